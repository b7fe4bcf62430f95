//! Target of program track, and the quality of its track.

use std::time::Duration;

use super::{likeness::Recheck, off_target::OffTarget};
use crate::{
    astro::{Angle, PointingModel, TrackOffsets},
    clock::Instant,
    contract::driver::TrackView,
    device::{Axis, AxisMotion, Capabilities, Measured, Pointing},
    plan::{
        Sample, TrackPhase, TrackStats,
        program_track::{AxisNow, Drives, Next, OnPath, Planner},
    },
    station::{self, Antenna},
};

/// Max time without an angle of an axis before the track ends.
const UNMEASURED: Duration = Duration::from_secs(10);

/// Max number of consecutive commands without an answer and without effect.
const MAX_LOST: u32 = 3;
/// Interval between updates while a barrier blocks the path.
const BLOCKED: Duration = Duration::from_secs(2);
/// Max number of changes that the operator can undo.
const MAX_UNDO: usize = 100;

/// Settings of program track.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackConfig {
    pub(super) drives: Drives,
    pub(super) settings: station::TrackSettings,
    pub(super) model: PointingModel,
}

impl TrackConfig {
    /// Returns the learned or configured rates of both axes, degrees a second.
    pub(super) fn rates_deg_s(&self) -> [f64; 2] {
        self.drives.rates_deg_s
    }

    pub(super) fn new(antenna: &Antenna, can: Capabilities) -> Self {
        let drives = Drives {
            mount: antenna.track_mount(),
            limits: antenna.limits,
            rates_deg_s: [antenna.limits.maximum_rate_deg_s; 2],
            step_deg: can.position_step_deg,
            arrives_within_deg: can.arrives_within_deg,
            has_elevation: can.has_elevation(),
        };
        Self { drives, settings: antenna.follow, model: antenna.track_model() }
    }

    /// Returns the operator's rate limit, degrees a second.
    pub(super) fn fastest_deg_s(&self) -> f64 {
        self.drives.limits.maximum_rate_deg_s
    }
}

pub(super) struct Tracking {
    pub(super) planner: Planner,
    phase: TrackPhase,
    /// Offsets before each change in the pass, the oldest first.
    earlier: Vec<TrackOffsets>,
    stats: TrackStats,
    next_update: Instant,
    /// `true` if a due position waits for the end of another action, which then triggers it.
    is_held_up: bool,
    /// Time at which the last command passed the gate.
    sent: Option<Instant>,
    /// Number of consecutive lost commands.
    lost: u32,
    /// Receive time of the last compared position.
    compared: Option<Instant>,
    predicted: Option<Sample>,
    /// Last measurement against the planned path; `None` before the pass.
    on_path: Option<OnPath>,
    off_target: OffTarget,
    /// Start and latest time of an unbroken series of readings without the angle of an axis that is
    /// off its limits.
    unmeasured: Option<(Instant, Instant)>,
    /// `true` while the track waits for the operator.
    awaits_operator: bool,
    /// Pending comparison of the unit with its earlier state.
    recheck: Option<Recheck>,
    /// `true` if Azel has reported the barrier on the path.
    barrier_is_reported: bool,
    /// Target of the last command.
    commanded: Option<Pointing>,
    /// Target of the last command while the satellite is not up.
    aim: Option<Pointing>,
}

impl Tracking {
    /// Creates a track without a sent position; the first update is due now.
    pub(super) fn new(planner: Planner, phase: TrackPhase, now: Instant) -> Self {
        Self {
            planner,
            phase,
            earlier: Vec::new(),
            stats: TrackStats::default(),
            next_update: now,
            is_held_up: false,
            sent: None,
            lost: 0,
            compared: None,
            predicted: None,
            on_path: None,
            off_target: OffTarget::default(),
            unmeasured: None,
            awaits_operator: false,
            recheck: None,
            barrier_is_reported: false,
            commanded: None,
            aim: None,
        }
    }

    pub(super) fn phase(&self) -> TrackPhase {
        self.phase
    }

    /// Returns `true` while the target is up and tracked.
    pub(super) fn follows_now(&self) -> bool {
        self.phase == TrackPhase::Tracking && !self.awaits_operator
    }

    /// Returns the target of the last command while the satellite is not up.
    pub(super) fn aim(&self) -> Option<Pointing> {
        self.aim
    }

    pub(super) fn off_target(&self) -> OffTarget {
        self.off_target
    }

    /// Returns the time of the next update; `None` while another action must end first.
    pub(super) fn due(&self) -> Option<Instant> {
        (!self.is_held_up).then_some(self.next_update)
    }

    /// Returns `true` if the next position is due.
    pub(super) fn is_due(&self, now: Instant) -> bool {
        now >= self.next_update
    }

    /// Sets the time of the next update.
    pub(super) fn look_at(&mut self, time: Instant) {
        self.next_update = time;
    }

    /// Records that a due position must wait for the end of another action.
    pub(super) fn hold_up(&mut self, is_held_up: bool) {
        self.is_held_up = is_held_up;
    }

    /// Enters a phase. Returns the statistics of a pass that has ended.
    pub(super) fn enter(&mut self, phase: TrackPhase) -> Option<TrackStats> {
        let before = std::mem::replace(&mut self.phase, phase);
        if phase == TrackPhase::Tracking {
            self.aim = None;
        }
        if before != TrackPhase::Tracking {
            return None;
        }
        (self.predicted, self.on_path) = (None, None);
        self.off_target = OffTarget::default();
        // The changes and their undo steps belonged to the pass.
        let begins_with = self.planner.track().offsets;
        self.planner.set_offsets(begins_with);
        self.earlier.clear();
        Some(std::mem::take(&mut self.stats))
    }

    /// Records a position that passed the gate. `is_corner`: it leads only round a corner.
    pub(super) fn sent(
        &mut self,
        next: Next,
        aim: Option<Pointing>,
        is_corner: bool,
        now: Instant,
    ) {
        // Check the leg round a corner again until the path is free.
        if !is_corner {
            self.planner.sent(next);
        }
        self.sent = Some(now);
        self.stats.commands += 1;
        self.commanded = aim;
        self.barrier_is_reported &= is_corner;
        // During the pass, Azel compares the antenna with the satellite, not with the last
        // position.
        self.aim = aim.filter(|_| self.phase != TrackPhase::Tracking);
    }

    /// Records a barrier on the path. Returns `true` the first time.
    pub(super) fn block(&mut self, now: Instant) -> bool {
        // The search for a path takes time that other antennas need, too.
        self.next_update = self.next_update.max(now + BLOCKED);
        !std::mem::replace(&mut self.barrier_is_reported, true)
    }

    /// Records a position without an answer or effect. Returns `true` if the track may send another
    /// position.
    pub(super) fn lose(&mut self) -> bool {
        self.lost += 1;
        // The unit may or may not have received the position, so the next position starts from the
        // axes.
        self.planner.forget_sent();
        self.lost < MAX_LOST
    }

    /// Records that the unit accepted a position.
    pub(super) fn is_taken(&mut self) {
        self.lost = 0;
    }

    /// Interrupts the track at the first reading after an outage. Returns the duration of an
    /// earlier outage whose comparison is still pending.
    pub(super) fn interrupt(&mut self) -> Option<Duration> {
        self.planner.forget_sent();
        self.sent = None;
        self.recheck.take().map(|recheck| recheck.lost)
    }

    pub(super) fn recheck(&self) -> Option<Recheck> {
        self.recheck
    }

    pub(super) fn take_recheck(&mut self) -> Option<Recheck> {
        self.recheck.take()
    }

    /// Starts a comparison of the unit with its earlier state.
    pub(super) fn begin_recheck(&mut self, recheck: Recheck) {
        self.recheck = Some(recheck);
    }

    /// Makes the track wait for the operator.
    pub(super) fn await_operator(&mut self) {
        self.awaits_operator = true;
    }

    /// Forgets the target of the last command after a stop on the way.
    pub(super) fn forget_aim(&mut self) {
        self.aim = None;
    }

    /// Resumes the track on the operator's decision.
    pub(super) fn resume(&mut self) {
        self.awaits_operator = false;
        self.recheck = None;
        self.planner.forget_sent();
    }

    /// Returns the offsets before the last change in the pass.
    pub(super) fn last_earlier(&self) -> Option<TrackOffsets> {
        self.earlier.last().copied()
    }

    pub(super) fn drop_last_earlier(&mut self) {
        self.earlier.pop();
    }

    /// Stores the offsets before a change, for undo.
    pub(super) fn remember(&mut self, before: TrackOffsets) {
        if self.earlier.len() >= MAX_UNDO {
            self.earlier.remove(0);
        }
        self.earlier.push(before);
    }

    pub(super) fn view(&self) -> TrackView {
        let target = &self.planner.track().target;
        TrackView {
            name: target.name().into_owned(),
            catalog_number: target.catalog_number(),
            phase: self.phase,
            stats: self.stats,
            awaits_operator: self.awaits_operator,
            next_update: (self.phase != TrackPhase::Over).then_some(self.next_update),
            commanded: self.commanded,
            predicted: self.predicted,
            on_path: self.on_path,
            missing: self.off_target.missing(),
            offsets: self.planner.offsets(),
            can_undo: !self.earlier.is_empty(),
            target_moves: target.moves(),
        }
    }

    /// Returns `true` if the track waits for the operator or for a comparison of the unit.
    pub(super) fn asks(&self) -> bool {
        self.awaits_operator || self.recheck.is_some()
    }

    pub(super) fn name(&self) -> String {
        self.planner.track().target.name().into_owned()
    }

    /// Takes the pointing error and the rates of a measurement, once each. The antenna is on target
    /// within `half_beam`. The antenna is on its path within `on_target`, which includes the error
    /// of the unit's readings.
    pub(super) fn compare(
        &mut self,
        measured: Measured,
        axis_count: usize,
        half_beam: Angle,
        on_target: Angle,
    ) {
        if self.compared.replace(measured.received) == Some(measured.received) {
            return;
        }
        let positions_deg = measured.axes.map(|axis| axis.angle_deg);
        // An RC2000C reports no angle of an axis at a limit.
        let is_known =
            |axis: &Axis| axis.angle_deg.is_some() || axis.plus_limit || axis.minus_limit;
        let is_measured = measured.axes.iter().take(axis_count).all(is_known);
        let began = self.unmeasured.map_or(measured.received, |(began, _)| began);
        self.unmeasured = (!is_measured && !self.asks()).then_some((began, measured.received));
        self.planner.watch(measured.requested, positions_deg);
        let is_up = self.phase == TrackPhase::Tracking;
        let direction = is_up.then(|| self.planner.reachable(measured.time)).flatten();
        self.predicted = direction.map(|direction| Sample { time: measured.time, direction });
        if let Some(error) =
            direction.and_then(|direction| measured.pointing.separation(direction.into()))
        {
            self.stats.take(error);
        }
        // Other events report the reason for a waiting track.
        let is_free = is_up && !self.asks() && !self.barrier_is_reported && direction.is_some();
        if !is_free {
            self.planner.restart_chase();
        }
        let Pointing { azimuth, elevation } = measured.pointing;
        let reported = [azimuth, elevation];
        let compared = is_free
            .then(|| self.planner.compare(measured.time, positions_deg, reported, half_beam));
        self.on_path = compared.flatten();
        let allowed = on_target + self.planner.allowed(measured.time);
        let error = match self.on_path {
            Some(OnPath::Due { deviation: error }) => Some(error).filter(|error| *error > allowed),
            Some(OnPath::OnItsWay { .. }) | None => None,
        };
        self.off_target.take(error, measured.received);
    }

    /// Returns `true` once an axis has had no angle for [`UNMEASURED`].
    pub(super) fn is_blind(&self) -> bool {
        self.unmeasured
            .is_some_and(|(began, last)| last.saturating_duration_since(began) >= UNMEASURED)
    }

    /// Returns the axes without assuming either axis at rest.
    pub(super) fn turning(measured: Option<Measured>) -> [AxisNow; 2] {
        let axes = measured.map(|measured| measured.axes);
        let position_deg = |axis: usize| axes.and_then(|axes| axes.get(axis)?.angle_deg);
        [0, 1].map(|axis| AxisNow { position_deg: position_deg(axis), stands: false })
    }

    /// Returns the axes. An axis stands only if its reading can show the effect of the last
    /// command.
    pub(super) fn axes(&self, measured: Measured, latency: Duration) -> [AxisNow; 2] {
        let shows_it = self.sent.is_none_or(|sent| measured.requested >= sent + latency);
        measured.axes.map(|axis| AxisNow {
            position_deg: axis.angle_deg,
            stands: shows_it && axis.motion == AxisMotion::Still,
        })
    }
}
