//! The path over the sky with its obstacles, and the error of the antenna enlarged.

use std::collections::HashMap;

use egui::{Align2, Painter, Pos2, Rect, Sense, Stroke, Ui, WidgetInfo, pos2};
use jiff::Timestamp;

use super::{PADDING, RecordState, cursor};
use crate::{
    astro::HorizonMask,
    contract::record::OpenedPass,
    model::Model,
    plan::{Sample, pass_report::TrackPoint},
    ui::{
        format,
        profile::dashes,
        recorded_track,
        sky_plot::{
            Keyholes,
            geometry::{Dome, usable},
            grid,
            labels::{Key, Label, Labels},
            legend, mask,
            placement::Side,
        },
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

const TITLE: f32 = 32.0;
const LEGEND: f32 = 28.0;
const DASH: (f32, f32) = (6.0, 4.0);
/// Function that paints a sample of an area around a place.
type AreaSample = fn(&Painter, Pos2, &Tokens);
/// Length of a minute tick, points.
const TICK: f32 = 6.0;

pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, opened: &OpenedPass, state: &RecordState) {
    let t = theme::tokens(ui);
    let (title, rest) = rect.split_top_bottom_at_y(rect.top() + TITLE);
    let factor = recorded_track::enlarged(&opened.track);
    let words = format!("Path, {}", recorded_track::enlargement(factor));
    let in_the_way = InTheWay::new(model, opened);
    let room = title.shrink2(egui::vec2(PADDING, 0.0));
    let room = room.with_max_x(in_the_way.legend(ui, room));
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::small_strong(), t.t1);
    let (plot, foot) = rest.split_top_bottom_at_y(rest.bottom() - LEGEND);
    if !usable(plot) {
        return;
    }
    let dome = Dome::fitted(plot);
    let painter = ui.painter_at(rect);
    grid::disc(&painter, dome, t);
    if let Some(mask) = in_the_way.mask {
        mask::paint(&painter, dome, mask, t);
    }
    grid::rings(&painter, dome, t);
    if let Some(holes) = in_the_way.keyholes {
        grid::keyholes(&painter, dome, &holes, t);
    }
    for (name, azimuth_deg) in [("N", 0.0_f32), ("E", 90.0), ("S", 180.0), ("W", 270.0)] {
        let position = dome.point_at(azimuth_deg.to_radians(), -11.0);
        painter.text(position, Align2::CENTER_CENTER, name, text::small_strong(), t.t1);
    }
    let predicted = dome.path(opened.path.iter().map(|sample| sample.direction));
    dashes::paint(&painter, &predicted, Stroke::new(1.5, t.sat), DASH);
    let pieces = flown(dome, &opened.track, factor);
    for piece in &pieces {
        painter.line(piece.clone(), Stroke::new(2.0, t.ant));
    }
    ticks(&painter, dome, opened, factor, t);
    let mut labels = Labels::new(&painter, t, Some(dome), plot.shrink(4.0), HashMap::new());
    for path in pieces.iter().chain([&predicted]) {
        labels.reserve_path(path, 6.0);
    }
    let cursor = cursor::point(opened, state);
    let cursor = cursor.and_then(|track_point| {
        Some((
            track_point,
            [dome.visible(track_point.satellite)?, enlarged_at(dome, track_point, factor)?],
        ))
    });
    for mark in cursor.into_iter().flat_map(|(_, marks)| marks) {
        labels.reserve(paint::square(mark, 10.0));
    }
    ends(ui, &mut labels, &painter, dome, &opened.path, model.now, t);
    if let Some((point, [position, deviation])) = cursor {
        painter.line_segment([position, deviation], Stroke::new(2.5, t.warn));
        painter.circle_filled(position, 4.0, t.sat);
        painter.circle_stroke(deviation, 4.0, Stroke::new(1.5, t.ant));
        // The track has one point a second, but the report evaluated every position.
        let worst = opened.pass.report.report.worst.filter(|_| state.cursor.is_none());
        let (off_deg, at_time) = worst
            .map_or((point.error.off_deg, point.time), |worst| (worst.error.off_deg, worst.time));
        let words =
            format!("{}, {}", format::degrees(off_deg, 2), format::moment(at_time, model.now));
        label(&mut labels, Key::Cursor, dome, deviation, &words, t.warn);
    }
    grid::label_rings(&mut labels, dome);
    labels.finish();
    lines(ui, foot);
    let id = ui.make_persistent_id("recorded path");
    let spoken = format!("Sky plot of the pass. {words}");
    ui.interact(plot, id, Sense::hover())
        .widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &spoken));
}

/// Current obstacles of the station and keyholes of the antenna.
struct InTheWay<'a> {
    mask: Option<&'a HorizonMask>,
    keyholes: Option<Keyholes>,
}

impl<'a> InTheWay<'a> {
    /// Collects the obstacles. The mask applies only to the site of the pass, and a removed antenna
    /// has no known keyholes.
    fn new(model: &'a Model, opened: &OpenedPass) -> Self {
        // The comparison ignores refraction, because the operator may have changed it since.
        let is_here = opened
            .pass
            .report
            .site
            .is_none_or(|site| site.airless() == model.station.site.airless());
        let antenna =
            model.antennas.iter().find(|model_antenna| model_antenna.id() == opened.pass.antenna);
        Self {
            mask: model.station.horizon_mask.as_ref().filter(|_| is_here),
            keyholes: antenna.and_then(|antenna| Keyholes::new(&antenna.config.mount)),
        }
    }

    /// Draws the names of the obstacles at the right end of `row`. Returns the right end of the
    /// room before them.
    fn legend(&self, ui: &Ui, row: Rect) -> f32 {
        let t = theme::tokens(ui);
        let mask = self.mask.map(|_| ("mask", legend::mask as AreaSample));
        let keyholes = self.keyholes.map(|_| ("keyhole", legend::keyhole as AreaSample));
        let mut right = row.right();
        for (word, sample) in keyholes.into_iter().chain(mask) {
            let place = row.with_max_x(right);
            let drawn = paint::text(
                ui,
                place.right_center(),
                Align2::RIGHT_CENTER,
                word,
                text::caption(),
                t.t2,
            );
            let whole = drawn.with_min_x(drawn.left() - 26.0);
            sample(ui.painter(), pos2(whole.left() + 10.0, row.center().y), t);
            paint::name_text(ui, ("in the way", word), whole, word)
                .on_hover_text("As the station is set now.");
            right = whole.left() - 12.0;
        }
        right
    }
}

/// Returns the place of the antenna with its error enlarged; `None` outside of the plot.
fn enlarged_at(dome: Dome, point: &TrackPoint, factor: u16) -> Option<Pos2> {
    let satellite = dome.visible(point.satellite)?;
    let antenna = dome.point(point.antenna)?;
    Some(satellite + (antenna - satellite) * f32::from(factor))
}

/// Returns the tracked path, split where measurements are missing.
fn flown(dome: Dome, track: &[TrackPoint], factor: u16) -> Vec<Vec<Pos2>> {
    let pieces = recorded_track::pieces(track).map(|piece| {
        piece.iter().filter_map(|point| enlarged_at(dome, point, factor)).collect::<Vec<_>>()
    });
    pieces.filter(|piece| piece.len() > 1).collect()
}

/// Marks each full minute on both paths, left of the predicted path and right of the tracked path.
/// An error along the path shows as ticks that do not meet.
fn ticks(painter: &Painter, dome: Dome, opened: &OpenedPass, factor: u16, t: &Tokens) {
    let is_minute = |before: Timestamp, time: Timestamp| {
        before.as_second().div_euclid(60) != time.as_second().div_euclid(60)
    };
    for pair in opened.path.windows(2) {
        let [a, b] = pair else { continue };
        if is_minute(a.time, b.time)
            && let (Some(start), Some(end)) = (dome.visible(a.direction), dome.visible(b.direction))
        {
            let out = (end - start).normalized().rot90();
            painter.line_segment([end, end - out * TICK], Stroke::new(1.5, t.sat));
        }
    }
    for pair in opened.track.windows(2) {
        let [a, b] = pair else { continue };
        let places = (enlarged_at(dome, a, factor), enlarged_at(dome, b, factor));
        if is_minute(a.time, b.time)
            && let ((Some(_), Some(position)), (Some(start), Some(end))) =
                (places, (dome.visible(a.satellite), dome.visible(b.satellite)))
        {
            let out = (end - start).normalized().rot90();
            painter.line_segment([position, position + out * TICK], Stroke::new(1.5, t.ant));
        }
    }
}

/// Marks AOS and LOS with their times.
fn ends(
    ui: &Ui,
    labels: &mut Labels<'_>,
    painter: &Painter,
    dome: Dome,
    path: &[Sample],
    now: Timestamp,
    t: &Tokens,
) {
    let (Some(first), Some(last)) = (path.first(), path.last()) else { return };
    let ends = [(Key::Aos, "AOS", first), (Key::Los, "LOS", last)];
    let places = ends.map(|(_, _, sample)| dome.point(sample.direction));
    for position in places.into_iter().flatten() {
        labels.reserve(paint::square(position, 12.0));
    }
    for ((key, word, sample), position) in ends.into_iter().zip(places) {
        let Some(position) = position else { continue };
        painter.circle(position, 4.5, t.bg0, Stroke::new(1.5, t.sat));
        let words = format!("{word} {}", format::moment(sample.time, now));
        label(labels, key, dome, position, &words, t.t1);
        paint::name_text(ui, ("recorded end", word), paint::square(position, 12.0), &words);
    }
}

/// Adds a label towards the middle of the plot, where there is room.
fn label(
    labels: &mut Labels<'_>,
    key: Key,
    dome: Dome,
    mark: Pos2,
    words: &str,
    colour: egui::Color32,
) {
    labels.add(&Label {
        key,
        lines: &[(words, text::small(), colour)],
        mark,
        clearance: 9.0,
        order: &Side::by_nearness(dome.centre - mark),
        tolerance: 1.0,
    });
}

fn lines(ui: &Ui, rect: Rect) {
    let t = theme::tokens(ui);
    let mut x = rect.left() + PADDING;
    let y = rect.center().y;
    for (word, colour, is_dashed) in
        [("predicted", t.sat, true), ("actual", t.ant, false), ("error", t.warn, false)]
    {
        let line = [pos2(x, y), pos2(x + 18.0, y)];
        let stroke = Stroke::new(2.0, colour);
        if is_dashed {
            dashes::paint(ui.painter(), &line, stroke, DASH);
        } else {
            ui.painter().line_segment(line, stroke);
        }
        let place = rect.with_min_x(x + 24.0);
        let drawn = paint::text_in(ui, place, Align2::LEFT_CENTER, word, text::caption(), t.t2);
        x = drawn.right() + 16.0;
    }
    let place = rect.with_min_x(x).with_max_x(rect.right() - 4.0);
    let words = "ticks: minutes";
    paint::text_in(ui, place, Align2::LEFT_CENTER, words, text::caption(), t.t3);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{AzEl, time::add_seconds},
        plan::pass_report::PointingError,
    };

    #[test]
    fn the_flown_path_is_broken_where_nothing_was_measured() {
        let dome = Dome { centre: pos2(300.0, 300.0), radius: 200.0 };
        let point = |seconds: f64| TrackPoint {
            time: add_seconds(Timestamp::UNIX_EPOCH, seconds),
            antenna: AzEl::from_degrees(seconds, 45.0),
            satellite: AzEl::from_degrees(seconds, 45.0),
            error: PointingError {
                off_deg: 0.0,
                azimuth_deg: 0.0,
                elevation_deg: 0.0,
                along_deg: 0.0,
                across_deg: 0.0,
            },
        };
        let track = [0.0, 1.0, 2.0, 10.0, 11.0, 20.0].map(point);
        let pieces: Vec<usize> = flown(dome, &track, 1).iter().map(Vec::len).collect();
        assert_eq!(pieces, [3, 2], "a point alone makes no line");
    }
}
