//! Scripts that a subcommand works on: loaded, with everything said that there is to say about them.

use super::console::{say, say_error, speaks_color};
use super::failure::Failure;
use super::value;
use crate::lang::{self, LoadError, Loaded};
use crate::scene::{Fault, Node, Scene, Settings};
use crate::trace::{SceneTracer, World};
use clap::Args;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Values for parameters of the scripts.
#[derive(Args, Debug)]
pub struct Definitions {
    /// A value for a `param` of the script; may be given several times
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = value::definition, allow_hyphen_values = true)]
    definitions: Vec<(String, String)>,
}

/// One script.
#[derive(Args, Debug)]
pub struct Script {
    /// The script of the scene
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    #[command(flatten)]
    definitions: Definitions,
}

impl Script {
    /// Loads the script and says what is worth knowing about it.
    ///
    /// # Errors
    /// If it can't be read, or is wrong; then all that is wrong has been said.
    pub fn load(&self) -> Result<Loaded, Failure> {
        load(&self.path, &self.definitions)
    }
}

/// Several scripts.
#[derive(Args, Debug)]
pub struct Scripts {
    /// The scripts of the scenes
    #[arg(value_name = "SCENE", required = true)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    definitions: Definitions,
}

impl Scripts {
    /// Does the work for every script, the others too if one fails.
    ///
    /// # Errors
    /// The failure with the largest exit code; all have been said. Nothing is done after the reader of the answer left.
    pub fn each(
        &self,
        work: impl FnMut(&Path, Loaded) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        each(&self.paths, &self.definitions, work)
    }

    /// One of them anew, without a word about what [`Scripts::each`] has said of it.
    ///
    /// # Errors
    /// If it can't be read any more, or is wrong by now.
    pub fn again(&self, path: &Path) -> Result<Loaded, Failure> {
        read(path, &self.definitions)
    }

    /// Where they are.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.paths.len()
    }
}

/// Any number of scripts, also none.
#[derive(Args, Debug)]
pub struct AnyScripts {
    /// The scripts of the scenes
    #[arg(value_name = "SCENE")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    definitions: Definitions,
}

impl AnyScripts {
    /// As [`Scripts::each`].
    ///
    /// # Errors
    /// As [`Scripts::each`].
    pub fn each(
        &self,
        work: impl FnMut(&Path, Loaded) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        each(&self.paths, &self.definitions, work)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.paths.is_empty()
    }
}

fn each(
    paths: &[PathBuf],
    definitions: &Definitions,
    mut work: impl FnMut(&Path, Loaded) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut worst: Option<Failure> = None;
    for path in paths {
        let done = load(path, definitions).and_then(|loaded| work(path, loaded));
        let Err(failure) = done else { continue };
        if matches!(failure, Failure::Closed) {
            return Err(failure);
        }
        let message = failure.to_string();
        if !message.is_empty() {
            say_error(&message);
        }
        let silent = match failure {
            Failure::Script => Failure::Script,
            _ => Failure::Other(String::new()),
        };
        if worst.as_ref().is_none_or(|w| w.code() < silent.code()) {
            worst = Some(silent);
        }
    }
    worst.map_or(Ok(()), Err)
}

fn load(path: &Path, definitions: &Definitions) -> Result<Loaded, Failure> {
    let loaded = read(path, definitions)?;
    say(&loaded.warnings.render(speaks_color()));
    Ok(loaded)
}

fn read(path: &Path, definitions: &Definitions) -> Result<Loaded, Failure> {
    let loaded = lang::load(path, &definitions.definitions, &SceneTracer::default());
    match loaded {
        Ok(loaded) => Ok(loaded),
        Err(LoadError::Io { path, error }) => {
            Err(Failure::reading(&format!("`{}`", path.display()), &error))
        }
        Err(LoadError::Script(report)) => {
            say(&report.render(speaks_color()));
            Err(Failure::Script)
        }
    }
}

/// The world of everything that the scene shows.
///
/// # Errors
/// If a shape can't be traced; every one of them has been said.
pub fn compile(scene: &Scene) -> Result<World, Failure> {
    World::new(scene).map_err(|fault| {
        for line in faults(&scene.shown, &scene.settings, &fault) {
            say_error(&line);
        }
        Failure::Script
    })
}

/// What is wrong with each of these shapes, with its place in the script; `fault` is what is wrong with them together.
fn faults(shown: &[Arc<Node>], settings: &Settings, fault: &Fault) -> Vec<String> {
    let alone = |node: &Arc<Node>| {
        let fault = World::of(std::slice::from_ref(node), settings).err()?;
        Some(described(&fault, Some(node)))
    };
    let mut lines: Vec<String> = shown.iter().filter_map(alone).collect();
    lines.dedup();
    if lines.is_empty() {
        lines.push(described(fault, None));
    }
    lines
}

/// The fault in the form of the reports on scripts.
pub fn described(fault: &Fault, node: Option<&Arc<Node>>) -> String {
    let mut text = fault.message.clone();
    if let Some(place) = node.and_then(|node| node.place()) {
        text.push_str(&format!("\n  --> {}:{}", place.file, place.line));
    }
    if !fault.hint.is_empty() {
        text.push_str(&format!("\n   = help: {}", fault.hint));
    }
    text.push('\n');
    text
}

/// The shapes that a question is about: the one called `name`, or everything that is shown.
///
/// # Errors
/// If there is no shape of that name, or nothing is shown.
pub fn chosen(loaded: &Loaded, name: Option<&str>) -> Result<Vec<Arc<Node>>, Failure> {
    let Some(name) = name else {
        if loaded.scene.shown.is_empty() {
            let message = "the scene shows nothing; name one of its shapes with --shape";
            return Err(Failure::Other(message.into()));
        }
        return Ok(loaded.scene.shown.clone());
    };
    match loaded.names.get(name) {
        Some(node) => Ok(vec![node.clone()]),
        None => Err(Failure::Usage(unknown_shape(
            name,
            loaded.names.keys().map(String::as_str),
        ))),
    }
}

/// The message that there is no shape `name` among these.
fn unknown_shape<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    let problem = format!("there is no shape `{name}` in the script");
    if let Some(near) = nearest(name, &known) {
        return format!("{problem}; did you mean `{near}`?");
    }
    match &known[..] {
        [] => format!("{problem}: it names none with `let` or `field`"),
        _ => format!("{problem}; it has {}", listed(&known)),
    }
}

/// The name that was probably meant: at most a third of it is mistyped.
fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let limit = (name.chars().count() / 3).max(1);
    known
        .iter()
        .map(|word| (strsim::osa_distance(name, word), *word))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, word)| word)
}

/// The first few of these names.
fn listed(names: &[&str]) -> String {
    const FEW: usize = 8;
    let first: Vec<String> = names.iter().take(FEW).map(|n| format!("`{n}`")).collect();
    let more = names.len().saturating_sub(FEW);
    let rest = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    first.join(", ") + &rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_shapes_are_hinted_at() {
        let message = |name: &str, known: &[&str]| unknown_shape(name, known.iter().copied());
        assert_eq!(
            message("balll", &["ball", "floor"]),
            "there is no shape `balll` in the script; did you mean `ball`?"
        );
        assert_eq!(
            message("x", &["ball", "floor"]),
            "there is no shape `x` in the script; it has `ball`, `floor`"
        );
        assert!(message("x", &[]).ends_with("names none with `let` or `field`"));
        let many: Vec<String> = (100..120).map(|i| format!("part{i}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert!(message("zz", &many).ends_with("`part107` and 12 more"));
    }

    #[test]
    fn every_shape_that_cannot_be_traced_is_named() {
        use crate::catalogue::{AnyModifier, AnyPrimitive, Plane, Twist};
        let plane = Node::primitive(AnyPrimitive::Plane(Plane::new([0.0, 1.0, 0.0], 0.0))).unwrap();
        let twisted = Node::modifier(AnyModifier::Twist(Twist::new(1.0)), plane.clone()).unwrap();
        let place = |line| {
            Some(crate::scene::Place {
                file: "a.sdf".into(),
                line,
                mark: Default::default(),
            })
        };
        let shown = [
            twisted.labelled(Some("sheet".into()), place(3)),
            plane,
            twisted.labelled(None, place(7)),
        ];
        let lines = faults(&shown, &Settings::default(), &Fault::new("all", ""));
        assert_eq!(lines.len(), 2);
        assert!(lines[0].starts_with("`sheet` has no finite Lipschitz constant"));
        assert!(lines[0].contains("\n  --> a.sdf:3\n   = help: "));
        assert!(lines[1].contains("\n  --> a.sdf:7\n"));
        let unknown = faults(&[], &Settings::default(), &Fault::new("all", ""));
        assert_eq!(unknown, ["all\n"]);
    }
}
