//! Shell of the window, which draws the station's state and carries out the commands of the views.
//!
//! Invariants: this thread never blocks and never does I/O; views change nothing, they queue
//! [`UiCommand`]s.

mod carry_out;
mod catalog_table;
mod change;
mod effects;
mod export;
mod folder;
pub mod frames;
mod intake;
mod known_stations;
mod log_file;
mod mask_file;
mod memory;
pub mod notifier;
mod open_file;
mod place;
mod rehearsal;
mod replay;
mod running_station;

use std::{
    io,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

pub use self::running_station::RunningStation;
use self::{
    catalog_table::CatalogWork, change::Change, effects::EffectsJobs, export::ExportWork,
    folder::FolderWork, intake::IntakeWork, known_stations::KnownWork, log_file::LogWork,
    mask_file::MaskWork, memory::Keeper, notifier::Notifier, open_file::OpenWork,
    place::PlaceWatch, rehearsal::RehearsalWork, replay::Replay,
};
use crate::{
    clock::Clock,
    contract::{self, antenna::AntennaModel, driver::Snapshot},
    desktop::Desktop,
    driver::Outside,
    engine::{Client, Handle, Settings},
    job::Wake,
    model::{Appearance, Model, UiCommand, View},
    ui,
};

/// Interval between frames while an antenna moves.
const MOVING_FRAME: Duration = Duration::from_millis(100);

/// Interval between frames while a replay plays.
const REPLAY_FRAME: Duration = Duration::from_millis(50);

/// App that shows one station in the window.
pub struct App {
    model: Model,
    views: ui::Views,
    station: Handle,
    /// Settings of the station in the window.
    settings: Settings,
    /// Folder of the station list and of new station files.
    stations_folder: Option<PathBuf>,
    outside: Outside,
    /// Client of the station in the window; the signal handlers send STOP through it.
    client: Arc<Mutex<Client>>,
    clock: Clock,
    wake: Wake,
    effects_jobs: EffectsJobs,
    catalog_work: CatalogWork,
    export_work: ExportWork,
    folder_work: FolderWork,
    intake_work: IntakeWork,
    log_work: LogWork,
    mask_work: MaskWork,
    open_work: OpenWork,
    known_work: KnownWork,
    rehearsal_work: RehearsalWork,
    /// Replay of the record; `None` while the window shows the live station.
    replay: Option<Replay>,
    /// Pending change to another station.
    change: Option<Change>,
    keeper: Keeper,
    place_watch: PlaceWatch,
    /// Permission to open the set-up view when the demo station appears.
    opens_set_up: bool,
    /// Desktop notifier; `None` if Azel reports nothing to the desktop.
    notifier: Option<Notifier>,
    /// The attention last reported to the station.
    attention: contract::Attention,
    /// Flag: the work before closing is done.
    closes: bool,
    /// Flag: the operator or the operating system decided to close, so Azel asks no question.
    may_close: Arc<AtomicBool>,
    /// Flag: the operating system ends the program, so nobody can answer a question.
    told_to_end: Arc<AtomicBool>,
    /// Flag for the station's waker: frames come at the pace of [`MOVING_FRAME`].
    is_lively: Arc<AtomicBool>,
    /// Flag for the event loop: an antenna is jogged.
    is_jogging: Arc<AtomicBool>,
    drawn: bool,
}

impl App {
    /// Creates the app in a new window, on the station that `settings` names. The station takes its
    /// clock and links from `outside`; the window holds only the station's handle.
    pub fn new(
        ctx: &egui::Context,
        settings: &Settings,
        outside: impl Into<Outside>,
    ) -> io::Result<Self> {
        Ok(Self::on(RunningStation::start(settings.clone(), outside)?, ctx))
    }

    /// Creates the app in a new window, on a station that is already running.
    pub fn on(begun: RunningStation, ctx: &egui::Context) -> Self {
        begun.show_in(ctx);
        let RunningStation {
            station,
            settings,
            outside,
            wake,
            client,
            may_close,
            told_to_end,
            is_lively,
            is_jogging,
            ..
        } = begun;
        let clock = outside.clock.clone();
        let keeper = Keeper::new(settings.station_path().as_deref());
        ui::theme::install(ctx, keeper.memory.appearance.theme);
        let library = settings.library_path();
        let (log_work, mask_work) = (LogWork::new(library.clone()), MaskWork::new(library));
        let mut model = Model::before_anything(clock.now());
        (model.list, model.view) = (keeper.memory.list, keeper.memory.view);
        // Store the absolute path: the list outlives the working directory of this run.
        let whole = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        model.stations.open = settings.station_path().map(whole);
        let folder = model.stations.open.as_deref().and_then(Path::parent).map(Path::to_path_buf);
        let known_work;
        (known_work, model.stations.stations) = KnownWork::new(folder.as_deref());
        Self {
            model,
            views: ui::Views::new(keeper.memory.views.clone()),
            station,
            settings,
            stations_folder: folder,
            outside,
            client,
            clock,
            wake,
            effects_jobs: EffectsJobs::default(),
            catalog_work: CatalogWork::default(),
            export_work: ExportWork::default(),
            folder_work: FolderWork::default(),
            intake_work: IntakeWork::default(),
            log_work,
            mask_work,
            open_work: OpenWork::default(),
            known_work,
            rehearsal_work: RehearsalWork::default(),
            replay: None,
            change: None,
            keeper,
            place_watch: PlaceWatch::default(),
            opens_set_up: true,
            notifier: None,
            attention: contract::Attention::default(),
            closes: false,
            may_close,
            told_to_end,
            is_lively,
            is_jogging,
            drawn: false,
        }
    }

    /// Reports alarms and reminders to the desktop of this session, too.
    pub fn with_notifier(mut self) -> io::Result<Self> {
        let station = self.station.client().clone();
        self.notifier = Some(Notifier::start(station, Desktop::default(), Arc::clone(&self.wake))?);
        Ok(self)
    }

    /// Leaves the set-up closed until the operator opens it.
    #[must_use]
    pub fn without_set_up(mut self) -> Self {
        self.opens_set_up = false;
        self
    }

    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the model of the replay, or `None` while no replay is shown.
    pub fn replay(&self) -> Option<&Model> {
        self.replay.as_ref().map(Replay::model)
    }

    /// Returns the handle on the station behind the window.
    pub fn station(&self) -> &Handle {
        &self.station
    }

    /// Takes all news since the last frame.
    fn think(&mut self) {
        self.take_opened_file();
        self.work_on_change();
        let now = self.clock.now();
        (self.model.now, self.model.steady) = (now.utc, now.steady);
        // Take the events first: the snapshot taken after them holds the state that they refer to.
        let events: Vec<_> = std::iter::from_fn(|| self.station.next_event()).collect();
        if self.station.take() {
            let before: Vec<_> = self.model.antennas.iter().map(AntennaModel::id).collect();
            let was_demo = self.model.demo;
            let (shown, station) = (Arc::clone(self.station.snapshot()), &self.station);
            self.model.take(shown, |antenna| station.wire(antenna));
            if self.model.demo && !was_demo && self.opens_set_up {
                self.model.view = View::Setup;
            }
            if !self.model.antennas.iter().map(AntennaModel::id).eq(before) {
                self.select_known_antenna();
            }
            self.note_station();
        }
        if !self.is_between_stations() {
            self.model.watch_station(self.station.stood_for());
        }
        self.model.outlets = self.notifier.as_ref().map(Notifier::outlets).unwrap_or_default();
        for event in events {
            match event {
                contract::Event::Saved(result) => self.views.saved(result),
                contract::Event::Changed => self.views.station_changed(),
                contract::Event::MayEnd => self.closes = !self.change_now(),
            }
        }
        self.model.follow_antenna();
        self.look();
        self.take_export();
        self.take_folder();
        self.take_log_file();
        self.take_mask_file();
        self.effects_jobs.work(&mut self.model, &self.wake);
        self.catalog_work.work(&mut self.model, &self.wake);
        self.take_intake();
        self.take_rehearsal();
        self.model.refresh_sky();
        self.go_on_with_replay();
        self.remember();
    }

    /// Selects the antenna that the operator selected last, if the station still has it.
    fn select_known_antenna(&mut self) {
        let last = self.keeper.memory.antenna.as_deref();
        let mut antennas = self.model.antennas.iter();
        let place = antennas.position(|antenna| Some(antenna.config.name.as_str()) == last);
        let last_index = self.model.antennas.len().saturating_sub(1);
        self.model.selected_antenna = place.unwrap_or(self.model.selected_antenna).min(last_index);
    }

    /// Reports to the station the list and the pass that the operator looks at.
    fn look(&mut self) {
        let (list, selected) = (self.model.list, self.model.selected);
        let attention = contract::Attention { list, selected };
        let look = contract::Command::Look(attention);
        if attention != self.attention && self.station.client().send(look).is_ok() {
            self.attention = attention;
        }
    }

    /// Applies the zoom and the theme for the current elevation of the Sun.
    fn appear(&mut self, ctx: &egui::Context) {
        let appearance = self.keeper.memory.appearance;
        self.model.appearance = appearance;
        let theme = appearance.theme_under(self.model.sky.sun);
        if ui::theme::name(ctx) != theme {
            ui::theme::set(ctx, theme);
        }
        // Round to whole pixels: the view size depends on the current zoom but must not change it.
        let pixels = (ctx.content_rect().size() * ctx.pixels_per_point()).round();
        let view = pixels / ctx.native_pixels_per_point().unwrap_or(1.0);
        ctx.set_zoom_factor(appearance.zoom(view.into()));
    }

    fn change_appearance(&mut self, appearance: Appearance, ctx: &egui::Context) {
        self.keeper.memory.appearance = appearance;
        self.appear(ctx);
    }

    /// Keeps the operator's changes for the next start.
    fn remember(&mut self) {
        self.keeper.memory.views = self.views.stored();
        self.keeper.keep(&self.wake);
    }

    /// Returns `true` once, in the frame in which the window may close without a question.
    fn closes_now(&mut self) -> bool {
        if !self.station.runs() && !self.is_between_stations() {
            // Stop all antennas: the window shows nothing any more. The sessions send STOP while
            // they end.
            self.station.client().stop_all();
            std::panic::resume_unwind(Box::new("the station broke down".to_owned()));
        }
        std::mem::take(&mut self.closes) && !self.may_close.swap(true, Ordering::Relaxed)
    }

    /// Schedules the next frame: after at most 100 ms while an antenna moves or is jogged, after at
    /// most 50 ms in a playing replay, otherwise on the full second. News request their own frames.
    fn schedule_repaint(&self, ctx: &egui::Context) {
        let shown = || self.model.antennas.iter().map(|antenna| &antenna.snapshot);
        let jogs = shown().any(|snapshot| snapshot.jog.is_some());
        self.is_jogging.store(jogs, Ordering::Relaxed);
        let moves = |snapshot: &Arc<Snapshot>| {
            snapshot.state.measured.is_some_and(|measured| measured.moving())
        };
        let lively = jogs || shown().any(moves);
        let into_second = self.model.now.subsec_nanosecond();
        let to_next = Duration::from_nanos(1_000_000_000 - u64::from(into_second.unsigned_abs()));
        self.is_lively.store(lively, Ordering::Relaxed);
        let wait = if lively { MOVING_FRAME.min(to_next) } else { to_next };
        let plays = self.replay.as_ref().is_some_and(Replay::plays);
        let wait = if plays { REPLAY_FRAME.min(wait) } else { wait };
        // Min wait: shortly before the full second, the wait would be almost zero in many frames.
        let wait = wait.max(Duration::from_millis(5));
        ctx.request_repaint_after_for(wait, egui::ViewportId::ROOT);
    }
}

/// Sends STOP for every jog before the window is gone.
impl Drop for App {
    fn drop(&mut self) {
        if self.told_to_end.load(Ordering::Relaxed) {
            self.station.end_unasked();
        }
        // The sessions end in parallel with the write of the last change.
        self.station.begin_end();
        self.remember();
        self.keeper.finish(&self.wake);
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        self.think();
        self.restore_place(ctx, frame);
        self.watch_place(ctx);
        self.appear(ctx);
        if self.closes_now() {
            ctx.send_viewport_cmd_to(egui::ViewportId::ROOT, egui::ViewportCommand::Close);
        }
        self.schedule_repaint(ctx);
    }

    /// Returns the background of the panels. Clearing with it instead of painting saves a software
    /// renderer most of the filling.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        tracing::trace!(causes = ?ui.repaint_causes(), "frame");
        // Handle STOP before all other input of the frame, whatever is open or focused.
        let stop = ui.input(|input| input.key_pressed(egui::Key::Escape));
        if stop {
            self.stop_all();
        }
        let mut commands = Vec::new();
        let closes = ui.input(|input| input.viewport().close_requested());
        if closes || self.is_between_stations() {
            self.leave_replay(None);
        }
        if closes && !self.may_close.load(Ordering::Relaxed) && !self.is_between_stations() {
            self.stay();
            if self.views.ask_before_closing(&self.model, &mut commands) {
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::CancelClose);
            }
        }
        self.ask_before_change(&mut commands);
        if let Some(replay) = &mut self.replay {
            replay.show(ui, &self.model, &mut commands);
            for command in commands {
                self.carry_out_in_replay(command, ui.ctx());
            }
            return;
        }
        self.views.show(ui, &self.model, &mut commands);
        let stops =
            |command: &UiCommand| matches!(command, UiCommand::Stop | UiCommand::StopAntenna(_));
        if stop || commands.iter().any(stops) {
            commands.retain(|command| !command.is_void_after_stop());
        }
        if !std::mem::replace(&mut self.drawn, true) {
            tracing::info!("first frame");
        }
        if !commands.is_empty() && !frames::one_follows(ui.ctx()) {
            (self.wake)();
        }
        for command in commands {
            self.carry_out(command, ui.ctx());
        }
        // Report now, so that the station answers before the next frame.
        self.look();
    }
}
