//! The evaluator: walks expressions, keeps names, counts steps, and remembers the calls that led to an error.

use super::arguments::{Given, bind};
use super::ast::*;
use super::hint::{clipped, counted};
use super::limits::*;
use super::program::Program;
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::value::{Range, Value};
use crate::scene::{
    Camera, CameraRecord, FieldShape, GraphBuilder, Mark, Node, Place, Settings, Tracer,
};
use std::collections::HashMap;
use std::sync::Arc;

/// Evaluation stopped; why is in the report already.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop;

/// What evaluation gives.
pub(super) type Eval<T> = Result<T, Stop>;

/// The value of a global, so far.
#[derive(Clone, Debug)]
pub(super) enum Global {
    /// Its statement was not reached yet.
    Unset,
    Ready(Value),
    /// Its statement failed, which was reported: whatever needs it stops silently.
    Poisoned,
}

/// Evaluates a program.
pub(super) struct Machine<'a> {
    pub program: &'a Program,
    pub tracer: &'a dyn Tracer,
    pub globals: Vec<Vec<Global>>,
    pub diagnostics: Vec<Diagnostic>,
    /// The shapes of fields with default arguments.
    pub fields: HashMap<GlobalId, Option<Arc<Node>>>,
    /// Every field that was made, whose constants take time to derive.
    pub derived: Vec<(GlobalId, Arc<FieldShape>)>,
    effort: u64,
    /// Everything that is shown, for `trace`.
    pub shown: Vec<Arc<Node>>,
    pub settings: Settings,
    /// The point of view, while tests run.
    pub camera: Option<Camera>,
    /// What its rays took, once that was asked for.
    pub record: Option<Arc<CameraRecord>>,
    /// How rays of the test that runs fared.
    pub fates: super::judgement::Fates,
    /// The graphs of the fields that are being made, the innermost last.
    pub builders: Vec<GraphBuilder>,
    /// The calls that are open: where, and what is said of it.
    pub calls: Vec<(Span, &'static str)>,
    locals: Vec<Value>,
    base: usize,
    open: usize,
    steps: u64,
    made: u64,
}

impl<'a> Machine<'a> {
    /// A machine that has evaluated nothing yet.
    pub fn new(program: &'a Program, tracer: &'a dyn Tracer) -> Self {
        let globals = program.modules.iter();
        Self {
            program,
            tracer,
            globals: globals
                .map(|module| vec![Global::Unset; module.globals.len()])
                .collect(),
            diagnostics: Vec::new(),
            fields: HashMap::new(),
            derived: Vec::new(),
            effort: 0,
            shown: Vec::new(),
            settings: Settings::default(),
            camera: None,
            record: None,
            fates: super::judgement::Fates::default(),
            builders: Vec::new(),
            calls: Vec::new(),
            locals: Vec::new(),
            base: 0,
            open: 0,
            steps: 0,
            made: 0,
        }
    }

    /// Reports an error with the calls that led to it.
    pub fn fail<T>(&mut self, mut diagnostic: Diagnostic) -> Eval<T> {
        const INNERMOST: usize = 3;
        let calls: Vec<_> = self
            .calls
            .iter()
            .rev()
            .filter(|(_, words)| !words.is_empty())
            .collect();
        let mut noted: Vec<Span> = Vec::new();
        for (span, words) in calls.iter().take(INNERMOST) {
            // A call that calls itself is one place.
            if !noted.contains(span) {
                noted.push(*span);
                diagnostic.notes.push((*span, (*words).into()));
            }
        }
        if let [between @ .., (span, words)] = &calls[..]
            && between.len() >= INNERMOST
        {
            let left_out = between.len() - INNERMOST;
            let words = match left_out {
                0 => (*words).into(),
                n => format!("{words}, with {} between", counted(n, "more call")),
            };
            diagnostic.notes.push((*span, words));
        }
        self.diagnostics.push(diagnostic);
        Err(Stop)
    }

    /// Counts `n` steps.
    #[inline]
    pub fn tick(&mut self, n: u64, at: Span) -> Eval<()> {
        self.steps += n;
        if self.steps > MAX_STEPS {
            return self.out_of_steps(at);
        }
        Ok(())
    }

    #[cold]
    fn out_of_steps(&mut self, at: Span) -> Eval<()> {
        // What comes after would stop at once: one report is enough.
        if self.steps >= u64::MAX / 2 {
            return Err(Stop);
        }
        self.steps = u64::MAX / 2;
        let message = format!("the script takes more than {MAX_STEPS} steps (limit MAX_STEPS)");
        self.fail(
            Diagnostic::error(at, message)
                .label("evaluation stopped here")
                .help("make fewer or simpler elements; a field with a claimed `lipschitz` counts for less"),
        )
    }

    /// Whether the steps have run out.
    pub fn is_exhausted(&self) -> bool {
        self.steps > MAX_STEPS
    }

    /// Starts counting afresh, and forgets what an interrupted statement left behind.
    pub fn reset(&mut self) {
        self.steps = 0;
        self.clear();
    }

    /// Forgets what an interrupted statement left behind.
    pub fn clear(&mut self) {
        self.unwind(0);
    }

    /// How many locals there are.
    pub fn depth(&self) -> usize {
        self.locals.len()
    }

    /// Forgets what an interrupted expectation left behind, but the locals up to this depth.
    pub fn unwind(&mut self, depth: usize) {
        self.locals.truncate(depth);
        self.builders.clear();
        (self.base, self.open) = (0, 0);
    }

    /// Counts a new shape.
    pub fn count_shape(&mut self, node: &Node, at: Span) -> Eval<()> {
        self.made += 1;
        if self.made > MAX_SHAPES {
            if self.made == MAX_SHAPES + 1 {
                let message =
                    format!("the script makes more than {MAX_SHAPES} shapes (limit MAX_SHAPES)");
                return self.fail(Diagnostic::error(at, message));
            }
            return Err(Stop);
        }
        // Bounds are found by a walk over the tree.
        self.tick(4 + node.size() / 8, at)?;
        self.count_effort(at)
    }

    /// Counts what it took to derive constants of fields since the last time.
    fn count_effort(&mut self, at: Span) -> Eval<()> {
        if self.derived.is_empty() {
            return Ok(());
        }
        let efforts = self.derived.iter().map(|(_, field)| field.graph.effort());
        let effort = efforts.sum();
        let before = std::mem::replace(&mut self.effort, effort);
        // An operation on intervals with derivatives takes about 160 ns, a step as long as two.
        self.tick((effort - before) / 2 + self.derived.len() as u64 / 16, at)
    }

    /// Where `span` is.
    pub fn place(&self, span: Span) -> Place {
        let line = self.program.sources.line(span);
        Place {
            file: self.program.sources.get(span.file).name.clone(),
            line: line as u32,
            mark: span.mark(),
        }
    }

    /// The statement that defines a global.
    pub fn statement(&self, id: GlobalId) -> &'a Statement {
        let module = &self.program.modules[id.module as usize];
        &module.statements[module.globals[id.index as usize].statement]
    }

    /// The routine that a global is.
    pub fn routine(&self, id: GlobalId) -> &'a Routine {
        match &self.statement(id).kind {
            StatementKind::Routine(routine) => routine,
            _ => unreachable!("only routines are called by their global"),
        }
    }

    /// The value of a global.
    pub fn global(&mut self, id: GlobalId, at: Span) -> Eval<Value> {
        if let StatementKind::Routine(routine) = &self.statement(id).kind {
            return Ok(Value::Routine(routine.kind, id));
        }
        match &self.globals[id.module as usize][id.index as usize] {
            Global::Ready(value) => Ok(value.clone()),
            Global::Poisoned => Err(Stop),
            Global::Unset => {
                let name =
                    &self.program.modules[id.module as usize].globals[id.index as usize].name;
                let message = format!("`{}` is used before it is defined", clipped(&name.text));
                let error = Diagnostic::error(at, message)
                    .note(name.span, "defined here")
                    .help("statements are evaluated in order: move the definition up");
                self.fail(error)
            }
        }
    }

    /// The value of an expression.
    pub fn eval(&mut self, expression: &'a Expression) -> Eval<Value> {
        self.tick(1, expression.span)?;
        match &expression.kind {
            Kind::Literal(literal) => Ok(Value::from(literal)),
            Kind::Name(_, Binding::Local(slot)) => {
                Ok(self.locals[self.base + *slot as usize].clone())
            }
            Kind::Name(word, binding) => self.named(word, *binding),
            kind => {
                self.open += 1;
                if self.open > MAX_OPEN_EXPRESSIONS {
                    self.open -= 1;
                    return self.too_many_open(expression.span);
                }
                // What a field computes is marked with the innermost expression that says so.
                let around = self.marked(expression.span.mark());
                let value = self.composed(kind, expression.span);
                around.map(|mark| self.marked(mark));
                self.open -= 1;
                value
            }
        }
    }

    /// Marks the operations to come, where a field is being made; gives the mark before.
    fn marked(&mut self, mark: Mark) -> Option<Mark> {
        self.builders.last_mut().map(|builder| builder.mark(mark))
    }

    #[cold]
    fn too_many_open(&mut self, at: Span) -> Eval<Value> {
        let message = format!(
            "expressions are nested deeper than {MAX_OPEN_EXPRESSIONS} levels (limit MAX_OPEN_EXPRESSIONS)"
        );
        self.fail(Diagnostic::error(at, message).help("does the recursion end?"))
    }

    fn composed(&mut self, kind: &'a Kind, at: Span) -> Eval<Value> {
        match kind {
            Kind::Literal(literal) => Ok(Value::from(literal)),
            Kind::Name(word, binding) => self.named(word, *binding),
            Kind::List(items) => self.list(items, at),
            Kind::Chain(chain) => self.chain(chain, at),
            Kind::Logic(connective, items) => self.logic(*connective, items),
            Kind::Compare(compare) => self.compare(compare, at),
            Kind::Power(pair) => self.power(&pair.0, &pair.1, at),
            Kind::Negate(operand) => self.negate(operand),
            Kind::Not(operand) => self.not(operand),
            Kind::Range(range) => self.range(range),
            Kind::If(conditional) => self.arms(&conditional.arms, &conditional.otherwise),
            Kind::For(each) => self.for_each(each, at),
            Kind::Postfix(postfix) => self.postfix(postfix),
        }
    }

    /// What a name stands for, evaluated.
    pub fn named(&mut self, word: &'a Word, binding: Binding) -> Eval<Value> {
        match binding {
            Binding::Unknown => Err(Stop),
            Binding::Local(slot) => Ok(self.locals[self.base + slot as usize].clone()),
            Binding::Global(id) => self.global(id, word.span),
            Binding::Builtin(super::builtin::Builtin::Constant(x)) => Ok(Value::Number(x)),
            Binding::Builtin(builtin) => Ok(Value::Builtin(builtin)),
        }
    }

    fn list(&mut self, items: &'a [Expression], at: Span) -> Eval<Value> {
        let items = items.iter().map(|item| self.eval(item));
        let items = items.collect::<Eval<Vec<_>>>()?;
        self.listed(items, at)
    }

    /// The list of these values, within the limits.
    pub fn listed(&mut self, items: Vec<Value>, at: Span) -> Eval<Value> {
        self.tick(items.len() as u64 / 4, at)?;
        let list = Value::list(items);
        if list.weight() > MAX_LIST {
            let message = format!(
                "the list has {}, more than {MAX_LIST} (limit MAX_LIST)",
                counted(list.weight(), "element")
            );
            return self.fail(Diagnostic::error(at, message));
        }
        if list.depth() > MAX_LIST_DEPTH {
            let message = format!(
                "lists are nested deeper than {MAX_LIST_DEPTH} levels (limit MAX_LIST_DEPTH)"
            );
            return self.fail(Diagnostic::error(at, message));
        }
        Ok(list)
    }

    fn range(&mut self, range: &'a RangeExpression) -> Eval<Value> {
        let (low, is_angle) = self.range_end(&range.low, None)?;
        let (high, _) = self.range_end(&range.high, Some(is_angle))?;
        let step = match &range.step {
            Some(step) => Some(self.range_end(step, Some(is_angle))?.0),
            None => None,
        };
        if let (Some(step), Some(expression)) = (step, &range.step)
            && (step == 0.0 || (step < 0.0 && low < high))
        {
            let message = if step == 0.0 {
                "the step of a range must not be zero"
            } else {
                "a negative step leads away from the end of the range"
            };
            let error = Diagnostic::error(expression.span, message);
            return self.fail(error.label(format!("this is {step}")));
        }
        Ok(Value::Range(Arc::new(Range {
            low,
            high,
            is_inclusive: range.is_inclusive,
            step,
            is_angle,
        })))
    }

    /// A finite number or angle for a range, and whether it is an angle, as it may have to be.
    fn range_end(&mut self, at: &'a Expression, is_angle: Option<bool>) -> Eval<(f64, bool)> {
        let (value, found) = match self.eval(at)? {
            Value::Number(x) if x.is_finite() => (x, false),
            Value::Angle(x) if x.is_finite() => (x, true),
            value => {
                let error = Diagnostic::error(at.span, "a range goes between finite numbers");
                return self.fail(error.label(value.shown()));
            }
        };
        if is_angle.is_some_and(|is_angle| is_angle != found) {
            let message = "a range is of numbers or of angles, not of both";
            let error = Diagnostic::error(at.span, message);
            return self.fail(error.help("angles carry a unit, as in `45deg`"));
        }
        Ok((value, found))
    }

    /// The value of a block, in a scope of its own.
    pub fn block(&mut self, block: &'a Block) -> Eval<Value> {
        if block.locals.is_empty() {
            return self.eval(&block.value);
        }
        let scope = self.locals.len();
        for (_, value) in &block.locals {
            let value = self.eval(value)?;
            self.locals.push(value);
        }
        let value = self.eval(&block.value)?;
        self.locals.truncate(scope);
        Ok(value)
    }

    /// Adds a local to the open scope.
    pub fn push_local(&mut self, value: Value) {
        self.locals.push(value);
    }

    /// The first arm whose condition holds. Where that depends on the point of a field, all arms are evaluated.
    fn arms(&mut self, arms: &'a [(Expression, Block)], otherwise: &'a Block) -> Eval<Value> {
        let Some(((condition, block), rest)) = arms.split_first() else {
            return self.block(otherwise);
        };
        match self.eval(condition)? {
            Value::Bool(true) => self.block(block),
            Value::Bool(false) => self.arms(rest, otherwise),
            Value::Condition(symbolic) => {
                let yes = self.block(block)?;
                let no = self.arms(rest, otherwise)?;
                self.select(symbolic, yes, no, condition.span)
            }
            value => self.no_condition(&value, condition.span),
        }
    }

    /// Reports a value that is no condition.
    pub fn no_condition<T>(&mut self, value: &Value, at: Span) -> Eval<T> {
        let message = format!("a condition is true or false, but this is {}", value.noun());
        let error = Diagnostic::error(at, message).label(value.shown());
        self.fail(match value {
            Value::Number(_) => error.help("compare it, as in `x > 0`"),
            _ => error,
        })
    }

    fn for_each(&mut self, each: &'a For, at: Span) -> Eval<Value> {
        let span = each.items.span;
        let items = self.eval(&each.items)?;
        let count = self.count_of(&items, span)?;
        let mut results = Vec::new();
        for i in 0..count {
            let scope = self.locals.len();
            self.locals.push(item_of(&items, i));
            if let Some(filter) = &each.filter {
                let is_in = match self.eval(filter)? {
                    Value::Bool(is_in) => is_in,
                    value => return self.no_condition(&value, filter.span),
                };
                if !is_in {
                    self.locals.truncate(scope);
                    continue;
                }
            }
            results.push(self.block(&each.body)?);
            self.locals.truncate(scope);
        }
        self.listed(results, at)
    }

    /// How many elements a list, vector or range has.
    pub fn count_of(&mut self, items: &Value, at: Span) -> Eval<usize> {
        match items {
            Value::List(list) => Ok(list.items.len()),
            Value::Range(range) if range.is_angle && range.step.is_none() => {
                let error = Diagnostic::error(at, "a range of angles needs a step");
                self.fail(error.help("as in `0deg..360deg step 45deg`"))
            }
            Value::Range(range) => {
                let count = range.count();
                if count <= MAX_LIST as f64 {
                    return Ok(count as usize);
                }
                let count = crate::catalogue::written(count);
                let message = format!(
                    "the range has {count} elements, more than {MAX_LIST} (limit MAX_LIST)"
                );
                self.fail(Diagnostic::error(at, message))
            }
            other => match other.quantity() {
                Some(quantity) if quantity.form == super::value::Form::Vector => Ok(quantity.count),
                _ => {
                    let message = format!(
                        "a list, a vector or a range is expected, but this is {}",
                        other.noun()
                    );
                    let error = Diagnostic::error(at, message).label(other.shown());
                    self.fail(match other {
                        Value::Number(n) if *n >= 0.0 && n.fract() == 0.0 => {
                            error.help(format!("write `0..{n}` for the numbers below it"))
                        }
                        _ => error,
                    })
                }
            },
        }
    }

    /// Runs `inside` where the arguments have their names.
    pub fn with_frame<T>(
        &mut self,
        id: GlobalId,
        at: Span,
        given: Vec<Given<'a>>,
        inside: impl FnOnce(&mut Self, &'a Routine) -> Eval<T>,
    ) -> Eval<T> {
        let routine = self.routine(id);
        let slots: Vec<_> = routine
            .formals
            .iter()
            .map(|formal| (&*formal.name.text, formal.default.is_none()))
            .collect();
        let bound = match bind(&routine.name.text, &slots, at, given) {
            Ok(bound) => bound,
            Err(diagnostic) => return self.fail(*diagnostic),
        };
        if self.calls.len() >= MAX_CALL_DEPTH {
            let message =
                format!("more than {MAX_CALL_DEPTH} calls are open at once (limit MAX_CALL_DEPTH)");
            let name = &routine.name.text;
            let help = format!("does the recursion of `{name}` end?");
            return self.fail(Diagnostic::error(at, message).help(help));
        }
        // A field that is made where it is defined was called by nobody.
        let words = if at == routine.name.span {
            ""
        } else {
            "called here"
        };
        self.calls.push((at, words));
        let base = std::mem::replace(&mut self.base, self.locals.len());
        let result = self.fill_frame(routine, bound);
        let result = result.and_then(|()| inside(self, routine));
        self.locals.truncate(self.base);
        self.base = base;
        self.calls.pop();
        result
    }

    fn fill_frame(&mut self, routine: &'a Routine, bound: Vec<Option<Given<'a>>>) -> Eval<()> {
        for (formal, given) in routine.formals.iter().zip(bound) {
            let value = match (given, &formal.default) {
                (Some(given), _) => given.value,
                (None, Some(default)) => self.eval(default)?,
                (None, None) => return Err(Stop),
            };
            self.locals.push(value);
        }
        Ok(())
    }
}

/// Element `i` of a list, vector or range.
pub(super) fn item_of(items: &Value, i: usize) -> Value {
    match items {
        Value::List(list) => list.items[i].clone(),
        Value::Range(range) => range.element(i),
        other => match other.quantity() {
            Some(quantity) => component_of(&quantity, i),
            None => other.clone(),
        },
    }
}

/// Component `i` as a number.
pub(super) fn component_of(quantity: &super::value::Quantity, i: usize) -> Value {
    super::value::Quantity::new(super::value::Form::Number, &[quantity.scalars[i]]).value()
}
