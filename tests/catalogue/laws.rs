//! The laws.

use super::ascent::{Effort, climb, highest};
use super::samples::Dice;
use fieldstone::catalogue::*;
use fieldstone::field::{Level, compile, compile_wide};
use fieldstone::num::{Dual, F32x64, F64x32, Interval, Lanes, Vec3};
use fieldstone::scene::Node;

type Law = Result<(), String>;

/// The field at a point.
pub fn value(node: &Node, p: [f64; 3]) -> f64 {
    node.evaluate(&Vec3::splat(p))
}

fn gradient_at(node: &Node, p: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = std::array::from_fn(|i| Dual::<f64, 3>::variable(p[i], i));
    node.evaluate(&Vec3::new(x, y, z)).partial
}

/// The length of the gradient at a point.
pub fn slope_at(node: &Node, p: [f64; 3]) -> f64 {
    length(gradient_at(node, p))
}

fn length(v: [f64; 3]) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// Where a node is looked at: its bounds, infinite ones cut at 2.
fn region(node: &Node) -> Bounds {
    node.bounds().intersect(Bounds::centred([2.0; 3]))
}

/// Around the region, where the constant must hold too if it holds everywhere.
pub fn surroundings(node: &Node) -> Bounds {
    let inner = region(node);
    if inner.is_empty() {
        return inner;
    }
    let is_global = node.lipschitz_everywhere() <= node.lipschitz();
    inner.inflate(if is_global { 0.7 } else { 0.0 })
}

/// By how much the value at a point may be off by rounding: the value without any lies in the interval over the point
/// alone. Where intervals say less (at the border of a choice between two formulas, say), the rounding of some thousand
/// operations on numbers as large as the value or the change over one unit.
fn rounding(node: &Node, p: [f64; 3], lambda: f64) -> f64 {
    let [x, y, z] = p.map(Interval::point);
    let width = node.evaluate(&Vec3::new(x, y, z)).width();
    width.min(1e-13 * (1.0 + lambda + value(node, p).abs()))
}

/// |f(p) - f(q)| <= lambda |p - q| (1 + 1e-12), but for rounding.
fn is_no_steeper(node: &Node, lambda: f64, p: [f64; 3], q: [f64; 3]) -> Law {
    let (change, distance) = ((value(node, p) - value(node, q)).abs(), apart(p, q));
    let excess = change - lambda * distance * (1.0 + 1e-12);
    if excess <= 0.0 || excess <= rounding(node, p, lambda) + rounding(node, q, lambda) {
        return Ok(());
    }
    let slope = change / distance;
    Err(format!("slope {slope} > {lambda} between {p:?} and {q:?}"))
}

/// |f(p) - f(q)| <= lambda |p - q|: for `n` random pairs near and far and for pairs along the gradient; then for those that
/// climbing from the steepest of them finds, for the halves of the steepest one down to a millionth, where a jump would
/// be as steep as they are short, and across the place with the largest gradient.
pub fn lipschitz(node: &Node, dice: &mut Dice, n: usize) -> Law {
    let domain = surroundings(node);
    let lambda = node.lipschitz();
    if domain.is_empty() || lambda.is_infinite() {
        return Ok(());
    }
    lipschitz_on(node, &domain, lambda, dice, n)
}

fn lipschitz_on(node: &Node, domain: &Bounds, lambda: f64, dice: &mut Dice, n: usize) -> Law {
    let secant = |p: [f64; 3], q: [f64; 3]| {
        let slope = (value(node, p) - value(node, q)).abs() / apart(p, q);
        if slope.is_finite() { slope } else { 0.0 }
    };
    let mut steepest = (0.0, domain.centre(), domain.centre());
    for i in 0..n {
        let p = dice.point(domain);
        let q = match i % 3 {
            0 => dice.point(domain),
            1 => p.map(|c| c + dice.between(-1e-3, 1e-3)),
            _ => {
                let g = gradient_at(node, p);
                std::array::from_fn(|k| p[k] + 1e-3 * g[k])
            }
        };
        if !domain.contains(q) {
            continue;
        }
        is_no_steeper(node, lambda, p, q)?;
        let slope = secant(p, q);
        if slope > steepest.0 {
            steepest = (slope, p, q);
        }
    }
    // One of two halves is as steep as the whole.
    let (_, mut p, mut q) = steepest;
    while apart(p, q) > 1e-6 {
        let middle = std::array::from_fn(|k| 0.5 * (p[k] + q[k]));
        if secant(p, middle) > secant(middle, q) {
            q = middle;
        } else {
            p = middle;
        }
        is_no_steeper(node, lambda, p, q)?;
    }
    let place = |v: &[f64]| -> [f64; 3] {
        std::array::from_fn(|k| domain.low[k] + v[k] * (domain.high[k] - domain.low[k]))
    };
    let unit = |p: [f64; 3]| -> [f64; 3] {
        let part = |k: usize| (p[k] - domain.low[k]) / (domain.high[k] - domain.low[k]);
        std::array::from_fn(|k| Some(part(k)).filter(|x| x.is_finite()).unwrap_or(0.0))
    };
    let score = |v: &[f64; 6]| {
        let (p, q) = (place(&v[..3]), place(&v[3..]));
        if apart(p, q) > 1e-4 {
            secant(p, q)
        } else {
            0.0
        }
    };
    let (u, v) = (unit(steepest.1), unit(steepest.2));
    let mut peak = ([u[0], u[1], u[2], v[0], v[1], v[2]], steepest.0);
    climb(score, dice, n / 2, f64::INFINITY, &mut peak);
    is_no_steeper(node, lambda, place(&peak.0[..3]), place(&peak.0[3..]))?;
    let effort = Effort {
        samples: n / 2,
        climbs: 1,
        steps: n / 2,
    };
    let (top, _) = highest(
        |v: &[f64; 3]| slope_at(node, place(v)),
        dice,
        effort,
        f64::INFINITY,
    );
    let (p, g) = (place(&top), gradient_at(node, place(&top)));
    for step in [1e-2, 1e-3, 1e-5] {
        let along = |sign: f64| -> [f64; 3] {
            std::array::from_fn(|k| p[k] + sign * step * g[k] / length(g).max(1e-300))
        };
        let (ahead, behind) = (along(0.5), along(-0.5));
        if domain.contains(ahead) && domain.contains(behind) {
            is_no_steeper(node, lambda, ahead, behind)?;
        }
    }
    Ok(())
}

/// Points where the field is at most a level lie in the box for that level.
pub fn bounded(node: &Node, dice: &mut Dice, n: usize) -> Law {
    let everywhere = Bounds::centred([4.0; 3]);
    for level in [0.0, 0.1, 0.5] {
        let bounds = node.sublevel(level);
        for _ in 0..n {
            let p = dice.point(&everywhere);
            if value(node, p) <= level && !bounds.inflate(1e-12).contains(p) {
                return Err(format!(
                    "{p:?} has {} but lies outside of {bounds:?}",
                    value(node, p)
                ));
            }
        }
    }
    Ok(())
}

/// Points of the surface, about `n` of them: half from rays that cross the region, where the sign changes, from outside
/// and from inside; the rest, which finds surfaces without an inside too, where walks along the gradient end.
fn surface(node: &Node, dice: &mut Dice, n: usize) -> Vec<[f64; 3]> {
    let domain = region(node).inflate(0.3);
    let mut found = Vec::new();
    for _ in 0..n {
        let (from, to) = (dice.point(&domain), dice.point(&domain));
        crossings(node, from, to, &mut found);
        if 2 * found.len() >= n {
            break;
        }
    }
    for _ in 0..2 * n {
        let mut p = dice.point(&domain);
        for _ in 0..60 {
            let (f, g) = (value(node, p), gradient_at(node, p));
            let squared = g.iter().map(|c| c * c).sum::<f64>();
            if f.abs() < 1e-10 {
                found.push(p);
                break;
            }
            if squared < 1e-12 {
                break;
            }
            p = std::array::from_fn(|k| p[k] - f * g[k] / squared);
        }
        if found.len() >= n {
            break;
        }
    }
    found
}

/// Where the field changes sign on the way from one point to another: by steps, then by halving.
fn crossings(node: &Node, from: [f64; 3], to: [f64; 3], found: &mut Vec<[f64; 3]>) {
    const STEPS: u32 = 24;
    let at = |t: f64| -> [f64; 3] { std::array::from_fn(|k| from[k] + t * (to[k] - from[k])) };
    let mut last = value(node, from);
    for i in 1..=STEPS {
        let (mut low, mut high) = (
            f64::from(i - 1) / f64::from(STEPS),
            f64::from(i) / f64::from(STEPS),
        );
        let (before, after) = (last, value(node, at(high)));
        last = after;
        if (before < 0.0) == (after < 0.0) || before.is_nan() || after.is_nan() {
            continue;
        }
        for _ in 0..36 {
            let middle = 0.5 * (low + high);
            if (value(node, at(middle)) < 0.0) == (before < 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        found.push(at(low));
    }
}

/// |f(p)| <= lambda |p - s| for every surface point s, lambda = 1 where the class promises a bound.
pub fn below_distance(node: &Node, dice: &mut Dice, n: usize) -> Law {
    let domain = surroundings(node);
    if domain.is_empty() || node.lipschitz().is_infinite() {
        return Ok(());
    }
    let allowed = if node.class() >= Class::Bound {
        1.0
    } else {
        node.lipschitz()
    };
    let points: Vec<_> = surface(node, dice, n)
        .into_iter()
        .filter(|s| domain.contains(*s))
        .collect();
    for i in 0..n {
        // Everywhere, and close to the surface, where a wrong slope shows before another part of the surface is nearer.
        let mut p = dice.point(&domain);
        if i % 2 == 1 && !points.is_empty() {
            let s = points[dice.below(points.len())];
            p = s.map(|c| c + dice.between(-0.05, 0.05));
        }
        if !domain.contains(p) {
            continue;
        }
        let f = value(node, p).abs();
        let is_near = |s: &&[f64; 3]| f > allowed * apart(p, **s) * (1.0 + 1e-9) + 2e-10;
        if let Some(s) = points.iter().find(is_near) {
            let distance = apart(p, *s);
            return Err(format!(
                "|f| = {f} at {p:?}, but {s:?} of the surface is {distance} away"
            ));
        }
    }
    Ok(())
}

/// From p, a walk of length |f| down the gradient ends on the surface: with `below_distance`, f is the distance.
pub fn exact(node: &Node, dice: &mut Dice) -> Law {
    let domain = surroundings(node);
    let mut tried = 0;
    for _ in 0..300 {
        let p = dice.point(&domain);
        let (f, g) = (value(node, p), gradient_at(node, p));
        if (length(g) - 1.0).abs() > 1e-9 {
            // On a medial axis the gradient is that of one side only; an exact field has slope 1 elsewhere.
            return Err(format!("slope {} at {p:?}", length(g)));
        }
        let foot = std::array::from_fn(|k| p[k] - f * g[k]);
        tried += 1;
        if value(node, foot).abs() > 1e-9 {
            return Err(format!(
                "|f| = {f} at {p:?}, but its foot {foot:?} has {}",
                value(node, foot)
            ));
        }
    }
    if tried > 0 {
        Ok(())
    } else {
        Err("nothing tried".into())
    }
}

/// The dual gradient is what differences say, wherever the two one-sided differences agree.
pub fn gradient(node: &Node, dice: &mut Dice, n: usize) -> Law {
    const H: f64 = 1e-6;
    let domain = Bounds::centred([1.5; 3]);
    for _ in 0..n {
        let p = dice.point(&domain);
        let g = gradient_at(node, p);
        for axis in 0..3 {
            let at = |h: f64| {
                let mut q = p;
                q[axis] += h;
                value(node, q)
            };
            let (ahead, behind) = ((at(H) - at(0.0)) / H, (at(0.0) - at(-H)) / H);
            let is_smooth = (ahead - behind).abs() < 1e-4;
            if is_smooth && (g[axis] - 0.5 * (ahead + behind)).abs() > 1e-4 {
                return Err(format!(
                    "component {axis} at {p:?}: {} but differences say {ahead}",
                    g[axis]
                ));
            }
        }
    }
    Ok(())
}

/// The value and the gradient over a box contain those at its points: for boxes of size 1e-6 to 1e6, at the origin and
/// as far away.
pub fn enclosed(node: &Node, dice: &mut Dice, n: usize) -> Law {
    const PLACES: [(f64, f64); 7] = [
        (0.3, 1.0),
        (3.0, 0.5),
        (1e-6, 1.0),
        (1e6, 1e6),
        (1e-6, 1e6),
        (1.0, 1e6),
        (1e-6, 1e-6),
    ];
    for i in 0..n {
        let (size, centre) = PLACES[i % PLACES.len()];
        let low: [f64; 3] = std::array::from_fn(|_| dice.between(-centre, centre));
        let bounds = Bounds::new(low, low.map(|c| c + size * dice.unit()));
        let side = |k: usize| Interval::new(bounds.low[k], bounds.high[k]);
        let [x, y, z] = std::array::from_fn(side);
        let range = node.evaluate(&Vec3::new(x, y, z));
        let [x, y, z] = std::array::from_fn(|k| Dual::<Interval, 3>::variable(side(k), k));
        let slopes = node.evaluate(&Vec3::new(x, y, z));
        for _ in 0..6 {
            let p = dice.point(&bounds);
            if !bounds.contains(p) {
                continue;
            }
            let (f, g) = (value(node, p), gradient_at(node, p));
            if !range.contains(f) || !slopes.value.contains(f) {
                return Err(format!(
                    "{f} at {p:?} is outside of {range:?}, {:?}",
                    slopes.value
                ));
            }
            if let Some(k) = (0..3).find(|k| !slopes.partial[*k].contains(g[*k])) {
                let slopes = slopes.partial[k];
                return Err(format!(
                    "slope {} along {k} at {p:?} is outside of {slopes:?}",
                    g[k]
                ));
            }
        }
    }
    Ok(())
}

/// Closures give the bits of the walked tree, in scalars and lanes, on every level of instructions.
pub fn same_bits(node: &Node, dice: &mut Dice) -> Law {
    let domain = Bounds::centred([1.5; 3]);
    let points: Vec<[f64; 3]> = (0..64).map(|_| dice.point(&domain)).collect();
    let (single, single32) = (compile::<f64>(node), compile::<f32>(node));
    let expected: Vec<u64> = points
        .iter()
        .map(|p| single(&Vec3::splat(*p)).to_bits())
        .collect();
    let expected32: Vec<u32> = points
        .iter()
        .map(|p| single32(&Vec3::splat(*p)).to_bits())
        .collect();
    for (name, level) in Level::ALL {
        let (wide, wide32) = (
            compile_wide::<F64x32>(node, level),
            compile_wide::<F32x64>(node, level),
        );
        let lane = |axis: usize| Lanes(std::array::from_fn(|i| points[i][axis]));
        let found = wide(&Vec3::new(lane(0), lane(1), lane(2))).0;
        if let Some(i) = (0..32).find(|i| found[*i].to_bits() != expected[*i]) {
            return Err(format!("f64 on {name}: {} at {:?}", found[i], points[i]));
        }
        let lane = |axis: usize| Lanes(std::array::from_fn(|i| points[i][axis] as f32));
        let found = wide32(&Vec3::new(lane(0), lane(1), lane(2))).0;
        if let Some(i) = (0..64).find(|i| found[*i].to_bits() != expected32[*i]) {
            return Err(format!("f32 on {name}: {} at {:?}", found[i], points[i]));
        }
    }
    Ok(())
}

/// The compiled closure is close to the walked tree (folded transforms round differently).
pub fn walked(node: &Node, dice: &mut Dice, n: usize) -> Law {
    let single = compile::<f64>(node);
    for _ in 0..n {
        let p = dice.point(&Bounds::centred([1.5; 3]));
        let (a, b) = (single(&Vec3::splat(p)), value(node, p));
        if (a - b).abs() > 1e-12 {
            return Err(format!("{a} compiled, {b} walked, at {p:?}"));
        }
    }
    Ok(())
}

/// A constant over a region holds there, and is no larger than over a larger one.
pub fn regional(node: &Node, dice: &mut Dice, n: usize) -> Law {
    let low = dice.point(&Bounds::centred([0.8; 3]));
    let small = Bounds::new(low, low.map(|c| c + dice.between(0.05, 0.7)));
    let lambda = node.lipschitz_over(small);
    // Derived constants of both are known to a few per cent only.
    if lambda > node.lipschitz_over(small.inflate(0.5)) * if node.has_graph() { 1.04 } else { 1.0 }
    {
        return Err("larger on the smaller region".into());
    }
    if lambda.is_infinite() {
        return Ok(());
    }
    lipschitz_on(node, &small, lambda, dice, n)
}

/// A finite repetition is the union of its copies: everywhere for an exact child, else at least on the inside and as far
/// as half the spacing. It keeps the Lipschitz constant.
pub fn repeated_is_union(node: &Node, dice: &mut Dice) -> Law {
    let spacing: [f64; 3] = std::array::from_fn(|_| dice.between(0.4, 2.0));
    let count: [f64; 3] = std::array::from_fn(|_| 1.0 + dice.below(5) as f64);
    let repeat = AnyModifier::Repeat(Repeat::new(spacing, count));
    let Ok(repeated) = Node::modifier(repeat, std::sync::Arc::new(node.clone())) else {
        return Ok(());
    };
    let places = |axis: usize| {
        let n = count[axis];
        (0..n as u32).map(move |i| (f64::from(i) - 0.5 * (n - 1.0)) * spacing[axis])
    };
    let domain = Bounds::centred([3.0; 3]);
    for _ in 0..60 {
        let p = dice.point(&domain);
        let mut nearest = f64::INFINITY;
        for x in places(0) {
            for y in places(1) {
                for z in places(2) {
                    nearest = nearest.min(value(node, [p[0] - x, p[1] - y, p[2] - z]));
                }
            }
        }
        let least = spacing.into_iter().fold(f64::INFINITY, f64::min);
        same_as_union(node, value(&repeated, p), nearest, 0.5 * least)
            .map_err(|why| format!("{why} at {p:?}; spacing {spacing:?} count {count:?}"))?;
    }
    lipschitz(&repeated, dice, 60)
}

/// Whether `found` is what a union of copies of `node` has, of which the smallest field is `nearest`: the same for an
/// exact node; else of the same sign, and no less than the smaller of `nearest` and `reach`.
fn same_as_union(node: &Node, found: f64, nearest: f64, reach: f64) -> Law {
    let is_same = if node.class() == Class::Exact {
        (found - nearest).abs() < 1e-12
    } else {
        let is_same_side = (found < 0.0) == (nearest < 0.0) || nearest.abs() < 1e-12;
        is_same_side && found >= nearest.min(reach) - 1e-12
    };
    if is_same {
        return Ok(());
    }
    Err(format!("{found} but the copies say {nearest}"))
}

/// Copies around an axis are the union of turned copies.
pub fn polar_is_union(node: &Node, dice: &mut Dice) -> Law {
    let (count, axis) = (1 + dice.below(9), dice.below(3));
    let polar = AnyModifier::Polar(Polar::new(count as f64, Axis(axis)));
    let child = std::sync::Arc::new(node.clone());
    let whole = Node::modifier(polar, child.clone()).map_err(|fault| fault.message)?;
    let mut direction = [0.0; 3];
    direction[axis] = 1.0;
    let copies: Vec<_> = (0..count)
        .map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / count as f64;
            let rotate = AnyModifier::Rotate(Rotate::new(angle, direction, 0.0, 0.0, 0.0));
            Node::modifier(rotate, child.clone()).expect("anything turns")
        })
        .collect();
    let is_plain = !(0..3).any(|i| i != axis && node.traits().is_symmetric[i]);
    for _ in 0..60 {
        let p = dice.point(&Bounds::centred([2.0; 3]));
        let nearest = copies
            .iter()
            .map(|c| value(c, p))
            .fold(f64::INFINITY, f64::min);
        let found = value(&whole, p);
        let is_same = !is_plain || (found - nearest).abs() < 1e-12;
        same_as_union(node, found, nearest, f64::INFINITY)
            .and(if is_same {
                Ok(())
            } else {
                Err(format!("{found}, not {nearest}"))
            })
            .map_err(|why| format!("{why} at {p:?}; {count} copies about {axis}"))?;
    }
    lipschitz(&whole, dice, 60)
}

/// An endless mirrored repetition has the field at the point that reflections bring into the middle cell.
pub fn mirrored_is_reflected(node: &Node, dice: &mut Dice) -> Law {
    let spacing: [f64; 3] = std::array::from_fn(|_| dice.between(0.4, 2.0));
    let child = std::sync::Arc::new(node.clone());
    let made = |count: [f64; 3]| {
        let modifier = AnyModifier::MirroredRepeat(MirroredRepeat::new(spacing, count));
        Node::modifier(modifier, child.clone()).expect("anything is repeated")
    };
    let (endless, three) = (made([f64::INFINITY; 3]), made([3.0; 3]));
    for _ in 0..60 {
        let p = dice.point(&Bounds::centred([3.0; 3]));
        let reflected = |most: u32| -> [f64; 3] {
            std::array::from_fn(|i| {
                let (mut x, c) = (p[i], spacing[i]);
                for _ in 0..most {
                    if x.abs() > 0.5 * c {
                        x = c.copysign(x) - x;
                    }
                }
                x
            })
        };
        for (whole, most) in [(&endless, 100), (&three, 1)] {
            let (found, expected) = (value(whole, p), value(node, reflected(most)));
            if (found - expected).abs() > 1e-12 {
                return Err(format!(
                    "{found}, not {expected} at {p:?}; {most} reflections"
                ));
            }
        }
    }
    lipschitz(&endless, dice, 60)?;
    lipschitz(&made([2.0, 4.0, 5.0]), dice, 60)
}

/// The box of a modified box or rectangle is touched on every side by what it holds, but for a tenth of its size.
pub fn touched(modifier: &AnyModifier, dice: &mut Dice) -> Law {
    let leaf = AnyPrimitive::Cuboid(Cuboid::new([0.8, 1.2, 0.6], 0.0));
    let profile = AnyPrimitive::Rectangle(Rectangle::new([0.8, 1.2], 0.0));
    let made = |leaf| {
        Node::modifier(
            modifier.clone(),
            Node::primitive(leaf).expect("a valid leaf"),
        )
    };
    let Ok(node) = made(leaf).or_else(|_| made(profile)) else {
        return Ok(());
    };
    let bounds = node.bounds();
    // A shape that shrinks keeps its box: boxes are known for levels from 0 on.
    let shrinks = matches!(modifier, AnyModifier::Offset(o) if o.by < 0.0);
    // The box of a warp is that of the worst noise, which is nowhere the one at the sides.
    let is_random = matches!(modifier, AnyModifier::Warp(_));
    if bounds.is_empty() || !bounds.is_finite() || shrinks || is_random {
        return Ok(());
    }
    for side in 0..6 {
        let (axis, is_high) = (side % 3, side >= 3);
        let mut slab = bounds;
        let tenth = 0.1 * bounds.size()[axis];
        if is_high {
            slab.low[axis] = slab.high[axis] - tenth;
        } else {
            slab.high[axis] = slab.low[axis] + tenth;
        }
        if !(0..60_000).any(|_| value(&node, dice.point(&slab)) <= 0.0) {
            return Err(format!("nothing at side {side} of {bounds:?}"));
        }
    }
    Ok(())
}
