//! Hard combinations of solids with closed forms: what their chords say must be what the reference finds, which knows nothing
//! but fields.

mod rays;
mod solids;

use fieldstone::catalogue::*;
use fieldstone::scene::{Method, Node};
use fieldstone::trace::{Outcome, Ray, Verdict};
use glam::DVec3;
use rays::{aimed, ray};
use solids::{agree, found, modified, number};
use std::sync::Arc;

fn combined(operation: Operation, children: Vec<Arc<Node>>) -> Arc<Node> {
    let blend = AnyBlend::Hard(Hard::new());
    Node::combination(Combination { operation, blend }, children).expect("a valid combination")
}

/// A solid with a closed form, turned, scaled and moved.
fn leaf(seed: u64) -> Arc<Node> {
    let x = |k: u64| number(seed, k);
    let primitive = match seed % 9 {
        0 | 1 => AnyPrimitive::Sphere(Sphere::new(0.2 + 0.6 * x(0))),
        2 | 3 => AnyPrimitive::Cuboid(Cuboid::new([0.4 + x(0), 0.4 + x(1), 0.4 + x(2)], 0.0)),
        4 => AnyPrimitive::Cylinder(Cylinder::new(0.1 + 0.4 * x(0), 0.4 + x(1), 0.0)),
        5 => AnyPrimitive::Cylinder(Cylinder::new(0.1 + 0.3 * x(0), f64::INFINITY, 0.0)),
        6 => AnyPrimitive::Capsule(Capsule::new(0.1 + 0.3 * x(0), 0.85 + x(1))),
        7 => AnyPrimitive::Ellipsoid(Ellipsoid::new([0, 1, 2].map(|k| 0.1 + 0.6 * x(k)))),
        _ => AnyPrimitive::Plane(Plane::new([x(0) - 0.5, x(1) - 0.5, 0.7], x(2) - 0.2)),
    };
    let axis = [x(11) - 0.5, x(12) - 0.5, 0.3];
    let turn = AnyModifier::Rotate(Rotate::new(6.0 * x(10), axis, 0.0, 0.0, 0.0));
    let scale = AnyModifier::Scale(Scale::new([0.7 + 0.6 * x(20); 3]));
    let place = [0, 1, 2].map(|k| 1.6 * x(30 + k) - 0.8);
    let shift = AnyModifier::Translate(Translate::new(place));
    let leaf = Node::primitive(primitive).expect("a valid primitive");
    [turn, scale, shift]
        .into_iter()
        .fold(leaf, |node, modifier| modified(modifier, node))
}

/// A tree of hard operations, so many levels high.
fn tree(seed: u64, height: u32) -> Arc<Node> {
    if height == 0 {
        return leaf(seed);
    }
    let operations = [
        Operation::Union,
        Operation::Difference,
        Operation::Intersection,
        Operation::Difference,
    ];
    let count = 2 + (number(seed, 40) * 3.0) as u64;
    let child = |k: u64| tree(seed.wrapping_mul(31).wrapping_add(k + 1), height - 1);
    let operation = operations[(number(seed, 41) * 4.0) as usize];
    let combination = combined(operation, (0..count).map(child).collect());
    let turn = Rotate::new(
        0.0,
        [0.0, 0.0, 1.0],
        number(seed, 42),
        0.0,
        number(seed, 43),
    );
    modified(AnyModifier::Rotate(turn), combination)
}

/// A tree inside of a box, so that it ends somewhere. The outermost operation keeps it in one part.
fn solid(seed: u64) -> Arc<Node> {
    let room = Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([2.4, 2.6, 2.8], 0.0)));
    let height = 1 + (seed % 3) as u32;
    combined(
        Operation::Intersection,
        vec![room.expect("a box"), tree(seed, height)],
    )
}

/// Rays from outside and from inside, in all directions.
fn rays(seed: u64) -> Vec<Ray> {
    let x = |k: u64| number(seed + 77, k) - 0.5;
    let inside = |k: u64| {
        let [origin, way] = [0, 3].map(|first| [0, 1, 2].map(|axis| 2.0 * x(6 * k + first + axis)));
        ray(origin, way)
    };
    let mut rays = aimed(48, seed << 20);
    rays.extend((0..16).map(inside));
    rays
}

#[test]
fn chords_find_what_the_reference_finds() {
    let (mut hits, mut asked) = (0, 0);
    for seed in 0..160u64 {
        let node = solid(seed);
        let rays = rays(seed);
        let what = format!("seed {seed}");
        let (new, evaluations) = agree(&what, &node, &rays, |a, b, what| {
            assert!((a.t - b.t).abs() <= a.error + b.error + 1e-12, "{what}");
            assert!(a.error < 1e-6, "{what}");
            assert!(a.normal.dot(b.normal) > 1.0 - 1e-9, "{what}");
        });
        (hits, asked) = (hits + new, asked + evaluations);
    }
    assert!(hits > 2000, "{hits}");
    assert!(
        asked < hits / 10,
        "fields are asked where rounding decides: {asked}"
    );
}

#[test]
fn what_leaves_a_surface_does_not_meet_it_again() {
    for seed in 0..200u64 {
        let node = solid(seed);
        let rays = rays(seed);
        for (ray, hit) in rays.iter().zip(found(&node, Method::Auto, &rays)) {
            if hit.verdict != Verdict::Hit || hit.normal.dot(ray.direction) >= 0.0 {
                continue;
            }
            // Straight away from the surface, and nearly along it.
            let aside = hit.normal.any_orthonormal_vector();
            for direction in [hit.normal, (aside + 1e-3 * hit.normal).normalize()] {
                let away = Ray {
                    origin: hit.point + hit.normal * (2.0 * hit.error + 1e-14),
                    direction,
                    ..*ray
                };
                let [auto, reference] = [Method::Auto, Method::Reference]
                    .map(|method| found(&node, method, std::slice::from_ref(&away))[0]);
                let is_near = |out: &Outcome| out.verdict == Verdict::Hit && out.t < 1e-6;
                assert!(
                    !is_near(&auto) || is_near(&reference),
                    "seed {seed}, {away:?}"
                );
            }
        }
    }
}

#[test]
fn coincident_faces_leave_no_skin() {
    let block = |size: [f64; 3], place: [f64; 3]| {
        let cuboid = Cuboid::new(size, 0.0);
        let node = Node::primitive(AnyPrimitive::Cuboid(cuboid)).expect("a box");
        modified(AnyModifier::Translate(Translate::new(place)), node)
    };
    // A slot as deep as the block is high, and turned, so that no number is round.
    let cut = combined(
        Operation::Difference,
        vec![
            block([1.0, 1.0, 1.0], [0.0; 3]),
            block([0.5, 1.0, 2.0], [0.1, 0.0, 0.0]),
        ],
    );
    let node = modified(
        AnyModifier::Rotate(Rotate::new(0.7, [0.3, 0.5, 0.8], 0.0, 0.0, 0.0)),
        cut,
    );
    let down = DVec3::new(0.0, -1.0, 0.0);
    let outside = |v: DVec3| {
        let turn = glam::DQuat::from_axis_angle(DVec3::new(0.3, 0.5, 0.8).normalize(), 0.7);
        turn * v
    };
    for k in 0..200 {
        let x = -0.14 + 0.48 * number(1, k);
        let z = -0.45 + 0.9 * number(2, k);
        let away = outside(DVec3::new(x, 3.0, z));
        let through = ray(away.to_array(), outside(down).to_array());
        let out = found(&node, Method::Auto, &[through])[0];
        assert_eq!(out.verdict, Verdict::Miss, "{x}, {z}: {out:?}");
    }
}

#[test]
fn rays_along_faces_are_not_lost() {
    // Nearly along two of the faces of a box, and in the very plane of one: what is far is no less a surface for it.
    let node = combined(
        Operation::Difference,
        vec![
            Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([2.0, 2.0, 2.0], 0.0)))
                .expect("a box"),
            Node::primitive(AnyPrimitive::Cylinder(Cylinder::new(
                0.3,
                f64::INFINITY,
                0.0,
            )))
            .expect("a cylinder"),
        ],
    );
    for aside in [0.0, 1e-15, -1e-15, 1e-13, 1e-9, -1e-6] {
        for x in [0.5, 0.999, 1.0 - 1e-13, 1.0, 1.0 + 1e-13, 1.1] {
            let along = ray([x, 0.2, -2.0], [aside, aside, 1.0]);
            let [auto, reference] = [Method::Auto, Method::Reference]
                .map(|method| found(&node, method, std::slice::from_ref(&along))[0]);
            let what = format!("{along:?}: {auto:?}, {reference:?}");
            if x < 1.0 - 1e-3 {
                assert_eq!(auto.verdict, Verdict::Hit, "{what}");
                assert!((auto.t - 1.0).abs() < 1e-9, "{what}");
            } else if x > 1.0 + 1e-3 {
                assert_eq!(auto.verdict, Verdict::Miss, "{what}");
            } else if reference.verdict != Verdict::Unknown {
                assert_eq!(auto.verdict, reference.verdict, "{what}");
            }
        }
    }
}

#[test]
fn rays_from_the_very_middle_leave_what_is_around_them() {
    let node = |primitive: AnyPrimitive| Node::primitive(primitive).expect("a valid primitive");
    let room = || node(AnyPrimitive::Cuboid(Cuboid::new([4.0; 3], 0.0)));
    let hollows = [
        (AnyPrimitive::Sphere(Sphere::new(0.5)), 0.5),
        (AnyPrimitive::Cylinder(Cylinder::new(0.25, 3.0, 0.0)), 0.25),
        (AnyPrimitive::Capsule(Capsule::new(0.75, 3.0)), 0.75),
        (
            AnyPrimitive::Ellipsoid(Ellipsoid::new([0.5, 1.0, 0.5])),
            0.5,
        ),
    ];
    for (hollow, radius) in hollows {
        for operation in [Operation::Difference, Operation::Intersection] {
            let both = combined(operation, vec![room(), node(hollow.clone())]);
            for direction in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]] {
                let out = found(&both, Method::Auto, &[ray([0.0; 3], direction)])[0];
                let what = format!("{operation:?}, {radius}, {direction:?}: {out:?}");
                assert_eq!(out.verdict, Verdict::Hit, "{what}");
                assert!((out.t - radius).abs() < 1e-14, "{what}");
            }
        }
    }
}
