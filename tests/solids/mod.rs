//! Solids for tests, and what rays find on them.

use super::rays::random;
use fieldstone::catalogue::AnyModifier;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Outcome, Ray, Visibility, World};
use std::sync::Arc;

/// Number `k` in [0, 1) of a seed.
pub fn number(seed: u64, k: u64) -> f64 {
    random(seed.wrapping_mul(1_000_003).wrapping_add(k))
}

/// A shape under a modifier.
pub fn modified(modifier: AnyModifier, child: Arc<Node>) -> Arc<Node> {
    Node::modifier(modifier, child).expect("a valid modifier")
}

/// What rays find of a shape by a method.
pub fn found(node: &Arc<Node>, method: Method, rays: &[Ray]) -> Vec<Outcome> {
    let settings = Settings {
        method,
        ..Settings::default()
    };
    let world = World::of(std::slice::from_ref(node), &settings).expect("a world");
    world.nearest(rays, Visibility::All)
}
