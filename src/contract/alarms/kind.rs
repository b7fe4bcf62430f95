//! The kinds of alarms.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{Angle, TrackOffsets},
    automatic::{Interruption, NotReady, OffBecause},
    claim::HeldBy,
    device::{
        MotionRequest, PrepareError, TrackTarget,
        panel::{Check, CheckState},
        settings::WriteError,
    },
    driver::{LeftOffsets, LinkLoss, OffTargetCause, Safety, TrackProblem, Unit},
    name::{self, Name},
    passes::PassListKey,
    plan::on_board::Ranked,
    station::Note,
};

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Priority {
    /// Problem that is about to occur, or a task that was not done.
    Caution,
    /// Current fault.
    Warning,
    /// Motion or pointing that may be dangerous, of an antenna that is not known to obey. Neither a
    /// shelf nor a setting can silence such an alarm.
    First,
}

impl Priority {
    /// Returns `true` for an alarm that is red while its cause persists.
    pub fn is_red(self) -> bool {
        match self {
            Self::First | Self::Warning => true,
            Self::Caution => false,
        }
    }
}

/// Kind of an alarm. The window words it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum AlarmKind {
    /// No link to the antenna.
    LinkLost(LinkLoss),
    /// The antenna still moves three seconds after STOP.
    StopNotConfirmed,
    /// The unit refused STOP, with this code.
    StopRefused(String),
    /// Azel stopped a jog because the window or the station was too busy to renew it.
    JogLeaseOver,
    /// Azel stopped a jog because the position was too old.
    JogPositionOld,
    /// Recurrent loss of positions that Azel requested from the unit.
    LosesPositions,
    /// The antenna has stopped, but the unit may start to track without a command.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// Azel requested auto-track off, and the unit cannot report its state.
    AutoTrackNotKnown,
    /// Azel still has to switch auto-track off at a unit that belongs to no antenna of the station.
    AutoTrackOwed(Unit),
    /// A unit that belongs to no antenna of the station may still add offsets of a track.
    OffsetsOwed(Unit),
    /// The unit is locked out, but no read-back proves that auto-track is off.
    LockOutUnproved,
    /// Azel could not read or write the list of locked-out units; the text is the error.
    LockOuts(String),
    /// The unit refused a request, with this code.
    Refused(MotionRequest, String),
    /// The unit did not answer a request.
    Unanswered(MotionRequest),
    /// The unit cannot track the satellite on board.
    CannotTrack(TrackTarget, PrepareError),
    /// Program track of this target cannot begin or continue.
    CannotProgramTrack(String, TrackProblem),
    /// The antenna tracks, but points off the satellite.
    OffTarget {
        /// Angle off the satellite at the time of the alarm.
        #[serde(rename = "off")]
        deviation: Angle,
        cause: Option<OffTargetCause>,
    },
    /// The settings that the unit reports would make it miss a pass; with the likeliest cause.
    UnitDiffers(Ranked),
    /// The unit still adds offsets that Azel wrote for a track.
    OffsetsLeft {
        offsets: TrackOffsets,
        #[serde(rename = "why")]
        reason: LeftOffsets,
    },
    /// The unit did not take an offset of its own track.
    OffsetNotTaken(WriteError),
    /// The unit tracks on board, but Azel does not know its target direction.
    NotCompared {
        /// Name of the satellite that the unit reports, without known elements; `None` if the unit
        /// reports none.
        satellite: Option<String>,
    },
    /// Tracking ended before LOS.
    TrackingEnded,
    /// A motion ended short of its target.
    EndedShort,
    /// The antenna is not on its way to a pass of the schedule that is about to begin.
    NotOnItsWay {
        pass: PassListKey,
        /// Short name of the satellite.
        name: String,
        /// Reason why the unit cannot begin the pass, if known.
        #[serde(rename = "why", default)]
        reason: Option<NotReady>,
    },
    /// Automatic operation is about to move the antenna, for the first time or after a rest.
    AutomaticMoves {
        #[serde(rename = "at")]
        time: Timestamp,
        /// Short name of the satellite of the pass.
        name: String,
    },
    /// Automatic operation of the antenna has ended without the operator.
    AutomaticOff(OffBecause),
    /// Somebody else moves the antenna, so automatic operation waits for the operator.
    AutomaticSuspended(Interruption),
    /// No antenna is on its way to a pass for which the operator set a reminder.
    NoAntennaFor {
        pass: PassListKey,
        /// Short name of the satellite.
        name: String,
    },
    /// The unit tracks without a request from this console.
    StartedByItself,
    /// The unit moves without a request from this console.
    MovesByItself,
    Safety(Safety),
    /// Azel owes a STOP to a unit that belongs to no antenna of the station.
    Owed(Unit),
    /// The thread that talks to the antennas has not responded for this long.
    DriverStands(Duration),
    /// The station's thread has published nothing new for this long; the displayed state has the
    /// same age.
    StationStands(Duration),
    /// Another Azel on this machine has this station open: this Azel can drive nothing.
    StationElsewhere(HeldBy),
    /// Another Azel on this machine drives this unit.
    UnitElsewhere(HeldBy),
    /// The Azel that drives an antenna did not confirm STOP.
    StopNotElsewhere,
    /// A background job of the program has crashed.
    BrokeOff(Work),
    /// Azel does not read the source of elements with this name, because its last reading crashed
    /// the program.
    SourceSetAside(String),
    /// The last requests to this source returned no elements, its server refused the log-in, or its
    /// file cannot be read.
    SourceFails {
        source: String,
        /// Last time at which the elements of the source were known to be current.
        as_of: Option<Timestamp>,
    },
    /// The elements of this satellite, and of `others`, are too old for passes that automatic
    /// operation takes, or skips because of their age.
    ElementsOld {
        name: String,
        others: usize,
    },
    /// The automatic upload of newer elements to the unit failed.
    ElementsNotUploaded {
        #[serde(rename = "why")]
        reason: String,
    },
    /// The program was too busy to take a request.
    NotTaken,
    /// Fault or warning that the unit itself reports.
    Check(Check),
    /// The unit's clock is this far ahead of the computer's clock, seconds.
    ClockOff(f64),
    /// The unit's clock was never set.
    ClockNotSet,
    /// Azel cannot read the position of the unit, for this reason.
    Unreadable(#[serde(deserialize_with = "name::one")] Name),
    /// Azel did not use this entry of the station file.
    Setting(Note),
    /// Azel could not read a safety setting. This antenna, or all antennas if `None`, do not move
    /// automatically.
    SafetySetting {
        note: Note,
        antenna: Option<String>,
    },
    /// Azel could not read, write or send settings; the text is the error.
    Settings(String),
    /// Azel could not read the elements; the text is the error.
    Elements(String),
    /// Azel cannot write the record; the text is the reason.
    NoRecord(String),
    /// Somebody has removed or replaced the file of the record.
    RecordRemoved,
}

/// Background work that can crash.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    Elements,
    Passes,
    Schedule,
}

impl AlarmKind {
    pub fn priority(&self) -> Priority {
        match self {
            Self::StopNotConfirmed
            | Self::StopRefused(_)
            | Self::StopNotElsewhere
            | Self::Owed(_)
            | Self::DriverStands(_)
            | Self::MovesByItself
            | Self::LockOutUnproved
            | Self::Safety(
                Safety::DeadManFired
                | Safety::LeftMoving { .. }
                | Safety::SilentInMotion
                | Safety::FlagsContradict { .. }
                | Safety::NoEffect { .. }
                | Safety::Forbidden { .. },
            )
            | Self::SafetySetting { .. } => Priority::First,
            Self::LinkLost(_)
            | Self::Safety(_)
            | Self::StationStands(_)
            | Self::StationElsewhere(_)
            | Self::UnitElsewhere(_)
            | Self::LockOuts(_)
            | Self::StartedByItself
            | Self::Unreadable(_)
            | Self::JogPositionOld
            | Self::LosesPositions
            | Self::AutoTrackOwed(_)
            | Self::OffsetsOwed(_)
            | Self::OffTarget { .. }
            | Self::OffsetsLeft {
                reason: LeftOffsets::Failed(_) | LeftOffsets::Refused(_), ..
            }
            | Self::NotOnItsWay { .. }
            | Self::AutomaticMoves { .. }
            | Self::AutomaticOff(_)
            | Self::AutomaticSuspended(_)
            | Self::SourceFails { .. }
            | Self::ElementsOld { .. }
            | Self::ElementsNotUploaded { .. }
            | Self::Check(Check { state: CheckState::Fault, .. }) => Priority::Warning,
            _ => Priority::Caution,
        }
    }
}
