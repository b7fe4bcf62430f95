//! Changes of settings on their way to a session. Changes of service settings wait until the
//! previous values are saved in a file.

use super::{
    Engine,
    copies::{Outcome, Waiting},
};
use crate::{
    contract::{
        alarms::AlarmKind,
        copies::{OpenCopy, Saving},
        driver,
    },
    device::settings::{Change, Guard},
    engine::alarms::KeepAlarms,
};

impl Engine {
    /// Returns `true` if a change must wait for a copy of the values it replaces.
    fn needs_copy(&self, index: usize, change: &Change) -> bool {
        let Some(antenna) = self.antennas.get(index) else { return false };
        let group = antenna.shown.groups().iter().find(|group| group.key == change.group);
        change.is_unlocked && group.is_some_and(|one| one.guard(&change.values) == Guard::Service)
    }

    /// Sends a change to the session. A service setting waits until a copy is saved.
    pub(super) fn write_settings(&mut self, index: usize, change: Change) {
        if !self.needs_copy(index, &change) {
            return self.send(index, driver::Command::WriteSettings(change));
        }
        let Some(antenna) = self.antennas.get(index) else { return };
        let name = antenna.shown.config.name.clone();
        if let Some(waiting) = self.copy_work.waiting.as_mut().filter(|entry| entry.antenna == name)
        {
            return waiting.changes.push(change);
        }
        match self.copy_work.save(&antenna.shown, self.now) {
            Ok(()) => {
                self.copy_work.waiting = Some(Waiting { antenna: name, changes: vec![change] });
            }
            Err(reason) => self.service_not_sent(index, &not_saved(&reason)),
        }
    }

    /// Drops changes that wait for their copy: a STOP voids them.
    pub(super) fn drop_waiting_settings(&mut self) {
        let Some(waiting) = self.copy_work.waiting.take() else { return };
        let names = self.antennas.iter().map(|antenna| antenna.shown.config.name.as_str());
        if let Some(index) = names.into_iter().position(|name| name == waiting.antenna) {
            self.service_not_sent(index, "STOP was pressed meanwhile");
        }
    }

    fn service_not_sent(&mut self, index: usize, reason: &str) {
        let text = format!("no service setting was sent, because {reason}");
        tracing::error!("{text}");
        let antenna_id = self.antennas.get(index).map(|antenna| antenna.shown.id());
        self.alarms.raise(antenna_id, AlarmKind::Settings(text), self.now);
    }

    /// Saves the settings that were read from an antenna's unit.
    pub(super) fn save_copy(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        if let Err(reason) = self.copy_work.save(&antenna.shown, self.now) {
            let (antenna, time) = (antenna.shown.config.name.clone(), self.now);
            self.copies.saved = Some(Saving { antenna, time, result: Err(reason) });
        }
    }

    /// Opens the comparison of an antenna with a file.
    pub(super) fn open_copies(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let name = antenna.shown.config.name.clone();
        self.copy_work.list(&name);
        self.copies.open = Some(OpenCopy { antenna: name, listed: Vec::new(), read: None });
    }

    /// Handles the outcomes of the thread for copies.
    pub(super) fn take_copies(&mut self) {
        let Some(outcome) = self.copy_work.turn(&self.wake) else { return };
        let now = self.now;
        match outcome {
            Outcome::Saved { antenna, result } => {
                self.after_copy(&antenna, result.as_ref().err().cloned());
                self.copies.saved = Some(Saving { antenna, time: now, result });
            }
            Outcome::Listed(paths) => {
                if let Some(open) = &mut self.copies.open {
                    open.listed = paths;
                }
            }
            Outcome::Read(path, copy) => {
                if let Some(open) = &mut self.copies.open {
                    open.read = Some((path, copy));
                }
            }
        }
    }

    /// Sends the changes that waited for the copy of `antenna`, unless the copy failed.
    fn after_copy(&mut self, antenna: &str, failure: Option<String>) {
        let Some(waiting) = self.copy_work.waiting.take_if(|entry| entry.antenna == antenna) else {
            return;
        };
        let names = self.antennas.iter().map(|antenna| antenna.shown.config.name.as_str());
        let Some(index) = names.into_iter().position(|name| name == antenna) else { return };
        match failure {
            Some(reason) => self.service_not_sent(index, &not_saved(&reason)),
            None => {
                for change in waiting.changes {
                    self.send(index, driver::Command::WriteSettings(change));
                }
            }
        }
    }
}

fn not_saved(reason: &str) -> String {
    format!("the old values could not be saved first: {reason}")
}
