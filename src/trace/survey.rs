//! The driver of methods that ask for ranges along a ray: one ray at a time. They also answer what others leave open.

use super::Ray;
use super::along::stretched;
use super::evidence::{Trail, Witness};
use super::march::{Job, Walked};
use super::method::{Ending, Resolver, Segment, Walk};
use super::part::Marched;
use crate::num::{Interval, Vec3};

/// Walks all jobs through `part` by the method `W`.
pub(super) fn survey<W: Walk>(part: &Marched, rays: &[Ray], jobs: &[Job]) -> Vec<Walked> {
    jobs.iter()
        .map(|job| walk::<W>(part, &rays[job.ray as usize], job))
        .collect()
}

/// Walks of other methods through `part`, with those that could not tell decided by ranges.
pub(super) fn resolved(
    part: &Marched,
    rays: &[Ray],
    jobs: &[Job],
    mut walked: Vec<Walked>,
) -> Vec<Walked> {
    for open in walked.iter_mut().filter(|walked| walked.ending.is_open()) {
        let Some(job) = jobs.iter().find(|job| job.ray == open.ray) else {
            continue;
        };
        let ray = &rays[job.ray as usize];
        let (ending, evaluations) = decided(part, ray, job.segment, open.ending);
        open.evaluations += evaluations;
        open.ending = ending;
    }
    walked
}

/// The end of a walk on `segment` that could not tell, decided by ranges; others as they are. And how many evaluations
/// that took.
pub(super) fn decided(
    part: &Marched,
    ray: &Ray,
    segment: Segment,
    ending: Ending,
) -> (Ending, u32) {
    if !ending.is_open() {
        return (ending, 0);
    }
    let again = walk::<Resolver>(part, ray, &Job { ray: 0, segment });
    let steps = ending.steps + again.ending.steps;
    (
        Ending {
            steps,
            ..again.ending
        },
        again.evaluations,
    )
}

/// Ranges are of use where they say that the field changes by less than this share of its constant.
const USEFUL: f64 = 0.25;

/// Whether ranges say where the ray is stuck, from `from` to `to`, that the field hardly changes.
pub(super) fn is_told(part: &Marched, ray: &Ray, segment: &Segment, [from, to]: [f64; 2]) -> bool {
    let (_, slope) = ranges(part, ray, from, to);
    slope.magnitude() < USEFUL * segment.lipschitz
}

/// Walks one ray to its end.
fn walk<W: Walk>(part: &Marched, ray: &Ray, job: &Job) -> Walked {
    let mut walk = W::begin(job.segment);
    let mut evaluations = 0;
    let mut trail = Trail::default();
    let mut look = |t: f64, value: f64| {
        let samples = trail.extend(&job.segment, (t, value));
        if let Some(samples) = samples.filter(|_| W::RESTS_ON_CONSTANT) {
            part.evidence.add(Witness::on(ray, samples));
        }
    };
    loop {
        evaluations += 1;
        let t = walk.t();
        let ending = if let Some(reach) = walk.probe() {
            let ahead = part.probe().ask(ray, t, reach);
            look(t, ahead.value);
            walk.ahead(ahead)
        } else if let Some(reach) = walk.reach() {
            let (value, slope) = ranges(part, ray, t, reach);
            walk.survey(value, slope)
        } else {
            let p = ray.at(t);
            let value = part.single()(&Vec3::new(p.x, p.y, p.z));
            look(t, value);
            walk.observe(value, 0.0)
        };
        if let Some(ending) = ending {
            return Walked {
                ray: job.ray,
                ending,
                evaluations,
            };
        }
    }
}

/// The ranges of the field and of its derivative along the ray, from `from` to `to`.
fn ranges(part: &Marched, ray: &Ray, from: f64, to: f64) -> (Interval, Interval) {
    let field = part.ranges()(&stretched(ray.origin, ray.direction, [from, to]));
    (field.value, field.partial[0])
}
