//! What walls along periodic surfaces share: the sheet of a wave `w(2 pi p / cell)`, divided by its steepest slope.

use crate::num::Number;
use std::f64::consts::TAU;

/// The factor from lengths to the wave's angles.
pub(super) fn frequency(cell: f64) -> f64 {
    TAU / cell
}

/// The wall of this thickness around the zeros of a wave with the given steepest slope.
#[inline(always)]
pub(super) fn wall<N: Number>(wave: N, steepest: f64, cell: f64, thickness: f64) -> N {
    wave.abs() * N::splat(1.0 / (frequency(cell) * steepest)) - N::splat(0.5 * thickness)
}

/// Whether a wall leaves some space empty, where `share` is the wave's largest value over its steepest slope.
pub(super) fn fits(thickness: f64, cell: f64, share: f64) -> Result<(), (&'static str, String)> {
    let most = 2.0 * share / frequency(cell);
    if thickness < most {
        return Ok(());
    }
    let message =
        format!("must be below {most:.4} for this cell: else the wall fills all of space");
    Err(("thickness", message))
}
