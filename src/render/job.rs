//! The whole picture: tiles on threads.

use super::film::Patch;
use super::refine::{NEEDED, Refined};
use super::statistics::{Layout, Tally};
use super::tile::{Shared, Tile};
use super::{Channel, Film, Statistics, View};
use crate::scene::{Sampling, Scene};
use crate::shade::{Surfaces, Whitted};
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The stack of a thread: deep scenes recurse in their closures.
const STACK_BYTES: usize = 16 << 20;

/// How far a rendering is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Tiles that are done.
    pub done: usize,
    /// Tiles of the picture; where samples are adaptive, each is there twice.
    pub tiles: usize,
}

/// How a rendering is carried out; none of it changes a bit of the film.
#[derive(Clone, Copy)]
pub struct RenderOptions<'a> {
    /// What is recorded.
    pub channels: &'a [Channel],
    /// How many threads work; 0 for one on each processor.
    pub threads: usize,
    /// How wide and high a tile is, in pixels: rounded up to a multiple of 16.
    pub tile: u32,
    /// Is told after each tile, by whichever thread rendered it.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    /// Ends the rendering once it is true.
    pub cancel: Option<&'a AtomicBool>,
}

impl Default for RenderOptions<'_> {
    fn default() -> Self {
        Self {
            channels: &[Channel::Beauty],
            threads: 0,
            tile: 32,
            progress: None,
            cancel: None,
        }
    }
}

impl RenderOptions<'_> {
    fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }
}

/// A finished rendering.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// What was recorded.
    pub film: Film,
    /// What it took.
    pub statistics: Statistics,
    /// Whether it was cancelled: then some tiles are black.
    pub cancelled: bool,
}

/// What `work` gives for each of `items`, on so many threads, or 0 for one on each processor; and how many worked.
pub(super) fn on_threads<T: Sync, R: Send>(
    threads: usize,
    items: &[T],
    work: impl Fn(&T) -> R + Sync,
) -> (Vec<R>, usize) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK_BYTES)
        .build();
    match pool {
        Ok(pool) => {
            // One by one: in larger shares one thread waits for the other at the end, of S6 a twelfth of the time.
            let results = pool.install(|| items.par_iter().with_max_len(1).map(&work).collect());
            (results, pool.current_num_threads())
        }
        // Where the system grants no threads, this one does the work.
        Err(_) => (items.iter().map(work).collect(), 1),
    }
}

/// The picture of `scene`, whose shapes are compiled into `world`. The film and all counts are the same to the bit for any
/// number of threads and size of tiles.
pub fn render<S: Surfaces + ?Sized>(scene: &Scene, world: &S, options: &RenderOptions) -> Rendered {
    let start = Instant::now();
    let settings = &scene.settings;
    let samples = settings.samples.max(1);
    let is_adaptive = settings.sampling == Sampling::Adaptive && samples > 1;
    let mut channels = options.channels.to_vec();
    if is_adaptive {
        channels.extend(NEEDED);
    }
    let mut film = Film::new(settings.size, &channels);
    let channels: Vec<Channel> = film.planes().iter().map(|plane| plane.channel).collect();
    let mut shared = Shared {
        whitted: Whitted::new(scene, world),
        view: View::new(&scene.camera, settings.size),
        samples: if is_adaptive { 1 } else { samples },
        seed: settings.seed,
        refined: None,
        channels: &channels,
    };
    let mut round = Round {
        options,
        tiles: Tile::all(settings.size, options.tile.max(1)),
        rounds: 1 + usize::from(is_adaptive),
        recording: Recording::default(),
        threads: 1,
    };
    round.expose(&shared, &mut film);
    let mut refined_pixels = 0;
    if is_adaptive && !options.is_cancelled() {
        let refined = Refined::of(&film);
        refined_pixels = refined.count();
        shared.samples = samples;
        shared.refined = Some(&refined);
        // Those without an answer are asked again.
        round.recording.tally.unknown_pixels = 0;
        round.expose(&shared, &mut film);
    }
    film.keep(options.channels);
    let Round {
        recording, threads, ..
    } = &round;
    Rendered {
        film,
        statistics: recording.tally.statistics(Layout {
            size: settings.size,
            samples,
            refined_pixels,
            threads: *threads,
            wall: start.elapsed(),
        }),
        cancelled: recording.done < round.rounds * round.tiles.len(),
    }
}

/// The tiles of a picture, which are recorded once or, where samples are adaptive, twice.
struct Round<'a> {
    options: &'a RenderOptions<'a>,
    tiles: Vec<Tile>,
    /// How many times.
    rounds: usize,
    recording: Recording,
    threads: usize,
}

impl Round<'_> {
    /// Records all tiles on the film.
    fn expose<S: Surfaces + ?Sized>(&mut self, shared: &Shared<S>, film: &mut Film) {
        let (options, tiles) = (self.options, &self.tiles);
        let side = tiles.first().map_or([1; 2], Tile::size);
        let patches = film.patches(side).into_iter().map(Mutex::new);
        let jobs: Vec<(&Tile, Mutex<Patch>)> = tiles.iter().zip(patches).collect();
        let result = Mutex::new(std::mem::take(&mut self.recording));
        let all = self.rounds * tiles.len();
        let work = |(tile, patch): &(&Tile, Mutex<Patch>)| {
            if options.is_cancelled() {
                return;
            }
            // Another thread panicked if either is poisoned; rayon passes that on.
            let Ok(mut patch) = patch.lock() else {
                return;
            };
            let cost = tile.render(shared, &mut patch);
            let Ok(mut recording) = result.lock() else {
                return;
            };
            let done = recording.add(cost);
            drop(recording);
            if let Some(progress) = options.progress {
                progress(Progress { done, tiles: all });
            }
        };
        (_, self.threads) = on_threads(options.threads, &jobs, work);
        drop(jobs);
        self.recording = result
            .into_inner()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
    }
}

/// What the tiles took so far. Counts only add up, so the order does not matter.
#[derive(Default)]
struct Recording {
    tally: Tally,
    done: usize,
}

impl Recording {
    /// Adds a tile, and gives how many there are now.
    fn add(&mut self, cost: Tally) -> usize {
        self.tally += cost;
        self.done += 1;
        self.done
    }
}
