//! Vectors over any number.

use super::Number;
use std::ops::{Add, Mul, Neg, Sub};

/// A point or direction with three components, in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<N> {
    /// First component.
    pub x: N,
    /// Second component, upwards.
    pub y: N,
    /// Third component.
    pub z: N,
}

impl<N: Number> Vec3<N> {
    /// The vector with these components.
    #[inline(always)]
    pub fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }

    /// The constant vector `v`.
    #[inline(always)]
    pub fn splat(v: [f64; 3]) -> Self {
        Self::new(N::splat(v[0]), N::splat(v[1]), N::splat(v[2]))
    }

    /// The vector of constants as they are kept.
    #[inline(always)]
    pub fn spread(v: [N::Constant; 3]) -> Self {
        Self::new(N::spread(v[0]), N::spread(v[1]), N::spread(v[2]))
    }

    /// `f` of each component.
    #[inline(always)]
    pub fn each(self, f: impl Fn(N) -> N) -> Self {
        Self::new(f(self.x), f(self.y), f(self.z))
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> N {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// The vector product, right-handed.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self::new(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    /// The square of the length.
    #[inline(always)]
    pub fn length_squared(self) -> N {
        self.x.square() + self.y.square() + self.z.square()
    }

    /// The Euclidean length.
    #[inline(always)]
    pub fn length(self) -> N {
        N::norm3(self.x, self.y, self.z)
    }

    /// Absolute values of the components.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.each(N::abs)
    }

    /// The larger of each pair of components.
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        Self::new(self.x.max(o.x), self.y.max(o.y), self.z.max(o.z))
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_component(self) -> N {
        self.x.max(self.y).max(self.z)
    }

    /// The product of each pair of components.
    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        Self::new(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// Component `axis`: 0 is x, 1 is y, anything else z.
    #[inline(always)]
    pub fn component(self, axis: usize) -> N {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    /// The same vector with component `axis` replaced.
    #[inline(always)]
    pub fn with_component(self, axis: usize, value: N) -> Self {
        match axis {
            0 => Self { x: value, ..self },
            1 => Self { y: value, ..self },
            _ => Self { z: value, ..self },
        }
    }
}

impl<N: Number> Add for Vec3<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<N: Number> Sub for Vec3<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<N: Number> Mul<N> for Vec3<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: N) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl<N: Number> Neg for Vec3<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
