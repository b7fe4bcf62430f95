//! Alarms: events and states that the operator must not miss.

mod kind;
mod order;

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use self::{
    kind::{AlarmKind, Priority, Work},
    order::Placed,
};
use crate::{astro::time::seconds_between, station::AntennaId};

/// Max delay between the first occurrence of an alarm and its record, seconds.
const RECORDED_S: f64 = 5.0;

/// Lifecycle state of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmState {
    /// Alarm with a persisting cause, not acknowledged.
    New,
    /// Alarm whose cause is over, not acknowledged.
    NewAndOver { over_since: Timestamp },
    /// Alarm with a persisting cause, acknowledged.
    Seen,
    /// Alarm whose cause is over, acknowledged.
    Over { over_since: Timestamp },
    /// Alarm that stays quiet until `end`, even if its cause persists or recurs.
    Shelved { end: Timestamp },
}

/// Time for which an alarm is shelved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ShelveTime {
    TenMinutes,
    OneHour,
    EightHours,
}

impl ShelveTime {
    pub const ALL: [Self; 3] = [Self::TenMinutes, Self::OneHour, Self::EightHours];

    pub fn duration(self) -> Duration {
        let minutes = match self {
            Self::TenMinutes => 10,
            Self::OneHour => 60,
            Self::EightHours => 480,
        };
        Duration::from_secs(60 * minutes)
    }
}

/// One row of the alarm list: one problem of one antenna, however often it recurs today.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Id of the alarm, unique in this station. A recurrence gets a new id, so that the operator
    /// acknowledges only alarms that the list has shown.
    pub id: u64,
    /// Id of the first occurrence. The row keeps this id at each recurrence.
    pub row: u64,
    /// Antenna with the problem; `None` if the alarm concerns no single antenna.
    pub antenna: Option<AntennaId>,
    pub kind: AlarmKind,
    /// Time of the first occurrence.
    pub raised: Timestamp,
    /// Time of the last occurrence; equal to `raised` after a single occurrence.
    pub last: Timestamp,
    /// Number of occurrences.
    pub count: u32,
    /// The operator has acknowledged the alarm.
    #[serde(rename = "seen")]
    pub acknowledged: bool,
    /// Time at which the cause ended; `None` while the cause persists.
    pub over_since: Option<Timestamp>,
    /// End of the shelf; `None` if the alarm is not shelved.
    pub shelved_until: Option<Timestamp>,
}

impl Alarm {
    /// Creates an alarm that occurs for the first time.
    pub fn new(id: u64, antenna: Option<AntennaId>, kind: AlarmKind, now: Timestamp) -> Self {
        Self {
            id,
            row: id,
            antenna,
            kind,
            raised: now,
            last: now,
            count: 1,
            acknowledged: false,
            over_since: None,
            shelved_until: None,
        }
    }

    pub fn priority(&self) -> Priority {
        self.kind.priority()
    }

    /// Returns `true` once the cause of the alarm is over.
    pub fn is_over(&self) -> bool {
        self.over_since.is_some()
    }

    pub fn state(&self) -> AlarmState {
        match (self.shelved_until, self.over_since, self.acknowledged) {
            (Some(end), ..) => AlarmState::Shelved { end },
            (None, None, false) => AlarmState::New,
            (None, Some(over_since), false) => AlarmState::NewAndOver { over_since },
            (None, None, true) => AlarmState::Seen,
            (None, Some(over_since), true) => AlarmState::Over { over_since },
        }
    }

    /// Returns `true` once the alarm is over and acknowledged.
    pub fn is_done(&self) -> bool {
        matches!(self.state(), AlarmState::Over { .. })
    }
}

/// A recorded change of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmChange {
    Came,
    Acknowledged,
    Shelved,
    Over,
}

impl AlarmChange {
    /// Returns the change that the record made at `time` shows, compared with the previous record
    /// of the same id. Returns `None` for changes that no list shows, such as the end of a shelf.
    pub fn new(alarm: &Alarm, before: Option<&Alarm>, time: Timestamp) -> Option<Self> {
        let is_new = before.is_none() && seconds_between(alarm.last, time) < RECORDED_S;
        let is_set = |part: fn(&Alarm) -> bool| part(alarm) && !before.is_some_and(part);
        if is_new {
            Some(Self::Came)
        } else if is_set(|alarm| alarm.shelved_until.is_some()) {
            Some(Self::Shelved)
        } else if is_set(|alarm| alarm.acknowledged) {
            Some(Self::Acknowledged)
        } else if is_set(Alarm::is_over) {
            Some(Self::Over)
        } else {
            None
        }
    }
}

/// Alarms of the station: persisting alarms, unacknowledged alarms, and alarms of this UTC day that
/// are over. The newest is the last. Clones share the list.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Alarms {
    pub list: Arc<Vec<Alarm>>,
    pub next_id: u64,
    /// An alarm has come since the list was last opened.
    pub unopened: bool,
}

impl Alarms {
    /// Returns the alarms, newest last.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// Returns the id of the newest unacknowledged alarm.
    pub fn newest_unseen(&self) -> Option<u64> {
        self.list.iter().rev().find(|alarm| !alarm.acknowledged).map(|alarm| alarm.id)
    }
}
