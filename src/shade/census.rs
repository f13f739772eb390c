//! What shading did, in numbers.

use std::ops::AddAssign;
use std::time::{Duration, Instant};

/// Counts and times of shading; the counts are the same on every machine and for any number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays to lights; one that goes on through a tinted surface counts again.
    pub shadow: u64,
    /// Mirrored rays.
    pub reflected: u64,
    /// Rays into or out of a transparent solid.
    pub refracted: u64,
    /// Camera rays that hit a surface.
    pub hits: u64,
    /// Camera rays that met nothing.
    pub misses: u64,
    /// Camera rays whose tracing ended without an answer.
    pub unknown: u64,
    /// Other rays whose tracing ended without an answer.
    pub unknown_secondary: u64,
    /// Mirrored and refracted rays that were black because they lay deeper than the limit.
    pub too_deep: u64,
    /// Mirrored and refracted rays that were left out because they weighed too little.
    pub too_faint: u64,
    /// Evaluations of fields, by all rays.
    pub evaluations: u64,
    /// The time inside of the tracer, as a clock shows it.
    pub tracing: Tracing,
}

/// The time inside of the tracer, by the kind of rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tracing {
    /// For rays from the camera.
    pub primary: Duration,
    /// For rays to lights.
    pub shadow: Duration,
    /// For mirrored and refracted rays.
    pub secondary: Duration,
}

impl Tracing {
    /// The time for rays of all kinds.
    pub fn total(&self) -> Duration {
        self.primary + self.shadow + self.secondary
    }
}

impl AddAssign for Tracing {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.secondary += other.secondary;
    }
}

impl Census {
    /// Counts camera rays that met nothing.
    pub fn miss(&mut self, rays: usize) {
        self.primary += rays as u64;
        self.misses += rays as u64;
    }

    /// What `trace` gives, with the time that it took added to a kind of [`Census::tracing`].
    pub fn timed<T>(
        &mut self,
        kind: fn(&mut Tracing) -> &mut Duration,
        trace: impl FnOnce() -> T,
    ) -> T {
        let start = Instant::now();
        let result = trace();
        *kind(&mut self.tracing) += start.elapsed();
        result
    }
}

impl AddAssign for Census {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.reflected += other.reflected;
        self.refracted += other.refracted;
        self.hits += other.hits;
        self.misses += other.misses;
        self.unknown += other.unknown;
        self.unknown_secondary += other.unknown_secondary;
        self.too_deep += other.too_deep;
        self.too_faint += other.too_faint;
        self.evaluations += other.evaluations;
        self.tracing += other.tracing;
    }
}

/// The sum of counts.
pub(super) fn sum(counts: &[u32]) -> u64 {
    counts.iter().map(|count| u64::from(*count)).sum()
}
