//! The state that all antennas have in common, as last read from the unit.

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
    /// The unit's on-board track.
    pub program: Option<Program>,
    /// Something other than the two axes turns, such as the polarization.
    pub turns_besides: bool,
    /// A fault forbids motion. `None` until the unit was asked on this link, and while the
    /// name of a new fault is not known yet.
    pub motion_lock: Option<bool>,
    /// Lower and upper end of each axis by the unit's own limits, degrees as the mount
    /// counts; `None` where it reports none.
    pub travel_deg: [Option<(f64, f64)>; 2],
    /// The azimuth axis may reach a position either way round: clockwise or counter-clockwise.
    #[serde(default)]
    pub may_turn_either_way: bool,
    /// Limits of the azimuth axis, degrees from 0 to 360, which it does not cross; `None` for one that
    /// is not known.
    #[serde(default)]
    pub azimuth_limits_deg: [Option<f64>; 2],
    /// When the present link came up. Older readings are from an earlier link.
    pub link_since: Option<Instant>,
    /// Further readings for the panel, line by line.
    pub readings: Arc<[Reading]>,
    /// Faults and warnings by name, where the unit reports them one by one.
    pub checks: Arc<[Check]>,
    /// When [`Self::checks`] were read.
    pub checked_at: Option<Timestamp>,
    /// Questions that the operator can ask by hand.
    pub questions: Arc<[Question]>,
    pub on_board: OnBoard,
    /// The satellite that the unit held when it was last read, on this link or an earlier one. Nothing is
    /// judged by it.
    #[serde(default)]
    pub last_satellite: Option<LastSatellite>,
    /// Why the last position could not be read, as far as known, and what to do, in a
    /// sentence or two.
    #[serde(deserialize_with = "name::option")]
    pub unreadable: Option<Name>,
    /// Settings that were read, and the outcome of changes.
    #[serde(rename = "held", deserialize_with = "name::shared_map")]
    pub groups: Arc<GroupStates>,
    /// Another unit answers, or one that needs a code first.
    pub is_other_device: bool,
    /// Identity that the unit reported on this link, with its firmware or names.
    pub identity: Option<String>,
    /// Name that the unit gives itself, for the head of its card.
    pub unit_name: Option<String>,
    pub traffic: Traffic,
}

impl AntennaState {
    /// The last position that was asked for on the present link.
    pub fn measured_on_link(&self) -> Option<Measured> {
        let start = self.link_since?;
        self.measured.filter(|measured| measured.requested >= start)
    }

    /// The state of a group of settings, empty if it is new.
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

    /// Forgets the results of all checks, not their names.
    pub(crate) fn forget_checks(&mut self) {
        self.checked_at = None;
        let unknown = |check: &Check| Check {
            state: CheckState::Unknown,
            unit_text: Cow::Borrowed(""),
            ..check.clone()
        };
        self.show_checks(self.checks.iter().map(unknown).collect());
    }

    /// Records the end of a change. `is_followed`: another change of its group waits.
    pub(crate) fn end_change(
        &mut self,
        change: Change,
        result: Result<(), WriteError>,
        is_followed: bool,
        now: Moment,
    ) {
        // Only the names of the fields: a value may be a secret.
        let fields: Vec<_> = change.values.keys().collect();
        tracing::info!(group = change.group, ?fields, ?result, "settings");
        let state = self.group(change.group);
        if !is_followed {
            state.step = None;
        }
        state.written = Some(Arc::new(Written { change, time: now.utc, result }));
    }
}

/// A satellite that a unit held when it was last read.
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
    /// When it was first asked for. The position may not show what the unit did after this
    /// instant.
    #[serde(rename = "asked")]
    pub requested: Instant,
    pub received: Instant,
    pub pointing: Pointing,
    pub axes: [Axis; 2],
}

impl Measured {
    /// Angles of both axes, degrees as the mount counts; a missing elevation axis counts as
    /// 0. `None` where an axis reports no angle.
    pub fn axes_deg(&self, has_elevation: bool) -> Option<[f64; 2]> {
        let [first, second] = self.axes.map(|axis| axis.angle_deg.filter(|deg| deg.is_finite()));
        Some([first?, if has_elevation { second? } else { 0.0 }])
    }

    /// The same for a plan, where an axis without an angle at a limit stands at that end of its travel.
    /// Motion needs [`Self::axes_deg`], because a limit need not be where the travel ends.
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
    /// `None` without a sensor, or while its reading gives no angle.
    pub azimuth: Option<Angle>,
    /// `None` also where there is no elevation axis.
    pub elevation: Option<Angle>,
}

impl Pointing {
    /// The direction for these angles of an elevation-over-azimuth mount, as far as they
    /// are known. Beyond 90° of elevation it is over the zenith on the other side.
    pub fn of_axes(azimuth: Option<Angle>, elevation: Option<Angle>) -> Self {
        let side = AzEl::of_axes(azimuth.unwrap_or_default(), elevation.unwrap_or_default());
        Self {
            azimuth: azimuth.map(|_| side.azimuth),
            elevation: elevation.map(|_| side.elevation),
        }
    }

    /// The direction, once both angles are known.
    pub fn direction(self) -> Option<AzEl> {
        Some(AzEl { azimuth: self.azimuth?, elevation: self.elevation? })
    }
}

impl Pointing {
    /// Angle from here to `other`: in the sky where all angles are known, else in azimuth
    /// alone; `None` without an azimuth.
    pub fn separation(self, other: Self) -> Option<Angle> {
        if let (Some(here), Some(there_direction)) = (self.direction(), other.direction()) {
            return Some(here.separation(there_direction));
        }
        Some((self.azimuth? - other.azimuth?).wrapped_180().abs())
    }

    /// Angle from here to `aim` in the angles that `aim` has; `None` while one of them is missing
    /// here.
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
    /// Direction of the antenna, once both angles are known.
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
    /// Degrees as the mount counts; `None` where unknown.
    pub angle_deg: Option<f64>,
    /// As the unit reports it, or as its angles show where it reports none: a standing axis
    /// that is said to turn delays every proof of STOP, and the reverse raises an alarm.
    pub motion: AxisMotion,
    pub drive: Drive,
    /// The limit switch at the upper end is set.
    pub plus_limit: bool,
    /// The limit switch at the lower end is set.
    pub minus_limit: bool,
}

/// Motion of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisMotion {
    Still,
    /// The angle grows.
    Plus,
    /// The angle shrinks.
    Minus,
    /// A number without a known meaning: treat it as moving.
    Unknown(i64),
}

/// State of an axis's drive, as the unit reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// Without power; the axis may still coast, or turn in the wind.
    Off,
    On,
    /// On by a jog, of Azel or of somebody else.
    Jogged,
    /// The axis turns without a command.
    Runaway,
}

/// The unit's own tracking program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    pub enabled: bool,
    pub phase: Phase,
    /// The program starts by itself when it is due; `None` where not reported.
    pub auto: Option<bool>,
}

/// Phase of the unit's tracking program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// The window has not begun, or there is none.
    OutOfWindow,
    Tracking,
    /// The window is over.
    Completed,
    /// The antenna waits at the start of the pass.
    AtStart,
    /// A number without a known meaning.
    Unknown(i64),
}

/// Counts of frames and lines on the link since it came up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Traffic {
    /// Good frames that answered a question.
    pub replies: u64,
    /// Good frames that nobody asked for.
    pub unsolicited: u64,
    /// Lines that were not good frames.
    pub damaged: u64,
    /// Good frames whose content made no sense.
    pub unreadable: u64,
    /// Questions without an answer in time.
    pub unanswered: u64,
    /// Good frames that differ from the document in a known way.
    pub odd: u64,
    /// When the last good reply came in.
    pub last_reply: Option<Instant>,
    /// When the last line came in that was no good frame, or whose content made no sense.
    pub last_unreadable: Option<Instant>,
    /// When the last positions were given up, the oldest first.
    #[serde(default)]
    pub missed: [Option<Instant>; MISSED],
}

/// So many positions that are missing within [`MISSED_WITHIN`] are more than a hiccup.
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
