//! Stitches that gain or lose a loop: what can be kept of them, and what is new.

use crate::stitch::{Make, Op, Stitch};

/// A plain operation.
fn plain(make: Make) -> Op {
    Op { make, twist: 0 }
}

/// The stitch with one more top, to the right of top `i` (or its first).
pub fn add_top(stitch: &mut Stitch, i: usize) {
    let make = match (stitch.bottoms(), stitch.ops.get(i).map(|op| op.make)) {
        (0, _) => Make::YarnOver,
        (_, Some(Make::Knit)) => Make::Purl,
        _ => Make::Knit,
    };
    let at = (i + 1).min(stitch.ops.len());
    stitch.ops.insert(at, plain(make));
}

/// The stitch without top `i`.
pub fn remove_top(stitch: &mut Stitch, i: usize) {
    stitch.ops.remove(i);
}

/// The stitch with bottom `i` divided into `i` and `i + 1`; the new one lies on the side of the old one to which the stack
/// goes down.
pub fn add_bottom(stitch: &mut Stitch, i: usize) {
    let falls_left = stitch.stack.first() > stitch.stack.last();
    let place = stitch.stack.iter().position(|b| usize::from(*b) == i).unwrap_or(0);
    stitch.stack.iter_mut().filter(|b| usize::from(**b) > i).for_each(|b| *b += 1);
    stitch.stack.insert(if falls_left { place } else { place + 1 }, i as u8 + 1);
}

/// The stitch without bottom `i`.
pub fn remove_bottom(stitch: &mut Stitch, i: usize) {
    stitch.stack.retain(|b| usize::from(*b) != i);
    stitch.stack.iter_mut().filter(|b| usize::from(**b) > i).for_each(|b| *b -= 1);
}

/// A stitch cut before bottom `bottom` and top `top`: what lies on the left and on the right.
pub fn cut(stitch: &Stitch, bottom: usize, top: usize) -> [Stitch; 2] {
    let part = |tops: &[Op], keep: &dyn Fn(usize) -> Option<usize>| {
        let stack = stitch.stack.iter().filter_map(|b| keep(usize::from(*b)).map(|b| b as u8));
        Stitch { ops: tops.iter().copied().collect(), stack: stack.collect() }
    };
    let (left, right) = stitch.ops.split_at(top);
    [part(left, &|b| (b < bottom).then_some(b)), part(right, &|b| b.checked_sub(bottom))]
}

/// Two neighbours worked as one stitch, the loops of the left one in front.
pub fn join(left: &Stitch, right: &Stitch) -> Stitch {
    let mut joined = left.clone();
    joined.ops.extend(right.ops.iter().copied());
    let shift = left.bottoms() as u8;
    joined.stack.extend(right.stack.iter().map(|b| b + shift));
    joined
}

/// The top on the right end of `left` becomes one on the left end of `right`, or the other way round.
pub fn pass_top(left: &mut Stitch, right: &mut Stitch, to_left: bool) {
    if to_left {
        left.ops.push(right.ops.remove(0));
    } else if let Some(op) = left.ops.pop() {
        right.ops.insert(0, op);
    }
}

/// The bottom on the right end of `left` becomes one on the left end of `right`, or the other way round.
pub fn pass_bottom(left: &mut Stitch, right: &mut Stitch, to_left: bool) {
    let gain = |stitch: &mut Stitch, i: usize| match stitch.bottoms() {
        0 => stitch.stack.push(0),
        // A new first bottom is the old first one divided: it gets the lower number.
        n => add_bottom(stitch, i.min(n - 1)),
    };
    if to_left {
        remove_bottom(right, 0);
        let last = left.bottoms().saturating_sub(1);
        gain(left, last);
    } else {
        let last = left.bottoms() - 1;
        remove_bottom(left, last);
        gain(right, 0);
    }
}

/// Makes a stitch fit its loops again after it has changed: yarn-overs where there is no loop below, something that holds them
/// where there are some, and a loop handed on only where it is the only one. `borne` says whether loops come from below.
pub fn mend(stitch: &mut Stitch, borne: bool) {
    let bottoms = stitch.bottoms();
    if bottoms == 0 {
        stitch.ops.iter_mut().for_each(|op| op.make = Make::YarnOver);
        return;
    }
    let handed_on = stitch.ops.iter_mut().filter(|op| op.make.passes_on());
    handed_on.skip(usize::from(bottoms == 1)).for_each(|op| *op = plain(Make::Knit));
    if !stitch.holds() && (borne || bottoms > 1) {
        stitch.ops[0] = plain(Make::Knit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(symbol: &str, change: impl Fn(&mut Stitch)) -> String {
        let mut stitch: Stitch = symbol.parse().unwrap();
        change(&mut stitch);
        mend(&mut stitch, true);
        stitch.to_string()
    }

    #[test]
    fn stitches_keep_what_they_can() {
        assert_eq!(changed("k", |s| add_top(s, 0)), "kp");
        assert_eq!(changed("p1", |s| add_top(s, 0)), "p1k");
        assert_eq!(changed("kyk", |s| remove_top(s, 0)), "yk");
        assert_eq!(changed("ky", |s| remove_top(s, 0)), "k");
        assert_eq!(changed("k", |s| add_bottom(s, 0)), "d12k");
        assert_eq!(changed("d21k", |s| add_bottom(s, 1)), "d321k");
        assert_eq!(changed("d213k", |s| add_bottom(s, 0)), "d3124k");
        assert_eq!(changed("d312p", |s| remove_bottom(s, 0)), "d21p");
        assert_eq!(changed("d1", |s| add_top(s, 0)), "k");
        assert_eq!(changed("s", |s| add_top(s, 0)), "sk");
        assert_eq!(changed("s", |s| add_bottom(s, 0)), "d12k");
        assert_eq!(changed("k", |s| remove_bottom(s, 0)), "d0y");
    }

    #[test]
    fn cut_and_join_are_each_others_reverse() {
        let [left, right] = cut(&"d2134kpk".parse().unwrap(), 2, 1);
        assert_eq!((left.to_string().as_str(), right.to_string().as_str()), ("d21k", "d12pk"));
        assert_eq!(join(&left, &right).to_string(), "d2134kpk");
    }
}
