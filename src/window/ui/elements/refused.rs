//! Records that Azel could not read, with the reason for each.

use egui::{Align2, Rect, Role, ScrollArea, Ui, UiBuilder, pos2, vec2};

use super::{ElementsState, PADDING};
use crate::{
    contract::sources::Sources,
    model::Model,
    orbit::Refusal,
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::paint,
        words::sentence,
    },
};

const BAR: f32 = 32.0;
const ROW: f32 = 24.0;
const MAX_ROWS: usize = 3;

/// Returns the height of the part, points; zero if no record was refused.
pub(super) fn height(model: &Model, state: &ElementsState) -> f32 {
    match (refused(&model.sources), state.refused_are_open) {
        (0, _) => 0.0,
        (_, false) => BAR,
        (count, true) => BAR + count.min(MAX_ROWS) as f32 * ROW,
    }
}

fn refused(sources: &Sources) -> usize {
    sources.reports.iter().map(crate::orbit::SourceReport::refused).sum()
}

/// Returns the listed refusals with the names of their sources.
fn listed(sources: &Sources) -> impl Iterator<Item = (&str, &Refusal)> {
    sources.reports.iter().flat_map(|report| {
        let files = report.files.iter().flat_map(|file| &file.merge.refused);
        files.map(|refusal| (report.source.as_str(), refusal))
    })
}

pub(super) fn show(ui: &mut Ui, rect: Rect, model: &Model, state: &mut ElementsState) {
    let count = refused(&model.sources);
    if count == 0 {
        return;
    }
    let t = theme::tokens(ui);
    let (bar, body) = rect.split_top_bottom_at_y(rect.top() + BAR);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let title = format::counted(count, "refused record");
    let more = "The previous elements stay in use.";
    let name = format!("{title}. {more}");
    let response = paint::control(ui, "refused records", bar, Role::Button, true, &name);
    let is_open = state.refused_are_open;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(is_open));
    ui.painter().rect_filled(bar, 0.0, if response.hovered() { t.bg3 } else { t.bg1 });
    let icon = if is_open { Icon::ChevronDown } else { Icon::ChevronRight };
    let area = |x: f32| paint::square(pos2(bar.left() + x, bar.center().y), 12.0);
    icons::paint(ui.painter(), area(PADDING + 4.0), icon, t.t2);
    icons::paint(ui.painter(), area(PADDING + 24.0), Icon::Warning, t.warn);
    let room = bar.with_min_x(bar.left() + PADDING + 38.0).with_max_x(bar.right() - PADDING);
    let font = text::sized(13.0, Weight::SemiBold);
    let title = paint::text_in(ui, room, Align2::LEFT_CENTER, &title, font, t.t1);
    let room = room.with_min_x(title.right() + 12.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, more, text::small(), t.t2);
    paint::focus_ring(ui, &response, 0);
    if response.clicked() {
        state.refused_are_open = !is_open;
    }
    if is_open {
        rows(ui, body, &model.sources);
    }
}

fn rows(ui: &mut Ui, rect: Rect, sources: &Sources) {
    let t = theme::tokens(ui);
    let count = listed(sources).count();
    ui.scope_builder(UiBuilder::new().id_salt("refused").max_rect(rect), |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let area = ScrollArea::vertical().id_salt("refused").auto_shrink(false);
        area.show_rows(ui, ROW, count, |ui, range| {
            let top = ui.max_rect().top();
            let shown = listed(sources).enumerate().skip(range.start).take(range.len());
            for (place, (index, (source, refusal))) in shown.enumerate() {
                let min = pos2(rect.left(), top + place as f32 * ROW);
                let row = Rect::from_min_size(min, vec2(rect.width(), ROW));
                let cell = |start: f32, end: f32, words: &str, colour| {
                    let room = row.with_min_x(row.left() + start);
                    let room = room.with_max_x((row.left() + end).min(row.right() - PADDING));
                    let left = Align2::LEFT_CENTER;
                    paint::text_in(ui, room, left, words, text::small(), colour);
                };
                let line = format!("line {}", format::number(refusal.line as f64, 0));
                let object = refusal.object.as_deref().unwrap_or("no name");
                let reason = sentence(&refusal.reason.to_string());
                cell(54.0, 150.0, source, t.t1);
                cell(158.0, 236.0, &line, t.t2);
                cell(244.0, 400.0, object, t.t1);
                let position = pos2(row.left() + 414.0, row.center().y);
                icons::paint(ui.painter(), paint::square(position, 11.0), Icon::Cross, t.bad);
                cell(428.0, f32::INFINITY, &reason, t.t1);
                let spoken = format!("{source}, {line}, {object}: {reason}");
                paint::name_text(ui, ("refused", index), row, &spoken).on_hover_text(&spoken);
            }
        });
    });
}
