//! Random instances of every entry, from its declaration.

use fieldstone::catalogue::*;
use fieldstone::scene::Node;
use std::sync::Arc;

/// Numbers from a counter, so that a seed names a case. Source: the finalizer of MurmurHash3.
pub struct Dice {
    state: u64,
}

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self {
            state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678,
        }
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        z = (z ^ (z >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        ((z ^ (z >> 33)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A point of a box.
    pub fn point(&mut self, bounds: &Bounds) -> [f64; 3] {
        std::array::from_fn(|i| self.between(bounds.low[i], bounds.high[i]))
    }

    /// One of `n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }
}

pub fn declarations() -> impl Iterator<Item = &'static Declaration> {
    let lists = [
        AnyPrimitive::DECLARATIONS,
        AnyModifier::DECLARATIONS,
        AnyBlend::DECLARATIONS,
    ];
    lists.into_iter().flatten().copied()
}

/// A random argument that the parameter's range allows.
fn argument(parameter: &Parameter, dice: &mut Dice) -> Argument {
    let range = parameter.range;
    let low = range
        .low
        .max(-1.0)
        .max(if range.includes_low { f64::MIN } else { 0.1 });
    let high = range.high.min(match parameter.kind {
        Kind::Count => 6.0,
        Kind::Angle if range.high < f64::MAX => range.high,
        _ => 1.2,
    });
    let mut number = || dice.between(low, high);
    match parameter.kind {
        Kind::Number => Argument::Number(number()),
        Kind::Count => Argument::Number(number().round()),
        Kind::Angle => Argument::Angle(number()),
        Kind::Vector2 => Argument::Vector2([number(), number()]),
        Kind::Vector3 | Kind::Factors => Argument::Vector3([number(), number(), number()]),
        Kind::Direction => Argument::Vector3([number() + 0.01, number(), number()]),
        Kind::Axis => Argument::Axis(dice.below(3)),
        Kind::Points => Argument::Points(star(dice)),
        Kind::Points3 => {
            let points = (0..1 + dice.below(5)).map(|_| dice.point(&Bounds::centred([0.8; 3])));
            Argument::Points3(points.collect())
        }
    }
}

/// A star-shaped outline, which does not cross itself.
fn star(dice: &mut Dice) -> Vec<[f64; 2]> {
    let n = 3 + dice.below(5);
    (0..n)
        .map(|i| {
            let (angle, r) = (
                std::f64::consts::TAU * i as f64 / n as f64,
                dice.between(0.3, 0.9),
            );
            [r * angle.cos(), r * angle.sin()]
        })
        .collect()
}

/// Random arguments, which the entry may still refuse.
pub fn arguments(declaration: &Declaration, dice: &mut Dice) -> Vec<Argument> {
    declaration
        .parameters
        .iter()
        .map(|p| match (p.name, p.default) {
            // Copies: a few, so that a union can be compared; spacings that let copies overlap now and then.
            ("count", Some(_)) => {
                Argument::Vector3([0; 3].map(|_: i32| 1.0 + dice.below(5) as f64))
            }
            ("count", None) => Argument::Number(1.0 + dice.below(7) as f64),
            // A shape leans across the axis y.
            ("by", None) if declaration.name == "shear" => {
                Argument::Vector3([dice.between(-1.2, 1.2), 0.0, dice.between(-1.2, 1.2)])
            }
            ("axis", Some(_)) if declaration.name == "shear" => Argument::Axis(1),
            ("spacing", None) => Argument::Vector3([0; 3].map(|_: i32| dice.between(0.5, 2.5))),
            _ => argument(p, dice),
        })
        .collect()
}

/// The entries of one kind that the laws are tried on: all, unless `FIELDSTONE_ENTRIES` names some of them (separated by
/// commas).
pub fn tried(all: &[&'static Declaration]) -> Vec<&'static Declaration> {
    let names = std::env::var("FIELDSTONE_ENTRIES").unwrap_or_default();
    let named = |d: &&'static Declaration| names.split(',').any(|name| name == d.name);
    let some: Vec<_> = all.iter().copied().filter(named).collect();
    if some.is_empty() { all.to_vec() } else { some }
}

/// A random valid instance of a primitive.
pub fn leaf(declaration: &Declaration, seed: u64) -> (String, Arc<Node>) {
    let mut dice = Dice::new(seed * 31 + declaration.name.len() as u64);
    for _ in 0..1000 {
        let arguments = arguments(declaration, &mut dice);
        let primitive =
            AnyPrimitive::from_arguments(declaration.name, &arguments).expect("listed by name");
        if let Ok(node) = Node::primitive(primitive) {
            return (format!("{}{arguments:?}", declaration.name), node);
        }
    }
    panic!("{}: no valid arguments found", declaration.name);
}

/// `n` random instances of every primitive, with the name of its entry.
pub fn leaves(n: u64) -> Vec<(&'static str, String, Arc<Node>)> {
    let mut all = Vec::new();
    for d in tried(AnyPrimitive::DECLARATIONS) {
        for seed in 0..n {
            let (name, node) = leaf(d, seed);
            all.push((d.name, name, node));
        }
    }
    all
}

/// The shape turned and moved at random; a profile stays in its plane.
pub fn placed(node: Arc<Node>, dice: &mut Dice) -> Arc<Node> {
    let (angle, is_planar) = (dice.between(0.3, 2.8), node.traits().is_planar);
    let axis: [f64; 3] = std::array::from_fn(|_| dice.between(-1.0, 1.0));
    let shift: [f64; 3] = std::array::from_fn(|_| dice.between(-0.9, 0.9));
    let [axis, shift] = if is_planar {
        [[0.0, 0.0, 1.0], [shift[0], shift[1], 0.0]]
    } else {
        [axis, shift]
    };
    let turned = AnyModifier::Rotate(Rotate::new(angle, axis, 0.0, 0.0, 0.0));
    let moved = AnyModifier::Translate(Translate::new(shift));
    let node = Node::modifier(turned, node).expect("anything turns");
    Node::modifier(moved, node).expect("anything moves")
}

/// A profile with thickness; a shape in space as it is.
pub fn in_space(node: Arc<Node>, height: f64) -> Arc<Node> {
    if !node.traits().is_planar {
        return node;
    }
    let extrude = AnyModifier::Extrude(Extrude::new(height, 0.0, 1.0));
    Node::modifier(extrude, node).expect("a profile can be extruded")
}

/// `n` random instances of every primitive; profiles are extruded.
pub fn instances(n: u64) -> Vec<(String, Arc<Node>)> {
    leaves(n)
        .into_iter()
        .enumerate()
        .map(|(i, (_, name, node))| (name, in_space(node, 0.2 + 0.1 * (i % 9) as f64)))
        .collect()
}

/// A seed for a name, so that the cases of one entry do not change with what else is listed.
pub fn seed_of(name: &str) -> u64 {
    name.bytes().fold(0, |seed: u64, byte| {
        seed.wrapping_mul(31).wrapping_add(byte.into())
    })
}

/// One random instance of every modifier, each with numbers of its own.
pub fn modifiers(dice: &mut Dice) -> Vec<AnyModifier> {
    let seed = (1e9 * dice.unit()) as u64;
    let made = |d: &&'static Declaration| {
        let mut own = Dice::new(seed.wrapping_add(seed_of(d.name)));
        AnyModifier::from_arguments(d.name, &arguments(d, &mut own)).expect("listed by name")
    };
    tried(AnyModifier::DECLARATIONS).iter().map(made).collect()
}

/// One random instance of every blend.
pub fn blends(dice: &mut Dice) -> Vec<AnyBlend> {
    tried(AnyBlend::DECLARATIONS)
        .iter()
        .map(|d| AnyBlend::from_arguments(d.name, &arguments(d, dice)).expect("listed by name"))
        .collect()
}

/// What a blend can be used for.
pub fn operations(blend: &AnyBlend) -> Vec<Operation> {
    match blend.manner() {
        Manner::Seam => Operation::ALL.map(|(_, operation)| operation).to_vec(),
        Manner::Pair | Manner::Several => vec![Operation::Joint],
    }
}

/// Small asymmetric shapes and shapes larger than a cell, for repetition.
pub fn nodes() -> Vec<(String, Arc<Node>)> {
    let mut all = instances(2);
    all.retain(|(_, node)| node.bounds().is_finite());
    let shifted = all.iter().map(|(name, node)| {
        let shift = AnyModifier::Translate(Translate::new([0.21, -0.13, 0.4]));
        (
            format!("{name} shifted"),
            Node::modifier(shift, node.clone()).expect("anything moves"),
        )
    });
    let shifted: Vec<_> = shifted.collect();
    all.extend(shifted);
    all
}
