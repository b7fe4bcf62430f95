//! The log as a table: only the rows in view are drawn.

use egui::{
    Event, EventFilter, Id, Key, Modifiers, Rect, Response, Role, ScrollArea, Sense, StrokeKind,
    Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::{ConsoleState, PADDING, row, selection::Way};
use crate::ui::{text, theme, widgets::paint};

const HEAD: f32 = 26.0;
const ROW: f32 = 25.0;

/// Scroll state of the table.
#[derive(Debug)]
pub(super) struct TableState {
    follows: bool,
    offset: f32,
    /// A row to scroll to.
    wanted: Option<usize>,
}

impl Default for TableState {
    fn default() -> Self {
        Self { follows: true, offset: 0.0, wanted: None }
    }
}

impl TableState {
    /// The table follows the newest line.
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
    let id = ui.make_persistent_id("log");
    let sense = Sense::CLICK | Sense::FOCUSABLE;
    let list = ui.interact(body, id, sense);
    list.widget_info(|| WidgetInfo::labeled(Role::ListBox, true, "Log of the links"));
    keys(ui, &list, body.height(), state);
    if state.log.shown().is_empty() {
        nothing(ui, body, state);
    }
    let rows = state.log.shown().len();
    let most = (rows as f32 * ROW - body.height()).max(0.0);
    let gone = state.log.take_gone() as f32 * ROW;
    let offset = if state.table.follows { most } else { (state.table.offset - gone).max(0.0) };
    let offset = state.table.wanted.take().map_or(offset, |row| {
        let top = row as f32 * ROW;
        offset.min(top).max(top + ROW - body.height())
    });
    ui.scope_builder(UiBuilder::new().id_salt("log rows").max_rect(body), |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        // A new line lies beyond the end of the last frame, from which the area would spring
        // back.
        ui.spacing_mut().scroll.kinetic.rubber_band = false;
        let area = ScrollArea::vertical().id_salt("log").auto_shrink(false);
        let area = area.vertical_scroll_offset(offset);
        let output = area.show_rows(ui, ROW, rows, |ui, range| {
            let top = ui.max_rect().top();
            for (place, index) in range.enumerate() {
                let min = pos2(body.left(), top + place as f32 * ROW);
                let place = Rect::from_min_size(min, vec2(body.width(), ROW));
                show_row(ui, id, place, (names_antenna, now), index, state);
            }
        });
        let offset = output.state.clamped_offset().y;
        state.table.offset = offset;
        state.table.follows = offset >= most - 0.5;
    });
    if list.has_focus() {
        ui.painter().rect_stroke(
            body.shrink(1.0),
            0.0,
            (2.0, theme::tokens(ui).sat),
            StrokeKind::Inside,
        );
    }
}

fn nothing(ui: &Ui, rect: Rect, state: &ConsoleState) {
    let words = if !state.filter.needle.is_empty() {
        "No line contains this text."
    } else if state.log.hidden_polls() > 0 {
        "Nothing but polls so far. Untick \"Hide polls\" to see them."
    } else {
        "Nothing has been sent or received yet."
    };
    let at = rect.left_top() + vec2(PADDING, 12.0);
    let t = theme::tokens(ui);
    let place = paint::paragraph(ui, at, rect.width() - 2.0 * PADDING, words, text::body(), t.t2);
    paint::name_text(ui, "no lines", place, words);
}

fn show_row(
    ui: &Ui,
    id: Id,
    rect: Rect,
    (names_antenna, now): (bool, Timestamp),
    index: usize,
    state: &mut ConsoleState,
) {
    let Some(line) = state.log.shown().get(index).and_then(|at| state.log.line(*at)) else {
        return;
    };
    let is_selected = state.selection.holds(line.position);
    // The whole list is one Tab stop.
    let response = ui.interact(rect, id.with(line.position), Sense::CLICK);
    response.widget_info(|| {
        WidgetInfo::selected(Role::ListBoxOption, true, is_selected, row::spoken(line, now))
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
    row::show(ui, rect, names_antenna, now, line, is_selected, response.hovered());
    if response.clicked() {
        let position = line.position;
        let way = way(ui.input(|input| input.modifiers));
        state.selection.choose(position, way, state.log.shown());
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}

fn way(modifiers: Modifiers) -> Way {
    match modifiers {
        Modifiers { shift: true, .. } => Way::Range,
        Modifiers { command: true, .. } => Way::Toggle,
        _ => Way::Alone,
    }
}

/// Handles the keys of the list while it has the focus.
fn keys(ui: &Ui, list: &Response, height: f32, state: &mut ConsoleState) {
    if list.clicked() {
        list.request_focus();
    }
    // Copies the selected lines unless a text has a selection of its own.
    let copies = |event: &Event| matches!(event, Event::Copy);
    if !ui.text_edit_focused() && ui.input(|input| input.events.iter().any(copies)) {
        state.copy(ui);
    }
    if !list.has_focus() {
        return;
    }
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(list.id, filter));
    let page = ((height / ROW) as isize - 1).max(1);
    let moves = [
        (Key::ArrowUp, -1),
        (Key::ArrowDown, 1),
        (Key::PageUp, -page),
        (Key::PageDown, page),
        (Key::Home, isize::MIN),
        (Key::End, isize::MAX),
    ];
    let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND, Key::A) {
        state.selection.choose_all(state.log.shown());
    }
    for (key, down) in moves {
        for (modifiers, way) in [(Modifiers::SHIFT, Way::Range), (Modifiers::NONE, Way::Alone)] {
            if pressed(modifiers, key) {
                let place = state.selection.go(down, way, state.log.shown());
                state.table.wanted = place.or(state.table.wanted);
            }
        }
    }
}
