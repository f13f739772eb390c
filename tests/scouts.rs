//! Scouts in single precision: what they pass must be free and what they find must be there, however coarse their numbers are.

mod rays;
mod solids;

use fieldstone::catalogue::*;
use fieldstone::lang::load_text;
use fieldstone::scene::Node;
use fieldstone::trace::{Ray, SceneTracer};
use glam::DVec3;
use rays::aimed;
use solids::{agree, modified, number};
use std::sync::Arc;

fn moved(node: Arc<Node>, by: [f64; 3]) -> Arc<Node> {
    modified(AnyModifier::Translate(Translate::new(by)), node)
}

/// Balls, rings and twisted bars in one smooth union: nothing of it has a closed form.
fn blend(seed: u64) -> Arc<Node> {
    let leaf = |k: u64| {
        let x = |n: u64| number(seed.wrapping_mul(97).wrapping_add(k), n);
        let primitive = match k % 3 {
            0 => AnyPrimitive::Sphere(Sphere::new(0.1 + 0.3 * x(0))),
            1 => AnyPrimitive::Torus(Torus::new(0.3 + 0.3 * x(0), 0.02 + 0.1 * x(1))),
            _ => AnyPrimitive::Cuboid(Cuboid::new([0.3, 0.3 + 0.6 * x(0), 0.2], 0.0)),
        };
        let node = Node::primitive(primitive).expect("a valid primitive");
        let node = if k % 3 == 2 {
            modified(AnyModifier::Twist(Twist::new(3.0 * x(3))), node)
        } else {
            node
        };
        moved(node, [4, 5, 6].map(|n| 1.2 * x(n) - 0.6))
    };
    let blend = AnyBlend::Smooth(Smooth::new(0.02 + 0.2 * number(seed, 9)));
    let combination = Combination {
        operation: Operation::Union,
        blend,
    };
    Node::combination(combination, (0..6).map(leaf).collect()).expect("a valid combination")
}

/// A thin wall along the surface of a shape.
fn wall(node: Arc<Node>, thickness: f64) -> Arc<Node> {
    modified(AnyModifier::Shell(Shell::new(thickness)), node)
}

/// Rays that lead past the shape, through it and away from its inside, where it stands.
fn rays_about(place: [f64; 3], seed: u64) -> Vec<Ray> {
    let shift = DVec3::from_array(place);
    let mut rays = aimed(96, seed << 20);
    for (k, ray) in rays.iter_mut().enumerate() {
        if k % 4 == 3 {
            ray.origin *= 0.1;
        }
        ray.origin += shift;
    }
    rays
}

/// Compares with the reference; gives how many rays hit.
fn compare(what: &str, node: &Arc<Node>, rays: &[Ray]) -> u64 {
    let (hits, _) = agree(what, node, rays, |a, b, what| {
        // Two surfaces within the tolerance, a tenth of a thousandth of the distance, are one.
        let is_near = (a.t - b.t).abs() <= a.error + b.error + 1e-4 * a.t;
        assert!(is_near, "{what}");
        assert!(a.error < 1e-6, "{what}");
    });
    hits
}

#[test]
fn scouts_find_what_the_reference_finds() {
    let mut hits = 0;
    for seed in 0..24 {
        hits += compare(
            &format!("seed {seed}"),
            &blend(seed),
            &rays_about([0.0; 3], seed),
        );
    }
    assert!(hits > 600, "{hits}");
}

#[test]
fn walls_thinner_than_single_precision_are_not_passed() {
    let mut hits = 0;
    for seed in 0..8 {
        for thickness in [1e-3, 1e-5, 1e-7] {
            let node = wall(blend(seed), thickness);
            let what = format!("seed {seed}, {thickness} thick");
            hits += compare(&what, &node, &rays_about([0.0; 3], seed + 100));
        }
    }
    assert!(hits > 600, "{hits}");
}

#[test]
fn far_from_the_origin_coarse_numbers_decide_nothing() {
    let mut hits = 0;
    for seed in 0..8 {
        for far in [30.0, 1e3, 1e5] {
            let place = [far, -0.7 * far, 0.3 * far];
            let node = moved(wall(blend(seed), 1e-4), place);
            let what = format!("seed {seed}, {far} away");
            hits += compare(&what, &node, &rays_about(place, seed + 200));
        }
    }
    assert!(hits > 600, "{hits}");
}

/// What the last statement of a script shows.
fn written(script: &str) -> Arc<Node> {
    let loaded = load_text("test.sdf", script, &[], &SceneTracer::default());
    let scene = loaded.expect("a valid script").scene;
    scene.shown.last().expect("something shown").clone()
}

#[test]
fn fields_that_bend_are_not_cut_short() {
    let scripts = [
        "field sheet(p) {
           let q = 5 * p
           let g = sin(q.x) * cos(q.y) + sin(q.y) * cos(q.z) + sin(q.z) * cos(q.x)
           return (abs(g) - 0.3) / 5
         }
         show sheet & sphere(1)",
        "show box([0.7, 1.6, 0.7]).twist(rate: 2.5rad)",
        "field waves(p) { 0.1 * sin(9 * p.x) * exp(-abs(p.y)) }
         show sphere(0.8).displace(waves)",
        "field bumps(p) { 0.1 * noise(4 * p) }
         show torus(0.6, 0.25).displace(bumps)",
        // Thinned out along the way, so that stretches with different fields follow each other.
        "let arms = for i in 0..7 { box([0.16, 1.3, 0.16]).rotate(z: i * 50deg, x: i * 33deg) }
         let knobs = for i in 0..9 { sphere(0.17).translate([0.6 * cos(i), 0.6 * sin(2 * i), 0.5 * sin(i)]) }
         show union([union(arms, blend: smooth(0.1)), union(knobs, blend: smooth(0.1))], blend: smooth(0.1))",
    ];
    for script in scripts {
        let node = written(script);
        let hits: u64 = (0..30)
            .map(|seed| compare(script, &node, &rays_about([0.0; 3], seed + 300)))
            .sum();
        assert!(hits > 300, "{hits}: {script}");
    }
}
