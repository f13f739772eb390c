//! The judge of the other methods: interval bisection along the whole ray, unpruned, in f64.
//!
//! The ray is cut into pieces from near to far until the sign of the field on each is sure: by its range, or by the mean
//! value form f(m) + f'(piece) (piece - m). Pieces as short as 1e-10 of the distance, or on which the field is nothing but
//! rounding, stay open. Where the signs on both sides of an open piece differ, the surface lies in it, and interval Newton
//! steps narrow it to rounding; where they do not, the field touches zero or the ray starts there, and that is no hit. A
//! field that is never negative has its surface at the first open piece. Sources: Moore 1966; Hansen 1978 for Newton's
//! method on intervals.
//!
//! Guarantees: the first change of sign is found, without any Lipschitz constant or box of the shape, and is known to
//! rounding. Does not: two surfaces closer than 1e-10 of the distance are not told from a touch, and nothing is looked for
//! further away than 2^60 times the size of the scene. What would take more than 200 000 ranges is unknown.

use super::{Ending, Segment, Walk};
use crate::num::Interval;
use crate::trace::Verdict;

/// What is being asked for.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The ranges over the nearest piece.
    Piece,
    /// The value in the middle of the nearest piece, whose derivative has this range.
    Middle { slope: Interval },
    /// The derivative over a piece that holds the surface; it is negative before or behind it.
    Slope { negative_before: bool },
    /// The value in the middle of that piece.
    Narrow {
        negative_before: bool,
        slope: Interval,
    },
    /// The value where a piece begins in which a field that is never negative reaches zero.
    Sheet,
}

/// A walk by the reference.
pub struct Reference {
    segment: Segment,
    /// The pieces that are still to be looked at, the nearest last.
    pieces: Vec<(f64, f64)>,
    phase: Phase,
    /// Up to where the sign of the field is known, and whether it is negative.
    known: Option<(f64, bool)>,
    /// A length that is not small: the size of what is known of the scene.
    size: f64,
    steps: u32,
}

impl Reference {
    /// How short a piece may get, as a share of the distance.
    const CLOSE: f64 = 1e-10;

    /// How short a piece may get where the ray starts, as a share of the size of what is known.
    const CLOSE_AT_START: f64 = 1.0 / (1u64 << 50) as f64;

    /// How many ranges are looked at.
    const MOST: u32 = 200_000;

    /// How many sizes of what is known a ray is followed.
    const FAR: f64 = (1u64 << 60) as f64;

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

    fn piece(&self) -> (f64, f64) {
        self.pieces.last().copied().unwrap_or_default()
    }

    /// Where a piece is cut; one without an end where it has doubled.
    fn middle(&self) -> f64 {
        let (from, to) = self.piece();
        if to.is_finite() {
            from + 0.5 * (to - from)
        } else {
            2.0 * from.max(self.size)
        }
    }

    /// Whether a piece is not cut any more.
    fn is_short(&self, (from, to): (f64, f64)) -> bool {
        to - from <= (Self::CLOSE * to).max(Self::CLOSE_AT_START * self.size)
    }

    fn look(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        if let Some(is_negative) = sign(value) {
            return self.settle(is_negative);
        }
        let (from, to) = self.piece();
        if to.is_infinite() {
            if from <= Self::FAR * self.size {
                return self.cut();
            }
            // The sign is sure up to here, so nothing lies on the way to where nothing is any more.
            return match self.known {
                Some((t, _)) if t == from => self.end(Verdict::Miss, from, 0.0),
                _ => self.unknown(),
            };
        }
        let is_rounding = value.magnitude() <= self.segment.noise(to);
        if !is_rounding && !self.is_short((from, to)) {
            self.phase = Phase::Middle { slope };
            return None;
        }
        if self.segment.is_sheet && self.known.is_some() {
            self.phase = Phase::Sheet;
            return None;
        }
        self.next()
    }

    /// The mean value form over a piece; it is cut where that does not decide either.
    fn judge(&mut self, middle: Interval, slope: Interval) -> Option<Ending> {
        let (from, to) = self.piece();
        let away = Interval::new(from, to) - Interval::point(self.middle());
        match sign(middle + slope * away) {
            Some(is_negative) => self.settle(is_negative),
            None => self.cut(),
        }
    }

    fn cut(&mut self) -> Option<Ending> {
        let ((from, to), middle) = (self.piece(), self.middle());
        self.pieces.pop();
        self.pieces.push((middle, to));
        self.pieces.push((from, middle));
        self.phase = Phase::Piece;
        None
    }

    /// The sign on the nearest piece is known.
    fn settle(&mut self, is_negative: bool) -> Option<Ending> {
        let (from, to) = self.piece();
        if let Some((before, negative_before)) = self.known
            && negative_before != is_negative
        {
            self.pieces.push((before, from));
            self.phase = Phase::Slope { negative_before };
            return None;
        }
        self.known = Some((to, is_negative));
        self.next()
    }

    /// Goes on to the next piece.
    fn next(&mut self) -> Option<Ending> {
        self.pieces.pop();
        self.phase = Phase::Piece;
        match self.pieces.is_empty() {
            true => self.end(Verdict::Miss, self.segment.end, 0.0),
            false => None,
        }
    }

    /// Narrows the piece that holds the surface by what its middle says, until that is rounding.
    fn narrow(
        &mut self,
        negative_before: bool,
        slope: Interval,
        value: Interval,
    ) -> Option<Ending> {
        let ((from, to), middle) = (self.piece(), self.middle());
        let (mut low, mut high) = (from, to);
        match sign(value) {
            Some(is_negative) if is_negative == negative_before => low = middle,
            Some(_) => high = middle,
            None => {}
        }
        if sign(slope).is_some() {
            let root = Interval::point(middle) - value / slope;
            low = low.max(root.lo);
            high = high.min(root.hi);
        }
        let has_narrowed = high - low < 0.75 * (to - from);
        if low > high || !has_narrowed {
            let finest = 4.0 * f64::EPSILON * self.size.max(middle);
            return self.end(Verdict::Hit, middle, (to - from).max(finest));
        }
        self.pieces.pop();
        self.pieces.push((low, high));
        self.phase = Phase::Slope { negative_before };
        None
    }

    /// The surface of a field that is never negative: near it, distances are linear.
    fn reach_sheet(&self, value: Interval, slope: Interval) -> Option<Ending> {
        let (from, to) = self.piece();
        let t = from - value.mid() / slope.mid();
        // It may lie a little behind a piece that only rounding left open.
        let is_near = slope.hi < 0.0 && t - from <= 2.0 * (to - from);
        let t = if is_near { t } else { to };
        self.end(Verdict::Hit, t, to - from)
    }
}

/// Whether the numbers of an interval are negative; none where that is not sure.
fn sign(range: Interval) -> Option<bool> {
    (range.lo > 0.0 || range.hi < 0.0).then_some(range.hi < 0.0)
}

impl Walk for Reference {
    const NEEDS_SLOPE: bool = false;
    const RESTS_ON_CONSTANT: bool = false;

    fn begin(segment: Segment) -> Self {
        let size = segment.size.max(segment.footprint.at_origin);
        Self {
            segment,
            pieces: vec![(segment.start, segment.end)],
            phase: Phase::Piece,
            known: None,
            size: if size > 0.0 { size } else { 1.0 },
            steps: 0,
        }
    }

    fn t(&self) -> f64 {
        match self.phase {
            Phase::Middle { .. } | Phase::Narrow { .. } => self.middle(),
            _ => self.piece().0,
        }
    }

    fn reach(&self) -> Option<f64> {
        Some(match self.phase {
            Phase::Piece | Phase::Slope { .. } => self.piece().1,
            _ => self.t(),
        })
    }

    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending> {
        self.survey(Interval::point(value), Interval::point(slope))
    }

    fn survey(&mut self, value: Interval, slope: Interval) -> Option<Ending> {
        self.steps += 1;
        if self.steps > Self::MOST {
            return self.unknown();
        }
        match self.phase {
            Phase::Piece => self.look(value, slope),
            Phase::Middle { slope } => self.judge(value, slope),
            Phase::Slope { negative_before } => {
                self.phase = Phase::Narrow {
                    negative_before,
                    slope,
                };
                None
            }
            Phase::Narrow {
                negative_before,
                slope,
            } => self.narrow(negative_before, slope, value),
            Phase::Sheet => self.reach_sheet(value, slope),
        }
    }
}
