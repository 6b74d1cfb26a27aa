//! The data of every stage from polygon mesh to yarn curves, and the pure geometry between them.
//! No GPU, no window, no iteration.

pub mod autolabel;
pub mod cable;
pub mod catalogue;
mod corners;
pub mod dye;
pub mod edge_counts;
pub mod edge_totals;
pub mod edit;
pub mod fill;
#[cfg(test)]
mod grid;
pub mod ids;
mod keep;
pub mod label;
pub mod lay;
pub mod marks;
pub mod mean_value;
pub mod mesh;
pub mod needle;
pub mod obj;
pub mod patch;
pub mod pieces;
mod reface;
mod region;
mod rows;
pub mod seam;
mod sides;
pub mod stitch;
pub mod stitch_mesh;
mod stitch_names;
pub mod subdivide;
pub mod swatches;
pub mod tessellate;
pub mod unravel;
pub mod validate;
pub mod weave;
pub mod wrapping;
pub mod yarn_curves;
pub mod yarn_net;
