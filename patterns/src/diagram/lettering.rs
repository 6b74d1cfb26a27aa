//! Letters and digits as lines: charts have few words, and so they look the same in every kind of file without any font.

use super::mark::{Ink, Mark, Paint, Point};

/// The lines of each letter; a point is two digits, x from the left and y from two below the base line. Small letters are
/// four high, tall ones and digits six.
const LETTERS: [(char, &str); 48] = [
    ('a', "4642 4536160503123243"),
    ('b', "0802 0516364543321203"),
    ('c', "4536160503123243"),
    ('d', "4842 4536160503123243"),
    ('e', "04444536160503123243"),
    ('f', "38281712 0636"),
    ('g', "4641301001 4536160503123243"),
    ('h', "0802 0516364542"),
    ('i', "0602 0708"),
    ('j', "161100 1718"),
    ('k', "0802 360432"),
    ('l', "0802"),
    ('m', "0602 05162522 25364542"),
    ('n', "0602 0516364542"),
    ('o', "160503123243453616"),
    ('p', "0600 0516364543321203"),
    ('q', "4640 4536160503123243"),
    ('r', "0602 051636"),
    ('s', "45361605143443321203"),
    ('t', "18132232 0636"),
    ('u', "0603123243 4642"),
    ('v', "062246"),
    ('w', "0612253246"),
    ('x', "0642 0246"),
    ('y', "0622 4610"),
    ('z', "06460242"),
    ('0', "180703123243473818"),
    ('1', "071812 0222"),
    ('2', "07183847460242"),
    ('3', "07183847463515 35444332 1203 3212"),
    ('4', "380444 3832"),
    ('5', "48080535444332 1203 3212"),
    ('6', "4738180703123243443505"),
    ('7', "084812"),
    ('8', "153544433212030415 1506071838474635"),
    ('9', "0312324347381807061545"),
    (',', "1201"),
    ('.', "0203"),
    (':', "0203 0506"),
    ('(', "18070312"),
    (')', "08171302"),
    ('-', "0434"),
    ('–', "0434"),
    ('+', "0444 2622"),
    ('/', "0238"),
    ('×', "0642 0246"),
    (';', "1201 1516"),
    ('#', "1218 3238 0444 0646"),
];

/// Unit of the letters' points over the height of a tall letter.
const UNIT: f32 = 1.0 / 6.0;
/// Space after a letter, and width of a space [units].
const SPACE: [f32; 2] = [1.8, 3.0];

/// Lines of a letter; one that is not among them is a space.
fn lines(letter: char) -> impl Iterator<Item = Vec<Point>> {
    let letter = letter.to_ascii_lowercase();
    let text = LETTERS.iter().find(|l| l.0 == letter).map_or("", |l| l.1);
    let number = |b: u8| f32::from(b.wrapping_sub(b'0'));
    let point = move |p: &[u8]| [number(p[0]), number(p[1]) - 2.0];
    text.split(' ').filter(|l| !l.is_empty()).map(move |l| l.as_bytes().chunks_exact(2).map(point).collect())
}

/// How far a letter takes the pen [units].
fn advance(letter: char) -> f32 {
    let right = lines(letter)
        .flatten()
        .map(|p| p[0])
        .fold(None, |most: Option<f32>, x| Some(most.map_or(x, |most| most.max(x))));
    right.map_or(SPACE[1], |right| right + SPACE[0])
}

/// Width of a text [squares] whose tall letters have some height [squares].
pub(super) fn width(text: &str, height: f32) -> f32 {
    (text.chars().map(advance).sum::<f32>() - SPACE[0]).max(0.0) * UNIT * height
}

/// A text that begins at a place on its base line.
pub(super) fn write(text: &str, [x, y]: Point, height: f32) -> Vec<Mark> {
    /// Width of the lines over the height of a tall letter.
    const WIDTH: f32 = 0.13;
    let unit = UNIT * height;
    let mut marks = Vec::new();
    let mut pen = 0.0;
    for letter in text.chars() {
        for line in lines(letter) {
            let points = line.into_iter().map(|p| [x + (pen + p[0]) * unit, y - p[1] * unit]).collect();
            marks.push(Mark { points, paint: Paint::Line(Ink::Black, WIDTH * height) });
        }
        pen += advance(letter);
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_is_written_in_whole_points() {
        for (letter, text) in LETTERS {
            for line in text.split(' ') {
                assert!(line.len() % 2 == 0 && line.len() >= 4, "{letter}: {line}");
                assert!(line.bytes().all(|b| b.is_ascii_digit()), "{letter}: {line}");
            }
        }
        assert!(width("mm", 1.0) > width("il", 1.0));
        assert_eq!(width("", 1.0), 0.0);
    }
}
