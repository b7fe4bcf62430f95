//! Input of the watch: motions that pass the gate, and readings of the unit.

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

/// Max difference between the unit's direction and the direction of its X/Y angles, degrees. Beyond
/// it, the geometry of the station does not describe the unit.
const FITS_DEG: f64 = 1.0;
/// Angle from the zenith beyond which the axes of an X/Y mount turn much faster than the direction,
/// degrees. The ends of the lower axis are near.
const STEEP_DEG: f64 = 80.0;
/// Distance from north within which a reading may be on either side of north, degrees.
const NEAR_NORTH_DEG: f64 = 3.0;
const TURN_DEG: f64 = 360.0;
/// Max time in which a unit applies a setting.
const APPLIES_WITHIN: Duration = Duration::from_mins(1);

pub(super) fn watch(
    can: Capabilities,
    mount: Mount,
    sway_deg: f64,
    lessons: &[AxisLessons; 2],
) -> MotionWatch {
    let is_azel = matches!(mount, Mount::AzEl { .. });
    // The watch still trusts the angles of an X/Y mount within this error of the geometry.
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
    /// Informs the watch about an outgoing motion.
    pub(super) fn watch_motion(&mut self, motion: Motion, now: Moment) {
        let leads = match motion {
            Motion::Jog { x_deg_s, y_deg_s } => [x_deg_s, y_deg_s]
                .map(|rate| (rate != 0.0).then_some(Lead::ToEnd { is_up: rate > 0.0 })),
            Motion::Step { x_deg, y_deg } => {
                [x_deg, y_deg].map(|by_deg| (by_deg != 0.0).then_some(Lead::By(by_deg)))
            }
            Motion::Position { .. } => self.position_leads(motion, now),
            // The unit reports when its program moves the axes.
            Motion::StartProgram | Motion::EnableAuto => [None; 2],
        };
        self.watch.note_command(leads, now.steady);
    }

    fn position_leads(&self, motion: Motion, now: Moment) -> [Option<Lead>; 2] {
        let sent_to_deg = self.end_angles(motion, now);
        let [first, second] = sent_to_deg.map(|deg| match deg {
            Some(deg) => Lead::To(deg),
            None => Lead::Anywhere,
        });
        let [turns_first, _] = self.moved_axes(motion);
        let sent = self.controller.as_sent(motion);
        let Motion::Position { azimuth, .. } = sent else {
            return [Some(Lead::Anywhere); 2];
        };
        let first = match (first, azimuth) {
            (Lead::To(deg), Some(_)) if turns_first => self.azimuth_lead(deg, now),
            (first, _) => first,
        };
        let [sends_first, sends_second] = self.moved_axes(sent);
        [sends_first.then_some(first), sends_second.then_some(second)]
    }

    /// Returns the possible paths of the azimuth axis to an angle, degrees as the mount counts:
    /// direct, over north, or either.
    fn azimuth_lead(&self, deg: f64, now: Moment) -> Lead {
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

    /// Informs the watch about an outgoing action of the make that moves an axis.
    pub(super) fn watch_act(&mut self, act: &Act, now: Moment) {
        let leads = match self.controller.lead_of(act) {
            panel::Lead::Nowhere => [None; 2],
            panel::Lead::To(to_deg) => to_deg.map(|deg| deg.map(Lead::To)),
            // Azel sent the action, so its motion is no evidence against another operator.
            panel::Lead::Unseen(_) | panel::Lead::Unknown(_) => [Some(Lead::Anywhere); 2],
        };
        self.watch.note_command(leads, now.steady);
    }

    /// Records that the unit accepted the oldest unanswered motion.
    pub(in crate::driver) fn note_acceptance(&mut self, now: Moment) {
        self.watch.note_acceptance(now.steady);
    }

    /// Records that the unit refused the oldest unanswered motion, or that its outcome is unknown.
    pub(in crate::driver) fn note_refusal(&mut self) {
        self.watch.note_refusal();
    }

    /// Records that the unit will answer none of the sent motions.
    pub(in crate::driver) fn note_lost_answers(&mut self) {
        self.watch.note_lost_answers();
    }

    /// Records proved standstill of the axes after a halt.
    pub(in crate::driver) fn note_standstill(&mut self, now: Moment) {
        self.watch.note_standstill(now.steady);
    }

    /// Returns the measured sway of the standing axes, degrees, at most 1; `None` until all have
    /// been measured.
    pub(in crate::driver) fn measured_sway_deg(&self) -> Option<f64> {
        self.watch.measured_sway_deg(self.variant.capabilities.axis_count())
    }

    /// Returns the lessons of the watch about each axis.
    pub(in crate::driver) fn lessons(&self) -> [AxisLessons; 2] {
        self.watch.lessons()
    }

    pub(in crate::driver) fn forget_lessons(&mut self) {
        self.watch.forget_lessons();
    }

    /// Returns `true` if commands explain the current axis readings after an outage. Call this
    /// before [`Self::look_for_hands`].
    pub(in crate::driver) fn explains_position(&self) -> bool {
        let coasts_deg = self.limits.maximum_rate_deg_s * self.overrun_s;
        self.readings().is_some_and(|readings| self.watch.explains(readings, coasts_deg))
    }

    /// Returns the axes that are outside their interval although foreign motion is not yet proved.
    pub(in crate::driver) fn suspects(&self, now: Moment) -> [bool; 2] {
        self.watch.suspects(now.steady)
    }

    /// Restarts the watch after a time without readings.
    pub(in crate::driver) fn restart_watch(&mut self) {
        self.watch.restart();
    }

    /// Informs the watch about a written setting that may change the meaning of the readings.
    pub(in crate::driver) fn readings_change(&mut self, now: Moment) {
        self.watch.open(now.steady + APPLIES_WITHIN);
    }

    /// Checks the last position. Returns an axis that somebody else has moved.
    pub(in crate::driver) fn look_for_hands(&mut self, now: Moment) -> Option<Foreign> {
        // The unit's program moves the axes without commands of Azel.
        if self.state().program.is_some_and(|program| program.enabled) {
            self.watch.open(now.steady);
        }
        let measured = self.state().measured?;
        if self.looked.replace(measured.received) == Some(measured.received) {
            return None;
        }
        // Azel then does not know the commands in axis degrees, so angles prove no foreign motion.
        if !self.geometry_fits(&measured) {
            self.watch.open(now.steady);
        }
        let Some(readings) = self.readings() else {
            self.watch.restart();
            return None;
        };
        self.watch.take(readings)
    }

    /// Returns the last position of each axis.
    fn readings(&self) -> Option<[Option<AxisReading>; 2]> {
        let measured = self.state().measured?;
        let reading = |axis: Axis| {
            let angle_deg = axis.angle_deg.filter(|deg| deg.is_finite())?;
            let Measured { requested, received, .. } = measured;
            let Axis { motion, drive, .. } = axis;
            Some(AxisReading { angle_deg, motion, drive, requested, received })
        };
        let [first, second] = measured.axes.map(reading);
        Some([first, second.filter(|_| self.variant.capabilities.has_elevation())])
    }

    /// Returns `true` if the mount of the station turns these angles into the direction that the
    /// unit reports.
    fn geometry_fits(&self, measured: &Measured) -> bool {
        if matches!(self.mount, Mount::AzEl { .. }) {
            return true;
        }
        let axes_deg = measured.axes_deg(self.variant.capabilities.has_elevation());
        let (Some(axes_deg), Some(direction)) = (axes_deg, measured.direction()) else {
            return false;
        };
        let [_, upper_deg] = axes_deg;
        let deviation = self.mount.direction(axes_deg).separation(direction);
        deviation.degrees() <= FITS_DEG && (upper_deg - 90.0).abs() <= STEEP_DEG
    }
}
