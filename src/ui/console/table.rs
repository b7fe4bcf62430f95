//! The log as a table: only the rows in view are drawn.

use egui::{
    Align2, Color32, Event, EventFilter, Id, Key, Modifiers, Rect, Response, Role, ScrollArea,
    Sense, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use super::{ConsoleState, PADDING, line::Line, raw, selection::Way};
use crate::{
    controller::{Direction, Finding},
    protocol::satrak::Tone,
    ui::{
        icons::{self, Icon},
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

const HEAD: f32 = 26.0;
const ROW: f32 = 25.0;
const TIME: f32 = 104.0;
const ANTENNA: f32 = 92.0;
const ARROW: f32 = 24.0;
const ROUND_TRIP: f32 = 64.0;
const GAP: f32 = 8.0;
/// Part of the rest for the bytes; the meaning has the other.
const RAW_PART: f32 = 0.56;

/// Where the table stands.
#[derive(Debug)]
pub(super) struct TableState {
    follows: bool,
    offset: f32,
    /// The offset at which the newest line was in view.
    most: f32,
    /// A row to bring into view.
    wanted: Option<usize>,
}

impl Default for TableState {
    fn default() -> Self {
        Self { follows: true, offset: 0.0, most: 0.0, wanted: None }
    }
}

impl TableState {
    /// The newest line is in view, and stays so.
    pub(super) fn follows(&self) -> bool {
        self.follows
    }

    /// From now on the newest line is in view.
    pub(super) fn follow(&mut self) {
        self.follows = true;
    }
}

/// The columns of a row.
struct Columns {
    time: Rect,
    antenna: Option<Rect>,
    arrow: Rect,
    raw: Rect,
    meaning: Rect,
    round_trip: Rect,
}

impl Columns {
    fn of(row: Rect, names_antenna: bool) -> Self {
        let mut left = row.left() + PADDING;
        let mut take = |width: f32| {
            let column = row.with_min_x(left).with_max_x(left + width);
            left += width;
            column
        };
        let time = take(TIME);
        let antenna = names_antenna.then(|| take(ANTENNA - GAP));
        take(if names_antenna { GAP } else { 0.0 });
        let arrow = take(ARROW);
        let rest = row.right() - PADDING - ROUND_TRIP - arrow.right();
        let raw = take(rest * RAW_PART - GAP);
        take(GAP);
        let meaning = take(rest * (1.0 - RAW_PART));
        let round_trip = take(ROUND_TRIP);
        Self { time, antenna, arrow, raw, meaning, round_trip }
    }
}

/// Draws the head and the rows.
pub(super) fn show(ui: &mut Ui, rect: Rect, names_antenna: bool, state: &mut ConsoleState) {
    let (top, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    head(ui, top, names_antenna);
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
        let area = ScrollArea::vertical().id_salt("log").auto_shrink(false);
        let area = area.vertical_scroll_offset(offset);
        let output = area.show_rows(ui, ROW, rows, |ui, range| {
            let top = ui.max_rect().top();
            for (place, index) in range.enumerate() {
                let min = pos2(body.left(), top + place as f32 * ROW);
                let row = Rect::from_min_size(min, vec2(body.width(), ROW));
                show_row(ui, id, row, names_antenna, index, state);
            }
        });
        let offset = output.state.clamped_offset().y;
        state.table.offset = offset;
        // While lines are added the area springs back to its former end.
        state.table.follows = offset >= most.min(state.table.most) - 0.5;
        state.table.most = most;
    });
    if list.has_focus() {
        ui.painter().rect_stroke(
            body.shrink(1.0),
            0.0,
            (2.0, theme::tokens(ui).sat),
            egui::StrokeKind::Inside,
        );
    }
}

fn head(ui: &Ui, rect: Rect, names_antenna: bool) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg2);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let columns = Columns::of(rect, names_antenna);
    let word = |place: Rect, anchor, word: &str| {
        paint::text_in(ui, place, anchor, word, text::caption(), t.t3);
    };
    word(columns.time, Align2::LEFT_CENTER, "Time UTC");
    if let Some(antenna) = columns.antenna {
        word(antenna, Align2::LEFT_CENTER, "Antenna");
    }
    word(columns.raw, Align2::LEFT_CENTER, "Raw");
    word(columns.meaning, Align2::LEFT_CENTER, "Decoded");
    word(columns.round_trip, Align2::RIGHT_CENTER, "Reply after");
}

fn nothing(ui: &Ui, rect: Rect, state: &ConsoleState) {
    let words = if !state.filter.needle.is_empty() {
        "No line has this text."
    } else if state.log.hidden_polls() > 0 {
        "Nothing but polls so far. Untick \"Hide polls\" to see them."
    } else {
        "Nothing has gone over a link yet."
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
    names_antenna: bool,
    index: usize,
    state: &mut ConsoleState,
) {
    let Some(line) = state.log.shown().get(index).and_then(|at| state.log.line(*at)) else {
        return;
    };
    let is_selected = state.selection.holds(line.position);
    // The whole list is one stop of the Tab key.
    let response = ui.interact(rect, id.with(line.position), Sense::CLICK);
    response
        .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_selected, spoken(line)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
    paint_row(ui, rect, names_antenna, line, is_selected, response.hovered());
    if response.clicked() {
        let position = line.position;
        let way = way(ui.input(|input| input.modifiers));
        state.selection.choose(position, way, state.log.shown());
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}

fn spoken(line: &Line) -> String {
    let raw = line.raw.trim_end_matches("<CR><LF>");
    let went = match line.direction() {
        "" => String::new(),
        direction => format!(" {direction} {raw}"),
    };
    format!("{} {}{went}: {}", line.time(), line.antenna, line.meaning.text)
}

fn way(modifiers: Modifiers) -> Way {
    match modifiers {
        Modifiers { shift: true, .. } => Way::Range,
        Modifiers { command: true, .. } => Way::Toggle,
        _ => Way::Alone,
    }
}

fn paint_row(
    ui: &Ui,
    rect: Rect,
    names_antenna: bool,
    line: &Line,
    is_selected: bool,
    is_hovered: bool,
) {
    let t = theme::tokens(ui);
    let ground = match line.meaning.tone {
        _ if is_selected => t.bgsel,
        Tone::Bad => t.badbg,
        Tone::Caution => t.warnbg,
        _ if is_hovered => t.bg3,
        _ => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, 0.0, ground);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    if is_selected {
        ui.painter().rect_filled(rect.with_max_x(rect.left() + 3.0), 0.0, t.sat);
    }
    let columns = Columns::of(rect, names_antenna);
    let left = Align2::LEFT_CENTER;
    paint::text_in(ui, columns.time, left, &line.time(), text::raw(), t.t2);
    if let Some(place) = columns.antenna {
        paint::text_in(ui, place, left, &line.antenna, text::small_strong(), t.t1);
    }
    let (mark, colour) = match (line.wire().finding, line.wire().direction) {
        (Finding::NoReply { .. }, _) => (Icon::Warning, t.warn),
        (_, Direction::Sent) => (Icon::ChevronRight, t.sat),
        (_, Direction::Received) => (Icon::ChevronLeft, t.t1),
    };
    let at = pos2(columns.arrow.left() + 6.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(at, 12.0), mark, colour);
    let colour = if line.wire().direction == Direction::Sent { t.sat } else { t.t1 };
    raw::show(ui, columns.raw, &line.wire().bytes, colour);
    let mut place = columns.meaning;
    if let Some((icon, colour)) = mark_of(line.meaning.tone, t) {
        let at = pos2(place.left() + 6.0, rect.center().y);
        icons::paint(ui.painter(), paint::square(at, 12.0), icon, colour);
        place = place.with_min_x(place.left() + 18.0);
    }
    paint::text_in(ui, place, left, &line.meaning.text, text::small(), t.t1);
    if let Some(after) = line.round_trip() {
        paint::text_in(ui, columns.round_trip, Align2::RIGHT_CENTER, &after, text::small(), t.t2);
    }
}

fn mark_of(tone: Tone, t: &Tokens) -> Option<(Icon, Color32)> {
    match tone {
        Tone::Plain => None,
        Tone::Change => Some((Icon::Sliders, t.cmd)),
        Tone::Good => Some((Icon::Check, t.ok)),
        Tone::Caution => Some((Icon::Warning, t.warn)),
        Tone::Bad => Some((Icon::Cross, t.bad)),
    }
}

/// The keys of the list while it has the focus.
fn keys(ui: &Ui, list: &Response, height: f32, state: &mut ConsoleState) {
    if list.clicked() {
        list.request_focus();
    }
    // What is selected can be copied unless a text has its own selection.
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
