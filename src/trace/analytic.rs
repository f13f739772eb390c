//! Ray entries in closed form: sphere, plane, box, triangle.

use super::Ray;
use crate::catalogue::{Bounds, Plane, Similarity, Sphere};
use glam::DVec3;

/// Half a unit in the last place of 1: the largest relative error of one operation in f64.
pub(super) const U: f64 = 0.5 * f64::EPSILON;

/// Where a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The distance along the ray.
    pub t: f64,
    /// A bound of its error, in scene units.
    pub error: f64,
}

/// A surface that rays enter in closed form.
pub trait ClosedForm {
    /// Where a half-line first crosses the surface in front of its origin, and a bound of the error of that; infinite where
    /// it does not. A crossing that the origin itself lies on does not count. Without branches where it serves in lanes.
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64);

    /// Whether a line may meet the surface: false only where it surely does not. Cheaper than a crossing.
    #[inline(always)]
    fn may_meet(&self, _origin: DVec3, _direction: DVec3) -> bool {
        true
    }

    /// The outward unit normal at a point of the surface; for a triangle that of its front, for a sheet without a front that
    /// against the direction of the ray.
    fn normal(&self, p: DVec3, direction: DVec3) -> DVec3;

    /// The first crossing in front of the ray's origin.
    fn enter(&self, ray: &Ray) -> Option<Crossing> {
        let (t, error) = self.crossing(ray.origin, ray.direction);
        (t < f64::INFINITY).then_some(Crossing { t, error })
    }
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre.
    pub centre: DVec3,
    /// The radius, positive.
    pub radius: f64,
}

impl Ball {
    /// The sphere that a map makes of one about the origin.
    pub(super) fn placed(sphere: &Sphere, map: &Similarity) -> Self {
        Self {
            centre: DVec3::from_array(map.outside([0.0; 3])),
            radius: sphere.radius * map.scale,
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds::centred([self.radius; 3]).translate(self.centre.to_array())
    }

    /// Both crossings of the line in order, and half their distance; not numbers where the line does not meet the sphere.
    #[inline(always)]
    pub(super) fn roots(&self, origin: DVec3, direction: DVec3) -> (f64, f64, f64) {
        let q = origin - self.centre;
        let b = q.dot(direction);
        let foot = q - direction * b;
        // (r - |foot|)(r + |foot|) loses nothing where they are close.
        let distance = foot.length();
        let h = (self.radius - distance) * (self.radius + distance);
        let half_chord = h.sqrt();
        let (near, far) = chord_ends(b, half_chord, self.radius, q.length());
        (near, far, half_chord)
    }

    /// A bound of the error of both crossings.
    #[inline(always)]
    pub(super) fn error(&self, origin: DVec3, half_chord: f64) -> f64 {
        let size = (origin - self.centre).length() + self.radius;
        chord_error(self.radius, half_chord, 8.0 * U * size)
    }

    /// The outward unit normal at a point of the surface.
    #[inline(always)]
    pub(super) fn outward(&self, p: DVec3) -> DVec3 {
        (p - self.centre).normalize()
    }

    /// Both crossings in order, where the line meets the sphere.
    fn crossings(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (near, far, half_chord) = self.roots(ray.origin, ray.direction);
        (half_chord >= 0.0).then_some((near, far))
    }
}

impl ClosedForm for Ball {
    #[inline(always)]
    fn normal(&self, p: DVec3, _: DVec3) -> DVec3 {
        self.outward(p)
    }

    /// The geometric form with a discriminant that does not cancel: h = r^2 - |q - (q.d) d|^2 with q the vector from
    /// the centre to the origin. Source: Haines et al., Ray Tracing Gems chapter 7.
    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let (near, far, half_chord) = self.roots(origin, direction);
        let size = (origin - self.centre).length() + self.radius;
        let error = self.error(origin, half_chord);
        let on_surface = 16.0 * U * size;
        let t = if near > on_surface { near } else { far };
        // Also where the roots are not numbers.
        let is_ahead = t > on_surface;
        (if is_ahead { t } else { f64::INFINITY }, error)
    }

    #[inline(always)]
    fn may_meet(&self, origin: DVec3, direction: DVec3) -> bool {
        let q = origin - self.centre;
        let foot = q - direction * q.dot(direction);
        let rounding = 64.0 * U * q.dot(q);
        let radius = self.radius * self.radius * (1.0 + 1e-9) + rounding;
        foot.dot(foot) <= radius
    }
}

/// Where a line comes into a circle or sphere of this `radius` and where it leaves it, in order: `along` is how far its origin
/// lies behind the foot of the perpendicular, `length` how far from the centre.
#[inline(always)]
pub(super) fn chord_ends(along: f64, half_chord: f64, radius: f64, length: f64) -> (f64, f64) {
    // The root of larger size by a sum that does not cancel, the other by their product |q|^2 - r^2.
    let large = -along - half_chord.copysign(along);
    let product = (length - radius) * (length + radius);
    let small = if large == 0.0 { 0.0 } else { product / large };
    // Not by the sign of `along`, which zero does not have.
    let is_near = large < 0.0;
    let near = if is_near { large } else { small };
    let far = if is_near { small } else { large };
    (near, far)
}

/// A bound of the error of these ends, where the foot of the perpendicular is known up to `place`.
#[inline(always)]
pub(super) fn chord_error(radius: f64, half_chord: f64, place: f64) -> f64 {
    // The square of the foot's distance is known to place * radius. Where the line is tangent, half the chord itself is known
    // to the root of that only.
    let tangent = (2.0 * radius * place).sqrt();
    let chord = if half_chord > tangent {
        half_chord
    } else {
        tangent
    };
    place * (1.0 + radius / chord)
}

/// The outward normal of the face that a point of the surface of a box about the origin lies on; of several, the first.
#[inline(always)]
pub(super) fn face(q: DVec3, half: DVec3) -> DVec3 {
    let outside = q.abs() - half;
    let is_second = outside.y > outside.x;
    let larger = if is_second { outside.y } else { outside.x };
    let is_third = outside.z > larger;
    let along = if is_second { q.y } else { q.x };
    let along = if is_third { q.z } else { along };
    let faces = [!is_second & !is_third, is_second & !is_third, is_third];
    DVec3::from_array(faces.map(|is| if is { 1.0 } else { 0.0 })) * along.signum()
}

/// The distances at which a line meets a sphere, by the geometric form of the textbook: the foot of the perpendicular
/// from the centre, then the right triangle with the radius as hypotenuse. The classical discriminant |q|^2 - (q.d)^2
/// cancels for small far spheres; here the foot itself is measured.
pub fn sphere_geometric(ray: &Ray, ball: &Ball) -> Option<(f64, f64)> {
    let to_centre = ball.centre - ray.origin;
    let along = to_centre.dot(ray.direction);
    let foot = to_centre - ray.direction * along;
    let squared = ball.radius * ball.radius - foot.length_squared();
    (squared >= 0.0).then(|| (along - squared.sqrt(), along + squared.sqrt()))
}

/// The distances at which a line meets a sphere, by the algebraic form of the textbook: the roots of
/// t^2 + 2 b t + c = 0, b = q.d, c = |q|^2 - r^2, with the stable quadratic formula and a stable discriminant.
pub fn sphere_algebraic(ray: &Ray, ball: &Ball) -> Option<(f64, f64)> {
    ball.crossings(ray)
}

/// A half-space `normal . p < offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// The outward unit normal.
    pub normal: DVec3,
    /// The distance of the plane from the origin along the normal.
    pub offset: f64,
}

impl HalfSpace {
    /// The half-space that a map makes of one.
    pub(super) fn placed(plane: &Plane, map: &Similarity) -> Self {
        let unit = plane.unit_normal();
        let normal = DVec3::from_array(map.outside_direction(unit)).normalize();
        let foot = DVec3::from_array(map.outside(unit.map(|c| c * plane.offset)));
        Self {
            normal,
            offset: normal.dot(foot),
        }
    }
}

impl ClosedForm for HalfSpace {
    #[inline(always)]
    fn normal(&self, _: DVec3, _: DVec3) -> DVec3 {
        self.normal
    }

    /// A parallel ray, and one that starts on the plane, has no crossing.
    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let slope = self.normal.dot(direction);
        let height = self.normal.dot(origin) - self.offset;
        let noise = 4.0 * U * (origin.abs().dot(self.normal.abs()) + self.offset.abs());
        let t = -height / slope;
        let error = noise / slope.abs() + 4.0 * U * t.abs();
        let is_ahead = (t > 0.0) & (height.abs() > noise);
        (if is_ahead { t } else { f64::INFINITY }, error)
    }
}

/// A box with faces across the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// The centre.
    pub centre: DVec3,
    /// Half the lengths of the sides, positive.
    pub half: DVec3,
}

impl Block {
    /// The box itself.
    pub fn bounds(&self) -> Bounds {
        Bounds::centred(self.half.to_array()).translate(self.centre.to_array())
    }
}

impl ClosedForm for Block {
    /// That of the face that the point lies on; of several, the first.
    #[inline(always)]
    fn normal(&self, p: DVec3, _: DVec3) -> DVec3 {
        face(p - self.centre, self.half)
    }

    /// A touch of an edge does not count. Source: Kay and Kajiya 1986.
    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut enter_error, mut leave_error) = (0.0, 0.0);
        for axis in 0..3 {
            let (centre, half) = (self.centre[axis], self.half[axis]);
            let q = origin[axis] - centre;
            let inverse = 1.0 / direction[axis];
            let (first, second) = ((-half - q) * inverse, (half - q) * inverse);
            let near = if first < second { first } else { second };
            let far = if first < second { second } else { first };
            // Not a number where the ray runs within a face, which is a touch: then nothing is entered.
            let near = if first <= second || second <= first {
                near
            } else {
                f64::INFINITY
            };
            let place = 4.0 * U * (origin[axis].abs() + centre.abs() + half) * inverse.abs();
            enter_error = if near > enter { place } else { enter_error };
            enter = if near > enter { near } else { enter };
            leave_error = if far < leave { place } else { leave_error };
            leave = if far < leave { far } else { leave };
        }
        let enter_error = enter_error + 4.0 * U * enter.abs();
        let leave_error = leave_error + 4.0 * U * leave.abs();
        let is_ahead = enter > enter_error;
        let t = if is_ahead { enter } else { leave };
        let error = if is_ahead { enter_error } else { leave_error };
        let is_met = enter < leave && t > error;
        (if is_met { t } else { f64::INFINITY }, error)
    }
}

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// The corners, counter-clockwise as seen from the front.
    pub corners: [DVec3; 3],
    /// The unit normal of the front.
    pub normal: DVec3,
    /// A ball around it.
    around: Ball,
}

impl Facet {
    /// The triangle with these corners.
    pub fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let centre = (a + b + c) / 3.0;
        let reach = |corner: DVec3| corner.distance(centre);
        Self {
            corners,
            normal: (b - a).cross(c - a).normalize_or_zero(),
            around: Ball {
                centre,
                radius: corners.map(reach).into_iter().fold(0.0, f64::max),
            },
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds::around(self.corners.map(|c| c.to_array()))
    }

    /// How far a point lies before its plane.
    #[inline(always)]
    fn height(&self, p: DVec3) -> f64 {
        (p - self.corners[0]).dot(self.normal)
    }
}

impl ClosedForm for Facet {
    #[inline(always)]
    fn may_meet(&self, origin: DVec3, direction: DVec3) -> bool {
        self.around.may_meet(origin, direction)
    }

    #[inline(always)]
    fn normal(&self, _: DVec3, _: DVec3) -> DVec3 {
        self.normal
    }

    /// Where the ray meets the plane, if that point is on the same side of every edge. The border belongs to the triangle, up
    /// to rounding, so that nothing leaks between neighbours.
    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let plane = HalfSpace {
            normal: self.normal,
            offset: self.normal.dot(self.corners[0]),
        };
        let (t, error) = plane.crossing(origin, direction);
        let p = origin + direction * t;
        let [a, b, c] = self.corners;
        let is_on = |from: DVec3, to: DVec3| {
            let (edge, arm) = (to - from, p - from);
            let noise =
                8.0 * U * edge.length() * (arm.length() + p.length()) + error * edge.length();
            edge.cross(arm).dot(self.normal) >= -noise
        };
        let is_inside = is_on(a, b) & is_on(b, c) & is_on(c, a);
        // A ray along the plane is told of no more than the others.
        let is_inside = is_inside & self.may_meet(origin, direction);
        (if is_inside { t } else { f64::INFINITY }, error)
    }
}

/// A sheet with four corners, made of two triangles. It has no front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// Its triangles.
    pub halves: [Facet; 2],
}

impl Pane {
    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        let [first, second] = self.halves;
        first.bounds().hull(second.bounds())
    }
}

impl ClosedForm for Pane {
    #[inline(always)]
    fn may_meet(&self, origin: DVec3, direction: DVec3) -> bool {
        let [first, second] = self.halves;
        first.may_meet(origin, direction) | second.may_meet(origin, direction)
    }

    /// Of the half in whose plane the point lies.
    #[inline(always)]
    fn normal(&self, p: DVec3, direction: DVec3) -> DVec3 {
        let [first, second] = self.halves;
        let is_first = first.height(p).abs() <= second.height(p).abs();
        let front = if is_first {
            first.normal
        } else {
            second.normal
        };
        let is_behind = front.dot(direction) > 0.0;
        if is_behind { -front } else { front }
    }

    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let [first, second] = self.halves;
        let (t, error) = first.crossing(origin, direction);
        let (other_t, other_error) = second.crossing(origin, direction);
        let is_first = t <= other_t;
        (
            if is_first { t } else { other_t },
            if is_first { error } else { other_error },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::random;
    use crate::trace::Footprint;

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray {
            origin: DVec3::from_array(origin),
            direction: DVec3::from_array(direction).normalize(),
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        }
    }

    #[test]
    fn both_forms_of_the_sphere_agree() {
        for seed in 0..100_000u64 {
            let x = |k: u64| 4.0 * random(seed * 16 + k) - 2.0;
            let ball = Ball {
                centre: DVec3::new(x(0), x(1), x(2)),
                radius: 0.1 + random(seed * 16 + 3),
            };
            let ray = ray([x(4) + 5.0, x(5), x(6)], [x(7) - 4.0, x(8), x(9)]);
            let foot = (ball.centre - ray.origin).cross(ray.direction).length();
            if (foot / ball.radius - 1.0).abs() < 1e-3 {
                continue; // tangent: the roots themselves are ill-conditioned
            }
            let (a, b) = (sphere_geometric(&ray, &ball), sphere_algebraic(&ray, &ball));
            assert_eq!(a.is_some(), b.is_some(), "seed {seed}");
            if let (Some(a), Some(b)) = (a, b) {
                let scale = a.0.abs().max(a.1.abs());
                assert!(
                    (a.0 - b.0).abs() <= 1e-12 * scale,
                    "seed {seed}: {a:?} {b:?}"
                );
                assert!(
                    (a.1 - b.1).abs() <= 1e-12 * scale,
                    "seed {seed}: {a:?} {b:?}"
                );
            }
        }
    }

    #[test]
    fn small_far_sphere_is_entered_where_the_textbook_form_is_noise() {
        let ball = Ball {
            centre: DVec3::ZERO,
            radius: 1e-6,
        };
        let t = ball
            .enter(&ray([1e3, 0.0, 0.0], [-1.0, 0.0, 0.0]))
            .map(|c| c.t);
        assert_eq!(t, Some(1e3 - 1e-6));
        assert_eq!(
            ball.enter(&ray([1e3, 1.01e-6, 0.0], [-1.0, 0.0, 0.0])),
            None
        );
        assert!(
            ball.enter(&ray([1e3, 0.99e-6, 0.0], [-1.0, 0.0, 0.0]))
                .is_some()
        );
    }

    #[test]
    fn ray_from_inside_leaves_the_sphere() {
        let ball = Ball {
            centre: DVec3::ZERO,
            radius: 1.0,
        };
        assert_eq!(
            ball.enter(&ray([0.0; 3], [0.0, 0.0, 1.0])).map(|c| c.t),
            Some(1.0)
        );
        // From the surface inwards: the whole chord; outwards: nothing.
        let chord = ball
            .enter(&ray([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]))
            .map(|c| c.t);
        assert_eq!(chord, Some(2.0));
        assert_eq!(ball.enter(&ray([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])), None);
    }

    #[test]
    fn boxes_are_entered_left_and_passed() {
        let block = Block {
            centre: DVec3::new(1.0, 0.0, 0.0),
            half: DVec3::new(1.0, 2.0, 3.0),
        };
        let t = |origin, direction| block.enter(&ray(origin, direction)).map(|c| c.t);
        assert_eq!(t([-3.0, 0.5, 0.5], [1.0, 0.0, 0.0]), Some(3.0));
        assert_eq!(
            t([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
            Some(3.0),
            "from inside"
        );
        assert_eq!(
            t([0.0, 0.5, 0.5], [1.0, 0.0, 0.0]),
            Some(2.0),
            "from a face inwards"
        );
        assert_eq!(
            t([0.0, 0.5, 0.5], [-1.0, 0.0, 0.0]),
            None,
            "from a face outwards"
        );
        assert_eq!(t([-3.0, 2.0, 0.5], [1.0, 0.0, 0.0]), None, "within a face");
        assert_eq!(t([-3.0, 2.5, 0.5], [1.0, 0.0, 0.0]), None, "beside");
        assert_eq!(t([-3.0, 0.5, 0.5], [-1.0, 0.0, 0.0]), None, "behind");
        let diagonal = t([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]);
        assert!((diagonal.unwrap() - 2f64.sqrt()).abs() < 1e-15);
        for (p, n) in [([0.0, 1.0, 1.0], DVec3::NEG_X), ([1.0, 2.0, 1.0], DVec3::Y)] {
            assert_eq!(block.normal(DVec3::from_array(p), DVec3::X), n);
        }
    }

    #[test]
    fn plane_misses_parallel_and_starting_rays() {
        let floor = HalfSpace {
            normal: DVec3::Y,
            offset: 0.0,
        };
        assert_eq!(floor.enter(&ray([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])), None);
        assert_eq!(floor.enter(&ray([0.0, 0.0, 0.0], [1.0, 1.0, 0.0])), None);
        assert_eq!(floor.enter(&ray([0.0, 1.0, 0.0], [0.0, 1.0, 0.0])), None);
        let grazing = 0.01f64.to_radians();
        let t = floor
            .enter(&ray([0.0, 1.0, 0.0], [grazing.cos(), -grazing.sin(), 0.0]))
            .map(|c| c.t);
        assert!((t.unwrap_or(0.0) * grazing.sin() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_leaks_between_two_triangles() {
        let [a, b] = [DVec3::new(-1.3, 0.1, 0.2), DVec3::new(1.1, 0.4, -0.3)];
        let (left, right) = (
            Facet::new([a, b, DVec3::new(0.0, 2.0, 0.7)]),
            Facet::new([b, a, DVec3::new(0.1, -2.0, 0.5)]),
        );
        let eye = DVec3::new(0.3, 0.2, 9.0);
        for i in 0..1_000_000u64 {
            let target = a + (b - a) * (0.001 + 0.998 * random(i));
            let through = ray(eye.to_array(), (target - eye).to_array());
            assert!(
                left.enter(&through).is_some() || right.enter(&through).is_some(),
                "ray {i}"
            );
        }
    }

    #[test]
    fn triangle_is_hit_inside_and_missed_outside() {
        let facet = Facet::new([DVec3::ZERO, DVec3::X, DVec3::Y]);
        let down = |x: f64, y: f64| {
            facet
                .enter(&ray([x, y, 2.0], [0.0, 0.0, -1.0]))
                .map(|c| c.t)
        };
        assert_eq!(down(0.25, 0.25), Some(2.0));
        assert_eq!(down(0.75, 0.75), None);
        assert_eq!(down(-0.01, 0.5), None);
    }
}
