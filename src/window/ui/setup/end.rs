//! The last step of the set-up: the file to write, and the effects of writing it.

use egui::{RichText, Ui};

use super::{SetupState, draft::SetupDraft, so_far};
use crate::{
    model::Model,
    ui::{
        format, text,
        widgets::{
            card,
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

const CARD: f32 = 638.0;

pub(super) fn show(ui: &mut Ui, model: &Model, draft: &SetupDraft, state: &SetupState) {
    let name = draft.site().map(|(name, _)| name);
    card::show(ui, CARD, |ui| {
        let title = name.as_deref().unwrap_or("Your station");
        ui.label(RichText::new(title).font(text::value()));
        for part in so_far::parts(model, draft, state.progress) {
            line(ui, part.tone, &format!("{}: {}", part.name, part.state));
        }
    });
    card::show(ui, CARD, |ui| {
        ui.label(RichText::new("When you finish").font(text::value()));
        line(ui, Tone::Good, "The station file is written.");
        line(ui, Tone::Good, "The demo station ends with its simulated antennas.");
        for words in links(draft) {
            line(ui, Tone::Good, &words);
        }
        line(ui, Tone::Good, "Operate opens with the next pass selected.");
    });
    if state.add.typed(&model.sources).is_some() {
        let words = "A source is typed but not added, and Finish drops it. Go back to Elements to add \
                     it.";
        line(ui, Tone::Caution, words);
    }
    if let Some(problem) = &state.problem {
        line(ui, Tone::Bad, &format!("Not saved: {}", sentence(problem)));
    }
}

/// Returns sentences about the links to the antennas: links that Azel opens, and links that wait
/// for Connect.
fn links(draft: &SetupDraft) -> Vec<String> {
    let (mut opened, mut waiting) = (Vec::new(), Vec::new());
    for (index, antenna) in draft.form.antennas.iter().enumerate() {
        let waits = antenna.read().0.connection.variant().capabilities.waits_for_word;
        let list = if waits { &mut waiting } else { &mut opened };
        list.push(draft.antenna_name(index));
    }
    let mut words = Vec::new();
    if !opened.is_empty() {
        let names = format::list(&opened);
        words.push(format!("Azel opens the links to {names}. That moves nothing."));
    }
    if !waiting.is_empty() {
        let names = format::list(&waiting);
        words.push(format!("{names}: left alone until you press Connect on the antenna's card."));
    }
    if words.is_empty() {
        words.push("Azel predicts passes. Preferences can add antennas.".to_owned());
    }
    words
}
