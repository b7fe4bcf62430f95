//! Log as a table that draws only the rows in view.

use egui::{Event, Key, Modifiers, Rect, Ui};
use jiff::Timestamp;

use super::{ConsoleState, row};
use crate::ui::{
    theme,
    widgets::list::{List, Scroll},
};

const HEAD: f32 = 26.0;
const ROW: f32 = 25.0;

/// Scroll state of the table.
#[derive(Debug)]
pub(super) struct TableState {
    follows: bool,
    scroll: Scroll,
}

impl Default for TableState {
    fn default() -> Self {
        Self { follows: true, scroll: Scroll::default() }
    }
}

impl TableState {
    /// Returns `true` while the table follows the newest line.
    pub(super) fn follows(&self) -> bool {
        self.follows
    }

    /// Makes the table follow the newest line.
    pub(super) fn follow(&mut self) {
        self.follows = true;
    }
}

/// Draws the head and the rows.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    names_antenna: bool,
    now: Timestamp,
    state: &mut ConsoleState,
) {
    let (top, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    row::head(ui, top, names_antenna);
    ui.painter().rect_filled(body, 0.0, theme::tokens(ui).field);
    let list = List::new(ui, body, "log", "Log of the links", ROW);
    keys(ui, &list, state);
    let rows = state.log.shown().len();
    let scrolled = state.log.take_gone() as f32 * ROW;
    if rows == 0 {
        return list.show_empty(ui, "no lines", why_empty(state));
    }
    let end = (rows as f32 * ROW - body.height()).max(0.0);
    let mut scroll = state.table.scroll;
    scroll.set(if state.table.follows { end } else { scroll.offset - scrolled });
    list.show_rows(ui, rows, &mut scroll, |ui, place, index| {
        show_row(ui, &list, place, (names_antenna, now), index, state);
    });
    state.table.follows = scroll.offset >= end - 0.5;
    state.table.scroll = scroll;
}

fn why_empty(state: &ConsoleState) -> &'static str {
    if !state.filter.needle.is_empty() {
        "No line contains this text."
    } else if state.log.hidden_polls() > 0 {
        "Nothing but polls so far. Untick \"Hide polls\" to see them."
    } else {
        "Nothing has been sent or received yet."
    }
}

fn show_row(
    ui: &Ui,
    list: &List,
    rect: Rect,
    (names_antenna, now): (bool, Timestamp),
    index: usize,
    state: &mut ConsoleState,
) {
    let Some(line) = state.log.shown().get(index).and_then(|number| state.log.line(*number)) else {
        return;
    };
    let position = line.position;
    let is_selected = state.selection.is_marked(position);
    let spoken = || row::spoken(line, now);
    let response = list.option(ui, rect, position, is_selected, row::tint(ui, line), spoken);
    row::show(ui, rect, names_antenna, now, line);
    if response.clicked() {
        let choice = ui.input(|input| input.modifiers).into();
        state.selection.choose(position, choice, state.log.shown());
    }
}

/// Handles the keys of the list while it has the focus.
fn keys(ui: &Ui, list: &List, state: &mut ConsoleState) {
    // Copy the selected lines, unless a text field has the focus and copies its own text.
    let copies = |event: &Event| matches!(event, Event::Copy);
    if !ui.text_edit_focused() && ui.input(|input| input.events.iter().any(copies)) {
        state.copy(ui);
    }
    if !list.response.has_focus() {
        return;
    }
    if ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::A)) {
        state.selection.mark_all(state.log.shown());
    }
    let shown = state.log.shown();
    if let Some(place) = list.step(ui).and_then(|step| state.selection.go(step, shown)) {
        state.table.scroll.bring_into_view(place);
    }
}
