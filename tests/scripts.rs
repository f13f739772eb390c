//! Scripts from outside: the example of the language contract, and wrong scripts with their exact messages.

mod stub;

use fieldstone::lang::{self, LoadError};
use std::fs;
use std::path::Path;
use stub::Marcher;

/// The example of the language contract.
const CONTRACT: &str = r##"// gyroid_ball.sdf - a brass gyroid inside a glass shell on a checkered floor
param cells = 5 in 1..=12 "gyroid cells across the ball"

field gyroid(p) {
  let q = p * (cells * 3.14159265)
  return (sin(q.x) * cos(q.y) + sin(q.y) * cos(q.z) + sin(q.z) * cos(q.x)) / (cells * 3.14159265)
}

material brass { color: #d9a441, specular: 0.6, shininess: 80, reflect: 0.2 }
material glass { color: #000000, ambient: 0, diffuse: 0, specular: 0.8, shininess: 200, refract: 0.9, reflect: 0.1, ior: 1.5 }
material floor { color: checker(#e8e8e8, #404850, size: 0.5), reflect: 0.1 }

let core = gyroid.shell(0.05) & sphere(0.9)
let studs = for i in 0..8 { sphere(0.12).translate([1.4, 0.12, 0]).rotate(y: i * 45deg) }

show core.translate([0, 1, 0]).paint(brass)
show sphere(1.0).translate([0, 1, 0]).paint(glass)
show studs.paint(brass)
show plane("y", 0).paint(floor)

camera { eye: [3.2, 2.2, 4.4], at: [0, 0.8, 0], fov: 38deg }
light { position: [5, 8, 3] }
light { toward: [-1, 2, 1], intensity: 0.3 }
sky { horizon: #dfe8f5, zenith: #6f9fd8 }
render { size: [960, 540] }

test "the core is certified" { expect core.lipschitz <= 1.8 }
"##;

#[test]
fn the_example_of_the_contract_loads() {
    let loaded = lang::load_text("gyroid_ball.sdf", CONTRACT, &[], &Marcher)
        .unwrap_or_else(|report| panic!("{report}"));
    assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
    let scene = &loaded.scene;
    // A core, a shell, eight studs and a floor.
    assert_eq!(scene.shown.len(), 11);
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.settings.size, [960, 540]);
    assert_eq!(scene.camera.eye.to_array(), [3.2, 2.2, 4.4]);
    assert_eq!(loaded.parameters, [("cells".into(), "5".into())]);
    let names: Vec<_> = loaded.names.keys().collect();
    assert_eq!(names, ["core", "gyroid", "studs"]);
    assert_eq!(loaded.tests(), ["the core is certified"]);
    for result in loaded.run_tests(&Marcher) {
        assert!(result.passed(), "{}", result.failures);
    }
}

#[test]
fn a_file_that_is_not_there_is_no_error_of_the_script() {
    let path = Path::new("tests/errors/no_such_script.sdf");
    match lang::load(path, &[], &Marcher) {
        Err(LoadError::Io { path: named, .. }) => assert_eq!(named, path),
        other => panic!("{other:?}"),
    }
}

/// What is said about a script: its report, or its warnings and what its tests say.
fn said(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a script");
    // The first line may say what the command line sets.
    let first = text.lines().next().unwrap_or("");
    let overrides: Vec<(String, String)> = first
        .strip_prefix("// -D ")
        .and_then(|setting| setting.split_once('='))
        .map(|(name, value)| (name.into(), value.into()))
        .into_iter()
        .collect();
    match lang::load(path, &overrides, &Marcher) {
        Err(LoadError::Script(report)) => report.to_string(),
        Err(error) => error.to_string(),
        Ok(loaded) => {
            let mut text = loaded.warnings.to_string();
            for result in loaded.run_tests(&Marcher) {
                let verdict = if result.passed() { "passed" } else { "failed" };
                text.push_str(&format!("test {}: {verdict}\n", result.name));
                text.push_str(&result.failures.to_string());
            }
            text
        }
    }
}

/// Every `tests/errors/*.sdf` says exactly what stands in the text file beside it. To write these files anew, run
/// with `FIELDSTONE_BLESS=1` and read the differences.
#[test]
fn wrong_scripts_say_what_is_wrong() {
    let folder = Path::new("tests/errors");
    let is_blessed = std::env::var_os("FIELDSTONE_BLESS").is_some();
    let mut scripts: Vec<_> = fs::read_dir(folder)
        .expect("tests/errors is a folder")
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "sdf"))
        .collect();
    scripts.sort();
    assert!(scripts.len() >= 90, "only {} scripts", scripts.len());
    let mut wrong = Vec::new();
    for script in scripts {
        let expectation = script.with_extension("txt");
        let said = said(&script);
        assert!(!said.is_empty(), "{} is not wrong", script.display());
        if is_blessed {
            fs::write(&expectation, &said).expect("tests/errors is writable");
        }
        let expected = fs::read_to_string(&expectation).unwrap_or_default();
        if said != expected {
            let name = script.display();
            wrong.push(format!(
                "--- {name} should say\n{expected}--- but says\n{said}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
