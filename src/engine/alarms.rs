//! What the operator must not miss.

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

/// Older ones are forgotten, seen ones first.
const MAX: usize = 100;

/// How much it matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Priority {
    /// Something will go wrong or was not done.
    Caution,
    /// Something is wrong now.
    Warning,
}

/// What happened. The words are the view's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum AlarmKind {
    /// No link to the antenna.
    LinkLost(LinkLoss),
    /// It moves three seconds after STOP.
    StopNotConfirmed,
    /// The unit refused STOP, with this code.
    StopRefused(String),
    /// A jog was stopped because the window or the station was too busy to renew it.
    JogLeaseOver,
    /// A jog was stopped because the position grew too old.
    JogPositionOld,
    /// Stopped, but the unit may start by itself.
    AutoTrackStillOn,
    /// The unit did not switch auto-track off.
    AutoStaysOn,
    /// Locked out, and it cannot be read back that the unit does not start by itself.
    LockOutUnproved,
    /// The list of units that are locked out could not be read or written; in words.
    LockOuts(String),
    /// The unit refused, with this code.
    Refused(Asked, String),
    /// The unit did not answer.
    Unanswered(Asked),
    /// The satellite cannot be tracked.
    CannotTrack(TrackTarget, PrepareError),
    /// A target cannot be followed position by position, or no further.
    CannotProgramTrack(String, TrackProblem),
    /// The unit tracks by itself, and not where the satellite is.
    OffTarget {
        /// So far it was off when it was noticed.
        off: Angle,
        /// The likeliest cause.
        cause: Option<Ranked>,
    },
    /// By what the unit tells of itself it would miss a pass; the likeliest cause.
    UnitDiffers(Ranked),
    /// The unit tracks by itself, and where it should point is not known here.
    NotCompared {
        /// What it says that it tracks, of which no elements are known; `None` where it
        /// does not say.
        satellite: Option<String>,
    },
    /// Tracking ended before LOS.
    TrackingEnded,
    /// A motion ended somewhere else.
    EndedShort,
    /// The unit tracks without having been asked to by this console.
    StartedByItself,
    /// The unit moves without having been asked to by this console.
    MovesByItself,
    /// A matter of safety.
    Safety(Safety),
    /// A STOP is owed to a unit of no antenna of the station.
    Owed(Unit),
    /// The part of the program that talks to the antennas has not responded for
    /// this long.
    DriverStands(Duration),
    /// The part of the program that runs the station has shown nothing new for this
    /// long; what is shown is as old.
    StationStands(Duration),
    /// Another Azel of this machine has this station open: nothing is driven from here.
    StationElsewhere(HeldBy),
    /// Another Azel of this machine drives this unit.
    UnitElsewhere(HeldBy),
    /// STOP is not known to have been carried out by the Azel that drives an antenna.
    StopNotElsewhere,
    /// Work of the program itself broke off.
    BrokeOff(Work),
    /// A source of elements, by its name, is not read: the last reading of it
    /// ended the program.
    SourceSetAside(String),
    /// The part of the program that talks to the antenna is too busy to take
    /// what was asked for.
    NotTaken,
    /// A fault or warning of the unit, as it names them itself.
    Check(Check),
    /// The unit's clock is this far ahead of ours, seconds.
    ClockOff(f64),
    /// The unit's clock was never set.
    ClockNotSet,
    /// Its position cannot be read, for this reason.
    Unreadable(#[serde(deserialize_with = "name::one")] Name),
    /// A setting of the station file that was not taken over.
    Setting(Note),
    /// The settings could not be read or written; in words.
    Settings(String),
    /// The elements could not be read; in words.
    Elements(String),
}

/// Work that can break off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    /// The reading of the sources of elements.
    Elements,
    /// The search for passes.
    Passes,
}

/// One entry of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Never used twice.
    pub id: u64,
    /// The antenna that it is about.
    pub antenna: Option<AntennaId>,
    /// What happened.
    pub kind: AlarmKind,
    /// When.
    pub time: Timestamp,
    /// The operator has acknowledged it.
    pub seen: bool,
    /// It is over.
    pub cleared: bool,
}

impl Alarm {
    /// How much it matters.
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

/// All alarms, the newest last. A copy shares them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Alarms {
    list: Arc<Vec<Alarm>>,
    next_id: u64,
    /// One has come since the list was opened.
    pub unopened: bool,
}

impl Alarms {
    /// The alarms, the newest last.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// Adds one, unless the same is standing already or one that explains it. It
    /// takes the place of what it makes obsolete.
    pub fn raise(&mut self, antenna: Option<AntennaId>, kind: AlarmKind, time: Timestamp) {
        if let AlarmKind::DriverStands(_) | AlarmKind::StationStands(_) = kind {
            let same = |alarm: &Alarm| !alarm.cleared && same_matter(&alarm.kind, &kind);
            // How long it stands grows while the alarm does.
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

    /// Forgets those of antennas that the station has no more.
    pub fn keep_only(&mut self, antennas: &[AntennaId]) {
        let is_known = |alarm: &Alarm| alarm.antenna.is_none_or(|id| antennas.contains(&id));
        if !self.list.iter().all(is_known) {
            Arc::make_mut(&mut self.list).retain(is_known);
        }
    }

    /// What `is_over` says is over.
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
        // What is over and was seen need not stay.
        list.retain(|alarm| !(alarm.cleared && alarm.seen));
    }

    /// The operator has seen this one.
    pub fn acknowledge(&mut self, id: u64) {
        let list = Arc::make_mut(&mut self.list);
        for alarm in list.iter_mut() {
            if alarm.id == id {
                alarm.seen = true;
            }
        }
        list.retain(|alarm| !(alarm.seen && (alarm.cleared || alarm.kind.is_momentary())));
    }

    /// The newest that was not seen.
    pub fn newest_unseen(&self) -> Option<u64> {
        self.list.iter().rev().find(|alarm| !alarm.seen).map(|alarm| alarm.id)
    }
}

impl AlarmKind {
    /// It tells of a moment rather than of a state that goes on.
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

/// Figures change while the matter stays.
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

/// Whether `cause` says all that `effect` says, and why.
fn explains(cause: &AlarmKind, effect: &AlarmKind) -> bool {
    matches!(
        (cause, effect),
        (AlarmKind::Unreadable(_), AlarmKind::LinkLost(LinkLoss::Unreadable))
            | (AlarmKind::Safety(Safety::SilentInMotion), AlarmKind::LinkLost(_))
    )
}

/// Whether `news` says more than what stands: a unit that cannot be read does
/// answer, and one that moves matters more than its link.
fn replaces(news: &AlarmKind, standing: &AlarmKind) -> bool {
    matches!(
        (news, standing),
        (
            AlarmKind::Unreadable(_) | AlarmKind::Safety(Safety::SilentInMotion),
            AlarmKind::LinkLost(_)
        )
    )
}

/// Whether what was raised of a check is over by now: it is good, or something
/// else. A unit that does not say is not taken for one that is well.
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
        // The first is said where it was asked for; many antennas have such an axis.
        // The others stand for as long as the snapshot says so.
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
