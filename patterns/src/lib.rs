//! Stitch patterns: charts of stitches and laying them over a stitch mesh, and patterns in the words of knitters.

pub mod alternation;
pub mod chart;
pub mod diagram;
pub mod instructions;
pub mod knit;
pub mod knitspeak;
pub mod tile;
