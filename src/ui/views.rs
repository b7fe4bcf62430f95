//! The whole window: what is always there, and the view that fills the rest.

use egui::{Rect, Ui, pos2};
use jiff::Timestamp;

use super::{
    banner, bar,
    confirm::Question,
    icons::Icon,
    keys::{self, Desk},
    operate, preferences, rail,
    rail::RailEntry,
    top_bar,
};
use crate::app::{Model, UiCommand, View};

/// What the operator typed, opened and folded.
#[derive(Default)]
pub struct Views {
    operate: operate::OperateState,
    preferences: preferences::PreferencesState,
    question: Option<Question>,
    keys_open: bool,
}

impl Views {
    /// Draws everything and collects what the operator asked for.
    pub fn show(&mut self, ui: &mut Ui, model: &Model, commands: &mut Vec<UiCommand>) {
        let window = ui.max_rect();
        let top = window.with_max_y(window.top() + top_bar::height(window.height()));
        bar::show(ui, top, model, commands);
        let mut desk = Desk {
            question: &mut self.question,
            operate: &mut self.operate,
            list_open: &mut self.keys_open,
        };
        keys::take(ui, model, &mut desk, commands);

        let mut body = window.with_min_y(top.bottom());
        if model.demo {
            let strip = body.with_max_y(body.top() + banner::HEIGHT);
            banner::show(ui, strip, model, commands);
            body = body.with_min_y(strip.bottom());
        }
        let side = body.with_max_x(body.left() + rail::width(window.width()));
        show_rail(ui, side, model, commands);
        let rest = Rect::from_min_max(pos2(side.right(), body.top()), body.max);
        match model.view {
            View::Operate => {
                operate::show(ui, window, rest, model, &mut self.operate, commands);
            }
            View::Preferences => {
                self.operate.leave_card(commands);
                preferences::show(ui, rest, model, &mut self.preferences, commands);
            }
        }
        Question::show(&mut self.question, ui, commands);
        keys::list::show(ui, &mut self.keys_open);
    }

    /// The settings were saved at this time, or not, and why.
    pub fn saved(&mut self, result: Result<Timestamp, String>) {
        self.preferences.saved(result);
    }
}

fn show_rail(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let views = [
        (View::Operate, Icon::CrossHair, "Operate"),
        (View::Preferences, Icon::Sliders, "Preferences"),
    ];
    let entries =
        views.map(|(view, icon, word)| RailEntry { icon, word, active: view == model.view });
    if let Some((view, ..)) = rail::show(ui, rect, &entries).and_then(|index| views.get(index)) {
        commands.push(UiCommand::Show(*view));
    }
}
