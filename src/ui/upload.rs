//! The upload of elements to a unit: choice of satellites, connection, progress, outcome,
//! and earlier files to restore.

mod chosen;
mod form;
mod kept;
mod outcome;
mod progress;
mod questions;

use std::{
    collections::BTreeMap,
    mem::{self, Discriminant},
};

use egui::{Align, RichText, Ui, vec2};

use super::{
    confirm::Question,
    text,
    widgets::{
        button::{Button, HEIGHT},
        told::{Tone, line},
    },
};
use crate::{
    engine::{
        self, CatalogState,
        uploads::{Ask, Cargo, Order, Stage},
    },
    model::{Model, UiCommand},
};
use form::Form;

/// Input and choices for every antenna, by its name. A failure leaves them as they are.
#[derive(Default)]
pub struct UploadState {
    forms: BTreeMap<String, Form>,
    /// Catalog numbers to choose in the form that is shown next.
    chosen: Option<Vec<u32>>,
    /// The stage that was shown last; a new one is scrolled into sight.
    stage: Option<Discriminant<Stage>>,
    questions: questions::Questions,
    question: Option<Question>,
}

impl UploadState {
    /// Chooses these satellites for the file.
    pub fn choose(&mut self, numbers: Vec<u32>) {
        self.chosen = Some(numbers);
    }
}

/// Draws the upload for the antenna with the index `antenna`, as wide as `ui` and as high as
/// needed; designed for 300 to 560 points. Its questions are modal.
pub fn show(
    ui: &mut Ui,
    model: &Model,
    antenna: usize,
    state: &mut UploadState,
    commands: &mut Vec<UiCommand>,
) {
    let Some(antenna) = model.antennas.get(antenna) else {
        ui.label(RichText::new("There is no antenna.").font(text::body()));
        return;
    };
    let name = &antenna.config.name;
    let Some(takes) = antenna.spec().element_files else {
        let words = format!("{name} holds no elements: none are uploaded to it.");
        return line(ui, Tone::Plain, &words);
    };
    let form = state.forms.entry(name.clone()).or_insert_with(|| Form::of(&antenna.config, takes));
    if let Some(numbers) = state.chosen.take() {
        form.numbers = Some(numbers);
    }
    ui.spacing_mut().item_spacing.y = 6.0;
    ui.label(RichText::new(format!("Elements to {name}")).font(text::title()));
    let uploads = &model.uploads;
    let (is_ours, is_open) = (uploads.antenna == *name, uploads.stage.is_open());
    if is_ours && uploads.stage != Stage::Idle {
        let stage = Some(mem::discriminant(&uploads.stage));
        if mem::replace(&mut state.stage, stage) != stage {
            ui.scroll_to_cursor(Some(Align::BOTTOM));
        }
        progress::show(ui, model, commands);
        outcome::show(ui, model, &mut state.question, commands);
    }
    let file = match &model.catalog {
        CatalogState::Ready(catalog) => {
            let held = antenna.snapshot.state.on_board.satellite.as_ref();
            chosen::show(ui, model, catalog, held.filter(|held| held.catalog_number > 0), form);
            form.chosen_file(catalog, &model.station.favourites.numbers())
        }
        CatalogState::Loading | CatalogState::Failed => Err("there are no elements".to_owned()),
    };
    form::show(ui, form);
    let order = form.order(name, file.map(Cargo::New));
    send(ui, model, order.as_ref().map_err(String::as_str), commands);
    if is_open && !is_ours {
        let words = format!("Files are on their way to {}. One at a time.", uploads.antenna);
        line(ui, Tone::Plain, &words);
    }
    kept::show(ui, model, name, form, &mut state.question, commands);
    if is_ours {
        questions::show(ui, model, &mut state.questions, commands);
    }
    Question::show(&mut state.question, ui, commands);
}

/// Shows the send button, and below it the reason why nothing can be sent.
fn send(ui: &mut Ui, model: &Model, order: Result<&Order, &str>, commands: &mut Vec<UiCommand>) {
    let can = order.is_ok() && !model.uploads.stage.is_open();
    let button = Button::primary("Upload and prove").locked(!can);
    let (_, place) = ui.allocate_space(vec2(button.width(ui), HEIGHT));
    if button.show(ui, "upload", place).clicked()
        && let Ok(order) = order
    {
        let begin = Ask::Begin(Box::new(order.clone()));
        commands.push(UiCommand::Station(engine::Command::Upload(begin)));
    }
    if let Err(problem) = order {
        line(ui, Tone::Caution, &format!("Not to be sent yet: {problem}."));
    }
}
