//! The moon.

use crate::catalogue::plane_geometry::bounds_around;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A disc around the origin of the plane without what another disc, further along x, has in common with it.
    Moon = "moon" {
        /// The radius of the disc, in scene units.
        outer: f64, Number, Range::POSITIVE, default 0.8;
        /// The radius of the disc that is taken away, in scene units.
        inner: f64, Number, Range::POSITIVE, default 0.65;
        /// The distance between the centres.
        distance: f64, Number, Range::POSITIVE, default 0.4;
    }
    derived {
        horn: Option<[f64; 2]> = horn(outer, inner, distance);
    }
    source "Quilez, 2D distance functions (moon); a distance, so its constant is 1"
    example "moon(0.8, 0.65, 0.4).extrude(0.3)"
}

/// Where the circles cross, above the x axis.
fn horn(outer: f64, inner: f64, distance: f64) -> Option<[f64; 2]> {
    let x = 0.5 * (distance + (outer - inner) * (outer + inner) / distance);
    (x.abs() < outer).then(|| [x, ((outer - x) * (outer + x)).sqrt()])
}

impl Primitive for Moon {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (x, y) = (p.x, p.y.abs());
        let d = N::splat(self.distance);
        let disc = x.hypot(y) - N::splat(self.outer);
        let hole = N::splat(self.inner) - (x - d).hypot(y);
        let body = disc.max(hole);
        let Some([a, b]) = self.horn else {
            return body;
        };
        let (u, v) = (x - N::splat(a), y - N::splat(b));
        // Between the normals of both circles at the horn.
        let past_disc = x * N::splat(b) - y * N::splat(a);
        let past_hole = u * N::splat(b) - v * (N::splat(a) - d);
        let past = past_disc.min(past_hole);
        N::select_lt(N::splat(0.0), past, u.hypot(v), body)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = self.outer;
        let [x, y] = match self.horn {
            Some([x, y]) => [x, if x < 0.0 { y } else { r }],
            None => [r, r],
        };
        bounds_around(&[[-r, -y], [x, y]], level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [false, true, true],
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = self.outer + self.distance;
        if self.inner < most {
            return Ok(());
        }
        Err((
            "inner",
            format!(
                "must be less than {most}, the sum of `outer` and `distance`, or nothing is left"
            ),
        ))
    }
}
