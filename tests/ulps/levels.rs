//! Lanes have the bits of scalars, with the instructions of every level that the processor has.

use super::precision::Precision;
use super::samples::{Samples, corners};
use fieldstone::field::{Level, Task, run_at};
use fieldstone::num::{F32x32, F64x32, Lanes, Lattice, Number};

const W: usize = 32;

/// A function of up to three numbers that gives up to three.
trait Function {
    const NAME: &'static str;
    /// How many of its arguments it looks at.
    const ARGUMENTS: usize;
    fn of<N: Number>(x: N, y: N, z: N) -> [N; 3];
}

macro_rules! functions {
    ($($type:ident $arguments:literal |$x:ident, $y:ident, $z:ident| $value:expr;)*) => {
        $(
            struct $type;
            impl Function for $type {
                const NAME: &'static str = stringify!($type);
                const ARGUMENTS: usize = $arguments;
                #[inline(always)]
                fn of<N: Number>($x: N, $y: N, $z: N) -> [N; 3] {
                    $value
                }
            }
        )*

        /// Compares every function over a width on a level.
        fn compare_all<T: Width>(level: (&str, Level), inputs: &Inputs<T>) {
            $(T::compare::<$type>(level, inputs);)*
        }
    };
}

functions! {
    Sin 1 |x, y, z| [x.sin(), y, z];
    Cos 1 |x, y, z| [x.cos(), y, z];
    SinCos 1 |x, _y, z| { let (sine, cosine) = x.sin_cos(); [sine, cosine, z] };
    Exp 1 |x, y, z| [x.exp(), y, z];
    Ln 1 |x, y, z| [x.ln(), y, z];
    Sqrt 1 |x, y, z| [x.sqrt(), y, z];
    Floor 1 |x, y, z| [x.floor(), x.fract(), y.min(z)];
    Tan 1 |x, y, z| [x.tan(), y, z];
    Arcs 1 |x, _y, z| [x.asin(), x.acos(), z];
    Atan2 2 |x, y, z| [x.atan2(y), y, z];
    Pow 2 |x, y, z| [x.pow(y), y, z];
    Powi 1 |x, y, z| [x.powi(5), x.powi(-3), y.max(z)];
    Lengths 3 |x, y, z| [x.hypot(y), N::norm3(x, y, z), x.direction_cosine(y)];
    Noise 3 |x, y, z| [N::lattice(Lattice::Noise, x, y, z), y, z];
    NoiseSlope 3 |x, y, z| N::lattice_slope(Lattice::Noise, x, y, z);
    Voronoi 3 |x, y, z| [N::lattice(Lattice::Voronoi, x, y, z), y, z];
    VoronoiSlope 3 |x, y, z| N::lattice_slope(Lattice::Voronoi, x, y, z);
}

/// Arguments, those of a function of one number, of two, and of three, and the results of packets of them.
struct Inputs<T> {
    of: [Vec<[T; 3]>; 3],
}

/// A function of packets of arguments.
struct Packets<'a, N, F> {
    arguments: &'a [[N; 3]],
    function: std::marker::PhantomData<F>,
}

impl<N: Number, F: Function> Task for Packets<'_, N, F> {
    type Output = Vec<[N; 3]>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut results = Vec::with_capacity(self.arguments.len());
        for [x, y, z] in self.arguments {
            results.push(F::of(*x, *y, *z));
        }
        results
    }
}

/// A width with its lanes.
trait Width: Precision {
    fn compare<F: Function>(level: (&str, Level), inputs: &Inputs<Self>);
}

macro_rules! width {
    ($type:ty, $lanes:ty) => {
        impl Width for $type {
            fn compare<F: Function>((name, level): (&str, Level), inputs: &Inputs<Self>) {
                let points = &inputs.of[F::ARGUMENTS - 1];
                let lane = |packet: &[[Self; 3]], k: usize| Lanes(std::array::from_fn(|i| packet[i][k]));
                let packets: Vec<[$lanes; 3]> = points
                    .chunks_exact(W)
                    .map(|packet| [0, 1, 2].map(|k| lane(packet, k)))
                    .collect();
                let results = run_at(level, Packets { arguments: &packets, function: std::marker::PhantomData::<F> });
                for (packet, result) in points.chunks_exact(W).zip(results) {
                    for (i, [x, y, z]) in packet.iter().enumerate() {
                        let alone = F::of(*x, *y, *z);
                        for (lanes, alone) in result.iter().zip(alone) {
                            let (lane, about) = (lanes.0[i], F::NAME);
                            // NaN has many bit patterns, and a processor may pick any.
                            let is_same = lane.to_bits() == alone.to_bits() || lane.is_nan() && alone.is_nan();
                            assert!(
                                is_same,
                                "{about} of {x:e}, {y:e}, {z:e}: {lane:e} in a lane on {name}, {alone:e} alone"
                            );
                        }
                    }
                }
            }
        }
    };
}

width!(f32, F32x32);
width!(f64, F64x32);

/// `count` numbers over all bit patterns, evenly: as much of each exponent as its share of the patterns is. The steps are
/// the golden section of them, so that neighbours are far apart and packets mixed. Then numbers of ordinary size, in
/// packets of their own.
fn numbers<T: Precision>(count: u64, samples: &mut Samples) -> Vec<T> {
    let bits = T::FRACTION_BITS + T::EXPONENTS.trailing_zeros() + 1;
    let spread =
        (1..=count).map(|n| T::from_pattern(n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - bits)));
    let mut all: Vec<T> = spread.chain(corners()).collect();
    all.resize(all.len().next_multiple_of(W), T::nearest(1.0));
    let ordinary = (0..count / 2 * 2).map(|n| {
        let reach = [4.0, 1e5][n as usize / W % 2];
        T::nearest(samples.uniform(-reach, reach))
    });
    all.extend(ordinary);
    all
}

/// As many numbers for each argument, in orders that have nothing to do with each other; of three, half of them on the
/// lattice's reach.
fn inputs<T: Precision>() -> Inputs<T> {
    let mut samples = Samples::new(0x1e7e1);
    let mut points = |count: u64, arguments: usize| {
        let first = numbers::<T>(count, &mut samples);
        let mut others = || -> T {
            match samples.below(4) {
                0 => samples.any(),
                1 => T::nearest(samples.uniform(-4e6, 4e6)),
                _ => T::nearest(samples.uniform(-600.0, 600.0)),
            }
        };
        let mut point = |x: T| [x, others(), others()];
        let mut all: Vec<[T; 3]> = first.into_iter().map(&mut point).collect();
        if arguments == 3 {
            let again: Vec<T> = (0..count)
                .map(|n| T::nearest(289.0 * (n as f64 * 0.618_033_988_749_895).fract()))
                .collect();
            all.extend(again.into_iter().map(&mut point));
        }
        all.truncate(all.len() / W * W);
        all
    };
    Inputs {
        of: [points(60_000, 1), points(60_000, 2), points(12_000, 3)],
    }
}

#[test]
fn lanes_of_every_level_have_the_bits_of_scalars_over_the_whole_range() {
    let levels = Level::ALL
        .into_iter()
        .filter(|(_, level)| *level <= Level::supported());
    let (single, double) = (inputs::<f32>(), inputs::<f64>());
    for level in levels {
        compare_all(level, &single);
        compare_all(level, &double);
        println!("{}: the bits of scalars", level.0);
    }
}
