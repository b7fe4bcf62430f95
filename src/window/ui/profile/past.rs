//! The errors of past tracks: a list to choose from, and the curve of the chosen track.

use egui::{
    Align2, Popup, Rect, Role, Stroke, StrokeKind, TextWrapMode, Ui, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::{HEAD_Y, LEFT_SCALE, PADDING, PLOTS_TOP, RIGHT_SCALE, TIMES, error_plot};
use crate::{
    contract::antenna::Errors,
    ui::{
        format,
        icons::{self, Icon},
        text, theme,
        time_axis::TimeAxis,
        widgets::{close_key, menu, paint},
    },
};

/// Size of the button that opens the list, points.
const BUTTON: egui::Vec2 = vec2(24.0, 22.0);
const GAP: f32 = 10.0;

/// A past track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PastModel<'a> {
    pub now: Timestamp,
    pub name: &'a str,
    pub start: Timestamp,
    pub end: Timestamp,
    pub rms_deg: f64,
    pub worst_deg: f64,
    pub worst_at: Timestamp,
    pub errors: &'a Errors,
    /// Half of the beam width, degrees.
    pub half_beam_deg: f64,
}

impl PastModel<'_> {
    fn words(&self) -> String {
        let times = format::minutes(self.start, self.end, self.now);
        let rms = format::degrees(self.rms_deg, 2);
        let worst = format::degrees(self.worst_deg, 2);
        format!("{}, {times}: rms {rms}, worst {worst}", self.name)
    }
}

/// Shows the button that lists the past tracks, if there are any. Returns the free part of the head
/// line.
pub(super) fn choice(
    ui: &Ui,
    rect: Rect,
    past: &[PastModel<'_>],
    shown: Option<&PastModel<'_>>,
    chosen: &mut Option<Timestamp>,
) -> Rect {
    let line = Rect::from_center_size(
        pos2(rect.center().x, rect.top() + HEAD_Y),
        vec2((rect.width() - 2.0 * PADDING).max(0.0), 16.0),
    );
    if past.is_empty() {
        return line;
    }
    let t = theme::tokens(ui);
    let place = Align2::RIGHT_CENTER.anchor_size(line.right_center(), BUTTON);
    let name = "Errors of the last tracks";
    let response = paint::control(ui, "past tracks", place, Role::ComboBox, true, name);
    let border = if response.hovered() { t.t2 } else { t.edge };
    let fill = if shown.is_some() { t.bgsel } else { t.bg1 };
    ui.painter().rect(place, 5.0, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    icons::paint(ui.painter(), paint::square(place.center(), 14.0), Icon::Clock, t.t1);
    paint::focus_ring(ui, &response, 5);
    let response = response.on_hover_text(name);
    menu::show(&response, Popup::menu(&response).accessible_name(name), |ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        ui.selectable_value(chosen, None, "The selected pass");
        for track in past {
            ui.selectable_value(chosen, Some(track.start), track.words());
        }
        close_key::show(ui);
    });
    line.with_max_x(place.left() - GAP)
}

/// Shows the errors of a past track in `rect`, with its title in `head`.
pub(super) fn show(ui: &Ui, rect: Rect, head: Rect, track: &PastModel<'_>) {
    let t = theme::tokens(ui);
    let title = format!("{}, past track", track.name);
    let title = paint::text_in(ui, head, Align2::LEFT_CENTER, &title, text::small_strong(), t.t1);
    let rms = format::degrees(track.rms_deg, 2);
    let worst = format::degrees(track.worst_deg, 2);
    let time_text = format::moment(track.worst_at, track.now);
    let figures = format!("rms {rms} \u{b7} worst {worst} at {time_text}");
    let room = head.with_min_x(title.right() + GAP);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, &figures, text::caption(), t.t2);
    let plot = Rect::from_min_max(
        pos2(rect.left() + LEFT_SCALE, rect.top() + PLOTS_TOP),
        pos2(rect.right() - RIGHT_SCALE, rect.bottom() - TIMES),
    );
    let axis = TimeAxis::new(track.start, track.end, plot.x_range());
    if let Some(axis) = axis.filter(|_| plot.is_positive()) {
        let errors = track.errors.iter();
        let errors: Vec<_> =
            errors.map(|error| (error.time, error.off_beam.degrees() as f32)).collect();
        error_plot::show(ui, plot, &axis, &errors, track.half_beam_deg);
    }
    let y = plot.bottom() + TIMES / 2.0;
    let start_text = format!("from {}", format::moment(track.start, track.now));
    let end_text = format!("to {}", format::moment(track.end, track.now));
    let font = text::caption();
    paint::text(ui, pos2(plot.left(), y), Align2::LEFT_CENTER, start_text, font.clone(), t.t2);
    paint::text(ui, pos2(plot.right(), y), Align2::RIGHT_CENTER, end_text, font, t.t2);
    let response = ui.interact(rect, ui.make_persistent_id("past profile"), egui::Sense::hover());
    let spoken = format!("Past track of {}, worst at {time_text}.", track.words());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
}
