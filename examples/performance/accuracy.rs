//! How far the hits of camera rays lie from those of the reference.

use crate::peers::{Figure, Peers};
use crate::scenes::{NOT_MEASURED, SCENES, sized, verdict, world};
use crate::{Options, Outcome};
use fieldstone::output::{markdown, short};
use fieldstone::render::{Errors, Hits, Spread};
use fieldstone::scene::{Method, Scene};

/// What has to be reached: the error of depth in pixels, and in scene units.
const PIXELS: f64 = 0.01;
const UNITS: f64 = 1e-5;

/// In how many seconds, on one thread, the object of a peers' scene has to be drawn at 640 x 360 with that error.
const SECONDS: f64 = 0.025;

/// The errors of a picture.
pub struct Judged {
    pub scene: String,
    pub what: &'static str,
    pub errors: Errors,
}

impl Judged {
    /// False hits, false misses and unknown rays.
    pub fn wrong(&self) -> u64 {
        self.errors.false_hits + self.errors.false_misses + self.errors.unknown
    }
}

/// The errors of all pictures; none where there is no reference to judge by.
pub fn measure(options: &Options) -> Outcome<Vec<Judged>> {
    let Some(reference) = Method::from_name("reference") else {
        return Ok(Vec::new());
    };
    let mut all = Vec::new();
    for (name, _) in SCENES {
        for what in ["whole", "object"] {
            if name == "s1" && what == "object" {
                continue;
            }
            all.push(judge(name, what, options.accuracy_width, reference)?);
        }
    }
    Ok(all)
}

/// The errors of one picture, that wide.
fn judge(name: &str, what: &'static str, width: u32, reference: Method) -> Outcome<Judged> {
    eprintln!("{name}, {what}: errors at {width}");
    let scene = sized(name, width, what == "object")?;
    let found = hits(&scene, Method::Auto)?;
    let truth = hits(&scene, reference)?;
    Ok(Judged {
        scene: name.into(),
        what,
        errors: Errors::of(&found, &truth),
    })
}

fn hits(scene: &Scene, method: Method) -> Outcome<Hits> {
    let mut scene = scene.clone();
    scene.settings.method = method;
    Ok(Hits::of(&scene, &world(&scene)?, 0))
}

/// The errors, and the peers' times at their errors.
pub fn section(options: &Options, judged: &[Judged], peers: &Peers) -> Outcome<String> {
    let width = options.accuracy_width;
    let mut text = format!(
        "\n## Accuracy\n\nCamera rays at {width} x {}, every one of them compared with `--method reference`: interval \
         bisection in f64, which shares no step with the tracer. Target: the error of depth that 99 % of the hits don't \
         exceed is at most {PIXELS} of a pixel's width, no false hit and no false miss.\n\n",
        width * 9 / 16
    );
    let head = [
        "scene",
        "picture",
        "rays",
        "p99, px",
        "largest, px",
        "p99, units",
        "normals p99, degrees",
        "false hits",
        "false misses",
        "unknown",
        "undecided",
        "reached",
    ];
    let rows: Vec<Vec<String>> = judged.iter().map(row).collect();
    if rows.is_empty() {
        text.push_str("Not measured: there is no reference in this version.\n");
    } else {
        text.push_str(&markdown(&head, 2, &rows));
        text.push_str(
            "\nUndecided are rays of which the reference is not certain; they are left out.\n",
        );
    }
    text.push_str(&against(options, judged, peers)?);
    Ok(text)
}

fn row(judged: &Judged) -> Vec<String> {
    let e = &judged.errors;
    let is_reached = e.depth_p99 <= PIXELS && e.false_hits + e.false_misses == 0;
    let mut row = vec![judged.scene.clone(), judged.what.into(), e.rays.to_string()];
    row.extend([e.depth_p99, e.depth_max, e.distance_p99, e.normal_p99].map(short));
    row.extend([e.false_hits, e.false_misses, e.unknown, e.undecided].map(|n| n.to_string()));
    row.push(verdict(is_reached));
    row
}

/// Time and error of peers and of ours, on the objects alone.
fn against(options: &Options, judged: &[Judged], peers: &Peers) -> Outcome<String> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for scene in ["s2", "s3", "s6"] {
        let of_scene = |f: &&Figure| f.scene == scene;
        rows.extend(peers.errors().filter(of_scene).map(peer_row));
        let width = 640;
        let alone = sized(scene, width, true)?;
        let world = world(&alone)?;
        let times = (0..options.rounds).map(|_| Hits::of(&alone, &world, 1).milliseconds() / 1e3);
        let seconds = Spread::of(times)
            .expect("there is at least one round")
            .median;
        let is_known =
            |j: &&Judged| j.scene == scene && j.what == "object" && options.accuracy_width == width;
        let own = match Method::from_name("reference") {
            Some(reference) if !judged.iter().any(|j| is_known(&j)) => {
                Some(judge(scene, "object", width, reference)?)
            }
            _ => None,
        };
        let errors = judged.iter().find(is_known).or(own.as_ref());
        rows.push(our_row(scene, seconds, errors));
    }
    let head = [
        "scene",
        "by",
        "seconds",
        "p99 error, units",
        "missed",
        "wrong surface",
        "reached",
    ];
    Ok(format!(
        "\n### Time against error\n\nThe object alone at 640 x 360, one thread, tracing only. Target for ours: at most \
         {UNITS:.0e}, none missed, none wrong, in at most {SECONDS} s.\n\n{}",
        markdown(&head, 2, &rows)
    ))
}

fn peer_row(figure: &Figure) -> Vec<String> {
    let count = |n: Option<u64>| n.map_or(NOT_MEASURED.into(), |n| n.to_string());
    let p99 = figure.p99.map_or(NOT_MEASURED.into(), short);
    let (missed, wrong) = (count(figure.missed), count(figure.wrong));
    vec![
        figure.scene.clone(),
        figure.peer.clone(),
        short(figure.value),
        p99,
        missed,
        wrong,
        String::new(),
    ]
}

fn our_row(scene: &str, seconds: f64, judged: Option<&Judged>) -> Vec<String> {
    let mut row = vec![scene.into(), "Fieldstone".into(), short(seconds)];
    let Some(Judged { errors: e, .. }) = judged else {
        row.extend([NOT_MEASURED; 4].map(String::from));
        return row;
    };
    let is_exact = e.distance_p99 <= UNITS && e.false_misses + e.false_hits + e.unknown == 0;
    row.extend([
        short(e.distance_p99),
        (e.false_misses + e.unknown).to_string(),
        e.false_hits.to_string(),
    ]);
    row.push(verdict(is_exact && seconds <= SECONDS));
    row
}
