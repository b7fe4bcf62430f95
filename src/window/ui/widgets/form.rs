//! Parts of every form: the row with its label, the entered text, the state next to a field and the
//! note below it.

use egui::{
    Align, Align2, Color32, Id, Label, Layout, Rect, Response, RichText, TextEdit, Ui, vec2,
};

use super::{input::select_when_tabbed, paint};
use crate::ui::{
    icons::{self, Icon},
    text, theme,
    tokens::Tokens,
};

/// Width of the labels of a page, points.
pub const LABEL: f32 = 176.0;
pub const ROW: f32 = 24.0;
/// Gap between label, field and state, points.
pub const GAP: f32 = 8.0;
/// Width of the mark of a state, points.
const MARK: f32 = 18.0;
/// Width below which the state of a field is only its mark, points.
const MIN_STATE: f32 = 64.0;

/// An entered text and its saved text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    pub text: String,
    /// The saved text; `None` for a new field.
    saved: Option<String>,
}

impl Entry {
    pub fn saved(text: String) -> Self {
        Self { saved: Some(text.clone()), text }
    }

    /// Creates the entry of a new field.
    pub fn added(text: String) -> Self {
        Self { text, saved: None }
    }

    pub fn is_new(&self) -> bool {
        self.saved.is_none()
    }

    pub fn is_edited(&self) -> bool {
        self.was().is_some()
    }

    /// Returns the saved text if the entered text differs.
    pub fn was(&self) -> Option<&str> {
        self.saved.as_deref().filter(|saved| *saved != self.text)
    }

    /// Returns the saved text; empty for a new field.
    pub fn before(&self) -> &str {
        self.saved.as_deref().unwrap_or_default()
    }
}

/// State of a field. It sets the border of the field, and the mark and the colour of the words next
/// to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    Plain,
    Edited,
    /// A value that waits for the operator.
    Pending,
    /// A value that waits until the operator unlocks the service functions.
    NeedsUnlock,
    Sending,
    Good,
    Invalid,
    /// A value that the unit does not accept or has rejected.
    Refused,
    Unknown,
    Locked,
}

impl Mark {
    /// Returns icon and colour of the words.
    pub fn look(self, t: &Tokens) -> (Option<Icon>, Color32) {
        match self {
            Self::Plain => (None, t.t3),
            Self::Edited => (Some(Icon::Pencil), t.sat),
            Self::Pending => (Some(Icon::Warning), t.warn),
            Self::NeedsUnlock => (Some(Icon::Lock), t.warn),
            Self::Sending => (Some(Icon::HalfDisc), t.cmd),
            Self::Good => (Some(Icon::Check), t.ok),
            Self::Invalid => (Some(Icon::Warning), t.bad),
            Self::Refused => (Some(Icon::Cross), t.bad),
            Self::Unknown => (Some(Icon::Dash), t.t3),
            Self::Locked => (Some(Icon::Lock), t.t3),
        }
    }

    /// Returns the colour of the border, if the field has one.
    pub fn border(self, t: &Tokens) -> Option<Color32> {
        let is_plain = matches!(self, Self::Plain | Self::Sending | Self::Unknown | Self::Locked);
        (!is_plain).then(|| self.look(t).1)
    }
}

/// Returns the state of a field in words: this problem, or else an edit of the text `was`.
pub fn standing(problem: Option<String>, was: Option<&str>) -> (Mark, String) {
    match (problem, was) {
        (Some(reason), _) => (Mark::Invalid, reason),
        (None, Some(was)) => {
            let was = if was.is_empty() { "empty" } else { was };
            (Mark::Edited, format!("Edited, was {was}").replace('-', "−"))
        }
        (None, None) => (Mark::Plain, String::new()),
    }
}

/// Paints the state of a field in `room`. If it has a mark, `name` is its accessible name.
pub fn state(ui: &Ui, salt: impl egui::AsIdSalt, room: Rect, mark: Mark, [words, name]: [&str; 2]) {
    let (icon, colour) = mark.look(theme::tokens(ui));
    let mut place = room;
    if let Some(icon) = icon {
        let rect = paint::square(room.left_center() + vec2(6.0, 0.0), 12.0);
        icons::paint(ui.painter(), rect, icon, colour);
        place = room.with_min_x(room.left() + MARK);
    }
    if room.width() >= MIN_STATE {
        paint::text_in(ui, place, Align2::LEFT_CENTER, words, text::small(), colour);
    }
    if icon.is_some() {
        let named = paint::name_text(ui, ("state", salt), room, name);
        if words != name || !paint::fits(ui, words, text::small(), place) {
            named.on_hover_text(name);
        }
    }
}

/// Shows a row with `content` next to a label of this width. Returns the result of `content` and
/// the place of the whole row.
pub fn labelled<R>(
    ui: &mut Ui,
    label: &str,
    width: f32,
    content: impl FnOnce(&mut Ui, Id) -> R,
) -> (R, Rect) {
    let t = theme::tokens(ui);
    let response = ui.horizontal_top(|ui| {
        let words = RichText::new(label).font(text::body()).color(t.t2);
        let left = Layout::left_to_right(Align::Center);
        let name = ui.allocate_ui_with_layout(vec2(width, ROW), left, |ui| {
            ui.set_min_width(width);
            ui.label(words).id
        });
        content(ui, name.inner)
    });
    (response.inner, response.response.rect)
}

/// Shows a row with a text of one line, which shows `hint` while it is empty. `widths` are the
/// widths of the label and, as far as there is room, of the field.
pub fn text_field(
    ui: &mut Ui,
    (label, hint): (&str, &str),
    widths: [f32; 2],
    typed: &mut String,
) -> Response {
    let [label_width, width] = widths;
    let field = |ui: &mut Ui, name| {
        let hint = RichText::new(hint).color(theme::tokens(ui).t3);
        let width = width.min(ui.available_width());
        let edit = TextEdit::singleline(typed).id_salt(label).hint_text(hint).desired_width(width);
        let response = ui.add(edit).labelled_by(name);
        select_when_tabbed(ui, &response, typed);
        response
    };
    labelled(ui, label, label_width, field).0
}

/// Shows a note in the column of the fields.
pub fn note(ui: &mut Ui, words: &str, colour: Color32) {
    ui.horizontal_top(|ui| {
        ui.add_space(LABEL + GAP);
        let words = RichText::new(words).font(text::small()).color(colour);
        ui.add(Label::new(words).wrap());
    });
}
