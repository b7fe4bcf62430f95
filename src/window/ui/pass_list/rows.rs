//! The rows in view, and the keys that move between them.

use egui::{Rect, Response, Ui};

use super::{
    PassListModel, PassListState, PassRow, Verdict,
    phase::{self, Phase},
    row,
};
use crate::{
    model::UiCommand,
    ui::widgets::{
        context_menu, copy_menu,
        list::{List, Step},
    },
};

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
    commands: &mut Vec<UiCommand>,
) {
    let list = List::new(ui, rect, "pass list", "Passes", row::HEIGHT);
    let is_news = state.is_news(model.selected);
    let selected = model.selected.filter(|_| is_news).and_then(model.place);
    let scrolled = state.rows_gone_above(model);
    let mut scroll = state.scroll;
    if let Some(first) = state.opens_at(model) {
        scroll.set(first as f32 * row::HEIGHT);
    } else if scrolled != 0.0 {
        scroll.set(scroll.offset - scrolled * row::HEIGHT);
    }
    if let Some(place) = selected {
        scroll.bring_into_view(place);
    }
    if let Some(pass) = list.arrow_step(ui).and_then(|step| stepped(step, model)) {
        commands.push(UiCommand::SelectPass(pass.key));
    }
    list.show_rows(ui, model.rows, &mut scroll, |ui, place, index| {
        if let Some(pass) = (model.row)(index) {
            show_row(ui, &list, place, &pass, model, commands);
        }
    });
    state.remember(scroll, row::HEIGHT, model);
}

/// Returns the pass one step away from the selected pass, or the first pass.
fn stepped<'a>(step: Step, model: &PassListModel<'a>) -> Option<PassRow<'a>> {
    let start = model.selected.and_then(model.place);
    let target = start.map_or(Some(0), |start| step.target(start, model.rows))?;
    (model.row)(target).filter(|pass| model.selected != Some(pass.key))
}

fn show_row(
    ui: &Ui,
    list: &List,
    rect: Rect,
    pass: &PassRow<'_>,
    model: &PassListModel<'_>,
    commands: &mut Vec<UiCommand>,
) {
    let response = one(ui, list, rect, pass, model);
    let mut menu = |opener: &Response| {
        context_menu::show(ui, opener, |ui| {
            (model.menu)(ui, opener.id, pass.key, commands);
            if context_menu::entry(ui, opener.id, "Copy this pass") {
                ui.copy_text(phase::copied(pass));
            }
        });
    };
    menu(&response);
    if model.selected == Some(pass.key) {
        // The keys apply to the selected row.
        let focused = list.response.clone().with_new_rect(rect);
        copy_menu::by_key(ui, &focused, || phase::copied(pass));
        menu(&focused);
    }
    if response.clicked() {
        commands.push(UiCommand::SelectPass(pass.key));
    }
}

fn one(
    ui: &Ui,
    list: &List,
    rect: Rect,
    pass: &PassRow<'_>,
    model: &PassListModel<'_>,
) -> Response {
    let is_selected = model.selected == Some(pass.key);
    let spoken = || phase::spoken(pass, Phase::new(pass, model.now), model.now);
    let clear = egui::Color32::TRANSPARENT;
    let response = list.option(ui, rect, pass.key, is_selected, clear, spoken);
    if ui.is_rect_visible(rect) && row::paint(ui, rect, pass, model.now, model.thumbnails) {
        let verdict = pass.verdict.map(Verdict::sentence).unwrap_or_default();
        return response.on_hover_text(format!("{}\n{verdict}", pass.name).trim_end());
    }
    response
}
