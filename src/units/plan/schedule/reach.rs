//! Passes that one antenna can take: the positions of its axes along a pass, and the slew times
//! between places.

mod travel;

use std::borrow::Cow;

use jiff::Timestamp;

use super::{
    sight::{Samples, Sight},
    way::{Impossible, Lost, Span, Verdict, Way, at_ms, ms},
};
use crate::{
    astro::{Angle, AzEl, PointingModel, time::seconds_between},
    device::Pointing,
    plan::{
        Barrier, Bounds, BoundsAt, Loss, Sample, Sweep,
        az_el::{Flip, FlipChoice, Planned, Start},
        bounds::FINEST_DEG,
        detour::{self, AxisLimits},
        on_board::ALONG_DEG,
        program_track::Drives,
    },
    station::{Antenna, ControllerSpec, Mount, Station},
};

/// Max distance between the beginnings of equal paths, degrees.
const SAME_DEG: f64 = 0.5;
/// Whole turn of an azimuth axis, degrees.
const TURN_DEG: f64 = 360.0;
/// Share of its rate below which an axis keeps up with few samples of a pass.
const SLOW: f64 = 0.4;
/// Position of an axis of an X/Y mount at the zenith, degrees as the mount counts.
const ZENITH_DEG: f64 = 90.0;
/// Distance of the open sky from the ends of the travel, degrees.
const OFF_ENDS_DEG: f64 = 5.0;
/// Time in which the Sun moves less than [`FINEST_DEG`].
const SUN_STAYS_MS: i64 = 10_000;
/// Number of checked places on a path to the open sky.
const STEPS: u32 = 18;
/// Min angle from the direction in which the first axis turns on the spot, degrees: the zenith, or
/// an end of the lower axis of an X/Y mount. Beyond this angle, few samples suffice to judge a
/// pass.
const CLEAR_DEG: f64 = 5.0;

/// Mount, rates, limits and bounds of an antenna, for passes and slews.
#[derive(Debug, Clone)]
pub struct Reach {
    drives: Drives,
    /// Whole travel: a slew may use the ends, but a track keeps away from them.
    slews: AxisLimits,
    bounds: Bounds,
    /// Model that program track applies; `None` if the axes read the true direction, and for a unit
    /// that follows a pass on its own.
    model: Option<PointingModel>,
    half_beam: Angle,
    park: AzEl,
    park_deg: [f64; 2],
    /// `true` for a unit that follows a pass on its own, and refuses a pass through a keep-out.
    on_board: bool,
    spec: &'static ControllerSpec,
}

/// Single path along a pass.
struct Judged {
    /// Usable path; `None` if no second counts.
    way: Option<Way>,
    entered: Option<Barrier>,
    lost_at: Option<Loss>,
}

impl Reach {
    /// Returns the reach of an antenna of `station`, with the measured rates of its axes.
    pub fn from_station(
        station: &Station,
        antenna: &Antenna,
        rates_deg_s: Option<[f64; 2]>,
    ) -> Self {
        let can = antenna.connection.variant().capabilities;
        let drives = Drives {
            mount: antenna.track_mount(),
            limits: antenna.limits,
            rates_deg_s: rates_deg_s.unwrap_or([antenna.limits.maximum_rate_deg_s; 2]),
            step_deg: can.position_step_deg,
            arrives_within_deg: can.arrives_within_deg,
            has_elevation: can.has_elevation(),
        };
        let park = antenna.park_direction();
        let sample = Sample { time: Timestamp::UNIX_EPOCH, direction: park };
        let choice = FlipChoice::Keep(Flip::None);
        let bounds = Bounds::new(station, antenna);
        let start = Start::default();
        let whole = Drives { mount: antenna.mount, ..drives };
        let parked = whole.along_within(&bounds, &[sample], 1.0, start, choice).axes_deg;
        Self {
            slews: whole.axis_limits(),
            drives,
            bounds,
            model: Some(antenna.track_model())
                .filter(|pointing_model| !pointing_model.is_none() && !can.has_program),
            half_beam: antenna.beam_width() * 0.5,
            park,
            park_deg: parked.map(|axis| axis.first().copied().unwrap_or_default()),
            on_board: can.has_program,
            spec: antenna.connection.spec(),
        }
    }

    /// Returns `true` if the antenna can stand at its park position at `time`.
    pub fn can_park(&self, time: Timestamp) -> bool {
        let reached = self.bounds.direction(self.park_deg);
        let deviation = if self.drives.has_elevation {
            self.park.separation(reached)
        } else {
            (self.park.azimuth - reached.azimuth).wrapped_180().abs()
        };
        deviation.degrees() < SAME_DEG && self.bounds.at_time(time).forbids(reached).is_none()
    }

    /// Returns a direction outside of all barriers at `time`; `None` if none is found.
    pub fn open_sky(&self, time: Timestamp) -> Option<AzEl> {
        self.open_sky_deg(&self.bounds.at_time(time))
            .map(|axes_deg| self.bounds.direction(axes_deg))
    }

    /// Returns the axis positions at the park position, or as near to it as they travel, degrees as
    /// the mount counts.
    pub fn park_deg(&self) -> [f64; 2] {
        self.park_deg
    }

    /// Returns the direction of the antenna at these axis positions; an antenna without elevation
    /// has only an azimuth.
    pub fn pointing(&self, axes_deg: [f64; 2]) -> Pointing {
        let direction = self.bounds.direction(axes_deg);
        let elevation = Some(direction.elevation).filter(|_| self.drives.has_elevation);
        Pointing { azimuth: Some(direction.azimuth), elevation }
    }

    /// Returns the time between two axis positions along the straight path, seconds.
    pub fn straight_s(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
        self.straight_ms(from_deg, to_deg) as f64 / 1000.0
    }

    pub(super) fn has_barriers(&self) -> bool {
        self.bounds.forbid_anything()
    }

    pub(super) fn min_elevation(&self) -> Angle {
        Angle::from_degrees(self.drives.limits.minimum_elevation_deg)
    }

    /// Returns how program track takes the rest at `now` of a pass along `samples`, which are at
    /// equal intervals. The axes stand at `stands_deg` and may turn from `ready_ms` on. Returns
    /// `None` if no second counts.
    pub(super) fn rest(
        &self,
        samples: &[Sample],
        stands_deg: [f64; 2],
        (now, ready_ms): (Timestamp, i64),
    ) -> Option<Way> {
        let is_ahead = |sample: &&Sample| {
            sample.time >= now && sample.direction.elevation >= self.min_elevation()
        };
        let first = samples.iter().position(|sample| is_ahead(&sample))?;
        let last = samples.iter().rposition(|sample| is_ahead(&sample))?;
        let list = samples.get(first..=last).unwrap_or_default();
        let list: Vec<_> = list.iter().map(|sample| self.as_read(*sample)).collect();
        let [first_sample, second, ..] = list.as_slice() else { return None };
        let step_s = seconds_between(first_sample.time, second.time);
        let span = Span { from_ms: ms(first_sample.time), to_ms: ms(list.last()?.time) };
        let lead_s = ((span.from_ms - ready_ms) as f64 / 1000.0).max(0.0);
        let start = Start { axes_deg: stands_deg.map(Some), lead_s, ..Start::default() };
        let choice = FlipChoice::Prefer(Flip::None);
        let planned = self.drives.along_within(&self.bounds, &list, step_s, start, choice);
        let samples = Samples { list, step_s };
        let Judged { way, entered, .. } = self.judged(&samples, planned, &[span]);
        way.filter(|_| entered.is_none() || !self.on_board)
    }

    /// Converts the sample to the axis reading in program track.
    fn as_read(&self, sample: Sample) -> Sample {
        let reading = self.model.and_then(|model| model.reading(sample.direction));
        Sample { direction: reading.unwrap_or(sample.direction), ..sample }
    }

    fn all_as_read<'s>(&self, samples: &'s Samples) -> Cow<'s, Samples> {
        if self.model.is_none() {
            return Cow::Borrowed(samples);
        }
        let list = samples.list.iter().map(|sample| self.as_read(*sample)).collect();
        Cow::Owned(Samples { list, ..*samples })
    }

    /// Judges how the antenna can take the visible part of the pass.
    pub fn judge(&self, sight: &mut Sight<'_>) -> Verdict {
        if sight.name().is_some_and(|name| !self.spec.takes_satellite(name)) {
            return Verdict::Impossible(Impossible::Name);
        }
        // A unit that tracks on its own applies its minimum without refraction.
        let lowest = self.min_elevation();
        let lowest = if self.on_board { sight.appearing_at(lowest) } else { lowest };
        let Some(span) = sight.above(lowest) else {
            return Verdict::Impossible(Impossible::TooLow);
        };
        let clear = sight.clear(span);
        if clear.is_empty() {
            return Verdict::Impossible(Impossible::Hidden);
        }
        let coarse = self.all_as_read(sight.coarse(span));
        if let Some(ways) = self.easy_ways(&coarse, &clear) {
            return Verdict::Possible(ways);
        }
        let Some(part) = self.within_travel(&coarse, span) else {
            let seconds = Span::total_ms(&clear) as f64 / 1000.0;
            return Verdict::Impossible(Impossible::Lost(Lost { seconds, loss: Loss::OutOfReach }));
        };
        drop(coarse);
        self.ways(&self.all_as_read(sight.fine(span, part)), &clear)
    }

    /// Returns the paths of a pass that the axes follow easily; `None` for a pass that needs a
    /// closer check.
    fn easy_ways(&self, samples: &Samples, clear: &[Span]) -> Option<Vec<Way>> {
        // A keep-out may lie between two of the few samples.
        if self.has_barriers() {
            return None;
        }
        let ways: Vec<_> =
            self.planned(samples).into_iter().map(|planned| planned.axes_deg).collect();
        let follows = |axes_deg: &[Vec<f64>; 2]| {
            let slow = axes_deg.iter().zip(self.drives.rates_deg_s).all(|(axis, rate)| {
                let max_deg = SLOW * rate * samples.step_s;
                axis.iter().zip(axis.iter().skip(1)).all(|(a, b)| (b - a).abs() < max_deg)
            });
            let places = axes_deg[0].iter().zip(&axes_deg[1]).map(|(a, b)| [*a, *b]);
            let mut pairs = samples.list.iter().zip(places);
            slow && axes_deg[1].iter().all(|deg| self.is_clear(*deg))
                && pairs.all(|(sample, axes_deg)| self.is_in_beam(sample.direction, axes_deg))
        };
        ways.iter().all(follows).then(|| {
            let ways = ways.into_iter();
            let ways = ways.map(|axes_deg| Way::new(samples, axes_deg, clear.to_vec(), None));
            ways.collect()
        })
    }

    /// Returns `true` if the first axis need not turn on the spot at this angle of the second axis.
    fn is_clear(&self, second_deg: f64) -> bool {
        let to_pole_deg = match self.drives.mount {
            Mount::AzEl { .. } => (second_deg - 90.0).abs(),
            Mount::Xy { .. } => 90.0 - (second_deg - 90.0).abs(),
        };
        to_pole_deg >= CLEAR_DEG
    }

    fn ways(&self, samples: &Samples, clear: &[Span]) -> Verdict {
        let planned = self.planned(samples).into_iter();
        let judged: Vec<Judged> =
            planned.map(|planned| self.judged(samples, planned, clear)).collect();
        let entered = judged.iter().find_map(|judged| judged.entered.clone());
        let lost_at = judged.iter().find_map(|judged| judged.lost_at);
        let mut ways: Vec<Way> = judged.into_iter().filter_map(|judged| judged.way).collect();
        if let Some(barrier) = entered.filter(|_| self.on_board || ways.is_empty()) {
            return Verdict::Impossible(Impossible::KeepOut(barrier));
        }
        if ways.is_empty() {
            let seconds = Span::total_ms(clear) as f64 / 1000.0;
            let loss = lost_at.unwrap_or(Loss::OutOfReach);
            return Verdict::Impossible(Impossible::Lost(Lost { seconds, loss }));
        }
        ways.retain(|way| self.is_within_reach(way));
        if ways.is_empty() {
            return Verdict::Impossible(Impossible::NoWay);
        }
        Verdict::Possible(ways)
    }

    /// Returns the counted time along one path, the first barrier on it, and the first loss of the
    /// satellite.
    fn judged(&self, samples: &Samples, planned: Planned, clear: &[Span]) -> Judged {
        let Planned { axes_deg, slews, .. } = planned;
        let [first, second] = &axes_deg;
        let places = first.iter().zip(second).map(|(first, second)| [*first, *second]);
        let slews = slews.iter().filter_map(|slew| samples.list.get(*slew));
        let slews: Vec<Timestamp> = slews.map(|sample| sample.time).collect();
        let (mut visible, mut entered): (Vec<Span>, _) = (Vec::new(), None);
        let [is_late, is_early] = samples.leave_out(clear);
        let loss_beyond = |index| Loss::beyond_travel(self.drives.mount, &samples.list, index);
        let mut lost_at = is_late.then(|| loss_beyond(0));
        // Reuse the bounds while the Sun hardly moves.
        let mut bounds = None;
        // As in trackability, the time between two samples counts only if both are in the beam.
        let mut before: Option<Timestamp> = None;
        for (index, (sample, axes_deg)) in samples.list.iter().zip(places).enumerate() {
            let lost_from = before.take();
            if self.has_barriers() {
                let direction = self.bounds.direction(axes_deg);
                let step_ms = ms(sample.time).div_euclid(SUN_STAYS_MS) * SUN_STAYS_MS;
                let now = match bounds.take() {
                    Some((since_ms, now)) if since_ms == step_ms => now,
                    Some(_) | None => self.bounds.at_time(at_ms(step_ms)),
                };
                let barrier = now.forbids(direction);
                bounds = Some((step_ms, now));
                if let Some(barrier) = barrier {
                    entered = entered.or(Some(barrier));
                    continue;
                }
            }
            if !self.is_in_beam(sample.direction, axes_deg) {
                lost_at = lost_at.or_else(|| Some(self.loss_at(&samples.list, index, &slews)));
                continue;
            }
            before = Some(sample.time);
            let Some(start) = lost_from else { continue };
            let span = Span { from_ms: ms(start), to_ms: ms(sample.time) };
            match visible.last_mut() {
                Some(last) if last.to_ms == span.from_ms => last.to_ms = span.to_ms,
                _ => visible.push(span),
            }
        }
        let lost_at =
            lost_at.or_else(|| is_early.then(|| loss_beyond(samples.list.len().saturating_sub(1))));
        let counted = Span::intersections(&visible, clear);
        let lost_ms = Span::total_ms(clear) - Span::total_ms(&counted);
        let lost = lost_at.filter(|_| lost_ms > 0);
        let lost = lost.map(|loss| Lost { seconds: lost_ms as f64 / 1000.0, loss });
        let way = (!counted.is_empty()).then(|| Way::new(samples, axes_deg, counted, lost));
        Judged { way, entered, lost_at }
    }

    /// Returns `true` if paths lead from the open sky to the start, and back from the end.
    fn is_within_reach(&self, way: &Way) -> bool {
        if !self.has_barriers() {
            return true;
        }
        let Span { from_ms, to_ms } = way.span();
        let (start_deg, end_deg) = (way.axes_deg(from_ms), way.axes_deg(to_ms));
        [(start_deg, from_ms), (end_deg, to_ms)].into_iter().all(|(place_deg, ms)| {
            let now = self.bounds.at_time(at_ms(ms));
            self.open_sky_deg(&now).is_some_and(|open_deg| self.is_way(place_deg, open_deg, &now))
        })
    }

    fn is_way(&self, place_deg: [f64; 2], open_deg: [f64; 2], now: &BoundsAt<'_>) -> bool {
        let sweep = Sweep::new(place_deg, open_deg);
        now.blocks(sweep, Sweep::at_position(place_deg)).is_none() || {
            // Start at the place that may be enclosed, because a search from there ends soon.
            detour::leads(now, &self.slews, place_deg, open_deg)
        }
    }

    /// Returns the first place outside of all barriers on a path from the park position to the
    /// zenith, and round from there. Returns `None` without such a place. The park position may
    /// itself be inside a barrier. The place is off the ends of the travel, where some units report
    /// no angle.
    fn open_sky_deg(&self, now: &BoundsAt<'_>) -> Option<[f64; 2]> {
        let ends = self.park_deg.into_iter().zip(self.slews.travel_deg);
        let mut off_ends = ends.map(|(at_deg, (min_deg, max_deg))| {
            let off_deg = OFF_ENDS_DEG.min((max_deg - min_deg) / 2.0);
            let (low_deg, high_deg) = (min_deg + off_deg, max_deg - off_deg);
            (at_deg.max(low_deg).min(high_deg), low_deg, high_deg)
        });
        let (first, second) = (off_ends.next()?, off_ends.next()?);
        let zenith_deg = match self.drives.mount {
            Mount::AzEl { .. } if !self.drives.has_elevation => [first.0, second.0],
            Mount::AzEl { .. } => [first.0, ZENITH_DEG],
            Mount::Xy { .. } => [ZENITH_DEG; 2],
        };
        let up = along([first.0, second.0], zenith_deg);
        let round = along([first.1, zenith_deg[1]], [first.2, zenith_deg[1]]);
        let room_deg = self.slews.room_deg * now.max_beam_turn();
        up.chain(round).find(|place| now.has_room(*place, room_deg))
    }

    /// Returns the kind of loss at `samples[index]`, the first lost sample, for an antenna whose
    /// azimuth axis slews at `slews`.
    fn loss_at(&self, samples: &[Sample], index: usize, slews: &[Timestamp]) -> Loss {
        let Some(sample) = samples.get(index) else { return Loss::OutOfReach };
        match self.drives.mount {
            Mount::Xy { lower_axis_azimuth_deg, .. } => {
                let end = Angle::from_degrees(lower_axis_azimuth_deg);
                let is_far = (sample.direction.azimuth - end).wrapped_180().abs().degrees() > 90.0;
                let turn = Angle::from_degrees(if is_far { 180.0 } else { 0.0 });
                Loss::Keyhole((end + turn).wrapped_360())
            }
            Mount::AzEl { .. } => {
                // An unwrap takes no longer than a whole turn.
                let near_s = TURN_DEG / self.drives.rates_deg_s[0];
                let is_near =
                    |slew: &Timestamp| seconds_between(*slew, sample.time).abs() <= near_s;
                Loss::at_sample(self.drives.mount, samples, index, slews.iter().any(is_near))
            }
        }
    }

    /// Returns the positions of both axes along `samples`, one list for each turn on which the
    /// azimuth axis can begin.
    fn planned(&self, samples: &Samples) -> Vec<Planned> {
        let mut found: Vec<Planned> = Vec::new();
        for start in self.starts(samples.list.first()) {
            let choice = FlipChoice::Prefer(Flip::None);
            let planned = self.drives.along_within(
                &self.bounds,
                &samples.list,
                samples.step_s,
                start,
                choice,
            );
            let first =
                |planned: &Planned| planned.axes_deg[0].first().copied().unwrap_or_default();
            let begins_deg = first(&planned);
            if found.iter().all(|other| (first(other) - begins_deg).abs() > SAME_DEG) {
                found.push(planned);
            }
        }
        found
    }

    fn starts(&self, first: Option<&Sample>) -> Vec<Start> {
        let [(from_deg, to_deg), _] = self.drives.mount.travel_deg();
        let Some(first) = first.filter(|_| {
            matches!(self.drives.mount, Mount::AzEl { .. }) && to_deg - from_deg > TURN_DEG
        }) else {
            return vec![Start::default()];
        };
        let azimuth_deg = first.direction.azimuth_deg();
        let lowest_deg = from_deg + (azimuth_deg - from_deg).rem_euclid(TURN_DEG);
        let turns = (0..).map(|turn: u32| lowest_deg + TURN_DEG * f64::from(turn));
        turns
            .take_while(|axis_deg| *axis_deg <= to_deg)
            .map(|axis_deg| Start {
                axes_deg: [Some(axis_deg), None],
                // The slews later judge whether the axis can arrive in time.
                lead_s: f64::MAX,
                sets_out: false,
            })
            .collect()
    }

    fn is_in_beam(&self, direction: AzEl, axes_deg: [f64; 2]) -> bool {
        let deviation = if self.drives.has_elevation {
            let points = self.bounds.direction(axes_deg);
            let [azimuth, elevation] = [
                (points.azimuth - direction.azimuth).wrapped_180().abs(),
                (points.elevation - direction.elevation).abs(),
            ];
            // No direction is further away than the sum of both differences, or nearer than the
            // difference of the elevations.
            if azimuth + elevation <= self.half_beam || elevation > self.half_beam {
                return elevation <= self.half_beam;
            }
            points.separation(direction)
        } else {
            (Angle::from_degrees(axes_deg[0]) - direction.azimuth).wrapped_180().abs()
        };
        deviation <= self.half_beam
    }

    /// Returns the longest leg between any two of these places, without keep-outs, milliseconds.
    pub(super) fn widest_ms(&self, places: impl Iterator<Item = [f64; 2]>) -> i64 {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        // Round a barrier, the axes may go anywhere.
        let [(a, b), (c, d)] = self.slews.travel_deg;
        let corners = self.has_barriers().then_some([[a, c], [b, d]]);
        let corners = corners.into_iter().flatten();
        let ends = places.chain([self.park_deg]).chain(corners).fold([none; 2], |ends, place| {
            let [(a, b), (c, d)] = ends;
            let [first, second] = place;
            [(a.min(first), b.max(first)), (c.min(second), d.max(second))]
        });
        let [from_deg, to_deg] = [ends.map(|end| end.0), ends.map(|end| end.1)];
        match self.drives.mount {
            Mount::AzEl { .. } => self.straight_ms(from_deg, to_deg),
            Mount::Xy { .. } => self.by_corner_ms(from_deg, to_deg),
        }
    }

    /// Returns the time between two axis positions along the straight path, milliseconds.
    pub(super) fn straight_ms(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> i64 {
        let second = |axes: [f64; 2]| if self.drives.has_elevation { axes } else { [axes[0], 0.0] };
        (self.slews.seconds(second(from_deg), second(to_deg)) * 1000.0).ceil() as i64
    }

    /// Returns the time between two places if one axis turns after the other, milliseconds.
    fn by_corner_ms(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> i64 {
        let corner_deg = [to_deg[0], from_deg[1]];
        self.straight_ms(from_deg, corner_deg) + self.straight_ms(corner_deg, to_deg)
    }

    /// Returns `true` if an X/Y mount may dip below its minimum elevation between two positions while
    /// both axes turn; `false` for other mounts.
    fn may_dip(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> bool {
        let Mount::Xy { .. } = self.drives.mount else { return false };
        let [start, last] = [from_deg, to_deg].map(|axes| axes.map(|deg| (deg - ZENITH_DEG).abs()));
        // The sine of the elevation is the product of the cosines of both axes from the zenith, so it
        // is smallest where each axis is as far from the zenith as at its further end. If that is
        // the same end for both axes, the lowest position is that end.
        if (start[0] >= last[0]) == (start[1] >= last[1]) {
            return false;
        }
        let sine = |off_deg: [f64; 2]| off_deg.map(|deg| deg.to_radians().cos()).iter().product();
        let corner: f64 = sine([start[0].max(last[0]), start[1].max(last[1])]);
        let minimum = self.min_elevation().radians().sin();
        if corner >= minimum {
            return false;
        }
        let end: f64 = minimum.min(sine(start)).min(sine(last));
        let along_deg = if self.on_board { ALONG_DEG } else { FINEST_DEG };
        (end.asin() - corner.asin()).to_degrees() > along_deg
    }

    /// Returns the time between two axis positions at `at_ms`, round barriers; `None` if no path
    /// leads there.
    pub(super) fn leg_ms(&self, from_deg: [f64; 2], to_deg: [f64; 2], at_ms: i64) -> Option<i64> {
        self.leg_within_ms(from_deg, to_deg, at_ms, i64::MAX)
    }

    /// Does the same as [`Self::leg_ms`]; also returns `None` for a leg that takes longer than
    /// `max_ms`.
    pub(super) fn leg_within_ms(
        &self,
        from_deg: [f64; 2],
        to_deg: [f64; 2],
        at_ms: i64,
        max_ms: i64,
    ) -> Option<i64> {
        let straight_ms = self.straight_ms(from_deg, to_deg);
        // A search costs more than all other steps.
        if straight_ms > max_ms {
            return None;
        }
        let leg_ms = if self.has_barriers() {
            self.round_ms(from_deg, to_deg, at_ms, max_ms)?.max(straight_ms)
        } else if self.may_dip(from_deg, to_deg) {
            self.by_corner_ms(from_deg, to_deg)
        } else {
            straight_ms
        };
        (leg_ms <= max_ms).then_some(leg_ms)
    }

    fn round_ms(
        &self,
        from_deg: [f64; 2],
        to_deg: [f64; 2],
        time_ms: i64,
        max_ms: i64,
    ) -> Option<i64> {
        let (now, sweep) = (self.bounds.at_time(at_ms(time_ms)), Sweep::new(from_deg, to_deg));
        if now.blocks(sweep, Sweep::at_position(from_deg)).is_none() {
            return Some(0);
        }
        let limits = &self.slews;
        let max_s = max_ms as f64 / 1000.0;
        let route = detour::between_within(&now, limits, (from_deg, to_deg), max_s)?;
        let legs = route.iter().zip(route.iter().skip(1));
        let seconds: f64 = legs.map(|(start, end)| limits.seconds(*start, *end)).sum();
        Some((seconds * 1000.0).ceil() as i64)
    }
}

/// Yields places on a straight path of the axes.
fn along(from_deg: [f64; 2], to_deg: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..=STEPS).map(move |step| {
        let share = f64::from(step) / f64::from(STEPS);
        [0, 1].map(|axis: usize| {
            let [start_deg, end_deg] = [from_deg, to_deg].map(|axes| axes.get(axis).copied());
            let (start, end) = (start_deg.unwrap_or_default(), end_deg.unwrap_or_default());
            start + (end - start) * share
        })
    })
}

#[cfg(test)]
mod tests;
