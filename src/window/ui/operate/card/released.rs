//! Controls for a unit without a connection.

use egui::{Align2, Rect, Role, Stroke, StrokeKind, Ui, pos2, vec2};

use super::{Card, Cursor};
use crate::{
    contract::{antenna::AntennaModel, driver::Command},
    model::UiCommand,
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::{
            button::{self, Button},
            paint,
        },
    },
};

/// Shows Connect and a separate STOP, because STOP in the top bar leaves this unit alone.
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>) {
    let is_locked = card.model.replay.is_some();
    let row = cursor.take(button::HEIGHT);
    let (connect, stop) = row.split_left_right_at_fraction(0.4);
    if Button::primary("Connect")
        .locked(is_locked)
        .show(ui, "connect", connect.with_max_x(connect.right() - 4.0))
        .clicked()
    {
        card.queue(Command::Connect);
    }
    if show_stop_key(ui, stop.with_min_x(stop.left() + 4.0), card.antenna, is_locked) {
        card.commands.push(UiCommand::StopAntenna(card.antenna.id()));
    }
    cursor.skip(6.0);
}

/// Shows the effect of STOP on a unit without a connection.
pub(super) fn show_stop_note(ui: &Ui, cursor: &mut Cursor, antenna: &AntennaModel) {
    let t = theme::tokens(ui);
    let note = stop_note(antenna);
    let place = paint::paragraph(ui, cursor.position(), cursor.width(), &note, text::small(), t.t2);
    paint::name_text(ui, "about stop of a released unit", place, &note);
    cursor.y = place.bottom() + 6.0;
}

fn stop_note(antenna: &AntennaModel) -> String {
    let effect = if antenna.variant().capabilities.waits_for_word {
        "takes control from anybody at its panel, and disconnects"
    } else {
        "disconnects again"
    };
    format!(
        "Connect and STOP {effect} when the antenna has stopped. STOP at the top does not reach this \
         unit."
    )
}

fn show_stop_key(ui: &Ui, rect: Rect, antenna: &AntennaModel, is_locked: bool) -> bool {
    let t = theme::tokens(ui);
    let (name, note) = (format!("Connect and STOP {}", antenna.config.name), stop_note(antenna));
    let colour = if is_locked { t.t3 } else { t.bad };
    let response =
        paint::control(ui, "stop a released unit", rect, Role::Button, !is_locked, &name);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(&*note));
    // Only STOP in the top bar has the fill of STOP.
    let border = Stroke::new(2.0, colour);
    ui.painter().rect(rect, button::RADIUS, t.bg3, border, StrokeKind::Inside);
    let words = "Connect and STOP";
    let font = text::sized(13.0, Weight::SemiBold);
    let width = paint::text_width(ui, words, font.clone()) + 22.0;
    let left = rect.center().x - width / 2.0;
    let glyph = paint::square(pos2(left + 8.0, rect.center().y), 16.0);
    icons::paint(ui.painter(), glyph, Icon::Octagon, colour);
    let room = rect.with_min_x(left + 22.0).shrink2(vec2(0.0, 2.0));
    paint::text_in(ui, room, Align2::LEFT_CENTER, words, font, colour);
    paint::focus_ring(ui, &response, button::RADIUS);
    response.on_hover_text(note).clicked()
}
