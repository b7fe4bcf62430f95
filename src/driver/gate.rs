//! The one checker that every motion passes.
//!
//! Invariant: the gate owns the controller and hands out only its
//! [`Device`] side, so no other code can start a motion. A new rule, such as a
//! keep-out, is one more entry of [`RULES`].

mod rules;

use std::time::Duration;

use super::intent::Intent;
use crate::{
    astro::Angle,
    controller::{
        AntennaState, Capabilities, Device, Moment, Motion, Moves, Pointing, aimed, panel::Act,
    },
    station::{MotionLimits, Mount},
};
use rules::RULES;

/// Why a motion was not sent.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No link, or nothing was read yet.
    #[error("the position is not known")]
    PositionUnknown,
    /// The last position is too old to move by.
    #[error("the last position is {0:?} old")]
    PositionOld(Duration),
    /// The present intent does not allow it.
    #[error("not possible in {0:?}")]
    Intent(Intent),
    /// A fault forbids motion.
    #[error("a fault of the unit forbids motion")]
    Fault,
    /// The unit was not asked for its faults on this link yet.
    #[error("the faults of the unit are not known")]
    FaultsUnknown,
    /// The limit switch in that direction is set.
    #[error("the limit switch {axis}{} is set", if *plus { '+' } else { '-' })]
    Limit {
        /// Name of the axis.
        axis: &'static str,
        /// Which end.
        plus: bool,
    },
    /// Not a number, or no motion at all.
    #[error("no motion was asked for")]
    Nothing,
    /// Faster than allowed.
    #[error("{asked_deg_s} degrees a second is faster than {allowed_deg_s}")]
    TooFast {
        /// Asked for.
        asked_deg_s: f64,
        /// Allowed.
        allowed_deg_s: f64,
    },
    /// A larger step than allowed.
    #[error("a step of {asked_deg} degrees is larger than {allowed_deg}")]
    StepTooLarge {
        /// Asked for.
        asked_deg: f64,
        /// Allowed.
        allowed_deg: f64,
    },
    /// Below the lowest elevation, or beyond the zenith.
    #[error("elevation {asked_deg} is not between {lowest_deg} and 90 degrees")]
    Elevation {
        /// Asked for.
        asked_deg: f64,
        /// Lowest allowed.
        lowest_deg: f64,
    },
    /// The controller cannot do this.
    #[error("the controller cannot do this")]
    NotOffered,
    /// The angle of an axis is not known, so nothing would end its motion.
    #[error("the angle of {axis} is not known")]
    AngleUnknown {
        /// Name of the axis.
        axis: &'static str,
    },
    /// One axis at a time.
    #[error("one axis at a time")]
    OneAxis,
    /// The mount cannot point there.
    #[error("{axis} would have to go to {asked_deg} degrees, it travels {from_deg} to {to_deg}")]
    Travel {
        /// Name of the axis.
        axis: &'static str,
        /// Where it would have to go.
        asked_deg: f64,
        /// Lower end of its travel.
        from_deg: f64,
        /// Upper end of its travel.
        to_deg: f64,
    },
    /// What is special to this controller speaks against it.
    #[error("{0}")]
    Controller(&'static str),
    /// A step needs an antenna that stands.
    #[error("the antenna still moves")]
    StillMoving,
    /// A stop is under way.
    #[error("a stop is under way")]
    Stopping,
}

/// What the rules look at beside the motion itself.
struct Situation<'a> {
    state: &'a AntennaState,
    can: Capabilities,
    intent: Intent,
    stopping: bool,
    limits: MotionLimits,
    mount: Mount,
    now: Moment,
}

/// The checker and the controller behind it.
pub(super) struct Gate {
    controller: Box<dyn Moves>,
    limits: MotionLimits,
    mount: Mount,
}

impl Gate {
    pub(super) fn new(controller: Box<dyn Moves>, limits: MotionLimits, mount: Mount) -> Self {
        Self { controller, limits, mount }
    }

    /// The harmless side of the controller.
    pub(super) fn device(&mut self) -> &mut dyn Device {
        &mut *self.controller
    }

    /// What is known of the antenna.
    pub(super) fn state(&self) -> &AntennaState {
        self.controller.state()
    }

    /// Whether `motion` could start were the antenna at rest.
    pub(super) fn check(&self, motion: Motion, intent: Intent, now: Moment) -> Result<(), Refusal> {
        self.examine(motion, intent, false, now)
    }

    /// Starts `motion`, or says why not. This is the only way to move metal.
    pub(super) fn start(
        &mut self,
        motion: Motion,
        intent: Intent,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        self.examine(motion, intent, stopping, now)?;
        self.controller.start(motion);
        Ok(())
    }

    fn examine(
        &self,
        motion: Motion,
        intent: Intent,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = Situation {
            state: self.controller.state(),
            can: self.controller.capabilities(),
            intent,
            stopping,
            limits: self.limits,
            mount: self.mount,
            now,
        };
        RULES.iter().try_for_each(|rule| rule(&motion, &situation))?;
        self.controller.objection(&motion, now).map_or(Ok(()), |why| Err(Refusal::Controller(why)))
    }

    /// Does what only this make can do, or says why not.
    pub(super) fn act(
        &mut self,
        act: Act,
        moves: bool,
        intent: Intent,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        if moves {
            self.examine(Motion::Action(act.action), intent, stopping, now)?;
        }
        self.controller.act(act);
        Ok(())
    }

    /// The motion to an azimuth of the sky, with the position of the axis that is
    /// nearest. One beyond the sky that the axis has is meant as the axis counts.
    pub(super) fn nearest(&self, motion: Motion) -> Motion {
        let Motion::Position { azimuth: Some(azimuth), elevation } = motion else { return motion };
        let [(from_deg, to_deg), _] = self.mount.travel_deg();
        let asked_deg = azimuth.degrees();
        let is_of_sky = (0.0..360.0).contains(&asked_deg);
        if !is_of_sky && (from_deg..=to_deg).contains(&asked_deg) {
            return motion;
        }
        let near_deg = self.state().measured.and_then(|measured| measured.axes[0].angle_deg);
        let azimuth = Some(self.mount.axis_azimuth(azimuth, near_deg));
        Motion::Position { azimuth, elevation }
    }

    /// Where a motion to a position would end, as the device is told it.
    pub(super) fn aim(&self, motion: &Motion) -> Option<Pointing> {
        let motion = self.controller.as_told(*motion);
        let Motion::Position { azimuth, elevation } = motion else { return None };
        let measured = self.state().measured.map(|measured| measured.pointing);
        let aim = aimed(azimuth.map(Angle::wrapped_360), elevation, measured);
        Some(aim)
    }
}

#[cfg(test)]
mod tests;
