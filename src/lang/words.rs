//! The words that every script knows, with what is said of each: what the reference prints.

use super::builtin::Intrinsic;
use super::hint::nearest;
use crate::catalogue::{
    AnyBlend, AnyModifier, AnyPrimitive, Argument, Declaration, Function, Manner, Operation,
    Parameter,
};
use crate::scene::Node;
use std::sync::Arc;

/// The scene that shows an entry: the first line that starts with `let entry` makes way for the entry's example.
const STAGE: &str = include_str!("stage.sdf");

/// What a word makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// A leaf in space.
    Solid,
    /// A leaf in the plane.
    Profile,
    /// One shape of several.
    Combination,
    /// A seam between shapes.
    Blend,
    /// A changed shape.
    Modifier,
    /// A number, a pattern or what else a function gives.
    Function,
}

impl Group {
    /// All groups, in the order of the reference, with their titles.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Solid, "Solids"),
        (Self::Profile, "Profiles"),
        (Self::Combination, "Combinations"),
        (Self::Blend, "Blends"),
        (Self::Modifier, "Modifiers"),
        (Self::Function, "Functions and patterns"),
    ];
}

/// A word that every script knows.
#[derive(Clone, Debug)]
pub struct Word {
    /// The word itself.
    pub name: &'static str,
    /// What it makes.
    pub group: Group,
    /// A call of it, with the values that its parameters have when they are left out.
    pub signature: String,
    /// What it gives, in one or two sentences.
    pub summary: String,
    /// How many shapes a call of it takes at most before its parameters; the shape before a point does not count.
    pub operands: usize,
    /// Its parameters in positional order; none are known of functions and combinations.
    pub parameters: &'static [Parameter],
    /// Where its formula and its Lipschitz rule come from; may be empty.
    pub source: &'static str,
    /// A line of script that shows it: a shape, or statements that end in `let entry = ` and a shape; empty for most
    /// functions.
    pub example: &'static str,
    /// The shape that a call without arguments makes, of solids and profiles.
    pub shape: Option<Arc<Node>>,
}

impl Word {
    /// Every word, group by group.
    pub fn all() -> Vec<Self> {
        let primitives = AnyPrimitive::DECLARATIONS
            .iter()
            .map(|d| Self::primitive(d));
        let (profiles, solids): (Vec<_>, Vec<_>) =
            primitives.partition(|word| word.group == Group::Profile);
        let mut all = solids;
        all.extend(profiles);
        all.extend(Operation::ALL.map(|(_, operation)| Self::operation(operation)));
        let blends = AnyBlend::DECLARATIONS.iter().map(|d| Self::blend(d));
        let (seams, joints): (Vec<_>, Vec<_>) = blends.partition(|word| word.group == Group::Blend);
        all.extend(joints);
        all.extend(seams);
        all.extend(
            AnyModifier::DECLARATIONS
                .iter()
                .map(|d| Self::entry(d, Group::Modifier)),
        );
        let mut functions: Vec<Self> = Function::ALL.iter().map(|f| Self::function(*f)).collect();
        functions.extend(
            Intrinsic::ALL.map(|(name, intrinsic, arguments, gives)| Self {
                signature: format!("{name}({arguments})"),
                summary: sentence(gives),
                example: intrinsic.example(),
                ..Self::named(name, Group::Function)
            }),
        );
        functions.sort_by_key(|word| word.name);
        all.extend(functions);
        all
    }

    /// The word that `name` is probably a misspelling of.
    pub fn nearest(name: &str) -> Option<&'static str> {
        nearest(name, Self::all().iter().map(|word| word.name))
    }

    /// A script that shows the example on the stage of all pictures of the reference.
    pub fn scene(&self) -> Option<String> {
        let (before, line) = STAGE.split_once("let entry")?;
        let (_, after) = line.split_once('\n')?;
        let example = self.example;
        let entry = if example.contains("let entry") {
            example.to_string()
        } else {
            format!("let entry = {example}")
        };
        (!example.is_empty()).then(|| format!("{before}{entry}\n{after}"))
    }

    fn named(name: &'static str, group: Group) -> Self {
        Self {
            name,
            group,
            signature: String::new(),
            summary: String::new(),
            operands: 0,
            parameters: &[],
            source: "",
            example: "",
            shape: None,
        }
    }

    fn entry(declaration: &Declaration, group: Group) -> Self {
        let receiver = if group == Group::Modifier {
            "shape."
        } else {
            ""
        };
        Self {
            signature: format!("{receiver}{}", call(declaration)),
            summary: declaration.summary.trim().into(),
            parameters: declaration.parameters,
            source: declaration.source,
            example: declaration.example,
            ..Self::named(declaration.name, group)
        }
    }

    fn primitive(declaration: &Declaration) -> Self {
        let shape = defaults(declaration).and_then(|arguments| {
            let primitive = AnyPrimitive::from_arguments(declaration.name, &arguments)?;
            Node::primitive(primitive).ok()
        });
        let is_planar = shape.as_ref().is_some_and(|node| node.traits().is_planar);
        let group = if is_planar {
            Group::Profile
        } else {
            Group::Solid
        };
        Self {
            shape,
            ..Self::entry(declaration, group)
        }
    }

    /// A seam, or an operation of its own, whose parameters all have defaults.
    fn blend(declaration: &Declaration) -> Self {
        let blend = defaults(declaration)
            .and_then(|arguments| AnyBlend::from_arguments(declaration.name, &arguments));
        let (shapes, operands) = match blend.map(|blend| blend.manner()) {
            None | Some(Manner::Seam) => return Self::entry(declaration, Group::Blend),
            Some(Manner::Pair) => ("a, b", 2),
            Some(Manner::Several) => ("a, b, ...", usize::MAX),
        };
        let arguments = arguments(declaration);
        let comma = if arguments.is_empty() { "" } else { ", " };
        Self {
            signature: format!("{}({shapes}{comma}{arguments})", declaration.name),
            operands,
            ..Self::entry(declaration, Group::Combination)
        }
    }

    fn operation(operation: Operation) -> Self {
        Self {
            signature: format!(
                "{}(a, b, ..., blend: {}())",
                operation.name(),
                AnyBlend::HARD.name()
            ),
            summary: operation.summary().into(),
            example: operation.example(),
            operands: usize::MAX,
            ..Self::named(operation.name(), Group::Combination)
        }
    }

    fn function(function: Function) -> Self {
        let name = function.name();
        Self {
            signature: format!("{name}({})", function.arguments().join(", ")),
            summary: function.summary().trim().into(),
            ..Self::named(name, Group::Function)
        }
    }
}

/// The arguments of the entry that are used when none is given; none where one must be.
fn defaults(declaration: &Declaration) -> Option<Vec<Argument>> {
    let defaults = declaration.parameters.iter().map(|p| Some((p.default?)()));
    defaults.collect()
}

/// A call of the entry in which every parameter has its default, or where it must be given, only its name.
fn call(declaration: &Declaration) -> String {
    format!("{}({})", declaration.name, arguments(declaration))
}

/// The arguments of such a call.
fn arguments(declaration: &Declaration) -> String {
    let parameters = declaration
        .parameters
        .iter()
        .map(|p| match p.default_in_words() {
            Some(default) => format!("{}: {default}", p.name),
            None => p.name.into(),
        });
    parameters.collect::<Vec<_>>().join(", ")
}

/// The words as a sentence.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_primitive_has_a_shape_without_arguments() {
        for word in Word::all() {
            let is_leaf = matches!(word.group, Group::Solid | Group::Profile);
            assert_eq!(word.shape.is_some(), is_leaf, "{}", word.name);
        }
    }

    #[test]
    fn calls_are_as_they_would_be_written() {
        let signature = |name| {
            let all = Word::all();
            let word = all.iter().find(|word| word.name == name);
            word.map(|word| word.signature.clone()).unwrap_or_default()
        };
        assert_eq!(signature("torus"), "torus(major: 0.75, minor: 0.25)");
        assert_eq!(signature("shell"), "shape.shell(thickness)");
        assert_eq!(signature("mix"), "mix(a, b, t)");
        assert_eq!(signature("checker"), "checker(a, b, size?)");
        assert_eq!(signature("union"), "union(a, b, ..., blend: hard())");
        assert_eq!(signature("morph"), "morph(a, b, t: 0.5)");
        assert_eq!(signature("xor"), "xor(a, b, ...)");
        assert_eq!(signature("stairs"), "stairs(k, n: 3)");
    }

    #[test]
    fn scene_shows_the_example() {
        let all = Word::all();
        let scene = all[0].scene().expect("a shape has a scene");
        assert!(scene.contains(&format!("let entry = {}\n", all[0].example)));
        assert!(!scene.contains("let entry = sphere(0.123)"));
    }
}
