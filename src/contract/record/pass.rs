//! The report of a pass that an antenna tracked, as it is kept.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{Angle, AzEl, PointingModel, Site},
    device::{Place, Pointing},
    driver::TimeSync,
    orbit::{Elements, Propagator},
    plan::pass_report::{Explanation, FlownOffsets, MeasuredPosition, PassReport, PathSource},
};

/// Report of a pass as it is kept; `docs/record.md` tells its fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordedReport {
    /// From AOS to LOS, above the antenna's minimum elevation.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// The part of it that the plan gave to the antenna: that counts. `None` without a plan, where all
    /// of it counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<PlannedPart>,
    pub max_elevation_deg: f64,
    /// Age of the elements in the middle of the pass, days.
    pub age_days: f64,
    pub elements: Elements,
    /// Where the antenna stands; `None` in older reports.
    #[serde(default)]
    pub site: Option<Site>,
    pub half_beam_deg: f64,
    #[serde(flatten)]
    pub track: AboutTrack,
    #[serde(flatten)]
    pub report: PassReport,
    /// The cause of the error, or up to three that the positions do not tell apart, the best first;
    /// none for a good pass. Older reports name none: their causes were not tested.
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
    /// When it was first seen to be tracked.
    pub begun: Timestamp,
    pub tracked_by: TrackedBy,
    /// Positions that were sent, with program track.
    pub sent: Option<u32>,
    /// Offsets of program track.
    #[serde(default)]
    pub offsets: FlownOffsets,
    /// Pointing model of program track.
    #[serde(default, skip_serializing_if = "PointingModel::is_none")]
    pub pointing_model: PointingModel,
    /// The unit's clock against that of this computer, seconds.
    pub unit_clock_ahead_s: Option<f64>,
    /// The place for which a unit computes its track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit_place: Option<Place>,
    /// State of the time service that keeps the clock of this computer.
    pub sync: TimeSync,
}

impl AboutTrack {
    /// The origin of the path of a track from a station at `site`.
    pub fn path_source(&self, site: Site) -> PathSource {
        match self.tracked_by {
            TrackedBy::ProgramTrack => PathSource::Azel,
            TrackedBy::OnBoard | TrackedBy::Elsewhere => PathSource::Unit {
                clock_ahead_s: self.unit_clock_ahead_s,
                place: self.unit_place.and_then(|place| place.as_site(site)),
            },
        }
    }

    /// The position as it is compared with the satellite: pointing model and offsets taken off.
    #[must_use]
    pub fn compared(
        &self,
        propagator: &Propagator,
        site: Site,
        flown: MeasuredPosition,
    ) -> MeasuredPosition {
        self.offsets.taken_off(propagator, site, self.on_the_sky(flown))
    }

    /// The site with the refraction by which the antenna was led: units leave it out.
    pub fn led_from(&self, site: Site) -> Site {
        match self.tracked_by {
            TrackedBy::ProgramTrack => site,
            TrackedBy::OnBoard | TrackedBy::Elsewhere => site.airless(),
        }
    }

    /// Where the antenna pointed on the sky at a position of its axes.
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
    /// The unit began it, or somebody at its panel.
    Elsewhere,
}
