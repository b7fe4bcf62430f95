//! Every state of an antenna, shown whole on its chip and its card, with the longest names and
//! numbers.
//!
//! Each list goes from one state to the next by a `match` that names all of them, so the compiler
//! rejects a forgotten state.

use std::{iter::successors, sync::Arc, time::Duration};

use azel::{
    contract::{
        automatic::{Doing, Interruption, OffBecause, Operation},
        driver::{Intent, LinkLoss, LinkState, Snapshot, StopState},
    },
    device::{AxisMotion, Phase},
    engine::antenna::{Recent, refresh},
    model::Model,
    station::Antenna,
};

use crate::window_stories::{
    automatic,
    every_view::painted,
    extremes::nothing_is_cut,
    maintenance,
    rig::{self, LARGE, SMALL},
    states,
    wide::three,
};

const SIZES: [[f32; 2]; 3] = [SMALL, LARGE, [1920.0, 1080.0]];
const LONG: &str = "Northern 3.7 m dish of Şile, X/Y";
/// Time without a link; Azel writes no time up to a week with more letters.
const LOST: Duration = Duration::from_secs(24 * 3600 - 1);
/// Age of the last reply of a unit that replies.
const AGE: Duration = Duration::from_millis(9900);

fn losses() -> impl Iterator<Item = LinkLoss> {
    let system = || "Network is unreachable (os error 101)".to_owned();
    successors(Some(LinkLoss::Refused(system())), move |loss| match loss {
        LinkLoss::Refused(_) => Some(LinkLoss::ConnectTimeout),
        LinkLoss::ConnectTimeout => Some(LinkLoss::Closed),
        LinkLoss::Closed => Some(LinkLoss::Broken(system())),
        LinkLoss::Broken(_) => Some(LinkLoss::Silent),
        LinkLoss::Silent => Some(LinkLoss::Slept),
        LinkLoss::Slept => Some(LinkLoss::Unreadable),
        LinkLoss::Unreadable => Some(LinkLoss::OtherDevice),
        LinkLoss::OtherDevice => None,
    })
}

fn links(model: &Model) -> Vec<LinkState> {
    let at = rig::ago(model, LOST.as_secs());
    let usual = successors(Some(LinkState::Off), |link| match link {
        LinkState::Off => Some(LinkState::Connecting { start: at }),
        LinkState::Connecting { .. } => Some(LinkState::Up { start: at }),
        LinkState::Up { .. } => Some(LinkState::Stale { as_of: model.steady - AGE }),
        LinkState::Stale { .. } | LinkState::Lost { .. } => None,
    });
    let retry_at = rig::soon(model);
    let lost = losses().map(|reason| LinkState::Lost { start: at, reason, retry_at });
    usual.chain(lost).collect()
}

fn stops(model: &Model) -> impl Iterator<Item = StopState> {
    let since = rig::ago(model, AGE.as_secs());
    successors(Some(StopState::Ready), move |stop| match stop {
        StopState::Ready => Some(StopState::Stopping { start: since }),
        StopState::Stopping { .. } => Some(StopState::Stopped { time: since }),
        StopState::Stopped { .. } => Some(StopState::NotConfirmed { start: since }),
        StopState::NotConfirmed { .. } => None,
    })
}

fn intents() -> impl Iterator<Item = Intent> {
    successors(Some(Intent::Standby), |intent| match intent {
        Intent::Standby => Some(Intent::Manual),
        Intent::Manual => Some(Intent::Position),
        Intent::Position => Some(Intent::Track),
        Intent::Track => Some(Intent::Park),
        Intent::Park => None,
    })
}

fn phases() -> impl Iterator<Item = Phase> {
    successors(Some(Phase::OutOfWindow), |phase| match phase {
        Phase::OutOfWindow => Some(Phase::Tracking),
        Phase::Tracking => Some(Phase::Completed),
        Phase::Completed => Some(Phase::AtStart),
        Phase::AtStart => Some(Phase::Unknown(i64::MIN)),
        Phase::Unknown(_) => None,
    })
}

fn interruptions() -> impl Iterator<Item = Interruption> {
    successors(Some(Interruption::ByHand), |interruption| match interruption {
        Interruption::ByHand => Some(Interruption::Elsewhere),
        Interruption::Elsewhere => Some(Interruption::EndedByUnit),
        Interruption::EndedByUnit => Some(Interruption::Clock),
        Interruption::Clock => None,
    })
}

fn reasons() -> impl Iterator<Item = OffBecause> {
    successors(Some(OffBecause::NotSwitchedOn), |reason| match reason {
        OffBecause::NotSwitchedOn => Some(OffBecause::Operator),
        OffBecause::Operator => Some(OffBecause::Stop),
        OffBecause::Stop => Some(OffBecause::Safety),
        OffBecause::Safety => Some(OffBecause::LockedOut),
        OffBecause::LockedOut => Some(OffBecause::Changed),
        OffBecause::Changed => Some(OffBecause::NotAsLeft),
        OffBecause::NotAsLeft => Some(OffBecause::Failures),
        OffBecause::Failures => None,
    })
}

fn operations() -> Vec<Operation> {
    let off = reasons().map(Operation::Off);
    let suspended =
        interruptions().map(|by| Operation::Suspended { interruption: by, start: rig::now() });
    off.chain(suspended)
        .chain([automatic::on(&Doing::Rests), automatic::on(&Doing::Parks)])
        .collect()
}

/// Checks the window in which the first of three antennas has this snapshot and operation.
fn check(what: &str, snapshot: &Snapshot, operation: Option<&Operation>) {
    for size in SIZES {
        let mut model = three();
        let shown = Arc::clone(model.shown());
        let steady = model.steady;
        let first = &mut model.shown_mut().antennas[0];
        let mut config = Antenna::clone(&first.config);
        LONG.clone_into(&mut config.name);
        let id = config.id;
        let mut snapshot = snapshot.clone();
        snapshot.state.traffic.last_reply = Some(steady - AGE);
        *first = rig::antenna(config, snapshot);
        Arc::make_mut(&mut first.config).id = id;
        if let Some(operation) = operation {
            first.operation = operation.clone();
        }
        refresh(first, &mut Recent::default(), shown.station.site, |number| {
            shown.pass_lists.satellite(number)
        });
        let window = rig::window(size, model);
        nothing_is_cut(&window, size);
        let cut: Vec<String> =
            painted::cut(&window).into_iter().filter(|words| !may_be_cut(words)).collect();
        assert!(cut.is_empty(), "{what} at {size:?}: {cut:?}");
    }
}

/// Returns `true` if Azel may cut the text: a name without room, or a line of another antenna below
/// the card.
fn may_be_cut(words: &str) -> bool {
    words.starts_with("Northern") || words.starts_with("Holding at ")
}

#[test]
fn every_link_is_told_whole() {
    for link in links(&three()) {
        let what = format!("{link:?}");
        check(&what, &Snapshot { link, ..states::holding() }, None);
    }
}

#[test]
fn every_motion_is_told_whole() {
    let model = three();
    for stop in stops(&model) {
        check(&format!("{stop:?}"), &Snapshot { stop, ..states::moving() }, None);
        check(&format!("{stop:?}, at rest"), &Snapshot { stop, ..states::holding() }, None);
    }
    for intent in intents() {
        check(&format!("{intent:?}"), &Snapshot { intent, ..states::moving() }, None);
    }
    for phase in phases() {
        for motion in [AxisMotion::Still, AxisMotion::Plus] {
            check(&format!("{phase:?}"), &states::program(phase, motion), None);
        }
    }
    check("locked out", &maintenance::locked(states::holding()), None);
}

#[test]
fn every_state_of_automatic_operation_is_told_whole() {
    for operation in operations() {
        check(&format!("{operation:?}"), &states::holding(), Some(&operation));
    }
}
