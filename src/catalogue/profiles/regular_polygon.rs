//! The regular polygon.

use crate::catalogue::plane_geometry::{Edge, Wedge, bounds_around};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

entry! {
    /// A polygon with equal sides and angles around the origin of the plane; one corner is on the positive y axis.
    RegularPolygon = "regular_polygon" {
        /// How many sides, from 3 to 1000.
        sides: f64, Count, Range::closed(3.0, 1000.0), default 6.0;
        /// The radius of the circle through the corners, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.8;
    }
    derived {
        wedge: Wedge = Wedge::new(sides);
        half: Edge = half_side(sides, radius);
    }
    source "Quilez, 2D distance functions (hexagon), folded by mirrors; a distance, so its constant is 1"
    example "regular_polygon(6, 0.8).extrude(0.4)"
}

/// From a corner on the x axis to the middle of a side.
fn half_side(sides: f64, radius: f64) -> Edge {
    let (sin, cos) = (PI / sides).sin_cos();
    Edge::new([radius, 0.0], [radius * cos * cos, radius * cos * sin])
}

impl Primitive for RegularPolygon {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (along, aside) = self.wedge.fold(p.x, p.y);
        self.half.signed_distance(along, aside)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let corners: Vec<_> = (0..self.sides as u32)
            .map(|i| {
                let angle = FRAC_PI_2 + TAU * f64::from(i) / self.sides;
                [self.radius * angle.cos(), self.radius * angle.sin()]
            })
            .collect();
        bounds_around(&corners, level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            is_symmetric: [true, self.sides % 2.0 == 0.0, true],
            ..Traits::EXACT
        }
        .planar()
    }
}
