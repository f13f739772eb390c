//! `fieldstone explain`: what is known of a scene's shapes, and what it compiled in.

use super::console::{answer, counted};
use super::failure::Failure;
use super::outline::{bounds_in_words, object_name, short};
use super::script::{Script, compile};
use crate::catalogue::{Bounds, Combination, Modifier, Operation, with_modifier};
use crate::field::Level;
use crate::scene::{Node, Scene, Shadow, Shape, sampled_supremum};
use crate::shade::{FAINTEST, Features, sight};
use crate::trace::World;
use clap::Args;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How many nodes of a tree are told of, for people.
const MAX_LINES: usize = 400;

/// How many children of a node are told of, for people.
const MAX_CHILDREN: usize = 12;

/// How many nodes are told of, for programs.
const MAX_NODES: usize = 100_000;

const AFTER_HELP: &str = "\
For each shape: what it is and its name; its class (exact: the field is the distance; bound: at most the distance; \
lipschitz: at most the distance times the constant); a Lipschitz constant of its field; where that holds (everywhere, \
or on the bounds); the steepest slope that sampling found there; the slack, which is constant / slope; a box that \
holds the shape. Then the rule behind each constant, how rays find the parts of the scene, which features it \
compiled in, and what is passed over because nothing of it is seen: what a scene does not use costs nothing.

Large trees are cut; --json has all of it, up to 100 000 nodes.

Examples:
  fieldstone explain scene.sdf
  fieldstone explain scene.sdf --json | jq '.shown[0].lipschitz'";

/// Print what is known of a scene's shapes, how rays find them, and what it compiled in
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    script: Script,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// Explains the scene. A scene that can't be traced is explained as far as it goes.
///
/// # Errors
/// If the script is wrong, or a shape can't be traced.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.script.load()?.scene;
    let world = compile(&scene);
    let known = world.as_ref().ok();
    if arguments.json {
        answer(&format!("{:#}\n", to_json(&scene, known)))?;
    } else {
        answer(&in_words(&scene, known))?;
    }
    world.map(drop)
}

/// All of it for people.
fn in_words(scene: &Scene, world: Option<&World>) -> String {
    let mut text = tree_in_words(&scene.shown);
    text.push_str(&rules_in_words(&scene.shown));
    if let Some(world) = world {
        text.push_str(&paths_in_words(world));
        text.push_str("\ncompiled in\n");
        let features = Features::new(scene, world);
        for word in features.words() {
            text.push_str(&format!("  {word}\n"));
        }
        text.push_str(&format!("  closures for {}\n", Level::best().name()));
        let savings = savings(scene, world, &features);
        if !savings.is_empty() {
            text.push_str("\npassed over\n");
        }
        for saving in savings {
            text.push_str(&format!("  {saving}\n"));
        }
    }
    text
}

/// What is passed over on the way to the picture, and why that changes nothing that is seen, in words.
fn savings(scene: &Scene, world: &World, features: &Features) -> Vec<String> {
    let mut found = Vec::new();
    let (placed, folded) = folds(&scene.shown);
    if placed > folded {
        let maps = counted(folded, "map");
        found.push(format!("{placed} transforms in a row, folded into {maps}"));
    }
    if world.prunes() {
        found.extend(pruned_in_words(world));
    }
    if features.lit {
        let dark = scene.lights.iter().filter(|light| !light.shines()).count();
        if dark > 0 {
            found.push(format!("{}: black", counted(dark, "light")));
        }
        found.push("lights behind a surface, and shadow rays to them".into());
        let is_blocked = features.opaque_shadows || features.tinted_shadows;
        if !is_blocked && world.materials().iter().any(|m| m.shadow != Shadow::None) {
            found.push("all shadow rays: the only solid is convex".into());
        }
    }
    if features.reflects {
        let least = (1.0 / FAINTEST).round();
        found.push(format!("rays that weigh less than 1/{least}"));
        let depth = scene.settings.depth;
        found.push(format!("rays deeper than {depth}"));
    }
    if let Some(fog) = scene.fog.filter(|_| features.fog) {
        let far = short(sight(&fog));
        found.push(format!(
            "what lies farther than {far}: less than 1/4096 of its light passes the fog"
        ));
    }
    found
}

/// How many transforms that keep angles there are below one another, and into how many maps they are folded.
fn folds(nodes: &[Arc<Node>]) -> (usize, usize) {
    let (mut placed, mut folded) = (0, 0);
    let mut open: Vec<(&Arc<Node>, usize)> = nodes.iter().map(|node| (node, 0)).collect();
    while let Some((node, above)) = open.pop() {
        let keeps_angles = match node.shape() {
            Shape::Modifier(modifier, _) => with_modifier!(modifier, m => m.similarity()).is_some(),
            _ => false,
        };
        let here = if keeps_angles { above + 1 } else { 0 };
        if !keeps_angles && above > 1 {
            placed += above;
            folded += 1;
        }
        open.extend(node.children().iter().map(|child| (child, here)));
    }
    (placed, folded)
}

/// What beams spare rays, in words.
fn pruned_in_words(world: &World) -> Vec<String> {
    let boxes = world.parts() - world.endless_parts();
    let mut found = Vec::new();
    if boxes > 0 {
        let all = counted(boxes, "bounded part");
        let mut meet = format!("blocks of 16 x 16 pixels that meet none of {all}");
        if world.endless_parts() > 0 {
            let endless = counted(world.endless_parts(), "endless part");
            meet.push_str(&format!(" and of {endless}"));
        }
        found.push(format!("{meet}: the sky"));
    }
    if boxes > 1 {
        found.push(format!(
            "parts that the beam of 256 rays, or the cone of 32, misses: a hierarchy of {boxes} boxes"
        ));
    }
    found
}

/// A line of the tree.
#[derive(Default)]
struct Line {
    /// What it is, drawn under its parent.
    label: String,
    class: &'static str,
    lipschitz: String,
    certified: &'static str,
    sampled: String,
    slack: String,
    bounds: String,
}

/// How many evaluations of a node all suprema together may take.
const MAX_EVALUATIONS: u64 = 4_000_000;

/// The steepest slope that sampling finds where the node's constant holds, with a share of [`MAX_EVALUATIONS`].
fn supremum(node: &Node, share: usize) -> Option<f64> {
    let samples = MAX_EVALUATIONS / (share.max(1) as u64 * node.size());
    sampled_supremum(node, node.certified_region(), samples.clamp(16, 4096))
}

/// The constant divided by the steepest slope found, where both are known.
fn slack(node: &Node, supremum: Option<f64>) -> Option<f64> {
    let slack = node.lipschitz() / supremum?;
    slack.is_finite().then_some(slack)
}

/// Where a node's constant holds, in a word.
fn certified(node: &Node) -> &'static str {
    if node.certified_region() == Bounds::EVERYWHERE {
        "everywhere"
    } else {
        "bounds"
    }
}

/// The trees as a table.
fn tree_in_words(shown: &[Arc<Node>]) -> String {
    let mut lines = Vec::new();
    add_children(shown, "", true, &mut lines);
    let sampled: Vec<Option<f64>> = lines
        .iter()
        .map(|(_, node)| node.and_then(|node| supremum(node, lines.len())))
        .collect();
    let mut rows = vec![Line {
        label: "shown".into(),
        class: "class",
        lipschitz: "lipschitz".into(),
        certified: "holds on",
        sampled: "sampled".into(),
        slack: "slack".into(),
        bounds: "bounds".into(),
    }];
    for ((label, node), sampled) in lines.into_iter().zip(sampled) {
        rows.push(match node {
            Some(node) => Line {
                label,
                class: node.class().word(),
                lipschitz: short(node.lipschitz()),
                certified: certified(node),
                sampled: sampled.map_or("-".into(), short),
                slack: slack(node, sampled).map_or("-".into(), |slack| format!("{slack:.2}")),
                bounds: bounds_in_words(&node.bounds()),
            },
            None => Line {
                label,
                ..Line::default()
            },
        });
    }
    let width = |cell: &dyn Fn(&Line) -> usize| rows.iter().map(cell).max().unwrap_or(0);
    let label = width(&|l| l.label.chars().count());
    let lipschitz = width(&|l| l.lipschitz.len());
    let sampled = width(&|l| l.sampled.len());
    let mut text = String::new();
    for l in &rows {
        let line = format!(
            "{:label$}  {:9}  {:lipschitz$}  {:10}  {:sampled$}  {:5}  {}",
            l.label, l.class, l.lipschitz, l.certified, l.sampled, l.slack, l.bounds
        );
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// Adds the lines of these nodes, each after `indent`, with the node where it is not a line that stands for many; at the
/// root there are no branches.
fn add_children<'a>(
    nodes: &'a [Arc<Node>],
    indent: &str,
    is_root: bool,
    lines: &mut Vec<(String, Option<&'a Node>)>,
) {
    for (i, node) in nodes.iter().enumerate() {
        let rest = nodes.len() - i;
        let is_cut = lines.len() >= MAX_LINES || (i + 1 >= MAX_CHILDREN && rest > 1);
        let is_last = is_cut || rest == 1;
        let (branch, below) = match (is_root, is_last) {
            (true, _) => ("", ""),
            (false, true) => ("└─ ", "   "),
            (false, false) => ("├─ ", "│  "),
        };
        if is_cut {
            let label = format!("{indent}{branch}... {rest} more");
            lines.push((label, None));
            return;
        }
        lines.push((format!("{indent}{branch}{}", label(node)), Some(node)));
        add_children(node.children(), &format!("{indent}{below}"), false, lines);
    }
}

/// What a node is, its name and its line.
fn label(node: &Node) -> String {
    let mut label = node.kind().to_string();
    if let Some(name) = node.name().filter(|name| *name != node.kind()) {
        label.push_str(&format!(" `{name}`"));
    }
    if let Some(place) = node.place() {
        label.push_str(&format!(" (line {})", place.line));
    }
    label
}

/// The rules behind the constants, each kind of shape once.
fn rules_in_words(shown: &[Arc<Node>]) -> String {
    let mut rules = BTreeMap::new();
    let mut left = MAX_NODES;
    for node in shown {
        collect_rules(node, &mut rules, &mut left);
    }
    let width = rules.keys().map(|kind| kind.len()).max().unwrap_or(0);
    let mut text = String::from("\nrules\n");
    for (kind, rule) in &rules {
        text.push_str(&format!("  {kind:width$}  {rule}\n"));
    }
    text
}

/// Whether the combination is a set operation that does more to its seam than to leave it.
fn has_seam(combination: &Combination) -> bool {
    combination.operation != Operation::Joint && !combination.blend.is_hard()
}

fn collect_rules(node: &Node, rules: &mut BTreeMap<String, &'static str>, left: &mut usize) {
    if *left == 0 {
        return;
    }
    *left -= 1;
    let kind = match node.shape() {
        Shape::Field(field) => format!("field {}", field.name),
        Shape::Combination(combination, _) if has_seam(combination) => {
            format!("{} by {}", node.kind(), combination.blend.name())
        }
        _ => node.kind().into(),
    };
    rules.insert(kind, node.rule());
    for child in node.children() {
        collect_rules(child, rules, left);
    }
}

/// How rays find the parts: each way with how many go it and what they are.
fn paths_in_words(world: &World) -> String {
    let mut ways: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for (way, node) in world.paths() {
        *ways
            .entry(way)
            .or_default()
            .entry(object_name(node))
            .or_default() += 1;
    }
    let width = ways.keys().map(|way| way.len()).max().unwrap_or(0);
    let mut text = format!("\nray paths of {}\n", counted(world.parts(), "part"));
    for (way, objects) in &ways {
        let mut names: Vec<String> = objects
            .iter()
            .take(MAX_CHILDREN)
            .map(|(name, n)| match n {
                1 => (*name).to_string(),
                n => format!("{n} x {name}"),
            })
            .collect();
        if objects.len() > MAX_CHILDREN {
            names.push(format!("{} more", objects.len() - MAX_CHILDREN));
        }
        text.push_str(&format!("  {way:width$}  {}\n", names.join(", ")));
    }
    text
}

/// All of it for programs.
fn to_json(scene: &Scene, world: Option<&World>) -> Value {
    let mut left = MAX_NODES;
    let share = scene.shown.iter().map(|node| node.size()).sum::<u64>();
    let share = share.min(MAX_NODES as u64) as usize;
    let shown: Vec<Value> = scene
        .shown
        .iter()
        .map_while(|node| node_to_json(node, share, &mut left))
        .collect();
    let mut value = json!({ "schema": 1, "shown": shown, "is_cut": left == 0 });
    if let Some(world) = world {
        let parts: Vec<Value> = world
            .paths()
            .map(|(way, node)| json!({ "path": way, "object": object_name(node) }))
            .collect();
        value["parts"] = json!(parts);
        let features = Features::new(scene, world);
        value["features"] = json!(features.words());
        value["passed_over"] = json!(savings(scene, world, &features));
        value["processor"] = json!(Level::best().name());
    }
    value
}

/// The node and its children; none once `left` nodes have been told of.
fn node_to_json(node: &Node, share: usize, left: &mut usize) -> Option<Value> {
    *left = left.checked_sub(1)?;
    let children: Vec<Value> = node
        .children()
        .iter()
        .map_while(|child| node_to_json(child, share, left))
        .collect();
    let sampled = supremum(node, share);
    Some(json!({
        "kind": node.kind(),
        "name": node.name(),
        "file": node.place().map(|place| &*place.file),
        "line": node.place().map(|place| place.line),
        "class": node.class().word(),
        "lipschitz": finite(node.lipschitz()),
        "region": bounds_to_json(&node.certified_region()),
        "supremum": sampled,
        "slack": slack(node, sampled),
        "bounds": bounds_to_json(&node.bounds()),
        "rule": node.rule(),
        "children": children,
    }))
}

/// The corners, with null for what is infinite; null for the bounds of nothing.
fn bounds_to_json(bounds: &Bounds) -> Value {
    if bounds.is_empty() {
        return Value::Null;
    }
    json!({ "min": bounds.low.map(finite), "max": bounds.high.map(finite) })
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{
        AnyBlend, AnyModifier, AnyPrimitive, Combination, Operation, Sphere, Translate,
    };

    fn balls(n: usize) -> Arc<Node> {
        let ball = |i| {
            let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
            let at = [3.0 * i as f64, 0.0, 0.0];
            Node::modifier(AnyModifier::Translate(Translate::new(at)), ball).unwrap()
        };
        let union = Combination {
            operation: Operation::Union,
            blend: AnyBlend::HARD,
        };
        Node::combination(union, (0..n).map(ball).collect()).unwrap()
    }

    #[test]
    fn tree_is_drawn_with_branches() {
        let expected = "\
shown              class      lipschitz  holds on    sampled  slack  bounds
union              exact      1          everywhere  1        1.00   [-1, -1, -1] to [4, 1, 1]
├─ translate       exact      1          everywhere  1        1.00   [-1, -1, -1] to [1, 1, 1]
│  └─ sphere       exact      1          everywhere  1        1.00   [-1, -1, -1] to [1, 1, 1]
└─ translate       exact      1          everywhere  1        1.00   [2, -1, -1] to [4, 1, 1]
   └─ sphere       exact      1          everywhere  1        1.00   [-1, -1, -1] to [1, 1, 1]
";
        let squeezed = |text: &str| {
            let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
            text.lines().map(words).collect::<Vec<_>>()
        };
        let drawn = tree_in_words(&[balls(2)]);
        // The class of a union is the catalogue's business.
        assert_eq!(
            squeezed(&drawn.replace("bound ", "exact ")),
            squeezed(expected)
        );
    }

    #[test]
    fn large_trees_are_cut() {
        let drawn = tree_in_words(&[balls(10_000)]);
        assert!(drawn.lines().count() < 40);
        assert!(drawn.contains("└─ ... 9989 more"));
    }

    #[test]
    fn infinite_numbers_are_null_for_programs() {
        assert_eq!(
            bounds_to_json(&Bounds::EVERYWHERE),
            json!({"min": [null, null, null], "max": [null, null, null]})
        );
        assert_eq!(bounds_to_json(&Bounds::EMPTY), Value::Null);
    }
}
