//! Every example is what it promises: short, free of warnings, certain of every pixel, with its picture beside it.

use fieldstone::lang::{Loaded, load, load_text};
use fieldstone::output::picture;
use fieldstone::render::{Channel, RenderOptions, render};
use fieldstone::trace::{SceneTracer, World};
use image::imageops::{FilterType, resize};
use image::{ImageReader, RgbImage};
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scripts() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("examples")).expect("the examples");
    let mut found: Vec<PathBuf> = entries
        .flatten()
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "sdf"))
        .collect();
    found.sort();
    assert!(found.len() >= 12, "only {} examples", found.len());
    found
}

fn loaded(path: &Path) -> Loaded {
    match load(path, &[], &SceneTracer::default()) {
        Ok(loaded) => loaded,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

fn stored(path: &Path) -> RgbImage {
    let image = ImageReader::open(path).unwrap_or_else(|_| panic!("{} is missing", path.display()));
    image.decode().expect("a readable picture").to_rgb8()
}

#[test]
fn scripts_are_short_and_say_what_is_seen() {
    for path in scripts() {
        let text = std::fs::read_to_string(&path).expect("a script");
        assert!(
            text.starts_with("// "),
            "{}: no comment first",
            path.display()
        );
        assert!(
            text.lines().count() <= 60,
            "{}: {} lines",
            path.display(),
            text.lines().count()
        );
    }
}

#[test]
fn scripts_load_without_a_warning_and_pass_their_tests() {
    for path in scripts() {
        let loaded = loaded(&path);
        assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
        for result in loaded.run_tests(&SceneTracer::default()) {
            assert!(result.passed(), "{}: {}", path.display(), result.name);
        }
    }
}

#[test]
fn every_example_is_shown_in_the_readme() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("the README");
    for path in scripts() {
        let name = path.file_stem().expect("a name").to_string_lossy();
        assert!(
            readme.contains(&format!("examples/{name}.sdf")),
            "{name}.sdf"
        );
        assert!(
            readme.contains(&format!("docs/thumbnails/{name}.png")),
            "{name}.png"
        );
    }
}

/// The picture beside each script is what the program renders now: rendered at a quarter of the size and compared after
/// both are scaled down to 40 points across. Both sample the same image, at places that differ by up to two pixels (the
/// outermost pixels lie on the border of the screen at any size); on the average the points must agree to 5 of 255 (fine patterns are the worst: 3.5).
/// `cargo run --release --example pictures` renders them anew.
#[test]
fn pictures_are_not_stale() {
    const SHRINK: u32 = 4;
    const MOST: f64 = 5.0;
    for path in scripts() {
        let expected = stored(&path.with_extension("png"));
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let thumbnail = stored(&root().join("docs/thumbnails").join(format!("{name}.png")));
        assert_eq!((expected.width(), thumbnail.width()), (640, 256), "{name}");
        let mut loaded = loaded(&path);
        let scene = &mut loaded.scene;
        assert_eq!(
            scene.settings.size,
            [expected.width(), expected.height()],
            "{name}"
        );
        scene.settings.size = scene.settings.size.map(|side| side / SHRINK);
        let world = World::new(scene).expect("a world");
        let done = render(scene, &world, &RenderOptions::default());
        assert_eq!(done.statistics.unknown_pixels, 0, "{name}: unknown pixels");
        let actual = picture(&done.film, Channel::Beauty)
            .expect("beauty was recorded")
            .image;
        let coarse = |image: &RgbImage| {
            resize(
                image,
                40,
                40 * image.height() / image.width(),
                FilterType::Triangle,
            )
        };
        let (actual, expected) = (coarse(&actual), coarse(&expected));
        let sum: f64 = actual
            .iter()
            .zip(expected.iter())
            .map(|(a, b)| f64::from(a.abs_diff(*b)))
            .sum();
        let mean = sum / actual.len() as f64;
        assert!(mean <= MOST, "{name}: differs by {mean:.2} on the average");
    }
}

/// What stands between lines of three backquotes.
fn blocks(text: &str) -> Vec<String> {
    text.split("```\n")
        .skip(1)
        .step_by(2)
        .map(str::to_string)
        .collect()
}

#[test]
fn the_readme_shows_what_the_program_does() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("the README");
    let blocks = blocks(&readme);
    let first = std::fs::read_to_string(root().join("docs/first.sdf")).expect("the first script");
    assert!(
        blocks.contains(&first),
        "the README's script is not docs/first.sdf"
    );
    assert_eq!(stored(&root().join("docs/first.png")).width(), 640);
    assert!(stored(&root().join("docs/hero.png")).width() > 0);
    // The taste of the language loads; what it imports is not there.
    let taste = blocks
        .iter()
        .find(|b| b.contains("the blend is certified"))
        .expect("the taste of the language");
    let taste: String = taste
        .lines()
        .filter(|l| !l.starts_with("import"))
        .map(|l| format!("{l}\n"))
        .collect();
    let loaded = load_text("taste.sdf", &taste, &[], &SceneTracer::default());
    assert!(loaded.as_ref().is_ok_and(|l| {
        l.run_tests(&SceneTracer::default())
            .iter()
            .all(|r| r.passed())
    }));
    // The mistake is answered as printed.
    let answer = blocks
        .iter()
        .find(|b| b.contains("ring.sdf"))
        .expect("the answer to a mistake");
    let report = load_text(
        "ring.sdf",
        "show torus(minor: -0.2)\n",
        &[],
        &SceneTracer::default(),
    );
    let report = report.err().map(|e| e.to_string()).unwrap_or_default();
    assert_eq!(report.trim_end(), answer.trim_end());
}
