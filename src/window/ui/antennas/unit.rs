//! Unit as the current frame shows it.

use jiff::Timestamp;

use crate::{
    astro::time::add_seconds,
    contract::{antenna::AntennaModel, driver::Intent},
    device::settings::{Group, GroupState, Hindrance, ReadFailure, Values},
    model::Model,
};

/// Unit in the current frame, with the rights of its form.
#[derive(Clone, Copy)]
pub(super) struct ShownUnit<'a> {
    pub(super) model: &'a Model,
    /// Index among the antennas.
    pub(super) index: usize,
    pub(super) antenna: &'a AntennaModel,
    /// Flag: the service functions are open.
    pub(super) is_unlocked: bool,
}

impl<'a> ShownUnit<'a> {
    pub(super) fn new(model: &'a Model, index: usize) -> Option<Self> {
        let antenna = model.antennas.get(index)?;
        Some(Self { model, index, antenna, is_unlocked: false })
    }

    pub(super) fn name(&self) -> &'a str {
        &self.antenna.config.name
    }

    /// Returns the description of one of the unit's groups.
    pub(super) fn description(&self, key: &str) -> Option<&'static Group> {
        self.antenna.groups().iter().copied().find(|group| group.key == key)
    }

    pub(super) fn group(&self, key: &str) -> Option<&'a GroupState> {
        self.antenna.snapshot.state.groups.get(key)
    }

    /// Returns the values of the group at its last reading.
    pub(super) fn values(&self, key: &str) -> Option<&'a Values> {
        self.group(key)?.last_read.as_ref().map(|group| &group.values)
    }

    pub(super) fn read_at(&self, key: &str) -> Option<Timestamp> {
        self.group(key)?.last_read.as_ref().map(|group| group.read_at)
    }

    pub(super) fn failure(&self, key: &str) -> Option<&'a ReadFailure> {
        self.group(key)?.failure.as_ref()
    }

    pub(super) fn is_open(&self) -> bool {
        self.antenna.snapshot.link.is_open()
    }

    /// Returns `true` if Azel has read the group on the current link. Values from an earlier link
    /// may be outdated.
    pub(super) fn is_fresh(&self, key: &str) -> bool {
        let Some(start) = self.antenna.snapshot.state.link_since.filter(|_| self.is_open()) else {
            return false;
        };
        let up_s = self.model.steady.saturating_duration_since(start).as_secs_f64();
        self.read_at(key).is_some_and(|time| time >= add_seconds(self.model.now, -up_s))
    }

    /// Returns `true` if the unit's own program is on, or not known to be off. For a unit without a
    /// program, returns `true` if Azel tracks with the unit.
    pub(super) fn tracks(&self) -> bool {
        let program = self.antenna.snapshot.state.program;
        if self.antenna.variant().capabilities.has_program {
            return program.is_none_or(|program| program.enabled);
        }
        let follows = self.antenna.snapshot.intent == Intent::Track;
        follows || program.is_some_and(|program| program.enabled)
    }

    /// Returns the reason why a setting that decides where the antenna points has to wait.
    pub(super) fn hindrance(&self) -> Option<Hindrance> {
        let can = self.antenna.variant().capabilities;
        self.antenna.snapshot.hindrance(can, self.model.steady)
    }

    /// Returns `true` if Azel knows that the antenna neither turns nor is about to turn.
    pub(super) fn stands(&self) -> bool {
        let moving = |measured: crate::device::Measured| measured.moving();
        let measured = self.antenna.snapshot.state.measured;
        self.is_open() && !self.tracks() && measured.is_some_and(|measured| !moving(measured))
    }
}
