//! Groups of nodes that the incomplete factorisation treats as one block: two stitches above each other in a wale.
//!
//! # Theory
//! What makes the system hard is axial stretch, and the yarn of a loop runs up and down its wale: with two courses of a
//! wale in one block the hardest couplings are inside of blocks and eliminated exactly.
//!
//! # Practice
//! Which stitch is above which follows from the net: where a loop goes from the stitch that forms it to the stitch that is
//! drawn through it, its yarn changes from new to old. Each stitch is paired with the free stitch above or below that
//! most segments join it to; what is left alone (the last row of an odd number, the border, tails) goes to the group it
//! is joined to most, as long as that does not grow too large.

use crate::model::Model;
use std::collections::{BTreeMap, HashMap};

/// Unknowns that a group may have.
const MOST_UNKNOWNS: u32 = 80;

/// The nodes of each group, groups in the order of their first nodes.
pub(crate) fn groups(model: &Model) -> Vec<Vec<u32>> {
    let (unit_of, mut units) = stitches(model);
    let (along_wales, links) = links(model, &unit_of, units.len());
    let size = |nodes: &[u32]| -> u32 {
        nodes.iter().map(|n| model.start[*n as usize + 1] - model.start[*n as usize]).sum()
    };
    let is_stitch: Vec<bool> = units.iter().map(|u| model.net.nodes[u[0] as usize].face.is_some()).collect();
    // The unit that each unit has gone to; itself until it is moved.
    let mut home: Vec<usize> = (0..units.len()).collect();
    let mut paired = vec![false; units.len()];
    for unit in 0..units.len() {
        if paired[unit] || !is_stitch[unit] {
            continue;
        }
        let free = along_wales[unit].iter().filter(|(u, _)| is_stitch[**u] && !paired[**u]);
        if let Some((&mate, _)) = free.max_by_key(|(u, n)| (**n, usize::MAX - **u)) {
            paired[unit] = true;
            paired[mate] = true;
            join(&mut units, mate, unit);
            home[mate] = unit;
        }
    }
    for unit in 0..units.len() {
        if paired[unit] || home[unit] != unit {
            continue;
        }
        let mut strength: BTreeMap<usize, u32> = BTreeMap::new();
        for (&other, &count) in &links[unit] {
            *strength.entry(found(&home, other)).or_default() += count;
        }
        let room = |u: usize| size(&units[u]) + size(&units[unit]) <= MOST_UNKNOWNS;
        let best = strength.iter().filter(|(u, _)| **u != unit && room(**u));
        if let Some((&group, _)) = best.max_by_key(|(u, n)| (**n, usize::MAX - **u)) {
            join(&mut units, unit, group);
            home[unit] = group;
        }
    }
    let mut groups: Vec<Vec<u32>> = units.into_iter().filter(|u| !u.is_empty()).collect();
    groups.iter_mut().for_each(|g| g.sort_unstable());
    groups.sort_unstable();
    groups
}

/// Moves everything in `from` to `to`.
fn join(units: &mut [Vec<u32>], from: usize, to: usize) {
    let moved = std::mem::take(&mut units[from]);
    units[to].extend(moved);
}

/// Where `unit` is now.
fn found(home: &[usize], mut unit: usize) -> usize {
    while home[unit] != unit {
        unit = home[unit];
    }
    unit
}

/// The unit of each node and the nodes of each unit: one for each stitch, one for each node outside of stitches.
fn stitches(model: &Model) -> (Vec<usize>, Vec<Vec<u32>>) {
    let mut units: Vec<Vec<u32>> = Vec::new();
    let mut of_face = HashMap::new();
    let mut unit_of = Vec::with_capacity(model.net.nodes.len());
    for (i, node) in model.net.nodes.iter().enumerate() {
        let new = units.len();
        let unit = node.face.map_or(new, |face| *of_face.entry(face).or_insert(new));
        if unit == new {
            units.push(Vec::new());
        }
        units[unit].push(i as u32);
        unit_of.push(unit);
    }
    (unit_of, units)
}

/// Number of segments from one unit to others.
type Links = BTreeMap<usize, u32>;

/// For each unit the segments along wales, and all segments.
fn links(model: &Model, unit_of: &[usize], count: usize) -> (Vec<Links>, Vec<Links>) {
    let mut is_new = vec![false; model.net.visits.len()];
    let mut is_old = is_new.clone();
    for contact in &model.net.contacts {
        contact.new.iter().for_each(|v| is_new[v.index()] = true);
        contact.old.iter().flatten().for_each(|v| is_old[v.index()] = true);
    }
    let mut along_wales = vec![Links::new(); count];
    let mut all = along_wales.clone();
    for term in &model.segments {
        let [a, b] = term.stencil.nodes.map(|n| unit_of[n.index()]);
        let [p, q] = term.stencil.visits.map(|v| v.index());
        if a == b {
            continue;
        }
        for (from, to) in [(a, b), (b, a)] {
            *all[from].entry(to).or_default() += 1;
            if is_new[p] && is_old[q] || is_old[p] && is_new[q] {
                *along_wales[from].entry(to).or_default() += 1;
            }
        }
    }
    (along_wales, all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_courses_of_a_wale_are_one_group() {
        let (wide, high) = (5, 6);
        let model = crate::testing::swatch_model(wide, high);
        let groups = groups(&model);
        let mut nodes: Vec<u32> = groups.concat();
        nodes.sort_unstable();
        assert!(nodes.into_iter().eq(0..model.net.nodes.len() as u32), "each node is in one group");
        let mut with_stitches = 0;
        for group in &groups {
            let faces = group.iter().filter_map(|n| model.net.nodes[*n as usize].face);
            let mut faces: Vec<usize> = faces.map(|f| f.index()).collect();
            faces.sort_unstable();
            faces.dedup();
            if let [lower, upper] = faces[..] {
                assert_eq!(lower + wide, upper);
                with_stitches += 1;
            }
        }
        assert_eq!(with_stitches, wide * high / 2);
    }
}
