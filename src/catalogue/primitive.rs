//! Primitives: the leaves of a scene.

use super::{Bounds, Declared, Traits};
use crate::num::{Number, Vec3};

/// The mathematics of a leaf: a solid in space, or a profile in the plane `z = 0` whose field ignores z.
pub trait Primitive: Declared {
    /// The field at `p`: positive outside, negative inside, at most the distance to the surface times
    /// [`Primitive::lipschitz`].
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N;

    /// A box that holds every point where the field is at most `level`, for `level >= 0`.
    fn sublevel(&self, level: f64) -> Bounds;

    /// What is known about the field.
    fn traits(&self) -> Traits;

    /// The smallest Lipschitz constant, on all of space.
    fn lipschitz(&self) -> f64 {
        1.0
    }

    /// What no range of a single parameter can say.
    ///
    /// # Errors
    /// The name of the parameter at fault and a sentence that says what is wrong with it.
    fn check(&self) -> Result<(), (&'static str, String)> {
        Ok(())
    }
}
