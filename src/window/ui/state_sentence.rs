//! The state sentence of an antenna: its activity, the reason and the next step.

mod link;
mod lock_out;
mod news;
mod program_track;

use jiff::Timestamp;

use super::{
    format,
    widgets::sentence::{Sentence, SentenceKind, Span},
    words,
};
use crate::{
    astro::time::add_seconds,
    contract::{
        antenna::AntennaModel,
        driver::{Intent, StopState},
        passes::ListedSatellite,
    },
    device::{JogSpeeds, Phase, Pointing},
    model::Model,
};

/// A sentence, split into parts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Spoken {
    /// Kind of the sentence, which sets its colour.
    pub kind: SentenceKind,
    /// Parts of the sentence; `true` marks a name that must stand out.
    pub parts: Vec<(String, bool)>,
}

impl Spoken {
    fn new(kind: SentenceKind) -> Self {
        Self { kind, parts: Vec::new() }
    }

    fn plain(mut self, text: impl Into<String>) -> Self {
        self.parts.push((text.into(), false));
        self
    }

    fn bold(mut self, text: impl Into<String>) -> Self {
        self.parts.push((text.into(), true));
        self
    }

    /// Returns the sentence as one text.
    pub fn text(&self) -> String {
        self.parts.iter().map(|(text, _)| text.as_str()).collect()
    }

    /// Calls `show` with the sentence in the form of the widget.
    pub fn with_sentence<R>(&self, show: impl FnOnce(&Sentence<'_>) -> R) -> R {
        let spans: Vec<Span<'_>> =
            self.parts.iter().map(|(text, bold)| Span { text, bold: *bold }).collect();
        show(&Sentence { kind: self.kind, spans: &spans })
    }
}

/// Returns the state sentence of `antenna`. The most severe state takes precedence.
pub fn state_sentence(model: &Model, antenna: &AntennaModel) -> Spoken {
    lock_out::sentence(antenna)
        .or_else(|| link::sentence(model, antenna))
        .or_else(|| stop(model, antenna))
        .or_else(|| news::sentence(model, antenna))
        .or_else(|| fault_or_limit(antenna))
        .or_else(|| being_judged(antenna))
        .or_else(|| preparing(antenna))
        .or_else(|| program_track::sentence(model, antenna))
        .or_else(|| program(model, antenna))
        .or_else(|| by_hand(antenna))
        .unwrap_or_else(|| standing(model, antenna))
}

fn stop(model: &Model, antenna: &AntennaModel) -> Option<Spoken> {
    let name = &antenna.config.name;
    match antenna.snapshot.stop {
        StopState::Ready | StopState::Stopped { .. } => antenna.stop_pressed.map(|pressed| {
            let age = model.steady.saturating_duration_since(pressed).as_secs_f64();
            Spoken::new(SentenceKind::Caution).plain(format!(
                "Stopping {name}: STOP was pressed {} ago and is about to be sent.",
                format::age(age)
            ))
        }),
        StopState::Stopping { start } => {
            let age = model.steady.saturating_duration_since(start).as_secs_f64();
            Some(Spoken::new(SentenceKind::Caution).plain(format!(
                "Stopping {name}: STOP was sent {} ago, waiting for standstill.",
                format::age(age)
            )))
        }
        StopState::NotConfirmed { start } => {
            let age = model.steady.saturating_duration_since(start).as_secs_f64();
            Some(Spoken::new(SentenceKind::Fault).plain(format!(
                "{name} is not known to have stopped, {} after STOP. Use the local panel.",
                format::age(age)
            )))
        }
    }
}

fn fault_or_limit(antenna: &AntennaModel) -> Option<Spoken> {
    let state = &antenna.snapshot.state;
    if let Some(check) = state.checks.iter().find(|check| check.forbids_motion()) {
        let words = format!("Motion is locked by a fault: {}. {}", check.name, check.advice);
        // A unit may continue to move without a command.
        let moves = state.measured.is_some_and(|measured| measured.moving());
        let warning = if moves { " It is still moving: STOP ends that." } else { "" };
        return Some(Spoken::new(SentenceKind::Fault).plain(words + warning));
    }
    let measured = state.measured.filter(|measured| !measured.moving())?;
    for (axis, name) in measured.axes.iter().zip(antenna.variant().capabilities.axes) {
        let plus = match (axis.plus_limit, axis.minus_limit) {
            (true, _) => true,
            (_, true) => false,
            _ => continue,
        };
        let (end, back) = (words::way(name, plus), words::way(name, !plus));
        return Some(
            Spoken::new(SentenceKind::Fault).plain(format!(
                "Stopped: {end} limit switch is set. Jog {back} to leave the limit."
            )),
        );
    }
    None
}

/// Returns the sentence for a request that waits until Azel has checked its path.
fn being_judged(antenna: &AntennaModel) -> Option<Spoken> {
    antenna.snapshot.being_judged.then(|| {
        Spoken::new(SentenceKind::Commanded).plain(
            "Being judged: Azel checks the whole way against keep-outs, the Sun and the limits before \
             the antenna goes on.",
        )
    })
}

fn preparing(antenna: &AntennaModel) -> Option<Spoken> {
    let snapshot = &antenna.snapshot;
    let target = snapshot.target.as_ref().filter(|_| snapshot.pending)?;
    Some(
        Spoken::new(SentenceKind::Commanded)
            .plain("Preparing to track ")
            .bold(short(&target.name))
            .plain(": satellite and tracking window are sent to the unit and read back."),
    )
}

/// Returns the sentence for a unit that runs its own program, with or without a request from Azel.
fn program(model: &Model, antenna: &AntennaModel) -> Option<Spoken> {
    let state = &antenna.snapshot.state;
    let program = state.program.filter(|program| program.enabled)?;
    let satellite = state.on_board.satellite.as_ref();
    let name = satellite.map_or("a satellite", |satellite| short(&satellite.name));
    let window = state.on_board.window;
    match program.phase {
        Phase::Tracking => Some(tracking(model, antenna, name)),
        Phase::AtStart | Phase::OutOfWindow => {
            let starts = window.map(|(start, _)| start).filter(|start| *start > model.now);
            let moving = state.measured.is_some_and(|measured| measured.moving());
            let spoken = Spoken::new(SentenceKind::Commanded);
            if moving {
                let spoken = spoken.plain("Moving to the start of the pass of ").bold(name);
                return Some(spoken.plain(tracking_starts(model, starts)));
            }
            let spoken = spoken.plain(format!("Waiting{} for ", place(antenna))).bold(name);
            let lead_s = state.on_board.offsets.map_or(0.0, |offsets| offsets.lead_s);
            let moves = starts.filter(|_| program.phase == Phase::OutOfWindow);
            let moves = moves.map(|start| (start, add_seconds(start, -lead_s)));
            Some(match moves.filter(|(_, time)| lead_s > 0.0 && *time > model.now) {
                Some((start, time)) => spoken.plain(format!(
                    ". The antenna moves to the start at {}, in {}, and tracks from {}.",
                    format::moment(time, model.now),
                    format::time_left(model.now, time),
                    format::moment(start, model.now)
                )),
                None => spoken.plain(tracking_starts(model, starts)),
            })
        }
        Phase::Completed => Some(
            Spoken::new(SentenceKind::Holding)
                .plain("The pass of ")
                .bold(name)
                .plain(format!(" is over. Holding{}.", place(antenna))),
        ),
        Phase::Unknown(code) => Some(
            Spoken::new(SentenceKind::Caution)
                .plain(format!("The unit reports the unknown tracking state {code} for "))
                .bold(name)
                .plain("."),
        ),
    }
}

/// Returns the end of a sentence about an antenna that a unit sends to a pass.
fn tracking_starts(model: &Model, starts: Option<Timestamp>) -> String {
    starts.map_or_else(
        || ". Its tracking window is not open.".to_owned(),
        |start| {
            let left = format::time_left(model.now, start);
            format!(". Its tracking starts at {}, in {left}.", format::moment(start, model.now))
        },
    )
}

fn tracking(model: &Model, antenna: &AntennaModel, name: &str) -> Spoken {
    let half_beam_deg = antenna.config.beam_width_deg / 2.0;
    let has_offsets = !antenna.snapshot.meant_offsets().is_none();
    let own = match (antenna.snapshot.intent == Intent::Track, has_offsets) {
        (true, false) => " with the elements stored on the unit. ",
        (true, true) => " with the elements stored on the unit, and with offsets. ",
        (false, false) => " by its own program. ",
        (false, true) => " by its own program, and with offsets. ",
    };
    let Some(error) = antenna.error() else {
        return Spoken::new(SentenceKind::Tracking)
            .plain("Tracking ")
            .bold(name)
            .plain(own)
            .plain("Azel has no elements of it to compare with.");
    };
    let off_deg = error.off_beam.degrees();
    let arrives = antenna.snapshot.on_board.as_ref().and_then(|view| view.arrives);
    if let Some(arrives) =
        arrives.filter(|instant| *instant > model.steady && off_deg > half_beam_deg)
    {
        let left = arrives.saturating_duration_since(model.steady).as_secs_f64();
        return Spoken::new(SentenceKind::Commanded).plain("Tracking ").bold(name).plain(own).plain(
            format!(
                "The antenna is still turning, {} off the predicted path, expected there within {}.",
                format::degrees(off_deg, 2),
                format::age(left)
            ),
        );
    }
    let after = match antenna.snapshot.state.on_board.window {
        Some((_, stop)) if stop > model.now => {
            let subject = if sets(model, antenna) { "At LOS" } else { "It does not set; at" };
            format!(" {subject} {} it stops and holds.", format::moment(stop, model.now))
        }
        _ => String::new(),
    };
    let (kind, place) = if off_deg <= half_beam_deg {
        (SentenceKind::Tracking, "inside")
    } else {
        (SentenceKind::Caution, "outside")
    };
    Spoken::new(kind).plain("Tracking ").bold(name).plain(own).plain(format!(
        "The antenna is {} off the predicted path, {place} its {} beam.{after}",
        format::degrees(off_deg, 2),
        format::degrees(antenna.config.beam_width_deg, 2)
    ))
}

/// Returns `false` if the tracked satellite is known to stay up within the list.
fn sets(model: &Model, antenna: &AntennaModel) -> bool {
    let Some(number) = antenna.tracked_number() else { return true };
    let lists = [&model.pass_lists.favourites, &model.pass_lists.all];
    let mut listed = lists.into_iter().flat_map(|list| list.passes.iter());
    !listed.any(|predicted| {
        predicted.number() == number
            && predicted.in_progress(model.now)
            && predicted.pass.ends_after
    })
}

fn by_hand(antenna: &AntennaModel) -> Option<Spoken> {
    let snapshot = &antenna.snapshot;
    let [first, second] = antenna.variant().capabilities.axes;
    if let Some([x, y]) = snapshot.jog {
        let (axis, rate) = if x == 0.0 { (second, y) } else { (first, x) };
        return Some(Spoken::new(SentenceKind::Commanded).plain(jogging(antenna, axis, rate)));
    }
    if let Some([x, y]) = snapshot.step {
        let (axis, by_deg) = if x == 0.0 { (second, y) } else { (first, x) };
        return Some(
            Spoken::new(SentenceKind::Commanded)
                .plain(format!("Moving {axis} by {}° in one step.", format::signed(by_deg, 2))),
        );
    }
    let moving = snapshot.state.measured.is_some_and(|measured| measured.moving());
    let aim = snapshot.aim.filter(|_| moving || snapshot.pending)?;
    let verb = if snapshot.intent == Intent::Park { "Parking at" } else { "Moving to" };
    Some(
        Spoken::new(SentenceKind::Commanded)
            .plain(format!("{verb} {}.", format::pointing(aim, antenna.variant().capabilities))),
    )
}

/// Describes a jog. A named speed appears with its name, because its rate is unknown.
fn jogging(antenna: &AntennaModel, axis: &str, rate_deg_s: f64) -> String {
    let speeds = antenna.variant().capabilities.jog;
    let max_deg_s = antenna.config.limits.maximum_rate_deg_s;
    let Some(speed) = speeds.nearest(rate_deg_s, max_deg_s) else {
        let rate = format::signed(rate_deg_s, 2);
        return format!("Jogging {axis} at {rate} °/s while the key is held.");
    };
    let way = words::way(axis, rate_deg_s > 0.0);
    match speeds {
        JogSpeeds::Named([_, _, ..]) => {
            format!("Jogging {way} at speed {} while the key is held.", speed.name)
        }
        _ => format!("Jogging {way} while the key is held."),
    }
}

fn standing(model: &Model, antenna: &AntennaModel) -> Spoken {
    let state = &antenna.snapshot.state;
    if antenna.snapshot.runs_out {
        return Spoken::new(SentenceKind::Holding)
            .plain(format!("Stopping{}: Azel has ended the motion.", place(antenna)));
    }
    if state.measured.is_some_and(|measured| measured.moving()) {
        return Spoken::new(SentenceKind::Caution).plain(
            "Moving, not by this console: somebody else is driving it, or it is coasting to a \
             stop.",
        );
    }
    if let Some(breach) = &antenna.snapshot.breach {
        let words = words::kept_still(&antenna.config.name, breach);
        return Spoken::new(SentenceKind::Caution).plain(words);
    }
    let next = next_words(
        model.selected_pass().map(|predicted| {
            (&*predicted.satellite, predicted.pass.aos.time, predicted.pass.los.time)
        }),
        model.now,
    );
    let stopped = matches!(antenna.snapshot.stop, StopState::Stopped { .. });
    let auto = state.program.is_some_and(|program| program.auto == Some(true));
    let lead = match (stopped, antenna.snapshot.intent) {
        (true, _) => "Stopped, holding",
        (_, Intent::Park) => "Parked, holding",
        _ => "Holding",
    };
    if let Some(missing) = missing_angle(antenna) {
        return Spoken::new(SentenceKind::Caution)
            .plain(format!("{lead}{}. {missing}", place(antenna)));
    }
    let spoken = Spoken::new(SentenceKind::Holding).plain(format!("{lead}{}. ", place(antenna)));
    if auto {
        spoken.plain("Auto-track is on: the unit may start by itself.")
    } else {
        spoken.plain(next)
    }
}

/// Describes the angle that the unit does not report, and the reason.
pub(super) fn missing_angle(antenna: &AntennaModel) -> Option<&'static str> {
    let can = antenna.variant().capabilities;
    let measured = antenna.snapshot.state.measured?;
    let pointing = measured.pointing;
    let elevation_known = pointing.elevation.is_some() || !can.has_elevation();
    let [azimuth, elevation] = measured.axes;
    match (pointing.azimuth.is_some(), elevation_known) {
        (true, true) => None,
        (false, _) if azimuth.minus_limit => {
            Some("At the CCW limit: the unit shows no azimuth there.")
        }
        (false, _) if azimuth.plus_limit => {
            Some("At the CW limit: the unit shows no azimuth there.")
        }
        (_, false) if elevation.minus_limit => {
            Some("At the lower limit: the unit shows no elevation there.")
        }
        (_, false) if elevation.plus_limit => {
            Some("At the upper limit: the unit shows no elevation there.")
        }
        (false, false) => {
            Some("The unit reports no angles: they are not calibrated, or a sensor is missing.")
        }
        (false, true) => {
            Some("The unit reports no azimuth: it is not calibrated, or a sensor is missing.")
        }
        (true, false) => {
            Some("The unit reports no elevation: it is not calibrated, or a sensor is missing.")
        }
    }
}

/// Returns a sentence about the selected pass, which the operator could track.
fn next_words(
    selected: Option<(&ListedSatellite, Timestamp, Timestamp)>,
    now: Timestamp,
) -> String {
    match selected {
        Some((satellite, aos, _)) if aos > now => {
            format!("{} rises in {}.", satellite.short_name(), format::time_left(now, aos))
        }
        Some((satellite, _, los)) if los > now => {
            format!("{} is up but is not being tracked.", satellite.short_name())
        }
        _ => "No pass is selected.".to_owned(),
    }
}

/// Returns the position, such as " at 343.1°, 5.0°"; empty if unknown.
fn place(antenna: &AntennaModel) -> String {
    antenna.snapshot.state.measured.map_or_else(String::new, |measured| match measured.pointing {
        Pointing { azimuth: None, elevation: None } => String::new(),
        pointing => format!(" at {}", format::pointing(pointing, antenna.variant().capabilities)),
    })
}

/// Returns the name without a trailing part in brackets.
pub fn short(name: &str) -> &str {
    name.split_once(" (").map_or(name, |(short, _)| short)
}
