//! Pictures in the repository, and what the program makes of their scripts now.

use fieldstone::lang::Loaded;
use fieldstone::output::picture;
use fieldstone::render::{Channel, RenderOptions, render};
use fieldstone::trace::World;
use image::{ImageReader, RgbImage};
use std::path::Path;

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The picture in a file of the repository.
pub fn stored(path: &Path) -> RgbImage {
    let image = ImageReader::open(path).unwrap_or_else(|_| panic!("{} is missing", path.display()));
    image.decode().expect("a readable picture").to_rgb8()
}

/// What the program makes of a script now; no pixel may be unknown.
pub fn rendered(name: &str, loaded: &Loaded) -> RgbImage {
    let world = World::new(&loaded.scene).expect("a world");
    let done = render(&loaded.scene, &world, &RenderOptions::default());
    let unknown = done.statistics.unknown_pixels;
    assert_eq!(unknown, 0, "{name}: unknown pixels");
    let beauty = picture(&done.film, Channel::Beauty);
    beauty.expect("beauty was recorded").image
}

/// The text of a PNG under a keyword.
pub fn text_of(path: &Path, keyword: &str) -> Option<String> {
    let file = std::fs::File::open(path).expect("a picture");
    let decoder = png::Decoder::new(std::io::BufReader::new(file));
    let reader = decoder.read_info().expect("a PNG");
    let texts = &reader.info().uncompressed_latin1_text;
    let found = texts.iter().find(|text| text.keyword == keyword);
    found.map(|text| text.text.clone())
}
