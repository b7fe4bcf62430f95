//! Line of a setting, drawn from its description. All settings of all groups have such a line.

use egui::{Rect, Role, Sense, Ui, pos2, vec2};

use super::{
    draft::Draft,
    field_state::{self, FieldState},
    outcome::{self, HIDDEN},
    row::{self, Columns},
    unit::ShownUnit,
};
use crate::{
    astro::time::seconds_between,
    device::settings::{Access, Field, Group, Kind, Value},
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        widgets::{axes_table::UNKNOWN, hold_button, input::Input, paint},
        words,
    },
};

/// Shows the fields of `group` that `is_wanted` accepts. `is_revealed` makes a typed password
/// readable.
pub(super) fn show_all(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    group: &'static Group,
    draft: &mut Draft,
    is_revealed: &mut bool,
    is_wanted: fn(&Field) -> bool,
) {
    ui.push_id(group.key, |ui| {
        if !unit.is_fresh(group.key) {
            old_or_unread(ui, unit, group);
        }
        for field in group.fields.iter().filter(|field| is_wanted(field)) {
            show(ui, unit, group, field, draft, is_revealed);
        }
    });
}

/// Shows a note with the reason why the values are not current.
fn old_or_unread(ui: &mut Ui, unit: &ShownUnit<'_>, group: &Group) {
    let t = theme::tokens(ui);
    let reason = unit.failure(group.key).map(outcome::read_failure);
    let words = match (unit.read_at(group.key), unit.is_open(), reason) {
        (Some(time), _, _) => {
            let age = format::age(seconds_between(time, unit.model.now));
            format!("{}: values read {age} ago.", group.title)
        }
        (None, _, Some(reason)) => format!("{}: not read: {reason}.", group.title),
        (None, true, None) => format!("{}: being read.", group.title),
        (None, false, None) => format!("{}: not read yet; there is no link.", group.title),
    };
    row::note(ui, Some(Icon::OpenRing), &words, t.t3);
}

fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    group: &'static Group,
    field: &'static Field,
    draft: &mut Draft,
    is_revealed: &mut bool,
) {
    let t = theme::tokens(ui);
    let (state, _) = field_state::new(unit, group, field, draft);
    let columns = Columns::new(row::take(ui));
    paint::text_in(ui, columns.label, egui::Align2::LEFT_CENTER, field.label, text::small(), t.t1);
    let named = paint::name_text(ui, ("label", field.key), columns.label, field.label);
    if !field.description.is_empty() {
        named.on_hover_text(field.description);
    } else if !paint::fits(ui, field.label, text::small(), columns.label) {
        named.on_hover_text(field.label);
    }
    on_unit(ui, unit, group, field, &columns);
    if field.access != Access::Read {
        let is_long = matches!(field.kind, Kind::Text(_) | Kind::Password(_) | Kind::Time);
        let place = if is_long { columns.wide() } else { columns.new };
        if !is_long {
            paint_unit(ui, &columns, field);
        }
        edit(ui, unit, group, field, draft, is_revealed, (&state, place));
    }
    let (icon, colour) = state.mark().look(t);
    let word = state.word(unit.model.now);
    // Paint no word for an unchanged field: it would hide the few changed fields.
    let painted = if state == FieldState::Unchanged { "" } else { &word };
    row::state(ui, columns.state, icon, painted, colour, &format!("{}: {word}", field.label));
    below(ui, field, draft, &state);
    if *is_revealed && matches!(field.kind, Kind::Password(_)) {
        typed_password(ui, &draft.text(field, unit.values(group.key)));
    }
}

fn paint_unit(ui: &Ui, columns: &Columns, field: &Field) {
    let t = theme::tokens(ui);
    let room = columns.unit.with_min_x(columns.unit.left() + 3.0);
    paint::text_in(ui, room, egui::Align2::LEFT_CENTER, field.unit, text::small(), t.t3);
}

/// Shows the value on the unit; an open ring marks a value that is not current.
fn on_unit(ui: &Ui, unit: &ShownUnit<'_>, group: &Group, field: &Field, columns: &Columns) {
    let t = theme::tokens(ui);
    let value = unit.values(group.key).and_then(|current| current.get(field.key));
    let full = value.map(|value| outcome::shown(field, value)).filter(|shown| !shown.is_empty());
    let full = full.unwrap_or_else(|| missing(unit, group, field).to_owned());
    let short = match value {
        Some(Value::Time(time)) => format::moment(*time, unit.model.now),
        _ => full.clone(),
    };
    let mut room = if field.access == Access::Read {
        columns.on_unit.with_max_x(columns.unit.right())
    } else {
        columns.on_unit
    };
    let is_old = !unit.is_fresh(group.key);
    if is_old && value.is_some() {
        let ring = paint::square(pos2(room.left() + 5.0, room.center().y), 9.0);
        icons::paint(ui.painter(), ring, Icon::OpenRing, t.t3);
        room = room.with_min_x(room.left() + 13.0);
    }
    let old = if is_old && value.is_some() { ", old" } else { "" };
    let name = format!("{}, on the unit{old}: {full}", field.label);
    // A read-only line has no input field, which leaves room for the unit of measure.
    let short = if field.access == Access::Read && !field.unit.is_empty() && value.is_some() {
        format!("{short}{}{}", if field.unit == "°" { "" } else { " " }, field.unit)
    } else {
        short
    };
    let colour = if is_old { t.t3 } else { t.t2 };
    row::status_text(ui, room, &short, text::small(), colour, &name);
}

/// Returns the placeholder for a value that the unit never reports or has not reported.
fn missing(unit: &ShownUnit<'_>, group: &Group, field: &Field) -> &'static str {
    let is_read = unit.read_at(group.key).is_some();
    if is_read || field.access == Access::Write { outcome::NOT_REPORTED } else { "not read" }
}

fn edit(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    group: &Group,
    field: &'static Field,
    draft: &mut Draft,
    is_revealed: &mut bool,
    (state, place): (&FieldState, Rect),
) {
    let current = unit.values(group.key);
    let name = format!("{}, new value", field.label);
    let border = state.mark().border(theme::tokens(ui));
    let input = Input { rect: place, name: &name, border };
    let mut typed = draft.text(field, current);
    let is_password = matches!(field.kind, Kind::Password(_));
    let is_closed = group.is_service && !unit.is_unlocked;
    if !unit.is_open() || is_closed || !state.is_editable() {
        let words = match (state, is_password && !typed.is_empty()) {
            (FieldState::Unknown, _) if typed.is_empty() => UNKNOWN,
            (_, true) => HIDDEN,
            _ => &typed,
        };
        return input.inert(ui, words);
    }
    let eye = place.with_min_x(place.right() - 24.0);
    let rect = if is_password { place.with_max_x(eye.left() - 2.0) } else { place };
    if (Input { rect, ..input }).value(ui, &field.kind, &mut typed) {
        draft.type_in(field, typed, current);
    }
    if is_password {
        reveal(ui, eye, is_revealed);
    }
}

/// Shows the eye button, which reveals the typed text but never a value from the unit.
fn reveal(ui: &Ui, rect: Rect, is_revealed: &mut bool) {
    let t = theme::tokens(ui);
    let name = if *is_revealed { "Hide the typed password" } else { "Show the typed password" };
    let response = paint::control(ui, "reveal", rect, Role::Button, true, name);
    if response.clicked() {
        *is_revealed = !*is_revealed;
    }
    let colour = if *is_revealed { t.sat } else { t.t2 };
    icons::paint(ui.painter(), paint::square(rect.center(), 16.0), Icon::Eye, colour);
    paint::focus_ring(ui, &response, 4);
}

/// Paints the typed password without a label: a screen reader would speak it, and tools would
/// record it.
fn typed_password(ui: &mut Ui, typed: &str) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
    let area = Columns::new(rect).new.with_max_x(rect.right());
    let colour = theme::tokens(ui).t1;
    paint::text_in(ui, area, egui::Align2::LEFT_CENTER, typed, text::small(), colour);
}

/// Shows the problem of the value, or its confirmation, below the line.
fn below(ui: &mut Ui, field: &'static Field, draft: &mut Draft, state: &FieldState) {
    let t = theme::tokens(ui);
    match state {
        FieldState::Invalid(unfit) => {
            row::note(
                ui,
                None,
                &format!("{} {}.", field.label, words::unfit(unfit, field.unit)),
                t.bad,
            );
        }
        FieldState::NeedsService => {
            let words = format!("{}: unlock Service to send this value.", field.label);
            row::note(ui, Some(Icon::Lock), &words, t.warn);
        }
        FieldState::HeldBackBy(other) => {
            let words = format!(
                "{} is not sent until {other} can be sent too: both are sent together.",
                field.label
            );
            row::note(ui, Some(Icon::Warning), &words, t.warn);
        }
        FieldState::ConfirmFirst => {
            let value = draft.text(field, None);
            let words = format!("Hold 1 s to confirm {} {value}", field.label);
            let (rect, _) =
                ui.allocate_exact_size(vec2(ui.available_width(), row::HEIGHT), Sense::hover());
            let area = rect.shrink2(vec2(0.0, 2.0));
            if draft.hold(field.key).is_some_and(|hold| hold_button::show(ui, area, &words, hold)) {
                draft.confirm(field.key);
            }
        }
        _ => {}
    }
}
