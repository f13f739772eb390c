//! How much of a light's radiance reaches a point.
//!
//! Shadow rays are a batch of their own. Opaque surfaces stop them at the first hit, whichever it is. Where the scene has
//! tinted shadows, they walk along the straight ray from one boundary to the next instead, and keep at each of them the
//! share that its material passes, and between them what the medium does not absorb.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::attenuation::absorbed;
use super::census::sum;
use super::highlight::{GROUP, groups};
use super::lit::{Lit, put};
use super::looks::Looks;
use super::medium::{Crossings, Surroundings};
use super::palette::Palette;
use super::{Census, Features, Surfaces, offset};
use crate::field::{Level, Task, run_at};
use crate::num::{BATCH, Column, ROOM};
use crate::trace::vector::place;
use crate::trace::{Footprint, Occlusions, Outcomes, RayColumns, Rays, Verdict, Visibility, count};
use glam::DVec3;

/// How many boundaries a shadow ray may cross before it is given up as unknown, and taken as blocked.
const MAX_CROSSINGS: usize = 256;

/// What reaches the start of a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Passage {
    /// The share of the light, in each channel.
    share: DVec3,
    /// Whether the tracer could not tell.
    unknown: bool,
}

impl Passage {
    const CLEAR: Self = Self {
        share: DVec3::ONE,
        unknown: false,
    };
}

/// Hits of a wave, and the rays from them to a lamp.
pub struct Shadowed<'a> {
    /// The hits with what they gain from the lamp if nothing is in the way.
    pub lit: &'a mut Lit,
    /// Those that gain something, by their numbers in it, in order.
    pub hits: &'a [u32],
    /// What all rays of the wave travel in.
    pub media: &'a Surroundings,
}

/// What shadow rays meet; memory that is used again for others.
pub struct Obstacles {
    occlusions: Occlusions,
    outcomes: Outcomes,
    looks: Looks,
    beyond: Box<Beyond>,
}

impl Obstacles {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            occlusions: Occlusions::default(),
            outcomes: Outcomes::default(),
            looks: Looks::default(),
            beyond: Beyond::new(),
        }
    }
}

/// Takes from hits what does not reach them; gives those of which the tracer could not tell. Where it could not tell whether
/// something is in the way, nothing is.
pub fn darken<S: Surfaces + ?Sized>(
    seen: (&S, &Palette),
    features: &Features,
    (shadowed, met): (Shadowed, &mut Obstacles),
    (census, level): (&mut Census, Level),
) -> Vec<u32> {
    if features.tinted_shadows {
        weaken(seen, shadowed, met, (census, level))
    } else if features.opaque_shadows {
        stop(seen.0, shadowed, &mut met.occlusions, (census, level))
    } else {
        Vec::new()
    }
}

/// Takes what is gained along rays that meet an opaque surface; gives those of which the tracer could not tell.
fn stop<S: Surfaces + ?Sized>(
    surfaces: &S,
    Shadowed { lit, hits, .. }: Shadowed,
    occlusions: &mut Occlusions,
    (census, level): (&mut Census, Level),
) -> Vec<u32> {
    census.shadow += hits.len() as u64;
    census.timed(
        |t| &mut t.shadow,
        || surfaces.occluded(&lit.rays(), hits, occlusions),
    );
    census.evaluations += sum(&occlusions.evaluations);
    let verdicts = &occlusions.verdict[..];
    if count(verdicts, Verdict::Hit) > 0 {
        let gained = lit.gained_mut();
        run_at(level, Darken { gained, verdicts });
    }
    if count(verdicts, Verdict::Unknown) == 0 {
        return Vec::new();
    }
    let verdicts = (0..).zip(verdicts);
    let unknown = verdicts.filter(|(_, verdict)| **verdict == Verdict::Unknown);
    let unknown: Vec<u32> = unknown.map(|(i, _)| i).collect();
    census.unknown_secondary += unknown.len() as u64;
    unknown
}

/// Takes what is gained along rays that meet something.
struct Darken<'a> {
    gained: [&'a mut [f64]; 3],
    verdicts: &'a [Verdict],
}

impl Task for Darken<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let [r, g, b] = self.gained;
        let channels = r.chunks_mut(GROUP).zip(g.chunks_mut(GROUP));
        let channels = channels.zip(b.chunks_mut(GROUP));
        let mut is_dark = [0u64; GROUP];
        for (((r, g), b), verdicts) in channels.zip(self.verdicts.chunks(GROUP)) {
            for (is_dark, verdict) in is_dark.iter_mut().zip(verdicts) {
                *is_dark = u64::from(*verdict == Verdict::Hit);
            }
            for channel in [r, g, b] {
                for (gained, is_dark) in channel.iter_mut().zip(&is_dark) {
                    *gained = if *is_dark == 0 { *gained } else { 0.0 };
                }
            }
        }
    }
}

/// Weakens what comes through tinted surfaces; gives the hits of which the tracer could not tell.
fn weaken<S: Surfaces + ?Sized>(
    seen: (&S, &Palette),
    Shadowed { lit, hits, media }: Shadowed,
    met: &mut Obstacles,
    (census, level): (&mut Census, Level),
) -> Vec<u32> {
    let mut walkers = Walkers::default();
    walkers.rays.pick(lit.rays(), hits);
    let first = lit.numbers.start as u32;
    walkers
        .media
        .pick(media, hits.iter().map(|hit| first + hit));
    walkers.indices.extend_from_slice(hits);
    let mut passages = vec![Passage::CLEAR; lit.numbers.len()];
    for _ in 0..MAX_CROSSINGS {
        if walkers.rays.is_empty() {
            break;
        }
        walkers = step(seen, &walkers, met, &mut passages, (census, level));
    }
    for index in walkers.indices {
        census.unknown_secondary += 1;
        passages[index as usize] = Passage {
            share: DVec3::ZERO,
            unknown: true,
        };
    }
    for (k, channel) in lit.gained_mut().into_iter().enumerate() {
        for (gained, passage) in channel.iter_mut().zip(&passages) {
            *gained *= passage.share[k];
        }
    }
    let unknown = (0..).zip(&passages).filter(|(_, passage)| passage.unknown);
    unknown.map(|(i, _)| i).collect()
}

/// Shadow rays on their way.
#[derive(Default)]
struct Walkers {
    rays: Rays,
    media: Surroundings,
    /// Which hit each of them is of.
    indices: Vec<u32>,
}

/// Takes every walker, no more than a batch, to its next boundary; those that arrive at the light or are blocked fall out.
fn step<S: Surfaces + ?Sized>(
    (surfaces, palette): (&S, &Palette),
    walkers: &Walkers,
    met: &mut Obstacles,
    passages: &mut [Passage],
    (census, level): (&mut Census, Level),
) -> Walkers {
    let Walkers {
        rays,
        media,
        indices,
    } = walkers;
    let Obstacles {
        outcomes,
        looks,
        beyond,
        ..
    } = met;
    census.shadow += rays.len() as u64;
    census.timed(
        |t| &mut t.shadow,
        || surfaces.nearest(rays, Visibility::Casting, outcomes),
    );
    census.evaluations += sum(&outcomes.evaluations);
    census.unknown_secondary += count(&outcomes.verdict, Verdict::Unknown) as u64;
    palette.look_through(surfaces, outcomes, looks);
    let straight_on = StraightOn {
        rays,
        outcomes,
        beyond,
    };
    run_at(level, straight_on);
    let mut further = Walkers::default();
    let (mut chosen, mut crossings) = (Vec::with_capacity(rays.len()), Crossings::default());
    let t = outcomes.t();
    let is_outside = |i: usize| beyond.is_outside[i] != 0;
    for (range, surface) in looks.runs(palette) {
        match surface {
            Some(surface) if surface.passes == 0.0 => {
                for i in range {
                    passages[indices[i] as usize].share = DVec3::ZERO;
                }
            }
            Some(surface) => {
                let asked = (media, &outcomes.part[..], is_outside);
                crossings.each(range, surface, asked, |some, media, crossing| {
                    let (absorb, before) = (media.absorb(), chosen.len());
                    for i in some {
                        let passage = &mut passages[indices[i] as usize];
                        passage.share *= absorbed(absorb, t[i]);
                        passage.share *= surface.passes;
                        if passage.share != DVec3::ZERO && beyond.end[i] > 0.0 {
                            chosen.push(i as u32);
                        }
                    }
                    let more = chosen.len() - before;
                    further.media.push_all(&crossing.beyond, more);
                });
            }
            None => {
                for i in range {
                    let passage = &mut passages[indices[i] as usize];
                    passage.unknown |= outcomes.verdict[i] == Verdict::Unknown;
                    let media = media.at(i);
                    if !media.is_empty() {
                        let end = t[i].min(rays.at(i).t_max);
                        passage.share *= absorbed(media.absorb(), end);
                    }
                }
            }
        }
    }
    further.rays.pick(beyond.rays(rays), &chosen);
    let indices = chosen.iter().map(|i| indices[*i as usize]);
    further.indices.extend(indices);
    further
}

/// The rests of rays behind what they hit. What hit nothing is there too, with numbers that mean nothing. Every column begins with
/// a cache line.
#[repr(C, align(64))]
struct Beyond {
    origin: [Column; 3],
    end: Column,
    /// How wide pixels are at the origins.
    width: Column,
    /// Whether the rays come to their hits from the outside: 0 or 1, as wide as the other lanes.
    is_outside: [u64; ROOM],
}

impl Beyond {
    /// No rays: large, so it lives in a box.
    fn new() -> Box<Self> {
        let column = [0.0; ROOM];
        Box::new(Self {
            origin: [column; 3],
            end: column,
            width: column,
            is_outside: [0; ROOM],
        })
    }

    /// The rests of these rays.
    fn rays<'a>(&'a self, rays: &'a Rays) -> RayColumns<'a> {
        let [a, b, c] = &self.origin;
        let [_, _, _, d, e, f, _, _, spread] = rays.columns();
        [a, b, c, d, e, f, &self.end, &self.width, spread]
    }
}

/// Finds the rests of rays, straight on behind what they hit.
struct StraightOn<'a> {
    rays: &'a Rays,
    outcomes: &'a Outcomes,
    beyond: &'a mut Beyond,
}

impl Task for StraightOn<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let to = self.beyond;
        let [a, b, c, d, e, f, t_max, width, spread] = self.rays.lanes();
        let [t, error, g, h, k, l, m, n] = self.outcomes.lanes();
        let columns = [
            a, b, c, d, e, f, g, h, k, l, m, n, t, error, t_max, width, spread,
        ];
        for first in (0..self.rays.len()).step_by(GROUP) {
            let first = first.min(BATCH - GROUP);
            let [
                a,
                b,
                c,
                d,
                e,
                f,
                g,
                h,
                k,
                l,
                m,
                n,
                t,
                error,
                t_max,
                width,
                spread,
            ] = groups(columns, first);
            let (mut start, mut end) = ([[0.0; GROUP]; 3], [0.0; GROUP]);
            let (mut wide, mut outside) = ([0.0; GROUP], [0; GROUP]);
            for i in 0..GROUP {
                let (origin, direction) = (place(&[a, b, c], i), place(&[d, e, f], i));
                let (point, normal) = (place(&[g, h, k], i), place(&[l, m, n], i));
                let far_side = -offset::facing(normal, direction);
                let next = offset::start(point, t[i], error[i], far_side);
                for axis in 0..3 {
                    start[axis][i] = next[axis];
                }
                end[i] = t_max[i] - (next - origin).dot(direction);
                let footprint = Footprint {
                    at_origin: width[i],
                    spread: spread[i],
                };
                wide[i] = footprint.at(t[i]);
                outside[i] = u64::from(offset::is_outside(normal, direction));
            }
            put(to.origin.each_mut(), first, start.each_ref());
            put([&mut to.end, &mut to.width], first, [&end, &wide]);
            to.is_outside[first..first + GROUP].copy_from_slice(&outside);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Outcome, Ray};

    /// What a ray meets on a wall across the z axis, from either side.
    fn on_wall(ray: Ray) -> Outcome {
        let t = -ray.origin.z / ray.direction.z;
        Outcome {
            verdict: Verdict::Hit,
            t,
            error: 1e-12,
            point: ray.origin + ray.direction * t,
            normal: DVec3::Z,
            ..Outcome::NOTHING
        }
    }

    #[test]
    fn rays_go_straight_on_behind_what_they_hit() {
        let ray = |i: u32| {
            let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let aside = f64::from(i) / 50.0 - 0.7;
            Ray {
                origin: DVec3::new(1.0, aside, 2.0 * side),
                direction: DVec3::new(0.1, -aside, -side).normalize(),
                t_max: 5.0,
                footprint: Footprint {
                    at_origin: 0.5,
                    spread: 0.25,
                },
            }
        };
        let rays: Rays = (0..70).map(ray).collect();
        let outcomes: Outcomes = rays.iter().map(on_wall).collect();
        let mut beyond = Beyond::new();
        let task = StraightOn {
            rays: &rays,
            outcomes: &outcomes,
            beyond: &mut beyond,
        };
        run_at(Level::best(), task);
        let numbers: Vec<u32> = (0..70).collect();
        let found = Rays::picked(beyond.rays(&rays), &numbers);
        for (i, (before, after)) in rays.iter().zip(found.iter()).enumerate() {
            let t = outcomes.t()[i];
            let is_outside = before.origin.z > 0.0;
            assert_eq!(beyond.is_outside[i], u64::from(is_outside));
            // On the other side of the wall, within a few errors of it.
            let behind = if is_outside {
                -after.origin.z
            } else {
                after.origin.z
            };
            assert!(behind > 0.0 && behind < 4e-12, "{after:?}");
            assert!((after.t_max - (5.0 - t)).abs() < 1e-11);
            let end = after.origin + after.direction * after.t_max;
            assert!(end.distance(before.origin + before.direction * 5.0) < 1e-11);
            assert_eq!(after.direction, before.direction);
            let width = after.footprint.at_origin - (0.5 + 0.25 * t);
            assert!(width.abs() < 1e-12 && after.footprint.spread == 0.25);
        }
    }
}
