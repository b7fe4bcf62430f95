//! The lane that shows day and night.

use egui::{Align2, Rect, Stroke, StrokeKind, Ui, pos2};
use jiff::Timestamp;

use super::SunSpan;
use crate::ui::{format, text, theme, time_axis::TimeAxis, widgets::paint};

/// Gap between two captions below the lane, points.
const GAP: f32 = 8.0;

/// Shows the spans in `bar`, and their captions in `words`, the band below.
pub(super) fn show(
    ui: &Ui,
    scale: &TimeAxis,
    now: Timestamp,
    spans: &[SunSpan],
    bar: Rect,
    words: Rect,
) {
    let t = theme::tokens(ui);
    let mut free_from = words.left();
    for span in spans {
        let Some(x) = scale.range(span.start, span.end) else {
            continue;
        };
        let rect = Rect::from_x_y_ranges(x, bar.y_range());
        let (fill, line) = if span.up { (t.bg1, t.sun) } else { (t.bg3, t.line) };
        ui.painter().rect(rect, 0, fill, Stroke::new(1.0, line), StrokeKind::Inside);
        let word = caption(span, scale, now);
        let width = paint::text_width(ui, &word, text::caption());
        let left = x.min.min(words.right() - width);
        if left < free_from {
            continue;
        }
        let position = pos2(left, words.center().y);
        paint::text(ui, position, Align2::LEFT_CENTER, &word, text::caption(), t.t2);
        let name = Rect::from_x_y_ranges(left..=left + width, words.y_range());
        paint::name_text(ui, ("sun", span.start), name, &word);
        free_from = left + width + GAP;
    }
}

/// Returns the caption of a span: the state at the start of the window, or the change that begins
/// the span.
fn caption(span: &SunSpan, scale: &TimeAxis, now: Timestamp) -> String {
    let began = format::minute(span.start, now);
    match (span.start > scale.start(), span.up) {
        (false, true) => "day".to_owned(),
        (false, false) => "night".to_owned(),
        (true, true) => format!("sunrise {began}"),
        (true, false) => format!("sunset {began}"),
    }
}
