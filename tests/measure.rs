//! What the commands that measure answer: counts and refusals, never times.

use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;

/// A ball on a floor, partly in shadow, partly mirrored.
const SCENE: &str = r##"
param radius = 1 in 0.1..=5
material shiny { color: #c06020, reflect: 0.3 }
let ball = box(1.2 * radius, round: 0.3)
show ball.translate([0, 1, 0]).paint(shiny)
show plane("y", 0)
camera { eye: [0, 2, 8], at: [0, 1, 0] }
light { position: [3, 5, 4] }
render { size: [32, 24] }
"##;

/// An empty folder that goes away again.
struct Folder(PathBuf);

impl Folder {
    /// The folder with `scene.sdf` in it.
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("fieldstone-measure-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("scene.sdf"), SCENE).unwrap();
        Self(path)
    }

    /// What the command answers and says, if it ends with `code`.
    fn run(&self, arguments: &[&str], code: i32) -> [String; 2] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
        let output = command
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .unwrap();
        let [out, err] =
            [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!(
            output.status.code(),
            Some(code),
            "{arguments:?}: {out}{err}"
        );
        [out, err]
    }

    fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.run(arguments, 0)[0]).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn bench_counts_what_render_counts() {
    let folder = Folder::new("counts");
    let arguments = [
        "bench",
        "scene.sdf",
        "--rounds",
        "2",
        "--threads",
        "1,2",
        "--methods",
        "auto,sphere,auto",
        "--json",
    ];
    let answer = folder.json(&arguments);
    let cases = answer["scenes"][0]["cases"].as_array().unwrap();
    let names: Vec<_> = cases
        .iter()
        .map(|c| {
            (
                c["method"].as_str().unwrap(),
                c["threads"].as_u64().unwrap(),
            )
        })
        .collect();
    assert_eq!(
        names,
        [("auto", 1), ("auto", 2), ("sphere", 1), ("sphere", 2)]
    );
    for case in cases {
        let method = case["method"].as_str().unwrap();
        folder.run(
            &[
                "render",
                "scene.sdf",
                "-q",
                "--method",
                method,
                "--stats",
                "s.json",
            ],
            0,
        );
        let stats = std::fs::read_to_string(folder.0.join("s.json")).unwrap();
        let stats: Value = serde_json::from_str(&stats).unwrap();
        let rays = &stats["rays"];
        assert_eq!(case["rays"]["primary"]["number"], rays["primary"]);
        assert_eq!(case["rays"]["shadow"]["number"], rays["shadow"]);
        let secondary = rays["reflected"].as_u64().unwrap() + rays["refracted"].as_u64().unwrap();
        assert!(secondary > 0);
        assert_eq!(case["rays"]["secondary"]["number"], secondary);
        assert_eq!(case["evaluations"], stats["evaluations"]);
        assert_eq!(case["render"]["rounds"], 2);
    }
}

#[test]
fn bench_refuses_a_ratio_of_few_rounds() {
    let folder = Folder::new("refuses");
    let arguments = [
        "bench",
        "scene.sdf",
        "--rounds",
        "3",
        "--methods",
        "auto,sphere",
    ];
    let [answer, _] = folder.run(&arguments, 0);
    assert!(
        answer.starts_with("scene.sdf, 32 x 24, 3 rounds\n"),
        "{answer}"
    );
    assert!(answer.contains("no difference"), "{answer}");
    assert!(!answer.contains("times as fast"), "{answer}");
}

#[test]
fn bench_takes_parameters_and_size() {
    let folder = Folder::new("parameters");
    let arguments = [
        "bench",
        "scene.sdf",
        "-D",
        "radius=2",
        "--size",
        "8x6",
        "--rounds",
        "1",
        "--json",
    ];
    let answer = folder.json(&arguments);
    assert_eq!(answer["scenes"][0]["parameters"]["radius"], "2");
    assert_eq!(
        answer["scenes"][0]["cases"][0]["rays"]["primary"]["number"],
        48
    );
    let [_, err] = folder.run(&["bench", "scene.sdf", "-D", "radius=99"], 2);
    assert!(err.contains("radius"), "{err}");
    folder.run(&["bench", "scene.sdf", "--rounds", "0"], 2);
    folder.run(&["bench", "scene.sdf", "--methods", "magic"], 2);
    folder.run(&["bench", "missing.sdf", "--json"], 1);
}

#[test]
fn times_of_tracing_are_told_by_kind_of_ray() {
    let folder = Folder::new("kinds");
    folder.run(&["render", "scene.sdf", "-q", "--stats", "s.json"], 0);
    let stats = std::fs::read_to_string(folder.0.join("s.json")).unwrap();
    let stats: Value = serde_json::from_str(&stats).unwrap();
    let time = |name: &str| stats["milliseconds"][name].as_f64().unwrap();
    let parts = ["trace_primary", "trace_shadow", "trace_secondary"].map(time);
    assert!(parts.iter().all(|t| *t > 0.0), "{parts:?}");
    assert!((parts.iter().sum::<f64>() - time("trace")).abs() < 1e-6 * time("trace").max(1.0));
}
