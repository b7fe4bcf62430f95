//! Ground tracks with their full times.

use egui::{Painter, Pos2, Shape, Stroke, Vec2};
use jiff::Timestamp;

use super::projection::Projection;
use crate::{
    astro::GroundPoint,
    model::globe::GlobeSatellite,
    ui::{sky_plot::geometry::dashed, tokens::Tokens},
};

/// Time between two ticks, seconds.
const TICK_S: i64 = 20 * 60;
/// Half the length of a tick, points.
const TICK: f32 = 5.0;

/// Track of the selected satellite on every turn, split at the current time.
pub(super) struct Tracks {
    pub(super) flown: Vec<Vec<Pos2>>,
    pub(super) ahead: Vec<Vec<Pos2>>,
    pub(super) ticks: Vec<Tick>,
}

/// Full time on the track ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tick {
    pub(super) time: Timestamp,
    pub(super) position: Pos2,
    /// Unit vector across the track.
    across: Vec2,
}

/// Lays out the track of the selected satellite.
pub(super) fn tracks(
    projection: &Projection,
    satellite: &GlobeSatellite,
    now: Timestamp,
) -> Tracks {
    let split = satellite.track.partition_point(|point| point.time <= now);
    let (before, after) = satellite.track.split_at_checked(split).unwrap_or_default();
    let here = satellite.below.point;
    let flown: Vec<GroundPoint> = before.iter().map(|point| point.point).chain([here]).collect();
    let ahead: Vec<GroundPoint> =
        [here].into_iter().chain(after.iter().map(|point| point.point)).collect();
    let tick = |pair: &[crate::orbit::TrackPoint]| {
        let &[start, end] = pair else { return None };
        if end.time.as_second() % TICK_S != 0 {
            return None;
        }
        let position = projection.point(end.point);
        let line = projection.lines(&[start.point, end.point]);
        let direction = line.first().and_then(|line| match line[..] {
            [start, end] => Some((end - start).normalized()),
            _ => None,
        })?;
        Some(Tick { time: end.time, position, across: direction.rot90() })
    };
    Tracks {
        flown: projection.lines(&flown),
        ahead: projection.lines(&ahead),
        ticks: after.windows(2).filter_map(tick).collect(),
    }
}

/// Paints the track of the selected satellite.
pub(super) fn paint(painter: &Painter, tracks: &Tracks, t: &Tokens) {
    let stroke = Stroke::new(2.0, t.sat);
    for line in &tracks.flown {
        painter.add(Shape::line(line.clone(), stroke));
    }
    for line in &tracks.ahead {
        // Start at the end: the dashes then stand still while the track ahead gets shorter.
        let backwards: Vec<Pos2> = line.iter().rev().copied().collect();
        painter.extend(dashed(&backwards, 7.0, 5.0, stroke));
    }
    for tick in &tracks.ticks {
        let half = tick.across * TICK;
        painter.line_segment([tick.position - half, tick.position + half], Stroke::new(1.5, t.sat));
    }
}

/// Paints the track of another satellite.
pub(super) fn paint_other(
    painter: &Painter,
    projection: &Projection,
    satellite: &GlobeSatellite,
    now: Timestamp,
    t: &Tokens,
) {
    let split = satellite.track.partition_point(|point| point.time <= now);
    let after = satellite.track.iter().skip(split).map(|point| point.point);
    let ahead: Vec<GroundPoint> = [satellite.below.point].into_iter().chain(after).collect();
    if ahead.len() > 1 {
        for line in projection.lines(&ahead) {
            painter.extend(dashed(&line, 1.5, 4.0, Stroke::new(1.25, t.other)));
        }
    }
}
