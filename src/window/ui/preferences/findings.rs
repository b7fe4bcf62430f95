//! The card of the invalid fields of a page, with valid examples.

use egui::{RichText, Ui};

use super::{draft::Draft, form, page::Page};
use crate::ui::{
    text,
    widgets::status_line::{self, Tone},
};

pub(super) fn show(ui: &mut Ui, page: Page, draft: &mut Draft) {
    let findings = draft.findings(page);
    let mut duplicate = None;
    form::card(ui, "Validation of this page", |ui| {
        if findings.is_empty() {
            status_line::line(ui, Tone::Good, "All fields are valid.");
        }
        for finding in &findings {
            status_line::line(ui, Tone::Bad, &finding.sentence());
            let Some(would_do) = &finding.problem.would_do else { continue };
            ui.horizontal(|ui| {
                ui.add_space(20.0);
                let words = RichText::new(format!("Use {would_do}")).font(text::body_medium());
                if ui.button(words).clicked() {
                    duplicate = Some((finding.label.clone(), would_do.clone()));
                }
            });
        }
    });
    if let Some((label, text)) = duplicate {
        draft.write(page, &label, text);
    }
}
