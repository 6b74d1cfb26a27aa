use super::*;
use std::time::Instant;
use stitch_mesh::autolabel::autolabel;
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::label::LabelledMesh;
use stitch_mesh::obj::{Unit, read_obj};
use stitch_mesh::tessellate::tessellate;

#[test]
fn spike() {
    let Ok(width) = std::env::var("WIDTH") else { return };
    let name = std::env::var("MESH").unwrap_or("../assets/meshes/pullover.obj".into());
    let unit = if name.contains("shared") { Unit::Dm } else { Unit::M };
    let mesh = read_obj(&std::fs::read(name).unwrap(), unit).unwrap();
    let labelled = autolabel(&LabelledMesh::new(mesh.clone()));
    let width: f64 = width.parse().unwrap();
    let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(width)).unwrap();
    let stitches = tessellate(&labelled, &counts).unwrap();
    let start = Instant::now();
    let mut r = MeshRelaxation::new(&stitches, Some(&mesh), RelaxParams::default()).unwrap();
    println!("{} faces, new {:?}", stitches.mesh().face_count(), start.elapsed());
    let rms = |s: &[f64]| (s.iter().map(|s| s * s).sum::<f64>() / s.len() as f64).sqrt();
    println!("strain before: rms {:.4} worst {:?}", rms(&r.strain()), r.worst(3));
    r.run(&mut |_, f| {
        println!("{:?} {f:?}", start.elapsed());
        ControlFlow::Continue(())
    });
    let end = r.stitches().unwrap();
    let How::OnSurface(inner) = &r.how else { panic!() };
    let folded = end
        .mesh()
        .faces()
        .flat_map(|f| elements::sub_quads(&end, f))
        .filter(|q| {
            let p = q.map(|v| inner.x[v as usize]);
            (0..4).any(|k| {
                let (a, j, b) = (p[(k + 3) % 4], p[k], p[(k + 1) % 4]);
                use relaxer::Domain as _;
                let n = inner.domain.normal(&inner.places[q[k] as usize]);
                n.dot((b - j).cross(a - j)) <= 0.0
            })
        })
        .count();
    println!("strain folded sub-quads {folded}");
    println!("strain after: rms {:.4} worst {:?}", rms(&r.strain()), r.worst(3));
}
