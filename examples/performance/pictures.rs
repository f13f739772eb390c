//! Whole pictures and objects alone: against the peers, and on two threads.

use crate::accuracy::Judged;
use crate::peers::Peers;
use crate::scenes::{NOT_MEASURED, SCENES, in_words, scene, sized, verdict};
use crate::{Options, Outcome};
use fieldstone::output::{markdown, short};
use fieldstone::render::{Case, Channel, RenderOptions, Spread, rounds};
use fieldstone::scene::{Method, Scene};

/// What has to be reached against a peer.
struct Target {
    scene: &'static str,
    /// "whole" or "object".
    what: &'static str,
    peer: &'static str,
    /// How many times as fast.
    times: f64,
}

const fn target(scene: &'static str, what: &'static str, peer: &'static str, times: f64) -> Target {
    Target {
        scene,
        what,
        peer,
        times,
    }
}

/// The targets of the fast tracer.
const TARGETS: [Target; 13] = [
    target("s1", "whole", "POV-Ray", 10.0),
    target("s2", "whole", "POV-Ray", 1000.0),
    target("s3", "whole", "POV-Ray", 40.0),
    target("s4", "whole", "POV-Ray", 20.0),
    target("s5a", "whole", "POV-Ray", 8.0),
    target("s5b", "whole", "POV-Ray", 8.0),
    target("s6", "whole", "POV-Ray", 40.0),
    target("s2", "object", "fidget", 15.0),
    target("s3", "object", "fidget", 15.0),
    target("s4", "object", "fidget", 6.0),
    target("s5a", "object", "fidget", 30.0),
    target("s5b", "object", "fidget", 300.0),
    target("s6", "object", "fidget", 5.0),
];

/// How wide the peers' pictures are.
const PEERS_WIDTH: u32 = 1280;

/// How many times as fast two threads have to be as one.
const TWO_THREADS: f64 = 1.9;

/// The times of a picture in milliseconds, on one thread and on two.
pub struct Timed {
    scene: String,
    what: &'static str,
    times: [Spread; 2],
}

fn cases() -> [Case; 2] {
    [1, 2].map(|threads| Case {
        method: Method::Auto,
        threads,
    })
}

/// The times of a picture on one thread and on two.
pub fn times(scene: &Scene, number: u16, channels: &[Channel]) -> Outcome<[Spread; 2]> {
    let options = RenderOptions {
        channels,
        ..RenderOptions::default()
    };
    let runs = rounds(scene, &cases(), usize::from(number), &options);
    let runs = runs.map_err(|fault| fault.message)?;
    Ok([0, 1].map(|case| {
        let walls = runs[case]
            .iter()
            .map(|run| run.statistics.milliseconds.wall);
        Spread::of(walls).expect("there is at least one round")
    }))
}

/// The times of all pictures.
pub fn measure(options: &Options) -> Outcome<Vec<Timed>> {
    let mut all = Vec::new();
    for (name, _) in SCENES {
        for what in ["whole", "object"] {
            if name == "s1" && what == "object" {
                continue;
            }
            // The peer takes minutes for 10 000 objects at full size.
            let width = if name == "s5b" && what == "object" {
                options.width / 2
            } else {
                options.width
            };
            eprintln!("{name}, {what}");
            let scene = sized(name, width, what == "object")?;
            // The peer of objects alone gives their depth and normals.
            let channels: &[Channel] = match what {
                "object" => &[Channel::Depth, Channel::Normal],
                _ => &[Channel::Beauty],
            };
            let times = times(&scene, options.rounds, channels)?;
            all.push(Timed {
                scene: name.into(),
                what,
                times,
            });
        }
    }
    Ok(all)
}

/// The table of targets.
pub fn section(options: &Options, pictures: &[Timed], peers: &Peers, errors: &[Judged]) -> String {
    let head = [
        "scene",
        "picture",
        "peer",
        "peer, s",
        "ours, ms",
        "times as fast",
        "target",
        "reached",
        "p99 error, px",
        "wrong rays",
    ];
    // Their figures are for one size.
    let nobody = Peers::default();
    let theirs = if options.width == PEERS_WIDTH {
        peers
    } else {
        &nobody
    };
    let rows: Vec<Vec<String>> = TARGETS
        .iter()
        .map(|t| row(t, pictures, theirs, errors))
        .collect();
    let (width, height) = (options.width, options.width * 9 / 16);
    let mut text = format!("\n## Against peers, one thread\n\n{width} x {height}:\n\n");
    for (name, what) in SCENES {
        text.push_str(&format!("- {name}: {what}\n"));
    }
    text.push_str(&format!("\n{}", markdown(&head, 3, &rows)));
    text.push_str(&format!(
        "\nThe error is that of the depth of camera rays in widths of a pixel at {} wide, against the reference; wrong are \
         false hits, false misses and unknown rays of the same picture.\n",
        options.accuracy_width
    ));
    text
}

fn row(target: &Target, pictures: &[Timed], peers: &Peers, errors: &[Judged]) -> Vec<String> {
    let Target {
        scene,
        what,
        peer,
        times,
    } = target;
    let ours = pictures
        .iter()
        .find(|p| p.scene == *scene && p.what == *what)
        .map(|p| p.times[0]);
    let theirs = peers.value(scene, what, peer);
    let ratio = ours
        .zip(theirs)
        .map(|(ours, theirs)| theirs * 1e3 / ours.minimum);
    let judged = errors.iter().find(|j| j.scene == *scene && j.what == *what);
    let or_not = |cell: Option<String>| cell.unwrap_or(NOT_MEASURED.into());
    let picture = match (*what, *scene) {
        ("whole", _) => "whole",
        (_, "s5b") => "object only, half as wide",
        _ => "object only",
    };
    vec![
        (*scene).into(),
        picture.into(),
        (*peer).into(),
        or_not(theirs.map(short)),
        or_not(ours.map(|s| in_words(&s))),
        or_not(ratio.map(short)),
        format!("at least {times}"),
        or_not(ratio.map(|r| verdict(r >= *times))),
        or_not(judged.map(|j| short(j.errors.depth_p99))),
        or_not(judged.map(|j| j.wrong().to_string())),
    ]
}

/// Two threads against one.
pub fn threads(pictures: &[Timed]) -> String {
    let head = [
        "scene",
        "picture",
        "1 thread, ms",
        "2 threads, ms",
        "times as fast",
        "reached",
    ];
    let row = |p: &Timed| {
        let [one, two] = &p.times;
        // Where the spreads overlap, no ratio is claimed.
        let ratio = two.ratio(one);
        vec![
            p.scene.clone(),
            p.what.into(),
            in_words(one),
            in_words(two),
            ratio.map_or("no difference".into(), short),
            verdict(ratio.is_some_and(|r| r >= TWO_THREADS)),
        ]
    };
    let rows: Vec<Vec<String>> = pictures.iter().map(row).collect();
    format!(
        "\n## Two threads\n\nTarget: at least {TWO_THREADS} times as fast as one.\n\n{}",
        markdown(&head, 2, &rows)
    )
}

/// Pictures a second of interactive scenes, on two threads.
pub fn interactive(options: &Options) -> Outcome<Vec<Vec<String>>> {
    let height = options.width * 9 / 16;
    let mut spheres = scene("../../examples/three_spheres", &[])?;
    spheres.settings.size = [options.width, height];
    spheres.settings.samples = 1;
    spheres.settings.depth = 6;
    let blend = sized("s2", options.width, false)?;
    let mut rows = Vec::new();
    for (name, scene, target) in [
        ("three spheres, depth 6", spheres, 30.0),
        ("s2", blend, 20.0),
    ] {
        eprintln!("{name}");
        let [_, two] = times(&scene, options.rounds, &[Channel::Beauty])?;
        let rate = 1e3 / two.median;
        rows.push(vec![
            format!(
                "{name}, {} x {height}, two threads: pictures a second",
                options.width
            ),
            short(rate),
            format!("at least {target}"),
            verdict(rate >= target),
        ]);
    }
    Ok(rows)
}
