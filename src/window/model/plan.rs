//! The plan, as the plan view shows it: each pass of the favourites with its place in the schedule.

mod pose;

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::Model;
use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::{
        antenna::AntennaModel,
        automatic::{DayEvent, Flown, Taking},
        passes::{PassListKey, PredictedPass},
        schedule::Swap,
    },
    plan::schedule::{Entry, LeftOut, LeftOutReason},
    station::{AntennaId, PassChoice, Priority},
};
pub use pose::{PlannedActivity, Pose};

/// Max difference between the AOS of the same pass in the list and in the schedule, seconds.
const SAME_AOS_S: f64 = 60.0;

/// A pass of the list with its place in the schedule.
#[derive(Debug, Clone)]
pub struct PlannedPass<'a> {
    pub predicted: &'a PredictedPass,
    /// Entries of the pass; two if one antenna hands the pass over to another.
    pub entries: Vec<&'a Entry>,
    /// Reason why the schedule leaves the pass out; also `None` while no schedule contains the
    /// pass.
    pub left_out: Option<&'a LeftOut>,
    pub choice: Option<&'a PassChoice>,
}

/// A satellite with its passes.
#[derive(Debug, Clone)]
pub struct PlannedSatellite<'a> {
    pub number: u32,
    pub name: &'a str,
    pub priority: Priority,
    pub passes: Vec<PlannedPass<'a>>,
}

/// Status of a pass on one antenna.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Standing<'a> {
    /// A pass that is over.
    Flown(&'a Flown),
    /// A pass that the antenna tracks now.
    Running,
    /// A pass to which the antenna moves; the motion was confirmed at this time.
    Proved(Timestamp),
    /// A pass for which Azel commanded the unit at this time, without confirmation yet.
    Sent(Timestamp),
    /// A pass to which Azel will send the antenna.
    Planned(&'a Entry),
    /// A pass that another antenna takes.
    TakenBy(AntennaId),
    LeftOut(&'a LeftOutReason),
    /// A pass that is not in any schedule yet.
    NotKnown,
}

/// A row of the list of one antenna.
#[derive(Debug, Clone)]
pub struct ListedPass<'a> {
    pub key: PassListKey,
    pub name: &'a str,
    pub los: Timestamp,
    pub max_elevation_deg: Option<f64>,
    pub entry: Option<&'a Entry>,
    pub standing: Standing<'a>,
    /// Plan of the pass if the pass is not over.
    pub planned: Option<PlannedPass<'a>>,
}

fn is_same(entry: (u32, Timestamp), key: PassListKey) -> bool {
    entry.0 == key.0 && seconds_between(entry.1, key.1).abs() < SAME_AOS_S
}

impl Model {
    /// Returns the end of the plan.
    pub fn plan_until(&self) -> Timestamp {
        add_seconds(self.now, self.station.scheduling.span_h * 3600.0)
    }

    /// Returns the entry of the plan that an antenna carries out now or next.
    pub fn next_entry(&self, antenna: AntennaId) -> Option<&Entry> {
        let entries = self.schedule.schedule.entries.iter();
        let own = entries.filter(|entry| entry.antenna == antenna && entry.end > self.now);
        own.min_by_key(|entry| entry.start)
    }

    /// Returns the antennas that take a pass in the plan, or the selected antenna if none does.
    pub fn antennas_of(&self, key: PassListKey) -> Vec<AntennaId> {
        let entries = self.schedule.schedule.entries.iter();
        let own = entries.filter(|entry| is_same((entry.pass.satellite, entry.pass.aos), key));
        let own: Vec<AntennaId> = own.map(|entry| entry.antenna).collect();
        if own.is_empty() {
            self.antenna().map(AntennaModel::id).into_iter().collect()
        } else {
            own
        }
    }

    /// Returns the cost of this pass in the current schedule, once it is computed.
    pub fn swap_of(&self, pass: PassListKey) -> Option<&Swap> {
        let fits = |swap: &&Swap| swap.pass == pass && swap.revision == self.schedule.revision;
        self.swap.as_deref().filter(fits)
    }

    /// Returns all future passes and their place in the schedule, by AOS.
    pub fn planned_passes(&self) -> Vec<PlannedPass<'_>> {
        self.planned_passes_until(self.plan_until())
    }

    /// Returns the future passes with AOS before `end` and their place in the schedule, by AOS.
    pub fn planned_passes_until(&self, end: Timestamp) -> Vec<PlannedPass<'_>> {
        let schedule = &self.schedule.schedule;
        let last = add_seconds(end, SAME_AOS_S);
        let ahead = self.pass_lists.favourites.upcoming(self.now);
        let mut entries: BTreeMap<u32, Vec<&Entry>> = BTreeMap::new();
        for entry in schedule.entries.iter().filter(|entry| entry.pass.aos < last) {
            entries.entry(entry.pass.satellite).or_default().push(entry);
        }
        let planned = ahead.starting_before(end).map(|predicted| {
            let own = entries.get(&predicted.number()).into_iter().flatten();
            self.planned(predicted, own.copied())
        });
        planned.collect()
    }

    /// Returns a pass with its place in the schedule.
    pub fn planned_pass<'a>(&'a self, predicted: &'a PredictedPass) -> PlannedPass<'a> {
        self.planned(predicted, self.schedule.schedule.entries.iter())
    }

    /// Returns the selected pass if it lies within the plan.
    pub fn selected_planned(&self) -> Option<PlannedPass<'_>> {
        let predicted = self.pass_lists.favourites.find(self.selected_pass()?.key())?;
        let is_planned = !predicted.is_always_up() && predicted.pass.aos.time < self.plan_until();
        is_planned.then(|| self.planned_pass(predicted))
    }

    fn planned<'a>(
        &'a self,
        predicted: &'a PredictedPass,
        entries: impl Iterator<Item = &'a Entry>,
    ) -> PlannedPass<'a> {
        let key = predicted.key();
        let (number, pass) = (key.0, &predicted.pass);
        PlannedPass {
            predicted,
            entries: entries
                .filter(|entry| is_same((entry.pass.satellite, entry.pass.aos), key))
                .collect(),
            left_out: self.left_out(key),
            choice: self.station.pass_choice(number, (pass.aos.time, pass.los.time)),
        }
    }

    /// Returns the entry of the schedule for a pass that it leaves out.
    fn left_out(&self, key: PassListKey) -> Option<&LeftOut> {
        let all = &self.schedule.schedule.left_out;
        let (start, end) = (add_seconds(key.1, -SAME_AOS_S), add_seconds(key.1, SAME_AOS_S));
        let near = all.iter().skip(all.partition_point(|entry| entry.pass.aos <= start));
        let mut near = near.take_while(|entry| entry.pass.aos < end);
        near.find(|entry| is_same((entry.pass.satellite, entry.pass.aos), key))
    }

    /// Returns the satellites of the plan by priority, then in the order of the favourites.
    pub fn planned_satellites(&self) -> Vec<PlannedSatellite<'_>> {
        let mut by_number: BTreeMap<u32, Vec<PlannedPass<'_>>> = BTreeMap::new();
        for planned in self.planned_passes() {
            by_number.entry(planned.predicted.number()).or_default().push(planned);
        }
        let priorities = self.station.priorities();
        let favourites = &self.pass_lists.favourites.satellites;
        let mut satellites: Vec<PlannedSatellite<'_>> = favourites
            .iter()
            .filter(|satellite| !satellite.elements.is_geosynchronous())
            .map(|satellite| {
                let number = satellite.elements.catalog_number();
                PlannedSatellite {
                    number,
                    name: satellite.short_name(),
                    priority: priorities.get(&number).copied().unwrap_or_default(),
                    passes: by_number.remove(&number).unwrap_or_default(),
                }
            })
            .collect();
        satellites.sort_by_key(|satellite| satellite.priority);
        satellites
    }

    /// Returns the passes of this day that are over for an antenna.
    pub fn flown_by(&self, antenna: AntennaId) -> impl Iterator<Item = &Flown> + Clone {
        let own = self.day.iter().filter(move |line| line.antenna == antenna);
        own.filter_map(|line| match &line.event {
            DayEvent::Flown(flown) => Some(flown),
            _ => None,
        })
    }

    /// Returns the status of passes on an antenna that are not over.
    pub fn standings_on(&self, antenna: &AntennaModel) -> Standings<'_> {
        let mut flown: Vec<&Flown> = self.flown_by(antenna.id()).collect();
        flown.sort_by_key(|flown| flown.pass.0);
        Standings {
            antenna: antenna.id(),
            flown,
            taking: antenna.operation.taking().copied(),
            now: self.now,
        }
    }

    /// Returns the list of an antenna: past passes of this day, then future passes.
    pub fn listed_passes(&self, antenna: &AntennaModel) -> Vec<ListedPass<'_>> {
        let id = antenna.id();
        let ended = self.flown_by(id).map(|flown| ListedPass {
            key: flown.pass,
            name: &flown.name,
            los: add_seconds(flown.pass.1, flown.of_s),
            max_elevation_deg: None,
            entry: None,
            standing: Standing::Flown(flown),
            planned: None,
        });
        let standings = self.standings_on(antenna);
        let ahead = self.planned_passes().into_iter().filter_map(|planned| {
            let predicted = planned.predicted;
            if standings.flown(predicted.key()).is_some() {
                return None;
            }
            Some(ListedPass {
                key: predicted.key(),
                name: predicted.satellite.short_name(),
                los: predicted.pass.los.time,
                max_elevation_deg: Some(predicted.pass.max_elevation().degrees()),
                entry: standings.entry(&planned),
                standing: standings.ahead(&planned),
                planned: Some(planned),
            })
        });
        ended.chain(ahead).collect()
    }
}

/// Status of passes on an antenna.
pub struct Standings<'a> {
    antenna: AntennaId,
    /// Passes that are over for the antenna, by satellite.
    flown: Vec<&'a Flown>,
    taking: Option<Taking>,
    now: Timestamp,
}

impl<'a> Standings<'a> {
    pub fn standing(&self, planned: &PlannedPass<'a>) -> Standing<'a> {
        // A pass that is over for the antenna may not have reached LOS yet.
        let flown = self.flown(planned.predicted.key());
        flown.map_or_else(|| self.ahead(planned), Standing::Flown)
    }

    fn flown(&self, key: PassListKey) -> Option<&'a Flown> {
        let first = self.flown.partition_point(|flown| flown.pass.0 < key.0);
        let own = self.flown.iter().skip(first).take_while(|flown| flown.pass.0 == key.0);
        own.copied().find(|flown| is_same(flown.pass, key))
    }

    fn entry(&self, planned: &PlannedPass<'a>) -> Option<&'a Entry> {
        planned.entries.iter().copied().find(|entry| entry.antenna == self.antenna)
    }

    /// Returns the status of a pass that is not over for the antenna.
    fn ahead(&self, planned: &PlannedPass<'a>) -> Standing<'a> {
        let Some(entry) = self.entry(planned) else {
            if let Some(other) = planned.entries.first() {
                return Standing::TakenBy(other.antenna);
            }
            let Some(left_out) = planned.left_out else { return Standing::NotKnown };
            let own = left_out.by_antenna.iter().find(|(antenna, _)| *antenna == self.antenna);
            return Standing::LeftOut(own.map_or(&left_out.reason, |(_, reason)| reason));
        };
        let key = planned.predicted.key();
        let Some(taking) = self.taking.filter(|taking| is_same(taking.pass, key)) else {
            return Standing::Planned(entry);
        };
        match taking.proved_at {
            Some(_) if taking.start <= self.now => Standing::Running,
            Some(time) => Standing::Proved(time),
            None => Standing::Sent(taking.asked_at),
        }
    }
}
