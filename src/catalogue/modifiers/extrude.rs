//! Extrusion.

use crate::catalogue::{Bounds, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Gives a profile thickness along z, half of it on each side.
    Extrude = "extrude" {
        /// The full thickness, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    source "Quilez, 2D to 3D (extrusion); the larger of the profile's constant and 1"
    example "circle(0.6).extrude(0.4)"
}

impl Modifier for Extrude {
    const RULE: &'static str =
        "the larger of the profile's constant and 1: two orthogonal slopes that are never added";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let zero = N::splat(0.0);
        let side = child(p);
        let cap = p.z.abs() - N::splat(0.5 * self.height);
        side.max(zero).hypot(cap.max(zero)) + side.max(cap).min(zero)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let half = 0.5 * self.height + level;
        let slab = Bounds::centred([f64::INFINITY, f64::INFINITY, half]);
        child(level).intersect(slab)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child.max(1.0)
    }

    fn traits(&self, child: &Traits) -> Traits {
        let [x, y, _] = child.is_symmetric;
        Traits {
            is_symmetric: [x, y, true],
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
