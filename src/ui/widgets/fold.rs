//! The heading line of a section that opens on a click.

use egui::{Align2, Color32, Rect, Role, Ui, pos2};

use super::paint;
use crate::ui::{
    icons::{self, Icon},
    text, theme,
};

pub const HEIGHT: f32 = 28.0;

/// The heading line.
#[derive(Debug, Clone, Copy)]
pub struct FoldModel<'a> {
    pub title: &'a str,
    /// The most important content of the section, shown while it is closed.
    pub value: &'a str,
    /// Icon after the value.
    pub mark: Option<(Icon, Color32)>,
}

/// Shows the line in `rect` and flips `open` on a click. Returns `true` if the click
/// opened the section; the caller then scrolls its content into sight.
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
    let at = paint::square(pos2(rect.left() + 18.0, y), 12.0);
    icons::paint(ui.painter(), at, chevron, t.t2);
    let at = pos2(rect.left() + 34.0, y);
    let title = paint::text(ui, at, Align2::LEFT_CENTER, model.title, text::body_medium(), t.t1);
    let mut right = rect.right() - 12.0;
    if let Some((icon, colour)) = model.mark {
        let at = paint::square(pos2(right - 6.0, y), 12.0);
        icons::paint(ui.painter(), at, icon, colour);
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
