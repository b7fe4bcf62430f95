//! Moves to stored satellites and to counts.

use azel::{
    controller::{Motion, panel::CheckState, rc2000c::MAKE, settings::Value},
    driver::{Command, Event, Intent, Refusal},
    protocol::rc2000c::SatelliteName,
    sim::rc2000c::{Options, StoredSatellite},
    station::LockOut,
};

use super::rig::{Rig, antenna, check, reading};

async fn refused(rig: &mut Rig) -> String {
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(Motion::Action(_), reason) = event else { panic!("{event:?}") };
    reason
}

fn to(name: &str, polarity: i64) -> [(&'static str, Value); 2] {
    [("satellite", Value::Text(name.to_owned())), ("polarity", Value::Choice(polarity))]
}

#[tokio::test(start_paused = true)]
async fn a_stored_satellite_is_gone_to_by_its_name_and_polarity() {
    let mut rig = Rig::in_manual().await;
    rig.act("to_satellite", to(" galaxy 5 ", 0));
    rig.seconds(20.0).await;
    assert_eq!(rig.counts(), [1100, 640]);
    assert_eq!(reading(&rig.shown(), "Satellite").as_deref(), Some("GALAXY 5"));
    rig.act("to_satellite", to("SBS 6", 1));
    rig.seconds(0.5).await;
    assert!(rig.shown().state.measured.unwrap().moving());
    rig.seconds(20.0).await;
    rig.act("to_satellite", to("SBS 6", 2));
    rig.seconds(1.0).await;
    let frames = rig.control.received();
    let moves: Vec<_> = frames.iter().filter(|(_, frame)| frame.code() == b'2').collect();
    assert_eq!(moves[1].1.to_bytes(), b"\x02\x32\x32HSBS 6     \x03\x3d");
    assert_eq!(rig.orders(), ["2 GALAXY 5  ", "2HSBS 6     ", "2VSBS 6     "]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_name_that_is_not_in_the_list_is_not_sent() {
    let mut rig = Rig::in_manual().await;
    rig.act("to_satellite", to("GALAXY", 0));
    assert_eq!(refused(&mut rig).await, "no satellite \"GALAXY\" is stored");
    assert!(rig.orders().is_empty());
}

#[tokio::test(start_paused = true)]
async fn names_with_blanks_before_them_and_of_ten_digits_are_handled() {
    let mut options = Options::default();
    let stored = |name: &str| StoredSatellite {
        name: SatelliteName::new(name).unwrap(),
        ..options.satellites[1]
    };
    let odd = [stored("  LEFT"), stored("0123456789")];
    options.satellites.extend(odd);
    let mut rig = Rig::connected(&options, &antenna()).await;
    rig.send(Command::Manual);
    rig.act("to_satellite", to("left", 0));
    rig.seconds(1.0).await;
    assert_eq!(rig.orders(), ["2   LEFT    "]);
    rig.act("to_satellite", to("0123456789", 0));
    assert_eq!(refused(&mut rig).await, "a name of ten digits means a position");
}

#[tokio::test(start_paused = true)]
async fn the_list_is_read_anew_on_request() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Standby);
    rig.act("read_list", []);
    rig.seconds(3.0).await;
    assert_eq!(rig.times("5").len(), 12);
    let mut rig =
        Rig::connected(&Options { satellites: Vec::new(), ..Options::default() }, &antenna()).await;
    assert_eq!(reading(&rig.shown(), "Stored satellites").as_deref(), Some("none"));
    rig.send(Command::Manual);
    rig.act("polarity_h", []);
    assert_eq!(refused(&mut rig).await, "no satellite is stored near this azimuth");
}

#[tokio::test(start_paused = true)]
async fn counts_are_gone_to_within_the_travel_of_the_mount() {
    let mut rig = Rig::in_manual().await;
    let counts = |az, el| [("az_counts", Value::Integer(az)), ("el_counts", Value::Integer(el))];
    rig.act("to_counts", counts(1600, 700));
    rig.seconds(10.0).await;
    assert_eq!(rig.counts(), [1600, 700]);
    assert_eq!(rig.orders(), ["2 0160000700"]);
    rig.act("to_counts", counts(4000, 700));
    let reason = refused(&mut rig).await;
    assert!(reason.contains("azimuth") && reason.contains("270"), "{reason}");
    rig.act("to_counts", [("az_counts", Value::Integer(1600))]);
    assert_eq!(refused(&mut rig).await, "el_counts is missing");
    assert_eq!(rig.times("2").len(), 1);
    assert_eq!(check(&rig.shown(), "Remote mode"), Some(CheckState::Good));
}

#[tokio::test(start_paused = true)]
async fn in_standby_no_action_moves_anything_and_an_unknown_one_is_none() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Standby);
    for action in MAKE.actions.iter().filter(|action| action.moves) {
        rig.act(action.key, []);
        rig.seconds(0.1).await;
        let wanted = Event::NotSent(Refusal::Intent(Intent::Standby));
        assert_eq!(rig.events(), [wanted], "{}", action.key);
    }
    rig.act("self_destruct", []);
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::NotOffered)]);
    assert!(rig.orders().is_empty());
}

#[test]
fn every_action_is_described_and_what_cannot_be_undone_is_asked() {
    let mut keys: Vec<&str> = MAKE.actions.iter().map(|action| action.key).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), MAKE.actions.len());
    for action in MAKE.actions {
        assert!(action.about.ends_with('.'), "{}", action.key);
        let is_reset = action.key.starts_with("reset") || action.key == "restart_track";
        assert_eq!(action.question.is_some(), is_reset, "{}", action.key);
    }
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_locked_out_is_told_nothing_also_where_nothing_would_move() {
    let mut rig = Rig::in_manual().await;
    let lock_out = LockOut {
        by: "Ada".to_owned(),
        reason: "feed off".to_owned(),
        since: "2026-11-22T10:00:00Z".parse().unwrap(),
    };
    rig.send(Command::LockOut(lock_out));
    rig.until("locked out", 1, |shown| shown.lock_out.is_some() && !shown.locking).await;
    let before = rig.orders();
    let (by, reason) = ("Ada".to_owned(), "feed off".to_owned());
    let refused = Event::NotSent(Refusal::LockedOut { by, reason });
    for action in MAKE.actions {
        rig.act(action.key, []);
        rig.seconds(1.0).await;
        assert_eq!(rig.events(), std::slice::from_ref(&refused), "{}", action.key);
    }
    rig.hold([1.0, 0.0], 1.0).await;
    rig.send(Command::EndJog);
    rig.seconds(1.0).await;
    assert_eq!(rig.events(), [refused], "a key that is held is refused once");
    assert_eq!(rig.orders(), before);
}
