//! Memory of the unit, with the values of a new unit.

use crate::protocol::satrak::{
    AngleChange, AngleSettings, FtpTle, GpsSettingsChange, HttpTle, PositionBase, Reduction,
    SatelliteChoice, Settings, SspaAutoRule, SspaMode, TextValue, TleMode,
};

/// Degrees per count of the position sensors: 16 bits a turn, the simulator's own choice.
const DEG_PER_COUNT: f64 = 360.0 / 65_536.0;
/// Reduction at which the drives run as commanded, from the document's example.
pub(super) const DEFAULT_REDUCTION: f64 = 4000.0;

/// Settings of the unit; `None` if never set.
#[derive(Debug, Clone)]
pub(super) struct Memory {
    pub(super) settings: Settings,
    pub(super) angles: AngleSettings,
    pub(super) gps: Option<GpsSettingsChange>,
    pub(super) satellite: Option<SatelliteChoice>,
    pub(super) http: Option<HttpTle>,
    pub(super) ftp: Option<FtpTle>,
    pub(super) image: Option<TextValue>,
    pub(super) reduction: Option<Reduction>,
}

impl Default for Memory {
    fn default() -> Self {
        Self {
            settings: Settings {
                rtc_from_gps: true,
                time_offset_ms: 0,
                az_offset_deg: 0.0,
                el_offset_deg: 0.0,
                lead_ms: 60_000,
                position_base: PositionBase::Resolver,
                minimum_elevation_deg: 3.0,
                north_offset_deg: 0.0,
                sspa: SspaMode::Off,
                sspa_auto: SspaAutoRule::Tracking,
                tle_mode: TleMode::File,
                elevation_threshold_deg: 2.0,
            },
            // Use the angles of the document's example, with counts that leave the reported angles
            // unchanged.
            angles: AngleSettings {
                x_sensor: counts(160.0),
                x_deg: 160.0,
                y_sensor: counts(40.0),
                y_deg: 40.0,
            },
            gps: None,
            satellite: None,
            http: None,
            ftp: None,
            image: None,
            reduction: None,
        }
    }
}

/// Returns the sensor reading at a mechanical angle in degrees.
fn counts(angle_deg: f64) -> i64 {
    (angle_deg / DEG_PER_COUNT).round() as i64
}

impl Memory {
    /// Returns the reported minus the mechanical angle of X and Y, degrees.
    pub(super) fn shifts_deg(&self) -> [f64; 2] {
        let AngleSettings { x_sensor, x_deg, y_sensor, y_deg } = self.angles;
        let shift = |angle_deg: f64, sensor: i64| {
            let shift = angle_deg - sensor as f64 * DEG_PER_COUNT;
            // A shift of less than a count is rounding, not calibration.
            if shift.abs() < DEG_PER_COUNT { 0.0 } else { shift }
        };
        [shift(x_deg, x_sensor), shift(y_deg, y_sensor)]
    }

    /// Applies `change` to the calibration of axes at `mechanical` degrees.
    pub(super) fn calibrate(&mut self, change: AngleChange, mechanical: [f64; 2]) {
        let [x_now, y_now] = mechanical.map(counts);
        let (x_sensor, y_sensor, angles) = match change {
            AngleChange::PresentPosition(angles) => (x_now, y_now, angles),
            AngleChange::Given { x_sensor, y_sensor, angles } => {
                (i64::from(x_sensor), i64::from(y_sensor), angles)
            }
        };
        self.angles =
            AngleSettings { x_sensor, x_deg: angles.x_deg(), y_sensor, y_deg: angles.y_deg() };
    }

    /// Returns the ratios of the drives' rates to the commanded rates.
    pub(super) fn drive_scales(&self) -> [f64; 2] {
        self.reduction.map_or([1.0; 2], |ratio| {
            [DEFAULT_REDUCTION / ratio.x(), DEFAULT_REDUCTION / ratio.y()]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::SensorAngles;

    #[test]
    fn a_new_unit_reports_its_mechanical_angles() {
        assert!(Memory::default().shifts_deg().iter().all(|shift| shift.abs() < 1e-12));
    }

    #[test]
    fn calibrating_shifts_the_reported_angles() {
        let mut memory = Memory::default();
        let angles = SensorAngles::new(100.0, 80.0).unwrap();
        memory.calibrate(AngleChange::PresentPosition(angles), [90.0, 90.0]);
        let [x, y] = memory.shifts_deg();
        assert!((x - 10.0).abs() < 0.01 && (y + 10.0).abs() < 0.01);
    }
}
