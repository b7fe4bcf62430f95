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
            Self::Over => index > top,
            Self::Back => index <= top,
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
