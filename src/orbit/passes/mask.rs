//! The parts of a pass above the horizon mask of the site.
//!
//! The search follows the clearance, elevation minus mask, along the pass. High above the whole
//! mask, or far below it, the clearance cannot change its sign before the satellite has moved by as
//! much. Near the mask, the steps are small. The mask is straight between its points. The search
//! therefore also examines every mask point that the azimuth passes, and misses no narrow wall.

use super::{
    Pass, PassSearch,
    local_series::{Bend, LocalState},
    sighting::Sighting,
    track::Track,
    window::Window,
};
use crate::{
    Propagator,
    astro::{Angle, AzEl, HorizonMask, Site},
};

/// Min step, near the mask, and max step, radians across the sky.
const FINE_STEP: f64 = 0.002_5;
const COARSE_STEP: f64 = 0.09;
/// Max change of azimuth between two looks, radians. It is small enough for the sense of the turn
/// to be clear.
const MAX_TURN: f64 = 0.09;
/// Max step, seconds.
const LONGEST_STEP_S: f64 = 300.0;
/// Accuracy of crossings, and of the times at which the azimuth passes a mask point, seconds.
const TOLERANCE_S: f64 = 2e-4;
/// Tolerance of the clearance, radians. A satellite level with the mask counts as clear, because
/// AOS over a level mask is level with it except for rounding.
const LEVEL: f64 = 1e-7;

/// Returns the stretches of `pass` in which the satellite is above `mask`, in order.
///
/// AOS and LOS of a stretch are crossings of the mask, exact to a millisecond, or the AOS and LOS
/// of the pass. Only the latter keep the marks of the pass.
pub fn clear_stretches(
    propagator: &Propagator,
    site: Site,
    mask: &HorizonMask,
    pass: &Pass,
) -> Vec<Pass> {
    let search = PassSearch::new(site, pass.aos.time, pass.los.time);
    let Some(window) = Window::new(&search) else { return Vec::new() };
    let track = Track::new(&window, 0, propagator);
    let points = mask.points_deg().iter().map(|(azimuth, _)| azimuth.to_radians());
    let follower = Follower {
        track: &track,
        mask,
        points: points.collect(),
        lowest: mask.lowest().radians(),
        highest: mask.highest().radians(),
    };
    let mut stretches = Stretches { pass, track: &track, open: None, found: Vec::new() };
    follower.follow(&mut stretches);
    stretches.found
}

/// A look at the sky, with the clearance over the mask.
#[derive(Clone, Copy)]
struct MaskLook {
    place: LocalState,
    azimuth: f64,
    elevation: f64,
    clearance: f64,
}

impl MaskLook {
    fn is_clear(&self) -> bool {
        self.clearance >= -LEVEL
    }

    /// Returns the shorter turn from here to `azimuth`, radians.
    fn turn_to(&self, azimuth: f64) -> f64 {
        Angle::from_radians(azimuth - self.azimuth).wrapped_180().radians()
    }
}

struct Follower<'a> {
    track: &'a Track<'a>,
    mask: &'a HorizonMask,
    /// Azimuths of the points of the mask, ascending, radians.
    points: Vec<f64>,
    lowest: f64,
    highest: f64,
}

impl Follower<'_> {
    fn look(&self, at_s: f64) -> Option<MaskLook> {
        let place = self.track.place(at_s)?;
        let geometric = Sighting::new(&place).direction();
        let AzEl { azimuth, elevation } = self.track.window.pass_direction(geometric);
        let clearance = (elevation - self.mask.elevation_at(azimuth)).radians();
        Some(MaskLook {
            place,
            azimuth: azimuth.radians(),
            elevation: elevation.radians(),
            clearance,
        })
    }

    fn follow(&self, stretches: &mut Stretches<'_>) {
        let end_s = self.track.window.length_s;
        let Some(mut here) = self.look(0.0) else { return };
        if here.is_clear() {
            stretches.open(here.place, stretches.pass.starts_before);
        }
        while here.place.at_s < end_s {
            let next_s = (here.place.at_s + self.step_s(&here)).min(end_s);
            let Some(next) = self.look(next_s) else { break };
            self.step(here, next, stretches);
            here = next;
        }
        if here.is_clear() {
            stretches.close(here.place, stretches.pass.ends_after);
        }
    }

    fn step_s(&self, here: &MaskLook) -> f64 {
        let spare = (here.elevation - self.highest).max(self.lowest - here.elevation);
        let step = (0.5 * spare).clamp(FINE_STEP, COARSE_STEP);
        (step / here.place.angular_rate()).min(LONGEST_STEP_S)
    }

    /// Moves from one look to the next, via every point of the mask between them.
    fn step(&self, start: MaskLook, end: MaskLook, stretches: &mut Stretches<'_>) {
        let side = |look: &MaskLook| {
            if look.elevation > self.highest + LEVEL {
                1
            } else {
                -i32::from(look.elevation < self.lowest - LEVEL)
            }
        };
        // If both looks are above or both below the whole mask, the path between them does not
        // matter.
        if side(&start) * side(&end) == 1 {
            stretches.pass_by(start.place, end.place);
            return;
        }
        let turn = start.turn_to(end.azimuth);
        let span_s = end.place.at_s - start.place.at_s;
        if turn.abs() > MAX_TURN && span_s > TOLERANCE_S {
            if let Some(middle) = self.look(start.place.at_s + 0.5 * span_s) {
                self.step(start, middle, stretches);
                self.step(middle, end, stretches);
            }
            return;
        }
        let mut last = start;
        for azimuth in self.points_between(start.azimuth, turn) {
            if let Some(look) = self.look_at_azimuth(last, end, azimuth) {
                self.cross(last, look, stretches);
                last = look;
            }
        }
        self.cross(last, end, stretches);
    }

    /// Returns the azimuths of the mask points that a turn by `turn` from `start` passes, in that
    /// order.
    fn points_between(&self, start: f64, turn: f64) -> impl Iterator<Item = f64> {
        let (low, length) = (start + turn.min(0.0), turn.abs());
        let first = Angle::from_radians(low).wrapped_360().radians();
        let split = self.points.partition_point(|point| *point <= first);
        let (before, after) = self.points.split_at(split);
        let mut crossed: Vec<f64> = after
            .iter()
            .chain(before)
            .copied()
            .take_while(|point| {
                let ahead = Angle::from_radians(point - first).wrapped_360().radians();
                ahead > 0.0 && ahead < length
            })
            .collect();
        if turn < 0.0 {
            crossed.reverse();
        }
        crossed.into_iter()
    }

    /// Returns the look between two others with the azimuth `azimuth`.
    fn look_at_azimuth(&self, start: MaskLook, end: MaskLook, azimuth: f64) -> Option<MaskLook> {
        self.settle(start, end, |look| look.turn_to(azimuth)).map(|(_, look)| look)
    }

    /// Records the time at which the clearance changes its sign between two looks.
    fn cross(&self, start: MaskLook, end: MaskLook, stretches: &mut Stretches<'_>) {
        if start.is_clear() == end.is_clear() {
            stretches.pass_by(start.place, end.place);
        } else if let Some((_, crossing)) = self.settle(start, end, |look| look.clearance + LEVEL) {
            if end.is_clear() {
                stretches.open(crossing.place, false);
                stretches.pass_by(crossing.place, end.place);
            } else {
                stretches.pass_by(start.place, crossing.place);
                stretches.close(crossing.place, false);
            }
        }
    }

    /// Returns the last look before and the first look after a sign change of `value`, at most the
    /// tolerance apart. The search uses the Illinois method of false position.
    fn settle(
        &self,
        start: MaskLook,
        end: MaskLook,
        value: impl Fn(&MaskLook) -> f64,
    ) -> Option<(MaskLook, MaskLook)> {
        let (mut a, mut b) = ((start, value(&start)), (end, value(&end)));
        if (a.1 > 0.0) == (b.1 > 0.0) {
            return None;
        }
        for round in 0..60 {
            let (a_s, b_s) = (a.0.place.at_s, b.0.place.at_s);
            if b_s - a_s <= TOLERANCE_S {
                break;
            }
            // An occasional halving bounds the effort for any curve.
            let share = if round % 4 == 3 { 0.5 } else { a.1 / (a.1 - b.1) };
            // The new look is never at an end, so that both ends close in.
            let margin_s = (0.4 * TOLERANCE_S).min(0.25 * (b_s - a_s));
            let at_s = (a_s + share * (b_s - a_s)).clamp(a_s + margin_s, b_s - margin_s);
            let middle = self.look(at_s)?;
            let found = value(&middle);
            if (found > 0.0) == (a.1 > 0.0) {
                a = (middle, found);
            } else {
                b = (middle, found);
            }
        }
        Some((a.0, b.0))
    }
}

/// Builder of the stretches from looks in order of time.
struct Stretches<'a> {
    pass: &'a Pass,
    track: &'a Track<'a>,
    open: Option<OpenStretch>,
    found: Vec<Pass>,
}

/// A stretch without a known end.
struct OpenStretch {
    aos: LocalState,
    highest: LocalState,
    /// Duration of the step to the highest look, seconds.
    around_s: f64,
    starts_before: bool,
}

impl Stretches<'_> {
    fn open(&mut self, aos: LocalState, starts_before: bool) {
        self.open = Some(OpenStretch { aos, highest: aos, around_s: 0.0, starts_before });
    }

    fn pass_by(&mut self, start: LocalState, end: LocalState) {
        if let Some(open) = &mut self.open
            && end.height.sine > open.highest.height.sine
        {
            open.highest = end;
            open.around_s = end.at_s - start.at_s;
        }
    }

    fn close(&mut self, los: LocalState, ends_after: bool) {
        let Some(open) = self.open.take().filter(|open| los.at_s > open.aos.at_s) else { return };
        let ends = [&open.aos, &los];
        let highest = if los.height.sine > open.highest.height.sine { los } else { open.highest };
        // The top lies within a step of the highest look, or at an end.
        let reach_s = 2.0 * open.around_s;
        let crest = self
            .track
            .extreme(highest.at_s, reach_s, Bend::Crest)
            .map(|(_, place)| place)
            .filter(|top| (open.aos.at_s..=los.at_s).contains(&top.at_s))
            .filter(|top| top.height.sine >= highest.height.sine);
        let tca = crest.unwrap_or(highest);
        let [aos, los] = ends;
        let sightings = [aos, &tca, los].map(Sighting::new);
        let marks = [open.starts_before, ends_after];
        let mut stretch: Pass = self.track.pass(sightings.each_ref(), marks).into();
        // Points of the pass itself stay exactly the same.
        let (from_s, end_s) = (aos.at_s, self.track.window.length_s);
        if from_s <= 0.0 {
            stretch.aos = self.pass.aos;
        }
        if los.at_s >= end_s {
            stretch.los = self.pass.los;
        }
        if (stretch.aos.time..=stretch.los.time).contains(&self.pass.tca.time) {
            stretch.tca = self.pass.tca;
        }
        self.found.push(stretch);
    }
}
