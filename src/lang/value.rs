//! The values of expressions.

use super::ast::{GlobalId, Literal, RoutineKind};
use super::builtin::Builtin;
use super::hint::clipped;
use crate::catalogue::{AnyBlend, written};
use crate::scene::{Id, Material, Node, TraceRecord};
use std::fmt;
use std::sync::Arc;

/// A value. Copies are cheap: what is large is shared.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    /// In radians.
    Angle(f64),
    Bool(bool),
    Text(Arc<str>),
    Vector2([f64; 2]),
    Vector3([f64; 3]),
    /// Linear RGB.
    Color([f64; 3]),
    /// Numbers that depend on the point of a field or pattern.
    Symbolic(Arc<Quantity>),
    /// A condition that depends on the point of a field or pattern.
    Condition(Condition),
    List(Arc<List>),
    Range(Arc<Range>),
    Shape(Arc<Node>),
    Blend(Arc<AnyBlend>),
    Material(Arc<Material>),
    Pattern(Arc<Pattern>),
    /// A function, field or pattern of the script.
    Routine(RoutineKind, GlobalId),
    Builtin(Builtin),
    Bounds(Arc<crate::catalogue::Bounds>),
    Trace(Arc<TraceRecord>),
}

/// A list; lists of two or three numbers are vectors instead.
#[derive(Debug)]
pub(super) struct List {
    pub items: Vec<Value>,
    /// How deep lists are nested in it, itself included.
    pub depth: u32,
    /// How many elements it has, with those of lists in it.
    pub weight: usize,
}

/// Evenly spaced numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
    pub is_inclusive: bool,
    /// The distance between elements; 1 where none is given.
    pub step: Option<f64>,
    /// Whether the numbers are angles, in radians.
    pub is_angle: bool,
}

impl Range {
    /// How many elements there are; may be huge. An element that misses the end by a billionth of a step counts as on
    /// it, so that `0..1 step 0.1` has ten.
    pub fn count(&self) -> f64 {
        let steps = (self.high - self.low) / self.step.unwrap_or(1.0);
        let slack = 1e-9 * steps.abs().clamp(1.0, 1e3);
        let count = if self.is_inclusive {
            (steps + slack).floor() + 1.0
        } else {
            (steps - slack).ceil()
        };
        count.max(0.0)
    }

    /// Element number `i`.
    pub fn element(&self, i: usize) -> Value {
        let x = self.low + i as f64 * self.step.unwrap_or(1.0);
        match self.is_angle {
            true => Value::Angle(x),
            false => Value::Number(x),
        }
    }

    /// Whether `x` lies between the ends, and on a step where one is given.
    pub fn contains(&self, x: f64) -> bool {
        let is_below = x < self.high || (self.is_inclusive && x == self.high);
        let is_on_step = self.step.is_none_or(|step| {
            let steps = (x - self.low) / step;
            (steps - steps.round()).abs() <= 1e-9 * steps.abs().max(1.0)
        });
        self.low <= x && is_below && is_on_step
    }
}

/// A pattern with its arguments.
#[derive(Debug)]
pub(super) struct Pattern {
    pub kind: PatternKind,
    /// How deep patterns are nested in it, itself included.
    pub depth: u32,
}

#[derive(Debug)]
pub(super) enum PatternKind {
    /// A pattern of the script, with what follows the point.
    Routine(GlobalId, Vec<(Option<Arc<str>>, Value)>),
    /// Cubes of edge `size`.
    Checker { a: Value, b: Value, size: f64 },
    /// Layers across an axis.
    Stripes {
        a: Value,
        b: Value,
        width: f64,
        axis: [f64; 3],
    },
    /// Veins of `b`, `size` apart, bent by noise.
    Marble {
        a: Value,
        b: Value,
        size: f64,
        turbulence: f64,
    },
    /// Rings around the y axis, `width` apart, bent by noise.
    Wood {
        a: Value,
        b: Value,
        width: f64,
        turbulence: f64,
    },
    /// From `a` to `b` along the way between two points.
    Gradient {
        a: Value,
        b: Value,
        from: [f64; 3],
        way: [f64; 3],
    },
}

/// What a tuple of numbers means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Number,
    Angle,
    /// With two or three components.
    Vector,
    Color,
}

/// A number: known, or depending on the point of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scalar {
    Known(f64),
    Symbolic(Id),
}

/// One to three numbers with a meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantity {
    pub form: Form,
    pub count: usize,
    pub scalars: [Scalar; 3],
}

impl Quantity {
    /// The quantity with these numbers.
    pub fn new(form: Form, scalars: &[Scalar]) -> Self {
        Self {
            form,
            count: scalars.len(),
            scalars: std::array::from_fn(|i| scalars.get(i).copied().unwrap_or(Scalar::Known(0.0))),
        }
    }

    /// The numbers that count.
    pub fn scalars(&self) -> &[Scalar] {
        &self.scalars[..self.count]
    }

    /// Component `i`; a lone number stands for every component.
    pub fn component(&self, i: usize) -> Scalar {
        self.scalars[if self.count == 1 { 0 } else { i }]
    }

    /// The quantity as a value.
    pub fn value(self) -> Value {
        let mut known = [0.0; 3];
        for (x, scalar) in known.iter_mut().zip(self.scalars()) {
            match scalar {
                Scalar::Known(value) => *x = *value,
                Scalar::Symbolic(_) => return Value::Symbolic(Arc::new(self)),
            }
        }
        let [x, y, _] = known;
        match (self.form, self.count) {
            (Form::Number, _) => Value::Number(x),
            (Form::Angle, _) => Value::Angle(x),
            (Form::Color, _) => Value::Color(known),
            (Form::Vector, 2) => Value::Vector2([x, y]),
            (Form::Vector, _) => Value::Vector3(known),
        }
    }
}

/// Whether `a < b`, or, where `is_negated`, not so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Condition {
    pub a: Id,
    pub b: Id,
    pub is_negated: bool,
}

impl Value {
    /// The list of these values: a vector where they are two or three numbers.
    pub fn list(items: Vec<Self>) -> Self {
        if let [_, _] | [_, _, _] = &items[..]
            && let Some(vector) = vector_of(&items)
        {
            return vector;
        }
        let depth = 1 + items.iter().map(Self::depth).max().unwrap_or(0);
        let weight = items
            .iter()
            .fold(0usize, |n, item| n.saturating_add(1 + item.weight()));
        Self::List(Arc::new(List {
            items,
            depth,
            weight,
        }))
    }

    /// How many elements the value has, with those of lists in it.
    pub fn weight(&self) -> usize {
        match self {
            Self::List(list) => list.weight,
            _ => 0,
        }
    }

    /// How deep lists are nested in the value.
    pub fn depth(&self) -> u32 {
        match self {
            Self::List(list) => list.depth,
            Self::Pattern(pattern) => pattern.depth,
            _ => 0,
        }
    }

    /// The numbers of a number, angle, vector or colour.
    pub fn quantity(&self) -> Option<Quantity> {
        let known = |form, xs: &[f64]| {
            let mut quantity = Quantity::new(form, &[]);
            quantity.count = xs.len();
            for (scalar, x) in quantity.scalars.iter_mut().zip(xs) {
                *scalar = Scalar::Known(*x);
            }
            Some(quantity)
        };
        match self {
            Self::Number(x) => known(Form::Number, &[*x]),
            Self::Angle(x) => known(Form::Angle, &[*x]),
            Self::Vector2(v) => known(Form::Vector, v),
            Self::Vector3(v) => known(Form::Vector, v),
            Self::Color(c) => known(Form::Color, c),
            Self::Symbolic(quantity) => Some(**quantity),
            _ => None,
        }
    }

    /// Whether it is a shape or a field, or a list that starts as a list of shapes does.
    pub fn is_shape(&self) -> bool {
        let is_one =
            |value: &Self| matches!(value, Self::Shape(_) | Self::Routine(RoutineKind::Field, _));
        match self {
            Self::List(list) => {
                let first = list.items.first();
                first.is_some_and(|item| is_one(item) || matches!(item, Self::List(_)))
            }
            other => is_one(other),
        }
    }

    /// What the value is, with its article.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Angle(_) => "an angle",
            Self::Bool(_) => "a truth value",
            Self::Text(_) => "a string",
            Self::Vector2(_) | Self::Vector3(_) => "a vector",
            Self::Color(_) => "a colour",
            Self::Symbolic(quantity) => match quantity.form {
                Form::Number => "a number that depends on the point",
                Form::Angle => "an angle that depends on the point",
                Form::Vector => "a vector that depends on the point",
                Form::Color => "a colour that depends on the point",
            },
            Self::Condition(_) => "a condition that depends on the point",
            Self::List(_) => "a list",
            Self::Range(_) => "a range",
            Self::Shape(node) if node.traits().is_planar => "a profile",
            Self::Shape(_) => "a shape",
            Self::Blend(_) => "a blend",
            Self::Material(_) => "a material",
            Self::Pattern(_) => "a pattern",
            Self::Routine(RoutineKind::Function, _) => "a function",
            Self::Routine(RoutineKind::Field, _) => "a field",
            Self::Routine(RoutineKind::Pattern, _) => "a pattern",
            Self::Builtin(_) => "a function",
            Self::Bounds(_) => "bounds",
            Self::Trace(_) => "the record of a ray",
        }
    }

    /// The value for a label: "this is ...", shown where it is short, else named.
    pub fn shown(&self) -> String {
        let is_plain = !matches!(
            self,
            Self::List(_) | Self::Symbolic(_) | Self::Condition(_) | Self::Shape(_)
        );
        if is_plain && self.is_printable() {
            format!("this is {}", clipped(&self.to_string()))
        } else {
            format!("this is {}", self.noun())
        }
    }

    fn is_printable(&self) -> bool {
        matches!(
            self,
            Self::Number(_)
                | Self::Angle(_)
                | Self::Bool(_)
                | Self::Text(_)
                | Self::Vector2(_)
                | Self::Vector3(_)
                | Self::Color(_)
                | Self::Range(_)
        )
    }
}

impl From<&Literal> for Value {
    fn from(literal: &Literal) -> Self {
        match literal {
            Literal::Number(x) => Self::Number(*x),
            Literal::Angle(x) => Self::Angle(*x),
            Literal::Bool(x) => Self::Bool(*x),
            Literal::Text(text) => Self::Text(text.clone()),
            Literal::Color(color) => Self::Color(*color),
        }
    }
}

/// The vector of two or three numbers; none where anything else is among them.
fn vector_of(items: &[Value]) -> Option<Value> {
    let mut scalars = [Scalar::Known(0.0); 3];
    for (scalar, item) in scalars.iter_mut().zip(items) {
        *scalar = match item {
            Value::Number(x) => Scalar::Known(*x),
            Value::Symbolic(quantity) if quantity.form == Form::Number => quantity.scalars[0],
            _ => return None,
        };
    }
    Some(Quantity::new(Form::Vector, &scalars[..items.len()]).value())
}

/// As a script would write it, where it could.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let joined = |xs: &[f64]| {
            xs.iter()
                .copied()
                .map(written)
                .collect::<Vec<_>>()
                .join(", ")
        };
        match self {
            Self::Number(x) => f.write_str(&written(*x)),
            Self::Angle(x) => write!(f, "{}deg", written(x.to_degrees())),
            Self::Bool(x) => write!(f, "{x}"),
            Self::Text(text) => write!(f, "\"{text}\""),
            Self::Vector2(v) => write!(f, "[{}]", joined(v)),
            Self::Vector3(v) => write!(f, "[{}]", joined(v)),
            Self::Color(c) => write!(f, "rgb({})", joined(c)),
            Self::List(list) if list.weight > 64 => {
                write!(f, "a list of {} elements", list.items.len())
            }
            Self::List(list) => {
                f.write_str("[")?;
                for (i, item) in list.items.iter().enumerate() {
                    let comma = if i == 0 { "" } else { ", " };
                    write!(f, "{comma}{item}")?;
                }
                f.write_str("]")
            }
            Self::Range(range) => {
                let mark = if range.is_inclusive { "..=" } else { ".." };
                let shown = |x: f64| match range.is_angle {
                    true => Self::Angle(x),
                    false => Self::Number(x),
                };
                write!(f, "{}{mark}{}", shown(range.low), shown(range.high))?;
                match range.step {
                    Some(step) => write!(f, " step {}", shown(step)),
                    None => Ok(()),
                }
            }
            Self::Shape(node) => match node.name() {
                Some(name) => write!(f, "{} `{name}`", self.noun()),
                None => write!(f, "{} `{}`", self.noun(), node.kind()),
            },
            Self::Material(material) => write!(f, "material `{}`", material.name),
            Self::Builtin(builtin) => write!(f, "function `{}`", builtin.name()),
            Self::Bounds(bounds) => {
                write!(f, "[{}] to [{}]", joined(&bounds.low), joined(&bounds.high))
            }
            other => f.write_str(other.noun()),
        }
    }
}
