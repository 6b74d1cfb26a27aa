//! Laying again after an edit that leaves every yarn where it runs.
//!
//! A purl is a knit with its yarns the other way round at each node; another stacking order, or a twist the other way, change
//! no more than that. After such an edit the net is the one from before with other stacks at the nodes of the edited
//! faces, and painting stitches on a garment costs a copy of its net instead of the laying of all its yarn.

use super::lay;
use super::template::{Template, TemplateContact};
use crate::ids::{FaceId, VisitId};
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::YarnNet;
use smallvec::SmallVec;

/// The net of `after`: what [`lay`] gives, by way of the net that `before` had where that can be done.
pub fn relay(net: &YarnNet, before: &StitchMesh, after: &StitchMesh) -> YarnNet {
    restacked(net, before, after).unwrap_or_else(|| lay(after))
}

fn restacked(net: &YarnNet, before: &StitchMesh, after: &StitchMesh) -> Option<YarnNet> {
    if !after.has_mesh_of(before)
        || before.marks() != after.marks()
        || before.dyes() != after.dyes()
        || before.wrappings() != after.wrappings()
    {
        return None;
    }
    let changed = after.mesh().faces().filter(|f| before.stitch(*f) != after.stitch(*f));
    let changed: Vec<(FaceId, Template, Template)> = changed
        .map(|face| {
            let (old, new) = (Template::of(before.stitch(face)), Template::of(after.stitch(face)));
            runs_alike(&old, &new).then_some((face, old, new))
        })
        .collect::<Option<_>>()?;
    // Copied last: a copy costs a third of laying everything.
    let mut net = net.clone();
    for (face, old, new) in changed {
        restack(&mut net, face, &old, &new)?;
    }
    Some(net)
}

/// Whether two templates lead their yarns through the same places, whatever lies in front there.
fn runs_alike(old: &Template, new: &Template) -> bool {
    let pieces = |t: &Template| -> Vec<_> {
        t.pieces.iter().map(|p| (p.from, p.to, p.visits.clone(), p.own)).collect()
    };
    let alike = |(a, b): (&TemplateContact, &TemplateContact)| {
        a.new == b.new && a.old.len() == b.old.len() && b.old.iter().all(|o| a.old.contains(o))
    };
    old.visits == new.visits
        && old.nodes.len() == new.nodes.len()
        && old.nodes.iter().zip(&new.nodes).all(|(a, b)| a.weights == b.weights && a.kind == b.kind)
        && pieces(old) == pieces(new)
        && old.contacts.len() == new.contacts.len()
        && old.contacts.iter().zip(&new.contacts).all(alike)
}

/// Puts the stacks and contacts of `new` at the nodes of a face that were laid from `old`. Nodes and contacts of faces come
/// first in a net, in the order of the faces.
fn restack(net: &mut YarnNet, face: FaceId, old: &Template, new: &Template) -> Option<()> {
    let first = net.nodes.partition_point(|n| n.face.is_some_and(|f| f < face));
    for (i, (before, after)) in old.nodes.iter().zip(&new.nodes).enumerate() {
        let visits = &mut net.nodes.get_mut(first + i)?.visits;
        let stack: Option<SmallVec<[VisitId; 3]>> = after
            .stack
            .iter()
            .map(|v| visits.get(before.stack.iter().position(|w| w == v)?).copied())
            .collect();
        *visits = stack?;
    }
    let face_of = |visit: VisitId| net.nodes[net.visits[visit.index()].node.index()].face;
    let first = net.contacts.partition_point(|c| face_of(c.new[0]).is_some_and(|f| f < face));
    for (i, (before, after)) in old.contacts.iter().zip(&new.contacts).enumerate() {
        let contact = net.contacts.get_mut(first + i)?;
        let of: Option<SmallVec<[[VisitId; 2]; 1]>> = after
            .old
            .iter()
            .map(|o| contact.old.get(before.old.iter().position(|b| b == o)?).copied())
            .collect();
        contact.old = of?;
        contact.handedness = after.handedness;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_counts::StitchSize;
    use crate::pieces::from_rows;
    use crate::stitch::Stitch;
    use crate::wrapping::Wrapping;

    fn same(a: &YarnNet, b: &YarnNet) -> bool {
        // Debug prints every field to the last digit.
        format!("{a:?}") == format!("{b:?}")
    }

    #[test]
    fn the_short_way_gives_the_same_net() {
        let row = |text: &str| text.split_whitespace().map(|s| s.parse().unwrap()).collect::<Vec<Stitch>>();
        let rows = ["k k k k k k", "k d123k k k", "k1 kp k s", "k k k k k"].map(row);
        let before = from_rows(&rows, StitchSize::of_width(3e-3)).unwrap();
        let net = lay(&before);
        let edits =
            [(0, "p"), (7, "d213p"), (10, "k-1"), (10, "p1"), (11, "pk"), (13, "x"), (15, "k1"), (2, "s")];
        let mut short = 0;
        for (face, symbol) in edits {
            let mut after = before.clone();
            after.set_stitch(FaceId(face), symbol.parse().unwrap()).unwrap();
            assert!(same(&relay(&net, &before, &after), &lay(&after)), "{symbol} on {face}");
            assert!(!same(&net, &lay(&after)));
            short += usize::from(restacked(&net, &before, &after).is_some());
        }
        assert_eq!(short, 6, "all but the new twist and the slip");
        let mut dyed = before.clone();
        dyed.set_dye(FaceId(3), crate::dye::Dye([1, 2, 3])).unwrap();
        assert!(restacked(&net, &before, &dyed).is_none());
        let mut slack = before.clone();
        slack.set_wrapping(FaceId(3), Wrapping { modulus: 0.5, angle: None }).unwrap();
        assert!(same(&relay(&net, &before, &slack), &lay(&slack)) && !same(&net, &lay(&slack)));
    }
}
