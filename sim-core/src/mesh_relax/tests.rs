use super::surface::Place;
use super::*;
use crate::bvh::{nearest_on_segment, nearest_on_triangle};
use crate::noise::unit_hash;
use stitch_mesh::autolabel::autolabel;
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::label::LabelledMesh;
use stitch_mesh::obj::{Unit, read_obj};
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::tessellate::tessellate;

const HAT: &[u8] = include_bytes!("../../../assets/meshes/hat.obj");
const PULLOVER: &[u8] = include_bytes!("../../../assets/meshes/pullover.obj");

fn knitted(obj: &[u8], width: f64) -> (PolygonMesh, StitchMesh) {
    let mesh = read_obj(obj, Unit::M).unwrap();
    let labelled = autolabel(&LabelledMesh::new(mesh.clone()));
    let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(width)).unwrap();
    (mesh, tessellate(&labelled, &counts).unwrap())
}

fn relaxed(stitches: &StitchMesh, input: Option<&PolygonMesh>, params: RelaxParams) -> MeshRelaxation {
    let mut relaxation = MeshRelaxation::new(stitches, input, params).unwrap();
    let mut energy = f64::INFINITY;
    let end = relaxation.run(&mut |_, facts| {
        assert!(facts.energy <= energy, "{facts:?}");
        energy = facts.energy;
        ControlFlow::Continue(())
    });
    assert_eq!(end, RelaxEnd::Settled);
    relaxation
}

/// Coefficient of variation of edge length over rest length.
fn unevenness(stitches: &StitchMesh, rest: RestLengths) -> f64 {
    let mesh = stitches.mesh();
    let ratios: Vec<f64> = mesh
        .edges()
        .map(|e| {
            let is_wale = stitches.is_wale(mesh.edge_sides(e).0);
            mesh.edge_length(e) / if is_wale { rest.wale } else { rest.course }
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    (ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / ratios.len() as f64).sqrt() / mean
}

/// Sub-quads with a corner that is folded over.
fn folded(relaxation: &MeshRelaxation) -> usize {
    let How::OnSurface(inner) = &relaxation.how else { panic!("not on a surface") };
    let stitches = &relaxation.stitches;
    let quads = stitches.mesh().faces().flat_map(|f| elements::sub_quads(stitches, f));
    let is_folded = |quad: &[u32; 4]| {
        let p = quad.map(|v| inner.x[v as usize]);
        (0..4).any(|k| {
            let normal = inner.domain.normal(&inner.places[quad[k] as usize]);
            normal.dot((p[(k + 1) % 4] - p[k]).cross(p[(k + 3) % 4] - p[k])) <= 0.0
        })
    };
    quads.filter(is_folded).count()
}

/// A tube of the usual stitches and the coarse mesh that it was cut from, the stitches badly distorted along and around it.
fn distorted_tube() -> (PolygonMesh, StitchMesh) {
    let (around, high) = (48, 40);
    let size = StitchSize::of_width(4e-3);
    let input = tube(12, 5, StitchSize { width: 16e-3, height: 24e-3 }).unwrap().mesh().clone();
    let stitches = tube(around, high, size).unwrap();
    let [low, high] = input.bounds();
    let radius = high.z;
    let shift = |p: &DVec3| {
        let turn = p.x.atan2(p.z);
        let t = (p.y - stitches.mesh().bounds()[0].y)
            / (stitches.mesh().bounds()[1].y - stitches.mesh().bounds()[0].y);
        // Edges from a third to two and a half times as long as they should be.
        let turn = turn + 0.7 * turn.sin() + 0.1 * (7.0 * t).sin();
        let t = t + 0.11 * (std::f64::consts::TAU * t).sin();
        DVec3::new(radius * turn.sin(), low.y + t * (high.y - low.y), radius * turn.cos())
    };
    let positions = stitches.mesh().positions().iter().map(shift).collect();
    (input, stitches.moved_to(positions).unwrap())
}

#[test]
fn a_distorted_tube_becomes_even() {
    let (input, stitches) = distorted_tube();
    let relaxation = relaxed(&stitches, Some(&input), RelaxParams::default());
    let (before, after) = (
        unevenness(&stitches, relaxation.rest()),
        unevenness(&relaxation.stitches().unwrap(), relaxation.rest()),
    );
    assert!(before > 0.3 && after < before / 15.0, "{before} to {after}");
    assert_eq!(folded(&relaxation), 0);
    // The fill of 0.95: 1/√0.95 is 2.6 % over.
    let mean = relaxation.strain().iter().sum::<f64>() / relaxation.strain().len() as f64;
    assert!((mean - 0.026).abs() < 0.01, "{mean}");
    assert!(relaxation.worst(3).windows(2).all(|w| w[0].1.abs() >= w[1].1.abs()));
}

#[test]
fn vertices_stay_on_the_surface_and_borders_on_borders() {
    let (input, stitches) = knitted(PULLOVER, 12e-3);
    let relaxation = relaxed(&stitches, Some(&input), RelaxParams::default());
    let How::OnSurface(inner) = &relaxation.how else { panic!("not on a surface") };
    let (surface, unit) = (&inner.domain, relaxation.rest().unit());
    let [low, high] = input.bounds();
    let near = 1e-6 * low.distance(high);
    let mesh = stitches.mesh();
    let mut at_border = vec![false; mesh.vertex_count()];
    for e in mesh.edges().filter(|e| mesh.is_border(*e)) {
        mesh.edge_ends(e).iter().for_each(|v| at_border[v.index()] = true);
    }
    let mut checked = 0;
    for (v, p) in relaxation.positions().iter().enumerate() {
        let p = *p / unit;
        if at_border[v] {
            checked += 1;
            assert!(!matches!(inner.places[v], Place::Inside { .. }));
            let segments = surface.border_starts.windows(2).flat_map(|s| s[0]..s[1] - 1);
            let distance = segments.map(|s| {
                let [a, b] = surface.segment(s as usize);
                a.lerp(b, nearest_on_segment([a, b], p)).distance(p)
            });
            assert!(distance.fold(f64::INFINITY, f64::min) * unit < near, "vertex {v} left the border");
        } else if v.is_multiple_of(7) {
            let distance = (0..surface.triangles.len()).map(|t| {
                let [a, b, c] = surface.corners(t);
                let at = nearest_on_triangle([a, b, c], p);
                (at[0] * a + at[1] * b + at[2] * c).distance(p)
            });
            assert!(distance.fold(f64::INFINITY, f64::min) * unit < near, "vertex {v} left the surface");
        }
    }
    assert!(checked > 100);
    let unevenness = |s: &StitchMesh| unevenness(s, relaxation.rest());
    assert!(unevenness(&relaxation.stitches().unwrap()) < 0.75 * unevenness(&stitches));
}

#[test]
fn in_space_a_distorted_rectangle_finds_its_rest_shape() {
    let piece = rectangle(14, 12, StitchSize::of_width(4e-3)).unwrap();
    let noise = |i: usize| 1.6e-3 * (unit_hash(i as u64) - 0.5);
    let distort = |(v, p): (usize, &DVec3)| {
        let z = 0.5e-3 * (200.0 * p.x).sin() + noise(3 * v + 2);
        DVec3::new(1.3 * p.x + 0.4 * p.y + noise(3 * v), 0.8 * p.y + noise(3 * v + 1), z)
    };
    let positions = piece.mesh().positions().iter().enumerate().map(distort).collect();
    let distorted = piece.moved_to(positions).unwrap();
    let params = RelaxParams { fill: 1.0, tolerance: 1e-4, ..RelaxParams::default() };
    let relaxation = relaxed(&distorted, None, params);
    let rest = relaxation.rest();
    let strain = relaxation.strain();
    assert!(strain.iter().all(|s| s.abs() < 0.01), "{:?}", relaxation.worst(1));
    let (mesh, at) = (distorted.mesh(), relaxation.positions());
    for face in mesh.faces() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| at[mesh.face_vertices(face).nth(i).unwrap().index()]);
        assert!((a.distance(c) / rest.course.hypot(rest.wale) - 1.0).abs() < 0.01);
        assert!((b.distance(d) / rest.course.hypot(rest.wale) - 1.0).abs() < 0.01);
    }
}

#[test]
fn the_crown_of_a_hat_does_not_fold() {
    let (input, stitches) = knitted(HAT, 8e-3);
    assert_eq!(folded(&relaxed(&stitches, Some(&input), RelaxParams::default())), 0);
    let without = RelaxParams { fold: 0.0, ..RelaxParams::default() };
    assert!(folded(&relaxed(&stitches, Some(&input), without)) > 0, "it would without the resistance");
}

#[test]
fn the_same_twice_and_with_any_number_of_threads() {
    let (input, stitches) = knitted(HAT, 9e-3);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| relaxed(&stitches, Some(&input), RelaxParams::default()).positions())
    };
    let first = run(1);
    assert!(first == run(3) && first == run(2));
}

#[test]
fn what_is_relaxed_stays_where_it_is() {
    let (input, stitches) = distorted_tube();
    let first = relaxed(&stitches, Some(&input), RelaxParams::default());
    let again = relaxed(&first.stitches().unwrap(), Some(&input), RelaxParams::default());
    let (a, b) = (first.positions(), again.positions());
    let furthest = a.iter().zip(&b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(furthest < 0.05 * first.rest().course, "moved by {furthest} m");
}

#[test]
fn a_run_can_be_watched_and_broken_off() {
    let (input, stitches) = distorted_tube();
    let mut relaxation = MeshRelaxation::new(&stitches, Some(&input), RelaxParams::default()).unwrap();
    let before = relaxation.positions();
    let mut seen = Vec::new();
    let end = relaxation.run(&mut |now, facts| {
        assert!(now.positions() != before && now.strain().len() == stitches.mesh().face_count());
        seen.push(facts.step);
        if facts.step == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!((end, &seen[..], relaxation.is_settled()), (RelaxEnd::Interrupted, &[1, 2][..], false));
    assert_eq!(relaxation.run(&mut |_, _| ControlFlow::Continue(())), RelaxEnd::Settled);
    let at = relaxation.positions();
    relaxation.step();
    assert_eq!(relaxation.positions(), at, "nothing moves once it is settled");
}

#[test]
fn absurd_wishes_are_refused() {
    let piece = rectangle(3, 3, StitchSize::of_width(4e-3)).unwrap();
    let error = |params| MeshRelaxation::new(&piece, None, params).err().unwrap().to_string();
    let usual = RelaxParams::default();
    assert_eq!(
        error(RelaxParams { fill: 0.0, ..usual }),
        "the fill is 0; it has to be above 0 (0.01) and at most 1"
    );
    assert!(error(RelaxParams { aspect: f64::NAN, ..usual }).contains("aspect of a stitch is NaN"));
    assert!(error(RelaxParams { stretch: -1.0, ..usual }).contains("stretch"));
    let huge = piece.mesh().positions().iter().map(|p| *p * 1e200).collect();
    let huge = piece.moved_to(huge).ok().and_then(|p| MeshRelaxation::new(&p, None, usual).err());
    assert!(huge.is_none_or(|e| matches!(e, RelaxError::Area(_))));
}

#[test]
fn nothing_is_ever_not_a_number() {
    // All vertices of a row but its ends in nearly one place.
    let piece = rectangle(8, 6, StitchSize::of_width(4e-3)).unwrap();
    let crowded = |p: &DVec3| DVec3::new(if p.x.abs() < 15e-3 { 1e-5 * p.x } else { p.x }, p.y, 0.0);
    let positions = piece.mesh().positions().iter().map(crowded).collect();
    let crowded = piece.moved_to(positions).unwrap();
    for surface in [None, Some(piece.mesh())] {
        let relaxation = relaxed(&crowded, surface, RelaxParams::default());
        assert!(relaxation.positions().iter().all(|p| p.is_finite()));
        assert!(relaxation.strain().iter().all(|s| s.abs() < 0.3), "{:?}", relaxation.worst(2));
    }
}
