//! Where methods fail: the matrix of `fieldstone limits` is as recorded, and the default method is nowhere wrong.
//!
//! `FIELDSTONE_BLESS=1 cargo test --release --test limits` records it anew; look at each difference before it is committed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// How many ways to fail the catalogue of failures has.
const KNOWN: u32 = 68;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn limits(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
    command.arg("limits").args(arguments).current_dir(root());
    command.output().expect("the command runs")
}

fn scripts() -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join("tests/limits")).expect("the folder of limits");
    let scripts = entries.flatten().map(|entry| entry.path());
    scripts
        .filter(|path| path.extension().is_some_and(|e| e == "sdf"))
        .collect()
}

/// The lines that differ, with their numbers.
fn differences(expected: &str, actual: &str) -> String {
    let lines = expected.lines().count().max(actual.lines().count());
    let line = |text: &str, i: usize| text.lines().nth(i).unwrap_or("").to_string();
    (0..lines)
        .map(|i| (i, line(expected, i), line(actual, i)))
        .filter(|(_, expected, actual)| expected != actual)
        .map(|(i, expected, actual)| format!("{}: - {expected}\n{}: + {actual}\n", i + 1, i + 1))
        .collect()
}

#[test]
fn the_matrix_is_as_recorded_and_the_default_is_nowhere_wrong() {
    let recorded = root().join("tests/limits.md");
    let answer = limits(&[]);
    let errors = String::from_utf8_lossy(&answer.stderr);
    // The exit code says whether the default is silently wrong.
    assert_eq!(answer.status.code(), Some(0), "{errors}");
    let actual = String::from_utf8(answer.stdout).expect("text");
    if std::env::var_os("FIELDSTONE_BLESS").is_some() {
        fs::write(&recorded, &actual).expect("the folder is writable");
        return;
    }
    let expected = fs::read_to_string(&recorded).expect("the recorded matrix");
    assert!(
        expected == actual,
        "the matrix has changed:\n{}",
        differences(&expected, &actual)
    );
}

#[test]
fn tests_of_limits_pass_by_default() {
    let is_traced = |path: &PathBuf| {
        let text = fs::read_to_string(path).expect("a script");
        let second = text.lines().nth(1).unwrap_or("");
        !second.starts_with("// refused: ") && !second.starts_with("// see: ")
    };
    let traced: Vec<PathBuf> = scripts().into_iter().filter(is_traced).collect();
    assert!(traced.len() >= 58, "only {} scripts", traced.len());
    let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
    let answer = command
        .arg("test")
        .args(&traced)
        .output()
        .expect("the command runs");
    let said = String::from_utf8_lossy(&answer.stdout);
    assert_eq!(answer.status.code(), Some(0), "{said}");
}

#[test]
fn sphere_tracing_fails_where_theory_says() {
    // A suite in which it never fails tests nothing.
    let answer = limits(&["--method", "sphere"]);
    let text = String::from_utf8(answer.stdout).expect("text");
    let cell = |number: u32| {
        let row = text
            .lines()
            .find(|line| line.starts_with(&format!("| {number} |")));
        let row = row.unwrap_or_else(|| panic!("no row {number} in {text}"));
        row.split('|').nth(3).unwrap_or("").trim().to_string()
    };
    // Near misses and gaps below epsilon are hits; so is a face that was cut away.
    for number in [2, 8, 31] {
        assert_eq!(cell(number), "**hit!**", "{number}");
    }
    // Grazing rays end early or run out of steps, and so does a corridor.
    for number in [1, 4] {
        assert!(
            !cell(number).starts_with("ok"),
            "{number}: {}",
            cell(number)
        );
    }
}

#[test]
fn every_known_way_to_fail_has_a_script() {
    let mut numbers = BTreeSet::new();
    for path in scripts() {
        let text = fs::read_to_string(&path).expect("a script");
        let first = text.lines().next().unwrap_or("");
        let number = first
            .strip_prefix("// ")
            .and_then(|rest| rest.split_once(". "));
        let number: u32 = number.and_then(|(n, _)| n.parse().ok()).unwrap_or_else(|| {
            panic!("{} begins with {first}", path.display());
        });
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        assert!(
            name.starts_with(&format!("{number:02}_")),
            "{name}: {number}"
        );
        assert!(
            first.ends_with('.') && first.chars().count() <= 150,
            "{name}: {first}"
        );
        numbers.insert(number);
    }
    let missing: Vec<u32> = (1..=KNOWN).filter(|n| !numbers.contains(n)).collect();
    assert!(missing.is_empty(), "no script for {missing:?}");
}

#[test]
fn tests_that_limits_refer_to_exist() {
    let mut named = 0;
    for path in scripts() {
        let text = fs::read_to_string(&path).expect("a script");
        let Some(see) = text.lines().find_map(|line| line.strip_prefix("// see: ")) else {
            continue;
        };
        for place in see.split("; ") {
            let (file, tests) = place.split_once(": ").expect("`file: test, test`");
            let code = fs::read_to_string(root().join(file)).expect("the file of the test");
            for test in tests.split(", ") {
                assert!(
                    code.contains(&format!("fn {test}(")),
                    "{file} has no {test}"
                );
                named += 1;
            }
        }
    }
    assert!(named >= 10, "only {named} tests are named");
}

#[test]
fn wrong_folders_and_scripts_are_told() {
    let answer = limits(&["no/such/folder"]);
    assert_eq!(answer.status.code(), Some(1));
    let folder = std::env::temp_dir().join(format!("fieldstone-limits-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let run = |text: &str| {
        fs::write(folder.join("a.sdf"), text).expect("a script");
        let answer = limits(&[&folder.display().to_string()]);
        let said = String::from_utf8_lossy(&answer.stderr).into_owned();
        (answer.status.code(), said)
    };
    let (code, said) = run("show sphere(1)\n");
    assert!(code == Some(1) && said.contains("must begin"), "{said}");
    let (code, said) = run("// 1. Ball: round.\nshow sphere(1)\n");
    assert!(code == Some(1) && said.contains("`test` block"), "{said}");
    let (code, said) = run(
        "// 1. Ball: round.\nshow sphere(1)\ntest \"a\" { expect trace([3, 0, 0], [-1, 0, 0]).hits(1) }\n",
    );
    assert!(
        code == Some(1) && said.contains("wrong at 1 (Ball)"),
        "{said}"
    );
    fs::remove_dir_all(&folder).expect("the folder goes away");
}
