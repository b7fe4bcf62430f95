//! The line above the sky plot: the selected pass with countdowns to its events.

use egui::{Align2, FontId, Rect, Ui, pos2, vec2};

use super::{
    text::{self, Weight},
    theme,
    widgets::{
        button::{Button, SMALL_HEIGHT},
        paint,
    },
};

/// Height of the header, points.
pub const HEIGHT: f32 = 56.0;
/// Min height of a header with two lines, points.
const TWO_LINES_FROM: f32 = 52.0;
/// Padding at the left and the right, points.
const PADDING: f32 = 16.0;
/// [`PADDING`] in a small window, which also shows the button, points.
const SMALL_PADDING: f32 = 12.0;
/// Gap between the texts at the left and the countdowns, points.
const GAP: f32 = 16.0;
/// Gap between a word and its value, points.
const WORD_GAP: f32 = 7.0;
/// Downward shift of a smaller text to align its baseline with a larger text, points for each point
/// of difference in size.
const DOWN_PER_SIZE: f32 = 0.22;
/// Separator between the clauses of the second line.
pub const SEPARATOR: &str = " · ";
/// Min width of a text, points; the header omits a text with less room.
const MIN_TEXT: f32 = 24.0;
/// Min width of the texts next to which a TCA countdown fits, points.
const TCA_FROM: f32 = 180.0;
/// Widest common countdown. The header reserves its width so that the words before it do not move
/// with the digits.
const DEFAULT_COUNTDOWN: &str = "T−00:00";

/// The selected pass in words.
#[derive(Debug, Clone, Copy, Default)]
pub struct PassHeaderModel<'a> {
    pub name: &'a str,
    /// Second name and catalog number.
    pub detail: &'a str,
    /// Warnings at the start of the second line.
    pub warning: &'a str,
    /// The rest of the second line: the elements and their location.
    pub second_line: &'a str,
    /// Countdown to TCA; empty once it is over.
    pub tca_countdown: &'a str,
    /// Event of the large countdown, such as AOS or LOS.
    pub event: &'a str,
    pub countdown: &'a str,
    /// `true` in a small window: one line, and a button that opens the list of passes.
    pub drawer_button: bool,
    /// Sentence to show in place of a pass.
    pub empty: Option<&'a str>,
}

/// Shows the header in `rect`. Returns `true` when the operator opens the list of passes.
pub fn show(ui: &mut Ui, rect: Rect, model: &PassHeaderModel<'_>) -> bool {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let padding = if model.drawer_button { SMALL_PADDING } else { PADDING };
    let mut room = rect.shrink2(vec2(padding.min(rect.width() / 2.0), 0.0));
    let mut clicked = false;
    if model.drawer_button {
        let button = Button::normal("Passes");
        let place = Rect::from_min_size(
            pos2(room.left(), room.center().y - SMALL_HEIGHT / 2.0),
            vec2(button.width(ui), SMALL_HEIGHT),
        );
        clicked = button.show(ui, "passes", place).clicked();
        room.min.x = (place.right() + 12.0).min(room.right());
    }
    if let Some(sentence) = model.empty {
        paint::text_in(ui, room, Align2::LEFT_CENTER, sentence, text::body(), t.t2);
        paint::name_text(ui, "pass", room, sentence);
        return clicked;
    }
    let one_line = model.drawer_button || rect.height() < TWO_LINES_FROM;
    let left = countdowns(ui, room, model, one_line);
    let texts = room.with_max_x((left - GAP).max(room.left()));
    if one_line {
        // A warning gets the room of the second name.
        let detail = if model.warning.is_empty() { model.detail } else { "" };
        let end = names(ui, texts, model.name, detail, text::value());
        let rest = texts.with_min_x(end + WORD_GAP).translate(vec2(0.0, DOWN_PER_SIZE * 3.0));
        second_line(ui, rest, model);
    } else {
        let line = |y: f32| Rect::from_x_y_ranges(texts.x_range(), y - 12.0..=y + 12.0);
        names(ui, line(rect.top() + 20.0), model.name, model.detail, text::title());
        second_line(ui, line(rect.top() + 40.0), model);
    }
    // The tool-tip contains the texts that had no room.
    paint::name_text(
        ui,
        "pass",
        texts,
        &joined(&[model.name, model.detail, model.warning, model.second_line]),
    )
    .on_hover_text(joined(&[model.warning, model.second_line]));
    clicked
}

/// Paints the name in `font` and then `detail`, cut at the end of `rect`. Returns the right end of
/// the texts.
fn names(ui: &Ui, rect: Rect, name: &str, detail: &str, font: FontId) -> f32 {
    let t = theme::tokens(ui);
    let down = DOWN_PER_SIZE * (font.size - text::body().size);
    let name = paint::text_in(ui, rect, Align2::LEFT_CENTER, name, font, t.t1);
    let rest = rect.with_min_x(name.right() + WORD_GAP).translate(vec2(0.0, down));
    if detail.is_empty() || rest.width() < MIN_TEXT {
        return name.right();
    }
    paint::text_in(ui, rest, Align2::LEFT_CENTER, detail, text::body(), t.t2).right()
}

fn second_line(ui: &Ui, rect: Rect, model: &PassHeaderModel<'_>) {
    let t = theme::tokens(ui);
    let mut room = rect;
    let mut words = model.second_line.to_owned();
    if !model.warning.is_empty() && rect.width() >= MIN_TEXT {
        let drawn =
            paint::text_in(ui, rect, Align2::LEFT_CENTER, model.warning, text::small(), t.warn);
        room = rect.with_min_x(drawn.right());
        words = format!("{SEPARATOR}{words}");
    }
    // The line omits a clause without room, and all clauses after it.
    while !words.is_empty() && paint::text_width(ui, &words, text::small()) > room.width() {
        words = words.rsplit_once(SEPARATOR).map_or("", |(first, _)| first).to_owned();
    }
    if room.width() >= MIN_TEXT && !words.is_empty() {
        paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small(), t.t2);
    }
}

/// Paints the countdowns at the right of `room` and returns their left end.
fn countdowns(ui: &Ui, room: Rect, model: &PassHeaderModel<'_>, one_line: bool) -> f32 {
    let t = theme::tokens(ui);
    let y = room.center().y;
    let font = if one_line { text::sized(24.0, Weight::SemiBold) } else { text::clock() };
    let position = room.right_center();
    paint::text(ui, position, Align2::RIGHT_CENTER, model.countdown, font.clone(), t.t1);
    let position = pos2(room.right() - countdown_width(ui, model.countdown, font) - 10.0, y);
    let event = paint::text(ui, position, Align2::RIGHT_CENTER, model.event, text::small(), t.t2);
    let mut spoken = format!("{} {}", model.event, model.countdown);
    let mut left = event.left();

    let value = if one_line { text::sized(13.0, Weight::SemiBold) } else { text::value() };
    let width = countdown_width(ui, model.tca_countdown, value.clone());
    if !model.tca_countdown.is_empty() && left - width - room.left() >= TCA_FROM {
        spoken = format!("TCA {}, {spoken}", model.tca_countdown);
        let t2 = t.t2;
        if one_line {
            let position = pos2(left - 12.0, y);
            paint::text(ui, position, Align2::RIGHT_CENTER, model.tca_countdown, value, t.t1);
            let position = pos2(position.x - width - 4.0, y);
            left = paint::text(ui, position, Align2::RIGHT_CENTER, "TCA", text::small(), t2).left();
        } else {
            let divider = left - 16.5;
            ui.painter().vline(divider, y - 16.0..=y + 16.0, (1.0, t.line));
            let right = divider - 16.5;
            let position = pos2(right, y - 10.0);
            paint::text(ui, position, Align2::RIGHT_CENTER, "TCA", text::small(), t2);
            let position = pos2(right, y + 8.0);
            paint::text(ui, position, Align2::RIGHT_CENTER, model.tca_countdown, value, t.t1);
            left = right - width;
        }
    }
    let place = Rect::from_x_y_ranges(left.min(room.right())..=room.right(), room.y_range());
    paint::name_text(ui, "countdowns", place, spoken.trim());
    left
}

/// Returns the width to reserve for a countdown, points.
fn countdown_width(ui: &Ui, countdown: &str, font: FontId) -> f32 {
    if countdown.is_empty() {
        return 0.0;
    }
    let default = paint::text_width(ui, DEFAULT_COUNTDOWN, font.clone());
    paint::text_width(ui, countdown, font).max(default)
}

/// Joins the non-empty texts.
fn joined(texts: &[&str]) -> String {
    let texts: Vec<&str> = texts.iter().copied().filter(|text| !text.is_empty()).collect();
    texts.join(", ")
}

#[cfg(test)]
mod tests;
