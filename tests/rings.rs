//! Tori: what is found in closed form must be what the reference finds, which knows nothing but the field, and what geometry
//! says where that is simple.

mod rays;
mod solids;

use fieldstone::catalogue::*;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Footprint, Ray, Verdict, Visibility, World};
use glam::{DQuat, DVec3};
use rays::{aimed, ray};
use solids::{agree, found, modified, number};
use std::sync::Arc;

/// A torus with its place: the place of the origin, and a turn.
struct Placed {
    major: f64,
    minor: f64,
    turn: DQuat,
    place: DVec3,
}

impl Placed {
    /// A torus of some thickness, turned and moved.
    fn some(seed: u64) -> Self {
        let x = |k: u64| number(seed, k);
        // Thin ones, ordinary ones, some that nearly close their holes, and some without a hole.
        let thickness = match seed % 8 {
            0 => 0.002 + 0.02 * x(0),
            1 => 1.0 - 1e-3 * x(0).powi(4),
            2 => 1.0 + 0.8 * x(0),
            3 => 1.0,
            _ => 0.05 + 0.9 * x(0),
        };
        let major = 0.3 + 0.6 * x(1);
        let axis = DVec3::new(x(2) - 0.5, x(3) - 0.5, x(4) - 0.5).normalize();
        Self {
            major,
            minor: major * thickness,
            turn: DQuat::from_axis_angle(axis, 6.0 * x(5)),
            place: DVec3::new(x(6) - 0.5, x(7) - 0.5, x(8) - 0.5),
        }
    }

    fn node(&self) -> Arc<Node> {
        let torus = Torus::new(self.major, self.minor);
        let (axis, angle) = self.turn.to_axis_angle();
        let turn = Rotate::new(angle, axis.to_array(), 0.0, 0.0, 0.0);
        let node = Node::primitive(AnyPrimitive::Torus(torus)).expect("a torus");
        let node = modified(AnyModifier::Rotate(turn), node);
        let shift = Translate::new(self.place.to_array());
        modified(AnyModifier::Translate(shift), node)
    }

    /// A point in the torus's own coordinates as seen from outside.
    fn outside(&self, p: DVec3) -> DVec3 {
        self.turn * p + self.place
    }

    /// A ray in the torus's own coordinates as seen from outside.
    fn ray(&self, origin: DVec3, direction: DVec3) -> Ray {
        let direction = self.turn * direction;
        ray(self.outside(origin).to_array(), direction.to_array())
    }

    /// A point of its surface by two angles, and the normal there.
    fn surface(&self, around: f64, about: f64) -> (DVec3, DVec3) {
        let out = DVec3::new(around.cos(), 0.0, around.sin());
        let normal = out * about.cos() + DVec3::Y * about.sin();
        (out * self.major + normal * self.minor, normal)
    }
}

/// Holds what `auto` finds against the reference; gives how many hits there were, and how often it asked the field.
fn compare(what: &str, node: &Arc<Node>, rays: &[Ray]) -> (u64, u64) {
    agree(what, node, rays, |a, b, what| {
        assert!((a.t - b.t).abs() <= a.error + b.error, "{what}");
        assert!(a.normal.dot(b.normal) > 1.0 - 1e-9, "{what}");
    })
}

fn box_point(seed: u64, k: u64) -> DVec3 {
    let x = |axis: u64| 2.0 * number(seed + 99, 8 * k + axis) - 1.0;
    DVec3::new(x(0), x(1), x(2))
}

#[test]
fn rays_in_all_directions_find_what_the_reference_finds() {
    let (mut hits, mut asked) = (0, 0);
    for seed in 0..120u64 {
        let torus = Placed::some(seed);
        let reach = torus.major + torus.minor;
        let some = |k: u64| match k % 4 {
            // From near by, often from inside.
            0 => torus.ray(box_point(seed, k) * reach, box_point(seed, k + 50)),
            // Towards the tube.
            1 => {
                let angle = 6.3 * number(seed, 100 + k);
                let target = torus.surface(angle, 0.0).0 + box_point(seed, k) * torus.minor;
                let origin = box_point(seed, k + 50).normalize() * 3.0;
                torus.ray(origin, target - origin)
            }
            // From inside of the tube.
            2 => {
                let (p, n) =
                    torus.surface(6.3 * number(seed, 100 + k), 6.3 * number(seed, 200 + k));
                torus.ray(
                    p - n * (torus.minor * number(seed, 300 + k)),
                    box_point(seed, k),
                )
            }
            // Through the middle.
            _ => {
                let origin = box_point(seed, k + 50).normalize() * 3.0;
                torus.ray(origin, box_point(seed, k) * torus.major - origin)
            }
        };
        let rays: Vec<Ray> = (0..48).map(some).collect();
        let counts = compare(&format!("seed {seed}"), &torus.node(), &rays);
        hits += counts.0;
        // A wide tube is left from inside by its field.
        asked += if torus.minor > torus.major {
            0
        } else {
            counts.1
        };
    }
    assert!(hits > 2500, "{hits}");
    assert!(
        asked < hits / 4,
        "fields are asked: {asked} times, {hits} hits"
    );
}

#[test]
fn tangent_rays_are_decided_as_by_the_reference() {
    let mut hits = 0;
    for seed in 0..80u64 {
        let torus = Placed::some(seed);
        let some = |k: u64| {
            let (p, n) = torus.surface(6.3 * number(seed, k), 6.3 * number(seed, 100 + k));
            let aside = n.cross(box_point(seed, k)).normalize();
            // Beside the surface by much, little, or nothing.
            let gap = [0.0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-6, 1e-3][k as usize % 7];
            let side = if number(seed, 200 + k) < 0.5 {
                1.0
            } else {
                -1.0
            };
            torus.ray(p + n * (gap * side) - aside * 2.5, aside)
        };
        let rays: Vec<Ray> = (0..28).map(some).collect();
        // What lies beside the surface by less than rounding is a hit for one and a miss for the other.
        let is_clear = |k: &usize| k % 7 > 2;
        let clear: Vec<Ray> = (0..rays.len()).filter(is_clear).map(|k| rays[k]).collect();
        hits += compare(&format!("seed {seed}"), &torus.node(), &clear).0;
        for outcome in found(&torus.node(), Method::Auto, &rays) {
            assert_ne!(
                outcome.verdict,
                Verdict::Unknown,
                "seed {seed}: {outcome:?}"
            );
        }
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn what_leaves_a_ring_does_not_meet_it_where_it_starts() {
    for seed in 0..80u64 {
        let torus = Placed::some(seed);
        let node = torus.node();
        for k in 0..24 {
            let (p, n) = torus.surface(6.3 * number(seed, k), 6.3 * number(seed, 100 + k));
            let direction = box_point(seed, k).normalize();
            let slope = direction.dot(n);
            if slope.abs() < 1e-3 {
                continue;
            }
            // As exact as numbers are, on the surface; what goes in comes out, what leaves may come back.
            let away = torus.ray(p, direction);
            let [auto, reference] = [Method::Auto, Method::Reference]
                .map(|method| found(&node, method, std::slice::from_ref(&away))[0]);
            let what = format!("seed {seed}, {away:?}: {auto:?}, {reference:?}");
            if torus.minor < 0.99 * torus.major {
                assert!(auto.verdict != Verdict::Hit || auto.t > 1e-12, "{what}");
                assert!(slope > 0.0 || auto.verdict == Verdict::Hit, "{what}");
            }
            if reference.verdict != Verdict::Unknown {
                assert_eq!(auto.verdict, reference.verdict, "{what}");
                let is_near = (auto.t - reference.t).abs() <= auto.error + reference.error;
                assert!(auto.verdict != Verdict::Hit || is_near, "{what}");
            }
        }
    }
}

/// Where rays in the plane of the ring, along its axis, and straight at the tube meet it.
#[test]
fn simple_rays_hit_where_geometry_says() {
    for exponent in [-300, -60, -20, 0, 3, 20, 60] {
        let scale = 2f64.powi(exponent);
        let (major, minor) = (0.75 * scale, 0.25 * scale);
        let node = Node::primitive(AnyPrimitive::Torus(Torus::new(major, minor))).expect("a torus");
        let hit = |origin: [f64; 3], direction: [f64; 3]| {
            let ray = Ray {
                footprint: Footprint {
                    at_origin: 0.0,
                    spread: 1e-3,
                },
                ..ray(origin.map(|x| x * scale), direction)
            };
            found(&node, Method::Auto, &[ray])[0]
        };
        let cases = [
            // In the plane: from outside, from the middle, from inside of the tube, and back into it.
            ([3.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 2.0),
            ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 0.5),
            ([0.75, 0.0, 0.0], [1.0, 0.0, 0.0], 0.25),
            ([0.75, 0.0, 0.0], [-1.0, 0.0, 0.0], 0.25),
            ([0.5, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0),
            ([0.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5),
            // Across it, from above the middle of the tube and from within.
            ([0.75, 4.0, 0.0], [0.0, -1.0, 0.0], 3.75),
            ([0.0, -4.0, 0.75], [0.0, 1.0, 0.0], 3.75),
            ([0.0, 0.0, 0.75], [0.0, 1.0, 0.0], 0.25),
            // Slanting, where 3 : 4 : 5 makes it rational: 0.6 x 0.25 off the middle of the tube.
            ([0.9, 4.0, 0.0], [0.0, -1.0, 0.0], 3.8),
            ([0.6, 4.0, 0.0], [0.0, -1.0, 0.0], 3.8),
        ];
        for (origin, direction, t) in cases {
            let out = hit(origin, direction);
            let what = format!("2^{exponent}, {origin:?}, {direction:?}: {out:?}");
            assert_eq!(out.verdict, Verdict::Hit, "{what}");
            assert!((out.t / scale - t).abs() <= 1e-14 * t.max(1.0), "{what}");
            assert!(out.error <= 1e-11 * scale, "{what}");
            assert_eq!(out.evaluations, 0, "{what}");
        }
        // Along the axis, beside it within the hole, above, beside, and away.
        for (origin, direction) in [
            ([0.0, 4.0, 0.0], [0.0, -1.0, 0.0]),
            ([0.3, 4.0, 0.3], [0.0, -1.0, 0.0]),
            ([3.0, 0.251, 0.1], [-1.0, 0.0, 0.0]),
            ([1.001, 4.0, 0.0], [0.0, -1.0, 0.0]),
            ([3.0, 0.0, 1.001], [-1.0, 0.0, 0.0]),
            ([3.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ] {
            let out = hit(origin, direction);
            let what = format!("2^{exponent}, {origin:?}, {direction:?}: {out:?}");
            assert_eq!(out.verdict, Verdict::Miss, "{what}");
        }
    }
}

/// Hits have the same bits whatever rays go along, also those of shadow rays.
#[test]
fn hits_do_not_depend_on_other_rays() {
    for seed in 0..20u64 {
        let torus = Placed::some(seed);
        let node = torus.node();
        let rays = aimed(300, seed << 20);
        let settings = Settings::default();
        let world = World::of(std::slice::from_ref(&node), &settings).expect("a world");
        let together = world.nearest(&rays, Visibility::All);
        let shadows = world.occluded(&rays);
        for ((ray, hit), shadow) in rays.iter().zip(&together).zip(&shadows) {
            let alone = world.nearest(std::slice::from_ref(ray), Visibility::All)[0];
            assert_eq!(alone.verdict, hit.verdict, "seed {seed}, {ray:?}");
            assert_eq!(alone.t.to_bits(), hit.t.to_bits(), "seed {seed}, {ray:?}");
            assert_eq!(alone.normal, hit.normal, "seed {seed}, {ray:?}");
            assert_eq!(shadow.verdict, hit.verdict, "seed {seed}, {ray:?}");
        }
    }
}

/// From so far away that rounding decides more and more.
#[test]
fn far_eyes_see_what_the_reference_sees() {
    for (distance, seed) in [(1e2, 1), (1e3, 2), (1e4, 3), (1e5, 4), (1e6, 5)] {
        let torus = Placed::some(8 + 4 * seed);
        let some = |k: u64| {
            let origin = box_point(seed, k).normalize() * distance;
            let (p, n) = torus.surface(6.3 * number(seed, k), 6.3 * number(seed, 100 + k));
            // Well into the tube, or well past it.
            let target = p + n * (torus.minor * if k.is_multiple_of(2) { -0.5 } else { 0.5 });
            torus.ray(origin, target - origin)
        };
        let rays: Vec<Ray> = (0..40).map(some).collect();
        compare(&format!("from {distance}"), &torus.node(), &rays);
    }
}
