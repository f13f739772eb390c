//! The method `probe`: it finds what the reference finds, on every entry of the catalogue, and takes few steps where lines and
//! crossings are known.

#[path = "catalogue/entries.rs"]
#[allow(dead_code)]
mod entries;
mod rays;
#[path = "catalogue/samples.rs"]
#[allow(dead_code)]
mod samples;
#[allow(dead_code)]
mod solids;
mod stub;

use entries::entries_and_fields;
use fieldstone::catalogue::*;
use fieldstone::scene::{Method, Node};
use fieldstone::trace::{Outcome, Verdict};
use rayon::prelude::*;
use rays::{aimed, ray};
use solids::{found, modified, number};
use std::sync::Arc;

/// Of these the reference takes seconds a ray, as their ranges are wide: certified sphere tracing, which other tests hold to it,
/// judges instead.
const SLOW: [&str; 4] = ["bezier", "ellipse", "helix", "tube"];

/// How many hits and misses the method has in common with the reference on rays at a shape in a box, from outside and from
/// inside.
fn agreed(seed: u64, name: &str, node: Arc<Node>) -> [usize; 2] {
    let finite = AnyPrimitive::Cuboid(Cuboid::new([3.0; 3], 0.0));
    let finite = Node::primitive(finite).expect("a box");
    let hard = Combination {
        operation: Operation::Intersection,
        blend: AnyBlend::HARD,
    };
    let node = Node::combination(hard, vec![node, finite]).expect("what lies in a box");
    let mut agreed = [0; 2];
    if !node.lipschitz().is_finite() {
        return agreed;
    }
    let mut rays = aimed(3, 1000 * seed);
    rays.extend((0..2).map(|k| {
        let x = |i: u64| 2.0 * number(seed, 8 * k + i) - 1.0;
        ray([x(0), x(1), x(2)], [x(3), x(4), x(5) + 0.01])
    }));
    let probed = found(&node, Method::Probe, &rays);
    let judge = if SLOW.contains(&name) {
        Method::Certified
    } else {
        Method::Reference
    };
    let judged = found(&node, judge, &rays);
    for ((ray, a), b) in rays.iter().zip(&probed).zip(&judged) {
        let what = format!("{name}, {ray:?}: {a:?}, {b:?}");
        if [a, b].iter().any(|out| out.verdict == Verdict::Unknown) {
            continue;
        }
        assert_eq!(a.verdict, b.verdict, "{what}");
        let is_hit = a.verdict == Verdict::Hit;
        agreed[usize::from(!is_hit)] += 1;
        let room = 1e-9 + a.error + b.error;
        assert!(!is_hit || (a.t - b.t).abs() <= room, "{what}");
    }
    agreed
}

#[test]
fn every_entry_is_met_where_the_reference_meets_it() {
    let entries: Vec<_> = (0..).zip(entries_and_fields()).collect();
    let rays = 5 * entries.len();
    let sums = entries
        .into_par_iter()
        .map(|(seed, (name, node))| agreed(seed, &name, node));
    let [hits, misses] = sums.reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    assert!(
        10 * (hits + misses) > 9 * rays,
        "{hits} and {misses} of {rays}"
    );
    assert!(hits > rays / 3 && misses > rays / 10, "{hits} and {misses}");
}

fn balls(n: u64, blend: AnyBlend) -> Arc<Node> {
    let ball = |k: u64| {
        let sphere = AnyPrimitive::Sphere(Sphere::new(0.1 + 0.2 * number(k, 0)));
        let place = [1, 2, 3].map(|i| 1.6 * number(k, i) - 0.8);
        let shift = AnyModifier::Translate(Translate::new(place));
        modified(shift, Node::primitive(sphere).expect("a ball"))
    };
    let union = Combination {
        operation: Operation::Union,
        blend,
    };
    Node::combination(union, (0..n).map(ball).collect()).expect("balls")
}

/// The steps of all rays together.
fn steps(outcomes: &[Outcome]) -> u32 {
    assert!(outcomes.iter().all(|out| out.verdict != Verdict::Unknown));
    outcomes.iter().map(|out| out.steps).sum()
}

#[test]
fn smooth_seams_take_half_the_steps_that_constants_take() {
    let node = balls(40, AnyBlend::Smooth(Smooth::new(0.15)));
    let rays = aimed(400, 7);
    let [probe, certified] =
        [Method::Probe, Method::Certified].map(|method| steps(&found(&node, method, &rays)));
    assert!(2 * probe < certified, "{probe} and {certified}");
}

#[test]
fn crossings_of_balls_leave_nothing_to_march() {
    // A step to the ball, and a window in which it is enclosed; past it there is none.
    let node = balls(1, AnyBlend::HARD);
    for out in found(&node, Method::Probe, &aimed(400, 8)) {
        let most = if out.verdict == Verdict::Hit { 4 } else { 2 };
        assert!(out.steps <= most, "{out:?}");
    }
}

#[test]
fn rooms_are_left_where_they_end() {
    // A box without a smaller one, seen from within: the wall is one crossing away, wherever the ray starts.
    let cuboid = |size: f64| {
        let cuboid = Cuboid::new([size, 0.5 * size, size], 0.0);
        Node::primitive(AnyPrimitive::Cuboid(cuboid)).expect("a box")
    };
    let hard = Combination {
        operation: Operation::Difference,
        blend: AnyBlend::HARD,
    };
    let room = Node::combination(hard, vec![cuboid(6.0), cuboid(4.0)]).expect("a room");
    let within = |k: u64| {
        let x = |i: u64| 2.0 * number(k, i) - 1.0;
        ray([1.9 * x(0), 0.9 * x(1), 1.9 * x(2)], [x(3), x(4), x(5)])
    };
    let rays: Vec<_> = (0..200).map(within).collect();
    let probed = found(&room, Method::Probe, &rays);
    for (ray, out) in rays.iter().zip(&probed) {
        let wall = |axis: usize| {
            let half = [2.0, 1.0, 2.0][axis];
            let way = ray.direction[axis];
            (half - ray.origin[axis] * way.signum()) / way.abs()
        };
        let exit = [0, 1, 2]
            .map(wall)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        assert_eq!(out.verdict, Verdict::Hit, "{ray:?}");
        assert!(
            (out.t - exit).abs() <= 1e-12 * (1.0 + exit),
            "{ray:?}: {out:?}"
        );
        assert!(out.steps <= 5, "{ray:?}: {out:?}");
    }
}
