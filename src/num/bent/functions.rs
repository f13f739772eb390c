//! The functions of numbers with bends.

use super::{Bent, ZERO, around_zero, common, crossed, length, norm, times};
use crate::num::{Interval, Lattice, Number, Steep};

/// Whether the first is the smaller one, where ranges say.
fn is_less(a: &Bent, b: &Bent) -> Option<bool> {
    let (a, b) = (a.value(), b.value());
    (a.hi < b.lo || a.lo >= b.hi).then_some(a.hi < b.lo)
}

impl Bent {
    /// 1 / self, where it is not 0.
    pub(super) fn reciprocal(self) -> Self {
        let inverse = Interval::point(1.0) / self.value();
        let square = inverse.square();
        let steep = Steep::splat(1.0) / self.steep;
        self.smooth(steep, -square, Interval::point(2.0) * inverse * square)
    }

    /// `self^e` for a constant exponent and numbers that are not negative, or positive where the power is infinite at 0.
    fn constant_power(self, steep: Steep, e: f64) -> Self {
        let x = self.value();
        if x.lo < 0.0 || e < 0.0 && x.lo == 0.0 {
            return Self::unknown(steep);
        }
        let point = Interval::point;
        let (e1, e2) = (point(e) - point(1.0), point(e) - point(2.0));
        let first = point(e) * x.pow(e1);
        let second = point(e) * e1 * x.pow(e2);
        self.smooth(steep, first, second)
    }
}

impl Number for Bent {
    type Constant = f64;

    const HAS_BENDS: bool = true;

    fn constant(x: f64) -> f64 {
        x
    }

    fn spread(x: f64) -> Self {
        Self::new(Steep::splat(x), ZERO)
    }

    fn min(self, o: Self) -> Self {
        -(-self).max(-o)
    }

    /// The larger of two is bent upwards at its kinks, and else as one of the two.
    fn max(self, o: Self) -> Self {
        let steep = self.steep.max(o.steep);
        match is_less(&self, &o) {
            Some(true) => Self { steep, ..o },
            Some(false) => Self { steep, ..self },
            None => {
                let bend = Interval {
                    lo: self.bend.lo.min(o.bend.lo),
                    hi: f64::INFINITY,
                };
                Self::new(steep, bend)
            }
        }
    }

    fn abs(self) -> Self {
        let (steep, range) = (self.steep.abs(), self.value());
        if range.lo >= 0.0 {
            return Self { steep, ..self };
        }
        if range.hi <= 0.0 {
            return Self { steep, ..-self };
        }
        let bend = Interval {
            lo: self.bend.lo.min(-self.bend.hi),
            hi: f64::INFINITY,
        };
        Self::new(steep, bend)
    }

    fn sqrt(self) -> Self {
        let steep = self.steep.sqrt();
        let inverse = Interval::point(0.5) / steep.value();
        let second = -(inverse.square() / steep.value());
        self.smooth(steep, inverse, second)
    }

    fn floor(self) -> Self {
        let steep = self.steep.floor();
        Self::new(steep, self.value().floor_slope())
    }

    fn sin(self) -> Self {
        let (sine, cosine) = self.value().sin_cos();
        self.wave(self.steep.sin(), cosine, -sine)
    }

    fn cos(self) -> Self {
        let (sine, cosine) = self.value().sin_cos();
        self.wave(self.steep.cos(), -sine, -cosine)
    }

    /// The gradient of the angle at the distance r is 1 / r long, its second derivatives are within 1 / r^2.
    fn atan2(self, x: Self) -> Self {
        let steep = self.steep.atan2(x.steep);
        let jumps = self.value().atan2_slope(x.value(), ZERO) == Interval::ENTIRE;
        let nearest = self.value().hypot(x.value()).lo;
        if jumps || nearest <= 0.0 {
            return Self::unknown(steep);
        }
        let bends = length([self, x].map(|q| q.bend.magnitude()));
        let turn = norm(&[self.steep, x.steep]) / nearest;
        let most = times(turn, turn) + (bends / nearest).next_up();
        // Three more roundings.
        Self::new(steep, around_zero(most * (1.0 + 1e-15)))
    }

    fn exp(self) -> Self {
        let steep = self.steep.exp();
        self.smooth(steep, steep.value(), steep.value())
    }

    fn ln(self) -> Self {
        let inverse = Interval::point(1.0) / self.value();
        self.smooth(self.steep.ln(), inverse, -inverse.square())
    }

    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        let steep = Steep::select_lt(a.steep, b.steep, x.steep, y.steep);
        match is_less(&a, &b) {
            Some(true) => x,
            Some(false) => y,
            None => Self::unknown(steep),
        }
    }

    fn square(self) -> Self {
        let first = self.value() + self.value();
        self.smooth(self.steep.square(), first, Interval::point(2.0))
    }

    /// Within [0, 1] the bends are mixed too: their ends are linear in the share.
    fn mix(self, a: Self, b: Self) -> Self {
        let steep = self.steep.mix(a.steep, b.steep);
        let (share, rise) = (self.value(), b - a);
        let product = a + rise * self;
        if share.lo < 0.0 || share.hi > 1.0 {
            return Self::new(steep, product.bend);
        }
        let at = |t: f64| {
            let rest = Interval::point(1.0) - Interval::point(t);
            rest * a.bend + Interval::point(t) * b.bend
        };
        let between = at(share.lo).hull(at(share.hi));
        let bend = between + rise.value() * self.bend + crossed(&rise.steep, &self.steep);
        Self::new(steep, common(bend, product.bend))
    }

    fn ease(self) -> Self {
        let point = Interval::point;
        let from_middle = self.value() - point(0.5);
        let first = point(1.5) - point(6.0) * from_middle.square();
        self.smooth(self.steep.ease(), first, point(-12.0) * from_middle)
    }

    /// The slope of the cubic is 0 at its ends, so beyond them only the bend 0 is added.
    fn smoothstep(self) -> Self {
        let (point, x) = (Interval::point, self.value());
        let steep = self.steep.smoothstep();
        if x.hi <= 0.0 || x.lo >= 1.0 {
            return Self::new(steep, ZERO);
        }
        let from_middle = x.clamp(point(0.0), point(1.0)) - point(0.5);
        let first = point(1.5) - point(6.0) * from_middle.square();
        let first = common(Interval::new(0.0, 1.5), first);
        let second = point(-12.0) * from_middle;
        let is_within = x.lo >= 0.0 && x.hi <= 1.0;
        let second = if is_within { second } else { second.hull(ZERO) };
        self.smooth(steep, first, second)
    }

    fn hypot(self, o: Self) -> Self {
        Self::length(self.steep.hypot(o.steep), [self, o])
    }

    fn norm3(x: Self, y: Self, z: Self) -> Self {
        Self::length(Steep::norm3(x.steep, y.steep, z.steep), [x, y, z])
    }

    fn pow(self, e: Self) -> Self {
        let steep = self.steep.pow(e.steep);
        let exponent = e.value();
        if exponent.lo == exponent.hi {
            return self.constant_power(steep, exponent.lo);
        }
        if self.value().lo <= 0.0 {
            return Self::unknown(steep);
        }
        Self::new(steep, (e * self.ln()).exp().bend)
    }

    fn powi(self, n: i32) -> Self {
        let (steep, x) = (self.steep.powi(n), self.value());
        let point = |n: i32| Interval::point(n.into());
        match n {
            0 => Self::splat(1.0),
            1 => self,
            2 => self.square(),
            _ if n < 0 && x.contains(0.0) => Self::unknown(steep),
            _ => {
                let first = point(n) * x.powi(n.saturating_sub(1));
                let second = point(n) * point(n.saturating_sub(1)) * x.powi(n.saturating_sub(2));
                self.smooth(steep, first, second)
            }
        }
    }

    fn tan(self) -> Self {
        let steep = self.steep.tan();
        let first = Interval::point(1.0) + steep.value().square();
        let second = Interval::point(2.0) * steep.value() * first;
        self.smooth(steep, first, second)
    }

    fn asin(self) -> Self {
        let first = Interval::point(1.0) / self.value().cathetus();
        let second = self.value() * (first.square() * first);
        self.smooth(self.steep.asin(), first, second)
    }

    fn acos(self) -> Self {
        let first = Interval::point(1.0) / self.value().cathetus();
        let second = self.value() * (first.square() * first);
        self.smooth(self.steep.acos(), -first, -second)
    }

    fn cathetus(self) -> Self {
        let steep = self.steep.cathetus();
        let inverse = Interval::point(1.0) / self.value().cathetus();
        let second = -(inverse.square() * inverse);
        self.smooth(steep, -(self.value() * inverse), second)
    }

    /// The derivatives of u(a, b) add up to 1, so the bends of a and b are mixed, and less by at most the curvature times
    /// the square of (a - b)'.
    fn with_curvature(self, curvature: f64, of: [Self; 2]) -> Self {
        if curvature == f64::INFINITY {
            return self;
        }
        let [a, b] = of;
        let most = (b - a).squares() * Interval::point(curvature);
        let bend = Interval {
            lo: (a.bend.lo.min(b.bend.lo) - most.hi).next_down(),
            hi: a.bend.hi.max(b.bend.hi),
        };
        Self::new(self.steep, common(bend, self.bend))
    }

    /// A convex function is the largest of the linear functions that touch it from below, and those are bent by no more
    /// than the point, since none is steeper than 1.
    fn with_convexity<const K: usize>(self, of: [Self; K]) -> Self {
        let bend = Interval {
            lo: -length(of.map(|q| q.bend.magnitude())),
            hi: f64::INFINITY,
        };
        Self::new(self.steep, common(bend, self.bend))
    }

    /// With the point q and the gradient g: at most the largest bend times |q'|^2, and g.q''.
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        let steep = Steep::lattice(lattice, x.steep, y.steep, z.steep);
        let parts = [x, y, z];
        let [u, v, w] = parts.map(|q| q.value());
        let most = lattice.bend();
        if most == f64::INFINITY {
            return Self::unknown(steep);
        }
        let gradient = Interval::lattice_slope(lattice, u, v, w);
        let carried = parts.into_iter().zip(gradient);
        let carried = carried.fold(ZERO, |sum, (q, slope)| sum + slope * q.bend);
        let speed = norm(&parts.map(|q| q.steep));
        let own = around_zero(times(most, times(speed, speed)));
        Self::new(steep, own + carried)
    }
}
