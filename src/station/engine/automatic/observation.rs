//! State of an antenna for automatic operation, taken from its snapshot.

use super::operation::Observation;
use crate::{
    clock::Instant,
    contract::{
        antenna::AntennaModel,
        automatic::NotReady,
        driver::{Intent, Snapshot, StopState},
    },
    device::Axis,
};

pub(super) fn observe(antenna: &AntennaModel, now: Instant) -> Observation {
    let snapshot = &antenna.snapshot;
    let moves = snapshot.state.measured.is_some_and(|measured| measured.moving());
    let stops =
        matches!(snapshot.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. });
    let takes = antenna.tracked_number().filter(|_| !antenna.tracks_unasked());
    // Somebody has given the unit another satellite than Azel requested.
    let requested = snapshot.target.as_ref().map(|target| target.catalog_number);
    let is_replaced = antenna.is_live()
        && snapshot.intent == Intent::Track
        && !snapshot.pending
        && snapshot.state.program.is_some_and(|program| program.enabled)
        && requested.is_some_and(|requested| takes.is_some_and(|takes| takes != requested));
    Observation {
        is_live: antenna.is_live(),
        is_silent: antenna.is_silent(now),
        is_locked_out: snapshot.lock_out.is_some(),
        can_be_sent: !stops
            && snapshot.state.measured_on_link().is_some()
            && !snapshot.being_compared
            && snapshot.left_moving.is_none()
            && antenna.held_by.is_none(),
        not_ready: not_ready(snapshot, antenna.variant().capabilities.axis_count()),
        takes: takes.filter(|number| antenna.takes(*number)),
        is_proved: !snapshot.pending,
        awaits_operator: snapshot.program_track.as_ref().is_some_and(|view| view.awaits_operator),
        offers: antenna
            .tracked_number()
            .filter(|_| antenna.tracks_unasked() && snapshot.on_board.is_some()),
        may_be_planned: false,
        moves,
        turns_unasked: antenna.is_live() && moves && !is_asked(snapshot),
        is_moved_elsewhere: is_replaced || antenna.is_live() && antenna.tracks_unasked(),
    }
}

/// Returns the reason why the antenna is not ready. At a limit, an axis may report no angle.
fn not_ready(snapshot: &Snapshot, axes: usize) -> Option<NotReady> {
    if snapshot.state.motion_lock == Some(true) {
        return Some(NotReady::Fault);
    }
    let has_place = |axis: &Axis| axis.angle_deg.is_some() || axis.plus_limit || axis.minus_limit;
    let measured = snapshot.state.measured?;
    let has_positions = measured.axes.iter().take(axes).all(has_place);
    (!has_positions).then_some(NotReady::NoPosition)
}

/// Returns `true` if a request of Azel may still move the antenna.
fn is_asked(snapshot: &Snapshot) -> bool {
    snapshot.intent == Intent::Track
        || snapshot.pending
        || snapshot.runs_out
        || snapshot.jog.is_some()
        || snapshot.step.is_some()
}
