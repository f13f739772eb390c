//! The box around a solid that is known by its field alone.

use super::Bounds;
use crate::num::{Number, Vec3};

/// How often a box is halved along each axis. The result is a few of the smallest boxes too large on each side, the more the
/// further the field lies below the distance.
const HALVINGS: u32 = 7;

/// A box around the points of `start` where `field` is not positive; `start` where there is none. The field is at most the
/// distance to them.
pub(super) fn enclosure(start: Bounds, field: impl Fn([f64; 3]) -> f64) -> Bounds {
    let mut hull = Bounds::EMPTY;
    let mut parts = vec![(start, 0)];
    while let Some((part, depth)) = parts.pop() {
        let centre = part.centre();
        let half = std::array::from_fn(|i| part.high[i] - centre[i]);
        if hull.encloses(&part) || field(centre) > Bounds::centred(half).radius() {
            continue;
        }
        if depth == 3 * HALVINGS {
            hull = hull.hull(part);
            continue;
        }
        let (mut below, mut above) = (part, part);
        let axis = depth as usize % 3;
        (below.high[axis], above.low[axis]) = (centre[axis], centre[axis]);
        parts.extend([(below, depth + 1), (above, depth + 1)]);
    }
    if hull.is_empty() { start } else { hull }
}

/// The distance to a box, measured along the axis where it is largest; negative inside.
#[inline(always)]
pub(super) fn beyond<N: Number>(bounds: &Bounds, p: &Vec3<N>) -> N {
    let size = bounds.size();
    let from_middle = (*p - Vec3::splat(bounds.centre())).abs();
    let half = Vec3::splat([0.5 * size[0], 0.5 * size[1], 0.5 * size[2]]);
    (from_middle - half).max_component()
}
