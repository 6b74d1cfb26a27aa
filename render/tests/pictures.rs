//! Whole pictures: known scenes checked by their pixels, and pictures to look at in the target directory.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "helpers of tests are tests, which clippy cannot see"
)]

mod support;

use glam::Vec3;
use image::RgbaImage;
use render::{
    Camera, Drawing, Faces, Lines, NamedView, Polygon, Quality, RenderError, Renderer, Scene, Segment, Solid,
    Solids, Viewport, YarnLayout, palette, read_back, render_image,
};
use stitch_mesh::dye::Dye;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};
use support::{gpu, stockinette};

const SIZE: [u32; 2] = [160, 120];
const RED: [f32; 3] = [0.8, 0.05, 0.05];
const GREEN: [f32; 3] = [0.05, 0.7, 0.05];

/// A square in a plane z, of half width 0.1, seen counter-clockwise from +z.
fn square(center: Vec3, color: [f32; 3]) -> Faces {
    let corners = [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)];
    Faces {
        positions: corners.map(|(x, y)| center + Vec3::new(x, y, 0.0)).to_vec(),
        polygons: vec![Polygon { vertices: smallvec::smallvec![0, 1, 2, 3], color }],
    }
}

fn join(mut a: Faces, b: Faces) -> Faces {
    let offset = a.positions.len() as u32;
    a.positions.extend(b.positions);
    a.polygons.extend(b.polygons.into_iter().map(|mut polygon| {
        polygon.vertices.iter_mut().for_each(|v| *v += offset);
        polygon
    }));
    a
}

fn draw(drawing: &Drawing, view: NamedView) -> RgbaImage {
    let (yaw, pitch) = match view {
        NamedView::Back => (std::f32::consts::PI, 0.0),
        _ => (0.0, 0.0),
    };
    render_image(gpu(), SIZE, &Camera { yaw, pitch, ..Default::default() }, drawing).unwrap()
}

/// The pixel at a part of the width and height, 0…1.
fn at(picture: &RgbaImage, x: f32, y: f32) -> [i32; 3] {
    let [r, g, b, a] = picture.get_pixel((x * SIZE[0] as f32) as u32, (y * SIZE[1] as f32) as u32).0;
    assert_eq!(a, 255);
    [r, g, b].map(i32::from)
}

fn is_red(pixel: [i32; 3]) -> bool {
    pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2]
}

fn is_green(pixel: [i32; 3]) -> bool {
    pixel[1] > 2 * pixel[0] && pixel[1] > 2 * pixel[2]
}

/// Light grey, as the background is.
fn is_background([r, g, b]: [i32; 3]) -> bool {
    b > 180 && r >= g && g >= b && r - b < 20
}

#[test]
fn faces_appear_where_they_are() {
    let faces = join(square(Vec3::new(-0.2, 0.0, 0.0), RED), square(Vec3::new(0.2, 0.1, 0.0), GREEN));
    let picture = draw(&Drawing { faces, ..Default::default() }, NamedView::Front);
    assert!(is_red(at(&picture, 0.2, 0.5)));
    assert!(is_green(at(&picture, 0.8, 0.35)));
    assert!(is_background(at(&picture, 0.5, 0.5)), "{:?}", at(&picture, 0.5, 0.5));
    assert!(is_background(at(&picture, 0.8, 0.9)));
    // From behind, left is right.
    let back = draw(
        &Drawing { faces: square(Vec3::new(-0.2, 0.0, 0.0), RED), ..Default::default() },
        NamedView::Back,
    );
    assert!(is_red(at(&back, 0.8, 0.5)) && is_background(at(&back, 0.2, 0.5)));
}

#[test]
fn what_is_nearer_hides_what_is_farther() {
    for (near, far) in [(RED, GREEN), (GREEN, RED)] {
        let faces = join(square(Vec3::Z * 0.05, near), square(Vec3::Z * -0.05, far));
        let drawing = Drawing { faces, ..Default::default() };
        let front = at(&draw(&drawing, NamedView::Front), 0.5, 0.5);
        let back = at(&draw(&drawing, NamedView::Back), 0.5, 0.5);
        assert!(if near == RED { is_red(front) && is_green(back) } else { is_green(front) && is_red(back) });
    }
}

#[test]
fn the_back_of_a_face_is_darker() {
    let drawing = Drawing { faces: square(Vec3::ZERO, [0.5; 3]), ..Default::default() };
    let [front, back] =
        [NamedView::Front, NamedView::Back].map(|view| at(&draw(&drawing, view), 0.5, 0.5)[1]);
    assert!(back + 20 < front && back > 30, "front {front}, back {back}");
}

#[test]
fn yarn_is_lit_from_the_upper_left_and_round() {
    let points = (0..8).map(|i| Vec3::new(0.0, 0.05 * (i as f32 - 3.5), 0.0)).collect();
    let curve = YarnCurve::new(points, false, 0.05, Dye([188; 3]));
    let drawing = Drawing { yarn: YarnCurves { curves: vec![curve] }, ..Default::default() };
    let picture = draw(&drawing, NamedView::Front);
    // Fibres make single pixels differ: means along the yarn.
    let column = |x: f32| (0..40).map(|i| at(&picture, x, 0.35 + 0.3 * i as f32 / 40.0)[0]).sum::<i32>() / 40;
    let [left, middle, right] = [0.44, 0.49, 0.56].map(column);
    assert!(left > right + 15 && middle > right + 10, "{left} {middle} {right}");
    assert!(is_background(at(&picture, 0.3, 0.5)) && is_background(at(&picture, 0.7, 0.5)));
}

#[test]
fn yarn_as_wide_as_a_pixel_is_as_light_as_wider_yarn() {
    // Yarn side by side, with radii of 0.71 and 0.80 pixels of the picture before it is made smaller: threads and ribbons.
    let mean = |radius: f32| {
        let yarn = |i: i32| {
            let points = (-8..=8).map(|k| Vec3::new(0.02 * k as f32, 2.0 * radius * i as f32, 0.0)).collect();
            YarnCurve::new(points, false, radius, Dye([200, 150, 90]))
        };
        let curves = (-40..40).map(yarn).collect();
        let picture = draw(&Drawing { yarn: YarnCurves { curves }, ..Default::default() }, NamedView::Front);
        let pixels =
            (0..40 * 40).map(|i| at(&picture, 0.4 + 0.005 * (i % 40) as f32, 0.4 + 0.005 * (i / 40) as f32));
        pixels.fold([0; 3], |sum, pixel| [0, 1, 2].map(|c| sum[c] + pixel[c])).map(|sum| sum as f32 / 1600.0)
    };
    let [threads, ribbons] = [1.5e-3, 1.7e-3].map(mean);
    let apart = (0..3).map(|c| (threads[c] - ribbons[c]).abs()).fold(0.0, f32::max);
    assert!(apart < 4.0, "{threads:?} {ribbons:?}");
}

#[test]
fn lines_lie_on_the_surface_that_they_belong_to() {
    let [a, b] = [Vec3::new(-0.1, 0.0, 0.0), Vec3::new(0.1, 0.0, 0.0)];
    let lines = Lines { segments: vec![Segment { ends: [a, b], color: GREEN, width: 4.0 }] };
    let drawing = Drawing { faces: square(Vec3::ZERO, RED), lines, ..Default::default() };
    let picture = draw(&drawing, NamedView::Front);
    assert!(is_green(at(&picture, 0.5, 0.5)) && is_red(at(&picture, 0.5, 0.6)));
    let hidden = Drawing { faces: square(Vec3::Z * 0.05, RED), ..drawing };
    assert!(is_red(at(&draw(&hidden, NamedView::Front), 0.5, 0.5)));
    // A line of four pixels is about four pixels wide.
    let width = (0..120).filter(|&y| is_green(at(&picture, 0.5, (y as f32 + 0.5) / 120.0))).count();
    assert!((3..=5).contains(&width), "{width}");
}

#[test]
fn bodies_cast_shadows_on_the_ground() {
    let sphere = Solid::Sphere { center: Vec3::new(0.0, 0.05, 0.0), radius: 0.06 };
    let look = Camera { pitch: 0.6, ..Default::default() };
    let [shaded, lit] = [vec![sphere, Solid::Ground { height: -0.1 }], vec![Solid::Ground { height: -0.1 }]]
        .map(|solids| Drawing { solids: Solids { solids }, ..Default::default() })
        .map(|drawing| render_image(gpu(), SIZE, &look, &drawing).unwrap());
    let darker = shaded.pixels().zip(lit.pixels()).filter(|(a, b)| a.0[0] + 25 < b.0[0]).count();
    assert!(darker > 200, "{darker} pixels");
}

#[test]
fn a_viewport_is_reused_resized_and_drawn_again() {
    let renderer = Renderer::new(gpu(), Quality::Interactive);
    let mut viewport = Viewport::new(gpu(), &renderer, [64, 48]).unwrap();
    let mut scene = Scene::new();
    assert!(!viewport.resize(gpu(), &renderer, [64, 48]).unwrap());
    assert!(viewport.resize(gpu(), &renderer, SIZE).unwrap());
    let show = |scene: &Scene| {
        let mut encoder = gpu().device.create_command_encoder(&Default::default());
        renderer.draw(gpu(), &mut encoder, &viewport, &Camera::default(), scene);
        gpu().queue.submit([encoder.finish()]);
        at(&read_back(gpu(), viewport.picture()).unwrap(), 0.5, 0.5)
    };
    assert!(is_background(show(&scene)));
    scene.set_faces(gpu(), &square(Vec3::ZERO, RED)).unwrap();
    assert!(is_red(show(&scene)));
    scene.set_faces(gpu(), &Faces::default()).unwrap();
    assert!(is_background(show(&scene)));
}

#[test]
fn a_rough_picture_shows_the_same_with_less_where_yarn_is_thin() {
    let renderer = Renderer::new(gpu(), Quality::Interactive);
    let mut scene = Scene::new();
    let yarn = stockinette(63, 63);
    scene.set_yarn(gpu(), &YarnLayout::of(&yarn)).unwrap();
    let bounds = Drawing { yarn, ..Default::default() }.bounds().unwrap();
    // With yarn of half a pixel, and of three, of which hollows are drawn.
    for (zoom, most_apart) in [(2.0, 12.0), (8.0, 6.0)] {
        let mut camera = Camera::named(NamedView::Front, bounds, 4.0 / 3.0);
        camera.zoom(zoom);
        let [fine, rough] = [false, true].map(|rough| {
            let mut viewport = Viewport::new(gpu(), &renderer, [64, 48]).unwrap();
            viewport.set_rough(rough);
            viewport.resize(gpu(), &renderer, SIZE).unwrap();
            let mut encoder = gpu().device.create_command_encoder(&Default::default());
            renderer.draw(gpu(), &mut encoder, &viewport, &camera, &scene);
            gpu().queue.submit([encoder.finish()]);
            read_back(gpu(), viewport.picture()).unwrap()
        });
        let mean = |of: &dyn Fn(f64, f64) -> f64| {
            let both = fine.as_raw().iter().zip(rough.as_raw());
            both.map(|(a, b)| of(f64::from(*a), f64::from(*b))).sum::<f64>() / fine.as_raw().len() as f64
        };
        let (apart, lighter) = (mean(&|a, b| (a - b).abs()), mean(&|_, b| b) / mean(&|a, _| a));
        assert!(zoom > 2.0 || apart > 1.0, "{apart} at {zoom}");
        assert!(apart < most_apart && (0.95..1.07).contains(&lighter), "{apart} {lighter} at {zoom}");
    }
}

#[test]
fn impossible_sizes_are_refused() {
    for size in [[0, 10], [10, 0], [1 << 20, 10]] {
        let result = render_image(gpu(), size, &Camera::default(), &Drawing::default());
        assert!(matches!(result, Err(RenderError::Size { .. })));
    }
}

#[test]
fn odd_curves_draw_without_complaint() {
    let curve = |points, closed| YarnCurve::new(points, closed, 0.01, Dye([188; 3]));
    let curves = vec![
        curve(vec![], false),
        curve(vec![Vec3::ZERO], true),
        curve(vec![Vec3::ZERO; 3], true),
        curve(vec![Vec3::ZERO, Vec3::X * 0.1], false),
        curve(vec![Vec3::ZERO, Vec3::Y * 0.1, Vec3::X * 0.1], true),
    ];
    draw(&Drawing { yarn: YarnCurves { curves }, ..Default::default() }, NamedView::Front);
}

fn save(name: &str, picture: &RgbaImage) {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    picture.save(&path).unwrap();
    println!("{}", path.display());
}

/// A curved patch of stitch faces in the colours of their stitches, with course and wale edges and one face selected.
fn stitch_chart() -> Drawing {
    const COLUMNS: u32 = 20;
    const ROWS: u32 = 16;
    let position = |i: u32| {
        let (x, y) = (i % (COLUMNS + 1), i / (COLUMNS + 1));
        let angle = (x as f32 / COLUMNS as f32 - 0.5) * 2.4;
        Vec3::new(0.05 * angle.sin(), 0.0046 * y as f32, 0.05 * angle.cos())
    };
    let positions: Vec<_> = (0..(COLUMNS + 1) * (ROWS + 1)).map(position).collect();
    let mut faces = Faces { positions, polygons: Vec::new() };
    let mut lines = Lines::default();
    let symbols = ["k", "k", "p", "p", "k", "y", "d12k", "kp", "k", "d123p"];
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let start = row * (COLUMNS + 1) + column;
        let corners = [start, start + 1, start + COLUMNS + 2, start + COLUMNS + 1];
        let symbol = symbols[((column + row / 4) % 10) as usize];
        faces.polygons.push(Polygon {
            vertices: corners.as_slice().into(),
            color: palette::StitchColors::Distinct.of(symbol, palette::YARN, row as usize),
        });
        let edge = |i: usize| [corners[i], corners[(i + 1) % 4]].map(|v| faces.positions[v as usize]);
        lines.segments.push(Segment { ends: edge(0), color: palette::COURSE_EDGE, width: 1.5 });
        lines.segments.push(Segment { ends: edge(3), color: palette::WALE_EDGE, width: 2.5 });
        if (row, column) == (7, 10) {
            let selected = |i| Segment { ends: edge(i), color: palette::SELECTED, width: 5.0 };
            lines.segments.extend((0..4).map(selected));
        }
    }
    Drawing { faces, lines, ..Default::default() }
}

#[test]
#[ignore = "draws pictures to look at; checks nothing"]
fn gallery() {
    let size = [1280, 960];
    let aspect = 4.0 / 3.0;
    let fabric = |wales, courses| Drawing { yarn: stockinette(wales, courses), ..Default::default() };
    let swatch = fabric(24, 26);
    let camera = Camera::named(NamedView::Front, swatch.bounds().unwrap(), aspect);
    save("front.png", &render_image(gpu(), size, &camera, &swatch).unwrap());
    let camera = Camera::named(NamedView::Back, swatch.bounds().unwrap(), aspect);
    save("back.png", &render_image(gpu(), size, &camera, &swatch).unwrap());
    let near = Camera { distance: 0.045, yaw: 0.4, pitch: 0.35, ..camera };
    save("near.png", &render_image(gpu(), size, &near, &swatch).unwrap());
    let mut draped = fabric(63, 63);
    draped.solids = Solids {
        solids: vec![
            Solid::Ground { height: -0.16 },
            Solid::Sphere { center: Vec3::new(0.02, -0.06, -0.11), radius: 0.1 },
        ],
    };
    let camera = Camera::named(NamedView::ThreeQuarter, draped.bounds().unwrap(), aspect);
    save("far.png", &render_image(gpu(), size, &camera, &draped).unwrap());
    let chart = stitch_chart();
    let camera = Camera::named(NamedView::ThreeQuarter, chart.bounds().unwrap(), aspect);
    save("stitches.png", &render_image(gpu(), size, &camera, &chart).unwrap());
}

#[test]
#[ignore = "measures; run with --nocapture on a quiet machine"]
fn frame_times() {
    let renderer = Renderer::new(gpu(), Quality::Interactive);
    let mut scene = Scene::new();
    let yarn = stockinette(64, 63);
    let bounds = Drawing { yarn: yarn.clone(), ..Default::default() }.bounds().unwrap();
    let camera = Camera::named(NamedView::Front, bounds, 16.0 / 9.0);
    for (zoom, size) in
        [1.0, 2.0, 4.0, 8.0].into_iter().flat_map(|zoom| [(zoom, [1280, 720]), (zoom, [640, 360])])
    {
        let viewport = Viewport::new(gpu(), &renderer, size).unwrap();
        let mut camera = camera;
        camera.zoom(zoom);
        let mut frame = || {
            let start = std::time::Instant::now();
            scene.set_yarn(gpu(), &YarnLayout::of(&yarn)).unwrap();
            let update = start.elapsed();
            let mut encoder = gpu().device.create_command_encoder(&Default::default());
            renderer.draw(gpu(), &mut encoder, &viewport, &camera, &scene);
            gpu().queue.submit([encoder.finish()]);
            gpu().device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            (start.elapsed(), update)
        };
        // The fastest of several: other programs only ever add.
        let (whole, update) = (0..12).map(|_| frame()).min().unwrap();
        println!("{size:?}, zoom {zoom}: {whole:.1?}, of which the update takes {update:.1?}");
    }
}

/// Squares in a row, each a little in front of the one before, with a line along the lower side of each.
fn row_of(colors: &[[f32; 3]]) -> Drawing {
    let place = |i: usize| Vec3::new(0.2 * i as f32 - 0.3, 0.02 * i as f32, 0.05 * i as f32);
    let faces = colors.iter().enumerate().map(|(i, c)| square(place(i), *c)).reduce(join).unwrap();
    let line = |i: usize| Segment {
        ends: [-0.1, 0.1].map(|x| place(i) + Vec3::new(x, -0.1, 0.01)),
        color: [0.0; 3],
        width: 3.0,
    };
    let lines = Lines { segments: (0..colors.len()).map(line).collect() };
    Drawing { faces, lines, ..Default::default() }
}

/// What has changed is drawn again in a part of the picture, and the picture is the same as if all of it were.
#[test]
fn a_part_drawn_again_is_as_if_all_were() {
    let gpu = gpu();
    let camera = Camera { yaw: 0.4, pitch: 0.3, distance: 2.5, ..Default::default() };
    let mark = |x: f32| Segment {
        ends: [Vec3::new(x, -0.05, 0.2), Vec3::new(x + 0.05, 0.0, 0.2)],
        color: [1.0, 0.5, 0.0],
        width: 4.0,
    };
    for quality in [Quality::Interactive, Quality::Still] {
        let renderer = Renderer::new(gpu, quality);
        let viewport = Viewport::new(gpu, &renderer, SIZE).unwrap();
        let picture = |scene: &mut Scene, all: bool| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if all {
                renderer.draw(gpu, &mut encoder, &viewport, &camera, scene);
            } else {
                renderer.redraw(gpu, &mut encoder, &viewport, &camera, scene);
            }
            gpu.queue.submit([encoder.finish()]);
            scene.settle();
            read_back(gpu, viewport.picture()).unwrap()
        };
        let mut scene = Scene::new();
        scene.set(gpu, &row_of(&[RED, RED, GREEN, RED])).unwrap();
        let mut old = picture(&mut scene, true);
        assert!(picture(&mut scene, false) == old, "nothing has changed");
        let changes: [&dyn Fn(&mut Scene); 6] = [
            &|scene| scene.set_colors(gpu, &[RED, GREEN, GREEN, RED]).unwrap(),
            &|scene| scene.set(gpu, &row_of(&[RED, GREEN, GREEN])).unwrap(),
            &|scene| scene.set(gpu, &row_of(&[RED, RED, GREEN, GREEN])).unwrap(),
            &|scene| scene.set_marks(gpu, &Lines { segments: vec![mark(-0.2), mark(0.1)] }).unwrap(),
            &|scene| scene.set_marks(gpu, &Lines { segments: vec![mark(0.1)] }).unwrap(),
            &|scene| scene.set_colors(gpu, &[GREEN, RED, GREEN, GREEN]).unwrap(),
        ];
        for (i, change) in changes.into_iter().enumerate() {
            change(&mut scene);
            let part = picture(&mut scene, false);
            let whole = picture(&mut scene, true);
            assert!(old != whole && part == whole, "change {i}");
            old = whole;
        }
    }
}

/// The comparison above would see what is left out: a change that is said to be drawn stays out of the part beside it.
#[test]
fn what_is_said_to_be_drawn_is_not_drawn_again() {
    let gpu = gpu();
    let camera = Camera { distance: 2.5, ..Default::default() };
    let renderer = Renderer::new(gpu, Quality::Interactive);
    if !gpu.is_software() {
        return; // with shadows all of a picture is drawn always
    }
    let viewport = Viewport::new(gpu, &renderer, SIZE).unwrap();
    let picture = |scene: &Scene, all: bool| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if all {
            renderer.draw(gpu, &mut encoder, &viewport, &camera, scene);
        } else {
            renderer.redraw(gpu, &mut encoder, &viewport, &camera, scene);
        }
        gpu.queue.submit([encoder.finish()]);
        read_back(gpu, viewport.picture()).unwrap()
    };
    let mut scene = Scene::new();
    scene.set(gpu, &row_of(&[RED, RED, RED, RED])).unwrap();
    picture(&scene, true);
    scene.set_colors(gpu, &[GREEN, RED, RED, RED]).unwrap();
    scene.settle();
    scene.set_colors(gpu, &[GREEN, RED, RED, GREEN]).unwrap();
    let part = picture(&scene, false);
    assert!(part != picture(&scene, true));
}
