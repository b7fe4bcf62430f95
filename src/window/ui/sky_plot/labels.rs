//! Labels next to marks, placed one after the other without covering earlier labels.

use std::collections::HashMap;

use egui::{
    Align, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, layers::ShapeIdx,
    text::LayoutJob, text::TextFormat, vec2,
};

use super::{
    geometry::Dome,
    placement::{Memory, Obstacle, Placement, Side, covered, place},
};
use crate::ui::{text, tokens::Tokens};

/// Padding between a text and the edge of its background, points.
const PADDING: f32 = 2.0;

/// Weights of objects that a label may cover. A line continues next to a label, but a covered mark
/// or number is lost.
pub(super) const LINE: f32 = 1.0;
pub(super) const MARK: f32 = 4.0;

/// Max distance between the picture and a mark outside whose label is still drawn, points.
const OUTSIDE: f32 = 8.0;

/// Key of a label from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::ui) enum Key {
    /// Name of the selected satellite.
    Selected(u32),
    /// The station on the map.
    Station,
    Aos,
    Tca,
    Los,
    /// The chosen moment of a recorded pass.
    Cursor,
    /// A full minute of the pass, as minutes since 1970.
    Minute(i64),
    Sun,
    Moon,
    /// The selected antenna, if its elevation is unknown.
    Bearing,
    /// An antenna that is not selected, by its index in the station.
    Antenna(usize),
    /// The planned pointing of an antenna at another time, by index.
    Planned(usize),
    /// The selected antenna, in the sky of another time.
    LiveAntenna,
    /// The end of an azimuth axis.
    Stop(usize),
    /// Name of a satellite that is not selected, by its catalog number.
    Other(u32),
}

/// A label to place.
pub(in crate::ui) struct Label<'a> {
    pub(in crate::ui) key: Key,
    pub(in crate::ui) lines: &'a [(&'a str, FontId, Color32)],
    /// Position of the mark.
    pub(in crate::ui) mark: Pos2,
    /// Distance from the centre of the mark, points.
    pub(in crate::ui) clearance: f32,
    /// Sides to try, the best first.
    pub(in crate::ui) order: &'a [Side],
    /// Max covered share of the label, 0 to 1. Azel drops a label with a larger share.
    pub(in crate::ui) tolerance: f32,
}

/// The labels of one frame.
pub(in crate::ui) struct Labels<'a> {
    painter: &'a Painter,
    tokens: &'a Tokens,
    /// The disc that the background of a label must not leave.
    dome: Option<Dome>,
    bounds: Rect,
    obstacles: Vec<Obstacle>,
    /// Backgrounds of the labels, and their index among the painted shapes.
    grounds: Vec<Shape>,
    grounds_at: ShapeIdx,
    /// Places of the painted labels, which no other label may overlap.
    texts: Vec<Rect>,
    before: HashMap<Key, Memory>,
    memory: HashMap<Key, Memory>,
}

impl<'a> Labels<'a> {
    /// Starts a frame with the memory of the previous frame. Shapes painted afterwards lie above
    /// the backgrounds of the labels.
    pub(in crate::ui) fn new(
        painter: &'a Painter,
        tokens: &'a Tokens,
        dome: Option<Dome>,
        bounds: Rect,
        before: HashMap<Key, Memory>,
    ) -> Self {
        Self {
            painter,
            tokens,
            dome,
            bounds,
            obstacles: Vec::new(),
            grounds: Vec::new(),
            grounds_at: painter.add(Shape::Noop),
            texts: Vec::new(),
            before,
            memory: HashMap::new(),
        }
    }

    /// Returns the part of the picture that labels should not leave.
    pub(in crate::ui) fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Keeps labels away from a mark or a number.
    pub(in crate::ui) fn reserve(&mut self, rect: Rect) {
        self.avoid(rect, MARK);
    }

    /// Prevents labels from covering a text.
    pub(in crate::ui) fn keep_off(&mut self, text: Rect) {
        self.texts.push(text);
    }

    /// Paints a number at the first free place of `places`, or else at the least covered place. No
    /// later label may cover the number.
    pub(super) fn add_number(&mut self, words: String, places: &[Pos2]) {
        let t = self.tokens;
        let galley = self.painter.layout_no_wrap(words, text::caption(), t.t3);
        let on =
            |position: &Pos2| Rect::from_center_size(*position, galley.size() + vec2(6.0, 0.0));
        let is_free = |rect: &Rect| {
            self.bounds.contains_rect(*rect)
                && !self.texts.iter().any(|other| other.intersects(*rect))
        };
        let best = places
            .iter()
            .map(on)
            .filter(is_free)
            .map(|rect| (rect, covered(rect, self.bounds, &self.obstacles)))
            .reduce(|best, next| if next.1 + 1e-3 < best.1 { next } else { best });
        let Some((rect, _)) = best else { return };
        self.grounds.push(Shape::rect_filled(rect, 0.0, t.sky));
        self.painter.galley(rect.min + vec2(3.0, 0.0), galley, t.t3);
        self.texts.push(rect);
    }

    /// Keeps labels away from a box, according to its weight.
    pub(super) fn avoid(&mut self, rect: Rect, weight: f32) {
        // In a magnified sky most obstacles are out of sight.
        if self.bounds.intersects(rect) {
            self.obstacles.push(Obstacle { rect, weight });
        }
    }

    /// Keeps labels away from a line of `width` points.
    pub(in crate::ui) fn reserve_path(&mut self, path: &[Pos2], width: f32) {
        for pair in path.windows(2) {
            let &[start, end] = pair else { continue };
            let steps = (start.distance(end) / width).ceil().clamp(1.0, 500.0) as u16;
            // The last point of a segment is the first one of the next segment.
            for step in 0..steps {
                let position = start.lerp(end, f32::from(step) / f32::from(steps));
                self.avoid(Rect::from_center_size(position, Vec2::splat(width)), LINE);
            }
        }
    }

    /// Paints a label at the best place and keeps later labels away from it. Returns `None` for a
    /// dropped label; earlier labels have priority.
    pub(in crate::ui) fn add(&mut self, label: &Label<'_>) -> Option<Placement> {
        if !self.bounds.expand(OUTSIDE).contains(label.mark) {
            return None;
        }
        let measure = job(label, Align::LEFT);
        let size = self.painter.layout_job(measure).size() + Vec2::splat(2.0 * PADDING);
        let rect = |side: &Side| side.rect(label.mark, size, label.clearance);
        let is_free = |side: &Side| !self.texts.iter().any(|text| text.intersects(rect(side)));
        let is_whole = |side: &Side| self.bounds.contains_rect(rect(side));
        let mut free: Vec<Side> = label.order.iter().copied().filter(is_free).collect();
        // A label that is always shown covers a line rather than lose letters at the edge.
        if label.tolerance >= 1.0 && free.iter().any(is_whole) {
            free.retain(is_whole);
        }
        let place = place(
            label.mark,
            size,
            label.clearance,
            &free,
            self.bounds,
            &self.obstacles,
            self.before.get(&label.key).copied(),
        )?;
        // The memory keeps the first choice. Otherwise many small steps would add up unnoticed.
        let chosen = Memory { side: place.side, covered: place.covered };
        let previous = self.before.get(&label.key).filter(|memory| memory.side == place.side);
        self.memory.insert(label.key, previous.copied().unwrap_or(chosen));
        if place.covered.min(1.0) > label.tolerance {
            return None;
        }
        self.paint(label, place);
        self.texts.push(place.rect);
        Some(place)
    }

    /// Paints the backgrounds. Returns the memory for the next frame.
    pub(in crate::ui) fn finish(self) -> HashMap<Key, Memory> {
        self.painter.set(self.grounds_at, Shape::Vec(self.grounds));
        self.memory
    }

    fn paint(&mut self, label: &Label<'_>, place: Placement) {
        let direction = place.side.direction();
        let align = match direction.x {
            x if x < 0.0 => Align::RIGHT,
            x if x > 0.0 => Align::LEFT,
            _ => Align::Center,
        };
        let galley = self.painter.layout_job(job(label, align));
        let inner = place.rect.shrink(PADDING);
        let on = |colour| Shape::rect_filled(place.rect, 0.0, colour);
        match self.dome {
            Some(dome) => {
                // A background is also needed outside of the rim, because no line may cross a
                // label.
                let is_across = dome.touches(place.rect) && !dome.holds(place.rect);
                self.grounds.extend(is_across.then(|| on(self.tokens.bg0)));
                let points = dome.clipped(place.rect);
                let sky = |points| Shape::convex_polygon(points, self.tokens.sky, Stroke::NONE);
                self.grounds.extend(points.map(sky));
            }
            None => self.grounds.push(on(self.tokens.sky)),
        }
        // A galley that is not aligned to the left extends around its origin.
        let shift = inner.min - galley.rect.min.to_vec2();
        self.painter.galley(shift, galley, self.tokens.t2);
    }
}

fn job(label: &Label<'_>, align: Align) -> LayoutJob {
    let mut job = LayoutJob { halign: align, ..LayoutJob::default() };
    for (index, (text, font, colour)) in label.lines.iter().enumerate() {
        let text = if index == 0 { (*text).to_owned() } else { format!("\n{text}") };
        job.append(&text, 0.0, TextFormat::simple(font.clone(), *colour));
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::{
        sky_plot::{testing, track},
        theme,
        widgets::testing::window,
    };
    use egui::pos2;

    /// Returns the keys of the labels of the pass on a disc of this radius. Checks that no labels
    /// overlap.
    fn labelled(radius: f32) -> Vec<Key> {
        let dome = Dome { centre: pos2(200.0, 200.0), radius };
        let bounds = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 400.0));
        let samples = testing::pass();
        let mut harness = window(bounds.size(), Vec::new(), move |ui, found| {
            let t = theme::tokens(ui.ctx());
            let pass = testing::track(&samples);
            let mut labels = Labels::new(ui.painter(), t, Some(dome), bounds, HashMap::new());
            let (events, ticks) = (track::events(&pass), track::ticks(dome, &pass));
            track::label_events(&mut labels, dome, &events, pass.los.time, t);
            track::label_minutes(&mut labels, &ticks, &events, pass.los.time, t);
            for (index, text) in labels.texts.iter().enumerate() {
                let others = &labels.texts[index + 1..];
                assert!(others.iter().all(|other| !other.intersects(*text)), "{radius}");
            }
            *found = labels.finish().into_keys().collect();
        });
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn a_label_that_is_always_shown_rather_covers_a_line_than_loses_letters() {
        let bounds = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 400.0));
        let mut harness = window(bounds.size(), None, move |ui, found| {
            let t = theme::tokens(ui.ctx());
            let mut labels = Labels::new(ui.painter(), t, None, bounds, HashMap::new());
            let mark = pos2(30.0, 200.0);
            for x in (40_u8..200).step_by(8) {
                let x = f32::from(x);
                labels.reserve_path(&[pos2(x, 100.0), pos2(x, 300.0)], 6.0);
            }
            *found = labels.add(&Label {
                key: Key::Cursor,
                lines: &[("1.78°, 01:22:10Z", text::small(), t.t1)],
                mark,
                clearance: 9.0,
                order: &Side::by_nearness(vec2(-1.0, 0.0)),
                tolerance: 1.0,
            });
        });
        harness.run();
        let placed = harness.state().as_ref().map(|placed| placed.rect);
        assert!(placed.is_some_and(|rect| bounds.contains_rect(rect)), "{placed:?}");
    }

    #[test]
    fn labels_that_have_no_room_are_dropped_and_those_of_the_ends_last() {
        let minutes =
            |keys: &[Key]| keys.iter().filter(|key| matches!(key, Key::Minute(_))).count();
        let all = labelled(190.0);
        assert!([Key::Aos, Key::Tca, Key::Los].iter().all(|key| all.contains(key)));
        assert!(minutes(&all) > 0);
        let few = labelled(60.0);
        assert!([Key::Aos, Key::Los].iter().all(|key| few.contains(key)));
        assert!(minutes(&few) < minutes(&all), "{few:?}");
        let labels_of_small = labelled(20.0);
        assert!(
            [Key::Aos, Key::Los].iter().all(|key| labels_of_small.contains(key)),
            "{labels_of_small:?}"
        );
    }
}
