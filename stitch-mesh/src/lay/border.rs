//! Borders: cast-on, bind-off, and rows joined at their ends (Yuksel et al. §4.3, Fig. 6).
//!
//! Walking along a border with the fabric on the left, one meets bottom edges from left to right, top edges from right to
//! left, and the ends of rows at wale edges. A run of bottom edges is a **cast-on**: the loops on them are joined one to the
//! next. A run of top edges is a **bind-off**: one more row of knits in cells beyond the border, each through its fabric loop
//! and the bind-off loop before it; where the run has an end, the yarn is drawn through the last loop. A border of one kind
//! all round closes on itself without any end.
//!
//! Rows that end at a border, cast-ons and bind-offs are strands with two ends. The ends stand in a circle along the border,
//! and a strand's end is joined to the neighbouring end of a higher strand: so a flat piece becomes one yarn going back and
//! forth from cast-on to bind-off, and so do the panels above an armhole. What stays loose gets a tail.

use super::cell::{Cell, FaceFrame};
use super::{Draft, Port, course_port, wale_port};
use crate::ids::HalfEdgeId;
use crate::stitch::{Make, Op, Stitch};
use crate::stitch_mesh::StitchMesh;
use glam::{DVec2, DVec3};
use smallvec::{SmallVec, smallvec};
use std::collections::{HashMap, HashSet};

/// Height of a bind-off cell, as a part of the face below it.
const BIND_OFF_HEIGHT: f64 = 0.7;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Bottom,
    Top,
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

struct BindOffCell {
    edge: HalfEdgeId,
    left: Port,
    right: Port,
}

/// Adds cast-on, bind-off and row joins to a draft.
pub fn finish(stitches: &StitchMesh, vertex_normals: &[DVec3], draft: &mut Draft) {
    let mesh = stitches.mesh();
    let mut height = vec![0.0; mesh.face_count()];
    for (r, row) in stitches.rows().iter().enumerate() {
        row.faces.iter().for_each(|f| height[f.index()] = r as f64);
    }
    let height_at = |h: &HalfEdgeId| height[mesh.face(*h).index()];
    // The loose ends in the order of each border, with their heights, and the bind-offs.
    let mut circles: Vec<Vec<(Port, f64)>> = Vec::new();
    let mut strands: Vec<Strand> = Vec::new();
    for ring in mesh.borders() {
        let mut circle = Vec::new();
        for (side, run) in runs(stitches, &ring) {
            let closed = run.len() == ring.len();
            match side {
                Side::Wale => circle.push((wale_port(run[0]), height_at(&run[0]))),
                Side::Bottom => {
                    let ends = cast_on(&run, closed, draft);
                    let lowest = run.iter().map(height_at).fold(f64::INFINITY, f64::min);
                    if !closed {
                        circle.extend(ends.map(|port| (port, lowest - 0.5)));
                    }
                }
                Side::Top => {
                    let cells = bind_off_cells(&run, draft);
                    let ends = [cells[0].left, cells[cells.len() - 1].right];
                    if closed {
                        draft.join(ends[0], ends[1]);
                        bind_off(stitches, vertex_normals, &cells, BindOff::Round, draft);
                    } else {
                        let highest = run.iter().map(height_at).fold(0.0, f64::max) + 0.5;
                        strands.push(Strand { ends, height: highest, bind_off: cells });
                        circle.extend([(ends[1], highest), (ends[0], highest)]);
                    }
                }
            }
        }
        circles.push(circle);
    }
    // Whatever else ends at a border is found by following its yarn from end to end.
    let piece_at = draft.piece_at_ports();
    let mut ended: HashSet<Port> = strands.iter().flat_map(|s| s.ends).collect();
    let heights: HashMap<Port, f64> = circles.iter().flatten().copied().collect();
    for (port, height) in circles.iter().flatten() {
        if ended.insert(*port)
            && let (_, Some(other)) = draft.follow(&piece_at, *port)
            && ended.insert(other)
        {
            let height = heights.get(&other).map_or(*height, |h| h.min(*height));
            strands.push(Strand { ends: [*port, other], height, bind_off: vec![] });
        }
    }
    let circles = circles.into_iter().map(|c| c.into_iter().map(|(port, _)| port).collect()).collect();
    join_strands(stitches, vertex_normals, &strands, circles, draft);
}

/// Cuts a border into runs of one kind; wale edges come one by one.
fn runs(stitches: &StitchMesh, ring: &[HalfEdgeId]) -> Vec<(Side, Vec<HalfEdgeId>)> {
    let side = |h: HalfEdgeId| match (stitches.is_wale(h), stitches.is_bottom(h)) {
        (true, _) => Side::Wale,
        (false, true) => Side::Bottom,
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

/// Joins the loops on a run of bottom edges, left to right. Returns the ends.
fn cast_on(run: &[HalfEdgeId], closed: bool, draft: &mut Draft) -> [Port; 2] {
    for pair in run.windows(2) {
        draft.join(course_port(pair[0], 1), course_port(pair[1], 0));
    }
    let ends = [course_port(run[0], 0), course_port(run[run.len() - 1], 1)];
    if closed {
        draft.join(ends[1], ends[0]);
    }
    ends
}

/// Cells with joined ports above a run of top edges (which come right to left).
fn bind_off_cells(run: &[HalfEdgeId], draft: &mut Draft) -> Vec<BindOffCell> {
    let cells: Vec<BindOffCell> = run
        .iter()
        .rev()
        .map(|h| BindOffCell { edge: *h, left: draft.new_port(), right: draft.new_port() })
        .collect();
    for pair in cells.windows(2) {
        draft.join(pair[0].right, pair[1].left);
    }
    // Until the cells are laid, the legs of a loop are joined as they will be through its cell: so its yarn can be followed.
    for h in run {
        draft.join(course_port(*h, 0), course_port(*h, 1));
    }
    cells
}

/// The way in which a bind-off is worked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum BindOff {
    Rightwards,
    Leftwards,
    Round,
}

/// Lays the bind-off stitches. Returns, for one with an end, the port at which the yarn leaves after it has been drawn
/// through the last loop.
fn bind_off(
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    cells: &[BindOffCell],
    way: BindOff,
    draft: &mut Draft,
) -> Option<Port> {
    let mesh = stitches.mesh();
    let mut previous: Option<[Port; 2]> = None;
    let n = cells.len();
    // Going round, the first stitch takes the last one's loop.
    let tops: Vec<[Port; 2]> = (0..n).map(|_| [draft.new_port(), draft.new_port()]).collect();
    let order: Vec<usize> = if way == BindOff::Leftwards { (0..n).rev().collect() } else { (0..n).collect() };
    if way == BindOff::Round {
        previous = tops.last().copied();
    }
    for i in order {
        let BindOffCell { edge, left, right } = cells[i];
        let face = mesh.face(edge);
        let frame = FaceFrame::of_face(stitches, vertex_normals, face);
        let up = (frame.position(DVec2::new(0.5, 0.9)) - frame.position(DVec2::new(0.5, 0.1))) / 0.8
            * BIND_OFF_HEIGHT;
        let (from, to) = (mesh.position(mesh.tip(edge)), mesh.position(mesh.origin(edge)));
        let normal = vertex_normals[mesh.tip(edge).index()] + vertex_normals[mesh.origin(edge).index()];
        let frame = FaceFrame::beyond_border([from, to, to + up, from + up], normal.normalize_or(DVec3::Z));
        let legs = [draft.new_port(), draft.new_port()];
        draft.join(legs[0], course_port(edge, 1));
        draft.join(legs[1], course_port(edge, 0));
        let mut bottoms: SmallVec<[[Port; 2]; 2]> = smallvec![legs];
        if let Some(previous) = previous {
            let passed_over = [draft.new_port(), draft.new_port()];
            draft.join(passed_over[0], previous[0]);
            draft.join(passed_over[1], previous[1]);
            bottoms.push(passed_over);
        }
        // The bind-off loop before is passed over the fabric loop: it lies in front.
        let stack = (0..bottoms.len() as u8).rev().collect();
        let knit = Stitch { ops: smallvec![Op { make: Make::Knit, twist: 0 }], stack };
        Cell { left, right, bottoms, tops: smallvec![tops[i]] }.lay(&knit, &frame, draft);
        previous = Some(tops[i]);
        let is_last = i + 1 == n && way == BindOff::Rightwards || i == 0 && way == BindOff::Leftwards;
        if is_last {
            return Some(fasten(
                tops[i],
                if way == BindOff::Leftwards { left } else { right },
                way,
                [from, to],
                up,
                normal,
                draft,
            ));
        }
    }
    None
}

/// Draws the yarn that leaves at `from` through the last loop.
fn fasten(
    last: [Port; 2],
    from: Port,
    way: BindOff,
    [left, right]: [DVec3; 2],
    up: DVec3,
    normal: DVec3,
    draft: &mut Draft,
) -> Port {
    let along = (right - left) * if way == BindOff::Leftwards { -1.0 } else { 1.0 };
    let corners = [left, right, right + up, left + up].map(|c| c + along * 0.8 + up * 0.3);
    let frame = FaceFrame::beyond_border(corners, normal.normalize_or(DVec3::Z));
    let mut port = || draft.new_port();
    let (entry, exit, legs) = (port(), port(), [port(), port()]);
    draft.join(entry, from);
    legs.iter().zip(last).for_each(|(a, b)| draft.join(*a, b));
    let (left, right) = if way == BindOff::Leftwards { (exit, entry) } else { (entry, exit) };
    let gather = Stitch { ops: smallvec![], stack: smallvec![0] };
    Cell { left, right, bottoms: smallvec![legs], tops: smallvec![] }.lay(&gather, &frame, draft);
    exit
}

/// Joins strands end to end, always upwards, and lays each bind-off in the direction in which the yarn reaches it.
fn join_strands(
    stitches: &StitchMesh,
    vertex_normals: &[DVec3],
    strands: &[Strand],
    circles: Vec<Vec<Port>>,
    draft: &mut Draft,
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
                let way = if entered == 0 { BindOff::Rightwards } else { BindOff::Leftwards };
                leaves = bind_off(stitches, vertex_normals, &strand.bind_off, way, draft).unwrap_or(end);
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
