//! How far the elementary functions and the lattice functions are from their exact values, over the whole range of their
//! arguments, and that lanes have the bits of scalars with the instructions of every processor.
//!
//! The reference of the elementary functions is `pxfm` in `f64`: it computes with about twice the bits, looks whether that
//! decides the rounding, and where it does not, computes with more (Ziv 1991). That is not proved for every argument;
//! its authors know of no result that is not correctly rounded, and tests here hold it against `libm`, written apart. Of an
//! `f32` result it says the exact value to 2^-30 of a unit of the last place.
//!
//! The test that looks at every `f32` there is takes half an hour of one processor and is run by name:
//! `cargo test --release --test ulps -- --ignored --nocapture`.

mod lattices;
mod levels;
mod one;
mod powers;
mod precision;
mod samples;
mod two;
