//! How many stitches go on every edge of the input (Yuksel et al. §5.2: the tessellation values).
//!
//! Counts follow from edge length and stitch size. Rounded one by one, lengths that hardly change from row to row would give
//! single increases and decreases strewn over the fabric, which no knitter would work; so a course edge keeps the count of
//! the edge below it while its own length is within a stitch of that. What is really shaped gets its shaping, one edge
//! length after another.

use crate::ids::{EdgeId, FaceId, HalfEdgeId};
use crate::label::{Incomplete, LabelledMesh, Wales};
use serde::{Deserialize, Serialize};

/// Size of a stitch as laid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StitchSize {
    /// Width of a loop along the course [m].
    pub width: f64,
    /// Height of a row along the wale [m].
    pub height: f64,
}

impl StitchSize {
    /// The usual proportions of stockinette as laid: three quarters as high as wide (W = 3 mm, H = 2.25 mm in the simulator's
    /// reference fabric).
    pub fn of_width(width: f64) -> Self {
        Self { width, height: 0.75 * width }
    }
}

/// Stitches or rows along every edge of the input, and the wale edges marked for increases and decreases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EdgeCounts {
    /// [edge_count], each at least 1.
    pub counts: Vec<u32>,
    /// Marked wale edges.
    pub marked: Vec<EdgeId>,
}

/// Ten times the finest garment that was ever simulated this way (325 000 loops).
pub const MOST_STITCHES: u64 = 3_000_000;

/// Why there are no counts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CountError {
    /// Faces without a clear row.
    #[error(transparent)]
    Labels(#[from] Incomplete),
    /// The stitch size is no length.
    #[error("the stitch size must be above zero, not {0} m")]
    StitchSize(f64),
    /// No stitches at all on an edge.
    #[error("an edge needs at least one stitch or row")]
    Zero,
    /// A list of another length than the mesh has edges.
    #[error("{given} edge counts for {edges} edges")]
    Length {
        /// Counts given.
        given: usize,
        /// Edges there are.
        edges: usize,
    },
    /// More stitches than a garment has.
    #[error(
        "this would make {0} stitches; the limit is {MOST_STITCHES}: take larger stitches, or check the unit of the mesh"
    )]
    TooMany(u64),
}

impl EdgeCounts {
    /// Counts from edge lengths and stitch size: a course edge by its own length, the wale edges of a row by their mean.
    ///
    /// # Errors
    /// [`CountError::Labels`] where labels are missing, [`CountError::StitchSize`], [`CountError::TooMany`].
    pub fn from_size(labelled: &LabelledMesh, size: StitchSize) -> Result<Self, CountError> {
        labelled.check_complete()?;
        if !(size.width > 0.0 && size.height > 0.0) {
            return Err(CountError::StitchSize(size.width.min(size.height)));
        }
        let mesh = labelled.mesh();
        let count = |length: f64, unit: f64| rounded(length / unit) as u32;
        let mut counts = course_counts(labelled, size.width);
        for row in labelled.rows() {
            let wales: Vec<Wales> = row.faces.iter().filter_map(|f| labelled.wales(*f)).collect();
            let edges: Vec<EdgeId> =
                wales.iter().flat_map(|w| [mesh.edge(w.left), mesh.edge(w.right)]).collect();
            let mean = edges.iter().map(|e| mesh.edge_length(*e)).sum::<f64>() / edges.len() as f64;
            edges.iter().for_each(|e| counts[e.index()] = count(mean, size.height));
        }
        let counts = Self { counts, marked: Vec::new() };
        counts.check(labelled)?;
        Ok(counts)
    }

    /// Changes the count of some edges; that of a wale edge together with all wale edges of its row.
    ///
    /// # Errors
    /// As [`Self::check`]; nothing is changed then.
    pub fn set(&mut self, labelled: &LabelledMesh, edges: &[EdgeId], count: u32) -> Result<(), CountError> {
        self.check(labelled)?;
        let mut after = self.clone();
        for edge in edges {
            match labelled.is_wale(*edge) && after.counts[edge.index()] != count {
                true => labelled.wales_of_row(*edge).iter().for_each(|e| after.counts[e.index()] = count),
                false => after.counts[edge.index()] = count,
            }
        }
        after.check(labelled)?;
        *self = after;
        Ok(())
    }

    /// Faces whose two wale edges have different counts, with those on the left and on the right. An artist who changes
    /// labels after counting may leave some; they cannot be cut.
    pub fn unequal_wales(&self, labelled: &LabelledMesh) -> Vec<(FaceId, u32, u32)> {
        let count = |h| self.counts[labelled.mesh().edge(h).index()];
        let at = |f| labelled.wales(f).map(|w| (f, count(w.left), count(w.right)));
        labelled.mesh().faces().filter_map(at).filter(|(_, left, right)| left != right).collect()
    }

    /// Marks a wale edge for increases and decreases, or takes the mark away.
    pub fn mark(&mut self, edge: EdgeId, marked: bool) {
        self.marked.retain(|e| *e != edge);
        if marked {
            self.marked.push(edge);
        }
    }

    /// Whether there is a count for every edge of the mesh, none is zero, and together they make no more than
    /// [`MOST_STITCHES`].
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self, labelled: &LabelledMesh) -> Result<(), CountError> {
        let (given, edges) = (self.counts.len(), labelled.mesh().edge_count());
        if given != edges || self.marked.iter().any(|e| e.index() >= edges) {
            return Err(CountError::Length { given, edges });
        }
        if self.counts.contains(&0) {
            return Err(CountError::Zero);
        }
        match self.stitches(labelled) {
            many if many > MOST_STITCHES => Err(CountError::TooMany(many)),
            _ => Ok(()),
        }
    }

    /// About how many stitches the counts make: rows times the mean of top and bottom, face by face.
    fn stitches(&self, labelled: &LabelledMesh) -> u64 {
        let faces = labelled.mesh().faces().filter_map(|f| FaceCounts::of(labelled, self, f));
        faces.map(|c| u64::from(c.rows) * (u64::from(c.bottom) + u64::from(c.top)).div_ceil(2)).sum()
    }
}

/// A count: halves go up even when rounding error has taken a trifle from them, so that equal edges get equal counts.
fn rounded(ideal: f64) -> f64 {
    (ideal + 1e-6).round().clamp(1.0, 1e6)
}

/// Stitches on course edges, from the bottom of the fabric upwards, so that columns go on straight where they can.
fn course_counts(labelled: &LabelledMesh, width: f64) -> Vec<u32> {
    /// How far an edge may be from the length that its count stands for [stitches].
    const SLACK: f64 = 1.0;
    let mesh = labelled.mesh();
    let mut counts: Vec<Option<u32>> = vec![None; mesh.edge_count()];
    let ideal = |e: EdgeId| mesh.edge_length(e) / width;
    // Chains of opposite course edges through faces with one edge below and one above; each begins where nothing is below.
    let across = |e: EdgeId| {
        let (first, twin) = mesh.edge_sides(e);
        [Some(first), twin].into_iter().flatten().find_map(|h| {
            let wales = labelled.wales(mesh.face(h))?;
            match (&labelled.bottoms(wales)[..], &labelled.tops(wales)[..]) {
                ([bottom], [top]) if *bottom == h => Some(mesh.edge(*top)),
                _ => None,
            }
        })
    };
    let mut has_below = vec![false; mesh.edge_count()];
    mesh.edges().filter_map(across).for_each(|above| has_below[above.index()] = true);
    // Where rows run in a circle up the wale there is no beginning; any edge left over will do.
    for begins in [true, false] {
        for start in mesh.edges().filter(|e| begins != has_below[e.index()]) {
            let mut at = Some((start, rounded(ideal(start))));
            while let Some((edge, below)) = at.filter(|(e, _)| counts[e.index()].is_none()) {
                let count = if (ideal(edge) - below).abs() <= SLACK { below } else { rounded(ideal(edge)) };
                counts[edge.index()] = Some(count as u32);
                at = across(edge).map(|above| (above, count));
            }
        }
    }
    counts.into_iter().map(|c| c.unwrap_or(1)).collect()
}

/// Counts at one face.
pub(crate) struct FaceCounts {
    pub wales: Wales,
    pub bottom: u32,
    pub top: u32,
    pub rows: u32,
}

impl FaceCounts {
    /// Counts at a labelled face.
    pub fn of(labelled: &LabelledMesh, counts: &EdgeCounts, face: FaceId) -> Option<Self> {
        let wales = labelled.wales(face)?;
        let count = |h| counts.counts[labelled.mesh().edge(h).index()];
        let sum = |chain: Vec<HalfEdgeId>| chain.into_iter().map(count).fold(0, u32::saturating_add);
        let (bottom, top) = (sum(labelled.bottoms(wales)), sum(labelled.tops(wales)));
        Some(Self { wales, bottom, top, rows: count(wales.right) })
    }

    /// Stitches on row boundary `i`, from 0 at the bottom.
    pub fn at(&self, i: u32) -> u32 {
        let (b, t, w) = (f64::from(self.bottom), f64::from(self.top), f64::from(self.rows));
        match i {
            0 => self.bottom,
            i if i == self.rows => self.top,
            i => (b + (t - b) * f64::from(i) / w).round().max(1.0) as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::grid;
    use crate::ids::VertexId;
    use crate::mesh::PolygonMesh;
    use crate::tessellate::tessellate;
    use glam::DVec3;

    #[test]
    fn counts_follow_the_stitch_size() {
        let labelled = grid(2, 3); // faces of 10 mm × 10 mm
        let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(1e-3)).unwrap();
        let stitches = tessellate(&labelled, &counts).unwrap();
        assert_eq!(stitches.rows().len(), 3 * 13);
        assert!(stitches.rows().iter().all(|r| r.faces.len() == 20));
    }

    #[test]
    fn equal_edges_get_equal_counts_at_a_tie() {
        let labelled = grid(7, 1);
        let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(0.01 / 1.5)).unwrap();
        let stitches = tessellate(&labelled, &counts).unwrap();
        assert!(stitches.rows().iter().all(|r| r.faces.len() == 14));
    }

    #[test]
    fn absurd_sizes_are_refused() {
        let labelled = grid(1, 1);
        let counts = |width| EdgeCounts::from_size(&labelled, StitchSize::of_width(width));
        assert!(matches!(counts(1e-9), Err(CountError::TooMany(_))));
        assert!(matches!(counts(f64::NAN), Err(CountError::StitchSize(_))));
        assert!(matches!(counts(-1.0), Err(CountError::StitchSize(_))));
    }

    #[test]
    fn widths_that_hardly_change_keep_their_count() {
        // A column of quads that widens from 20 to 23 mm by a tenth of a stitch a row, and then to 30 mm at once.
        let widths = [20.0, 20.6, 21.4, 22.4, 22.9, 30.0];
        let positions = widths
            .iter()
            .enumerate()
            .flat_map(|(j, w)| [-0.5, 0.5].map(|side| DVec3::new(w * side, j as f64 * 10.0, 0.0) * 1e-3));
        let faces: Vec<Vec<u32>> = (0..5).map(|j| [0, 1, 3, 2].map(|k| 2 * j + k).to_vec()).collect();
        let mut labelled = LabelledMesh::new(PolygonMesh::new(positions.collect(), &faces).unwrap());
        let hem = labelled.mesh().edge_between(VertexId(0), VertexId(1)).unwrap();
        labelled.fill_from_border(hem).unwrap();
        let labelled = crate::autolabel::autolabel(&labelled);
        let counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(3e-3)).unwrap();
        let course = |j: u32| {
            let edge = labelled.mesh().edge_between(VertexId(2 * j), VertexId(2 * j + 1)).unwrap();
            counts.counts[edge.index()]
        };
        assert_eq!((0..6).map(course).collect::<Vec<_>>(), [7, 7, 7, 7, 7, 10]);
    }
}
