//! The patterns that come with the program, and a picture of each.

use crate::project::Project;
use crate::scenes::pinned_out;
use crate::written::{swatch, title};
use anyhow::{Context, Result};
use glam::Vec3;
use image::RgbaImage;
use include_dir::{Dir, include_dir};
use patterns::knitspeak::Width;
use render::{Bounds, Camera, Drawing, Gpu, NamedView, render_image};
use sim_core::{Simulator, curves};
use std::sync::LazyLock;

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../assets/patterns");

/// Side of a picture [pixels].
pub const PICTURE: u32 = 80;
/// Pictures side by side in [`PICTURES`].
pub const ACROSS: u32 = 10;
/// All pictures in one, in the order of [`ENTRIES`], as PNG; made by `purlwise library`.
pub const PICTURES: &[u8] = include_bytes!("../../assets/pictures/patterns.png");

/// A pattern of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub title: &'static str,
    /// What kind of fabric it is: lace, rib, cable, ….
    pub kind: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// How sure we are that it is right.
    pub certainty: &'static str,
    /// How large it is.
    pub repeat: &'static str,
    /// The text.
    pub text: &'static str,
}

/// All patterns, by the names of their files.
pub static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    let mut files: Vec<_> = FILES.files().collect();
    files.sort_by_key(|file| file.path());
    files.into_iter().filter_map(|file| Some(Entry::of(file.contents_utf8()?))).collect()
});

impl Entry {
    fn of(text: &'static str) -> Self {
        let said = |what: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix("# ")?.strip_prefix(what));
            line.map_or("", |rest| rest.trim_start_matches(':').trim())
        };
        Self {
            title: title(text),
            kind: said("kind"),
            source: said("source"),
            certainty: said("certainty"),
            repeat: said("repeat"),
            text,
        }
    }

    /// Whether all words of a query stand in its name, its kind or its source.
    pub fn matches(&self, query: &str) -> bool {
        let about = format!("{} {} {}", self.title, self.kind, self.source).to_lowercase();
        query.to_lowercase().split_whitespace().all(|word| about.contains(word))
    }
}

/// Draws the pictures of all patterns into one. `watch` is told how many are done.
///
/// # Errors
/// A pattern that cannot be knitted, or a device that cannot draw.
pub fn draw(gpu: &Gpu, watch: &mut dyn FnMut(usize)) -> Result<RgbaImage> {
    let rows = (ENTRIES.len() as u32).div_ceil(ACROSS);
    let mut all = RgbaImage::new(ACROSS * PICTURE, rows * PICTURE);
    for (i, entry) in (0..).zip(ENTRIES.iter()) {
        let picture = picture(gpu, entry.text).with_context(|| entry.title)?;
        let place = [i % ACROSS, i / ACROSS].map(|n| i64::from(n * PICTURE));
        image::imageops::replace(&mut all, &picture, place[0], place[1]);
        watch(i as usize + 1);
    }
    Ok(all)
}

/// A swatch about as high as wide, as far as its rows can be repeated.
fn high(text: &str) -> Result<Project> {
    let (once, facts) = swatch(text, Width::AsWritten, 1)?;
    let size = once.size;
    let wanted = (facts.cast_on as f64 * size.width / size.height / facts.rows as f64).round() as usize;
    Ok(if wanted < 2 {
        once
    } else {
        swatch(text, Width::AsWritten, wanted).map_or(once, |repeated| repeated.0)
    })
}

/// A swatch pinned out and settled a little, seen from the front.
fn picture(gpu: &Gpu, text: &str) -> Result<RgbaImage> {
    /// Simulated time [s], and part of the swatch that shows.
    const TIME: f64 = 0.15;
    const SHOWN: f32 = 0.27;
    let project = high(text)?;
    let fabric = project.fabric()?;
    let (stitches, net) = (&fabric.stitches, fabric.net());
    let materials = project.materials.clone();
    let scene = pinned_out(stitches, (net, &net.laid_state()), &materials.base, |_| true);
    let mut simulator = Simulator::new(net, materials.clone(), scene, net.laid_state())?;
    while simulator.time_s() < TIME {
        simulator.step()?;
    }
    let yarn = curves(net, simulator.state(), &materials);
    let drawing = Drawing { yarn, ..Drawing::default() };
    let [low, high] = stitches.mesh().bounds().map(|p| p.as_vec3());
    let middle = (low + high) / 2.0;
    let reach = Vec3::splat((high - low).truncate().min_element() * SHOWN);
    let bounds = Bounds::of([middle - reach, middle + reach]).context("a swatch without extent")?;
    let camera = Camera::named(NamedView::Front, bounds, 1.0);
    Ok(render_image(gpu, [PICTURE; 2], &camera, &drawing)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pattern_says_what_it_is_and_where_it_comes_from() {
        assert!(ENTRIES.len() >= 39, "{} patterns", ENTRIES.len());
        for entry in ENTRIES.iter() {
            let said = [entry.kind, entry.source, entry.certainty, entry.repeat];
            assert!(said.iter().all(|s| !s.is_empty()), "{}: {said:?}", entry.title);
        }
        for name in [
            "Feather and Fan",
            "Openwork Diamonds",
            "Flame Chevron",
            "Mrs. Montague",
            "Openwork Trellis",
            "Ridged Feather",
            "Flame Ribbing",
            "Braid Cables",
            "Cable Work",
        ] {
            assert!(ENTRIES.iter().any(|e| e.title.starts_with(name)), "{name}");
        }
    }

    #[test]
    fn words_are_found_in_any_order() {
        let found = |query: &str| ENTRIES.iter().filter(|e| e.matches(query)).count();
        assert_eq!(found("and fan feather"), found("feather and fan"));
        assert!((1..5).contains(&found("fan feather")));
        assert!(found("cable") > 5 && found("lace") > 10 && found("nothing of the kind") == 0);
    }

    #[test]
    fn there_is_a_picture_of_each() {
        let pictures = image::load_from_memory(PICTURES).unwrap().to_rgba8();
        let rows = (ENTRIES.len() as u32).div_ceil(ACROSS);
        assert_eq!(pictures.dimensions(), (ACROSS * PICTURE, rows * PICTURE));
        let tile = |i: u32| {
            let [x, y] = [i % ACROSS * PICTURE, i / ACROSS * PICTURE];
            image::imageops::crop_imm(&pictures, x, y, PICTURE, PICTURE).to_image()
        };
        let colors = |i: u32| tile(i).pixels().map(|p| p.0).collect::<std::collections::HashSet<_>>().len();
        assert!((0..ENTRIES.len() as u32).all(|i| colors(i) > 50));
    }
}
