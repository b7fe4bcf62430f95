//! The table of commands: the nature of each command, and the states in which Azel accepts it. All
//! code that depends on the kind of a command reads its row here. No command compiles without a
//! row.

use crate::driver::Command;

/// Row of a command in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    pub effect: Effect,
    pub offline: Offline,
    pub locked_out: LockedOut,
    /// A replay of the record accepts the command, because the command changes nothing.
    pub in_replay: bool,
    /// A closing station accepts the command.
    pub while_closing: bool,
    /// Parties that lose control of the antenna to the operator who gives the command.
    pub takes_control: TakesControl,
    /// A later STOP voids the command while the command waits in any queue.
    pub void_after_stop: bool,
    /// Only the operator at the station's own machine may give the command.
    pub only_here: bool,
}

/// Effect of a command on the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Motion of the antenna, now or later.
    Moves,
    /// End of a motion, or prevention of one.
    Stops,
    /// Change of the safety of people and antenna: a lock-out, a permission or an owed STOP.
    ChangesSafety,
    /// Any other change.
    Changes,
    /// Request for information only.
    Looks,
}

/// Effect of an operator's command on the party in control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TakesControl {
    /// Any other party loses control, and automatic operation is suspended.
    FromAll,
    /// A program on the network loses control. Automatic operation goes on.
    FromClients,
    /// No party loses control.
    Never,
}

/// Handling of a command to an antenna without a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Offline {
    /// The session carries the command out without contact to the unit.
    CarriedOut,
    /// The session ends the current motion, owes STOP for it, and refuses the command.
    EndsMotion,
    /// The session refuses the command.
    Refused,
    /// The session drops the command, because the state of the link already shows the reason.
    Dropped,
}

/// Handling of a command to an antenna that is locked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LockedOut {
    Taken,
    /// The session refuses the command.
    Refused,
    /// The gate or the controller refuses the command, and shows the refusal where the operator
    /// gave it.
    RefusedAtTheGate,
    /// The session accepts the command, unless a connection would take the unit's panel from the
    /// person who works on it.
    TakesPanel,
}

impl Row {
    /// Row of commands that may move the antenna.
    const MOVES: Self = Self {
        effect: Effect::Moves,
        offline: Offline::EndsMotion,
        locked_out: LockedOut::Refused,
        in_replay: false,
        while_closing: false,
        takes_control: TakesControl::FromAll,
        void_after_stop: true,
        only_here: false,
    };
    /// Row of commands that end a motion.
    const STOPS: Self = Self {
        effect: Effect::Stops,
        offline: Offline::CarriedOut,
        locked_out: LockedOut::Taken,
        while_closing: true,
        ..Self::MOVES
    };
    /// Row of commands that move nothing themselves.
    const CHANGES: Self =
        Self { effect: Effect::Changes, takes_control: TakesControl::Never, ..Self::STOPS };
    const LOOKS: Self = Self {
        effect: Effect::Looks,
        offline: Offline::Dropped,
        in_replay: true,
        void_after_stop: false,
        ..Self::CHANGES
    };

    /// Row of station commands that concern no motion.
    pub const OF_STATION: Self = Self { void_after_stop: false, ..Self::CHANGES };
    /// Row of station commands that only request information.
    pub const STATION_LOOKS: Self = Self::LOOKS;
    /// Row of station commands that make antennas move.
    pub const STATION_MOVES: Self = Self::MOVES;
}

impl Command {
    pub fn row(&self) -> Row {
        match self {
            Self::Manual | Self::Hold => {
                let (offline, locked_out) = (Offline::EndsMotion, LockedOut::Refused);
                Row { offline, locked_out, ..Row::STOPS }
            }
            Self::Standby => Row::STOPS,
            Self::EndJog => {
                Row { takes_control: TakesControl::Never, in_replay: true, ..Row::STOPS }
            }
            Self::AutoTrack(false) => Row {
                takes_control: TakesControl::Never,
                locked_out: LockedOut::Refused,
                ..Row::STOPS
            },
            // A person at the antenna relies on the lock-out, so it takes no control, and STOP does
            // not void it.
            Self::LockOut(_) => {
                Row { takes_control: TakesControl::Never, void_after_stop: false, ..Row::STOPS }
            }
            Self::Step { .. }
            | Self::Position { .. }
            | Self::Park
            | Self::MoveAway
            | Self::Track(_)
            | Self::TakeOver
            | Self::ProgramTrack(_)
            | Self::ProgramTrackIntoSun(_) => Row::MOVES,
            Self::Jog { .. } => {
                let (offline, locked_out) = (Offline::Dropped, LockedOut::RefusedAtTheGate);
                Row { offline, locked_out, ..Row::MOVES }
            }
            Self::Resume => Row { offline: Offline::CarriedOut, ..Row::MOVES },
            Self::Offset(_) | Self::AutoTrack(true) => {
                let takes_control = TakesControl::FromClients;
                Row { offline: Offline::Refused, takes_control, ..Row::MOVES }
            }
            Self::Act(_) | Self::ActUnseen(_) => {
                let (offline, locked_out) = (Offline::Refused, LockedOut::RefusedAtTheGate);
                Row { offline, locked_out, ..Row::MOVES }
            }
            Self::AllowUnguarded | Self::AllowWayOut | Self::Unlock | Self::ForgetDrives => {
                Row { effect: Effect::ChangesSafety, ..Row::CHANGES }
            }
            Self::SeenStanding => {
                let takes_control = TakesControl::FromAll;
                Row { effect: Effect::ChangesSafety, takes_control, ..Row::CHANGES }
            }
            Self::WriteSettings(_) => {
                let (offline, locked_out) = (Offline::Refused, LockedOut::RefusedAtTheGate);
                Row { offline, locked_out, ..Row::CHANGES }
            }
            // An earlier command started the way to the target.
            Self::EndAtTarget | Self::FirstOffsets(_) => Row::CHANGES,
            Self::Connect => Row { locked_out: LockedOut::TakesPanel, ..Row::CHANGES },
            Self::Disconnect => Row { takes_control: TakesControl::FromAll, ..Row::CHANGES },
            Self::Preview(_) => Row { offline: Offline::CarriedOut, ..Row::LOOKS },
            Self::ReadGroup(_) => Row::LOOKS,
            // The question goes to the unit.
            Self::Ask(_) => Row { in_replay: false, void_after_stop: true, ..Row::LOOKS },
        }
    }
}
