//! Statements, one after another: from a program to a scene.

use super::ast::*;
use super::budget::Budget;
use super::machine::{Eval, Global, Machine, Stop};
use super::program::Override;
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::scene::{Node, Scene};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// What the statements of a script made.
#[derive(Debug, Default)]
pub(super) struct Made {
    pub scene: Scene,
    pub names: BTreeMap<String, Arc<Node>>,
    pub parameters: Vec<(String, String)>,
    pub budget: Option<Budget>,
    /// Where each setting stands that can be given once.
    once: HashMap<&'static str, Span>,
    /// Whether the script has a `show`.
    pub has_shows: bool,
}

impl<'a> Machine<'a> {
    /// Evaluates the script, its imports as they come.
    pub fn run(&mut self) -> Made {
        let mut made = Made::default();
        self.check_overrides();
        self.module(0, &mut made);
        self.finish_fields();
        self.shown = made.scene.shown.clone();
        self.settings = made.scene.settings;
        self.check_claims();
        self.name_shapes(&mut made);
        made
    }

    fn module(&mut self, number: u32, made: &mut Made) {
        let program = self.program;
        let module = &program.modules[number as usize];
        for (i, statement) in module.statements.iter().enumerate() {
            if self.is_exhausted() {
                return;
            }
            let id = module.defines[i].map(|index| GlobalId {
                module: number,
                index,
            });
            self.statement_of(statement, id, made);
            self.clear();
        }
    }

    fn statement_of(&mut self, statement: &'a Statement, id: Option<GlobalId>, made: &mut Made) {
        let is_script = statement.span.file == 0;
        match &statement.kind {
            StatementKind::Routine(_) => {}
            StatementKind::Broken(_) => self.define(id, Err(Stop)),
            StatementKind::Import(import) => {
                if let Some(module) = import.module
                    && self.is_new(module)
                {
                    self.calls.push((import.path.span, "imported here"));
                    self.module(module, made);
                    self.calls.pop();
                }
            }
            StatementKind::Parameter(parameter) => {
                let value = self.parameter(parameter, is_script);
                if let (Ok(value), true) = (&value, is_script) {
                    let name = parameter.name.text.to_string();
                    made.parameters.push((name, plain(value)));
                }
                self.define(id, value);
            }
            StatementKind::Let(name, value) => {
                let value = self
                    .eval(value)
                    .and_then(|value| self.labelled(value, Some(&name.text), name.span));
                self.define(id, value);
            }
            StatementKind::Material(name, entries) => {
                let value = self.material(name, entries).map(Value::Material);
                self.define(id, value);
            }
            // An imported file gives its names; what it shows by itself is not for others.
            _ if !is_script => {}
            StatementKind::Show(value) => {
                made.has_shows = true;
                if let Ok(mut shown) = self.show(value, statement.span) {
                    made.scene.shown.append(&mut shown);
                }
            }
            StatementKind::Settings(word, entries) => self.setting(word, entries, made),
            StatementKind::Test(_) => {}
        }
    }

    /// Whether the module has not been evaluated yet.
    fn is_new(&self, module: u32) -> bool {
        self.globals[module as usize]
            .iter()
            .all(|global| matches!(global, Global::Unset))
    }

    fn define(&mut self, id: Option<GlobalId>, value: Eval<Value>) {
        let Some(id) = id else {
            return;
        };
        self.globals[id.module as usize][id.index as usize] = match value {
            Ok(value) => Global::Ready(value),
            Err(Stop) => Global::Poisoned,
        };
    }

    fn setting(&mut self, word: &'a super::source::Word, entries: &'a [Entry], made: &mut Made) {
        match &*word.text {
            "light" => {
                if let Ok(light) = self.light(word, entries) {
                    made.scene.lights.push(light);
                }
            }
            "camera" if self.is_first("camera", word.span, made) => {
                if let Ok(camera) = self.camera(word, entries) {
                    made.scene.camera = camera;
                }
            }
            "sky" if self.is_first("sky", word.span, made) => {
                if let Ok(sky) = self.sky(word, entries) {
                    made.scene.sky = sky;
                }
            }
            "fog" if self.is_first("fog", word.span, made) => {
                if let Ok(fog) = self.fog(word, entries) {
                    made.scene.fog = Some(fog);
                }
            }
            "render" if self.is_first("render", word.span, made) => {
                if let Ok(settings) = self.render(word, entries) {
                    made.scene.settings = settings;
                }
            }
            "budget" if self.is_first("budget", word.span, made) => {
                made.budget = self.budget(word, entries).ok();
            }
            _ => {}
        }
    }

    fn is_first(&mut self, word: &'static str, span: Span, made: &mut Made) -> bool {
        let Some(first) = made.once.insert(word, span) else {
            return true;
        };
        let error = Diagnostic::error(span, format!("a script has one `{word}`"))
            .note(first, "the first is here");
        let _: Eval<()> = self.fail(error);
        false
    }

    /// The shapes of a `show`, each of which can be traced.
    fn show(&mut self, value: &'a Expression, at: Span) -> Eval<Vec<Arc<Node>>> {
        let evaluated = self.eval(value)?;
        let mut nodes = Vec::new();
        self.gather(&evaluated, value.span, &mut nodes)?;
        let place = self.place(at);
        for node in &mut nodes {
            if node.traits().is_planar {
                let error = Diagnostic::error(value.span, "a profile is flat and cannot be shown");
                let help =
                    "give it thickness with `.extrude(height)`, or turn it with `.revolve()`";
                return self.fail(error.help(help));
            }
            if let Some(part) = node.untraceable() {
                return self.fail(super::certificates::without_constant(part, value.span));
            }
            if node.place().is_none() {
                *node = node.labelled(None, Some(place.clone()));
            }
        }
        Ok(nodes)
    }

    /// The value of a parameter: its default, or what the command line says.
    fn parameter(&mut self, parameter: &'a Parameter, is_script: bool) -> Eval<Value> {
        let default = self.eval(&parameter.default)?;
        let program = self.program;
        let given = program
            .overrides
            .iter()
            .rev()
            .find(|given| given.name.text == parameter.name.text);
        let (value, at) = match given {
            Some(given) if is_script => (
                self.override_value(given, &default, parameter)?,
                given.raw.span,
            ),
            _ => (default, parameter.default.span),
        };
        self.check_range(parameter, &value, at)?;
        Ok(value)
    }

    fn override_value(
        &mut self,
        given: &'a Override,
        default: &Value,
        parameter: &Parameter,
    ) -> Eval<Value> {
        if let Value::Text(_) = default {
            // A string needs no quotes on the command line.
            return match &given.value {
                Ok(expression) if matches!(expression.kind, Kind::Literal(Literal::Text(_))) => {
                    self.eval(expression)
                }
                _ => Ok(Value::Text(given.raw.text.clone())),
            };
        }
        let expression = match &given.value {
            Ok(expression) => expression,
            Err(diagnostics) => {
                self.diagnostics.extend(diagnostics.iter().cloned());
                return Err(Stop);
            }
        };
        let value = match literal(expression) {
            true => self.eval(expression)?,
            false => {
                let error = Diagnostic::error(
                    given.raw.span,
                    "a parameter is set to a plain value",
                )
                .help(
                    "a number, an angle, a colour, a string, true or false, or a vector of numbers",
                );
                return self.fail(error);
            }
        };
        if std::mem::discriminant(&value) == std::mem::discriminant(default) {
            return Ok(value);
        }
        let message = format!(
            "`{}` expects {}, but this is {}",
            parameter.name.text,
            default.noun(),
            value.noun()
        );
        let error = Diagnostic::error(given.raw.span, message)
            .label(value.shown())
            .note(parameter.name.span, "the parameter");
        self.fail(match default {
            Value::Angle(_) => error.help("angles carry a unit, as in `45deg`"),
            _ => error,
        })
    }

    fn check_range(&mut self, parameter: &'a Parameter, value: &Value, at: Span) -> Eval<()> {
        let Some(range) = &parameter.range else {
            return Ok(());
        };
        let allowed = self.eval(range)?;
        let is_in = match (&allowed, value) {
            (Value::Range(range), Value::Number(x)) if !range.is_angle => range.contains(*x),
            (Value::Range(range), Value::Angle(x)) if range.is_angle => range.contains(*x),
            (Value::List(_) | Value::Vector2(_) | Value::Vector3(_), _) => {
                let count = self.count_of(&allowed, range.span)?;
                (0..count).any(|i| {
                    super::operators::equal(&super::machine::item_of(&allowed, i), value)
                        == Some(true)
                })
            }
            (Value::Range(_), Value::Number(_) | Value::Angle(_)) => {
                let message = "the range of a number is of numbers, that of an angle of angles";
                let error = Diagnostic::error(range.span, message).label(allowed.shown());
                return self.fail(error.help("angles carry a unit, as in `45deg`"));
            }
            _ => {
                let message = "a parameter's range is a range of numbers or a list of values";
                let error = Diagnostic::error(range.span, message).label(allowed.shown());
                return self.fail(error.help("as in `param n = 5 in 1..=12`"));
            }
        };
        if is_in {
            return Ok(());
        }
        let words = self.program.sources.text(range.span).to_string();
        let message = format!("`{}` must be in {words}", parameter.name.text);
        let error = Diagnostic::error(at, message).label(value.shown());
        let error = match (&allowed, value) {
            // A list of two numbers is easily taken for a range.
            (Value::Vector2(_), Value::Number(_)) => error.help(
                "a list has all values that are allowed; for those between two, write `0..=1`",
            ),
            _ => error,
        };
        self.fail(match at.file == parameter.name.span.file {
            true => error,
            false => error.note(parameter.name.span, "the parameter"),
        })
    }

    /// Reports values on the command line for parameters that the script does not have.
    fn check_overrides(&mut self) {
        let program = self.program;
        let parameters: Vec<&str> = program.modules[0]
            .statements
            .iter()
            .filter_map(|statement| match &statement.kind {
                StatementKind::Parameter(parameter) => Some(&*parameter.name.text),
                StatementKind::Broken(Some(name)) => Some(&*name.text),
                _ => None,
            })
            .collect();
        for given in &program.overrides {
            let name = &given.name;
            if parameters.contains(&&*name.text) {
                continue;
            }
            let message = format!("the script has no parameter `{}`", name.text);
            let help = match parameters[..] {
                [] => Some("parameters are declared with `param name = value`".into()),
                _ => super::hint::did_you_mean(&name.text, parameters.iter().copied()),
            };
            let _: Eval<()> = self.fail(Diagnostic::error(name.span, message).help_if(help));
        }
    }

    /// Makes every field and pattern that nothing has used yet, so that their errors are found.
    fn finish_fields(&mut self) {
        let program = self.program;
        for (number, module) in program.modules.iter().enumerate() {
            for index in 0..module.globals.len() {
                let id = GlobalId {
                    module: number as u32,
                    index: index as u32,
                };
                let StatementKind::Routine(routine) = &self.statement(id).kind else {
                    continue;
                };
                let mut rest = routine.formals.iter().skip(1);
                if self.is_exhausted()
                    || routine.formals.is_empty()
                    || rest.any(|formal| formal.default.is_none())
                {
                    continue;
                }
                let at = routine.name.span;
                match routine.kind {
                    RoutineKind::Function => {}
                    RoutineKind::Field => drop(self.field_shape(id, at)),
                    RoutineKind::Pattern => {
                        let pattern = super::value::Pattern {
                            kind: super::value::PatternKind::Routine(id, Vec::new()),
                            depth: 1,
                        };
                        drop(self.pattern_graph(&pattern, at));
                    }
                }
                self.clear();
            }
        }
    }

    /// Gathers the script's own shapes by name.
    fn name_shapes(&mut self, made: &mut Made) {
        let program = self.program;
        for (index, global) in program.modules[0].globals.iter().enumerate() {
            let id = GlobalId {
                module: 0,
                index: index as u32,
            };
            let node = match &self.globals[0][index] {
                Global::Ready(value @ Value::Shape(_)) => Some(value.clone()),
                Global::Ready(value @ Value::List(list))
                    if matches!(list.items.first(), Some(Value::Shape(_) | Value::List(_))) =>
                {
                    Some(value.clone())
                }
                _ => None,
            };
            let node = match node {
                Some(value) => {
                    // A list of mixed things is no shape, and that is no error.
                    let before = self.diagnostics.len();
                    let node = self.shape(&value, global.name.span).ok();
                    self.diagnostics.truncate(before);
                    node
                }
                None => self.fields.get(&id).cloned().flatten(),
            };
            if let Some(node) = node {
                made.names.insert(global.name.text.to_string(), node);
            }
        }
    }
}

/// The value as the command line would take it.
fn plain(value: &Value) -> String {
    match value {
        Value::Text(text) => text.to_string(),
        other => other.to_string(),
    }
}

/// Whether the expression is a plain value: a literal, or numbers with a sign or in a vector.
fn literal(expression: &Expression) -> bool {
    match &expression.kind {
        Kind::Literal(_) => true,
        Kind::Negate(inner) => literal(inner),
        Kind::List(items) => items.iter().all(literal),
        Kind::Postfix(postfix) => match (&postfix.base.kind, &postfix.steps[..]) {
            (Kind::Name(word, _), [Step::Call(arguments)]) => {
                &*word.text == "rgb" && arguments.items.iter().all(|a| literal(&a.value))
            }
            _ => false,
        },
        _ => false,
    }
}
