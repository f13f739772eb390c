//! The star.

use crate::catalogue::plane_geometry::{Edge, Wedge, bounds_around};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

entry! {
    /// A star with straight edges around the origin of the plane; one tip is on the positive y axis.
    Star = "star" {
        /// How many tips, from 2 to 1000.
        points: f64, Count, Range::closed(2.0, 1000.0), default 5.0;
        /// The radius of the circle through the tips, in scene units.
        outer: f64, Number, Range::POSITIVE, default 0.9;
        /// The radius of the circle through the corners between them, at most that of the tips.
        inner: f64, Number, Range::POSITIVE, default 0.4;
    }
    derived {
        wedge: Wedge = Wedge::new(points);
        edge: Edge = Edge::new([outer, 0.0], polar(inner, PI / points));
    }
    source "Quilez, 2D distance functions (star), folded by mirrors; a distance, so its constant is 1"
    example "star(5, 0.9, 0.4).extrude(0.3)"
}

/// The point at a distance from the origin and an angle from the x axis.
fn polar(radius: f64, angle: f64) -> [f64; 2] {
    [radius * angle.cos(), radius * angle.sin()]
}

impl Primitive for Star {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (along, aside) = self.wedge.fold(p.x, p.y);
        self.edge.signed_distance(along, aside)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let corners: Vec<_> = (0..2 * self.points as u32)
            .map(|i| {
                let radius = if i % 2 == 0 { self.outer } else { self.inner };
                polar(radius, FRAC_PI_2 + PI * f64::from(i) / self.points)
            })
            .collect();
        bounds_around(&corners, level)
    }

    fn traits(&self) -> Traits {
        Traits {
            // The tip of a neighbour must not lie beyond the edge's line.
            is_convex: self.inner >= self.outer * (PI / self.points).cos(),
            is_symmetric: [true, self.points % 2.0 == 0.0, true],
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.inner <= self.outer {
            return Ok(());
        }
        Err((
            "inner",
            format!(
                "must be at most {}, the radius `outer` of the tips",
                self.outer
            ),
        ))
    }
}
