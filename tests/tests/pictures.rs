//! Pictures of whole projects, checked by their pixels. They are left in `target/pictures` to be looked at.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::bundled::pullover;
use app::drawing::{Stage, drawing};
use app::fabric::Fabric;
use app::project::Project;
use image::{RgbaImage, imageops::flip_horizontal};
use render::{Camera, Drawing, NamedView, render_image};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::stitch::Stitch;
use tests::{gpu, picture_folder};

const SIZE: [u32; 2] = [480, 360];

/// A swatch of 12 × 10 stitches; those are purled that `is_purl` says, by column and row.
fn swatch(is_purl: impl Fn(usize, usize) -> bool) -> Project {
    let size = StitchSize::of_width(0.01);
    let mut stitches = rectangle(12, 10, size).unwrap();
    for face in (0..120).filter(|f| is_purl(f % 12, f / 12)) {
        stitches.set_stitch(FaceId::new(face), Stitch::purl()).unwrap();
    }
    let mut project = Project::new(stitches.mesh().clone(), size);
    project.fabric = Some(Fabric::new(stitches));
    project
}

/// Draws a stage and keeps the picture.
fn picture(project: &Project, stage: Stage, view: NamedView, name: &str) -> RgbaImage {
    let drawing = drawing(project, stage).unwrap();
    let camera = Camera::named(view, drawing.bounds().unwrap(), SIZE[0] as f32 / SIZE[1] as f32);
    let image = render_image(gpu(), SIZE, &camera, &drawing).unwrap();
    image.save(picture_folder().join(format!("{name}.png"))).unwrap();
    image
}

/// Largest difference of a channel.
fn contrast(a: &image::Rgba<u8>, b: &image::Rgba<u8>) -> u8 {
    (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap()
}

/// Part of the pixels that differ clearly, 0…1.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let different = a.pixels().zip(b.pixels()).filter(|(a, b)| contrast(a, b) > 24).count();
    different as f64 / a.pixels().len() as f64
}

/// What is drawn where there is nothing.
fn background() -> RgbaImage {
    render_image(gpu(), SIZE, &Camera::default(), &Drawing::default()).unwrap()
}

/// Colours of the rainbow, in twelve parts, that fill more than one in a hundred pixels.
fn hues(image: &RgbaImage) -> usize {
    let mut count = [0; 12];
    for pixel in image.pixels() {
        let [r, g, b] = [0, 1, 2].map(|c| i32::from(pixel[c]));
        let (high, low) = (r.max(g).max(b), r.min(g).min(b));
        if high - low > 60 {
            let sixth = if high == r {
                (g - b) as f32 / (high - low) as f32
            } else if high == g {
                2.0 + (b - r) as f32 / (high - low) as f32
            } else {
                4.0 + (r - g) as f32 / (high - low) as f32
            };
            count[(2.0 * sixth.rem_euclid(6.0)) as usize % 12] += 1;
        }
    }
    count.iter().filter(|n| **n * 100 > image.pixels().len()).count()
}

#[test]
fn rows_of_the_pullover_are_told_apart_by_colour() {
    let project = pullover().unwrap();
    let mesh = picture(&project, Stage::Mesh, NamedView::Front, "mesh");
    let labels = picture(&project, Stage::Labels, NamedView::Front, "labels");
    assert!(hues(&labels) >= 3, "{} colours", hues(&labels));
    assert_eq!(hues(&mesh), 0, "the bare mesh has none");
    assert!(difference(&mesh, &background()) > 0.1);
}

/// How much bluer the right half of the fabric is than the left one, in steps of a channel.
fn turns_blue(image: &RgbaImage) -> f64 {
    let blueness = |from: u32, to: u32| {
        let mut sum = 0.0;
        for (x, y) in (from..to).flat_map(|x| (SIZE[1] * 2 / 5..SIZE[1] * 3 / 5).map(move |y| (x, y))) {
            let pixel = image.get_pixel(x, y);
            sum += f64::from(pixel[2]) - f64::from(pixel[0]);
        }
        sum / f64::from((to - from) * (SIZE[1] * 3 / 5 - SIZE[1] * 2 / 5))
    };
    let middle = SIZE[0] / 2;
    blueness(middle + 10, middle + 90) - blueness(middle - 90, middle - 10)
}

#[test]
fn knit_and_purl_stitches_have_their_own_colours() {
    let halves = swatch(|column, _| column >= 6);
    let halves = picture(&halves, Stage::Stitches, NamedView::Front, "stitches-half-purl");
    assert!(turns_blue(&halves) > 40.0, "{}", turns_blue(&halves));
    let knit = picture(&swatch(|_, _| false), Stage::Stitches, NamedView::Front, "stitches-knit");
    assert!(turns_blue(&knit).abs() < 4.0, "{}", turns_blue(&knit));
}

#[test]
fn yarn_fills_the_middle_and_leaves_the_corners() {
    let image = picture(&swatch(|_, _| false), Stage::Yarn, NamedView::Front, "yarn-front");
    let background = background();
    let drawn = |x: u32, y: u32| contrast(image.get_pixel(x, y), background.get_pixel(x, y)) > 24;
    let part = |x0: u32, y0: u32| {
        let square = (x0..x0 + 40).flat_map(|x| (y0..y0 + 40).map(move |y| (x, y)));
        square.filter(|(x, y)| drawn(*x, *y)).count() as f64 / 1600.0
    };
    let [w, h] = SIZE;
    assert!(part(w / 2 - 20, h / 2 - 20) > 0.5, "{}", part(w / 2 - 20, h / 2 - 20));
    for (x, y) in [(0, 0), (w - 40, 0), (0, h - 40), (w - 40, h - 40)] {
        assert_eq!(part(x, y), 0.0, "{x}, {y}");
    }
}

#[test]
fn the_back_of_knitting_is_not_its_front() {
    let knit = swatch(|_, _| false);
    let front = picture(&knit, Stage::Yarn, NamedView::Front, "yarn-front-2");
    let back = flip_horizontal(&picture(&knit, Stage::Yarn, NamedView::Back, "yarn-back"));
    assert!(difference(&front, &back) > 0.1, "{}", difference(&front, &back));
    // The comparison has to find pictures alike that are, and so has the renderer.
    let again = picture(&knit, Stage::Yarn, NamedView::Front, "yarn-front-2");
    assert_eq!(difference(&front, &again), 0.0);
}

#[test]
fn purling_shows_in_the_yarn() {
    let knit = picture(&swatch(|_, _| false), Stage::Yarn, NamedView::Front, "yarn-knit");
    let one_row = picture(&swatch(|_, row| row == 5), Stage::Yarn, NamedView::Front, "yarn-purl-row");
    let different = difference(&knit, &one_row);
    assert!((0.005..0.3).contains(&different), "one row of ten, not all of them: {different}");
}
