//! Floor 0: the numbers that a field can be evaluated over, and vectors of them.
//!
//! A distance function is written once over [`Number`]; which type it runs on decides what comes out: `f64` a value,
//! [`Lanes`] many values at once, [`Dual`] a value with exact derivatives, [`Interval`] the range over a region, [`Rounded`]
//! how far `f32` can be off there, [`Bent`] how far the field can bend.

mod batch;
mod bent;
mod columns;
mod dual;
mod float;
mod interval;
mod kernels;
mod lanes;
mod lattice;
mod lattice_range;
mod number;
mod rounded;
mod rows;
#[cfg(test)]
pub(crate) mod samples;
mod scalar;
mod steep;
mod vector;

pub use batch::{BATCH, Column, ROOM};
pub use bent::Bent;
pub use columns::Columns;
pub use dual::Dual;
pub use interval::Interval;
pub use lanes::{F32x32, F32x64, F64x16, F64x32, Lanes};
pub use lattice::Lattice;
pub use number::Number;
pub use rounded::Rounded;
pub use rows::Rows;
pub use steep::Steep;
pub use vector::Vec3;
