//! Elongation.

use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Makes a shape longer: cuts it at the origin, pulls the halves apart and fills the gap with what the cut shows.
    Elongate = "elongate" {
        /// How much longer along x, y and z, half of it on each side, in scene units.
        by: [f64; 3], Vector3, Range::NOT_NEGATIVE;
    }
    derived {
        half: [f64; 3] = by.map(|c| 0.5 * c);
    }
    source "Quilez, distance functions (elongation); p - clamp(p) does not lengthen any segment"
    example "torus(0.5, 0.2).elongate([0.8, 0.3, 0])"
}

/// `x` without what lies within `half` of 0.
#[inline(always)]
fn pulled<N: Number>(x: N, half: f64) -> N {
    x - x.clamp(N::splat(-half), N::splat(half))
}

impl Modifier for Elongate {
    const RULE: &'static str = "p - clamp(p) does not lengthen any segment";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let [x, y, z] = self.half;
        child(&Vec3::new(pulled(p.x, x), pulled(p.y, y), pulled(p.z, z)))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let mut bounds = child(level);
        if bounds.is_empty() {
            return bounds;
        }
        for (i, half) in self.half.into_iter().enumerate() {
            // A side that does not reach the cut moves away from it.
            bounds.low[i] += if bounds.low[i] > 0.0 { half } else { -half };
            bounds.high[i] += if bounds.high[i] < 0.0 { -half } else { half };
        }
        bounds
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let place = |i: usize, x: f64| x - x.clamp(-self.half[i], self.half[i]);
        Bounds::new(
            std::array::from_fn(|i| place(i, region.low[i])),
            std::array::from_fn(|i| place(i, region.high[i])),
        )
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.by == [0.0; 3] {
            return *child;
        }
        // A convex function that is the same on both sides of the cut grows away from it.
        let stays_convex = (0..3).all(|i| self.by[i] == 0.0 || child.is_symmetric[i]);
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: child.is_convex && stays_convex,
            ..*child
        }
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        if !child.is_planar || self.by[2] == 0.0 {
            return Ok(());
        }
        Err((
            "a profile has no length along z".into(),
            "give [x, y], or extrude it first".into(),
        ))
    }
}
