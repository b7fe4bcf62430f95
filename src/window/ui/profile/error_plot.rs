//! The plot of the pointing error along the pass.

use egui::{Align2, Rect, Stroke, Ui, pos2};
use jiff::Timestamp;

use super::{dashes, scale};
use crate::ui::{format, text, theme, time_axis::TimeAxis, widgets::paint};

/// Height of the plot, points.
pub(super) const HEIGHT: f32 = 32.0;
/// Dash and gap of the line at half the beam, points.
const DASH: (f32, f32) = (4.0, 4.0);
/// Description of the plot for screen readers.
const DESCRIPTION: &str = "Pointing error: the measured angle between the antenna's direction and the \
                     satellite. The dashed line is half the beamwidth.";
/// Gap between the plot and the words next to it, points.
const GAP: f32 = 6.0;

/// Shows the plot in `rect`; its name and the half beam stand next to it.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    axis: &TimeAxis,
    measured: &[(Timestamp, f32)],
    half_beam_deg: f64,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    ui.painter().hline(rect.x_range(), rect.bottom(), (1.0, t.line));
    let name = pos2(rect.left() - GAP, rect.center().y);
    let name = paint::text(ui, name, Align2::RIGHT_CENTER, "err", text::caption(), t.t2);
    paint::name_text(ui, "pointing error", name.expand(3.0), DESCRIPTION)
        .on_hover_text(DESCRIPTION);

    let errors = || {
        let on_axis = measured.iter().filter(|(time, _)| axis.contains(*time));
        on_axis.map(|&(time, error_deg)| (axis.x(time), f64::from(error_deg)))
    };
    let top = scale::error_top_deg(errors().map(|(_, error_deg)| error_deg), half_beam_deg);
    if scale::has_beam(half_beam_deg) {
        let y = scale::y(rect, half_beam_deg, top);
        let line = [pos2(rect.left(), y), pos2(rect.right(), y)];
        let stroke = Stroke::new(1.0, t.cmd);
        dashes::paint(ui.painter(), &line, stroke, DASH);
        let number = format::number(half_beam_deg, 2);
        let position = pos2(rect.right() + GAP, y);
        paint::text(ui, position, Align2::LEFT_CENTER, number, text::caption(), t.cmd);
    }
    let painter = ui.painter_at(rect);
    for piece in scale::pieces(errors(), rect, top) {
        painter.line(piece, Stroke::new(1.5, t.ant));
    }
}
