//! What one antenna can take: where its axes have to stand along a pass, and how long they take
//! from one place to another.

use jiff::Timestamp;

use super::{
    sight::{Samples, Sight},
    way::{Impossible, Lost, Span, Verdict, Way, at_ms, ms},
};
use crate::{
    astro::{Angle, AzEl},
    plan::{
        Bounds, Loss, MountLimits, Sample, Sweep, Trackability,
        az_el::{Choice, Flip, Start},
        detour,
        program_track::Drives,
        trackability,
    },
    station::{Antenna, Mount, Station},
};

/// Ways that begin less than this apart are one, degrees.
const SAME_DEG: f64 = 0.5;
/// A whole turn of an azimuth axis, degrees.
const TURN_DEG: f64 = 360.0;
/// Share of the rate of an axis below which it keeps up with few samples of a pass.
const SLOW: f64 = 0.4;
/// Elevation below which a pass may be judged by few samples, degrees.
const LOW_DEG: f64 = 75.0;

/// Mount, rates, limits and bounds of an antenna, as passes and slews need them.
#[derive(Debug, Clone)]
pub struct Reach {
    drives: Drives,
    bounds: Bounds,
    half_beam: Angle,
    park_deg: [f64; 2],
    /// Its unit follows a pass by itself, and refuses one that leads through a keep-out.
    on_board: bool,
}

impl Reach {
    /// The reach of an antenna of `station`, with the rates that its axes were measured to have.
    pub fn of(station: &Station, antenna: &Antenna, rates_deg_s: Option<[f64; 2]>) -> Self {
        let can = antenna.connection.variant().capabilities;
        let drives = Drives {
            mount: antenna.mount,
            limits: antenna.limits,
            rates_deg_s: rates_deg_s.unwrap_or([antenna.limits.maximum_rate_deg_s; 2]),
            step_deg: can.position_step_deg,
            arrives_within_deg: can.arrives_within_deg,
            has_elevation: can.has_elevation(),
        };
        let park = Sample { time: Timestamp::UNIX_EPOCH, direction: antenna.park_direction() };
        let choice = Choice::Keep(Flip::None);
        let bounds = Bounds::of(station, antenna);
        let start = Start::default();
        let parked = drives.along_within(&bounds, &[park], 1.0, start, choice).axes_deg;
        Self {
            drives,
            bounds,
            half_beam: antenna.beam_width() * 0.5,
            park_deg: parked.map(|axis| axis.first().copied().unwrap_or_default()),
            on_board: can.has_program,
        }
    }

    pub(super) fn park_deg(&self) -> [f64; 2] {
        self.park_deg
    }

    pub(super) fn has_barriers(&self) -> bool {
        self.bounds.forbid_anything()
    }

    pub(super) fn min_elevation(&self) -> Angle {
        Angle::from_degrees(self.drives.limits.minimum_elevation_deg)
    }

    /// How the antenna can take what is in sight.
    pub fn judge(&self, sight: &mut Sight<'_>) -> Verdict {
        let Some(span) = sight.above(self.min_elevation()) else {
            return Verdict::Impossible(Impossible::TooLow);
        };
        let clear = sight.clear(span);
        if clear.is_empty() {
            return Verdict::Impossible(Impossible::Hidden);
        }
        let coarse = sight.samples(span, false).clone();
        if let Some(ways) = self.easy_ways(&coarse, &clear) {
            return Verdict::Possible(ways);
        }
        let fine = sight.samples(span, true).clone();
        self.ways(&fine, &clear)
    }

    /// The ways of a pass that the axes follow without effort; `None` for one that has to be
    /// looked at more closely.
    fn easy_ways(&self, samples: &Samples, clear: &[Span]) -> Option<Vec<Way>> {
        let is_low = |it: &Sample| it.direction.elevation_deg() < LOW_DEG;
        if self.has_barriers() || !samples.list.iter().all(is_low) {
            return None;
        }
        let ways = self.planned(samples);
        let follows = |axes_deg: &[Vec<f64>; 2]| {
            let slow = axes_deg.iter().zip(self.drives.rates_deg_s).all(|(axis, rate)| {
                let max_deg = SLOW * rate * samples.step_s;
                axis.iter().zip(axis.iter().skip(1)).all(|(a, b)| (b - a).abs() < max_deg)
            });
            let places = axes_deg[0].iter().zip(&axes_deg[1]).map(|(a, b)| [*a, *b]);
            let mut pairs = samples.list.iter().zip(places);
            slow && pairs.all(|(it, axes_deg)| self.off(it.direction, axes_deg) <= self.half_beam)
        };
        ways.iter().all(follows).then(|| {
            let ways = ways.into_iter().map(|axes_deg| Way::new(samples, axes_deg, clear.to_vec()));
            ways.collect()
        })
    }

    fn ways(&self, samples: &Samples, clear: &[Span]) -> Verdict {
        let mut entered = None;
        let ways = self.planned(samples).into_iter().filter_map(|axes_deg| {
            let places = axes_deg[0].iter().zip(&axes_deg[1]).map(|(a, b)| [*a, *b]);
            let mut held: Vec<Span> = Vec::new();
            // As trackability has it, what lies between two samples is judged by the later one.
            let later = samples.list.iter().zip(places).skip(1);
            for (before, (sample, axes_deg)) in samples.list.iter().zip(later) {
                if self.has_barriers() {
                    let direction = self.bounds.direction(axes_deg);
                    if let Some(barrier) = self.bounds.at(sample.time).forbids(direction) {
                        entered = entered.take().or(Some(barrier));
                        continue;
                    }
                }
                if self.off(sample.direction, axes_deg) > self.half_beam {
                    continue;
                }
                let span = Span { from_ms: ms(before.time), to_ms: ms(sample.time) };
                match held.last_mut() {
                    Some(last) if last.to_ms == span.from_ms => last.to_ms = span.to_ms,
                    _ => held.push(span),
                }
            }
            let counted = Span::both(&held, clear);
            (!counted.is_empty()).then(|| Way::new(samples, axes_deg, counted))
        });
        let mut ways: Vec<Way> = ways.collect();
        if let Some(barrier) = entered.filter(|_| self.on_board || ways.is_empty()) {
            return Verdict::Impossible(Impossible::KeepOut(barrier));
        }
        let whole_ms: i64 = clear.iter().map(|span| span.length_ms()).sum();
        if ways.is_empty() {
            let lost = Lost { seconds: whole_ms as f64 / 1000.0, at: self.loss_at(samples) };
            return Verdict::Impossible(Impossible::Lost(lost));
        }
        ways.retain(|way| self.is_within_reach(way));
        if ways.is_empty() {
            return Verdict::Impossible(Impossible::NoWay);
        }
        for way in &mut ways {
            let lost_ms = whole_ms - way.counted_ms(way.span());
            way.lost = (lost_ms > 0)
                .then(|| Lost { seconds: lost_ms as f64 / 1000.0, at: self.loss_at(samples) });
        }
        Verdict::Possible(ways)
    }

    /// Returns `true` if ways lead from the park position to the start, and back from the end.
    fn is_within_reach(&self, way: &Way) -> bool {
        let Span { from_ms, to_ms } = way.span();
        let [from_deg, to_deg] = [from_ms, to_ms].map(|at| way.axes_deg(at));
        self.leg_ms(self.park_deg, from_deg, from_ms).is_some()
            && self.leg_ms(to_deg, self.park_deg, to_ms).is_some()
    }

    fn loss_at(&self, samples: &Samples) -> Loss {
        match (trackability(&samples.list, self.mount_limits()), self.drives.mount) {
            (Trackability::Loses { at, .. }, _) => at,
            (_, Mount::Xy { lower_axis_azimuth_deg, .. }) => {
                Loss::Keyhole(Angle::from_degrees(lower_axis_azimuth_deg))
            }
            _ => Loss::OutOfReach,
        }
    }

    fn mount_limits(&self) -> MountLimits {
        MountLimits {
            mount: self.drives.mount,
            maximum_rate_deg_s: self.drives.rates_deg_s[0].min(self.drives.rates_deg_s[1]),
            half_beam: self.half_beam,
            has_elevation: self.drives.has_elevation,
            min_elevation: self.min_elevation(),
        }
    }

    /// The positions of both axes along `samples`, one list for each turn on which the azimuth
    /// axis can begin.
    fn planned(&self, samples: &Samples) -> Vec<[Vec<f64>; 2]> {
        let mut found: Vec<[Vec<f64>; 2]> = Vec::new();
        for start in self.starts(samples.list.first()) {
            let choice = Choice::Prefer(Flip::None);
            let planned = self.drives.along_within(
                &self.bounds,
                &samples.list,
                samples.step_s,
                start,
                choice,
            );
            let first = |axes: &[Vec<f64>; 2]| axes[0].first().copied().unwrap_or_default();
            let begins_deg = first(&planned.axes_deg);
            if found.iter().all(|other| (first(other) - begins_deg).abs() > SAME_DEG) {
                found.push(planned.axes_deg);
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
            .map(|axis_deg| Start { axes_deg: [Some(axis_deg), None], lead_s: f64::MAX })
            .collect()
    }

    fn off(&self, direction: AzEl, axes_deg: [f64; 2]) -> Angle {
        if self.drives.has_elevation {
            self.bounds.direction(axes_deg).separation(direction)
        } else {
            (Angle::from_degrees(axes_deg[0]) - direction.azimuth).wrapped_180().abs()
        }
    }

    /// The longest leg between any two of these places, without detours, milliseconds.
    pub(super) fn widest_ms(&self, places: impl Iterator<Item = [f64; 2]>) -> i64 {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let ends = places.chain([self.park_deg]).fold([none; 2], |ends, place| {
            let [(a, b), (c, d)] = ends;
            let [first, second] = place;
            [(a.min(first), b.max(first)), (c.min(second), d.max(second))]
        });
        self.straight_ms(ends.map(|end| end.0), ends.map(|end| end.1))
    }

    /// Time from one place of the axes to another along the straight way, milliseconds.
    pub(super) fn straight_ms(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> i64 {
        let second = |axes: [f64; 2]| if self.drives.has_elevation { axes } else { [axes[0], 0.0] };
        let limits = self.drives.axis_limits();
        (limits.seconds(second(from_deg), second(to_deg)) * 1000.0).ceil() as i64
    }

    /// Time from one place of the axes to another at `at_ms`, round what must not be entered;
    /// `None` where no way leads.
    pub(super) fn leg_ms(&self, from_deg: [f64; 2], to_deg: [f64; 2], at: i64) -> Option<i64> {
        let straight_ms = self.straight_ms(from_deg, to_deg);
        if !self.has_barriers() {
            return Some(straight_ms);
        }
        let (at, sweep) = (at_ms(at), Sweep::between(from_deg, to_deg));
        if self.bounds.at(at).blocks(sweep, from_deg).is_none() {
            return Some(straight_ms);
        }
        let limits = self.drives.axis_limits();
        let route = detour::between(&self.bounds, &limits, from_deg, to_deg, at)?;
        let legs = route.iter().zip(route.iter().skip(1));
        let seconds: f64 = legs.map(|(from, to)| limits.seconds(*from, *to)).sum();
        Some(straight_ms.max((seconds * 1000.0).ceil() as i64))
    }
}
