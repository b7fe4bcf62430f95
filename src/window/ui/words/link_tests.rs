//! Words for tests of links: the outcome, and the checks to make.

use std::time::Duration;

use jiff::Timestamp;

use super::clock;
use crate::{
    astro::time::seconds_between,
    contract::{
        driver::{LinkFault, LinkFinding},
        link_tests::{LinkTest, LinkTestStage},
    },
    device::{AntennaState, panel::CheckState},
    station::{ControllerSpec, Link},
    ui::{format, widgets::status_line::Tone, words::sentence},
};

/// Age below which a test shows no age, seconds.
const JUST_NOW_S: f64 = 10.0;

/// Formats a place on the ground as coordinates.
pub fn place(latitude_deg: f64, longitude_deg: f64) -> String {
    format!("{}, {}", format::latitude(latitude_deg, 3), format::longitude(longitude_deg, 3))
}

/// Returns `true` if the expected unit answered.
pub fn link_test_reached(test: &LinkTest) -> bool {
    reached_state(test).is_some()
}

/// Returns the number of faults that a reached unit reports.
pub fn link_test_faults(test: &LinkTest) -> usize {
    reached_state(test).map_or(0, |state| count(state, CheckState::Fault))
}

fn reached_state(test: &LinkTest) -> Option<&AntennaState> {
    match &test.stage {
        LinkTestStage::Done { finding: LinkFinding::Reached { state, .. }, .. } => {
            Some(&**state).filter(|state| !state.is_other_device)
        }
        LinkTestStage::Done { .. }
        | LinkTestStage::Working
        | LinkTestStage::InUse
        | LinkTestStage::Elsewhere(_) => None,
    }
}

fn count(state: &AntennaState, check_state: CheckState) -> usize {
    state.checks.iter().filter(|check| check.state == check_state).count()
}

/// Returns the state of a test in a few words.
pub fn link_test_state(test: Option<&LinkTest>) -> (Tone, String) {
    let Some(test) = test else { return (Tone::Plain, "not tested".to_owned()) };
    let (tone, words) = match &test.stage {
        LinkTestStage::Working => (Tone::Now, "asking"),
        LinkTestStage::InUse => (Tone::Plain, "in use"),
        LinkTestStage::Elsewhere(_) => (Tone::Caution, "held elsewhere"),
        LinkTestStage::Done { finding, .. } => match finding {
            LinkFinding::Reached { state, .. } if state.is_other_device => {
                (Tone::Caution, "another unit")
            }
            LinkFinding::Reached { after, state } => return reached_in_short(*after, state),
            LinkFinding::Silent | LinkFinding::Closed => (Tone::Bad, "no answer"),
            LinkFinding::SomethingElse { .. } => (Tone::Bad, "something else"),
            LinkFinding::NotOpened(_) => (Tone::Bad, "not reached"),
        },
    };
    (tone, words.to_owned())
}

fn reached_in_short(after: Duration, state: &AntennaState) -> (Tone, String) {
    let faults = count(state, CheckState::Fault);
    let warnings = count(state, CheckState::Caution);
    match (faults, warnings, state.unreadable) {
        (0, 0, None) => (Tone::Good, format!("reached, {} ms", after.as_millis())),
        (0, 0, Some(_)) => (Tone::Caution, "reached, not readable".to_owned()),
        (0, warnings, _) => {
            (Tone::Caution, format!("reached, {}", format::counted(warnings, "warning")))
        }
        (faults, _, _) => (Tone::Caution, format!("reached, {}", format::counted(faults, "fault"))),
    }
}

/// Returns the outcome of a test, the checks to make, and the age of the test at `now`.
pub fn link_test(test: &LinkTest, is_demo: bool, now: Timestamp) -> Vec<(Tone, String)> {
    let connection = &test.antenna.connection;
    let (spec, address) = (connection.spec(), connection.address.as_str());
    match &test.stage {
        LinkTestStage::Working => vec![(Tone::Now, format!("Asking {address}."))],
        LinkTestStage::InUse if !is_demo => {
            let words = "Not asked: an antenna of this station uses the unit. See its card.";
            vec![(Tone::Plain, words.to_owned())]
        }
        LinkTestStage::InUse => vec![
            (Tone::Bad, "This is a simulated unit of the demo station, which ends.".to_owned()),
            (Tone::Plain, "Type the address of your unit.".to_owned()),
        ],
        LinkTestStage::Elsewhere(holder) => vec![
            (Tone::Caution, format!("Not asked: {holder} holds this unit.")),
            (Tone::Plain, "Close it there first: a unit obeys one Azel at a time.".to_owned()),
        ],
        LinkTestStage::Done { finding, time } => {
            let mut lines = finding_words(finding, spec, address);
            lines.push((Tone::Plain, format!("Tested {}.", ago(*time, now))));
            lines
        }
    }
}

fn ago(time: Timestamp, now: Timestamp) -> String {
    let age_s = seconds_between(time, now);
    if age_s < JUST_NOW_S { "just now".to_owned() } else { format!("{} ago", format::age(age_s)) }
}

fn finding_words(
    finding: &LinkFinding,
    spec: &ControllerSpec,
    address: &str,
) -> Vec<(Tone, String)> {
    let port_opens = match spec.link {
        Link::Tcp => {
            "The port opens. Check that it is the port of the unit, and that no other program \
             holds the unit."
        }
        Link::Line { .. } => {
            "The line opens. Compare the settings above with the unit's menu, check the cable, \
             and make sure that nobody uses its panel."
        }
    };
    let bad = |subject: String, check: String| vec![(Tone::Bad, subject), (Tone::Plain, check)];
    match finding {
        LinkFinding::Reached { after, state } => reached(after.as_millis(), state, spec),
        LinkFinding::Silent => {
            bad(format!("Nothing came from {address} in 2 s."), port_opens.to_owned())
        }
        LinkFinding::Closed => bad(
            format!("{address} closed the connection without an answer."),
            spec.closed_note.map_or_else(|| port_opens.to_owned(), sentence),
        ),
        LinkFinding::SomethingElse { text } if text.is_empty() => {
            bad(format!("Something else answers at {address}."), port_opens.to_owned())
        }
        LinkFinding::SomethingElse { text } => bad(
            format!("Something else answers at {address}: {text}"),
            "Check the port.".to_owned(),
        ),
        LinkFinding::NotOpened(fault) => not_opened(fault, spec, address),
    }
}

fn not_opened(fault: &LinkFault, spec: &ControllerSpec, address: &str) -> Vec<(Tone, String)> {
    let (subject, check) = match fault {
        LinkFault::Refused => (
            format!("{address} refuses the connection."),
            format!(
                "The host is there. Check the port. {}",
                spec.closed_note.map(sentence).unwrap_or_default()
            ),
        ),
        LinkFault::NobodyThere => (
            format!("Nobody answers at {address}."),
            "Check the address, the power of the unit and the network.".to_owned(),
        ),
        LinkFault::NoSuchPort => (
            format!("There is no serial port {address}."),
            "Check its name, and that the adapter is plugged in.".to_owned(),
        ),
        LinkFault::NotPermitted => (
            format!("This user may not open {address}."),
            "On Linux, add the user to the dialout group and log in again.".to_owned(),
        ),
        LinkFault::Busy => {
            (format!("Another program uses {address}."), "Close it there first.".to_owned())
        }
        LinkFault::Other(text) => {
            (format!("{address} cannot be opened: {text}."), "Check the address.".to_owned())
        }
    };
    vec![(Tone::Bad, subject), (Tone::Plain, check.trim().to_owned())]
}

fn reached(after_ms: u128, state: &AntennaState, spec: &ControllerSpec) -> Vec<(Tone, String)> {
    let spoken = state.identity.as_deref().or(state.unit_name.as_deref());
    let spoken = spoken.map(|spoken| format!(", {spoken}")).unwrap_or_default();
    if state.is_other_device {
        let subject = format!("Reached{spoken}, {after_ms} ms, but this is not the expected unit.");
        let check = format!("Check that a {} answers there and that it needs no code.", spec.name);
        return vec![(Tone::Caution, subject), (Tone::Plain, check)];
    }
    let mut lines = vec![(Tone::Good, format!("Reached{spoken}, {after_ms} ms."))];
    let mut facts = Vec::new();
    if let Some(direction) = state.measured.and_then(|measured| measured.direction()) {
        facts.push(format!("It pointed at {}.", format::pointing_at(direction)));
    }
    if let Some(own) = state.on_board.place {
        let place_text = place(own.latitude_deg, own.longitude_deg);
        facts.push(format!("Its own location: {place_text}."));
    }
    if let Some(own) = state.on_board.clock.filter(|own| own.is_set) {
        facts.push(if clock::agrees(own.ahead_s) {
            "Its clock agrees with this computer's.".to_owned()
        } else {
            format!("Its clock is {}.", clock::side(own.ahead_s))
        });
    }
    if !facts.is_empty() {
        lines.push((Tone::Plain, facts.join(" ")));
    }
    let wrong = state
        .checks
        .iter()
        .filter(|check| matches!(check.state, CheckState::Caution | CheckState::Fault));
    lines.extend(wrong.map(|check| (Tone::Caution, format!("{}: {}", check.name, check.advice))));
    if let Some(reason) = state.unreadable {
        lines.push((Tone::Caution, reason.to_string()));
    }
    lines
}
