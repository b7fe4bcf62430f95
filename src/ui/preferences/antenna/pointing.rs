//! The pointing model that fits the record of the antenna, to be filled into the fields.

use egui::{Label, RichText, Ui};

use crate::{
    astro::Term,
    engine::{self, pointing_fit::PointingFitted},
    model::{Model, UiCommand},
    record::{FittedTerm, PointingFit},
    station::{Antenna, AntennaId},
    ui::{
        preferences::{fields::Typed, preview},
        text, theme,
        widgets::told::{self, Tone},
        words::pointing::{fitted_to, pointing_term},
    },
};

/// Shows the fit below the fields of the model. Nothing of it is used before it is saved.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    id: AntennaId,
    antenna: &Antenna,
    commands: &mut Vec<UiCommand>,
) -> Option<PointingFit> {
    ui.add_space(6.0);
    let fitted = model.pointing_fitted.as_deref().filter(|fitted| fitted.antenna == id);
    let is_at_work = fitted.is_some_and(|fitted| fitted.found.is_none());
    let can_fit = model.replay.is_none() && !is_at_work;
    let button = ui.add_enabled(can_fit, egui::Button::new("Fit to recorded passes"));
    if button.on_disabled_hover_text(why_not(is_at_work)).clicked() {
        commands.push(UiCommand::Station(engine::Command::FitPointing(id)));
    }
    let PointingFitted { found, .. } = fitted?;
    match found {
        None => {
            told::line(ui, Tone::Plain, "Reading the record.");
            None
        }
        Some(Err(why)) => {
            told::line(ui, Tone::Bad, &format!("No model: {why}."));
            None
        }
        Some(Ok(fit)) => terms(ui, antenna, fit).then(|| fit.clone()),
    }
}

fn why_not(is_at_work: bool) -> &'static str {
    if is_at_work { "The record is being read." } else { "Not while a replay is shown." }
}

/// Returns `true` if the operator wants the terms in the fields.
fn terms(ui: &mut Ui, antenna: &Antenna, fit: &PointingFit) -> bool {
    let t = theme::tokens(ui);
    let line = |ui: &mut Ui, words: String| {
        let words = RichText::new(words).font(text::small()).color(t.t2);
        ui.add(Label::new(words).wrap());
    };
    line(ui, fitted_to(fit));
    preview::heads(ui);
    for of in &fit.terms {
        let was = written(of.term, antenna.pointing_model.term(of.term));
        let new = of.value.map_or_else(|| "–".to_owned(), |value| written(of.term, value));
        preview::cells(ui, pointing_term(of.term), (was, t.t2), (new, t.t1));
        line(ui, certainty(of));
    }
    ui.button("Fill in").on_hover_text("Nothing is used before you save.").clicked()
}

fn certainty(of: &FittedTerm) -> String {
    match of.half_of_95_percent {
        Some(half) => format!("± {} with 95 % confidence", written(of.term, half)),
        None => {
            let with: Vec<&str> =
                of.not_told_from.iter().map(|term| pointing_term(*term)).collect();
            format!("cannot be told from: {}", with.join(", ").to_lowercase())
        }
    }
}

/// Types the terms into the fields of the model. One that the record cannot tell is zero.
pub(super) fn fill_in(antenna: &mut Typed<Antenna>, fit: &PointingFit) {
    for of in &fit.terms {
        let value = of.value.unwrap_or_default();
        antenna.write(pointing_term(of.term), number(of.term, value));
    }
}

fn written(term: Term, value: f64) -> String {
    let unit = if term == Term::ElevationScale { "°/°" } else { "°" };
    format!("{}{unit}", number(term, value))
}

/// With the digits that an operator can use.
fn number(term: Term, value: f64) -> String {
    let digits = if term == Term::ElevationScale { 6 } else { 4 };
    let number = format!("{value:.digits$}");
    if number.trim_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { number }
}
