//! A gauge for the position of an axis in its travel.

use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};

use super::paint;
use crate::ui::{
    format,
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

/// Height of one gauge, points.
pub const HEIGHT: f32 = 28.0;
/// Distance from an end of the travel within which the gauge is hatched, degrees.
const NEAR_END_DEG: f64 = 10.0;
const TAG: Vec2 = Vec2::new(25.0, 17.0);
const TRACK: f32 = 4.0;

#[derive(Debug, Clone, Copy)]
pub struct TravelModel<'a> {
    pub name: &'a str,
    /// Range of the gauge, degrees; the parts outside the travel are red.
    pub scale_deg: (f64, f64),
    /// Travel that the unit may use, degrees.
    pub travel_deg: (f64, f64),
    pub position_deg: Option<f64>,
    /// `true` if the unit does not answer in time; position and limits are then from its last
    /// answer.
    pub is_old: bool,
    /// Number of decimals of the position.
    pub decimals: usize,
    /// `true` if the limit switch at the lower end is set.
    pub lower_limit: bool,
    /// `true` if the limit switch at the upper end is set.
    pub upper_limit: bool,
    /// `true` to show a tick for each full turn, for mounts that wrap their cables.
    pub turns: bool,
}

impl TravelModel<'_> {
    /// Returns the formatted position.
    pub fn number(&self) -> String {
        self.position_deg.map_or_else(
            || super::axes_table::UNKNOWN.to_owned(),
            |deg| format::degrees(deg, self.decimals),
        )
    }
}

/// Returns the place of a value on the gauge, from 0 at the lower end to 1 at the upper end.
fn part(value_deg: f64, (low, high): (f64, f64)) -> f32 {
    if high > low && value_deg.is_finite() {
        ((value_deg - low) / (high - low)).clamp(0.0, 1.0) as f32
    } else {
        0.0
    }
}

/// Returns the hatched stretch at an end of the travel, if the position is near an end.
fn near_end(position_deg: f64, (low, high): (f64, f64)) -> Option<(f64, f64)> {
    if position_deg >= high - NEAR_END_DEG {
        Some((high - NEAR_END_DEG, high))
    } else if position_deg <= low + NEAR_END_DEG {
        Some((low, low + NEAR_END_DEG))
    } else {
        None
    }
}

/// Returns the places of the ticks: the middle, or each full turn.
fn ticks(model: &TravelModel<'_>) -> Vec<f64> {
    let (low, high) = model.scale_deg;
    if !model.turns {
        return vec![f64::midpoint(low, high)];
    }
    let (first, last) = ((low / 360.0).ceil() as i32, (high / 360.0).floor() as i32);
    (first..=last).map(|turn| f64::from(turn) * 360.0).collect()
}

/// Shows the gauge in `rect`: name, limit tags, track and number.
pub fn show(ui: &Ui, rect: Rect, model: &TravelModel<'_>) {
    let t = theme::tokens(ui);
    let y = rect.center().y;
    let strong = text::sized(13.0, Weight::SemiBold);
    paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, model.name, strong, t.t1);
    let lower = Rect::from_min_size(pos2(rect.left() + 24.0, y - TAG.y / 2.0), TAG);
    let upper = lower.translate(vec2(rect.width() - 99.0, 0.0));
    tag(ui, lower, &format!("{}−", model.name), model.lower_limit, t);
    tag(ui, upper, &format!("{}+", model.name), model.upper_limit, t);
    let track = Rect::from_min_max(
        pos2(lower.right() + 7.0, y - TRACK / 2.0),
        pos2(upper.left() - 7.0, y + TRACK / 2.0),
    );
    let x = |deg: f64| track.left() + part(deg, model.scale_deg) * track.width();
    ui.painter().rect_filled(track, 0.0, t.bg3);
    for tick in ticks(model) {
        ui.painter().vline(x(tick), (y - 4.5)..=(y + 4.5), (1.5, t.edge));
    }
    for (start, last) in [
        (track.left(), x(model.travel_deg.0).max(track.left() + 3.0)),
        (x(model.travel_deg.1).min(track.right() - 3.0), track.right()),
    ] {
        let end = Rect::from_min_max(pos2(start, y - 4.0), pos2(last, y + 4.0));
        ui.painter().rect_filled(end, 0.0, t.keep);
    }
    let number = model.number();
    if let Some(deg) = model.position_deg {
        if let Some((start, last)) = near_end(deg, model.travel_deg) {
            let zone = Rect::from_min_max(pos2(x(start), y - 4.0), pos2(x(last), y + 4.0));
            hatch(ui, zone, t.warn);
        }
        let ended = model.lower_limit || model.upper_limit;
        let colour = match (model.is_old, ended) {
            (true, _) => t.t3,
            (false, true) => t.bad,
            (false, false) => t.ant,
        };
        marker(ui, x(deg), y, colour);
    }
    let ink = if model.is_old { t.t3 } else { t.t1 };
    let medium = text::body_medium();
    paint::text(ui, rect.right_center(), Align2::RIGHT_CENTER, &number, medium, ink);
    let limits = match (model.lower_limit, model.upper_limit) {
        (true, true) => ", both limit switches set",
        (true, false) => ", lower limit switch set",
        (false, true) => ", upper limit switch set",
        (false, false) => "",
    };
    let old = if model.is_old { ", of the last answer" } else { "" };
    paint::name_text(
        ui,
        ("travel", model.name),
        rect,
        &format!("Travel {} {number}{limits}{old}", model.name),
    );
}

fn tag(ui: &Ui, rect: Rect, word: &str, set: bool, t: &Tokens) {
    let (fill, border, colour) =
        if set { (t.bad, t.bad, t.onsat) } else { (Color32::TRANSPARENT, t.edge, t.t2) };
    ui.painter().rect(rect, 3.0, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    paint::text(ui, rect.center(), Align2::CENTER_CENTER, word, text::caption(), colour);
}

fn marker(ui: &Ui, x: f32, y: f32, colour: Color32) {
    let head = vec![pos2(x - 4.0, y - 10.0), pos2(x + 4.0, y - 10.0), pos2(x, y - 4.0)];
    ui.painter().add(Shape::convex_polygon(head, colour, Stroke::NONE));
    ui.painter().vline(x, (y - 8.0)..=(y + 7.0), (2.0, colour));
}

fn hatch(ui: &Ui, zone: Rect, colour: Color32) {
    let painter = ui.painter_at(zone);
    let mut x = zone.left() - zone.height();
    while x < zone.right() {
        let ends = [pos2(x, zone.top()), pos2(x + zone.height(), zone.bottom())];
        painter.line_segment(ends, Stroke::new(1.25, colour));
        x += 4.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    const AXIS: TravelModel<'_> = TravelModel {
        name: "X",
        scale_deg: (0.0, 180.0),
        travel_deg: (6.0, 174.0),
        position_deg: Some(175.0),
        is_old: false,
        decimals: 1,
        lower_limit: false,
        upper_limit: true,
        turns: false,
    };

    #[test]
    fn the_marker_stays_on_the_gauge() {
        for (deg, requested) in [(0.0, 0.0), (90.0, 0.5), (180.0, 1.0), (-40.0, 0.0), (900.0, 1.0)]
        {
            assert!((part(deg, AXIS.scale_deg) - requested).abs() < 1e-6, "{deg}");
        }
        assert!(part(f64::NAN, AXIS.scale_deg).abs() < 1e-6);
        assert!(part(5.0, (10.0, 10.0)).abs() < 1e-6);
    }

    #[test]
    fn only_the_last_ten_degrees_are_hatched() {
        assert_eq!(near_end(163.9, AXIS.travel_deg), None);
        assert_eq!(near_end(164.0, AXIS.travel_deg), Some((164.0, 174.0)));
        assert_eq!(near_end(15.0, AXIS.travel_deg), Some((6.0, 16.0)));
    }

    #[test]
    fn a_cable_wrap_has_a_tick_each_turn() {
        let wrap = TravelModel { scale_deg: (-270.0, 450.0), turns: true, ..AXIS };
        assert_eq!(ticks(&wrap), [0.0, 360.0]);
        assert_eq!(ticks(&AXIS), [90.0]);
    }

    #[test]
    fn a_set_limit_is_said() {
        let window = testing::window([400.0, 80.0], (), |ui, ()| {
            show(ui, Rect::from_min_size(pos2(10.0, 10.0), vec2(312.0, HEIGHT)), &AXIS);
        });
        window.get_by_label("Travel X 175.0°, upper limit switch set");
    }

    #[test]
    fn an_old_position_is_said() {
        let window = testing::window([400.0, 80.0], (), |ui, ()| {
            let old = TravelModel { is_old: true, upper_limit: false, ..AXIS };
            show(ui, Rect::from_min_size(pos2(10.0, 10.0), vec2(312.0, HEIGHT)), &old);
        });
        window.get_by_label("Travel X 175.0°, of the last answer");
    }
}
