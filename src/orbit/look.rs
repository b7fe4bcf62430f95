//! Look angles: direction, range and range rate of a satellite from a site.
//!
//! The direction is the apparent direction of the site, in the frame of [`frames`]. Only
//! [`SiteFrame::direction`] applies refraction. AOS and LOS are geometric by default: at the
//! horizon, refraction lifts a satellite by 0.6 degrees, a low satellite some 10 s before its AOS.
//! The table lists the neglected effects, as an angle and as the median shift of AOS of low
//! satellites:
//!
//! | left out | direction | AOS |
//! |---|---|---|
//! | UT1 - UTC, at most 0.9 s | 0.004 degrees of Earth rotation | 0.06 s |
//! | light time | 0.002 degrees | 0.01 s |
//! | polar motion | 0.000 2 degrees | 0.003 s |
//!
//! With the UT1 - UTC of 2026, some hundredths of a second, AOS is accurate to 2 ms.

use glam::DVec3;
use jiff::Timestamp;

use super::{PropagationError, Propagator, State};
use crate::astro::{
    AzEl, Site,
    frames::{self, SiteFrame},
};

/// Speed of light, km/s.
const LIGHT_KM_S: f64 = 299_792.458;

/// Direction, distance and speed of a satellite as seen from a site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookAngles {
    /// Apparent direction, with the refraction of the site.
    pub direction: AzEl,
    pub range_km: f64,
    /// Change of the range, km/s; negative when approaching.
    pub range_rate_km_s: f64,
}

/// Distance of a satellite from a site, and its change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    pub range_km: f64,
    /// Change of the range, km/s; negative when approaching.
    pub range_rate_km_s: f64,
}

impl LookAngles {
    pub fn distance(self) -> Distance {
        Distance { range_km: self.range_km, range_rate_km_s: self.range_rate_km_s }
    }

    /// Returns the Doppler shift; see [`Distance::doppler_hz`].
    pub fn doppler_hz(self, carrier_hz: f64) -> f64 {
        self.distance().doppler_hz(carrier_hz)
    }
}

impl Distance {
    fn new(line_km: DVec3, velocity_km_s: DVec3) -> Self {
        let range_km = line_km.length();
        Self { range_km, range_rate_km_s: line_km.dot(velocity_km_s) / range_km }
    }

    /// Returns the Doppler shift, Hz, of a carrier of `carrier_hz` that the satellite sends:
    /// positive when approaching. The result is first order in v/c.
    pub fn doppler_hz(self, carrier_hz: f64) -> f64 {
        -self.range_rate_km_s / LIGHT_KM_S * carrier_hz
    }
}

/// Position and motion of a satellite in Earth-fixed axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverGround {
    pub position_km: DVec3,
    /// Velocity over the ground, km/s.
    pub velocity_km_s: DVec3,
}

/// Position and motion of a satellite relative to a site: east, north, up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Geometric position, km; [`SiteFrame::direction`] converts it to a direction.
    pub position_km: DVec3,
    /// Velocity over the ground, km/s.
    pub velocity_km_s: DVec3,
}

impl State {
    /// Returns the look angles from `site` at `time`, the time of this state.
    pub fn look_from(&self, site: Site, time: Timestamp) -> LookAngles {
        let site = SiteFrame::from(site);
        let place = self.over_ground(time);
        let direction = site.direction(site.enu_km(place.position_km));
        let Distance { range_km, range_rate_km_s } = place.distance_from(site.ecef_km);
        LookAngles { direction, range_km, range_rate_km_s }
    }

    /// Returns position and motion as seen from a site at `time`, the time of this state.
    pub fn local(&self, site: &SiteFrame, time: Timestamp) -> Local {
        let OverGround { position_km, velocity_km_s } = self.over_ground(time);
        Local { position_km: site.enu_km(position_km), velocity_km_s: site.to_enu * velocity_km_s }
    }

    /// Returns position and motion in Earth-fixed axes at `time`, the time of this state.
    pub fn over_ground(&self, time: Timestamp) -> OverGround {
        let to_ecef = frames::teme_to_ecef(time);
        OverGround::of_inertial(to_ecef * self.position_km, to_ecef * self.velocity_km_s)
    }
}

impl OverGround {
    /// Creates the value from the inertial velocity, turned into the Earth-fixed axes.
    pub(super) fn of_inertial(position_km: DVec3, velocity_km_s: DVec3) -> Self {
        let velocity_km_s = frames::velocity_over_ground_km_s(position_km, velocity_km_s);
        Self { position_km, velocity_km_s }
    }

    /// Returns distance from a site, given in Earth-fixed axes.
    pub fn distance_from(&self, site_ecef_km: DVec3) -> Distance {
        Distance::new(self.position_km - site_ecef_km, self.velocity_km_s)
    }
}

impl Propagator {
    /// Returns look angles of the satellite from `site` at `time`, with UT1 taken as UTC.
    pub fn look_from(&self, site: Site, time: Timestamp) -> Result<LookAngles, PropagationError> {
        Ok(self.state_at(time)?.look_from(site, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{astro::time, bundled};

    #[test]
    fn the_range_rate_is_the_change_of_the_range_and_shifts_the_carrier() {
        let catalog = bundled().unwrap();
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let propagator = Propagator::new(catalog.get(25_544).unwrap()).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        for minute in 0..90 {
            let time = time::add_seconds(start, 60.0 * f64::from(minute));
            let look = |offset_s| propagator.look_from(site, time::add_seconds(time, offset_s));
            let change_km = look(0.5).unwrap().range_km - look(-0.5).unwrap().range_km;
            let now = look(0.0).unwrap();
            assert!((change_km - now.range_rate_km_s).abs() < 5e-4, "{change_km} {now:?}");
            // A speed of 7 km/s shifts 145.8 MHz by 3.4 kHz; an approach raises the frequency.
            let expected_hz = -change_km / 299_792.458 * 145.8e6;
            assert!((now.doppler_hz(145.8e6) - expected_hz).abs() < 0.5);
        }
    }
}
