//! The first root of a quartic without a cubic term, in lanes, by Newton's method from the side on which it can't overshoot.
//!
//! ```text
//! P(u) = u^4 + a u^2 + b u + c,   P''(u) = 12 u^2 + 2 a
//! ```
//!
//! P is convex up to -w and from w on, with w^2 = -a / 6, and concave between: three stretches. Where P or -P, whichever is
//! positive at the start, is convex, its tangents lie below it: Newton's method comes to the first root without passing it, and
//! where a tangent rises, or is still positive at the end of the stretch, there is none. Where it is concave it lies above
//! its chord: there is a root if it is negative at the end of the stretch, just one, and Newton's method comes to it from there.
//! So nothing is ever guessed; what depends on values that rounding may have made is left open.
//! Source: the theorem of Fourier on Newton's method, as in Ostrowski 1966, chapter 9.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::{WIDTH, lesser};
use super::packet::Lane;

/// What a lane does. As 64-bit numbers, so that they are as wide as the lanes.
pub(super) mod state {
    /// It comes to a root along tangents from the start of a convex stretch.
    pub const FORWARD: i64 = 0;
    /// It looks at the end of a concave stretch.
    pub const LOOKING: i64 = 1;
    /// It comes to a root from the end of a concave stretch.
    pub const BACKWARD: i64 = 2;
    /// It has a root.
    pub const FOUND: i64 = 3;
    /// There is none.
    pub const MISSED: i64 = 4;
    /// Rounding decides.
    pub const OPEN: i64 = 5;
}

/// No more steps are made. Each halves at least the distance to a root, double or not, and roots that are not found in so
/// many are left open.
const MOST_STEPS: usize = 48;

/// A root is known once the next step would not change it by more than this.
const FINE: f64 = 1e-17;

/// A slope squared up to this many doubts belongs to a double root, as far as is known: P'' is at most 160 where |u| <= 3
/// and |a| <= 26.
const FLAT: f64 = 1024.0;

/// 32 quartics, and how far the search for their first roots has come.
pub(super) struct Quartics {
    /// The coefficients of u^2, u and 1.
    pub square: Lane,
    pub linear: Lane,
    pub constant: Lane,
    /// Values below this are lost in rounding.
    pub doubt: Lane,
    /// 1 where values are positive at the start, or as soon as it is left, and -1 where they are negative.
    pub side: Lane,
    /// Where the search starts.
    pub from: Lane,
    /// Where it ends, beyond `from`.
    pub to: Lane,
    /// Where the root is.
    pub u: Lane,
    /// What each lane does or has found.
    pub state: [i64; WIDTH],
    /// Where the stretch ends that a lane is in.
    end: Lane,
    /// Where the one after it ends.
    later: Lane,
}

impl Quartics {
    /// No quartics yet: the public fields but the last two are to be filled in.
    #[inline(always)]
    pub fn new() -> Self {
        let zero = [0.0; WIDTH];
        Self {
            square: zero,
            linear: zero,
            constant: zero,
            doubt: zero,
            side: zero,
            from: zero,
            to: zero,
            u: zero,
            state: [state::OPEN; WIDTH],
            end: zero,
            later: zero,
        }
    }

    /// Finds the first roots beyond `from` and before `to` of all lanes that are to go forward.
    #[inline(always)]
    pub fn solve(&mut self) {
        self.begin();
        for _ in 0..MOST_STEPS {
            if self.step() == 0 {
                return;
            }
        }
        for lane in 0..WIDTH {
            let is_done = self.state[lane] >= state::FOUND;
            self.state[lane] = if is_done {
                self.state[lane]
            } else {
                state::OPEN
            };
        }
    }

    /// Lays out the stretches of all lanes.
    #[inline(always)]
    fn begin(&mut self) {
        for i in 0..WIDTH {
            let (from, to) = (self.from[i], self.to[i]);
            let turn = self.square[i] * (-1.0 / 6.0);
            let has_turns = turn > 0.0;
            let w = turn.sqrt();
            // Without turning points all is one stretch.
            let (first, second) = (
                if has_turns { -w } else { to },
                if has_turns { w } else { to },
            );
            let (first, second) = (lesser(first, to), lesser(second, to));
            let (is_first, is_third) = (from < first, from >= second);
            let later = if is_first { second } else { to };
            let end = if is_third { to } else { second };
            let end = if is_first { first } else { end };
            let is_convex = (is_first | is_third) == (self.side[i] > 0.0);
            self.end[i] = end;
            self.later[i] = later;
            self.u[i] = if is_convex { from } else { end };
            let begins = if is_convex {
                state::FORWARD
            } else {
                state::LOOKING
            };
            let is_active = self.state[i] < state::FOUND;
            self.state[i] = if is_active { begins } else { self.state[i] };
        }
    }

    /// Lets every lane take a step; gives how many go on.
    #[inline(always)]
    fn step(&mut self) -> i64 {
        let mut going = 0;
        for i in 0..WIDTH {
            let (u, from, to, doubt) = (self.u[i], self.from[i], self.to[i], self.doubt[i]);
            let (end, later, state) = (self.end[i], self.later[i], self.state[i]);
            let (a, b, side) = (self.square[i], self.linear[i], self.side[i]);
            let squared = u * u;
            let value = side * (((squared + a) * u + b) * u + self.constant[i]);
            let slope = side * ((4.0 * squared + 2.0 * a) * u + b);
            // Half the second derivative is at most this between the root and here.
            let bend = 6.0 * squared + a.abs();

            // The end of a concave stretch: no root before it, or one.
            let looks = state == state::LOOKING;
            let passes = looks & (value > doubt);
            let turns = looks & (value < -doubt);
            let ends_here = passes & (u >= to);
            let end = if passes { later } else { end };
            let later = if passes { to } else { later };

            let is_forward = (state == state::FORWARD) | (passes & !ends_here);
            let is_backward = (state == state::BACKWARD) | turns;
            let is_flat = slope * slope <= FLAT * doubt;
            let (is_low, rises, falls) = (value <= doubt, slope >= 0.0, slope < 0.0);
            // What the tangent is at the end of the stretch.
            let reach = value + slope * (end - u);
            let leaves = is_forward & (rises | (reach > doubt));
            // A root lies so close to another, or to the end of the stretch, that rounding decides.
            let is_start = u == from;
            let is_touch = is_low & (is_flat | (rises & !is_start));
            let is_vague = is_forward & (is_touch | (falls & (reach.abs() <= doubt)));
            let is_open = is_vague | (looks & !passes & !turns) | (is_backward & !falls);

            let step = -value / slope;
            let next = u + step;
            let is_fine = step * step * bend <= FINE * slope.abs();
            let is_past = (is_forward & (value <= 0.0)) | (is_backward & (value >= 0.0));
            let is_done = ((is_forward & !leaves) | is_backward) & (is_fine | is_past);
            let goes_on = if is_backward {
                state::BACKWARD
            } else {
                state::FORWARD
            };
            let found = if is_flat { state::OPEN } else { state::FOUND };
            let nears = if is_done { found } else { goes_on };
            let is_last = end >= to;
            let left = if is_last {
                state::MISSED
            } else {
                state::LOOKING
            };
            let moves = if leaves { left } else { nears };
            let moves = if ends_here { state::MISSED } else { moves };
            let becomes = if is_open { state::OPEN } else { moves };

            let is_active = state < state::FOUND;
            let is_next = leaves & !is_last;
            let place = if is_next { later } else { next };
            let end = if is_next { later } else { end };
            let later = if is_next { to } else { later };
            self.end[i] = if is_active { end } else { self.end[i] };
            self.later[i] = if is_active { later } else { self.later[i] };
            self.u[i] = if is_active { place } else { u };
            self.state[i] = if is_active { becomes } else { state };
            going += i64::from(self.state[i] < state::FOUND);
        }
        going
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::random;

    /// Four roots that sum to zero, so that there is no cubic term, in order.
    fn roots(seed: u64) -> [f64; 4] {
        let x = |k: u64| 2.0 * random(seed * 8 + k) - 1.0;
        let three = [x(0), x(1), x(2)];
        let mut roots = [three[0], three[1], three[2], -three.iter().sum::<f64>()];
        roots.sort_by(f64::total_cmp);
        roots
    }

    /// The quartics with these real roots, or with one pair moved apart into the complex plane by `gap`.
    fn quartics(seed: u64, from: f64, gap: f64) -> (Quartics, Vec<Vec<f64>>) {
        let mut quartics = Quartics::new();
        let mut expected = Vec::new();
        for lane in 0..WIDTH {
            let [p, q, r, s] = roots(64 * seed + lane as u64);
            // (u^2 + b u + c)(u^2 - b u + e), the first with roots p and q or none.
            let (b, c, e) = (-(p + q), p * q, r * s);
            let c = if gap > 0.0 {
                0.25 * b * b + gap * gap
            } else {
                c
            };
            quartics.square[lane] = c + e - b * b;
            quartics.linear[lane] = b * e - b * c;
            quartics.constant[lane] = c * e;
            quartics.doubt[lane] = 1e-12;
            let real = if gap > 0.0 {
                vec![r, s]
            } else {
                vec![p, q, r, s]
            };
            let beyond: Vec<f64> = real.into_iter().filter(|root| *root > from).collect();
            quartics.side[lane] = if beyond.len().is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            quartics.from[lane] = from;
            quartics.to[lane] = 3.5;
            quartics.state[lane] = state::FORWARD;
            expected.push(beyond);
        }
        (quartics, expected)
    }

    #[test]
    fn first_roots_are_found_from_any_place() {
        let (mut found, mut open) = (0, 0);
        for (k, gap) in (0..400u32).flat_map(|k| [(k, 0.0), (k, 0.01 + 1e-3 * f64::from(k))]) {
            let (mut quartics, expected) = quartics(k.into(), -3.5 + 0.015 * f64::from(k), gap);
            quartics.solve();
            for (lane, beyond) in expected.iter().enumerate() {
                let what = format!("{k}, {gap}, lane {lane}: {beyond:?}, {}", quartics.u[lane]);
                match quartics.state[lane] {
                    state::FOUND => {
                        found += 1;
                        assert!((quartics.u[lane] - beyond[0]).abs() < 1e-8, "{what}");
                    }
                    state::MISSED => assert!(beyond.is_empty(), "{what}"),
                    _ => open += 1,
                }
            }
        }
        assert!(found > 10_000, "{found}");
        assert!(open < 20, "{open}");
    }

    #[test]
    fn double_roots_are_left_open() {
        for lane in 0..100u32 {
            let mut quartics = Quartics::new();
            let root = 0.3 + 0.01 * f64::from(lane);
            // (u - root)^2 (u^2 + 2 root u + 4): the second factor has no root where root < 2.
            quartics.square.fill(4.0 - 3.0 * root * root);
            quartics.linear.fill(2.0 * root * root * root - 8.0 * root);
            quartics.constant.fill(4.0 * root * root);
            quartics.doubt.fill(1e-12);
            quartics.side.fill(1.0);
            quartics.from.fill(-3.0);
            quartics.to.fill(3.0);
            quartics.state.fill(state::FORWARD);
            quartics.solve();
            assert_eq!(quartics.state, [state::OPEN; WIDTH], "{root}");
        }
    }
}
