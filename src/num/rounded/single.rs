//! What `f32` does to intervals of results.

use crate::num::Interval;

/// The unit roundoff of `f32`: rounding to nearest takes at most this share of a result.
pub const UNIT: f64 = 1.0 / (1_u64 << 24) as f64;

/// More than a product or quotient loses where it underflows.
pub const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// More than the length of a vector loses where squares of its components underflow: each loses at most 2^-150, and the
/// root of three of them is 5e-23.
pub const LEAST_LENGTH: f64 = 1e-18;

/// A bound times this is a bound although it was computed in `f64`, by a few dozen operations on numbers that are not
/// negative.
pub const SLACK: f64 = 1.0 + 1e-12;

/// Beyond this, the next operations may overflow.
const LARGE: f64 = f32::MAX as f64 / 4.0;

/// Whether all are numbers far from overflow.
pub fn is_in_reach(x: Interval) -> bool {
    x.magnitude() <= LARGE
}

/// What the results of a correctly rounded operation become: rounding is monotone, so only the ends count.
pub fn rounded(x: Interval) -> Interval {
    Interval::new(f64::from(x.lo as f32), f64::from(x.hi as f32))
}

/// By how much results in `x` are off, if they are by at most so many units of the last place.
pub fn kernel_error(x: Interval, ulps: f64) -> f64 {
    // A unit of the last place of the nearest number is at most 2 u of that number, which is off by u itself.
    ulps * 2.0 * UNIT * (1.0 + 2.0 * UNIT) * x.magnitude() + LEAST
}

/// All numbers that are off by at most `error`.
pub fn wider(x: Interval, error: f64) -> Interval {
    let error = error * SLACK;
    Interval::new((x.lo - error).next_down(), (x.hi + error).next_up())
}
