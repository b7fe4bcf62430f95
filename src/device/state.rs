//! The state that all antennas share, as last read from the device.

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    OnBoard, Question,
    panel::{Check, Reading},
    settings::{Change, GroupState, Held, WriteError, Written},
};
use crate::{
    astro::{Angle, AzEl},
    clock::{Instant, Moment},
    name::{self, Name},
};

/// What is known of an antenna. `None` means not read yet, never a default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AntennaState {
    /// The last measured position.
    pub measured: Option<Measured>,
    /// The device's own tracking program.
    pub program: Option<Program>,
    /// Something besides the two axes turns, such as the polarization.
    pub turns_besides: bool,
    /// Something is wrong that forbids motion; `None` until the device was
    /// asked on this link, and while a new fault is not yet known by name.
    pub motion_lock: Option<bool>,
    /// Both ends of each axis by the device's own limits, degrees as the mount
    /// counts; `None` where it tells none.
    pub travel_deg: [Option<(f64, f64)>; 2],
    /// When the present link came up: what is older tells of another time.
    pub link_since: Option<Instant>,
    /// What it tells beyond the above, line by line for its panel.
    pub readings: Arc<[Reading]>,
    /// Its faults and warnings by name, where it reports them one by one.
    pub checks: Arc<[Check]>,
    /// When [`Self::checks`] were read.
    pub checked_at: Option<Timestamp>,
    /// What it can be asked by hand.
    pub questions: Arc<[Question]>,
    /// What it goes by when it tracks by itself.
    pub on_board: OnBoard,
    /// Why the last position could not be read, as far as it is known, and what to do;
    /// in a sentence or two.
    #[serde(deserialize_with = "name::option")]
    pub unreadable: Option<Name>,
    /// Its settings, as far as they were read, and what came of changes.
    #[serde(deserialize_with = "name::shared_map")]
    pub held: Arc<Held>,
    /// What answers is another device, or wants to be told a code first.
    pub is_other_device: bool,
    /// Who it says that it is, with its firmware or names, as told on this link.
    pub identity: Option<String>,
    /// What it calls itself, for the head of its card.
    pub unit_name: Option<String>,
    /// What went over the link.
    pub traffic: Traffic,
}

impl AntennaState {
    /// What is known of a group of settings.
    pub(crate) fn group(&mut self, key: &'static str) -> &mut GroupState {
        Arc::make_mut(&mut self.held).entry(key).or_default()
    }

    /// A change is over, for good or bad. `is_followed` by another one of its group.
    pub(crate) fn end_change(
        &mut self,
        change: Change,
        result: Result<(), WriteError>,
        is_followed: bool,
        now: Moment,
    ) {
        // The names of what was changed only: a value may be a secret.
        let fields: Vec<_> = change.values.keys().collect();
        tracing::info!(group = change.group, ?fields, ?result, "settings");
        let state = self.group(change.group);
        if !is_followed {
            state.step = None;
        }
        state.written = Some(Arc::new(Written { change, at: now.utc, result }));
    }
}

/// A measured position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// When the device measured it, as well as the way over the link tells.
    pub at: Timestamp,
    /// When it was asked for, the first time. What the device did after this
    /// instant may not show in it.
    pub asked: Instant,
    /// When it came in.
    pub received: Instant,
    /// Where the antenna points.
    pub pointing: Pointing,
    /// Its two axes.
    pub axes: [Axis; 2],
}

impl Measured {
    /// Where both axes stand, degrees as the mount counts; an antenna without an
    /// elevation axis counts as one at 0. `None` where an axis tells no angle.
    pub fn axes_deg(&self, has_elevation: bool) -> Option<[f64; 2]> {
        let [first, second] = self.axes.map(|axis| axis.angle_deg.filter(|deg| deg.is_finite()));
        Some([first?, if has_elevation { second? } else { 0.0 }])
    }
}

/// Where an antenna points, as far as its device tells.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pointing {
    /// `None` without a sensor, or while the reading cannot be turned into one.
    pub azimuth: Option<Angle>,
    /// As the azimuth; `None` for good where there is no elevation axis.
    pub elevation: Option<Angle>,
}

impl Pointing {
    /// Where axes of elevation over azimuth point that stand there, as far as they
    /// are known: beyond 90 degrees of elevation over the zenith to the other side.
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
    /// How far it is from here to `other`: in the sky where all angles are known,
    /// else by the azimuth alone; `None` without one.
    pub fn separation(self, other: Self) -> Option<Angle> {
        if let (Some(here), Some(there)) = (self.direction(), other.direction()) {
            return Some(here.separation(there));
        }
        Some((self.azimuth? - other.azimuth?).wrapped_180().abs())
    }
}

impl From<AzEl> for Pointing {
    fn from(direction: AzEl) -> Self {
        Self { azimuth: Some(direction.azimuth), elevation: Some(direction.elevation) }
    }
}

impl Measured {
    /// Where the antenna points, once both angles are known.
    pub fn direction(&self) -> Option<AzEl> {
        self.pointing.direction()
    }

    /// Whether any axis turns, or may turn.
    pub fn moving(&self) -> bool {
        self.axes.iter().any(|axis| axis.motion != AxisMotion::Still)
    }
}

/// One axis as the device reports it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// In degrees, counted as the mount counts; `None` when it is not known.
    pub angle_deg: Option<f64>,
    /// Whether it turns.
    pub motion: AxisMotion,
    /// The limit switch at the upper end is set.
    pub plus_limit: bool,
    /// The limit switch at the lower end is set.
    pub minus_limit: bool,
}

/// Whether an axis turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisMotion {
    /// It stands.
    Still,
    /// Its angle grows.
    Plus,
    /// Its angle shrinks.
    Minus,
    /// The device reports a number without a meaning: treat it as moving.
    Unknown(i64),
}

/// The device's own tracking program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    /// It is switched on.
    pub enabled: bool,
    /// What it is about.
    pub phase: Phase,
    /// It starts by itself when its time comes; `None` when not told.
    pub auto: Option<bool>,
}

/// What the device's tracking program is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Its time has not come, or there is none.
    OutOfWindow,
    /// It follows.
    Tracking,
    /// Its time is over.
    Completed,
    /// It waits at the place where the pass begins.
    AtStart,
    /// The device reports a number without a meaning.
    Unknown(i64),
}

/// What went over the link since it came up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Traffic {
    /// Good frames that answered a question.
    pub replies: u64,
    /// Good frames that nobody asked for.
    pub unsolicited: u64,
    /// Lines that were no good frame.
    pub damaged: u64,
    /// Good frames whose content made no sense.
    pub unreadable: u64,
    /// Questions without an answer in time.
    pub unanswered: u64,
    /// Good frames that differ from the document in a known way.
    pub odd: u64,
    /// When the last good reply came in.
    pub last_reply: Option<Instant>,
    /// When the last good frame came in whose content made no sense.
    pub last_unreadable: Option<Instant>,
}
