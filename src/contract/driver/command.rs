//! The operator's commands to an antenna.

use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

use crate::{
    astro::{Angle, Offset, TrackOffsets},
    device::{Pointing, panel::Act, settings::Change},
    name::{self, Name},
    plan::{OnBoardPass, ProgramTrack},
    station::LockOut,
};

/// Change of the offsets of a track. The gate judges each change like a motion. A refused change
/// leaves the offsets unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum OffsetChange {
    /// Increase of one offset by this amount.
    Step(Offset),
    /// Reset of all offsets to zero.
    Zero,
    /// Undo of the last change that is still in force.
    Undo,
}

/// Command to an antenna. STOP is no such command, because it bypasses this queue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// End of every motion and track.
    Standby,
    /// Start of jogs and steps by hand; ends tracking.
    Manual,
    /// Stop at the current direction, ready for the next position; ends tracking.
    Hold,
    /// A held jog key, repeated at least every 300 ms.
    Jog {
        /// Signed rates of the two axes, degrees a second.
        rates_deg_s: [f64; 2],
    },
    /// Release of the jog key.
    EndJog,
    /// Permission for motions by hand without a dead-man, for one minute.
    AllowUnguarded,
    /// Permission for motions by hand out of a forbidden direction, for one minute.
    AllowWayOut,
    /// Motion to the nearest direction clear of the Sun.
    MoveAway,
    /// Turn of each axis by one step.
    Step {
        /// Signed steps of the two axes, degrees.
        steps_deg: [f64; 2],
    },
    /// Motion to a direction of the sky.
    Position {
        /// Target azimuth; `None` keeps the current azimuth.
        azimuth: Option<Angle>,
        /// Target elevation; `None` keeps the current elevation.
        elevation: Option<Angle>,
    },
    /// On-board track of a pass.
    Track(Box<OnBoardPass>),
    /// Takeover of a track that the unit started, without a motion. Azel must know its satellite,
    /// and the unit must point at it.
    TakeOver,
    /// Program track, even if the unit could track on board.
    ProgramTrack(Box<ProgramTrack>),
    /// Program track of a target that leads to the Sun. The operator lifts the Sun avoidance for
    /// this track only.
    ProgramTrackIntoSun(Box<ProgramTrack>),
    /// End of a program track of a fixed direction upon arrival there. A track of a moving target
    /// goes on.
    EndAtTarget,
    /// Change of the offsets of the current track.
    Offset(OffsetChange),
    /// Offsets with which the next passes of the program track begin; the current pass keeps its
    /// own.
    FirstOffsets(TrackOffsets),
    /// Resumption of a program track that waits for the operator.
    Resume,
    /// Confirmation of the operator that the antenna stands: Azel no longer owes a STOP.
    SeenStanding,
    Park,
    /// Request to judge the way to a direction without a motion, again for each position. The
    /// snapshot shows the outcome; `None` ends the judgement.
    Preview(Option<Pointing>),
    /// Request to open the link, and to keep it open.
    Connect,
    /// Request to close the link and leave the unit to others. A motion of the unit's own goes on.
    Disconnect,
    /// Action that only this make has.
    Act(Act),
    /// Action with a destination unknown to the gate, on the operator's responsibility.
    ActUnseen(Act),
    /// Switch of the unit's automatic start of tracking.
    AutoTrack(bool),
    /// Request to reread the settings group with this key.
    ReadGroup(#[serde(deserialize_with = "name::one")] Name),
    /// New values of a settings group. The outcome appears in the snapshot.
    WriteSettings(Change),
    /// Lock-out of the unit for maintenance. Azel stops any motion, and then sends the unit only
    /// questions and STOP.
    LockOut(LockOut),
    /// End of the maintenance.
    Unlock,
    /// Reset of the learned figures of the axes, because the drives have changed.
    ForgetDrives,
    /// Question to the unit; the answer appears in the wire log.
    Ask(SmolStr),
}

/// First ticket for changes that sessions make; clients use lower tickets.
pub const SESSION_TICKETS: u64 = 1 << 62;

/// Returns `true` for the ticket of a change that a session makes without a request, such as adding
/// or removing the offsets for a pass.
pub fn is_ticket_of_session(ticket: u64) -> bool {
    ticket >= SESSION_TICKETS
}
