//! Studies of errors: by the way gradients are found, by samples a pixel.

use super::study::{Findings, Plan, single};
use crate::catalogue::{AnyPrimitive, Torus};
use crate::num::{Dual, Vec3};
use crate::output::chart::{Axis, Chart, Line, Panel, Point, Scale, Series};
use crate::render::{Channel, Film, RenderOptions, render, root_mean_square};
use crate::scene::{Fault, Node, Scene, Settings};
use crate::trace::World;
use glam::DVec3;

/// The widths of differences, in scene units.
const WIDTHS: [f64; 13] = [
    0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13,
];

/// How many points of the surface are looked at.
const POINTS: u32 = 2000;

/// A way to find a gradient.
type Gradient = fn(&Node, DVec3, f64) -> DVec3;

fn value(node: &Node, p: DVec3) -> f64 {
    node.evaluate(&Vec3::splat(p.to_array()))
}

fn dual(node: &Node, p: DVec3, _: f64) -> DVec3 {
    let [x, y, z] = [0, 1, 2].map(|axis| Dual::<f64, 3>::variable(p[axis], axis));
    DVec3::from_array(node.evaluate(&Vec3::new(x, y, z)).partial)
}

fn central(node: &Node, p: DVec3, h: f64) -> DVec3 {
    let along = |axis: DVec3| value(node, p + axis * h) - value(node, p - axis * h);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// Differences at the corners of a tetrahedron. Source: Quilez, normals for an SDF.
fn tetrahedron(node: &Node, p: DVec3, h: f64) -> DVec3 {
    let corners = [
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::ONE,
    ];
    corners
        .map(|corner| corner * value(node, p + corner * h))
        .into_iter()
        .sum()
}

/// Points of the surface of a torus with their normals, by its own angles.
fn torus_points(major: f64, minor: f64) -> Vec<[DVec3; 2]> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (0..POINTS)
        .map(|i| {
            let around = std::f64::consts::TAU * (f64::from(i) * GOLDEN).fract();
            let across = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(POINTS);
            let out = DVec3::new(around.cos(), 0.0, around.sin());
            let normal = out * across.cos() + DVec3::Y * across.sin();
            [out * major + normal * minor, normal]
        })
        .collect()
}

/// The angle that 99 % of the normals don't exceed, in degrees.
fn angle(node: &Node, points: &[[DVec3; 2]], gradient: Gradient, h: f64) -> f64 {
    let mut angles: Vec<f64> = points
        .iter()
        .map(|[p, normal]| {
            let found = gradient(node, *p, h).normalize_or_zero();
            // A gradient of zero is no direction at all.
            if found == DVec3::ZERO {
                return 180.0;
            }
            found
                .cross(*normal)
                .length()
                .atan2(found.dot(*normal))
                .to_degrees()
        })
        .collect();
    angles.sort_by(f64::total_cmp);
    angles[angles.len() * 99 / 100]
}

/// Errors of normals by dual numbers and by differences.
///
/// # Errors
/// None: a torus can be made.
pub fn gradients() -> Result<Findings, Fault> {
    let (major, minor) = (0.75, 0.25);
    let torus = Node::primitive(AnyPrimitive::Torus(Torus::new(major, minor)))?;
    let points = torus_points(major, minor);
    let ways: [(&str, Gradient); 3] = [
        ("dual numbers (one evaluation of four numbers)", dual),
        ("central differences (6 evaluations)", central),
        ("tetrahedron (4 evaluations)", tetrahedron),
    ];
    let series = ways
        .into_iter()
        .enumerate()
        .map(|(style, (name, gradient))| Series {
            name: name.into(),
            style,
            line: Line::Solid,
            points: WIDTHS
                .map(|h| Point::new(h, angle(&torus, &points, gradient, h)))
                .to_vec(),
        })
        .collect();
    let subtitle = "Normals of a torus of radii 0.75 and 0.25 against their closed form. No width of differences is as good as none.";
    let axes = [
        ("width of the differences", Scale::Log),
        ("error of normals (p99), degrees", Scale::LogOrExact),
    ];
    Ok(Findings {
        chart: single(
            "Gradients by dual numbers and by differences",
            subtitle,
            axes,
            series,
        ),
        columns: ["way", "width", "degrees"],
    })
}

/// The numbers of samples a pixel, and that of the picture they are compared with.
const SAMPLES: [u32; 6] = [1, 2, 4, 8, 16, 32];
const MANY: u32 = 256;

/// Errors of pictures against samples a pixel.
///
/// # Errors
/// If a shape can't be traced.
pub fn samples(plan: &Plan) -> Result<Findings, Fault> {
    let mut panels = Vec::new();
    for (name, scene) in &plan.scenes {
        let world = World::new(scene)?;
        // Other random numbers, or the samples of the one would be among those of the other.
        let many = film(scene, &world, MANY, scene.settings.seed.wrapping_add(1));
        let error = |n: u32| {
            root_mean_square(&film(scene, &world, n, scene.settings.seed), &many)
                .unwrap_or(f64::NAN)
        };
        let points: Vec<Point> = SAMPLES
            .iter()
            .map(|n| Point::new(f64::from(*n), error(*n)))
            .collect();
        let slope = |exponent: f64| {
            SAMPLES
                .map(|n| Point::new(f64::from(n), points[0].at[1] * f64::from(n).powf(exponent)))
                .to_vec()
        };
        let guides = [
            ("n to the -1/2: random samples", -0.5),
            ("n to the -3/4: even samples", -0.75),
        ];
        let mut series: Vec<Series> = guides
            .into_iter()
            .enumerate()
            .map(|(i, (name, exponent))| Series {
                name: name.into(),
                style: 5 + i,
                line: Line::Dashed,
                points: slope(exponent),
            })
            .collect();
        series.push(Series {
            name: "error of light".into(),
            style: 0,
            line: Line::Solid,
            points,
        });
        let axis = |label: &str| Axis {
            label: label.into(),
            scale: Scale::Log,
        };
        panels.push(Panel {
            title: name.clone(),
            x: axis("samples a pixel"),
            y: axis("root mean square of the difference"),
            series,
        });
    }
    let chart = Chart {
        title: "Pictures against samples a pixel".into(),
        subtitle: format!("Light (linear) against {MANY} samples with other random numbers."),
        columns: panels.len().min(3),
        panels,
        notes: Vec::new(),
    };
    Ok(Findings {
        chart,
        columns: ["series", "samples", "error"],
    })
}

fn film(scene: &Scene, world: &World, samples: u32, seed: u64) -> Film {
    let scene = Scene {
        settings: Settings {
            samples,
            seed,
            ..scene.settings
        },
        ..scene.clone()
    };
    let options = RenderOptions {
        channels: &[Channel::Beauty],
        ..RenderOptions::default()
    };
    render(&scene, world, &options).film
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences are off by h^2 / 6 times a third derivative, and by rounding over h: best near the cube root of it.
    #[test]
    fn differences_have_a_best_width_and_dual_numbers_need_none() {
        let findings = gradients().unwrap();
        let [dual, central, tetrahedron] = &findings.chart.panels[0].series[..] else {
            panic!("three ways")
        };
        assert!(dual.points.iter().all(|p| p.at[1] < 1e-12), "{dual:?}");
        let of =
            |series: &Series, h: f64| series.points.iter().find(|p| p.at[0] == h).unwrap().at[1];
        assert!((of(central, 1e-2) / of(central, 1e-3) / 100.0 - 1.0).abs() < 0.1);
        // The tetrahedron's error shrinks with h alone, and rounding has the last word for both.
        assert!((of(tetrahedron, 1e-2) / of(tetrahedron, 1e-3) / 10.0 - 1.0).abs() < 0.1);
        assert!(of(central, 1e-5) < of(central, 1e-2) && of(central, 1e-5) < of(central, 1e-10));
    }

    #[test]
    fn normals_of_the_torus_are_those_of_its_field() {
        let torus = Node::primitive(AnyPrimitive::Torus(Torus::new(0.75, 0.25))).unwrap();
        for [p, normal] in torus_points(0.75, 0.25) {
            assert!(value(&torus, p).abs() < 1e-15);
            assert!((value(&torus, p + normal * 0.1) - 0.1).abs() < 1e-14);
        }
    }
}
