//! The bench scenes changed: other random numbers, and the same blend as people write it. Nothing is to be tuned to the scenes
//! that are timed, so these are measured beside them.

use crate::pictures::times;
use crate::scenes::{in_words, scene};
use crate::{Options, Outcome};
use fieldstone::output::{markdown, short};
use fieldstone::render::Channel;

/// A scene, what is changed, and the parameters that change it; the first of each scene is the scene as it is.
type Change = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

const CHANGES: [Change; 13] = [
    ("s2", "as it is", &[]),
    ("s2", "turned by 20 degrees", &[("turned", "20")]),
    ("s2", "scaled by 1.1", &[("scaled", "1.1")]),
    ("s2", "grown by 0.02", &[("grown", "0.02")]),
    ("s2", "seams by `cubic`", &[("seam", "\"cubic\"")]),
    ("s2", "seams by `circular`", &[("seam", "\"circular\"")]),
    ("s5a", "as it is", &[]),
    ("s5a", "seed 1", &[("seed", "1")]),
    ("s5a", "seed 2024", &[("seed", "2024")]),
    ("s5a", "seed 987654321", &[("seed", "987654321")]),
    ("s5b", "as it is", &[]),
    ("s5b", "seed 1", &[("seed", "1")]),
    ("s5b", "seed 987654321", &[("seed", "987654321")]),
];

/// The table of changed scenes: objects alone, half as wide as the pictures that are timed, on one thread.
pub fn section(options: &Options) -> Outcome<String> {
    let width = (options.width / 32 * 16).max(16).to_string();
    let mut rows = Vec::new();
    let mut first = f64::NAN;
    for (name, change, parameters) in CHANGES {
        eprintln!("{name}, {change}");
        let own = parameters
            .iter()
            .map(|(key, value)| (*key, value.to_string()));
        let common = [("object_only", "1".to_string()), ("width", width.clone())];
        let parameters: Vec<_> = common.into_iter().chain(own).collect();
        let scene = scene(name, &parameters)?;
        let [one, _] = times(&scene, options.rounds, &[Channel::Beauty])?;
        if parameters.len() == 2 {
            first = one.minimum;
        }
        rows.push(vec![
            name.to_string(),
            change.to_string(),
            in_words(&one),
            short(one.minimum / first),
        ]);
    }
    let head = ["scene", "changed", "picture, ms", "times as long"];
    let table = markdown(&head, 1, &rows);
    Ok(format!(
        "\n## Changed scenes\n\nWhat is fast is not to depend on these scenes as they are: the object alone, {width} pixels wide, on one \
         thread, with other random numbers, and with the blend as people write it. The last column compares the smallest times with those of the \
         scene as it is.\n\n{table}"
    ))
}
