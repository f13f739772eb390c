//! Rotation.

use crate::catalogue::modifier::rotated;
use crate::catalogue::{Bounds, Kind, Modifier, Range, Similarity, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Turns a shape about the origin: by an angle about an axis, then about x, y and z in this order, each
    /// counter-clockwise as seen from the tip of the axis.
    Rotate = "rotate" {
        /// The angle about `axis`.
        angle: f64, Angle, Range::ANY, default 0.0;
        /// The axis of `angle`; its length does not matter.
        axis: [f64; 3], Direction, Range::ANY, default [0.0, 0.0, 1.0];
        /// The angle about the x axis.
        x: f64, Angle, Range::ANY, default 0.0;
        /// The angle about the y axis.
        y: f64, Angle, Range::ANY, default 0.0;
        /// The angle about the z axis.
        z: f64, Angle, Range::ANY, default 0.0;
    }
    derived {
        rows: [[f64; 3]; 3] = inverse_rotation(&[(axis, angle), (X, x), (Y, y), (Z, z)]);
    }
    source "an isometry keeps the constant (Hart 1996); matrix by Rodrigues' formula"
    example "box(0.8).rotate(y: 30deg)"
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Sine and cosine, exact at quarter turns.
pub(super) fn sin_cos(angle: f64) -> (f64, f64) {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    let nearest = quarters.round();
    if (quarters - nearest).abs() > 4.0 * f64::EPSILON * nearest.abs().max(1.0) {
        return (libm::sin(angle), libm::cos(angle));
    }
    match nearest.rem_euclid(4.0) as u8 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// The rows of the matrix that turns by `angle` about `axis`.
fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let length = axis.iter().fold(0.0, |n: f64, c| n.hypot(*c));
    let u = axis.map(|c| c / length);
    let (s, c) = sin_cos(angle);
    let cross = [[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if i == j && u[i].abs() == 1.0 {
                return 1.0; // what c + (1 - c) may miss
            }
            let identity = if i == j { c } else { 0.0 };
            identity + s * cross[i][j] + (1.0 - c) * u[i] * u[j]
        })
    })
}

/// The rows of the inverse of all turns done one after another: the transpose of their product.
fn inverse_rotation(turns: &[([f64; 3], f64)]) -> [[f64; 3]; 3] {
    let all = turns.iter().filter(|(_, angle)| *angle != 0.0).fold(
        Similarity::IDENTITY,
        |m, (axis, angle)| {
            m.then(&Similarity {
                rows: rotation(*axis, *angle),
                ..Similarity::IDENTITY
            })
        },
    );
    std::array::from_fn(|i| std::array::from_fn(|j| all.rows[j][i]))
}

impl Modifier for Rotate {
    const RULE: &'static str = "an isometry keeps the constant (Hart 1996, section 3)";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(&rotated(&self.rows, p))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let inverse = std::array::from_fn(|i| std::array::from_fn(|j| self.rows[j][i]));
        child(level).transform(&inverse)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region.transform(&self.rows)
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        // Quarter turns carry a symmetry over to the axis they bring it to; other angles lose it.
        let carried =
            |j: usize| (0..3).any(|i| self.rows[i][j].abs() == 1.0 && child.is_symmetric[i]);
        Traits {
            is_symmetric: [carried(0), carried(1), carried(2)],
            ..*child
        }
    }

    fn similarity(&self) -> Option<Similarity> {
        Some(Similarity {
            rows: self.rows,
            ..Similarity::IDENTITY
        })
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        let is_about_z = self.rows[2] == Z;
        if !child.is_planar || is_about_z {
            return Ok(());
        }
        let problem = "a profile can only turn in its plane, about the z axis".into();
        Err((
            problem,
            format!(
                "give {} alone, as in `rotate(45deg)`, or extrude it first",
                Kind::Angle.noun()
            ),
        ))
    }
}
