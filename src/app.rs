//! The window's app: what it knows, what it does once a frame, and what it
//! carries out for the views.
//!
//! Invariants: this thread never blocks and never does I/O but for saving the
//! settings on the operator's word; views change nothing, they queue
//! [`UiCommand`]s.

pub mod alarms;
pub mod antenna;
mod carry_out;
pub mod clearance;
mod clock_watch;
pub mod closing;
pub mod command;
pub mod copies;
pub mod daylight;
mod demo;
pub mod effects;
pub mod forecast;
pub mod host_keys;
mod lock_outs;
mod log_file;
mod logic;
pub mod mask_file;
mod memory;
pub mod model;
pub mod on_board;
mod owed;
mod settle;
pub mod source_tests;
pub mod sources;
pub mod track_again;
pub mod uploads;

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

pub use command::UiCommand;
pub use model::{Model, View};

use self::{
    alarms::AlarmKind,
    antenna::AntennaModel,
    clock_watch::ClockWatch,
    copies::CopyWork,
    demo::Demo,
    log_file::LogWork,
    mask_file::MaskWork,
    memory::Keeper,
    model::CatalogState,
    sources::{Outcome, Places, SourceWork, Sources, Task},
};
use crate::{
    clock::Clock,
    driver::{self, Command, Driver, Unit},
    job::{Job, Wake},
    makes::{self, DemoAddresses},
    plan::Bounds,
    station::{self, LoadError, LockOuts, Station},
    ui,
};

/// What the command line says about the window.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Where the station file is; `None` for the user's own.
    pub path: Option<PathBuf>,
    /// Where elements from servers are kept; `None` for the user's own folder.
    pub library: Option<PathBuf>,
    /// Where host keys, old uploads and secrets are kept; `None` for the user's
    /// own places.
    pub upload_places: Option<uploads::Places>,
    /// The program that is started as the dead-man; `None` for none.
    pub dead_man: Option<PathBuf>,
    /// Where motions by hand are marked; `None` for nowhere.
    pub marks: Option<PathBuf>,
}

/// The app behind the window.
pub struct App {
    model: Model,
    views: ui::Views,
    // The sessions end before their thread does.
    driver: Driver,
    demo: Option<Demo>,
    clock: Clock,
    clock_watch: ClockWatch,
    wake: Wake,
    settings_path: Option<PathBuf>,
    places: Places,
    elements_job: Option<Job<Outcome>>,
    /// The last reading of the elements broke off.
    elements_broke_off: bool,
    copy_work: CopyWork,
    log_work: LogWork,
    mask_work: MaskWork,
    uploads: uploads::Desk,
    source_tests: source_tests::Desk,
    keeper: Keeper,
    lock_outs: LockOuts,
    /// The settings on disk could not be read: only the operator may replace them.
    settings_unread: bool,
    /// The operator or the operating system has said so: nothing is asked.
    may_close: Arc<AtomicBool>,
    /// The operating system has said so: nobody can be asked.
    told_to_end: Arc<AtomicBool>,
    drawn: bool,
}

impl App {
    /// The app in a new window.
    pub fn new(ctx: &egui::Context, settings: &Settings, clock: Clock) -> std::io::Result<Self> {
        let settings_path = settings.path.clone().or_else(station::settings_path);
        let keeper = Keeper::beside(settings_path.as_deref());
        ui::theme::install(ctx, keeper.memory.theme);
        let wake = wake(ctx.clone());
        let driver = Driver::start(clock.clone(), Arc::clone(&wake))?
            .guarded_by(settings.dead_man.clone())
            .marking_in(settings.marks.clone());
        let model = Model {
            now: clock.utc(),
            steady: Instant::now(),
            time_sync: driver::TimeSync::NotKnown,
            station: Station::default(),
            demo: false,
            catalog: CatalogState::Loading,
            sources: Sources { work: SourceWork::Reading, ..Sources::default() },
            antennas: Vec::new(),
            selected_antenna: 0,
            forecasts: forecast::Forecasts::default(),
            list: keeper.memory.list,
            selected: None,
            sky: model::Sky::default(),
            uploads: uploads::Uploads::default(),
            source_tests: source_tests::SourceTests::default(),
            effects: effects::Effects::default(),
            alarms: alarms::Alarms::default(),
            copies: copies::Copies::default(),
            view: View::Operate,
            closing: None,
        };
        let (may_close, told_to_end) = (Arc::default(), Arc::default());
        let flags = [Arc::clone(&may_close), Arc::clone(&told_to_end)];
        close_on_signals(&driver, flags, ctx.clone());
        let copy_work = CopyWork::beside(settings_path.as_deref());
        let places = Places::new(settings_path.as_deref(), settings.library.clone());
        let log_work = LogWork::beside(places.library().map(PathBuf::from));
        let mask_work = MaskWork::beside(places.library().map(PathBuf::from));
        let task = Task::default();
        let elements_job = sources::start(&places, task, clock.utc(), Arc::clone(&wake))?;
        let upload_places = settings.upload_places.clone().or_else(uploads::Places::of_this_user);
        let uploads = uploads::Desk::new(upload_places.clone(), clock.clone(), Arc::clone(&wake));
        let source_tests = source_tests::Desk::new(upload_places, clock.clone(), Arc::clone(&wake));
        let mut app = Self {
            model,
            views: ui::Views::with(keeper.memory.views),
            driver,
            demo: None,
            clock,
            clock_watch: ClockWatch::default(),
            wake,
            settings_path,
            places,
            elements_job: Some(elements_job),
            elements_broke_off: false,
            copy_work,
            log_work,
            mask_work,
            uploads,
            source_tests,
            keeper,
            lock_outs: LockOuts::default(),
            settings_unread: false,
            may_close,
            told_to_end,
            drawn: false,
        };
        app.load_lock_outs();
        app.load_station();
        Ok(app)
    }

    /// What is shown.
    pub fn model(&self) -> &Model {
        &self.model
    }

    fn load_station(&mut self) {
        let loaded = match &self.settings_path {
            Some(path) => station::load(path, &makes::kinds()),
            None => Err(LoadError::Missing),
        };
        match loaded {
            Ok(loaded) => {
                for note in loaded.notes {
                    self.model.alarms.raise(None, alarms::AlarmKind::Setting(note), self.model.now);
                }
                self.use_station(loaded.station);
            }
            // The address is known once the simulator runs.
            Err(LoadError::Missing) => {
                self.model.demo = true;
                self.use_station(Station {
                    antennas: Vec::new(),
                    ..Station::demo(&DemoAddresses::default())
                });
            }
            Err(error) => {
                let text = error.to_string();
                tracing::error!("{text}");
                self.model.alarms.raise(None, alarms::AlarmKind::Settings(text), self.model.now);
                // Nothing is connected and nothing is overwritten by itself.
                self.settings_unread = true;
                self.use_station(Station::default());
            }
        }
    }

    /// Takes a station into use. Antennas that stay as they are keep their session.
    fn use_station(&mut self, station: Station) {
        self.keep_rows_locked_out(&station.antennas);
        let mut before = std::mem::take(&mut self.model.antennas);
        // The antenna may be the same one at a new address: then STOP is owed to both.
        let debts = self.driver.debts().clone();
        let owed: Vec<String> = (before.iter())
            .filter(|antenna| debts.owes(&Unit::of(&antenna.config)))
            .map(|antenna| antenna.config.name.clone())
            .collect();
        // A unit has one place for a client: the old session leaves first.
        before.retain(|antenna| station.antennas.contains(&antenna.config));
        for config in &station.antennas {
            let bounds = Bounds::of(&station, config);
            let kept = before.iter().position(|antenna| antenna.config == *config);
            let antenna = if let Some(kept) = kept {
                let antenna = before.swap_remove(kept);
                // Not taken only where the session is too busy to take anything.
                if antenna.handle.send(Command::Within(Box::new(bounds))).is_err() {
                    self.model.alarms.raise(None, AlarmKind::NotTaken, self.model.now);
                }
                antenna
            } else {
                let antenna = self.open_antenna(config.clone(), bounds);
                if owed.contains(&config.name) {
                    antenna.handle.stop();
                }
                antenna
            };
            self.model.antennas.push(antenna);
        }
        let last = self.keeper.memory.antenna.as_deref();
        self.model.selected_antenna = (self.model.antennas.iter())
            .position(|antenna| Some(antenna.config.name.as_str()) == last)
            .unwrap_or(self.model.selected_antenna)
            .min(self.model.antennas.len().saturating_sub(1));
        self.model.station = station;
    }

    fn open_antenna(&self, config: station::Antenna, bounds: Bounds) -> AntennaModel {
        let lock_out = self.lock_outs.of(&config.connection).cloned();
        let handle = self.driver.open(&config, bounds, lock_out);
        AntennaModel::new(config, handle)
    }
}

/// Every jog ends with a STOP on the wire before the window is gone.
impl Drop for App {
    fn drop(&mut self) {
        if self.told_to_end.load(Ordering::Relaxed) {
            self.end_unasked();
        }
        self.model.antennas.clear();
        self.remember();
        self.keeper.finish(&self.wake);
    }
}

/// A log-out or Ctrl C in the terminal closes the window in order, so that a
/// jog ends with STOP.
fn close_on_signals(driver: &Driver, flags: [Arc<AtomicBool>; 2], ctx: egui::Context) {
    driver.runtime().spawn(async move {
        if let Err(error) = driver::told_to_end().await {
            return tracing::error!(%error, "signals are not heard");
        }
        for flag in flags {
            flag.store(true, Ordering::Relaxed);
        }
        ctx.send_viewport_cmd_to(egui::ViewportId::ROOT, egui::ViewportCommand::Close);
        ctx.request_repaint_after_for(std::time::Duration::from_millis(1), egui::ViewportId::ROOT);
    });
}

/// Asks for a frame soon. A delay that is not zero gives one frame, not two,
/// and merges what comes in between.
fn wake(ctx: egui::Context) -> Wake {
    Arc::new(move || {
        ctx.request_repaint_after_for(std::time::Duration::from_millis(30), egui::ViewportId::ROOT);
    })
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        self.think();
        if self.closes_now() {
            ctx.send_viewport_cmd_to(egui::ViewportId::ROOT, egui::ViewportCommand::Close);
        }
        self.schedule_repaint(ctx);
    }

    /// The ground of the panels: cleared, not painted, which spares a software
    /// renderer most of what it would have to fill.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        tracing::trace!(causes = ?ui.repaint_causes(), "frame");
        // Before any other input of the frame, whatever is open or focused.
        let stop = ui.input(|input| input.key_pressed(egui::Key::Escape));
        if stop {
            self.stop_all();
        }
        let mut commands = Vec::new();
        let closes = ui.input(|input| input.viewport().close_requested());
        if closes
            && !self.may_close.load(Ordering::Relaxed)
            && self.views.ask_before_closing(&self.model, &mut commands)
        {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
        self.views.show(ui, &self.model, &mut commands);
        let stops =
            |command: &UiCommand| matches!(command, UiCommand::Stop | UiCommand::StopAntenna(_));
        if stop || commands.iter().any(stops) {
            self.uploads.stopped();
            commands.retain(|command| !command.may_move());
        }
        if !std::mem::replace(&mut self.drawn, true) {
            tracing::info!("first frame");
        }
        for command in commands {
            self.carry_out(command, ui.ctx());
        }
    }
}
