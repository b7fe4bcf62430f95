//! Real path of an antenna whose unit tracks on its own.

use jiff::Timestamp;

use super::Judge;
use crate::{
    astro::{
        Angle, AzEl, Site,
        time::{add_seconds, seconds_between},
    },
    device::{Offsets, OnBoard, UnitClock},
    orbit::Propagator,
    plan::Sample,
    station::Mount,
};

/// Max number of steps in which the error of a pass is sampled.
const LOOKS: f64 = 240.0;
/// Max time between two samples of a path that are more than [`STEP_DEG`] apart, seconds.
const STEP_S: f64 = 1.0;
/// Max angle between two samples of a path that are more than [`STEP_S`] apart, degrees.
const STEP_DEG: f64 = 0.5;
/// Max step for a target that hardly moves, seconds.
const LONGEST_STEP_S: f64 = 60.0;

/// Returns equal steps from `start` to `end`, both included.
pub(super) fn spread(start: Timestamp, end: Timestamp) -> impl Iterator<Item = Timestamp> {
    let span_s = seconds_between(start, end).max(0.0);
    let step_s = (span_s / LOOKS).max(STEP_S);
    let count = (span_s / step_s).ceil() as u32;
    (0..=count).map(move |index| add_seconds(start, (f64::from(index) * step_s).min(span_s)))
}

/// Data by which a unit tracks.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitPath<'a> {
    pub(super) propagator: &'a Propagator,
    pub(super) window: (Timestamp, Timestamp),
    pub(super) site: Site,
    pub(super) ahead_s: f64,
    pub(super) offsets: Offsets,
    /// Reported azimuth of the unit minus the real one.
    pub(super) turned: Angle,
    /// `true` for a unit that points at the apparent satellite; no unit's documentation describes
    /// this.
    pub(super) refracts: bool,
}

impl<'a> UnitPath<'a> {
    /// Returns a unit that computes exactly like Azel.
    pub(super) fn right(judge: &'a Judge) -> Self {
        let target = &judge.pass.target;
        Self {
            propagator: &judge.propagator,
            window: (target.start, target.end),
            site: judge.pass.site,
            ahead_s: 0.0,
            offsets: Offsets { minimum_elevation_deg: -90.0, ..Offsets::default() },
            turned: Angle::ZERO,
            refracts: true,
        }
    }

    /// Creates a unit with the report `on_board`. Assumes correct values where the unit reports
    /// none.
    pub(super) fn new(on_board: &OnBoard, judge: &'a Judge) -> Self {
        let right = Self::right(judge);
        let offsets = on_board.offsets.unwrap_or(right.offsets);
        Self {
            site: site(on_board, judge.pass.site).unwrap_or(right.site),
            ahead_s: on_board.clock.map_or(0.0, |clock| clock.ahead_s),
            offsets,
            turned: turned(offsets.north_deg, judge.ability.mount),
            refracts: false,
            ..right
        }
    }

    /// Creates the unit with only the certain part of its clock error: late replies make no
    /// pointing error.
    pub(super) fn surely(on_board: &OnBoard, judge: &'a Judge) -> Self {
        let ahead_s = on_board.clock.map_or(0.0, UnitClock::surely_ahead_s);
        Self { ahead_s, ..Self::new(on_board, judge) }
    }

    /// Returns the unit with either sign of the time offset, because the unit's sign convention is
    /// unknown.
    pub(super) fn either_way(self) -> impl Iterator<Item = Self> {
        let negated = Offsets { time_s: -self.offsets.time_s, ..self.offsets };
        let other = (self.offsets.time_s != 0.0).then_some(Self { offsets: negated, ..self });
        std::iter::once(self).chain(other)
    }

    /// Returns the direction of the satellite that the unit computes at `time` by Azel's clock.
    /// Outside its window, returns the direction at the nearer end of the window.
    pub(super) fn computed(&self, time: Timestamp) -> Option<AzEl> {
        let (start, stop) = self.window;
        let own = add_seconds(time, self.ahead_s).clamp(start, stop.max(start));
        let shifted = add_seconds(own, self.offsets.time_s);
        let site = if self.refracts { self.site } else { self.site.airless() };
        Some(self.propagator.look_from(site, shifted).ok()?.direction)
    }

    /// Returns the real direction of the antenna at `time` by Azel's clock.
    pub(super) fn direction(&self, time: Timestamp) -> Option<AzEl> {
        let AzEl { azimuth, elevation } = self.computed(time)?;
        let lowest = Angle::from_degrees(self.offsets.minimum_elevation_deg);
        let raised = elevation + Angle::from_degrees(self.offsets.elevation_deg);
        let raised = if raised < lowest { lowest } else { raised };
        let azimuth = azimuth + Angle::from_degrees(self.offsets.azimuth_deg);
        Some(AzEl {
            azimuth: (azimuth - self.turned).wrapped_360(),
            elevation: Angle::from_degrees(raised.degrees().min(90.0)),
        })
    }
}

/// Returns the location that a unit reports, at the altitude of `ours`. Returns `ours` if both are
/// equal to the resolution of the report.
pub(super) fn site(on_board: &OnBoard, ours: Site) -> Option<Site> {
    on_board.place?.as_site(ours)
}

/// Returns the azimuth error that a north offset makes. The offset counts from the zero of the
/// mount, which the station may know as the azimuth of the lower axis.
pub(super) fn turned(north_deg: f64, mount: Mount) -> Angle {
    let north = Angle::from_degrees(north_deg).wrapped_180();
    let Mount::Xy { lower_axis_azimuth_deg, .. } = mount else { return north };
    let turn_to = |axis_deg: f64| (north - Angle::from_degrees(axis_deg)).wrapped_180();
    let ends = [lower_axis_azimuth_deg, lower_axis_azimuth_deg + 180.0].map(turn_to);
    ends.into_iter()
        .fold(north, |min, deviation| if deviation.abs() < min.abs() { deviation } else { min })
}

/// Time at which the elements yield no direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoDirection(pub(super) Timestamp);

/// Samples the path of `unit` while its clock runs through `window`. Ends at the first sample
/// without a direction.
pub(super) fn samples(
    unit: UnitPath<'_>,
    (start, stop): (Timestamp, Timestamp),
) -> impl Iterator<Item = Result<Sample, NoDirection>> + '_ {
    let ours = |own: Timestamp| add_seconds(own, -unit.ahead_s);
    let (begin, end) = (ours(start), ours(stop));
    let span_s = seconds_between(begin, end).max(0.0);
    let sample_at = move |after_s: f64| {
        let time = add_seconds(begin, after_s);
        let direction = unit.direction(time).ok_or(NoDirection(time))?;
        Ok(Sample { time, direction })
    };
    let (mut last, mut after_s, mut step_s) = (None::<Result<Sample, _>>, 0.0, STEP_S);
    std::iter::from_fn(move || {
        let before = match last {
            None => {
                last = Some(sample_at(0.0));
                return last;
            }
            Some(Ok(before)) if after_s < span_s => before,
            Some(_) => return None,
        };
        loop {
            let next_s = (after_s + step_s).min(span_s);
            let next = sample_at(next_s);
            let way_deg =
                next.map_or(0.0, |next| before.direction.separation(next.direction).degrees());
            if way_deg > STEP_DEG && step_s > STEP_S {
                step_s = (step_s / 2.0).max(STEP_S);
                continue;
            }
            if way_deg < STEP_DEG / 4.0 {
                step_s = (step_s * 2.0).min(LONGEST_STEP_S);
            }
            (last, after_s) = (Some(next), next_s);
            return last;
        }
    })
}
