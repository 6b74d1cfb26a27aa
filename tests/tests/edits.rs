//! Random edits on fabrics of every topology: whatever is done, the stitch mesh stays one, what is refused changes nothing,
//! and undo leads back to the same document.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::command::Command;
use app::document::Document;
use app::fabric::Fabric;
use app::project::Project;
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use std::collections::HashSet;
use std::sync::Arc;
use stitch_mesh::cable::Cable;
use stitch_mesh::edit::{End, Way};
use stitch_mesh::ids::{EdgeId, FaceId, HalfEdgeId, VertexId};
use stitch_mesh::lay::lay;
use stitch_mesh::mesh::PolygonMesh;
use stitch_mesh::patch::Patch;
use stitch_mesh::stitch::{Make, Op, Stitch};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::unravel::{handed_on_to, loose_loops};
use stitch_mesh::yarn_net::YarnNet;
use tests::fabrics;

/// Numbers from which one edit is made up.
type Dice = (u8, u32, u32, u32);

fn pick<T: Copy>(from: &[T], dice: u32) -> Option<T> {
    (!from.is_empty()).then(|| from[dice as usize % from.len()])
}

fn ends(stitches: &StitchMesh, edge: EdgeId) -> [u32; 2] {
    stitches.mesh().edge_ends(edge).map(|v| v.0)
}

/// An edge that `suits`, if there is one.
fn some_edge(
    stitches: &StitchMesh,
    dice: u32,
    suits: impl Fn(HalfEdgeId, Option<HalfEdgeId>) -> bool,
) -> Option<[u32; 2]> {
    let mesh = stitches.mesh();
    let fitting = |e: &EdgeId| {
        let (h, twin) = mesh.edge_sides(*e);
        suits(h, twin)
    };
    let edges: Vec<EdgeId> = mesh.edges().filter(fitting).collect();
    pick(&edges, dice).map(|e| ends(stitches, e))
}

/// Any stitch with these numbers of loops.
fn some_stitch(bottoms: usize, tops: usize, mut dice: u32) -> Stitch {
    let mut throw = |n: u32| {
        let face = dice % n;
        dice = dice.wrapping_mul(747_796_405).wrapping_add(2_891_336_453) >> 3;
        face
    };
    let mut stack: Vec<u8> = (0..bottoms as u8).collect();
    (1..bottoms).for_each(|i| stack.swap(i, throw(i as u32 + 1) as usize));
    let make = |n| [Make::Knit, Make::Purl, Make::YarnOver, Make::Slip, Make::Cross][n as usize];
    let ops = (0..tops).map(|_| Op { make: make(throw(5)), twist: throw(3) as i8 - 1 }).collect();
    let stitch = Stitch { ops, stack: stack.into() };
    stitch.to_string().parse().unwrap_or_else(|_| Stitch::default_for(bottoms, tops, dice.is_multiple_of(2)))
}

/// Loops side by side above a row, from a stitch to the right.
fn some_cable(stitches: &StitchMesh, face: FaceId, dice: u32) -> Option<Command> {
    let mesh = stitches.mesh();
    let mut path = Vec::new();
    let mut at = Some(face);
    let loops = 2 + dice as usize % 5;
    for _ in 0..loops {
        let Some(face) = at.filter(|_| path.len() <= loops) else { break };
        for h in stitches.tops(face).take((loops + 1).saturating_sub(path.len().max(1))) {
            if path.is_empty() {
                path.push(mesh.tip(h));
            }
            path.push(mesh.origin(h));
        }
        at = mesh.face_across(stitches.right(face));
    }
    let crossed = path.len().checked_sub(1)? as u8;
    let left = 1 + (dice / 8) as u8 % crossed.max(2).saturating_sub(1);
    let cable = Cable::cross(path, left, crossed.saturating_sub(left), dice.is_multiple_of(2));
    Some(Command::SetCable { cable })
}

/// A block of stitches copied, perhaps mirrored.
fn some_patch(stitches: &StitchMesh, face: FaceId, dice: u32) -> Option<Patch> {
    let mut block = Vec::new();
    let mut anchor = Some(face);
    for _ in 0..1 + dice % 3 {
        let mut at = anchor;
        for _ in 0..1 + dice / 3 % 4 {
            block.extend(at);
            at = at.and_then(|f| stitches.mesh().face_across(stitches.right(f)));
        }
        anchor = anchor.and_then(|f| stitches.above(f).next());
    }
    let patch = Patch::copy(stitches, &block).ok()?;
    Some(if dice.is_multiple_of(2) { patch.mirrored() } else { patch })
}

/// Vertices along the border from an edge on.
fn some_border(stitches: &StitchMesh, dice: u32, long: u32) -> Option<Vec<u32>> {
    let mesh = stitches.mesh();
    let borders: Vec<HalfEdgeId> = mesh.borders().concat();
    let first = pick(&borders, dice)?;
    let along = std::iter::successors(Some(first), |h| mesh.next_on_border(*h));
    let mut path = vec![mesh.origin(first).0];
    path.extend(along.take(long as usize).map(|h| mesh.tip(h).0));
    Some(path)
}

/// An edit made up from numbers; most of them can be done, some not.
fn command(stitches: &StitchMesh, (kind, a, b, c): Dice) -> Option<Command> {
    let mesh = stitches.mesh();
    let face = FaceId(a % mesh.face_count() as u32);
    let stitch = stitches.stitch(face);
    let is_course = |h: HalfEdgeId, _: Option<HalfEdgeId>| !stitches.is_wale(h);
    let is_joint = |h: HalfEdgeId, twin: Option<HalfEdgeId>| stitches.is_wale(h) && twin.is_some();
    let several = |h: HalfEdgeId| {
        let stitch = stitches.stitch(mesh.face(h));
        !stitches.is_wale(h) && (if stitches.is_bottom(h) { stitch.bottoms() } else { stitch.tops() }) > 1
    };
    let color = format!("#{:06x}", b % 0x100_0000).parse().unwrap();
    Some(match kind % 20 {
        0 | 1 => {
            let stitch = some_stitch(stitch.bottoms(), stitch.tops(), b);
            Command::SetStitch { faces: vec![face.0], stitch }
        }
        2 | 3 => Command::SplitCourse { edge: some_edge(stitches, a, is_course)? },
        4 => Command::CollapseCourse { edge: some_edge(stitches, a, is_course)? },
        5 | 6 => {
            let edge = some_edge(stitches, a, |h, twin| several(h) && twin.is_none_or(several))?;
            Command::CollapseCourse { edge }
        }
        7 | 8 => {
            let corners: Vec<u32> = mesh.face_vertices(face).map(|v| v.0).collect();
            let (below, above) = corners.split_at(stitch.bottoms() + 1);
            Command::AddWale { face: face.0, edge: [pick(below, b)?, pick(above, c)?] }
        }
        9 => Command::RemoveWale { edge: some_edge(stitches, a, is_joint)? },
        10 | 11 => {
            let end = if b.is_multiple_of(2) { End::Bottom } else { End::Top };
            let to = if c.is_multiple_of(2) { Way::Left } else { Way::Right };
            Command::ShiftWale { edge: some_edge(stitches, a, is_joint)?, end, to }
        }
        12 => some_cable(stitches, face, b)?,
        13 => {
            let cables: Vec<&Cable> = stitches.cables().iter().collect();
            let cable = pick(&cables, a)?;
            Command::ClearCables { edges: vec![[cable.path[0].0, cable.path[1].0]] }
        }
        14 => {
            let edge = some_edge(stitches, a, |h, twin| {
                twin.is_none() && !stitches.is_wale(h) && !stitches.is_bottom(h)
            })?;
            Command::SetLive { edges: vec![edge], live: !b.is_multiple_of(3) }
        }
        15 if b.is_multiple_of(2) => Command::SetWrap {
            faces: vec![face.0],
            modulus: (!b.is_multiple_of(3)).then_some(f64::from(b % 4)),
            angle_deg: (!c.is_multiple_of(3)).then_some(f64::from(c % 181)),
        },
        15 => Command::Dye { faces: vec![face.0], color },
        16 => Command::Paste { at: b % mesh.face_count() as u32, patch: some_patch(stitches, face, c)? },
        17 => match b % 3 {
            0 => Command::SetSpiral { spiral: c.is_multiple_of(2) },
            1 => {
                Command::FillRegion { face: face.0, stitch: some_stitch(stitch.bottoms(), stitch.tops(), c) }
            }
            _ => Command::SetChart {
                chart: vec!["k p".into(), "p k".into()],
                rows: None,
                faces: Some(vec![face.0]),
            },
        },
        18 => {
            let long = 1 + c % 3;
            Command::Sew { a: some_border(stitches, a, long)?, b: some_border(stitches, b, long)? }
        }
        _ => Command::Unsew { edges: vec![some_edge(stitches, a, |_, twin| twin.is_none())?] },
    })
}

/// What holds for any stitch mesh.
fn check_mesh(stitches: &StitchMesh) {
    let mesh = stitches.mesh();
    let again = PolygonMesh::new(mesh.positions().to_vec(), &mesh.face_lists()).unwrap();
    let again = StitchMesh::new(again, stitches.stitches().to_vec()).unwrap();
    let marks = stitches.marks().clone();
    let (dyes, wrappings) = (stitches.dyes().to_vec(), stitches.wrappings().to_vec());
    let again = again.with(dyes, wrappings, stitches.places().to_vec(), marks).unwrap();
    assert!(again == *stitches);
    for h in (0..mesh.half_edge_count()).map(HalfEdgeId::new) {
        if let Some(twin) = mesh.twin(h) {
            assert_eq!(stitches.is_wale(h), stitches.is_wale(twin), "a wale edge of one stitch only");
        }
    }
    for face in mesh.faces() {
        assert_eq!(mesh.face_half_edges(face).filter(|h| stitches.is_wale(*h)).count(), 2);
        let stitch = stitches.stitch(face);
        assert_eq!(stitch.to_string().parse().as_ref(), Ok(stitch), "files name stitches by symbol");
    }
    let mut seen = HashSet::new();
    for row in stitches.rows() {
        assert!(row.faces.iter().all(|f| seen.insert(*f)), "a stitch in two rows");
        let joined = row.faces.windows(2).all(|w| mesh.face_across(stitches.right(w[0])) == Some(w[1]));
        assert!(joined);
    }
    assert_eq!(seen.len(), mesh.face_count());
}

/// What holds for the yarn of any stitch mesh.
fn check_yarn(fabric: &Fabric) {
    let net = fabric.net();
    assert!(net.nodes.iter().all(|n| n.position.is_finite()));
    assert!(fabric.state().fits(net));
    let loose = loose_loops(&fabric.stitches, net);
    // Slipped all the way to where tops meet tops a loop ends in another one: then the project has a problem that says so.
    let meets_tops = |top: &HalfEdgeId| {
        let last = handed_on_to(&fabric.stitches, *top);
        fabric.stitches.mesh().twin(last).is_some_and(|t| !fabric.stitches.is_bottom(t))
    };
    let loose: Vec<_> = loose.iter().filter(|top| !meets_tops(top)).collect();
    assert!(loose.is_empty(), "loops that nothing holds: {loose:?}");
    for (v, visit) in net.visits.iter().enumerate() {
        let stack = &net.nodes[visit.node.index()].visits;
        assert_eq!(stack.iter().filter(|s| s.index() == v).count(), 1);
    }
    for segment in net.segments() {
        let [a, b] = segment.ends.map(|v| net.visits[v.index()].u);
        let nodes = segment.ends.map(|v| &net.nodes[net.visits[v.index()].node.index()]);
        assert!(b + segment.wrap > a, "no yarn between {nodes:?}");
    }
    check_joints(fabric);
}

/// The yarn of every stitch goes on into its neighbours': from the right one to the left along the row, and up through every
/// course edge.
fn check_joints(fabric: &Fabric) {
    let (stitches, net) = (&fabric.stitches, fabric.net());
    let mesh = stitches.mesh();
    let mut joined: HashSet<[FaceId; 2]> = HashSet::new();
    for yarn in &net.yarns {
        let mut before = None;
        let visits = yarn.visits.clone().chain(yarn.period.map(|_| yarn.visits.start));
        // Turns lie in no stitch.
        for face in visits.filter_map(|v| net.nodes[net.visits[v as usize].node.index()].face) {
            joined.extend(before.map(|b: FaceId| [b.min(face), b.max(face)]));
            before = Some(face);
        }
    }
    // A yarn-over has no place of its own where its yarn could be found.
    let op =
        |face: FaceId, i: usize| stitches.stitch(face).ops.get(i).is_none_or(|op| op.make != Make::YarnOver);
    for h in (0..mesh.half_edge_count()).map(HalfEdgeId::new) {
        let Some(twin) = mesh.twin(h).filter(|t| h < *t) else { continue };
        let has_yarn_at = |h: HalfEdgeId| {
            let face = mesh.face(h);
            let tops = stitches.stitch(face).tops();
            match () {
                () if stitches.is_bottom(h) => stitches.stitch(face).holds(),
                () if h == stitches.left(face) => op(face, 0),
                () if h == stitches.right(face) => op(face, tops.saturating_sub(1)),
                () => stitches.tops(face).position(|t| t == h).is_none_or(|i| op(face, i)),
            }
        };
        let ends = [mesh.origin(h), mesh.tip(h)];
        let crosses = stitches.cables().iter().any(|c| c.covers(ends[0], ends[1]));
        let winds = stitches.is_wale(h) && stitches.marks().spiral;
        if has_yarn_at(h) && has_yarn_at(twin) && !crosses && !winds {
            let (f, g) = (mesh.face(h), mesh.face(twin));
            assert!(f == g || joined.contains(&[f.min(g), f.max(g)]), "{f} and {g} are not joined");
        }
    }
}

/// Whether two nets are the same to the last digit.
fn same_net(a: &YarnNet, b: &YarnNet) -> bool {
    // Debug prints every field, and of numbers all that there is.
    format!("{a:?}") == format!("{b:?}")
}

fn check(project: &Project) {
    let fabric = project.fabric().unwrap();
    check_mesh(&fabric.stitches);
    check_yarn(fabric);
    assert!(same_net(fabric.net(), &lay(&fabric.stitches)), "laid again it is another net than laid anew");
    project.scene.validate(fabric.net().nodes.len()).unwrap();
}

/// The project as its file has it.
fn saved(project: &Project) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.purl");
    project.save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let again = Project::open(&path).unwrap();
    assert_eq!(again.fabric().unwrap().stitches, project.fabric().unwrap().stitches);
    assert_eq!(again.counts, project.counts);
    bytes
}

/// Whether two projects are the same, by all that an edit of stitches can change.
fn same(a: &Project, b: &Project) -> bool {
    let stitches = |p: &Project| p.fabric().unwrap().stitches.clone();
    stitches(a) == stitches(b) && a.counts == b.counts && a.scene == b.scene && a.materials == b.materials
}

/// Does the edits and takes them back. Returns how many could be done.
fn edit(which: usize, dice: &[Dice]) -> usize {
    let mut document = Document::new(fabrics::fabric(which));
    let start = saved(document.project());
    let mut states = vec![document.project().clone()];
    for throw in dice {
        let before = document.project().fabric().unwrap().stitches.clone();
        let Some(command) = command(&before, *throw) else { continue };
        match document.apply(command.clone()) {
            // What changes nothing is no step.
            Ok(()) if document.steps().len() < states.len() => {}
            Ok(()) => {
                check(document.project());
                states.push(document.project().clone());
            }
            Err(error) => {
                let after = &document.project().fabric().unwrap().stitches;
                assert!(Arc::ptr_eq(&before, after), "{command:?} was refused, but has changed something");
                assert!(!format!("{error:#}").is_empty());
            }
        }
    }
    let end = saved(document.project());
    for state in states.iter().rev().skip(1) {
        assert!(document.undo() && same(document.project(), state), "undo leads elsewhere");
    }
    assert!(!document.undo());
    assert!(saved(document.project()) == start, "undo leads elsewhere");
    while document.redo() {}
    assert!(saved(document.project()) == end, "redo leads elsewhere");
    states.len() - 1
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, max_shrink_iters: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_edits_leave_a_stitch_mesh_and_can_be_undone(
        which in 0..fabrics::COUNT,
        dice in proptest::collection::vec(any::<Dice>(), 10..60),
    ) {
        edit(which, &dice);
    }
}

#[test]
fn most_edits_can_be_done() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let throws = proptest::collection::vec(any::<Dice>(), 60);
    for which in 0..fabrics::COUNT {
        let dice = throws.new_tree(&mut runner).unwrap().current();
        let done = edit(which, &dice);
        assert!(done > 20, "only {done} of 60 edits of fabric {which} could be done");
    }
}

/// The comparison of nets sees two yarns that have changed places at one node, which is all that a purl changes, and one
/// that is a hair longer.
#[test]
fn another_net_is_told_apart() {
    let fabric = fabrics::fabric(0).fabric.unwrap();
    let net = &**fabric.net();
    assert!(same_net(net, &net.clone()));
    let mut swapped = net.clone();
    let stack = swapped.nodes.iter_mut().find(|n| n.visits.len() == 2).unwrap();
    stack.visits.swap(0, 1);
    assert!(!same_net(net, &swapped));
    let mut longer = net.clone();
    let visits = Arc::make_mut(&mut longer.visits);
    visits[7].u = visits[7].u.next_up();
    assert!(!same_net(net, &longer));
}

/// A collapse that moves numbers down takes cables, seams and colours along.
#[test]
fn marks_follow_their_vertices() {
    let mut document = Document::new(fabrics::fabric(0));
    let cable = Cable::cross([22, 23, 24].map(VertexId).to_vec(), 1, 1, false);
    for command in [
        Command::SetCable { cable },
        Command::Dye { faces: vec![29], color: "#123456".parse().unwrap() },
        Command::RemoveWale { edge: [8, 15] },
        Command::RemoveWale { edge: [15, 22] },
        Command::CollapseCourse { edge: [15, 14] },
    ] {
        document.apply(command).unwrap();
    }
    let stitches = &document.project().fabric().unwrap().stitches;
    assert_eq!(stitches.cables()[0].path, [21, 22, 23].map(VertexId));
    assert_eq!(stitches.dyes()[27].to_string(), "#123456");
}
