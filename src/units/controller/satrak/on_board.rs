//! Conversion of a Satrak's reports to the data that all units with on-board tracking share.

use super::reported::Reported;
use crate::{
    device::{HeldSatellite, Offsets, OnBoard, Place},
    protocol::satrak::Position,
};

/// Resolution of a reported place, degrees: the unit writes two decimals.
const STEP_DEG: f64 = 0.01;

impl Reported {
    /// Returns the data by which the unit tracks.
    pub(super) fn on_board(&self) -> OnBoard {
        let offsets = self.settings.as_ref().map(|settings| Offsets {
            time_s: settings.time_offset_ms as f64 / 1000.0,
            azimuth_deg: settings.az_offset_deg,
            elevation_deg: settings.el_offset_deg,
            north_deg: settings.north_offset_deg,
            minimum_elevation_deg: settings.minimum_elevation_deg,
            lead_s: settings.lead_ms as f64 / 1000.0,
        });
        let satellite = self.satellite.as_ref().map(|current| HeldSatellite {
            catalog_number: current.catalog_number,
            name: current.name.clone(),
            maximum_elevation_deg: self
                .height_is_of_window
                .then_some(current.maximum_elevation_deg),
        });
        OnBoard {
            place: self.place().map(|place| Place {
                latitude_deg: place.latitude_deg(),
                longitude_deg: place.longitude_deg(),
                step_deg: STEP_DEG,
            }),
            clock: self.clock,
            offsets,
            satellite,
            window: self.window.map(|window| (window.start, window.stop)),
        }
    }

    /// Returns the place in use: the configured one, or the place from the GPS receiver. The
    /// document does not say which place the unit uses without a fix.
    fn place(&self) -> Option<Position> {
        let settings = self.gps_settings?;
        if settings.automatic {
            return self.gps.filter(|gps| gps.valid)?.position;
        }
        settings.position
    }
}
