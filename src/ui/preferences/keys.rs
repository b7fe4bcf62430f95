//! The page of the keys: which key does what, and where, and the choice of other keys. A choice
//! is used at once and belongs to this window.

use egui::{Align2, Color32, Event, Key, Rect, Role, Sense, Stroke, StrokeKind, Ui, vec2};

use super::form;
use crate::ui::{
    icons::{self, Icon},
    keys::{
        ALL, Binding, KeyScope,
        list::{in_words, word},
        own::{Clash, OwnKeys, Slot},
    },
    text, theme,
    widgets::paint,
};

const ROW: f32 = 22.0;
/// Width of the column of the keys.
const KEYS: f32 = 160.0;
const GAP: f32 = 4.0;
/// What a key says that waits for another one.
const WAITING: &str = "Press a key";

/// The cards, each with its title and its scopes.
const CARDS: [(&str, &[KeyScope]); 8] = [
    ("In every view", &[KeyScope::Everywhere, KeyScope::Views]),
    ("In the focused control", &[KeyScope::Focus]),
    ("In Operate", &[KeyScope::Operate]),
    ("In Plan", &[KeyScope::Plan]),
    ("In Record", &[KeyScope::Record]),
    ("In Map", &[KeyScope::Map]),
    ("In a replay", &[KeyScope::Replay]),
    ("In Elements and Preferences", &[KeyScope::Elements, KeyScope::Preferences]),
];

/// The chosen keys, and the choice under way.
#[derive(Default)]
pub(super) struct KeysState {
    pub(super) own: OwnKeys,
    /// The key for which another one is to be pressed.
    waiting: Option<Slot>,
    refused: Option<(Slot, Refusal)>,
}

/// Why a pressed key was not taken.
#[derive(Clone, Copy)]
enum Refusal {
    /// It was pressed with Ctrl, Shift or Alt.
    Modified,
    Clash(Key, Clash),
}

impl KeysState {
    pub(super) fn waits(&self) -> bool {
        self.waiting.is_some()
    }

    /// Waits for no key any more. To be called wherever the page is not shown: a key pressed
    /// there belongs to what is.
    pub(super) fn stop_waiting(&mut self) {
        self.waiting = None;
    }

    /// Takes the key that is pressed in this frame, if one is waited for. Esc is STOP, also here.
    pub(super) fn listen(&mut self, ui: &Ui) {
        let Some(slot) = self.waiting else { return };
        let pressed = ui.input_mut(|input| {
            let pressed = input.events.iter().find_map(|event| match event {
                Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
                    Some((*key, modifiers.is_none()))
                }
                _ => None,
            });
            if pressed.is_some() {
                let is_of_keys =
                    |event: &Event| matches!(event, Event::Key { .. } | Event::Text(_));
                input.events.retain(|event| !is_of_keys(event));
            }
            pressed
        });
        let Some((key, is_plain)) = pressed else { return };
        self.waiting = None;
        self.refused = match (key, is_plain) {
            (Key::Escape, _) => None,
            (_, false) => Some((slot, Refusal::Modified)),
            (_, true) => {
                let clash = self.own.choose(slot, key).err();
                clash.map(|clash| (slot, Refusal::Clash(key, clash)))
            }
        };
    }
}

fn bindings(scopes: &'static [KeyScope]) -> impl Iterator<Item = &'static Binding> {
    // STOP is above every control.
    let place = |of: &Binding| if of.is_stop() { KeyScope::Everywhere } else { of.place };
    ALL.iter().filter(move |binding| scopes.contains(&place(binding)))
}

/// The numbers of rows in each card.
pub(super) fn rows() -> [usize; CARDS.len()] {
    CARDS.map(|(_, scopes)| bindings(scopes).count())
}

pub(super) fn card_of(ui: &mut Ui, card: usize, state: &mut KeysState) {
    let Some((title, scopes)) = CARDS.get(card) else { return };
    form::card(ui, title, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for binding in bindings(scopes) {
            row(ui, binding, state);
        }
        if card == 0 && state.own != OwnKeys::default() {
            ui.add_space(8.0);
            if ui.button("Restore default keys").clicked() {
                *state = KeysState::default();
            }
        }
    });
}

fn row(ui: &mut Ui, binding: &Binding, state: &mut KeysState) {
    let t = theme::tokens(ui);
    let slots: Vec<Slot> = binding.slots().collect();
    let keys: Vec<(Key, Option<Slot>)> = binding.with_slots().collect();
    let words = in_words(binding, &state.own);
    let refused = state.refused.filter(|(slot, ..)| slots.contains(slot));
    let (said, colour) = match refused {
        Some((_, refusal)) => (refusal_in_words(refusal), t.bad),
        None => (binding.does.to_owned(), t.t2),
    };
    let width = ui.available_width();
    let boxes: f32 =
        keys.iter().map(|(usual, slot)| key_width(ui, on_key(*usual, *slot, state)) + GAP).sum();
    let column = if slots.is_empty() { KEYS } else { KEYS.max(boxes + GAP) };
    let does = ui.painter().layout(said.clone(), text::body(), colour, width - column);
    let height = ROW.max(does.size().y + 4.0);
    let (rect, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.top(), (1.0, t.line));
    let place = rect.with_max_x(rect.left() + KEYS);
    if slots.is_empty() {
        let keys =
            paint::text_in(ui, place, Align2::LEFT_CENTER, &words, text::body_medium(), t.t1);
        if binding.is_stop() {
            let lock = paint::square(keys.right_center() + vec2(14.0, 0.0), 12.0);
            icons::paint(ui.painter(), lock, Icon::Lock, t.t3);
        }
    }
    let mut at = place.left_center();
    for (usual, slot) in keys.into_iter().filter(|_| !slots.is_empty()) {
        let right = match slot {
            Some(slot) => key(ui, at, slot, binding.does, state),
            None => fixed_key(ui, at, usual),
        };
        at.x = right + GAP;
    }
    let room = rect.with_min_x(rect.left() + column);
    let at = Align2::LEFT_CENTER.align_size_within_rect(does.size(), room);
    ui.painter().galley(at.min, does, colour);
    let spoken = format!("{words}: {said}");
    paint::name_text(ui, ("key", binding.does), room, &spoken);
}

fn refusal_in_words(refusal: Refusal) -> String {
    match refusal {
        Refusal::Modified => "Press one key alone, without Ctrl, Shift or Alt.".to_owned(),
        Refusal::Clash(key, Clash::NoShortcut) => {
            format!("{} cannot be used here: choose a letter, a digit or F5 to F12.", word(key))
        }
        Refusal::Clash(key, Clash::Taken(by)) => {
            format!("{} is taken: {}.", word(key), by.does_where())
        }
    }
}

/// The words on a key.
fn on_key(usual: Key, slot: Option<Slot>, state: &KeysState) -> &'static str {
    let Some(slot) = slot else { return word(usual) };
    if state.waiting == Some(slot) { WAITING } else { word(state.own.of_slot(slot)) }
}

fn key_width(ui: &Ui, words: &str) -> f32 {
    (paint::text_width(ui, words, text::body_medium()) + 12.0).max(ROW)
}

/// A key that cannot be changed, without a box; returns its right end.
fn fixed_key(ui: &Ui, left: egui::Pos2, usual: Key) -> f32 {
    let t = theme::tokens(ui);
    let size = vec2(key_width(ui, word(usual)), 18.0);
    let rect = Rect::from_min_size(left - vec2(0.0, 9.0), size);
    let font = text::body_medium();
    paint::text_in(ui, rect, Align2::CENTER_CENTER, word(usual), font, t.t1);
    rect.right()
}

/// A key that can be changed; returns its right end.
fn key(ui: &Ui, left: egui::Pos2, slot: Slot, does: &str, state: &mut KeysState) -> f32 {
    let t = theme::tokens(ui);
    let waits = state.waiting == Some(slot);
    let now = word(state.own.of_slot(slot));
    let words = if waits { WAITING } else { now };
    let width = key_width(ui, words);
    let rect = Rect::from_min_size(left - vec2(0.0, 9.0), vec2(width, 18.0));
    let name = if waits {
        format!("{WAITING} in place of {now}")
    } else {
        format!("Change {now}: {does}")
    };
    let response = paint::control(ui, ("change key", does, now), rect, Role::Button, true, &name);
    let (fill, border, ink) = match (waits, state.own.is_own(slot)) {
        (true, _) => (t.sat, t.sat, t.onsat),
        (false, true) => (Color32::TRANSPARENT, t.sat, t.t1),
        (false, false) => (Color32::TRANSPARENT, t.edge, t.t1),
    };
    ui.painter().rect(rect, 3, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    paint::text_in(ui, rect, Align2::CENTER_CENTER, words, text::body_medium(), ink);
    paint::focus_ring(ui, &response, 3);
    if response.on_hover_text(&name).clicked() {
        state.waiting = (!waits).then_some(slot);
        state.refused = None;
    }
    rect.right()
}
