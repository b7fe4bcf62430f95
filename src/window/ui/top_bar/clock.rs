//! The clock: UTC, with date and local time next to it or in a tool-tip.

use egui::{Align2, Color32, Id, LayerId, Order, Rect, Ui, accesskit::Live, pos2, vec2};

use crate::ui::{
    icons::{self, Icon},
    text::{self, Weight},
    theme,
    widgets::paint,
};

/// Width of the letters UTC and the space after them, points.
const UTC_WIDTH: f32 = 34.0;
/// Gap between the local time and the health of the clock, points.
const HEALTH_GAP: f32 = 10.0;
/// Distance from the centre of the bar to the centre of each of two lines, points.
const LINE: f32 = 8.0;
/// Min width of a sentence in two lines, points; a narrower sentence takes three.
const TWO_LINES: f32 = 180.0;
/// Width below which words would break, points.
const NARROWEST: f32 = 110.0;

/// Formatted times for the clock.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClockModel<'a> {
    /// UTC as hh:mm:ss.
    pub utc: &'a str,
    /// Day of the week and date, UTC.
    pub date: &'a str,
    /// Local time with the name or offset of its zone; `None` if the operator has hidden it.
    pub local: Option<&'a str>,
    /// Health of the clock, next to the local time.
    pub health: ClockHealth<'a>,
}

/// Health of the clock in words.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClockHealth<'a> {
    /// Rating that sets colour and shape of the health.
    pub mood: ClockMood,
    /// Short description of the health.
    pub words: &'a str,
    /// Explanation of the health.
    pub sentence: &'a str,
}

/// Rating of the health of the clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ClockMood {
    /// A correct clock.
    Good,
    /// A clock that needs attention, shown even where words have no room.
    Bad,
    #[default]
    Unknown,
}

/// The right end of the clock, and the place of the letters UTC next to it.
pub(super) struct ClockEnds {
    pub(super) time: f32,
    pub(super) utc: Rect,
}

/// Shows the UTC clock at the left end of `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, model: &ClockModel<'_>, wide: bool) -> ClockEnds {
    let t = theme::tokens(ui);
    let font = if wide { text::clock() } else { text::sized(24.0, Weight::SemiBold) };
    let time = paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, model.utc, font, t.t1);
    let named = paint::name_text(ui, "utc", time, &format!("{} UTC", model.utc));
    let local = model.local.map_or_else(String::new, |local| format!("{local}\n"));
    named.on_hover_text(format!("{} UTC\n{local}{}", model.date, model.health.sentence));
    let strong = text::sized(12.0, Weight::SemiBold);
    let two_lines = wide || model.health.mood == ClockMood::Bad;
    let position = pos2(time.right() + 10.0, rect.center().y - if two_lines { LINE } else { 0.0 });
    let utc = paint::text(ui, position, Align2::LEFT_CENTER, "UTC", strong, t.t1);
    ClockEnds { time: time.right(), utc }
}

/// Shows date, local time and health in `rect`, next to and below the letters UTC. Omits parts that
/// would be cut; the tool-tip contains all parts. Returns `true` if the date had room.
pub(super) fn date(ui: &Ui, rect: Rect, model: &ClockModel<'_>) -> bool {
    let t = theme::tokens(ui);
    let local = model.local.unwrap_or_default();
    let gap = if local.is_empty() { 0.0 } else { HEALTH_GAP };
    let width = |words: &str| paint::text_width(ui, words, text::small());
    let bad = model.health.mood == ClockMood::Bad;
    let has_room = |words: &str| width(local) + gap + width(words) <= rect.width();
    let room_for_health = has_room(model.health.words);
    if UTC_WIDTH + width(model.date) > rect.width() || (bad && !room_for_health) {
        return false;
    }
    let after_utc = rect.with_min_x(rect.left() + UTC_WIDTH).translate(vec2(0.0, -LINE));
    paint::text_in(ui, after_utc, Align2::LEFT_CENTER, model.date, text::small(), t.t2);
    let below = rect.translate(vec2(0.0, LINE));
    let place = paint::text_in(ui, below, Align2::LEFT_CENTER, local, text::small(), t.t2);
    let spoken = match model.local {
        Some(local) => format!("{}, local time {local}", model.date),
        None => model.date.to_owned(),
    };
    paint::name_text(ui, "local", place, &spoken);
    if room_for_health {
        let colour = match model.health.mood {
            ClockMood::Good => t.ok,
            ClockMood::Bad => t.warn,
            ClockMood::Unknown => t.t3,
        };
        let rest = below.with_min_x(place.right() + gap);
        let full = format!("clock {}", model.health.words);
        let words = if has_room(&full) { &full } else { model.health.words };
        let place = paint::text_in(ui, rest, Align2::LEFT_CENTER, words, text::small(), colour);
        name_health(ui, place, &model.health);
    }
    true
}

/// Shows a warning triangle below the letters UTC where the health has no room for words.
pub(super) fn warn(ui: &Ui, utc: Rect, health: &ClockHealth<'_>) {
    let t = theme::tokens(ui);
    let place = paint::square(utc.center() + vec2(0.0, 2.0 * LINE), 14.0);
    icons::paint(ui.painter(), place, Icon::Warning, t.warn);
    name_health(ui, place, health);
}

fn name_health(ui: &Ui, place: Rect, health: &ClockHealth<'_>) {
    let name = format!("Clock: {}", health.words);
    paint::name_text(ui, "clock health", place, &name).on_hover_text(health.sentence);
}

/// Shows the sentence that STOP is not confirmed in `rect` of `bar`.
pub(super) fn not_confirmed(ui: &Ui, bar: Rect, rect: Rect, sentence: &str) {
    let t = theme::tokens(ui);
    about_stop(ui, (bar, rect), sentence, (t.badbg, t.bad), Live::Assertive);
}

/// Shows the antennas that STOP left alone in `rect` of `bar`.
pub(super) fn left_out(ui: &Ui, bar: Rect, rect: Rect, sentence: &str) {
    let t = theme::tokens(ui);
    about_stop(ui, (bar, rect), sentence, (t.warnbg, t.warn), Live::Polite);
}

/// Shows a sentence about STOP. A sentence that does not fit between the clock and the chips stands
/// below the bar, above all other parts.
fn about_stop(
    ui: &Ui,
    (bar, rect): (Rect, Rect),
    sentence: &str,
    (ground, colour): (Color32, Color32),
    live: Live,
) {
    let size = if rect.width() < TWO_LINES { 11.0 } else { 12.0 };
    let font = text::sized(size, Weight::SemiBold);
    let laid_out =
        |room: Rect| ui.painter().layout(sentence.to_owned(), font.clone(), colour, room.width());
    let inner = |rect: Rect| rect.shrink2(vec2(6.0, 0.0));
    let fits = rect.width() > NARROWEST && laid_out(inner(rect)).size().y <= rect.height();
    let (painter, rect) = if fits {
        (ui.painter().clone(), rect)
    } else {
        let layer = LayerId::new(Order::Foreground, Id::unique("about stop"));
        let below = bar.translate(vec2(0.0, bar.height()));
        let height = laid_out(inner(below)).size().y + 12.0;
        (ui.ctx().layer_painter(layer), below.with_max_y(below.top() + height))
    };
    painter.rect_filled(rect.shrink2(vec2(0.0, 1.0)), 4.0, ground);
    let galley = laid_out(inner(rect));
    let place = Align2::LEFT_CENTER.align_size_within_rect(galley.size(), inner(rect));
    painter.galley(place.min, galley, colour);
    let node = paint::name_text(ui, "about stop", rect, sentence);
    ui.ctx().accesskit_node_builder(node.id, |node| node.set_live(live));
}
