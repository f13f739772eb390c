//! Methods over a sweep of their knob, the tolerance, each judged by a reference.

use super::{Case, Errors, Film, Hits, RenderOptions, Spread, root_mean_square};
use crate::scene::{Fault, Method, Scene};
use crate::trace::World;

/// A method at a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// How rays find surfaces.
    pub method: Method,
    /// How far from the surface a hit may be, in footprints.
    pub tolerance: f64,
}

/// How a method at a tolerance did.
#[derive(Clone, Debug)]
pub struct Judged {
    /// What was judged.
    pub setting: Setting,
    /// How its hits lie beside those of the reference.
    pub errors: Errors,
    /// Evaluations of fields a camera ray.
    pub evaluations: f64,
    /// The milliseconds in which one thread traced the camera's rays.
    pub milliseconds: Spread,
    /// The root of the mean square of the difference of light, where a picture was asked for.
    pub image: Option<f64>,
}

/// What all settings are judged by.
#[derive(Clone, Debug)]
pub struct Truth {
    hits: Hits,
    film: Option<Film>,
}

/// A run that takes longer than this, in milliseconds, is not repeated.
const LONG: f64 = 500.0;

impl Setting {
    /// The scene with this setting.
    pub fn applied(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.settings.method = self.method;
        scene.settings.tolerance = self.tolerance;
        scene
    }

    /// What the camera's rays hit, on so many threads.
    fn hits(&self, scene: &Scene, threads: usize) -> Result<Hits, Fault> {
        let scene = self.applied(scene);
        Ok(Hits::of(&scene, &World::new(&scene)?, threads))
    }

    fn film(&self, scene: &Scene) -> Result<Film, Fault> {
        let scene = self.applied(scene);
        let case = Case {
            method: self.method,
            threads: 0,
        };
        Ok(case.run(&scene, &RenderOptions::default())?.1)
    }
}

impl Truth {
    /// What the reference says of the camera's rays of `scene`, and of the picture if that is asked for.
    ///
    /// # Errors
    /// If a shape can't be traced.
    pub fn of(scene: &Scene, wants_picture: bool) -> Result<Self, Fault> {
        let setting = Setting {
            method: Method::Reference,
            tolerance: scene.settings.tolerance,
        };
        let film = wants_picture.then(|| setting.film(scene)).transpose()?;
        Ok(Self {
            hits: setting.hits(scene, 0)?,
            film,
        })
    }

    /// What a reference has said before.
    pub(super) fn with(hits: Hits, film: Option<Film>) -> Self {
        Self { hits, film }
    }

    /// The picture by the reference, if it was asked for.
    pub fn film(&self) -> Option<&Film> {
        self.film.as_ref()
    }

    /// The hits of the reference.
    pub fn hits(&self) -> &Hits {
        &self.hits
    }
}

/// Judges every setting, with times from so many interleaved rounds; what takes long is timed once.
///
/// # Errors
/// If a shape can't be traced.
pub fn sweep(
    scene: &Scene,
    settings: &[Setting],
    rounds: usize,
    truth: &Truth,
) -> Result<Vec<Judged>, Fault> {
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); settings.len()];
    let mut last: Vec<Option<Hits>> = vec![None; settings.len()];
    for round in 0..rounds.max(1) {
        for (i, setting) in settings.iter().enumerate() {
            if round > 0 && times[i][0] > LONG {
                continue;
            }
            let hits = setting.hits(scene, 1)?;
            times[i].push(hits.milliseconds());
            last[i].get_or_insert(hits);
        }
    }
    let mut judged = Vec::with_capacity(settings.len());
    for ((setting, times), hits) in settings.iter().zip(times).zip(last) {
        let hits = hits.unwrap_or_default();
        let image = match &truth.film {
            Some(film) => root_mean_square(&setting.film(scene)?, film),
            None => None,
        };
        judged.push(Judged {
            setting: *setting,
            errors: Errors::of(&hits, &truth.hits),
            evaluations: hits.evaluations(),
            milliseconds: Spread::of(times).expect("there is at least one round"),
            image,
        });
    }
    Ok(judged)
}

/// Which of these points no other one beats: none is at least as good on both sides and better on one. Less is better; what is
/// not a number beats nothing and is on no front.
pub fn pareto(points: &[[f64; 2]]) -> Vec<bool> {
    let is_number = |p: &[f64; 2]| p.iter().all(|x| !x.is_nan());
    let beats = |a: &[f64; 2], b: &[f64; 2]| is_number(a) && a[0] <= b[0] && a[1] <= b[1] && a != b;
    points
        .iter()
        .map(|p| is_number(p) && points.iter().all(|other| !beats(other, p)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Sphere};
    use crate::scene::{Camera, Node, Settings};
    use glam::DVec3;

    #[test]
    fn front_is_what_nothing_beats() {
        let points = [
            [0.0, 5.0],
            [1.0, 3.0],
            [1.0, 4.0],
            [2.0, 3.0],
            [3.0, 1.0],
            [f64::NAN, 0.0],
            [3.0, 1.0],
        ];
        assert_eq!(
            pareto(&points),
            [true, true, false, false, true, false, true]
        );
    }

    /// A ball of radius 1 in the middle of the picture: the closed form is exact, and Hart's steps end within the tolerance.
    #[test]
    fn errors_of_methods_on_a_ball() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let scene = Scene {
            shown: vec![ball],
            camera: Camera {
                eye: DVec3::new(0.0, 0.0, 5.0),
                at: DVec3::ZERO,
                ..Camera::default()
            },
            settings: Settings {
                size: [33, 33],
                ..Settings::default()
            },
            ..Scene::default()
        };
        let truth = Truth::of(&scene, true).unwrap();
        let hits = truth.hits().census.hits;
        assert!(hits > 100, "{hits} hits");
        let setting = |method, tolerance| Setting { method, tolerance };
        let settings = [
            setting(Method::Auto, 0.1),
            setting(Method::Sphere, 0.1),
            setting(Method::Sphere, 1e-4),
        ];
        let judged = sweep(&scene, &settings, 2, &truth).unwrap();
        let [auto, coarse, fine] = &judged[..] else {
            panic!("three settings were judged")
        };
        assert!(auto.errors.depth_max < 1e-9, "{auto:?}");
        assert_eq!(auto.evaluations, 0.0);
        assert_eq!(
            auto.errors.false_hits + auto.errors.false_misses + auto.errors.unknown,
            0
        );
        assert!(coarse.errors.depth_p99 > fine.errors.depth_p99);
        assert!(fine.errors.depth_p99 > 0.0);
        assert!(coarse.evaluations < fine.evaluations);
        assert!(auto.image.unwrap() < 1e-6 && coarse.image.unwrap() > auto.image.unwrap());
        assert_eq!(auto.milliseconds.rounds, 2);
    }
}
