//! What a session tells the rest of the program: snapshots and events.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Intent, Refusal, Safety};
use crate::{
    astro::Angle,
    clock::Instant,
    device::{
        AntennaState, Asked, Capabilities, Pointing, PrepareError, TrackTarget,
        settings::{GroupState, Held, Hindrance},
    },
    orbit::PropagationError,
    plan::{Barrier, Sample, Supervision, TrackPhase, TrackStats},
    station::LockOut,
};

/// One antenna at one instant. Replaced as a whole, never changed in place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The link.
    pub link: LinkState,
    /// It has moved on this program's word when it answered last, and does not answer.
    pub silent: bool,
    /// What the operator wants.
    pub intent: Intent,
    /// The intent is asked for but not yet proved by the device.
    pub pending: bool,
    /// Where a motion to a position ends.
    pub aim: Option<Pointing>,
    /// What is to be tracked.
    pub target: Option<TrackTarget>,
    /// How the unit tracks it by itself.
    pub on_board: Option<OnBoardView>,
    /// What this program follows with it, position by position.
    pub program_track: Option<TrackView>,
    /// It was moved from here, or a stop is owed, and standstill is not proved
    /// since.
    pub unproved: bool,
    /// The unit is locked out for maintenance.
    pub lock_out: Option<LockOut>,
    /// It is being locked out: that it stands and does not start by itself is not
    /// read back yet.
    pub locking: bool,
    /// The stop button.
    pub stop: StopState,
    /// A motion that this program has ended is not known to have come to rest.
    pub runs_out: bool,
    /// No dead-man could be had for the last motion by hand that needed one.
    pub unguarded: bool,
    /// It is where it must not point.
    pub inside: Option<Inside>,
    /// What is followed may lead to the Sun, by the operator's word.
    pub sun_lifted: bool,
    /// An earlier run may have left it moving, since then: the operator is asked.
    pub left_moving: Option<Timestamp>,
    /// Signed rates of a jog that is held, degrees a second.
    pub jog: Option<[f64; 2]>,
    /// How long it runs on after a STOP.
    pub stopping_way: StoppingWay,
    /// Signed amounts of a step that is not known to be over, degrees.
    pub step: Option<[f64; 2]>,
    /// What the device reported.
    pub state: AntennaState,
    /// The time between two questions at present.
    pub poll_period: Duration,
}

impl Snapshot {
    /// What there is to show before the session runs.
    pub fn before_anything(link: LinkState) -> Self {
        Self {
            link,
            silent: false,
            intent: Intent::Standby,
            pending: false,
            aim: None,
            target: None,
            on_board: None,
            program_track: None,
            unproved: false,
            lock_out: None,
            locking: false,
            stop: StopState::Ready,
            runs_out: false,
            unguarded: false,
            inside: None,
            sun_lifted: false,
            left_moving: None,
            jog: None,
            stopping_way: StoppingWay::default(),
            step: None,
            state: AntennaState::default(),
            poll_period: Duration::from_millis(500),
        }
    }
}

impl Snapshot {
    /// Whether a STOP of the whole station is for this antenna too. A unit to which
    /// nobody wants a link and that was not moved from here is left to whoever
    /// stands in front of it.
    pub fn wants_stop(&self) -> bool {
        let owed = matches!(self.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. });
        self.link != LinkState::Off || self.unproved || owed
    }

    /// Why the gate would refuse a setting that decides where the antenna points,
    /// at `now`.
    pub fn hindrance(&self, can: Capabilities, now: Instant) -> Option<Hindrance> {
        if matches!(self.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. }) {
            return Some(Hindrance::Stopping);
        }
        let told = self.pending
            || self.intent == Intent::Track
            || self.program_track.is_some()
            || self.jog.is_some()
            || self.step.is_some();
        Hindrance::of(&self.state, can, now).or(told.then_some(Hindrance::Moves))
    }

    /// Whether nothing but ages and counters differ. The window shows those
    /// with the next tick of its clock; a frame of their own is not worth it.
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
        if !same_settings(&self.state.held, &newer.state.held) {
            return false;
        }
        let mut newer = newer.clone();
        newer.state.measured = self.state.measured;
        newer.state.traffic = self.state.traffic;
        newer.state.checked_at = self.state.checked_at;
        newer.state.held = Arc::clone(&self.state.held);
        newer.state.on_board.clock = self.state.on_board.clock;
        if let (Some(old), Some(new)) = (&self.program_track, &mut newer.program_track) {
            new.next_look = old.next_look;
            new.stats = old.stats;
            new.predicted = old.predicted;
        }
        *self == newer
    }
}

/// Whether the same is known of the settings, and the same is being done. What
/// the device reports anew of its own accord is shown with the next tick.
fn same_settings(old: &Held, new: &Held) -> bool {
    let shown = |state: &GroupState| {
        (state.held.is_some(), state.failure.clone(), state.step, state.written.clone())
    };
    old.len() == new.len() && old.values().map(shown).eq(new.values().map(shown))
}

/// How long the axes run on at their rate after a STOP.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct StoppingWay {
    /// That is reckoned with, seconds.
    pub overrun_s: f64,
    /// In so many STOPs it was seen.
    pub stops: u32,
    /// It was measured; until then it is the figure of the make.
    pub is_learned: bool,
}

impl StoppingWay {
    /// So many STOPs have to be seen before they replace the figure of the make.
    pub const ENOUGH: u32 = 3;
}

/// What an antenna is inside of that is forbidden.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inside {
    /// What it is.
    pub barrier: Barrier,
    /// By the operator's word it may be moved out by hand now.
    pub may_leave: bool,
}

/// What the unit tracks by itself, and how well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnBoardView {
    /// How it will follow by what it tells of itself.
    pub found: Arc<Supervision>,
    /// How far it is off the satellite, where that has lasted longer than turning to
    /// it explains.
    pub missing: Option<Angle>,
}

/// What is followed position by position, and how well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackView {
    /// Of the target.
    pub name: String,
    /// Of a satellite, up to nine digits.
    pub catalog_number: Option<u32>,
    /// Where it is in its passes.
    pub phase: TrackPhase,
    /// How well it is followed, and the number of commands.
    pub stats: TrackStats,
    /// It waits for the operator's word, because the antenna was out of sight.
    pub awaits_word: bool,
    /// When it is looked at next whether the antenna is where it should be.
    pub next_look: Option<Instant>,
    /// Where the antenna was sent last; `None` before the first position.
    pub commanded: Option<Pointing>,
    /// Where the target stood when the antenna was measured last; `None` unless
    /// it is followed right now.
    pub predicted: Option<Sample>,
}

/// The link to a controller.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkState {
    /// Nobody wants one: the operator has not connected or has disconnected, or
    /// the session has ended.
    Off,
    /// Trying, for the first time since the start.
    Connecting {
        /// Since when.
        since: Instant,
    },
    /// Open, with good replies.
    Up {
        /// Since when.
        since: Instant,
    },
    /// Open, but the last good reply is older than two poll periods.
    Stale {
        /// When the last good reply came.
        last_reply: Instant,
    },
    /// Gone, or silent for too long. It is tried again by itself.
    Lost {
        /// When the last good reply came, or the link went.
        since: Instant,
        /// Why.
        reason: LinkLoss,
        /// When it is tried again.
        retry_at: Instant,
    },
}

impl LinkState {
    /// Whether bytes can be sent.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Up { .. } | Self::Stale { .. })
    }
}

/// Why a link is lost.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkLoss {
    /// The other end is not there or does not want us; in the words of the
    /// operating system.
    Refused(String),
    /// No connection in time.
    ConnectTimeout,
    /// The other end closed it.
    Closed,
    /// It broke; in the words of the operating system.
    Broken(String),
    /// Open, but no reply.
    Silent,
    /// The computer slept: it is opened anew.
    Slept,
    /// Open, but no reply that can be read.
    Unreadable,
    /// Open, but to another device, or to one that wants to be told a code.
    OtherDevice,
}

/// The stop button of one antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopState {
    /// Nothing was asked.
    Ready,
    /// Sent, or to be sent first thing when the link is back.
    Stopping {
        /// When it was pressed.
        since: Instant,
    },
    /// The device reports standstill.
    Stopped {
        /// When it did.
        at: Instant,
    },
    /// No standstill within three seconds.
    NotConfirmed {
        /// When it was pressed.
        since: Instant,
    },
}

/// Something that happened, for the event line and the alarm list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// The link went.
    LinkLost(LinkLoss),
    /// The link came for the first time, and the device was read.
    Connected(Found),
    /// The device has begun to track without having been asked to.
    StartedByItself,
    /// The link is back, and the device was read.
    Back {
        /// How long it was silent.
        after: Duration,
        /// What the device was found doing.
        found: Found,
    },
    /// The gate did not let it through.
    NotSent(Refusal),
    /// The device said no; its code as it came.
    Refused(Asked, String),
    /// No answer to a motion, which is not sent again.
    Unanswered(Asked),
    /// A satellite cannot be tracked.
    CannotTrack(TrackTarget, PrepareError),
    /// By what the device tells of itself it would miss the satellite of this name.
    WouldMiss {
        /// Name of the satellite.
        name: String,
        /// By how much and why.
        found: Arc<Supervision>,
    },
    /// The device tracks.
    Tracking(TrackTarget),
    /// The device has ended tracking by itself.
    TrackingEnded {
        /// At the end of the pass, not before.
        completed: bool,
    },
    /// The antenna goes to where this target will rise, and waits there.
    Awaits {
        /// Name of the target.
        name: String,
        /// When it rises.
        aos: Timestamp,
    },
    /// The antenna follows the target of this name, position by position.
    ProgramTracks(String),
    /// The last pass of a target is over.
    ProgramTrackOver {
        /// Name of the target.
        name: String,
        /// How well it was followed.
        stats: TrackStats,
    },
    /// The target of this name cannot be followed, or no further.
    CannotProgramTrack(String, TrackProblem),
    /// A motion to a position has arrived.
    Arrived(Pointing),
    /// A motion to a position ended elsewhere.
    EndedShort {
        /// Where it should have gone.
        aim: Pointing,
        /// Where it is.
        at: Pointing,
    },
    /// The window did not renew a jog; it was stopped.
    JogLeaseOver,
    /// A jog was ended because the position grew too old.
    JogPositionOld,
    /// A matter of safety.
    Safety(Safety),
    /// The antenna stands still after a stop.
    Stopped,
    /// It still moves three seconds after a stop.
    StopNotConfirmed,
    /// The device refused a stop; its code as it came.
    StopRefused(String),
    /// The antenna is stopped, but the device may start to track by itself.
    AutoTrackStillOn,
    /// The device did not switch its auto-track off.
    AutoStaysOn,
    /// The unit is locked out, and that its auto-track is off cannot be read back.
    LockOutUnproved,
}

/// Why a target cannot be followed, or no further.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum TrackProblem {
    /// It does not rise any more in the time that was looked at.
    #[error("there is no pass to come")]
    NoPass,
    /// Its elements describe no orbit, or it has come down.
    #[error(transparent)]
    Orbit(#[from] PropagationError),
    /// The gate does not let the antenna go where it has to.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl TrackProblem {
    /// Where the antenna must not point, where that is why.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Refused(refusal) => refusal.barrier(),
            Self::NoPass | Self::Orbit(_) => None,
        }
    }
}

/// What a device was found doing when its link came back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Found {
    /// It tracks.
    Tracking,
    /// It moves, and not by its tracking program.
    Moving,
    /// It stands still.
    Still,
}
