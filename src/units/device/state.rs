//! The state that all antennas share, as last read from the unit.

use std::{borrow::Cow, sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    OnBoard, Question,
    panel::{Check, CheckState, Reading},
    settings::{Change, GroupState, GroupStates, WriteError, Written},
};
use crate::{
    astro::{Angle, AzEl},
    clock::{Instant, Moment},
    name::{self, Name},
};

/// Known state of an antenna. `None` means not read yet, never a default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AntennaState {
    pub measured: Option<Measured>,
    /// State of the unit's on-board track.
    pub program: Option<Program>,
    /// `true` if a part other than the two axes turns, such as the polarization.
    pub turns_besides: bool,
    /// `true` if a fault forbids motion. `None` until Azel has asked the unit on this link, and
    /// while the name of a new fault is unknown.
    pub motion_lock: Option<bool>,
    /// Lower and upper end of each axis from the unit's own limits, degrees of the mount; `None` if
    /// the unit reports none.
    pub travel_deg: [Option<(f64, f64)>; 2],
    /// `true` if the azimuth axis may reach a position either way round: clockwise or
    /// counter-clockwise.
    #[serde(default)]
    pub may_turn_either_way: bool,
    /// Limits of the azimuth axis, degrees from 0 to 360, which the axis does not cross; `None` for
    /// an unknown limit.
    #[serde(default)]
    pub azimuth_limits_deg: [Option<f64>; 2],
    /// Time at which the current link came up. Older readings are from an earlier link.
    pub link_since: Option<Instant>,
    /// Further readings for the panel, line by line.
    pub readings: Arc<[Reading]>,
    /// Faults and warnings by name, if the unit reports them one by one.
    pub checks: Arc<[Check]>,
    /// Time at which Azel read [`Self::checks`].
    pub checked_at: Option<Timestamp>,
    /// Questions that the operator can ask by hand.
    pub questions: Arc<[Question]>,
    pub on_board: OnBoard,
    /// Satellite that the unit held when Azel last read it, on this link or an earlier one. No
    /// decision depends on it.
    #[serde(default)]
    pub last_satellite: Option<LastSatellite>,
    /// Known reason why the last position could not be read, and advice, in a sentence or two.
    #[serde(deserialize_with = "name::option")]
    pub unreadable: Option<Name>,
    /// Settings that Azel has read, and the outcome of changes.
    #[serde(rename = "held", deserialize_with = "name::shared_map")]
    pub groups: Arc<GroupStates>,
    /// `true` if another unit answers, or a unit that needs a code first.
    pub is_other_device: bool,
    /// Identity that the unit reported on this link, with its firmware or names.
    pub identity: Option<String>,
    /// Name that the unit reports for itself, for the head of its card.
    pub unit_name: Option<String>,
    pub traffic: Traffic,
}

impl AntennaState {
    /// Returns the last position that Azel requested on the current link.
    pub fn measured_on_link(&self) -> Option<Measured> {
        let start = self.link_since?;
        self.measured.filter(|measured| measured.requested >= start)
    }

    /// Returns the state of a group of settings, empty if it is new.
    pub(crate) fn group(&mut self, key: &'static str) -> &mut GroupState {
        Arc::make_mut(&mut self.groups).entry(key).or_default()
    }

    /// Replaces the readings if they changed; an unchanged list keeps its address for comparisons.
    pub(crate) fn show_readings(&mut self, readings: Vec<Reading>) {
        if *self.readings != readings {
            self.readings = readings.into();
        }
    }

    /// Replaces the checks if they changed; an unchanged list keeps its address for comparisons.
    pub(crate) fn show_checks(&mut self, checks: Vec<Check>) {
        if *self.checks != checks {
            self.checks = checks.into();
        }
    }

    /// Clears the results of all checks, and keeps their names.
    pub(crate) fn forget_checks(&mut self) {
        self.checked_at = None;
        let unknown = |check: &Check| Check {
            state: CheckState::Unknown,
            unit_text: Cow::Borrowed(""),
            ..check.clone()
        };
        self.show_checks(self.checks.iter().map(unknown).collect());
    }

    /// Records the end of a change. `is_followed` is `true` if another change of its group waits.
    pub(crate) fn end_change(
        &mut self,
        change: Change,
        result: Result<(), WriteError>,
        is_followed: bool,
        now: Moment,
    ) {
        // The log contains only the names of the fields, because a value may be a secret.
        let fields: Vec<_> = change.values.keys().collect();
        tracing::info!(group = change.group, ?fields, ?result, "settings");
        let state = self.group(change.group);
        if !is_followed {
            state.step = None;
        }
        state.written = Some(Arc::new(Written { change, time: now.utc, result }));
    }
}

/// A satellite that a unit held when Azel last read it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LastSatellite {
    pub name: String,
    pub read_at: Timestamp,
}

/// A position that a unit reported.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Time of the measurement, estimated from the round trip over the link.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Time of the first request for the position. The position may not show the unit's actions
    /// after this time.
    #[serde(rename = "asked")]
    pub requested: Instant,
    pub received: Instant,
    pub pointing: Pointing,
    pub axes: [Axis; 2],
}

impl Measured {
    /// Returns the angles of both axes, degrees of the mount; a missing elevation axis counts as 0.
    /// `None` if an axis reports no angle.
    pub fn axes_deg(&self, has_elevation: bool) -> Option<[f64; 2]> {
        let [first, second] = self.axes.map(|axis| axis.angle_deg.filter(|deg| deg.is_finite()));
        Some([first?, if has_elevation { second? } else { 0.0 }])
    }

    /// Returns the same for a plan, in which an axis without an angle at a limit stands at that end
    /// of its travel. Motion needs [`Self::axes_deg`], because a limit need not be the end of the
    /// travel.
    pub fn planned_axes_deg(
        &self,
        travel_deg: [(f64, f64); 2],
        has_elevation: bool,
    ) -> Option<[f64; 2]> {
        let mut measured = *self;
        for (axis, (from_deg, to_deg)) in measured.axes.iter_mut().zip(travel_deg) {
            let end_deg = match (axis.minus_limit, axis.plus_limit) {
                (true, false) => Some(from_deg),
                (false, true) => Some(to_deg),
                (true, true) | (false, false) => None,
            };
            axis.angle_deg = axis.angle_deg.or(end_deg);
        }
        measured.axes_deg(has_elevation)
    }
}

/// Direction of an antenna, as far as its unit reports it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pointing {
    /// Azimuth; `None` without a sensor, or while its reading gives no angle.
    pub azimuth: Option<Angle>,
    /// Elevation; `None` also without an elevation axis.
    pub elevation: Option<Angle>,
}

impl Pointing {
    /// Returns the direction for the known angles of an elevation-over-azimuth mount. An elevation
    /// beyond 90° points over the zenith to the other side.
    pub fn of_axes(azimuth: Option<Angle>, elevation: Option<Angle>) -> Self {
        let side = AzEl::of_axes(azimuth.unwrap_or_default(), elevation.unwrap_or_default());
        Self {
            azimuth: azimuth.map(|_| side.azimuth),
            elevation: elevation.map(|_| side.elevation),
        }
    }

    /// Returns the direction, once both angles are known.
    pub fn direction(self) -> Option<AzEl> {
        Some(AzEl { azimuth: self.azimuth?, elevation: self.elevation? })
    }
}

impl Pointing {
    /// Returns the angle from here to `other`: in the sky if all angles are known, else in azimuth
    /// only; `None` without an azimuth.
    pub fn separation(self, other: Self) -> Option<Angle> {
        if let (Some(here), Some(there_direction)) = (self.direction(), other.direction()) {
            return Some(here.separation(there_direction));
        }
        Some((self.azimuth? - other.azimuth?).wrapped_180().abs())
    }

    /// Returns the angle from here to `aim` in the angles that `aim` has; `None` while one of them
    /// is missing here.
    pub fn deviation(self, aim: Self) -> Option<Angle> {
        match aim {
            Self { azimuth: Some(azimuth), elevation: Some(elevation) } => {
                Some(self.direction()?.separation(AzEl { azimuth, elevation }))
            }
            Self { azimuth: Some(azimuth), elevation: None } => {
                Some((self.azimuth? - azimuth).wrapped_180().abs())
            }
            Self { azimuth: None, elevation: Some(elevation) } => {
                Some((self.elevation? - elevation).abs())
            }
            Self { azimuth: None, elevation: None } => None,
        }
    }
}

impl From<AzEl> for Pointing {
    fn from(direction: AzEl) -> Self {
        Self { azimuth: Some(direction.azimuth), elevation: Some(direction.elevation) }
    }
}

impl Measured {
    /// Returns the direction of the antenna, once both angles are known.
    pub fn direction(&self) -> Option<AzEl> {
        self.pointing.direction()
    }

    /// Returns `true` if any axis turns, or may turn.
    pub fn moving(&self) -> bool {
        self.axes.iter().any(|axis| axis.motion != AxisMotion::Still)
    }
}

/// One axis as the unit reports it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Angle in degrees of the mount; `None` if unknown.
    pub angle_deg: Option<f64>,
    /// Motion as the unit reports it, or as its angles show if it reports none. A false report of
    /// motion delays every proof of STOP, and a false report of standstill raises an alarm.
    pub motion: AxisMotion,
    pub drive: Drive,
    /// `true` if the limit switch at the upper end is set.
    pub plus_limit: bool,
    /// `true` if the limit switch at the lower end is set.
    pub minus_limit: bool,
}

/// Motion of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisMotion {
    Still,
    /// Motion towards larger angles.
    Plus,
    /// Motion towards smaller angles.
    Minus,
    /// A number without a known meaning, which counts as motion.
    Unknown(i64),
}

/// State of an axis's drive, as the unit reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// No power; the axis may still coast, or turn in the wind.
    Off,
    On,
    /// Power from a jog, by Azel or by another operator.
    Jogged,
    /// Motion of the axis without a command.
    Runaway,
}

/// The unit's own tracking program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    pub enabled: bool,
    pub phase: Phase,
    /// `true` if the program starts unattended when it is due; `None` if not reported.
    pub auto: Option<bool>,
}

/// Phase of the unit's tracking program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// A window that has not begun, or no window.
    OutOfWindow,
    Tracking,
    /// A window that is over.
    Completed,
    /// An antenna that waits at the start of the pass.
    AtStart,
    /// A number without a known meaning.
    Unknown(i64),
}

/// Counts of frames and lines on the link since it came up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Traffic {
    /// Good frames that answered a question.
    pub replies: u64,
    /// Good frames without a request.
    pub unsolicited: u64,
    /// Lines that were not good frames.
    pub damaged: u64,
    /// Good frames with invalid content.
    pub unreadable: u64,
    /// Questions without an answer in time.
    pub unanswered: u64,
    /// Good frames that differ from the document in a known way.
    pub odd: u64,
    /// Time of the last good reply.
    pub last_reply: Option<Instant>,
    /// Time of the last line that was not a good frame or had an invalid content.
    pub last_unreadable: Option<Instant>,
    /// Times at which Azel gave up the last missing positions, the oldest first.
    #[serde(default)]
    pub missed: [Option<Instant>; MISSED],
}

/// Number of missing positions within [`MISSED_WITHIN`] that shows a bad link.
const MISSED: usize = 3;
const MISSED_WITHIN: Duration = Duration::from_secs(10);

impl Traffic {
    pub(crate) fn miss_position(&mut self, now: Instant) {
        self.missed.rotate_left(1);
        if let Some(last) = self.missed.last_mut() {
            *last = Some(now);
        }
    }

    /// Returns `true` while three positions of the last ten seconds are missing.
    pub fn loses_positions(&self, now: Instant) -> bool {
        let oldest = self.missed.first().copied().flatten();
        oldest.is_some_and(|instant| now.saturating_duration_since(instant) < MISSED_WITHIN)
    }
}
