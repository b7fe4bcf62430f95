//! Automatic operation on the card: its tag, its next action with the time, and the button that
//! resumes it after a suspension.

use egui::{Rect, Role, Ui, WidgetInfo, pos2, text::LayoutJob, vec2};

use super::Cursor;
use crate::{
    contract::{self, antenna::AntennaModel, automatic::Operation},
    model::{Model, UiCommand},
    ui::{
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            link_chip::{self, TAG},
            paint,
        },
        words,
    },
};

/// Space between the tag and the words, points.
const GAP: f32 = 8.0;
/// Number of rows reserved for a countdown, to keep everything below in place.
const ROWS: usize = 2;

pub(super) fn show(
    ui: &Ui,
    cursor: &mut Cursor,
    model: &Model,
    antenna: &AntennaModel,
    commands: &mut Vec<UiCommand>,
) {
    let Some(message) = words::automatic::in_full(model, antenna) else { return };
    let t = theme::tokens(ui);
    let is_suspended = matches!(antenna.operation, Operation::Suspended { .. });
    let colour = if is_suspended { t.warn } else { t.t1 };
    let width = cursor.width() - TAG.x - GAP;
    let font = text::small();
    let layout = |words: &str, rows| {
        let mut job = LayoutJob::simple(words.to_owned(), font.clone(), colour, width);
        job.wrap.max_rows = rows;
        ui.painter().layout_job(job)
    };
    // Show the reason for a suspension in full.
    let words = layout(&message, if is_suspended { usize::MAX } else { ROWS });
    let is_cut = words.elided;
    let room = if is_suspended { words.size().y } else { layout("\n", ROWS).size().y };
    let row = cursor.take(room.max(TAG.y));
    link_chip::automatic_tag(ui, Rect::from_min_size(row.left_top(), TAG), is_suspended);
    ui.painter().galley(pos2(row.left() + TAG.x + GAP, row.top()), words, colour);
    let spoken = format!("Automatic operation: {message}");
    let named = paint::name_text(ui, "automatic", row, &spoken);
    if is_cut {
        named.on_hover_text(&spoken);
    }
    if let Some(resume_label) = words::automatic::go_on(model, antenna) {
        cursor.skip(4.0);
        let row = cursor.take(SMALL_HEIGHT);
        let is_locked = model.replay.is_some();
        let whole = Button::normal(&resume_label).locked(is_locked);
        let has_room = whole.width(ui) <= row.width();
        let button = if has_room { whole } else { Button::normal(words::automatic::RESUME) };
        let button = button.locked(is_locked);
        let place = Rect::from_min_size(row.left_top(), vec2(button.width(ui), SMALL_HEIGHT));
        let response = button.show(ui, "go on", place);
        let name = format!("{resume_label}: automatic operation is suspended");
        response.widget_info(|| WidgetInfo::labeled(Role::Button, !is_locked, &name));
        if response.clicked() {
            let command = contract::Command::GoOn(antenna.id());
            commands.push(UiCommand::Station(command));
        }
        if !has_room {
            response.on_hover_text(name);
        }
    }
    cursor.skip(6.0);
}
