//! The search of the method `auto`: bundle by bundle, part by part, in lanes.
//!
//! The rays of a bundle go about the same way, so a part that their beam misses is asked of none of them, and a
//! combination is thinned out ball by ball along the beam. What is left out has no say on any of the rays, so no ray's
//! result depends on the others. Which way a part is met is chosen once, in `part.rs`: in closed form, by chords, by tangents, or
//! by certified steps. Sources: Barbier et al. 2025 for thinning; Boulos, Wald and Shirley 2006 for beams.
//!
//! Guarantees: as `method/convex.rs` and `method/certified.rs`, and where these leave a ray open, `method/resolver.rs`; a marched
//! hit is enclosed to a four-millionth of epsilon, whichever way lanes came to it. What is thinned out, culled or scouted in
//! single precision changes no result.

use super::analytic::{Ball, ClosedForm, Crossing};
use super::beam::Beam;
use super::bundle::{Bundle, Enter, WIDTH};
use super::cones::{ALL, Cones, Follow, Gather, Meeting, Packets};
use super::cut::{Cut, Workshop};
use super::descent::{Descent, Step};
use super::inclines::{Derivatives, Gradient};
use super::newton::Newton;
use super::packet::{Found, Load, Muster, Packet, Proceed, Rules};
use super::part::{Marched, Part, PartKind, Spare};
use super::ring::{Near, Ring};
use super::scout::Scout;
use super::stages::{Stage, stages};
use super::stride::Stride;
use super::world::World;
use super::{RayColumns, Verdict};
use crate::catalogue::Bounds;
use crate::field::{Thinned, run_at};
use crate::num::BATCH;
use glam::DVec3;
use std::cell::Cell;
use std::ops::Range;

/// A bundle whose beam meets more parts than this is divided.
const CROWD: usize = 36;

/// Of more parts than this each is asked only of the packets that may meet it.
const SOME: usize = 4;

/// In a world of more parts than this, shadow rays are followed back from the lamp where they are looked for.
const MANY: usize = 16;

/// A bundle whose beam meets more nodes and parts than this on one level of the hierarchy is divided there.
const THRONG: usize = 64;

/// A beam that starts wider than this share of a combination is divided, so that thinning it out is of use.
const TOO_WIDE: f64 = 0.1;

/// The packet in which lanes are put together that lag behind.
const MIXED: usize = BATCH / WIDTH;

/// Scouts go where values are larger than their errors by this factor.
const SCOUTED: f64 = 4.0;

/// Lanes lag behind if no more than this go on in a packet.
const LAGGARDS: i64 = 12;

/// Memory that is used again and again.
pub(super) struct Scratch {
    bundle: Box<Bundle>,
    cones: Cones,
    /// Those of a bundle, and one more in which lanes are put together.
    packets: Vec<Box<Packet>>,
    descent: Descent,
    /// The nodes from which the halves of divided bundles go down, those of the innermost last.
    entries: Vec<u32>,
    /// Rays that are put aside while a bundle is divided.
    aside: Vec<u32>,
    rays: Vec<u32>,
    found: Vec<Found>,
    /// Where the lanes of the mixed packet come from: packets and lanes.
    homes: Vec<(usize, usize)>,
    /// Rays with hits whose gradients are still to be found.
    fresh: Vec<u32>,
    shop: Workshop,
    /// The last part that rays of a sweep hit.
    occluder: Option<u32>,
}

thread_local! {
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// Which parts count, and whether any hit will do.
pub(super) struct Question<'a> {
    /// Whether a part is seen.
    pub is_seen: &'a dyn Fn(&Part) -> bool,
    /// Whether a ray is content with any hit.
    pub any: bool,
}

/// A part, and the packets of which it is asked.
type Asked = (u32, Packets);

/// The rays of a bundle: those of some columns with these numbers, and their beam.
struct Asking<'a> {
    rays: &'a RayColumns<'a>,
    numbers: &'a [u32],
    beam: Beam,
}

/// What a part is asked.
struct Visit<'a> {
    marched: &'a Marched,
    number: u32,
    any: bool,
    rules: Rules,
}

impl World {
    /// Asks `question` of the rays with these numbers, in order; `answer` is given each bundle, with the numbers of the rays in
    /// it. Numbers come back in another order.
    pub(super) fn sweep(
        &self,
        (rays, numbers): (&RayColumns, &mut [u32]),
        question: &Question,
        answer: &mut dyn FnMut(&mut Bundle, &[u32]),
    ) {
        let scratch = SCRATCH.with(Cell::take);
        let mut scratch = scratch.unwrap_or_else(|| {
            Box::new(Scratch {
                bundle: Bundle::new(),
                cones: Cones::default(),
                packets: (0..=MIXED).map(|_| Box::default()).collect(),
                descent: Descent::default(),
                entries: Vec::new(),
                aside: Vec::new(),
                rays: Vec::new(),
                found: Vec::new(),
                homes: Vec::new(),
                fresh: Vec::new(),
                shop: Workshop::default(),
                occluder: None,
            })
        });
        scratch.occluder = None;
        scratch.entries.clear();
        scratch.entries.extend(self.hierarchy.root());
        let known = 0..scratch.entries.len();
        for numbers in numbers.chunks_mut(BATCH) {
            self.sweep_bundle(rays, numbers, known.clone(), question, &mut scratch, answer);
        }
        SCRATCH.with(|cell| cell.set(Some(scratch)));
    }

    /// The sweep of the rays with these numbers, which can meet only what lies below the `known` entries, and what has no end.
    fn sweep_bundle(
        &self,
        rays: &RayColumns,
        numbers: &mut [u32],
        known: Range<usize>,
        question: &Question,
        scratch: &mut Scratch,
        answer: &mut dyn FnMut(&mut Bundle, &[u32]),
    ) {
        scratch.bundle.fill(rays, numbers);
        let mut beam = Beam::around(&scratch.bundle, self.level);
        if self.is_thinned {
            beam = beam.tightened(&scratch.bundle, self.level);
        }
        let limit = self.farthest(scratch);
        let is_aimed = question.any && limit < f64::INFINITY && self.parts.len() > MANY;
        let back = is_aimed
            .then(|| beam.back(&scratch.bundle, self.level))
            .flatten();
        let asked = back.as_ref().unwrap_or(&beam);
        let most = if numbers.len() > 1 {
            THRONG
        } else {
            usize::MAX
        };
        let beams = (&beam, asked);
        let is_down = self.meet(beams, limit, known.clone(), most, question, scratch);
        if !is_down || self.is_crowd(&beam, numbers.len(), &scratch.descent.met) {
            let half = divide(numbers, beam.divide(self.horizon, rays), &mut scratch.aside);
            if half > 0 && half < numbers.len() {
                let (first, second) = numbers.split_at_mut(half);
                let from = scratch.entries.len();
                scratch.entries.extend(scratch.descent.nodes());
                let known = from..scratch.entries.len();
                self.sweep_bundle(rays, first, known.clone(), question, scratch, answer);
                self.sweep_bundle(rays, second, known, question, scratch, answer);
                scratch.entries.truncate(from);
                return;
            }
            if !is_down {
                self.meet(beams, limit, known, usize::MAX, question, scratch);
            }
        }
        // What blocked rays of this sweep before is asked first.
        let last = scratch.occluder.filter(|_| question.any);
        let same = |(_, number): &&mut (f64, u32)| Some(*number) == last;
        let met = &mut scratch.descent.met;
        if let Some((enter, _)) = met.iter_mut().find(same) {
            *enter = -1.0;
        }
        met.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let is_told = self.prunes && scratch.descent.met.len() > SOME;
        if is_told {
            let Scratch { cones, bundle, .. } = &mut *scratch;
            run_at(self.level, Gather { cones, bundle });
        }
        let asking = Asking {
            rays,
            numbers,
            beam,
        };
        let mut farthest = limit;
        for k in 0..scratch.descent.met.len() {
            let (enter, number) = scratch.descent.met[k];
            if enter > farthest {
                break;
            }
            let mut packets = scratch.bundle.packets();
            if is_told {
                packets &= self.meeting(number, &scratch.cones);
            }
            if packets != 0 && self.ask((number, packets), &asking, question.any, scratch) {
                farthest = self.farthest(scratch);
                scratch.occluder = Some(number);
            }
        }
        answer(&mut scratch.bundle, numbers);
    }

    /// Whether a beam of `rays` rays should be divided before it is asked of these parts.
    fn is_crowd(&self, beam: &Beam, rays: usize, candidates: &[(f64, u32)]) -> bool {
        let is_too_wide = |number: u32| match &self.parts[number as usize].kind {
            PartKind::Marched(marched) => {
                let size = marched.region.radius();
                marched.thicket.is_some() && beam.radius(0.0) > TOO_WIDE * size
            }
            _ => false,
        };
        rays > 1 && candidates.len() > CROWD
            || rays > WIDTH && candidates.iter().any(|(_, number)| is_too_wide(*number))
    }

    /// Collects the parts that a beam may meet before `limit`, with where, below the `known` entries, which are asked by the same
    /// rays or by those from their ends back; stops where it meets more than `most`. Gives whether it came to an end.
    fn meet(
        &self,
        (rays, beam): (&Beam, &Beam),
        limit: f64,
        known: Range<usize>,
        most: usize,
        question: &Question,
        scratch: &mut Scratch,
    ) -> bool {
        let step = Step {
            hierarchy: &self.hierarchy,
            beam,
            limit,
            level: self.level,
        };
        let Scratch {
            descent, entries, ..
        } = scratch;
        let nodes = entries[known].iter().copied();
        if !descent.go(&step, nodes, most) {
            return false;
        }
        descent
            .met
            .extend(self.endless_met(rays).map(|number| (0.0, number)));
        let is_seen = |number: u32| (question.is_seen)(&self.parts[number as usize]);
        descent.met.retain(|(_, number)| is_seen(*number));
        true
    }

    /// Asks one part of the rays in some packets of the bundle; gives whether any found something.
    fn ask(&self, asked: Asked, asking: &Asking, any: bool, scratch: &mut Scratch) -> bool {
        let bundle = &mut *scratch.bundle;
        let (number, packets) = asked;
        match &self.parts[number as usize].kind {
            PartKind::Ball(form) => self.enter(form, asked, any, bundle),
            PartKind::HalfSpace(form) => self.enter(form, asked, any, bundle),
            PartKind::Block(form) => self.enter(form, asked, any, bundle),
            PartKind::Facet(form) => self.enter(form, asked, any, bundle),
            PartKind::Pane(form) => self.enter(&**form, asked, any, bundle),
            PartKind::Ring(ring, spare) => self.ring(ring, spare, asked, asking, any, scratch),
            PartKind::Marched(marched) => {
                bundle.clip(&marched.region, packets, self.level);
                bundle.meeting(&mut scratch.rays);
                if scratch.rays.is_empty() {
                    return false;
                }
                bundle.mark();
                self.march(marched, number, asking, any, scratch)
            }
        }
    }

    /// Takes where the rays enter a surface in closed form as hits; gives whether any is new.
    fn enter<F: ClosedForm>(
        &self,
        form: &F,
        (number, packets): Asked,
        any: bool,
        bundle: &mut Bundle,
    ) -> bool {
        let task = Enter {
            bundle,
            form,
            number,
            packets,
            any,
        };
        let is_new = run_at(self.level, task);
        if is_new {
            bundle.winners.push(number);
        }
        is_new
    }

    /// Takes the hits of rays with a torus; those of which rounding decides are walked through its field.
    fn ring(
        &self,
        ring: &Ring,
        spare: &Spare,
        (number, packets): Asked,
        asking: &Asking,
        any: bool,
        scratch: &mut Scratch,
    ) -> bool {
        let bundle = &mut *scratch.bundle;
        if !run_at(
            self.level,
            Near {
                bundle,
                ring,
                packets,
            },
        ) {
            return false;
        }
        bundle.mark();
        let (rays, shop) = (&mut scratch.rays, &mut scratch.shop);
        bundle.meeting(rays);
        ring.find(bundle, rays, self.level, shop);
        let is_hit = take(bundle, shop, number, any);
        if shop.open.is_empty() {
            return is_hit;
        }
        let node = &self.parts[number as usize].node;
        let marched = spare.marched(node, self.settings.method, self.level);
        bundle.clip(&marched.region, packets, self.level);
        let meets = |ray: &u32| bundle.meets[*ray as usize] != 0;
        rays.clear();
        rays.extend(shop.open.drain(..).filter(meets));
        let is_met = !rays.is_empty() && self.march(marched, number, asking, any, scratch);
        is_hit | is_met
    }

    /// How far the farthest ray of a bundle is still to be followed.
    fn farthest(&self, scratch: &mut Scratch) -> f64 {
        let Scratch { cones, bundle, .. } = scratch;
        run_at(self.level, Follow { cones, bundle })
    }

    /// The packets of a bundle that may meet a part.
    fn meeting(&self, number: u32, cones: &Cones) -> Packets {
        let part = &self.parts[number as usize];
        let ball = match &part.kind {
            PartKind::Ball(ball) => *ball,
            PartKind::Ring(ring, _) => ring.around,
            _ if part.bounds.is_finite() => around(&part.bounds),
            _ => return ALL,
        };
        run_at(self.level, Meeting { cones, ball })
    }

    /// Walks the rays that come into the region of a part through its field.
    fn march(
        &self,
        marched: &Marched,
        number: u32,
        asking: &Asking,
        any: bool,
        scratch: &mut Scratch,
    ) -> bool {
        let Asking {
            rays,
            numbers,
            beam,
        } = asking;
        scratch.bundle.measure(rays, numbers);
        let rules = Rules {
            lipschitz: marched.lipschitz,
            tolerance: self.settings.tolerance,
            max_steps: self.settings.max_steps,
            reach: self.reach(marched),
            extent: marched.region.radius_about_centre(),
            is_endless: marched.is_endless(),
            any,
        };
        let mut is_hit = false;
        if let Some(cut) = &marched.cut {
            is_hit |= self.cut(cut, number, beam, any, scratch);
            if scratch.rays.is_empty() {
                return is_hit;
            }
        }
        let rays = std::mem::take(&mut scratch.rays);
        let packets = rays.len().div_ceil(WIDTH);
        for (k, rays) in rays.chunks(WIDTH).enumerate() {
            let task = Load {
                packet: &mut scratch.packets[k],
                bundle: &scratch.bundle,
                rays,
                rules: &rules,
            };
            run_at(self.level, task);
        }
        scratch.rays = rays;
        let visit = Visit {
            marched,
            number,
            any,
            rules,
        };
        if marched.is_sheet || marched.slope.is_some() {
            for k in 0..packets {
                let packet = &mut *scratch.packets[k];
                match &marched.slope {
                    Some(slope) => {
                        let (slope, rules) = (&slope.wide, &visit.rules);
                        run_at(
                            self.level,
                            Newton {
                                packet,
                                slope,
                                rules,
                            },
                        );
                    }
                    None => packet.walk_singly(),
                }
                is_hit |= self.settle(&visit, k, scratch);
            }
            self.incline(&visit, None, scratch);
        } else {
            for stage in &stages(marched, beam, &visit.rules, &scratch.bundle, &scratch.rays) {
                is_hit |= self.pass(&visit, stage, packets, scratch);
            }
        }
        for packet in &mut scratch.packets[..packets] {
            for lane in 0..packet.count {
                let ray = packet.ray[lane] as usize;
                scratch.bundle.steps[ray] += packet.steps[lane] as u32;
                scratch.bundle.evaluations[ray] += packet.evaluations[lane] as u32;
            }
        }
        is_hit
    }

    /// Takes the hits of rays with a combination in closed form; leaves those about which nothing was said.
    fn cut(&self, cut: &Cut, number: u32, beam: &Beam, any: bool, scratch: &mut Scratch) -> bool {
        let Scratch {
            bundle, rays, shop, ..
        } = scratch;
        cut.find(bundle, rays, beam, self.level, shop);
        let is_hit = take(bundle, shop, number, any);
        std::mem::swap(rays, &mut shop.open);
        is_hit
    }

    /// Walks all packets through a stage. Lanes that lag behind are put together in a packet of their own, so that few
    /// evaluations are done for few lanes.
    fn pass(&self, visit: &Visit, stage: &Stage, packets: usize, scratch: &mut Scratch) -> bool {
        let few = if packets > 1 { LAGGARDS } else { 0 };
        let mut homes = std::mem::take(&mut scratch.homes);
        homes.clear();
        let mut is_hit = false;
        scratch.packets[MIXED].clear();
        for k in 0..packets {
            let task = Proceed {
                packet: &mut scratch.packets[k],
                from: stage.from,
                to: stage.to,
                before: stage.before,
            };
            if !run_at(self.level, task) {
                continue;
            }
            self.advance(visit, stage, &mut scratch.packets[k], few);
            for from in scratch.packets[k].going(self.level) {
                let [packet, mixed] = pair(&mut scratch.packets, k);
                mixed.adopt(homes.len(), packet, from);
                homes.push((k, from));
                while homes.len() == WIDTH {
                    self.advance(visit, stage, &mut scratch.packets[MIXED], LAGGARDS);
                    is_hit |= self.disband(visit, &mut homes, scratch);
                }
            }
            is_hit |= self.settle(visit, k, scratch);
            // Those that were stuck.
            while scratch.packets[k].going(self.level).next().is_some() {
                self.advance(visit, stage, &mut scratch.packets[k], 0);
                is_hit |= self.settle(visit, k, scratch);
            }
        }
        while !homes.is_empty() {
            self.advance(visit, stage, &mut scratch.packets[MIXED], 0);
            is_hit |= self.disband(visit, &mut homes, scratch);
        }
        scratch.homes = homes;
        self.incline(visit, stage.left.as_ref(), scratch);
        is_hit
    }

    /// Walks a packet through a stage until no more than `few` lanes go on in each precision: first those that are close to
    /// surfaces, until they are away from them or have met one; then the others through free space in single precision, if
    /// that can be; then all to what they meet.
    fn advance(&self, visit: &Visit, stage: &Stage, packet: &mut Packet, few: i64) {
        let rules = &visit.rules;
        let stride = |packet: &mut Packet, scouted: f64| {
            let value = &stage.value;
            run_at(
                self.level,
                Stride {
                    packet,
                    value,
                    rules,
                    scouted,
                    few,
                },
            );
        };
        if let Some((value, short)) = stage.short.as_ref().zip(visit.marched.short()) {
            let least = SCOUTED * short.error;
            let reach = rules.reach;
            let muster = Muster {
                packet: &mut *packet,
                least,
                reach,
            };
            if run_at(self.level, muster) {
                stride(packet, least);
            }
            let task = Scout {
                packet,
                value,
                short,
                rules,
                few,
            };
            run_at(self.level, task);
        }
        stride(packet, f64::INFINITY);
    }

    /// Sends the lanes of the mixed packet that have come to the end of the stage home; those that go on move up.
    fn disband(
        &self,
        visit: &Visit,
        homes: &mut Vec<(usize, usize)>,
        scratch: &mut Scratch,
    ) -> bool {
        let is_hit = self.settle(visit, MIXED, scratch);
        for lane in scratch.packets[MIXED].arrived(self.level) {
            let (k, from) = homes[lane];
            let [packet, mixed] = pair(&mut scratch.packets, k);
            packet.adopt(from, mixed, lane);
        }
        let mixed = &mut scratch.packets[MIXED];
        let mut left = 0;
        for from in mixed.going(self.level) {
            homes[left] = homes[from];
            if left != from {
                mixed.shift(left, from);
            }
            left += 1;
        }
        homes.truncate(left);
        is_hit
    }

    /// Hands what the lanes of a packet found over to the bundle.
    fn settle(&self, visit: &Visit, k: usize, scratch: &mut Scratch) -> bool {
        let &Visit {
            marched,
            number,
            any,
            ..
        } = visit;
        let Scratch {
            bundle,
            packets,
            found,
            fresh,
            ..
        } = scratch;
        let packet = &mut packets[k];
        packet.found(&visit.rules, marched, found);
        let mut is_hit = false;
        // Hits behind the stage of lanes that went on alone, where its field may lack something.
        let mut beyond = Vec::new();
        for Found { lane, ending } in found.drain(..) {
            let ray = packet.ray[lane] as usize;
            bundle.steps[ray] += packet.steps[lane] as u32;
            bundle.evaluations[ray] += packet.evaluations[lane] as u32;
            (packet.steps[lane], packet.evaluations[lane]) = (0, 0);
            match ending.verdict {
                Verdict::Hit => {
                    let crossing = Crossing {
                        t: ending.t,
                        error: ending.error,
                    };
                    if ending.t <= bundle.t_max[ray] && bundle.offer(ray, crossing, number, any) {
                        is_hit = true;
                        let is_beyond = ending.t > packet.limit[lane];
                        let list = if is_beyond { &mut beyond } else { &mut *fresh };
                        list.push(ray as u32);
                    }
                }
                Verdict::Miss => {}
                Verdict::Unknown => bundle.doubt(ray, ending.t),
            }
        }
        if !beyond.is_empty() {
            let within = std::mem::replace(&mut scratch.fresh, beyond);
            self.incline(visit, None, scratch);
            scratch.fresh = within;
        }
        is_hit
    }

    /// Finds the gradients at the hits of a stage that have none yet.
    fn incline(&self, visit: &Visit, left: Option<&Thinned>, scratch: &mut Scratch) {
        let Scratch { bundle, fresh, .. } = scratch;
        if !visit.any && !fresh.is_empty() {
            let thinned = match (&visit.marched.thicket, left) {
                (Some(thicket), Some(left)) => thicket.gradient(left),
                _ => None,
            };
            let gradient = thinned.as_ref().or(visit.marched.gradient_wide.as_ref());
            let source = match gradient {
                Some(gradient) => Some(Derivatives::Dual(gradient)),
                None => visit
                    .marched
                    .gradient_graph(self.level)
                    .map(Derivatives::Graph),
            };
            if let Some(source) = source {
                for rays in fresh.chunks(WIDTH) {
                    let task = Gradient {
                        bundle,
                        source: &source,
                        rays,
                    };
                    run_at(self.level, task);
                }
            }
        }
        fresh.clear();
    }
}

/// A ball around a box.
fn around(bounds: &Bounds) -> Ball {
    Ball {
        centre: DVec3::from_array(bounds.centre()),
        radius: 0.5 * DVec3::from_array(bounds.size()).length(),
    }
}

/// Offers what rays found in closed form to them, with the normals; gives whether any took it.
fn take(bundle: &mut Bundle, shop: &Workshop, number: u32, any: bool) -> bool {
    let mut is_hit = false;
    for found in &shop.found {
        let ray = found.ray as usize;
        let crossing = Crossing {
            t: found.t,
            error: found.error,
        };
        if found.t <= bundle.limit[ray] && bundle.offer(ray, crossing, number, any) {
            is_hit = true;
            (0..3).for_each(|axis| bundle.gradient[axis][ray] = found.normal[axis]);
        }
    }
    is_hit
}

/// Brings the numbers that come first to the front; gives how many there are. Those of either kind stay in order.
fn divide(numbers: &mut [u32], is_first: impl Fn(&u32) -> bool, aside: &mut Vec<u32>) -> usize {
    aside.clear();
    let mut half = 0;
    for i in 0..numbers.len() {
        let number = numbers[i];
        if is_first(&number) {
            numbers[half] = number;
            half += 1;
        } else {
            aside.push(number);
        }
    }
    numbers[half..].copy_from_slice(aside);
    half
}

/// Packet `k` and the mixed one.
fn pair(packets: &mut [Box<Packet>], k: usize) -> [&mut Packet; 2] {
    let (own, mixed) = packets.split_at_mut(MIXED);
    [&mut own[k], &mut mixed[0]]
}
