//! State of an antenna in the record: values that change occasionally, without the ones that change
//! with each measurement.

use serde::Serialize;

use crate::{
    astro::TrackOffsets,
    contract::{
        antenna::AntennaModel,
        automatic::Operation,
        driver::{Breach, Intent, LeftMoving, StopState},
    },
    device::{Phase, panel::CheckState},
    engine::{automatic::Operate, status::LinkStatus},
    plan::TrackPhase,
    station::LockOut,
};

#[derive(Debug, PartialEq, Serialize)]
pub(super) struct State {
    link: LinkStatus,
    intent: Intent,
    /// `true` until the unit proves the intent.
    is_pending: bool,
    /// `true` while the axes turn.
    moves: Option<bool>,
    /// Name and catalog number of the tracked satellite.
    tracks: Option<(Option<String>, Option<u32>)>,
    program_track: Option<TrackPhase>,
    /// Offsets of program track, or offsets that Azel added to the unit's own.
    offsets: Option<TrackOffsets>,
    on_board_track: Option<Phase>,
    auto_track: Option<bool>,
    stop: &'static str,
    /// `true` if Azel moved the antenna and standstill has not been proved since.
    is_unproved: bool,
    is_silent: bool,
    left_moving: Option<LeftMoving>,
    #[serde(rename = "inside")]
    breach: Option<Breach>,
    lock_out: Option<LockOut>,
    operation: Operation,
    /// Names of the checks with a caution or fault.
    faults: Vec<String>,
    held_by: Option<String>,
}

impl State {
    pub(super) fn new(antenna: &AntennaModel) -> Self {
        let snapshot = &antenna.snapshot;
        let program = snapshot.state.program;
        let bad = |state| matches!(state, CheckState::Caution | CheckState::Fault);
        let checks = snapshot.state.checks.iter().filter(|check| bad(check.state));
        let is_tracked = antenna.tracked_name().is_some() || antenna.tracked_number().is_some();
        Self {
            link: LinkStatus::new(antenna),
            intent: snapshot.intent,
            is_pending: snapshot.pending,
            moves: snapshot.state.measured.map(|measured| measured.moving()),
            tracks: is_tracked
                .then(|| (antenna.tracked_name().map(str::to_owned), antenna.tracked_number())),
            program_track: snapshot.program_track.as_ref().map(|view| view.phase),
            offsets: (snapshot.program_track.as_ref().map(|view| view.offsets))
                .or(snapshot.unit_offsets.as_ref().map(|unit| unit.offsets)),
            on_board_track: program.filter(|current| current.enabled).map(|program| program.phase),
            auto_track: program.and_then(|program| program.auto),
            stop: match snapshot.stop {
                StopState::Ready => "ready",
                StopState::Stopping { .. } => "stopping",
                StopState::Stopped { .. } => "stopped",
                StopState::NotConfirmed { .. } => "not_confirmed",
            },
            is_unproved: snapshot.unproved,
            is_silent: snapshot.silent,
            left_moving: snapshot.left_moving,
            breach: snapshot.breach.clone(),
            lock_out: snapshot.lock_out.clone(),
            operation: antenna.operation.clone().without_motion(),
            faults: checks.map(|check| check.name.to_string()).collect(),
            held_by: antenna.held_by.as_ref().map(ToString::to_string),
        }
    }
}
