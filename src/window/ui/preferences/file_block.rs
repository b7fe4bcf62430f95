//! The station file below the list of pages: its path, and the time of the last save.

use std::path::Path;

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::PADDING;
use crate::{
    model::{Model, UiCommand},
    ui::{
        format, text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
    },
};

const LINE: f32 = 18.0;
const GAP: f32 = 8.0;
/// Min width of two buttons side by side, points.
const WIDE: f32 = 200.0;

/// Returns the height of the block in a list of this width, points.
pub(super) fn height(width: f32) -> f32 {
    let buttons = if width < WIDE { 2.0 } else { 1.0 };
    3.0 * LINE + buttons * (SMALL_HEIGHT + GAP) + 2.0 * GAP
}

pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, GAP)).with_max_x(rect.right() - 12.0);
    let line = |index: f32| {
        Rect::from_min_size(inner.min + vec2(0.0, index * LINE), vec2(inner.width(), LINE))
    };
    let left = Align2::LEFT_CENTER;
    paint::text_in(ui, line(0.0), left, "Station file", text::small(), t.t3);
    let Some(path) = &model.stations.open else {
        let words = "This user has no folder for settings.";
        let room = line(1.0).union(line(2.0));
        paint::paragraph_in(ui, room, words, text::small(), t.warn);
        paint::name_text(ui, "station file", room, words);
        return;
    };
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    paint::text_in(ui, line(1.0), left, &name, text::body_medium(), t.t1);
    let saved = saved(model);
    paint::text_in(ui, line(2.0), left, &saved, text::small(), t.t2);
    let spoken = format!("Station file: {}, {saved}", path.display());
    paint::name_text(ui, "station file", line(1.0).union(line(2.0)), &spoken)
        .on_hover_text(path.display().to_string());
    let (copy, open) = (Button::normal("Copy path"), Button::normal("Open folder"));
    let first = Rect::from_min_size(
        pos2(inner.left(), line(3.0).top() + GAP),
        vec2(copy.width(ui), SMALL_HEIGHT),
    );
    let second = if rect.width() < WIDE {
        pos2(inner.left(), first.bottom() + GAP)
    } else {
        pos2(first.right() + GAP, first.top())
    };
    let second = Rect::from_min_size(second, vec2(open.width(ui), SMALL_HEIGHT));
    if copy.show(ui, "copy station path", first).clicked() {
        ui.copy_text(path.display().to_string());
    }
    if let Some(folder) = path.parent().map(Path::to_owned)
        && open.show(ui, "open station folder", second).clicked()
    {
        commands.push(UiCommand::OpenFolder(folder));
    }
}

fn saved(model: &Model) -> String {
    match model.station_saved_at {
        Some(time) => format!("saved {}", format::moment(time, model.now)),
        None => "not saved yet".to_owned(),
    }
}
