//! Instructions by the count of callgrind, where valgrind is installed: they don't depend on what else the machine does.

use crate::Outcome;
use crate::start::command;
use fieldstone::output::markdown;
use std::path::Path;
use std::process::Command;

/// The scenes, and the width of their pictures.
const SCENES: [&str; 3] = ["s1", "s2", "s5a"];
const WIDTH: u32 = 64;

/// The instructions of a whole process that renders a scene on one thread; `None` without valgrind.
fn count(command: &Path, scene: &str, picture: &Path) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(command)
        .arg("render")
        .arg(format!("benches/scenes/{scene}.sdf"))
        .args([
            "-D",
            &format!("width={WIDTH}"),
            "--threads",
            "1",
            "-q",
            "-o",
        ])
        .arg(picture)
        .output()
        .ok()?;
    let report = String::from_utf8_lossy(&output.stderr);
    let collected = report
        .lines()
        .find_map(|line| line.split("Collected :").nth(1))?;
    collected.trim().parse().ok()
}

/// The table of instructions.
pub fn section() -> Outcome<String> {
    let picture = std::env::temp_dir().join(format!(
        "fieldstone-instructions-{}.png",
        std::process::id()
    ));
    let command = command();
    let mut rows = Vec::new();
    for scene in SCENES {
        eprintln!("{scene}: instructions");
        let number = command
            .as_ref()
            .and_then(|command| count(command, scene, &picture));
        let cell = number.map_or(
            "not measured: valgrind and the command are needed".into(),
            |n| format!("{:.1}", n as f64 / 1e6),
        );
        rows.push(vec![scene.to_string(), cell]);
    }
    // There is none where nothing was measured.
    let _ = std::fs::remove_file(&picture);
    let head = ["scene", "million instructions"];
    Ok(format!(
        "\n## Instructions\n\nOf the whole process, counted by callgrind (which knows AVX2, not AVX-512):\n\n```\nvalgrind \
         --tool=callgrind target/release/fieldstone render benches/scenes/s2.sdf -D width={WIDTH} --threads 1\n```\n\n{}",
        markdown(&head, 1, &rows)
    ))
}
