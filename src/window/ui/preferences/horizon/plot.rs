//! The plot of the sky, in which the operator draws the skyline and the keep-outs.

mod draw;
mod handles;
mod scene;

use egui::{Align2, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use super::{Chosen, HorizonState, Tool, draft::Skies};
use crate::{
    model::Model,
    ui::{
        format,
        sky_plot::{
            geometry::{Dome, circle, dashed},
            legend,
        },
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

/// Side of the square of a corner handle, points.
const HANDLE: f32 = 10.0;
/// Height of a line of the legend, points.
const ROW: f32 = 17.0;

/// Room above the rim for the names of azimuths, points.
const NAMES: f32 = 24.0;

/// Shows the plot and handles drawing in it.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    skies: &mut Skies,
    state: &mut HorizonState,
) {
    if !crate::ui::sky_plot::geometry::usable(rect) {
        return;
    }
    let ui = &mut ui.new_child(egui::UiBuilder::new().id_salt("horizon plot").max_rect(rect));
    ui.shrink_clip_rect(rect);
    let t = theme::tokens(ui);
    // The hint needs no separate line next to a disc narrower than the plot.
    let hint_height = if rect.width() > rect.height() + 300.0 { 0.0 } else { 24.0 };
    let dome = Dome::fitted(rect.with_min_y(rect.top() + hint_height));
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let antenna = state.shown(model);

    // The canvas is only for the pointer. Tab leads to the points, which arrow keys move.
    let id = ui.make_persistent_id("canvas");
    let canvas = ui.interact(rect, id, Sense::CLICK | Sense::DRAG);
    let name = "Horizon and keep-outs of the site";
    canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
    scene::paint_sky(ui, rect, dome, model, skies, state, antenna);
    draw::draw_on_canvas(
        ui,
        &canvas,
        dome,
        skies,
        state,
        antenna.map(|model_antenna| &*model_antenna.config),
    );
    let marks = &mut paint::marks_of(ui, &canvas);
    match state.chosen {
        Chosen::Zone(index) => handles::zone_handles(marks, dome, index, skies, state, t),
        Chosen::Skyline | Chosen::Sun => {}
    }
    if state.chosen == Chosen::Skyline || state.tool == Tool::Point {
        handles::skyline_handles(marks, dome, skies, state, t);
    }
    handles::continue_drag(ui, dome, skies, state);
    draw::paint_drawing(ui, dome, state, t);

    let hint = match state.tool {
        Tool::Select => {
            "Drag a point, Shift keeps one axis, Alt-click an edge to add one, Del removes."
        }
        Tool::Point => "Click where the sky begins; drag a point to move it, Del removes it.",
        Tool::Polygon => {
            "Click corner after corner; a double click, or one on the first corner, ends it."
        }
        Tool::Rectangle => "Draw from one corner to the other.",
    };
    let line = rect.with_max_y(rect.top() + 32.0).shrink2(vec2(16.0, 0.0));
    // In a low window the plot reaches the line of the hint, so the hint takes two lines next to
    // the top of the plot.
    let is_beside = dome.centre.y - dome.radius - NAMES < line.bottom();
    if is_beside {
        let position = line.left_top() + vec2(0.0, 8.0);
        let width = dome.centre.x - line.left() - NAMES;
        paint::paragraph(ui, position, width, hint, text::small(), t.t3);
    } else {
        let room = line.with_max_x(line.right() - 90.0);
        paint::text_in(ui, room, Align2::LEFT_CENTER, hint, text::small(), t.t3);
    }
    paint::text_in(ui, line, Align2::RIGHT_CENTER, "N up, E right", text::small(), t.t3);
    show_legend(ui, rect, dome, t);
}

/// Draws a label with a background, kept inside the plot.
fn label(ui: &Ui, position: Pos2, anchor: Align2, words: &str, colour: egui::Color32, t: &Tokens) {
    let galley = ui.painter().layout_no_wrap(words.to_owned(), text::small(), colour);
    let bounds = anchor.anchor_size(position, galley.size());
    let visible = ui.clip_rect().shrink(4.0);
    let place =
        bounds.translate(bounds.min.clamp(visible.min, visible.max - galley.size()) - bounds.min);
    ui.painter().rect_filled(place.expand(2.0), 0.0, t.sky);
    ui.painter().galley(place.min, galley, colour);
}

/// Formats a direction.
pub(super) fn direction((azimuth_deg, elevation_deg): (f64, f64)) -> String {
    let azimuth = format::degrees(azimuth_deg, 1);
    format!("{azimuth}, {}", format::degrees(elevation_deg, 1))
}

fn show_legend(ui: &Ui, rect: Rect, dome: Dome, t: &Tokens) {
    type Sample = fn(&egui::Painter, Pos2, &Tokens);
    let rows: [(&str, Sample); 7] = [
        ("Horizon mask", legend::mask),
        ("Keep-out", legend::keep_out),
        ("Safety margin", legend::margin),
        ("End of travel", |painter, position, t| {
            let line = [position - vec2(10.0, 0.0), position + vec2(10.0, 0.0)];
            painter.extend(dashed(&line, 1.5, 4.0, Stroke::new(1.25, t.warn)));
        }),
        ("Sun avoidance", |painter, position, t| {
            painter.extend(dashed(&circle(position, 6.0), 3.0, 2.0, Stroke::new(1.25, t.sun)));
        }),
        ("Path of the Sun today", |painter, position, t| {
            let line = [position - vec2(10.0, 0.0), position + vec2(10.0, 0.0)];
            painter.extend(dashed(&line, 1.5, 4.0, Stroke::new(1.0, t.sun)));
        }),
        ("Blocked part of a pass", |painter, position, t| {
            let line = [position - vec2(10.0, 0.0), position + vec2(10.0, 0.0)];
            painter.line_segment(line, Stroke::new(1.5, t.warn));
        }),
    ];
    let corner = rect.left_bottom() + vec2(12.0, -6.0 - ROW * rows.len() as f32);
    let row = |index: usize, name: &str| {
        let width = paint::text_width(ui, name, text::small()) + 30.0;
        Rect::from_min_size(corner + vec2(0.0, ROW * index as f32), vec2(width, ROW))
    };
    let is_over = |(index, (name, _)): (usize, &(&str, Sample))| {
        row(index, name).clamp(dome.centre).distance(dome.centre) < dome.radius + 4.0
    };
    if rows.iter().enumerate().any(is_over) {
        return;
    }
    for (index, (name, sample)) in rows.into_iter().enumerate() {
        let middle = corner + vec2(10.0, ROW * (index as f32 + 0.5));
        sample(ui.painter(), middle, t);
        let point = middle + vec2(20.0, 0.0);
        ui.painter().text(point, Align2::LEFT_CENTER, name, text::small(), t.t2);
    }
}
