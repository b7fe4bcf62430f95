//! A row of the list: thumbnail, three lines, progress.

use egui::{Align2, Color32, FontId, Rect, Ui, pos2};
use jiff::Timestamp;

use super::{
    PassRow, Verdict,
    phase::{self, Phase},
    thumbnail,
};
use crate::ui::{
    format,
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    tokens::Tokens,
    widgets::paint,
    words::WayThere,
};

/// Height of a row, with its divider, points.
pub(super) const HEIGHT: f32 = 74.0;

const PADDING: f32 = 16.0;
/// Gap between thumbnail and text, points.
const GAP: f32 = 12.0;
/// Centres of the three lines from the top of the row, points.
const LINES: [f32; 3] = [20.0, 38.5, 56.0];
/// Distance from the maximum elevation to the azimuths, points.
const AZIMUTHS: f32 = 62.0;
/// Gap between columns, points.
const COLUMN_GAP: f32 = 8.0;
/// Thickness of the progress line, points.
const BAR: f32 = 3.0;

/// Paints the row in `rect`. Returns `true` if a text was cut.
pub(super) fn paint(
    ui: &Ui,
    rect: Rect,
    row: &PassRow<'_>,
    now: Timestamp,
    has_thumbnail: bool,
) -> bool {
    let t = theme::tokens(ui);
    let phase = Phase::new(row, now);
    let mut left = rect.left() + PADDING;
    if has_thumbnail {
        let area =
            paint::square(pos2(left + thumbnail::SIDE / 2.0, rect.center().y), thumbnail::SIDE);
        thumbnail::paint(ui, area, row.path);
        left = area.right() + GAP;
    }
    let [first, second, third] = LINES.map(|down| {
        let start = pos2(left, rect.top() + down - 10.0);
        Rect::from_min_max(start, pos2(rect.right() - PADDING, start.y + 20.0))
    });
    let name_cut = name_line(ui, first, row, phase, now, t);
    shape_line(ui, second, row, t);
    let verdict_cut = verdict_line(ui, third, row, now, t);
    if let Some(done) = phase::progress(row, phase, now) {
        let track = rect.with_min_y(rect.bottom() - BAR);
        ui.painter().rect_filled(track, 0.0, t.line);
        let line = track.with_max_x(rect.left() + done * rect.width());
        ui.painter().rect_filled(line, 0.0, t.sat);
    }
    name_cut || verdict_cut
}

/// Paints the name and the countdown. Returns `true` if the name was cut.
fn name_line(
    ui: &Ui,
    rect: Rect,
    row: &PassRow<'_>,
    phase: Phase,
    now: Timestamp,
    t: &Tokens,
) -> bool {
    let (word, time) = phase::countdown(row, phase, now);
    let (font, colour) = match phase {
        Phase::AllTheTime | Phase::Over | Phase::NoLos => (text::small(), t.t2),
        Phase::Upcoming | Phase::InProgress => (text::value(), t.t1),
    };
    let time = paint::text(ui, rect.right_center(), Align2::RIGHT_CENTER, time, font, colour);
    let mut right = time.left();
    if !word.is_empty() {
        let position = pos2(right - 6.0, rect.center().y);
        right = paint::text(ui, position, Align2::RIGHT_CENTER, word, text::caption(), t.t3).left();
    }
    let room = rect.with_max_x(right - COLUMN_GAP);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::name_in(ui, room, Align2::LEFT_CENTER, row.name, font.clone(), t.t1);
    paint::text_width(ui, row.name, font) > room.width()
}

/// Paints the maximum elevation, the azimuths and the duration.
fn shape_line(ui: &Ui, rect: Rect, row: &PassRow<'_>, t: &Tokens) {
    let small = text::small;
    let maximum = format!("max {}", format::degrees(row.max_elevation_deg, 0));
    let room = rect.with_max_x(rect.left() + AZIMUTHS);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &maximum, small(), t.t2);
    let duration = phase::duration(row);
    let position = rect.right_center();
    let duration = paint::text(ui, position, Align2::RIGHT_CENTER, duration, small(), t.t2);
    let room = rect.with_min_x(room.right()).with_max_x(duration.left() - COLUMN_GAP);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &phase::azimuths(row), small(), t.t2);
}

/// Paints the verdict and the time of AOS. Returns `true` if the verdict was cut.
fn verdict_line(ui: &Ui, rect: Rect, row: &PassRow<'_>, now: Timestamp, t: &Tokens) -> bool {
    let position = rect.right_center();
    let time = phase::aos_time(row, now);
    let time = paint::text(ui, position, Align2::RIGHT_CENTER, time, text::small(), t.t3);
    let Some(verdict) = row.verdict else { return false };
    verdict_in(ui, rect.with_max_x(time.left() - COLUMN_GAP), verdict, t)
}

/// Paints a verdict with its mark, in the short form where space is tight. Returns `true` if the
/// text was cut.
pub(super) fn verdict_in(ui: &Ui, rect: Rect, verdict: Verdict<'_>, t: &Tokens) -> bool {
    let (icon, mark, colour) = match verdict {
        Verdict::Trackable => (Icon::Check, t.ok, t.t2),
        Verdict::Loses { .. }
        | Verdict::Blocked { .. }
        | Verdict::Way(WayThere { joining: Some(_) })
        | Verdict::Misses => (Icon::Warning, t.warn, t.warn),
        Verdict::Way(WayThere { joining: None }) | Verdict::OutOfReach | Verdict::TooLow => {
            (Icon::Cross, t.bad, t.bad)
        }
        Verdict::LeftOut(_) => (Icon::Dash, t.t2, t.t2),
        Verdict::InMaintenance => (Icon::Lock, t.warn, t.warn),
    };
    let glyph = paint::square(pos2(rect.left() + 6.0, rect.center().y), 12.0);
    icons::paint(ui.painter(), glyph, icon, mark);
    let room = rect.with_min_x(glyph.right() + 5.0);
    let sentence = verdict.sentence();
    let fits = paint::text_width(ui, &sentence, text::small()) <= room.width();
    let words = if fits { sentence } else { verdict.short() };
    elided(ui, room, &words, text::small(), colour)
}

/// Paints a text from the left, cut with an ellipsis if needed. Returns `true` if the text was cut.
fn elided(ui: &Ui, room: Rect, text: &str, font: FontId, colour: Color32) -> bool {
    let cut = paint::text_width(ui, text, font.clone()) > room.width();
    paint::text_in(ui, room, Align2::LEFT_CENTER, text, font, colour);
    cut
}
