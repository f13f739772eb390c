//! Which node has a Lipschitz constant that is too small, given two points at which the whole changes too much.

use super::{Node, Shape};
use crate::catalogue::{Bounds, Modifier, with_modifier};
use crate::num::Vec3;
use std::cell::RefCell;
use std::sync::Arc;

/// A node, and two points between which its field changes by more than its constant allows.
#[derive(Clone, Copy, Debug)]
pub struct Blame<'a> {
    /// The node.
    pub node: &'a Node,
    /// The deepest node on the way to it, or itself, whose place in the script is known.
    pub placed: Option<&'a Node>,
    /// The points, in the coordinates of the node.
    pub points: [[f64; 3]; 2],
    /// The field of the node there.
    pub values: [f64; 2],
    /// The constant that they refute.
    pub constant: f64,
}

impl Node {
    /// The innermost node whose own constant is refuted when this one is asked at two points of `region`; none where no
    /// constant is, up to rounding. Below a user's field nothing is looked at: its constant is one for the whole.
    pub fn blamed(&self, region: Bounds, points: [[f64; 3]; 2]) -> Option<Blame<'_>> {
        let values = points.map(|p| self.evaluate(&Vec3::splat(p)));
        let constant = self.lipschitz_over(region);
        if !is_refuted(points, values, constant) {
            return None;
        }
        let inner = match self.shape() {
            Shape::Primitive(_) | Shape::Field(_) => None,
            Shape::Combination(_, children) => first_blamed(children, region, points),
            Shape::Displacement(d) => first_blamed(&d.operands, region, points),
            Shape::Modifier(modifier, child) => {
                let asked = points.map(|p| {
                    let asked = RefCell::new(Vec::new());
                    with_modifier!(modifier, m => m.apply(&Vec3::splat(p), |q: &Vec3<f64>| {
                        asked.borrow_mut().push([q.x, q.y, q.z]);
                        child.evaluate(q)
                    }));
                    asked.into_inner()
                });
                let inside = with_modifier!(modifier, m => m.domain(region));
                let mut pairs = asked[0].iter().zip(&asked[1]);
                pairs.find_map(|(a, b)| child.blamed(inside, [*a, *b]))
            }
        };
        let own = self.place().map(|_| self);
        Some(match inner {
            Some(inner) => Blame {
                placed: inner.placed.or(own),
                ..inner
            },
            None => Blame {
                node: self,
                placed: own,
                points,
                values,
                constant,
            },
        })
    }

    /// Whether the constant of the node, or of any below it, rests on a claim.
    pub fn rests_on_claim(&self) -> bool {
        let claims = matches!(self.shape(), Shape::Field(field) if field.claimed.is_some());
        claims || self.children().iter().any(|child| child.rests_on_claim())
    }
}

fn first_blamed<'a>(
    children: &'a [Arc<Node>],
    region: Bounds,
    points: [[f64; 3]; 2],
) -> Option<Blame<'a>> {
    let mut children = children.iter();
    children.find_map(|child| child.blamed(region, points))
}

/// Whether a field changes by more between two points than a constant allows, and than rounding explains.
fn is_refuted(points: [[f64; 3]; 2], values: [f64; 2], constant: f64) -> bool {
    let [a, b] = points;
    let apart = (0..3).fold(0.0, |n: f64, i| n.hypot(b[i] - a[i]));
    let size = a.iter().chain(&b).fold(0.0, |n: f64, c| n.max(c.abs()));
    let noise = 64.0 * f64::EPSILON * size * constant;
    (values[1] - values[0]).abs() > constant * apart * (1.0 + 1e-9) + noise
}

#[cfg(test)]
mod tests {
    use super::super::{FieldShape, GraphBuilder};
    use super::*;
    use crate::catalogue::{
        AnyBlend, AnyModifier, AnyPrimitive, Combination, Operation, Smooth, Sphere, Translate,
    };

    /// f = 3 x, claimed to have constant `claimed`.
    fn ramp(claimed: f64) -> Arc<Node> {
        let mut b = GraphBuilder::new();
        let [x, ..] = b.point();
        let three = b.constant(3.0);
        let f = b.multiply(three, x);
        Node::field(FieldShape {
            name: "ramp".into(),
            graph: Arc::new(b.finish(&[f])),
            claimed: Some(claimed),
        })
        .unwrap()
    }

    #[test]
    fn the_claim_inside_of_a_moved_blend_is_to_blame() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let blend = Combination {
            operation: Operation::Union,
            blend: AnyBlend::Smooth(Smooth::new(0.5)),
        };
        let both = Node::combination(blend, vec![ball, ramp(2.0)]).unwrap();
        let moved = AnyModifier::Translate(Translate::new([0.0, 10.0, 0.0]));
        let moved = Node::modifier(moved, both).unwrap();
        let points = [[-5.0, 10.0, 0.0], [-4.0, 10.0, 0.0]];
        let blame = moved.blamed(Bounds::EVERYWHERE, points).unwrap();
        assert_eq!(blame.node.kind(), "ramp");
        assert_eq!(blame.points, [[-5.0, 0.0, 0.0], [-4.0, 0.0, 0.0]]);
        assert_eq!((blame.values, blame.constant), ([-15.0, -12.0], 2.0));
        assert!(moved.rests_on_claim());
    }

    #[test]
    fn a_right_constant_is_not_to_blame() {
        let points = [[-5.0, 0.0, 0.0], [7.0, 0.0, 0.0]];
        assert!(ramp(3.0).blamed(Bounds::EVERYWHERE, points).is_none());
    }
}
