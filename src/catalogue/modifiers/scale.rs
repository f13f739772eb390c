//! Scaling.

use crate::catalogue::{Bounds, Modifier, Range, Similarity, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Makes a shape larger or smaller about the origin, by one factor or by one for each axis.
    Scale = "scale" {
        /// The factor, or the factors along x, y and z.
        factor: [f64; 3], Factors, Range::POSITIVE;
    }
    derived {
        inverse: [f64; 3] = factor.map(|f| 1.0 / f);
        smallest: f64 = factor.into_iter().fold(f64::INFINITY, f64::min);
    }
    source "s f(p / s) keeps the constant of f; along the axes, s is the smallest factor (deadsy/sdfx pull request 89)"
    example "sphere(0.5).scale([2, 1, 1])"
}

impl Scale {
    fn is_uniform(&self) -> bool {
        self.factor[0] == self.factor[1] && self.factor[1] == self.factor[2]
    }
}

impl Modifier for Scale {
    const RULE: &'static str = "s f(p / s) keeps the constant, with s the smallest factor: the matrix diag(1 / s) has norm \
         1 / min(s)";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(&p.times(Vec3::splat(self.inverse))) * N::splat(self.smallest)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        child(level / self.smallest).scale(self.factor)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region.scale(self.inverse)
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.is_uniform() || (child.is_planar && self.factor[0] == self.factor[1]) {
            return *child;
        }
        Traits {
            class: child.class.min(crate::catalogue::Class::Bound),
            ..*child
        }
    }

    fn similarity(&self) -> Option<Similarity> {
        let [x, y, z] = self.inverse;
        let rows = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        self.is_uniform().then_some(Similarity {
            rows,
            shift: [0.0; 3],
            scale: self.smallest,
        })
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        if child.is_planar {
            // The third factor has nothing to scale, and must not make the smallest smaller.
            let [x, y, _] = self.factor;
            *self = Self::new([x, y, x.max(y)]);
        }
        Ok(())
    }
}
