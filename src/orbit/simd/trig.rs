//! Sine, cosine and the angle of a direction, several at once. The code has no branches, so that
//! all lanes take the same path.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use super::{Lanes, Number, series};

/// A turn in two parts. The first has so few digits that its multiples are not rounded.
const TURN_HIGH: f64 = 4.0 * 1.570_796_326_734_125_6;
const TURN_LOW: f64 = 4.0 * 6.077_100_506_506_192e-11;
/// Reciprocal of the tangent of a sixteenth of a turn.
const STEEP: f64 = 1.0 + std::f64::consts::SQRT_2;

/// Returns sine and cosine, doubled twice from those of a quarter of the angle, for which the power
/// series are short.
#[inline(always)]
pub(super) fn sin_cos<N: Number>(angle: N) -> (N, N) {
    let turns = (angle * (1.0 / TAU)).nearest();
    let quarter = (angle - turns * TURN_HIGH - turns * TURN_LOW) * 0.25;
    let square = quarter * quarter;
    let sine = quarter + quarter * square * series(&SINE, square);
    // The value 1 - cosine keeps the digits that the doubling would lose.
    let less = square * (square * series(&COSINE, square) + 0.5);
    let double_sine = sine * (-less + 1.0) * 2.0;
    let double_less = sine * sine * 2.0;
    let sine = double_sine * (-double_less + 1.0) * 2.0;
    let cosine = -(double_sine * double_sine * 2.0) + 1.0;
    (sine, cosine)
}

/// Returns the angle of the direction (`x`, `y`). It is the angle from the nearest axis or line
/// midway between two axes, plus the angle of that axis or line. The first part is at most a
/// sixteenth of a turn.
#[inline(always)]
pub(super) fn atan2(y: Lanes, x: Lanes) -> Lanes {
    let (width, height) = (x.abs(), y.abs());
    let is_upright = width.is_less(height);
    let less = is_upright.select(width, height);
    // The addition gives the zero vector the angle 0.
    let more = is_upright.select(height, width) + f64::MIN_POSITIVE;
    let is_midway = more.is_less(less * STEEP);
    let tangent = is_midway.select(less - more, less) / is_midway.select(less + more, more);
    let square = tangent * tangent;
    let from_nearest = tangent + tangent * square * series(&TANGENT, square);
    let angle = from_nearest + is_midway.select(Lanes::splat(FRAC_PI_4), Lanes::ZERO);
    let angle = is_upright.select(-angle + FRAC_PI_2, angle);
    let angle = x.is_less(Lanes::ZERO).select(-angle + PI, angle);
    y.is_less(Lanes::ZERO).select(-angle, angle)
}

/// Polynomials that interpolate (sin x / x - 1) / x² and ((1 - cos x) / x² - 1/2) / x², by powers
/// of x², at the Chebyshev nodes from 0 to an eighth of a turn; accurate to 2e-14.
const SINE: [f64; 5] = [
    -0.166_666_666_666_638_86,
    0.008_333_333_331_079_223,
    -0.000_198_412_669_169_859_66,
    2.755_599_092_956_532e-6,
    -2.480_563_624_183_476_3e-8,
];
const COSINE: [f64; 5] = [
    -0.041_666_666_666_664_68,
    0.001_388_888_888_727_734_3,
    -0.000_024_801_585_210_990_516,
    2.755_636_969_557_300_6e-7,
    -2.070_060_048_343_311_8e-9,
];

/// Polynomial that interpolates (arctan x / x - 1) / x², by powers of x², at the Chebyshev nodes
/// from 0 to the tangent of a sixteenth of a turn; accurate to 4e-11.
const TANGENT: [f64; 6] = [
    -0.333_333_332_792_548,
    0.199_999_772_586_883_86,
    -0.142_841_511_936_286_14,
    0.110_713_650_218_847_94,
    -0.086_246_761_452_494_94,
    0.050_481_385_120_797_444,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_right_in_every_lane() {
        for step in -20_000..20_000 {
            let angles = [0.001, 0.37, 7.3, 50.0, 0.002, 0.74, 14.6, 25.0]
                .map(|scale| f64::from(step) * scale);
            let (sines, cosines) = sin_cos(Lanes::from(angles));
            for (lane, angle) in angles.iter().enumerate() {
                let (sine, cosine) = angle.sin_cos();
                assert!((sines.as_array()[lane] - sine).abs() < 1e-13, "{angle}");
                assert!((cosines.as_array()[lane] - cosine).abs() < 1e-13, "{angle}");
            }
        }
        let odd = [f64::NAN, f64::INFINITY, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let (sine, cosine) = sin_cos(Lanes::from(odd));
        assert!(sine.as_array()[..2].iter().all(|sine| sine.is_nan()));
        assert_eq!((sine.as_array()[2], cosine.as_array()[2]), (0.0, 1.0));
    }

    #[test]
    fn the_angle_is_that_of_the_direction() {
        for step in -50_000..=50_000 {
            let angle = f64::from(step) * (PI / 50_000.0);
            let lengths = [1e-9, 0.01, 0.7, 1.0, 3.0, 42_164.0, 1e9, 1e200];
            let y = Lanes::from(lengths.map(|length| length * angle.sin()));
            let x = Lanes::from(lengths.map(|length| length * angle.cos()));
            for (lane, found) in atan2(y, x).as_array().iter().enumerate() {
                let expected = y.as_array()[lane].atan2(x.as_array()[lane]);
                assert!((found - expected).abs() < 5e-11, "{angle} {found}");
            }
        }
        let y = Lanes::from([0.0, 0.0, 0.0, 1.0, -1.0, f64::NAN, 1.0, 0.0]);
        let x = Lanes::from([0.0, 1.0, -1.0, 0.0, 0.0, 1.0, f64::NAN, 2.0]);
        let found = atan2(y, x);
        assert_eq!(found.as_array()[..5], [0.0, 0.0, PI, FRAC_PI_2, -FRAC_PI_2]);
        assert!(found.as_array()[5].is_nan() && found.as_array()[6].is_nan());
    }
}
