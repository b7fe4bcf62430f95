//! The set-up step for the elements: the elements in use, and the form for a source.

use egui::{RichText, Ui};

use super::draft::SetupDraft;
use crate::{
    contract::sources::SourceWork,
    model::{Model, UiCommand},
    ui::{
        elements::{AddState, add_source, source_words},
        text, theme,
        widgets::{card, status_line::line},
        words::sentence,
    },
};

const CARD: f32 = 638.0;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    draft: &SetupDraft,
    state: &mut AddState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (tone, words) = super::so_far::elements(model, draft);
    card::show(ui, CARD, |ui| {
        ui.label(RichText::new("In use").font(text::value()));
        line(ui, tone, &format!("{}.", crate::ui::words::capitalised(&words)));
        for (index, source) in model.sources.list.iter().enumerate() {
            ui.label(RichText::new(&source.name).font(text::body_medium()).color(t.t1));
            for (tone, words) in source_words(source, model.sources.reports.get(index), model.now) {
                line(ui, tone, &words);
            }
        }
        let work = match model.sources.work {
            SourceWork::Reading => "The sources are being read.",
            SourceWork::Asking => "The servers are being asked. You can continue meanwhile.",
            SourceWork::Nothing => "",
        };
        if !work.is_empty() {
            ui.label(RichText::new(work).font(text::body()).color(t.t2));
        }
        for problem in &model.sources.problems {
            ui.label(RichText::new(sentence(problem)).font(text::body()).color(t.bad));
        }
    });
    card::show(ui, CARD, |ui| {
        add_source(ui, &model.sources, state, commands);
        if let Some(Ok(_)) = state.typed(&model.sources) {
            let words = "Enter adds the source. Press Enter again to continue.";
            ui.label(RichText::new(words).font(text::small()).color(t.t2));
        }
    });
}
