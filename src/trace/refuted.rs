//! Constants that rays have refuted: which node's, and by which points.

use super::evidence::Witness;
use super::part::{Marched, Part, PartKind};
use super::world::World;
use crate::scene::Blame;

/// A Lipschitz constant that rays have refuted.
#[derive(Clone, Copy, Debug)]
pub struct Refuted<'a> {
    /// The innermost node whose constant is too small, with its constant, and two points with values that refute it.
    pub blame: Blame<'a>,
    /// How many walks of rays through the part have found such points.
    pub walks: u64,
}

impl<'a> Refuted<'a> {
    fn of(part: &'a Part, marched: &Marched, (witness, walks): (Witness, u64)) -> Self {
        let whole = || Blame {
            node: &part.node,
            placed: part.node.place().map(|_| &*part.node),
            points: witness.points,
            values: witness.values,
            constant: marched.lipschitz,
        };
        // Where the constants of the tree are right, that of the part was altered.
        let blame = part.node.blamed(marched.region, witness.points);
        Self {
            blame: blame.unwrap_or_else(whole),
            walks,
        }
    }
}

impl World {
    /// The constants that rays have refuted so far, in the order of the parts. Every method whose steps rest on constants
    /// looks, where it samples a field anyway; what no ray samples is not noticed.
    pub fn refuted(&self) -> Vec<Refuted<'_>> {
        self.parts.iter().filter_map(refuted).collect()
    }
}

fn refuted(part: &Part) -> Option<Refuted<'_>> {
    match &part.kind {
        PartKind::Marched(marched) => Some(Refuted::of(part, marched, marched.evidence.worst()?)),
        _ => None,
    }
}
