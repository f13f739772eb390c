//! The surfaces that the rays of a wave hit.

use super::highlight::GROUP;
use super::lighting::{BACKDROP, LIGHTING, Lighting, row};
use super::palette::Palette;
use super::{Surface, sky};
use crate::field::{Level, Task, run_at};
use crate::num::Columns;
use crate::scene::Sky;
use crate::trace::Rays;
use glam::DVec3;
use std::mem;
use std::ops::Range;

/// No surface.
pub const NONE: u32 = u32::MAX;

/// The surfaces that the rays of a wave hit.
#[derive(Default)]
pub struct Looks {
    /// Those that are met at single points.
    pub own: Vec<Surface>,
    /// For each ray the number of its surface: those of the palette first; [`NONE`] where nothing was hit.
    pub numbers: Vec<u32>,
    /// What lighting reads of them; where nothing was hit, the colour is still to be written.
    pub terms: Columns<LIGHTING>,
    /// Rays whose surfaces have patterns, with the numbers of their materials.
    pub varied: Vec<(u32, Range<u32>)>,
    /// Of which palette and which numbers the terms are that were written last, but for those of the sky and of patterns.
    written: (u64, Vec<u32>),
}

impl Looks {
    /// The surface that ray number `i` hit; but what lighting reads of it is in `terms`.
    pub fn at<'a>(&'a self, palette: &'a Palette, i: usize) -> Option<&'a Surface> {
        let number = self.numbers[i] as usize;
        let plain = palette.surface(number);
        plain.or_else(|| self.own.get(number.wrapping_sub(palette.len())))
    }

    /// The rays that hit the same surface, or nothing, as ranges, with that.
    pub fn runs<'a>(
        &'a self,
        palette: &'a Palette,
    ) -> impl Iterator<Item = (Range<usize>, Option<&'a Surface>)> {
        let mut first = 0;
        self.numbers.chunk_by(|a, b| a == b).map(move |same| {
            let range = first..first + same.len();
            first = range.end;
            (range.clone(), self.at(palette, range.start))
        })
    }

    /// Whether any of these rays hit a surface that answers light, so that shadow rays are of use.
    pub fn is_any_lit(&self, rays: Range<usize>) -> bool {
        let terms = Lighting::of(self.terms.columns().map(|column| &column[rays.clone()]));
        let [r, g, b] = terms.color;
        let mut lit = 0;
        for i in 0..rays.len() {
            let is_colored = (r[i] != 0.0) | (g[i] != 0.0) | (b[i] != 0.0);
            let is_matt = (terms.diffuse[i] != 0.0) & is_colored;
            lit += u64::from((terms.specular[i] != 0.0) | is_matt);
        }
        lit > 0
    }

    /// Writes the colours of the sky behind the rays that hit nothing.
    pub fn write_sky(&mut self, sky: &Sky, rays: &Rays, level: Level) {
        if self.numbers.contains(&NONE) {
            let looks = self;
            run_at(level, Backdrop { looks, sky, rays });
        }
    }

    /// Adds a surface that is met at a single point; gives its number.
    pub fn add(&mut self, palette: &Palette, surface: Surface) -> u32 {
        self.own.push(surface);
        (palette.len() + self.own.len() - 1) as u32
    }

    /// Writes what lighting reads of each surface. Neighbouring blocks often show the same.
    pub fn write_terms(&mut self, palette: &Palette) {
        let (of, numbers) = &mut self.written;
        let is_written = *of == palette.serial() && *numbers == self.numbers;
        if is_written && self.own.is_empty() {
            return;
        }
        *of = palette.serial();
        numbers.clear();
        if self.own.is_empty() {
            numbers.extend_from_slice(&self.numbers);
        }
        let mut terms = mem::take(&mut self.terms);
        terms.resize(self.numbers.len());
        let mut columns = terms.columns_mut();
        for (range, surface) in self.runs(palette) {
            let row = surface.map_or(BACKDROP, row);
            for (column, number) in columns.iter_mut().zip(row) {
                column[range.clone()].fill(number);
            }
        }
        self.terms = terms;
    }
}

/// Writes the sky behind the rays of a wave that hit nothing.
struct Backdrop<'a> {
    looks: &'a mut Looks,
    sky: &'a Sky,
    rays: &'a Rays,
}

impl Task for Backdrop<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let n = self.looks.numbers.len();
        let direction = self.rays.direction();
        let [r, g, b, ..] = self.looks.terms.columns_mut();
        for first in (0..n).step_by(GROUP) {
            let some = first..n.min(first + GROUP);
            let numbers = &self.looks.numbers[some.clone()];
            if numbers.iter().filter(|number| **number == NONE).count() == 0 {
                continue;
            }
            let [x, y, z] = direction.map(|column| &column[some.clone()]);
            let (r, g, b) = (&mut r[some.clone()], &mut g[some.clone()], &mut b[some]);
            for i in 0..numbers.len() {
                let light = sky::radiance(self.sky, DVec3::new(x[i], y[i], z[i]));
                let is_sky = numbers[i] == NONE;
                r[i] = if is_sky { light.x } else { r[i] };
                g[i] = if is_sky { light.y } else { g[i] };
                b[i] = if is_sky { light.z } else { b[i] };
            }
        }
    }
}
