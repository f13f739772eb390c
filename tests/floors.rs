//! The house: a file imports its own floor and floors below it, never above, never a stranger on the same floor.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules by floor, from the ground up; `lang` and `field` are strangers on one floor.
const FLOORS: [(&str, u8); 10] = [
    ("num", 0),
    ("catalogue", 1),
    ("scene", 2),
    ("lang", 3),
    ("field", 3),
    ("trace", 4),
    ("shade", 5),
    ("render", 6),
    ("output", 7),
    ("cli", 8),
];

fn floor(module: &str) -> Option<u8> {
    FLOORS
        .iter()
        .find(|(name, _)| *name == module)
        .map(|(_, floor)| *floor)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("src is readable").flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// What a file imports that its floor forbids.
fn trespasses(module: &str, text: &str) -> Vec<String> {
    let own = floor(module).expect("every folder of src is a floor");
    let names = text.split("crate::").skip(1).map(|rest| {
        rest.split(|c: char| !c.is_alphanumeric() && c != '_')
            .next()
            .unwrap_or("")
            .to_string()
    });
    names
        .filter(|name| name != module)
        .filter(|name| floor(name).is_some_and(|other| other >= own))
        .collect()
}

#[test]
fn files_import_only_what_lies_below() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    assert!(files.len() > 60, "only {} files found", files.len());
    let mut wrong = Vec::new();
    for file in &files {
        let inner = file.strip_prefix(&src).expect("found below src");
        let Some(module) = inner
            .parent()
            .and_then(|p| p.iter().next())
            .and_then(|m| m.to_str())
        else {
            continue; // lib.rs and main.rs stand outside of the floors
        };
        let text = fs::read_to_string(file).expect("a source file");
        for name in trespasses(module, &text) {
            wrong.push(format!("src/{} imports {name}", inner.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_trespass_is_seen() {
    assert_eq!(
        trespasses("scene", "use crate::trace::Ray; use crate::num::Vec3;"),
        ["trace"]
    );
    assert_eq!(trespasses("lang", "crate::field::compile(node)"), ["field"]);
    assert!(trespasses("shade", "use crate::shade::fog; use crate::trace::Ray;").is_empty());
}

#[test]
fn unsafe_code_stays_in_one_file() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let with_unsafe: Vec<_> = files
        .iter()
        .filter(|f| fs::read_to_string(f).is_ok_and(|text| text.contains("allow(unsafe_code)")))
        .map(|f| f.strip_prefix(&src).expect("found below src").to_path_buf())
        .collect();
    assert_eq!(with_unsafe, [Path::new("field/compile.rs")]);
}
