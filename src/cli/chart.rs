//! `fieldstone chart`: speed against accuracy.

use super::chart_panels::{Kind, Measured, Metric, Work, chart};
use super::chart_tables::{csv, json, markdown};
use super::console::{answer, say_line};
use super::failure::Failure;
use super::files;
use super::script::{AnyScripts, compile, described};
use super::study::{self, Study};
use super::{tracing, truth_cache, value};
use crate::output::chart::Chart;
use crate::output::{self, Metadata};
use crate::render::{Setting, sweep};
use crate::scene::{Method, Scene, Settings};
use clap::Args;
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "\
Every method traces the camera's rays of each scene at each tolerance; its hits are compared with those of `--method \
reference`, and its times are the smallest of interleaved rounds on one thread, with the spread. The files chart.svg, \
chart.png, chart.csv, chart.json and chart.md go to the folder of -o; the table is printed, too. Of several kinds of panels, each \
is drawn alone as well, as depth-evaluations.svg, depth-evaluations.png and so on.

A point is a method at a tolerance. Down and left is good: few evaluations, small errors. The band joins the points that \
no other point beats on both axes. Grey points missed surfaces: they are fast because they are wrong. Crossed ones have rays \
that ended without an answer; ringed ones met a field steeper than its Lipschitz constant. Errors:

  depth      the error of depth that 99 % of the hits don't exceed, in widths of a pixel
  depth-max  the largest error of depth, in widths of a pixel
  wrong      false hits, false misses and unknown rays, of a million
  normals    the angle between normals that 99 % of the hits don't exceed, in degrees
  image      the root mean square of the difference of the pictures' light (renders them as well)

With --study, another chart is drawn instead, and its files are named after it:

  grazing     steps towards a plane against the angle, with the closed form for Hart's steps
  primitives  time against the number of primitives, from 1 to 10 000, with and without pruning
  constants   wrong rays, evaluations and time against a factor on every Lipschitz constant (needs scenes)
  distance    errors against the distance of everything from the origin and against its size, in f64 and in f32
  precision   errors of f32 and of f64 against the tolerance (needs scenes)
  gradients   errors of normals by dual numbers, central and tetrahedral differences
  samples     errors of pictures against the number of samples a pixel (needs scenes)

Examples:
  fieldstone chart scene.sdf
  fieldstone chart a.sdf b.sdf --methods auto,sphere,relaxed --tolerances 1,0.1,0.01 -o charts
  fieldstone chart scene.sdf --errors depth --work evaluations --size 320x180
  fieldstone chart --study grazing";

/// Chart the speed of methods against their accuracy
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    scripts: AnyScripts,
    /// The methods [default: all but the reference]
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',', value_parser = tracing::method())]
    methods: Vec<Method>,
    /// The tolerances, in pixels; the scene's own joins them
    #[arg(long, value_name = "PX[,PX]", value_delimiter = ',', default_value = "1,0.1,0.01,0.001,0.0001", value_parser = value::positive, allow_negative_numbers = true)]
    tolerances: Vec<f64>,
    /// Width and height in pixels [default: 160 wide, in the shape of the scene's picture]
    #[arg(long, value_name = "WxH", value_parser = value::size, allow_hyphen_values = true)]
    size: Option<[u32; 2]>,
    /// How often everything is timed; what takes longer than half a second is timed once
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000), allow_negative_numbers = true)]
    rounds: u16,
    /// The errors that are drawn, a panel each
    #[arg(
        long,
        value_name = "NAME[,NAME]",
        value_delimiter = ',',
        default_value = "depth,wrong"
    )]
    errors: Vec<Metric>,
    /// What they are drawn against
    #[arg(
        long,
        value_name = "NAME[,NAME]",
        value_delimiter = ',',
        default_value = "evaluations,milliseconds"
    )]
    work: Vec<Work>,
    /// Another chart instead
    #[arg(long, value_name = "NAME")]
    study: Option<Study>,
    /// The folder of the files, which must exist [default: the current one]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

/// How wide the pictures are if nothing else is said, in pixels.
const WIDTH: u32 = 160;

/// Measures the scenes and writes the charts.
///
/// # Errors
/// If a script is wrong, shows what can't be traced, or a file can't be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = arguments.output.clone().unwrap_or_default();
    let name = arguments.study.map_or("chart", Study::name);
    files::has_place(&folder.join(name).with_extension("csv"))?;
    if let Some(study) = arguments.study {
        return run_study(arguments, study, &folder);
    }
    if arguments.scripts.is_empty() {
        return Err(Failure::Usage(
            "which scenes? Write `fieldstone chart scene.sdf`".into(),
        ));
    }
    let mut measured = Vec::new();
    arguments.scripts.each(|path, loaded| {
        measured.push(measure(arguments, path, loaded.scene)?);
        Ok(())
    })?;
    let files = [
        ("chart.csv", csv(&measured).into_bytes()),
        ("chart.json", json(&measured).into_bytes()),
        ("chart.md", markdown(&measured).into_bytes()),
    ];
    let names: Vec<String> = measured.iter().map(Measured::name).collect();
    let mut kinds = Kind::all(&arguments.errors, &arguments.work);
    let mut seen = Vec::new();
    kinds.retain(|kind| {
        !seen.contains(kind) && {
            seen.push(*kind);
            true
        }
    });
    let source = names.join(" ");
    draw(
        arguments,
        &folder,
        "chart",
        &chart(&measured, &kinds),
        &source,
    )?;
    for kind in kinds.iter().filter(|_| kinds.len() > 1) {
        let alone = chart(&measured, std::slice::from_ref(kind));
        draw(arguments, &folder, &kind.name(), &alone, &source)?;
    }
    for (name, bytes) in files {
        write(arguments, &folder.join(name), &bytes)?;
    }
    answer(&markdown(&measured))
}

/// Draws another chart.
fn run_study(arguments: &Arguments, study: Study, folder: &Path) -> Result<(), Failure> {
    let mut scenes = Vec::new();
    arguments.scripts.each(|path, loaded| {
        let scene = prepared(arguments, path, loaded.scene)?;
        scenes.push((study::name(path), scene));
        Ok(())
    })?;
    let plan = study::Plan {
        scenes,
        methods: methods(arguments),
        rounds: usize::from(arguments.rounds),
    };
    let result = study.carry_out(&plan)?;
    draw(arguments, folder, study.name(), &result.chart, "")?;
    write(
        arguments,
        &folder.join(study.name()).with_extension("csv"),
        result.csv().as_bytes(),
    )?;
    answer(&result.markdown())
}

/// The size of the pictures of a scene.
fn size(arguments: &Arguments, settings: &Settings) -> [u32; 2] {
    let [width, height] = settings.size;
    let scaled = (f64::from(WIDTH) * f64::from(height) / f64::from(width)).round() as u32;
    arguments
        .size
        .unwrap_or([WIDTH, scaled.clamp(1, 4 * WIDTH)])
}

/// The methods that were asked for, in the order of their list.
fn methods(arguments: &Arguments) -> Vec<Method> {
    let all = Method::ALL.iter().map(|(_, method)| *method);
    match arguments.methods.is_empty() {
        true => all.filter(|m| *m != Method::Reference).collect(),
        false => all.filter(|m| arguments.methods.contains(m)).collect(),
    }
}

/// Every method with every tolerance, and the scene's own setting.
fn settings(arguments: &Arguments, settings: &Settings) -> Vec<Setting> {
    let mut tolerances = arguments.tolerances.clone();
    tolerances.sort_by(|a, b| b.total_cmp(a));
    tolerances.dedup();
    let own = settings.tolerance;
    let mut list = Vec::new();
    for method in methods(arguments) {
        let extra = (method == settings.method && !tolerances.contains(&own)).then_some(own);
        let mut of_method: Vec<f64> = tolerances.iter().copied().chain(extra).collect();
        of_method.sort_by(|a, b| b.total_cmp(a));
        list.extend(
            of_method
                .into_iter()
                .map(|tolerance| Setting { method, tolerance }),
        );
    }
    list
}

/// The scene at the size that is charted; what can't be traced is said shape by shape.
fn prepared(arguments: &Arguments, path: &Path, mut scene: Scene) -> Result<Scene, Failure> {
    if scene.shown.is_empty() {
        let path = path.display();
        return Err(Failure::Other(format!(
            "`{path}` shows nothing that rays could find"
        )));
    }
    scene.settings.size = size(arguments, &scene.settings);
    compile(&scene)?;
    Ok(scene)
}

fn measure(arguments: &Arguments, path: &Path, scene: Scene) -> Result<Measured, Failure> {
    let scene = prepared(arguments, path, scene)?;
    let settings = settings(arguments, &scene.settings);
    if !arguments.quiet {
        let [width, height] = scene.settings.size;
        say_line(&format!(
            "{}: {} settings at {width} x {height}",
            path.display(),
            settings.len()
        ));
    }
    let fault = |fault| Failure::Other(described(&fault, None));
    let wants_picture = arguments.errors.contains(&Metric::Image);
    let truth = truth_cache::truth(&scene, wants_picture).map_err(fault)?;
    let judged = sweep(&scene, &settings, usize::from(arguments.rounds), &truth).map_err(fault)?;
    Ok(Measured {
        script: path.to_path_buf(),
        settings: scene.settings,
        judged,
    })
}

/// Writes the chart as SVG and as PNG.
fn draw(
    arguments: &Arguments,
    folder: &Path,
    name: &str,
    chart: &Chart,
    source: &str,
) -> Result<(), Failure> {
    let vector = output::chart::svg(chart).map_err(Failure::Other)?;
    let image = output::chart::pixels(chart).map_err(Failure::Other)?;
    let metadata = Metadata {
        source: source.into(),
        ..Metadata::default()
    };
    let picture =
        output::encode(&image, &metadata).map_err(|error| Failure::Other(error.to_string()))?;
    let path = folder.join(name);
    write(arguments, &path.with_extension("svg"), vector.as_bytes())?;
    write(arguments, &path.with_extension("png"), &picture)
}

fn write(arguments: &Arguments, path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    files::write(path, bytes)?;
    if !arguments.quiet {
        say_line(&format!("wrote {}", path.display()));
    }
    Ok(())
}
