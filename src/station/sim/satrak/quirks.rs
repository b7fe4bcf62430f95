//! Switchable oddities of firmware, and failures.

use crate::protocol::satrak::FaultKind;
use crate::sim::names::named;

/// Deviation of firmware from the document, or of the document from itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quirk {
    /// The form `STATUS?0,..` has no comma after the sign, as in the document's example.
    NoComma,
    /// The status has no auto-track field, as in older firmware.
    Fields15,
    /// The faults have no GPS field, as in the document's example.
    Err11,
    /// The clock has no milliseconds, as in the document's example.
    Time6,
    /// Checksums are in lower case.
    LowerHex,
    /// Lines end with LF alone.
    LfOnly,
    /// A blank stands between word and `=`, as in the document's examples.
    SpaceBeforeEq,
    /// Numbers have decimal commas, as in a Turkish locale.
    DecimalComma,
    /// Auto-track restarts in a window in which tracking was switched off.
    AutoTrackRestarts,
}

impl Quirk {
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::NoComma, "no_comma"),
        (Self::Fields15, "fields=15"),
        (Self::Err11, "err=11"),
        (Self::Time6, "time=6"),
        (Self::LowerHex, "lower_hex"),
        (Self::LfOnly, "lf_only"),
        (Self::SpaceBeforeEq, "space_before_eq"),
        (Self::DecimalComma, "decimal_comma"),
        (Self::AutoTrackRestarts, "auto_track_restarts"),
    ];
}

/// Failure of the unit or its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// An unsolicited frame follows each reply.
    Unsolicited,
    /// Every third reply is lost; its request was carried out.
    DropReply,
    /// Noise precedes each reply.
    Garbage,
    /// Replies come in pieces.
    Split,
    /// Replies are collected and sent together.
    Merge,
    /// No reply comes, but the unit carries out requests.
    Silence,
    /// Every third reply has a wrong checksum.
    BadChecksum,
    /// The unit refuses every setting.
    RefuseSettings,
    /// A change of the general settings takes effect late: its azimuth offset after 5 s, the rest
    /// after 40 s. Changes that are pending when this fault ends are lost.
    LateSettings,
    /// The unit carries out a command but closes the connection instead of answering.
    HangUp,
    /// The reported angles do not change.
    FrozenAngles,
    /// Both axes are always reported at rest.
    FalseRest,
    /// The unit has and reports this fault.
    Unit(FaultKind),
}

impl Fault {
    pub const ALL: [(Self, &'static str); 24] = [
        (Self::Unsolicited, "unsolicited"),
        (Self::DropReply, "drop_reply"),
        (Self::Garbage, "garbage"),
        (Self::Split, "split"),
        (Self::Merge, "merge"),
        (Self::Silence, "silence"),
        (Self::BadChecksum, "bad_checksum"),
        (Self::RefuseSettings, "refuse_settings"),
        (Self::LateSettings, "late_settings"),
        (Self::HangUp, "hang_up"),
        (Self::FrozenAngles, "frozen_angles"),
        (Self::FalseRest, "false_rest"),
        (Self::Unit(FaultKind::InternalLink), "internal_link"),
        (Self::Unit(FaultKind::TleOutdated), "tle_outdated"),
        (Self::Unit(FaultKind::TleMissing), "tle_missing"),
        (Self::Unit(FaultKind::SatelliteMissing), "satellite_missing"),
        (Self::Unit(FaultKind::WebTle), "web_tle"),
        (Self::Unit(FaultKind::TrackingStopped), "tracking_stopped"),
        (Self::Unit(FaultKind::Setup), "setup"),
        (Self::Unit(FaultKind::XMotor), "x_motor"),
        (Self::Unit(FaultKind::YMotor), "y_motor"),
        (Self::Unit(FaultKind::XSensor), "x_sensor"),
        (Self::Unit(FaultKind::YSensor), "y_sensor"),
        (Self::Unit(FaultKind::GpsLink), "gps"),
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

    #[test]
    fn every_fault_of_the_unit_can_be_switched_on() {
        for kind in FaultKind::ALL {
            assert!(Fault::ALL.iter().any(|(fault, _)| *fault == Fault::Unit(kind)));
        }
    }
}
