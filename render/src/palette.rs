//! Colours with a meaning, as linear RGB.

/// Rows of labels take these in turn: the eight of Okabe and Ito without their black and grey, told apart by every kind
/// of colour vision, in an order where neighbours differ in lightness too.
const ROWS: [u32; 7] = [0x56b4e9, 0xd55e00, 0xf0e442, 0x0072b2, 0xe69f00, 0x009e73, 0xcc79a7];

/// Odd rows of stitches are darker by this factor, so that rows can be counted.
const ODD_ROW: f32 = 0.82;

/// Course edges, along a row.
pub const COURSE_EDGE: [f32; 3] = hex(0x12324a);
/// Wale edges, across the rows.
pub const WALE_EDGE: [f32; 3] = hex(0x9c2a12);
/// Edges that have no label yet.
pub const UNLABELLED_EDGE: [f32; 3] = hex(0x8a8780);
/// Faces that have no row yet.
pub const UNLABELLED_FACE: [f32; 3] = hex(0xd9d5cc);
/// What the pointer is over.
pub const HOVERED: [f32; 3] = hex(0xffffff);
/// What is selected.
pub const SELECTED: [f32; 3] = hex(0xffb000);
/// A strand of a cable.
pub const CABLE: [f32; 3] = hex(0x5a1f6b);
/// Yarn nobody has chosen a colour for: undyed wool.
pub const YARN: [f32; 3] = hex(0xe4d6bd);

/// How much white the row colours are mixed with, so that edges and arrows stand out on the dark ones too.
const ROW_TINT: f32 = 0.3;

/// Colour of a row of labels.
pub fn row(index: usize) -> [f32; 3] {
    hex(ROWS[index % ROWS.len()]).map(|channel| channel + (1.0 - channel) * ROW_TINT)
}

/// Colours of the kinds of stitches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StitchColors {
    /// Kinds are told apart by every kind of colour vision. Knit is a calm light sand, purl a clear blue, a yarn-over nearly
    /// white like the hole it makes. Decreases lean to red and increases to green, deeper when more stitches meet, bluer when
    /// they are purled.
    #[default]
    Distinct,
    /// A strong hue for each of the seven types that Yuksel et al. colour (Fig. 16): `k`, `p`, `ky`, `yk`, `yky`, `d12k`,
    /// `d21k`. Their key is a picture without names, so the hues are ours; what they are for is to tell the two slants of a
    /// decrease and the two sides of a yarn-over apart, which the colours above do not. Other kinds are as above.
    Paper,
    /// No kinds: every stitch has the colour of its yarn.
    Yarn,
}

impl StitchColors {
    /// All, each with a name and what it is for.
    pub const ALL: [(Self, &str, &str); 3] = [
        (Self::Distinct, "Distinct", "Kinds of stitches are told apart by every kind of colour vision"),
        (
            Self::Paper,
            "As in the paper",
            "A strong hue for each of the seven types of Stitch Meshes, slants apart",
        ),
        (Self::Yarn, "Yarn", "Every stitch has the colour of its yarn"),
    ];

    /// Colour of a stitch by its symbol (`k`, `p`, `y`, `kp`, `d12k`, …) and that of its yarn, in a row. Odd rows are darker.
    pub fn of(self, symbol: &str, yarn: [f32; 3], row: usize) -> [f32; 3] {
        let color = match (self, symbol) {
            (Self::Yarn, _) => return yarn.map(|channel| channel * shade(row)),
            (Self::Distinct, _) => distinct(symbol),
            (_, "k") => 0xf2dc5c,
            (_, "p") => 0x4a86d8,
            (_, "ky") => 0x62bf4b,
            (_, "yk") => 0xf0913a,
            (_, "yky") => 0xb565cf,
            (_, "d12k") => 0xe2483d,
            (_, "d21k") => 0x2fb9ae,
            (Self::Paper, other) => distinct(other),
        };
        hex(color).map(|channel| channel * shade(row))
    }
}

fn shade(row: usize) -> f32 {
    if row % 2 == 1 { ODD_ROW } else { 1.0 }
}

fn distinct(symbol: &str) -> u32 {
    // What begins from nothing is no decrease.
    let symbol = symbol.strip_prefix("d0").unwrap_or(symbol);
    let actions = || symbol.chars().filter(|c| matches!(c, 'k' | 'p' | 'y'));
    let purled = actions().next() == Some('p');
    if let Some(order) = symbol.strip_prefix('d') {
        let stacked = order.chars().filter(char::is_ascii_digit).count();
        match (stacked, purled) {
            (..=2, false) => 0xe39a72,
            (..=2, true) => 0xb97a9e,
            (_, false) => 0xcb6a4c,
            (_, true) => 0x94527c,
        }
    } else {
        match (actions().count(), purled) {
            (1, _) if symbol.starts_with('y') => 0xf6f3ea,
            (1, false) => 0xe3d6bb,
            (1, true) => 0x7f9fbe,
            (2, false) => 0xa9c47f,
            (2, true) => 0x6fae9a,
            (3.., false) => 0x7aa653,
            (3.., true) => 0x468f7c,
            _ => 0xb8b4ab, // nothing this palette knows
        }
    }
}

/// Strain at which the colours of [`strain`] end: stitches a third wider or narrower than the others show at a glance.
pub const MOST_STRAIN: f32 = 0.3;

/// Colour of a face by its strain: blue where it is pressed, red where it is stretched, nearly white where it is even. The
/// colours are told apart by every kind of colour vision (Brewer's RdBu).
pub fn strain(strain: f32) -> [f32; 3] {
    const STEPS: [u32; 7] = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];
    let place = (strain / MOST_STRAIN).clamp(-1.0, 1.0) * 3.0 + 3.0;
    let step = (place as usize).min(STEPS.len() - 2);
    let [low, high] = [0, 1].map(|i| hex(STEPS[step + i]));
    [0, 1, 2].map(|i| low[i] + (high[i] - low[i]) * (place - step as f32))
}

/// Linear RGB of a colour as written on the web. A `const` function, so it inverts the sRGB curve by the polynomial that
/// is within 0.004 of it.
const fn hex(rgb: u32) -> [f32; 3] {
    [linear((rgb >> 16) as u8), linear((rgb >> 8) as u8), linear(rgb as u8)]
}

const fn linear(byte: u8) -> f32 {
    let c = byte as f32 / 255.0;
    c * (c * (c * 0.305_306 + 0.682_171_1) + 0.012_522_878)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
        (0..3).map(|i| (a[i].powf(1.0 / 2.2) - b[i].powf(1.0 / 2.2)).powi(2)).sum::<f32>().sqrt()
    }

    #[test]
    fn linear_inverts_the_srgb_curve() {
        for byte in 0..=255 {
            let c = byte as f32 / 255.0;
            let exact = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
            assert!((linear(byte) - exact).abs() < 0.004, "{byte}");
        }
    }

    #[test]
    fn neighbouring_rows_differ() {
        assert!((0..14).all(|i| distance(row(i), row(i + 1)) > 0.25));
    }

    #[test]
    fn strain_goes_from_blue_over_white_to_red() {
        let [pressed, even, stretched] = [-MOST_STRAIN, 0.0, MOST_STRAIN].map(strain);
        assert!(pressed[2] > 2.0 * pressed[0] && stretched[0] > 2.0 * stretched[2]);
        assert!(even.iter().all(|c| *c > 0.85));
        assert_eq!(strain(5.0), stretched);
        assert!(distance(strain(0.1), even) > 0.1 && distance(strain(-0.1), even) > 0.1);
    }

    #[test]
    fn kinds_of_stitches_differ() {
        let stitch = |symbol, row| StitchColors::Distinct.of(symbol, YARN, row);
        let kinds = ["k", "p", "y", "kp", "py", "kyk", "pyp", "d12k", "d21p", "d123k", "d312p"];
        for (i, a) in kinds.iter().enumerate() {
            for b in &kinds[..i] {
                assert!(distance(stitch(a, 0), stitch(b, 0)) > 0.1, "{a} and {b}");
            }
        }
        assert!(stitch("k", 1)[0] < stitch("k", 2)[0]);
        assert_eq!(stitch("d12k", 0), stitch("d21k", 0));
    }

    #[test]
    fn the_types_of_the_paper_differ_more() {
        let stitch = |symbol, row| StitchColors::Paper.of(symbol, YARN, row);
        let types = ["k", "p", "ky", "yk", "yky", "d12k", "d21k"];
        for (i, a) in types.iter().enumerate() {
            assert!(types[..i].iter().all(|b| distance(stitch(a, 0), stitch(b, 0)) > 0.25), "{a}");
            assert!(stitch(a, 1)[0] < stitch(a, 0)[0]);
        }
        assert_eq!(stitch("kpk", 0), StitchColors::Distinct.of("kpk", YARN, 0));
    }
}
