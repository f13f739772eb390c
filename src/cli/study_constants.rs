//! The study of wrong Lipschitz constants: what methods lose when steps are too long, and what they pay when they are too short.

use super::chart_panels::series_of;
use super::study::{Findings, Plan};
use super::truth_cache;
use crate::output::chart::{Axis, Chart, Panel, Point, Scale};
use crate::render::{Errors, Hits, Setting};
use crate::scene::{Fault, Method, Scene};
use crate::trace::World;

/// What every constant is multiplied by.
const FACTORS: [f64; 9] = [0.25, 0.35, 0.5, 0.7, 0.9, 1.0, 1.4, 2.0, 4.0];

/// A run that takes longer than this, in milliseconds, is not repeated.
const LONG: f64 = 200.0;

/// How a method did with wrong constants.
struct Done {
    method: Method,
    factor: f64,
    errors: Errors,
    evaluations: f64,
    times: Vec<f64>,
}

/// Wrong rays, unknown rays, evaluations and time against the factor, a row of panels for each scene.
///
/// # Errors
/// If a shape can't be traced.
pub fn constants(plan: &Plan) -> Result<Findings, Fault> {
    let mut panels = Vec::new();
    for (name, scene) in &plan.scenes {
        let truth = truth_cache::truth(scene, false)?;
        let results = results(plan, scene, truth.hits())?;
        let panel = |title: &str, label: &str, scale: Scale, value: &dyn Fn(&Done) -> f64| Panel {
            title: format!("{name}: {title}"),
            x: Axis {
                label: "constant, times the proved one".into(),
                scale: Scale::Log,
            },
            y: Axis {
                label: label.into(),
                scale,
            },
            series: plan
                .methods
                .iter()
                .map(|method| {
                    let own = results.iter().filter(|r| r.method == *method);
                    let points = own.map(|r| Point::new(r.factor, value(r)));
                    series_of(*method, points.collect())
                })
                .collect(),
        };
        let share = |n: u64, e: &Errors| 1e6 * n as f64 / e.rays.max(1) as f64;
        let wrong = |r: &Done| share(r.errors.false_hits + r.errors.false_misses, &r.errors);
        let unknown = |r: &Done| share(r.errors.unknown, &r.errors);
        let time = |r: &Done| r.times.iter().copied().fold(f64::INFINITY, f64::min);
        let [counts, times] = [Scale::LogFromOne, Scale::Log];
        panels.push(panel(
            "wrong",
            "false hits and misses of a million",
            counts,
            &wrong,
        ));
        panels.push(panel(
            "unknown",
            "unknown rays of a million",
            counts,
            &unknown,
        ));
        panels.push(panel("work", "evaluations a ray", counts, &|r| {
            r.evaluations
        }));
        panels.push(panel("time", "milliseconds", times, &time));
    }
    let subtitle = "Every Lipschitz constant times a factor. Below 1 it is no bound; certified methods say so of most rays.";
    let chart = Chart {
        title: "Wrong constants".into(),
        subtitle: subtitle.into(),
        columns: 2,
        panels,
        notes: Vec::new(),
    };
    Ok(Findings {
        chart,
        columns: ["method", "factor", "value"],
    })
}

/// All methods with all factors, timed in rounds, in each of which every one of them has its turn.
fn results(plan: &Plan, scene: &Scene, truth: &Hits) -> Result<Vec<Done>, Fault> {
    let mut results: Vec<Done> = Vec::new();
    for method in &plan.methods {
        for factor in FACTORS {
            let hits = hits(scene, *method, factor)?;
            results.push(Done {
                method: *method,
                factor,
                errors: Errors::of(&hits, truth),
                evaluations: hits.evaluations(),
                times: vec![hits.milliseconds()],
            });
        }
    }
    for _ in 1..plan.rounds {
        for done in results.iter_mut().filter(|done| done.times[0] < LONG) {
            let hits = hits(scene, done.method, done.factor)?;
            done.times.push(hits.milliseconds());
        }
    }
    Ok(results)
}

/// What one thread finds.
fn hits(scene: &Scene, method: Method, factor: f64) -> Result<Hits, Fault> {
    let setting = Setting {
        method,
        tolerance: scene.settings.tolerance,
    };
    let scene = setting.applied(scene);
    let world = World::new(&scene)?.with_constants_times(factor);
    Ok(Hits::of(&scene, &world, 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Torus};
    use crate::scene::{Camera, Node, Settings};
    use glam::DVec3;

    /// With half of its constant, Hart's method steps through the ring without a word; the certified one does so nowhere: it says
    /// unknown. With four times the constant, both only work more.
    #[test]
    fn wrong_constants_are_passed_over_or_told() {
        let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(0.75, 0.1))).unwrap();
        let scene = Scene {
            shown: vec![ring],
            camera: Camera {
                eye: DVec3::new(1.0, 2.0, 3.0),
                at: DVec3::ZERO,
                ..Camera::default()
            },
            settings: Settings {
                size: [48, 36],
                ..Settings::default()
            },
            ..Scene::default()
        };
        let methods = vec![Method::Sphere, Method::Certified];
        let plan = Plan {
            scenes: vec![("ring".into(), scene)],
            methods,
            rounds: 1,
        };
        let findings = constants(&plan).unwrap();
        let value = |panel: usize, series: usize, factor: f64| {
            let points = &findings.chart.panels[panel].series[series].points;
            points.iter().find(|p| p.at[0] == factor).unwrap().at[1]
        };
        let (wrong, unknown, work, time) = (0, 1, 2, 3);
        assert!(value(wrong, 0, 0.25) > 1000.0);
        assert!(value(unknown, 1, 0.25) > 1000.0);
        assert_eq!(value(wrong, 1, 1.0) + value(unknown, 1, 1.0), 0.0);
        for series in [0, 1] {
            assert!(value(work, series, 4.0) > 2.0 * value(work, series, 1.0));
            assert!(value(time, series, 4.0) > 0.0);
        }
    }
}
