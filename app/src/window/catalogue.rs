//! The stitches of the palette, with the names that knitters use.
//!
//! Symbols say which loop lies in front, counted from the left: in a k2tog that is the left one (`d12k`, leaning right), in an
//! ssk the right one (`d21k`, leaning left).

use super::editor::Editor;
use stitch_mesh::stitch::Stitch;

/// A kind of stitch.
pub struct Kind {
    /// Where it stands in the palette.
    pub group: Group,
    /// Its symbol.
    pub symbol: &'static str,
    /// Its name.
    pub name: &'static str,
}

/// Groups of the palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// One loop to one.
    Plain,
    /// One loop to one, twisted.
    Twisted,
    /// One loop to several.
    Increases,
    /// Several loops to one.
    Decreases,
    /// The rest.
    Special,
}

impl Group {
    /// All groups with their headings.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Plain, "Plain"),
        (Self::Twisted, "Twisted"),
        (Self::Increases, "Increases"),
        (Self::Decreases, "Decreases"),
        (Self::Special, "Special"),
    ];
}

const fn kind(group: Group, symbol: &'static str, name: &'static str) -> Kind {
    Kind { group, symbol, name }
}

/// All kinds.
pub const KINDS: &[Kind] = &[
    kind(Group::Plain, "k", "knit"),
    kind(Group::Plain, "p", "purl"),
    kind(Group::Plain, "y", "yarn-over, or cast-on"),
    kind(Group::Twisted, "k1", "knit, twisted clockwise"),
    kind(Group::Twisted, "k-1", "knit, twisted counter-clockwise (k tbl)"),
    kind(Group::Twisted, "p1", "purl, twisted clockwise"),
    kind(Group::Twisted, "p-1", "purl, twisted counter-clockwise (p tbl)"),
    kind(Group::Twisted, "y1", "yarn-over, twisted clockwise (M1R)"),
    kind(Group::Twisted, "y-1", "yarn-over, twisted counter-clockwise (M1L)"),
    kind(Group::Increases, "kp", "kfb: knit and purl into one"),
    kind(Group::Increases, "ky", "knit, yarn-over"),
    kind(Group::Increases, "yk", "yarn-over, knit"),
    kind(Group::Increases, "pk", "pfb: purl and knit into one"),
    kind(Group::Increases, "py", "purl, yarn-over"),
    kind(Group::Increases, "yp", "yarn-over, purl"),
    kind(Group::Increases, "kpk", "k1-p1-k1 into one"),
    kind(Group::Increases, "kyk", "k1-yo-k1 into one"),
    kind(Group::Increases, "yky", "yo-k1-yo"),
    kind(Group::Increases, "kpy", "k1-p1-yo into one"),
    kind(Group::Increases, "ykp", "yo-k1-p1 into one"),
    kind(Group::Increases, "pkp", "p1-k1-p1 into one"),
    kind(Group::Increases, "pyp", "p1-yo-p1 into one"),
    kind(Group::Increases, "ypy", "yo-p1-yo"),
    kind(Group::Increases, "pky", "p1-k1-yo into one"),
    kind(Group::Increases, "ypk", "yo-p1-k1 into one"),
    kind(Group::Decreases, "d12k", "k2tog, leaning right"),
    kind(Group::Decreases, "d21k", "ssk, leaning left"),
    kind(Group::Decreases, "d12p", "p2tog, leaning right"),
    kind(Group::Decreases, "d21p", "ssp, leaning left"),
    kind(Group::Decreases, "d123k", "k3tog, leaning right"),
    kind(Group::Decreases, "d321k", "sssk, leaning left"),
    kind(Group::Decreases, "d231k", "s2kp, centred: the middle loop in front"),
    kind(Group::Decreases, "d312k", "sk2p, leaning left"),
    kind(Group::Decreases, "d132k", "knit 3 together, left loop in front, middle behind"),
    kind(Group::Decreases, "d213k", "knit 3 together, middle loop in front, right behind"),
    kind(Group::Decreases, "d123p", "p3tog, leaning right"),
    kind(Group::Decreases, "d321p", "sssp, leaning left"),
    kind(Group::Decreases, "d231p", "s2pp, centred: the middle loop in front"),
    kind(Group::Decreases, "d312p", "sp2p, leaning left"),
    kind(Group::Decreases, "d132p", "purl 3 together, left loop in front, middle behind"),
    kind(Group::Decreases, "d213p", "purl 3 together, middle loop in front, right behind"),
    kind(Group::Special, "d1", "bind-off: a loop gathered on the yarn"),
];

impl Kind {
    /// Sets the stitches that are meant, or takes it to paint with.
    pub(super) fn choose(&self, editor: &mut Editor) {
        // Every symbol is read by a test.
        if let Ok(stitch) = self.symbol.parse() {
            editor.use_stitch(stitch);
        }
    }
}

/// What a knitter calls a stitch, with its symbol: `k2tog (d12k)`; where there is no name, the symbol.
pub fn describe(stitch: &Stitch) -> String {
    let symbol = stitch.to_string();
    match KINDS.iter().find(|k| k.symbol == symbol) {
        Some(kind) => {
            let short = kind.name.split([',', ':']).next().unwrap_or(kind.name);
            let twisted = stitch.ops.len() == 1 && stitch.ops[0].twist != 0;
            let short = if twisted { kind.name } else { short };
            format!("{short} ({symbol})")
        }
        None => symbol,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_symbol_is_a_stitch_of_its_group() {
        for kind in KINDS {
            let stitch: Stitch = kind.symbol.parse().unwrap();
            let group = match (stitch.bottoms(), stitch.tops(), stitch.ops.iter().any(|op| op.twist != 0)) {
                (1, 1, false) => Group::Plain,
                (1, 1, true) => Group::Twisted,
                (1, 2.., _) => Group::Increases,
                (2.., 1, _) => Group::Decreases,
                _ => Group::Special,
            };
            assert_eq!(kind.group, group, "{}", kind.symbol);
        }
        let names: BTreeSet<_> = KINDS.iter().map(|k| k.name).collect();
        assert_eq!(names.len(), KINDS.len());
    }

    #[test]
    fn table_1_is_all_there() {
        let count = |bottoms, tops| {
            let has = |k: &&Kind| {
                let s: Stitch = k.symbol.parse().unwrap();
                (s.bottoms(), s.tops()) == (bottoms, tops)
            };
            KINDS.iter().filter(has).count()
        };
        assert_eq!([count(1, 2), count(1, 3), count(2, 1), count(3, 1)], [6, 9, 4, 12]);
    }

    #[test]
    fn stitches_have_names() {
        let of = |symbol: &str| describe(&symbol.parse().unwrap());
        assert_eq!(of("d12k"), "k2tog (d12k)");
        assert_eq!(of("p"), "purl (p)");
        assert_eq!(of("d1234k"), "d1234k");
    }
}
