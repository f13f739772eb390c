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
    /// Walks of rays that met a field steeper than its Lipschitz constant.
    pub refuted: u64,
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
        Ok(self.run(scene, threads)?.0)
    }

    /// What the camera's rays hit, and how many walks refuted a constant.
    fn run(&self, scene: &Scene, threads: usize) -> Result<(Hits, u64), Fault> {
        let scene = self.applied(scene);
        let world = World::new(&scene)?;
        let hits = Hits::of(&scene, &world, threads);
        let refuted = world.refuted().iter().map(|refuted| refuted.walks).sum();
        Ok((hits, refuted))
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
    let mut first: Vec<Option<(Hits, u64)>> = vec![None; settings.len()];
    for round in 0..rounds.max(1) {
        for (i, setting) in settings.iter().enumerate() {
            if round > 0 && times[i][0] > LONG {
                continue;
            }
            let run = setting.run(scene, 1)?;
            times[i].push(run.0.milliseconds());
            first[i].get_or_insert(run);
        }
    }
    let mut judged = Vec::with_capacity(settings.len());
    for ((setting, times), run) in settings.iter().zip(times).zip(first) {
        let (hits, refuted) = run.unwrap_or_default();
        let image = match &truth.film {
            Some(film) => root_mean_square(&setting.film(scene)?, film),
            None => None,
        };
        judged.push(Judged {
            setting: *setting,
            errors: Errors::of(&hits, &truth.hits),
            refuted,
            evaluations: hits.evaluations(),
            milliseconds: Spread::of(times).expect("there is at least one round"),
            image,
        });
    }
    Ok(judged)
}

/// The place of a setting on a chart; less is better on both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The error.
    pub error: f64,
    /// The work, at least: the smallest that was measured.
    pub work: f64,
    /// Up to where measurements of the work spread; the same where it is a count.
    pub upper: f64,
}

impl Place {
    /// A place whose work is a count.
    pub fn counted(error: f64, work: f64) -> Self {
        Self {
            error,
            work,
            upper: work,
        }
    }

    fn is_number(&self) -> bool {
        !(self.error.is_nan() || self.work.is_nan() || self.upper.is_nan())
    }

    /// Whether the work is surely less: the spreads lie apart.
    fn works_less(&self, other: &Self) -> bool {
        self.upper < other.work
    }

    /// Whether it is at least as good on both axes and better on one, as far as spreads let that be said. What is not a number
    /// beats nothing.
    pub fn beats(&self, other: &Self) -> bool {
        let is_worse = self.error > other.error || other.works_less(self);
        let is_better = self.error < other.error || self.works_less(other);
        self.is_number() && !is_worse && is_better
    }
}

/// Which of these places no other one beats; what is not a number is on no front.
pub fn pareto(places: &[Place]) -> Vec<bool> {
    places
        .iter()
        .map(|place| place.is_number() && !places.iter().any(|other| other.beats(place)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Function, Sphere};
    use crate::scene::{Camera, FieldShape, GraphBuilder, Node, Settings};
    use glam::DVec3;

    #[test]
    fn front_is_what_nothing_beats() {
        let places = [
            [0.0, 5.0],
            [1.0, 3.0],
            [1.0, 4.0],
            [2.0, 3.0],
            [3.0, 1.0],
            [f64::NAN, 0.0],
            [3.0, 1.0],
        ]
        .map(|[error, work]| Place::counted(error, work));
        assert_eq!(
            pareto(&places),
            [true, true, false, false, true, false, true]
        );
    }

    /// Of two times that overlap neither is less, so the nearer one has the front; where both are as near, both have it.
    #[test]
    fn times_that_overlap_are_not_ranked() {
        let timed = |error, work, upper| Place { error, work, upper };
        let apart = [timed(0.0, 10.0, 11.0), timed(1.0, 8.0, 9.0)];
        assert_eq!(pareto(&apart), [true, true]);
        let overlap = [timed(0.0, 10.0, 11.0), timed(1.0, 8.0, 10.5)];
        assert_eq!(pareto(&overlap), [true, false]);
        let alike = [timed(0.0, 10.0, 11.0), timed(0.0, 8.0, 10.5)];
        assert_eq!(pareto(&alike), [true, true]);
        let slower = [timed(0.0, 10.0, 11.0), timed(0.0, 8.0, 9.0)];
        assert_eq!(pareto(&slower), [false, true]);
    }

    fn three_times_a_ball(claimed: f64) -> FieldShape {
        let mut b = GraphBuilder::new();
        let p = b.point();
        let r = b.call(Function::Norm3, &p);
        let [one, three] = [1.0, 3.0].map(|x| b.constant(x));
        let distance = b.subtract(r, one);
        let field = b.multiply(three, distance);
        FieldShape {
            name: "steep".into(),
            graph: b.finish(&[field]).into(),
            claimed: Some(claimed),
        }
    }

    /// A field that is a ball's distance times 3, with the constant 1 claimed for it: every ray that samples it near the ball and
    /// far from it finds the claim too small. With the constant 3 none does.
    #[test]
    fn refuted_constants_are_counted() {
        let judged = |claimed: f64| {
            let mut scene = Scene {
                shown: vec![Node::field(three_times_a_ball(claimed)).unwrap()],
                camera: Camera {
                    eye: DVec3::new(0.0, 0.0, 5.0),
                    at: DVec3::ZERO,
                    ..Camera::default()
                },
                ..Scene::default()
            };
            scene.settings.size = [16, 16];
            let truth = Truth::of(&scene, false).unwrap();
            let setting = |method| Setting {
                method,
                tolerance: 0.1,
            };
            let settings = [Method::Auto, Method::Sphere].map(setting);
            sweep(&scene, &settings, 1, &truth).unwrap()
        };
        for judged in judged(1.0) {
            assert!(judged.refuted > 0, "{judged:?}");
        }
        for judged in judged(3.0) {
            assert_eq!(judged.refuted, 0, "{judged:?}");
        }
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
