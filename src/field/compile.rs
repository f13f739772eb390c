//! A tree of shapes becomes a tree of closures, over any number.
//!
//! The functions that make closures are written once, in a macro, and stand in one module for each level of vector
//! instructions: what is made in a module runs with its instructions. This is the one file with `unsafe`: the call into
//! a module after its instructions were detected.
#![allow(unsafe_code)]

use super::Level;
use crate::catalogue::{AnyModifier, Combination, Similarity};
use crate::num::{Number, Vec3};
use crate::scene::{Graph, Node};
use std::sync::Arc;

/// A field, ready to be evaluated.
pub type Closure<N> = Arc<dyn Fn(&Vec3<N>) -> N + Send + Sync>;

/// A graph, ready to be evaluated: writes its outputs.
pub type Walked<N> = Arc<dyn Fn(&Vec3<N>, &mut [N]) + Send + Sync>;

/// Several shapes of a union, ready to be joined to what comes before them: takes the point and the field so far, which it
/// changes in place (a value that is handed on is copied twice, which is slow to be read again).
type Siblings<N> = Arc<dyn Fn(&Vec3<N>, &mut N) + Send + Sync>;

/// The next shapes of a union.
enum Stretch<N> {
    One(Closure<N>),
    Many(Siblings<N>),
}

/// The walk over a graph, with the instructions of `level`, or of the best level below it that the processor has.
pub fn compile_graph<N: Number>(graph: &Arc<Graph>, level: Level) -> Walked<N> {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { avx512::walked(graph) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { avx2::walked(graph) },
        _ => baseline::walked(graph),
    }
}

/// Work that runs with the instructions of a level: all that it calls is inlined into it or is a closure of that level.
pub trait Task {
    /// What it gives.
    type Output;

    /// Does the work. To be marked `#[inline(always)]`, or it falls out of the level.
    fn run(self) -> Self::Output;
}

/// Runs `task` with the instructions of `level`, or of the best level below it that the processor has.
///
/// Inlined, since a task that is handed on is written once more, in pieces that are slow to be read together.
#[inline(always)]
pub fn run_at<T: Task>(level: Level, task: T) -> T::Output {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { tasks::run_avx512(task) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { tasks::run_avx2(task) },
        _ => tasks::run_baseline(task),
    }
}

/// Tasks, for each level: apart from the closures, so that a change of a task does not compile them again.
mod tasks {
    use super::Task;

    #[inline(never)]
    pub(super) fn run_baseline<T: Task>(task: T) -> T::Output {
        task.run()
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    pub(super) fn run_avx2<T: Task>(task: T) -> T::Output {
        task.run()
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl")]
    pub(super) fn run_avx512<T: Task>(task: T) -> T::Output {
        task.run()
    }
}

/// The field of `node` as a closure without special instructions: for scalars, duals and intervals.
pub fn compile<N: Number>(node: &Node) -> Closure<N> {
    baseline::build::<N, true>(node)
}

/// The field of `node` as a closure that uses the instructions of `level`, or of the best level below it that the
/// processor has: for wide lanes and duals of them.
pub fn compile_wide<N: Number>(node: &Node, level: Level) -> Closure<N> {
    at_level::<N, true>(node, level)
}

/// As [`compile_wide`], for a field without graphs ([`Node::has_graph`]): the code for them is not made for `N` (it would
/// be a third of the library's build).
pub fn compile_convex<N: Number>(node: &Node, level: Level) -> Closure<N> {
    at_level::<N, false>(node, level)
}

fn at_level<N: Number, const GRAPHS: bool>(node: &Node, level: Level) -> Closure<N> {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { avx512::build::<N, GRAPHS>(node) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { avx2::build::<N, GRAPHS>(node) },
        _ => baseline::build::<N, GRAPHS>(node),
    }
}

/// The closure of what a modifier makes of a closure that was compiled for `level`; none where it is a graph for such
/// numbers.
pub fn modify<N: Number>(
    modifier: &AnyModifier,
    child: Closure<N>,
    level: Level,
) -> Option<Closure<N>> {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { avx512::modifying(modifier, child) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { avx2::modifying(modifier, child) },
        _ => baseline::modifying(modifier, child),
    }
}

/// The closure of what `map` places, given its own that was compiled for `level`.
pub fn place<N: Number>(child: Closure<N>, map: Similarity, level: Level) -> Closure<N> {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { avx512::placed(child, map) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { avx2::placed(child, map) },
        _ => baseline::placed(child, map),
    }
}

/// The closure of a combination of closures that were compiled for `level`; none where its blend is a graph for such numbers.
pub fn combine<N: Number>(
    combination: &Combination,
    children: Vec<Closure<N>>,
    level: Level,
) -> Option<Closure<N>> {
    match level.min(Level::supported()) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::supported` has detected every feature of the module.
        Level::Avx512 => unsafe { avx512::combined(combination, children) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { avx2::combined(combination, children) },
        _ => baseline::combined(combination, children),
    }
}

/// How many registers of a program live on the stack: more cost more, as every register begins with a value.
const FEW_REGISTERS: usize = 6;
const SOME_REGISTERS: usize = 12;
const MANY_REGISTERS: usize = 32;

/// The functions that make closures, for one level.
macro_rules! builders {
    ($(#[$feature:meta])* mod $level:ident; whole: $whole:literal) => {
        mod $level {
            use super::{Closure, FEW_REGISTERS, MANY_REGISTERS, SOME_REGISTERS, Siblings, Stretch, Walked};
            use crate::catalogue::{AnyBlend, AnyModifier, AnyPrimitive, Blend, Combination, Modifier, Operation, Placing};
            use crate::catalogue::{Capsule, Cuboid, Cylinder, Primitive, Similarity, Sphere, Torus};
            use crate::catalogue::{with_blend, with_compiled_blend, with_compiled_modifier, with_compiled_primitive};
            use crate::catalogue::{with_modifier, with_primitive};
            use crate::num::{Number, Vec3};
            use crate::scene::{Graph, Node, Program, Shape};
            use std::sync::Arc;

            /// Whether all entries of the catalogue are compiled for `N`, also those that otherwise run as graphs: their
            /// results have the same bits.
            const fn is_whole<N: Number>() -> bool {
                $whole && N::LANES > 1
            }

            /// The closure of a node: transforms that keep angles are folded into one.
            $(#[$feature])*
            pub(super) fn build<N: Number, const GRAPHS: bool>(node: &Node) -> Closure<N> {
                let (map, inner) = node.unplaced();
                if let Shape::Primitive(primitive) = inner.shape()
                    && let Some(leaf) = primitive_at::<N>(primitive, map)
                {
                    return leaf;
                }
                let child = warped::<N, GRAPHS>(inner);
                if map == Similarity::IDENTITY { child } else { placed(child, map) }
            }

            $(#[$feature])*
            fn warped<N: Number, const GRAPHS: bool>(node: &Node) -> Closure<N> {
                let is_formula = matches!(node.shape(), Shape::Field(_) | Shape::Displacement(_));
                if GRAPHS
                    && (is_formula || !is_whole::<N>())
                    && let Some(graph) = node.graph()
                {
                    return recorded(graph);
                }
                let compiled = match node.shape() {
                    Shape::Primitive(primitive) => primitive_at(primitive, Similarity::IDENTITY),
                    Shape::Field(_) => None,
                    Shape::Combination(combination, children) => match united::<N, GRAPHS>(combination, children) {
                        None => combined(combination, children.iter().map(|c| build::<N, GRAPHS>(c)).collect()),
                        stretches => stretches,
                    },
                    Shape::Modifier(modifier, child) => modifying(modifier, build::<N, GRAPHS>(child)),
                    Shape::Displacement(_) => None,
                };
                // Not a number: a walk that meets it ends as unknown.
                compiled.unwrap_or_else(|| Arc::new(|_: &Vec3<N>| N::splat(f64::NAN)))
            }

            $(#[$feature])*
            fn primitive_at<N: Number>(primitive: &AnyPrimitive, map: Similarity) -> Option<Closure<N>> {
                if is_whole::<N>() {
                    Some(with_primitive!(primitive, p => leaf(p.clone(), map)))
                } else {
                    with_compiled_primitive!(primitive, p => leaf(p.clone(), map))
                }
            }

            $(#[$feature])*
            fn leaf<P: Primitive, N: Number>(leaf: P, map: Similarity) -> Closure<N> {
                let placing = Placing::new(&map);
                if map.is_translation() {
                    return Arc::new(move |p: &Vec3<N>| leaf.distance(&placing.moved(p)));
                }
                Arc::new(move |p: &Vec3<N>| placing.field(leaf.distance(&placing.point(p))))
            }

            $(#[$feature])*
            pub(super) fn placed<N: Number>(child: Closure<N>, map: Similarity) -> Closure<N> {
                let placing = Placing::new(&map);
                if map.is_translation() {
                    return Arc::new(move |p: &Vec3<N>| child(&placing.moved(p)));
                }
                Arc::new(move |p: &Vec3<N>| placing.field(child(&placing.point(p))))
            }

            /// The closure of what a modifier makes of a closure that is there already.
            $(#[$feature])*
            pub(super) fn modifying<N: Number>(modifier: &AnyModifier, child: Closure<N>) -> Option<Closure<N>> {
                if is_whole::<N>() {
                    Some(with_modifier!(modifier, m => modified(m.clone(), child)))
                } else {
                    with_compiled_modifier!(modifier, m => modified(m.clone(), child))
                }
            }

            $(#[$feature])*
            fn modified<M: Modifier, N: Number>(modifier: M, child: Closure<N>) -> Closure<N> {
                Arc::new(move |p: &Vec3<N>| modifier.apply(p, |q| child(q)))
            }

            /// The closure of a combination of closures that are there already.
            $(#[$feature])*
            pub(super) fn combined<N: Number>(combination: &Combination, children: Vec<Closure<N>>) -> Option<Closure<N>> {
                let operation = combination.operation;
                if is_whole::<N>() {
                    Some(with_blend!(&combination.blend, b => joined(operation, b.clone(), children)))
                } else {
                    with_compiled_blend!(&combination.blend, b => joined(operation, b.clone(), children))
                }
            }

            /// The closure of a union in which neighbours of one kind are a loop, not a call for each; none where there are no
            /// such neighbours.
            $(#[$feature])*
            fn united<N: Number, const GRAPHS: bool>(combination: &Combination, nodes: &[Arc<Node>]) -> Option<Closure<N>> {
                if !is_whole::<N>() || combination.operation != Operation::Union {
                    return None;
                }
                match &combination.blend {
                    AnyBlend::Hard(blend) => in_stretches::<_, N, GRAPHS>(blend, nodes),
                    AnyBlend::Smooth(blend) => in_stretches::<_, N, GRAPHS>(blend, nodes),
                    _ => None,
                }
            }

            $(#[$feature])*
            fn in_stretches<B: Blend, N: Number, const GRAPHS: bool>(
                blend: &B,
                nodes: &[Arc<Node>],
            ) -> Option<Closure<N>> {
                let (first, mut rest) = nodes.split_first()?;
                let mut stretches: Vec<Stretch<N>> = Vec::new();
                while let Some((next, others)) = rest.split_first() {
                    // Those whose fields take little longer than a call.
                    let siblings = siblings::<Sphere, _, N>(blend, rest)
                        .or_else(|| siblings::<Cuboid, _, N>(blend, rest))
                        .or_else(|| siblings::<Cylinder, _, N>(blend, rest))
                        .or_else(|| siblings::<Capsule, _, N>(blend, rest))
                        .or_else(|| siblings::<Torus, _, N>(blend, rest));
                    if let Some((stretch, count)) = siblings {
                        stretches.push(Stretch::Many(stretch));
                        rest = &rest[count..];
                        continue;
                    }
                    stretches.push(Stretch::One(build::<N, GRAPHS>(next)));
                    rest = others;
                }
                if stretches.len() + 1 == nodes.len() {
                    return None;
                }
                let (blend, first) = (B::clone(blend), build::<N, GRAPHS>(first));
                let stretches = stretches.into_boxed_slice();
                Some(Arc::new(move |p: &Vec3<N>| {
                    let mut value = first(p);
                    for stretch in stretches.iter() {
                        match stretch {
                            Stretch::One(child) => value = Operation::Union.join(&blend, value, child(p)),
                            Stretch::Many(siblings) => siblings(p, &mut value),
                        }
                    }
                    value
                }))
            }

            /// The primitives of one kind that `nodes` begin with, and how many they are; none where there are fewer than two.
            $(#[$feature])*
            fn siblings<P: Primitive, B: Blend, N: Number>(
                blend: &B,
                nodes: &[Arc<Node>],
            ) -> Option<(Siblings<N>, usize)>
            where
                for<'a> &'a P: TryFrom<&'a AnyPrimitive>,
            {
                let is_moved = nodes.first()?.unplaced().0.is_translation();
                let mut leaves: Vec<(P, Placing<N>)> = Vec::new();
                for node in nodes {
                    let (map, inner) = node.unplaced();
                    let Shape::Primitive(primitive) = inner.shape() else { break };
                    let Ok(leaf) = <&P>::try_from(primitive) else { break };
                    if map.is_translation() != is_moved {
                        break;
                    }
                    leaves.push((P::clone(leaf), Placing::new(&map)));
                }
                let (blend, count) = (B::clone(blend), leaves.len());
                if count < 2 {
                    return None;
                }
                let leaves = leaves.into_boxed_slice();
                let stretch: Siblings<N> = if is_moved {
                    Arc::new(move |p: &Vec3<N>, all: &mut N| {
                        let mut value = *all;
                        for (leaf, placing) in leaves.iter() {
                            value = Operation::Union.join(&blend, value, leaf.distance(&placing.moved(p)));
                        }
                        *all = value;
                    })
                } else {
                    Arc::new(move |p: &Vec3<N>, all: &mut N| {
                        let mut value = *all;
                        for (leaf, placing) in leaves.iter() {
                            let own = placing.field(leaf.distance(&placing.point(p)));
                            value = Operation::Union.join(&blend, value, own);
                        }
                        *all = value;
                    })
                };
                Some((stretch, count))
            }

            $(#[$feature])*
            fn joined<B: Blend, N: Number>(
                operation: Operation,
                blend: B,
                mut children: Vec<Closure<N>>,
            ) -> Closure<N> {
                let rest = children.split_off(1);
                let first = children.remove(0);
                match operation {
                    Operation::Union | Operation::Joint => Arc::new(move |p: &Vec3<N>| {
                        let mut value = first(p);
                        for child in &rest {
                            value = Operation::Union.join(&blend, value, child(p));
                        }
                        value
                    }),
                    Operation::Intersection => Arc::new(move |p: &Vec3<N>| {
                        let mut value = first(p);
                        for child in &rest {
                            value = Operation::Intersection.join(&blend, value, child(p));
                        }
                        value
                    }),
                    Operation::Difference => Arc::new(move |p: &Vec3<N>| {
                        let mut value = first(p);
                        for child in &rest {
                            value = Operation::Difference.join(&blend, value, child(p));
                        }
                        value
                    }),
                }
            }

            $(#[$feature])*
            fn recorded<N: Number>(graph: &Arc<Graph>) -> Closure<N> {
                let program = Program::new(graph);
                let shapes = graph.shapes().iter().map(|s| build::<N, true>(s)).collect();
                match program.registers() {
                    0..=FEW_REGISTERS => recorded_in::<N, FEW_REGISTERS>(program, shapes),
                    ..=SOME_REGISTERS => recorded_in::<N, SOME_REGISTERS>(program, shapes),
                    ..=MANY_REGISTERS => recorded_in::<N, MANY_REGISTERS>(program, shapes),
                    count => Arc::new(move |p: &Vec3<N>| {
                        let mut registers = vec![p.x; count];
                        walk(&program, &shapes, p, &mut registers);
                        program.output(&registers, 0)
                    }),
                }
            }

            $(#[$feature])*
            fn recorded_in<N: Number, const R: usize>(program: Program, shapes: Vec<Closure<N>>) -> Closure<N> {
                Arc::new(move |p: &Vec3<N>| {
                    let mut registers = [p.x; R];
                    walk(&program, &shapes, p, &mut registers);
                    program.output(&registers, 0)
                })
            }

            /// The walk over a graph: writes its outputs.
            $(#[$feature])*
            pub(super) fn walked<N: Number>(graph: &Arc<Graph>) -> Walked<N> {
                let program = Program::new(graph);
                let shapes = graph.shapes().iter().map(|s| build::<N, true>(s)).collect();
                match program.registers() {
                    0..=FEW_REGISTERS => walked_in::<N, FEW_REGISTERS>(program, shapes),
                    ..=SOME_REGISTERS => walked_in::<N, SOME_REGISTERS>(program, shapes),
                    ..=MANY_REGISTERS => walked_in::<N, MANY_REGISTERS>(program, shapes),
                    count => Arc::new(move |p: &Vec3<N>, outputs: &mut [N]| {
                        let mut registers = vec![p.x; count];
                        walk(&program, &shapes, p, &mut registers);
                        program.write(&registers, outputs);
                    }),
                }
            }

            $(#[$feature])*
            fn walked_in<N: Number, const R: usize>(program: Program, shapes: Vec<Closure<N>>) -> Walked<N> {
                Arc::new(move |p: &Vec3<N>, outputs: &mut [N]| {
                    let mut registers = [p.x; R];
                    walk(&program, &shapes, p, &mut registers);
                    program.write(&registers, outputs);
                })
            }

            /// One walk over a program, in registers that all hold the point's x: apart, because its code is long.
            $(#[$feature])*
            #[inline(never)]
            fn walk<N: Number>(program: &Program, shapes: &[Closure<N>], p: &Vec3<N>, registers: &mut [N]) {
                (registers[1], registers[2]) = (p.y, p.z);
                program.run(p, registers, &|i, q: &Vec3<N>| shapes[i](q));
            }
        }
    };
}

builders! { mod baseline; whole: false }
#[cfg(target_arch = "x86_64")]
builders! { #[target_feature(enable = "avx2")] mod avx2; whole: true }
#[cfg(target_arch = "x86_64")]
builders! { #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl")] mod avx512; whole: true }
