//! Head of the view: the unit, the progress of its reading, and actions on the whole unit.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::unit::ShownUnit;
use crate::{
    astro::time::seconds_between,
    contract,
    contract::driver::Command,
    model::UiCommand,
    ui::{
        format, text, theme,
        widgets::{
            button::{self, Button},
            paint,
        },
    },
};

pub(super) const HEIGHT: f32 = 56.0;
const PADDING: f32 = 16.0;
/// Time for which the view shows the path of a saved copy, seconds.
const SAVED_S: f64 = 30.0;

pub(super) fn show(ui: &Ui, rect: Rect, unit: &ShownUnit<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let antenna = unit.antenna.id();
    let groups = unit.antenna.groups();
    let is_read = is_read(unit);
    let mut right = rect.right() - PADDING;
    if !groups.is_empty() {
        let read = Button::normal("Read again").locked(!unit.is_open());
        let compare = Button::normal("Compare with file").locked(!is_read);
        let save = Button::normal("Save copy").locked(!is_read);
        let widths = [read, compare, save].map(|button| button.width(ui));
        let [of_read, of_compare, of_save] = button::row(pos2(right, rect.center().y), widths);
        if read.show(ui, "Read again", of_read).clicked() {
            let read = |key| UiCommand::antenna(antenna, Command::ReadGroup(key));
            commands.extend(groups.iter().map(|group| read(group.key)));
        }
        if compare.show(ui, "Compare with file", of_compare).clicked() {
            commands.push(UiCommand::Station(contract::Command::CompareSettings(antenna)));
        }
        if save.show(ui, "Save copy", of_save).clicked() {
            commands.push(UiCommand::Station(contract::Command::SaveSettings(antenna)));
        }
        right = of_read.left() - button::GAP;
    }
    let room = rect.with_min_x(rect.left() + PADDING).with_max_x(right);
    let title = format!("{} settings", unit.name());
    let up = room.translate(vec2(0.0, -9.0));
    paint::text_in(ui, up, Align2::LEFT_CENTER, &title, text::title(), t.t1);
    paint::name_text(ui, "settings title", up.with_max_y(rect.center().y), &title);
    let (words, colour) = match saved(unit) {
        Some(Ok(words)) => (words, t.ok),
        Some(Err(words)) => (words, t.bad),
        None => {
            let address = unit.antenna.config.connection.address.as_str();
            let words = read(unit).map_or_else(String::new, |read| format!(", {read}"));
            (format!("{address}{words}"), t.t2)
        }
    };
    let down = room.translate(vec2(0.0, 13.0));
    paint::text_in(ui, down, Align2::LEFT_CENTER, &words, text::small(), colour);
    let place = down.with_min_y(rect.center().y + 4.0).with_max_y(rect.bottom());
    let named = paint::name_text(ui, "settings read", place, &words);
    if !paint::fits(ui, &words, text::small(), down) {
        named.on_hover_text(&words);
    }
}

/// Returns the path of the copy that Azel just saved, or the error.
fn saved(unit: &ShownUnit<'_>) -> Option<Result<String, String>> {
    let saving = unit.model.copies.saved.as_ref()?;
    let is_news = seconds_between(saving.time, unit.model.now) < SAVED_S;
    (is_news && saving.antenna == unit.name()).then(|| match &saving.result {
        Ok(path) => Ok(format!("Saved as {}", path.display())),
        Err(reason) => Err(format!("Not saved: {reason}")),
    })
}

fn is_read(unit: &ShownUnit<'_>) -> bool {
    unit.antenna.groups().iter().any(|group| unit.values(group.key).is_some())
}

/// Describes how much of the unit Azel has read; `None` for a unit without groups of settings.
fn read(unit: &ShownUnit<'_>) -> Option<String> {
    let groups = unit.antenna.groups();
    if groups.is_empty() {
        return None;
    }
    if !unit.is_open() {
        let words = if is_read(unit) { "showing values read earlier" } else { "nothing read yet" };
        return Some(format!("no link, {words}"));
    }
    let missing: Vec<&str> =
        groups.iter().filter(|group| !unit.is_fresh(group.key)).map(|group| group.title).collect();
    let oldest = groups.iter().filter_map(|group| unit.read_at(group.key)).min();
    Some(match (missing.as_slice(), oldest) {
        ([], Some(oldest)) => format!("all groups read {}", format::moment(oldest, unit.model.now)),
        (missing, _) => format!("not read: {}", missing.join(", ")),
    })
}
