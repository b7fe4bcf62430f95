//! Change of the window's station. Azel reads the file of the next station first; a station that
//! cannot be opened changes nothing. Azel then asks the operator the same questions as before
//! closing the window. The old station ends before the next one starts.

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, PoisonError},
};

use super::{App, Keeper, KnownWork, LogWork, MaskWork, Notifier, PlaceWatch};
use crate::{
    contract,
    desktop::Desktop,
    engine::{CannotOpen, Handle, Settings, look_at},
    job::{Job, Wake},
    model::{KnownStation, Model, NextStation, UiCommand},
    station, ui,
};

/// Station that the window can open.
pub(super) struct Target {
    name: String,
    settings: Settings,
    opens_set_up: bool,
}

/// Reason why Azel does not open the chosen station.
pub(super) struct Refused {
    path: PathBuf,
    cannot_open: CannotOpen,
}

/// Progress of a change of the station.
pub(super) enum Change {
    Looking(Job<Result<Target, Refused>>),
    /// Station that can be opened, before Azel asks the operator.
    Found(Target),
    /// Station that waits for the operator's answer, or until the antennas are at rest.
    Asked(Target),
    /// Station that waits for the end of the old station.
    Ending(Target),
    Starting {
        job: Job<io::Result<(Handle, Keeper)>>,
        settings: Settings,
        opens_set_up: bool,
    },
}

impl App {
    /// Keeps the station list and new station files in `folder` instead of the current station's
    /// folder.
    #[must_use]
    pub fn with_stations_in(mut self, folder: PathBuf) -> Self {
        (self.known_work, self.model.stations.stations) = KnownWork::new(Some(&folder));
        self.stations_folder = Some(folder);
        self
    }

    /// Starts to read the chosen station, unless the old station is already ending or has ended.
    pub(super) fn choose_station(&mut self, next: NextStation) {
        if self.is_between_stations() {
            return;
        }
        let (settings, folder) = (self.settings.clone(), self.stations_folder.clone());
        let work = move |_: &(dyn Fn() -> bool + Sync)| look(next, settings, folder.as_deref());
        self.change =
            Some(Change::Looking(Job::start("azel-station-look", Arc::clone(&self.wake), work)));
    }

    /// Advances the change up to the next decision of the operator.
    pub(super) fn work_on_change(&mut self) {
        self.change = match self.change.take() {
            Some(Change::Looking(job)) => self.take_look(job),
            Some(Change::Ending(target)) if self.station.has_ended() => Some(self.start(target)),
            Some(Change::Starting { job, settings, opens_set_up }) => {
                let mut job = Some(job);
                match Job::take(&mut job) {
                    None => job.map(|job| Change::Starting { job, settings, opens_set_up }),
                    Some(Ok(Ok((station, keeper)))) => {
                        self.use_station(station, keeper, settings);
                        self.opens_set_up = opens_set_up;
                        None
                    }
                    Some(Ok(Err(error))) => broke_down(&error.to_string()),
                    Some(Err(broke_off)) => broke_down(&broke_off.to_string()),
                }
            }
            change => change,
        };
        self.model.stations.is_changing = self.is_between_stations();
    }

    fn take_look(&mut self, job: Job<Result<Target, Refused>>) -> Option<Change> {
        let mut job = Some(job);
        match Job::take(&mut job) {
            None => return job.map(Change::Looking),
            Some(Ok(Ok(target))) => return Some(Change::Found(target)),
            Some(Ok(Err(Refused { path, cannot_open }))) => {
                tracing::warn!("a station is not opened: {cannot_open}");
                self.model.stations.refused = Some(cannot_open.to_string());
                if matches!(cannot_open, CannotOpen::Missing(_)) {
                    let stations = &mut self.model.stations.stations;
                    self.known_work.forget(path, stations, &self.wake);
                }
            }
            Some(Err(broke_off)) => self.model.stations.refused = Some(broke_off.to_string()),
        }
        None
    }

    /// Asks about the consequences of the change, once the next station can be opened.
    pub(super) fn ask_before_change(&mut self, commands: &mut Vec<UiCommand>) {
        self.change = match self.change.take() {
            Some(Change::Found(target)) => {
                self.model.stations.next = Some(target.name.clone());
                if self.views.ask_before_closing(&self.model, commands) {
                    Some(Change::Asked(target))
                } else {
                    Some(self.end_old(target))
                }
            }
            change => change,
        };
    }

    /// Ends the old station after the operator agreed and the antennas came to rest. Returns `true`
    /// if a change was waiting for that.
    pub(super) fn change_now(&mut self) -> bool {
        match self.change.take() {
            Some(Change::Asked(target)) => {
                self.change = Some(self.end_old(target));
                true
            }
            change => {
                self.change = change;
                false
            }
        }
    }

    /// Cancels the change, unless the old station is already ending or has ended.
    pub(super) fn stay(&mut self) {
        if !self.is_between_stations() {
            self.change = None;
            self.model.stations.next = None;
        }
        self.model.stations.refused = None;
    }

    /// Returns `true` while the old station ends or the next one starts: no station can answer
    /// then.
    pub(super) fn is_between_stations(&self) -> bool {
        matches!(self.change, Some(Change::Ending(_) | Change::Starting { .. }))
    }

    fn end_old(&mut self, target: Target) -> Change {
        self.model.stations.is_changing = true;
        self.remember();
        self.station.begin_end();
        Change::Ending(target)
    }

    fn start(&mut self, target: Target) -> Change {
        let Target { settings, opens_set_up, .. } = target;
        let (of_station, outside) = (settings.clone(), self.outside.clone());
        let wake = Arc::clone(&self.wake);
        let mut old = std::mem::replace(&mut self.keeper, Keeper::new(None));
        let work = move |_: &(dyn Fn() -> bool + Sync)| {
            old.finish(&wake);
            let keeper = Keeper::new(of_station.station_path().as_deref());
            Ok((Handle::start(of_station, outside, wake)?, keeper))
        };
        let job = Job::start("azel-station-start", Arc::clone(&self.wake), work);
        Change::Starting { job, settings, opens_set_up }
    }

    /// Puts a started station into the window.
    fn use_station(&mut self, station: Handle, keeper: Keeper, settings: Settings) {
        // No code panics while it holds the lock.
        *self.client.lock().unwrap_or_else(PoisonError::into_inner) = station.client().clone();
        self.station = station;
        let library = settings.library_path();
        self.log_work = LogWork::new(library.clone());
        self.mask_work = MaskWork::new(library);
        (self.effects_jobs, self.catalog_work) = Default::default();
        self.intake_work = super::IntakeWork::default();
        self.rehearsal_work = super::RehearsalWork::default();
        let stations = std::mem::take(&mut self.model.stations.stations);
        self.model = Model::before_anything(self.clock.now());
        (self.model.list, self.model.view) = (keeper.memory.list, keeper.memory.view);
        (self.model.stations.stations, self.model.stations.open) =
            (stations, settings.station_path());
        self.views = ui::Views::new(keeper.memory.views.clone());
        (self.keeper, self.settings) = (keeper, settings);
        self.place_watch = PlaceWatch::default();
        (self.attention, self.closes) = (contract::Attention::default(), false);
        if self.notifier.is_some() {
            let client = self.station.client().clone();
            let notifier = Notifier::start(client, Desktop::default(), Wake::clone(&self.wake));
            let log_error =
                |error: &io::Error| tracing::error!(%error, "no thread for the desktop");
            self.notifier = notifier.inspect_err(log_error).ok();
        }
    }

    /// Keeps the station in the window at the head of the list. The list omits the demo station.
    pub(super) fn note_station(&mut self) {
        if self.model.demo {
            return;
        }
        let Some(path) = self.model.stations.open.clone() else { return };
        let station = KnownStation { name: self.model.station.name.clone(), path };
        self.known_work.put_first(station, &mut self.model.stations.stations, &self.wake);
    }
}

fn look(next: NextStation, settings: Settings, folder: Option<&Path>) -> Result<Target, Refused> {
    let free = folder.map(station::free_path);
    let beside_demo = |name: &str, opens_set_up| {
        let settings = Settings { path: free, ..settings.clone() };
        Ok(Target { name: name.to_owned(), settings, opens_set_up })
    };
    match next {
        NextStation::Demo => beside_demo("the demo station", false),
        NextStation::New => beside_demo("a new station", true),
        NextStation::File(path) => {
            let path = std::path::absolute(&path).unwrap_or(path);
            let settings = Settings { path: Some(path.clone()), ..settings };
            match look_at(&settings) {
                Ok(name) => Ok(Target { name, settings, opens_set_up: true }),
                Err(cannot_open) => Err(Refused { path, cannot_open }),
            }
        }
    }
}

/// Panics: without a station Azel has nothing to show and nothing to stop.
fn broke_down(reason: &str) -> ! {
    std::panic::resume_unwind(Box::new(format!("the station did not start: {reason}")))
}
