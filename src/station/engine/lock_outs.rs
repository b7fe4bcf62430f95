//! Locked-out units: the file beside the station file, and the sessions that must know.

use std::{path::Path, sync::Arc};

use super::Engine;
use crate::{
    contract::{alarms::AlarmKind, driver::Command, uploads::Ask},
    engine::alarms::KeepAlarms,
    promises::FileState,
    station::{Antenna, LOCK_OUTS_FILE, LockOut},
};

impl Engine {
    /// Reloads the list. An unreadable list locks out every unit.
    pub(super) fn load_lock_outs(&mut self) {
        let folder = self.settings_path.as_deref().and_then(Path::parent);
        let path = folder.map(|folder| folder.join(LOCK_OUTS_FILE));
        let problem = match path {
            Some(path) => self.lock_outs.reload(&path, self.now),
            None => None,
        };
        if let Some(problem) = problem {
            tracing::error!("{LOCK_OUTS_FILE} cannot be read: {problem}");
            let text = format!(
                "every unit is locked out until you remove its lock-out, because the list of \
                 lock-outs cannot be read: {problem}"
            );
            self.alarms.raise(None, AlarmKind::LockOuts(text), self.now);
        }
    }

    /// Sets or removes the lock-out of an antenna's unit.
    pub(super) fn set_lock_out(&mut self, index: usize, lock_out: Option<LockOut>) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let config = &antenna.shown.config;
        let (name, connection) = (config.name.clone(), config.connection.clone());
        let is_locked = lock_out.is_some();
        if self.demo.is_none() {
            // Another Azel may have written the list, for another station in this folder.
            self.load_lock_outs();
        }
        let station = Arc::clone(&self.station);
        let all = station.antennas.iter().map(|antenna| &antenna.connection);
        self.lock_outs.set(&connection, lock_out, all);
        self.keep_lock_outs();
        if is_locked && self.uploads.antenna == name {
            self.ask_about_upload(Ask::Cancel);
        }
        for index in 0..self.antennas.len() {
            self.tell_lock_out(index);
        }
    }

    /// Moves lock-outs to the new addresses of their antennas.
    pub(super) fn keep_locked_out(&mut self, after: &[Antenna]) {
        let antennas = self.antennas.iter();
        let before: Vec<Antenna> =
            antennas.map(|antenna| Antenna::clone(&antenna.shown.config)).collect();
        if self.lock_outs.stay_with_antennas(&before, after) {
            self.keep_lock_outs();
        }
    }

    /// Saves the list, except for the demo station, whose units have no lasting address.
    fn keep_lock_outs(&mut self) {
        if self.demo.is_some() {
            return;
        }
        let folder = self.settings_path.as_deref().and_then(Path::parent);
        let saved = match folder {
            Some(folder) => {
                self.lock_outs.text().map_err(|error| error.to_string()).and_then(|text| {
                    let state = FileState::HoldsAndKeepsOld(text);
                    self.driver.debts().promises().put_and_wait(&folder.join(LOCK_OUTS_FILE), state)
                })
            }
            None => Err("this user has no folder for settings".to_owned()),
        };
        if saved.is_ok() {
            self.lock_outs.saved();
        }
        let now = self.now;
        self.alarms.clear(None, self.now, |kind| matches!(kind, AlarmKind::LockOuts(_)));
        if let Err(reason) = saved {
            tracing::error!("{reason}");
            let text = format!("what is locked out is not kept for the next start: {reason}");
            self.alarms.raise(None, AlarmKind::LockOuts(text), now);
        }
    }

    /// Sends a session its lock-out until the snapshot shows it: a STOP voids an unlock.
    pub(super) fn tell_lock_out(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        if antenna.shown.held_by.is_some() {
            return;
        }
        let lock_out = self.lock_outs.find(&antenna.shown.config.connection);
        let snapshot = antenna.handle.snapshot();
        if snapshot.lock_out.as_ref() == lock_out {
            return;
        }
        let command = lock_out.cloned().map_or(Command::Unlock, Command::LockOut);
        if antenna.handle.send(command).is_err() {
            tracing::warn!(
                antenna = antenna.shown.config.name,
                "the lock-out waits for the session"
            );
        }
    }
}
