//! The path of the selected pass, with its minutes and events.

use egui::{Painter, Pos2, Shape, Stroke, Vec2};
use jiff::Timestamp;

use super::{
    geometry::{Dome, dashed},
    labels::{Key, Label, Labels},
    marks::{self, EventForm},
    placement::Side,
    scene::Track,
};
use crate::{
    plan::Sample,
    ui::{format, text, tokens::Tokens},
};

/// Min time between a minute label and an event, seconds.
const CLEAR_OF_EVENT_S: i64 = 45;
/// Min time between a minute label and the present, seconds.
const CLEAR_OF_NOW_S: i64 = 30;
/// Min distance between ticks, points.
const TICK_DISTANCE: f32 = 6.0;

/// The path of the pass, split at the present.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parts {
    /// Past points of the path, in order of time.
    pub(super) flown: Vec<Pos2>,
    /// Future points of the path, in order of time.
    pub(super) planned: Vec<Pos2>,
}

/// A tick of a full minute on the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tick {
    /// Time of the tick, minutes since 1970.
    pub(super) minute: i64,
    pub(super) position: Pos2,
    /// Unit vector across the path, away from the zenith.
    pub(super) across: Vec2,
    /// `true` for a long tick, which may have a time label.
    pub(super) even: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// Label key of the event: AOS, TCA or LOS.
    pub(super) key: Key,
    pub(super) word: &'static str,
    pub(super) sample: Sample,
    pub(super) form: EventForm,
}

/// Returns the events of a pass that lie within the prediction window.
pub(super) fn events(track: &Track<'_>) -> Vec<Event> {
    let rise = track.show_aos.then_some((Key::Aos, "AOS", track.aos, EventForm::Up));
    let top = Some((Key::Tca, "TCA", track.tca, EventForm::Diamond))
        .filter(|_| track.show_aos || track.show_los);
    let set = track.show_los.then_some((Key::Los, "LOS", track.los, EventForm::Down));
    [rise, top, set]
        .into_iter()
        .flatten()
        .map(|(key, word, sample, form)| Event { key, word, sample, form })
        .collect()
}

pub(super) fn parts(dome: Dome, track: &Track<'_>, now: Timestamp) -> Parts {
    let split = track.samples.partition_point(|sample| sample.time <= now);
    let (before, after) = track.samples.split_at_checked(split).unwrap_or_default();
    let directions = |samples: &[Sample]| dome.path(samples.iter().map(|s| s.direction));
    let (mut flown, mut planned) = (directions(before), directions(after));
    let under_way = !flown.is_empty() && !planned.is_empty();
    if under_way {
        let joint = track.position.and_then(|position| dome.visible(position));
        let joint = joint.or(flown.last().copied());
        flown.extend(joint);
        planned.splice(0..0, joint);
    }
    Parts { flown, planned }
}

/// Returns the full minutes of the path; every tenth minute or every hour of a very long path.
pub(super) fn ticks(dome: Dome, track: &Track<'_>) -> Vec<Tick> {
    let seconds = track.los.time.as_second().saturating_sub(track.aos.time.as_second());
    let step = match seconds {
        ..2400 => 1,
        2400..14_400 => 10,
        _ => 60,
    };
    let mut ticks: Vec<Tick> = Vec::new();
    for pair in track.samples.windows(2) {
        let &[first, last] = pair else { continue };
        let period_ms = 60_000 * step;
        let (start, end) = (first.time.as_millisecond(), last.time.as_millisecond());
        let full_ms = end.div_euclid(period_ms) * period_ms;
        if full_ms <= start {
            continue;
        }
        let (Some(a), Some(b)) = (dome.visible(first.direction), dome.visible(last.direction))
        else {
            continue;
        };
        let position = a.lerp(b, (full_ms - start) as f32 / (end - start) as f32);
        let near = |tick: &Tick| tick.position.distance(position) < TICK_DISTANCE;
        if ticks.last().is_some_and(near) {
            continue;
        }
        let across = (b - a).normalized().rot90();
        let outwards = if across.dot(position - dome.centre) < 0.0 { -across } else { across };
        let minute = full_ms / 60_000;
        ticks.push(Tick { minute, position, across: outwards, even: (minute / step) % 2 == 0 });
    }
    ticks
}

/// Paints the path and its ticks.
pub(super) fn paint(painter: &Painter, parts: &Parts, ticks: &[Tick], t: &Tokens) {
    if parts.flown.len() > 1 {
        painter.add(Shape::line(parts.flown.clone(), Stroke::new(2.5, t.sat)));
    }
    // The dashes start at the end, so that they stand still while the path ahead gets shorter.
    let backwards: Vec<Pos2> = parts.planned.iter().rev().copied().collect();
    painter.extend(dashed(&backwards, 7.0, 5.0, Stroke::new(2.0, t.sat)));
    for tick in ticks {
        let half = tick.across * if tick.even { 6.0 } else { 4.0 };
        painter.line_segment([tick.position - half, tick.position + half], Stroke::new(1.5, t.sat));
    }
}

/// Paints the marks of the events.
pub(super) fn paint_events(painter: &Painter, dome: Dome, events: &[Event], t: &Tokens) {
    for event in events {
        if let Some(position) = dome.point(event.sample.direction) {
            marks::event(painter, position, event.form, t.sat, t.sky);
        }
    }
}

/// Labels the events. AOS and LOS come before TCA if there is no room for all.
pub(super) fn label_events(
    labels: &mut Labels<'_>,
    dome: Dome,
    events: &[Event],
    now: Timestamp,
    t: &Tokens,
) {
    let is_top = |event: &&Event| event.form == EventForm::Diamond;
    let (top, ends): (Vec<&Event>, Vec<&Event>) = events.iter().partition(is_top);
    for event in ends.into_iter().chain(top) {
        let direction = event.sample.direction;
        let Some(mark) = dome.point(direction) else { continue };
        let first = format!("{} {}", event.word, format::moment(event.sample.time, now));
        let azimuth = format::azimuth(direction.azimuth_deg());
        let second = if is_top(&event) {
            format!("el {} az {azimuth}", format::degrees(direction.elevation_deg(), 1))
        } else {
            format!("az {azimuth}")
        };
        // The sides towards the inside of the disc come first.
        labels.add(&Label {
            key: event.key,
            lines: &[(&first, text::small_strong(), t.t1), (&second, text::caption(), t.t2)],
            mark,
            clearance: 9.0,
            order: &Side::by_nearness(dome.centre - mark),
            tolerance: 1.0,
        });
    }
}

/// Labels the even minutes with their times, on the side away from the zenith.
pub(super) fn label_minutes(
    labels: &mut Labels<'_>,
    ticks: &[Tick],
    events: &[Event],
    now: Timestamp,
    t: &Tokens,
) {
    for tick in ticks.iter().filter(|tick| tick.even) {
        let second = tick.minute * 60;
        let distance_s = |time: Timestamp| (time.as_second() - second).abs();
        let beside_event =
            events.iter().any(|event| distance_s(event.sample.time) < CLEAR_OF_EVENT_S);
        if beside_event || distance_s(now) < CLEAR_OF_NOW_S {
            continue;
        }
        let Ok(time) = Timestamp::from_second(second) else { continue };
        labels.add(&Label {
            key: Key::Minute(tick.minute),
            lines: &[(&format::minute_of_day(time), text::caption(), t.t2)],
            mark: tick.position,
            clearance: 7.0,
            order: &[Side::nearest(tick.across), Side::nearest(-tick.across)],
            tolerance: 0.4,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{astro::AzEl, ui::sky_plot::testing};

    const DOME: Dome = Dome { centre: Pos2::new(300.0, 300.0), radius: 270.0 };

    #[test]
    fn the_path_is_split_at_the_satellite() {
        let samples = testing::pass();
        let track = testing::track(&samples);
        let parts = parts(DOME, &track, testing::now());
        let here = DOME.point(track.position.unwrap()).unwrap();
        assert_eq!(parts.flown.last(), Some(&here));
        assert_eq!(parts.planned.first(), Some(&here));
        assert_eq!(parts.flown.len() + parts.planned.len(), samples.len() + 2);
    }

    #[test]
    fn before_and_after_the_pass_the_path_is_whole() {
        let samples = testing::pass();
        let track = testing::track(&samples);
        let before = parts(DOME, &track, track.aos.time - jiff::SignedDuration::from_secs(5));
        assert!(before.flown.is_empty() && before.planned.len() == samples.len());
        let after = parts(DOME, &track, track.los.time + jiff::SignedDuration::from_secs(5));
        assert!(after.planned.is_empty() && after.flown.len() == samples.len());
    }

    #[test]
    fn each_full_minute_has_a_tick_across_the_path() {
        let samples = testing::pass();
        let track = testing::track(&samples);
        let ticks = ticks(DOME, &track);
        // The pass lasts from 11:01:53 to 11:14:45.
        assert_eq!(ticks.len(), 13);
        assert!(ticks.windows(2).all(|pair| pair[1].minute == pair[0].minute + 1));
        assert_eq!(ticks.iter().filter(|tick| tick.even).count(), 7);
        for tick in ticks {
            assert!((tick.across.length() - 1.0).abs() < 1e-4);
            assert!(tick.across.dot(tick.position - DOME.centre) >= 0.0);
        }
    }

    #[test]
    fn a_satellite_that_stands_still_has_no_ticks_on_one_heap_and_no_events() {
        let samples: Vec<_> = testing::pass()
            .into_iter()
            .map(|s| Sample { direction: AzEl::from_degrees(220.0, 35.0), ..s })
            .collect();
        let track = Track { show_aos: false, show_los: false, ..testing::track(&samples) };
        assert_eq!(ticks(DOME, &track).len(), 1);
        assert!(events(&track).is_empty());
    }
}
