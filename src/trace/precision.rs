//! Hart's sphere tracing of one field, all of it in numbers of a chosen precision: for studies of what f32 loses.
//!
//! Rays, distances along them, constants of shapes, tolerances and the field itself are rounded to the number; steps and ends
//! are those of `method/sphere.rs`, with the number's own rounding as the floor of the tolerance. Nothing is pruned and nothing
//! is compiled, so times say nothing here.

use super::part::unbounded;
use super::{Outcome, Ray, Verdict};
use crate::catalogue::Bounds;
use crate::num::{Number, Vec3};
use crate::scene::{Fault, Node, Settings};
use glam::DVec3;

/// A number that rays can be traced in.
pub trait Precision: Number + PartialOrd {
    /// The distance from 1 to the next larger number.
    const EPSILON: Self;

    /// The number as f64.
    fn wide(self) -> f64;
}

impl Precision for f64 {
    const EPSILON: Self = f64::EPSILON;

    fn wide(self) -> f64 {
        self
    }
}

impl Precision for f32 {
    const EPSILON: Self = f32::EPSILON;

    fn wide(self) -> f64 {
        f64::from(self)
    }
}

/// What Hart's method finds on each of these rays in numbers `N`, without normals. Where the constant holds within bounds
/// alone, rays are clipped to them.
///
/// # Errors
/// If the shape has no finite Lipschitz constant on its bounds.
pub fn sphere_traced<N: Precision>(
    node: &Node,
    settings: &Settings,
    rays: &[Ray],
) -> Result<Vec<Outcome>, Fault> {
    let is_endless = node.lipschitz_everywhere().is_finite();
    let region = if is_endless {
        Bounds::EVERYWHERE
    } else {
        node.bounds()
    };
    let lipschitz = node.lipschitz_over(region);
    if !lipschitz.is_finite() {
        return Err(unbounded(node));
    }
    let march = March::<N> {
        node,
        region,
        lipschitz: N::splat(lipschitz),
        size: if is_endless { 0.0 } else { region.radius() },
        is_endless,
        tolerance: N::splat(settings.tolerance),
        max_steps: settings.max_steps,
    };
    Ok(rays.iter().map(|ray| march.outcome(ray)).collect())
}

/// A field with what its walks have in common.
struct March<'a, N> {
    node: &'a Node,
    region: Bounds,
    lipschitz: N,
    size: f64,
    is_endless: bool,
    tolerance: N,
    max_steps: u32,
}

/// A ray in numbers `N`.
struct Beam<N> {
    origin: [N; 3],
    direction: [N; 3],
    footprint: [N; 2],
    /// The size of coordinates on the way.
    size: N,
}

impl<N: Precision> Beam<N> {
    fn at(&self, t: N) -> Vec3<N> {
        let [x, y, z] = [0, 1, 2].map(|i| self.origin[i] + self.direction[i] * t);
        Vec3::new(x, y, z)
    }

    /// How much of a distance at `t` may be rounding.
    fn noise(&self, t: N) -> N {
        N::splat(64.0) * N::EPSILON * (self.size + t)
    }
}

impl<N: Precision> March<'_, N> {
    fn outcome(&self, ray: &Ray) -> Outcome {
        let beam = Beam {
            origin: ray.origin.to_array().map(N::splat),
            direction: ray.direction.to_array().map(N::splat),
            footprint: [ray.footprint.at_origin, ray.footprint.spread].map(N::splat),
            size: N::splat(ray.origin.abs().max_element() + self.size),
        };
        let (verdict, t, steps) = match self.clipped(&beam, N::splat(ray.t_max)) {
            Some((start, end)) => self.walk(&beam, start, end),
            None => (Verdict::Miss, N::splat(f64::INFINITY), 0),
        };
        let point = beam.at(t);
        let is_hit = verdict == Verdict::Hit;
        Outcome {
            verdict,
            t: t.wide(),
            point: if is_hit {
                DVec3::new(point.x.wide(), point.y.wide(), point.z.wide())
            } else {
                DVec3::ZERO
            },
            steps,
            evaluations: steps,
            ..Outcome::NOTHING
        }
    }

    /// Where a ray is in the region, if it comes there.
    fn clipped(&self, beam: &Beam<N>, t_max: N) -> Option<(N, N)> {
        let (mut start, mut end) = (N::splat(0.0), t_max);
        for axis in 0..3 {
            let way = |bound: f64| (N::splat(bound) - beam.origin[axis]) / beam.direction[axis];
            let [a, b] = [self.region.low[axis], self.region.high[axis]].map(way);
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        (start <= end).then_some((start, end))
    }

    fn walk(&self, beam: &Beam<N>, start: N, end: N) -> (Verdict, N, u32) {
        let zero = N::splat(0.0);
        let far_away = N::splat((1u64 << 30) as f64);
        let (mut t, mut far) = (start, N::splat(f64::INFINITY));
        let mut has_departed = start > zero;
        for steps in 1.. {
            let distance = self.node.evaluate(&beam.at(t)).abs() / self.lipschitz;
            if steps == 1 && self.is_endless {
                far = beam.size.max(distance).max(beam.footprint[0]) * far_away;
            }
            let pixel = beam.footprint[0] + beam.footprint[1] * t;
            let epsilon = (self.tolerance * pixel).max(beam.noise(t));
            let is_near = distance < epsilon;
            if is_near && has_departed {
                return (Verdict::Hit, t, steps);
            }
            has_departed |= !is_near;
            if t > far {
                let has_left = distance * N::splat((1u64 << 20) as f64) >= t;
                let verdict = if has_left {
                    Verdict::Miss
                } else {
                    Verdict::Unknown
                };
                return (verdict, t, steps);
            }
            // What is not a number is no distance.
            let is_broken = distance.wide().is_nan();
            if is_broken || steps >= self.max_steps {
                return (Verdict::Unknown, t, steps);
            }
            t = t + if is_near { epsilon } else { distance };
            if t > end {
                return (Verdict::Miss, t, steps);
            }
        }
        unreachable!("steps run out")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Plane, Sphere, Torus, Translate, Twist};
    use crate::scene::Method;
    use crate::trace::{Footprint, Visibility, World, union};

    fn ring_and_ball() -> std::sync::Arc<Node> {
        let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(0.75, 0.25))).unwrap();
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(0.5))).unwrap();
        let shift = AnyModifier::Translate(Translate::new([1.0, 0.25, 0.5]));
        let ball = Node::modifier(shift, ball).unwrap();
        union(&[ring, ball]).unwrap()
    }

    fn rays(number: u32) -> Vec<Ray> {
        let ray = |i: u32| {
            let (x, y) = (
                f64::from(i % 24) / 12.0 - 1.0,
                f64::from(i / 24) / 12.0 - 0.5,
            );
            Ray {
                origin: DVec3::new(0.3, 0.6, 4.0),
                direction: DVec3::new(0.3 * x, 0.3 * y, -1.0).normalize(),
                t_max: f64::INFINITY,
                footprint: Footprint {
                    at_origin: 0.0,
                    spread: 0.01,
                },
            }
        };
        (0..number).map(ray).collect()
    }

    /// In f64 it is the method `sphere`, step for step.
    #[test]
    fn in_f64_it_is_the_method_of_that_name() {
        let (node, rays) = (ring_and_ball(), rays(300));
        let settings = Settings {
            method: Method::Sphere,
            ..Settings::default()
        };
        let world = World::unpruned(std::slice::from_ref(&node), &settings).unwrap();
        let expected = world.nearest(&rays, Visibility::All);
        let found = sphere_traced::<f64>(&node, &settings, &rays).unwrap();
        let mut hits = 0;
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.verdict, expected.verdict);
            assert_eq!(found.steps, expected.steps);
            if found.verdict == Verdict::Hit {
                assert_eq!(found.t, expected.t);
                hits += 1;
            }
        }
        assert!((50..250).contains(&hits), "{hits} hits");
    }

    /// A ball of radius 1 seen from 5 away along an axis, where a step lands on it: at t = 4 in every precision. Its distance
    /// to f32's nearest places is all that f32 adds.
    #[test]
    fn f32_is_off_by_its_rounding() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let settings = Settings {
            tolerance: 1e-9,
            ..Settings::default()
        };
        let mut ray = rays(1)[0];
        ray.origin = DVec3::new(0.3, 0.0, 5.0);
        ray.direction = DVec3::NEG_Z;
        let exact = 5.0 - (1.0f64 - 0.09).sqrt();
        let [wide] = sphere_traced::<f64>(&ball, &settings, &[ray]).unwrap()[..] else {
            panic!("one ray")
        };
        let [narrow] = sphere_traced::<f32>(&ball, &settings, &[ray]).unwrap()[..] else {
            panic!("one ray")
        };
        assert_eq!(wide.verdict, Verdict::Hit);
        assert_eq!(narrow.verdict, Verdict::Hit);
        let [wide, narrow] = [wide, narrow].map(|o| (o.t - exact).abs());
        let floor = |epsilon: f64| 64.0 * epsilon * (5.0 + 5.0);
        assert!(wide <= 1e-9, "{wide}");
        assert!(
            narrow > 1e-9 && narrow < 2.0 * floor(f32::EPSILON.into()),
            "{narrow}"
        );
    }

    /// A twisted plane is as steep as it is wide: it has no constant.
    #[test]
    fn what_has_no_constant_is_refused_as_by_the_world() {
        let plane = Node::primitive(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0))).unwrap();
        let sheet = Node::modifier(AnyModifier::Twist(Twist::new(1.0)), plane).unwrap();
        let settings = Settings::default();
        let fault = sphere_traced::<f64>(&sheet, &settings, &[]).unwrap_err();
        assert!(fault.message.contains("`twist` has no finite"), "{fault:?}");
        assert_eq!(Some(fault), World::of(&[sheet], &settings).err());
    }

    /// Half the largest f32 exponent is where squares of coordinates overflow: 2^70 is beyond it, and f32 sees nothing.
    #[test]
    fn f32_overflows_where_f64_does_not() {
        let big = (70f64).exp2();
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(big))).unwrap();
        let mut ray = rays(1)[0];
        ray.origin = DVec3::new(0.0, 0.0, 5.0 * big);
        ray.direction = DVec3::NEG_Z;
        let settings = Settings::default();
        let wide = sphere_traced::<f64>(&ball, &settings, &[ray]).unwrap();
        let narrow = sphere_traced::<f32>(&ball, &settings, &[ray]).unwrap();
        assert_eq!(wide[0].verdict, Verdict::Hit);
        assert_ne!(narrow[0].verdict, Verdict::Hit);
    }
}
