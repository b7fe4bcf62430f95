//! UTC first; the date and the local time beside it or in a tool-tip.

use egui::{Align2, Rect, Ui, accesskit::Live, pos2, vec2};

use crate::ui::{
    text::{self, Weight},
    theme,
    widgets::paint,
};

/// The letters UTC and the space behind them.
const UTC_WIDTH: f32 = 34.0;
/// A sentence in less room than this takes three lines.
const TWO_LINES: f32 = 180.0;

/// Times as they are shown.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClockModel<'a> {
    /// UTC, hh:mm:ss.
    pub utc: &'a str,
    /// Day of the week and date, UTC.
    pub date: &'a str,
    /// Local time.
    pub local: &'a str,
    /// Name or offset of the local zone.
    pub zone: &'a str,
}

/// Where the clock ends, and where the letters UTC beside it end.
pub(super) struct ClockEnds {
    pub(super) time: f32,
    pub(super) utc: f32,
}

/// Shows the UTC clock at the left end of `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, model: &ClockModel<'_>, wide: bool) -> ClockEnds {
    let t = theme::tokens(ui);
    let font = if wide { text::clock() } else { text::sized(24.0, Weight::SemiBold) };
    let time = paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, model.utc, font, t.t1);
    let named = paint::name_text(ui, "utc", time, &format!("{} UTC", model.utc));
    named.on_hover_text(format!("{} UTC\n{} {}", model.date, model.local, model.zone));
    let strong = text::sized(12.0, Weight::SemiBold);
    let below = if wide { -8.0 } else { 0.0 };
    let at = pos2(time.right() + 10.0, rect.center().y + below);
    let utc = paint::text(ui, at, Align2::LEFT_CENTER, "UTC", strong, t.t1);
    ClockEnds { time: time.right(), utc: utc.right() }
}

/// Shows date and local time in `rect`, beside and below the letters UTC,
/// unless a part of it would be cut off; it is in the tool-tip as well.
pub(super) fn date(ui: &Ui, rect: Rect, model: &ClockModel<'_>) {
    let t = theme::tokens(ui);
    let wanted = UTC_WIDTH + paint::text_width(ui, model.date, text::small());
    if wanted > rect.width() {
        return;
    }
    let after_utc = rect.with_min_x(rect.left() + UTC_WIDTH).translate(vec2(0.0, -8.0));
    paint::text_in(ui, after_utc, Align2::LEFT_CENTER, model.date, text::small(), t.t2);
    let local = format!("{} {}", model.local, model.zone);
    let below = rect.translate(vec2(0.0, 8.0));
    let place = paint::text_in(ui, below, Align2::LEFT_CENTER, &local, text::small(), t.t2);
    paint::name_text(ui, "local", place, &format!("{}, local time {local}", model.date));
}

/// Says in `rect` what STOP did not prove.
pub(super) fn not_confirmed(ui: &Ui, rect: Rect, sentence: &str) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect.shrink2(vec2(0.0, 1.0)), 4.0, t.badbg);
    let size = if rect.width() < TWO_LINES { 11.0 } else { 12.0 };
    let font = text::sized(size, Weight::SemiBold);
    let room = rect.shrink2(vec2(6.0, 0.0));
    let galley = ui.painter().layout(sentence.to_owned(), font, t.bad, room.width());
    let place = Align2::LEFT_CENTER.align_size_within_rect(galley.size(), room);
    ui.painter().galley(place.min, galley, t.bad);
    let node = paint::name_text(ui, "not confirmed", rect, sentence);
    ui.ctx().accesskit_node_builder(node.id, |node| node.set_live(Live::Assertive));
}
