//! How much of a pass an antenna can follow.

mod az_el;
mod xy;

use jiff::Timestamp;

use crate::{
    astro::{Angle, AzEl},
    station::Mount,
};

/// A direction at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// When.
    pub time: Timestamp,
    /// Where.
    pub direction: AzEl,
}

/// Travel and rate of a mount, and the beam it has to keep on a satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MountLimits {
    /// How its axes are arranged.
    pub mount: Mount,
    /// Fastest rate of an axis, degrees a second.
    pub maximum_rate_deg_s: f64,
    /// A direction that is off by less is within the beam.
    pub half_beam: Angle,
    /// It turns both angles; else only the azimuth counts.
    pub has_elevation: bool,
}

/// How much of a pass an antenna can follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trackability {
    /// All of it.
    Whole,
    /// All but some seconds.
    Loses {
        /// For how long the satellite is not in the beam, seconds.
        seconds: f64,
        /// Where that begins.
        at: Loss,
    },
    /// None of it.
    Nothing,
}

/// Where an antenna loses a satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loss {
    /// Near an end of the lower axis of an X/Y mount, at this azimuth.
    Keyhole(Angle),
    /// So high that the azimuth axis would have to turn too fast.
    Overhead,
    /// At an end of the azimuth axis, which has to go all the way round.
    Slew,
    /// Where no position of the axes points.
    OutOfReach,
}

/// How much of the pass along `samples` an antenna follows. Samples are a few
/// seconds apart, oldest first; the antenna waits at the first of them.
pub fn trackability(samples: &[Sample], limits: MountLimits) -> Trackability {
    match limits.mount {
        Mount::Xy { .. } => xy::trackability(samples, limits),
        Mount::AzEl { .. } => az_el::trackability(samples, limits),
    }
}

impl Trackability {
    /// What a loss of `lost_s` seconds of `whole_s` comes to.
    fn of(lost_s: f64, whole_s: f64, at: Loss) -> Self {
        if lost_s <= 0.0 {
            Self::Whole
        } else if lost_s >= whole_s {
            Self::Nothing
        } else {
            Self::Loses { seconds: lost_s, at }
        }
    }
}
