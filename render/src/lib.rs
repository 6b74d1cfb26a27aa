//! Draws what it is given on a wgpu device that somebody else made: polygons, lines, bodies, and yarn as lit wool.
//!
//! The flow of a frame, which is also the order to read the files in:
//!
//! | from | verb | to | file |
//! |---|---|---|---|
//! | [`Drawing`] (plain data) | upload | [`Scene`] (buffers) | `drawing`, `scene`, `surface`, `lines`, `yarn` |
//! | `Scene`, [`Camera`] | cast shadows | shadow map | `shadow` |
//! | `Scene`, `Camera`, shadow map | shade | colour and depth | `surface`, `lines`, `yarn` |
//! | depth | find hollows | ambient occlusion | `occlusion` |
//! | colour, occlusion | compose over the background | picture | `compose` |
//!
//! [`Renderer`] owns what does not depend on the size of the picture, [`Viewport`] what does. The same code draws on
//! screen (a viewport's picture is shown by the window) and into image files ([`render_image`]).
//!
//! A software adapter takes about as long as there are pixels. Where [`Gpu::is_software`], a window stays fluent by drawing
//! into a viewport of half the width and height, and roughly, while something moves, and of full size when it has come to rest.

mod camera;
mod compose;
mod damage;
mod drawing;
mod error;
mod frame;
mod gpu;
mod light;
mod lines;
mod mirror;
mod occlusion;
mod offscreen;
pub mod palette;
mod pick;
mod pipeline;
mod renderer;
mod scene;
mod shadow;
mod solids;
mod surface;
mod viewport;
mod visible;
mod yarn;

pub use camera::{Bounds, Camera, NamedView, Ray};
pub use drawing::{Drawing, Faces, Lines, Polygon, Segment};
pub use error::RenderError;
pub use gpu::Gpu;
pub use offscreen::{read_back, render_image};
pub use pick::{Hit, pick};
pub use renderer::{Quality, Renderer};
pub use scene::Scene;
pub use solids::{Solid, Solids};
pub use viewport::Viewport;
pub use visible::Visible;
pub use yarn::{LaidRun, LaidYarn, YarnLayout};
