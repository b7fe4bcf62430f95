//! Keeps a unit fit between passes, by the rules of its antenna: sets its clock here, and uploads
//! elements in [`elements`].

mod elements;

use jiff::Timestamp;

use super::{DayEvent, Doing, On, Operation, sets_out};
use crate::{
    astro::time::{add_seconds, seconds_between},
    device::{
        ClockSetting, UnitClock,
        settings::{Change, Hindrance},
    },
    driver::{self, TimeSync},
    engine::{Antenna, Engine, antenna::AntennaModel},
    plan::schedule::Entry,
    station::{AntennaId, BetweenPasses, Upkeep},
};

/// Time that must be left before the antenna sets out, for its clock to be set, seconds.
const CLOCK_TAKES_S: f64 = 60.0;
/// A reading of the clock that is older tells nothing, seconds.
const READING_LASTS_S: f64 = 30.0;
/// Time limit for the unit's answer, seconds.
const ANSWER_S: f64 = 90.0;
/// Time between two attempts, seconds.
const AGAIN_S: f64 = 3600.0;
/// Tickets begin here; those of sessions, uploads and forms are lower.
const TICKETS: u64 = 3 << 62;

/// Upkeep of one unit.
#[derive(Default)]
pub(super) struct UpkeepWork {
    setting: Option<ClockChange>,
    tickets: u64,
    next_try: Option<Timestamp>,
    /// When the elements of the unit are looked at again.
    next_look: Option<Timestamp>,
}

/// A clock that is being set.
#[derive(Clone, Copy)]
struct ClockChange {
    ticket: u64,
    group: &'static str,
    sent_at: Timestamp,
    was_ahead_s: f64,
}

impl Engine {
    /// Does what the rules of an antenna say about its unit.
    pub(super) fn keep_up(&mut self, index: usize) {
        self.end_clock_change(index);
        self.set_clock(index);
        self.keep_elements(index);
    }

    fn set_clock(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let Some((setting, was_ahead_s)) = self.clock_to_set(antenna) else { return };
        if !self.is_at_rest(index) {
            return;
        }
        let now = self.now;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let work = &mut antenna.at_work.upkeep;
        work.tickets += 1;
        work.next_try = Some(add_seconds(now, AGAIN_S));
        let ticket = TICKETS + work.tickets;
        let ClockSetting { group, from_here, .. } = *setting;
        work.setting = Some(ClockChange { ticket, group, sent_at: now, was_ahead_s });
        let values = from_here();
        let change = Change { ticket, group, values, seen: None, is_unlocked: false };
        self.send(index, driver::Command::WriteSettings(change));
    }

    /// The clock of an antenna's unit, and how far it is ahead, if it is to be set now.
    fn clock_to_set(&self, antenna: &Antenna) -> Option<(&'static ClockSetting, f64)> {
        let (shown, work) = (&antenna.shown, &antenna.at_work.upkeep);
        let setting = shown.variant().clock?;
        let clock = shown.snapshot.state.on_board.clock?;
        let is_due = is_clock_off(&shown.config.upkeep, clock, self.now)
            && work.setting.is_none()
            && work.next_try.is_none_or(|at| self.now >= at)
            && !is_kept_by_unit(setting, shown)
            && self.time_sync == TimeSync::Synchronised
            && self.is_between_passes(shown, CLOCK_TAKES_S);
        is_due.then_some((setting, clock.ahead_s))
    }

    /// Automatic operation is on, nothing is asked of the antenna, and it does not set out within
    /// `takes_s` seconds.
    fn is_between_passes(&self, antenna: &AntennaModel, takes_s: f64) -> bool {
        let rests = matches!(
            antenna.operation,
            Operation::On(On { doing: Doing::Rests | Doing::Parks, .. })
        );
        let entries = &self.schedule.schedule.entries;
        rests
            && antenna.is_live()
            && antenna.held_by.is_none()
            && antenna.snapshot.lock_out.is_none()
            && self.schedule.made_at.is_some()
            && !self.scheduler.is_at_work()
            && is_free(entries, antenna.id(), self.now, takes_s)
    }

    /// Returns `true` if the unit takes settings that decide where it points. Auto-track of automatic
    /// operation ends first; the next pass switches it on again.
    fn is_at_rest(&mut self, index: usize) -> bool {
        let Some(antenna) = self.antennas.get(index) else { return false };
        let shown = &antenna.shown;
        match shown.snapshot.hindrance(shown.variant().capabilities, self.steady) {
            None => true,
            Some(Hindrance::AutoTrack) if antenna.at_work.has_auto_track_on => {
                self.end_auto_track(index);
                false
            }
            Some(_) => false,
        }
    }

    /// Takes the unit's answer to a clock that was set.
    fn end_clock_change(&mut self, index: usize) {
        let now = self.now;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let Some(change) = antenna.at_work.upkeep.setting else { return };
        let held = &antenna.shown.snapshot.state.held;
        let written = held.get(change.group).and_then(|group| group.written.as_ref());
        let answer = written.filter(|written| written.change.ticket == change.ticket);
        let what = match answer {
            Some(written) => match &written.result {
                Ok(()) => DayEvent::ClockSet { was_ahead_s: change.was_ahead_s },
                Err(why) => DayEvent::ClockNotSet { why: why.to_string() },
            },
            None if seconds_between(change.sent_at, now) > ANSWER_S => {
                DayEvent::ClockNotSet { why: "the unit did not answer".to_owned() }
            }
            None => return,
        };
        antenna.at_work.upkeep.setting = None;
        let id = antenna.shown.id();
        self.note_day(id, what);
    }
}

/// Returns `true` if a clock that was read a moment ago is surely off by more than the limit.
fn is_clock_off(rule: &Upkeep, clock: UnitClock, now: Timestamp) -> bool {
    let age_s = seconds_between(clock.read_at, now);
    let is_off = !clock.is_set || clock.surely_ahead_s().abs() > rule.clock_limit_s;
    rule.sets_clock && (0.0..=READING_LASTS_S).contains(&age_s) && is_off
}

/// Returns `true` if no pass of the antenna is under way, and it does not set out for one within
/// `takes_s` seconds.
fn is_free(entries: &[Entry], antenna: AntennaId, now: Timestamp, takes_s: f64) -> bool {
    !entries.iter().any(|entry| {
        let sets_out = sets_out(entry, BetweenPasses::Stay);
        entry.antenna == antenna && now < entry.to && seconds_between(now, sets_out) < takes_s
    })
}

fn is_kept_by_unit(setting: &ClockSetting, antenna: &AntennaModel) -> bool {
    let group = antenna.snapshot.state.held.get(setting.group);
    let held = group.and_then(|group| group.held.as_ref());
    held.is_some_and(|held| (setting.is_kept_by_unit)(&held.values))
}
