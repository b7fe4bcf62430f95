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

/// Within this time after it came, an alarm is recorded, seconds.
const RECORDED_S: f64 = 5.0;

/// State of an alarm in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmState {
    /// Its reason stands, and it was not acknowledged.
    New,
    /// Its reason is over, and it was not acknowledged.
    NewAndOver { over_since: Timestamp },
    /// Its reason stands; it was acknowledged.
    Seen,
    /// Its reason is over, and it was acknowledged.
    Over { over_since: Timestamp },
    /// It is quiet until then, whether its reason stands or comes again.
    Shelved { end: Timestamp },
}

/// How long an alarm is shelved.
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

/// One row of the alarm list: one matter of one antenna, however often it came today.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Unique in this station. A matter that comes again has a new one, so that nobody
    /// acknowledges what he has not seen.
    pub id: u64,
    /// The id with which the matter came first: that of its row, however often it comes again.
    pub row: u64,
    /// `None` where it concerns no single antenna.
    pub antenna: Option<AntennaId>,
    pub kind: AlarmKind,
    /// When it came first.
    pub raised: Timestamp,
    /// When it came last; the same as `raised` where it came once.
    pub last: Timestamp,
    /// How often it came.
    pub count: u32,
    /// The operator has acknowledged the alarm.
    #[serde(rename = "seen")]
    pub acknowledged: bool,
    /// When its reason was over; `None` while it stands.
    pub over_since: Option<Timestamp>,
    /// Quiet until then.
    pub shelved_until: Option<Timestamp>,
}

impl Alarm {
    /// An alarm that has come for the first time.
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

    /// Returns `true` once the reason of the alarm is over.
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
    /// The change that was recorded at `time`, after the one before of the same id. `None` for one that
    /// nobody looks for, as the end of a shelf.
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

/// The alarms of the station: those that stand, those that nobody has seen, and those of this
/// day (UTC) that are over. The newest is the last. Clones share the list.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Alarms {
    pub list: Arc<Vec<Alarm>>,
    /// Id of the next alarm.
    pub next_id: u64,
    /// An alarm has come since the list was last opened.
    pub unopened: bool,
}

impl Alarms {
    /// The newest last.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// Id of the newest unseen alarm.
    pub fn newest_unseen(&self) -> Option<u64> {
        self.list.iter().rev().find(|alarm| !alarm.acknowledged).map(|alarm| alarm.id)
    }
}
