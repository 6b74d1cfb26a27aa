//! What knitters call the stitches.

use crate::stitch::{Make, Stitch};

/// Stitches with a name of their own: symbol, abbreviation, name.
///
/// The order of a decrease follows from how it is worked, right to left: in a k2tog the needle enters the left loop first, so
/// that one comes to lie in front, leaning right; in an ssk the right one, leaning left. An increase begins on the right too: the
/// knit of a kfb stands there, and its twisted loop, whose bar looks like a purl, on the left of it.
const NAMES: [(&str, &str, &str); 36] = [
    ("k", "k", "knit"),
    ("p", "p", "purl"),
    ("y", "co", "loop of the cast-on"),
    ("y1", "e-loop", "twisted loop of the cast-on (backward loop)"),
    ("y-1", "e-loop", "twisted loop of the cast-on (forward loop)"),
    ("d0y", "yo", "yarn-over between two stitches"),
    ("k1", "k tbl", "knit through the back loop"),
    ("p1", "p tbl", "purl through the back loop"),
    ("s", "sl wyib", "slipped, yarn behind"),
    ("x", "sl woven", "slipped, yarn woven through its legs"),
    ("sk", "k, sl", "knitted into, then slipped"),
    ("ks", "sl, k", "slipped, then knitted into"),
    ("pk", "kfb", "knit into the front and back of one (bar increase)"),
    ("kp", "pfb", "purl into the front and back of one; (p1, k1) in one"),
    ("ky", "yo, k1", "yarn-over, knit"),
    ("yk", "k1, yo", "knit, yarn-over"),
    ("py", "yo, p1", "yarn-over, purl"),
    ("yp", "p1, yo", "purl, yarn-over"),
    ("kyk", "k-yo-k", "knit, yarn-over, knit into one"),
    ("kpk", "k-p-k", "knit, purl, knit into one"),
    ("pkp", "p-k-p", "purl, knit, purl into one"),
    ("pyp", "p-yo-p", "purl, yarn-over, purl into one"),
    ("yky", "yo, k1, yo", "a yarn-over on both sides of a knit"),
    ("ypy", "yo, p1, yo", "a yarn-over on both sides of a purl"),
    ("d12k", "k2tog", "knit two together, leaning right"),
    ("d21k", "ssk", "slip, slip, knit: two together, leaning left"),
    ("d12p", "p2tog", "purl two together"),
    ("d21p", "ssp", "slip, slip, purl: two together"),
    ("d123k", "k3tog", "knit three together, leaning right"),
    ("d321k", "sssk", "slip three, knit them together, leaning left"),
    ("d312k", "sk2p", "slip one, knit two together, pass over, leaning left"),
    ("d231k", "s2kp", "slip two together, knit one, pass over: centred"),
    ("d123p", "p3tog", "purl three together"),
    ("d321p", "sssp", "slip three, purl them together"),
    ("d312p", "sp2p", "slip one, purl two together, pass over"),
    ("d231p", "s2pp", "slip two together, purl one, pass over: centred"),
];

impl Stitch {
    /// What a knitter's chart calls it: k2tog, ssk, kfb, …; the symbol where there is no shorter name.
    pub fn abbreviation(&self) -> String {
        let symbol = self.to_string();
        let named = NAMES.iter().find(|n| n.0 == symbol);
        named.map_or(symbol, |n| n.1.to_owned())
    }

    /// What it is, in words.
    pub fn description(&self) -> String {
        let symbol = self.to_string();
        if let Some(named) = NAMES.iter().find(|n| n.0 == symbol) {
            return named.2.to_owned();
        }
        if self.ops.is_empty() {
            return format!("{} gathered on the yarn of the row", loops(self.bottoms()));
        }
        // As it is worked on the right side: from right to left.
        let made = self.ops.iter().rev().map(|op| {
            let made = match op.make {
                Make::Knit => "knit",
                Make::Purl => "purl",
                Make::YarnOver => "yarn-over",
                Make::Slip => "slip",
                Make::Cross => "slip woven",
            };
            match op.twist {
                0 => made.to_owned(),
                1.. => format!("{made} twisted clockwise"),
                _ => format!("{made} twisted counter-clockwise"),
            }
        });
        let made = made.collect::<Vec<_>>().join(", ");
        match self.bottoms() {
            0 => format!("{made} from nothing"),
            1 => made,
            many => {
                let order = self.stack.iter().map(|b| (b + 1).to_string()).collect::<Vec<_>>().join(", ");
                format!(
                    "{made} through {} together, from front to back {order} counted from the left",
                    loops(many)
                )
            }
        }
    }
}

fn loops(count: usize) -> String {
    if count == 1 { "one loop".to_owned() } else { format!("{count} loops") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stitches_have_names() {
        for (symbol, abbreviation, description) in NAMES {
            let stitch: Stitch = symbol.parse().unwrap();
            assert_eq!(stitch.to_string(), symbol, "symbols are written as they are printed");
            assert_eq!((&*stitch.abbreviation(), &*stitch.description()), (abbreviation, description));
        }
        let described = |symbol: &str| symbol.parse::<Stitch>().unwrap().description();
        assert_eq!(described("k-1y"), "yarn-over, knit twisted counter-clockwise");
        assert_eq!(
            described("d132k"),
            "knit through 3 loops together, from front to back 1, 3, 2 counted from the left"
        );
        assert_eq!(described("d1"), "one loop gathered on the yarn of the row");
    }
}
