//! The panels around the viewport.

mod history;
pub mod left;
mod palette;
mod patterns;
mod problems;
pub mod right;
pub mod status;
pub mod top;
mod yarn;

use super::view::View;
use sim_core::Material;

/// What the panels remember between frames.
pub struct State {
    /// The path field.
    pub path: String,
    /// The stitch size field [mm].
    pub width_mm: f64,
    /// Width over height of the viewport.
    pub aspect: f32,
    /// The yarn while a slider moves.
    pub material: Option<Material>,
    /// Radius of the selecting brush [px].
    pub brush_radius: f32,
    /// What the palette is searched for.
    pub palette_filter: String,
    /// Numbers of the alternations.
    pub alternation: patterns::Numbers,
}

impl State {
    /// Fields as they stand for a freshly opened document.
    pub fn of(view: &View) -> Self {
        Self {
            path: view.path.as_ref().map(|p| p.display().to_string()).unwrap_or_default(),
            width_mm: 1e3 * view.project.size.width,
            aspect: 4.0 / 3.0,
            material: None,
            brush_radius: 30.0,
            palette_filter: String::new(),
            alternation: patterns::Numbers::default(),
        }
    }
}
