//! Every command to a station: at rest, while it closes, with automatic operation, and before STOP.

use std::time::Duration;

use azel::{
    astro::Angle,
    contract::{
        Command,
        alarms::AlarmKind,
        automatic::{Interruption, Operation},
        closing::CloseHow,
        driver::{self, Effect, Event, Intent, Refusal, StopState, TakesControl},
        passes::PassListKey,
        transfer::{FileName, Peer, TleFile},
        uploads::{Ask, Cargo, Order, Stage as UploadStage},
    },
    controller::SPECS,
    device::Pointing,
    engine::Client,
    orbit::bundled,
    station::{AntennaId, Station},
};
use tokio::time::sleep;

use super::{
    makes::{Sent, genius_sent, satrak_sent, values_of_genius, values_of_satrak},
    samples,
};
use crate::{
    common::units::{self, antenna, measured, start, until},
    rehearsed::scene::{Scene, operation, set_automatic},
};

/// A station with one antenna, and a pass that it could track.
struct Stage {
    scene: Scene,
    client: Client,
    id: AntennaId,
    name: &'static str,
    pass: PassListKey,
}

impl Stage {
    async fn new(name: &'static str) -> Self {
        let mut station = units::station();
        station.antennas.retain(|of| of.name == name);
        let scene = Scene::new(start(), &station);
        let client = scene.client();
        let id = measured(&client, name).await;
        until("the schedule", || client.snapshot().schedule.made_at).await;
        let pass = client.snapshot().pass_lists.favourites.passes.first().unwrap().key();
        Self { scene, client, id, name, pass }
    }

    fn commands(&self) -> Vec<Command> {
        let values = if self.name == "Dish" { values_of_satrak() } else { values_of_genius() };
        let of_antenna = samples::commands(&values).into_iter();
        let of_antenna = of_antenna.map(|command| Command::Antenna(self.id, command));
        let station = Station::clone(&self.client.snapshot().station);
        of_antenna.chain(samples::commands_of_stations(self.id, self.pass, station)).collect()
    }

    fn send(&self, command: Command) {
        self.client.send(command).unwrap();
    }

    fn order(&self, command: driver::Command) {
        self.send(Command::Antenna(self.id, command));
    }

    /// Returns the number of motions that the units received.
    fn motions(&self) -> usize {
        let (dish, mast) = (self.scene.units.dish.received(), self.scene.units.mast.received());
        let dish = dish.iter().map(|(_, payload)| satrak_sent(payload));
        let mast = mast.iter().map(|(_, command)| genius_sent(command));
        dish.chain(mast).filter(|sent| *sent == Sent::Motion).count()
    }

    fn shown(&self) -> driver::Snapshot {
        let snapshot = self.client.snapshot();
        let antenna = snapshot.antennas.iter().find(|of| of.id() == self.id).unwrap();
        driver::Snapshot::clone(&antenna.snapshot)
    }

    fn is_closing(&self) -> bool {
        self.client.snapshot().closing.is_some()
    }

    /// Sends the antenna to a far direction and waits until it moves. `before` is the next command.
    async fn moves(&self, before: &Command) {
        until("the checks of the unit", || {
            self.shown().state.motion_lock.filter(|is_locked| !is_locked)
        })
        .await;
        let here = self.shown().state.measured.unwrap().pointing;
        let far = [100.0, 260.0].map(|azimuth_deg| Pointing {
            azimuth: Some(Angle::from_degrees(azimuth_deg)),
            elevation: Some(Angle::from_degrees(30.0)),
        });
        let off_deg = |to: &Pointing| here.separation(*to).unwrap().degrees();
        let far = far.into_iter().max_by(|a, b| off_deg(a).total_cmp(&off_deg(b)));
        let Pointing { azimuth, elevation } = far.unwrap();
        self.order(driver::Command::Hold);
        self.order(driver::Command::Position { azimuth, elevation });
        until(&format!("motion before {before:?}"), || {
            (!self.scene.units.all_stand()).then_some(())
        })
        .await;
        sleep(Duration::from_secs(2)).await;
    }

    /// Closes the station and waits until the antenna goes to park. `before` is the next command.
    async fn closes(&self, before: &Command) {
        self.moves(before).await;
        let before = self.motions();
        self.send(Command::CloseAfter(CloseHow::Park));
        until("the way to park", || {
            let parks = self.shown().intent == Intent::Park && self.motions() > before;
            (parks && self.is_closing()).then_some(())
        })
        .await;
        sleep(Duration::from_millis(300)).await;
    }

    /// Unlocks, connects and stops the antenna, and waits until it stands.
    async fn rests(&self) {
        self.order(driver::Command::Unlock);
        self.order(driver::Command::Connect);
        // A STOP would void the two commands, so wait for their effect.
        until("a link and no lock-out", || {
            let shown = self.shown();
            (shown.link.is_open() && shown.lock_out.is_none()).then_some(())
        })
        .await;
        self.client.stop(self.id);
        let pressed = self.client.now().steady;
        until("rest", || match self.shown().stop {
            StopState::Stopped { time: at } => (at >= pressed).then_some(()),
            _ => None,
        })
        .await;
        self.send(Command::StayOpen);
        until("no closing", || (!self.is_closing()).then_some(())).await;
    }

    /// Returns `true` if the last refusal of the antenna since `from` was for closing.
    fn is_refused_by_closing(&self, from: jiff::Timestamp) -> bool {
        let snapshot = self.client.snapshot();
        let antenna = snapshot.antennas.iter().find(|of| of.id() == self.id).unwrap();
        let refused = Event::NotSent(Refusal::Closing);
        antenna.news.as_ref().is_some_and(|(event, at)| *event == refused && *at >= from)
    }
}

const MAKES: [&str; 2] = ["Dish", "Mast"];

#[tokio::test(start_paused = true)]
async fn a_station_that_closes_takes_only_what_the_table_says() {
    let mut faults = Vec::new();
    for make in MAKES {
        let stage = Stage::new(make).await;
        for command in stage.commands() {
            let row = command.row();
            // The refusal of a program's command goes to the program.
            let is_of_program = matches!(command, Command::Client(..));
            if is_of_program || command.antenna().is_none() && row.effect != Effect::Moves {
                continue;
            }
            stage.closes(&command).await;
            let (before, from) = (stage.motions(), stage.client.now().utc);
            stage.send(command.clone());
            sleep(Duration::from_secs(1)).await;
            let is_refused = stage.is_refused_by_closing(from);
            let has_antenna = command.antenna().is_some();
            let may_move = row.while_closing && row.effect == Effect::Moves;
            let is_moved = stage.motions() != before;
            let goes_on = stage.is_closing() && stage.shown().intent == Intent::Park;
            let is_as_said = is_refused == (has_antenna && !row.while_closing)
                && (may_move || !is_moved)
                && (row.while_closing || goes_on);
            if !is_as_said {
                faults.push(format!("{make}, {command:?}: {is_refused} {is_moved} {goes_on}"));
            }
            stage.rests().await;
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// If a station takes a motion up more than two seconds late, the operator no longer expects it.
#[tokio::test(start_paused = true)]
async fn a_motion_that_the_station_takes_up_late_is_not_carried_out() {
    for (late_ms, is_moved) in [(1900, true), (2100, false)] {
        let stage = Stage::new("Dish").await;
        until("the checks of the unit", || {
            stage.shown().state.motion_lock.filter(|is_locked| !is_locked)
        })
        .await;
        let before = stage.motions();
        let Pointing { azimuth, elevation } = samples::elsewhere();
        stage.order(driver::Command::Position { azimuth, elevation });
        tokio::time::advance(Duration::from_millis(late_ms)).await;
        sleep(Duration::from_secs(3)).await;
        assert_eq!(stage.motions() > before, is_moved, "{late_ms} ms");
        let snapshot = stage.client.snapshot();
        let mut alarms = snapshot.alarms.list().iter();
        assert_ne!(alarms.any(|alarm| alarm.kind == AlarmKind::NotTaken), is_moved, "{late_ms} ms");
    }
}

#[tokio::test(start_paused = true)]
async fn automatic_operation_is_suspended_by_what_the_table_says() {
    let mut faults = Vec::new();
    for make in MAKES {
        let stage = Stage::new(make).await;
        for command in stage.commands() {
            if command.antenna().is_none() {
                continue;
            }
            set_automatic(&stage.client, stage.id, true).await;
            stage.send(command.clone());
            sleep(Duration::from_secs(1)).await;
            let by_hand = matches!(
                operation(&stage.client, stage.id),
                Operation::Suspended { interruption: Interruption::ByHand, .. }
            );
            let takes_control = command.row().takes_control == TakesControl::FromAll;
            if by_hand != takes_control {
                faults.push(format!("{make}, {command:?}: {by_hand}"));
            }
            stage.rests().await;
            set_automatic(&stage.client, stage.id, false).await;
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[tokio::test(start_paused = true)]
async fn only_what_the_table_says_moves_an_antenna() {
    let stage = Stage::new("Dish").await;
    for command in stage.commands() {
        if command.antenna().is_some() || command.row().effect == Effect::Moves {
            continue;
        }
        let before = stage.motions();
        stage.send(command.clone());
        sleep(Duration::from_secs(3)).await;
        assert_eq!(stage.motions(), before, "{command:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn stop_voids_what_waits_for_the_station() {
    let mut faults = Vec::new();
    let stage = Stage::new("Dish").await;
    let is_void = |command: &Command| command.row().void_after_stop;
    for command in stage.commands().iter().filter(|command| is_void(command)) {
        stage.moves(command).await;
        let before = stage.motions();
        stage.send(command.clone());
        stage.client.stop(stage.id);
        let mut closes = false;
        for _ in 0..20 {
            sleep(Duration::from_millis(200)).await;
            closes |= stage.is_closing();
        }
        let is_moved = stage.motions() != before || !stage.scene.units.all_stand();
        let is_automatic = operation(&stage.client, stage.id).is_on();
        if closes || is_moved || is_automatic {
            faults.push(format!("{command:?}: {closes} {is_moved} {is_automatic}"));
        }
        stage.rests().await;
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Returns an upload order that a computer without a server refuses.
fn order() -> Order {
    let takes = SPECS.iter().find_map(|make| make.element_files).unwrap();
    let catalog = bundled().unwrap();
    Order {
        antenna: "Dish".to_owned(),
        takes,
        unit: Peer { host: "127.0.0.1".to_owned(), port: 1 },
        folder: takes.folder.to_owned(),
        file: FileName::new("weather.txt", takes).unwrap(),
        user: takes.factory_user.to_owned(),
        key_file: None,
        cargo: Cargo::New(TleFile::new([catalog.get(25_544).unwrap()], takes).unwrap()),
        satellite: Some(25_544),
        is_unattended: false,
    }
}

#[tokio::test(start_paused = true)]
async fn stop_voids_an_agreement_that_waits_for_the_station() {
    let stage = Stage::new("Dish").await;
    stage.send(Command::Track { antenna: stage.id, pass: stage.pass, is_agreed: true });
    until("the track", || antenna(&stage.client, stage.name)?.1.tracks).await;
    let asks =
        || matches!(stage.client.snapshot().uploads.stage, UploadStage::AsksAboutTracking(_));
    stage.send(Command::Upload(Ask::Begin(Box::new(order()))));
    until("the question", || asks().then_some(())).await;
    stage.send(Command::Upload(Ask::AgreeToTracking));
    stage.client.stop(stage.id);
    sleep(Duration::from_secs(2)).await;
    assert!(asks(), "{:?}", stage.client.snapshot().uploads.stage);
}
