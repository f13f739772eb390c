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

/// The functions over numbers in a source file that are not `#[inline(always)]`.
fn not_inlined(text: &str, is_over_numbers: impl Fn(&str) -> bool) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or("");
    let lines: Vec<&str> = code.lines().map(str::trim).collect();
    let is_function = |l: &str| {
        ["fn ", "pub fn ", "pub(super) fn ", "pub(crate) fn "]
            .iter()
            .any(|start| l.starts_with(start))
    };
    (0..lines.len())
        .filter(|i| is_function(lines[*i]) && !lines[*i].ends_with(';'))
        .filter(|i| {
            let signature: String = lines[*i..]
                .iter()
                .take(8)
                .take_while(|l| **l != "}")
                .copied()
                .collect();
            is_over_numbers(signature.split('{').next().unwrap_or(""))
        })
        .filter(|i| {
            let attributes = lines[..*i]
                .iter()
                .rev()
                .take_while(|l| l.starts_with("#[") || l.starts_with("//"));
            !attributes
                .clone()
                .any(|l| l.contains("inline(always)") || l.contains("cold"))
        })
        .map(|i| lines[i].to_string())
        .collect()
}

/// An operation without `#[inline(always)]` is compiled for the baseline and called from wide closures: twice as slow,
/// without a word (measured: 2.2 times).
#[test]
fn every_operation_on_numbers_is_inlined() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    for folder in ["num", "catalogue"] {
        sources(&src.join(folder), &mut files);
    }
    let mut wrong = Vec::new();
    for file in files.iter().filter(|f| !f.ends_with("samples.rs")) {
        let text = fs::read_to_string(file).expect("a source file");
        for function in not_inlined(&text, |signature| signature.contains("N: Number")) {
            wrong.push(format!(
                "{}: {function}",
                file.strip_prefix(&src).unwrap_or(file).display()
            ));
        }
    }
    assert!(
        wrong.is_empty(),
        "without #[inline(always)]:\n{}",
        wrong.join("\n")
    );
    let lanes = fs::read_to_string(src.join("num/lanes.rs")).expect("the lanes");
    let wrong = not_inlined(&lanes, |signature| {
        signature.contains("self") || signature.contains("Self")
    });
    assert!(
        wrong.is_empty(),
        "without #[inline(always)]:\n{}",
        wrong.join("\n")
    );
}

/// Lines on which `array::map` or `array::from_fn` computes with numbers. Constants that are made ready to be kept may be made there.
fn closures_in_arrays(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or("");
    code.lines()
        .map(str::trim)
        .filter(|l| l.contains(".map(|") || l.contains(".map(N::") || l.contains("from_fn("))
        .filter(|l| !l.contains("map(N::constant)"))
        .filter(|l| l.contains("N::") || l.contains("Vec3::") || l.contains("(p."))
        .map(str::to_string)
        .collect()
}

/// What stands inside of `array::map` is compiled for the baseline, as the library's own loop around it is (measured: a
/// sixth of the instructions of a smooth union).
#[test]
fn no_operation_on_numbers_hides_in_an_array() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    for folder in ["num", "catalogue"] {
        sources(&src.join(folder), &mut files);
    }
    for file in files.iter().filter(|f| !f.ends_with("samples.rs")) {
        let text = fs::read_to_string(file).expect("a source file");
        assert_eq!(closures_in_arrays(&text), [""; 0], "{}", file.display());
    }
    assert_eq!(
        closures_in_arrays("let [w, h] = size.map(|s| N::splat(s));").len(),
        1
    );
    assert_eq!(
        closures_in_arrays("let [w, h] = size.map(N::splat);").len(),
        1
    );
}

#[test]
fn a_missing_inline_is_seen() {
    let text = "#[inline(always)]\nfn a<N: Number>(x: N) -> N {\n}\n/// Doc.\nfn b<N: Number>(\n    x: N,\n) -> N {\n}\n";
    assert_eq!(
        not_inlined(text, |s| s.contains("N: Number")),
        ["fn b<N: Number>("]
    );
}
