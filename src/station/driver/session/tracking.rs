//! A target of program track, and how well it is tracked.

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

/// A track ends once an axis has had no angle for this long.
const UNMEASURED: Duration = Duration::from_secs(10);

/// Maximum number of commands in a row without an answer and without effect.
const MAX_LOST: u32 = 3;
/// Interval between looks while a barrier is in the way.
const BLOCKED: Duration = Duration::from_secs(2);
/// Number of changes that can be undone.
const MAX_UNDO: usize = 100;

/// Settings of program track.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackConfig {
    pub(super) drives: Drives,
    pub(super) settings: station::TrackSettings,
    pub(super) model: PointingModel,
}

impl TrackConfig {
    /// Rates of both axes as learned, or as set.
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

    /// The operator's limit, degrees a second.
    pub(super) fn fastest_deg_s(&self) -> f64 {
        self.drives.limits.maximum_rate_deg_s
    }
}

pub(super) struct Tracking {
    pub(super) planner: Planner,
    phase: TrackPhase,
    /// Offsets before each change of the pass, the oldest first.
    earlier: Vec<TrackOffsets>,
    stats: TrackStats,
    next_update: Instant,
    /// A position is due, but something else must end first, which then brings it.
    is_held_up: bool,
    /// When the last command went to the gate.
    sent: Option<Instant>,
    /// Number of commands in a row that were lost.
    lost: u32,
    /// When the position that was compared last came in.
    compared: Option<Instant>,
    predicted: Option<Sample>,
    /// The last measurement against the planned path; `None` before the pass.
    on_path: Option<OnPath>,
    off_target: OffTarget,
    /// Start and latest in an unbroken series of readings without the angle of an axis off its limits.
    unmeasured: Option<(Instant, Instant)>,
    /// Waits for the operator.
    awaits_operator: bool,
    /// The unit must still prove to be as before.
    recheck: Option<Recheck>,
    /// The barrier in the way was reported.
    barrier_is_reported: bool,
    /// Where the last command leads.
    commanded: Option<Pointing>,
    /// The same, while the target is not up.
    aim: Option<Pointing>,
}

impl Tracking {
    /// Nothing has been sent yet; the first look is due now.
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

    /// Where the last command leads, while the target is not up.
    pub(super) fn aim(&self) -> Option<Pointing> {
        self.aim
    }

    pub(super) fn off_target(&self) -> OffTarget {
        self.off_target
    }

    /// When the clock calls for the next look; `None` while something else must end first.
    pub(super) fn due(&self) -> Option<Instant> {
        (!self.is_held_up).then_some(self.next_update)
    }

    /// Returns `true` if the next position is due.
    pub(super) fn is_due(&self, now: Instant) -> bool {
        now >= self.next_update
    }

    /// The next look is at this time.
    pub(super) fn look_at(&mut self, time: Instant) {
        self.next_update = time;
    }

    /// Notes whether a position that is due must wait for something else to end.
    pub(super) fn hold_up(&mut self, is_held_up: bool) {
        self.is_held_up = is_held_up;
    }

    /// Enters a phase. Returns the figures of the pass that is over.
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
        // They were for the pass.
        let begins_with = self.planner.track().offsets;
        self.planner.set_offsets(begins_with);
        self.earlier.clear();
        Some(std::mem::take(&mut self.stats))
    }

    /// The gate has let a position pass. `is_corner`: it leads round a corner only.
    pub(super) fn sent(
        &mut self,
        next: Next,
        aim: Option<Pointing>,
        is_corner: bool,
        now: Instant,
    ) {
        // The leg round a corner is looked at again until the way is free.
        if !is_corner {
            self.planner.sent(next);
        }
        self.sent = Some(now);
        self.stats.commands += 1;
        self.commanded = aim;
        self.barrier_is_reported &= is_corner;
        // During the pass the target is compared with itself, not with the last position.
        self.aim = aim.filter(|_| self.phase != TrackPhase::Tracking);
    }

    /// A barrier is in the way. Returns `true` the first time.
    pub(super) fn block(&mut self, now: Instant) -> bool {
        // Looking for a way takes time that other antennas need, too.
        self.next_update = self.next_update.max(now + BLOCKED);
        !std::mem::replace(&mut self.barrier_is_reported, true)
    }

    /// A position was not answered and had no effect. Returns `true` if another may be sent.
    pub(super) fn lose(&mut self) -> bool {
        self.lost += 1;
        // Nothing tells whether the unit took the position, so the next one starts from the axes.
        self.planner.forget_sent();
        self.lost < MAX_LOST
    }

    /// The unit accepted a position.
    pub(super) fn is_taken(&mut self) {
        self.lost = 0;
    }

    /// The unit is read again after an outage. Returns how long it was out of reach before, if
    /// the comparison after that is still pending.
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

    /// The unit must prove to be as before.
    pub(super) fn begin_recheck(&mut self, recheck: Recheck) {
        self.recheck = Some(recheck);
    }

    /// Waits for the operator from now on.
    pub(super) fn await_operator(&mut self) {
        self.awaits_operator = true;
    }

    /// The track was stopped on its way.
    pub(super) fn forget_aim(&mut self) {
        self.aim = None;
    }

    /// The operator lets it go on.
    pub(super) fn resume(&mut self) {
        self.awaits_operator = false;
        self.recheck = None;
        self.planner.forget_sent();
    }

    /// Offsets before the last change of the pass.
    pub(super) fn last_earlier(&self) -> Option<TrackOffsets> {
        self.earlier.last().copied()
    }

    pub(super) fn drop_last_earlier(&mut self) {
        self.earlier.pop();
    }

    /// Keeps the offsets before a change, for undo.
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

    /// It goes on only by the word of the operator, or once the unit has proved to be as before.
    pub(super) fn asks(&self) -> bool {
        self.awaits_operator || self.recheck.is_some()
    }

    pub(super) fn name(&self) -> String {
        self.planner.track().target.name().into_owned()
    }

    /// Takes the pointing error and the rates of a measurement, once each.
    /// The antenna is on target within `half_beam`. It is on its path within `on_target`, which includes
    /// the error of the unit's readings.
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
        if let Some(off) =
            direction.and_then(|direction| measured.pointing.separation(direction.into()))
        {
            self.stats.take(off);
        }
        // Other events report why the track waits.
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
        let off = match self.on_path {
            Some(OnPath::Due { deviation: off }) => Some(off).filter(|off| *off > allowed),
            Some(OnPath::OnItsWay { .. }) | None => None,
        };
        self.off_target.take(off, measured.received);
    }

    /// Returns `true` once an axis has had no angle for [`UNMEASURED`].
    pub(super) fn is_blind(&self) -> bool {
        self.unmeasured.is_some_and(|(began, at)| at.saturating_duration_since(began) >= UNMEASURED)
    }

    /// The axes, of which none is taken for at rest.
    pub(super) fn turning(measured: Option<Measured>) -> [AxisNow; 2] {
        let axes = measured.map(|measured| measured.axes);
        let position_deg = |axis: usize| axes.and_then(|axes| axes.get(axis)?.angle_deg);
        [0, 1].map(|axis| AxisNow { position_deg: position_deg(axis), stands: false })
    }

    /// The axes, as far as they show the effect of the last command.
    pub(super) fn axes(&self, measured: Measured, latency: Duration) -> [AxisNow; 2] {
        let shows_it = self.sent.is_none_or(|sent| measured.requested >= sent + latency);
        measured.axes.map(|axis| AxisNow {
            position_deg: axis.angle_deg,
            stands: shows_it && axis.motion == AxisMotion::Still,
        })
    }
}
