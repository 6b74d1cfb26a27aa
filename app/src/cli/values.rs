//! Values that options take.

use clap::ValueEnum;
use sim_core::SolverChoice;
use stitch_mesh::obj::Unit;

#[derive(Clone, Copy, ValueEnum)]
pub enum RelaxStage {
    /// The stitch mesh on the smooth surface of the input; the yarn is laid again
    Mesh,
    /// The yarn with its contacts
    Contact,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// The fastest for the fabric on this machine
    Auto,
    /// The faster one on the CPU
    Cpu,
    /// A complete factorisation, on the CPU
    Direct,
    /// Conjugate gradients, on the CPU
    Iterative,
    /// Conjugate gradients on the GPU, and on the CPU once that fails
    Gpu,
}

impl From<Solver> for SolverChoice {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Auto => Self::Auto,
            Solver::Cpu => Self::Cpu,
            Solver::Direct => Self::Direct,
            Solver::Iterative => Self::Iterative,
            Solver::Gpu => Self::Gpu,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum UnitName {
    Mm,
    Cm,
    Dm,
    M,
    In,
}

impl From<UnitName> for Unit {
    fn from(name: UnitName) -> Self {
        match name {
            UnitName::Mm => Self::Mm,
            UnitName::Cm => Self::Cm,
            UnitName::Dm => Self::Dm,
            UnitName::M => Self::M,
            UnitName::In => Self::In,
        }
    }
}

/// Width and height of `WxH` [pixels].
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let (w, h) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as in 1280x960")?;
    let side = |s: &str| s.parse().ok().filter(|n| (1..=16384).contains(n));
    match (side(w), side(h)) {
        (Some(w), Some(h)) => Ok([w, h]),
        _ => Err(format!("'{text}' is not a size from 1x1 to 16384x16384")),
    }
}

/// First and last row of `A..B`.
pub fn parse_rows(text: &str) -> Result<[usize; 2], String> {
    let (a, b) = text.split_once("..").ok_or("expected FIRST..LAST, as in 4..19")?;
    match (a.parse(), b.parse()) {
        (Ok(a), Ok(b)) if a <= b => Ok([a, b]),
        _ => Err(format!("'{text}' is not a range of rows")),
    }
}
