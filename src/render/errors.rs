//! How far hits lie from those of a reference.

use super::{Channel, Film, Hits};
use crate::trace::{Outcome, Ray, Verdict};
use serde::Serialize;

/// How hits compare with those of a reference. Rays of which the reference is not certain are left out.
///
/// A hit that lies more than a pixel's width in front of the reference's surface, measured at right angles to it, is one
/// where there is nothing: a false hit. One that lies so far behind it has missed a surface: a false miss. All other pairs
/// of hits have an error of depth, the distance between them along the ray in widths of the pixel there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Rays that were compared.
    pub rays: u64,
    /// Rays of which the reference is not certain.
    pub undecided: u64,
    /// Pairs of hits whose depths were compared.
    pub compared: u64,
    /// Hits where there is nothing.
    pub false_hits: u64,
    /// Surfaces that were missed.
    pub false_misses: u64,
    /// Rays of which the method was not certain.
    pub unknown: u64,
    /// The error of depth that half of the pairs don't exceed, in pixels.
    pub depth_median: f64,
    /// The error of depth that 99 % of them don't exceed, in pixels.
    pub depth_p99: f64,
    /// The largest error of depth, in pixels.
    pub depth_max: f64,
    /// The error of depth that 99 % of the pairs don't exceed, in scene units.
    pub distance_p99: f64,
    /// The angle between normals that 99 % of the pairs don't exceed, in degrees.
    pub normal_p99: f64,
}

/// How a ray compares.
enum Pair {
    Same,
    FalseHit,
    FalseMiss,
    Unknown,
    /// Errors of depth in pixels and in scene units, and of the normal in degrees.
    Near {
        pixels: f64,
        distance: f64,
        degrees: f64,
    },
}

impl Errors {
    /// How `found` compares with the hits of a reference, ray by ray.
    ///
    /// # Panics
    /// If they are of different rays.
    pub fn of(found: &Hits, truth: &Hits) -> Self {
        assert_eq!(found.rays, truth.rays, "hits of the same rays");
        let mut errors = Self::default();
        let [mut pixels, mut distances, mut degrees] = [const { Vec::new() }; 3];
        for ((ray, found), truth) in found.rays.iter().zip(&found.outcomes).zip(&truth.outcomes) {
            if truth.verdict == Verdict::Unknown {
                errors.undecided += 1;
                continue;
            }
            errors.rays += 1;
            match compare(ray, found, truth) {
                Pair::Same => {}
                Pair::FalseHit => errors.false_hits += 1,
                Pair::FalseMiss => errors.false_misses += 1,
                Pair::Unknown => errors.unknown += 1,
                Pair::Near {
                    pixels: p,
                    distance,
                    degrees: d,
                } => {
                    pixels.push(p);
                    distances.push(distance);
                    degrees.push(d);
                }
            }
        }
        errors.compared = pixels.len() as u64;
        errors.depth_median = quantile(&mut pixels, 0.5);
        errors.depth_p99 = quantile(&mut pixels, 0.99);
        errors.depth_max = quantile(&mut pixels, 1.0);
        errors.distance_p99 = quantile(&mut distances, 0.99);
        errors.normal_p99 = quantile(&mut degrees, 0.99);
        errors
    }

    /// False hits, false misses and unknown rays, of a million rays.
    pub fn wrong_per_million(&self) -> f64 {
        let wrong = self.false_hits + self.false_misses + self.unknown;
        1e6 * wrong as f64 / self.rays.max(1) as f64
    }
}

fn compare(ray: &Ray, found: &Outcome, truth: &Outcome) -> Pair {
    match (found.verdict, truth.verdict) {
        (Verdict::Unknown, _) => Pair::Unknown,
        (Verdict::Hit, Verdict::Hit) => {
            let distance = found.t - truth.t;
            let width = ray.footprint.at(truth.t);
            let aside = distance * truth.normal.dot(ray.direction).abs() / width;
            if aside < -1.0 {
                return Pair::FalseHit;
            }
            if aside > 1.0 {
                return Pair::FalseMiss;
            }
            let (a, b) = (found.normal, truth.normal);
            Pair::Near {
                pixels: distance.abs() / width,
                distance: distance.abs(),
                degrees: a.cross(b).length().atan2(a.dot(b)).to_degrees(),
            }
        }
        (Verdict::Hit, _) => Pair::FalseHit,
        (_, Verdict::Hit) => Pair::FalseMiss,
        _ => Pair::Same,
    }
}

/// The value that this share of the values don't exceed; 0 of none.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let rank = (share * values.len() as f64).ceil() as usize;
    values.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

/// The root of the mean square of the differences of the light of two pictures, over all pixels and the three linear
/// components; `None` if one has no light, or they differ in size.
pub fn root_mean_square(a: &Film, b: &Film) -> Option<f64> {
    let [a, b] = [a, b].map(|film| film.plane(Channel::Beauty).map(|plane| &plane.values));
    let (a, b) = (a?, b?);
    if a.len() != b.len() || a.is_empty() {
        return None;
    }
    let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum();
    Some((squares / a.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Footprint;
    use glam::DVec3;

    /// A ray whose pixel is 0.01 wide at distance 1.
    fn ray() -> Ray {
        Ray {
            origin: DVec3::ZERO,
            direction: DVec3::Z,
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 0.01,
            },
        }
    }

    fn outcome(verdict: Verdict, t: f64, normal: DVec3) -> Outcome {
        Outcome {
            verdict,
            t,
            error: 0.0,
            point: DVec3::Z * t,
            normal,
            part: 0,
            steps: 0,
            evaluations: 0,
        }
    }

    fn hits(outcomes: &[Outcome]) -> Hits {
        Hits {
            rays: vec![ray(); outcomes.len()],
            outcomes: outcomes.to_vec(),
            ..Hits::default()
        }
    }

    #[test]
    fn errors_of_known_pairs() {
        let hit = |t| outcome(Verdict::Hit, t, DVec3::NEG_Z);
        let miss = outcome(Verdict::Miss, f64::INFINITY, DVec3::ZERO);
        let unknown = outcome(Verdict::Unknown, 0.0, DVec3::ZERO);
        let truth = hits(&[
            hit(1.0),
            hit(1.0),
            hit(1.0),
            hit(1.0),
            miss,
            miss,
            hit(1.0),
            unknown,
        ]);
        let found = hits(&[
            hit(1.005),
            hit(0.98),
            hit(1.02),
            miss,
            hit(5.0),
            miss,
            unknown,
            hit(1.0),
        ]);
        let e = Errors::of(&found, &truth);
        assert_eq!((e.rays, e.undecided, e.compared), (7, 1, 1));
        assert_eq!((e.false_hits, e.false_misses, e.unknown), (2, 2, 1));
        assert!((e.depth_max - 0.5).abs() < 1e-12, "{e:?}");
        assert!((e.distance_p99 - 0.005).abs() < 1e-15, "{e:?}");
        assert!((e.wrong_per_million() - 5e6 / 7.0).abs() < 1e-6);
    }

    /// On a surface seen at a small angle, a small distance from it is a long way along the ray.
    #[test]
    fn grazing_hits_are_judged_at_right_angles_to_the_surface() {
        let normal = DVec3::new(1.0, 0.0, -0.01).normalize();
        let truth = hits(&[outcome(Verdict::Hit, 1.0, normal)]);
        let found = hits(&[outcome(Verdict::Hit, 0.9, normal)]);
        let e = Errors::of(&found, &truth);
        assert_eq!((e.false_hits, e.compared), (0, 1));
        assert!((e.depth_p99 - 10.0).abs() < 1e-9);
    }

    #[test]
    fn normals_differ_by_their_angle() {
        let truth = hits(&[outcome(Verdict::Hit, 1.0, DVec3::NEG_Z)]);
        let turned = DVec3::new(0.0, 30f64.to_radians().sin(), -30f64.to_radians().cos());
        let found = hits(&[outcome(Verdict::Hit, 1.0, turned)]);
        assert!((Errors::of(&found, &truth).normal_p99 - 30.0).abs() < 1e-12);
    }

    #[test]
    fn quantiles_by_rank() {
        let mut values: Vec<f64> = (1..=200).map(f64::from).collect();
        assert_eq!(quantile(&mut values, 0.99), 198.0);
        assert_eq!(quantile(&mut values, 1.0), 200.0);
        assert_eq!(quantile(&mut values, 0.5), 100.0);
        assert_eq!(quantile(&mut [], 0.5), 0.0);
    }

    #[test]
    fn pictures_differ_by_the_root_of_the_mean_square() {
        let film = |red| vec![red, 0.0, 0.0, 0.0, 0.0, 0.0];
        let film = |red| Film::of([2, 1], Channel::Beauty, film(red)).unwrap();
        let [a, b] = &[0.0, 3.0].map(film);
        assert!((root_mean_square(a, b).unwrap() - 1.5f64.sqrt()).abs() < 1e-7);
        assert_eq!(root_mean_square(a, a), Some(0.0));
        assert_eq!(
            root_mean_square(a, &Film::new([1, 1], &[Channel::Beauty])),
            None
        );
    }
}
