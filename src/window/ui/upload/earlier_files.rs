//! Earlier files of the unit, which the operator can restore.

use egui::{RichText, Sense, Ui, vec2};

use super::{chosen::named, form::Form, outcome};
use crate::{
    contract::{
        self,
        transfer::Origin,
        uploads::{Ask, Cargo, KeptEntry, Order},
    },
    model::{Model, UiCommand},
    ui::{
        confirm::Question,
        format, text, theme,
        widgets::{
            card,
            fold::{self, FoldModel},
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

/// Number of hash digits shown to distinguish files.
const HASH_DIGITS: usize = 12;
const TITLE: &str = "Kept on this computer";

pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    antenna: &str,
    form: &mut Form,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let (Ok(unit), Ok(file)) = (form.peer(), form.file_name()) else { return };
    let origin = (unit.to_string(), file.as_str().to_owned());
    let kept_files = &model.uploads.kept_files;
    if kept_files.origin != origin {
        let (unit, file) = origin;
        commands.push(UiCommand::Station(contract::Command::Upload(Ask::ListKept { unit, file })));
        return;
    }
    let t = theme::tokens(ui);
    card::show(ui, f32::INFINITY, |ui| {
        // A closed list leaves the room below to the satellites.
        if let Some(Ok(list)) = &kept_files.list
            && !list.is_empty()
        {
            let size = vec2(ui.available_width(), fold::HEIGHT);
            let (place, _) = ui.allocate_exact_size(size, Sense::hover());
            let value = format::counted(list.len(), "file");
            let head = FoldModel { title: TITLE, value: &value, mark: None };
            fold::show(ui, place, &head, &mut form.kept_is_open);
            let shown = list.iter().enumerate().filter(|_| form.kept_is_open);
            for (index, entry) in shown {
                let order = form.order(antenna, Ok(Cargo::Kept(entry.file.clone())));
                one(ui, model, index, entry, order, question);
            }
            return;
        }
        ui.label(RichText::new(TITLE).font(text::value()));
        match &kept_files.list {
            None => line(ui, Tone::Plain, "The list is being read."),
            Some(Err(problem)) => line(ui, Tone::Bad, &sentence(problem)),
            Some(Ok(_)) => {
                let words = format!(
                    "No earlier copy of {} from {}.",
                    kept_files.origin.1, kept_files.origin.0
                );
                ui.label(RichText::new(words).font(text::small()).color(t.t3));
            }
        }
    });
}

fn one(
    ui: &mut Ui,
    model: &Model,
    index: usize,
    entry: &KeptEntry,
    order: Result<Order, String>,
    question: &mut Option<Question>,
) {
    let t = theme::tokens(ui);
    let file = &entry.file;
    let time_text = format::dated(file.time);
    let origin = match file.origin {
        Origin::Found => "was on the unit",
        Origin::Uploaded => "sent from here",
    };
    if index > 0 {
        ui.separator();
    }
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(&time_text).font(text::body_medium()));
        ui.label(RichText::new(origin).font(text::small()).color(t.t2));
    });
    let hash: String = file.sha256.to_string().chars().take(HASH_DIGITS).collect();
    let words = format!("{hash} {} bytes", file.bytes);
    ui.label(RichText::new(words).font(text::raw()).color(t.t3))
        .on_hover_text(file.sha256.to_string());
    match &entry.objects {
        Ok(objects) if objects.is_empty() => line(ui, Tone::Caution, "No elements in it."),
        Ok(objects) => outcome::objects(ui, objects, model.now),
        Err(problem) => return line(ui, Tone::Bad, &sentence(problem)),
    }
    let can = order.is_ok() && !model.uploads.stage.is_open();
    if named(ui, can, "Put back…", &format!("Put back the file of {time_text}, {origin}, {hash}"))
        && let Ok(order) = order
    {
        let text = format!(
            "Put {} of {time_text} back on {}? It is uploaded, compared and verified like any other.",
            file.file, order.unit
        );
        let begin = Ask::Begin(Box::new(order));
        *question = Some(Question {
            text,
            yes: "Put back",
            command: UiCommand::Station(contract::Command::Upload(begin)),
        });
    }
}
