//! Beams: rays that are traced together, and what surely holds all of them.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::RayColumns;
use super::analytic::{HalfSpace, U};
use super::bundle::{Bundle, fold, larger, lesser};
use super::hierarchy::{BRANCHES, Boxes, Eight};
use super::vector::place;
use crate::field::{Level, Task, run_at};
use crate::num::BATCH;
use glam::DVec3;

/// What holds a number of rays: ranges of their origins and directions, and a cone about their mean.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    origins: [DVec3; 2],
    directions: [DVec3; 2],
    paces: [Pace; 3],
    /// The mean ray: its direction is not normalised.
    origin: DVec3,
    direction: DVec3,
    /// No origin is farther from the mean one.
    width: f64,
    /// No direction differs by more from the mean one.
    spread: f64,
}

/// The ranges of a bundle's columns.
struct Ranges<'a>(&'a Bundle);

impl Task for Ranges<'_> {
    /// Of origins and directions, each the least and the largest.
    type Output = [[DVec3; 2]; 2];

    #[inline(always)]
    fn run(self) -> [[DVec3; 2]; 2] {
        let b = self.0;
        let mut ranges = [[DVec3::ZERO; 2]; 2];
        for (range, columns) in ranges.iter_mut().zip([&b.origin, &b.direction]) {
            for axis in 0..3 {
                let column = &columns[axis][..b.lanes()];
                range[0][axis] = fold(column, f64::INFINITY, lesser);
                range[1][axis] = fold(column, f64::NEG_INFINITY, larger);
            }
        }
        ranges
    }
}

/// The range of where a bundle's rays end.
struct Ends<'a>(&'a Bundle);

impl Task for Ends<'_> {
    /// The least and the largest.
    type Output = [DVec3; 2];

    #[inline(always)]
    fn run(self) -> [DVec3; 2] {
        let b = self.0;
        let mut range = [DVec3::ZERO; 2];
        let mut ends = [0.0; BATCH];
        for axis in 0..3 {
            for i in 0..b.lanes() {
                ends[i] = b.origin[axis][i] + b.direction[axis][i] * b.t_max[i];
            }
            let ends = &ends[..b.lanes()];
            range[0][axis] = fold(ends, f64::INFINITY, lesser);
            range[1][axis] = fold(ends, f64::NEG_INFINITY, larger);
        }
        let t_max = fold(&b.t_max[..b.lanes()], 0.0, larger);
        let size = range[0].abs().max(range[1].abs()) + DVec3::splat(t_max);
        [range[0] - ENDS * size, range[1] + ENDS * size]
    }
}

/// Room for the rounding of a place on a ray, as a share of its coordinates and of the way to it.
const ENDS: f64 = 8.0 * f64::EPSILON;

/// Finds where a beam enters boxes.
struct Enters<'a> {
    beam: &'a Beam,
    boxes: &'a Boxes,
    limit: f64,
}

impl Task for Enters<'_> {
    type Output = Eight;

    #[inline(always)]
    fn run(self) -> Eight {
        self.beam.entered(self.boxes, self.limit)
    }
}

/// The largest distances of a bundle's origins and directions from these, squared.
struct Distances<'a> {
    bundle: &'a Bundle,
    from: [DVec3; 2],
}

impl Task for Distances<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run(self) -> [f64; 2] {
        let b = self.bundle;
        let mut squares = [0.0; BATCH];
        let mut most = [0.0; 2];
        for (k, columns) in [&b.origin, &b.direction].into_iter().enumerate() {
            for i in 0..b.lanes() {
                squares[i] = place(columns, i).distance_squared(self.from[k]);
            }
            most[k] = fold(&squares[..b.lanes()], 0.0, larger);
        }
        most
    }
}

impl Beam {
    /// What holds all rays whose origins and directions lie in these ranges, each from the least to the largest coordinates.
    /// Directions may have any length.
    pub fn within(origins: [DVec3; 2], directions: [DVec3; 2]) -> Self {
        let half = |range: [DVec3; 2]| 0.5 * (range[1] - range[0]).length();
        Self::new(origins, directions, [half(origins), half(directions)])
    }

    /// The beam of all rays of a bundle.
    pub(super) fn around(bundle: &Bundle, level: Level) -> Self {
        let [origins, directions] = run_at(level, Ranges(bundle));
        Self::within(origins, directions)
    }

    /// This beam, which is that of a bundle, with no larger balls than its rays need.
    pub(super) fn tightened(&self, bundle: &Bundle, level: Level) -> Self {
        let from = [self.origins, self.directions].map(|[low, high]| 0.5 * (low + high));
        let squares = run_at(level, Distances { bundle, from });
        Self::new(self.origins, self.directions, squares.map(f64::sqrt))
    }

    /// The same rays from their ends back, if these lie closer together than where the rays start: so it is with shadow rays. All
    /// ends are finite.
    pub(super) fn back(&self, bundle: &Bundle, level: Level) -> Option<Self> {
        let ends = run_at(level, Ends(bundle));
        let width = |[low, high]: [DVec3; 2]| (high - low).max_element();
        (width(ends) < width(self.origins)).then(|| {
            let [low, high] = self.directions;
            Self::within(ends, [-high, -low])
        })
    }

    /// The rays in these ranges that are no farther than these from the means of both.
    fn new(origins: [DVec3; 2], directions: [DVec3; 2], [width, spread]: [f64; 2]) -> Self {
        // Room for the rounding of the square roots and of places along the rays.
        let room = 1.0 + 1e-12;
        Self {
            origins,
            directions,
            paces: [0, 1, 2].map(|axis| Pace::new(directions[0][axis], directions[1][axis])),
            origin: 0.5 * (origins[0] + origins[1]),
            direction: 0.5 * (directions[0] + directions[1]),
            width: width * room,
            spread: spread * room,
        }
    }

    /// Where the first of the rays may enter each of some boxes, if one of them may before `limit`; else infinite. Source:
    /// interval arithmetic as in Boulos, Wald and Shirley 2006.
    pub(super) fn enters(&self, boxes: &Boxes, limit: f64, level: Level) -> Eight {
        let beam = self;
        run_at(level, Enters { beam, boxes, limit })
    }

    /// As [`Beam::enters`], within a task.
    #[inline(always)]
    pub(super) fn entered(&self, boxes: &Boxes, limit: f64) -> Eight {
        let (mut enter, mut leave) = ([0.0; BRANCHES], [limit; BRANCHES]);
        for axis in 0..3 {
            let (low, high) = (&boxes.low[axis], &boxes.high[axis]);
            let [first, last] = self.origins.map(|end| end[axis]);
            let Pace { rise, fall } = self.paces[axis];
            // Rays that rise come in at `low` and leave at `high`, rays that fall the other way round.
            for k in 0..BRANCHES {
                let up = (low[k] - last) * rise[0];
                let down = (first - high[k]) * fall[0];
                enter[k] = larger(up * (1.0 - 1e-12), enter[k]);
                enter[k] = larger(down * (1.0 - 1e-12), enter[k]);
            }
            if rise[1] < f64::INFINITY {
                for k in 0..BRANCHES {
                    let way = high[k] - first;
                    let far = larger(way * rise[0], way * rise[1]);
                    leave[k] = lesser(far * (1.0 + 1e-12), leave[k]);
                }
            } else if fall[1] < f64::INFINITY {
                for k in 0..BRANCHES {
                    let way = last - low[k];
                    let far = larger(way * fall[0], way * fall[1]);
                    leave[k] = lesser(far * (1.0 + 1e-12), leave[k]);
                }
            }
        }
        for k in 0..BRANCHES {
            enter[k] = if enter[k] <= leave[k] {
                enter[k]
            } else {
                f64::INFINITY
            };
        }
        enter
    }

    /// A ball that holds every place of the rays from distance `from` to `to`.
    pub(super) fn ball(&self, from: f64, to: f64) -> (DVec3, f64) {
        let centre = self.origin + self.direction * (0.5 * (from + to));
        let across = self.width + self.spread * to;
        let along = 0.5 * (to - from) * self.direction.length();
        let rounding = 8.0 * f64::EPSILON * (self.origin.abs().max_element() + to);
        (centre, (across + along) * (1.0 + 1e-12) + rounding)
    }

    /// The half of the beam that a ray belongs to, if it is cut across where its rays differ most over the distance
    /// `reach`: the first or not.
    pub(super) fn divide<'a>(
        &self,
        reach: f64,
        rays: &RayColumns<'a>,
    ) -> impl Fn(&u32) -> bool + 'a {
        let differ = |ends: &[DVec3; 2], scale: f64| {
            let size = (ends[1] - ends[0]) * scale;
            let axis = size
                .to_array()
                .iter()
                .enumerate()
                .fold(
                    0,
                    |best, (axis, x)| {
                        if *x > size[best] { axis } else { best }
                    },
                );
            (axis, size[axis], 0.5 * (ends[0] + ends[1])[axis])
        };
        let origins = differ(&self.origins, 1.0);
        let directions = differ(&self.directions, reach);
        let (column, middle) = if origins.1 >= directions.1 {
            (rays[origins.0], origins.2)
        } else {
            (rays[3 + directions.0], directions.2)
        };
        move |number| column[*number as usize] < middle
    }

    /// Whether one of the rays, however far it is followed, may meet a half-space.
    pub(super) fn may_meet(&self, half: &HalfSpace) -> bool {
        // The least `n.x` of a range, and the largest number in it.
        let least = |[low, high]: [DVec3; 2]| {
            let (a, b) = (half.normal * low, half.normal * high);
            (a.min(b).element_sum(), a.abs().max(b.abs()).element_sum())
        };
        let (height, size) = least(self.origins);
        let (rise, speed) = least(self.directions);
        // Room for five roundings, and no more: rays that leave the plane start as close to it.
        let is_above = height - half.offset >= 5.0 * U * (size + half.offset.abs());
        !(is_above && rise > 1e-12 * speed)
    }

    /// How far apart the rays are at distance `t`: the radius of a cut through the beam.
    pub(super) fn radius(&self, t: f64) -> f64 {
        self.width + self.spread * t
    }
}

/// How long rays take for a unit along an axis: the fastest and the slowest of them. Infinite where there is none, or one
/// that never arrives.
#[derive(Clone, Copy, Debug)]
struct Pace {
    rise: [f64; 2],
    fall: [f64; 2],
}

impl Pace {
    /// The pace of rays whose directions have components from `slowest` to `fastest`.
    fn new(slowest: f64, fastest: f64) -> Self {
        let time = |speed: f64| {
            if speed > 0.0 {
                1.0 / speed
            } else {
                f64::INFINITY
            }
        };
        Self {
            rise: [time(fastest), time(slowest)],
            fall: [time(-slowest), time(-fastest)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Bounds;
    use crate::num::samples::random;
    use crate::trace::analytic::ClosedForm;
    use crate::trace::hierarchy::clip;
    use crate::trace::{Footprint, Ray, Rays};

    fn rays(seed: u64) -> Vec<Ray> {
        let place = |k: u64| {
            let x = |j: u64| 2.0 * random(seed * 4096 + k * 8 + j) - 1.0;
            DVec3::new(x(0), x(1), x(2))
        };
        let spread = random(seed).powi(3);
        let ray = |k: u64| Ray {
            origin: 3.0 * place(0) + 0.3 * spread * place(2 * k + 2),
            direction: (place(1) + spread * place(2 * k + 3)).normalize(),
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        };
        (0..45).map(ray).collect()
    }

    /// The beam of these rays, and the same tightened.
    fn beams(rays: &[Ray]) -> [Beam; 2] {
        let numbers: Vec<u32> = (0..rays.len() as u32).collect();
        let mut bundle = Bundle::new();
        let level = Level::best();
        let columns: Rays = rays.iter().collect();
        bundle.fill(&columns.columns(), &numbers);
        let beam = Beam::around(&bundle, level);
        let tight = beam.tightened(&bundle, level);
        [beam, tight]
    }

    fn beam(rays: &[Ray]) -> Beam {
        let [_, tight] = beams(rays);
        tight
    }

    #[test]
    fn what_a_ray_enters_its_beam_enters_no_later() {
        let mut entered = 0;
        for seed in 0..2000u64 {
            let rays = rays(seed);
            let beam = beam(&rays);
            let x = |j: u64| 3.0 * random(seed * 31 + j) - 1.5;
            let bounds = Bounds::centred([0.5 * random(seed + 7); 3]).translate([x(1), x(2), x(3)]);
            for ray in &rays {
                if let Some((enter, _)) = clip(ray.origin, ray.direction.recip(), &bounds, 100.0) {
                    entered += 1;
                    let boxes = Boxes::new([bounds].into_iter());
                    let [first, others @ ..] = beam.enters(&boxes, 100.0, Level::best());
                    assert_eq!(others, [f64::INFINITY; 7], "there is one box");
                    assert!(first <= enter, "seed {seed}: {first:?}, {enter}");
                }
            }
        }
        assert!(entered > 300, "{entered}");
    }

    #[test]
    fn what_a_ray_enters_before_its_end_its_beam_enters_from_there() {
        let (mut entered, mut nearer) = (0, 0);
        for seed in 0..2000u64 {
            let x = |j: u64| 3.0 * random(seed * 31 + j) - 1.5;
            // They end near one place.
            let end = 4.0 * DVec3::new(x(4), x(5), x(6));
            let aimed = |ray: Ray| {
                let way = end - ray.origin;
                Ray {
                    direction: way.normalize(),
                    t_max: way.length() * (1.0 - 0.01 * random(seed)),
                    ..ray
                }
            };
            let rays: Vec<Ray> = rays(seed).into_iter().map(aimed).collect();
            let numbers: Vec<u32> = (0..rays.len() as u32).collect();
            let (mut bundle, level) = (Bundle::new(), Level::best());
            let columns: Rays = rays.iter().collect();
            bundle.fill(&columns.columns(), &numbers);
            let Some(beam) = Beam::around(&bundle, level).back(&bundle, level) else {
                continue;
            };
            let bounds = Bounds::centred([0.5 * random(seed + 7); 3]).translate([x(1), x(2), x(3)]);
            let boxes = Boxes::new([bounds].into_iter());
            let limit = rays.iter().map(|ray| ray.t_max).fold(0.0, f64::max);
            let [found, ..] = beam.enters(&boxes, limit, level);
            nearer += u32::from(found == f64::INFINITY);
            for ray in &rays {
                let inverse = ray.direction.recip();
                if let Some((_, leave)) = clip(ray.origin, inverse, &bounds, ray.t_max) {
                    entered += 1;
                    let way = (ray.t_max - leave).max(0.0);
                    assert!(found <= way + 1e-12, "seed {seed}: {found}, {way}");
                }
            }
        }
        assert!(entered > 300 && nearer > 300, "{entered} {nearer}");
    }

    /// However close to a plane rays start, and however flat they go. Those that leave one across an axis are told apart from it
    /// within some roundings.
    #[test]
    fn a_plane_that_a_ray_crosses_its_beam_may_meet() {
        let (mut crossed, mut passed) = (0, 0);
        for seed in 0..4000u64 {
            let x = |j: u64| 2.0 * random(seed * 31 + j) - 1.0;
            let axis = [DVec3::X, DVec3::NEG_Y, DVec3::Z][seed as usize % 3];
            let tilted = DVec3::new(x(1), x(2), x(3)).normalize();
            let normal = if seed.is_multiple_of(2) { axis } else { tilted };
            let offset = if seed.is_multiple_of(5) { 0.0 } else { x(4) };
            let half = HalfSpace { normal, offset };
            // Off the plane by some roundings, on the side to which they go or on the other.
            let off = 64.0 * U * x(5);
            let across = normal.any_orthonormal_pair();
            let ray = |k: u64| {
                let y = |j: u64| random(seed * 512 + k * 8 + j) - 0.5;
                let aside = across.0 * y(0) + across.1 * y(1);
                let steep = if seed.is_multiple_of(7) { 1e-3 } else { 1.0 };
                Ray {
                    origin: normal * (offset + off * (1.0 + y(2))) + aside,
                    direction: (normal * steep + across.0 * y(3) + across.1 * y(4)).normalize(),
                    t_max: f64::INFINITY,
                    footprint: Footprint {
                        at_origin: 0.0,
                        spread: 1e-3,
                    },
                }
            };
            let rays: Vec<Ray> = (0..33).map(ray).collect();
            let crosses = |ray: &Ray| half.crossing(ray.origin, ray.direction).0 < f64::INFINITY;
            let crossing = rays.iter().filter(|ray| crosses(ray)).count();
            let may_meet = beam(&rays).may_meet(&half);
            assert!(may_meet || crossing == 0, "seed {seed}: {half:?}, {off:e}");
            crossed += u32::from(crossing > 0);
            if normal == axis && off > 24.0 * U * offset.abs() {
                assert!(!may_meet, "seed {seed}: {half:?}, {off:e}");
                passed += 1;
            }
        }
        assert!(crossed > 500 && passed > 500, "{crossed} {passed}");
    }

    #[test]
    fn balls_hold_the_rays() {
        for seed in 0..500u64 {
            let rays = rays(seed);
            let from = 10.0 * random(seed + 1);
            let to = from + random(seed + 2);
            let [loose, tight] = beams(&rays).map(|beam| beam.ball(from, to));
            assert!(tight.1 <= loose.1);
            for (centre, radius) in [loose, tight] {
                for ray in &rays {
                    for k in 0..=4 {
                        let t = from + (to - from) * f64::from(k) / 4.0;
                        assert!(ray.at(t).distance(centre) <= radius, "seed {seed}");
                    }
                }
            }
        }
    }
}
