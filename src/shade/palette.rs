//! What the surfaces of a scene look like: materials that are the same at all points are evaluated once, and patterns at many
//! points at a time.

use super::surface::Terms;
use super::{Surface, Surfaces};
use crate::field::{Level, Walked, compile_graph};
use crate::num::{F64x32, Lanes, Vec3};
use crate::scene::{Graph, Material, Term};
use crate::trace::{Outcomes, Verdict};
use glam::DVec3;
use std::sync::Arc;

/// How many points are evaluated at a time.
const WIDTH: usize = F64x32::WIDTH;

/// A material of a scene.
struct Swatch {
    material: Arc<Material>,
    /// The terms that differ from point to point, in the order in which a surface asks for them; none where it is the same
    /// everywhere.
    patterns: Vec<Pattern>,
}

/// A term that differs from point to point.
struct Pattern {
    walk: Walked<F64x32>,
    /// 3 for a colour, else 1.
    outputs: usize,
}

/// The materials of a scene.
pub struct Palette {
    swatches: Vec<Swatch>,
    /// Their surfaces, at the origin.
    surfaces: Vec<Surface>,
}

/// No surface.
const NONE: u32 = u32::MAX;

/// The surfaces that the rays of a wave hit.
pub struct Looks<'a> {
    palette: &'a Palette,
    /// Those that are met at single points.
    own: Vec<Surface>,
    /// For each ray the number of its surface: those of the palette first; [`NONE`] where nothing was hit.
    numbers: Vec<u32>,
}

impl Palette {
    /// The palette of these materials.
    pub fn new(materials: &[Arc<Material>]) -> Self {
        let level = Level::best();
        let mut swatches = Vec::with_capacity(materials.len());
        let mut surfaces = Vec::with_capacity(materials.len());
        for material in materials {
            let mut graphs = Graphs(Vec::new());
            surfaces.push(Surface::of_terms(material, &mut graphs));
            let pattern = |graph: Arc<Graph>| Pattern {
                walk: compile_graph(&graph, level),
                outputs: if graph.outputs() == 3 { 3 } else { 1 },
            };
            swatches.push(Swatch {
                material: material.clone(),
                patterns: graphs.0.into_iter().map(pattern).collect(),
            });
        }
        Self { swatches, surfaces }
    }

    /// The surfaces that rays with these outcomes hit.
    pub fn looks<S: Surfaces + ?Sized>(&self, surfaces: &S, outcomes: &Outcomes) -> Looks<'_> {
        let mut looks = Looks {
            palette: self,
            own: Vec::new(),
            numbers: vec![NONE; outcomes.len()],
        };
        let mut varied: Vec<(usize, u32)> = Vec::new();
        for i in 0..outcomes.len() {
            if outcomes.verdict[i] != Verdict::Hit {
                continue;
            }
            let part = outcomes.part[i];
            match surfaces.sole(part) {
                Some(number) if self.swatches[number].patterns.is_empty() => {
                    looks.numbers[i] = number as u32;
                }
                Some(number) => varied.push((number, i as u32)),
                None => {
                    let [x, y, z] = outcomes.point();
                    let surface = Surface::of(surfaces, part, DVec3::new(x[i], y[i], z[i]));
                    looks.numbers[i] = surface.map_or(NONE, |surface| looks.add(surface));
                }
            }
        }
        varied.sort_unstable();
        for same in varied.chunk_by(|(a, _), (b, _)| a == b) {
            let swatch = &self.swatches[same[0].0];
            for some in same.chunks(WIDTH) {
                looks.paint(swatch, outcomes, some);
            }
        }
        looks
    }
}

impl Looks<'_> {
    /// The surface that ray number `i` hit.
    pub fn at(&self, i: usize) -> Option<&Surface> {
        let number = self.numbers[i] as usize;
        let plain = self.palette.surfaces.get(number);
        plain.or_else(|| {
            self.own
                .get(number.wrapping_sub(self.palette.surfaces.len()))
        })
    }

    fn add(&mut self, surface: Surface) -> u32 {
        self.own.push(surface);
        (self.palette.surfaces.len() + self.own.len() - 1) as u32
    }

    /// Gives these rays, at most [`WIDTH`], their surfaces, all of one material with patterns.
    fn paint(&mut self, swatch: &Swatch, outcomes: &Outcomes, rays: &[(usize, u32)]) {
        let axis = |axis: usize| {
            let column = outcomes.point()[axis];
            // Lanes without a ray repeat the first.
            Lanes::from_fn(|lane| column[rays.get(lane).unwrap_or(&rays[0]).1 as usize])
        };
        let points = Vec3::new(axis(0), axis(1), axis(2));
        let value = |pattern: &Pattern| {
            let mut value = [Lanes([0.0; WIDTH]); 3];
            (pattern.walk)(&points, &mut value[..pattern.outputs]);
            if pattern.outputs == 1 {
                // A pattern with one output gives a grey.
                (value[1], value[2]) = (value[0], value[0]);
            }
            value
        };
        let values: Vec<[F64x32; 3]> = swatch.patterns.iter().map(value).collect();
        for (lane, (_, ray)) in rays.iter().enumerate() {
            let mut known = Known {
                values: values.iter(),
                lane,
            };
            let surface = Surface::of_terms(&swatch.material, &mut known);
            self.numbers[*ray as usize] = self.add(surface);
        }
    }
}

/// Collects the patterns of a material; their values don't matter.
struct Graphs(Vec<Arc<Graph>>);

impl Graphs {
    fn value<T: Copy>(&mut self, term: &Term<T>, nothing: T) -> T {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(graph) => {
                self.0.push(graph.clone());
                nothing
            }
        }
    }
}

impl Terms for Graphs {
    fn number(&mut self, term: &Term<f64>) -> f64 {
        self.value(term, 0.0)
    }

    fn color(&mut self, term: &Term<DVec3>) -> DVec3 {
        self.value(term, DVec3::ZERO)
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
    fn number(&mut self, term: &Term<f64>) -> f64 {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(_) => self.next().x,
        }
    }

    fn color(&mut self, term: &Term<DVec3>) -> DVec3 {
        match term {
            Term::Constant(value) => *value,
            Term::Pattern(_) => self.next(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::random;
    use crate::scene::GraphBuilder;
    use crate::trace::{Occlusion, Outcome, Paint, Rays, Visibility};

    /// Materials alone: part number `i` has material number `i`.
    struct Samples(Vec<Arc<Material>>);

    impl Surfaces for Samples {
        fn nearest(&self, rays: &Rays, _: Visibility) -> Outcomes {
            Outcomes::nothing(rays.len())
        }

        fn occluded(&self, _: &Rays) -> Vec<Occlusion> {
            Vec::new()
        }

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
                color: Term::Pattern(pattern(9, 1)),
                shininess: number(31),
                absorb: Term::Pattern(pattern(32, 3)),
                ..Material::default()
            }),
        ]);
        let outcome = |i: u64| Outcome {
            verdict: if i % 5 == 4 {
                Verdict::Miss
            } else {
                Verdict::Hit
            },
            part: (i % 3) as u32,
            point: DVec3::from_array([0, 1, 2].map(|k| 4.0 * random(100 + 3 * i + k) - 2.0)),
            ..Outcome::NOTHING
        };
        let outcomes: Outcomes = (0..200).map(outcome).collect();
        let palette = Palette::new(&materials.0);
        let looks = palette.looks(&materials, &outcomes);
        for (i, outcome) in outcomes.iter().enumerate() {
            let material = &materials.0[outcome.part as usize];
            let expected = Surface::new(material, outcome.point.to_array());
            let is_hit = outcome.verdict == Verdict::Hit;
            assert_eq!(looks.at(i).copied(), is_hit.then_some(expected));
        }
    }
}
