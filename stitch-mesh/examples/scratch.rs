use ::stitch_mesh::*;
fn main() {
    for a in std::env::args().skip(1) {
        let m = obj::read_obj(&std::fs::read(&a).unwrap(), obj::Unit::M);
        let m = match m {
            Ok(m) => m,
            Err(e) => {
                println!("{a}: {e}");
                continue;
            }
        };
        let t = std::time::Instant::now();
        let l = autolabel::autolabel(&label::LabelledMesh::new(m));
        let p = l.problems();
        println!(
            "{a}: {} faces, {} rows, {} problems {:?}",
            l.mesh().face_count(),
            l.rows().len(),
            p.len(),
            t.elapsed()
        );
        for p in p.iter().take(12) {
            println!("   {p}");
        }
        if p.is_empty() {
            let c = tessellate::EdgeCounts::from_size(&l, tessellate::StitchSize::of_width(0.01)).unwrap();
            match tessellate::tessellate(&l, &c) {
                Ok(s) => {
                    let n = lay::lay(&s);
                    println!(
                        "   {} stitches {} rows {} nodes {} yarns {:?}",
                        s.loop_count(),
                        s.rows().len(),
                        n.nodes.len(),
                        n.yarns.len(),
                        t.elapsed()
                    );
                }
                Err(e) => println!("   {e}"),
            }
        }
    }
}
