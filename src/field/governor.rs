//! Which leaf has most say on a field at a point.

use super::paint::{Single, child_point, weights};
use crate::num::Vec3;
use crate::scene::{Node, Shape};
use std::sync::Arc;

/// The leaf of `node` that governs its field at `p`, and the deepest node on the way to it whose place in the script is
/// known: down the tree, the child by which the field changes most, and under a modifier the point that it asks.
pub fn governor(node: &Node, p: [f64; 3]) -> (&Node, Option<&Node>) {
    let (mut node, mut p) = (node, Vec3::splat(p));
    let mut placed = None;
    loop {
        placed = node.place().map(|_| node).or(placed);
        node = match node.shape() {
            Shape::Primitive(_) | Shape::Field(_) => return (node, placed),
            Shape::Displacement(displacement) => &displacement.operands[0],
            Shape::Modifier(modifier, child) => {
                p = child_point(&Single, modifier, child, p);
                child
            }
            Shape::Combination(combination, children) => {
                let weights = weights(&Single, combination, children, p);
                heaviest(children, &weights)
            }
        };
    }
}

/// The child with the largest weight; of several, the first.
fn heaviest<'a>(children: &'a [Arc<Node>], weights: &[f64]) -> &'a Node {
    let mut best = 0;
    for (i, weight) in weights.iter().enumerate() {
        if *weight > weights[best] {
            best = i;
        }
    }
    &children[best]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid, Operation, Repeat, Smooth,
        Sphere, Translate,
    };

    fn at(x: f64, node: Arc<Node>) -> Arc<Node> {
        Node::modifier(AnyModifier::Translate(Translate::new([x, 0.0, 0.0])), node).unwrap()
    }

    fn both(operation: Operation, blend: AnyBlend, a: Arc<Node>, b: Arc<Node>) -> Arc<Node> {
        Node::combination(Combination { operation, blend }, vec![a, b]).unwrap()
    }

    fn ball() -> Arc<Node> {
        Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap()
    }

    fn cube() -> Arc<Node> {
        Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([1.0; 3], 0.0))).unwrap()
    }

    #[test]
    fn nearest_child_of_a_union_governs() {
        for blend in [AnyBlend::HARD, AnyBlend::Smooth(Smooth::new(0.5))] {
            let pair = both(Operation::Union, blend, at(-2.0, ball()), at(2.0, cube()));
            assert_eq!(governor(&pair, [-3.5, 0.0, 0.0]).0.kind(), "sphere");
            assert_eq!(governor(&pair, [3.5, 0.0, 0.0]).0.kind(), "box");
        }
    }

    #[test]
    fn tool_of_a_difference_governs_its_face() {
        let cut = both(
            Operation::Difference,
            AnyBlend::HARD,
            cube(),
            at(0.5, ball()),
        );
        // The ball takes all of the cube but its two corners to the left, from x = -0.5 on at the height of its middle.
        assert_eq!(governor(&cut, [-0.3, 0.0, 0.0]).0.kind(), "sphere");
        assert_eq!(governor(&cut, [-0.5, 0.45, 0.45]).0.kind(), "box");
    }

    #[test]
    fn copies_are_asked_where_they_stand() {
        let pair = both(
            Operation::Union,
            AnyBlend::HARD,
            at(-1.0, ball()),
            at(1.0, cube()),
        );
        let row = Node::modifier(
            AnyModifier::Repeat(Repeat::new([8.0, 8.0, 8.0], [f64::INFINITY; 3])),
            pair,
        );
        let row = row.unwrap();
        assert_eq!(governor(&row, [16.0 - 2.2, 0.0, 0.0]).0.kind(), "sphere");
        assert_eq!(governor(&row, [16.0 + 1.7, 0.0, 0.0]).0.kind(), "box");
    }
}
