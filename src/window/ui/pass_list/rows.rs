//! The rows in view, and the keys that move between them.

use egui::{
    FocusDirection, Id, Key, Modifiers, Rect, Response, Role, ScrollArea, Sense, Ui, UiBuilder,
    WidgetInfo, pos2, style::ScrollAnimation, vec2,
};

use super::{
    PassListModel, PassListState, PassRow, Verdict,
    phase::{self, Phase},
    row::{self, Look},
};
use crate::{
    model::UiCommand,
    ui::widgets::{context_menu, copy_menu},
};

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
    commands: &mut Vec<UiCommand>,
) {
    let is_news = state.is_news(model.selected);
    let selected = model.selected.filter(|_| is_news).and_then(model.place);
    let opens_at = state.opens_at(model);
    let gone = state.rows_gone_above(model);
    // An id of this column and not of the scroll area, so that a row keeps its id at any
    // scroll position.
    let list = ui.make_persistent_id("passes");
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        ui.ctx().accesskit_node_builder(ui.unique_id(), |node| node.set_role(Role::ListBox));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let mut area = ScrollArea::vertical().id_salt("passes").auto_shrink(false);
        let mut offset = (state.offset - gone * row::HEIGHT).max(0.0);
        if let Some(first) = opens_at {
            offset = first as f32 * row::HEIGHT;
        }
        if let Some(index) = selected {
            // Before the rows are placed: afterwards it would take one more frame.
            let top = index as f32 * row::HEIGHT;
            offset = offset.min(top).max(top + row::HEIGHT - rect.height());
        }
        if gone != 0.0 || opens_at.is_some() || selected.is_some() {
            area = area.vertical_scroll_offset(offset);
        }
        let shown = area.show_rows(ui, row::HEIGHT, model.rows, |ui, range| {
            let top = ui.max_rect().top();
            let place = |index: usize| {
                let down = row::HEIGHT * (index as f32 - range.start as f32);
                let min = pos2(rect.left(), top + down);
                Rect::from_min_size(min, vec2(rect.width(), row::HEIGHT))
            };
            // One more row above those in view, so that the focus can reach it; below there is one
            // already.
            for index in range.start.saturating_sub(1)..range.end {
                let Some(pass) = (model.row)(index) else { continue };
                let response = one(ui, list, place(index), &pass, model);
                copy_menu::by_key(ui, &response, || phase::copied(&pass));
                context_menu::show(ui, &response, |ui| {
                    (model.menu)(ui, response.id, pass.key, commands);
                    if context_menu::entry(ui, response.id, "Copy this pass") {
                        ui.copy_text(phase::copied(&pass));
                    }
                });
                if response.clicked() {
                    response.request_focus();
                    commands.push(UiCommand::SelectPass(pass.key));
                }
                if response.gained_focus() {
                    into_view(ui, place(index));
                }
                if response.has_focus()
                    && let Some(target) = step(ui, index, model.rows)
                    && let Some(next) = (model.row)(target)
                {
                    focus(ui, list.with(next.key), place(target));
                    commands.push(UiCommand::SelectPass(next.key));
                }
            }
        });
        state.remember(shown.state.clamped_offset().y, row::HEIGHT, model);
    });
}

fn one(ui: &Ui, list: Id, rect: Rect, pass: &PassRow<'_>, model: &PassListModel<'_>) -> Response {
    let response = ui.interact(rect, list.with(pass.key), Sense::click());
    let selected = model.selected == Some(pass.key);
    let phase = Phase::of(pass, model.now);
    response.widget_info(|| {
        let name = phase::spoken(pass, phase, model.now);
        WidgetInfo::selected(Role::ListBoxOption, true, selected, name)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(selected));
    if ui.is_rect_visible(rect) {
        let look = Look {
            selected,
            hovered: response.hovered(),
            focused: response.has_focus(),
            thumbnail: model.thumbnails,
        };
        if row::paint(ui, rect, pass, model.now, look) {
            let verdict = pass.verdict.map(Verdict::sentence).unwrap_or_default();
            return response.on_hover_text(format!("{}\n{verdict}", pass.name).trim_end());
        }
    }
    response
}

/// The index that the arrow keys of this frame lead to from `index`.
fn step(ui: &Ui, index: usize, rows: usize) -> Option<usize> {
    let (up, down) = ui.input_mut(|input| {
        let up = input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp);
        (up, input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown))
    });
    if up == 0 && down == 0 {
        return None;
    }
    // The arrow keys would also move the focus to a control above or below.
    ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
    let target = (index + down).saturating_sub(up).min(rows.saturating_sub(1));
    (target != index).then_some(target)
}

fn focus(ui: &Ui, id: Id, rect: Rect) {
    ui.memory_mut(|memory| memory.request_focus(id));
    into_view(ui, rect);
}

/// Scrolls to `rect` without animation: a row that is still sliding in could not take the
/// focus.
fn into_view(ui: &Ui, rect: Rect) {
    ui.scroll_to_rect_animation(rect, None, ScrollAnimation::none());
}
