//! Worlds without pruning, for studies of what it saves.

use super::join::hard_union;
use super::method::Demands;
use super::part::Part;
use super::world::World;
use crate::field::Level;
use crate::scene::{Fault, Node, Settings};
use std::sync::Arc;

/// The hard union of these shapes; of one, the shape itself.
///
/// # Errors
/// If there is none.
pub fn union(shown: &[Arc<Node>]) -> Result<Arc<Node>, Fault> {
    if let [only] = shown {
        return Ok(only.clone());
    }
    hard_union(shown.to_vec())
}

impl World {
    /// The world of these shapes as one field, their hard union, that every sample evaluates whole: no part is passed over, none
    /// is entered in closed form, nothing is thinned out. The steps are those of the method.
    ///
    /// # Errors
    /// As [`World::new`]; and if nothing is shown.
    pub fn unpruned(shown: &[Arc<Node>], settings: &Settings) -> Result<Self, Fault> {
        let level = Level::best();
        let demands = Demands {
            lanes: false,
            ..Demands::of(settings.method)
        };
        let part = Part::new(union(shown)?, demands, level)?;
        let mut world = Self::of_parts(vec![part], *settings, level);
        world.tells_empty = false;
        Ok(world)
    }
}
