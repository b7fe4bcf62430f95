//! The Record view: the passes that antennas have tracked, and their results.

mod bar;
mod correct;
mod cursor;
mod curves;
mod days;
mod events;
mod explain;
mod facts;
mod list;
mod path;
mod report;
mod state;

use egui::{Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

pub use self::{
    correct::take_over,
    state::{RecordState, lock},
};
use super::{text, theme};
use crate::model::{Model, UiCommand};

const PADDING: f32 = 16.0;
/// Width of the list of passes, points.
const LIST: f32 = 320.0;
/// Window width below which the list is a drawer, points.
const DRAWER_BELOW: f32 = 1100.0;
/// Report width below which the tables stand one below the other, points.
const TABLES_BELOW: f32 = 1000.0;
/// Min height of the path and the curves, points.
const DRAWINGS: f32 = 384.0;
/// Min and max width of the path, points; higher drawings may be wider.
const PATH: (f32, f32) = (280.0, 400.0);
/// Min height of the tables below the drawings, points.
const TABLES: f32 = 276.0;

/// Draws the view.
pub fn show(
    ui: &mut Ui,
    window: Rect,
    rect: Rect,
    model: &Model,
    state: &mut RecordState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let has_drawer = window.width() < DRAWER_BELOW;
    let (top, rest) = rect.split_top_bottom_at_y(rect.top() + bar::HEIGHT);
    bar::show(ui, top, model, has_drawer, state, commands);
    let is_listed = !has_drawer || state.list_is_open;
    let list_width = if is_listed { LIST } else { 0.0 };
    let (left, right) = rest.split_left_right_at_x(rest.left() + list_width);
    // A drawer covers the report and takes the pointer.
    if is_listed {
        list::show(ui, left, model, state);
    }
    let body = if has_drawer { rest.with_min_x(left.right()) } else { right };
    match state.opened(model) {
        Some(opened) => {
            let opened = opened.clone();
            show_report(ui, body, model, &opened, state, commands);
        }
        None => nothing(ui, body, model),
    }
    days::show(ui, state, commands);
    state.ask(model, commands);
}

/// Shows a text in place of a report.
fn nothing(ui: &mut Ui, rect: Rect, model: &Model) {
    let t = theme::tokens(ui);
    let place = rect.shrink2(vec2(PADDING, PADDING));
    ui.scope_builder(UiBuilder::new().id_salt("no report").max_rect(place), |ui| {
        let (head, words) = RecordState::why_nothing(model);
        ui.label(RichText::new(head).font(text::value()));
        ui.label(RichText::new(words).font(text::body()).color(t.t2));
    });
}

fn show_report(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    opened: &crate::contract::record::OpenedPass,
    state: &mut RecordState,
    commands: &mut Vec<UiCommand>,
) {
    let (head, rest) = rect.split_top_bottom_at_y(rect.top() + report::HEAD);
    report::head(ui, head, model, &opened.pass, commands);
    ui.scope_builder(UiBuilder::new().id_salt("report").max_rect(rest), |ui| {
        ui.set_clip_rect(rest.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        ScrollArea::vertical().id_salt("report").auto_shrink(false).show(ui, |ui| {
            let width = rest.width();
            let verdict = report::verdict_height(ui, width, model, &opened.pass);
            let (_, place) = ui.allocate_space(vec2(width, verdict));
            report::verdict(ui, place, model, &opened.pass);
            let is_wide = width >= TABLES_BELOW;
            let rows = explain::height(opened);
            let tables =
                if is_wide { rows.max(facts::HEIGHT).max(TABLES) } else { rows + facts::HEIGHT };
            // The drawings take the spare height of a large window.
            let drawings = (rest.height() - verdict - tables).max(DRAWINGS);
            let (_, place) = ui.allocate_space(vec2(width, drawings));
            let side = (0.344 * width).clamp(PATH.0, PATH.1.max(drawings));
            let (left, right) = place.split_left_right_at_x(place.left() + side);
            path::show(ui, left, model, opened, state);
            curves::show(ui, right, model, opened, state, commands);
            if is_wide {
                let (_, place) = ui.allocate_space(vec2(width, tables));
                let side = (0.375 * width).clamp(340.0, 420.0);
                let (left, right) = place.split_left_right_at_x(place.right() - side);
                explain::show(ui, left, model, opened, state);
                facts::show(ui, right, model, opened, commands);
            } else {
                let (_, place) = ui.allocate_space(vec2(width, rows));
                explain::show(ui, place, model, opened, state);
                let (_, place) = ui.allocate_space(vec2(width, facts::HEIGHT));
                facts::show(ui, place, model, opened, commands);
            }
        });
    });
}
