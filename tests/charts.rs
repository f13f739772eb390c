//! The charts of `docs/speed-and-accuracy.md` are held against the tracer by their counts.

use fieldstone::lang::load;
use fieldstone::render::Hits;
use fieldstone::scene::{Method, Scene};
use fieldstone::trace::{SceneTracer, Verdict, World};
use serde::Deserialize;
use std::path::PathBuf;

/// How the document is made anew.
const COMMAND: &str = "cargo build --release && cargo run --release --example speed_and_accuracy";

/// A row of `docs/charts/chart.csv`.
#[derive(Debug, Deserialize)]
struct Row {
    scene: String,
    width: u32,
    height: u32,
    method: String,
    tolerance: f64,
    unknown: u64,
    undecided: u64,
    evaluations: f64,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn rows() -> Vec<Row> {
    let path = root().join("docs/charts/chart.csv");
    let mut reader = csv::Reader::from_path(path).expect("the figures of the charts");
    reader
        .deserialize()
        .collect::<Result<_, _>>()
        .expect("rows of figures")
}

fn scene(row: &Row) -> Scene {
    let folders = ["examples", "benches/scenes"].map(|folder| root().join(folder));
    let paths = folders.map(|folder| folder.join(&row.scene).with_extension("sdf"));
    let path = paths
        .into_iter()
        .find(|path| path.is_file())
        .expect("the script of a chart");
    let mut scene = load(&path, &[], &SceneTracer::default())
        .expect("a scene")
        .scene;
    let settings = &mut scene.settings;
    settings.size = [row.width, row.height];
    settings.tolerance = row.tolerance;
    settings.method = Method::from_name(&row.method).expect("a method");
    scene
}

/// Evaluations and unknown rays of the default and of sphere tracing: not times, which are of one machine.
#[test]
fn charts_are_not_stale() {
    let rows = rows();
    let scenes: std::collections::BTreeSet<&str> = rows.iter().map(|row| &row.scene[..]).collect();
    assert!(scenes.len() >= 6, "{scenes:?}");
    let is_tried = |row: &&Row| {
        // Where each of a thousand parts is marched by itself, sphere tracing takes too long for a test.
        let is_short = row.evaluations < 1000.0;
        ["auto", "sphere"].contains(&&row.method[..]) && row.tolerance == 0.1 && is_short
    };
    let tried: Vec<&Row> = rows.iter().filter(is_tried).collect();
    assert_eq!(tried.len(), 2 * scenes.len() - 1);
    for row in tried {
        let scene = scene(row);
        let hits = Hits::of(&scene, &World::new(&scene).expect("a world"), 0);
        let unknown = hits
            .outcomes
            .iter()
            .filter(|o| o.verdict == Verdict::Unknown)
            .count() as u64;
        assert!(
            hits.evaluations() == row.evaluations && (unknown == row.unknown || row.undecided > 0),
            "{row:?}: now {} evaluations a ray, {unknown} unknown; make the charts anew: {COMMAND}",
            hits.evaluations()
        );
    }
}

/// The table of steps towards a plane, row by row, as the command prints it now.
#[test]
fn steps_of_grazing_rays_are_not_stale() {
    let folder = std::env::temp_dir().join(format!("fieldstone-grazing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let methods = "auto,sphere,relaxed,auto-relaxed,enhanced,bisect";
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_fieldstone"))
        .args([
            "chart",
            "--study",
            "grazing",
            "--methods",
            methods,
            "-q",
            "-o",
        ])
        .arg(&folder)
        .output()
        .expect("the command runs");
    std::fs::remove_dir_all(&folder).expect("the folder goes away");
    let table = String::from_utf8(output.stdout).expect("text");
    let text =
        std::fs::read_to_string(root().join("docs/speed-and-accuracy.md")).expect("the document");
    let rows: Vec<&str> = table.lines().filter(|line| line.starts_with('|')).collect();
    assert!(rows.len() > 10, "{table}");
    for row in rows {
        assert!(
            text.contains(row),
            "{row} is not in the document; make it anew: {COMMAND}"
        );
    }
}

/// Every picture that the document shows is there, and no place of the template is left open.
#[test]
fn document_is_whole() {
    let text =
        std::fs::read_to_string(root().join("docs/speed-and-accuracy.md")).expect("the document");
    assert!(!text.contains("{{"), "a place of the template is left open");
    let pictures: Vec<&str> = text
        .split("](charts/")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .collect();
    assert!(pictures.len() >= 6, "{pictures:?}");
    for name in pictures {
        assert!(root().join("docs/charts").join(name).is_file(), "{name}");
    }
}
