//! Where the steps of the camera's rays went.
//!
//! What keeps a step short is the leaf that governs the field where it is taken. So a ray's steps are put down to the leaves
//! that govern the places where classical sphere tracing would sample its way up to where it ended, in proportion to
//! their numbers; whole steps, by largest remainders, so that they add up to all steps, by every method. Source: Hart 1996 for
//! the places; Hamilton 1792 for the remainders.

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
    /// Rays of which at least one step is put down to it.
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
                for (cause, steps) in causes(ray, outcome, &parts) {
                    let share = shares.entry(cause).or_default();
                    share.rays += u64::from(steps > 0);
                    share.steps += steps;
                }
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

/// How many places of a ray's way are looked at.
const LOOKS: usize = 256;

/// At how many of them, evenly chosen, the leaf is looked up.
const LEAVES: usize = 8;

/// A place that a ray samples in a part.
type Sample<'a> = (&'a Node, [f64; 3]);

/// What a ray's steps are put down to.
fn causes(ray: &Ray, outcome: &Outcome, parts: &[Part]) -> Vec<(Cause, u64)> {
    let samples = replayed(ray, outcome, parts);
    let steps = u64::from(outcome.steps);
    let count = samples.len().min(LEAVES);
    if count == 0 {
        let nothing = Cause {
            place: None,
            kind: String::new(),
            name: None,
        };
        return vec![(nothing, steps)];
    }
    let mut weights: BTreeMap<Cause, u64> = BTreeMap::new();
    for k in 0..count {
        let (part, point) = samples[(2 * k + 1) * samples.len() / (2 * count)];
        *weights.entry(cause(part, point)).or_default() += 1;
    }
    apportioned(steps, weights.into_iter().collect())
}

/// So many steps in proportion to the weights, whole ones: what is left over goes to the largest remainders, of equal ones to
/// the first.
fn apportioned(steps: u64, weights: Vec<(Cause, u64)>) -> Vec<(Cause, u64)> {
    let sum: u64 = weights.iter().map(|(_, weight)| weight).sum();
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by_key(|k| std::cmp::Reverse(steps * weights[*k].1 % sum));
    let mut shares: Vec<(Cause, u64)> = weights
        .into_iter()
        .map(|(cause, weight)| (cause, steps * weight / sum))
        .collect();
    let given: u64 = shares.iter().map(|(_, share)| share).sum();
    for k in order.into_iter().take((steps - given) as usize) {
        shares[k].1 += 1;
    }
    shares
}

/// The leaf that governs a part at a place.
fn cause(part: &Node, point: [f64; 3]) -> Cause {
    let (leaf, placed) = governor(part, point);
    Cause {
        place: placed
            .and_then(Node::place)
            .map(|place| (place.file.clone(), place.line)),
        kind: leaf.kind().into(),
        name: placed.and_then(Node::name).map(String::from),
    }
}

/// The places that sphere tracing samples on a ray up to where it ended, part by part: in the parts whose boxes it crosses, or,
/// if it misses all of them, in all.
fn replayed<'a>(ray: &Ray, outcome: &Outcome, parts: &[Part<'a>]) -> Vec<Sample<'a>> {
    let end = match outcome.verdict {
        Verdict::Hit => outcome.t,
        Verdict::Miss | Verdict::Unknown => ray.t_max,
    };
    let mut samples = Vec::new();
    let marched = || {
        parts
            .iter()
            .filter(|part| part.takes_steps)
            .map(|part| &**part.node)
    };
    for part in marched() {
        let bounds = part.bounds();
        if let Some((from, to)) = crossing(ray, &bounds) {
            replay(ray, part, from, to.min(end), &mut samples);
        } else if !bounds.is_finite() {
            replay(ray, part, 0.0, end, &mut samples);
        }
    }
    if samples.is_empty() {
        marched().for_each(|part| replay(ray, part, 0.0, end, &mut samples));
    }
    samples
}

/// Adds the places that sphere tracing samples in a part on a stretch of a ray.
fn replay<'a>(ray: &Ray, part: &'a Node, from: f64, to: f64, samples: &mut Vec<Sample<'a>>) {
    let constant = if part.lipschitz().is_finite() {
        part.lipschitz()
    } else {
        1.0
    };
    let mut t = from;
    for _ in 0..LOOKS {
        let p = ray.at(t).to_array();
        let value: f64 = part.evaluate(&Vec3::splat(p));
        samples.push((part, p));
        // Past what it touches by a little, rather than creeping up to it.
        let width = ray.footprint.at(t).max(f64::MIN_POSITIVE);
        t += (value.abs() / constant).max(0.1 * width);
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
    use crate::catalogue::{
        AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid, Operation, Smooth, Sphere,
        Translate,
    };
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

    /// The steps that are put down to a line, with the leaf.
    fn of_line(effort: &[(Cause, Share)], line: u32) -> (&str, u64) {
        let is_meant = |(cause, _): &&(Cause, Share)| cause.place == Some(("a.sdf".into(), line));
        let (cause, share) = effort.iter().find(is_meant).unwrap();
        (&cause.kind, share.steps)
    }

    /// The hits of a scene's rays, all their steps, and where these went.
    fn counted(scene: &Scene) -> (Hits, u64, Vec<(Cause, Share)>) {
        let world = World::new(scene).unwrap();
        let hits = Hits::of(scene, &world, 1);
        let total = hits.outcomes.iter().map(|o| u64::from(o.steps)).sum();
        let effort = effort(&hits, &world);
        (hits, total, effort)
    }

    /// A ball to the left, a cube to the right: each has all steps of the rays that cross its box, and all add up.
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
        let (hits, total, effort) = counted(&scene);
        assert_eq!(
            effort.iter().map(|(_, share)| share.steps).sum::<u64>(),
            total
        );
        assert!(total > 500, "{total} steps");
        let parts: Vec<Part> = scene
            .shown
            .iter()
            .map(|node| Part {
                node,
                takes_steps: true,
            })
            .collect();
        // All steps of a ray that crosses the box of one shape are that shape's.
        let mut own = [0; 2];
        for (ray, outcome) in hits.rays.iter().zip(&hits.outcomes) {
            let crosses = |half: &usize| crossing(ray, &scene.shown[*half].bounds()).is_some();
            if let Some(half) = (0..2).find(crosses) {
                let steps = u64::from(outcome.steps);
                let [(cause, share)] = &causes(ray, outcome, &parts)[..] else {
                    panic!("the boxes stand side by side");
                };
                assert_eq!(
                    (cause.kind.as_str(), *share),
                    (["sphere", "box"][half], steps)
                );
                own[half] += steps;
            }
        }
        let ((ball, left), (cube, right)) = (of_line(&effort, 3), of_line(&effort, 7));
        assert_eq!((ball, cube), ("sphere", "box"));
        assert_eq!(left + right, total);
        assert!(own[0] > 500 && own[1] > 500, "{own:?}");
        assert!(left >= own[0] && right >= own[1]);
    }

    #[test]
    fn steps_past_one_shape_to_another_are_put_down_to_both() {
        // Rays graze a ball on their way to a wall; both are in one part.
        let (ball, wall) = (
            placed(AnyPrimitive::Sphere(Sphere::new(1.0)), 0.0, 3),
            placed(
                AnyPrimitive::Cuboid(Cuboid::new([0.4, 8.0, 8.0], 0.1)),
                6.0,
                7,
            ),
        );
        let operation = Operation::Union;
        let blend = AnyBlend::Smooth(Smooth::new(0.1));
        let scene = Scene {
            shown: vec![
                Node::combination(Combination { operation, blend }, vec![ball, wall]).unwrap(),
            ],
            camera: Camera {
                eye: DVec3::new(-6.0, 1.2, 0.0),
                at: DVec3::new(6.0, 1.2, 0.0),
                ..Camera::default()
            },
            settings: Settings {
                size: [9, 1],
                method: Method::Sphere,
                ..Settings::default()
            },
            ..Scene::default()
        };
        let (_, total, effort) = counted(&scene);
        let [ball, wall] = [3, 7].map(|line| of_line(&effort, line).1);
        assert_eq!(ball + wall, total);
        assert!(ball > total / 4 && wall > total / 8, "{ball} and {wall}");
    }

    #[test]
    fn shares_are_whole_and_add_up() {
        let named = |kind: &str| Cause {
            place: None,
            kind: kind.into(),
            name: None,
        };
        let weights = || vec![(named("a"), 1), (named("b"), 3), (named("c"), 4)];
        let shares = |steps| apportioned(steps, weights()).into_iter().map(|(_, n)| n);
        assert_eq!(shares(8).collect::<Vec<_>>(), [1, 3, 4]);
        assert_eq!(shares(4).collect::<Vec<_>>(), [1, 1, 2]);
        (0..100).for_each(|steps| assert_eq!(shares(steps).sum::<u64>(), steps));
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
