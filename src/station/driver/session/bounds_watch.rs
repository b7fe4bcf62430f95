//! Check of measured positions against the bounds of the antenna, for any operator.

use super::Session;
use crate::{
    clock::Moment,
    contract::driver::{Event, Mover, Response, Safety},
    device::{AxisMotion, Measured},
    driver::gate::{Interval, Intervals},
    plan::{Barrier, Clearance, Sweep},
};

/// Max tolerated dip below the minimum elevation, beyond the pointing tolerance, degrees: a program
/// ends there, and units round their readings.
const DIP_DEG: f64 = 0.5;
/// Min rate of a moving antenna, degrees a second.
const SLOWEST_DEG_S: f64 = 0.02;
/// Min length of a way out that exceeds the noise of the readings, degrees.
const NOISE_DEG: f64 = 0.02;

/// Certainty that the antenna is inside a barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum InsideCertainty {
    /// Certainty from two known angles.
    Known,
    /// Position inside at every possible angle.
    Inside,
    Unknown,
}

impl Session {
    /// Checks whether the antenna enters, or is inside, a forbidden zone.
    pub(super) fn watch_bounds(&mut self, now: Moment) {
        let Some(look) = self.gate.state().measured else { return };
        if !self.observed.monitor.is_new(&look) || self.contact.is_unread() {
            return;
        }
        let Some(intervals) = self.gate.intervals() else { return };
        let here = intervals.sweep();
        let (has_elevation, width_deg) =
            (self.setup.can().has_elevation(), self.alarm_figures().rest_width_deg());
        let rates = self.observed.monitor.rates(&look, intervals, has_elevation, width_deg);
        let turns_unseen = self.turns_unseen(&look, intervals);
        let is_moving = rates.iter().any(|rate| rate.abs() > SLOWEST_DEG_S) || turns_unseen;
        let ahead_s = self.gate.ahead_s(now);
        let next = self.reach(intervals, rates, turns_unseen, ahead_s);
        let bounds = self.bounds_now().at_time(now.utc).turned_by(self.gate.to_sky());
        let [starts, ends] = [here, next].map(|place| bounds.min_clearances(place));
        let is_known = intervals.unknown().is_none();
        // A position with an unknown angle is surely inside a barrier only if it is inside at every
        // possible angle.
        let surely = (!is_known).then(|| bounds.holds_all_of(here));
        // A search from every place in a range would delay the other antennas of this thread.
        let way_deg = |place| is_known.then(|| bounds.way_out_deg(place)).flatten();
        let ways_deg = [here, next].map(way_deg);
        for (index, (here, next)) in starts.into_iter().zip(ends).enumerate() {
            // If no single axis leads out, compare the depths inside each barrier.
            let deeper_deg = match ways_deg {
                [Some(here_deg), Some(next_deg)] => next_deg - here_deg,
                _ => here.angle.degrees() - next.angle.degrees(),
            };
            let goes_deeper = is_moving && deeper_deg > NOISE_DEG;
            let certainty = match &surely {
                None => InsideCertainty::Known,
                Some(surely) if surely.get(index) == Some(&true) => InsideCertainty::Inside,
                Some(_) => InsideCertainty::Unknown,
            };
            self.judge(here, &next, certainty, is_moving, goes_deeper, now);
        }
    }

    /// Returns `true` if an axis whose angle is unknown may turn.
    fn turns_unseen(&self, look: &Measured, intervals: Intervals) -> bool {
        let is_ours = self.mover() == Mover::Azel;
        let axes = look.axes.iter().zip(intervals.0).zip(self.gate.turning_axes());
        let mut unknown = axes.filter(|((_, interval), _)| !interval.is_known);
        unknown.any(|((axis, _), is_turned)| {
            axis.motion != AxisMotion::Still || (is_ours && is_turned)
        })
    }

    /// Returns the possible positions of the axes after `ahead_s` seconds at these rates.
    fn reach(
        &self,
        intervals: Intervals,
        rates: [f64; 2],
        turns_unseen: bool,
        ahead_s: f64,
    ) -> Sweep {
        let ahead_deg = rates.map(|rate| rate * ahead_s);
        if let Some(axes_deg) = intervals.angles_deg() {
            let Sweep([first, second]) =
                Sweep::at_position(self.gate.turn_ahead(axes_deg, ahead_deg));
            let has_elevation = self.setup.can().has_elevation();
            let Sweep([_, column]) = intervals.sweep();
            return Sweep([first, if has_elevation { second } else { column }]);
        }
        let here = intervals.sweep().turned(ahead_deg);
        let unseen_deg =
            if turns_unseen { self.setup.track_config().fastest_deg_s() * ahead_s } else { 0.0 };
        let widen = |(min, max): (f64, f64), axis: Interval| {
            if axis.is_known { (min, max) } else { (min - unseen_deg, max + unseen_deg) }
        };
        let (Sweep([first, second]), Intervals([first_axis, second_axis])) = (here, intervals);
        Sweep([widen(first, first_axis), widen(second, second_axis)])
    }

    fn judge(
        &mut self,
        here: Clearance,
        next: &Clearance,
        certainty: InsideCertainty,
        is_moving: bool,
        goes_deeper: bool,
        now: Moment,
    ) {
        let arrives_within_deg = self.setup.can().arrives_within_deg;
        let is_floor = here.barrier == Barrier::MinimumElevation;
        let dip_deg = if is_floor { DIP_DEG + arrives_within_deg } else { 0.0 };
        let (here_deg, next_deg) = (here.angle.degrees() + dip_deg, next.angle.degrees() + dip_deg);
        let driver = self.mover();
        let is_inside = match certainty {
            InsideCertainty::Known => here_deg < 0.0,
            InsideCertainty::Inside => true,
            // If the antenna may be inside already, only the gate forbids or permits.
            InsideCertainty::Unknown if here_deg < 0.0 => return,
            InsideCertainty::Unknown => false,
        };
        // A program slows down at the start of its pass; the readings show whether it does.
        let ends_there = driver == Mover::Program && here.barrier == Barrier::MinimumElevation;
        let enters = is_moving && !is_inside && next_deg < 0.0 && !ends_there;
        let goes_deeper = is_inside && goes_deeper;
        let is_reported = self.observed.monitor.is_reported(&here.barrier);
        if !is_inside && !enters {
            self.observed.monitor.leave(&here.barrier);
            return;
        }
        // Azel always stops its own motions, including on-board tracks. The station's setting
        // applies only to motions of other people.
        let is_requested =
            driver == Mover::Azel || (self.commanded.activity.on_board().is_some() && !is_floor);
        let stops = (enters || goes_deeper)
            && !here.warns_only
            && (is_requested || self.setup.stops_others());
        if stops && !self.stop.is_under_way() {
            self.halt(now);
        } else if is_reported {
            return;
        }
        if !is_reported {
            self.observed.monitor.report(here.barrier.clone());
        }
        let response = if stops { Response::Stopped } else { Response::Reported };
        self.tell(Event::Safety(Safety::Forbidden { barrier: here.barrier, driver, response }));
    }

    fn mover(&self) -> Mover {
        let program = self.gate.state().program;
        self.commanded.mover(program.is_some_and(|program| program.enabled))
    }
}
