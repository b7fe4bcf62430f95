//! Push buttons.

use egui::{Align2, Color32, Pos2, Rect, Response, Role, Stroke, StrokeKind, Ui, pos2, vec2};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text, theme,
};

pub const HEIGHT: f32 = 32.0;
pub const SMALL_HEIGHT: f32 = 24.0;
/// Width of an icon with the gap after it, points.
const ICON: f32 = 24.0;
/// Gap between two buttons side by side, points.
pub const GAP: f32 = 8.0;
/// Corner radius of buttons and jog keys, points.
pub const RADIUS: u8 = 5;

/// Emphasis of a button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// The main action of its place.
    Primary,
    Normal,
    /// An unobtrusive button.
    Quiet,
}

#[derive(Debug, Clone, Copy)]
pub struct Button<'a> {
    text: &'a str,
    weight: Weight,
    locked: bool,
    reason: Option<&'a str>,
    chevron: bool,
    icon: Option<Icon>,
}

impl<'a> Button<'a> {
    pub fn normal(text: &'a str) -> Self {
        Self {
            text,
            weight: Weight::Normal,
            locked: false,
            reason: None,
            chevron: false,
            icon: None,
        }
    }

    /// Creates a button for the main action of its place.
    pub fn primary(text: &'a str) -> Self {
        Self { weight: Weight::Primary, ..Self::normal(text) }
    }

    /// Creates an unobtrusive button.
    pub fn quiet(text: &'a str) -> Self {
        Self { weight: Weight::Quiet, ..Self::normal(text) }
    }

    /// Draws the button dashed and ignores clicks; the caller shows the reason next to it.
    #[must_use]
    pub fn locked(self, locked: bool) -> Self {
        Self { locked, ..self }
    }

    /// Locks the button if there is a reason, and shows the reason as a tooltip.
    #[must_use]
    pub fn locked_by(self, reason: Option<&'a str>) -> Self {
        Self { locked: self.locked || reason.is_some(), reason, ..self }
    }

    pub fn is_locked(&self) -> bool {
        self.locked
    }

    /// Adds a chevron, for a button that opens a part below it.
    #[must_use]
    pub fn chevron(self) -> Self {
        Self { chevron: true, ..self }
    }

    /// Adds an icon before the text.
    #[must_use]
    pub fn icon(self, icon: Icon) -> Self {
        Self { icon: Some(icon), ..self }
    }

    /// Returns the width of the text with its padding, points.
    pub fn width(&self, ui: &Ui) -> f32 {
        let chevron = if self.chevron { 20.0 } else { 0.0 };
        let icon = if self.icon.is_some() { ICON } else { 0.0 };
        (paint::text_width(ui, self.text, text::body_medium()) + 24.0 + chevron + icon).ceil()
    }

    pub fn show(self, ui: &Ui, salt: impl egui::AsIdSalt, rect: Rect) -> Response {
        let response = paint::control(ui, salt, rect, Role::Button, !self.locked, self.text);
        let t = theme::tokens(ui);
        let down = response.is_pointer_button_down_on();
        let colour = if self.locked {
            paint::dashed_border(ui, rect, f32::from(RADIUS), (1.0, t.edge));
            t.t3
        } else {
            let (fill, border, colour) = match self.weight {
                Weight::Primary => (t.sat, t.sat, t.onsat),
                Weight::Normal => (if down { t.bgsel } else { t.bg3 }, t.edge, t.t1),
                Weight::Quiet => {
                    let fill = if down { t.bg3 } else { Color32::TRANSPARENT };
                    (fill, t.edge, t.t1)
                }
            };
            let border =
                if response.hovered() && self.weight != Weight::Primary { t.t2 } else { border };
            ui.painter().rect(rect, RADIUS, fill, Stroke::new(1.0, border), StrokeKind::Inside);
            colour
        };
        let room = rect.shrink2(vec2(6.0, 0.0));
        if self.chevron {
            let position = pos2(rect.right() - 14.0, rect.center().y);
            icons::paint(ui.painter(), paint::square(position, 12.0), Icon::ChevronDown, colour);
            let room = room.with_max_x(rect.right() - 22.0);
            paint::text_in(ui, room, Align2::CENTER_CENTER, self.text, text::body_medium(), colour);
        } else {
            let icon = if self.icon.is_some() { ICON } else { 0.0 };
            let words = room.translate(vec2(icon / 2.0, 0.0)).with_max_x(room.right());
            let anchor = Align2::CENTER_CENTER;
            let place = paint::text_in(ui, words, anchor, self.text, text::body_medium(), colour);
            if let Some(icon) = self.icon {
                let position = pos2(place.left() - ICON / 2.0 - 2.0, rect.center().y);
                icons::paint(ui.painter(), paint::square(position, 16.0), icon, colour);
            }
        }
        paint::focus_ring(ui, &response, RADIUS);
        match self.reason {
            Some(reason) => response.on_hover_text(reason),
            None => response,
        }
    }
}

/// Shows the two answers to a question side by side.
pub fn pair(ui: &mut Ui, first: Button<'_>, second: Button<'_>) -> [Response; 2] {
    let [left_width, right_width] = [first, second].map(|button| button.width(ui));
    let size = vec2(left_width + GAP + right_width, HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let left = rect.with_max_x(rect.left() + left_width);
    let right = rect.with_min_x(left.right() + GAP);
    [first.show(ui, "first answer", left), second.show(ui, "second answer", right)]
}

/// Returns the places for buttons of these widths side by side. The last button ends at `right`,
/// the middle of its edge. Show the buttons in this order, which is the Tab order.
pub fn row<const N: usize>(mut right: Pos2, widths: [f32; N]) -> [Rect; N] {
    row_before(&mut right, HEIGHT, widths)
}

/// Returns places like [`row`], for buttons of this height. Moves `right` to the end of the room
/// before the buttons.
pub fn row_before<const N: usize>(right: &mut Pos2, height: f32, widths: [f32; N]) -> [Rect; N] {
    let whole = widths.iter().map(|width| width + GAP).sum::<f32>();
    right.x -= whole;
    let mut left = right.x + GAP;
    widths.map(|width| {
        let min = pos2(left, right.y - height / 2.0);
        left += width + GAP;
        Rect::from_min_size(min, vec2(width, height))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui::pos2;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn a_click_is_reported_and_a_locked_button_is_silent() {
        let mut window = testing::window([300.0, 100.0], [0, 0], |ui, clicks| {
            let rect = |x| Rect::from_min_size(pos2(x, 20.0), vec2(100.0, HEIGHT));
            if Button::primary("Track").show(ui, "a", rect(10.0)).clicked() {
                clicks[0] += 1;
            }
            if Button::normal("Go to").locked(true).show(ui, "b", rect(130.0)).clicked() {
                clicks[1] += 1;
            }
        });
        window.get_by_role_and_label(Role::Button, "Track").click();
        window.run();
        window.get_by_role_and_label(Role::Button, "Go to").click();
        window.run();
        assert_eq!(*window.state(), [1, 0]);
    }
}
