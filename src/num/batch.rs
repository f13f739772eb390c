//! Columns for the numbers of rays that are treated together.

/// How many rays are treated together at most: those of a block of 16 x 16 pixels, or those that follow from them.
pub const BATCH: usize = 256;

/// The length of a column: a cache line more than a batch. Were it a power of two, columns side by side would share the same
/// few places of the cache and drive each other out: a twentieth of the time of s1 and three spheres.
pub const ROOM: usize = BATCH + 8;

/// A number for each ray of a batch.
pub type Column = [f64; ROOM];
