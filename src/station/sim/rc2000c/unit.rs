//! Simulated unit: its memory and activity. It has no I/O and no clock: the caller passes the time
//! since the start.

mod commands;
mod peer;
mod report;

use std::collections::BTreeSet;
use std::time::Duration;

use super::axis::{Axis, AxisTrouble};
use super::feed::Feed;
use super::satellites::StoredSatellite;
use super::tracking::Tracking;
use super::{AxisOptions, Fault, Options, Quirk};
use crate::protocol::rc2000c::{Address, AxisDrive, Submode};
use crate::sim::Mechanics;

/// Time between two steps of the mount.
const STEP: Duration = Duration::from_millis(50);
/// Max elapsed time that the unit simulates; it skips a longer rest.
const LONGEST_CATCH_UP: Duration = Duration::from_mins(10);
/// Position at the start, on the first satellite of the demo, counts.
const START_COUNTS: [u16; 2] = [1525, 750];
const START_POLARIZATION: u16 = 263;

/// Source of the commands that the unit obeys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The local operator at the panel.
    Manual,
    /// A client on the line.
    Remote,
    /// The unit itself, while it follows a satellite.
    Track,
}

/// Activity of the unit, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Snapshot {
    /// Azimuth in counts.
    pub az_counts: u16,
    /// Elevation in counts.
    pub el_counts: u16,
    /// Polarization in the feed's units.
    pub polarization_units: u16,
    pub mode: Mode,
    /// `true` if anything turns, reported or not.
    pub is_turning: bool,
}

/// State of a simulated unit.
#[derive(Debug)]
pub struct Rc2000c {
    pub(super) address: Address,
    baud: u32,
    satellites: Vec<StoredSatellite>,
    pub(super) quirks: BTreeSet<Quirk>,
    pub(super) faults: BTreeSet<Fault>,
    /// Time since the start.
    elapsed: Duration,
    mode: Mode,
    axes: [AxisOptions; 2],
    mechanics: Mechanics,
    seed: u64,
    azimuth: Axis,
    elevation: Axis,
    /// Frozen counts on the display, if any.
    frozen: Option<[u16; 2]>,
    feed: Feed,
    is_auto_polarization: bool,
    tracking: Option<Tracking>,
    /// Track mode that begins when the current auto move has arrived.
    next_tracking: Option<Tracking>,
}

impl Rc2000c {
    pub(super) fn new(options: &Options) -> Self {
        let axes = [options.azimuth.clone(), options.elevation.clone()];
        let [azimuth, elevation] = stand(START_COUNTS, &axes, &options.mechanics, options.seed);
        let mut unit = Self {
            address: options.address,
            baud: options.baud.max(1),
            satellites: options.satellites.clone(),
            quirks: options.quirks.clone(),
            faults: options.faults.clone(),
            elapsed: Duration::ZERO,
            mode: Mode::Manual,
            axes,
            mechanics: options.mechanics,
            seed: options.seed,
            azimuth,
            elevation,
            frozen: None,
            feed: Feed::new(START_POLARIZATION),
            is_auto_polarization: false,
            tracking: None,
            next_tracking: None,
        };
        unit.suffer();
        unit
    }

    /// Applies the quirks and faults. Must be called after each change of them.
    pub(super) fn suffer(&mut self) {
        let has = |fault| self.faults.contains(&fault);
        self.azimuth.set_trouble(AxisTrouble {
            is_stuck: has(Fault::AzimuthJam),
            is_overloaded: has(Fault::AzimuthOvercurrent),
            runs_away: has(Fault::AzimuthRunaway),
        });
        self.elevation.set_trouble(AxisTrouble {
            is_stuck: has(Fault::ElevationJam),
            is_overloaded: has(Fault::ElevationOvercurrent),
            runs_away: has(Fault::ElevationRunaway),
        });
        let is_frozen = has(Fault::FrozenAngles);
        self.frozen = is_frozen.then(|| self.frozen.unwrap_or_else(|| self.counts()));
        self.feed.set_rotating(self.quirks.contains(&Quirk::RotatingFeed));
    }

    /// Gives the panel to the local operator: any motion from the line ends.
    pub(super) fn use_panel(&mut self) {
        self.mode = Mode::Manual;
        self.tracking = None;
        self.stop_axes();
    }

    fn stop_axes(&mut self) {
        self.next_tracking = None;
        self.azimuth.stop();
        self.elevation.stop();
    }

    fn step(&mut self, step_s: f64) {
        self.azimuth.advance(step_s);
        self.elevation.advance(step_s);
        self.feed.advance(step_s);
        if self.azimuth.has_arrived()
            && self.elevation.has_arrived()
            && let Some(tracking) = self.next_tracking.take()
        {
            self.mode = Mode::Track;
            self.tracking = Some(tracking);
        }
        self.track(step_s);
    }

    fn track(&mut self, step_s: f64) {
        let Some(tracking) = &mut self.tracking else { return };
        tracking.advance(step_s);
        let drives = [self.azimuth.drive(), self.elevation.drive()];
        if drives.contains(&AxisDrive::Jammed) {
            tracking.fail(Submode::JammedError);
        } else if drives.iter().any(|drive| drive.is_alarm()) {
            tracking.fail(Submode::DriveError);
        } else if tracking.is_peaking() && self.faults.contains(&Fault::PeakLimit) {
            tracking.fail(Submode::PeakLimitError);
        }
        if let Some([az_counts, el_counts]) = tracking.target() {
            for (axis, counts) in [(&mut self.azimuth, az_counts), (&mut self.elevation, el_counts)]
            {
                if axis.counts() != counts {
                    axis.auto_move(counts);
                }
            }
        }
        if !tracking.is_peaking()
            && let Some(polarity) = tracking.waiting.take()
        {
            self.turn_to(polarity);
        }
    }

    fn end_tracking(&mut self) {
        if self.tracking.take().is_some() {
            self.mode = Mode::Remote;
            self.stop_axes();
        }
    }

    fn counts(&self) -> [u16; 2] {
        [self.azimuth.counts(), self.elevation.counts()]
    }

    /// Returns the satellite nearest in azimuth.
    fn nearest(&self) -> Option<&StoredSatellite> {
        let az_counts = self.azimuth.counts();
        self.satellites.iter().min_by_key(|satellite| satellite.az_counts.abs_diff(az_counts))
    }
}

/// Returns both axes at rest at these counts.
fn stand(
    [az_counts, el_counts]: [u16; 2],
    [azimuth, elevation]: &[AxisOptions; 2],
    mechanics: &Mechanics,
    seed: u64,
) -> [Axis; 2] {
    let seed = seed.rotate_left(1);
    [
        Axis::new(az_counts, azimuth, mechanics, seed, false),
        Axis::new(el_counts, elevation, mechanics, seed ^ 1, true),
    ]
}

#[cfg(test)]
mod tests;
