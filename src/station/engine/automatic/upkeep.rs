//! Maintenance of a unit between passes, by the rules of its antenna. This module sets the unit's
//! clock, and [`elements`] uploads elements.

mod elements;

use std::time::Duration;

use jiff::Timestamp;

pub(in crate::engine) use self::elements::RuleUpload;
use crate::{
    astro::time::seconds_between,
    clock::Instant,
    contract::{
        antenna::AntennaModel,
        automatic::DayEvent,
        driver::{self, TimeSync},
    },
    device::{
        ClockSetting, UnitClock,
        settings::{Change, Hindrance, WriteError},
    },
    engine::{Antenna, Engine, automatic::Operate},
    plan::schedule::{Entry, sets_out},
    station::{AntennaId, BetweenPasses, Upkeep},
};

/// Min time before departure for setting the unit's clock, seconds.
const MIN_TIME_FOR_CLOCK_S: f64 = 60.0;
/// Max age of a clock reading, seconds.
const MAX_READING_AGE_S: f64 = 30.0;
/// Timeout for the unit's answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(90);
/// Pause before the next attempt if Azel sent nothing because the antenna was not at rest.
const RETRY_AT_REST: Duration = Duration::from_secs(10);
/// Pause between two attempts.
const RETRY: Duration = Duration::from_hours(1);
/// First ticket of upkeep; tickets of sessions, uploads and forms are lower.
const TICKETS: u64 = 3 << 62;

/// Upkeep of one unit.
#[derive(Default)]
pub(super) struct UpkeepWork {
    setting: Option<ClockChange>,
    tickets: u64,
    /// Earliest time to set the clock again.
    next_setting: Option<Instant>,
    /// Earliest time to check the unit's elements again.
    next_check: Option<Instant>,
    /// Number of checks in a row at which another upload blocked a due one.
    blocked: u32,
}

/// Pending change of a unit's clock.
#[derive(Clone, Copy)]
struct ClockChange {
    ticket: u64,
    group: &'static str,
    sent: Instant,
    /// Error before the change, seconds ahead; `None` for a clock that was never set.
    was_ahead_s: Option<f64>,
}

impl Engine {
    /// Carries out the rules of an antenna for its unit.
    pub(super) fn run_upkeep(&mut self, index: usize) {
        self.end_clock_change(index);
        self.set_clock(index);
        self.keep_elements(index);
    }

    fn set_clock(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let Some((setting, was_ahead_s)) = self.clock_to_set(antenna) else { return };
        if !self.prepare_for_settings(index) {
            return;
        }
        let steady = self.steady;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let work = &mut antenna.at_work.upkeep;
        work.tickets += 1;
        work.next_setting = Some(steady + RETRY);
        let ticket = TICKETS + work.tickets;
        let ClockSetting { group, from_here, .. } = *setting;
        work.setting = Some(ClockChange { ticket, group, sent: steady, was_ahead_s });
        let values = from_here();
        let change = Change { ticket, group, values, expected: None, is_unlocked: false };
        self.send(index, driver::Command::WriteSettings(change));
    }

    /// Returns the unit's clock if Azel should set it now, with its error in seconds ahead.
    fn clock_to_set(&self, antenna: &Antenna) -> Option<(&'static ClockSetting, Option<f64>)> {
        let (shown, work) = (&antenna.shown, &antenna.at_work.upkeep);
        let setting = shown.variant().clock?;
        let clock = shown.snapshot.state.on_board.clock?;
        let is_due = is_clock_off(&shown.config.upkeep, clock, self.now)
            && work.setting.is_none()
            && work.next_setting.is_none_or(|instant| self.steady >= instant)
            && !is_kept_by_unit(setting, shown)
            && self.time_sync == TimeSync::Synchronised
            && self.is_between_passes(shown, MIN_TIME_FOR_CLOCK_S);
        is_due.then(|| (setting, clock.is_set.then_some(clock.ahead_s)))
    }

    /// Returns `true` if automatic operation is on and idle, and the antenna does not set out
    /// within `takes_s` seconds.
    fn is_between_passes(&self, antenna: &AntennaModel, takes_s: f64) -> bool {
        let entries = &self.schedule.schedule.entries;
        antenna.operation.is_idle()
            && antenna.is_live()
            && antenna.held_by.is_none()
            && antenna.snapshot.lock_out.is_none()
            && self.schedule.made_at.is_some()
            && !self.scheduler.is_at_work()
            && is_free(entries, antenna.id(), self.now, takes_s)
    }

    /// Returns `true` if the unit takes settings that affect its pointing. Otherwise first switches
    /// off an auto-track of automatic operation; the next pass switches it on again.
    fn prepare_for_settings(&mut self, index: usize) -> bool {
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

    /// Handles the unit's answer to a clock change.
    fn end_clock_change(&mut self, index: usize) {
        let steady = self.steady;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let Some(change) = antenna.at_work.upkeep.setting else { return };
        let groups = &antenna.shown.snapshot.state.groups;
        let written = groups.get(change.group).and_then(|group| group.written.as_ref());
        let answer = written.filter(|written| written.change.ticket == change.ticket);
        let day_event = match answer {
            Some(written) => match &written.result {
                Ok(()) => DayEvent::ClockSet { was_ahead_s: change.was_ahead_s },
                // At the end of a pass, Azel may still be stopping the unit.
                Err(WriteError::Hindered { .. }) => {
                    let work = &mut antenna.at_work.upkeep;
                    work.setting = None;
                    work.next_setting = Some(steady + RETRY_AT_REST);
                    return;
                }
                Err(reason) => DayEvent::ClockNotSet { reason: reason.to_string() },
            },
            None if steady.saturating_duration_since(change.sent) > ANSWER_TIMEOUT => {
                DayEvent::ClockNotSet {
                    reason: "the unit did not answer, or STOP came first".to_owned(),
                }
            }
            None => return,
        };
        antenna.at_work.upkeep.setting = None;
        let id = antenna.shown.id();
        self.note_day(id, day_event);
    }
}

/// Returns `true` if a recently read clock is certainly off by more than the limit.
fn is_clock_off(rule: &Upkeep, clock: UnitClock, now: Timestamp) -> bool {
    let age_s = seconds_between(clock.read_at, now);
    let is_off = !clock.is_set || clock.surely_ahead_s().abs() > rule.clock_limit_s;
    rule.sets_clock && (0.0..=MAX_READING_AGE_S).contains(&age_s) && is_off
}

/// Returns `true` if the antenna has no pass under way, and does not set out for one within
/// `takes_s` seconds.
fn is_free(entries: &[Entry], antenna: AntennaId, now: Timestamp, takes_s: f64) -> bool {
    !entries.iter().any(|entry| {
        let sets_out = sets_out(entry, BetweenPasses::Stay);
        entry.antenna == antenna && now < entry.end && seconds_between(now, sets_out) < takes_s
    })
}

fn is_kept_by_unit(setting: &ClockSetting, antenna: &AntennaModel) -> bool {
    let group = antenna.snapshot.state.groups.get(setting.group);
    let reading = group.and_then(|group| group.last_read.as_ref());
    reading.is_some_and(|reading| (setting.is_kept_by_unit)(&reading.values))
}
