//! Small fabrics of every construction.

use glam::DVec3;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::pieces::{rectangle, tube};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;

const WIDTH: f64 = 3e-3;

/// One fabric of each construction, and what it is called.
pub(crate) fn fabrics() -> [(&'static str, StitchMesh); 10] {
    let (wide, high) = (10, 10);
    let size = StitchSize::of_width(WIDTH);
    let flat = |symbol: &dyn Fn(usize, usize) -> &'static str| {
        let stitches = rectangle(wide, high, size).unwrap();
        with_symbols(stitches, &|face| symbol(face % wide, face / wide))
    };
    let shaped = |counts: &[usize]| rows(counts, size);
    [
        ("stockinette", flat(&|_, _| "k")),
        ("garter", flat(&|_, t| ["k", "p"][t % 2])),
        ("rib", flat(&|s, _| ["k", "k", "p", "p"][s % 4])),
        ("seed", flat(&|s, t| ["k", "p"][(s + t) % 2])),
        ("twisted", flat(&|s, _| ["k1", "p-1", "k", "p"][s % 4])),
        ("tube", tube(16, 8, size).unwrap()),
        ("increases", shaped(&[4, 4, 8, 8, 16, 16])),
        ("stacks", shaped(&[12, 12, 12, 4, 4, 4])),
        ("gathered top", shaped(&[16, 16, 16, 8, 4, 2])),
        ("mixed", shaped(&[8, 8, 4, 8, 8, 4, 4, 8])),
    ]
}

fn with_symbols(mut stitches: StitchMesh, symbol: &dyn Fn(usize) -> &'static str) -> StitchMesh {
    for face in 0..stitches.mesh().face_count() {
        stitches.set_stitch(FaceId::new(face), symbol(face).parse().unwrap()).unwrap();
    }
    stitches
}

/// A piece with so many loops in each row; where their number changes, all are joined or divided alike.
fn rows(counts: &[usize], size: StitchSize) -> StitchMesh {
    let width = size.width * counts.iter().copied().fold(0, usize::max) as f64;
    let row = |(level, count): (usize, &usize)| {
        let (count, y) = (*count, level as f64 * size.height);
        (0..=count).map(move |i| DVec3::new(i as f64 * width / count as f64, y, 0.0))
    };
    let positions: Vec<DVec3> = counts.iter().enumerate().flat_map(row).collect();
    let first = |level: usize| counts[..level].iter().map(|n| n + 1).sum::<usize>();
    let (mut faces, mut stitches): (Vec<Vec<u32>>, Vec<Stitch>) = Default::default();
    for (level, pair) in counts.windows(2).enumerate() {
        let columns = pair[0].min(pair[1]);
        let (below, above) = (pair[0] / columns, pair[1] / columns);
        for column in 0..columns {
            let bottom = (0..=below).map(|k| first(level) + column * below + k);
            let top = (0..=above).rev().map(|k| first(level + 1) + column * above + k);
            faces.push(bottom.chain(top).map(|v| v as u32).collect());
            stitches.push(Stitch::default_for(below, above, column % 2 == 1));
        }
    }
    StitchMesh::new(PolygonMesh::new(positions, &faces).unwrap(), stitches).unwrap()
}
