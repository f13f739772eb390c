//! Writes `docs/performance.md`: what Fieldstone is meant to reach, beside what it reaches on this machine.
//!
//! `cargo build --release && cargo run --release --example performance -- --peers peers.csv`
//!
//! Every figure of the document comes from this run or from the file of the peers' figures, measured on the same machine.

mod accuracy;
mod changed;
mod evaluation;
mod growth;
mod instructions;
mod machine;
mod peers;
mod pictures;
mod scenes;
mod start;

use clap::Parser;
use fieldstone::output::write;
use peers::Peers;
use std::error::Error;
use std::path::PathBuf;

/// Where people write why a target is not reached, and what was tried.
const NOTES: &str = "docs/performance-notes.md";

type Outcome<T> = Result<T, Box<dyn Error>>;

/// How it is measured.
#[derive(Debug, Parser)]
struct Options {
    /// The peers' figures, as CSV with the columns scene,what,peer,value,p99,missed,wrong; see docs/performance.md
    #[arg(long, value_name = "FILE.csv")]
    peers: Option<PathBuf>,
    /// How often every picture is made
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=100))]
    rounds: u16,
    /// How wide the pictures are that are timed, in pixels, a multiple of 16; the targets are for 1280
    #[arg(long, default_value_t = 1280)]
    width: u32,
    /// How wide the pictures are whose errors are measured, in pixels, a multiple of 16; the peers' are for 640
    #[arg(long, default_value_t = 640)]
    accuracy_width: u32,
    /// The document
    #[arg(short, long, default_value = "docs/performance.md")]
    output: PathBuf,
}

fn main() -> Outcome<()> {
    if let Some(n) = growth::asked_for_memory() {
        return growth::tell_memory(&n);
    }
    let options = Options::parse();
    let peers = Peers::read(options.peers.as_deref())?;
    let mut text = introduction(&options, &peers);
    let errors = accuracy::measure(&options)?;
    let pictures = pictures::measure(&options)?;
    text.push_str(&pictures::section(&options, &pictures, &peers, &errors));
    text.push_str(&accuracy::section(&options, &errors, &peers)?);
    text.push_str(&pictures::threads(&pictures));
    text.push_str(&changed::section(&options)?);
    text.push_str(&growth::section(&options)?);
    text.push_str(&evaluation::section(&peers)?);
    text.push_str(&start::section(&options)?);
    text.push_str(&instructions::section()?);
    text.push_str(&notes());
    write(&options.output, text.as_bytes())?;
    eprintln!("wrote {}", options.output.display());
    Ok(())
}

/// What is to be said about the figures, from a file beside the document: it is written by people and kept.
fn notes() -> String {
    std::fs::read_to_string(NOTES).map_or(String::new(), |notes| format!("\n{notes}"))
}

fn introduction(options: &Options, peers: &Peers) -> String {
    let Options {
        rounds,
        width,
        accuracy_width,
        ..
    } = options;
    let wide = if *width == 1280 {
        String::new()
    } else {
        format!(" --width {width}")
    };
    format!(
        "# Performance

Measured on {}, {}, in {rounds} rounds of each picture, by

```
cargo build --release
cargo run --release --example performance -- --peers peers.csv --rounds {rounds} --accuracy-width {accuracy_width}{wide}
```

Times are the median of the rounds, with the smallest and the one that three quarters don't exceed; ratios to peers take the \
smallest, and the peers' processor seconds: neighbours disturb them least. Compare nothing with other machines or days. {}

`peers.csv` has the columns `scene,what,peer,value,p99,missed,wrong`. `what` is `whole` or `object` (the value is seconds), \
`evaluation` (million points a second), or `error` (seconds at 640 x 360, the error of depth in scene units that 99 % of the hits don't \
exceed, rays missed, rays on a wrong surface). What it does not hold is not measured.

The peers' figures are for 1280 x 720 on one thread unless said otherwise: POV-Ray 3.7 draws the whole picture with floor \
and shadows; the JIT of fidget 0.5.1 draws the object only, its depth and normals, 1024 voxels deep (512 at 640 x 360). \
Ours is the time from the first tile to the last: with shading for the whole picture, with depth and normals for the object only. The scenes are in \
[benches/scenes](../benches/scenes/README.md); \"object only\" is `-D object_only=1`. A single row is measured anew by, as an example,

```
fieldstone bench benches/scenes/s2.sdf -D object_only=1 --rounds 9
```
",
        machine::name(),
        machine::today(),
        peers.source(),
    )
}
