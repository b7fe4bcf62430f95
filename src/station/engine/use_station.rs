//! Station in use: read from its file or supplied by the operator, with a session for each antenna.

use std::sync::Arc;

use super::{
    Antenna, DemoStation, Engine, Hold, StationClaim,
    automatic::AtWork,
    claim::{Claim, Elsewhere},
};
use crate::{
    contract::{
        alarms::AlarmKind,
        antenna::AntennaModel,
        automatic::{OffBecause, Operation},
        driver::Unit,
    },
    controller::SPECS,
    driver::Driver,
    engine::{alarms::KeepAlarms, antenna::Recent, automatic::Operate},
    makes::DemoAddresses,
    plan::Bounds,
    station::{self, AntennaId, LoadError, Note, Station},
};

/// State that outlasts the session of an antenna whose settings change.
struct Changed {
    id: AntennaId,
    unit: Unit,
    operation: Operation,
    at_work: AtWork,
}

impl Engine {
    /// Raises an alarm for each entry of the station file that could not be used.
    pub(super) fn raise_notes(&mut self, notes: Vec<Note>, station: &Station) {
        for note in notes {
            let unread = station.unread.iter().find(|unread| unread.place == note.place);
            let kind = match unread {
                None => AlarmKind::Setting(note),
                Some(unread) => {
                    let mut antennas = station.antennas.iter();
                    let antenna = antennas.find(|antenna| Some(antenna.id) == unread.antenna);
                    let antenna = antenna.map(|antenna| antenna.name.clone());
                    AlarmKind::SafetySetting { note, antenna }
                }
            };
            self.alarms.raise(None, kind, self.now);
        }
    }

    pub(super) fn load_station(&mut self) {
        // The running demo ends after another station is in use.
        let _demo = self.demo.take();
        let loaded = match &self.settings_path {
            Some(path) => station::load(path, SPECS),
            None => Err(LoadError::Missing),
        };
        self.load_learned_drives();
        match loaded {
            Ok(loaded) => {
                self.station_saved_at = self.settings_path.as_deref().and_then(station::saved_at);
                self.raise_notes(loaded.notes, &loaded.station);
                self.use_station(loaded.station);
                self.pay_left_debts();
            }
            Err(LoadError::Missing) => {
                self.station_claim = StationClaim::None;
                self.demo = Some(DemoStation::Coming);
                self.use_station(Station {
                    antennas: Vec::new(),
                    ..Station::demo(&DemoAddresses::default())
                });
            }
            Err(error) => {
                let text = error.to_string();
                tracing::error!("{text}");
                self.alarms.raise(None, AlarmKind::Settings(text), self.now);
                // Without the operator, Azel connects and overwrites nothing.
                self.settings_unread = true;
                self.use_station(Station::default());
            }
        }
    }

    /// Uses a station. Unchanged antennas keep their session.
    pub(super) fn use_station(&mut self, station: Station) {
        self.record_station(&station);
        // A new session adopts the learned properties of the previous one.
        self.note_learned_drives();
        self.keep_locked_out(&station.antennas);
        let mut before = std::mem::take(&mut self.antennas);
        // Drop the alarms of units that leave; an owed STOP has its own alarm.
        let has_same_unit = |new: &&station::Antenna| {
            let previous = before.iter().find(|antenna| antenna.shown.id() == new.id);
            previous.is_some_and(|previous| Unit::new(&previous.shown.config) == Unit::new(new))
        };
        let unchanged: Vec<AntennaId> =
            station.antennas.iter().filter(has_same_unit).map(|antenna| antenna.id).collect();
        self.alarms.keep_only(&unchanged);
        // The antenna may be the same one at a new address, so both units are owed a STOP.
        let debts = self.driver.debts().clone();
        let owed: Vec<String> = (before.iter())
            .filter(|antenna| debts.owes(&Unit::new(&antenna.shown.config)))
            .map(|antenna| antenna.shown.config.name.clone())
            .collect();
        // A unit accepts one client, so the old session leaves first.
        let is_kept = |antenna: &mut Antenna| {
            antenna.shown.held_by.is_none() && station.antennas.contains(&antenna.shown.config)
        };
        let mut changed: Vec<Changed> = Vec::new();
        for antenna in before.extract_if(.., |antenna| !is_kept(antenna)) {
            let unit = Unit::new(&antenna.shown.config);
            let is_of =
                |new: &station::Antenna| new.id == antenna.shown.id() && Unit::new(new) == unit;
            let is_left = !station.antennas.iter().any(is_of) && antenna.shown.held_by.is_none();
            if is_left && antenna.may_have_auto_track() {
                let marked = debts.mark_auto_track_off(&unit, self.now);
                if let Err(error) = marked {
                    tracing::error!(%error, "the next start would not know of this auto-track");
                }
            }
            let AntennaModel { operation, config, .. } = antenna.shown;
            changed.push(Changed { unit, id: config.id, operation, at_work: antenna.at_work });
        }
        for config in &station.antennas {
            let bounds = Bounds::new(&station, config);
            let position = before.iter().position(|antenna| *antenna.shown.config == *config);
            let antenna = if let Some(place) = position {
                let antenna = before.swap_remove(place);
                antenna.handle.keep_within(bounds);
                antenna
            } else {
                let mut antenna = self.open_antenna(config.clone(), bounds);
                let was = changed.iter().position(|changed| changed.id == config.id);
                if let Some(was) = was.map(|was| changed.swap_remove(was)) {
                    antenna.shown.operation = was.operation;
                    antenna.shown.operation.switch_off(OffBecause::Changed);
                    let is_same_unit = was.unit == Unit::new(config);
                    antenna.at_work =
                        if is_same_unit { was.at_work } else { was.at_work.without_unit() };
                }
                if owed.contains(&config.name) {
                    antenna.handle.stop();
                }
                antenna
            };
            self.antennas.push(antenna);
        }
        self.station = Arc::new(station);
        for index in 0..self.antennas.len() {
            self.cancel_resumption(index);
        }
        self.keep_fingerprint();
        // From here on, STOP reaches the new sessions.
        self.publish();
    }

    pub(super) fn open_antenna(&mut self, config: station::Antenna, bounds: Bounds) -> Antenna {
        let config = Arc::new(config);
        let claim = self.claim_unit(&config, None);
        self.open_claimed(config, bounds, claim)
    }

    /// Opens an antenna with a claim on its unit, or leaves the unit to its holder.
    pub(super) fn open_claimed(
        &mut self,
        config: Arc<station::Antenna>,
        bounds: Bounds,
        claim: Result<Option<Claim>, Elsewhere>,
    ) -> Antenna {
        self.sessions += 1;
        let (handle, held_by, hold) = match claim {
            Ok(claim) => {
                let lock_out = self.lock_outs.find(&config.connection).cloned();
                // The claim lasts until the session ends.
                let lock = Box::new(claim.clone());
                // Connect without the operator only at the start, not after a change of settings.
                let connects_at_start = config.connects_at_start && !self.has_started;
                let opened =
                    station::Antenna { connects_at_start, ..station::Antenna::clone(&config) };
                let learned = self.learned_drives(&config);
                let handle = self.driver.open(&opened, bounds, learned, lock_out, lock);
                (handle, None, Hold::Ours(claim))
            }
            Err(Elsewhere { holder, lock }) => {
                (Driver::leave_alone(&config), Some(holder), Hold::Elsewhere(lock))
            }
        };
        self.recording.follow(&config, &handle, self.clock.now());
        let mut shown = AntennaModel::new(config, handle.snapshot());
        shown.held_by = held_by;
        Antenna {
            shown,
            recent: Recent::default(),
            session: self.sessions,
            handle,
            at_work: AtWork::default(),
            hold,
        }
    }

    /// Returns the index of an antenna, if the station still has it.
    pub(super) fn place(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.shown.id() == id)
    }
}
