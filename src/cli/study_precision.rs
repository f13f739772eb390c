//! Studies of numbers: f32 against f64, near the origin and far from it, small and large.

use super::chart_panels::series_of;
use super::study::{Findings, Plan};
use super::truth_cache;
use crate::catalogue::{
    AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid, Operation, Smooth, Sphere, Torus,
    Translate,
};
use crate::output::chart::{Axis, Chart, Line, Look, Panel, Point, Scale, Series};
use crate::render::{Errors, Hits};
use crate::scene::{Camera, Fault, Method, Node, Scene, Settings, Shape};
use crate::trace::{Outcome, Precision, Ray, Visibility, World, sphere_traced, union};
use glam::DVec3;
use std::sync::Arc;

/// The picture of the study of distances and sizes.
const SIZE: [u32; 2] = [96, 54];

/// Its tolerance, in pixels: fine enough that rounding shows.
const TOLERANCE: f64 = 1e-4;

/// The distances from the origin, in scene units.
const DISTANCES: [f64; 9] = [1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];

/// The sizes, as exponents of 2.
const EXPONENTS: [i32; 17] = [
    -80, -70, -60, -50, -40, -30, -20, -10, 0, 10, 20, 30, 40, 50, 60, 70, 80,
];

/// The tolerances of the study of f32 against f64, in pixels.
const TOLERANCES: [f64; 7] = [1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// What rays are traced in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Numbers {
    /// A method of the program, in f64.
    Of(Method),
    /// Hart's steps over the whole union, in f64.
    F64,
    /// The same in f32.
    F32,
    /// In f32, after positions were moved to the camera's in f64.
    Rebased,
}

impl Numbers {
    /// What these shapes are to these rays, whose camera is at `eye`.
    fn outcomes(
        self,
        shown: &[Arc<Node>],
        settings: &Settings,
        rays: &[Ray],
        eye: DVec3,
    ) -> Result<Vec<Outcome>, Fault> {
        match self {
            Self::Of(method) => {
                let settings = Settings {
                    method,
                    ..*settings
                };
                Ok(World::of(shown, &settings)?.nearest(rays, Visibility::All))
            }
            Self::F64 => whole::<f64>(shown, settings, rays),
            Self::F32 => whole::<f32>(shown, settings, rays),
            Self::Rebased => {
                let shown = shown.iter().map(|node| moved(node, -eye));
                let shown = shown.collect::<Result<Vec<_>, _>>()?;
                let from_there = |ray: &Ray| Ray {
                    origin: ray.origin - eye,
                    ..*ray
                };
                let rays: Vec<Ray> = rays.iter().map(from_there).collect();
                whole::<f32>(&shown, settings, &rays)
            }
        }
    }

    fn series(self, points: Vec<Point>) -> Series {
        let (name, style) = match self {
            Self::Of(method) => return series_of(method, points),
            Self::F64 => ("f64", 1),
            Self::F32 => ("f32", 6),
            Self::Rebased => ("f32, moved to the camera", 9),
        };
        Series {
            name: name.into(),
            style,
            line: Line::Solid,
            points,
        }
    }
}

fn whole<N: Precision>(
    shown: &[Arc<Node>],
    settings: &Settings,
    rays: &[Ray],
) -> Result<Vec<Outcome>, Fault> {
    let node = union(shown)?;
    sphere_traced::<N>(&node, settings, rays)
}

/// A shape moved by a vector: translations at the root of the tree, and below combinations there, are summed in f64; whatever
/// lies deeper is moved as a whole.
fn moved(node: &Arc<Node>, by: DVec3) -> Result<Arc<Node>, Fault> {
    match node.shape() {
        Shape::Combination(combination, children) => {
            let children = children.iter().map(|child| moved(child, by));
            Node::combination(combination.clone(), children.collect::<Result<_, _>>()?)
        }
        Shape::Modifier(AnyModifier::Translate(shift), child) => {
            moved(child, by + DVec3::from_array(shift.by))
        }
        _ => Node::modifier(
            AnyModifier::Translate(Translate::new(by.to_array())),
            node.clone(),
        ),
    }
}

/// A ball and a box that melt into each other, and a ring, moved away from the origin with the camera, all of it times a size.
fn group(away: DVec3, size: f64) -> Result<Scene, Fault> {
    let s = |x: f64| size * x;
    let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(s(0.8))))?;
    let cube = Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([s(1.1); 3], s(0.05))))?;
    let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(s(1.6), s(0.2))))?;
    let blend = AnyBlend::Smooth(Smooth::new(s(0.3)));
    let pair = Combination {
        operation: Operation::Union,
        blend,
    };
    let cube = moved(&cube, DVec3::new(0.8, 0.4, 0.2) * size)?;
    let pair = Node::combination(pair, vec![ball, cube])?;
    Ok(Scene {
        shown: vec![moved(&pair, away)?, moved(&ring, away)?],
        camera: Camera {
            eye: away + DVec3::new(2.5, 3.0, 5.0) * size,
            at: away,
            ..Camera::default()
        },
        settings: Settings {
            size: SIZE,
            tolerance: TOLERANCE,
            ..Settings::default()
        },
        ..Scene::default()
    })
}

/// How outcomes lie beside the truth.
fn errors(outcomes: Vec<Outcome>, truth: &Hits) -> Errors {
    let found = Hits {
        rays: truth.rays.clone(),
        outcomes,
        ..Hits::default()
    };
    Errors::of(&found, truth)
}

/// The point of these errors: with `is_depth` the error of depth, else how many rays are wrong.
fn point(x: f64, errors: &Errors, is_depth: bool) -> Point {
    let finds_nothing = errors.compared == 0 && errors.false_misses + errors.unknown > 0;
    let depth = if finds_nothing {
        f64::INFINITY
    } else {
        errors.depth_p99
    };
    let y = if is_depth {
        depth
    } else {
        errors.wrong_per_million()
    };
    Point {
        look: Look {
            is_wrong: errors.false_misses > 0,
            is_crossed: errors.unknown > 0,
            ..Look::default()
        },
        ..Point::new(x, y)
    }
}

const DEPTH: (&str, &str, Scale) = ("depth", "error of depth (p99), pixels", Scale::LogOrExact);
const WRONG: (&str, &str, Scale) = (
    "wrong rays",
    "wrong or unknown rays of a million",
    Scale::LogFromOne,
);

/// What was found in each kind of numbers, at each place on the horizontal axis.
type Found = Vec<(Numbers, Vec<(f64, Errors)>)>;

/// A panel of errors of depth, and one of wrong rays.
fn panels(title: &str, (label, x_scale): (&str, Scale), found: &Found) -> [Panel; 2] {
    [(DEPTH, true), (WRONG, false)].map(|((kind, y, scale), is_depth)| Panel {
        title: format!("{title}: {kind}"),
        x: Axis {
            label: label.into(),
            scale: x_scale,
        },
        y: Axis {
            label: y.into(),
            scale,
        },
        series: found
            .iter()
            .map(|(numbers, errors)| {
                let points = errors.iter().map(|(x, e)| point(*x, e, is_depth));
                numbers.series(points.collect())
            })
            .collect(),
    })
}

/// What marks mean in these charts.
fn notes() -> Vec<(Look, String)> {
    let look = Look::default();
    let wrong = Look {
        is_wrong: true,
        ..look
    };
    let unknown = Look {
        is_crossed: true,
        ..look
    };
    vec![
        (wrong, "missed surfaces".into()),
        (unknown, "some rays unknown".into()),
    ]
}

/// Errors against the distance from the origin and against the size of everything.
///
/// # Errors
/// If a shape can't be traced.
pub fn distance(plan: &Plan) -> Result<Findings, Fault> {
    let direction = DVec3::new(2.0, -1.0, 2.0) / 3.0;
    let home = group(DVec3::ZERO, 1.0)?;
    let truth = truth_cache::truth(&home, false)?;
    let truth = truth.hits();
    let far = |numbers: Numbers, distance: f64| -> Result<_, Fault> {
        let away = direction * distance;
        let scene = group(away, 1.0)?;
        let moved = |ray: &Ray| Ray {
            origin: ray.origin + away,
            ..*ray
        };
        let rays: Vec<Ray> = truth.rays.iter().map(moved).collect();
        let eye = scene.camera.eye;
        let outcomes = numbers.outcomes(&scene.shown, &scene.settings, &rays, eye)?;
        Ok((distance, errors(outcomes, truth)))
    };
    let sized = |numbers: Numbers, exponent: i32| -> Result<_, Fault> {
        let size = f64::from(exponent).exp2();
        let scene = group(DVec3::ZERO, size)?;
        let scaled = |ray: &Ray| Ray {
            origin: ray.origin * size,
            ..*ray
        };
        let rays: Vec<Ray> = truth.rays.iter().map(scaled).collect();
        let eye = scene.camera.eye;
        let mut outcomes = numbers.outcomes(&scene.shown, &scene.settings, &rays, eye)?;
        outcomes.iter_mut().for_each(|outcome| outcome.t /= size);
        Ok((f64::from(exponent), errors(outcomes, truth)))
    };
    let methods = plan.methods.iter().map(|method| Numbers::Of(*method));
    let all: Vec<Numbers> = methods.chain([Numbers::F32, Numbers::Rebased]).collect();
    let [mut distances, mut sizes] = [Found::new(), Found::new()];
    for numbers in all {
        let far = DISTANCES.iter().map(|d| far(numbers, *d));
        distances.push((numbers, far.collect::<Result<_, _>>()?));
        let sized = EXPONENTS.iter().map(|e| sized(numbers, *e));
        sizes.push((numbers, sized.collect::<Result<_, _>>()?));
    }
    let of_distance = ("distance from the origin", Scale::Log);
    let of_size = ("size of everything, as a power of 2", Scale::Linear);
    let far = panels("Far from the origin", of_distance, &distances);
    let sized = panels("Small and large", of_size, &sizes);
    let chart = Chart {
        title: "Far from the origin, small and large".into(),
        subtitle: format!(
            "A blend and a ring with their camera, at a tolerance of {TOLERANCE} pixels. Methods are in f64; f32 takes Hart's steps."
        ),
        columns: 2,
        panels: far.into_iter().chain(sized).collect(),
        notes: notes(),
    };
    Ok(Findings {
        chart,
        columns: ["numbers", "place", "value"],
    })
}

/// Errors of f32 and of f64 against the tolerance.
///
/// # Errors
/// If a shape can't be traced.
pub fn precision(plan: &Plan) -> Result<Findings, Fault> {
    let mut all = Vec::new();
    for (name, scene) in &plan.scenes {
        let truth = truth_cache::truth(scene, false)?;
        let truth = truth.hits();
        let at = |numbers: Numbers, tolerance: f64| -> Result<_, Fault> {
            let settings = Settings {
                tolerance,
                ..scene.settings
            };
            let eye = scene.camera.eye;
            let outcomes = numbers.outcomes(&scene.shown, &settings, &truth.rays, eye)?;
            Ok((tolerance, errors(outcomes, truth)))
        };
        let mut found = Found::new();
        for numbers in [Numbers::F64, Numbers::F32, Numbers::Rebased] {
            let errors = TOLERANCES.iter().map(|t| at(numbers, *t));
            found.push((numbers, errors.collect::<Result<_, _>>()?));
        }
        all.extend(panels(name, ("tolerance, pixels", Scale::Log), &found));
    }
    let chart = Chart {
        title: "f32 against f64".into(),
        subtitle: "Hart's steps over the whole scene in numbers of each kind; the finest tolerance is 64 roundings.".into(),
        columns: 2,
        panels: all,
        notes: notes(),
    };
    Ok(Findings {
        chart,
        columns: ["numbers", "tolerance", "value"],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(findings: &Findings, panel: usize, name: &str, x: f64) -> f64 {
        let series = &findings.chart.panels[panel].series;
        let series = series.iter().find(|s| s.name == name).unwrap();
        series.points.iter().find(|p| p.at[0] == x).unwrap().at[1]
    }

    /// The rounding of f32, 2^-24 of the distance, against that of f64, 2^-53: what f32 loses with each decade of distance is
    /// what moving everything to the camera, before it is rounded, gives back.
    #[test]
    fn f32_loses_with_the_distance_and_moving_to_the_camera_gives_it_back() {
        let plan = Plan {
            scenes: Vec::new(),
            methods: vec![Method::Auto, Method::Sphere],
            rounds: 1,
        };
        let findings = distance(&plan).unwrap();
        let (depth, wrong, size) = (0, 1, 2);
        let f32_at = |d: f64| value(&findings, depth, "f32", d);
        // A decade of distance is a decade of rounding.
        let growth = f32_at(1e4) / f32_at(1e3);
        assert!((5.0..20.0).contains(&growth), "{growth}");
        let moved = |d: f64| value(&findings, depth, "f32, moved to the camera", d);
        assert!(
            moved(1e6) < 2.0 * moved(1.0),
            "{} {}",
            moved(1e6),
            moved(1.0)
        );
        assert!(moved(1.0) < 0.1 && f32_at(1e4) > 10.0 * moved(1e4));
        assert!(value(&findings, wrong, "f32", 1e8) > 1e5);
        assert_eq!(value(&findings, wrong, "auto", 1e8), 0.0);
        // The same bits at every size by a power of two, as far as squares of f32 reach.
        let at = |name: &str, e: f64| value(&findings, size, name, e);
        for name in ["auto", "sphere", "f32"] {
            assert_eq!(at(name, 40.0), at(name, -40.0), "{name}");
            assert_eq!(at(name, 40.0), at(name, 0.0), "{name}");
        }
        assert_eq!(at("sphere", 80.0), at("sphere", 0.0));
        assert!(value(&findings, 3, "f32", 80.0) > 1e5);
    }

    /// Ever finer tolerances go on being worth their steps in f64; in f32 they end at its rounding.
    #[test]
    fn f32_stops_where_its_rounding_begins() {
        let mut scene = group(DVec3::ZERO, 1.0).unwrap();
        scene.settings.size = [48, 27];
        let plan = Plan {
            scenes: vec![("group".into(), scene)],
            methods: Vec::new(),
            rounds: 1,
        };
        let findings = precision(&plan).unwrap();
        let gain = |name: &str| value(&findings, 0, name, 1e-3) / value(&findings, 0, name, 1e-6);
        assert!(gain("f64") > 500.0, "{}", gain("f64"));
        assert!(gain("f32") < 20.0, "{}", gain("f32"));
        let coarse = |name: &str| value(&findings, 0, name, 1.0);
        assert!((coarse("f32") / coarse("f64") - 1.0).abs() < 0.01);
    }

    /// Positions are summed before they are rounded: the tree holds no large number any more.
    #[test]
    fn moving_sums_positions() {
        let away = DVec3::splat(1e7);
        let scene = group(away, 1.0).unwrap();
        for (node, home) in scene
            .shown
            .iter()
            .zip(&group(DVec3::ZERO, 1.0).unwrap().shown)
        {
            let back = moved(node, -away).unwrap();
            let p = crate::num::Vec3::new(0.5f32, 1.5, -0.25);
            assert_eq!(back.evaluate(&p), home.evaluate(&p));
        }
    }
}
