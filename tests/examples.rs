//! Every example is what it promises: short, free of warnings, certain of every pixel, with its picture beside it.

mod pictures;

use fieldstone::lang::{Loaded, load, load_text};
use fieldstone::render::CameraTracer;
use fieldstone::trace::SceneTracer;
use image::RgbImage;
use image::imageops::{FilterType, resize};
use pictures::{root, stored, text_of};
use std::path::{Path, PathBuf};

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
        for result in loaded.run_tests(&CameraTracer::default()) {
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

/// How much smaller a picture is rendered to be compared.
const SHRINK: u32 = 4;

/// What the program makes of the script now, `SHRINK` times smaller.
fn rendered(path: &Path, samples: Option<u32>) -> RgbImage {
    let mut loaded = loaded(path);
    let settings = &mut loaded.scene.settings;
    settings.size = settings.size.map(|side| side / SHRINK);
    settings.samples = samples.unwrap_or(settings.samples);
    pictures::rendered(&path.display().to_string(), &loaded)
}

/// How far the pictures are apart, of 255, on the average over the points `within` (places in [0, 1]) after both are scaled
/// down to 40 points across.
fn difference(a: &RgbImage, b: &RgbImage, within: fn(f64, f64) -> bool) -> f64 {
    let [w, h] = [40, 40 * b.height() / b.width()];
    let coarse = |image: &RgbImage| resize(image, w, h, FilterType::Triangle);
    let (a, b) = (coarse(a), coarse(b));
    let place = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let differences: Vec<f64> = a
        .enumerate_pixels()
        .filter(|(x, y, _)| within(place(*x, w), place(*y, h)))
        .flat_map(|(x, y, color)| {
            let other = b.get_pixel(x, y);
            [0, 1, 2].map(|i| f64::from(color[i].abs_diff(other[i])))
        })
        .collect();
    differences.iter().sum::<f64>() / differences.len() as f64
}

/// That a picture is what the program renders now. The smaller one samples the same image at places that differ by up to two
/// pixels of the larger one, as the outermost pixels lie on the border of the screen at any size: so edges and fine patterns
/// differ. Measured: 3.5 for the endless checker of `gyroid_ball`, 0.5 to 2.5 for the others.
fn assert_fresh(name: &str, now: &RgbImage, stored: &RgbImage, within: fn(f64, f64) -> bool) {
    const MOST: f64 = 4.0;
    let size = (stored.width() / SHRINK, stored.height() / SHRINK);
    assert_eq!(now.dimensions(), size, "{name}");
    let mean = difference(now, stored, within);
    println!("{name}: {mean:.2}");
    assert!(
        mean <= MOST,
        "{name}: differs by {mean:.2} on the average; \
         `cargo run --release --example pictures {name}` renders it anew"
    );
}

#[test]
fn pictures_are_not_stale() {
    for path in scripts() {
        let picture = stored(&path.with_extension("png"));
        let name = path.file_stem().expect("a name").to_string_lossy();
        assert_eq!(picture.width(), 640, "{name}");
        assert_fresh(&name, &rendered(&path, None), &picture, |_, _| true);
    }
}

#[test]
fn thumbnails_are_the_pictures_made_small() {
    for path in scripts() {
        let picture = stored(&path.with_extension("png"));
        let name = path.file_name().expect("a name");
        let thumbnail = root().join("docs/thumbnails").join(name);
        let thumbnail = stored(&thumbnail.with_extension("png"));
        let height = 256 * picture.height() / picture.width();
        assert_eq!(thumbnail.dimensions(), (256, height), "{name:?}");
        let small = resize(&picture, 256, height, FilterType::Lanczos3);
        // Another machine may round another way.
        let differs = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 1;
        let is_other = small.iter().zip(thumbnail.iter()).any(differs);
        assert!(!is_other, "{name:?}: not the thumbnail of its picture");
    }
}

#[test]
fn pictures_of_the_readme_are_not_stale() {
    let docs = root().join("docs");
    let first = rendered(&docs.join("first.sdf"), Some(9));
    let picture = stored(&docs.join("first.png"));
    assert_fresh("first", &first, &picture, |_, _| true);
    // Only the light, that is above the line.
    let hero = rendered(&docs.join("hero.sdf"), None);
    let picture = stored(&docs.join("hero.png"));
    assert_fresh("hero", &hero, &picture, |x, y| x + y < 0.95);
}

#[test]
fn pictures_tell_how_they_were_made() {
    for path in scripts() {
        let name = path.file_name().expect("a name").to_string_lossy();
        let expected = [
            ("Software", "fieldstone "),
            ("Source", &*name),
            ("Settings", "size=640x"),
        ];
        for (keyword, part) in expected {
            let found = text_of(&path.with_extension("png"), keyword);
            let says = found.is_some_and(|text| text.starts_with(part));
            assert!(says, "{name}: {keyword}");
        }
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
        l.run_tests(&CameraTracer::default())
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
