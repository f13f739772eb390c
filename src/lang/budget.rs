//! `budget { ... }` and `steps(...)`: what the camera's rays may take, and what they do.

use super::arguments::Given;
use super::ast::Entry;
use super::hint::did_you_mean;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::terms::Terms;
use super::value::Value;
use crate::catalogue::written;
use crate::scene::CameraRecord;
use std::sync::Arc;

/// A name in scripts, how its number is said, and where the number is found.
type Quantity = (&'static str, &'static str, fn(&CameraRecord) -> f64);

/// What is counted.
const QUANTITIES: [Quantity; 5] = [
    ("mean_steps", "steps a ray in the mean", |r| r.mean_steps),
    (
        "p99_steps",
        "steps are what 99 % of the rays don't exceed",
        |r| r.p99_steps.into(),
    ),
    ("max_steps", "steps are the most that a ray takes", |r| {
        r.max_steps.into()
    }),
    ("mean_evaluations", "evaluations a ray in the mean", |r| {
        r.mean_evaluations
    }),
    ("unknown", "rays end without an answer", |r| {
        r.unknown as f64
    }),
];

/// What the camera's rays may take.
#[derive(Clone, Debug)]
pub(super) struct Budget {
    span: Span,
    /// The numbers of quantities, what each may be at most, and where that stands.
    limits: Vec<(usize, f64, Span)>,
}

impl<'a> Machine<'a> {
    /// `budget { mean_steps: 20, ... }`
    pub fn budget(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Budget> {
        let known = QUANTITIES.map(|(name, ..)| name);
        let mut terms = Terms::new(self, (&word.text, word.span), entries, &known);
        let mut limits = Vec::new();
        for (i, name) in known.into_iter().enumerate() {
            if let Some((_, span)) = terms.get(name) {
                let range = ("zero or positive", |x| x >= 0.0);
                limits.push((i, terms.number(self, name, range, f64::INFINITY), span));
            }
        }
        if limits.is_empty() && !terms.is_broken {
            let error = Diagnostic::error(word.span, "this budget limits nothing");
            let help = "as in `budget { mean_steps: 20, p99_steps: 80, unknown: 0 }`";
            terms.note(self, error.help(help));
        }
        match terms.is_broken {
            true => Err(super::machine::Stop),
            false => Ok(Budget {
                span: word.span,
                limits,
            }),
        }
    }

    /// Holds a budget against what the camera's rays take; what is exceeded.
    pub fn hold(&mut self, budget: &Budget) -> Vec<Diagnostic> {
        self.reset();
        self.diagnostics.clear();
        if let Ok(record) = self.counted(budget.span) {
            for (quantity, most, span) in &budget.limits {
                let (name, words, of) = QUANTITIES[*quantity];
                let reached = of(&record);
                if reached > *most {
                    let message =
                        format!("the budget is exceeded: `{name}` is {}", shortened(reached));
                    let label = format!("{} {words}", shortened(reached));
                    let error = Diagnostic::error(*span, message).label(label);
                    self.diagnostics.push(error.help(worst(name, &record)));
                }
            }
        }
        std::mem::take(&mut self.diagnostics)
    }

    /// `steps(mean)`, `steps(p99)`, `steps(max)`
    pub fn steps(&mut self, which: &Given, at: Span) -> Eval<Value> {
        let Value::Text(word) = &which.value else {
            return self.unfit(which, "steps", "`mean`, `p99` or `max`");
        };
        let name = format!("{word}_steps");
        let Some((.., of)) = QUANTITIES[..3].iter().find(|(known, ..)| *known == name) else {
            let message = format!("`steps` knows no `{}`", super::hint::clipped(word));
            let help = did_you_mean(word, ["mean", "p99", "max"]);
            let help = help.unwrap_or("it is `mean`, `p99` or `max`".into());
            return self.fail(Diagnostic::error(which.span, message).help(help));
        };
        let record = self.counted(at)?;
        Ok(Value::Number(of(&record)))
    }

    /// What the camera's rays took; counted once.
    fn counted(&mut self, at: Span) -> Eval<Arc<CameraRecord>> {
        if let Some(record) = &self.record {
            return Ok(record.clone());
        }
        let Some(camera) = self.camera else {
            let message = "the camera's rays are only counted in tests";
            let help = "write it in a block, as in `test \"steps\" { expect steps(mean) < 20 }`";
            return self.fail(Diagnostic::error(at, message).help(help));
        };
        match self.tracer.count(&self.shown, &camera, &self.settings) {
            Ok(record) => {
                let record = Arc::new(record);
                self.record = Some(record.clone());
                Ok(record)
            }
            Err(problem) => self.fail(Diagnostic::error(at, problem)),
        }
    }
}

/// Where it is worst.
fn worst(name: &str, record: &CameraRecord) -> String {
    if let ("unknown", Some([x, y])) = (name, record.first_unknown) {
        return format!(
            "the first of them goes through pixel [{x}, {y}], counted from the upper left; `--channel verdict` shows all"
        );
    }
    let [x, y] = record.longest;
    let steps = record.max_steps;
    format!(
        "the longest ray takes {steps} steps through pixel [{x}, {y}], counted from the upper left; `fieldstone steps` shows \
         what steps are taken for"
    )
}

/// The number with four digits, for reading.
fn shortened(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    written(if x.fract() == 0.0 { x } else { rounded })
}
