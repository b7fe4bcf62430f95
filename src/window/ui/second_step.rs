//! The second step before a command that ends a track or lets a unit start unattended: a question
//! that names the consequence. All views share it, so that mouse, key and screen reader get the
//! same question. Standby and STOP never need it.

use super::{confirm::Question, format, state_sentence::short, words};
use crate::{
    contract::{
        self,
        antenna::AntennaModel,
        driver,
        passes::{PassListKey, PredictedPass},
    },
    device::Pointing,
    model::{Model, UiCommand},
};

/// Removes the first of the `commands` from index `start` on that needs a second step. Returns its
/// question.
pub(super) fn ask(model: &Model, start: usize, commands: &mut Vec<UiCommand>) -> Option<Question> {
    let found = commands.iter().enumerate().skip(start);
    let mut found = found.filter_map(|(index, command)| Some((index, question(model, command)?)));
    let (index, question) = found.next()?;
    commands.remove(index);
    Some(question)
}

/// Returns the question before `command`; `None` if it needs none.
fn question(model: &Model, command: &UiCommand) -> Option<Question> {
    if let UiCommand::AskToTrack(pass) = command {
        return before_a_track(model, *pass);
    }
    let UiCommand::Station(station) = command else { return None };
    let antenna = model.antenna_of(station.antenna()?)?;
    let name = &antenna.config.name;
    if let contract::Command::Antenna(_, driver::Command::AutoTrack(true)) = station {
        let ends = match antenna.tracked_name() {
            Some(tracked) => format!(" It tracks {} now.", short(tracked)),
            None => String::new(),
        };
        return Some(Question {
            text: format!(
                "{name} starts the next pass by itself, even if this computer is off.{ends}"
            ),
            yes: "Switch auto-track on",
            command: command.clone(),
        });
    }
    let (subject, yes) = step_text(model, antenna, station)?;
    let tracked = antenna.tracked_name().map(short)?;
    let end_text = end(model, antenna)
        .map(|los| format!(" until {}", format::moment(los, model.now)))
        .unwrap_or_default();
    let text = format!("{name} tracks {tracked}{end_text}. {subject} ends that.");
    Some(Question { text, yes, command: command.clone() })
}

/// Returns the question before parking by key. The button of the card uses a hold instead.
pub(super) fn before_parking(antenna: &AntennaModel) -> Question {
    let name = &antenna.config.name;
    let ends = antenna.tracked_name().map_or_else(
        || " The antenna moves.".to_owned(),
        |tracked| format!(" That ends the track of {}.", short(tracked)),
    );
    Question {
        text: format!("Park {name}? {}{ends}", words::parks_at(antenna)),
        yes: "Park",
        command: UiCommand::antenna(antenna.id(), driver::Command::Park),
    }
}

/// Returns the question before a track, which names the track that it ends.
fn before_a_track(model: &Model, pass: PassListKey) -> Option<Question> {
    let (antenna, predicted) = (model.antenna()?, model.pass_lists.find(pass)?);
    let track = contract::Command::Track { antenna: antenna.id(), pass, is_agreed: false };
    let track = UiCommand::Station(track);
    let default_question = || Question {
        text: format!(
            "Track {} with {}? The antenna moves{}.",
            predicted.satellite.short_name(),
            antenna.config.name,
            way_there(model, antenna, predicted).unwrap_or_default()
        ),
        yes: "Track",
        command: track.clone(),
    };
    Some(question(model, &track).unwrap_or_else(default_question))
}

/// Describes the slew to the start of a pass, or to the point where the antenna would join a
/// current pass.
fn way_there(model: &Model, antenna: &AntennaModel, predicted: &PredictedPass) -> Option<String> {
    let can = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured.filter(|_| antenna.is_live())?;
    let track = predicted.track();
    let joining = model.planned_from_here(antenna)?.joining(track)?;
    let end = track.iter().find(|sample| sample.time >= joining.met)?.direction;
    let elevation = can.has_elevation().then_some(end.elevation);
    let target = Pointing { azimuth: Some(end.azimuth), elevation };
    Some(format!(
        " from {} to {} and {}",
        format::pointing(measured.pointing, can),
        format::pointing(target, can),
        words::needs(joining)
    ))
}

/// Returns the consequence of a command that would end a track, and the label of its button.
fn step_text(
    model: &Model,
    antenna: &AntennaModel,
    command: &contract::Command,
) -> Option<(String, &'static str)> {
    let by_hand = |words: &str, yes| Some((words.to_owned(), yes));
    match command {
        contract::Command::Antenna(_, command) => match command {
            driver::Command::Manual => by_hand("Moving by hand", "Manual"),
            driver::Command::Hold => by_hand("Position", "Position"),
            driver::Command::Position { .. } => by_hand("Going to a direction", "Go"),
            driver::Command::ProgramTrack(track) | driver::Command::ProgramTrackIntoSun(track) => {
                Some((format!("Tracking {}", short(&track.target.name())), "Track"))
            }
            _ => None,
        },
        contract::Command::Track { pass, .. }
        | contract::Command::ProgramTrackPass { pass, .. } => {
            let (number, _) = *pass;
            let is_other = antenna.tracked_number() != Some(number);
            is_other.then(|| (tracking(model, *pass), "Track"))
        }
        _ => None,
    }
}

/// Describes the track of a pass, with the time that the antenna would wait for it.
fn tracking(model: &Model, pass: PassListKey) -> String {
    let (_, aos) = pass;
    let listed = model.pass_lists.find(pass);
    let name = listed.map_or("the other pass", |listed| listed.satellite.short_name());
    if aos > model.now {
        format!("Tracking {name}, which rises in {},", format::time_left(model.now, aos))
    } else {
        format!("Tracking {name}")
    }
}

/// Returns the end of the current track.
fn end(model: &Model, antenna: &AntennaModel) -> Option<jiff::Timestamp> {
    let snapshot = &antenna.snapshot;
    let window = snapshot.state.on_board.window.filter(|_| !antenna.follows());
    let los = window.map(|(_, stop)| stop).or_else(|| {
        let number = antenna.tracked_number()?;
        let listed = model.pass_lists.favourites.upcoming(model.now);
        let under_way = |number| {
            listed
                .iter()
                .find(|predicted| predicted.number() == number && predicted.in_progress(model.now))
        };
        under_way(number)
            .filter(|predicted| !predicted.pass.ends_after)
            .map(|predicted| predicted.pass.los.time)
    });
    los.filter(|los| *los > model.now)
}
