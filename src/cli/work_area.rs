//! The part of the desktop that its panels leave to windows, where the window system tells it.

use egui::{Vec2, vec2};
#[cfg(target_os = "linux")]
use x11rb::{
    connection::Connection as _,
    protocol::xproto::{AtomEnum, ConnectionExt as _},
};

/// Room for windows, in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct WorkArea {
    width: u32,
    height: u32,
}

impl WorkArea {
    /// `None` where only the window system itself keeps windows clear of its panels, as Wayland
    /// does.
    pub(super) fn of_the_desktop() -> Option<Self> {
        let is_wayland = std::env::var_os("WAYLAND_DISPLAY").is_some_and(|name| !name.is_empty());
        if is_wayland { None } else { Self::of_x11() }
    }

    #[cfg(target_os = "linux")]
    fn of_x11() -> Option<Self> {
        let (connection, screen) = x11rb::connect(None).ok()?;
        let root = connection.setup().roots.get(screen)?.root;
        let name = connection.intern_atom(true, b"_NET_WORKAREA").ok()?.reply().ok()?;
        let kind = AtomEnum::CARDINAL;
        let cookie = connection.get_property(false, root, name.atom, kind, 0, 4).ok()?;
        let values: Vec<u32> = cookie.reply().ok()?.value32()?.collect();
        Self::of_values(&values)
    }

    #[cfg(not(target_os = "linux"))]
    fn of_x11() -> Option<Self> {
        None
    }

    /// The area of the first desktop: x, y, width, height.
    fn of_values(values: &[u32]) -> Option<Self> {
        let [_, _, width, height] = *values else { return None };
        (width > 0 && height > 0).then_some(Self { width, height })
    }

    /// Width and height in points.
    pub(super) fn points(self, pixels_per_point: f32) -> Vec2 {
        vec2(self.width as f32, self.height as f32) / pixels_per_point
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_is_taken_as_the_desktop_tells_it_or_not_at_all() {
        let area = WorkArea::of_values(&[0, 28, 2880, 1744]).unwrap();
        assert_eq!(area.points(2.0), vec2(1440.0, 872.0));
        for numbers in [&[][..], &[0, 28, 2880], &[0, 0, 0, 0]] {
            assert_eq!(WorkArea::of_values(numbers), None);
        }
    }
}
