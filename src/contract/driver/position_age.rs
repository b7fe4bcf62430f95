//! The age up to which a position serves a motion.

use std::time::Duration;

use super::Refusal;
use crate::{
    clock::Instant,
    device::{AntennaState, Measured, Motion, MotionRequest},
};

/// A jog or step needs a position younger than this.
const FRESH: Duration = Duration::from_secs(1);
/// Other motions need a position younger than this.
const RECENT: Duration = Duration::from_secs(5);

/// Returns the position that `motion` would start from, or the reason why the gate refuses it. The
/// controls of a client are locked by the same judgement.
///
/// # Errors
/// Returns a refusal if no position was read on the present link, or the last one is too old.
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
