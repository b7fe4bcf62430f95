//! Recorded report of a pass that an antenna tracked.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{Angle, AzEl, PointingModel, Site},
    device::{Place, Pointing},
    driver::TimeSync,
    orbit::{Elements, Propagator},
    plan::pass_report::{Explanation, FlownOffsets, MeasuredPosition, PassReport, PathSource},
};

/// Recorded report of a pass; `docs/record.md` describes its fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordedReport {
    /// AOS above the antenna's minimum elevation.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// Part of the pass that the plan gave to the antenna; only this part counts. `None` without a
    /// plan: the whole pass counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<PlannedPart>,
    pub max_elevation_deg: f64,
    /// Age of the elements in the middle of the pass, days.
    pub age_days: f64,
    pub elements: Elements,
    /// Location of the antenna; `None` in older reports.
    #[serde(default)]
    pub site: Option<Site>,
    pub half_beam_deg: f64,
    #[serde(flatten)]
    pub track: AboutTrack,
    #[serde(flatten)]
    pub report: PassReport,
    /// Cause of the error, or up to three causes that the positions cannot separate, best first.
    /// The list is empty for a good pass, and in older reports, which tested no causes.
    #[serde(default)]
    pub causes: Vec<Explanation>,
}

/// The part of a pass that a plan gives to an antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedPart {
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
}

/// Description of a track besides its positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AboutTrack {
    /// Time at which Azel first saw the track.
    pub begun: Timestamp,
    pub tracked_by: TrackedBy,
    /// Number of positions that Azel sent with program track.
    pub sent: Option<u32>,
    /// Offsets of program track.
    #[serde(default)]
    pub offsets: FlownOffsets,
    /// Pointing model of program track.
    #[serde(default, skip_serializing_if = "PointingModel::is_none")]
    pub pointing_model: PointingModel,
    /// Lead of the unit's clock over this computer's clock, seconds.
    pub unit_clock_ahead_s: Option<f64>,
    /// Location for which the unit computes its track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit_place: Option<Place>,
    /// State of the time service that keeps the clock of this computer.
    pub sync: TimeSync,
}

impl AboutTrack {
    /// Returns the origin of the path of a track from a station at `site`.
    pub fn path_source(&self, site: Site) -> PathSource {
        match self.tracked_by {
            TrackedBy::ProgramTrack => PathSource::Azel,
            TrackedBy::OnBoard | TrackedBy::Elsewhere => PathSource::Unit {
                clock_ahead_s: self.unit_clock_ahead_s,
                place: self.unit_place.and_then(|place| place.as_site(site)),
            },
        }
    }

    /// Returns the position for the comparison with the satellite, without pointing model and
    /// offsets.
    #[must_use]
    pub fn compared(
        &self,
        propagator: &Propagator,
        site: Site,
        flown: MeasuredPosition,
    ) -> MeasuredPosition {
        self.offsets.taken_off(propagator, site, self.on_the_sky(flown))
    }

    /// Returns the site with the refraction that the track used: units ignore refraction.
    pub fn led_from(&self, site: Site) -> Site {
        match self.tracked_by {
            TrackedBy::ProgramTrack => site,
            TrackedBy::OnBoard | TrackedBy::Elsewhere => site.airless(),
        }
    }

    /// Returns the direction of the beam on the sky for a position of the axes.
    #[must_use]
    pub fn on_the_sky(&self, flown: MeasuredPosition) -> MeasuredPosition {
        let model = &self.pointing_model;
        let pointing = match flown.pointing {
            pointing if model.is_none() => pointing,
            Pointing { azimuth: Some(azimuth), elevation: Some(elevation) } => {
                model.direction(AzEl { azimuth, elevation }).into()
            }
            // Only an offset is applied to an azimuth axis alone.
            Pointing { azimuth, elevation } => {
                let offset = Angle::from_degrees(model.azimuth_offset_deg);
                let azimuth = azimuth.map(|azimuth| (azimuth - offset).wrapped_360());
                Pointing { azimuth, elevation }
            }
        };
        MeasuredPosition { pointing, ..flown }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrackedBy {
    ProgramTrack,
    OnBoard,
    /// Track that the unit or somebody at its panel began.
    Elsewhere,
}
