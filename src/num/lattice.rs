//! Functions on the lattice of whole points: gradient noise, and the distance to scattered points.
//!
//! Every cell draws its random numbers from a permutation polynomial in plain floating point: (34 x + 10) x mod 289, of
//! which all steps are exact whole numbers below 2^23, so `f32`, `f64` and lanes agree on them without any integers. The
//! functions repeat themselves after 289 cells along each axis. Coordinates find their cell up to 2^22 in
//! `f32` and 2^51 in `f64`; values there are off by at most [`Lattice::roundings`], further out they stay in their range.
//! Sources: Perlin 2002 (noise); Worley 1996 (distance); McEwan, Sheets, Richardson, Gustavson 2012 (hashing).

use super::Number;

/// A function on the lattice of whole points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lattice {
    /// Perlin's gradient noise: zero at whole points, smooth between them.
    Noise,
    /// The distance to the nearest of the points that lie scattered one in every cell.
    Voronoi,
}

/// The numbers that a hash can be.
const PERIOD: f64 = 289.0;

impl Lattice {
    /// The values lie within `[low, high]`.
    ///
    /// Noise: the largest sum of corner weights times corner products, over all choices of the twelve gradients and all
    /// points of a cell, is 1.036353811. Voronoi: no point is further than that from a corner of the box
    /// [1/8, 7/8] x [1/8, 7/8] x [3/16, 13/16] of its own cell or the nearest of its neighbours.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Noise => [-1.036_354, 1.036_354],
            Self::Voronoi => [0.0, 1.481_1],
        }
    }

    /// The largest slope.
    ///
    /// Noise: 3.75, at the middle of a cell whose corners pull to both sides along an axis: twice the slope 15/8 of the
    /// fade. Climbing over point, direction and all choices of gradients finds
    /// no larger one; branch and bound shows that none is above 3.765.
    pub fn lipschitz(self) -> f64 {
        match self {
            Self::Noise => 3.75,
            Self::Voronoi => 1.0,
        }
    }

    /// The largest second derivative along a line, on either side of zero: infinite where there are kinks.
    ///
    /// Noise: climbing over point, direction and all choices of gradients finds 14.4652, at (0.5, 0.3992, 0.3992) of a cell and
    /// places like it; branch and bound shows that none is above 20.
    pub fn bend(self) -> f64 {
        match self {
            Self::Noise => 20.0,
            Self::Voronoi => f64::INFINITY,
        }
    }

    /// By how much a value can be off, in units of `u`, half of the width's `EPSILON` (2^-24 in `f32`, 2^-53 in `f64`), at
    /// points whose coordinates are at most 2^22 in `f32` and 2^51 in `f64`. This is an absolute error: where the value
    /// is near zero, so are the terms that it is the difference of not.
    ///
    /// Noise. Hashes and gradients are exact. A place t in the cell is off by u / 2 (below 0 it may round): 3.75 sqrt(3) / 2,
    /// together 4. The fade is t^3 times q = t (6 t - 15) + 10, where q is off by (10 + 15 t) u, plus three roundings of the
    /// product: at most w(t) = t^3 (10 + 15 t) + 3 fade(t). It mixes two faces whose heights differ by at most 1 + 2 m + 2 n,
    /// where m and n are the means of the distances to the two sides along the other axes: the sum over the axes of
    /// w (1 + 2 m + 2 n) is at most 117 (a test finds it). Heights are at most 2: their two terms take 6, each of three mixtures
    /// one after the other 10: 4 of the difference, 4 of its product, 2 of the sum. In all 157.
    ///
    /// Distance: each of x - first, - i, - place takes at most 2 u, so a way is off by 6 u an axis, 10.4 in length; the length
    /// of at most 1.49 takes 2.5 u of itself. In all 14.2.
    pub fn roundings(self) -> f64 {
        match self {
            Self::Noise => 160.0,
            Self::Voronoi => 16.0,
        }
    }
}

/// How often `m` goes into the whole number `x`, from 0 to four millions. The reciprocal is too large by a part in 2^23: enough
/// for its rounding, in `f32` too, and too little to reach the next whole number.
#[inline(always)]
fn quotient<N: Number>(x: N, m: f64) -> N {
    (x * N::splat((1.0 + 1.0 / (1u32 << 23) as f64) / m)).floor()
}

/// What is left of the whole number `x`, from 0 to four millions, above a multiple of `m`.
#[inline(always)]
fn modulo<N: Number>(x: N, m: f64) -> N {
    x - quotient(x, m) * N::splat(m)
}

/// A permutation of the whole numbers below 289; others, from -289 to 291, count by what they leave.
#[inline(always)]
fn hash<N: Number>(x: N) -> N {
    modulo((x * N::splat(34.0) + N::splat(10.0)) * x, PERIOD)
}

/// A number up to 291 less the period, as [`hash_next`] takes it: the sum with a hash is then one of those that can be hashed.
#[inline(always)]
fn less<N: Number>(i: N) -> N {
    i - N::splat(PERIOD)
}

/// The hash of a row's hash `h` and a number that is [`less`].
#[inline(always)]
fn hash_next<N: Number>(h: N, i: N) -> N {
    hash(h + i)
}

/// The number of a cell that starts at the whole number `x`, from 0 to 288. The half keeps the product off whole numbers, so
/// that its rounding does not matter.
#[inline(always)]
fn cell<N: Number>(x: N) -> N {
    let times = ((x + N::splat(0.5)) * N::splat(1.0 / PERIOD)).floor();
    (x - times * N::splat(PERIOD)).clamp(N::splat(0.0), N::splat(PERIOD - 1.0))
}

/// The quintic 6 t^5 - 15 t^4 + 10 t^3. Source: Perlin 2002.
#[inline(always)]
pub(super) fn fade<N: Number>(t: N) -> N {
    t.square() * t * (t * (t * N::splat(6.0) - N::splat(15.0)) + N::splat(10.0))
}

/// The derivative of [`fade`].
#[inline(always)]
pub(super) fn fade_slope<N: Number>(t: N) -> N {
    (t * (N::splat(1.0) - t)).square() * N::splat(30.0)
}

/// The hash of the cell or corner at three whole numbers.
pub(super) fn hash_at(corner: [f64; 3]) -> f64 {
    let [i, j, k] = corner.map(cell);
    hash_next(hash_next(hash(i), less(j)), less(k))
}

/// What a corner draws: a plane across an axis (0, 1 or 2), and a sign for each of two directions in it.
#[inline(always)]
fn drawn<N: Number>(h: N) -> (N, N, N) {
    let one = N::splat(1.0);
    let number = modulo(h, 12.0);
    let plane = (number * N::splat(0.25)).floor();
    let signs = number - plane * N::splat(4.0);
    let upper = (signs * N::splat(0.5)).floor();
    let lower = signs - upper - upper;
    (plane, one - lower - lower, one - upper - upper)
}

/// One of three numbers, by that of a plane.
#[inline(always)]
fn chosen<N: Number>(plane: N, x: N, y: N, z: N) -> N {
    let (first, second) = (N::splat(0.5), N::splat(1.5));
    N::select_lt(plane, first, x, N::select_lt(plane, second, y, z))
}

/// The gradient that a corner draws: one of the twelve directions from the middle of a cube to its edges.
#[inline(always)]
pub(super) fn gradient<N: Number>(h: N) -> [N; 3] {
    let zero = N::splat(0.0);
    let (plane, s, t) = drawn(h);
    [
        chosen(plane, s, zero, t),
        chosen(plane, t, s, zero),
        chosen(plane, zero, t, s),
    ]
}

/// The product of the gradient that a corner draws and the way `(x, y, z)` from it to a point.
#[inline(always)]
fn height<N: Number>(h: N, x: N, y: N, z: N) -> N {
    let (plane, s, t) = drawn(h);
    s * chosen(plane, x, y, z) + t * chosen(plane, y, z, x)
}

/// A coordinate as the number of its cell and the place in it.
#[inline(always)]
fn split<N: Number>(x: N) -> (N, N) {
    let floor = x.floor();
    (cell(floor), x - floor)
}

/// The hashes of the corners of the cell that begins at the whole numbers `(i, j, k)`, by their places along x, y and z.
#[inline(always)]
fn corners<N: Number>(i: N, j: N, k: N) -> [[[N; 2]; 2]; 2] {
    let one = N::splat(1.0);
    let (j, k) = (less(j), less(k));
    let mut hashes = [[[i; 2]; 2]; 2];
    for (right, i) in [i, i + one].into_iter().enumerate() {
        let row = hash(i);
        for (top, j) in [j, j + one].into_iter().enumerate() {
            let column = hash_next(row, j);
            for (front, k) in [k, k + one].into_iter().enumerate() {
                hashes[right][top][front] = hash_next(column, k);
            }
        }
    }
    hashes
}

/// `a` for `t = 0`, `b` for `t = 1`, straight between.
#[inline(always)]
fn lerp<N: Number>([a, b]: [N; 2], t: N) -> N {
    a + (b - a) * t
}

/// The value of gradient noise.
#[inline(always)]
pub(super) fn noise<N: Number>(x: N, y: N, z: N) -> N {
    let one = N::splat(1.0);
    let ((i, u), (j, v), (k, w)) = (split(x), split(y), split(z));
    let (ways_x, ways_y, ways_z) = ([u, u - one], [v, v - one], [w, w - one]);
    let (a, b, c) = (fade(u), fade(v), fade(w));
    let hashes = corners(i, j, k);
    let mut sides = [x; 2];
    for (right, side) in sides.iter_mut().enumerate() {
        let mut edges = [x; 2];
        for (top, edge) in edges.iter_mut().enumerate() {
            let mut heights = [x; 2];
            for (front, h) in heights.iter_mut().enumerate() {
                *h = height(
                    hashes[right][top][front],
                    ways_x[right],
                    ways_y[top],
                    ways_z[front],
                );
            }
            *edge = lerp(heights, c);
        }
        *side = lerp(edges, b);
    }
    lerp(sides, a)
}

/// The gradient of gradient noise: the mean gradient of the corners, and along each axis the slope of the fade times how much
/// higher one side is than the other.
#[inline(always)]
pub(super) fn noise_slope<N: Number>(x: N, y: N, z: N) -> [N; 3] {
    let one = N::splat(1.0);
    let ((i, u), (j, v), (k, w)) = (split(x), split(y), split(z));
    let (ways_x, ways_y, ways_z) = ([u, u - one], [v, v - one], [w, w - one]);
    let (a, b, c) = (fade(u), fade(v), fade(w));
    let hashes = corners(i, j, k);
    // Of each side, edge and corner: the gradient, the height, and how much it rises along z and along y.
    let mut sides = [[x; 2]; 6];
    for right in 0..2 {
        let mut edges = [[x; 2]; 5];
        for top in 0..2 {
            let mut ends = [[x; 2]; 4];
            for front in 0..2 {
                let g = gradient(hashes[right][top][front]);
                let height = g[0] * ways_x[right] + g[1] * ways_y[top] + g[2] * ways_z[front];
                (ends[0][front], ends[1][front], ends[2][front]) = (g[0], g[1], g[2]);
                ends[3][front] = height;
            }
            for n in 0..4 {
                edges[n][top] = lerp(ends[n], c);
            }
            edges[4][top] = ends[3][1] - ends[3][0];
        }
        for n in 0..5 {
            sides[n][right] = lerp(edges[n], b);
        }
        sides[5][right] = edges[3][1] - edges[3][0];
    }
    [
        lerp(sides[0], a) + fade_slope(u) * (sides[3][1] - sides[3][0]),
        lerp(sides[1], a) + fade_slope(v) * lerp(sides[5], a),
        lerp(sides[2], a) + fade_slope(w) * lerp(sides[4], a),
    ]
}

/// Where in its cell a point lies: on a grid of steps of 1/8, no nearer than 1/8 to the border.
#[inline(always)]
pub(super) fn scattered<N: Number>(h: N) -> [N; 3] {
    let (step, seven) = (N::splat(0.125), N::splat(7.0));
    let (rows, layers) = (quotient(h, 7.0), quotient(h, 49.0));
    [
        (h - rows * seven) * step + N::splat(0.125),
        (rows - layers * seven) * step + N::splat(0.125),
        layers * step + N::splat(0.1875),
    ]
}

/// The vector from the nearest scattered point to `(x, y, z)`, and the square of its length.
///
/// Of each axis four cells matter: with u in [0, 1/2] the place in the own cell (the other half is its mirror image),
/// those from 2 before to 1 behind. All scattered points keep a = 1/8 from the borders, so the one in the own cell is at
/// most 1 - a - u away along each axis, together at most 1.516; a point 3 before or 2 behind is at least 3/2 + a = 1.625
/// away. A point 2 before is at least 1 + a + u away, one behind 1 + a - u: where this holds along all three axes, the own
/// point is nearer, so such cells are left out.
#[inline(always)]
fn nearest<N: Number>(x: N, y: N, z: N) -> ([N; 3], N) {
    let half = N::splat(0.5);
    let first = [
        (x - half).floor() - N::splat(1.0),
        (y - half).floor() - N::splat(1.0),
        (z - half).floor() - N::splat(1.0),
    ];
    let numbers = [cell(first[0]), less(cell(first[1])), less(cell(first[2]))];
    let from = [x - first[0], y - first[1], z - first[2]];
    let mut way = [N::splat(0.0); 3];
    let mut shortest = N::splat(f64::INFINITY);
    for i in 0..4 {
        let row = hash(numbers[0] + N::splat(f64::from(i)));
        for j in 0..4 {
            let column = hash_next(row, numbers[1] + N::splat(f64::from(j)));
            for k in 0..4 {
                let is_outer = |n: i32| n == 0 || n == 3;
                if is_outer(i) && is_outer(j) && is_outer(k) {
                    continue;
                }
                let h = hash_next(column, numbers[2] + N::splat(f64::from(k)));
                let place = scattered(h);
                let dx = from[0] - N::splat(f64::from(i)) - place[0];
                let dy = from[1] - N::splat(f64::from(j)) - place[1];
                let dz = from[2] - N::splat(f64::from(k)) - place[2];
                let squared = dx.square() + dy.square() + dz.square();
                way[0] = N::select_lt(squared, shortest, dx, way[0]);
                way[1] = N::select_lt(squared, shortest, dy, way[1]);
                way[2] = N::select_lt(squared, shortest, dz, way[2]);
                shortest = squared.min(shortest);
            }
        }
    }
    // A coordinate that is not finite has no nearest point: then its place is not a number, and so is what this adds.
    let nothing = (from[0] + from[1] + from[2]) * N::splat(0.0);
    (way, shortest + nothing)
}

/// The value of a lattice function.
#[inline(always)]
pub(super) fn value<N: Number>(lattice: Lattice, x: N, y: N, z: N) -> N {
    match lattice {
        Lattice::Noise => noise(x, y, z),
        Lattice::Voronoi => nearest(x, y, z).1.sqrt(),
    }
}

/// The partial derivatives of a lattice function.
#[inline(always)]
pub(super) fn slope<N: Number>(lattice: Lattice, x: N, y: N, z: N) -> [N; 3] {
    match lattice {
        Lattice::Noise => noise_slope(x, y, z),
        Lattice::Voronoi => {
            let ([dx, dy, dz], squared) = nearest(x, y, z);
            let length = squared.sqrt();
            [
                dx.direction_cosine(length),
                dy.direction_cosine(length),
                dz.direction_cosine(length),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::Samples;
    use super::super::{Dual, Interval};
    use super::*;

    const SEED: u64 = 0x1a77;
    const KINDS: [Lattice; 2] = [Lattice::Noise, Lattice::Voronoi];

    fn at(lattice: Lattice, [x, y, z]: [f64; 3]) -> f64 {
        f64::lattice(lattice, x, y, z)
    }

    fn steepness(lattice: Lattice, [x, y, z]: [f64; 3]) -> f64 {
        let [u, v, w] = f64::lattice_slope(lattice, x, y, z);
        f64::norm3(u, v, w)
    }

    fn point(samples: &mut Samples, reach: f64) -> [f64; 3] {
        [0; 3].map(|_| samples.uniform(-reach, reach))
    }

    /// The polynomial in whole numbers.
    #[test]
    fn hashes_are_those_of_integers_in_both_widths() {
        for x in 0..=291u64 {
            let expected = (34 * x * x + 10 * x) % 289;
            assert_eq!(hash(x as f64), expected as f64);
            assert_eq!(hash(x as f32), expected as f32);
            for i in 0..=291u64 {
                let expected = (34 * (expected + i) + 10) * (expected + i) % 289;
                let (wide, short) = (less(i as f64), less(i as f32));
                assert_eq!(hash_next(hash(x as f64), wide), expected as f64);
                assert_eq!(hash_next(hash(x as f32), short), expected as f32);
            }
        }
        for x in 0..4_000_000u32 {
            for m in [7, 12, 49, 289] {
                let (expected, m) = (x / m, f64::from(m));
                assert_eq!(quotient(x as f32, m), expected as f32, "{x} by {m}");
                assert_eq!(quotient(f64::from(x), m), f64::from(expected), "{x} by {m}");
            }
        }
        for x in -4_000_000i64..4_000_000 {
            assert_eq!(cell(x as f32), x.rem_euclid(289) as f32, "{x}");
            assert_eq!(cell(x as f64), x.rem_euclid(289) as f64, "{x}");
        }
    }

    #[test]
    fn hashes_permute_and_gradients_are_the_twelve() {
        let mut hashes: Vec<u32> = (0..289).map(|x| hash(f64::from(x)) as u32).collect();
        hashes.sort_unstable();
        assert!(hashes.into_iter().eq(0..289));
        let all: std::collections::BTreeSet<[i8; 3]> = (0..289)
            .map(|h| gradient(f64::from(h)).map(|c| c as i8))
            .collect();
        assert_eq!(all.len(), 12);
        let is_edge = |g: &[i8; 3]| g.iter().filter(|c| **c == 0).count() == 1;
        assert!(all.iter().all(is_edge), "{all:?}");
    }

    #[test]
    fn noise_is_zero_at_whole_points_and_repeats() {
        let mut samples = Samples::new(SEED);
        for lattice in KINDS {
            for _ in 0..500 {
                let p = point(&mut samples, 50.0);
                let again = [p[0] + 289.0, p[1] - 289.0, p[2] + 578.0];
                assert!((at(lattice, p) - at(lattice, again)).abs() < 1e-11);
                if lattice == Lattice::Noise {
                    assert_eq!(at(lattice, p.map(f64::floor)), 0.0);
                }
            }
        }
    }

    /// Short steps, half of them over a border of cells, change little.
    #[test]
    fn no_step_is_steeper_than_the_constant() {
        let mut samples = Samples::new(SEED);
        for lattice in KINDS {
            let [low, high] = lattice.range();
            for n in 0..20_000 {
                let mut p = point(&mut samples, 300.0);
                let step = [1e-6, 1e-3, 0.3][n % 3];
                if n % 2 == 0 {
                    let axis = samples.below(3);
                    p[axis] = (2.0 * p[axis]).round() / 2.0;
                }
                let q: [f64; 3] = p.map(|c| c + samples.uniform(-step, step));
                let (a, b) = (at(lattice, p), at(lattice, q));
                let distance = f64::norm3(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
                assert!(low <= a && a <= high, "{lattice:?} {a} at {p:?}");
                assert!(
                    (a - b).abs() <= lattice.lipschitz() * distance + 1e-12,
                    "{lattice:?} from {p:?} to {q:?}, seed {SEED:#x}"
                );
                assert!(steepness(lattice, p) <= lattice.lipschitz() + 1e-12);
            }
        }
    }

    /// Second differences along short pieces of lines: none above the bound, some near it.
    #[test]
    fn no_line_is_bent_more_than_the_bound() {
        let mut samples = Samples::new(SEED);
        let (step, most) = (1e-3, Lattice::Noise.bend());
        let mut largest = 0.0f64;
        for _ in 0..200_000 {
            let p = point(&mut samples, 300.0);
            let way = point(&mut samples, 1.0);
            let length = f64::norm3(way[0], way[1], way[2]);
            let at = |share: f64| {
                let q = std::array::from_fn(|k| p[k] + share * step * way[k] / length);
                at(Lattice::Noise, q)
            };
            let bend = (at(1.0) - 2.0 * at(0.0) + at(-1.0)) / (step * step);
            assert!(bend.abs() <= most + 1e-6, "{bend} at {p:?} along {way:?}");
            largest = largest.max(bend.abs());
        }
        assert!(largest > 0.4 * most, "{largest}");
        assert_eq!(Lattice::Voronoi.bend(), f64::INFINITY);
    }

    /// Over all cells within 5, not only the 56 that are looked at.
    #[test]
    fn nearest_point_is_the_nearest_of_all() {
        let mut samples = Samples::new(SEED);
        for _ in 0..300 {
            let p = point(&mut samples, 20.0);
            let mut nearest = f64::INFINITY;
            for n in 0..1000 {
                let corner: [f64; 3] = std::array::from_fn(|k| {
                    p[k].floor() + f64::from(n / 10i32.pow(k as u32) % 10) - 5.0
                });
                let place = scattered(hash_at(corner));
                let way: [f64; 3] = std::array::from_fn(|k| p[k] - corner[k] - place[k]);
                nearest = nearest.min(f64::norm3(way[0], way[1], way[2]));
            }
            assert!(
                (at(Lattice::Voronoi, p) - nearest).abs() < 1e-13,
                "at {p:?}"
            );
        }
    }

    #[test]
    fn gradients_are_differences() {
        let mut samples = Samples::new(SEED);
        for lattice in KINDS {
            for _ in 0..2_000 {
                let p = point(&mut samples, 9.0);
                let [x, y, z] = [0, 1, 2].map(|i| Dual::<f64, 3>::variable(p[i], i));
                let gradient = Dual::lattice(lattice, x, y, z).partial;
                for axis in 0..3 {
                    let moved = |h: f64| {
                        let mut q = p;
                        q[axis] += h;
                        at(lattice, q)
                    };
                    let (ahead, behind) = (moved(1e-6) - moved(0.0), moved(0.0) - moved(-1e-6));
                    let is_smooth = (ahead - behind).abs() < 1e-9;
                    let slope = 0.5e6 * (ahead + behind);
                    assert!(!is_smooth || (slope - gradient[axis]).abs() < 1e-4);
                }
            }
        }
    }

    #[test]
    fn ranges_hold_values_and_slopes_and_are_tight_on_small_boxes() {
        let mut samples = Samples::new(SEED);
        for lattice in KINDS {
            for n in 0..1_500 {
                let size = [0.0, 1e-9, 1e-3, 0.1, 0.9, 4.0][n % 6];
                let low = point(&mut samples, if n % 5 == 0 { 1e6 } else { 3.0 });
                let high = low.map(|c| c + size * samples.uniform(0.0, 1.0));
                let [x, y, z] = std::array::from_fn(|k| Interval::new(low[k], high[k]));
                let value = Interval::lattice(lattice, x, y, z);
                let slopes = Interval::lattice_slope(lattice, x, y, z);
                for _ in 0..20 {
                    let p: [f64; 3] = std::array::from_fn(|k| {
                        samples.uniform(low[k], high[k]).clamp(low[k], high[k])
                    });
                    assert!(
                        value.contains(at(lattice, p)),
                        "{lattice:?} at {p:?} in {value:?}"
                    );
                    let slope = f64::lattice_slope(lattice, p[0], p[1], p[2]);
                    for (range, d) in slopes.iter().zip(slope) {
                        assert!(
                            range.contains(d),
                            "{lattice:?} slope {d} at {p:?} in {range:?}"
                        );
                    }
                }
                let radius = f64::norm3(x.width(), y.width(), z.width());
                let reach = 2.5 * lattice.lipschitz() * radius + 1e-12;
                assert!(
                    size > 1e-3 || value.width() <= reach,
                    "{lattice:?}: {value:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_not_finite_has_no_value() {
        for lattice in KINDS {
            for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(at(lattice, [0.3, x, 0.2]).is_nan());
            }
            let [low, high] = lattice.range();
            for x in [1e15, 1e40, -1e300] {
                let value = at(lattice, [0.3, x, 0.2]);
                assert!(low <= value && value <= high, "{lattice:?} {value} at {x}");
            }
        }
    }
}
