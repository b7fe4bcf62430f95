//! Frequencies of the selected object, which the operator can edit here.

use egui::{Align, Layout, RichText, Role, TextEdit, Ui, WidgetInfo};

use super::ElementsState;
use crate::{
    contract,
    model::{Model, UiCommand},
    station::Frequency,
    ui::{
        format,
        text::{self, Weight},
        theme,
    },
};

/// An edit of the frequencies of an object.
pub(super) struct Edit {
    number: u32,
    text: String,
}

/// Shows the frequencies. `lock` is the reason why the station's settings may not change now.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    number: u32,
    lock: Option<&'static str>,
    state: &mut ElementsState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.spacing_mut().item_spacing.y = 4.0;
    let own = || model.station.frequencies.iter().filter(|frequency| frequency.satellite == number);
    let title = RichText::new("Frequencies").font(text::sized(13.0, Weight::SemiBold));
    let is_edited = state.frequencies.as_ref().is_some_and(|edit| edit.number == number);
    let mut is_asked = false;
    ui.horizontal(|ui| {
        ui.label(title.color(t.t1));
        // Put the button beside the title: below the lines, the foot of the inspector would cut it.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if !is_edited {
                let button = egui::Button::new("Edit frequencies");
                let button = ui.add_enabled(lock.is_none(), button);
                is_asked = button.on_disabled_hover_text(lock.unwrap_or_default()).clicked();
            }
        });
    });
    let Some(edit) = state.frequencies.as_mut().filter(|edit| edit.number == number) else {
        for frequency in own() {
            let words = format!("{} MHz {}", format::number(frequency.mhz, 3), frequency.name);
            ui.label(RichText::new(words.trim()).font(text::small()).color(t.t1));
        }
        if own().next().is_none() {
            let words = "None: no Doppler shift is shown.";
            ui.label(RichText::new(words).font(text::small()).color(t.t2));
        }
        if is_asked {
            let lines: Vec<String> = own()
                .map(|frequency| {
                    format!("{} {}", frequency.mhz, frequency.name).trim_end().to_owned()
                })
                .collect();
            state.frequencies = Some(Edit { number, text: lines.join("\n") });
        }
        return;
    };
    let field = TextEdit::multiline(&mut edit.text)
        .id_salt("frequencies of the object")
        .hint_text("MHz and a name, one per line")
        .desired_rows(3)
        .desired_width(ui.available_width());
    let response = ui.add(field);
    response.widget_info(|| {
        WidgetInfo::labeled(Role::MultilineTextInput, true, "Frequencies, one per line")
    });
    let lines = edit.text.lines().filter(|line| !line.trim().is_empty());
    let list: Vec<String> = lines.map(|line| format!("{number} {line}")).collect();
    let read = Frequency::read_list(&list.join("\n"));
    let mut is_over = false;
    ui.horizontal(|ui| {
        let save = egui::Button::new("Save frequencies");
        if ui.add_enabled(read.is_ok() && lock.is_none(), save).clicked()
            && let Ok(frequencies) = &read
        {
            let frequencies = frequencies.clone();
            let command = contract::Command::SetFrequencies { satellite: number, frequencies };
            commands.push(UiCommand::Station(command));
            is_over = true;
        }
        is_over |= ui.button("Cancel").clicked();
    });
    if read.is_err() {
        let words = "Each line must be MHz and a name, such as 145.8 Voice.";
        ui.label(RichText::new(words).font(text::small()).color(t.warn));
    }
    if is_over {
        state.frequencies = None;
    }
}
