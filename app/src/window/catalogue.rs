//! What the window says about the stitches of the catalogue, and what it does with them.

use super::editor::Editor;
use stitch_mesh::stitch::Stitch;

/// Abbreviation and name of a stitch, as in "k2tog · knit two together, leaning right".
pub fn name(symbol: &str) -> String {
    let Ok(stitch) = symbol.parse::<Stitch>() else { return symbol.to_owned() };
    let (short, long) = (stitch.abbreviation(), stitch.description());
    if short == symbol { long } else { format!("{short} · {long}") }
}

/// Sets the stitches that are meant, or takes this one to paint with.
pub(super) fn choose(symbol: &str, editor: &mut Editor) {
    if let Ok(stitch) = symbol.parse() {
        editor.use_stitch(stitch);
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

    #[test]
    fn stitches_have_names() {
        let of = |symbol: &str| describe(&symbol.parse().unwrap());
        assert_eq!([of("d12k"), of("p")], ["k2tog (d12k)", "purl (p)"]);
    }
}
