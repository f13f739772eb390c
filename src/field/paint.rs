//! Which materials a point of the surface shows.
//!
//! A hard union shows the operand whose surface was hit; a blend mixes its operands by its partial derivatives, without
//! their signs and divided by their sum; a cut face shows the tool's material if the tool is painted, else the body's.

use crate::catalogue::{AnyModifier, Combination, Modifier, with_blend, with_modifier};
use crate::num::{Dual, Vec3};
use crate::scene::{Material, Node, Shape};
use std::cell::Cell;
use std::sync::Arc;

/// A material, its share, and the point in the coordinates of the shape that was painted with it.
#[derive(Clone, Copy, Debug)]
pub struct Share<'a> {
    /// The material; none where nothing is painted.
    pub material: Option<&'a Arc<Material>>,
    /// Its share; the shares of a point sum to 1.
    pub weight: f64,
    /// The point that patterns are evaluated at.
    pub point: [f64; 3],
}

/// The materials of `node` at the surface point `p`.
pub fn shares(node: &Node, p: [f64; 3]) -> Vec<Share<'_>> {
    let unpainted = Share {
        material: None,
        weight: 1.0,
        point: p,
    };
    let mut found = Vec::with_capacity(1);
    collect(node, p, unpainted, &mut found);
    found
}

/// Adds the shares of `node` at `p`; `outer` is what holds if nothing is painted deeper down, with the weight of this
/// node.
fn collect<'a>(node: &'a Node, p: [f64; 3], outer: Share<'a>, found: &mut Vec<Share<'a>>) {
    let here = match node.paint() {
        Some(material) => Share {
            material: Some(material),
            point: p,
            ..outer
        },
        None => outer,
    };
    match node.shape() {
        Shape::Primitive(_) | Shape::Field(_) => found.push(here),
        Shape::Modifier(modifier, child) => {
            collect(child, child_point(modifier, child, p), here, found)
        }
        // The relief moves the surface of the shape, and so its paint.
        Shape::Displacement(displacement) => collect(&displacement.operands[0], p, here, found),
        Shape::Combination(combination, children) => {
            let weights = weights(combination, children, p);
            let shown = |i: usize| Share {
                weight: here.weight * weights[i],
                ..here
            };
            for (i, child) in children
                .iter()
                .enumerate()
                .filter(|(i, _)| weights[*i] > 0.0)
            {
                if combination.is_tool(i) {
                    cut_face(child, &children[0], p, shown(i), found);
                } else {
                    collect(child, p, shown(i), found);
                }
            }
        }
    }
}

/// Adds the shares of a face that `tool` cut into `body`.
fn cut_face<'a>(
    tool: &'a Node,
    body: &'a Node,
    p: [f64; 3],
    outer: Share<'a>,
    found: &mut Vec<Share<'a>>,
) {
    let mut of_tool = Vec::new();
    collect(
        tool,
        p,
        Share {
            material: None,
            ..outer
        },
        &mut of_tool,
    );
    for share in of_tool {
        match share.material {
            Some(_) => found.push(share),
            None => collect(
                body,
                p,
                Share {
                    weight: share.weight,
                    ..outer
                },
                found,
            ),
        }
    }
}

/// The shares of a combination's children: its partial derivatives by them, without their signs and divided by their sum.
pub(super) fn weights(combination: &Combination, children: &[Arc<Node>], p: [f64; 3]) -> Vec<f64> {
    let point = Vec3::splat(p);
    let mut values = children.iter().map(|c| c.evaluate::<f64>(&point));
    let mut joined = values.next().expect("a combination has children");
    let mut weights = vec![1.0];
    for value in values {
        let (a, b) = (
            Dual::<f64, 2>::variable(joined, 0),
            Dual::variable(value, 1),
        );
        let both =
            with_blend!(&combination.blend, blend => combination.operation.join(blend, a, b));
        joined = both.value;
        weights.iter_mut().for_each(|w| *w *= both.partial[0].abs());
        weights.push(both.partial[1].abs());
    }
    let sum: f64 = weights.iter().sum();
    if sum > 0.0 && sum.is_finite() {
        weights.iter_mut().for_each(|w| *w /= sum);
    } else {
        // No direction is known: the first child stands for all.
        weights.fill(0.0);
        weights[0] = 1.0;
    }
    weights
}

/// The point at which a modifier asks its child; of several, the one where the child's field is smallest.
pub(super) fn child_point(modifier: &AnyModifier, child: &Node, p: [f64; 3]) -> [f64; 3] {
    let nearest = Cell::new((f64::INFINITY, p));
    let ask = |q: &Vec3<f64>| {
        let value = child.evaluate(q);
        if value < nearest.get().0 {
            nearest.set((value, [q.x, q.y, q.z]));
        }
        value
    };
    with_modifier!(modifier, m => m.apply(&Vec3::splat(p), ask));
    nearest.get().1
}
