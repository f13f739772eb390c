//! The language against values worked out by hand.

mod stub;

use fieldstone::catalogue::{AnyBlend, AnyModifier, AnyPrimitive};
use fieldstone::lang::{self, Loaded, Report, limits};
use fieldstone::scene::{Falloff, Method, Model, Node, Projection, Sampling, Shadow, Source};
use glam::DVec3;
use std::f64::consts::PI;
use stub::Marcher;

fn load(script: &str) -> Result<Loaded, Report> {
    lang::load_text("test.sdf", script, &[], &Marcher)
}

fn loaded(script: &str) -> Loaded {
    load(script).unwrap_or_else(|report| panic!("{script}\n{report}"))
}

/// The errors of a script that is wrong, as text.
fn errors(script: &str) -> String {
    match load(script) {
        Err(report) => report.to_string(),
        Ok(_) => panic!("{script}\nis not wrong"),
    }
}

/// Every expectation holds, each in a test of its own, after the definitions.
fn holds(definitions: &str, expectations: &[&str]) {
    let tests: String = expectations
        .iter()
        .map(|e| format!("test \"t\" {{ expect {e} }}\n"))
        .collect();
    let loaded = loaded(&format!("{definitions}\n{tests}"));
    let failures: String = loaded
        .run_tests(&Marcher)
        .iter()
        .map(|result| result.failures.to_string())
        .collect();
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn operators_bind_as_documented() {
    holds(
        "",
        &[
            "1 + 2 * 3 == 7",
            "(1 + 2) * 3 == 9",
            "-2^2 == -4",
            "(-2)^2 == 4",
            "2^3^2 == 512",
            "2^-1 == 0.5",
            "10 - 4 - 3 == 3",
            "64 / 4 / 2 == 8",
            "7 % 3 == 1",
            "-7 % 3 == 2",
            "2 * -3 == -6",
            "- - 3 == 3",
            "1 < 2 and 2 < 3",
            "not 1 > 2",
            "not 1 == 2",
            "true or false and false",
            "(true or false) and not false",
            "false or not false",
            "1 + 1 == 2 and 2 + 2 == 4",
            "1e-3 == 0.001",
            "1.5e2 == 150",
            "2E+2 == 200",
        ],
    );
}

#[test]
fn the_second_condition_is_not_asked_where_the_first_decides() {
    holds(
        "",
        &[
            "not (false and [1, 2, 3, 4][9] == 0)",
            "true or [1, 2, 3, 4][9] == 0",
        ],
    );
}

#[test]
fn ranges_count_as_documented() {
    holds(
        "",
        &[
            "len(0..5) == 5",
            "len(0..=5) == 6",
            "len(0..1 step 0.1) == 10",
            "len(0..=1 step 0.1) == 11",
            "len(1..5) == 4",
            "len(5..1) == 0",
            "len(5..1 step -1) == 4",
            "sum(0..=100) == 5050",
            "(0..10 step 2)[3] == 6",
            "max(0..10) == 9",
            "len(0..0) == 0",
            "for i in 3..0 step -1 { i } == [3, 2, 1]",
            "len(0..2.5) == 3",
            "len(0deg..360deg step 45deg) == 8",
            "(0deg..=90deg step 30deg)[2] == 60deg",
        ],
    );
}

#[test]
fn vectors_work_by_components() {
    holds(
        "let a = [1, 2, 3]\nlet b = [4, 5, 6]",
        &[
            "a + b == [5, 7, 9]",
            "b - a == [3, 3, 3]",
            "a * b == [4, 10, 18]",
            "b / [2, 5, 3] == [2, 1, 2]",
            "a * 2 == [2, 4, 6]",
            "2 * a == [2, 4, 6]",
            "-a == [-1, -2, -3]",
            "a.x == 1 and a.y == 2 and a.z == 3",
            "a[0] == 1 and a[2] == 3",
            "dot(a, b) == 32",
            "a.dot(b) == 32",
            "cross([1, 0, 0], [0, 1, 0]) == [0, 0, 1]",
            "length([3, 4]) == 5",
            "length([2, 3, 6]) == 7",
            "normalize([0, 3, 4]) == [0, 0.6, 0.8]",
            "distance([1, 1], [4, 5]) == 5",
            "mix(a, b, 0.5) == [2.5, 3.5, 4.5]",
            "clamp([-1, 0.5, 2], 0, 1) == [0, 0.5, 1]",
            "min(a, [2, 2, 2]) == [1, 2, 2]",
            "max(a, 2) == [2, 2, 3]",
            "abs([-1, 2]) == [1, 2]",
            "floor([1.5, -1.5]) == [1, -2]",
            "fract([1.25, 2.5]) == [0.25, 0.5]",
            "[1, 2]^2 == [1, 4]",
            "[1, 2] != [1, 2, 3]",
        ],
    );
}

#[test]
fn angles_carry_units() {
    holds(
        "",
        &[
            "180deg == 0.5turn",
            "abs(180deg / 1rad - pi) < 1e-15",
            "90deg + 0.25turn == 180deg",
            "2 * 45deg == 90deg",
            "90deg / 45deg == 2",
            "-90deg < 0deg",
            "abs(sin(30deg) - 0.5) < 1e-15",
            "abs(sin(pi / 6) - 0.5) < 1e-15",
            "abs(cos(60deg) - 0.5) < 1e-15",
            "abs(370deg % 360deg - 10deg) < 1e-12 * 1rad",
            "max(30deg, 45deg) == 45deg",
            "mix(0deg, 90deg, 0.5) == 45deg",
            "abs(atan2(1, 1) * 4 - pi) < 1e-15",
            "tau == 2 * pi",
        ],
    );
}

#[test]
fn colors_are_linear_inside() {
    holds(
        "",
        &[
            "#fff == rgb(1, 1, 1)",
            "#000 == rgb(0, 0, 0)",
            "#f00.r == 1 and #f00.g == 0",
            "abs(#808080.g - 0.2158605) < 1e-7",
            "#ff0000 + #00ff00 == rgb(1, 1, 0)",
            "#fff * 0.5 == rgb(0.5, 0.5, 0.5)",
            "mix(#000, #fff, 0.25) == rgb(0.25, 0.25, 0.25)",
        ],
    );
}

#[test]
fn if_and_for_are_expressions() {
    holds(
        "let xs = for i in 0..5 { i * i }",
        &[
            "if 1 < 2 { 3 } else { 4 } == 3",
            "if 1 > 2 { 3 } else if 2 > 1 { 5 } else { 4 } == 5",
            "xs[4] == 16",
            "len(xs) == 5",
            "for i in xs if i % 2 == 0 { i } == [0, 4, 16]",
            "sum(for v in [[1, 2], [3, 4]] { v.x * v.y }) == 14",
            "for i in 0..2 { let j = i + 1 return j * 10 } == [10, 20]",
            "len(for i in 0..3 { for j in 0..4 { i + j } }) == 3",
            "(for i in 0..3 { for j in 0..4 { i + j } })[2][3] == 5",
            "len(concat(xs, [7, 8])) == 7",
            "reverse([1, 2, 3]) == [3, 2, 1]",
            "min(3, 1, 2, 5) == 1",
            "max(xs) == 16",
        ],
    );
}

#[test]
fn functions_have_defaults_names_and_recursion() {
    holds(
        "fn f(x, y = 2) { x * 10 + y }\n\
         fn factorial(n) { if n < 2 { 1 } else { n * factorial(n - 1) } }\n\
         fn twice(g, x) { g(g(x)) }\n\
         fn inc(x) { x + 1 }\n\
         fn later(x) { defined_below(x) }\n\
         fn defined_below(x, y = x) { x + y }\n\
         fn hyp(a, b) { let c = a * a + b * b return sqrt(c) }",
        &[
            "f(1) == 12",
            "f(1, 3) == 13",
            "f(y: 5, x: 4) == 45",
            "f(1, y: 7) == 17",
            "3.f() == 32",
            "3.f(y: 4) == 34",
            "factorial(10) == 3628800",
            "twice(inc, 3) == 5",
            "later(4) == 8",
            "hyp(3, 4) == 5",
            "twice(sqrt, 16) == 2",
            "(3).inc() == 4",
        ],
    );
}

#[test]
fn words_of_statements_are_free_as_names() {
    holds(
        "let light = 1\nlet camera = light + 1\nlet test = [camera, 3]\nfn sky(fog) { fog * 2 }\nfn g(material) { material }",
        &[
            "test.x == 2",
            "sky(fog: 3) == 6",
            "g(material: 4) == 4",
            "sky(light) == 2",
        ],
    );
}

#[test]
fn comments_nest_and_line_ends_mean_nothing() {
    holds(
        "/* a /* b */ c */ let a = // one\r\n  1\r\n\t+ 2 let b = a\n* 3",
        &["a == 3", "b == 9"],
    );
}

#[test]
fn fields_answer_as_numbers_and_as_shapes() {
    let script = "field ball(p, r = 1) { length(p) - r }\nfield bump(p) { if p.x > 0 { p.y } else { p.z } }\n\
         field both(p) { max(ball(p), p.y) }\nfield around(p) { sphere(0.5).at(p * 2) }\n\
         field poly(p) { p.x^3 + p.y^2 - p.z^-1 }\n\
         field sums(p) { sum(for i in 0..3 { p[i] * i }) }\n\
         field either(p) { if p.x < 0 or p.y < 0 and not (p.z == 1) { 1 } else { 2 } }";
    holds(
        script,
        &[
            "ball([3, 0, 4]) == 4",
            "ball([3, 0, 4], r: 2) == 3",
            "ball.at([3, 0, 4]) == 4",
            "ball(r: 2).at([3, 0, 4]) == 3",
            "bump([1, 2, 3]) == 2 and bump([-1, 2, 3]) == 3",
            "bump.at([1, 2, 3]) == 2 and bump.at([-1, 2, 3]) == 3",
            "both.at([3, 5, 4]) == both([3, 5, 4])",
            "around.at([0.5, 0, 0]) == 0.5",
            "poly.at([-2, 3, 4]) == 0.75",
            "poly([-2, 3, 4]) == 0.75",
            "sums.at([5, 6, 7]) == 20",
            "either.at([-1, 1, 1]) == 1",
            "either.at([1, -1, 1]) == 2",
            "either.at([1, -1, 0]) == 1",
            "either.at([1, 1, 0]) == 2",
            "either([1, -1, 0]) == 1",
            "(ball & box(1)).at([0, 0, 0]) == -0.5",
            "ball.shell(0.2).at([0, 0, 0]) == 0.9",
        ],
    );
}

#[test]
fn shapes_combine_as_sets() {
    holds(
        "let s = sphere(1)\nlet b = s.translate([3, 0, 0])\nlet list = [s, b]",
        &[
            "(s | b).at([3, 0, 0]) == -1",
            "(s & b).at([1.5, 0, 0]) == 0.5",
            "(s - b).at([0, 0, 0]) == -1",
            "(s - b - b).at([3, 0, 0]) == 2",
            "union(list).at([3, 0, 0]) == -1",
            "union(s, list).at([3, 0, 0]) == -1",
            "intersection(list).at([1.5, 0, 0]) == 0.5",
            "difference(s, list).at([0, 0, 0]) == 1",
            "s.union(b).at([3, 0, 0]) == -1",
            "(s - list).at([0, 0, 0]) == 1",
            "abs(union(s, s, blend: smooth(0.4)).at([1, 0, 0]) + 0.1) < 1e-15",
            "s.lipschitz == 1",
            "s.bounds.min == [-1, -1, -1]",
            "b.bounds.max == [4, 1, 1]",
            "b.bounds.center == [3, 0, 0]",
            "list.translate([0, 1, 0])[1].at([3, 1, 0]) == -1",
            "circle(1).translate([1, 2]).extrude(2).at([1, 2, 0]) == -1",
            "rectangle([2, 4]).scale([2, 1]).extrude(2).bounds.max == [2, 2, 1]",
            "box(2).at([0, 0, 0]) == -1",
            "plane(\"y\", 0.5).at([7, 2, 7]) == 1.5",
            "translate(s, [1, 0, 0]).at([1, 0, 0]) == -1",
            "s.class == \"exact\"",
        ],
    );
}

#[test]
fn blends_that_are_operations_take_shapes_first() {
    holds(
        "let s = sphere(1)\nlet b = sphere(2)\nlet far = s.translate([3, 0, 0])",
        &[
            "morph(s, b, t: 0.25).at([5, 0, 0]) == 3.75",
            "s.morph(b, 0.25).at([5, 0, 0]) == 3.75",
            "morph(s, b).at([5, 0, 0]) == 3.5",
            "morph([s, b], 0).at([5, 0, 0]) == 4",
            "s.xor(b).at([0, 0, 0]) == 1",
            "s.xor(b).at([1.5, 0, 0]) == -0.5",
            "xor(s, s, s).at([0, 0, 0]) == -1",
            "xor([s, far], b).at([3, 0, 0]) == -1",
            "s.pipe(plane(\"y\"), 0.1).at([2, 0, 0]) == 0.9",
            "s.groove(plane(\"y\"), depth: 0.3).at([0.9, 0, 0]) == 0.1",
            "s.tongue(plane(\"y\"), height: 0.3).at([1.2, 0, 0]) == -0.1",
            "abs(s.engrave(plane(\"y\"), 0.2).at([1, 0, 0]) - 0.2 * sqrt(0.5)) < 1e-15",
            "s.pipe(b, 0.1).lipschitz == sqrt(2)",
            "union(s, b, blend: chamfer(0.1)).lipschitz == sqrt(2)",
            "union(s, b, blend: chamfer(0)).lipschitz == 1",
            "union(s, b, blend: round(0.1)).class == \"lipschitz\"",
            "union(s, b, blend: stairs(0.3)).class == \"bound\"",
        ],
    );
    for (script, message) in [
        (
            "show morph(sphere(1), 0.5)",
            "`morph` takes two shapes, but here are 1",
        ),
        (
            "show morph(sphere(1), box(1), t: 2)",
            "`t` of `morph` must be between 0 and 1",
        ),
        (
            "show union(sphere(1), blend: morph(0.5))",
            "`morph` takes two shapes, but here are 0",
        ),
        (
            "show cubic(sphere(1), box(1), 0.2)",
            "`cubic` is a blend, not an operation",
        ),
        (
            "show union(sphere(1), box(1), blend: round(-0.1))",
            "`k` of `round` must be zero or positive",
        ),
    ] {
        let text = errors(script);
        assert!(text.contains(message), "{script}: {text}");
    }
}

#[test]
fn rays_can_be_asked() {
    holds(
        "let s = sphere(1)\nshow s.translate([0, 0, 1])",
        &[
            "abs(trace([0, 0, 5], [0, 0, -2]).t - 3) < 1e-6",
            "trace([0, 0, 5], [0, 0, -1]).hit",
            "not trace([0, 0, 5], [0, 0, 1]).hit",
            "trace([0, 0, 5], [0, 0, 1]).t == infinity",
            "trace([0, 0, 5], [0, 0, 1]).verdict == \"miss\"",
            "abs(s.trace([0, 0, 5], [0, 0, -1]).t - 4) < 1e-6",
            "trace([0, 0, 5], [0, 0, -1]).normal.z > 0.999",
            "trace([0, 0, 5], [0, 0, -1]).steps > 0",
        ],
    );
}

#[test]
fn noise_is_bounded_by_its_known_slope() {
    holds(
        "field n(p) { return noise(p * 4) }\n\
         field far(p) { return noise(p * 4 + [1000, 2000, 3000]) }\n\
         field v(p) { return voronoi(p * 3) }\n\
         field sum(p) { return fbm(p, octaves: 3, gain: 0.5, lacunarity: 3) }",
        &[
            "noise([3, -2, 7]) == 0",
            "noise([0.3, 0.6]) == noise([0.3, 0.6, 0])",
            "abs(noise([0.3, 0.6, 0.1]) - noise([289.3, -288.4, 0.1])) < 1e-12",
            "fbm([0.3, 0.6, 0.1], octaves: 1) == noise([0.3, 0.6, 0.1])",
            "n.at([0.1, 0.2, 0.3]) == noise([0.4, 0.8, 1.2])",
            // The point of the own cell is in [1/8, 7/8] along x and y, in [3/16, 13/16] along z.
            "voronoi([0.5, 0.5, 0.5]) <= sqrt(0.75^2 + 0.75^2 + 0.625^2) / 2",
            // 3.75 times the frequency, also on all of space.
            "n.lipschitz <= 15.000001",
            "(n & box(4)).lipschitz <= 15.000001",
            "far.lipschitz <= 15.000001",
            "v.lipschitz <= 3.000001",
            // 3.75 (1 + 1.5 + 2.25)
            "sum.lipschitz <= 17.812501",
        ],
    );
}

#[test]
fn patterns_of_noise_are_mixtures_of_their_colours() {
    let mixtures = [
        "marble(0, 1)",
        "wood(0, 1, width: 0.3)",
        "marble(0, 1, 2, 3)",
    ];
    for pattern in mixtures {
        holds(
            &format!(
                "let pattern_ = {pattern}\n\
                 let shares = for i in 0..200 {{ pattern_([rand(1, i), 4 * rand(2, i), 9 * rand(3, i)]) }}"
            ),
            &[
                "min(shares) >= 0",
                "max(shares) <= 1",
                "min(shares) < 0.1",
                "max(shares) > 0.6",
            ],
        );
    }
    let message = errors("material m { color: marble(#fff, 1) }\nshow sphere(1).paint(m)");
    assert!(
        message.contains("`marble` expects a colour here"),
        "{message}"
    );
    let message = errors("let x = fbm([0, 0, 0], octaves: 2.5)");
    assert!(
        message.contains("must be a whole number up to 20"),
        "{message}"
    );
    let message = errors("let x = noise(3)");
    assert!(message.contains("`noise` expects a point"), "{message}");
}

#[test]
fn displaced_shapes_add_values_and_constants() {
    holds(
        "field waves(p, depth = 0.05) { return depth * sin(20 * p.x) }\n\
         let ball = sphere(1).displace(waves)\n\
         let deep = sphere(1).displace(waves(depth: 0.1))\n\
         let both = [sphere(1), box(1)].displace(waves)",
        &[
            "abs(ball.at([1.2, 0, 0]) - (0.2 + 0.05 * sin(24))) < 1e-12",
            // Attained where both gradients point along x.
            "ball.lipschitz >= 2 and ball.lipschitz <= 2.03",
            "deep.lipschitz >= 3 and deep.lipschitz <= 3.06",
            // The surface is at most as far outside as the field is low.
            "ball.bounds.max.y >= 1.05 and ball.bounds.max.y < 1.0500001",
            "len(both) == 2 and abs(both[1].bounds.max.x - 0.55) < 1e-6",
        ],
    );
    let message = errors("field f(p) { return p.x }\nshow sphere(1).displace(f)");
    assert!(
        message.contains("the field `f` may fall without end"),
        "{message}"
    );
    assert!(message.contains("clamp(x, -0.2, 0.2)"), "{message}");
    let message = errors("show sphere(1).displace(box(1))");
    assert!(message.contains("`displace` expects a field"), "{message}");
}

#[test]
fn heightfields_are_blocks_of_ground() {
    holds(
        "field hills(p) { return 0.25 * sin(2 * p.x) * cos(p.z) }\n\
         let ground = heightfield(hills, size: [4, 2], base: -1)",
        &[
            "abs(ground.bounds.max.y - 0.25) < 0.02 and ground.bounds.max.y >= 0.2499",
            "ground.bounds.min.y == -1",
            "abs(ground.bounds.max.x - 2) < 1e-9 and abs(ground.bounds.min.z + 1) < 1e-9",
            "abs(ground.at([0.7, 0.2, 0.3]) - (0.2 - 0.25 * sin(1.4) * cos(0.3))) < 1e-12",
            // The slope of hills is at most 1/2.
            "ground.lipschitz >= 1.118 and ground.lipschitz < 1.152",
        ],
    );
    let message = errors("field h(p) { return p.x }\nshow heightfield(h, base: 2)");
    assert!(message.contains("must lie below the ground"), "{message}");
    let message = errors("field h(p) { return 1 / p.x }\nshow heightfield(h)");
    assert!(message.contains("have no bounds"), "{message}");
}

#[test]
fn random_numbers_depend_on_their_arguments_alone() {
    holds(
        "let xs = for i in 0..1000 { rand(1, i) }",
        &[
            "rand(1, 2) == rand(1, 2)",
            "rand(1, 2) != rand(2, 1)",
            "min(xs) >= 0 and max(xs) < 1",
            "abs(sum(xs) / 1000 - 0.5) < 0.03",
            "rand(0) == rand(-0)",
        ],
    );
}

#[test]
fn strings_are_joined_and_made() {
    holds(
        "",
        &[
            "\"a\" + \"b\" == \"ab\"",
            "str(1, \" \", 2.5) == \"1 2.5\"",
            "len(\"abc\") == 3",
            "str([1, 2]) == \"[1, 2]\"",
            "str(45deg) == \"45deg\"",
        ],
    );
}

#[test]
fn materials_take_constants_and_patterns() {
    let script = "pattern grain(p, scale = 2) { 0.5 + 0.5 * sin(p.x * scale) }\n\
         pattern wood(p) { mix(#321, #fff, grain(p, scale: 3)) }\n\
         material m { color: wood, ambient: 0.3, diffuse: grain(scale: 1), specular: 0, shininess: 8, model: \"blinn\", \
           reflect: checker(0, 1), refract: 0.5, ior: 1.3, fresnel: true, absorb: rgb(1, 2, 3), shadow: \"tinted\" }\n\
         show sphere(1).paint(m)";
    let loaded = loaded(script);
    let material = loaded.scene.shown[0].paint().expect("painted").clone();
    assert_eq!(material.name, "m");
    assert_eq!(material.ambient.at([0.0; 3]), 0.3);
    assert_eq!(material.model, Model::Blinn);
    assert_eq!(material.shadow, Shadow::Tinted);
    assert!(material.fresnel);
    assert_eq!(material.absorb.at([0.0; 3]), DVec3::new(1.0, 2.0, 3.0));
    let grain = |x: f64| 0.5 + 0.5 * x.sin();
    assert!((material.diffuse.at([0.7, 0.0, 0.0]) - grain(0.7)).abs() < 1e-12);
    // Green of #321 is #22: ((34 / 255 + 0.055) / 1.055)^2.4.
    let dark = 0.015_996_293_365_509_63;
    let green = dark + (1.0 - dark) * grain(2.1);
    assert!((material.color.at([0.7, 0.0, 0.0]).y - green).abs() < 1e-9);
    // Cells of edge 1, those along y centred on 0.
    assert_eq!(material.reflect.at([0.5, 0.0, 0.5]), 0.0);
    assert_eq!(material.reflect.at([1.5, 0.0, 0.5]), 1.0);
    assert_eq!(material.reflect.at([1.5, 0.0, -0.5]), 0.0);
    assert_eq!(material.reflect.at([0.5, 0.6, 0.5]), 1.0);
}

#[test]
fn the_stage_is_set() {
    let loaded = loaded(
        "show sphere(1)\n\
         camera { eye: [0, 0, 5], at: [0, 1, 0], up: [1, 0, 0], projection: \"orthographic\", height: 3 }\n\
         light { toward: [0, 2, 0], color: #f00, intensity: 2 }\n\
         light { position: [1, 2, 3], falloff: \"inverse-square\" }\n\
         light { position: [0, 4, 0], at: [0, 0, 0], angle: 60deg, softness: 0.5 }\n\
         sky { horizon: #000, zenith: #00f }\n\
         fog { color: #fff, density: 0.5 }\n\
         render { size: [320, 200], samples: 4, sampling: \"adaptive\", depth: 2, tolerance: 0.5, max_steps: 99, method: \"relaxed\", omega: 1.5, seed: 7 }",
    );
    let scene = &loaded.scene;
    assert_eq!(
        scene.camera.projection,
        Projection::Orthographic { height: 3.0 }
    );
    assert_eq!(scene.camera.up, DVec3::X);
    let [sun, bulb, spot] = &scene.lights[..] else {
        panic!("three lights");
    };
    assert_eq!(sun.source, Source::Directional { toward: DVec3::Y });
    assert_eq!(sun.radiance, DVec3::new(2.0, 0.0, 0.0));
    let position = DVec3::new(1.0, 2.0, 3.0);
    let falloff = Falloff::InverseSquare;
    assert_eq!(bulb.source, Source::Point { position, falloff });
    match spot.source {
        Source::Spot {
            axis, outer, inner, ..
        } => {
            assert_eq!(axis, DVec3::NEG_Y);
            assert!((outer - PI / 6.0).abs() < 1e-15);
            assert!((inner - PI / 12.0).abs() < 1e-15);
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(scene.sky.zenith, DVec3::Z);
    assert_eq!(scene.fog.map(|fog| fog.density), Some(0.5));
    let settings = &scene.settings;
    assert_eq!(
        (settings.size, settings.samples, settings.depth),
        ([320, 200], 4, 2)
    );
    assert_eq!((settings.max_steps, settings.seed), (99, 7));
    assert_eq!((settings.method, settings.omega), (Method::Relaxed, 1.5));
    assert_eq!(settings.sampling, Sampling::Adaptive);
}

#[test]
fn parameters_are_set_from_outside() {
    let script = "param n = 3 in 1..=9\nparam a = 30deg\nparam c = #fff\nparam s = \"x\" in [\"x\", \"yy\"]\n\
         param v = [1, 2, 3]\nparam on = true\nshow sphere(n + v.y)";
    let set = [
        ("n", "5"),
        ("a", "0.25turn"),
        ("c", "#000"),
        ("s", "yy"),
        ("v", "[4, -5, 6]"),
        ("on", "false"),
    ];
    let set = set.map(|(name, value)| (name.to_string(), value.to_string()));
    let script = script.replace("v.y", "0 * v.y");
    let loaded =
        lang::load_text("test.sdf", &script, &set, &Marcher).unwrap_or_else(|r| panic!("{r}"));
    let values: Vec<_> = loaded
        .parameters
        .iter()
        .map(|(_, value)| value.as_str())
        .collect();
    assert_eq!(
        values,
        ["5", "90deg", "rgb(0, 0, 0)", "yy", "[4, -5, 6]", "false"]
    );
    assert_eq!(loaded.scene.shown[0].bounds().high, [5.0; 3]);
}

#[test]
fn names_and_places_go_with_shapes() {
    let loaded = loaded(
        "let ball = sphere(1)\nlet again = ball\nlet two = [ball, box(1)]\nshow two\nshow\n  again",
    );
    let names: Vec<_> = loaded.names.keys().map(String::as_str).collect();
    assert_eq!(names, ["again", "ball", "two"]);
    let [first, second, third] = &loaded.scene.shown[..] else {
        panic!("three shapes");
    };
    assert_eq!(first.name(), Some("ball"));
    assert_eq!(second.name(), Some("two"));
    assert_eq!(third.name(), Some("ball"));
    let lines: Vec<_> = [first, second, third]
        .map(|n| n.place().map(|p| p.line))
        .into();
    assert_eq!(lines, [Some(1), Some(3), Some(1)]);
}

#[test]
fn long_chains_do_not_nest() {
    let sum = vec!["1"; 10_000].join(" + ");
    let union = vec!["sphere(1)"; 10_000].join(" | ");
    let or = vec!["false"; 10_000].join(" or ");
    let ifs = "if x == -1 { 0 } else ".repeat(3_000);
    let loaded = loaded(&format!(
        "let total = {sum}\nlet all = {union}\nfn f(x) {{ {or} or x == 3 }}\nfn g(x) {{ {ifs} {{ 7 }} }}\nshow all\n\
         test \"sum\" {{ expect total == 10000 expect f(3) expect g(1) == 7 }}"
    ));
    assert_eq!(loaded.scene.shown[0].children().len(), 10_000);
    assert!(loaded.run_tests(&Marcher)[0].passed());
}

#[test]
fn one_run_reports_several_errors() {
    let text = errors(
        "let a = (1 +\nlet b = sphere(radios: 1)\nlet c = b.translate([1, 0, 0])\nshow unknown\nshow box(-1)",
    );
    assert!(text.contains("`(` is never closed"), "{text}");
    let text = errors(
        "let a = 1 +\nlet b = sphere(radios: 1)\nlet c = b.translate([1, 0, 0])\nshow unknown\nshow box(-1)\nshow [a, c]",
    );
    let count = text.matches("error: ").count();
    assert_eq!(count, 4, "{text}");
}

#[test]
fn every_example_of_the_catalogue_is_a_script() {
    let all = [
        AnyPrimitive::DECLARATIONS,
        AnyModifier::DECLARATIONS,
        AnyBlend::DECLARATIONS,
    ];
    for declaration in all.into_iter().flatten() {
        let example = declaration.example;
        let loaded = loaded(&format!("show {example}"));
        assert_eq!(loaded.scene.shown.len(), 1, "{example}");
    }
}

#[test]
fn the_documentation_states_the_limits() {
    let text = std::fs::read_to_string("docs/language.md").expect("docs/language.md");
    let limits: [(&str, u64); 14] = [
        ("MAX_SCRIPT_BYTES", limits::MAX_SCRIPT_BYTES as u64),
        ("MAX_STATEMENT_BYTES", limits::MAX_STATEMENT_BYTES as u64),
        ("MAX_NESTING", limits::MAX_NESTING as u64),
        ("MAX_IMPORT_DEPTH", limits::MAX_IMPORT_DEPTH as u64),
        ("MAX_STEPS", limits::MAX_STEPS),
        ("MAX_CALL_DEPTH", limits::MAX_CALL_DEPTH as u64),
        ("MAX_OPEN_EXPRESSIONS", limits::MAX_OPEN_EXPRESSIONS as u64),
        ("MAX_LIST", limits::MAX_LIST as u64),
        ("MAX_LIST_DEPTH", u64::from(limits::MAX_LIST_DEPTH)),
        ("MAX_STRING", limits::MAX_STRING as u64),
        ("MAX_SHAPES", limits::MAX_SHAPES),
        ("MAX_GRAPH", limits::MAX_GRAPH as u64),
        ("MAX_DEPTH", u64::from(Node::MAX_DEPTH)),
        ("MAX_SIZE", Node::MAX_SIZE),
    ];
    for (name, value) in limits {
        let row = text
            .lines()
            .find(|line| line.starts_with(&format!("| `{name}` |")));
        let row = row.unwrap_or_else(|| panic!("{name} has no row"));
        let stated: String = row.split('|').nth(2).unwrap_or("").replace(' ', "");
        assert_eq!(stated, value.to_string(), "{name}");
    }
}

#[test]
fn the_script_of_the_documentation_loads() {
    let text = std::fs::read_to_string("docs/language.md").expect("docs/language.md");
    let script: String = text
        .lines()
        .filter_map(|line| line.strip_prefix("    "))
        .map(|line| format!("{line}\n"))
        .collect();
    let loaded = loaded(&script);
    assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
    assert_eq!(loaded.scene.shown.len(), 2);
}

#[test]
fn every_function_works_by_components() {
    use fieldstone::catalogue::Function;
    for function in Function::ALL {
        let name = function.name();
        let arguments = vec!["[0.5, 0.25]"; function.arguments().len()].join(", ");
        let single = vec!["0.25"; function.arguments().len()].join(", ");
        // Where the edges of a step coincide there is no value, here as there.
        holds(
            "",
            &[&format!(
                "{name}({arguments}).y == {name}({single}) or \"{name}\" == \"smoothstep\""
            )],
        );
    }
}
