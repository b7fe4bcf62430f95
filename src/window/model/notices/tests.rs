use std::{sync::Arc, time::Duration};

use jiff::{Timestamp, ToSpan as _, tz};

use super::*;
use crate::{
    astro::{Angle, TrackOffsets},
    clock::{Instant, Moment},
    contract::{
        alarms::{AlarmKind, Alarms, ShelveTime, Work},
        automatic::OffBecause,
        claim::HeldBy,
        driver::{
            Evidence, LeftOffsets, LinkLoss, Mover, Response, Safety, TrackProblem, Unit, Unlike,
        },
    },
    device::{
        MotionRequest, PrepareError, TrackTarget,
        panel::{Check, CheckState},
        settings::WriteError,
    },
    engine::alarms::KeepAlarms,
    plan::{
        Barrier,
        on_board::{Cause, Ranked},
    },
    station::{Antenna, AntennaId, Note, NoteReason, Notices, Station},
};

const ANTENNA: Option<AntennaId> = Some(AntennaId::FIRST);
const LOST: AlarmKind = AlarmKind::LinkLost(LinkLoss::Silent);
const STOP: AlarmKind = AlarmKind::StopNotConfirmed;

/// Returns eleven in the evening, local time.
fn time() -> Timestamp {
    "2026-08-12T20:00:00Z".parse().unwrap()
}

fn istanbul() -> TimeZone {
    TimeZone::fixed(tz::offset(3))
}

/// Returns the notices of a station with these alarms and settings.
fn look(teller: &mut Teller, alarms: &Alarms, notices: &Notices) -> Vec<Notice> {
    let moment = Moment { utc: time(), steady: Instant::now() };
    let station = Station { notices: notices.clone(), ..Station::default() };
    let snapshot = Snapshot {
        station: Arc::new(station),
        alarms: alarms.clone(),
        ..Snapshot::before_anything(moment)
    };
    teller.look(&snapshot, None, &istanbul()).notices
}

fn rows(notices: &[Notice]) -> Vec<u64> {
    let row = |notice: &Notice| match &notice.subject {
        NoticeSubject::Alarm(alarm) => alarm.row,
        subject => panic!("{subject:?}"),
    };
    notices.iter().map(row).collect()
}

#[test]
fn an_alarm_is_told_once_and_again_in_its_row_when_it_comes_again() {
    let (mut teller, mut alarms, notices) =
        (Teller::default(), Alarms::default(), Notices::default());
    alarms.raise(ANTENNA, LOST, time());
    let list = look(&mut teller, &alarms, &notices);
    assert_eq!(rows(&list), [0]);
    assert!(list[0].is_shown && list[0].tones == Tones::Falling);
    alarms.raise(ANTENNA, LOST, time());
    assert_eq!(look(&mut teller, &alarms, &notices), []);
    alarms.raise(None, AlarmKind::NotTaken, time());
    assert_eq!(rows(&look(&mut teller, &alarms, &notices)), [1]);
    alarms.clear(ANTENNA, time(), |_| true);
    assert_eq!(look(&mut teller, &alarms, &notices), []);
    alarms.raise(ANTENNA, LOST, time());
    let again = look(&mut teller, &alarms, &notices);
    assert_eq!(rows(&again), [0], "in the place of the first");
    let NoticeSubject::Alarm(alarm) = &again[0].subject else { panic!("{again:?}") };
    assert_eq!((alarm.id, alarm.count), (2, 2));
}

#[test]
fn the_shelf_is_silent_until_its_time_is_up() {
    let (mut teller, mut alarms, notices) =
        (Teller::default(), Alarms::default(), Notices::default());
    alarms.raise(ANTENNA, LOST, time());
    look(&mut teller, &alarms, &notices);
    alarms.shelve(0, ShelveTime::TenMinutes, time());
    alarms.clear(ANTENNA, time(), |_| true);
    alarms.raise(ANTENNA, LOST, time());
    assert_eq!(look(&mut teller, &alarms, &notices), []);
    alarms.pass_time(time() + 10.minutes());
    assert_eq!(rows(&look(&mut teller, &alarms, &notices)), [0]);
}

#[test]
fn what_an_operator_has_seen_first_is_not_told() {
    let (mut teller, mut alarms) = (Teller::default(), Alarms::default());
    alarms.raise(ANTENNA, LOST, time());
    alarms.acknowledge(0, time());
    assert_eq!(look(&mut teller, &alarms, &Notices::default()), []);
}

#[test]
fn each_outlet_has_its_setting_and_quiet_hours_hold_for_both() {
    let mut alarms = Alarms::default();
    alarms.raise(ANTENNA, LOST, time());
    let tones = |notifications, sounds, quiet| {
        let notices = Notices { notifications, sounds, quiet, ..Notices::default() };
        let list = look(&mut Teller::default(), &alarms, &notices);
        list.first().map(|notice| (notice.is_shown, notice.tones != Tones::None))
    };
    assert_eq!(tones(true, false, None), Some((true, false)));
    assert_eq!(tones(false, true, None), Some((false, true)));
    assert_eq!(tones(false, false, None), None);
    assert_eq!(tones(true, true, Some(HoursOfDay::NIGHT)), None, "23:00 local, 20:00 UTC");
    let HoursOfDay { start, end } = HoursOfDay::NIGHT;
    let by_day = HoursOfDay { start: end, end: start };
    assert_eq!(tones(true, true, Some(by_day)), Some((true, true)));
}

#[test]
fn each_kind_of_notice_has_a_sound_of_its_own_or_none() {
    let tones = |kind: AlarmKind, notices: &Notices| {
        let mut alarms = Alarms::default();
        alarms.raise(ANTENNA, kind, time());
        look(&mut Teller::default(), &alarms, notices).first().map(|notice| notice.tones)
    };
    let (warning, caution) = (LOST, AlarmKind::ClockNotSet);
    let ranks = [&warning, &caution].map(AlarmKind::priority);
    assert_eq!(ranks, [Priority::Warning, Priority::Caution]);
    let notices =
        Notices { warning_tones: Tones::Rising, caution_tones: Tones::None, ..Notices::default() };
    assert_eq!(tones(warning, &notices), Some(Tones::Rising));
    assert_eq!(tones(caution.clone(), &notices), Some(Tones::None), "shown all the same");
    let silent = Notices { notifications: false, ..notices };
    assert_eq!(tones(caution, &silent), None);
    assert_eq!(tones(STOP, &silent), Some(Tones::Falling), "top priority");
}

#[test]
fn an_alarm_that_stood_and_is_over_is_named_once() {
    let moment = Moment { utc: time(), steady: Instant::now() };
    let (mut teller, mut alarms) = (Teller::default(), Alarms::default());
    let mut ended = |alarms: &Alarms| {
        let alarms = alarms.clone();
        let snapshot = Snapshot { alarms, ..Snapshot::before_anything(moment) };
        teller.look(&snapshot, None, &istanbul()).ended
    };
    alarms.raise(ANTENNA, LOST, time());
    alarms.raise(ANTENNA, AlarmKind::EndedShort, time());
    assert_eq!(ended(&alarms), [0; 0]);
    alarms.clear(ANTENNA, time(), |kind| *kind == LOST);
    assert_eq!(ended(&alarms), [0]);
    assert_eq!(ended(&alarms), [0; 0]);
    alarms.raise(ANTENNA, LOST, time());
    assert_eq!(ended(&alarms), [0; 0]);
    alarms.clear(ANTENNA, time(), |kind| *kind == LOST);
    assert_eq!(ended(&alarms), [0], "it came again in its row");
    alarms.acknowledge(1, time());
    assert_eq!(ended(&alarms), [1], "what lasted for a moment is over once it is seen");
}

#[test]
fn what_was_quiet_is_not_told_afterwards() {
    let (mut teller, mut alarms) = (Teller::default(), Alarms::default());
    alarms.raise(ANTENNA, LOST, time());
    let quiet = Notices { quiet: Some(HoursOfDay::NIGHT), ..Notices::default() };
    assert_eq!(look(&mut teller, &alarms, &quiet), []);
    assert_eq!(look(&mut teller, &alarms, &Notices::default()), []);
}

#[test]
fn a_reminder_is_told_once_before_aos() {
    let reminder = Reminder {
        pass: (25_544, time() + 5.minutes()),
        name: "ISS".to_owned(),
        los: time() + 15.minutes(),
        max_elevation: Angle::from_degrees(54.0),
        can_track: vec![AntennaId::FIRST],
    };
    let mut alarms = Alarms::default();
    alarms.raise(ANTENNA, STOP, time());
    let look = |teller: &mut Teller, utc, station: &Arc<Station>| {
        let moment = Moment { utc, steady: Instant::now() };
        let snapshot = Snapshot {
            reminders: Arc::new(vec![reminder.clone()]),
            alarms: alarms.clone(),
            station: Arc::clone(station),
            ..Snapshot::before_anything(moment)
        };
        teller.look(&snapshot, None, &istanbul()).notices
    };
    let mut teller = Teller::default();
    let station = Arc::default();
    let list = look(&mut teller, time(), &station);
    assert!(list[0].subject.has_top_priority() && list.len() == 2, "{list:?}");
    assert_eq!(list[1].subject, NoticeSubject::Reminder(reminder.clone()));
    assert_eq!(look(&mut teller, time(), &station), []);
    let late = look(&mut Teller::default(), time() + 5.minutes(), &station);
    assert_eq!(late.len(), 1, "not after AOS: {late:?}");
    let notices = Notices { quiet: Some(HoursOfDay::NIGHT), ..Notices::default() };
    let quiet = Arc::new(Station { notices, ..Station::default() });
    assert_eq!(look(&mut Teller::default(), time(), &quiet).len(), 1, "the alarm alone");
}

#[test]
fn a_station_that_stands_is_told_once_until_it_goes_on() {
    let moment = Moment { utc: time(), steady: Instant::now() };
    let (snapshot, stood) = (Snapshot::before_anything(moment), Duration::from_secs(2));
    let mut teller = Teller::default();
    let mut announced = |stood| {
        let notices = teller.look(&snapshot, stood, &istanbul()).notices;
        notices.into_iter().map(|notice| notice.subject).collect::<Vec<_>>()
    };
    assert_eq!(announced(None), []);
    assert_eq!(announced(Some(stood)), [NoticeSubject::StationStands(stood)]);
    assert_eq!(announced(Some(stood)), []);
    assert_eq!(announced(None), []);
    assert_eq!(announced(Some(stood)), [NoticeSubject::StationStands(stood)]);
}

#[test]
fn nothing_silences_a_top_priority_alarm() {
    let silent = Notices {
        notifications: false,
        sounds: false,
        warning_tones: Tones::None,
        quiet: Some(HoursOfDay::NIGHT),
        ..Notices::default()
    };
    let mut first = 0;
    for kind in every_kind() {
        let mut alarms = Alarms::default();
        alarms.raise(ANTENNA, kind.clone(), time());
        alarms.shelve(0, ShelveTime::EightHours, time());
        let notices = look(&mut Teller::default(), &alarms, &silent);
        let is_told =
            notices.iter().any(|notice| notice.is_shown && notice.tones == Tones::Falling);
        assert_eq!(is_told, kind.priority() == Priority::First, "{kind:?}");
        first += usize::from(is_told);
    }
    assert_eq!(first, 14);
}

/// Returns an alarm of each kind and of each safety event.
fn every_kind() -> Vec<AlarmKind> {
    use crate::contract::alarms::AlarmKind as K;
    let ranked = || Ranked { cause: Cause::AzimuthOffset(1.0), max_error: None };
    let target = TrackTarget {
        catalog_number: 25_544,
        name: "ISS".to_owned(),
        element_file: None,
        start: time(),
        end: time(),
    };
    let text = || "text".to_owned();
    let note = |reason| Note { place: text(), line: None, reason };
    let mut all = vec![
        LOST,
        STOP,
        K::StopRefused(text()),
        K::JogLeaseOver,
        K::JogPositionOld,
        K::LosesPositions,
        K::AutoTrackStillOn,
        K::AutoStaysOn,
        K::AutoTrackNotKnown,
        K::AutoTrackOwed(Unit::new(&Antenna::satrak("Dish", "10.0.0.5:4001"))),
        K::OffsetsOwed(Unit::new(&Antenna::satrak("Dish", "10.0.0.5:4001"))),
        K::LockOutUnproved,
        K::LockOuts(text()),
        K::Refused(MotionRequest::Action("park"), text()),
        K::Unanswered(MotionRequest::Action("park")),
        K::CannotTrack(target, PrepareError::CannotBeSent(text())),
        K::CannotProgramTrack(text(), TrackProblem::NoPass),
        K::OffTarget { deviation: Angle::from_degrees(1.0), cause: None },
        K::OffsetsLeft {
            offsets: TrackOffsets::NONE,
            reason: LeftOffsets::Found { start: time() },
        },
        K::OffsetNotTaken(WriteError::Unanswered),
        K::UnitDiffers(ranked()),
        K::NotCompared { satellite: None },
        K::NoAntennaFor { pass: (25_544, time()), name: text() },
        K::NotOnItsWay { pass: (25_544, time()), name: text(), reason: None },
        K::AutomaticMoves { time: time(), name: text() },
        K::AutomaticOff(OffBecause::Failures),
        K::AutomaticSuspended(crate::contract::automatic::Interruption::Elsewhere),
        K::TrackingEnded,
        K::EndedShort,
        K::StartedByItself,
        K::MovesByItself,
        K::Owed(Unit::new(&Antenna::satrak("Dish", "10.0.0.5:4001"))),
        K::DriverStands(Duration::from_secs(3)),
        K::StationStands(Duration::from_secs(3)),
        K::StationElsewhere(HeldBy::Azel(None)),
        K::UnitElsewhere(HeldBy::Azel(None)),
        K::StopNotElsewhere,
        K::BrokeOff(Work::Passes),
        K::SourceSetAside(text()),
        K::SourceFails { source: text(), as_of: Some(time()) },
        K::ElementsOld { name: text(), others: 2 },
        K::ElementsNotUploaded { reason: text() },
        K::NotTaken,
        K::Check(Check::new("Drive", CheckState::Fault, "Look at it.")),
        K::Check(Check::new("Drive", CheckState::Caution, "Look at it.")),
        K::ClockOff(1.5),
        K::ClockNotSet,
        K::Unreadable("Decimal commas."),
        K::Setting(note(NoteReason::Unknown)),
        K::SafetySetting {
            note: note(NoteReason::DoesNotHold { name: text(), reason: text() }),
            antenna: None,
        },
        K::Settings(text()),
        K::Elements(text()),
        K::NoRecord(text()),
        K::RecordRemoved,
    ];
    all.extend(every_matter_of_safety().into_iter().map(K::Safety));
    all.iter().for_each(is_listed);
    all
}

/// Fails to compile until this list and the list above contain each new kind.
fn is_listed(kind: &AlarmKind) {
    use crate::contract::alarms::AlarmKind as K;
    match kind {
        K::LinkLost(_)
        | K::StopNotConfirmed
        | K::StopRefused(_)
        | K::JogLeaseOver
        | K::JogPositionOld
        | K::LosesPositions
        | K::AutoTrackStillOn
        | K::AutoStaysOn
        | K::AutoTrackNotKnown
        | K::AutoTrackOwed(_)
        | K::OffsetsOwed(_)
        | K::LockOutUnproved
        | K::LockOuts(_)
        | K::Refused(..)
        | K::Unanswered(_)
        | K::CannotTrack(..)
        | K::CannotProgramTrack(..)
        | K::OffTarget { .. }
        | K::OffsetsLeft { .. }
        | K::OffsetNotTaken(_)
        | K::UnitDiffers(_)
        | K::NotCompared { .. }
        | K::NoAntennaFor { .. }
        | K::NotOnItsWay { .. }
        | K::AutomaticMoves { .. }
        | K::AutomaticOff(_)
        | K::AutomaticSuspended(_)
        | K::TrackingEnded
        | K::EndedShort
        | K::StartedByItself
        | K::MovesByItself
        | K::Safety(_)
        | K::Owed(_)
        | K::DriverStands(_)
        | K::StationStands(_)
        | K::StationElsewhere(_)
        | K::UnitElsewhere(_)
        | K::StopNotElsewhere
        | K::BrokeOff(_)
        | K::SourceSetAside(_)
        | K::SourceFails { .. }
        | K::ElementsOld { .. }
        | K::ElementsNotUploaded { .. }
        | K::NotTaken
        | K::Check(_)
        | K::ClockOff(_)
        | K::ClockNotSet
        | K::Unreadable(_)
        | K::Setting(_)
        | K::SafetySetting { .. }
        | K::Settings(_)
        | K::Elements(_)
        | K::NoRecord(_)
        | K::RecordRemoved => {}
    }
}

fn every_matter_of_safety() -> Vec<Safety> {
    let all = vec![
        Safety::DeadManFired,
        Safety::LeftMoving { start: Some(time()), asks: true },
        Safety::NoMark,
        Safety::SessionBroke,
        Safety::StoppedByFlags { axis: "X" },
        Safety::FlagsContradict { axis: "X", turned_deg: 2.0 },
        Safety::SilentInMotion,
        Safety::NoEffect { axis: Some("X") },
        Safety::ForeignHands { axis: "X", evidence: Evidence::Outside { off_deg: 8.0 } },
        Safety::OffTarget { off_deg: 5.0, cause: None },
        Safety::ClockStepped { by_s: 2.0, time: Some(time()) },
        Safety::EndedForSleep,
        Safety::Slept { lasted: Duration::from_mins(1) },
        Safety::AsksToResume { name: "ISS".to_owned(), lost: Duration::from_mins(1), unlike: None },
        Safety::UnitDiffers { unlike: Unlike::Identity },
        Safety::Forbidden {
            barrier: Barrier::Sun,
            driver: Mover::Somebody,
            response: Response::Reported,
        },
    ];
    for matter in &all {
        match matter {
            Safety::DeadManFired
            | Safety::LeftMoving { .. }
            | Safety::NoMark
            | Safety::SessionBroke
            | Safety::StoppedByFlags { .. }
            | Safety::FlagsContradict { .. }
            | Safety::SilentInMotion
            | Safety::NoEffect { .. }
            | Safety::ForeignHands { .. }
            | Safety::OffTarget { .. }
            | Safety::ClockStepped { .. }
            | Safety::EndedForSleep
            | Safety::Slept { .. }
            | Safety::AsksToResume { .. }
            | Safety::UnitDiffers { .. }
            | Safety::Forbidden { .. } => {}
        }
    }
    all
}
