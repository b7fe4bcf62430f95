//! The next passes of the selected object.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::PADDING;
use crate::{
    contract::passes::PredictedPass,
    model::{Model, UiCommand, View},
    ui::{
        format,
        operate::passes::pass_row,
        pass_list::{SHORT_ROW, short_row},
        text::{self, Weight},
        theme,
        widgets::paint,
    },
};

const HEAD: f32 = 30.0;

pub(super) fn height(passes: Option<&[PredictedPass]>) -> f32 {
    HEAD + passes.map_or(0, <[_]>::len).max(1) as f32 * SHORT_ROW
}

/// Draws the passes into `rect`. A click on the pass of a favourite opens it on the sky plot.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    passes: Option<&[PredictedPass]>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    let room = head.shrink2(vec2(PADDING, 0.0));
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, room, Align2::LEFT_CENTER, "Next passes", font, t.t1);
    let floor = format!("floor {}", format::degrees(model.station.elevation_floor_deg, 0));
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &floor, text::small(), t.t2);
    paint::name_text(ui, "element passes", room, &format!("Next passes, {floor}"));
    let words = match passes {
        None => "The passes are being computed.",
        Some([]) => "No pass in the next 7 d.",
        Some(_) => "",
    };
    if !words.is_empty() {
        let at = body.left_top() + vec2(PADDING, 4.0);
        let width = body.width() - 2.0 * PADDING;
        let place = paint::paragraph(ui, at, width, words, text::body(), t.t2);
        paint::name_text(ui, "no element passes", place, words);
    }
    for (index, predicted) in passes.unwrap_or_default().iter().enumerate() {
        let min = pos2(body.left(), body.top() + index as f32 * SHORT_ROW);
        let place = Rect::from_min_size(min, vec2(body.width(), SHORT_ROW));
        let time = format::minute(predicted.pass.aos.time, model.now);
        let row = pass_row(model, predicted);
        let clicked = short_row(ui, place, &row, &time, false).clicked();
        if clicked && model.pass_lists.find(predicted.key()).is_some() {
            commands.push(UiCommand::SelectPass(predicted.key()));
            commands.push(UiCommand::Show(View::Operate));
        }
    }
}
