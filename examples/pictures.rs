//! Renders what the repository shows: `cargo run --release --example pictures [NAME ...]`.
//!
//! For every script `examples/NAME.sdf` the picture beside it and a thumbnail in `docs/thumbnails`; then `docs/hero.png`: one
//! scene cut diagonally, the shaded picture above the number of steps that each ray took.

use fieldstone::lang::{Loaded, load};
use fieldstone::output::{Metadata, encode, heat, picture, write};
use fieldstone::render::{Channel, Film, RenderOptions, render};
use fieldstone::trace::{SceneTracer, World};
use image::imageops::{FilterType, resize};
use image::{Rgb, RgbImage};
use std::error::Error;
use std::path::{Path, PathBuf};

/// The scene of the hero picture.
const HERO: &str = "blobs";

/// How wide a thumbnail is, in pixels.
const THUMBNAIL: u32 = 256;

fn scripts() -> Result<Vec<PathBuf>, Box<dyn Error>> {
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

fn loaded(path: &Path) -> Result<Loaded, Box<dyn Error>> {
    load(path, &[], &SceneTracer::default()).map_err(|error| error.to_string().into())
}

fn rendered(loaded: &Loaded, channels: &[Channel]) -> Result<Film, Box<dyn Error>> {
    let world = World::new(&loaded.scene).map_err(|fault| fault.message)?;
    let done = render(
        &loaded.scene,
        &world,
        &RenderOptions {
            channels,
            ..RenderOptions::default()
        },
    );
    if done.statistics.unknown_pixels > 0 {
        return Err(format!("{} pixels are unknown", done.statistics.unknown_pixels).into());
    }
    Ok(done.film)
}

/// The picture of the README's script, as `--samples 9` renders it.
fn first() -> Result<(), Box<dyn Error>> {
    let mut loaded = loaded(Path::new("docs/first.sdf"))?;
    loaded.scene.settings.samples = 9;
    let film = rendered(&loaded, &[Channel::Beauty])?;
    let image = picture(&film, Channel::Beauty)
        .ok_or("beauty was recorded")?
        .image;
    let metadata = Metadata {
        source: "first.sdf".into(),
        ..Metadata::default()
    };
    write(Path::new("docs/first.png"), &encode(&image, &metadata)?)?;
    println!("first");
    Ok(())
}

/// The picture beside a script, and its thumbnail.
fn show(path: &Path) -> Result<(), Box<dyn Error>> {
    let loaded = loaded(path)?;
    let film = rendered(&loaded, &[Channel::Beauty])?;
    let image = picture(&film, Channel::Beauty)
        .ok_or("beauty was recorded")?
        .image;
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let metadata = Metadata {
        source: format!("{name}.sdf"),
        ..Metadata::default()
    };
    write(&path.with_extension("png"), &encode(&image, &metadata)?)?;
    let height = THUMBNAIL * image.height() / image.width();
    let small = resize(&image, THUMBNAIL, height, FilterType::Lanczos3);
    write(
        &Path::new("docs/thumbnails").join(format!("{name}.png")),
        &encode(&small, &metadata)?,
    )?;
    println!("{name}");
    Ok(())
}

/// Digits of 3 x 5 points, a row of three bits each, from the top.
const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 1, 1, 1],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// Writes a number with its last digit ending at `right`, each point a square of two pixels.
fn write_number(image: &mut RgbImage, number: u32, right: u32, top: u32) {
    for (place, digit) in number.to_string().bytes().rev().enumerate() {
        let left = right - 8 * (place as u32 + 1);
        for (row, bits) in DIGITS[usize::from(digit - b'0')].iter().enumerate() {
            for column in (0..3).filter(|c| bits >> (2 - c) & 1 == 1) {
                for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    image.put_pixel(
                        left + 2 * column + x,
                        top + 2 * row as u32 + y,
                        Rgb([255; 3]),
                    );
                }
            }
        }
    }
}

/// A bar of the colours from no steps (below) to the most (above), with numbers at quarters.
fn draw_bar(image: &mut RgbImage, most: u32) {
    let (left, top, height) = (
        image.width() - 22,
        image.height() / 2,
        image.height() / 2 - 16,
    );
    for y in 0..height {
        let share = 1.0 - f64::from(y) / f64::from(height - 1);
        for x in 0..12 {
            image.put_pixel(left + x, top + y, Rgb(heat(share)));
        }
    }
    for quarter in 0..=4 {
        let y = top + (height - 1) * (4 - quarter) / 4;
        write_number(image, most * quarter / 4, left - 4, y.saturating_sub(5));
    }
}

/// The hero picture: light above the diagonal, steps below.
fn hero() -> Result<(), Box<dyn Error>> {
    let loaded = loaded(&Path::new("examples").join(HERO).with_extension("sdf"))?;
    let film = rendered(&loaded, &[Channel::Beauty, Channel::Steps])?;
    let mut image = picture(&film, Channel::Beauty)
        .ok_or("beauty was recorded")?
        .image;
    let steps = |x, y| film.at(Channel::Steps, x, y)[0];
    // The bar ends at the 99.5th percentile, rounded up to a multiple of four: single rays would darken the rest.
    let mut sorted: Vec<f32> = (0..image.height())
        .flat_map(|y| (0..image.width()).map(move |x| (x, y)))
        .map(|(x, y)| steps(x, y))
        .collect();
    sorted.sort_by(f32::total_cmp);
    let most = (sorted[sorted.len() * 995 / 1000] / 4.0).ceil().max(1.0) as u32 * 4;
    let (w, h) = image.dimensions();
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        // The cut runs from the lower left to the upper right corner.
        let side =
            i64::from(x) * i64::from(h) + i64::from(y) * i64::from(w) - i64::from(w) * i64::from(h);
        if side.abs() < i64::from(w) {
            *pixel = Rgb([255; 3]);
        } else if side > 0 {
            *pixel = Rgb(heat(f64::from(steps(x, y)) / f64::from(most)));
        }
    }
    draw_bar(&mut image, most);
    let metadata = Metadata {
        source: format!("{HERO}.sdf"),
        ..Metadata::default()
    };
    write(Path::new("docs/hero.png"), &encode(&image, &metadata)?)?;
    println!("hero");
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    std::fs::create_dir_all("docs/thumbnails")?;
    for path in scripts()? {
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if wanted.is_empty() || wanted.contains(&name) {
            show(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        }
    }
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|w| w == name);
    if is_wanted("first") {
        first()?;
    }
    if is_wanted("hero") {
        hero()?;
    }
    Ok(())
}
