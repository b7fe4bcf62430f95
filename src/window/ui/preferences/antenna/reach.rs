//! The part of the sky that an antenna reaches, with its park position.

use std::f32::consts::TAU;

use egui::{Label, Mesh, Painter, RichText, Sense, Shape, Stroke, Ui, Vec2, vec2};

use crate::{
    astro::Angle,
    station::{Antenna, Mount},
    ui::{
        format,
        preferences::antenna_fields::has_elevation,
        sky_plot::{
            Keyholes,
            geometry::{Dome, outward},
            grid,
        },
        text, theme,
        tokens::Tokens,
    },
};

/// Angle between two points of an arc, degrees.
const STEP_DEG: f64 = 3.0;
/// Length of the mark at an end of the travel, points.
const STOP: f32 = 10.0;

/// Shows the plot in a square, with the saved ends of the travel.
pub(super) fn plot(ui: &mut Ui, was: &Antenna, new: &Antenna) {
    let t = theme::tokens(ui);
    let side = Vec2::splat(ui.available_width());
    let (rect, _) = ui.allocate_exact_size(side, Sense::hover());
    let dome = Dome::fitted(rect);
    let painter = ui.painter_at(rect);
    grid::disc(&painter, dome, t);
    let (before, travel) = (Travel::new(was), Travel::new(new));
    if let Some(travel) = travel {
        painter.add(travel.area(dome, t));
    }
    grid::rings(&painter, dome, t);
    grid::ring_numbers(&painter, dome, t);
    if let Some(holes) = Keyholes::new(&new.mount) {
        grid::keyholes(&painter, dome, &holes, t);
    }
    grid::rim(&painter, dome, Angle::from_degrees(new.limits.minimum_elevation_deg), t);
    if let Some(before) = before.filter(|_| before != travel) {
        before.paint_ends(&painter, dome, Stroke::new(1.5, t.t3));
    }
    if let Some(travel) = travel {
        travel.paint_ends(&painter, dome, Stroke::new(2.0, t.bad));
    }
    if let Some(position) = dome.visible(new.park_direction()) {
        let corners =
            [vec2(0.0, -6.0), vec2(6.0, 5.0), vec2(-6.0, 5.0)].map(|corner| position + corner);
        painter.add(Shape::closed_line(corners.to_vec(), Stroke::new(1.5, t.t1)));
    }
}

/// Shows the content of the plot in words.
pub(super) fn words(ui: &mut Ui, antenna: &Antenna) {
    let t = theme::tokens(ui);
    let words = RichText::new(sentence(antenna)).font(text::small()).color(t.t2);
    ui.add(Label::new(words).wrap());
}

/// Travel of an elevation-over-azimuth mount, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Travel {
    azimuth: (f64, f64),
    elevation: (f64, f64),
}

impl Travel {
    fn new(antenna: &Antenna) -> Option<Self> {
        let Mount::AzEl { .. } = antenna.mount else { return None };
        let [azimuth, (lowest, highest)] = antenna.mount.travel_deg();
        let whole = (0.0, 90.0);
        let elevation =
            if has_elevation(antenna) { (lowest.max(0.0), highest.min(90.0)) } else { whole };
        Some(Self { azimuth, elevation })
    }

    fn span_deg(&self) -> f64 {
        self.azimuth.1 - self.azimuth.0
    }

    /// Returns the part of the disc between the ends of both axes.
    fn area(&self, dome: Dome, t: &Tokens) -> Mesh {
        let mut mesh = Mesh::default();
        let span_deg = self.span_deg().clamp(0.0, 360.0);
        let steps = (span_deg / STEP_DEG).ceil().max(1.0) as u32;
        for step in 0..=steps {
            let azimuth_deg = self.azimuth.0 + span_deg * f64::from(step) / f64::from(steps);
            let azimuth = (azimuth_deg.to_radians() as f32).rem_euclid(TAU);
            for elevation_deg in [self.elevation.0, self.elevation.1] {
                mesh.colored_vertex(dome.point_at(azimuth, elevation_deg as f32), t.bgsel);
            }
            if step > 0 {
                let first = 2 * (step - 1);
                mesh.add_triangle(first, first + 1, first + 2);
                mesh.add_triangle(first + 1, first + 2, first + 3);
            }
        }
        mesh
    }

    /// Marks both ends of the azimuth axis with the T of a stop.
    fn paint_ends(&self, painter: &Painter, dome: Dome, stroke: Stroke) {
        for azimuth_deg in [self.azimuth.0, self.azimuth.1] {
            let azimuth = (azimuth_deg.to_radians() as f32).rem_euclid(TAU);
            let (foot, out) = (dome.point_at(azimuth, 0.0), outward(azimuth));
            let across = out.rot90() * (STOP / 2.0);
            painter.line_segment([foot - out * STOP, foot], stroke);
            painter.line_segment([foot - across, foot + across], stroke);
        }
    }
}

fn sentence(antenna: &Antenna) -> String {
    let is_within = antenna.mount.reaches(antenna.park_direction());
    let park = if is_within { "" } else { " The park position lies outside the travel." };
    let Some(travel) = Travel::new(antenna) else {
        return format!("An X/Y mount: it is too slow inside the hatched keyholes.{park}");
    };
    let (start, end) = travel.azimuth;
    let [start_text, end_text] = [start, end].map(|deg| format::degrees(deg, 0));
    let span_deg = travel.span_deg();
    let reach = if span_deg > 360.0 {
        format!(
            " {} of the circle can be reached on two turns.",
            format::degrees(span_deg - 360.0, 0)
        )
    } else if span_deg < 360.0 {
        format!(" {} of the circle cannot be reached.", format::degrees(360.0 - span_deg, 0))
    } else {
        String::new()
    };
    format!("Azimuth from {start_text} to {end_text}.{reach}{park}")
}
