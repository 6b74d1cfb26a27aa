//! The stitches of the palette, by groups.

use super::editor::Editor;
use stitch_mesh::stitch::Stitch;

/// A kind of stitch.
pub struct Kind {
    /// Where it stands in the palette.
    pub group: Group,
    /// Its symbol.
    pub symbol: &'static str,
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

const fn kind(group: Group, symbol: &'static str) -> Kind {
    Kind { group, symbol }
}

/// All kinds.
pub const KINDS: &[Kind] = &[
    kind(Group::Plain, "k"),
    kind(Group::Plain, "p"),
    kind(Group::Plain, "y"),
    kind(Group::Plain, "d0y"),
    kind(Group::Twisted, "k1"),
    kind(Group::Twisted, "k-1"),
    kind(Group::Twisted, "p1"),
    kind(Group::Twisted, "p-1"),
    kind(Group::Twisted, "y1"),
    kind(Group::Twisted, "y-1"),
    kind(Group::Increases, "kp"),
    kind(Group::Increases, "ky"),
    kind(Group::Increases, "yk"),
    kind(Group::Increases, "pk"),
    kind(Group::Increases, "py"),
    kind(Group::Increases, "yp"),
    kind(Group::Increases, "kpk"),
    kind(Group::Increases, "kyk"),
    kind(Group::Increases, "yky"),
    kind(Group::Increases, "kpy"),
    kind(Group::Increases, "ykp"),
    kind(Group::Increases, "pkp"),
    kind(Group::Increases, "pyp"),
    kind(Group::Increases, "ypy"),
    kind(Group::Increases, "pky"),
    kind(Group::Increases, "ypk"),
    kind(Group::Decreases, "d12k"),
    kind(Group::Decreases, "d21k"),
    kind(Group::Decreases, "d12p"),
    kind(Group::Decreases, "d21p"),
    kind(Group::Decreases, "d123k"),
    kind(Group::Decreases, "d321k"),
    kind(Group::Decreases, "d231k"),
    kind(Group::Decreases, "d312k"),
    kind(Group::Decreases, "d132k"),
    kind(Group::Decreases, "d213k"),
    kind(Group::Decreases, "d123p"),
    kind(Group::Decreases, "d321p"),
    kind(Group::Decreases, "d231p"),
    kind(Group::Decreases, "d312p"),
    kind(Group::Decreases, "d132p"),
    kind(Group::Decreases, "d213p"),
    kind(Group::Special, "s"),
    kind(Group::Special, "x"),
    kind(Group::Special, "sk"),
    kind(Group::Special, "ks"),
    kind(Group::Special, "d1"),
];

impl Kind {
    /// The stitch. Every symbol is read by a test.
    fn stitch(&self) -> Option<Stitch> {
        self.symbol.parse().ok()
    }

    /// Its abbreviation and name, as in "k2tog · knit two together, leaning right".
    pub fn name(&self) -> String {
        let Some(stitch) = self.stitch() else { return self.symbol.to_owned() };
        let (short, long) = (stitch.abbreviation(), stitch.description());
        if short == self.symbol { long } else { format!("{short} · {long}") }
    }

    /// Sets the stitches that are meant, or takes it to paint with.
    pub(super) fn choose(&self, editor: &mut Editor) {
        if let Some(stitch) = self.stitch() {
            editor.use_stitch(stitch);
        }
    }
}

/// What a knitter calls a stitch, with its symbol: `k2tog (d12k)`, `knit (k)`.
pub fn describe(stitch: &Stitch) -> String {
    let (symbol, short) = (stitch.to_string(), stitch.abbreviation());
    let name = if short == symbol { stitch.description() } else { short };
    format!("{name} ({symbol})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_symbol_is_a_stitch_of_its_group() {
        for kind in KINDS {
            let stitch: Stitch = kind.symbol.parse().unwrap();
            assert_eq!(stitch.to_string(), kind.symbol);
            let twisted = stitch.ops.iter().any(|op| op.twist != 0);
            let fits = match kind.group {
                Group::Plain => stitch.bottoms() <= 1 && stitch.tops() == 1 && !twisted,
                Group::Twisted => (stitch.bottoms(), stitch.tops()) == (1, 1) && twisted,
                Group::Increases => stitch.bottoms() == 1 && stitch.tops() > 1,
                Group::Decreases => stitch.bottoms() > 1 && stitch.tops() == 1,
                Group::Special => true,
            };
            assert!(fits, "{}", kind.symbol);
        }
        let symbols: BTreeSet<_> = KINDS.iter().map(|k| k.symbol).collect();
        assert_eq!(symbols.len(), KINDS.len());
    }

    #[test]
    fn table_1_is_all_there() {
        let count = |bottoms, tops| {
            let has = |k: &&Kind| k.stitch().is_some_and(|s| (s.bottoms(), s.tops()) == (bottoms, tops));
            KINDS.iter().filter(has).filter(|k| k.group != Group::Special).count()
        };
        assert_eq!([count(1, 2), count(1, 3), count(2, 1), count(3, 1)], [6, 10, 4, 12]);
    }

    #[test]
    fn stitches_have_names() {
        let of = |symbol: &str| describe(&symbol.parse().unwrap());
        assert_eq!([of("d12k"), of("p")], ["k2tog (d12k)", "purl (p)"]);
    }
}
