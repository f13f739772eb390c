//! What rays are expected to find, and how they fared: `hits` and `misses`.

use super::arguments::Given;
use super::machine::{Eval, Machine};
use super::value::Value;
use crate::scene::{Camera, TraceRecord};
use std::sync::Arc;

/// How a ray fared against what a script expects of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Judgement {
    /// It found what it should.
    Right,
    /// A surface at another distance, off by this, in scene units.
    Off(f64),
    /// A surface where there is none.
    FalseHit,
    /// No surface where there is one.
    FalseMiss,
    /// It did not find out.
    Unknown,
    /// Something else that is expected is not so.
    Failed,
}

/// How the rays of a test fared.
#[derive(Clone, Debug, Default)]
pub(super) struct Fates {
    /// In the order in which they were judged.
    pub judgements: Vec<Judgement>,
    /// The most steps that a ray took.
    pub steps: u32,
    /// Whether some ray did not find out.
    has_unknown: bool,
}

impl Fates {
    /// Takes note of a ray.
    pub fn count(&mut self, record: &TraceRecord) {
        self.steps = self.steps.max(record.steps);
        self.has_unknown |= record.verdict == "unknown";
    }

    /// An expectation was met, or not: what the rays that it speaks of, from number `first` on, were judged to be counts
    /// only where it was not. Who expects a hit or a miss gets either.
    pub fn settle(&mut self, first: usize, is_met: bool) {
        let own = &mut self.judgements[first..];
        let is_told = own
            .iter()
            .any(|j| !matches!(j, Judgement::Right | Judgement::Unknown));
        if is_met {
            let known = own.iter_mut().filter(|j| **j != Judgement::Unknown);
            known.for_each(|j| *j = Judgement::Right);
            if own.is_empty() {
                self.judgements.push(Judgement::Right);
            }
        } else if !is_told {
            // What follows from a ray that did not find out is not known either.
            let verdict = match self.has_unknown {
                true => Judgement::Unknown,
                false => Judgement::Failed,
            };
            self.judgements.push(verdict);
        }
    }
}

impl<'a> Machine<'a> {
    /// `ray.hits(t)`: whether a ray hit at a distance, to within the tolerance of the settings or the distance given.
    pub fn hits(&mut self, ray: &Given, t: &Given, within: Option<Given<'a>>) -> Eval<Value> {
        let record = self.record(ray, "hits")?;
        let Value::Number(expected) = t.value else {
            return self.unfit(t, "hits", "a number");
        };
        let spread = Camera::default().pixel(self.settings.size)[1];
        let pixel = self.settings.tolerance * spread * expected.abs();
        let within = self.positive_or(within, "within", "hits", pixel)?;
        let off = (record.t - expected).abs();
        let judgement = match record.verdict {
            "hit" if off <= within => Judgement::Right,
            "hit" => Judgement::Off(off),
            "miss" => Judgement::FalseMiss,
            _ => Judgement::Unknown,
        };
        self.fates.judgements.push(judgement);
        Ok(Value::Bool(judgement == Judgement::Right))
    }

    /// `ray.misses()`: whether a ray certainly hit nothing.
    pub fn misses(&mut self, ray: &Given) -> Eval<Value> {
        let record = self.record(ray, "misses")?;
        let judgement = match record.verdict {
            "hit" => Judgement::FalseHit,
            "miss" => Judgement::Right,
            _ => Judgement::Unknown,
        };
        self.fates.judgements.push(judgement);
        Ok(Value::Bool(judgement == Judgement::Right))
    }

    fn record(&mut self, ray: &Given, callee: &str) -> Eval<Arc<TraceRecord>> {
        match &ray.value {
            Value::Trace(record) => Ok(record.clone()),
            _ => self.unfit(ray, callee, "what `trace` gives"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(judgements: &[Judgement], is_met: bool, has_unknown: bool) -> Vec<Judgement> {
        let mut fates = Fates {
            judgements: judgements.to_vec(),
            steps: 0,
            has_unknown,
        };
        fates.settle(0, is_met);
        fates.judgements
    }

    #[test]
    fn an_expectation_that_is_met_forgives_what_it_allows() {
        use Judgement::{FalseHit, Off, Right, Unknown};
        assert_eq!(settled(&[FalseHit, Right], true, false), [Right, Right]);
        assert_eq!(settled(&[Unknown], true, true), [Unknown]);
        assert_eq!(settled(&[], true, false), [Right]);
        assert_eq!(settled(&[Right, Off(2.0)], false, false), [Right, Off(2.0)]);
    }

    #[test]
    fn an_expectation_that_is_not_met_is_told() {
        use Judgement::{Failed, Right, Unknown};
        assert_eq!(settled(&[], false, false), [Failed]);
        assert_eq!(settled(&[Right], false, false), [Right, Failed]);
        assert_eq!(settled(&[Right], false, true), [Right, Unknown]);
    }
}
