//! The rhombus.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A flat bar along the y axis whose section is a rhombus with its corners on the axes, rounded if wanted.
    Rhombus = "rhombus" {
        /// The full lengths of the diagonals along x and z, and of the height along y, in scene units.
        size: [f64; 3], Vector3, Range::POSITIVE, default [1.6, 0.4, 1.0];
        /// The radius of all edges; the sides stay where they are.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    derived {
        core: [f64; 2] = [0, 2].map(|i| 0.5 * size[i] * (1.0 - round / inner_radius(size)));
        edge: Edge = Edge::new([core[0], 0.0], [0.0, core[1]]);
    }
    source "Quilez, distance functions (rhombus); a distance, so its constant is 1"
    example "rhombus([1.6, 0.4, 1], round: 0.05).rotate(x: 30deg)"
}

/// The radius of the circle that touches the sides of the section.
fn inner_radius([x, _, z]: [f64; 3]) -> f64 {
    0.5 * x * (z / x.hypot(z))
}

impl Primitive for Rhombus {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let side = self.edge.distance(p.x.abs(), p.z.abs()).signed;
        let cap = p.y.abs() - N::splat(0.5 * self.size[1] - self.round);
        side.max(zero).hypot(cap.max(zero)) + side.max(cap).min(zero) - N::splat(self.round)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let [x, z] = self.core.map(|c| c + self.round);
        Bounds::centred([x, 0.5 * self.size[1], z]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let inner = inner_radius(self.size);
        if self.round >= inner {
            return Err((
                "round",
                format!("must be below {inner}, the distance of the sides from the axis"),
            ));
        }
        let most = 0.5 * self.size[1];
        if self.round > most {
            return Err(("round", format!("must be at most {most}, half the height")));
        }
        Ok(())
    }
}
