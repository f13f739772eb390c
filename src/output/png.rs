//! PNG with the story of the picture in its text.

use crate::scene::{Method, Sampling, Settings};
use image::RgbImage;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};

/// What a picture says about itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata {
    /// The script.
    pub source: String,
    /// The values of its parameters.
    pub parameters: String,
    /// The settings it was rendered with.
    pub settings: String,
}

impl Metadata {
    /// What a picture of the script `source` says, rendered with these values of its parameters and these settings; the
    /// settings in the words of the command's options.
    pub fn new(source: &str, parameters: &[(String, String)], settings: &Settings) -> Self {
        let parameters: Vec<String> = parameters
            .iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        Self {
            source: source.into(),
            parameters: parameters.join(" "),
            settings: in_words(settings),
        }
    }

    /// Keywords and texts; empty ones are left out.
    fn entries(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let software = concat!("fieldstone ", env!("CARGO_PKG_VERSION"));
        [
            ("Software", software),
            ("Source", &self.source),
            ("Parameters", &self.parameters),
            ("Settings", &self.settings),
        ]
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
    }
}

fn in_words(s: &Settings) -> String {
    let [width, height] = s.size;
    // Settings of some pictures alone.
    let sampling = match s.sampling {
        Sampling::Even => String::new(),
        Sampling::Adaptive => format!(" sampling={}", s.sampling.name()),
    };
    let omega = match s.method {
        Method::Relaxed => format!(" omega={}", s.omega),
        _ => String::new(),
    };
    format!(
        "size={width}x{height} samples={}{sampling} depth={} tolerance={} max_steps={} method={}{omega} seed={}",
        s.samples,
        s.depth,
        s.tolerance,
        s.max_steps,
        s.method.name(),
        s.seed
    )
}

/// The bytes of a PNG of `image`, whose samples are sRGB.
///
/// # Errors
/// If the picture has no pixels, or a text holds a NUL.
pub fn encode(image: &RgbImage, metadata: &Metadata) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    // A third of the time for files a third to a half larger: to compress well took as long as to render.
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    for (keyword, text) in metadata.entries() {
        // tEXt is Latin-1 and read by every program; iTXt takes the rest.
        if text.is_ascii() {
            encoder.add_text_chunk(keyword.into(), text.into())?;
        } else {
            encoder.add_itxt_chunk(keyword.into(), text.into())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(image.as_raw())?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use std::io::Cursor;

    fn gradient() -> RgbImage {
        RgbImage::from_fn(17, 9, |i, j| Rgb([(i * 15) as u8, (j * 28) as u8, 77]))
    }

    fn metadata() -> Metadata {
        Metadata {
            source: "ball.sdf".into(),
            parameters: "größe=3".into(),
            settings: String::new(),
        }
    }

    #[test]
    fn pixels_read_back_as_written() {
        let bytes = encode(&gradient(), &metadata()).unwrap();
        let read = image::load_from_memory(&bytes).unwrap().to_rgb8();
        assert_eq!(read, gradient());
    }

    #[test]
    fn text_and_colour_space_read_back_as_written() {
        let bytes = encode(&gradient(), &metadata()).unwrap();
        let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let info = reader.info();
        let plain: Vec<_> = info
            .uncompressed_latin1_text
            .iter()
            .map(|t| (t.keyword.as_str(), t.text.as_str()))
            .collect();
        let software = format!("fieldstone {}", env!("CARGO_PKG_VERSION"));
        assert_eq!(
            plain,
            [("Software", software.as_str()), ("Source", "ball.sdf")]
        );
        let other = &info.utf8_text[0];
        assert_eq!(other.keyword, "Parameters");
        assert_eq!(other.get_text().unwrap(), "größe=3");
        assert_eq!(info.srgb, Some(SrgbRenderingIntent::Perceptual));
    }

    #[test]
    fn equal_pictures_give_equal_bytes() {
        let bytes = || encode(&gradient(), &metadata()).unwrap();
        assert_eq!(bytes(), bytes());
    }

    #[test]
    fn settings_are_told_in_the_words_of_the_options() {
        let parameters = [("n".into(), "7".into()), ("gap".into(), "0.2".into())];
        let metadata = Metadata::new("ring.sdf", &parameters, &Settings::default());
        assert_eq!(metadata.parameters, "n=7 gap=0.2");
        assert_eq!(
            metadata.settings,
            "size=640x360 samples=1 depth=8 tolerance=0.1 max_steps=1024 method=auto seed=0"
        );
    }

    #[test]
    fn a_picture_without_pixels_is_an_error() {
        assert!(encode(&RgbImage::new(0, 4), &metadata()).is_err());
    }
}
