//! Switchable oddities of firmware and wiring, and failures.

use crate::protocol::rc2000c::Alarm;
use crate::sim::names::named;

/// Difference of a unit or its line from the plainest case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quirk {
    /// The display, and so the status, shows angles instead of counts.
    AngleDisplay,
    /// The unit has a rotating feed instead of a polarotor.
    RotatingFeed,
    /// The unit is an RC2000A, without track mode and receiver.
    Rc2000a,
    /// The reply to the device type query has a wrong command code.
    TypeCode,
    /// The unit does not answer a malformed command, as in appendix D.
    SilentRefusal,
    /// Limit words stand at the left of their fields.
    LeftWords,
    /// The unit refuses a jog into the limit at which the axis rests.
    RefuseAtLimit,
    /// A stop does not end an auto move.
    StopSparesAutoMove,
    /// A stop or a jog does not end the track mode.
    StopSparesTracking,
    /// The line adapter echoes the client's bytes.
    Echo,
    /// The serial server uses eight bits, and the eighth carries even parity.
    ParityBit,
}

impl Quirk {
    pub const ALL: [(Self, &'static str); 11] = [
        (Self::AngleDisplay, "angle_display"),
        (Self::RotatingFeed, "rotating_feed"),
        (Self::Rc2000a, "rc2000a"),
        (Self::TypeCode, "type_code"),
        (Self::SilentRefusal, "silent_refusal"),
        (Self::LeftWords, "left_words"),
        (Self::RefuseAtLimit, "refuse_at_limit"),
        (Self::StopSparesAutoMove, "stop_spares_auto_move"),
        (Self::StopSparesTracking, "stop_spares_tracking"),
        (Self::Echo, "echo"),
        (Self::ParityBit, "parity_bit"),
    ];
}

/// Failure of the unit or its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// No reply comes, but the unit carries out commands.
    Silence,
    /// Every third reply is lost; its command was carried out.
    DropReply,
    /// Noise precedes each reply.
    Garbage,
    /// Replies come in pieces.
    Split,
    /// Replies are collected and sent together.
    Merge,
    /// One bit of every third reply is wrong.
    BitError,
    /// Every third reply breaks off in the middle.
    Truncate,
    /// The configuration disables commands: every reply says offline.
    RemoteDisabled,
    /// The unit refuses every command except queries.
    Refuse,
    /// The azimuth cannot be turned.
    AzimuthJam,
    /// The elevation cannot be turned.
    ElevationJam,
    /// The azimuth turns without a command.
    AzimuthRunaway,
    /// The elevation turns without a command.
    ElevationRunaway,
    /// The azimuth drive takes too much current.
    AzimuthOvercurrent,
    /// The elevation drive takes too much current.
    ElevationOvercurrent,
    /// The track mode finds its peak at a limit.
    PeakLimit,
    /// The reported angles do not change.
    FrozenAngles,
    /// Both axes are always reported at rest.
    FalseRest,
    /// The unit shows this alarm.
    Alarm(Alarm),
}

impl Fault {
    pub const ALL: [(Self, &'static str); 38] = [
        (Self::Silence, "silence"),
        (Self::DropReply, "drop_reply"),
        (Self::Garbage, "garbage"),
        (Self::Split, "split"),
        (Self::Merge, "merge"),
        (Self::BitError, "bit_error"),
        (Self::Truncate, "truncate"),
        (Self::RemoteDisabled, "remote_disabled"),
        (Self::Refuse, "refuse"),
        (Self::AzimuthJam, "az_jam"),
        (Self::ElevationJam, "el_jam"),
        (Self::AzimuthRunaway, "az_runaway"),
        (Self::ElevationRunaway, "el_runaway"),
        (Self::AzimuthOvercurrent, "az_overcurrent"),
        (Self::ElevationOvercurrent, "el_overcurrent"),
        (Self::PeakLimit, "peak_limit"),
        (Self::FrozenAngles, "frozen_angles"),
        (Self::FalseRest, "false_rest"),
        (Self::Alarm(Alarm::LowBattery), "low_battery"),
        (Self::Alarm(Alarm::Azimuth), "az_alarm"),
        (Self::Alarm(Alarm::Elevation), "el_alarm"),
        (Self::Alarm(Alarm::AzimuthCount), "az_count"),
        (Self::Alarm(Alarm::ElevationCount), "el_count"),
        (Self::Alarm(Alarm::AzimuthLimits), "az_limits"),
        (Self::Alarm(Alarm::ElevationLimits), "el_limits"),
        (Self::Alarm(Alarm::AutoPolarizationData), "autopol_data"),
        (Self::Alarm(Alarm::SimultaneousAxes), "simultaneous_axes"),
        (Self::Alarm(Alarm::AzimuthSlowSpeed), "az_slow_speed"),
        (Self::Alarm(Alarm::ElevationSlowSpeed), "el_slow_speed"),
        (Self::Alarm(Alarm::SerialPortData), "serial_port_data"),
        (Self::Alarm(Alarm::GeoElevationPosition), "geo_position"),
        (Self::Alarm(Alarm::TrackConfiguration), "track_configuration"),
        (Self::Alarm(Alarm::AntennaReceiver), "antenna_receiver"),
        (Self::Alarm(Alarm::TimeOrDate), "time_or_date"),
        (Self::Alarm(Alarm::AngleDisplay), "angle_display_data"),
        (Self::Alarm(Alarm::PolarizationOptions), "pol_options"),
        (Self::Alarm(Alarm::Polarization), "pol_alarm"),
        (Self::Alarm(Alarm::AxisOptions), "axis_options"),
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
    fn every_alarm_can_be_switched_on() {
        for alarm in Alarm::ALL.into_iter().skip(1) {
            assert!(Fault::ALL.iter().any(|(fault, _)| *fault == Fault::Alarm(alarm)));
        }
    }
}
