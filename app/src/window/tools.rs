//! What the mouse does in the viewport.

use crate::command::Command;
use crate::drawing::Stage;
use stitch_mesh::ids::{FaceId, VertexId};
use stitch_mesh::label::{EdgeLabel, LabelledMesh};
use stitch_mesh::stitch_mesh::StitchMesh;

/// A tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Click an edge: the row there; with Shift all rows onwards from there.
    Fill,
    /// Click an edge: course.
    Course,
    /// Click an edge: wale.
    Wale,
    /// Click an edge: no label.
    Erase,
    /// Click a face: its row is knitted the other way.
    Flip,
    /// Paint stitches.
    Paint(Reach),
    /// Drag the yarn.
    Grab,
}

/// How far a dab of paint reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// One stitch.
    Stitch,
    /// Its whole row.
    Row,
    /// Its wale, upwards and downwards.
    Wale,
}

impl Tool {
    /// The tools of a stage, with their names and what they do.
    pub fn of(stage: Stage) -> &'static [(Self, &'static str, &'static str)] {
        const LABEL: &[(Tool, &str, &str)] = &[
            (
                Tool::Fill,
                "Fill rows",
                "Click a border or a course edge to label the row there; Shift-click to go on to all rows beyond",
            ),
            (Tool::Course, "Course", "Click an edge to make it a course edge"),
            (Tool::Wale, "Wale", "Click an edge to make it a wale edge"),
            (Tool::Erase, "Erase", "Click an edge to take its label away"),
            (Tool::Flip, "Flip row", "Click a face to turn the direction in which its row is knitted"),
        ];
        const PAINT: &[(Tool, &str, &str)] = &[
            (Tool::Paint(Reach::Stitch), "Stitch", "Drag over stitches to paint them"),
            (Tool::Paint(Reach::Row), "Row", "Click a stitch to paint its row"),
            (Tool::Paint(Reach::Wale), "Wale", "Click a stitch to paint its column"),
        ];
        const YARN: &[(Tool, &str, &str)] = &[
            (Tool::Paint(Reach::Stitch), "Stitch", "Drag over stitches to paint them"),
            (Tool::Paint(Reach::Row), "Row", "Click a stitch to paint its row"),
            (Tool::Paint(Reach::Wale), "Wale", "Click a stitch to paint its column"),
            (Tool::Grab, "Grab", "Drag the yarn while it is simulated"),
        ];
        match stage {
            Stage::Mesh => &[],
            Stage::Labels => LABEL,
            Stage::Stitches => PAINT,
            Stage::Yarn => YARN,
        }
    }

    /// What a click on an edge and face of the labelled mesh does.
    pub fn label(
        self,
        labelled: &LabelledMesh,
        face: FaceId,
        edge: [u32; 2],
        onwards: bool,
    ) -> Option<Command> {
        let id = labelled.mesh().edge_between(VertexId(edge[0]), VertexId(edge[1]))?;
        match self {
            Self::Fill if onwards => Some(Command::FillOnwards { edge }),
            Self::Fill if labelled.label(id) == Some(EdgeLabel::Course) => {
                Some(Command::FillFromCourse { edge })
            }
            Self::Fill => Some(Command::FillFromBorder { edge }),
            Self::Course => Some(Command::LabelEdges { edges: vec![edge], label: Some(EdgeLabel::Course) }),
            Self::Wale => Some(Command::LabelEdges { edges: vec![edge], label: Some(EdgeLabel::Wale) }),
            Self::Erase => Some(Command::LabelEdges { edges: vec![edge], label: None }),
            Self::Flip => Some(Command::FlipRow { face: face.0 }),
            Self::Paint(_) | Self::Grab => None,
        }
    }
}

impl Reach {
    /// The faces that a dab on `face` reaches and that can take a stitch of the same shape.
    pub fn faces(self, stitches: &StitchMesh, face: FaceId) -> Vec<u32> {
        let shape = |f: FaceId| (stitches.stitch(f).bottoms(), stitches.stitch(f).tops());
        let reached = match self {
            Self::Stitch => vec![face],
            Self::Row => stitches.row_of(face).faces,
            Self::Wale => {
                let mut column = vec![face];
                for up in [true, false] {
                    let step =
                        |f: FaceId| if up { stitches.above(f).next() } else { stitches.below(f).next() };
                    let beyond = std::iter::successors(step(face), |f| step(*f).filter(|n| *n != face));
                    column.extend(beyond.take(stitches.mesh().face_count()));
                }
                column
            }
        };
        reached.into_iter().filter(|f| shape(*f) == shape(face)).map(|f| f.0).collect()
    }
}
