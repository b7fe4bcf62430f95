//! Possible reports of a Rotator Genius and an RC2000C, for the stories.

use std::sync::Arc;

use azel::{
    astro::Angle,
    contract::driver::{Intent, LinkState, Snapshot},
    controller::rotator_genius::{ROTATORS, Rotators},
    device::{
        AxisMotion, Measured, Pointing,
        panel::{Check, CheckState, Reading, Tone},
    },
    model::Model,
    station::{Antenna, Mount},
};

use crate::window_stories::{
    rig::{self, quiet},
    states,
};

/// Returns a Rotator Genius that turns azimuth and elevation.
pub(crate) fn pair() -> Antenna {
    Antenna::genius("Genius", "192.168.1.250:9006")
}

/// Returns a Rotator Genius of which one rotator turns the antenna.
pub(crate) fn alone() -> Antenna {
    let mut antenna = Antenna::genius("Mast", "192.168.1.250:9006");
    antenna.connection.put(&ROTATORS, Rotators::First).unwrap();
    antenna
}

/// Returns an RC2000C whose azimuth axis turns by more than a full turn.
pub(crate) fn rc2000c() -> Antenna {
    let mut antenna = Antenna::rc2000c("RC2000C", "192.168.1.30:4001");
    if let Mount::AzEl { azimuth_to_deg, .. } = &mut antenna.mount {
        *azimuth_to_deg = 450.0;
    }
    antenna
}

/// Returns the station with `config` as its antenna in the state of `snapshot`.
pub(crate) fn model(config: Antenna, snapshot: Snapshot) -> Model {
    let mut model = rig::model(quiet());
    Arc::make_mut(&mut model.shown_mut().station).antennas = vec![config.clone()];
    model.shown_mut().antennas = vec![rig::antenna(config, snapshot)];
    rig::refresh_antennas(&mut model);
    model
}

fn at(azimuth_deg: Option<f64>, elevation_deg: Option<f64>) -> Measured {
    let mut measured = states::measured(0.0, 0.0, AxisMotion::Still);
    measured.pointing = Pointing {
        azimuth: azimuth_deg.map(Angle::from_degrees),
        elevation: elevation_deg.map(Angle::from_degrees),
    };
    measured.axes[0].angle_deg = azimuth_deg;
    measured.axes[1].angle_deg = elevation_deg;
    measured
}

fn standing(intent: Intent, measured: Measured) -> Snapshot {
    let mut snapshot = Snapshot { intent, ..quiet() };
    snapshot.state.measured = Some(measured);
    snapshot.state.motion_lock = Some(false);
    snapshot.state.link_since = Some(measured.received);
    snapshot
}

/// Returns the state of a pair whose rotators stand and report themselves.
pub(crate) fn pair_at(intent: Intent) -> Snapshot {
    let mut snapshot = standing(intent, at(Some(43.0), Some(12.0)));
    snapshot.state.readings = Arc::new([
        Reading::new("1 Tower", "043°").with_bar(0.4),
        Reading::new("2 Elevation", "012° of 0 to 90"),
    ]);
    snapshot
}

/// Returns the state of two standing rotators, of which one turns the antenna. The other one has no
/// sensor if `sees_other` is false.
pub(crate) fn alone_at(intent: Intent, sees_other: bool) -> Snapshot {
    let mut measured = at(Some(43.0), None);
    measured.axes[1].angle_deg = sees_other.then_some(200.0);
    standing(intent, measured)
}

fn alarms() -> [Check; 3] {
    [
        Check::new("Azimuth drive", CheckState::Good, ""),
        Check {
            locks_motion: true,
            ..Check::new(
                "Elevation drive",
                CheckState::Fault,
                "The sensor did not move with the drive: look at the motor, then reset.",
            )
        },
        Check::new("Remote mode", CheckState::Caution, "Switch it on at the panel."),
    ]
}

fn told() -> Arc<[Reading]> {
    Arc::new([
        Reading::new("Satellite", "TÜRKSAT 4A"),
        Reading::new("Azimuth counts", "30512"),
        Reading::new("Elevation counts", "12044"),
        Reading::new("Polarization", "H, 45 units"),
        Reading::new("AGC 1", "43 %").with_bar(0.43),
        Reading::new("Alarm", "none"),
    ])
}

/// Returns the state of an RC2000C without a connection.
pub(crate) fn rc2000c_off() -> Snapshot {
    Snapshot { link: LinkState::Off, ..quiet() }
}

/// Returns the state of a calibrated RC2000C at standstill.
pub(crate) fn rc2000c_at(intent: Intent) -> Snapshot {
    let mut snapshot = standing(intent, at(Some(370.0), Some(42.4)));
    snapshot.state.readings = told();
    snapshot.state.checks = alarms().map(|check| Check { state: CheckState::Good, ..check }).into();
    snapshot.state.checked_at = Some(rig::now());
    snapshot
}

/// Returns the state of an RC2000C at its limit switch, with a drive that does not turn.
pub(crate) fn rc2000c_alarmed(intent: Intent) -> Snapshot {
    let mut snapshot = rc2000c_at(intent);
    snapshot.state.motion_lock = Some(true);
    snapshot.state.checks = alarms().into();
    let mut readings = told().to_vec();
    readings[5] = Reading::new("Alarm", "3, elevation jammed").in_tone(Tone::Bad);
    snapshot.state.readings = readings.into();
    if let Some(measured) = &mut snapshot.state.measured {
        measured.axes[1].plus_limit = true;
    }
    snapshot
}

/// Returns the state of an RC2000C at standstill without a calibration.
pub(crate) fn rc2000c_uncalibrated(intent: Intent) -> Snapshot {
    let mut snapshot = rc2000c_at(intent);
    snapshot.state.measured = Some(at(None, None));
    snapshot
}
