//! The words that every script knows: the catalogue's entries, and the few functions of the language itself.

use crate::catalogue::{AnyBlend, AnyModifier, AnyPrimitive, Declaration, Function, Operation};
use std::collections::HashMap;
use std::sync::LazyLock;

/// What a built-in word stands for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Builtin {
    Primitive(&'static Declaration),
    Modifier(&'static Declaration),
    Blend(&'static Declaration),
    Operation(Operation),
    Function(Function),
    Constant(f64),
    Intrinsic(Intrinsic),
}

/// A function that only the language knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Intrinsic {
    At,
    Checker,
    Concat,
    Cross,
    Distance,
    Displace,
    Dot,
    Fbm,
    Gradient,
    Heightfield,
    Hits,
    Len,
    Length,
    Marble,
    Misses,
    Noise,
    Normalize,
    Paint,
    Rand,
    Reverse,
    Rgb,
    Steps,
    Str,
    Stripes,
    Sum,
    Trace,
    Voronoi,
    Wood,
}

impl Intrinsic {
    /// Every one with its name, its arguments (a `?` marks those that may be left out), and what it gives.
    pub const ALL: [(&'static str, Self, &'static str, &'static str); 28] = [
        (
            "at",
            Self::At,
            "shape, p",
            "the value of a shape's field at a point",
        ),
        (
            "checker",
            Self::Checker,
            "a, b, size?",
            "a pattern of cubes with edge `size` (1)",
        ),
        (
            "concat",
            Self::Concat,
            "a, b, ...",
            "the elements of several lists as one list",
        ),
        ("cross", Self::Cross, "a, b", "the vector product"),
        (
            "distance",
            Self::Distance,
            "a, b",
            "the distance between two points",
        ),
        (
            "displace",
            Self::Displace,
            "shape, field",
            "the shape with a field added to its own: dented where it is positive, swollen where it is negative",
        ),
        ("dot", Self::Dot, "a, b", "the scalar product"),
        (
            "fbm",
            Self::Fbm,
            "p, octaves?, gain?, lacunarity?",
            "the sum of `octaves` (4) of noise, each `lacunarity` (2) times as fine and `gain` (0.5) times as high as the one before",
        ),
        (
            "gradient",
            Self::Gradient,
            "a, b, from?, to?",
            "a pattern that turns from `a` at `from` ([0, 0, 0]) into `b` at `to` ([0, 1, 0])",
        ),
        (
            "heightfield",
            Self::Heightfield,
            "field, size?, base?",
            "a block of ground of `size` ([2, 2]) along x and z, from y = `base` up to the field's value at (x, 0, z)",
        ),
        (
            "hits",
            Self::Hits,
            "trace, t, within?",
            "whether a ray hit at the distance `t`, to within a tenth of a pixel (the tolerance) or the distance given",
        ),
        (
            "len",
            Self::Len,
            "list",
            "the number of elements, or of bytes of a string",
        ),
        (
            "length",
            Self::Length,
            "v",
            "the Euclidean length of a vector",
        ),
        (
            "marble",
            Self::Marble,
            "a, b, size?, turbulence?",
            "a pattern of stone `a` with veins of `b`, `size` (1) apart and bent by `turbulence` (1)",
        ),
        (
            "misses",
            Self::Misses,
            "trace",
            "whether a ray certainly hit nothing",
        ),
        (
            "noise",
            Self::Noise,
            "p",
            "gradient noise at a point: between -1.037 and 1.037, zero at whole points, of slope at most 3.75",
        ),
        (
            "normalize",
            Self::Normalize,
            "v",
            "the vector with the same direction and length 1",
        ),
        (
            "paint",
            Self::Paint,
            "shape, material",
            "the shape with a material where none is given deeper down",
        ),
        (
            "rand",
            Self::Rand,
            "seed, ...",
            "a number in [0, 1) that depends on its arguments alone",
        ),
        (
            "reverse",
            Self::Reverse,
            "list",
            "the elements in the opposite order",
        ),
        (
            "rgb",
            Self::Rgb,
            "r, g, b",
            "a colour from linear components",
        ),
        (
            "steps",
            Self::Steps,
            "which",
            "how many steps the camera's rays take, in tests: `mean`, `p99` (what 99 % don't exceed) or `max`",
        ),
        ("str", Self::Str, "value, ...", "the values as one string"),
        (
            "stripes",
            Self::Stripes,
            "a, b, width?, axis?",
            "a pattern of layers of the given width (1) across an axis (\"x\")",
        ),
        ("sum", Self::Sum, "list", "the sum of all elements"),
        (
            "trace",
            Self::Trace,
            "origin, direction",
            "what a ray finds first: `.hit .t .point .normal .steps .evaluations .verdict`",
        ),
        (
            "voronoi",
            Self::Voronoi,
            "p",
            "the distance to the nearest of points that lie scattered one in every cell of size 1",
        ),
        (
            "wood",
            Self::Wood,
            "a, b, width?, turbulence?",
            "a pattern of rings around the y axis, `width` (0.1) apart, from early wood `a` to late wood `b`, bent by `turbulence` (1)",
        ),
    ];

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, intrinsic, ..)| *intrinsic == self)
            .map_or("", |(name, ..)| name)
    }

    /// A line of script that shows it: statements that end in `let entry = ` and a shape; empty where there is nothing
    /// to see.
    pub fn example(self) -> &'static str {
        match self {
            Self::Checker => {
                "material tiles { color: checker(#f0ece4, #86a3c4, size: 0.5) } let entry = sphere(0.9).paint(tiles)"
            }
            Self::Displace => {
                "field waves(p) { return 0.05 * sin(9 * p.x) * sin(9 * p.y) } let entry = box(1.4, round: 0.2).displace(waves)"
            }
            Self::Fbm => {
                "field rock(p) { return 0.12 * fbm(p * 2, octaves: 4) } let entry = sphere(0.85).displace(rock)"
            }
            Self::Gradient => {
                "material dawn { color: gradient(#d8603a, #3a5fb0, from: [0, -0.8, 0], to: [0, 0.8, 0]) } let entry = sphere(0.9).paint(dawn)"
            }
            Self::Heightfield => {
                "field hills(p) { return 0.35 * noise(p * 1.4 + [0.3, 0, 0.7]) } let entry = heightfield(hills, size: [1.7, 1.7])"
            }
            Self::Marble => {
                "material stone { color: marble(#ece8e0, #4a5568, size: 0.5) } let entry = sphere(0.9).paint(stone)"
            }
            Self::Noise => {
                "field lumps(p) { return 0.2 * noise(p * 2.5) } let entry = sphere(0.9).displace(lumps)"
            }
            Self::Stripes => {
                "material awning { color: stripes(#f0ece4, #b0403a, width: 0.25) } let entry = sphere(0.9).paint(awning)"
            }
            Self::Voronoi => {
                "field cells(p) { return 0.25 - 0.4 * voronoi(p * 2.5) } let entry = sphere(0.9).displace(cells)"
            }
            Self::Wood => {
                "material plank { color: wood(#c8995c, #7a4a24, width: 0.15) } let entry = box([1.8, 1, 0.8]).paint(plank)"
            }
            _ => "",
        }
    }

    /// The names of its arguments, and whether each must be given.
    pub fn arguments(self) -> Vec<(&'static str, bool)> {
        let words = Self::ALL
            .iter()
            .find(|(_, intrinsic, ..)| *intrinsic == self)
            .map_or("", |(_, _, arguments, _)| arguments);
        words
            .split(", ")
            .filter(|word| *word != "...")
            .map(|word| (word.trim_end_matches('?'), !word.ends_with('?')))
            .collect()
    }
}

static WORDS: LazyLock<HashMap<&'static str, Builtin>> = LazyLock::new(|| {
    let constants = [
        ("pi", std::f64::consts::PI),
        ("tau", std::f64::consts::TAU),
        ("infinity", f64::INFINITY),
    ];
    let entries = |list: &'static [&'static Declaration],
                   make: fn(&'static Declaration) -> Builtin| {
        list.iter().map(move |entry| (entry.name, make(entry)))
    };
    let mut words = HashMap::new();
    words.extend(constants.map(|(name, x)| (name, Builtin::Constant(x))));
    words.extend(Intrinsic::ALL.map(|(name, i, ..)| (name, Builtin::Intrinsic(i))));
    words.extend(entries(AnyBlend::DECLARATIONS, Builtin::Blend));
    words.extend(
        Function::ALL
            .iter()
            .map(|f| (f.name(), Builtin::Function(*f))),
    );
    words.extend(entries(AnyModifier::DECLARATIONS, Builtin::Modifier));
    words.extend(entries(AnyPrimitive::DECLARATIONS, Builtin::Primitive));
    words.extend(Operation::ALL.map(|(name, o)| (name, Builtin::Operation(o))));
    words
});

impl Builtin {
    /// What the word stands for, if it is built in.
    pub fn named(word: &str) -> Option<Self> {
        WORDS.get(word).copied()
    }

    /// Every built-in word, sorted.
    pub fn names() -> Vec<&'static str> {
        let mut names: Vec<_> = WORDS.keys().copied().collect();
        names.sort_unstable();
        names
    }

    /// The blend of this name, also where a function has the same.
    pub fn blend(word: &str) -> Option<&'static Declaration> {
        AnyBlend::DECLARATIONS
            .iter()
            .copied()
            .find(|entry| entry.name == word)
    }

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primitive(entry) | Self::Modifier(entry) | Self::Blend(entry) => entry.name,
            Self::Operation(operation) => operation.name(),
            Self::Function(function) => function.name(),
            Self::Constant(x) if x == std::f64::consts::PI => "pi",
            Self::Constant(x) if x == std::f64::consts::TAU => "tau",
            Self::Constant(_) => "infinity",
            Self::Intrinsic(intrinsic) => intrinsic.name(),
        }
    }
}
