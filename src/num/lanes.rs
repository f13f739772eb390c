//! Lanes: many scalars that go through the same operations at once.
//!
//! Plain arrays with plain loops: inside a function compiled for AVX2 or AVX-512 the loops become instructions of that
//! width, because every operation is inlined into its caller. No operation may do without `#[inline(always)]`.

use super::float::Float;
use super::{Lattice, Number, kernels, lattice};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `W` numbers of type `T` (`f32` or `f64`), each with the bits that the scalar operations give.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<T, const W: usize>(pub [T; W]);

/// 64 single precision lanes: four AVX-512 registers.
pub type F32x64 = Lanes<f32, 64>;

/// 32 single precision lanes: as many as [`F64x32`] has.
pub type F32x32 = Lanes<f32, 32>;

/// 32 double precision lanes: four AVX-512 registers.
pub type F64x32 = Lanes<f64, 32>;

/// 16 lanes, for numbers that take along the derivatives by several variables.
pub type F64x16 = Lanes<f64, 16>;

/// The lanes whose lane `$i` is `$value`. A loop in place, because a closure might fall out of the feature region.
macro_rules! each {
    ($i:ident => $value:expr) => {{
        let mut out = [T::ZERO; W];
        for $i in 0..W {
            out[$i] = $value;
        }
        Self(out)
    }};
}

impl<T: Float, const W: usize> Lanes<T, W> {
    /// How many lanes there are.
    pub const WIDTH: usize = W;

    /// The lanes whose lane `i` is `f(i)`.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> T) -> Self {
        each!(i => f(i))
    }

    /// Whether some lane is out of the reach of the trigonometric kernels.
    #[inline(always)]
    fn is_beyond_trig(self) -> bool {
        let mut beyond = false;
        for i in 0..W {
            beyond |= kernels::is_beyond_trig(self.0[i]);
        }
        beyond
    }
}

/// `near`, or `anywhere` in the lanes that it does not reach. Rare, so it may leave the feature region: the bits are the same.
#[cold]
#[inline(never)]
fn with_far_lanes<T: Float, const W: usize>(
    x: Lanes<T, W>,
    near: fn(T) -> T,
    anywhere: fn(T) -> T,
) -> Lanes<T, W> {
    let mut out = x;
    for x in &mut out.0 {
        *x = if kernels::is_beyond_trig(*x) {
            anywhere(*x)
        } else {
            near(*x)
        };
    }
    out
}

impl<T: Float, const W: usize> Add for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        each!(i => self.0[i] + o.0[i])
    }
}

impl<T: Float, const W: usize> Sub for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        each!(i => self.0[i] - o.0[i])
    }
}

impl<T: Float, const W: usize> Mul for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        each!(i => self.0[i] * o.0[i])
    }
}

impl<T: Float, const W: usize> Div for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        each!(i => self.0[i] / o.0[i])
    }
}

impl<T: Float, const W: usize> Neg for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        each!(i => -self.0[i])
    }
}

impl<T: Float, const W: usize> Number for Lanes<T, W> {
    type Constant = T;

    const LANES: usize = W;
    const LEAVES_OUT: bool = true;

    #[inline(always)]
    fn may_be_below(self, other: Self) -> bool {
        let mut any = false;
        for i in 0..W {
            any |= self.0[i] < other.0[i];
        }
        any
    }

    #[inline(always)]
    fn constant(x: f64) -> T {
        T::from_f64(x)
    }

    #[inline(always)]
    fn spread(x: T) -> Self {
        Self([x; W])
    }

    #[inline(always)]
    fn min(self, o: Self) -> Self {
        each!(i => kernels::min(self.0[i], o.0[i]))
    }

    #[inline(always)]
    fn max(self, o: Self) -> Self {
        each!(i => kernels::max(self.0[i], o.0[i]))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each!(i => self.0[i].abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(i => self.0[i].sqrt())
    }

    #[inline(always)]
    fn floor(self) -> Self {
        each!(i => kernels::floor(self.0[i]))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        if self.is_beyond_trig() {
            return with_far_lanes(self, kernels::sin_near, T::sin_anywhere);
        }
        each!(i => kernels::sin_near(self.0[i]))
    }

    #[inline(always)]
    fn cos(self) -> Self {
        if self.is_beyond_trig() {
            return with_far_lanes(self, kernels::cos_near, T::cos_anywhere);
        }
        each!(i => kernels::cos_near(self.0[i]))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if self.is_beyond_trig() {
            return (
                with_far_lanes(self, kernels::sin_near, T::sin_anywhere),
                with_far_lanes(self, kernels::cos_near, T::cos_anywhere),
            );
        }
        let (mut sine, mut cosine) = ([T::ZERO; W], [T::ZERO; W]);
        for i in 0..W {
            (sine[i], cosine[i]) = kernels::sin_cos_near(self.0[i]);
        }
        (Self(sine), Self(cosine))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        each!(i => kernels::atan2(self.0[i], x.0[i]))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        each!(i => kernels::exp(self.0[i]))
    }

    #[inline(always)]
    fn ln(self) -> Self {
        each!(i => kernels::ln(self.0[i]))
    }

    /// Lane by lane: one loop over all of it, which becomes wide as a whole, where loops over single operations would be
    /// unrolled first and then be too deep to be put together again (2.5 times as slow).
    #[inline(always)]
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        match lattice {
            Lattice::Noise => each!(i => {
                let [x, y, z] = [x.0[i], y.0[i], z.0[i]];
                lattice::noise(Lanes([x]), Lanes([y]), Lanes([z])).0[0]
            }),
            Lattice::Voronoi => lattice::value(lattice, x, y, z),
        }
    }

    /// As [`Number::lattice`].
    #[inline(always)]
    fn lattice_slope(lattice: Lattice, x: Self, y: Self, z: Self) -> [Self; 3] {
        if lattice == Lattice::Voronoi {
            return lattice::slope(lattice, x, y, z);
        }
        let [mut u, mut v, mut w] = [[T::ZERO; W]; 3];
        for i in 0..W {
            let [x, y, z] = [x.0[i], y.0[i], z.0[i]];
            let slope = lattice::noise_slope(Lanes([x]), Lanes([y]), Lanes([z]));
            (u[i], v[i], w[i]) = (slope[0].0[0], slope[1].0[0], slope[2].0[0]);
        }
        [Self(u), Self(v), Self(w)]
    }

    #[inline(always)]
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        // Both branches are read first: a read that depends on the comparison becomes a gather (3 times slower).
        each!(i => {
            let (x, y) = (x.0[i], y.0[i]);
            if a.0[i] < b.0[i] { x } else { y }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Dual;
    use super::super::samples::{Samples, binary, unary};
    use super::*;

    const SEED: u64 = 0x1a9e5;
    const PACKETS: usize = 300;

    /// Whether two results are the same number: NaN has many bit patterns, and hardware may pick any.
    macro_rules! assert_same_bits {
        ($lane:expr, $scalar:expr, $($about:tt)*) => {
            let (lane, scalar) = ($lane, $scalar);
            let same = lane.to_bits() == scalar.to_bits() || lane.is_nan() && scalar.is_nan();
            assert!(same, "{lane:e} in a lane, {scalar:e} alone: {}", format!($($about)*));
        };
    }

    macro_rules! lanes_equal_scalars {
        ($name:ident, $type:ident, $width:literal) => {
            #[test]
            fn $name() {
                type Wide = Lanes<$type, $width>;
                let mut samples = Samples::new(SEED);
                for _ in 0..PACKETS {
                    let [a, b] = [0; 2].map(|_| Wide::from_fn_mut(|| $name::input(&mut samples)));
                    for ((name, wide), (_, scalar)) in
                        unary::<Wide>().into_iter().zip(unary::<$type>())
                    {
                        let result = wide(a);
                        for i in 0..$width {
                            assert_same_bits!(
                                result.0[i],
                                scalar(a.0[i]),
                                "{name} of {:e}",
                                a.0[i]
                            );
                        }
                    }
                    let (sine, cosine) = a.sin_cos();
                    for i in 0..$width {
                        let x = a.0[i];
                        let (alone, other) = Number::sin_cos(x);
                        assert_same_bits!(sine.0[i], alone, "sine beside a cosine of {x:e}");
                        assert_same_bits!(cosine.0[i], other, "cosine beside a sine of {x:e}");
                    }
                    for ((name, wide), (_, scalar)) in
                        binary::<Wide>().into_iter().zip(binary::<$type>())
                    {
                        let result = wide(a, b);
                        for i in 0..$width {
                            let (x, y) = (a.0[i], b.0[i]);
                            assert_same_bits!(result.0[i], scalar(x, y), "{name} of {x:e}, {y:e}");
                        }
                    }
                }
            }

            mod $name {
                use super::Samples;

                /// Special values, any bit pattern, and ordinary numbers.
                pub fn input(samples: &mut Samples) -> $type {
                    let special = [
                        0.0,
                        1.0,
                        0.5,
                        $type::MIN_POSITIVE / 2.0,
                        $type::MIN_POSITIVE,
                        $type::MAX,
                        $type::INFINITY,
                        $type::NAN,
                        1e4,
                        1e6,
                        1.0 / $type::EPSILON,
                    ];
                    let sign = if samples.bits() & 1 == 0 { -1.0 } else { 1.0 };
                    match samples.below(4) {
                        0 => sign * special[samples.below(special.len())],
                        1 => $type::from_bits(samples.bits() as _),
                        2 => samples.uniform(-3.0, 3.0) as $type,
                        _ => samples.scaled(-4.0, 4.0) as $type,
                    }
                }
            }
        };
    }

    impl<T: Float, const W: usize> Lanes<T, W> {
        fn from_fn_mut(mut f: impl FnMut() -> T) -> Self {
            Self([(); W].map(|()| f()))
        }
    }

    lanes_equal_scalars!(single_lanes_give_the_bits_of_scalars, f32, 64);
    lanes_equal_scalars!(double_lanes_give_the_bits_of_scalars, f64, 32);

    #[test]
    fn derivatives_in_lanes_are_those_of_scalars() {
        type Wide = Dual<F32x64, 2>;
        type Alone = Dual<f32, 2>;
        let mut samples = Samples::new(SEED);
        for ((name, wide), (_, scalar)) in binary::<Wide>().into_iter().zip(binary::<Alone>()) {
            let [a, b] = [0; 2].map(|_| F32x64::from_fn_mut(|| samples.uniform(-3.0, 3.0) as f32));
            let wide = wide(Dual::variable(a, 0), Dual::variable(b, 1));
            for i in 0..64 {
                let (x, y) = (a.0[i], b.0[i]);
                let scalar = scalar(Dual::variable(x, 0), Dual::variable(y, 1));
                assert_same_bits!(wide.value.0[i], scalar.value, "{name} of {x:e}, {y:e}");
                for (lanes, d) in wide.partial.into_iter().zip(scalar.partial) {
                    assert_same_bits!(lanes.0[i], d, "slope of {name} at {x:e}, {y:e}");
                }
            }
        }
    }

    #[test]
    fn one_far_angle_leaves_other_lanes_alone() {
        let near = F32x64::from_fn(|i| i as f32);
        let mut far = near;
        far.0[7] = 1e9;
        let (near, far) = (near.sin(), far.sin());
        for i in (0..64).filter(|&i| i != 7) {
            assert_eq!(near.0[i].to_bits(), far.0[i].to_bits());
        }
        assert_eq!(far.0[7], libm::sinf(1e9));
    }
}
