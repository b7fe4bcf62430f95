//! Status of the antennas, in a form for scripts and other programs.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::Angle,
    contract::{
        Snapshot,
        antenna::AntennaModel,
        automatic::Operation,
        driver::{LinkState, StopState},
    },
};

/// Status of an antenna.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AntennaStatus {
    /// Name of the antenna.
    pub antenna: String,
    pub link: LinkStatus,
    /// Operator's intent: `standby`, `manual`, `position`, `track` or `park`.
    pub intent: String,
    /// Measured azimuth, degrees.
    pub azimuth_deg: Option<f64>,
    /// Measured elevation, degrees.
    pub elevation_deg: Option<f64>,
    /// Time of the measurement.
    pub measured_at: Option<Timestamp>,
    /// Motion at the last measurement.
    pub moves: Option<bool>,
    /// Name of the tracked target, with on-board or program track.
    pub tracks: Option<String>,
    /// `true` if a STOP is owed.
    pub owes_stop: bool,
    /// Automatic operation.
    pub automatic: AutomaticStatus,
    /// Holder and reason of the lock-out.
    pub locked_out: Option<String>,
}

/// Automatic operation of an antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AutomaticStatus {
    Off,
    On,
    /// Automatic operation waits for the operator because somebody moved the antenna.
    Suspended,
}

/// State of the link to a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LinkStatus {
    /// No link is wanted.
    Off,
    /// First attempt to connect.
    Connecting,
    /// The unit answers.
    Up,
    /// The last answer is old.
    Stale,
    /// The link is lost, and Azel tries to connect again.
    Lost,
    /// Another Azel of this machine drives the unit.
    Elsewhere,
}

impl LinkStatus {
    pub fn new(antenna: &AntennaModel) -> Self {
        match antenna.snapshot.link {
            _ if antenna.held_by.is_some() => Self::Elsewhere,
            LinkState::Off => Self::Off,
            LinkState::Connecting { .. } => Self::Connecting,
            LinkState::Up { .. } => Self::Up,
            LinkState::Stale { .. } => Self::Stale,
            LinkState::Lost { .. } => Self::Lost,
        }
    }
}

impl AntennaStatus {
    /// Returns the status of all antennas.
    pub fn of_all(station: &Snapshot) -> Vec<Self> {
        station.antennas.iter().map(Self::new).collect()
    }

    pub fn new(antenna: &AntennaModel) -> Self {
        let snapshot = &antenna.snapshot;
        let measured = snapshot.state.measured;
        let by_unit = snapshot.state.program.filter(|program| program.enabled);
        let satellite = by_unit.and(snapshot.state.on_board.satellite.as_ref());
        let followed = snapshot.program_track.as_ref().map(|following| following.name.clone());
        let lock_out = snapshot.lock_out.as_ref();
        Self {
            antenna: antenna.config.name.clone(),
            link: LinkStatus::new(antenna),
            intent: format!("{:?}", snapshot.intent).to_lowercase(),
            azimuth_deg: measured
                .and_then(|measured| measured.pointing.azimuth)
                .map(Angle::degrees),
            elevation_deg: measured
                .and_then(|measured| measured.pointing.elevation)
                .map(Angle::degrees),
            measured_at: measured.map(|measured| measured.time),
            moves: measured.map(|measured| measured.moving()),
            tracks: followed.or_else(|| satellite.map(|satellite| satellite.name.clone())),
            owes_stop: matches!(
                snapshot.stop,
                StopState::Stopping { .. } | StopState::NotConfirmed { .. }
            ),
            automatic: match antenna.operation {
                Operation::Off(_) => AutomaticStatus::Off,
                Operation::On(_) => AutomaticStatus::On,
                Operation::Suspended { .. } => AutomaticStatus::Suspended,
            },
            locked_out: lock_out
                .map(|lock_out| format!("{}: {}", lock_out.operator, lock_out.reason)),
        }
    }
}
