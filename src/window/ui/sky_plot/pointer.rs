//! The direction under the pointer, and the time at a point of the path.

use egui::{Pos2, Rect, Stroke, Ui, vec2};
use jiff::Timestamp;

use super::{geometry::Dome, scene::Track};
use crate::{
    astro::{AzEl, time::add_seconds},
    plan::Sample,
    ui::{along, format, text, tokens::Tokens, widgets::paint},
};

/// Max distance from the path at which the pointer marks a point of it, points.
const GRIP: f32 = 9.0;
/// Distance of the words from the pointer or the mark, points.
const MARGIN: f32 = 14.0;
/// Radius of the mark on the path, points.
const MARK: f32 = 4.0;

/// Returns the point of the path nearest to `position`, if it is within [`GRIP`].
pub(super) fn on_path(dome: Dome, track: &Track<'_>, position: Pos2) -> Option<Sample> {
    let mut nearest: Option<(f32, Timestamp)> = None;
    for pair in track.samples.windows(2) {
        let &[start, end] = pair else { continue };
        let (Some(a), Some(b)) = (dome.visible(start.direction), dome.visible(end.direction))
        else {
            continue;
        };
        let along = b - a;
        let part = ((position - a).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
        let distance = position.distance(a + along * part);
        if distance <= nearest.map_or(GRIP, |(min, _)| min) {
            let step_s = end.time.duration_since(start.time).as_secs_f64();
            nearest = Some((distance, add_seconds(start.time, f64::from(part) * step_s)));
        }
    }
    along::sample_at(track.samples, nearest?.1)
}

/// Paints the marked point of the path, with its time and direction.
pub(super) fn marked(ui: &Ui, rect: Rect, dome: Dome, sample: Sample, now: Timestamp, t: &Tokens) {
    let Some(position) = dome.visible(sample.direction) else { return };
    ui.painter().circle(position, MARK, t.sky, Stroke::new(2.0, t.sat));
    let time = format::moment(sample.time, now);
    let words = format!("{time}\n{}", direction(sample.direction));
    let place = words_beside(ui, rect, position, &words, t);
    let (azimuth, elevation) = spoken(sample.direction);
    let name = format!("Path at {time}: {azimuth}, {elevation}");
    paint::name_text(ui, "marked", place, &name);
}

/// Paints the direction under the pointer next to the pointer.
pub(super) fn pointed_at(ui: &Ui, rect: Rect, position: Pos2, pointed: AzEl, t: &Tokens) {
    let place = words_beside(ui, rect, position, &direction(pointed), t);
    let (azimuth, elevation) = spoken(pointed);
    paint::name_text(ui, "pointed at", place, &format!("Pointer at {azimuth}, {elevation}"));
}

fn words_beside(ui: &Ui, rect: Rect, position: Pos2, words: &str, t: &Tokens) -> Rect {
    let galley = ui.painter().layout_no_wrap(words.to_owned(), text::small(), t.t1);
    let size = galley.size() + vec2(8.0, 4.0);
    let right = position.x + MARGIN + size.x <= rect.right();
    let below = position.y + MARGIN + size.y <= rect.bottom();
    let left_top = vec2(
        if right { MARGIN } else { -MARGIN - size.x },
        if below { MARGIN } else { -MARGIN - size.y },
    );
    let place = Rect::from_min_size(position + left_top, size);
    ui.painter().rect(place, 3.0, t.bg2, Stroke::new(1.0, t.line), egui::StrokeKind::Inside);
    ui.painter().galley(place.min + vec2(4.0, 2.0), galley, t.t1);
    place
}

fn direction(direction: AzEl) -> String {
    let azimuth_deg = direction.azimuth.wrapped_360().degrees();
    let azimuth = format::degrees(azimuth_deg, 1);
    format!("Az {azimuth}  El {}", format::degrees(direction.elevation_deg(), 1))
}

fn spoken(direction: AzEl) -> (String, String) {
    let azimuth = format::degrees(direction.azimuth.wrapped_360().degrees(), 1);
    let elevation = format::degrees(direction.elevation_deg(), 1);
    (format!("azimuth {azimuth}"), format!("elevation {elevation}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::sky_plot::testing;

    const DOME: Dome = Dome { centre: Pos2::new(300.0, 300.0), radius: 270.0 };

    #[test]
    fn the_time_at_a_point_of_the_path_is_found_near_it_alone() {
        let samples = testing::pass();
        let track = testing::track(&samples);
        let (start, end) = (samples[60], samples[61]);
        let (a, b) = (DOME.point(start.direction).unwrap(), DOME.point(end.direction).unwrap());
        let sideways = (b - a).normalized().rot90() * 6.0;
        let found = on_path(DOME, &track, a + (b - a) * 0.5 + sideways).unwrap();
        let after_s = found.time.duration_since(start.time).as_secs_f64();
        assert!((after_s - 2.0).abs() < 0.3, "{after_s}");
        assert!(found.direction.separation(start.direction).degrees() < 1.0);
        assert_eq!(on_path(DOME, &track, a + sideways * 3.0), None);
    }
}
