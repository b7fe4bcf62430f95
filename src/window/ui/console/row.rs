//! One row of the log.

use egui::{Align2, Color32, Rect, Ui, pos2};
use jiff::Timestamp;

use super::{PADDING, raw};
use crate::{
    device::{Direction, Finding, panel::Tone},
    model::ConsoleLine,
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

const TIME: f32 = 116.0;
const ANTENNA: f32 = 92.0;
const ARROW: f32 = 24.0;
const ROUND_TRIP: f32 = 64.0;
const GAP: f32 = 8.0;
/// Share of the bytes in the remaining width, 0 to 1; the meaning has the rest.
const RAW_PART: f32 = 0.56;

struct Columns {
    time: Rect,
    antenna: Option<Rect>,
    arrow: Rect,
    raw: Rect,
    meaning: Rect,
    round_trip: Rect,
}

impl Columns {
    fn new(row: Rect, names_antenna: bool) -> Self {
        let mut left = row.left() + PADDING;
        let mut take = |width: f32| {
            let column = row.with_min_x(left).with_max_x(left + width);
            left += width;
            column
        };
        let time = take(TIME);
        let antenna = names_antenna.then(|| take(ANTENNA - GAP));
        take(if names_antenna { GAP } else { 0.0 });
        let arrow = take(ARROW);
        let rest = row.right() - PADDING - ROUND_TRIP - arrow.right();
        let raw = take(rest * RAW_PART - GAP);
        take(GAP);
        let meaning = take(rest * (1.0 - RAW_PART));
        let round_trip = take(ROUND_TRIP);
        Self { time, antenna, arrow, raw, meaning, round_trip }
    }
}

/// Paints the names of the columns.
pub(super) fn head(ui: &Ui, rect: Rect, names_antenna: bool) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg2);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let columns = Columns::new(rect, names_antenna);
    let word = |place: Rect, anchor, word: &str| {
        paint::text_in(ui, place, anchor, word, text::caption(), t.t3);
    };
    word(columns.time, Align2::LEFT_CENTER, "Time UTC");
    if let Some(antenna) = columns.antenna {
        word(antenna, Align2::LEFT_CENTER, "Antenna");
    }
    word(columns.raw, Align2::LEFT_CENTER, "Raw");
    word(columns.meaning, Align2::LEFT_CENTER, "Decoded");
    word(columns.round_trip, Align2::RIGHT_CENTER, "Reply after");
}

/// Returns the background of a line by its meaning.
pub(super) fn tint(ui: &Ui, line: &ConsoleLine) -> Color32 {
    let t = theme::tokens(ui);
    match line.meaning.tone {
        Tone::Bad => t.badbg,
        Tone::Caution => t.warnbg,
        Tone::Plain | Tone::Change | Tone::Good => Color32::TRANSPARENT,
    }
}

/// Paints the row of a line.
pub(super) fn show(ui: &Ui, rect: Rect, names_antenna: bool, now: Timestamp, line: &ConsoleLine) {
    let t = theme::tokens(ui);
    let columns = Columns::new(rect, names_antenna);
    let left = Align2::LEFT_CENTER;
    paint::text_in(
        ui,
        columns.time,
        left,
        &format::millisecond(line.wire().time, now),
        text::raw(),
        t.t2,
    );
    if let Some(place) = columns.antenna {
        paint::text_in(ui, place, left, &line.antenna, text::small_strong(), t.t1);
    }
    let (mark, colour) = match (line.wire().finding, line.wire().direction) {
        (Finding::NoReply { .. }, _) => (Icon::Warning, t.warn),
        (_, Direction::Sent) => (Icon::ChevronRight, t.sat),
        (_, Direction::Received) => (Icon::ChevronLeft, t.t1),
    };
    let position = pos2(columns.arrow.left() + 6.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(position, 12.0), mark, colour);
    let colour = if line.wire().direction == Direction::Sent { t.sat } else { t.t1 };
    raw::show(ui, columns.raw, &line.wire().bytes, colour);
    let mut place = columns.meaning;
    if let Some((icon, colour)) = mark_of(line.meaning.tone, t) {
        let position = pos2(place.left() + 6.0, rect.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
        place = place.with_min_x(place.left() + 18.0);
    }
    paint::text_in(ui, place, left, &line.meaning.text, text::small(), t.t1);
    if let Some(after) = line.round_trip() {
        paint::text_in(ui, columns.round_trip, Align2::RIGHT_CENTER, &after, text::small(), t.t2);
    }
}

fn mark_of(tone: Tone, t: &Tokens) -> Option<(Icon, Color32)> {
    match tone {
        Tone::Plain => None,
        Tone::Change => Some((Icon::Sliders, t.cmd)),
        Tone::Good => Some((Icon::Check, t.ok)),
        Tone::Caution => Some((Icon::Warning, t.warn)),
        Tone::Bad => Some((Icon::Cross, t.bad)),
    }
}

/// Returns the row as text for screen readers.
pub(super) fn spoken(line: &ConsoleLine, now: Timestamp) -> String {
    let time = format::millisecond(line.wire().time, now);
    let raw = line.raw.trim_end_matches("<CR><LF>");
    let went = match line.direction() {
        "" => String::new(),
        direction => format!(" {direction} {raw}"),
    };
    format!("{time} {}{went}: {}", line.antenna, line.meaning.text)
}
