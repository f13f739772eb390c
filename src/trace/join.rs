//! Transparent shapes that overlap and have one material are one body: no surface is seen inside of it.

use super::part::materials;
use crate::catalogue::{AnyBlend, Combination, Operation};
use crate::scene::{Fault, Material, Node};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The pieces of a scene, with those of the same transparent material that overlap united. A body stands
/// where its first piece stood.
pub(super) fn joined(pieces: Vec<Arc<Node>>) -> Vec<Arc<Node>> {
    let transparent: Vec<Option<Arc<Material>>> =
        pieces.iter().map(|node| clear_material(node)).collect();
    if transparent.iter().all(Option::is_none) {
        return pieces;
    }
    let leaders = leaders(&pieces, &transparent);
    let mut bodies: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, leader) in leaders.into_iter().enumerate() {
        bodies.entry(leader).or_default().push(i);
    }
    bodies
        .values()
        .flat_map(|members| united(&pieces, members))
        .collect()
}

/// The body of these pieces; the pieces themselves where it cannot be made.
fn united(pieces: &[Arc<Node>], members: &[usize]) -> Vec<Arc<Node>> {
    let nodes = members.iter().map(|i| pieces[*i].clone()).collect();
    match hard_union(nodes) {
        Ok(body) => vec![body],
        Err(_) => members.iter().map(|i| pieces[*i].clone()).collect(),
    }
}

/// The hard union of these shapes.
///
/// # Errors
/// As [`Node::combination`].
pub(super) fn hard_union(nodes: Vec<Arc<Node>>) -> Result<Arc<Node>, Fault> {
    let union = Combination {
        operation: Operation::Union,
        blend: AnyBlend::HARD,
    };
    Node::combination(union, nodes)
}

/// For each piece the first piece of its body, found by a sweep along x.
fn leaders(pieces: &[Arc<Node>], transparent: &[Option<Arc<Material>>]) -> Vec<usize> {
    let bounds = |i: usize| pieces[i].bounds();
    let mut order: Vec<usize> = (0..pieces.len())
        .filter(|i| transparent[*i].is_some())
        .collect();
    order.sort_by(|a, b| {
        bounds(*a).low[0]
            .total_cmp(&bounds(*b).low[0])
            .then(a.cmp(b))
    });
    let mut leader: Vec<usize> = (0..pieces.len()).collect();
    for (place, i) in order.iter().enumerate() {
        let reach = bounds(*i);
        for j in order[place + 1..]
            .iter()
            .take_while(|j| bounds(**j).low[0] <= reach.high[0])
        {
            let is_same = match (&transparent[*i], &transparent[*j]) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                _ => false,
            };
            if is_same && !bounds(*j).intersect(reach).is_empty() {
                let (a, b) = (root(&leader, *i), root(&leader, *j));
                leader[a.max(b)] = a.min(b);
            }
        }
    }
    (0..pieces.len()).map(|i| root(&leader, i)).collect()
}

fn root(leader: &[usize], mut i: usize) -> usize {
    while leader[i] != i {
        i = leader[i];
    }
    i
}

/// The material of a shape that has only one and lets light through.
fn clear_material(node: &Node) -> Option<Arc<Material>> {
    match &materials(node)[..] {
        [Some(material)] if !material.refract.is_zero() && !node.traits().is_sheet => {
            Some(material.clone())
        }
        _ => None,
    }
}
