//! Studies of work: steps against the grazing angle, time against the number of primitives.

use super::chart_panels::series_of;
use super::study::{Findings, Plan, single};
use crate::catalogue::{AnyModifier, AnyPrimitive, Cuboid, Plane, Sphere, Torus, Translate};
use crate::output::chart::{Axis, Chart, Line, Panel, Point, Scale, Series};
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
const SIZE: [u32; 2] = [96, 54];

/// A run that takes longer than this, in milliseconds, is not repeated, and no larger one is tried.
const LONG: f64 = 3000.0;

/// A method with or without pruning, and what was measured of it for each number of primitives.
struct Way {
    method: Method,
    is_pruned: bool,
    times: Vec<Vec<f64>>,
    /// Primitives evaluated a ray.
    work: Vec<f64>,
}

impl Way {
    /// The world of a scene.
    fn world(&self, scene: &Scene) -> Result<World, Fault> {
        let settings = Settings {
            method: self.method,
            ..scene.settings
        };
        if self.is_pruned {
            World::of(&scene.shown, &settings)
        } else {
            World::unpruned(&scene.shown, &settings)
        }
    }

    /// Whether this number of primitives, or a smaller one, took too long for another run.
    fn is_tired(&self, number: usize) -> bool {
        self.times[..=number].iter().flatten().any(|t| *t > LONG)
    }

    /// Times the rays of a scene, the one of that number, if that is not too much.
    fn run(&mut self, number: usize, scene: &Scene) -> Result<(), Fault> {
        if self.is_tired(number) {
            return Ok(());
        }
        let world = self.world(scene)?;
        let hits = Hits::of(scene, &world, 1);
        self.times[number].push(hits.milliseconds());
        if self.work.len() == number {
            // A part that is not pruned evaluates all primitives.
            let whole = f64::from(NUMBERS[number]) / world.parts() as f64;
            self.work.push(hits.evaluations() * whole);
        }
        Ok(())
    }

    /// The series of this way with these points.
    fn series(&self, points: Vec<Point>) -> Series {
        let pruned = series_of(self.method, points);
        if self.is_pruned {
            return pruned;
        }
        Series {
            name: format!("{}, unpruned", pruned.name),
            // The same colour with other marks.
            style: pruned.style + 10,
            ..pruned
        }
    }

    fn timed(&self) -> Series {
        let point = |(n, times): (&u32, &Vec<f64>)| {
            let spread = Spread::of(times.iter().copied())?;
            Some(Point {
                upper: Some(spread.upper),
                ..Point::new(f64::from(*n), spread.minimum)
            })
        };
        self.series(NUMBERS.iter().zip(&self.times).filter_map(point).collect())
    }

    fn counted(&self) -> Series {
        let points = NUMBERS.iter().zip(&self.work);
        self.series(
            points
                .map(|(n, work)| Point::new(f64::from(*n), *work))
                .collect(),
        )
    }
}

/// Time and primitives evaluated against the number of primitives, with and without pruning.
///
/// # Errors
/// If a shape can't be traced.
pub fn primitives(plan: &Plan) -> Result<Findings, Fault> {
    let scenes = NUMBERS
        .map(crowd)
        .into_iter()
        .collect::<Result<Vec<Scene>, Fault>>()?;
    let way = |method: Method, is_pruned: bool| Way {
        method,
        is_pruned,
        times: vec![Vec::new(); NUMBERS.len()],
        work: Vec::new(),
    };
    let methods = plan.methods.iter();
    let mut ways: Vec<Way> = methods
        .flat_map(|m| [way(*m, true), way(*m, false)])
        .collect();
    for _ in 0..plan.rounds.max(1) {
        for way in &mut ways {
            for (number, scene) in scenes.iter().enumerate() {
                way.run(number, scene)?;
            }
        }
    }
    let panel = |title: &str, label: &str, scale: Scale, series: fn(&Way) -> Series| Panel {
        title: title.into(),
        x: Axis {
            label: "primitives".into(),
            scale: Scale::Log,
        },
        y: Axis {
            label: label.into(),
            scale,
        },
        series: ways.iter().map(series).collect(),
    };
    let [width, height] = SIZE;
    let chart = Chart {
        title: "Many primitives, with and without pruning".into(),
        subtitle: format!(
            "A hard union of balls, boxes and rings in the same space; camera rays at {width} × {height}, one thread."
        ),
        columns: 2,
        panels: vec![
            panel("Time", "milliseconds", Scale::Log, Way::timed),
            panel(
                "Primitives evaluated",
                "a ray; closed forms count nothing",
                Scale::LogFromOne,
                Way::counted,
            ),
        ],
        notes: Vec::new(),
    };
    Ok(Findings {
        chart,
        columns: ["method", "primitives", "value"],
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
    Ok(Scene {
        shown: children,
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

    /// Without pruning, every sample evaluates all primitives; with it, a thousand times as many cost a few times as much. Both
    /// find the same.
    #[test]
    fn pruning_passes_over_most_primitives() {
        let scenes = [10, 1000].map(|n| crowd(n).unwrap());
        let evaluated = |n: usize, is_pruned: bool| {
            let way = Way {
                method: Method::Certified,
                is_pruned,
                times: Vec::new(),
                work: Vec::new(),
            };
            let mut scene = scenes[n].clone();
            scene.settings.size = [32, 18];
            let hits = Hits::of(&scene, &way.world(&scene).unwrap(), 0);
            let places: Vec<_> = hits.outcomes.iter().map(|o| (o.verdict, o.t)).collect();
            (hits.evaluations(), places)
        };
        let [few, many] = [0, 1].map(|n| (evaluated(n, true), evaluated(n, false)));
        for ((_, pruned), (_, whole)) in [&few, &many] {
            for ((verdict, t), (expected, at)) in pruned.iter().zip(whole) {
                assert_eq!(verdict, expected);
                assert!(t == at || (t - at).abs() < 1e-9, "{t} {at}");
            }
        }
        // Ten and a thousand primitives in each sample.
        let growth = 100.0 * many.1.0 / few.1.0;
        assert!(growth > 50.0, "unpruned: {growth} times as many");
        let growth = many.0.0 / few.0.0;
        assert!(growth < 10.0, "pruned: {growth} times as many");
    }

    #[test]
    fn crowds_have_their_number() {
        for n in [1, 10, 100] {
            let world = World::new(&crowd(n).unwrap()).unwrap();
            assert_eq!(world.parts(), n as usize);
        }
    }
}
