//! The panels around the viewport.

mod colour;
mod evenness;
mod history;
pub mod lab;
pub mod leaving;
pub mod left;
pub mod library;
mod material;
mod palette;
mod patterns;
mod problems;
pub mod replacing;
pub mod right;
mod scene;
pub mod status;
mod strands;
mod tessellation;
pub mod top;
mod wrapping;
mod yarn;

use super::view::View;
use sim_core::Material;
use sim_core::mesh_relax::RelaxParams;
use stitch_mesh::dye::Dye;

/// A colour of the picture, linear RGB, as egui wants it.
pub fn color32([r, g, b]: [f32; 3]) -> egui::Color32 {
    egui::Rgba::from_rgb(r, g, b).into()
}

/// What the path field says of a document.
pub fn path_text(view: &View) -> String {
    view.path.as_ref().map(|p| p.display().to_string()).unwrap_or_default()
}

/// What the panels remember between frames.
pub struct State {
    /// The path field.
    pub path: String,
    /// The stitch size field [mm].
    pub width_mm: f64,
    /// Width over height of the viewport.
    pub aspect: f32,
    /// The field for a scene file.
    pub scene: String,
    /// The colour of the yarn whose material is shown; none for all that have none of their own.
    pub yarn: Option<Dye>,
    /// Its material while a number is dragged.
    pub material: Option<Material>,
    /// Radius of the selecting brush [px].
    pub brush_radius: f32,
    /// What the palette is searched for.
    pub palette_filter: String,
    /// Whether the stitch size field has been changed since it was last tessellated or an edge was counted by hand.
    pub width_changed: bool,
    /// The colour to dye with.
    pub dye: Dye,
    /// A cable written out.
    pub strands: strands::Fields,
    /// Wrapping of single stitches.
    pub wrap: wrapping::Fields,
    /// Height over width of a stitch at rest, and how much of the surface stitches fill.
    pub relax: [f64; 2],
    /// Whether relaxed stitches stay on the surface of the input mesh.
    pub relax_on_surface: bool,
    /// What tessellating would come to.
    pub forecast: tessellation::Forecast,
    /// Which tools the left panel shows.
    pub tab: left::Tab,
    /// The pattern library.
    pub written: library::State,
    /// Experiments.
    pub lab: lab::State,
    /// Numbers of the alternations.
    pub alternation: patterns::Numbers,
}

impl State {
    /// Fields as they stand for a freshly opened document.
    pub fn of(view: &View) -> Self {
        Self {
            path: path_text(view),
            width_mm: 1e3 * view.project.size.width,
            aspect: 4.0 / 3.0,
            scene: String::new(),
            yarn: None,
            material: None,
            width_changed: view.project.fabric.is_none(),
            dye: Dye([0x00, 0x72, 0xb2]),
            strands: strands::Fields::default(),
            wrap: wrapping::Fields::default(),
            relax: [RelaxParams::default().aspect, RelaxParams::default().fill],
            relax_on_surface: true,
            forecast: tessellation::Forecast::default(),
            tab: left::Tab::Simulate,
            brush_radius: 30.0,
            palette_filter: String::new(),
            written: library::State::default(),
            lab: lab::State::default(),
            alternation: patterns::Numbers::default(),
        }
    }
}
