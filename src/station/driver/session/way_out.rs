//! Antenna in a forbidden direction: its way out, and its path to the Sun if the operator wants it.

use std::time::Duration;

use super::{Session, program_track::NotFollowed};
use crate::{
    astro::AzEl,
    clock::Moment,
    contract::driver::{Command, Event, Intent, Refusal},
    device::Motion,
    plan::{Barrier, Bounds, ProgramTrack, bounds::Budget},
};

/// Duration of the operator's permission to leave a barrier.
const ALLOWED: Duration = Duration::from_mins(1);
/// Max number of paths to a refuge that Azel tries.
const MAX_REFUGES: usize = 64;

impl Session {
    /// Finds the barrier around the antenna. Ends the permission to leave once the antenna is
    /// outside.
    pub(super) fn watch_place(&mut self, now: Moment) {
        let Some(look) = self.gate.state().measured else { return };
        if !self.observed.place.is_new(&look) {
            return;
        }
        let Some(intervals) = self.gate.intervals() else { return };
        let axis = intervals.unknown();
        if let Some(place) = self.bounds_now().unread().cloned() {
            // Unreadable bounds forbid every place.
            self.observed.place.set(Some(Barrier::Unread(place)), None);
            return;
        }
        let bounds = self.bounds_now().at_time(now.utc).turned_by(self.gate.to_sky());
        let place = intervals.sweep();
        let barrier = match axis {
            // With known angles, only keep-outs and the Sun count: the way up from below the
            // minimum elevation needs no permission.
            None => bounds.may_forbid(place),
            Some(_) => bounds.may_be_inside(place),
        };
        let is_outside = barrier.is_none();
        self.observed.place.set(barrier, axis);
        if is_outside {
            self.gate.permit_exit(None);
        }
    }

    /// Returns the bounds that apply to the current activity.
    pub(super) fn bounds_now(&self) -> &Bounds {
        // Only program track may lead to the Sun.
        let intent = if self.commanded.activity.program().is_some() {
            Intent::Track
        } else {
            Intent::Standby
        };
        self.gate.bounds_in(intent)
    }

    /// Returns the direction of the antenna for the check of its bounds.
    fn direction(&self) -> Option<AzEl> {
        Some(self.gate.bounds().direction(self.gate.axes_deg()?))
    }

    /// Allows manual motions out of the barrier for a minute.
    pub(super) fn allow_way_out(&mut self, now: Moment) {
        self.gate.permit_exit(Some(now.steady + ALLOWED));
    }

    /// Starts program track. The track may lead to the Sun only with the operator's permission.
    pub(super) fn follow_as_agreed(
        &mut self,
        follow: ProgramTrack,
        leads_to_sun: bool,
        now: Moment,
    ) {
        // The planner takes its bounds from the gate, so set the permission before planning.
        let before = self.gate.lift_sun(leads_to_sun);
        let Err(not_followed) = self.follow(follow.clone(), now) else { return };
        // The current track continues with its own permission.
        self.gate.lift_sun(before);
        if let NotFollowed::Waits = not_followed {
            let follow = Box::new(follow);
            self.wait_for_judgement(if leads_to_sun {
                Command::ProgramTrackIntoSun(follow)
            } else {
                Command::ProgramTrack(follow)
            });
        }
    }

    /// Moves the shortest path to a direction that stays clear of the Sun for its time ahead, or to
    /// the park position if that is nearer.
    pub(super) fn move_away(&mut self, now: Moment) {
        let has_elevation = self.setup.can().has_elevation();
        let motion_to = |direction: AzEl| Motion::Position {
            azimuth: Some(direction.azimuth),
            elevation: has_elevation.then_some(direction.elevation),
        };
        let Some(here) = self.direction() else {
            return self.tell(Event::NotSent(Refusal::PositionUnknown));
        };
        let bounds = self.gate.bounds();
        // The antenna must reach the direction, on a path without a corner.
        let way = |direction: AzEl, intent: Intent, budget: &Budget| {
            let motion = self.gate.nearest(motion_to(direction)).ok()?;
            let route = self.gate.route_within(motion, intent, budget, now).ok()?;
            Some((direction, route.second.is_none()))
        };
        let budget = Budget::default();
        // Without an elevation axis, the antenna reaches only its own elevation.
        let is_reached = |direction: &AzEl| {
            has_elevation || (direction.elevation - here.elevation).degrees().abs() < 1e-6
        };
        let refuges = bounds.refuges(here, now.utc).filter(is_reached).take(MAX_REFUGES);
        let refuges = refuges.take_while(|_| !budget.is_spent());
        let mut round_a_corner = None;
        let refuge = refuges
            .filter_map(|refuge| way(refuge, Intent::Position, &budget))
            .find(|(refuge, is_direct)| {
                round_a_corner = round_a_corner.or(Some(*refuge));
                *is_direct
            })
            .map(|(refuge, _)| refuge)
            .or(round_a_corner);
        let park = self.setup.park().direction().filter(|park| {
            let is_nearer =
                refuge.is_none_or(|refuge| here.separation(*park) <= here.separation(refuge));
            is_nearer
                && bounds.stays_clear(*park, now.utc)
                && way(*park, Intent::Park, &Budget::default()).is_some()
        });
        match (park, refuge) {
            (Some(park), _) => self.go_to(motion_to(park), Intent::Park, now),
            (None, Some(refuge)) => self.go_to(motion_to(refuge), Intent::Position, now),
            (None, None) => self.tell(Event::NotSent(Refusal::NoRefuge)),
        }
    }
}
