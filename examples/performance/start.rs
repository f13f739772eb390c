//! How soon a small picture is there, and how many large ones a second.

use crate::pictures::interactive;
use crate::scenes::{NOT_MEASURED, in_words, verdict};
use crate::{Options, Outcome};
use fieldstone::output::markdown;
use fieldstone::render::Spread;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// In how many milliseconds the smallest scene has to be there.
const MILLISECONDS: f64 = 10.0;

/// How often the command is started.
const STARTS: usize = 25;

/// The command `fieldstone` beside this example, if it was built.
pub fn command() -> Option<PathBuf> {
    let examples = std::env::current_exe().ok()?;
    let name = format!("fieldstone{}", std::env::consts::EXE_SUFFIX);
    let path = examples.parent()?.parent()?.join(name);
    path.is_file().then_some(path)
}

/// Milliseconds of whole processes that render a ball at 64 x 64.
fn starts() -> Outcome<Option<Spread>> {
    let Some(command) = command() else {
        return Ok(None);
    };
    let folder = std::env::temp_dir().join(format!("fieldstone-start-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("s.sdf"), "show sphere(1)\n")?;
    let mut times = Vec::new();
    for _ in 0..STARTS {
        let start = Instant::now();
        let output = Command::new(&command)
            .args(["render", "s.sdf", "--size", "64x64", "-q"])
            .current_dir(&folder)
            .output()?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into());
        }
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(Spread::of(times))
}

/// The table of starts and of pictures a second.
pub fn section(options: &Options) -> Outcome<String> {
    eprintln!("starts");
    let start = starts()?;
    let mut rows = vec![vec![
        "`show sphere(1)` at 64 x 64, the whole process: milliseconds".to_string(),
        start.map_or(NOT_MEASURED.into(), |s| in_words(&s)),
        format!("at most {MILLISECONDS}"),
        start.map_or(NOT_MEASURED.into(), |s| verdict(s.median <= MILLISECONDS)),
    ]];
    rows.extend(interactive(options)?);
    let head = ["", "measured", "target", "reached"];
    Ok(format!(
        "\n## Start and interaction\n\n{}",
        markdown(&head, 1, &rows)
    ))
}
