//! Shear.

use super::sweep::largest_stretch;
use crate::catalogue::{AXES, Axis, Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Makes a shape lean: moves every point along a vector, as many times as it lies scene units up an axis.
    Shear = "shear" {
        /// How far points move along x, y and z for each scene unit up `axis`; nothing along the axis itself.
        by: [f64; 3], Vector3, Range::ANY;
        /// The axis that tells how far.
        axis: Axis, Axis, Range::ANY, default Axis(1);
    }
    derived {
        rows: [[f64; 3]; 3] = shear(by, axis.0, -1.0);
        shrink: f64 = 1.0 / largest_stretch(1.0, by[0].hypot(by[1]).hypot(by[2]));
    }
    source "f(M p) / |M| keeps the constant of f; |M| = s/2 + sqrt(1 + s^2/4) is the largest singular value of a shear by s"
    example "box([0.8, 1, 0.8]).shear([0.5, 0, 0])"
}

/// The rows of the matrix that adds `sign` times `by` for each unit along `axis`.
fn shear(by: [f64; 3], axis: usize, sign: f64) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let identity = if i == j { 1.0 } else { 0.0 };
            identity + if j == axis { sign * by[i] } else { 0.0 }
        })
    })
}

impl Modifier for Shear {
    const RULE: &'static str =
        "f(M p) / |M| keeps the constant, with |M| the largest singular value of the matrix";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let up = p.component(self.axis.0);
        let moved = Vec3::splat(self.by) * up;
        child(&(*p - moved)) * N::splat(self.shrink)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        child(level / self.shrink).transform(&shear(self.by, self.axis.0, 1.0))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region.transform(&self.rows)
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.by == [0.0; 3] {
            return *child;
        }
        let stays = |i: usize| i != self.axis.0 && self.by[i] == 0.0;
        Traits {
            class: child.class.min(Class::Bound),
            is_symmetric: std::array::from_fn(|i| child.is_symmetric[i] && stays(i)),
            ..*child
        }
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        if !child.is_planar || (self.axis.0 != 2 && self.by[2] == 0.0) {
            return Ok(());
        }
        Err((
            "a profile can only lean in its plane".into(),
            "give [x, y] and the axis \"x\" or \"y\", or extrude it first".into(),
        ))
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let axis = self.axis.0;
        if self.by[axis] == 0.0 {
            return Ok(());
        }
        let name = AXES[axis];
        Err(("by", format!("must be 0 along {name}, the axis itself")))
    }
}
