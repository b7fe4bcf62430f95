//! Elevation, azimuth and pointing error of the selected pass over time.

mod curves;
pub(super) mod dashes;
mod error_plot;
mod head;
mod marker;
mod past;
pub(super) mod scale;
mod words;

use egui::{Align2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use jiff::Timestamp;

use super::{text, theme, widgets::paint};
use crate::{astro::HorizonMask, plan::Sample, ui::time_axis::TimeAxis};
pub use past::PastModel;

/// Padding at the left and the right edge, points.
const PADDING: f32 = 16.0;
/// Centre of the line with the title, from the top, points.
const HEAD_Y: f32 = 19.0;
/// Distance of the plots from the top, points.
const PLOTS_TOP: f32 = 45.0;
/// Width of the left scale, points.
const LEFT_SCALE: f32 = 42.0;
/// Width of the right scale, points.
const RIGHT_SCALE: f32 = 44.0;
/// Gap between the two plots, points.
const PLOT_GAP: f32 = 10.0;
/// Height below the plots for the times, points.
const TIMES: f32 = 25.0;
/// Min height of the upper plot, points; with less room the profile is empty.
const MIN_PLOT: f32 = 24.0;

/// The selected pass, with samples in order of time.
#[derive(Debug, Clone, Copy)]
pub struct ProfileModel<'a> {
    pub now: Timestamp,
    pub name: &'a str,
    /// Predicted path from the begin to the end of the pass.
    pub track: &'a [Sample],
    /// Sample at the highest point of the pass.
    pub tca: Sample,
    /// `true` if the pass continues beyond the first or the last sample.
    pub cut: bool,
    /// The horizon mask of the site.
    pub mask: Option<&'a HorizonMask>,
    /// Times, and the angles between satellite and beam axis, degrees. A value that is not finite
    /// breaks the line.
    pub errors: &'a [(Timestamp, f32)],
    /// Half of the beam width, degrees.
    pub half_beam_deg: f64,
    /// Time that another view marks.
    pub marked: Option<Timestamp>,
}

/// State of the profile, kept from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct ProfileState {
    /// Time that the arrow keys mark.
    cursor: Option<Timestamp>,
    /// Begin of the past track that the operator has opened.
    past: Option<Timestamp>,
}

/// Shows the profile in `rect`; the design size is 392 by 208 points. Returns the time that the
/// operator marks in it.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: Option<&ProfileModel<'_>>,
    past: &[PastModel<'_>],
    state: &mut ProfileState,
) -> Option<Timestamp> {
    let shown = past.iter().find(|track| Some(track.start) == state.past);
    let head_room = past::choice(ui, rect, past, shown, &mut state.past);
    if let Some(track) = shown {
        past::show(ui, rect, head_room, track);
        return None;
    }
    let sense = Sense::focusable_noninteractive();
    let response = ui.interact(rect, ui.make_persistent_id("pass profile"), sense);
    let Some(model) = model else {
        let sentence = "No pass selected.";
        empty(ui, rect, sentence);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, sentence));
        return None;
    };
    let head = head_room;
    head::show(ui, head, model.name);

    let error_rect = Rect::from_min_max(
        pos2(rect.left() + LEFT_SCALE, rect.bottom() - TIMES - error_plot::HEIGHT),
        pos2(rect.right() - RIGHT_SCALE, rect.bottom() - TIMES),
    );
    let curves_rect = Rect::from_min_max(
        pos2(error_rect.left(), rect.top() + PLOTS_TOP),
        pos2(error_rect.right(), error_rect.top() - PLOT_GAP),
    );
    let Some(axis) = axis(model.track, curves_rect) else {
        let sentence = format!("The path of {} is not known.", model.name);
        empty(ui, rect.with_min_y(head.bottom()), &sentence);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &sentence));
        return None;
    };
    let mut requested = None;
    if curves_rect.width() >= MIN_PLOT && curves_rect.height() >= MIN_PLOT {
        curves::show(ui, curves_rect, &axis, model);
        error_plot::show(ui, error_rect, &axis, model.errors, model.half_beam_deg);
        let plots = curves_rect.union(error_rect);
        now_line(ui, plots, &axis, model.now);
        words::times(ui, error_rect, &axis, model);
        requested =
            marker::requested_time(ui, &response, plots, &axis, model.now, &mut state.cursor);
        if let Some(time) = requested.or(model.marked) {
            marker::paint(ui, plots, curves_rect, &axis, model, time);
        }
    }
    if response.has_focus() {
        let stroke = Stroke::new(2.0, theme::tokens(ui).sat);
        ui.painter().rect_stroke(rect.shrink(2.0), 0.0, stroke, egui::StrokeKind::Inside);
    }
    let sentence = words::sentence(&axis, model);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &sentence));
    requested
}

fn empty(ui: &Ui, rect: Rect, sentence: &str) {
    let room = rect.shrink2(vec2(PADDING.min(rect.width() / 2.0), 0.0));
    let colour = theme::tokens(ui).t2;
    paint::text_in(ui, room, Align2::CENTER_CENTER, sentence, text::body(), colour);
}

/// Returns the time axis from the first to the last sample; `None` if no time lies between them.
fn axis(track: &[Sample], rect: Rect) -> Option<TimeAxis> {
    TimeAxis::new(track.first()?.time, track.last()?.time, rect.x_range())
}

fn now_line(ui: &Ui, rect: Rect, axis: &TimeAxis, now: Timestamp) {
    if !axis.contains(now) {
        return;
    }
    let colour = theme::tokens(ui).t1;
    let (x, top) = (axis.x(now), rect.top());
    ui.painter().line_segment([pos2(x, top), pos2(x, rect.bottom())], (1.75, colour));
    let corners = vec![pos2(x - 5.0, top - 7.0), pos2(x + 5.0, top - 7.0), pos2(x, top)];
    ui.painter().add(Shape::convex_polygon(corners, colour, Stroke::NONE));
}

#[cfg(test)]
mod tests;
