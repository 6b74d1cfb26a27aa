//! The garments that come with the program: in any number of loops, sewn, worn.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, which clippy cannot see")]

use app::bundled::{ALL, find};
use app::fabric::Fabric;
use app::project::Project;
use glam::DVec3;
use sim_core::Simulator;
use stitch_mesh::ids::VertexId;
use stitch_mesh::stitch_mesh::StitchMesh;
use tests::Program;

#[test]
fn a_garment_comes_in_any_number_of_loops() {
    let sweater = find("sweater").unwrap();
    for loops in [1_000, 2_000, 6_000, 56_000] {
        let project = sweater.of_loops(loops).unwrap();
        let fabric = project.fabric().unwrap();
        let got = fabric.stitches.loop_count() as f64;
        assert!((0.93..1.07).contains(&(got / loops as f64)), "{got} loops for {loops}");
        // Sides, shoulders, two halves of each armhole, along both sleeves.
        assert_eq!(fabric.stitches.seams().len(), 10);
        assert_eq!(app::inspect::inspect(&project).problems, []);
    }
    assert!(sweater.of_loops(100_000_000).is_err());
}

#[test]
fn everything_bundled_is_known_by_its_name() {
    let program = Program::new(env!("CARGO_BIN_EXE_purlwise-tested"));
    for bundled in &ALL {
        let facts = program.json(&["new", bundled.name, "-o", "a.purl", "--stitch-size", "20"]);
        assert_eq!(facts["problems"], serde_json::json!([]), "{}", bundled.name);
        let stitches = facts["stitches"].as_object().unwrap();
        let garter = ["sweater", "t-shirt"].contains(&bundled.name);
        let count = |s: &str| stitches.get(s).and_then(serde_json::Value::as_f64).unwrap_or(0.0);
        assert_eq!(garter, count("p") > 0.9 * count("k"), "{}: {stitches:?}", bundled.name);
    }
    let unknown = program.run(&["new", "sweatre", "-o", "a.purl"]);
    assert!(unknown.status == Some(1) && unknown.stderr.contains("sweatre"), "{}", unknown.stderr);
}

/// Largest distance of a stitch on one side of a seam from the nearest on the other [stitch widths].
fn widest_gap(stitches: &StitchMesh, simulator: &Simulator, width: f64) -> f64 {
    let mesh = stitches.mesh();
    let mut middles = vec![(DVec3::ZERO, 0.0); mesh.face_count()];
    for (node, x) in simulator.net().nodes.iter().zip(&simulator.state().position) {
        if let Some(face) = node.face {
            let (sum, count) = &mut middles[face.index()];
            (*sum, *count) = (*sum + *x, *count + 1.0);
        }
    }
    let middle = |w: &[VertexId]| {
        let h = mesh.half_edge_between(w[0], w[1]).or_else(|| mesh.half_edge_between(w[1], w[0])).unwrap();
        let (sum, count) = middles[mesh.face(h).index()];
        sum / count
    };
    let mut widest: f64 = 0.0;
    for seam in stitches.seams() {
        let b: Vec<DVec3> = seam.b.windows(2).map(middle).collect();
        for a in seam.a.windows(2).map(middle) {
            widest = widest.max(b.iter().map(|x| x.distance(a)).fold(f64::INFINITY, f64::min) / width);
        }
    }
    widest
}

/// The fabric after 0.9 s of the scene of `project`: fallen, its seams closed.
fn worn(project: &Project, fabric: &Fabric) -> Simulator {
    let state = (*fabric.state()).clone();
    let mut simulator =
        Simulator::new(fabric.net(), project.materials.clone(), project.scene.clone(), state).unwrap();
    while simulator.time_s() < 0.9 {
        simulator.step().unwrap();
    }
    simulator
}

#[test]
fn the_sweater_is_worn_and_its_seams_hold() {
    let project = find("sweater").unwrap().of_loops(1_000).unwrap();
    let sewn = project.fabric().unwrap();
    let simulator = worn(&project, sewn);
    let facts = simulator.facts();
    let gap = |simulator: &Simulator| widest_gap(&sewn.stitches, simulator, project.size.width);
    let lowest = |s: &Simulator| s.state().position.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    println!("gap {:.2}, lowest {:.3} {facts:?}", gap(&simulator), lowest(&simulator));
    assert!(gap(&simulator) < 3.0 && lowest(&simulator) > -0.1);
    assert!(facts.max_stretch < 0.02 && facts.max_penetration_mm < 3.0 && facts.rejected_steps < 5);
    // Without its seams it comes off her.
    let mut stitches = (*sewn.stitches).clone();
    let edges: Vec<[VertexId; 2]> = stitches.seams().iter().map(|s| [s.a[0], s.a[1]]).collect();
    assert_eq!(stitches.unsew(&edges), 10);
    let simulator = worn(&project, &Fabric::new(stitches));
    println!("unsewn: gap {:.2}", gap(&simulator));
    assert!(gap(&simulator) > 6.0);
}
