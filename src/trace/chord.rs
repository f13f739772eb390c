//! Convex solids whose stretch on a ray is known in closed form.

use super::analytic::{Ball, HalfSpace, U, chord_ends, chord_error, face};
use super::vector::{select, unit_or};
use crate::catalogue::{AnyPrimitive, Similarity};
use glam::DVec3;

/// The stretch of a line in a convex solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chord {
    /// Where the line enters the solid; infinite where it does not.
    pub enter: f64,
    /// Where it leaves it.
    pub leave: f64,
    /// Bounds of the errors of both.
    pub errors: [f64; 2],
    /// Whether rounding decides if, or about where, the line meets the solid.
    pub is_doubtful: bool,
}

/// What is known of a place on a line only up to this share of the sizes at hand is in doubt.
const COARSE: f64 = 1e-9;

impl Chord {
    /// The stretch between two ends, in doubt where these can't be told apart, or are known in no useful way.
    #[inline(always)]
    fn between(enter: f64, leave: f64, errors: [f64; 2], is_doubtful: bool) -> Self {
        let both = errors[0] + errors[1];
        let is_clear = enter + both < leave;
        let is_missed = enter > leave + both;
        let is_coarse =
            |t: f64, error: f64| (error > COARSE * (1.0 + t.abs())) & (t.abs() < f64::INFINITY);
        let is_vague = is_coarse(enter, errors[0]) | is_coarse(leave, errors[1]);
        Self {
            enter: if enter < leave { enter } else { f64::INFINITY },
            leave,
            errors,
            is_doubtful: is_doubtful | (!is_clear & !is_missed) | (is_vague & !is_missed),
        }
    }

    /// What two stretches have in common.
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let enter = if b.enter > a.enter { b.enter } else { a.enter };
        let leave = if b.leave < a.leave { b.leave } else { a.leave };
        // Of the two ends that which counts; both where either may.
        let error = |a: f64, b: f64, [ea, eb]: [f64; 2], is_second: bool| {
            let is_close = (a - b).abs() <= ea + eb;
            let larger = if ea > eb { ea } else { eb };
            let own = if is_second { eb } else { ea };
            if is_close { larger } else { own }
        };
        let errors = [
            error(
                a.enter,
                b.enter,
                [a.errors[0], b.errors[0]],
                b.enter > a.enter,
            ),
            error(
                a.leave,
                b.leave,
                [a.errors[1], b.errors[1]],
                b.leave < a.leave,
            ),
        ];
        Self::between(enter, leave, errors, a.is_doubtful | b.is_doubtful)
    }

    /// The stretch in two solids that are convex together, of which each has a stretch or none.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let leave = |chord: &Self| {
            if chord.enter < f64::INFINITY {
                chord.leave
            } else {
                f64::NEG_INFINITY
            }
        };
        let (left, right) = (leave(&a), leave(&b));
        let is_first = a.enter < b.enter;
        let is_last = left > right;
        let larger = |k: usize| {
            if a.errors[k] > b.errors[k] {
                a.errors[k]
            } else {
                b.errors[k]
            }
        };
        let error = |k: usize, is_own: bool, is_close: bool| {
            let own = if is_own { a.errors[k] } else { b.errors[k] };
            if is_close { larger(k) } else { own }
        };
        let is_close = |gap: f64, k: usize| gap.abs() <= a.errors[k] + b.errors[k];
        Self {
            enter: if is_first { a.enter } else { b.enter },
            leave: if is_last { left } else { right },
            errors: [
                error(0, is_first, is_close(a.enter - b.enter, 0)),
                error(1, is_last, is_close(left - right, 1)),
            ],
            is_doubtful: a.is_doubtful | b.is_doubtful,
        }
    }
}

/// A convex solid.
pub(super) trait Solid {
    /// The stretch of a line in it. Without branches, to serve in lanes.
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord;

    /// The outward unit normal at a point of its surface. Without branches, to serve in lanes.
    fn normal(&self, p: DVec3) -> DVec3;
}

impl Solid for Ball {
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let (near, far, half_chord) = self.roots(origin, direction);
        let error = self.error(origin, half_chord);
        let is_met = half_chord >= 0.0;
        // A line that passes by as closely as rounding may meet it.
        let q = origin - self.centre;
        let gap = (q - direction * q.dot(direction)).length() - self.radius;
        let is_close = !is_met & (gap <= 16.0 * U * (q.length() + self.radius));
        let enter = if is_met { near } else { f64::INFINITY };
        let leave = if is_met { far } else { f64::NEG_INFINITY };
        Chord::between(enter, leave, [error; 2], is_close)
    }

    #[inline(always)]
    fn normal(&self, p: DVec3) -> DVec3 {
        self.outward(p)
    }
}

impl Solid for HalfSpace {
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let size = origin.abs().dot(self.normal.abs()) + self.offset.abs();
        let height = self.normal.dot(origin) - self.offset;
        slab_end(height, self.normal.dot(direction), 8.0 * U * size)
    }

    #[inline(always)]
    fn normal(&self, _: DVec3) -> DVec3 {
        self.normal
    }
}

/// The stretch of a line below the level 0 on which it starts at this `height` and rises at this `slope`; both are known up to
/// `place`, for a unit of distance.
#[inline(always)]
fn slab_end(height: f64, slope: f64, place: f64) -> Chord {
    let t = -height / slope;
    let error = place / slope.abs() + 4.0 * U * t.abs();
    let (rises, falls) = (slope > 0.0, slope < 0.0);
    let is_level = !(rises | falls);
    // A level line is below all the way or nowhere.
    let below = if height < 0.0 {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    let enter = if falls { t } else { f64::NEG_INFINITY };
    Chord {
        enter: if is_level { below } else { enter },
        leave: if rises { t } else { f64::INFINITY },
        errors: [
            if falls { error } else { 0.0 },
            if rises { error } else { 0.0 },
        ],
        is_doubtful: is_level & (height.abs() <= place),
    }
}

/// A place and orientation: lengths stay as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// The axes, of length 1, as seen from outside.
    axes: [DVec3; 3],
    /// What is added to each coordinate.
    shift: DVec3,
}

impl Frame {
    /// The frame of a map, whose own coordinates are in the outside's lengths.
    pub(super) fn new(map: &Similarity) -> Self {
        Self {
            axes: map.rows.map(|row| DVec3::from_array(row) * map.scale),
            shift: DVec3::from_array(map.shift) * map.scale,
        }
    }

    /// A place in the frame.
    #[inline(always)]
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        self.turned(p) + self.shift
    }

    /// A direction in the frame.
    #[inline(always)]
    pub(super) fn turned(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        DVec3::new(x.dot(v), y.dot(v), z.dot(v))
    }

    /// A direction of the frame as seen from outside.
    #[inline(always)]
    pub(super) fn outside(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        x * v.x + y * v.y + z * v.z
    }

    /// A bound of the rounding of a place's coordinates, and of others up to `extent`.
    #[inline(always)]
    pub(super) fn noise(&self, origin: DVec3, extent: f64) -> f64 {
        let size = origin.abs() + self.shift.abs();
        16.0 * U * (size.x + size.y + size.z + extent)
    }
}

/// A box in any orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Brick {
    frame: Frame,
    half: DVec3,
}

impl Solid for Brick {
    /// Source: Kay and Kajiya 1986.
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let (o, d) = (self.frame.place(origin), self.frame.turned(direction));
        let noise = self
            .frame
            .noise(origin, self.half.x + self.half.y + self.half.z);
        let chord = slab(o.x, d.x, self.half.x, noise).and(slab(o.y, d.y, self.half.y, noise));
        chord.and(slab(o.z, d.z, self.half.z, noise))
    }

    #[inline(always)]
    fn normal(&self, p: DVec3) -> DVec3 {
        self.frame.outside(face(self.frame.place(p), self.half))
    }
}

/// The stretch of a line between -half and half of a coordinate.
#[inline(always)]
fn slab(o: f64, d: f64, half: f64, noise: f64) -> Chord {
    slab_end(o - half, d, noise).and(slab_end(-o - half, -d, noise))
}

/// A round bar with flat ends, in any orientation; it may have no ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bar {
    /// Its axis is y.
    frame: Frame,
    radius: f64,
    half: f64,
}

impl Bar {
    /// The stretch of a line in the bar without its ends, given in the bar's coordinates, with their rounding.
    ///
    /// The geometric form with a discriminant that does not cancel, as of the sphere, across the axis. Source: Haines et
    /// al., Ray Tracing Gems chapter 7.
    #[inline(always)]
    fn endless(&self, o: DVec3, d: DVec3, noise: f64) -> Chord {
        let run = (d.x * d.x + d.z * d.z).sqrt();
        let is_along = run < 1e-12;
        let scale = 1.0 / if is_along { 1.0 } else { run };
        let (x, z) = (d.x * scale, d.z * scale);
        let along = o.x * x + o.z * z;
        let aside = (o.x * z - o.z * x).abs();
        let h = (self.radius - aside) * (self.radius + aside);
        let half_chord = h.sqrt();
        let error = chord_error(self.radius, half_chord, noise) * scale;
        let length = (o.x * o.x + o.z * o.z).sqrt();
        let (near, far) = chord_ends(along, half_chord, self.radius, length);
        let is_met = half_chord >= 0.0;
        let is_inside = length < self.radius;
        let around = if is_inside {
            f64::NEG_INFINITY
        } else {
            f64::INFINITY
        };
        let crossed = if is_met { near * scale } else { f64::INFINITY };
        let left = if is_met {
            far * scale
        } else {
            f64::NEG_INFINITY
        };
        let gap = if is_along {
            (length - self.radius).abs()
        } else {
            aside - self.radius
        };
        let rounding = error + 4.0 * U * (far * scale).abs();
        let error = if is_along | !is_met { 0.0 } else { rounding };
        Chord::between(
            if is_along { around } else { crossed },
            if is_along { f64::INFINITY } else { left },
            [error; 2],
            (is_along | !is_met) & (gap <= noise),
        )
    }
}

impl Solid for Bar {
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let (o, d) = (self.frame.place(origin), self.frame.turned(direction));
        let noise = self.frame.noise(origin, self.radius);
        let round = self.endless(o, d, noise);
        let ends = slab(o.y, d.y, self.half, noise + 4.0 * U * self.half);
        let both = round.and(ends);
        let has_ends = self.half < f64::INFINITY;
        Chord {
            enter: if has_ends { both.enter } else { round.enter },
            leave: if has_ends { both.leave } else { round.leave },
            errors: [0, 1].map(|k: usize| {
                if has_ends {
                    both.errors[k]
                } else {
                    round.errors[k]
                }
            }),
            is_doubtful: if has_ends {
                both.is_doubtful
            } else {
                round.is_doubtful
            },
        }
    }

    #[inline(always)]
    fn normal(&self, p: DVec3) -> DVec3 {
        let q = self.frame.place(p);
        let round = DVec3::new(q.x, 0.0, q.z);
        let is_end = q.y.abs() - self.half > round.length() - self.radius;
        let end = DVec3::new(0.0, q.y.signum(), 0.0);
        let normal = select(is_end, end, unit_or(round, DVec3::ZERO));
        self.frame.outside(normal)
    }
}

/// A round bar with half balls as ends, in any orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pill {
    /// The part between the balls.
    bar: Bar,
    /// The balls.
    ends: [Ball; 2],
}

impl Solid for Pill {
    /// The bar between the balls, and both of them: where one ends within another does not matter.
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let [low, high] = &self.ends;
        let ends = low.chord(origin, direction);
        let ends = ends.or(high.chord(origin, direction));
        let bar = self.bar.chord(origin, direction);
        bar.or(ends)
    }

    #[inline(always)]
    fn normal(&self, p: DVec3) -> DVec3 {
        let Bar { frame, half, .. } = &self.bar;
        let q = frame.place(p);
        // The nearest point of the axis between the centres of the balls.
        let low = if q.y < -half { -half } else { q.y };
        let middle = DVec3::new(0.0, if low > *half { *half } else { low }, 0.0);
        frame.outside(unit_or(q - middle, DVec3::ZERO))
    }
}

/// An ellipsoid in any orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Oval {
    frame: Frame,
    /// The reciprocals of the semi-axes.
    inverse: DVec3,
    /// The longest semi-axis.
    reach: f64,
    /// The reciprocal of the shortest.
    steepness: f64,
}

impl Solid for Oval {
    /// As of the unit ball, in coordinates in which it is one.
    #[inline(always)]
    fn chord(&self, origin: DVec3, direction: DVec3) -> Chord {
        let o = self.frame.place(origin) * self.inverse;
        let d = self.frame.turned(direction) * self.inverse;
        let scale = 1.0 / d.length();
        let unit = Ball {
            centre: DVec3::ZERO,
            radius: 1.0,
        };
        let d = d * scale;
        let (near, far, half_chord) = unit.roots(o, d);
        let place = self.frame.noise(origin, self.reach) * self.steepness + 16.0 * U * o.length();
        let error = chord_error(1.0, half_chord, place) * scale;
        let is_met = half_chord >= 0.0;
        let gap = (o - d * o.dot(d)).length() - 1.0;
        let is_close = !is_met & (gap <= 2.0 * place);
        let (near, far) = (near * scale, far * scale);
        let enter = if is_met { near } else { f64::INFINITY };
        let leave = if is_met { far } else { f64::NEG_INFINITY };
        let errors = [near, far].map(|t| {
            if is_met {
                error + 4.0 * U * t.abs()
            } else {
                0.0
            }
        });
        Chord::between(enter, leave, errors, is_close)
    }

    #[inline(always)]
    fn normal(&self, p: DVec3) -> DVec3 {
        let q = self.frame.place(p);
        let normal = (q * self.inverse) * self.inverse;
        self.frame.outside(unit_or(normal, DVec3::ZERO))
    }
}

/// A convex solid with a closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Convex {
    Ball(Ball),
    HalfSpace(HalfSpace),
    Brick(Brick),
    Bar(Bar),
    Pill(Pill),
    Oval(Oval),
}

/// Evaluates an expression in which the solid inside is bound to a name.
macro_rules! with_solid {
    ($any:expr, $bound:ident => $body:expr) => {
        match $any {
            $crate::trace::chord::Convex::Ball($bound) => $body,
            $crate::trace::chord::Convex::HalfSpace($bound) => $body,
            $crate::trace::chord::Convex::Brick($bound) => $body,
            $crate::trace::chord::Convex::Bar($bound) => $body,
            $crate::trace::chord::Convex::Pill($bound) => $body,
            $crate::trace::chord::Convex::Oval($bound) => $body,
        }
    };
}
pub(super) use with_solid;

impl Convex {
    /// The solid that a primitive is under a map; none if it has no closed form.
    pub fn of(primitive: &AnyPrimitive, map: &Similarity) -> Option<Self> {
        let frame = Frame::new(map);
        let solid = match primitive {
            AnyPrimitive::Sphere(s) => Self::Ball(Ball::placed(s, map)),
            AnyPrimitive::Plane(p) => Self::HalfSpace(HalfSpace::placed(p, map)),
            AnyPrimitive::Cuboid(b) if b.round == 0.0 => Self::Brick(Brick {
                frame,
                half: DVec3::from_array(b.size) * (0.5 * map.scale),
            }),
            AnyPrimitive::Cylinder(c) if c.round == 0.0 => Self::Bar(Bar {
                frame,
                radius: c.radius * map.scale,
                half: 0.5 * c.height * map.scale,
            }),
            AnyPrimitive::Capsule(c) => {
                let straight = 0.5 * c.height - c.radius;
                let radius = c.radius * map.scale;
                // What is hardly longer than a ball has hardly a middle.
                if straight < 1e-3 * c.radius {
                    return None;
                }
                let end = |y: f64| Ball {
                    centre: DVec3::from_array(map.outside([0.0, y, 0.0])),
                    radius,
                };
                Self::Pill(Pill {
                    bar: Bar {
                        frame,
                        radius,
                        half: straight * map.scale,
                    },
                    ends: [end(-straight), end(straight)],
                })
            }
            AnyPrimitive::Ellipsoid(e) => {
                let radii = DVec3::from_array(e.radii) * map.scale;
                Self::Oval(Oval {
                    frame,
                    inverse: radii.recip(),
                    reach: radii.max_element(),
                    steepness: 1.0 / radii.min_element(),
                })
            }
            _ => return None,
        };
        Some(solid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyModifier, Capsule, Cuboid, Cylinder, Ellipsoid, Plane, Rotate, Scale, Sphere, Translate,
    };
    use crate::num::Vec3;
    use crate::num::samples::random;
    use crate::scene::{Node, Shape};
    use std::sync::Arc;

    /// A leaf of some kind, turned, scaled and moved.
    fn leaf(seed: u64) -> Arc<Node> {
        let x = |k: u64| random(seed * 64 + k);
        let primitive = match seed % 7 {
            0 => AnyPrimitive::Sphere(Sphere::new(0.2 + x(0))),
            1 => AnyPrimitive::Cuboid(Cuboid::new([0.2 + x(0), 0.2 + x(1), 0.2 + x(2)], 0.0)),
            2 => AnyPrimitive::Cylinder(Cylinder::new(0.2 + x(0), 0.3 + x(1), 0.0)),
            3 => AnyPrimitive::Cylinder(Cylinder::new(0.2 + x(0), f64::INFINITY, 0.0)),
            4 => AnyPrimitive::Capsule(Capsule::new(0.2 + 0.5 * x(0), 1.5 + x(1))),
            5 => AnyPrimitive::Ellipsoid(Ellipsoid::new([0.2 + x(0), 0.2 + x(1), 0.2 + x(2)])),
            _ => AnyPrimitive::Plane(Plane::new([x(0) - 0.5, x(1) - 0.5, 1.0], x(2) - 0.5)),
        };
        let turn = AnyModifier::Rotate(Rotate::new(
            6.0 * x(10),
            [x(11) - 0.5, x(12) - 0.5, 0.3],
            0.0,
            0.0,
            0.0,
        ));
        let scale = AnyModifier::Scale(Scale::new([0.5 + x(20); 3]));
        let shift =
            AnyModifier::Translate(Translate::new([0, 1, 2].map(|k| 2.0 * x(30 + k) - 1.0)));
        let node = Node::primitive(primitive).unwrap();
        [turn, scale, shift]
            .into_iter()
            .fold(node, |node, m| Node::modifier(m, node).unwrap())
    }

    #[test]
    fn fields_are_negative_on_chords_and_zero_at_their_ends() {
        let (mut met, mut doubts) = (0, 0);
        for seed in 0..4000u64 {
            let node = leaf(seed);
            let (map, inner) = node.unplaced();
            let Shape::Primitive(primitive) = inner.shape() else {
                panic!("a leaf is a primitive");
            };
            let solid = Convex::of(primitive, &map).unwrap();
            let x = |k: u64| random(seed * 64 + 40 + k);
            let origin = DVec3::new(x(0) - 0.5, x(1) - 0.5, x(2) - 0.5) * 6.0;
            let target = DVec3::new(x(3) - 0.5, x(4) - 0.5, x(5) - 0.5);
            let direction = (target - origin).normalize();
            let chord = with_solid!(&solid, s => s.chord(origin, direction));
            let field = |t: f64| {
                let p = origin + direction * t;
                node.evaluate(&Vec3::new(p.x, p.y, p.z))
            };
            let Chord {
                enter,
                leave,
                errors,
                is_doubtful,
            } = chord;
            doubts += usize::from(is_doubtful);
            if enter == f64::INFINITY {
                // Nowhere inside, as far as samples tell.
                assert!(
                    (0..100).all(|k| field(f64::from(k) * 0.1 - 5.0) > -1e-9),
                    "seed {seed}"
                );
                continue;
            }
            met += 1;
            let ends = [(enter, errors[0]), (leave, errors[1])];
            for (end, error) in ends.into_iter().filter(|(t, _)| t.is_finite()) {
                let value = field(end).abs();
                assert!(
                    value <= error + 1e-14,
                    "seed {seed}: {value} at {end}, error {error}"
                );
                let p = origin + direction * end;
                let h = 1e-6;
                let rate = |axis: DVec3| {
                    let at = |s: f64| {
                        let q = p + axis * s;
                        node.evaluate(&Vec3::new(q.x, q.y, q.z))
                    };
                    (at(h) - at(-h)) / (2.0 * h)
                };
                let gradient = DVec3::new(rate(DVec3::X), rate(DVec3::Y), rate(DVec3::Z));
                // Near an edge differences see both faces.
                if (gradient.length() - 1.0).abs() < 1e-9 {
                    let normal = with_solid!(&solid, solid => Solid::normal(solid, p));
                    assert!(
                        normal.abs_diff_eq(gradient, 1e-5),
                        "seed {seed}: {normal}, {gradient}"
                    );
                }
            }
            let inside = 0.5 * (enter.max(-1e3) + leave.min(1e3));
            assert!(field(inside) < 1e-12, "seed {seed}");
            for outside in [enter - 1e-3, leave + 1e-3]
                .into_iter()
                .filter(|t| t.is_finite())
            {
                assert!(field(outside) > 0.0, "seed {seed}");
            }
        }
        assert!(met > 1500, "{met}");
        assert!(doubts < 4, "{doubts}");
    }
}
