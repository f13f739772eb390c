//! Methods side by side: the reference against closed forms, the others against the reference, steps against theory.

mod promises;
#[path = "../rays/mod.rs"]
mod rays;
mod reference;
mod steps;

use fieldstone::lang::load_text;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Footprint, Outcome, Ray, SceneTracer, Visibility, World};
use glam::DVec3;
use rays::{aimed, ray};
use std::sync::Arc;

/// A ray whose pixel is as wide as `at_origin + spread t`.
fn ray_of_pixel(origin: [f64; 3], direction: [f64; 3], at_origin: f64, spread: f64) -> Ray {
    Ray {
        origin: DVec3::from_array(origin),
        direction: DVec3::from_array(direction).normalize(),
        t_max: f64::INFINITY,
        footprint: Footprint { at_origin, spread },
    }
}

/// What a script shows.
fn shown(script: &str) -> Vec<Arc<Node>> {
    load_text("test.sdf", script, &[], &SceneTracer::default())
        .unwrap_or_else(|error| panic!("{script}: {error}"))
        .scene
        .shown
}

fn settings(method: Method) -> Settings {
    Settings {
        method,
        ..Settings::default()
    }
}

/// What rays find in a script by the given settings.
fn traced(script: &str, settings: Settings, rays: &[Ray]) -> Vec<Outcome> {
    let world = World::of(&shown(script), &settings).expect("a world");
    world.nearest(rays, Visibility::All)
}
