//! What to command next.

use jiff::Timestamp;

use super::{
    Follow,
    drives::{Drives, SetPoint},
    path::Path,
    target::Course,
};
use crate::{
    astro::{
        AzEl,
        time::{add_seconds, seconds_between},
    },
    orbit::PropagationError,
    station::Following,
};

/// A path is worked out for this long at most, seconds.
const PATH_S: f64 = 3.0 * 3600.0;
/// A path is continued this long before it ends, beyond what a command looks
/// ahead, seconds.
const MARGIN_S: f64 = 60.0;
/// How often the time of arrival is improved.
const ROUNDS: usize = 4;
/// Angles come from decimal degrees: allow for the rounding.
const ROUNDING_DEG: f64 = 1e-9;

/// An axis as it was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisNow {
    /// As the mount counts, degrees; `None` when it is not known.
    pub position_deg: Option<f64>,
    /// It has come to rest since the last command.
    pub stands: bool,
}

/// What to command now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    /// The command.
    pub set_point: SetPoint,
    told_deg: [Option<f64>; 2],
}

/// Plans the commands for one target. Time and positions come in.
#[derive(Debug)]
pub struct Planner {
    follow: Follow,
    course: Course,
    drives: Drives,
    following: Following,
    /// With the end of the pass or stretch that it belongs to.
    path: Option<(Path, Timestamp)>,
    /// What each axis was told last, degrees.
    told_deg: [Option<f64>; 2],
}

/// What one axis should do.
#[derive(Debug, Clone, Copy)]
struct Wish {
    position_deg: f64,
    /// It would be off by too much otherwise.
    is_due: bool,
}

impl Planner {
    /// For `follow`; an error where its elements describe no orbit.
    pub fn new(
        follow: Follow,
        drives: Drives,
        following: Following,
    ) -> Result<Self, PropagationError> {
        let course = Course::new(&follow.target, follow.site)?;
        Ok(Self { follow, course, drives, following, path: None, told_deg: [None; 2] })
    }

    /// What is followed.
    pub fn follow(&self) -> &Follow {
        &self.follow
    }

    /// Where the target stands at `at`; `None` once it has decayed.
    pub fn direction(&self, at: Timestamp) -> Option<AzEl> {
        self.course.direction(at)
    }

    /// Whether the antenna may point as low as `direction`.
    pub fn may_reach(&self, direction: AzEl) -> bool {
        self.drives.may_reach(direction)
    }

    /// What to command at `now` so that the antenna is right when the next look
    /// comes; `None` while what it was told, or where it stands, is good enough.
    /// An error once the target is nowhere any more.
    pub fn look(
        &mut self,
        now: Timestamp,
        axes: [AxisNow; 2],
    ) -> Result<Option<Next>, PropagationError> {
        if !self.has_path(now) {
            let found = self.new_path(now, axes[0].position_deg);
            self.path = Some(found.ok_or(PropagationError::Decayed)?);
        }
        let Some((path, _)) = &self.path else { return Ok(None) };
        let now_s = path.seconds(now);
        let [told_first, told_second] = self.told_deg;
        let first = self.wish(path, 0, now_s, axes[0], told_first);
        let second = self.wish(path, 1, now_s, axes[1], told_second);
        let second_is_due = second.is_due && self.drives.has_elevation;
        if !first.is_due && !second_is_due {
            return Ok(None);
        }
        let positions = [
            self.command(first, first.is_due, axes[0], told_first),
            self.command(second, second_is_due, axes[1], told_second),
        ];
        let told_deg = [positions[0].or(told_first), positions[1].or(told_second)];
        Ok(Some(Next { set_point: self.drives.set_point(positions), told_deg }))
    }

    /// `next` was sent.
    pub fn sent(&mut self, next: Next) {
        self.told_deg = next.told_deg;
    }

    /// It is not known any more what the antenna was told.
    pub fn forget_sent(&mut self) {
        self.told_deg = [None; 2];
    }

    /// Where an axis should go, and whether it is time to say so.
    fn wish(
        &self,
        path: &Path,
        axis: usize,
        now_s: f64,
        state: AxisNow,
        told_deg: Option<f64>,
    ) -> Wish {
        let period_s = self.following.period().as_secs_f64();
        let begins_s = now_s + self.following.latency_s;
        let (band_deg, lead_deg) = self.bands_deg();
        let rate_deg_s = self.drives.limits.maximum_rate_deg_s;
        let mut way_s = 0.0_f64;
        let mut position_deg = 0.0;
        let mut from_s = begins_s;
        for _ in 0..ROUNDS {
            // It turns first and then stands: its mean error over the period is
            // least for where the target is in the middle of both.
            let middle_s = begins_s + way_s.max(f64::midpoint(period_s, way_s));
            from_s = middle_s - period_s / 2.0;
            let wanted_deg = path.swing_end_deg(axis, from_s).unwrap_or_else(|| {
                let (least, most) =
                    path.longest_span_deg(axis, from_s, from_s + period_s, 2.0 * lead_deg);
                f64::midpoint(least, most)
            });
            position_deg = self.drives.tellable_deg(axis, wanted_deg);
            let way_deg = state.position_deg.map_or(0.0, |at| (position_deg - at).abs());
            way_s = way_deg / rate_deg_s;
        }
        let is_new = told_deg.is_none_or(|told| (told - position_deg).abs() > ROUNDING_DEG);
        let stays_deg = state.position_deg.filter(|_| state.stands).or(told_deg);
        let (least, most) = path.span_deg(axis, from_s, from_s + period_s);
        let is_off = stays_deg
            .is_none_or(|at| (at - least).abs().max((at - most).abs()) > band_deg + ROUNDING_DEG);
        Wish { position_deg, is_due: is_new && is_off }
    }

    /// How far off an axis may be before it is told a new position, and how far
    /// ahead of the target it is sent, so that it is as far off on either side.
    fn bands_deg(&self) -> (f64, f64) {
        let dead_band_deg = self.following.dead_band_deg;
        let half_step_deg = self.drives.step_deg / 2.0;
        (dead_band_deg.max(half_step_deg), (dead_band_deg - half_step_deg).max(0.0))
    }

    /// What to tell an axis while at least one of both has to be told something.
    fn command(
        &self,
        wish: Wish,
        is_due: bool,
        state: AxisNow,
        told_deg: Option<f64>,
    ) -> Option<f64> {
        if is_due || !self.drives.takes_single_axes() {
            return Some(wish.position_deg);
        }
        // An axis that stands well is spared; one under way goes on.
        if state.stands { None } else { told_deg.or(Some(wish.position_deg)) }
    }

    fn has_path(&self, now: Timestamp) -> bool {
        let Some((path, ends)) = &self.path else { return false };
        let ahead_s = self.following.latency_s + self.following.period().as_secs_f64() + MARGIN_S;
        let is_over = self.follow.pass(now).is_some() && now >= *ends;
        let goes_on = path.to() < *ends && seconds_between(now, path.to()) < ahead_s;
        !is_over && !goes_on
    }

    fn new_path(&self, now: Timestamp, azimuth_deg: Option<f64>) -> Option<(Path, Timestamp)> {
        let always = (now, Timestamp::MAX);
        let (aos, los) = self.follow.pass(now).unwrap_or(always);
        let from = aos.max(now);
        let to = los.min(add_seconds(from, PATH_S));
        Some((Path::along(&self.course, &self.drives, (from, to), azimuth_deg)?, los))
    }
}

#[cfg(test)]
mod tests;
