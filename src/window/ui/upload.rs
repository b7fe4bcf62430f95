//! The upload of elements to a unit: choice of satellites, connection, progress, outcome,
//! and earlier files to restore.

mod chosen;
mod earlier_files;
mod form;
mod outcome;
mod progress;
mod questions;

use std::{
    collections::BTreeMap,
    mem::{self, Discriminant},
};

use egui::{Align, Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use super::{
    confirm::Question,
    icons::{self, Icon},
    text, theme,
    widgets::{
        button::{Button, HEIGHT},
        paint,
        status_line::{Tone, line},
    },
    words::sentence,
};
use crate::{
    contract::{
        self, CatalogState,
        antenna::AntennaModel,
        uploads::{Ask, Cargo, Order, Stage},
    },
    model::{Model, UiCommand},
};
use form::Form;

/// Height of the foot, points: the button, and in two lines the reason why Azel cannot send.
const FOOT: f32 = 80.0;

/// Input and choices for every antenna, by its name. A failure leaves them unchanged.
#[derive(Default)]
pub struct UploadState {
    forms: BTreeMap<String, Form>,
    /// Satellites to choose in the next form.
    choice: Option<Choice>,
    /// The last shown stage; the view scrolls to a new stage.
    stage: Option<Discriminant<Stage>>,
    questions: questions::Questions,
    question: Option<Question>,
}

/// Satellites for the file, by catalog number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choice {
    /// A new list of satellites that replaces the choice.
    These(Vec<u32>),
    /// A satellite to add to the choice.
    Also(u32),
}

impl UploadState {
    /// Chooses satellites for the file.
    pub fn choose(&mut self, choice: Choice) {
        self.choice = Some(choice);
    }
}

/// Draws the upload for the antenna with the index `antenna` into `ui`; the design width is 300 to
/// 560 points. Everything above the button scrolls. Its questions are modal.
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
        let words = format!("{name} stores no elements, so none can be uploaded to it.");
        return line(ui, Tone::Plain, &words);
    };
    let form = state.forms.entry(name.clone()).or_insert_with(|| Form::new(&antenna.config, takes));
    if let Some(choice) = state.choice.take() {
        form.choose(choice, &model.station.favourites.numbers());
    }
    let room = ui.available_rect_before_wrap();
    let (above, foot) = room.split_top_bottom_at_y(room.bottom() - FOOT);
    let order = ui
        .scope_builder(UiBuilder::new().max_rect(above), |ui| {
            let area = ScrollArea::vertical().auto_shrink(false);
            let shown = area.show(ui, |ui| {
                let order = content(ui, model, antenna, state, commands);
                paint::follow_focus(ui);
                order
            });
            shown.inner
        })
        .inner;
    send(ui, foot, model, order.as_ref().map_err(String::as_str), commands);
    Question::show(&mut state.question, ui, commands);
}

/// Shows the scrolling part above the button. Returns the order, or the input that is missing for
/// an order.
fn content(
    ui: &mut Ui,
    model: &Model,
    antenna: &AntennaModel,
    state: &mut UploadState,
    commands: &mut Vec<UiCommand>,
) -> Result<Order, String> {
    let name = &antenna.config.name;
    let Some(form) = state.forms.get_mut(name) else { return Err("there is no form".to_owned()) };
    ui.spacing_mut().item_spacing.y = 6.0;
    ui.label(RichText::new(format!("Upload elements to {name}")).font(text::title()));
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
    if is_open && !is_ours {
        let words =
            format!("An upload to {} is under way. Only one can run at a time.", uploads.antenna);
        line(ui, Tone::Plain, &words);
    }
    form::show(ui, form);
    // The satellites come last, because there may be hundreds.
    earlier_files::show(ui, model, name, form, &mut state.question, commands);
    let file = match &model.catalog {
        CatalogState::Ready(catalog) => {
            let satellite = antenna.snapshot.state.on_board.satellite.as_ref();
            chosen::show(ui, model, catalog, satellite, form);
            form.chosen_file(catalog, &model.station.favourites.numbers())
        }
        CatalogState::Loading | CatalogState::Failed => {
            Err("there are no elements to upload".to_owned())
        }
    };
    if is_ours {
        questions::show(ui, model, &mut state.questions, commands);
    }
    form.order(name, file.map(Cargo::New))
}

/// Shows the send button, and below it the reason why Azel cannot send.
fn send(
    ui: &Ui,
    foot: Rect,
    model: &Model,
    order: Result<&Order, &str>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().hline(foot.x_range(), foot.top() + 0.5, (1.0, t.line));
    let can = order.is_ok() && !model.uploads.stage.is_open();
    let button = Button::primary("Upload and verify").locked(!can);
    let min = foot.min + vec2(0.0, 8.0);
    let place = Rect::from_min_size(min, vec2(button.width(ui), HEIGHT));
    if button.show(ui, "upload", place).clicked()
        && let Ok(order) = order
    {
        let begin = Ask::Begin(Box::new(order.clone()));
        commands.push(UiCommand::Station(contract::Command::Upload(begin)));
    }
    if let Err(problem) = order {
        let words = sentence(problem);
        let position = place.left_bottom() + vec2(20.0, 6.0);
        let glyph = paint::square(position + vec2(-13.0, 8.0), 13.0);
        icons::paint(ui.painter(), glyph, Icon::Warning, t.warn);
        let width = foot.right() - position.x;
        let place = paint::paragraph(ui, position, width, &words, text::small(), t.warn);
        paint::name_text(ui, "no upload", place, &words);
    }
}
