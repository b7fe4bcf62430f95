//! The Console view: the traffic on the links, line by line with its meaning, and a line
//! for sending questions.

mod bar;
mod entry;
mod inspector;
mod links;
mod log;
mod raw;
mod row;
mod send;
mod table;
mod tally;

use std::{path::PathBuf, sync::Arc, time::Duration};

use egui::{Rect, Ui, ViewportId};

use super::{theme, widgets::selection::RowSelection};
use crate::model::{ConsoleLine, Model, UiCommand};
use entry::Entry;
use log::{Filter, Log};

/// Window width below which the inspector is a drawer, points.
const DRAWER_BELOW: f32 = 1100.0;
const INSPECTOR: f32 = 344.0;
const PADDING: f32 = 16.0;

/// Shown lines, input and selection.
#[derive(Default)]
pub struct ConsoleState {
    log: Log,
    filter: Filter,
    filter_wants_focus: bool,
    selection: RowSelection<u64>,
    table: table::TableState,
    tallies: tally::Tallies,
    is_paused: bool,
    inspector_is_open: bool,
    entry: Entry,
    /// Outcome of the last save.
    saved: Option<Result<PathBuf, String>>,
}

impl ConsoleState {
    /// Gives the filter field the keyboard focus.
    pub fn focus_filter(&mut self) {
        self.filter_wants_focus = true;
    }

    /// Takes the outcome of a save of the shown lines: the path or the error.
    pub fn saved(&mut self, result: Result<PathBuf, String>) {
        self.saved = Some(result);
    }

    fn selected(&self) -> Option<&Arc<ConsoleLine>> {
        self.log.line(self.selection.row()?)
    }

    /// Returns the positions of the lines that are both selected and shown.
    fn chosen(&self) -> impl Iterator<Item = u64> {
        let shown = self.log.shown();
        let is_shown = |position: &u64| shown.binary_search(position).is_ok();
        self.selection.marked().iter().copied().filter(is_shown)
    }

    /// Copies the selected lines as text, if any.
    fn copy(&self, ui: &Ui) {
        let chosen = self.chosen();
        let lines: Vec<String> =
            chosen.filter_map(|position| Some(self.log.line(position)?.report())).collect();
        if !lines.is_empty() {
            ui.copy_text(lines.join("\n"));
        }
    }
}

/// Draws the view. The inspector stands beside the log if `window` is wide enough.
pub fn show(
    ui: &mut Ui,
    window: Rect,
    rect: Rect,
    model: &Model,
    state: &mut ConsoleState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    take_new_lines(ui, model, state);
    let has_drawer = window.width() < DRAWER_BELOW;
    let side = if has_drawer { 0.0 } else { INSPECTOR };
    let (left, right) = rect.split_left_right_at_x(rect.right() - side);

    let (head, left) = left.split_top_bottom_at_y(left.top() + bar::HEIGHT);
    bar::show(ui, head.with_max_x(rect.right()), model, has_drawer, state, commands);
    let (left, send) = left.split_top_bottom_at_y(left.bottom() - send::HEIGHT);
    let (list, strip) = left.split_top_bottom_at_y(left.bottom() - bar::STRIP);
    let (list, drawer) = if has_drawer && state.inspector_is_open {
        list.split_left_right_at_x(list.right() - INSPECTOR)
    } else {
        (list, Rect::NOTHING)
    };
    table::show(ui, list, model.antennas.len() > 1, model.now, state);
    bar::show_strip(ui, strip, state);
    send::show(ui, send, model, &mut state.entry, commands);

    if !has_drawer {
        let tallies = state.tallies.all();
        let right = right.with_min_y(head.bottom());
        let foot = right.bottom() - links::height(tallies.len());
        let (right, foot) = right.split_top_bottom_at_y(foot);
        links::show(ui, foot, tallies);
        inspector::show(ui, right, model, state, false);
    } else if state.inspector_is_open {
        inspector::show(ui, drawer, model, state, true);
    }
}

/// Takes new lines into the view unless the view is paused; a pause does not stop the recording.
fn take_new_lines(ui: &Ui, model: &Model, state: &mut ConsoleState) {
    state.log.set_filter(&state.filter);
    if state.is_paused {
        return;
    }
    let names = model.antennas.iter().map(|antenna| antenna.config.name.as_str());
    let logs = names.zip(&model.wires);
    if state.log.pull(logs) {
        ui.request_repaint_after_for(Duration::from_millis(5), ViewportId::ROOT);
    }
    state.tallies.refresh(model.now, &state.log);
}
