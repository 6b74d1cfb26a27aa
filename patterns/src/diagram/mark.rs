//! What drawings are made of: lines and convex areas, in squares of the chart, x to the right and y down.

/// A place [squares].
pub type Point = [f32; 2];

/// A colour of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Symbols and numbers.
    Black,
    /// Squares.
    White,
    /// Squares without a stitch.
    Grey,
    /// Lines between squares.
    Grid,
    /// The box around a repeat.
    Red,
    /// Squares of yarn in a colour, sRGB.
    Yarn([u8; 3]),
}

impl Ink {
    /// The colour, sRGB.
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Self::Black => [0x18; 3],
            Self::White => [0xff; 3],
            Self::Grey => [0xbc; 3],
            Self::Grid => [0x8c; 3],
            Self::Red => [0xc6, 0x28, 0x28],
            Self::Yarn(rgb) => rgb,
        }
    }

    /// The colour in which this is read best on squares of another.
    fn on(self, ground: Self) -> Self {
        /// Luma from which squares are light.
        const LIGHT: f32 = 110.0;
        let [r, g, b] = ground.rgb().map(f32::from);
        match self {
            Self::White => ground,
            Self::Black if 0.299 * r + 0.587 * g + 0.114 * b < LIGHT => Self::White,
            other => other,
        }
    }
}

/// How a mark is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The area within the points is filled; it is convex.
    Fill(Ink),
    /// A line through the points, of a width [squares].
    Line(Ink, f32),
}

/// One line or area.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its points; a closed line ends where it begins.
    pub points: Vec<Point>,
    /// How it is drawn.
    pub paint: Paint,
}

impl Mark {
    /// A line of a symbol.
    pub fn line(points: impl IntoIterator<Item = Point>) -> Self {
        /// Width of the lines of symbols [squares].
        const WIDTH: f32 = 0.07;
        Self { points: points.into_iter().collect(), paint: Paint::Line(Ink::Black, WIDTH) }
    }

    /// A filled area.
    pub fn area(points: impl IntoIterator<Item = Point>, ink: Ink) -> Self {
        Self { points: points.into_iter().collect(), paint: Paint::Fill(ink) }
    }

    /// A filled dot.
    pub fn dot(middle: Point, radius: f32) -> Self {
        Self::area(arc(middle, [radius; 2], 0.0, 1.0), Ink::Black)
    }

    /// The same of a symbol on squares of a colour.
    pub fn on(mut self, ground: Ink) -> Self {
        self.paint = match self.paint {
            Paint::Fill(ink) => Paint::Fill(ink.on(ground)),
            Paint::Line(ink, width) => Paint::Line(ink.on(ground), width),
        };
        self
    }

    /// The same elsewhere.
    pub fn moved(mut self, [x, y]: Point) -> Self {
        self.points.iter_mut().for_each(|p| *p = [p[0] + x, p[1] + y]);
        self
    }
}

/// Points of an arc of an ellipse, from one part of a turn to another: from the right over the bottom to the left.
pub fn arc([x, y]: Point, [a, b]: [f32; 2], from: f32, to: f32) -> impl Iterator<Item = Point> {
    /// Pieces of a whole turn.
    const PIECES: f32 = 24.0;
    let pieces = (PIECES * (to - from).abs()).ceil();
    (0..=pieces as usize).map(move |i| {
        let angle = std::f32::consts::TAU * (from + (to - from) * i as f32 / pieces);
        [x + a * angle.cos(), y + b * angle.sin()]
    })
}

/// The corners of a rectangle; the last is the first again.
pub fn rectangle([x, y]: Point, [wide, high]: [f32; 2]) -> [Point; 5] {
    [[x, y], [x + wide, y], [x + wide, y + high], [x, y + high], [x, y]]
}
