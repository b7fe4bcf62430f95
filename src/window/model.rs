//! The model: the state that the views show. Only the shell of the window changes the model; views
//! read it and queue commands.

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

use std::{ops::Deref, path::PathBuf, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

#[cfg(test)]
pub(crate) use self::line::testing;
pub use self::{
    appearance::{Appearance, DistanceUnit},
    command::UiCommand,
    line::{ConsoleLine, Piece, pieces},
    sky::{CROWD, Selected, Sky, SkySatellite},
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
        Snapshot,
        alarms::{Alarm, AlarmKind, Alarms},
        antenna::AntennaModel,
        driver::WireLog,
        passes::{ListChoice, PassListKey, PredictedPass, Scope, UpcomingPasses},
    },
    desktop::Outlets,
    station::{AntennaId, Station},
};

/// A view that fills the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// Watching and moving the antennas.
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
    /// The recorded passes.
    Record,
    /// The satellites over the globe.
    Map,
    /// The station's settings.
    Preferences,
    /// The set-up of a station during the demonstration.
    Setup,
}

/// Outcome of reading or writing a horizon mask file.
pub enum MaskNews {
    /// A mask read from a file, and its format.
    Read(HorizonMask, MaskForm),
    /// Path of the written file.
    Written(PathBuf),
    /// Reason of the failure.
    Failed(String),
}

/// All state that the window shows: the last published state of the station and the window's own
/// state.
///
/// The model dereferences to the snapshot, so that a view can read `model.antennas`.
pub struct Model {
    /// The last published state of the station.
    shown: Arc<Snapshot>,
    /// UTC of this frame.
    pub now: Timestamp,
    /// Steady clock at this frame, for computing ages.
    pub steady: Instant,
    /// Known stations for the station menu.
    pub stations: Stations,
    /// Files and texts offered as elements; `None` without an offer.
    pub intake: Option<Intake>,
    /// Rows of the catalog table, and its question.
    pub catalog_table: CatalogTable,
    /// Traffic on the links of the antennas, in the order of the antennas.
    pub wires: Vec<WireLog>,
    /// Index of the antenna whose card the window shows.
    pub selected_antenna: usize,
    /// Theme, scale and formats of the window.
    pub appearance: Appearance,
    /// Selection of passes in the list.
    pub list: ListChoice,
    /// Key of the selected pass.
    pub selected: Option<PassListKey>,
    /// The pass that the operator chose; it stays selected until it is over.
    pub chosen: Option<PassListKey>,
    /// The sky at `now`.
    pub sky: Sky,
    /// The globe at `now`, updated while the window shows the map.
    pub globe: Globe,
    /// Effects of the keep-outs on the predicted passes.
    pub obstacle_effects: Effects<obstacles::Question>,
    /// Share of the predicted passes that an antenna tracks.
    pub mount_effects: Effects<mounts::Question>,
    /// Effects of an edited site.
    pub site_effects: Effects<sites::Question>,
    /// Times when antennas would join current passes.
    pub joinings: Joinings,
    /// Progress or result of the last rehearsal.
    pub rehearsal: RehearsalState,
    /// Ways to announce alarms and reminders that the desktop lacks.
    pub outlets: Outlets,
    /// View that fills the window.
    pub view: View,
    /// State of the replay that this model shows; `None` for the live station.
    pub replay: Option<Replayed>,
    /// Reason why the last replay ended automatically, until the operator closes the message or
    /// opens another view.
    pub replay_end: Option<ReplayEnd>,
}

impl Deref for Model {
    type Target = Snapshot;

    fn deref(&self) -> &Snapshot {
        &self.shown
    }
}

impl Model {
    /// Returns the model of a station that has published nothing yet.
    pub fn before_anything(now: Moment) -> Self {
        Self {
            shown: Arc::new(Snapshot::before_anything(now)),
            now: now.utc,
            steady: now.steady,
            stations: Stations::default(),
            intake: None,
            catalog_table: CatalogTable::default(),
            wires: Vec::new(),
            selected_antenna: 0,
            appearance: Appearance::default(),
            list: ListChoice::default(),
            selected: None,
            chosen: None,
            sky: Sky::default(),
            globe: Globe::default(),
            obstacle_effects: Effects::default(),
            mount_effects: Effects::default(),
            site_effects: Effects::default(),
            joinings: Joinings::default(),
            rehearsal: RehearsalState::None,
            outlets: Outlets::default(),
            view: View::Operate,
            replay: None,
            replay_end: None,
        }
    }

    /// Returns the published state.
    pub fn shown(&self) -> &Arc<Snapshot> {
        &self.shown
    }

    /// Returns the published state for a client that adds to it: a pressed STOP or its own alarm.
    pub fn shown_mut(&mut self) -> &mut Snapshot {
        Arc::make_mut(&mut self.shown)
    }

    /// Returns the selected antenna.
    pub fn antenna(&self) -> Option<&AntennaModel> {
        self.antennas.get(self.selected_antenna)
    }

    /// Returns the index of an antenna, if the station still has the antenna.
    pub fn place(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.id() == id)
    }

    /// Returns an antenna, if the station still has it.
    pub fn antenna_of(&self, id: AntennaId) -> Option<&AntennaModel> {
        self.antennas.get(self.place(id)?)
    }

    /// Returns the station with which a form starts. In the demonstration it has no antennas,
    /// because their addresses end with the demonstration.
    pub fn station_to_edit(&self) -> Station {
        let station = Station::clone(&self.station);
        if !self.demo {
            return station;
        }
        Station { name: Station::default().name, antennas: Vec::new(), ..station }
    }

    /// Returns the selected pass until it is over.
    pub fn selected_pass(&self) -> Option<&PredictedPass> {
        self.pass_ahead(self.selected?)
    }

    /// Returns the current or next pass of a favourite.
    pub fn pass_of(&self, catalog_number: u32) -> Option<&PredictedPass> {
        let passes = self.pass_lists.favourites.upcoming(self.now);
        passes.iter().find(|predicted| predicted.number() == catalog_number)
    }

    /// Returns the current or next pass of any favourite.
    pub fn next_pass(&self) -> Option<&PredictedPass> {
        self.pass_lists.next(self.now)
    }

    /// Returns the passes that the list shows.
    pub fn upcoming(&self) -> UpcomingPasses<'_> {
        match self.list.scope {
            Scope::Favourites => {
                self.pass_lists.favourites.upcoming_within(self.now, self.list.span_h())
            }
            Scope::All => self.pass_lists.all.upcoming(self.now),
        }
    }

    /// Takes the published state of the station and the logs of its links.
    pub fn take(&mut self, shown: Arc<Snapshot>, wire: impl Fn(AntennaId) -> Option<WireLog>) {
        self.take_demo(shown.demo);
        let before = std::mem::replace(&mut self.shown, shown);
        for model_antenna in
            before.antennas.iter().filter(|model_antenna| model_antenna.stop_pressed.is_some())
        {
            let place = self.place(model_antenna.id());
            let antennas = &mut self.shown_mut().antennas;
            if let Some(antenna) = place.and_then(|place| antennas.get_mut(place)) {
                antenna.keep_pressed(model_antenna.stop_pressed);
            }
        }
        let wire = |antenna: &AntennaModel| wire(antenna.id()).unwrap_or_default();
        self.wires = self.antennas.iter().map(wire).collect();
    }

    /// Closes the set-up when the demonstration ends, and selects the next pass over the new site.
    fn take_demo(&mut self, is_demo: bool) {
        if self.demo && !is_demo {
            self.drop_choice();
            if self.view == View::Setup {
                self.view = View::Operate;
            }
        }
    }

    /// Raises an alarm if the station has published nothing new for `stood`; `None` clears the
    /// alarm.
    pub fn watch_station(&mut self, stood: Option<Duration>) {
        let is_standing = |alarm: &&mut Alarm| {
            matches!(alarm.kind, AlarmKind::StationStands(_)) && !alarm.is_over()
        };
        let mut alarms = self.alarms.list.iter();
        let is_known = alarms.any(|alarm| matches!(alarm.kind, AlarmKind::StationStands(_)));
        if stood.is_none() && !is_known {
            return;
        }
        let now = self.now;
        let Alarms { list, next_id, unopened } = &mut self.shown_mut().alarms;
        let list = Arc::make_mut(list);
        match stood.map(AlarmKind::StationStands) {
            None => {
                list.iter_mut().filter(is_standing).for_each(|alarm| alarm.over_since = Some(now));
            }
            Some(kind) => {
                if let Some(alarm) = list.iter_mut().find(is_standing) {
                    alarm.kind = kind;
                } else {
                    list.push(Alarm::new(*next_id, None, kind, now));
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
        let shown = Arc::clone(&self.shown);
        let satellites = &shown.pass_lists.favourites.satellites;
        self.sky.refresh(satellites, selected.as_deref(), site, self.now);
    }

    /// Returns the sky at another time, without day and night.
    pub fn sky_at(&self, time: Timestamp) -> Sky {
        let selected = self.selected_pass().map(|predicted| &*predicted.satellite);
        Sky::new(&self.pass_lists.favourites.satellites, selected, self.station.site, time)
    }
}
