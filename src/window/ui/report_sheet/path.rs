//! The path over the sky, with the error of the antenna enlarged.

use maud::{Markup, html};

use crate::{
    contract::record::OpenedPass,
    plan::pass_report::TrackPoint,
    ui::{
        format,
        page::{
            plot::{self, Sky},
            section,
        },
        recorded_track,
    },
};

/// Size of the plot, points on paper.
const SIZE: [f64; 2] = [262.0, 238.0];
const RADIUS: f64 = 104.0;
const CENTRE: [f64; 2] = [131.0, 119.0];
const TICK: f64 = 4.0;

pub(super) fn html(opened: &OpenedPass) -> Markup {
    let factor = recorded_track::enlarged(&opened.track);
    let sky = Sky { centre: CENTRE, radius: RADIUS };
    let [x, y] = CENTRE;
    let letters = [
        ("N", [x, y - RADIUS - 4.0]),
        ("E", [x + RADIUS + 8.0, y + 2.5]),
        ("S", [x, y + RADIUS + 10.0]),
        ("W", [x - RADIUS - 8.0, y + 2.5]),
    ];
    let predicted: Vec<_> = opened.path.iter().map(|sample| sky.point(sample.direction)).collect();
    let measured = recorded_track::pieces(&opened.track)
        .map(|piece| piece.iter().map(|point| measured_at(sky, point, factor)).collect::<Vec<_>>());
    let worst = recorded_track::worst(&opened.track);
    let worst = worst.map(|worst| [sky.point(worst.satellite), measured_at(sky, worst, factor)]);
    let [width, height] = SIZE;
    let content = html! {
        svg viewBox=(format!("0 0 {width} {height}")) {
            (sky.rings())
            @for (letter, place) in letters { (plot::text("middle", place, letter)) }
            (plot::line("thin dashed", &predicted))
            @for piece in measured { (plot::line("thick measured", &piece)) }
            @for tick in minutes(sky, opened, factor) { (plot::line("thin", &tick)) }
            @if let Some(ends) = worst {
                (plot::line("thin", &ends))
                @for end in ends { (plot::ring("filled", end, 1.4)) }
            }
        }
        p.quiet { "dashed: predicted; solid: actual; dots: the worst error; ticks: whole minutes" }
        @if let Some((first, last)) = opened.path.first().zip(opened.path.last()) {
            p.quiet {
                "AOS " (format::second_of_day(first.time))
                " at " (format::azimuth(first.direction.azimuth_deg()))
                ", LOS " (format::second_of_day(last.time))
                " at " (format::azimuth(last.direction.azimuth_deg()))
            }
        }
    };
    section("path", "Path", &recorded_track::enlargement(factor), &content)
}

/// Returns the place of the antenna with its error enlarged, within the circle.
fn measured_at(sky: Sky, point: &TrackPoint, factor: u16) -> [f64; 2] {
    let [start, end] = [point.satellite, point.antenna].map(|direction| sky.point(direction));
    let enlarged = |start: f64, end: f64| start + (end - start) * f64::from(factor);
    let [x, y] =
        [enlarged(start[0], end[0]) - sky.centre[0], enlarged(start[1], end[1]) - sky.centre[1]];
    let out = (x.hypot(y) / sky.radius).max(1.0);
    [sky.centre[0] + x / out, sky.centre[1] + y / out]
}

/// Returns ticks across both paths at full minutes: outward on the predicted path, inward on the
/// measured path.
fn minutes(sky: Sky, opened: &OpenedPass, factor: u16) -> Vec<[[f64; 2]; 2]> {
    let begins_minute = |before: jiff::Timestamp, time: jiff::Timestamp| {
        before.as_second().div_euclid(60) != time.as_second().div_euclid(60)
    };
    // The unit vector points to the left of the path, on paper.
    let left = |[ax, ay]: [f64; 2], [bx, step]: [f64; 2]| {
        let length = (bx - ax).hypot(step - ay).max(1e-9);
        [(step - ay) / length, -(bx - ax) / length]
    };
    let tick = |[x, y]: [f64; 2], [nx, ny]: [f64; 2], length: f64| {
        [[x, y], [x + nx * length, y + ny * length]]
    };
    let mut ticks = Vec::new();
    for (a, b) in opened.path.iter().zip(opened.path.iter().skip(1)) {
        if begins_minute(a.time, b.time) {
            let point = sky.point(b.direction);
            ticks.push(tick(point, left(sky.point(a.direction), point), TICK));
        }
    }
    for (a, b) in opened.track.iter().zip(opened.track.iter().skip(1)) {
        if begins_minute(a.time, b.time) {
            let across = left(sky.point(a.satellite), sky.point(b.satellite));
            ticks.push(tick(measured_at(sky, b, factor), across, -TICK));
        }
    }
    ticks
}
