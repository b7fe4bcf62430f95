//! Notes of upcoming passes with a reminder, and of the outcome of a saved file or a change. They
//! lie over the views, so nothing moves under the pointer, and beside the antenna card.

use egui::{Align2, Area, Frame, Label, Margin, Order, Rect, RichText, Stroke, Ui, vec2};

use super::{map, text, theme, words};
use crate::{
    contract::{passes::PassListKey, reminders::Reminder},
    model::{Model, UiCommand, View, export::SavedFile},
};

/// Max width of a note, points.
const WIDTH: f32 = 560.0;
/// Width left free at the right for the antenna card, points.
const RIGHT: f32 = 376.0;
const GAP: f32 = 16.0;
/// Thickness of the bar at the left, points.
const BAR: f32 = 3.0;

/// Contents of the notes, besides the reminders of the model.
#[derive(Debug, Default)]
pub struct Notes {
    /// Last saved file, or the reason why an action failed; kept until the operator closes it.
    pub news: Option<Result<SavedFile, String>>,
    /// Passes whose reminders the operator closed.
    closed: Vec<PassListKey>,
}

impl Notes {
    /// Shows the file, and the reminders before AOS that the operator has not closed.
    pub fn show(&mut self, ui: &Ui, room: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
        let is_known =
            |pass: &PassListKey| model.reminders.iter().any(|candidate| candidate.pass == *pass);
        self.closed.retain(is_known);
        let is_shown = |reminder: &&Reminder| {
            reminder.aos() > model.now && !self.closed.contains(&reminder.pass)
        };
        let shown: Vec<&Reminder> = model.reminders.iter().filter(is_shown).collect();
        if shown.is_empty() && self.news.is_none() {
            return;
        }
        frame(ui, room, model.view, |ui| {
            for reminder in shown {
                line(ui, model, reminder, &mut self.closed, commands);
            }
            news_line(ui, &mut self.news);
        });
    }
}

fn frame(ui: &Ui, room: Rect, view: View, lines: impl FnOnce(&mut Ui)) {
    let width = WIDTH.min(room.width() - RIGHT - GAP);
    let position = room.left_bottom() + vec2(GAP, -below(view));
    Area::new(ui.make_persistent_id("notes"))
        .order(Order::Middle)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(position)
        .show(ui.ctx(), |ui| {
            ui.set_width(width);
            let t = theme::tokens(ui);
            let frame = Frame::new()
                .fill(t.bg2)
                .stroke(Stroke::new(1.0, t.edge))
                .inner_margin(Margin::symmetric(GAP as i8, 8));
            let place = frame.show(ui, lines);
            let place = place.response.rect;
            ui.painter().rect_filled(place.with_max_x(place.left() + BAR), 0.0, t.sat);
        });
}

/// Returns the height left free for the bars at the foot of the views, points.
fn below(view: View) -> f32 {
    match view {
        View::Operate | View::Plan | View::Elements | View::Record => GAP,
        View::Map => map::FOOT + GAP,
        View::Antennas | View::Preferences | View::Setup => 80.0,
        View::Console => 128.0,
    }
}

fn line(
    ui: &mut Ui,
    model: &Model,
    reminder: &Reminder,
    closed: &mut Vec<PassListKey>,
    commands: &mut Vec<UiCommand>,
) {
    let words = words::reminder(reminder, &model.antennas, model.now);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.with_layout(layout, |ui| {
        let close = ui.button("Close");
        close.widget_info(|| button(format!("Close the reminder of {}", reminder.name)));
        if close.clicked() {
            closed.push(reminder.pass);
        }
        let show = ui.button("Show");
        show.widget_info(|| button(format!("Show the pass of {}", reminder.name)));
        if show.clicked() {
            commands.push(UiCommand::SelectPass(reminder.pass));
            commands.push(UiCommand::Show(View::Operate));
        }
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(layout, |ui| {
            let words = RichText::new(words).font(text::body());
            ui.add(Label::new(words).wrap());
        });
    });
}

fn news_line(ui: &mut Ui, news: &mut Option<Result<SavedFile, String>>) {
    let Some(outcome) = news else { return };
    let t = theme::tokens(ui);
    let (words, colour) = match outcome {
        Ok(file) => (saved(file), t.t1),
        Err(reason) => (reason.clone(), t.bad),
    };
    let is_closed = ui
        .with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let close = ui.button("Close");
            close.widget_info(|| button("Close the note of the file".to_owned()));
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let words = RichText::new(words).font(text::body()).color(colour);
                ui.add(Label::new(words).wrap());
            });
            close.clicked()
        })
        .inner;
    if is_closed {
        *news = None;
    }
}

fn saved(SavedFile { path, left_out }: &SavedFile) -> String {
    let path = path.display();
    match left_out {
        0 => format!("Saved: {path}"),
        1 => format!("Saved without 1 object that a TLE cannot hold: {path}"),
        count => format!("Saved without {count} objects that a TLE cannot hold: {path}"),
    }
}

fn button(name: String) -> egui::WidgetInfo {
    egui::WidgetInfo::labeled(egui::Role::Button, true, name)
}
