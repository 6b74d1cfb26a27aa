//! Regions of stitches of one kind.

use crate::ids::FaceId;
use crate::stitch_mesh::StitchMesh;

impl StitchMesh {
    /// A face and all faces with the same stitch that can be reached from it over such faces, in order of their numbers.
    pub fn region(&self, face: FaceId) -> Vec<FaceId> {
        let mesh = self.mesh();
        let mut inside = vec![false; mesh.face_count()];
        inside[face.index()] = true;
        let mut open = vec![face];
        while let Some(at) = open.pop() {
            for next in mesh.face_half_edges(at).filter_map(|h| mesh.face_across(h)) {
                if !inside[next.index()] && self.stitch(next) == self.stitch(face) {
                    inside[next.index()] = true;
                    open.push(next);
                }
            }
        }
        mesh.faces().filter(|f| inside[f.index()]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_counts::StitchSize;
    use crate::pieces::rectangle;
    use crate::stitch::Stitch;

    #[test]
    fn a_region_ends_at_other_stitches() {
        let mut fabric = rectangle(5, 3, StitchSize::of_width(3e-3)).unwrap();
        for row in fabric.rows() {
            fabric.set_stitch(row.faces[2], Stitch::purl()).unwrap();
        }
        assert_eq!(fabric.region(FaceId(0)), [0, 1, 5, 6, 10, 11].map(FaceId));
        assert_eq!(fabric.region(FaceId(7)), [2, 7, 12].map(FaceId));
    }
}
