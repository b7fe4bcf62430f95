//! The status of a long search: its progress, and the buttons that end or resume it.

use egui::{Align2, Rect, Role, Ui, WidgetInfo, vec2};

use super::PassListModel;
use crate::{
    contract,
    contract::passes::Work,
    model::UiCommand,
    ui::{
        format, text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
    },
};

/// Height of the strip, with its divider, points.
pub(super) const HEIGHT: f32 = 36.0;

const PADDING: f32 = 16.0;
const GAP: f32 = 8.0;
/// Thickness of the progress bar, points.
const BAR: f32 = 3.0;

pub(super) fn show(ui: &Ui, rect: Rect, model: &PassListModel<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let room = rect.shrink2(vec2(PADDING, 0.0));
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let made = model.made.map_or_else(String::new, |(satellites, time)| {
        let count = format::number(satellites as f64, 0);
        format!("{count} satellites at {}", format::minute(time, model.now))
    });
    let (words, colour, offer) = match model.work {
        Work::Nothing => (made, t.t3, None),
        Work::UnderWay { done, total } => {
            progress(ui, rect, done, total);
            let count = |number: usize| format::number(number as f64, 0);
            let words = if total == 0 {
                "Preparing the satellites".to_owned()
            } else {
                format!("Searched {} of {}", count(done), count(total))
            };
            (
                words,
                t.t2,
                Some(("Cancel", UiCommand::Station(contract::Command::CancelSearch(model.scope)))),
            )
        }
        Work::Cancelled => {
            let words = match model.made {
                Some((_, time)) => {
                    format!("Cancelled; list of {}", format::minute(time, model.now))
                }
                None => "Cancelled".to_owned(),
            };
            (
                words,
                t.warn,
                Some(("Search", UiCommand::Station(contract::Command::ResumeSearch(model.scope)))),
            )
        }
    };
    let mut left = room;
    if let Some((word, action)) = offer {
        let button = Button::quiet(word);
        let size = vec2(button.width(ui), SMALL_HEIGHT);
        let place = Align2::RIGHT_CENTER.align_size_within_rect(size, room);
        if button.show(ui, "search work", place).clicked() {
            commands.push(action);
        }
        left.set_right(place.left() - GAP);
    }
    paint::named_text_in(
        ui,
        "search status",
        left,
        Align2::LEFT_CENTER,
        &words,
        text::small(),
        colour,
    );
}

fn progress(ui: &Ui, rect: Rect, done: usize, total: usize) {
    let t = theme::tokens(ui);
    let part = if total == 0 { 0.0 } else { (done as f32 / total as f32).clamp(0.0, 1.0) };
    let track = rect.with_min_y(rect.bottom() - BAR);
    ui.painter().rect_filled(track, 0.0, t.line);
    let filled = track.with_max_x(track.left() + part * track.width());
    ui.painter().rect_filled(filled, 0.0, t.sat);
    let response = ui.interact(track, ui.make_persistent_id("progress"), egui::Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, "Search"));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_numeric_value(f64::from((part * 100.0).round()));
    });
}
