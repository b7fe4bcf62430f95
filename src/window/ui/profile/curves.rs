//! Elevation and azimuth along the pass.

use egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, pos2, vec2};

use super::{
    ProfileModel, dashes,
    scale::{self, AZIMUTH_TOP_DEG, ELEVATION_TOP_DEG},
};
use crate::{
    astro::HorizonMask,
    plan::Sample,
    ui::{format, text, theme, time_axis::TimeAxis, widgets::paint},
};

/// Dash and gap of the future part of the path, points.
const DASH: (f32, f32) = (6.0, 4.5);
/// Dash and gap of the azimuth curve, points.
pub(super) const DOTS: (f32, f32) = (1.5, 3.5);
/// Distance from the centre of the diamond to its corners, points.
const DIAMOND: f32 = 6.5;
/// Gap between a plot and the numbers of its scales, points.
const SCALE_GAP: f32 = 6.0;

/// Shows the plot in `rect`, with the numbers of the scales at its sides.
pub(super) fn show(ui: &Ui, rect: Rect, axis: &TimeAxis, model: &ProfileModel<'_>) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let painter = ui.painter_at(rect);
    if let Some(mask) = model.mask {
        let skyline = skyline(rect, axis, model.track, mask);
        painter.add(ground(rect, &skyline, t.hatch.gamma_multiply(0.45)));
        painter.line(skyline, Stroke::new(1.0, t.hatch));
    }
    grid(ui, rect);

    let azimuths = model.track.iter().map(|s| (axis.x(s.time), s.direction.azimuth_deg()));
    let broken = scale::broken_at_north(azimuths);
    for piece in scale::pieces(broken.into_iter(), rect, AZIMUTH_TOP_DEG) {
        let stroke = Stroke::new(1.5, t.t2);
        dashes::paint(&painter, &piece, stroke, DOTS);
    }

    let elevations = model.track.iter().map(|s| (axis.x(s.time), s.direction.elevation_deg()));
    let stroke = Stroke::new(2.0, t.sat);
    let now_x = axis.x(model.now).clamp(rect.left(), rect.right());
    // The code dashes the whole path and then cuts it at the present, so that the dashes keep their
    // place as time goes on.
    let flown = painter.with_clip_rect(painter.clip_rect().intersect(rect.with_max_x(now_x)));
    let planned = painter.with_clip_rect(painter.clip_rect().intersect(rect.with_min_x(now_x)));
    for piece in scale::pieces(elevations, rect, ELEVATION_TOP_DEG) {
        dashes::paint(&planned, &piece, stroke, DASH);
        flown.line(piece, stroke);
    }
    highest(ui, rect, axis, model);
}

/// Returns the height of the mask along the path.
fn skyline(rect: Rect, axis: &TimeAxis, track: &[Sample], mask: &HorizonMask) -> Vec<Pos2> {
    let finite = track.iter().filter(|sample| sample.direction.azimuth.is_finite());
    let height = |sample: &Sample| {
        let elevation_deg = mask.elevation_at(sample.direction.azimuth).degrees();
        pos2(axis.x(sample.time), scale::y(rect, elevation_deg, ELEVATION_TOP_DEG))
    };
    finite.map(height).collect()
}

/// Returns the filled area from the bottom of the plot to the skyline.
fn ground(rect: Rect, skyline: &[Pos2], colour: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    for (index, position) in (0_u32..).zip(skyline) {
        mesh.colored_vertex(pos2(position.x, rect.bottom()), colour);
        mesh.colored_vertex(*position, colour);
        if let Some(before) = (2 * index).checked_sub(2) {
            mesh.add_triangle(before, before + 1, before + 2);
            mesh.add_triangle(before + 1, before + 2, before + 3);
        }
    }
    mesh
}

fn grid(ui: &Ui, rect: Rect) {
    let t = theme::tokens(ui);
    for third in 0..=3_u8 {
        let part = f64::from(third) / 3.0;
        let y = scale::y(rect, part, 1.0);
        ui.painter().hline(rect.x_range(), y, (1.0, t.line));
        let number = |top: f64| format::number(part * top, 0);
        let left = pos2(rect.left() - SCALE_GAP, y);
        let elevation = number(ELEVATION_TOP_DEG);
        paint::text(ui, left, Align2::RIGHT_CENTER, elevation, text::caption(), t.sat);
        let right = pos2(rect.right() + SCALE_GAP, y);
        let azimuth = number(AZIMUTH_TOP_DEG);
        paint::text(ui, right, Align2::LEFT_CENTER, azimuth, text::caption(), t.t2);
    }
}

/// Paints the diamond at TCA with the elevation next to it.
fn highest(ui: &Ui, rect: Rect, axis: &TimeAxis, model: &ProfileModel<'_>) {
    let elevation_deg = model.tca.direction.elevation_deg();
    if !axis.contains(model.tca.time) || !elevation_deg.is_finite() {
        return;
    }
    let t = theme::tokens(ui);
    let x = axis.x(model.tca.time);
    let centre = pos2(x, scale::y(rect, elevation_deg, ELEVATION_TOP_DEG));
    diamond(ui.painter(), centre, t.bg0, Stroke::new(1.5, t.sat));

    let words = format!("{}°", format::number(elevation_deg, 1));
    let size = vec2(paint::text_width(ui, &words, text::caption()), 14.0);
    let now_x = axis.x(model.now);
    let place = label_place(rect, centre, size, now_x);
    // The fill keeps the number readable above a curve.
    ui.painter().rect_filled(place.shrink2(vec2(-1.0, 1.0)), 2.0, t.bg0.gamma_multiply(0.8));
    paint::text(ui, place.left_center(), Align2::LEFT_CENTER, words, text::caption(), t.t1);
}

fn diamond(painter: &Painter, centre: Pos2, fill: Color32, stroke: Stroke) {
    let corners =
        [vec2(0.0, -DIAMOND), vec2(DIAMOND, 0.0), vec2(0.0, DIAMOND), vec2(-DIAMOND, 0.0)];
    let points = corners.into_iter().map(|corner| centre + corner).collect();
    painter.add(Shape::convex_polygon(points, fill, stroke));
}

/// Returns the rectangle of the label at the left of the diamond. It moves to the right if the left
/// side has no room or the line of the present crosses it.
fn label_place(rect: Rect, centre: Pos2, size: Vec2, now_x: f32) -> Rect {
    let distance = DIAMOND + 4.0;
    let y = (centre.y - 7.0).max(rect.top() + size.y / 2.0 + 1.0);
    let area = |x: f32| Rect::from_min_size(pos2(x, y - size.y / 2.0), size);
    let left = area(centre.x - distance - size.x);
    let right = area(centre.x + distance);
    let free = |place: &Rect| {
        place.left() >= rect.left()
            && place.right() <= rect.right()
            && !place.x_range().expand(3.0).contains(now_x)
    };
    if free(&left) || !free(&right) && left.left() >= rect.left() { left } else { right }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::AzEl;

    const PLOT: Rect = Rect { min: pos2(40.0, 40.0), max: pos2(340.0, 140.0) };

    fn place(x: f32, y: f32, now_x: f32) -> Rect {
        label_place(PLOT, pos2(x, y), vec2(30.0, 14.0), now_x)
    }

    #[test]
    fn the_mask_fills_what_lies_below_it_along_the_path() {
        let sample = |time: &str, azimuth_deg| Sample {
            time: time.parse().unwrap(),
            direction: AzEl::from_degrees(azimuth_deg, 20.0),
        };
        let track = [
            sample("2026-11-14T11:00:00Z", 0.0),
            sample("2026-11-14T11:05:00Z", f64::NAN),
            sample("2026-11-14T11:10:00Z", 90.0),
        ];
        let axis = super::super::axis(&track, PLOT).unwrap();
        let mask = HorizonMask::from_degrees([(0.0, -2.0), (90.0, 45.0), (180.0, 0.0)]).unwrap();
        let skyline = skyline(PLOT, &axis, &track, &mask);
        assert_eq!(skyline, [pos2(40.0, 140.0), pos2(340.0, 90.0)]);
        assert_eq!(ground(PLOT, &skyline, Color32::PLACEHOLDER).indices.len(), 6);
    }

    #[test]
    fn the_maximum_stands_where_it_has_room() {
        assert!(place(190.0, 70.0, 100.0).right() < 190.0);
        assert!(place(60.0, 70.0, 300.0).left() > 60.0);
        assert!(place(330.0, 70.0, 100.0).right() < 330.0);
    }

    #[test]
    fn the_maximum_steps_aside_for_the_present() {
        assert!(place(190.0, 70.0, 165.0).left() > 190.0);
        assert!(place(190.0, 70.0, 215.0).right() < 190.0);
    }

    #[test]
    fn the_maximum_of_an_overhead_pass_stays_in_the_plot() {
        assert!(place(190.0, 40.0, 100.0).top() > PLOT.top());
    }
}
