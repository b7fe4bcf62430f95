//! Satellites in the unit's memory.

use crate::protocol::rc2000c::{PolarizationCode, SatelliteName};

/// Max distance in azimuth and elevation for a name in capitals, counts.
const ON_COUNTS: [u16; 2] = [15, 10];
/// Max distance in azimuth and elevation for a name in small letters, counts.
const NEAR_COUNTS: [u16; 2] = [45, 20];
/// Max distances for the stored polarization and for one close to it, feed units.
const ON_UNITS: u16 = 5;
const NEAR_UNITS: u16 = 20;
const MAX_AGC: f64 = 900.0;
const NOISE_AGC: f64 = 60.0;
/// Half width of the simulated beam, counts.
const BEAM_COUNTS: f64 = 25.0;

/// Entry of the list of satellites.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StoredSatellite {
    pub name: SatelliteName,
    /// Azimuth in counts.
    pub az_counts: u16,
    /// Elevation in counts.
    pub el_counts: u16,
    /// Position of the horizontal polarization, in the feed's units.
    pub horizontal: u16,
    /// Position of the vertical polarization, in the feed's units.
    pub vertical: u16,
    /// `true` for an inclined orbit: an auto move to the satellite starts track mode.
    pub is_inclined: bool,
    /// `true` if the satellite transmits in C and K band.
    pub is_dual_band: bool,
}

/// Closeness of the antenna to a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Closeness {
    On,
    Near,
}

impl StoredSatellite {
    /// Returns six satellites of an example station; the fourth is inclined and has both bands.
    pub fn demo() -> Vec<Self> {
        [
            ("SBS 6", 1525, 750, 263, 593, false),
            ("GALAXY 5", 1100, 640, 120, 450, false),
            ("SATCOM C3", 820, 520, 118, 448, false),
            ("GSTAR 3", 1830, 860, 250, 580, true),
            ("TELSTAR 4", 2210, 905, 261, 591, false),
            ("ANIK E2", 2640, 610, 240, 570, false),
        ]
        .into_iter()
        .filter_map(|(name, az_counts, el_counts, horizontal, vertical, is_inclined)| {
            Some(Self {
                name: SatelliteName::new(name).ok()?,
                az_counts,
                el_counts,
                horizontal,
                vertical,
                is_inclined,
                is_dual_band: is_inclined,
            })
        })
        .collect()
    }

    /// Returns the closeness of the antenna to this satellite; `None` if it is not close.
    pub(super) fn closeness(&self, counts: [u16; 2]) -> Option<Closeness> {
        let is_within = |window: [u16; 2]| {
            let own = [self.az_counts, self.el_counts];
            own.into_iter()
                .zip(counts)
                .zip(window)
                .all(|((own, target), max)| own.abs_diff(target) <= max)
        };
        if is_within(ON_COUNTS) {
            Some(Closeness::On)
        } else {
            is_within(NEAR_COUNTS).then_some(Closeness::Near)
        }
    }

    /// Returns the stored polarization at this position of the feed.
    pub(super) fn polarization(&self, units: u16) -> PolarizationCode {
        match (self.horizontal.abs_diff(units), self.vertical.abs_diff(units)) {
            (..=ON_UNITS, _) => PolarizationCode::Horizontal,
            (_, ..=ON_UNITS) => PolarizationCode::Vertical,
            (..=NEAR_UNITS, _) => PolarizationCode::NearHorizontal,
            (_, ..=NEAR_UNITS) => PolarizationCode::NearVertical,
            _ => PolarizationCode::None,
        }
    }

    /// Returns the receiver level at a position of the antenna, 0 to 1023.
    pub(super) fn agc(&self, counts: [u16; 2]) -> u16 {
        let [az, el] = counts;
        let distance = f64::from(self.az_counts.abs_diff(az))
            .hypot(f64::from(self.el_counts.abs_diff(el)))
            / BEAM_COUNTS;
        (NOISE_AGC + (MAX_AGC - NOISE_AGC) * (-distance * distance).exp()).round() as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_windows_of_the_name_are_those_of_the_manual() {
        let satellite = StoredSatellite::demo()[0];
        assert_eq!(satellite.closeness([1540, 760]), Some(Closeness::On));
        assert_eq!(satellite.closeness([1541, 750]), Some(Closeness::Near));
        assert_eq!(satellite.closeness([1570, 770]), Some(Closeness::Near));
        assert_eq!(satellite.closeness([1525, 771]), None);
    }

    #[test]
    fn the_signal_is_strongest_on_the_satellite() {
        let satellite = StoredSatellite::demo()[0];
        assert_eq!(satellite.agc([1525, 750]), 900);
        assert!(satellite.agc([1530, 750]) < 900);
        assert_eq!(satellite.agc([3000, 100]), 60);
        assert_eq!(satellite.polarization(263), PolarizationCode::Horizontal);
        assert_eq!(satellite.polarization(400), PolarizationCode::None);
        assert_eq!(satellite.polarization(580), PolarizationCode::NearVertical);
    }
}
