//! Where in a region a pattern has room.

use std::collections::{HashMap, HashSet};
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::Row;
use stitch_mesh::stitch_mesh::StitchMesh;

/// For every row how many of the region lie below it.
pub(super) fn levels(stitches: &StitchMesh, rows: &[Row], region: &HashSet<FaceId>) -> Vec<usize> {
    let mut level_of: HashMap<FaceId, usize> = HashMap::new();
    let mut levels = Vec::with_capacity(rows.len());
    for row in rows {
        let faces = || row.faces.iter().filter(|f| region.contains(f));
        let below = faces().flat_map(|f| stitches.below(*f)).filter_map(|f| level_of.get(&f)).max();
        let level = below.map_or(0, |l| l + 1);
        level_of.extend(faces().map(|f| (*f, level)));
        levels.push(level);
    }
    levels
}

/// Plain stitches side by side and above each other.
pub(super) struct Band {
    /// Rows of faces, the lowest first.
    pub faces: Vec<Vec<FaceId>>,
    /// Whether it goes all round.
    pub closed: bool,
}

/// What is left of the region, and the columns of what is tiled.
pub(super) struct Bands<'s> {
    stitches: &'s StitchMesh,
    open: HashSet<FaceId>,
    /// Column within the repeat of tiled faces.
    column: HashMap<FaceId, usize>,
}

impl<'s> Bands<'s> {
    pub fn new(stitches: &'s StitchMesh, region: HashSet<FaceId>) -> Self {
        Self { stitches, open: region, column: HashMap::new() }
    }

    fn is_open(&self, face: FaceId) -> bool {
        let stitch = self.stitches.stitch(face);
        self.open.contains(&face) && (stitch.bottoms(), stitch.tops()) == (1, 1)
    }

    /// The stitch that stands alone above another.
    fn next(&self, face: FaceId) -> Option<FaceId> {
        self.stitches
            .above(face)
            .next()
            .filter(|f| self.is_open(*f) && self.stitches.below(*f).next() == Some(face))
    }

    /// Bands whose lowest stitches are in a row: of the full height where anything is so high, otherwise of the largest one
    /// that all of it has.
    pub fn above(&self, row: &Row, heights: &[usize]) -> Vec<Band> {
        let Some(full) = heights.last().copied() else { return Vec::new() };
        let columns: Vec<Vec<FaceId>> = row
            .faces
            .iter()
            .map(|face| {
                let first = Some(*face).filter(|f| self.is_open(*f));
                std::iter::successors(first, |f| self.next(*f)).take(full).collect()
            })
            .collect();
        let tallest = columns.iter().map(Vec::len).max().unwrap_or(0);
        let Some(high) = heights.iter().copied().filter(|h| *h <= tallest).max() else { return Vec::new() };
        let fits = |i: usize| columns[i].len() >= high;
        let n = columns.len();
        // Whether a column and the one on its right are neighbours all the way up.
        let joined = |i: usize| {
            let (a, b) = (&columns[i], &columns[(i + 1) % n]);
            let beside = |f: FaceId| self.stitches.mesh().face_across(self.stitches.right(f));
            (i + 1 < n || row.closed)
                && fits(i)
                && fits((i + 1) % n)
                && (0..high).all(|r| beside(a[r]) == Some(b[r]))
        };
        let band = |columns_of: Vec<usize>, closed: bool| Band {
            faces: (0..high).map(|r| columns_of.iter().map(|i| columns[*i][r]).collect()).collect(),
            closed,
        };
        if row.closed && (0..n).all(joined) {
            return vec![band((0..n).collect(), true)];
        }
        let starts = (0..n).filter(|i| fits(*i) && !joined((i + n - 1) % n));
        let run = |start: usize| {
            let mut run = vec![start];
            while joined(run[run.len() - 1] % n) && run.len() < n {
                run.push((run[run.len() - 1] + 1) % n);
            }
            run
        };
        starts.map(|start| band(run(start), false)).collect()
    }

    /// How wide a swatch is in a band after all, and where it begins: above the columns of the band below, or in the middle.
    pub fn place(&self, band: &Band, mut wide: usize, repeat: usize, narrowest: usize) -> (usize, usize) {
        let room = band.faces[0].len();
        let column = |i: usize| {
            let below = self.stitches.below(band.faces[0][i]).next()?;
            self.column.get(&below).map(|column| (i + repeat - column) % repeat)
        };
        let Some(begin) = (0..room).find_map(column) else { return (wide, (room - wide) / 2) };
        if band.closed && wide == room {
            return (wide, begin);
        }
        loop {
            let middle = (room - wide) / 2;
            let starts = (begin..=room - wide).step_by(repeat);
            match starts.min_by_key(|s| s.abs_diff(middle)) {
                Some(start) => return (wide, start),
                None if wide >= narrowest + repeat => wide -= repeat,
                None => return (wide, middle),
            }
        }
    }

    pub fn take(&mut self, faces: &[Vec<FaceId>], repeat: usize) {
        for row in faces {
            for (i, face) in row.iter().enumerate() {
                self.open.remove(face);
                self.column.insert(*face, i % repeat);
            }
        }
    }
}
