//! Replays whose thread does not start or breaks off, and commands during a replay.

use super::*;
use crate::{
    contract::{
        antenna::AntennaModel,
        closing::CloseHow,
        driver::{self, LinkState},
    },
    job::InPlace,
    model::replay::StretchPass,
    station::Antenna,
};

fn replay() -> Replay {
    let time: Timestamp = "2026-11-14T19:00:00Z".parse().unwrap();
    let live = Model::before_anything(Moment { utc: time, steady: Instant::now() });
    let (start, end) = (add_seconds(time, -60.0), add_seconds(time, 60.0));
    let stretch = Stretch { name: "the record".to_owned(), pass: None, start, end };
    let path = PathBuf::from("no record");
    Replay::begin(path, stretch, time, &live, ui::Views::default(), Arc::new(|| {}))
}

/// Checks that the replay ended for `reason`, and that no key makes it appear to go on.
fn is_not_read(mut replay: Replay, reason: &str) {
    let problem = Some(ReplayProblem::NotRead(reason.to_owned()));
    let shown = |replay: &Replay| replay.model.replay.clone().unwrap();
    assert_eq!((shown(&replay).problem, shown(&replay).plays), (problem.clone(), false));
    replay.change(ReplayCommand::PlayOrPause);
    replay.think(Instant::now());
    assert_eq!((shown(&replay).problem, shown(&replay).plays), (problem, false));
}

#[test]
fn a_replay_whose_thread_broke_off_says_so_and_stands() {
    let mut replay = replay();
    let _in_place = InPlace::begin();
    replay.room = None;
    let job = Job::start("azel-replay", Arc::new(|| {}), |_| panic!("on purpose"));
    replay.job = Some(job);
    replay.take_answer();
    is_not_read(replay, "the work failed inside Azel");
}

#[test]
fn a_command_given_in_a_replay_ends_there() {
    use crate::contract::driver::Command as C;
    let mut replay = replay();
    let antenna = AntennaId(1);
    let moving = [C::Manual, C::Park, C::MoveAway, C::TakeOver, C::Resume, C::AutoTrack(true)];
    let other = [C::Standby, C::Unlock, C::SeenStanding, C::AllowWayOut, C::Ask("STATUS?".into())];
    let of_antenna =
        moving.into_iter().chain(other).map(|command| Command::Antenna(antenna, command));
    let pass = (25_544, replay.begun_at);
    let of_station = [
        Command::Track { antenna, pass, is_agreed: true },
        Command::ProgramTrackPass { antenna, pass },
        Command::SetAutomatic { antenna, is_on: true },
        Command::GoOn(antenna),
        Command::CloseAfter(CloseHow::Park),
        Command::SaveStation(Box::default()),
    ];
    for command in of_antenna.chain(of_station) {
        assert!(!command.row().in_replay, "{command:?}");
        assert!(replay.carry_out(UiCommand::Station(command.clone())).is_none(), "{command:?}");
    }
}

/// Returns the station of a film, with two antennas.
fn scene(time: Timestamp) -> Scene {
    let mut shown = Snapshot::before_anything(Moment { utc: time, steady: Instant::now() });
    shown.antennas = ["North", "South"]
        .into_iter()
        .enumerate()
        .map(|(index, name)| {
            let id = AntennaId(10 + index as u32);
            let config = Antenna { id, ..Antenna::satrak(name, "192.0.2.1:4001") };
            let session = driver::Snapshot::before_anything(LinkState::Off);
            AntennaModel::new(config, Arc::new(session))
        })
        .collect();
    Scene { shown, wires: Vec::new() }
}

#[test]
fn the_replay_of_another_report_selects_its_antenna() {
    let mut replay = replay();
    let time = replay.begun_at;
    let mut turn_to = |antenna: Option<u32>| {
        let stretch = antenna.map(|number| {
            let antenna = AntennaId(number);
            let pass = Some(StretchPass { id: 1, satellite: 25_544, antenna });
            let (start, end) = (add_seconds(time, -60.0), add_seconds(time, 60.0));
            Stretch { name: "ISS".to_owned(), pass, start, end }
        });
        let scene = Ok(Some(scene(time)));
        replay.take_moment(Found { time, stretch, hole: None, skipped: None, scene });
        replay.model.antenna().map(|antenna| antenna.config.name.clone())
    };
    let [north, south] = ["North", "South"].map(|name| Some(name.to_owned()));
    assert_eq!(turn_to(Some(11)), south);
    assert_eq!(turn_to(None), south, "another moment of the same report");
    assert_eq!(turn_to(Some(10)), north);
    assert_eq!(turn_to(Some(12)), north, "its antenna is no longer there");
    assert!(replay.carry_out(UiCommand::SelectAntenna(1)).is_none());
    let again =
        Found { time, stretch: None, hole: None, skipped: None, scene: Ok(Some(scene(time))) };
    replay.take_moment(again);
    assert_eq!(replay.model.selected_antenna, 1, "the operator chose it");
}

#[test]
fn the_replay_of_a_report_begins_with_its_antenna() {
    let time: Timestamp = "2026-11-14T19:00:00Z".parse().unwrap();
    let live = Model::before_anything(Moment { utc: time, steady: Instant::now() });
    let pass = Some(StretchPass { id: 1, satellite: 25_544, antenna: AntennaId(11) });
    let stretch =
        Stretch { name: "ISS".to_owned(), pass, start: time, end: add_seconds(time, 60.0) };
    let path = PathBuf::from("no record");
    let mut replay =
        Replay::begin(path, stretch, time, &live, ui::Views::default(), Arc::new(|| {}));
    let found =
        Found { time, stretch: None, hole: None, skipped: None, scene: Ok(Some(scene(time))) };
    replay.take_moment(found);
    assert_eq!(replay.model.selected_antenna, 1);
}
