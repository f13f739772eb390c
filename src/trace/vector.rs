//! Vectors without branches, to serve in lanes.

use glam::DVec3;
use std::borrow::Borrow;

/// Vector number `i` of columns by axis.
#[inline(always)]
pub fn place<const N: usize>(columns: &[impl Borrow<[f64; N]>; 3], i: usize) -> DVec3 {
    let columns = columns.each_ref().map(Borrow::borrow);
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}

/// The direction of `v`, or `other` where it has none.
#[inline(always)]
pub fn unit_or(v: DVec3, other: DVec3) -> DVec3 {
    let scale = 1.0 / v.length();
    let is_scale = (scale > 0.0) & (scale <= f64::MAX);
    select(is_scale, v * scale, other)
}

/// `a` where that holds, else `b`.
#[inline(always)]
pub fn select(holds: bool, a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        if holds { a.x } else { b.x },
        if holds { a.y } else { b.y },
        if holds { a.z } else { b.z },
    )
}
