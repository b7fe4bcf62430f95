//! Content of the top bar, from the model.

use egui::{Rect, Ui};

use super::{
    format, state_sentence,
    top_bar::{self, ClockHealth, ClockModel, ClockMood, StopLeftOut, TopBarModel},
    widgets::{
        alarm_list::{AlarmModel, AlarmRow, Section},
        link_chip::{AutomaticModel, ChipModel, LinkGlyph},
        stop_button::StopLook,
    },
    words,
};
use crate::{
    contract::{
        alarms::{Alarm, AlarmKind, AlarmState, Placed},
        antenna::{Answers, AntennaModel},
        automatic::Operation,
        driver::{StopState, TimeSync},
    },
    device::{Phase, panel::Check},
    model::{Model, UiCommand},
    plan::Barrier,
    station::AntennaId,
};

pub fn show(ui: &mut Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let (utc, date) = (format::clock(model.now), format::date(model.now));
    let local = format::local_clock(model.now);
    let site = model.station.site;
    let coordinates = coordinates(site.latitude().degrees(), site.longitude().degrees());

    let ages: Vec<String> = model.antennas.iter().map(|antenna| age(model, antenna)).collect();
    let automatic: Vec<Option<String>> =
        model.antennas.iter().map(|antenna| words::automatic::in_full(model, antenna)).collect();
    let alarms: Vec<Option<String>> =
        model.antennas.iter().map(|antenna| alarm(model, antenna)).collect();
    let chips: Vec<ChipModel<'_>> = model
        .antennas
        .iter()
        .zip(ages.iter().zip(&automatic).zip(&alarms))
        .enumerate()
        .map(|(index, (antenna, ((age, words), alarm)))| ChipModel {
            name: &antenna.config.name,
            link: glyph(model, antenna),
            activity: activity(model, antenna),
            age,
            selected: index == model.selected_antenna,
            maintenance: antenna.snapshot.lock_out.is_some(),
            automatic: words.as_deref().map(|words| automatic_model(antenna, words)),
            alarm: alarm.as_deref(),
        })
        .collect();

    let announced: Vec<ToldAlarm<'_>> = told_alarms(model);
    let rows: Vec<AlarmRow<'_>> = announced.iter().map(ToldAlarm::row).collect();

    let unproved = unproved_stop(model);
    let left_out = left_out_of_stop(model);
    let bar = TopBarModel {
        station: &model.station.name,
        demo: model.demo,
        stations: &model.stations,
        coordinates: &coordinates,
        clock: ClockModel {
            utc: &utc,
            date: &date,
            local: model.appearance.local_time.then_some(&*local),
            health: clock_health(model.time_sync),
        },
        chips: &chips,
        alarms: AlarmModel { rows: &rows, unopened: model.alarms.unopened },
        stop: stop_look(model, unproved.as_deref()),
        stop_about: &stop_about(model, left_out.as_ref()),
        stop_left_out: left_out.as_ref().map(|(count, sentence)| StopLeftOut { count, sentence }),
    };
    commands.extend(top_bar::show(ui, rect, &bar));
}

/// An alarm in words.
struct ToldAlarm<'a> {
    alarm: &'a Alarm,
    /// Flag: the alarm follows from an alarm above it.
    follows: bool,
    text: String,
    time: String,
    state: String,
    moves_away: Option<AntennaId>,
}

impl ToldAlarm<'_> {
    fn row(&self) -> AlarmRow<'_> {
        AlarmRow {
            id: self.alarm.id,
            priority: self.alarm.priority(),
            state: self.alarm.state(),
            follows: self.follows,
            text: &self.text,
            time: &self.time,
            state_words: &self.state,
            moves_away: self.moves_away,
        }
    }
}

/// Returns the alarms in the order of the list: standing or new, shelved, then over and seen.
fn told_alarms(model: &Model) -> Vec<ToldAlarm<'_>> {
    let mut placed = model.alarms.in_order();
    placed.sort_by_key(|placed| Section::new(placed.alarm.state()));
    let section_of = |id: u64| {
        let alarm = placed.iter().find(|placed| placed.alarm.id == id);
        alarm.map(|placed| Section::new(placed.alarm.state()))
    };
    let tell = |Placed { alarm, follows }| {
        let antenna = alarm.antenna.and_then(|id| model.antenna_of(id));
        ToldAlarm {
            alarm,
            follows: follows.and_then(section_of) == Some(Section::new(alarm.state())),
            text: alarm_text(model, alarm),
            time: words::alarm_times(alarm, model.now),
            state: words::alarm_state(alarm.state(), model.now),
            moves_away: alarm.antenna.filter(|_| {
                !alarm.is_over()
                    && antenna
                        .is_some_and(|model_antenna| is_left_to_the_sun(&alarm.kind, model_antenna))
            }),
        }
    };
    placed.iter().copied().map(tell).collect()
}

fn alarm_text(model: &Model, alarm: &Alarm) -> String {
    let antenna = alarm.antenna.and_then(|id| model.antenna_of(id));
    let name = antenna.map_or("Azel", |antenna| antenna.config.name.as_str());
    let reason = barrier_of(&alarm.kind).map(|barrier| words::reason(barrier, &model.station));
    words::alarm(&alarm.kind, name, model.now) + &reason.unwrap_or_default()
}

/// Returns the most urgent red alarm that stands for an antenna, in words; the newest of equal
/// ones.
pub fn alarm(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let stands = |alarm: &&Alarm| match alarm.state() {
        AlarmState::New | AlarmState::Seen => true,
        AlarmState::NewAndOver { .. } | AlarmState::Over { .. } | AlarmState::Shelved { .. } => {
            false
        }
    };
    let own = model.alarms.list().iter().filter(|alarm| alarm.antenna == Some(antenna.id()));
    let red = own.filter(stands).filter(|alarm| alarm.priority().is_red());
    // The list ends with the newest alarm, and `max_by_key` returns the last of equal ones.
    red.max_by_key(|alarm| alarm.priority()).map(|alarm| alarm_text(model, alarm))
}

/// Returns the barrier that an alarm is about.
fn barrier_of(kind: &AlarmKind) -> Option<&Barrier> {
    match kind {
        AlarmKind::Safety(matter) => matter.barrier(),
        AlarmKind::CannotProgramTrack(_, problem) => problem.barrier(),
        _ => None,
    }
}

/// Returns `true` for an alarm about the Sun approaching an antenna that stands still and can
/// be moved away.
fn is_left_to_the_sun(kind: &AlarmKind, antenna: &AntennaModel) -> bool {
    let is_about = barrier_of(kind) == Some(&Barrier::Sun);
    let snapshot = &antenna.snapshot;
    let is_there = snapshot
        .breach
        .as_ref()
        .is_some_and(|breach| breach.barrier == Barrier::Sun && breach.unknown_axis.is_none());
    is_about && is_there && antenna.can_park() && !antenna.is_busy()
}

/// Describes the effect of STOP, with its further effects on some antennas.
fn stop_about(model: &Model, left_out: Option<&(String, String)>) -> String {
    let note = |antenna: &AntennaModel| {
        Some(format!(" {}: {}", antenna.config.name, antenna.variant().capabilities.stop_note?))
    };
    let notes: String = model.antennas.iter().filter_map(note).collect();
    match left_out {
        Some((count, sentence)) => format!("Reaches {count} antennas.{notes} {sentence}"),
        None => format!("Stops every antenna.{notes}"),
    }
}

/// Returns the number of antennas that STOP stops, and a sentence on those that it leaves to
/// others; `None` if it stops all.
fn left_out_of_stop(model: &Model) -> Option<(String, String)> {
    let is_left_out = |model_antenna: &&AntennaModel| {
        model_antenna.held_by.is_none() && !model_antenna.snapshot.wants_stop()
    };
    let left_out = model.antennas.iter().filter(is_left_out);
    let names: Vec<&str> = left_out.map(|antenna| antenna.config.name.as_str()).collect();
    let (verb, pronoun) = match *names {
        [] => return None,
        [_] => ("is", "it"),
        _ => ("are", "them"),
    };
    let total = model.antennas.len();
    let count = format!("{} of {total}", total - names.len());
    let names = format::list(&names);
    Some((count, format!("{names} {verb} not connected: STOP does not reach {pronoun}.")))
}

fn clock_health(sync: TimeSync) -> ClockHealth<'static> {
    match sync {
        TimeSync::Synchronised => ClockHealth {
            mood: ClockMood::Good,
            words: "synchronised",
            sentence: "A time service synchronises this computer's clock.",
        },
        TimeSync::NotSynchronised => ClockHealth {
            mood: ClockMood::Bad,
            words: "not synchronised",
            sentence: "No time service synchronises this computer's clock. A low satellite \
                       overhead moves about 1° a second, so each second of clock error puts \
                       predictions off by about 1°.",
        },
        TimeSync::NotKnown => ClockHealth {
            mood: ClockMood::Unknown,
            words: "sync unknown",
            sentence: "Azel cannot tell whether a time service synchronises this computer's clock.",
        },
    }
}

fn coordinates(latitude_deg: f64, longitude_deg: f64) -> String {
    format!("{}  {}", format::latitude(latitude_deg, 3), format::longitude(longitude_deg, 3))
}

pub fn glyph(model: &Model, antenna: &AntennaModel) -> LinkGlyph {
    match antenna.answers(model.steady) {
        Answers::Off | Answers::Connecting => LinkGlyph::Off,
        Answers::InTime if !antenna.loses_positions => LinkGlyph::Live,
        Answers::InTime | Answers::Late(_) => LinkGlyph::Late,
        Answers::Silent(_) => LinkGlyph::Silent,
        Answers::Lost(_) => LinkGlyph::Lost,
    }
}

/// Returns the age of the unit's last report, or an empty text.
pub fn age(model: &Model, antenna: &AntennaModel) -> String {
    let last_reply = antenna.snapshot.state.traffic.last_reply;
    let age = match antenna.answers(model.steady) {
        Answers::Off | Answers::Connecting => None,
        Answers::InTime => last_reply.map(|last| model.steady.saturating_duration_since(last)),
        Answers::Late(age) | Answers::Silent(age) | Answers::Lost(age) => Some(age),
    };
    age.map_or_else(String::new, |age| format::age(age.as_secs_f64()))
}

/// Returns the automatic operation of an antenna, described by `words`.
pub fn automatic_model<'a>(antenna: &AntennaModel, words: &'a str) -> AutomaticModel<'a> {
    let is_suspended = matches!(antenna.operation, Operation::Suspended { .. });
    AutomaticModel { is_suspended, words }
}

/// Returns the activity of an antenna in one or two words.
pub fn activity(model: &Model, antenna: &AntennaModel) -> &'static str {
    let state = &antenna.snapshot.state;
    let stops = matches!(
        antenna.snapshot.stop,
        StopState::Stopping { .. } | StopState::NotConfirmed { .. }
    );
    if antenna.snapshot.lock_out.is_some() && !stops {
        return if antenna.snapshot.locking { "Being locked out" } else { "In maintenance" };
    }
    match antenna.answers(model.steady) {
        Answers::Off => return "Not connected",
        Answers::Connecting => return "Connecting",
        Answers::Silent(_) | Answers::Lost(_) => return "No reply",
        Answers::InTime => {}
        Answers::Late(_) => return "Late",
    }
    let moving = state.measured.is_some_and(|measured| measured.moving());
    let program = state.program.filter(|program| program.enabled);
    match (antenna.snapshot.stop, program.map(|program| program.phase)) {
        (StopState::Stopping { .. } | StopState::NotConfirmed { .. }, _) => "Stopping",
        _ if state.checks.iter().any(Check::forbids_motion) => "Fault",
        (_, Some(Phase::Tracking)) => "Tracking",
        _ if antenna.snapshot.jog.is_some() => "Jogging",
        _ if antenna.is_out_of_reach() => "Waiting",
        _ if antenna.tracks() => "Tracking",
        _ if moving => "Moving",
        (_, Some(Phase::AtStart | Phase::OutOfWindow)) => "Waiting",
        _ if antenna.follows() => "Waiting",
        _ if state.measured.is_none() => "Reading",
        (StopState::Stopped { .. }, _) => "Stopped",
        _ => "Holding",
    }
}

/// Returns the state sentence of the first antenna that may still move after a stop.
fn unproved_stop(model: &Model) -> Option<String> {
    let unproved =
        |antenna: &&AntennaModel| matches!(antenna.snapshot.stop, StopState::NotConfirmed { .. });
    let antenna = model.antennas.iter().find(unproved)?;
    Some(state_sentence::state_sentence(model, antenna).text())
}

fn stop_look<'a>(model: &Model, unproved: Option<&'a str>) -> StopLook<'a> {
    if let Some(text) = unproved {
        return StopLook::NotConfirmed { text };
    }
    let any = |is_matching: fn(&StopState) -> bool| {
        model.antennas.iter().any(|antenna| is_matching(&antenna.snapshot.stop))
    };
    let is_pressed = model.antennas.iter().any(|antenna| antenna.stop_pressed.is_some());
    if is_pressed || any(|stop| matches!(stop, StopState::Stopping { .. })) {
        StopLook::Stopping
    } else if any(|stop| matches!(stop, StopState::Stopped { .. }))
        && !model.antennas.iter().any(is_under_way)
    {
        StopLook::AllStopped
    } else {
        StopLook::Ready
    }
}

/// Returns `true` if an antenna moves or is about to.
fn is_under_way(antenna: &AntennaModel) -> bool {
    antenna.snapshot.state.measured.is_some_and(|measured| measured.moving())
        || antenna.snapshot.jog.is_some()
        || antenna.tracks()
        || antenna.follows()
}
