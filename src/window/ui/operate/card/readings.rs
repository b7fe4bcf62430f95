//! Readings that a unit reports about itself, line by line.

use egui::{Align2, Color32, Rect, Ui, pos2};

use super::Cursor;
use crate::{
    device::panel::{Reading, Tone},
    ui::{
        icons::{self, Icon},
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

const LINE_HEIGHT: f32 = 22.0;
/// Room for the bar below a line, points.
const BAR_HEIGHT: f32 = 6.0;
/// Max share of the width for the label, 0 to 1.
const LABEL_SHARE: f32 = 0.45;

/// Returns the mark and the colour of a value.
fn look(tone: Tone, t: &Tokens) -> (Option<Icon>, Color32) {
    match tone {
        Tone::Plain | Tone::Change => (None, t.t1),
        Tone::Good => (Some(Icon::Check), t.ok),
        Tone::Caution => (Some(Icon::Warning), t.warn),
        Tone::Bad => (Some(Icon::Cross), t.bad),
    }
}

/// Returns the most important reading for the fold: the most severe, otherwise the first.
pub(super) fn in_words(ui: &Ui, readings: &[Reading]) -> (String, Option<(Icon, Color32)>) {
    let find_tone = |tone: Tone| readings.iter().find(|reading| reading.tone == tone);
    let Some(reading) =
        find_tone(Tone::Bad).or_else(|| find_tone(Tone::Caution)).or(readings.first())
    else {
        return (String::new(), None);
    };
    let (icon, colour) = look(reading.tone, theme::tokens(ui));
    (format!("{} {}", reading.label, reading.text), icon.map(|icon| (icon, colour)))
}

pub(super) fn show(ui: &Ui, cursor: &mut Cursor, readings: &[Reading], has_head: bool) {
    let t = theme::tokens(ui);
    if has_head {
        let head = cursor.take(20.0);
        let words = "Reported by the unit";
        paint::text(ui, head.left_center(), Align2::LEFT_CENTER, words, text::caption(), t.t3);
    }
    for reading in readings {
        let line = cursor.take(LINE_HEIGHT);
        show_line(ui, line, reading, t);
        if let Some(share) = reading.share {
            show_bar(ui, cursor.take(BAR_HEIGHT), share, t);
        }
    }
    cursor.skip(6.0);
}

fn show_line(ui: &Ui, line: Rect, reading: &Reading, t: &Tokens) {
    let room = line.with_max_x(line.left() + LABEL_SHARE * line.width());
    let label = paint::text_in(ui, room, Align2::LEFT_CENTER, &reading.label, text::small(), t.t2);
    let (icon, colour) = look(reading.tone, t);
    let mut room = line.with_min_x(label.right() + 8.0);
    if icon.is_some() {
        room = room.with_min_x(room.left() + 18.0);
    }
    let font = text::small_strong();
    let value = paint::text_in(ui, room, Align2::RIGHT_CENTER, &reading.text, font, colour);
    if let Some(icon) = icon {
        let mark = paint::square(pos2(value.left() - 10.0, line.center().y), 13.0);
        icons::paint(ui.painter(), mark, icon, colour);
    }
    let words = format!("{}: {}", reading.label, reading.text);
    let named = paint::name_text(ui, ("reading", &reading.label), line, &words);
    if paint::text_width(ui, &reading.text, text::small_strong()) > room.width() {
        named.on_hover_text(words);
    }
}

fn show_bar(ui: &Ui, room: Rect, share: f64, t: &Tokens) {
    let track = Rect::from_min_max(room.left_top(), pos2(room.right(), room.top() + 4.0));
    ui.painter().rect_filled(track, 0.0, t.bg3);
    let full = track.left() + share.clamp(0.0, 1.0) as f32 * track.width();
    ui.painter().rect_filled(track.with_max_x(full), 0.0, t.ant);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn every_line_is_said_and_the_gravest_stands_for_all() {
        let readings = [
            Reading::new("Satellite", "TÜRKSAT 4A"),
            Reading::new("AGC", "43 %").with_bar(0.43).in_tone(Tone::Caution),
            Reading::new("Alarm", "none"),
        ];
        let window = testing::window([320.0, 120.0], readings, |ui, readings| {
            let mut cursor = Cursor::new(ui.max_rect());
            show(ui, &mut cursor, readings, true);
            assert_eq!(in_words(ui, readings).0, "AGC 43 %");
            assert_eq!(in_words(ui, readings.get(2..).unwrap_or_default()).0, "Alarm none");
            assert_eq!(in_words(ui, &[]).0, "");
        });
        window.get_by_label("Satellite: TÜRKSAT 4A");
        window.get_by_label("AGC: 43 %");
    }
}
