//! The interface between a controller of any make and the rest of the program: its state,
//! its settings and its commands.
//!
//! Invariant: a [`Controller`] can start motion, so only the driver's gate holds one. All other
//! code uses its [`Device`] side.

mod calibration;
mod capabilities;
mod element_files;
mod on_board;
pub mod panel;
pub mod settings;
mod state;
mod variant;
pub(crate) mod wire;

use std::{borrow::Cow, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

pub use calibration::{CalibrationError, CountLine, CountPoint};
pub use capabilities::{Capabilities, Effect, JogSpeed, JogSpeeds, SecondAxis, Standstill};
pub use element_files::ElementFiles;
pub use on_board::{
    HeldSatellite, LONGEST_WINDOW_S, Offsets, OnBoard, Place, TrackOffsetFields, UnitClock,
};
pub use state::{
    AntennaState, Axis, AxisMotion, Drive, LastSatellite, Measured, Phase, Pointing, Program,
    Traffic,
};
pub use variant::{ClockSetting, Variant};
pub use wire::{Direction, Explained, ExplainedValue, Finding, Meaning, WireLine};

use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    name::{self, Name},
};
use panel::{Act, Lead};
use settings::{Change, WriteError};

/// Time limit for a reply while the antenna moves.
pub const PROMPT: Duration = Duration::from_millis(600);
/// Default of [`Device::patience`].
const PATIENCE: Duration = Duration::from_secs(5);
/// Default of [`Device::poll_period`]. A controller asks for the position at least twice a
/// second, because motion by hand needs a position younger than a second.
const LONGEST_POLL_PERIOD: Duration = Duration::from_millis(500);

/// A motion that Azel can request from a controller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Rotation of both axes at these rates until stopped; degrees a second.
    Jog {
        /// Signed rate of the first axis.
        x_deg_s: f64,
        /// Signed rate of the second axis.
        y_deg_s: f64,
    },
    /// Rotation of both axes by these angles; degrees.
    Step {
        /// Signed angle of the first axis.
        x_deg: f64,
        /// Signed angle of the second axis.
        y_deg: f64,
    },
    /// Move to a direction. `None` leaves that axis at its current angle, which over the zenith
    /// differs from its current direction.
    Position {
        /// Azimuth. On a mount whose azimuth axis turns by more than 360 degrees, the position of
        /// that axis: 370 is not 10.
        azimuth: Option<Angle>,
        /// Elevation. On a mount whose elevation axis travels over the zenith, the position of that
        /// axis: 120 points up 60 degrees on the other side.
        elevation: Option<Angle>,
    },
    /// Start of the on-board track of the target that the unit holds.
    StartProgram,
    /// Auto-track: the unit starts to track whenever its target is due.
    EnableAuto,
}

/// A request to move; events report its outcome.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum MotionRequest {
    /// A motion started with [`Controller::start`].
    Motion(Motion),
    /// An action requested with [`Controller::act`]: the key of one of [`Variant::actions`].
    Action(#[serde(deserialize_with = "name::one")] Name),
}

impl From<Motion> for MotionRequest {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}

/// A target for on-board track.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrackTarget {
    /// Catalog number of up to nine digits.
    pub catalog_number: u32,
    /// Name as in the elements.
    pub name: String,
    /// Element file that contains the satellite; `None` for the configured file.
    #[serde(default)]
    pub element_file: Option<String>,
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
}

/// A question that the operator may ask a unit by hand. The question changes nothing on the unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Question {
    /// Text as typed, in capitals, such as `STATUS?`.
    pub key: SmolStr,
    /// Subject of the question, as a sentence without a full stop.
    #[serde(rename = "about")]
    pub subject: Cow<'static, str>,
    /// Bytes to send over the link.
    pub bytes: Box<[u8]>,
}

/// Scope of a halt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Current motion only.
    Motion,
    /// Current motion and on-board track, even if the track is known to be off.
    Track,
    /// Current motion, on-board track and auto-track.
    Everything,
}

/// Outcome of a request to a unit.
#[derive(Debug, Clone, PartialEq)]
pub enum ControllerEvent {
    /// The target that was sent and read back.
    Prepared(TrackTarget),
    /// The target that the unit does not hold, with the reason.
    NotPrepared(TrackTarget, PrepareError),
    /// A command that the unit accepted; its state shows whether it moves.
    Accepted(MotionRequest),
    /// A command that the unit refused with this answer.
    Refused(MotionRequest, String),
    /// A command without an answer. Azel does not send it again; the state shows what happened.
    Unanswered(MotionRequest),
    /// The answer with which the unit refused a halt.
    HaltRefused(String),
    /// Auto-track that the unit refused to switch off, or did not answer about.
    AutoStaysOn,
}

/// Reason why the unit does not hold the target.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum PrepareError {
    /// A name, file or time that the protocol cannot carry.
    #[error("cannot be sent: {0}")]
    CannotBeSent(String),
    #[error("the unit answered {0}")]
    Refused(String),
    /// A missing answer to a setting.
    #[error("no answer")]
    Unanswered,
    /// A read-back that differs from the target.
    #[error("holds {current}")]
    Differs {
        /// Target that the unit holds now.
        #[serde(rename = "held")]
        current: String,
    },
    /// A satellite whose elements the unit does not have.
    #[error("no elements in {file}")]
    NotOnDevice {
        /// The element file that was searched.
        file: String,
    },
    /// A missing element file: neither the unit nor the settings name a file.
    #[error("no element file is named")]
    NoElementFile,
    /// A halt during the preparation.
    #[error("stopped")]
    Stopped,
}

/// The side of a controller that all code may use: no method starts a motion or decides where a
/// motion leads. A method with a default is for a feature that only some makes have, or returns the
/// default value.
///
/// The controller repeats an unanswered position question. The position then counts as requested at
/// the time of the first unanswered question. The reply to a halt is never used as a position.
pub trait Device: Send {
    /// Handles a new link: forgets all outstanding requests, halts included, and asks all questions
    /// again.
    fn link_up(&mut self, now: Moment);

    /// Handles a lost link: no outstanding request will be answered. [`Self::link_up`] forgets the
    /// requests that the controller keeps.
    fn link_down(&mut self, _now: Moment) {}

    /// Records written bytes for [`Self::next_wire_line`].
    fn sent(&mut self, _bytes: &[u8], _now: Moment) {}

    /// Returns the oldest line of the link that was not returned yet.
    fn next_wire_line(&mut self) -> Option<WireLine> {
        None
    }

    /// Takes received bytes. Any bytes are harmless.
    fn receive(&mut self, bytes: &[u8], now: Moment);

    /// Returns the bytes to send now, if a request is due.
    fn poll(&mut self, now: Moment) -> Option<Vec<u8>>;

    /// Returns the latest time for the next call of [`Self::poll`].
    fn due(&self, now: Moment) -> Instant;

    /// Returns the bytes that stop all motion and end on-board track, and drops pending motions.
    /// The caller writes them immediately, ahead of all other bytes. [`Extent::Motion`] leaves an
    /// on-board track that is known to be off unchanged; [`Extent::Everything`] also switches
    /// auto-track off.
    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8>;

    /// Ends every permission with a time limit, because the operator has pressed STOP.
    fn disarm(&mut self) {}

    /// Returns the time after which Azel sends an unproved halt again. A state that was requested
    /// after the halt arrives within this time.
    fn halt_patience(&self) -> Duration {
        Duration::from_secs(1)
    }

    /// Asks for the position immediately. This is for makes whose [`Self::poll_period`] can be
    /// long.
    fn ask_position(&mut self, _now: Moment) {}

    /// Sets whether Azel has the antenna moving. If so, the controller immediately asks again for a
    /// position that does not arrive within [`Self::prompt`], and a slower reply delays no position
    /// question. There is no default, because the second question decides whether the unit counts
    /// as silent.
    fn watch_closely(&mut self, is_watched: bool);

    /// Returns the max time that a reply takes in normal operation.
    fn prompt(&self) -> Duration {
        PROMPT
    }

    /// Reads the group with this key again; the result appears in [`AntennaState::groups`]. Azel
    /// calls this method and the others about settings only with [`Variant::groups`].
    fn read_group(&mut self, _group: &str) {}

    /// Records a change that is not sent, with the reason, in [`AntennaState::groups`].
    fn refuse_change(&mut self, _change: Change, _why: WriteError, _now: Moment) {}

    /// Locks or unlocks the settings. While they are locked, pending changes end with
    /// [`LockedOut`](settings::WriteError::LockedOut), and the gate passes no new change.
    fn lock_changes(&mut self, _are_locked: bool) {}

    /// Asks one of [`AntennaState::questions`], by its key, between the controller's own questions.
    /// Ignores an unknown key.
    fn ask(&mut self, _question: &str) {}

    /// Switches auto-track off: the unit no longer starts to track unattended.
    fn disable_auto(&mut self) {}

    /// Returns `true` while a motion is queued, or sent and not answered. There is no default:
    /// after a wrong `false`, Azel would send the next motion into this one.
    fn motion_under_way(&self) -> bool;

    /// Returns the motion as the unit takes it, for example rounded to whole degrees.
    fn as_sent(&self, motion: Motion) -> Motion {
        motion
    }

    /// Returns the last known state.
    fn state(&self) -> &AntennaState;

    /// Returns the oldest outcome of earlier requests that was not returned yet. There is no
    /// default, because only this method reports refused and unanswered motions.
    fn next_event(&mut self) -> Option<ControllerEvent>;

    /// Returns the time without a good reply after which the link counts as lost.
    fn patience(&self) -> Duration {
        PATIENCE
    }

    /// Returns the current time between two position questions. It determines how far ahead of the
    /// last position Azel judges a jog, and when a link counts as stale.
    fn poll_period(&self) -> Duration {
        LONGEST_POLL_PERIOD
    }
}

/// The side of a controller that can move the antenna or decide where it goes. Only the gate has
/// access to it.
pub trait Controller: Device {
    /// Returns a reason of this make not to start the motion or continue it. The gate calls this
    /// method after its own rules, and again while a jog runs.
    fn objection(&self, _asked: &MotionRequest, _now: Moment) -> Option<&'static str> {
        None
    }

    /// Returns where an action leads the axes. By default, the operator is responsible for it.
    fn lead_of(&self, _act: &Act) -> Lead {
        Lead::Unseen("its make does not tell where it leads")
    }

    /// Puts a target on the unit without moving the antenna. A [`ControllerEvent`] reports the
    /// outcome. Azel calls this method only with [`Capabilities::has_program`].
    fn prepare(&mut self, _target: TrackTarget) {}

    /// Writes new values of a group to the unit and reads them back. Progress and outcome appear in
    /// [`AntennaState::groups`].
    fn write_settings(&mut self, _change: Change, _now: Moment) {}

    /// Writes offsets of the track that the unit computes, also while it tracks, and reads them
    /// back. Progress and outcome appear in [`AntennaState::groups`]; a halt drops offsets that are
    /// not sent yet. Azel calls this method only with [`Variant::track_offsets`].
    fn shift_track(&mut self, _change: Change, _now: Moment) {}

    /// Queues a motion. The controller sends it once, or not at all if a halt comes first. Without
    /// a link, the controller refuses the motion, or forgets it when the link comes up. The gate
    /// passes no motion that [`Variant::capabilities`] exclude; the controller refuses such a
    /// motion with a [`ControllerEvent`].
    fn start(&mut self, motion: Motion);

    /// Queues an action that only this make has. Azel calls this method only with
    /// [`Variant::actions`].
    fn act(&mut self, _act: Act) {}
}

/// Returns the direction at which a motion aims. An angle that is `None` stays as measured.
pub fn aimed(
    azimuth: Option<Angle>,
    elevation: Option<Angle>,
    measured: Option<Pointing>,
) -> Pointing {
    Pointing {
        azimuth: azimuth.or(measured.and_then(|measured| measured.azimuth)),
        elevation: elevation.or(measured.and_then(|measured| measured.elevation)),
    }
}
