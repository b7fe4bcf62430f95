//! Reasons why controls of the card are locked.

use crate::{
    contract::{
        antenna::{AntennaModel, NoMotion},
        driver::{Intent, LinkState},
    },
    device::{Motion, MotionRequest, panel::Check},
    model::Model,
    ui::state_sentence::missing_angle,
};

/// Lock of all controls for moving by hand while the antenna tracks a target.
const TRACKING: &str = "Locked while tracking. Choose Manual or Position.";
const LATE: &str = "Locked: the unit answers late.";
const SILENT: &str = "Locked: the unit does not answer.";
const STANDBY: &str = "Locked in Standby. Choose Manual or Position.";

/// Reasons why controls are locked, each as a sentence.
#[derive(Default)]
pub(in crate::ui::operate) struct Locks<'a> {
    /// Reason for all controls.
    pub(in crate::ui::operate) link: Option<&'a str>,
    pub(in crate::ui::operate) jog: Option<&'a str>,
    pub(in crate::ui::operate) go_to: Option<&'a str>,
    pub(in crate::ui::operate) track: Option<&'a str>,
    /// Reason for actions of the make that move the antenna.
    pub(in crate::ui::operate) action: Option<&'a str>,
    /// Flag: only a track, besides late replies, locks moving by hand.
    pub(in crate::ui::operate) is_tracking: bool,
}

impl<'a> Locks<'a> {
    /// Returns the locks of an antenna's controls. `in_replay` is the reason in a replay, which
    /// cannot reach a unit.
    pub(in crate::ui::operate) fn new(
        model: &Model,
        antenna: &AntennaModel,
        in_replay: &'a str,
    ) -> Self {
        if model.replay.is_some() {
            let lock = Some(in_replay);
            return Self {
                link: lock,
                jog: lock,
                go_to: lock,
                track: lock,
                action: lock,
                is_tracking: false,
            };
        }
        let snapshot = &antenna.snapshot;
        let intent = snapshot.intent;
        let program = snapshot.state.program.is_some_and(|program| program.enabled);
        let link = match snapshot.link {
            LinkState::Off => Some("Locked: not connected."),
            LinkState::Up { .. } | LinkState::Stale { .. } => None,
            LinkState::Connecting { .. } | LinkState::Lost { .. } => Some(SILENT),
        };
        let fault = fault(antenna);
        let maintenance =
            snapshot.lock_out.is_some().then_some("Locked: the unit is in maintenance.");
        let link = maintenance.or(link);
        let to_position = Motion::Position { azimuth: None, elevation: None };
        let motion_lock = |motion| no_motion(model, antenna, motion);
        let jog_hindrance =
            link.or(motion_lock(Motion::Jog { x_deg_s: 0.0, y_deg_s: 0.0 })).or(fault);
        let position_hindrance = link.or(motion_lock(to_position)).or(fault);
        let jog = match intent {
            _ if program => Some(TRACKING),
            Intent::Manual => None,
            Intent::Track => Some(TRACKING),
            Intent::Standby => Some(STANDBY),
            Intent::Position | Intent::Park => Some("Jog is locked. Choose Manual."),
        };
        let go_to = match intent {
            _ if program => Some(TRACKING),
            Intent::Position | Intent::Park | Intent::Manual => None,
            Intent::Track => Some(TRACKING),
            Intent::Standby => Some(STANDBY),
        };
        let action = match intent {
            Intent::Manual | Intent::Position => None,
            Intent::Standby | Intent::Track | Intent::Park => {
                Some("Motion is locked. Choose Manual or Position.")
            }
        };
        let direction_lock = no_direction(antenna);
        // A late reply must not change the layout of the card.
        let is_tracking = link.or(fault).is_none() && [jog, go_to] == [Some(TRACKING); 2];
        Self {
            link,
            jog: jog_hindrance.or(jog),
            go_to: position_hindrance.or(direction_lock).or(go_to),
            track: position_hindrance.or(direction_lock),
            action: position_hindrance.or(action),
            is_tracking,
        }
    }
}

/// Returns the reason, by the age of the position, why Azel does not offer this motion.
fn no_motion(model: &Model, antenna: &AntennaModel, motion: Motion) -> Option<&'static str> {
    let reason = antenna.no_motion(&MotionRequest::Motion(motion), model.steady)?;
    Some(match reason {
        NoMotion::Unread => "Locked: the position is not read yet.",
        NoMotion::Late => LATE,
        NoMotion::Silent => SILENT,
    })
}

/// Returns the reason why the unit locks motion, if it does.
fn fault(antenna: &AntennaModel) -> Option<&'static str> {
    let state = &antenna.snapshot.state;
    if state.motion_lock != Some(true) {
        return None;
    }
    let is_named = state.checks.iter().any(Check::forbids_motion);
    // Without checks, the card has no section that names faults.
    Some(match (is_named, !state.checks.is_empty()) {
        (true, _) => "Locked by a fault. See Faults.",
        (false, false) => "Locked by the unit. See what it reports.",
        // The unit reports a fault, but its list of faults has not arrived.
        (false, true) if antenna.is_live() => "Locked: the unit reports a fault without naming it.",
        (false, true) => LATE,
    })
}

/// Returns the reason why Azel cannot send the antenna to any direction.
fn no_direction(antenna: &AntennaModel) -> Option<&'static str> {
    let capabilities = antenna.variant().capabilities;
    if !capabilities.takes_positions {
        return (!capabilities.has_program)
            .then_some("This controller cannot be sent to a direction.");
    }
    missing_angle(antenna)
}
