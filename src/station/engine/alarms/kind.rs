//! Kinds of alarms: their priority, and the kinds that mean the same or replace each other.

use crate::{
    contract::{
        alarms::AlarmKind,
        driver::{Event, Found, LinkLoss, Safety},
    },
    device::panel::{Check, CheckState},
};

/// Returns `true` for an alarm about a moment rather than about a lasting state.
pub(super) fn is_momentary(kind: &AlarmKind) -> bool {
    !matches!(
        kind,
        AlarmKind::LinkLost(_)
            | AlarmKind::StopNotConfirmed
            | AlarmKind::Safety(Safety::LeftMoving { asks: true, .. } | Safety::SilentInMotion)
            | AlarmKind::Owed(_)
            | AlarmKind::AutoTrackOwed(_)
            | AlarmKind::OffsetsOwed(_)
            | AlarmKind::DriverStands(_)
            | AlarmKind::StationStands(_)
            | AlarmKind::StationElsewhere(_)
            | AlarmKind::UnitElsewhere(_)
            | AlarmKind::BrokeOff(_)
            | AlarmKind::SourceSetAside(_)
            | AlarmKind::SourceFails { .. }
            | AlarmKind::ElementsOld { .. }
            | AlarmKind::ElementsNotUploaded { .. }
            | AlarmKind::LockOutUnproved
            | AlarmKind::LockOuts(_)
            | AlarmKind::Check(_)
            | AlarmKind::ClockOff(_)
            | AlarmKind::OffTarget { .. }
            | AlarmKind::OffsetsLeft { .. }
            | AlarmKind::UnitDiffers(_)
            | AlarmKind::NotCompared { .. }
            | AlarmKind::LosesPositions
            | AlarmKind::NoAntennaFor { .. }
            | AlarmKind::NotOnItsWay { .. }
            | AlarmKind::AutomaticMoves { .. }
            | AlarmKind::AutomaticOff(_)
            | AlarmKind::AutomaticSuspended(_)
            | AlarmKind::ClockNotSet
            | AlarmKind::Unreadable(_)
            | AlarmKind::Setting(_)
            | AlarmKind::SafetySetting { .. }
            | AlarmKind::Settings(_)
            | AlarmKind::Elements(_)
            | AlarmKind::NoRecord(_)
    )
}

/// Returns the new kind of a standing alarm whose matter is now `present`; `None` if nothing is
/// new. An off-target alarm keeps its first error, and its cause once known.
pub(super) fn restated(standing: &AlarmKind, present: &AlarmKind) -> Option<AlarmKind> {
    match (standing, present) {
        (AlarmKind::OffTarget { deviation, cause: before }, AlarmKind::OffTarget { cause, .. }) => {
            let is_news = cause.is_some() && cause != before;
            is_news.then(|| AlarmKind::OffTarget { deviation: *deviation, cause: cause.clone() })
        }
        _ => (same_matter(standing, present) && standing != present).then(|| present.clone()),
    }
}

/// Returns `true` if two alarms are about the same matter. Ignores figures that change while the
/// matter stays.
pub(super) fn same_matter(a: &AlarmKind, b: &AlarmKind) -> bool {
    match (a, b) {
        (AlarmKind::ClockOff(_), AlarmKind::ClockOff(_))
        | (AlarmKind::LinkLost(_), AlarmKind::LinkLost(_))
        | (AlarmKind::NoRecord(_), AlarmKind::NoRecord(_))
        | (AlarmKind::DriverStands(_), AlarmKind::DriverStands(_))
        | (AlarmKind::StationStands(_), AlarmKind::StationStands(_))
        | (AlarmKind::StationElsewhere(_), AlarmKind::StationElsewhere(_))
        | (AlarmKind::UnitElsewhere(_), AlarmKind::UnitElsewhere(_))
        | (AlarmKind::OffTarget { .. }, AlarmKind::OffTarget { .. })
        | (AlarmKind::ElementsOld { .. }, AlarmKind::ElementsOld { .. })
        | (AlarmKind::ElementsNotUploaded { .. }, AlarmKind::ElementsNotUploaded { .. }) => true,
        (
            AlarmKind::Safety(Safety::ForeignHands { axis: a, .. }),
            AlarmKind::Safety(Safety::ForeignHands { axis: b, .. }),
        ) => a == b,
        (AlarmKind::SourceFails { source: a, .. }, AlarmKind::SourceFails { source: b, .. }) => {
            a == b
        }
        (AlarmKind::Check(a), AlarmKind::Check(b)) => a.name == b.name && a.state == b.state,
        (AlarmKind::UnitDiffers(a), AlarmKind::UnitDiffers(b)) => {
            std::mem::discriminant(&a.cause) == std::mem::discriminant(&b.cause)
        }
        _ => a == b,
    }
}

/// Returns `true` if `cause` contains all that `effect` says, and its reason.
pub(super) fn explains(cause: &AlarmKind, effect: &AlarmKind) -> bool {
    matches!(
        (cause, effect),
        (AlarmKind::Unreadable(_), AlarmKind::LinkLost(LinkLoss::Unreadable))
            | (AlarmKind::Safety(Safety::SilentInMotion), AlarmKind::LinkLost(_))
    )
}

/// Returns `true` if `news` says more than `standing`: a unit with an unreadable position does
/// answer, and a silent moving unit matters more than its link.
pub(super) fn replaces(news: &AlarmKind, standing: &AlarmKind) -> bool {
    matches!(
        (news, standing),
        (
            AlarmKind::Unreadable(_) | AlarmKind::Safety(Safety::SilentInMotion),
            AlarmKind::LinkLost(_)
        )
    )
}

/// Returns `true` if the check behind an alarm is gone or has another state. A unit that does not
/// report the check may still have the fault.
pub fn is_over(raised: &Check, now: &[Check]) -> bool {
    let same = now.iter().find(|check| check.name == raised.name);
    same.is_none_or(|check| check.state != raised.state && check.state != CheckState::Unknown)
}

/// Returns the alarm for an event, if it needs one.
pub fn alarm_of(event: &Event) -> Option<AlarmKind> {
    Some(match event.clone() {
        Event::LinkLost(loss) => AlarmKind::LinkLost(loss),
        Event::StopNotConfirmed => AlarmKind::StopNotConfirmed,
        Event::StopRefused(code) => AlarmKind::StopRefused(code),
        // The motion's requester sees `StoppedByFlags`, which many antennas report. The other two
        // alarms follow the snapshot's state.
        Event::Safety(matter)
            if !matches!(
                matter,
                Safety::StoppedByFlags { .. }
                    | Safety::LeftMoving { asks: true, .. }
                    | Safety::SilentInMotion
            ) =>
        {
            AlarmKind::Safety(matter)
        }
        Event::JogLeaseOver => AlarmKind::JogLeaseOver,
        Event::JogPositionOld => AlarmKind::JogPositionOld,
        Event::AutoTrackStillOn => AlarmKind::AutoTrackStillOn,
        Event::AutoStaysOn => AlarmKind::AutoStaysOn,
        Event::AutoTrackNotKnown => AlarmKind::AutoTrackNotKnown,
        Event::LockOutUnproved => AlarmKind::LockOutUnproved,
        Event::Refused(motion, code) => AlarmKind::Refused(motion, code),
        Event::Unanswered(motion) => AlarmKind::Unanswered(motion),
        Event::OffsetNotTaken(error) => AlarmKind::OffsetNotTaken(error),
        Event::CannotTrack(target, reason) => AlarmKind::CannotTrack(target, reason),
        Event::CannotProgramTrack(name, problem) => AlarmKind::CannotProgramTrack(name, problem),
        Event::TrackingEnded { completed: false } => AlarmKind::TrackingEnded,
        Event::EndedShort { .. } => AlarmKind::EndedShort,
        Event::StartedByItself | Event::Connected(Found::Tracking) => AlarmKind::StartedByItself,
        Event::Connected(Found::Moving) => AlarmKind::MovesByItself,
        Event::TrackingEnded { completed: true }
        | Event::Connected(Found::Still)
        | Event::Back { .. }
        | Event::NotSent(_)
        | Event::OffsetRefused(_)
        | Event::Safety(_)
        | Event::WouldMiss { .. }
        | Event::Tracking(_)
        | Event::Awaits { .. }
        | Event::ProgramTracks(_)
        | Event::ProgramTrackOver { .. }
        | Event::Arrived(_)
        | Event::Stopped => return None,
    })
}
