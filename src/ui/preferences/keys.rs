//! The page of the keys: which key does what, and where.

use egui::{Align2, Rect, Sense, Ui, vec2};

use super::form;
use crate::ui::{
    icons::{self, Icon},
    keys::{ALL, Binding, KeyScope, list::in_words},
    text, theme,
    widgets::paint,
};

const ROW: f32 = 22.0;
/// Width of the column of the keys.
const KEYS: f32 = 148.0;

/// The cards, each with its title and its scopes.
const CARDS: [(&str, &[KeyScope]); 5] = [
    ("In every view", &[KeyScope::Everywhere, KeyScope::Views]),
    ("In the focused control", &[KeyScope::Focus]),
    ("In Operate", &[KeyScope::Operate]),
    ("In Map", &[KeyScope::Map]),
    ("In Elements and Preferences", &[KeyScope::Elements, KeyScope::Preferences]),
];

fn bindings(scopes: &'static [KeyScope]) -> impl Iterator<Item = &'static Binding> {
    // STOP is above every control.
    let place = |of: &Binding| if of.is_stop() { KeyScope::Everywhere } else { of.place };
    ALL.iter().filter(move |binding| scopes.contains(&place(binding)))
}

/// The numbers of rows in each card.
pub(super) fn rows() -> [usize; CARDS.len()] {
    CARDS.map(|(_, scopes)| bindings(scopes).count())
}

pub(super) fn card_of(ui: &mut Ui, card: usize) {
    let Some((title, scopes)) = CARDS.get(card) else { return };
    form::card(ui, title, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for binding in bindings(scopes) {
            row(ui, binding);
        }
    });
}

fn row(ui: &mut Ui, binding: &Binding) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.top(), (1.0, t.line));
    let words = in_words(binding);
    let place = rect.with_max_x(rect.left() + KEYS);
    let keys = paint::text_in(ui, place, Align2::LEFT_CENTER, &words, text::body_medium(), t.t1);
    if binding.is_stop() {
        let lock = paint::square(keys.right_center() + vec2(14.0, 0.0), 12.0);
        icons::paint(ui.painter(), lock, Icon::Lock, t.t3);
    }
    let does = Rect::from_min_max(place.right_top(), rect.max);
    paint::text_in(ui, does, Align2::LEFT_CENTER, binding.does, text::body(), t.t2);
    let said = format!("{words}: {}", binding.does);
    paint::name_text(ui, ("key", binding.does), rect, &said).on_hover_text(&said);
}
