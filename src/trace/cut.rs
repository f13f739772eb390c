//! Convex solids, and hard combinations of them, in closed form: where a ray enters what is left of solids that are united,
//! cut with one another, or taken from one another.
//!
//! Each solid has one chord on a ray. A ray at `t` is inside of a combination, or goes on to the next place where it is: in a
//! union the nearest of its children's; in an intersection, and with what is taken away turned inside out, to where no child
//! sends it any farther. So rooms, which are concave, are left by the exits of what was taken away. Where a surface that leads
//! in and one that leads out lie so close on a ray that rounding decides their order, nothing is said, and the ray is marched.
//! Source: Roth 1982 for chords of combinations.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::beam::Beam;
use super::bundle::{Bundle, Choice, WIDTH};
use super::chord::{Chord, Convex, Solid, with_solid};
use super::hierarchy::{BRANCHES, Boxes};
use super::packet::Lane;
use crate::catalogue::{Bounds, Combination, Operation, Similarity};
use crate::field::{Level, Task, run_at};
use crate::num::Vec3;
use crate::scene::{Node, Shape};
use glam::DVec3;

/// More passes over the children of a combination are not made; a ray that would need them is marched.
const MOST_PASSES: usize = 64;

/// How solids are combined.
enum Tree {
    Solid(usize),
    /// What is in any of them.
    Any(Vec<Tree>),
    /// What is in all of them.
    All(Vec<Tree>),
    /// What is in the first and in none of the others.
    Less(Vec<Tree>),
}

/// A solid of a combination.
struct Leaf {
    solid: Convex,
    /// 1 where it is added, -1 where it is taken away.
    sign: f64,
}

/// A hard combination of convex solids, or one of them.
pub(super) struct Cut {
    tree: Tree,
    leaves: Vec<Leaf>,
    /// The boxes of the leaves, as far as they lie in the combination's.
    boxes: Vec<Boxes>,
}

/// The chords of 32 rays.
#[derive(Clone, Copy)]
struct Chords {
    enter: Lane,
    leave: Lane,
    /// The errors of both.
    errors: [Lane; 2],
    /// 1 where the chord is in doubt, else 0.
    doubt: Lane,
}

/// 32 rays: their origins and directions, by axis.
pub(super) type Lines = [Lane; 6];

/// No leaf.
const NONE: u64 = u64::MAX;

/// What 32 rays meet, in lanes.
struct Verge {
    /// Where.
    t: Lane,
    /// The leaf whose surface it is; [`NONE`] if there is none.
    leaf: [u64; WIDTH],
    /// The error of that surface alone, and the largest of all surfaces there.
    own: Lane,
    error: Lane,
    /// Whether the surface leads into what is combined, as 0 or 1.
    leads_in: [u64; WIDTH],
    /// Whether rounding decides what lies there, as 0 or 1: where one surface leads into the combination and another out of
    /// it, or a chord is in doubt. Surfaces that lead the same way may come in any order.
    is_open: [u64; WIDTH],
    normal: [Lane; 3],
}

/// The hit of a ray.
pub(super) struct Found {
    /// The ray's number in the bundle.
    pub ray: u32,
    /// Where it is.
    pub t: f64,
    /// A bound of the error.
    pub error: f64,
    /// The outward normal.
    pub normal: DVec3,
}

/// Memory that is used again and again.
#[derive(Default)]
pub(super) struct Workshop {
    /// Which leaves the beam may meet.
    is_met: Vec<bool>,
    met: Vec<u32>,
    chords: Vec<Chords>,
    /// What rays found.
    pub found: Vec<Found>,
    /// The rays about which nothing is said.
    pub open: Vec<u32>,
}

impl Cut {
    /// The combination that a node is, or the one solid; none if it is blended, or has a leaf without a closed form.
    pub fn of(node: &Node) -> Option<Self> {
        let mut leaves = Vec::new();
        let mut bounds: Vec<Bounds> = Vec::new();
        let tree = tree(
            node,
            &Similarity::IDENTITY,
            1.0,
            &mut |solid, own, map, sign| {
                leaves.push(Leaf { solid, sign });
                // With room for rounding, so that no surface lies on its border.
                let own = outside(own, map, node.bounds());
                bounds.push(own.inflate(1e-9 * node.bounds().finite_size()));
                leaves.len() - 1
            },
        )?;
        let boxes = |some: &[Bounds]| Boxes::new(some.iter().copied());
        Some(Self {
            tree,
            leaves,
            boxes: bounds.chunks(BRANCHES).map(boxes).collect(),
        })
    }

    /// Finds the hits of these rays of a bundle.
    pub fn find(
        &self,
        bundle: &Bundle,
        rays: &[u32],
        beam: &Beam,
        level: Level,
        shop: &mut Workshop,
    ) {
        shop.found.clear();
        shop.open.clear();
        shop.met.clear();
        shop.is_met.clear();
        for boxes in &self.boxes {
            let entered = beam.enters(boxes, f64::INFINITY, level);
            shop.is_met.extend(entered.map(|t| t < f64::INFINITY));
        }
        let is_met = |leaf: &usize| shop.is_met[*leaf];
        shop.met.extend(
            (0..self.leaves.len())
                .filter(is_met)
                .map(|leaf| leaf as u32),
        );
        let nothing = Chords {
            enter: [f64::INFINITY; WIDTH],
            leave: [f64::INFINITY; WIDTH],
            errors: [[0.0; WIDTH]; 2],
            doubt: [0.0; WIDTH],
        };
        shop.chords.resize(self.leaves.len(), nothing);
        for rays in rays.chunks(WIDTH) {
            self.find_some(bundle, rays, level, shop);
        }
    }

    /// As [`Cut::find`], for up to 32 rays.
    fn find_some(&self, bundle: &Bundle, rays: &[u32], level: Level, shop: &mut Workshop) {
        let lines = &lines(bundle, rays);
        for leaf in &shop.met {
            let chords = &mut shop.chords[*leaf as usize];
            with_solid!(&self.leaves[*leaf as usize].solid, solid => {
                run_at(level, Cross { lines, solid, chords });
            });
        }
        let walk = Walk {
            chords: &shop.chords,
            is_met: &shop.is_met,
            level,
        };
        let zero = [0.0; WIDTH];
        let (mut t, mut out_of) = (zero, zero);
        let is_done = walk.go(&self.tree, &mut t, false);
        // Rays that start inside look for the way out.
        let starts_inside = t[..rays.len()].contains(&0.0);
        let is_done = is_done && (!starts_inside || walk.go(&self.tree, &mut out_of, true));
        if !is_done {
            shop.open.extend(rays);
            return;
        }
        for lane in 0..WIDTH {
            t[lane] = if t[lane] == 0.0 {
                out_of[lane]
            } else {
                t[lane]
            };
        }
        let mut verge = Verge::at(t);
        self.look(shop, &mut verge, lines, level);
        for (lane, ray) in rays.iter().enumerate() {
            let is_open = verge.is_open[lane] != 0;
            if verge.t[lane] == f64::INFINITY && !is_open {
                continue;
            }
            if is_open || verge.leaf[lane] == NONE {
                shop.open.push(*ray);
                continue;
            }
            let [x, y, z] = [0, 1, 2].map(|axis: usize| verge.normal[axis][lane]);
            shop.found.push(Found {
                ray: *ray,
                t: verge.t[lane],
                error: verge.error[lane],
                normal: DVec3::new(x, y, z),
            });
        }
    }

    /// Finds what lies at the places that rays came to.
    fn look(&self, shop: &Workshop, verge: &mut Verge, lines: &Lines, level: Level) {
        let ends = |leaf: &u32| {
            let is_added = self.leaves[*leaf as usize].sign > 0.0;
            Ends {
                leaf: u64::from(*leaf),
                chords: &shop.chords[*leaf as usize],
                leads_in: [is_added, !is_added].map(u64::from),
            }
        };
        for leaf in &shop.met {
            let ends = ends(leaf);
            run_at(level, Meet { ends, verge });
        }
        for leaf in &shop.met {
            let ends = ends(leaf);
            run_at(level, Doubt { ends, verge });
        }
        for leaf in &shop.met {
            let number = u64::from(*leaf);
            if !verge.leaf.contains(&number) {
                continue;
            }
            let Leaf { solid, sign } = &self.leaves[*leaf as usize];
            let sign = *sign;
            with_solid!(solid, solid => {
                run_at(level, Turn { number, solid, sign, lines, verge });
            });
        }
    }
}

impl Verge {
    /// These places, with nothing there yet.
    fn at(t: Lane) -> Self {
        Self {
            t,
            leaf: [NONE; WIDTH],
            own: [0.0; WIDTH],
            error: [0.0; WIDTH],
            leads_in: [0; WIDTH],
            is_open: [0; WIDTH],
            normal: [[0.0; WIDTH]; 3],
        }
    }
}

/// The rays of a bundle with these numbers.
#[inline(always)]
pub(super) fn lines(bundle: &Bundle, rays: &[u32]) -> Lines {
    let mut lines = [[0.0; WIDTH]; 6];
    let columns = bundle.origin.iter().chain(&bundle.direction);
    let choice = Choice::of(rays);
    for (line, column) in lines.iter_mut().zip(columns) {
        *line = choice.picked(column);
    }
    lines
}

/// The ends of the chords of a leaf.
struct Ends<'a> {
    leaf: u64,
    chords: &'a Chords,
    /// Whether they lead into what is combined, as 0 or 1: where rays enter the leaf, and where they leave it.
    leads_in: [u64; 2],
}

/// Takes a leaf whose surface lies where rays came to, if they have none yet: where they enter it, or else leave it.
struct Meet<'a> {
    ends: Ends<'a>,
    verge: &'a mut Verge,
}

impl Task for Meet<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (chords, v) = (self.ends.chords, self.verge);
        let [into, out_of] = self.ends.leads_in;
        for lane in 0..WIDTH {
            let t = v.t[lane];
            let (enters, leaves) = (chords.enter[lane] == t, chords.leave[lane] == t);
            let is_first = (v.leaf[lane] == NONE) & (enters | leaves);
            let [enter, leave] = [chords.errors[0][lane], chords.errors[1][lane]];
            let error = if enters { enter } else { leave };
            let leads_in = if enters { into } else { out_of };
            v.leaf[lane] = if is_first {
                self.ends.leaf
            } else {
                v.leaf[lane]
            };
            v.own[lane] = if is_first { error } else { v.own[lane] };
            v.error[lane] = v.own[lane];
            v.leads_in[lane] = if is_first { leads_in } else { v.leads_in[lane] };
        }
    }
}

/// Doubts places near which the other end of a chord lies, and takes the largest error of all surfaces there.
struct Doubt<'a> {
    ends: Ends<'a>,
    verge: &'a mut Verge,
}

impl Task for Doubt<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (chords, v) = (self.ends.chords, self.verge);
        let [into, out_of] = self.ends.leads_in;
        for lane in 0..WIDTH {
            let (t, own) = (v.t[lane], v.own[lane]);
            let mut is_open = chords.doubt[lane] != 0.0;
            let mut error = v.error[lane];
            for (end, other, leads_in) in [
                (chords.enter[lane], chords.errors[0][lane], into),
                (chords.leave[lane], chords.errors[1][lane], out_of),
            ] {
                let is_close = (end - t).abs() <= 4.0 * (own + other);
                is_open |= is_close & (leads_in != v.leads_in[lane]);
                error = if is_close & (other > error) {
                    other
                } else {
                    error
                };
            }
            v.error[lane] = error;
            v.is_open[lane] |= u64::from(is_open);
        }
    }
}

/// Finds the normals where rays meet a leaf.
struct Turn<'a, S> {
    number: u64,
    solid: &'a S,
    sign: f64,
    lines: &'a Lines,
    verge: &'a mut Verge,
}

impl<S: Solid> Task for Turn<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let ([a, b, c, d, e, f], v) = (self.lines, self.verge);
        for lane in 0..WIDTH {
            let origin = DVec3::new(a[lane], b[lane], c[lane]);
            let direction = DVec3::new(d[lane], e[lane], f[lane]);
            let p = origin + direction * v.t[lane];
            let normal = self.solid.normal(p) * self.sign;
            let is_here = v.leaf[lane] == self.number;
            for axis in 0..3 {
                let before = v.normal[axis][lane];
                v.normal[axis][lane] = if is_here { normal[axis] } else { before };
            }
        }
    }
}

/// What is told of each leaf: the solid, a box around it before the map that places it, that map, and whether the solid is
/// added (1) or taken away (-1).
type Tell<'a> = &'a mut dyn FnMut(Convex, Bounds, &Similarity, f64) -> usize;

/// The combination that a node is under a map; `leaf` numbers its leaves.
fn tree(node: &Node, outer: &Similarity, sign: f64, leaf: Tell) -> Option<Tree> {
    let (map, inner) = node.unplaced();
    let map = outer.then(&map);
    let (operation, children) = match inner.shape() {
        Shape::Primitive(primitive) => {
            let solid = Convex::of(primitive, &map)?;
            return Some(Tree::Solid(leaf(solid, inner.bounds(), &map, sign)));
        }
        Shape::Combination(Combination { operation, blend }, children) if blend.is_hard() => {
            (operation, children)
        }
        _ => return None,
    };
    let is_less = *operation == Operation::Difference;
    let mut trees = Vec::with_capacity(children.len());
    for (k, child) in children.iter().enumerate() {
        let sign = if is_less && k > 0 { -sign } else { sign };
        trees.push(tree(child, &map, sign, leaf)?);
    }
    match operation {
        Operation::Union => Some(Tree::Any(trees)),
        Operation::Intersection => Some(Tree::All(trees)),
        Operation::Difference => Some(Tree::Less(trees)),
        Operation::Joint => None,
    }
}

/// A box around what a map makes of a box, as far as that lies in `room`.
fn outside(bounds: Bounds, map: &Similarity, room: Bounds) -> Bounds {
    if !room.is_finite() {
        return room;
    }
    // In the solid's own coordinates first, so that a long bar stays thin however it lies.
    let inside = |[x, y, z]: [f64; 3]| {
        let q = map.point(&Vec3::new(x, y, z));
        [q.x, q.y, q.z]
    };
    let room_inside = Bounds::around(corners(room).map(inside));
    let own = bounds.intersect(room_inside);
    if own.is_empty() {
        return own;
    }
    Bounds::around(corners(own).map(|corner| map.outside(corner))).intersect(room)
}

/// The corners of a box.
fn corners(bounds: Bounds) -> impl Iterator<Item = [f64; 3]> {
    let end = move |k: usize, axis: usize| [bounds.low[axis], bounds.high[axis]][k >> axis & 1];
    (0..8).map(move |k| [0, 1, 2].map(|axis| end(k, axis)))
}

/// Finds the chords of a solid on up to 32 rays.
struct Cross<'a, S> {
    lines: &'a Lines,
    solid: &'a S,
    chords: &'a mut Chords,
}

impl<S: Solid> Task for Cross<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let [a, b, c, d, e, f] = self.lines;
        for lane in 0..WIDTH {
            let origin = DVec3::new(a[lane], b[lane], c[lane]);
            let direction = DVec3::new(d[lane], e[lane], f[lane]);
            let Chord {
                enter,
                leave,
                errors,
                is_doubtful,
            } = self.solid.chord(origin, direction);
            // A ray that starts on a surface leaves it first.
            let is_behind = leave <= 2.0 * errors[1];
            let enter = if enter <= 2.0 * errors[0] {
                f64::NEG_INFINITY
            } else {
                enter
            };
            self.chords.enter[lane] = if is_behind { f64::INFINITY } else { enter };
            self.chords.leave[lane] = if is_behind { f64::INFINITY } else { leave };
            self.chords.errors[0][lane] = errors[0];
            self.chords.errors[1][lane] = errors[1];
            self.chords.doubt[lane] = if is_doubtful { 1.0 } else { 0.0 };
        }
    }
}

/// A way along 32 rays through a combination.
struct Walk<'a> {
    chords: &'a [Chords],
    is_met: &'a [bool],
    level: Level,
}

impl Walk<'_> {
    /// Goes on from `t` to the next place, which may be here, that is outside of a combination, or else inside. Gives whether
    /// that was found; where there is none, `t` is infinite.
    fn go(&self, tree: &Tree, t: &mut Lane, to_outside: bool) -> bool {
        match tree {
            Tree::Solid(leaf) => {
                let leaf = *leaf;
                if self.is_met[leaf] {
                    let chords = &self.chords[leaf];
                    run_at(
                        self.level,
                        Go {
                            chords,
                            t,
                            to_outside,
                        },
                    );
                } else if !to_outside {
                    *t = [f64::INFINITY; WIDTH];
                }
                true
            }
            Tree::Any(children) if to_outside => self.past_all(children, t, |_| true),
            Tree::Any(children) => self.nearest(children, t, |_| false),
            Tree::All(children) if to_outside => self.nearest(children, t, |_| true),
            Tree::All(children) => self.past_all(children, t, |_| false),
            Tree::Less(children) if to_outside => self.nearest(children, t, |k| k == 0),
            Tree::Less(children) => self.past_all(children, t, |k| k > 0),
        }
    }

    /// Whether what goes on is a solid that no ray meets, so that all are outside of it wherever they are.
    #[inline(always)]
    fn is_missed(&self, tree: &Tree) -> bool {
        matches!(tree, Tree::Solid(leaf) if !self.is_met[*leaf])
    }

    /// The nearest of the places that the children give.
    fn nearest(&self, children: &[Tree], t: &mut Lane, to_outside: impl Fn(usize) -> bool) -> bool {
        let from = *t;
        *t = [f64::INFINITY; WIDTH];
        children.iter().enumerate().all(|(k, child)| {
            let mut own = from;
            let is_done = self.go(child, &mut own, to_outside(k));
            for lane in 0..WIDTH {
                t[lane] = if own[lane] < t[lane] {
                    own[lane]
                } else {
                    t[lane]
                };
            }
            is_done
        })
    }

    /// The first place from which no child goes any farther.
    fn past_all(
        &self,
        children: &[Tree],
        t: &mut Lane,
        to_outside: impl Fn(usize) -> bool,
    ) -> bool {
        for _ in 0..MOST_PASSES {
            let before = *t;
            for (k, child) in children.iter().enumerate() {
                if to_outside(k) && self.is_missed(child) {
                    continue;
                }
                if !self.go(child, t, to_outside(k)) {
                    return false;
                }
            }
            if *t == before {
                return true;
            }
        }
        false
    }
}

/// Goes on from `t` to the next place that is outside of a solid, or else inside.
struct Go<'a> {
    chords: &'a Chords,
    t: &'a mut Lane,
    to_outside: bool,
}

impl Task for Go<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (enter, leave) = (&self.chords.enter, &self.chords.leave);
        if self.to_outside {
            for lane in 0..WIDTH {
                let t = self.t[lane];
                let is_inside = (t >= enter[lane]) & (t < leave[lane]);
                self.t[lane] = if is_inside { leave[lane] } else { t };
            }
        } else {
            for lane in 0..WIDTH {
                let t = self.t[lane];
                let here = if t < leave[lane] { t } else { f64::INFINITY };
                self.t[lane] = if t < enter[lane] { enter[lane] } else { here };
            }
        }
    }
}
