//! Repetition on a grid.
//!
//! A copy stands in every cell. Along an axis with spacing c, let the child's box have the width w. The nearest point of
//! all copies is in one whose box centre is no further than (c + w) / 2 along the axis: else the next copy has the
//! same point nearer. So K >= 1 + w / c copies, those whose boxes are the nearest along the axis, always hold it, and for
//! an exact child the smallest of their fields is the distance to all copies. For a convex child that is the same on
//! both sides, the field grows away from its centre, and its own cell's copy is the smallest, whatever its width.
//!
//! For other children the copies that are not asked could be smaller still, and the field would jump where one of them
//! is asked. There the field is never more than the distance that is left to the boxes of copies that are not asked,
//! at least (K c - w) / 2 >= c / 2, and a copy counts at least as far as its box: so the field is continuous, keeps
//! the constant, and is that of the union wherever that is at most half the spacing.

use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Repeats a shape on a grid around the origin; a count makes the grid finite and centred.
    Repeat = "repeat" {
        /// The distance between copies along x, y and z, in scene units; 0 for no repetition along that axis.
        spacing: [f64; 3], Vector3, Range::NOT_NEGATIVE;
        /// The number of copies along x, y and z; left out, the grid has no end.
        count: [f64; 3], Vector3, Range::COUNT, default [f64::INFINITY; 3];
    }
    derived {
        // In a box of its own, or nodes would be larger for every modifier.
        axes: Box<[Option<Row>; 3]> = Box::default();
        child: Bounds = Bounds::EVERYWHERE;
        grid: Bounds = Bounds::EVERYWHERE;
    }
    source "copies around the point, and half the spacing or more for the others; keeps the larger of the constant and 1"
    example "sphere(0.2).repeat(spacing: [0.6, 0, 0.6], count: [3, 1, 3])"
}

/// How a shape is repeated along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    spacing: f64,
    /// The number of copies, perhaps infinite.
    count: f64,
    /// Where the child's box has its middle.
    middle: f64,
    /// The width of the child's box.
    width: f64,
    /// How many copies are asked: those whose boxes are nearest along the axis.
    asked: f64,
    /// Whether a copy that is not asked could have a smaller field than those that are.
    is_guarded: bool,
    /// See [`grid_shift`].
    shift: f64,
}

/// Along one axis no more copies are asked than this.
const MOST_ASKED: f64 = 9.0;

impl Row {
    /// The number of the last copy, counted from the middle.
    fn last(&self) -> f64 {
        0.5 * (self.count - 1.0)
    }

    /// Whether there are so few copies that all of them are asked.
    fn is_asked_whole(&self) -> bool {
        self.count <= self.asked
    }

    /// The place of the point relative to the grid, in spacings from the copy whose box has its middle at 0.
    #[inline(always)]
    fn scaled<N: Number>(&self, x: N) -> N {
        (x - N::splat(self.middle)) / N::splat(self.spacing) - N::splat(self.shift)
    }

    /// The number of the first copy that is asked, counted from the middle; no matter where all of them are.
    #[inline(always)]
    fn first<N: Number>(&self, x: N) -> N {
        let last = self.last();
        if self.is_asked_whole() {
            return N::splat(-last);
        }
        let first = (self.scaled(x) + N::splat(1.0 - 0.5 * self.asked)).floor();
        // Near the ends the asked copies move inwards, so that none is asked twice.
        let (low, high) = (N::splat(-last), N::splat(last + 1.0 - self.asked));
        (first + N::splat(self.shift)).clamp(low, high)
    }

    /// The place of the point relative to the copy that is asked as number `i`.
    #[inline(always)]
    fn place<N: Number>(&self, x: N, first: N, i: u32) -> N {
        let i = f64::from(i);
        if self.is_asked_whole() {
            return x - N::splat((i - self.last()) * self.spacing);
        }
        x - (first + N::splat(i)) * N::splat(self.spacing)
    }

    /// What is left to the box of any copy that is not asked, along this axis alone.
    #[inline(always)]
    fn left_over<N: Number>(&self, x: N) -> N {
        // Copies change places where this is whole, and the one that leaves is as far as the one that enters.
        let place = self.scaled(x) - N::splat(0.5 * self.asked);
        let (shift, last) = (N::splat(self.shift), self.last());
        let (low, high) = (N::splat(-last), N::splat(last - self.asked));
        let change = ((place + N::splat(0.5)).floor() + shift).clamp(low, high);
        let beside = (place + shift - change).abs() * N::splat(self.spacing);
        N::splat(0.5 * (self.asked * self.spacing - self.width)) + beside
    }

    /// The places, relative to their copies, at which copies are asked for points from `low` to `high`.
    fn domain(&self, low: f64, high: f64) -> (f64, f64) {
        let (spacing, last) = (self.spacing, self.last() * self.spacing);
        if self.is_asked_whole() {
            return (low - last, high + last);
        }
        // Around the middle while the asked copies go along with the point; further off next to the ends.
        let reach = 0.5 * self.asked * spacing;
        let within = (self.asked - 1.0) * spacing;
        (
            (self.middle - reach).min(low + last - within),
            (self.middle + reach).max(high - last + within),
        )
    }
}

impl Repeat {
    /// Whether some copies are not asked though they could be the nearest.
    fn is_guarded(&self) -> bool {
        self.axes.iter().flatten().any(|row| row.is_guarded)
    }

    /// What is surely left from `p` to the box of any copy that is not asked along `axis`: all copies lie inside of the
    /// grid along the other axes.
    #[inline(always)]
    fn guard<N: Number>(&self, axis: usize, p: &Vec3<N>) -> N {
        let Some(row) = self.axes[axis].as_ref().filter(|row| row.is_guarded) else {
            return N::splat(f64::INFINITY);
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        N::norm3(
            row.left_over(p.component(axis)),
            gap_to(&self.grid, u, p.component(u)),
            gap_to(&self.grid, v, p.component(v)),
        )
    }

    /// The box with every copy of `child`.
    fn extended(&self, child: Bounds) -> Bounds {
        let mut bounds = child;
        for (axis, row) in self.axes.iter().enumerate() {
            if let Some(row) = row {
                let last = row.last() * row.spacing;
                bounds.low[axis] -= last;
                bounds.high[axis] += last;
            }
        }
        bounds
    }
}

/// How far coordinate `x` lies outside of `bounds` along `axis`.
#[inline(always)]
fn gap_to<N: Number>(bounds: &Bounds, axis: usize, x: N) -> N {
    let (low, high) = (N::splat(bounds.low[axis]), N::splat(bounds.high[axis]));
    (low - x).max(x - high).max(N::splat(0.0))
}

impl Modifier for Repeat {
    const RULE: &'static str = "the smallest of the child's copies, or what is left to those not asked: the larger of the child's \
         constant and 1";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let mut nearest = N::splat(f64::INFINITY);
        let is_guarded = self.is_guarded();
        let rows = &self.axes;
        let first = Vec3::new(
            first(&rows[0], p.x),
            first(&rows[1], p.y),
            first(&rows[2], p.z),
        );
        // Loops in place: closures that visit places would be functions of their own, without the instructions of the caller.
        for i in 0..asked(&rows[0]) {
            let x = place(&rows[0], p.x, first.x, i);
            for j in 0..asked(&rows[1]) {
                let y = place(&rows[1], p.y, first.y, j);
                for k in 0..asked(&rows[2]) {
                    let q = Vec3::new(x, y, place(&rows[2], p.z, first.z, k));
                    let mut value = child(&q);
                    if is_guarded {
                        // Outside of its box a copy counts at least as far as the box, as the guard below assumes.
                        let box_distance = N::norm3(
                            gap_to(&self.child, 0, q.x),
                            gap_to(&self.child, 1, q.y),
                            gap_to(&self.child, 2, q.z),
                        );
                        let zero = N::splat(0.0);
                        value = N::select_lt(zero, box_distance, value.max(box_distance), value);
                    }
                    nearest = nearest.min(value);
                }
            }
        }
        if !is_guarded {
            return nearest;
        }
        nearest
            .min(self.guard(0, p))
            .min(self.guard(1, p))
            .min(self.guard(2, p))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let copies = child(level);
        if !self.is_guarded() {
            return self.extended(copies);
        }
        // The guard can be as low as the distance to the boxes of copies.
        self.extended(copies.hull(self.child.inflate(level)))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let mut domain = region;
        for (axis, row) in self.axes.iter().enumerate() {
            if let Some(row) = row {
                (domain.low[axis], domain.high[axis]) =
                    row.domain(region.low[axis], region.high[axis]);
            }
        }
        domain
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        if self.is_guarded() {
            child.max(1.0)
        } else {
            child
        }
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.axes.iter().all(Option::is_none) {
            return *child;
        }
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: false,
            ..*child
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        whole_counts(&self.count)
    }

    fn fit(
        &mut self,
        child: &Traits,
        sublevel: &dyn Fn(f64) -> Bounds,
    ) -> Result<(), (String, String)> {
        self.child = sublevel(0.0);
        for axis in 0..3 {
            let (spacing, count) = (self.spacing[axis], self.count[axis]);
            if spacing == 0.0 || count == 1.0 || self.child.is_empty() {
                continue;
            }
            let (low, high) = (self.child.low[axis], self.child.high[axis]);
            let reach = high.max(-low);
            let is_own = child.is_symmetric[axis] && (child.is_convex || 2.0 * reach <= spacing);
            let width = high - low;
            let least = if is_own {
                1.0
            } else {
                (1.0 + width / spacing).ceil()
            };
            let asked = least.min(count);
            if asked > MOST_ASKED {
                return Err(too_large(axis, width, spacing));
            }
            self.axes[axis] = Some(Row {
                spacing,
                count,
                middle: if asked == least && !is_own {
                    0.5 * (low + high)
                } else {
                    0.0
                },
                width,
                asked,
                is_guarded: !is_own && asked < count && child.class < Class::Exact,
                shift: grid_shift(count),
            });
        }
        self.grid = self.extended(self.child);
        Ok(())
    }
}

/// That every count is a whole number.
pub(super) fn whole_counts(count: &[f64; 3]) -> Result<(), (&'static str, String)> {
    let is_whole = |n: &f64| n.is_infinite() || (*n >= 1.0 && n.fract() == 0.0);
    if count.iter().all(is_whole) {
        return Ok(());
    }
    Err(("count", "must be whole numbers, 1 or more".into()))
}

fn too_large(axis: usize, width: f64, spacing: f64) -> (String, String) {
    let (name, most) = (crate::catalogue::AXES[axis], MOST_ASKED - 1.0);
    let problem = format!(
        "the shape is {width} wide along {name}, more than {most} times the spacing {spacing}"
    );
    (
        problem,
        "make the spacing larger, or intersect the shape with a box first".into(),
    )
}

/// How many copies are asked along one axis: one, the shape itself, where there is no row.
#[inline(always)]
fn asked(row: &Option<Row>) -> u32 {
    row.as_ref().map_or(1, |row| row.asked as u32)
}

/// As [`Row::first`]; nothing where there is no row.
#[inline(always)]
fn first<N: Number>(row: &Option<Row>, x: N) -> N {
    match row {
        Some(row) => row.first(x),
        None => N::splat(0.0),
    }
}

/// As [`Row::place`]; the point's own where there is no row.
#[inline(always)]
fn place<N: Number>(row: &Option<Row>, x: N, first: N, i: u32) -> N {
    match row {
        Some(row) => row.place(x, first, i),
        None => x,
    }
}

/// Where a grid of that many cells lies, in cells: they are centred on whole multiples of the spacing for an odd or infinite
/// count, half way between for an even one.
#[inline(always)]
pub(super) fn grid_shift(count: f64) -> f64 {
    if count.is_finite() && is_even(count) {
        0.5
    } else {
        0.0
    }
}

/// Whether a whole number is even.
#[inline(always)]
pub(super) fn is_even(n: f64) -> bool {
    0.5 * n == (0.5 * n).floor()
}
