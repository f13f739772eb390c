//! Evidence against Lipschitz constants: samples of a field that changes faster than its constant allows.
//!
//! Every method whose steps rest on a constant compares the samples that it takes anyway. Where two of one ray refute the
//! constant, the pair is kept, of each part that with the steepest slope: so what is kept is the same for any number of
//! threads. What no ray samples is not noticed. Source: the audit of `max_gradient` in POV-Ray's isosurfaces.

use super::Ray;
use super::method::Segment;
use std::sync::{Mutex, PoisonError};

/// Two samples of a field between which it changes by more than its constant allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// Where the samples were taken.
    pub points: [[f64; 3]; 2],
    /// The field there.
    pub values: [f64; 2],
    /// The distance between the points.
    apart: f64,
}

impl Witness {
    /// Two samples on a ray: distances along it with values.
    pub fn on(ray: &Ray, samples: [(f64, f64); 2]) -> Self {
        Self {
            points: samples.map(|(t, _)| ray.at(t).to_array()),
            values: samples.map(|(_, value)| value),
            apart: (samples[1].0 - samples[0].0).abs(),
        }
    }

    /// How steep the field is between the points.
    pub fn slope(&self) -> f64 {
        (self.values[1] - self.values[0]).abs() / self.apart
    }

    /// Whether it says more than another: the steeper one does, and of equally steep ones that with the smaller numbers.
    fn outweighs(&self, other: &Self) -> bool {
        let key = |w: &Self| w.points.concat();
        let order = other.slope().total_cmp(&self.slope());
        let ties = || {
            key(self)
                .into_iter()
                .zip(key(other))
                .map(|(a, b)| a.total_cmp(&b))
        };
        ties().fold(order, |order, tie| order.then(tie)).is_lt()
    }
}

/// What rays have found against the constant of one part.
#[derive(Default)]
pub(super) struct Evidence(Mutex<Option<Box<(Witness, u64)>>>);

impl Evidence {
    /// Takes what a ray has found.
    pub fn add(&self, witness: Witness) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (worst, rays) = &mut **kept.get_or_insert_with(|| Box::new((witness, 0)));
        *rays += 1;
        if witness.outweighs(worst) {
            *worst = witness;
        }
    }

    /// The worst of it, and how many rays have found something.
    pub fn worst(&self) -> Option<(Witness, u64)> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.as_deref().copied()
    }
}

/// The samples of a walk, as far as they are compared: the last one, and the farthest one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Trail {
    last: Option<(f64, f64)>,
    farthest: Option<(f64, f64)>,
    /// Whether it has refuted the constant; once is enough.
    is_told: bool,
}

impl Trail {
    /// A walk that goes on from this sample.
    pub fn from(sample: Option<(f64, f64)>) -> Self {
        Self {
            last: sample,
            farthest: sample,
            is_told: false,
        }
    }

    /// Takes the next sample; gives the first pair that refutes the segment's constant.
    pub fn extend(&mut self, segment: &Segment, now: (f64, f64)) -> Option<[(f64, f64); 2]> {
        let found = [self.farthest, self.last]
            .into_iter()
            .flatten()
            .find(|before| !self.is_told && is_refuted(segment, *before, now));
        self.last = Some(now);
        if self.farthest.is_none_or(|(t, _)| now.0 > t) {
            self.farthest = Some(now);
        }
        self.is_told |= found.is_some();
        Some([found?, now])
    }
}

/// Whether two samples of a segment differ by more than its constant allows and rounding explains.
fn is_refuted(segment: &Segment, before: (f64, f64), now: (f64, f64)) -> bool {
    let change = (now.1 - before.1).abs();
    let apart = (now.0 - before.0).abs();
    let noise = segment.noise(now.0.max(before.0));
    change.is_finite() && change > segment.lipschitz * apart * (1.0 + 1e-9) + noise
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Footprint;
    use glam::DVec3;

    fn witness(slope: f64, x: f64) -> Witness {
        let ray = Ray {
            origin: DVec3::new(x, 0.0, 0.0),
            direction: DVec3::Y,
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        };
        Witness::on(&ray, [(1.0, 0.0), (3.0, 2.0 * slope)])
    }

    #[test]
    fn the_same_is_kept_in_any_order() {
        let all = [witness(2.0, 1.0), witness(3.0, 2.0), witness(3.0, 1.0)];
        for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let evidence = Evidence::default();
            order.iter().for_each(|i| evidence.add(all[*i]));
            assert_eq!(evidence.worst(), Some((all[2], 3)), "{order:?}");
        }
        assert_eq!(all[2].slope(), 3.0);
    }
}
