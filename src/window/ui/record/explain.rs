//! The table of possible causes of the error.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{PADDING, RecordState};
use crate::{
    contract::record::OpenedPass,
    model::{
        Model,
        correction::{Correction, correction},
    },
    plan::pass_report::Explanation,
    ui::{
        format, text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            list::paint_stripe,
            paint,
        },
        words::record as words,
    },
};

const BAR: f32 = 32.0;
const HEAD: f32 = 22.0;
const ROW: f32 = 29.0;
const FOOT: f32 = 80.0;
const SHARE_BAR: f32 = 108.0;
const CORRECTION: f32 = 72.0;

pub(super) fn height(opened: &OpenedPass) -> f32 {
    let explanations = &opened.pass.report.causes;
    let rows =
        explanations.iter().map(|explanation| explanation.causes().count()).sum::<usize>() + 2;
    BAR + HEAD + rows as f32 * ROW + FOOT
}

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    opened: &OpenedPass,
    state: &mut RecordState,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.field);
    let report = &opened.pass.report;
    let explanations = &report.causes;
    let (bar, rest) = rect.split_top_bottom_at_y(rect.top() + BAR);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    let inner = bar.shrink2(vec2(PADDING, 0.0));
    let left = Align2::LEFT_CENTER;
    let drawn = paint::text_in(ui, inner, left, "Causes of the error", text::small_strong(), t.t1);
    let note = words::fitted_to(opened.track.len());
    paint::text_in(ui, inner.with_min_x(drawn.right() + 12.0), left, &note, text::small(), t.t3);
    let (head, mut rest) = rest.split_top_bottom_at_y(rest.top() + HEAD);
    ui.painter().hline(head.x_range(), head.bottom() - 0.5, (1.0, t.line));
    let columns = Columns::new(rect);
    for (place, word, anchor) in [
        (columns.cause, "Cause", Align2::LEFT_CENTER),
        (columns.size, "Best value", Align2::RIGHT_CENTER),
        (columns.left, "Residual °", Align2::RIGHT_CENTER),
        (columns.bar, "Explained", Align2::LEFT_CENTER),
        (columns.correction, "Correction", Align2::LEFT_CENTER),
    ] {
        let cell = head.with_min_x(place.0).with_max_x(place.1);
        paint::text_in(ui, cell, anchor, word, text::caption(), t.t3);
    }
    let mut next = || {
        let (row, below) = rest.split_top_bottom_at_y(rest.top() + ROW);
        rest = below;
        ui.painter().hline(row.x_range(), row.bottom() - 0.5, (1.0, t.line));
        row
    };
    let rms =
        report.report.rms.map_or_else(|| "–".to_owned(), |rms| format::number(rms.off_deg, 3));
    let row = next();
    cells(ui, row, &columns, ["As recorded", "–", &rms]);
    paint::name_text(ui, "as recorded", row, &format!("As recorded, root mean square {rms}°"));
    if explanations.is_empty() {
        let row = next();
        let words = words::not_explained(opened);
        let room = row.with_min_x(columns.cause.0).with_max_x(row.right() - PADDING);
        paint::text_in(ui, room, left, words, text::small(), t.t2);
        paint::name_text(ui, "not explained", row, words);
    }
    for (place, explanation) in explanations.iter().enumerate() {
        let row = next();
        if place == 0 {
            ui.painter().rect_filled(row.shrink2(vec2(0.0, 1.0)), 0.0, t.bgsel);
            paint_stripe(ui, row);
        }
        explained(ui, row, place, &columns, explanation);
        if let Some(cause) = &explanation.partner {
            let row = next();
            cells(ui, row, &columns, [&words::second_cause(cause), &words::size(cause), ""]);
        }
        let cell = row.with_min_x(columns.correction.0).with_max_x(columns.correction.1);
        let correction = correction(model, &opened.pass, explanation);
        if let Some(offer) = offered(ui, cell, place, correction) {
            state.correction = Some(Ok(offer));
        }
    }
    let combined = model.recorded.as_ref().and_then(|recorded| recorded.combined.as_ref());
    let combined = combined.and_then(|set| words::explained_together(set, &opened.pass));
    let mut position = rest.min + vec2(PADDING, 8.0);
    for (id, words) in [("alike", words::alike(explanations)), ("together", combined)] {
        let Some(words) = words else { continue };
        let width = rest.width() - 2.0 * PADDING;
        let place = paint::paragraph(ui, position, width, &words, text::small(), t.t3);
        paint::name_text(ui, id, place, &words);
        position.y = place.bottom() + 4.0;
    }
}

/// Shows the correction button of a cause, or a dash without a correction. Returns the correction
/// when the operator presses the button.
fn offered(
    ui: &Ui,
    cell: Rect,
    place: usize,
    correction: Option<Correction>,
) -> Option<Correction> {
    let Some(correction) = correction else {
        let t3 = theme::tokens(ui).t3;
        paint::text_in(ui, cell, Align2::LEFT_CENTER, "–", text::small(), t3);
        return None;
    };
    let rect = Rect::from_center_size(cell.center(), vec2(cell.width(), SMALL_HEIGHT));
    let response = Button::normal("Apply…").show(ui, ("correct", place), rect);
    let words = words::correction(&correction.method, place == 0);
    response.on_hover_text(words).clicked().then_some(correction)
}

/// Columns of the table, as ranges of x.
struct Columns {
    cause: (f32, f32),
    size: (f32, f32),
    left: (f32, f32),
    bar: (f32, f32),
    share: (f32, f32),
    correction: (f32, f32),
}

impl Columns {
    fn new(rect: Rect) -> Self {
        let correction = (rect.right() - PADDING - CORRECTION, rect.right() - PADDING);
        let share = (correction.0 - 12.0 - 48.0, correction.0 - 12.0);
        let bar = (share.0 - 8.0 - SHARE_BAR, share.0 - 8.0);
        let left = (bar.0 - 16.0 - 64.0, bar.0 - 16.0);
        let cause_end = rect.left() + PADDING + 0.34 * (left.0 - rect.left());
        Self {
            cause: (rect.left() + PADDING, cause_end),
            size: (cause_end + 8.0, left.0 - 8.0),
            left,
            bar,
            share,
            correction,
        }
    }
}

fn cells(ui: &Ui, row: Rect, columns: &Columns, [cause, size, left]: [&str; 3]) {
    let t = theme::tokens(ui);
    let cell = |(start, end): (f32, f32)| row.with_min_x(start).with_max_x(end);
    paint::text_in(ui, cell(columns.cause), Align2::LEFT_CENTER, cause, text::small_strong(), t.t1);
    paint::text_in(ui, cell(columns.size), Align2::RIGHT_CENTER, size, text::small(), t.t1);
    paint::text_in(ui, cell(columns.left), Align2::RIGHT_CENTER, left, text::small(), t.t1);
}

fn explained(ui: &Ui, row: Rect, place: usize, columns: &Columns, explanation: &Explanation) {
    let t = theme::tokens(ui);
    let (cause, size) = (words::cause(&explanation.cause), words::size(&explanation.cause));
    let left = format::number(explanation.left_deg, 3);
    cells(ui, row, columns, [cause, &size, &left]);
    let (start, end) = columns.bar;
    let y = row.center().y;
    let whole = Rect::from_min_max(pos2(start, y - 4.0), pos2(end, y + 4.0));
    ui.painter().rect_filled(whole, 1.0, t.bg3);
    let share = explanation.share.clamp(0.0, 1.0) as f32;
    ui.painter().rect_filled(whole.with_max_x(egui::lerp(start..=end, share)), 1.0, t.sat);
    let words = words::whole_share(explanation.share);
    let cell = row.with_min_x(columns.share.0).with_max_x(columns.share.1);
    paint::text_in(ui, cell, Align2::RIGHT_CENTER, &words, text::small_strong(), t.t1);
    let alike = if place > 0 { ", not distinguishable from the best one" } else { "" };
    let second = explanation.partner.as_ref();
    let partner =
        second.map(|cause| format!(" {} {}", words::second_cause(cause), words::size(cause)));
    let partner = partner.unwrap_or_default();
    let spoken = format!("{cause} {size}{partner}: explains {words}, {left}° left{alike}");
    paint::name_text(ui, ("explanation", place), row, &spoken);
}
