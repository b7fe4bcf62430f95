//! Feeds the watch with the motions that pass the gate and with the readings of the unit.

use std::time::Duration;

use super::{Capabilities, Gate, Motion, Mount, Sweep, way};
use crate::{
    clock::Moment,
    contract::driver::{AxisLessons, Intent},
    device::{
        Axis, Measured,
        panel::{self, Act},
    },
    driver::motion_watch::{AxisFigures, AxisReading, Foreign, Lead, MotionWatch},
};

/// Where the unit's azimuth and elevation and the angles of an X/Y mount differ by more, degrees, the
/// geometry of the station does not describe the unit.
const FITS_DEG: f64 = 1.0;
/// The axes of an X/Y mount turn by many times as much as the direction near the ends of the lower
/// axis, degrees from the zenith.
const STEEP_DEG: f64 = 80.0;
/// A reading so near to north may be on either side of it, degrees.
const NEAR_NORTH_DEG: f64 = 3.0;
const TURN_DEG: f64 = 360.0;
/// A unit applies a setting within this time.
const APPLIES_WITHIN: Duration = Duration::from_mins(1);

pub(super) fn watch(
    can: Capabilities,
    mount: Mount,
    sway_deg: f64,
    lessons: &[AxisLessons; 2],
) -> MotionWatch {
    let is_azel = matches!(mount, Mount::AzEl { .. });
    // The watch still trusts angles of an X/Y mount that the geometry misses by this much.
    let slack_deg = if is_azel { 0.0 } else { FITS_DEG };
    let figures = |wraps| AxisFigures {
        resolution_deg: can.standstill.resolution_deg,
        sway_deg,
        arrives_within_deg: can.arrives_within_deg + slack_deg,
        wraps,
    };
    MotionWatch::new([figures(is_azel), figures(false)], lessons)
}

impl Gate {
    /// A motion goes out.
    pub(super) fn watch_motion(&mut self, motion: Motion, now: Moment) {
        let leads = match motion {
            Motion::Jog { x_deg_s, y_deg_s } => [x_deg_s, y_deg_s]
                .map(|rate| (rate != 0.0).then_some(Lead::ToEnd { is_up: rate > 0.0 })),
            Motion::Step { x_deg, y_deg } => {
                [x_deg, y_deg].map(|by_deg| (by_deg != 0.0).then_some(Lead::By(by_deg)))
            }
            Motion::Position { .. } => self.leads_of_position(motion, now),
            // The unit's own words tell whether its program moves it.
            Motion::StartProgram | Motion::EnableAuto => [None; 2],
        };
        self.watch.commanded(leads, now.steady);
    }

    fn leads_of_position(&self, motion: Motion, now: Moment) -> [Option<Lead>; 2] {
        let sent_to_deg = self.sent_to(motion, now);
        let [first, second] = sent_to_deg.map(|deg| match deg {
            Some(deg) => Lead::To(deg),
            None => Lead::Anywhere,
        });
        let [turns_first, _] = self.turned_by(motion);
        let sent = self.controller.as_sent(motion);
        let Motion::Position { azimuth, .. } = sent else {
            return [Some(Lead::Anywhere); 2];
        };
        let first = match (first, azimuth) {
            (Lead::To(deg), Some(_)) if turns_first => self.ways_to(deg, now),
            (first, _) => first,
        };
        let [sends_first, sends_second] = self.turned_by(sent);
        [sends_first.then_some(first), sends_second.then_some(second)]
    }

    /// The ways of the azimuth axis to an angle, degrees as the mount counts: as it counts, over
    /// north, or either.
    fn ways_to(&self, deg: f64, now: Moment) -> Lead {
        let at_deg = self.state().measured.and_then(|measured| measured.axes[0].angle_deg);
        let is_azel = matches!(self.mount, Mount::AzEl { .. });
        let Some(at_deg) = at_deg.filter(|_| is_azel) else { return Lead::To(deg) };
        let north_deg = (at_deg + TURN_DEG / 2.0).rem_euclid(TURN_DEG) - TURN_DEG / 2.0;
        if north_deg.abs() < NEAR_NORTH_DEG {
            return Lead::EitherWay(deg);
        }
        let counted = Sweep([(at_deg.min(deg), at_deg.max(deg)), (0.0, 0.0)]);
        let start = Sweep::at_position([at_deg, 0.0]);
        let situation = self.situation(Intent::Position, false, now);
        let over_north_deg = if deg > at_deg { deg - TURN_DEG } else { deg + TURN_DEG };
        let ways = way::ways_round(true, counted, start, &situation);
        match ways {
            [Some(_), Some(_)] => Lead::EitherWay(deg),
            [Some(way), None] if way != counted => Lead::To(over_north_deg),
            [Some(_) | None, None] | [None, Some(_)] => Lead::To(deg),
        }
    }

    /// An action of the make that moves something goes out.
    pub(super) fn watch_act(&mut self, act: &Act, now: Moment) {
        let leads = match self.controller.lead_of(act) {
            panel::Lead::Nowhere => [None; 2],
            panel::Lead::To(to_deg) => to_deg.map(|deg| deg.map(Lead::To)),
            // Wherever the action leads, Azel sent it, so its motion accuses nobody.
            panel::Lead::Unseen(_) | panel::Lead::Unknown(_) => [Some(Lead::Anywhere); 2],
        };
        self.watch.commanded(leads, now.steady);
    }

    /// The unit accepted the oldest motion that was not answered.
    pub(in crate::driver) fn motion_accepted(&mut self, now: Moment) {
        self.watch.accepted(now.steady);
    }

    /// The unit refused the oldest motion that was not answered, or nobody knows what became of it.
    pub(in crate::driver) fn motion_not_accepted(&mut self) {
        self.watch.not_accepted();
    }

    /// No motion that is out will be answered.
    pub(in crate::driver) fn motions_unanswered(&mut self) {
        self.watch.not_answered();
    }

    /// The axes were proved to stand after a halt.
    pub(in crate::driver) fn motions_over(&mut self, now: Moment) {
        self.watch.proved_still(now.steady);
    }

    /// Returns the measured sway of the standing axes, degrees, at most 1; `None` until all have been
    /// measured.
    pub(in crate::driver) fn measured_sway_deg(&self) -> Option<f64> {
        self.watch.measured_sway_deg(self.variant.capabilities.axis_count())
    }

    /// Returns what the watch has learned of each axis.
    pub(in crate::driver) fn lessons(&self) -> [AxisLessons; 2] {
        self.watch.lessons()
    }

    pub(in crate::driver) fn forget_lessons(&mut self) {
        self.watch.forget_lessons();
    }

    /// Returns `true` if commands lead the axes to where they are read now, after an outage. Call it before
    /// [`Self::look_for_hands`].
    pub(in crate::driver) fn explains_position(&self) -> bool {
        let coasts_deg = self.limits.maximum_rate_deg_s * self.overrun_s;
        self.readings().is_some_and(|readings| self.watch.explains(readings, coasts_deg))
    }

    /// The axes that are outside their interval although foreign motion is not yet proved.
    pub(in crate::driver) fn suspects(&self, now: Moment) -> [bool; 2] {
        self.watch.suspects(now.steady)
    }

    /// Nobody has watched the axes for a while.
    pub(in crate::driver) fn watch_anew(&mut self) {
        self.watch.start_anew();
    }

    /// A setting is written that may change the meaning of the readings.
    pub(in crate::driver) fn readings_change(&mut self, now: Moment) {
        self.watch.opened(now.steady + APPLIES_WITHIN);
    }

    /// Looks at the last position. Returns an axis that somebody else has moved.
    pub(in crate::driver) fn look_for_hands(&mut self, now: Moment) -> Option<Foreign> {
        // The unit's program leads the axes where no command of Azel does.
        if self.state().program.is_some_and(|program| program.enabled) {
            self.watch.opened(now.steady);
        }
        let measured = self.state().measured?;
        if self.looked.replace(measured.received) == Some(measured.received) {
            return None;
        }
        // Then commands are not known in degrees of the axes, and angles accuse nobody.
        if !self.geometry_fits(&measured) {
            self.watch.opened(now.steady);
        }
        let Some(readings) = self.readings() else {
            self.watch.start_anew();
            return None;
        };
        self.watch.take(readings)
    }

    /// The last position by axis.
    fn readings(&self) -> Option<[Option<AxisReading>; 2]> {
        let measured = self.state().measured?;
        let reading = |axis: Axis| {
            let angle_deg = axis.angle_deg.filter(|deg| deg.is_finite())?;
            let Measured { requested: asked, received, .. } = measured;
            let Axis { motion, drive, .. } = axis;
            Some(AxisReading { angle_deg, motion, drive, asked, received })
        };
        let [first, second] = measured.axes.map(reading);
        Some([first, second.filter(|_| self.variant.capabilities.has_elevation())])
    }

    /// Returns `true` if the mount of the station turns these angles into the direction that the unit
    /// reports.
    fn geometry_fits(&self, measured: &Measured) -> bool {
        if matches!(self.mount, Mount::AzEl { .. }) {
            return true;
        }
        let axes_deg = measured.axes_deg(self.variant.capabilities.has_elevation());
        let (Some(axes_deg), Some(direction)) = (axes_deg, measured.direction()) else {
            return false;
        };
        let [_, upper_deg] = axes_deg;
        let off = self.mount.direction(axes_deg).separation(direction);
        off.degrees() <= FITS_DEG && (upper_deg - 90.0).abs() <= STEEP_DEG
    }
}
