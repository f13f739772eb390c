//! Random trees over the whole catalogue: every primitive, modifier, operation and blend with random arguments.

use super::samples::{Dice, arguments, in_space, operations, tried};
use fieldstone::catalogue::*;
use fieldstone::scene::Node;
use std::sync::Arc;

/// A random tree of a few operations, in words. The seed names it.
pub fn random_tree(seed: u64) -> (String, Arc<Node>) {
    let mut growth = Growth {
        dice: Dice::new(seed ^ 0xabcd_ef01),
        may_repeat: true,
    };
    let depth = 1 + growth.dice.below(4) as u32;
    let (words, node) = growth.solid(depth);
    (format!("tree {seed}: {words}"), node)
}

type Branch = (String, Arc<Node>);

struct Growth {
    dice: Dice,
    /// Repetitions of repetitions ask too many copies to be tried ten thousand times.
    may_repeat: bool,
}

impl Growth {
    /// A shape in space of at most `depth` operations from root to leaf.
    fn solid(&mut self, depth: u32) -> Branch {
        let (words, node) = if depth > 1 && self.dice.unit() < 0.2 {
            self.branch(depth - 1, true)
        } else {
            self.branch(depth, false)
        };
        if !node.traits().is_planar {
            return (words, node);
        }
        // A modifier that makes a shape in space of a profile, if one of a few does.
        for _ in 0..8 {
            let (modifier, call) = self.modifier();
            if let Ok(solid) = Node::modifier(modifier.clone(), node.clone())
                && !solid.traits().is_planar
            {
                return (format!("{words}.{call}"), solid);
            }
        }
        let height = self.dice.between(0.2, 1.0);
        (format!("{words}.extrude({height})"), in_space(node, height))
    }

    /// A shape in space or a profile.
    fn branch(&mut self, depth: u32, is_planar: bool) -> Branch {
        if depth == 0 || self.dice.unit() < 0.1 {
            return self.leaf(is_planar);
        }
        if self.dice.unit() < 0.5 {
            return self.modified(depth, is_planar);
        }
        let blend = self.blend();
        let n = match blend.manner() {
            Manner::Pair => 2,
            Manner::Seam | Manner::Several => 2 + self.dice.below(2),
        };
        let children: Vec<Branch> = (0..n)
            .map(|_| {
                if is_planar {
                    self.branch(depth - 1, true)
                } else {
                    self.solid(depth - 1)
                }
            })
            .collect();
        let all = operations(&blend);
        let operation = all[self.dice.below(all.len())];
        let words: Vec<_> = children.iter().map(|(words, _)| words.as_str()).collect();
        let words = format!("{operation:?}({}, {blend:?})", words.join(", "));
        let nodes: Vec<_> = children.iter().map(|(_, node)| node.clone()).collect();
        let combination = Combination { operation, blend };
        match Node::combination(combination, nodes) {
            Ok(node) => (words, node),
            Err(_) => children.into_iter().next().expect("two or three"),
        }
    }

    fn modified(&mut self, depth: u32, is_planar: bool) -> Branch {
        let (modifier, call) = self.modifier();
        let name = modifier.declaration().name;
        let repeats = name.contains("repeat") || name.contains("polar");
        let may_repeat = self.may_repeat;
        self.may_repeat &= !repeats;
        let (words, child) = self.branch(depth - 1, is_planar);
        self.may_repeat = may_repeat;
        if repeats && !may_repeat {
            return (words, child);
        }
        let modified = |child: &Arc<Node>| Node::modifier(modifier.clone(), child.clone());
        let is_same_kind = |node: &Arc<Node>| node.traits().is_planar == is_planar;
        match modified(&child) {
            Ok(node) if node.lipschitz().is_finite() && is_same_kind(&node) => {
                (format!("{words}.{call}"), node)
            }
            // What has no constant on all of space gets one on a box.
            Ok(node) if is_same_kind(&node) && !is_planar => {
                let cut = Node::primitive(AnyPrimitive::Cuboid(Cuboid::new([1.6; 3], 0.0)))
                    .and_then(|cut| {
                        let combination = Combination {
                            operation: Operation::Intersection,
                            blend: AnyBlend::HARD,
                        };
                        Node::combination(combination, vec![child.clone(), cut])
                    })
                    .expect("two shapes in space");
                match modified(&cut) {
                    Ok(node) if node.lipschitz().is_finite() => {
                        (format!("({words} & box(1.6)).{call}"), node)
                    }
                    _ => (words, child),
                }
            }
            _ => (words, child),
        }
    }

    fn leaf(&mut self, is_planar: bool) -> Branch {
        let all = tried(AnyPrimitive::DECLARATIONS);
        for _ in 0..200 {
            let declaration = all[self.dice.below(all.len())];
            let arguments = arguments(declaration, &mut self.dice);
            let primitive =
                AnyPrimitive::from_arguments(declaration.name, &arguments).expect("listed by name");
            if let Ok(node) = Node::primitive(primitive)
                && node.traits().is_planar == is_planar
            {
                return (call(declaration, &arguments), node);
            }
        }
        // Where only a few entries are tried, there may be no profile among them, or nothing else.
        let (words, primitive) = if is_planar {
            ("circle(0.5)", AnyPrimitive::Circle(Circle::new(0.5)))
        } else {
            ("sphere(0.5)", AnyPrimitive::Sphere(Sphere::new(0.5)))
        };
        (
            words.into(),
            Node::primitive(primitive).expect("a valid leaf"),
        )
    }

    fn modifier(&mut self) -> (AnyModifier, String) {
        let all = tried(AnyModifier::DECLARATIONS);
        let declaration = all[self.dice.below(all.len())];
        let arguments = arguments(declaration, &mut self.dice);
        let modifier = AnyModifier::from_arguments(declaration.name, &arguments);
        (
            modifier.expect("listed by name"),
            call(declaration, &arguments),
        )
    }

    fn blend(&mut self) -> AnyBlend {
        let all = tried(AnyBlend::DECLARATIONS);
        if self.dice.unit() < 0.3 {
            return AnyBlend::HARD;
        }
        let declaration = all[self.dice.below(all.len())];
        let arguments = arguments(declaration, &mut self.dice);
        AnyBlend::from_arguments(declaration.name, &arguments).expect("listed by name")
    }
}

/// The entry as it is written in scripts.
fn call(declaration: &Declaration, arguments: &[Argument]) -> String {
    let arguments: Vec<_> = declaration
        .parameters
        .iter()
        .zip(arguments)
        .map(|(parameter, argument)| format!("{}: {argument}", parameter.name))
        .collect();
    format!("{}({})", declaration.name, arguments.join(", "))
}
