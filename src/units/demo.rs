//! Demo station for an Azel without settings.

use crate::{
    controller::{rc2000c::Calibration, satrak::ELEMENT_FILE},
    device::CountPoint,
    station::{Antenna, AntennaId, Mount, Station},
};

/// Element file of a simulated Satrak.
pub const BUNDLED_FILE: &str = "active.txt";

/// Addresses of the three simulated units.
#[derive(Debug, Clone, Default)]
pub struct DemoAddresses {
    /// Host and port of the Satrak.
    pub satrak: String,
    /// Host and port of the Rotator Genius.
    pub genius: String,
    /// Serial port of the RC2000C, or host and port.
    pub rc2000c: String,
}

impl Station {
    /// Returns the demo station for an Azel without settings: a simulated unit of each make, and
    /// well-known weather and research satellites.
    pub fn demo(addresses: &DemoAddresses) -> Self {
        let mut antennas = vec![
            satrak(&addresses.satrak),
            Antenna::genius("Genius", &addresses.genius),
            rc2000c(&addresses.rc2000c),
        ];
        for (antenna, number) in antennas.iter_mut().zip(AntennaId::FIRST.0..) {
            antenna.id = AntennaId(number);
        }
        Self { name: "Demo station".to_owned(), antennas, ..Self::default() }
    }
}

fn satrak(address: &str) -> Antenna {
    let mut antenna = Antenna::satrak("Satrak", address);
    // The call cannot fail: a Satrak has this setting, and it accepts any text.
    antenna.connection.put(&ELEMENT_FILE, BUNDLED_FILE).ok();
    antenna
}

/// Returns the antenna of the simulated RC2000C, which turns from east over south to west, 20
/// counts a degree.
fn rc2000c(address: &str) -> Antenna {
    let mut antenna = Antenna::rc2000c("RC2000C", address);
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: 90.0,
        azimuth_to_deg: 270.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 90.0), point(3630, 270.0)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    // The call cannot fail: an RC2000C has these settings, and the points make a scale.
    calibration.put_into(&mut antenna.connection).ok();
    antenna
}
