//! Forward inclusion: what the field does ahead is bounded from below by lines and by crossings of levels, and the step goes to
//! where the best bound comes to zero.
//!
//! Each step asks the tree once (`trace/probe.rs`): its value, the lines below and above it over a stretch ahead, and how far it
//! surely keeps its sign. The step is the longest that the constant, the line or the crossing allows, and the next stretch is four
//! times as long. Where that is less than the tolerance, a window of the ray is left to certified sphere tracing, which encloses
//! a change of sign or says that there is none. Sources: Aydinlilar and Zanni 2023, forward inclusion functions, for the lines;
//! Galin et al. 2020 for stretches; what the window does is cited in `certified.rs`.
//!
//! Guarantees: as `certified`: where the constants are right, no changes of sign farther apart than rounding are passed over, and a hit
//! is one, enclosed to rounding; two samples that refute a constant make the ray unknown. Does not: where doubts or steps run
//! out, it stays unknown, for ranges to decide.

use super::{Certified, Ending, Segment, Walk};
use crate::trace::Verdict;
use crate::trace::probe::Ahead;

/// A walk by forward inclusion.
pub struct Probing {
    segment: Segment,
    t: f64,
    /// How long the stretch is over which lines are asked for.
    reach: f64,
    steps: u32,
    /// Whether the ray is inside; none before the first value.
    is_inside: Option<bool>,
    /// A window that is left to another walk, and where it ends.
    window: Option<(Certified, f64)>,
    far: f64,
}

impl Probing {
    /// How much longer than the last step the next stretch is.
    pub const GROWTH: f64 = 4.0;

    /// How long a window is, in tolerances.
    const WINDOW: f64 = 4.0;

    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }

    /// The tolerance at `t`, but not less than what rounding leaves.
    fn epsilon(&self, t: f64) -> f64 {
        self.segment.epsilon(t).max(self.segment.finest(t))
    }

    /// Leaves the next piece of the ray to certified sphere tracing, which knows the value here.
    fn open_window(&mut self, value: f64) {
        let Segment { start, end, .. } = self.segment;
        let until = (self.t + Self::WINDOW * self.epsilon(self.t)).min(end);
        let segment = Segment {
            end: until,
            ..self.segment
        };
        // At the start it has to tell what the ray may have started on.
        let walk = if self.t == start {
            Certified::begin(segment)
        } else {
            let next = (self.t + self.epsilon(self.t)).min(until);
            let known = (value != 0.0).then_some((self.t, value));
            Certified::resume(segment, known, next, true, 1, f64::INFINITY)
        };
        self.window = Some((walk, until));
    }

    /// How far the ray surely goes on without a change of sign.
    fn free(&self, ahead: &Ahead, is_inside: bool) -> f64 {
        let Segment { lipschitz, .. } = self.segment;
        let noise = self.segment.noise(self.t);
        let (height, slope) = if is_inside {
            (-ahead.value - noise, -ahead.slope[1])
        } else {
            (ahead.value - noise, ahead.slope[0])
        };
        if height <= 0.0 {
            return 0.0;
        }
        // A slope that is not a number says nothing.
        let by_line = if -slope * self.reach <= height {
            self.reach
        } else {
            height / -slope
        };
        let by_level = ahead.free - noise / lipschitz;
        // Where one is not a number, the others count.
        (height / lipschitz).max(by_line).max(by_level)
    }
}

impl Walk for Probing {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        // Of a ray without end the first stretch is as long as what is known of the shape.
        let length = segment.end - segment.start;
        Self {
            segment,
            t: segment.start,
            reach: if length.is_finite() {
                length
            } else {
                segment.size.max(1.0)
            },
            steps: 0,
            is_inside: None,
            window: None,
            far: f64::INFINITY,
        }
    }

    fn t(&self) -> f64 {
        match &self.window {
            Some((walk, _)) => walk.t(),
            None => self.t,
        }
    }

    fn probe(&self) -> Option<f64> {
        let is_probing = self.window.is_none() && !self.segment.is_sheet;
        is_probing.then(|| self.reach.max(self.epsilon(self.t)))
    }

    fn ahead(&mut self, ahead: Ahead) -> Option<Ending> {
        self.steps += 1;
        let Segment { start, end, .. } = self.segment;
        let value = ahead.value;
        if value.is_nan() {
            return Some(Ending::broken(self.t, self.steps));
        }
        if self.steps == 1 {
            self.far = self.segment.far(value);
        }
        // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
        let enters = start > 0.0 && self.t == start;
        let is_negative = value < 0.0 && !enters;
        let is_inside = *self.is_inside.get_or_insert(is_negative);
        let free = self.free(&ahead, is_inside);
        let is_over = self.t + free >= end;
        if is_over && free > 0.0 {
            return self.end(Verdict::Miss, end, 0.0);
        }
        if self.t > self.far {
            let verdict = self.segment.verdict_at_far(self.t, free);
            return self.end(verdict, self.t, f64::INFINITY);
        }
        if self.steps >= self.segment.max_steps {
            return self.end(Verdict::Unknown, self.t, f64::INFINITY);
        }
        if free < self.epsilon(self.t) {
            self.open_window(value);
            return None;
        }
        self.t += free;
        let left = end - self.t;
        self.reach = (Self::GROWTH * free).min(left);
        None
    }

    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending> {
        if self.window.is_none() {
            // A field that is never negative has no changes of sign to be free of.
            self.window = Some((Certified::begin(self.segment), self.segment.end));
        }
        let (walk, until) = self.window.as_mut()?;
        let until = *until;
        let ending = walk.observe(value, slope)?;
        if ending.verdict == Verdict::Miss && until < self.segment.end {
            // The window is free.
            self.window = None;
            self.steps += ending.steps;
            self.t = until;
            self.is_inside = None;
            self.reach = Self::GROWTH * self.epsilon(until);
            return None;
        }
        let steps = self.steps + ending.steps;
        let t = if ending.verdict == Verdict::Miss {
            self.segment.end
        } else {
            ending.t
        };
        Some(Ending { steps, t, ..ending })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Footprint;

    fn walk() -> Probing {
        Probing::begin(Segment {
            start: 0.0,
            end: 10.0,
            lipschitz: 2.0,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
            tolerance: 0.1,
            max_steps: 100,
            size: 10.0,
            is_sheet: false,
            is_endless: false,
            omega: 1.0,
        })
    }

    /// Where a walk is after this answer.
    fn after(value: f64, slope: [f64; 2], free: f64) -> f64 {
        let mut walk = walk();
        assert_eq!(walk.probe(), Some(10.0));
        assert_eq!(walk.ahead(Ahead { value, slope, free }), None);
        walk.t()
    }

    #[test]
    fn the_longest_of_the_steps_is_taken() {
        let is_about = |t: f64, expected: f64| assert!((t - expected).abs() < 1e-9, "{t}");
        is_about(after(2.0, [-2.0, 2.0], 0.0), 1.0);
        is_about(after(2.0, [-0.5, 2.0], 0.0), 4.0);
        is_about(after(2.0, [-2.0, 2.0], 7.0), 7.0);
        // Inside, the line above counts.
        is_about(after(-2.0, [-2.0, 0.5], 0.0), 4.0);
    }

    #[test]
    fn what_is_not_a_number_allows_no_step() {
        for slope in [[f64::NAN; 2], [f64::NEG_INFINITY, f64::INFINITY]] {
            let t = after(2.0, slope, f64::NAN);
            assert!((t - 1.0).abs() < 1e-9, "{t}");
        }
        let broken = Ahead {
            value: f64::NAN,
            slope: [0.0; 2],
            free: 1.0,
        };
        let ending = walk().ahead(broken).expect("an end");
        assert_eq!(ending.verdict, Verdict::Unknown);
        assert!(!ending.is_open());
    }
}
