//! The verdict on a pass, in words.

use std::borrow::Cow;

use crate::{
    plan::{Loss, schedule::AntennaOff},
    ui::{
        format,
        words::{self, WayThere},
    },
};

/// The part of a pass that the selected antenna can track, and its place in the schedule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict<'a> {
    /// A pass that the mount tracks completely.
    Trackable,
    /// A pass of which the mount loses a part.
    Loses {
        /// Lost time, seconds.
        seconds: f64,
        /// Place where the loss begins.
        loss: Loss,
    },
    /// A pass that the mount tracks completely, but the horizon mask blocks the beam.
    Blocked {
        /// Blocked time, seconds.
        seconds: f64,
        /// `true` if no part of the pass is clear of the mask.
        is_whole: bool,
    },
    /// A pass that the antenna could track, but not before it has slewed there from its current
    /// position.
    Way(WayThere),
    /// A pass that the mount could track, but the unit would miss because of its own settings.
    Misses,
    /// A pass that lies completely out of reach of the mount.
    OutOfReach,
    /// A pass that stays below the minimum elevation of the antenna.
    TooLow,
    /// A pass that the antenna cannot track now because its unit is in maintenance.
    InMaintenance,
    /// A pass that the antenna could track, but the schedule leaves out.
    LeftOut(LeftOut<'a>),
}

/// Reason why the schedule leaves a pass out for an antenna.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LeftOut<'a> {
    /// Overlap with a pass of this satellite that the schedule takes.
    Overlaps(&'a str),
    /// Too little time to slew and set up between this pass and the pass of this satellite.
    TooClose(&'a str),
    /// Antenna that takes the pass.
    TakenBy(&'a str),
    TooFar,
    /// A pass that has begun.
    UnderWay,
    /// Exclusion by the operator.
    Never,
    /// Exclusion by a limit of the satellite or of the station.
    Limit,
    /// An antenna that takes no passes.
    Off(AntennaOff),
    /// A pass that adds no worth to any known schedule.
    WorthLess,
}

impl LeftOut<'_> {
    /// Returns only the reason, such as "overlaps METOP-B".
    fn reason(self) -> Cow<'static, str> {
        match self {
            Self::Overlaps(name) => format!("overlaps {name}").into(),
            Self::TooClose(name) => format!("close to {name}").into(),
            Self::TakenBy(name) => format!("{name} takes it").into(),
            Self::TooFar => "not there at AOS".into(),
            Self::UnderWay => "under way".into(),
            Self::Never => "as you chose".into(),
            Self::Limit => "a limit".into(),
            Self::Off(AntennaOff::LockedOut) => "in maintenance".into(),
            Self::Off(AntennaOff::SwitchedOff) => "not connected".into(),
            Self::WorthLess => "worth less".into(),
        }
    }
}

/// Formats the azimuth of a keyhole, as a compass point where it matches one.
fn text_towards(degrees: f64) -> String {
    match degrees.round() as i32 % 360 {
        0 => "N".to_owned(),
        90 => "E".to_owned(),
        180 => "S".to_owned(),
        270 => "W".to_owned(),
        _ => format::azimuth(degrees),
    }
}

impl Verdict<'_> {
    /// Returns the verdict in words, such as "Loses 12 s at keyhole N".
    pub(super) fn sentence(self) -> Cow<'static, str> {
        match self {
            Self::Trackable => "Trackable".into(),
            Self::Blocked { is_whole: true, .. } => "Never clear of the mask".into(),
            Self::Blocked { seconds, .. } => {
                format!("Blocked by the mask for {}", format::duration(seconds)).into()
            }
            Self::Misses => "The unit would miss it".into(),
            Self::OutOfReach => "Out of the mount's reach".into(),
            Self::TooLow => "Below the antenna's minimum elevation".into(),
            Self::InMaintenance => "In maintenance".into(),
            Self::Way(way) => words::capitalised(&way.words()).into(),
            Self::LeftOut(reason) => format!("Left out: {}", reason.reason()).into(),
            Self::Loses { seconds, loss } => {
                let lost = format::age(seconds.ceil());
                match loss {
                    Loss::Keyhole(azimuth) => {
                        format!("Loses {lost} at keyhole {}", text_towards(azimuth.degrees()))
                    }
                    Loss::Overhead => format!("Loses {lost} overhead"),
                    Loss::Slew => format!("Loses {lost} at the azimuth unwrap"),
                    Loss::BeyondAzimuth(end) => {
                        format!("Loses {lost} beyond azimuth {}", format::azimuth(end.degrees()))
                    }
                    Loss::OutOfReach => format!("Loses {lost} out of reach"),
                }
                .into()
            }
        }
    }

    /// Returns a shorter verdict for places without room for [`Self::sentence`]. It keeps the
    /// reason.
    pub(super) fn short(self) -> Cow<'static, str> {
        match self {
            Self::Blocked { is_whole: true, .. } => "Mask blocks it".into(),
            Self::Blocked { seconds, .. } => {
                format!("Mask blocks {}", format::duration(seconds)).into()
            }
            Self::OutOfReach => "Out of reach".into(),
            Self::TooLow => "Stays too low".into(),
            Self::Way(way) => words::capitalised(&way.short()).into(),
            Self::LeftOut(reason) => words::capitalised(&reason.reason()).into(),
            Self::Loses { seconds, loss } => {
                let lost = format::age(seconds.ceil());
                match loss {
                    Loss::Keyhole(azimuth) => {
                        format!("{lost}: keyhole {}", text_towards(azimuth.degrees()))
                    }
                    Loss::Overhead => format!("{lost} overhead"),
                    Loss::Slew => format!("{lost} unwrapping"),
                    Loss::BeyondAzimuth(end) => {
                        format!("{lost} beyond {}", format::azimuth(end.degrees()))
                    }
                    Loss::OutOfReach => format!("{lost} out of reach"),
                }
                .into()
            }
            Self::Misses => "Would miss it".into(),
            Self::Trackable | Self::InMaintenance => self.sentence(),
        }
    }
}
