//! Reports of the unit about itself: versions, its own time stamp, its checks.

use egui::Ui;

use crate::ui::antennas::cards::{fields, subtitle};
use crate::{
    controller::satrak::settings::{POSITION, VERSIONS},
    device::panel::{Check, CheckState},
    ui::{
        antennas::{form::Form, row, unit::ShownUnit},
        format,
        icons::Icon,
        theme,
    },
};

pub(super) fn show(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form) {
    fields(ui, unit, form, VERSIONS.key, |_| true);
    subtitle(ui, "Position with the unit's own time");
    fields(ui, unit, form, POSITION.key, |_| true);
    let t = theme::tokens(ui);
    let state = &unit.antenna.snapshot.state;
    let Some(read_at) = state.checked_at else {
        subtitle(ui, "Faults");
        return row::note(ui, Some(Icon::Dash), "The unit has not reported its checks.", t.t3);
    };
    subtitle(ui, &format!("Faults, read {}", format::moment(read_at, unit.model.now)));
    for check in state.checks.iter() {
        show_check(ui, check);
    }
}

fn show_check(ui: &mut Ui, check: &Check) {
    let t = theme::tokens(ui);
    let (icon, word, colour) = match check.state {
        CheckState::Unknown => (Icon::Dash, "Not reported", t.t3),
        CheckState::Good => (Icon::Check, "Good", t.ok),
        CheckState::Caution => (Icon::Warning, "Caution", t.warn),
        CheckState::Fault => (Icon::Cross, "Fault", t.bad),
    };
    let word = if check.unit_text.is_empty() { word } else { check.unit_text.as_ref() };
    let is_good = check.state == CheckState::Good;
    let description = if is_good { check.when_good } else { "" };
    row::plain(ui, check.name, description, Some((Some(icon), word, colour)));
    if matches!(check.state, CheckState::Caution | CheckState::Fault) {
        row::note(ui, None, check.advice, t.t2);
    }
}
