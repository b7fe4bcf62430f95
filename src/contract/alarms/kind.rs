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
    /// Something will go wrong or was not done.
    Caution,
    /// Something is wrong now.
    Warning,
    /// An antenna moves, may move or points where it must not, and is not known to obey. Nothing
    /// silences it: it cannot be shelved, and no setting keeps it quiet.
    First,
}

impl Priority {
    /// Returns `true` for an alarm that is red while it stands.
    pub fn is_red(self) -> bool {
        match self {
            Self::First | Self::Warning => true,
            Self::Caution => false,
        }
    }
}

/// Kind of an alarm. The view puts it into words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum AlarmKind {
    /// No link to the antenna.
    LinkLost(LinkLoss),
    /// The antenna still moves three seconds after STOP.
    StopNotConfirmed,
    /// The unit refused STOP, with this code.
    StopRefused(String),
    /// A jog was stopped because the window or the station was too busy to renew it.
    JogLeaseOver,
    /// A jog was stopped because the position grew too old.
    JogPositionOld,
    /// Positions that the unit was asked for are missing again and again.
    LosesPositions,
    /// The antenna has stopped, but the unit may start by itself.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// The unit was told to switch auto-track off, and cannot tell whether it has.
    AutoTrackNotKnown,
    /// Auto-track is to be switched off at a unit that belongs to no antenna of the station.
    AutoTrackOwed(Unit),
    /// A unit that belongs to no antenna of the station may still add offsets of a track.
    OffsetsOwed(Unit),
    /// The unit is locked out, but no read-back proves that it does not start by itself.
    LockOutUnproved,
    /// The list of locked-out units could not be read or written; in words.
    LockOuts(String),
    /// The unit refused a request, with this code.
    Refused(MotionRequest, String),
    /// The unit did not answer a request.
    Unanswered(MotionRequest),
    /// The satellite cannot be tracked on board.
    CannotTrack(TrackTarget, PrepareError),
    /// Program track of this target cannot begin, or cannot go on.
    CannotProgramTrack(String, TrackProblem),
    /// The antenna tracks, and is not where the satellite is.
    OffTarget {
        /// Error when it was noticed.
        #[serde(rename = "off")]
        deviation: Angle,
        cause: Option<OffTargetCause>,
    },
    /// By the unit's own settings it would miss a pass; with the likeliest cause.
    UnitDiffers(Ranked),
    /// The unit still adds offsets that were written for a track.
    OffsetsLeft {
        offsets: TrackOffsets,
        #[serde(rename = "why")]
        reason: LeftOffsets,
    },
    /// An offset of the unit's own track was not written.
    OffsetNotTaken(WriteError),
    /// The unit tracks on board, but its target direction is unknown here.
    NotCompared {
        /// Name of the satellite that the unit reports, without known elements; `None`
        /// where it reports none.
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
    /// Automatic operation is going to move the antenna, for the first time or after a rest.
    AutomaticMoves {
        #[serde(rename = "at")]
        time: Timestamp,
        /// Short name of the satellite whose pass it is for.
        name: String,
    },
    /// Automatic operation of the antenna has ended, and not by the operator.
    AutomaticOff(OffBecause),
    /// Somebody else moves the antenna, so automatic operation waits for the operator.
    AutomaticSuspended(Interruption),
    /// No antenna is on its way to a pass that the operator wanted to be reminded of.
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
    /// A STOP is owed to a unit that belongs to no antenna of the station.
    Owed(Unit),
    /// The thread that talks to the antennas has not responded for this long.
    DriverStands(Duration),
    /// The station's thread has published nothing new for this long; the displayed state is
    /// as old.
    StationStands(Duration),
    /// Another Azel of this machine has this station open: nothing can be driven from here.
    StationElsewhere(HeldBy),
    /// Another Azel of this machine drives this unit.
    UnitElsewhere(HeldBy),
    /// The Azel that drives an antenna did not confirm STOP.
    StopNotElsewhere,
    /// A background job of the program broke off.
    BrokeOff(Work),
    /// The source of elements with this name is not read: its last reading ended the
    /// program.
    SourceSetAside(String),
    /// The last requests to this source returned no elements, its server refused the log-in, or its
    /// file cannot be read.
    SourceFails {
        source: String,
        /// When its elements were last known to be current.
        as_of: Option<Timestamp>,
    },
    /// The elements of this satellite, and of `others`, are too old for the passes that automatic
    /// operation will take, or leaves out for this reason.
    ElementsOld {
        name: String,
        others: usize,
    },
    /// Newer elements cannot be uploaded to the unit by the rule.
    ElementsNotUploaded {
        #[serde(rename = "why")]
        reason: String,
    },
    /// The program was too busy to take a request.
    NotTaken,
    /// A fault or warning that the unit names itself.
    Check(Check),
    /// The unit's clock is this far ahead of ours, seconds.
    ClockOff(f64),
    /// The unit's clock was never set.
    ClockNotSet,
    /// The position of the unit cannot be read, for this reason.
    Unreadable(#[serde(deserialize_with = "name::one")] Name),
    /// An entry of the station file was not taken over.
    Setting(Note),
    /// A setting on which safety depends could not be read, so this antenna, or all of them if it is
    /// `None`, do not move by themselves.
    SafetySetting {
        note: Note,
        antenna: Option<String>,
    },
    /// Settings could not be read, written or sent; in words.
    Settings(String),
    /// The elements could not be read; in words.
    Elements(String),
    /// Nothing can be recorded, for this reason.
    NoRecord(String),
    /// Somebody has removed or replaced the file of the record.
    RecordRemoved,
}

/// Background work that can break off.
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
