//! Golden pictures: small scenes that together use every feature, compared to the bit.
//!
//! They guard, they do not prove: the laws are in the other tests. `FIELDSTONE_BLESS=1 cargo test --test golden` renders
//! them anew; look at each before it is committed. On a difference, expected | difference | actual is written into the
//! folder of build products.

use fieldstone::lang;
use fieldstone::output::{Metadata, encode, picture};
use fieldstone::render::{Channel, RenderOptions, render};
use fieldstone::trace::{SceneTracer, World};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(folder()).expect("the folder of golden scenes");
    let mut scenes: Vec<PathBuf> = entries
        .flatten()
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "sdf"))
        .collect();
    scenes.sort();
    scenes
}

/// The picture of a scene, and how many of its rays ended without an answer.
fn rendered(path: &Path) -> (RgbImage, u64) {
    let loaded = match lang::load(path, &[], &SceneTracer::default()) {
        Ok(loaded) => loaded,
        Err(error) => panic!("{}: {error}", path.display()),
    };
    let world = World::new(&loaded.scene).expect("a world");
    let options = RenderOptions {
        channels: &[Channel::Beauty],
        threads: 2,
        ..RenderOptions::default()
    };
    let done = render(&loaded.scene, &world, &options);
    let picture = picture(&done.film, Channel::Beauty).expect("beauty was recorded");
    (picture.image, done.statistics.unknown_pixels)
}

/// Expected, where they differ, actual: side by side.
fn comparison(expected: &RgbImage, actual: &RgbImage) -> RgbImage {
    let (w, h) = (
        expected.width().max(actual.width()),
        expected.height().max(actual.height()),
    );
    let at = |image: &RgbImage, x, y| {
        image
            .get_pixel_checked(x, y)
            .copied()
            .unwrap_or(Rgb([255, 0, 255]))
    };
    RgbImage::from_fn(3 * w, h, |x, y| {
        let (e, a) = (at(expected, x % w, y), at(actual, x % w, y));
        match x / w {
            0 => e,
            1 if e == a => Rgb([0, 0, 0]),
            1 => Rgb([255, 255, 255]),
            _ => a,
        }
    })
}

#[test]
fn pictures_are_as_they_were() {
    let is_blessing = std::env::var_os("FIELDSTONE_BLESS").is_some();
    let scenes = scenes();
    assert!(scenes.len() >= 7, "only {} golden scenes", scenes.len());
    let mut changed = Vec::new();
    for scene in scenes {
        let golden = scene.with_extension("png");
        let (actual, unknown) = rendered(&scene);
        assert_eq!(unknown, 0, "{}: rays without an answer", scene.display());
        assert!(
            actual.width() <= 96 && actual.height() <= 96,
            "{}",
            scene.display()
        );
        if is_blessing {
            let bytes = encode(&actual, &Metadata::default()).expect("a picture encodes");
            fs::write(&golden, bytes).expect("the folder is writable");
            continue;
        }
        let expected = image::open(&golden)
            .expect("a golden picture beside each scene")
            .to_rgb8();
        if expected != actual {
            let name = scene
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let shown = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
            comparison(&expected, &actual)
                .save(&shown)
                .expect("the comparison is written");
            changed.push(format!("{name}: see {}", shown.display()));
        }
    }
    assert!(changed.is_empty(), "{}", changed.join("\n"));
}

#[test]
fn a_changed_pixel_is_seen() {
    let black = RgbImage::new(2, 1);
    let mut other = black.clone();
    other.put_pixel(1, 0, Rgb([0, 0, 1]));
    let sheet = comparison(&black, &other);
    assert_eq!(sheet.get_pixel(3, 0), &Rgb([255, 255, 255]));
    assert_eq!(sheet.get_pixel(2, 0), &Rgb([0, 0, 0]));
}
