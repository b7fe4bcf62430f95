//! Peaks of the noise of the Sun and the Moon that the operator entered. They serve as points for
//! the pointing model of an antenna.

use std::ops::RangeInclusive;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{AzEl, Site},
    plan::pointing::Point,
    station::AntennaId,
};

/// Position of the axes at the peak of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    #[serde(rename = "of")]
    pub body: PeakBody,
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PeakBody {
    Sun,
    Moon,
}

/// Change of a peak in an entry of the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PeakChange {
    Added(Peak),
    Removed(Peak),
}

/// Peaks of all antennas, in order of entry.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Peaks(Vec<(AntennaId, Peak)>);

impl Peak {
    /// Valid azimuths of an axis reading, degrees.
    pub const AZIMUTHS_DEG: RangeInclusive<f64> = -360.0..=720.0;
    pub const ELEVATIONS_DEG: RangeInclusive<f64> = -10.0..=90.0;

    /// Returns the point for the pointing model of an antenna at `site`.
    pub fn point(&self, site: Site) -> Point {
        let axes = AzEl::from_degrees(self.azimuth_deg, self.elevation_deg);
        match self.body {
            PeakBody::Sun => Point::of_sun(site, self.time, axes, 1.0),
            PeakBody::Moon => Point::of_moon(site, self.time, axes, 1.0),
        }
    }
}

impl Peaks {
    pub fn change(&mut self, antenna: AntennaId, change: PeakChange) {
        let (PeakChange::Added(peak) | PeakChange::Removed(peak)) = change;
        self.0.retain(|entry| *entry != (antenna, peak));
        if matches!(change, PeakChange::Added(_)) {
            self.0.push((antenna, peak));
        }
    }

    /// Adds the peaks of another list, without duplicates.
    pub fn extend(&mut self, others: &Self) {
        for (antenna, peak) in &others.0 {
            self.change(*antenna, PeakChange::Added(*peak));
        }
    }

    /// Returns the peaks of an antenna, in order of entry.
    pub fn for_antenna(&self, antenna: AntennaId) -> impl Iterator<Item = &Peak> {
        self.0.iter().filter(move |(owner, _)| *owner == antenna).map(|(_, peak)| peak)
    }
}
