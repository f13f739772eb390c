//! Fields to try numbers on: every entry of the catalogue, fields of scripts, and scenes of the benchmarks.

use super::samples::{Dice, blends, in_space, leaf, leaves, modifiers, operations, placed};
use super::stub::Marcher;
use fieldstone::catalogue::*;
use fieldstone::lang;
use fieldstone::scene::Node;
use std::path::Path;
use std::sync::Arc;

/// Regions are clipped to so much on each side of the origin.
pub const REACH: f64 = 2.5;

/// The box of a node and a little more, within reach.
pub fn region(node: &Node) -> Bounds {
    let most = Bounds::centred([REACH; 3]);
    let bounds = node.bounds().intersect(most);
    if bounds.is_empty() {
        most
    } else {
        bounds.inflate(0.2).intersect(most)
    }
}

/// A box in the region, a sixteenth as wide.
pub fn part(region: &Bounds, dice: &mut Dice) -> Bounds {
    let low: [f64; 3] = std::array::from_fn(|i| {
        let width = region.high[i] - region.low[i];
        region.low[i] + width * dice.between(0.0, 15.0 / 16.0)
    });
    let high = std::array::from_fn(|i| low[i] + (region.high[i] - region.low[i]) / 16.0);
    Bounds::new(low, high)
}

/// A shape that is neither round nor symmetric.
fn base() -> Arc<Node> {
    let cuboid = leaf(
        AnyPrimitive::DECLARATIONS
            .iter()
            .find(|d| d.name == "box")
            .expect("a box"),
        3,
    );
    placed(cuboid.1, &mut Dice::new(5))
}

/// Every entry of the catalogue, by name: primitives, modifiers over a box, combinations of a box and a torus.
fn entries() -> Vec<(String, Arc<Node>)> {
    let mut all: Vec<(String, Arc<Node>)> = leaves(2)
        .into_iter()
        .map(|(name, _, node)| (name.into(), in_space(node, 0.4)))
        .collect();
    for seed in 0..2 {
        for modifier in modifiers(&mut Dice::new(seed)) {
            let flat = leaves(1).into_iter().find(|(name, ..)| *name == "star");
            let over = [base(), flat.expect("a star").2];
            let made = over
                .into_iter()
                .find_map(|child| Node::modifier(modifier.clone(), child).ok());
            let name = modifier.declaration().name;
            all.extend(made.map(|node| (format!(".{name}"), in_space(node, 0.4))));
        }
        for blend in blends(&mut Dice::new(seed)) {
            let torus = leaf(
                AnyPrimitive::DECLARATIONS
                    .iter()
                    .find(|d| d.name == "torus")
                    .expect("a torus"),
                1,
            );
            for operation in operations(&blend) {
                let combination = Combination {
                    operation,
                    blend: blend.clone(),
                };
                let name = format!("{} {}", combination.name(), blend.name());
                let node = Node::combination(combination, vec![base(), torus.1.clone()]);
                all.extend(node.ok().map(|node| (name, node)));
            }
        }
    }
    all
}

/// Fields of scripts.
const FIELDS: [&str; 5] = [
    "sin(3 * p.x) * cos(2 * p.y) + exp(-(p.z ^ 2)) - 0.7",
    "sqrt(p.x ^ 2 + 2 * p.y ^ 2 + p.z ^ 2 + 0.1) - 1",
    "noise(2 * p) + 0.3 * p.y",
    "if p.x < p.y { p.x + p.z } else { p.y + p.z }",
    "ln(2 + cos(p.x * p.y)) - abs(p.z) ^ 1.5 / 3",
];

fn shown(script: &str) -> Arc<Node> {
    let loaded = lang::load_text("field.sdf", script, &[], &Marcher);
    loaded
        .unwrap_or_else(|report| panic!("{script}: {report}"))
        .scene
        .shown[0]
        .clone()
}

/// Every entry of the catalogue, and fields of scripts, by name.
pub fn entries_and_fields() -> Vec<(String, Arc<Node>)> {
    let mut fields = entries();
    fields.extend(FIELDS.map(|formula| {
        let script = format!("field f(p) lipschitz 9 {{ {formula} }}\nshow f & sphere(2)");
        (formula.into(), shown(&script))
    }));
    fields
}

/// The object of a scene of the benchmarks, without a floor.
pub fn object(name: &str) -> Arc<Node> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("benches/scenes/{name}.sdf"));
    let alone = [("object_only".to_string(), "1".to_string())];
    let loaded = lang::load(&path, &alone, &Marcher).unwrap_or_else(|e| panic!("{e:?}"));
    loaded.scene.shown[0].clone()
}
