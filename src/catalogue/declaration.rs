//! How an entry of the catalogue is declared: name, documentation, parameters with kinds, ranges and defaults.
//!
//! The language reads declarations to call entries, to check arguments and to word its errors; the reference page
//! prints them. The macro [`entry!`] writes a declaration and its parameter struct in one place.

use std::fmt;

/// Everything that is said about an entry besides its mathematics.
#[derive(Debug)]
pub struct Declaration {
    /// The word in scripts.
    pub name: &'static str,
    /// What it is, in one or two sentences.
    pub summary: &'static str,
    /// Its parameters in positional order.
    pub parameters: &'static [Parameter],
    /// Where the formula and its Lipschitz rule come from.
    pub source: &'static str,
    /// A line of script that shows it.
    pub example: &'static str,
}

/// One parameter of an entry.
#[derive(Debug)]
pub struct Parameter {
    /// The name in scripts.
    pub name: &'static str,
    /// What it means, with its unit.
    pub summary: &'static str,
    /// What kind of value it takes.
    pub kind: Kind,
    /// What values are allowed, for each component.
    pub range: Range,
    /// The value when it is left out; none where it must be given.
    pub default: Option<fn() -> Argument>,
}

impl Parameter {
    /// What values are allowed, in words: "must be ...".
    pub fn range_words(&self) -> String {
        match self.kind {
            Kind::Angle => self.range.in_words(|x| Argument::Angle(x).to_string()),
            _ => self.range.in_words(written),
        }
    }

    /// The value when it is left out, as it would be written in a script; none where it must be given.
    pub fn default_in_words(&self) -> Option<String> {
        self.default.map(|default| default().to_string())
    }
}

/// A number as it would be written in a script, with up to twelve significant digits.
pub fn written(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return match x {
            x if x.is_nan() => "not a number".into(),
            x if x.is_infinite() && x > 0.0 => "infinity".into(),
            x if x.is_infinite() => "-infinity".into(),
            _ => "0".into(),
        };
    }
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    let magnitude = rounded.abs();
    if (1e-5..1e15).contains(&magnitude) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// What kind of value a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A plain number; lengths are in scene units.
    Number,
    /// A whole number.
    Count,
    /// An angle with a unit (radians inside).
    Angle,
    /// A vector with two components.
    Vector2,
    /// A vector with three components; a planar shape may leave out the third, which is then 0.
    Vector3,
    /// A number for all axes alike, or a vector with three components (two for a planar shape, the third is then 1).
    Factors,
    /// A direction: a vector with three components that is not zero, or `"x"`, `"y"`, `"z"`.
    Direction,
    /// One of `"x"`, `"y"`, `"z"`.
    Axis,
    /// A list of vectors with two components.
    Points,
    /// A list of vectors with three components.
    Points3,
}

impl Kind {
    /// The kind in words for error messages: "expects a ...".
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Count => "a whole number",
            Self::Angle => "an angle",
            Self::Vector2 => "a vector [x, y]",
            Self::Vector3 => "a vector [x, y, z]",
            Self::Factors => "a number or a vector [x, y, z]",
            Self::Direction => "a direction [x, y, z] or \"x\", \"y\", \"z\"",
            Self::Axis => "an axis: \"x\", \"y\" or \"z\"",
            Self::Points => "a list of points [[x, y], ...]",
            Self::Points3 => "a list of points [[x, y, z], ...]",
        }
    }
}

/// The values that each component of a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The smallest value.
    pub low: f64,
    /// The largest value.
    pub high: f64,
    /// Whether `low` itself is allowed.
    pub includes_low: bool,
}

impl Range {
    /// Every finite number.
    pub const ANY: Self = Self::closed(f64::MIN, f64::MAX);
    /// Above zero.
    pub const POSITIVE: Self = Self {
        low: 0.0,
        high: f64::MAX,
        includes_low: false,
    };
    /// Zero or above.
    pub const NOT_NEGATIVE: Self = Self::closed(0.0, f64::MAX);
    /// Above zero, infinity too.
    pub const POSITIVE_OR_INFINITE: Self = Self {
        high: f64::INFINITY,
        ..Self::POSITIVE
    };
    /// Above zero, a full turn at most, in radians.
    pub const ANGLE: Self = Self {
        high: std::f64::consts::TAU,
        ..Self::POSITIVE
    };
    /// Zero or above, infinity too.
    pub const COUNT: Self = Self::closed(0.0, f64::INFINITY);

    /// From `low` to `high`, both allowed.
    pub const fn closed(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            includes_low: true,
        }
    }

    /// Whether `x` is allowed; NaN never is.
    pub fn contains(&self, x: f64) -> bool {
        (self.low < x || (self.includes_low && self.low == x)) && x <= self.high
    }

    /// The range in words, its ends by `shown`: "must be ...".
    fn in_words(&self, shown: impl Fn(f64) -> String) -> String {
        let (low, high) = (shown(self.low), shown(self.high));
        match (self.low == f64::MIN, self.high >= f64::MAX) {
            (true, true) => "finite".into(),
            (false, true) if self.low == 0.0 && !self.includes_low => "positive".into(),
            (false, true) if self.low == 0.0 => "zero or positive".into(),
            (false, true) if self.includes_low => format!("at least {low}"),
            (false, true) => format!("above {low}"),
            (true, false) => format!("at most {high}"),
            (false, false) if self.includes_low => format!("between {low} and {high}"),
            (false, false) => format!("above {low} and at most {high}"),
        }
    }
}

/// A value for a parameter, as its kind asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// For [`Kind::Number`] and [`Kind::Count`].
    Number(f64),
    /// For [`Kind::Angle`], in radians.
    Angle(f64),
    /// For [`Kind::Vector2`].
    Vector2([f64; 2]),
    /// For [`Kind::Vector3`], [`Kind::Factors`] and [`Kind::Direction`].
    Vector3([f64; 3]),
    /// For [`Kind::Axis`]: 0, 1, 2.
    Axis(usize),
    /// For [`Kind::Points`].
    Points(Vec<[f64; 2]>),
    /// For [`Kind::Points3`].
    Points3(Vec<[f64; 3]>),
}

impl Argument {
    /// All numbers inside, to be checked against a range.
    pub fn components(&self) -> Vec<f64> {
        match self {
            Self::Number(x) | Self::Angle(x) => vec![*x],
            Self::Vector2(v) => v.to_vec(),
            Self::Vector3(v) => v.to_vec(),
            Self::Axis(_) => vec![],
            Self::Points(points) => points.iter().flatten().copied().collect(),
            Self::Points3(points) => points.iter().flatten().copied().collect(),
        }
    }
}

/// As it would be written in a script.
impl fmt::Display for Argument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |v: &[f64]| {
            let words: Vec<_> = v.iter().copied().map(written).collect();
            format!("[{}]", words.join(", "))
        };
        match self {
            Self::Number(x) => f.write_str(&written(*x)),
            Self::Angle(x) => write!(f, "{}deg", written(x.to_degrees())),
            Self::Vector2(v) => write!(f, "{}", list(v)),
            Self::Vector3(v) => write!(f, "{}", list(v)),
            Self::Axis(i) => write!(f, "\"{}\"", AXES[*i]),
            Self::Points(points) => {
                let words: Vec<_> = points.iter().map(|p| list(p)).collect();
                write!(f, "[{}]", words.join(", "))
            }
            Self::Points3(points) => {
                let words: Vec<_> = points.iter().map(|p| list(p)).collect();
                write!(f, "[{}]", words.join(", "))
            }
        }
    }
}

/// The names of the axes.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// An axis of space: 0 is x, 1 is y, 2 is z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis(pub usize);

/// The type of a field of a parameter struct.
pub trait Parametric: Sized {
    /// The value of an argument whose kind has been checked.
    fn from_argument(argument: &Argument) -> Option<Self>;
    /// The argument that has this value, of kind `kind`.
    fn to_argument(&self, kind: Kind) -> Argument;
}

impl Parametric for f64 {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Number(x) | Argument::Angle(x) => Some(*x),
            _ => None,
        }
    }
    fn to_argument(&self, kind: Kind) -> Argument {
        match kind {
            Kind::Angle => Argument::Angle(*self),
            _ => Argument::Number(*self),
        }
    }
}

impl Parametric for [f64; 2] {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Vector2(v) => Some(*v),
            _ => None,
        }
    }
    fn to_argument(&self, _: Kind) -> Argument {
        Argument::Vector2(*self)
    }
}

impl Parametric for [f64; 3] {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Vector3(v) => Some(*v),
            _ => None,
        }
    }
    fn to_argument(&self, _: Kind) -> Argument {
        Argument::Vector3(*self)
    }
}

impl Parametric for Axis {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Axis(i) => Some(Self(*i)),
            _ => None,
        }
    }
    fn to_argument(&self, _: Kind) -> Argument {
        Argument::Axis(self.0)
    }
}

impl Parametric for Vec<[f64; 2]> {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Points(points) => Some(points.clone()),
            _ => None,
        }
    }
    fn to_argument(&self, _: Kind) -> Argument {
        Argument::Points(self.clone())
    }
}

impl Parametric for Vec<[f64; 3]> {
    fn from_argument(argument: &Argument) -> Option<Self> {
        match argument {
            Argument::Points3(points) => Some(points.clone()),
            _ => None,
        }
    }
    fn to_argument(&self, _: Kind) -> Argument {
        Argument::Points3(self.clone())
    }
}

/// An entry that a script can make from arguments.
pub trait Declared: Clone + Send + Sync + 'static {
    /// What is said about the entry.
    const DECLARATION: Declaration;

    /// The entry with these arguments, one for each parameter in order, each of its parameter's kind.
    ///
    /// # Panics
    /// If an argument is missing or of another kind: the caller has checked them against the declaration.
    fn from_arguments(arguments: &[Argument]) -> Self;

    /// The arguments that make this entry again, in order.
    fn arguments(&self) -> Vec<Argument>;
}

/// Declares an entry: its struct, its parameters and what is said about it. Behind `derived` stand values that its
/// mathematics needs often and that are computed once, from the parameters by name.
macro_rules! entry {
    (
        $(#[doc = $summary:literal])+
        $type:ident = $name:literal
        { $( $(#[doc = $doc:literal])+ $field:ident: $ftype:ty, $kind:ident, $range:expr $(, default $default:expr)?; )* }
        $(derived { $( $derived:ident: $dtype:ty = $value:expr; )* })?
        source $source:literal
        example $example:literal
    ) => {
        $(#[doc = $summary])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $type {
            $( $(#[doc = $doc])+ pub $field: $ftype, )*
            $($( $derived: $dtype, )*)?
        }

        impl $type {
            /// The entry with these parameters, in the order of its declaration; their ranges are not checked.
            #[allow(clippy::new_without_default)]
            pub fn new($($field: $ftype),*) -> Self {
                $($( let $derived: $dtype = $value; )*)?
                Self { $($field,)* $($($derived,)*)? }
            }
        }

        impl $crate::catalogue::Declared for $type {
            const DECLARATION: $crate::catalogue::Declaration = $crate::catalogue::Declaration {
                name: $name,
                summary: concat!($($summary),+),
                parameters: &[$(
                    $crate::catalogue::Parameter {
                        name: stringify!($field),
                        summary: concat!($($doc),+),
                        kind: $crate::catalogue::Kind::$kind,
                        range: $range,
                        default: $crate::catalogue::declaration::entry!(@default $ftype, $kind $(, $default)?),
                    },
                )*],
                source: $source,
                example: $example,
            };

            #[allow(unused_variables, unused_mut)]
            fn from_arguments(arguments: &[$crate::catalogue::Argument]) -> Self {
                let mut rest = arguments.iter();
                $(
                    let $field = rest
                        .next()
                        .and_then(<$ftype as $crate::catalogue::Parametric>::from_argument)
                        .expect("arguments were checked against the declaration");
                )*
                Self::new($($field),*)
            }

            fn arguments(&self) -> Vec<$crate::catalogue::Argument> {
                vec![$(
                    <$ftype as $crate::catalogue::Parametric>::to_argument(
                        &self.$field,
                        $crate::catalogue::Kind::$kind,
                    ),
                )*]
            }
        }
    };
    (@default $ftype:ty, $kind:ident) => { None };
    (@default $ftype:ty, $kind:ident, $default:expr) => {
        Some(|| {
            <$ftype as $crate::catalogue::Parametric>::to_argument(&$default, $crate::catalogue::Kind::$kind)
        })
    };
}
pub(crate) use entry;

/// Lists the entries of one kind: the enum over all of them, macros that reach inside, and what follows from their
/// declarations. Entries before the semicolon are compiled for every type of number; those behind `recorded` are compiled for
/// wide lanes alone, and else run once with a symbol and are evaluated as graphs, which takes no time to build. The first
/// token is a dollar sign, which the macros inside need.
macro_rules! list {
    (
        $dollar:tt $(#[doc = $doc:literal])+
        $any:ident, $with:ident, $with_compiled:ident, $with_recorded:ident:
        $($compiled:ident),+; recorded $($recorded:ident),*
    ) => {
        $crate::catalogue::declaration::list! {
            @all $dollar $(#[doc = $doc])+ $any, $with: $($compiled,)+ $($recorded,)*
        }

        /// Some value of an expression in which the entry inside is bound to a name, if it is one of those that are
        /// compiled for every type of number.
        macro_rules! $with_compiled {
            ($dollar any:expr, $dollar bound:ident => $dollar body:expr) => {
                match $dollar any {
                    $( $dollar crate::catalogue::$any::$compiled($dollar bound) => Some($dollar body), )+
                    #[allow(unreachable_patterns)]
                    _ => None,
                }
            };
        }
        pub(crate) use $with_compiled;

        /// Some value of an expression in which the entry inside is bound to a name, if it is a recorded one.
        macro_rules! $with_recorded {
            ($dollar any:expr, $dollar bound:ident => $dollar body:expr) => {
                match $dollar any {
                    $( $dollar crate::catalogue::$any::$recorded($dollar bound) => Some($dollar body), )*
                    _ => None,
                }
            };
        }
        pub(crate) use $with_recorded;
    };
    (@all $dollar:tt $(#[doc = $doc:literal])+ $any:ident, $with:ident: $($type:ident,)+) => {
        $(#[doc = $doc])+
        #[derive(Clone, Debug, PartialEq)]
        pub enum $any {
            $(
                #[doc = concat!("See [`", stringify!($type), "`].")]
                $type($type),
            )+
        }

        /// Evaluates an expression in which the entry inside is bound to a name.
        macro_rules! $with {
            ($dollar any:expr, $dollar bound:ident => $dollar body:expr) => {
                match $dollar any { $( $dollar crate::catalogue::$any::$type($dollar bound) => $dollar body, )+ }
            };
        }
        pub(crate) use $with;

        $(
            impl<'a> TryFrom<&'a $any> for &'a $type {
                type Error = ();

                /// The entry inside, if it is of this type.
                fn try_from(any: &'a $any) -> Result<Self, ()> {
                    if let $any::$type(entry) = any { Ok(entry) } else { Err(()) }
                }
            }
        )+

        impl $any {
            /// The declarations of all entries of this kind.
            pub const DECLARATIONS: &'static [&'static $crate::catalogue::Declaration] =
                &[$(&<$type as $crate::catalogue::Declared>::DECLARATION),+];

            /// The entry that scripts call `name`, made from checked arguments; none where there is no such name.
            pub fn from_arguments(name: &str, arguments: &[$crate::catalogue::Argument]) -> Option<Self> {
                $(
                    if name == <$type as $crate::catalogue::Declared>::DECLARATION.name {
                        return Some(Self::$type(<$type as $crate::catalogue::Declared>::from_arguments(arguments)));
                    }
                )+
                None
            }

            /// What is said about the entry.
            pub fn declaration(&self) -> &'static $crate::catalogue::Declaration {
                match self {
                    $(Self::$type(_) => &<$type as $crate::catalogue::Declared>::DECLARATION,)+
                }
            }
        }
    };
}
pub(crate) use list;
