//! The one checker that every motion passes.
//!
//! Invariant: the gate owns the controller and hands out only its
//! [`Device`] side, so no other code can start a motion. A new rule, such as a
//! keep-out, is one more entry of [`RULES`].

mod program;
mod rules;
mod settings;

use std::{sync::Arc, time::Duration};

use super::intent::Intent;
use crate::{
    astro::Angle,
    controller::{
        AntennaState, Capabilities, Device, Moment, Motion, Moves, Pointing, aimed, panel::Act,
        settings::Hindrance,
    },
    plan::on_board::{Judge, Trespass},
    station::{MotionLimits, Mount},
};
use rules::RULES;

/// From one side of the zenith to the other.
const HALF_TURN: Angle = Angle::from_degrees(180.0);

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
    /// The pass that the unit is to track by itself is not known.
    #[error("the pass is not known")]
    PassUnknown,
    /// The pass does not get up to where the antenna may point.
    #[error(
        "the pass reaches {highest_deg} degrees, the antenna points no lower than {lowest_deg}"
    )]
    TooLow {
        /// Its greatest elevation.
        highest_deg: f64,
        /// The lowest elevation of the antenna.
        lowest_deg: f64,
    },
    /// The unit's own program would lead where the antenna must not point.
    #[error("the program of the unit leads to {0:?}")]
    Path(Trespass),
    /// A setting that decides where the antenna points, at a bad time.
    #[error("{field} is not set: {why}")]
    Setting {
        /// Its label.
        field: &'static str,
        /// Why not now.
        why: Hindrance,
    },
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
    /// The pass that the device's own program is started on.
    program: Option<Arc<Judge>>,
}

impl Gate {
    pub(super) fn new(controller: Box<dyn Moves>, limits: MotionLimits, mount: Mount) -> Self {
        Self { controller, limits, mount, program: None }
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
        if motion == Motion::StartProgram {
            self.program_is_clear()?;
        }
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

    /// The motion to a direction of the sky, as the axes count: the azimuth axis
    /// goes to the nearest of its positions. Where one angle is to stay, axes that
    /// are tipped over the zenith stay so. An error beyond it, where there is no sky.
    pub(super) fn nearest(&self, motion: Motion) -> Result<Motion, Refusal> {
        let Motion::Position { azimuth, elevation } = motion else { return Ok(motion) };
        if let Some(asked_deg) = elevation.map(Angle::degrees).filter(|deg| *deg > 90.0 + 1e-9) {
            let lowest_deg = self.limits.minimum_elevation_deg;
            return Err(Refusal::Elevation { asked_deg, lowest_deg });
        }
        let stays_tipped = self.is_tipped() && (azimuth.is_none() || elevation.is_none());
        let tipped = |elevation| if stays_tipped { HALF_TURN - elevation } else { elevation };
        Ok(Motion::Position {
            azimuth: azimuth.map(|azimuth| self.nearest_azimuth(azimuth, stays_tipped)),
            elevation: elevation.map(tipped),
        })
    }

    /// An azimuth beyond the sky that the axis has is meant as the axis counts.
    fn nearest_azimuth(&self, azimuth: Angle, is_tipped: bool) -> Angle {
        let [(from_deg, to_deg), _] = self.mount.travel_deg();
        let asked_deg = azimuth.degrees();
        let is_of_sky = (0.0..360.0).contains(&asked_deg);
        if !is_of_sky && (from_deg..=to_deg).contains(&asked_deg) {
            return azimuth;
        }
        let near_deg = self.state().measured.and_then(|measured| measured.axes[0].angle_deg);
        let side = if is_tipped { (azimuth + HALF_TURN).wrapped_360() } else { azimuth };
        self.mount.axis_azimuth(side, near_deg)
    }

    /// Where a motion to a position would end, as the device is told it.
    pub(super) fn aim(&self, motion: &Motion) -> Option<Pointing> {
        let motion = self.controller.as_told(*motion);
        let Motion::Position { azimuth, elevation } = motion else { return None };
        let measured = self.state().measured;
        if !self.mount.tips_over() {
            let measured = measured.map(|measured| measured.pointing);
            return Some(aimed(azimuth.map(Angle::wrapped_360), elevation, measured));
        }
        let elevation_now = self.elevation_axis_deg().map(Angle::from_degrees);
        let azimuth_now = measured.and_then(|measured| measured.axes[0].angle_deg);
        Some(Pointing::of_axes(
            azimuth.or(azimuth_now.map(Angle::from_degrees)),
            elevation.or(elevation_now),
        ))
    }

    /// Where the elevation axis was measured, degrees; `None` without one.
    fn elevation_axis_deg(&self) -> Option<f64> {
        let is_one = matches!(self.mount, Mount::AzEl { .. })
            && self.controller.capabilities().has_elevation;
        self.state().measured.filter(|_| is_one)?.axes[1].angle_deg
    }

    fn is_tipped(&self) -> bool {
        self.mount.is_tipped(self.elevation_axis_deg())
    }
}

#[cfg(test)]
mod tests;
