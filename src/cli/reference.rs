//! `fieldstone reference`: every word that scripts know, from its declaration.

use super::console::answer;
use super::failure::Failure;
use super::outline::short;
use crate::catalogue::{Class, Kind, Parameter};
use crate::lang::{Group, Word, load_text};
use crate::scene::{Node, Shape};
use crate::trace::SceneTracer;
use clap::Args;
use serde_json::{Value, json};
use std::sync::Arc;

/// How wide a line for people is at most.
const WIDTH: usize = 100;

const AFTER_HELP: &str = "\
Without a name, all words with a line on each. With one, all that is known of it: how it is called, its parameters \
with what values they take, its class and Lipschitz constant and where they come from, and a line of script that \
shows it. --markdown prints the page docs/reference.md, or the section of one word.

Examples:
  fieldstone reference
  fieldstone reference torus
  fieldstone reference smooth --json | jq '.[0].parameters'";

/// Print what there is to know of the words of scripts: shapes, modifiers, blends, functions
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    /// A word of scripts
    name: Option<String>,
    /// Answer as a page in Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// Prints the overview, the page, or all that is known of a word.
///
/// # Errors
/// If there is no such word.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut words = Word::all();
    if let Some(name) = &arguments.name {
        words.retain(|word| word.name == name);
        if words.is_empty() {
            return Err(Failure::Usage(unknown(name)));
        }
    }
    if arguments.markdown {
        let sections = || words.iter().map(section).collect();
        return answer(
            &arguments
                .name
                .as_ref()
                .map_or_else(|| page(&words), |_| sections()),
        );
    }
    if arguments.json {
        let all: Vec<Value> = words.iter().map(to_json).collect();
        return answer(&format!("{:#}\n", Value::from(all)));
    }
    if arguments.name.is_none() {
        return answer(&overview(&words));
    }
    let texts: Vec<String> = words.iter().map(in_words).collect();
    answer(&texts.join("\n"))
}

fn unknown(name: &str) -> String {
    let help = match Word::nearest(name) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => "`fieldstone reference` lists all words".into(),
    };
    format!("scripts know no word `{name}`\n  = help: {help}")
}

/// The words of each group that has any, with its title.
fn grouped(words: &[Word]) -> Vec<(Group, &'static str, Vec<&Word>)> {
    let groups = Group::ALL.into_iter().map(|(group, title)| {
        let members = words.iter().filter(|word| word.group == group);
        (group, title, members.collect::<Vec<_>>())
    });
    groups.filter(|(.., members)| !members.is_empty()).collect()
}

/// What is known of a word beyond what it says of itself.
struct Certificate {
    class: Class,
    lipschitz: f64,
    rule: &'static str,
    /// Whether all of it is only so in the example.
    is_of_example: bool,
}

/// The certificate of a leaf with its defaults, or else of what the example makes with the word; functions have none.
fn certificate(word: &Word) -> Option<Certificate> {
    let certificate = |node: &Node, is_of_example| Certificate {
        class: node.class(),
        lipschitz: node.lipschitz(),
        rule: node.rule(),
        is_of_example,
    };
    if let Some(shape) = &word.shape {
        return Some(certificate(shape, false));
    }
    let scene = word.scene()?;
    let loaded = load_text(word.name, &scene, &[], &SceneTracer::default()).ok()?;
    let entry = loaded.names.get("entry")?;
    made_with(entry, word.name).map(|node| certificate(node, true))
}

/// The first node on the way down that the word `name` makes or joins.
fn made_with<'a>(node: &'a Arc<Node>, name: &str) -> Option<&'a Arc<Node>> {
    let is_joined = matches!(node.shape(), Shape::Combination(c, _) if c.blend.name() == name);
    if node.kind() == name || is_joined {
        return Some(node);
    }
    node.children()
        .iter()
        .find_map(|child| made_with(child, name))
}

/// What values a parameter takes.
fn values_in_words(parameter: &Parameter) -> String {
    let noun = parameter.kind.noun();
    match parameter.kind {
        Kind::Axis => noun.into(),
        Kind::Direction => format!("{noun}, not zero"),
        _ => format!("{noun}, {}", parameter.range_words()),
    }
}

/// Which value it has when it is left out, in `quotes`.
fn default_in_words(parameter: &Parameter, quotes: &str) -> String {
    match parameter.default_in_words() {
        Some(default) => format!("default {quotes}{default}{quotes}"),
        None => "must be given".into(),
    }
}

/// All words, group by group, with the first sentence of each.
fn overview(words: &[Word]) -> String {
    let width = words.iter().map(|word| word.name.len()).max().unwrap_or(0);
    let groups = grouped(words).into_iter().map(|(_, title, members)| {
        let lines = members.iter().map(|word| {
            let head = format!("  {:width$}  ", word.name);
            wrapped(&head, first_sentence(&word.summary))
        });
        format!("{}\n{}", title.to_lowercase(), lines.collect::<String>())
    });
    groups.collect::<Vec<_>>().join("\n")
}

/// The text up to its first full stop.
fn first_sentence(text: &str) -> &str {
    text.split_inclusive(". ").next().unwrap_or(text).trim_end()
}

/// Lines of at most [`WIDTH`] columns: `head` and the words of the text, those below indented like the first.
fn wrapped(head: &str, text: &str) -> String {
    let indent = head.chars().count();
    let mut lines = String::from(head);
    let mut column = indent;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > indent {
            if column + 1 + length > WIDTH {
                lines.push_str(&format!("\n{:indent$}", ""));
                column = indent;
            } else {
                lines.push(' ');
                column += 1;
            }
        }
        lines.push_str(word);
        column += length;
    }
    lines + "\n"
}

/// All that is known of a word, for people.
fn in_words(word: &Word) -> String {
    let mut text = format!("{}\n\n{}", word.signature, wrapped("", &word.summary));
    let width = word
        .parameters
        .iter()
        .map(|p| p.name.len())
        .max()
        .unwrap_or(0);
    for (i, parameter) in word.parameters.iter().enumerate() {
        let values = values_in_words(parameter);
        let default = default_in_words(parameter, "");
        let head = format!("  {:width$}  ", parameter.name);
        text.push_str(if i == 0 { "\n" } else { "" });
        text.push_str(&wrapped(&head, &format!("{values}; {default}")));
        let head = " ".repeat(width + 4);
        text.push_str(&wrapped(&head, parameter.summary));
    }
    let facts = facts(word);
    if !facts.is_empty() {
        text.push('\n');
    }
    for (name, fact) in facts {
        text.push_str(&wrapped(&format!("{name:9}  "), &fact));
    }
    text
}

/// What is known of a word besides its parameters, each with what it is.
fn facts(word: &Word) -> Vec<(&'static str, String)> {
    let mut facts = Vec::new();
    if let Some(known) = certificate(word) {
        let note = if known.is_of_example {
            " (in the example)"
        } else {
            ""
        };
        let (class, meaning) = (known.class.word(), known.class.meaning());
        facts.push(("class", format!("{class}{note}: {meaning}")));
        facts.push(("lipschitz", format!("{}{note}", short(known.lipschitz))));
        if known.rule != word.source {
            facts.push(("rule", known.rule.into()));
        }
    }
    facts.push(("source", word.source.into()));
    facts.push(("example", word.example.into()));
    facts.retain(|(_, fact)| !fact.is_empty());
    facts
}

/// All that is known of a word, for programs.
fn to_json(word: &Word) -> Value {
    let parameters = word.parameters.iter().map(|parameter| {
        json!({
            "name": parameter.name,
            "summary": parameter.summary.trim(),
            "kind": parameter.kind.noun(),
            "range": parameter.range_words(),
            "default": parameter.default_in_words(),
        })
    });
    let title = Group::ALL.iter().find(|(group, _)| *group == word.group);
    let known = certificate(word);
    let text = |text: &'static str| (!text.is_empty()).then_some(text);
    json!({
        "name": word.name,
        "group": title.map(|(_, title)| title.to_lowercase()),
        "signature": word.signature,
        "summary": word.summary,
        "parameters": parameters.collect::<Vec<_>>(),
        "class": known.as_ref().map(|known| known.class.word()),
        "lipschitz": known.as_ref().map(|known| known.lipschitz),
        "rule": known.as_ref().map(|known| known.rule),
        "source": text(word.source),
        "example": text(word.example),
    })
}

const PAGE_HEAD: &str = "\
# Reference

Every word of [the language](language.md) that makes, joins or changes a shape, and every function, from the declarations in \
`src/catalogue`. `fieldstone reference NAME` says the same of one word. All lengths are in scene units; everything is \
centred at the origin unless it says otherwise.

The class says what the value of a field means: *exact*, it is the distance to the surface; *bound*, at most the distance; \
*lipschitz*, at most the distance times the Lipschitz constant. Class and constant of solids and profiles are those of their \
defaults; of what joins or changes shapes, those of the example, by the rule.
";

/// The page: each group with its pictured entries, and a table of the others.
fn page(words: &[Word]) -> String {
    let mut text = String::from(PAGE_HEAD);
    let groups = grouped(words);
    for (_, title, members) in &groups {
        let is_pictured = |word: &&&Word| !word.example.is_empty();
        let links: Vec<String> = members
            .iter()
            .filter(is_pictured)
            .map(|w| link(w))
            .collect();
        let (pictured, others): (Vec<&Word>, Vec<&Word>) =
            members.iter().partition(|word| !word.example.is_empty());
        text.push_str(&format!("\n## {title}\n\n"));
        if !others.is_empty() {
            text.push_str(&format!("{}\n", table(&others)));
        }
        text.push_str(&format!("{}\n", links.join(" · ")));
        text.extend(pictured.iter().map(|word| section(word)));
    }
    text
}

/// The word, leading to its section.
fn link(word: &Word) -> String {
    format!("[{0}](#{0})", word.name)
}

/// The text without what Markdown takes for more than text.
fn escaped(text: &str) -> String {
    let text = text.trim().replace('|', "\\|").replace('*', "\\*");
    text.replace('<', "&lt;")
}

/// Functions with what they give.
fn table(words: &[&Word]) -> String {
    let mut text = String::from("| function | gives |\n|---|---|\n");
    for word in words {
        let gives = escaped(&word.summary);
        text.push_str(&format!("| `{}` | {gives} |\n", word.signature));
    }
    text
}

/// An entry with its picture, if it has one.
fn section(word: &Word) -> String {
    let (name, summary) = (word.name, escaped(&word.summary));
    let mut text = format!("\n### {name}\n\n");
    if !word.example.is_empty() {
        text.push_str(&format!(
            "<img src=\"reference/{name}.png\" alt=\"{name}\" width=\"160\" height=\"120\" align=\"right\">\n\n"
        ));
    }
    text.push_str(&format!("{summary}\n\n    {}\n\n", word.signature));
    for parameter in word.parameters {
        let values = escaped(&values_in_words(parameter));
        let default = default_in_words(parameter, "`");
        let summary = escaped(parameter.summary);
        text.push_str(&format!(
            "- `{}`: {values}; {default}. {summary}\n",
            parameter.name
        ));
    }
    for (name, fact) in facts(word) {
        let fact = match name {
            "example" => format!("`{fact}`"),
            // The head of the page has the meanings.
            "class" => fact.split(':').next().unwrap_or_default().into(),
            _ => escaped(&fact),
        };
        text.push_str(&format!("- *{name}*: {fact}\n"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn word(name: &str) -> Word {
        let mut all = Word::all();
        all.retain(|word| word.name == name);
        all.swap_remove(0)
    }

    #[test]
    fn lines_are_wrapped_under_their_head() {
        let text = "word ".repeat(40);
        let lines = wrapped("  name  ", &text);
        assert!(lines.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(
            lines
                .lines()
                .skip(1)
                .all(|line| line.starts_with("        word"))
        );
        assert_eq!(lines.matches("word").count(), 40);
    }

    #[test]
    fn an_entry_in_words() {
        let expected = "\
torus(major: 0.75, minor: 0.25)

A ring around the y axis.

  major  a number, positive; default 0.75
         The radius of the circle in the middle of the tube, in scene units.
  minor  a number, positive; default 0.25
         The radius of the tube, in scene units.

class      exact: the field is the distance
lipschitz  1
source     Quilez, distance functions (torus); a distance, so its constant is 1
example    torus(0.75, 0.25)
";
        assert_eq!(in_words(&word("torus")), expected);
    }

    #[test]
    fn certificates_of_modifiers_and_blends_are_those_of_their_examples() {
        for (name, class) in [
            ("translate", Class::Exact),
            ("smooth", Class::Bound),
            ("union", Class::Bound),
        ] {
            let known = certificate(&word(name)).expect("it makes a shape");
            assert_eq!((known.class, known.lipschitz), (class, 1.0), "{name}");
            assert!(known.is_of_example);
        }
        assert!(certificate(&word("mix")).is_none());
    }
}
