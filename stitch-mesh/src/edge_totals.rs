//! What edge counts will come to, before anything is cut.

use crate::edge_counts::{EdgeCounts, FaceCounts};
use crate::label::LabelledMesh;
use crate::stitch_mesh::StitchMesh;

/// Figures that an artist weighs when choosing counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Stitches.
    pub stitches: u64,
    /// Rows of stitches.
    pub rows: u64,
    /// Loops that increases add.
    pub increases: u64,
    /// Loops that decreases take away.
    pub decreases: u64,
}

impl EdgeCounts {
    /// What cutting a labelled mesh with these counts will come to, in no more time than its faces have rows.
    pub fn totals(&self, labelled: &LabelledMesh) -> Totals {
        let mut totals = Totals::default();
        for face in labelled.mesh().faces() {
            let Some(at) = FaceCounts::of(labelled, self, face) else { continue };
            for i in 0..at.rows {
                let (below, above) = (u64::from(at.at(i)), u64::from(at.at(i + 1)));
                totals.stitches += below.min(above).max(1);
                totals.increases += above.saturating_sub(below);
                totals.decreases += below.saturating_sub(above);
            }
        }
        let rows = |faces: &[crate::ids::FaceId]| {
            let first = FaceCounts::of(labelled, self, *faces.first()?)?;
            Some(u64::from(first.rows))
        };
        totals.rows = labelled.rows().iter().filter_map(|r| rows(&r.faces)).sum();
        totals
    }
}

impl Totals {
    /// The figures of stitches that are there.
    pub fn of(stitches: &StitchMesh) -> Self {
        let mut totals = Self {
            stitches: stitches.mesh().face_count() as u64,
            rows: stitches.rows().len() as u64,
            ..Self::default()
        };
        for stitch in stitches.stitches() {
            let (below, above) = (stitch.bottoms() as u64, stitch.tops() as u64);
            totals.increases += above.saturating_sub(below);
            totals.decreases += below.saturating_sub(above);
        }
        totals
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::grid;
    use crate::tessellate::tessellate;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn totals_are_those_of_the_stitches(counts in proptest::collection::vec(1u32..9, 24), rows in 1u32..6) {
            let labelled = grid(3, 3);
            let mut counts = EdgeCounts { counts, marked: vec![] };
            for edge in labelled.mesh().edges().filter(|e| labelled.is_wale(*e)) {
                counts.set(&labelled, &[edge], rows).unwrap();
            }
            let stitches = tessellate(&labelled, &counts).unwrap();
            prop_assert_eq!(counts.totals(&labelled), Totals::of(&stitches));
        }
    }
}
