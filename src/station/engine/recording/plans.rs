//! Record entries of the changes in each new schedule.

use std::{collections::BTreeMap, sync::Arc};

use serde::Serialize;

use crate::{
    clock::Moment,
    contract::schedule::Planned,
    engine::Engine,
    plan::schedule::{Change, Entry, LeftOut, PassKey, Schedule},
    record::Kind,
    station::AntennaId,
};

/// Treatment of a pass by the schedule.
#[derive(PartialEq, Serialize)]
#[serde(untagged)]
enum Planning<'a> {
    Taken(&'a Entry),
    LeftOut(&'a LeftOut),
}

/// Record entry of a new schedule.
#[derive(Serialize)]
struct News<'a> {
    revision: u64,
    new: Vec<&'a Planning<'a>>,
    #[serde(rename = "gone")]
    removed: Vec<PassKey>,
    changes: &'a [Change],
}

/// Returns the passes of a schedule, by pass and by the antenna that takes it.
fn passes(planned: &Planned) -> BTreeMap<(PassKey, Option<AntennaId>), Planning<'_>> {
    let Schedule { entries, left_out, .. } = &planned.schedule;
    let taken_passes =
        entries.iter().map(|entry| ((entry.pass, Some(entry.antenna)), Planning::Taken(entry)));
    let left_out = left_out.iter().map(|left| ((left.pass, None), Planning::LeftOut(left)));
    taken_passes.chain(left_out).collect()
}

impl Engine {
    pub(super) fn note_schedule(&mut self, moment: Moment) {
        let planned = &self.schedule;
        let before = std::mem::replace(&mut self.recording.schedule, Arc::clone(planned));
        if planned.revision == before.revision {
            return;
        }
        let (was, is) = (passes(&before), passes(planned));
        let new: Vec<&Planning<'_>> = (is.iter())
            .filter(|(key, planning)| was.get(*key) != Some(planning))
            .map(|(_, planning)| planning)
            .collect();
        let removed: Vec<PassKey> =
            was.keys().filter(|key| !is.contains_key(*key)).map(|(pass, _)| *pass).collect();
        if !new.is_empty() || !removed.is_empty() {
            let Planned { revision, ref changes, .. } = **planned;
            let news = News { revision, new, removed, changes };
            self.recording.note(moment, None, Kind::Schedule, &news);
        }
    }
}
