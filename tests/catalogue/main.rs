//! Laws that every entry of the catalogue obeys, alone and combined with every other.
//!
//! Instances come from the declarations: a new entry is tested without a word here.

mod ascent;
mod blends;
mod implicit;
mod laws;
mod regressions;
mod samples;
#[path = "../stub/mod.rs"]
mod stub;
mod tightness;
mod trees;

use fieldstone::catalogue::{AnyBlend, Combination, Manner, Operation};
use fieldstone::scene::Node;
use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};
use samples::{Dice, in_space, instances, leaves, modifiers, nodes, placed};
use std::sync::{Arc, OnceLock};

/// Does something on all processors, with stacks that are large enough for deep trees in builds without optimization.
fn spread<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    static POOL: OnceLock<ThreadPool> = OnceLock::new();
    let pool = || {
        let builder = ThreadPoolBuilder::new().stack_size(64 << 20);
        builder.build().expect("threads")
    };
    POOL.get_or_init(pool).install(work)
}

/// Tries cases number 0 to `n`, of which none may say what is wrong.
fn none_is_wrong(n: usize, try_one: impl Fn(usize) -> Option<String> + Sync + Send) {
    assert!(n > 0);
    let wrong: Vec<String> = spread(|| (0..n).into_par_iter().filter_map(try_one).collect());
    let first = wrong[..wrong.len().min(12)].join("\n");
    assert!(wrong.is_empty(), "{} of {n}:\n{first}", wrong.len());
}

/// Runs `law` on many nodes and names the node and seed that break it.
fn for_all(
    nodes: &[(String, Arc<Node>)],
    law: impl Fn(&Node, &mut Dice) -> Result<(), String> + Sync,
) {
    none_is_wrong(nodes.len(), |i| {
        let (name, node) = &nodes[i];
        let why = law(node, &mut Dice::new(i as u64)).err()?;
        Some(format!("{name} (seed {i}): {why}"))
    });
}

/// Every primitive with several random parameters, and every modifier over every primitive.
fn zoo() -> Vec<(String, Arc<Node>)> {
    let mut all = instances(4);
    all.extend(modified());
    all
}

/// Random trees by their seeds.
fn trees(seeds: std::ops::Range<u64>) -> Vec<(String, Arc<Node>)> {
    spread(|| seeds.into_par_iter().map(trees::random_tree).collect())
}

fn modified() -> Vec<(String, Arc<Node>)> {
    let all = modified_by_entry(None).into_iter();
    all.map(|(_, _, name, node)| (name, node)).collect()
}

/// Every modifier over every primitive that it takes, with the names of both entries. A profile is modified as it is,
/// and extruded. With a seed, the primitive is turned and moved at random first: in general position it has no symmetry
/// that the modifier could keep.
fn modified_by_entry(
    position: Option<u64>,
) -> Vec<(&'static str, &'static str, String, Arc<Node>)> {
    let mut all = Vec::new();
    for (primitive, name, leaf) in leaves(1) {
        let mut dice = Dice::new(samples::seed_of(primitive));
        let height = dice.between(0.2, 1.0);
        let place = |node: Arc<Node>| match position {
            Some(seed) => placed(node, &mut Dice::new(seed)),
            None => node,
        };
        for modifier in modifiers(&mut dice) {
            let mut add = |child: &Arc<Node>, name: String| {
                if let Ok(whole) = Node::modifier(modifier.clone(), child.clone()) {
                    let entry = modifier.declaration().name;
                    all.push((entry, primitive, name, in_space(whole, height)));
                }
            };
            add(&place(leaf.clone()), format!("{name}.{modifier:?}"));
            if leaf.traits().is_planar {
                let solid = place(in_space(leaf.clone(), height));
                add(&solid, format!("{name}.extrude({height}).{modifier:?}"));
            }
        }
    }
    all
}

/// What is quick to check of a node, with few samples: there are many.
fn cheap_laws(node: &Node, dice: &mut Dice) -> Result<(), String> {
    laws::lipschitz(node, dice, 12)?;
    laws::bounded(node, dice, 10)?;
    laws::gradient(node, dice, 1)?;
    laws::enclosed(node, dice, 2)
}

/// Whether the order of two shapes does not matter.
fn is_even(blend: &AnyBlend, operation: Operation) -> bool {
    blend.manner() == Manner::Seam && operation != Operation::Difference
}

/// Every operation with every blend on every pair of primitives. Where the order does not matter, each pair once.
#[test]
fn every_combination_of_every_pair_obeys_the_cheap_laws() {
    let leaves = instances(1);
    let n = leaves.len();
    none_is_wrong(n * n, |pair| {
        let mut dice = Dice::new(pair as u64);
        let (i, j) = (pair / n, pair % n);
        let [(a_name, a), (b_name, b)] = [&leaves[i], &leaves[j]];
        samples::blends(&mut dice).iter().find_map(|blend| {
            samples::operations(blend)
                .into_iter()
                .find_map(|operation| {
                    if is_even(blend, operation) && i > j {
                        return None;
                    }
                    let combination = Combination {
                        operation,
                        blend: blend.clone(),
                    };
                    let why = Node::combination(combination, vec![a.clone(), b.clone()])
                        .map_err(|fault| fault.message)
                        .and_then(|node| cheap_laws(&node, &mut dice))
                        .err()?;
                    Some(format!(
                        "{operation:?}({a_name}, {b_name}, {blend:?}): {why}"
                    ))
                })
        })
    });
}

/// How many random trees are tried; their seeds are 0, 1, 2, ...
const TREES: u64 = 10_000;

#[test]
fn ten_thousand_random_trees_obey_the_cheap_laws() {
    none_is_wrong(TREES as usize, |seed| {
        let (words, node) = trees::random_tree(seed as u64);
        let mut dice = Dice::new(seed as u64);
        let why = cheap_laws(&node, &mut dice)
            .and_then(|()| laws::regional(&node, &mut dice, 4))
            .err()?;
        Some(format!("{words}\n  {why}"))
    });
}

#[test]
fn slopes_stay_below_the_lipschitz_constant() {
    for_all(&zoo(), |node, dice| laws::lipschitz(node, dice, 120));
}

#[test]
fn bounds_hold_the_solid() {
    for_all(&zoo(), |node, dice| laws::bounded(node, dice, 300));
}

#[test]
fn fields_are_no_larger_than_the_distance() {
    for_all(&instances(3), |node, dice| {
        laws::below_distance(node, dice, 200)
    });
    for_all(&modified(), |node, dice| {
        laws::below_distance(node, dice, 40)
    });
    for_all(&trees(0..300), |node, dice| {
        laws::below_distance(node, dice, 40)
    });
}

#[test]
fn exact_fields_are_the_distance() {
    let exact = |all: Vec<(String, Arc<Node>)>| -> Vec<(String, Arc<Node>)> {
        all.into_iter()
            .filter(|(_, n)| n.class() == fieldstone::catalogue::Class::Exact)
            .collect()
    };
    for_all(&exact(instances(3)), laws::exact);
    for_all(&exact(modified()), laws::exact);
}

#[test]
fn gradients_are_differences() {
    for_all(&zoo(), |node, dice| laws::gradient(node, dice, 30));
}

#[test]
fn intervals_contain_samples() {
    for_all(&zoo(), |node, dice| laws::enclosed(node, dice, 21));
}

#[test]
fn closures_lanes_and_levels_give_the_same_bits() {
    for_all(&instances(2), laws::same_bits);
    for_all(&modified(), laws::same_bits);
    for_all(&trees(0..100), laws::same_bits);
}

#[test]
fn closures_are_the_walked_tree() {
    for_all(&zoo(), |node, dice| laws::walked(node, dice, 20));
    for_all(&trees(0..300), |node, dice| laws::walked(node, dice, 20));
}

#[test]
fn regional_constants_hold_on_their_region() {
    for_all(&zoo(), |node, dice| laws::regional(node, dice, 30));
}

#[test]
fn every_declaration_is_complete() {
    for declaration in samples::declarations() {
        let name = declaration.name;
        assert!(
            declaration.summary.trim().ends_with('.'),
            "{name}: {}",
            declaration.summary
        );
        assert!(
            !declaration.source.is_empty() && declaration.example.contains(name),
            "{name}"
        );
        for parameter in declaration.parameters {
            assert!(parameter.summary.len() > 10, "{name}.{}", parameter.name);
        }
    }
    let mut names: Vec<_> = samples::declarations().map(|d| d.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count, "two entries share a name");
}

#[test]
fn boxes_of_modified_shapes_are_tight() {
    let mut broken = Vec::new();
    for seed in 0..4 {
        let mut dice = Dice::new(seed);
        for modifier in modifiers(&mut dice) {
            if let Err(why) = laws::touched(&modifier, &mut dice) {
                broken.push(format!("{modifier:?} (seed {seed}): {why}"));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn copies_around_an_axis_are_what_a_union_shows() {
    for_all(&nodes(), laws::polar_is_union);
}

#[test]
fn mirrored_copies_are_reflections() {
    for_all(&nodes(), laws::mirrored_is_reflected);
}

#[test]
fn repeated_copies_are_what_a_union_shows() {
    for_all(&nodes(), laws::repeated_is_union);
}
