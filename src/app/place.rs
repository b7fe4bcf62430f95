//! Size and place of the window, kept for each station and fitted to the current screens.

use std::time::Duration;

use egui::{Context, Rect, Vec2, ViewportCommand, pos2, vec2};
use serde::{Deserialize, Serialize};

use super::App;
use crate::clock::Instant;

/// Time without a change after which Azel keeps a place.
const SETTLED: Duration = Duration::from_secs(1);

/// Place of the window, points; for a maximized window its place when not maximized.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Place {
    /// Position of the frame; `None` where the desktop does not report it.
    #[serde(rename = "at")]
    position: Option<[i32; 2]>,
    /// Size of the content, points.
    size: [u32; 2],
    is_maximized: bool,
}

/// The place of the window from frame to frame.
#[derive(Debug, Default)]
pub(super) struct PlaceWatch {
    /// Flag: Azel has requested the kept place.
    is_restored: bool,
    /// Last place, with the time since which it is unchanged.
    last: Option<(Place, Instant)>,
    /// First place, which the operator did not choose.
    first: Option<Place>,
}

impl Place {
    fn new(ctx: &Context, before: Option<Self>) -> Option<Self> {
        ctx.input(|input| {
            let viewport = input.viewport();
            if viewport.minimized == Some(true) || viewport.fullscreen == Some(true) {
                return None;
            }
            let inner = viewport.inner_rect?;
            let is_maximized = viewport.maximized == Some(true);
            if let Some(before) = before.filter(|_| is_maximized) {
                return Some(Self { is_maximized, ..before });
            }
            let position =
                viewport.outer_rect.map(|outer| [outer.left() as i32, outer.top() as i32]);
            let size = [inner.width() as u32, inner.height() as u32];
            Some(Self { position, size, is_maximized })
        })
    }

    /// Shrinks and moves the place onto the screen that shows most of it.
    fn fitted(self, screens: &[Rect]) -> Self {
        let size = vec2(self.size[0] as f32, self.size[1] as f32);
        let position = self.position.map(|[x, y]| pos2(x as f32, y as f32));
        let shown = |screen: &&Rect| {
            let visible =
                position.map(|position| Rect::from_min_size(position, size).intersect(**screen));
            visible.map_or(0.0, |visible| visible.width().max(0.0) * visible.height().max(0.0))
        };
        let best = screens.iter().max_by(|one, other| shown(one).total_cmp(&shown(other)));
        let Some(screen) = best else { return self };
        let size = size.min(screen.size());
        let position = position.map(|position| position.clamp(screen.min, screen.max - size));
        Self {
            position: position.map(|position| [position.x as i32, position.y as i32]),
            size: [size.x as u32, size.y as u32],
            ..self
        }
    }
}

impl App {
    /// Puts the window at the place kept for this station, once.
    pub(super) fn restore_place(&mut self, ctx: &Context, frame: &eframe::Frame) {
        if std::mem::replace(&mut self.place_watch.is_restored, true) {
            return;
        }
        let Some(saved) = self.keeper.memory.place else { return };
        let place = saved.fitted(&screens(ctx, frame));
        let size = Vec2::from(place.size.map(|length| length as f32));
        let mut commands = vec![ViewportCommand::InnerSize(size)];
        if let Some([x, y]) = place.position {
            commands.push(ViewportCommand::OuterPosition(pos2(x as f32, y as f32)));
        }
        if place.is_maximized {
            commands.push(ViewportCommand::Maximized(true));
        }
        for command in commands {
            ctx.send_viewport_cmd_to(egui::ViewportId::ROOT, command);
        }
    }

    /// Keeps the place of the window once the operator has changed it.
    pub(super) fn watch_place(&mut self, ctx: &Context) {
        let (watch, now) = (&mut self.place_watch, self.model.steady);
        let Some(place) = Place::new(ctx, watch.last.map(|(place, _)| place)) else { return };
        let start = match watch.last {
            Some((last, start)) if last == place => start,
            _ => now,
        };
        watch.last = Some((place, start));
        if now.saturating_duration_since(start) < SETTLED {
            return;
        }
        if *watch.first.get_or_insert(place) != place {
            self.keeper.memory.place = Some(place);
            watch.first = Some(place);
        }
    }
}

/// Returns the screens of this desktop, in points.
fn screens(ctx: &Context, frame: &eframe::Frame) -> Vec<Rect> {
    let Some(window) = frame.winit_window() else { return Vec::new() };
    let points = 1.0 / ctx.pixels_per_point();
    let screen = |corner: winit::dpi::PhysicalPosition<i32>,
                  size: winit::dpi::PhysicalSize<u32>| {
        let min = pos2(corner.x as f32, corner.y as f32) * points;
        Rect::from_min_size(min, vec2(size.width as f32, size.height as f32) * points)
    };
    let monitors = window.available_monitors();
    let rects = monitors.map(|monitor| screen(monitor.position(), monitor.size()));
    rects.filter(Rect::is_positive).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: i32, y: i32, width: u32, height: u32) -> Place {
        Place { position: Some([x, y]), size: [width, height], is_maximized: false }
    }

    fn screen(x: f32, width: f32, height: f32) -> Rect {
        Rect::from_min_size(pos2(x, 0.0), vec2(width, height))
    }

    #[test]
    fn a_window_fits_the_screens_that_are_there() {
        let two = [screen(0.0, 1920.0, 1080.0), screen(1920.0, 1440.0, 900.0)];
        for (saved, screens, fitted) in [
            (place(100, 50, 1440, 900), &two[..], place(100, 50, 1440, 900)),
            (place(2000, 0, 1300, 800), &two, place(2000, 0, 1300, 800)),
            // The screen of this place is gone.
            (place(2000, 0, 1300, 800), &two[..1], place(620, 0, 1300, 800)),
            (place(300, 300, 1900, 1000), &two[1..], place(1920, 0, 1440, 900)),
            (place(-500, -90, 1440, 900), &two, place(0, 0, 1440, 900)),
            (place(7, 7, 1440, 900), &[], place(7, 7, 1440, 900)),
        ] {
            assert_eq!(saved.fitted(screens), fitted, "{saved:?} {screens:?}");
        }
        let nowhere = Place { position: None, ..place(0, 0, 4000, 3000) };
        assert_eq!(nowhere.fitted(&two[..1]), Place { size: [1920, 1080], ..nowhere });
    }
}
