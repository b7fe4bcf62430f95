//! A choice among a few segments side by side.

use egui::{
    Align2, CornerRadius, Rect, Response, Role, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo,
    pos2, vec2,
};

use super::{button::RADIUS, paint};
use crate::ui::{text, theme};

/// State of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Segment {
    /// Can be chosen.
    #[default]
    Free,
    /// Is in force.
    Chosen,
    /// Is in force, but not by this console: dashed.
    Foreign,
    /// Requested, but not confirmed yet.
    Pending,
    /// Cannot be chosen now. Whoever points at it reads why, unless that stands beside it.
    Locked(Option<&'static str>),
}

impl Segment {
    fn is_locked(self) -> bool {
        matches!(self, Self::Locked(_))
    }
}

/// Shows segments in `rect`, each as wide as its text needs, with the remaining width shared
/// evenly. Returns the index of a clicked segment.
pub fn show(
    ui: &Ui,
    salt: &str,
    rect: Rect,
    name: &str,
    segments: &[(&str, Segment)],
) -> Option<usize> {
    let t = theme::tokens(ui);
    let group = ui.interact(rect, ui.make_persistent_id(salt), egui::Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(Role::RadioGroup, true, name));
    let cells = inside(ui, &group);
    ui.painter().rect_filled(rect, RADIUS, t.bg2);
    let wanted: Vec<f32> =
        segments.iter().map(|(word, _)| paint::text_width(ui, word, text::body_medium())).collect();
    let spare = (rect.width() - wanted.iter().sum::<f32>()) / segments.len().max(1) as f32;
    let mut x = rect.left();
    let mut clicked = None;
    let mut over_border = Vec::new();
    for (index, ((word, state), width)) in segments.iter().zip(wanted).enumerate() {
        let right = (x + width + spare).min(rect.right());
        let cell = Rect::from_min_max(pos2(x, rect.top()), pos2(right, rect.bottom()));
        let id = ui.make_persistent_id((salt, *word));
        let is_free = !state.is_locked();
        let sense = if is_free { egui::Sense::click() } else { egui::Sense::hover() };
        let response = cells.interact(cell, id, sense);
        let chosen = matches!(state, Segment::Chosen | Segment::Foreign);
        let is_foreign = *state == Segment::Foreign;
        let said =
            if is_foreign { format!("{word}, not by this console") } else { (*word).to_owned() };
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, is_free, chosen, &said));
        let radius = corners(index, segments.len());
        let colour = match state {
            Segment::Chosen => {
                ui.painter().rect_filled(cell, radius, t.sat);
                t.onsat
            }
            Segment::Locked(_) => t.t3,
            _ if response.hovered() => {
                ui.painter().rect_filled(cell, radius, t.bg3);
                t.t1
            }
            _ => t.t1,
        };
        if index > 0 {
            ui.painter().vline(cell.left(), cell.y_range().shrink(1.0), (1.0, t.line));
        }
        let room = cell.shrink2(vec2(1.0, 0.0));
        paint::text_in(ui, room, Align2::CENTER_CENTER, word, text::body_medium(), colour);
        if response.clicked() {
            clicked = Some(index);
        }
        over_border.push((*state, radius, response));
        x = right;
    }
    if segments.iter().all(|(_, state)| state.is_locked()) {
        paint::dashed_border(ui, rect, f32::from(RADIUS), Stroke::new(1.0, t.edge));
    } else {
        ui.painter().rect_stroke(rect, RADIUS, Stroke::new(1.0, t.edge), StrokeKind::Inside);
    }
    for (state, radius, response) in over_border {
        if state == Segment::Pending {
            let stroke = Stroke::new(2.0, t.cmd);
            ui.painter().rect_stroke(response.rect, radius, stroke, StrokeKind::Inside);
        }
        if state == Segment::Foreign {
            let inside = response.rect.shrink(1.0);
            paint::dashed_border(ui, inside, f32::from(RADIUS), Stroke::new(2.0, t.sat));
            response.clone().on_hover_text("Not by this console");
        }
        if let Segment::Locked(Some(why)) = state {
            response.clone().on_hover_text(why);
        }
        paint::focus_ring(ui, &response, RADIUS);
    }
    clicked
}

/// A place for the segments, whose nodes are children of the node of the group.
fn inside(ui: &Ui, group: &Response) -> Ui {
    let builder = UiBuilder::new().layer_id(ui.layer_id()).max_rect(group.rect);
    let builder = builder.accessibility_parent(group.id);
    let mut inside = Ui::new(ui.ctx().clone(), group.id.with("segments"), builder);
    inside.set_clip_rect(ui.clip_rect());
    if !ui.is_enabled() {
        inside.disable();
    }
    inside
}

fn corners(index: usize, count: usize) -> CornerRadius {
    let left = if index == 0 { RADIUS } else { 0 };
    let right = if index + 1 == count { RADIUS } else { 0 };
    CornerRadius { nw: left, sw: left, ne: right, se: right }
}
