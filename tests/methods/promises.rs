//! Every method finds what the reference finds, within what it promises.

use super::{aimed, settings, shown};
use fieldstone::num::Vec3;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Outcome, Ray, Verdict, Visibility, World};
use glam::DVec3;
use std::sync::Arc;

const SCENES: [&str; 8] = [
    "show torus(0.7, 0.2).rotate(x: 50deg)",
    "show box([1, 0.8, 1.2]).rotate(y: 30deg) - sphere(0.5).translate([0.4, 0.3, 0.5])",
    "show union(sphere(0.5).translate([-0.4, 0, 0]), torus(0.7, 0.2), blend: smooth(0.3))",
    "show box([0.5, 1.6, 0.5]).twist(rate: 75deg)",
    "show gyroid(1.2).shell(0.03) & sphere(0.9)",
    "field bumpy(p) { return length(p) - 0.8 + 0.1 * sin(9 * p.x) * sin(9 * p.y) * sin(9 * p.z) } show bumpy",
    "show sphere(0.15).translate([0.07, 0, 0.02]).repeat(spacing: [0.5, 0.4, 0.5], count: [3, 2, 4])",
    "show sphere(0.5) show plane(\"y\", -0.5) show box(0.4).translate([0.6, 0.2, 0])",
];

/// What a method promises of the rays that it answers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Promise {
    /// Hits and misses are those of the reference, to within the stated error.
    Certified,
    /// Nothing is missed; a hit is before the surface, or less than epsilon from where the field is below lambda times
    /// epsilon.
    Near,
    /// The same, but a hit may also be where ranges cannot decide: on few rays, if the formula seldom jumps.
    Undecided,
    /// A hit is behind the surface by at most epsilon; a chord shorter than that may be missed.
    Inside,
}

fn promise(method: Method) -> Promise {
    match method {
        Method::Auto | Method::Certified | Method::Convex | Method::Probe | Method::Reference => {
            Promise::Certified
        }
        Method::Bisect => Promise::Inside,
        Method::Sphere
        | Method::Relaxed
        | Method::AutoRelaxed
        | Method::Enhanced
        | Method::Segment => Promise::Near,
        Method::Interval => Promise::Undecided,
    }
}

/// The field of everything shown, and its constant.
struct Field(Vec<Arc<Node>>);

impl Field {
    fn at(&self, p: DVec3) -> f64 {
        let values = self
            .0
            .iter()
            .map(|node| node.evaluate(&Vec3::splat(p.to_array())));
        values.fold(f64::INFINITY, f64::min)
    }

    fn lipschitz(&self) -> f64 {
        self.0
            .iter()
            .map(|node| node.lipschitz())
            .fold(1.0, f64::max)
    }
}

/// What is wrong with what a method found, measured by the reference.
fn broken(
    promise: Promise,
    field: &Field,
    ray: &Ray,
    found: &Outcome,
    truth: &Outcome,
) -> Option<String> {
    let epsilon = |t: f64| 0.1 * ray.footprint.at(t) + 1e-12;
    let near = || field.at(found.point).abs() <= field.lipschitz() * epsilon(found.t) * 2.01;
    let is_kept = match (promise, found.verdict, truth.verdict) {
        (_, Verdict::Unknown, _) | (_, _, Verdict::Unknown) => true,
        (_, Verdict::Miss, Verdict::Miss) => true,
        (Promise::Certified, Verdict::Hit, Verdict::Hit) => {
            (found.t - truth.t).abs() <= found.error + truth.error + 1e-12
        }
        (Promise::Near, Verdict::Hit, Verdict::Hit) => {
            found.t <= truth.t + epsilon(truth.t) && near()
        }
        (Promise::Near, Verdict::Hit, Verdict::Miss) => near(),
        (Promise::Undecided, Verdict::Hit, Verdict::Hit) => found.t <= truth.t + epsilon(truth.t),
        (Promise::Undecided, Verdict::Hit, Verdict::Miss) => true,
        (Promise::Inside, Verdict::Hit, Verdict::Hit) => {
            let is_short = |t: f64| field.at(ray.at(t + epsilon(t))) > 0.0;
            let off = found.t - truth.t;
            (-1e-12 <= off && off <= epsilon(found.t)) || is_short(truth.t)
        }
        (Promise::Inside, Verdict::Miss, Verdict::Hit) => {
            field.at(ray.at(truth.t + epsilon(truth.t))) > 0.0
        }
        _ => false,
    };
    (!is_kept).then(|| format!("{found:?}, truth {truth:?}"))
}

#[test]
fn every_method_keeps_its_promise() {
    let rays = aimed(600, 41);
    for script in SCENES {
        let nodes = shown(script);
        let by = |method: Method| {
            World::of(&nodes, &settings(method))
                .expect("a world")
                .nearest(&rays, Visibility::All)
        };
        let truths = by(Method::Reference);
        let hits = truths.iter().filter(|o| o.verdict == Verdict::Hit).count();
        let unknown = truths
            .iter()
            .filter(|o| o.verdict == Verdict::Unknown)
            .count();
        assert!(
            hits > 60 && unknown == 0,
            "{script}: {hits} hits, {unknown} unknown"
        );
        let field = Field(nodes.clone());
        for (name, method) in Method::ALL {
            let found = by(method);
            let (mut answers, mut early) = (0, 0);
            for (i, ray) in rays.iter().enumerate() {
                let wrong = broken(promise(method), &field, ray, &found[i], &truths[i]);
                assert_eq!(wrong, None, "{script}: {name}: ray {i}");
                answers += usize::from(found[i].verdict != Verdict::Unknown);
                let is_early = found[i].verdict == Verdict::Hit && found[i].t < truths[i].t - 0.01;
                early += usize::from(is_early);
            }
            // The promise is worth something only where there are answers.
            let least = if promise(method) == Promise::Certified {
                600
            } else {
                590
            };
            let most = if promise(method) == Promise::Undecided {
                60
            } else {
                12
            };
            assert!(
                early <= most,
                "{script}: {name} stops {early} of 600 rays early"
            );
            assert!(
                answers >= least,
                "{script}: {name} answers {answers} of 600 rays"
            );
        }
    }
}

#[test]
fn methods_do_not_depend_on_packing() {
    let nodes = shown(SCENES[2]);
    let rays = aimed(200, 43);
    for (name, method) in Method::ALL {
        let world = World::of(&nodes, &settings(method)).expect("a world");
        let together = world.nearest(&rays, Visibility::All);
        for (i, ray) in rays.iter().enumerate() {
            let alone = world.nearest(std::slice::from_ref(ray), Visibility::All)[0];
            assert_eq!(
                alone.t.to_bits(),
                together[i].t.to_bits(),
                "{name}: ray {i}"
            );
            // Which parts are asked first depends on the rays that are traced together, in lanes.
            if method != Method::Auto {
                assert_eq!(alone.steps, together[i].steps, "{name}: ray {i}");
            }
        }
    }
}

#[test]
fn names_of_methods_lead_back() {
    for (name, method) in Method::ALL {
        assert_eq!(
            (Method::from_name(name), method.name()),
            (Some(method), name)
        );
    }
    assert_eq!(Settings::default().method, Method::Auto);
}

/// What the default finds on one ray.
fn by_default(script: &str, origin: [f64; 3], direction: [f64; 3]) -> Outcome {
    super::traced(
        script,
        Settings::default(),
        &[super::ray(origin, direction)],
    )[0]
}

#[test]
fn rays_along_a_turned_face_are_decided() {
    // A box that is no convex shape, and a ray along its face, within and without.
    let script = "show (box(2) - sphere(0.1)).rotate(y: 32deg)";
    let (sine, cosine) = 32f64.to_radians().sin_cos();
    let turned = |x: f64, z: f64| [x * cosine + z * sine, 0.3, z * cosine - x * sine];
    let along = turned(1.0, 0.0);
    let along = [along[0], 0.0, along[2]];
    for exponent in [3, 6, 9, 12] {
        let gap = 10f64.powi(-exponent);
        let out = by_default(script, turned(-3.0, 1.0 + gap), along);
        assert_eq!(out.verdict, Verdict::Miss, "gap {gap}: {out:?}");
        let out = by_default(script, turned(-3.0, 1.0 - gap), along);
        assert!((out.t - 2.0).abs() < 1e-12, "depth {gap}: {out:?}");
    }
}

#[test]
fn rays_on_the_walls_of_a_repetition_are_decided() {
    // Between two columns of balls, where no range knows which cell it is in.
    let script = "show sphere(0.2).repeat([1, 0, 1], count: [2, 1, 40])";
    let out = by_default(script, [0.0, 0.0, 30.0], [0.0, 0.0, -1.0]);
    assert_eq!(out.verdict, Verdict::Miss, "{out:?}");
    let touching = "show sphere(0.5).repeat([1, 0, 1], count: [2, 1, 40]) | box(0.1)";
    let out = by_default(touching, [0.0, 0.0, 30.0], [0.0, 0.0, -1.0]);
    assert!((out.t - 29.95).abs() < 1e-9, "{out:?}");
}

#[test]
fn what_is_no_number_leaves_its_neighbours_alone() {
    let script =
        "field gap(p) lipschitz 1.1 { return p.y + 1e-3 * (sqrt(p.x - 100) - 10) } show gap";
    let nodes = shown(script);
    let rays: Vec<Ray> = (0..64)
        .map(|i| {
            super::ray(
                [if i % 3 == 0 { 0.0 } else { 200.0 }, 1.0, f64::from(i)],
                [0.0, -1.0, 0.0],
            )
        })
        .collect();
    for (name, method) in Method::ALL {
        let world = World::of(&nodes, &settings(method)).expect("a world");
        let found = world.nearest(&rays, Visibility::All);
        for (i, out) in found.iter().enumerate().filter(|(i, _)| i % 3 != 0) {
            assert!((out.t - 1.0).abs() < 1e-3, "{name}: ray {i}: {out:?}");
        }
        // Ranges say nothing of what is no number: interval analysis takes it for a surface.
        for (i, out) in found.iter().enumerate().filter(|(i, _)| i % 3 == 0) {
            let is_told = out.verdict == Verdict::Unknown || method == Method::Interval;
            assert!(is_told, "{name}: ray {i}: {out:?}");
        }
    }
}
