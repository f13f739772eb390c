//! The reference is what the declarations say, and its pictures are what the program renders.

mod pictures;

use fieldstone::lang::{Loaded, Word, load_text};
use fieldstone::trace::SceneTracer;
use image::RgbImage;
use pictures::{rendered, root, stored, text_of};
use rayon::prelude::*;
use std::path::PathBuf;
use std::process::Command;

/// The words that make, join or change shapes.
fn entries() -> Vec<Word> {
    let mut all = Word::all();
    all.retain(|word| word.scene().is_some());
    all
}

fn loaded(word: &Word) -> Loaded {
    let scene = word.scene().expect("an entry of the catalogue");
    match load_text(word.name, &scene, &[], &SceneTracer::default()) {
        Ok(loaded) => loaded,
        Err(report) => panic!("{report}"),
    }
}

fn picture_of(word: &Word) -> PathBuf {
    root()
        .join("docs/reference")
        .join(word.name)
        .with_extension("png")
}

/// `FIELDSTONE_BLESS=1 cargo test --test reference` writes the page anew.
#[test]
fn the_page_is_what_the_declarations_say() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
    let output = command.args(["reference", "--markdown"]).output();
    let page = String::from_utf8(output.expect("the command runs").stdout).expect("text");
    assert!(page.len() > 1000, "{page}");
    let path = root().join("docs/reference.md");
    if std::env::var_os("FIELDSTONE_BLESS").is_some() {
        std::fs::write(&path, &page).expect("docs is writable");
    }
    let stored = std::fs::read_to_string(&path).expect("docs/reference.md");
    assert!(
        stored == page,
        "stale: `FIELDSTONE_BLESS=1 cargo test --test reference` writes it anew"
    );
    let pictures = page.split("src=\"reference/").skip(1);
    let names: Vec<&str> = pictures.filter_map(|rest| rest.split('"').next()).collect();
    assert!(names.len() > 90, "{} pictures", names.len());
    for name in names {
        assert!(root().join("docs/reference").join(name).exists(), "{name}");
    }
}

#[test]
fn every_example_is_certified() {
    for word in entries() {
        let loaded = loaded(&word);
        let entry = &loaded.names["entry"];
        assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
        assert!(entry.lipschitz().is_finite(), "{}", word.name);
        assert!(
            !entry.traits().is_planar,
            "{}: a profile is not seen",
            word.name
        );
    }
}

#[test]
fn every_entry_has_a_picture_and_every_picture_an_entry() {
    let mut expected: Vec<PathBuf> = entries().iter().map(picture_of).collect();
    expected.sort();
    let found = std::fs::read_dir(root().join("docs/reference")).expect("the pictures");
    let mut found: Vec<PathBuf> = found.flatten().map(|entry| entry.path()).collect();
    found.sort();
    let names = |all: &[PathBuf], others: &[PathBuf]| {
        let lonely = all.iter().filter(|path| !others.contains(path));
        lonely
            .map(|path| path.display().to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        names(&expected, &found),
        [""; 0],
        "entries without a picture"
    );
    assert_eq!(
        names(&found, &expected),
        [""; 0],
        "pictures without an entry"
    );
}

/// How much smaller a picture is rendered to be compared.
const SHRINK: u32 = 4;

/// How many pixels of the smaller picture are compared together, in each direction.
const BLOCK: u32 = 5;

/// The picture `SHRINK` times smaller, each pixel the mean of those around its place: the outermost pixels lie on the
/// border of the screen at any size.
fn shrunk(image: &RgbImage) -> RgbImage {
    let [w, h] = [image.width() / SHRINK, image.height() / SHRINK];
    let place = |i: u32, n: u32, all: u32| f64::from(i * (all - 1)) / f64::from(n - 1);
    // How much of a pixel at `i` lies within half a small pixel around `centre`.
    let share = |i: u32, centre: f64, n: u32, all: u32| {
        let half = 0.5 * f64::from(all - 1) / f64::from(n - 1);
        let (low, high) = (f64::from(i) - 0.5, f64::from(i) + 0.5);
        (high.min(centre + half) - low.max(centre - half)).max(0.0)
    };
    RgbImage::from_fn(w, h, |x, y| {
        let (cx, cy) = (place(x, w, image.width()), place(y, h, image.height()));
        let mut sum = [0.0; 4];
        for (i, j, color) in image.enumerate_pixels() {
            let weight = share(i, cx, w, image.width()) * share(j, cy, h, image.height());
            if weight > 0.0 {
                for (s, c) in sum
                    .iter_mut()
                    .zip(color.0.map(f64::from).into_iter().chain([1.0]))
                {
                    *s += weight * c;
                }
            }
        }
        image::Rgb([0, 1, 2].map(|c| (sum[c] / sum[3]).round() as u8))
    })
}

/// How far the two pictures are apart, of 255, in the block of pixels where they differ most.
fn difference(a: &RgbImage, b: &RgbImage) -> f64 {
    let mean = |image: &RgbImage, x: u32, y: u32, c: usize| {
        let places = (0..BLOCK * BLOCK).map(|i| (x + i % BLOCK, y + i / BLOCK));
        let sum: f64 = places
            .map(|(x, y)| f64::from(image.get_pixel(x, y).0[c]))
            .sum();
        sum / f64::from(BLOCK * BLOCK)
    };
    let corners = |n: u32| (0..n).step_by(BLOCK as usize);
    let mut most: f64 = 0.0;
    for (x, y) in corners(a.width()).flat_map(|x| corners(a.height()).map(move |y| (x, y))) {
        for c in 0..3 {
            most = most.max((mean(a, x, y, c) - mean(b, x, y, c)).abs());
        }
    }
    most
}

#[test]
fn pictures_are_not_stale() {
    /// Measured: 1 to 5, and 10 for the fine holes of `sierpinski`.
    const MOST: f64 = 12.0;
    let stale = entries().into_par_iter().filter_map(|word| {
        let picture = stored(&picture_of(&word));
        let mut loaded = loaded(&word);
        let settings = &mut loaded.scene.settings;
        assert_eq!(
            picture.dimensions(),
            (settings.size[0], settings.size[1]),
            "{}",
            word.name
        );
        settings.size = settings.size.map(|side| side / SHRINK);
        let apart = difference(&rendered(word.name, &loaded), &shrunk(&picture));
        println!("{}: {apart:.2}", word.name);
        let is_told = text_of(&picture_of(&word), "Source").as_deref() == Some(word.example);
        (apart > MOST || !is_told).then(|| format!("reference/{}", word.name))
    });
    let stale: Vec<String> = stale.collect();
    assert!(
        stale.is_empty(),
        "`cargo run --release --example pictures {}` renders them anew",
        stale.join(" ")
    );
}

#[test]
fn reference_answers() {
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
        let output = command.arg("reference").args(arguments).output();
        let output = output.expect("the command runs");
        let text = |bytes| String::from_utf8(bytes).expect("text");
        (
            output.status.code(),
            text(output.stdout),
            text(output.stderr),
        )
    };
    let (code, overview, _) = run(&[]);
    assert_eq!(code, Some(0));
    for word in Word::all() {
        let starts = format!("\n  {} ", word.name);
        assert!(overview.contains(&starts), "{}", word.name);
    }
    assert!(overview.lines().all(|line| line.chars().count() <= 100));
    let (code, torus, _) = run(&["torus"]);
    assert_eq!(code, Some(0));
    assert!(torus.starts_with("torus(major: 0.75, minor: 0.25)\n"));
    let (code, out, err) = run(&["tours"]);
    assert_eq!((code, &out[..]), (Some(2), ""));
    assert!(
        err.contains("`tours`") && err.contains("did you mean `torus`?"),
        "{err}"
    );
    let (code, json, _) = run(&["torus", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(code, Some(0));
    assert_eq!(json[0]["parameters"][1]["default"], "0.25");
}

#[test]
fn one_word_is_one_section_of_the_page() {
    let page =
        std::fs::read_to_string(root().join("docs/reference.md")).expect("docs/reference.md");
    for name in ["torus", "displace"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fieldstone"));
        let output = command.args(["reference", name, "--markdown"]).output();
        let section = String::from_utf8(output.expect("the command runs").stdout).expect("text");
        assert!(section.starts_with(&format!("\n### {name}\n")), "{section}");
        assert!(page.contains(&section), "{section}");
    }
}
