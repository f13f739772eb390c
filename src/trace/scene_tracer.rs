//! Single rays for scripts and for the command `trace`.

use super::{Footprint, Outcome, Ray, Visibility, World};
use crate::scene::{Camera, Node, Settings, TraceRecord, Tracer};
use glam::DVec3;
use std::sync::{Arc, Mutex};

/// Traces the rays of scripts: with the footprint of a pixel of the default camera.
#[derive(Default)]
pub struct SceneTracer {
    /// The world that was traced last, by the shapes and settings it was made of.
    last: Mutex<Option<Traced>>,
}

/// A world with the shapes and settings it was made of.
struct Traced {
    shown: Vec<Arc<Node>>,
    settings: Settings,
    world: Arc<World>,
}

impl SceneTracer {
    fn world(&self, shown: &[Arc<Node>], settings: &Settings) -> Result<Arc<World>, String> {
        let mut last = self
            .last
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(traced) = &*last {
            let is_same = traced.shown.len() == shown.len()
                && traced
                    .shown
                    .iter()
                    .zip(shown)
                    .all(|(a, b)| Arc::ptr_eq(a, b));
            if is_same && traced.settings == *settings {
                return Ok(traced.world.clone());
            }
        }
        let world = Arc::new(World::of(shown, settings).map_err(|fault| fault.message)?);
        *last = Some(Traced {
            shown: shown.to_vec(),
            settings: *settings,
            world: world.clone(),
        });
        Ok(world)
    }
}

/// The ray of a script or of the command line: its pixel is that of the default camera.
fn script_ray(settings: &Settings, origin: [f64; 3], direction: [f64; 3]) -> Ray {
    let direction = DVec3::from_array(direction);
    // The square of a length that is tiny or huge is no number: such a direction is first divided by its largest part.
    let squared = direction.length_squared();
    let direction = if squared.is_normal() {
        direction
    } else {
        direction / direction.abs().max_element()
    };
    Ray {
        origin: DVec3::from_array(origin),
        direction: direction.normalize_or_zero(),
        t_max: f64::INFINITY,
        footprint: Footprint {
            at_origin: 0.0,
            spread: Camera::default().pixel(settings.size)[1],
        },
    }
}

impl Tracer for SceneTracer {
    fn trace(
        &self,
        shown: &[Arc<Node>],
        settings: &Settings,
        origin: [f64; 3],
        direction: [f64; 3],
    ) -> Result<TraceRecord, String> {
        let world = self.world(shown, settings)?;
        let ray = script_ray(settings, origin, direction);
        if ray.direction == DVec3::ZERO || !ray.origin.is_finite() || !ray.direction.is_finite() {
            return Err("a ray needs a finite origin and a direction that is not zero".into());
        }
        let found: Outcome = world.nearest(&[ray], Visibility::All)[0];
        Ok(TraceRecord {
            verdict: found.verdict.word(),
            t: found.t,
            point: found.point.to_array(),
            normal: found.normal.to_array(),
            steps: found.steps,
            evaluations: found.evaluations,
        })
    }
}
