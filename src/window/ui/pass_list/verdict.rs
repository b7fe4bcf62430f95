//! The verdict on a pass, in words.

use std::borrow::Cow;

use crate::{
    plan::{Loss, schedule::AntennaOff},
    ui::{
        format,
        words::{self, WayThere},
    },
};

/// Part of a pass that the selected antenna can take, and whether the schedule wants it to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict<'a> {
    /// The mount tracks the whole pass.
    Trackable,
    /// The mount loses part of the pass.
    Loses {
        /// Lost time.
        seconds: f64,
        /// Place where the loss begins.
        loss: Loss,
    },
    /// The mount tracks the whole pass, but the horizon mask blocks the beam.
    Blocked {
        /// Blocked time.
        seconds: f64,
        /// No part is clear of it.
        is_whole: bool,
    },
    /// The antenna could track it, but not before it has slewed there from where it stands.
    Way(WayThere),
    /// The mount can follow, but the unit would miss according to its own settings.
    Misses,
    /// All of the pass is out of the reach of the mount.
    OutOfReach,
    /// The pass stays below the minimum elevation of the antenna.
    TooLow,
    /// Not trackable now: the unit is in maintenance.
    InMaintenance,
    /// The antenna could track it, but the schedule leaves it out.
    LeftOut(LeftOut<'a>),
}

/// Why the schedule leaves a pass out for an antenna.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LeftOut<'a> {
    /// The pass of this satellite is taken at the same time.
    Overlaps(&'a str),
    /// No time for slew and set-up beside the pass of this satellite.
    TooClose(&'a str),
    /// This antenna takes it.
    TakenBy(&'a str),
    TooFar,
    /// The pass has begun.
    UnderWay,
    /// The operator chose so.
    Never,
    /// A limit of the satellite or of the station.
    Limit,
    /// The antenna takes no passes.
    Off(AntennaOff),
    /// No schedule with it is known to be worth more.
    WorthLess,
}

impl LeftOut<'_> {
    /// The reason alone, such as "overlaps METOP-B".
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

/// The azimuth of a keyhole, as a point of the compass where it is one.
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
    /// The verdict in words, such as "Loses 12 s at keyhole N".
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

    /// The verdict where [`Self::sentence`] has no room: the reason is what stays.
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
