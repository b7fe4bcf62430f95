//! Planner of position commands.

use glam::DQuat;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    ProgramTrack,
    axis::{AxisNow, LastCommand, TrackedAxis},
    chase::Chase,
    drives::{Drives, SetPoint},
    path::Path,
    target::Course,
};
use crate::{
    astro::{
        Angle, AzEl, PointingModel, TrackOffsets,
        time::{add_seconds, seconds_between},
    },
    clock::Instant,
    orbit::PropagationError,
    plan::{
        Bounds,
        az_el::{Flip, FlipChoice, Start},
    },
    station::TrackSettings,
};

/// Max duration of a path, seconds.
const PATH_S: f64 = 3.0 * 3600.0;
/// Approach to the path, degrees within this time, seconds, that proves an antenna on its way: its
/// drives may be slower than known.
const COMES_NEARER_DEG: f64 = 1.25;
const COMES_NEARER_S: f64 = 5.0;
/// Interval between predictions of an arrival, seconds.
const PREDICTED_EVERY_S: f64 = 5.0;
/// Time shifts at which an antenna still counts as on its path, seconds.
const SHOWN_LATE_S: [f64; 5] = [-1.0, 0.0, 1.0, 2.0, 3.0];
/// Time before its end at which a path is extended, beyond the look-ahead of a command, seconds.
const MARGIN_S: f64 = 60.0;

/// Order of a path for a target, with all values on which the path depends.
#[derive(Debug, Clone)]
pub struct PathOrder {
    track: ProgramTrack,
    course: Course,
    offsets: TrackOffsets,
    drives: Drives,
    bounds: Bounds,
    begin: Timestamp,
    end: Timestamp,
    /// End of the pass.
    ends: Timestamp,
    start: Start,
    choice: FlipChoice,
}

impl PathOrder {
    /// Returns `true` if the path may need detours, whose search takes long.
    pub fn may_detour(&self) -> bool {
        self.bounds.has_way_round()
    }

    /// Plans the path. A path with detours takes up to a tenth of a second.
    pub fn plan(self) -> PlannedPath {
        let path = Path::along(
            (&self.course, self.offsets),
            &self.drives,
            &self.bounds,
            (self.begin, self.end),
            self.start,
            self.choice,
        );
        PlannedPath { order: self, path }
    }
}

/// Answer to a [`PathOrder`].
#[derive(Debug, Clone)]
pub struct PlannedPath {
    order: PathOrder,
    /// Planned path; `None` if the target has decayed.
    path: Option<Path>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    pub set_point: SetPoint,
    last_command: [LastCommand; 2],
}

/// Comparison of a measured direction with the planned path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum OnPath {
    /// Antenna that cannot have reached the path yet, or path that leaves the target, like in an
    /// unwrap. `arrival` is the predicted arrival on target; `None` without a prediction.
    OnItsWay {
        #[serde(rename = "until")]
        arrival: Option<Timestamp>,
    },
    /// Antenna that should be on its path but is off by this angle.
    Due {
        #[serde(rename = "off")]
        deviation: Angle,
    },
}

/// Progress of an antenna that is off its path.
#[derive(Debug, Clone, Copy, Default)]
struct Approach {
    /// Error to compare later errors with, degrees, and its time.
    anchor: Option<(f64, Timestamp)>,
    progress_at: Option<Timestamp>,
}

impl Approach {
    /// Takes an error. Returns `true` while the antenna makes progress: its drives may be slower
    /// than known.
    fn comes_nearer(&mut self, off_deg: f64, time: Timestamp) -> bool {
        let is_recent =
            |start: &Timestamp| (0.0..=COMES_NEARER_S).contains(&seconds_between(*start, time));
        let (from_deg, begin) = *self.anchor.get_or_insert((off_deg, time));
        let has_progressed = from_deg - off_deg >= COMES_NEARER_DEG;
        if has_progressed {
            self.progress_at = Some(time);
        }
        // Advance the anchor, so that only recent progress counts.
        if has_progressed || off_deg > from_deg || !is_recent(&begin) {
            self.anchor = Some((off_deg, time));
        }
        self.progress_at.as_ref().is_some_and(is_recent)
    }
}

/// Planner of the commands for one target.
#[derive(Debug)]
pub struct Planner {
    track: ProgramTrack,
    course: Course,
    offsets: TrackOffsets,
    drives: Drives,
    settings: TrackSettings,
    bounds: Bounds,
    /// Path, and the end of its pass.
    path: Option<(Path, Timestamp)>,
    /// `true` if the path was planned within other bounds or with other offsets; its flip still
    /// applies.
    is_stale: bool,
    chase: Option<Chase>,
    approach: Approach,
    /// Predicted arrival, and the time of the prediction.
    arrival: Option<(Option<Timestamp>, Timestamp)>,
    axes: [TrackedAxis; 2],
}

impl Planner {
    /// Creates a planner whose paths lead round the keep-outs of `bounds`. Fails if the elements do
    /// not describe an orbit.
    pub fn new(
        track: ProgramTrack,
        drives: Drives,
        settings: TrackSettings,
        bounds: Bounds,
    ) -> Result<Self, PropagationError> {
        let course = Course::new(&track.target, track.site)?;
        let axes = [0, 1].map(|index| TrackedAxis::new(index, drives, settings));
        let offsets = track.offsets;
        Ok(Self {
            track,
            course,
            offsets,
            drives,
            settings,
            bounds,
            path: None,
            is_stale: false,
            chase: None,
            approach: Approach::default(),
            arrival: None,
            axes,
        })
    }

    /// Sets the pointing model of the antenna.
    #[must_use]
    pub fn with_model(self, model: PointingModel) -> Self {
        Self { course: self.course.with_model(model), ..self }
    }

    /// Sets the offsets with which the next passes begin.
    pub fn begin_with(&mut self, offsets: TrackOffsets) {
        self.track.offsets = offsets;
    }

    pub fn offsets(&self) -> TrackOffsets {
        self.offsets
    }

    pub fn set_offsets(&mut self, offsets: TrackOffsets) {
        if offsets != self.offsets {
            self.offsets = offsets;
            self.is_stale = true;
        }
    }

    pub fn keep_within(&mut self, bounds: Bounds) {
        if bounds != self.bounds {
            self.bounds = bounds;
            self.is_stale = true;
        }
    }

    pub fn track(&self) -> &ProgramTrack {
        &self.track
    }

    /// Returns the readings that the axes need at `time` with these offsets; `None` once the target
    /// has decayed.
    pub fn demanded(&self, time: Timestamp, offsets: TrackOffsets) -> Option<AzEl> {
        self.course.demanded(time, offsets)
    }

    /// Returns the direction on the sky at `time` with these offsets; `None` once the target has
    /// decayed.
    pub fn on_the_sky(&self, time: Timestamp, offsets: TrackOffsets) -> Option<AzEl> {
        self.course.on_the_sky(time, offsets)
    }

    /// Returns the rotation from the modelled beam direction with these offsets at `time` to the
    /// true one on the sky. Returns `None` unless axis offsets correct further errors of the mount.
    pub fn to_sky(&self, time: Timestamp, offsets: TrackOffsets) -> Option<DQuat> {
        if offsets.on_the_sky() == offsets {
            return None;
        }
        let beam = self.course.beam(self.demanded(time, offsets)?);
        let sky = self.on_the_sky(time, offsets)?;
        Some(DQuat::from_rotation_arc(beam.to_enu(), sky.to_enu()))
    }

    /// Returns the readings that the axes need at `time`, offsets included, unless the elevation is
    /// below the minimum or the target has decayed.
    pub fn reachable(&self, time: Timestamp) -> Option<AzEl> {
        self.demanded(time, self.offsets).filter(|direction| self.drives.may_reach(*direction))
    }

    /// Returns the command at `now` that brings the antenna onto the target by the next update.
    /// Returns `None` while the last command or the current position is good enough. Fails once the
    /// target has decayed.
    pub fn update(
        &mut self,
        now: Timestamp,
        axes: [AxisNow; 2],
    ) -> Result<Option<Next>, PropagationError> {
        let [first_now, second_now] = axes;
        // A worker plans paths with detours. Other paths are fast enough to plan here.
        if let Some(order) = self.path_order(now, axes) {
            self.take_path(order.plan())?;
        }
        let Some((path, _)) = &self.path else { return Ok(None) };
        let now_s = path.seconds(now);
        let [first, second] = &mut self.axes;
        first.learn(first_now);
        second.learn(second_now);
        let first_demand = first.demand(path, now_s, first_now);
        let second_demand = second.demand(path, now_s, second_now);
        let second_is_due = second_demand.is_due && self.drives.has_elevation;
        if !first_demand.is_due && !second_is_due {
            return Ok(None);
        }
        let first_deg = first.command(first_demand, first_now);
        let second_deg = second.command(second_demand, second_now);
        Ok(Some(Next {
            set_point: self.drives.set_point([first_deg, second_deg]),
            last_command: [
                first.commanded(first_deg, first_now),
                second.commanded(second_deg, second_now),
            ],
        }))
    }

    /// Takes measured positions, degrees as the mount counts, and learns the rates of the axes from
    /// long slews. `instant` comes from the steady clock, because UTC may be corrected in the
    /// middle of a slew.
    pub fn watch(&mut self, instant: Instant, positions_deg: [Option<f64>; 2]) {
        let axes = self.axes.iter_mut().zip(positions_deg).zip(&mut self.drives.rates_deg_s);
        for ((axis, position_deg), rate_deg_s) in axes {
            if let Some(found_deg_s) = axis.watch(instant, position_deg) {
                tracing::info!(found_deg_s, before_deg_s = *rate_deg_s, "rate of an axis");
                *rate_deg_s = found_deg_s;
            }
        }
        for axis in &mut self.axes {
            // Both axes need both rates, because either axis can delay the path.
            axis.drives = self.drives;
        }
    }

    /// Compares the reported direction with the planned path. Uses the axes only for the start of
    /// the motion, because the station may not describe their geometry. The target counts as met
    /// within `half_beam`. Returns `None` without a path, or for an unknown angle.
    pub fn compare(
        &mut self,
        time: Timestamp,
        positions_deg: [Option<f64>; 2],
        reported: [Option<Angle>; 2],
        half_beam: Angle,
    ) -> Option<OnPath> {
        let Some((path, _)) = &self.path else {
            self.chase = None;
            return None;
        };
        // Without an elevation axis, the error in elevation is zero.
        let [_, elevation_deg] = path.positions_deg(time);
        let [first, second] = positions_deg;
        let second = if self.drives.has_elevation { second } else { Some(elevation_deg) };
        let Some(measured_deg) = first.zip(second) else {
            self.chase = None;
            return None;
        };
        let measured_deg = <[f64; 2]>::from(measured_deg);
        let rates_deg_s = self.drives.rates_deg_s;
        let chase = Chase::advanced(self.chase, path, rates_deg_s, (time, measured_deg));
        self.chase = Some(chase);
        let mount = self.drives.mount;
        let separation = |one_deg, other: AzEl| mount.direction(one_deg).separation(other);
        let is_met = |utc, axes_deg| {
            let target = self.demanded(utc, self.offsets);
            target.is_some_and(|target| separation(axes_deg, target) <= half_beam)
        };
        if !chase.has_arrived(path) || !is_met(time, path.positions_deg(time)) {
            // A prediction takes hundreds of propagations.
            let is_recent = |(_, at_then): &(Option<Timestamp>, Timestamp)| {
                (0.0..PREDICTED_EVERY_S).contains(&seconds_between(*at_then, time))
            };
            let recent = self.arrival.filter(is_recent);
            let (arrival, _) =
                recent.unwrap_or_else(|| (chase.reaches(path, rates_deg_s, is_met), time));
            self.arrival = recent.or(Some((arrival, time)));
            return Some(OnPath::OnItsWay { arrival });
        }
        self.arrival = None;
        let [azimuth, elevation] = reported;
        let on_path = mount.direction(path.positions_deg(time));
        let elevation = if self.drives.has_elevation { elevation } else { Some(on_path.elevation) };
        let measured = AzEl { azimuth: azimuth?, elevation: elevation? };
        let off_deg = SHOWN_LATE_S.map(|late_s| {
            let on_path = path.positions_deg(add_seconds(time, -late_s));
            separation(on_path, measured).degrees()
        });
        // A unit may report an outdated position; assume the age that fits best.
        let off_deg = off_deg.into_iter().fold(f64::INFINITY, f64::min);
        if self.approach.comes_nearer(off_deg, time) {
            return Some(OnPath::OnItsWay { arrival: None });
        }
        Some(OnPath::Due { deviation: Angle::from_degrees(off_deg) })
    }

    /// Returns the max error that the settings of program track allow at `time`.
    pub fn allowed(&self, time: Timestamp) -> Angle {
        let Some((path, _)) = &self.path else { return Angle::ZERO };
        let period_s = self.settings.period().as_secs_f64() + self.settings.latency_s;
        let [now, later] = [0.0, period_s]
            .map(|s| self.drives.mount.direction(path.positions_deg(add_seconds(time, s))));
        let bands_deg = self.axes.iter().map(TrackedAxis::band_deg).fold(0.0, f64::hypot);
        // The antenna may lag by one period, and each axis may rest anywhere in its band.
        now.separation(later) + Angle::from_degrees(bands_deg)
    }

    /// Restarts the chase at the next measurement, because the antenna was not free to follow the
    /// path.
    pub fn restart_chase(&mut self) {
        (self.chase, self.arrival) = (None, None);
        self.approach = Approach::default();
    }

    /// Returns the known rates of the axes, degrees per second.
    pub fn rates_deg_s(&self) -> [f64; 2] {
        self.drives.rates_deg_s
    }

    /// Records that `next` was sent.
    pub fn sent(&mut self, next: Next) {
        for (axis, last_command) in self.axes.iter_mut().zip(next.last_command) {
            axis.last_command = last_command;
        }
    }

    /// Forgets the last command, because it may no longer hold.
    pub fn forget_sent(&mut self) {
        self.forget_sent_of([true; 2]);
    }

    /// Does the same as [`Self::forget_sent`] for the chosen axes.
    pub fn forget_sent_of(&mut self, chosen: [bool; 2]) {
        for (axis, _) in self.axes.iter_mut().zip(chosen).filter(|(_, is_chosen)| *is_chosen) {
            axis.last_command = LastCommand::default();
        }
    }

    fn has_path(&self, now: Timestamp) -> bool {
        let is_for = |(path, _): &(Path, Timestamp)| path.is_for(self.drives.rates_deg_s);
        !self.is_stale && self.path.as_ref().is_some_and(is_for) && self.reaches_on(now)
    }

    /// Returns `true` if the path extends far enough ahead.
    fn reaches_on(&self, now: Timestamp) -> bool {
        let Some((path, ends)) = &self.path else { return false };
        let ahead_s = self.settings.latency_s + self.settings.period().as_secs_f64() + MARGIN_S;
        // The planner plans a very long pass in pieces; the next piece must be ready in time.
        let is_short = path.end() < *ends && seconds_between(now, path.end()) < ahead_s;
        now < *ends && !is_short
    }

    /// Returns the flip for a new path. A path planned again for other rates keeps its flip once
    /// the pass has begun. Before the pass, another flip must be clearly better, so that the
    /// antenna does not go back and forth.
    fn choice(&self, now: Timestamp) -> FlipChoice {
        match self.path.as_ref().filter(|_| self.reaches_on(now)) {
            Some((path, _)) if self.is_under_way(now) => FlipChoice::Keep(path.flip()),
            Some((path, _)) => FlipChoice::Prefer(path.flip()),
            None => FlipChoice::Prefer(Flip::None),
        }
    }

    /// Returns `true` once the axes follow a path. A new path then begins at their positions;
    /// before, one command takes them to the beginning of the path.
    fn is_under_way(&self, now: Timestamp) -> bool {
        self.path.as_ref().is_some_and(|(path, _)| path.seconds(now) >= 0.0)
    }

    /// Returns the order of the path that the next command needs; `None` while a path is available.
    pub fn path_order(&self, now: Timestamp, axes: [AxisNow; 2]) -> Option<PathOrder> {
        if self.has_path(now) {
            return None;
        }
        let always = (now, Timestamp::MAX);
        let (aos, los) = self.track.pass(now).unwrap_or(always);
        let begin = aos.max(now);
        let axes_deg = axes.map(|axis| axis.position_deg);
        Some(PathOrder {
            track: self.track.clone(),
            course: self.course.clone(),
            offsets: self.offsets,
            drives: self.drives,
            bounds: self.bounds.clone(),
            begin,
            end: los.min(add_seconds(begin, PATH_S)),
            ends: los,
            start: Start {
                axes_deg,
                lead_s: seconds_between(now, begin),
                // Set this only under way: otherwise the approach to a current pass would go in
                // steps.
                sets_out: self.is_under_way(now),
            },
            choice: self.choice(now),
        })
    }

    /// Takes a path that this planner ordered, or another planner for the same track. Ignores the
    /// path if the order has changed since. Fails if the target has decayed.
    pub fn take_path(&mut self, planned: PlannedPath) -> Result<(), PropagationError> {
        let PlannedPath { order, path } = planned;
        // The offsets or bounds may have changed while a worker was planning. This check skips the
        // rates: `has_path` orders again after a large change of them.
        let is_up_to_date = order.track == self.track
            && order.course.model == self.course.model
            && order.offsets == self.offsets
            && order.drives.mount == self.drives.mount
            && order.bounds == self.bounds;
        if is_up_to_date {
            self.path = Some((path.ok_or(PropagationError::Decayed)?, order.ends));
            self.is_stale = false;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
