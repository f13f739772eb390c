//! Elementary functions of numbers, for expressions, fields and patterns.

use crate::num::{Lattice, Number};

macro_rules! functions {
    ($( $(#[doc = $doc:literal])+ $variant:ident = $name:literal ($($arg:ident),+) $body:expr; )+) => {
        /// A function of one to three numbers. Angles are in radians.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Function {
            $( $(#[doc = $doc])+ $variant, )+
        }

        impl Function {
            /// Every function.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name in scripts.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// What it gives.
            pub fn summary(self) -> &'static str {
                match self { $(Self::$variant => concat!($($doc),+)),+ }
            }

            /// The names of its arguments.
            pub fn arguments(self) -> &'static [&'static str] {
                match self { $(Self::$variant => &[$(stringify!($arg)),+]),+ }
            }

            /// The value at `arguments`, of which as many count as [`Function::arguments`] names.
            ///
            /// # Panics
            /// If there are fewer.
            #[inline(always)]
            pub fn apply<N: Number>(self, arguments: &[N]) -> N {
                match self {
                    $(Self::$variant => {
                        let mut place = 0..arguments.len();
                        $(let $arg = arguments[place.next().expect("as many arguments as the function names")];)+
                        $body
                    })+
                }
            }
        }
    };
}

functions! {
    /// The absolute value.
    Abs = "abs" (x) x.abs();
    /// The largest whole number not above x.
    Floor = "floor" (x) x.floor();
    /// The smallest whole number not below x.
    Ceil = "ceil" (x) -((-x).floor());
    /// The nearest whole number, halves upwards.
    Round = "round" (x) (x + N::splat(0.5)).floor();
    /// What is left of x above its floor.
    Fract = "fract" (x) x.fract();
    /// -1, 0 or 1 as x is negative, zero or positive.
    Sign = "sign" (x) {
        let zero = N::splat(0.0);
        N::select_lt(x, zero, N::splat(-1.0), N::select_lt(zero, x, N::splat(1.0), zero))
    };
    /// The square root.
    Sqrt = "sqrt" (x) x.sqrt();
    /// The sine of an angle.
    Sin = "sin" (x) x.sin();
    /// The cosine of an angle.
    Cos = "cos" (x) x.cos();
    /// The tangent of an angle.
    Tan = "tan" (x) x.tan();
    /// The angle whose sine is x.
    Asin = "asin" (x) x.asin();
    /// The angle whose cosine is x.
    Acos = "acos" (x) x.acos();
    /// The angle whose tangent is x.
    Atan = "atan" (x) x.atan2(N::splat(1.0));
    /// The angle of the point (x, y) from the x axis.
    Atan2 = "atan2" (y, x) y.atan2(x);
    /// The exponential function.
    Exp = "exp" (x) x.exp();
    /// The natural logarithm.
    Ln = "ln" (x) x.ln();
    /// The smaller of two.
    Min = "min" (a, b) a.min(b);
    /// The larger of two.
    Max = "max" (a, b) a.max(b);
    /// x held between low and high.
    Clamp = "clamp" (x, low, high) x.clamp(low, high);
    /// a for t = 0, b for t = 1, straight between.
    Mix = "mix" (a, b, t) t.mix(a, b);
    /// 0 below low, 1 above high, a smooth cubic between.
    Smoothstep = "smoothstep" (low, high, x) ((x - low) / (high - low)).smoothstep();
    /// x to the power e.
    Pow = "pow" (x, e) x.pow(e);
    /// The length of the vector (x, y).
    Hypot = "hypot" (x, y) x.hypot(y);
    /// The length of the vector (x, y, z).
    Norm3 = "norm3" (x, y, z) N::norm3(x, y, z);
    /// What is left of x above the largest multiple of m that is not above it.
    Modulo = "mod" (x, m) x - m * (x / m).floor();
    /// Gradient noise at (x, y, z): between -1.037 and 1.037, zero at whole numbers, of slope at most 3.75.
    Noise3 = "noise3" (x, y, z) N::lattice(Lattice::Noise, x, y, z);
    /// The distance of (x, y, z) from the nearest of points scattered one in every cell of size 1.
    Voronoi3 = "voronoi3" (x, y, z) N::lattice(Lattice::Voronoi, x, y, z);
}

impl Function {
    /// How many plain operations it takes over intervals, about.
    pub fn work(self) -> u64 {
        match self {
            Self::Noise3 => 256,
            Self::Voronoi3 => 1024,
            _ => 1,
        }
    }
}
