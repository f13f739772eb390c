//! Settles before evaluation what every name stands for, reports those that stand for nothing, and notes which are used.

use super::ast::*;
use super::builtin::{Builtin, Intrinsic};
use super::hint::{clipped, nearest};
use super::program::{Module, Program};
use super::report::Diagnostic;
use super::source::Word;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// After so many unknown names no more hints are looked for.
const MOST_HINTS: usize = 64;

/// Settles all names of the program, and reports what is unknown (errors) or unused (warnings).
pub(super) fn resolve(program: &mut Program, has_parse_errors: bool) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    let mut used = HashSet::new();
    for number in 0..program.modules.len() {
        let mut statements = std::mem::take(&mut program.modules[number].statements);
        let own = kinds_of(&statements, &program.modules[number]);
        for (index, statement) in statements.iter_mut().enumerate() {
            let defines = program.modules[number].defines[index];
            let mut resolver = Resolver {
                program,
                own: &own,
                module: number as u32,
                defines,
                diagnostics: &mut diagnostics,
                used: &mut used,
                locals: Vec::new(),
                slots: HashMap::new(),
                scope: 0,
            };
            resolver.statement(&mut statement.kind);
        }
        program.modules[number].statements = statements;
    }
    if !has_parse_errors {
        diagnostics.extend(unused(&program.modules[0], &used));
    }
    diagnostics
}

/// Warnings for what the script itself defines and never uses.
fn unused(module: &Module, used: &HashSet<GlobalId>) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for (index, global) in module.globals.iter().enumerate() {
        let noun = match &module.statements[global.statement].kind {
            StatementKind::Let(..) => "value",
            StatementKind::Material(..) => "material",
            StatementKind::Routine(routine) if routine.kind == RoutineKind::Function => "function",
            _ => continue,
        };
        let id = GlobalId {
            module: 0,
            index: index as u32,
        };
        let name = &global.name.text;
        if !used.contains(&id) && !name.starts_with('_') {
            let warning = Diagnostic::warning(
                global.name.span,
                format!("the {noun} `{name}` is never used"),
            )
            .help(format!("use it, or call it `_{name}`"));
            warnings.push(warning);
        }
    }
    warnings
}

/// As much as resolving needs to know of a global.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GlobalKind {
    Module(Option<u32>),
    Callable,
    Value,
}

fn kinds_of(statements: &[Statement], module: &Module) -> Vec<GlobalKind> {
    let kinds = module
        .globals
        .iter()
        .map(|global| match &statements[global.statement].kind {
            StatementKind::Import(import) => GlobalKind::Module(import.module),
            StatementKind::Routine(_) => GlobalKind::Callable,
            _ => GlobalKind::Value,
        });
    kinds.collect()
}

struct Resolver<'a> {
    program: &'a Program,
    own: &'a [GlobalKind],
    module: u32,
    /// The global that the statement defines: its own uses do not count.
    defines: Option<u32>,
    diagnostics: &'a mut Vec<Diagnostic>,
    used: &'a mut HashSet<GlobalId>,
    locals: Vec<Arc<str>>,
    slots: HashMap<Arc<str>, Vec<u32>>,
    /// The first local of the innermost scope.
    scope: usize,
}

impl Resolver<'_> {
    fn statement(&mut self, kind: &mut StatementKind) {
        match kind {
            StatementKind::Broken(_) | StatementKind::Import(_) => {}
            StatementKind::Parameter(parameter) => {
                self.expression(&mut parameter.default);
                if let Some(range) = &mut parameter.range {
                    self.expression(range);
                }
            }
            StatementKind::Let(_, value) | StatementKind::Show(value) => self.expression(value),
            StatementKind::Routine(routine) => self.routine(routine),
            StatementKind::Material(_, entries) | StatementKind::Settings(_, entries) => {
                for entry in entries {
                    self.expression(&mut entry.value);
                }
            }
            StatementKind::Test(test) => {
                for step in &mut test.steps {
                    match step {
                        TestStep::Expect(value) => self.expression(value),
                        TestStep::Let(name, value) => {
                            self.expression(value);
                            self.declare(name);
                        }
                    }
                }
            }
        }
    }

    fn routine(&mut self, routine: &mut Routine) {
        for formal in &mut routine.formals {
            if let Some(default) = &mut formal.default {
                self.expression(default);
            }
            self.declare(&formal.name);
        }
        if let Some(claim) = &mut routine.claim {
            self.expression(claim);
        }
        self.block(&mut routine.body);
        if routine.kind != RoutineKind::Function && routine.formals.is_empty() {
            let (noun, name) = (routine.kind.noun(), &routine.name);
            let error = Diagnostic::error(
                name.span,
                format!("the {noun} `{}` has no point", name.text),
            )
            .help(format!("write `{noun} {}(p) {{ ... }}`", name.text));
            self.diagnostics.push(error);
        }
    }

    fn declare(&mut self, name: &Word) {
        let slots = self.slots.entry(name.text.clone()).or_default();
        if slots
            .last()
            .is_some_and(|slot| *slot as usize >= self.scope)
        {
            let error = Diagnostic::error(name.span, format!("`{}` is defined twice", name.text))
                .help("a name is given its value once; choose another");
            self.diagnostics.push(error);
        }
        slots.push(self.locals.len() as u32);
        self.locals.push(name.text.clone());
    }

    /// Runs `inside` in a scope of its own.
    fn scoped(&mut self, inside: impl FnOnce(&mut Self)) {
        let outer = std::mem::replace(&mut self.scope, self.locals.len());
        inside(self);
        for name in self.locals.drain(self.scope..) {
            if let Some(slots) = self.slots.get_mut(&name) {
                slots.pop();
            }
        }
        self.scope = outer;
    }

    fn block(&mut self, block: &mut Block) {
        self.scoped(|inner| {
            for (name, value) in &mut block.locals {
                inner.expression(value);
                inner.declare(name);
            }
            inner.expression(&mut block.value);
        });
    }

    fn expression(&mut self, expression: &mut Expression) {
        match &mut expression.kind {
            Kind::Literal(_) => {}
            Kind::Name(word, binding) => *binding = self.value_binding(word),
            Kind::List(items) | Kind::Logic(_, items) => {
                for item in items {
                    self.expression(item);
                }
            }
            Kind::Chain(chain) => {
                self.expression(&mut chain.first);
                for (_, _, operand) in &mut chain.rest {
                    self.expression(operand);
                }
            }
            Kind::Compare(compare) => {
                self.expression(&mut compare.left);
                self.expression(&mut compare.right);
            }
            Kind::Power(pair) => {
                self.expression(&mut pair.0);
                self.expression(&mut pair.1);
            }
            Kind::Negate(operand) | Kind::Not(operand) => self.expression(operand),
            Kind::Range(range) => {
                self.expression(&mut range.low);
                self.expression(&mut range.high);
                if let Some(step) = &mut range.step {
                    self.expression(step);
                }
            }
            Kind::If(conditional) => {
                for (condition, block) in &mut conditional.arms {
                    self.expression(condition);
                    self.block(block);
                }
                self.block(&mut conditional.otherwise);
            }
            Kind::For(each) => {
                self.expression(&mut each.items);
                self.scoped(|inner| {
                    inner.declare(&each.variable);
                    if let Some(filter) = &mut each.filter {
                        inner.expression(filter);
                    }
                    inner.block(&mut each.body);
                });
            }
            Kind::Postfix(postfix) => self.postfix(postfix),
        }
    }

    fn postfix(&mut self, postfix: &mut Postfix) {
        if !self.module_member(postfix) {
            self.expression(&mut postfix.base);
        }
        let is_steps = matches!(
            &postfix.base.kind,
            Kind::Name(_, Binding::Builtin(Builtin::Intrinsic(Intrinsic::Steps)))
        );
        for step in &mut postfix.steps {
            match step {
                Step::Member(_) => {}
                Step::Index(index) => self.expression(index),
                Step::Call(arguments) => {
                    if is_steps {
                        quoted(arguments);
                    }
                    self.arguments(arguments);
                }
                Step::Method(word, binding, arguments) => {
                    *binding = self.method_binding(word);
                    self.arguments(arguments);
                }
            }
        }
    }

    fn arguments(&mut self, arguments: &mut Arguments) {
        for argument in &mut arguments.items {
            self.expression(&mut argument.value);
        }
    }

    /// Turns `module.name` into the global that it means; whether it was that.
    fn module_member(&mut self, postfix: &mut Postfix) -> bool {
        let Kind::Name(base, _) = &postfix.base.kind else {
            return false;
        };
        if self.local(&base.text).is_some() {
            return false;
        }
        let Some(GlobalKind::Module(module)) = self.own_global(&base.text) else {
            return false;
        };
        let (word, call) = match postfix.steps.remove(0) {
            Step::Member(word) => (word, None),
            Step::Method(word, _, arguments) => (word, Some(arguments)),
            other => {
                postfix.steps.insert(0, other);
                return false;
            }
        };
        let span = base.span.to(word.span);
        let alias = base.text.clone();
        let binding = module.map_or(Binding::Unknown, |module| {
            self.foreign(&alias, module, &word)
        });
        if let Some(arguments) = call {
            postfix.steps.insert(0, Step::Call(arguments));
        }
        postfix.base = Expression {
            span,
            kind: Kind::Name(word, binding),
        };
        true
    }

    /// A name of an imported module.
    fn foreign(&mut self, alias: &str, module: u32, word: &Word) -> Binding {
        let imported = &self.program.modules[module as usize];
        if let Some(index) = imported.names.get(&word.text) {
            return Binding::Global(GlobalId {
                module,
                index: *index,
            });
        }
        let candidates = imported.globals.iter().map(|global| &*global.name.text);
        let help = super::hint::did_you_mean(&word.text, candidates);
        let message = format!("`{alias}` has no `{}`", clipped(&word.text));
        self.diagnostics
            .push(Diagnostic::error(word.span, message).help_if(help));
        Binding::Unknown
    }

    fn local(&self, name: &str) -> Option<Binding> {
        let slot = self.slots.get(name)?.last()?;
        Some(Binding::Local(*slot))
    }

    fn own_global(&self, name: &str) -> Option<GlobalKind> {
        let index = self.own_index(name)?;
        Some(self.own[index as usize])
    }

    fn own_index(&self, name: &str) -> Option<u32> {
        self.program.modules[self.module as usize]
            .names
            .get(name)
            .copied()
    }

    fn global(&mut self, name: &str) -> Option<Binding> {
        let index = self.own_index(name)?;
        let id = GlobalId {
            module: self.module,
            index,
        };
        if self.defines != Some(index) {
            self.used.insert(id);
        }
        Some(Binding::Global(id))
    }

    /// What a name means that stands alone.
    fn value_binding(&mut self, word: &Word) -> Binding {
        if let Some(local) = self.local(&word.text) {
            return local;
        }
        if let Some(GlobalKind::Module(_)) = self.own_global(&word.text) {
            let error =
                Diagnostic::error(word.span, format!("`{}` is an imported file", word.text))
                    .help(format!("name something in it: `{}.name`", word.text));
            self.diagnostics.push(error);
            return Binding::Unknown;
        }
        if let Some(global) = self.global(&word.text) {
            return global;
        }
        match Builtin::named(&word.text) {
            Some(builtin) => Binding::Builtin(builtin),
            None => self.unknown(word, "name"),
        }
    }

    /// What a name means after a point: the script's functions come first, then what is built in, then other values.
    fn method_binding(&mut self, word: &Word) -> Binding {
        if let Some(GlobalKind::Callable) = self.own_global(&word.text)
            && let Some(global) = self.global(&word.text)
        {
            return global;
        }
        if let Some(builtin) = Builtin::named(&word.text) {
            return Binding::Builtin(builtin);
        }
        if let Some(local) = self.local(&word.text) {
            return local;
        }
        match self.global(&word.text) {
            Some(global) => global,
            None => self.unknown(word, "function"),
        }
    }

    fn unknown(&mut self, word: &Word, noun: &str) -> Binding {
        let message = format!("unknown {noun} `{}`", clipped(&word.text));
        let mut error = Diagnostic::error(word.span, message);
        if self.diagnostics.len() < MOST_HINTS {
            let own = &self.program.modules[self.module as usize].globals;
            let candidates = self
                .locals
                .iter()
                .map(|name| &**name)
                .chain(own.iter().map(|global| &*global.name.text))
                .chain(Builtin::names());
            error = match (nearest(&word.text, candidates), foreign_word(&word.text)) {
                (_, Some(help)) => error.help(help),
                (Some(name), _) => error.help(format!("did you mean `{name}`?")),
                (None, None) => error,
            };
        }
        self.diagnostics.push(error);
        Binding::Unknown
    }
}

/// Takes names that stand alone for words: `steps(mean)` is `steps("mean")`.
fn quoted(arguments: &mut Arguments) {
    for argument in &mut arguments.items {
        if let Kind::Name(word, _) = &argument.value.kind {
            argument.value.kind = Kind::Literal(Literal::Text(word.text.clone()));
        }
    }
}

/// What other languages call something that this one has.
fn foreign_word(word: &str) -> Option<&'static str> {
    Some(match word {
        "cube" | "cuboid" => "boxes of all kinds are `box([w, h, d])`",
        "PI" => "it is written `pi`",
        "color" | "colour" => "colours are written `#d9a441` or `rgb(r, g, b)`",
        "p" => {
            "a point has a name inside of a field or pattern: `field f(p) { return noise(p) }`, and its word is passed on"
        }
        "red" | "green" | "blue" | "white" | "black" | "yellow" => {
            "colours are written `#d9a441` or `rgb(r, g, b)`"
        }
        "hexagon" => "it is `regular_polygon(6)`, or `prism(6)` in space",
        "metaballs" => "metaballs are a `blob`",
        "move" => "shapes are moved with `.translate([x, y, z])`",
        _ => return None,
    })
}
