//! The parts of a world: what a hard union at the root falls apart into.

use super::analytic::{Ball, Block, Facet, HalfSpace, Pane};
use super::apart;
use super::cut::Cut;
use super::evidence::Evidence;
use super::method::{Demands, Reach};
use super::probe::Probe;
use super::ring::Ring;
use crate::catalogue::Modifier;
use crate::catalogue::{AnyPrimitive, Bounds, Combination, Operation, Triangle, with_modifier};
use crate::field::{
    Closure, Level, Thicket, Walked, compile, compile_convex, compile_graph, compile_wide,
};
use crate::num::{Bent, Dual, F32x32, F64x16, F64x32, Interval, Rounded, Vec3};
use crate::scene::{Fault, FieldShape, Graph, Material, Method, Node, Parts, Shadow, Shape};
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// How rays find a part.
pub enum PartKind {
    /// A sphere, in closed form.
    Ball(Ball),
    /// A half-space, in closed form.
    HalfSpace(HalfSpace),
    /// A box with faces across the axes, in closed form.
    Block(Block),
    /// A triangle, in closed form.
    Facet(Facet),
    /// A quadrilateral, in closed form.
    Pane(Box<Pane>),
    /// A torus, in closed form.
    Ring(Box<Ring>, Spare),
    /// Anything else, by its field.
    Marched(Box<Marched>),
}

/// By how much a number is off that was rounded to single precision, as a share of it.
const UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// By how much the place of a scout is off, in roundings of the farthest corner of the region: one of the place where the ray comes in, two each
/// of the direction and of its product with the distance, and one of their sum. The rest is for where the way is known to be free, which
/// is rounded too.
const PLACES: f64 = 24.0;

/// A field counts as bent by at least this share of its slope over the size of its region, so that nothing is divided by zero.
const LEAST_BEND: f64 = 1.0 / 1024.0;

/// The largest error with which scouts are of use, as a share of how much the field may change from the middle of its region.
const COARSEST: f64 = 1.0 / 1024.0;

impl PartKind {
    /// The path that rays take, in words.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Ball(_) => "analytic sphere",
            Self::HalfSpace(_) => "analytic plane",
            Self::Block(_) => "analytic box",
            Self::Facet(_) => "analytic triangle",
            Self::Pane(_) => "analytic quadrilateral",
            Self::Ring(..) => "analytic torus",
            Self::Marched(m) if m.cut.is_some() => "analytic chords",
            Self::Marched(m) if m.slope.is_some() => "convex: by slope",
            Self::Marched(m) => match (m.thicket.is_some(), m.short().map(Short::is_bend_known)) {
                (false, None) => "sphere tracing",
                (false, Some(false)) => "sphere tracing, f32 in free space",
                (false, Some(true)) => "sphere tracing, f32 in free space, steps by bends",
                (true, None) => "sphere tracing, thinned out",
                (true, Some(false)) => "sphere tracing, thinned out, f32 in free space",
                (true, Some(true)) => {
                    "sphere tracing, thinned out, f32 in free space, steps by bends"
                }
            },
        }
    }
}

/// A field ready to be marched.
pub struct Marched {
    /// Where the constant holds, and outside of which nothing is: rays are clipped to it.
    pub region: Bounds,
    /// Whether the constant, or that of a leaf, may be larger outside of the region.
    pub is_regional: bool,
    /// How far from the origin of coordinates anything is known of the solid.
    pub size: f64,
    /// The Lipschitz constant on the region.
    pub lipschitz: f64,
    /// Whether the field is never negative, so that a hit can't be told by a change of sign.
    pub is_sheet: bool,
    /// The field, over wide lanes.
    pub value: Closure<F64x32>,
    /// What [`Marched::short`] gives, once it was asked for.
    short: OnceLock<Option<Short>>,
    /// Whether scouts may be asked for.
    is_scouted: bool,
    level: Level,
    /// What [`Marched::single`] gives, once it was asked for.
    single: OnceLock<Closure<f64>>,
    /// The field and its derivative along the ray, where the field is convex.
    pub slope: Option<Slope>,
    /// The shape.
    node: Arc<Node>,
    /// What [`Marched::ranges`] gives, once it was asked for.
    ranges: OnceLock<Closure<Dual<Interval, 1>>>,
    /// What [`Marched::gradient`] gives, once it was asked for.
    gradient: OnceLock<Closure<Dual<f64, 3>>>,
    /// The field and its gradient over lanes; none for fields with graphs.
    pub gradient_wide: Option<Closure<Dual<F64x16, 3>>>,
    /// The gradient of a field with graphs over wide lanes, once it was asked for; none where that would be too large.
    gradient_graph: OnceLock<Option<Walked<F64x32>>>,
    /// The combination in closed form, if it has one.
    pub(super) cut: Option<Cut>,
    /// The combination that can be thinned out, if the field is one.
    pub thicket: Option<Thicket>,
    /// What [`Marched::probe`] gives, once it was asked for.
    probe: OnceLock<Probe>,
    /// What rays have found against its constant.
    pub(super) evidence: Evidence,
}

/// A field in single precision, for scouts.
pub struct Short {
    /// Over wide lanes.
    pub value: Closure<F32x32>,
    /// By how much its values may be off in the region, with the places that scouts take them at, in units of the field.
    pub error: f64,
    /// By how much places and distances may be off, in scene units.
    pub off: f64,
    /// How much the slope along a straight line falls at most with each unit of the way, outside of the solid, and rises inside:
    /// infinite where that is not known.
    pub bends: [f64; 2],
}

impl Short {
    /// Whether steps outside of the solid can count on a bend.
    pub fn is_bend_known(&self) -> bool {
        self.bends[0].is_finite()
    }
}

/// Closures for a value with its derivative along a ray.
pub struct Slope {
    /// Over wide lanes.
    pub wide: Closure<Dual<F64x32, 1>>,
    /// Of a single ray.
    pub single: Closure<Dual<f64, 1>>,
}

/// The field of a part in closed form, for rays of which rounding decides; compiled when it is first asked for.
#[derive(Default)]
pub struct Spare(OnceLock<Box<Marched>>);

impl Spare {
    /// The field of `node`, whose constant is finite.
    pub(super) fn marched(&self, node: &Arc<Node>, method: Method, level: Level) -> &Marched {
        let field = || Marched::new(node.clone(), Demands::of(method), level);
        self.0
            .get_or_init(|| Box::new(field().unwrap_or_else(|fault| panic!("{}", fault.message))))
    }
}

/// A part of the world.
pub struct Part {
    /// How rays find it.
    pub kind: PartKind,
    /// Its shape, for materials.
    pub node: Arc<Node>,
    /// Its different materials; none stands for the default.
    pub materials: Vec<Option<Arc<Material>>>,
    /// What it does to light behind it.
    pub shadow: Shadow,
    /// A box around it.
    pub bounds: Bounds,
}

impl Part {
    /// Whether it is a combination that is thinned out.
    pub fn is_thinned(&self) -> bool {
        matches!(&self.kind, PartKind::Marched(marched) if marched.thicket.is_some())
    }

    /// The part of a shape, with what a method demands of it.
    ///
    /// # Errors
    /// If the shape has no finite Lipschitz constant.
    pub fn new(node: Arc<Node>, demands: Demands, level: Level) -> Result<Self, Fault> {
        let analytic = if demands.lanes { entry(&node) } else { None };
        let kind = match analytic {
            Some(kind) => kind,
            None => PartKind::Marched(Box::new(Marched::new(node.clone(), demands, level)?)),
        };
        let bounds = match &kind {
            PartKind::Ball(ball) => ball.bounds(),
            PartKind::HalfSpace(_) => Bounds::EVERYWHERE,
            PartKind::Block(block) => widened(block.bounds()),
            PartKind::Facet(facet) => facet.bounds(),
            PartKind::Pane(pane) => pane.bounds(),
            PartKind::Ring(..) => widened(node.bounds()),
            PartKind::Marched(marched) => marched.region,
        };
        let materials = materials(&node);
        let shadows: Vec<Shadow> = materials.iter().map(shadow_of).collect();
        let shadow = [Shadow::Opaque, Shadow::Tinted]
            .into_iter()
            .find(|s| shadows.contains(s))
            .unwrap_or(Shadow::None);
        Ok(Self {
            kind,
            node,
            materials,
            shadow,
            bounds,
        })
    }
}

fn shadow_of(material: &Option<Arc<Material>>) -> Shadow {
    material.as_ref().map_or(Shadow::Opaque, |m| m.shadow)
}

impl Marched {
    /// The field of `node`, with what a method demands of it.
    fn new(shape: Arc<Node>, demands: Demands, level: Level) -> Result<Self, Fault> {
        let node = &*shape;
        let is_clipped = match demands.reach {
            Reach::Bounds => true,
            Reach::Constant => !node.lipschitz_everywhere().is_finite(),
            Reach::Everywhere => false,
        };
        let bounds = widened(node.bounds());
        let region = if is_clipped {
            bounds
        } else {
            Bounds::EVERYWHERE
        };
        // Who asks everywhere does without the constant; it still measures noise.
        let lipschitz = match demands.reach {
            Reach::Everywhere => node.lipschitz(),
            _ => node.lipschitz_over(region),
        };
        if !lipschitz.is_finite() {
            return Err(unbounded(node));
        }
        let size = match (region.is_finite(), demands.reach) {
            (true, _) => region.radius(),
            (false, Reach::Everywhere) => bounds.finite_size(),
            (false, _) => region.finite_size(),
        };
        let is_convex = node.traits().is_convex && !node.traits().is_sheet && !node.has_graph();
        let slope = (demands.slopes && is_convex).then(|| Slope {
            wide: compile_convex(node, level),
            single: compile_convex(node, Level::Baseline),
        });
        let is_plain = demands.lanes && !node.has_graph();
        let gradient_wide = is_plain.then(|| compile_convex(node, level));
        let leaf_constant = |leaf: &Node, region: Bounds| leaf.lipschitz_over(region);
        // What rests on a claim is sampled, not thinned out: so a claim that is wrong is noticed.
        let is_thinned = demands.lanes && !node.rests_on_claim();
        let thicket = is_thinned.then(|| Thicket::new(node, level, region, &leaf_constant));
        Ok(Self {
            gradient_wide,
            gradient_graph: OnceLock::new(),
            thicket: thicket.flatten(),
            cut: is_thinned.then(|| Cut::of(node)).flatten(),
            region,
            is_regional: node.is_regional(),
            size,
            lipschitz,
            is_sheet: node.traits().is_sheet,
            value: compile_wide(node, level),
            short: OnceLock::new(),
            is_scouted: demands.lanes && !node.rests_on_claim() && !node.traits().is_sheet,
            level,
            single: OnceLock::new(),
            slope,
            gradient: OnceLock::new(),
            ranges: OnceLock::new(),
            probe: OnceLock::new(),
            evidence: Evidence::default(),
            node: shape,
        })
    }

    /// The field for scouts, compiled when it is first asked for; none where single precision says too little of it.
    pub fn short(&self) -> Option<&Short> {
        self.short.get_or_init(|| self.shortened()).as_ref()
    }

    fn shortened(&self) -> Option<Short> {
        if !self.is_scouted || self.is_endless() || self.slope.is_some() {
            return None;
        }
        // Scouts may be that far outside of it.
        let off = PLACES * UNIT * self.region.radius();
        let region = self.region.inflate(off);
        let bent = bent(&self.node, region);
        // The constant of a graph would be derived anew, which takes long.
        let slope = if self.node.has_graph() {
            bent.steep().slope().min(self.node.lipschitz_everywhere())
        } else {
            self.node.lipschitz_over(region)
        };
        let [x, y, z] = ranges(region).map(|range| Rounded::new(range, 0.0));
        let own = compile::<Rounded>(&self.node)(&Vec3::new(x, y, z)).error();
        let error = own + slope * off;
        let is_enough = error <= COARSEST * self.lipschitz * self.region.radius_about_centre();
        if !is_enough {
            return None;
        }
        Some(Short {
            value: compile_wide(&self.node, self.level),
            error,
            off,
            bends: [-bent.low(), bent.high()]
                .map(|bend| bend.max(LEAST_BEND * self.lipschitz / self.size)),
        })
    }

    /// The field of a single ray, compiled when it is first asked for: the same bits as over wide lanes.
    pub fn single(&self) -> &Closure<f64> {
        self.single.get_or_init(|| compile(&self.node))
    }

    /// The field and its gradient, compiled when they are first asked for.
    pub fn gradient(&self) -> &Closure<Dual<f64, 3>> {
        self.gradient.get_or_init(|| compile(&self.node))
    }

    /// The field as a tree that can be probed, made when it is first asked for.
    pub fn probe(&self) -> &Probe {
        self.probe
            .get_or_init(|| Probe::new(&self.node, self.region))
    }

    /// The ranges of the field and of its derivative along a ray, compiled when they are first asked for.
    pub fn ranges(&self) -> &Closure<Dual<Interval, 1>> {
        self.ranges.get_or_init(|| compile(&self.node))
    }
}

impl Marched {
    /// The instructions that its closures were made with.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Whether the shape has no finite bounds.
    pub fn is_endless(&self) -> bool {
        !self.region.is_finite()
    }

    /// The gradient of a field with graphs over wide lanes; none where that would be too large.
    pub fn gradient_graph(&self, level: Level) -> Option<&Walked<F64x32>> {
        let graph = || Some(compile_graph(&Arc::new(self.node.gradient()?), level));
        self.gradient_graph.get_or_init(graph).as_ref()
    }
}

/// The coordinates in a box.
fn ranges(region: Bounds) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval::new(region.low[axis], region.high[axis]))
}

/// How much a field bends at most in a box.
pub(super) fn bent(node: &Node, region: Bounds) -> Bent {
    let [x, y, z] = ranges(region);
    let [x, y, z] = [(x, 0), (y, 1), (z, 2)].map(|(range, axis)| Bent::variable(range, axis));
    compile::<Bent>(node)(&Vec3::new(x, y, z))
}

/// The fault of a shape that has no finite constant.
pub(super) fn unbounded(node: &Node) -> Fault {
    let name = node.name().unwrap_or(node.kind());
    Fault::new(
        format!("`{name}` has no finite Lipschitz constant on its bounds, so it cannot be traced"),
        "intersect it with something finite, as in `shape & box(4)`, or give the field a claimed `lipschitz`",
    )
}

/// The box with room for rounding, so that no surface lies on its border.
fn widened(bounds: Bounds) -> Bounds {
    if bounds.is_empty() {
        return bounds;
    }
    let size = bounds.finite_size();
    bounds.inflate(size * 1e-9)
}

/// The parts that the hard union at the root of `node` falls apart into, each with its paint and transforms.
pub fn flatten(node: &Arc<Node>) -> Vec<Arc<Node>> {
    let inherit = |child: Arc<Node>| {
        let child = match node.paint() {
            Some(paint) => child.painted(paint.clone()),
            None => child,
        };
        child.labelled(node.name().map(Arc::from), node.place().cloned())
    };
    match node.shape() {
        Shape::Combination(
            Combination {
                operation: Operation::Union,
                blend,
            },
            children,
        ) if blend.is_hard() => children.iter().flat_map(flatten).map(inherit).collect(),
        Shape::Combination(combination, children) => {
            let Some(groups) = apart::groups(combination, children) else {
                return vec![node.clone()];
            };
            let united = |mut group: Vec<Arc<Node>>| match group.len() {
                1 => Ok(group.remove(0)),
                _ => Node::combination(combination.clone(), group),
            };
            match groups
                .into_iter()
                .map(united)
                .collect::<Result<Vec<_>, _>>()
            {
                Ok(groups) => groups.iter().flat_map(flatten).map(inherit).collect(),
                Err(_) => vec![node.clone()],
            }
        }
        Shape::Field(field) if field.claimed.is_none() => match field.graph.parts() {
            Parts::Least(parts) => match of_field(field, parts) {
                Some(parts) => parts.into_iter().map(inherit).collect(),
                None => vec![node.clone()],
            },
            _ => vec![node.clone()],
        },
        Shape::Modifier(modifier, child)
            if with_modifier!(modifier, m => m.similarity()).is_some() =>
        {
            let inner = flatten(child);
            if inner.len() < 2 {
                return vec![node.clone()];
            }
            let moved = |c: Arc<Node>| Node::modifier(modifier.clone(), c);
            match inner.into_iter().map(moved).collect::<Result<Vec<_>, _>>() {
                Ok(parts) => parts.into_iter().map(inherit).collect(),
                Err(_) => vec![node.clone()],
            }
        }
        _ => vec![node.clone()],
    }
}

/// The operands of a user's field that is a minimum: a hard union, each with a constant and bounds of its own. None where
/// one of them has no constant.
fn of_field(field: &FieldShape, parts: &[Graph]) -> Option<Vec<Arc<Node>>> {
    let part = |graph: &Graph| {
        let node = Node::field(FieldShape {
            name: field.name.clone(),
            graph: Arc::new(graph.clone()),
            claimed: None,
        });
        node.ok().filter(|node| node.lipschitz().is_finite())
    };
    parts.iter().map(part).collect()
}

/// The closed form of a shape that is a sphere, plane, box, torus, triangle or quadrilateral under transforms that keep angles.
fn entry(node: &Node) -> Option<PartKind> {
    let (map, inner) = node.unplaced();
    let Shape::Primitive(primitive) = inner.shape() else {
        return None;
    };
    let outside = |p: [f64; 3]| DVec3::from_array(map.outside(p));
    let facet = |t: &Triangle| Facet::new([t.a, t.b, t.c].map(outside));
    match primitive {
        AnyPrimitive::Sphere(s) => Some(PartKind::Ball(Ball::placed(s, &map))),
        AnyPrimitive::Plane(p) => Some(PartKind::HalfSpace(HalfSpace::placed(p, &map))),
        AnyPrimitive::Cuboid(b) if b.round == 0.0 && map.is_translation() => {
            Some(PartKind::Block(Block {
                centre: outside([0.0; 3]),
                half: 0.5 * DVec3::from_array(b.size),
            }))
        }
        AnyPrimitive::Torus(t) if node.lipschitz().is_finite() => {
            let ring = Box::new(Ring::placed(t, &map)?);
            Some(PartKind::Ring(ring, Spare::default()))
        }
        AnyPrimitive::Triangle(t) => Some(PartKind::Facet(facet(t))),
        AnyPrimitive::Quad(q) => {
            let halves = q.halves().each_ref().map(facet);
            Some(PartKind::Pane(Box::new(Pane { halves })))
        }
        _ => None,
    }
}

/// The different materials of a shape; `None` stands for unpainted.
pub fn materials(node: &Node) -> Vec<Option<Arc<Material>>> {
    let mut found = Vec::new();
    collect(node, None, &mut found);
    found
}

/// Adds the materials of a shape, where `outer` is what holds if nothing is painted deeper down.
fn collect(node: &Node, outer: Option<&Arc<Material>>, found: &mut Vec<Option<Arc<Material>>>) {
    let here = node.paint().or(outer);
    // Children of a user's field lend their shape, not their paint.
    let children = match node.shape() {
        Shape::Primitive(_) | Shape::Field(_) => &[][..],
        Shape::Displacement(displacement) => &displacement.operands[..1],
        _ => node.children(),
    };
    if children.is_empty() {
        let is_known = found.iter().any(|m| match (m, here) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        });
        if !is_known {
            found.push(here.cloned());
        }
    }
    children.iter().for_each(|c| collect(c, here, found));
}
