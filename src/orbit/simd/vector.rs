//! Vectors in three dimensions, one or several at once.

use std::ops::{Add, Mul, Sub};

use glam::DVec3;

use super::{Lanes, Number};

/// A vector in three dimensions, with one or several values per component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vector<N> {
    pub(crate) x: N,
    pub(crate) y: N,
    pub(crate) z: N,
}

impl<N: Number> Vector<N> {
    #[inline]
    pub(crate) fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }

    #[inline]
    pub(crate) fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    #[inline]
    pub(crate) fn length_squared(self) -> N {
        self.dot(self)
    }

    #[inline]
    pub(crate) fn length(self) -> N {
        self.length_squared().sqrt()
    }
}

impl Vector<Lanes> {
    pub(crate) fn lane(&self, lane: usize) -> Vector<f64> {
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|numbers| numbers.lane(lane));
        Vector { x, y, z }
    }
}

impl<N: Number> From<DVec3> for Vector<N> {
    #[inline]
    fn from(vector: DVec3) -> Self {
        Self::new(N::splat(vector.x), N::splat(vector.y), N::splat(vector.z))
    }
}

impl From<Vector<f64>> for DVec3 {
    #[inline]
    fn from(Vector { x, y, z }: Vector<f64>) -> Self {
        Self::new(x, y, z)
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: N) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}
