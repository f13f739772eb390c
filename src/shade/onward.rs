//! The reflected and the refracted rays of hits, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::fresnel::share;
use super::highlight::GROUP;
use super::looks::Looks;
use super::medium::{Crossings, Media, Surroundings};
use super::offset;
use super::palette::Palette;
use super::reflect::reflected;
use super::refract::{bent, transmitted_cosine};
use super::wave::{Meetings, Wave};
use super::{Census, FAINTEST, Surface};
use crate::field::{Level, Task, run_at};
use crate::num::{BATCH, Column, ROOM, Rows};
use crate::trace::Footprint;
use crate::trace::vector::place;
use glam::DVec3;
use std::ops::Range;

/// Up to [`BATCH`] hits that send rays on, and those rays.
pub struct Senders {
    /// Which rays of the wave they are of.
    numbers: Vec<u32>,
    /// How the rays arrive: their directions, distances, and the errors of these.
    incident: [Column; 3],
    t: Column,
    error: Column,
    /// What they weigh, belong to and travel in.
    weight: [Column; 3],
    samples: Vec<u32>,
    around: Surroundings,
    /// Where they hit, and the unit normals there: outward, then on the side from which the ray came.
    point: [Column; 3],
    outward: [Column; 3],
    /// How wide pixels are where the rays start, then at the hits, and by how much they grow.
    width: Column,
    spread: Column,
    /// The terms of their surfaces.
    reflect: Column,
    refract: Column,
    fresnel: Column,
    /// The indices of refraction on the ray's side and on the other.
    indices: [Column; 2],
    /// What the refracted rays travel in.
    beyond: Surroundings,
    mirrored: Branches,
    through: Branches,
    /// How far they are followed: all the way.
    end: Column,
}

/// Rays of one kind.
struct Branches {
    start: [Column; 3],
    direction: [Column; 3],
    weight: [Column; 3],
    /// Whether they are sent at all: 0 or 1, as wide as the other lanes.
    is_sent: [u64; ROOM],
    /// Whether they weigh enough to be followed.
    is_strong: [u64; ROOM],
}

impl Branches {
    fn new() -> Self {
        let column = [0.0; ROOM];
        Self {
            start: [column; 3],
            direction: [column; 3],
            weight: [column; 3],
            is_sent: [0; ROOM],
            is_strong: [0; ROOM],
        }
    }

    #[inline(always)]
    fn put(&mut self, i: usize, start: DVec3, direction: DVec3, (weight, share): (DVec3, f64)) {
        let weight = weight * share;
        self.is_sent[i] = u64::from(share != 0.0);
        let y = if weight.y > weight.z {
            weight.y
        } else {
            weight.z
        };
        let largest = if weight.x > y { weight.x } else { y };
        self.is_strong[i] = u64::from(largest >= FAINTEST);
        for axis in 0..3 {
            self.start[axis][i] = start[axis];
            self.direction[axis][i] = direction[axis];
            self.weight[axis][i] = weight[axis];
        }
    }
}

impl Senders {
    /// No hits: large, so it lives in a box.
    pub fn new() -> Box<Self> {
        let column = [0.0; ROOM];
        Box::new(Self {
            numbers: Vec::with_capacity(BATCH),
            incident: [column; 3],
            t: column,
            error: column,
            weight: [column; 3],
            samples: Vec::new(),
            around: Surroundings::default(),
            point: [column; 3],
            outward: [column; 3],
            width: column,
            spread: column,
            reflect: column,
            refract: column,
            fresnel: column,
            indices: [column; 2],
            beyond: Surroundings::default(),
            mirrored: Branches::new(),
            through: Branches::new(),
            end: [f64::INFINITY; ROOM],
        })
    }

    /// Adds the mirrored and the refracted rays of all hits of a wave to the next wave of each kind, unless they are deeper
    /// than `depth` or too faint.
    pub fn send_on(
        &mut self,
        wave: Meetings,
        (palette, looks): (&Palette, &Looks),
        (next, depth): (&mut [Wave; 2], u32),
        (census, level): (&mut Census, Level),
    ) {
        let mut first = 0;
        while first < wave.rays.len() {
            first = self.collect(&wave, (palette, looks), first);
            if self.numbers.is_empty() {
                return;
            }
            self.gather(&wave);
            run_at(level, Turn(self));
            let [mirrored, through] = &mut *next;
            let is_too_deep = mirrored.depth > depth;
            let kinds = [
                (&self.mirrored, mirrored, &self.around),
                (&self.through, through, &self.beyond),
            ];
            let sent = kinds.map(|kind| self.push(kind, is_too_deep, census));
            census.reflected += sent[0];
            census.refracted += sent[1];
        }
    }

    /// Takes the hits of a wave that send rays on, from ray number `first` on; gives where to go on.
    fn collect(
        &mut self,
        wave: &Meetings,
        (palette, looks): (&Palette, &Looks),
        first: usize,
    ) -> usize {
        self.numbers.clear();
        self.beyond.clear();
        let mut crossings = Crossings::default();
        let runs = looks.runs(palette);
        for (range, surface) in runs.filter(|(range, _)| range.end > first) {
            let Some(surface) = surface.filter(|surface| surface.sends_on()) else {
                continue;
            };
            let range = range.start.max(first)..range.end;
            let from = self.numbers.len();
            let some = range.start..range.end.min(range.start + BATCH - from);
            self.numbers.extend(some.start as u32..some.end as u32);
            let to = self.numbers.len();
            self.reflect[from..to].fill(surface.reflect);
            self.refract[from..to].fill(surface.refract);
            self.fresnel[from..to].fill(surface.fresnel);
            // Only what lets light through, or reflects by how it would, asks for media.
            if surface.refract != 0.0 || surface.fresnel != 0.0 {
                self.cross(wave, (some.clone(), surface), from, &mut crossings);
            } else {
                self.indices
                    .iter_mut()
                    .for_each(|indices| indices[from..to].fill(1.0));
                self.beyond.push_all(&Media::EMPTY, some.len());
            }
            if some.end < range.end {
                return some.end;
            }
        }
        wave.rays.len()
    }

    /// Finds how some rays of a wave go through a surface, from sender number `from` on.
    fn cross(
        &mut self,
        wave: &Meetings,
        (rays, surface): (Range<usize>, &Surface),
        from: usize,
        crossings: &mut Crossings,
    ) {
        let [normal, direction] = [wave.outcomes.normal(), wave.rays.direction()];
        let at = |columns: [&[f64]; 3], i: usize| DVec3::from_array(columns.map(|c| c[i]));
        let is_outside = |i| offset::is_outside(at(normal, i), at(direction, i));
        let asked = (&wave.paths.media, &wave.outcomes.part[..], is_outside);
        let mut from = from;
        let [before, behind] = &mut self.indices;
        let beyond = &mut self.beyond;
        crossings.each(rays, surface, asked, |some, _, crossing| {
            let to = from + some.len();
            before[from..to].fill(crossing.n1);
            behind[from..to].fill(crossing.n2);
            beyond.push_all(&crossing.beyond, some.len());
            from = to;
        });
    }

    /// Takes what is known of the rays and their hits.
    fn gather(&mut self, wave: &Meetings) {
        let rows = Rows::in_order(&self.numbers);
        let (rays, outcomes) = (wave.rays, wave.outcomes);
        for (columns, sources) in [
            (&mut self.incident, rays.direction()),
            (&mut self.weight, wave.paths.weights().columns()),
            (&mut self.point, outcomes.point()),
            (&mut self.outward, outcomes.normal()),
        ] {
            for (column, source) in columns.iter_mut().zip(sources) {
                rows.take(source, column);
            }
        }
        rows.take(outcomes.t(), &mut self.t);
        rows.take(outcomes.error(), &mut self.error);
        let [width, spread] = rays.footprint();
        rows.take(width, &mut self.width);
        rows.take(spread, &mut self.spread);
        self.samples.resize(self.numbers.len(), 0);
        rows.take(&wave.paths.sample, &mut self.samples);
        self.around.clear();
        self.around
            .pick(&wave.paths.media, self.numbers.iter().copied());
    }

    /// Adds rays of one kind, which travel in these media, to their next wave; gives how many.
    fn push(
        &self,
        (branches, next, media): (&Branches, &mut Wave, &Surroundings),
        is_too_deep: bool,
        census: &mut Census,
    ) -> u64 {
        let mut chosen: Vec<u32> = Vec::with_capacity(self.numbers.len());
        for k in 0..self.numbers.len() {
            if branches.is_sent[k] == 0 {
                continue;
            }
            if branches.is_strong[k] == 0 {
                census.too_faint += 1;
            } else if is_too_deep {
                census.too_deep += 1;
            } else {
                chosen.push(k as u32);
            }
        }
        let ([a, b, c], [d, e, f]) = (&branches.start, &branches.direction);
        let rays = [a, b, c, d, e, f, &self.end, &self.width, &self.spread];
        let columns = (
            rays.map(|column| &column[..]),
            branches.weight.each_ref().map(|column| &column[..]),
        );
        next.take(&chosen, columns, (&self.samples, media));
        chosen.len() as u64
    }
}

/// Finds where the rays go that hits send on, and what they weigh. The refracted share goes to the reflected ray where
/// reflection is total; Fresnel's equations divide the sum of both shares, of which an opaque surface sends only the
/// reflected part.
struct Turn<'a>(&'a mut Senders);

impl Task for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let s = self.0;
        let count = s.numbers.len();
        for first in (0..count).step_by(GROUP) {
            let first = first.min(BATCH - GROUP);
            mirror(s, first);
            let mut is_bent = false;
            for k in first..first + GROUP {
                is_bent |= (s.refract[k] != 0.0) | (s.fresnel[k] != 0.0);
            }
            if is_bent {
                bend(s, first);
            }
        }
    }
}

/// Mirrors the rays of a group from number `first` on, and lets none through.
#[inline(always)]
fn mirror(s: &mut Senders, first: usize) {
    for k in first..first + GROUP {
        let (incident, outward) = (place(&s.incident, k), place(&s.outward, k));
        let normal = offset::facing(outward, incident);
        // From here on they are the normals on the ray's side.
        for axis in 0..3 {
            s.outward[axis][k] = normal[axis];
        }
        let footprint = Footprint {
            at_origin: s.width[k],
            spread: s.spread[k],
        };
        s.width[k] = footprint.at(s.t[k]);
        let start = offset::start(place(&s.point, k), s.t[k], s.error[k], normal);
        let share = (place(&s.weight, k), s.reflect[k]);
        s.mirrored.put(k, start, reflected(incident, normal), share);
        s.through.is_sent[k] = 0;
    }
}

/// Divides the rays of a group from number `first` on into those that are mirrored and those that go through.
#[inline(always)]
fn bend(s: &mut Senders, first: usize) {
    for k in first..first + GROUP {
        let (incident, normal) = (place(&s.incident, k), place(&s.outward, k));
        let (point, weight) = (place(&s.point, k), place(&s.weight, k));
        let (reflect, refract, by_law) = (s.reflect[k], s.refract[k], s.fresnel[k]);
        let (n1, n2) = (s.indices[0][k], s.indices[1][k]);
        let cosine = (-incident.dot(normal)).clamp(0.0, 1.0);
        let transmitted = transmitted_cosine(cosine, n1, n2);
        let is_total = transmitted.is_nan();
        let both = reflect + refract;
        let by_fresnel = share(cosine, transmitted, n1, n2);
        let mixed = reflect + (both * by_fresnel - reflect) * by_law;
        let passed = refract + (both * (1.0 - by_fresnel) - refract) * by_law;
        let is_clear = refract != 0.0;
        let mirrored = if is_clear & is_total { both } else { mixed };
        let passed = if is_clear & !is_total { passed } else { 0.0 };
        let (start, direction) = (place(&s.mirrored.start, k), place(&s.mirrored.direction, k));
        s.mirrored.put(k, start, direction, (weight, mirrored));
        let start = offset::start(point, s.t[k], s.error[k], -normal);
        let direction = bent(incident, normal, (n1, n2), (cosine, transmitted));
        s.through.put(k, start, direction, (weight, passed));
    }
}
