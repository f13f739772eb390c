//! Colours: from sRGB as people write it to linear light as the renderer wants it.

/// The linear RGB of three or six hexadecimal digits; none for anything else.
pub(super) fn color_of_hex(digits: &str) -> Option<[f64; 3]> {
    let values: Vec<u32> = digits
        .chars()
        .map(|c| c.to_digit(16))
        .collect::<Option<_>>()?;
    let bytes = match values[..] {
        [r, g, b] => [r * 17, g * 17, b * 17],
        [a, b, c, d, e, f] => [a * 16 + b, c * 16 + d, e * 16 + f],
        _ => return None,
    };
    Some(bytes.map(|byte| linear_of_srgb(f64::from(byte) / 255.0)))
}

/// The linear value of an sRGB value in [0, 1]. Source: IEC 61966-2-1.
fn linear_of_srgb(s: f64) -> f64 {
    if s <= 0.040_45 {
        s / 12.92
    } else {
        libm::pow((s + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colors_are_decoded_to_linear_light() {
        assert_eq!(color_of_hex("000"), Some([0.0; 3]));
        assert_eq!(color_of_hex("ffffff"), Some([1.0; 3]));
        let [r, g, b] = color_of_hex("bc8040").expect("six digits");
        // By hand: 188, 128, 64 of 255.
        assert!((r - 0.502_886_458).abs() < 1e-8, "{r}");
        assert!((g - 0.215_860_500).abs() < 1e-8, "{g}");
        assert!((b - 0.051_269_458).abs() < 1e-8, "{b}");
        assert_eq!(color_of_hex("ccc"), color_of_hex("cccccc"));
    }

    #[test]
    fn other_digits_are_no_color() {
        for digits in ["", "f", "ff", "ffff", "fffff", "fffffff", "ggg"] {
            assert_eq!(color_of_hex(digits), None, "{digits}");
        }
    }
}
