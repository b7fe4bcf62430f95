//! The next passes of a satellite, in the panel that shows it.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{
    format,
    operate::passes::pass_row,
    pass_list::{SHORT_ROW, short_row},
    text::{self, Weight},
    theme,
    widgets::{inspector::PADDING, paint},
};
use crate::{contract::passes::PredictedPass, model::Model};

/// Height of the head, points.
const HEAD: f32 = 32.0;

/// Passes and the words around them.
pub(super) struct Upcoming<'a> {
    pub(super) title: &'a str,
    /// Remark at the right of the title.
    pub(super) remark: &'a str,
    pub(super) passes: &'a [&'a PredictedPass],
    /// Reason why there are no passes.
    pub(super) empty: &'a str,
}

impl<'a> Upcoming<'a> {
    /// Returns the height of the head and the passes, points.
    pub(super) fn height(&self) -> f32 {
        HEAD + self.passes.len().max(1) as f32 * SHORT_ROW
    }

    /// Draws the passes into `rect`. Returns the clicked pass.
    pub(super) fn show(&self, ui: &Ui, rect: Rect, model: &Model) -> Option<&'a PredictedPass> {
        let t = theme::tokens(ui);
        let (head, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
        let room = head.shrink2(vec2(PADDING, 0.0));
        let font = text::sized(13.0, Weight::SemiBold);
        paint::text_in(ui, room, Align2::LEFT_CENTER, self.title, font, t.t1);
        paint::text_in(ui, room, Align2::RIGHT_CENTER, self.remark, text::small(), t.t2);
        let words = format!("{}, {}", self.title, self.remark);
        paint::name_text(ui, "next passes", room, words.trim_end_matches(", "));
        if self.passes.is_empty() {
            let corner = body.left_top() + vec2(PADDING, 4.0);
            let width = body.width() - 2.0 * PADDING;
            let place = paint::paragraph(ui, corner, width, self.empty, text::body(), t.t2);
            paint::name_text(ui, "no next pass", place, self.empty);
        }
        let mut clicked = None;
        for (index, predicted) in self.passes.iter().enumerate() {
            let min = pos2(body.left(), body.top() + index as f32 * SHORT_ROW);
            let place = Rect::from_min_size(min, vec2(body.width(), SHORT_ROW));
            let time = format::minute(predicted.pass.aos.time, model.now);
            let is_selected = model.selected == Some(predicted.key());
            let row = pass_row(model, predicted);
            if short_row(ui, place, &row, &time, is_selected).clicked() {
                clicked = Some(*predicted);
            }
        }
        clicked
    }
}
