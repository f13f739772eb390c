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
use super::bundle::{Bundle, WIDTH, place};
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
        for leaf in &shop.met {
            let chords = &mut shop.chords[*leaf as usize];
            with_solid!(&self.leaves[*leaf as usize].solid, solid => {
                run_at(level, Cross { bundle, rays, solid, chords });
            });
        }
        let walk = Walk {
            chords: &shop.chords,
            is_met: &shop.is_met,
            level,
        };
        let zero = [0.0; WIDTH];
        let (mut into, mut out_of) = (zero, zero);
        let is_done = walk.go(&self.tree, &mut into, false);
        // Rays that start inside look for the way out.
        let starts_inside = (0..rays.len()).any(|lane| into[lane] == 0.0);
        let is_done = is_done && (!starts_inside || walk.go(&self.tree, &mut out_of, true));
        for (lane, ray) in rays.iter().enumerate() {
            let is_doubtful = |leaf: &u32| shop.chords[*leaf as usize].doubt[lane] != 0.0;
            let is_done = is_done && !shop.met.iter().any(is_doubtful);
            let t = if into[lane] == 0.0 {
                out_of[lane]
            } else {
                into[lane]
            };
            if t == f64::INFINITY && is_done {
                continue;
            }
            match self.surface(t, lane, shop).filter(|_| is_done) {
                Some((leaf, error)) => {
                    let i = *ray as usize;
                    let p = place(&bundle.origin, i) + place(&bundle.direction, i) * t;
                    let Leaf { solid, sign } = &self.leaves[leaf];
                    shop.found.push(Found {
                        ray: *ray,
                        t,
                        error,
                        normal: solid.normal(p) * *sign,
                    });
                }
                None => shop.open.push(*ray),
            }
        }
    }

    /// A leaf whose surface a ray meets at `t`, with the error of that. None where rounding decides what lies there: where
    /// one surface leads into the combination and another out of it. Surfaces that lead the same way may come in any order.
    fn surface(&self, t: f64, lane: usize, shop: &Workshop) -> Option<(usize, f64)> {
        // Each surface: its leaf, its place, the error, and whether it leads into what is combined.
        let surfaces = || {
            shop.met.iter().flat_map(|leaf| {
                let leaf = *leaf as usize;
                let (chords, is_added) = (&shop.chords[leaf], self.leaves[leaf].sign > 0.0);
                let [enter, leave] = [0, 1].map(|k: usize| chords.errors[k][lane]);
                [
                    (leaf, chords.enter[lane], enter, is_added),
                    (leaf, chords.leave[lane], leave, !is_added),
                ]
            })
        };
        let (leaf, _, own, leads_in) = surfaces().find(|(_, end, ..)| *end == t)?;
        let mut error = own;
        for (_, end, other, also_in) in surfaces() {
            if (end - t).abs() <= 4.0 * (own + other) {
                if also_in != leads_in {
                    return None;
                }
                error = error.max(other);
            }
        }
        Some((leaf, error))
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
    bundle: &'a Bundle,
    rays: &'a [u32],
    solid: &'a S,
    chords: &'a mut Chords,
}

impl<S: Solid> Task for Cross<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut lines = [[0.0; WIDTH]; 6];
        for lane in 0..WIDTH {
            // Lanes without a ray repeat the first.
            let ray = self.rays[if lane < self.rays.len() { lane } else { 0 }] as usize;
            for axis in 0..3 {
                lines[axis][lane] = self.bundle.origin[axis][ray];
                lines[3 + axis][lane] = self.bundle.direction[axis][ray];
            }
        }
        let [a, b, c, d, e, f] = &lines;
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
