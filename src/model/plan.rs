//! The plan as its view shows it: each pass of the favourites with what the schedule says of it.

mod pose;

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::Model;
use crate::{
    astro::time::{add_seconds, seconds_between},
    engine::{
        antenna::AntennaModel,
        automatic::{DayEvent, Flown, Taking},
        passes::{PassKey, PredictedPass},
        schedule::Swap,
    },
    plan::schedule::{Entry, LeftOut, Why},
    station::{AntennaId, PassChoice, Priority},
};

pub use pose::{PlannedActivity, Pose};

/// Largest difference in AOS of one pass between the list and the schedule, seconds.
const SAME_AOS_S: f64 = 60.0;

/// A pass of the list with what the schedule says of it.
#[derive(Debug, Clone)]
pub struct PlannedPass<'a> {
    pub predicted: &'a PredictedPass,
    pub priority: Priority,
    /// Two where one antenna hands it over to another.
    pub entries: Vec<&'a Entry>,
    /// `None` also while no schedule knows of the pass.
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

/// How a pass stands on one antenna.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Standing<'a> {
    /// It is over.
    Flown(&'a Flown),
    /// It is tracked now.
    Running,
    /// The antenna is on its way, and that was proved at this time.
    Proved(Timestamp),
    /// The unit was asked at this time, and has not proved it.
    Sent(Timestamp),
    /// The antenna will be sent to it.
    Planned(&'a Entry),
    /// Another antenna takes it.
    TakenBy(AntennaId),
    LeftOut(&'a Why),
    /// No schedule knows of it yet.
    NotKnown,
}

/// A row of the list of one antenna.
#[derive(Debug, Clone)]
pub struct ListedPass<'a> {
    pub key: PassKey,
    pub name: &'a str,
    pub los: Timestamp,
    pub max_elevation_deg: Option<f64>,
    pub entry: Option<&'a Entry>,
    pub standing: Standing<'a>,
    /// Still to come, with all that is known of it.
    pub planned: Option<PlannedPass<'a>>,
}

fn is_same(entry: (u32, Timestamp), key: PassKey) -> bool {
    entry.0 == key.0 && seconds_between(entry.1, key.1).abs() < SAME_AOS_S
}

impl Model {
    /// The end of the plan.
    pub fn plan_until(&self) -> Timestamp {
        add_seconds(self.now, self.station.scheduling.span_h * 3600.0)
    }

    /// What it costs in the schedule shown to take this pass, once that is known.
    pub fn swap_of(&self, pass: PassKey) -> Option<&Swap> {
        let fits = |swap: &&Swap| swap.pass == pass && swap.revision == self.schedule.revision;
        self.swap.as_deref().filter(fits)
    }

    /// All passes to come with what the schedule says of them, by AOS.
    pub fn planned_passes(&self) -> Vec<PlannedPass<'_>> {
        self.planned_passes_until(self.plan_until())
    }

    /// The passes to come with AOS before `end`, with what the schedule says of them, by AOS.
    pub fn planned_passes_until(&self, end: Timestamp) -> Vec<PlannedPass<'_>> {
        let schedule = &self.schedule.schedule;
        let last = add_seconds(end, SAME_AOS_S);
        let mut entries: BTreeMap<u32, Vec<&Entry>> = BTreeMap::new();
        for entry in schedule.entries.iter().filter(|entry| entry.pass.aos < last) {
            entries.entry(entry.pass.satellite).or_default().push(entry);
        }
        let mut left_out: BTreeMap<u32, Vec<&LeftOut>> = BTreeMap::new();
        for of in schedule.left_out.iter().filter(|of| of.pass.aos < last) {
            left_out.entry(of.pass.satellite).or_default().push(of);
        }
        let priorities = self.station.priorities();
        let ahead = self.pass_lists.favourites.upcoming(self.now);
        let passes = ahead.iter().filter(|it| !it.is_always_up() && it.pass.aos.time < end);
        let planned = passes.map(|predicted| {
            let priority = priorities.get(&predicted.number()).copied();
            let entries = entries.get(&predicted.number()).into_iter().flatten().copied();
            let out = left_out.get(&predicted.number()).into_iter().flatten().copied();
            self.planned(predicted, priority, entries, out)
        });
        planned.collect()
    }

    /// A pass with what the schedule says of it.
    pub fn planned_pass<'a>(&'a self, predicted: &'a PredictedPass) -> PlannedPass<'a> {
        let schedule = &self.schedule.schedule;
        let priority = self.station.priority(predicted.number());
        self.planned(predicted, priority, schedule.entries.iter(), schedule.left_out.iter())
    }

    fn planned<'a>(
        &'a self,
        predicted: &'a PredictedPass,
        priority: Option<Priority>,
        entries: impl Iterator<Item = &'a Entry>,
        mut left_out: impl Iterator<Item = &'a LeftOut>,
    ) -> PlannedPass<'a> {
        let key = predicted.key();
        let (number, pass) = (key.0, &predicted.pass);
        PlannedPass {
            predicted,
            priority: priority.unwrap_or_default(),
            entries: entries
                .filter(|entry| is_same((entry.pass.satellite, entry.pass.aos), key))
                .collect(),
            left_out: left_out.find(|of| is_same((of.pass.satellite, of.pass.aos), key)),
            choice: self.station.pass_choice(number, (pass.aos.time, pass.los.time)),
        }
    }

    /// The satellites of the plan by priority, then in the order of the favourites.
    pub fn planned_satellites(&self) -> Vec<PlannedSatellite<'_>> {
        let mut by_number: BTreeMap<u32, Vec<PlannedPass<'_>>> = BTreeMap::new();
        for planned in self.planned_passes() {
            by_number.entry(planned.predicted.number()).or_default().push(planned);
        }
        let priorities = self.station.priorities();
        let known = &self.pass_lists.favourites.satellites;
        let mut satellites: Vec<PlannedSatellite<'_>> = known
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

    /// The passes of this day that are over for an antenna.
    pub fn flown_by(&self, antenna: AntennaId) -> impl Iterator<Item = &Flown> + Clone {
        let own = self.day.iter().filter(move |line| line.antenna == antenna);
        own.filter_map(|line| match &line.what {
            DayEvent::Flown(flown) => Some(flown),
            _ => None,
        })
    }

    /// How a pass that has not set stands on an antenna.
    pub fn standing_on<'a>(
        &'a self,
        planned: &PlannedPass<'a>,
        antenna: &AntennaModel,
    ) -> Standing<'a> {
        let (id, key) = (antenna.id(), planned.predicted.key());
        // What is over for the antenna may not have set yet.
        if let Some(flown) = self.flown_by(id).find(|flown| is_same(flown.pass, key)) {
            return Standing::Flown(flown);
        }
        let entry = planned.entries.iter().copied().find(|entry| entry.antenna == id);
        standing(planned, entry, id, antenna.operation.taking().copied(), self.now)
    }

    /// What the list of an antenna shows: the passes of this day that are over, then those to
    /// come.
    pub fn listed_passes(&self, antenna: &AntennaModel) -> Vec<ListedPass<'_>> {
        let id = antenna.id();
        let over = self.flown_by(id).map(|flown| ListedPass {
            key: flown.pass,
            name: &flown.name,
            los: add_seconds(flown.pass.1, flown.of_s),
            max_elevation_deg: None,
            entry: None,
            standing: Standing::Flown(flown),
            planned: None,
        });
        let taking = antenna.operation.taking().copied();
        // What is over for the antenna may not have set yet.
        let is_over = |planned: &PlannedPass<'_>| {
            let key = planned.predicted.key();
            over.clone().any(|listed| is_same(listed.key, key))
        };
        let ahead = self.planned_passes().into_iter().filter(|planned| !is_over(planned));
        let ahead = ahead.map(|planned| {
            let predicted = planned.predicted;
            let entry = planned.entries.iter().copied().find(|entry| entry.antenna == id);
            ListedPass {
                key: predicted.key(),
                name: predicted.satellite.short_name(),
                los: predicted.pass.los.time,
                max_elevation_deg: Some(predicted.pass.max_elevation().degrees()),
                entry,
                standing: standing(&planned, entry, id, taking, self.now),
                planned: Some(planned),
            }
        });
        let ahead: Vec<ListedPass<'_>> = ahead.collect();
        over.chain(ahead).collect()
    }
}

/// How a pass to come stands on an antenna.
fn standing<'a>(
    planned: &PlannedPass<'a>,
    entry: Option<&'a Entry>,
    antenna: AntennaId,
    taking: Option<Taking>,
    now: Timestamp,
) -> Standing<'a> {
    let Some(entry) = entry else {
        if let Some(other) = planned.entries.first() {
            return Standing::TakenBy(other.antenna);
        }
        let Some(left_out) = planned.left_out else { return Standing::NotKnown };
        let own = left_out.by_antenna.iter().find(|(of, _)| *of == antenna);
        return Standing::LeftOut(own.map_or(&left_out.why, |(_, why)| why));
    };
    let key = planned.predicted.key();
    let Some(taking) = taking.filter(|taking| is_same(taking.pass, key)) else {
        return Standing::Planned(entry);
    };
    match taking.proved_at {
        Some(_) if taking.from <= now => Standing::Running,
        Some(at) => Standing::Proved(at),
        None => Standing::Sent(taking.asked_at),
    }
}
