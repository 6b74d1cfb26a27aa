//! Fig. 23 of Yuksel et al. in the window: too few stitches under an arm show red, their counts are changed, and it is even.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use app::project::Project;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec3, Vec4};
use render::{Bounds, Camera, NamedView};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::Unit;
use tests::asset;
use tests::window::Window;

const NONE: Modifiers = Modifiers::NONE;

/// Course edges under the left arm, by their vertices: the last four rows of edges below the armhole.
fn under_the_arm(mesh: &PolygonMesh) -> Vec<[u32; 2]> {
    let ends = mesh.edges().map(|e| mesh.edge_ends(e));
    let under = ends.filter(|ends| {
        let [a, b] = ends.map(|v| mesh.position(v));
        let middle = (a + b) / 2.0;
        (a.y - b.y).abs() < 0.006 && middle.x > 0.13 && (0.15..0.215).contains(&middle.y)
    });
    under.map(|ends| ends.map(|v| v.0)).collect()
}

/// A pullover with a single stitch on each of these edges.
fn tight(edges: &[[u32; 2]]) -> Project {
    let mut project =
        Project::from_obj(asset("pullover").as_ref(), Unit::M, StitchSize::of_width(0.012)).unwrap();
    let steps = [
        Command::Autolabel,
        Command::Tessellate { width_mm: Some(12.0) },
        Command::SetEdgeCounts { edges: edges.to_vec(), count: 1 },
        Command::Tessellate { width_mm: None },
    ];
    for step in steps {
        project = step.apply(&project).unwrap();
    }
    project
}

/// Presses the button and watches until it is done. Returns how many states were seen on the way.
fn relax(window: &mut Window) -> usize {
    window.press("Finish");
    window.harness.get_by_label("Relax mesh").click();
    let mut seen = std::collections::BTreeSet::new();
    loop {
        window.harness.step();
        seen.extend(window.editor().watched());
        if window.editor().is_idle() && window.says("Relax stitches") && window.editor().watched().is_none() {
            window.rest();
            return seen.len();
        }
    }
}

/// Pixels that are clearly red.
fn red(picture: &image::RgbaImage) -> usize {
    let is_red = |[r, g, b]: [u32; 3]| r > 130 && r > 2 * g && r > 2 * b;
    picture.pixels().filter(|p| is_red([0, 1, 2].map(|i| u32::from(p[i])))).count()
}

fn strains(window: &Window) -> (f64, u32) {
    let fabric = window.editor().project().fabric().unwrap();
    let strain = app::relax::mesh_strain(&fabric.stitches, 0.75).unwrap();
    let most = strain.worst.iter().max_by(|a, b| a.strain.total_cmp(&b.strain)).unwrap();
    (strain.max, most.face)
}

/// Where a point is on the screen, seen from the right.
fn seen_from_the_right(window: &Window, mesh: &PolygonMesh, point: DVec3) -> Pos2 {
    let rect = window.viewport();
    let bounds = Bounds::of(mesh.positions().iter().map(|p| p.as_vec3())).unwrap();
    let camera = Camera::named(NamedView::Right, bounds, rect.aspect_ratio());
    let p: Vec4 = camera.view_projection(rect.aspect_ratio()) * point.as_vec3().extend(1.0);
    rect.min + rect.size() * egui::vec2(0.5 + 0.5 * p.x / p.w, 0.5 - 0.5 * p.y / p.w)
}

#[test]
fn too_few_stitches_under_an_arm_show_red_and_are_mended() {
    let mesh = Project::from_obj(asset("pullover").as_ref(), Unit::M, StitchSize::of_width(0.012)).unwrap();
    let mesh = mesh.labelled.mesh().clone();
    let edges = under_the_arm(&mesh);
    assert_eq!(edges.len(), 18);
    let mut window = Window::new(tight(&edges));

    window.press("Stitches");
    assert!(relax(&mut window) > 1, "the stitches are watched on their way");
    window.key(NONE, Key::Num8);
    let (tight, worst) = strains(&window);
    assert!(tight > 0.5, "{tight}");
    let fabric = window.editor().project().fabric().unwrap();
    let middle = fabric.stitches.mesh().face_center(stitch_mesh::ids::FaceId(worst));
    assert!(middle.x > 0.12 && middle.y > 0.13, "the worst stitch is under the arm: {middle}");
    assert!(window.says(&format!("stitch {worst}: {:.0} % stretched", 100.0 * tight)));
    let red_before = red(&window.keep("tight-under-the-arm"));
    assert!(red_before > 2000, "{red_before}");

    window.press("Labels");
    window.key(NONE, Key::Num1);
    window.key(NONE, Key::Num8);
    let place = |[a, b]: &[u32; 2]| {
        let edge = mesh.edge_between(stitch_mesh::ids::VertexId(*a), stitch_mesh::ids::VertexId(*b)).unwrap();
        let face = mesh.face(mesh.edge_sides(edge).0);
        let middle = (mesh.position(mesh.edge_ends(edge)[0]) + mesh.position(mesh.edge_ends(edge)[1])) / 2.0;
        seen_from_the_right(&window, &mesh, middle.lerp(mesh.face_center(face), 0.15))
    };
    let places: Vec<Pos2> = edges.iter().map(place).collect();
    window.click_all(&places);
    assert_eq!(window.editor().selection().edges.len(), edges.len());
    window.press("+");
    window.press("+");
    window.keep("counts-under-the-arm");
    window.press("Tessellate");
    relax(&mut window);
    window.key(NONE, Key::Num8);
    let (even, _) = strains(&window);
    let red_after = red(&window.keep("even-under-the-arm"));
    assert!(even < 0.25, "{even}");
    // The end of the legend is red as well.
    assert!(5 * red_after < red_before, "{red_before}, then {red_after}");
}
