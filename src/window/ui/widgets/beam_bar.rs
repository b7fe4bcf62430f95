//! A bar that compares the pointing error with the beam width.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::{axes_table, paint};
use crate::ui::{
    text::{self, Weight},
    theme,
    tokens::Tokens,
};

/// Height of the line, points.
pub const HEIGHT: f32 = 22.0;
/// Position of the half-beam tick, as a part of the bar.
const TICK_PART: f64 = 0.727;
/// Share of half the beam above which an error counts as near the edge.
const NEAR_EDGE: f64 = 0.8;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Inside,
    NearEdge,
    Outside,
}

fn place(error_deg: f64, half_beam_deg: f64) -> Place {
    if error_deg > half_beam_deg {
        Place::Outside
    } else if error_deg > NEAR_EDGE * half_beam_deg {
        Place::NearEdge
    } else {
        Place::Inside
    }
}

/// Returns the part of the bar that is filled, 0 to 1.
fn filled_part(error_deg: f64, half_beam_deg: f64) -> f32 {
    if half_beam_deg > 0.0 {
        (error_deg / half_beam_deg * TICK_PART).clamp(0.0, 1.0) as f32
    } else {
        0.0
    }
}

/// Room for the number and half the beam, points, and min width of a bar with a name.
const NUMBER: f32 = 99.0;
const NAMED_NUMBER: f32 = 156.0;
const NAMED_FROM: f32 = 300.0;

/// Shows words, bar and number in `rect`. `error_deg` is the angle between the beam axis and the
/// satellite.
pub fn show(ui: &Ui, rect: Rect, error_deg: Option<f64>, half_beam_deg: f64) {
    let t = theme::tokens(ui);
    let y = rect.center().y;
    let words = "Off beam axis";
    paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, words, text::small(), t.t2);
    let half_beam = format!("{}°", axes_table::angle(Some(half_beam_deg), 2));
    let (limit, number) = if rect.width() < NAMED_FROM {
        (format!(" of {half_beam}"), NUMBER)
    } else {
        (format!(" (half beam {half_beam})"), NAMED_NUMBER)
    };
    let bar_left = rect.left() + 92.0;
    let bar = Rect::from_min_max(pos2(bar_left, y - 3.0), pos2(rect.right() - number, y + 3.0));
    ui.painter().rect_filled(bar, 0.0, t.bg3);
    if let Some(error_deg) = error_deg {
        let (colour, _) = look(place(error_deg, half_beam_deg), t);
        let width = filled_part(error_deg, half_beam_deg) * bar.width();
        ui.painter().rect_filled(bar.with_max_x(bar.left() + width), 0.0, colour);
    }
    let tick = bar.left() + TICK_PART as f32 * bar.width();
    ui.painter().vline(tick, (y - 7.0)..=(y + 7.0), (2.0, t.cmd));

    let limit_box =
        paint::text(ui, rect.right_center(), Align2::RIGHT_CENTER, &limit, text::small(), t.t2);
    let error = error_deg.map_or_else(
        || axes_table::UNKNOWN.to_owned(),
        |error_deg| format!("{}°", axes_table::angle(Some(error_deg), 2)),
    );
    let strong = text::sized(12.0, Weight::SemiBold);
    let position = pos2(limit_box.left(), y);
    paint::text(ui, position, Align2::RIGHT_CENTER, &error, strong, t.t1);
    let spoken =
        error_deg.map_or("not known", |error_deg| look(place(error_deg, half_beam_deg), t).1);
    paint::name_text(
        ui,
        "beam",
        rect.shrink2(vec2(0.0, 1.0)),
        &format!("{words} {error} (half beam {half_beam}), {spoken}"),
    );
}

fn look(place: Place, t: &Tokens) -> (Color32, &'static str) {
    match place {
        Place::Inside => (t.ant, "inside the beam"),
        Place::NearEdge => (t.warn, "near the edge of the beam"),
        Place::Outside => (t.bad, "outside the beam"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colour_changes_at_the_edges_of_the_beam() {
        assert_eq!(place(0.04, 0.44), Place::Inside);
        assert_eq!(place(0.38, 0.44), Place::NearEdge);
        assert_eq!(place(0.61, 0.44), Place::Outside);
    }

    #[test]
    fn the_bar_reaches_its_tick_at_half_the_beam_and_never_leaves_its_track() {
        assert!((f64::from(filled_part(0.44, 0.44)) - TICK_PART).abs() < 1e-6);
        assert_eq!(filled_part(50.0, 0.44).to_bits(), 1.0_f32.to_bits());
        assert_eq!(filled_part(1.0, 0.0).to_bits(), 0.0_f32.to_bits());
    }
}
