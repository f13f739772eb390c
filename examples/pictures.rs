//! Renders what the repository shows: `cargo run --release --example pictures [NAME ...]`.
//!
//! For every script `examples/NAME.sdf` the picture beside it and a thumbnail in `docs/thumbnails`; the picture of the README's
//! first script; `docs/hero.png`: one scene cut diagonally, the shaded picture above the steps that each ray took; and for
//! every entry of the catalogue `docs/reference/NAME.png`. The names of these are `reference/NAME`, or `reference` for all.

use fieldstone::lang::{Loaded, Word, load, load_text};
use fieldstone::output::{Metadata, encode, heat, picture, write};
use fieldstone::render::{Channel, Film, RenderOptions, render};
use fieldstone::trace::{SceneTracer, World};
use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage};
use std::error::Error;
use std::path::{Path, PathBuf};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// How wide a thumbnail is, in pixels.
const THUMBNAIL: u32 = 256;

/// Samples of the README's first picture, whose script is too short to say so.
const FIRST_SAMPLES: u32 = 9;

/// A script that was rendered.
struct Shown {
    film: Film,
    beauty: RgbImage,
    metadata: Metadata,
}

impl Shown {
    fn new(path: &Path, channels: &[Channel], samples: Option<u32>) -> Outcome<Self> {
        let mut loaded =
            load(path, &[], &SceneTracer::default()).map_err(|error| error.to_string())?;
        let settings = &mut loaded.scene.settings;
        settings.samples = samples.unwrap_or(settings.samples);
        let source = path.file_name().unwrap_or_default().to_string_lossy();
        Self::of(&loaded, &source, channels)
    }

    fn of(loaded: &Loaded, source: &str, channels: &[Channel]) -> Outcome<Self> {
        let world = World::new(&loaded.scene).map_err(|fault| fault.message)?;
        let options = RenderOptions {
            channels,
            ..RenderOptions::default()
        };
        let done = render(&loaded.scene, &world, &options);
        let unknown = done.statistics.unknown_pixels;
        if unknown > 0 {
            return Err(format!("{unknown} pixels are unknown").into());
        }
        let beauty = picture(&done.film, Channel::Beauty).ok_or("beauty was recorded")?;
        Ok(Self {
            film: done.film,
            beauty: beauty.image,
            metadata: Metadata::new(source, &loaded.parameters, &loaded.scene.settings),
        })
    }

    fn write(&self, image: &RgbImage, path: &Path) -> Outcome<()> {
        Ok(write(path, &encode(image, &self.metadata)?)?)
    }
}

/// The picture beside a script, and its thumbnail.
fn example(path: &Path) -> Outcome<()> {
    let shown = Shown::new(path, &[Channel::Beauty], None)?;
    let picture = path.with_extension("png");
    shown.write(&shown.beauty, &picture)?;
    let height = THUMBNAIL * shown.beauty.height() / shown.beauty.width();
    let small = resize(&shown.beauty, THUMBNAIL, height, FilterType::Lanczos3);
    let name = picture.file_name().unwrap_or_default();
    shown.write(&small, &Path::new("docs/thumbnails").join(name))
}

/// The picture of an entry of the catalogue; its source is the example.
fn entry(word: &Word, scene: &str) -> Outcome<()> {
    let loaded = load_text(word.name, scene, &[], &SceneTracer::default())
        .map_err(|report| report.to_string())?;
    let shown = Shown::of(&loaded, word.example, &[Channel::Beauty])?;
    let path = format!("docs/reference/{}.png", word.name);
    shown.write(&shown.beauty, Path::new(&path))
}

fn first() -> Outcome<()> {
    let path = Path::new("docs/first.sdf");
    let shown = Shown::new(path, &[Channel::Beauty], Some(FIRST_SAMPLES))?;
    shown.write(&shown.beauty, &path.with_extension("png"))
}

/// Light above the line from the lower left to the upper right corner, steps below, and a bar that says how many.
fn hero() -> Outcome<()> {
    let path = Path::new("docs/hero.sdf");
    let shown = Shown::new(path, &[Channel::Beauty, Channel::Steps], None)?;
    let steps = |x, y| shown.film.at(Channel::Steps, x, y)[0];
    let mut image = shown.beauty.clone();
    let [w, h] = [image.width(), image.height()].map(i64::from);
    let below = |x: u32, y: u32| i64::from(x) * h + i64::from(y) * w - w * h;
    // The bar ends at the 99th percentile, rounded up to a multiple of four: single rays would darken the rest.
    let pixels = image.enumerate_pixels().map(|(x, y, _)| (x, y));
    let mut sorted: Vec<f32> = pixels
        .filter(|&(x, y)| below(x, y) > 0)
        .map(|(x, y)| steps(x, y))
        .collect();
    sorted.sort_by(f32::total_cmp);
    let most = 4 * (sorted[sorted.len() * 99 / 100] / 4.0).ceil().max(1.0) as u32;
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        if below(x, y).abs() < w {
            *pixel = WHITE;
        } else if below(x, y) > 0 {
            *pixel = Rgb(heat(f64::from(steps(x, y)) / f64::from(most)));
        }
    }
    draw_bar(&mut image, most);
    shown.write(&image, &path.with_extension("png"))
}

const WHITE: Rgb<u8> = Rgb([255; 3]);

/// How many pixels wide and high a point of a letter is.
const POINT: u32 = 2;

/// From the left of a letter to that of the next one, in pixels.
const ADVANCE: u32 = 4 * POINT;

/// Letters of 3 x 5 points, a row of three bits each, from the top.
const LETTERS: [(char, [u8; 5]); 14] = [
    ('0', [7, 5, 5, 5, 7]),
    ('1', [2, 6, 2, 2, 7]),
    ('2', [7, 1, 7, 4, 7]),
    ('3', [7, 1, 7, 1, 7]),
    ('4', [5, 5, 7, 1, 1]),
    ('5', [7, 4, 7, 1, 7]),
    ('6', [7, 4, 7, 5, 7]),
    ('7', [7, 1, 1, 1, 1]),
    ('8', [7, 5, 7, 5, 7]),
    ('9', [7, 5, 7, 1, 7]),
    ('S', [7, 4, 7, 1, 7]),
    ('T', [7, 2, 2, 2, 2]),
    ('E', [7, 4, 7, 4, 7]),
    ('P', [7, 5, 7, 4, 4]),
];

/// Writes a word that ends at `right`.
fn write_word(image: &mut RgbImage, word: &str, right: u32, top: u32) {
    for (place, letter) in word.chars().rev().enumerate() {
        let left = right - ADVANCE * (place as u32 + 1);
        let known = LETTERS.iter().find(|(known, _)| *known == letter);
        let rows = known.map_or([0; 5], |(_, rows)| *rows);
        for (x, y) in (0..3 * POINT).flat_map(|x| (0..5 * POINT).map(move |y| (x, y))) {
            if rows[(y / POINT) as usize] >> (2 - x / POINT) & 1 == 1 {
                image.put_pixel(left + x, top + y, WHITE);
            }
        }
    }
}

/// A bar of the colours from no steps (below) to the most (above), with numbers at quarters, at the lower right.
fn draw_bar(image: &mut RgbImage, most: u32) {
    let left = image.width() - 28;
    let (top, bottom) = (image.height() / 2, image.height() - 16);
    write_word(image, "STEPS", left + 12 + POINT, top - 22);
    for y in top..bottom {
        let share = f64::from(bottom - 1 - y) / f64::from(bottom - 1 - top);
        for x in left..left + 12 {
            image.put_pixel(x, y, Rgb(heat(share)));
        }
    }
    for quarter in 0..=4 {
        let middle = bottom - 1 - (bottom - 1 - top) * quarter / 4;
        let number = (most * quarter / 4).to_string();
        write_word(image, &number, left - 4, middle - 5 * POINT / 2);
    }
}

fn scripts() -> Outcome<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir("examples")? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "sdf") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Does `work` and says so, if `name` or its folder is wanted.
fn draw(wanted: &[String], name: &str, work: impl FnOnce() -> Outcome<()>) -> Outcome<()> {
    let folder = name.split('/').next();
    if wanted.is_empty() || wanted.iter().any(|w| w == name || Some(&w[..]) == folder) {
        work().map_err(|error| format!("{name}: {error}"))?;
        println!("{name}");
    }
    Ok(())
}

fn main() -> Outcome<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    std::fs::create_dir_all("docs/thumbnails")?;
    std::fs::create_dir_all("docs/reference")?;
    for path in scripts()? {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        draw(&wanted, &name, || example(&path))?;
    }
    draw(&wanted, "first", first)?;
    draw(&wanted, "hero", hero)?;
    for word in Word::all() {
        if let Some(scene) = word.scene() {
            let name = format!("reference/{}", word.name);
            draw(&wanted, &name, || entry(&word, &scene))?;
        }
    }
    Ok(())
}
