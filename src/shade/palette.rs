//! What the surfaces of a scene look like: materials that are the same at all points are evaluated once, and colours that
//! are patterns at many points at a time.

use super::{Surface, Surfaces};
use crate::field::{Level, Walked, compile_graph};
use crate::num::{F64x32, Lanes, Vec3};
use crate::scene::{Material, Term};
use crate::trace::{Outcomes, Verdict};
use glam::DVec3;
use std::sync::Arc;

/// How many points are evaluated at a time.
const WIDTH: usize = F64x32::WIDTH;

/// A material, as far as it is known beforehand.
enum Swatch {
    /// The same at all points.
    Plain,
    /// The same at all points but for its colour: the walk over its pattern, and how many outputs it has.
    Colored(Walked<F64x32>, usize),
    /// Different from point to point.
    Varied,
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
}

impl Palette {
    /// The palette of these materials.
    pub fn new(materials: &[Arc<Material>]) -> Self {
        let level = Level::best();
        let surface = |material| Surface::new(material, [0.0; 3]);
        Self {
            swatches: materials.iter().map(|m| swatch(m, level)).collect(),
            surfaces: materials.iter().map(surface).collect(),
        }
    }

    /// The surfaces that rays with these outcomes hit.
    pub fn looks<S: Surfaces + ?Sized>(&self, surfaces: &S, outcomes: &Outcomes) -> Looks<'_> {
        let mut looks = Looks {
            palette: self,
            own: Vec::new(),
            numbers: vec![NONE; outcomes.len()],
        };
        let mut colored: Vec<(usize, u32)> = Vec::new();
        for i in 0..outcomes.len() {
            if outcomes.verdict[i] != Verdict::Hit {
                continue;
            }
            let part = outcomes.part[i];
            let sole = surfaces.sole(part);
            match sole.map(|number| (number, &self.swatches[number])) {
                Some((number, Swatch::Plain)) => looks.numbers[i] = number as u32,
                Some((number, Swatch::Colored(..))) => colored.push((number, i as u32)),
                Some((_, Swatch::Varied)) | None => {
                    let [x, y, z] = outcomes.point();
                    let surface = Surface::of(surfaces, part, DVec3::new(x[i], y[i], z[i]));
                    if let Some(surface) = surface {
                        looks.numbers[i] = looks.add(surface);
                    }
                }
            }
        }
        colored.sort_unstable();
        for same in colored.chunk_by(|(a, _), (b, _)| a == b) {
            let number = same[0].0;
            if let Swatch::Colored(walk, outputs) = &self.swatches[number] {
                for some in same.chunks(WIDTH) {
                    looks.color(&self.surfaces[number], (walk, *outputs), outcomes, some);
                }
            }
        }
        looks
    }
}

impl Looks<'_> {
    fn add(&mut self, surface: Surface) -> u32 {
        self.own.push(surface);
        (self.palette.surfaces.len() + self.own.len() - 1) as u32
    }

    /// Gives these rays, at most [`WIDTH`], the surface with the colours of a pattern.
    fn color(
        &mut self,
        surface: &Surface,
        (walk, outputs): (&Walked<F64x32>, usize),
        outcomes: &Outcomes,
        rays: &[(usize, u32)],
    ) {
        let axis = |axis: usize| {
            let column = outcomes.point()[axis];
            // Lanes without a ray repeat the first.
            Lanes::from_fn(|lane| column[rays.get(lane).unwrap_or(&rays[0]).1 as usize])
        };
        let mut color = [Lanes([0.0; WIDTH]); 3];
        walk(&Vec3::new(axis(0), axis(1), axis(2)), &mut color[..outputs]);
        for (lane, (_, ray)) in rays.iter().enumerate() {
            let channel = |k: usize| color[k.min(outputs - 1)].0[lane];
            let color = DVec3::new(channel(0), channel(1), channel(2));
            self.numbers[*ray as usize] = self.add(Surface { color, ..*surface });
        }
    }
}

fn swatch(material: &Arc<Material>, level: Level) -> Swatch {
    if !material.has_patterns() {
        return Swatch::Plain;
    }
    let Term::Pattern(graph) = &material.color else {
        return Swatch::Varied;
    };
    let otherwise = Material {
        color: Term::Constant(DVec3::ZERO),
        ..Material::clone(material)
    };
    let outputs = if graph.outputs() == 3 { 3 } else { 1 };
    if otherwise.has_patterns() {
        Swatch::Varied
    } else {
        Swatch::Colored(compile_graph(graph, level), outputs)
    }
}
