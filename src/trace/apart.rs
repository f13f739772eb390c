//! Soft unions whose operands lie too far apart to blend fall apart into hard unions, each part with a path of its own.
//!
//! Let k be the width of a seam: where two fields differ by k, their union is the smaller of them, to the bit, and a fold lies at
//! most k below the least of its operands. Take a point where some operand is at most k, and where no more than n operands are at
//! most T = (2 n + 2) k. Between k and T there is a gap of 2 k in which no value lies. What is folded above the gap stays
//! more than k above the first value below it, which therefore takes its place; and what comes later from above changes nothing. So
//! the union is that of the operands below T alone, to the bit, and of any others with them. Where no operand is at most k, the union is
//! positive, and so is that of some of them. So operands that are in one group if one can be at most k where the other is at
//! most T leave nothing inside and nothing at the surface changed when the groups go their own ways.

use crate::catalogue::{Bounds, Combination, Operation};
use crate::scene::Node;
use std::collections::BTreeMap;
use std::sync::Arc;

/// More operands than this are not compared with one another.
const MOST: usize = 1024;

/// Where more operands than this may blend, it is not asked which.
const CROWD: usize = 16;

/// The operands of a soft union in groups that do not blend with one another, in order; none where all blend, or where that is
/// not known.
pub(super) fn groups(
    combination: &Combination,
    operands: &[Arc<Node>],
) -> Option<Vec<Vec<Arc<Node>>>> {
    let width = combination.blend.width()?;
    let is_soft = combination.operation == Operation::Union && !combination.blend.is_hard();
    let count = operands.len();
    // How far graphs reach takes long to find.
    let is_told = (2..=MOST).contains(&count) && !operands.iter().any(|node| node.has_graph());
    if !is_soft || !is_told {
        return None;
    }
    let within =
        |level: f64| -> Vec<Bounds> { operands.iter().map(|node| node.sublevel(level)).collect() };
    let near = within(width);
    // Where operands are at most T, for each n.
    let mut far: BTreeMap<usize, Vec<Bounds>> = BTreeMap::new();
    let mut group: Vec<usize> = (0..count).collect();
    for (i, near) in near.iter().enumerate() {
        let mut n = 1;
        let others = loop {
            let far = far
                .entry(n)
                .or_insert_with(|| within((2 * n + 2) as f64 * width));
            let is_met = |j: &usize| *j != i && !near.intersect(far[*j]).is_empty();
            let others: Vec<usize> = (0..count).filter(is_met).collect();
            if others.len() < n {
                break others;
            }
            n = others.len() + 1;
            if n > CROWD {
                return None;
            }
        };
        for j in others {
            let (kept, gone) = (group[i].min(group[j]), group[i].max(group[j]));
            if kept != gone {
                let gone = group.iter_mut().filter(|g| **g == gone);
                gone.for_each(|g| *g = kept);
            }
        }
    }
    if group.iter().all(|g| *g == 0) {
        return None;
    }
    let mut groups: BTreeMap<usize, Vec<Arc<Node>>> = BTreeMap::new();
    for (node, g) in operands.iter().zip(group) {
        groups.entry(g).or_default().push(node.clone());
    }
    Some(groups.into_values().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyBlend, AnyModifier, AnyPrimitive};
    use crate::catalogue::{Circular, Cubic, Smooth, Sphere, Translate};
    use crate::num::Vec3;
    use crate::num::samples::random;

    fn place(seed: u64, size: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| size * (2.0 * random(seed * 3 + k) - 1.0))
    }

    fn ball(seed: u64) -> Arc<Node> {
        let sphere = Sphere::new(0.1 + 0.3 * random(seed));
        let node = Node::primitive(AnyPrimitive::Sphere(sphere)).unwrap();
        let shift = AnyModifier::Translate(Translate::new(place(seed + 99, 3.0)));
        Node::modifier(shift, node).unwrap()
    }

    fn united(blend: &AnyBlend, nodes: &[Arc<Node>]) -> (Combination, Arc<Node>) {
        let combination = Combination {
            operation: Operation::Union,
            blend: blend.clone(),
        };
        let node = match nodes {
            [node] => node.clone(),
            _ => Node::combination(combination.clone(), nodes.to_vec()).unwrap(),
        };
        (combination, node)
    }

    #[test]
    fn groups_have_the_bits_of_the_whole_where_it_counts() {
        let (mut near, mut most, mut apart) = (0, 0, 0);
        for seed in 0..120u64 {
            let width = [0.02, 0.05, 0.1, 0.2][seed as usize % 4];
            let blend = match seed % 3 {
                0 => AnyBlend::Smooth(Smooth::new(width)),
                1 => AnyBlend::Cubic(Cubic::new(width)),
                _ => AnyBlend::Circular(Circular::new(width)),
            };
            let balls: Vec<Arc<Node>> = (0..16).map(|i| ball(seed * 100 + i)).collect();
            let (combination, whole) = united(&blend, &balls);
            let Some(groups) = groups(&combination, &balls) else {
                continue;
            };
            apart += 1;
            most = most.max(groups.iter().map(Vec::len).max().unwrap());
            let kept: usize = groups.iter().map(Vec::len).sum();
            assert_eq!(kept, balls.len());
            let groups: Vec<Arc<Node>> = groups.iter().map(|g| united(&blend, g).1).collect();
            for k in 0..400 {
                // Near the surface of some ball, on either side.
                let centre = place(seed * 100 + k % 16 + 99, 3.0);
                let way = place(seed * 1000 + k, 0.5);
                let p = [0, 1, 2].map(|i| centre[i] + way[i]);
                let expected: f64 = whole.evaluate(&Vec3::new(p[0], p[1], p[2]));
                let found = groups
                    .iter()
                    .map(|g| g.evaluate(&Vec3::new(p[0], p[1], p[2])));
                let found = found.fold(f64::INFINITY, f64::min);
                let least = balls
                    .iter()
                    .map(|b| b.evaluate(&Vec3::new(p[0], p[1], p[2])));
                if least.fold(f64::INFINITY, f64::min) <= width {
                    near += 1;
                    assert_eq!(found, expected, "seed {seed} at {p:?}");
                } else {
                    assert!(found > 0.0 && expected > 0.0);
                }
            }
        }
        assert!(
            near > 5_000 && most > 3 && apart > 60,
            "{near} {most} {apart}"
        );
    }

    #[test]
    fn what_blends_stays_together() {
        let at = |x: f64| {
            let node = Node::primitive(AnyPrimitive::Sphere(Sphere::new(0.5))).unwrap();
            let shift = AnyModifier::Translate(Translate::new([x, 0.0, 0.0]));
            Node::modifier(shift, node).unwrap()
        };
        let sizes = |k: f64, places: &[f64]| {
            let nodes: Vec<Arc<Node>> = places.iter().map(|x| at(*x)).collect();
            let (combination, _) = united(&AnyBlend::Smooth(Smooth::new(k)), &nodes);
            groups(&combination, &nodes).map(|g| g.iter().map(Vec::len).collect::<Vec<_>>())
        };
        // Surfaces 0.1 apart blend over 0.2, and so may those that are less than 5 k apart.
        assert_eq!(sizes(0.2, &[0.0, 1.1]), None);
        assert_eq!(sizes(0.1, &[0.0, 1.4]), None);
        assert_eq!(sizes(0.1, &[0.0, 1.6]), Some(vec![1, 1]));
        // Where there is one more, it may be 7 k.
        assert_eq!(sizes(0.1, &[0.0, 1.0, 2.6]), None);
        assert_eq!(sizes(0.1, &[0.0, 1.0, 2.8, 9.0]), Some(vec![2, 1, 1]));
        assert_eq!(sizes(0.0, &[0.0, 9.0]), None);
    }
}
