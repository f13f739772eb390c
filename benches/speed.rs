//! `cargo bench`: the scenes of `benches/scenes` at 320 x 180 on one thread: how many points a second their fields are evaluated
//! at, how many camera rays a second are traced, and how many pixels a second the whole pictures make.
//!
//! `cargo bench -- s2` runs what has `s2` in its name. Ratios between methods, with their spread: `fieldstone bench`.

use divan::Bencher;
use divan::counter::ItemsCount;
use fieldstone::catalogue::{AnyBlend, Combination, Operation};
use fieldstone::field::Packets;
use fieldstone::lang::load;
use fieldstone::render::{RenderOptions, View, render};
use fieldstone::scene::{Node, Scene};
use fieldstone::trace::{Rays, SceneTracer, Visibility, World};
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

fn main() {
    divan::main();
}

/// The scenes by their names.
const SCENES: [&str; 7] = ["s1", "s2", "s3", "s4", "s5a", "s5b", "s6"];

/// How wide the pictures are, in pixels.
const WIDTH: &str = "320";

/// How many points the fields are evaluated at.
const POINTS: usize = 4096;

/// The side of the squares of camera rays that are traced together.
const SIDE: u32 = 16;

fn scene(name: &str) -> Scene {
    let path = format!("{}/benches/scenes/{name}.sdf", env!("CARGO_MANIFEST_DIR"));
    let definitions = [("width".to_string(), WIDTH.to_string())];
    load(Path::new(&path), &definitions, &SceneTracer::default())
        .unwrap_or_else(|error| panic!("{name}: {error:?}"))
        .scene
}

fn world(scene: &Scene) -> World {
    World::new(scene).unwrap_or_else(|fault| panic!("{}", fault.message))
}

/// Everything that is shown as one field.
fn whole(scene: &Scene) -> Arc<Node> {
    let union = Combination {
        operation: Operation::Union,
        blend: AnyBlend::HARD,
    };
    Node::combination(union, scene.shown.clone())
        .unwrap_or_else(|fault| panic!("{}", fault.message))
}

/// Evenly scattered points of the cube of half a side of 2 around the origin: the additive sequence of the plastic number's
/// generalisation to three dimensions (Roberts 2018).
fn points() -> Vec<[f64; 3]> {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_3,
    ];
    (0..POINTS)
        .map(|i| STEPS.map(|step| 4.0 * (0.5 + i as f64 * step).fract() - 2.0))
        .collect()
}

/// Points a second.
#[divan::bench(args = SCENES, max_time = 2)]
fn evaluate(bencher: Bencher, name: &str) {
    let field = Packets::new(&whole(&scene(name)));
    let packets = Packets::of_points(&points());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        for packet in &packets {
            black_box(field.at(black_box(packet)));
        }
    });
}

/// Camera rays a second.
#[divan::bench(args = SCENES, max_time = 2, sample_count = 20, sample_size = 1)]
fn trace(bencher: Bencher, name: &str) {
    let scene = scene(name);
    let world = world(&scene);
    let rays = rays(&scene);
    let count: usize = rays.iter().map(Rays::len).sum();
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        for block in &rays {
            black_box(world.trace(black_box(block), Visibility::All));
        }
    });
}

/// The camera's rays, square by square.
fn rays(scene: &Scene) -> Vec<Rays> {
    let [width, height] = scene.settings.size;
    let view = View::new(&scene.camera, scene.settings.size);
    let square = |x: u32, y: u32| {
        let row = move |j: u32| (x..(x + SIDE).min(width)).map(move |i| [i, j]);
        let pixels: Vec<[u32; 2]> = (y..(y + SIDE).min(height)).flat_map(row).collect();
        view.rays(&pixels)
    };
    let starts = |end: u32| (0..end).step_by(SIDE as usize);
    starts(height)
        .flat_map(|y| starts(width).map(move |x| (x, y)))
        .map(|(x, y)| square(x, y))
        .collect()
}

/// Pixels a second.
#[divan::bench(args = SCENES, max_time = 2, sample_count = 20, sample_size = 1)]
fn picture(bencher: Bencher, name: &str) {
    let scene = scene(name);
    let world = world(&scene);
    let [width, height] = scene.settings.size;
    let options = RenderOptions {
        threads: 1,
        ..RenderOptions::default()
    };
    bencher
        .counter(ItemsCount::new(width * height))
        .bench_local(|| render(&scene, &world, &options).statistics.evaluations);
}
