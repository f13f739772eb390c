//! The world: a scene that is ready to be traced.

use super::analytic::{ClosedForm, Crossing};
use super::beam::Beam;
use super::bundle::{Bundle, WIDTH};
use super::descent::Meets;
use super::finding::Finding;
use super::hierarchy::{Boxes, Hierarchy, clip, stretch};
use super::join::joined;
use super::march::{Job, Walked, march};
use super::method::{
    AutoRelaxed, Bisection, Certified, Convex, Demands, Ending, Enhanced, IntervalAnalysis,
    Probing, Reference, Relaxed, Segment, SegmentTracing, SphereTracing,
};
use super::part::{Marched, Part, PartKind, flatten};
use super::survey::{resolved, survey};
use super::sweep::Question;
use super::{Occlusion, Occlusions, Outcome, Outcomes, Ray, RayColumns, Rays, Verdict};
use crate::catalogue::Bounds;
use crate::field::{Brush, Level, Share, normal, run_at, shares};
use crate::num::Rows;
use crate::scene::{Fault, Material, Method, Node, Scene, Settings, Shadow};
use glam::DVec3;
use std::array;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

/// Which parts of the world a ray can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// All of them.
    All,
    /// Those that cast shadows, opaque or tinted.
    Casting,
}

/// A material that a surface point shows, with its share.
#[derive(Clone, Copy, Debug)]
pub struct Paint<'a> {
    /// The material.
    pub material: &'a Arc<Material>,
    /// Its share; the shares of a point sum to 1.
    pub weight: f64,
    /// The point in the coordinates of the shape that was painted, for patterns.
    pub point: [f64; 3],
}

/// A scene that is ready to be traced.
pub struct World {
    pub(super) parts: Vec<Part>,
    pub(super) hierarchy: Hierarchy,
    /// Parts without finite bounds.
    pub(super) endless: Vec<u32>,
    materials: Vec<Arc<Material>>,
    /// For each part what [`World::sole`] says.
    sole: Vec<Option<u32>>,
    default: Arc<Material>,
    /// Of parts with several materials, those that were asked for theirs.
    brushes: Mutex<BTreeMap<u32, Arc<Brush>>>,
    pub(super) settings: Settings,
    /// How far a ray without end is followed through shapes without end.
    pub(super) horizon: f64,
    /// Whether any part is a combination that is thinned out.
    pub(super) is_thinned: bool,
    /// Whether rays are spared what their beam or cone misses: not by what is to judge the others, nor where nothing is to be
    /// passed over.
    pub(super) prunes: bool,
    /// The instructions that lanes use.
    pub(super) level: Level,
}

/// A ray while it is traced by a method that asks fields alone.
struct Search {
    finding: Finding,
    /// Parts to be marched, the nearest last.
    candidates: Vec<(f64, u32)>,
}

/// Whether a shape has its paint from the outside alone.
fn is_painted_whole(node: &Node) -> bool {
    fn is_bare(node: &Node) -> bool {
        node.paint().is_none() && node.children().iter().all(|child| is_bare(child))
    }
    node.paint().is_some() && node.children().iter().all(|child| is_bare(child))
}

impl World {
    /// The world of everything that `scene` shows.
    ///
    /// # Errors
    /// If a shape has no finite Lipschitz constant; the fault names it and the way out.
    pub fn new(scene: &Scene) -> Result<Self, Fault> {
        Self::of(&scene.shown, &scene.settings)
    }

    /// The world of these shapes.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn of(shown: &[Arc<Node>], settings: &Settings) -> Result<Self, Fault> {
        let level = Level::best();
        let demands = Demands::of(settings.method);
        let parts = joined(shown.iter().flat_map(flatten).collect())
            .into_iter()
            .map(|node| Part::new(node, demands, level))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self::of_parts(parts, *settings, level))
    }

    pub(super) fn of_parts(parts: Vec<Part>, settings: Settings, level: Level) -> Self {
        let numbered = || {
            parts
                .iter()
                .enumerate()
                .map(|(i, part)| (i as u32, part.bounds))
        };
        let boxes: Vec<_> = numbered().filter(|(_, b)| b.is_finite()).collect();
        let endless = numbered()
            .filter(|(_, b)| !b.is_finite())
            .map(|(i, _)| i)
            .collect();
        let reach = boxes.iter().map(|(_, b)| b.radius()).fold(0.0, f64::max);
        let default = Arc::new(Material::default());
        let mut materials: Vec<Arc<Material>> = Vec::new();
        let mut numbers: BTreeMap<*const Material, u32> = BTreeMap::new();
        let mut sole = Vec::with_capacity(parts.len());
        for part in &parts {
            let mut number = None;
            for material in &part.materials {
                let material = material.as_ref().unwrap_or(&default);
                number = Some(*numbers.entry(Arc::as_ptr(material)).or_insert_with(|| {
                    materials.push(material.clone());
                    materials.len() as u32 - 1
                }));
            }
            let is_sole = |n: &u32| {
                let is_same = !materials[*n as usize].has_patterns();
                part.materials.len() == 1 && (is_same || is_painted_whole(&part.node))
            };
            sole.push(number.filter(is_sole));
        }
        Self {
            hierarchy: Hierarchy::new(&boxes),
            endless,
            materials,
            sole,
            default,
            brushes: Mutex::default(),
            settings,
            horizon: reach,
            is_thinned: parts.iter().any(Part::is_thinned),
            prunes: settings.method != Method::Reference,
            level,
            parts,
        }
    }

    /// The first surface on each ray.
    pub fn nearest(&self, rays: &[Ray], visibility: Visibility) -> Vec<Outcome> {
        self.trace(&rays.iter().collect(), visibility)
            .iter()
            .collect()
    }

    /// As [`World::nearest`], for rays side by side.
    pub fn trace(&self, rays: &Rays, visibility: Visibility) -> Outcomes {
        let mut found = Outcomes::default();
        self.trace_into(rays, visibility, &mut found);
        found
    }

    /// As [`World::trace`]; what was in `found` before is forgotten.
    pub fn trace_into(&self, rays: &Rays, visibility: Visibility, found: &mut Outcomes) {
        let is_seen = |part: &Part| visibility == Visibility::All || part.shadow != Shadow::None;
        if self.settings.method == Method::Auto {
            found.resize(rays.len());
            let question = Question {
                is_seen: &is_seen,
                any: false,
            };
            let mut open = Vec::new();
            let mut all: Vec<u32> = (0..rays.len() as u32).collect();
            let some = (&rays.columns(), &mut all[..]);
            self.sweep(some, &question, &mut |bundle, numbers| {
                self.conclude(rays, bundle, numbers, (found, &mut open));
            });
            return;
        }
        let rays: Vec<Ray> = rays.iter().collect();
        let searches = self.search(&rays, &is_seen, false);
        let outcomes = rays.iter().zip(&searches).map(|(ray, search)| {
            let outcome = search.finding.outcome(ray);
            let is_hit = outcome.verdict == Verdict::Hit;
            let normal = if is_hit {
                self.normal(&outcome, ray)
            } else {
                outcome.normal
            };
            Outcome { normal, ..outcome }
        });
        *found = outcomes.collect();
    }

    /// Whether one of the rays of a beam, however far it is followed, may meet anything. Where it says no, none does; the
    /// reference never does.
    pub fn may_meet(&self, beam: &Beam) -> bool {
        if !self.prunes {
            return true;
        }
        let hierarchy = &self.hierarchy;
        self.endless_met(beam).next().is_some() || run_at(self.level, Meets { hierarchy, beam })
    }

    /// A box around the only part there is, if it is a convex solid; none for methods whose hits are only near a surface, so that
    /// what they find on it may be in its own way.
    pub fn lone_convex(&self) -> Option<Bounds> {
        let [part] = &self.parts[..] else {
            return None;
        };
        let traits = part.node.traits();
        let is_solid = traits.is_convex && !traits.is_sheet;
        (is_solid && self.settings.method == Method::Auto).then_some(part.bounds)
    }

    /// The parts without an end that one of the rays of a beam may meet.
    pub(super) fn endless_met(&self, beam: &Beam) -> impl Iterator<Item = u32> {
        let may_meet = |number: &u32| match &self.parts[*number as usize].kind {
            PartKind::HalfSpace(half) if self.prunes => beam.may_meet(half),
            _ => true,
        };
        self.endless.iter().copied().filter(may_meet)
    }

    /// Whether any opaque surface lies on each ray; parts whose shadow is tinted or none are passed over.
    pub fn occluded(&self, rays: &[Ray]) -> Vec<Occlusion> {
        let mut found = Occlusions::default();
        let rays: Rays = rays.iter().collect();
        let all: Vec<u32> = (0..rays.len() as u32).collect();
        self.occlusions_into(&rays.columns(), &all, &mut found);
        found.iter().collect()
    }

    /// As [`World::occluded`], for the rays with these numbers of some columns, each number larger than the one before; nothing is
    /// said to be in the way of the others. What was in `found` before is forgotten.
    ///
    /// # Panics
    /// If a column is too short.
    pub fn occlusions_into(&self, rays: &RayColumns, numbers: &[u32], found: &mut Occlusions) {
        let count = rays[0].len();
        if numbers.len() < count {
            found.reset(count);
        } else {
            found.resize(count);
        }
        if self.settings.method == Method::Auto {
            let question = Question {
                is_seen: &|part: &Part| part.shadow == Shadow::Opaque,
                any: true,
            };
            let mut some = numbers.to_vec();
            self.sweep((rays, &mut some), &question, &mut |bundle, numbers| {
                if bundle.is_blank() {
                    return found.miss(numbers);
                }
                let verdicts = bundle.blocked(self.level);
                let rows = Rows::in_order(numbers);
                rows.put(&mut found.verdict, &verdicts);
                rows.put(&mut found.steps, &bundle.steps);
                rows.put(&mut found.evaluations, &bundle.evaluations);
            });
            return;
        }
        let rays: Vec<Ray> = Rays::picked(*rays, numbers).iter().collect();
        let searches = self.search(&rays, &|part: &Part| part.shadow == Shadow::Opaque, true);
        let occlusions = searches.iter().map(|search| search.finding.occlusion());
        found.put(numbers, occlusions);
    }

    /// The same world with every Lipschitz constant that methods take steps by times a factor. Below 1, that is no bound any
    /// more: for studies of what a wrong one does.
    pub fn with_constants_times(mut self, factor: f64) -> Self {
        for part in &mut self.parts {
            if let PartKind::Marched(marched) = &mut part.kind {
                marched.lipschitz *= factor;
                let thicket = marched.thicket.take();
                marched.thicket = thicket.map(|t| t.with_constants_times(factor));
            }
        }
        self
    }

    /// The materials at a point of the surface of `part`, one or more.
    pub fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>> {
        let shares = shares(&self.parts[part as usize].node, point.to_array());
        shares.iter().map(|share| self.paint(share)).collect()
    }

    /// Gives `each` the materials at these points of the surface of `part`, with their numbers: as [`World::paints`].
    pub fn paints_at(
        &self,
        part: u32,
        points: &[[f64; 3]],
        each: &mut dyn FnMut(usize, &[Paint<'_>]),
    ) {
        let node = &self.parts[part as usize].node;
        let brush = {
            let mut brushes = self.brushes.lock().unwrap_or_else(PoisonError::into_inner);
            let new = || Arc::new(Brush::new(node, self.level));
            brushes.entry(part).or_insert_with(new).clone()
        };
        let mut paints = Vec::new();
        for (k, some) in points.chunks(WIDTH).enumerate() {
            brush.shares(node, some, |lane, shares| {
                paints.clear();
                paints.extend(shares.iter().map(|share| self.paint(share)));
                each(WIDTH * k + lane, &paints);
            });
        }
    }

    fn paint<'a>(&'a self, share: &Share<'a>) -> Paint<'a> {
        Paint {
            material: share.material.unwrap_or(&self.default),
            weight: share.weight,
            point: share.point,
        }
    }

    /// The number in [`World::materials`] of the material of `part`, if that is its only one and is the same at all of its
    /// points, or was painted on in the coordinates of the scene.
    pub fn sole(&self, part: u32) -> Option<usize> {
        self.sole[part as usize].map(|number| number as usize)
    }

    /// Every material that some part shows.
    pub fn materials(&self) -> &[Arc<Material>] {
        &self.materials
    }

    /// How many parts there are.
    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    /// How many of them have no finite bounds.
    pub fn endless_parts(&self) -> usize {
        self.endless.len()
    }

    /// Whether rays are spared what their beam misses.
    pub fn prunes(&self) -> bool {
        self.prunes && self.settings.method == Method::Auto
    }

    /// How rays find each part, in words: its own path where the method has several, else the method's name.
    pub fn paths(&self) -> impl Iterator<Item = (&'static str, &Arc<Node>)> {
        let method = self.settings.method;
        self.parts.iter().map(move |part| match method {
            Method::Auto | Method::Convex => (part.kind.word(), &part.node),
            _ => (method.name(), &part.node),
        })
    }

    /// Marches rays through the parts that they meet, part by part, nearest first, by the methods that ask fields alone. With
    /// `any`, a ray is content with the first hit.
    fn search(&self, rays: &[Ray], is_seen: &dyn Fn(&Part) -> bool, any: bool) -> Vec<Search> {
        let mut searches: Vec<Search> = rays.iter().map(|ray| self.begin(ray, is_seen)).collect();
        loop {
            let mut jobs: BTreeMap<u32, Vec<Job>> = BTreeMap::new();
            for (number, (ray, search)) in rays.iter().zip(&mut searches).enumerate() {
                if let Some((part, segment)) = self.next_walk(ray, search, any) {
                    jobs.entry(part).or_default().push(Job {
                        ray: number as u32,
                        segment,
                    });
                }
            }
            if jobs.is_empty() {
                return searches;
            }
            for (part, jobs) in jobs {
                for walked in self.walk(part, rays, &jobs) {
                    let search = &mut searches[walked.ray as usize];
                    let Ending {
                        verdict,
                        t,
                        error,
                        steps,
                    } = walked.ending;
                    search.finding.steps += steps;
                    search.finding.evaluations += walked.evaluations;
                    match verdict {
                        Verdict::Hit => {
                            search.finding.offer(Crossing { t, error }, part);
                        }
                        Verdict::Miss => {}
                        Verdict::Unknown => search.finding.doubt(t),
                    }
                }
            }
        }
    }

    /// The parts that a ray has to be marched through.
    fn begin(&self, ray: &Ray, is_seen: &dyn Fn(&Part) -> bool) -> Search {
        let mut candidates: Vec<(f64, u32)> = self.endless.iter().map(|n| (0.0, *n)).collect();
        let inverse = ray.direction.recip();
        let enters = |boxes: &Boxes| {
            let enter = |k| clip(ray.origin, inverse, &boxes.at(k), ray.t_max);
            array::from_fn(|k| enter(k).map_or(f64::INFINITY, |(enter, _)| enter))
        };
        self.hierarchy.visit(enters, |number, enter| {
            candidates.push((enter, number));
            ControlFlow::Continue(())
        });
        candidates.retain(|(_, number)| is_seen(&self.parts[*number as usize]));
        candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        Search {
            finding: Finding::NOTHING,
            candidates,
        }
    }

    /// The next part that a ray has to be marched through, and where.
    fn next_walk(&self, ray: &Ray, search: &mut Search, any: bool) -> Option<(u32, Segment)> {
        if any && search.finding.is_hit() {
            return None;
        }
        let limit = search.finding.limit(ray.t_max);
        while let Some((_, number)) = search.candidates.pop() {
            let PartKind::Marched(part) = &self.parts[number as usize].kind else {
                continue;
            };
            if let Some((start, end)) = clip(ray.origin, ray.direction.recip(), &part.region, limit)
            {
                return Some((number, self.segment(ray, part, start, end)));
            }
        }
        None
    }

    /// How far a part reaches from the origin, as far as that is known.
    pub(super) fn reach(&self, part: &Marched) -> f64 {
        if part.is_endless() {
            self.horizon.max(part.size)
        } else {
            part.size
        }
    }

    fn segment(&self, ray: &Ray, part: &Marched, start: f64, end: f64) -> Segment {
        let origin = ray.origin.abs().max_element();
        let (start, end) = stretch(origin, start, end, ray.t_max);
        Segment {
            start,
            end,
            lipschitz: part.lipschitz,
            footprint: ray.footprint,
            tolerance: self.settings.tolerance,
            max_steps: self.settings.max_steps,
            size: origin + self.reach(part),
            is_sheet: part.is_sheet,
            is_endless: part.is_endless(),
            omega: self.settings.omega,
        }
    }

    /// Walks jobs through one part by the method of the settings.
    fn walk(&self, part: u32, rays: &[Ray], jobs: &[Job]) -> Vec<Walked> {
        let PartKind::Marched(marched) = &self.parts[part as usize].kind else {
            return Vec::new();
        };
        match self.settings.method {
            Method::Auto | Method::Convex if marched.slope.is_some() => {
                let walked = march::<Convex>(marched, rays, jobs);
                resolved(marched, rays, jobs, walked)
            }
            Method::Auto | Method::Convex | Method::Certified => {
                let walked = march::<Certified>(marched, rays, jobs);
                resolved(marched, rays, jobs, walked)
            }
            Method::Sphere => march::<SphereTracing>(marched, rays, jobs),
            Method::Relaxed => march::<Relaxed>(marched, rays, jobs),
            Method::AutoRelaxed => march::<AutoRelaxed>(marched, rays, jobs),
            Method::Enhanced => march::<Enhanced>(marched, rays, jobs),
            Method::Segment => survey::<SegmentTracing>(marched, rays, jobs),
            Method::Bisect => march::<Bisection>(marched, rays, jobs),
            Method::Interval => survey::<IntervalAnalysis>(marched, rays, jobs),
            Method::Probe => {
                let walked = survey::<Probing>(marched, rays, jobs);
                resolved(marched, rays, jobs, walked)
            }
            Method::Reference => survey::<Reference>(marched, rays, jobs),
        }
    }

    /// Puts down what the rays of a bundle, with these numbers, found. Their normals are the directions of the gradients at
    /// their hits, where these are known and not zero.
    fn conclude(
        &self,
        rays: &Rays,
        bundle: &mut Bundle,
        numbers: &[u32],
        (outcomes, open): (&mut Outcomes, &mut Vec<u32>),
    ) {
        if bundle.is_blank() {
            return outcomes.miss(numbers);
        }
        let verdicts = bundle.conclude(self.level);
        for k in 0..bundle.winners.len() {
            let number = bundle.winners[k];
            match &self.parts[number as usize].kind {
                PartKind::Ball(ball) => bundle.turn(ball, number, self.level),
                PartKind::HalfSpace(plane) => bundle.turn(plane, number, self.level),
                PartKind::Block(block) => bundle.turn(block, number, self.level),
                PartKind::Facet(facet) => bundle.turn(facet, number, self.level),
                PartKind::Pane(pane) => bundle.turn(&**pane, number, self.level),
                // Their normals are found with the hits.
                PartKind::Ring(..) | PartKind::Marched(_) => {}
            }
        }
        let rows = Rows::in_order(numbers);
        rows.put(&mut outcomes.verdict, &verdicts);
        rows.put(&mut outcomes.part, &bundle.hit);
        rows.put(&mut outcomes.steps, &bundle.steps);
        rows.put(&mut outcomes.evaluations, &bundle.evaluations);
        let [t, error, point @ .., x, y, z] = outcomes.columns_mut();
        rows.put(t, &bundle.enter);
        rows.put(error, &bundle.leave);
        for (column, axis) in [x, y, z].into_iter().zip(&bundle.gradient) {
            rows.put(column, axis);
        }
        for (column, axis) in point.into_iter().zip(&bundle.point) {
            rows.put(column, axis);
        }
        bundle.meeting(open);
        for i in open {
            let number = numbers[*i as usize] as usize;
            let normal = self.normal(&outcomes.at(number), &rays.at(number));
            let [.., x, y, z] = outcomes.columns_mut();
            [x[number], y[number], z[number]] = normal.to_array();
        }
    }

    /// The normal of the part that `ray` hit.
    fn normal(&self, hit: &Outcome, ray: &Ray) -> DVec3 {
        match &self.parts[hit.part as usize].kind {
            PartKind::Marched(marched) => {
                let pixel = self.settings.tolerance * ray.footprint.at(hit.t);
                let back = hit.error.max(pixel);
                normal(marched.gradient(), hit.point, ray.direction, back)
            }
            PartKind::Ball(ball) => ball.outward(hit.point),
            PartKind::HalfSpace(plane) => plane.normal,
            PartKind::Block(block) => block.normal(hit.point, ray.direction),
            PartKind::Facet(facet) => facet.normal,
            PartKind::Pane(pane) => pane.normal(hit.point, ray.direction),
            PartKind::Ring(ring, _) => ring.normal(hit.point),
        }
    }
}
