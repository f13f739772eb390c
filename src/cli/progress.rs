//! How far a rendering is: a bar with the time left on a terminal, now and then a line elsewhere.

use super::console::say_line;
use crate::render::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Tells the user how far a rendering is.
pub enum Reporter {
    /// By a bar.
    Bar(ProgressBar),
    /// By lines.
    Lines(Mutex<Lines>),
    /// Not at all.
    Silent,
}

impl Reporter {
    /// The reporter for this kind of standard error.
    pub fn new(is_quiet: bool) -> Self {
        let is_dumb = std::env::var("TERM").is_ok_and(|term| term == "dumb");
        if is_quiet {
            Self::Silent
        } else if io::stderr().is_terminal() && !is_dumb {
            Self::Bar(bar())
        } else {
            Self::Lines(Mutex::new(Lines::new(Instant::now())))
        }
    }

    /// Tells of progress; threads may call it at once.
    pub fn tell(&self, progress: Progress) {
        match self {
            Self::Bar(bar) => {
                bar.set_length(progress.tiles as u64);
                // Threads may come in another order than their tiles were counted.
                bar.set_position(bar.position().max(progress.done as u64));
            }
            Self::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(line) = lines.due(progress, Instant::now()) {
                    say_line(&line);
                }
            }
            Self::Silent => {}
        }
    }

    /// Takes the bar away.
    pub fn end(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
        .expect("the template is well formed")
        .progress_chars("=> ");
    ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_style(style)
}

/// Lines for who reads no bar: at most one a second, and each at least 10 % after the one before.
#[derive(Debug)]
pub struct Lines {
    start: Instant,
    last: Instant,
    tenths: usize,
}

impl Lines {
    const PAUSE: Duration = Duration::from_secs(1);

    fn new(start: Instant) -> Self {
        Self {
            start,
            last: start,
            tenths: 0,
        }
    }

    /// The line that is due at this moment, if one is.
    fn due(&mut self, progress: Progress, now: Instant) -> Option<String> {
        let tenths = progress.done * 10 / progress.tiles.max(1);
        let is_done = progress.done >= progress.tiles;
        if tenths <= self.tenths || is_done || now.duration_since(self.last) < Self::PAUSE {
            return None;
        }
        (self.tenths, self.last) = (tenths, now);
        let passed = now.duration_since(self.start).as_secs_f64();
        let left = passed * (progress.tiles - progress.done) as f64 / progress.done as f64;
        let percent = progress.done * 100 / progress.tiles;
        Some(format!("{percent:>3} %, {left:.0} s left"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_at_most_once_a_second_and_every_tenth() {
        let start = Instant::now();
        let mut lines = Lines::new(start);
        let mut due = |done, milliseconds| {
            let now = start + Duration::from_millis(milliseconds);
            lines.due(Progress { done, tiles: 200 }, now)
        };
        assert_eq!(due(40, 500), None, "too early");
        assert_eq!(due(50, 2000).as_deref(), Some(" 25 %, 6 s left"));
        assert_eq!(due(100, 2500), None, "too soon after the last");
        assert_eq!(due(58, 4000), None, "not a tenth further");
        assert_eq!(due(100, 4000).as_deref(), Some(" 50 %, 4 s left"));
        assert_eq!(due(200, 8000), None, "the summary follows");
    }
}
