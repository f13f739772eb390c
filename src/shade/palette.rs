//! What the surfaces of a scene look like: materials that are the same at all points are evaluated once, and patterns at many
//! points at a time.

use super::lighting::{LIGHTING, place, row};
use super::looks::{Looks, NONE};
use super::surface::{Property, Terms};
use super::{Surface, Surfaces};
use crate::field::{Level, Task, Walked, compile_graph, run_at};
use crate::num::{Columns, F64x32, Lanes, Number, Vec3};
use crate::scene::{Graph, Material, Term};
use crate::trace::{Outcomes, Verdict};
use glam::DVec3;
use std::mem;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// How many points are evaluated at a time.
const WIDTH: usize = F64x32::WIDTH;

/// A material of a scene.
struct Swatch {
    material: Arc<Material>,
    /// Its surface at the origin.
    surface: Surface,
    /// The terms that differ from point to point, in the order in which a surface asks for them; none where it is the same
    /// everywhere.
    patterns: Vec<Pattern>,
    /// Whether lighting reads all such terms, and nothing else does.
    is_only_lit: bool,
}

/// A term that differs from point to point.
struct Pattern {
    walk: Walked<F64x32>,
    /// 3 for a colour, else 1.
    outputs: usize,
    property: Property,
}

/// The materials of a scene.
pub struct Palette {
    swatches: Vec<Swatch>,
    level: Level,
    serial: u64,
}

/// How many palettes there were.
static PALETTES: AtomicU64 = AtomicU64::new(0);

impl Palette {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.swatches.len()
    }

    /// The surface of material number `i` at the origin, if there are so many.
    pub fn surface(&self, i: usize) -> Option<&Surface> {
        self.swatches.get(i).map(|swatch| &swatch.surface)
    }

    /// The palette of these materials.
    pub fn new(materials: &[Arc<Material>]) -> Self {
        let level = Level::best();
        let swatch = |material: &Arc<Material>| {
            let mut graphs = Graphs(Vec::new());
            let surface = Surface::of_terms(material, &mut graphs);
            let pattern = |(property, graph): (Property, Arc<Graph>)| Pattern {
                walk: compile_graph(&graph, level),
                outputs: if graph.outputs() == 3 { 3 } else { 1 },
                property,
            };
            let patterns: Vec<Pattern> = graphs.0.into_iter().map(pattern).collect();
            let is_lit = |pattern: &Pattern| place(pattern.property).is_some();
            Swatch {
                material: material.clone(),
                surface,
                is_only_lit: patterns.iter().all(is_lit),
                patterns,
            }
        };
        Self {
            swatches: materials.iter().map(swatch).collect(),
            level,
            serial: PALETTES.fetch_add(1, Ordering::Relaxed) + 1,
        }
    }

    /// A number that no other palette has; not 0.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// Finds the surfaces that rays with these outcomes hit, with what lighting reads of them.
    pub fn look<S: Surfaces + ?Sized>(&self, surfaces: &S, outcomes: &Outcomes, looks: &mut Looks) {
        self.number(surfaces, outcomes, looks);
        looks.write_terms(self);
        self.paint_varied(looks, outcomes, true);
    }

    /// The same for rays that only pass: without what lighting reads.
    pub fn look_through<S: Surfaces + ?Sized>(
        &self,
        surfaces: &S,
        outcomes: &Outcomes,
        looks: &mut Looks,
    ) {
        self.number(surfaces, outcomes, looks);
        self.paint_varied(looks, outcomes, false);
    }

    /// Numbers the surfaces that rays hit.
    fn number<S: Surfaces + ?Sized>(&self, surfaces: &S, outcomes: &Outcomes, looks: &mut Looks) {
        looks.own.clear();
        looks.numbers.clear();
        looks.varied.clear();
        same_parts(outcomes, |rays| {
            self.look_at(surfaces, outcomes, rays, looks);
        });
    }

    /// Gives the rays whose surfaces have patterns theirs; with what lighting reads of them only if they are `lit`.
    fn paint_varied(&self, looks: &mut Looks, outcomes: &Outcomes, lit: bool) {
        let mut varied = mem::take(&mut looks.varied);
        varied.sort_unstable_by_key(|(number, rays)| (*number, rays.start));
        let mut rays = Vec::new();
        for same in varied.chunk_by(|(a, _), (b, _)| a == b) {
            let number = same[0].0 as usize;
            if !lit && self.swatches[number].is_only_lit {
                continue;
            }
            rays.clear();
            for (_, some) in same {
                rays.extend(some.clone());
            }
            self.paint(looks, number, outcomes, (&rays, lit));
        }
        looks.varied = varied;
    }
}

/// Calls `each` with the ranges of rays that hit the same part, or nothing.
fn same_parts(outcomes: &Outcomes, mut each: impl FnMut(Range<usize>)) {
    /// So many are compared at once.
    const SOME: usize = 16;
    let (verdicts, parts) = (&outcomes.verdict, &outcomes.part);
    let Some((mut verdict, mut part)) = verdicts.first().copied().zip(parts.first().copied())
    else {
        return;
    };
    let (mut first, mut begin) = (0, 0);
    for (some_verdicts, some_parts) in verdicts.chunks(SOME).zip(parts.chunks(SOME)) {
        let differs = |(v, p): (&Verdict, &u32)| u32::from((*v != verdict) | (*p != part));
        let others = some_verdicts.iter().zip(some_parts).map(differs);
        if others.sum::<u32>() > 0 {
            for (k, (v, p)) in some_verdicts.iter().zip(some_parts).enumerate() {
                if (*v, *p) != (verdict, part) {
                    each(begin..first + k);
                    (begin, verdict, part) = (first + k, *v, *p);
                }
            }
        }
        first += some_verdicts.len();
    }
    each(begin..first);
}

impl Palette {
    /// Finds the surface of rays that hit the same part, or nothing.
    fn look_at<S: Surfaces + ?Sized>(
        &self,
        surfaces: &S,
        outcomes: &Outcomes,
        rays: Range<usize>,
        looks: &mut Looks,
    ) {
        let end = rays.end;
        if outcomes.verdict[rays.start] != Verdict::Hit {
            looks.numbers.resize(end, NONE);
            return;
        }
        let part = outcomes.part[rays.start];
        let Some(number) = surfaces.sole(part) else {
            let [x, y, z] = outcomes.point();
            let points: Vec<[f64; 3]> = rays.map(|i| [x[i], y[i], z[i]]).collect();
            surfaces.paints_at(part, &points, &mut |_, paints| {
                let surface = Surface::mixed(paints);
                let number = surface.map_or(NONE, |surface| looks.add(self, surface));
                looks.numbers.push(number);
            });
            return;
        };
        let number = number as u32;
        if !self.swatches[number as usize].patterns.is_empty() {
            let some = rays.start as u32..end as u32;
            looks.varied.push((number, some));
        }
        looks.numbers.resize(end, number);
    }

    /// Gives these rays, in order, their surfaces, all of one material with patterns; with what lighting reads of them only if
    /// they are lit.
    fn paint(
        &self,
        looks: &mut Looks,
        number: usize,
        outcomes: &Outcomes,
        (rays, lit): (&[u32], bool),
    ) {
        let swatch = &self.swatches[number];
        if swatch.is_only_lit {
            let task = Strokes {
                patterns: &swatch.patterns,
                points: outcomes.point(),
                rays,
                terms: &mut looks.terms,
            };
            return run_at(self.level, task);
        }
        let mut easel = Easel::new();
        for rays in rays.chunks(WIDTH) {
            easel.place(outcomes.point(), rays);
            let values = swatch.patterns.iter().map(|pattern| {
                easel.look(pattern);
                easel.value
            });
            let values: Vec<[F64x32; 3]> = values.collect();
            for (lane, ray) in rays.iter().enumerate() {
                let mut known = Known {
                    values: values.iter(),
                    lane,
                };
                let surface = Surface::of_terms(&swatch.material, &mut known);
                if lit {
                    let row = row(&surface);
                    for (column, number) in looks.terms.columns_mut().into_iter().zip(row) {
                        column[*ray as usize] = number;
                    }
                }
                looks.numbers[*ray as usize] = looks.add(self, surface);
            }
        }
    }
}

/// A place for some points, and for what a pattern is there.
struct Easel {
    points: Vec3<F64x32>,
    value: [F64x32; 3],
}

impl Easel {
    fn new() -> Self {
        Self {
            points: Vec3::splat([0.0; 3]),
            value: [Lanes([0.0; WIDTH]); 3],
        }
    }

    /// Takes the points of these rays, at most [`WIDTH`]; lanes without a ray are at the first ray's place.
    #[inline(always)]
    fn place(&mut self, points: [&[f64]; 3], rays: &[u32]) {
        let Vec3 { x, y, z } = &mut self.points;
        for (lanes, column) in [x, y, z].into_iter().zip(points) {
            if let Some(first) = neighbours(rays) {
                lanes.0.copy_from_slice(&column[first..first + WIDTH]);
            } else {
                for lane in 0..WIDTH {
                    let ray = rays[if lane < rays.len() { lane } else { 0 }];
                    lanes.0[lane] = column[ray as usize];
                }
            }
        }
    }

    /// Finds what a pattern is at the points; one with one output gives a grey.
    #[inline(always)]
    fn look(&mut self, pattern: &Pattern) {
        let value = &mut self.value;
        (pattern.walk)(&self.points, &mut value[..pattern.outputs]);
        if pattern.outputs == 1 {
            (value[1], value[2]) = (value[0], value[0]);
        }
    }
}

/// Where rays begin that are [`WIDTH`] neighbours, given in order.
#[inline(always)]
fn neighbours(rays: &[u32]) -> Option<usize> {
    let is_full = rays.len() == WIDTH && (rays[WIDTH - 1] - rays[0]) as usize == WIDTH - 1;
    is_full.then(|| rays[0] as usize)
}

/// Writes terms that lighting reads and that differ from point to point.
struct Strokes<'a> {
    patterns: &'a [Pattern],
    points: [&'a [f64]; 3],
    rays: &'a [u32],
    terms: &'a mut Columns<LIGHTING>,
}

impl Task for Strokes<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut easel = Easel::new();
        let mut columns = self.terms.columns_mut();
        for rays in self.rays.chunks(WIDTH) {
            easel.place(self.points, rays);
            for pattern in self.patterns {
                let Some(first) = place(pattern.property) else {
                    continue;
                };
                easel.look(pattern);
                if pattern.property == Property::Shininess {
                    easel.value[0] = easel.value[0].max(Lanes([0.0; WIDTH]));
                }
                let is_color = pattern.property == Property::Color;
                let count = if is_color { 3 } else { 1 };
                for (column, lanes) in columns[first..].iter_mut().zip(&easel.value[..count]) {
                    if let Some(first) = neighbours(rays) {
                        column[first..first + WIDTH].copy_from_slice(&lanes.0);
                    } else {
                        for (ray, number) in rays.iter().zip(&lanes.0) {
                            column[*ray as usize] = *number;
                        }
                    }
                }
            }
        }
    }
}

/// Collects the patterns of a material; their values don't matter.
struct Graphs(Vec<(Property, Arc<Graph>)>);

impl Graphs {
    fn value<T: Copy>(&mut self, property: Property, term: &Term<T>, nothing: T) -> T {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(graph) => {
                self.0.push((property, graph.clone()));
                nothing
            }
        }
    }
}

impl Terms for Graphs {
    fn number(&mut self, property: Property, term: &Term<f64>) -> f64 {
        self.value(property, term, 0.0)
    }

    fn color(&mut self, property: Property, term: &Term<DVec3>) -> DVec3 {
        self.value(property, term, DVec3::ZERO)
    }
}

/// Values of patterns that are known, in the order in which they are asked for.
struct Known<'a> {
    values: std::slice::Iter<'a, [F64x32; 3]>,
    lane: usize,
}

impl Known<'_> {
    fn next(&mut self) -> DVec3 {
        let lane = self.lane;
        let value = self.values.next();
        value.map_or(DVec3::ZERO, |[r, g, b]| {
            DVec3::new(r.0[lane], g.0[lane], b.0[lane])
        })
    }
}

impl Terms for Known<'_> {
    fn number(&mut self, _: Property, term: &Term<f64>) -> f64 {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(_) => self.next().x,
        }
    }

    fn color(&mut self, _: Property, term: &Term<DVec3>) -> DVec3 {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(_) => self.next(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::lighting::BACKDROP;
    use super::*;
    use crate::num::samples::random;
    use crate::scene::GraphBuilder;
    use crate::trace::{Occlusions, Outcome, Paint, RayColumns, Rays, Visibility};

    /// Materials alone: part number `i` has material number `i`.
    struct Samples(Vec<Arc<Material>>);

    impl Surfaces for Samples {
        fn nearest(&self, _: &Rays, _: Visibility, _: &mut Outcomes) {}

        fn occluded(&self, _: &RayColumns, _: &[u32], _: &mut Occlusions) {}

        fn paints(&self, _: u32, _: DVec3) -> Vec<Paint<'_>> {
            Vec::new()
        }

        fn materials(&self) -> &[Arc<Material>] {
            &self.0
        }

        fn sole(&self, part: u32) -> Option<usize> {
            Some(part as usize)
        }
    }

    /// A pattern with as many outputs: products of coordinates and a number.
    fn pattern(seed: u64, outputs: usize) -> Arc<Graph> {
        let mut builder = GraphBuilder::new();
        let [x, y, z] = builder.point();
        let outputs: Vec<_> = (0..outputs)
            .map(|k| {
                let scale = builder.constant(random(seed + k as u64));
                let a = builder.multiply([x, y, z][k % 3], scale);
                builder.multiply(a, [y, z, x][k % 3])
            })
            .collect();
        Arc::new(builder.finish(&outputs))
    }

    #[test]
    fn rays_that_hit_the_same_part_are_in_one_range() {
        for seed in 0..40u64 {
            // Runs of about 1, 4, 13 and 40 rays, that hit one of two parts or nothing.
            let change = [1.0, 0.25, 0.08, 0.025][seed as usize % 4];
            let mut now = (Verdict::Miss, 0);
            let outcome = |i: u64| {
                let x = |k: u64| random(1000 * seed + 3 * i + k);
                if x(0) < change {
                    let part = (2.0 * x(1)) as u32;
                    now = [(Verdict::Hit, part), (Verdict::Miss, 0)][(2.0 * x(2)) as usize];
                }
                let (verdict, part) = now;
                Outcome {
                    verdict,
                    part,
                    ..Outcome::NOTHING
                }
            };
            let outcomes: Outcomes = (0..8 * seed).map(outcome).collect();
            let all: Vec<_> = outcomes.iter().map(|o| (o.verdict, o.part)).collect();
            let expected: Vec<usize> = all.chunk_by(|a, b| a == b).map(<[_]>::len).collect();
            let (mut lengths, mut next) = (Vec::new(), 0);
            same_parts(&outcomes, |range| {
                assert_eq!(range.start, next);
                next = range.end;
                lengths.push(range.len());
            });
            assert_eq!(lengths, expected);
        }
    }

    #[test]
    fn surfaces_are_those_of_single_points() {
        let number = |seed| Term::Pattern(pattern(seed, 1));
        let materials = Samples(vec![
            Arc::new(Material::default()),
            Arc::new(Material {
                color: Term::Pattern(pattern(7, 3)),
                ior: number(21),
                refract: number(22),
                ..Material::default()
            }),
            Arc::new(Material {
                color: Term::Pattern(pattern(5, 3)),
                ambient: number(11),
                shininess: number(12),
                ..Material::default()
            }),
            Arc::new(Material {
                color: Term::Pattern(pattern(9, 1)),
                shininess: number(31),
                absorb: Term::Pattern(pattern(32, 3)),
                ..Material::default()
            }),
            Arc::new(Material {
                diffuse: number(41),
                specular: number(42),
                ..Material::default()
            }),
        ]);
        let outcome = |i: u64| Outcome {
            verdict: if i % 7 == 4 && i < 200 {
                Verdict::Miss
            } else {
                Verdict::Hit
            },
            part: (if i < 200 { i % 5 } else { i / 40 % 5 }) as u32,
            point: DVec3::from_array([0, 1, 2].map(|k| 4.0 * random(100 + 3 * i + k) - 2.0)),
            ..Outcome::NOTHING
        };
        let outcomes: Outcomes = (0..600).map(outcome).collect();
        let palette = Palette::new(&materials.0);
        let mut looks = Looks::default();
        // What was there before is of no concern.
        let nothing: Outcomes = [Outcome::NOTHING; 7].into_iter().collect();
        for outcomes in [nothing, outcomes.clone(), outcomes] {
            palette.look(&materials, &outcomes, &mut looks);
            for (i, outcome) in outcomes.iter().enumerate() {
                let material = &materials.0[outcome.part as usize];
                let expected = Surface::new(material, outcome.point.to_array());
                let is_hit = outcome.verdict == Verdict::Hit;
                let terms = if is_hit { row(&expected) } else { BACKDROP };
                assert_eq!(looks.terms.row(i), terms);
                let found = looks.at(&palette, i).map(|surface| Surface {
                    color: expected.color,
                    ambient: expected.ambient,
                    diffuse: expected.diffuse,
                    specular: expected.specular,
                    shininess: expected.shininess,
                    ..*surface
                });
                assert_eq!(found, is_hit.then_some(expected));
            }
        }
    }
}
