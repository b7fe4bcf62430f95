//! Name of the antenna and who controls it.

use egui::{Align2, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

use super::Cursor;
use crate::ui::{
    icons,
    text::{self, Weight},
    theme,
    widgets::{link_chip::LinkGlyph, paint},
};

/// Who may move the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control<'a> {
    /// This console.
    You,
    /// Somebody else, in words such as "Local panel".
    Other(&'a str),
    /// The unit does not say, or does not answer.
    Unknown,
}

/// The head of the card.
#[derive(Debug, Clone, Copy)]
pub struct HeaderModel<'a> {
    /// Name of the antenna.
    pub name: &'a str,
    /// What it is: size, mount, ability.
    pub second_line: &'a str,
    /// How its link stands.
    pub link: LinkGlyph,
    /// Who controls it.
    pub control: Control<'a>,
}

pub(super) fn show(ui: &Ui, at: &mut Cursor, model: &HeaderModel<'_>, card: Rect, short: bool) {
    let t = theme::tokens(ui);
    let row = at.take(if short { 44.0 } else { 56.0 });
    ui.painter().hline(card.x_range(), row.bottom() - 0.5, (1.0, t.line));
    let y = row.center().y;
    let (icon, colour) = model.link.look(t);
    let glyph = paint::square(pos2(row.left() + 8.0, y), 15.0);
    icons::paint(ui.painter(), glyph, icon, colour);

    let tag_left = control_tag(ui, row, model.control);
    let name_room = row.with_min_x(row.left() + 24.0).with_max_x(tag_left - 6.0);
    if short {
        paint::text_in(ui, name_room, Align2::LEFT_CENTER, model.name, text::value(), t.t1);
    } else {
        let up = name_room.translate(vec2(0.0, -8.0));
        paint::text_in(ui, up, Align2::LEFT_CENTER, model.name, text::value(), t.t1);
        let down = name_room.translate(vec2(0.0, 10.0));
        paint::text_in(ui, down, Align2::LEFT_CENTER, model.second_line, text::small(), t.t2);
    }
    let words = format!("{}, {}, link {}", model.name, model.second_line, model.link.word());
    let named = paint::name_text(ui, "header", name_room, &words);
    named.on_hover_text(format!("{}\n{}", model.name, model.second_line));
}

/// Paints who controls and returns the left end of it.
fn control_tag(ui: &Ui, row: Rect, control: Control<'_>) -> f32 {
    let t = theme::tokens(ui);
    let (words, colour) = match control {
        Control::You => ("You have control", t.ok),
        Control::Other(who) => (who, t.warn),
        Control::Unknown => ("Control not known", t.t3),
    };
    let font = text::sized(11.0, Weight::SemiBold);
    let width = (paint::text_width(ui, words, font.clone()) + 12.0).min(0.5 * row.width());
    let size = vec2(width.ceil(), 18.0);
    let min = pos2(row.right() - size.x, row.center().y - size.y / 2.0);
    let tag = Rect::from_min_size(min, size);
    ui.painter().rect_stroke(tag, 3.0, Stroke::new(1.0, colour), StrokeKind::Inside);
    let room = tag.shrink2(vec2(4.0, 0.0));
    paint::text_in(ui, room, Align2::CENTER_CENTER, words, font, colour);
    paint::name_text(ui, "control", tag, words);
    tag.left()
}
