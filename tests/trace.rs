//! Laws of tracing: what rays find must be what the fields say.

mod rays;

use fieldstone::catalogue::*;
use fieldstone::num::Vec3;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Occlusions, Outcome, Ray, Rays, Verdict, Visibility, World};
use glam::DVec3;
use rays::{aimed, random, ray};
use std::sync::Arc;

fn leaf(primitive: AnyPrimitive) -> Arc<Node> {
    Node::primitive(primitive).expect("a valid primitive")
}

fn modified(modifier: AnyModifier, child: &Arc<Node>) -> Arc<Node> {
    Node::modifier(modifier, child.clone()).expect("a valid modifier")
}

fn combined(operation: Operation, blend: AnyBlend, children: &[Arc<Node>]) -> Arc<Node> {
    Node::combination(Combination { operation, blend }, children.to_vec())
        .expect("a valid combination")
}

fn sphere(r: f64) -> Arc<Node> {
    leaf(AnyPrimitive::Sphere(Sphere::new(r)))
}

fn cuboid(size: [f64; 3], round: f64) -> Arc<Node> {
    leaf(AnyPrimitive::Cuboid(Cuboid::new(size, round)))
}

fn moved(child: &Arc<Node>, by: [f64; 3]) -> Arc<Node> {
    modified(AnyModifier::Translate(Translate::new(by)), child)
}

fn smooth(k: f64) -> AnyBlend {
    AnyBlend::Smooth(Smooth::new(k))
}

/// Shapes of every kind, named.
fn zoo() -> Vec<(&'static str, Arc<Node>)> {
    let profile = leaf(AnyPrimitive::Polygon(Polygon::new(vec![
        [-0.6, -0.5],
        [0.7, -0.4],
        [0.1, 0.0],
        [0.6, 0.6],
        [-0.5, 0.5],
    ])));
    let torus = leaf(AnyPrimitive::Torus(Torus::new(0.7, 0.2)));
    let ellipsoid = leaf(AnyPrimitive::Ellipsoid(Ellipsoid::new([0.9, 0.4, 0.6])));
    let tilted = |n: &Arc<Node>| {
        modified(
            AnyModifier::Rotate(Rotate::new(0.0, [0.0, 0.0, 1.0], 0.4, 0.7, -0.3)),
            n,
        )
    };
    let bar = cuboid([0.5, 1.6, 0.5], 0.05);
    vec![
        (
            "offset sphere",
            modified(AnyModifier::Offset(Offset::new(0.2)), &sphere(0.6)),
        ),
        ("ellipsoid", tilted(&ellipsoid)),
        ("box", tilted(&cuboid([1.0, 0.8, 1.2], 0.0))),
        ("round box", tilted(&cuboid([1.0, 0.8, 1.2], 0.1))),
        (
            "cylinder",
            tilted(&leaf(AnyPrimitive::Cylinder(Cylinder::new(0.5, 1.2, 0.0)))),
        ),
        (
            "cone",
            tilted(&leaf(AnyPrimitive::Cone(Cone::new(0.6, 1.4)))),
        ),
        (
            "capsule",
            tilted(&leaf(AnyPrimitive::Capsule(Capsule::new(0.3, 1.5)))),
        ),
        ("torus", tilted(&torus)),
        (
            "extruded polygon",
            tilted(&modified(
                AnyModifier::Extrude(Extrude::new(0.7, 0.0, 1.0)),
                &profile,
            )),
        ),
        (
            "revolved polygon",
            modified(AnyModifier::Revolve(Revolve::new(0.3)), &profile),
        ),
        (
            "twisted bar",
            modified(AnyModifier::Twist(Twist::new(1.3)), &bar),
        ),
        ("shell", {
            let cut = moved(&cuboid([1.0, 1.0, 1.0], 0.0), [0.5, 0.5, 0.5]);
            let shell = modified(AnyModifier::Shell(Shell::new(0.1)), &sphere(0.8));
            combined(Operation::Difference, AnyBlend::HARD, &[shell, cut])
        }),
        (
            "smooth union",
            combined(
                Operation::Union,
                smooth(0.3),
                &[moved(&sphere(0.5), [-0.4, 0.0, 0.0]), torus.clone()],
            ),
        ),
        ("smooth difference", {
            combined(
                Operation::Difference,
                smooth(0.2),
                &[cuboid([1.2; 3], 0.0), moved(&sphere(0.6), [0.6, 0.6, 0.6])],
            )
        }),
        (
            "mirror",
            modified(
                AnyModifier::Mirror(Mirror::new(Axis(0))),
                &moved(&torus, [0.3, 0.1, 0.0]),
            ),
        ),
        (
            "scaled",
            modified(AnyModifier::Scale(Scale::new([1.2, 0.5, 0.8])), &torus),
        ),
        ("repeated", {
            let bead = moved(&sphere(0.15), [0.07, 0.0, 0.02]);
            modified(
                AnyModifier::Repeat(Repeat::new([0.5, 0.4, 0.5], [3.0, 2.0, 4.0])),
                &bead,
            )
        }),
    ]
}

fn value(node: &Node, p: DVec3) -> f64 {
    node.evaluate(&Vec3::splat(p.to_array()))
}

/// The first change of sign along a ray, by dense samples in steps of 0.002: independent of all methods.
fn first_crossing(node: &Node, ray: &Ray, end: f64) -> Option<f64> {
    const STEP: f64 = 0.002;
    let mut before = value(node, ray.at(0.0));
    for i in 1..(end / STEP) as usize {
        let now = value(node, ray.at(STEP * i as f64));
        if (now < 0.0) != (before < 0.0) {
            return Some(STEP * (i as f64 - 0.5));
        }
        before = now;
    }
    None
}

fn world(node: &Arc<Node>, method: Method) -> World {
    World::of(
        std::slice::from_ref(node),
        &Settings {
            method,
            ..Settings::default()
        },
    )
    .expect("a world")
}

#[test]
fn hits_are_the_first_changes_of_sign() {
    for (name, node) in zoo() {
        let rays = aimed(1500, 17);
        let found = world(&node, Method::Auto).nearest(&rays, Visibility::All);
        let mut hits = 0;
        for (i, (ray, out)) in rays.iter().zip(&found).enumerate() {
            assert_ne!(out.verdict, Verdict::Unknown, "{name}: ray {i} {out:?}");
            let expected = first_crossing(&node, ray, 6.0);
            match (out.verdict, expected) {
                (Verdict::Hit, Some(t)) => {
                    hits += 1;
                    assert!(
                        out.t <= t + 0.002,
                        "{name}: ray {i} found {} behind {t}",
                        out.t
                    );
                    // A hit before the sampled crossing must be a chord that the samples jumped over.
                    let is_early = out.t < t - 0.002;
                    let (before, after) = (
                        value(&node, ray.at(out.t - 1e-7)),
                        value(&node, ray.at(out.t + 1e-7)),
                    );
                    assert!(!is_early || before > 0.0, "{name}: ray {i} early");
                    assert!(
                        (before < 0.0) != (after < 0.0) || is_early,
                        "{name}: ray {i}: {before} {after}"
                    );
                    assert!(value(&node, out.point).abs() < 1e-9, "{name}: ray {i}");
                    assert!((out.normal.length() - 1.0).abs() < 1e-12, "{name}: ray {i}");
                    assert!(
                        out.normal.dot(ray.direction) < 1e-6,
                        "{name}: ray {i}: seen from behind"
                    );
                }
                (Verdict::Hit, None) => {
                    // A chord shorter than a sample.
                    assert!(value(&node, out.point).abs() < 1e-9, "{name}: ray {i}");
                }
                (Verdict::Miss, None) => {}
                (verdict, expected) => {
                    panic!("{name}: ray {i}: {verdict:?} where {expected:?} was expected")
                }
            }
        }
        assert!(hits > 100, "{name}: only {hits} hits");
    }
}

#[test]
fn both_methods_agree_within_the_tolerance() {
    for (name, node) in zoo() {
        let rays = aimed(800, 23);
        let auto = world(&node, Method::Auto).nearest(&rays, Visibility::All);
        let sphere = world(&node, Method::Sphere).nearest(&rays, Visibility::All);
        let differ = auto
            .iter()
            .zip(&sphere)
            .filter(|(a, b)| a.verdict != b.verdict)
            .count();
        // Hart's rays that pass within a tenth of a pixel are called hits.
        assert!(differ <= 8, "{name}: {differ} of 800 verdicts differ");
    }
}

#[test]
fn analytic_and_marched_surfaces_are_the_same() {
    let ball = moved(&sphere(0.8), [0.1, -0.2, 0.3]);
    let tilted = |n: &Arc<Node>| {
        modified(
            AnyModifier::Rotate(Rotate::new(0.7, [1.0, 2.0, 0.5], 0.0, 0.0, 0.0)),
            n,
        )
    };
    let floor = tilted(&leaf(AnyPrimitive::Plane(Plane::new(
        [0.0, 1.0, 0.0],
        -0.4,
    ))));
    for node in [ball, floor] {
        // An offset of zero hides the closed form.
        let hidden = modified(
            AnyModifier::Mirror(Mirror::new(Axis(2))),
            &modified(AnyModifier::Mirror(Mirror::new(Axis(2))), &node),
        );
        let hidden = combined(
            Operation::Intersection,
            AnyBlend::HARD,
            &[hidden, cuboid([20.0; 3], 0.0)],
        );
        let node = combined(
            Operation::Intersection,
            AnyBlend::HARD,
            &[node.clone(), cuboid([20.0; 3], 0.0)],
        );
        let rays: Vec<Ray> = aimed(500, 5)
            .into_iter()
            .filter(|r| r.origin.z > 0.0 && r.at(3.0).z > 0.0)
            .collect();
        let a = world(&node, Method::Auto).nearest(&rays, Visibility::All);
        let b = world(&hidden, Method::Auto).nearest(&rays, Visibility::All);
        for (a, b) in a
            .iter()
            .zip(&b)
            .filter(|(a, b)| a.point.z > 0.0 && b.point.z > 0.0)
        {
            assert!((a.t - b.t).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}

fn same_bits(a: &Outcome, b: &Outcome) -> bool {
    let bits = |o: &Outcome| {
        let [x, y, z] = o.normal.to_array().map(f64::to_bits);
        (
            o.verdict,
            o.t.to_bits(),
            o.error.to_bits(),
            [x, y, z],
            o.part,
        )
    };
    bits(a) == bits(b)
}

#[test]
fn results_do_not_depend_on_packing() {
    for (name, node) in zoo() {
        let rays = aimed(300, 41);
        let both = combined(
            Operation::Union,
            AnyBlend::HARD,
            &[node, moved(&sphere(0.4), [0.5, 0.5, 0.0])],
        );
        for method in [Method::Auto, Method::Sphere] {
            let world = world(&both, method);
            let together = world.nearest(&rays, Visibility::All);
            for (i, ray) in rays.iter().enumerate() {
                let alone = world.nearest(std::slice::from_ref(ray), Visibility::All)[0];
                assert!(
                    same_bits(&alone, &together[i]),
                    "{name}: ray {i}: {alone:?} {:?}",
                    together[i]
                );
            }
        }
    }
}

#[test]
fn occlusion_is_a_hit_before_the_end() {
    for (name, node) in zoo() {
        let rays: Vec<Ray> = aimed(400, 61)
            .into_iter()
            .map(|r| Ray { t_max: 2.8, ..r })
            .collect();
        let world = world(&node, Method::Auto);
        let hits = world.nearest(&rays, Visibility::All);
        let blocked = world.occluded(&rays);
        for (i, (a, b)) in hits.iter().zip(&blocked).enumerate() {
            assert_eq!(a.verdict, b.verdict, "{name}: ray {i}");
        }
    }
}

/// Of rays side by side some may be asked: what they find is what they find alone, and nothing is said of the others.
#[test]
fn some_rays_are_occluded_as_they_are_alone() {
    let (name, node) = &zoo()[0];
    let rays = aimed(600, 91);
    let columns: Rays = rays.iter().collect();
    let wanted: [fn(u32) -> bool; 4] = [|_| true, |_| false, |i| i % 3 != 1, |i| i / 40 % 2 == 0];
    for method in [Method::Auto, Method::Sphere] {
        let world = world(node, method);
        let all = world.occluded(&rays);
        assert!(all.iter().any(|found| found.verdict == Verdict::Hit));
        let mut found = Occlusions::default();
        for is_wanted in wanted {
            let some: Vec<u32> = (0..600).filter(|i| is_wanted(*i)).collect();
            world.occlusions_into(&columns.columns(), &some, &mut found);
            for (i, found) in found.iter().enumerate() {
                let expected = if is_wanted(i as u32) {
                    all[i].verdict
                } else {
                    Verdict::Miss
                };
                assert_eq!(found.verdict, expected, "{name}, {method:?}: ray {i}");
            }
        }
    }
}

#[test]
fn rays_leave_the_surface_that_they_start_on() {
    for (name, node) in zoo() {
        let world = world(&node, Method::Auto);
        let rays = aimed(400, 77);
        let hits = world.nearest(&rays, Visibility::All);
        let (mut tried, mut convex_hits) = (0, 0);
        for hit in hits.iter().filter(|h| h.verdict == Verdict::Hit) {
            let away = ray(
                (hit.point + hit.normal * 1e-12).to_array(),
                hit.normal.to_array(),
            );
            let next = world.nearest(&[away], Visibility::All)[0];
            tried += 1;
            assert!(
                next.verdict != Verdict::Hit || next.t > 1e-6,
                "{name}: {next:?}"
            );
            convex_hits += usize::from(node.traits().is_convex && next.verdict == Verdict::Hit);
        }
        assert!(
            tried > 30 && convex_hits == 0,
            "{name}: {convex_hits} of {tried}"
        );
    }
}

#[test]
fn rays_inside_find_the_way_out() {
    for node in [
        sphere(1.0),
        modified(AnyModifier::Offset(Offset::new(0.5)), &sphere(0.5)),
    ] {
        let out = world(&node, Method::Auto)
            .nearest(&[ray([0.0; 3], [0.6, 0.0, 0.8])], Visibility::All)[0];
        assert_eq!(out.verdict, Verdict::Hit);
        assert!(
            (out.t - 1.0).abs() < 1e-12 && out.normal.dot(DVec3::new(0.6, 0.0, 0.8)) > 0.999_999
        );
    }
    // Across a box from face to face.
    let out = world(&cuboid([2.0, 1.0, 1.0], 0.0), Method::Auto)
        .nearest(&[ray([-0.999, 0.1, 0.1], [1.0, 0.0, 0.0])], Visibility::All)[0];
    assert!((out.t - 1.999).abs() < 1e-12, "{out:?}");
}

#[test]
fn coincident_cut_leaves_no_skin() {
    // A = [-1, 1]^3 minus B = [0, 1] x [-1, 1]^2: the field touches zero on the common face.
    let tool = moved(&cuboid([1.0, 2.0, 2.0], 0.0), [0.5, 0.0, 0.0]);
    let cut = combined(
        Operation::Difference,
        AnyBlend::HARD,
        &[cuboid([2.0; 3], 0.0), tool],
    );
    let out = world(&cut, Method::Auto)
        .nearest(&[ray([0.5, 5.0, 0.0], [0.0, -1.0, 0.0])], Visibility::All)[0];
    assert_eq!(out.verdict, Verdict::Miss, "{out:?}");
}

#[test]
fn near_misses_of_a_marched_sphere_miss() {
    let ball = modified(AnyModifier::Offset(Offset::new(0.5)), &sphere(0.5));
    let torus = leaf(AnyPrimitive::Torus(Torus::new(0.5, 0.5)));
    for (node, top) in [(&ball, 1.0), (&torus, 0.5)] {
        for exponent in 1..=12 {
            let clearance = 10f64.powi(-exponent);
            let at = |y: f64| {
                world(node, Method::Auto)
                    .nearest(&[ray([-5.0, y, 0.0], [1.0, 0.0, 0.0])], Visibility::All)[0]
            };
            assert_eq!(
                at(top + clearance).verdict,
                Verdict::Miss,
                "clearance {clearance}"
            );
        }
    }
}

#[test]
fn wrong_constants_are_refuted() {
    use fieldstone::scene::{FieldShape, GraphBuilder};
    // f = 20 (|p| - 0.5), claimed to have constant 15: the second step lands inside.
    let mut b = GraphBuilder::new();
    let p = b.point();
    let r = b.call(Function::Norm3, &p);
    let half = b.constant(0.5);
    let twenty = b.constant(20.0);
    let d = b.subtract(r, half);
    let f = b.multiply(d, twenty);
    let graph = b.finish(&[f]);
    let field = Node::field(FieldShape {
        name: "steep".into(),
        graph: graph.into(),
        claimed: Some(15.0),
    })
    .expect("a field");
    let node = combined(
        Operation::Intersection,
        AnyBlend::HARD,
        &[field, cuboid([4.0; 3], 0.0)],
    );
    let out = world(&node, Method::Auto)
        .nearest(&[ray([-3.0, 0.1, 0.0], [1.0, 0.0, 0.0])], Visibility::All)[0];
    assert_eq!(out.verdict, Verdict::Unknown, "{out:?}");
}

#[test]
fn sphere_tracing_takes_the_steps_that_theory_says() {
    // Towards a plane at angle a from height h, until |f| < eps: n = ceil(ln(eps / h) / ln(1 - sin a)) steps forward.
    // With a tolerance of eps(t) = 0.1 * spread * t the end is where f < eps(t); the height shrinks by (1 - sin a) each
    // time, so the walk can be followed by hand.
    let floor = leaf(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0)));
    for degrees in [90.0f64, 45.0, 10.0, 2.0] {
        let a = degrees.to_radians();
        let ray = ray([0.0, 1.0, 0.0], [a.cos(), -a.sin(), 0.0]);
        let out = world(&floor, Method::Sphere).nearest(&[ray], Visibility::All)[0];
        let (mut height, mut t, mut steps) = (1.0f64, 0.0f64, 1u32);
        while height >= 0.1 * 1e-3 * t {
            t += height;
            height *= 1.0 - a.sin();
            steps += 1;
        }
        assert_eq!(out.verdict, Verdict::Hit);
        assert_eq!(out.steps, steps, "{degrees} degrees");
    }
}

#[test]
fn scaling_by_a_power_of_two_keeps_the_bits() {
    for (name, node) in zoo() {
        for exponent in [-30, 30] {
            let s = 2f64.powi(exponent);
            let large = modified(AnyModifier::Scale(Scale::new([s; 3])), &node);
            let rays = aimed(100, 91);
            let scaled: Vec<Ray> = rays
                .iter()
                .map(|r| Ray {
                    origin: r.origin * s,
                    ..*r
                })
                .collect();
            let a = world(&node, Method::Auto).nearest(&rays, Visibility::All);
            let b = world(&large, Method::Auto).nearest(&scaled, Visibility::All);
            for (i, (a, b)) in a.iter().zip(&b).enumerate() {
                assert_eq!(a.verdict, b.verdict, "{name}: ray {i}");
                assert_eq!(
                    (a.t * s).to_bits(),
                    b.t.to_bits(),
                    "{name} at 2^{exponent}: ray {i}"
                );
            }
        }
    }
}

/// The gyroid with `cells` cells in a unit, as a script would write it.
fn gyroid(cells: f64) -> fieldstone::scene::Graph {
    use fieldstone::scene::GraphBuilder;
    let mut b = GraphBuilder::new();
    let k = b.constant(cells * std::f64::consts::PI);
    let q = b.point().map(|c| b.multiply(c, k));
    let s = q.map(|c| b.call(Function::Sin, &[c]));
    let c = q.map(|c| b.call(Function::Cos, &[c]));
    let terms = [0, 1, 2].map(|i| b.multiply(s[i], c[(i + 1) % 3]));
    let sum = b.add(terms[0], terms[1]);
    let sum = b.add(sum, terms[2]);
    let f = b.divide(sum, k);
    b.finish(&[f])
}

#[test]
fn constant_of_the_gyroid_is_derived() {
    use fieldstone::scene::FieldShape;
    let graph = gyroid(5.0);
    let field = Node::field(FieldShape {
        name: "gyroid".into(),
        graph: graph.into(),
        claimed: None,
    })
    .expect("a field");
    // The largest slope is sqrt 3, at the origin.
    let exact = 3f64.sqrt();
    assert!(
        field.lipschitz() >= exact && field.lipschitz() <= 1.04 * exact,
        "{}",
        field.lipschitz()
    );
    let core = combined(
        Operation::Intersection,
        AnyBlend::HARD,
        &[field, sphere(0.9)],
    );
    assert!(
        core.lipschitz() >= exact && core.lipschitz() <= 1.8,
        "{}",
        core.lipschitz()
    );
}

#[test]
fn overlapping_glass_is_one_body() {
    use fieldstone::scene::{Material, Term};
    let glass = std::sync::Arc::new(Material {
        refract: Term::Constant(1.0),
        ..Material::default()
    });
    // Two unit boxes that share the face x = 0, and a third one apart.
    let boxes = [-0.5, 0.5, 3.0]
        .map(|x| moved(&cuboid([1.0; 3], 0.0), [x, 0.0, 0.0]).painted(glass.clone()));
    let world = World::of(&boxes, &Settings::default()).expect("a world");
    assert_eq!(world.parts(), 2);
    // From inside the left box the way out is the far face of the right one.
    let out = world.nearest(&[ray([-0.9, 0.1, 0.1], [1.0, 0.0, 0.0])], Visibility::All)[0];
    assert!((out.t - 1.9).abs() < 1e-9, "{out:?}");
    // Of different materials, both surfaces are there.
    let other = std::sync::Arc::new(Material {
        refract: Term::Constant(1.0),
        ..Material::default()
    });
    let right = moved(&cuboid([1.0; 3], 0.0), [0.5, 0.0, 0.0]).painted(other);
    let world = World::of(&[boxes[0].clone(), right], &Settings::default()).expect("a world");
    let out = world.nearest(&[ray([-0.9, 0.1, 0.1], [1.0, 0.0, 0.0])], Visibility::All)[0];
    assert!((out.t - 0.9).abs() < 1e-9, "{out:?}");
}

#[test]
fn rays_inside_of_convex_shapes_find_the_far_side() {
    // Also those that graze a face from within, where steps of sphere tracing would be as short as the gap.
    let slab = cuboid([2.0, 1.0, 1.0], 0.1);
    let world = world(&slab, Method::Auto);
    for exponent in 1..=12 {
        let y = 0.5 - 10f64.powi(-exponent);
        let out = world.nearest(&[ray([-0.8, y, 0.0], [1.0, 0.0, 0.0])], Visibility::All)[0];
        // The far side there: the rounded edge, a circle of radius 0.1 around (0.9, 0.4).
        let expected = 0.8 + 0.9 + (0.01 - (y - 0.4).max(0.0).powi(2)).max(0.0).sqrt();
        assert_eq!(out.verdict, Verdict::Hit, "gap 1e-{exponent}");
        assert!(
            (out.t - expected).abs() < 1e-7 && out.steps < 64,
            "gap 1e-{exponent}: {out:?}"
        );
    }
}

fn down(x: f64, y: f64, z: f64) -> Ray {
    ray([x, y, z], [0.0, -1.0, 0.0])
}

#[test]
fn surfaces_on_the_border_of_their_bounds_are_found() {
    // A half-space with a dent: its bounds end at its surface, wherever that lies.
    for height in [0.0, 1.0, 100.0, 1e4, -1e6] {
        let floor = leaf(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], height)));
        let dent = moved(&sphere(0.7), [50.0, height, 0.0]);
        let node = combined(Operation::Difference, AnyBlend::HARD, &[floor, dent]);
        let world = world(&node, Method::Auto);
        for i in 0..50 {
            let ray = ray(
                [2.0, height + 1.7, 5.0],
                [random(i) - 0.5, -0.2 - random(i + 99), random(i + 50) - 0.5],
            );
            let out = world.nearest(&[ray], Visibility::All)[0];
            assert_eq!(
                out.verdict,
                Verdict::Hit,
                "height {height}: ray {i} {out:?}"
            );
            assert!(
                (out.t * ray.direction.y + 1.7).abs() < 1e-6 * (1.0 + height.abs() * 1e-6),
                "{out:?}"
            );
        }
    }
}

#[test]
fn endless_shapes_are_seen_from_the_origin_of_the_world() {
    let grid = modified(
        AnyModifier::Repeat(Repeat::new([1.0; 3], [f64::INFINITY; 3])),
        &moved(&sphere(0.2), [0.05, 0.5, 0.5]),
    );
    let out =
        world(&grid, Method::Auto).nearest(&[ray([0.0; 3], [1.0, 0.1, 0.3])], Visibility::All)[0];
    assert_eq!(out.verdict, Verdict::Hit, "{out:?}");
    let dented = combined(
        Operation::Difference,
        AnyBlend::HARD,
        &[
            leaf(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], -1.0))),
            moved(&sphere(0.5), [3.0, -1.0, 0.0]),
        ],
    );
    let out = world(&dented, Method::Auto).nearest(&[down(0.0, 0.0, 0.0)], Visibility::All)[0];
    assert!((out.t - 1.0).abs() < 1e-9, "{out:?}");
    // At a millionth of a degree above the horizon.
    let a = 1e-6f64.to_radians();
    let out = world(&dented, Method::Sphere).nearest(
        &[ray([0.0, 0.0, 9.0], [a.cos(), a.sin(), 0.0])],
        Visibility::All,
    )[0];
    assert_ne!(out.verdict, Verdict::Hit, "{out:?}");
}

#[test]
fn sheets_thinner_than_a_step_are_found() {
    for exponent in 2..=9 {
        let w = 10f64.powi(-exponent);
        let far_cut = moved(&cuboid([0.1; 3], 0.0), [5.0; 3]);
        let shell = modified(AnyModifier::Shell(Shell::new(w)), &sphere(1.0));
        let node = combined(Operation::Difference, AnyBlend::HARD, &[shell, far_cut]);
        let world = world(&node, Method::Auto);
        let rays: Vec<Ray> = (0..200)
            .map(|i| {
                ray(
                    [0.0, 0.0, 5.0],
                    [
                        0.18 * (random(i) - 0.5),
                        0.18 * (random(i + 777) - 0.5),
                        -1.0,
                    ],
                )
            })
            .collect();
        for (i, (ray, out)) in rays
            .iter()
            .zip(world.nearest(&rays, Visibility::All))
            .enumerate()
        {
            let b = ray.origin.dot(ray.direction);
            let r = 1.0 + 0.5 * w;
            let expected = -b - (b * b - 25.0 + r * r).sqrt();
            assert_eq!(out.verdict, Verdict::Hit, "w {w}: ray {i}");
            assert!(
                (out.t - expected).abs() < 1e-7,
                "w {w}: ray {i}: {} but {expected}",
                out.t
            );
        }
    }
}

#[test]
fn a_tangent_sphere_does_not_hide_what_stands_before_it() {
    let both = [sphere(1.0), moved(&sphere(0.3), [0.0, 1.0, 3.0])];
    let world = World::of(&both, &Settings::default()).expect("a world");
    let out = world.nearest(&[ray([0.0, 1.0, 5.0], [0.0, 0.0, -1.0])], Visibility::All)[0];
    assert!((out.t - 1.7).abs() < 1e-12, "{out:?}");
}

#[test]
fn a_closed_outline_is_the_same_polygon() {
    let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mut closed = corners.clone();
    closed.extend([[0.0, 1.0], [0.0, 0.0]]);
    let field = |points| {
        value(
            &leaf(AnyPrimitive::Polygon(Polygon::new(points))),
            DVec3::new(3.0, 3.0, 0.0),
        )
    };
    assert_eq!(field(corners), field(closed));
}

#[test]
fn slopes_of_a_blend_are_halves_where_its_shapes_tie() {
    use fieldstone::num::Dual;
    let blended = |operation| {
        let wall = |normal| leaf(AnyPrimitive::Plane(Plane::new(normal, 0.0)));
        combined(
            operation,
            smooth(0.4),
            &[wall([1.0, 0.0, 0.0]), wall([0.0, 1.0, 0.0])],
        )
    };
    for (operation, expected) in [
        (Operation::Union, [0.5, 0.5]),
        (Operation::Intersection, [0.5, 0.5]),
        (Operation::Difference, [0.5, -0.5]),
    ] {
        // Difference ties where the body's field is minus the tool's.
        let y = if operation == Operation::Difference {
            -0.1
        } else {
            0.1
        };
        let p = Vec3::new(
            Dual::<f64, 2>::variable(0.1, 0),
            Dual::variable(y, 1),
            Dual::new(0.0, [0.0; 2]),
        );
        assert_eq!(
            blended(operation).evaluate(&p).partial,
            expected,
            "{operation:?}"
        );
    }
}

#[test]
fn a_chamfer_of_parallel_floors_is_not_stepped_through() {
    // Catalogue C22: the strip lies at y = 0.125, where the field has the slope sqrt 2.
    let floor = |offset| leaf(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], offset)));
    let chamfer = AnyBlend::Chamfer(Chamfer::new(0.2));
    let node = combined(Operation::Union, chamfer, &[floor(0.0), floor(0.05)]);
    for method in [Method::Auto, Method::Sphere] {
        let settings = Settings {
            method,
            ..Settings::default()
        };
        let world = World::of(std::slice::from_ref(&node), &settings).expect("a world");
        for (tilt, expected) in [(0.0, 0.875), (1.0, 0.875 * 2.0_f64.sqrt())] {
            let down = ray([0.0, 1.0, 0.0], [tilt, -1.0, 0.0]);
            let out = world.nearest(&[down], Visibility::All)[0];
            assert_eq!(out.verdict, Verdict::Hit);
            assert!((out.t - expected).abs() < 1e-3, "{method:?}: {out:?}");
        }
    }
}

#[test]
fn quadrilaterals_are_hit_where_their_triangles_are() {
    let mut beyond = 0;
    for seed in 0..200 {
        let x = |k: u64| 2.0 * random(seed * 64 + k) - 1.0;
        let point = |k: u64| DVec3::new(x(k), x(k + 1), x(k + 2));
        // A parallelogram, or with its last corner lifted out of the plane.
        let (a, u, v) = (point(0), point(3), point(6));
        let lift = if seed % 2 == 0 { 0.0 } else { 0.5 * x(9) };
        let d = a + v + lift * u.cross(v);
        let corners = [a, a + u, a + u + v, d];
        let [a, b, c, d] = corners.map(|corner| corner.to_array());
        let quad = leaf(AnyPrimitive::Quad(Quad::new(a, b, c, d)));
        let world = world(&quad, Method::Auto);
        assert_eq!(world.parts(), 1);
        let halves = [
            [corners[0], corners[1], corners[2]],
            [corners[0], corners[2], corners[3]],
        ];
        for i in 0..50 {
            let x = |k: u64| random(1_000_000 + seed * 4096 + i * 8 + k);
            // A place on a half by its coordinates; beyond the border where the last one is negative.
            let half = halves[(i % 2) as usize];
            let (p, q) = (1.4 * x(0), 1.4 * x(1));
            let target = half[0] + p * (half[1] - half[0]) + q * (half[2] - half[0]);
            let eye = DVec3::new(x(2) - 0.5, x(3) - 0.5, x(4) - 0.5).normalize() * 6.0;
            let ray = ray(eye.to_array(), (target - eye).to_array());
            let out = world.nearest(&[ray], Visibility::All)[0];
            if p + q < 0.999 && p > 0.001 && q > 0.001 {
                assert_eq!(out.verdict, Verdict::Hit, "{seed} {i}");
                assert!(out.t <= eye.distance(target) + 1e-9, "{seed} {i}: {out:?}");
            }
            // A parallelogram is met there or nowhere.
            let (arm, normal) = (target - corners[0], u.cross(v));
            let s = arm.cross(v).dot(normal) / normal.length_squared();
            let t = u.cross(arm).dot(normal) / normal.length_squared();
            let is_beyond = s.min(1.0 - s).min(t).min(1.0 - t) < -1e-6;
            if lift == 0.0 && is_beyond {
                beyond += 1;
                assert_eq!(out.verdict, Verdict::Miss, "{seed} {i}: {s} {t}");
            }
            if out.verdict == Verdict::Hit {
                let field = value(&quad, ray.origin + out.t * ray.direction);
                assert!(field.abs() < 1e-12, "{seed} {i}: {field}");
                // It has no front: its normal is that of one of its halves, against the ray.
                assert_eq!(out.evaluations, 0);
                assert!(out.normal.dot(ray.direction) <= 0.0, "{seed} {i}: {out:?}");
                let normals = halves.map(|[a, b, c]| (b - a).cross(c - a).normalize());
                let is_one = |n: &DVec3| n.cross(out.normal).length() < 1e-12;
                assert!(normals.iter().any(is_one), "{seed} {i}: {out:?}");
            }
        }
    }
    assert!(beyond > 500, "{beyond}");
}

#[test]
fn rays_along_the_rim_of_a_fractal_come_to_an_end() {
    let bulb = leaf(AnyPrimitive::Mandelbulb(Mandelbulb::new(8.0, 3.0)));
    let world = world(&bulb, Method::Auto);
    let rays = aimed(4000, 5);
    let outcomes = world.nearest(&rays, Visibility::All);
    let mut evaluations = 0;
    for (ray, out) in rays.iter().zip(&outcomes) {
        assert_ne!(out.verdict, Verdict::Unknown);
        evaluations += u64::from(out.evaluations);
        if out.verdict == Verdict::Hit {
            let at = |t: f64| value(&bulb, ray.origin + t * ray.direction);
            let (before, behind) = (at(out.t - 2.0 * out.error), at(out.t + 2.0 * out.error));
            assert!(
                before * behind <= 0.0 || before.abs() < 1e-12,
                "{ray:?}: {out:?}"
            );
        }
    }
    let most = outcomes.iter().map(|out| out.evaluations).max();
    // Where a few rays are looked into down to rounding, they take more than all the others.
    assert!(evaluations < 400 * 4000, "{evaluations}");
    assert!(most < Some(20_000), "{most:?}");
}
