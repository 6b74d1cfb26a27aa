//! Bodies from mesh files: one that keeps its shape, and a sequence of them.

use super::file::metres;
use crate::files;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::Deserialize;
use sim_core::{ClosedMesh, Frames, MeshSequence, Triangles};
use std::path::Path;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::{Unit, read_obj};

/// A closed mesh.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshFile {
    /// Beside the scene file.
    file: String,
    unit: Option<Unit>,
    #[serde(default)]
    at: [f64; 3],
}

/// Closed meshes of one topology, one after another.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SequenceFiles {
    /// Beside the scene file, in order of time.
    #[serde(default)]
    files: Vec<String>,
    /// Instead: a name with `#` for each digit of a number.
    pattern: Option<String>,
    /// Frames per second.
    rate: f64,
    /// Whether the first follows the last again.
    #[serde(default)]
    repeat: bool,
    unit: Option<Unit>,
    #[serde(default)]
    at: [f64; 3],
}

/// The mesh of a file, with its origin `at` a place.
fn read(path: &Path, unit: Option<Unit>, at: DVec3) -> Result<PolygonMesh> {
    let mesh = read_obj(&files::read(path)?, unit.unwrap_or(Unit::Mm))?;
    Ok(mesh.moved_to(mesh.positions().iter().map(|p| *p + at).collect())?)
}

fn triangles(mesh: &PolygonMesh) -> Vec<[u32; 3]> {
    let fan = |face: Vec<u32>| (2..face.len()).map(move |i| [face[0], face[i - 1], face[i]]);
    mesh.face_lists().into_iter().flat_map(fan).collect()
}

impl MeshFile {
    pub fn read(&self, origin: DVec3, folder: &Path) -> Result<ClosedMesh> {
        let path = folder.join(&self.file);
        let name = || path.display().to_string();
        let mesh = read(&path, self.unit, origin + metres(self.at)).with_context(name)?;
        let mesh = Triangles { positions: mesh.positions().to_vec(), triangles: triangles(&mesh) };
        ClosedMesh::new(mesh).with_context(name)
    }
}

impl SequenceFiles {
    pub fn read(&self, origin: DVec3, folder: &Path) -> Result<MeshSequence> {
        let names = self.names(folder)?;
        let mut first: Option<PolygonMesh> = None;
        let mut positions = Vec::new();
        for name in &names {
            let path = folder.join(name);
            let mesh = read(&path, self.unit, origin + metres(self.at))
                .with_context(|| path.display().to_string())?;
            positions.push(mesh.positions().to_vec());
            match &first {
                Some(first) => alike(first, &mesh, &path, &names[0])?,
                None => first = Some(mesh),
            }
        }
        let triangles = first.as_ref().map(triangles).unwrap_or_default();
        let (interval_s, repeats) = (1.0 / self.rate, self.repeat);
        let sequence = MeshSequence::new(Frames { triangles, positions, interval_s, repeats });
        sequence.with_context(|| names.first().cloned().unwrap_or_default())
    }

    /// The files in order of time.
    fn names(&self, folder: &Path) -> Result<Vec<String>> {
        let Some(pattern) = &self.pattern else {
            if self.files.is_empty() {
                bail!("a mesh sequence needs 'files' or a 'pattern'");
            }
            return Ok(self.files.clone());
        };
        if !self.files.is_empty() {
            bail!("a mesh sequence takes either 'files' or a 'pattern'");
        }
        let (Some(from), Some(to)) = (pattern.find('#'), pattern.rfind('#')) else {
            bail!("the pattern '{pattern}' has no '#' for the digits of a number");
        };
        // The pattern may lie in a folder of its own.
        let path = folder.join(pattern);
        let folder = path.parent().filter(|p| *p != Path::new("")).unwrap_or(Path::new("."));
        let inner = pattern.len() - path.file_name().map_or(0, std::ffi::OsStr::len);
        let fits = |name: &str| {
            let numbered = name.get(from - inner..=to - inner);
            name.len() == pattern.len() - inner
                && numbered.is_some_and(|n| n.bytes().all(|b| b.is_ascii_digit()))
                && name.starts_with(&pattern[inner..from])
                && name.ends_with(&pattern[to + 1..])
        };
        let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| fits(name))
            .map(|name| format!("{}{name}", &pattern[..inner]))
            .collect();
        if names.is_empty() {
            bail!("no file is called as '{pattern}' says");
        }
        names.sort();
        Ok(names)
    }
}

/// Whether two meshes have the same faces between the same vertices; where not, the line of the file says so.
fn alike(first: &PolygonMesh, mesh: &PolygonMesh, path: &Path, name: &str) -> Result<()> {
    // The mesh has been read, so its file can be.
    let line = |keyword: &str, number: usize| -> Result<usize> {
        let bytes = files::read(path)?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let lines = text.lines().zip(1..).filter(|(l, _)| l.split_whitespace().next() == Some(keyword));
        let lines: Vec<usize> = lines.map(|(_, number)| number).collect();
        Ok(lines.get(number).or(lines.last()).copied().unwrap_or(1))
    };
    let [vertices, expected] = [mesh, first].map(PolygonMesh::vertex_count);
    if vertices != expected {
        bail!(
            "{}: line {}: {vertices} vertices, where {name} has {expected}",
            path.display(),
            line("v", expected.min(vertices))?
        );
    }
    let (faces, of_first) = (mesh.face_lists(), first.face_lists());
    let differs = (0..faces.len().max(of_first.len())).find(|i| faces.get(*i) != of_first.get(*i));
    if let Some(face) = differs {
        bail!("{}: line {}: face {face} is not that of {name}", path.display(), line("f", face)?);
    }
    Ok(())
}
