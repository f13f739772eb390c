//! Profiles against their outlines: points on a curve that is written down independently, corner by corner and arc by
//! arc, tell the distance and the side.

use fieldstone::catalogue::*;
use fieldstone::num::{Dual, Number, Vec3};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

type Point = [f64; 2];

/// How many points stand for a piece of an outline.
const PIECES: usize = 600;

/// A straight piece up to `b`, which begins the next.
fn line(a: Point, _: Point) -> Vec<Point> {
    vec![a]
}

/// Points at angles from the x axis, counter-clockwise, of an ellipse.
fn curve(centre: Point, radii: Point, from: f64, to: f64) -> Vec<Point> {
    (0..PIECES)
        .map(|i| {
            let (sin, cos) = (from + (to - from) * i as f64 / PIECES as f64).sin_cos();
            [centre[0] + radii[0] * cos, centre[1] + radii[1] * sin]
        })
        .collect()
}

fn arc(centre: Point, radius: f64, from: f64, to: f64) -> Vec<Point> {
    curve(centre, [radius; 2], from, to)
}

fn corners(points: &[Point]) -> Vec<Point> {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .flat_map(|(a, b)| line(*a, *b))
        .collect()
}

/// The distance from `p` to the chord between two points.
fn from_chord(p: Point, a: Point, b: Point) -> f64 {
    let (v, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = v[0] * v[0] + v[1] * v[1];
    let t = if squared > 0.0 {
        ((v[0] * w[0] + v[1] * w[1]) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (w[0] - t * v[0]).hypot(w[1] - t * v[1])
}

/// The signed distance to the closed chain of chords: the nearest one, and the even-odd rule.
fn signed(outline: &[Point], p: Point) -> f64 {
    let (mut nearest, mut is_inside) = (f64::INFINITY, false);
    let mut a = outline[outline.len() - 1];
    for b in outline.iter().copied() {
        nearest = nearest.min(from_chord(p, a, b));
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            is_inside ^= p[0] < x;
        }
        a = b;
    }
    if is_inside { -nearest } else { nearest }
}

/// Points of the square from -1.5 to 1.5 and of lines through its middle, in some order without a pattern.
fn places() -> impl Iterator<Item = Point> {
    (1..500).map(|i| {
        // Source: Roberts, the R2 sequence.
        let [u, v] = [0.754_877_666_246_693, 0.569_840_290_998_053]
            .map(|g| 3.0 * (f64::from(i) * g).fract() - 1.5);
        match i % 20 {
            0 => [u, 0.0],
            1 => [0.0, v],
            2 => [1e-9 * u, v],
            _ => [u, v],
        }
    })
}

/// The field is the signed distance to the outline, up to what its chords cut off.
fn agrees(primitive: AnyPrimitive, outline: &[Point]) {
    let name = format!("{primitive:?}");
    let node =
        fieldstone::scene::Node::primitive(primitive).unwrap_or_else(|f| panic!("{name}: {f:?}"));
    let is_exact = node.class() == Class::Exact;
    for p in places() {
        let found: f64 = node.evaluate(&Vec3::splat([p[0], p[1], 0.3]));
        let expected = signed(outline, p);
        let is_right = if is_exact || expected > 0.0 {
            (found - expected).abs() < 2e-5
        } else {
            found >= expected - 2e-5 && found <= 2e-5
        };
        assert!(
            is_right,
            "{name} at {p:?}: {found}, but the outline says {expected}"
        );
        let variable = |i: usize| Dual::<f64, 2>::variable(p[i], i);
        let [gx, gy] = node
            .evaluate(&Vec3::new(variable(0), variable(1), Dual::splat(0.3)))
            .partial;
        let slope = gx.hypot(gy);
        assert!(
            slope.is_finite() && slope <= 1.0 + 1e-9,
            "{name} at {p:?}: slope {slope}"
        );
        let reach = node.sublevel(found.max(0.0));
        assert!(
            reach.inflate(1e-9).contains([p[0], p[1], 0.0]),
            "{name} at {p:?}: {reach:?}"
        );
    }
    let around = Bounds::around(outline.iter().map(|p| [p[0], p[1], 0.0]));
    let bounds = node.bounds();
    for i in 0..2 {
        let ends = [
            bounds.low[i] - around.low[i],
            bounds.high[i] - around.high[i],
        ];
        assert!(
            ends.iter().all(|e| e.abs() < 1e-4),
            "{name}: {bounds:?}, not {around:?}"
        );
    }
}

fn polar(radius: f64, angle: f64) -> Point {
    [radius * angle.sin(), radius * angle.cos()]
}

#[test]
fn polygons_by_mirrors_are_their_outlines() {
    for n in [3_u32, 4, 5, 6, 7, 12, 17, 64] {
        let step = TAU / f64::from(n);
        let outer: Vec<_> = (0..n).map(|i| polar(0.8, step * f64::from(i))).collect();
        agrees(
            AnyPrimitive::RegularPolygon(RegularPolygon::new(n.into(), 0.8)),
            &corners(&outer),
        );
        for inner in [0.1, 0.4, 0.78] {
            let star: Vec<_> = (0..n)
                .flat_map(|i| {
                    let angle = step * f64::from(i);
                    [polar(0.8, angle), polar(inner, angle + 0.5 * step)]
                })
                .collect();
            agrees(
                AnyPrimitive::Star(Star::new(n.into(), 0.8, inner)),
                &corners(&star),
            );
        }
    }
    let rhombus = [[0.5, 0.0], [0.0, 0.2], [-0.5, 0.0], [0.0, -0.2]];
    agrees(
        AnyPrimitive::Star(Star::new(2.0, 0.5, 0.2)),
        &corners(&rhombus.map(|[x, y]| [y, x])),
    );
    agrees(
        AnyPrimitive::Rhombus2(Rhombus2::new([1.0, 0.4])),
        &corners(&rhombus),
    );
}

#[test]
fn straight_profiles_are_their_outlines() {
    let (a, b, c) = ([-0.7, -0.5], [0.9, -0.3], [0.2, 0.7]);
    agrees(
        AnyPrimitive::Triangle2(Triangle2::new(a, b, c)),
        &corners(&[a, b, c]),
    );
    agrees(
        AnyPrimitive::Triangle2(Triangle2::new(a, c, b)),
        &corners(&[a, b, c]),
    );
    for (bottom, top, h) in [(1.4, 0.7, 0.45), (0.3, 1.8, 0.2), (1.0, 1.0, 0.5)] {
        let outline = [
            [-0.5 * bottom, -h],
            [0.5 * bottom, -h],
            [0.5 * top, h],
            [-0.5 * top, h],
        ];
        agrees(
            AnyPrimitive::Trapezoid(Trapezoid::new(bottom, top, 2.0 * h)),
            &corners(&outline),
        );
    }
    for skew in [-1.3, 0.0, 0.5] {
        let outline = [
            [-0.5, -0.4],
            [0.5, -0.4],
            [0.5 + skew, 0.4],
            [skew - 0.5, 0.4],
        ]
        .map(|[x, y]| [x - 0.5 * skew, y]);
        agrees(
            AnyPrimitive::Parallelogram(Parallelogram::new([1.0, 0.8], skew)),
            &corners(&outline),
        );
    }
}

#[test]
fn crosses_are_their_outlines() {
    for (l, h, r) in [
        (0.7, 0.25, 0.0),
        (0.7, 0.25, 0.1),
        (0.5, 0.4, 0.05),
        (0.8, 0.05, 0.05),
    ] {
        let mut quarter: Vec<Point> = line([h, h], [l - r, h]);
        let turned: Vec<Point> = arc([l - r, h - r], r, 0.0, 0.5 * PI);
        quarter.extend(turned.into_iter().rev());
        quarter.extend(line([l, h - r], [l, r - h]));
        quarter.extend(arc([l - r, r - h], r, -0.5 * PI, 0.0).into_iter().rev());
        quarter.extend(line([l - r, -h], [h, -h]));
        // Clockwise, so the next quarter is turned clockwise too.
        let mut outline = Vec::new();
        for _ in 0..4 {
            outline.extend_from_slice(&quarter);
            quarter.iter_mut().for_each(|p| *p = [p[1], -p[0]]);
        }
        agrees(
            AnyPrimitive::Cross2(Cross2::new(2.0 * l, 2.0 * h, r)),
            &outline,
        );
    }
}

#[test]
fn ellipses_are_their_outlines() {
    for radii in [
        [0.9, 0.5],
        [0.5, 0.9],
        [0.7, 0.7],
        [0.7, 0.700_000_1],
        [1.0, 0.1],
    ] {
        let outline: Vec<_> = (0..12)
            .flat_map(|i| {
                curve(
                    [0.0; 2],
                    radii,
                    TAU * f64::from(i) / 12.0,
                    TAU * f64::from(i + 1) / 12.0,
                )
            })
            .collect();
        agrees(AnyPrimitive::Ellipse(Ellipse::new(radii)), &outline);
    }
}

/// The true distance by bisection of the secular equation in each quadrant, to rounding.
fn ellipse_distance([a, b]: Point, [x, y]: Point) -> f64 {
    let ([a, b], [x, y]) = if a < b {
        ([b, a], [y.abs(), x.abs()])
    } else {
        ([a, b], [x.abs(), y.abs()])
    };
    let k = a * a - b * b;
    let cosine = |s: f64| a * x * s / (k * s + b * y);
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..1200 {
        let s = 0.5 * (low + high);
        if cosine(s).powi(2) + s * s < 1.0 {
            low = s
        } else {
            high = s
        }
    }
    let (s, c) = (high, (1.0 - high * high).sqrt());
    let side = (x / a).hypot(y / b) - 1.0;
    (x - a * c).hypot(y - b * s).copysign(side)
}

#[test]
fn flat_ellipses_are_exact() {
    for radii in [
        [1.0, 0.01],
        [0.001, 1.0],
        [1.0, 0.3],
        [1.0, 1.0 - 1e-9],
        [30.0, 0.3],
    ] {
        let ellipse = Ellipse::new(radii);
        for (i, [u, v]) in places().enumerate() {
            let shrink = 10.0_f64.powi(-(i as i32 % 9));
            let p = match i % 3 {
                0 => [u, v],
                1 => [u * radii[0], v * radii[1]],
                _ => [u * radii[0], v * radii[1] * shrink],
            };
            if p[0] * p[1] == 0.0 {
                continue;
            }
            let found: f64 = ellipse.distance(&Vec3::splat([p[0], p[1], 0.0]));
            let expected = ellipse_distance(radii, p);
            assert!(
                (found - expected).abs() < 1e-9,
                "{radii:?} at {p:?}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn ellipses_are_right_on_their_axes() {
    let ellipse = Ellipse::new([2.0, 1.0]);
    // Inside, the nearest point of the long axis is at x = 4 t / 3 for |x| < 3 / 2: sqrt(1 - x^2 / 3) away.
    for (p, expected) in [
        ([0.0, 0.0], -1.0),
        ([3.0, 0.0], 1.0),
        ([0.0, 1.5], 0.5),
        ([1.0, 0.0], -(2.0_f64 / 3.0).sqrt()),
        ([1.5, 0.0], -0.5),
        ([2.0, 0.0], 0.0),
        ([0.0, -1.0], 0.0),
    ] {
        let found: f64 = ellipse.distance(&Vec3::splat([p[0], p[1], 0.0]));
        assert!(
            (found - expected).abs() < 1e-10,
            "{p:?}: {found}, not {expected}"
        );
    }
}

#[test]
fn arcs_and_pies_are_their_outlines() {
    for degrees in [10.0_f64, 90.0, 180.0, 250.0, 330.0] {
        let half = 0.5 * degrees.to_radians();
        let (start, end) = (0.5 * PI - half, 0.5 * PI + half);
        let mut outline = arc([0.0; 2], 0.9, start, end);
        outline.extend(line(polar(0.9, -half), [0.0; 2]));
        outline.extend(line([0.0; 2], polar(0.9, half)));
        agrees(AnyPrimitive::Pie(Pie::new(0.9, 2.0 * half)), &outline);
        if degrees < 320.0 {
            let outline = [
                arc([0.0; 2], 0.8, start, end),
                arc(polar(0.7, -half), 0.1, end, end + PI),
                arc([0.0; 2], 0.6, end, start),
                arc(polar(0.7, half), 0.1, start - PI, start),
            ]
            .concat();
            agrees(AnyPrimitive::Arc(Arc::new(0.7, 0.2, 2.0 * half)), &outline);
        }
    }
    let disc = arc([0.0; 2], 0.9, 0.0, TAU);
    agrees(AnyPrimitive::Pie(Pie::new(0.9, TAU)), &disc);
}

#[test]
fn round_profiles_are_their_outlines() {
    for (w, h) in [(0.4, 0.8), (0.8, 0.8), (0.02, 0.9)] {
        let radius = (w * w + h * h) / (2.0 * w);
        let (back, half) = (radius - w, (h / radius).min(1.0).asin());
        let outline = [
            arc([-back, 0.0], radius, -half, half),
            arc([back, 0.0], radius, PI - half, PI + half),
        ]
        .concat();
        agrees(
            AnyPrimitive::Vesica2(Vesica2::new(2.0 * w, 2.0 * h)),
            &outline,
        );
    }
    for width in [0.3, 1.4] {
        let s = width / (0.5 + 0.5_f64.sqrt());
        let r = 0.125_f64.sqrt() * s;
        let outline = [
            line([0.0, 0.0], [0.5 * s, 0.5 * s]),
            arc([0.25 * s, 0.75 * s], r, -FRAC_PI_4, 3.0 * FRAC_PI_4),
            arc([-0.25 * s, 0.75 * s], r, FRAC_PI_4, 5.0 * FRAC_PI_4),
            line([-0.5 * s, 0.5 * s], [0.0, 0.0]),
        ]
        .concat();
        let middle = 0.5 * (0.75 * s + r);
        let outline: Vec<_> = outline.into_iter().map(|[x, y]| [x, y - middle]).collect();
        agrees(AnyPrimitive::Heart(Heart::new(width)), &outline);
    }
    for (big, small, height) in [(0.6, 0.3, 1.6), (0.4, 0.1, 0.8), (0.3, 0.29, 1.5)] {
        let rise = height - big - small;
        let radius = 0.5 * (rise * rise / (big - small) + big + small);
        let slope = (rise / (radius - small)).min(1.0).asin();
        let bottom = big - 0.5 * height;
        let outline = [
            arc([0.0, bottom], big, PI, TAU),
            arc([big - radius, bottom], radius, 0.0, slope),
            arc([0.0, bottom + rise], small, slope, PI - slope),
            arc([radius - big, bottom], radius, PI - slope, PI),
        ]
        .concat();
        agrees(AnyPrimitive::Egg(Egg::new(big, small, height)), &outline);
    }
}

#[test]
fn moons_are_their_outlines() {
    for (r, s, d) in [
        (0.8, 0.65, 0.4),
        (0.8, 0.9, 0.3),
        (0.5, 0.9, 0.9),
        (0.8, 0.3, 0.9),
        (0.7, 0.7, 0.05),
    ] {
        let x: f64 = (r * r - s * s + d * d) / (2.0 * d);
        let y = (r * r - x * x).sqrt();
        let (outer, inner) = (y.atan2(x), y.atan2(x - d));
        let mut outline = arc([0.0; 2], r, outer, TAU - outer);
        outline.extend(arc([d, 0.0], s, TAU - inner, inner));
        agrees(AnyPrimitive::Moon(Moon::new(r, s, d)), &outline);
    }
}

/// The distance to a stroke is that to its middle line, less half its width.
fn is_stroke(primitive: AnyPrimitive, middle: &[Point], width: f64) {
    let node = fieldstone::scene::Node::primitive(primitive).expect("a stroke");
    for p in places() {
        let found: f64 = node.evaluate(&Vec3::splat([p[0], p[1], 0.0]));
        let chords = middle
            .windows(2)
            .map(|pair| from_chord(p, pair[0], pair[1]));
        let expected = chords.fold(f64::INFINITY, f64::min) - 0.5 * width;
        assert!(
            (found - expected).abs() < 2e-6,
            "{node:?} at {p:?}: {found}, not {expected}"
        );
    }
    let around = Bounds::around(middle.iter().map(|p| [p[0], p[1], 0.0])).inflate(0.5 * width);
    for i in 0..2 {
        let ends = [
            node.bounds().low[i] - around.low[i],
            node.bounds().high[i] - around.high[i],
        ];
        assert!(
            ends.iter().all(|e| e.abs() < 1e-4),
            "{:?}, not {around:?}",
            node.bounds()
        );
    }
}

#[test]
fn strokes_keep_their_distance_from_the_middle() {
    let bolt = vec![
        [-0.8, -0.4],
        [-0.2, 0.5],
        [-0.2, 0.5],
        [0.2, -0.5],
        [0.8, 0.4],
    ];
    is_stroke(
        AnyPrimitive::Polyline(Polyline::new(bolt.clone(), 0.2)),
        &bolt,
        0.2,
    );
    let curves = [
        [[-0.8, -0.4], [0.0, 1.2], [0.8, -0.4]],
        [[-0.8, -0.4], [0.9, 0.3], [-0.7, -0.3]],
        [[-0.8, -0.4], [0.0, 0.0], [0.8, 0.4]],
        [[-0.8, -0.4], [1e-7, 0.0], [0.8, 0.4]],
        [[-0.8, -0.4], [1.6, 0.8], [0.4, 0.2]],
        [[-0.8, -0.4], [-0.8, -0.4], [0.4, 0.2]],
        [[0.5, 0.1], [0.9, 0.3], [0.5, 0.1]],
        [[0.5, 0.1], [0.5, 0.1], [0.5, 0.1]],
        [[-0.3, 0.0], [5.0, 0.2], [-0.4, 0.1]],
    ];
    for [a, b, c] in curves {
        let at = |t: f64| {
            std::array::from_fn(|i| (1.0 - t) * ((1.0 - t) * a[i] + 2.0 * t * b[i]) + t * t * c[i])
        };
        let middle: Vec<Point> = (0..=4000).map(|i| at(f64::from(i) / 4000.0)).collect();
        is_stroke(
            AnyPrimitive::Bezier(Bezier::new(a, b, c, 0.1)),
            &middle,
            0.1,
        );
    }
}

#[test]
fn a_stroke_is_exact_where_it_bends_no_sharper_than_its_width() {
    let parabola = |width: f64| Bezier::new([-1.0, 1.0], [0.0, -1.0], [1.0, 1.0], width);
    // y = x^2, whose smallest radius of curvature is 1 / 2.
    assert_eq!(parabola(1.0).traits().class, Class::Exact);
    assert_eq!(parabola(1.001).traits().class, Class::Bound);
    assert_eq!(Arc::new(0.7, 0.2, 1.9 * PI).traits().class, Class::Exact);
    assert_eq!(Arc::new(0.7, 0.3, 1.9 * PI).traits().class, Class::Bound);
}

fn polygon(points: &[Point]) -> Result<(), (&'static str, String)> {
    Polygon::new(points.to_vec()).check()
}

#[test]
fn outlines_that_cross_themselves_are_refused() {
    let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 1.0]];
    let (parameter, message) = polygon(&bow).expect_err("it crosses itself");
    assert_eq!(parameter, "points");
    assert_eq!(
        message,
        "must not cross themselves, but the edge from [0, 0] to [1, 1] crosses the edge from [1, 0] to [0, 1] or runs along it"
    );
    // A frame whose inner outline is reached by one edge there and back: which side of that edge is inside?
    let frame = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ];
    assert!(polygon(&frame).is_err());
    let partly = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [0.0, 2.0],
        [0.0, 0.5],
        [1.0, 0.5],
        [1.0, 1.5],
        [0.0, 1.5],
    ];
    assert!(polygon(&partly).is_err());
    // A star drawn in one go crosses itself five times; each of its edges in turn is the last.
    let mut pentagram: Vec<_> = (0..5)
        .map(|i| polar(1.0, 2.0 * TAU * f64::from(i) / 5.0))
        .collect();
    for _ in 0..5 {
        pentagram.rotate_left(1);
        assert!(polygon(&pentagram).is_err());
    }
    assert!(Polygon::DECLARATION.parameters[0].default.is_some());
}

#[test]
fn outlines_that_touch_themselves_are_allowed() {
    // A corner that lies on another edge.
    assert_eq!(
        polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]]),
        Ok(())
    );
}

#[test]
fn crossings_of_long_outlines_are_found_quickly() {
    let n = 20_000;
    let mut wave: Vec<_> = (0..n)
        .map(|i| {
            let radius = 1.0 + 1e-4 * f64::from(i % 2);
            polar(radius, TAU * f64::from(i) / f64::from(n))
        })
        .collect();
    assert_eq!(polygon(&wave), Ok(()));
    wave.swap(7_000, 7_002);
    assert!(polygon(&wave).is_err());
}
