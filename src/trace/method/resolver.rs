//! What certified walks leave open, decided by ranges: rays that graze, whose steps have run out, or that run along a
//! wall.
//!
//! The segment is cut into pieces until each has one sign: by its range; where the field is monotone on it, by the signs at
//! its ends; or by its value in the middle and how steep it is on the piece, by its range or the Lipschitz constant. Where
//! that sign changes, the root is enclosed by halving. Near a tangent the derivative has one sign on every piece but that
//! of the tangent point, and along a face it is nearly zero, so what takes the constant a million values takes some dozens
//! here; and on a wall between two cells of a repetition, where no range decides, the constant does. Source: Mitchell 1990.
//!
//! Guarantees: no change of sign is passed over, if the constant is right; a touch without one is no hit. Where 4096
//! questions do not suffice (along the rim of a fractal), pieces are not cut any more below a thousandth of epsilon, and
//! where 8192 do not, below a sixteenth: a pair of roots that close is passed over. What takes more than 16 384 stays unknown.

use super::pieces::Pieces;
use super::{Ending, Segment, Walk};
use crate::num::Interval;
use crate::trace::Verdict;

/// What is being asked for.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The ranges over the nearest piece.
    Piece,
    /// The value at the far end of the nearest piece, on which the field is monotone.
    FarEnd,
    /// The value in the middle of the nearest piece, on which the field is at most so steep.
    Middle { steepness: f64 },
    /// The value in the middle of a piece that holds the root.
    Enclosing { negative_before: bool },
}

/// A walk that decides.
pub struct Resolver {
    segment: Segment,
    pieces: Pieces,
    phase: Phase,
    /// Up to where the sign of the field is known, and whether it is negative; none before the ray has left what it may
    /// have started on.
    known: Option<(f64, bool)>,
    steps: u32,
}

impl Resolver {
    /// How many questions are asked.
    const MOST: u32 = 16_384;

    /// After how many questions pieces are not cut any more below which share of epsilon.
    const COARSER: [(u32, f64); 2] = [(8192, 1.0 / 16.0), (4096, 1.0 / 1024.0)];

    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }

    fn unknown(&self) -> Option<Ending> {
        let free = self.known.map_or(self.segment.start, |(t, _)| t);
        self.end(Verdict::Unknown, free, f64::INFINITY)
    }

    /// The length from which on a piece at `t` is not cut.
    fn shortest(&self, t: f64) -> f64 {
        let coarser = Self::COARSER.iter().find(|(after, _)| self.steps > *after);
        let share = coarser.map_or(0.0, |(_, share)| *share);
        self.segment.finest(t).max(share * self.segment.epsilon(t))
    }

    fn look(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        if let Some(is_negative) = sign(value) {
            return self.settle(is_negative);
        }
        let (from, to) = self.pieces.nearest();
        if to.is_infinite() {
            return match self.pieces.is_too_far() {
                true => self.unknown(),
                false => self.cut(),
            };
        }
        let is_known_here = self.known.is_some_and(|(t, _)| t == from);
        if sign(slope).is_some() && is_known_here {
            self.phase = Phase::FarEnd;
            return None;
        }
        if to - from > self.shortest(to) && value.magnitude() > self.segment.noise(to) {
            let steepness = slope.magnitude().min(self.segment.lipschitz);
            self.phase = Phase::Middle { steepness };
            return None;
        }
        if self.segment.is_sheet && self.known.is_some() {
            return self.end(Verdict::Hit, to, (to - from).max(self.segment.finest(to)));
        }
        self.next()
    }

    fn cut(&mut self) -> Option<Ending> {
        self.pieces.cut();
        self.phase = Phase::Piece;
        None
    }

    /// The sign on the nearest piece is known: a root lies before it, if it differs from the sign before.
    fn settle(&mut self, is_negative: bool) -> Option<Ending> {
        let (from, to) = self.pieces.nearest();
        match self.known {
            Some((before, negative_before)) if negative_before != is_negative => {
                self.pieces.precede((before, from));
                self.enclose(negative_before)
            }
            _ => {
                self.known = Some((to, is_negative));
                self.next()
            }
        }
    }

    /// The value in the middle of the nearest piece, from which the field rises or falls at most so fast.
    fn judge(&mut self, value: f64, steepness: f64) -> Option<Ending> {
        let (from, to) = self.pieces.nearest();
        let reach = 0.5 * (to - from) * steepness * (1.0 + 1e-9);
        match value.abs() > reach + self.segment.noise(to) {
            true => self.settle(value < 0.0),
            false => self.cut(),
        }
    }

    /// On the nearest piece the field is monotone, and its sign at the near end is known.
    fn compare(&mut self, far_end: f64) -> Option<Ending> {
        let ((from, to), known) = (self.pieces.nearest(), self.known);
        let far_end = (far_end.abs() > self.segment.noise(to)).then_some(far_end < 0.0);
        let (Some(is_negative), Some((_, negative_before))) = (far_end, known) else {
            return match to - from > self.shortest(to) {
                true => self.cut(),
                false => self.next(),
            };
        };
        if is_negative != negative_before {
            return self.enclose(negative_before);
        }
        self.known = Some((to, is_negative));
        self.next()
    }

    /// Goes on to the next piece.
    fn next(&mut self) -> Option<Ending> {
        self.phase = Phase::Piece;
        match self.pieces.pass() {
            true => self.end(Verdict::Miss, self.segment.end, 0.0),
            false => None,
        }
    }

    /// Narrows the nearest piece, which holds a root, until it is as narrow as rounding allows.
    fn enclose(&mut self, negative_before: bool) -> Option<Ending> {
        let (from, to) = self.pieces.nearest();
        let finest = self.segment.finest(to);
        if to - from <= finest {
            return self.end(Verdict::Hit, from + 0.5 * (to - from), finest);
        }
        self.phase = Phase::Enclosing { negative_before };
        None
    }

    fn halve(&mut self, negative_before: bool, value: f64) -> Option<Ending> {
        if value == 0.0 {
            let middle = self.pieces.middle();
            return self.end(Verdict::Hit, middle, self.segment.finest(middle));
        }
        self.pieces.keep((value < 0.0) == negative_before);
        self.enclose(negative_before)
    }
}

/// Whether the numbers of an interval are negative; none where that is not sure.
fn sign(range: Interval) -> Option<bool> {
    (range.lo > 0.0 || range.hi < 0.0).then_some(range.hi < 0.0)
}

impl Walk for Resolver {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        // The region holds the solid, so a ray that comes into it is outside.
        let known = (segment.start > 0.0).then_some((segment.start, false));
        Self {
            segment,
            pieces: Pieces::of(&segment),
            phase: Phase::Piece,
            known,
            steps: 0,
        }
    }

    fn t(&self) -> f64 {
        match self.phase {
            Phase::Piece => self.pieces.nearest().0,
            Phase::FarEnd => self.pieces.nearest().1,
            Phase::Middle { .. } | Phase::Enclosing { .. } => self.pieces.middle(),
        }
    }

    fn reach(&self) -> Option<f64> {
        matches!(self.phase, Phase::Piece).then(|| self.pieces.nearest().1)
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        self.steps += 1;
        if value.is_nan() {
            return Some(Ending::broken(self.t(), self.steps));
        }
        match self.phase {
            Phase::Piece => self.look(Interval::point(value), Interval::ENTIRE),
            Phase::FarEnd => self.compare(value),
            Phase::Middle { steepness } => self.judge(value, steepness),
            Phase::Enclosing { negative_before } => self.halve(negative_before, value),
        }
    }

    fn survey(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        self.steps += 1;
        if self.steps > Self::MOST {
            return self.unknown();
        }
        self.look(value, slope)
    }
}
