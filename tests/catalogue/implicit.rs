//! What fractals, blobs and periodic walls are, by other means than their fields.

use super::samples::Dice;
use fieldstone::catalogue::*;
use fieldstone::num::Vec3;
use std::f64::consts::{FRAC_PI_4, TAU};

fn at(entry: &impl Primitive, p: [f64; 3]) -> f64 {
    entry.distance(&Vec3::splat(p))
}

/// Whether a point of the unit cube is in the sponge, by its digits in base 3: nowhere are two of them 1.
fn is_in_sponge(mut p: [f64; 3], rounds: u32) -> bool {
    (0..rounds).all(|_| {
        let ones = p.iter().filter(|x| (3.0 * **x).floor() == 1.0).count();
        p = p.map(|x| (3.0 * x).fract());
        ones < 2
    })
}

#[test]
fn digits_in_base_three_tell_the_sponge() {
    let mut dice = Dice::new(0);
    for rounds in 0..=4 {
        let sponge = Menger::new(rounds.into(), 1.0);
        for _ in 0..4000 {
            let p = dice.point(&Bounds::new([0.0; 3], [1.0; 3]));
            let distance = at(&sponge, p.map(|x| x - 0.5));
            assert!(
                (distance <= 0.0) == is_in_sponge(p, rounds) || distance.abs() < 1e-12,
                "{distance} at {p:?} after {rounds} rounds"
            );
        }
    }
}

type Tetrahedron = [[f64; 3]; 4];

/// The tetrahedra of the Sierpinski tetrahedron with edges of length 1.
fn tetrahedra(rounds: u32) -> Vec<Tetrahedron> {
    let (height, across) = ((2.0_f64 / 3.0).sqrt(), 3.0_f64.sqrt());
    let base = -0.25 * height;
    let mut all = vec![[
        [0.0, 0.75 * height, 0.0],
        [0.5, base, -across / 6.0],
        [-0.5, base, -across / 6.0],
        [0.0, base, across / 3.0],
    ]];
    for _ in 0..rounds {
        let halved = |t: &Tetrahedron, corner: usize| {
            t.map(|v| std::array::from_fn(|i| 0.5 * (v[i] + t[corner][i])))
        };
        all = all
            .iter()
            .flat_map(|t| [0, 1, 2, 3].map(|corner| halved(t, corner)))
            .collect();
    }
    all
}

/// The distance to a tetrahedron, by its four triangles: inside it is behind all of them.
fn distance_to(t: &Tetrahedron, p: [f64; 3]) -> f64 {
    let faces = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
    let (mut nearest, mut is_inside) = (f64::INFINITY, true);
    for (opposite, [a, b, c]) in faces.into_iter().enumerate() {
        let triangle = Triangle::new(t[a], t[b], t[c]);
        nearest = nearest.min(at(&triangle, p));
        let side = |q: [f64; 3]| -> f64 {
            let n = triangle.unit_normal();
            (0..3).map(|i| n[i] * (q[i] - t[a][i])).sum()
        };
        is_inside &= side(p) * side(t[opposite]) > 0.0;
    }
    if is_inside { -nearest } else { nearest }
}

#[test]
fn sierpinski_is_the_union_of_its_tetrahedra() {
    let mut dice = Dice::new(1);
    for rounds in 0..=3 {
        let (folded, parts) = (Sierpinski::new(rounds.into(), 1.0), tetrahedra(rounds));
        for _ in 0..400 {
            let p = dice.point(&Bounds::centred([0.9; 3]));
            let nearest = parts.iter().map(|t| distance_to(t, p));
            let expected = nearest.fold(f64::INFINITY, f64::min);
            let found = at(&folded, p);
            assert!(
                (found - expected).abs() < 1e-12,
                "{found}, not {expected}, at {p:?} after {rounds} rounds"
            );
        }
    }
}

/// Whether z^2 + c stays within radius 2 plus |c|, from which nothing comes back, for some rounds.
fn stays(c: [f64; 4], p: [f64; 3], rounds: u32) -> bool {
    let escape = 0.5 + (0.25 + c.iter().map(|x| x * x).sum::<f64>().sqrt()).sqrt();
    let mut z = [p[0], p[1], p[2], 0.0];
    for _ in 0..rounds {
        let vector = z[1] * z[1] + z[2] * z[2] + z[3] * z[3];
        let twice = 2.0 * z[0];
        z = [
            z[0] * z[0] - vector + c[0],
            twice * z[1] + c[1],
            twice * z[2] + c[2],
            twice * z[3] + c[3],
        ];
    }
    z.iter().map(|x| x * x).sum::<f64>().sqrt() <= escape
}

#[test]
fn julia_is_what_stays() {
    let mut dice = Dice::new(2);
    for (c, rounds) in [
        ([-0.2, 0.6, 0.2, 0.2], 6),
        ([-0.291, -0.399, 0.339, 0.437], 8),
        ([-1.0, 0.2, 0.0, 0.0], 5),
    ] {
        let julia = Julia::new([c[0], c[1], c[2]], c[3], rounds.into());
        let mut inside = 0;
        for _ in 0..4000 {
            let p = dice.point(&Bounds::centred([1.6; 3]));
            let distance = at(&julia, p);
            assert!(
                (distance <= 0.0) == stays(c, p, rounds) || distance.abs() < 1e-9,
                "{distance} at {p:?}"
            );
            inside += u32::from(distance <= 0.0);
        }
        assert!(inside > 40, "{inside} of 4000 inside");
    }
}

#[test]
fn the_mandelbulb_is_what_stays() {
    let mut dice = Dice::new(4);
    for (power, rounds) in [(8.0, 4), (2.0, 5), (3.0, 3), (5.0, 3)] {
        let bulb = Mandelbulb::new(power, rounds.into());
        let escape = 2.0_f64.powf(1.0 / (power - 1.0));
        let next = |z: [f64; 3], c: [f64; 3]| -> [f64; 3] {
            let r = z[0].hypot(z[1]).hypot(z[2]);
            let (t, u) = (power * (z[1] / r).acos(), power * z[2].atan2(z[0]));
            let turned = [t.sin() * u.cos(), t.cos(), t.sin() * u.sin()];
            std::array::from_fn(|i| r.powf(power) * turned[i] + c[i])
        };
        let mut inside = 0;
        for _ in 0..2000 {
            let p = dice.point(&Bounds::centred([1.2; 3]));
            let distance = at(&bulb, p);
            let sizes = (0..rounds).scan(p, |z, _| {
                *z = next(*z, p);
                Some(z[0].hypot(z[1]).hypot(z[2]))
            });
            let start = p[0].hypot(p[1]).hypot(p[2]);
            let stays = sizes.fold(start, f64::max) <= escape;
            assert!(
                (distance <= 0.0) == stays || distance.abs() < 1e-9,
                "{distance} at {p:?}"
            );
            inside += u32::from(stays);
        }
        assert!(inside > 100, "{inside} of 2000 inside");
    }
}

#[test]
fn the_julia_set_of_zero_is_the_unit_ball() {
    let julia = Julia::new([0.0; 3], 0.0, 10.0);
    let mut dice = Dice::new(3);
    for _ in 0..1000 {
        let p = dice.point(&Bounds::centred([3.0; 3]));
        let distance = p[0].hypot(p[1]).hypot(p[2]) - 1.0;
        let found = at(&julia, p);
        // What every round adds is less than |z| - 1 outside; inside, only the sign is exact.
        assert!(found <= distance + 1e-12 && found * distance >= 0.0);
        assert!(
            distance < 0.0 || (found - distance).abs() < 1e-12,
            "{found}, not {distance}"
        );
    }
}

#[test]
fn a_lone_blob_is_a_ball() {
    let (radius, threshold) = (0.8_f64, 0.3_f64);
    let blob = Blob::new(vec![[0.1, -0.2, 0.3]], radius, threshold);
    let r = radius * (1.0 - threshold.cbrt()).sqrt();
    assert!(at(&blob, [0.1 + r, -0.2, 0.3]).abs() < 1e-12);
    let excess = blob.sublevel(0.0).size().map(|s| s / (2.0 * r) - 1.0);
    assert!(
        excess.iter().all(|e| (0.0..0.05).contains(e)),
        "{excess:?} too large"
    );
    // The steepest slope of 6 u (1 - u^2)^2 is at u = 1 / sqrt(5).
    let steepest = 96.0 / (25.0 * 5.0_f64.sqrt()) / radius;
    let middle = at(&blob, [0.1, -0.2, 0.3]);
    assert!((middle - (threshold - 1.0) / steepest).abs() < 1e-6);
    // Two in one place are twice as steep, which is known within 4 %.
    let twice = Blob::new(vec![[0.0; 3]; 2], radius, threshold);
    let known = (threshold - 2.0) / at(&twice, [0.0; 3]);
    assert!(
        (1.0..=1.04).contains(&(known / (2.0 * steepest))),
        "{known}"
    );
}

#[test]
fn walls_are_steepest_where_they_are_thinnest() {
    // On the middle surface, at the steepest place of each wave, in turns.
    let eighth = FRAC_PI_4 / TAU;
    let (gyroid, p, d) = (
        Gyroid::new(1.0, 0.1),
        SchwarzP::new(1.0, 0.1),
        SchwarzD::new(1.0, 0.1),
    );
    let step = 1e-4;
    let along = |x: f64| [x + step / 3.0_f64.sqrt(); 3];
    for (found, name) in [
        (at(&gyroid, along(0.0)), "gyroid"),
        (at(&p, along(0.25)), "schwarz_p"),
        (at(&d, along(eighth)), "schwarz_d"),
    ] {
        assert!((found + 0.05 - step).abs() < 1e-7, "{name}: {found}");
    }
}
