//! Surfaces that a field moves: displaced shapes, and ground of a field's height.

use super::arguments::Given;
use super::ast::RoutineKind;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::catalogue::{AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid};
use crate::catalogue::{Operation, Translate};
use crate::num::{Interval, Number, Vec3};
use crate::scene::{Fault, FieldShape, GraphBuilder, Node, Shape};
use std::sync::Arc;

/// How many pieces along each side the range of a height is looked for in.
const PIECES: usize = 16;

impl<'a> Machine<'a> {
    /// `shape.displace(field)`; of a list, each shape in it.
    pub fn displace(
        &mut self,
        value: &Value,
        span: Span,
        field: &Given<'a>,
        at: Span,
    ) -> Eval<Value> {
        if let Value::List(list) = value {
            let displaced = list
                .items
                .iter()
                .map(|item| self.displace(item, span, field, at))
                .collect::<Eval<Vec<_>>>()?;
            return self.listed(displaced, at);
        }
        let shape = self.shape(value, span)?;
        let relief = self.relief(field, "displace")?;
        self.node(Node::displacement(shape, relief), field.span)
    }

    /// `heightfield(field, size: [2, 2], base: ...)`; without a base, a tenth of the size below the lowest point.
    pub fn heightfield(
        &mut self,
        field: &Given<'a>,
        size: Option<Given<'a>>,
        base: Option<Given<'a>>,
        at: Span,
    ) -> Eval<Value> {
        let size = match size {
            None => [2.0, 2.0],
            Some(given) => match given.value {
                Value::Vector2(v) if v.iter().all(|s| *s > 0.0 && s.is_finite()) => v,
                Value::Vector2(_) => {
                    let message = "`size` of `heightfield` must be positive";
                    let error = Diagnostic::error(given.span, message).label(given.value.shown());
                    return self.fail(error);
                }
                _ => return self.unfit(&given, "heightfield", "a size [x, z]"),
            },
        };
        let relief = self.relief(field, "heightfield")?;
        self.tick(PIECES.pow(2) as u64 * relief.size() / 4, at)?;
        let heights = heights(&relief, size);
        if heights.magnitude() == f64::INFINITY {
            let message = "the heights of this field have no bounds over the size of the ground";
            let error = Diagnostic::error(field.span, message);
            return self.fail(error.help("hold them between limits, as in `clamp(h, 0, 1)`"));
        }
        let base = match base {
            None => heights.lo - 0.1 * size[0].max(size[1]),
            Some(given) => match given.value {
                Value::Number(y) if y < heights.hi && y.is_finite() => y,
                Value::Number(_) => {
                    let message = "`base` of `heightfield` must lie below the ground";
                    let error = Diagnostic::error(given.span, message).label(given.value.shown());
                    return self.fail(error);
                }
                _ => return self.unfit(&given, "heightfield", "a number"),
            },
        };
        let ground = Node::field(below(&relief));
        let block = block(size, [base, heights.hi]);
        let both = ground.and_then(|ground| {
            let combination = Combination {
                operation: Operation::Intersection,
                blend: AnyBlend::HARD,
            };
            Node::combination(combination, vec![ground, block?])
        });
        self.node(both, at)
    }

    fn node(&mut self, made: Result<Arc<Node>, Fault>, at: Span) -> Eval<Value> {
        match made {
            Ok(node) => self.made(node, at),
            Err(fault) => self.fault(fault, at),
        }
    }

    /// The field that an argument names or calls.
    fn relief(&mut self, given: &Given<'a>, callee: &str) -> Eval<Arc<Node>> {
        match &given.value {
            Value::Routine(RoutineKind::Field, id) => self.field_shape(*id, given.span),
            Value::Shape(node) if matches!(node.shape(), Shape::Field(_)) => Ok(node.clone()),
            _ => {
                let message = format!(
                    "`{callee}` expects a field, but this is {}",
                    given.value.noun()
                );
                let error = Diagnostic::error(given.span, message).label(given.value.shown());
                self.fail(error.help(
                    "write it as a statement, `field f(p) { return 0.1 * sin(9 * p.x) }`, and pass `f`",
                ))
            }
        }
    }
}

/// The range of the field over the rectangle of this size in the plane y = 0, piece by piece.
fn heights(field: &Node, size: [f64; 2]) -> Interval {
    let side = |length: f64, i: usize| {
        let end = |i: usize| length * (i as f64 / PIECES as f64 - 0.5);
        Interval::new(end(i), end(i + 1))
    };
    let mut all: Option<Interval> = None;
    for i in 0..PIECES {
        for k in 0..PIECES {
            let (x, z) = (side(size[0], i), side(size[1], k));
            let here: Interval = field.evaluate(&Vec3::new(x, Interval::splat(0.0), z));
            all = Some(all.map_or(here, |range| range.hull(here)));
        }
    }
    all.unwrap_or(Interval::ENTIRE)
}

/// The field y - height(x, 0, z).
fn below(height: &Arc<Node>) -> FieldShape {
    let mut builder = GraphBuilder::new();
    let [x, y, z] = builder.point();
    let ground = builder.constant(0.0);
    let height = builder.shape(height, [x, ground, z]);
    let field = builder.subtract(y, height);
    FieldShape {
        name: "heightfield".into(),
        graph: builder.finish(&[field]).into(),
        claimed: None,
    }
}

/// The block of this size along x and z between two heights, with room for rounding above.
fn block(size: [f64; 2], [low, high]: [f64; 2]) -> Result<Arc<Node>, Fault> {
    let high = high + 1e-9 * (high - low);
    let cuboid = Cuboid::new([size[0], high - low, size[1]], 0.0);
    let cuboid = Node::primitive(AnyPrimitive::Cuboid(cuboid))?;
    let moved = Translate::new([0.0, 0.5 * (low + high), 0.0]);
    Node::modifier(AnyModifier::Translate(moved), cuboid)
}
