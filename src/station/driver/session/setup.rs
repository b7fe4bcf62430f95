//! Settings of an antenna, and values derived from them and from the make of its unit.

use std::time::Duration;

use super::{standstill::Figures, tracking::TrackConfig};
use crate::{
    astro::Angle,
    device::{Capabilities, Motion, Pointing, TrackOffsetFields, Variant},
    name::Name,
    plan::on_board::Ability,
    station::{Antenna, Monitor, Resume},
};

/// Assumed sway of a standing axis before it is measured, degrees.
const MAX_SWAY_DEG: f64 = 1.0;

/// Settings of the antenna.
pub(super) struct Setup {
    name: String,
    variant: &'static Variant,
    park: Pointing,
    track_config: TrackConfig,
    /// Limits for judging a pass that the unit tracks on its own.
    ability: Ability,
    /// Condition under which program track resumes automatically after an outage.
    resume: Resume,
    /// Max outage after which program track always resumes.
    resume_after: Duration,
    /// Configured sway of the antenna, degrees.
    sway_deg: f64,
    /// Response to somebody else driving the antenna into a keep-out or near the Sun.
    monitor: Monitor,
}

impl Setup {
    pub(super) fn new(antenna: &Antenna) -> Self {
        let variant = antenna.connection.variant();
        Self {
            name: antenna.name.clone(),
            variant,
            park: antenna.park_direction().into(),
            track_config: TrackConfig::new(antenna, variant.capabilities),
            ability: Ability::from_antenna(antenna),
            resume: antenna.resume,
            resume_after: Duration::try_from_secs_f64(antenna.resume_after_s).unwrap_or_default(),
            sway_deg: antenna.sway_deg,
            monitor: antenna.monitor,
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn can(&self) -> Capabilities {
        self.variant.capabilities
    }

    pub(super) fn track_offsets(&self) -> Option<&'static TrackOffsetFields> {
        self.variant.track_offsets
    }

    /// Returns the name of an axis; empty if the unit has no such axis.
    pub(super) fn axis_name(&self, axis: usize) -> Name {
        self.can().axes.get(axis).copied().unwrap_or_default()
    }

    pub(super) fn park(&self) -> Pointing {
        self.park
    }

    pub(super) fn park_motion(&self) -> Motion {
        let has_elevation = self.can().has_elevation();
        Motion::Position {
            azimuth: self.park.azimuth,
            elevation: self.park.elevation.filter(|_| has_elevation),
        }
    }

    pub(super) fn track_config(&self) -> TrackConfig {
        self.track_config
    }

    /// Keeps rates that a track has measured for the next target, degrees a second.
    pub(super) fn learn_rates(&mut self, rates_deg_s: [f64; 2]) {
        self.track_config.drives.rates_deg_s = rates_deg_s;
    }

    pub(super) fn ability(&self) -> Ability {
        self.ability
    }

    pub(super) fn stops_others(&self) -> bool {
        self.monitor == Monitor::Stop
    }

    /// Returns `true` if an outage of this length is too short for a new comparison of the unit.
    pub(super) fn resumes_at_once(&self, lost: Duration) -> bool {
        lost <= self.resume_after
    }

    /// Returns `true` if Azel must ask the operator after a longer outage.
    pub(super) fn asks_to_resume(&self) -> bool {
        self.resume == Resume::Ask
    }

    /// Returns the figures for standstill with the larger of the configured and the measured sway.
    pub(super) fn figures(&self, measured_sway_deg: Option<f64>) -> Figures {
        self.figures_with(measured_sway_deg.unwrap_or_default())
    }

    /// Returns the figures for alarms: assumes [`MAX_SWAY_DEG`] until the sway is measured, to
    /// avoid false alarms.
    pub(super) fn alarm_figures(&self, measured_sway_deg: Option<f64>) -> Figures {
        self.figures_with(measured_sway_deg.unwrap_or(MAX_SWAY_DEG))
    }

    fn figures_with(&self, measured_sway_deg: f64) -> Figures {
        Figures::new(self.can(), self.sway_deg.max(measured_sway_deg))
    }

    /// Returns the max angle off target while the beam contains the target: half the beam, plus the
    /// max rounding error of both angles and the noise.
    pub(super) fn in_beam(&self, figures: Figures) -> Angle {
        let error_deg = self.can().standstill.resolution_deg + figures.tolerance_deg();
        self.ability.half_beam + Angle::from_degrees(error_deg)
    }

    /// Returns the max angle off target of a working antenna: [`Self::in_beam`], the arrival
    /// tolerance, and a second rounding error for a unit that truncates its angles.
    pub(super) fn on_target(&self, figures: Figures) -> Angle {
        let can = self.can();
        let more_deg = can.standstill.resolution_deg + can.arrives_within_deg;
        self.in_beam(figures) + Angle::from_degrees(more_deg)
    }
}
