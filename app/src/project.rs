//! A project: everything that a `.purl` file holds.
//!
//! The parts are shared, never changed in place: a changed project is a new one that shares what stayed the same. So undo
//! keeps whole projects cheaply, and threads hand them to each other.
//!
//! The file is JSON, `{"purlwise": 1, …}`. Half-edge structures are built again on reading, and so is the yarn net, which
//! follows from the stitch mesh; the state of the yarn has to fit it.

use crate::fabric::{Fabric, Moved};
use crate::files;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use sim_core::{Facts, Material, Materials, RestShape, Scene, Surgery};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use stitch_mesh::dye::Dye;
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::ids::{FaceId, HalfEdgeId};
use stitch_mesh::label::{EdgeLabel, LabelledMesh};
use stitch_mesh::marks::Marks;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::obj::{Unit, read_obj};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::{Place, StitchMesh};
use stitch_mesh::weave::Woven;
use stitch_mesh::wrapping::Wrapping;
use stitch_mesh::yarn_net::YarnState;

/// Version of the file that this program writes, and the newest that it reads.
const VERSION: u32 = 1;

/// Stitch width when nobody has chosen one [m].
pub const DEFAULT_STITCH_WIDTH: f64 = 0.010;

/// A project. See the module.
#[derive(Clone, Debug)]
pub struct Project {
    /// The input mesh with its labels.
    pub labelled: Arc<LabelledMesh>,
    /// Size of a stitch as laid.
    pub size: StitchSize,
    /// The yarns.
    pub materials: Materials,
    /// What surrounds the fabric in the simulation.
    pub scene: Scene,
    /// Stitches and rows on every edge of the input, once somebody has asked for some.
    pub counts: Option<EdgeCounts>,
    /// The fabric, once the mesh has been tessellated.
    pub fabric: Option<Fabric>,
}

impl Project {
    /// A project that begins with a mesh, without labels.
    pub fn new(mesh: PolygonMesh, size: StitchSize) -> Self {
        Self {
            labelled: Arc::new(LabelledMesh::new(mesh)),
            size,
            materials: Material::for_loop_width(size.width).into(),
            scene: Scene::empty(),
            counts: None,
            fabric: None,
        }
    }

    /// A project that begins with a mesh file.
    ///
    /// # Errors
    /// What is wrong with the file, by line or face.
    pub fn from_obj(path: &Path, unit: Unit, size: StitchSize) -> Result<Self> {
        let mesh = read_obj(&files::read(path)?, unit).with_context(|| path.display().to_string())?;
        Ok(Self::new(mesh, size))
    }

    /// Whether a command that made this of `other` has left everything as it was.
    pub(crate) fn is_as(&self, other: &Self) -> bool {
        let fabrics = match (&self.fabric, &other.fabric) {
            (Some(fabric), Some(before)) => fabric.is_as(before),
            (fabric, before) => fabric.is_none() && before.is_none(),
        };
        fabrics
            && (Arc::ptr_eq(&self.labelled, &other.labelled) || self.labelled == other.labelled)
            && self.size == other.size
            && self.materials == other.materials
            && self.scene == other.scene
            && self.counts == other.counts
    }

    /// The fabric, or an error that says what to do first.
    pub fn fabric(&self) -> Result<&Fabric> {
        self.fabric.as_ref().context("the mesh has no stitches yet: label all its rows, then tessellate it")
    }

    /// The fabric if it has stitches, or an error that says so.
    pub fn knitted(&self) -> Result<&Fabric> {
        let fabric = self.fabric()?;
        if fabric.stitches.stitches().is_empty() {
            bail!("the project has woven cloth only, and no stitches");
        }
        Ok(fabric)
    }

    /// Takes over where the yarn is in another project, as far as both have the same faces. `was` tells for each face here
    /// which it is there; without it, both have to have the same mesh.
    pub fn keep_yarn_of(&mut self, other: &Self, was: Option<&[Option<FaceId>]>) {
        let (Some(fabric), Some(from)) = (&mut self.fabric, &other.fabric) else { return };
        if was.is_none() && !fabric.stitches.has_mesh_of(&from.stitches) {
            return;
        }
        fabric.continue_from(from, was.map(<[_]>::to_vec));
    }

    /// Takes over where a simulation that began with this fabric has brought its yarn. Pins on nodes that are gone go too.
    pub fn take_over(&mut self, moved: Moved, facts: Option<Facts>) {
        let Some(fabric) = &mut self.fabric else { return };
        if !moved.surgery.operations.is_empty()
            && let Ok((_, nodes)) = moved.surgery.replay(&moved.from)
        {
            self.scene.follow(&nodes);
        }
        fabric.take_over(moved, facts);
    }

    /// Reads a `.purl` file.
    ///
    /// # Errors
    /// A file that is not a project, is cut off, or is of a newer version, with line and column where there is one.
    pub fn open(path: &Path) -> Result<Self> {
        Self::from_json(&files::read(path)?).with_context(|| path.display().to_string())
    }

    /// Writes a `.purl` file, whole or not at all.
    ///
    /// # Errors
    /// Where it cannot be written, or has the name of another kind of file.
    pub fn save(&self, path: &Path) -> Result<()> {
        files::check_ending(path, "purl", "projects")?;
        files::write(path, &serde_json::to_vec(&File::of(self))?)
    }

    fn from_json(bytes: &[u8]) -> Result<Self> {
        #[derive(Deserialize)]
        struct Header {
            purlwise: u32,
        }
        let header: Header = serde_json::from_slice(bytes).context("not a Purlwise project")?;
        if header.purlwise > VERSION {
            bail!(
                "written by a newer Purlwise (file version {}, this program reads up to {VERSION})",
                header.purlwise
            );
        }
        serde_json::from_slice::<File>(bytes).context("not a Purlwise project")?.into_project()
    }
}

/// The file, field by field.
#[derive(Serialize, Deserialize)]
struct File {
    purlwise: u32,
    mesh: FileMesh,
    /// [edge_count], edges in order of first use by the faces.
    labels: Vec<Option<EdgeLabel>>,
    /// The rising wale half-edge of every face, [face_count].
    rising: Vec<Option<HalfEdgeId>>,
    stitch_size: StitchSize,
    material: Material,
    /// Yarns that have another, by their colour. Absent where there are none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    yarns: BTreeMap<Dye, Material>,
    scene: Scene,
    /// Absent in files from before counts could be edited, and before there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    counts: Option<EdgeCounts>,
    fabric: Option<FileFabric>,
}

#[derive(Serialize, Deserialize)]
struct FileMesh {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

#[derive(Serialize, Deserialize)]
struct FileFabric {
    mesh: FileMesh,
    stitches: Vec<Stitch>,
    /// [face_count]; absent where nothing is dyed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dyes: Option<Vec<Dye>>,
    /// [face_count]; absent where all stitches are wrapped as their material has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    wrappings: Option<Vec<Wrapping>>,
    /// [face_count]; absent where no stitch was cut from the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    places: Option<Vec<Option<Place>>>,
    /// Absent where nothing is marked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    marks: Option<Marks>,
    /// Absent where loops have the shapes in which they are drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rest_shape: Option<RestShape>,
    /// Absent where nothing was cut and nothing has slipped out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surgery: Option<Surgery>,
    /// Absent where nothing is woven.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    woven: Vec<Woven>,
    state: Option<YarnState>,
    facts: Option<Facts>,
}

impl FileMesh {
    fn of(mesh: &PolygonMesh) -> Self {
        Self { positions: mesh.positions().to_vec(), faces: mesh.face_lists() }
    }
}

impl FileFabric {
    fn of(fabric: &Fabric) -> Self {
        let stitches = &fabric.stitches;
        let (dyes, wrappings) = (stitches.dyes(), stitches.wrappings());
        let (places, marks) = (stitches.places(), stitches.marks());
        Self {
            mesh: FileMesh::of(stitches.mesh()),
            stitches: stitches.stitches().to_vec(),
            dyes: dyes.iter().any(|d| *d != Dye::UNDYED).then(|| dyes.to_vec()),
            wrappings: wrappings.iter().any(|w| *w != Wrapping::OF_MATERIAL).then(|| wrappings.to_vec()),
            places: places.iter().any(Option::is_some).then(|| places.to_vec()),
            marks: Some(marks).filter(|m| **m != Marks::default()).cloned(),
            rest_shape: fabric.rest_shape.as_deref().cloned(),
            surgery: Some(&fabric.surgery).filter(|s| **s != Surgery::default()).cloned(),
            woven: (*fabric.woven).clone(),
            state: fabric.simulated().as_deref().cloned(),
            facts: fabric.facts.clone(),
        }
    }

    fn into_fabric(self) -> Result<Fabric> {
        let stitches = if self.mesh.faces.is_empty() && !self.woven.is_empty() {
            StitchMesh::empty()
        } else {
            let mesh = PolygonMesh::new(self.mesh.positions, &self.mesh.faces).context("the stitch mesh")?;
            let faces = mesh.face_count();
            StitchMesh::new(mesh, self.stitches)?.with(
                self.dyes.unwrap_or_else(|| vec![Dye::UNDYED; faces]),
                self.wrappings.unwrap_or_else(|| vec![Wrapping::OF_MATERIAL; faces]),
                self.places.unwrap_or_else(|| vec![None; faces]),
                self.marks.unwrap_or_default(),
            )?
        };
        self.woven.iter().try_for_each(Woven::check).context("woven cloth")?;
        let mut fabric = Fabric::laid(stitches, self.rest_shape.map(Arc::new), Arc::new(self.woven))
            .after(self.surgery.unwrap_or_default())?;
        if let Some(state) = self.state {
            if !state.fits(fabric.net()) || !state.is_finite() {
                bail!("the state of the yarn does not belong to the stitches");
            }
            fabric.put(state);
            fabric.facts = self.facts;
        }
        Ok(fabric)
    }
}

impl File {
    fn of(project: &Project) -> Self {
        let labelled = &project.labelled;
        Self {
            purlwise: VERSION,
            mesh: FileMesh::of(labelled.mesh()),
            labels: labelled.labels().to_vec(),
            rising: labelled.mesh().faces().map(|f| labelled.wales(f).map(|w| w.right)).collect(),
            stitch_size: project.size,
            material: project.materials.base.clone(),
            yarns: project.materials.by_dye.clone(),
            scene: project.scene.clone(),
            counts: project.counts.clone(),
            fabric: project.fabric.as_ref().map(FileFabric::of),
        }
    }

    fn into_project(self) -> Result<Project> {
        let mesh = PolygonMesh::new(self.mesh.positions, &self.mesh.faces)?;
        let labelled = LabelledMesh::from_parts(mesh, self.labels, &self.rising)
            .context("the labels do not belong to the mesh")?;
        let materials = Materials { base: self.material, by_dye: self.yarns };
        materials.validate()?;
        let mut project = Project {
            labelled: Arc::new(labelled),
            size: self.stitch_size,
            materials,
            scene: self.scene,
            counts: self.counts,
            fabric: None,
        };
        if let Some(counts) = &project.counts {
            counts.check(&project.labelled).context("the counts of the edges")?;
        }
        project.fabric = self.fabric.map(FileFabric::into_fabric).transpose()?;
        project.scene.validate(project.fabric.as_ref().map_or(0, |f| f.net().nodes.len()))?;
        Ok(project)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::ids::VertexId;
    use stitch_mesh::pieces::rectangle;

    fn project() -> Project {
        let size = StitchSize::of_width(0.004);
        let stitches = rectangle(4, 3, size).unwrap();
        let mut project = Project::new(stitches.mesh().clone(), size);
        project.fabric = Some(Fabric::new(stitches));
        project
    }

    #[test]
    fn what_is_saved_is_read_again() {
        let mut before = project();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.purl");
        let mut stitches = (*before.fabric().unwrap().stitches).clone();
        stitches.set_dye(FaceId(2), "#c04030".parse().unwrap()).unwrap();
        stitches.set_live([VertexId(15), VertexId(16)], true).unwrap();
        let mut fabric = Fabric::new(stitches);
        let mut state = fabric.net().laid_state();
        state.position[3].x += 0.1 + 1e-17;
        fabric.put(state);
        before.fabric = Some(fabric);
        before.save(&path).unwrap();
        let after = Project::open(&path).unwrap();
        assert_eq!(after.labelled, before.labelled);
        assert_eq!(after.materials, before.materials);
        let (a, b) = (after.fabric.unwrap(), before.fabric.unwrap());
        assert_eq!(a.stitches, b.stitches);
        assert_eq!(a.simulated(), b.simulated());
    }

    #[test]
    fn broken_files_say_what_is_wrong() {
        let json = serde_json::to_string(&File::of(&project())).unwrap();
        let error = |text: &str| format!("{:#}", Project::from_json(text.as_bytes()).unwrap_err());
        assert!(error("").contains("not a Purlwise project"));
        assert!(error(&json[..json.len() / 2]).contains("line 1 column"));
        assert!(error(&json.replace("\"purlwise\":1", "\"purlwise\":2")).contains("newer Purlwise"));
        assert!(
            error(&json.replacen("\"labels\":[", "\"labels\":[null,", 1)).contains("labels do not belong")
        );
        assert!(error(&json.replacen("\"k\"", "\"kp\"", 1)).contains("face 0"));
        assert!(error(&json.replacen("\"faces\":[[0", "\"faces\":[[99", 1)).contains("names vertex 99"));
    }
}
