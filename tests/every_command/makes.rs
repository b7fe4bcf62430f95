//! Simulated units that the tests give every command to.

use std::{future::Future, pin::Pin};

use azel::{
    contract::driver::Command,
    controller::rotator_genius::Rotators,
    device::settings::{Change, Value},
    plan::Bounds,
    sim::{Control, Unit, rc2000c, rotator_genius, satrak},
    station::{Antenna, Station},
};

use super::samples::{self, Values};
use crate::{
    common::{mast, rig::Rig},
    genius_session::rig as genius,
    rc2000c_session::rig as horn,
    satrak_session::scene,
};

/// Kind of a request that a unit received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sent {
    Question,
    Stop,
    Motion,
    Change,
}

pub(super) type Connecting<U> = Pin<Box<dyn Future<Output = Rig<Control<U>>>>>;

/// Make of a unit, with functions that classify the requests and the motion of the unit.
pub(super) struct Make<U: Unit> {
    /// Start of a session that has read its unit; the antenna stands.
    pub(super) connect: fn() -> Connecting<U>,
    text: fn(&U::Request) -> String,
    sent: fn(&str) -> Sent,
    moves: fn(&U::Snapshot) -> bool,
    antenna: fn() -> Antenna,
    /// `true` if a question would take the panel from the person who works on the unit.
    pub(super) waits_for_word: bool,
    pub(super) commands: Vec<Command>,
}

impl<U: Unit> Make<U> {
    /// Returns the requests that the unit received after its first `skipped` ones.
    pub(super) fn received(&self, rig: &Rig<Control<U>>, skipped: usize) -> Vec<(Sent, String)> {
        let received = rig.control.received().into_iter().skip(skipped);
        let text = received.map(|(_, request)| (self.text)(&request));
        text.map(|text| ((self.sent)(&text), text)).collect()
    }

    /// Returns the bounds of the antenna with a mast at its start position.
    pub(super) fn within_a_mast(&self) -> Bounds {
        let corners_deg = [(150.0, -5.0), (200.0, -5.0), (200.0, 60.0), (150.0, 60.0)];
        let station = Station { keep_outs: vec![mast(&corners_deg)], ..Station::default() };
        Bounds::new(&station, &(self.antenna)())
    }

    pub(super) fn moves(&self, rig: &Rig<Control<U>>) -> bool {
        (self.moves)(&rig.control.state())
    }
}

fn change(group: &'static str, field: &'static str, value: Value) -> Change {
    Change { ticket: 1, group, values: [(field, value)].into(), expected: None, is_unlocked: true }
}

fn values(
    act: &'static str,
    change: Change,
    group: &'static str,
    question: &'static str,
) -> Values {
    let (pass, site) = (scene::on_board(scene::iss()), scene::site());
    Values { pass, site, act, change, group, question }
}

pub(super) fn satrak_sent(payload: &str) -> Sent {
    match payload {
        "STOP=" | "TRACK=,0" | "TRACK_AUTO_ENABLE=,0" => Sent::Stop,
        "TRACK=,1" | "TRACK_AUTO_ENABLE=,1" => Sent::Motion,
        _ if ["MOVE=", "STEP=", "GOTO="].iter().any(|word| payload.starts_with(word)) => {
            Sent::Motion
        }
        _ if payload.ends_with('?') => Sent::Question,
        _ => Sent::Change,
    }
}

pub(super) fn genius_sent(command: &str) -> Sent {
    match command.get(..2) {
        Some("|h") => Sent::Question,
        Some("|S") => Sent::Stop,
        Some("|c") => Sent::Change,
        _ => Sent::Motion,
    }
}

fn rc2000c_sent(command: &str) -> Sent {
    match command.get(..1) {
        Some("0" | "1" | "5") => Sent::Question,
        Some("3") if command == "3XS0000" => Sent::Stop,
        Some("6") => Sent::Change,
        _ => Sent::Motion,
    }
}

pub(super) fn values_of_satrak() -> Values {
    let lead = change("general", "lead_ms", Value::Integer(90_000));
    values("anything", lead, "web", "REDUCTION?")
}

pub(super) fn values_of_genius() -> Values {
    let offset = change("rotator_1", "stop_offset_deg", Value::Integer(3));
    values("rescue", offset, "rotator_1", "|h")
}

pub(super) fn satrak() -> Make<impl Unit> {
    Make {
        connect: || Box::pin(Rig::<satrak::Control>::usual()),
        text: String::clone,
        sent: satrak_sent,
        moves: |unit: &satrak::Snapshot| unit.is_moving,
        antenna: scene::antenna,
        waits_for_word: false,
        commands: samples::commands(&values_of_satrak()),
    }
}

pub(super) fn genius() -> Make<impl Unit> {
    Make {
        connect: || {
            Box::pin(async {
                Rig::<rotator_genius::Control>::connected(&genius::pair(), Rotators::Pair).await
            })
        },
        text: String::clone,
        sent: genius_sent,
        moves: |unit: &rotator_genius::Snapshot| unit.rotators.iter().any(|of| of.is_turning),
        antenna: || genius::antenna(Rotators::Pair),
        waits_for_word: false,
        commands: samples::commands(&values_of_genius()),
    }
}

pub(super) fn rc2000c() -> Make<impl Unit> {
    // The RC2000C has no settings, so no change can show a refusal.
    let none = change("none", "none", Value::Flag(true));
    Make {
        connect: || {
            Box::pin(async {
                let options = rc2000c::Options::default();
                Rig::<rc2000c::Control>::connected(&options, &horn::antenna()).await
            })
        },
        text: |frame| {
            format!("{}{}", char::from(frame.code()), String::from_utf8_lossy(frame.data()))
        },
        sent: rc2000c_sent,
        moves: |unit: &rc2000c::Snapshot| unit.is_turning,
        antenna: horn::antenna,
        waits_for_word: true,
        commands: {
            let mut commands = samples::commands(&values("polarity_h", none, "none", "1"));
            commands.retain(|command| !matches!(command, Command::WriteSettings(_)));
            commands
        },
    }
}
