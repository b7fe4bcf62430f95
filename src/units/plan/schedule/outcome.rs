//! Contents of a schedule.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    request::{AntennaOff, PassKey, Refusal},
    row::Class,
    way::{Impossible, Lost},
};
use crate::{astro::time::seconds_between, station::AntennaId};

/// Passes that all antennas will take, and passes that none will take.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Schedule {
    /// Entries by start, then by antenna.
    pub entries: Vec<Entry>,
    /// Passes left out, by AOS.
    pub left_out: Vec<LeftOut>,
    /// Worth of the entries, class by class, and its proof.
    pub worth: Vec<ClassWorth>,
    /// Total slew time of the antennas, seconds.
    pub slew_s: f64,
}

/// Pass that an antenna will take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    pub pass: PassKey,
    pub antenna: AntennaId,
    pub class: Class,
    /// Start of the track, with the axes in place.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "to")]
    pub end: Timestamp,
    /// Seconds by which the entry starts late and ends early, compared with the possible take.
    pub late_s: f64,
    pub early_s: f64,
    /// Counted time of the entry, seconds.
    pub counted_s: f64,
    /// Worth that the entry adds to its class.
    pub worth: i64,
    /// Part of the pass that the mount loses.
    pub lost: Option<Lost>,
    /// Axis positions at the start and at the end, degrees as the mount counts: they include the
    /// turn of the azimuth and the side of the zenith.
    pub axes_deg: [[f64; 2]; 2],
    /// Previous entry on the same antenna.
    pub after: Option<PassKey>,
    /// Time that the axes turn before the entry, through the park position if they go there,
    /// seconds.
    pub slew_s: f64,
    pub set_up_s: f64,
    /// Spare time between the previous entry and this one, seconds; `None` for a first entry
    /// without known earlier positions. See [`Self::spare_at`].
    pub spare_s: Option<f64>,
    /// Antenna that takes the other part of a pass that is handed over.
    pub shared_with: Option<AntennaId>,
    pub is_fixed: bool,
}

impl Entry {
    /// Returns the remaining spare time at `now`, after the schedule was made, seconds. Returns
    /// `None` from the start of the entry on, and for an entry without a spare time.
    pub fn spare_at(&self, now: Timestamp) -> Option<f64> {
        let until_s = seconds_between(now, self.start);
        let left_s = until_s - self.slew_s - self.set_up_s;
        self.spare_s.filter(|_| until_s > 0.0).map(|spare_s| spare_s.min(left_s).max(0.0))
    }
}

/// Pass that no antenna will take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    pub pass: PassKey,
    #[serde(rename = "why")]
    pub reason: LeftOutReason,
    /// Reason against the pass on each antenna.
    pub by_antenna: Vec<(AntennaId, LeftOutReason)>,
}

/// Reason why a pass is left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LeftOutReason {
    Refused(Refusal),
    Impossible(Impossible),
    Off(AntennaOff),
    /// Exclusion of this antenna by the rules of the satellite, which allow only these antennas.
    OtherAntennas(Vec<AntennaId>),
    /// Overlap with other passes of the antenna.
    Overlaps(Conflict),
    /// Missing slew time after another pass, or before the next one.
    SlewTooShort(Conflict),
    /// Missing slew time from the current position of the antenna.
    TooFar,
    /// Current pass that the antenna does not track.
    UnderWay,
    /// Reached max number of passes of the satellite on this day.
    MaxPerDay(u32),
    /// Possible addition to the schedule that the search did not find.
    NotFound,
}

/// Entry that took the time of a pass instead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conflict {
    #[serde(rename = "with")]
    pub pass: PassKey,
    pub class: Class,
    /// Missing time between the entry and the pass, seconds.
    pub missing_s: f64,
    /// Further entries in the way.
    pub others: Vec<PassKey>,
}

/// Worth of the entries of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassWorth {
    pub class: Class,
    /// Milliseconds, or passes if the rule counts them.
    pub worth: i64,
    pub proof: Proof,
}

/// Proof of the quality of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// Proved best: the previous classes are the best, and no schedule with them is worth more.
    Best,
    /// Upper bound for schedules that are worth the same in the previous classes.
    AtMost(i64),
}

impl Schedule {
    /// Returns the entries of a pass, two if it is handed over.
    pub fn entries_of(&self, pass: PassKey) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.pass == pass)
    }

    /// Returns `true` if no schedule is worth more in any class.
    pub fn is_proved(&self) -> bool {
        self.worth.iter().all(|class| class.proof == Proof::Best)
    }
}
