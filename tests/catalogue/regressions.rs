//! Constants that are wrong elsewhere, by name: for each the constant that is taken there, a witness that refutes it, and
//! ours, which holds and is tight.
//!
//! The first seven are the node types of issue 85 of deadsy/sdfx, whose fields are steeper than 1 though they are traced
//! as distances; the others are the formulas that libraries of distance functions give with a constant that is too small.
//! There is no entry for voxels: a grid of values is a user's field here.

use super::ascent::{Effort, highest};
use super::laws::{slope_at, surroundings, value};
use super::samples::Dice;
use super::stub::Marcher;
use fieldstone::lang;
use fieldstone::scene::Node;
use std::sync::Arc;

/// The shape that a script shows.
fn shown(script: &str) -> Arc<Node> {
    let loaded = lang::load_text("regression.sdf", script, &[], &Marcher)
        .unwrap_or_else(|report| panic!("{report}"));
    loaded.scene.shown[0].clone()
}

/// Checks a shape against the constant that others take for it: two points refute that one, none that is found refutes
/// ours, and ours is at most `slack` times the steepest slope that is found.
fn refutes(script: &str, wrong: f64, slack: f64) {
    let node = shown(script);
    let (region, ours) = (surroundings(&node), node.lipschitz());
    let place = |v: &[f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| region.low[k] + v[k] * (region.high[k] - region.low[k]))
    };
    let effort = Effort {
        samples: 20_000,
        climbs: 8,
        steps: 200,
    };
    let slope = |v: &[f64; 3]| slope_at(&node, place(v));
    let (top, steepest) = highest(slope, &mut Dice::new(0), effort, f64::INFINITY);
    // The witness does not rely on derivatives.
    let p = place(&top);
    let secant = (0..4000)
        .map(|i| {
            let mut dice = Dice::new(i);
            let q = p.map(|c| c + dice.between(-1e-4, 1e-4));
            let distance = (0..3).map(|k| p[k] - q[k]).fold(0.0, f64::hypot);
            (value(&node, p) - value(&node, q)).abs() / distance
        })
        .fold(0.0, f64::max);
    println!(
        "taken {wrong:.4}, found {steepest:.4}, ours {ours:.4}, slack {:.4}",
        ours / steepest
    );
    assert!(
        secant > 1.02 * wrong,
        "{wrong} is not refuted: the slope is {secant} near {p:?}"
    );
    assert!(
        steepest <= ours * (1.0 + 1e-9),
        "{steepest} at {p:?} is above {ours}"
    );
    assert!(
        ours <= slack * steepest,
        "{ours} is loose: {steepest} found"
    );
}

/// Checks that a claim of `wrong` for the number `field` of the point p is refused, with a witness.
fn claim_is_refuted(field: &str, wrong: f64) {
    let script = format!("field f(p) lipschitz {wrong} {{ {field} }}\nshow f & box(2)");
    match lang::load_text("regression.sdf", &script, &[], &Marcher) {
        Ok(_) => panic!("{wrong} is believed"),
        Err(report) => assert!(report.to_string().contains("refuted"), "{report}"),
    }
}

#[test]
fn sdfx_85_twisted_extrusion() {
    let bar = "rectangle([1, 0.6]).extrude(2).rotate(x: 90deg)";
    refutes(&format!("show {bar}.twist(rate: 90deg)"), 1.0, 1.6);
    // Cut by a slanted plane it has the gradient for which the rule is attained.
    let cut = format!("({bar} & plane([1, 0.55, 0], -0.4))");
    refutes(&format!("show {cut}.twist(rate: 90deg)"), 1.0, 1.05);
    claim_is_refuted(&format!("{bar}.twist(rate: 90deg).at(p)"), 1.0);
}

#[test]
fn sdfx_85_scaled_extrusion() {
    // A square that shrinks to a quarter on the way up: its upper end is four times as steep as the square.
    refutes("show rectangle([1, 1]).extrude(1, scale: 0.25)", 1.0, 2.0);
    refutes(
        "show rectangle([1, 1]).extrude(1, twist: 120deg, scale: 0.25)",
        1.0,
        2.0,
    );
    let cut = "(box([1, 1, 1]) & plane([1, 0.3, 0], -0.4))";
    refutes(&format!("show {cut}.taper(top: 0.25)"), 1.0, 1.05);
}

#[test]
fn sdfx_85_transform() {
    // f(p / s) without the factor: a ball flattened to a tenth is ten times as steep.
    claim_is_refuted("sphere(1).at(p / [1, 0.1, 1])", 1.0);
    claim_is_refuted("sphere(1).at(p / [1, 0.1, 1])", 9.0);
    let node = shown("show sphere(1).scale([1, 0.1, 1])");
    assert!((node.lipschitz() - 1.0).abs() < 1e-12);
    // From 2 above the centre, the surface is 1.9 away.
    assert!(value(&node, [0.0, 2.0, 0.0]) <= 1.9 + 1e-12);
    refutes("show sphere(1).scale([1, 0.1, 1])", 0.9, 1.05);
    // A shear by 1 has norm (1 + sqrt(5)) / 2, by which the field is divided.
    claim_is_refuted("sphere(1).at([p.x - p.y, p.y, p.z])", 1.0);
    claim_is_refuted("sphere(1).at([p.x - p.y, p.y, p.z])", 1.6);
    refutes("show sphere(1).shear([1, 0, 0])", 0.9, 1.05);
}

#[test]
fn sdfx_85_loft() {
    // From a small circle below to a large square above.
    let loft = "let t = clamp(p.z + 0.5, 0, 1) \
                return (length([p.x, p.y]) - 0.2) * (1 - t) + (max(abs(p.x), abs(p.y)) - 1) * t";
    claim_is_refuted(loft, 1.0);
    refutes(
        &format!("field loft(p) {{ {loft} }}\nshow loft & box([2, 2, 1])"),
        1.0,
        1.2,
    );
}

#[test]
fn sdfx_85_voxel() {
    // Values that differ by 1 along every edge of a cell, between them what is linear in each coordinate.
    let cell = "let u = fract(p) \
                let a = mix(mix(0, 1, u.x), mix(1, 2, u.x), u.y) \
                let b = mix(mix(1, 2, u.x), mix(2, 3, u.x), u.y) \
                return mix(a, b, u.z) - 1";
    let inside = cell.replace("fract(p)", "p + 0.5");
    claim_is_refuted(&inside, 1.0);
    claim_is_refuted(&inside, 1.7);
    refutes(
        &format!("field cell(p) {{ {inside} }}\nshow cell & box(1)"),
        1.0,
        1.1,
    );
}

#[test]
fn sdfx_85_screw() {
    // A thread away from the axis, with a constant for the radius of its profile.
    let (rate, radius) = (2.0, 0.15);
    let s: f64 = rate * radius;
    let assumed = 0.5 * s + (1.0 + 0.25 * s * s).sqrt();
    let thread = "circle(0.15).translate([0.6, 0, 0]).extrude(2).rotate(x: 90deg)";
    refutes(
        &format!("show {thread}.twist(rate: {rate}rad)"),
        assumed,
        2.0,
    );
    refutes(
        &format!("show {thread}.twist(rate: {rate}rad)"),
        (1.0 + s * s).sqrt(),
        2.0,
    );
}

const GYROID: &str = "sin(p.x) * cos(p.y) + sin(p.y) * cos(p.z) + sin(p.z) * cos(p.x)";

#[test]
fn sdfx_85_gyroid() {
    // sqrt(3), at the origin among others: all three cosines 1.
    claim_is_refuted(GYROID, 1.0);
    claim_is_refuted(GYROID, 1.7);
    let field = format!("field gyroid_of(p) {{ {GYROID} }}\n");
    refutes(&format!("{field}show gyroid_of & box(2)"), 1.0, 1.05);
    refutes("show gyroid() & box(2)", 0.9, 1.05);
    let node = shown(&format!("{field}show gyroid_of & box(2)"));
    assert!((3.0_f64.sqrt()..1.04 * 3.0_f64.sqrt()).contains(&node.lipschitz()));
}

#[test]
fn a_chamfer_of_parallel_faces_is_steeper_than_they_are() {
    // Both fields grow along y, so the chamfer (a + b - k) / sqrt(2) grows by sqrt(2).
    let script = "show union(plane(\"y\", 0), plane(\"y\", 0.05), blend: chamfer(0.2))";
    refutes(script, 1.0, 1.0001);
    let node = shown(script);
    let at = |y: f64| value(&node, [0.3, y, 0.1]);
    // The surface is at y = 0.125. Taken as a distance, the value at y = 1 leads to y = 0.05: through it.
    assert!(at(0.125).abs() < 1e-12);
    assert!((at(1.0) - 0.95).abs() < 1e-12 && at(1.0) / node.lipschitz() < 0.875);
    // Chamfers of chamfers: sqrt(2) each time.
    let twice = "let a = union(plane(\"y\", 0), plane(\"y\", 0.05), blend: chamfer(0.4))\n\
                 show union(a, a.translate([0, 0.02, 0]), blend: chamfer(0.8))";
    refutes(twice, 2.0_f64.sqrt(), 1.0001);
}

#[test]
fn displacement_is_more_than_its_amplitude() {
    // 0.045 sin 20x sin 20y sin 20z is as steep as 0.9, whatever its amplitude; Galin et al. 2020 and issue 550 of
    // DirectX-Graphics-Samples.
    let bumps = "torus(1, 0.25).at(p) + 0.045 * sin(20 * p.x) * sin(20 * p.y) * sin(20 * p.z)";
    claim_is_refuted(bumps, 1.045);
    let script = format!("field bumpy(p) {{ {bumps} }}\nshow bumpy & box([2.7, 0.7, 2.7])");
    refutes(&script, 1.045, 1.2);
    let bumps = "length(p) - 1 + 0.15 * sin(12 * p.x) * sin(12 * p.y) * sin(12 * p.z)";
    claim_is_refuted(bumps, 1.15);
    refutes(
        &format!("field bumpy(p) {{ {bumps} }}\nshow bumpy & box(2.4)"),
        1.15,
        1.2,
    );
}

#[test]
fn twist_grows_with_the_radius() {
    // Four wide, with the constant for a radius of 1.
    let assumed = 0.5 + 1.25_f64.sqrt();
    let bar = "(box([4, 2, 0.5]) & plane([1, 0.55, 0], -2))";
    refutes(&format!("show {bar}.twist(rate: 1rad)"), assumed, 1.05);
}

#[test]
fn an_ellipsoid_is_as_steep_as_its_shortest_axis() {
    let radii = "[1, 0.3, 0.3]";
    claim_is_refuted(&format!("length(p / {radii}) - 1"), 1.0);
    claim_is_refuted(&format!("length(p / {radii}) - 1"), 3.3);
    // Quilez' quotient of gauges: below the distance outside, but not inside, where it jumps.
    let quotient =
        format!("let k = length(p / {radii}) return k * (k - 1) / length(p / ({radii} * {radii}))");
    claim_is_refuted(&quotient, 1.0);
    refutes(&format!("show ellipsoid({radii})"), 0.9, 1.05);
}

#[test]
fn a_small_steep_ball_beside_a_plane() {
    let field = "field both(p) { min(p.y + 1, 20 * (length(p - [0.5, -0.6, 0]) - 0.1)) }\nshow both & box(2)";
    refutes(field, 1.0, 1.05);
}
