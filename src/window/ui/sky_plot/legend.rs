//! The legend of the plot.

use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, vec2};

use super::{
    geometry::{dashed, hatch},
    marks,
    scene::SkyScene,
};
use crate::ui::{text, tokens::Tokens, widgets::paint};

/// Width of the legend, points.
pub(super) const WIDTH: f32 = 134.0;
/// Height of a line, points.
const ROW: f32 = 18.0;
/// Half the width of a sample, points.
const HALF: f32 = 10.0;

const KEYHOLE_NAME: &str = "Keyhole";
/// Explanation of a keyhole.
pub(super) const KEYHOLE: &str = "Keyhole: the sky around an end of the lower axis, where an X/Y \
                                  mount cannot point or cannot turn fast enough.";

/// Function that paints the sample of a row around its centre.
type Sample = fn(&Painter, Pos2, &Tokens);

/// Returns the height of the legend, points. The legend lists only marks that are in the plot.
pub(super) fn height(scene: &SkyScene<'_>) -> f32 {
    rows(scene).count() as f32 * ROW
}

/// Paints the legend with its upper left corner at `position`.
pub(super) fn paint(ui: &Ui, position: Pos2, scene: &SkyScene<'_>, t: &Tokens) {
    for (index, (name, sample)) in rows(scene).enumerate() {
        let middle = position + vec2(HALF, ROW * (index as f32 + 0.5));
        sample(ui.painter(), middle, t);
        let point = middle + vec2(HALF + 10.0, 0.0);
        let words = paint::text(ui, point, Align2::LEFT_CENTER, name, text::small(), t.t2);
        if name == KEYHOLE_NAME {
            let row = words.with_min_x(position.x);
            paint::name_text(ui, "keyhole", row, KEYHOLE).on_hover_text(KEYHOLE);
        }
    }
}

fn rows(scene: &SkyScene<'_>) -> impl Iterator<Item = (&'static str, Sample)> {
    let (commanded, measured) = match scene.later {
        None => ("Commanded", "Measured"),
        Some(_) => ("Commanded now", "Measured now"),
    };
    let always: [(&str, Sample); 5] = [
        ("Satellite", marks::selected),
        (commanded, |painter, position, t| {
            painter.circle_stroke(position, 6.5, Stroke::new(2.0, t.cmd));
        }),
        (measured, |painter, position, t| {
            for arm in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment(
                    [position + arm * 3.0, position + arm * 8.0],
                    Stroke::new(2.0, t.ant),
                );
            }
        }),
        ("Planned path", |painter, position, t| {
            let line = [position - vec2(HALF, 0.0), position + vec2(HALF, 0.0)];
            painter.extend(dashed(&line, 5.0, 2.5, Stroke::new(2.0, t.sat)));
        }),
        ("Other satellite", |painter, position, t| {
            marks::other(painter, position, false, t);
        }),
    ];
    let planned = scene.later.map(|_| ("Planned antenna", planned as Sample));
    let mask = scene.mask.map(|_| ("Horizon mask", mask as Sample));
    let keyhole = scene.keyholes.map(|_| (KEYHOLE_NAME, keyhole as Sample));
    let mut keep_outs = scene.keep_outs.iter();
    let margin = keep_outs
        .any(|mark| mark.margin.degrees() > 0.0)
        .then_some(("Safety margin", margin as Sample));
    let keep_out = (!scene.keep_outs.is_empty()).then_some(("Keep-out", keep_out as Sample));
    let stop = (!scene.stops.is_empty()).then_some(("Azimuth stop", stop as Sample));
    let areas = mask.into_iter().chain(keyhole).chain(keep_out).chain(margin);
    always.into_iter().chain(planned).chain(areas).chain(stop)
}

fn planned(painter: &Painter, position: Pos2, t: &Tokens) {
    marks::planned(painter, position, 6.5, t);
}

fn stop(painter: &Painter, position: Pos2, t: &Tokens) {
    let stroke = Stroke::new(3.0, t.bad);
    let bar = position - vec2(HALF - 1.5, 0.0);
    painter.line_segment([bar - vec2(0.0, 6.0), bar + vec2(0.0, 6.0)], stroke);
    painter.line_segment([bar, position + vec2(HALF, 0.0)], stroke);
}

pub(in crate::ui) fn mask(painter: &Painter, position: Pos2, t: &Tokens) {
    hatched(painter, position, (t.mask, t.hatch), true);
}

pub(in crate::ui) fn keep_out(painter: &Painter, position: Pos2, t: &Tokens) {
    let area = Rect::from_center_size(position, vec2(2.0 * HALF, 11.0));
    let stroke = Stroke::new(1.25, t.bad);
    painter.rect(area, 0.0, t.keep, stroke, egui::StrokeKind::Inside);
}

pub(in crate::ui) fn margin(painter: &Painter, position: Pos2, t: &Tokens) {
    let area = Rect::from_center_size(position, vec2(2.0 * HALF, 11.0));
    let mut ring = vec![area.left_top(), area.right_top(), area.right_bottom(), area.left_bottom()];
    let lines = hatch(&ring, 4.0, true);
    let thin = Stroke::new(0.75, t.bad);
    painter.extend(lines.into_iter().map(|line| Shape::line_segment(line, thin)));
    ring.push(area.left_top());
    painter.extend(dashed(&ring, 4.0, 3.0, Stroke::new(1.25, t.bad)));
}

pub(in crate::ui) fn keyhole(painter: &Painter, position: Pos2, t: &Tokens) {
    hatched(painter, position, (t.warnbg, t.warn), false);
}

/// Paints a sample of an area, with its fill and the colour of its lines.
fn hatched(painter: &Painter, position: Pos2, (fill, ink): (Color32, Color32), rising: bool) {
    let area = Rect::from_center_size(position, vec2(2.0 * HALF, 11.0));
    let outline = vec![area.left_top(), area.right_top(), area.right_bottom(), area.left_bottom()];
    let lines = hatch(&outline, 4.0, rising);
    painter.rect_filled(area, 0.0, fill);
    painter.extend(lines.into_iter().map(|line| Shape::line_segment(line, Stroke::new(1.5, ink))));
    painter.add(Shape::closed_line(outline, Stroke::new(1.25, ink)));
}
