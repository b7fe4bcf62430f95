//! What a device that tracks by itself tells of how it does so.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// What a device that tracks by itself goes by, each part as last read. `None`
/// means not read, or not told.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct OnBoard {
    /// Where it takes itself to stand.
    pub place: Option<Place>,
    /// Its clock.
    pub clock: Option<UnitClock>,
    /// What it adds to the path that it computes.
    pub offsets: Option<Offsets>,
    /// The satellite that it holds.
    pub satellite: Option<HeldSatellite>,
    /// From when to when it tracks.
    pub window: Option<(Timestamp, Timestamp)>,
}

/// A unit's clock against ours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnitClock {
    /// How far the unit is ahead of us, in seconds; half the way over the link
    /// is taken off.
    pub ahead_s: f64,
    /// It was set by somebody.
    pub is_set: bool,
    /// When it was read, by our clock.
    pub read_at: Timestamp,
}

/// A place as a device tells it: without its height.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// North positive.
    pub latitude_deg: f64,
    /// East positive.
    pub longitude_deg: f64,
    /// Both are told in steps of this.
    pub step_deg: f64,
}

/// What a device adds to the path that it computes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Offsets {
    /// Along the track. Which sign is ahead is not known.
    pub time_s: f64,
    /// Added to the azimuth.
    pub azimuth_deg: f64,
    /// Added to the elevation.
    pub elevation_deg: f64,
    /// Between the zero of the mount and north.
    pub north_deg: f64,
    /// It does not point lower.
    pub minimum_elevation_deg: f64,
    /// So long before its window it goes to the start of the track, seconds.
    pub lead_s: f64,
}

/// The satellite that a device holds. The epoch of its elements is not told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldSatellite {
    /// Up to nine digits; 0 for none.
    pub catalog_number: u32,
    /// As in its elements.
    pub name: String,
    /// The highest elevation of the pass as the device predicts it, where it tells.
    pub maximum_elevation_deg: Option<f64>,
}
