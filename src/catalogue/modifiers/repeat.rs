//! Repetition on a grid.
//!
//! A copy stands in every cell. The field is the smallest over the copies whose cells are next to the point, and never
//! more than the distance that is left to the box of any copy that was not asked: so it is continuous, keeps the
//! constant, and is right for children that are not symmetric or stick out of their cell.
//!
//! Along an axis with spacing c, let h be how far the child's box reaches from its cell's centre, and x the place in
//! the cell, |x| <= c/2. Asked are the m copies before and the m copies after x, m the least with m c > h. Every other
//! copy is at least m c + |x| - h away: those on the far side exactly so, the others because they lie beyond
//! (m + 1) c - |x|, which is no less for |x| <= c/2. Where the set of asked copies changes (x = 0), the copy that leaves
//! and the one that enters are both that far away, so the smaller of the two is continuous.

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
        axes: [Option<Row>; 3] = [None; 3];
        child: Bounds = Bounds::EVERYWHERE;
        grid: Bounds = Bounds::EVERYWHERE;
    }
    source "copies next to the point, and the distance to the others' boxes; keeps the larger of the constant and 1"
    example "sphere(0.2).repeat(spacing: [0.6, 0, 0.6], count: [3, 1, 3])"
}

/// How a shape is repeated along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    spacing: f64,
    /// The number of copies, perhaps infinite.
    count: f64,
    /// How far the child's box reaches from the centre of its cell.
    reach: f64,
    /// How many copies are asked on each side of the point; none where the child is symmetric and stays in its cell,
    /// so that its own cell's copy is always the nearest.
    asked: Option<u8>,
}

/// No child may stick further out of its cell than this many cells, or too many copies would be asked.
const MOST_ASKED: u8 = 4;

impl Row {
    /// Where the grid lies: copies stand on whole multiples of the spacing for an odd or infinite count, half way
    /// between for an even one.
    fn shift(&self) -> f64 {
        if self.count.is_finite() && self.count % 2.0 == 0.0 {
            0.5
        } else {
            0.0
        }
    }

    /// The number of the last copy, counted from the middle.
    fn last(&self) -> f64 {
        0.5 * (self.count - 1.0)
    }

    /// The places of the point relative to the copies that are asked.
    #[inline(always)]
    fn places<N: Number>(&self, x: N, visit: &mut impl FnMut(N)) {
        let (spacing, shift, last) = (N::splat(self.spacing), N::splat(self.shift()), self.last());
        let scaled = x / spacing - shift;
        let Some(m) = self.asked else {
            let nearest = (scaled + N::splat(0.5)).floor() + shift;
            return visit(x - nearest.clamp(N::splat(-last), N::splat(last)) * spacing);
        };
        if self.is_asked_whole(m) {
            for i in 0..self.count as u32 {
                visit(x - N::splat((f64::from(i) - last) * self.spacing));
            }
            return;
        }
        // Near the ends the asked copies move inwards, so that none is asked twice.
        let m = f64::from(m);
        let before = (scaled.floor() + shift).clamp(N::splat(m - 1.0 - last), N::splat(last - m));
        for i in 0..2 * m as u32 {
            visit(x - (before + N::splat(1.0 - m + f64::from(i))) * spacing);
        }
    }

    /// Whether there are so few copies that all of them are asked.
    fn is_asked_whole(&self, m: u8) -> bool {
        self.count <= 2.0 * f64::from(m)
    }

    /// What is surely left to the box of any copy that is not asked, along this axis alone.
    #[inline(always)]
    fn left_over<N: Number>(&self, x: N) -> N {
        let Some(m) = self.asked else {
            return N::splat(f64::INFINITY);
        };
        if self.is_asked_whole(m) {
            return N::splat(f64::INFINITY);
        }
        let (spacing, shift, last) = (N::splat(self.spacing), N::splat(self.shift()), self.last());
        let scaled = x / spacing - shift;
        let nearest =
            ((scaled + N::splat(0.5)).floor() + shift).clamp(N::splat(-last), N::splat(last));
        let beside = (x - nearest * spacing).abs();
        N::splat(f64::from(m) * self.spacing - self.reach) + beside
    }
}

impl Repeat {
    /// Whether some copies are not asked though they could be the nearest.
    fn is_guarded(&self) -> bool {
        self.axes.iter().flatten().any(|row| row.asked.is_some())
    }

    /// What is surely left from `p` to the box of any copy that is not asked along `axis`: all copies lie inside of the
    /// grid along the other axes.
    #[inline(always)]
    fn guard<N: Number>(&self, axis: usize, p: &Vec3<N>) -> N {
        let Some(row) = &self.axes[axis] else {
            return N::splat(f64::INFINITY);
        };
        let gap = |axis: usize| gap_to(&self.grid, axis, p.component(axis));
        let (u, v) = (gap((axis + 1) % 3), gap((axis + 2) % 3));
        N::norm3(row.left_over(p.component(axis)), u, v)
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
    const RULE: &'static str = "a copy of the child, or the distance to the boxes of copies not asked, whichever is smaller: the larger of \
         the child's constant and 1";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let mut nearest = N::splat(f64::INFINITY);
        let is_guarded = self.is_guarded();
        let mut ask = |q: Vec3<N>| {
            let mut value = child(&q);
            if is_guarded {
                // Outside of its box a copy counts at least as far as the box, as the guard below assumes.
                let box_distance = N::norm3(
                    gap_to(&self.child, 0, q.x),
                    gap_to(&self.child, 1, q.y),
                    gap_to(&self.child, 2, q.z),
                );
                value = N::select_lt(N::splat(0.0), box_distance, value.max(box_distance), value);
            }
            nearest = nearest.min(value);
        };
        along(&self.axes[0], p.x, &mut |x| {
            along(&self.axes[1], p.y, &mut |y| {
                along(&self.axes[2], p.z, &mut |z| ask(Vec3::new(x, y, z)));
            });
        });
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
        // The guard can be as low as the distance to the boxes of copies, and to the places where copies stand, whether
        // or not their boxes are there.
        let mut reach = self.child;
        for axis in (0..3).filter(|axis| self.axes[*axis].is_some()) {
            reach.low[axis] = reach.low[axis].min(0.0);
            reach.high[axis] = reach.high[axis].max(0.0);
        }
        self.extended(copies.hull(reach.inflate(level)))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let mut domain = region;
        for (axis, row) in self.axes.iter().enumerate() {
            if let Some(row) = row {
                let reach = row.spacing * (2.0 * f64::from(row.asked.unwrap_or(0)) + 0.5);
                let end = row.last() * row.spacing;
                // Inside the grid a place is at most `reach` from any asked copy; past its ends it is further.
                domain.low[axis] = -reach + (region.low[axis] + end).min(0.0);
                domain.high[axis] = reach + (region.high[axis] - end).max(0.0);
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
        if self
            .count
            .iter()
            .all(|n| n.is_infinite() || (*n >= 1.0 && n.fract() == 0.0))
        {
            return Ok(());
        }
        Err(("count", "must be whole numbers, 1 or more".into()))
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
            let reach = self.child.high[axis].max(-self.child.low[axis]).max(0.0);
            let asked = if child.is_symmetric[axis] && 2.0 * reach <= spacing {
                None
            } else {
                let least = (reach / spacing).floor() + 1.0;
                if least > f64::from(MOST_ASKED) {
                    return Err(too_large(axis, reach, spacing));
                }
                Some(least as u8)
            };
            self.axes[axis] = Some(Row {
                spacing,
                count,
                reach,
                asked,
            });
        }
        self.grid = self.extended(self.child);
        Ok(())
    }
}

fn too_large(axis: usize, reach: f64, spacing: f64) -> (String, String) {
    let name = crate::catalogue::AXES[axis];
    let problem = format!(
        "the shape reaches {reach} from its origin along {name}, more than {MOST_ASKED} times the spacing {spacing}"
    );
    (
        problem,
        "make the spacing larger, or intersect the shape with a box first".into(),
    )
}

/// Visits the places along one axis: those of a row, or the point's own.
#[inline(always)]
fn along<N: Number>(row: &Option<Row>, x: N, visit: &mut impl FnMut(N)) {
    match row {
        Some(row) => row.places(x, visit),
        None => visit(x),
    }
}
