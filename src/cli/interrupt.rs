//! Ctrl-C: the first asks the rendering to stop, the second stops the program.

use crate::output::remove_temporaries;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user asked to stop.
static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// The exit code of a program that Ctrl-C stopped.
const INTERRUPTED: i32 = 130;

/// Listens for Ctrl-C from now on, and gives the flag that it sets. Where the system has no such signal, nothing sets it.
pub fn listen() -> &'static AtomicBool {
    // Failing means that somebody listens already.
    let _ = ctrlc::set_handler(|| {
        if IS_INTERRUPTED.swap(true, Ordering::Relaxed) {
            remove_temporaries();
            std::process::exit(INTERRUPTED);
        }
    });
    &IS_INTERRUPTED
}
