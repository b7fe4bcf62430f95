//! The path over the sky, with the error of the antenna enlarged.

use crate::{
    plan::pass_report::TrackPoint,
    record::OpenedPass,
    ui::{
        format, recorded_track,
        sheet::{
            CAPTION, LEFT, SMALL, section,
            sky::Sky,
            svg::{Anchor, Svg},
        },
    },
};

/// Width that is kept for the path.
pub(super) const WIDTH: f64 = 262.0;
const RADIUS: f64 = 104.0;
/// Room above the circle, for the name of north.
const ABOVE: f64 = 10.0;
const DASH: [f64; 2] = [3.0, 2.0];
const TICK: f64 = 4.0;

/// Returns where the path ends.
pub(super) fn draw(svg: &mut Svg, y: f64, opened: &OpenedPass) -> f64 {
    let factor = recorded_track::enlarged(&opened.track);
    let y = section(svg, y, "Path", &recorded_track::enlargement(factor));
    let sky = Sky { centre: [LEFT + WIDTH / 2.0, y + ABOVE + RADIUS], radius: RADIUS };
    sky.rings(svg);
    let [x, middle] = sky.centre;
    let letter = SMALL.anchored(Anchor::Middle);
    for (name, at) in [
        ("N", [x, middle - RADIUS - 3.0]),
        ("E", [x + RADIUS + 6.0, middle + 2.5]),
        ("S", [x, middle + RADIUS + 8.0]),
        ("W", [x - RADIUS - 6.0, middle + 2.5]),
    ] {
        svg.text(at, 10.0, letter, name);
    }
    let predicted: Vec<_> = opened.path.iter().map(|sample| sky.at(sample.direction)).collect();
    svg.dashed(&predicted, 0.6, DASH);
    for piece in recorded_track::pieces(&opened.track) {
        let flown: Vec<_> = piece.iter().map(|point| flown_at(sky, point, factor)).collect();
        svg.path(&flown, 1.1);
    }
    minutes(svg, sky, opened, factor);
    if let Some(worst) = recorded_track::worst(&opened.track) {
        let (from, to) = (sky.at(worst.satellite), flown_at(sky, worst, factor));
        svg.line(from, to, 0.6);
        svg.dot(from, 1.4);
        svg.dot(to, 1.4);
    }
    let bottom = middle + RADIUS + ABOVE;
    let words = "dashed: predicted; solid: actual; dots: the worst error; ticks: whole minutes";
    svg.text([LEFT, bottom + 8.0], WIDTH, CAPTION, words);
    let ends = opened.path.first().zip(opened.path.last());
    if let Some((first, last)) = ends {
        let words = format!(
            "AOS {} at {}, LOS {} at {}",
            format::second_of_day(first.time),
            format::azimuth(first.direction.azimuth_deg()),
            format::second_of_day(last.time),
            format::azimuth(last.direction.azimuth_deg()),
        );
        svg.text([LEFT, bottom + 17.0], WIDTH, CAPTION, &words);
    }
    bottom + 17.0
}

/// The place of the antenna, with its error enlarged; within the circle.
fn flown_at(sky: Sky, point: &TrackPoint, factor: u16) -> [f64; 2] {
    let [from, to] = [point.satellite, point.antenna].map(|direction| sky.at(direction));
    let enlarged = |from: f64, to: f64| from + (to - from) * f64::from(factor);
    let [x, y] =
        [enlarged(from[0], to[0]) - sky.centre[0], enlarged(from[1], to[1]) - sky.centre[1]];
    let out = (x.hypot(y) / sky.radius).max(1.0);
    [sky.centre[0] + x / out, sky.centre[1] + y / out]
}

/// Ticks across both paths at full minutes: outwards on the predicted one, inwards on the flown.
fn minutes(svg: &mut Svg, sky: Sky, opened: &OpenedPass, factor: u16) {
    let begins_minute = |before: jiff::Timestamp, time: jiff::Timestamp| {
        before.as_second().div_euclid(60) != time.as_second().div_euclid(60)
    };
    // The unit vector to the left of the way, on paper.
    let left = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| {
        let length = (bx - ax).hypot(by - ay).max(1e-9);
        [(by - ay) / length, -(bx - ax) / length]
    };
    let mut tick = |[x, y]: [f64; 2], [nx, ny]: [f64; 2], length: f64| {
        svg.line([x, y], [x + nx * length, y + ny * length], 0.5);
    };
    for (a, b) in opened.path.iter().zip(opened.path.iter().skip(1)) {
        if begins_minute(a.time, b.time) {
            let at = sky.at(b.direction);
            tick(at, left(sky.at(a.direction), at), TICK);
        }
    }
    for (a, b) in opened.track.iter().zip(opened.track.iter().skip(1)) {
        if begins_minute(a.time, b.time) {
            tick(flown_at(sky, b, factor), left(sky.at(a.satellite), sky.at(b.satellite)), -TICK);
        }
    }
}
