//! `fieldstone bench`: how long scenes take, measured in rounds.

use super::bench_report::{Bench, in_words, to_json};
use super::console::answer;
use super::failure::Failure;
use super::script::{Scripts, compile, described};
use super::stats::timed;
use super::{tracing, value};
use crate::render::{Case, RenderOptions};
use crate::scene::{Method, Settings};
use clap::Args;
use std::path::Path;

const AFTER_HELP: &str = "\
In every round each scene is loaded, and its picture made by each method with each number of threads in turn, so that \
what else the machine does strikes all of them alike. Of each time the table has the smallest, the one in the middle, \
and the one that three quarters of the rounds don't exceed. A ratio is that of the middles. Where the spreads (from the \
smallest to the three quarters) overlap, or there are fewer than four rounds, it says `no difference`.

  load      reading and running the script
  compile   making closures of its shapes
  render    the picture, from the first tile to the last
  tracing   finding surfaces, summed over the threads; with the rest of the tile it is what render does
  ns/ray    tracing time of a thread for a ray of that kind

The picture is not written. Compare times of one call only: a machine drifts.

Examples:
  fieldstone bench scene.sdf
  fieldstone bench scene.sdf --methods auto,sphere --threads 1,2 --rounds 9
  fieldstone bench benches/scenes/s*.sdf -D width=320 --json";

/// Measure the time that scenes take, and compare methods and numbers of threads
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    scripts: Scripts,
    /// How often everything is measured
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000), allow_negative_numbers = true)]
    rounds: u16,
    /// The methods that are compared [default: what the script says, or else auto]
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',', value_parser = tracing::method())]
    methods: Vec<Method>,
    /// The numbers of threads that are compared
    #[arg(long, value_name = "N[,N]", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Vec<u16>,
    /// Width and height in pixels, up to 16384 each [default: what the script says, or else 640x360]
    #[arg(long, value_name = "WxH", value_parser = value::size, allow_hyphen_values = true)]
    size: Option<[u32; 2]>,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Every method with every number of threads, each once.
    fn cases(&self, settings: &Settings) -> Vec<Case> {
        let own = [settings.method];
        let methods = if self.methods.is_empty() {
            &own[..]
        } else {
            &self.methods[..]
        };
        let mut cases = Vec::new();
        for method in methods {
            for threads in &self.threads {
                let case = Case {
                    method: *method,
                    threads: usize::from(*threads),
                };
                if !cases.contains(&case) {
                    cases.push(case);
                }
            }
        }
        cases
    }
}

/// Measures each scene and prints what it found.
///
/// # Errors
/// If a script can't be read, is wrong, or shows what can't be traced.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut measured = Vec::new();
    let result = arguments.scripts.each(|path, loaded| {
        // What can't be traced is said here, shape by shape.
        compile(&loaded.scene)?;
        let bench = measure(arguments, path, loaded.scene.settings, &loaded.parameters)?;
        if arguments.json {
            measured.push(to_json(&bench));
            return Ok(());
        }
        answer(&in_words(&bench))
    });
    if arguments.json && !matches!(result, Err(Failure::Closed)) {
        let json = serde_json::json!({ "schema": 1, "scenes": measured });
        answer(&format!("{json:#}\n"))?;
    }
    result
}

/// The rounds of a scene.
fn measure(
    arguments: &Arguments,
    path: &Path,
    mut settings: Settings,
    parameters: &[(String, String)],
) -> Result<Bench, Failure> {
    settings.size = arguments.size.unwrap_or(settings.size);
    let mut bench = Bench {
        script: path.display().to_string(),
        parameters: parameters.to_vec(),
        settings,
        load: Vec::new(),
        cases: arguments
            .cases(&settings)
            .into_iter()
            .map(|case| (case, Vec::new()))
            .collect(),
    };
    for _ in 0..arguments.rounds {
        let (loaded, milliseconds) = timed(|| arguments.scripts.again(path));
        bench.load.push(milliseconds);
        let mut scene = loaded?.scene;
        scene.settings = settings;
        for (case, runs) in &mut bench.cases {
            let run = case.run(&scene, &RenderOptions::default());
            let (run, _) = run.map_err(|fault| Failure::Other(described(&fault, None)))?;
            runs.push(run);
        }
    }
    Ok(bench)
}
