//! A replay whose thread cannot be started or breaks off, and commands given in one.

use super::*;
use crate::{driver, engine::closing::CloseHow, job::InPlace};

fn replay() -> Replay {
    let at: Timestamp = "2026-11-14T19:00:00Z".parse().unwrap();
    let live = Model::before_anything(Moment { utc: at, steady: Instant::now() });
    let (from, until) = (add_seconds(at, -60.0), add_seconds(at, 60.0));
    let stretch = Stretch { name: "the record".to_owned(), pass: None, from, until };
    let path = PathBuf::from("no record");
    Replay::begin(path, stretch, at, &live, ui::Views::default(), Arc::new(|| {}))
}

/// Reading ended for this reason, and no key makes the replay look as if it went on.
fn is_not_read(mut replay: Replay, why: &str) {
    let problem = Some(ReplayProblem::NotRead(why.to_owned()));
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
    replay.take_job(job);
    replay.take_answer();
    is_not_read(replay, "the work failed inside Azel");
}

#[test]
fn a_replay_whose_thread_cannot_be_started_says_so_and_stands() {
    let mut replay = replay();
    replay.room = None;
    replay.take_job(Err(io::Error::other("no thread is left")));
    is_not_read(replay, "no thread is left");
}

#[test]
fn a_command_given_in_a_replay_ends_there() {
    use driver::Command as C;
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
