//! One line for each other antenna.

use egui::{Align2, Rect, Role, Ui, pos2, vec2};

use super::Cursor;
use crate::{
    contract::antenna::AntennaModel,
    model::{Model, UiCommand},
    station::AntennaId,
    ui::{
        bar, format,
        icons::{self, Icon},
        state_sentence::state_sentence,
        text::{self, Weight},
        theme,
        widgets::{fold, link_chip::ALARM, paint},
    },
};

/// Height of a line with its sentence, points.
const HEIGHT: f32 = 48.0;

/// Shows a line for each antenna without a card. A low window omits the sentences.
pub(super) fn show(
    ui: &Ui,
    cursor: &mut Cursor,
    model: &Model,
    on_cards: &[AntennaId],
    commands: &mut Vec<UiCommand>,
) {
    for (index, antenna) in model.antennas.iter().enumerate() {
        if !on_cards.contains(&antenna.id()) && show_line(ui, cursor, index, model, antenna) {
            commands.push(UiCommand::SelectAntenna(index));
        }
    }
}

/// Returns the last known direction, or a note on maintenance; empty if unknown.
fn direction(antenna: &AntennaModel) -> String {
    let snapshot = &antenna.snapshot;
    if snapshot.lock_out.is_some() {
        return "in maintenance".to_owned();
    }
    let Some(measured) = snapshot.state.measured else { return String::new() };
    let position = format::pointing(measured.pointing, antenna.variant().capabilities);
    if position.is_empty() || snapshot.link.is_open() {
        position
    } else {
        format!("last {position}")
    }
}

fn show_line(
    ui: &Ui,
    cursor: &mut Cursor,
    index: usize,
    model: &Model,
    antenna: &AntennaModel,
) -> bool {
    let is_short = cursor.is_short();
    let row = cursor.take_across(if is_short { fold::HEIGHT } else { HEIGHT });
    let sentence = state_sentence(model, antenna).text();
    let alarm = bar::alarm(model, antenna);
    let t = theme::tokens(ui);
    let summary = match &alarm {
        Some(alarm) => format!("{ALARM}: {alarm} {sentence}"),
        None => sentence.clone(),
    };
    let name = format!("Show {}: {summary}", antenna.config.name);
    let response = paint::control(ui, ("other", index), row, Role::Button, true, &name);
    if response.hovered() {
        ui.painter().rect_filled(row, 0.0, t.bg3);
    }
    ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    let first = if is_short { row } else { row.with_max_y(row.top() + 28.0) };
    let y = first.center().y;
    let (icon, colour) = bar::glyph(model, antenna).look(t);
    icons::paint(ui.painter(), paint::square(pos2(cursor.left + 7.0, y), 12.0), icon, colour);
    let chevron = paint::square(pos2(cursor.right - 6.0, y), 12.0);
    icons::paint(ui.painter(), chevron, Icon::ChevronRight, t.t2);
    let start = pos2(cursor.left + 22.0, y);
    let name = &antenna.config.name;
    let title = paint::text(ui, start, Align2::LEFT_CENTER, name, text::body_medium(), t.t1);
    let mut room = first.with_min_x(title.right() + 8.0).with_max_x(chevron.left() - 8.0);
    if alarm.is_some() {
        let font = text::sized(12.0, Weight::SemiBold);
        let word = paint::text_in(ui, room, Align2::LEFT_CENTER, ALARM, font, t.bad);
        room = room.with_min_x(word.right() + 8.0);
    }
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &direction(antenna), text::body(), t.t1);
    if !is_short {
        let below =
            Rect::from_min_max(pos2(start.x, first.bottom()), pos2(cursor.right, row.bottom()));
        let below = below.translate(vec2(0.0, -4.0));
        paint::text_in(ui, below, Align2::LEFT_CENTER, &sentence, text::small(), t.t2);
    }
    paint::focus_ring(ui, &response, 0);
    response.on_hover_text(summary).clicked()
}
