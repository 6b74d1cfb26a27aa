//! The data of every stage from polygon mesh to yarn curves, and the pure geometry between them.
//! No GPU, no window, no iteration.

pub mod ids;
pub mod yarn_curves;
pub mod yarn_net;
