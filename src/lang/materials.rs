//! `material name { ... }`

use super::ast::{Entry, RoutineKind};
use super::machine::{Eval, Machine, Stop};
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::terms::{Terms, is_color};
use super::value::{Pattern, PatternKind, Value};
use crate::scene::{Graph, Material, Model, Shadow, Term};
use glam::DVec3;
use std::sync::Arc;

const KNOWN: [&str; 12] = [
    "color",
    "ambient",
    "diffuse",
    "specular",
    "shininess",
    "model",
    "reflect",
    "refract",
    "ior",
    "fresnel",
    "absorb",
    "shadow",
];

impl<'a> Machine<'a> {
    /// The material of a statement.
    pub fn material(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Arc<Material>> {
        let mut terms = Terms::new(self, ("material", word.span), entries, &KNOWN);
        let default = Material::default();
        let models = [("phong", Model::Phong), ("blinn", Model::Blinn)];
        let shadows = [
            ("opaque", Shadow::Opaque),
            ("tinted", Shadow::Tinted),
            ("none", Shadow::None),
        ];
        let mut number = |machine: &mut Self, name: &str, default: Term<f64>, range: Allowed| {
            machine.number_term(&mut terms, name, default, range)
        };
        let ambient = number(self, "ambient", default.ambient, NOT_NEGATIVE);
        let diffuse = number(self, "diffuse", default.diffuse, NOT_NEGATIVE);
        let specular = number(self, "specular", default.specular, NOT_NEGATIVE);
        let shininess = number(self, "shininess", default.shininess, NOT_NEGATIVE);
        let reflect = number(self, "reflect", default.reflect, NOT_NEGATIVE);
        let refract = number(self, "refract", default.refract, NOT_NEGATIVE);
        let ior = number(self, "ior", default.ior, POSITIVE);
        let material = Material {
            name: word.text.to_string(),
            color: self.color_term(&mut terms, "color", default.color),
            ambient,
            diffuse,
            specular,
            shininess,
            model: terms.choice(self, "model", &models, default.model),
            reflect,
            refract,
            ior,
            fresnel: terms.truth(self, "fresnel", default.fresnel),
            absorb: self.color_term(&mut terms, "absorb", default.absorb),
            shadow: terms.choice(self, "shadow", &shadows, default.shadow),
        };
        match terms.is_broken {
            true => Err(Stop),
            false => Ok(Arc::new(material)),
        }
    }

    fn number_term(
        &mut self,
        terms: &mut Terms<'a>,
        name: &str,
        default: Term<f64>,
        range: Allowed,
    ) -> Term<f64> {
        match terms.get(name) {
            Some((value @ (Value::Pattern(_) | Value::Routine(..)), span)) => {
                match self.graph_of(&value, span) {
                    Ok(Some((graph, 1))) => Term::Pattern(graph),
                    Ok(Some(_)) => {
                        let message = format!(
                            "`{name}` of `material` needs a pattern of numbers, not of colours"
                        );
                        terms.note(self, Diagnostic::error(span, message));
                        default
                    }
                    Ok(None) => {
                        terms.wrong_kind(self, name, "a number or a pattern", None);
                        default
                    }
                    Err(Stop) => {
                        terms.is_broken = true;
                        default
                    }
                }
            }
            Some(_) => {
                let constant = match default {
                    Term::Constant(x) => x,
                    Term::Pattern(_) => 0.0,
                };
                Term::Constant(terms.number(self, name, range, constant))
            }
            None => default,
        }
    }

    fn color_term(
        &mut self,
        terms: &mut Terms<'a>,
        name: &str,
        default: Term<DVec3>,
    ) -> Term<DVec3> {
        match terms.get(name) {
            Some((value @ (Value::Pattern(_) | Value::Routine(..)), span)) => {
                match self.graph_of(&value, span) {
                    Ok(Some((graph, _))) => Term::Pattern(graph),
                    Ok(None) => {
                        terms.wrong_kind(self, name, "a colour or a pattern", None);
                        default
                    }
                    Err(Stop) => {
                        terms.is_broken = true;
                        default
                    }
                }
            }
            Some((Value::Color(c), _)) if is_color(&c) => Term::Constant(DVec3::from(c)),
            Some((value, _)) => {
                let help = match value {
                    Value::Number(x) => format!("write `rgb({x}, {x}, {x})` for a grey"),
                    Value::Vector3([r, g, b]) => format!("write `rgb({r}, {g}, {b})`"),
                    _ => "colours are written `#d9a441` or `rgb(r, g, b)`".into(),
                };
                if matches!(value, Value::Color(_)) {
                    terms.color(self, name, DVec3::ZERO);
                } else {
                    terms.wrong_kind(self, name, "a colour or a pattern", Some(&help));
                }
                default
            }
            None => default,
        }
    }

    /// The graph of a pattern and the number of its outputs; none where the value is no pattern.
    fn graph_of(&mut self, value: &Value, at: Span) -> Eval<Option<(Arc<Graph>, usize)>> {
        let own;
        let pattern = match value {
            Value::Pattern(pattern) => &**pattern,
            Value::Routine(RoutineKind::Pattern, id) => {
                own = Pattern {
                    kind: PatternKind::Routine(*id, Vec::new()),
                    depth: 1,
                };
                &own
            }
            _ => return Ok(None),
        };
        let graph = self.pattern_graph(pattern, at)?;
        let outputs = graph.outputs();
        Ok(Some((Arc::new(graph), outputs)))
    }
}

/// A range in words, and as a question.
type Allowed = (&'static str, fn(f64) -> bool);

const NOT_NEGATIVE: Allowed = ("zero or positive", |x| x >= 0.0);
const POSITIVE: Allowed = ("positive", |x| x > 0.0);
