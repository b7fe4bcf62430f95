//! Actions of the make: a button for each, with its input fields.

use std::collections::BTreeMap;

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{Card, Cursor, Locks, show_remark};
use crate::{
    contract::driver::Command,
    device::{
        panel::{Act, Action},
        settings::{Field, Values},
    },
    model::UiCommand,
    ui::{
        confirm::Question,
        icons::Icon,
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            form::Mark,
            input::Input,
            paint,
        },
        words,
    },
};

const GAP: f32 = 8.0;
/// Max share of the width for the label of a field, 0 to 1.
const LABEL_SHARE: f32 = 0.42;

/// Input for the actions. The type has no `Debug`, because it may contain a password.
#[derive(Clone, Default)]
pub(super) struct MoreState {
    /// Input by the keys of action and field.
    typed: BTreeMap<(&'static str, &'static str), String>,
    /// The refused action and the reason.
    refused: Option<(&'static str, String)>,
}

impl MoreState {
    fn text(&mut self, action: &Action, field: &Field) -> &mut String {
        self.typed.entry((action.key, field.key)).or_insert_with(|| field.kind.untouched())
    }

    /// Returns the action with its input, or a sentence about invalid input.
    fn read(&mut self, action: &'static Action) -> Result<Act, String> {
        let read = |field: &'static Field| match field.kind.read(self.text(action, field)) {
            Ok(value) => Ok((field.key, value)),
            Err(unfit) => Err(format!("{} {}.", field.label, words::unfit(&unfit, field.unit))),
        };
        let values: Values = action.fields.iter().map(read).collect::<Result<_, _>>()?;
        Ok(Act { action: action.key, values })
    }
}

/// Shows the actions and starts the chosen one, after its question if it has one.
pub(super) fn show(ui: &mut Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut MoreState) {
    let actions = card.antenna.variant().actions;
    let Some((action, act)) = show_actions(ui, cursor, actions, &card.locks, state) else { return };
    match action.question {
        Some(text) => {
            let command = UiCommand::antenna(card.antenna.id(), Command::Act(act));
            *card.question = Some(Question { text: text.to_owned(), yes: action.label, command });
        }
        None => card.queue(Command::Act(act)),
    }
}

/// Shows the actions, those without input side by side. Returns the action to start, with its
/// input.
fn show_actions(
    ui: &mut Ui,
    cursor: &mut Cursor,
    actions: &'static [Action],
    locks: &Locks<'_>,
    state: &mut MoreState,
) -> Option<(&'static Action, Act)> {
    cursor.skip(4.0);
    let motion_lock = locks.action.filter(|_| actions.iter().any(|action| action.moves));
    if let Some(reason) = locks.link.or(motion_lock) {
        show_remark(ui, cursor, "locked actions", Icon::Lock, theme::tokens(ui).t2, reason);
        cursor.skip(GAP);
    }
    let mut right_end = cursor.right;
    let mut chosen = None;
    for action in actions {
        let is_locked = locks.link.is_some() || locks.action.is_some() && action.moves;
        let button = Button::normal(action.label).locked(is_locked);
        let width = button.width(ui).min(cursor.width());
        if action.fields.is_empty() {
            // Start a new row if the current one has no room for the button.
            if right_end + GAP + width > cursor.right {
                cursor.skip(SMALL_HEIGHT + GAP);
                right_end = cursor.left - GAP;
            }
            let min = pos2(right_end + GAP, cursor.y - SMALL_HEIGHT - GAP);
            let place = Rect::from_min_size(min, vec2(width, SMALL_HEIGHT));
            right_end = place.right();
            chosen = chosen.or(show_button(ui, place, button, action, state));
        } else {
            right_end = cursor.right;
            for field in action.fields {
                show_field(ui, cursor.take(SMALL_HEIGHT), action, field, state);
                cursor.skip(4.0);
            }
            let row = cursor.take(SMALL_HEIGHT);
            cursor.skip(GAP);
            let place = row.with_min_x(row.right() - width);
            chosen = chosen.or(show_button(ui, place, button, action, state));
        }
        let refusal = state.refused.as_ref().filter(|(key, _)| *key == action.key);
        if let Some((_, words)) = refusal {
            right_end = cursor.right;
            show_remark(ui, cursor, "refused action", Icon::Warning, theme::tokens(ui).bad, words);
            cursor.skip(GAP);
        }
    }
    chosen
}

fn show_button(
    ui: &Ui,
    place: Rect,
    button: Button<'_>,
    action: &'static Action,
    state: &mut MoreState,
) -> Option<(&'static Action, Act)> {
    let response = button.show(ui, ("action", action.key), place).on_hover_text(action.description);
    if !response.clicked() {
        return None;
    }
    match state.read(action) {
        Ok(act) => Some((action, act)),
        Err(reason) => {
            state.refused = Some((action.key, reason));
            None
        }
    }
}

fn show_field(
    ui: &mut Ui,
    row: Rect,
    action: &'static Action,
    field: &'static Field,
    state: &mut MoreState,
) {
    let t = theme::tokens(ui);
    let label = row.with_max_x(row.left() + LABEL_SHARE * row.width());
    paint::text_in(ui, label, Align2::LEFT_CENTER, field.label, text::small(), t.t2);
    let hint = if field.description.is_empty() { action.description } else { field.description };
    let salt = ("action label", action.key, field.key);
    paint::name_text(ui, salt, label, field.label).on_hover_text(hint);
    let room = row.with_min_x(label.right() + GAP);
    let unit_width = match field.unit {
        "" => 0.0,
        unit => paint::text_width(ui, unit, text::small()).ceil() + 5.0,
    };
    let rect = room.with_max_x(room.right() - unit_width);
    let unit = row.with_min_x(rect.right() + 4.0);
    paint::text_in(ui, unit, Align2::LEFT_CENTER, field.unit, text::small(), t.t3);
    let name = format!("{}: {}", action.label, field.label);
    let refused = state.refused.as_ref().is_some_and(|(key, _)| *key == action.key);
    let typed = state.text(action, field);
    let is_invalid = refused && field.kind.read(typed).is_err();
    let mark = if is_invalid { Mark::Invalid } else { Mark::Plain };
    let input = Input { rect, name: &name, border: mark.border(t) };
    if input.value(ui, &field.kind, typed) {
        state.refused = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        device::settings::{Key, Value},
        ui::widgets::testing,
    };
    use egui_kittest::{Harness, kittest::Queryable as _};

    const FIELDS: &[Field] = &[
        Field::write(Key::integer("to", 0, 360), "Heading").in_unit("°"),
        Field::write(Key::choice("way", &[(0, "Shortest"), (1, "Long")]), "Way round"),
    ];
    const ACTIONS: &[Action] = &[
        Action {
            key: "turn",
            label: "Turn the other",
            description: "Sends the other rotator to a heading.",
            fields: FIELDS,
            moves: true,
            question: None,
        },
        Action {
            key: "reset",
            label: "Reset alarms",
            description: "Takes back the alarms.",
            fields: &[],
            moves: false,
            question: None,
        },
        Action {
            key: "read",
            label: "Read the list",
            description: "Reads the names of the satellites.",
            fields: &[],
            moves: false,
            question: None,
        },
    ];

    #[derive(Default)]
    struct Story {
        motion_lock: Option<&'static str>,
        state: MoreState,
        acts: Vec<Act>,
    }

    fn section(story: Story) -> Harness<'static, Story> {
        let mut window = testing::window([320.0, 220.0], story, |ui, story| {
            let mut cursor = Cursor::new(ui.max_rect());
            let locks = Locks { action: story.motion_lock, ..Locks::default() };
            let chosen = show_actions(ui, &mut cursor, ACTIONS, &locks, &mut story.state);
            story.acts.extend(chosen.map(|(_, act)| act));
        });
        window.run();
        window
    }

    #[test]
    fn an_action_goes_out_with_what_was_typed_or_says_what_is_missing() {
        let mut window = section(Story::default());
        window.get_by_label("Turn the other").click();
        window.run();
        assert!(window.state().acts.is_empty());
        window.get_by_label("Heading must be a whole number from 0 to 360°.");
        window.get_by_label("Turn the other: Heading").focus();
        window.run();
        window.get_by_label("Turn the other: Heading").type_text("270");
        window.run();
        assert!(window.query_by_label("Heading must be a whole number from 0 to 360°.").is_none());
        window.get_by_label("Turn the other").click();
        window.run();
        let values = Values::from([("to", Value::Integer(270)), ("way", Value::Choice(0))]);
        assert_eq!(window.state().acts, [Act { action: "turn", values }]);
    }

    #[test]
    fn keys_without_fields_stand_side_by_side() {
        let window = section(Story::default());
        let (first, second) = (
            window.get_by_label("Reset alarms").rect(),
            window.get_by_label("Read the list").rect(),
        );
        assert!((first.top() - second.top()).abs() < 0.1 && second.left() > first.right());
        assert!(first.top() > window.get_by_label("Turn the other").rect().bottom());
    }

    #[test]
    fn what_moves_is_locked_with_its_reason_and_the_rest_is_not() {
        let reason = "Motion is locked. Choose Manual or Position.";
        let mut window = section(Story { motion_lock: Some(reason), ..Story::default() });
        window.get_by_label(reason);
        window.get_by_label("Turn the other").click();
        window.run();
        assert!(window.state().acts.is_empty());
        window.get_by_label("Reset alarms").click();
        window.run();
        let reset = Act { action: "reset", values: Values::default() };
        assert_eq!(window.state().acts, [reset]);
    }
}
