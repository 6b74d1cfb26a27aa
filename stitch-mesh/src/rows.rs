//! The rows of a stitch mesh, and how high each of them lies.

use crate::ids::FaceId;
use crate::label::Row;
use crate::stitch_mesh::StitchMesh;
use rayon::prelude::*;

impl StitchMesh {
    /// All rows, lower rows before those above them; a closed row begins above the beginning of the row below it, so that
    /// columns line up.
    pub fn rows(&self) -> Vec<Row> {
        self.rows_and_heights().0
    }

    /// The rows at some heights, from the first to the last: of pieces that are knitted beside each other, and on both sides of a
    /// neck, those of each. `None` where there are none so high.
    pub fn rows_between(&self, [first, last]: [usize; 2]) -> Option<Vec<Row>> {
        let (rows, heights) = self.rows_and_heights();
        let exist = first <= last && heights.last().is_some_and(|highest| last <= *highest);
        let within = rows.into_iter().zip(heights).filter(|(_, height)| (first..=last).contains(height));
        let within: Vec<Row> = within.map(|(row, _)| row).collect();
        (exist && !within.is_empty()).then_some(within)
    }

    /// All rows as [`Self::rows`] has them, and how high each lies: one more than the highest row below it, from 0, so that pieces that
    /// are knitted beside each other count their rows alike.
    pub fn rows_and_heights(&self) -> (Vec<Row>, Vec<usize>) {
        let mut row_of = vec![usize::MAX; self.mesh().face_count()];
        let mut rows = Vec::new();
        for face in self.mesh().faces() {
            if row_of[face.index()] == usize::MAX {
                let row = self.row_of(face);
                row.faces.iter().for_each(|f| row_of[f.index()] = rows.len());
                rows.push(row);
            }
        }
        // Which row lies on which, each pair once for every run of faces in which they meet.
        let below = |(r, row): (usize, &Row)| {
            let below = row.faces.iter().flat_map(|f| self.below(*f)).map(|f| [row_of[f.index()], r]);
            let mut below: Vec<_> = below.collect();
            below.dedup();
            below
        };
        let stacked: Vec<[usize; 2]> = rows.par_iter().enumerate().flat_map_iter(below).collect();
        // Height of a row: one more than the highest below it. A garment knitted in a circle (a Möbius band of rows) has no
        // lowest row; going round more often than there are rows says so, and the heights so far are as good as any.
        let mut height = vec![0usize; rows.len()];
        for _ in 0..rows.len() {
            let mut changed = false;
            for [below, r] in &stacked {
                let h = height[*below] + 1;
                if h > height[*r] && h <= rows.len() {
                    height[*r] = h;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by_key(|r| (height[*r], *r));
        let mut sorted: Vec<Row> = Vec::with_capacity(rows.len());
        let mut begins = vec![false; self.mesh().face_count()];
        // In a circle they are counted as they come.
        let is_circle = stacked.iter().any(|[below, r]| height[*below] >= height[*r]);
        let heights = (0..).zip(&order).map(|(i, r)| if is_circle { i } else { height[*r] }).collect();
        for r in order {
            let mut row = std::mem::take(&mut rows[r]);
            if row.closed
                && let Some(start) = row.faces.iter().position(|f| {
                    let mut below = self.below(*f);
                    below.next().is_some_and(|b| begins[b.index()])
                })
            {
                row.faces.rotate_left(start);
            }
            begins[row.faces[0].index()] = true;
            sorted.push(row);
        }
        (sorted, heights)
    }

    /// The row through a face, left to right.
    pub fn row_of(&self, face: FaceId) -> Row {
        let right = |f: FaceId| self.mesh().face_across(self.right(f));
        let left = |f: FaceId| self.mesh().face_across(self.left(f));
        let mut faces = vec![face];
        let mut at = face;
        while let Some(next) = right(at) {
            if next == face {
                return Row { faces, closed: true };
            }
            faces.push(next);
            at = next;
        }
        let mut before: Vec<FaceId> = std::iter::successors(left(face), |f| left(*f)).collect();
        before.reverse();
        before.append(&mut faces);
        Row { faces: before, closed: false }
    }
}
