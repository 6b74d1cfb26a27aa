//! Virtual textile experiments: what a fabric does, in numbers, curves and pictures.
//!
//! | file | idea |
//! |---|---|
//! | `report` | what an experiment finds: figures, tables, plots, pictures |
//! | `bench` | where it is done: simulated time that somebody watches and may stop |
//! | `specimen` | a piece of fabric and places on it |
//! | `jaws`, `pull`, `regimes` | springs that grip a specimen, slow pulling, the straight parts of a force curve |
//! | `plot` | a plot with egui, in the window and in a picture alike |
//! | the others | one experiment each: setup, measurement, figures |
//!
//! All pieces are of yarn with the same parameters ([`sim_core::Material::for_loop_width`]) unless an experiment is about them.

mod bench;
mod bending;
mod curl;
mod gauge;
mod jaws;
mod overstretch;
pub mod plot;
mod pull;
mod pullout;
mod regimes;
mod report;
mod rest_shape;
mod rib_draw_in;
mod shear;
mod specimen;
mod sphere;
mod stretch;

use anyhow::Result;
use bench::Bench;
pub use bench::Watch;
use clap::ValueEnum as _;
pub use jaws::Direction;
pub use report::{Line, Picture, Plot, Report, Table};

/// An experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Experiment {
    /// Which way the edges of stockinette roll
    Curl,
    /// How much narrower a 2 × 2 rib becomes
    RibDrawIn,
    /// Force against extension, loading and unloading
    Stretch,
    /// Force against shear angle, to and fro
    Shear,
    /// Drape over a small disc, and bending length of a strip
    Bending,
    /// What stays of an extension beyond what friction holds
    Overstretch,
    /// A row drawn out of the fabric by its yarn
    Pullout,
    /// Six fabrics dropped on a sphere
    Sphere,
    /// Course and wale spacing of relaxed plain knit against its loop length
    Gauge,
    /// A garment with loops as drawn, and with loops as they are at rest
    RestShape,
}

/// What an experiment is done with; those that are about a fabric of their own take no notice.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// A written pattern instead of the usual fabric (stretch, shear).
    pub pattern: Option<String>,
    /// Which way it is pulled (stretch).
    pub direction: Direction,
}

impl Experiment {
    /// Its name, as on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
    }

    /// What it is about.
    pub fn about(self) -> String {
        let help = self.to_possible_value().and_then(|v| v.get_help().map(ToString::to_string));
        help.unwrap_or_default()
    }

    /// Does it. `watch` is told what has been found after every step, and may break off.
    ///
    /// # Errors
    /// The pattern cannot be knitted, the simulation is stuck, or `watch` broke off.
    pub fn run(self, setup: &Setup, watch: Watch<'_>) -> Result<Report> {
        let mut bench = Bench::new(watch);
        match self {
            Self::Curl => curl::run(&mut bench),
            Self::RibDrawIn => rib_draw_in::run(&mut bench),
            Self::Stretch => stretch::run(&mut bench, setup),
            Self::Shear => shear::run(&mut bench, setup),
            Self::Bending => bending::run(&mut bench),
            Self::Overstretch => overstretch::run(&mut bench),
            Self::Pullout => pullout::run(&mut bench),
            Self::Sphere => sphere::run(&mut bench),
            Self::Gauge => gauge::run(&mut bench),
            Self::RestShape => rest_shape::run(&mut bench),
        }?;
        Ok(bench.report)
    }
}
