//! How series and points look.

/// A colour as 8-bit sRGB.
pub(super) type Color = [u8; 3];

pub(super) const INK: Color = [40, 40, 46];
pub(super) const FAINT: Color = [120, 120, 128];
pub(super) const GRID: Color = [228, 228, 232];
pub(super) const PAPER: Color = [255; 3];
pub(super) const WRONG: Color = [178, 178, 184];
pub(super) const RING: Color = [200, 0, 40];
pub(super) const BAND: Color = [222, 226, 236];

/// Ten colours that people who see few colours can tell apart, as far as ten can be. Sources: the first seven but black, Okabe
/// and Ito 2008, without their yellow; the others, Tol 2021, scheme "muted".
const COLORS: [Color; 10] = [
    [213, 94, 0],
    [0, 114, 178],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [60, 60, 66],
    [136, 34, 85],
    [51, 34, 136],
    [153, 153, 51],
];

/// How many styles can be told apart.
pub const STYLES: usize = COLORS.len() * Shape::ALL.len();

/// How a point looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Look {
    /// It is what one gets without asking: larger, with a dark rim.
    pub is_default: bool,
    /// It is wrong: grey.
    pub is_wrong: bool,
    /// It is not certain everywhere: crossed.
    pub is_crossed: bool,
    /// Its bounds were refuted: ringed.
    pub is_ringed: bool,
}

impl Look {
    /// Whether it bears one of the marks of `other`.
    pub(super) fn has_some_of(&self, other: &Self) -> bool {
        (self.is_default && other.is_default)
            || (self.is_wrong && other.is_wrong)
            || (self.is_crossed && other.is_crossed)
            || (self.is_ringed && other.is_ringed)
    }
}

/// The shape of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Disc,
    Square,
    Up,
    Diamond,
    Down,
}

impl Shape {
    const ALL: [Self; 5] = [
        Self::Disc,
        Self::Square,
        Self::Up,
        Self::Diamond,
        Self::Down,
    ];

    /// The corners around the middle for a point of radius 1; a disc has many.
    pub fn corners(self) -> Vec<[f64; 2]> {
        let regular = |n: usize, turn: f64, radius: f64| {
            let angle = move |i: usize| std::f64::consts::TAU * (i as f64 + turn) / n as f64;
            (0..n)
                .map(move |i| [radius * angle(i).sin(), -radius * angle(i).cos()])
                .collect()
        };
        match self {
            Self::Disc => regular(16, 0.0, 1.0),
            Self::Square => regular(4, 0.5, 1.25),
            Self::Up => regular(3, 0.0, 1.35),
            Self::Diamond => regular(4, 0.0, 1.3),
            Self::Down => regular(3, 0.5, 1.35),
        }
    }
}

/// The colour and the shape of a series by its number; the first [`STYLES`] differ.
pub(super) fn style(number: usize) -> (Color, Shape) {
    let (colors, shapes) = (COLORS.len(), Shape::ALL.len());
    (
        COLORS[number % colors],
        Shape::ALL[(number + number / colors) % shapes],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn styles_differ() {
        let all: Vec<_> = (0..STYLES).map(style).collect();
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a != b), "{i}");
        }
    }
}
