//! The skyline as text, from a file, or recorded by pointing with an antenna.

use std::path::PathBuf;

use egui::{Align2, Key, Rect, Sense, Ui, pos2, vec2};

use super::{HorizonState, draft::Skies, pane, plot};
use crate::{
    astro::{Angle, AzEl},
    contract::driver::{Intent, LinkState},
    model::{Model, UiCommand},
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{Button, HEIGHT},
            input::Input,
            paint,
        },
        words,
    },
};

/// Distance in azimuth within which a new mark replaces an old one, degrees.
const REPLACES_DEG: f64 = 2.0;
/// Min gap between marks that Azel reports, degrees.
const GAP_DEG: f64 = 30.0;

/// A recording of the skyline.
pub(super) struct Recording {
    marks: Vec<(f64, f64)>,
    /// Text of the mask before the recording.
    before: String,
    is_over: bool,
}

impl Recording {
    pub(super) fn new(mask: &str) -> Self {
        Self { marks: Vec::new(), before: mask.to_owned(), is_over: false }
    }

    /// Adds a direction, replacing a mark near it.
    fn mark(&mut self, direction: AzEl) {
        let rounded = |value: f64| (value * 100.0).round() / 100.0;
        let mark = (
            rounded(direction.azimuth_deg()).rem_euclid(360.0),
            rounded(direction.elevation_deg()),
        );
        self.marks.retain(|(azimuth_deg, _)| distance_deg(*azimuth_deg, mark.0) >= REPLACES_DEG);
        self.marks.push(mark);
    }

    /// Returns the widest gap if it is too wide: from one azimuth to the next, degrees.
    fn gap(&self) -> Option<(f64, f64)> {
        let mut azimuths: Vec<f64> =
            self.marks.iter().map(|(azimuth_deg, _)| *azimuth_deg).collect();
        azimuths.sort_by(f64::total_cmp);
        let next = azimuths.iter().cycle().skip(1);
        let gaps = azimuths.iter().zip(next).map(|(start, end)| {
            let width = (end - start).rem_euclid(360.0);
            (*start, *end, if width == 0.0 { 360.0 } else { width })
        });
        let widest = gaps.max_by(|a, b| a.2.total_cmp(&b.2))?;
        (widest.2 > GAP_DEG).then_some((widest.0, widest.1))
    }
}

fn distance_deg(a_deg: f64, b_deg: f64) -> f64 {
    Angle::from_degrees(a_deg - b_deg).wrapped_180().abs().degrees()
}

/// Shows the form for the skyline as text, typed or pasted in any known format.
pub(super) fn form(ui: &mut Ui, skies: &mut Skies) {
    let t = theme::tokens(ui);
    let head = row(ui, 32.0);
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Skyline", text::value(), t.t1);
    let read = skies.read_mask();
    let hint = "Azimuth and elevation, one point per line. Tables from other programs also work.";
    pane::lines(ui, "Horizon mask", hint, &mut skies.mask, read.is_err());
    if let Err(reason) = read {
        let words = format!("{}. The plot shows no skyline.", words::capitalised(&reason));
        let words = words.replace('-', "−");
        let line = row(ui, 28.0);
        paint::named_text_in(
            ui,
            "mask problem",
            line,
            Align2::LEFT_CENTER,
            &words,
            text::small(),
            t.bad,
        );
    }
}

fn row(ui: &mut Ui, height: f32) -> Rect {
    ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover()).0
}

/// Returns the direction of the antenna, or the reason why the operator cannot mark it now.
fn markable(model: &Model, state: &HorizonState) -> Result<AzEl, String> {
    let Some(antenna) = state.shown(model) else {
        return Err("There is no antenna.".to_owned());
    };
    let name = &antenna.config.name;
    let snapshot = &antenna.snapshot;
    if !matches!(snapshot.link, LinkState::Up { .. }) {
        return Err(format!("{name} is not connected."));
    }
    if snapshot.intent != Intent::Manual {
        return Err(format!("{name} must be in Manual: choose it in Operate."));
    }
    let measured = snapshot.state.measured.ok_or_else(|| format!("{name} has no position yet."))?;
    if measured.moving() {
        return Err(format!("{name} is moving. Mark when it has stopped."));
    }
    measured.direction().ok_or_else(|| format!("{name} reports no elevation."))
}

/// Shows the steps of a recording. Azel itself does not move the antenna.
pub(super) fn record(ui: &mut Ui, model: &Model, skies: &mut Skies, state: &mut HorizonState) {
    let t = theme::tokens(ui);
    let direction = markable(model, state);
    let Some(recording) = &mut state.recording else { return };
    ui.add_space(8.0);
    let head = row(ui, 28.0);
    let title = "Record the skyline with the antenna";
    paint::text_in(ui, head, Align2::LEFT_CENTER, title, text::body_medium(), t.t1);
    let count = recording.marks.len();
    if recording.is_over {
        let words = format!("{count} points recorded. Which skyline do you want to keep?");
        says(ui, "recorded", &words, (Icon::Info, t.sat), t.t1);
        let buttons = row(ui, HEIGHT + 8.0);
        let (new, old) = (Button::primary("Keep the new one"), Button::normal("Keep the old one"));
        let (first, second) = columns(buttons, new.width(ui), old.width(ui));
        let keeps_new = new.show(ui, "keep new", first).clicked();
        let keeps_old = old.show(ui, "keep old", second).clicked();
        if keeps_old {
            skies.mask = std::mem::take(&mut recording.before);
        }
        if keeps_new || keeps_old {
            state.recording = None;
        }
        return;
    }
    let words = "Point the antenna by hand to where the sky begins, by camera or by noise level.";
    says(ui, "step 1", words, (Icon::Check, t.ok), t.t2);
    let (words, icon) = match &direction {
        Ok(direction) => {
            let here = plot::direction((direction.azimuth_deg(), direction.elevation_deg()));
            (
                format!("Mark it with Enter. It is at {here}. {count} marked."),
                (Icon::CrossHair, t.cmd),
            )
        }
        Err(reason) => (format!("{reason} {count} marked."), (Icon::Warning, t.warn)),
    };
    says(ui, "step 2", &words, icon, t.t1);
    let words = "Jog to the next azimuth in Operate. Azel moves nothing by itself here.";
    says(ui, "step 3", words, (Icon::Dash, t.t3), t.t2);
    if let Some((start, last)) = recording.gap().filter(|_| count > 1) {
        let words = format!(
            "Nothing is marked from {start:.0}° to {last:.0}°: a straight line is drawn there."
        );
        says(ui, "gap", &words, (Icon::Warning, t.warn), t.warn);
    }
    let buttons = row(ui, HEIGHT + 8.0);
    let label = match &direction {
        Ok(direction) => format!(
            "Mark {}",
            plot::direction((direction.azimuth_deg(), direction.elevation_deg()))
        ),
        Err(_) => "Mark".to_owned(),
    };
    let mark = Button::primary(&label).locked(direction.is_err());
    let undo = Button::normal("Undo point").locked(count == 0);
    let end = Button::normal("End");
    let (first, second) = columns(buttons, mark.width(ui), undo.width(ui));
    let third =
        Rect::from_min_size(second.right_top() + vec2(8.0, 0.0), vec2(end.width(ui), HEIGHT));
    let is_free = !ui.text_edit_focused() && ui.memory(|memory| memory.focused().is_none());
    let enter = is_free && ui.input(|input| input.key_pressed(Key::Enter));
    let marks = mark.show(ui, "mark", first).clicked() || enter;
    let undoes = undo.show(ui, "undo point", second).clicked();
    let ends = end.show(ui, "end", third).clicked();
    if let (true, Ok(direction)) = (marks, direction) {
        recording.mark(direction);
    } else if undoes {
        recording.marks.pop();
    }
    if marks || undoes {
        skies.set_skyline(recording.marks.clone());
        if recording.marks.is_empty() {
            skies.mask.clone_from(&recording.before);
        }
    }
    if ends {
        recording.is_over = true;
        if recording.marks.is_empty() {
            state.recording = None;
        }
    }
}

fn columns(row: Rect, first: f32, second: f32) -> (Rect, Rect) {
    let top = row.top() + 8.0;
    let one = Rect::from_min_size(pos2(row.left(), top), vec2(first, HEIGHT));
    (one, Rect::from_min_size(pos2(one.right() + 8.0, top), vec2(second, HEIGHT)))
}

fn says(
    ui: &mut Ui,
    salt: &str,
    words: &str,
    (icon, ink): (Icon, egui::Color32),
    colour: egui::Color32,
) {
    let line = row(ui, 22.0);
    let place = paint::square(line.left_center() + vec2(7.0, 0.0), 12.0);
    icons::paint(ui.painter(), place, icon, ink);
    let room = line.with_min_x(line.left() + 24.0);
    paint::text_in(ui, room, Align2::LEFT_CENTER, words, text::small(), colour);
    paint::name_text(ui, salt, line, words).on_hover_text(words);
}

/// Shows the line for a mask file and the result of its last exchange.
pub(super) fn exchange(
    ui: &mut Ui,
    bar: Rect,
    state: &mut HorizonState,
    commands: &mut Vec<UiCommand>,
) {
    if !bar.is_positive() {
        return;
    }
    let t = theme::tokens(ui);
    ui.painter().rect_filled(bar, 0.0, t.bg2);
    let row = bar.shrink2(vec2(16.0, 8.0));
    let mut right = row.right();
    let mut place = |width: f32| {
        let rect = row.with_min_x(right - width).with_max_x(right);
        right -= width + 8.0;
        rect
    };
    let close = Button::quiet("Close");
    let closes = close.show(ui, "close exchange", place(close.width(ui))).clicked();
    if let Some(path) = &mut state.import {
        let read = Button::primary("Read file").locked(path.trim().is_empty());
        let reads = read.show(ui, "read mask", place(read.width(ui))).clicked();
        let field = row.with_max_x(right.min(row.left() + 420.0));
        Input { rect: field, name: "Path of a horizon mask", border: None }.text(ui, path, false);
        if reads {
            commands.push(UiCommand::ImportMask(PathBuf::from(path.trim())));
        }
        right = right.max(field.right() + 8.0);
        draw_answer(ui, row.with_min_x(field.right() + 8.0).with_max_x(right), state);
    } else {
        draw_answer(ui, row.with_max_x(right), state);
    }
    if closes {
        (state.import, state.answer) = (None, None);
    }
}

fn draw_answer(ui: &Ui, room: Rect, state: &HorizonState) {
    let t = theme::tokens(ui);
    let (words, colour) = match &state.answer {
        Some(Ok(words)) => (words, t.ok),
        Some(Err(words)) => (words, t.bad),
        None => return,
    };
    paint::named_text_in(ui, "exchanged", room, Align2::LEFT_CENTER, words, text::small(), colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_mark_nearby_replaces_the_first_and_gaps_are_named() {
        let mut recording = Recording::new("0 3");
        for (azimuth, elevation) in [(359.5, 4.0), (100.0, 5.0), (0.504, 6.006)] {
            recording.mark(AzEl::from_degrees(azimuth, elevation));
        }
        assert_eq!(recording.marks, [(100.0, 5.0), (0.5, 6.01)]);
        assert_eq!(recording.gap(), Some((100.0, 0.5)));
        for azimuth in (0..360).step_by(20) {
            recording.mark(AzEl::from_degrees(f64::from(azimuth), 1.0));
        }
        assert_eq!(recording.gap(), None);
    }
}
