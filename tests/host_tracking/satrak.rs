//! Satrak in program track, although it could track on board.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::{AzEl, time::add_seconds},
    contract::driver::{Command, Event, Intent, Refusal, Safety, TrackProblem, Unlike},
    controller::satrak::Satrak,
    driver::{Debts, Session},
    plan::{ProgramTrack, Target, TrackPhase},
    protocol::satrak::{FaultKind, Goto, Halt, Motion, Request, encode},
    sim::satrak::{Control, Fault, Options},
    station::{AfterPass, Antenna, Resume},
};
use jiff::{SignedDuration, Timestamp};
use tokio::io::AsyncWriteExt as _;

use super::{
    rig::{self, figures},
    sky::{self, Scene, site},
};

type Rig = rig::Rig<Control>;

fn start(control: Control, antenna: &Antenna, utc_origin: Timestamp) -> Rig {
    Rig::new(control, utc_origin, |dial, clock| {
        let satrak = Satrak::new(antenna.poll, String::new());
        Session::new(Box::new(satrak), antenna, dial, clock, Arc::new(|| {}), Debts::default())
    })
    .looking_every(rig::LOOK)
}

/// Starts a session that has read its unit, `lead_s` seconds before the pass of `scene`.
pub(super) async fn connected(antenna: &Antenna, scene: &Scene, lead_s: f64) -> (Rig, Control) {
    let utc_origin = add_seconds(scene.pass.aos.time, -lead_s);
    let control = Control::new(&Options::new(site(), utc_origin));
    let mut rig = start(control.clone(), antenna, utc_origin);
    rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
    rig.events();
    (rig, control)
}

pub(super) fn antenna() -> Antenna {
    Antenna::satrak("Dish", "in memory")
}

fn gotos(control: &Control) -> usize {
    control.received().iter().filter(|(_, payload)| payload.starts_with("GOTO=")).count()
}

fn direction(control: &Control) -> AzEl {
    let state = control.state();
    AzEl::from_degrees(state.az_deg, state.el_deg)
}

#[tokio::test(start_paused = true)]
async fn a_pass_is_waited_for_followed_and_held_at_its_end() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&antenna(), &scene, 120.0).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let told = rig.until_event(1, |event| matches!(event, Event::Awaits { .. })).await;
    let name = scene.elements.name().to_owned();
    assert_eq!(told, Event::Awaits { name: name.clone(), aos: scene.pass.aos.time });
    rig.seconds(60.0).await;
    let (aos, los) = (scene.pass.aos, scene.pass.los);
    assert!(!control.state().is_moving);
    let floor = AzEl { elevation: AzEl::from_degrees(0.0, 5.0).elevation, ..aos.direction };
    assert!(direction(&control).separation(floor).degrees() < 0.2);
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending), (Intent::Track, false));
    assert_eq!(rig.phase(), Some(TrackPhase::Waiting { aos: aos.time }));
    let sent_before = gotos(&control);

    rig.until_utc(scene.pass.tca.time).await;
    let view = rig.shown().program_track.clone().unwrap();
    assert_eq!(view.phase, TrackPhase::Tracking);
    assert!(view.predicted.is_some() && view.next_update.is_some());
    assert_eq!(rig.events(), [Event::ProgramTracks(name)]);

    let stats = rig.until_over().await;
    let (rms, worst) = figures("Satrak, usual", stats);
    assert!(rms < 0.15 && worst < 0.6, "{rms} {worst}");
    // Azel sends at most one go-to for each fifth of a degree of either axis.
    assert!(gotos(&control) - sent_before < 900);
    assert!(scene.pass.tca.time < los.time);
    let sent = gotos(&control);
    rig.seconds(30.0).await;
    assert_eq!((rig.shown().intent, rig.phase()), (Intent::Position, Some(TrackPhase::Over)));
    assert_eq!(gotos(&control), sent, "it holds");
    assert!(!control.received().iter().any(|(_, payload)| payload.starts_with("STOP")));
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn stop_and_every_other_wish_end_it_for_good() {
    let scene = sky::usual();
    for command in [
        None,
        Some(Command::Standby),
        Some(Command::Manual),
        Some(Command::Hold),
        Some(Command::Park),
    ] {
        let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
        rig.send(Command::ProgramTrack(Box::new(scene.follow())));
        rig.until_utc(add_seconds(scene.pass.aos.time, 120.0)).await;
        assert_eq!(rig.phase(), Some(TrackPhase::Tracking));
        match command.clone() {
            None => rig.stop(),
            Some(command) => rig.send(command),
        }
        rig.seconds(0.05).await;
        assert_eq!(rig.phase(), None, "{command:?}");
        let sent = gotos(&control);
        rig.seconds(90.0).await;
        let parked = usize::from(command == Some(Command::Park));
        assert_eq!(gotos(&control), sent + parked, "{command:?}");
        assert!(!control.state().is_moving);
    }
}

/// Starts a program track and waits for the middle of the default pass.
async fn following(antenna: &Antenna) -> (Rig, Control, Scene) {
    let scene = sky::usual();
    let (rig, control) = connected(antenna, &scene, 60.0).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let mut rig = rig;
    rig.until_utc(add_seconds(scene.pass.aos.time, 150.0)).await;
    (rig, control, scene)
}

fn is_followed(rig: &Rig, control: &Control) -> bool {
    let shown = rig.shown();
    let predicted = shown.program_track.as_ref().and_then(|following| following.predicted);
    predicted
        .is_some_and(|predicted| direction(control).separation(predicted.direction).degrees() < 0.6)
}

/// Sends the antenna elsewhere from another client.
async fn send_elsewhere(control: &Control) {
    let (mut near, far) = tokio::io::duplex(4096);
    let unit = control.clone();
    tokio::spawn(async move { unit.serve(far).await });
    let here = direction(control);
    let azimuth_deg = (here.azimuth_deg() + 20.0) % 360.0;
    let goto = Goto::new(Some(azimuth_deg.round()), Some(60.0)).unwrap();
    near.write_all(&Request::Motion(Motion::Goto(goto)).to_bytes()).await.unwrap();
    tokio::time::sleep(Duration::from_secs(15)).await;
}

fn asks(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::AsksToResume { .. }))
}

#[tokio::test(start_paused = true)]
async fn after_a_long_outage_it_asks_and_goes_on_at_the_operators_word() {
    let impatient = Antenna { resume_after_s: 0.5, ..antenna() };
    for (antenna, outage_s) in [(antenna(), 6.0), (impatient, 2.0)] {
        let (mut rig, control, _) = following(&antenna).await;
        rig.set_off(true);
        rig.seconds(outage_s).await;
        assert!(!control.state().is_moving, "it stands at the last position");
        let sent = gotos(&control);
        rig.set_off(false);
        rig.until_event(20, asks).await;
        rig.seconds(20.0).await;
        assert_eq!(gotos(&control), sent, "nothing moves without a word");
        assert!(rig.shown().program_track.as_ref().unwrap().awaits_operator);
        rig.send(Command::Resume);
        rig.seconds(20.0).await;
        assert_eq!(rig.phase(), Some(TrackPhase::Tracking));
        assert!(gotos(&control) > sent && is_followed(&rig, &control));
    }
}

#[tokio::test(start_paused = true)]
async fn after_a_restart_in_mid_pass_nothing_moves_until_the_operator_asks() {
    let (rig, control, scene) = following(&antenna()).await;
    let utc = rig.clock.utc();
    drop(rig);
    tokio::time::sleep(Duration::from_secs(5)).await;
    let sent = gotos(&control);
    let mut rig = start(control.clone(), &antenna(), add_seconds(utc, 5.0));
    rig.seconds(30.0).await;
    assert_eq!((rig.shown().intent, gotos(&control)), (Intent::Standby, sent));
    assert!(!control.state().is_moving);
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.seconds(20.0).await;
    assert!(gotos(&control) > sent && is_followed(&rig, &control));
}

#[tokio::test(start_paused = true)]
async fn after_a_short_outage_it_goes_on() {
    let (mut rig, control, _) = following(&antenna()).await;
    rig.set_off(true);
    rig.seconds(3.0).await;
    rig.set_off(false);
    rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    let sent = gotos(&control);
    rig.seconds(20.0).await;
    assert!(gotos(&control) > sent && is_followed(&rig, &control));
    assert!(!rig.events().iter().any(asks));
}

#[tokio::test(start_paused = true)]
async fn where_the_station_lets_it_resume_it_does_so_only_where_it_was_left() {
    let goes_on = Antenna { resume: Resume::Continue, ..antenna() };
    for is_moved in [false, true] {
        let (mut rig, control, _) = following(&goes_on).await;
        rig.set_off(true);
        rig.seconds(2.0).await;
        if is_moved {
            send_elsewhere(&control).await;
        }
        rig.seconds(18.0).await;
        let sent = gotos(&control);
        rig.set_off(false);
        rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
        rig.seconds(20.0).await;
        assert_eq!(gotos(&control) > sent, !is_moved, "moved: {is_moved}");
        assert_eq!(rig.events().iter().any(asks), is_moved);
    }
}

#[tokio::test(start_paused = true)]
async fn an_outage_on_the_way_to_a_pass_is_told_from_a_unit_that_was_moved() {
    let goes_on = Antenna { resume: Resume::Continue, resume_after_s: 0.5, ..antenna() };
    let scene = sky::usual();
    for is_moved in [false, true] {
        let (mut rig, control) = connected(&goes_on, &scene, 120.0).await;
        rig.send(Command::ProgramTrack(Box::new(scene.follow())));
        rig.seconds(1.0).await;
        rig.set_off(true);
        rig.seconds(1.0).await;
        if is_moved {
            send_elsewhere(&control).await;
        }
        assert!(is_moved || control.state().is_moving, "still on its way");
        rig.set_off(false);
        rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
        rig.seconds(20.0).await;
        assert_eq!(rig.events().iter().any(asks), is_moved);
    }
}

#[tokio::test(start_paused = true)]
async fn one_that_somebody_has_stopped_on_its_way_to_a_pass_is_not_as_it_was_left() {
    let goes_on = Antenna { resume: Resume::Continue, resume_after_s: 0.5, ..antenna() };
    let (mut rig, control) = connected(&goes_on, &sky::usual(), 120.0).await;
    rig.send(Command::ProgramTrack(Box::new(sky::usual().follow())));
    rig.seconds(1.0).await;
    rig.set_off(true);
    rig.seconds(0.2).await;
    let (mut near, far) = tokio::io::duplex(4096);
    let unit = control.clone();
    tokio::spawn(async move { unit.serve(far).await });
    near.write_all(&Request::Halt(Halt::Stop).to_bytes()).await.unwrap();
    rig.seconds(3.0).await;
    assert!(!control.state().is_moving);
    rig.set_off(false);
    rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    rig.seconds(5.0).await;
    assert!(rig.events().iter().any(asks));
}

#[tokio::test(start_paused = true)]
async fn a_second_short_outage_does_not_spare_a_unit_the_comparison() {
    let goes_on = Antenna { resume: Resume::Continue, ..antenna() };
    let (mut rig, control, _) = following(&goes_on).await;
    rig.until("its place", 60, |shown| shown.state.on_board.place.is_some()).await;
    rig.set_off(true);
    rig.seconds(2.0).await;
    let (mut near, far) = tokio::io::duplex(4096);
    let unit = control.clone();
    tokio::spawn(async move { unit.serve(far).await });
    near.write_all(&encode("GPS_SETTINGS=,0,12.50N,40.10E")).await.unwrap();
    rig.seconds(8.0).await;
    rig.set_off(false);
    rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    let sent = gotos(&control);
    // Lose the link before Azel reads the position again.
    rig.set_off(true);
    rig.seconds(0.1).await;
    rig.set_off(false);
    rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    rig.seconds(20.0).await;
    assert!(rig.events().iter().any(asks));
    assert_eq!(gotos(&control), sent);
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_comes_back_with_other_settings_is_not_followed_on_with() {
    let goes_on = Antenna { resume: Resume::Continue, ..antenna() };
    for (setting, unlike) in [
        (Some("SETTINGS=,?,?,?,1.0,?,?,?,?,?,?,?"), Some(Unlike::Offsets)),
        (Some("GPS_SETTINGS=,0,12.50N,40.10E"), Some(Unlike::Place)),
        (None, None),
    ] {
        let (mut rig, control, _) = following(&goes_on).await;
        rig.until("its place", 60, |shown| shown.state.on_board.place.is_some()).await;
        rig.set_off(true);
        rig.seconds(2.0).await;
        if let Some(setting) = setting {
            let (mut near, far) = tokio::io::duplex(4096);
            let unit = control.clone();
            tokio::spawn(async move { unit.serve(far).await });
            near.write_all(&encode(setting)).await.unwrap();
        }
        rig.seconds(8.0).await;
        let sent = gotos(&control);
        rig.set_off(false);
        rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
        rig.seconds(20.0).await;
        let asked = rig.events().into_iter().find_map(|event| match event {
            Event::Safety(Safety::AsksToResume { unlike, .. }) => unlike,
            _ => None,
        });
        assert_eq!(asked, unlike, "{setting:?}");
        assert_eq!(gotos(&control) > sent, unlike.is_none(), "{setting:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_clock_that_is_set_stops_the_following_until_the_operators_word() {
    for by_s in [600, -600, 3] {
        let (mut rig, control, _) = following(&antenna()).await;
        rig.clock.set(by_s);
        let stepped = |event: &Event| matches!(event, Event::Safety(Safety::ClockStepped { .. }));
        rig.until_event(2, stepped).await;
        rig.seconds(2.0).await;
        let sent = gotos(&control);
        rig.seconds(20.0).await;
        assert_eq!(gotos(&control), sent, "{by_s}");
        rig.clock.set(0);
        rig.until_event(2, stepped).await;
    }
}

/// Starts a program track of two passes, one a day after the other, and waits until Azel tracks the
/// first.
async fn tracking_the_first_of_two(after: AfterPass) -> (Rig, Control) {
    let mut antenna = antenna();
    antenna.follow.after = after;
    let scene = sky::usual();
    let day = SignedDuration::from_hours(24);
    let mut follow = scene.follow();
    follow.passes.push((scene.pass.aos.time + day, scene.pass.los.time + day));
    let (mut rig, control) = connected(&antenna, &scene, 60.0).await;
    rig.send(Command::ProgramTrack(Box::new(follow)));
    rig.until_utc(add_seconds(scene.pass.aos.time, 150.0)).await;
    (rig, control)
}

#[tokio::test(start_paused = true)]
async fn a_question_that_nobody_answers_keeps_it_still_after_the_pass_too() {
    for after in [AfterPass::Next, AfterPass::Park] {
        let (mut rig, control) = tracking_the_first_of_two(after).await;
        rig.set_off(true);
        rig.seconds(40.0).await;
        rig.set_off(false);
        rig.until_event(20, asks).await;
        rig.seconds(5.0).await;
        let (sent, at) = (gotos(&control), direction(&control));
        rig.until_over().await;
        rig.seconds(300.0).await;
        assert_eq!(gotos(&control), sent, "{after:?}");
        assert!(direction(&control).separation(at).degrees() < 0.01, "{after:?}");
        if after == AfterPass::Next {
            assert!(rig.shown().program_track.as_ref().unwrap().awaits_operator);
            rig.send(Command::Resume);
            rig.seconds(60.0).await;
            assert!(gotos(&control) > sent, "it goes to where the next pass begins");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn a_clock_that_is_set_past_the_pass_stops_it_before_anything_else() {
    for after in [AfterPass::Hold, AfterPass::Next, AfterPass::Park] {
        let (mut rig, control) = tracking_the_first_of_two(after).await;
        let before = control.received().len();
        rig.clock.set(3600);
        rig.seconds(60.0).await;
        let orders: Vec<String> = (control.received().into_iter().skip(before))
            .map(|(_, payload)| payload)
            .filter(|payload| payload.contains('='))
            .collect();
        // The last position before the change of the clock may still be on its way.
        let first = orders.iter().position(|order| order.starts_with("STOP=")).expect("a STOP");
        assert!(orders[first..].iter().all(|order| !order.starts_with("GOTO=")), "{orders:?}");
        assert!(first <= 1 && !control.state().is_moving, "{after:?} {orders:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn after_a_sleep_positions_are_read_anew_and_nothing_moves_by_itself() {
    let (mut rig, control, _) = following(&antenna()).await;
    let sent = gotos(&control);
    rig.clock.sleep_for(60);
    rig.until_event(2, |event| matches!(event, Event::Safety(Safety::Slept { .. }))).await;
    rig.until_event(5, asks).await;
    rig.seconds(20.0).await;
    assert!(gotos(&control) <= sent + 1, "{} {sent}", gotos(&control));
    let measured = rig.shown().state.measured.unwrap();
    assert!(measured.requested >= rig.shown().state.link_since.unwrap(), "read on the new link");
}

#[tokio::test(start_paused = true)]
async fn a_wish_or_a_stop_without_a_link_is_not_forgotten_when_it_is_back() {
    let scene = sky::usual();
    for command in [None, Some(Command::Standby), Some(Command::Manual)] {
        let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
        rig.send(Command::ProgramTrack(Box::new(scene.follow())));
        rig.until_utc(add_seconds(scene.pass.aos.time, 150.0)).await;
        rig.set_off(true);
        rig.seconds(5.0).await;
        match command.clone() {
            None => rig.stop(),
            Some(command) => rig.send(command),
        }
        rig.seconds(1.0).await;
        let sent = gotos(&control);
        rig.set_off(false);
        rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
        rig.seconds(20.0).await;
        assert_eq!((gotos(&control), rig.phase()), (sent, None), "{command:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn the_next_pass_is_waited_for_or_the_antenna_parks() {
    let scene = sky::usual();
    let day = SignedDuration::from_hours(24);
    let mut follow = scene.follow();
    follow.passes.push((scene.pass.aos.time + day, scene.pass.los.time + day));
    for after in [AfterPass::Next, AfterPass::Park] {
        let mut antenna = antenna();
        antenna.follow.after = after;
        let (mut rig, control) = connected(&antenna, &scene, 60.0).await;
        rig.send(Command::ProgramTrack(Box::new(follow.clone())));
        rig.until_over().await;
        rig.seconds(60.0).await;
        if after == AfterPass::Next {
            let aos = scene.pass.aos.time + day;
            assert_eq!(rig.phase(), Some(TrackPhase::Waiting { aos }));
        } else {
            assert_eq!((rig.phase(), rig.shown().intent), (None, Intent::Park));
            assert!(direction(&control).elevation_deg() > 89.5);
        }
    }
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_followed_is_told_and_nothing_moves() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
    let day = SignedDuration::from_hours(24);
    let mut over = scene.follow();
    over.passes = vec![(scene.pass.aos.time - day, scene.pass.los.time - day)];
    rig.send(Command::ProgramTrack(Box::new(over)));
    rig.seconds(5.0).await;
    let name = scene.elements.name().to_owned();
    assert_eq!(rig.events(), [Event::CannotProgramTrack(name, TrackProblem::NoPass)]);
    assert_eq!((gotos(&control), rig.shown().intent), (0, Intent::Standby));
}

#[tokio::test(start_paused = true)]
async fn a_direction_the_sun_and_the_moon_are_followed_too() {
    let scene = sky::usual();
    for target in [Target::Fixed(AzEl::from_degrees(200.0, 40.0)), Target::Sun, Target::Moon] {
        let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
        let follow = ProgramTrack::new(target.clone(), site(), Vec::new());
        rig.send(Command::ProgramTrack(Box::new(follow)));
        rig.seconds(4000.0).await;
        assert_eq!(rig.phase(), Some(TrackPhase::Tracking));
        if let Some(predicted) = rig.shown().program_track.as_ref().unwrap().predicted {
            let off = direction(&control).separation(predicted.direction).degrees();
            assert!(off < 0.15, "{target:?} {off}");
        }
        // The targets move by less than 17 degrees during the test.
        assert!(gotos(&control) < 400, "{target:?} {}", gotos(&control));
        if matches!(target, Target::Fixed(_)) {
            assert_eq!(gotos(&control), 1);
        }
    }
}

#[tokio::test(start_paused = true)]
async fn lost_answers_do_not_end_it() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
    control.set_fault(Fault::DropReply, true);
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    let (rms, _) = figures("Satrak, every third answer lost", rig.until_over().await);
    // The session waits for the answer to each go-to.
    assert!(rms < 1.2, "{rms}");
}

#[tokio::test(start_paused = true)]
async fn a_fault_ends_it_with_its_reason_and_forbids_it_from_the_start() {
    let scene = sky::usual();
    let (mut rig, control) = connected(&antenna(), &scene, 60.0).await;
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.until_utc(add_seconds(scene.pass.aos.time, 120.0)).await;
    rig.events();
    control.set_fault(Fault::Unit(FaultKind::Setup), true);
    let told = rig.until_event(20, |event| matches!(event, Event::CannotProgramTrack(..))).await;
    let refused = TrackProblem::Refused(Refusal::Fault);
    let name = scene.elements.name().to_owned();
    assert_eq!(told, Event::CannotProgramTrack(name.clone(), refused.clone()));
    assert_eq!((rig.phase(), rig.shown().intent), (None, Intent::Standby));
    let sent = gotos(&control);
    rig.send(Command::ProgramTrack(Box::new(scene.follow())));
    rig.seconds(5.0).await;
    assert_eq!(rig.events(), [Event::CannotProgramTrack(name, refused)]);
    assert_eq!((gotos(&control), rig.phase()), (sent, None));
}
