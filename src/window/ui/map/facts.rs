//! Figures of the selected satellite.

use egui::{Rect, Ui, pos2, vec2};

use super::{PADDING, words};
use crate::{
    model::{Model, globe::GlobeSatellite},
    ui::{format, theme, widgets::paint},
};

/// Height of a line, points.
const LINE: f32 = 20.0;
const COUNT: usize = 7;

/// Height of all lines, points.
pub(super) const HEIGHT: f32 = COUNT as f32 * LINE;

/// Draws the lines of the figures into `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, satellite: &GlobeSatellite) {
    let t = theme::tokens(ui);
    for (index, (name, value)) in facts(model, satellite).into_iter().enumerate() {
        let min = pos2(rect.left() + PADDING, rect.top() + index as f32 * LINE);
        let line = Rect::from_min_size(min, vec2(rect.width() - 2.0 * PADDING, LINE));
        paint::fact_in(ui, ("fact", index), line, name, &value, t.t1);
    }
}

fn facts(model: &Model, satellite: &GlobeSatellite) -> [(&'static str, String); COUNT] {
    let direction = satellite.look.direction;
    let elevation = words::elevation(model.globe.aos_elevation);
    let unit = model.appearance.distances;
    let distance = |km| format::distance(km, 0, unit);
    let (height, speed) =
        (distance(satellite.below.height_km), format::speed(satellite.speed_km_s, unit));
    let radius = distance(satellite.footprint.radius_km());
    let minutes = format::number(satellite.satellite.elements.period_s() / 60.0, 1);
    [
        ("Sub-satellite point", words::place(satellite.below.point)),
        ("Height, speed", format!("{height}, {speed}")),
        ("Footprint radius", format!("{radius} at {elevation}")),
        (
            "From the station",
            format!(
                "az {}, el {}, {}",
                format::degrees(direction.azimuth_deg(), 1),
                format::degrees(direction.elevation_deg(), 1),
                distance(satellite.look.range_km),
            ),
        ),
        ("Heading", words::goes(satellite.heading).to_owned()),
        ("Period", format!("{minutes} min")),
        ("Light", words::light(satellite.is_sunlit).to_owned()),
    ]
}
