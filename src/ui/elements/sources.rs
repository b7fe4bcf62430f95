//! The cards of the sources.

use egui::{Align, Button, Layout, RichText, Role, Ui, WidgetInfo, vec2};

use super::words;
use crate::{
    engine,
    model::{Model, UiCommand},
    orbit::{Source, SourcePlace, SourceReport},
    ui::{
        confirm::Question,
        text, theme,
        widgets::{button::SMALL_HEIGHT, card, told::line},
    },
};

/// Maximum width of a card.
const MAX: f32 = 720.0;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    for (index, source) in model.sources.list.iter().enumerate() {
        let report = model.sources.reports.get(index);
        card::show(ui, MAX, |ui| one(ui, model, source, report, question, commands));
    }
}

fn one(
    ui: &mut Ui,
    model: &Model,
    source: &Source,
    report: Option<&SourceReport>,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let name = &source.name;
    let is_free = model.sources.is_free();
    let size = vec2(ui.available_width(), SMALL_HEIGHT);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        if named_button(ui, is_free, "Remove", &format!("Remove {name}")) {
            *question = Some(Question {
                text: format!("Remove the source {name}? Its elements are used no longer."),
                yes: "Remove",
                command: UiCommand::Station(engine::Command::RemoveSource(name.clone())),
            });
        }
        let (word, spoken) = match source.place {
            SourcePlace::Web(_) => ("Ask", format!("Ask {name}")),
            SourcePlace::File(_) | SourcePlace::Folder(_) => ("Read", format!("Read {name} again")),
        };
        if named_button(ui, is_free, word, &spoken) {
            let again = words::ask_again(name, report, model.now);
            let forced = again.is_some();
            let command = UiCommand::Station(engine::Command::RefreshSources {
                names: vec![name.clone()],
                forced,
            });
            match again {
                Some(text) => *question = Some(Question { text, yes: "Ask", command }),
                None => commands.push(command),
            }
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let words = RichText::new(name).font(text::value());
            ui.add(egui::Label::new(words).truncate());
        });
    });
    ui.spacing_mut().item_spacing.y = 4.0;
    let place = RichText::new(words::place(source)).font(text::small()).color(t.t3);
    ui.add(egui::Label::new(place).truncate());
    for (tone, words) in words::report(source, report, model.now) {
        line(ui, tone, &words);
    }
}

/// Shows a button with a longer accessible name; returns `true` when it was clicked.
pub(super) fn named_button(ui: &mut Ui, enabled: bool, word: &str, name: &str) -> bool {
    let response = ui.add_enabled(enabled, Button::new(word));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response.clicked()
}
