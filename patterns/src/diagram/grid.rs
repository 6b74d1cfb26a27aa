//! Where the cells of a row stand.
//!
//! A stitch wants to stand above the loop it is knitted into, a decrease above the one of its loops that lies in front; a
//! yarn-over comes from nothing and takes what is left. In their order and without overlapping, the cells stand so that
//! they are away from there by as few columns as possible, together; of equal places the left one is taken. So the squares
//! without a stitch stand where a loop was taken by a decrease, until another comes out of nothing in their place.

/// A cell without a place.
pub(super) struct Piece {
    /// Its columns.
    pub(super) width: usize,
    /// Where its first column should be.
    pub(super) wants: Vec<i64>,
}

/// The first column of each piece. Together they are no wider than `columns`.
pub(super) fn place(pieces: &[Piece], columns: usize) -> Vec<usize> {
    let used: usize = pieces.iter().map(|p| p.width).sum();
    let spare = columns.saturating_sub(used);
    // Of piece i, the places right of the pieces before it set close together: 0 to `spare`.
    let mut best = vec![vec![0u64; spare + 1]];
    let mut close = Vec::with_capacity(pieces.len());
    let mut before = 0;
    for piece in pieces {
        let away = |gap: usize| {
            let column = (before + gap) as i64;
            piece.wants.iter().map(|want| column.abs_diff(*want)).sum::<u64>()
        };
        let mut row: Vec<u64> = (0..=spare).map(|gap| best[best.len() - 1][gap] + away(gap)).collect();
        for gap in 1..=spare {
            row[gap] = row[gap].min(row[gap - 1]);
        }
        best.push(row);
        close.push(before);
        before += piece.width;
    }
    let mut gap = spare;
    let mut places = vec![0; pieces.len()];
    for i in (0..pieces.len()).rev() {
        while gap > 0 && best[i + 1][gap - 1] == best[i + 1][gap] {
            gap -= 1;
        }
        places[i] = close[i] + gap;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(wants: &[Option<i64>], columns: usize) -> Vec<usize> {
        let piece = |want: &Option<i64>| Piece { width: 1, wants: want.iter().copied().collect() };
        place(&wants.iter().map(piece).collect::<Vec<_>>(), columns)
    }

    #[test]
    fn cells_stand_where_they_want_and_keep_their_order() {
        assert_eq!(placed(&[Some(1), Some(3)], 5), [1, 3]);
        assert_eq!(placed(&[Some(2), Some(2)], 4), [1, 2], "the left of equal places");
        assert_eq!(placed(&[Some(0), None, Some(3)], 4), [0, 1, 3]);
        assert_eq!(placed(&[Some(-2), Some(9)], 4), [0, 3]);
        assert_eq!(placed(&[], 3), [0; 0]);
    }
}
