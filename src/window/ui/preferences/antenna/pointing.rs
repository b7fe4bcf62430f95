//! The pointing model that fits the record of the antenna. The operator can copy it into the
//! fields.

use egui::{Grid, Label, RichText, Ui};

use super::peaks::{self, TypedPeak};
use crate::{
    astro::Term,
    contract,
    contract::record::{FittedTerm, PointingFit, PointingFitted},
    model::{Model, UiCommand},
    station::{Antenna, AntennaId},
    ui::{
        format,
        preferences::fields::Typed,
        replay::LOCKED,
        text, theme,
        widgets::status_line::{self, Tone},
        words::pointing::{fitted_to, pointing_term},
    },
};

/// Min width of a column, points.
const NUMBER: f32 = 80.0;
const UNCERTAIN: &str = "Some terms may as well be zero. Passes at other elevations and azimuths settle them: \
     a model with such terms points worse there.";

/// Shows the fit below the fields of the model. Nothing takes effect before the operator saves it.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    id: AntennaId,
    antenna: &Antenna,
    peak: &mut TypedPeak,
    commands: &mut Vec<UiCommand>,
) -> Option<PointingFit> {
    peaks::show(ui, model, id, peak, commands);
    ui.add_space(6.0);
    let fitted = model.pointing_fitted.as_deref().filter(|fitted| fitted.antenna == id);
    let is_at_work = fitted.is_some_and(|fitted| fitted.found.is_none());
    let can_fit = model.replay.is_none() && !is_at_work;
    let button = ui.add_enabled(can_fit, egui::Button::new("Fit to recorded passes"));
    if button.on_disabled_hover_text(why_not(is_at_work)).clicked() {
        commands.push(fit_without(id, Vec::new()));
    }
    let PointingFitted { found, .. } = fitted?;
    match found {
        None => {
            status_line::line(ui, Tone::Plain, "Reading the record.");
            None
        }
        Some(Err(reason)) => {
            status_line::line(ui, Tone::Bad, &format!("No model: {reason}."));
            None
        }
        Some(Ok(fit)) => match terms(ui, antenna, fit, can_fit)? {
            Wish::FillIn => Some(fit.clone()),
            Wish::FitWithout(terms) => {
                commands.push(fit_without(id, terms));
                None
            }
        },
    }
}

fn fit_without(id: AntennaId, terms: Vec<Term>) -> UiCommand {
    UiCommand::Station(contract::Command::FitPointing(id, terms))
}

/// A request of the operator about a fit.
enum Wish {
    FillIn,
    /// A fit of the same peaks without these terms.
    FitWithout(Vec<Term>),
}

fn why_not(is_at_work: bool) -> &'static str {
    if is_at_work { "The record is being read." } else { LOCKED }
}

fn terms(ui: &mut Ui, antenna: &Antenna, fit: &PointingFit, can_fit: bool) -> Option<Wish> {
    let t = theme::tokens(ui);
    let line = |ui: &mut Ui, words: &str| {
        let words = RichText::new(words).font(text::small()).color(t.t2);
        ui.add(Label::new(words).wrap());
    };
    line(ui, &fitted_to(fit));
    let grid = Grid::new("fitted terms").num_columns(4).min_col_width(NUMBER).striped(false);
    grid.show(ui, |ui| {
        for head in ["Term", "Now", "Fitted", "± (95 %)"] {
            ui.label(RichText::new(head).font(text::small()).color(t.t3));
        }
        ui.end_row();
        for fitted in &fit.terms {
            let now = written(fitted.term, antenna.pointing_model.term(fitted.term));
            let value =
                fitted.value.map_or_else(|| "–".to_owned(), |value| written(fitted.term, value));
            let half = fitted.half_of_95_percent;
            let half = half.map_or_else(|| "–".to_owned(), |half| written(fitted.term, half));
            let colour = if may_be_zero(fitted) { t.warn } else { t.t1 };
            let cells = [
                (pointing_term(fitted.term), t.t2),
                (&*now, t.t2),
                (&*value, t.t1),
                (&*half, colour),
            ];
            for (words, colour) in cells {
                ui.label(RichText::new(words).font(text::small()).color(colour));
            }
            ui.end_row();
        }
    });
    let is_fitted = |fitted: &&FittedTerm| !fit.excluded.contains(&fitted.term);
    for words in fit.terms.iter().filter(is_fitted).filter_map(not_told) {
        line(ui, &words);
    }
    let of_unknown =
        |fitted: &&FittedTerm| fitted.value.is_some() && fitted.half_of_95_percent.is_none();
    let shared = fit.terms.iter().filter(of_unknown).map(|fitted| pointing_term(fitted.term));
    let shared: Vec<&str> = shared.collect();
    if !shared.is_empty() {
        let terms = format::list(&shared);
        line(
            ui,
            &format!(
                "{terms}: may hold a part of what is left at 0, so nothing tells how well they are known."
            ),
        );
    }
    if !fit.excluded.is_empty() {
        let terms: Vec<&str> = fit.excluded.iter().map(|term| pointing_term(*term)).collect();
        line(ui, &format!("Left at 0, as you wanted: {}.", format::list(&terms).to_lowercase()));
    }
    let may_go = without_term(fit);
    if may_go.is_some() {
        status_line::line(ui, Tone::Caution, UNCERTAIN);
    }
    ui.horizontal(|ui| {
        let fill_in = ui.button("Fill in").on_hover_text("Nothing is used before you save.");
        let again = may_go.filter(|_| {
            let button = ui.add_enabled(can_fit, egui::Button::new("Fit without them"));
            let button = button.on_hover_text("Fits again with only the terms that are not zero.");
            button.on_disabled_hover_text(LOCKED).clicked()
        });
        let fill_in = fill_in.clicked().then_some(Wish::FillIn);
        fill_in.or(again.map(Wish::FitWithout))
    })
    .inner
}

/// Returns the terms to exclude so that no remaining term may be zero; `None` if no term may be
/// zero.
fn without_term(fit: &PointingFit) -> Option<Vec<Term>> {
    let zero: Vec<Term> =
        fit.terms.iter().filter(|fitted| may_be_zero(fitted)).map(|fitted| fitted.term).collect();
    (!zero.is_empty()).then(|| [&fit.excluded[..], &zero].concat())
}

/// Returns `true` if a term may be zero. The errors of such terms may cancel each other only in
/// these passes.
fn may_be_zero(fitted: &FittedTerm) -> bool {
    fitted.value.zip(fitted.half_of_95_percent).is_some_and(|(value, half)| value.abs() < half)
}

fn not_told(fitted: &FittedTerm) -> Option<String> {
    if fitted.value.is_some() {
        return None;
    }
    let others: Vec<&str> = fitted.not_told_from.iter().map(|term| pointing_term(*term)).collect();
    let (term, others) = (pointing_term(fitted.term), format::list(&others).to_lowercase());
    Some(format!("{term} cannot be told from {others} in these passes: it is left at 0."))
}

/// Copies the terms into the fields of the model. A term that the record cannot determine becomes
/// zero.
pub(super) fn fill_in(antenna: &mut Typed<Antenna>, fit: &PointingFit) {
    for fitted in &fit.terms {
        let value = fitted.value.unwrap_or_default();
        antenna.type_in(pointing_term(fitted.term), number(fitted.term, value));
    }
}

fn written(term: Term, value: f64) -> String {
    let unit = if term == Term::ElevationScale { "°/°" } else { "°" };
    format!("{}{unit}", number(term, value))
}

/// Formats a value with as many digits as an operator can use.
fn number(term: Term, value: f64) -> String {
    let digits = if term == Term::ElevationScale { 6 } else { 4 };
    let number = format!("{value:.digits$}");
    if number.trim_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { number }
}
