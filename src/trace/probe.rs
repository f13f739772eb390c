//! What a field does ahead on a ray, in one traversal of its tree: its value, lines below and above it, and how far it surely
//! keeps its sign.
//!
//! A line below: along a ray, a convex field lies above its tangent and below its chords; another field rises and falls by at
//! most the range of its derivative over the stretch ahead, which is known by intervals. A smooth minimum is concave and rises
//! with both operands, so that of two lines lies above its chord and below its tangent; with intersections and differences it is the
//! other way round. The crossing of a level: where two fields are united, their union is above a level while both are above
//! it by what the seam goes below the lower one; of a leaf a box around all that is below the level is known. Sources:
//! Aydinlilar and Zanni 2023, forward inclusion functions; Galin et al. 2020 for ranges over a stretch; levels are passed down as
//! in the sublevels of the catalogue.

use super::Ray;
use super::along::{moving, stretched};
use super::analytic::Ball;
use super::hierarchy::clip;
use super::part::bent;
use crate::catalogue::{AnyModifier, AnyPrimitive, Blend, Bounds, Combination, Offset};
use crate::catalogue::{Operation, Shell, Similarity, with_compiled_blend};
use crate::field::{Closure, Level, compile, compile_convex};
use crate::num::{Dual, Interval, Vec3};
use crate::scene::{Node, Shape};
use glam::DVec3;

/// What is known of a field from a place on a ray on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Its value there.
    pub value: f64,
    /// It changes with each unit of the way at least and at most so much, up to the reach that was asked for, as seen from
    /// there: `value + slope[0] s <= f(s) <= value + slope[1] s`.
    pub slope: [f64; 2],
    /// So far it surely keeps its sign; 0 if that is not known.
    pub free: f64,
}

/// A field as a tree that can be probed.
pub struct Probe {
    root: Branch,
}

/// A part of the tree.
enum Branch {
    Leaf(Box<Leaf>),
    Join(Combination, Vec<Self>),
    Placed(Similarity, Box<Self>),
    Grown(Offset, Box<Self>),
    Hollow(Shell, Box<Self>),
}

/// What is not taken apart.
struct Leaf {
    value: Closure<f64>,
    /// The field with its derivative along a ray, if it is convex.
    tangent: Option<Closure<Dual<f64, 1>>>,
    /// How much the slope along a line of unit length falls and rises at most with each unit, with the gradient that it is measured
    /// from; none where that is not known.
    bend: Option<([f64; 2], Closure<Dual<f64, 3>>)>,
    /// The ranges of the field and its derivative; none for claims, which are to be noticed if they are wrong.
    ranges: Option<Closure<Dual<Interval, 1>>>,
    lipschitz: f64,
    /// What is below the level that matters lies in here.
    around: Bounds,
    /// A sphere about the origin with this radius, grown by the level.
    radius: Option<f64>,
    levels: Levels,
    /// What is in here is inside, if the level is 0: a convex solid that is its bounds.
    is_box: bool,
}

/// The levels whose crossings matter: of the field itself from above, and of its opposite. Neither is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Levels {
    above: f64,
    below: f64,
}

/// A line in the coordinates of a branch: places are `origin + t direction`, with the same `t` for all branches.
#[derive(Clone, Copy)]
struct Line {
    origin: DVec3,
    direction: DVec3,
    /// Where the stretch begins, and how long it is.
    from: f64,
    reach: f64,
}

impl Line {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The same line as seen from inside of a map.
    fn inside(&self, map: &Similarity) -> Self {
        let point = |p: DVec3| {
            let q = map.point(&Vec3::new(p.x, p.y, p.z));
            DVec3::new(q.x, q.y, q.z)
        };
        let turned = |axis: usize| DVec3::from_array(map.rows[axis]).dot(self.direction);
        Self {
            origin: point(self.origin),
            direction: DVec3::new(turned(0), turned(1), turned(2)),
            ..*self
        }
    }
}

/// What a branch says: value, lines, and the lengths on which it stays above its level, or its opposite above its own.
#[derive(Clone, Copy)]
struct Told {
    value: f64,
    slope: [f64; 2],
    above: f64,
    below: f64,
}

/// The share of a length that rounding may take from it.
const ROUNDING: f64 = 1e-9;

impl Probe {
    /// The tree of a field that is asked in `region`.
    pub fn new(node: &Node, region: Bounds) -> Self {
        let levels = Levels {
            above: 0.0,
            below: 0.0,
        };
        Self {
            root: branch(node, region, levels),
        }
    }

    /// What is known of the field on a ray from `t` up to `reach` farther on, which is finite.
    pub fn ask(&self, ray: &Ray, t: f64, reach: f64) -> Ahead {
        let line = Line {
            origin: ray.origin,
            direction: ray.direction,
            from: t,
            reach,
        };
        let Told {
            value,
            slope,
            above,
            below,
        } = self.root.ask(&line);
        Ahead {
            value,
            slope,
            free: if value < 0.0 { below } else { above },
        }
    }
}

/// The tree of a node.
fn branch(node: &Node, region: Bounds, levels: Levels) -> Branch {
    let (map, inner, inside) = node.unplaced_in(region);
    let scaled = Levels {
        above: levels.above / map.scale,
        below: levels.below / map.scale,
    };
    let tree = match inner.shape() {
        _ if inner.rests_on_claim() => Branch::Leaf(Box::new(Leaf::new(inner, inside, scaled))),
        Shape::Combination(combination, children) if is_known(combination) => {
            let child = |(i, child): (usize, &std::sync::Arc<Node>)| {
                let levels = operand(combination, i, children.len(), scaled);
                branch(child, inside, levels)
            };
            Branch::Join(
                combination.clone(),
                children.iter().enumerate().map(child).collect(),
            )
        }
        Shape::Modifier(AnyModifier::Offset(offset), child) => {
            let levels = Levels {
                above: (scaled.above + offset.by).max(0.0),
                below: (scaled.below - offset.by).max(0.0),
            };
            Branch::Grown(offset.clone(), Box::new(branch(child, inside, levels)))
        }
        Shape::Modifier(AnyModifier::Shell(shell), child) => {
            let level = scaled.above + 0.5 * shell.thickness;
            let levels = Levels {
                above: level,
                below: level,
            };
            Branch::Hollow(shell.clone(), Box::new(branch(child, inside, levels)))
        }
        _ => Branch::Leaf(Box::new(Leaf::new(inner, inside, scaled))),
    };
    if map == Similarity::IDENTITY {
        tree
    } else {
        Branch::Placed(map, Box::new(tree))
    }
}

/// Whether a combination is a minimum, hard or smooth, or what is made of one by turning signs: concave, and rising with both
/// operands. So are all blends that are compiled.
fn is_known(combination: &Combination) -> bool {
    let is_compiled = with_compiled_blend!(&combination.blend, _blend => true).unwrap_or(false);
    is_compiled && combination.operation != Operation::Joint
}

/// The levels of operand `i` of `n`: a seam goes below the lower operand, so the crossing of a level is certain only where that is
/// higher by as much.
fn operand(combination: &Combination, i: usize, n: usize, levels: Levels) -> Levels {
    let lower = |level: f64| {
        with_compiled_blend!(&combination.blend, blend => blend.reach(level, n))
            .expect("only compiled blends are taken apart")
    };
    let Levels { above, below } = levels;
    match combination.operation {
        Operation::Union | Operation::Joint => Levels {
            above: lower(above),
            below,
        },
        Operation::Difference if i > 0 => Levels {
            above: lower(below),
            below: above,
        },
        Operation::Intersection | Operation::Difference => Levels {
            above,
            below: lower(below),
        },
    }
}

/// The value of a blend of two fields, and its derivative where these have the derivatives `a` and `b`.
fn joined(combination: &Combination, a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let [a, b] = [a, b].map(|[value, slope]| Dual::new(value, [slope]));
    let all =
        with_compiled_blend!(&combination.blend, blend => combination.operation.join(blend, a, b))
            .expect("only compiled blends are taken apart");
    [all.value, all.partial[0]]
}

impl Branch {
    fn ask(&self, line: &Line) -> Told {
        match self {
            Self::Leaf(leaf) => leaf.ask(line),
            Self::Placed(map, child) => {
                let told = child.ask(&line.inside(map));
                Told {
                    value: map.field(told.value),
                    slope: told.slope.map(|slope| slope * map.scale),
                    ..told
                }
            }
            Self::Grown(offset, child) => {
                let told = child.ask(line);
                Told {
                    value: told.value - offset.by,
                    ..told
                }
            }
            Self::Hollow(shell, child) => {
                let told = child.ask(line);
                hollow(shell, told, line)
            }
            Self::Join(combination, children) => {
                let mut all = children[0].ask(line);
                for child in &children[1..] {
                    all = joined_told(combination, all, child.ask(line), line.reach);
                }
                all
            }
        }
    }
}

/// What is known of `|f| - t / 2`.
fn hollow(shell: &Shell, told: Told, line: &Line) -> Told {
    let half = 0.5 * shell.thickness;
    let steepest = told.slope[0].abs().max(told.slope[1].abs());
    let [low, high] = told.slope;
    // The lines of |f|, which is convex in f: where f keeps its sign they are its own or their opposites.
    let end = |slope: f64| told.value + slope * line.reach;
    let slope = if told.value > 0.0 && end(low) >= 0.0 {
        [low, high]
    } else if told.value < 0.0 && end(high) <= 0.0 {
        [-high, -low]
    } else {
        [-steepest, steepest]
    };
    Told {
        value: told.value.abs() - half,
        slope,
        above: if told.value > 0.0 {
            told.above
        } else {
            told.below
        },
        // How far the wall is left behind is told by the lines alone.
        below: 0.0,
    }
}

/// What is known of two fields as one.
fn joined_told(combination: &Combination, a: Told, b: Told, reach: f64) -> Told {
    let value = joined(combination, [a.value, 0.0], [b.value, 0.0])[0];
    // With what is subtracted the field falls.
    let falls = combination.operation == Operation::Difference;
    let line = |k: usize| (a.slope[k], b.slope[if falls { 1 - k } else { k }]);
    let tangent = |k: usize| {
        let (p, q) = line(k);
        joined(combination, [a.value, p], [b.value, q])[1]
    };
    let chord = |k: usize| {
        let (p, q) = line(k);
        let ends = [[a.value + p * reach, 0.0], [b.value + q * reach, 0.0]];
        (joined(combination, ends[0], ends[1])[0] - value) / reach
    };
    let is_concave = combination.operation == Operation::Union;
    let slope = if is_concave {
        [chord(0), tangent(1)]
    } else {
        [tangent(0), chord(1)]
    };
    let (above, below) = match combination.operation {
        Operation::Union | Operation::Joint => (a.above.min(b.above), a.below.max(b.below)),
        Operation::Intersection => (a.above.max(b.above), a.below.min(b.below)),
        Operation::Difference => (a.above.max(b.below), a.below.min(b.above)),
    };
    Told {
        value,
        slope,
        above,
        below,
    }
}

impl Leaf {
    fn new(node: &Node, region: Bounds, levels: Levels) -> Self {
        let traits = node.traits();
        let is_claimed = node.rests_on_claim();
        let is_convex = traits.is_convex && !traits.is_sheet && !node.has_graph() && !is_claimed;
        let (radius, is_box) = match node.shape() {
            Shape::Primitive(AnyPrimitive::Sphere(sphere)) => (Some(sphere.radius), false),
            Shape::Primitive(AnyPrimitive::Cuboid(cuboid)) => (None, cuboid.round == 0.0),
            _ => (None, false),
        };
        Self {
            value: compile(node),
            tangent: is_convex.then(|| compile_convex(node, Level::Baseline)),
            bend: bend(node, region).filter(|_| !is_claimed && !is_convex),
            ranges: (!is_claimed).then(|| compile(node)),
            lipschitz: node.lipschitz_over(region),
            around: if is_claimed {
                Bounds::EVERYWHERE
            } else {
                node.sublevel(levels.above)
            },
            radius,
            levels,
            is_box,
        }
    }

    fn ask(&self, line: &Line) -> Told {
        let place = line.at(line.from);
        let value = (self.value)(&Vec3::new(place.x, place.y, place.z));
        // A unit of the way is as long as the direction here.
        let steepest = self.lipschitz * line.direction.length();
        let slope = self.slopes(line, value, steepest);
        let Levels { above, below } = self.levels;
        let by_constant = |over: f64| (over / steepest).max(0.0);
        Told {
            value,
            slope,
            above: by_constant(value - above).max(self.entered(line)),
            below: by_constant(-value - below).max(self.left(line, value)),
        }
    }

    /// The lines below and above the field.
    fn slopes(&self, line: &Line, value: f64, steepest: f64) -> [f64; 2] {
        let Line { from, reach, .. } = *line;
        if let Some(tangent) = &self.tangent {
            let here = tangent(&moving(line.at(from), line.direction));
            let end = line.at(from + reach);
            let chord = ((self.value)(&Vec3::new(end.x, end.y, end.z)) - value) / reach;
            // Where one is not a number, the constant says enough; in this order max and min then take the constant.
            return [here.partial[0].max(-steepest), chord.min(steepest)];
        }
        let Some(ranges) = &self.ranges else {
            return [-steepest, steepest];
        };
        let d = line.direction;
        let slope = ranges(&stretched(line.origin, d, [from, from + reach])).partial[0];
        let mut lines = [slope.lo.max(-steepest), slope.hi.min(steepest)];
        if let Some(([falls, rises], gradient)) = &self.bend {
            let p = line.at(from);
            let [x, y, z] = [p.x, p.y, p.z];
            let [x, y, z] = [(x, 0), (y, 1), (z, 2)].map(|(x, axis)| Dual::variable(x, axis));
            let here = DVec3::from_array(gradient(&Vec3::new(x, y, z)).partial).dot(d);
            // Half of the bend over the whole stretch, with room for the rounding of the slope itself.
            let half = 0.5 * reach * d.length_squared();
            let room = 64.0 * f64::EPSILON * steepest;
            lines[0] = lines[0].max(here - falls * half - room);
            lines[1] = lines[1].min(here + rises * half + room);
        }
        lines
    }

    /// How far the line is outside of what is below the level.
    fn entered(&self, line: &Line) -> f64 {
        let length = line.direction.length();
        let (place, way) = (line.at(line.from), line.direction / length);
        let free = match self.radius {
            Some(radius) => {
                let radius = radius + self.levels.above;
                ball(place, way, radius + doubt(place, radius)).0
            }
            None if self.around.is_empty() => f64::INFINITY,
            None => {
                let around = self.around.inflate(doubt(place, self.around.finite_size()));
                clip(place, way.recip(), &around, f64::INFINITY)
                    .map_or(f64::INFINITY, |(enter, _)| enter)
            }
        };
        shorter(free / length)
    }

    /// How far the line stays inside of a convex solid, deeper than the level.
    fn left(&self, line: &Line, value: f64) -> f64 {
        if value >= 0.0 {
            return 0.0;
        }
        let length = line.direction.length();
        let (place, way) = (line.at(line.from), line.direction / length);
        let depth = self.levels.below;
        let free = match self.radius {
            Some(radius) => {
                let (enter, leave) = ball(place, way, radius - depth - doubt(place, radius));
                if enter <= 0.0 { leave } else { 0.0 }
            }
            None if self.is_box && depth == 0.0 && self.levels.above == 0.0 => {
                let room = doubt(place, self.around.finite_size());
                clip(
                    place,
                    way.recip(),
                    &self.around.inflate(-room),
                    f64::INFINITY,
                )
                .filter(|(enter, _)| *enter == 0.0)
                .map_or(0.0, |(_, leave)| leave)
            }
            None => 0.0,
        };
        shorter(free / length)
    }
}

/// How much the slope of a field along lines through a region falls and rises at most, with its gradient; none where that is
/// not known.
fn bend(node: &Node, region: Bounds) -> Option<([f64; 2], Closure<Dual<f64, 3>>)> {
    if !region.is_finite() || region.is_empty() {
        return None;
    }
    let bent = bent(node, region);
    let bend = [-bent.low(), bent.high()];
    let is_known = bend.iter().all(|bend| bend.is_finite());
    is_known.then(|| (bend.map(|bend| bend.max(0.0)), compile(node)))
}

/// By how much a place on a line may be off beside something of this size: so closely it is not told whether the line passes by.
fn doubt(place: DVec3, size: f64) -> f64 {
    16.0 * f64::EPSILON * (place.length() + size)
}

/// A length less what rounding may have added to it; 0 for what is none.
fn shorter(length: f64) -> f64 {
    (length * (1.0 - ROUNDING)).max(0.0)
}

/// Where a line from `place` enters and leaves a ball about the origin: infinitely far where it does not meet it ahead.
fn ball(place: DVec3, way: DVec3, radius: f64) -> (f64, f64) {
    let centre = DVec3::ZERO;
    let (enter, leave, half_chord) = Ball { centre, radius }.roots(place, way);
    let is_met = radius > 0.0 && half_chord >= 0.0 && leave >= 0.0;
    if is_met {
        (enter, leave)
    } else {
        (f64::INFINITY, f64::NEG_INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyBlend, Circular, Cubic, Cuboid, Cylinder, Ellipsoid, Gyroid, Rotate, Scale, Smooth,
        Sphere, Torus, Translate, Twist,
    };
    use crate::num::samples::Samples;
    use crate::trace::Footprint;
    use std::sync::Arc;

    fn leaf(dice: &mut Samples) -> Arc<Node> {
        let mut size = || dice.uniform(0.2, 0.6);
        let (a, b, c) = (size(), size(), size());
        let primitive = match dice.below(7) {
            0 => AnyPrimitive::Sphere(Sphere::new(a)),
            1 => AnyPrimitive::Cuboid(Cuboid::new([a, b, c], 0.0)),
            2 => AnyPrimitive::Cuboid(Cuboid::new([a, b, c], 0.05)),
            3 => AnyPrimitive::Cylinder(Cylinder::new(a, b, 0.0)),
            4 => AnyPrimitive::Ellipsoid(Ellipsoid::new([a, b, c])),
            5 => AnyPrimitive::Torus(Torus::new(a + 0.2, 0.3 * b)),
            _ => AnyPrimitive::Gyroid(Gyroid::new(2.0 * a, 0.2 * b)),
        };
        let node = Node::primitive(primitive).unwrap();
        let twisted = AnyModifier::Twist(Twist::new(dice.uniform(-1.0, 1.0)));
        let is_twisted = dice.below(4) == 0;
        let node = match Node::modifier(twisted, node.clone()) {
            Ok(twisted) if is_twisted => twisted,
            _ => node,
        };
        placed(node, dice)
    }

    /// Moved, turned and scaled, or grown, or hollow.
    fn placed(node: Arc<Node>, dice: &mut Samples) -> Arc<Node> {
        let mut place = || dice.uniform(-0.7, 0.7);
        let shift = AnyModifier::Translate(Translate::new([place(), place(), place()]));
        let turn = AnyModifier::Rotate(Rotate::new(place(), [0.6, 0.0, 0.8], 0.0, 0.0, 0.0));
        let scale = AnyModifier::Scale(Scale::new([dice.uniform(0.7, 1.4); 3]));
        let last = match dice.below(4) {
            0 => AnyModifier::Offset(Offset::new(dice.uniform(-0.05, 0.1))),
            1 => AnyModifier::Shell(Shell::new(dice.uniform(0.05, 0.2))),
            _ => scale.clone(),
        };
        let steps = [shift, turn, scale, last];
        let step = |node, step| Node::modifier(step, node).unwrap();
        steps.into_iter().fold(node, step)
    }

    fn tree(height: usize, dice: &mut Samples) -> Arc<Node> {
        if height == 0 {
            return leaf(dice);
        }
        let width = dice.uniform(0.05, 0.3);
        let blend = match dice.below(4) {
            0 => AnyBlend::HARD,
            1 => AnyBlend::Smooth(Smooth::new(width)),
            2 => AnyBlend::Cubic(Cubic::new(width)),
            _ => AnyBlend::Circular(Circular::new(width)),
        };
        let operation = Operation::ALL[dice.below(3)].1;
        let children = (0..2 + dice.below(3))
            .map(|_| tree(height - 1, dice))
            .collect();
        let node = Node::combination(Combination { operation, blend }, children).unwrap();
        placed(node, dice)
    }

    /// A ray that comes near the middle, from outside or from inside.
    fn ray(dice: &mut Samples) -> Ray {
        let mut point = |size: f64| {
            let mut x = || dice.uniform(-size, size);
            DVec3::new(x(), x(), x())
        };
        let (from, to) = (point(2.0), point(0.7));
        Ray {
            origin: from,
            direction: (to - from).normalize(),
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        }
    }

    /// Lines enclose the field over their reach, and it keeps its sign as far as it is said to.
    #[test]
    fn lines_and_crossings_bound_the_field() {
        let region = Bounds::centred([10.0; 3]);
        let (mut longer, mut tighter, mut asked) = (0, 0, 0);
        for seed in 0..300 {
            let dice = &mut Samples::new(seed);
            let node = tree(dice.below(3), dice);
            let lipschitz = node.lipschitz_over(region);
            if !lipschitz.is_finite() {
                continue;
            }
            let probe = Probe::new(&node, region);
            let field = compile::<f64>(&node);
            for _ in 0..12 {
                let ray = ray(dice);
                let value = |t: f64| {
                    let p = ray.at(t);
                    field(&Vec3::new(p.x, p.y, p.z))
                };
                let (t, reach) = (dice.uniform(0.0, 1.5), dice.scaled(-2.0, 0.0).abs());
                let ahead = probe.ask(&ray, t, reach);
                let room = 1e-12 * (1.0 + lipschitz);
                assert!((ahead.value - value(t)).abs() <= room, "seed {seed}");
                asked += 1;
                longer += u32::from(ahead.free > 1.5 * ahead.value.abs() / lipschitz);
                tighter += u32::from(ahead.slope[1] - ahead.slope[0] < lipschitz);
                for k in 1..=24 {
                    let s = reach * f64::from(k) / 24.0;
                    let [low, high] = ahead.slope.map(|slope| ahead.value + slope * s);
                    let here = value(t + s);
                    let is_between = low - room <= here && here <= high + room;
                    assert!(
                        is_between,
                        "seed {seed}: {low} {here} {high} at {s} of {reach}"
                    );
                    let s = ahead.free.min(4.0) * f64::from(k) / 25.0;
                    let here = value(t + s) * ahead.value.signum();
                    assert!(here >= -room, "seed {seed}: {here} at {s} of {ahead:?}");
                }
            }
        }
        // They say more than the constant does.
        assert!(asked > 2000, "{asked}");
        assert!(4 * longer > asked, "{longer} of {asked} crossings");
        assert!(3 * tighter > 2 * asked, "{tighter} of {asked} lines");
    }

    /// Along a ray, what is convex lies on its tangent at first: so the line below a ball is its derivative.
    #[test]
    fn line_below_a_convex_field_is_its_tangent() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let probe = Probe::new(&ball, Bounds::centred([10.0; 3]));
        let ray = Ray {
            origin: DVec3::new(-3.0, 0.5, 0.0),
            direction: DVec3::X,
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        };
        let ahead = probe.ask(&ray, 0.0, 2.0);
        let far = 9.25f64.sqrt();
        assert!((ahead.slope[0] + 3.0 / far).abs() < 1e-15);
        assert!((ahead.slope[1] - (1.25f64.sqrt() - far) / 2.0).abs() < 1e-15);
        // The crossing is the closed form.
        assert!((ahead.free - (3.0 - 0.75f64.sqrt())).abs() < 1e-8);
    }
}
