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
    println!("strain after: rms {:.4} worst {:?}", rms(&r.strain()), r.worst(3));
}
