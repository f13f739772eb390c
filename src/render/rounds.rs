//! The same picture again and again, by several methods and numbers of threads in turn: what is compared is measured side by
//! side, so that whatever else the machine does strikes all of them alike.

use super::{Film, RenderOptions, Statistics, render};
use crate::scene::{Fault, Method, Scene};
use crate::trace::World;
use std::time::Instant;

/// One of the ways to make a picture that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Case {
    /// How rays find surfaces.
    pub method: Method,
    /// How many threads work; 0 for one on each processor.
    pub threads: usize,
}

/// What it took to make a picture once.
#[derive(Clone, Debug)]
pub struct Run {
    /// The time in which the shapes were compiled, in milliseconds.
    pub compile: f64,
    /// What the rendering took.
    pub statistics: Statistics,
}

impl Case {
    /// Makes the picture of `scene` this way; `options` say everything but the number of threads.
    ///
    /// # Errors
    /// If a shape can't be traced.
    pub fn run(&self, scene: &Scene, options: &RenderOptions) -> Result<(Run, Film), Fault> {
        let mut scene = scene.clone();
        scene.settings.method = self.method;
        let start = Instant::now();
        let world = World::new(&scene)?;
        let compile = start.elapsed().as_secs_f64() * 1e3;
        let options = RenderOptions {
            threads: self.threads,
            ..*options
        };
        let rendered = render(&scene, &world, &options);
        let run = Run {
            compile,
            statistics: rendered.statistics,
        };
        Ok((run, rendered.film))
    }
}

/// Makes the picture of `scene` in each of `cases` in turn, `number` times: for each case its runs.
///
/// # Errors
/// If a shape can't be traced.
pub fn rounds(
    scene: &Scene,
    cases: &[Case],
    number: usize,
    options: &RenderOptions,
) -> Result<Vec<Vec<Run>>, Fault> {
    let mut runs = vec![Vec::with_capacity(number); cases.len()];
    for _ in 0..number {
        for (case, runs) in cases.iter().zip(&mut runs) {
            let (run, _) = case.run(scene, options)?;
            runs.push(run);
        }
    }
    Ok(runs)
}
