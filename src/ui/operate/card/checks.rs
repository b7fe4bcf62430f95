//! The checks of a unit as the card shows them.

use jiff::Timestamp;

use crate::{
    app::antenna::AntennaModel,
    controller::{
        panel::{Check, CheckState},
        satrak,
    },
    protocol::satrak::FaultKind,
    ui::words,
};

/// When the unit reported its checks.
pub(super) fn read_at(antenna: &AntennaModel) -> Option<Timestamp> {
    let state = &antenna.snapshot.state;
    state.satrak.faults.as_ref().map(|(_, at)| *at).or(state.checked_at)
}

/// The checks of the unit; those of a Satrak also before it has reported them.
pub(super) fn of(antenna: &AntennaModel) -> Vec<Check> {
    let state = &antenna.snapshot.state;
    if antenna.make().key != satrak::MAKE.key {
        return state.checks.to_vec();
    }
    let faults = state.satrak.faults.as_ref().map(|(faults, _)| faults);
    let check = |kind: FaultKind| Check {
        name: words::fault_name(kind),
        state: match faults.and_then(|faults| faults.state(kind)) {
            None => CheckState::Unknown,
            Some(state) if !state.is_set() => CheckState::Good,
            Some(_) if kind.is_warning() => CheckState::Caution,
            Some(_) => CheckState::Fault,
        },
        advice: words::fault_advice(kind),
    };
    FaultKind::ALL.into_iter().map(check).collect()
}
