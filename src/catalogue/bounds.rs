//! Axis-aligned boxes, possibly infinite: where a solid can be.

/// The box `low <= p <= high`, in scene units; sides may be infinite; empty where `low > high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The smallest corner.
    pub low: [f64; 3],
    /// The largest corner.
    pub high: [f64; 3],
}

impl Bounds {
    /// All of space.
    pub const EVERYWHERE: Self = Self {
        low: [f64::NEG_INFINITY; 3],
        high: [f64::INFINITY; 3],
    };

    /// No point at all.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The box between two corners.
    pub fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        Self { low, high }
    }

    /// The box from `-half` to `half`.
    pub fn centred(half: [f64; 3]) -> Self {
        Self::new(half.map(|h| -h), half)
    }

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |b, p| b.hull(Self::new(p, p)))
    }

    /// Whether no point is inside.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.low[i] > self.high[i])
    }

    /// Whether every side is finite (an empty box is finite).
    pub fn is_finite(&self) -> bool {
        self.is_empty() || (0..3).all(|i| self.low[i].is_finite() && self.high[i].is_finite())
    }

    /// The smallest box around both.
    pub fn hull(self, other: Self) -> Self {
        self.zip(other, f64::min, f64::max)
    }

    /// What is in both.
    pub fn intersect(self, other: Self) -> Self {
        self.zip(other, f64::max, f64::min)
    }

    /// The box with every side moved outwards by `r`.
    pub fn inflate(self, r: f64) -> Self {
        Self::new(self.low.map(|l| l - r), self.high.map(|h| h + r))
    }

    /// The box moved by `v`.
    pub fn translate(self, v: [f64; 3]) -> Self {
        Self::new(
            std::array::from_fn(|i| self.low[i] + v[i]),
            std::array::from_fn(|i| self.high[i] + v[i]),
        )
    }

    /// The box with each axis multiplied by its factor, which may be negative.
    pub fn scale(self, factor: [f64; 3]) -> Self {
        if self.is_empty() {
            return self;
        }
        let side = |i: usize| {
            let (a, b) = (
                product(self.low[i], factor[i]),
                product(self.high[i], factor[i]),
            );
            (a.min(b), a.max(b))
        };
        Self::new(
            std::array::from_fn(|i| side(i).0),
            std::array::from_fn(|i| side(i).1),
        )
    }

    /// The smallest box around the image under the matrix with these rows.
    pub fn transform(self, rows: &[[f64; 3]; 3]) -> Self {
        if self.is_empty() {
            return self;
        }
        let end = |row: &[f64; 3], upper: bool| -> f64 {
            (0..3)
                .map(|j| {
                    let (a, b) = (product(row[j], self.low[j]), product(row[j], self.high[j]));
                    if upper { a.max(b) } else { a.min(b) }
                })
                .sum()
        };
        Self::new(rows.map(|r| end(&r, false)), rows.map(|r| end(&r, true)))
    }

    /// The largest absolute value of coordinate `axis` inside; 0 for an empty box.
    pub fn reach(&self, axis: usize) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        self.low[axis].abs().max(self.high[axis].abs())
    }

    /// The radius of the smallest sphere about the origin that holds the box; 0 for an empty box.
    pub fn radius(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|i| self.reach(i));
        x.hypot(y).hypot(z)
    }

    /// The radius of the smallest sphere that holds the box; 0 for an empty box.
    pub fn radius_about_centre(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let [x, y, z] = self.size();
        0.5 * x.hypot(y).hypot(z)
    }

    /// The largest absolute value of any coordinate that is finite; 0 where there is none.
    pub fn finite_size(&self) -> f64 {
        let sides = self.low.iter().chain(&self.high);
        sides
            .map(|c| c.abs())
            .filter(|c| c.is_finite())
            .fold(0.0, f64::max)
    }

    /// The middle of the box.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|i| 0.5 * (self.low[i] + self.high[i]))
    }

    /// The lengths of the sides.
    pub fn size(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.high[i] - self.low[i])
    }

    /// Whether `p` is inside or on the border.
    pub fn contains(&self, p: [f64; 3]) -> bool {
        (0..3).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i])
    }

    /// Whether all of `other` is inside.
    pub fn encloses(&self, other: &Self) -> bool {
        other.is_empty() || (self.contains(other.low) && self.contains(other.high))
    }

    fn zip(self, o: Self, low: fn(f64, f64) -> f64, high: fn(f64, f64) -> f64) -> Self {
        Self::new(
            std::array::from_fn(|i| low(self.low[i], o.low[i])),
            std::array::from_fn(|i| high(self.high[i], o.high[i])),
        )
    }
}

/// The product in which zero times infinity is zero.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}
