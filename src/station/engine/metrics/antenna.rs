//! Metrics of one antenna, from the snapshot of the station.

use std::time::Duration;

use super::families::{Families, Labels, Metric, flag};
use crate::{
    astro::{Angle, time::seconds_between},
    clock::Moment,
    contract::{
        antenna::AntennaModel,
        automatic::Operation,
        control::Party,
        driver::{Intent, LinkState, StopState},
    },
    device::Measured,
    plan::schedule::Schedule,
};

/// Max age of a position that a metric shows as the current one, as for other programs.
const MAX_AGE: Duration = Duration::from_secs(3);
/// Max age of a reading of a unit's clock.
const MAX_CLOCK_AGE_S: f64 = 600.0;

const LINK: Metric = Metric::gauge("azel_link_state", "1 for the state of the link.");
const LINK_AGE: Metric =
    Metric::gauge("azel_link_state_age", "Time since the link came into its state, or of silence.")
        .in_unit("seconds");
const FRAMES: Metric =
    Metric::counter("azel_link_frames", "Frames from the unit since the link came up.");
const UNANSWERED: Metric =
    Metric::counter("azel_link_unanswered", "Questions to the unit without an answer in time.");
const POSITION_AGE: Metric =
    Metric::gauge("azel_position_age", "Age of the last measured position.").in_unit("seconds");
const AZIMUTH: Metric =
    Metric::gauge("azel_azimuth", "Measured azimuth, at most 3 s old.").in_unit("degrees");
const ELEVATION: Metric =
    Metric::gauge("azel_elevation", "Measured elevation, at most 3 s old.").in_unit("degrees");
const MOVING: Metric = Metric::gauge("azel_moving", "1 while an axis turns or may turn.");
const TRACKING: Metric = Metric::gauge("azel_tracking", "1 while the antenna tracks a target.");
const DEMANDED_AZIMUTH: Metric =
    Metric::gauge("azel_demanded_azimuth", "Azimuth of the tracked target.").in_unit("degrees");
const DEMANDED_ELEVATION: Metric =
    Metric::gauge("azel_demanded_elevation", "Elevation of the tracked target.").in_unit("degrees");
const ERROR: Metric =
    Metric::gauge("azel_pointing_error", "Angle between the beam and the tracked target.")
        .in_unit("degrees");
const BEAM: Metric =
    Metric::gauge("azel_beam_width", "Beamwidth of the antenna.").in_unit("degrees");
const INTENT: Metric = Metric::gauge("azel_intent", "1 for the mode that the operator chose.");
const AUTOMATIC: Metric =
    Metric::gauge("azel_automatic", "1 for the state of automatic operation.");
const CONTROL: Metric = Metric::gauge("azel_control", "1 for the party in control.");
const PROGRAMS: Metric =
    Metric::gauge("azel_programs", "Programs that are connected to the port of the antenna.");
const LOCKED_OUT: Metric = Metric::gauge("azel_locked_out", "1 while the unit is locked out.");
const ELSEWHERE: Metric =
    Metric::gauge("azel_driven_elsewhere", "1 while another Azel drives the unit.");
const PASSES: Metric =
    Metric::counter("azel_passes", "Passes of the schedule that are over, by outcome.");
const PLANNED: Metric =
    Metric::counter("azel_passes_planned", "Time of these passes that was to be tracked.")
        .in_unit("seconds");
const IN_BEAM: Metric =
    Metric::counter("azel_passes_in_beam", "Time of these passes within half the beamwidth.")
        .in_unit("seconds");
const NEXT_PASS: Metric =
    Metric::gauge("azel_next_pass_start_timestamp", "Unix time at which the next track starts.")
        .in_unit("seconds");
const STOP: Metric = Metric::gauge("azel_stop_state", "1 for the state of STOP.");
const STOP_PENDING: Metric =
    Metric::gauge("azel_stop_pending", "Time since a STOP without proof; 0 without such a STOP.")
        .in_unit("seconds");
const STOPS: Metric = Metric::counter("azel_stops", "STOPs of the operator.");
const STOPS_PROVED: Metric =
    Metric::counter("azel_stops_proved", "STOPs whose standstill was proved.");
const STOP_LATENCY: Metric =
    Metric::gauge("azel_stop_latency", "Time from the last STOP to the end of its first write.")
        .in_unit("seconds");
const STOP_PROOF: Metric =
    Metric::gauge("azel_stop_proof", "Time from the last proved STOP to its proof.")
        .in_unit("seconds");
const CLOCK: Metric =
    Metric::gauge("azel_unit_clock_offset", "Lead of the unit's clock over this computer's.")
        .in_unit("seconds");

pub(super) const METRICS: [Metric; 30] = [
    LINK,
    LINK_AGE,
    FRAMES,
    UNANSWERED,
    POSITION_AGE,
    AZIMUTH,
    ELEVATION,
    MOVING,
    TRACKING,
    DEMANDED_AZIMUTH,
    DEMANDED_ELEVATION,
    ERROR,
    BEAM,
    INTENT,
    AUTOMATIC,
    CONTROL,
    PROGRAMS,
    LOCKED_OUT,
    ELSEWHERE,
    PASSES,
    PLANNED,
    IN_BEAM,
    NEXT_PASS,
    STOP,
    STOP_PENDING,
    STOPS,
    STOPS_PROVED,
    STOP_LATENCY,
    STOP_PROOF,
    CLOCK,
];

/// Labels of an antenna.
pub(super) fn labels(antenna: &AntennaModel) -> Labels {
    vec![("antenna", antenna.config.name.clone()), ("make", antenna.spec().key.to_owned())]
}

/// Adds the metrics of an antenna.
pub(super) fn add(
    families: &mut Families,
    antenna: &AntennaModel,
    schedule: &Schedule,
    now: Moment,
) {
    let labels = labels(antenna);
    add_link(families, antenna, &labels, now);
    add_position(families, antenna, &labels, now);
    add_operation(families, antenna, &labels);
    add_passes(families, antenna, &labels, schedule, now);
    add_stops(families, antenna, &labels, now);
}

fn labelled(labels: &Labels, key: &'static str, value: &str) -> Labels {
    let mut labels = labels.clone();
    labels.push((key, value.to_owned()));
    labels
}

fn add_link(families: &mut Families, antenna: &AntennaModel, labels: &Labels, now: Moment) {
    const STATES: [&str; 5] = ["off", "connecting", "up", "stale", "lost"];
    let (state, start) = match &antenna.snapshot.link {
        LinkState::Off => ("off", None),
        LinkState::Connecting { start } => ("connecting", Some(start)),
        LinkState::Up { start } => ("up", Some(start)),
        LinkState::Stale { as_of } => ("stale", Some(as_of)),
        LinkState::Lost { start, .. } => ("lost", Some(start)),
    };
    families.add_states(LINK, labels, "state", (&STATES, state));
    let age = start.map(|start| now.steady.saturating_duration_since(*start).as_secs_f64());
    families.add(LINK_AGE, labels.clone(), age);
    let traffic = &antenna.snapshot.state.traffic;
    for (kind, count) in [
        ("reply", traffic.replies),
        ("unsolicited", traffic.unsolicited),
        ("damaged", traffic.damaged),
        ("unreadable", traffic.unreadable),
    ] {
        families.add(FRAMES, labelled(labels, "kind", kind), count as f64);
    }
    families.add(UNANSWERED, labels.clone(), traffic.unanswered as f64);
    let clock = antenna.snapshot.state.on_board.clock.filter(|clock| {
        let age_s = seconds_between(clock.read_at, now.utc);
        clock.is_set && antenna.is_live() && (0.0..=MAX_CLOCK_AGE_S).contains(&age_s)
    });
    families.add(CLOCK, labels.clone(), clock.map(|clock| clock.ahead_s));
}

fn add_position(families: &mut Families, antenna: &AntennaModel, labels: &Labels, now: Moment) {
    let age = |measured: &Measured| now.steady.saturating_duration_since(measured.requested);
    let last = antenna.snapshot.state.measured;
    families.add(POSITION_AGE, labels.clone(), last.map(|last| age(&last).as_secs_f64()));
    families.add(BEAM, labels.clone(), antenna.config.beam_width_deg);
    let current = antenna.snapshot.state.measured_on_link();
    let current = current.filter(|measured| age(measured) <= MAX_AGE);
    let Some(current) = current.filter(|_| antenna.snapshot.link.is_open()) else { return };
    let degrees = |angle: Option<Angle>| angle.map(Angle::degrees);
    families.add(AZIMUTH, labels.clone(), degrees(current.pointing.azimuth));
    families.add(ELEVATION, labels.clone(), degrees(current.pointing.elevation));
    families.add(MOVING, labels.clone(), flag(current.moving()));
    families.add(TRACKING, labels.clone(), flag(antenna.tracks()));
    if !antenna.tracks() {
        return;
    }
    let Some(prediction) = antenna.prediction.filter(|_| antenna.is_live()) else { return };
    let direction = prediction.direction;
    families.add(DEMANDED_AZIMUTH, labels.clone(), direction.azimuth_deg());
    families.add(DEMANDED_ELEVATION, labels.clone(), direction.elevation_deg());
    families.add(ERROR, labels.clone(), antenna.error().map(|error| error.off_beam.degrees()));
}

fn add_operation(families: &mut Families, antenna: &AntennaModel, labels: &Labels) {
    const INTENTS: [&str; 5] = ["standby", "manual", "position", "track", "park"];
    let intent = match antenna.snapshot.intent {
        Intent::Standby => "standby",
        Intent::Manual => "manual",
        Intent::Position => "position",
        Intent::Track => "track",
        Intent::Park => "park",
    };
    families.add_states(INTENT, labels, "intent", (&INTENTS, intent));
    let automatic = match antenna.operation {
        Operation::Off(_) => "off",
        Operation::On(_) => "on",
        Operation::Suspended { .. } => "suspended",
    };
    families.add_states(AUTOMATIC, labels, "state", (&["off", "on", "suspended"], automatic));
    let party = match antenna.control.party {
        None => "none",
        Some(Party::Window) => "window",
        Some(Party::Automatic) => "automatic",
        Some(Party::Command) => "command",
        Some(Party::Program(_)) => "program",
    };
    let parties = ["none", "window", "automatic", "command", "program"];
    families.add_states(CONTROL, labels, "party", (&parties, party));
    families.add(PROGRAMS, labels.clone(), antenna.control.clients.len() as f64);
    families.add(LOCKED_OUT, labels.clone(), flag(antenna.snapshot.lock_out.is_some()));
    families.add(ELSEWHERE, labels.clone(), flag(antenna.held_by.is_some()));
}

fn add_passes(
    families: &mut Families,
    antenna: &AntennaModel,
    labels: &Labels,
    schedule: &Schedule,
    now: Moment,
) {
    let tally = &antenna.tally.passes;
    let outcomes = [("whole", tally.whole), ("partial", tally.partial), ("missed", tally.missed)];
    for (outcome, count) in outcomes {
        families.add(PASSES, labelled(labels, "outcome", outcome), count as f64);
    }
    families.add(PLANNED, labels.clone(), tally.planned_s);
    families.add(IN_BEAM, labels.clone(), tally.in_beam_s);
    let entries = schedule.entries.iter().filter(|entry| entry.antenna == antenna.id());
    let next = entries.map(|entry| entry.start).filter(|start| *start > now.utc).min();
    let unix_s = next.map(|start| start.as_microsecond() as f64 / 1e6);
    families.add(NEXT_PASS, labels.clone(), unix_s);
}

fn add_stops(families: &mut Families, antenna: &AntennaModel, labels: &Labels, now: Moment) {
    const STATES: [&str; 4] = ["ready", "stopping", "stopped", "not_confirmed"];
    let (state, start) = match antenna.snapshot.stop {
        StopState::Ready => ("ready", None),
        StopState::Stopping { start } => ("stopping", Some(start)),
        StopState::Stopped { .. } => ("stopped", None),
        StopState::NotConfirmed { start } => ("not_confirmed", Some(start)),
    };
    families.add_states(STOP, labels, "state", (&STATES, state));
    let pending = start.map(|start| now.steady.saturating_duration_since(start));
    families.add(STOP_PENDING, labels.clone(), pending.unwrap_or_default().as_secs_f64());
    let tally = &antenna.tally.stops;
    families.add(STOPS, labels.clone(), tally.pressed as f64);
    families.add(STOPS_PROVED, labels.clone(), tally.proved as f64);
    families.add(STOP_LATENCY, labels.clone(), tally.latency.map(|time| time.as_secs_f64()));
    families.add(STOP_PROOF, labels.clone(), tally.proof.map(|time| time.as_secs_f64()));
}
