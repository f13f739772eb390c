//! Studies of work: steps against the grazing angle, time against the number of primitives.

use super::chart_panels::series_of;
use super::study::{Findings, Plan, single};
use crate::catalogue::{
    AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid, Operation, Plane, Sphere, Torus,
    Translate,
};
use crate::output::chart::{Line, Point, Scale, Series};
use crate::render::{Hits, Spread};
use crate::scene::{Camera, Fault, Method, Node, Scene, Settings};
use crate::trace::{Footprint, Ray, Visibility, World};
use glam::DVec3;

/// The angles to the plane, in degrees.
const ANGLES: [f64; 13] = [
    60.0, 45.0, 30.0, 20.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05,
];

/// How far from the plane a hit may be, in scene units, for a ray that starts at height 1.
const NEAR: f64 = 1e-4;

/// How many steps Hart's method takes to within `near` of a plane that it sees at an angle, from height 1: at every step the
/// height shrinks by the factor 1 - sin(angle); the first step is the one at the start.
fn closed_form(degrees: f64) -> f64 {
    let factor = 1.0 - degrees.to_radians().sin();
    1.0 + (NEAR.ln() / factor.ln()).ceil().max(0.0)
}

/// Steps towards a plane against the angle.
///
/// # Errors
/// If the plane can't be traced.
pub fn grazing(plan: &Plan) -> Result<Findings, Fault> {
    let plane = Node::primitive(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0)))?;
    let mut series = vec![Series {
        name: "closed form of Hart's steps".into(),
        style: 6,
        line: Line::Dashed,
        points: ANGLES.map(|a| Point::new(a, closed_form(a))).to_vec(),
    }];
    for method in &plan.methods {
        let settings = Settings {
            method: *method,
            tolerance: 1.0,
            max_steps: 1_000_000,
            ..Settings::default()
        };
        let world = World::of(std::slice::from_ref(&plane), &settings)?;
        let points = ANGLES.map(|a| Point::new(a, f64::from(steps(&world, a))));
        series.push(series_of(*method, points.to_vec()));
    }
    let subtitle = "From height 1 to within 0.0001 of a plane. Where the ray grazes, steps that know only the distance crawl.";
    let axes = [
        ("angle to the plane, degrees", Scale::Log),
        ("steps", Scale::LogFromOne),
    ];
    Ok(Findings {
        chart: single("Steps against the grazing angle", subtitle, axes, series),
        columns: ["method", "degrees", "steps"],
    })
}

/// The steps of a ray from height 1 that sees the plane at an angle.
fn steps(world: &World, degrees: f64) -> u32 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let ray = Ray {
        origin: DVec3::Y,
        direction: DVec3::new(cos, -sin, 0.0),
        t_max: f64::INFINITY,
        footprint: Footprint {
            at_origin: NEAR,
            spread: 0.0,
        },
    };
    world.nearest(&[ray], Visibility::All)[0].steps
}

/// The numbers of primitives.
const NUMBERS: [u32; 5] = [1, 10, 100, 1000, 10_000];

/// The picture in which the camera's rays are timed.
const SIZE: [u32; 2] = [160, 90];

/// A run that takes longer than this, in milliseconds, is not repeated, and no larger one is tried.
const LONG: f64 = 4000.0;

/// Time against the number of primitives.
///
/// # Errors
/// If a shape can't be traced.
pub fn primitives(plan: &Plan) -> Result<Findings, Fault> {
    let scenes = NUMBERS
        .map(crowd)
        .into_iter()
        .collect::<Result<Vec<Scene>, Fault>>()?;
    let mut times: Vec<Vec<Vec<f64>>> = vec![vec![Vec::new(); NUMBERS.len()]; plan.methods.len()];
    for _ in 0..plan.rounds.max(1) {
        for (method, times) in plan.methods.iter().zip(&mut times) {
            for (i, scene) in scenes.iter().enumerate() {
                let is_long = |t: &Vec<f64>| t.iter().any(|t| *t > LONG);
                if times[..=i].iter().any(is_long) {
                    break;
                }
                let settings = Settings {
                    method: *method,
                    ..scene.settings
                };
                let world = World::of(&scene.shown, &settings)?;
                times[i].push(Hits::of(scene, &world, 1).milliseconds());
            }
        }
    }
    let point = |(n, times): (&u32, Vec<f64>)| {
        let spread = Spread::of(times)?;
        Some(Point {
            upper: Some(spread.upper),
            ..Point::new(f64::from(*n), spread.minimum)
        })
    };
    let series = plan
        .methods
        .iter()
        .zip(times)
        .map(|(method, times)| {
            series_of(
                *method,
                NUMBERS.iter().zip(times).filter_map(point).collect(),
            )
        })
        .collect();
    let subtitle = "A hard union of balls, boxes and rings in the same space; camera rays at 160 × 90, one thread.";
    let axes = [("primitives", Scale::Log), ("milliseconds", Scale::Log)];
    Ok(Findings {
        chart: single(
            "Time against the number of primitives",
            subtitle,
            axes,
            series,
        ),
        columns: ["method", "primitives", "milliseconds"],
    })
}

/// So many balls, boxes and rings in a cube, the smaller the more there are, by a linear congruential generator.
fn crowd(n: u32) -> Result<Scene, Fault> {
    let size = (1000.0 / f64::from(n)).cbrt();
    let mut state = 12_345 + n;
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / 4_294_967_296.0
    };
    let mut children = Vec::with_capacity(n as usize);
    for i in 0..n {
        let spread = 10.0 * (1.0 - 1.0 / f64::from(n).cbrt());
        let place = [number(), number(), number()].map(|u| spread * (2.0 * u - 1.0));
        let u = 0.3 + 0.3 * number();
        let shape = match i % 3 {
            0 => AnyPrimitive::Sphere(Sphere::new(size * u)),
            1 => AnyPrimitive::Cuboid(Cuboid::new([1.6 * size * u; 3], 0.0)),
            _ => AnyPrimitive::Torus(Torus::new(0.8 * size * u, 0.25 * size * u)),
        };
        let shape = Node::primitive(shape)?;
        children.push(Node::modifier(
            AnyModifier::Translate(Translate::new(place)),
            shape,
        )?);
    }
    let union = Combination {
        operation: Operation::Union,
        blend: AnyBlend::HARD,
    };
    let shown = if children.len() == 1 {
        children
    } else {
        vec![Node::combination(union, children)?]
    };
    Ok(Scene {
        shown,
        camera: Camera {
            eye: DVec3::new(12.0, 14.0, 30.0),
            at: DVec3::ZERO,
            ..Camera::default()
        },
        settings: Settings {
            size: SIZE,
            method: Method::Auto,
            ..Settings::default()
        },
        ..Scene::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(methods: &[Method]) -> Plan {
        Plan {
            scenes: Vec::new(),
            methods: methods.to_vec(),
            rounds: 1,
        }
    }

    /// The closed form, within a step of rounding at the end.
    #[test]
    fn hart_takes_the_steps_of_the_closed_form() {
        let findings = grazing(&plan(&[Method::Sphere])).unwrap();
        let [theory, found] = &findings.chart.panels[0].series[..] else {
            panic!("two series")
        };
        for (theory, found) in theory.points.iter().zip(&found.points) {
            assert!(
                (theory.at[1] - found.at[1]).abs() <= 1.0,
                "{:?} {:?}",
                theory.at,
                found.at
            );
        }
        assert!(found.points.last().unwrap().at[1] > 10_000.0);
    }

    #[test]
    fn default_does_not_crawl() {
        let findings = grazing(&plan(&[Method::Auto])).unwrap();
        let found = &findings.chart.panels[0].series[1];
        assert!(found.points.iter().all(|p| p.at[1] <= 2.0), "{found:?}");
    }

    #[test]
    fn crowds_have_their_number() {
        for n in [1, 10, 100] {
            let world = World::new(&crowd(n).unwrap()).unwrap();
            assert_eq!(world.parts(), n as usize);
        }
    }
}
