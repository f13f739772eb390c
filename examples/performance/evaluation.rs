//! How fast fields are evaluated.

use crate::Outcome;
use crate::peers::Peers;
use crate::scenes::{NOT_MEASURED, sized, verdict};
use fieldstone::field::Packets;
use fieldstone::output::{markdown, short};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The share of the hand-written loop's speed that has to be reached.
const SHARE: f64 = 0.75;

/// How many points are evaluated in turn: they stay in the processor's cache.
const POINTS: usize = 2048;

/// How many samples are taken, and how long one takes.
const SAMPLES: usize = 9;
const SAMPLE: Duration = Duration::from_millis(100);

/// Points in [-2.5, 2.5]^3 by the linear congruential generator of the scenes.
fn points() -> Vec<[f64; 3]> {
    let mut state = 1u32;
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX) * 5.0 - 2.5
    };
    (0..POINTS)
        .map(|_| [number(), number(), number()])
        .collect()
}

/// Million points a second: the best sample, which neighbours disturbed least.
fn rate(field: &Packets) -> f64 {
    let packets = Packets::of_points(&points());
    let sample = |_| {
        let start = Instant::now();
        let mut rounds = 0;
        while start.elapsed() < SAMPLE {
            for packet in &packets {
                black_box(field.at(black_box(packet)));
            }
            rounds += 1;
        }
        f64::from(rounds) * POINTS as f64 / start.elapsed().as_secs_f64() / 1e6
    };
    (0..SAMPLES).map(sample).fold(0.0, f64::max)
}

/// The table of evaluation.
pub fn section(peers: &Peers) -> Outcome<String> {
    let scene = sized("s2", 640, true)?;
    let node = scene.shown.first().ok_or("s2 shows its object")?;
    let ours = rate(&Packets::new(node));
    let mut rows = vec![vec![
        "compiled closures".to_string(),
        short(ours),
        String::new(),
        String::new(),
    ]];
    for (peer, target) in [
        ("hand-written loop", Some(SHARE)),
        ("fidget", None),
        ("scalar", None),
    ] {
        let theirs = peers.value("s2", "evaluation", peer);
        let share = theirs.map(|t| ours / t);
        rows.push(vec![
            peer.into(),
            theirs.map_or(NOT_MEASURED.into(), short),
            share.map_or(NOT_MEASURED.into(), short),
            match (target, share) {
                (Some(target), Some(share)) => {
                    format!("at least {target}: {}", verdict(share >= target))
                }
                (Some(target), None) => format!("at least {target}"),
                _ => String::new(),
            },
        ]);
    }
    let head = [
        "by",
        "million points a second",
        "ours, times as fast",
        "target",
    ];
    Ok(format!(
        "\n## Evaluation\n\nThe field of s2, one thread, {POINTS} points over and over.\n\n{}",
        markdown(&head, 1, &rows)
    ))
}
