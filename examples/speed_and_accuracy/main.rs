//! Writes `docs/speed-and-accuracy.md` and its charts in `docs/charts`:
//!
//! `cargo build --release && cargo run --release --example speed_and_accuracy`
//!
//! The words are those of `template.md`; every chart and every figure is made by the command `fieldstone chart` here and now.

use fieldstone::output::write;
use std::error::Error;
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
const PICTURES: [&str; 4] = ["--size", "96x54", "--rounds", "4"];

/// The further charts, with their options.
const STUDIES: [(&str, &[&str]); 6] = [
    (
        "grazing",
        &[
            "--methods",
            "auto,sphere,relaxed,auto-relaxed,enhanced,bisect",
        ],
    ),
    (
        "primitives",
        &["--methods", "auto,certified,sphere", "--rounds", "2"],
    ),
    (
        "constants",
        &[
            "benches/scenes/s3.sdf",
            "benches/scenes/s6.sdf",
            "--methods",
            "auto,certified,sphere,relaxed,auto-relaxed",
            "--size",
            "96x54",
        ],
    ),
    (
        "distance",
        &["--methods", "auto,sphere,auto-relaxed,bisect"],
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

fn main() -> Outcome<()> {
    let folder = Path::new(FOLDER);
    std::fs::create_dir_all(folder)?;
    let mut text = include_str!("template.md").to_string();
    let tables = chart(folder, &[&SCENES[..], &PICTURES].concat())?;
    text = text.replace("{{tables}}", tables.trim_end());
    for (name, options) in STUDIES {
        let table = chart(folder, &[&["--study", name], options].concat())?;
        // The first lines are the title and what is below it, which the document has in its own words.
        let table: Vec<&str> = table.lines().skip(4).collect();
        text = text.replace(&format!("{{{{{name}}}}}"), table.join("\n").trim_end());
    }
    // What the document does not show is not kept, but for its figures.
    for name in ["chart.md", "chart.json", "chart.png", "overview.svg"] {
        std::fs::remove_file(folder.join(name))?;
    }
    for (name, _) in STUDIES {
        for ending in ["png", "csv"] {
            std::fs::remove_file(folder.join(name).with_extension(ending))?;
        }
    }
    write(Path::new("docs/speed-and-accuracy.md"), text.as_bytes())?;
    Ok(())
}
