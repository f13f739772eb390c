//! The tree of shapes. A node cannot be made without its certificates.

use super::derive::{lipschitz_of_graph, range_of_graph};
use super::symbol::{asked, gradient, record};
use super::{Fault, Graph, Mark, Material};
use crate::catalogue::{
    AnyModifier, AnyPrimitive, Bounds, Class, Combination, Modifier, Operation, Primitive,
    Similarity, Traits, with_compiled_blend, with_compiled_modifier, with_compiled_primitive,
    with_modifier, with_primitive, with_recorded_blend, with_recorded_modifier,
    with_recorded_primitive,
};
use crate::num::{Number, Vec3};
use std::sync::Arc;

/// What a node is.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A leaf of the catalogue.
    Primitive(AnyPrimitive),
    /// A user's field.
    Field(Arc<FieldShape>),
    /// Several shapes as one.
    Combination(Combination, Vec<Arc<Node>>),
    /// One shape, changed.
    Modifier(AnyModifier, Arc<Node>),
    /// A shape, and a field that is added to its own.
    Displacement(Displacement),
}

/// A shape whose surface is moved: its field plus a relief. The inside grows where the relief is negative.
#[derive(Clone, Debug)]
pub struct Displacement {
    /// The shape and the relief, a user's field.
    pub operands: [Arc<Node>; 2],
    /// A number that the relief is nowhere below.
    pub lowest: f64,
}

impl Displacement {
    /// The Lipschitz rule in words, with its source.
    pub const RULE: &'static str =
        "the sum of the constants of the shape and of the field that is added";
}

/// A user's field: its graph, and the Lipschitz constant that its author claims for it, if any.
#[derive(Clone, Debug)]
pub struct FieldShape {
    /// The name in the script.
    pub name: String,
    /// The computation, with one output.
    pub graph: Arc<Graph>,
    /// The claimed constant.
    pub claimed: Option<f64>,
}

/// Where in the script a node was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
    /// The place itself, in the language's own terms.
    pub mark: Mark,
}

/// A shape with its certificates.
#[derive(Clone, Debug)]
pub struct Node {
    shape: Shape,
    /// What a recorded entry computes from the fields of its children.
    recording: Option<Arc<Graph>>,
    traits: Traits,
    bounds: Bounds,
    lipschitz: f64,
    everywhere: f64,
    is_regional: bool,
    depth: u32,
    size: u64,
    paint: Option<Arc<Material>>,
    name: Option<Arc<str>>,
    place: Option<Place>,
}

impl Node {
    /// How many nodes may lie on the way from the root to a leaf.
    pub const MAX_DEPTH: u32 = 512;

    /// How many nodes a tree may have, where one that is used several times counts as often.
    pub const MAX_SIZE: u64 = 1 << 20;

    /// A leaf of the catalogue.
    ///
    /// # Errors
    /// What [`Primitive::check`] says.
    pub fn primitive(primitive: AnyPrimitive) -> Result<Arc<Self>, Fault> {
        with_primitive!(&primitive, p => p.check())
            .map_err(|(parameter, message)| Fault::of(parameter, message))?;
        let (traits, everywhere) = with_primitive!(&primitive, p => (p.traits(), p.lipschitz()));
        Self::certified(Shape::Primitive(primitive), traits, everywhere, false)
    }

    /// A user's field; its constant is derived over the bounds of what it ends up in, unless one is claimed.
    ///
    /// # Errors
    /// None today; the signature is that of all constructors.
    pub fn field(field: FieldShape) -> Result<Arc<Self>, Fault> {
        let everywhere = field
            .claimed
            .unwrap_or_else(|| lipschitz_of_graph(&field.graph, Bounds::EVERYWHERE));
        let traits = Traits {
            class: Class::Lipschitz,
            ..Traits::EXACT
        };
        let is_regional = field.claimed.is_none();
        Self::certified(
            Shape::Field(Arc::new(field)),
            traits,
            everywhere,
            is_regional,
        )
    }

    /// Several shapes as one. A hard union of hard unions becomes one with all their children.
    ///
    /// # Errors
    /// What [`Combination::check`] says, or that profiles and shapes in space are mixed, or that the tree gets too deep.
    pub fn combination(
        mut combination: Combination,
        children: Vec<Arc<Self>>,
    ) -> Result<Arc<Self>, Fault> {
        combination.blend = combination.blend.simplified();
        combination
            .check(children.len())
            .map_err(|(message, hint)| Fault::new(message, hint))?;
        if children
            .iter()
            .any(|c| c.traits.is_planar != children[0].traits.is_planar)
        {
            return Err(Fault::new(
                "profiles and shapes in space cannot be combined",
                "give the profile thickness with `.extrude(height)` or turn it with `.revolve()`",
            ));
        }
        let children =
            if combination.operation != Operation::Difference && combination.blend.is_hard() {
                flattened(&combination, children)
            } else {
                children
            };
        if let [only] = &children[..] {
            return Ok(only.clone());
        }
        let traits = combination.traits(&children.iter().map(|c| c.traits).collect::<Vec<_>>());
        let everywhere = combination.lipschitz(children.iter().map(|c| c.everywhere));
        let is_regional = children.iter().any(|c| c.is_regional);
        Self::certified(
            Shape::Combination(combination, children),
            traits,
            everywhere,
            is_regional,
        )
    }

    /// One shape, changed.
    ///
    /// # Errors
    /// What [`Modifier::check`] and [`Modifier::fit`] say, or that the tree gets too deep.
    pub fn modifier(mut modifier: AnyModifier, child: Arc<Self>) -> Result<Arc<Self>, Fault> {
        with_modifier!(&modifier, m => m.check())
            .map_err(|(parameter, message)| Fault::of(parameter, message))?;
        with_modifier!(&mut modifier, m => m.fit(&child.traits, &|level| child.sublevel(level)))
            .map_err(|(message, hint)| Fault::new(message, hint))?;
        let traits = with_modifier!(&modifier, m => m.traits(&child.traits));
        let everywhere =
            with_modifier!(&modifier, m => m.lipschitz(child.everywhere, Bounds::EVERYWHERE));
        let is_regional = with_modifier!(&modifier, m => m.is_regional()) || child.is_regional;
        Self::certified(
            Shape::Modifier(modifier, child),
            traits,
            everywhere,
            is_regional,
        )
    }

    /// A shape with the field `relief` added to its own.
    ///
    /// # Errors
    /// If the relief is not a user's field, if no lower bound of it is found, or if the shape is a profile.
    pub fn displacement(shape: Arc<Self>, relief: Arc<Self>) -> Result<Arc<Self>, Fault> {
        let Shape::Field(field) = &relief.shape else {
            return Err(Fault::new(
                format!(
                    "`{}` is a shape, and `displace` adds a field",
                    relief.kind()
                ),
                "write a field, as in `field waves(p) { return 0.05 * sin(20 * p.x) }`",
            ));
        };
        if shape.traits.is_planar {
            return Err(Fault::new(
                "a profile is not displaced in space",
                "extrude it first",
            ));
        }
        let lowest = range_of_graph(&field.graph, Bounds::EVERYWHERE).lo;
        if lowest == f64::NEG_INFINITY {
            return Err(Fault::new(
                format!(
                    "the field `{}` may fall without end, so the displaced shape would have no bounds",
                    field.name
                ),
                "hold it between limits, as in `clamp(x, -0.2, 0.2)`",
            ));
        }
        let traits = Traits {
            class: Class::Lipschitz,
            ..Traits::EXACT
        };
        let everywhere = shape.everywhere + relief.everywhere;
        let is_regional = shape.is_regional || relief.is_regional;
        let operands = [shape, relief];
        let displacement = Displacement { operands, lowest };
        Self::certified(
            Shape::Displacement(displacement),
            traits,
            everywhere,
            is_regional,
        )
    }

    fn certified(
        shape: Shape,
        traits: Traits,
        everywhere: f64,
        is_regional: bool,
    ) -> Result<Arc<Self>, Fault> {
        let depth = 1 + match &shape {
            Shape::Primitive(_) => 0,
            Shape::Field(field) => field
                .graph
                .shapes()
                .iter()
                .map(|n| n.depth)
                .max()
                .unwrap_or(0),
            Shape::Combination(_, children) => children.iter().map(|n| n.depth).max().unwrap_or(0),
            Shape::Modifier(_, child) => child.depth,
            Shape::Displacement(d) => d.operands[0].depth.max(d.operands[1].depth),
        };
        if depth > Self::MAX_DEPTH {
            let limit = Self::MAX_DEPTH;
            return Err(Fault::new(
                format!("the shape is nested deeper than {limit} operations (limit MAX_DEPTH)"),
                "unite many shapes at once, as in `union(list)`, instead of one after another",
            ));
        }
        if least_recorded(&shape) > Self::MAX_SIZE {
            return Err(too_large());
        }
        let recording = recorded(&shape).map(Arc::new);
        let size = 1 + match &shape {
            _ if recording.is_some() => recording.as_ref().map_or(0, |graph| graph.work()),
            Shape::Primitive(AnyPrimitive::Polygon(polygon)) => polygon.points.len() as u64,
            Shape::Primitive(_) => 0,
            Shape::Field(field) => field.graph.work(),
            Shape::Combination(_, children) => children.iter().map(|n| n.size).sum(),
            Shape::Modifier(_, child) => child.size,
            Shape::Displacement(d) => d.operands[0].size + d.operands[1].size,
        };
        if size > Self::MAX_SIZE {
            return Err(too_large());
        }
        let mut node = Self {
            shape,
            recording,
            traits,
            bounds: Bounds::EVERYWHERE,
            lipschitz: everywhere,
            everywhere,
            is_regional,
            depth,
            size,
            paint: None,
            name: None,
            place: None,
        };
        node.bounds = node.sublevel(0.0);
        if is_regional {
            node.lipschitz = node.lipschitz_over(node.bounds);
        }
        let may_steepen = match &node.shape {
            Shape::Combination(combination, _) => is_regional || !combination.blend.is_hard(),
            _ => is_regional,
        };
        let is_claim_free = node.lipschitz <= 1.0;
        if may_steepen && !is_claim_free {
            node.traits.class = Class::Lipschitz;
        }
        Ok(Arc::new(node))
    }

    /// The same shape with this material where nothing is painted deeper down.
    pub fn painted(&self, material: Arc<Material>) -> Arc<Self> {
        let paint = self.paint.clone().or(Some(material));
        Arc::new(Self {
            paint,
            ..self.clone()
        })
    }

    /// The same shape with the name and place of its statement in the script, unless it has one already.
    pub fn labelled(&self, name: Option<Arc<str>>, place: Option<Place>) -> Arc<Self> {
        let (name, place) = (self.name.clone().or(name), self.place.clone().or(place));
        Arc::new(Self {
            name,
            place,
            ..self.clone()
        })
    }

    /// What the node is.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What it computes as a graph, which calls the fields of its children: for users' fields and for the recorded
    /// entries of the catalogue. What has none is compiled.
    pub fn graph(&self) -> Option<&Arc<Graph>> {
        match &self.shape {
            Shape::Field(field) => Some(&field.graph),
            _ => self.recording.as_ref(),
        }
    }

    /// Whether the node or any below it is evaluated as a graph.
    pub fn has_graph(&self) -> bool {
        self.graph().is_some() || self.children().iter().any(|child| child.has_graph())
    }

    /// What is known about its field.
    pub fn traits(&self) -> &Traits {
        &self.traits
    }

    /// What its value says about distance.
    pub fn class(&self) -> Class {
        self.traits.class
    }

    /// A box that holds the solid.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// A Lipschitz constant of the field on [`Node::bounds`]; infinite where none is known.
    pub fn lipschitz(&self) -> f64 {
        self.lipschitz
    }

    /// A Lipschitz constant of the field on all of space; infinite where none is known.
    pub fn lipschitz_everywhere(&self) -> f64 {
        self.everywhere
    }

    /// Whether [`Node::lipschitz_over`] may differ between regions.
    pub fn is_regional(&self) -> bool {
        self.is_regional
    }

    /// The region that [`Node::lipschitz`] holds on: all of space, or the bounds.
    pub fn certified_region(&self) -> Bounds {
        if self.everywhere <= self.lipschitz {
            Bounds::EVERYWHERE
        } else {
            self.bounds
        }
    }

    /// The material of what is not painted deeper down.
    pub fn paint(&self) -> Option<&Arc<Material>> {
        self.paint.as_ref()
    }

    /// The name in the script.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Where in the script the node was made.
    pub fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }

    /// The word for what the node is.
    pub fn kind(&self) -> &str {
        match &self.shape {
            Shape::Primitive(primitive) => primitive.declaration().name,
            Shape::Field(field) => &field.name,
            Shape::Combination(combination, _) => combination.name(),
            Shape::Modifier(modifier, _) => modifier.declaration().name,
            Shape::Displacement(_) => "displace",
        }
    }

    /// The rule behind its Lipschitz constant, in words with its source.
    pub fn rule(&self) -> &'static str {
        fn of_modifier<M: Modifier>(_: &M) -> &'static str {
            M::RULE
        }
        match &self.shape {
            Shape::Primitive(primitive) => primitive.declaration().source,
            Shape::Field(field) if field.claimed.is_some() => {
                "claimed in the script, checked by samples"
            }
            Shape::Field(_) => {
                "the largest gradient, by interval automatic differentiation over the bounds"
            }
            Shape::Combination(combination, _) => combination.blend.rule(),
            Shape::Modifier(modifier, _) => with_modifier!(modifier, m => of_modifier(m)),
            Shape::Displacement(_) => Displacement::RULE,
        }
    }

    /// How many nodes the tree has, where one that is used several times counts as often; operations of a user's field
    /// count as nodes. What walks over the tree takes so long.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// The node's children.
    pub fn children(&self) -> &[Arc<Self>] {
        match &self.shape {
            Shape::Primitive(_) => &[],
            Shape::Field(field) => field.graph.shapes(),
            Shape::Combination(_, children) => children,
            Shape::Modifier(_, child) => std::slice::from_ref(child),
            Shape::Displacement(d) => &d.operands,
        }
    }

    /// The first node below all transforms that keep angles, and what they do together.
    pub fn unplaced(&self) -> (Similarity, &Self) {
        let (map, inner, _) = self.unplaced_in(Bounds::EVERYWHERE);
        (map, inner)
    }

    /// As [`Node::unplaced`], with where it is asked if this one is asked in `region`.
    pub fn unplaced_in(&self, region: Bounds) -> (Similarity, &Self, Bounds) {
        let (mut map, mut inner, mut region) = (Similarity::IDENTITY, self, region);
        while let Shape::Modifier(modifier, child) = &inner.shape {
            let Some(step) = with_modifier!(modifier, m => m.similarity()) else {
                break;
            };
            map = map.then(&step);
            inner = child;
            region = with_modifier!(modifier, m => m.domain(region));
        }
        (map, inner, region)
    }

    /// A box that holds every point where the field is at most `level >= 0`.
    pub fn sublevel(&self, level: f64) -> Bounds {
        match &self.shape {
            Shape::Primitive(primitive) => with_primitive!(primitive, p => p.sublevel(level)),
            Shape::Field(field) => field.graph.extent(level),
            Shape::Combination(combination, children) => {
                combination.sublevel(children.len(), level, &|i, l| children[i].sublevel(l))
            }
            Shape::Modifier(modifier, child) => {
                with_modifier!(modifier, m => m.sublevel(level, &|l| child.sublevel(l)))
            }
            // Where f + g <= level, f <= level - inf g.
            Shape::Displacement(d) => d.operands[0].sublevel((level - d.lowest).max(0.0)),
        }
    }

    /// A Lipschitz constant of the field on `region`; infinite where none is known.
    pub fn lipschitz_over(&self, region: Bounds) -> f64 {
        if !self.is_regional {
            return self.everywhere;
        }
        match &self.shape {
            Shape::Primitive(_) => self.everywhere,
            Shape::Field(field) => match field.claimed {
                Some(claimed) => claimed,
                None => lipschitz_of_graph(&field.graph, region),
            },
            Shape::Combination(combination, children) => {
                combination.lipschitz(children.iter().map(|c| c.lipschitz_over(region)))
            }
            Shape::Modifier(modifier, child) => {
                let inner = with_modifier!(modifier, m => m.domain(region));
                let slope = child.lipschitz_over(inner);
                with_modifier!(modifier, m => m.lipschitz(slope, region))
            }
            Shape::Displacement(d) => d.operands.iter().map(|o| o.lipschitz_over(region)).sum(),
        }
    }

    /// The first part that cannot be traced for want of a finite constant; none where there is no such part. A hard union
    /// is traced part by part, each on its own bounds, so it needs no constant of its own.
    pub fn untraceable(&self) -> Option<&Self> {
        if self.lipschitz.is_finite() {
            return None;
        }
        match &self.shape {
            Shape::Combination(combination, children)
                if combination.operation == Operation::Union && combination.blend.is_hard() =>
            {
                children.iter().find_map(|child| child.untraceable())
            }
            Shape::Modifier(modifier, child)
                if with_modifier!(modifier, m => m.similarity()).is_some() =>
            {
                child.untraceable()
            }
            _ => Some(self),
        }
    }

    /// The innermost node that has no finite Lipschitz constant on the region where this one's bounds make it evaluated,
    /// with that region; none where the node has a constant.
    pub fn without_constant(&self) -> Option<(&Self, Bounds)> {
        self.without_constant_on(self.bounds)
    }

    fn without_constant_on(&self, region: Bounds) -> Option<(&Self, Bounds)> {
        if self.lipschitz_over(region).is_finite() {
            return None;
        }
        let deeper = match &self.shape {
            Shape::Primitive(_) | Shape::Field(_) => None,
            Shape::Combination(_, children) => children
                .iter()
                .find_map(|child| child.without_constant_on(region)),
            Shape::Modifier(modifier, child) => {
                let inner = with_modifier!(modifier, m => m.domain(region));
                child.without_constant_on(inner)
            }
            Shape::Displacement(d) => d
                .operands
                .iter()
                .find_map(|o| o.without_constant_on(region)),
        };
        deeper.or(Some((self, region)))
    }

    /// The gradient of the field as a graph with three outputs; none for what is too large to be worth it.
    pub fn gradient(&self) -> Option<Graph> {
        (self.size <= Self::MAX_GRADIENT).then(|| gradient(self))
    }

    /// The largest size of a shape whose gradient becomes a graph: its graph has several times as many operations.
    const MAX_GRADIENT: u64 = 512;

    /// The field at `p`, by walking the tree: slow, and the measure of what is compiled.
    pub fn evaluate<N: Number>(&self, p: &Vec3<N>) -> N {
        if let Some(graph) = self.graph() {
            return graph.value(p);
        }
        let compiled = match &self.shape {
            Shape::Primitive(primitive) => {
                with_compiled_primitive!(primitive, leaf => leaf.distance(p))
            }
            Shape::Field(_) => None,
            Shape::Combination(combination, children) => {
                let mut values = children.iter().map(|c| c.evaluate(p));
                let first = values.next().expect("a combination has children");
                with_compiled_blend!(&combination.blend, b => {
                    values.fold(first, |x, y| combination.operation.join(b, x, y))
                })
            }
            Shape::Modifier(modifier, child) => {
                with_compiled_modifier!(modifier, m => m.apply(p, |q| child.evaluate(q)))
            }
            Shape::Displacement(_) => None,
        };
        compiled.expect("what is not compiled has a graph")
    }
}

/// What a recorded entry computes; none for what is compiled, and for users' fields, which have a graph already.
fn recorded(shape: &Shape) -> Option<Graph> {
    match shape {
        Shape::Primitive(primitive) => {
            with_recorded_primitive!(primitive, leaf => record(|p| leaf.distance(p)))
        }
        Shape::Field(_) => None,
        Shape::Combination(combination, children) => {
            with_recorded_blend!(&combination.blend, b => record(|p| {
                let values = children[1..].iter().map(|child| asked(child, p));
                values.fold(asked(&children[0], p), |x, y| combination.operation.join(b, x, y))
            }))
        }
        Shape::Modifier(modifier, child) => {
            with_recorded_modifier!(modifier, m => record(|p| m.apply(p, |q| asked(child, q))))
        }
        Shape::Displacement(d) => {
            let [shape, relief] = &d.operands;
            Some(record(|p| asked(shape, p) + asked(relief, p)))
        }
    }
}

/// How many operations a recorded combination takes at least, from what its third child adds to the first two: what is
/// too large is not even recorded.
fn least_recorded(shape: &Shape) -> u64 {
    match shape {
        Shape::Combination(combination, children) if children.len() > 3 => {
            let of_first = |n: usize| {
                let part = Shape::Combination(combination.clone(), children[..n].to_vec());
                recorded(&part).map_or(0, |graph| graph.len())
            };
            let step = of_first(3).saturating_sub(of_first(2));
            step as u64 * (children.len() as u64 - 1)
        }
        _ => 0,
    }
}

fn too_large() -> Fault {
    let limit = Node::MAX_SIZE;
    Fault::new(
        format!("the shape has more than {limit} parts (limit MAX_SIZE)"),
        "repeat a part with `.repeat(...)`, which costs no more than the part itself",
    )
}

/// The children with those of equal hard combinations in their place, where no paint is lost by it.
fn flattened(combination: &Combination, children: Vec<Arc<Node>>) -> Vec<Arc<Node>> {
    let is_same = |c: &Node| {
        matches!(&c.shape, Shape::Combination(inner, _) if inner == combination)
            && c.paint.is_none()
            && c.name.is_none()
    };
    if !children.iter().any(|c| is_same(c)) {
        return children;
    }
    let mut flat = Vec::with_capacity(children.len());
    for child in children {
        match &child.shape {
            Shape::Combination(_, inner) if is_same(&child) => flat.extend(inner.iter().cloned()),
            _ => flat.push(child),
        }
    }
    flat
}
