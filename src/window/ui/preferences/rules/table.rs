//! The table of the rules in their order.

use egui::{
    Align2, EventFilter, Id, Key, Modifiers, Rect, Response, Role, ScrollArea, Sense, Stroke,
    StrokeKind, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use super::{
    RulesState, Shown,
    cannot_act::RuleContext,
    draft::RulesDraft,
    sentence::{then_in_short, when_in_short},
};
use crate::{
    model::Model,
    ui::{
        icons::{self, Icon},
        preferences::PADDING,
        text, theme,
        widgets::{list, paint},
        words,
    },
};

const HEAD: f32 = 24.0;
const ROW: f32 = 33.0;
const EMPTY: &str = "There are no rules: only priorities and limits decide.";
const SWITCH: [f32; 2] = [36.0, 20.0];

/// The columns of the table.
struct Columns {
    grip: Rect,
    number: Rect,
    switch: Rect,
    antenna: Rect,
    when: Rect,
    action: Rect,
    last: Rect,
}

impl Columns {
    fn new(row: Rect) -> Self {
        let inner = row.with_min_x(row.left() + PADDING).with_max_x(row.right() - PADDING);
        let (left, width) = (inner.left(), inner.width());
        let columns = |left: f32, right: f32| inner.with_min_x(left).with_max_x(right - 8.0);
        let antenna = left + 92.0;
        let rest = antenna + (width * 0.09).max(92.0);
        let share = (inner.right() - rest) / 10.0;
        let switch = pos2(left + 66.0, row.center().y);
        Self {
            grip: columns(left - 6.0, left + 22.0),
            number: columns(left + 16.0, left + 44.0),
            switch: Rect::from_center_size(switch, SWITCH.into()),
            antenna: columns(antenna, rest),
            when: columns(rest, rest + 3.4 * share),
            action: columns(rest + 3.4 * share, rest + 6.2 * share),
            last: inner.with_min_x(rest + 6.2 * share),
        }
    }
}

pub(super) fn height(rules: usize) -> f32 {
    HEAD + ROW * rules.max(1) as f32
}

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    rules: &mut RulesDraft,
    context: &RuleContext<'_>,
    state: &mut RulesState,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + HEAD);
    let columns = Columns::new(head);
    let left = Align2::LEFT_CENTER;
    for (place, anchor, words) in [
        (columns.number, Align2::RIGHT_CENTER, "#"),
        (columns.switch, left, "On"),
        (columns.antenna, left, "Antenna"),
        (columns.when, left, "When"),
        (columns.action, left, "Then"),
        (columns.last, Align2::RIGHT_CENTER, "Next 48 h"),
    ] {
        paint::text_in(ui, place, anchor, words, text::caption(), t.t3);
    }
    if rules.all().is_empty() {
        let room = body.shrink2(vec2(PADDING, 0.0));
        paint::text_in(ui, room, left, EMPTY, text::body(), t.t2);
        paint::name_text(ui, "no rules", room, EMPTY);
        return;
    }
    let builder = UiBuilder::new().id_salt("rules").max_rect(body);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(body.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let size = vec2(ui.available_width(), ROW * rules.all().len() as f32);
            let (all, _) = ui.allocate_exact_size(size, Sense::hover());
            for index in 0..rules.all().len() {
                let Some(shown) = Shown::new(index, rules, context, model) else { continue };
                let top = all.top() + ROW * index as f32;
                let row = all.with_min_y(top).with_max_y(top + ROW);
                draw(ui, row, model, &shown, rules, context, state);
            }
            drag(ui, all, rules, state);
            ring(ui, all, rules.all().len());
        });
    });
}

fn id_of(ui: &Ui, index: usize) -> Id {
    ui.make_persistent_id(("rule", index))
}

fn draw(
    ui: &Ui,
    row: Rect,
    model: &Model,
    shown: &Shown,
    rules: &mut RulesDraft,
    context: &RuleContext<'_>,
    state: &mut RulesState,
) {
    let t = theme::tokens(ui);
    let response = choice(ui, row, shown, state);
    let columns = Columns::new(row);
    let index = shown.index;
    let Some(rule) = rules.get_mut(index) else { return };
    let is_idle = !rule.is_on || rule.is_removed;
    let ink = if is_idle { t.t3 } else { t.t1 };
    let left = Align2::LEFT_CENTER;
    let number = shown.number.map_or_else(|| "–".to_owned(), |number| number.to_string());
    paint::text_in(ui, columns.number, Align2::RIGHT_CENTER, &number, text::small(), t.t2);
    let antenna = rule.antenna.map_or("all", |id| context.antenna(id).unwrap_or("removed"));
    paint::text_in(ui, columns.antenna, left, antenna, text::body_medium(), ink);
    let when = when_in_short(rule, context, &|number| words::satellite(model, number));
    paint::text_in(ui, columns.when, left, &when, text::body(), ink);
    paint::text_in(ui, columns.action, left, then_in_short(rule), text::body(), ink);
    last(ui, columns.last, shown, is_idle, rule.is_removed, state);
    if rule.is_removed {
        ui.painter().hline(columns.when.x_range(), row.center().y, (1.0, t.t3));
    } else {
        switch(ui, columns.switch, &number, &mut rule.is_on, index);
    }
    grip(ui, columns.grip, index, state);
    keys(ui, &response, index, rules, state);
}

/// Paints the focus ring of a row above the backgrounds of its neighbours.
fn ring(ui: &Ui, all: Rect, rules: usize) {
    let focused = (0..rules).find(|index| ui.memory(|memory| memory.has_focus(id_of(ui, *index))));
    let Some(index) = focused else { return };
    let top = all.top() + ROW * index as f32;
    let row = all.with_min_y(top).with_max_y(top + ROW);
    let stroke = Stroke::new(2.0, theme::tokens(ui).sat);
    ui.painter().rect_stroke(row.shrink(1.0), 0.0, stroke, StrokeKind::Inside);
}

/// Draws the row as a control that chooses the rule.
fn choice(ui: &Ui, row: Rect, shown: &Shown, state: &mut RulesState) -> Response {
    let t = theme::tokens(ui);
    let is_chosen = state.chosen == shown.index;
    let name = match (&shown.number, &shown.hindrance) {
        (None, _) => format!("Removed when you save: {}", shown.sentence),
        (Some(number), None) => format!("Rule {number}: {}", shown.sentence),
        (Some(number), Some((_, reason))) => {
            format!("Rule {number}: {} It cannot act: {reason}.", shown.sentence)
        }
    };
    let response = ui.interact(row, id_of(ui, shown.index), Sense::click());
    let role = Role::RadioButton;
    response.widget_info(|| WidgetInfo::selected(role, true, is_chosen, &name));
    let ground = match &shown.hindrance {
        Some((reason, _)) if reason.is_wrong() => Some(t.badbg),
        Some(_) => Some(t.warnbg),
        None if is_chosen => Some(t.bgsel),
        None => response.hovered().then_some(t.bg3),
    };
    if let Some(ground) = ground {
        ui.painter().rect_filled(row, 0.0, ground);
    }
    if is_chosen {
        list::paint_stripe(ui, row);
    }
    list::paint_divider(ui, row);
    if state.wants_focus.take_if(|requested| *requested == shown.index).is_some() {
        response.request_focus();
    }
    if response.gained_focus() && !ui.input(|input| input.pointer.any_down()) {
        response.scroll_to_me(None);
    }
    if response.clicked() {
        state.chosen = shown.index;
        response.request_focus();
    }
    response
}

/// Draws the number of passes that the rule decides in the next 48 h, or the reason why it decides
/// none.
fn last(ui: &Ui, place: Rect, shown: &Shown, is_idle: bool, is_removed: bool, state: &RulesState) {
    let t = theme::tokens(ui);
    let (words, ink) = match (&shown.hindrance, shown.decided(state)) {
        _ if is_removed => ("removed when you save".to_owned(), t.t3),
        (Some((reason, words)), _) => {
            (words.clone(), if reason.is_wrong() { t.bad } else { t.warn })
        }
        _ if is_idle => ("off".to_owned(), t.t3),
        (None, None) => ("–".to_owned(), t.t3),
        (None, Some([])) => ("no pass".to_owned(), t.t2),
        (None, Some([_])) => ("1 pass".to_owned(), t.t2),
        (None, Some(passes)) => (format!("{} passes", passes.len()), t.t2),
    };
    let room = place.with_min_x(place.left() + 18.0);
    let label = paint::text_in(ui, room, Align2::RIGHT_CENTER, &words, text::small(), ink);
    if shown.hindrance.is_some() && !is_removed {
        let rect = paint::square(pos2(label.left() - 10.0, place.center().y), 12.0);
        icons::paint(ui.painter(), rect, Icon::Warning, ink);
    }
    let name = format!("Next 48 h: {words}");
    let named = paint::name_text(ui, ("decides", shown.index), place, &name);
    if !paint::fits(ui, &words, text::small(), room) {
        named.on_hover_text(&words);
    }
}

fn switch(ui: &Ui, rect: Rect, number: &str, is_on: &mut bool, index: usize) {
    let t = theme::tokens(ui);
    let name = format!("Rule {number} is on");
    let response = paint::control(ui, ("switch", index), rect, Role::Switch, true, &name);
    response.widget_info(|| WidgetInfo::selected(Role::Switch, true, *is_on, &name));
    if response.clicked() {
        *is_on = !*is_on;
    }
    let (fill, line) = if *is_on { (t.okbg, t.ok) } else { (t.bg0, t.edge) };
    let x = if *is_on { rect.right() - 10.0 } else { rect.left() + 10.0 };
    ui.painter().rect_filled(rect, rect.height() / 2.0, fill);
    let stroke = Stroke::new(1.0, line);
    ui.painter().rect_stroke(rect, rect.height() / 2.0, stroke, StrokeKind::Inside);
    ui.painter().circle_filled(pos2(x, rect.center().y), 7.0, line);
    paint::focus_ring(ui, &response, 10);
}

/// Draws the grip with which the operator drags a row to another place.
fn grip(ui: &Ui, rect: Rect, index: usize, state: &mut RulesState) {
    let t = theme::tokens(ui);
    // The grip is only for the pointer. Tab skips it; Alt with an arrow key moves the focused row.
    let response = ui.interact(rect, ui.make_persistent_id(("grip", index)), Sense::DRAG);
    let name = format!("Drag rule {} to another place", index + 1);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let ink = if response.hovered() || state.dragged == Some(index) { t.t1 } else { t.t3 };
    for x in [-3.0, 3.0] {
        for y in [-5.0, 0.0, 5.0] {
            let position = pos2(rect.left() + 8.0 + x, rect.center().y + y);
            ui.painter().circle_filled(position, 1.2, ink);
        }
    }
    if response.drag_started() {
        state.dragged = Some(index);
        state.chosen = index;
    }
}

/// Moves the dragged rule along with the pointer.
fn drag(ui: &Ui, all: Rect, rules: &mut RulesDraft, state: &mut RulesState) {
    let Some(start) = state.dragged else { return };
    let pointer = ui.input(|input| input.pointer.latest_pos().filter(|_| input.pointer.any_down()));
    let Some(pointer) = pointer else {
        state.dragged = None;
        return;
    };
    let last = rules.all().len().saturating_sub(1);
    let end = (((pointer.y - all.top()) / ROW).max(0.0) as usize).min(last);
    if end != start {
        rules.reorder(start, end);
        state.dragged = Some(end);
        state.chosen = end;
    }
}

/// Handles the keys of the focused row: arrows choose a rule, Alt with arrows moves it.
fn keys(
    ui: &Ui,
    response: &Response,
    index: usize,
    rules: &mut RulesDraft,
    state: &mut RulesState,
) {
    if !response.has_focus() {
        return;
    }
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let last = rules.all().len().saturating_sub(1);
    for (key, end) in
        [(Key::ArrowUp, index.saturating_sub(1)), (Key::ArrowDown, (index + 1).min(last))]
    {
        let moves = ui.input_mut(|input| input.consume_key(Modifiers::ALT, key));
        if moves {
            rules.reorder(index, end);
        }
        if moves || ui.input_mut(|input| input.consume_key(Modifiers::NONE, key)) {
            state.choose(end);
        }
    }
    if ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Delete))
        && let Some(rule) = rules.get_mut(index)
    {
        rule.is_removed = !rule.is_removed;
    }
}
