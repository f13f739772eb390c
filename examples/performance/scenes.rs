//! The bench scenes, and how their times are written.

use crate::Outcome;
use fieldstone::lang::load;
use fieldstone::output::short;
use fieldstone::render::Spread;
use fieldstone::scene::Scene;
use fieldstone::trace::{SceneTracer, World};
use std::path::Path;

/// The scenes with what they show.
pub const SCENES: [(&str, &str); 7] = [
    ("s1", "ten spheres, checker, mirror, glass, two lights"),
    ("s2", "24 primitives in a smooth union"),
    ("s3", "a sphere cut with a gyroid sheet"),
    ("s4", "a box minus 20 cylinders minus 19 spheres"),
    ("s5a", "1000 objects, hard union"),
    ("s5b", "10 000 objects, hard union"),
    ("s6", "a twisted column"),
];

/// A bench scene with values for its parameters.
pub fn scene(name: &str, parameters: &[(&str, String)]) -> Outcome<Scene> {
    let definitions: Vec<(String, String)> = parameters
        .iter()
        .map(|(name, value)| (name.to_string(), value.clone()))
        .collect();
    let path = Path::new("benches/scenes").join(name).with_extension("sdf");
    let loaded = load(&path, &definitions, &SceneTracer::default());
    Ok(loaded.map_err(|error| format!("{name}: {error}"))?.scene)
}

/// A bench scene as wide as that: whole, or its object alone.
pub fn sized(name: &str, width: u32, is_object_only: bool) -> Outcome<Scene> {
    let mut parameters = vec![("width", width.to_string())];
    if is_object_only {
        parameters.push(("object_only", "1".into()));
    }
    scene(name, &parameters)
}

/// The world of a scene.
pub fn world(scene: &Scene) -> Outcome<World> {
    Ok(World::new(scene).map_err(|fault| fault.message)?)
}

/// A time with its spread, in milliseconds.
pub fn in_words(spread: &Spread) -> String {
    let [median, minimum, upper] = [spread.median, spread.minimum, spread.upper].map(short);
    format!("{median} ({minimum} to {upper})")
}

/// Whether a target is reached.
pub fn verdict(is_reached: bool) -> String {
    if is_reached { "yes" } else { "**no**" }.into()
}

/// What is said where something was not measured.
pub const NOT_MEASURED: &str = "not measured";
