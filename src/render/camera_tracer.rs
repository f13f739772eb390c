//! What scripts ask of a tracer, the counts of the camera's rays with it.

use super::tile::Tile;
use super::{Hits, RenderOptions};
use crate::scene::{Camera, CameraRecord, Node, Scene, Settings, TraceRecord, Tracer};
use crate::trace::{SceneTracer, Verdict, World};
use std::sync::Arc;

/// Traces the rays of scripts, and counts what those of their cameras take.
#[derive(Default)]
pub struct CameraTracer {
    rays: SceneTracer,
    threads: usize,
}

impl CameraTracer {
    /// One that counts on so many threads, or 0 for one on each processor, as by default. The counts do not depend on it.
    pub fn on(threads: usize) -> Self {
        Self {
            threads,
            ..Self::default()
        }
    }
}

impl Tracer for CameraTracer {
    fn trace(
        &self,
        shown: &[Arc<Node>],
        settings: &Settings,
        origin: [f64; 3],
        direction: [f64; 3],
    ) -> Result<TraceRecord, String> {
        self.rays.trace(shown, settings, origin, direction)
    }

    fn count(
        &self,
        shown: &[Arc<Node>],
        camera: &Camera,
        settings: &Settings,
    ) -> Result<CameraRecord, String> {
        let scene = Scene {
            shown: shown.to_vec(),
            camera: *camera,
            settings: *settings,
            ..Scene::default()
        };
        let world = World::new(&scene).map_err(|fault| fault.message)?;
        Ok(record(&scene, &Hits::of(&scene, &world, self.threads)))
    }
}

fn record(scene: &Scene, hits: &Hits) -> CameraRecord {
    let steps = hits.steps();
    let tiles = Tile::all(scene.settings.size, RenderOptions::default().tile);
    let blocks = tiles.iter().flat_map(Tile::blocks);
    let pixels: Vec<[u32; 2]> = blocks.flat_map(|block| block.pixels().to_vec()).collect();
    let row_first = |[x, y]: [u32; 2]| [y, x];
    let first = |is_meant: &dyn Fn(usize) -> bool| {
        let numbered = pixels.iter().enumerate();
        let meant = numbered
            .filter(|(i, _)| is_meant(*i))
            .map(|(_, pixel)| row_first(*pixel));
        meant.min().map(row_first)
    };
    CameraRecord {
        mean_steps: steps.mean,
        p99_steps: steps.p99,
        max_steps: steps.max,
        longest: first(&|i| hits.outcomes[i].steps == steps.max).unwrap_or_default(),
        mean_evaluations: hits.evaluations(),
        unknown: hits.census.unknown,
        first_unknown: first(&|i| hits.outcomes[i].verdict == Verdict::Unknown),
    }
}
