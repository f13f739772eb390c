//! What a reference says, as bytes, so that it can be kept; to the bit.

use super::{Channel, Film, Hits, Truth};
use crate::shade::Census;
use crate::trace::{Footprint, Outcome, Ray, Verdict};
use glam::DVec3;

const VERDICTS: [Verdict; 3] = [Verdict::Hit, Verdict::Miss, Verdict::Unknown];

impl Truth {
    /// All of it but the times; numbers have their lower bytes first.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let hits = self.hits();
        integers(&mut bytes, &counts(&hits.census));
        integers(&mut bytes, &[hits.rays.len() as u64]);
        for (ray, outcome) in hits.rays.iter().zip(&hits.outcomes) {
            let Footprint { at_origin, spread } = ray.footprint;
            let (o, d, p, n) = (ray.origin, ray.direction, outcome.point, outcome.normal);
            let verdict = VERDICTS.iter().position(|v| *v == outcome.verdict);
            let numbers = [
                [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_max, at_origin],
                [spread, outcome.t, outcome.error, p.x, p.y, p.z, n.x, n.y],
            ];
            let bits = numbers.concat().into_iter().chain([n.z]).map(f64::to_bits);
            integers(&mut bytes, &bits.collect::<Vec<_>>());
            let whole = [outcome.part, outcome.steps, outcome.evaluations].map(u64::from);
            integers(&mut bytes, &whole);
            integers(&mut bytes, &[verdict.unwrap_or(0) as u64]);
        }
        let light = self.film().map(|film| (film, film.plane(Channel::Beauty)));
        if let Some((film, Some(plane))) = light {
            integers(&mut bytes, &[film.width().into(), film.height().into()]);
            bytes.extend(plane.values.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes
    }

    /// What [`Truth::to_bytes`] wrote, with no times; none of other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes;
        let census = census(take(&mut rest)?);
        let [count] = take(&mut rest)?;
        let mut hits = Hits {
            census,
            ..Hits::default()
        };
        for _ in 0..count {
            let (ray, outcome) = pair(take(&mut rest)?, take(&mut rest)?)?;
            hits.rays.push(ray);
            hits.outcomes.push(outcome);
        }
        let film = match rest.is_empty() {
            true => None,
            false => Some(picture(rest)?),
        };
        Some(Self::with(hits, film))
    }
}

fn integers(bytes: &mut Vec<u8>, numbers: &[u64]) {
    bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
}

fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u64; N]> {
    let (head, tail) = rest.split_at_checked(8 * N)?;
    *rest = tail;
    let (numbers, _) = head.as_chunks::<8>();
    Some(std::array::from_fn(|i| u64::from_le_bytes(numbers[i])))
}

fn counts(c: &Census) -> [u64; 11] {
    let of_rays = [c.primary, c.shadow, c.reflected, c.refracted];
    let [primary, shadow, reflected, refracted] = of_rays;
    [
        primary,
        shadow,
        reflected,
        refracted,
        c.hits,
        c.misses,
        c.unknown,
        c.unknown_secondary,
        c.too_deep,
        c.too_faint,
        c.evaluations,
    ]
}

fn census(counts: [u64; 11]) -> Census {
    let [
        primary,
        shadow,
        reflected,
        refracted,
        hits,
        misses,
        unknown,
        secondary,
        deep,
        faint,
        evaluations,
    ] = counts;
    Census {
        primary,
        shadow,
        reflected,
        refracted,
        hits,
        misses,
        unknown,
        unknown_secondary: secondary,
        too_deep: deep,
        too_faint: faint,
        evaluations,
        ..Census::default()
    }
}

fn pair(bits: [u64; 17], whole: [u64; 4]) -> Option<(Ray, Outcome)> {
    let x = bits.map(f64::from_bits);
    let vector = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
    let ray = Ray {
        origin: vector(0),
        direction: vector(3),
        t_max: x[6],
        footprint: Footprint {
            at_origin: x[7],
            spread: x[8],
        },
    };
    let [part, steps, evaluations, verdict] = whole;
    let outcome = Outcome {
        verdict: *VERDICTS.get(verdict as usize)?,
        t: x[9],
        error: x[10],
        point: vector(11),
        normal: vector(14),
        part: part.try_into().ok()?,
        steps: steps.try_into().ok()?,
        evaluations: evaluations.try_into().ok()?,
    };
    Some((ray, outcome))
}

/// The light of a picture, row by row.
fn picture(bytes: &[u8]) -> Option<Film> {
    let mut rest = bytes;
    let [width, height] = take(&mut rest)?;
    let size = [u32::try_from(width).ok()?, u32::try_from(height).ok()?];
    let (values, odd) = rest.as_chunks::<4>();
    let values = values.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let film = Film::of(size, Channel::Beauty, values);
    film.filter(|_| odd.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Torus};
    use crate::scene::{Node, Scene, Settings};

    #[test]
    fn bytes_give_the_same_again() {
        let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(1.0, 0.3))).unwrap();
        let scene = Scene {
            shown: vec![ring],
            settings: Settings {
                size: [9, 7],
                ..Settings::default()
            },
            ..Scene::default()
        };
        for wants_picture in [false, true] {
            let truth = Truth::of(&scene, wants_picture).unwrap();
            let bytes = truth.to_bytes();
            let again = Truth::from_bytes(&bytes).unwrap();
            assert_eq!(again.hits().rays, truth.hits().rays);
            assert_eq!(again.hits().outcomes, truth.hits().outcomes);
            assert_eq!(counts(&again.hits().census), counts(&truth.hits().census));
            assert_eq!(again.film(), truth.film());
            assert_eq!(again.film().is_some(), wants_picture);
            for length in [0, 1, 87, 88, 95, 96, 97, bytes.len() - 1] {
                assert!(Truth::from_bytes(&bytes[..length]).is_none(), "{length}");
            }
        }
    }
}
