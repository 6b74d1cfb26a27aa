//! Names of commands, as the history shows them.

use super::Command;
use crate::written::title;
use stitch_mesh::edit::Way;
use stitch_mesh::label::EdgeLabel;

/// A number and its noun: `1 edge`, `2 edges`.
fn many(count: usize, one: &str) -> String {
    match (count, one) {
        (1, one) => format!("1 {one}"),
        (count, "stitch") => format!("{count} stitches"),
        (count, one) => format!("{count} {one}s"),
    }
}

impl Command {
    /// Its name in the history.
    pub fn name(&self) -> String {
        match self {
            Self::FillFromBorder { .. } => "Fill row from border".into(),
            Self::FillFromCourse { .. } => "Fill next row".into(),
            Self::FillOnwards { .. } => "Fill rows onwards".into(),
            Self::LabelEdges { edges, label: Some(EdgeLabel::Course) } => {
                format!("Label {} course", many(edges.len(), "edge"))
            }
            Self::LabelEdges { edges, label: Some(EdgeLabel::Wale) } => {
                format!("Label {} wale", many(edges.len(), "edge"))
            }
            Self::LabelEdges { edges, label: None } => {
                format!("Clear {}", many(edges.len(), "edge label"))
            }
            Self::FlipRow { .. } => "Flip row".into(),
            Self::Autolabel => "Label automatically".into(),
            Self::ClearLabels => "Clear labels".into(),
            Self::Tessellate { width_mm: Some(width) } => format!("Tessellate at {width} mm"),
            Self::Tessellate { width_mm: None } => "Tessellate as counted".into(),
            Self::SetEdgeCounts { edges, count } => {
                format!("Count {count} on {}", many(edges.len(), "edge"))
            }
            Self::MarkWale { marked: true, .. } => "Shape along edge".into(),
            Self::MarkWale { marked: false, .. } => "Shape along both edges".into(),
            Self::SetStitch { faces, stitch } => format!("Set {} to {stitch}", many(faces.len(), "stitch")),
            Self::SetChart { chart, .. } => format!("Repeat {}", chart.join(" / ")),
            Self::FillRegion { stitch, .. } => format!("Fill with {stitch}"),
            Self::SetCable { cable } => format!("Cable {}", cable.name()),
            Self::ClearCables { .. } => "Clear cables".into(),
            Self::SetLive { edges, live: true } => format!("Leave {} live", many(edges.len(), "loop")),
            Self::SetLive { edges, live: false } => format!("Bind off {}", many(edges.len(), "loop")),
            Self::SetSpiral { spiral: true } => "Knit in a spiral".into(),
            Self::SetSpiral { spiral: false } => "Knit in rings".into(),
            Self::Sew { .. } => "Sew seam".into(),
            Self::Unsew { .. } => "Undo seam".into(),
            Self::Dye { faces, color } => format!("Dye {} {color}", many(faces.len(), "stitch")),
            Self::DyeRows { rows: [first, last], color } => {
                format!("Dye {} {color}", many(last.abs_diff(*first) + 1, "row"))
            }
            Self::SetWrap { faces, modulus, angle_deg } => {
                let modulus = modulus.map(|m| format!("× {m}"));
                let how: Vec<String> =
                    modulus.into_iter().chain(angle_deg.map(|a| format!("at {a}°"))).collect();
                let how = if how.is_empty() { "as the material has it".into() } else { how.join(" ") };
                format!("Wrap {} {how}", many(faces.len(), "stitch"))
            }
            Self::Paste { patch, .. } => {
                let count = patch.rows.iter().map(|r| r.stitches.iter().flatten().count()).sum();
                format!("Paste {}", many(count, "stitch"))
            }
            Self::Import { text, .. } => format!("Knit {}", title(text)),
            Self::Tile { text, .. } => format!("Tile {}", title(text)),
            Self::Weave(piece) => format!("Weave {} by {} yarns", piece.ends, piece.picks),
            Self::SplitCourse { .. } => "Split course edge".into(),
            Self::CollapseCourse { .. } => "Collapse course edge".into(),
            Self::AddWale { .. } => "Add wale edge".into(),
            Self::RemoveWale { .. } => "Remove wale edge".into(),
            Self::ShiftWale { to: Way::Left, .. } => "Shift wale edge left".into(),
            Self::ShiftWale { to: Way::Right, .. } => "Shift wale edge right".into(),
            Self::SetMaterial { color: None, .. } => "Change yarn".into(),
            Self::SetMaterial { color: Some(color), .. } => format!("Change yarn {color}"),
            Self::UsePreset { color: None, preset } => preset.name().to_owned(),
            Self::UsePreset { color: Some(color), preset } => format!("{} for {color}", preset.name()),
            Self::ClearMaterial { color } => format!("Yarn {color} as the rest"),
            Self::SetScene { .. } => "Change scene".into(),
            Self::CutYarn { faces } => format!("Cut the yarn of {}", many(faces.len(), "stitch")),
            Self::CutYarnAt { .. } => "Cut yarn".into(),
            Self::DropLoops { faces } => format!("Drop {}", many(faces.len(), "stitch")),
            Self::Hold { faces } => format!("Hold {}", many(faces.len(), "stitch")),
            Self::LetGo => "Let go".into(),
            Self::ResetYarn => "Lay yarn anew".into(),
            Self::Compensate { text: Some(text) } => format!("Loops at rest as in {}", title(text)),
            Self::Compensate { text: None } => "Loops as drawn".into(),
            Self::RelaxMesh { surface: true, .. } => "Relax stitches".into(),
            Self::RelaxMesh { surface: false, .. } => "Relax stitches freely".into(),
        }
    }
}
