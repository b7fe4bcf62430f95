//! Snapshots and events: what a session shows of an antenna.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{Angle, TrackOffsets},
    clock::Instant,
    control::Answer,
    device::{
        AntennaState, Capabilities, MotionRequest, Pointing, PrepareError, TrackTarget,
        settings::{GroupState, GroupStates, Hindrance, WriteError},
    },
    driver::{AxisLessons, Intent, Preview, Refusal, Safety},
    name::{self, Name},
    orbit::PropagationError,
    plan::{Barrier, Sample, Supervision, TrackPhase, TrackStats, program_track::OnPath},
    station::LockOut,
};

/// An antenna that an earlier run may have left moving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftMoving {
    /// When the motion by hand began, or the STOP was pressed; `None` if the record of it cannot be
    /// read.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
}

/// One antenna at one instant. Replaced as a whole, never changed in place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    pub link: LinkState,
    /// It was moving on Azel's command at its last answer, and does not answer.
    pub silent: bool,
    pub intent: Intent,
    /// The intent is requested, but not yet proved by the unit.
    pub pending: bool,
    /// A way is being judged: the path of the unit's own program, the path of a program track or a
    /// detour of one. The antenna waits for that.
    #[serde(default)]
    pub being_judged: bool,
    /// After an outage, the unit has not proved yet to be as it was before.
    #[serde(default)]
    pub being_compared: bool,
    /// End of a motion to a position.
    pub aim: Option<Pointing>,
    /// Target of an on-board track.
    pub target: Option<TrackTarget>,
    /// The on-board track, as it is supervised.
    pub on_board: Option<OnBoardView>,
    pub program_track: Option<TrackView>,
    /// Offsets that were added from here to those of the unit's own track.
    pub unit_offsets: Option<UnitOffsetsView>,
    /// Rates of the axes as learned from long slews, degrees per second; `None` before the
    /// session runs. Until a slew they are those of the settings.
    pub rates_deg_s: Option<[f64; 2]>,
    /// It was moved from here, or a STOP is owed, and standstill has not been proved since.
    pub unproved: bool,
    pub lock_out: Option<LockOut>,
    /// A lock-out has begun, but standstill and auto-track off have not been read back yet.
    pub locking: bool,
    pub stop: StopState,
    /// A motion that Azel has ended is not known to have come to rest.
    pub runs_out: bool,
    /// No dead-man could be had for the last motion by hand that needed one.
    pub unguarded: bool,
    /// It is inside a barrier.
    #[serde(rename = "inside")]
    pub breach: Option<Breach>,
    /// By the operator's permission, program track may lead to the Sun.
    pub sun_lifted: bool,
    /// An earlier run may have left it moving: the operator is asked. Older films hold a time under
    /// the field's own name, which is ignored.
    #[serde(default, rename = "left_in_motion")]
    pub left_moving: Option<LeftMoving>,
    /// Why the next start would not send the STOP that is owed.
    #[serde(default)]
    pub not_on_disk: Option<String>,
    /// Answer to the last command that somebody waits for.
    #[serde(default)]
    pub answer: Option<Answer>,
    /// Signed rates of a held jog, degrees a second.
    pub jog: Option<[f64; 2]>,
    pub stopping_way: StoppingWay,
    /// Properties of each axis that its motions have shown.
    #[serde(default)]
    pub learned: [AxisLessons; 2],
    /// Signed amounts of a step that may not be over, degrees.
    pub step: Option<[f64; 2]>,
    /// Outcome of going to the direction that the operator looks at.
    pub preview: Option<Arc<Preview>>,
    pub state: AntennaState,
    /// Present time between two questions.
    pub poll_period: Duration,
}

impl Snapshot {
    /// The snapshot before the session runs.
    pub fn before_anything(link: LinkState) -> Self {
        Self {
            link,
            silent: false,
            intent: Intent::Standby,
            pending: false,
            being_judged: false,
            being_compared: false,
            aim: None,
            target: None,
            on_board: None,
            program_track: None,
            unit_offsets: None,
            rates_deg_s: None,
            unproved: false,
            lock_out: None,
            locking: false,
            stop: StopState::Ready,
            runs_out: false,
            unguarded: false,
            breach: None,
            sun_lifted: false,
            left_moving: None,
            not_on_disk: None,
            answer: None,
            jog: None,
            stopping_way: StoppingWay::default(),
            learned: Default::default(),
            step: None,
            preview: None,
            state: AntennaState::default(),
            poll_period: Duration::from_millis(500),
        }
    }
}

impl Snapshot {
    /// Returns `true` if a STOP of the whole station includes this antenna. A unit to which
    /// nobody wants a link and that was not moved from here is left to the person in front of
    /// it.
    pub fn wants_stop(&self) -> bool {
        let owed = matches!(self.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. });
        self.link != LinkState::Off || self.unproved || owed
    }

    /// Returns the offsets that are meant to be added to the track that the unit computes.
    pub fn meant_offsets(&self) -> TrackOffsets {
        let offsets = self.unit_offsets.as_ref().filter(|unit| unit.left.is_none());
        offsets.map(|unit| unit.offsets).unwrap_or_default()
    }

    /// The reason why the gate would refuse, at `now`, a setting that decides where the
    /// antenna points.
    pub fn hindrance(&self, can: Capabilities, now: Instant) -> Option<Hindrance> {
        if matches!(self.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. }) {
            return Some(Hindrance::Stopping);
        }
        let is_moving = self.pending
            || self.intent == Intent::Track
            || self.program_track.is_some()
            || self.jog.is_some()
            || self.step.is_some();
        Hindrance::from_state(&self.state, can, now).or(is_moving.then_some(Hindrance::Moves))
    }

    /// Returns `true` if only ages and counters differ. The window shows those with its next
    /// second; they are not worth a frame.
    pub fn shows_the_same(&self, newer: &Self) -> bool {
        let standing = |snapshot: &Self| {
            snapshot
                .state
                .measured
                .filter(|measured| !measured.moving())
                .map(|measured| (measured.pointing, measured.axes))
        };
        if standing(self).is_none() || standing(self) != standing(newer) {
            return false;
        }
        if !same_settings(&self.state.groups, &newer.state.groups) {
            return false;
        }
        let mut newer = newer.clone();
        newer.state.measured = self.state.measured;
        newer.state.traffic = self.state.traffic;
        newer.state.checked_at = self.state.checked_at;
        newer.learned = self.learned;
        newer.state.groups = Arc::clone(&self.state.groups);
        newer.state.on_board.clock = self.state.on_board.clock;
        if let (Some(old), Some(new)) =
            (&self.state.last_satellite, &mut newer.state.last_satellite)
        {
            new.read_at = old.read_at;
        }
        if let (Some(old), Some(new)) = (&self.program_track, &mut newer.program_track) {
            new.next_update = old.next_update;
            new.stats = old.stats;
            new.predicted = old.predicted;
        }
        *self == newer
    }
}

/// Returns `true` if the known settings and the present writes are the same. New reports of the
/// unit alone show with the window's next second.
fn same_settings(old: &GroupStates, new: &GroupStates) -> bool {
    let shown = |state: &GroupState| {
        (state.last_read.is_some(), state.failure.clone(), state.step, state.written.clone())
    };
    old.len() == new.len() && old.values().map(shown).eq(new.values().map(shown))
}

/// Overrun: how long the axes turn on at their rate after a STOP.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct StoppingWay {
    /// The figure in use, seconds.
    pub overrun_s: f64,
    /// Number of STOPs it was measured in.
    pub stops: u32,
    /// It was measured; otherwise it is the default of the make.
    pub is_learned: bool,
}

impl StoppingWay {
    /// Number of STOPs that replace the default.
    pub const ENOUGH: u32 = 3;
}

/// The barrier that an antenna is, or may be, inside of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Breach {
    pub barrier: Barrier,
    /// The axis whose angle is unknown: the antenna may be inside. `None` if it surely is.
    #[serde(default, deserialize_with = "name::option")]
    pub unknown_axis: Option<Name>,
    /// The operator allows manual motion at present: outwards only, or in any direction while the
    /// position is unknown.
    pub may_leave: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnBoardView {
    /// How the unit will track, by what it reports.
    pub found: Arc<Supervision>,
    /// Angle off the satellite, where it has lasted longer than a slew explains.
    pub missing: Option<Angle>,
    /// Latest expected arrival on the satellite of an antenna that has not been on it yet.
    #[serde(default)]
    pub arrives: Option<Instant>,
}

/// Offsets that were added from here to those of the unit's own track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnitOffsetsView {
    /// In force: read back.
    pub offsets: TrackOffsets,
    /// Others are on their way to the unit.
    pub is_changing: bool,
    pub can_undo: bool,
    /// Why they are still there although no track needs them.
    pub left: Option<LeftOffsets>,
}

/// Why offsets of a track are still on a unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LeftOffsets {
    /// An earlier run of the program wrote them, at that time or soon after.
    Found {
        #[serde(rename = "since")]
        start: Timestamp,
    },
    /// They were not taken back.
    Failed(WriteError),
    /// The unit has gone on to another pass, on which they cannot be taken back.
    Refused(Refusal),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackView {
    /// Name of the target.
    pub name: String,
    /// Catalog number of a satellite, up to nine digits.
    pub catalog_number: Option<u32>,
    pub phase: TrackPhase,
    /// Pointing errors, and the number of commands.
    pub stats: TrackStats,
    /// The antenna was out of reach: it waits for the operator.
    pub awaits_operator: bool,
    /// When the next position is due.
    pub next_update: Option<Instant>,
    /// The last commanded position; `None` before the first.
    pub commanded: Option<Pointing>,
    /// Direction in which to point at the time of the last measurement, offsets included;
    /// `None` unless the target is tracked right now.
    pub predicted: Option<Sample>,
    /// Comparison of the last measurement with the planned path; `None` unless the target is tracked
    /// right now.
    pub on_path: Option<OnPath>,
    /// Angle off the path once it has lasted long enough for an alarm.
    pub missing: Option<Angle>,
    /// Offsets from the target.
    pub offsets: TrackOffsets,
    /// They were changed in this pass.
    pub can_undo: bool,
    /// The target has a way over the sky, so that something is along and across it.
    pub target_moves: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkState {
    /// Nobody wants one: the operator has not connected, has disconnected, or the session has
    /// ended.
    Off,
    /// Dialling for the first time since the start.
    Connecting {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// Open, with good replies.
    Up {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// Open, but the last good reply is older than two poll periods, or the position was asked for
    /// longer ago than a unit that answers in time makes possible.
    Stale {
        /// The instant to which the newest report belongs.
        #[serde(alias = "last_reply")]
        as_of: Instant,
    },
    /// Gone, or silent for too long. It is dialled again automatically.
    Lost {
        /// When the last good reply came, or the link was lost.
        #[serde(rename = "since")]
        start: Instant,
        reason: LinkLoss,
        retry_at: Instant,
    },
}

impl LinkState {
    /// Returns `true` if bytes can be sent.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Up { .. } | Self::Stale { .. })
    }
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkLoss {
    /// The other end is absent or refuses, in the words of the operating system.
    Refused(String),
    ConnectTimeout,
    Closed,
    /// Broken, in the words of the operating system.
    Broken(String),
    /// Open, but no reply.
    Silent,
    /// The computer slept: Azel opens the link again.
    Slept,
    /// Open, but no readable reply.
    Unreadable,
    /// Open, but to another device, or to one that asks for a code.
    OtherDevice,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopState {
    /// Nothing was requested.
    Ready,
    /// Sent, or to be sent first when the link is back.
    Stopping {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// The unit is proved to stand.
    Stopped {
        #[serde(rename = "at")]
        time: Instant,
    },
    /// Standstill was not proved within three seconds.
    NotConfirmed {
        #[serde(rename = "since")]
        start: Instant,
    },
}

/// For the event line and the alarm list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    LinkLost(LinkLoss),
    /// The link came up for the first time, and the unit was read.
    Connected(Found),
    /// The unit has begun to track without being asked.
    StartedByItself,
    /// The link is back, and the unit was read.
    Back {
        /// How long it was silent.
        after: Duration,
        found: Found,
        /// Commands from here explain what the unit does and where it points. `true` for a program
        /// track from here as well, which Azel compares separately.
        #[serde(alias = "is_as_left")]
        is_explained: bool,
    },
    /// The gate refused it.
    NotSent(Refusal),
    /// The unit refused it, with this code as received.
    Refused(MotionRequest, String),
    /// Offsets of a track stay as they are, and the track goes on.
    OffsetRefused(Refusal),
    /// An offset of the unit's own track is not in force.
    OffsetNotTaken(WriteError),
    /// No answer to a motion, which is not sent again.
    Unanswered(MotionRequest),
    CannotTrack(TrackTarget, PrepareError),
    /// By what the unit reports, it would miss the satellite of this name.
    WouldMiss {
        name: String,
        found: Arc<Supervision>,
    },
    Tracking(TrackTarget),
    TrackingEnded {
        /// At the end of the pass, not before.
        completed: bool,
    },
    /// The antenna goes to where this target will rise, and waits there.
    Awaits {
        name: String,
        aos: Timestamp,
    },
    ProgramTracks(String),
    /// The last pass of a target is over.
    ProgramTrackOver {
        name: String,
        stats: TrackStats,
    },
    /// Program track of this target cannot begin, or cannot go on.
    CannotProgramTrack(String, TrackProblem),
    Arrived(Pointing),
    /// A motion to a position ended elsewhere.
    EndedShort {
        aim: Pointing,
        #[serde(rename = "at")]
        position: Pointing,
    },
    /// The window did not renew a jog, which was stopped.
    JogLeaseOver,
    /// A jog was ended because its position grew too old.
    JogPositionOld,
    Safety(Safety),
    /// Standstill is proved after a STOP.
    Stopped,
    /// The antenna still moves three seconds after a STOP.
    StopNotConfirmed,
    /// The unit refused a STOP, with this code as received.
    StopRefused(String),
    /// The antenna is stopped, but the unit may start to track on its own.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// Azel has told the unit to switch auto-track off, and cannot find out if it has.
    AutoTrackNotKnown,
    /// The unit is locked out, but auto-track off cannot be read back.
    LockOutUnproved,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum TrackProblem {
    /// It does not rise in the time that was searched.
    #[error("there is no pass to come")]
    NoPass,
    #[error("an axis reports no angle: check its sensor and the cable")]
    NoAngle,
    /// Its elements describe no orbit, or it has come down.
    #[error(transparent)]
    Orbit(#[from] PropagationError),
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl TrackProblem {
    /// The barrier that is the reason, if one is.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Refused(refusal) => refusal.barrier(),
            Self::NoPass | Self::NoAngle | Self::Orbit(_) => None,
        }
    }
}

/// State of a unit when its link came back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Found {
    Tracking,
    /// It moves, but not by its tracking program.
    Moving,
    Still,
}
