//! `test` blocks: expectations are evaluated once the scene is there.

use super::ast::*;
use super::machine::{Eval, Machine};
use super::operators::equal;
use super::report::{Diagnostic, Report};
use super::value::Value;

/// How a `test` block of a script went.
#[derive(Clone, Debug)]
pub struct TestResult {
    /// The name of the block.
    pub name: String,
    /// What failed: expectations with both sides, or errors. Empty where the test passed.
    pub failures: Report,
}

impl TestResult {
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
        for step in &test.steps {
            let outcome = match step {
                TestStep::Let(_, value) => self.eval(value).map(|value| self.push_local(value)),
                TestStep::Expect(expectation) => self.expect(expectation),
            };
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
