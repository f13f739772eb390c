//! The driver: feeds walks of many rays through one field, a packet of lanes at a time.
//!
//! A packet holds one walk in each lane; a walk that ends makes room for the next ray. Few walks run one by one through
//! the scalar closure, whose bits are the same.

use super::Ray;
use super::along::moving;
use super::bundle::WIDTH;
use super::evidence::{Trail, Witness};
use super::method::{Ending, Segment, Walk};
use super::part::Marched;
use crate::num::{Dual, F64x32, Lanes, Vec3};

/// Below this many walks a packet costs more than its walks one by one (a packet of 32 takes about as long as three to
/// four scalar evaluations).
const FEW: usize = 4;

/// A ray's task in a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Job {
    /// The ray, by number.
    pub ray: u32,
    /// Where it walks.
    pub segment: Segment,
}

/// How a job ended, and how many evaluations it took.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walked {
    /// The ray, by number.
    pub ray: u32,
    /// The end.
    pub ending: Ending,
    /// Evaluations of the field.
    pub evaluations: u32,
}

/// A walk in a lane.
struct Seat<W> {
    walk: W,
    ray: u32,
    evaluations: u32,
    segment: Segment,
    trail: Trail,
}

impl<W: Walk> Seat<W> {
    fn new(job: &Job) -> Self {
        Self {
            walk: W::begin(job.segment),
            ray: job.ray,
            evaluations: 0,
            segment: job.segment,
            trail: Trail::default(),
        }
    }

    fn observe(&mut self, part: &Marched, rays: &[Ray], value: f64, slope: f64) -> Option<Walked> {
        self.evaluations += 1;
        if let Some(samples) = self.trail.extend(&self.segment, (self.walk.t(), value)) {
            let ray = &rays[self.ray as usize];
            part.evidence.add(Witness::on(ray, samples));
        }
        let ending = self.walk.observe(value, slope)?;
        Some(Walked {
            ray: self.ray,
            ending,
            evaluations: self.evaluations,
        })
    }
}

/// Walks all jobs through `part` by the method `W`; the order of the results is not that of the jobs.
pub(super) fn march<W: Walk>(part: &Marched, rays: &[Ray], jobs: &[Job]) -> Vec<Walked> {
    let mut done = Vec::with_capacity(jobs.len());
    let mut waiting = jobs.iter();
    let mut seats: Vec<Seat<W>> = waiting.by_ref().take(WIDTH).map(Seat::new).collect();
    while seats.len() >= FEW {
        step_packet(part, rays, &mut seats, &mut done, &mut waiting);
    }
    for mut seat in seats {
        done.push(finish_single(part, rays, &mut seat));
    }
    done
}

/// Evaluates one packet and lets every walk observe; ended walks give their seats to waiting jobs.
fn step_packet<'a, W: Walk>(
    part: &Marched,
    rays: &[Ray],
    seats: &mut Vec<Seat<W>>,
    done: &mut Vec<Walked>,
    waiting: &mut impl Iterator<Item = &'a Job>,
) {
    let (values, slopes) = evaluate(part, rays, seats);
    let mut lane = 0;
    let mut kept = 0;
    while lane < values.len() && kept < seats.len() {
        match seats[kept].observe(part, rays, values[lane], slopes[lane]) {
            None => kept += 1,
            Some(walked) => {
                done.push(walked);
                match waiting.next() {
                    Some(job) => {
                        seats[kept] = Seat::new(job);
                        kept += 1;
                    }
                    // The seats behind move up, and so their values stay one lane ahead.
                    None => drop(seats.remove(kept)),
                }
            }
        }
        lane += 1;
    }
}

/// The field, and the slopes if the method needs them, at the places of all walks.
fn evaluate<W: Walk>(
    part: &Marched,
    rays: &[Ray],
    seats: &[Seat<W>],
) -> ([f64; WIDTH], [f64; WIDTH]) {
    let mut places = [[0.0; WIDTH]; 3];
    let mut directions = [[0.0; WIDTH]; 3];
    for lane in 0..WIDTH {
        // Lanes without a walk repeat the first.
        let seat = seats.get(lane).unwrap_or(&seats[0]);
        let ray = &rays[seat.ray as usize];
        let p = ray.at(seat.walk.t());
        for axis in 0..3 {
            places[axis][lane] = p[axis];
            directions[axis][lane] = ray.direction[axis];
        }
    }
    let [x, y, z] = places.map(Lanes);
    match &part.slope {
        Some(slope) if W::NEEDS_SLOPE => {
            let [u, v, w] = directions.map(Lanes);
            let along = |value: F64x32, rate: F64x32| Dual::new(value, [rate]);
            let field = (slope.wide)(&Vec3::new(along(x, u), along(y, v), along(z, w)));
            (field.value.0, field.partial[0].0)
        }
        _ => ((part.value)(&Vec3::new(x, y, z)).0, [0.0; WIDTH]),
    }
}

/// Walks one ray to its end through the scalar closure.
fn finish_single<W: Walk>(part: &Marched, rays: &[Ray], seat: &mut Seat<W>) -> Walked {
    let ray = &rays[seat.ray as usize];
    loop {
        let p = ray.at(seat.walk.t());
        let (value, slope) = match &part.slope {
            Some(slope) if W::NEEDS_SLOPE => {
                let field = (slope.single)(&moving(p, ray.direction));
                (field.value, field.partial[0])
            }
            _ => (part.single()(&Vec3::new(p.x, p.y, p.z)), 0.0),
        };
        if let Some(walked) = seat.observe(part, rays, value, slope) {
            return walked;
        }
    }
}
