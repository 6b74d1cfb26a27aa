//! The catalogue of stitches: all that have a place in the palette and a picture in the contact sheet, by groups.
//!
//! They are those of Table 1, the twisted ones, and the special faces of Fig. 4 and 5 of Yuksel et al.

/// Headings, each with the symbols below it.
pub const GROUPS: [(&str, &[&str]); 5] = [
    ("Plain", &["k", "p", "y", "d0y"]),
    ("Twisted", &["k1", "k-1", "p1", "p-1", "y1", "y-1"]),
    (
        "Increases",
        &[
            "pk", "kp", "ky", "yk", "py", "yp", "kpk", "kyk", "yky", "kpy", "ykp", "pkp", "pyp", "ypy",
            "pky", "ypk",
        ],
    ),
    (
        "Decreases",
        &[
            "d12k", "d21k", "d12p", "d21p", "d123k", "d321k", "d231k", "d312k", "d132k", "d213k", "d123p",
            "d321p", "d231p", "d312p", "d132p", "d213p",
        ],
    ),
    ("Special", &["s", "x", "sk", "ks", "k1y", "d1"]),
];

/// All symbols in the order of the groups.
pub fn symbols() -> impl Iterator<Item = &'static str> {
    GROUPS.into_iter().flat_map(|(_, symbols)| symbols.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stitch::Stitch;
    use std::collections::BTreeSet;

    #[test]
    fn every_symbol_is_a_stitch_of_its_group() {
        for (heading, symbols) in GROUPS {
            for symbol in symbols {
                let stitch: Stitch = symbol.parse().unwrap();
                assert_eq!(stitch.to_string(), *symbol);
                let twisted = stitch.ops.iter().any(|op| op.twist != 0);
                let fits = match heading {
                    "Plain" => stitch.bottoms() <= 1 && stitch.tops() == 1 && !twisted,
                    "Twisted" => (stitch.bottoms(), stitch.tops()) == (1, 1) && twisted,
                    "Increases" => stitch.bottoms() == 1 && stitch.tops() > 1,
                    "Decreases" => stitch.bottoms() > 1 && stitch.tops() == 1,
                    _ => true,
                };
                assert!(fits, "{symbol}");
            }
        }
        assert_eq!(symbols().collect::<BTreeSet<_>>().len(), symbols().count());
    }

    #[test]
    fn table_1_is_all_there() {
        let count = |bottoms, tops| {
            let plain = GROUPS.iter().filter(|g| g.0 != "Special").flat_map(|g| g.1);
            let stitches = plain.map(|symbol| symbol.parse::<Stitch>().unwrap());
            stitches.filter(|s| (s.bottoms(), s.tops()) == (bottoms, tops)).count()
        };
        assert_eq!([count(1, 2), count(1, 3), count(2, 1), count(3, 1)], [6, 10, 4, 12]);
    }
}
