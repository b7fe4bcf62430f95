//! Alarms: events and states that the operator must not miss.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::claim::HeldBy;
use crate::{
    astro::Angle,
    device::{
        Asked, PrepareError, TrackTarget,
        panel::{Check, CheckState},
    },
    driver::{Event, Found, LinkLoss, Safety, TrackProblem, Unit},
    name::{self, Name},
    plan::on_board::Ranked,
    station::{AntennaId, Note, NoteReason},
};

/// Maximum number of alarms. Beyond it the oldest go, seen ones first.
const MAX: usize = 100;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Priority {
    /// Something will go wrong or was not done.
    Caution,
    /// Something is wrong now.
    Warning,
}

/// Kind of an alarm. The view puts it into words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum AlarmKind {
    /// No link to the antenna.
    LinkLost(LinkLoss),
    /// The antenna still moves three seconds after STOP.
    StopNotConfirmed,
    /// The unit refused STOP, with this code.
    StopRefused(String),
    /// A jog was stopped because the window or the station was too busy to renew it.
    JogLeaseOver,
    /// A jog was stopped because the position grew too old.
    JogPositionOld,
    /// The antenna has stopped, but the unit may start by itself.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// The unit is locked out, but no read-back proves that it does not start by itself.
    LockOutUnproved,
    /// The list of locked-out units could not be read or written; in words.
    LockOuts(String),
    /// The unit refused a request, with this code.
    Refused(Asked, String),
    /// The unit did not answer a request.
    Unanswered(Asked),
    /// The satellite cannot be tracked on board.
    CannotTrack(TrackTarget, PrepareError),
    /// Program track of this target cannot begin, or cannot go on.
    CannotProgramTrack(String, TrackProblem),
    /// The unit tracks on board, and not where the satellite is.
    OffTarget {
        /// Error when it was noticed.
        off: Angle,
        /// The likeliest cause.
        cause: Option<Ranked>,
    },
    /// By the unit's own settings it would miss a pass; with the likeliest cause.
    UnitDiffers(Ranked),
    /// The unit tracks on board, but its target direction is unknown here.
    NotCompared {
        /// Name of the satellite that the unit reports, without known elements; `None`
        /// where it reports none.
        satellite: Option<String>,
    },
    /// Tracking ended before LOS.
    TrackingEnded,
    /// A motion ended short of its target.
    EndedShort,
    /// The unit tracks without a request from this console.
    StartedByItself,
    /// The unit moves without a request from this console.
    MovesByItself,
    Safety(Safety),
    /// A STOP is owed to a unit that belongs to no antenna of the station.
    Owed(Unit),
    /// The thread that talks to the antennas has not responded for this long.
    DriverStands(Duration),
    /// The station's thread has published nothing new for this long; the displayed state is
    /// as old.
    StationStands(Duration),
    /// Another Azel of this machine has this station open: nothing can be driven from here.
    StationElsewhere(HeldBy),
    /// Another Azel of this machine drives this unit.
    UnitElsewhere(HeldBy),
    /// The Azel that drives an antenna did not confirm STOP.
    StopNotElsewhere,
    /// A background job of the program broke off.
    BrokeOff(Work),
    /// The source of elements with this name is not read: its last reading ended the
    /// program.
    SourceSetAside(String),
    /// The program was too busy to take a request.
    NotTaken,
    /// A fault or warning that the unit names itself.
    Check(Check),
    /// The unit's clock is this far ahead of ours, seconds.
    ClockOff(f64),
    /// The unit's clock was never set.
    ClockNotSet,
    /// The position of the unit cannot be read, for this reason.
    Unreadable(#[serde(deserialize_with = "name::one")] Name),
    /// An entry of the station file was not taken over.
    Setting(Note),
    /// Settings could not be read, written or sent; in words.
    Settings(String),
    /// The elements could not be read; in words.
    Elements(String),
}

/// Background work that can break off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    Elements,
    Passes,
}

/// One entry of the alarm list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Unique in this station.
    pub id: u64,
    /// `None` where it concerns no single antenna.
    pub antenna: Option<AntennaId>,
    pub kind: AlarmKind,
    pub time: Timestamp,
    /// The operator has acknowledged the alarm.
    pub seen: bool,
    /// The reason of the alarm is over.
    pub cleared: bool,
}

impl Alarm {
    pub fn priority(&self) -> Priority {
        match &self.kind {
            AlarmKind::LinkLost(_)
            | AlarmKind::StopNotConfirmed
            | AlarmKind::StopRefused(_)
            | AlarmKind::Safety(_)
            | AlarmKind::Owed(_)
            | AlarmKind::DriverStands(_)
            | AlarmKind::StationStands(_)
            | AlarmKind::StationElsewhere(_)
            | AlarmKind::UnitElsewhere(_)
            | AlarmKind::StopNotElsewhere
            | AlarmKind::LockOutUnproved
            | AlarmKind::LockOuts(_)
            | AlarmKind::StartedByItself
            | AlarmKind::MovesByItself
            | AlarmKind::Unreadable(_)
            | AlarmKind::JogPositionOld
            | AlarmKind::OffTarget { .. }
            | AlarmKind::Check(Check { state: CheckState::Fault, .. }) => Priority::Warning,
            AlarmKind::Setting(Note { reason: NoteReason::DoesNotHold { .. }, .. }) => {
                Priority::Warning
            }
            _ => Priority::Caution,
        }
    }
}

/// All alarms, the newest last. Clones share the list.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Alarms {
    list: Arc<Vec<Alarm>>,
    next_id: u64,
    /// An alarm has come since the list was last opened.
    pub unopened: bool,
}

impl Alarms {
    /// The newest last.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// Adds an alarm, unless the same one or one that explains it stands already. It
    /// replaces alarms that it makes obsolete.
    pub fn raise(&mut self, antenna: Option<AntennaId>, kind: AlarmKind, time: Timestamp) {
        if let AlarmKind::DriverStands(_) | AlarmKind::StationStands(_) = kind {
            let same = |alarm: &Alarm| !alarm.cleared && same_matter(&alarm.kind, &kind);
            // The duration grows while the alarm stands.
            if let Some(place) = self.list.iter().position(same) {
                if let Some(standing) = Arc::make_mut(&mut self.list).get_mut(place) {
                    standing.kind = kind;
                }
                return;
            }
        }
        let standing = self.list.iter().any(|alarm| {
            !alarm.cleared
                && alarm.antenna == antenna
                && (same_matter(&alarm.kind, &kind) || explains(&alarm.kind, &kind))
        });
        if standing {
            return;
        }
        let list = Arc::make_mut(&mut self.list);
        list.retain(|alarm| {
            alarm.cleared || alarm.antenna != antenna || !replaces(&kind, &alarm.kind)
        });
        if list.len() >= MAX {
            let oldest = list.iter().position(|alarm| alarm.seen).unwrap_or(0);
            list.remove(oldest);
        }
        list.push(Alarm { id: self.next_id, antenna, kind, time, seen: false, cleared: false });
        self.next_id += 1;
        self.unopened = true;
    }

    /// Removes alarms of antennas that the station no longer has.
    pub fn keep_only(&mut self, antennas: &[AntennaId]) {
        let is_known = |alarm: &Alarm| alarm.antenna.is_none_or(|id| antennas.contains(&id));
        if !self.list.iter().all(is_known) {
            Arc::make_mut(&mut self.list).retain(is_known);
        }
    }

    /// Clears the alarms of `antenna` for which `is_over` returns `true`.
    pub fn clear(&mut self, antenna: Option<AntennaId>, is_over: impl Fn(&AlarmKind) -> bool) {
        let ends =
            |alarm: &Alarm| alarm.antenna == antenna && !alarm.cleared && is_over(&alarm.kind);
        if !self.list.iter().any(ends) {
            return;
        }
        let list = Arc::make_mut(&mut self.list);
        for alarm in list.iter_mut().filter(|alarm| ends(alarm)) {
            alarm.cleared = true;
        }
        // Alarms that are over and seen need not stay.
        list.retain(|alarm| !(alarm.cleared && alarm.seen));
    }

    /// Marks an alarm as seen by the operator.
    pub fn acknowledge(&mut self, id: u64) {
        let list = Arc::make_mut(&mut self.list);
        for alarm in list.iter_mut() {
            if alarm.id == id {
                alarm.seen = true;
            }
        }
        list.retain(|alarm| !(alarm.seen && (alarm.cleared || alarm.kind.is_momentary())));
    }

    /// Id of the newest unseen alarm.
    pub fn newest_unseen(&self) -> Option<u64> {
        self.list.iter().rev().find(|alarm| !alarm.seen).map(|alarm| alarm.id)
    }
}

impl AlarmKind {
    /// Returns `true` for an alarm about a moment rather than about a lasting state.
    fn is_momentary(&self) -> bool {
        !matches!(
            self,
            Self::LinkLost(_)
                | Self::StopNotConfirmed
                | Self::Safety(Safety::LeftMoving { asks: true, .. } | Safety::SilentInMotion)
                | Self::Owed(_)
                | Self::DriverStands(_)
                | Self::StationStands(_)
                | Self::StationElsewhere(_)
                | Self::UnitElsewhere(_)
                | Self::BrokeOff(_)
                | Self::SourceSetAside(_)
                | Self::LockOutUnproved
                | Self::LockOuts(_)
                | Self::Check(_)
                | Self::ClockOff(_)
                | Self::OffTarget { .. }
                | Self::UnitDiffers(_)
                | Self::NotCompared { .. }
                | Self::ClockNotSet
                | Self::Unreadable(_)
                | Self::Setting(_)
                | Self::Settings(_)
                | Self::Elements(_)
        )
    }
}

/// Compares two alarms, ignoring figures that change while the matter stays.
fn same_matter(a: &AlarmKind, b: &AlarmKind) -> bool {
    match (a, b) {
        (AlarmKind::ClockOff(_), AlarmKind::ClockOff(_))
        | (AlarmKind::LinkLost(_), AlarmKind::LinkLost(_))
        | (AlarmKind::DriverStands(_), AlarmKind::DriverStands(_))
        | (AlarmKind::StationStands(_), AlarmKind::StationStands(_))
        | (AlarmKind::StationElsewhere(_), AlarmKind::StationElsewhere(_))
        | (AlarmKind::UnitElsewhere(_), AlarmKind::UnitElsewhere(_))
        | (AlarmKind::OffTarget { .. }, AlarmKind::OffTarget { .. }) => true,
        (AlarmKind::Check(a), AlarmKind::Check(b)) => a.name == b.name && a.state == b.state,
        (AlarmKind::UnitDiffers(a), AlarmKind::UnitDiffers(b)) => {
            std::mem::discriminant(&a.cause) == std::mem::discriminant(&b.cause)
        }
        _ => a == b,
    }
}

/// Returns `true` if `cause` says all that `effect` says, and why.
fn explains(cause: &AlarmKind, effect: &AlarmKind) -> bool {
    matches!(
        (cause, effect),
        (AlarmKind::Unreadable(_), AlarmKind::LinkLost(LinkLoss::Unreadable))
            | (AlarmKind::Safety(Safety::SilentInMotion), AlarmKind::LinkLost(_))
    )
}

/// Returns `true` if `news` says more than `standing`: a unit whose position cannot be read
/// does answer, and a silent one that moves matters more than its link.
fn replaces(news: &AlarmKind, standing: &AlarmKind) -> bool {
    matches!(
        (news, standing),
        (
            AlarmKind::Unreadable(_) | AlarmKind::Safety(Safety::SilentInMotion),
            AlarmKind::LinkLost(_)
        )
    )
}

/// Returns `true` if the check behind an alarm is over by now: it is gone, or has another
/// state. A unit that does not report it may still have the fault.
pub fn is_over(raised: &Check, now: &[Check]) -> bool {
    let same = now.iter().find(|check| check.name == raised.name);
    same.is_none_or(|check| check.state != raised.state && check.state != CheckState::Unknown)
}

/// The alarm that an event calls for, if any.
pub fn alarm_of(event: &Event) -> Option<AlarmKind> {
    Some(match event.clone() {
        Event::LinkLost(loss) => AlarmKind::LinkLost(loss),
        Event::StopNotConfirmed => AlarmKind::StopNotConfirmed,
        Event::StopRefused(code) => AlarmKind::StopRefused(code),
        // `StoppedByFlags` is shown where the motion was asked for; many antennas have such
        // an axis. The other two stand for as long as the snapshot says so.
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
        Event::LockOutUnproved => AlarmKind::LockOutUnproved,
        Event::Refused(asked, code) => AlarmKind::Refused(asked, code),
        Event::Unanswered(asked) => AlarmKind::Unanswered(asked),
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

#[cfg(test)]
mod tests {
    use super::*;

    const COMMAS: AlarmKind = AlarmKind::Unreadable("Decimal commas.");

    fn time() -> Timestamp {
        "2026-08-12T00:00:00Z".parse().unwrap()
    }

    #[test]
    fn the_same_matter_stands_once_and_comes_again_after_it_was_over() {
        let mut alarms = Alarms::default();
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(1.5), time());
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(1.6), time());
        alarms.raise(Some(AntennaId(2)), AlarmKind::ClockOff(1.6), time());
        assert_eq!(alarms.list().len(), 2);
        alarms.clear(Some(AntennaId::FIRST), |kind| matches!(kind, AlarmKind::ClockOff(_)));
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockOff(2.0), time());
        assert_eq!(alarms.list().len(), 3);
    }

    #[test]
    fn a_driver_that_goes_on_standing_is_one_alarm_whose_figure_grows() {
        let mut alarms = Alarms::default();
        for seconds in 1..4 {
            alarms.raise(None, AlarmKind::DriverStands(Duration::from_secs(seconds)), time());
        }
        let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
        assert_eq!(kinds, [&AlarmKind::DriverStands(Duration::from_secs(3))]);
    }

    #[test]
    fn an_alarm_stays_until_it_is_seen_and_over() {
        let mut alarms = Alarms::default();
        alarms.raise(None, AlarmKind::StopNotConfirmed, time());
        let id = alarms.newest_unseen().unwrap();
        alarms.acknowledge(id);
        assert_eq!(alarms.list().len(), 1, "still moving");
        alarms.clear(None, |_| true);
        assert_eq!(alarms.list(), []);
        alarms.raise(None, AlarmKind::AutoTrackStillOn, time());
        alarms.acknowledge(alarms.newest_unseen().unwrap());
        assert_eq!(alarms.list(), [], "a moment is over when seen");
    }

    #[test]
    fn a_unit_that_writes_decimal_commas_raises_one_alarm() {
        let unreadable = AlarmKind::LinkLost(LinkLoss::Unreadable);
        let orders = [
            [unreadable.clone(), COMMAS],
            [AlarmKind::LinkLost(LinkLoss::Silent), COMMAS],
            [COMMAS, unreadable.clone()],
        ];
        for order in orders {
            let mut alarms = Alarms::default();
            for kind in order {
                alarms.raise(Some(AntennaId::FIRST), kind, time());
            }
            let kinds: Vec<&AlarmKind> = alarms.list().iter().map(|alarm| &alarm.kind).collect();
            assert_eq!(kinds, [&COMMAS]);
            alarms.raise(Some(AntennaId(2)), unreadable.clone(), time());
            alarms.raise(Some(AntennaId::FIRST), AlarmKind::LinkLost(LinkLoss::Closed), time());
            assert_eq!(alarms.list().len(), 3, "another antenna, another loss");
        }
    }

    #[test]
    fn a_check_is_over_when_it_is_told_to_be_good_or_worse() {
        let check = |name, state| Check::new(name, state, "Look at it.");
        let raised = check("Drive", CheckState::Caution);
        assert!(!is_over(&raised, std::slice::from_ref(&raised)));
        assert!(!is_over(&raised, &[check("Drive", CheckState::Unknown)]));
        assert!(is_over(&raised, &[check("Drive", CheckState::Good)]));
        assert!(is_over(&raised, &[check("Drive", CheckState::Fault)]));
        assert!(is_over(&raised, &[check("Clock", CheckState::Caution)]));
    }

    #[test]
    fn a_check_that_is_told_in_other_words_is_the_same_matter() {
        let check = Check::new("X position sensor", CheckState::Fault, "Look at it.");
        let told = Check { told: "Not connected".into(), ..check.clone() };
        let mut alarms = Alarms::default();
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::Check(check), time());
        alarms.raise(Some(AntennaId::FIRST), AlarmKind::Check(told), time());
        assert_eq!(alarms.list().len(), 1);
    }

    #[test]
    fn the_list_is_bounded() {
        let mut alarms = Alarms::default();
        for number in 0..1000_u32 {
            alarms.raise(None, AlarmKind::Settings(number.to_string()), time());
        }
        assert_eq!(alarms.list().len(), MAX);
    }
}
