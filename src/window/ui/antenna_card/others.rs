//! One line for each other antenna.

use egui::{Align2, Rect, Role, Ui, pos2, vec2};

use super::{CardAction, Cursor};
use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    widgets::{
        fold,
        link_chip::{ALARM, LinkGlyph},
        paint,
    },
};

/// Height of a line with its sentence.
const HEIGHT: f32 = 48.0;

/// Summary of another antenna.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherAntenna {
    /// Index among all antennas.
    pub index: usize,
    pub name: String,
    pub link: LinkGlyph,
    /// Last known direction; empty if unknown.
    pub pointing: String,
    /// The state sentence.
    pub sentence: String,
    /// The gravest red alarm that stands for the antenna, in words.
    pub alarm: Option<String>,
}

/// Shows the lines, in a low window without sentences.
pub(super) fn show(
    ui: &Ui,
    at: &mut Cursor,
    card: Rect,
    others: &[OtherAntenna],
    short: bool,
    actions: &mut Vec<CardAction>,
) {
    for other in others {
        let row = at.take(if short { fold::HEIGHT } else { HEIGHT });
        let row = Rect::from_x_y_ranges(card.x_range(), row.y_range());
        if line(ui, row, at, other, short) {
            actions.push(CardAction::Select(other.index));
        }
    }
}

fn line(ui: &Ui, row: Rect, at: &Cursor, other: &OtherAntenna, short: bool) -> bool {
    let t = theme::tokens(ui);
    let about = match &other.alarm {
        Some(alarm) => format!("{ALARM}: {alarm} {}", other.sentence),
        None => other.sentence.clone(),
    };
    let name = format!("Show {}: {about}", other.name);
    let response = paint::control(ui, ("other", other.index), row, Role::Button, true, &name);
    if response.hovered() {
        ui.painter().rect_filled(row, 0.0, t.bg3);
    }
    ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    let first = if short { row } else { row.with_max_y(row.top() + 28.0) };
    let y = first.center().y;
    let (icon, colour) = other.link.look(t);
    icons::paint(ui.painter(), paint::square(pos2(at.left + 7.0, y), 12.0), icon, colour);
    let chevron = paint::square(pos2(at.right - 6.0, y), 12.0);
    icons::paint(ui.painter(), chevron, Icon::ChevronRight, t.t2);
    let start = pos2(at.left + 22.0, y);
    let title = paint::text(ui, start, Align2::LEFT_CENTER, &other.name, text::body_medium(), t.t1);
    let mut room = first.with_min_x(title.right() + 8.0).with_max_x(chevron.left() - 8.0);
    if other.alarm.is_some() {
        let font = text::sized(12.0, Weight::SemiBold);
        let word = paint::text_in(ui, room, Align2::LEFT_CENTER, ALARM, font, t.bad);
        room = room.with_min_x(word.right() + 8.0);
    }
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &other.pointing, text::body(), t.t1);
    if !short {
        let below = Rect::from_min_max(pos2(start.x, first.bottom()), pos2(at.right, row.bottom()));
        let below = below.translate(vec2(0.0, -4.0));
        paint::text_in(ui, below, Align2::LEFT_CENTER, &other.sentence, text::small(), t.t2);
    }
    paint::focus_ring(ui, &response, 0);
    response.on_hover_text(about).clicked()
}
