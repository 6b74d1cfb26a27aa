//! Blocks of plain stitches knitted anew from rows of other ones (Yuksel et al. §5.3: "tiling").
//!
//! A block keeps its outline: its lowest course edges, its highest ones and both its sides. Inside it the rows lie between the
//! same rows of course edges; where one has another number of loops now, its vertices are spread anew along it.

use super::{EditError, Edited, Survivors};
use crate::cable::Cable;
use crate::ids::{FaceId, VertexId};
use crate::mesh::PolygonMesh;
use crate::needle::Item;
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use glam::DVec3;

/// A block, and what is to be knitted there.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its stitches, the lowest row first, each left to right. Every one joins one loop to one, and lies above the one in the
    /// same place of the row below.
    pub faces: Vec<Vec<FaceId>>,
    /// As many rows of stitches and cables, left to right. The lowest works as many loops as the block is wide, each other one
    /// what the row below it makes, and the highest makes as many as the block is wide.
    pub rows: Vec<Vec<Item>>,
}

/// A face on its way into the new mesh.
struct NewFace {
    vertices: Vec<u32>,
    stitch: Stitch,
    /// The face that it takes after.
    from: FaceId,
}

impl StitchMesh {
    /// Knits blocks anew. They must not overlap. New stitches have colour and wrapping of the old one in the same place; marks
    /// outside of the blocks stay, cables inside go.
    ///
    /// # Errors
    /// [`EditError`]: rows that do not fit a block, or a cable that cannot cross.
    pub fn reknit(&self, blocks: &[Block]) -> Result<Edited, EditError> {
        let mut positions = self.mesh().positions().to_vec();
        let mut replaced: Vec<Option<Vec<NewFace>>> = (0..self.stitches().len()).map(|_| None).collect();
        let mut marks = self.marks().clone();
        let mut cables = Vec::new();
        for block in blocks {
            let chains = self.chains(block, &mut positions)?;
            let cut = |cable: &Cable| {
                let inside = |chain: &[u32], w: &[VertexId]| {
                    chain.windows(2).any(|c| [c[0], c[1]] == [w[0].0, w[1].0])
                };
                let highest = chains.len() - 1;
                let old = (0..highest).any(|r| {
                    let chain = self.chain(block, r);
                    cable.path.windows(2).any(|w| inside(&chain, w))
                });
                old || cable.path.windows(2).any(|w| chains[1..highest].iter().any(|c| inside(c, w)))
            };
            marks.cables.retain(|cable| !cut(cable));
            for (r, row) in block.rows.iter().enumerate() {
                self.row(block, r, row, [&chains[r], &chains[r + 1]], &mut replaced, &mut cables);
            }
        }
        let mut faces = Vec::new();
        let (mut stitches, mut places) = (Vec::new(), Vec::new());
        let (mut dyes, mut wrappings) = (Vec::new(), Vec::new());
        let mut survivors = Survivors { vertices: Vec::new(), faces: Vec::with_capacity(replaced.len()) };
        for (face, new) in self.mesh().faces().zip(replaced) {
            let new = new.unwrap_or_else(|| {
                let vertices = self.mesh().face_vertices(face).map(|v| v.0).collect();
                vec![NewFace { vertices, stitch: self.stitch(face).clone(), from: face }]
            });
            survivors.faces.push((!new.is_empty()).then(|| FaceId::new(faces.len())));
            for (i, NewFace { vertices, stitch, from }) in new.into_iter().enumerate() {
                // Only one stitch can be in a place of the input.
                places.push(self.places()[face.index()].filter(|_| i == 0));
                dyes.push(self.dyes()[from.index()]);
                wrappings.push(self.wrappings()[from.index()]);
                faces.push(vertices);
                stitches.push(stitch);
            }
        }
        let mut used = vec![false; positions.len()];
        faces.iter().flatten().for_each(|v| used[*v as usize] = true);
        let now: Vec<u32> = used
            .iter()
            .scan(0, |count, used| Some(std::mem::replace(count, *count + u32::from(*used))))
            .collect();
        let vertex = |v: VertexId| VertexId(now[v.index()]);
        faces.iter_mut().flatten().for_each(|v| *v = now[*v as usize]);
        let old = 0..self.mesh().vertex_count();
        survivors.vertices = old.map(|v| used[v].then(|| VertexId(now[v]))).collect();
        marks.cables.extend(cables);
        marks.cables.iter_mut().flat_map(|c| &mut c.path).for_each(|v| *v = vertex(*v));
        marks.seams.iter_mut().flat_map(|s| s.a.iter_mut().chain(&mut s.b)).for_each(|v| *v = vertex(*v));
        marks.live = marks.live.iter().map(|e| crate::seam::sorted(e.map(vertex))).collect();
        let kept = positions.iter().zip(&used).filter(|(_, used)| **used).map(|(p, _)| *p);
        let mesh = PolygonMesh::new(kept.collect(), &faces)?;
        Ok((Self::new(mesh, stitches)?.with(dyes, wrappings, places, marks)?, survivors))
    }

    /// Vertices below a row of a block, left to right; above the highest row for the one after it.
    fn chain(&self, block: &Block, row: usize) -> Vec<u32> {
        let mesh = self.mesh();
        let below = row < block.faces.len();
        let faces = &block.faces[row.min(block.faces.len() - 1)];
        let left = |f: FaceId| if below { mesh.tip(self.left(f)) } else { mesh.origin(self.left(f)) };
        let right = |f: FaceId| if below { mesh.origin(self.right(f)) } else { mesh.tip(self.right(f)) };
        std::iter::once(left(faces[0])).chain(faces.iter().map(|f| right(*f))).map(|v| v.0).collect()
    }

    /// The rows of vertices of the block as they will be.
    fn chains(&self, block: &Block, positions: &mut Vec<DVec3>) -> Result<Vec<Vec<u32>>, EditError> {
        let wide = block.faces.first().map_or(0, Vec::len);
        if wide == 0
            || block.faces.iter().any(|row| row.len() != wide)
            || block.rows.len() != block.faces.len()
        {
            return Err(EditError::NotABlock);
        }
        let plain = |f: &FaceId| (self.stitch(*f).bottoms(), self.stitch(*f).tops()) == (1, 1);
        if let Some(face) = block.faces.iter().flatten().find(|f| !plain(f)) {
            return Err(EditError::NotPlain(*face));
        }
        let mut loops = wide;
        let mut chains = vec![self.chain(block, 0)];
        for (r, row) in block.rows.iter().enumerate() {
            if row.iter().any(|item| matches!(item, Item::BindOff(_) | Item::CastOn(_))) {
                return Err(EditError::Edge(r));
            }
            let worked: usize = row.iter().map(Item::uses).sum();
            let made = row.iter().map(Item::makes).sum();
            let last = r + 1 == block.rows.len();
            let below = self.chain(block, r);
            if chains[r].first() != below.first() || (last && made != wide) || worked != loops {
                let (row, loops) = (r, if worked == loops { wide } else { loops });
                return Err(EditError::Row { row, worked, made, loops });
            }
            loops = made;
            let old = self.chain(block, r + 1);
            chains.push(if made == wide { old } else { spread(&old, made, positions) });
        }
        Ok(chains)
    }

    /// Puts the stitches of a row in the place of those that were there.
    fn row(
        &self,
        block: &Block,
        r: usize,
        items: &[Item],
        [below, above]: [&[u32]; 2],
        replaced: &mut [Option<Vec<NewFace>>],
        cables: &mut Vec<Cable>,
    ) {
        let old = &block.faces[r];
        old.iter().for_each(|f| replaced[f.index()] = Some(Vec::new()));
        let (mut i, mut j) = (0, 0);
        let total = below.len() - 1;
        for item in items {
            let stitches = match item {
                Item::Stitch(stitch) => std::slice::from_ref(stitch),
                Item::Cross(cable, stitches) => {
                    let path = below[i..=i + cable.loops()].iter().copied().map(VertexId).collect();
                    cables.push(Cable { path, ..cable.clone() });
                    stitches
                }
                Item::BindOff(_) | Item::CastOn(_) => &[],
            };
            for stitch in stitches {
                let bottoms = below[i..=i + stitch.bottoms()].iter();
                let tops = above[j..=j + stitch.tops()].iter().rev();
                let from = old[(i * old.len() / total.max(1)).min(old.len() - 1)];
                let face = NewFace {
                    vertices: bottoms.chain(tops).copied().collect(),
                    stitch: stitch.clone(),
                    from,
                };
                replaced[from.index()].get_or_insert_default().push(face);
                (i, j) = (i + stitch.bottoms(), j + stitch.tops());
            }
        }
    }
}

/// A row of vertices between the same ends with another number of loops, at the same distances along it.
fn spread(chain: &[u32], loops: usize, positions: &mut Vec<DVec3>) -> Vec<u32> {
    let n = chain.len() - 1;
    let mut spread = vec![chain[0]];
    for i in 1..loops {
        let along = i as f64 * n as f64 / loops as f64;
        let edge = (along as usize).min(n - 1);
        let [a, b] = [edge, edge + 1].map(|k| positions[chain[k] as usize]);
        positions.push(a.lerp(b, along - edge as f64));
        spread.push(positions.len() as u32 - 1);
    }
    spread.push(chain[n]);
    spread
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_counts::StitchSize;
    use crate::lay::lay;
    use crate::pieces::{rectangle, tube};
    use crate::unravel::loose_loops;
    use crate::wrapping::Wrapping;

    fn row(text: &str) -> Vec<Item> {
        text.split_whitespace().map(|s| Item::Stitch(s.parse().unwrap())).collect()
    }

    /// Faces `columns` wide and `rows` high of a fabric that is `wide`.
    fn block(wide: u32, [left, low]: [u32; 2], rows: Vec<Vec<Item>>, columns: u32) -> Block {
        let face = |r: u32, c: u32| FaceId((low + r) * wide + (left + c) % wide);
        let faces = (0..rows.len() as u32).map(|r| (0..columns).map(|c| face(r, c)).collect());
        Block { faces: faces.collect(), rows }
    }

    #[test]
    fn lace_is_knitted_into_the_middle() {
        let fabric = rectangle(8, 6, StitchSize::of_width(3e-3)).unwrap();
        let rows = vec![row("k ky d12k k"), row("k kpk d123k k"), row("d12k yk k k")];
        let (edited, survivors) = fabric.reknit(&[block(8, [2, 1], rows, 5)]).err().map_or_else(
            || unreachable!(),
            |error| {
                assert!(
                    matches!(error, EditError::Row { row: 1, worked: 6, made: 6, loops: 5 }),
                    "{error:?}"
                );
                let rows = vec![row("k ky d12k k"), row("k k kp d12k"), row("d12k yk k k")];
                fabric.reknit(&[block(8, [2, 1], rows, 5)]).unwrap()
            },
        );
        assert_eq!(edited.mesh().face_count(), 48 - 3);
        assert!(loose_loops(&edited, &lay(&edited)).is_empty());
        let counts: Vec<usize> = edited.rows().iter().map(|r| r.faces.len()).collect();
        assert_eq!(counts, [8, 7, 7, 7, 8, 8]);
        assert_eq!(survivors.faces.iter().flatten().count(), 45);
        assert!(survivors.vertices.iter().all(Option::is_some), "no row has changed its number of loops");
    }

    #[test]
    fn new_stitches_take_after_the_old_ones_in_their_place() {
        let mut fabric = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
        let slack = Wrapping { modulus: 0.5, angle: None };
        [1, 2, 20].into_iter().for_each(|f| fabric.set_wrapping(FaceId(f), slack).unwrap());
        let rows = vec![row("d12k k k k"), row("kp k k k")];
        let (edited, survivors) = fabric.reknit(&[block(6, [1, 0], rows, 5)]).unwrap();
        let wrapped_so = edited.mesh().faces().filter(|f| edited.wrappings()[f.index()] == slack);
        assert_eq!(wrapped_so.collect::<Vec<_>>(), [FaceId(1), survivors.faces[20].unwrap()]);
    }

    #[test]
    fn rows_that_swell_spread_their_vertices() {
        let fabric = tube(6, 4, StitchSize::of_width(3e-3)).unwrap();
        let rows = vec![row("kyk k k kyk k k"), row("d123k k k d123k k k")];
        let (edited, _) = fabric.reknit(&[block(6, [0, 1], rows, 6)]).unwrap();
        assert_eq!(edited.loop_count(), 6 + 10 + 6 + 6);
        assert!(edited.rows().iter().all(|r| r.closed));
        assert!(loose_loops(&edited, &lay(&edited)).is_empty());
    }

    #[test]
    fn cables_come_and_go() {
        let mut fabric = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
        let path = [15, 16, 17].map(VertexId).to_vec();
        fabric.set_cable(Cable::cross(path, 1, 1, true)).unwrap();
        let cross = Item::Cross(Cable::cross(Vec::new(), 2, 2, false), vec![Stitch::knit(); 4]);
        let rows = vec![row("k k k k"), vec![cross]];
        let (edited, _) = fabric.reknit(&[block(6, [1, 1], rows, 4)]).unwrap();
        assert_eq!(edited.cables().len(), 1);
        assert_eq!(edited.cables()[0].strands, [2, 2]);
    }

    #[test]
    fn blocks_are_checked() {
        let fabric = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
        let wrong = fabric.reknit(&[block(6, [0, 0], vec![row("k k")], 3)]);
        assert!(matches!(wrong, Err(EditError::Row { row: 0, worked: 2, loops: 3, .. })));
        let cross = Item::Cross(Cable::cross(Vec::new(), 1, 1, false), vec![Stitch::knit(); 2]);
        assert!(fabric.reknit(&[block(6, [0, 0], vec![vec![cross]], 2)]).is_err(), "nothing below");
        let bound = vec![vec![Item::BindOff(3)], vec![Item::CastOn(3)]];
        assert_eq!(fabric.reknit(&[block(6, [0, 0], bound, 3)]).unwrap_err(), EditError::Edge(0));
        assert_eq!(fabric.reknit(&[]).unwrap().0, fabric);
    }
}
