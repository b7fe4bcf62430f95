//! The hours above the lanes, the grid through them, and the now-line.

use egui::{Align2, Rangef, Rect, Shape, Stroke, Ui, pos2, vec2};

use super::TimelineModel;
use crate::ui::{
    format, text, theme,
    time_axis::{TimeAxis, is_full_hour},
    widgets::paint,
};

const NOW_WIDTH: f32 = 1.75;
const NOW_TRIANGLE: egui::Vec2 = vec2(10.0, 7.0);
/// Min width of an hour with a label, points.
const NARROW_HOUR: f32 = 40.0;
/// Min width of an hour with lines at half hours, points.
const WIDE_HOUR: f32 = 100.0;
const HOUR_S: i64 = 3600;

/// Returns the number of hours from one label to the next, so that labels do not touch.
fn named_every_hours(hour_width: f32) -> i64 {
    [1, 2, 3, 6, 12]
        .into_iter()
        .find(|hours| hour_width * *hours as f32 >= NARROW_HOUR)
        .unwrap_or(24)
}

/// Paints the background of the lanes, a line for each full hour in `lanes`, and the labels of the
/// hours in `names`, the band above.
pub(super) fn show(ui: &Ui, scale: &TimeAxis, lanes: Rect, names: Rect) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(lanes, 0, t.bg0);
    let step_s = if scale.hour_width() >= WIDE_HOUR { HOUR_S / 2 } else { HOUR_S };
    for time in scale.multiples(step_s) {
        ui.painter().vline(scale.x(time), lanes.y_range(), (1.0, t.line));
    }
    for (x, name) in hour_names(ui, scale, names) {
        let place = pos2(x, names.center().y);
        paint::text(ui, place, Align2::CENTER_CENTER, name, text::caption(), t.t3);
    }
}

/// Returns the labels of hours, each with the x of its centre. Omits labels that would extend
/// beyond the end of the lane.
fn hour_names(ui: &Ui, scale: &TimeAxis, names: Rect) -> Vec<(f32, String)> {
    let every_s = named_every_hours(scale.hour_width()) * HOUR_S;
    let hours = scale.multiples(every_s).filter(|time| is_full_hour(*time));
    let named = hours.map(|time| (scale.x(time), format::on_axis(time)));
    let fits = |(x, name): &(f32, String)| {
        x + paint::text_width(ui, name, text::caption()) / 2.0 <= names.right()
    };
    named.filter(fits).collect()
}

/// Paints the now-line through `y` with its triangle on top, and a dashed line for the time that
/// the sky plot shows.
pub(super) fn time_lines(ui: &Ui, scale: &TimeAxis, model: &TimelineModel<'_>, y: Rangef) {
    let t = theme::tokens(ui);
    if let Some(time) = model.time.filter(|time| *time < scale.end()) {
        let x = scale.x(time);
        let line = [pos2(x, y.min), pos2(x, y.max)];
        ui.painter().extend(Shape::dashed_line(&line, Stroke::new(NOW_WIDTH, t.warn), 4.0, 3.0));
    }
    let x = scale.x(model.now);
    ui.painter().vline(x, y, Stroke::new(NOW_WIDTH, t.t1));
    let half = NOW_TRIANGLE.x / 2.0;
    let tip = pos2(x, y.min + NOW_TRIANGLE.y);
    let triangle = vec![pos2(x - half, y.min), pos2(x + half, y.min), tip];
    ui.painter().add(Shape::convex_polygon(triangle, t.t1, Stroke::NONE));
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::ui::widgets::testing;

    #[test]
    fn no_name_of_an_hour_reaches_beyond_the_lane() {
        let names = Rect::from_min_size(pos2(100.0, 0.0), vec2(504.0, 24.0));
        // With each of these times, the end of the strip comes nearer to the last hour.
        let ends = ["22:56", "22:20", "22:12", "22:11", "22:10"];
        let last = ends.map(|end| {
            let now = format!("2026-11-14T{end}:00Z").parse::<Timestamp>().unwrap();
            let now = now - jiff::SignedDuration::from_mins(12 * 60 - 10);
            let scale = super::super::scale::axis(now, 12.0, names.x_range());
            let mut window = testing::window([640.0, 80.0], Vec::new(), move |ui, shown| {
                *shown = hour_names(ui, &scale, names);
            });
            window.run();
            let (x, name) = window.state().last().unwrap().clone();
            assert!(x + 12.0 < names.right(), "{name} at {x}");
            name
        });
        assert_eq!(last, ["22:00", "21:00", "21:00", "21:00", "21:00"]);
    }

    #[test]
    fn narrow_hours_are_not_all_named() {
        assert_eq!(named_every_hours(45.0), 1);
        assert_eq!(named_every_hours(25.0), 2);
        assert_eq!(named_every_hours(8.0), 6);
        assert_eq!(named_every_hours(1.0), 24);
    }
}
