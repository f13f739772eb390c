//! Interval analysis on the ray: a piece whose range of values does not hold 0 has no root; one whose range of derivatives
//! does not hold 0 has at most one, told by the signs at its ends and narrowed by halving; any other piece is halved, down
//! to epsilon. Source: Mitchell, Robust ray intersection with interval arithmetic, 1990; ranges of derivatives by
//! automatic differentiation, all rounded outwards.
//!
//! Guarantees: no root is passed over, without any Lipschitz constant, also of fields that jump. Does not: a piece as
//! short as epsilon that still cannot be decided is called a hit, also where the surface is only nearby, or where the
//! formula jumps between branches that meet (at the walls of a repetition).

use super::pieces::Pieces;
use super::{Ending, Segment, Walk};
use crate::num::Interval;
use crate::trace::Verdict;

/// What the walk is doing.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Asking for the ranges over the nearest piece.
    Piece,
    /// On a piece where the field is monotone: asking for its sign at the near end.
    NearEnd,
    /// The sign at the near end is known: asking for that at the far end.
    FarEnd { is_negative: bool },
    /// Narrowing the one root of a piece: asking for the sign in the middle.
    Narrowing { is_negative: bool },
}

/// A walk by ranges.
pub struct IntervalAnalysis {
    segment: Segment,
    pieces: Pieces,
    phase: Phase,
    steps: u32,
    /// Whether the ray has left the surface that it may have started on.
    has_departed: bool,
}

impl IntervalAnalysis {
    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }

    /// How short a piece may get.
    fn epsilon(&self, t: f64) -> f64 {
        let finest = 16.0 * f64::EPSILON * self.segment.size.max(t);
        self.segment.epsilon(t).max(finest)
    }

    /// Goes on behind the nearest piece, which holds no root.
    fn pass(&mut self) -> Option<Ending> {
        self.phase = Phase::Piece;
        match self.pieces.pass() {
            true => self.end(Verdict::Miss, self.segment.end, 0.0),
            false => None,
        }
    }

    fn halve(&mut self) -> Option<Ending> {
        if self.pieces.is_too_far() {
            let (from, _) = self.pieces.nearest();
            return self.end(Verdict::Unknown, from, f64::INFINITY);
        }
        self.pieces.cut();
        None
    }

    fn look(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        self.steps += 1;
        let (from, to) = self.pieces.nearest();
        if self.steps > self.segment.max_steps {
            return self.end(Verdict::Unknown, from, f64::INFINITY);
        }
        if is_sure(value) {
            self.has_departed = true;
            return self.pass();
        }
        if is_sure(slope) && to.is_finite() {
            self.phase = Phase::NearEnd;
            return None;
        }
        if !to.is_finite() || to - from > self.epsilon(to) {
            return self.halve();
        }
        if !self.has_departed {
            return self.pass();
        }
        self.end(Verdict::Hit, from + 0.5 * (to - from), to - from)
    }

    /// Takes the sign at the far end of a piece where the field is monotone.
    fn compare(&mut self, is_negative: bool, far_end: Interval) -> Option<Ending> {
        self.has_departed = true;
        let differs = (far_end.hi < 0.0) != is_negative;
        if !differs {
            return self.pass();
        }
        self.phase = Phase::Narrowing { is_negative };
        self.narrow()
    }

    fn narrow(&mut self) -> Option<Ending> {
        let (from, to) = self.pieces.nearest();
        match to - from <= self.epsilon(to) {
            true => self.end(Verdict::Hit, from + 0.5 * (to - from), to - from),
            false => None,
        }
    }

    /// Keeps the half of the piece that holds its root.
    fn keep(&mut self, is_negative: bool, middle: Interval) -> Option<Ending> {
        if !is_sure(middle) {
            let cut = self.pieces.middle();
            return self.end(Verdict::Hit, cut, self.epsilon(cut));
        }
        self.pieces.keep((middle.hi < 0.0) == is_negative);
        self.narrow()
    }
}

/// Whether the sign of all numbers of an interval is the same, and none is 0.
fn is_sure(range: Interval) -> bool {
    range.lo > 0.0 || range.hi < 0.0
}

impl Walk for IntervalAnalysis {
    const NEEDS_SLOPE: bool = false;
    const RESTS_ON_CONSTANT: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            segment,
            pieces: Pieces::of(&segment),
            phase: Phase::Piece,
            steps: 0,
            has_departed: segment.start > 0.0,
        }
    }

    fn t(&self) -> f64 {
        let (from, to) = self.pieces.nearest();
        match self.phase {
            Phase::Piece | Phase::NearEnd => from,
            Phase::FarEnd { .. } => to,
            Phase::Narrowing { .. } => self.pieces.middle(),
        }
    }

    fn reach(&self) -> Option<f64> {
        Some(match self.phase {
            Phase::Piece => self.pieces.nearest().1,
            _ => self.t(),
        })
    }

    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending> {
        self.survey(Interval::point(value), Interval::point(slope))
    }

    fn survey(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        match self.phase {
            Phase::Piece => self.look(value, slope),
            Phase::NearEnd => {
                // A root at the near end: what the ray starts on is no hit, and what follows a piece without a root is.
                if !is_sure(value) && self.has_departed {
                    let (from, _) = self.pieces.nearest();
                    return self.end(Verdict::Hit, from, self.epsilon(from));
                }
                // Where the sign is not sure, it is that which the slope leads to.
                let is_negative = if is_sure(value) {
                    value.hi < 0.0
                } else {
                    slope.hi < 0.0
                };
                self.phase = Phase::FarEnd { is_negative };
                None
            }
            Phase::FarEnd { is_negative } => self.compare(is_negative, value),
            Phase::Narrowing { is_negative } => self.keep(is_negative, value),
        }
    }
}
