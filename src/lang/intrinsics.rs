//! The functions that only the language knows.

use super::arguments::{Given, bind};
use super::ast::RoutineKind;
use super::builtin::Intrinsic;
use super::limits::MAX_STRING;
use super::machine::{Eval, Machine, item_of};
use super::numeric::Arithmetic;
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Form, PatternKind, Quantity, Scalar, Value};
use crate::catalogue::{AXES, Function};

impl<'a> Machine<'a> {
    /// A function of the language itself.
    pub fn intrinsic(
        &mut self,
        intrinsic: Intrinsic,
        at: Span,
        given: Vec<Given<'a>>,
    ) -> Eval<Value> {
        match intrinsic {
            Intrinsic::Concat => return self.concat(at, &given),
            Intrinsic::Str => return self.str(at, &given),
            Intrinsic::Rand => return self.rand(at, &given),
            Intrinsic::Trace => return self.trace(at, &given),
            _ => {}
        }
        let slots = intrinsic.arguments();
        let bound = match bind(intrinsic.name(), &slots, at, given) {
            Ok(bound) => bound,
            Err(diagnostic) => return self.fail(*diagnostic),
        };
        let mut bound = bound.into_iter();
        // The names say which arguments are there; those that must be are.
        let mut next = || bound.next().flatten();
        let (Some(first), second, third, fourth) = (next(), next(), next(), next()) else {
            return Err(super::machine::Stop);
        };
        match (intrinsic, second) {
            (Intrinsic::At, Some(point)) => self.at(&first, &point),
            (Intrinsic::Paint, Some(material)) => match &material.value {
                Value::Material(m) => self.painted(&first.value, &m.clone(), first.span),
                other => {
                    let message =
                        format!("`paint` expects a material, but this is {}", other.noun());
                    let error = Diagnostic::error(material.span, message).label(other.shown());
                    self.fail(match other {
                        Value::Color(_) => error.help(
                            "write `material name { color: #d9a441 }` and paint with the name",
                        ),
                        _ => error,
                    })
                }
            },
            (Intrinsic::Displace, Some(field)) => {
                self.displace(&first.value, first.span, &field, at)
            }
            (Intrinsic::Hits, Some(t)) => self.hits(&first, &t, third),
            (Intrinsic::Steps, _) => self.steps(&first, at),
            (Intrinsic::Misses, _) => self.misses(&first),
            (Intrinsic::Heightfield, size) => self.heightfield(&first, size, third, at),
            (Intrinsic::Len, _) => match &first.value {
                Value::Text(text) => Ok(Value::Number(text.len() as f64)),
                other => {
                    let count = self.count_of(other, first.span)?;
                    Ok(Value::Number(count as f64))
                }
            },
            (Intrinsic::Reverse, _) => {
                let count = self.count_of(&first.value, first.span)?;
                self.tick(count as u64 / 4, at)?;
                let items = (0..count).rev().map(|i| item_of(&first.value, i)).collect();
                self.listed(items, at)
            }
            (Intrinsic::Sum, _) => self.sum(&first, at),
            (Intrinsic::Length, _) => {
                let v = self.vector(&first, "length")?;
                let length = self.length(v.scalars());
                self.number(length, at)
            }
            (Intrinsic::Noise, _) => self.lattice(Function::Noise3, &first, at),
            (Intrinsic::Voronoi, _) => self.lattice(Function::Voronoi3, &first, at),
            (Intrinsic::Fbm, octaves) => self.fbm_call(&first, [octaves, third, fourth], at),
            (Intrinsic::Normalize, _) => self.normalize(&first, at),
            (Intrinsic::Dot, Some(second)) => {
                let (a, b) = self.vectors(&first, &second, "dot")?;
                let dot = self.dot(a.scalars(), b.scalars());
                self.number(dot, at)
            }
            (Intrinsic::Distance, Some(second)) => {
                let (a, b) = self.vectors(&first, &second, "distance")?;
                let mut difference = a.scalars;
                for (i, x) in difference[..a.count].iter_mut().enumerate() {
                    *x = self.arithmetic(Arithmetic::Subtract, *x, b.scalars[i]);
                }
                let length = self.length(&difference[..a.count]);
                self.number(length, at)
            }
            (Intrinsic::Cross, Some(second)) => self.cross(&first, &second, at),
            (Intrinsic::Rgb, Some(green)) => {
                let Some(blue) = third else {
                    return Err(super::machine::Stop);
                };
                let mut parts = [Scalar::Known(0.0); 3];
                for (part, given) in parts.iter_mut().zip([&first, &green, &blue]) {
                    *part = self.scalar_of(given, "rgb")?;
                }
                Ok(Quantity::new(Form::Color, &parts).value())
            }
            (Intrinsic::Checker, Some(b)) => {
                let size = self.positive(third, "size", "checker")?;
                let (a, b) = self.shades(first, b, "checker")?;
                self.pattern(PatternKind::Checker { a, b, size }, at)
            }
            (Intrinsic::Stripes, Some(b)) => {
                let width = self.positive(third, "width", "stripes")?;
                let axis = self.axis(fourth)?;
                let (a, b) = self.shades(first, b, "stripes")?;
                let kind = PatternKind::Stripes { a, b, width, axis };
                self.pattern(kind, at)
            }
            (Intrinsic::Marble, Some(b)) => {
                let size = self.positive(third, "size", "marble")?;
                let turbulence = self.positive(fourth, "turbulence", "marble")?;
                let (a, b) = self.shades(first, b, "marble")?;
                self.pattern(
                    PatternKind::Marble {
                        a,
                        b,
                        size,
                        turbulence,
                    },
                    at,
                )
            }
            (Intrinsic::Wood, Some(b)) => {
                let width = self.positive_or(third, "width", "wood", 0.1)?;
                let turbulence = self.positive(fourth, "turbulence", "wood")?;
                let (a, b) = self.shades(first, b, "wood")?;
                self.pattern(
                    PatternKind::Wood {
                        a,
                        b,
                        width,
                        turbulence,
                    },
                    at,
                )
            }
            (Intrinsic::Gradient, Some(b)) => {
                let from = self.point_or(third, [0.0; 3], "gradient")?;
                let to = self.point_or(fourth, [0.0, 1.0, 0.0], "gradient")?;
                let way: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
                if way == [0.0; 3] {
                    let message = "`from` and `to` of `gradient` must be different points";
                    return self.fail(Diagnostic::error(at, message));
                }
                let (a, b) = self.shades(first, b, "gradient")?;
                self.pattern(PatternKind::Gradient { a, b, from, way }, at)
            }
            _ => Err(super::machine::Stop),
        }
    }

    /// The number as a value, if the graph is not too large.
    pub fn number(&mut self, scalar: Scalar, at: Span) -> Eval<Value> {
        self.check_graph(at)?;
        Ok(Quantity::new(Form::Number, &[scalar]).value())
    }

    /// Reports an argument of the wrong kind.
    pub fn unfit<T>(&mut self, given: &Given, callee: &str, wanted: &str) -> Eval<T> {
        let message = format!(
            "`{callee}` expects {wanted}, but this is {}",
            given.value.noun()
        );
        self.fail(Diagnostic::error(given.span, message).label(given.value.shown()))
    }

    fn vector(&mut self, given: &Given, callee: &str) -> Eval<Quantity> {
        match given.value.quantity() {
            Some(quantity) if quantity.form == Form::Vector => Ok(quantity),
            _ => self.unfit(given, callee, "a vector"),
        }
    }

    fn vectors(&mut self, a: &Given, b: &Given, callee: &str) -> Eval<(Quantity, Quantity)> {
        let (x, y) = (self.vector(a, callee)?, self.vector(b, callee)?);
        if x.count == y.count {
            return Ok((x, y));
        }
        let wanted = format!("a vector with {} components here", x.count);
        self.unfit(b, callee, &wanted)
    }

    fn scalar_of(&mut self, given: &Given, callee: &str) -> Eval<Scalar> {
        match given.value.quantity() {
            Some(quantity) if quantity.form == Form::Number => Ok(quantity.scalars[0]),
            _ => self.unfit(given, callee, "a number"),
        }
    }

    fn point_or(
        &mut self,
        given: Option<Given>,
        default: [f64; 3],
        callee: &str,
    ) -> Eval<[f64; 3]> {
        match given {
            Some(given) => self.known_point(&given, callee),
            None => Ok(default),
        }
    }

    fn positive(&mut self, given: Option<Given>, name: &str, callee: &str) -> Eval<f64> {
        self.positive_or(given, name, callee, 1.0)
    }

    /// A positive number, `default` where none is given.
    pub fn positive_or(
        &mut self,
        given: Option<Given>,
        name: &str,
        callee: &str,
        default: f64,
    ) -> Eval<f64> {
        let Some(given) = given else {
            return Ok(default);
        };
        match given.value {
            Value::Number(x) if x > 0.0 && x.is_finite() => Ok(x),
            Value::Number(_) => {
                let message = format!("`{name}` of `{callee}` must be positive");
                let error = Diagnostic::error(given.span, message).label(given.value.shown());
                self.fail(error.help(format!("the default is {default}")))
            }
            _ => self.unfit(&given, callee, "a number"),
        }
    }

    fn axis(&mut self, given: Option<Given>) -> Eval<[f64; 3]> {
        let Some(given) = given else {
            return Ok([1.0, 0.0, 0.0]);
        };
        match &given.value {
            Value::Text(name) => {
                if let Some(i) = AXES.iter().position(|axis| **axis == **name) {
                    let mut axis = [0.0; 3];
                    axis[i] = 1.0;
                    return Ok(axis);
                }
            }
            Value::Vector3(v) if *v != [0.0; 3] => {
                let length = v.iter().fold(0.0, |n: f64, c| n.hypot(*c));
                return Ok(v.map(|c| c / length));
            }
            _ => {}
        }
        self.unfit(
            &given,
            "stripes",
            "an axis \"x\", \"y\", \"z\" or a direction",
        )
    }

    /// The two values between which a pattern changes: both colours or both numbers, or patterns.
    fn shades(&mut self, a: Given, b: Given, callee: &str) -> Eval<(Value, Value)> {
        for given in [&a, &b] {
            let is_shade = matches!(
                given.value,
                Value::Number(_)
                    | Value::Color(_)
                    | Value::Pattern(_)
                    | Value::Routine(RoutineKind::Pattern, _)
            );
            if !is_shade {
                return self.unfit(given, callee, "a colour, a number or a pattern");
            }
        }
        let is_color = [&a, &b].map(|given| matches!(given.value, Value::Color(_)));
        let is_number = [&a, &b].map(|given| matches!(given.value, Value::Number(_)));
        if (is_color[0] && is_number[1]) || (is_number[0] && is_color[1]) {
            let wanted = if is_color[0] {
                "a colour here"
            } else {
                "a number here"
            };
            return self.unfit(&b, callee, wanted);
        }
        Ok((a.value, b.value))
    }

    fn normalize(&mut self, given: &Given, at: Span) -> Eval<Value> {
        let v = self.vector(given, "normalize")?;
        let length = self.length(v.scalars());
        if length == Scalar::Known(0.0) {
            let error = Diagnostic::error(given.span, "a vector of length zero has no direction");
            return self.fail(error);
        }
        let mut unit = v.scalars;
        for x in &mut unit[..v.count] {
            *x = self.arithmetic(Arithmetic::Divide, *x, length);
        }
        self.check_graph(at)?;
        Ok(Quantity::new(Form::Vector, &unit[..v.count]).value())
    }

    fn cross(&mut self, a: &Given, b: &Given, at: Span) -> Eval<Value> {
        let (x, y) = self.vectors(a, b, "cross")?;
        if x.count != 3 {
            return self.unfit(a, "cross", "a vector [x, y, z]");
        }
        let mut product = [Scalar::Known(0.0); 3];
        for (i, component) in product.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let plus = self.arithmetic(Arithmetic::Multiply, x.scalars[j], y.scalars[k]);
            let minus = self.arithmetic(Arithmetic::Multiply, x.scalars[k], y.scalars[j]);
            *component = self.arithmetic(Arithmetic::Subtract, plus, minus);
        }
        self.check_graph(at)?;
        Ok(Quantity::new(Form::Vector, &product).value())
    }

    fn sum(&mut self, given: &Given, at: Span) -> Eval<Value> {
        let count = self.count_of(&given.value, given.span)?;
        self.tick(count as u64, at)?;
        let mut sum = None;
        for i in 0..count {
            let item = item_of(&given.value, i);
            sum = Some(match sum {
                None => item,
                Some(sum) => {
                    let add = super::ast::Operator::Add;
                    self.binary(add, (sum, given.span), (item, given.span))?
                }
            });
        }
        Ok(sum.unwrap_or(Value::Number(0.0)))
    }

    fn concat(&mut self, at: Span, given: &[Given]) -> Eval<Value> {
        let mut items = Vec::new();
        for argument in given {
            let count = self.count_of(&argument.value, argument.span)?;
            self.tick(count as u64 / 4, at)?;
            items.extend((0..count).map(|i| item_of(&argument.value, i)));
        }
        self.listed(items, at)
    }

    fn str(&mut self, at: Span, given: &[Given]) -> Eval<Value> {
        let parts: Vec<String> = given
            .iter()
            .map(|argument| match &argument.value {
                Value::Text(text) => text.to_string(),
                other => other.to_string(),
            })
            .collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        self.joined_text(&parts, at)
    }

    /// The strings one after another, within the limit.
    pub fn joined_text(&mut self, parts: &[&str], at: Span) -> Eval<Value> {
        let length: usize = parts.iter().map(|part| part.len()).sum();
        if length > MAX_STRING {
            let message =
                format!("this string is longer than {MAX_STRING} bytes (limit MAX_STRING)");
            return self.fail(Diagnostic::error(at, message));
        }
        self.tick(length as u64 / 32, at)?;
        Ok(Value::Text(parts.concat().into()))
    }

    /// A number in [0, 1) from the bits of the arguments.
    fn rand(&mut self, at: Span, given: &[Given]) -> Eval<Value> {
        if given.is_empty() {
            let error = Diagnostic::error(at, "`seed` of `rand` is missing");
            return self
                .fail(error.help("as in `rand(1, i)`: the same arguments give the same number"));
        }
        let mut state = 0u64;
        for argument in given {
            let Value::Number(x) = argument.value else {
                return self.unfit(argument, "rand", "a number");
            };
            // Zero has one hash, whatever its sign.
            state = mixed_bits(state ^ (x + 0.0).to_bits());
        }
        let unit = (state >> 11) as f64 / (1u64 << 53) as f64;
        Ok(Value::Number(unit))
    }
}

/// SplitMix64's output function: every bit of the input reaches every bit of the output. Source: Steele et al. 2014.
fn mixed_bits(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
