//! The numbers of the selected satellite, in the upper corners of the plot.

use std::sync::Arc;

use egui::{Galley, Painter, Pos2, Rect, pos2, vec2};

use super::{corners::EDGE, geometry::Dome, grid, scene::SkyScene};
use crate::ui::{text, tokens::Tokens};

/// Width of the labels in the left corner, points.
const LABELS: f32 = 54.0;
/// Gap between a label and its value in the right corner, points.
const LABEL_GAP: f32 = 8.0;
/// Room above the first line in the left corner, points.
const LEFT_TOP: f32 = 12.0;
/// Room above the first line in the right corner, for the orientation, points.
const RIGHT_TOP: f32 = 44.0;
/// Gap between two lines, points.
const LINE_GAP: f32 = 3.0;
/// Gap between a line and the disc with the names around it, points.
const CLEARANCE: f32 = 4.0;
/// Number of large lines at the top of the readout.
const LARGE: usize = 2;

/// A line of the readout with its places.
struct ReadoutLine {
    /// Place of the label with the first row of the value, then the places of further rows.
    places: Vec<Rect>,
    label: (Pos2, Arc<Galley>),
    value: (Pos2, Arc<Galley>),
}

/// Paints the lines that have room; `over_sky` gives them a background.
pub(super) fn paint(
    painter: &Painter,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    over_sky: bool,
    t: &Tokens,
) {
    for line in lines(painter, rect, dome, scene, t) {
        for place in line.places.iter().filter(|_| over_sky) {
            painter.rect_filled(place.expand(CLEARANCE), 0.0, t.bg0);
        }
        painter.galley(line.label.0, line.label.1, t.t2);
        painter.galley(line.value.0, line.value.1, t.t1);
    }
}

/// Returns the boxes of the lines, which labels avoid.
pub(super) fn reserved(
    painter: &Painter,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    t: &Tokens,
) -> Vec<Rect> {
    let lines = lines(painter, rect, dome, scene, t);
    lines.iter().flat_map(|line| &line.places).map(|place| place.expand(4.0)).collect()
}

/// Lays out the lines in the left corner downwards until one would meet the disc, then in the right
/// corner. Omits lines without room in either corner.
fn lines(
    painter: &Painter,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    t: &Tokens,
) -> Vec<ReadoutLine> {
    let names = grid::name_boxes(dome);
    let is_open = |place: &Rect| {
        place.clamp(dome.centre).distance(dome.centre) >= dome.radius + CLEARANCE
            && names.iter().all(|name| !name.expand(CLEARANCE / 2.0).intersects(*place))
    };
    let is_free = |line: &ReadoutLine| line.places.iter().all(is_open);
    let mut placed: Vec<ReadoutLine> = Vec::new();
    let (mut y, mut on_left) = (rect.top() + LEFT_TOP, true);
    for (index, (label, value)) in scene.readout.iter().enumerate() {
        let font = if index < LARGE { text::value() } else { text::small() };
        let label = painter.layout_no_wrap((*label).to_owned(), text::small(), t.t2);
        let value = painter.layout_no_wrap(value.clone(), font, t.t1);
        let mut line = line(rect, y, on_left, &label, &value);
        if on_left && !is_free(&line) {
            on_left = false;
            line = self::line(rect, rect.top() + RIGHT_TOP, on_left, &label, &value);
        }
        if !is_free(&line) {
            continue;
        }
        y = line.places.last().map_or(y, |place| place.bottom() + LINE_GAP);
        placed.push(line);
    }
    placed
}

/// Lays out a line. In the left corner, values align in a column; in the right corner, the value
/// stands at the edge after its label.
fn line(
    rect: Rect,
    top: f32,
    on_left: bool,
    label: &Arc<Galley>,
    value: &Arc<Galley>,
) -> ReadoutLine {
    let label_width = if on_left { LABELS } else { label.size().x + LABEL_GAP };
    let width = label_width + value.size().x;
    let left = if on_left { rect.left() + EDGE } else { rect.right() - EDGE - width };
    // The label aligns with the first row of its value.
    let first = value.rows.first().map_or(0.0, |row| row.height());
    let label_at = pos2(left, top + (first - label.size().y) / 2.0);
    let value_at = pos2(left + label_width, top);
    let head = Rect::from_min_size(pos2(left, top), vec2(width, first));
    let further = Rect::from_min_size(value_at, value.size()).with_min_y(head.bottom());
    ReadoutLine {
        places: std::iter::once(head).chain((value.rows.len() > 1).then_some(further)).collect(),
        label: (label_at, Arc::clone(label)),
        value: (value_at, Arc::clone(value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::{sky_plot::testing, theme, widgets::testing::window};

    fn readout() -> [(&'static str, String); 4] {
        [
            ("Az", "327.59°".to_owned()),
            ("El", "−36.49°".to_owned()),
            ("Range", "41 586 km\n−7.61 km/s".to_owned()),
            ("Doppler", "+10.92 kHz\n437 MHz".to_owned()),
        ]
    }

    /// Returns the places of the lines in a plot of this size.
    fn places(width: f32, height: f32) -> Vec<Vec<Rect>> {
        let size = vec2(width, height);
        let mut harness = window(size, Vec::new(), move |ui, places: &mut Vec<Vec<Rect>>| {
            let scene_readout = readout();
            let scene = SkyScene { readout: &scene_readout, ..testing::empty() };
            let rect = Rect::from_min_size(Pos2::ZERO, size);
            let t = theme::tokens(ui);
            let lines = lines(ui.painter(), rect, Dome::fitted(rect), &scene, t);
            *places = lines.into_iter().map(|line| line.places).collect();
        });
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn the_numbers_meet_neither_disc_nor_edge() {
        for (width, height, count) in [
            (704.0, 580.0, 4),
            (624.0, 580.0, 4),
            (520.0, 580.0, 3),
            (672.0, 468.0, 4),
            (1200.0, 900.0, 4),
        ] {
            let places = places(width, height);
            assert_eq!(places.len(), count, "{width} x {height} {places:?}");
            let dome = Dome::fitted(Rect::from_min_size(Pos2::ZERO, vec2(width, height)));
            for place in places.iter().flatten() {
                assert!(place.clamp(dome.centre).distance(dome.centre) > dome.radius);
                let is_outside = place.right() > width || place.left() < 0.0;
                assert!(!is_outside, "{place} in {width} x {height}");
            }
        }
    }

    #[test]
    fn a_plot_of_the_usual_width_keeps_them_together() {
        assert!(places(704.0, 580.0).iter().all(|line| line[0].left() < 20.0));
    }

    #[test]
    fn what_has_no_room_is_left_out() {
        assert!(places(300.0, 300.0).len() < readout().len());
    }
}
