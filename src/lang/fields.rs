//! Fields and patterns of the script: run once with a symbolic point, they give a graph.

use super::arguments::Given;
use super::ast::{GlobalId, RoutineKind};
use super::limits::MAX_LIST_DEPTH;
use super::machine::{Eval, Machine};
use super::numeric::Arithmetic;
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::value::{Form, Pattern, PatternKind, Quantity, Scalar, Value};
use crate::catalogue::Function;
use crate::scene::{FieldShape, Graph, GraphBuilder, Node, Shape};
use std::sync::Arc;

impl<'a> Machine<'a> {
    /// A call of a field: with a point its value there, without one a shape.
    pub fn call_field(&mut self, id: GlobalId, at: Span, given: Vec<Given<'a>>) -> Eval<Value> {
        let routine = self.routine(id);
        let Some(point) = routine.formals.first() else {
            return Err(super::machine::Stop);
        };
        let Some(point) = given.iter().find(|given| is_for(given, &point.name)) else {
            let node = self.field_node(id, at, given)?;
            return self.made(node, at);
        };
        self.check_point(point, &routine.name.text)?;
        let value = self.call_routine(id, at, given)?;
        self.field_value(&value, id)?;
        Ok(value)
    }

    /// A call of a pattern: with a point its value there, without one the pattern with these arguments.
    pub fn call_pattern(&mut self, id: GlobalId, at: Span, given: Vec<Given<'a>>) -> Eval<Value> {
        let routine = self.routine(id);
        let Some(point) = routine.formals.first() else {
            return Err(super::machine::Stop);
        };
        if let Some(point) = given.iter().find(|given| is_for(given, &point.name)) {
            self.check_point(point, &routine.name.text)?;
            return self.call_routine(id, at, given);
        }
        self.check_fixed(&given)?;
        let rest = given
            .into_iter()
            .map(|given| (given.label.map(|label| label.text.clone()), given.value))
            .collect();
        self.pattern(PatternKind::Routine(id, rest), at)
    }

    /// The pattern, if it is not nested too deep.
    pub fn pattern(&mut self, kind: PatternKind, at: Span) -> Eval<Value> {
        let inside = match &kind {
            PatternKind::Routine(_, given) => given
                .iter()
                .map(|(_, value)| value.depth())
                .max()
                .unwrap_or(0),
            PatternKind::Checker { a, b, .. }
            | PatternKind::Stripes { a, b, .. }
            | PatternKind::Gradient { a, b, .. }
            | PatternKind::Marble { a, b, .. }
            | PatternKind::Wood { a, b, .. } => a.depth().max(b.depth()),
        };
        let depth = inside + 1;
        if depth > MAX_LIST_DEPTH {
            let message = format!(
                "patterns are nested deeper than {MAX_LIST_DEPTH} levels (limit MAX_LIST_DEPTH)"
            );
            return self.fail(Diagnostic::error(at, message));
        }
        Ok(Value::Pattern(Arc::new(Pattern { kind, depth })))
    }

    fn check_point(&mut self, given: &Given, name: &str) -> Eval<()> {
        let is_point = given
            .value
            .quantity()
            .is_some_and(|q| q.form == Form::Vector && q.count == 3);
        if is_point {
            return Ok(());
        }
        let message = format!(
            "`{name}` is taken at a point [x, y, z], but this is {}",
            given.value.noun()
        );
        let error = Diagnostic::error(given.span, message).label(given.value.shown());
        self.fail(error.help("its other arguments are given by name"))
    }

    /// Reports arguments that depend on the point of the field around.
    fn check_fixed(&mut self, given: &[Given]) -> Eval<()> {
        if self.builders.is_empty() {
            return Ok(());
        }
        for argument in given {
            if depends_on_point(&argument.value) {
                let message = "this argument depends on the point of the field around";
                let help = "give the point too, as in `f(p, cell: p.x)`, for the value there";
                return self.fail(Diagnostic::error(argument.span, message).help(help));
            }
        }
        Ok(())
    }

    /// The number that a field gave.
    fn field_value(&mut self, value: &Value, id: GlobalId) -> Eval<Scalar> {
        match value.quantity() {
            Some(quantity) if quantity.form == Form::Number => Ok(quantity.scalars[0]),
            _ => {
                let routine = self.routine(id);
                let name = &routine.name.text;
                let message = format!(
                    "the field `{name}` must give a number, but this is {}",
                    value.noun()
                );
                let span = routine.body.value.span;
                self.fail(Diagnostic::error(span, message).label(value.shown()))
            }
        }
    }

    /// The shape of a field with its default arguments, made once.
    pub fn field_shape(&mut self, id: GlobalId, at: Span) -> Eval<Arc<Node>> {
        if let Some(known) = self.fields.get(&id) {
            return known.clone().ok_or(super::machine::Stop);
        }
        let node = self.field_node(id, at, Vec::new());
        self.fields.insert(id, node.as_ref().ok().cloned());
        node
    }

    /// The shape of a field with these arguments after the point.
    fn field_node(&mut self, id: GlobalId, at: Span, given: Vec<Given<'a>>) -> Eval<Arc<Node>> {
        self.check_fixed(&given)?;
        let routine = self.routine(id);
        let run = |machine: &mut Self, point: Value| {
            let mut all = vec![Given {
                label: None,
                value: point,
                span: at,
            }];
            all.extend(given);
            machine.with_frame(id, at, all, |machine, routine| {
                let claimed = match &routine.claim {
                    Some(claim) => Some(machine.claim(claim)?),
                    None => None,
                };
                let value = machine.block(&routine.body)?;
                let scalar = machine.field_value(&value, id)?;
                Ok((vec![scalar], claimed))
            })
        };
        let (graph, claimed) = self.graph(at, run)?;
        let graph = Arc::new(graph);
        let work = graph.len() as u64;
        let field = FieldShape {
            name: routine.name.text.to_string(),
            graph,
            claimed,
        };
        self.tick(work, at)?;
        match Node::field(field) {
            Ok(node) => {
                if let Shape::Field(field) = node.shape() {
                    self.derived.push((id, field.clone()));
                }
                let place = self.place(routine.name.span);
                self.count_shape(&node, at)?;
                Ok(node.labelled(Some(routine.name.text.clone()), Some(place)))
            }
            Err(fault) => self.fault(fault, at),
        }
    }

    fn claim(&mut self, claim: &'a super::ast::Expression) -> Eval<f64> {
        match self.eval(claim)? {
            Value::Number(x) if x > 0.0 && x.is_finite() => Ok(x),
            value => {
                let message = "a claimed Lipschitz constant is a positive number";
                self.fail(Diagnostic::error(claim.span, message).label(value.shown()))
            }
        }
    }

    /// The graph of what `run` does with a symbolic point, and what else it gives.
    fn graph<T>(
        &mut self,
        at: Span,
        run: impl FnOnce(&mut Self, Value) -> Eval<(Vec<Scalar>, T)>,
    ) -> Eval<(Graph, T)> {
        let mut builder = GraphBuilder::new();
        let point = builder.point().map(Scalar::Symbolic);
        self.builders.push(builder);
        let point = Quantity::new(Form::Vector, &point).value();
        let result = run(self, point).and_then(|(scalars, rest)| {
            let ids: Vec<_> = scalars.into_iter().map(|scalar| self.id(scalar)).collect();
            self.check_graph(at)?;
            let graph = self.builder().finish(&ids);
            Ok((graph, rest))
        });
        self.builders.pop();
        result
    }

    /// The graph of a pattern, with one output for a number and three for a colour.
    pub fn pattern_graph(&mut self, pattern: &Pattern, at: Span) -> Eval<Graph> {
        let run = |machine: &mut Self, point: Value| {
            let value = machine.pattern_at(pattern, &point, at)?;
            match value.quantity() {
                Some(quantity) if matches!(quantity.form, Form::Number | Form::Color) => {
                    Ok((quantity.scalars().to_vec(), ()))
                }
                _ => {
                    let message = format!(
                        "a pattern gives a number or a colour, but this one gives {}",
                        value.noun()
                    );
                    machine.fail(Diagnostic::error(at, message))
                }
            }
        };
        Ok(self.graph(at, run)?.0)
    }

    /// The value of a pattern at a point.
    pub fn pattern_at(&mut self, pattern: &Pattern, point: &Value, at: Span) -> Eval<Value> {
        self.tick(4, at)?;
        match &pattern.kind {
            PatternKind::Routine(id, rest) => {
                let routine = self.routine(*id);
                let mut given = vec![Given {
                    label: None,
                    value: point.clone(),
                    span: at,
                }];
                given.extend(rest.iter().map(|(name, value)| {
                    let formal = routine.formals.iter().map(|formal| &formal.name);
                    let label = name
                        .as_ref()
                        .and_then(|name| formal.clone().find(|word| word.text == *name));
                    Given {
                        label,
                        value: value.clone(),
                        span: at,
                    }
                }));
                self.call_routine(*id, at, given)
            }
            PatternKind::Checker { a, b, size } => {
                let parity = self.checker_parity(point, *size);
                self.alternating(parity, (a, b), point, at)
            }
            PatternKind::Stripes { a, b, width, axis } => {
                let along = self.along(point, *axis, [0.0; 3]);
                let layer = self.arithmetic(Arithmetic::Divide, along, Scalar::Known(*width));
                let layer = self.apply(Function::Floor, &[layer]);
                self.alternating(layer, (a, b), point, at)
            }
            PatternKind::Gradient { a, b, from, way } => {
                let length_squared = way.iter().map(|c| c * c).sum::<f64>();
                let along = self.along(point, way.map(|c| c / length_squared), *from);
                let bounds = [Scalar::Known(0.0), Scalar::Known(1.0)];
                let share = self.apply(Function::Clamp, &[along, bounds[0], bounds[1]]);
                self.mixed(share, (a, b), point, at)
            }
            PatternKind::Marble {
                a,
                b,
                size,
                turbulence,
            } => {
                let share = self.marble_share(point, *size, *turbulence);
                self.mixed(share, (a, b), point, at)
            }
            PatternKind::Wood {
                a,
                b,
                width,
                turbulence,
            } => {
                let share = self.wood_share(point, *width, *turbulence);
                self.mixed(share, (a, b), point, at)
            }
        }
    }

    /// The sum of the numbers of the cell along the axes; cells along y are centred, so that a floor at y = 0 lies
    /// inside of one.
    fn checker_parity(&mut self, point: &Value, size: f64) -> Scalar {
        let shifts = [0.0, 0.5, 0.0];
        let mut sum = Scalar::Known(0.0);
        let Some(point) = point.quantity() else {
            return sum;
        };
        for (coordinate, shift) in point.scalars().iter().zip(shifts) {
            let cells = self.arithmetic(Arithmetic::Divide, *coordinate, Scalar::Known(size));
            let cells = self.arithmetic(Arithmetic::Add, cells, Scalar::Known(shift));
            let cell = self.apply(Function::Floor, &[cells]);
            sum = self.arithmetic(Arithmetic::Add, sum, cell);
        }
        sum
    }

    /// How far the point lies from `from`, times `direction`.
    fn along(&mut self, point: &Value, direction: [f64; 3], from: [f64; 3]) -> Scalar {
        let mut sum = Scalar::Known(0.0);
        let Some(point) = point.quantity() else {
            return sum;
        };
        for (i, coordinate) in point.scalars().iter().enumerate() {
            let offset = self.arithmetic(Arithmetic::Subtract, *coordinate, Scalar::Known(from[i]));
            let product =
                self.arithmetic(Arithmetic::Multiply, offset, Scalar::Known(direction[i]));
            sum = self.arithmetic(Arithmetic::Add, sum, product);
        }
        sum
    }

    /// `a` where the whole number is even, `b` where it is odd.
    fn alternating(
        &mut self,
        number: Scalar,
        (a, b): (&Value, &Value),
        point: &Value,
        at: Span,
    ) -> Eval<Value> {
        let two = Scalar::Known(2.0);
        let parity = self.apply(Function::Modulo, &[number, two]);
        let (a, b) = (self.shade(a, point, at)?, self.shade(b, point, at)?);
        let is_odd = self.less(Scalar::Known(0.5), parity, false);
        match is_odd {
            Value::Condition(condition) => self.select(condition, b, a, at),
            Value::Bool(true) => Ok(b),
            _ => Ok(a),
        }
    }

    /// `a` where the share is 0, `b` where it is 1.
    fn mixed(
        &mut self,
        share: Scalar,
        (a, b): (&Value, &Value),
        point: &Value,
        at: Span,
    ) -> Eval<Value> {
        let (a, b) = (self.shade(a, point, at)?, self.shade(b, point, at)?);
        let (Some(x), Some(y)) = (a.quantity(), b.quantity()) else {
            return Err(super::machine::Stop);
        };
        let Some((form, count)) = Self::joined_form(&x, &y) else {
            let message = format!(
                "a pattern needs two colours or two numbers, not {} and {}",
                a.noun(),
                b.noun()
            );
            return self.fail(Diagnostic::error(at, message));
        };
        let mut result = [Scalar::Known(0.0); 3];
        for (i, scalar) in result[..count].iter_mut().enumerate() {
            *scalar = self.apply(Function::Mix, &[x.component(i), y.component(i), share]);
        }
        Ok(Quantity::new(form, &result[..count]).value())
    }

    /// A number or colour, or the value of a pattern at the point.
    fn shade(&mut self, value: &Value, point: &Value, at: Span) -> Eval<Value> {
        match value {
            Value::Pattern(pattern) => self.pattern_at(pattern, point, at),
            Value::Routine(RoutineKind::Pattern, id) => {
                let given = vec![Given {
                    label: None,
                    value: point.clone(),
                    span: at,
                }];
                self.call_routine(*id, at, given)
            }
            other => Ok(other.clone()),
        }
    }
}

/// Whether the argument is for the parameter of this name, which is the first.
fn is_for(given: &Given, name: &Word) -> bool {
    given.label.is_none_or(|label| label.text == name.text)
}

/// Whether anything in the value depends on the point of a field.
fn depends_on_point(value: &Value) -> bool {
    match value {
        Value::Symbolic(_) | Value::Condition(_) => true,
        Value::List(list) => list.items.iter().any(depends_on_point),
        _ => false,
    }
}
