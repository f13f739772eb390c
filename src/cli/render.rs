//! `fieldstone render`: a picture of a scene.

use super::console::{say, say_line, say_warning};
use super::failure::Failure;
use super::files;
use super::interrupt;
use super::progress::Reporter;
use super::refutations;
use super::script::{Script, compile};
use super::stats::{self, Stages, timed};
use super::tracing::Tracing;
use super::value;
use crate::output::{self, Metadata, Saved};
use crate::render::{self, Channel, RenderOptions, Rendered};
use crate::scene::{Sampling, Scene, Settings};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

const AFTER_HELP: &str = "\
The picture is a PNG with the script's name, the values of its parameters, the settings and the version in its \
text. Without -o it is named after the script and lies in the current folder: `fieldstone render art/arch.sdf` \
writes arch.png. A single channel goes to that file; of several, beauty does, and each other one lies beside it, as \
in arch.depth.png. Files are written whole or not at all.

Where two samples on a ray differ by more than a Lipschitz constant allows, that constant is wrong and the picture may \
be: a warning then names the node, its place in the script, and the two points. With --strict the exit code is 3. Every \
method but `interval` and `reference` looks, which need no constants; what no ray samples is not noticed.

Examples:
  fieldstone render scene.sdf
  fieldstone render scene.sdf -o big.png --size 1920x1080 --samples 16 --sampling adaptive
  fieldstone render scene.sdf -D teeth=30 -D gap=0.2
  fieldstone render scene.sdf --channel beauty,steps,verdict --stats stats.json
  fieldstone render scene.sdf --strict";

/// Render a scene to a PNG
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    script: Script,
    /// The picture's file [default: the script's name with .png, in the current folder]
    #[arg(short, long, value_name = "OUT.png")]
    output: Option<PathBuf>,
    /// Width and height in pixels, up to 16384 each [default: what the script says, or else 640x360]
    #[arg(long, value_name = "WxH", value_parser = value::size, allow_hyphen_values = true)]
    size: Option<[u32; 2]>,
    /// Rays per pixel [default: what the script says, or else 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65536), allow_negative_numbers = true)]
    samples: Option<u32>,
    /// Which pixels get as many: all, or those that differ from a neighbour, the others one [default: what the script says, or else
    /// even]
    #[arg(long, value_name = "WAY", value_parser = sampling())]
    sampling: Option<Sampling>,
    /// How often a ray may be reflected or refracted [default: what the script says, or else 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1000), allow_negative_numbers = true)]
    depth: Option<u32>,
    #[command(flatten)]
    tracing: Tracing,
    /// Threads that work at once [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,
    /// What is recorded of each pixel, one or more
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',', default_value = "beauty", value_parser = channel())]
    channel: Vec<Channel>,
    /// Write counts and times to this file
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Exit with code 3 if rays refute a Lipschitz constant; the picture is written all the same
    #[arg(long)]
    strict: bool,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

fn sampling() -> impl TypedValueParser<Value = Sampling> {
    PossibleValuesParser::new(Sampling::ALL.map(|(name, _)| name))
        .map(|name| Sampling::from_name(&name).expect("the parser takes only names of them"))
}

fn channel() -> impl TypedValueParser<Value = Channel> {
    let values = Channel::ALL.map(|c| PossibleValue::new(c.name()).help(c.summary()));
    PossibleValuesParser::new(values)
        .map(|name| Channel::from_name(&name).expect("the parser takes only names of channels"))
}

/// Renders the scene and writes its picture.
///
/// # Errors
/// If the script is wrong, a file can't be written, or the user stops it; then no half-written file is left. And if rays
/// refute a Lipschitz constant while `--strict` asks that none is; then all files are there.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = picture_path(arguments)?;
    [Some(&path), arguments.stats.as_ref()]
        .into_iter()
        .flatten()
        .try_for_each(|path| files::has_place(path))?;
    let mut stages = Stages::default();
    let (loaded, milliseconds) = timed(|| arguments.script.load());
    let mut loaded = loaded?;
    stages.load = milliseconds;
    apply(arguments, &mut loaded.scene.settings);
    let (world, milliseconds) = timed(|| compile(&loaded.scene));
    let world = world?;
    stages.compile = milliseconds;
    let rendered = rendered(arguments, &loaded.scene, &world)?;
    // The script by its name alone, so that no folder of this machine gets out.
    let name = script_name(arguments);
    let metadata = Metadata::new(&name, &loaded.parameters, &loaded.scene.settings);
    let (saved, milliseconds) = timed(|| output::save(&rendered.film, &path, &metadata));
    let saved = saved.map_err(|error| files::failed(&error.path, &error.source))?;
    stages.write = milliseconds;
    if let Some(path) = &arguments.stats {
        let text = stats::to_json(&rendered.statistics, &stages, &name, &loaded.parameters)
            .map_err(|error| Failure::Other(error.to_string()))?;
        files::write(path, text.as_bytes())?;
    }
    tell(arguments, &rendered, &stages, &saved);
    if refutations::warn(&loaded, &world) > 0 && arguments.strict {
        return Err(Failure::Refuted);
    }
    Ok(())
}

/// Renders with a report of progress, until it is done or the user stops it.
fn rendered(
    arguments: &Arguments,
    scene: &Scene,
    world: &crate::trace::World,
) -> Result<Rendered, Failure> {
    let cancel = interrupt::listen();
    let reporter = Reporter::new(arguments.quiet);
    let rendered = render::render(
        scene,
        world,
        &RenderOptions {
            channels: &arguments.channel,
            threads: arguments.threads.map_or(0, usize::from),
            progress: Some(&|progress| reporter.tell(progress)),
            cancel: Some(cancel),
            ..RenderOptions::default()
        },
    );
    reporter.end();
    if rendered.cancelled || cancel.load(Ordering::Relaxed) {
        return Err(Failure::Interrupted);
    }
    Ok(rendered)
}

/// Puts what was asked for into the settings.
fn apply(arguments: &Arguments, settings: &mut Settings) {
    settings.size = arguments.size.unwrap_or(settings.size);
    settings.samples = arguments.samples.unwrap_or(settings.samples);
    settings.sampling = arguments.sampling.unwrap_or(settings.sampling);
    settings.depth = arguments.depth.unwrap_or(settings.depth);
    arguments.tracing.apply(settings);
}

/// What was written, what it took, and what is to be looked at.
fn tell(arguments: &Arguments, rendered: &Rendered, stages: &Stages, saved: &[Saved]) {
    let statistics = &rendered.statistics;
    if !arguments.quiet {
        for file in saved {
            say_line(&format!(
                "wrote {} ({})",
                file.path.display(),
                file.channel.name()
            ));
        }
        say(&stats::summary(statistics, stages));
    }
    for file in saved.iter().filter(|file| file.not_a_number > 0) {
        let (path, n) = (file.path.display(), file.not_a_number);
        say_warning(&format!(
            "in {path}, {n} pixels are not a number; they are black"
        ));
    }
    if let Some(warning) = stats::warning(statistics) {
        say_warning(&warning);
    }
}

/// Where the picture goes.
fn picture_path(arguments: &Arguments) -> Result<PathBuf, Failure> {
    let path = match &arguments.output {
        Some(path) => path.clone(),
        None => default_path(&arguments.script.path),
    };
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        None | Some("png") => Ok(path),
        Some(other) => Err(Failure::Usage(format!(
            "pictures are written as PNG, not as .{other}; write `-o {}`",
            path.with_extension("png").display()
        ))),
    }
}

/// The script's name with `.png`, in the current folder.
fn default_path(script: &Path) -> PathBuf {
    let stem = script.file_stem().unwrap_or("scene".as_ref());
    let mut name = stem.to_os_string();
    name.push(".png");
    PathBuf::from(name)
}

fn script_name(arguments: &Arguments) -> String {
    let path = &arguments.script.path;
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picture_is_named_after_the_script_in_the_current_folder() {
        assert_eq!(
            default_path(Path::new("a/b.c/arch.sdf")),
            Path::new("arch.png")
        );
        assert_eq!(default_path(Path::new("arch")), Path::new("arch.png"));
        assert_eq!(default_path(Path::new("v1.2.sdf")), Path::new("v1.2.png"));
    }
}
