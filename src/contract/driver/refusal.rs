//! The reasons to refuse a motion, an action or a setting.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

use crate::{
    astro::{AzEl, Offset},
    control::Party,
    device::{panel::Act, settings::Hindrance},
    driver::Intent,
    name::{self, Name},
    plan::{
        Barrier,
        on_board::{NotClear, Trespass},
    },
    station::LockOut,
};

#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum Refusal {
    #[error("locked out by {operator}: {reason}")]
    LockedOut {
        #[serde(rename = "by")]
        operator: String,
        reason: String,
    },
    /// The unit is locked out, and any question would take its panel from the person who works on
    /// it.
    #[error("locked out by {operator}, whose panel a connection would take")]
    PanelLockedOut {
        #[serde(rename = "by")]
        operator: String,
    },
    /// Another program of this computer, named here, drives the unit.
    #[error("the unit is driven by {0}")]
    Elsewhere(String),
    /// No link, or no position read yet.
    #[error("the position is not known")]
    PositionUnknown,
    #[error("the last position is {0:?} old")]
    PositionOld(Duration),
    /// The current intent does not allow the request.
    #[error("not possible in {0:?}")]
    Intent(Intent),
    #[error("a fault of the unit forbids motion")]
    Fault,
    /// Azel has not read the unit's faults on this link yet.
    #[error("the faults of the unit are not known")]
    FaultsUnknown,
    #[error("the limit switch {axis}{} is set", if *plus { '+' } else { '-' })]
    Limit {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        plus: bool,
    },
    /// The value is not a number, or no motion is requested.
    #[error("no motion was asked for")]
    Nothing,
    #[error("{asked_deg_s} degrees a second is faster than {allowed_deg_s}")]
    TooFast { asked_deg_s: f64, allowed_deg_s: f64 },
    #[error("a step of {asked_deg} degrees is larger than {allowed_deg}")]
    StepTooLarge { asked_deg: f64, allowed_deg: f64 },
    /// Elevation below the lowest elevation, or beyond the zenith.
    #[error("elevation {asked_deg} is not between {lowest_deg} and 90 degrees")]
    Elevation { asked_deg: f64, lowest_deg: f64 },
    /// The controller does not support the request.
    #[error("the controller cannot do this")]
    NotOffered,
    /// The angle of an axis is unknown, so Azel could not end its motion.
    #[error("the angle of {axis} is not known")]
    AngleUnknown {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
    },
    /// Only one axis can move at a time.
    #[error("one axis at a time")]
    OneAxis,
    /// The mount cannot point to the target.
    #[error("{axis} would have to go to {asked_deg} degrees, it travels {from_deg} to {to_deg}")]
    Travel {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        asked_deg: f64,
        from_deg: f64,
        to_deg: f64,
    },
    /// The way leads into a barrier.
    #[error("{barrier:?} is in the way")]
    Forbidden {
        barrier: Barrier,
        /// Direction on the way that is inside the barrier.
        #[serde(rename = "at")]
        direction: AzEl,
    },
    /// The antenna is inside a barrier, and its way out needs the operator's permission.
    #[error("inside of {0:?}")]
    Inside(Barrier),
    /// The angle of an axis is unknown, so a motion by hand may lead into a barrier. The motion
    /// needs the operator's permission.
    #[error("the angle of {axis} is not known, so {barrier:?} may be in the way")]
    Unchecked {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        barrier: Barrier,
    },
    /// Azel could not read a safety setting. A motion by hand needs the operator's permission, and
    /// Azel refuses any other motion.
    #[error("the setting {place} could not be read")]
    SettingsUnread {
        /// Place in the station file.
        place: SmolStr,
    },
    /// Azel found no clear direction to go to.
    #[error("there is no clear direction to go to")]
    NoRefuge,
    /// Objection specific to this make.
    #[error("{0}")]
    Controller(#[serde(deserialize_with = "name::one")] Name),
    /// Only the unit knows the destination of the action, and the operator has not accepted
    /// responsibility.
    #[error("where {} leads is not known: {reason}", act.action)]
    Unseen {
        act: Act,
        /// Reason why the destination is unknown.
        #[serde(rename = "why", deserialize_with = "name::one")]
        reason: Name,
        /// The axes report their angles, so Azel can stop the antenna before a barrier.
        is_watched: bool,
    },
    /// A step needs an antenna at rest.
    #[error("the antenna still moves")]
    StillMoving,
    #[error("a stop is under way")]
    Stopping,
    /// The station is about to end.
    #[error("the station is closing")]
    Closing,
    /// This party is in control of the antenna, and the requesting program is not.
    #[error("{0:?} is in control")]
    InControl(Party),
    /// The operator has not allowed the program to point the antenna.
    #[error("the operator has not allowed it")]
    NotAllowed,
    /// The connection of the program has ended.
    #[error("the connection has ended")]
    ClientGone,
    /// No dead-man is available, so nothing would end the motion if this program ended.
    #[error("nothing would stop it if this program ended")]
    Unguarded,
    #[error("the pass is not known")]
    PassUnknown,
    /// Azel is still judging the way: the unit's own path, a path of Azel or a detour.
    #[error("the way is still being judged")]
    BeingJudged,
    /// An offset needs a track.
    #[error("nothing is tracked")]
    NoTrack,
    /// Azel has not read the offsets that the unit adds to its own track.
    #[error("the offsets of the unit are not known")]
    OffsetsUnknown,
    /// Azel could not record the unit's previous offsets on disk.
    #[error("what the unit held before could not be recorded on disk")]
    NoOffsetsRecord,
    /// An offset along or across the track needs a moving target.
    #[error("the target does not move")]
    TargetStands,
    #[error("the offset would be larger than {max:?}")]
    OffsetTooLarge {
        #[serde(rename = "most")]
        max: Offset,
    },
    /// The unit holds a satellite without known elements.
    #[error("the orbit of {name} is not known")]
    OrbitUnknown {
        /// Name that the unit reports.
        name: String,
    },
    /// The unit's tracking window is too long to check.
    #[error("the window of the unit is {hours:.0} hours long")]
    WindowTooLong { hours: f64 },
    /// The elements yield no direction at this time, so the unit's path is unknown.
    #[error("the elements give no direction at {time}")]
    NoDirection {
        #[serde(rename = "at")]
        time: Timestamp,
    },
    /// The pass does not reach the antenna's minimum elevation.
    #[error(
        "the pass reaches {highest_deg} degrees, the antenna points no lower than {lowest_deg}"
    )]
    TooLow {
        /// Maximum elevation of the pass.
        highest_deg: f64,
        /// The antenna's minimum elevation.
        lowest_deg: f64,
    },
    /// The unit's own program would lead into a barrier.
    #[error("the program of the unit leads to {0:?}")]
    Path(Trespass),
    /// A setting that decides where the antenna points cannot be written now.
    #[error("{field} is not set: {hindrance}")]
    Setting {
        #[serde(deserialize_with = "name::one")]
        field: Name,
        #[serde(rename = "why")]
        hindrance: Hindrance,
    },
}

impl From<NotClear> for Refusal {
    fn from(not_clear: NotClear) -> Self {
        match not_clear {
            NotClear::Leads(trespass) => Self::Path(trespass),
            NotClear::NoDirection(time) => Self::NoDirection { time },
        }
    }
}

impl Refusal {
    /// Returns the barrier behind the refusal, if any.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Forbidden { barrier, .. } | Self::Inside(barrier) => Some(barrier),
            _ => None,
        }
    }
}

impl From<&LockOut> for Refusal {
    fn from(LockOut { operator, reason, .. }: &LockOut) -> Self {
        Self::LockedOut { operator: operator.clone(), reason: reason.clone() }
    }
}
