//! Stitch patterns: charts of stitches, and laying them over a stitch mesh.

pub mod alternation;
pub mod chart;
pub mod knitspeak;
