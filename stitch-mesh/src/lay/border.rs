//! Borders: cast-on, bind-off, live loops, and rows joined at their ends (Yuksel et al. §4.3, Fig. 6).
//!
//! Walking along a border with the fabric on the left, one meets bottom edges from left to right, top edges from right to
//! left, and the ends of rows at wale edges. A run of bottom edges is a **cast-on**: the loops on them are joined one to the
//! next. A run of top edges is a **bind-off** ([`super::bind_off`]); where the run has an end, the yarn is drawn through the
//! last loop. A border of one kind all round closes on itself without any end, unless a spiral begins or ends there. The
//! loops of live edges are left open.
//!
//! Rows that end at a border, cast-ons and bind-offs are strands with two ends. The ends stand in a circle along the border,
//! and a strand's end is joined to the neighbouring end of a higher strand: so a flat piece becomes one yarn going back and
//! forth from cast-on to bind-off, and so do the panels above an armhole. What stays loose gets a tail.

use super::bind_off::{self, BindOffCell, Way};
use super::draft::Draft;
use super::spiral::Spiral;
use super::{Port, course_port, wale_port};
use crate::ids::HalfEdgeId;
use crate::label::Row;
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::NodeKind;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Bottom,
    Top,
    Live,
    Wale,
}

/// A stretch of yarn with two ends on the border.
struct Strand {
    /// Both ends; of a bind-off the left and the right one.
    ends: [Port; 2],
    /// Rows from below; cast-on and bind-off lie half a row beside the row they belong to.
    height: f64,
    /// The bind-off cells, left to right.
    bind_off: Vec<BindOffCell>,
}

/// The ports at which the bind-off yarn leaves the cell above each bound-off edge, on its right.
pub(super) type BoundOff = HashMap<HalfEdgeId, Port>;

/// Adds cast-on, bind-off, live loops and row joins to a draft.
pub(super) fn finish(
    stitches: &StitchMesh,
    rows: &[Row],
    vertex_normals: &[DVec3],
    spirals: &[Spiral],
    draft: &mut Draft<'_>,
) -> BoundOff {
    let mesh = stitches.mesh();
    let mut height = vec![0.0; mesh.face_count()];
    for (r, row) in rows.iter().enumerate() {
        row.faces.iter().for_each(|f| height[f.index()] = r as f64);
    }
    let height_at = |h: &HalfEdgeId| height[mesh.face(*h).index()];
    let mut bound_off = BoundOff::new();
    // The loose ends in the order of each border, with their heights, and the bind-offs.
    let mut circles: Vec<Vec<(Port, f64)>> = Vec::new();
    let mut strands: Vec<Strand> = Vec::new();
    for ring in mesh.borders() {
        let mut circle = Vec::new();
        for (side, mut run) in runs(stitches, &ring) {
            let closed = run.len() == ring.len();
            match side {
                Side::Wale => circle.push((wale_port(run[0]), height_at(&run[0]))),
                Side::Live => run.iter().for_each(|h| leave_live(stitches, vertex_normals, *h, draft)),
                Side::Bottom => {
                    let spiral = spirals
                        .iter()
                        .find(|s| closed && begin_at_face(&mut run, mesh.face(s.first), stitches));
                    let ends = cast_on(&run, draft);
                    let lowest = run.iter().map(height_at).fold(f64::INFINITY, f64::min);
                    match (spiral, closed) {
                        (Some(spiral), _) => draft.join(ends[1], spiral.ends[0]),
                        (None, true) => draft.join(ends[1], ends[0]),
                        (None, false) => circle.extend(ends.map(|port| (port, lowest - 0.5))),
                    }
                }
                Side::Top => {
                    run.reverse(); // left to right, to begin where a spiral ends
                    let spiral = spirals
                        .iter()
                        .find(|s| closed && begin_at_face(&mut run, mesh.face(s.last_row), stitches));
                    run.reverse();
                    let cells = bind_off::cells(&run, draft);
                    bound_off.extend(cells.iter().map(|c| (c.edge, c.right)));
                    let ends = [cells[0].left, cells[cells.len() - 1].right];
                    match (spiral, closed) {
                        (Some(spiral), _) => {
                            draft.join(spiral.ends[1], ends[0]);
                            bind_off::lay(stitches, vertex_normals, &cells, Way::Rightwards, draft);
                        }
                        (None, true) => {
                            draft.join(ends[0], ends[1]);
                            bind_off::lay(stitches, vertex_normals, &cells, Way::Round, draft);
                        }
                        (None, false) => {
                            let highest = run.iter().map(height_at).fold(0.0, f64::max) + 0.5;
                            strands.push(Strand { ends, height: highest, bind_off: cells });
                            circle.extend([(ends[1], highest), (ends[0], highest)]);
                        }
                    }
                }
            }
        }
        circles.push(circle);
    }
    // Whatever else ends at a border is found by following its yarn from end to end.
    let mut ended: HashSet<Port> = strands.iter().flat_map(|s| s.ends).collect();
    let heights: HashMap<Port, f64> = circles.iter().flatten().copied().collect();
    for (port, height) in circles.iter().flatten() {
        if ended.insert(*port)
            && let Some(other) = draft.end_of(*port)
            && ended.insert(other)
        {
            let height = heights.get(&other).map_or(*height, |h| h.min(*height));
            strands.push(Strand { ends: [*port, other], height, bind_off: vec![] });
        }
    }
    let circles = circles.into_iter().map(|c| c.into_iter().map(|(port, _)| port).collect()).collect();
    join_strands(stitches, vertex_normals, &strands, circles, draft);
    bound_off
}

/// Cuts a border into runs of one kind; wale edges come one by one.
fn runs(stitches: &StitchMesh, ring: &[HalfEdgeId]) -> Vec<(Side, Vec<HalfEdgeId>)> {
    let side = |h: HalfEdgeId| match (stitches.is_wale(h), stitches.is_bottom(h)) {
        (true, _) => Side::Wale,
        (false, true) => Side::Bottom,
        (false, false) if stitches.is_live(h) => Side::Live,
        (false, false) => Side::Top,
    };
    let breaks = |a: HalfEdgeId, b: HalfEdgeId| side(b) == Side::Wale || side(a) != side(b);
    let n = ring.len();
    let start = (0..n).find(|i| breaks(ring[(i + n - 1) % n], ring[*i])).unwrap_or(0);
    let mut runs: Vec<(Side, Vec<HalfEdgeId>)> = Vec::new();
    for h in (0..n).map(|i| ring[(start + i) % n]) {
        match runs.last_mut() {
            Some((_, run)) if !breaks(run[run.len() - 1], h) => run.push(h),
            _ => runs.push((side(h), vec![h])),
        }
    }
    runs
}

/// Turns a closed run, which goes from left to right, until it begins with an edge of `face`. False if it has none.
fn begin_at_face(run: &mut [HalfEdgeId], face: crate::ids::FaceId, stitches: &StitchMesh) -> bool {
    let n = run.len();
    let of_face = |i: usize| stitches.mesh().face(run[i % n]) == face;
    let Some(at) = (0..n).find(|i| of_face(*i) && (n == 1 || !of_face(i + n - 1))) else { return false };
    run.rotate_left(at);
    true
}

/// Joins the loops on a run of bottom edges, left to right. Returns the ends.
fn cast_on(run: &[HalfEdgeId], draft: &mut Draft<'_>) -> [Port; 2] {
    for pair in run.windows(2) {
        draft.join(course_port(pair[0], 1), course_port(pair[1], 0));
    }
    [course_port(run[0], 0), course_port(run[run.len() - 1], 1)]
}

/// Closes the loop on a live edge over a node of its own, as over a needle.
fn leave_live(stitches: &StitchMesh, vertex_normals: &[DVec3], h: HalfEdgeId, draft: &mut Draft<'_>) {
    let mesh = stitches.mesh();
    let (left, right) = (mesh.tip(h), mesh.origin(h));
    let face = mesh.face(h);
    let up = stitches.up(face) * 0.4;
    let normal = (vertex_normals[left.index()] + vertex_normals[right.index()]).normalize_or(DVec3::Z);
    let middle = 0.5 * (mesh.position(left) + mesh.position(right));
    let node = draft.add_node(middle + up, normal, NodeKind::Free, up);
    draft.join_through(node, [course_port(h, 1), course_port(h, 0)], stitches.dyes()[face.index()]);
}

/// Joins strands end to end, always upwards, and lays each bind-off in the direction in which the yarn reaches it.
fn join_strands(
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    strands: &[Strand],
    circles: Vec<Vec<Port>>,
    draft: &mut Draft<'_>,
) {
    let mut strand_at: HashMap<Port, (usize, usize)> = HashMap::new();
    for (s, strand) in strands.iter().enumerate() {
        strand.ends.iter().enumerate().for_each(|(side, port)| {
            strand_at.insert(*port, (s, side));
        });
    }
    let mut neighbours: HashMap<Port, [Port; 2]> = HashMap::new();
    for circle in circles {
        let n = circle.len();
        for (i, port) in circle.iter().enumerate() {
            neighbours.insert(*port, [circle[(i + 1) % n], circle[(i + n - 1) % n]]);
        }
    }
    let mut order: Vec<usize> = (0..strands.len()).collect();
    order.sort_by(|a, b| strands[*a].height.total_cmp(&strands[*b].height));
    let mut used = vec![false; strands.len()];
    for first in order {
        let (mut at, mut entered) = (first, 0);
        while !used[at] {
            used[at] = true;
            let strand = &strands[at];
            let end = strand.ends[1 - entered];
            let mut leaves = end;
            if !strand.bind_off.is_empty() {
                let way = if entered == 0 { Way::Rightwards } else { Way::Leftwards };
                leaves = bind_off::lay(stitches, vertex_normals, &strand.bind_off, way, draft).unwrap_or(end);
            }
            let higher = neighbours.get(&end).into_iter().flatten().filter_map(|port| {
                let (s, side) = *strand_at.get(port)?;
                (!used[s] && strands[s].height > strand.height).then_some((s, side, *port))
            });
            let Some((next, side, port)) =
                higher.min_by(|a, b| strands[a.0].height.total_cmp(&strands[b.0].height))
            else {
                break;
            };
            draft.join(leaves, port);
            (at, entered) = (next, side);
        }
    }
}
