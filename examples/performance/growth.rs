//! How time and memory grow with the number of objects.

use crate::pictures::times;
use crate::scenes::{NOT_MEASURED, in_words, scene, verdict, world};
use crate::{Options, Outcome};
use fieldstone::output::{markdown, short};
use fieldstone::render::{Channel, Hits, Spread};
use std::process::Command;
use std::time::Instant;

/// The numbers of objects.
const NUMBERS: [u32; 5] = [100, 316, 1000, 3162, 10_000];

/// How much the time may grow from the fewest to the most, the bytes that a primitive may take, and the seconds in which the
/// most have to be loaded and compiled.
const GROWTH: f64 = 3.0;
const BYTES: f64 = 2048.0;
const SECONDS: f64 = 0.2;

/// The word that asks a process of this program for the memory of a scene.
const MEMORY: &str = "memory-of";

/// The number of objects whose memory this process is asked for, if it is.
pub fn asked_for_memory() -> Option<String> {
    let mut arguments = std::env::args().skip(1);
    (arguments.next()? == MEMORY)
        .then(|| arguments.next())
        .flatten()
}

/// Prints by how many bytes this process grows when it loads and compiles so many objects.
pub fn tell_memory(n: &str) -> Outcome<()> {
    let before = resident().ok_or("no memory figures")?;
    let scene = scene("s5a", &[("n", n.into()), ("object_only", "1".into())])?;
    let world = world(&scene)?;
    let after = resident().ok_or("no memory figures")?;
    println!("{}", after.saturating_sub(before));
    drop(world);
    Ok(())
}

/// The bytes of memory that this process occupies, where the system tells.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim()
        .strip_suffix("kB")?
        .trim()
        .parse::<u64>()
        .ok()
        .map(|kib| kib * 1024)
}

/// The bytes of so many objects, from a process of their own.
fn bytes(n: u32) -> Option<f64> {
    let program = std::env::current_exe().ok()?;
    let output = Command::new(program)
        .args([MEMORY, &n.to_string()])
        .output()
        .ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// Milliseconds of loading and compiling, each the smallest of the rounds.
fn stages(n: u32, rounds: u16) -> Outcome<[f64; 2]> {
    let mut best = [f64::INFINITY; 2];
    for _ in 0..rounds {
        let start = Instant::now();
        let scene = scene("s5a", &[("n", n.to_string()), ("object_only", "1".into())])?;
        let loaded = start.elapsed();
        drop(world(&scene)?);
        let compiled = start.elapsed() - loaded;
        best = [
            best[0].min(loaded.as_secs_f64() * 1e3),
            best[1].min(compiled.as_secs_f64() * 1e3),
        ];
    }
    Ok(best)
}

/// The table of growth.
pub fn section(options: &Options) -> Outcome<String> {
    let mut rows = Vec::new();
    let mut pictures: Vec<Spread> = Vec::new();
    let (mut last_bytes, mut last_stages) = (None, [0.0; 2]);
    for n in NUMBERS {
        eprintln!("{n} objects");
        last_stages = stages(n, options.rounds)?;
        let [load, compile] = last_stages;
        let parameters = [
            ("n", n.to_string()),
            ("object_only", "1".into()),
            ("width", options.width.to_string()),
        ];
        let scene = scene("s5a", &parameters)?;
        let [one, _] = times(&scene, options.rounds, &[Channel::Beauty])?;
        pictures.push(one);
        let hits = Hits::of(&scene, &world(&scene)?, 0);
        let covered = 100.0 * hits.census.hits as f64 / hits.rays.len() as f64;
        last_bytes = bytes(n).map(|b| b / f64::from(n));
        rows.push(vec![
            n.to_string(),
            short(load),
            short(compile),
            in_words(&one),
            format!("{covered:.1}"),
            short(hits.evaluations()),
            last_bytes.map_or(NOT_MEASURED.into(), short),
        ]);
    }
    let head = [
        "objects",
        "load, ms",
        "compile, ms",
        "picture, ms",
        "covered, %",
        "evaluations a ray",
        "bytes a primitive",
    ];
    let table = markdown(&head, 0, &rows);
    let growth = pictures[pictures.len() - 1].median / pictures[0].median;
    let seconds = (last_stages[0] + last_stages[1]) / 1e3;
    let goals = [
        vec![
            format!("time of {} objects against {}", NUMBERS[4], NUMBERS[0]),
            format!("{} times", short(growth)),
            format!("at most {GROWTH} times"),
            verdict(growth <= GROWTH),
        ],
        vec![
            format!("memory of {} objects", NUMBERS[4]),
            last_bytes.map_or(NOT_MEASURED.into(), |b| format!("{} bytes each", short(b))),
            format!("at most {BYTES} bytes each"),
            last_bytes.map_or(NOT_MEASURED.into(), |b| verdict(b <= BYTES)),
        ],
        vec![
            format!("load and compile of {} objects", NUMBERS[4]),
            format!("{} s", short(seconds)),
            format!("at most {SECONDS} s"),
            verdict(seconds <= SECONDS),
        ],
    ];
    let goals = markdown(&["growth", "measured", "target", "reached"], 1, &goals);
    Ok(format!(
        "\n## Growth\n\nA hard union of n spheres, boxes and tori in the same space, the smaller the more there are; they cover more \
         of the picture then, which the target does not ask for: `benches/scenes/s5a.sdf -D object_only=1 -D n=...`, one thread. Memory is by how much a process grows when it loads and compiles \
         them.\n\n{table}\n{goals}"
    ))
}
