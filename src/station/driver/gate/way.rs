//! Checks the way of a motion against the bounds of the antenna.

use super::{Angle, Gate, Intent, Moment, Motion, Mount, Refusal, Situation, Sweep};
use crate::{
    astro::{AzEl, xy_mount},
    device::{
        JogSpeeds, aimed,
        panel::{Act, Lead},
    },
    plan::{
        Barrier, BoundsAt,
        detour::{self, AxisLimits},
        on_board::ALONG_DEG,
    },
};

/// An antenna leaves a barrier only by hand, at no more than this share of the fastest rate,
/// or at the controller's slowest speed.
const OUT_SHARE: f64 = 0.25;
/// Minimum gain of a way out over the time for which it is judged ahead, and maximum loss on
/// the way, degrees.
const OUT_GAIN_DEG: f64 = 1e-6;
/// Distance between the places at which a way out is checked, lest it leads in deeper between
/// its ends: degrees of the axis that turns further.
const LOOK_OUT_DEG: f64 = 0.5;

/// Distance between two places of a detour that are tried as the next position, degrees.
const DETOUR_STEP_DEG: f64 = 4.0;

/// The way of a motion to a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) struct Route {
    pub(in crate::driver) first: Motion,
    /// The motion after the first has arrived, where the way goes round a corner.
    pub(in crate::driver) then: Option<Motion>,
}

/// Refuses a motion that may lead into a barrier.
pub(super) fn is_clear(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    if let Motion::Position { azimuth, elevation } = *motion {
        return to_position(azimuth, elevation, situation);
    }
    let Some(axes_deg) = axes(situation) else { return Ok(()) };
    match *motion {
        Motion::Jog { x_deg_s, y_deg_s } => {
            let rates = situation.turning([x_deg_s, y_deg_s]);
            let ahead_deg = rates.map(|rate| rate * situation.ahead_s);
            by_hand(axes_deg, ahead_deg, Some(rates), situation)
        }
        Motion::Step { x_deg, y_deg } => by_hand(axes_deg, [x_deg, y_deg], None, situation),
        // The way of the unit's own program is judged elsewhere.
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => Ok(()),
    }
}

/// An axis without an angle, such as one at its limit, may come from anywhere in its travel.
fn to_position(
    azimuth: Option<Angle>,
    elevation: Option<Angle>,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    if let Some(axes_deg) = axes(situation) {
        let Some(to_deg) = target(azimuth, elevation, axes_deg, situation) else {
            return Ok(());
        };
        let sweep = sweep_between(axes_deg, to_deg, situation);
        on_the_sky(sweep, axes_deg, situation)?;
        return away_from_the_sun(sweep, axes_deg, to_deg, situation)
            .unwrap_or_else(|| blocked(sweep, axes_deg, &situation.bounds_now()));
    }
    let Some(measured) = situation.state.measured else { return Ok(()) };
    let [first, second] = [0, 1].map(|axis| {
        let angle_deg = measured.axes.get(axis).and_then(|axis| axis.angle_deg);
        let whole = situation.mount.travel_deg().get(axis).copied();
        angle_deg.map(|deg| (deg, deg)).or(whole).unwrap_or_default()
    });
    let lowest_deg = [first.0, second.0];
    let Some(to_deg) = target(azimuth, elevation, lowest_deg, situation) else { return Ok(()) };
    let reach = |(from, to): (f64, f64), end: f64| (from.min(end), to.max(end));
    let second = if situation.can.has_elevation() { reach(second, to_deg[1]) } else { (0.0, 90.0) };
    let sweep = Sweep([reach(first, to_deg[0]), second]);
    on_the_sky(sweep, to_deg, situation)?;
    // The end is judged by its reach; the start may be below the floor.
    blocked(sweep, to_deg, &situation.bounds_now().above_the_floor())
}

impl Situation<'_> {
    fn bounds_now(&self) -> BoundsAt<'_> {
        self.bounds.at(self.now.utc)
    }

    /// The rates at which the axes really turn in a jog: a controller with named speeds has no
    /// others.
    pub(super) fn turning(&self, asked_deg_s: [f64; 2]) -> [f64; 2] {
        let fastest_deg_s = self.limits.maximum_rate_deg_s;
        asked_deg_s.map(|rate| {
            let named = self.can.jog.nearest(rate, fastest_deg_s);
            let named_deg_s = named.map_or(0.0, |speed| speed.share * fastest_deg_s);
            if rate == 0.0 { 0.0 } else { rate.abs().max(named_deg_s).copysign(rate) }
        })
    }
}

/// Refuses a way of the axes during which the antenna may point into a barrier on the sky, if its
/// axes point elsewhere than they count.
fn on_the_sky(sweep: Sweep, from_deg: [f64; 2], situation: &Situation<'_>) -> Result<(), Refusal> {
    let Some(to_sky) = situation.to_sky else { return Ok(()) };
    blocked(sweep, from_deg, &situation.bounds_now().on_the_sky(to_sky))
}

/// The operator may leave the surroundings of the Sun by a go-to that comes no nearer to it
/// and ends outside. `None` where the motion does not start there.
fn away_from_the_sun(
    sweep: Sweep,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
    situation: &Situation<'_>,
) -> Option<Result<(), Refusal>> {
    let (bounds, utc) = (situation.bounds, situation.now.utc);
    let is_sent = matches!(situation.intent, Intent::Position | Intent::Park);
    let leaving = bounds
        .away_from_the_sun(bounds.direction(from_deg), utc)
        .filter(|_| is_sent && bounds.at(utc).forbids(bounds.direction(to_deg)).is_none())?;
    Some(blocked(sweep, from_deg, &leaving.at(utc)))
}

fn by_hand(
    axes_deg: [f64; 2],
    ahead_deg: [f64; 2],
    rates_deg_s: Option<[f64; 2]>,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let (bounds, bounds_now) = (situation.bounds, situation.bounds_now());
    let at = |share: f64| [axes_deg[0] + ahead_deg[0] * share, axes_deg[1] + ahead_deg[1] * share];
    let sweep = sweep_between(axes_deg, at(1.0), situation);
    let clearances = bounds_now.clearances(bounds.direction(axes_deg));
    let inside = clearances.iter().find(|clearance| {
        !clearance.warns_only
            && clearance.barrier != Barrier::MinimumElevation
            && clearance.angle < Angle::ZERO
    });
    let Some(inside) = inside else {
        return blocked(sweep, axes_deg, &bounds_now);
    };
    let outside_of = bounds_now.without_entered(axes_deg);
    blocked(sweep, axes_deg, &outside_of.at(situation.now.utc))?;
    let here = Depth::of(&bounds_now, axes_deg);
    let looks = (ahead_deg[0].abs().max(ahead_deg[1].abs()) / LOOK_OUT_DEG).ceil().max(1.0) as u32;
    let mut was_out = false;
    for look in 1..=looks {
        let to_deg = at(f64::from(look) / f64::from(looks));
        let there = Depth::of(&bounds_now, to_deg);
        // On the way it may lead along an edge, or past a point where the way out is shorter.
        let gain_deg = if look == looks { OUT_GAIN_DEG } else { -OUT_GAIN_DEG };
        let enters_again = was_out && !there.is_out();
        was_out = there.is_out();
        if enters_again || !here.is_left_for(&there, gain_deg) {
            let at = bounds.direction(to_deg);
            return Err(Refusal::Forbidden { barrier: inside.barrier.clone(), at });
        }
    }
    let fastest = rates_deg_s.into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
    let slowest_share = match situation.can.jog {
        JogSpeeds::Named(speeds) => speeds.first().map_or(0.0, |slowest| slowest.share),
        JogSpeeds::AnyRate => 0.0,
    };
    let allowed_deg_s = situation.limits.maximum_rate_deg_s * OUT_SHARE.max(slowest_share);
    if fastest > allowed_deg_s {
        return Err(Refusal::TooFast { asked_deg_s: fastest, allowed_deg_s });
    }
    if situation.gate.lets_out(situation.now) {
        return Ok(());
    }
    Err(Refusal::Inside(inside.barrier.clone()))
}

/// How deep the axes stand inside barriers.
#[allow(clippy::struct_field_names, reason = "names tell their units")]
struct Depth {
    /// Distance to an allowed position, degrees; `None` where no axis gets out by itself.
    way_out_deg: Option<f64>,
    /// Below the minimum elevation, degrees.
    below_deg: f64,
    /// Inside of each other barrier, degrees.
    inside_deg: Vec<f64>,
}

impl Depth {
    fn of(bounds: &BoundsAt<'_>, axes_deg: [f64; 2]) -> Self {
        let (below_deg, inside_deg) = bounds.depths_deg(axes_deg);
        Self { way_out_deg: bounds.way_out_deg(axes_deg), below_deg, inside_deg }
    }

    fn is_out(&self) -> bool {
        self.way_out_deg.is_some_and(|deg| deg <= 0.0)
    }

    /// Returns `true` if `there` is less deep by `gain_deg`, or outside of everything, and no
    /// lower below the minimum elevation.
    fn is_left_for(&self, there: &Self, gain_deg: f64) -> bool {
        if there.below_deg > self.below_deg + OUT_GAIN_DEG {
            return false;
        }
        match (self.way_out_deg, there.way_out_deg) {
            (Some(here), Some(there)) => there < here - gain_deg || (here <= 0.0 && there <= 0.0),
            (Some(_), None) => false,
            // No axis gets out by itself: the edge of the deepest barrier must come nearer,
            // and no other may go further away.
            (None, _) => {
                let deepest = |depths: &[f64]| depths.iter().copied().fold(0.0, f64::max);
                let mut each = self.inside_deg.iter().zip(&there.inside_deg);
                each.all(|(here, there)| *there <= here + OUT_GAIN_DEG)
                    && deepest(&there.inside_deg) < deepest(&self.inside_deg) - gain_deg
            }
        }
    }
}

/// Angles of the axes, as the mount counts.
pub(super) fn axes(situation: &Situation<'_>) -> Option<[f64; 2]> {
    situation.state.measured?.axes_deg(situation.can.has_elevation())
}

fn sweep_between(from_deg: [f64; 2], to_deg: [f64; 2], situation: &Situation<'_>) -> Sweep {
    let Sweep([first, second]) = Sweep::between(from_deg, to_deg);
    let second = if situation.can.has_elevation() { second } else { (0.0, 90.0) };
    Sweep([first, second])
}

fn blocked(sweep: Sweep, from_deg: [f64; 2], bounds: &BoundsAt<'_>) -> Result<(), Refusal> {
    bounds
        .blocks(sweep, from_deg)
        .map_or(Ok(()), |(barrier, at)| Err(Refusal::Forbidden { barrier, at }))
}

/// Angles of the axes at the end of a motion to a position, degrees as the mount counts.
fn target(
    azimuth: Option<Angle>,
    elevation: Option<Angle>,
    axes_deg: [f64; 2],
    situation: &Situation<'_>,
) -> Option<[f64; 2]> {
    let degrees = |angle: Option<Angle>, stays: f64| angle.map_or(stays, Angle::degrees);
    match situation.mount {
        Mount::AzEl { .. } => {
            Some([degrees(azimuth, axes_deg[0]), degrees(elevation, axes_deg[1])])
        }
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let measured = situation.state.measured.map(|measured| measured.pointing);
            let direction = aimed(azimuth, elevation, measured).direction()?;
            Some(crossed(direction, lower_axis_azimuth_deg))
        }
    }
}

/// The controller counts 90 at the zenith.
fn crossed(direction: AzEl, lower_axis_azimuth_deg: f64) -> [f64; 2] {
    let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
    let axes = xy_mount::axes_from_azel(direction, lower_axis);
    [axes.lower, axes.upper].map(|angle| angle.degrees() + 90.0)
}

impl Gate {
    /// The way of `motion` to its position: direct, or one axis after the other where both
    /// together may sweep through a barrier.
    pub(in crate::driver) fn route(
        &self,
        motion: Motion,
        intent: Intent,
        now: Moment,
    ) -> Result<Route, Refusal> {
        let refusal = match self.check(motion, intent, now) {
            Ok(()) => return Ok(Route { first: motion, then: None }),
            Err(refusal @ Refusal::Forbidden { .. }) => refusal,
            Err(other) => return Err(other),
        };
        let Some((from_deg, to_deg)) = self.ends(motion, now) else { return Err(refusal) };
        let corners_deg = [[to_deg[0], from_deg[1]], [from_deg[0], to_deg[1]]];
        let bounds = self.bounds_in(intent);
        for corner_deg in corners_deg {
            let first = self.to_axes(corner_deg);
            let second = Sweep::between(corner_deg, to_deg);
            let is_free = bounds.at(now.utc).blocks(second, corner_deg).is_none()
                && self.check(first, intent, now).is_ok();
            if is_free {
                return Ok(Route { first, then: Some(motion) });
            }
        }
        if intent != Intent::Track {
            return Err(refusal);
        }
        // A sequence of positions may follow any way.
        let detour = detour::between(bounds, &self.axis_limits(), from_deg, to_deg, now.utc);
        let places_deg = detour::in_steps(&detour.unwrap_or_default(), DETOUR_STEP_DEG);
        let farthest = places_deg.into_iter().rev().map(|place| self.to_axes(place));
        let first = farthest.into_iter().find(|first| self.check(*first, intent, now).is_ok());
        first.map(|first| Route { first, then: Some(motion) }).ok_or(refusal)
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

    /// Where the axes will stand after turning by `ahead_deg`; an axis on its way to a
    /// position ends there.
    pub(in crate::driver) fn ahead_of(&self, axes_deg: [f64; 2], ahead_deg: [f64; 2]) -> [f64; 2] {
        let mut reached = [axes_deg[0] + ahead_deg[0], axes_deg[1] + ahead_deg[1]];
        let overrun_deg = self.variant.capabilities.arrives_within_deg * 2.0;
        for ((reached, from_deg), to_deg) in reached.iter_mut().zip(axes_deg).zip(self.to_deg) {
            let Some(to_deg) = to_deg else { continue };
            let passes =
                (from_deg..=*reached).contains(&to_deg) || (*reached..=from_deg).contains(&to_deg);
            if passes {
                *reached = to_deg;
            } else if (from_deg - to_deg).abs() <= overrun_deg {
                // It runs out around the position that it was sent to.
                *reached = from_deg;
            }
        }
        reached
    }

    /// The axes before and after a motion to a position.
    pub(super) fn ends(&self, motion: Motion, now: Moment) -> Option<([f64; 2], [f64; 2])> {
        let Motion::Position { azimuth, elevation } = self.controller.as_sent(motion) else {
            return None;
        };
        let situation = self.situation(Intent::Position, false, now);
        let from_deg = axes(&situation).filter(|_| situation.can.has_elevation())?;
        Some((from_deg, target(azimuth, elevation, from_deg, &situation)?))
    }

    /// Where each axis will stand after a motion to a position. An axis that is sent somewhere
    /// ends there, also from its limit, where it has no angle.
    pub(super) fn sent_to(&self, motion: Motion, now: Moment) -> [Option<f64>; 2] {
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

    /// Refuses a way to `to` that the unit takes by itself, at its own rates. The unit keeps
    /// to its own minimum elevation at the end, but not between: where both axes of an X/Y mount
    /// turn, the antenna may dip.
    pub(super) fn slew_is_clear(&self, to: AzEl, now: Moment) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Track, false, now);
        let Some(from_deg) = axes(&situation) else { return Ok(()) };
        let to_deg = target(Some(to.azimuth), Some(to.elevation), from_deg, &situation);
        let Some(to_deg) = to_deg else { return Ok(()) };
        let sweep = sweep_between(from_deg, to_deg, &situation);
        let along = Angle::from_degrees(ALONG_DEG);
        blocked(sweep, from_deg, &self.bounds.at(now.utc).with_floor_lower_by(along))
    }

    /// The lead of an action as a motion to a position; `None` where it leads nowhere or is
    /// unknown.
    pub(super) fn motion_of(&self, act: &Act) -> Option<Motion> {
        let Lead::To(to_deg) = self.controller.lead_of(act) else { return None };
        if let Mount::AzEl { .. } = self.mount {
            let [azimuth, elevation] = to_deg.map(|deg| deg.map(Angle::from_degrees));
            return Some(Motion::Position { azimuth, elevation });
        }
        let stands = self.state().measured.map(|measured| measured.axes);
        let angle_deg = |axis: usize| stands.and_then(|axes| axes.get(axis)?.angle_deg);
        let [first, second] = to_deg;
        Some(self.to_axes([first.or(angle_deg(0))?, second.or(angle_deg(1))?]))
    }

    /// Angles of the axes at the end of an action, as far as they are known.
    pub(super) fn end_of(&self, act: &Act) -> [Option<f64>; 2] {
        match self.controller.lead_of(act) {
            Lead::To(to_deg) => to_deg,
            Lead::Nowhere | Lead::Unseen(_) | Lead::Unknown(_) => [None; 2],
        }
    }
}
