//! `test` blocks: expectations are evaluated once the scene is there.

use super::ast::*;
use super::judgement::{Fates, Judgement};
use super::machine::{Eval, Machine};
use super::operators::equal;
use super::report::{Diagnostic, Report};
use super::source::Span;
use super::value::Value;
use crate::scene::CameraRecord;
use std::sync::Arc;

/// How a `test` block of a script, or its `budget`, went.
#[derive(Clone, Debug)]
pub struct TestResult {
    /// The name of the block; `budget` for that.
    pub name: String,
    /// What failed: expectations with both sides, or errors. Empty where the test passed.
    pub failures: Report,
    /// How every ray fared of which the test says whether it hits or misses, and every expectation that speaks of none.
    pub judgements: Vec<Judgement>,
    /// The most steps that a ray of the test took.
    pub steps: u32,
    /// What the camera's rays took, of a `budget`.
    pub record: Option<Arc<CameraRecord>>,
}

impl TestResult {
    /// How a `budget` went.
    pub(super) fn of_budget(failures: Report, record: Option<Arc<CameraRecord>>) -> Self {
        Self {
            name: "budget".into(),
            failures,
            judgements: Vec::new(),
            steps: record.as_ref().map_or(0, |record| record.max_steps),
            record,
        }
    }

    /// Whether every expectation was met.
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }
}

impl<'a> Machine<'a> {
    /// Runs one block; what failed.
    pub fn test(&mut self, test: &'a TestBlock) -> Vec<Diagnostic> {
        self.reset();
        self.diagnostics.clear();
        self.fates = Fates::default();
        for step in &test.steps {
            let before = self.fates.judgements.len();
            let depth = self.depth();
            let outcome = match step {
                TestStep::Let(_, value) => self.eval(value).map(|value| self.push_local(value)),
                TestStep::Expect(expectation) => self.expect(expectation),
            };
            if outcome.is_err() || matches!(step, TestStep::Expect(_)) {
                self.fates.settle(before, outcome.is_ok());
            }
            if outcome.is_err() {
                self.unwind(depth);
            }
            // Without a local the expectations after it mean nothing.
            if outcome.is_err() && matches!(step, TestStep::Let(..)) {
                break;
            }
        }
        std::mem::take(&mut self.diagnostics)
    }

    fn expect(&mut self, expectation: &'a Expression) -> Eval<()> {
        let Some(compare) = comparison(expectation) else {
            return match self.eval(expectation)? {
                Value::Bool(true) => Ok(()),
                Value::List(list) => self.expect_all(&list.items, expectation.span),
                Value::Bool(false) => {
                    let error = Diagnostic::error(expectation.span, "this is not so");
                    self.fail(error.label("this is false"))
                }
                value => self.no_condition(&value, expectation.span),
            };
        };
        let (left, right) = (self.eval(&compare.left)?, self.eval(&compare.right)?);
        let holds = match compare.comparison {
            Comparison::Equal => equal(&left, &right).map(Value::Bool),
            _ => None,
        };
        let holds = match holds {
            Some(holds) => holds,
            None => self.compared(compare.comparison, &left, &right, expectation.span)?,
        };
        if let Value::Bool(true) = holds {
            return Ok(());
        }
        let mark = compare.comparison.mark();
        let message = format!("{left} {mark} {right} is not so");
        let label = format!("left: {left}, right: {right}");
        let error = Diagnostic::error(expectation.span, message).label(label);
        self.fail(match (&left, &right) {
            (Value::Number(a), Value::Number(b)) if left.to_string() == right.to_string() => {
                error.help(format!("they differ by {:e}", a - b))
            }
            _ => error,
        })
    }
}

impl Machine<'_> {
    /// A list is expected to hold: each of its elements is true.
    fn expect_all(&mut self, items: &[Value], at: Span) -> Eval<()> {
        if items.is_empty() {
            return self.fail(Diagnostic::error(at, "an empty list expects nothing"));
        }
        for (i, item) in items.iter().enumerate() {
            match item {
                Value::Bool(true) => {}
                Value::Bool(false) => {
                    let error = Diagnostic::error(at, "this is not so for every element");
                    return self.fail(error.label(format!("element {i} is false")));
                }
                other => return self.no_condition(other, at),
            }
        }
        Ok(())
    }
}

/// The comparison that an expectation is, also in parentheses.
fn comparison(expression: &Expression) -> Option<&Compare> {
    match &expression.kind {
        Kind::Compare(compare) => Some(compare),
        Kind::Logic(_, items) => match &items[..] {
            [only] => comparison(only),
            _ => None,
        },
        _ => None,
    }
}
