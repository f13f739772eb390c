//! Numbers to places on an axis.

use std::ops::RangeInclusive;

/// How numbers lie on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly, from zero.
    Linear,
    /// By their logarithm.
    Log,
    /// By their logarithm; zero is beyond a break of the axis and is called "exact".
    LogOrExact,
    /// Evenly from zero to one, by their logarithm from there: for counts of which zero matters.
    LogFromOne,
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Its place, in [0, 1].
    pub at: f64,
    /// What is written there.
    pub label: String,
}

/// A scale with the numbers that lie on it.
#[derive(Clone, Debug)]
pub(super) struct Range {
    scale: Scale,
    /// The ends in the scale's own measure.
    from: f64,
    to: f64,
    /// Where zero is shown, in the scale's own measure, if it is beyond a break.
    exact: Option<f64>,
}

/// Errors below this are called exact: they are rounding.
pub const EXACT: f64 = 1e-12;

impl Scale {
    /// The number in the scale's own measure, if it has one.
    fn measure(self, x: f64) -> Option<f64> {
        let measured = match self {
            Self::Linear => x,
            Self::Log => x.log10(),
            Self::LogOrExact if x < EXACT => return None,
            Self::LogOrExact => x.log10(),
            Self::LogFromOne if x <= 1.0 => x.max(0.0),
            Self::LogFromOne => 1.0 + x.log10(),
        };
        measured.is_finite().then_some(measured)
    }

    /// The range that holds all these numbers; those that have no place are passed over.
    pub(super) fn range(self, numbers: impl Iterator<Item = f64> + Clone) -> Range {
        let measured = numbers.clone().filter_map(|x| self.measure(x));
        let (mut from, mut to) = measured
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), m| {
                (from.min(m), to.max(m))
            });
        if from > to {
            (from, to) = (0.0, 1.0);
        }
        match self {
            Self::Linear => from = from.min(0.0),
            Self::LogFromOne => (from, to) = (0.0, to.max(2.0)),
            Self::Log | Self::LogOrExact => (from, to) = widened(from, to),
        }
        // Room for the marks.
        let room = 0.06 * (to - from).max(1e-9);
        let has_exact =
            self == Self::LogOrExact && numbers.clone().any(|x| (0.0..EXACT).contains(&x));
        let exact = has_exact.then(|| from - 2.0 * room - 0.06 * (to - from).max(1.0));
        Range {
            scale: self,
            from: exact.unwrap_or(from) - room,
            to: to + room,
            exact,
        }
    }
}

/// Quarters of decades, at least one decade.
fn widened(from: f64, to: f64) -> (f64, f64) {
    let (low, high) = ((4.0 * from).floor() / 4.0, (4.0 * to).ceil() / 4.0);
    let lacking = (1.0 - (high - low)).max(0.0);
    (low - 0.5 * lacking, high + 0.5 * lacking)
}

impl Range {
    /// The place of a number, in [0, 1]; what is infinite is at the end.
    pub fn place(&self, x: f64) -> Option<f64> {
        if x == f64::INFINITY {
            return Some(1.0);
        }
        let measured = match self.exact {
            Some(exact) if (0.0..EXACT).contains(&x) => exact,
            _ => self.scale.measure(x)?,
        };
        Some((measured - self.from) / (self.to - self.from))
    }

    /// The place of the break, if there is one.
    pub fn broken(&self) -> Option<f64> {
        let exact = self.exact?;
        let end = 0.06 * (self.to - self.from);
        Some((exact + end - self.from) / (self.to - self.from))
    }

    /// The marks with their labels, at most about `most` of them.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        // The word at the break needs the room of a label.
        let clear = self
            .exact
            .map_or(0.0, |e| (e - self.from) / (self.to - self.from))
            + 0.6 / most.max(1) as f64;
        let mut ticks: Vec<Tick> = self
            .numbers(most)
            .into_iter()
            .filter_map(|x| self.tick(x))
            .filter(|tick| self.exact.is_none() || tick.at >= clear)
            .collect();
        if let Some(exact) = self.exact {
            let at = (exact - self.from) / (self.to - self.from);
            ticks.insert(
                0,
                Tick {
                    at,
                    label: "exact".into(),
                },
            );
        }
        ticks
    }

    fn tick(&self, x: f64) -> Option<Tick> {
        let at = self.place(x).filter(|at| (0.0..=1.0).contains(at))?;
        let is_clear = self.broken().is_none_or(|broken| at > broken);
        is_clear.then(|| Tick {
            at,
            label: label(x),
        })
    }

    /// The numbers at the marks.
    fn numbers(&self, most: usize) -> Vec<f64> {
        match self.scale {
            Scale::Linear => round_steps(self.from, self.to, most),
            Scale::Log | Scale::LogOrExact => decades(
                self.from.ceil() as i32..=self.to.floor() as i32,
                self.to - self.from,
                most,
            ),
            Scale::LogFromOne => {
                let powers = decades(0..=(self.to - 1.0).floor() as i32, self.to, most);
                std::iter::once(0.0).chain(powers).collect()
            }
        }
    }
}

/// Powers of ten, or of every second, third and so on; with halves and fifths between where there are few.
fn decades(exponents: RangeInclusive<i32>, length: f64, most: usize) -> Vec<f64> {
    let step = (length / most.max(1) as f64).ceil().max(1.0) as i32;
    let power = |e: i32| 10f64.powi(e);
    if length < 2.2 {
        let from = exponents.start() - 1;
        return (from..=*exponents.end())
            .flat_map(|e| [1.0, 2.0, 5.0].map(|m| m * power(e)))
            .collect();
    }
    exponents
        .filter(|e| e.rem_euclid(step) == 0)
        .map(power)
        .collect()
}

/// Multiples of 1, 2 or 5 times a power of ten.
fn round_steps(from: f64, to: f64, most: usize) -> Vec<f64> {
    let rough = (to - from) / most.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * power)
        .into_iter()
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let first = (from / step).ceil() as i64;
    (first..)
        .map(|i| i as f64 * step)
        .take_while(|x| *x <= to)
        .collect()
}

/// The number as it is written at an axis.
fn label(x: f64) -> String {
    let exponent = x.abs().log10();
    if x == 0.0 || (-3.5..=5.0).contains(&exponent) {
        let rounded = (x * 1e9).round() / 1e9;
        return format!("{rounded}");
    }
    let power = exponent.round() as i32;
    let digits = power
        .to_string()
        .chars()
        .map(superscript)
        .collect::<String>();
    match (x / 10f64.powi(power)).round() as i64 {
        1 => format!("10{digits}"),
        _ => format!("{x:e}"),
    }
}

fn superscript(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32(0x2070 + digit as u32 - '0' as u32).unwrap_or(digit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, numbers: &[f64], most: usize) -> Vec<String> {
        scale
            .range(numbers.iter().copied())
            .ticks(most)
            .into_iter()
            .map(|t| t.label)
            .collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(
            labels(Scale::Linear, &[3.0, 47.0], 6),
            ["0", "10", "20", "30", "40"]
        );
        assert_eq!(labels(Scale::Linear, &[-80.0, 80.0], 5), ["-50", "0", "50"]);
        assert_eq!(
            labels(Scale::Log, &[1e-6, 30.0], 9),
            ["10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1", "10"]
        );
        assert_eq!(
            labels(Scale::Log, &[1e-12, 1.0], 4),
            ["10⁻¹²", "10⁻⁸", "10⁻⁴", "1"]
        );
        assert_eq!(labels(Scale::Log, &[4.0, 31.0], 5), ["5", "10", "20"]);
    }

    #[test]
    fn zero_is_exact_and_first() {
        let range = Scale::LogOrExact.range([0.0, 1e-15, 1e-6, 1.0].into_iter());
        let place = |x| range.place(x).unwrap();
        assert_eq!(range.ticks(4)[0].label, "exact");
        assert_eq!(place(0.0), place(1e-15));
        let broken = range.broken().unwrap();
        assert!(0.0 < place(0.0) && place(0.0) < broken && broken < place(1e-6));
        assert!(place(1e-6) < place(1.0) && place(1.0) < 1.0);
        assert!(
            Scale::LogOrExact
                .range([1e-6, 1.0].into_iter())
                .broken()
                .is_none()
        );
    }

    #[test]
    fn zero_is_seen_among_counts() {
        let range = Scale::LogFromOne.range([0.0, 1e4].into_iter());
        let places: Vec<f64> = [0.0, 0.5, 1.0, 10.0, 1e4]
            .map(|x| range.place(x).unwrap())
            .to_vec();
        assert!(places.is_sorted() && places[0] > 0.0 && places[4] < 1.0);
        // A half is half way; a decade is as long as the step from none to one.
        assert!((places[1] - places[0] - (places[2] - places[1])).abs() < 1e-12);
        assert!((places[2] - places[0] - (places[3] - places[2])).abs() < 1e-12);
        let labels: Vec<String> = range.ticks(9).into_iter().map(|t| t.label).collect();
        assert_eq!(labels, ["0", "1", "10", "100", "1000", "10000"]);
    }

    /// Infinite errors are those of a method that found nothing to compare: not hidden, but as bad as can be.
    #[test]
    fn infinite_is_at_the_end() {
        for scale in [Scale::Log, Scale::LogOrExact, Scale::LogFromOne] {
            let range = scale.range([f64::INFINITY, 1.0, 10.0].into_iter());
            assert!(range.place(10.0).unwrap() < 1.0);
            assert_eq!(range.place(f64::INFINITY), Some(1.0));
        }
    }

    #[test]
    fn labels_keep_clear_of_the_word_at_the_break() {
        for least in 1..12 {
            let least = 10f64.powi(-least);
            let range = Scale::LogOrExact.range([0.0, least, 10.0].into_iter());
            let ticks = range.ticks(6);
            assert_eq!(ticks[0].label, "exact");
            assert!(ticks[1].at - ticks[0].at > 0.09, "{least}: {ticks:?}");
        }
    }

    #[test]
    fn what_has_no_place_is_left_out() {
        let range = Scale::Log.range([f64::NAN, 0.0, -1.0, 1.0, 10.0].into_iter());
        for x in [f64::NAN, 0.0, -1.0, f64::NEG_INFINITY] {
            assert_eq!(range.place(x), None, "{x}");
        }
        assert!(Scale::Log.range([].into_iter()).place(3.0).is_some());
    }
}
