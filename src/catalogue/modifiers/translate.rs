//! Translation.

use crate::catalogue::{Bounds, Modifier, Range, Similarity, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Moves a shape.
    Translate = "translate" {
        /// By how much along x, y and z, in scene units.
        by: [f64; 3], Vector3, Range::ANY;
    }
    source "an isometry keeps the constant (Hart 1996)"
    example "sphere(0.5).translate([0.5, 0, 0])"
}

impl Modifier for Translate {
    const RULE: &'static str = "an isometry keeps the constant (Hart 1996, section 3)";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(&(*p - Vec3::splat(self.by)))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        child(level).translate(self.by)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region.translate(self.by.map(|c| -c))
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        let is_symmetric = std::array::from_fn(|i| child.is_symmetric[i] && self.by[i] == 0.0);
        Traits {
            is_symmetric,
            ..*child
        }
    }

    fn similarity(&self) -> Option<Similarity> {
        Some(Similarity {
            shift: self.by.map(|c| -c),
            ..Similarity::IDENTITY
        })
    }
}
