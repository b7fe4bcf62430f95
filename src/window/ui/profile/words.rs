//! The times under the plots, and the description of the pass for screen readers.

use std::fmt::Write as _;

use egui::{Align2, Rect, Ui, pos2};

use super::ProfileModel;
use crate::{
    plan::Sample,
    ui::{format, text, theme, time_axis::TimeAxis, widgets::paint},
};

/// Centre of the times below the plots, points.
const BELOW: f32 = 12.0;
/// Gap between two of the times, points.
const GAP: f32 = 8.0;

/// Returns the names of the ends of the axis. The ends of a cut pass are not its AOS and LOS.
fn ends(cut: bool) -> (&'static str, &'static str) {
    if cut { ("from", "to") } else { ("AOS", "LOS") }
}

/// Paints the times of begin, maximum and end under `plot`. Omits the maximum if it has no room.
pub(super) fn times(ui: &Ui, plot: Rect, axis: &TimeAxis, model: &ProfileModel<'_>) {
    let colour = theme::tokens(ui).t2;
    let y = plot.bottom() + BELOW;
    let (begin, end) = ends(model.cut);
    let begin = format!("{begin} {}", format::moment(axis.start(), model.now));
    let end = format!("{end} {}", format::moment(axis.end(), model.now));
    let position = pos2(plot.left(), y);
    let begin = paint::text(ui, position, Align2::LEFT_CENTER, begin, text::caption(), colour);
    let position = pos2(plot.right(), y);
    let end = paint::text(ui, position, Align2::RIGHT_CENTER, end, text::caption(), colour);
    if axis.contains(model.tca.time) {
        let words = format!("TCA {}", format::moment(model.tca.time, model.now));
        let half = paint::text_width(ui, &words, text::caption()) / 2.0;
        let x = axis.x(model.tca.time);
        if let Some(x) = centre(x, half, begin.right() + GAP, end.left() - GAP) {
            paint::text(ui, pos2(x, y), Align2::CENTER_CENTER, words, text::caption(), colour);
        }
    }
}

/// Returns the centre nearest to `x` of a span that extends `half` to both sides and lies between
/// `left` and `right`. `None` if the room is too narrow.
fn centre(x: f32, half: f32, left: f32, right: f32) -> Option<f32> {
    (left + half <= right - half).then(|| x.clamp(left + half, right - half))
}

/// Describes the pass in a sentence, for screen readers.
pub(super) fn sentence(axis: &TimeAxis, model: &ProfileModel<'_>) -> String {
    let (begin, end) = ends(model.cut);
    let azimuth = |sample: Option<&Sample>| match sample.map(|s| s.direction.azimuth_deg()) {
        Some(azimuth_deg) if azimuth_deg.is_finite() => {
            format!(" at azimuth {}", format::azimuth(azimuth_deg))
        }
        _ => String::new(),
    };
    let mut sentence = format!(
        "{} profile: {begin} {}{}, TCA {} at elevation {}, {end} {}{}.",
        model.name,
        format::moment(axis.start(), model.now),
        azimuth(model.track.first()),
        format::moment(model.tca.time, model.now),
        format::degrees(model.tca.direction.elevation_deg(), 1),
        format::moment(axis.end(), model.now),
        azimuth(model.track.last()),
    );
    let last = model.errors.iter().rev().find(|(time, error_deg)| {
        axis.contains(*time) && *time <= model.now && error_deg.is_finite()
    });
    if let Some((_, error_deg)) = last {
        // Writing to a string cannot fail.
        let _ = write!(
            sentence,
            " Last error {}, half the beamwidth is {}.",
            format::degrees(f64::from(*error_deg), 2),
            format::degrees(model.half_beam_deg, 2),
        );
    }
    sentence
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_maximum_stays_between_the_ends() {
        assert_eq!(centre(50.0, 10.0, 20.0, 80.0), Some(50.0));
        assert_eq!(centre(5.0, 10.0, 20.0, 80.0), Some(30.0));
        assert_eq!(centre(95.0, 10.0, 20.0, 80.0), Some(70.0));
        assert_eq!(centre(50.0, 40.0, 20.0, 80.0), None);
    }
}
