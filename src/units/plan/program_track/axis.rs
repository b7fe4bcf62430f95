//! Commands for one axis.

use super::{drives::Drives, path::Path, slew_rate::SlewRate};
use crate::{clock::Instant, station::TrackSettings};

/// Number of iterations on the time of arrival.
const ROUNDS: usize = 4;
/// Tolerance for angles that are given in decimal degrees.
const ROUNDING_DEG: f64 = 1e-9;
/// Max time for which an axis that is ahead waits for the path, seconds.
const MAX_WAIT_S: f64 = 15.0;
/// Max distance from its goal at which any drive stops, degrees.
const MAX_IGNORED_DEG: f64 = 10.0;

/// Position and state of an axis at the last measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisNow {
    /// Position, degrees as the mount counts; `None` if unknown.
    pub position_deg: Option<f64>,
    /// `true` if the axis is at rest since the last command.
    pub stands: bool,
}

impl AxisNow {
    fn rest_deg(self) -> Option<f64> {
        self.position_deg.filter(|_| self.stands)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LastCommand {
    /// Commanded position, degrees; `None` if unknown.
    to_deg: Option<f64>,
    /// Rest position of the axis before the command, degrees.
    from_deg: Option<f64>,
}

/// Desired position of an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    position_deg: f64,
    /// `true` if the error would exceed the allowed error without a command.
    pub(super) is_due: bool,
}

/// Command planning for one axis of an antenna that tracks.
#[derive(Debug)]
pub(super) struct TrackedAxis {
    /// Index of the axis, 0 or 1.
    index: usize,
    pub(super) drives: Drives,
    settings: TrackSettings,
    pub(super) last_command: LastCommand,
    /// Longest distance for which the axis did not set out, degrees.
    ignored_deg: f64,
    /// Length of the axis motion for the shortest distance for which it sets out, degrees.
    min_run_deg: Option<f64>,
    slew_rate: SlewRate,
}

impl TrackedAxis {
    pub(super) fn new(index: usize, drives: Drives, settings: TrackSettings) -> Self {
        Self {
            index,
            drives,
            settings,
            last_command: LastCommand::default(),
            ignored_deg: 0.0,
            min_run_deg: None,
            slew_rate: SlewRate::default(),
        }
    }

    /// Takes a measured position. Returns the full rate of the axis, degrees per second, if the
    /// position ends a long slew.
    pub(super) fn watch(&mut self, instant: Instant, position_deg: Option<f64>) -> Option<f64> {
        self.slew_rate.take(instant, position_deg, self.last_command.to_deg)
    }

    /// Learns the shortest distance for which the axis sets out. A drive that stops some degrees
    /// early and lets the axis coast does not start at all for such a short distance.
    pub(super) fn learn(&mut self, now: AxisNow) {
        let Some(at_deg) = now.rest_deg() else { return };
        let Some((from_deg, to_deg)) =
            self.last_command.from_deg.take().zip(self.last_command.to_deg)
        else {
            return;
        };
        let way_deg = (to_deg - from_deg).abs();
        let run_deg = (at_deg - from_deg).abs();
        if run_deg >= self.half_step_deg() {
            // A longer distance does not show the shortest run.
            if way_deg <= self.min_way_deg() {
                self.min_run_deg = Some(run_deg.min(way_deg));
            }
        } else if way_deg <= MAX_IGNORED_DEG {
            // For a longer distance, standing still is a fault of the drive and not its normal
            // behaviour.
            self.ignored_deg = self.ignored_deg.max(way_deg);
            // The command had no effect. A comparison with it could make the next command look like
            // a repetition.
            self.last_command.to_deg = Some(from_deg);
            self.min_run_deg = None;
        }
    }

    /// Returns the desired position of the axis, and whether it needs a command now.
    pub(super) fn demand(&self, path: &Path, now_s: f64, now: AxisNow) -> Demand {
        let period_s = self.settings.period().as_secs_f64();
        let begins_s = now_s + self.settings.latency_s;
        let lead_deg = self.band_deg() - self.half_step_deg();
        let mut way_s = 0.0_f64;
        let mut position_deg = 0.0;
        let mut from_s = begins_s;
        for _ in 0..ROUNDS {
            // The axis turns first and then stands. Its mean error over the period is smallest if
            // it goes to the target's position in the middle of the two.
            let middle_s = begins_s + way_s.max(f64::midpoint(period_s, way_s));
            from_s = middle_s - period_s / 2.0;
            // A single command covers a whole slew.
            let wanted_deg = path.slew_end_deg(self.index, from_s).unwrap_or_else(|| {
                let to_s = from_s + period_s;
                let (min, max) = path.longest_span_deg(self.index, from_s, to_s, 2.0 * lead_deg);
                f64::midpoint(min, max)
            });
            position_deg = self.far_enough_deg(wanted_deg, now);
            let way_deg = now.position_deg.map_or(0.0, |at_deg| (position_deg - at_deg).abs());
            way_s = way_deg / self.rate_deg_s();
        }
        let (low_deg, high_deg) = path.span_deg(self.index, from_s, from_s + period_s);
        // A rest position near the commanded one is within the rounding of the sensor.
        let (rest_deg, commanded_deg) = (now.rest_deg(), self.last_command.to_deg);
        let rounding_deg = (self.settings.dead_band_deg / 2.0).max(self.half_step_deg());
        let elsewhere = |at_deg: &f64| {
            commanded_deg.is_none_or(|commanded_deg| {
                (at_deg - commanded_deg).abs() > rounding_deg + ROUNDING_DEG
            })
        };
        let stays_deg = rest_deg.filter(elsewhere).or_else(|| self.comes_to_rest_deg(now));
        // Only a drive with a shortest run overshoots. On a detour, a waiting axis could come too
        // close to the keep-out.
        let waits = self.ignored_deg > 0.0 && !path.goes_round();
        let later = waits.then(|| path.span_deg(self.index, from_s, from_s + MAX_WAIT_S));
        let is_off =
            stays_deg.is_none_or(|at_deg| self.is_left(at_deg, (low_deg, high_deg), later));
        // Do not repeat the same command to an axis that rests elsewhere.
        let is_new = commanded_deg.is_none_or(|commanded_deg| {
            let change_deg = (position_deg - commanded_deg).abs();
            change_deg > ROUNDING_DEG && change_deg > lead_deg - ROUNDING_DEG
        });
        Demand { position_deg, is_due: is_off && is_new }
    }

    /// Returns the rest position of the last command, degrees. A drive that ignores short distances
    /// switches off early by the same distance, and then coasts.
    fn comes_to_rest_deg(&self, now: AxisNow) -> Option<f64> {
        let commanded_deg = self.last_command.to_deg?;
        let (Some(at_deg), Some(run_deg), false) = (now.position_deg, self.min_run_deg, now.stands)
        else {
            return Some(commanded_deg);
        };
        let left_deg = commanded_deg - at_deg;
        let short_deg = (self.min_way_deg() - run_deg).max(0.0).min(left_deg.abs());
        Some(commanded_deg - short_deg.copysign(left_deg))
    }

    /// Returns `true` if an axis that stays at `at_deg` is too far from its path. `span_deg`: path
    /// during the next period. `later_deg`: path while an axis that is ahead may wait for it;
    /// `None` if it may not wait. Turning back would reverse the motor twice.
    fn is_left(&self, at_deg: f64, span_deg: (f64, f64), later_deg: Option<(f64, f64)>) -> bool {
        let band_deg = self.band_deg() + ROUNDING_DEG;
        let ahead_deg = self.min_way_deg().max(2.0 * band_deg);
        let is_left = |off_deg: f64, later_off_deg: Option<f64>| {
            let comes_back = later_off_deg.is_some_and(|off_deg| off_deg <= band_deg);
            off_deg > band_deg && !(comes_back && off_deg <= ahead_deg)
        };
        is_left(span_deg.1 - at_deg, later_deg.map(|(lowest_deg, _)| lowest_deg - at_deg))
            || is_left(at_deg - span_deg.0, later_deg.map(|(_, highest_deg)| at_deg - highest_deg))
    }

    /// Returns the command for this axis when at least one axis needs one; `None` leaves the axis
    /// alone.
    pub(super) fn command(&self, demand: Demand, now: AxisNow) -> Option<f64> {
        if demand.is_due || !self.drives.takes_single_axes() {
            return Some(demand.position_deg);
        }
        // An axis at its position gets no command; a moving axis continues.
        if now.stands { None } else { self.last_command.to_deg.or(Some(demand.position_deg)) }
    }

    /// Returns the state of the axis after a command to `position_deg`.
    pub(super) fn commanded(&self, position_deg: Option<f64>, now: AxisNow) -> LastCommand {
        let sent = |to_deg| LastCommand { to_deg: Some(to_deg), from_deg: now.rest_deg() };
        position_deg.map_or(self.last_command, sent)
    }

    /// Returns the error at which Azel commands the axis again, degrees. The command leads the
    /// target by the same angle, so that the error is equal on both sides.
    pub(super) fn band_deg(&self) -> f64 {
        let run_deg = self.min_run_deg.unwrap_or_else(|| self.min_way_deg());
        self.settings.dead_band_deg.max(run_deg / 2.0).max(self.half_step_deg())
    }

    /// Returns the min distance of a command, degrees.
    fn min_way_deg(&self) -> f64 {
        self.ignored_deg + self.drives.step_deg
    }

    fn rate_deg_s(&self) -> f64 {
        let of_axis = self.drives.rates_deg_s.get(self.index).copied();
        of_axis.unwrap_or(self.drives.limits.maximum_rate_deg_s)
    }

    fn half_step_deg(&self) -> f64 {
        self.drives.step_deg / 2.0
    }

    /// Returns the position nearest to `wanted_deg` that Azel can command and for which the axis
    /// sets out.
    fn far_enough_deg(&self, wanted_deg: f64, now: AxisNow) -> f64 {
        let near_deg = self.drives.tellable_deg(self.index, wanted_deg);
        let Some(at_deg) = now.rest_deg() else { return near_deg };
        if self.ignored_deg <= 0.0 || (near_deg - at_deg).abs() > self.ignored_deg {
            return near_deg;
        }
        let way_deg = self.min_way_deg().copysign(wanted_deg - at_deg);
        self.drives.tellable_deg(self.index, at_deg + way_deg)
    }
}
