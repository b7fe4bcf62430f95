//! Input fields for settings.

use egui::{
    Align2, Color32, Frame, Margin, Popup, Rect, Response, Role, Stroke, StrokeKind, TextEdit, Ui,
    pos2, text::CCursorRange, text_edit::TextEditState, vec2,
};

use super::{menu, paint};
use crate::{
    device::settings::Kind,
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
    },
};

const RADIUS: u8 = 4;
/// Padding between border and text, points.
const INSET: f32 = 6.0;

/// An input field.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    pub rect: Rect,
    /// Name for screen readers.
    pub name: &'a str,
    /// Border colour of a field that differs from the unit's value.
    pub border: Option<Color32>,
}

impl Input<'_> {
    /// Returns the border of the field; the focus ring surrounds the border.
    fn stroke(&self, ui: &Ui) -> Stroke {
        let plain = Stroke::new(1.0, theme::tokens(ui).edge);
        self.border.map_or(plain, |colour| Stroke::new(2.0, colour))
    }

    fn font(&self) -> egui::FontId {
        let weight = if self.border.is_some() { Weight::SemiBold } else { Weight::Regular };
        text::sized(12.0, weight)
    }

    /// Shows a text field. Returns `true` if the operator changed the text.
    pub fn text(&self, ui: &mut Ui, typed: &mut String, is_password: bool) -> bool {
        let t = theme::tokens(ui);
        let id = ui.make_persistent_id(("input", self.name));
        let stroke = self.stroke(ui);
        let frame = Frame::new()
            .fill(t.field)
            .stroke(stroke)
            .corner_radius(RADIUS)
            .inner_margin(Margin::symmetric(INSET as i8, 0));
        let edit = TextEdit::singleline(typed)
            .id(id)
            .frame(frame)
            .font(self.font())
            .text_color(t.t1)
            .password(is_password)
            .align(Align2::LEFT_CENTER)
            .min_size(self.rect.size())
            .desired_width(self.rect.width());
        let response = ui.place(self.rect, edit).accessible_name(self.name);
        select_when_tabbed(ui, &response, typed);
        paint::focus_ring(ui, &response, RADIUS);
        if is_password {
            forget_typing(ui, response.id);
        }
        response.changed()
    }

    /// Shows the field for a value of this kind. Returns `true` if the operator changed the value.
    pub fn value(&self, ui: &mut Ui, kind: &Kind, typed: &mut String) -> bool {
        let Some(choices) = kind.choices() else {
            return self.text(ui, typed, matches!(kind, Kind::Password(_)));
        };
        let other = self.choice(ui, typed, &choices);
        let is_changed = other.is_some();
        *typed = other.unwrap_or_else(|| std::mem::take(typed));
        is_changed
    }

    /// Shows a choice from a few values. Returns a newly chosen value.
    pub fn choice(&self, ui: &Ui, chosen: &str, offered: &[&str]) -> Option<String> {
        let t = theme::tokens(ui);
        let salt = ("input", self.name);
        let response = paint::control(ui, salt, self.rect, Role::ComboBox, true, self.name);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_value(chosen));
        let stroke = self.stroke(ui);
        ui.painter().rect(self.rect, RADIUS, t.field, stroke, StrokeKind::Inside);
        let position = pos2(self.rect.right() - 12.0, self.rect.center().y);
        icons::paint(ui.painter(), paint::square(position, 12.0), Icon::ChevronDown, t.t2);
        let room = self.rect.shrink2(vec2(INSET, 0.0)).with_max_x(self.rect.right() - 20.0);
        paint::text_in(ui, room, Align2::LEFT_CENTER, chosen, self.font(), t.t1);
        paint::focus_ring(ui, &response, RADIUS);
        let mut other = None;
        menu::show(
            &response,
            Popup::menu(&response).width(self.rect.width()).accessible_name(self.name),
            |ui| {
                ui.set_min_width(ui.available_width());
                for word in offered {
                    let button = egui::Button::selectable(*word == chosen, *word);
                    if ui.add(button).clicked() && *word != chosen {
                        other = Some((*word).to_owned());
                    }
                }
            },
        );
        other
    }

    /// Shows a read-only value.
    pub fn inert(&self, ui: &Ui, words: &str) {
        let t = theme::tokens(ui);
        paint::dashed_border(ui, self.rect, f32::from(RADIUS), (1.0, t.edge));
        let room = self.rect.shrink2(vec2(INSET, 0.0));
        paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small(), t.t2);
        let name = format!("{}: {words}", self.name);
        paint::name_text(ui, ("inert", self.name), self.rect, &name);
    }
}

/// Selects the whole text of a field that got the focus by a key, so that typing replaces it.
pub fn select_when_tabbed(ui: &Ui, response: &Response, typed: &str) {
    let by_pointer = ui.input(|input| input.pointer.any_down() || input.pointer.any_released());
    if !response.gained_focus() || by_pointer {
        return;
    }
    select_all(ui, response, typed);
}

/// Gives a field the focus, with its value selected.
pub fn focus_to_replace(ui: &Ui, response: &Response, typed: &str) {
    response.request_focus();
    select_all(ui, response, typed);
}

fn select_all(ui: &Ui, response: &Response, typed: &str) {
    let mut state = TextEditState::load(ui.ctx(), response.id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::select_all_str(typed)));
    state.store(ui.ctx(), response.id);
}

/// Clears the undo history. Otherwise Ctrl Z would bring back a sent or discarded password.
fn forget_typing(ui: &Ui, id: egui::Id) {
    if let Some(mut state) = TextEditState::load(ui.ctx(), id) {
        state.clear_undoer();
        state.store(ui.ctx(), id);
    }
}
