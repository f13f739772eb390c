//! Laws that every entry of the catalogue obeys, alone and combined with every other.
//!
//! Instances come from the declarations: a new entry is tested without a word here.

mod ascent;
mod blends;
mod implicit;
mod laws;
mod samples;
mod tightness;

use fieldstone::catalogue::Combination;
use fieldstone::scene::Node;
use rayon::prelude::*;
use samples::{Dice, in_space, instances, leaves, modifiers, nodes, placed};
use std::sync::Arc;

/// Runs `law` on many nodes and names the node and seed that break it.
fn for_all(
    nodes: &[(String, Arc<Node>)],
    law: impl Fn(&Node, &mut Dice) -> Result<(), String> + Sync,
) {
    assert!(!nodes.is_empty());
    let broken: Vec<String> = nodes
        .par_iter()
        .enumerate()
        .filter_map(|(i, (name, node))| {
            let mut dice = Dice::new(i as u64);
            law(node, &mut dice)
                .err()
                .map(|why| format!("{name} (seed {i}): {why}"))
        })
        .collect();
    assert!(
        broken.is_empty(),
        "{} of {}:\n{}",
        broken.len(),
        nodes.len(),
        broken[..broken.len().min(12)].join("\n")
    );
}

/// Every primitive with several random parameters, every modifier over every primitive, every combination of pairs,
/// and random trees.
fn zoo() -> Vec<(String, Arc<Node>)> {
    let mut all = instances(4);
    all.extend(modified());
    all.extend(combined());
    all.extend((0..400).filter_map(samples::random_tree));
    all
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

/// Every ordered pair as hard sets and by some of the blends, so that each blend meets all shapes in all its uses.
fn combined() -> Vec<(String, Arc<Node>)> {
    let leaves = instances(1);
    let skip = if leaves.len() < 8 { 1 } else { 12 };
    let mut all = Vec::new();
    for (i, (a_name, a)) in leaves.iter().enumerate() {
        for (j, (b_name, b)) in leaves.iter().enumerate() {
            let mut dice = Dice::new(3000 + (i * leaves.len() + j) as u64);
            let uses = samples::blends(&mut dice).into_iter().flat_map(|blend| {
                samples::operations(&blend)
                    .into_iter()
                    .map(move |o| (o, blend.clone()))
            });
            for (k, (operation, blend)) in uses.enumerate() {
                if !blend.is_hard() && !(i + 5 * j + k).is_multiple_of(skip) {
                    continue;
                }
                let combination = Combination { operation, blend };
                let name = format!("{operation:?}({a_name}, {b_name}, {:?})", combination.blend);
                if let Ok(node) = Node::combination(combination, vec![a.clone(), b.clone()]) {
                    all.push((name, node));
                }
            }
        }
    }
    all
}

#[test]
fn slopes_stay_below_the_lipschitz_constant() {
    for_all(&zoo(), laws::lipschitz);
}

#[test]
fn bounds_hold_the_solid() {
    for_all(&zoo(), laws::bounded);
}

#[test]
fn fields_are_no_larger_than_the_distance() {
    for_all(&instances(3), laws::below_distance);
    for_all(&modified(), laws::below_distance);
    for_all(
        &(0..40).filter_map(samples::random_tree).collect::<Vec<_>>(),
        laws::below_distance,
    );
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
    for_all(&zoo(), laws::gradient);
}

#[test]
fn intervals_contain_samples() {
    for_all(&zoo(), laws::enclosed);
}

#[test]
fn closures_lanes_and_levels_give_the_same_bits() {
    for_all(&instances(2), laws::same_bits);
    for_all(&modified(), laws::same_bits);
    for_all(
        &(0..60).filter_map(samples::random_tree).collect::<Vec<_>>(),
        laws::same_bits,
    );
}

#[test]
fn closures_are_the_walked_tree() {
    for_all(&zoo(), laws::walked);
}

#[test]
fn regional_constants_hold_on_their_region() {
    for_all(&modified(), laws::regional);
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
