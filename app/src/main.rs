//! The `purlwise` program.
fn main() {}
