//! The reasons why a motion, an action or a setting is not sent.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::{
    astro::AzEl,
    device::{panel::Act, settings::Hindrance},
    driver::Intent,
    name::{self, Name},
    plan::{Barrier, on_board::Trespass},
    station::LockOut,
};

/// Why a motion was not sent.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum Refusal {
    /// The unit is locked out for maintenance.
    #[error("locked out by {by}: {reason}")]
    LockedOut {
        /// By whom.
        by: String,
        /// Why.
        reason: String,
    },
    /// The unit is locked out, and whatever is asked of it would take its panel from
    /// who works on it.
    #[error("locked out by {by}, whose panel a connection would take")]
    PanelLockedOut {
        /// By whom.
        by: String,
    },
    /// Another program of this computer drives the unit; which, in words.
    #[error("the unit is driven by {0}")]
    Elsewhere(String),
    /// No link, or nothing was read yet.
    #[error("the position is not known")]
    PositionUnknown,
    /// The last position is too old to move by.
    #[error("the last position is {0:?} old")]
    PositionOld(Duration),
    /// The present intent does not allow it.
    #[error("not possible in {0:?}")]
    Intent(Intent),
    /// A fault forbids motion.
    #[error("a fault of the unit forbids motion")]
    Fault,
    /// The unit was not asked for its faults on this link yet.
    #[error("the faults of the unit are not known")]
    FaultsUnknown,
    /// The limit switch in that direction is set.
    #[error("the limit switch {axis}{} is set", if *plus { '+' } else { '-' })]
    Limit {
        /// Name of the axis.
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        /// Which end.
        plus: bool,
    },
    /// Not a number, or no motion at all.
    #[error("no motion was asked for")]
    Nothing,
    /// Faster than allowed.
    #[error("{asked_deg_s} degrees a second is faster than {allowed_deg_s}")]
    TooFast {
        /// Asked for.
        asked_deg_s: f64,
        /// Allowed.
        allowed_deg_s: f64,
    },
    /// A larger step than allowed.
    #[error("a step of {asked_deg} degrees is larger than {allowed_deg}")]
    StepTooLarge {
        /// Asked for.
        asked_deg: f64,
        /// Allowed.
        allowed_deg: f64,
    },
    /// Below the lowest elevation, or beyond the zenith.
    #[error("elevation {asked_deg} is not between {lowest_deg} and 90 degrees")]
    Elevation {
        /// Asked for.
        asked_deg: f64,
        /// Lowest allowed.
        lowest_deg: f64,
    },
    /// The controller cannot do this.
    #[error("the controller cannot do this")]
    NotOffered,
    /// The angle of an axis is not known, so nothing would end its motion.
    #[error("the angle of {axis} is not known")]
    AngleUnknown {
        /// Name of the axis.
        #[serde(deserialize_with = "name::one")]
        axis: Name,
    },
    /// One axis at a time.
    #[error("one axis at a time")]
    OneAxis,
    /// The mount cannot point there.
    #[error("{axis} would have to go to {asked_deg} degrees, it travels {from_deg} to {to_deg}")]
    Travel {
        /// Name of the axis.
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        /// Where it would have to go.
        asked_deg: f64,
        /// Lower end of its travel.
        from_deg: f64,
        /// Upper end of its travel.
        to_deg: f64,
    },
    /// The way leads into what is forbidden.
    #[error("{barrier:?} is in the way")]
    Forbidden {
        /// What it is.
        barrier: Barrier,
        /// A direction in it on the way.
        at: AzEl,
    },
    /// It is inside of what is forbidden, and the way out waits for the operator's
    /// word.
    #[error("inside of {0:?}")]
    Inside(Barrier),
    /// No clear direction was found that it could go to.
    #[error("there is no clear direction to go to")]
    NoRefuge,
    /// What is special to this controller speaks against it.
    #[error("{0}")]
    Controller(#[serde(deserialize_with = "name::one")] Name),
    /// Where an action leads is known to the unit alone, and the operator has not
    /// answered for it.
    #[error("where {} leads is not known: {why}", act.action)]
    Unseen {
        /// What was asked for.
        act: Act,
        /// Why it is not known.
        #[serde(deserialize_with = "name::one")]
        why: Name,
        /// Whether its axes tell where they stand, so that it is stopped before what is
        /// forbidden.
        is_watched: bool,
    },
    /// A step needs an antenna that stands.
    #[error("the antenna still moves")]
    StillMoving,
    /// A stop is under way.
    #[error("a stop is under way")]
    Stopping,
    /// No dead-man can be had, so nothing would end it if this program ended.
    #[error("nothing would stop it if this program ended")]
    Unguarded,
    /// The pass that the unit is to track by itself is not known.
    #[error("the pass is not known")]
    PassUnknown,
    /// The unit holds a satellite whose elements are not known here.
    #[error("the orbit of {name} is not known")]
    OrbitUnknown {
        /// Its name, as the unit tells it.
        name: String,
    },
    /// The pass does not get up to where the antenna may point.
    #[error(
        "the pass reaches {highest_deg} degrees, the antenna points no lower than {lowest_deg}"
    )]
    TooLow {
        /// Its greatest elevation.
        highest_deg: f64,
        /// The lowest elevation of the antenna.
        lowest_deg: f64,
    },
    /// The unit's own program would lead where the antenna must not point.
    #[error("the program of the unit leads to {0:?}")]
    Path(Trespass),
    /// A setting that decides where the antenna points, at a bad time.
    #[error("{field} is not set: {why}")]
    Setting {
        /// Its label.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        /// Why not now.
        why: Hindrance,
    },
}

impl Refusal {
    /// Where the antenna must not point, where that is why.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Forbidden { barrier, .. } | Self::Inside(barrier) => Some(barrier),
            _ => None,
        }
    }
}

impl From<&LockOut> for Refusal {
    fn from(LockOut { by, reason, .. }: &LockOut) -> Self {
        Self::LockedOut { by: by.clone(), reason: reason.clone() }
    }
}
