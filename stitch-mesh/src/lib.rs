//! The data of every stage from polygon mesh to yarn curves, and the pure geometry between them.
//! No GPU, no window, no iteration.

pub mod autolabel;
pub mod edge_counts;
pub mod fill;
#[cfg(test)]
mod grid;
pub mod ids;
pub mod label;
pub mod lay;
pub mod mean_value;
pub mod mesh;
pub mod obj;
pub mod pieces;
pub mod stitch;
pub mod stitch_mesh;
pub mod subdivide;
pub mod tessellate;
pub mod validate;
pub mod yarn_curves;
pub mod yarn_net;
