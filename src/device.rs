//! What any controller is to the rest of the program: what it can do, what it
//! tells, what it can be told, whatever its make.
//!
//! Invariant: a [`Moves`] can make metal move, so only the driver's gate holds
//! one; everyone else sees its [`Device`] side.

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

pub use capabilities::{Capabilities, JogSpeed, JogSpeeds, SecondAxis, Standstill};
pub use element_files::ElementFiles;
pub use on_board::{HeldSatellite, Offsets, OnBoard, Place, UnitClock};
pub use state::{AntennaState, Axis, AxisMotion, Measured, Phase, Pointing, Program, Traffic};
pub use variant::Variant;
pub use wire::{Direction, Explained, ExplainedValue, Finding, Meaning, WireLine};

use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    name::{self, Name},
};
use panel::{Act, Lead};
use settings::{Change, WriteError};

/// A reply that has not come after this long is missing while metal moves.
pub const PROMPT: Duration = Duration::from_millis(600);
/// Without a reply for so long the link of a make that says nothing else is lost.
const PATIENCE: Duration = Duration::from_secs(5);
/// A controller asks for the position twice a second at least: a motion by hand needs one
/// younger than a second.
const LONGEST_POLL_PERIOD: Duration = Duration::from_millis(500);

/// What makes metal move.
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
    /// To a direction; `None` leaves that axis where it stands, by its own angle and not by
    /// the direction: over the zenith the two differ.
    Position {
        /// Azimuth. On a mount whose azimuth axis turns by more than a turn it is
        /// the position of that axis: 370 is not 10.
        azimuth: Option<Angle>,
        /// Elevation. On a mount whose elevation axis travels over the zenith it is
        /// the position of that axis: 120 points up 60 degrees on the other side.
        elevation: Option<Angle>,
    },
    /// The controller follows the target it holds.
    StartProgram,
    /// The controller starts to follow by itself whenever its target is due.
    EnableAuto,
}

/// A request to move, as its outcome is told.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Asked {
    /// By [`Moves::start`].
    Motion(Motion),
    /// By [`Moves::act`]: one of [`Variant::actions`], by its key.
    Action(#[serde(deserialize_with = "name::one")] Name),
}

impl From<Motion> for Asked {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}

/// What an antenna shall follow, as far as a controller that tracks by itself
/// needs to know.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrackTarget {
    /// Up to nine digits.
    pub catalog_number: u32,
    /// As in the elements.
    pub name: String,
    /// When to start.
    pub from: Timestamp,
    /// When to end.
    pub until: Timestamp,
}

/// What the operator may ask a device by hand; it changes nothing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Question {
    /// As it is typed, in capitals, such as `STATUS?`.
    pub key: SmolStr,
    /// What it asks, in a sentence without a full stop.
    pub about: Cow<'static, str>,
    /// As it goes over the link.
    pub bytes: Box<[u8]>,
}

/// How much a halt ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// What moves now.
    Motion,
    /// What moves now or may begin to, whatever is known of it.
    Everything,
}

/// What came of something that was asked of the device.
#[derive(Debug, Clone, PartialEq)]
pub enum ControllerEvent {
    /// The target was sent and read back: the device holds it.
    Prepared(TrackTarget),
    /// The target is not on the device.
    NotPrepared(TrackTarget, PrepareError),
    /// The device took the command; whether it moves is seen in its state.
    Accepted(Asked),
    /// The device said no. Its code stands as it came.
    Refused(Asked, String),
    /// No answer came. It is not sent again; the state will tell.
    Unanswered(Asked),
    /// The device said no to a halt. Its code stands as it came.
    HaltRefused(String),
    /// The device said no to switching auto-track off, or did not answer.
    AutoStaysOn,
}

/// Why the device does not hold the target.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum PrepareError {
    /// A name, file or time cannot be carried by the protocol.
    #[error("cannot be sent: {0}")]
    CannotBeSent(String),
    /// The device said no. Its code stands as it came.
    #[error("refused with {code}")]
    Refused {
        /// As it came.
        code: String,
    },
    /// No answer to a setting.
    #[error("no answer")]
    Unanswered,
    /// The read-back shows something else.
    #[error("holds {held}")]
    Differs {
        /// What the device holds now.
        held: String,
    },
    /// The device has no elements of it.
    #[error("no elements in {file}")]
    NotOnDevice {
        /// The element file that was searched.
        file: String,
    },
    /// Neither the device nor the settings name an element file.
    #[error("no element file is named")]
    NoElementFile,
    /// A halt came in between.
    #[error("stopped")]
    Stopped,
}

/// A controller as everyone may use it: nothing here starts a motion, or decides
/// where one leads. A method with a default belongs to something that not every make has,
/// or tells the usual figure.
///
/// A question for the position that is not answered is asked again. A position counts as
/// asked when the first question went out that was not answered, and the reply to a halt
/// is none, whatever stands in it.
pub trait Device: Send {
    /// The link has come up: forget what was outstanding, a halt too, and ask everything anew.
    fn link_up(&mut self, now: Moment);

    /// The link is gone: nothing that was asked will be answered. What is not forgotten
    /// here is when the link comes up.
    fn link_down(&mut self, _now: Moment) {}

    /// Bytes that were written, for [`Self::next_wire_line`].
    fn sent(&mut self, _bytes: &[u8], _now: Moment) {}

    /// What went over the link and was not taken yet, oldest first.
    fn next_wire_line(&mut self) -> Option<WireLine> {
        None
    }

    /// Takes bytes that came in. Any bytes are harmless.
    fn receive(&mut self, bytes: &[u8], now: Moment);

    /// The bytes to send now, if something is due.
    fn poll(&mut self, now: Moment) -> Option<Vec<u8>>;

    /// When [`Self::poll`] is to be called next at the latest.
    fn due(&self, now: Moment) -> Instant;

    /// The bytes that stop all motion and end the device's own program. To be
    /// written at once, before and despite anything else; motions that wait are
    /// dropped. With [`Extent::Motion`] a program that is known to be off is
    /// left alone.
    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8>;

    /// The operator has pressed STOP, whatever else was halted before: nothing of
    /// what was allowed for a while is allowed any more.
    fn disarm(&mut self) {}

    /// After this long a halt that is not proved is sent again: by then a state
    /// that was asked for after it has come in.
    fn halt_patience(&self) -> Duration {
        Duration::from_secs(1)
    }

    /// Asks for the position without waiting for its turn, where [`Self::poll_period`] can be
    /// long.
    fn look(&mut self, _now: Moment) {}

    /// While `is_watched`, metal moves on this program's word: a position that is not
    /// told within [`Self::prompt`] is asked for again at once, and a reply that takes
    /// longer holds up no question for the position. It has no default: the silence of the
    /// unit is judged by the second question.
    fn watch_closely(&mut self, is_watched: bool);

    /// How long a reply takes at most while all is well.
    fn prompt(&self) -> Duration {
        PROMPT
    }

    /// Reads the group with this key anew. It is then among
    /// [`AntennaState::held`]. Without [`Variant::groups`] it is never asked, nor are the
    /// other methods about settings.
    fn read_group(&mut self, _group: &str) {}

    /// A change that is not sent: the reason stands in [`AntennaState::held`].
    fn refuse_change(&mut self, _change: Change, _why: WriteError, _now: Moment) {}

    /// While they are locked, changes of settings that wait end with
    /// [`LockedOut`](settings::WriteError::LockedOut). The gate lets no new one by.
    fn lock_changes(&mut self, _are_locked: bool) {}

    /// Asks this one of [`AntennaState::questions`], by its key, between its own. What is
    /// none of them is dropped.
    fn ask(&mut self, _question: &str) {}

    /// The device no longer starts to follow by itself.
    fn disable_auto(&mut self) {}

    /// A motion is queued, or sent and not answered. It has no default: one that is not told
    /// would be taken for none, and the next would be sent into it.
    fn motion_under_way(&self) -> bool;

    /// What `motion` becomes in the words of the device, such as whole degrees.
    fn as_told(&self, motion: Motion) -> Motion {
        motion
    }

    /// What is known.
    fn state(&self) -> &AntennaState;

    /// What came of earlier requests, oldest first. It has no default: a motion that was
    /// refused or not answered is told by it alone.
    fn next_event(&mut self) -> Option<ControllerEvent>;

    /// Without any good reply for this long, the link counts as lost.
    fn patience(&self) -> Duration {
        PATIENCE
    }

    /// The time between two questions at present: how far ahead of the last position a jog is
    /// judged, and when a link counts as stale.
    fn poll_period(&self) -> Duration {
        LONGEST_POLL_PERIOD
    }
}

/// The side of a controller that moves metal or decides where it goes. Only the gate holds it.
pub trait Moves: Device {
    /// Why `asked` must not be started or go on, where that is special to this
    /// device. The gate asks it after its own rules, and again while a jog runs.
    fn objection(&self, _asked: &Asked, _now: Moment) -> Option<&'static str> {
        None
    }

    /// Where an action leads the axes. Of a make that does not say, the operator answers
    /// for it.
    fn lead_of(&self, _act: &Act) -> Lead {
        Lead::Unseen("its make does not tell where it leads")
    }

    /// Puts a target on the device without moving it. The outcome comes as a
    /// [`ControllerEvent`]. Without [`Capabilities::has_program`] it is never asked.
    fn prepare(&mut self, _target: TrackTarget) {}

    /// Puts new values of a group on the device and reads them back. How far it
    /// is, and what came of it, stands in [`AntennaState::held`].
    fn write_settings(&mut self, _change: Change, _now: Moment) {}

    /// Queues a motion. It is sent once, and not at all when a halt comes first. The link
    /// may be gone: then the motion is refused, or forgotten when the link comes up. The
    /// gate lets nothing by that [`Variant::capabilities`] exclude; what comes all the same
    /// is refused by a [`ControllerEvent`].
    fn start(&mut self, motion: Motion);

    /// Queues what only this make can do. A controller without
    /// [`Variant::actions`] is never asked.
    fn act(&mut self, _act: Act) {}
}

/// What a motion aims at: an angle that is left as it is stays as measured.
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
