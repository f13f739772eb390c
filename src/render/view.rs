//! The camera's rays.
//!
//! Pixel (i, j) of a W x H picture lies on the screen at `x = s 2 (i - (W-1)/2) / (W-1)`, `y = t 2 ((H-1)/2 - j) / (H-1)`
//! with `t = tan(fov/2)` and `s/t = (W-1)/(H-1)`, so that the centres of the outermost pixels lie on its edges. A
//! picture of one column or row has it in the middle.

use super::area::Area;
use crate::field::{Level, Task, run_at};
use crate::scene::{Camera, Projection};
use crate::trace::{Beam, Footprint, Ray, Rays};
use glam::DVec3;

/// A camera in front of a grid of pixels.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    is_parallel: bool,
    /// The middle of the picture, in pixels.
    middle: [f64; 2],
    /// The width and height of a pixel on the screen.
    pixel: [f64; 2],
    /// The instructions that lanes use.
    level: Level,
}

impl View {
    /// The view of `camera` on a picture of `size` (width and height in pixels).
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let [right, up, forward] = axes(camera);
        Self {
            eye: camera.eye,
            right,
            up,
            forward,
            is_parallel: matches!(camera.projection, Projection::Orthographic { .. }),
            middle: size.map(|n| (f64::from(n) - 1.0) / 2.0),
            pixel: camera.pixel(size),
            level: Level::best(),
        }
    }

    /// The place on the screen of column `i` and row `j`, which may lie between pixels: in units of the distance to the
    /// screen for a perspective, in scene units otherwise.
    #[inline(always)]
    pub fn screen(&self, i: f64, j: f64) -> [f64; 2] {
        [
            self.pixel[0] * (i - self.middle[0]),
            self.pixel[1] * (self.middle[1] - j),
        ]
    }

    /// The ray through column `i` and row `j`, which may lie between pixels.
    pub fn ray(&self, i: f64, j: f64) -> Ray {
        let [x, y] = self.screen(i, j);
        let (origin, direction) = self.line(x, y);
        Ray {
            origin,
            direction,
            t_max: f64::INFINITY,
            footprint: self.footprint(),
        }
    }

    /// The rays through the middles of these pixels, each a column and a row: as [`View::ray`], to the bit.
    pub fn rays(&self, pixels: &[[u32; 2]]) -> Rays {
        let mut rays = Rays::default();
        self.aim(pixels, |_| [0.0; 2], &mut rays);
        rays
    }

    /// As [`View::rays`], but so far `aside` of the middle of each pixel, in pixels; what was in `rays` before is forgotten.
    pub fn aim(&self, pixels: &[[u32; 2]], aside: impl Fn([u32; 2]) -> [f64; 2], rays: &mut Rays) {
        rays.resize(pixels.len());
        let Footprint { at_origin, spread } = self.footprint();
        let [.., ends, widths, spreads] = rays.columns_mut();
        ends.fill(f64::INFINITY);
        widths.fill(at_origin);
        spreads.fill(spread);
        let lines = Lines {
            view: self,
            pixels,
            aside,
            rays,
        };
        run_at(self.level, lines);
    }

    /// What holds all rays through the pixels of an area: their whole squares.
    pub fn beam(&self, area: &Area) -> Beam {
        let Area { corner, end } = area;
        let side = |pixel: u32| f64::from(pixel) - 0.5;
        let (mut origins, mut directions) = ([self.eye; 2], [self.forward; 2]);
        let aside = if self.is_parallel {
            &mut origins
        } else {
            &mut directions
        };
        // The mean of two corners, and how far the plane through all four goes from it along each axis.
        let [left, top] = self.screen(side(corner[0]), side(corner[1]));
        let [right, bottom] = self.screen(side(end[0]), side(end[1]));
        let [x, y] = [(left, right), (bottom, top)]
            .map(|(low, high)| (0.5 * (low + high), 0.5 * (high - low)));
        let middle = aside[0] + self.right * x.0 + self.up * y.0;
        let half = (self.right * x.1).abs() + (self.up * y.1).abs();
        // Room for the rounding of places on the screen and of what is normalised.
        let size = aside[0].length() + left.abs().max(right.abs()) + top.abs().max(bottom.abs());
        let half = half + DVec3::splat(1e-12 * size);
        *aside = [middle - half, middle + half];
        Beam::within(origins, directions)
    }

    /// Where the ray through a place of the screen starts and goes.
    #[inline(always)]
    fn line(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let aside = self.right * x + self.up * y;
        if self.is_parallel {
            (self.eye + aside, self.forward)
        } else {
            (self.eye, (self.forward + aside).normalize())
        }
    }

    /// How wide pixels are: the narrower side is what details are measured by.
    fn footprint(&self) -> Footprint {
        let width = self.pixel[0].min(self.pixel[1]);
        let (at_origin, spread) = if self.is_parallel {
            (width, 0.0)
        } else {
            (0.0, width)
        };
        Footprint { at_origin, spread }
    }
}

/// Finds where rays start and go.
struct Lines<'a, F> {
    view: &'a View,
    /// Through which columns and rows.
    pixels: &'a [[u32; 2]],
    /// And how far aside of their middles.
    aside: F,
    rays: &'a mut Rays,
}

impl<F: Fn([u32; 2]) -> [f64; 2]> Task for Lines<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let n = self.pixels.len();
        let [ox, oy, oz, dx, dy, dz, ..] = self.rays.columns_mut();
        let (ox, oy, oz) = (&mut ox[..n], &mut oy[..n], &mut oz[..n]);
        let (dx, dy, dz) = (&mut dx[..n], &mut dy[..n], &mut dz[..n]);
        for (i, pixel) in self.pixels.iter().enumerate() {
            let (middle, aside) = (pixel.map(f64::from), (self.aside)(*pixel));
            let [x, y] = self.view.screen(middle[0] + aside[0], middle[1] + aside[1]);
            let (origin, direction) = self.view.line(x, y);
            (ox[i], oy[i], oz[i]) = (origin.x, origin.y, origin.z);
            (dx[i], dy[i], dz[i]) = (direction.x, direction.y, direction.z);
        }
    }
}

/// Right, up and forward: unit vectors at right angles. An `up` along the line of sight gives no direction; then the axis
/// that is farthest from it does. A camera that looks at its own place looks along -z.
fn axes(camera: &Camera) -> [DVec3; 3] {
    let forward = (camera.at - camera.eye)
        .try_normalize()
        .unwrap_or(DVec3::NEG_Z);
    let side = |up: DVec3| forward.cross(up.normalize_or_zero());
    // Below a part in 10^12 of the lengths, the cross product is rounding.
    let is_aligned = |side: DVec3| side.length_squared() < 1e-24 || side.is_nan();
    let across = match side(camera.up) {
        across if is_aligned(across) => {
            let steepest = forward.abs();
            if steepest.y <= steepest.z {
                side(DVec3::Y)
            } else {
                side(DVec3::NEG_Z)
            }
        }
        across => across,
    };
    let right = across.normalize();
    [right, right.cross(forward), forward]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyModifier, AnyPrimitive, Plane, Sphere, Translate};
    use crate::num::samples::random;
    use crate::scene::{Node, Scene};
    use crate::trace::{Verdict, Visibility, World};
    use std::sync::Arc;

    fn moved(primitive: AnyPrimitive, by: DVec3) -> Arc<Node> {
        let shape = Node::primitive(primitive).expect("a valid primitive");
        let by = AnyModifier::Translate(Translate::new(by.to_array()));
        Node::modifier(by, shape).expect("a valid modifier")
    }

    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(0.0, 0.0, 5.0),
            at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective {
                fov: 90f64.to_radians(),
            },
            screen: None,
        }
    }

    fn near(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).abs() < 1e-14 && (a[1] - b[1]).abs() < 1e-14
    }

    #[test]
    fn corner_pixels_lie_on_the_corners_of_the_screen() {
        let view = View::new(&camera(), [641, 361]);
        let s = 640.0 / 360.0;
        assert!(near(view.screen(0.0, 0.0), [-s, 1.0]));
        assert!(near(view.screen(640.0, 0.0), [s, 1.0]));
        assert!(near(view.screen(0.0, 360.0), [-s, -1.0]));
        assert!(near(view.screen(640.0, 360.0), [s, -1.0]));
        assert!(near(view.screen(320.0, 180.0), [0.0, 0.0]));
    }

    #[test]
    fn the_scripts_screen_takes_the_place_of_the_angle() {
        let view = View::new(
            &Camera {
                screen: Some([0.75, 0.5]),
                ..camera()
            },
            [100, 100],
        );
        assert!(near(view.screen(99.0, 0.0), [0.75, 0.5]));
    }

    #[test]
    fn single_rows_and_columns_are_in_the_middle() {
        for size in [[1, 1], [1, 8], [8, 1]] {
            let view = View::new(&camera(), size);
            let [x, y] = view.screen(0.0, 0.0);
            assert!(size[0] > 1 || x == 0.0);
            assert!(size[1] > 1 || y == 0.0);
            assert!(view.ray(0.0, 0.0).direction.is_normalized());
        }
    }

    #[test]
    fn rays_diverge_by_the_angle_of_view() {
        let view = View::new(&camera(), [101, 101]);
        let (top, bottom) = (view.ray(50.0, 0.0), view.ray(50.0, 100.0));
        assert!(
            top.direction.dot(bottom.direction).abs() < 1e-15,
            "90 degrees"
        );
        assert!(top.direction.y > 0.0);
        assert!(view.ray(100.0, 50.0).direction.x > 0.0);
        assert!(
            view.ray(50.0, 50.0)
                .direction
                .abs_diff_eq(DVec3::NEG_Z, 1e-15)
        );
    }

    #[test]
    fn parallel_rays_start_a_screen_apart() {
        let view = View::new(
            &Camera {
                projection: Projection::Orthographic { height: 4.0 },
                ..camera()
            },
            [201, 101],
        );
        let (low, high) = (view.ray(0.0, 100.0), view.ray(200.0, 0.0));
        assert_eq!(low.direction, high.direction);
        assert!((high.origin - low.origin).abs_diff_eq(DVec3::new(8.0, 4.0, 0.0), 1e-14));
        assert_eq!(low.footprint.at(0.0), low.footprint.at(1e6));
    }

    #[test]
    fn footprint_is_the_distance_between_neighbours() {
        let view = View::new(&camera(), [101, 101]);
        let (a, b) = (view.ray(50.0, 50.0), view.ray(51.0, 50.0));
        let apart = (a.at(3.0) - b.at(3.0)).length();
        assert!((a.footprint.at(3.0) / apart - 1.0).abs() < 1e-3);
    }

    #[test]
    fn what_a_ray_meets_the_beam_of_its_pixels_may_meet() {
        let (mut met, mut empty) = (0, 0);
        for seed in 0..600u64 {
            let x = |k: u64| random(seed * 97 + k);
            let corner = |k: u64| DVec3::new(x(k), x(k + 1), x(k + 2)) * 2.0 - DVec3::ONE;
            let projection = if seed % 3 == 0 {
                Projection::Orthographic { height: 4.0 }
            } else {
                Projection::Perspective {
                    fov: 0.2 + 2.0 * x(9),
                }
            };
            let eye = 3.0 * corner(0);
            let (at, up) = (corner(3), corner(6));
            let view = View::new(
                &Camera {
                    eye,
                    at,
                    up,
                    projection,
                    screen: None,
                },
                [90, 60],
            );
            // A ball on the border of a ray through some of the pixels, a half-space behind it.
            let first = [60.0 * x(10), 40.0 * x(11)].map(|x| x as u32);
            let area = Area {
                corner: first,
                end: [first[0] + 16, first[1] + 5],
            };
            let through = |k: u64| {
                let [i, j] = [0, 1].map(|axis| {
                    let width = f64::from(area.size()[axis]);
                    f64::from(first[axis]) - 0.5 + width * x(20 + 2 * k + axis as u64)
                });
                view.ray(i, j)
            };
            let radius = 0.5 * x(12);
            let aside = through(0).direction.any_orthonormal_vector() * radius * 2.0 * x(13);
            let centre = through(0).at(5.0 * x(14)) + aside;
            let normal = corner(15).normalize();
            let offset = normal.dot(through(1).at(3.0 * x(18) - 6.0 * x(19)));
            let shapes = [
                moved(AnyPrimitive::Sphere(Sphere::new(radius)), centre),
                moved(
                    AnyPrimitive::Plane(Plane::new(normal.to_array(), offset)),
                    DVec3::ZERO,
                ),
            ];
            for shape in shapes {
                let scene = Scene {
                    shown: vec![shape],
                    ..Scene::default()
                };
                let world = World::new(&scene).expect("a world");
                let may_meet = world.may_meet(&view.beam(&area));
                empty += u32::from(!may_meet);
                let rays: Vec<Ray> = (0..40).map(through).collect();
                for found in world.nearest(&rays, Visibility::All) {
                    assert!(may_meet || found.verdict == Verdict::Miss, "seed {seed}");
                    met += u32::from(found.verdict == Verdict::Hit);
                }
            }
        }
        assert!(met > 10_000 && empty > 100, "{met} {empty}");
    }

    #[test]
    fn looking_along_up_still_gives_a_view() {
        for at in [DVec3::new(0.0, -1.0, 5.0), DVec3::new(0.0, 7.0, 5.0)] {
            let view = View::new(&Camera { at, ..camera() }, [9, 9]);
            let ray = view.ray(1.0, 2.0);
            assert!(ray.direction.is_normalized());
        }
        let blind = Camera {
            at: camera().eye,
            up: DVec3::ZERO,
            ..camera()
        };
        assert!(
            View::new(&blind, [9, 9])
                .ray(1.0, 2.0)
                .direction
                .is_normalized()
        );
    }
}
