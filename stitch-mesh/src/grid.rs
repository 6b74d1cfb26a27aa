//! A rectangle of faces, labelled in rows: the plainest input there is, for tests.

use crate::label::LabelledMesh;
use crate::mesh::PolygonMesh;
use glam::DVec3;

/// `wide` × `high` square faces of 10 mm in the plane z = 0.
pub fn plain_grid(wide: usize, high: usize) -> PolygonMesh {
    let at = |i: usize| DVec3::new((i % (wide + 1)) as f64, (i / (wide + 1)) as f64, 0.0) * 0.01;
    let positions = (0..(wide + 1) * (high + 1)).map(at).collect();
    let face = |i: usize| {
        let corner = (i / wide * (wide + 1) + i % wide) as u32;
        let up = wide as u32 + 1;
        vec![corner, corner + 1, corner + 1 + up, corner + up]
    };
    let faces: Vec<Vec<u32>> = (0..wide * high).map(face).collect();
    PolygonMesh::new(positions, &faces).expect("a grid is a mesh")
}

/// The same, labelled: rows along x, knitted upwards.
pub fn grid(wide: usize, high: usize) -> LabelledMesh {
    let mut labelled = LabelledMesh::new(plain_grid(wide, high));
    let base = labelled.mesh().edge(labelled.mesh().first_half_edge(crate::ids::FaceId(0)));
    labelled.fill_from_border(base).expect("its lower side is a border");
    crate::autolabel::autolabel(&labelled)
}
