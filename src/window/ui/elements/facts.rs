//! The elements in use of the selected object.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::{PADDING, source_order, words};
use crate::{
    model::{Model, UiCommand},
    orbit::{Catalog, Elements},
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        widgets::paint,
    },
};

/// Height of a line, points.
const LINE: f32 = 18.0;
const TITLE: f32 = 30.0;
/// Number of lines across the whole width.
const WIDE: usize = 4;
/// Number of lines with two figures.
const HALVES: usize = 4;

pub(super) const HEIGHT: f32 = TITLE + (WIDE + HALVES) as f32 * LINE + 8.0;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    elements: &Elements,
    catalog: &Catalog,
    lock: Option<&str>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let title = inner.with_max_y(inner.top() + TITLE);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, title, Align2::LEFT_CENTER, "Elements in use", font, t.t1);
    let number = elements.catalog_number();
    let start_text = catalog.source_of(number).unwrap_or_default();
    let room = title.with_min_x(title.left() + 120.0);
    if catalog.set_aside(number).is_some() {
        let words = format!("older set, {start_text}");
        let drawn = paint::text_in(ui, room, Align2::RIGHT_CENTER, &words, text::small(), t.warn);
        let position = pos2(drawn.left() - 11.0, drawn.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), Icon::Warning, t.warn);
        let named = paint::name_text(ui, "older set in use", drawn, &words);
        if !paint::fits(ui, &words, text::small(), room) {
            named.on_hover_text(&words);
        }
    } else {
        paint::text_in(ui, room, Align2::RIGHT_CENTER, start_text, text::small(), t.t2);
    }
    let epoch = format::copied(elements.epoch());
    let (icon, colour) = words::age_look(words::age_tone(elements, model.now), t);
    let age = words::age(elements.age_s(model.now));
    let line = |index: usize| {
        let min = pos2(inner.left(), title.bottom() + index as f32 * LINE);
        Rect::from_min_size(min, vec2(inner.width(), LINE))
    };
    fact(ui, line(0), "Epoch", &epoch.clone(), t.t1);
    let place = fact(ui, line(1), "Age", &age, if icon.is_some() { colour } else { t.ok });
    if let Some(icon) = icon {
        let position = pos2(place.left() - 11.0, place.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
    }
    source_order::show(ui, line(2), model, catalog, number, lock, commands);
    let unit = model.appearance.distances;
    let heights = words::heights(elements.heights(), unit);
    let heights = format!("{heights} {}", format::distance_unit(unit));
    fact(ui, line(3), "Apogee × perigee", &heights, t.t1);
    let figures = figures(elements);
    // The right half holds the longer names.
    let (left, right) = (inner.width() * 0.45, inner.width() * 0.52);
    for (index, pair) in figures.chunks(2).enumerate() {
        let line = line(WIDE + index);
        let halves = [line.with_max_x(line.left() + left), line.with_min_x(line.right() - right)];
        for ((name, value), place) in pair.iter().zip(halves) {
            fact(ui, place, name, value, t.t1);
        }
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
}

fn fact(ui: &Ui, line: Rect, name: &str, value: &str, colour: Color32) -> Rect {
    paint::fact_in(ui, ("element fact", name), line, name, value, colour)
}

pub(super) fn figures(elements: &Elements) -> [(&'static str, String); 7] {
    let angle = |angle: crate::astro::Angle| format::degrees(angle.degrees(), 4);
    [
        ("Inclination", angle(elements.inclination())),
        ("RAAN", angle(elements.node())),
        ("Eccentricity", format!("{:.7}", elements.eccentricity())),
        ("Arg. of perigee", angle(elements.argument_of_perigee())),
        ("Mean motion", format!("{:.5}", elements.mean_motion_rev_day())),
        ("Mean anomaly", angle(elements.mean_anomaly())),
        ("B*", format!("{:.2e}", elements.bstar()).replace('-', "\u{2212}")),
    ]
}
