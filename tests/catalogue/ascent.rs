//! The largest value of a function of a few numbers: sampling, then climbing from the best samples.

use super::samples::Dice;

/// How hard to look.
#[derive(Clone, Copy)]
pub struct Effort {
    /// How many random places are looked at.
    pub samples: usize,
    /// From how many of them a climb starts.
    pub climbs: usize,
    /// How many steps a climb has.
    pub steps: usize,
}

/// A place in the unit cube and the value there.
pub type Peak<const D: usize> = ([f64; D], f64);

/// The largest value of `score` over the unit cube, as far as it is found; the search ends early once it reaches `goal`.
/// Values that are not finite do not count.
pub fn highest<const D: usize>(
    score: impl Fn(&[f64; D]) -> f64,
    dice: &mut Dice,
    effort: Effort,
    goal: f64,
) -> Peak<D> {
    let score = |place: &[f64; D]| {
        Some(score(place))
            .filter(|s| s.is_finite())
            .unwrap_or(f64::NEG_INFINITY)
    };
    let mut peaks: Vec<Peak<D>> = Vec::new();
    for _ in 0..effort.samples {
        let place = std::array::from_fn(|_| dice.unit());
        let value = score(&place);
        if value >= goal {
            return (place, value);
        }
        let rank = peaks.partition_point(|(_, v)| *v >= value);
        peaks.insert(rank, (place, value));
        peaks.truncate(effort.climbs);
    }
    for peak in &mut peaks {
        climb(score, dice, effort.steps, goal, peak);
        if peak.1 >= goal {
            return *peak;
        }
    }
    peaks
        .into_iter()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or(([0.5; D], f64::NEG_INFINITY))
}

/// Random steps that are kept where they lead up: longer after a success, shorter after a failure (the one fifth rule
/// of Rechenberg 1973). Steps that leave the cube end on its side, where maxima often lie.
pub fn climb<const D: usize>(
    score: impl Fn(&[f64; D]) -> f64,
    dice: &mut Dice,
    steps: usize,
    goal: f64,
    peak: &mut Peak<D>,
) {
    let mut reach = 0.1;
    for _ in 0..steps {
        let along = dice.below(D + 1);
        let next = std::array::from_fn(|i| {
            // Now and then along one axis alone.
            let step = if along < D && along != i {
                0.0
            } else {
                dice.between(-reach, reach)
            };
            (peak.0[i] + step).clamp(0.0, 1.0)
        });
        let value = score(&next);
        if value > peak.1 {
            *peak = (next, value);
            reach = (reach * 1.6).min(0.3);
        } else {
            reach *= 0.87;
        }
        if peak.1 >= goal {
            break;
        }
    }
}
