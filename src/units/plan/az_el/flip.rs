//! Flip of an elevation axis that travels over the zenith. Such a mount points in every direction
//! in two ways: plain (up to 90 degrees) and flipped (beyond, with the azimuth half a turn away).

use crate::{astro::Angle, plan::Sample};

/// Part of a pass in which the axes are flipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan) enum Flip {
    /// No part: the elevation stays at or below 90 degrees.
    None,
    /// Whole pass, with the axes flipped throughout.
    Whole,
    /// Part from the highest point of the pass onwards: the elevation continues over the zenith.
    FromTop,
    /// Part until the highest point of the pass: the elevation comes back over the zenith.
    UntilTop,
}

/// Freedom in the choice of a flip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan) enum FlipChoice {
    /// Preference for this flip, unless another is clearly better.
    Prefer(Flip),
    /// Restriction to this flip, even if another is better.
    Keep(Flip),
}

impl Flip {
    /// Returns for each sample whether the axes are flipped.
    pub(super) fn flipped(self, samples: &[Sample]) -> Vec<bool> {
        let elevation = |(_, sample): &(usize, &Sample)| sample.direction.elevation_deg();
        let highest =
            samples.iter().enumerate().max_by(|a, b| elevation(a).total_cmp(&elevation(b)));
        let top = highest.map_or(0, |(top, _)| top);
        let is_flipped = |index: usize| match self {
            Self::None => false,
            Self::Whole => true,
            // If the pass is highest at the first sample, the axes have already changed over.
            Self::FromTop => index > top || top == 0,
            Self::UntilTop => index <= top && top > 0,
        };
        (0..samples.len()).map(is_flipped).collect()
    }
}

/// Returns the positions of the azimuth axis for the samples, degrees without jumps: each is the
/// short way from the previous one.
pub(super) fn azimuths_deg(samples: &[Sample], flipped: &[bool]) -> Vec<f64> {
    let mut before: Option<Angle> = None;
    let azimuth = |(sample, is_flipped): (&Sample, &bool)| {
        let side = Angle::from_degrees(if *is_flipped { 180.0 } else { 0.0 });
        let azimuth = sample.direction.azimuth + side;
        let unwrapped = before.map_or(azimuth, |before| before + (azimuth - before).wrapped_180());
        before = Some(unwrapped);
        unwrapped.degrees()
    };
    samples.iter().zip(flipped).map(azimuth).collect()
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::astro::AzEl;

    #[test]
    fn what_is_left_of_a_pass_stays_on_the_side_to_which_it_has_changed() {
        let pass: Vec<Sample> = [20.0, 60.0, 85.0, 50.0, 10.0]
            .map(|elevation_deg| Sample {
                time: Timestamp::UNIX_EPOCH,
                direction: AzEl::from_degrees(40.0, elevation_deg),
            })
            .into();
        assert_eq!(Flip::FromTop.flipped(&pass), [false, false, false, true, true]);
        assert_eq!(Flip::UntilTop.flipped(&pass), [true, true, true, false, false]);
        let rest = pass.get(3..).unwrap();
        assert_eq!(Flip::FromTop.flipped(rest), Flip::Whole.flipped(rest));
        assert_eq!(Flip::UntilTop.flipped(rest), Flip::None.flipped(rest));
    }
}
