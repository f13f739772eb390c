//! How much of a light's radiance reaches a point.
//!
//! Shadow rays are a batch of their own. Opaque surfaces stop them at the first hit, whichever it is. Where the scene has
//! tinted shadows, they walk along the straight ray from one boundary to the next instead, and keep at each of them the
//! share that its material passes, and between them what the medium does not absorb.

use super::attenuation::absorbed;
use super::census::sum;
use super::highlight::GROUP;
use super::lit::Lit;
use super::looks::Looks;
use super::medium::{Crossings, Medium, Surroundings};
use super::palette::Palette;
use super::{Census, Features, Surface, Surfaces, offset};
use crate::field::{Level, Task, run_at};
use crate::trace::{Occlusions, Outcome, Outcomes, Ray, Rays, Verdict, Visibility, count};
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
#[derive(Default)]
pub struct Obstacles {
    occlusions: Occlusions,
    outcomes: Outcomes,
    looks: Looks,
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
        weaken(seen, shadowed, met, census)
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
    census: &mut Census,
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
        walkers = step(seen, &walkers, met, &mut passages, census);
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

/// Takes every walker to its next boundary; those that arrive at the light or are blocked fall out.
fn step<S: Surfaces + ?Sized>(
    (surfaces, palette): (&S, &Palette),
    walkers: &Walkers,
    met: &mut Obstacles,
    passages: &mut [Passage],
    census: &mut Census,
) -> Walkers {
    let Walkers {
        rays,
        media,
        indices,
    } = walkers;
    let Obstacles {
        outcomes, looks, ..
    } = met;
    census.shadow += rays.len() as u64;
    census.timed(
        |t| &mut t.shadow,
        || surfaces.nearest(rays, Visibility::Casting, outcomes),
    );
    census.evaluations += sum(&outcomes.evaluations);
    census.unknown_secondary += count(&outcomes.verdict, Verdict::Unknown) as u64;
    palette.look_through(surfaces, outcomes, looks);
    let (mut further, mut crossings) = (Walkers::default(), Crossings::default());
    for (range, surface) in looks.runs(palette) {
        match surface {
            Some(surface) if surface.passes == 0.0 => {
                for i in range {
                    passages[indices[i] as usize].share = DVec3::ZERO;
                }
            }
            Some(surface) => {
                for i in range {
                    let hit = &outcomes.at(i);
                    let onward = (&mut *passages, &mut further, &mut crossings);
                    pass(walkers, i, (surface, hit), onward);
                }
            }
            None => {
                for i in range {
                    let passage = &mut passages[indices[i] as usize];
                    passage.unknown |= outcomes.verdict[i] == Verdict::Unknown;
                    let media = media.at(i);
                    if !media.is_empty() {
                        let end = outcomes.t()[i].min(rays.at(i).t_max);
                        passage.share *= absorbed(media.absorb(), end);
                    }
                }
            }
        }
    }
    further
}

/// Takes walker number `i` through a surface that it hit, if anything is left of the light behind it.
fn pass(
    walkers: &Walkers,
    i: usize,
    (surface, hit): (&Surface, &Outcome),
    (passages, further, crossings): (&mut [Passage], &mut Walkers, &mut Crossings),
) {
    let Walkers {
        rays,
        media,
        indices,
    } = walkers;
    let (ray, media, index) = (&rays.at(i), media.at(i), indices[i]);
    let passage = &mut passages[index as usize];
    passage.share *= absorbed(media.absorb(), hit.t);
    passage.share *= surface.passes;
    if passage.share == DVec3::ZERO {
        return;
    }
    let next = straight_on(ray, hit);
    if next.t_max > 0.0 {
        let medium = Medium::new(hit.part, surface);
        let is_entering = offset::is_outside(hit.normal, ray.direction);
        further.rays.push(&next);
        let crossing = crossings.across(media, medium, is_entering);
        further.media.push(&crossing.beyond);
        further.indices.push(index);
    }
}

/// The rest of a ray behind what it hit.
fn straight_on(ray: &Ray, hit: &Outcome) -> Ray {
    let far_side = -offset::facing(hit.normal, ray.direction);
    let next = offset::leaving(hit, far_side, ray.direction, ray.footprint);
    let advance = (next.origin - ray.origin).dot(ray.direction);
    Ray {
        t_max: ray.t_max - advance,
        ..next
    }
}
