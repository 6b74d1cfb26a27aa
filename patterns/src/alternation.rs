//! Alternations of knit and purl that every knitter knows, as charts.
//!
//! Seen from the front; a flat piece worked to and fro shows the same there as a tube.

use crate::chart::{Chart, ChartError};
use stitch_mesh::stitch::Stitch;

fn line(stretches: &[(usize, Stitch)]) -> Vec<Stitch> {
    stretches.iter().flat_map(|(n, stitch)| std::iter::repeat_n(stitch.clone(), *n)).collect()
}

/// Columns of `n` knits and `m` purls by turns.
///
/// # Errors
/// [`ChartError::Empty`] for `n` = `m` = 0.
pub fn rib(n: usize, m: usize) -> Result<Chart, ChartError> {
    Chart::new(vec![line(&[(n, Stitch::knit()), (m, Stitch::purl())])])
}

/// Rows of knits and rows of purls by turns.
pub fn garter() -> Chart {
    Chart { rows: vec![vec![Stitch::knit()], vec![Stitch::purl()]] }
}

/// Moss or seed stitch: knits and purls by turns along rows and columns.
pub fn moss() -> Chart {
    Chart { rows: blocks(1, 1) }
}

/// Blocks of `n` stitches by `m` rows, knit and purl by turns like the squares of a chessboard.
///
/// # Errors
/// [`ChartError::Empty`] where a block has no stitches.
pub fn basketweave(n: usize, m: usize) -> Result<Chart, ChartError> {
    Chart::new(blocks(n, m))
}

fn blocks(n: usize, m: usize) -> Vec<Vec<Stitch>> {
    let knit_first = line(&[(n, Stitch::knit()), (n, Stitch::purl())]);
    let purl_first = line(&[(n, Stitch::purl()), (n, Stitch::knit())]);
    [vec![knit_first; m], vec![purl_first; m]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternations_are_what_their_names_say() {
        assert_eq!(rib(2, 1).unwrap().lines(), ["k k p"]);
        assert_eq!(garter().lines(), ["k", "p"]);
        assert_eq!(moss().lines(), ["k p", "p k"]);
        assert_eq!(basketweave(2, 2).unwrap().lines(), ["k k p p", "k k p p", "p p k k", "p p k k"]);
        assert!(rib(0, 0).is_err() && basketweave(0, 3).is_err() && basketweave(3, 0).is_err());
    }

    #[test]
    fn a_chart_reads_its_own_lines() {
        let chart = basketweave(3, 2).unwrap();
        assert_eq!(chart.lines().join("\n").parse::<Chart>().unwrap(), chart);
    }
}
