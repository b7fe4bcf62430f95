//! The table of commands: what each one is, and where it is taken. Everything that decides by the kind
//! of a command reads its row here, and no command compiles without one.

use crate::driver::Command;

/// The row of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    pub effect: Effect,
    pub offline: Offline,
    pub locked_out: LockedOut,
    /// A replay of the record takes it, because it changes nothing.
    pub in_replay: bool,
    /// A station that is closing takes it.
    pub while_closing: bool,
    /// Parties that lose control of the antenna to the operator who gives it.
    pub takes_control: TakesControl,
    /// A STOP that is pressed later voids it, wherever it still waits.
    pub void_after_stop: bool,
}

/// Effect of a command on the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// It may move the antenna, now or later.
    Moves,
    /// It ends a motion, or keeps one from beginning.
    Stops,
    /// It changes what keeps people and the antenna safe: a lock-out, a permission, an owed STOP.
    ChangesSafety,
    /// It changes something else.
    Changes,
    /// It only asks to be shown something.
    Looks,
}

/// Effect of an operator's command on the party in control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TakesControl {
    /// Any other party loses control; automatic operation is suspended.
    FromAll,
    /// A program on the network loses control. Automatic operation goes on with the command.
    FromClients,
    /// Control stays where it is.
    Never,
}

/// Handling of a command to an antenna without a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Offline {
    /// Carried out, without a word to the unit.
    CarriedOut,
    /// It ends the present motion, for which STOP is owed, and is refused itself.
    EndsMotion,
    /// Refused.
    Refused,
    /// Dropped: the link itself shows why.
    Dropped,
}

/// Handling of a command to an antenna that is locked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LockedOut {
    Taken,
    /// Refused by the session.
    Refused,
    /// Refused by the gate or the controller, which show it where it was asked for.
    RefusedAtTheGate,
    /// Taken unless a connection would take the unit's panel from the person who works on it.
    TakesPanel,
}

impl Row {
    /// A command that may move the antenna.
    const MOVES: Self = Self {
        effect: Effect::Moves,
        offline: Offline::EndsMotion,
        locked_out: LockedOut::Refused,
        in_replay: false,
        while_closing: false,
        takes_control: TakesControl::FromAll,
        void_after_stop: true,
    };
    /// A command that ends a motion.
    const STOPS: Self = Self {
        effect: Effect::Stops,
        offline: Offline::CarriedOut,
        locked_out: LockedOut::Taken,
        while_closing: true,
        ..Self::MOVES
    };
    /// A command that does not itself move anything.
    const CHANGES: Self =
        Self { effect: Effect::Changes, takes_control: TakesControl::Never, ..Self::STOPS };
    const LOOKS: Self = Self {
        effect: Effect::Looks,
        offline: Offline::Dropped,
        in_replay: true,
        void_after_stop: false,
        ..Self::CHANGES
    };

    /// A command of the station that concerns no motion.
    pub const OF_STATION: Self = Self { void_after_stop: false, ..Self::CHANGES };
    /// A command of the station that only asks to be shown something.
    pub const STATION_LOOKS: Self = Self::LOOKS;
    /// A command of the station that makes antennas move.
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
            // A person at the antenna relies on it.
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
            // The way to the target was commanded before.
            Self::EndAtTarget | Self::FirstOffsets(_) => Row::CHANGES,
            Self::Connect => Row { locked_out: LockedOut::TakesPanel, ..Row::CHANGES },
            Self::Disconnect => Row { takes_control: TakesControl::FromAll, ..Row::CHANGES },
            Self::Preview(_) => Row { offline: Offline::CarriedOut, ..Row::LOOKS },
            Self::ReadGroup(_) => Row::LOOKS,
            // It goes to the unit.
            Self::Ask(_) => Row { in_replay: false, void_after_stop: true, ..Row::LOOKS },
        }
    }
}
