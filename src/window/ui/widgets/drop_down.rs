//! A button that opens a list of choices below it.

use egui::{Popup, Rect, Response, Role, ScrollArea, TextWrapMode, Ui, WidgetInfo};

use super::{button::Button, menu};

/// Max height of a list, points; a longer list scrolls.
const MAX_HEIGHT: f32 = 400.0;

/// A button that shows the current choice and offers the others.
#[derive(Debug, Clone, Copy)]
pub struct DropDown<'a> {
    /// Button with the current choice.
    pub button: Button<'a>,
    /// Salt that distinguishes the drop-down from others.
    pub salt: &'static str,
    /// Subject and current choice, for screen readers.
    pub name: &'a str,
}

impl DropDown<'_> {
    pub fn width(&self, ui: &Ui) -> f32 {
        self.button.chevron().width(ui)
    }

    /// Shows the button in `rect`, and `choices` while it is open; a click on a choice closes it.
    pub fn show(self, ui: &Ui, rect: Rect, choices: impl FnOnce(&mut Ui)) -> Response {
        let response = self.button.chevron().show(ui, self.salt, rect);
        let is_free = !self.button.is_locked();
        response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, is_free, self.name));
        menu::show(
            &response,
            Popup::menu(&response).width(rect.width()).accessible_name(self.name),
            |ui| {
                ui.set_min_width(ui.available_width());
                ScrollArea::vertical().max_height(MAX_HEIGHT).show(ui, |ui| {
                    // A choice may be wider than the button.
                    ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
                    choices(ui);
                });
            },
        );
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::{button::SMALL_HEIGHT, testing};
    use egui::{Key, pos2, vec2};
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn a_choice_is_made_and_closes_the_list() {
        let long = "SFTP, by the key of the host that was shown before";
        let words = ["FTP", long];
        let mut window = testing::window([600.0, 200.0], "FTP", move |ui, chosen| {
            let name = format!("Protocol, {chosen}");
            let list = DropDown { button: Button::normal(chosen), salt: "list", name: &name };
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(120.0, SMALL_HEIGHT));
            list.show(ui, rect, |ui| {
                for word in words {
                    ui.selectable_value(chosen, word, word);
                }
            });
        });
        assert!(window.query_by_label(long).is_none());
        window.get_by_role_and_label(Role::ComboBox, "Protocol, FTP").click();
        window.run();
        let choice = window.get_by_label(long).rect();
        assert!(choice.height() < 40.0 && choice.width() > 200.0, "on one line: {choice:?}");
        window.get_by_label(long).click();
        window.run();
        window.get_by_role_and_label(Role::ComboBox, &format!("Protocol, {long}"));
        assert!(window.query_by_role_and_label(Role::Button, "FTP").is_none());
    }

    #[test]
    fn a_choice_by_keys_closes_the_list_and_gives_the_focus_back() {
        let mut window = testing::window([600.0, 200.0], "FTP", move |ui, chosen| {
            let name = format!("Protocol, {chosen}");
            let list = DropDown { button: Button::normal(chosen), salt: "list", name: &name };
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(120.0, SMALL_HEIGHT));
            list.show(ui, rect, |ui| {
                for word in ["FTP", "SFTP"] {
                    ui.selectable_value(chosen, word, word);
                }
            });
        });
        window.get_by_role(Role::ComboBox).focus();
        window.run();
        for key in [Key::Enter, Key::ArrowDown, Key::ArrowDown, Key::Enter] {
            window.key_press(key);
            window.run();
        }
        assert_eq!(*window.state(), "SFTP");
        assert!(window.query_by_role_and_label(Role::Button, "SFTP").is_none(), "it is closed");
        assert!(window.get_by_role(Role::ComboBox).is_focused());
    }
}
