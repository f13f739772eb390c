//! What is known about a field before it is ever evaluated.

/// What a field's value says about distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Its absolute value, divided by the Lipschitz constant, is at most the distance to the surface.
    Lipschitz,
    /// Its absolute value is at most the distance to the surface.
    Bound,
    /// Its absolute value is the distance to the surface.
    Exact,
}

impl Class {
    /// The class in words.
    pub fn word(self) -> &'static str {
        match self {
            Self::Lipschitz => "lipschitz",
            Self::Bound => "bound",
            Self::Exact => "exact",
        }
    }

    /// What it says about the field.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Lipschitz => "the field is at most the distance times the constant",
            Self::Bound => "the field is at most the distance",
            Self::Exact => "the field is the distance",
        }
    }
}

/// Properties of a field that its entry declares and that combinations preserve or lose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traits {
    /// What its value says about distance.
    pub class: Class,
    /// Whether the field is a convex function (so its solid is convex, and a chord bounds it along every ray).
    pub is_convex: bool,
    /// Whether the field is never negative: the surface has no inside.
    pub is_sheet: bool,
    /// Whether the field is the same on both sides of the plane through the origin across each axis.
    pub is_symmetric: [bool; 3],
    /// Whether the field is a profile: it depends on x and y alone.
    pub is_planar: bool,
}

impl Traits {
    /// An exact field in space without other properties.
    pub const EXACT: Self = Self {
        class: Class::Exact,
        is_convex: false,
        is_sheet: false,
        is_symmetric: [false; 3],
        is_planar: false,
    };
    /// A convex exact field in space that is symmetric across every axis.
    pub const CONVEX: Self = Self {
        is_convex: true,
        is_symmetric: [true; 3],
        ..Self::EXACT
    };

    /// The same, a profile.
    pub const fn planar(self) -> Self {
        let [x, y, _] = self.is_symmetric;
        Self {
            is_planar: true,
            is_symmetric: [x, y, true],
            ..self
        }
    }
}
