//! Writes `docs/speed-and-accuracy.md` and its charts in `docs/charts`:
//!
//! `cargo build --release && cargo run --release --example speed_and_accuracy`
//!
//! The words are those of `template.md`; every chart and every figure is made by the command `fieldstone chart` here and now.

mod choice;
mod figures;

use fieldstone::output::write;
use figures::Figures;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Where the charts are.
const FOLDER: &str = "docs/charts";

/// The scenes: closed forms, hard solids, a smooth blend of 24, a gyroid, 1000 primitives, a warp.
const SCENES: [&str; 6] = [
    "examples/three_spheres.sdf",
    "benches/scenes/s4.sdf",
    "benches/scenes/s2.sdf",
    "benches/scenes/s3.sdf",
    "benches/scenes/s5a.sdf",
    "benches/scenes/s6.sdf",
];

/// How large the pictures are, and how often everything is timed.
const PICTURES: [&str; 4] = ["--size", "160x90", "--rounds", "4"];

/// What the document shows of the chart, and what it is called there: the picture of one kind also as pixels, for the README.
const SHOWN: [[&str; 2]; 5] = [
    ["depth-evaluations.svg", "depth-evaluations.svg"],
    ["depth-evaluations.png", "overview.png"],
    ["depth-milliseconds.svg", "depth-milliseconds.svg"],
    ["wrong-milliseconds.svg", "wrong-milliseconds.svg"],
    ["chart.csv", "chart.csv"],
];

/// The chart of the other errors, with its options.
const OTHER_ERRORS: [&str; 12] = [
    "examples/three_spheres.sdf",
    "benches/scenes/s2.sdf",
    "--errors",
    "depth-max,normals,image",
    "--work",
    "evaluations",
    "--methods",
    "auto,sphere,relaxed,enhanced,segment,bisect",
    "--size",
    "96x54",
    "--rounds",
    "1",
];

/// The further charts, with their options.
const STUDIES: [(&str, &[&str]); 7] = [
    (
        "grazing",
        &[
            "--methods",
            "auto,sphere,relaxed,auto-relaxed,enhanced,bisect",
        ],
    ),
    (
        "primitives",
        &["--methods", "auto,certified", "--rounds", "2"],
    ),
    (
        "constants",
        &[
            "benches/scenes/s2.sdf",
            "benches/scenes/s3.sdf",
            "--methods",
            "auto,certified,sphere,relaxed,auto-relaxed",
            "--size",
            "96x54",
            "--rounds",
            "2",
        ],
    ),
    ("distance", &["--methods", "auto,sphere"]),
    (
        "precision",
        &[
            "benches/scenes/s2.sdf",
            "benches/scenes/s3.sdf",
            "--size",
            "96x54",
        ],
    ),
    ("gradients", &[]),
    (
        "samples",
        &[
            "examples/three_spheres.sdf",
            "benches/scenes/s2.sdf",
            "--size",
            "96x54",
        ],
    ),
];

/// The command, which is beside the folder of examples.
fn command() -> Outcome<PathBuf> {
    let name = format!("fieldstone{}", std::env::consts::EXE_SUFFIX);
    let example = std::env::current_exe()?;
    let folder = example
        .parent()
        .and_then(Path::parent)
        .ok_or("the example lies in a folder")?;
    let path = folder.join(name);
    if path.is_file() {
        Ok(path)
    } else {
        Err("build the command first: cargo build --release".into())
    }
}

/// The table that `fieldstone chart` prints, with these arguments.
fn chart(folder: &Path, arguments: &[&str]) -> Outcome<String> {
    eprintln!("fieldstone chart {}", arguments.join(" "));
    let output = Command::new(command()?)
        .arg("chart")
        .args(arguments)
        .arg("-q")
        .arg("-o")
        .arg(folder)
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// The rows of the tables that are at the tolerance of the default, with the titles and sentences between them.
fn at_default(tables: &str) -> String {
    let cell = |line: &str, i: usize| line.split('|').nth(i).unwrap_or("").trim().to_string();
    let default = tables.lines().find(|line| line.starts_with("| **"));
    let tolerance = cell(default.unwrap_or(""), 2);
    let is_kept = |line: &&str| {
        let is_row = line.starts_with("| ") && !line.starts_with("| method");
        !is_row || line.starts_with("| ---") || cell(line, 2) == tolerance
    };
    let kept: Vec<&str> = tables.trim_end().lines().filter(is_kept).collect();
    kept.join("\n")
}

fn main() -> Outcome<()> {
    let start = std::time::Instant::now();
    let folder = Path::new(FOLDER);
    let scratch = std::env::temp_dir().join(format!("fieldstone-charts-{}", std::process::id()));
    for folder in [folder, &scratch] {
        fs::create_dir_all(folder)?;
    }
    let mut text = include_str!("template.md").to_string();
    let tables = chart(&scratch, &[&SCENES[..], &PICTURES].concat())?;
    let on_front = |word: &str| {
        let sentence = format!("is on the Pareto front of {word}:");
        format!("{} of {}", tables.matches(&sentence).count(), SCENES.len())
    };
    // Whatever was shown before goes.
    fs::remove_dir_all(folder)?;
    fs::create_dir_all(folder)?;
    for [made, shown] in SHOWN {
        fs::copy(scratch.join(made), folder.join(shown))?;
    }
    let mut places = vec![
        (
            "choice".to_string(),
            choice::table(&folder.join("chart.csv"))?,
        ),
        ("tables".to_string(), at_default(&tables)),
        ("front of evaluations".to_string(), on_front("evaluations")),
        ("front of time".to_string(), on_front("time")),
    ];
    chart(&scratch, &OTHER_ERRORS)?;
    fs::copy(scratch.join("chart.svg"), folder.join("errors.svg"))?;
    let mut figures = Figures::default();
    for (name, options) in STUDIES {
        let table = chart(&scratch, &[&["--study", name], options].concat())?;
        // The first lines are the title and what is below it, which the document has in its own words.
        let table: Vec<&str> = table.lines().skip(4).collect();
        let folded = format!(
            "<details><summary>Figures</summary>\n\n{}\n\n</details>",
            table.join("\n").trim_end()
        );
        places.push((name.to_string(), folded));
        let file = Path::new(name).with_extension("svg");
        fs::copy(scratch.join(&file), folder.join(&file))?;
        figures.read(name, &scratch.join(name).with_extension("csv"))?;
    }
    for (name, value) in places {
        text = text.replace(&format!("{{{{{name}}}}}"), value.trim_end());
    }
    text = figures.filled(&text)?;
    write(Path::new("docs/speed-and-accuracy.md"), text.as_bytes())?;
    fs::remove_dir_all(&scratch)?;
    eprintln!("made in {:.0} seconds", start.elapsed().as_secs_f64());
    Ok(())
}
