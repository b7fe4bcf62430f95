//! Commands that still wait when the operator presses STOP. Each is void exactly if its row says
//! so, and then leaves only the trace of the STOP. Any other command leaves the same trace as after
//! STOP.

use std::{collections::BTreeSet, time::Duration};

use azel::{
    contract::driver::{Command, Event, Intent, LinkState, Snapshot},
    sim::Unit,
};

use super::{
    makes::{self, Make},
    samples::{lock_out, name},
};

const LOOK: Duration = Duration::from_millis(100);

/// Time at which the test gives the command.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Given {
    Never,
    /// Before STOP: the command still waits when STOP is pressed.
    Before,
    /// After the session has taken STOP.
    After,
}

/// Visible effects of a command.
#[derive(Debug, PartialEq)]
struct Trace {
    /// Requests that the unit received, each once.
    received: BTreeSet<String>,
    events: Vec<Event>,
    intent: Intent,
    is_off: bool,
    is_locked_out: bool,
    may_leave: Option<bool>,
    is_previewed: bool,
    /// Groups of settings whose change has an outcome.
    written: BTreeSet<&'static str>,
}

/// Returns `true` if the command needs a session in another state than the initial one.
fn is_prepared_for(command: &Command) -> bool {
    matches!(command, Command::Connect | Command::Unlock | Command::AllowWayOut)
}

async fn trace<U: Unit>(make: &Make<U>, command: &Command, given: Given) -> Trace {
    let mut rig = (make.connect)().await.looking_every(LOOK);
    match command {
        Command::Connect => rig.send(Command::Disconnect),
        Command::Unlock => rig.send(Command::LockOut(lock_out())),
        // Puts the antenna inside a mast.
        Command::AllowWayOut => rig.handle().keep_within(make.within_a_mast()),
        _ => {}
    }
    rig.seconds(4.0).await;
    rig.events();
    let before = rig.control.received().len();
    if given == Given::Before {
        rig.send(command.clone());
    }
    rig.stop();
    rig.seconds(0.1).await;
    if given == Given::After {
        rig.send(command.clone());
    }
    rig.seconds(12.0).await;
    let received = make.received(&rig, before).into_iter().map(|(_, text)| text).collect();
    let events = rig.events();
    let Snapshot { intent, link, lock_out, breach: inside, preview, state, .. } = &*rig.shown();
    let written = state.groups.iter().filter(|(_, group)| group.written.is_some());
    Trace {
        received,
        events,
        intent: *intent,
        is_off: *link == LinkState::Off,
        is_locked_out: lock_out.is_some(),
        may_leave: inside.as_ref().map(|inside| inside.may_leave),
        is_previewed: preview.is_some(),
        written: written.map(|(group, _)| *group).collect(),
    }
}

/// Returns the commands that leave no trace even after STOP.
async fn without_a_trace<U: Unit>(make: Make<U>) -> BTreeSet<String> {
    let mut without = BTreeSet::new();
    let plain = trace(&make, &Command::Standby, Given::Never).await;
    for command in &make.commands {
        let prepared = if is_prepared_for(command) {
            Some(trace(&make, command, Given::Never).await)
        } else {
            None
        };
        let never = prepared.as_ref().unwrap_or(&plain);
        let before = trace(&make, command, Given::Before).await;
        let after = trace(&make, command, Given::After).await;
        let expected = if command.row().void_after_stop { never } else { &after };
        assert_eq!(before, *expected, "{command:?}");
        if after == *never {
            without.insert(name(command));
        }
    }
    without
}

#[tokio::test(start_paused = true)]
async fn voids_what_waits_as_the_table_says() {
    let [satrak, genius, rc2000c] = [
        without_a_trace(makes::satrak()).await,
        without_a_trace(makes::genius()).await,
        without_a_trace(makes::rc2000c()).await,
    ];
    let nowhere = satrak.iter().filter(|name| genius.contains(*name) && rc2000c.contains(*name));
    // STOP has already ended the motions that these commands concern, and a link in memory needs no
    // dead-man.
    let expected = [
        "AllowUnguarded",
        "AutoTrack(false)",
        "EndAtTarget",
        "EndJog",
        "FirstOffsets",
        "ForgetDrives",
        "Jog",
        "Resume",
        "Standby",
    ];
    assert_eq!(nowhere.collect::<Vec<_>>(), expected);
}
