//! Planned pointing of the antennas at any time of the schedule.

use jiff::Timestamp;

use super::Model;
use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::{antenna::AntennaModel, passes::PassListKey},
    device::Pointing,
    plan::schedule::{Entry, Reach, between_passes, parks_within_s, sets_out},
    station::BetweenPasses,
};

/// Planned activity of an antenna, and its pointing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    pub doing: PlannedActivity,
    pub pointing: Pointing,
}

/// Planned activity of an antenna at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlannedActivity {
    Tracks(PassListKey),
    SlewsTo(PassListKey),
    /// Waiting at the start position of this pass.
    WaitsFor(PassListKey),
    /// Standing at the end position of the last pass, or at the current position.
    Stays,
    SlewsToPark,
    Parked,
}

/// A motion of the axes, degrees in the mount's scale.
#[derive(Debug, Clone, Copy)]
struct Slew {
    start: Timestamp,
    seconds: f64,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
}

impl Slew {
    /// Returns the position of the axes, degrees. Both axes move from the start to the end of the
    /// slew.
    fn axes_deg(self, time: Timestamp) -> [f64; 2] {
        let share = (seconds_between(self.start, time) / self.seconds.max(1e-3)).clamp(0.0, 1.0);
        let [a, b] = self.from_deg;
        let [c, d] = self.to_deg;
        [a + (c - a) * share, b + (d - b) * share]
    }

    fn has_begun(self, time: Timestamp) -> bool {
        time >= self.start
    }

    fn is_over(self, time: Timestamp) -> bool {
        seconds_between(self.start, time) >= self.seconds
    }
}

fn key(entry: &Entry) -> PassListKey {
    (entry.pass.satellite, entry.pass.aos)
}

impl Model {
    /// Returns the end of the schedule if it lies in the future.
    pub fn schedule_until(&self) -> Option<Timestamp> {
        self.schedule.end.filter(|end| *end > self.now)
    }

    /// Returns the planned activity and pointing of an antenna at `time`. `None` for an antenna
    /// without passes or with an unknown position.
    pub fn pose_at(&self, antenna: &AntennaModel, time: Timestamp) -> Option<Pose> {
        let id = antenna.id();
        let entries =
            || self.schedule.schedule.entries.iter().filter(|current| current.antenna == id);
        entries().next()?;
        let reach = Reach::from_station(&self.station, &antenna.config, None);
        if let Some(entry) = entries().find(|entry| entry.start <= time && time < entry.end) {
            return self.tracks(&reach, entry, time);
        }
        let before = entries().rfind(|entry| entry.end <= time);
        let next = entries().find(|entry| entry.start > time);
        let measured = antenna.snapshot.state.measured;
        let has_elevation = antenna.variant().capabilities.has_elevation();
        let stands_deg = match before {
            Some(entry) => Some(entry.axes_deg[1]),
            None => measured.and_then(|measured| measured.axes_deg(has_elevation)),
        };
        let (doing, axes_deg) =
            self.between_passes(antenna, &reach, (before, next), stands_deg, time);
        let pointing = if doing == PlannedActivity::Stays && before.is_none() {
            measured?.pointing
        } else {
            reach.pointing(axes_deg?)
        };
        Some(Pose { doing, pointing })
    }

    fn tracks(&self, reach: &Reach, entry: &Entry, time: Timestamp) -> Option<Pose> {
        let satellite = self.pass_lists.satellite(entry.pass.satellite)?;
        let look = satellite.propagator.look_from(self.station.site, time).ok()?;
        // The plan has no elevation for a mount without an elevation axis.
        let has_elevation = reach.pointing(entry.axes_deg[0]).elevation.is_some();
        let elevation = Some(look.direction.elevation).filter(|_| has_elevation);
        let pointing = Pointing { azimuth: Some(look.direction.azimuth), elevation };
        Some(Pose { doing: PlannedActivity::Tracks(key(entry)), pointing })
    }

    /// Returns the activity of the antenna between two entries, and the position of its axes if
    /// that is known. `stands_deg` is the initial position of the axes.
    fn between_passes(
        &self,
        antenna: &AntennaModel,
        reach: &Reach,
        (before, next): (Option<&Entry>, Option<&Entry>),
        stands_deg: Option<[f64; 2]>,
        time: Timestamp,
    ) -> (PlannedActivity, Option<[f64; 2]>) {
        let start = before.map_or(self.now, |entry| entry.end);
        let policy = between_passes(&self.station, &antenna.config, start);
        let goes_at = next.map(|next| sets_out(next, policy).max(start));
        let left_s = goes_at.map_or(f64::INFINITY, |time| seconds_between(start, time));
        // Before its first pass the antenna keeps its position, because parking is not announced.
        let parks = policy == BetweenPasses::Park
            && before.is_some()
            && antenna.can_park()
            && reach.can_park(start)
            && left_s > parks_within_s(&antenna.config);
        let park = stands_deg.filter(|_| parks).map(|stands_deg| {
            let to_deg = reach.park_deg();
            let seconds = reach.straight_s(stands_deg, to_deg);
            Slew { start, seconds, from_deg: stands_deg, to_deg }
        });
        let rest_deg = park.map(|park| park.to_deg).or(stands_deg);
        if let (Some(next), Some(goes_at)) = (next, goes_at) {
            let to_deg = next.axes_deg[0];
            let from_deg = rest_deg.unwrap_or(to_deg);
            let seconds = match park {
                Some(_) => reach.straight_s(from_deg, to_deg),
                None => next.slew_s,
            };
            let begin = add_seconds(goes_at, next.set_up_s);
            let slew = Slew { start: begin, seconds, from_deg, to_deg };
            if slew.is_over(time) {
                return (PlannedActivity::WaitsFor(key(next)), Some(to_deg));
            }
            if slew.has_begun(time) {
                return (PlannedActivity::SlewsTo(key(next)), Some(slew.axes_deg(time)));
            }
        }
        match park {
            Some(park) if park.is_over(time) => (PlannedActivity::Parked, Some(park.to_deg)),
            Some(park) => (PlannedActivity::SlewsToPark, Some(park.axes_deg(time))),
            None => (PlannedActivity::Stays, stands_deg),
        }
    }
}
