//! Rays and what they found, side by side in columns, so that lanes work on many of them.

use super::{Footprint, Occlusion, Outcome, Ray, Verdict};
use crate::num::{Columns, Rows};
use glam::DVec3;

/// Rays side by side: the numbers of [`Ray`], in columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rays(Columns<{ Rays::COLUMNS }>);

/// The columns of [`Rays`], wherever they are.
pub type RayColumns<'a> = [&'a [f64]; Rays::COLUMNS];

impl Rays {
    /// How many columns there are: origins and directions by axis, how far the rays are followed, the widths of their
    /// pixels at the origins, and by how much these grow with each scene unit.
    pub const COLUMNS: usize = 9;

    /// None yet, with room for as many.
    pub fn with_capacity(count: usize) -> Self {
        Self(Columns::with_capacity(count))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where they start, by axis.
    #[inline(always)]
    pub fn origin(&self) -> [&[f64]; 3] {
        [0, 1, 2].map(|k| self.0.column(k))
    }

    /// Where they go, each of length 1, by axis.
    #[inline(always)]
    pub fn direction(&self) -> [&[f64]; 3] {
        [3, 4, 5].map(|k| self.0.column(k))
    }

    /// How far they are followed, in scene units; may be infinite.
    pub fn t_max_mut(&mut self) -> &mut [f64] {
        self.0.column_mut(6)
    }

    /// How wide the pixels are: at the origins, and by how much that grows, in scene units.
    #[inline(always)]
    pub fn footprint(&self) -> [&[f64]; 2] {
        [7, 8].map(|k| self.0.column(k))
    }

    /// All columns up to whole lanes, as [`Columns::lanes`].
    #[inline(always)]
    pub fn lanes(&self) -> [&[f64]; Self::COLUMNS] {
        self.0.lanes()
    }

    /// Ray number `i`.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn at(&self, i: usize) -> Ray {
        let [a, b, c, d, e, f, t_max, at_origin, spread] = self.0.row(i);
        Ray {
            origin: DVec3::new(a, b, c),
            direction: DVec3::new(d, e, f),
            t_max,
            footprint: Footprint { at_origin, spread },
        }
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = Ray> {
        (0..self.len()).map(|i| self.at(i))
    }

    /// Adds a ray.
    pub fn push(&mut self, ray: &Ray) {
        let (o, d, footprint) = (ray.origin, ray.direction, ray.footprint);
        let widths = [footprint.at_origin, footprint.spread];
        self.0.push([
            o.x, o.y, o.z, d.x, d.y, d.z, ray.t_max, widths[0], widths[1],
        ]);
    }

    /// Adds rays of other columns, by number.
    ///
    /// # Panics
    /// If a column is too short.
    pub fn pick(&mut self, columns: RayColumns, numbers: &[u32]) {
        self.0.pick(columns, numbers);
    }

    /// Adds the rays of other columns.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn append(&mut self, columns: RayColumns) {
        self.0.append(columns);
    }

    /// Makes it so many, of whatever was there.
    pub fn resize(&mut self, count: usize) {
        self.0.resize(count);
    }

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.resize(0);
    }

    /// The rays with these numbers of some columns.
    ///
    /// # Panics
    /// If a column is too short.
    pub fn picked(columns: RayColumns, numbers: &[u32]) -> Self {
        let mut rays = Self::with_capacity(numbers.len());
        rays.pick(columns, numbers);
        rays
    }

    /// All columns.
    pub fn columns(&self) -> RayColumns<'_> {
        self.0.columns()
    }

    /// All columns, to be written.
    pub fn columns_mut(&mut self) -> [&mut [f64]; Self::COLUMNS] {
        self.0.columns_mut()
    }
}

impl<'a> FromIterator<&'a Ray> for Rays {
    fn from_iter<I: IntoIterator<Item = &'a Ray>>(rays: I) -> Self {
        let mut all = Self::default();
        rays.into_iter().for_each(|ray| all.push(ray));
        all
    }
}

impl FromIterator<Ray> for Rays {
    fn from_iter<I: IntoIterator<Item = Ray>>(rays: I) -> Self {
        let mut all = Self::default();
        rays.into_iter().for_each(|ray| all.push(&ray));
        all
    }
}

/// What rays found, side by side: the numbers of [`Outcome`], in columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcomes {
    /// How certain they are.
    pub verdict: Vec<Verdict>,
    /// The parts that were hit, by number.
    pub part: Vec<u32>,
    /// How many steps were taken.
    pub steps: Vec<u32>,
    /// How many times a field was evaluated.
    pub evaluations: Vec<u32>,
    /// Distances, errors, places and normals.
    numbers: Columns<8>,
}

/// The distance, error, place and normal of [`Outcome::NOTHING`].
const NOWHERE: [f64; 8] = {
    let Outcome {
        t,
        error,
        point: p,
        normal: n,
        ..
    } = Outcome::NOTHING;
    [t, error, p.x, p.y, p.z, n.x, n.y, n.z]
};

impl Outcomes {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.verdict.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.verdict.is_empty()
    }

    /// The distances along the rays.
    #[inline(always)]
    pub fn t(&self) -> &[f64] {
        self.numbers.column(0)
    }

    /// Bounds of their errors.
    #[inline(always)]
    pub fn error(&self) -> &[f64] {
        self.numbers.column(1)
    }

    /// Where they hit, by axis.
    #[inline(always)]
    pub fn point(&self) -> [&[f64]; 3] {
        [2, 3, 4].map(|k| self.numbers.column(k))
    }

    /// The outward unit normals, by axis.
    #[inline(always)]
    pub fn normal(&self) -> [&[f64]; 3] {
        [5, 6, 7].map(|k| self.numbers.column(k))
    }

    /// Distances, their errors, places and normals up to whole lanes, as [`Columns::lanes`].
    #[inline(always)]
    pub fn lanes(&self) -> [&[f64]; 8] {
        self.numbers.lanes()
    }

    /// Makes it so many, of whatever was there.
    pub(super) fn resize(&mut self, count: usize) {
        let nothing = Outcome::NOTHING;
        self.verdict.resize(count, nothing.verdict);
        self.part.resize(count, nothing.part);
        self.steps.resize(count, nothing.steps);
        self.evaluations.resize(count, nothing.evaluations);
        self.numbers.resize(count);
    }

    /// Makes it what that many rays find that meet nothing.
    pub fn nothing(&mut self, count: usize) {
        let Self {
            verdict,
            part,
            steps,
            evaluations,
            ..
        } = self;
        verdict.clear();
        for counts in [part, steps, evaluations] {
            counts.clear();
        }
        self.resize(count);
        for (column, number) in self.numbers.columns_mut().into_iter().zip(NOWHERE) {
            column.fill(number);
        }
    }

    /// Says that these rays meet nothing.
    pub(super) fn miss(&mut self, rays: &[u32]) {
        let (rows, nothing) = (Rows::in_order(rays), Outcome::NOTHING);
        rows.fill(&mut self.verdict, nothing.verdict);
        rows.fill(&mut self.part, nothing.part);
        rows.fill(&mut self.steps, nothing.steps);
        rows.fill(&mut self.evaluations, nothing.evaluations);
        for (column, number) in self.numbers.columns_mut().into_iter().zip(NOWHERE) {
            rows.fill(column, number);
        }
    }

    /// Distances, errors, places and normals, to be written.
    pub(super) fn columns_mut(&mut self) -> [&mut [f64]; 8] {
        self.numbers.columns_mut()
    }

    /// What ray number `i` found.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn at(&self, i: usize) -> Outcome {
        let [t, error, a, b, c, d, e, f] = self.numbers.row(i);
        Outcome {
            verdict: self.verdict[i],
            t,
            error,
            point: DVec3::new(a, b, c),
            normal: DVec3::new(d, e, f),
            part: self.part[i],
            steps: self.steps[i],
            evaluations: self.evaluations[i],
        }
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = Outcome> {
        (0..self.len()).map(|i| self.at(i))
    }
}

impl FromIterator<Outcome> for Outcomes {
    fn from_iter<I: IntoIterator<Item = Outcome>>(outcomes: I) -> Self {
        let mut all = Self::default();
        for outcome in outcomes {
            let (p, n) = (outcome.point, outcome.normal);
            let row = [outcome.t, outcome.error, p.x, p.y, p.z, n.x, n.y, n.z];
            all.numbers.push(row);
            all.verdict.push(outcome.verdict);
            all.part.push(outcome.part);
            all.steps.push(outcome.steps);
            all.evaluations.push(outcome.evaluations);
        }
        all
    }
}

/// What shadow rays found, side by side: the numbers of [`Occlusion`], in columns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Occlusions {
    /// `Hit` where something lies between, `Miss` where nothing does.
    pub verdict: Vec<Verdict>,
    /// How many steps were taken.
    pub steps: Vec<u32>,
    /// How many times a field was evaluated.
    pub evaluations: Vec<u32>,
}

impl Occlusions {
    /// Makes it so many, of whatever was there.
    pub(super) fn resize(&mut self, count: usize) {
        self.verdict.resize(count, Verdict::Miss);
        self.steps.resize(count, 0);
        self.evaluations.resize(count, 0);
    }

    /// Makes it so many, and says that nothing is in the way of any.
    pub fn reset(&mut self, count: usize) {
        self.verdict.clear();
        self.steps.clear();
        self.evaluations.clear();
        self.resize(count);
    }

    /// Puts what single rays found at their numbers.
    pub fn put(&mut self, numbers: &[u32], occlusions: impl Iterator<Item = Occlusion>) {
        for (number, occlusion) in numbers.iter().zip(occlusions) {
            let i = *number as usize;
            self.verdict[i] = occlusion.verdict;
            self.steps[i] = occlusion.steps;
            self.evaluations[i] = occlusion.evaluations;
        }
    }

    /// Says that nothing is in the way of these rays.
    pub(super) fn miss(&mut self, rays: &[u32]) {
        let rows = Rows::in_order(rays);
        rows.fill(&mut self.verdict, Verdict::Miss);
        rows.fill(&mut self.steps, 0);
        rows.fill(&mut self.evaluations, 0);
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = Occlusion> {
        let counts = self.steps.iter().zip(&self.evaluations);
        let all = self.verdict.iter().zip(counts);
        all.map(|(verdict, (steps, evaluations))| Occlusion {
            verdict: *verdict,
            steps: *steps,
            evaluations: *evaluations,
        })
    }
}

impl FromIterator<Occlusion> for Occlusions {
    fn from_iter<I: IntoIterator<Item = Occlusion>>(occlusions: I) -> Self {
        let mut all = Self::default();
        for occlusion in occlusions {
            all.verdict.push(occlusion.verdict);
            all.steps.push(occlusion.steps);
            all.evaluations.push(occlusion.evaluations);
        }
        all
    }
}
