//! The plot at the size of a card: the selected pass and the antenna, without words.

use egui::{Align2, Painter, Pos2, Rect, Stroke, pos2};

use super::{
    geometry::{Dome, circle, dashed},
    grid, marks, mask,
    scene::SkyScene,
    track,
};
use crate::ui::{
    text::{self, Weight},
    tokens::Tokens,
};

/// Room around the disc for the letters of the cardinal points, points.
const MARGIN: f32 = 20.0;
/// Diameter of the commanded ring, points.
const RING: f32 = 22.0;

/// Paints the plot into `rect`.
pub fn paint_small(painter: &Painter, rect: Rect, scene: &SkyScene<'_>, t: &Tokens) {
    let radius = rect.width().min(rect.height()) / 2.0 - MARGIN;
    if !(radius.is_finite() && radius > MARGIN) {
        return;
    }
    let dome = Dome { centre: rect.center(), radius };
    grid::disc(painter, dome, t);
    if let Some(mask) = scene.mask {
        mask::paint(painter, dome, mask, t);
    }
    rings(painter, dome, scene, t);
    if let Some(holes) = scene.keyholes {
        grid::keyholes(painter, dome, &holes, t);
    }
    if let Some(pass) = &scene.track {
        let parts = track::parts(dome, pass, scene.now);
        track::paint(painter, &parts, &[], t);
        track::paint_events(painter, dome, &ends(pass), t);
    }
    if let Some(point) = scene.commanded.and_then(|commanded| dome.visible(commanded)) {
        marks::commanded(painter, point, RING, t);
    }
    if let Some((measured, point)) =
        scene.measured.and_then(|measured| Some((measured, dome.visible(measured.direction)?)))
    {
        match measured.lost {
            None => marks::measured(painter, point, 0.6, t),
            Some(_) => marks::lost(painter, point, 1.0, t),
        }
    }
    let position = scene.track.and_then(|track| track.position);
    if let Some(point) = position.and_then(|position| dome.visible(position)) {
        marks::selected(painter, point, t);
    }
}

/// Returns AOS and LOS; TCA would hide the path in a small plot.
fn ends(pass: &super::Track<'_>) -> Vec<track::Event> {
    let events = track::events(pass).into_iter();
    events.filter(|event| event.form != marks::EventForm::Diamond).collect()
}

fn rings(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    let Dome { centre, radius } = dome;
    let thin = Stroke::new(1.0, t.grid);
    for elevation in [30.0, 60.0] {
        painter.circle_stroke(centre, dome.ring(elevation), thin);
    }
    painter.hline(centre.x - radius..=centre.x + radius, centre.y, thin);
    painter.vline(centre.x, centre.y - radius..=centre.y + radius, thin);
    let lowest = scene.minimum_elevation.degrees() as f32;
    if lowest > 0.0 && lowest < 90.0 {
        let ring = circle(centre, dome.ring(lowest));
        painter.extend(dashed(&ring, 2.0, 4.0, Stroke::new(1.0, t.edge)));
    }
    painter.circle_stroke(centre, radius, Stroke::new(1.5, t.edge));
    let letter = |position: Pos2, letter: &str| {
        let font = text::sized(12.0, Weight::Bold);
        painter.text(position, Align2::CENTER_CENTER, letter, font, t.t1);
    };
    let distance = radius + 11.0;
    letter(pos2(centre.x, centre.y - distance), "N");
    letter(pos2(centre.x + distance, centre.y), "E");
    letter(pos2(centre.x, centre.y + distance), "S");
    letter(pos2(centre.x - distance, centre.y), "W");
}
