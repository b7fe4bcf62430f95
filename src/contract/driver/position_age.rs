//! Max age of a position as the start of a motion.

use std::time::Duration;

use super::Refusal;
use crate::{
    clock::Instant,
    device::{AntennaState, Measured, Motion, MotionRequest},
};

/// Max age of the position for a jog or step.
const FRESH: Duration = Duration::from_secs(1);
/// Max age of the position for other motions.
const RECENT: Duration = Duration::from_secs(5);

/// Returns the position that `motion` would start from, or the refusal of the gate. The same
/// judgement locks a client's controls.
///
/// # Errors
/// Returns a refusal if no position was read on the current link, or if the last position is too
/// old.
pub fn position_for(
    motion: &MotionRequest,
    state: &AntennaState,
    now: Instant,
) -> Result<Measured, Refusal> {
    let measured = state.measured_on_link().ok_or(Refusal::PositionUnknown)?;
    let age = now.saturating_duration_since(measured.requested);
    let is_by_hand =
        matches!(motion, MotionRequest::Motion(Motion::Jog { .. } | Motion::Step { .. }));
    let allowed = if is_by_hand { FRESH } else { RECENT };
    if age < allowed { Ok(measured) } else { Err(Refusal::PositionOld(age)) }
}
