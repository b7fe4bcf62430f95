//! The page of how the window looks. It is used at once and belongs to this window, not to the
//! station file.

use egui::{Align, Label, Layout, RichText, Sense, Ui, vec2};

use super::form::{LABEL, ROW, card};
use crate::{
    model::{Appearance, Model, ThemeName, UiCommand},
    ui::{
        text, theme,
        widgets::segmented::{self, Segment},
    },
};

/// Width of a choice.
const CHOICE: f32 = 300.0;
/// The least size of the window at which all views work, points.
const LEAST: [f32; 2] = [960.0, 540.0];

pub(super) fn show(ui: &mut Ui, model: &Model, commands: &mut Vec<UiCommand>) {
    let now = model.appearance;
    let mut wanted = now;
    card(ui, "Theme and size", |ui| {
        let themes =
            [("Dark", ThemeName::Dark), ("Light", ThemeName::Light), ("Night", ThemeName::Night)];
        choice(ui, "Theme", &themes, &mut wanted.theme);
        note(ui, "Night has one red hue, for eyes that are used to the dark.");
        choice(
            ui,
            "With the Sun",
            &[("No", false), ("Light by day", true)],
            &mut wanted.light_by_day,
        );
        note(ui, "While the Sun is up over the station the theme is light.");
        let words = Appearance::SCALES_PERCENT.map(|percent| (format!("{percent} %"), percent));
        let fits = |percent: u32| percent <= now.scale_percent || has_room(ui, now, percent);
        let scales: Vec<(&str, u32)> = words
            .iter()
            .filter(|(_, percent)| fits(*percent))
            .map(|(word, percent)| (word.as_str(), *percent))
            .collect();
        choice(ui, "Scale", &scales, &mut wanted.scale_percent);
        if scales.len() < words.len() {
            note(ui, "A larger scale needs a larger window: part of the views would be cut off.");
        }
    });
    if wanted != now {
        commands.push(UiCommand::SetAppearance(wanted));
    }
}

/// Whether the window is large enough for this scale.
fn has_room(ui: &Ui, now: Appearance, percent: u32) -> bool {
    let size = ui.ctx().content_rect().size() * (now.scale_percent as f32 / percent as f32);
    size.x >= LEAST[0] && size.y >= LEAST[1]
}

fn choice<T: Copy + PartialEq>(ui: &mut Ui, label: &str, choices: &[(&str, T)], value: &mut T) {
    let t = theme::tokens(ui);
    ui.horizontal_top(|ui| {
        let left = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(LABEL, ROW), left, |ui| {
            ui.set_min_width(LABEL);
            ui.label(RichText::new(label).font(text::body()).color(t.t2));
        });
        let (rect, _) = ui.allocate_exact_size(vec2(CHOICE, ROW), Sense::hover());
        let state = |of: T| if of == *value { Segment::Chosen } else { Segment::Free };
        let segments: Vec<_> = choices.iter().map(|(word, of)| (*word, state(*of))).collect();
        let clicked = segmented::show(ui, label, rect, label, &segments);
        if let Some((_, of)) = clicked.and_then(|index| choices.get(index)) {
            *value = *of;
        }
    });
}

fn note(ui: &mut Ui, words: &str) {
    let t = theme::tokens(ui);
    ui.horizontal_top(|ui| {
        ui.add_space(LABEL + 8.0);
        ui.add(Label::new(RichText::new(words).font(text::small()).color(t.t3)).wrap());
    });
}
