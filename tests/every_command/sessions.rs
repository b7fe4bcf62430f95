//! Every command to a session: at rest, in motion, without a link, and locked out.

use std::time::Duration;

use azel::{
    contract::driver::{Command, Effect, Event, LinkState, LockedOut, Offline, Refusal, Snapshot},
    device::settings::WriteError,
    sim::{Control, Unit},
};

use super::{
    makes::{self, Make, Sent},
    samples::{go_elsewhere, lock_out, name},
};
use crate::common::rig::Rig;

/// Interval of the operator's looks.
const LOOK: Duration = Duration::from_millis(100);

/// Command given to the session of one unit.
struct Trial<'a, U: Unit> {
    make: &'a Make<U>,
    command: &'a Command,
    rig: Rig<Control<U>>,
    /// Number of requests that the unit received before the command.
    before: usize,
}

/// Outcome of a command.
#[derive(Debug)]
struct Outcome {
    /// Requests that the unit received since the command.
    received: Vec<(Sent, String)>,
    events: Vec<Event>,
    shown: Snapshot,
}

impl Outcome {
    /// Returns the refusals that the operator sees.
    fn refusals(&self) -> Vec<&Refusal> {
        let refusals = self.events.iter().filter_map(|event| match event {
            Event::NotSent(refusal) | Event::OffsetRefused(refusal) => Some(refusal),
            _ => None,
        });
        refusals.collect()
    }

    /// Returns the shown error of a change of settings.
    fn write_error(&self, command: &Command) -> Option<WriteError> {
        let Command::WriteSettings(change) = command else { return None };
        let written = self.shown.state.groups.get(change.group)?.written.as_ref()?;
        written.result.clone().err()
    }

    fn has(&self, kind: Sent) -> bool {
        self.received.iter().any(|(sent, _)| *sent == kind)
    }

    /// Returns the requests other than questions.
    fn orders(&self) -> Vec<&(Sent, String)> {
        self.received.iter().filter(|(sent, _)| *sent != Sent::Question).collect()
    }
}

impl<'a, U: Unit> Trial<'a, U> {
    /// Starts a session whose antenna stands, in the mode that the command needs for a motion.
    async fn at_rest(make: &'a Make<U>, command: &'a Command) -> Self {
        let mut rig = (make.connect)().await.looking_every(LOOK);
        let by_hand = matches!(
            command,
            Command::Jog { .. } | Command::Step { .. } | Command::Act(_) | Command::ActUnseen(_)
        );
        rig.send(if by_hand { Command::Manual } else { Command::Hold });
        rig.seconds(0.3).await;
        rig.events();
        Self { make, command, rig, before: 0 }
    }

    /// Starts a session whose antenna moves to a direction, or by hand if the command ends a jog.
    async fn moving(make: &'a Make<U>, command: &'a Command) -> Self {
        let mut trial = Self::at_rest(make, command).await;
        if *command == Command::EndJog {
            trial.rig.send(Command::Manual);
            trial.rig.hold([1.0, 0.0], 0.6).await;
        } else {
            trial.rig.send(Command::Hold);
            trial.rig.send(go_elsewhere());
            trial.rig.seconds(1.5).await;
        }
        trial.rig.events();
        assert!(make.moves(&trial.rig), "it has to move first");
        trial
    }

    /// Returns `true` if the unit received a late question that only this command asks.
    fn asks_late(&self, later: &Outcome) -> bool {
        let Command::Ask(question) = self.command else { return false };
        let asked = |received: &[(Sent, String)]| received.iter().any(|(_, text)| text == question);
        let all = self.make.received(&self.rig, 0);
        asked(&later.received) && !asked(&all[..self.before])
    }

    /// Sends the command and notes the number of earlier requests.
    fn give(&mut self) {
        self.before = self.rig.control.received().len();
        self.rig.send(self.command.clone());
    }

    async fn outcome(&mut self, seconds: f64) -> Outcome {
        self.rig.seconds(seconds).await;
        Outcome {
            received: self.make.received(&self.rig, self.before),
            events: self.rig.events(),
            shown: Snapshot::clone(&self.rig.shown()),
        }
    }
}

/// Differences from the table, collected for one message.
#[derive(Default)]
struct Faults(Vec<String>);

impl Faults {
    fn check(&mut self, is_so: bool, command: &Command, what: &str, outcome: &Outcome) {
        if !is_so {
            let (orders, events) = (outcome.orders(), &outcome.events);
            self.0.push(format!("{command:?}: {what}; sent {orders:?}, told {events:?}"));
        }
    }
}

/// Checks that at rest only a moving command sends a motion. Returns `true` if this command sends
/// one.
async fn at_rest<U: Unit>(make: &Make<U>, command: &Command, faults: &mut Faults) -> bool {
    let row = command.row();
    let mut trial = Trial::at_rest(make, command).await;
    trial.give();
    let outcome = trial.outcome(12.0).await;
    let is_moved = outcome.has(Sent::Motion);
    faults.check(row.effect == Effect::Moves || !is_moved, command, "moves at rest", &outcome);
    let only_asks = row.effect == Effect::Looks || row.in_replay;
    faults.check(!only_asks || outcome.orders().is_empty(), command, "changes", &outcome);
    is_moved
}

/// Checks that a stopping command ends a motion, and that a command without motion does not.
async fn in_motion<U: Unit>(make: &Make<U>, command: &Command, faults: &mut Faults) {
    let mut trial = Trial::moving(make, command).await;
    trial.give();
    // Look early: a jog ends soon unless a key repeats it.
    let at_once = trial.outcome(0.1).await;
    let outcome = trial.outcome(4.0).await;
    let is_moving = make.moves(&trial.rig);
    match command.row().effect {
        Effect::Moves => return,
        // This command ends only motions that the unit may begin, not a motion that Azel commanded.
        Effect::Stops if *command == Command::AutoTrack(false) => {}
        Effect::Stops => {
            let is_stopped = at_once.has(Sent::Stop) && !is_moving;
            faults.check(is_stopped, command, "leaves it moving", &outcome);
        }
        Effect::Changes | Effect::ChangesSafety | Effect::Looks => {
            faults.check(is_moving, command, "ends the motion", &outcome);
        }
    }
    faults.check(!outcome.has(Sent::Motion), command, "sends a motion", &outcome);
}

/// Checks a command without a link, while the antenna moved at the last reading.
async fn without_a_link<U: Unit>(make: &Make<U>, command: &Command, faults: &mut Faults) {
    let row = command.row();
    let mut trial = Trial::moving(make, command).await;
    trial.rig.set_off(true);
    trial.rig.until("lost", 10, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    trial.rig.events();
    trial.give();
    let at_once = trial.outcome(0.3).await;
    trial.rig.set_off(false);
    let later = trial.outcome(8.0).await;
    let refusals = at_once.refusals();
    let is_as_said = match row.offline {
        Offline::CarriedOut => refusals.is_empty(),
        Offline::EndsMotion => {
            let is_stop_first = later.received.first().is_some_and(|(sent, _)| *sent == Sent::Stop);
            refusals == [&Refusal::PositionUnknown] && is_stop_first
        }
        Offline::Refused => {
            let is_shown = at_once.write_error(command) == Some(WriteError::NoLink);
            refusals == [&Refusal::PositionUnknown] || is_shown
        }
        Offline::Dropped => at_once.events.is_empty(),
    };
    faults.check(is_as_said, command, "without a link", &at_once);
    let is_late = later.has(Sent::Motion) || later.has(Sent::Change) || trial.asks_late(&later);
    let is_told_late = !later.refusals().is_empty();
    faults.check(!is_late && !is_told_late, command, "is carried out late", &later);
    let may_stop = row.offline == Offline::EndsMotion || row.effect == Effect::Stops;
    faults.check(may_stop || !later.has(Sent::Stop), command, "ends the motion", &later);
}

/// Checks that a locked-out unit receives only questions and STOP.
async fn locked_out<U: Unit>(
    make: &Make<U>,
    command: &Command,
    has_link: bool,
    faults: &mut Faults,
) {
    let row = command.row();
    let mut trial = Trial::at_rest(make, command).await;
    trial.rig.send(Command::LockOut(lock_out()));
    trial.rig.until("locked out", 10, |shown| shown.lock_out.is_some() && !shown.locking).await;
    trial.rig.seconds(3.0).await;
    trial.rig.set_off(!has_link);
    trial.rig.seconds(1.0).await;
    trial.rig.events();
    trial.give();
    let outcome = trial.outcome(3.0).await;
    trial.rig.set_off(false);
    let later = trial.outcome(8.0).await;
    let (by, reason) = (lock_out().operator, lock_out().reason);
    let panel = [Event::NotSent(Refusal::PanelLockedOut { operator: by.clone() })];
    let locked = Refusal::LockedOut { operator: by, reason };
    let is_refused_here = outcome.events == [Event::NotSent(locked.clone())];
    let is_taken = !outcome.refusals().contains(&&locked);
    let is_as_said = match row.locked_out {
        LockedOut::Refused => is_refused_here,
        LockedOut::RefusedAtTheGate if outcome.shown.link.is_open() => {
            let refusals = outcome.refusals();
            let is_told = refusals == [&locked] || refusals == [&Refusal::NotOffered];
            is_told || outcome.write_error(command) == Some(WriteError::LockedOut)
        }
        // Without a link, the session refuses the command itself or drops it.
        LockedOut::RefusedAtTheGate => match row.offline {
            Offline::Refused => is_refused_here,
            Offline::Dropped => outcome.events.is_empty(),
            Offline::CarriedOut | Offline::EndsMotion => false,
        },
        LockedOut::TakesPanel if make.waits_for_word => outcome.events == panel,
        LockedOut::Taken | LockedOut::TakesPanel => is_taken,
    };
    let state = if has_link { "locked out" } else { "locked out, without a link" };
    faults.check(is_as_said, command, state, &outcome);
    for outcome in [&outcome, &later] {
        let is_moved = outcome.has(Sent::Motion) || outcome.has(Sent::Change);
        faults.check(!is_moved, command, state, outcome);
        // Any question would take the panel from the person who works on the unit.
        let is_quiet = !make.waits_for_word || outcome.received.is_empty();
        faults.check(is_quiet, command, "takes the panel", outcome);
    }
}

/// Returns the commands that move the antenna of this make at rest.
async fn all_states<U: Unit>(make: &Make<U>) -> Vec<String> {
    let (mut moving, mut faults) = (Vec::new(), Faults::default());
    for command in &make.commands {
        if at_rest(make, command, &mut faults).await {
            moving.push(name(command));
        }
        in_motion(make, command, &mut faults).await;
        without_a_link(make, command, &mut faults).await;
        locked_out(make, command, true, &mut faults).await;
        locked_out(make, command, false, &mut faults).await;
    }
    assert!(faults.0.is_empty(), "{:#?}", faults.0);
    moving
}

#[tokio::test(start_paused = true)]
async fn a_satrak_gets_what_the_table_says() {
    let moving = all_states(&makes::satrak()).await;
    let by_hand = ["Jog", "MoveAway", "Step", "Position"];
    let further = ["Track", "ProgramTrack", "ProgramTrackIntoSun", "Park", "AutoTrack(true)"];
    assert!(moving.iter().eq(by_hand.iter().chain(&further)), "{moving:?}");
}

#[tokio::test(start_paused = true)]
async fn a_rotator_genius_gets_what_the_table_says() {
    let moving = all_states(&makes::genius()).await;
    let expected = ["Jog", "MoveAway", "Position", "ProgramTrack", "ProgramTrackIntoSun", "Park"];
    assert_eq!(moving, expected);
}

#[tokio::test(start_paused = true)]
async fn an_rc2000c_gets_what_the_table_says() {
    let moving = all_states(&makes::rc2000c()).await;
    let by_hand = ["Jog", "MoveAway", "Position"];
    let further = ["ProgramTrack", "ProgramTrackIntoSun", "Park", "Act", "ActUnseen"];
    assert!(moving.iter().eq(by_hand.iter().chain(&further)), "{moving:?}");
}
