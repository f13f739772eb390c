//! The list of shapes in the documentation is what the declarations say.

use fieldstone::catalogue::{AnyBlend, AnyModifier, AnyPrimitive, Declaration};
use std::path::Path;

/// One entry: what it is, how to write it, its parameters.
fn entry(declaration: &Declaration) -> String {
    let mut text = format!(
        "### {}\n\n{}\n\n    {}\n\n",
        declaration.name,
        declaration.summary.trim(),
        declaration.example
    );
    for parameter in declaration.parameters {
        let default = match parameter.default {
            Some(default) => format!("default `{}`", default()),
            None => "must be given".into(),
        };
        let (name, kind, range) = (
            parameter.name,
            parameter.kind.noun(),
            parameter.range_words(),
        );
        text += &format!(
            "- `{name}`: {kind}, {range}; {default}. {}\n",
            parameter.summary.trim()
        );
    }
    text + &format!("\nSource and Lipschitz rule: {}.\n\n", declaration.source)
}

fn page() -> String {
    let mut text = String::from(
        "# The list of shapes\n\nMade from the declarations in `src/catalogue`; see also [the language](language.md).\n\n",
    );
    let groups = [
        ("Primitives", AnyPrimitive::DECLARATIONS),
        ("Modifiers", AnyModifier::DECLARATIONS),
        ("Blends", AnyBlend::DECLARATIONS),
    ];
    for (name, declarations) in groups {
        text += &format!("## {name}\n\n");
        text.extend(declarations.iter().map(|d| entry(d)));
    }
    text.trim_end().to_string() + "\n"
}

/// `FIELDSTONE_BLESS=1 cargo test --test shapes` writes the page anew.
#[test]
fn the_page_is_what_the_declarations_say() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/shapes.md");
    if std::env::var_os("FIELDSTONE_BLESS").is_some() {
        std::fs::write(&path, page()).expect("docs is writable");
    }
    assert_eq!(
        std::fs::read_to_string(&path).expect("docs/shapes.md"),
        page()
    );
}
