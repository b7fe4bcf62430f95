//! The interface between a controller of any make and the rest of the program: its state,
//! its settings and its commands.
//!
//! Invariant: a [`Controller`] can start motion, so only the driver's gate holds one; everyone
//! else sees its [`Device`] side.

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

/// While the antenna moves, a reply counts as missing after this time.
pub const PROMPT: Duration = Duration::from_millis(600);
/// Default of [`Device::patience`].
const PATIENCE: Duration = Duration::from_secs(5);
/// Default of [`Device::poll_period`]. A controller asks for the position at least twice a
/// second, because motion by hand needs a position younger than a second.
const LONGEST_POLL_PERIOD: Duration = Duration::from_millis(500);

/// A motion that a controller can be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Both axes turn at these rates until stopped; degrees a second.
    Jog {
        /// First axis, signed.
        x_deg_s: f64,
        /// Second axis, signed.
        y_deg_s: f64,
    },
    /// Both axes turn by this much; degrees.
    Step {
        /// First axis, signed.
        x_deg: f64,
        /// Second axis, signed.
        y_deg: f64,
    },
    /// To a direction. `None` leaves that axis at its present angle, not at its present
    /// direction: over the zenith the two differ.
    Position {
        /// Azimuth. On a mount whose azimuth axis turns by more than a turn it is
        /// the position of that axis: 370 is not 10.
        azimuth: Option<Angle>,
        /// Elevation. On a mount whose elevation axis travels over the zenith it is
        /// the position of that axis: 120 points up 60 degrees on the other side.
        elevation: Option<Angle>,
    },
    /// The unit starts to track the target it holds.
    StartProgram,
    /// The unit starts to track by itself whenever its target is due.
    EnableAuto,
}

/// A request to move; events report its outcome.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum MotionRequest {
    /// By [`Controller::start`].
    Motion(Motion),
    /// By [`Controller::act`]: one of [`Variant::actions`], by its key.
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
    /// Up to nine digits.
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

/// A question that the operator may ask a unit by hand. It changes nothing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Question {
    /// As typed, in capitals, such as `STATUS?`.
    pub key: SmolStr,
    /// Subject of the question, as a sentence without a full stop.
    #[serde(rename = "about")]
    pub subject: Cow<'static, str>,
    /// Bytes that go over the link.
    pub bytes: Box<[u8]>,
}

/// Scope of a halt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Present motion only.
    Motion,
    /// Present motion and on-board track, whatever the known state.
    Track,
    /// These, and whatever the unit would start by itself.
    Everything,
}

/// Outcome of a request to a unit.
#[derive(Debug, Clone, PartialEq)]
pub enum ControllerEvent {
    /// The target was sent and read back: the unit holds it.
    Prepared(TrackTarget),
    /// The unit does not hold the target.
    NotPrepared(TrackTarget, PrepareError),
    /// The unit accepted the command; its state shows whether it moves.
    Accepted(MotionRequest),
    /// The unit refused the command with this answer.
    Refused(MotionRequest, String),
    /// No answer came. The command is not sent again; the state shows what happened.
    Unanswered(MotionRequest),
    /// The unit refused a halt with this answer.
    HaltRefused(String),
    /// The unit refused to switch auto-track off, or did not answer.
    AutoStaysOn,
}

/// Why the unit does not hold the target.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum PrepareError {
    /// The protocol cannot carry a name, file or time.
    #[error("cannot be sent: {0}")]
    CannotBeSent(String),
    #[error("the unit answered {0}")]
    Refused(String),
    /// No answer to a setting.
    #[error("no answer")]
    Unanswered,
    /// The read-back differs from the target.
    #[error("holds {current}")]
    Differs {
        /// Held by the unit now.
        #[serde(rename = "held")]
        current: String,
    },
    /// The unit has no elements of the satellite.
    #[error("no elements in {file}")]
    NotOnDevice {
        /// The element file that was searched.
        file: String,
    },
    /// Neither the unit nor the settings name an element file.
    #[error("no element file is named")]
    NoElementFile,
    /// A halt came in between.
    #[error("stopped")]
    Stopped,
}

/// The side of a controller that everyone may use: nothing here starts a motion or decides
/// where one leads. A method with a default is for a feature that not every make has, or
/// returns the usual figure.
///
/// A position question that is not answered is asked again. The position then counts as
/// asked for when the first unanswered question went out. The reply to a halt is never
/// taken as a position, whatever it holds.
pub trait Device: Send {
    /// The link has come up: forget all outstanding requests, halts included, and ask
    /// everything anew.
    fn link_up(&mut self, now: Moment);

    /// The link is gone: no outstanding request will be answered. Requests that are kept
    /// here are forgotten in [`Self::link_up`].
    fn link_down(&mut self, _now: Moment) {}

    /// Bytes were written: notes them for [`Self::next_wire_line`].
    fn sent(&mut self, _bytes: &[u8], _now: Moment) {}

    /// Takes the oldest line of the link that was not taken yet.
    fn next_wire_line(&mut self) -> Option<WireLine> {
        None
    }

    /// Takes received bytes. Any bytes are harmless.
    fn receive(&mut self, bytes: &[u8], now: Moment);

    /// Returns the bytes to send now, if something is due.
    fn poll(&mut self, now: Moment) -> Option<Vec<u8>>;

    /// The latest time for the next call of [`Self::poll`].
    fn due(&self, now: Moment) -> Instant;

    /// Returns the bytes that stop all motion and end on-board track, and drops motions
    /// that wait. The caller writes them at once, before and despite anything else. With
    /// [`Extent::Motion`], an on-board track that is known to be off is left alone; with
    /// [`Extent::Everything`], auto-track is switched off too.
    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8>;

    /// The operator has pressed STOP, whatever was halted before: ends every permission
    /// that was given for a limited time.
    fn disarm(&mut self) {}

    /// Time after which an unproved halt is sent again. By then a state that was requested
    /// after the halt has come in.
    fn halt_patience(&self) -> Duration {
        Duration::from_secs(1)
    }

    /// Asks for the position at once. For makes whose [`Self::poll_period`] can be long.
    fn ask_position(&mut self, _now: Moment) {}

    /// While `is_watched`, this program has the antenna moving: a position that does not
    /// arrive within [`Self::prompt`] is asked for again at once, and a slower reply holds
    /// up no position question. There is no default, because the second question decides
    /// whether the unit counts as silent.
    fn watch_closely(&mut self, is_watched: bool);

    /// Longest time that a reply takes in normal operation.
    fn prompt(&self) -> Duration {
        PROMPT
    }

    /// Reads the group with this key anew; the result appears in [`AntennaState::groups`].
    /// Without [`Variant::groups`], neither this method nor the others about settings are
    /// called.
    fn read_group(&mut self, _group: &str) {}

    /// Records a change that is not sent, with the reason, in [`AntennaState::groups`].
    fn refuse_change(&mut self, _change: Change, _why: WriteError, _now: Moment) {}

    /// Locks or unlocks the settings. While they are locked, changes that wait end with
    /// [`LockedOut`](settings::WriteError::LockedOut), and the gate passes no new one.
    fn lock_changes(&mut self, _are_locked: bool) {}

    /// Asks one of [`AntennaState::questions`], by its key, between the controller's own
    /// questions. An unknown key is ignored.
    fn ask(&mut self, _question: &str) {}

    /// Switches auto-track off: the unit no longer starts to track by itself.
    fn disable_auto(&mut self) {}

    /// Returns `true` while a motion is queued, or sent and not answered. There is no
    /// default: a wrong `false` would let the next motion be sent into this one.
    fn motion_under_way(&self) -> bool;

    /// The motion as the unit takes it, such as rounded to whole degrees.
    fn as_sent(&self, motion: Motion) -> Motion {
        motion
    }

    /// The state as last known.
    fn state(&self) -> &AntennaState;

    /// Takes the oldest outcome of earlier requests. There is no default: refused and
    /// unanswered motions are reported only here.
    fn next_event(&mut self) -> Option<ControllerEvent>;

    /// Time without a good reply after which the link counts as lost.
    fn patience(&self) -> Duration {
        PATIENCE
    }

    /// Present time between two questions. It sets how far ahead of the last position a jog
    /// is judged, and when a link counts as stale.
    fn poll_period(&self) -> Duration {
        LONGEST_POLL_PERIOD
    }
}

/// The side of a controller that can move the antenna or decide where it goes. Only the
/// gate holds it.
pub trait Controller: Device {
    /// A reason of this make not to start the motion or let it go on. The gate calls it after
    /// its own rules, and again while a jog runs.
    fn objection(&self, _asked: &MotionRequest, _now: Moment) -> Option<&'static str> {
        None
    }

    /// Where an action leads the axes. By default the operator answers for it.
    fn lead_of(&self, _act: &Act) -> Lead {
        Lead::Unseen("its make does not tell where it leads")
    }

    /// Puts a target on the unit without moving the antenna. The outcome is a
    /// [`ControllerEvent`]. Not called without [`Capabilities::has_program`].
    fn prepare(&mut self, _target: TrackTarget) {}

    /// Writes new values of a group to the unit and reads them back. Progress and outcome
    /// appear in [`AntennaState::groups`].
    fn write_settings(&mut self, _change: Change, _now: Moment) {}

    /// Writes offsets of the track that the unit computes, also while it tracks, and reads them
    /// back. Progress and outcome appear in [`AntennaState::groups`]; a halt voids what is not sent.
    /// Not called without [`Variant::track_offsets`].
    fn shift_track(&mut self, _change: Change, _now: Moment) {}

    /// Queues a motion. It is sent once, or not at all when a halt comes first. Without a
    /// link it is refused, or forgotten when the link comes up. The gate passes no motion
    /// that [`Variant::capabilities`] exclude; one that comes anyway is refused with a
    /// [`ControllerEvent`].
    fn start(&mut self, motion: Motion);

    /// Queues an action that only this make has. Not called without [`Variant::actions`].
    fn act(&mut self, _act: Act) {}
}

/// The direction that a motion aims at. An angle that is `None` stays as measured.
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
