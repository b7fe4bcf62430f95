//! Snapshots and events of an antenna's session.

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

/// Antenna that a previous run may have left moving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftMoving {
    /// Start of the motion by hand, or time of the STOP; `None` if the record of it cannot be read.
    #[serde(rename = "since")]
    pub start: Option<Timestamp>,
}

/// State of one antenna at one instant. A session replaces the snapshot as a whole, and never
/// changes it in place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    pub link: LinkState,
    /// The antenna moved on Azel's command at its last answer, and has been silent since.
    pub silent: bool,
    pub intent: Intent,
    /// The unit has not yet proved the requested intent.
    pub pending: bool,
    /// Azel is judging a way: the path of the unit's own program, the path of a program track, or a
    /// detour. The antenna waits for the judgement.
    #[serde(default)]
    pub being_judged: bool,
    /// After an outage, Azel is still comparing the unit with its state before.
    #[serde(default)]
    pub being_compared: bool,
    /// Target of a motion to a position.
    pub aim: Option<Pointing>,
    /// Target of an on-board track.
    pub target: Option<TrackTarget>,
    /// Supervision of the on-board track.
    pub on_board: Option<OnBoardView>,
    pub program_track: Option<TrackView>,
    /// Offsets that Azel has added to the unit's own offsets of its track.
    pub unit_offsets: Option<UnitOffsetsView>,
    /// Axis rates learned from long slews, degrees a second; the rates of the settings before the
    /// first long slew. `None` before the session runs.
    pub rates_deg_s: Option<[f64; 2]>,
    /// Azel has moved the antenna or owes a STOP, and standstill is not yet proved.
    pub unproved: bool,
    pub lock_out: Option<LockOut>,
    /// A lock-out has begun, but Azel has not yet read back standstill and auto-track off.
    pub locking: bool,
    pub stop: StopState,
    /// Time at which the session had first written the last pressed STOP to the link; `None` before
    /// the first STOP.
    #[serde(default)]
    pub stop_written: Option<Instant>,
    /// A motion that Azel has ended is not yet known to be at rest.
    pub runs_out: bool,
    /// No dead-man was available for the last motion by hand that needed one.
    pub unguarded: bool,
    /// Barrier that the antenna is inside, or may be inside.
    #[serde(rename = "inside")]
    pub breach: Option<Breach>,
    /// The operator allows program track to lead to the Sun.
    pub sun_lifted: bool,
    /// Motion that a previous run may have left: Azel asks the operator. Older films hold a time
    /// under the field's own name, which serde ignores.
    #[serde(default, rename = "left_in_motion")]
    pub left_moving: Option<LeftMoving>,
    /// Reason why the next start would not send the owed STOP.
    #[serde(default)]
    pub not_on_disk: Option<String>,
    /// Answer to the last command for which somebody waits.
    #[serde(default)]
    pub answer: Option<Answer>,
    /// Signed rates of a held jog, degrees a second.
    pub jog: Option<[f64; 2]>,
    pub stopping_way: StoppingWay,
    /// Properties of each axis, learned from its motions.
    #[serde(default)]
    pub learned: [AxisLessons; 2],
    /// Signed amounts of a step that may still be in progress, degrees.
    pub step: Option<[f64; 2]>,
    /// Judgement of going to the direction that the operator looks at.
    pub preview: Option<Arc<Preview>>,
    pub state: AntennaState,
    /// Current interval between two questions.
    pub poll_period: Duration,
}

impl Snapshot {
    /// Creates the snapshot before the session runs.
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
            stop_written: None,
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
    /// Returns `true` if a STOP of the whole station includes this antenna. Azel leaves out a unit
    /// without a wanted link and without an unproved motion from here, because the person in front
    /// of it controls it.
    pub fn wants_stop(&self) -> bool {
        let owed = matches!(self.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. });
        self.link != LinkState::Off || self.unproved || owed
    }

    /// Returns the offsets that should be added to the track that the unit computes.
    pub fn meant_offsets(&self) -> TrackOffsets {
        let offsets = self.unit_offsets.as_ref().filter(|unit| unit.left.is_none());
        offsets.map(|unit| unit.offsets).unwrap_or_default()
    }

    /// Returns the reason why the gate would refuse, at `now`, a setting that decides where the
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

    /// Returns `true` if only ages and counters differ. The window shows them with its next second,
    /// without an extra frame.
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

/// Returns `true` if the known settings and the pending writes are the same. The window shows mere
/// repeats of the unit's reports with its next second.
fn same_settings(old: &GroupStates, new: &GroupStates) -> bool {
    let shown = |state: &GroupState| {
        (state.last_read.is_some(), state.failure.clone(), state.step, state.written.clone())
    };
    old.len() == new.len() && old.values().map(shown).eq(new.values().map(shown))
}

/// Overrun: time for which the axes turn on at their rate after a STOP.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct StoppingWay {
    /// Figure in use, seconds.
    pub overrun_s: f64,
    /// Number of STOPs with a measured overrun.
    pub stops: u32,
    /// Measured figure; otherwise the default of the make.
    pub is_learned: bool,
}

impl StoppingWay {
    /// Number of STOPs after which the measured figure replaces the default.
    pub const ENOUGH: u32 = 3;
}

/// Barrier that an antenna is inside, or may be inside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Breach {
    pub barrier: Barrier,
    /// Axis with an unknown angle: the antenna may be inside. `None` if the antenna is certainly
    /// inside.
    #[serde(default, deserialize_with = "name::option")]
    pub unknown_axis: Option<Name>,
    /// The operator currently allows motions by hand: outwards only, or in any direction while the
    /// position is unknown.
    pub may_leave: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnBoardView {
    /// Expected track, judged from the unit's reports.
    pub found: Arc<Supervision>,
    /// Angle off the satellite once it has lasted longer than a slew explains.
    pub missing: Option<Angle>,
    /// Latest expected arrival on the satellite, for an antenna that has not reached it yet.
    #[serde(default)]
    pub arrives: Option<Instant>,
}

/// Offsets that Azel has added to the unit's own offsets of its track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnitOffsetsView {
    /// Offsets in force, read back from the unit.
    pub offsets: TrackOffsets,
    /// Azel is writing other offsets to the unit.
    pub is_changing: bool,
    pub can_undo: bool,
    /// Reason why the offsets are still on the unit although no track needs them.
    pub left: Option<LeftOffsets>,
}

/// Reason why offsets of a track are still on a unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LeftOffsets {
    /// A previous run of the program wrote the offsets, at this time or soon after.
    Found {
        #[serde(rename = "since")]
        start: Timestamp,
    },
    /// Azel failed to remove the offsets.
    Failed(WriteError),
    /// The unit has gone on to another pass, during which Azel cannot remove the offsets.
    Refused(Refusal),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackView {
    /// Name of the target.
    pub name: String,
    /// Catalog number of a satellite, up to nine digits.
    pub catalog_number: Option<u32>,
    pub phase: TrackPhase,
    /// Pointing errors, and number of commands.
    pub stats: TrackStats,
    /// The antenna was out of reach, and the track waits for the operator.
    pub awaits_operator: bool,
    /// Time at which the next position is due.
    pub next_update: Option<Instant>,
    /// Last commanded position; `None` before the first command.
    pub commanded: Option<Pointing>,
    /// Target direction at the time of the last measurement, including offsets; `None` unless the
    /// antenna tracks the target now.
    pub predicted: Option<Sample>,
    /// Comparison of the last measurement with the planned path; `None` unless the antenna tracks
    /// the target now.
    pub on_path: Option<OnPath>,
    /// Angle off the path, once it has lasted long enough for an alarm.
    pub missing: Option<Angle>,
    /// Offsets from the target.
    pub offsets: TrackOffsets,
    /// The offsets were changed in this pass.
    pub can_undo: bool,
    /// The target moves across the sky, so along and across its path are defined.
    pub target_moves: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkState {
    /// No link is wanted: the operator has not connected or has disconnected, or the session has
    /// ended.
    Off,
    /// First attempt to connect since the start.
    Connecting {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// Open link with good replies.
    Up {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// Open link, but the last good reply is older than two poll periods. A position that is
    /// overdue has the same effect.
    Stale {
        /// Instant to which the newest report belongs.
        #[serde(alias = "last_reply")]
        as_of: Instant,
    },
    /// Lost link, or a link that was silent for too long. Azel retries automatically.
    Lost {
        /// Time of the last good reply or of the loss of the link.
        #[serde(rename = "since")]
        start: Instant,
        reason: LinkLoss,
        retry_at: Instant,
    },
}

impl LinkState {
    /// Returns `true` if the session can send bytes.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Up { .. } | Self::Stale { .. })
    }
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkLoss {
    /// The other end is absent or refuses; the text is from the operating system.
    Refused(String),
    ConnectTimeout,
    Closed,
    /// Broken connection; the text is from the operating system.
    Broken(String),
    /// Open link without a reply.
    Silent,
    /// The computer slept: Azel reopens the link.
    Slept,
    /// Open link without a readable reply.
    Unreadable,
    /// Open link to another device, or to a device that asks for a code.
    OtherDevice,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopState {
    /// No STOP is pending.
    Ready,
    /// STOP is sent, or will be the first request once the link is back.
    Stopping {
        #[serde(rename = "since")]
        start: Instant,
    },
    /// Standstill is proved.
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

/// Event for the event line and the alarm list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    LinkLost(LinkLoss),
    /// The first link is up, and Azel has read the unit.
    Connected(Found),
    /// The unit has begun to track without a request.
    StartedByItself,
    /// The link is back, and Azel has read the unit.
    Back {
        /// Duration of the silence.
        after: Duration,
        found: Found,
        /// Azel's commands explain the unit's activity and position. The value is also `true` for
        /// Azel's program track, which Azel compares separately.
        #[serde(alias = "is_as_left")]
        is_explained: bool,
    },
    /// The gate refused the request.
    NotSent(Refusal),
    /// The unit refused the request, with this code as received.
    Refused(MotionRequest, String),
    /// The gate refused a change of offsets. The offsets are unchanged, and the track goes on.
    OffsetRefused(Refusal),
    /// An offset of the unit's own track is not in force.
    OffsetNotTaken(WriteError),
    /// The unit did not answer a motion. Azel does not resend the motion.
    Unanswered(MotionRequest),
    CannotTrack(TrackTarget, PrepareError),
    /// The unit's reports show that it would miss the satellite of this name.
    WouldMiss {
        name: String,
        found: Arc<Supervision>,
    },
    Tracking(TrackTarget),
    TrackingEnded {
        /// The track ended at the end of the pass, not before.
        completed: bool,
    },
    /// The antenna goes to the direction where this target will rise, and waits there.
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
    /// Program track of this target cannot begin or continue.
    CannotProgramTrack(String, TrackProblem),
    Arrived(Pointing),
    /// A motion to a position ended short of its target.
    EndedShort {
        aim: Pointing,
        #[serde(rename = "at")]
        position: Pointing,
    },
    /// The window did not renew a jog, and Azel stopped the jog.
    JogLeaseOver,
    /// Azel ended a jog because its position was too old.
    JogPositionOld,
    Safety(Safety),
    /// Standstill is proved after a STOP.
    Stopped,
    /// The antenna still moves three seconds after a STOP.
    StopNotConfirmed,
    /// The unit refused a STOP, with this code as received.
    StopRefused(String),
    /// The antenna has stopped, but the unit may start to track without a command.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// Azel requested auto-track off, and the unit cannot report its state.
    AutoTrackNotKnown,
    /// The unit is locked out, but Azel cannot read back that auto-track is off.
    LockOutUnproved,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum TrackProblem {
    /// The target does not rise within the searched time.
    #[error("there is no pass to come")]
    NoPass,
    #[error("an axis reports no angle: check its sensor and the cable")]
    NoAngle,
    /// The elements describe no orbit, or the satellite has decayed.
    #[error(transparent)]
    Orbit(#[from] PropagationError),
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl TrackProblem {
    /// Returns the barrier behind the problem, if any.
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
    /// Motion outside the tracking program.
    Moving,
    Still,
}
