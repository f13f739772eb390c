//! The prism.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{PI, TAU};

entry! {
    /// A bar along the y axis whose section is a regular polygon, with a corner on the positive x axis.
    Prism = "prism" {
        /// The number of sides.
        sides: f64, Count, Range::closed(3.0, 360.0), default 6.0;
        /// The distance of the corners from the axis, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.6;
        /// The full length along y, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        apothem: f64 = radius * (PI / sides).cos();
        half_side: f64 = radius * (PI / sides).sin();
    }
    source "Quilez, distance functions (hexagonal prism), for any number of sides; a distance, so its constant is 1"
    example "prism(6, 0.7, 1)"
}

impl Primitive for Prism {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (zero, step) = (N::splat(0.0), N::splat(TAU / self.sides));
        // The direction of the middle of the side that faces the point. Folded first: no jump behind the axis.
        let z = p.z.abs();
        let half = N::splat(0.5);
        let facing = ((z.atan2(p.x) / step).floor() + half) * step;
        let (sine, cosine) = facing.sin_cos();
        let side = p.x * cosine + z * sine - N::splat(self.apothem);
        let corner = (z * cosine - p.x * sine).abs() - N::splat(self.half_side);
        let cap = p.y.abs() - N::splat(0.5 * self.height);
        let outside = N::norm3(side.max(zero), corner.max(zero), cap.max(zero));
        let depth = side.max(cap);
        N::select_lt(zero, depth, outside, depth)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let corners = (0..self.sides as u32).map(|i| {
            let angle = TAU * f64::from(i) / self.sides;
            [
                self.radius * angle.cos(),
                0.5 * self.height,
                self.radius * angle.sin(),
            ]
        });
        let section = Bounds::around(corners);
        let low = [section.low[0], -0.5 * self.height, section.low[2]];
        Bounds::new(low, section.high).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [self.sides % 2.0 == 0.0, true, true],
            ..Traits::CONVEX
        }
    }
}
