//! The whole window: the permanent parts, and the view that fills the rest.

use std::path::PathBuf;

use egui::{Rect, Ui, UiBuilder, pos2};
use jiff::Timestamp;

use super::{
    antennas,
    banner::{self, BannerRoom},
    bar,
    confirm::Question,
    console,
    dialogs::{
        PathDialog, changing,
        closing::{self, ClosingDialog},
    },
    elements,
    icons::Icon,
    keys::{self, KeyTargets},
    map::{self, MapLayers},
    notes::Notes,
    operate,
    pass_list::Arrangement,
    plan, preferences,
    rail::{self, RailEntry},
    record, replay, second_step, setup,
    sky_plot::Layers,
    timeline::Zoom,
    top_bar,
    upload::{self, UploadState},
    words,
};
use crate::{
    contract::{self, closing::CloseHow, driver::Command},
    model::{MaskNews, Model, UiCommand, View, export::SavedFile, typed_path::PathRequest},
};

/// Input, open parts and folds of all views.
#[derive(Default)]
pub struct Views {
    operate: operate::OperateState,
    elements: elements::ElementsState,
    antennas: antennas::AntennasState,
    console: console::ConsoleState,
    map: map::MapState,
    plan: plan::PlanState,
    record: record::RecordState,
    preferences: preferences::PreferencesState,
    setup: setup::SetupState,
    upload: UploadState,
    question: Option<Question>,
    closing: Option<ClosingDialog>,
    path_dialog: Option<PathDialog>,
    notes: Notes,
    banner: BannerRoom,
    keys_open: bool,
}

/// State of the views kept from one start to the next.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StoredViews {
    /// `true` if the travel gauges are unfolded in a low window.
    pub travel_open: bool,
    /// `true` if the checks are unfolded in a low window.
    pub faults_open: bool,
    /// Number of hours in the timeline; `None` for the default.
    pub strip_hours: Option<u32>,
    /// Width of the pass list, points; `None` for the default.
    pub list_width: Option<u32>,
    /// Order and filters of the pass list.
    pub passes: Arrangement,
    /// Layers of the sky plot.
    pub layers: Layers,
    /// Layers of the map.
    pub map_layers: MapLayers,
}

impl Views {
    /// Creates the views from the stored state.
    pub fn new(stored: StoredViews) -> Self {
        let mut views = Self::default();
        let operate = &mut views.operate;
        operate.card.travel_open = stored.travel_open;
        operate.card.faults_open = stored.faults_open;
        operate.zoom = Zoom::new(stored.strip_hours);
        operate.list_width = stored.list_width;
        operate.passes.filter.arrangement = stored.passes;
        operate.sky.layers = stored.layers;
        views.map.layers = stored.map_layers;
        views
    }

    /// Returns the state to store.
    pub fn stored(&self) -> StoredViews {
        StoredViews {
            travel_open: self.operate.card.travel_open,
            faults_open: self.operate.card.faults_open,
            strip_hours: self.operate.zoom.requested(),
            list_width: self.operate.list_width,
            passes: self.operate.passes.filter.arrangement.clone(),
            layers: self.operate.sky.layers,
            map_layers: self.map.layers,
        }
    }

    /// Draws the whole window and collects the operator's commands.
    pub fn show(&mut self, ui: &mut Ui, model: &Model, commands: &mut Vec<UiCommand>) {
        self.show_below_bar_of(model, ui, model, commands);
    }

    /// Draws the window for the replay in `model`. The bar with STOP stays live, and the window
    /// refuses commands that act.
    pub fn show_replay(
        &mut self,
        ui: &mut Ui,
        live: &Model,
        model: &Model,
        commands: &mut Vec<UiCommand>,
    ) {
        let window = ui.max_rect();
        self.show_below_bar_of(live, ui, model, commands);
        replay::frame(ui, window.with_min_y(window.top() + top_bar::height(window.height())));
    }

    fn show_below_bar_of(
        &mut self,
        live: &Model,
        ui: &mut Ui,
        model: &Model,
        commands: &mut Vec<UiCommand>,
    ) {
        let (window, before) = (ui.max_rect(), commands.len());
        let top = window.with_max_y(window.top() + top_bar::height(window.height()));
        bar::show(ui, top, live, commands);
        let mut targets = KeyTargets {
            question: &mut self.question,
            operate: &mut self.operate,
            elements: &mut self.elements,
            console: &mut self.console,
            map: &mut self.map,
            plan: &mut self.plan,
            record: &mut self.record,
            preferences: &mut self.preferences,
            list_open: &mut self.keys_open,
        };
        keys::take(ui, model, &mut targets, commands);

        self.antennas.watch(model);
        let mut body = window.with_min_y(top.bottom());
        let is_low = window.height() < top_bar::SMALL_BELOW;
        let has_banner = self.banner.is_taken(model);
        self.operate.has_banner = has_banner;
        if has_banner && !is_low {
            let strip = body.with_max_y(body.top() + banner::height(model));
            banner::show(ui, strip, model, commands);
            body = body.with_min_y(strip.bottom());
        }
        let side = body.with_max_x(body.left() + rail::width(window.width()));
        self.keys_open |= show_rail(ui, side, model, self.antennas.edited(model), commands);
        let mut rest = Rect::from_min_max(pos2(side.right(), body.top()), body.max);
        // In a low window the antenna card needs the whole height, so Operate has the strip next to
        // it.
        if has_banner && is_low && model.view != View::Operate {
            let strip = rest.with_max_y(rest.top() + banner::LOW_HEIGHT);
            banner::show(ui, strip, model, commands);
            rest = rest.with_min_y(strip.bottom());
        }
        self.leave_others(model.view, commands);
        match model.view {
            View::Operate => {
                let (state, question) = (&mut self.operate, &mut self.question);
                operate::show(ui, window, rest, live, model, state, question, commands);
            }
            View::Plan => plan::show(ui, window, rest, model, &mut self.plan, commands),
            View::Elements => {
                let is_edited = self.preferences.is_edited();
                let (state, question) = (&mut self.elements, &mut self.question);
                let upload = elements::show(ui, rest, model, is_edited, state, question, commands);
                if let Some(place) = upload {
                    if let Some(choice) = place.choice {
                        self.upload.choose(choice);
                    }
                    show_upload(ui, place.rect, model, &mut self.upload, commands);
                }
            }
            View::Antennas => {
                let before = commands.len();
                antennas::show(ui, rest, model, &mut self.antennas, commands);
                let leads_on = commands
                    .iter()
                    .skip(before)
                    .any(|command| matches!(command, UiCommand::Show(View::Preferences)));
                if let Some(antenna) = model.antenna().filter(|_| leads_on) {
                    self.preferences.show_antenna(antenna.id());
                }
            }
            View::Console => console::show(ui, window, rest, model, &mut self.console, commands),
            View::Record => {
                record::show(ui, window, rest, model, &mut self.record, commands);
                self.take_correction(model, commands);
            }
            View::Map => map::show(ui, window, rest, model, &mut self.map, commands),
            View::Preferences => {
                preferences::show(ui, rest, model, &mut self.preferences, commands);
            }
            View::Setup => {
                let is_asked = self.question.is_some() || self.path_dialog.is_some();
                let takes_keys = !is_asked && !self.keys_open;
                setup::show(ui, rest, model, takes_keys, &mut self.setup, commands);
            }
        }
        self.keep_edits(commands, before);
        if model.replay.is_some() && self.refuse_in_replay(commands, before) {
            self.notes.news = Some(Err(replay::REFUSED.to_owned()));
        }
        self.notes.show(ui, rest, model, commands);
        if let Some(question) = second_step::ask(model, before, commands) {
            self.question = Some(question);
            // Enter answers the question and does not end a text input behind it.
            ui.memory_mut(egui::Memory::stop_text_input);
        }
        self.show_questions(ui, live, model, commands);
        keys::list::show(ui, &mut self.keys_open);
    }

    /// Shows the questions above all views.
    fn show_questions(
        &mut self,
        ui: &Ui,
        live: &Model,
        model: &Model,
        commands: &mut Vec<UiCommand>,
    ) {
        let answered = commands.len();
        Question::show(&mut self.question, ui, commands);
        PathDialog::show(&mut self.path_dialog, ui, commands);
        ClosingDialog::show(&mut self.closing, ui, model, commands);
        closing::waiting(ui, live, commands);
        changing::show(ui, live, commands);
        let is_manual = |command: &UiCommand| {
            matches!(command, UiCommand::Station(contract::Command::Antenna(_, Command::Manual)))
        };
        if commands.iter().skip(answered).any(is_manual) {
            self.operate.card.drive.focus_pad();
        }
    }

    /// Accepts a correction that the operator has chosen in the record.
    fn take_correction(&mut self, model: &Model, commands: &mut Vec<UiCommand>) {
        match self.record.correction.take() {
            Some(Ok(correction)) => {
                let (antennas, question) = (&mut self.antennas, &mut self.question);
                record::take_over(correction, model, antennas, question, commands);
            }
            Some(Err(reason)) => self.notes.news = Some(Err(reason)),
            None => {}
        }
    }

    /// Ends activities that only a visible view may continue.
    fn leave_others(&mut self, shown: View, commands: &mut Vec<UiCommand>) {
        if shown != View::Operate {
            self.operate.leave(commands);
        }
        if shown != View::Record {
            self.record.leave(commands);
        }
    }

    /// Drops the commands from index `before` on that would change the station while its
    /// preferences have unsaved edits. The change would discard these edits. Shows a message about
    /// the dropped commands.
    fn keep_edits(&mut self, commands: &mut Vec<UiCommand>, before: usize) {
        if !self.preferences.is_edited() {
            return;
        }
        let changes = |command: &mut UiCommand| matches!(command, UiCommand::Station(command) if command.changes_station());
        if commands.extract_if(before.., changes).count() > 0 {
            let text = "Not changed: Preferences has unsaved changes. Save or revert them first.";
            self.notes.news = Some(Err(text.to_owned()));
            self.plan.was_not_changed();
        }
    }

    /// Removes the commands from index `before` on that act, and an open question about such a
    /// command. Returns `true` if the window refused any of them.
    fn refuse_in_replay(&mut self, commands: &mut Vec<UiCommand>, before: usize) -> bool {
        let acts = |command: &UiCommand| !command.is_for_replay();
        let requested = self.question.take_if(|question| acts(&question.command)).is_some();
        commands.extract_if(before.., |command| acts(command)).count() > 0 || requested
    }

    /// Asks before the window closes or changes the station, if the operator would lose something.
    /// Otherwise ends the station according to its settings. Returns `true` if closing has to wait.
    pub fn ask_before_closing(&mut self, model: &Model, commands: &mut Vec<UiCommand>) -> bool {
        let mut lost: Vec<String> = words::automatic::lost_by_closing(model).into_iter().collect();
        match self.antennas.edited(model) {
            0 => {}
            1 => lost.push("1 change to a unit's settings is not applied.".to_owned()),
            edited => lost.push(format!("{edited} changes to units' settings are not applied.")),
        }
        if self.preferences.is_edited() {
            lost.push("The station settings are not saved.".to_owned());
        }
        if self.setup.is_edited() {
            lost.push("The set-up of your station is not finished.".to_owned());
        }
        if model.uploads.stage.is_open() {
            lost.push("An upload is under way.".to_owned());
        }
        if closing::stakes(model).is_empty() {
            return self.ask_about_lost(&lost, model, commands);
        }
        self.operate.leave_card(commands);
        self.question = None;
        match CloseHow::from_station(&model.station) {
            Some(choice) if lost.is_empty() => {
                commands.push(UiCommand::Station(contract::Command::CloseAfter(choice)));
            }
            _ => self.closing = Some(ClosingDialog { lost }),
        }
        true
    }

    fn ask_about_lost(
        &mut self,
        lost: &[String],
        model: &Model,
        commands: &mut Vec<UiCommand>,
    ) -> bool {
        if lost.is_empty() {
            return false;
        }
        self.operate.leave_card(commands);
        let (yes, command) = match model.stations.next {
            None => ("Close", UiCommand::Close),
            Some(_) => ("Change", UiCommand::ChangeNow),
        };
        let text = format!("{} {yes} anyway?", lost.join(" "));
        self.question = Some(Question { text, yes, command });
        true
    }

    /// Resets views after a change of the station from outside the preferences.
    pub fn station_changed(&mut self) {
        self.operate.sky_time.return_to_now();
        self.preferences.forget();
        self.banner = BannerRoom::default();
    }

    /// Takes the outcome of saving console lines: the path or the error.
    pub fn log_saved(&mut self, result: Result<PathBuf, String>) {
        self.console.saved(result);
    }

    /// Takes the outcome of saving a file: the file or the error.
    pub fn file_saved(&mut self, result: Result<SavedFile, String>) {
        self.notes.news = Some(result.map_err(|reason| format!("Nothing was saved: {reason}.")));
    }

    /// Asks the operator to enter the path of a file.
    pub fn ask_for_path(&mut self, request: PathRequest) {
        self.path_dialog = Some(PathDialog::new(request));
    }

    /// Shows the reason why a folder was not opened.
    pub fn folder_not_opened(&mut self, reason: &str) {
        let cure = "Copy its path and open it by hand";
        self.notes.news = Some(Err(format!("The folder was not opened: {reason}. {cure}.")));
    }

    /// Shows the reason why a file was not opened.
    pub fn not_opened(&mut self, reason: &str) {
        self.notes.news = Some(Err(reason.to_owned()));
    }

    /// Takes the outcome of reading or writing a horizon mask.
    pub fn mask_news(&mut self, news: MaskNews) {
        self.preferences.mask_news(news);
    }

    /// Takes the outcome of saving the settings: the time or the error.
    pub fn saved(&mut self, result: Result<Timestamp, String>) {
        self.setup.saved(&result);
        self.preferences.saved(result);
    }
}

fn show_upload(
    ui: &mut Ui,
    place: Rect,
    model: &Model,
    state: &mut UploadState,
    commands: &mut Vec<UiCommand>,
) {
    let builder = UiBuilder::new().id_salt("upload").max_rect(place);
    ui.scope_builder(builder, |ui| {
        upload::show(ui, model, model.selected_antenna, state, commands);
    });
}

/// Shows the rail. Returns `true` when the operator opens the list of keys. `edits` is the number
/// of values entered in the Antennas view that are not on their units.
fn show_rail(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    edits: usize,
    commands: &mut Vec<UiCommand>,
) -> bool {
    let views = [
        (View::Operate, Icon::CrossHair, "Operate"),
        (View::Plan, Icon::Bars, "Plan"),
        (View::Elements, Icon::Orbit, "Elements"),
        (View::Antennas, Icon::Antenna, "Antennas"),
        (View::Console, Icon::Prompt, "Console"),
        (View::Record, Icon::Pulse, "Record"),
        (View::Map, Icon::Globe, "Map"),
    ];
    let entry = |view, icon, word| RailEntry {
        icon,
        word,
        active: view == model.view,
        edits: if view == View::Antennas { edits } else { 0 },
    };
    let entries = views.map(|(view, icon, word)| entry(view, icon, word));
    if let Some((view, ..)) = rail::show(ui, rect, &entries).and_then(|index| views.get(index)) {
        commands.push(UiCommand::Show(*view));
    }
    let foot = rail::show_foot(ui, rect, &entry(View::Preferences, Icon::Sliders, "Preferences"));
    if foot.view {
        commands.push(UiCommand::Show(View::Preferences));
    }
    foot.keys
}
