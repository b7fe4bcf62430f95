//! One number or eight at once.
//!
//! The passes of a satellite are worked eight at a time: a processor takes two
//! or more numbers through one operation as fast as one, and has something to
//! do while others wait for the result of the step before. What serves both is
//! written once, for any [`Number`].

use std::{
    f64::consts::TAU,
    ops::{Add, Div, Mul, Neg, Sub},
};

use glam::DVec3;
use wide::f64x8;

/// Numbers that go through the same operations.
pub(super) type Lanes = f64x8;
/// How many they are.
pub(super) const LANES: usize = 8;

/// From here on a number of this type has no digits after the point.
const WHOLE_ABOVE: f64 = 6_755_399_441_055_744.0;
/// A turn in two parts, of which the first has few enough digits to be taken
/// many times without rounding.
const TURN_HIGH: f64 = 4.0 * 1.570_796_326_734_125_6;
const TURN_LOW: f64 = 4.0 * 6.077_100_506_506_192e-11;

/// A real number, or several side by side.
pub(super) trait Number:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// This value in every lane.
    fn of(value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The nearest whole number, for numbers below 2^51.
    fn nearest(self) -> Self {
        self + WHOLE_ABOVE - WHOLE_ABOVE
    }
    /// Within 1e-15, for angles up to a million.
    fn sin_cos(self) -> (Self, Self) {
        sin_cos(self)
    }
    fn acos(self) -> Self;
    fn asin(self) -> Self;
    /// The angle of the direction (`x`, `self`), -pi to pi.
    fn atan2(self, x: Self) -> Self;
    /// The nearest number from `low` to `high`.
    fn within(self, low: f64, high: f64) -> Self;
    /// Whether any lane is this large. What is no number is not.
    fn any_reaches(self, limit: f64) -> bool;
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn acos(self) -> Self {
        self.acos()
    }
    fn asin(self) -> Self {
        self.asin()
    }
    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
    fn within(self, low: f64, high: f64) -> Self {
        self.clamp(low, high)
    }
    fn any_reaches(self, limit: f64) -> bool {
        self >= limit
    }
}

impl Number for Lanes {
    fn of(value: f64) -> Self {
        Self::splat(value)
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn acos(self) -> Self {
        self.acos()
    }
    fn asin(self) -> Self {
        self.asin()
    }
    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
    fn within(self, low: f64, high: f64) -> Self {
        self.clamp(Self::splat(low), Self::splat(high))
    }
    fn any_reaches(self, limit: f64) -> bool {
        self.simd_ge(Self::splat(limit)).any()
    }
}

/// Sine and cosine from those of the quarter of the angle, for which the power
/// series are short, doubled twice. No branch, so that all lanes go one way.
fn sin_cos<N: Number>(angle: N) -> (N, N) {
    let turns = (angle * (1.0 / TAU)).nearest();
    let quarter = (angle - turns * TURN_HIGH - turns * TURN_LOW) * 0.25;
    let square = quarter * quarter;
    let sine = quarter + quarter * square * series(&SINE, square);
    // 1 - cosine keeps the digits that doubling would lose.
    let less = square * (square * series(&COSINE, square) + 0.5);
    let double_sine = sine * (-less + 1.0) * 2.0;
    let double_less = sine * sine * 2.0;
    let sine = double_sine * (-double_less + 1.0) * 2.0;
    let cosine = -(double_sine * double_sine * 2.0) + 1.0;
    (sine, cosine)
}

/// The coefficients after the first of sin x / x and (1 - cos x) / x², by powers
/// of x²: enough for an eighth of a turn.
const SINE: [f64; 7] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];
const COSINE: [f64; 7] = [
    -1.0 / 24.0,
    1.0 / 720.0,
    -1.0 / 40_320.0,
    1.0 / 3_628_800.0,
    -1.0 / 479_001_600.0,
    1.0 / 87_178_291_200.0,
    -1.0 / 20_922_789_888_000.0,
];

/// The polynomial's value, constant term first.
pub(super) fn series<N: Number, const COUNT: usize>(polynomial: &[f64; COUNT], at: N) -> N {
    polynomial.iter().rev().fold(N::of(0.0), |sum, coefficient| sum * at + *coefficient)
}

/// A vector in three dimensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vector<N> {
    pub(super) x: N,
    pub(super) y: N,
    pub(super) z: N,
}

impl<N: Number> Vector<N> {
    pub(super) fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }

    pub(super) fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(super) fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    pub(super) fn length_squared(self) -> N {
        self.dot(self)
    }

    pub(super) fn length(self) -> N {
        self.length_squared().sqrt()
    }
}

/// Up to as many numbers as there are lanes; the last one fills the rest.
pub(super) fn lanes_of(numbers: &[f64]) -> Lanes {
    let mut lanes = [numbers.last().copied().unwrap_or_default(); LANES];
    for (lane, number) in lanes.iter_mut().zip(numbers) {
        *lane = *number;
    }
    Lanes::from(lanes)
}

/// The number of one lane.
pub(super) fn lane_of(numbers: &Lanes, lane: usize) -> Option<f64> {
    numbers.as_array().get(lane).copied()
}

impl Vector<Lanes> {
    /// The vector of one lane.
    pub(super) fn lane(&self, lane: usize) -> Option<Vector<f64>> {
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|numbers| lane_of(numbers, lane));
        Some(Vector { x: x?, y: y?, z: z? })
    }
}

impl<N: Number> From<DVec3> for Vector<N> {
    fn from(vector: DVec3) -> Self {
        Self::new(N::of(vector.x), N::of(vector.y), N::of(vector.z))
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;
    fn mul(self, factor: N) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_right_in_every_lane() {
        for step in -20_000..20_000 {
            let angles = [0.001, 0.37, 7.3, 50.0].map(|scale| f64::from(step) * scale);
            let (sines, cosines) = Number::sin_cos(Lanes::from(angles));
            for (lane, angle) in angles.iter().enumerate() {
                let (sine, cosine) = angle.sin_cos();
                assert!((sines.as_array()[lane] - sine).abs() < 1.5e-15, "{angle}");
                assert!((cosines.as_array()[lane] - cosine).abs() < 1.5e-15, "{angle}");
            }
        }
        let (sine, cosine) = Number::sin_cos(Lanes::from([f64::NAN, f64::INFINITY, 0.0, 1.0]));
        assert!(sine.as_array()[..2].iter().all(|sine| sine.is_nan()));
        assert_eq!((sine.as_array()[2], cosine.as_array()[2]), (0.0, 1.0));
    }
}
