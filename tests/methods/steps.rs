//! Step counts against closed forms (f64: the same on every machine).
//!
//! A method that takes n steps looks n + 1 times, and counts its looks: the last one ends the walk.

use super::{ray, ray_of_pixel, settings, traced};
use fieldstone::scene::{Method, Settings};
use fieldstone::trace::{Outcome, Ray, Verdict};

const FLOOR: &str = "show plane(\"y\", 0)";

/// The tolerance in scene units, where the pixel is 1e-3 wide everywhere.
const EPSILON: f64 = 1e-4;

/// What a method finds on one ray, with as many steps as it likes.
fn walk(script: &str, method: Method, ray: Ray) -> Outcome {
    let settings = Settings {
        max_steps: 1_000_000,
        ..settings(method)
    };
    traced(script, settings, &[ray])[0]
}

/// A ray from height 1 down to the floor at an angle, in degrees, and the angle's sine.
fn grazing(degrees: f64) -> (Ray, f64) {
    let a = degrees.to_radians();
    let ray = ray_of_pixel([0.0, 1.0, 0.0], [a.cos(), -a.sin(), 0.0], 1e-3, 0.0);
    (ray, -ray.direction.y)
}

/// How many times 1 shrinks by `factor` until it is below `epsilon`.
fn shrinkings(epsilon: f64, factor: f64) -> u32 {
    (epsilon.ln() / factor.ln()).ceil() as u32
}

#[test]
fn sphere_tracing_shrinks_the_height_by_one_minus_the_sine() {
    for degrees in [60.0, 30.0, 10.0, 2.0, 1.0, 0.1, 0.01] {
        let (ray, sine) = grazing(degrees);
        let out = walk(FLOOR, Method::Sphere, ray);
        assert_eq!(out.verdict, Verdict::Hit);
        assert_eq!(
            out.steps,
            shrinkings(EPSILON, 1.0 - sine) + 1,
            "{degrees} degrees"
        );
    }
}

#[test]
fn sphere_tracing_by_default_settings_ends_by_the_pixel() {
    // The tolerance is kappa t, and t = (1 - height) / sine: the end is where height < kappa / (kappa + sine).
    let kappa = 0.1 * 1e-3;
    for degrees in [60.0f64, 30.0, 10.0, 2.0] {
        let a = degrees.to_radians();
        let ray = ray([0.0, 1.0, 0.0], [a.cos(), -a.sin(), 0.0]);
        let sine = -ray.direction.y;
        let out = traced(FLOOR, settings(Method::Sphere), &[ray])[0];
        let expected = shrinkings(kappa / (kappa + sine), 1.0 - sine);
        assert_eq!(out.steps, expected + 1, "{degrees} degrees");
    }
}

#[test]
fn relaxed_steps_shrink_the_height_by_omega() {
    // The balls of two places overlap where omega (1 + sine) <= 2: below 14 degrees for omega = 1.6, below 3 for 1.9.
    for (omega, degrees) in [
        (1.6, 10.0),
        (1.6, 2.0),
        (1.6, 1.0),
        (1.6, 0.1),
        (1.0, 2.0),
        (1.2, 10.0),
        (1.9, 2.0),
        (1.9, 0.1),
    ] {
        let (ray, sine) = grazing(degrees);
        let settings = Settings {
            omega,
            max_steps: 1_000_000,
            ..settings(Method::Relaxed)
        };
        let out = traced(FLOOR, settings, &[ray])[0];
        let expected = shrinkings(EPSILON, 1.0 - omega * sine) + 1;
        assert_eq!(out.steps, expected, "{degrees} degrees, omega {omega}");
    }
}

#[test]
fn enhanced_steps_follow_the_plane() {
    // The first step is Hart's; then the plane's slope is known, and the step is r (1 + 0.9 (1 - sine) / (1 + sine)).
    for degrees in [30.0, 10.0, 2.0, 1.0, 0.1] {
        let (ray, sine) = grazing(degrees);
        let out = walk(FLOOR, Method::Enhanced, ray);
        let factor = 1.0 - sine * (1.0 + 0.9 * (1.0 - sine) / (1.0 + sine));
        let expected = 1 + shrinkings(EPSILON / (1.0 - sine), factor);
        assert_eq!(out.steps, expected + 1, "{degrees} degrees");
    }
}

#[test]
fn automatic_relaxation_learns_the_slope_of_the_plane() {
    // With the slope known, heights shrink by (1 - sine) / (1 + sine). To learn it costs the sum of 0.7^k / (1 + 0.7^k),
    // 2.4 steps. A plane's balls just touch then, so about every hundred steps rounding parts them, and it is learnt anew.
    for degrees in [30.0, 10.0, 2.0, 1.0, 0.1] {
        let (ray, sine) = grazing(degrees);
        let out = walk(FLOOR, Method::AutoRelaxed, ray);
        let least = shrinkings(EPSILON, (1.0 - sine) / (1.0 + sine));
        assert!(
            (least..=least + 6 + least / 20).contains(&out.steps),
            "{degrees} degrees: {} of {least}",
            out.steps
        );
    }
}

#[test]
fn what_knows_the_slope_needs_no_steps_at_the_horizon() {
    for degrees in [60.0, 10.0, 1.0, 0.1, 0.01] {
        let (ray, sine) = grazing(degrees);
        for method in [Method::Convex, Method::Segment] {
            let out = walk(FLOOR, method, ray);
            let name = method.name();
            assert!(out.steps <= 3, "{name} at {degrees} degrees: {out:?}");
            assert!(
                (out.t * sine - 1.0).abs() < 1e-9,
                "{name} at {degrees} degrees: {out:?}"
            );
        }
    }
}

/// A ray past a sphere of radius 1, seen from a distance of 5, that ends 5 behind it, with a pixel that is nothing.
fn passing(height: f64) -> Ray {
    Ray {
        t_max: 10.0,
        ..ray_of_pixel([-5.0, height, 0.0], [1.0, 0.0, 0.0], 1e-12, 0.0)
    }
}

#[test]
fn near_misses_of_a_sphere_take_as_many_steps_as_the_root_of_the_clearance() {
    // Beside the sphere the field is clearance + x^2 / 2R: n = pi sqrt(2R / clearance), and up to three to come and go.
    for exponent in 1..=6 {
        let clearance = 10f64.powi(-exponent);
        let out = walk("show sphere(1)", Method::Sphere, passing(1.0 + clearance));
        let expected = std::f64::consts::PI * (2.0 / clearance).sqrt();
        assert_eq!(out.verdict, Verdict::Miss);
        let taken = f64::from(out.steps - 1);
        assert!(
            (taken - expected).abs() <= 3.0,
            "clearance {clearance}: {} steps, {expected}",
            out.steps
        );
    }
}

#[test]
fn head_on_one_step_lands_on_a_sphere() {
    for (radius, distance) in [(0.5, 3.0), (1.0, 9.0), (4.0, 1e3)] {
        let ray = ray_of_pixel([0.0, 0.0, -distance], [0.0, 0.0, 1.0], 1e-3, 0.0);
        let out = walk(&format!("show sphere({radius})"), Method::Sphere, ray);
        assert_eq!(
            (out.verdict, out.steps),
            (Verdict::Hit, 2),
            "radius {radius}"
        );
        assert_eq!(out.t, distance - radius);
    }
}

#[test]
fn near_misses_cost_the_convex_method_nothing() {
    for exponent in 1..=12 {
        let clearance = 10f64.powi(-exponent);
        let out = walk("show sphere(1)", Method::Convex, passing(1.0 + clearance));
        assert_eq!(out.verdict, Verdict::Miss);
        assert!(out.steps <= 60, "clearance {clearance}: {}", out.steps);
    }
}

#[test]
fn bisection_takes_about_the_steps_of_sphere_tracing() {
    // Algorithms A6: the two-sided test spends as many values as the one-sided, give or take a power of two.
    for exponent in 2..=5 {
        let clearance = 10f64.powi(-exponent);
        // Past the sphere, and yet through its box.
        let h = (1.0 + clearance) * 0.5f64.sqrt();
        let aside = Ray {
            t_max: 10.0,
            ..ray_of_pixel([-5.0, h, h], [1.0, 0.0, 0.0], 1e-12, 0.0)
        };
        let steps = |method| f64::from(walk("show sphere(1)", method, aside).steps);
        let ratio = steps(Method::Bisect) / steps(Method::Sphere);
        assert!(
            (0.5..=2.0).contains(&ratio),
            "clearance {clearance}: {ratio}"
        );
    }
}

#[test]
fn a_corridor_takes_length_over_width() {
    // Walls at y = +-h, the end at x = L: steps of h until the end is nearer.
    let script = "show plane([0, 1, 0], -0.01) | plane([0, -1, 0], -0.01) | plane([-1, 0, 0], -10)";
    let ray = ray_of_pixel([0.0; 3], [1.0, 0.0, 0.0], 1e-6, 0.0);
    // As one field: the parts of a hard union are traced one by one, and alone the end wall is a step away.
    let whole = "show (plane([0, 1, 0], -0.01) | plane([0, -1, 0], -0.01) | plane([-1, 0, 0], -10)).offset(0)";
    let out = walk(script, Method::Sphere, ray);
    assert_eq!((out.verdict, out.t), (Verdict::Hit, 10.0));
    let out = walk(whole, Method::Sphere, ray);
    assert_eq!(out.verdict, Verdict::Hit);
    // The last 0.01 takes one step more, give or take the rounding of a thousand sums.
    assert!((1000..=1002).contains(&out.steps), "{}", out.steps);
    let out = walk(whole, Method::Segment, ray);
    assert!(out.steps < 60 && (out.t - 10.0).abs() < 1e-6, "{out:?}");
}

#[test]
fn a_groove_shrinks_by_one_minus_the_sine_of_its_angle() {
    // Down the axis of a V between two planes at 20 degrees to it.
    let script = "show plane([-0.9396926207859084, 0.3420201433256687, 0], 0).offset(0) | \
                  plane([0.9396926207859084, 0.3420201433256687, 0], 0).offset(0)";
    let ray = ray_of_pixel([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 1e-3, 0.0);
    let out = walk(script, Method::Sphere, ray);
    assert_eq!(out.verdict, Verdict::Hit);
    let sine = 20f64.to_radians().sin();
    // The distance to both is the height times the sine; two parts, each walked to its end.
    let each = shrinkings(EPSILON / sine, 1.0 - sine) + 1;
    assert!(
        out.steps <= 2 * each && out.steps >= each,
        "{} of {each}",
        out.steps
    );
}

#[test]
fn a_gap_between_touching_spheres_takes_two_pi_over_its_height() {
    // Between two unit spheres that touch at the origin, at height y: the clearance is y^2 / 2R on both sides.
    let script = "show union(sphere(1).translate([0, 1, 0]), sphere(1).translate([0, -1, 0]))";
    let y = 1e-2;
    let aside = ray_of_pixel([-5.0, 0.0, y], [1.0, 0.0, 0.0], 1e-12, 0.0);
    let out = walk(
        script,
        Method::Sphere,
        Ray {
            t_max: 10.0,
            ..aside
        },
    );
    assert_eq!(out.verdict, Verdict::Miss);
    // The two spheres are two parts.
    let expected = 2.0 * 2.0 * std::f64::consts::PI / y;
    let ratio = f64::from(out.steps) / expected;
    assert!(
        (0.9..=1.1).contains(&ratio),
        "{} steps, {expected}",
        out.steps
    );
}
