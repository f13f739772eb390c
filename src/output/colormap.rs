//! Colours for numbers, as 8-bit sRGB.

/// The colour of heat for a number in [0, 1]: black, purple, orange, pale yellow, evenly brighter to the eye; within 0.02
/// of the colour map "inferno". What is out of range is clamped, NaN is black.
/// Sources: inferno, van der Walt and Smith 2015; polynomial, Zucker 2019.
pub fn heat(x: f64) -> [u8; 3] {
    const POWERS: [[f64; 3]; 7] = [
        [
            0.000_218_940_369_119_226_5,
            0.001_651_004_631_001_012,
            -0.019_480_898_437_091_84,
        ],
        [
            0.106_513_419_485_611_6,
            0.563_956_436_788_409_1,
            3.932_712_388_889_277,
        ],
        [
            11.602_493_082_471_87,
            -3.972_853_965_665_698,
            -15.942_394_106_291_4,
        ],
        [
            -41.703_996_131_394_59,
            17.436_398_882_053_13,
            44.354_145_198_728_13,
        ],
        [
            77.162_935_699_427,
            -33.402_358_942_100_92,
            -81.807_309_257_389_93,
        ],
        [
            -71.319_428_244_992_14,
            32.626_064_263_977_23,
            73.209_519_858_032_02,
        ],
        [
            25.131_126_224_773_41,
            -12.242_668_952_385_67,
            -23.070_325_002_871_72,
        ],
    ];
    let x = x.clamp(0.0, 1.0);
    std::array::from_fn(|i| {
        let y = POWERS.iter().rev().fold(0.0, |y, power| y * x + power[i]);
        (255.0 * y).round() as u8
    })
}

/// A colour for a thing by its number; neighbours differ strongly: hues a golden angle apart.
pub fn hue(number: u64) -> [u8; 3] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    // The hue walks along the edges of the colour cube, in sixths; green looks brightest, so it is dimmed most.
    let turn = (number as f64 * GOLDEN).fract();
    [(0.0, 0.95), (1.0 / 3.0, 0.8), (2.0 / 3.0, 1.0)].map(|(centre, strength)| {
        let away = ((turn - centre + 0.5).rem_euclid(1.0) - 0.5).abs();
        let share = (2.0 - 6.0 * away).clamp(0.0, 1.0);
        (255.0 * strength * (0.25 + 0.75 * share)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_is_inferno() {
        // Published table, entries 0, 64, 128, 191 and 255 of 256.
        let table = [
            (0, [0.001_462, 0.000_466, 0.013_866]),
            (64, [0.341_500, 0.062_325, 0.429_425]),
            (128, [0.735_683, 0.215_906, 0.330_245]),
            (191, [0.978_422, 0.557_937, 0.034_931]),
            (255, [0.988_362, 0.998_364, 0.644_924]),
        ];
        for (k, color) in table {
            let ours = heat(f64::from(k) / 255.0);
            for i in 0..3 {
                let off = f64::from(ours[i]) / 255.0 - color[i];
                assert!(off.abs() < 0.025, "entry {k}, channel {i}: {off}");
            }
        }
    }

    #[test]
    fn heat_gets_brighter_all_the_way() {
        let luma = |x: f64| {
            let [r, g, b] = heat(x).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for i in 0..100 {
            let x = f64::from(i) / 100.0;
            assert!(luma(x) < luma(x + 0.01) + 0.5, "{x}");
        }
        assert_eq!(heat(f64::NAN), [0; 3]);
    }

    #[test]
    fn a_thousand_things_have_many_colours() {
        let colors: std::collections::HashSet<_> = (0..1000).map(hue).collect();
        assert!(colors.len() > 500);
        assert_ne!(hue(0), hue(1));
    }
}
