//! Fields without any number from their author are traced without one wrong pixel: every pixel is compared with a
//! reference that shares nothing with the tracer but the field, ranges of it along the ray in f64.

use fieldstone::lang::{load, load_text};
use fieldstone::num::{Interval, Steep, Vec3};
use fieldstone::render::View;
use fieldstone::scene::{Node, Scene, sampled_supremum};
use fieldstone::trace::{Ray, SceneTracer, Verdict, Visibility, World};
use rayon::prelude::*;

const SIZE: [u32; 2] = [320, 240];

/// How closely the reference knows where a ray meets a surface, as a share of the distance.
const CLOSE: f64 = 1e-11;

fn scene(body: &str) -> Scene {
    let script = format!("{body}\nrender {{ size: [{}, {}] }}\n", SIZE[0], SIZE[1]);
    load_text("test.sdf", &script, &[], &SceneTracer::default())
        .unwrap_or_else(|error| panic!("{error:?}"))
        .scene
}

/// What the reference says of a ray.
#[derive(Clone, Copy, Debug)]
enum Truth {
    Hit(f64),
    Miss,
    /// The field touches zero so closely that ranges in f64 cannot tell.
    Touch(f64),
}

/// The field's range and its derivative's along the ray, from `t0` to `t1`.
fn along(node: &Node, ray: &Ray, t0: f64, t1: f64) -> (Interval, Interval) {
    let d = ray.direction.to_array();
    let o = ray.origin.to_array();
    let t = Interval::new(t0, t1);
    let [x, y, z] = std::array::from_fn(|i| {
        let place = Interval::point(o[i]) + Interval::point(d[i]) * t;
        Steep::variable(place, i)
    });
    let field: Steep = node.evaluate(&Vec3::new(x, y, z));
    let slope = (0..3).fold(Interval::point(0.0), |sum, i| {
        sum + field.gradient()[i] * Interval::point(d[i])
    });
    (field.value(), slope)
}

/// Interval bisection from near to far: a piece without a zero is passed over; one on which the field falls
/// monotonically from positive to negative holds the hit.
fn reference(node: &Node, ray: &Ray, from: f64, to: f64) -> Truth {
    let sign = |t: f64| along(node, ray, t, t).0;
    let mut left = vec![(from, to)];
    while let Some((a, b)) = left.pop() {
        let (range, slope) = along(node, ray, a, b);
        if range.lo > 0.0 {
            continue;
        }
        if slope.hi < 0.0 && sign(a).lo > 0.0 {
            if sign(b).hi >= 0.0 {
                continue;
            }
            let (mut a, mut b) = (a, b);
            while b - a > CLOSE * b {
                let middle = 0.5 * (a + b);
                if sign(middle).lo > 0.0 {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            return Truth::Hit(b);
        }
        if b - a < CLOSE * b {
            return if sign(b).hi < 0.0 {
                Truth::Hit(b)
            } else {
                Truth::Touch(b)
            };
        }
        let middle = 0.5 * (a + b);
        left.push((middle, b));
        left.push((a, middle));
    }
    Truth::Miss
}

/// Traces every pixel and compares it: the number of hits. `far` is where the reference stops.
fn every_pixel_is_right(body: &str, far: f64) -> usize {
    let scene = scene(body);
    let [node] = &scene.shown[..] else {
        panic!("one shape is shown");
    };
    let world = World::new(&scene).expect("a certified scene");
    let view = View::new(&scene.camera, SIZE);
    let rays: Vec<Ray> = (0..SIZE[0] * SIZE[1])
        .map(|k| view.ray(f64::from(k % SIZE[0]), f64::from(k / SIZE[0])))
        .map(|ray| Ray { t_max: far, ..ray })
        .collect();
    let found = world.nearest(&rays, Visibility::All);
    let wrong: Vec<String> = rays
        .par_iter()
        .zip(&found)
        .enumerate()
        .filter_map(|(k, (ray, outcome))| {
            let truth = reference(node, ray, 0.0, far);
            let is_near = |t: f64| (outcome.t - t).abs() <= 0.1 * ray.footprint.at(t);
            let is_right = match (outcome.verdict, truth) {
                (Verdict::Hit, Truth::Hit(t) | Truth::Touch(t)) => is_near(t),
                (Verdict::Miss, Truth::Miss | Truth::Touch(_)) => true,
                _ => false,
            };
            let pixel = (k as u32 % SIZE[0], k as u32 / SIZE[0]);
            (!is_right).then(|| format!("{pixel:?}: {truth:?}, found {outcome:?}"))
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "{} of {} pixels are wrong:\n{}",
        wrong.len(),
        rays.len(),
        wrong[..wrong.len().min(5)].join("\n")
    );
    found.iter().filter(|o| o.verdict == Verdict::Hit).count()
}

#[test]
fn bumpy_sphere_has_no_wrong_pixel() {
    let hits = every_pixel_is_right(
        "field bumpy(p) { return length(p) - 1 + 0.15 * sin(12 * p.x) * sin(12 * p.y) * sin(12 * p.z) }
         show bumpy
         camera { eye: [1.8, 1.4, 2.6], fov: 40deg }
         light { toward: [1, 2, 1] }",
        10.0,
    );
    assert!(hits > 20_000, "{hits}");
}

#[test]
fn displaced_torus_has_no_wrong_pixel() {
    let hits = every_pixel_is_right(
        "field bumps(p) { return 0.045 * sin(20 * p.x) * sin(20 * p.y) * sin(20 * p.z) }
         field ring(p) { return torus(1, 0.25).at(p) + bumps(p) }
         show ring
         camera { eye: [1.2, 1.9, 2.2], fov: 40deg }
         light { toward: [1, 2, 1] }",
        10.0,
    );
    assert!(hits > 15_000, "{hits}");
}

#[test]
fn steep_sphere_beside_a_plane_has_no_wrong_pixel() {
    let hits = every_pixel_is_right(
        "field both(p) { return min(p.y + 1, 20 * (length(p - [0.2, -0.6, 0.3]) - 0.1)) }
         show both
         camera { eye: [1, 0.2, 2], at: [0, -0.8, 0], fov: 50deg }
         light { toward: [1, 2, 1] }",
        60.0,
    );
    assert!(hits > 50_000, "{hits}");
}

#[test]
fn constants_of_fields_are_within_five_percent_of_the_steepest_slope() {
    // Where the budget of boxes ends before the bound is that close, it is allowed for by name.
    let out_of_budget = |field: &str| field.starts_with("exp");
    let fields = [
        "length(p) - 1 + 0.15 * sin(12 * p.x) * sin(12 * p.y) * sin(12 * p.z)",
        "length(p) - 1",
        "sqrt(dot(p, p)) - 1",
        "20 * (length(p - [0.2, -0.6, 0.3]) - 0.1)",
        "length([p.x, p.z]) - 0.5 + 0.1 * sin(9 * p.y)",
        "max(abs(p.x), max(abs(p.y), abs(p.z))) - 0.7",
        "p.y - 0.3 * sin(3 * p.x) * cos(4 * p.z)",
        "length(p - [0.1, 0.2, 0.3]) * 0.5 + length(p + [0.4, 0, 0]) * 0.5 - 1",
        "exp(-dot(p, p)) * -1 + 0.5",
        "p.x^4 + p.y^4 + p.z^4 - 1",
        "torus(1, 0.25).at(p) + 0.045 * sin(20 * p.x) * sin(20 * p.y) * sin(20 * p.z)",
        "sphere(1).at(p) * box(1).at(p) - 0.02",
    ];
    for field in fields {
        let scene = scene(&format!(
            "field f(p) {{ return {field} }}\nshow f & box(3)\nlight {{ toward: [1, 2, 1] }}"
        ));
        let node = &scene.shown[0].children()[0];
        assert_eq!(node.kind(), "f");
        let region = scene.shown[0].bounds();
        let constant = node.lipschitz_over(region);
        let steepest = sampled_supremum(node, region, 20_000).expect("finite gradients");
        assert!(
            constant >= steepest * (1.0 - 1e-12),
            "{field}: {constant} < {steepest}"
        );
        assert!(
            constant <= if out_of_budget(field) { 1.1 } else { 1.05 } * steepest,
            "{field}: {constant} derived, {steepest} found"
        );
    }
}

#[test]
fn solids_of_fields_have_bounds() {
    let cases = [
        ("length(p) - 1 + 0.15 * sin(12 * p.x)", 1.15),
        ("length(p - [5, 0, -3]) - 0.5", 5.5),
        ("max(abs(p.x) + abs(p.y) + abs(p.z), length(p)) - 2", 2.0),
    ];
    for (field, reach) in cases {
        let scene = scene(&format!(
            "field f(p) {{ return {field} }}\nshow f\nlight {{ toward: [1, 2, 1] }}"
        ));
        let bounds = scene.shown[0].bounds();
        let found = (0..3).map(|axis| bounds.reach(axis)).fold(0.0, f64::max);
        assert!(
            found >= reach && found <= 1.2 * reach,
            "{field}: {bounds:?}"
        );
    }
    let endless =
        scene("field f(p) { return p.y - 0.2 * sin(p.x) }\nshow f\nlight { toward: [1, 2, 1] }");
    let bounds = endless.shown[0].bounds();
    assert!(bounds.high[1] >= 0.2 && bounds.high[1] < 0.3, "{bounds:?}");
    assert_eq!(bounds.low, [f64::NEG_INFINITY; 3]);
}

#[test]
fn hard_unions_are_traced_part_by_part() {
    let scene = scene(
        "let column = box([0.4, 2, 0.4]).twist(180deg)
         field ball(p) { return p.x^2 + p.y^2 + p.z^2 - 1 }
         show (column | plane(\"y\", -1)).translate([0, 0.1, 0])
         show ball.translate([3, 0, 0]) | plane(\"y\", -1)
         light { toward: [1, 2, 1] }",
    );
    let world = World::new(&scene).expect("every part has a constant on its bounds");
    assert_eq!(world.parts(), 4);
}

#[test]
fn no_node_of_the_examples_is_without_a_certificate() {
    fn check(node: &Node, file: &str) -> usize {
        assert!(
            node.lipschitz().is_finite(),
            "{file}: `{}` has no constant",
            node.kind()
        );
        assert!(!node.rule().is_empty(), "{file}: {}", node.kind());
        1 + node
            .children()
            .iter()
            .map(|child| check(child, file))
            .sum::<usize>()
    }
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    let mut nodes = 0;
    for entry in std::fs::read_dir(folder).expect("examples").flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|e| e != "sdf") {
            continue;
        }
        let file = path.display().to_string();
        let loaded = load(&path, &[], &SceneTracer::default());
        let loaded = loaded.unwrap_or_else(|error| panic!("{file}: {error:?}"));
        let shown = &loaded.scene.shown;
        nodes += shown.iter().map(|node| check(node, &file)).sum::<usize>();
    }
    assert!(nodes > 500, "{nodes} nodes");
}
