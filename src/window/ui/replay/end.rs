//! The notice that replaces the strip when a replay has ended automatically.

use egui::{Align2, Rect, Ui, vec2};
use jiff::Timestamp;

use super::{GAP, HEIGHT, at_the_end};
use crate::{
    model::{UiCommand, replay::ReplayEnd},
    ui::{
        format, text, theme,
        widgets::{button::Button, paint},
    },
};

/// Shows why the replay has ended. The notice stays until the operator closes it or opens another
/// view, so that no control moves under the pointer.
pub fn show(
    ui: &Ui,
    rect: Rect,
    reason: &ReplayEnd,
    now: Timestamp,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.warnbg);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.warn));
    let close = Button::normal("Close");
    let area = at_the_end(ui, rect, close);
    let words = ended(reason, now);
    let room = rect.shrink2(vec2(2.0 * GAP, 0.0)).with_max_x(area.left() - GAP);
    let font = if rect.height() >= HEIGHT { text::value() } else { text::body_medium() };
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, font, t.warn);
    paint::name_text(ui, "end of the replay", room, &words);
    if close.show(ui, "close the end", area).clicked() {
        commands.push(UiCommand::CloseReplayEnd);
    }
}

/// Returns the reason why a replay ended automatically, in a sentence.
fn ended(reason: &ReplayEnd, now: Timestamp) -> String {
    match reason {
        ReplayEnd::Stop => "Replay ended: STOP was pressed.".to_owned(),
        ReplayEnd::Alarm => "Replay ended: a top-priority alarm came.".to_owned(),
        ReplayEnd::Pass { antenna, satellite, start } if *start > now => {
            let left = format::time_left(now, *start);
            format!("Replay ended: {antenna} is to track {satellite} in {left}.")
        }
        ReplayEnd::Pass { antenna, satellite, start } => {
            let time_text = format::moment(*start, now);
            format!("Replay ended: {antenna} was to track {satellite} from {time_text} on.")
        }
    }
}
