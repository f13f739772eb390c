//! Solids for tests, and what rays find on them.

use super::rays::random;
use fieldstone::catalogue::AnyModifier;
use fieldstone::scene::{Method, Node, Settings};
use fieldstone::trace::{Outcome, Ray, Verdict, Visibility, World};
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

/// Holds the verdicts of `auto` against those of the reference where it has one; `check` is given the hits of both, with words that
/// say which. Gives how many hits there were, and how often `auto` asked the field.
pub fn agree(
    what: &str,
    node: &Arc<Node>,
    rays: &[Ray],
    check: impl Fn(&Outcome, &Outcome, &str),
) -> (u64, u64) {
    let auto = found(node, Method::Auto, rays);
    let reference = found(node, Method::Reference, rays);
    let (mut hits, mut asked) = (0, 0);
    for ((ray, a), b) in rays.iter().zip(&auto).zip(&reference) {
        asked += u64::from(a.evaluations);
        if b.verdict == Verdict::Unknown {
            continue;
        }
        let what = format!("{what}, {ray:?}: {a:?}, {b:?}");
        assert_eq!(a.verdict, b.verdict, "{what}");
        if a.verdict == Verdict::Hit {
            hits += 1;
            check(a, b, &what);
        }
    }
    (hits, asked)
}
