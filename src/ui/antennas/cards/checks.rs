//! What the unit says of itself: versions, its own time stamp, its checks.

use egui::Ui;

use super::{fields, subtitle};
use crate::{
    protocol::satrak::{FaultKind, FaultState, Faults},
    ui::{
        antennas::{form::Form, row, unit::Unit},
        format,
        icons::Icon,
        theme, words,
    },
};

pub(super) fn show(ui: &mut Ui, unit: &Unit<'_>, form: &mut Form) {
    fields(ui, unit, form, "versions", |_| true);
    subtitle(ui, "Position with the unit's own time");
    fields(ui, unit, form, "position", |_| true);
    let t = theme::tokens(ui);
    let Some((faults, read_at)) = &unit.antenna.snapshot.state.satrak.faults else {
        subtitle(ui, "Faults");
        return row::note(ui, Some(Icon::Dash), "The unit has not reported its checks.", t.t3);
    };
    subtitle(ui, &format!("Faults, read {}", format::time_z(*read_at)));
    for kind in FaultKind::ALL {
        check(ui, faults, kind);
    }
}

fn check(ui: &mut Ui, faults: &Faults, kind: FaultKind) {
    let t = theme::tokens(ui);
    let (icon, word, colour) = match faults.state(kind) {
        None => (Icon::Dash, "Not reported".to_owned(), t.t3),
        Some(FaultState::Clear) => (Icon::Check, "Good".to_owned(), t.ok),
        Some(state) => {
            let (icon, colour) =
                if kind.is_warning() { (Icon::Warning, t.warn) } else { (Icon::Cross, t.bad) };
            let word = match state {
                FaultState::Disconnected => "Not connected".to_owned(),
                FaultState::Unknown(code) => format!("Unknown ({code})"),
                _ if kind.is_warning() => "Caution".to_owned(),
                _ => "Fault".to_owned(),
            };
            (icon, word, colour)
        }
    };
    let about = words::fault_about(kind);
    row::plain(ui, words::fault_name(kind), about, Some((Some(icon), &word, colour)));
    if faults.state(kind).is_some_and(FaultState::is_set) {
        row::note(ui, None, words::fault_advice(kind), t.t2);
    }
}
