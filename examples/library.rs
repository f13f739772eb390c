//! Fieldstone as a library: builds a scene in code, traces one ray, renders a picture.
//!
//! `cargo run --release --example library` writes `library.png` into the current folder.

use fieldstone::catalogue::{
    AnyBlend, AnyModifier, AnyPrimitive, Combination, Cuboid, Operation, Plane, Smooth, Sphere,
    Torus, Translate, Twist,
};
use fieldstone::output::{Metadata, save};
use fieldstone::render::{RenderOptions, render};
use fieldstone::scene::{Camera, Falloff, Fault, Light, Material, Node, Scene, Sky, Source, Term};
use fieldstone::trace::{Footprint, Ray, Visibility, World};
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

fn moved(child: Arc<Node>, by: [f64; 3]) -> Result<Arc<Node>, Fault> {
    Node::modifier(AnyModifier::Translate(Translate::new(by)), child)
}

/// A twisted column, a ball that melts into a ring, a floor.
fn shapes() -> Result<Vec<Arc<Node>>, Fault> {
    let gold = Arc::new(Material {
        name: "gold".into(),
        color: Term::Constant(DVec3::new(0.7, 0.42, 0.1)),
        specular: Term::Constant(0.6),
        shininess: Term::Constant(60.0),
        reflect: Term::Constant(0.2),
        ..Material::default()
    });
    let bar = Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([0.7, 2.4, 0.7], 0.06)))?;
    let column = Node::modifier(AnyModifier::Twist(Twist::new(1.2)), bar)?;
    let ball = moved(
        Node::primitive(AnyPrimitive::Sphere(Sphere::new(0.55)))?,
        [0.0, 0.35, 0.0],
    )?;
    let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(0.75, 0.2)))?;
    let blend = AnyBlend::Smooth(Smooth::new(0.3));
    let melted = Node::combination(
        Combination {
            operation: Operation::Union,
            blend,
        },
        vec![ball, ring],
    )?;
    let floor = Node::primitive(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0)))?;
    Ok(vec![
        moved(column, [-0.9, 1.2, 0.0])?.painted(gold),
        moved(melted, [1.0, 0.25, 0.4])?,
        floor,
    ])
}

fn scene() -> Result<Scene, Fault> {
    let sun = Source::Directional {
        toward: DVec3::new(1.0, 2.0, 1.5).normalize(),
    };
    let lamp = Source::Point {
        position: DVec3::new(-4.0, 5.0, 3.0),
        falloff: Falloff::None,
    };
    let light = |source, strength: f64| Light {
        source,
        radiance: DVec3::splat(strength),
    };
    Ok(Scene {
        shown: shapes()?,
        lights: vec![light(sun, 0.8), light(lamp, 0.4)],
        camera: Camera {
            eye: DVec3::new(2.5, 2.6, 5.5),
            at: DVec3::new(0.1, 0.9, 0.0),
            ..Camera::default()
        },
        sky: Sky {
            horizon: DVec3::new(0.75, 0.82, 0.9),
            zenith: DVec3::new(0.16, 0.34, 0.7),
        },
        ..Scene::default()
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = scene().map_err(|fault| fault.message)?;
    let world = World::new(&scene).map_err(|fault| fault.message)?;
    for (path, node) in world.paths() {
        println!(
            "{} is found by {path}, Lipschitz constant {:.4}",
            node.kind(),
            node.lipschitz()
        );
    }
    let ray = Ray {
        origin: DVec3::new(-0.9, 1.2, 6.0),
        direction: -DVec3::Z,
        t_max: f64::INFINITY,
        footprint: Footprint {
            at_origin: 0.0,
            spread: 1e-3,
        },
    };
    let hit = world.nearest(&[ray], Visibility::All)[0];
    println!(
        "the ray ends in a {} at {:.6} +- {:.1e}",
        hit.verdict.word(),
        hit.t,
        hit.error
    );
    let picture = render(&scene, &world, &RenderOptions::default());
    println!("{} evaluations", picture.statistics.evaluations);
    save(
        &picture.film,
        Path::new("library.png"),
        &Metadata::default(),
    )?;
    Ok(())
}
