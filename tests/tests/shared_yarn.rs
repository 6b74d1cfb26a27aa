//! Yarn that is simulated on the device that it is drawn on: the same picture as through the CPU.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::window::screen::laid;
use image::RgbaImage;
use render::{Camera, Drawing, Quality, Renderer, Scene, Viewport, YarnLayout, read_back};
use sim_core::{
    GpuDevice, Material, Materials, SharedGpu, SimCommand, SimThread, Snapshot, SolverChoice, curves,
};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;
use stitch_mesh::dye::Dye;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::yarn_net::YarnNet;
use tests::{gpu, picture_folder};

const SIZE: [u32; 2] = [640, 480];

/// How far away it is looked at from, against the whole in the picture, and the part of its pixels that may differ clearly. From
/// far away yarn is ribbons, whose outlines differ by rounding; in tubes that are seen from close by its plies begin elsewhere.
const DISTANCES: [(&str, f32, f64); 2] = [("far", 4.0, 0.02), ("near", 0.5, 0.15)];

fn picture(scene: &Scene, camera: &Camera, name: &str) -> RgbaImage {
    let gpu = gpu();
    let renderer = Renderer::new(gpu, Quality::Still);
    let viewport = Viewport::new(gpu, &renderer, SIZE).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.draw(gpu, &mut encoder, &viewport, camera, scene);
    gpu.queue.submit([encoder.finish()]);
    let image = read_back(gpu, viewport.picture()).unwrap();
    image.save(picture_folder().join(format!("{name}.png"))).unwrap();
    image
}

/// Part of the pixels of the yarn that differ clearly, 0…1.
fn difference(a: &RgbaImage, b: &RgbaImage, background: &RgbaImage) -> f64 {
    let unlike = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..3).any(|c| a[c].abs_diff(b[c]) > 40);
    let count = |a: &RgbaImage, b| a.pixels().zip(RgbaImage::pixels(b)).filter(|(a, b)| unlike(a, b)).count();
    count(a, b) as f64 / count(a, background) as f64
}

/// A few steps of a net in a simulation thread on the device of the renderer.
fn simulated(net: YarnNet) -> (Arc<Snapshot>, Materials) {
    let shared = GpuDevice::of(gpu().adapter_info.clone(), &gpu().device, &gpu().queue).unwrap();
    let (seen, snapshots) = channel();
    let see =
        Box::new(move |snapshot: Option<&Arc<Snapshot>>| seen.send(snapshot.cloned()).unwrap_or_default());
    let thread = SimThread::spawn(SharedGpu::from(shared), see).unwrap();
    let materials = Materials::from(Material::for_loop_width(3e-3));
    let scene = sim_core::Scene::empty();
    thread.send(SimCommand::SetSolver(SolverChoice::Gpu));
    thread.send(SimCommand::Load { net: Arc::new(net), materials: materials.clone(), scene, state: None });
    (0..4).for_each(|_| _ = thread.send(SimCommand::StepOnce));
    loop {
        let seen = snapshots.recv_timeout(Duration::from_secs(60)).unwrap();
        if let Some(snapshot) = seen.filter(|s| s.time_s > 0.0) {
            assert_eq!((snapshot.solver, &snapshot.notice, &snapshot.error), ("gpu", &None, &None));
            return (snapshot, materials);
        }
    }
}

#[test]
fn yarn_is_drawn_where_it_is_simulated() {
    let size = StitchSize::of_width(3e-3);
    let mut flat = lay(&rectangle(10, 8, size).unwrap());
    let blue = Dye([0x20, 0x60, 0xc0]);
    let half = flat.visits.len() / 2;
    Arc::make_mut(&mut flat.visits)[half..].iter_mut().for_each(|v| v.dye = blue);
    for (name, net) in [("flat", flat), ("tube", lay(&tube(14, 5, size).unwrap()))] {
        let (snapshot, materials) = simulated(net);
        assert!(snapshot.curves.curves.is_empty());
        let yarn = curves(&snapshot.net, &snapshot.state, &materials);
        let moved = curves(&snapshot.net, &snapshot.net.laid_state(), &materials);
        let whole = Drawing { yarn, ..Drawing::default() };
        let fitted = Camera::named(render::NamedView::ThreeQuarter, whole.bounds().unwrap(), 4.0 / 3.0);
        let mut drawn = Scene::new();
        drawn.set(gpu(), &whole).unwrap();
        let mut shared = Scene::new();
        shared.share_yarn(laid(snapshot.on_device.as_ref().unwrap()));
        let mut elsewhere = Scene::new();
        elsewhere.set_yarn(gpu(), &YarnLayout::of(&moved)).unwrap();
        for (distance, away, most) in DISTANCES {
            let camera = Camera { distance: away * fitted.distance, ..fitted };
            let shown =
                |scene: &Scene, how: &str| picture(scene, &camera, &format!("yarn-{name}-{distance}-{how}"));
            let background = shown(&Scene::new(), "background");
            let (ours, theirs) = (shown(&drawn, "curves"), shown(&shared, "shared"));
            let unlike = difference(&ours, &theirs, &background);
            let wrong = difference(&shown(&elsewhere, "laid"), &theirs, &background);
            println!(
                "{name}, {distance}: {unlike:.4} of the pixels differ, {wrong:.4} from the yarn as laid"
            );
            assert!(unlike < most, "{name}, {distance}: {unlike}");
            assert!(wrong > 2.0 * most, "{name}, {distance}: {wrong}");
        }
    }
}
