//! A polygon mesh in the making, and its OBJ file.

use glam::DVec3;
use std::collections::HashMap;
use std::fmt::Write as _;

/// A mesh in the making: vertices are named by any key, so that faces that share a vertex say so by sharing its name.
#[derive(Default)]
pub struct Mesh {
    vertices: Vec<DVec3>,
    names: HashMap<[i32; 3], usize>,
    pub faces: Vec<Vec<usize>>,
}

impl Mesh {
    pub fn vertex(&mut self, name: [i32; 3], position: DVec3) -> usize {
        *self.names.entry(name).or_insert_with(|| {
            self.vertices.push(position);
            self.vertices.len() - 1
        })
    }

    /// The number of a vertex that is there.
    pub fn named(&self, name: [i32; 3]) -> usize {
        self.names[&name]
    }

    pub fn write(&self, name: &str, what: &str) -> std::io::Result<()> {
        let mut text = format!("# Purlwise: {what} Unit: metre. Made by make_assets; CC0.\n");
        for v in &self.vertices {
            let _ = writeln!(text, "v {:.5} {:.5} {:.5}", v.x, v.y, v.z);
        }
        for face in &self.faces {
            let corners: Vec<String> = face.iter().map(|v| (v + 1).to_string()).collect();
            let _ = writeln!(text, "f {}", corners.join(" "));
        }
        std::fs::write(format!("assets/meshes/{name}.obj"), text)
    }
}
