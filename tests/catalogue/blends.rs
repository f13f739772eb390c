//! Laws of blends: their Lipschitz rules over the plane of two fields, their depths, their shares of materials.

use super::samples::{Dice, blends, operations};
use fieldstone::catalogue::*;
use fieldstone::field::shares;
use fieldstone::num::{Dual, Vec3};
use fieldstone::scene::{Material, Node};
use std::sync::Arc;

fn leaf(primitive: AnyPrimitive) -> Arc<Node> {
    Node::primitive(primitive).expect("a valid primitive")
}

fn sphere(radius: f64) -> Arc<Node> {
    leaf(AnyPrimitive::Sphere(Sphere::new(radius)))
}

fn half_space(normal: [f64; 3], offset: f64) -> Arc<Node> {
    leaf(AnyPrimitive::Plane(Plane::new(normal, offset)))
}

fn joined(operation: Operation, blend: &AnyBlend, children: &[Arc<Node>]) -> Arc<Node> {
    let blend = blend.clone();
    Node::combination(Combination { operation, blend }, children.to_vec())
        .expect("a valid combination")
}

/// The union, or what the blend is where it is an operation of its own.
fn blended(blend: &AnyBlend, children: &[Arc<Node>]) -> Arc<Node> {
    joined(operations(blend)[0], blend, children)
}

/// The blend as a field over the plane: its value at (a, b) is that for fields with the values a and b.
fn plane_of(blend: &AnyBlend) -> Arc<Node> {
    let fields = [
        half_space([1.0, 0.0, 0.0], 0.0),
        half_space([0.0, 1.0, 0.0], 0.0),
    ];
    blended(blend, &fields)
}

fn value(node: &Node, p: [f64; 3]) -> f64 {
    node.evaluate(&Vec3::splat(p))
}

fn gradient(node: &Node, p: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = std::array::from_fn(|i| Dual::<f64, 3>::variable(p[i], i));
    node.evaluate(&Vec3::new(x, y, z)).partial
}

/// Several instances of every blend.
fn zoo() -> Vec<AnyBlend> {
    (0..4)
        .flat_map(|seed| blends(&mut Dice::new(700 + seed)))
        .collect()
}

/// Values of two fields, at all scales and with small and large differences.
fn pair(dice: &mut Dice) -> [f64; 2] {
    let size = 10.0_f64.powf(dice.between(-2.0, 1.5));
    let a = dice.between(-size, size);
    [a, a + dice.between(-size, size)]
}

#[test]
fn rules_hold_over_the_plane_of_values_and_are_attained() {
    for (i, blend) in zoo().iter().enumerate() {
        let node = plane_of(blend);
        let mut dice = Dice::new(i as u64);
        let partials: Vec<[f64; 3]> = (0..20_000)
            .map(|_| pair(&mut dice))
            .map(|[a, b]| gradient(&node, [a, b, 0.0]))
            .collect();
        for (a, b) in [(1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (2.0, 1.0), (0.3, 1.5)] {
            let steepest = partials
                .iter()
                .map(|[u, v, _]| u.abs() * a + v.abs() * b)
                .fold(0.0, f64::max);
            let rule = blend.lipschitz(a, b);
            assert!(
                steepest <= rule * (1.0 + 1e-12) && rule <= 1.01 * steepest,
                "{blend:?} of {a} and {b}: rule {rule}, found {steepest}"
            );
        }
    }
}

#[test]
fn slopes_of_half_spaces_at_all_angles_stay_below_the_rule() {
    for (i, blend) in zoo().iter().enumerate() {
        let mut dice = Dice::new(100 + i as u64);
        for angle in (0..=12).map(|i| f64::from(i) * std::f64::consts::PI / 12.0) {
            let fields = [
                half_space([1.0, 0.0, 0.0], 0.0),
                half_space([angle.cos(), angle.sin(), 0.0], dice.between(-0.5, 0.5)),
            ];
            for operation in operations(blend) {
                let node = joined(operation, blend, &fields);
                for _ in 0..200 {
                    let p = dice.point(&Bounds::centred([1.5; 3]));
                    let step = dice.point(&Bounds::centred([0.1; 3]));
                    let q = std::array::from_fn(|i| p[i] + step[i]);
                    let length = step[0].hypot(step[1]).hypot(step[2]);
                    let change = (value(&node, p) - value(&node, q)).abs();
                    assert!(
                        change <= node.lipschitz() * length * (1.0 + 1e-12) + 1e-14,
                        "{blend:?}, {operation:?}, {angle}: {p:?} to {q:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn seams_are_monotone_symmetric_and_below_the_minimum() {
    let seams = zoo()
        .into_iter()
        .filter(|blend| blend.manner() == Manner::Seam);
    for (i, blend) in seams.enumerate() {
        let node = plane_of(&blend);
        let mut dice = Dice::new(200 + i as u64);
        for _ in 0..5000 {
            let [a, b] = pair(&mut dice);
            let [u, v, _] = gradient(&node, [a, b, 0.0]);
            let (there, back) = (value(&node, [a, b, 0.0]), value(&node, [b, a, 0.0]));
            assert!(u >= 0.0 && v >= 0.0, "{blend:?} at {a}, {b}: {u}, {v}");
            assert!(
                there <= a.min(b) + 1e-14 && (there - back).abs() < 1e-13,
                "{blend:?} at {a}, {b}: {there}, {back}"
            );
        }
    }
}

#[test]
fn seams_are_the_formulas_of_their_sources() {
    // hg_sdf's and Quilez' own forms, in their parameters.
    let remainder = |x: f64, m: f64| x - m * (x / m).floor();
    let stairs = |a: f64, b: f64, k: f64, n: f64| {
        let (s, r) = (k / n, k + k / n);
        let wave = (remainder(b - r - a + s, 2.0 * s) - s).abs();
        a.min(b).min(0.5 * (b - r + a + wave))
    };
    let circular = |a: f64, b: f64, k: f64| {
        let h = (k - (a - b).abs()).max(0.0) / k;
        a.min(b) - k * 0.5 * (1.0 + h - (1.0 - h * (h - 2.0)).sqrt())
    };
    let exponential = |a: f64, b: f64, k: f64| -k * ((-a / k).exp2() + (-b / k).exp2()).log2();
    let mut dice = Dice::new(300);
    for _ in 0..3000 {
        let [k, a, b] = [
            dice.between(0.1, 1.0),
            dice.between(-1.0, 1.0),
            dice.between(-1.0, 1.0),
        ];
        let n = 1.0 + dice.below(6) as f64;
        let at = |blend: AnyBlend| value(&plane_of(&blend), [a, b, 0.0]);
        let pairs = [
            (at(AnyBlend::Stairs(Stairs::new(k, n))), stairs(a, b, k, n)),
            (at(AnyBlend::Circular(Circular::new(k))), circular(a, b, k)),
            (
                at(AnyBlend::Exponential(Exponential::new(k))),
                exponential(a, b, k),
            ),
        ];
        for (found, expected) in pairs {
            assert!(
                (found - expected).abs() < 1e-13,
                "{found}, {expected} at {a}, {b}, {k}, {n}"
            );
        }
    }
}

#[test]
fn a_blend_without_width_is_hard() {
    for declaration in AnyBlend::DECLARATIONS {
        if declaration.parameters.first().is_none_or(|p| p.name != "k") {
            continue;
        }
        let arguments: Vec<Argument> = declaration
            .parameters
            .iter()
            .map(|p| p.default.map_or(Argument::Number(0.0), |default| default()))
            .collect();
        let blend = AnyBlend::from_arguments(declaration.name, &arguments).expect("listed by name");
        assert!(blend.is_hard(), "{blend:?}");
        let node = plane_of(&blend);
        for (a, b) in [(0.3, 0.3), (-0.3, -0.3), (0.0, 0.0), (-2.0, 1.0)] {
            assert_eq!(value(&node, [a, b, 0.0]), f64::min(a, b), "{blend:?}");
        }
        let refused = declaration.parameters[0].range;
        assert!(
            !refused.contains(-0.1) && !refused.contains(f64::NAN),
            "{}",
            declaration.name
        );
    }
}

#[test]
fn huge_and_tiny_values_do_not_overflow() {
    for blend in zoo().iter().filter(|b| b.manner() == Manner::Seam) {
        let node = plane_of(blend);
        for (a, b) in [
            (1e150, 1e150),
            (-1e150, 1e150),
            (1e9, -1e9),
            (1e-300, 1e-300),
            (1e-300, -1e150),
        ] {
            let found = value(&node, [a, b, 0.0]);
            assert!(
                found.is_finite() && found <= f64::min(a, b),
                "{blend:?} at {a}, {b}: {found}"
            );
        }
    }
    // Catalogue C34: 2^(1000) overflows in the textbook form.
    let node = plane_of(&AnyBlend::Exponential(Exponential::new(0.1)));
    for x in [-100.0, 200.0] {
        assert!((value(&node, [x, x, 0.0]) - (x - 0.1)).abs() < 1e-12);
        assert_eq!(value(&node, [x, x + 90.0, 0.0]), x);
    }
}

#[test]
fn copies_fold_as_deep_as_is_known() {
    // The quadratic blend of n equal fields, folded: d <- d + (k - d)^2 / 4k; the exponential: k log2 n.
    let mut expected = 0.0;
    for n in 2..=64 {
        expected += (1.0 - expected) * (1.0 - expected) / 4.0;
        let copies = vec![sphere(2.0); n];
        let smooth = blended(&AnyBlend::Smooth(Smooth::new(1.0)), &copies);
        assert!(
            (value(&smooth, [2.0, 0.0, 0.0]) + expected).abs() < 1e-12,
            "{n}"
        );
        let exponential = blended(&AnyBlend::Exponential(Exponential::new(0.1)), &copies);
        let depth = 0.1 * (n as f64).log2();
        assert!(
            (value(&exponential, [2.0, 0.0, 0.0]) + depth).abs() < 1e-12,
            "{n}"
        );
    }
}

#[test]
fn copies_lie_within_the_box_of_their_union() {
    for blend in zoo() {
        for n in [2, 3, 7, 40] {
            if blend.manner() == Manner::Pair && n != 2 {
                continue;
            }
            let node = blended(&blend, &vec![sphere(1.0); n]);
            let reach = node.sublevel(0.25).high[0];
            for i in 0..400 {
                let x = 0.01 * f64::from(i);
                assert!(
                    value(&node, [x, 0.0, 0.0]) > 0.25 || x <= reach + 1e-12,
                    "{n} times {blend:?}: {x} is outside of {reach}"
                );
            }
        }
    }
}

#[test]
fn a_chain_of_chamfers_gets_steeper_and_a_tree_steeper_still() {
    let chamfer = AnyBlend::Chamfer(Chamfer::new(0.2));
    let floors: Vec<_> = (0..12)
        .map(|i| half_space([0.0, 1.0, 0.0], 1e-3 * f64::from(i)))
        .collect();
    // Parallel gradients attain the rule deep inside, where every piece is the slanted one.
    let slope = |node: &Node| gradient(node, [0.0, -50.0, 0.0])[1];
    let mut expected: f64 = 1.0;
    for n in 2..=12 {
        expected = (expected + 1.0) / 2.0_f64.sqrt();
        let chain = blended(&chamfer, &floors[..n]);
        assert!((chain.lipschitz() - expected).abs() < 1e-12, "{n}");
        assert!((slope(&chain) - expected).abs() < 1e-12, "{n}");
    }
    let mut row = floors[..8].to_vec();
    for depth in 1..=3 {
        row = row.chunks(2).map(|pair| blended(&chamfer, pair)).collect();
        let expected = 2.0_f64.sqrt().powi(depth);
        assert!((row[0].lipschitz() - expected).abs() < 1e-12);
        assert!((slope(&row[0]) - expected).abs() < 1e-12);
        assert_eq!(row[0].class(), Class::Lipschitz);
    }
}

#[test]
fn classes_follow_the_constants() {
    for blend in zoo() {
        let node = blended(&blend, &[sphere(1.0), sphere(0.7)]);
        let expected = if node.lipschitz() > 1.0 {
            Class::Lipschitz
        } else {
            Class::Bound
        };
        assert_eq!(node.class(), expected, "{blend:?}");
        assert_eq!(node.rule(), blend.rule());
    }
}

fn painted(node: &Node, name: &str) -> Arc<Node> {
    node.painted(Arc::new(Material {
        name: name.into(),
        ..Material::default()
    }))
}

#[test]
fn materials_mix_by_partial_derivatives() {
    for (i, blend) in zoo().iter().enumerate() {
        let mut dice = Dice::new(400 + i as u64);
        let (a, b) = (
            painted(&half_space([1.0, 0.0, 0.0], 0.0), "a"),
            painted(&half_space([0.0, 1.0, 0.0], 0.0), "b"),
        );
        for operation in operations(blend) {
            let node = joined(operation, blend, &[a.clone(), b.clone()]);
            for _ in 0..500 {
                let p = dice.point(&Bounds::centred([0.6; 3]));
                let [u, v, _] = gradient(&node, p).map(f64::abs);
                let (mut of_a, mut of_b, mut sum) = (0.0, 0.0, 0.0);
                for share in shares(&node, p) {
                    assert!(share.weight >= 0.0);
                    sum += share.weight;
                    match share.material.expect("both are painted").name.as_str() {
                        "a" => of_a += share.weight,
                        _ => of_b += share.weight,
                    }
                }
                assert!((sum - 1.0).abs() < 1e-15, "{blend:?} at {p:?}: {sum}");
                let expected = [u / (u + v), v / (u + v)];
                assert!(
                    (of_a - expected[0]).abs() < 1e-12 && (of_b - expected[1]).abs() < 1e-12,
                    "{blend:?}, {operation:?} at {p:?}: {of_a}, {of_b}, not {expected:?}"
                );
            }
        }
    }
}

#[test]
fn a_guide_without_paint_leaves_its_body_in_one_material() {
    let body = painted(&sphere(1.0), "body");
    let guide = half_space([1.0, 0.0, 0.0], 0.0);
    for blend in zoo().iter().filter(|blend| blend.is_tool()) {
        let node = blended(blend, &[body.clone(), guide.clone()]);
        for y in [0.9, 0.95, 1.0, 1.05] {
            let found = shares(&node, [0.01, y, 0.0]);
            let names: Vec<_> = found
                .iter()
                .filter_map(|s| s.material)
                .map(|m| &*m.name)
                .collect();
            assert!(
                names.iter().all(|name| *name == "body") && !names.is_empty(),
                "{blend:?}"
            );
        }
    }
}

#[test]
fn operations_and_blends_do_not_mix() {
    let two = vec![sphere(1.0), sphere(0.5)];
    let made = |operation, blend, children: &[Arc<Node>]| {
        Node::combination(Combination { operation, blend }, children.to_vec())
    };
    let morph = || AnyBlend::Morph(Morph::new(0.5));
    assert!(made(Operation::Union, morph(), &two).is_err());
    assert!(made(Operation::Joint, AnyBlend::Smooth(Smooth::new(0.1)), &two).is_err());
    assert!(made(Operation::Joint, AnyBlend::HARD, &two).is_err());
    assert!(made(Operation::Joint, morph(), &two[..1]).is_err());
    assert!(made(Operation::Joint, morph(), &two).is_ok());
    assert!(made(Operation::Joint, AnyBlend::Xor(Xor {}), &[]).is_err());
}
