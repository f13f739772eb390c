//! The values of options, from their text.

use crate::scene::Settings;

/// The smallest and the largest width or height of a picture, in pixels.
const SIDES: std::ops::RangeInclusive<u32> = 1..=Settings::MAX_SIDE;

/// The size of a picture from `WIDTHxHEIGHT`, in pixels.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text
        .split_once(['x', 'X'])
        .ok_or("write width and height in pixels, as in 640x360")?;
    Ok([side("width", width)?, side("height", height)?])
}

fn side(name: &str, text: &str) -> Result<u32, String> {
    let (low, high) = (SIDES.start(), SIDES.end());
    text.trim()
        .parse()
        .ok()
        .filter(|n| SIDES.contains(n))
        .ok_or(format!(
            "the {name} must be a whole number from {low} to {high}, and is `{text}`"
        ))
}

/// A value for a parameter of the script, from `name=value`.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("write the parameter's name and its value, as in teeth=30")?;
    let (name, value) = (name.trim(), value.trim());
    let is_name = name.chars().all(|c| c.is_alphanumeric() || c == '_')
        && name.starts_with(|c: char| c.is_alphabetic() || c == '_');
    if !is_name {
        return Err(format!(
            "`{name}` is not a parameter's name; write name=value"
        ));
    }
    if value.is_empty() {
        return Err(format!("there is no value after `{name}=`"));
    }
    Ok((name.into(), value.into()))
}

/// `N` finite numbers with commas between them.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let fields: Vec<&str> = text.split(',').collect();
    let found = fields.len();
    if found != N {
        return Err(format!(
            "expected {N} numbers with commas between them, found {found}"
        ));
    }
    let mut values = [0.0; N];
    for (value, field) in values.iter_mut().zip(fields) {
        *value = number(field)?;
    }
    Ok(values)
}

/// A finite number.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(format!("`{text}` is not a finite number")),
        Err(_) => Err(format!("`{text}` is not a number")),
    }
}

/// A point: three numbers.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn point(text: &str) -> Result<[f64; 3], String> {
    numbers(text)
}

/// A ray: its origin and its direction.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn ray(text: &str) -> Result<[f64; 6], String> {
    let ray = numbers(text)?;
    has_direction(&ray)
        .then_some(ray)
        .ok_or(NO_DIRECTION.into())
}

/// What is wrong with a ray that goes nowhere.
pub const NO_DIRECTION: &str = "the direction is zero";

/// Whether the last three numbers of a ray are a direction.
pub fn has_direction(ray: &[f64; 6]) -> bool {
    ray[3..].iter().any(|x| *x != 0.0)
}

/// A tolerance: a finite number above zero.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn positive(text: &str) -> Result<f64, String> {
    let x = number(text)?;
    (x > 0.0)
        .then_some(x)
        .ok_or(format!("`{text}` is not above zero"))
}

/// How much longer than known to be free a step is: a number from 1 up to, but not with, 2.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn omega(text: &str) -> Result<f64, String> {
    let x = number(text)?;
    Settings::OMEGAS
        .contains(&x)
        .then_some(x)
        .ok_or(format!("`{text}` is not at least 1 and below 2"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_limits() {
        assert_eq!(size("640x360"), Ok([640, 360]));
        assert_eq!(size("1X16384"), Ok([1, 16384]));
        assert_eq!(
            size("0x10").unwrap_err(),
            "the width must be a whole number from 1 to 16384, and is `0`"
        );
        assert!(size("10x32769").unwrap_err().contains("height"));
        assert!(size("640").unwrap_err().contains("640x360"));
        assert!(size("1x2x3").is_err());
        assert!(size("-1x3").is_err());
        assert!(size("1e3x3").is_err());
    }

    #[test]
    fn definitions_name_a_parameter() {
        let pair = |a: &str, b: &str| Ok((a.to_string(), b.to_string()));
        assert_eq!(definition("n=3"), pair("n", "3"));
        assert_eq!(definition("a_1 = [1, 2]"), pair("a_1", "[1, 2]"));
        assert_eq!(definition("s=\"a=b\""), pair("s", "\"a=b\""));
        for wrong in ["n", "=3", "n=", "1n=3", "a b=3", ""] {
            assert!(definition(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn points_and_rays_are_finite_numbers() {
        assert_eq!(point("-1, 2.5,3e-1"), Ok([-1.0, 2.5, 0.3]));
        assert_eq!(
            point("1,2").unwrap_err(),
            "expected 3 numbers with commas between them, found 2"
        );
        assert_eq!(point("1,b,3").unwrap_err(), "`b` is not a number");
        assert_eq!(
            point("1,inf,3").unwrap_err(),
            "`inf` is not a finite number"
        );
        assert_eq!(ray("0,0,0,0,-0,0").unwrap_err(), NO_DIRECTION);
        assert!(ray("0,0,5,0,0,-1").is_ok());
    }

    #[test]
    fn tolerances_are_above_zero() {
        assert_eq!(positive("0.5"), Ok(0.5));
        assert!(positive("0").is_err());
        assert!(positive("-1").is_err());
        assert!(positive("nan").is_err());
    }
}
