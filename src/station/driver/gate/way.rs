//! Check of the path of a motion against the bounds of the antenna.

use super::{Angle, Gate, Intervals, Moment, Motion, Mount, NoRoute, Situation, Sweep};
use crate::{
    astro::{AzEl, xy_mount},
    contract::driver::{Intent, Refusal},
    device::{
        JogSpeeds, aimed,
        panel::{Act, Lead},
    },
    plan::{Barrier, Bounds, BoundsAt, bounds::Budget, detour::AxisLimits, on_board::ALONG_DEG},
};

/// Max share of the fastest rate at which an antenna leaves a barrier. Only a manual motion leaves
/// it, at most at this rate or at the controller's slowest speed.
const OUT_SHARE: f64 = 0.25;
/// Min gain of a way out over the time judged ahead, and max loss on the way, degrees.
const OUT_GAIN_DEG: f64 = 1e-6;
/// Distance between the checked places of a way out, degrees of the axis that turns further. The
/// path between its ends must not lead in deeper.
const LOOK_OUT_DEG: f64 = 0.5;

/// Number of places of a detour that Azel tries first, evenly from its end.
const FIRST_PLACES: usize = 6;

/// Path of a motion to a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) struct Route {
    pub(in crate::driver) first: Motion,
    /// Second motion, after the first has arrived, if the path goes round a corner.
    pub(in crate::driver) second: Option<Motion>,
}

/// Refuses a motion that may lead into a barrier.
pub(super) fn is_clear(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    if let Motion::Position { azimuth, elevation } = *motion {
        return to_position(azimuth, elevation, situation);
    }
    let intervals = situation.intervals.ok_or(Refusal::PositionUnknown)?;
    match *motion {
        Motion::Jog { x_deg_s, y_deg_s } => {
            let rates = situation.actual_rates([x_deg_s, y_deg_s]);
            let ahead_deg = rates.map(|rate| rate * situation.ahead_s);
            check_manual(intervals, ahead_deg, Some(rates), situation)
        }
        Motion::Step { x_deg, y_deg } => check_manual(intervals, [x_deg, y_deg], None, situation),
        // A worker judges the path of the unit's own program.
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => Ok(()),
    }
}

fn to_position(
    azimuth: Option<Angle>,
    elevation: Option<Angle>,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let intervals = situation.intervals.ok_or(Refusal::PositionUnknown)?;
    let start = intervals.sweep();
    let end = target(azimuth, elevation, start, situation).ok_or(Refusal::PositionUnknown)?;
    // The last position may be seconds old. A track sends its next position while the axes turn, so
    // the path begins at any place that they can have reached.
    let covered = situation.gate.extend(start, situation.ahead_s);
    let ways = ways_round(azimuth.is_some(), start.union(end), covered, situation);
    // The unit chooses between these paths, so a barrier on either path refuses the motion.
    for sweep in ways.into_iter().flatten() {
        check_sun_exit(sweep, intervals, end, situation)
            .unwrap_or_else(|| check_sweep(sweep, start, &situation.bounds_now()))?;
    }
    Ok(())
}

/// Returns the possible paths of the azimuth axis: direct, or over north. The axis does not cross
/// its limits, so omits a path across a limit if the other path crosses none. Each path begins at
/// the range `covered`.
pub(super) fn ways_round(
    turns_azimuth: bool,
    counted: Sweep,
    covered: Sweep,
    situation: &Situation<'_>,
) -> [Option<Sweep>; 2] {
    if !turns_azimuth || !situation.state.may_turn_either_way {
        return [Some(counted.union(covered)), None];
    }
    let Sweep([(from_deg, to_deg), second]) = counted;
    let over_north = Sweep([(to_deg, from_deg + 360.0), second]);
    let crosses_limit = |Sweep([(from_deg, to_deg), _]): Sweep| {
        let limits = situation.state.azimuth_limits_deg.into_iter().flatten();
        let mut turns = limits.flat_map(|limit_deg| [limit_deg, limit_deg + 360.0]);
        turns.any(|limit_deg| from_deg < limit_deg && limit_deg < to_deg)
    };
    let crosses = [counted, over_north].map(crosses_limit);
    let Sweep([(begins_deg, _), _]) = covered;
    let turn_deg = if begins_deg <= from_deg { 360.0 } else { 0.0 };
    let counted = counted.union(covered);
    let over_north = over_north.union(covered.turned([turn_deg, 0.0]));
    match crosses {
        [false, true] => [Some(counted), None],
        [true, false] => [Some(over_north), None],
        _ => [Some(counted), Some(over_north)],
    }
}

impl Situation<'_> {
    fn bounds_now(&self) -> BoundsAt<'_> {
        self.evaluate(self.bounds)
    }

    /// Evaluates these bounds at the current time, with the offsets of the axes.
    fn evaluate<'b>(&'b self, bounds: &'b Bounds) -> BoundsAt<'b> {
        bounds.at_time(self.now.utc).turned_by(self.to_sky).with_budget(self.budget)
    }

    /// Returns the true rates of the axes in a jog, because a controller may have only a few named
    /// speeds.
    pub(super) fn actual_rates(&self, asked_deg_s: [f64; 2]) -> [f64; 2] {
        let fastest_deg_s = self.limits.maximum_rate_deg_s;
        asked_deg_s.map(|rate| {
            let named = self.can.jog.nearest(rate, fastest_deg_s);
            let named_deg_s = named.map_or(0.0, |speed| speed.share * fastest_deg_s);
            if rate == 0.0 { 0.0 } else { rate.abs().max(named_deg_s).copysign(rate) }
        })
    }
}

/// Allows a go-to from the surroundings of the Sun that comes no nearer to the Sun and ends
/// outside. Returns `None` if the motion does not start there.
fn check_sun_exit(
    sweep: Sweep,
    start: Intervals,
    end: Sweep,
    situation: &Situation<'_>,
) -> Option<Result<(), Refusal>> {
    let is_sent = matches!(situation.intent, Intent::Position | Intent::Park);
    let leaving = situation
        .bounds
        .away_from_the_sun(start.angles_deg()?, situation.now.utc)
        .filter(|_| is_sent && situation.bounds_now().may_forbid(end).is_none())?;
    Some(check_sweep(sweep, start.sweep(), &situation.evaluate(&leaving)))
}

/// Judges a manual motion, whose end may be unknown: the operator controls it.
fn check_manual(
    intervals: Intervals,
    ahead_deg: [f64; 2],
    rates_deg_s: Option<[f64; 2]>,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let bounds_now = situation.bounds_now();
    let start = intervals.sweep();
    let sweep = start.union(start.turned(ahead_deg));
    if intervals.unknown().is_some() {
        return check_manual_unseen(intervals, ahead_deg, rates_deg_s, situation);
    }
    let clearances = bounds_now.min_clearances(start);
    let violation = clearances.iter().find(|clearance| {
        !clearance.warns_only
            && clearance.barrier != Barrier::MinimumElevation
            && clearance.angle < Angle::ZERO
    });
    let Some(violation) = violation else {
        return check_sweep(sweep, start, &bounds_now);
    };
    // The permission to leave one barrier does not cover another barrier.
    let outside_of = bounds_now.without_entered(start);
    check_sweep(sweep, start, &situation.evaluate(&outside_of))?;
    // Without an elevation axis, only a turn in azimuth leads out.
    let is_left = if situation.can.has_elevation() {
        is_left_on_the_way(start, ahead_deg, &bounds_now)
    } else {
        is_left_by_azimuth(start, ahead_deg, &bounds_now)
    };
    if !is_left {
        let direction = situation.bounds.direction(sweep.middle());
        return Err(Refusal::Forbidden { barrier: violation.barrier.clone(), direction });
    }
    slowly_by_permission(rates_deg_s, Refusal::Inside(violation.barrier.clone()), situation)
}

/// Returns `true` if a motion of both axes from `start` leads out of barriers and nowhere deeper.
fn is_left_on_the_way(start: Sweep, ahead_deg: [f64; 2], bounds: &BoundsAt<'_>) -> bool {
    let here = Depth::new(bounds, start);
    let looks = (ahead_deg[0].abs().max(ahead_deg[1].abs()) / LOOK_OUT_DEG).ceil().max(1.0) as u32;
    let mut was_out = false;
    (1..=looks).all(|look| {
        let share = f64::from(look) / f64::from(looks);
        let depth = Depth::new(bounds, start.turned(ahead_deg.map(|deg| deg * share)));
        // Before its end, the path may follow an edge, or pass a point from which the way out is
        // shorter.
        let gain_deg = if look == looks { OUT_GAIN_DEG } else { -OUT_GAIN_DEG };
        // A gap between two barriers is no way out if the motion continues into the second.
        let enters_again = was_out && !depth.is_out();
        was_out = depth.is_out();
        !enters_again && here.is_left_for(&depth, gain_deg)
    })
}

/// Returns `true` if an antenna without an elevation axis turns out of barriers the shorter way.
fn is_left_by_azimuth(start: Sweep, [ahead_deg, _]: [f64; 2], bounds: &BoundsAt<'_>) -> bool {
    let out_deg = |way: f64| bounds.azimuth_out_deg(start, way);
    let Some(out) = out_deg(ahead_deg) else { return false };
    let is_shorter = out_deg(-ahead_deg).is_none_or(|other| out <= other);
    let past_the_edge = |deg: f64| start.turned([deg.copysign(ahead_deg), 0.0]);
    let sweep = past_the_edge(out).union(past_the_edge(out.max(ahead_deg.abs())));
    is_shorter && bounds.blocks(sweep, start).is_none()
}

/// Judges a manual motion while the angle of an axis is unknown. The motion needs no permission if
/// no barrier blocks it from any possible position.
fn check_manual_unseen(
    intervals: Intervals,
    ahead_deg: [f64; 2],
    rates_deg_s: Option<[f64; 2]>,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let bounds_now = situation.bounds_now();
    let start = intervals.sweep();
    let sweep = start.union(intervals.turn(ahead_deg, situation.mount.travel_deg()));
    let Some((barrier, direction)) = bounds_now.blocks_unseen(sweep, start) else { return Ok(()) };
    // The operator's permission does not override a known elevation below the minimum, nor a
    // barrier that the axes are definitely outside.
    let Intervals([_, second]) = intervals;
    let knows_elevation = matches!(situation.mount, Mount::AzEl { .. }) && second.is_known;
    if knows_elevation && bounds_now.leads_below_the_floor(sweep, start) {
        return Err(Refusal::Forbidden { barrier: Barrier::MinimumElevation, direction });
    }
    let outside_of = bounds_now.without_entered(start);
    check_sweep(sweep, start, &situation.evaluate(&outside_of))?;
    let axis = intervals.unknown().and_then(|axis| situation.can.axes.get(axis));
    let refusal = Refusal::Unchecked { axis: axis.copied().unwrap_or_default(), barrier };
    slowly_by_permission(rates_deg_s, refusal, situation)
}

/// Allows a manual motion on the operator's responsibility, at most at a share of the highest rate;
/// returns `refusal` without that permission.
pub(super) fn slowly_by_permission(
    rates_deg_s: Option<[f64; 2]>,
    refusal: Refusal,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let fastest = rates_deg_s.into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
    // The named speeds of a controller may all exceed this share.
    let slowest_share = match situation.can.jog {
        JogSpeeds::Named(speeds) => speeds.first().map_or(0.0, |slowest| slowest.share),
        JogSpeeds::AnyRate => 0.0,
    };
    let allowed_deg_s = situation.limits.maximum_rate_deg_s * OUT_SHARE.max(slowest_share);
    if fastest > allowed_deg_s {
        return Err(Refusal::TooFast { asked_deg_s: fastest, allowed_deg_s });
    }
    if situation.gate.permits_exit(situation.now) { Ok(()) } else { Err(refusal) }
}

/// Depth of the axes inside barriers.
#[allow(clippy::struct_field_names, reason = "names tell their units")]
struct Depth {
    /// Distance to an allowed position, degrees; `None` if no single axis can get out.
    way_out_deg: Option<f64>,
    /// Depth below the minimum elevation, degrees.
    below_deg: f64,
    /// Depth inside each other barrier, degrees.
    inside_deg: Vec<f64>,
}

impl Depth {
    fn new(bounds: &BoundsAt<'_>, place: Sweep) -> Self {
        let (below_deg, inside_deg) = bounds.depths_deg(place);
        Self { way_out_deg: bounds.way_out_deg(place), below_deg, inside_deg }
    }

    fn is_out(&self) -> bool {
        self.way_out_deg.is_some_and(|deg| deg <= 0.0)
    }

    /// Returns `true` if `next` is shallower by `gain_deg`, or outside of everything, and no lower
    /// below the minimum elevation.
    fn is_left_for(&self, next: &Self, gain_deg: f64) -> bool {
        if next.below_deg > self.below_deg + OUT_GAIN_DEG {
            return false;
        }
        match (self.way_out_deg, next.way_out_deg) {
            (Some(here), Some(next_deg)) => {
                next_deg < here - gain_deg || (here <= 0.0 && next_deg <= 0.0)
            }
            (Some(_), None) => false,
            // No single axis can get out: the edge of the deepest barrier must come nearer, and no
            // other edge may recede.
            (None, _) => {
                let deepest = |depths: &[f64]| depths.iter().copied().fold(0.0, f64::max);
                let mut pairs = self.inside_deg.iter().zip(&next.inside_deg);
                pairs.all(|(here, next_deg)| *next_deg <= here + OUT_GAIN_DEG)
                    && deepest(&next.inside_deg) < deepest(&self.inside_deg) - gain_deg
            }
        }
    }
}

fn check_sweep(sweep: Sweep, start: Sweep, bounds: &BoundsAt<'_>) -> Result<(), Refusal> {
    bounds
        .blocks(sweep, start)
        .map_or(Ok(()), |(barrier, direction)| Err(Refusal::Forbidden { barrier, direction }))
}

/// Returns the possible end positions of the axes after a motion to a position; `None` if unknown.
fn target(
    azimuth: Option<Angle>,
    elevation: Option<Angle>,
    start: Sweep,
    situation: &Situation<'_>,
) -> Option<Sweep> {
    let Sweep([first, second]) = start;
    let end = |angle: Option<Angle>, stays: (f64, f64)| {
        angle.map_or(stays, |angle| (angle.degrees(), angle.degrees()))
    };
    match situation.mount {
        Mount::AzEl { .. } => Some(Sweep([end(azimuth, first), end(elevation, second)])),
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let measured = situation.state.measured.map(|measured| measured.pointing);
            let direction = aimed(azimuth, elevation, measured).direction()?;
            Some(Sweep::at_position(xy_angles_deg(direction, lower_axis_azimuth_deg)))
        }
    }
}

/// Returns the angles of an X/Y mount in the controller's count, with 90 at the zenith.
fn xy_angles_deg(direction: AzEl, lower_axis_azimuth_deg: f64) -> [f64; 2] {
    let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
    let axes = xy_mount::axes_from_azel(direction, lower_axis);
    [axes.lower, axes.upper].map(|angle| angle.degrees() + 90.0)
}

impl Gate {
    /// Returns the path of `motion` to its position: direct, or one axis after the other if both
    /// together may sweep through a barrier.
    pub(in crate::driver) fn route(
        &self,
        motion: Motion,
        intent: Intent,
        now: Moment,
    ) -> Result<Route, NoRoute> {
        self.route_within(motion, intent, &Budget::default(), now)
    }

    /// Does the same as [`Self::route`] for one of many searches that share `budget`.
    pub(in crate::driver) fn route_within(
        &self,
        motion: Motion,
        intent: Intent,
        budget: &Budget,
        now: Moment,
    ) -> Result<Route, NoRoute> {
        let check = |motion| self.check_within(motion, intent, Some(budget), now);
        let refusal = match check(motion) {
            Ok(()) => return Ok(Route { first: motion, second: None }),
            Err(refusal @ Refusal::Forbidden { .. }) => refusal,
            Err(other) => return Err(other.into()),
        };
        let Some((from_deg, to_deg)) = self.ends(motion, now) else { return Err(refusal.into()) };
        let corners_deg = [[to_deg[0], from_deg[1]], [from_deg[0], to_deg[1]]];
        let bounds = self.bounds_in(intent).at_time(now.utc);
        let bounds_now = bounds.turned_by(self.to_sky_in(intent)).with_budget(Some(budget));
        for corner_deg in corners_deg {
            let first = self.to_axes(corner_deg);
            let second = Sweep::new(corner_deg, to_deg);
            let is_free = bounds_now.blocks(second, Sweep::at_position(corner_deg)).is_none()
                && check(first).is_ok();
            if is_free {
                return Ok(Route { first, second: Some(motion) });
            }
        }
        if intent != Intent::Track {
            return Err(refusal.into());
        }
        // A sequence of positions may follow any path.
        let places_deg = self.detour_places_deg(from_deg, to_deg, now)?;
        // The worker searched from an earlier position; the axes and the Sun have moved since.
        let is_reached = |place_deg: &&[f64; 2]| check(self.to_axes(**place_deg)).is_ok();
        // Try a few places first, because each check takes time.
        let step = places_deg.len().div_ceil(FIRST_PLACES).max(1);
        let from_the_end = || places_deg.iter().rev();
        let farthest = from_the_end()
            .step_by(step)
            .chain(from_the_end())
            .take_while(|_| !budget.is_spent())
            .find(is_reached);
        farthest
            .map(|place_deg| Route { first: self.to_axes(*place_deg), second: Some(motion) })
            .ok_or(NoRoute::Refused(refusal))
    }

    /// Returns the range from the read position to the position that the last motion may have
    /// reached within `ahead_s` seconds.
    fn extend(&self, start: Sweep, ahead_s: f64) -> Sweep {
        let gone_deg = self.limits.maximum_rate_deg_s * ahead_s;
        let mut covered = start;
        let axes = covered.0.iter_mut().zip(self.turns).zip(self.to_deg);
        // An axis that no motion of Azel turns stays at its last reading.
        for (((from_deg, to_deg), _), end_deg) in axes.filter(|((_, turns), _)| *turns) {
            let ends_deg = end_deg.map_or((f64::NEG_INFINITY, f64::INFINITY), |deg| (deg, deg));
            let lowest_deg = ends_deg.0.max(*from_deg - gone_deg);
            let highest_deg = ends_deg.1.min(*to_deg + gone_deg);
            (*from_deg, *to_deg) = (from_deg.min(lowest_deg), to_deg.max(highest_deg));
        }
        covered
    }

    pub(super) fn axis_limits(&self) -> AxisLimits {
        let mut travel_deg = self.mount.travel_deg();
        if let Mount::AzEl { .. } = self.mount {
            travel_deg[1].0 = travel_deg[1].0.max(self.limits.minimum_elevation_deg);
        }
        let can = self.variant.capabilities;
        let rests_within_deg = can.position_step_deg + can.arrives_within_deg;
        AxisLimits::new(travel_deg, [self.limits.maximum_rate_deg_s; 2], rests_within_deg)
    }

    /// Returns the axis angles after turning by `ahead_deg`, but at most to the target of a motion.
    pub(in crate::driver) fn turn_ahead(
        &self,
        axes_deg: [f64; 2],
        ahead_deg: [f64; 2],
    ) -> [f64; 2] {
        let mut reached = [axes_deg[0] + ahead_deg[0], axes_deg[1] + ahead_deg[1]];
        let overrun_deg = self.variant.capabilities.arrives_within_deg * 2.0;
        for ((reached, from_deg), to_deg) in reached.iter_mut().zip(axes_deg).zip(self.to_deg) {
            let Some(to_deg) = to_deg else { continue };
            let passes =
                (from_deg..=*reached).contains(&to_deg) || (*reached..=from_deg).contains(&to_deg);
            if passes {
                *reached = to_deg;
            } else if (from_deg - to_deg).abs() <= overrun_deg {
                // The axis comes to rest around its target position.
                *reached = from_deg;
            }
        }
        reached
    }

    /// Returns the axis angles before and after a motion to a position.
    pub(super) fn ends(&self, motion: Motion, now: Moment) -> Option<([f64; 2], [f64; 2])> {
        let Motion::Position { azimuth, elevation } = self.controller.as_sent(motion) else {
            return None;
        };
        let situation = self.situation(Intent::Position, false, now);
        let start = situation.intervals.filter(|_| situation.can.has_elevation())?;
        let from_deg = start.angles_deg()?;
        let Sweep([(first_deg, _), (second_deg, _)]) =
            target(azimuth, elevation, start.sweep(), &situation)?;
        Some((from_deg, [first_deg, second_deg]))
    }

    /// Returns the angle of each axis after a motion to a position. An axis with a target ends
    /// there, also from its limit, where it has no angle.
    pub(super) fn end_angles(&self, motion: Motion, now: Moment) -> [Option<f64>; 2] {
        match self.controller.as_sent(motion) {
            Motion::Position { azimuth, elevation } if matches!(self.mount, Mount::AzEl { .. }) => {
                let stands = self.state().measured.map(|measured| measured.axes);
                let stands_deg = |axis: usize| stands.and_then(|axes| axes.get(axis)?.angle_deg);
                let degrees = |angle: Option<Angle>| angle.map(Angle::degrees);
                [degrees(azimuth).or(stands_deg(0)), degrees(elevation).or(stands_deg(1))]
            }
            _ => self.ends(motion, now).map_or([None; 2], |(_, to_deg)| to_deg.map(Some)),
        }
    }

    fn to_axes(&self, axes_deg: [f64; 2]) -> Motion {
        let [azimuth, elevation] = match self.mount {
            Mount::AzEl { .. } => axes_deg.map(Angle::from_degrees),
            Mount::Xy { .. } => {
                let AzEl { azimuth, elevation } = self.bounds.direction(axes_deg);
                [azimuth, elevation]
            }
        };
        Motion::Position { azimuth: Some(azimuth), elevation: Some(elevation) }
    }

    /// Refuses a blocked path to `direction` that the unit takes at its own rates. The unit keeps
    /// to its own minimum elevation at the end, but not between: if both axes of an X/Y mount turn,
    /// the antenna may dip.
    pub(super) fn slew_is_clear(&self, direction: AzEl, now: Moment) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Track, false, now);
        let start = situation.intervals.ok_or(Refusal::PositionUnknown)?.sweep();
        let end = target(Some(direction.azimuth), Some(direction.elevation), start, &situation)
            .ok_or(Refusal::PositionUnknown)?;
        let along = Angle::from_degrees(ALONG_DEG);
        let bounds = situation.evaluate(&self.bounds).with_floor_lower_by(along);
        check_sweep(start.union(end), start, &bounds)
    }

    /// Returns the lead of an action as a motion to a position; `None` without a lead to a
    /// position, an error for an unknown lead.
    pub(super) fn lead_motion(&self, act: &Act) -> Result<Option<Motion>, Refusal> {
        let Lead::To(to_deg) = self.controller.lead_of(act) else { return Ok(None) };
        let [first, second] = to_deg;
        if let Mount::AzEl { .. } = self.mount {
            let [azimuth, elevation] = to_deg.map(|deg| deg.map(Angle::from_degrees));
            return Ok(Some(Motion::Position { azimuth, elevation }));
        }
        let [first_stays, second_stays] =
            self.intervals().and_then(Intervals::angles_deg).ok_or(Refusal::PositionUnknown)?;
        let axes_deg = [first.unwrap_or(first_stays), second.unwrap_or(second_stays)];
        Ok(Some(self.to_axes(axes_deg)))
    }

    /// Returns the known angles of the axes at the end of an action.
    pub(super) fn action_end(&self, act: &Act) -> [Option<f64>; 2] {
        match self.controller.lead_of(act) {
            Lead::To(to_deg) => to_deg,
            Lead::Nowhere | Lead::Unseen(_) | Lead::Unknown(_) => [None; 2],
        }
    }
}
