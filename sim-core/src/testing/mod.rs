//! What the tests share.

pub(crate) mod finite_difference;
