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
            .env("FIELDSTONE_CACHE", "kept")
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

#[test]
fn chart_writes_all_its_forms() {
    let folder = Folder::new("chart");
    let arguments = [
        "chart",
        "scene.sdf",
        "--size",
        "24x18",
        "--methods",
        "sphere,auto",
        "--tolerances",
        "0.01,1",
        "--rounds",
        "1",
        "-q",
    ];
    let [table, said] = folder.run(&arguments, 0);
    assert_eq!(said, "");
    assert!(table.contains("### scene, 24 x 18"), "{table}");
    assert!(table.contains("| **auto** | 0.100 |"), "{table}");
    let read = |name: &str| std::fs::read(folder.0.join(name)).unwrap();
    assert_eq!(read("chart.md"), table.as_bytes());
    for name in [
        "chart.png",
        "depth-evaluations.png",
        "wrong-milliseconds.png",
    ] {
        assert!(read(name).starts_with(b"\x89PNG"), "{name}");
    }
    let svg = String::from_utf8(read("chart.svg")).unwrap();
    for words in [
        "Speed against accuracy",
        "sphere",
        "evaluations a ray",
        "scene, 24",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    let chart: Value = serde_json::from_slice(&read("chart.json")).unwrap();
    let points = chart["scenes"][0]["points"].as_array().unwrap();
    // The default's tolerance of 0.1 joins those of its method.
    let knobs: Vec<_> = points
        .iter()
        .map(|p| {
            (
                p["method"].as_str().unwrap(),
                p["tolerance"].as_f64().unwrap(),
            )
        })
        .collect();
    assert_eq!(
        knobs,
        [
            ("auto", 1.0),
            ("auto", 0.1),
            ("auto", 0.01),
            ("sphere", 1.0),
            ("sphere", 0.01)
        ]
    );
    let csv = String::from_utf8(read("chart.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + points.len());
    assert!(
        csv.starts_with("scene,width,height,method,tolerance,is_default,"),
        "{csv}"
    );
}

/// A ramp that is three times as steep as claimed where the claim is not tested: rays that come there refute it, and the points
/// of all methods are ringed. Sphere tracing steps through the ramp, and its point is grey as well.
#[test]
fn chart_rings_what_met_a_field_steeper_than_its_constant() {
    let folder = Folder::new("refuted");
    let script = "field ramp(p) lipschitz 1 { return p.y - 3 * max(p.x - 12, 0) }
        show ramp
        camera { eye: [0, 1, 0], at: [12, 2, 0] }";
    std::fs::write(folder.0.join("wrong.sdf"), script).unwrap();
    let arguments = [
        "chart",
        "wrong.sdf",
        "--size",
        "64x48",
        "--methods",
        "auto,sphere",
        "--tolerances",
        "0.1",
        "--rounds",
        "1",
        "--quiet",
    ];
    folder.run(&arguments, 0);
    let chart = std::fs::read(folder.0.join("chart.json")).unwrap();
    let chart: Value = serde_json::from_slice(&chart).unwrap();
    for point in chart["scenes"][0]["points"].as_array().unwrap() {
        assert!(point["refuted"].as_u64().unwrap() > 0, "{point}");
        let missed = point["errors"]["false_misses"].as_u64().unwrap();
        assert_eq!(missed > 0, point["method"] == "sphere", "{point}");
    }
    let svg = std::fs::read_to_string(folder.0.join("chart.svg")).unwrap();
    assert!(svg.contains("stroke=\"#C80028\"") && svg.contains("a constant refuted"));
    assert!(svg.contains("fill=\"#B2B2B8\"") && svg.contains("missed surfaces"));
}

/// Hart's hits are near a surface, not on it: the finer the tolerance, the smaller the error and the more the evaluations.
#[test]
fn chart_finds_what_theory_says_of_sphere_tracing() {
    let folder = Folder::new("theory");
    let arguments = [
        "chart",
        "scene.sdf",
        "--size",
        "48x36",
        "--methods",
        "auto,sphere",
        "--tolerances",
        "1,0.01",
        "--rounds",
        "1",
        "-q",
    ];
    folder.run(&arguments, 0);
    let chart = std::fs::read(folder.0.join("chart.json")).unwrap();
    let chart: Value = serde_json::from_slice(&chart).unwrap();
    let points = chart["scenes"][0]["points"].as_array().unwrap();
    let of = |method: &str, tolerance: f64| {
        points
            .iter()
            .find(|p| p["method"] == method && p["tolerance"].as_f64() == Some(tolerance))
            .unwrap()
    };
    let error = |p: &Value| p["errors"]["depth_p99"].as_f64().unwrap();
    let evaluations = |p: &Value| p["evaluations"].as_f64().unwrap();
    let (coarse, fine, auto) = (of("sphere", 1.0), of("sphere", 0.01), of("auto", 1.0));
    assert!(error(coarse) > 10.0 * error(fine), "{coarse} {fine}");
    assert!(evaluations(coarse) < evaluations(fine));
    assert!(error(auto) < 1e-6 && error(fine) > 1e-4);
    for count in ["false_hits", "false_misses", "unknown"] {
        assert_eq!(auto["errors"][count], 0, "{count}");
    }
    assert!(coarse["errors"]["false_hits"].as_u64().unwrap() > 0);
    assert_eq!(auto["errors"]["rays"], 48 * 36);
}

#[test]
fn chart_refuses_what_makes_no_sense() {
    let folder = Folder::new("nonsense");
    let [_, err] = folder.run(&["chart", "scene.sdf", "-o", "missing"], 1);
    assert!(err.contains("`missing`"), "{err}");
    folder.run(&["chart", "scene.sdf", "--tolerances", "0"], 2);
    folder.run(&["chart", "scene.sdf", "--errors", "beauty"], 2);
    for (option, value, words) in [
        ("--tolerances", "", "is not a number"),
        ("--tolerances", "1,,2", "is not a number"),
        ("--methods", "", "a value is required"),
        ("--methods", "magic", "possible values"),
        ("--size", "0x9", "the width must be a whole number"),
        ("--rounds", "0", "is not in 1"),
        ("--study", "magic", "possible values"),
    ] {
        let [_, err] = folder.run(&["chart", "scene.sdf", option, value], 2);
        assert!(err.contains(words), "{option} {value}: {err}");
    }
    let [_, err] = folder.run(&["chart", "missing.sdf"], 1);
    assert!(err.contains("cannot read `missing.sdf`"), "{err}");
    let [_, err] = folder.run(&["chart", "scene.sdf", "--study", "grazing"], 2);
    assert!(err.contains("without scenes"), "{err}");
    assert_eq!(std::fs::read_dir(&folder.0).unwrap().count(), 1);
    std::fs::write(folder.0.join("empty.sdf"), "let _x = 1").unwrap();
    let [_, err] = folder.run(&["chart", "empty.sdf"], 1);
    assert!(
        err.ends_with("error: `empty.sdf` shows nothing that rays could find\n"),
        "{err}"
    );
    assert_eq!(std::fs::read_dir(&folder.0).unwrap().count(), 2);
}

/// The counts of each method add up, to the last step.
#[test]
fn steps_are_put_down_to_lines_without_a_rest() {
    let folder = Folder::new("steps");
    let answer = folder.json(&["steps", "scene.sdf", "--methods", "auto,sphere", "--json"]);
    for method in answer["methods"].as_array().unwrap() {
        let name = method["method"].as_str().unwrap();
        folder.run(
            &[
                "render",
                "scene.sdf",
                "-q",
                "--method",
                name,
                "--stats",
                "s.json",
            ],
            0,
        );
        let stats = std::fs::read_to_string(folder.0.join("s.json")).unwrap();
        let stats: Value = serde_json::from_str(&stats).unwrap();
        for key in ["mean", "p99", "max", "histogram"] {
            assert_eq!(method[key], stats["steps"][key], "{name}: {key}");
        }
        let histogram = method["histogram"].as_array().unwrap();
        let all: u64 = histogram
            .iter()
            .map(|bin| bin[0].as_u64().unwrap() * bin[1].as_u64().unwrap())
            .sum();
        let causes = method["causes"].as_array().unwrap();
        let sum: u64 = causes
            .iter()
            .map(|cause| cause["steps"].as_u64().unwrap())
            .sum();
        assert_eq!(
            (sum, method["total"].as_u64().unwrap()),
            (all, all),
            "{name}"
        );
        assert!(all > 0 && !causes.is_empty());
    }
    // The box is on line 4, the floor on line 6.
    let lines: Vec<u64> = answer["methods"][1]["causes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["line"].as_u64().unwrap())
        .collect();
    assert!(lines.contains(&4) && lines.contains(&6), "{lines:?}");
    let [words, _] = folder.run(&["steps", "scene.sdf", "--methods", "auto,sphere"], 0);
    assert!(
        words.contains("steps of sphere by what they were taken for"),
        "{words}"
    );
    assert!(words.contains("100.0 %"), "{words}");
}

#[test]
fn results_of_tests_for_build_servers() {
    let folder = Folder::new("junit");
    let script =
        "show sphere(1)\ntest \"right\" { expect 1 == 1 }\ntest \"wrong\" { expect 1 == 2 }\n";
    std::fs::write(folder.0.join("tests.sdf"), script).unwrap();
    std::fs::write(folder.0.join("broken.sdf"), "show shpere(1)\n").unwrap();
    let [answer, _] = folder.run(&["test", "tests.sdf", "--json"], 1);
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(
        (&answer["passed"], &answer["failed"]),
        (&1.into(), &1.into())
    );
    let tests = &answer["scripts"][0]["tests"];
    assert_eq!(
        (&tests[0]["name"], &tests[0]["passed"]),
        (&"right".into(), &true.into())
    );
    assert!(
        tests[1]["message"]
            .as_str()
            .unwrap()
            .contains("tests.sdf:3"),
        "{tests}"
    );
    let [answer, _] = folder.run(&["test", "broken.sdf", "tests.sdf", "--junit", "r.xml"], 2);
    assert!(answer.ends_with("1 passed, 1 failed\n"), "{answer}");
    let xml = std::fs::read_to_string(folder.0.join("r.xml")).unwrap();
    assert!(
        xml.contains("tests=\"3\" failures=\"1\" errors=\"1\""),
        "{xml}"
    );
    assert!(
        xml.contains("<testcase classname=\"tests.sdf\" name=\"right\"/>"),
        "{xml}"
    );
    assert!(
        xml.contains("<testsuite name=\"broken.sdf\" tests=\"1\" failures=\"0\" errors=\"1\">"),
        "{xml}"
    );
    folder.run(&["test", "tests.sdf", "--junit", "missing/r.xml"], 1);
}

#[test]
fn studies_are_charts_of_their_own() {
    let folder = Folder::new("study");
    let [table, _] = folder.run(
        &[
            "chart",
            "--study",
            "grazing",
            "--methods",
            "auto,sphere",
            "-q",
        ],
        0,
    );
    // From height 1 to 0.0001 at 30 degrees the height halves at every step: 2^-14 is the first below, after 14 of them.
    assert!(table.contains("| 30 | 15 | 0 | 15 |"), "{table}");
    for ending in ["svg", "png", "csv"] {
        assert!(
            folder.0.join("grazing").with_extension(ending).is_file(),
            "{ending}"
        );
    }
    for study in ["samples", "constants", "precision"] {
        let [_, err] = folder.run(&["chart", "--study", study], 2);
        assert!(err.contains("which scenes?"), "{err}");
    }
    let [_, err] = folder.run(&["chart"], 2);
    assert!(err.contains("which scenes?"), "{err}");
    let arguments = [
        "chart",
        "scene.sdf",
        "--study",
        "constants",
        "--methods",
        "sphere",
        "--size",
        "16x12",
        "-q",
    ];
    let [table, _] = folder.run(&arguments, 0);
    assert!(table.contains("scene: wrong"), "{table}");
}

#[test]
fn budgets_of_steps_are_held_or_the_command_fails() {
    let folder = Folder::new("budget");
    let steps = |budget: &str, code: i32| {
        folder.run(
            &[
                "steps",
                "scene.sdf",
                "--methods",
                "auto,sphere",
                "--budget",
                budget,
            ],
            code,
        )
    };
    let answer = folder.json(&["steps", "scene.sdf", "--methods", "auto,sphere", "--json"]);
    let most = &answer["methods"][1]["max"];
    let [_, err] = steps(&format!("max={most},unknown=100000"), 0);
    assert_eq!(err, "");
    let less = most.as_u64().unwrap() - 1;
    let [answer, err] = steps(&format!("max={less}"), 1);
    assert!(
        answer.contains("steps of sphere by what they were taken for"),
        "{answer}"
    );
    assert_eq!(
        err,
        format!("error: sphere: {most} steps of a ray, and the budget is {less}\n")
    );
    steps("median=3", 2);
}

/// Straight down on a floor from height 2, the first step lands on it and the second look ends the walk.
const PLUMB: &str = "\
    show plane(\"y\", 0)\n\
    camera { eye: [0, 2, 0], at: [0, 0, 0], up: [0, 0, 1], projection: \"orthographic\" }\n\
    render { size: [24, 18], method: \"sphere\" }\n";

#[test]
fn steps_of_the_camera_in_tests() {
    let folder = Folder::new("camera-steps");
    let tests = "\
        test \"two looks\" {\n\
          expect steps(mean) == 2\n\
          expect steps(p99) == 2 and steps(max) == 2\n\
        }\n\
        test \"a ray\" {\n\
          let r = trace([1, 3, 1], [0, -2, 0])\n\
          expect r.steps == 2 and r.evaluations == 2 and r.t == 3 and r.verdict == \"hit\" and r.hit\n\
          expect r.point == [1, 0, 1] and r.normal == [0, 1, 0]\n\
          let up = trace([1, 3, 1], [0, 1, 0])\n\
          expect up.verdict == \"miss\" and up.t == infinity and not up.hit\n\
        }\n\
        budget { mean_steps: 2, p99_steps: 2, max_steps: 2, mean_evaluations: 2, unknown: 0 }\n";
    std::fs::write(folder.0.join("plumb.sdf"), format!("{PLUMB}{tests}")).unwrap();
    let [answer, _] = folder.run(&["test", "plumb.sdf"], 0);
    assert!(
        answer.ends_with("test \"budget\" ... ok\n3 passed, 0 failed\n"),
        "{answer}"
    );
}

#[test]
fn a_budget_that_is_exceeded_says_what_was_reached_and_where() {
    let folder = Folder::new("camera-budget");
    // Each step to the floor shrinks the height by 1 - sin a: the ray that looks least far down takes the most, in the first
    // row, and at the edges of it, which lie farther from the middle.
    let script = "\
        show plane(\"y\", 0)\n\
        camera { eye: [0, 2, 5], at: [0, 0, 0] }\n\
        render { size: [24, 18], method: \"sphere\" }\n\
        budget {\n  mean_steps: 3,\n  max_steps: 1000\n}\n";
    std::fs::write(folder.0.join("floor.sdf"), script).unwrap();
    let [answer, _] = folder.run(&["test", "floor.sdf", "--junit", "r.xml"], 1);
    assert!(
        answer.contains("the budget is exceeded: `mean_steps` is "),
        "{answer}"
    );
    assert!(answer.contains("floor.sdf:5:15"), "{answer}");
    assert!(answer.contains("through pixel [0, 0]"), "{answer}");
    assert!(!answer.contains("max_steps"), "{answer}");
    let xml = std::fs::read_to_string(folder.0.join("r.xml")).unwrap();
    assert!(
        xml.contains("name=\"budget\">\n      <failure message=\"error: the budget is"),
        "{xml}"
    );
    let [json, _] = folder.run(&["test", "floor.sdf", "--json"], 1);
    let json: Value = serde_json::from_str(&json).unwrap();
    let case = &json["scripts"][0]["tests"][0];
    assert_eq!(
        (&case["name"], &case["passed"]),
        (&"budget".into(), &false.into())
    );
    let [steps, _] = folder.run(&["steps", "floor.sdf", "--json"], 0);
    let steps: Value = serde_json::from_str(&steps).unwrap();
    let (reached, counted) = (&case["reached"], &steps["methods"][0]);
    for (a, b) in [
        ("mean_steps", "mean"),
        ("p99_steps", "p99"),
        ("max_steps", "max"),
        ("mean_evaluations", "evaluations"),
    ] {
        assert_eq!(reached[a], counted[b], "{a}");
    }
    let most = reached["mean_steps"].as_f64().unwrap();
    let shown: f64 = answer
        .split("`mean_steps` is ")
        .nth(1)
        .unwrap()
        .lines()
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((shown / most - 1.0).abs() < 1e-3, "{shown}, {most}");
}

#[test]
fn budgets_do_not_depend_on_threads() {
    use fieldstone::lang::load_text;
    use fieldstone::render::CameraTracer;
    for method in ["auto", "sphere"] {
        let script = format!(
            "show union(sphere(1), box(1.6), torus(2, 0.4), blend: smooth(0.3))\n\
             render {{ size: [70, 50], method: \"{method}\" }}\n\
             budget {{ unknown: 0 }}\n"
        );
        let of = |threads: usize| {
            let tracer = CameraTracer::on(threads);
            let loaded = load_text("blend.sdf", &script, &[], &tracer).unwrap();
            loaded.run_tests(&tracer)[0].record.clone().unwrap()
        };
        let alone = of(1);
        assert!(alone.mean_steps > 1.0 && alone.unknown == 0, "{alone:?}");
        assert_eq!((&alone, &alone), (&of(2), &of(5)), "{method}");
    }
}

#[test]
fn references_of_charts_are_kept() {
    let folder = Folder::new("kept");
    let arguments = [
        "chart",
        "scene.sdf",
        "--methods",
        "sphere",
        "--tolerances",
        "0.1",
        "--rounds",
        "1",
        "-q",
    ];
    let kept = || {
        let files = std::fs::read_dir(folder.0.join("kept")).unwrap();
        let mut names: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let errors = || {
        folder.run(&arguments, 0);
        let table = folder.0.join("chart.json");
        let json: Value = serde_json::from_str(&std::fs::read_to_string(table).unwrap()).unwrap();
        json["scenes"][0]["points"][0]["errors"].clone()
    };
    let first = errors();
    assert!(first.is_object(), "{first}");
    let names = kept();
    assert_eq!(names.len(), 1, "{names:?}");
    assert_eq!((errors(), kept()), (first.clone(), names.clone()));
    // What is damaged is found anew, and kept instead.
    let path = folder.0.join("kept").join(&names[0]);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    assert_eq!(errors(), first);
    assert_eq!(std::fs::read(&path).unwrap(), whole);
    folder.run(&[&arguments[..], &["-D", "radius=2"]].concat(), 0);
    assert_eq!(kept().len(), 2);
}
