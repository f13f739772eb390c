//! The reference against closed forms.

use super::{aimed, settings, traced};
use fieldstone::scene::Method;
use fieldstone::trace::{Ray, Verdict};
use glam::DVec3;

/// How far the reference may be off, in scene units; distances are about 3.
const CLOSE: f64 = 1e-12;

/// The smallest root in front of the origin, with how steeply it is crossed; rays that meet nothing, or cross so flatly that
/// the root itself is ill-conditioned, are told apart.
enum Expected {
    Hit(f64),
    Miss,
    Flat,
}

/// Compares the reference on random rays with a closed form; at least a quarter of the rays have to hit.
fn agrees(script: &str, closed_form: impl Fn(&Ray) -> Expected) {
    let rays = aimed(2000, 5);
    let found = traced(script, settings(Method::Reference), &rays);
    let (mut hits, mut worst) = (0, 0.0f64);
    for (i, (ray, out)) in rays.iter().zip(&found).enumerate() {
        match closed_form(ray) {
            Expected::Hit(t) => {
                assert_eq!(
                    out.verdict,
                    Verdict::Hit,
                    "{script}: ray {i}: {out:?}, expected {t}"
                );
                worst = worst.max((out.t - t).abs());
                hits += 1;
            }
            Expected::Miss => assert_eq!(out.verdict, Verdict::Miss, "{script}: ray {i}: {out:?}"),
            Expected::Flat => {}
        }
    }
    assert!(hits > 500, "{script}: {hits} hits");
    assert!(worst <= CLOSE, "{script}: off by {worst:e}");
}

/// The first of some roots in front of the origin.
fn first(roots: &[f64]) -> Expected {
    let ahead = roots.iter().copied().filter(|t| *t > 0.0);
    match ahead.min_by(f64::total_cmp) {
        Some(t) => Expected::Hit(t),
        None => Expected::Miss,
    }
}

/// The roots of a t^2 + 2 b t + c, unless they nearly coincide.
fn quadratic(a: f64, b: f64, c: f64) -> Option<Vec<f64>> {
    let discriminant = b * b - a * c;
    if discriminant.abs() < 1e-3 * b.abs().max(1.0) {
        return None;
    }
    if discriminant < 0.0 {
        return Some(Vec::new());
    }
    let large = -b - discriminant.sqrt().copysign(b);
    Some(vec![large / a, c / large])
}

#[test]
fn reference_meets_the_sphere() {
    agrees("show sphere(0.8).translate([0.1, -0.2, 0.05])", |ray| {
        let q = ray.origin - DVec3::new(0.1, -0.2, 0.05);
        let roots = quadratic(1.0, q.dot(ray.direction), q.length_squared() - 0.64);
        roots.map_or(Expected::Flat, |roots| first(&roots))
    });
}

#[test]
fn reference_meets_the_plane() {
    agrees("show plane([1, 2, -2], 0.25)", |ray| {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let (height, slope) = (normal.dot(ray.origin) - 0.25, normal.dot(ray.direction));
        if slope.abs() < 1e-2 {
            return Expected::Flat;
        }
        first(&[-height / slope])
    });
}

#[test]
fn reference_meets_the_triangle() {
    let corners = [[-0.9, -0.7, 0.1], [1.0, -0.5, -0.3], [0.1, 1.1, 0.2]].map(DVec3::from_array);
    let script = "show triangle([-0.9, -0.7, 0.1], [1, -0.5, -0.3], [0.1, 1.1, 0.2])";
    // Moeller and Trumbore 1997.
    agrees(script, |ray| {
        let [a, b, c] = corners;
        let (u, v) = (b - a, c - a);
        let p = ray.direction.cross(v);
        let determinant = u.dot(p);
        let s = (ray.origin - a) / determinant;
        let (beta, gamma) = (s.dot(p), ray.direction.dot(s.cross(u)));
        let margin = beta.min(gamma).min(1.0 - beta - gamma);
        if margin.abs() < 1e-3 || determinant.abs() < 1e-1 {
            return Expected::Flat;
        }
        if margin < 0.0 {
            return Expected::Miss;
        }
        first(&[v.dot(s.cross(u))])
    });
}

/// Where a line is inside of |x_i| < h on the axes that have an h.
fn slabs(ray: &Ray, half: [Option<f64>; 3]) -> (f64, f64) {
    let axes = (0..3).filter_map(|i| half[i].map(|h| (ray.origin[i], ray.direction[i], h)));
    axes.fold(
        (f64::NEG_INFINITY, f64::INFINITY),
        |(low, high), (o, d, h)| {
            let (a, b) = ((-h - o) / d, (h - o) / d);
            (low.max(a.min(b)), high.min(a.max(b)))
        },
    )
}

/// The entry of a convex solid, unless the ray only grazes it.
fn entry((enter, leave): (f64, f64)) -> Expected {
    if (leave - enter).abs() < 1e-3 {
        Expected::Flat
    } else if leave < enter {
        Expected::Miss
    } else {
        first(&[enter])
    }
}

#[test]
fn reference_meets_the_box() {
    agrees("show box([1.2, 0.8, 1.6])", |ray| {
        entry(slabs(ray, [Some(0.6), Some(0.4), Some(0.8)]))
    });
}

#[test]
fn reference_meets_the_cylinder() {
    agrees("show cylinder(0.6, 1.4)", |ray| {
        let flat = |v: DVec3| DVec3::new(v.x, 0.0, v.z);
        let (o, d) = (flat(ray.origin), flat(ray.direction));
        let Some(side) = quadratic(d.length_squared(), o.dot(d), o.length_squared() - 0.36) else {
            return Expected::Flat;
        };
        let caps = slabs(ray, [None, Some(0.7), None]);
        match side[..] {
            [a, b] => entry((caps.0.max(a.min(b)), caps.1.min(a.max(b)))),
            _ => Expected::Miss,
        }
    });
}

/// The real roots of a polynomial with coefficients from the lowest up: between the roots of its derivative it is monotone.
fn roots(coefficients: &[f64]) -> Vec<f64> {
    let value = |t: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let degree = coefficients.len() - 1;
    if degree == 0 {
        return Vec::new();
    }
    let derivative: Vec<f64> = (1..=degree).map(|i| i as f64 * coefficients[i]).collect();
    let mut ends = vec![-100.0];
    ends.extend(roots(&derivative));
    ends.push(100.0);
    let mut found = Vec::new();
    for pair in ends.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        if (value(low) < 0.0) == (value(high) < 0.0) {
            continue;
        }
        let falls = value(low) > 0.0;
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (value(middle) > 0.0) == falls {
                low = middle;
            } else {
                high = middle;
            }
        }
        found.push(0.5 * (low + high));
    }
    found
}

#[test]
fn reference_meets_the_torus_quartic() {
    let (major, minor) = (0.7, 0.3);
    agrees("show torus(0.7, 0.3)", |ray| {
        // From the point nearest to the centre, so that the coefficients do not cancel: with s = |p|^2 + R^2 - r^2,
        // s^2 = 4 R^2 (x^2 + z^2).
        let start = -ray.origin.dot(ray.direction);
        let (o, d) = (ray.at(start), ray.direction);
        let k = o.length_squared() + major * major - minor * minor;
        let scale = 4.0 * major * major;
        let (oo, od, dd) = (
            o.x * o.x + o.z * o.z,
            o.x * d.x + o.z * d.z,
            d.x * d.x + d.z * d.z,
        );
        let b = o.dot(d);
        let quartic = [
            k * k - scale * oo,
            4.0 * k * b - 2.0 * scale * od,
            2.0 * k + 4.0 * b * b - scale * dd,
            4.0 * b,
            1.0,
        ];
        let slope = |t: f64| {
            (1..5)
                .rev()
                .fold(0.0, |sum, i| sum * t + i as f64 * quartic[i])
        };
        let value = |t: f64| quartic.iter().rev().fold(0.0, |sum, c| sum * t + c);
        let found = roots(&quartic);
        // Where the derivative vanishes close to zero, the line is nearly tangent.
        let derivative: Vec<f64> = (1..5).map(|i| i as f64 * quartic[i]).collect();
        let is_tangent = roots(&derivative).iter().any(|t| value(*t).abs() < 1e-3);
        if is_tangent || found.iter().any(|t| slope(*t).abs() < 1e-1) {
            return Expected::Flat;
        }
        let ahead: Vec<f64> = found.iter().map(|t| t + start).collect();
        first(&ahead)
    });
}

#[test]
fn reference_tells_a_touch_from_a_hit() {
    let one = |script: &str, origin: [f64; 3], direction: [f64; 3]| {
        traced(
            script,
            settings(Method::Reference),
            &[super::ray(origin, direction)],
        )[0]
    };
    // The common face of a box and what is cut from it.
    let cut = "show box(2) - box([1, 2, 2]).translate([0.5, 0, 0])";
    assert_eq!(
        one(cut, [0.5, 5.0, 0.0], [0.0, -1.0, 0.0]).verdict,
        Verdict::Miss
    );
    assert_eq!(one(cut, [-0.5, 5.0, 0.0], [0.0, -1.0, 0.0]).t, 4.0);
    // Clearances and chords of a sphere down to 1e-12.
    for exponent in 1..=12 {
        let depth = 10f64.powi(-exponent);
        let out = one("show sphere(1)", [-5.0, 1.0 + depth, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(out.verdict, Verdict::Miss, "clearance {depth}");
        let out = one("show sphere(1)", [-5.0, 1.0 - depth, 0.0], [1.0, 0.0, 0.0]);
        let expected = 5.0 - (depth * (2.0 - depth)).sqrt();
        // The height of the ray is rounded, and near the tangent half the chord is known to the root of that.
        let error = 2.0 * f64::EPSILON / (5.0 - expected) + 1e-14;
        assert!(
            (out.t - expected).abs() <= error,
            "depth {depth}: {out:?}, {expected}"
        );
    }
}

#[test]
fn reference_leaves_what_it_starts_on_and_in() {
    let one = |script: &str, origin: [f64; 3], direction: [f64; 3]| {
        traced(
            script,
            settings(Method::Reference),
            &[super::ray(origin, direction)],
        )[0]
    };
    let floor = "show plane(\"y\", 0)";
    assert_eq!(
        one(floor, [3.0, 0.0, 1.0], [1.0, 1.0, 0.0]).verdict,
        Verdict::Miss
    );
    assert_eq!(one(floor, [0.0; 3], [0.0, 1.0, 0.0]).verdict, Verdict::Miss);
    let ball = "show sphere(1)";
    assert!((one(ball, [0.0; 3], [0.0, 0.0, 1.0]).t - 1.0).abs() < 1e-15);
    assert!((one(ball, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]).t - 2.0).abs() < 1e-15);
    assert_eq!(
        one(ball, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]).verdict,
        Verdict::Miss
    );
}

#[test]
fn reference_needs_no_box_and_no_constant() {
    // The claimed constant is a quarter of the true one, and the box of the field is not known.
    let script =
        "field steep(p) lipschitz 5 { return 20 * (length(p - [0, 0, -40]) - 0.5) } show steep";
    let loaded = std::panic::catch_unwind(|| super::shown(script));
    // A claim that samples refute is an error of the script; what is left for the tracer is a claim that they do not.
    assert!(loaded.is_err());
    let script = "field wave(p) { return p.y - 0.3 * sin(3 * p.x) * cos(4 * p.z) } show wave";
    let down = super::ray([0.2, 2.0, 0.1], [0.3, -1.0, 0.2]);
    let out = traced(script, settings(Method::Reference), &[down])[0];
    let p = out.point;
    assert!(
        (p.y - 0.3 * (3.0 * p.x).sin() * (4.0 * p.z).cos()).abs() < 1e-15,
        "{out:?}"
    );
}
