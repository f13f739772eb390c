//! Mirroring.

use crate::catalogue::{Axis, Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Makes a shape symmetric: keeps its half on the positive side of an axis and shows the mirror image on the other.
    Mirror = "mirror" {
        /// The axis across which the shape is mirrored.
        axis: Axis, Axis, Range::ANY;
    }
    source "a fold by a plane does not lengthen any segment, so it keeps the constant"
    example "sphere(0.4).translate([0.5, 0, 0]).mirror(\"x\")"
}

impl Modifier for Mirror {
    const RULE: &'static str = "a fold by a plane does not lengthen any segment";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let axis = self.axis.0;
        child(&p.with_component(axis, p.component(axis).abs()))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let axis = self.axis.0;
        let mut bounds = child(level);
        if bounds.is_empty() || bounds.high[axis] < 0.0 {
            return Bounds::EMPTY;
        }
        bounds.low[axis] = -bounds.high[axis];
        bounds
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let axis = self.axis.0;
        let mut folded = region;
        folded.low[axis] = if region.low[axis] > 0.0 {
            region.low[axis]
        } else {
            (-region.high[axis]).max(0.0)
        };
        folded.high[axis] = region.high[axis].max(-region.low[axis]);
        folded
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        let mut is_symmetric = child.is_symmetric;
        if is_symmetric[self.axis.0] {
            return *child;
        }
        is_symmetric[self.axis.0] = true;
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: false,
            is_symmetric,
            ..*child
        }
    }
}
