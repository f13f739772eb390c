//! What times of many rounds say, and when they say nothing.
//!
//! Other programs only ever make a run slower, so a run's times pile up near the smallest and trail off above. The spread of a
//! sample is what lies between its smallest value and the value that three quarters don't exceed. Two samples differ where
//! their spreads lie apart: of two programs that are equally fast, four to eight rounds of each let at most one comparison
//! in twenty claim a difference (5 rounds: 12 of 252 orders in which the times can lie, 4.8 %).

use serde::Serialize;

/// A sample of times, or of anything that disturbances make larger.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// How many values there are.
    pub rounds: usize,
    /// The smallest.
    pub minimum: f64,
    /// The one in the middle.
    pub median: f64,
    /// The one that three quarters of them don't exceed.
    pub upper: f64,
}

impl Spread {
    /// Fewer rounds than this show no difference.
    pub const ENOUGH: usize = 4;

    /// The spread of a sample; `None` of an empty one. What is not a number counts as the largest.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_by(|a, b| a.is_nan().cmp(&b.is_nan()).then(a.total_cmp(b)));
        let last = sorted.len().checked_sub(1)?;
        Some(Self {
            rounds: sorted.len(),
            minimum: sorted[0],
            median: 0.5 * (sorted[last / 2] + sorted[last.div_ceil(2)]),
            upper: sorted[(3 * last).div_ceil(4)],
        })
    }

    /// Whether the two can't be told apart: too few rounds, or spreads that overlap.
    pub fn is_like(&self, other: &Self) -> bool {
        let lies_below = |a: &Self, b: &Self| a.upper < b.minimum;
        self.rounds.min(other.rounds) < Self::ENOUGH
            || !(lies_below(self, other) || lies_below(other, self))
    }

    /// How many times the median of `other` is as large as this one's; `None` where the two can't be told apart.
    pub fn ratio(&self, other: &Self) -> Option<f64> {
        let ratio = other.median / self.median;
        (!self.is_like(other) && ratio.is_finite()).then_some(ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(values: &[f64]) -> Spread {
        Spread::of(values.iter().copied()).unwrap()
    }

    #[test]
    fn spread_of_five_leaves_out_the_slowest() {
        let s = spread(&[3.0, 9.0, 1.0, 2.0, 4.0]);
        assert_eq!((s.minimum, s.median, s.upper), (1.0, 3.0, 4.0));
        assert_eq!(spread(&[1.0, 2.0, 4.0, 8.0]).median, 3.0);
        assert_eq!(spread(&[7.0]).upper, 7.0);
        assert!(Spread::of([]).is_none());
    }

    #[test]
    fn ratio_is_refused_where_spreads_overlap_or_rounds_are_few() {
        let slow = spread(&[20.0, 21.0, 22.0, 23.0, 24.0]);
        let fast = spread(&[10.0, 10.0, 11.0, 12.0, 50.0]);
        assert_eq!(fast.ratio(&slow), Some(2.0));
        assert_eq!(slow.ratio(&fast), Some(0.5));
        let between = spread(&[12.0, 13.0, 14.0, 15.0, 16.0]);
        assert_eq!(fast.ratio(&between), None);
        assert_eq!(fast.ratio(&fast), None);
        assert_eq!(spread(&[1.0, 1.0, 1.0]).ratio(&slow), None);
        assert_eq!(fast.ratio(&spread(&[f64::NAN; 5])), None);
    }

    /// Two equal programs, n rounds of each: every order of the 2n times is as likely as any other.
    #[test]
    fn equal_programs_differ_in_at_most_one_of_twenty_comparisons() {
        for rounds in Spread::ENOUGH..=8 {
            let (mut orders, mut claims) = (0, 0);
            for mask in 0u32..1 << (2 * rounds) {
                if mask.count_ones() as usize != rounds {
                    continue;
                }
                let times = |bit: u32| {
                    (0..2 * rounds)
                        .filter(move |i| mask >> i & 1 == bit)
                        .map(|i| i as f64)
                };
                let [a, b] = [0, 1].map(|bit| Spread::of(times(bit)).unwrap());
                orders += 1;
                claims += usize::from(!a.is_like(&b));
            }
            assert!(
                20 * claims <= orders,
                "{rounds} rounds: {claims} of {orders}"
            );
            assert!(claims > 0);
        }
    }
}
