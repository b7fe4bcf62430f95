//! Menu of a held set that is not in use: its elements, and how to use it.

use egui::{Grid, Popup, Response, RichText, Ui};
use jiff::Timestamp;

use super::{
    facts, sets,
    words::{self, Form},
};
use crate::{
    contract::{
        Command,
        older_sets::{OlderSet, SetChoice},
    },
    model::{
        Model, UiCommand,
        object_detail::{ObjectDetail, SetShift},
    },
    orbit::Elements,
    ui::{
        confirm::Question,
        format, text, theme,
        widgets::{close_key, menu},
    },
};

/// Width of the menu, points.
const WIDTH: f32 = 320.0;

/// Object whose sets the menu shows.
pub(super) struct Menu<'a> {
    pub(super) model: &'a Model,
    /// Set in use.
    pub(super) elements: &'a Elements,
    /// Newest set; `None` if it is in use.
    pub(super) newest: Option<&'a Elements>,
    pub(super) detail: Option<&'a ObjectDetail>,
}

/// Shows the menu of `shift` while it is open.
pub(super) fn show(
    response: &Response,
    menu: &Menu<'_>,
    shift: &SetShift,
    question: &mut Option<Question>,
) {
    menu::show(
        response,
        Popup::menu(response).width(WIDTH).accessible_name("Menu of the set"),
        |ui| {
            menu.contents(ui, shift, question);
            close_key::show(ui);
        },
    );
}

impl Menu<'_> {
    fn contents(&self, ui: &mut Ui, shift: &SetShift, question: &mut Option<Question>) {
        let t = theme::tokens(ui);
        let OlderSet { elements, source } = &shift.set;
        let title = format!("{}, from {source}", format::minute(elements.epoch(), self.model.now));
        ui.label(RichText::new(title).font(text::body_medium()).color(t.t1));
        Grid::new("figures of the set").num_columns(4).spacing([12.0, 2.0]).show(ui, |ui| {
            for pair in facts::figures(elements).chunks(2) {
                for (name, value) in pair {
                    ui.label(RichText::new(*name).font(text::small()).color(t.t2));
                    ui.label(RichText::new(value).font(text::small()).color(t.t1));
                }
                ui.end_row();
            }
        });
        let lock = words::sources_lock(self.model);
        let word = if self.is_newest(elements.epoch()) {
            "Use the newest set\u{2026}"
        } else {
            "Use this set\u{2026}"
        };
        let entry = ui.add_enabled(lock.is_none(), egui::Button::new(word));
        let entry = entry.on_disabled_hover_text(lock.unwrap_or_default());
        if entry.clicked() {
            *question = Some(self.ask(elements.epoch()));
        }
        for (word, form) in [("Copy as TLE", Form::Tle), ("Copy as OMM, JSON", Form::Omm)] {
            if ui.button(word).clicked() {
                ui.copy_text(words::copied(std::iter::once(elements), form));
            }
        }
    }

    /// Returns the question that offers the set with this epoch.
    pub(super) fn ask(&self, epoch: Timestamp) -> Question {
        let catalog_number = self.elements.catalog_number();
        let (subject, end_text, yes, choice) = if self.is_newest(epoch) {
            let choice = SetChoice::Newest { catalog_number };
            ("newest set", "", "Use the newest", choice)
        } else {
            let end_text = " It stays in use until newer elements arrive or you end it.";
            let choice = SetChoice::Older { catalog_number, epoch };
            ("set", end_text, "Use this set", choice)
        };
        let label = self.elements.label();
        let when = format::minute(epoch, self.model.now);
        let effect = self.effect(epoch);
        Question {
            text: format!("Use the {subject} of {when} for {label}? {effect}{end_text}"),
            yes,
            command: UiCommand::Station(Command::UseSet(choice)),
        }
    }

    fn is_newest(&self, epoch: Timestamp) -> bool {
        self.newest.is_some_and(|newest| newest.epoch() == epoch)
    }

    /// Describes the change that the set of this epoch makes to the next pass.
    fn effect(&self, epoch: Timestamp) -> String {
        let unknown = || "Its effect on the next pass is not known yet.".to_owned();
        let Some(detail) = self.detail else { return unknown() };
        let Some(pass) = detail.passes.first() else {
            return "It changes no pass in the next 7 days.".to_owned();
        };
        let shift = detail.sets.iter().find(|shift| shift.set.elements.epoch() == epoch);
        let Some((shift, deviation)) = shift.and_then(|shift| Some((shift, shift.deviation?)))
        else {
            return unknown();
        };
        let time_text = format::moment(pass.pass.tca.time, self.model.now);
        let angle = format::degrees(deviation.degrees(), 2);
        let beam = self.model.antenna().map_or_else(String::new, |antenna| {
            let half_deg = antenna.config.beam_width_deg / 2.0;
            let side = if deviation.degrees() > half_deg { "more" } else { "less" };
            format!(
                ", {side} than half the beamwidth of {} ({})",
                antenna.config.name,
                format::degrees(half_deg, 2)
            )
        });
        let distance = format!("up to {angle} away from where the set in use puts it{beam}");
        let shifted = match shift.late_s {
            Some(late_s) => {
                let way = if late_s < 0.0 { "earlier" } else { "later" };
                let time = format::number(late_s.abs(), sets::time_decimals(late_s));
                format!("{time} s {way} and {distance}")
            }
            None => format!("{distance}, and predicts no pass at that time"),
        };
        format!("At the next pass, {time_text}, this set puts the satellite {shifted}.")
    }
}
