//! Dialogs of a change to another station.

use egui::{Key, RichText, Ui};

use crate::{
    model::{Model, UiCommand},
    ui::{
        text,
        widgets::{
            modal::modal,
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

const WIDTH: f32 = 440.0;

pub fn show(ui: &Ui, model: &Model, commands: &mut Vec<UiCommand>) {
    if model.stations.is_changing {
        under_way(ui, model);
    } else if let Some(reason) = &model.stations.refused {
        refused(ui, model, reason, commands);
    }
}

/// Shows the change to another station, during which the operator can only press STOP.
fn under_way(ui: &Ui, model: &Model) {
    modal(ui, "changing").show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        let next = model.stations.next.as_deref().unwrap_or_default();
        ui.label(RichText::new(format!("Changing to {next}")).font(text::value()));
        line(ui, Tone::Now, &format!("{} disconnects from its antennas.", model.station.name));
    });
}

fn refused(ui: &Ui, model: &Model, reason: &str, commands: &mut Vec<UiCommand>) {
    let modal = modal(ui, "not opened").show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        ui.label(RichText::new("The station was not opened").font(text::value()));
        line(ui, Tone::Bad, &sentence(reason));
        line(ui, Tone::Plain, &format!("{} stays as it is.", model.station.name));
        ui.add_space(4.0);
        ui.button("Close (Enter)").clicked() || ui.input(|input| input.key_pressed(Key::Enter))
    });
    if modal.inner || modal.should_close() {
        commands.push(UiCommand::KeepStation);
    }
}
