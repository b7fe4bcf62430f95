//! Eight numbers that undergo the same operations.
//!
//! The lanes are plain arrays, which the compiler keeps in registers. The function into which an
//! operation is inlined determines the usable registers ([`widest`](super::widest)).

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use super::{Number, trig};

pub(crate) const LANES: usize = 8;

/// Eight numbers side by side, aligned for registers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub(crate) struct Lanes([f64; LANES]);

/// A yes or no for every lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answers([u64; LANES]);

/// Applies `op` to each pair of lanes.
#[inline]
fn by_lane<A: Copy, B: Copy, C>(
    a: [A; LANES],
    b: [B; LANES],
    op: impl Fn(A, B) -> C,
) -> [C; LANES] {
    let [a0, a1, a2, a3, a4, a5, a6, a7] = a;
    let [b0, b1, b2, b3, b4, b5, b6, b7] = b;
    [op(a0, b0), op(a1, b1), op(a2, b2), op(a3, b3), op(a4, b4), op(a5, b5), op(a6, b6), op(a7, b7)]
}

impl Lanes {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);

    pub(crate) fn as_array(&self) -> &[f64; LANES] {
        &self.0
    }

    /// Returns the number in one lane; NaN beyond the last lane.
    #[inline]
    pub(crate) fn lane(&self, lane: usize) -> f64 {
        self.0.get(lane).copied().unwrap_or(f64::NAN)
    }

    /// Puts a number into a lane; does nothing beyond the last lane.
    #[inline]
    pub(crate) fn set(&mut self, lane: usize, number: f64) {
        if let Some(place) = self.0.get_mut(lane) {
            *place = number;
        }
    }

    #[inline]
    fn zip_with(self, other: Self, op: impl Fn(f64, f64) -> f64) -> Self {
        Self(by_lane(self.0, other.0, op))
    }
}

impl Answers {
    /// Returns the answer for one lane; no beyond the last lane.
    #[inline]
    pub(crate) fn holds_in(self, lane: usize) -> bool {
        self.0.get(lane).is_some_and(|answer| *answer != 0)
    }

    /// Returns, in each lane, the first number if the answer is yes, otherwise the second.
    #[inline]
    pub(super) fn select(self, yes: Lanes, no: Lanes) -> Lanes {
        let pairs = by_lane(yes.0, no.0, |yes, no| (yes, no));
        Lanes(by_lane(self.0, pairs, |answer, (yes, no)| if answer != 0 { yes } else { no }))
    }
}

impl From<f64> for Lanes {
    #[inline]
    fn from(number: f64) -> Self {
        Self([number; LANES])
    }
}

impl From<[f64; LANES]> for Lanes {
    fn from(numbers: [f64; LANES]) -> Self {
        Self(numbers)
    }
}

macro_rules! operations {
    ($($operation:ident, $method:ident;)*) => {$(
        impl $operation for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                self.zip_with(other, f64::$method)
            }
        }

        impl $operation<f64> for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: f64) -> Self {
                self.zip_with(other.into(), f64::$method)
            }
        }
    )*};
}

operations! {
    Add, add;
    Sub, sub;
    Mul, mul;
    Div, div;
}

impl Neg for Lanes {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(f64::neg))
    }
}

impl BitAnd for Answers {
    type Output = Self;
    #[inline]
    fn bitand(self, other: Self) -> Self {
        Self(by_lane(self.0, other.0, u64::bitand))
    }
}

impl BitOr for Answers {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(by_lane(self.0, other.0, u64::bitor))
    }
}

impl Number for Lanes {
    type Answer = Answers;
    #[inline]
    fn splat(value: f64) -> Self {
        value.into()
    }
    #[inline]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        trig::atan2(self, x)
    }
    #[inline]
    fn clamped(self, low: f64, high: f64) -> Self {
        Self(self.0.map(|number| number.clamp(low, high)))
    }
    #[inline]
    fn is_less(self, other: Self) -> Answers {
        Answers(by_lane(self.0, other.0, |number, limit| if number < limit { u64::MAX } else { 0 }))
    }
    #[inline]
    fn any_reaches(self, limit: f64) -> bool {
        self.0.iter().any(|number| *number >= limit)
    }
}
