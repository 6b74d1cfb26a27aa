//! Fabrics of knit and purl by turns, as charts of one repeat.

/// Lines of a chart, the lowest row first, as [`crate::chart::Chart`] reads them.
pub type Lines = Vec<String>;

/// Rib: columns of `knit` stitches by turns with columns of `purl` stitches.
pub fn rib(knit: usize, purl: usize) -> Lines {
    vec![runs(&[("k", knit), ("p", purl)])]
}

/// Garter: `knit` rows by turns with `purl` rows, as seen from the front; 1 and 1 is plain garter.
pub fn garter(knit: usize, purl: usize) -> Lines {
    [vec!["k".to_owned(); knit], vec!["p".to_owned(); purl]].concat()
}

/// Moss: knit and purl by turns in both directions, each kept for `height` rows; 1 is seed, 2 is double moss.
pub fn moss(height: usize) -> Lines {
    basketweave(1, height)
}

/// Basketweave: blocks of `width` × `height` stitches, knit and purl like a chequerboard.
pub fn basketweave(width: usize, height: usize) -> Lines {
    let lower = vec![runs(&[("k", width), ("p", width)]); height];
    let upper = vec![runs(&[("p", width), ("k", width)]); height];
    [lower, upper].concat()
}

fn runs(runs: &[(&str, usize)]) -> String {
    let symbols: Vec<&str> = runs.iter().flat_map(|(s, n)| std::iter::repeat_n(*s, *n)).collect();
    symbols.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Chart;

    #[test]
    fn repeats_are_those_of_a_knitting_book() {
        assert_eq!(rib(2, 1), ["k k p"]);
        assert_eq!(garter(1, 1), ["k", "p"]);
        assert_eq!(moss(1), ["k p", "p k"]);
        assert_eq!(moss(2), ["k p", "k p", "p k", "p k"]);
        assert_eq!(basketweave(3, 2), ["k k k p p p", "k k k p p p", "p p p k k k", "p p p k k k"]);
    }

    #[test]
    fn all_of_them_are_charts() {
        for lines in [rib(1, 3), garter(2, 2), moss(2), basketweave(4, 4)] {
            assert!(lines.join("\n").parse::<Chart>().is_ok(), "{lines:?}");
        }
        assert!(rib(0, 0).join("\n").parse::<Chart>().is_err(), "nothing is no chart");
    }
}
