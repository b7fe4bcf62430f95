//! One number or eight at once.
//!
//! Azel computes passes for eight satellites at a time. A processor handles two or more numbers in
//! one operation as fast as one. It also works on some numbers while others wait for the previous
//! step. Code for both cases is written once, for any [`Number`].
//!
//! The number of values in a register is known only at run time ([`widest`]). Code that uses these
//! registers must be inlined up to that function, and carries `inline` attributes.

mod lanes;
mod trig;
mod vector;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

pub(super) use self::{
    lanes::{Answers, LANES, Lanes},
    vector::Vector,
};

/// Magnitude from which a number of this type has no digits after the point.
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
    /// Returns this value in every lane.
    fn splat(value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// Returns the nearest whole number, for numbers below 2^51.
    #[inline]
    fn nearest(self) -> Self {
        self + WHOLE_ABOVE - WHOLE_ABOVE
    }
    /// Returns sine and cosine. They are accurate to 1e-13 for angles up to a thousand; beyond
    /// that, as accurate as the remaining digits of the angle.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        trig::sin_cos(self)
    }
    /// Returns the angle of the direction (`x`, `self`), -pi to pi, accurate to 5e-11.
    fn atan2(self, x: Self) -> Self;
    /// Returns the nearest number from `low` to `high`.
    fn clamped(self, low: f64, high: f64) -> Self;
    /// Compares each lane with `other`: true if the lane is less, false for NaN.
    fn is_less(self, other: Self) -> Self::Answer;
    /// Returns `true` if any lane is at least `limit`; NaN does not count.
    fn any_reaches(self, limit: f64) -> bool;
}

impl Number for f64 {
    type Answer = bool;
    fn splat(value: f64) -> Self {
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
    fn clamped(self, low: f64, high: f64) -> Self {
        self.clamp(low, high)
    }
    fn is_less(self, other: Self) -> bool {
        self < other
    }
    fn any_reaches(self, limit: f64) -> bool {
        self >= limit
    }
}

/// Returns the value of a polynomial, constant term first. Its coefficients may differ from lane to
/// lane.
#[inline(always)]
pub(super) fn series<N, C, const COUNT: usize>(polynomial: &[C; COUNT], argument: N) -> N
where
    N: Number + Add<C, Output = N>,
    C: Copy + Into<N>,
{
    polynomial.split_last().map_or(N::splat(0.0), |(highest, others)| {
        others
            .iter()
            .rev()
            .fold((*highest).into(), |sum, coefficient| sum * argument + *coefficient)
    })
}

/// Puts each number of `numbers` into the lane `lane` of its entry in `all`.
pub(super) fn set_all<const COUNT: usize>(
    all: &mut [Lanes; COUNT],
    lane: usize,
    numbers: &[f64; COUNT],
) {
    for (lanes, number) in all.iter_mut().zip(numbers) {
        lanes.set(lane, *number);
    }
}

/// Runs `work` with registers of four numbers if the processor has them, otherwise of two. The
/// results are the same to the last bit. `work` must be inlined, for example a closure with an
/// `inline` attribute.
#[inline(always)]
pub(super) fn widest<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = fearless_simd::Level::new().as_avx2() {
        return fearless_simd::Simd::vectorize(avx2, work);
    }
    work()
}
