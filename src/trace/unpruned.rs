//! Worlds without pruning, for studies of what it saves.

use super::hierarchy::Hierarchy;
use super::join::hard_union;
use super::method::Demands;
use super::part::{Part, PartKind};
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
        world.prunes = false;
        Ok(world)
    }

    /// The same world, where nothing is passed over: every part is asked of every ray, combinations are evaluated whole, and
    /// rays that meet nothing are traced as all others. What is found is the same, to the bit; only it takes longer.
    pub fn without_pruning(mut self) -> Self {
        self.prunes = false;
        self.is_thinned = false;
        self.hierarchy = Hierarchy::new(&[]);
        self.endless = (0..self.parts.len() as u32).collect();
        for part in &mut self.parts {
            if let PartKind::Marched(marched) = &mut part.kind {
                marched.thicket = None;
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Sphere};
    use crate::trace::Beam;
    use glam::DVec3;

    #[test]
    fn nothing_is_passed_over_without_pruning() {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(1.0))).unwrap();
        let away = Beam::within([DVec3::new(0.0, 0.0, 5.0); 2], [DVec3::Z; 2]);
        let world = World::of(&[ball], &Settings::default()).unwrap();
        assert!(!world.may_meet(&away));
        assert!(world.without_pruning().may_meet(&away));
    }
}
