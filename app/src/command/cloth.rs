//! Weaving.

use crate::fabric::Fabric;
use crate::project::Project;
use anyhow::{Result, bail};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use sim_core::Surgery;
use std::sync::Arc;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::weave::{FILL, Stripes, WeaveDraft, Woven};

/// Room between a new piece and what is there, in spacings.
const ROOM: f64 = 8.0;

/// A piece of cloth as a command asks for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weave {
    /// Lines of # (warp in front) and . (weft in front), the last pick first, or a name: plain, twill, satin.
    pub draft: WeaveDraft,
    /// Yarns of the warp, which run up.
    pub ends: usize,
    /// Yarns of the weft, which run across.
    pub picks: usize,
    /// Distance from a yarn to the next [mm]; as close as the thicker of both allows if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing_mm: Option<f64>,
    /// Colours of the warp from the left, `#rrggbb` or `#rrggbb*4,#rrggbb*2`.
    #[serde(default)]
    pub warp: Stripes,
    /// Colours of the weft from below.
    #[serde(default)]
    pub weft: Stripes,
    /// Its middle [mm]; to the right of what is there if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_mm: Option<[f64; 3]>,
    /// Whether it lies, its front upwards, instead of standing with its front towards +z.
    #[serde(default)]
    pub flat: bool,
}

impl Weave {
    /// Adds the piece.
    pub(super) fn perform(&self, project: &mut Project) -> Result<()> {
        let Self { draft, warp, weft, .. } = self;
        let Self { ends, picks, flat, .. } = *self;
        let radii = warp.dyes().chain(weft.dyes()).map(|dye| project.materials.of(dye).drawn_radius);
        let thickest = radii.fold(0.0, f64::max);
        let spacing = self.spacing_mm.map_or(thickest / FILL, |mm| mm * 1e-3);
        let middle = match self.at_mm {
            Some(mm) => DVec3::from_array(mm) * 1e-3,
            None => beside(project, 0.5 * spacing * (ends as f64 + ROOM)),
        };
        let (draft, warp, weft) = (draft.clone(), warp.clone(), weft.clone());
        let piece = Woven { draft, ends, picks, spacing, warp, weft, middle, flat };
        piece.check()?;
        let fabric = match &project.fabric {
            Some(fabric) if fabric.surgery != Surgery::default() => {
                bail!("yarn has been cut: weave before that, or lay the yarn anew first")
            }
            Some(fabric) => fabric.with_woven(piece),
            None => Fabric::laid(StitchMesh::empty(), None, Arc::new(vec![piece])),
        };
        project.fabric = Some(fabric);
        Ok(())
    }
}

/// The middle of a piece that reaches so far to its left, put to the right of all yarn.
fn beside(project: &Project, reach: f64) -> DVec3 {
    let Some(fabric) = &project.fabric else { return DVec3::ZERO };
    let state = fabric.state();
    let low = state.position.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = state.position.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let middle = 0.5 * (low + high);
    DVec3::new(high.x + reach, middle.y, middle.z)
}

#[cfg(test)]
mod tests {
    use super::super::{Command, read_script};
    use super::*;
    use crate::cloth::cloth;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::ids::FaceId;
    use stitch_mesh::pieces::rectangle;

    fn run(project: &Project, script: &str) -> Project {
        let commands = read_script(script).unwrap();
        commands.into_iter().fold(project.clone(), |p, (_, command)| command.apply(&p).unwrap())
    }

    fn knitted() -> Project {
        let stitches = rectangle(4, 3, StitchSize::of_width(3e-3)).unwrap();
        let mut project = Project::new(stitches.mesh().clone(), StitchSize::of_width(3e-3));
        project.fabric = Some(Fabric::new(stitches));
        project
    }

    #[test]
    fn cloth_lies_beside_stitches_and_stays_through_their_edits() {
        let before = knitted();
        let mut moved = before.fabric().unwrap().net().laid_state();
        moved.position.iter_mut().for_each(|x| x.z += 0.01);
        let mut before = before;
        before.fabric.as_mut().unwrap().put(moved.clone());
        let after = run(&before, r##"{"do":"weave","draft":"twill","ends":6,"picks":5,"weft":"#204080"}"##);
        let fabric = after.fabric().unwrap();
        let knit = moved.position.len();
        assert_eq!(fabric.state().position[..knit], moved.position);
        assert_eq!(fabric.net().nodes.len(), knit + 30 + 22);
        let right = moved.position.iter().map(|x| x.x).fold(0.0, f64::max);
        assert!(fabric.state().position[knit..].iter().all(|x| x.x > right && (x.z - 0.01).abs() < 1e-9));
        let purled = run(&after, r#"{"do":"set_stitch","faces":[5],"stitch":"p"}"#);
        let fabric = purled.fabric().unwrap();
        assert_eq!(fabric.stitches.stitch(FaceId(5)).to_string(), "p");
        assert_eq!(fabric.woven, after.fabric().unwrap().woven);
        assert_eq!(fabric.state().position[knit..], after.fabric().unwrap().state().position[knit..]);
        let split = run(&purled, r#"{"do":"split_course","edge":[6,7]}"#);
        assert_eq!(split.fabric().unwrap().woven.len(), 1);
    }

    #[test]
    fn cloth_alone_is_saved_and_opened() {
        let piece = Woven {
            draft: "satin".parse().unwrap(),
            ends: 10,
            picks: 7,
            spacing: 1e-3,
            warp: "#c80000*2,#303034".parse().unwrap(),
            weft: Stripes::default(),
            middle: DVec3::ZERO,
            flat: true,
        };
        let project = cloth(piece.clone()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cloth.purl");
        project.save(&path).unwrap();
        let opened = Project::open(&path).unwrap();
        assert_eq!(opened.fabric().unwrap().woven[..], [piece]);
        assert_eq!(opened.fabric().unwrap().net().laid_state(), project.fabric().unwrap().net().laid_state());
        let facts = crate::inspect::inspect(&opened);
        assert_eq!((facts.yarns.open, facts.contact_nodes, facts.faces), (17, 70, 0));
        assert_eq!(facts.problems, []);
        let error = |command: Command| command.apply(&opened).unwrap_err().to_string();
        let purl = Command::SetStitch { faces: vec![0], stitch: "p".parse().unwrap() };
        assert!(error(purl).contains("woven cloth only"));
        assert!(error(read_script(r#"{"do":"relax_mesh"}"#).unwrap().remove(0).1).contains("no stitches"));
    }

    #[test]
    fn what_cannot_be_woven_is_refused() {
        let refused = |script: &str| match read_script(script) {
            Err(error) => format!("{error:#}"),
            Ok(mut commands) => format!("{:#}", commands.remove(0).1.apply(&knitted()).unwrap_err()),
        };
        assert!(refused(r#"{"do":"weave","draft":"plain","ends":1,"picks":5}"#).contains("1 ends"));
        assert!(refused(r##"{"do":"weave","draft":"#.\n##","ends":9,"picks":5}"##).contains("line 2"));
        assert!(refused(r#"{"do":"weave","draft":"plain","ends":9,"pics":5}"#).contains("pics"));
        let nowhere = r#"{"do":"weave","draft":"plain","ends":9,"picks":5,"spacing_mm":-1}"#;
        assert!(refused(nowhere).contains("-1 mm"));
    }
}
