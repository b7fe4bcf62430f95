//! Sentences while the unit is locked out for maintenance.

use super::Spoken;
use crate::{
    contract::{
        antenna::AntennaModel,
        driver::{LinkState, StopState},
    },
    ui::{format, widgets::sentence::SentenceKind},
};

pub(super) fn sentence(antenna: &AntennaModel) -> Option<Spoken> {
    let snapshot = &antenna.snapshot;
    let lock_out = snapshot.lock_out.as_ref()?;
    // An unconfirmed stop is more severe than the lock-out.
    if matches!(snapshot.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. }) {
        return None;
    }
    let moves = snapshot.state.measured.is_some_and(|measured| measured.moving());
    let after = match snapshot.link {
        LinkState::Off => " It is not connected.",
        LinkState::Connecting { .. } | LinkState::Lost { .. } => " It does not answer.",
        _ if moves => " It is moving, but not by this console.",
        _ if snapshot.locking => " The unit has not confirmed yet that auto-track is off.",
        _ => "",
    };
    let lead =
        if snapshot.locking { "Being locked out by " } else { "In maintenance, locked out by " };
    Some(Spoken::new(SentenceKind::Caution).plain(lead).bold(&lock_out.operator).plain(format!(
        " since {}: {}. Only queries and STOP go to it.{after}",
        start_of_lock_out(antenna),
        lock_out.reason.trim_end_matches('.'),
    )))
}

/// Returns the start of the lock-out, with the day.
fn start_of_lock_out(antenna: &AntennaModel) -> String {
    let start = antenna.snapshot.lock_out.as_ref().map(|lock_out| lock_out.start);
    start.map_or_else(String::new, format::dated)
}
