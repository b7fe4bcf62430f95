//! Contents of a schedule.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    request::{AntennaOff, PassKey, Refusal},
    row::Class,
    way::{Impossible, Lost},
};
use crate::{astro::time::seconds_between, station::AntennaId};

/// The passes that all antennas will take, and those that none will.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Schedule {
    /// By start, then by antenna.
    pub entries: Vec<Entry>,
    /// By AOS.
    pub left_out: Vec<LeftOut>,
    /// Worth of the entries, class by class, and how far it is proved.
    pub worth: Vec<ClassWorth>,
    /// Seconds that the antennas slew.
    pub slew_s: f64,
}

/// A pass that an antenna will take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    pub pass: PassKey,
    pub antenna: AntennaId,
    pub class: Class,
    /// The axes stand at the start of the track.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "to")]
    pub end: Timestamp,
    /// Seconds by which it starts late and ends early of what the antenna could take.
    pub late_s: f64,
    pub early_s: f64,
    /// Seconds that count.
    pub counted_s: f64,
    /// Worth that it adds to its class.
    pub worth: i64,
    /// Part of the pass that the mount loses.
    pub lost: Option<Lost>,
    /// Where the axes stand at the start and at the end, degrees as the mount counts: they tell
    /// the turn of the azimuth and the side of the zenith.
    pub axes_deg: [[f64; 2]; 2],
    /// The entry before on the same antenna.
    pub after: Option<PassKey>,
    /// Time that the axes turn before the entry, by way of the park position where they go there.
    pub slew_s: f64,
    pub set_up_s: f64,
    /// Time that is left between the entry before and this one; `None` for a first entry of which
    /// nothing is known before. See [`Self::spare_at`].
    pub spare_s: Option<f64>,
    /// The antenna that takes the other part of a pass that is handed over.
    pub shared_with: Option<AntennaId>,
    pub is_fixed: bool,
}

impl Entry {
    /// Returns the spare time that is left at `now`, some time after the schedule was made. `None`
    /// from the start of the entry on, and for an entry without a spare time.
    pub fn spare_at(&self, now: Timestamp) -> Option<f64> {
        let until_s = seconds_between(now, self.start);
        let left_s = until_s - self.slew_s - self.set_up_s;
        self.spare_s.filter(|_| until_s > 0.0).map(|spare_s| spare_s.min(left_s).max(0.0))
    }
}

/// A pass that no antenna will take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    pub pass: PassKey,
    #[serde(rename = "why")]
    pub reason: LeftOutReason,
    /// Reason against it on each antenna.
    pub by_antenna: Vec<(AntennaId, LeftOutReason)>,
}

/// Why a pass is left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LeftOutReason {
    Refused(Refusal),
    Impossible(Impossible),
    Off(AntennaOff),
    /// The rules of the satellite leave out this antenna and allow only these.
    OtherAntennas(Vec<AntennaId>),
    /// The antenna takes other passes at this time.
    Overlaps(Conflict),
    /// The antenna cannot be there in time after a pass, or in time for the next one.
    SlewTooShort(Conflict),
    /// The antenna cannot be there in time from where it stands.
    TooFar,
    /// The pass has begun, and the antenna does not track it.
    UnderWay,
    /// As many passes of the satellite are taken on this day as may be.
    MaxPerDay(u32),
    /// Beside the schedule it would be possible; the better schedule was not found.
    NotFound,
}

/// Entry that took the time of a pass instead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conflict {
    #[serde(rename = "with")]
    pub pass: PassKey,
    pub class: Class,
    /// Seconds that are missing.
    pub missing_s: f64,
    /// Further entries that are in the way.
    pub others: Vec<PassKey>,
}

/// Worth of the entries of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassWorth {
    pub class: Class,
    /// Milliseconds, or passes where the rule counts them.
    pub worth: i64,
    pub proof: Proof,
}

/// How good a class is known to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// The classes before are the best, and no schedule that has them is worth more.
    Best,
    /// No schedule that is worth as much in the classes before is worth more than this.
    AtMost(i64),
}

impl Schedule {
    /// The entries of a pass, two where it is handed over.
    pub fn entries_of(&self, pass: PassKey) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.pass == pass)
    }

    /// Returns `true` if no schedule is worth more in any class.
    pub fn is_proved(&self) -> bool {
        self.worth.iter().all(|class| class.proof == Proof::Best)
    }
}
