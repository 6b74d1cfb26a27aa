//! Fabrics of every topology, small enough to be edited thousands of times.

use app::command::Command;
use app::fabric::Fabric;
use app::project::Project;
use glam::DVec3;
use std::f64::consts::TAU;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::Unit;
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;

/// How many fabrics there are.
pub const COUNT: usize = 7;

fn size() -> StitchSize {
    StitchSize::of_width(0.004)
}

/// A project whose stitches are given.
pub fn project_of(stitches: StitchMesh) -> Project {
    let mut project = Project::new(stitches.mesh().clone(), size());
    project.fabric = Some(Fabric::new(stitches));
    project
}

/// All quadrilaterals knit.
fn knit(positions: Vec<DVec3>, faces: &[Vec<u32>]) -> StitchMesh {
    let mesh = PolygonMesh::new(positions, faces).unwrap();
    let stitches = vec![Stitch::knit(); mesh.face_count()];
    StitchMesh::new(mesh, stitches).unwrap()
}

/// A flat piece with a hole of two stitches.
fn with_hole() -> StitchMesh {
    let whole = rectangle(6, 5, size()).unwrap();
    let mut faces = whole.mesh().face_lists();
    faces.drain(14..16);
    knit(whole.mesh().positions().to_vec(), &faces)
}

/// Two legs that meet in a body, all knitted upwards: at the crotch the tops of one leg meet those of the other.
pub fn trousers() -> StitchMesh {
    const HALF: u32 = 4;
    const HIGH: usize = 3;
    let mut positions = Vec::new();
    let mut ring = |count: u32, x: f64, y: f64, radius: f64| -> Vec<u32> {
        let first = positions.len() as u32;
        for i in 0..count {
            let angle = f64::from(i) / f64::from(count) * TAU;
            positions.push(DVec3::new(x + radius * angle.sin(), y, radius * angle.cos()) * 0.004);
        }
        (first..first + count).collect()
    };
    let joint = ring(2 * HALF, 0.0, 0.0, 1.3);
    let mut tubes: Vec<Vec<Vec<u32>>> = Vec::new();
    for (x, mut top) in [(0.7, joint[..=HALF as usize].to_vec()), (-0.7, joint[HALF as usize..].to_vec())] {
        if x < 0.0 {
            top.push(joint[0]);
        }
        let mut rings: Vec<Vec<u32>> =
            (0..HIGH).map(|j| ring(HALF + 1, x, j as f64 - HIGH as f64, 0.6)).collect();
        rings.push(top);
        tubes.push(rings);
    }
    let mut body = vec![joint];
    body.extend((1..=HIGH).map(|j| ring(2 * HALF, 0.0, j as f64, 1.3)));
    tubes.push(body);
    let mut faces = Vec::new();
    for rings in &tubes {
        for pair in rings.windows(2) {
            let n = pair[0].len();
            for i in 0..n {
                let next = (i + 1) % n;
                faces.push(vec![pair[0][i], pair[0][next], pair[1][next], pair[1][i]]);
            }
        }
    }
    knit(positions, &faces)
}

/// A rectangle of faces cut into stitches that widen, narrow, and in one row run the other way.
fn shaped() -> Project {
    let big = rectangle(3, 4, StitchSize { width: 0.012, height: 0.009 }).unwrap();
    let edge = |i: u32| [4 * i + 1, 4 * i + 2];
    [
        Command::Autolabel,
        Command::FlipRow { face: 7 },
        Command::SetEdgeCounts { edges: vec![edge(1), edge(4)], count: 5 },
        Command::SetEdgeCounts { edges: vec![edge(2)], count: 1 },
        Command::Tessellate { width_mm: None },
    ]
    .iter()
    .fold(Project::new(big.mesh().clone(), size()), |project, command| command.apply(&project).unwrap())
}

/// The hat that ships with the program, whose stitches gather at its tip.
fn hat() -> Project {
    let path = crate::asset("hat");
    let project = Project::from_obj(path.as_ref(), Unit::M, StitchSize::of_width(0.06)).unwrap();
    let labelled = Command::Autolabel.apply(&project).unwrap();
    Command::Tessellate { width_mm: Some(60.0) }.apply(&labelled).unwrap()
}

/// One of the fabrics.
pub fn fabric(which: usize) -> Project {
    match which % COUNT {
        0 => project_of(rectangle(6, 5, size()).unwrap()),
        1 => project_of(tube(7, 5, size()).unwrap()),
        2 => project_of(tube(3, 4, size()).unwrap()),
        3 => project_of(with_hole()),
        4 => project_of(trousers()),
        5 => shaped(),
        _ => hat(),
    }
}
