//! Where the steps of the camera's rays went.
//!
//! A ray's steps are put down to the leaf that it hit. Where it hit nothing, or what it hit took no steps because it is met in
//! closed form, they are put down to the leaf that it passed most closely, seen from its start: what a ray comes near to is
//! what keeps its steps short. So every step is put down once, by every method.

use super::Hits;
use crate::catalogue::Bounds;
use crate::field::governor;
use crate::num::Vec3;
use crate::scene::Node;
use crate::trace::{Outcome, Ray, Verdict, World};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What steps are put down to.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cause {
    /// The script and the line of the leaf, or of the nearest node above it that has one.
    pub place: Option<(Arc<str>, u32)>,
    /// The word for what the leaf is; empty where a ray came near to nothing.
    pub kind: String,
    /// The name of the node at that place, if it has one.
    pub name: Option<String>,
}

/// What is put down to a cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// Rays with at least one step.
    pub rays: u64,
    /// Their steps.
    pub steps: u64,
}

/// Where the steps of these rays went, the most first. The sum of all steps is that of the outcomes.
pub fn effort(hits: &Hits, world: &World) -> Vec<(Cause, Share)> {
    let parts: Vec<Part> = world
        .paths()
        .map(|(way, node)| Part {
            node,
            takes_steps: !way.starts_with("analytic"),
        })
        .collect();
    let rays: Vec<(&Ray, &Outcome)> = hits.rays.iter().zip(&hits.outcomes).collect();
    let chunks: Vec<BTreeMap<Cause, Share>> = rays
        .par_chunks(1024)
        .map(|rays| {
            let mut shares: BTreeMap<Cause, Share> = BTreeMap::new();
            for (ray, outcome) in rays.iter().filter(|(_, outcome)| outcome.steps > 0) {
                let share = shares.entry(cause(ray, outcome, &parts)).or_default();
                share.rays += 1;
                share.steps += u64::from(outcome.steps);
            }
            shares
        })
        .collect();
    let mut all: BTreeMap<Cause, Share> = BTreeMap::new();
    for (cause, share) in chunks.into_iter().flatten() {
        let sum = all.entry(cause).or_default();
        sum.rays += share.rays;
        sum.steps += share.steps;
    }
    let mut sorted: Vec<(Cause, Share)> = all.into_iter().collect();
    sorted.sort_by_key(|(_, share)| std::cmp::Reverse(share.steps));
    sorted
}

/// A part of the world.
struct Part<'a> {
    node: &'a Arc<Node>,
    /// Whether rays take steps to it: they don't to what they meet in closed form.
    takes_steps: bool,
}

fn cause(ray: &Ray, outcome: &Outcome, parts: &[Part]) -> Cause {
    let hit = parts.get(outcome.part as usize);
    let hit = hit.filter(|part| outcome.verdict == Verdict::Hit && part.takes_steps);
    let found = match hit {
        Some(part) => Some((&**part.node, outcome.point.to_array())),
        None => nearest_pass(
            &Ray {
                t_max: ray.t_max.min(outcome.t),
                ..*ray
            },
            parts,
        ),
    };
    let Some((part, point)) = found else {
        return Cause {
            place: None,
            kind: String::new(),
            name: None,
        };
    };
    let (leaf, placed) = governor(part, point);
    Cause {
        place: placed
            .and_then(Node::place)
            .map(|place| (place.file.clone(), place.line)),
        kind: leaf.kind().into(),
        name: placed.and_then(Node::name).map(String::from),
    }
}

/// How many places along a ray are looked at in a part.
const LOOKS: usize = 96;

/// The part that a ray passes most closely, and where: by the distance to it as an angle seen from the ray's start. Parts whose
/// boxes it misses count only if it misses all of them.
fn nearest_pass<'a>(ray: &Ray, parts: &[Part<'a>]) -> Option<(&'a Node, [f64; 3])> {
    let mut best: Option<(f64, &Node, [f64; 3])> = None;
    let parts = || {
        parts
            .iter()
            .filter(|part| part.takes_steps)
            .map(|part| &**part.node)
    };
    for part in parts() {
        let bounds = part.bounds();
        if let Some((from, to)) = crossing(ray, &bounds) {
            look(ray, part, from, to, &mut best);
        } else if !bounds.is_finite() {
            look(ray, part, 0.0, ray.t_max, &mut best);
        }
    }
    if best.is_none() {
        parts().for_each(|part| look(ray, part, 0.0, ray.t_max, &mut best));
    }
    best.map(|(_, part, p)| (part, p))
}

/// Looks for a closer pass of `part` on a stretch of a ray.
fn look<'a>(
    ray: &Ray,
    part: &'a Node,
    from: f64,
    to: f64,
    best: &mut Option<(f64, &'a Node, [f64; 3])>,
) {
    let constant = if part.lipschitz().is_finite() {
        part.lipschitz()
    } else {
        1.0
    };
    let mut t = from;
    for _ in 0..LOOKS {
        let p = ray.at(t).to_array();
        let value: f64 = part.evaluate(&Vec3::splat(p));
        let distance = value.abs() / constant;
        let width = ray.footprint.at(t).max(f64::MIN_POSITIVE);
        let angle = distance / t.max(width);
        if best.is_none_or(|(least, ..)| angle < least) {
            *best = Some((angle, part, p));
        }
        // Past the surface by a little, rather than creeping up to it.
        t += distance.max(0.5 * width);
        if t.is_nan() || t > to {
            return;
        }
    }
}

/// Where a ray goes through a box, if it does: an infinite box from the start.
fn crossing(ray: &Ray, bounds: &Bounds) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, ray.t_max);
    for axis in 0..3 {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let ends = [bounds.low[axis], bounds.high[axis]].map(|side| (side - o) / d);
        // Along a side that it never crosses, a ray is inside all the way or not at all; an infinite side is no limit.
        if d == 0.0 {
            if o < bounds.low[axis] || o > bounds.high[axis] {
                return None;
            }
            continue;
        }
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    (from <= to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Cuboid, Sphere, Translate};
    use crate::scene::{Camera, Mark, Method, Place, Scene, Settings};
    use glam::DVec3;

    fn placed(primitive: AnyPrimitive, x: f64, line: u32) -> Arc<Node> {
        let node = Node::primitive(primitive).unwrap();
        let moved =
            Node::modifier(AnyModifier::Translate(Translate::new([x, 0.0, 0.0])), node).unwrap();
        moved.labelled(
            None,
            Some(Place {
                file: "a.sdf".into(),
                line,
                mark: Mark::default(),
            }),
        )
    }

    /// A ball to the left, a cube to the right: each has the steps of its half of the picture, and all add up.
    #[test]
    fn steps_are_put_down_to_what_rays_hit_or_pass() {
        let scene = Scene {
            shown: vec![
                placed(AnyPrimitive::Sphere(Sphere::new(1.0)), -1.5, 3),
                placed(AnyPrimitive::Cuboid(Cuboid::new([1.5; 3], 0.1)), 1.5, 7),
            ],
            camera: Camera {
                eye: DVec3::new(0.0, 0.0, 8.0),
                at: DVec3::ZERO,
                ..Camera::default()
            },
            settings: Settings {
                size: [48, 24],
                method: Method::Sphere,
                ..Settings::default()
            },
            ..Scene::default()
        };
        let world = World::new(&scene).unwrap();
        let hits = Hits::of(&scene, &world, 1);
        let effort = effort(&hits, &world);
        let total: u64 = hits.outcomes.iter().map(|o| u64::from(o.steps)).sum();
        assert_eq!(
            effort.iter().map(|(_, share)| share.steps).sum::<u64>(),
            total
        );
        assert!(total > 500, "{total} steps");
        let half = |is_left: bool| -> u64 {
            let rays = hits.rays.iter().zip(&hits.outcomes);
            rays.filter(|(ray, _)| (ray.direction.x < 0.0) == is_left)
                .map(|(_, o)| u64::from(o.steps))
                .sum()
        };
        let of = |line: u32| {
            let found = effort
                .iter()
                .find(|(cause, _)| cause.place == Some(("a.sdf".into(), line)));
            found
                .map(|(cause, share)| (cause.kind.clone(), share.steps))
                .unwrap()
        };
        assert_eq!(of(3), ("sphere".into(), half(true)));
        assert_eq!(of(7), ("box".into(), half(false)));
    }

    #[test]
    fn boxes_are_crossed_where_they_are() {
        let ray = |d: DVec3| Ray {
            origin: DVec3::new(-5.0, 0.0, 0.0),
            direction: d,
            t_max: f64::INFINITY,
            footprint: crate::trace::Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        };
        let cube = Bounds::centred([1.0; 3]);
        assert_eq!(crossing(&ray(DVec3::X), &cube), Some((4.0, 6.0)));
        assert_eq!(crossing(&ray(DVec3::Y), &cube), None);
        assert_eq!(crossing(&ray(DVec3::NEG_X), &cube), None);
        assert_eq!(
            crossing(&ray(DVec3::X), &Bounds::EVERYWHERE),
            Some((0.0, f64::INFINITY))
        );
    }
}
