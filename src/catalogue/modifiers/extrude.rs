//! Extrusion.

use super::sweep::swept;
use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Gives a profile thickness along z, half of it on each side; it can turn and grow or shrink on its way from the
    /// lower end of z to the upper one.
    Extrude = "extrude" {
        /// The full thickness, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
        /// By how much the upper end is turned against the lower one, counter-clockwise as seen from above.
        twist: f64, Angle, Range::ANY, default 0.0;
        /// The size of the upper end, as a multiple of the lower one's.
        scale: f64, Number, Range::POSITIVE, default 1.0;
    }
    source "Quilez, 2D to 3D (extrusion); the larger of the profile's constant and 1; times sqrt(1 + (t^2 + g^2) r^2) / s with t the twist and g the relative growth per unit, r the distance from the axis"
    example "rectangle([1, 0.5], round: 0.1).extrude(1, twist: 90deg, scale: 0.7).rotate(x: -90deg)"
}

/// Into how many pieces the way from one end to the other is cut to find out where a profile goes that grows.
const PIECES: u32 = 32;

impl Extrude {
    /// Whether every slice is the profile as it is.
    fn is_straight(&self) -> bool {
        self.twist == 0.0 && self.scale == 1.0
    }

    /// The smaller of the ends' factors. Values of the profile are multiplied by it, so that they are no larger than
    /// the distance in any slice.
    fn smallest(&self) -> f64 {
        self.scale.min(1.0)
    }

    /// The way from the lower end at 0 to the upper end at 1.
    fn way(&self, z: f64) -> f64 {
        (z / self.height + 0.5).clamp(0.0, 1.0)
    }

    /// The factor at a place on the way.
    fn factor(&self, way: f64) -> f64 {
        1.0 + (self.scale - 1.0) * way
    }

    /// A box around what becomes of `bounds`, turned and scaled as on the way between two places; back to the profile
    /// for a `sign` of -1.
    fn moved(&self, bounds: Bounds, way: [f64; 2], sign: f64) -> Bounds {
        if self.is_straight() || bounds.is_empty() {
            return bounds;
        }
        let pieces = if self.scale == 1.0 || self.twist == 0.0 {
            1
        } else {
            PIECES
        };
        let place = |i: u32| way[0] + (way[1] - way[0]) * f64::from(i) / f64::from(pieces);
        (0..pieces).fold(Bounds::EMPTY, |all, i| {
            let ends = [place(i), place(i + 1)];
            let factors = ends.map(|t| {
                let factor = self.factor(t);
                if sign < 0.0 { 1.0 / factor } else { factor }
            });
            all.hull(swept(
                bounds,
                2,
                ends.map(|t| sign * self.twist * t),
                factors,
            ))
        })
    }

    /// The profile's field at `p`.
    #[inline(always)]
    fn side<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        if self.is_straight() {
            return child(p);
        }
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let way = (p.z / N::splat(self.height) + N::splat(0.5)).clamp(zero, one);
        let (mut x, mut y) = (p.x, p.y);
        if self.twist != 0.0 {
            let angle = way * N::splat(self.twist);
            let (s, c) = angle.sin_cos();
            (x, y) = (p.x * c + p.y * s, p.y * c - p.x * s);
        }
        if self.scale != 1.0 {
            let factor = one + way * N::splat(self.scale - 1.0);
            (x, y) = (x / factor, y / factor);
        }
        child(&Vec3::new(x, y, p.z)) * N::splat(self.smallest())
    }
}

impl Modifier for Extrude {
    const RULE: &'static str = "the larger of the profile's constant and 1: two orthogonal slopes that are never added; for a twist, times \
         the norm of the Jacobian sqrt(1 + (t^2 + g^2) r^2) / s, t the twist and g the relative growth per unit";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let zero = N::splat(0.0);
        let side = self.side(p, child);
        let cap = p.z.abs() - N::splat(0.5 * self.height);
        side.max(zero).hypot(cap.max(zero)) + side.max(cap).min(zero)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let half = 0.5 * self.height + level;
        let slab = Bounds::centred([f64::INFINITY, f64::INFINITY, half]);
        self.moved(child(level / self.smallest()), [0.0, 1.0], 1.0)
            .intersect(slab)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let way = [region.low[2], region.high[2]].map(|z| self.way(z));
        self.moved(region, way, -1.0)
    }

    fn lipschitz(&self, child: f64, region: Bounds) -> f64 {
        if self.is_straight() || region.is_empty() {
            return child.max(1.0);
        }
        let half = 0.5 * self.height;
        let ends = [region.low[2], region.high[2]].map(|z| self.factor(self.way(z)));
        let least = ends[0].min(ends[1]);
        let is_changing = region.low[2] < half && region.high[2] > -half;
        let slant = if is_changing {
            // The profile's own point moves by this much for each unit along z.
            let (turn, growth) = (self.twist, (self.scale - 1.0) / least);
            turn.hypot(growth) / self.height * region.reach(0).hypot(region.reach(1))
        } else {
            0.0
        };
        (child * self.smallest() / least * slant.hypot(1.0)).max(1.0)
    }

    fn is_regional(&self) -> bool {
        !self.is_straight()
    }

    fn traits(&self, child: &Traits) -> Traits {
        let [x, y, _] = child.is_symmetric;
        if self.is_straight() {
            return Traits {
                is_symmetric: [x, y, true],
                is_planar: false,
                ..*child
            };
        }
        let is_turned = self.twist != 0.0;
        Traits {
            class: Class::Lipschitz,
            is_convex: false,
            is_symmetric: [x && !is_turned, y && !is_turned, false],
            is_planar: false,
            ..*child
        }
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        needs_profile(child, "extruded")
    }
}

/// That the child is a profile.
pub(super) fn needs_profile(child: &Traits, done: &str) -> Result<(), (String, String)> {
    if child.is_planar {
        return Ok(());
    }
    let problem = format!("only a profile can be {done}, and this is a shape in space");
    Err((
        problem,
        "start from a profile such as `circle`, `rectangle` or `polygon`".into(),
    ))
}
