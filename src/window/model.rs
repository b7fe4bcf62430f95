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

/// All state shown in the window: what the station published last, and what this window adds.
///
/// It dereferences to the snapshot, so that a view reads `model.antennas` whoever keeps them.
pub struct Model {
    /// The station as published last.
    shown: Arc<Snapshot>,
    /// UTC of this frame.
    pub now: Timestamp,
    /// The steady clock of this frame, for ages.
    pub steady: Instant,
    /// The stations of the station menu.
    pub stations: Stations,
    /// Files and texts that are offered as elements; `None` without any.
    pub intake: Option<Intake>,
    /// The table of the catalog.
    pub catalog_table: CatalogTable,
    /// The traffic on the links of the antennas, in the same order.
    pub wires: Vec<WireLog>,
    /// Index of the antenna whose card is shown.
    pub selected_antenna: usize,
    /// How the window looks.
    pub appearance: Appearance,
    /// The choice of passes in the list.
    pub list: ListChoice,
    /// The selected pass.
    pub selected: Option<PassListKey>,
    /// The pass that the operator chose; it stays selected until it is over.
    pub chosen: Option<PassListKey>,
    /// The sky at `now`.
    pub sky: Sky,
    /// The globe at `now`, as long as the map shows it.
    pub globe: Globe,
    /// Effects of the keep-outs on the predicted passes.
    pub obstacle_effects: Effects<obstacles::Question>,
    /// How much of the predicted passes an antenna tracks.
    pub mount_effects: Effects<mounts::Question>,
    /// Effects of an edited site.
    pub site_effects: Effects<sites::Question>,
    /// When antennas would join passes that are under way.
    pub joinings: Joinings,
    /// The last rehearsal of the plan.
    pub rehearsal: RehearsalState,
    /// Means for alarms and reminders that the desktop lacks.
    pub outlets: Outlets,
    /// The view that fills the window.
    pub view: View,
    /// The replay that this model is of; `None` for the live station.
    pub replay: Option<Replayed>,
    /// Why the last replay ended by itself, until the operator closes that or opens another view.
    pub replay_end: Option<ReplayEnd>,
}

impl Deref for Model {
    type Target = Snapshot;

    fn deref(&self) -> &Snapshot {
        &self.shown
    }
}

impl Model {
    /// The model of a station that has told nothing yet.
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

    /// The published state.
    pub fn shown(&self) -> &Arc<Snapshot> {
        &self.shown
    }

    /// The published state, to change what a client adds to it: a pressed STOP, an alarm of its own.
    pub fn shown_mut(&mut self) -> &mut Snapshot {
        Arc::make_mut(&mut self.shown)
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
            Scope::Favourites => {
                self.pass_lists.favourites.upcoming_within(self.now, self.list.span_h())
            }
            Scope::All => self.pass_lists.all.upcoming(self.now),
        }
    }

    /// Takes the state published by the station, and the logs of its links.
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

    /// The set-up closes with the demonstration; then the next pass over the new site is selected.
    fn take_demo(&mut self, is_demo: bool) {
        if self.demo && !is_demo {
            self.drop_choice();
            if self.view == View::Setup {
                self.view = View::Operate;
            }
        }
    }

    /// Raises the alarm that the station has published nothing new for `stood`; `None` clears it.
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

    /// The sky at another time, without day and night.
    pub fn sky_at(&self, time: Timestamp) -> Sky {
        let selected = self.selected_pass().map(|predicted| &*predicted.satellite);
        Sky::new(&self.pass_lists.favourites.satellites, selected, self.station.site, time)
    }
}
