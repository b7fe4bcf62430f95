//! The outcome of an upload.

use egui::{Frame, Margin, RichText, Stroke, Ui};
use jiff::Timestamp;

use crate::{
    astro::time::seconds_between,
    contract::{
        self,
        transfer::{FileObject, Uploaded},
        uploads::{Ask, Failure, Proved, Stage, Warning},
    },
    model::{Model, UiCommand},
    ui::{
        confirm::Question,
        dialogs, format, text, theme,
        widgets::status_line::{Tone, fact, line},
        words::{OLD_ELEMENTS_S, old_algorithms, sentence},
    },
};

/// Max number of objects of a file listed with their ages.
const LISTED: usize = 20;

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (ground, edge) = match &model.uploads.stage {
        Stage::Proved(_) => (t.okbg, t.ok),
        Stage::Failed(failure) if failure.is_cancel => (t.warnbg, t.warn),
        Stage::Failed(_) => (t.badbg, t.bad),
        _ => return warnings(ui, model),
    };
    Frame::new()
        .fill(ground)
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(6)
        .inner_margin(Margin::same(12))
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            match &model.uploads.stage {
                Stage::Proved(proved) => self::proved(ui, model, proved),
                Stage::Failed(failure) => failed(ui, model, failure, question),
                _ => {}
            }
            warnings(ui, model);
            if ui.button("Close").clicked() {
                commands.push(UiCommand::Station(contract::Command::Upload(Ask::Dismiss)));
            }
        });
    ui.add_space(4.0);
}

fn proved(ui: &mut Ui, model: &Model, proved: &Proved) {
    let subject = if model.uploads.is_roll_back { "Rolled back and verified" } else { "Verified" };
    let words = format!("{subject} {}", format::moment(proved.time, model.now));
    line(ui, Tone::Good, &words);
    let satellite = &proved.satellite;
    let words = format!(
        "The unit uses {} and has found {} ({}) in it.",
        proved.uploaded.file.as_str(),
        satellite.name,
        satellite.catalog_number
    );
    line(ui, Tone::Plain, &words);
    let oldest_s = proved.uploaded.oldest_age_s(model.now).unwrap_or_default();
    if oldest_s > OLD_ELEMENTS_S {
        let words = format!("The oldest elements in it are {} old.", format::age(oldest_s));
        line(ui, Tone::Caution, &words);
    }
    file(ui, &proved.uploaded);
    objects(ui, &proved.uploaded.objects, model.now);
}

fn failed(ui: &mut Ui, model: &Model, failure: &Failure, question: &mut Option<Question>) {
    let tone = if failure.is_cancel { Tone::Caution } else { Tone::Bad };
    match (&failure.changed_key, &failure.uploaded) {
        (Some(key), _) => {
            let forget = UiCommand::Station(contract::Command::Upload(Ask::ForgetHostKey));
            dialogs::changed_key(ui, key, forget, question);
        }
        (None, None) => line(ui, tone, &sentence(&failure.text)),
        (None, Some(uploaded)) => {
            line(ui, tone, &format!("Not in use: {}", sentence(&failure.text)));
            let words = "The new file is on the unit, read back and compared. Upload again, or \
                         put an old file back.";
            line(ui, Tone::Plain, words);
            file(ui, uploaded);
            objects(ui, &uploaded.objects, model.now);
        }
    }
}

fn file(ui: &mut Ui, uploaded: &Uploaded) {
    fact(ui, "File", &format!("{}, {} bytes", uploaded.file.as_str(), uploaded.bytes));
    fact(ui, "Unit", &uploaded.unit.to_string());
    let time_text = format::dated(uploaded.time);
    fact(ui, "Read back", &time_text);
    fact(ui, "SHA-256", &uploaded.sha256.to_string());
}

/// Shows the age of each object's elements.
pub(super) fn objects(ui: &mut Ui, objects: &[FileObject], now: Timestamp) {
    let t = theme::tokens(ui);
    let one = |object: &FileObject| {
        let age = format::age(seconds_between(object.epoch, now));
        format!("{} {} old", object.name, age)
    };
    let mut words: Vec<String> = objects.iter().take(LISTED).map(one).collect();
    if objects.len() > LISTED {
        words.push(format!("and {} more", objects.len() - LISTED));
    }
    let words = words.join(" · ");
    ui.add(egui::Label::new(RichText::new(words).font(text::small()).color(t.t2)).wrap());
}

fn warnings(ui: &mut Ui, model: &Model) {
    for warning in &model.uploads.warnings {
        let words = match warning {
            Warning::FactoryPassword => {
                "This is the factory password of every unit, printed in the protocol document: \
                 change it."
                    .to_owned()
            }
            Warning::NotKept(problem) => format!("The password was not kept: {problem}."),
            Warning::OldAlgorithms(list) => match old_algorithms(list) {
                Some(words) => words,
                None => continue,
            },
        };
        line(ui, Tone::Caution, &words);
    }
}
