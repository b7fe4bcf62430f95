//! Compares measured positions with the bounds of the antenna, whoever drives it.

use std::{collections::VecDeque, time::Duration};

use super::Session;
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    contract::driver::{Event, Mover, Response, Safety, StoppingWay},
    device::{Axis, AxisMotion, Drive, Measured},
    driver::gate::{Interval, Intervals},
    plan::{Barrier, Clearance, Sweep},
};

/// Rates are taken between positions no further apart than this.
const SPAN: Duration = Duration::from_secs(5);
/// Rates are taken between positions at least this far apart: one step of a unit that counts whole
/// degrees would be a great rate between two that follow at once.
const APART: Duration = Duration::from_millis(150);
/// An antenna that dips below its minimum elevation by no more than this, beyond its pointing
/// tolerance, is left alone: a program ends there, and readings are rounded.
const DIP_DEG: f64 = 0.5;
/// Lower rates are those of a standing antenna, degrees a second.
const SLOWEST_DEG_S: f64 = 0.02;
/// Angles that differ by less are equal, degrees.
const ROUNDING_DEG: f64 = 1e-6;
/// A shorter way out is lost in the noise of the readings, degrees.
const NOISE_DEG: f64 = 0.02;

/// Values that were measured and reported last.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Watch {
    /// When the position that was judged last came in.
    looked: Option<Instant>,
    /// The later of the two positions that the rates were taken between.
    last: Option<Measured>,
    /// The last angle of each axis, degrees, and when it was asked for.
    angles: [Option<(f64, Instant)>; 2],
    /// Where readings of each axis may be without a motion.
    rests: [Rest; 2],
    /// Rates of the axes between the last two positions, degrees a second.
    rates_deg_s: [f64; 2],
    /// Barriers that were reported and have not been left since.
    told: Vec<Barrier>,
}

/// Readings of an axis that may stand.
///
/// A reading that swings within this range is rounding, noise or sway. A reading beyond an end drags the
/// range along, so that an axis that goes on leaves it with each reading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Rest {
    /// Distance from the last reading to the lower and to the upper end, degrees.
    below_deg: f64,
    above_deg: f64,
}

impl Rest {
    /// Takes a reading that differs by `turned_deg` from the last one. Returns `true` if it is not within
    /// a range of `width_deg` with those before.
    fn leave(&mut self, turned_deg: f64, width_deg: f64) -> bool {
        let below_deg = (self.below_deg + turned_deg).max(0.0);
        let above_deg = (self.above_deg - turned_deg).max(0.0);
        self.below_deg = below_deg.min(width_deg);
        self.above_deg = above_deg.min(width_deg);
        below_deg + above_deg > width_deg + ROUNDING_DEG
    }
}

/// Returns `true` if the drive is on in the direction of this rate.
fn is_driven(axis: Axis, rate_deg_s: f64) -> bool {
    match axis.drive {
        Drive::Off => false,
        Drive::On | Drive::Jogged | Drive::Runaway => match axis.motion {
            AxisMotion::Plus => rate_deg_s > 0.0,
            AxisMotion::Minus => rate_deg_s < 0.0,
            AxisMotion::Still | AxisMotion::Unknown(_) => true,
        },
    }
}

/// How certain it is that the antenna is inside a barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Certainty {
    /// Both angles are known.
    Known,
    /// It is inside at every possible angle.
    Inside,
    Unknown,
}

/// Rate since an angle before readings without one, degrees a second.
fn bridged_rate_deg_s(turned_deg: f64, now: Instant, asked: Instant) -> f64 {
    let span = now.saturating_duration_since(asked);
    if span.is_zero() || span > SPAN {
        return 0.0;
    }
    Angle::from_degrees(turned_deg).wrapped_180().degrees() / span.as_secs_f64()
}

fn is_at_limit(axis: Axis) -> bool {
    axis.plus_limit != axis.minus_limit
}

impl Session {
    /// Checks whether the antenna enters, or is inside, a forbidden zone.
    pub(super) fn watch_bounds(&mut self, now: Moment) {
        let Some(look) = self.gate.state().measured else { return };
        let is_old = self.seen.watch.looked.replace(look.received) == Some(look.received);
        if is_old || self.contact.is_unread() {
            return;
        }
        let Some(intervals) = self.gate.intervals() else { return };
        let here = intervals.sweep();
        let rates = self.rates(&look, intervals);
        let turns_unseen = self.turns_unseen(&look, intervals);
        let is_moving = rates.iter().any(|rate| rate.abs() > SLOWEST_DEG_S) || turns_unseen;
        let ahead_s = self.gate.ahead_s(now);
        let there = self.reached(intervals, rates, turns_unseen, ahead_s);
        let bounds = self.bounds_now().at(now.utc).turned_by(self.gate.to_sky());
        let [from, to] = [here, there].map(|place| bounds.least_clearances(place));
        let is_known = intervals.unknown().is_none();
        // An unknown angle is inside a barrier only if it is so wherever the axis may be.
        let surely = (!is_known).then(|| bounds.holds_all_of(here));
        // From anywhere in a range the search would hold up the other antennas of this thread.
        let way_deg = |place| is_known.then(|| bounds.way_out_deg(place)).flatten();
        let ways_deg = [here, there].map(way_deg);
        for (index, (from, to)) in from.into_iter().zip(to).enumerate() {
            // Where no single axis leads out, the depth inside each barrier counts.
            let deeper_deg = match ways_deg {
                [Some(here_deg), Some(there_deg)] => there_deg - here_deg,
                _ => from.angle.degrees() - to.angle.degrees(),
            };
            let goes_deeper = is_moving && deeper_deg > NOISE_DEG;
            let certainty = match &surely {
                None => Certainty::Known,
                Some(surely) if surely.get(index) == Some(&true) => Certainty::Inside,
                Some(_) => Certainty::Unknown,
            };
            self.judge(from, &to, certainty, is_moving, goes_deeper, now);
        }
    }

    /// Rates of the axes, degrees a second. One that reports no angle for a moment keeps its last
    /// rate. One whose drive is off, or on in the other direction, turns only once it has left the range
    /// in which a standing axis is read.
    fn rates(&mut self, look: &Measured, intervals: Intervals) -> [f64; 2] {
        let before = self.seen.watch.last;
        if before.is_some_and(|before| span(&before, look) < APART) {
            return self.seen.watch.rates_deg_s;
        }
        self.seen.watch.last = Some(*look);
        let mut rates = before.map_or([0.0; 2], |before| rates_deg_s(&before, look));
        let width_deg = self.alarm_figures().rest_width_deg();
        let Watch { rates_deg_s: last_rates, angles, rests, .. } = &mut self.seen.watch;
        let last = last_rates.iter().zip(angles).zip(rests).zip(intervals.0);
        for ((rate, axis), (((last_rate, last), rest), interval)) in
            rates.iter_mut().zip(look.axes).zip(last)
        {
            let Some(angle_deg) = axis.angle_deg else {
                if interval.is_known && !is_at_limit(axis) {
                    *rate = *last_rate;
                }
                continue;
            };
            let Some((last_deg, asked)) = last.replace((angle_deg, look.asked)) else { continue };
            let bridged = before.is_some_and(|before| before.asked < look.asked);
            if bridged && *rate == 0.0 {
                *rate = bridged_rate_deg_s(angle_deg - last_deg, look.asked, asked);
            }
            let turned_deg = Angle::from_degrees(angle_deg - last_deg).wrapped_180().degrees();
            let has_left = rest.leave(turned_deg, width_deg);
            if !has_left && !is_driven(axis, *rate) {
                *rate = 0.0;
            }
        }
        // A second axis other than elevation does not belong to the antenna.
        let [first, second] = rates;
        let rates = [first, if self.setup.can().has_elevation() { second } else { 0.0 }];
        self.seen.watch.rates_deg_s = rates;
        rates
    }

    /// Returns `true` if an axis whose angle is unknown may turn.
    fn turns_unseen(&self, look: &Measured, intervals: Intervals) -> bool {
        let is_ours = self.mover() == Mover::Azel;
        let axes = look.axes.iter().zip(intervals.0).zip(self.gate.turns());
        let mut unknown = axes.filter(|((_, interval), _)| !interval.is_known);
        unknown.any(|((axis, _), is_turned)| {
            axis.motion != AxisMotion::Still || (is_ours && is_turned)
        })
    }

    /// Where the axes may be after `ahead_s` seconds at these rates.
    fn reached(
        &self,
        intervals: Intervals,
        rates: [f64; 2],
        turns_unseen: bool,
        ahead_s: f64,
    ) -> Sweep {
        let ahead_deg = rates.map(|rate| rate * ahead_s);
        if let Some(axes_deg) = intervals.angles_deg() {
            let Sweep([first, second]) = Sweep::at(self.gate.ahead_of(axes_deg, ahead_deg));
            let has_elevation = self.setup.can().has_elevation();
            let Sweep([_, column]) = intervals.sweep();
            return Sweep([first, if has_elevation { second } else { column }]);
        }
        let here = intervals.sweep().turned(ahead_deg);
        let unseen_deg =
            if turns_unseen { self.setup.track_config().fastest_deg_s() * ahead_s } else { 0.0 };
        let widen = |(from, to): (f64, f64), axis: Interval| {
            if axis.is_known { (from, to) } else { (from - unseen_deg, to + unseen_deg) }
        };
        let (Sweep([first, second]), Intervals([first_axis, second_axis])) = (here, intervals);
        Sweep([widen(first, first_axis), widen(second, second_axis)])
    }

    fn judge(
        &mut self,
        here: Clearance,
        there: &Clearance,
        certainty: Certainty,
        is_moving: bool,
        goes_deeper: bool,
        now: Moment,
    ) {
        let arrives_within_deg = self.setup.can().arrives_within_deg;
        let is_floor = here.barrier == Barrier::MinimumElevation;
        let dip_deg = if is_floor { DIP_DEG + arrives_within_deg } else { 0.0 };
        let (here_deg, there_deg) =
            (here.angle.degrees() + dip_deg, there.angle.degrees() + dip_deg);
        let driver = self.mover();
        let is_inside = match certainty {
            Certainty::Known => here_deg < 0.0,
            Certainty::Inside => true,
            // Where it may be inside already, the gate alone forbids or permits.
            Certainty::Unknown if here_deg < 0.0 => return,
            Certainty::Unknown => false,
        };
        // A program slows down where its pass begins; the readings show whether it does.
        let ends_there = driver == Mover::Program && here.barrier == Barrier::MinimumElevation;
        let enters = is_moving && !is_inside && there_deg < 0.0 && !ends_there;
        let goes_deeper = is_inside && goes_deeper;
        let is_told = self.seen.watch.told.contains(&here.barrier);
        if !is_inside && !enters {
            self.seen.watch.told.retain(|barrier| *barrier != here.barrier);
            return;
        }
        // Azel always stops its own requests, including on-board tracks: it started them, so the
        // station's setting for other people's motions does not apply.
        let is_requested =
            driver == Mover::Azel || (self.commanded.activity.on_board().is_some() && !is_floor);
        let stops = (enters || goes_deeper)
            && !here.warns_only
            && (is_requested || self.setup.stops_others());
        if stops && !self.stop.is_under_way() {
            self.halt(now);
        } else if is_told {
            return;
        }
        if !is_told {
            self.seen.watch.told.push(here.barrier.clone());
        }
        let response = if stops { Response::Stopped } else { Response::Reported };
        self.tell(Event::Safety(Safety::Forbidden { barrier: here.barrier, driver, response }));
    }

    fn mover(&self) -> Mover {
        let program = self.gate.state().program;
        self.commanded.mover(program.is_some_and(|program| program.enabled))
    }
}

/// Longest time between two measurements. The reply to a repeated question may have been measured
/// at any time since the first.
fn span(before: &Measured, after: &Measured) -> Duration {
    let asked = after.asked.saturating_duration_since(before.asked);
    asked.max(after.received.saturating_duration_since(before.received))
}

/// Rates of the axes, degrees a second; zero between positions that cannot be compared.
fn rates_deg_s(before: &Measured, after: &Measured) -> [f64; 2] {
    let span = span(before, after);
    if span.is_zero() || span > SPAN {
        return [0.0; 2];
    }
    let angles = before.axes.iter().zip(&after.axes);
    let mut rates = [0.0; 2];
    for (rate, (before, after)) in rates.iter_mut().zip(angles) {
        let turned = before.angle_deg.zip(after.angle_deg).map_or(0.0, |(a, b)| b - a);
        *rate = Angle::from_degrees(turned).wrapped_180().degrees() / span.as_secs_f64();
    }
    rates
}

/// Measured overrun: how long the axes turn on after a STOP.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Overrun {
    /// The position before the STOP, the rate then, and when STOP went out.
    before: Option<(Measured, [f64; 2], Instant)>,
    /// The last ones, seconds.
    seen_s: VecDeque<f64>,
    /// Number of STOPs measured in all.
    stops: u32,
}

/// Number of STOPs that replace the default.
const ENOUGH: usize = StoppingWay::ENOUGH as usize;
/// Azel learns the overrun from jogs at this share of the fastest rate or more. The overrun of
/// slower ones is lost in the noise of the readings.
const TELLING_SHARE: f64 = 0.5;

impl Overrun {
    /// A STOP goes out.
    pub(super) fn begin(&mut self, before: Option<(Measured, [f64; 2])>, now: Instant) {
        self.before = before.map(|(look, rates)| (look, rates, now));
    }

    /// The axes stand. Returns the longest overrun of the last STOPs, seconds, once enough
    /// were measured. It counts as that from the fastest rate, because drives that brake
    /// evenly turn on for longer the faster they are.
    pub(super) fn end(&mut self, rest: &Measured, fastest_deg_s: f64) -> Option<f64> {
        let (before, rates, stop) = self.before.take()?;
        let to_stop_s = stop.saturating_duration_since(before.asked).as_secs_f64();
        let axes = before.axes.iter().zip(&rest.axes).zip(rates);
        let overrun_s = axes
            .filter(|(_, rate)| rate.abs() >= fastest_deg_s * TELLING_SHARE)
            .filter_map(|((before, rest), rate)| {
                let turned_deg = rest.angle_deg? - before.angle_deg?;
                let overrun_s = turned_deg / rate - to_stop_s;
                Some(overrun_s * (fastest_deg_s / rate.abs()).max(1.0))
            })
            .max_by(f64::total_cmp)?;
        if self.seen_s.len() >= ENOUGH {
            self.seen_s.pop_front();
        }
        self.seen_s.push_back(overrun_s.clamp(0.0, 10.0));
        self.stops = self.stops.saturating_add(1);
        let worst_s = self.seen_s.iter().copied().fold(0.0, f64::max);
        (self.seen_s.len() >= ENOUGH).then_some(worst_s)
    }
}

impl Session {
    /// Remembers how fast the axes turn when a STOP goes out.
    pub(super) fn begin_overrun(&mut self, now: Moment) {
        let look = self.gate.state().measured;
        let rates = self.rates_now();
        self.seen.overrun.begin(look.zip(rates), now.steady);
    }

    fn rates_now(&self) -> Option<[f64; 2]> {
        // Other motions may be slowing down already.
        self.commanded.key.started().map(|_| self.seen.watch.rates_deg_s)
    }

    /// The overrun, as far as it is known.
    pub(super) fn stopping_way(&self) -> StoppingWay {
        let Overrun { stops, seen_s, .. } = &self.seen.overrun;
        StoppingWay {
            overrun_s: self.gate.overrun_s(),
            stops: *stops,
            is_learned: seen_s.len() >= ENOUGH,
        }
    }

    /// Learns from a STOP that has ended.
    pub(super) fn end_overrun(&mut self) {
        let Some(rest) = self.gate.state().measured else { return };
        let fastest_deg_s = self.setup.track_config().fastest_deg_s();
        if let Some(overrun_s) = self.seen.overrun.end(&rest, fastest_deg_s) {
            self.gate.set_overrun(overrun_s);
        }
    }
}
