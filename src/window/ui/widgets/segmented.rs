//! A choice among a few segments side by side. Tab reaches one of them, and arrow keys choose
//! another, as in a group of radio buttons. If a choice is a command, arrow keys only move the
//! focus.

use egui::{
    Align2, CornerRadius, FocusDirection, Id, Key, Modifiers, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, UiBuilder, WidgetInfo, accesskit::Action, pos2, vec2,
};

use super::{button::RADIUS, paint};
use crate::ui::{text, theme};

/// State of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Segment {
    /// A segment that the operator can choose.
    #[default]
    Free,
    /// The segment in force.
    Chosen,
    /// A segment in force that this console did not command, drawn dashed.
    Foreign,
    /// A requested segment without confirmation yet.
    Pending,
    /// A locked segment. A tooltip gives the reason, unless it stands next to the segment.
    Locked(Option<&'static str>),
}

impl Segment {
    fn is_locked(self) -> bool {
        matches!(self, Self::Locked(_))
    }
}

/// Effect of an arrow key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Arrows {
    /// Choice of the segment that the arrow reaches.
    Choose,
    /// Move of the focus; Enter or Space then chooses.
    Focus,
}

/// Shows segments in `rect`, each as wide as its text needs, and shares the remaining width evenly.
/// Returns the index of a segment chosen by click or arrow key.
pub fn show(
    ui: &Ui,
    salt: &str,
    rect: Rect,
    name: &str,
    segments: &[(&str, Segment)],
) -> Option<usize> {
    show_with(ui, salt, rect, name, segments, Arrows::Choose)
}

/// Shows a segment for each of these values; `value` is the chosen one. Returns `true` if the
/// operator chose a segment by click or arrow key.
pub fn choose<T: Copy + PartialEq>(
    ui: &Ui,
    salt: &str,
    rect: Rect,
    name: &str,
    choices: &[(&str, T)],
    value: &mut T,
) -> bool {
    let state = |choice: T| if choice == *value { Segment::Chosen } else { Segment::Free };
    let segments: Vec<(&str, Segment)> =
        choices.iter().map(|(word, choice)| (*word, state(*choice))).collect();
    let chosen = show(ui, salt, rect, name, &segments).and_then(|index| choices.get(index));
    if let Some((_, choice)) = chosen {
        *value = *choice;
    }
    chosen.is_some()
}

/// Shows segments like [`show`] for choices that act immediately and may move an antenna. An arrow
/// key that passes over a segment must not command it.
pub fn show_commands(
    ui: &Ui,
    salt: &str,
    rect: Rect,
    name: &str,
    segments: &[(&str, Segment)],
) -> Option<usize> {
    show_with(ui, salt, rect, name, segments, Arrows::Focus)
}

fn show_with(
    ui: &Ui,
    salt: &str,
    rect: Rect,
    name: &str,
    segments: &[(&str, Segment)],
    arrows: Arrows,
) -> Option<usize> {
    let t = theme::tokens(ui);
    let group = ui.interact(rect, ui.make_persistent_id(salt), egui::Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(Role::RadioGroup, true, name));
    let cells = inner_ui(ui, &group);
    ui.painter().rect_filled(rect, RADIUS, t.bg2);
    let widths: Vec<f32> =
        segments.iter().map(|(word, _)| paint::text_width(ui, word, text::body_medium())).collect();
    let spare = (rect.width() - widths.iter().sum::<f32>()) / segments.len().max(1) as f32;
    let ids: Vec<Id> =
        segments.iter().map(|(word, _)| ui.make_persistent_id((salt, *word))).collect();
    let stop = tab_stop(ui, &ids, segments);
    let mut x = rect.left();
    let (mut clicked, mut focused) = (None, None);
    let mut over_border = Vec::new();
    for (index, (((word, state), width), id)) in segments.iter().zip(widths).zip(&ids).enumerate() {
        let right = (x + width + spare).min(rect.right());
        let cell = Rect::from_min_max(pos2(x, rect.top()), pos2(right, rect.bottom()));
        let is_free = !state.is_locked();
        let sense = match is_free {
            true if stop == Some(index) => Sense::click(),
            true => Sense::CLICK,
            false => Sense::hover(),
        };
        let response = cells.interact(cell, *id, sense);
        let chosen = matches!(state, Segment::Chosen | Segment::Foreign);
        let is_foreign = *state == Segment::Foreign;
        let spoken =
            if is_foreign { format!("{word}, not by this console") } else { (*word).to_owned() };
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, is_free, chosen, &spoken));
        let radius = corners(index, segments.len());
        let colour = match state {
            Segment::Chosen => {
                ui.painter().rect_filled(cell, radius, t.sat);
                t.onsat
            }
            Segment::Locked(_) => t.t3,
            _ if response.hovered() => {
                ui.painter().rect_filled(cell, radius, t.bg3);
                t.t1
            }
            _ => t.t1,
        };
        if index > 0 {
            ui.painter().vline(cell.left(), cell.y_range().shrink(1.0), (1.0, t.line));
        }
        let room = cell.shrink2(vec2(1.0, 0.0));
        paint::text_in(ui, room, Align2::CENTER_CENTER, word, text::body_medium(), colour);
        if response.clicked() {
            clicked = Some(index);
        }
        if response.has_focus() {
            focused = Some(index);
        }
        over_border.push((*state, radius, response));
        x = right;
    }
    if let Some(index) = focused {
        // The focus moves last: a segment that is not a Tab stop yet would lose it immediately.
        let next = take_arrows(ui, index, &ids, segments);
        if arrows == Arrows::Choose {
            clicked = clicked.or(next);
        }
    }
    if segments.iter().all(|(_, state)| state.is_locked()) {
        paint::dashed_border(ui, rect, f32::from(RADIUS), Stroke::new(1.0, t.edge));
    } else {
        ui.painter().rect_stroke(rect, RADIUS, Stroke::new(1.0, t.edge), StrokeKind::Inside);
    }
    for (state, radius, response) in over_border {
        if state == Segment::Pending {
            let stroke = Stroke::new(2.0, t.cmd);
            ui.painter().rect_stroke(response.rect, radius, stroke, StrokeKind::Inside);
        }
        if state == Segment::Foreign {
            let inner = response.rect.shrink(1.0);
            paint::dashed_border(ui, inner, f32::from(RADIUS), Stroke::new(2.0, t.sat));
            response.clone().on_hover_text("Not by this console");
        }
        if let Segment::Locked(Some(reason)) = state {
            response.clone().on_hover_text(reason);
        }
        paint::focus_ring(ui, &response, RADIUS);
    }
    clicked
}

/// Returns the segment at which Tab stops. This is the segment that a screen reader requests or
/// that has the focus, the chosen segment, or else the first.
fn tab_stop(ui: &Ui, ids: &[Id], segments: &[(&str, Segment)]) -> Option<usize> {
    let focused = ui.memory(egui::Memory::focused);
    let is_free = |index: &usize| segments.get(*index).is_some_and(|(_, state)| !state.is_locked());
    let requested = ui.input(|input| {
        let is_asked = |id: &Id| input.has_accesskit_action_request(*id, Action::Focus);
        ids.iter().position(is_asked).filter(is_free)
    });
    // egui gives the focus only to a control that was a Tab stop before.
    if let Some(id) = requested.and_then(|requested| ids.get(requested)) {
        ui.memory_mut(|memory| memory.request_focus(*id));
    }
    let focused = ids.iter().position(|id| Some(*id) == focused);
    let is_chosen = |(_, state): &(&str, Segment)| *state == Segment::Chosen;
    requested
        .or(focused)
        .filter(is_free)
        .or_else(|| segments.iter().position(is_chosen))
        .or_else(|| (0..segments.len()).find(is_free))
}

/// Moves the focus from the segment at `index` to the next free one in the direction of an arrow.
/// The focus wraps around at the ends. Returns the new segment.
fn take_arrows(ui: &Ui, index: usize, ids: &[Id], segments: &[(&str, Segment)]) -> Option<usize> {
    let [back, on] = ui.input_mut(|input| {
        [[Key::ArrowLeft, Key::ArrowUp], [Key::ArrowRight, Key::ArrowDown]]
            .map(|keys| keys.map(|key| input.consume_key(Modifiers::NONE, key)).contains(&true))
    });
    if back == on {
        return None;
    }
    let is_free = |place: &usize| segments.get(*place).is_some_and(|(_, state)| !state.is_locked());
    let next = if on {
        (index + 1..segments.len()).chain(0..index).find(is_free)
    } else {
        (0..index).rev().chain((index + 1..segments.len()).rev()).find(is_free)
    };
    ui.memory_mut(|memory| {
        memory.move_focus(FocusDirection::None);
        if let Some(next) = next.and_then(|next| ids.get(next)) {
            memory.request_focus(*next);
        }
    });
    next
}

/// Returns a `Ui` for the segments, whose nodes are children of the node of the group.
fn inner_ui(ui: &Ui, group: &Response) -> Ui {
    let builder = UiBuilder::new().layer_id(ui.layer_id()).max_rect(group.rect);
    let builder = builder.accessibility_parent(group.id);
    let mut inner = Ui::new(ui.ctx().clone(), group.id.with("segments"), builder);
    inner.set_clip_rect(ui.clip_rect());
    if !ui.is_enabled() {
        inner.disable();
    }
    inner
}

fn corners(index: usize, count: usize) -> CornerRadius {
    let left = if index == 0 { RADIUS } else { 0 };
    let right = if index + 1 == count { RADIUS } else { 0 };
    CornerRadius { nw: left, sw: left, ne: right, se: right }
}

#[cfg(test)]
mod tests {
    use egui::{Pos2, Role};
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::{super::testing, *};

    const WORDS: [&str; 4] = ["Azimuth", "Pair", "Locked", "Elevation"];

    /// Returns a window with a group, whose segment `chosen` is chosen, between two buttons.
    fn window(chosen: usize) -> Harness<'static, usize> {
        testing::window([400.0, 100.0], chosen, |ui, chosen| {
            let _ = ui.button("before");
            let segments = WORDS.map(|word| match word {
                "Locked" => (word, Segment::Locked(None)),
                _ if word == WORDS[*chosen] => (word, Segment::Chosen),
                _ => (word, Segment::Free),
            });
            let rect = Rect::from_min_size(Pos2::new(0.0, 40.0), vec2(400.0, 24.0));
            if let Some(clicked) = show(ui, "rotators", rect, "Rotators", &segments) {
                *chosen = clicked;
            }
            ui.add_space(40.0);
            let _ = ui.button("after");
        })
    }

    fn focused(window: &Harness<'_, usize>) -> Option<&'static str> {
        let names = WORDS.into_iter().chain(["before", "after"]);
        names.into_iter().find(|name| window.get_by_label(name).is_focused())
    }

    #[test]
    fn tab_stops_at_the_chosen_segment_and_an_arrow_chooses_the_next_one() {
        let mut window = window(1);
        window.get_by_label("before").focus();
        window.run();
        let press = |window: &mut Harness<'_, usize>, key| {
            window.key_press(key);
            window.run();
            (focused(window), *window.state())
        };
        assert_eq!(press(&mut window, Key::Tab), (Some("Pair"), 1));
        let last = (Some("Elevation"), 3);
        assert_eq!(press(&mut window, Key::ArrowRight), last, "not the locked one");
        assert_eq!(press(&mut window, Key::ArrowRight), (Some("Azimuth"), 0), "round the end");
        assert_eq!(press(&mut window, Key::ArrowLeft), last, "round the start");
        assert_eq!(press(&mut window, Key::ArrowUp), (Some("Pair"), 1));
        assert_eq!(press(&mut window, Key::ArrowDown), last);
        assert_eq!(press(&mut window, Key::Tab), (Some("after"), 3));
        let button = window.get_by_role_and_label(Role::RadioButton, "Azimuth");
        button.click();
        window.run();
        assert_eq!(*window.state(), 0);
    }
}
