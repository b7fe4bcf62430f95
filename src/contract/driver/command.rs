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

/// A change of the offsets of a track. Each is judged like a motion; one that is refused leaves
/// them as they were.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum OffsetChange {
    /// One of them grows by this much.
    Step(Offset),
    /// All of them end.
    Zero,
    /// Back to those before the last change that was not undone.
    Undo,
}

/// A command to an antenna. STOP is not one: it bypasses this queue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// End whatever runs; nothing is to move.
    Standby,
    /// Jog and step by hand; ends tracking.
    Manual,
    /// Stay here, ready to be sent to a direction; ends tracking.
    Hold,
    /// A jog key is held. Repeated at least every 300 ms.
    Jog {
        /// Signed rates of the two axes, degrees a second.
        rates_deg_s: [f64; 2],
    },
    /// The jog key was released.
    EndJog,
    /// For a minute, allow motions by hand without a dead-man.
    AllowUnguarded,
    /// For a minute, allow motions by hand out of a forbidden direction.
    AllowWayOut,
    /// Go to the nearest direction clear of the Sun.
    MoveAway,
    /// Turn each axis by one step.
    Step {
        /// Signed, degrees.
        steps_deg: [f64; 2],
    },
    /// Go to a direction of the sky.
    Position {
        /// `None` leaves it as it is.
        azimuth: Option<Angle>,
        /// `None` leaves it as it is.
        elevation: Option<Angle>,
    },
    /// Let the unit track a pass on board.
    Track(Box<OnBoardPass>),
    /// Take over the track that the unit runs by itself, without a motion. Its satellite must
    /// be known here, and the unit must point at it.
    TakeOver,
    /// Program track, also with a unit that could track on board.
    ProgramTrack(Box<ProgramTrack>),
    /// Program track of a target that leads to the Sun: the operator lifts the Sun avoidance
    /// for this track alone.
    ProgramTrackIntoSun(Box<ProgramTrack>),
    /// Go to the target of a program track of a fixed direction, and end the track there. A track
    /// of anything that moves goes on.
    EndAtTarget,
    /// Change the offsets of the track that runs.
    Offset(OffsetChange),
    /// Begin the next passes of the program track with these offsets; the present ones stay.
    FirstOffsets(TrackOffsets),
    /// Resume a program track that waits for the operator.
    Resume,
    /// The operator has seen that the antenna stands: no STOP is owed any more.
    SeenStanding,
    Park,
    /// Judge the way to a direction, anew with each position, without a motion; `None` ends
    /// that. The snapshot shows what was found.
    Preview(Option<Pointing>),
    /// Open the link, and keep it open.
    Connect,
    /// Close the link and leave the unit to others. A motion of its own goes on.
    Disconnect,
    /// An action that only this make has.
    Act(Act),
    /// An action whose lead the gate does not know, on the operator's responsibility.
    ActUnseen(Act),
    /// Switch the unit's automatic start of tracking on or off.
    AutoTrack(bool),
    /// Read the settings group with this key anew.
    ReadGroup(#[serde(deserialize_with = "name::one")] Name),
    /// Write new values of a settings group. The outcome appears in the snapshot.
    WriteSettings(Change),
    /// Lock the unit out for maintenance: it gets only questions and STOP from now on. A
    /// motion is stopped first.
    LockOut(LockOut),
    /// The maintenance is over.
    Unlock,
    /// The drives have changed: reset their learned figures.
    ForgetDrives,
    /// Send a question to the unit; the answer appears in the wire log.
    Ask(SmolStr),
}

/// Tickets from here on are those of sessions.
pub const SESSION_TICKETS: u64 = 1 << 62;

/// Returns `true` for the ticket of a change that a session makes without a request, such as adding
/// offsets for a pass and taking them back.
pub fn is_ticket_of_session(ticket: u64) -> bool {
    ticket >= SESSION_TICKETS
}
