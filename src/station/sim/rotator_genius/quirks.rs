//! Switchable oddities of units, and failures.

use crate::protocol::rotator_genius::RotatorNumber;
use crate::sim::names::named;

/// Deviation of a unit from the recorded units, or of the document from itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quirk {
    /// The status has 64 bytes with leading zeros, as in the document's example.
    Narrow,
    /// The limit byte is `0` or `1`, as the document says. Recorded units send a zero byte
    /// inside the limits.
    LimitAscii,
    /// The limit byte is 0x01 outside the limits; nobody has recorded it.
    LimitBinary,
    /// "Active" is `0`, as in the document's example.
    Active0,
    /// The reply to a go-to repeats the target, as in the document's list.
    GoToReply6,
    /// The unit reads each segment separately: numbers may be short, and an incomplete command is
    /// dropped.
    Segment,
    /// A configuration may lack the name, as in the document's example.
    Config12,
    /// The unit answers an unknown command with its letter and `F`.
    UnknownFails,
}

impl Quirk {
    pub const ALL: [(Self, &'static str); 8] = [
        (Self::Narrow, "narrow"),
        (Self::LimitAscii, "limit_ascii"),
        (Self::LimitBinary, "limit_binary"),
        (Self::Active0, "active=0"),
        (Self::GoToReply6, "goto_reply=6"),
        (Self::Segment, "segment"),
        (Self::Config12, "config=12"),
        (Self::UnknownFails, "unknown_fails"),
    ];
}

/// Failure of the unit or its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// No reply comes, but the unit carries out requests.
    Silence,
    /// Every third reply is lost; its request was carried out.
    DropReply,
    /// The connection ends instead of every third reply.
    HangUp,
    /// Noise precedes each reply.
    Garbage,
    /// Replies come in pieces.
    Split,
    /// Replies are collected and sent together.
    Merge,
    /// The unit refuses every command except queries and stop.
    Refuse,
    /// "Panic" is 0x07. The document does not list the codes.
    Panic,
    /// The reported angles do not change.
    FrozenAngles,
    /// Both rotators are always reported at rest.
    FalseRest,
    /// The sensor of this rotator is not connected.
    NoSensor(RotatorNumber),
    /// The drive of this rotator runs, but the rotator does not turn.
    Stuck(RotatorNumber),
    /// The drives of the rotators are swapped: each order turns the other rotator.
    CrossedDrives,
}

impl Fault {
    pub const ALL: [(Self, &'static str); 15] = [
        (Self::Silence, "silence"),
        (Self::DropReply, "drop_reply"),
        (Self::HangUp, "hang_up"),
        (Self::Garbage, "garbage"),
        (Self::Split, "split"),
        (Self::Merge, "merge"),
        (Self::Refuse, "refuse"),
        (Self::Panic, "panic"),
        (Self::FrozenAngles, "frozen_angles"),
        (Self::FalseRest, "false_rest"),
        (Self::NoSensor(RotatorNumber::One), "no_sensor_1"),
        (Self::NoSensor(RotatorNumber::Two), "no_sensor_2"),
        (Self::Stuck(RotatorNumber::One), "stuck_1"),
        (Self::Stuck(RotatorNumber::Two), "stuck_2"),
        (Self::CrossedDrives, "crossed_drives"),
    ];
}

named!(Quirk is "quirk", Fault is "fault");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::names::assert_read_back;

    #[test]
    fn names_are_read_back_and_wrong_ones_are_answered_with_the_list() {
        assert_read_back(&Quirk::ALL);
        assert_read_back(&Fault::ALL);
    }
}
