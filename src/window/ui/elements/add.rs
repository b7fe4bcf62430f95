//! The form for a new source.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
};

use egui::{Button, Key, Response, RichText, Role, Sense, Ui, WidgetInfo, vec2};

use crate::{
    contract,
    contract::sources::{Sources, check_source},
    model::{UiCommand, typed_path::OpenedFile},
    orbit::{Source, SourcePlace},
    ui::{
        text, theme,
        widgets::{
            form::{ROW, text_field},
            segmented,
        },
        words::sentence,
    },
};

const LABEL: f32 = 72.0;
/// Width that a field leaves free beside its label, points.
const MARGIN: f32 = 24.0;
const NAME: f32 = 240.0;
const KINDS: f32 = 320.0;
/// Commonly used groups of `CelesTrak`.
const GROUPS: [&str; 8] =
    ["active", "stations", "weather", "resource", "science", "amateur", "cubesat", "geo"];

#[derive(Default)]
pub(in crate::ui) struct AddState {
    kind: Kind,
    name: String,
    place: String,
    /// Source that the form requested last.
    requested: Option<Source>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Kind {
    #[default]
    Web,
    File,
    Folder,
    SpaceTrack,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::Web => "Server",
            Self::File => "File",
            Self::Folder => "Folder",
            Self::SpaceTrack => "Space-Track",
        }
    }
}

impl AddState {
    fn source(&self) -> Source {
        let place = self.place.trim();
        let place = match self.kind {
            Kind::Web => SourcePlace::Web(place.to_owned()),
            Kind::File => SourcePlace::File(PathBuf::from(place)),
            Kind::Folder => SourcePlace::Folder(PathBuf::from(place)),
            Kind::SpaceTrack => SourcePlace::SpaceTrack(place.to_owned()),
        };
        let name = match self.name.trim() {
            "" => self.suggested_name(),
            typed => typed.to_owned(),
        };
        Source { name, place, refresh: None }
    }

    /// Returns the name of a source without a typed one: the name of its file, folder or server.
    fn suggested_name(&self) -> String {
        let place = self.place.trim();
        let path = Path::new(place);
        let name = match self.kind {
            Kind::Web => place.split_once("://").and_then(|(_, rest)| rest.split('/').next()),
            Kind::File => path.file_stem().and_then(OsStr::to_str),
            Kind::Folder => path.file_name().and_then(OsStr::to_str),
            Kind::SpaceTrack if place.is_empty() => None,
            Kind::SpaceTrack => Some("Space-Track"),
        };
        name.unwrap_or_default().to_owned()
    }

    /// Returns `true` if the operator has typed nothing.
    pub(in crate::ui) fn is_empty(&self) -> bool {
        self.name.trim().is_empty() && self.place.trim().is_empty()
    }

    /// Returns `true` if the operator has typed a source that the form has not requested.
    pub(in crate::ui) fn is_edited(&self) -> bool {
        !self.is_empty() && self.requested.as_ref() != Some(&self.source())
    }

    /// Returns the typed source that is not requested yet, or the reason why it cannot be added.
    /// Returns `None` for an empty form.
    pub(in crate::ui) fn typed(&self, sources: &Sources) -> Option<Result<Source, String>> {
        let source = self.source();
        // A requested source stays in the form until the list holds it.
        let is_requested = self.requested.as_ref() == Some(&source) && sources.problems.is_empty();
        if self.is_empty() || is_requested {
            return None;
        }
        let reason = match check_source(&source, &sources.list) {
            Err(problem) => problem.to_string(),
            Ok(()) if sources.is_locked => "the list of sources cannot be read".to_owned(),
            Ok(()) if !sources.is_free() => "wait until the other sources are read".to_owned(),
            Ok(()) => return Some(Ok(source)),
        };
        Some(Err(reason))
    }

    /// Requests the typed `source`.
    pub(in crate::ui) fn add(&mut self, source: Source, commands: &mut Vec<UiCommand>) {
        self.requested = Some(source.clone());
        commands.push(UiCommand::Station(contract::Command::AddSource(source)));
    }

    /// Clears the form once the source is in the list; returns `true` then.
    pub(super) fn forget_the_added(&mut self, sources: &Sources) -> bool {
        let is_added =
            self.requested.as_ref().is_some_and(|requested| sources.list.contains(requested));
        if is_added {
            *self = Self { kind: self.kind, ..Self::default() };
        }
        is_added
    }
}

/// Shows the form. Enter in one of its fields adds the source, like its button.
pub(in crate::ui) fn show(
    ui: &mut Ui,
    sources: &Sources,
    state: &mut AddState,
    commands: &mut Vec<UiCommand>,
) {
    state.forget_the_added(sources);
    let t = theme::tokens(ui);
    ui.vertical(|ui| {
        ui.label(RichText::new("Add a source").font(text::value()));
        ui.horizontal(|ui| {
            if ui.button("Choose files…").clicked() {
                commands.push(UiCommand::ChooseFile(OpenedFile::Elements));
                ui.close();
            }
            let words = "or drop files on this view, or paste elements with Ctrl V";
            ui.label(RichText::new(words).font(text::body()).color(t.t2));
        });
        kinds(ui, state);
        if state.kind == Kind::Web {
            suggestions(ui, sources, state);
        }
        let place = match state.kind {
            Kind::Web => ("Address", "https://…"),
            Kind::File => ("Path", "/… or C:\\…"),
            Kind::Folder => ("Path", "/… or C:\\…, all element files in it"),
            Kind::SpaceTrack => ("Log-in", "the name of your account at space-track.org"),
        };
        let suggested = state.suggested_name();
        let name_hint =
            if suggested.is_empty() { "also the name of the group" } else { suggested.as_str() };
        let room = ui.available_width() - LABEL - MARGIN;
        let fields = [
            text_field(ui, ("Name", name_hint), [LABEL, room.min(NAME)], &mut state.name),
            text_field(ui, place, [LABEL, room], &mut state.place),
        ];
        if state.kind == Kind::SpaceTrack {
            let words =
                "Azel asks for your favourites. After Add, enter the password with Password.";
            ui.label(RichText::new(words).font(text::small()).color(t.t2));
        }
        let typed = state.typed(sources);
        let entered = fields.into_iter().find(Response::lost_focus);
        let entered = entered.filter(|_| ui.input(|input| input.key_pressed(Key::Enter)));
        ui.horizontal(|ui| {
            let is_pressed = named_button(ui, matches!(typed, Some(Ok(_))), "Add", "Add source");
            match typed {
                Some(Ok(source)) if is_pressed || entered.is_some() => state.add(source, commands),
                Some(Err(reason)) => {
                    let words = sentence(&reason);
                    ui.label(RichText::new(words).font(text::body()).color(t.warn));
                    if let Some(field) = entered {
                        field.request_focus();
                    }
                }
                Some(Ok(_)) | None => {}
            }
        });
    });
}

/// Shows the choice of the kind of source.
fn kinds(ui: &mut Ui, state: &mut AddState) {
    let kinds = [Kind::Web, Kind::File, Kind::Folder, Kind::SpaceTrack];
    let (place, _) = ui.allocate_exact_size(vec2(KINDS, ROW), Sense::hover());
    let kinds = kinds.map(|kind| (kind.word(), kind));
    segmented::choose(ui, "kind", place, "Kind of source", &kinds, &mut state.kind);
}

fn suggestions(ui: &mut Ui, sources: &Sources, state: &mut AddState) {
    let t = theme::tokens(ui);
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("CelesTrak").font(text::body()).color(t.t2));
        for group in GROUPS {
            let name = format!("CelesTrak {group}");
            suggestion(ui, sources, state, (group, &name), Source::celestrak(group));
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Others").font(text::body()).color(t.t2));
        suggestion(ui, sources, state, ("SatNOGS", "SatNOGS"), Source::satnogs());
    });
}

/// Shows a button that fills the form with `source`.
fn suggestion(
    ui: &mut Ui,
    sources: &Sources,
    state: &mut AddState,
    (word, name): (&str, &str),
    source: Source,
) {
    let is_known = sources.list.iter().any(|other| other.name == source.name);
    if named_button(ui, !is_known, word, name) {
        state.name = source.name;
        if let SourcePlace::Web(url) = source.place {
            state.place = url;
        }
    }
}

/// Shows a button with a longer accessible name; returns `true` after a click.
fn named_button(ui: &mut Ui, enabled: bool, word: &str, name: &str) -> bool {
    let response = ui.add_enabled(enabled, Button::new(word));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, name));
    response.clicked()
}
