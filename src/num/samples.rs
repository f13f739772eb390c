//! Random inputs and expressions for the tests of this floor.

use super::{Lattice, Number};

/// A number in [0, 1) that is fixed by `i`. Source: the finalizer of MurmurHash3.
pub fn random(i: u64) -> f64 {
    let mut z = i
        .wrapping_add(0x9e37_79b9_7f4a_7c15)
        .wrapping_mul(0xff51_afd7_ed55_8ccd);
    z = (z ^ (z >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    ((z ^ (z >> 33)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A sequence of random numbers that is fixed by its seed: a counter, hashed.
pub struct Samples {
    state: u64,
}

impl Samples {
    /// The sequence number `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// 64 random bits (splitmix64). Source: Steele, Lea, Flood 2014, figure 17.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Uniform between `lo` and `hi`.
    pub fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        lo + (hi - lo) * unit
    }

    /// Either sign, and `10^low` to `10^high` in absolute value, every decade as often.
    pub fn scaled(&mut self, low: f64, high: f64) -> f64 {
        let size = libm::exp10(self.uniform(low, high));
        if self.bits() & 1 == 0 { size } else { -size }
    }
}

/// A function of one number.
pub type Unary<N> = fn(N) -> N;
/// A function of two numbers.
pub type Binary<N> = fn(N, N) -> N;

/// Every function of one number, by name.
pub fn unary<N: Number>() -> Vec<(&'static str, Unary<N>)> {
    vec![
        ("neg", |x| -x),
        ("abs", N::abs),
        ("sqrt", N::sqrt),
        ("floor", N::floor),
        ("sin", N::sin),
        ("cos", N::cos),
        ("exp", N::exp),
        ("ln", N::ln),
        ("square", N::square),
        ("tan", N::tan),
        ("asin", N::asin),
        ("acos", N::acos),
        ("cathetus", N::cathetus),
        ("fract", N::fract),
        ("powi 0", |x| x.powi(0)),
        ("powi 2", |x| x.powi(2)),
        ("powi 3", |x| x.powi(3)),
        ("powi 6", |x| x.powi(6)),
        ("powi -1", |x| x.powi(-1)),
        ("powi -2", |x| x.powi(-2)),
        ("ease", |x| x.clamp(N::splat(0.0), N::splat(1.0)).ease()),
        ("smoothstep", N::smoothstep),
        ("ease beyond", N::ease),
        ("clamp", |x| x.clamp(N::splat(-0.5), N::splat(2.0))),
    ]
}

/// Every function of two numbers, and those of more with some repeated, by name.
pub fn binary<N: Number>() -> Vec<(&'static str, Binary<N>)> {
    vec![
        ("add", |x, y| x + y),
        ("sub", |x, y| x - y),
        ("mul", |x, y| x * y),
        ("div", |x, y| x / y),
        ("min", N::min),
        ("max", N::max),
        ("atan2", N::atan2),
        ("hypot", N::hypot),
        ("pow", N::pow),
        ("norm3", |x, y| N::norm3(x, y, x - y)),
        ("noise", |x, y| N::lattice(Lattice::Noise, x, y, x - y)),
        ("voronoi", |x, y| N::lattice(Lattice::Voronoi, x, y, x - y)),
        ("direction_cosine", |x, y| x.direction_cosine(x.hypot(y))),
        ("mix", |x, y| {
            (x - y).clamp(N::splat(0.0), N::splat(1.0)).mix(x, y)
        }),
        ("mix beyond", |x, y| x.mix(y, x - y)),
        ("select_lt", |x, y| N::select_lt(x, y, x.square(), y)),
    ]
}

/// A random expression in three variables.
#[derive(Debug)]
pub enum Tree {
    /// A variable.
    Variable(usize),
    /// A constant.
    Constant(f64),
    /// A function of one number, by its place in [`unary`].
    One(usize, Box<Tree>),
    /// A function of two numbers, by its place in [`binary`].
    Two(usize, Box<Tree>, Box<Tree>),
}

impl Tree {
    /// A random tree of at most `depth` floors.
    pub fn random(samples: &mut Samples, depth: usize) -> Self {
        let kind = if depth == 0 {
            samples.below(2)
        } else {
            1 + samples.below(6)
        };
        let mut child = || Box::new(Self::random(samples, depth - 1));
        match kind {
            0 => Self::Variable(samples.below(3)),
            1 => Self::Constant(samples.scaled(-1.0, 1.0)),
            2 | 3 => {
                let child = child();
                Self::One(samples.below(unary::<f64>().len()), child)
            }
            _ => {
                let (left, right) = (child(), child());
                Self::Two(samples.below(binary::<f64>().len()), left, right)
            }
        }
    }

    /// Its value at `at`.
    pub fn value<N: Number>(&self, at: [N; 3]) -> N {
        match self {
            Self::Variable(i) => at[*i],
            Self::Constant(c) => N::splat(*c),
            Self::One(f, x) => unary()[*f].1(x.value(at)),
            Self::Two(f, x, y) => binary()[*f].1(x.value(at), y.value(at)),
        }
    }

    /// Whether `law` holds for every step on the way to the value at `at`.
    pub fn all_steps<N: Number>(&self, at: [N; 3], law: fn(N) -> bool) -> bool {
        let children = match self {
            Self::One(_, x) => x.all_steps(at, law),
            Self::Two(_, x, y) => x.all_steps(at, law) && y.all_steps(at, law),
            _ => true,
        };
        children && law(self.value(at))
    }
}
