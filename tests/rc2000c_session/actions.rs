//! Moves to stored satellites and to counts.

use azel::{
    contract::driver::{Command, Event, Intent, Mover, Refusal, Response, Safety},
    controller::rc2000c::VARIANT,
    device::{MotionRequest, panel::CheckState, settings::Value},
    plan::Bounds,
    protocol::rc2000c::SatelliteName,
    sim::rc2000c::{Options, StoredSatellite},
    station::{Antenna, LockOut, Monitor, Station},
};

use super::rig::{Rig, antenna, check, reading, uncalibrated};

async fn refused(rig: &mut Rig) -> String {
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Action(_), reason) = event else { panic!("{event:?}") };
    reason
}

async fn not_sent(rig: &mut Rig) -> Refusal {
    let event = rig.until_event(2, |event| matches!(event, Event::NotSent(..))).await;
    let Event::NotSent(refusal) = event else { panic!("{event:?}") };
    refusal
}

/// Returns bounds with a mast in front of azimuths 140 to 150 degrees, up to 60 degrees.
fn mast() -> Bounds {
    let corners_deg = [(140.0, -5.0), (150.0, -5.0), (150.0, 60.0), (140.0, 60.0)];
    let mast = crate::common::mast(&corners_deg);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    Bounds::new(&station, &antenna())
}

#[tokio::test(start_paused = true)]
async fn counts_are_judged_by_the_way_of_the_angles_that_they_mean() {
    let mut rig = Rig::in_manual().await;
    rig.handle().keep_within(mast());
    let counts = |az, el| [("az_counts", Value::Integer(az)), ("el_counts", Value::Integer(el))];
    // The mast stands between 164.75 degrees and the target at 110 degrees.
    rig.act("to_counts", counts(430, 750));
    let told = not_sent(&mut rig).await;
    assert!(matches!(told, Refusal::Forbidden { .. }), "{told:?}");
    rig.act_unseen("to_counts", counts(430, 750));
    assert_eq!(not_sent(&mut rig).await, told, "no word of the operator opens it");
    assert!(rig.orders().is_empty());
    rig.act("to_counts", counts(1530, 1500));
    rig.seconds(15.0).await;
    rig.act("to_counts", counts(430, 1500));
    rig.seconds(30.0).await;
    assert_eq!(rig.counts(), [430, 1500], "over it");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn counts_that_mean_no_angle_are_refused_whatever_the_operator_says() {
    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    rig.send(Command::Manual);
    let counts = [("az_counts", Value::Integer(1600)), ("el_counts", Value::Integer(700))];
    for is_agreed in [false, true] {
        if is_agreed {
            rig.act_unseen("to_counts", counts.clone());
        } else {
            rig.act("to_counts", counts.clone());
        }
        let told = not_sent(&mut rig).await;
        let Refusal::Controller(why) = told else { panic!("{told:?}") };
        assert!(why.contains("enter two points"), "{why}");
    }
    assert!(rig.orders().is_empty());
}

#[tokio::test(start_paused = true)]
async fn what_leads_where_only_the_unit_knows_needs_the_operators_word() {
    let mut rig = Rig::in_manual().await;
    rig.act("to_satellite", to("GALAXY 5", 0));
    let told = not_sent(&mut rig).await;
    let Refusal::Unseen { act, reason: why, is_watched } = told else { panic!("{told:?}") };
    assert_eq!((act.action, why.contains("names"), is_watched), ("to_satellite", true, true));
    rig.seconds(2.0).await;
    assert!(rig.orders().is_empty());
    rig.send(Command::ActUnseen(act));
    rig.seconds(20.0).await;
    assert_eq!(rig.counts(), [1100, 640]);
}

#[tokio::test(start_paused = true)]
async fn what_was_started_unseen_is_stopped_before_a_keep_out_whatever_the_station_says_of_others()
{
    let alarm_alone = Antenna { monitor: Monitor::Alarm, ..antenna() };
    let mut rig = Rig::connected(&Options::default(), &alarm_alone).await;
    rig.send(Command::Manual);
    rig.handle().keep_within(mast());
    // The stored azimuth is 122.75 degrees, behind the mast.
    rig.act_unseen("to_satellite", to("SATCOM C3", 0));
    let is_told = |event: &Event| matches!(event, Event::Safety(Safety::Forbidden { .. }));
    let told = rig.until_event(30, is_told).await;
    let Event::Safety(Safety::Forbidden { driver, response, .. }) = told else { panic!() };
    assert_eq!((driver, response), (Mover::Azel, Response::Stopped));
    rig.until_event(5, |event| *event == Event::Stopped).await;
    let azimuth_deg = rig.shown().state.measured.unwrap().direction().unwrap().azimuth_deg();
    assert!((150.0..160.0).contains(&azimuth_deg), "{azimuth_deg}");
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_watched_is_not_started_unseen() {
    let mut rig = Rig::connected(&Options::default(), &uncalibrated()).await;
    rig.send(Command::Manual);
    rig.handle().keep_within(mast());
    rig.act_unseen("to_satellite", to("GALAXY 5", 0));
    assert_eq!(not_sent(&mut rig).await, Refusal::AngleUnknown { axis: "Az" });
    assert!(rig.orders().is_empty());
    // Without barriers, Azel relies on the eyes of the operator.
    rig.handle().keep_within(Bounds::of_antenna(&uncalibrated()));
    rig.act("to_satellite", to("GALAXY 5", 0));
    let told = not_sent(&mut rig).await;
    assert!(matches!(told, Refusal::Unseen { is_watched: false, .. }), "{told:?}");
    rig.act_unseen("to_satellite", to("GALAXY 5", 0));
    rig.seconds(20.0).await;
    assert_eq!(rig.counts(), [1100, 640]);
}

fn to(name: &str, polarity: i64) -> [(&'static str, Value); 2] {
    [("satellite", Value::Text(name.to_owned())), ("polarity", Value::Choice(polarity))]
}

#[tokio::test(start_paused = true)]
async fn a_stored_satellite_is_gone_to_by_its_name_and_polarity() {
    let mut rig = Rig::in_manual().await;
    rig.act_unseen("to_satellite", to(" galaxy 5 ", 0));
    rig.seconds(20.0).await;
    assert_eq!(rig.counts(), [1100, 640]);
    assert_eq!(reading(&rig.shown(), "Satellite").as_deref(), Some("GALAXY 5"));
    rig.act_unseen("to_satellite", to("SBS 6", 1));
    rig.seconds(0.5).await;
    assert!(rig.shown().state.measured.unwrap().moving());
    rig.seconds(20.0).await;
    rig.act_unseen("to_satellite", to("SBS 6", 2));
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
    rig.act_unseen("to_satellite", to("GALAXY", 0));
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
    rig.act_unseen("to_satellite", to("left", 0));
    rig.seconds(1.0).await;
    assert_eq!(rig.orders(), ["2   LEFT    "]);
    rig.act_unseen("to_satellite", to("0123456789", 0));
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
    let told = not_sent(&mut rig).await;
    assert!(matches!(told, Refusal::Travel { axis: "Az", to_deg: 270.0, .. }), "{told:?}");
    // The target is within the travel but below the minimum elevation.
    rig.act_unseen("to_counts", counts(1600, 70));
    let told = not_sent(&mut rig).await;
    assert!(matches!(told, Refusal::Elevation { lowest_deg: 5.0, .. }), "{told:?}");
    rig.act("to_counts", [("az_counts", Value::Integer(1600))]);
    assert_eq!(refused(&mut rig).await, "el_counts is missing");
    assert_eq!(rig.times("2").len(), 1);
    assert_eq!(check(&rig.shown(), "Remote mode"), Some(CheckState::Good));
}

#[tokio::test(start_paused = true)]
async fn in_standby_no_action_moves_anything_and_an_unknown_one_is_none() {
    let mut rig = Rig::in_manual().await;
    rig.send(Command::Standby);
    for action in VARIANT.actions.iter().filter(|action| action.moves) {
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
    let mut keys: Vec<&str> = VARIANT.actions.iter().map(|action| action.key).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), VARIANT.actions.len());
    for action in VARIANT.actions {
        assert!(action.description.ends_with('.'), "{}", action.key);
        let is_reset = action.key.starts_with("reset") || action.key == "restart_track";
        assert_eq!(action.question.is_some(), is_reset, "{}", action.key);
    }
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_locked_out_is_told_nothing_also_where_nothing_would_move() {
    let mut rig = Rig::in_manual().await;
    let lock_out = LockOut {
        operator: "Ada".to_owned(),
        reason: "feed off".to_owned(),
        start: "2026-11-22T10:00:00Z".parse().unwrap(),
    };
    rig.send(Command::LockOut(lock_out));
    rig.until("locked out", 1, |shown| shown.lock_out.is_some() && !shown.locking).await;
    let before = rig.orders();
    let (by, reason) = ("Ada".to_owned(), "feed off".to_owned());
    let refused = Event::NotSent(Refusal::LockedOut { operator: by, reason });
    for action in VARIANT.actions {
        rig.act(action.key, []);
        rig.seconds(1.0).await;
        assert_eq!(rig.events(), std::slice::from_ref(&refused), "{}", action.key);
    }
    rig.hold([1.0, 0.0], 1.0).await;
    rig.send(Command::EndJog);
    rig.seconds(1.0).await;
    assert_eq!(rig.events(), [], "the keys are locked without a link");
    assert_eq!(rig.orders(), before);
}
