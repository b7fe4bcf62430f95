//! Programs that point antennas through their ports: control, motions and their ends.

use std::{net::SocketAddr, time::Duration};

use azel::{
    astro::Angle,
    contract::{
        Command,
        antenna::AntennaModel,
        control::Party,
        driver::{self, Intent, StopState},
    },
    engine::Client,
    station::AntennaId,
};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream},
    time::{sleep, timeout},
};

use crate::{
    common::{
        dice::Dice,
        units::{self, measured, start, until},
    },
    rehearsed::scene::{Scene, set_automatic},
    safety_properties::cases::for_each_case,
};

/// A station, and one of its antennas.
struct Stage {
    scene: Scene,
    client: Client,
    id: AntennaId,
}

impl Stage {
    async fn new(name: &str) -> Self {
        let mut station = units::station();
        station.antennas.retain(|antenna| antenna.name == name);
        let scene = Scene::new(start(), &station);
        let client = scene.client();
        let id = measured(&client, name).await;
        let stage = Self { scene, client, id };
        until("the checks of the unit", || {
            let state = stage.antenna().snapshot.state.clone();
            state.measured.and_then(|measured| measured.pointing.azimuth)?;
            state.motion_lock.filter(|is_locked| !is_locked)
        })
        .await;
        stage
    }

    fn antenna(&self) -> AntennaModel {
        let snapshot = self.client.snapshot();
        snapshot.antennas.iter().find(|antenna| antenna.id() == self.id).unwrap().clone()
    }

    fn order(&self, command: driver::Command) {
        self.client.send(Command::Antenna(self.id, command)).unwrap();
    }

    fn party(&self) -> Option<Party> {
        self.antenna().control.party
    }

    fn stands(&self) -> bool {
        self.scene.units.all_stand()
    }

    fn direction_deg(&self) -> (f64, f64) {
        let pointing = self.antenna().snapshot.state.measured.unwrap().pointing;
        (pointing.azimuth.unwrap().degrees(), pointing.elevation.unwrap_or_default().degrees())
    }

    async fn hand_over(&self, program: &Program) {
        let hand_over =
            Command::HandOver { antenna: self.id, client: program.address, always: false };
        self.client.send(hand_over).unwrap();
        until("control", || (self.party() == Some(program.party())).then_some(())).await;
    }

    async fn moves(&self) {
        until("motion", || (!self.stands()).then_some(())).await;
    }

    async fn arrives(&self, azimuth_deg: f64, elevation_deg: f64) {
        let is_near = || {
            let (az, el) = self.direction_deg();
            let has_elevation = self.antenna().variant().capabilities.has_elevation();
            let is_there = !has_elevation || (el - elevation_deg).abs() < 1.5;
            (az - azimuth_deg).abs() < 1.5 && is_there && self.stands()
        };
        let limit = Duration::from_mins(5);
        let arrived = timeout(limit, until("the target", || is_near().then_some(()))).await;
        assert!(arrived.is_ok(), "stands at {:?}", self.direction_deg());
    }
}

/// A program that is connected to the port of the antenna.
struct Program {
    stream: DuplexStream,
    address: SocketAddr,
}

impl Program {
    async fn connect(stage: &Stage, port: u16) -> Self {
        let address = SocketAddr::from(([127, 0, 0, 1], port));
        let (stream, far) = tokio::io::duplex(4096);
        let (client, id) = (stage.client.clone(), stage.id);
        tokio::spawn(async move { client.serve(id, address, far).await });
        until("the connection", || stage.antenna().control.client(address).map(drop)).await;
        Self { stream, address }
    }

    fn party(&self) -> Party {
        Party::Program(self.address)
    }

    async fn tell(&mut self, line: &str) {
        self.stream.write_all(format!("{line}\n").as_bytes()).await.unwrap();
    }

    /// Sends a line and returns the answer, which arrives in one piece.
    async fn ask(&mut self, line: &str) -> String {
        self.tell(line).await;
        let mut buffer = [0; 1024];
        let read = timeout(Duration::from_secs(3), self.stream.read(&mut buffer)).await;
        let count = read.unwrap_or_else(|_| panic!("no answer to {line}")).unwrap();
        String::from_utf8(buffer[..count].to_vec()).unwrap()
    }
}

#[tokio::test(start_paused = true)]
async fn a_program_points_the_antenna_once_the_operator_has_handed_it_over() {
    for name in ["Dish", "Mast"] {
        let stage = Stage::new(name).await;
        let mut program = Program::connect(&stage, 5001).await;
        let before = stage.direction_deg();
        assert_eq!(program.ask("P 100.00 40.00").await, "RPRT -9\n");
        until("the request", || stage.antenna().control.clients.first()?.asks_since).await;
        sleep(Duration::from_secs(3)).await;
        assert_eq!(stage.direction_deg(), before, "{name}");
        stage.hand_over(&program).await;
        assert_eq!(program.ask("P 100.00 40.00").await, "RPRT 0\n", "{name}");
        stage.moves().await;
        let keeps_control = async {
            loop {
                program.ask("p").await;
                sleep(Duration::from_secs(1)).await;
            }
        };
        tokio::select! {
            () = stage.arrives(100.0, 40.0) => {}
            () = keeps_control => {}
        }
        let answer = program.ask("p").await;
        let angles: Vec<f64> = answer.lines().map(|line| line.parse().unwrap()).collect();
        let (az, el) = stage.direction_deg();
        assert!((angles[0] - az).abs() < 0.01 && (angles[1] - el).abs() < 0.01, "{answer}");
        assert_eq!(stage.antenna().snapshot.intent, Intent::Track);
    }
}

#[tokio::test(start_paused = true)]
async fn silence_ends_control_and_the_antenna_goes_on_to_its_target() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    stage.hand_over(&program).await;
    assert_eq!(program.ask("P 250 40").await, "RPRT 0\n");
    sleep(Duration::from_secs(9)).await;
    assert_eq!(stage.party(), Some(program.party()));
    sleep(Duration::from_millis(2500)).await;
    assert_eq!(stage.party(), None);
    stage.arrives(250.0, 40.0).await;
    until("the end of the track", || {
        (stage.antenna().snapshot.intent == Intent::Position).then_some(())
    })
    .await;
}

#[tokio::test(start_paused = true)]
async fn a_script_points_once_and_hangs_up() {
    for name in ["Dish", "Mast"] {
        let stage = Stage::new(name).await;
        let first = Program::connect(&stage, 5001).await;
        stage.hand_over(&first).await;
        drop(first);
        let mut script = Program::connect(&stage, 5002).await;
        assert_eq!(script.ask("\\set_pos 120 35").await, "RPRT 0\n");
        drop(script);
        until("nobody in control", || stage.party().is_none().then_some(())).await;
        stage.arrives(120.0, 35.0).await;
        assert_eq!(stage.antenna().snapshot.intent, Intent::Position, "{name}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_turn_ends_with_its_connection() {
    let stage = Stage::new("Mast").await;
    let mut program = Program::connect(&stage, 5001).await;
    stage.hand_over(&program).await;
    assert_eq!(program.ask("M 16 100").await, "RPRT 0\n");
    stage.moves().await;
    sleep(Duration::from_secs(3)).await;
    assert!(!stage.stands(), "the turn is repeated");
    drop(program);
    sleep(Duration::from_secs(3)).await;
    assert!(stage.stands());
}

#[tokio::test(start_paused = true)]
async fn a_turn_ends_when_its_program_is_silent() {
    let stage = Stage::new("Mast").await;
    let mut program = Program::connect(&stage, 5001).await;
    stage.hand_over(&program).await;
    assert_eq!(program.ask("M LEFT 10").await, "RPRT 0\n");
    stage.moves().await;
    sleep(Duration::from_secs(14)).await;
    assert!(stage.stands());
    assert_eq!(stage.party(), None);
}

#[tokio::test(start_paused = true)]
async fn the_stop_of_a_program_ends_its_own_motion_only() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    // The operator moves the antenna. A program that only watches hangs up, as Gpredict does.
    let to = |deg| Some(Angle::from_degrees(deg));
    stage.order(driver::Command::Position { azimuth: to(250.0), elevation: to(40.0) });
    stage.moves().await;
    assert_eq!(program.ask("S").await, "RPRT 0\n");
    sleep(Duration::from_secs(2)).await;
    assert!(!stage.stands());
    assert_eq!(stage.antenna().control.clients.first().unwrap().ignored_stops, 1);
    stage.arrives(250.0, 40.0).await;
    // Now the program itself moves the antenna.
    stage.hand_over(&program).await;
    assert_eq!(program.ask("P 100 40").await, "RPRT 0\n");
    stage.moves().await;
    assert_eq!(program.ask("S").await, "RPRT 0\n");
    sleep(Duration::from_secs(3)).await;
    assert!(stage.stands());
    assert_eq!(stage.antenna().snapshot.stop, StopState::Ready, "it was no STOP");
}

#[tokio::test(start_paused = true)]
async fn an_operator_who_stops_or_moves_the_antenna_has_it() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    for takes_over in [None, Some(driver::Command::Park), Some(driver::Command::Standby)] {
        stage.client.send(Command::ReleaseControl(stage.id)).unwrap();
        stage.hand_over(&program).await;
        assert_eq!(program.ask("P 250 40").await, "RPRT 0\n");
        match takes_over.clone() {
            Some(command) => stage.order(command),
            None => drop(stage.client.stop(stage.id)),
        }
        until("the window in control", || (stage.party() == Some(Party::Window)).then_some(()))
            .await;
        for _ in 0..5 {
            assert_eq!(program.ask("P 250 41").await, "RPRT -9\n", "{takes_over:?}");
            sleep(Duration::from_secs(1)).await;
        }
        if takes_over.is_none() {
            assert!(stage.stands());
        }
    }
}

#[tokio::test(start_paused = true)]
async fn automatic_operation_leaves_the_antenna_to_no_program() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    stage.hand_over(&program).await;
    set_automatic(&stage.client, stage.id, true).await;
    until("automatic operation", || (stage.party() == Some(Party::Automatic)).then_some(())).await;
    assert_eq!(program.ask("P 250 40").await, "RPRT -9\n");
    assert_eq!(program.ask("S").await, "RPRT 0\n");
    assert_eq!(stage.party(), Some(Party::Automatic));
    assert!(stage.antenna().operation.is_on());
    // Handing the antenna over suspends automatic operation.
    stage.hand_over(&program).await;
    assert!(!stage.antenna().operation.is_on());
    assert_eq!(program.ask("P 250 40").await, "RPRT 0\n");
}

#[tokio::test(start_paused = true)]
async fn one_program_at_a_time_has_the_antenna() {
    let stage = Stage::new("Dish").await;
    let mut first = Program::connect(&stage, 5001).await;
    let mut second = Program::connect(&stage, 5002).await;
    stage.hand_over(&first).await;
    assert_eq!(first.ask("P 100 40").await, "RPRT 0\n");
    assert_eq!(second.ask("P 200 40").await, "RPRT -9\n");
    stage.hand_over(&second).await;
    assert_eq!(second.ask("P 200 40").await, "RPRT 0\n");
    assert_eq!(first.ask("P 100 40").await, "RPRT -9\n");
    assert_eq!(second.ask("+P 200 40").await, "set_pos: 200 40\nRPRT 0\n");
}

#[tokio::test(start_paused = true)]
async fn a_stream_of_positions_moves_without_a_stop_in_between() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    stage.hand_over(&program).await;
    assert_eq!(program.ask("P 100 40").await, "RPRT 0\n");
    stage.moves().await;
    let stops = |stage: &Stage| {
        let received = stage.scene.units.dish.received();
        received.iter().filter(|(_, payload)| payload.starts_with("STOP")).count()
    };
    let before = stops(&stage);
    for azimuth_deg in 101..130 {
        assert_eq!(program.ask(&format!("P {azimuth_deg} 40")).await, "RPRT 0\n");
        sleep(Duration::from_secs(1)).await;
    }
    assert_eq!(stops(&stage), before);
    assert!((stage.direction_deg().0 - 129.0).abs() < 20.0, "{:?}", stage.direction_deg());
}

#[tokio::test(start_paused = true)]
async fn questions_are_answered_for_everybody() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    let (az, el) = stage.direction_deg();
    assert_eq!(program.ask("p").await, format!("{az:.2}\n{el:.2}\n"));
    assert_eq!(program.ask("_").await, "Dish\n");
    assert_eq!(program.ask("s").await, "\n");
    let state = program.ask("\\dump_state").await;
    assert!(state.starts_with("1\n1\nmin_az=0.000000\nmax_az=360.000000\n"), "{state}");
    assert!(state.ends_with("rot_type=AzEl\ndone\n"), "{state}");
    for line in ["R 1", "C min_az 10", "w hello", "V SPEED 1", "nonsense"] {
        assert_eq!(program.ask(line).await, "RPRT -4\n", "{line}");
    }
    for line in ["P nan 10", "P 10", "P 10 91", "P 10 -1", "P 600 10"] {
        assert_eq!(program.ask(line).await, "RPRT -1\n", "{line}");
    }
    assert_eq!(program.ask("M 8 50").await, "RPRT -11\n", "an X/Y mount has no azimuth axis");
    // Without a link, the position is unknown.
    stage.order(driver::Command::Disconnect);
    until("no link", || (!stage.antenna().snapshot.link.is_open()).then_some(())).await;
    assert_eq!(program.ask("p").await, "RPRT -5\n");
}

#[tokio::test(start_paused = true)]
async fn a_program_that_hangs_up_leaves_the_list() {
    let stage = Stage::new("Dish").await;
    let mut program = Program::connect(&stage, 5001).await;
    program.tell("q").await;
    let mut rest = Vec::new();
    program.stream.read_to_end(&mut rest).await.unwrap();
    assert_eq!(rest, b"");
    until("an empty list", || stage.antenna().control.clients.is_empty().then_some(())).await;
}

/// Random step of a contention for the antenna.
#[derive(Debug, Clone, Copy)]
enum Happening {
    Connects(usize),
    HangsUp(usize),
    Points(usize),
    Turns(usize),
    Asks(usize),
    Stops(usize),
    IsHandedControl(usize),
    OperatorTakesControl,
    OperatorReleasesControl,
    OperatorStops,
    OperatorMoves,
    AutomaticOperation(bool),
    Silence,
}

const PROGRAMS: usize = 3;

fn happening(dice: &mut Dice) -> Happening {
    let program = dice.below(PROGRAMS);
    match dice.below(16) {
        0 => Happening::Connects(program),
        1 => Happening::HangsUp(program),
        2..=4 => Happening::Points(program),
        5..=6 => Happening::Turns(program),
        7 => Happening::Asks(program),
        8 => Happening::Stops(program),
        9..=10 => Happening::IsHandedControl(program),
        11 => Happening::OperatorTakesControl,
        12 => Happening::OperatorReleasesControl,
        13 => Happening::OperatorStops,
        14 => Happening::OperatorMoves,
        _ if dice.chance(0.5) => Happening::AutomaticOperation(dice.chance(0.5)),
        _ => Happening::Silence,
    }
}

/// Lets parties take the antenna from each other at random. Checks that only the party in control
/// moves it, that STOP wins, and that no turn outlives the control of its program.
async fn is_contended(mut dice: Dice) {
    let stage = Stage::new("Mast").await;
    let mut programs: [Option<Program>; PROGRAMS] = [None, None, None];
    let mut turning = None;
    let mut port = 5000;
    for _ in 0..60 {
        let next = happening(&mut dice);
        let before = stage.party();
        match next {
            Happening::Connects(index) if programs[index].is_none() => {
                port += 1;
                programs[index] = Some(Program::connect(&stage, port).await);
            }
            Happening::HangsUp(index) => programs[index] = None,
            Happening::Points(index) | Happening::Turns(index) => {
                let Some(program) = &mut programs[index] else { continue };
                let is_turn = matches!(next, Happening::Turns(_));
                let line = if is_turn {
                    format!("M {} 50", [8, 16][dice.below(2)])
                } else {
                    format!("P {:.2} 20", dice.between(0.0, 360.0))
                };
                if program.ask(&line).await == "RPRT 0\n" {
                    let is_own = before.is_none() || before == Some(program.party());
                    assert!(is_own, "{next:?} after {before:?}");
                    assert_eq!(stage.party(), Some(program.party()), "{next:?}");
                    turning = is_turn.then(|| program.party());
                }
            }
            Happening::Asks(index) => {
                if let Some(program) = &mut programs[index] {
                    program.ask("p").await;
                }
            }
            Happening::Stops(index) => {
                let Some(program) = &mut programs[index] else { continue };
                assert_eq!(program.ask("S").await, "RPRT 0\n");
                if before.is_none() || before == Some(program.party()) {
                    turning = None;
                }
            }
            Happening::IsHandedControl(index) => {
                if let Some(program) = &programs[index] {
                    stage.hand_over(program).await;
                }
            }
            Happening::OperatorTakesControl => {
                stage.client.send(Command::TakeControl(stage.id)).unwrap();
                until("the window", || (stage.party() == Some(Party::Window)).then_some(())).await;
            }
            Happening::OperatorReleasesControl => {
                stage.client.send(Command::ReleaseControl(stage.id)).unwrap();
            }
            Happening::OperatorStops => {
                stage.client.stop(stage.id);
                sleep(Duration::from_secs(4)).await;
                assert_eq!(stage.party(), Some(Party::Window));
                assert!(stage.stands(), "a STOP was lost");
                turning = None;
            }
            Happening::OperatorMoves => {
                let azimuth = Some(Angle::from_degrees(dice.between(0.0, 360.0)));
                stage.order(driver::Command::Position { azimuth, elevation: None });
                turning = None;
            }
            Happening::AutomaticOperation(is_on) => {
                set_automatic(&stage.client, stage.id, is_on).await;
            }
            Happening::Silence => {
                sleep(Duration::from_millis(100 + dice.below(13_000) as u64)).await;
            }
            Happening::Connects(_) => {}
        }
        sleep(Duration::from_millis(300)).await;
        if turning.is_some() && stage.party() != turning {
            sleep(Duration::from_secs(3)).await;
            assert!(stage.stands(), "a turn outlives its program: {next:?}");
            turning = None;
        }
        let party = stage.party();
        let is_on = stage.antenna().operation.is_on();
        assert_eq!(party == Some(Party::Automatic), is_on, "{next:?}");
    }
}

/// Draw more cases with `AZEL_SEED=1 AZEL_CASES=1000 cargo test --test azel
/// network_ports::parties`.
#[test]
fn parties_that_contend_for_an_antenna_never_have_it_at_once() {
    for_each_case("parties contend", 6, is_contended);
}
