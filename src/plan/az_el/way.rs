//! The two sides on which the axes of an antenna point to a direction, and when
//! they change from one to the other.

use crate::{astro::Angle, plan::Sample};

/// How the axes point along a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan) enum Way {
    /// As they count: the elevation up to 90 degrees.
    Plain,
    /// Tipped over the zenith, the azimuth on the other side.
    Flipped,
    /// Plain until the pass is highest, then on over the zenith.
    Over,
    /// Tipped over until the pass is highest, then back over the zenith.
    Back,
}

/// How free the choice of a way is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan) enum Choice {
    /// This one unless another is clearly better.
    Prefer(Way),
    /// This one.
    Keep(Way),
}

impl Way {
    /// For each sample, whether the axes are tipped over.
    pub(super) fn tipped(self, samples: &[Sample]) -> Vec<bool> {
        let elevation = |(_, sample): &(usize, &Sample)| sample.direction.elevation_deg();
        let highest =
            samples.iter().enumerate().max_by(|a, b| elevation(a).total_cmp(&elevation(b)));
        let top = highest.map_or(0, |(top, _)| top);
        let is_tipped = |index: usize| match self {
            Self::Plain => false,
            Self::Flipped => true,
            // A pass that is highest where the samples begin has changed already.
            Self::Over => index > top || top == 0,
            Self::Back => index <= top && top > 0,
        };
        (0..samples.len()).map(is_tipped).collect()
    }
}

/// Where the azimuth axis points to the samples, degrees without jumps: each one
/// the short way from the one before.
pub(super) fn azimuths_deg(samples: &[Sample], tipped: &[bool]) -> Vec<f64> {
    let mut before: Option<Angle> = None;
    let azimuth = |(sample, is_tipped): (&Sample, &bool)| {
        let side = Angle::from_degrees(if *is_tipped { 180.0 } else { 0.0 });
        let azimuth = sample.direction.azimuth + side;
        let at = before.map_or(azimuth, |before| before + (azimuth - before).wrapped_180());
        before = Some(at);
        at.degrees()
    };
    samples.iter().zip(tipped).map(azimuth).collect()
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
        assert_eq!(Way::Over.tipped(&pass), [false, false, false, true, true]);
        assert_eq!(Way::Back.tipped(&pass), [true, true, true, false, false]);
        let rest = pass.get(3..).unwrap();
        assert_eq!(Way::Over.tipped(rest), Way::Flipped.tipped(rest));
        assert_eq!(Way::Back.tipped(rest), Way::Plain.tipped(rest));
    }
}
