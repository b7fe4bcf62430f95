//! The heading line of a section that opens on a click.

use egui::{Align2, Color32, Rect, Role, Ui, pos2};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text, theme,
};

pub const HEIGHT: f32 = 28.0;

/// Content of the heading line.
#[derive(Debug, Clone, Copy)]
pub struct FoldModel<'a> {
    pub title: &'a str,
    /// Most important content of the section, shown while the section is closed.
    pub value: &'a str,
    /// Icon after the value.
    pub mark: Option<(Icon, Color32)>,
}

/// A section that is open where it has room, unless the operator has opened or closed it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fold {
    chosen: Option<bool>,
    has_room: bool,
    /// Height of the content when it was last drawn, points; 0 if unknown.
    height: f32,
}

impl Fold {
    pub fn is_open(&self) -> bool {
        self.chosen.unwrap_or(self.has_room)
    }

    /// Takes the choice of the operator.
    pub fn choose(&mut self, is_open: bool) {
        self.chosen = Some(is_open);
    }

    /// Takes the height of the drawn content, points.
    pub fn drawn(&mut self, height: f32) {
        self.height = height;
    }

    /// Clears the height, because the content changes.
    pub fn forget_height(&mut self) {
        (self.has_room, self.height) = (false, 0.0);
    }

    /// Opens the section if `free` points remain for it, or closes it if the view is too high.
    /// Returns `true` if the section changed.
    pub fn settle(&mut self, free: &mut f32) -> bool {
        let fits = if self.has_room { *free >= 0.0 } else { *free > self.height };
        if self.chosen.is_some() || fits == self.has_room {
            return false;
        }
        *free += if fits { -self.height } else { self.height };
        self.has_room = fits;
        true
    }
}

/// Shows the line in `rect` and flips `open` on a click. Returns `true` if the click opened the
/// section; the caller then scrolls to its content.
pub fn show(ui: &Ui, rect: Rect, model: &FoldModel<'_>, open: &mut bool) -> bool {
    let t = theme::tokens(ui);
    let name = format!("{}: {}", model.title, model.value);
    let response = paint::control(ui, ("fold", model.title), rect, Role::Button, true, &name);
    if response.clicked() {
        *open = !*open;
    }
    let state = *open;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(state));
    if response.hovered() {
        ui.painter().rect_filled(rect, 0.0, t.bg3);
    }
    ui.painter().hline(rect.x_range(), rect.top(), (1.0, t.line));
    let y = rect.center().y;
    let chevron = if *open { Icon::ChevronDown } else { Icon::ChevronRight };
    let area = paint::square(pos2(rect.left() + 18.0, y), 12.0);
    icons::paint(ui.painter(), area, chevron, t.t2);
    let position = pos2(rect.left() + 34.0, y);
    let title =
        paint::text(ui, position, Align2::LEFT_CENTER, model.title, text::body_medium(), t.t1);
    let mut right = rect.right() - 12.0;
    if let Some((icon, colour)) = model.mark {
        let area = paint::square(pos2(right - 6.0, y), 12.0);
        icons::paint(ui.painter(), area, icon, colour);
        right -= 20.0;
    }
    let room = rect.with_min_x(title.right() + 8.0).with_max_x(right);
    paint::text_in(ui, room, Align2::RIGHT_CENTER, model.value, text::small(), t.t2);
    paint::focus_ring(ui, &response, 0);
    *open && response.clicked()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui::vec2;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn a_section_opens_where_it_has_room_and_does_not_flutter() {
        let mut fold = Fold::default();
        // The fold learns its height of 60 points only by drawing; 50 points are free.
        assert!(fold.settle(&mut 50.0) && fold.is_open());
        fold.drawn(60.0);
        assert!(fold.settle(&mut -10.0) && !fold.is_open());
        assert!(!fold.settle(&mut 50.0) && !fold.is_open());
        assert!(fold.settle(&mut 61.0) && fold.is_open());
        assert!(!fold.settle(&mut 1.0) && fold.is_open());
        fold.choose(false);
        assert!(!fold.settle(&mut 500.0) && !fold.is_open());
        fold.choose(true);
        assert!(!fold.settle(&mut -500.0) && fold.is_open());
    }

    #[test]
    fn a_click_opens_and_the_next_one_closes() {
        let mut window = testing::window([400.0, 80.0], false, |ui, open| {
            let model = FoldModel { title: "Travel", value: "X 82.9°  Y 37.8°", mark: None };
            show(ui, Rect::from_min_size(pos2(0.0, 10.0), vec2(304.0, HEIGHT)), &model, open);
        });
        window.get_by_label("Travel: X 82.9°  Y 37.8°").click();
        window.run();
        assert!(*window.state());
        window.get_by_label("Travel: X 82.9°  Y 37.8°").click();
        window.run();
        assert!(!*window.state());
    }
}
