//! Parts of every form: the row with its label, the typed text, the state beside a field and the note
//! below it.

use egui::{
    Align, Align2, Color32, Id, Label, Layout, Rect, Response, RichText, TextEdit, Ui, vec2,
};

use super::{input::select_when_tabbed, paint};
use crate::ui::{
    icons::{self, Icon},
    text, theme,
    tokens::Tokens,
};

/// Width of the labels of a page.
pub const LABEL: f32 = 176.0;
pub const ROW: f32 = 24.0;
/// Gap between label, field and state.
pub const GAP: f32 = 8.0;
/// Width that the mark of a state needs.
const MARK: f32 = 18.0;
/// Width below which the state of a field is its mark alone.
const MIN_STATE: f32 = 64.0;

/// Text as typed over the saved text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    pub text: String,
    /// `None` for a field of something new.
    saved: Option<String>,
}

impl Entry {
    pub fn saved(text: String) -> Self {
        Self { saved: Some(text.clone()), text }
    }

    /// The field of something that is not saved.
    pub fn added(text: String) -> Self {
        Self { text, saved: None }
    }

    pub fn is_new(&self) -> bool {
        self.saved.is_none()
    }

    pub fn is_edited(&self) -> bool {
        self.was().is_some()
    }

    /// The saved text, if the typed one differs.
    pub fn was(&self) -> Option<&str> {
        self.saved.as_deref().filter(|saved| *saved != self.text)
    }

    /// The saved text; empty for a new field.
    pub fn before(&self) -> &str {
        self.saved.as_deref().unwrap_or_default()
    }
}

/// State of a field: it decides the border, and the mark and the colour of the words beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    Plain,
    Edited,
    /// Waits for the operator.
    Pending,
    /// Waits until the operator unlocks the service functions.
    NeedsUnlock,
    Sending,
    Good,
    Invalid,
    /// Invalid for the unit, or rejected by it.
    Refused,
    Unknown,
    Locked,
}

impl Mark {
    /// Icon and colour of the words.
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

    /// Colour of the border, where the field has one.
    pub fn border(self, t: &Tokens) -> Option<Color32> {
        let is_plain = matches!(self, Self::Plain | Self::Sending | Self::Unknown | Self::Locked);
        (!is_plain).then(|| self.look(t).1)
    }
}

/// State of a field with this problem, or else with an edit of the text that it `was`, in words.
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

/// Paints the state of a field in `room`. With a mark it is accessible by `name`.
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

/// A row with `content` beside a label of this width; returns what `content` returns and the place
/// of the whole row.
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

/// A row with a text of one line, which shows `hint` while it is empty. `widths` are those of the
/// label and, as far as there is room, of the field.
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

/// A note in the column of the fields.
pub fn note(ui: &mut Ui, words: &str, colour: Color32) {
    ui.horizontal_top(|ui| {
        ui.add_space(LABEL + GAP);
        let words = RichText::new(words).font(text::small()).color(colour);
        ui.add(Label::new(words).wrap());
    });
}
