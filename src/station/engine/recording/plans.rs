//! Records the changes of each new schedule.

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

/// How the schedule treats a pass.
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
    gone: Vec<PassKey>,
    changes: &'a [Change],
}

/// The passes of a schedule, by pass and by the antenna that takes it.
fn passes(planned: &Planned) -> BTreeMap<(PassKey, Option<AntennaId>), Planning<'_>> {
    let Schedule { entries, left_out, .. } = &planned.schedule;
    let taken = entries.iter().map(|it| ((it.pass, Some(it.antenna)), Planning::Taken(it)));
    let left_out = left_out.iter().map(|it| ((it.pass, None), Planning::LeftOut(it)));
    taken.chain(left_out).collect()
}

impl Engine {
    pub(super) fn note_schedule(&mut self, at: Moment) {
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
        let gone: Vec<PassKey> =
            was.keys().filter(|key| !is.contains_key(*key)).map(|(pass, _)| *pass).collect();
        if !new.is_empty() || !gone.is_empty() {
            let Planned { revision, ref changes, .. } = **planned;
            let news = News { revision, new, gone, changes };
            self.recording.note(at, None, Kind::Schedule, &news);
        }
    }
}
