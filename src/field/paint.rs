//! Which materials a point of the surface shows.
//!
//! A hard union shows the operand whose surface was hit; a blend mixes its operands by its partial derivatives, without
//! their signs and divided by their sum; a cut face shows the tool's material if the tool is painted, else the body's.

use super::{Closure, Level, compile_wide};
use crate::catalogue::{AnyModifier, Combination, Modifier, with_blend, with_modifier};
use crate::num::{Dual, F64x32, Lanes, Number, Vec3};
use crate::scene::{Material, Node, Shape};
use std::cell::Cell;
use std::collections::BTreeMap;
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
    coats(&Single, node, Vec3::splat(p))
        .into_iter()
        .map(|coat| Share {
            material: coat.material,
            weight: coat.weight,
            point: [coat.point.x, coat.point.y, coat.point.z],
        })
        .collect()
}

/// Where values of shapes come from, over numbers `N`.
pub(super) trait Values<N> {
    /// The value of a shape at a point.
    fn value(&self, node: &Node, p: &Vec3<N>) -> N;

    /// Whether a weight is positive anywhere.
    fn counts(&self, weight: N) -> bool;
}

/// From the shapes themselves, one point at a time.
pub(super) struct Single;

impl Values<f64> for Single {
    fn value(&self, node: &Node, p: &Vec3<f64>) -> f64 {
        node.evaluate(p)
    }

    fn counts(&self, weight: f64) -> bool {
        weight > 0.0
    }
}

/// What finds the materials of a shape at many points at a time.
pub struct Brush {
    /// The fields of the shapes below it that decide on materials, by address.
    fields: BTreeMap<usize, Closure<F64x32>>,
}

impl Brush {
    /// The brush of `node`, with the instructions of `level`.
    pub fn new(node: &Node, level: Level) -> Self {
        let mut fields = BTreeMap::new();
        let mut open = vec![node];
        while let Some(node) = open.pop() {
            let asked = match node.shape() {
                Shape::Primitive(_) | Shape::Field(_) => &[],
                Shape::Displacement(displacement) => &displacement.operands[..1],
                Shape::Modifier(_, child) => std::slice::from_ref(child),
                Shape::Combination(_, children) => &children[..],
            };
            let is_moved =
                matches!(node.shape(), Shape::Modifier(modifier, _) if asks_once(modifier));
            for child in asked {
                if !is_moved {
                    let compiled = || compile_wide(child, level);
                    fields.entry(address(child)).or_insert_with(compiled);
                }
                open.push(child);
            }
        }
        Self { fields }
    }

    /// Gives `each` the shares at these points, at most 32, one after the other, with their numbers: as [`shares`], to the bit.
    ///
    /// # Panics
    /// If the node is not that of the brush, or there are no points.
    pub fn shares<'a>(
        &self,
        node: &'a Node,
        points: &[[f64; 3]],
        mut each: impl FnMut(usize, &[Share<'a>]),
    ) {
        // Lanes without a point repeat the first.
        let axis = |k: usize| Lanes::from_fn(|lane| points.get(lane).unwrap_or(&points[0])[k]);
        let coats = coats(self, node, Vec3::new(axis(0), axis(1), axis(2)));
        let mut shares = Vec::with_capacity(coats.len());
        for lane in 0..points.len() {
            shares.clear();
            let seen = coats.iter().filter(|coat| coat.weight.0[lane] > 0.0);
            shares.extend(seen.map(|coat| Share {
                material: coat.material,
                weight: coat.weight.0[lane],
                point: [&coat.point.x, &coat.point.y, &coat.point.z].map(|axis| axis.0[lane]),
            }));
            each(lane, &shares);
        }
    }
}

impl Values<F64x32> for Brush {
    fn value(&self, node: &Node, p: &Vec3<F64x32>) -> F64x32 {
        self.fields[&address(node)](p)
    }

    fn counts(&self, weight: F64x32) -> bool {
        weight.0.iter().any(|weight| *weight > 0.0)
    }
}

fn address(node: &Node) -> usize {
    std::ptr::from_ref(node) as usize
}

/// A share over numbers `N`.
#[derive(Clone, Copy)]
struct Coat<'a, N> {
    material: Option<&'a Arc<Material>>,
    weight: N,
    point: Vec3<N>,
}

/// The shares of `node` at `p`.
fn coats<'a, N: Number>(values: &impl Values<N>, node: &'a Node, p: Vec3<N>) -> Vec<Coat<'a, N>> {
    let unpainted = Coat {
        material: None,
        weight: N::splat(1.0),
        point: p,
    };
    let mut found = Vec::with_capacity(1);
    collect(values, node, p, unpainted, &mut found);
    found
}

/// Adds the shares of `node` at `p`; `outer` is what holds if nothing is painted deeper down, with the weight of this
/// node.
fn collect<'a, N: Number>(
    values: &impl Values<N>,
    node: &'a Node,
    p: Vec3<N>,
    outer: Coat<'a, N>,
    found: &mut Vec<Coat<'a, N>>,
) {
    let here = match node.paint() {
        Some(material) => Coat {
            material: Some(material),
            point: p,
            ..outer
        },
        None => outer,
    };
    match node.shape() {
        Shape::Primitive(_) | Shape::Field(_) => found.push(here),
        Shape::Modifier(modifier, child) => {
            let p = child_point(values, modifier, child, p);
            collect(values, child, p, here, found);
        }
        // The relief moves the surface of the shape, and so its paint.
        Shape::Displacement(displacement) => {
            collect(values, &displacement.operands[0], p, here, found);
        }
        Shape::Combination(combination, children) => {
            let weights = weights(values, combination, children, p);
            for (i, child) in children.iter().enumerate() {
                if !values.counts(weights[i]) {
                    continue;
                }
                let shown = Coat {
                    weight: here.weight * weights[i],
                    ..here
                };
                if combination.is_tool(i) {
                    cut_face(values, [child, &children[0]], p, shown, found);
                } else {
                    collect(values, child, p, shown, found);
                }
            }
        }
    }
}

/// Adds the shares of a face that `tool` cut into `body`.
fn cut_face<'a, N: Number>(
    values: &impl Values<N>,
    [tool, body]: [&'a Node; 2],
    p: Vec3<N>,
    outer: Coat<'a, N>,
    found: &mut Vec<Coat<'a, N>>,
) {
    let mut of_tool = Vec::new();
    let unpainted = Coat {
        material: None,
        ..outer
    };
    collect(values, tool, p, unpainted, &mut of_tool);
    for share in of_tool {
        match share.material {
            Some(_) => found.push(share),
            None => {
                let weight = share.weight;
                collect(values, body, p, Coat { weight, ..outer }, found);
            }
        }
    }
}

/// The shares of a combination's children: its partial derivatives by them, without their signs and divided by their sum.
pub(super) fn weights<N: Number>(
    values: &impl Values<N>,
    combination: &Combination,
    children: &[Arc<Node>],
    p: Vec3<N>,
) -> Vec<N> {
    let mut of_children = children.iter().map(|child| values.value(child, &p));
    let mut joined = of_children.next().expect("a combination has children");
    let mut weights = Vec::with_capacity(children.len());
    weights.push(N::splat(1.0));
    for value in of_children {
        let (a, b) = (Dual::<N, 2>::variable(joined, 0), Dual::variable(value, 1));
        let both =
            with_blend!(&combination.blend, blend => combination.operation.join(blend, a, b));
        joined = both.value;
        weights
            .iter_mut()
            .for_each(|w| *w = *w * both.partial[0].abs());
        weights.push(both.partial[1].abs());
    }
    let zero = N::splat(0.0);
    let sum = weights.iter().fold(zero, |sum, w| sum + *w);
    for (i, weight) in weights.iter_mut().enumerate() {
        // Where no direction is known, the first child stands for all.
        let first = N::splat(if i == 0 { 1.0 } else { 0.0 });
        let share = N::select_lt(sum, N::splat(f64::INFINITY), *weight / sum, first);
        *weight = N::select_lt(zero, sum, share, first);
    }
    weights
}

/// Whether a modifier asks its child at one point, whatever is there: what only moves, turns and scales does.
fn asks_once(modifier: &AnyModifier) -> bool {
    with_modifier!(modifier, m => m.similarity()).is_some()
}

/// The point at which a modifier asks its child; of several, the one where the child's field is smallest.
pub(super) fn child_point<N: Number>(
    values: &impl Values<N>,
    modifier: &AnyModifier,
    child: &Node,
    p: Vec3<N>,
) -> Vec3<N> {
    let nearest = Cell::new((N::splat(f64::INFINITY), p));
    let asks_once = asks_once(modifier);
    let ask = |q: &Vec3<N>| {
        let value = if asks_once {
            N::splat(0.0)
        } else {
            values.value(child, q)
        };
        let (least, at) = nearest.get();
        let nearer = |new: N, old: N| N::select_lt(value, least, new, old);
        let at = Vec3::new(nearer(q.x, at.x), nearer(q.y, at.y), nearer(q.z, at.z));
        nearest.set((nearer(value, least), at));
        value
    };
    with_modifier!(modifier, m => m.apply(&p, ask));
    nearest.get().1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyBlend, AnyPrimitive, Cuboid, Operation, Repeat, Rotate, Smooth, Sphere, Translate,
    };
    use crate::num::samples::Samples;

    const SEED: u64 = 0xb4a5;

    fn painted(node: &Node) -> Arc<Node> {
        node.painted(Arc::default())
    }

    fn ball(radius: f64) -> Arc<Node> {
        Node::primitive(AnyPrimitive::Sphere(Sphere::new(radius))).unwrap()
    }

    fn cube(side: f64) -> Arc<Node> {
        Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([side; 3], 0.0))).unwrap()
    }

    fn modified(modifier: AnyModifier, node: Arc<Node>) -> Arc<Node> {
        Node::modifier(modifier, node).unwrap()
    }

    fn joined(operation: Operation, blend: AnyBlend, children: Vec<Arc<Node>>) -> Arc<Node> {
        Node::combination(Combination { operation, blend }, children).unwrap()
    }

    /// Rows of balls in two paints, blended with a turned cube, from which a bare ball and a painted one are cut.
    fn shape() -> Arc<Node> {
        let aside = |x: f64| AnyModifier::Translate(Translate::new([x, 0.2, 0.0]));
        let balls = joined(
            Operation::Union,
            AnyBlend::HARD,
            vec![
                painted(&ball(0.5)),
                painted(&modified(aside(0.6), ball(0.4))),
            ],
        );
        let rows = AnyModifier::Repeat(Repeat::new([2.0; 3], [2.0; 3]));
        let turn = Rotate::new(0.5, [0.0, 0.0, 1.0], 0.0, 0.3, 0.4);
        let turned = modified(AnyModifier::Rotate(turn), cube(1.2));
        let soft = joined(
            Operation::Union,
            AnyBlend::Smooth(Smooth::new(0.3)),
            vec![modified(rows, balls), painted(&turned), cube(0.7)],
        );
        let tools = vec![soft, ball(0.6), painted(&modified(aside(0.9), ball(0.5)))];
        joined(Operation::Difference, AnyBlend::HARD, tools)
    }

    /// Over lanes, whatever their number, the materials, shares and points are those of single points, to the bit.
    #[test]
    fn brushes_find_the_shares_of_single_points() {
        let node = shape();
        let mut samples = Samples::new(SEED);
        let (mut several, mut materials) = (0, BTreeMap::new());
        for level in [Level::Baseline, Level::best()] {
            let brush = Brush::new(&node, level);
            for round in 0..400 {
                let count = 1 + round % F64x32::WIDTH;
                let points: Vec<[f64; 3]> = (0..count)
                    .map(|_| [0; 3].map(|_| samples.uniform(-1.8, 1.8)))
                    .collect();
                let mut asked = 0;
                brush.shares(&node, &points, |i, found| {
                    assert_eq!(i, asked);
                    asked += 1;
                    let expected = shares(&node, points[i]);
                    assert_eq!(found.len(), expected.len(), "at {:?}", points[i]);
                    several += usize::from(found.len() > 1);
                    for (a, b) in found.iter().zip(&expected) {
                        let address = |share: &Share| share.material.map(Arc::as_ptr);
                        assert_eq!(address(a), address(b));
                        assert_eq!((a.weight, a.point), (b.weight, b.point));
                        *materials.entry(address(a)).or_insert(0) += 1;
                    }
                });
                assert_eq!(asked, count);
            }
        }
        // Four paints, and what is bare.
        assert!(several > 500, "{several}");
        assert!(materials.len() == 5, "{materials:?}");
    }
}
