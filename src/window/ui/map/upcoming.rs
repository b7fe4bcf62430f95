//! The next passes of the selected satellite.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{PADDING, words};
use crate::{
    contract::passes::PredictedPass,
    model::{Model, UiCommand, globe::GlobeSatellite},
    ui::{
        format,
        operate::passes::pass_row,
        pass_list::{SHORT_ROW, short_row},
        text::{self, Weight},
        theme,
        widgets::paint,
    },
};

/// Height of the head.
pub(super) const HEAD: f32 = 32.0;
/// Passes that are shown.
const COUNT: usize = 3;

/// The passes of a satellite after the present one.
pub(super) fn passes(model: &Model, number: u32) -> Vec<&PredictedPass> {
    // The satellite may be no favourite.
    let lists = [&model.pass_lists.favourites, &model.pass_lists.all];
    let is_later = |of: &&PredictedPass| of.number() == number && of.pass.aos.time > model.now;
    let found =
        lists.map(|list| list.passes.iter().filter(is_later).take(COUNT).collect::<Vec<_>>());
    found.into_iter().find(|passes| !passes.is_empty()).unwrap_or_default()
}

/// Height of the head and so many passes.
pub(super) fn height(passes: usize) -> f32 {
    HEAD + passes.max(1) as f32 * SHORT_ROW
}

/// Draws the passes into `rect`. A click selects a pass.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    of: &GlobeSatellite,
    passes: &[&PredictedPass],
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    let words = format!("Next at {}", model.station.name);
    let room = head.shrink2(vec2(PADDING, 0.0));
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, font, t.t1);
    paint::name_text(ui, "next passes", room, &words);
    if passes.is_empty() {
        let words = words::no_later_pass(of, model);
        let at = body.left_top() + vec2(PADDING, 4.0);
        let width = body.width() - 2.0 * PADDING;
        let place = paint::paragraph(ui, at, width, words, text::body(), t.t2);
        paint::name_text(ui, "no next pass", place, words);
    }
    for (index, predicted) in passes.iter().enumerate() {
        let min = pos2(body.left(), body.top() + index as f32 * SHORT_ROW);
        let place = Rect::from_min_size(min, vec2(body.width(), SHORT_ROW));
        let time = format::minute(predicted.pass.aos.time, model.now);
        let is_selected = model.selected == Some(predicted.key());
        let row = pass_row(model, predicted);
        if short_row(ui, place, &row, &time, is_selected).clicked() {
            commands.push(UiCommand::SelectPass(predicted.key()));
        }
    }
}
