//! One number or eight at once.
//!
//! Passes are computed for eight satellites at a time: a processor takes two or more numbers
//! through one operation as fast as one, and has something to do while others wait for the result
//! of the previous step. Code that serves both is written once, for any [`Number`].

mod trig;
mod vector;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use wide::f64x8;

pub(super) use self::vector::Vector;

/// Numbers that go through the same operations.
pub(super) type Lanes = f64x8;
pub(super) const LANES: usize = 8;

/// From here on, a number of this type has no digits after the point.
const WHOLE_ABOVE: f64 = 6_755_399_441_055_744.0;

/// A real number, or several side by side.
pub(super) trait Number:
    Copy
    + From<f64>
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
    /// A yes or no for every lane.
    type Answer: BitAnd<Output = Self::Answer> + BitOr<Output = Self::Answer>;
    /// This value in every lane.
    fn of(value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The nearest whole number, for numbers below 2^51.
    fn nearest(self) -> Self {
        self + WHOLE_ABOVE - WHOLE_ABOVE
    }
    /// Accurate to 1e-13 for angles up to a thousand; beyond that, as accurate as the remaining
    /// digits of the angle.
    fn sin_cos(self) -> (Self, Self) {
        trig::sin_cos(self)
    }
    /// The angle of the direction (`x`, `self`), -pi to pi, accurate to 5e-11.
    fn atan2(self, x: Self) -> Self;
    /// The nearest number from `low` to `high`.
    fn within(self, low: f64, high: f64) -> Self;
    /// Compares each lane with `than`: true if it is less, false for NaN.
    fn is_less(self, than: Self) -> Self::Answer;
    /// Returns `true` if any lane is at least `limit`; NaN is not.
    fn any_reaches(self, limit: f64) -> bool;
}

impl Number for f64 {
    type Answer = bool;
    fn of(value: f64) -> Self {
        value
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
    fn within(self, low: f64, high: f64) -> Self {
        self.clamp(low, high)
    }
    fn is_less(self, than: Self) -> bool {
        self < than
    }
    fn any_reaches(self, limit: f64) -> bool {
        self >= limit
    }
}

impl Number for Lanes {
    type Answer = Self;
    fn of(value: f64) -> Self {
        Self::splat(value)
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn atan2(self, x: Self) -> Self {
        trig::atan2(self, x)
    }
    fn within(self, low: f64, high: f64) -> Self {
        self.clamp(Self::splat(low), Self::splat(high))
    }
    fn is_less(self, than: Self) -> Self {
        self.simd_lt(than)
    }
    fn any_reaches(self, limit: f64) -> bool {
        self.simd_ge(Self::splat(limit)).any()
    }
}

/// The value of a polynomial, constant term first. Its coefficients may differ from lane to lane.
pub(super) fn series<N, C, const COUNT: usize>(polynomial: &[C; COUNT], at: N) -> N
where
    N: Number + Add<C, Output = N>,
    C: Copy + Into<N>,
{
    polynomial.split_last().map_or(N::of(0.0), |(highest, others)| {
        others.iter().rev().fold((*highest).into(), |sum, coefficient| sum * at + *coefficient)
    })
}

/// Puts a number into a lane; has no effect beyond the last lane.
pub(super) fn set(numbers: &mut Lanes, lane: usize, number: f64) {
    if let Some(place) = numbers.as_mut_array().get_mut(lane) {
        *place = number;
    }
}

/// Puts each number into a lane of its own vector.
pub(super) fn set_all<const COUNT: usize>(
    all: &mut [Lanes; COUNT],
    lane: usize,
    numbers: &[f64; COUNT],
) {
    for (lanes, number) in all.iter_mut().zip(numbers) {
        set(lanes, lane, *number);
    }
}

/// The number in one lane; NaN beyond the last lane.
pub(super) fn lane_of(numbers: &Lanes, lane: usize) -> f64 {
    numbers.as_array().get(lane).copied().unwrap_or(f64::NAN)
}

/// The answer for one lane.
pub(super) fn holds_in(answers: Lanes, lane: usize) -> bool {
    answers.to_bitmask() >> lane & 1 == 1
}
