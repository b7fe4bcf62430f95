//! The dialog that compares a unit's settings with a file, and takes chosen values over
//! into the form.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use egui::{Align, Grid, Layout, RichText, ScrollArea, TextEdit, Ui};

use super::{
    format, text, theme,
    widgets::{check_box::CheckBox, modal::modal},
};
use crate::{
    contract::{self, antenna::AntennaModel, copies::OpenCopy},
    device::settings::{Difference, Field, Group, SettingsCopy, Value, Verdict},
    model::UiCommand,
};

/// Width of the dialog if the window has room for it, points.
const WIDTH: f32 = 760.0;
/// Max height of the table before it scrolls, points.
const TABLE: f32 = 320.0;

/// Typed path and chosen values.
#[derive(Debug, Default)]
pub struct CompareState {
    path: String,
    chosen: BTreeSet<(&'static str, &'static str)>,
}

/// A value that the operator takes over from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct CopiedValues {
    /// Key of the group.
    pub group: &'static str,
    /// Key of the field.
    pub field: &'static str,
    pub value: Value,
}

/// Shows the dialog for `antenna`. Returns the values in the frame in which the operator takes them
/// over.
pub fn show(
    ui: &Ui,
    antenna: &AntennaModel,
    open: &OpenCopy,
    state: &mut CompareState,
    commands: &mut Vec<UiCommand>,
) -> Vec<CopiedValues> {
    let mut entries = Vec::new();
    let mut closed = false;
    let room = ui.ctx().content_rect().width() - 64.0;
    let modal = modal(ui, "compare settings").show(ui.ctx(), |ui| {
        ui.set_width(WIDTH.min(room));
        let title = format!("Compare the settings of {} with a file", open.antenna);
        ui.label(RichText::new(title).font(text::value()));
        let read = choose(ui, open, state);
        if let Some(path) = read {
            state.chosen.clear();
            let antenna = antenna.id();
            commands.push(UiCommand::Station(contract::Command::ReadCopy { antenna, path }));
        }
        match &open.read {
            None => {}
            Some((path, Err(reason))) => problem(ui, path, reason),
            Some((_, Ok(copy))) => entries = compared(ui, copy, antenna, state),
        }
        closed = !entries.is_empty() || ui.button("Close").clicked();
    });
    if closed || modal.should_close() {
        *state = CompareState::default();
        commands.push(UiCommand::Station(contract::Command::CloseCopy));
    }
    entries
}

/// Shows the existing copies and a field for another path. Returns the path to read.
fn choose(ui: &mut Ui, open: &OpenCopy, state: &mut CompareState) -> Option<PathBuf> {
    let t = theme::tokens(ui);
    let mut read = None;
    if open.listed.is_empty() {
        let words = "No settings of this antenna have been saved on this computer yet.";
        ui.label(RichText::new(words).font(text::body()).color(t.t2));
    }
    ScrollArea::vertical().id_salt("copies").max_height(96.0).show(ui, |ui| {
        for path in &open.listed {
            if ui.link(file_name(path)).clicked() {
                read = Some(path.clone());
            }
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label(RichText::new("Path").font(text::body()).color(t.t2)).id;
        let width = ui.available_width() - 80.0;
        let edit = TextEdit::singleline(&mut state.path).desired_width(width);
        ui.add(edit).labelled_by(label);
        let path = state.path.trim();
        if ui.add_enabled(!path.is_empty(), egui::Button::new("Read")).clicked() {
            read = Some(PathBuf::from(path));
        }
    });
    read
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn problem(ui: &mut Ui, path: &Path, reason: &str) {
    let t = theme::tokens(ui);
    let words = format!("{}: {reason}.", file_name(path));
    ui.label(RichText::new(words).font(text::body()).color(t.bad));
}

fn compared(
    ui: &mut Ui,
    copy: &SettingsCopy,
    antenna: &AntennaModel,
    state: &mut CompareState,
) -> Vec<CopiedValues> {
    let t = theme::tokens(ui);
    let head = &copy.head;
    let words = format!(
        "Copy of {} at {}, saved {}.",
        head.antenna,
        head.address,
        format::dated(head.saved_at)
    );
    ui.label(RichText::new(words).font(text::small()).color(t.t2));
    if !copy.unknown.is_empty() {
        let words = format!("Unknown settings, left out: {}.", copy.unknown.join(", "));
        ui.label(RichText::new(words).font(text::small()).color(t.warn));
    }
    let differences = copy.differences(antenna.groups(), &antenna.snapshot.state.groups);
    if differences.is_empty() {
        let words = "The unit already holds every value in the file.";
        ui.label(RichText::new(words).font(text::body()).color(t.ok));
        return Vec::new();
    }
    ScrollArea::vertical().id_salt("differences").max_height(TABLE).show(ui, |ui| {
        Grid::new("differences").num_columns(4).striped(true).show(ui, |ui| {
            for head in ["Setting", "In the file", "On the unit", ""] {
                ui.label(RichText::new(head).font(text::caption()).color(t.t3));
            }
            ui.end_row();
            for difference in &differences {
                row(ui, difference, state);
                ui.end_row();
            }
        });
    });
    let mut entries = Vec::new();
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let chosen: Vec<_> = differences.iter().filter_map(|entry| chosen(entry, state)).collect();
        let word = format!("Copy {} to the form", chosen.len());
        if ui.add_enabled(!chosen.is_empty(), egui::Button::new(word)).clicked() {
            entries = chosen;
        }
        let words = "They become edits in the form; Apply sends them.";
        ui.label(RichText::new(words).font(text::small()).color(t.t2));
    });
    entries
}

fn chosen(difference: &Difference, state: &CompareState) -> Option<CopiedValues> {
    let (group, field) = (difference.group.key, difference.field.key);
    let value = difference.copied.as_ref().ok()?;
    (difference.verdict == Verdict::Free && state.chosen.contains(&(group, field)))
        .then(|| CopiedValues { group, field, value: value.clone() })
}

fn row(ui: &mut Ui, difference: &Difference, state: &mut CompareState) {
    let t = theme::tokens(ui);
    let (group, field) = (difference.group, difference.field);
    let name = format!("{}, {}", group.title, field.label);
    let key = (group.key, field.key);
    let is_free = difference.verdict == Verdict::Free;
    let mut is_chosen = is_free && state.chosen.contains(&key);
    let check = ui.add_enabled(is_free, CheckBox::new(&mut is_chosen, &name));
    if check.clicked() {
        if is_chosen {
            state.chosen.insert(key)
        } else {
            state.chosen.remove(&key)
        };
    }
    let words = |value: Option<&Value>| value.map_or("–".to_owned(), |value| shown(field, value));
    let in_file = words(difference.copied.as_ref().ok());
    let on_unit = words(difference.current.as_ref());
    ui.label(RichText::new(in_file).font(text::body()));
    ui.label(RichText::new(on_unit).font(text::body()).color(t.t2));
    ui.label(RichText::new(verdict(group, difference)).font(text::small()).color(t.t3));
}

fn shown(field: &Field, value: &Value) -> String {
    let gap = if field.unit.is_empty() || field.unit == "°" { "" } else { " " };
    format!("{}{gap}{}", field.kind.text(value), field.unit)
}

fn verdict(group: &Group, difference: &Difference) -> String {
    match (difference.verdict, &difference.copied) {
        (Verdict::Unfit, Err(reason)) => format!("cannot be used: {reason}"),
        (Verdict::Service, _) => "service setting, only shown".to_owned(),
        (Verdict::NotRead, _) => format!("{} was not read from the unit", group.title),
        _ => String::new(),
    }
}
