//! The swatches of the sheet: which there are, and how each is settled and looked at.

use crate::scenes::pinned_out;
use anyhow::{Context, Result};
use glam::Vec3;
use image::RgbaImage;
use render::{Bounds, Camera, Drawing, Gpu, NamedView, render_image};
use sim_core::{Material, Materials, Simulator, curves};
use std::sync::Arc;
use stitch_mesh::cable::Cable;
use stitch_mesh::catalogue::GROUPS;
use stitch_mesh::dye::Dye;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::swatches;

/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// Simulated time after which a swatch is drawn [s].
const TIME: f64 = 0.5;

/// Colour of the yarn of the stitch that a swatch is about.
const SHOWN: Dye = Dye([0xc9, 0x6a, 0x3c]);
/// Colours of the loops that it joins or hands on, the front one first.
const JOINED: [Dye; 3] = [Dye([0x2f, 0x6f, 0xa8]), Dye([0x7f, 0xb2, 0xd9]), Dye([0x9a, 0x8f, 0xb5])];

/// The part of a swatch that is looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Middle,
    LowerBorder,
    UpperBorder,
}

/// A swatch and what stands below it.
pub(super) struct Swatch {
    stitches: StitchMesh,
    part: Part,
    /// What it is called.
    pub title: String,
    /// What it is, in words.
    pub description: String,
}

/// All swatches under their headings.
///
/// # Errors
/// A swatch that cannot be knitted.
pub(super) fn groups() -> Result<Vec<(&'static str, Vec<Swatch>)>> {
    let mut groups = Vec::new();
    for (heading, symbols) in GROUPS {
        let swatches = symbols.iter().map(|symbol| of_stitch(&symbol.parse()?));
        groups.push((heading, swatches.collect::<Result<Vec<_>>>()?));
    }
    groups.push(("Borders", borders()?));
    groups.push(("Cables", cables()?));
    Ok(groups)
}

fn of_stitch(stitch: &Stitch) -> Result<Swatch> {
    let size = StitchSize::of_width(LOOP);
    let (symbol, short, description) = (stitch.to_string(), stitch.abbreviation(), stitch.description());
    let title = if short == symbol { symbol } else { format!("{short} ({symbol})") };
    // Loops that hold no older ones begin a fabric.
    if stitch.bottoms() == 1 && !stitch.holds() {
        // A row of loops without any twist would pull straight: nothing holds them.
        let is_twisted = stitch.ops.iter().any(|op| op.twist != 0);
        let beside: Stitch = if is_twisted { stitch.clone() } else { "y1".parse()? };
        let mut cast_on = [(); 7].map(|()| beside.clone());
        cast_on[3] = stitch.clone();
        let mut stitches = swatches::with_borders(Some(cast_on), size)?;
        let shown = stitches.rows()[0].faces[3];
        stitches.set_dye(shown, SHOWN)?;
        return Ok(Swatch { stitches, part: Part::LowerBorder, title, description });
    }
    let mut stitches = swatches::of_stitch(stitch, size)?;
    let rows = stitches.rows();
    let (shown, below) = (rows[3].faces[3], rows[2].faces.clone());
    stitches.set_dye(shown, SHOWN)?;
    // Where the loops below are joined, gathered or slipped, they are what there is to see.
    let is_slipped = stitch.ops.iter().any(|op| op.make.passes_on());
    if stitch.bottoms() > 1 || stitch.ops.is_empty() || is_slipped {
        for (loop_, dye) in stitch.stack.iter().zip(JOINED) {
            stitches.set_dye(below[3 + usize::from(*loop_)], dye)?;
        }
    }
    Ok(Swatch { stitches, part: Part::Middle, title, description })
}

fn borders() -> Result<Vec<Swatch>> {
    let borders = [
        (Part::LowerBorder, "cast-on", "knits on the border: what tessellation makes"),
        (Part::UpperBorder, "bind-off", "each loop drawn over the next"),
    ];
    let swatch = |(part, title, description): (Part, &str, &str)| -> Result<Swatch> {
        let stitches = swatches::with_borders(None, StitchSize::of_width(LOOP))?;
        Ok(Swatch { stitches, part, title: title.to_owned(), description: description.to_owned() })
    };
    borders.into_iter().map(swatch).collect()
}

fn cables() -> Result<Vec<Swatch>> {
    let cross = |n, m, to_left| Cable::cross(vec![], n, m, to_left);
    let rope = |cable: Cable| vec![(0, cable); 3];
    let strands = [(0, false), (2, true)].repeat(3);
    let plait = strands.into_iter().map(|(left, to_left)| (left, cross(2, 2, to_left)));
    let cables = [
        ("1/1 LC", "two loops crossed, the front one to the left", rope(cross(1, 1, true)), 10),
        ("C4F (2/2 LC)", "two over two to the left", rope(cross(2, 2, true)), 17),
        ("C4B (2/2 RC)", "two over two to the right", rope(cross(2, 2, false)), 17),
        ("C6F (3/3 LC)", "three over three to the left", rope(cross(3, 3, true)), 23),
        ("C6B (3/3 RC)", "three over three to the right", rope(cross(3, 3, false)), 23),
        ("2/2/2", "plait of three strands", plait.collect(), 15),
    ];
    let swatch = |(title, description, crossings, height): (&str, &str, Vec<(usize, Cable)>, usize)| {
        let stitches = swatches::of_cable(&crossings, height, StitchSize::of_width(LOOP))?;
        let (title, description) = (title.to_owned(), description.to_owned());
        Ok(Swatch { stitches, part: Part::Middle, title, description })
    };
    cables.into_iter().map(swatch).collect()
}

/// A swatch settled with its border held, as pinned out on a board, seen from the front and from the back. `side` is that of
/// a picture in pixels.
///
/// # Errors
/// A swatch that cannot be simulated, or a device that cannot draw.
pub(super) fn both_sides(gpu: &Gpu, swatch: &Swatch, side: u32) -> Result<[RgbaImage; 2]> {
    let stitches = &swatch.stitches;
    let net = Arc::new(lay(stitches));
    let materials = Materials::from(Material::for_loop_width(LOOP));
    // Pinned out on a board: stitches on all sides, cables above and below only, as they draw together.
    let is_cabled = !stitches.cables().is_empty();
    let state = net.laid_state();
    let scene =
        pinned_out(stitches, (&net, &state), &materials.base, |h| !(is_cabled && stitches.is_wale(h)));
    let mut simulator = Simulator::new(&net, materials.clone(), scene, state)?;
    while simulator.time_s() < TIME {
        simulator.step()?;
    }
    let yarn = curves(&net, simulator.state(), &materials);
    let drawing = Drawing { yarn, ..Drawing::default() };
    let [low, high] = stitches.mesh().bounds().map(|p| p.as_vec3());
    // The border is cut off, unless it is what is shown.
    let reach = (high - low).truncate().min_element() * 0.36;
    let mut middle = (low + high) / 2.0;
    match swatch.part {
        Part::Middle => {}
        Part::LowerBorder => middle.y = low.y + 0.6 * reach,
        Part::UpperBorder => middle.y = high.y - 0.5 * reach,
    }
    let reach = Vec3::splat(reach);
    let bounds = Bounds::of([middle - reach, middle + reach]).context("a swatch without extent")?;
    let picture = |view: NamedView| -> Result<RgbaImage> {
        let camera = Camera::named(view, bounds, 1.0);
        Ok(render_image(gpu, [side; 2], &camera, &drawing)?)
    };
    Ok([picture(NamedView::Front)?, picture(NamedView::Back)?])
}
