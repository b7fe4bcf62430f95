//! The model: the state that the views show. Only the shell of the window changes it; a view
//! reads it and queues commands.

mod appearance;
pub mod catalog_table;
pub mod command;
pub mod correction;
pub mod daylight;
pub mod effects;
pub mod export;
pub mod globe;
pub mod intake;
mod joinings;
mod line;
pub mod notices;
pub mod object_detail;
pub mod plan;
pub mod rehearsal;
pub mod replay;
mod selection;
mod sky;
mod stations;
mod theme_name;
pub mod typed_path;

use std::{path::PathBuf, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

#[cfg(test)]
pub(crate) use self::line::testing;
pub use self::{
    appearance::{Appearance, DistanceUnit},
    command::UiCommand,
    line::{ConsoleLine, Piece, pieces},
    sky::{CROWD, Seen, Selected, Sky},
    stations::{KnownStation, NextStation, Stations},
    theme_name::ThemeName,
};
use self::{
    catalog_table::CatalogTable,
    effects::{Effects, mounts, obstacles, sites},
    globe::Globe,
    intake::Intake,
    joinings::Joinings,
    rehearsal::RehearsalState,
    replay::{ReplayEnd, Replayed},
};
use crate::{
    astro::{HorizonMask, MaskForm},
    clock::{Instant, Moment},
    contract::{
        CatalogState, Snapshot,
        alarms::{Alarm, AlarmKind, Alarms},
        antenna::AntennaModel,
        automatic::DayLine,
        closing::Closing,
        copies::Copies,
        driver::{TimeSync, WireLog},
        link_tests::LinkTest,
        older_sets::OlderSets,
        passes::{ListChoice, PassKey, PassLists, PredictedPass, Scope, UpcomingPasses},
        record::{self, Peaks, PointingFitted},
        recorded::Recorded,
        reminders::Reminder,
        schedule::{Planned, Swap},
        source_tests::SourceTests,
        sources::Sources,
        uploads::Uploads,
    },
    desktop::Outlets,
    station::{AntennaId, Station},
};

/// The view that fills the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// Watch and drive.
    #[default]
    Operate,
    /// The schedule of the antennas.
    Plan,
    /// The catalog and its sources.
    Elements,
    /// The settings of the units.
    Antennas,
    /// The traffic on the links.
    Console,
    /// The passes that were tracked.
    Record,
    /// The satellites over the globe.
    Map,
    /// The station's settings.
    Preferences,
    /// The set-up of a station, during the demonstration.
    Setup,
}

/// Outcome of reading or writing a file with a horizon mask.
pub enum MaskNews {
    /// A mask was read, in this form.
    Read(HorizonMask, MaskForm),
    /// A mask was written here.
    Written(PathBuf),
    /// The operation failed, with the reason.
    Failed(String),
}

/// All state shown in the window.
pub struct Model {
    /// UTC of this frame.
    pub now: Timestamp,
    /// The steady clock of this frame, for ages.
    pub steady: Instant,
    /// How the clock behind [`now`](Self::now) is kept.
    pub time_sync: TimeSync,
    /// The station as saved.
    pub station: Arc<Station>,
    /// When its file was written last; `None` for the demo station.
    pub station_saved_at: Option<Timestamp>,
    /// The station is the demo station with simulated antennas.
    pub demo: bool,
    /// The station file could not be read: nothing of this station is the operator's.
    pub station_unread: bool,
    /// The stations of the station menu.
    pub stations: Stations,
    pub catalog: CatalogState,
    /// The sources of elements.
    pub sources: Arc<Sources>,
    /// Files and texts that are offered as elements; `None` without any.
    pub intake: Option<Intake>,
    /// Older sets of the object that was asked for last.
    pub older_sets: Option<Arc<OlderSets>>,
    /// Passes of the record, where they are looked at.
    pub recorded: Option<Arc<Recorded>>,
    /// The fit of a pointing model that was asked for last.
    pub pointing_fitted: Option<Arc<PointingFitted>>,
    /// Peaks of the Sun and the Moon that count in it.
    pub peaks: Arc<Peaks>,
    /// The table of the catalog.
    pub catalog_table: CatalogTable,
    /// The antennas of the station.
    pub antennas: Vec<AntennaModel>,
    /// The traffic on the links of the antennas, in the same order.
    pub wires: Vec<WireLog>,
    /// Index of the antenna whose card is shown.
    pub selected_antenna: usize,
    /// The predicted passes.
    pub pass_lists: PassLists,
    /// How the window looks.
    pub appearance: Appearance,
    /// The choice of passes in the list.
    pub list: ListChoice,
    /// The selected pass.
    pub selected: Option<PassKey>,
    /// The pass that the operator chose; it stays selected until it is over.
    pub chosen: Option<PassKey>,
    /// The sky at `now`.
    pub sky: Sky,
    /// The globe at `now`, as long as the map shows it.
    pub globe: Globe,
    /// Files of elements on their way to units.
    pub uploads: Arc<Uploads>,
    /// Tests, from this console, of the sources that units use.
    pub source_tests: Arc<SourceTests>,
    /// Tests of links to units that the station need not have.
    pub link_tests: Arc<Vec<LinkTest>>,
    /// Effects of the keep-outs on the predicted passes.
    pub obstacle_effects: Effects<obstacles::Question>,
    /// How much of the predicted passes an antenna tracks.
    pub mount_effects: Effects<mounts::Question>,
    /// Effects of an edited site.
    pub site_effects: Effects<sites::Question>,
    /// Active alarms.
    pub alarms: Alarms,
    /// Reminders of passes that are not over.
    pub reminders: Arc<Vec<Reminder>>,
    /// The schedule of all antennas.
    pub schedule: Arc<Planned>,
    /// Cost of the pass that the operator has asked about.
    pub swap: Option<Arc<Swap>>,
    /// When antennas would join passes that are under way.
    pub joinings: Joinings,
    /// The last rehearsal of the plan.
    pub rehearsal: RehearsalState,
    /// Outcomes of the passes of this day.
    pub day: Arc<Vec<DayLine>>,
    /// Means for alarms and reminders that the desktop lacks.
    pub outlets: Outlets,
    /// Copies of the settings of units.
    pub copies: Arc<Copies>,
    /// How the record stands; `None` where none is kept.
    pub record: Option<Arc<record::Status>>,
    /// The view that fills the window.
    pub view: View,
    /// Closing under way, with the antennas that it waits for; `None` while the window is not
    /// closing.
    pub closing: Option<Closing>,
    /// The replay that this model is of; `None` for the live station.
    pub replay: Option<Replayed>,
    /// Why the last replay ended by itself, until the operator closes that or opens another view.
    pub replay_end: Option<ReplayEnd>,
}

impl Model {
    /// The model of a station that has told nothing yet.
    pub fn before_anything(now: Moment) -> Self {
        Self {
            now: now.utc,
            steady: now.steady,
            time_sync: TimeSync::NotKnown,
            station: Arc::default(),
            station_saved_at: None,
            demo: false,
            station_unread: false,
            stations: Stations::default(),
            catalog: CatalogState::Loading,
            sources: Arc::default(),
            intake: None,
            older_sets: None,
            recorded: None,
            pointing_fitted: None,
            peaks: Arc::default(),
            catalog_table: CatalogTable::default(),
            antennas: Vec::new(),
            wires: Vec::new(),
            selected_antenna: 0,
            pass_lists: PassLists::default(),
            appearance: Appearance::default(),
            list: ListChoice::default(),
            selected: None,
            chosen: None,
            sky: Sky::default(),
            globe: Globe::default(),
            uploads: Arc::default(),
            source_tests: Arc::default(),
            link_tests: Arc::default(),
            obstacle_effects: Effects::default(),
            mount_effects: Effects::default(),
            site_effects: Effects::default(),
            alarms: Alarms::default(),
            reminders: Arc::default(),
            schedule: Arc::default(),
            swap: None,
            joinings: Joinings::default(),
            rehearsal: RehearsalState::None,
            day: Arc::default(),
            outlets: Outlets::default(),
            copies: Arc::default(),
            record: None,
            view: View::Operate,
            closing: None,
            replay: None,
            replay_end: None,
        }
    }

    /// The selected antenna.
    pub fn antenna(&self) -> Option<&AntennaModel> {
        self.antennas.get(self.selected_antenna)
    }

    /// The index of an antenna, if the station still has it.
    pub fn place(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.id() == id)
    }

    /// An antenna, if the station still has it.
    pub fn antenna_of(&self, id: AntennaId) -> Option<&AntennaModel> {
        self.antennas.get(self.place(id)?)
    }

    /// The station that a form starts from: that of the demonstration without its antennas, whose
    /// addresses end with it.
    pub fn station_to_edit(&self) -> Station {
        let station = Station::clone(&self.station);
        if !self.demo {
            return station;
        }
        Station { name: Station::default().name, antennas: Vec::new(), ..station }
    }

    /// The selected pass, until it is over.
    pub fn selected_pass(&self) -> Option<&PredictedPass> {
        self.pass_ahead(self.selected?)
    }

    /// The pass of a favourite that is under way, otherwise its next one.
    pub fn pass_of(&self, catalog_number: u32) -> Option<&PredictedPass> {
        let passes = self.pass_lists.favourites.upcoming(self.now);
        passes.iter().find(|predicted| predicted.number() == catalog_number)
    }

    /// The pass of any favourite that is under way or comes next.
    pub fn next_pass(&self) -> Option<&PredictedPass> {
        self.pass_lists.next(self.now)
    }

    /// The passes that the list shows.
    pub fn upcoming(&self) -> UpcomingPasses<'_> {
        match self.list.scope {
            Scope::Favourites => self.pass_lists.favourites.within(self.now, self.list.span_h()),
            Scope::All => self.pass_lists.all.upcoming(self.now),
        }
    }

    /// Takes the state published by the station, and the logs of its links.
    pub fn take(&mut self, shown: &Snapshot, wire: impl Fn(AntennaId) -> Option<WireLog>) {
        self.time_sync = shown.time_sync;
        self.station = Arc::clone(&shown.station);
        self.station_saved_at = shown.station_saved_at;
        self.take_demo(shown.demo);
        self.station_unread = shown.station_unread;
        self.catalog = shown.catalog.clone();
        self.sources = Arc::clone(&shown.sources);
        self.older_sets.clone_from(&shown.older_sets);
        self.recorded.clone_from(&shown.recorded);
        self.pointing_fitted.clone_from(&shown.pointing_fitted);
        self.peaks = Arc::clone(&shown.peaks);
        self.pass_lists = shown.pass_lists.clone();
        self.uploads = Arc::clone(&shown.uploads);
        self.source_tests = Arc::clone(&shown.source_tests);
        self.link_tests = Arc::clone(&shown.link_tests);
        self.alarms = shown.alarms.clone();
        self.reminders = Arc::clone(&shown.reminders);
        self.schedule = Arc::clone(&shown.schedule);
        self.swap.clone_from(&shown.swap);
        self.day = Arc::clone(&shown.day);
        self.copies = Arc::clone(&shown.copies);
        self.record.clone_from(&shown.record);
        self.closing.clone_from(&shown.closing);
        let mut antennas = shown.antennas.clone();
        for antenna in &mut antennas {
            let known = self.antennas.iter().find(|known| known.id() == antenna.id());
            antenna.keep_pressed(known.and_then(|known| known.stop_pressed));
        }
        self.antennas = antennas;
        let wire = |antenna: &AntennaModel| wire(antenna.id()).unwrap_or_default();
        self.wires = self.antennas.iter().map(wire).collect();
    }

    /// The set-up closes with the demonstration; then the next pass over the new site is selected.
    fn take_demo(&mut self, is_demo: bool) {
        if self.demo && !is_demo {
            self.drop_choice();
            if self.view == View::Setup {
                self.view = View::Operate;
            }
        }
        self.demo = is_demo;
    }

    /// Raises the alarm that the station has published nothing new for `stood`; `None` clears it.
    pub fn watch_station(&mut self, stood: Option<Duration>) {
        let is_standing = |alarm: &&mut Alarm| {
            matches!(alarm.kind, AlarmKind::StationStands(_)) && !alarm.is_over()
        };
        let Alarms { list, next_id, unopened } = &mut self.alarms;
        let known = list.iter().any(|alarm| matches!(alarm.kind, AlarmKind::StationStands(_)));
        match stood.map(AlarmKind::StationStands) {
            None if !known => {}
            None => {
                let standing = Arc::make_mut(list).iter_mut().filter(is_standing);
                standing.for_each(|alarm| alarm.over_since = Some(self.now));
            }
            Some(kind) => {
                let list = Arc::make_mut(list);
                if let Some(alarm) = list.iter_mut().find(is_standing) {
                    alarm.kind = kind;
                } else {
                    list.push(Alarm::new(*next_id, None, kind, self.now));
                    *next_id += 1;
                    *unopened = true;
                }
            }
        }
    }

    /// Recomputes the sky for `now`, and the globe if it is shown.
    pub fn refresh_sky(&mut self) {
        if self.view == View::Map {
            let mut globe = std::mem::take(&mut self.globe);
            globe.refresh(self);
            self.globe = globe;
        }
        let span_s = self.station.scheduling.span_h * 3600.0;
        let site = (self.station.site, span_s);
        let selected = self.selected_pass().map(|predicted| Arc::clone(&predicted.satellite));
        let satellites = &self.pass_lists.favourites.satellites;
        self.sky.refresh(satellites, selected.as_deref(), site, self.now);
    }

    /// The sky at another time, without day and night.
    pub fn sky_at(&self, at: Timestamp) -> Sky {
        let selected = self.selected_pass().map(|predicted| &*predicted.satellite);
        Sky::at(&self.pass_lists.favourites.satellites, selected, self.station.site, at)
    }
}
