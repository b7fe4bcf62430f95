//! Changes from one schedule to the next, and their reasons.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    outcome::{Entry, LeftOutReason, Schedule},
    request::PassKey,
};
use crate::station::AntennaId;

/// Max shift of the start or end of an unchanged entry, seconds.
const SAME_S: f64 = 1.0;

/// Change of the entry of one pass between two schedules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Key of the pass, in the new schedule if it is still there.
    pub pass: PassKey,
    pub changed: Changed,
    pub cause: ChangeCause,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Changed {
    Added {
        antenna: AntennaId,
    },
    Dropped {
        antenna: AntennaId,
    },
    Moved {
        #[serde(rename = "from")]
        source: AntennaId,
        #[serde(rename = "to")]
        destination: AntennaId,
    },
    /// Later start and earlier end by these seconds; less than 0 for the opposite direction.
    Cut {
        late_s: f64,
        early_s: f64,
    },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChangeCause {
    /// Pass that the previous schedule did not contain.
    NewPass,
    /// Pass that is no longer predicted.
    Gone,
    /// Pass that is now left out.
    LeftOut(LeftOutReason),
    /// Higher worth of the new schedule.
    Better,
}

/// Returns the changes from `before` to `after`, from `start` on, in the order of `after`, then of
/// `before`. Two passes are the same if they are of the same satellite and their spans overlap.
pub fn changes(before: &Schedule, after: &Schedule, start: Timestamp) -> Vec<Change> {
    let ahead = |entry: &&Entry| entry.end > start;
    let old: Vec<&Entry> = before.entries.iter().filter(ahead).collect();
    let new: Vec<&Entry> = after.entries.iter().filter(ahead).collect();
    let mut found = Vec::new();
    for entry in &new {
        let same: Vec<&&Entry> = old.iter().filter(|other| is_same(other, entry)).collect();
        let changed = if same.is_empty() {
            Some(Changed::Added { antenna: entry.antenna })
        } else if let Some(previous) =
            same.iter().find(|previous| previous.antenna == entry.antenna)
        {
            let (late_s, early_s) =
                (entry.late_s - previous.late_s, entry.early_s - previous.early_s);
            let is_cut = late_s.abs() > SAME_S || early_s.abs() > SAME_S;
            is_cut.then_some(Changed::Cut { late_s, early_s })
        } else {
            let (source, destination) =
                (same.first().map(|earlier| earlier.antenna), entry.antenna);
            source.map(|source| Changed::Moved { source, destination })
        };
        let was_known = before.left_out.iter().any(|left_out| is_near(left_out.pass, entry));
        let is_new = same.is_empty() && !was_known;
        let cause = if is_new { ChangeCause::NewPass } else { ChangeCause::Better };
        let change = |changed| Change { pass: entry.pass, changed, cause };
        found.extend(changed.map(change));
    }
    for entry in &old {
        if new.iter().any(|next| is_same(next, entry)) {
            continue;
        }
        let left_out = after.left_out.iter().find(|left_out| is_near(left_out.pass, entry));
        let cause = left_out
            .map_or(ChangeCause::Gone, |omission| ChangeCause::LeftOut(omission.reason.clone()));
        let pass = left_out.map_or(entry.pass, |reason| reason.pass);
        let changed = Changed::Dropped { antenna: entry.antenna };
        found.push(Change { pass, changed, cause });
    }
    found
}

fn is_same(a: &Entry, b: &Entry) -> bool {
    a.pass.satellite == b.pass.satellite
        && (a.pass == b.pass || (a.start < b.end && b.start < a.end))
}

/// Half of the shortest revolution, seconds: passes of one satellite are further apart.
const HALF_REVOLUTION_S: f64 = 2_600.0;

fn is_near(pass: PassKey, entry: &Entry) -> bool {
    let apart_s = crate::astro::time::seconds_between(pass.aos, entry.pass.aos).abs();
    pass.satellite == entry.pass.satellite && apart_s < HALF_REVOLUTION_S
}
