//! Constants are tight: slack is a constant divided by the steepest slope that sampling and climbing find.
//!
//! The slack of a rule is the least over all that it can be applied to: a half-space of any direction for a modifier, two
//! of them for a blend. It is at most [`ATTAINED`] for every entry, and at most [`ELSEWHERE`] for every modifier over every
//! primitive and every combination of two primitives, but for what [`EXCEPTIONS`] lists.

use super::ascent::{Effort, highest};
use super::laws::{slope_at, surroundings};
use super::samples::{Dice, arguments, blends, leaf, leaves, operations, tried};
use fieldstone::catalogue::*;
use fieldstone::scene::Node;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The slack of a rule that is attained.
const ATTAINED: f64 = 1.05;

/// The slack of what a rule is applied to.
const ELSEWHERE: f64 = 2.0;

/// An entry whose slack may be larger.
struct Exception {
    /// The primitive, modifier or blend.
    entry: &'static str,
    /// What it is applied to; none for the entry's own rule.
    over: Option<&'static str>,
    /// The slack that is allowed.
    slack: f64,
    /// Why it can't be less.
    reason: &'static str,
}

const EXCEPTIONS: &[Exception] = &[
    Exception {
        entry: "extrude",
        over: Some("ring"),
        slack: 3.2,
        reason: "a fast twist: at the corners of its box the slope of something round points away from the axis",
    },
    Exception {
        entry: "warp",
        over: None,
        slack: 1.8,
        reason: "the constant holds for any noise: few cells of one noise don't draw the steepest gradients at once",
    },
];

/// How much slack is allowed, and by which exception.
fn allowed(entry: &str, over: Option<&str>) -> f64 {
    let found = EXCEPTIONS
        .iter()
        .find(|e| e.entry == entry && e.over == over);
    found.map_or(if over.is_none() { ATTAINED } else { ELSEWHERE }, |e| {
        e.slack
    })
}

/// The worst slack found for an entry, or for an entry over another.
type Slacks = BTreeMap<(&'static str, Option<&'static str>), (f64, String)>;

fn note(slacks: &mut Slacks, key: (&'static str, Option<&'static str>), slack: f64, name: String) {
    let worst = slacks.entry(key).or_insert((0.0, String::new()));
    if slack > worst.0 {
        *worst = (slack, name);
    }
}

/// The point of a box at a place of the unit cube.
fn point_of(region: &Bounds, place: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| region.low[i] + place[i] * (region.high[i] - region.low[i]))
}

/// The unit vector at a place of the unit square.
fn direction_of(u: f64, v: f64) -> [f64; 3] {
    let (y, angle) = (2.0 * u - 1.0, std::f64::consts::TAU * v);
    let r = (1.0 - y * y).sqrt();
    [r * angle.cos(), y, r * angle.sin()]
}

fn half_space(u: f64, v: f64, offset: f64) -> Arc<Node> {
    let plane = AnyPrimitive::Plane(Plane::new(direction_of(u, v), offset));
    Node::primitive(plane).expect("a direction is not zero")
}

/// A profile that is a half-plane through the origin as far as one looks, and positive there.
fn half_plane(turn: f64) -> Arc<Node> {
    let far = 1e3;
    let changed = [
        AnyModifier::Translate(Translate::new([-far, 0.0, 0.0])),
        AnyModifier::Rotate(Rotate::new(
            std::f64::consts::TAU * turn,
            [0.0, 0.0, 1.0],
            0.0,
            0.0,
            0.0,
        )),
        // Where an end of an extrusion is cut, only the profile counts then.
        AnyModifier::Offset(Offset::new(-1e6)),
    ];
    let rectangle = AnyPrimitive::Rectangle(Rectangle::new([2.0 * far; 2], 0.0));
    let leaf = Node::primitive(rectangle).expect("a valid rectangle");
    let change = |node, modifier| Node::modifier(modifier, node).expect("profiles move");
    changed.into_iter().fold(leaf, change)
}

/// The slack of a node's constant where it is looked at; none where there is no finite one or no such place.
pub fn slack(node: &Node, dice: &mut Dice, effort: Effort, enough: f64) -> Option<f64> {
    let region = surroundings(node);
    let constant = node.lipschitz_over(region);
    if region.is_empty() || constant.is_infinite() || constant == 0.0 {
        return None;
    }
    let goal = constant / enough;
    let (_, slope) = highest(
        |place: &[f64; 3]| slope_at(node, point_of(&region, place)),
        dice,
        effort,
        goal,
    );
    Some(constant / slope.max(0.0))
}

const THOROUGH: Effort = Effort {
    samples: 1500,
    climbs: 6,
    steps: 150,
};
const QUICK: Effort = Effort {
    samples: 400,
    climbs: 3,
    steps: 80,
};

/// The slack of every primitive, with several random arguments.
fn of_primitives(slacks: &mut Slacks) {
    let all: Vec<_> = tried(AnyPrimitive::DECLARATIONS)
        .par_iter()
        .flat_map_iter(|d| (0..6).map(|seed| (d.name, leaf(d, seed))))
        .filter_map(|(entry, (name, node))| {
            let found = slack(&node, &mut Dice::new(name.len() as u64), THOROUGH, 1.0001);
            found.map(|slack| (entry, slack, name))
        })
        .collect();
    for (entry, slack, name) in all {
        note(slacks, (entry, None), slack, name);
    }
}

/// The slack of a modifier's rule: over a half-space of any direction or a half-plane, or over simple shapes where it takes
/// neither.
fn of_modifier(modifier: &AnyModifier, dice: &mut Dice) -> f64 {
    let corner: [f64; 3] = std::array::from_fn(|_| dice.between(-1.0, 0.0));
    let size: [f64; 3] = std::array::from_fn(|_| dice.between(0.5, 2.0));
    let region = Bounds::new(corner, std::array::from_fn(|i| corner[i] + size[i]));
    let ratio = |node: &Node, place: &[f64]| {
        slope_at(node, point_of(&region, place)) / node.lipschitz_over(region)
    };
    let over_plane = |place: &[f64; 5]| {
        Node::modifier(modifier.clone(), half_space(place[3], place[4], 0.0))
            .or_else(|_| Node::modifier(modifier.clone(), half_plane(place[3])))
            .map_or(f64::NAN, |node| ratio(&node, place))
    };
    let (_, best) = highest(over_plane, dice, THOROUGH, 1.0 / 1.0001);
    let simple = ["sphere", "box", "circle", "rectangle"];
    let simple = leaves(1)
        .into_iter()
        .filter(|(entry, ..)| simple.contains(entry));
    let best = simple.fold(best, |best: f64, (_, _, child)| {
        if best > 1.0 / 1.0001 {
            return best;
        }
        let Ok(node) = Node::modifier(modifier.clone(), child) else {
            return best;
        };
        let (_, found) = highest(
            |place: &[f64; 3]| ratio(&node, place),
            dice,
            THOROUGH,
            1.0 / 1.0001,
        );
        best.max(found)
    });
    1.0 / best.max(0.0)
}

fn of_modifiers(slacks: &mut Slacks) {
    let all: Vec<_> = tried(AnyModifier::DECLARATIONS)
        .par_iter()
        .flat_map_iter(|d| (0..4).map(move |seed| (d, seed)))
        .map(|(d, seed)| {
            let mut dice = Dice::new(seed);
            let arguments = arguments(d, &mut dice);
            let modifier = AnyModifier::from_arguments(d.name, &arguments).expect("listed by name");
            (
                d.name,
                of_modifier(&modifier, &mut dice),
                format!("{modifier:?}"),
            )
        })
        .collect();
    for (entry, slack, name) in all {
        note(slacks, (entry, None), slack, name);
    }
}

/// The slack of a blend's rule: over two half-spaces of any direction, parallel ones among them.
fn of_blend(combination: &Combination, dice: &mut Dice) -> f64 {
    let region = Bounds::centred([1.0; 3]);
    let over_planes = |turn: f64| {
        move |place: &[f64; 6]| {
            let (u, v) = (place[3], place[4]);
            let beside = |x: f64| (x + turn * (place[5] - 0.5)).clamp(0.0, 1.0);
            let children = vec![
                half_space(u, v, 0.0),
                half_space(beside(u), beside(v), 0.4 * (place[5] - 0.5)),
            ];
            Node::combination(combination.clone(), children).map_or(f64::NAN, |node| {
                slope_at(&node, point_of(&region, place)) / node.lipschitz_over(region)
            })
        }
    };
    let best =
        [0.0, 0.1, 1.0].map(|turn| highest(over_planes(turn), dice, THOROUGH, 1.0 / 1.0001).1);
    1.0 / best.into_iter().fold(0.0, f64::max)
}

fn of_blends(slacks: &mut Slacks) {
    let all: Vec<_> = (0..3)
        .into_par_iter()
        .flat_map_iter(|seed| blends(&mut Dice::new(seed)))
        .flat_map_iter(|blend| {
            let uses = operations(&blend);
            uses.into_iter().map(move |operation| Combination {
                operation,
                blend: blend.clone(),
            })
        })
        .map(|combination| {
            let slack = of_blend(&combination, &mut Dice::new(1));
            (combination, slack)
        })
        .collect();
    for (combination, slack) in all {
        let name = format!("{combination:?}");
        note(slacks, (combination.blend.name(), None), slack, name);
    }
}

/// The slack of every modifier over every primitive, the least over some positions: what a rule that knows only the
/// child's constant can't know is that a symmetry of the child makes it less steep.
fn of_pairs(slacks: &mut Slacks) {
    let mut least = Slacks::new();
    for position in [None, Some(1), Some(2), Some(3)] {
        let all: Vec<_> = super::modified_by_entry(position)
            .into_par_iter()
            .enumerate()
            .filter(|(_, (modifier, primitive, ..))| {
                least
                    .get(&(*modifier, Some(*primitive)))
                    .is_none_or(|(slack, _)| *slack > ELSEWHERE)
            })
            .filter_map(|(i, (modifier, primitive, name, node))| {
                let mut dice = Dice::new(i as u64);
                // Once a slack is small, how small does not matter.
                let first = slack(&node, &mut dice, QUICK, ELSEWHERE)?;
                let found = if first > ELSEWHERE {
                    slack(&node, &mut dice, THOROUGH, ELSEWHERE)?
                } else {
                    first
                };
                Some(((modifier, Some(primitive)), found, name))
            })
            .collect();
        for (key, slack, name) in all {
            let entry = least.entry(key).or_insert((f64::INFINITY, String::new()));
            if slack < entry.0 {
                *entry = (slack, name);
            }
        }
    }
    slacks.extend(least);
}

/// All slacks, found once for all tests.
fn slacks() -> &'static Slacks {
    static FOUND: std::sync::OnceLock<Slacks> = std::sync::OnceLock::new();
    FOUND.get_or_init(|| {
        let mut slacks = Slacks::new();
        super::spread(|| {
            of_primitives(&mut slacks);
            of_modifiers(&mut slacks);
            of_blends(&mut slacks);
            of_pairs(&mut slacks);
        });
        slacks
    })
}

#[test]
fn constants_are_not_lazily_large() {
    let slacks = slacks();
    println!("slack of every entry's rule (at most {ATTAINED} unless excepted):");
    for ((entry, over), (slack, _)) in slacks {
        if over.is_none() {
            println!("{entry:>20} {slack:.4}");
        }
    }
    println!("modifiers over primitives that are looser than {ELSEWHERE}:");
    for ((entry, over), (slack, name)) in slacks {
        if let Some(over) = over.filter(|_| *slack > ELSEWHERE) {
            println!("{entry:>20} over {over}: {slack:.2} for {name}");
        }
    }
    let loose: Vec<String> = slacks
        .iter()
        .filter(|((entry, over), (slack, _))| *slack > allowed(entry, *over))
        .map(|((entry, over), (slack, name))| {
            let over = over.map_or(String::new(), |over| format!(" over {over}"));
            format!(
                "{entry}{over}: the constant of {name} is {slack:.3} times the steepest slope found"
            )
        })
        .collect();
    assert!(
        loose.is_empty(),
        "{} are loose:\n{}",
        loose.len(),
        loose.join("\n")
    );
}

#[test]
fn every_exception_is_needed() {
    let slacks = slacks();
    for e in EXCEPTIONS {
        let limit = if e.over.is_none() {
            ATTAINED
        } else {
            ELSEWHERE
        };
        // Entries that are not tried at all say nothing.
        if let Some((slack, _)) = slacks.get(&(e.entry, e.over)) {
            let over = e.over.unwrap_or("itself");
            assert!(
                *slack > limit,
                "{} over {over} has slack {slack:.3}: drop the exception",
                e.entry
            );
            assert!(
                e.slack < 2.0 * slack,
                "{} over {over} needs {slack:.3} only",
                e.entry
            );
        }
    }
    assert!(EXCEPTIONS.iter().all(|e| e.reason.len() > 20));
}
