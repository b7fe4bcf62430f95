//! Lock-out of a unit: Azel sends only questions and STOP.

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Event, Found, Intent, LinkState, Refusal, StopState},
    device::{
        panel::Act,
        settings::{Value, WriteError},
    },
    plan::{ProgramTrack, Target},
    station::LockOut,
};

use super::{
    rig::{Rig, antenna, iss, options},
    scene::{site, track},
    script::{STILL, Scripted, plain},
    settings::{change, read, text},
};

fn lock_out() -> LockOut {
    LockOut {
        operator: "Ada".to_owned(),
        reason: "gear box open".to_owned(),
        start: "2008-09-20T10:00:00Z".parse().unwrap(),
    }
}

fn refused() -> Event {
    Event::NotSent(Refusal::LockedOut {
        operator: "Ada".to_owned(),
        reason: "gear box open".to_owned(),
    })
}

/// Locks the unit out and waits for the proof.
async fn lock(rig: &mut Rig) {
    rig.send(Command::LockOut(lock_out()));
    rig.until("locked out", 10, |shown| shown.lock_out.is_some() && !shown.locking).await;
    rig.events();
}

/// Returns the received commands other than questions and STOP.
fn others(rig: &Rig) -> Vec<String> {
    const STOP: [&str; 3] = ["STOP=", "TRACK=,0", "TRACK_AUTO_ENABLE=,0"];
    rig.orders().into_iter().filter(|payload| !STOP.contains(&payload.as_str())).collect()
}

fn commands() -> Vec<Command> {
    let angle = |degrees| Some(Angle::from_degrees(degrees));
    let target = Target::Fixed(AzEl::from_degrees(180.0, 45.0));
    let follow = ProgramTrack::new(target, site(), Vec::new());
    vec![
        Command::Manual,
        Command::Hold,
        Command::Jog { rates_deg_s: [1.0, 0.0] },
        Command::Step { steps_deg: [1.0, 0.0] },
        Command::Position { azimuth: angle(74.0), elevation: angle(60.0) },
        track(iss()),
        Command::ProgramTrack(Box::new(follow)),
        Command::Park,
        Command::AutoTrack(true),
        Command::AutoTrack(false),
        Command::Act(Act { action: "anything", values: [].into() }),
    ]
}

#[tokio::test(start_paused = true)]
async fn every_command_is_refused_and_nothing_but_questions_and_stop_goes_out() {
    let mut rig = Rig::usual().await;
    for group in ["general", "window"] {
        read(&mut rig, group).await;
    }
    lock(&mut rig).await;
    assert_eq!(others(&rig), [""; 0]);
    for command in commands() {
        rig.send(command.clone());
        rig.seconds(1.0).await;
        rig.send(Command::EndJog);
        rig.seconds(0.5).await;
        let refusal = rig.events();
        let is_told = matches!(command, Command::Act(_)) || refusal == [refused()];
        assert!(is_told, "{command:?}: {refusal:?}");
        assert_eq!(rig.shown().intent, Intent::Standby, "{command:?}");
    }
    rig.send(Command::Standby);
    let wish = change("general", [("lead_ms", Value::Integer(90_000))]);
    rig.send(Command::WriteSettings(wish));
    rig.until("refused", 5, |shown| shown.state.groups["general"].written.is_some()).await;
    let written = rig.shown().state.groups["general"].written.clone().unwrap();
    assert_eq!(written.result, Err(WriteError::LockedOut));
    let asked = rig.sent("GPS_DATA?").len();
    rig.send(Command::Ask("GPS_DATA?".into()));
    rig.seconds(2.0).await;
    assert!(rig.sent("GPS_DATA?").len() > asked, "it is asked");
    rig.stop();
    rig.until_event(5, |event| *event == Event::Stopped).await;
    assert_eq!(others(&rig), [""; 0]);
    assert_eq!(rig.shown().lock_out, Some(lock_out()));

    rig.send(Command::Unlock);
    rig.send(Command::Hold);
    rig.send(Command::Position { azimuth: None, elevation: Some(Angle::from_degrees(70.0)) });
    rig.until("it moves", 5, |shown| shown.state.measured.unwrap().moving()).await;
    assert_eq!(rig.shown().lock_out, None);
}

#[tokio::test(start_paused = true)]
async fn what_moves_is_stopped_and_auto_track_is_off_before_it_counts_as_locked_out() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.until_event(30, |event| matches!(event, Event::Tracking(_))).await;
    rig.send(Command::AutoTrack(true));
    rig.until("auto-track", 5, |shown| shown.state.program.unwrap().auto == Some(true)).await;
    let before = rig.orders().len();
    rig.send(Command::LockOut(lock_out()));
    rig.seconds(0.05).await;
    let shown = rig.shown();
    assert_eq!((shown.lock_out.clone(), shown.locking), (Some(lock_out()), true));
    rig.until("locked out", 10, |shown| !shown.locking).await;
    let shown = rig.shown();
    assert_eq!(shown.state.program.unwrap().auto, Some(false));
    assert!(!shown.state.measured.unwrap().moving());
    assert_eq!((shown.intent, &shown.program_track), (Intent::Standby, &None));
    let sent = rig.orders().split_off(before);
    assert_eq!(sent[..2], ["STOP=", "TRACK=,0"]);
    assert_eq!(sent.iter().filter(|payload| *payload == "TRACK_AUTO_ENABLE=,0").count(), 1);
    let told = rig.events();
    assert!(told.contains(&Event::Stopped) && !told.contains(&Event::LockOutUnproved), "{told:?}");
}

#[tokio::test(start_paused = true)]
async fn a_change_of_settings_that_waits_is_not_sent_any_more() {
    let mut rig = Rig::usual().await;
    read(&mut rig, "web").await;
    rig.send(Command::WriteSettings(change("web", [("url", text("https://example.org/tle"))])));
    rig.send(Command::LockOut(lock_out()));
    rig.until("refused", 5, |shown| shown.state.groups["web"].written.is_some()).await;
    let written = rig.shown().state.groups["web"].written.clone().unwrap();
    assert_eq!(written.result, Err(WriteError::LockedOut));
    assert_eq!(others(&rig), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn without_a_link_the_lock_stands_and_is_proved_when_the_unit_is_back() {
    let mut rig = Rig::usual().await;
    rig.send(Command::AutoTrack(true));
    rig.until("auto-track", 5, |shown| shown.state.program.unwrap().auto == Some(true)).await;
    rig.set_off(true);
    rig.until("lost", 10, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    rig.events();
    rig.send(Command::LockOut(lock_out()));
    rig.until_event(1, |event| *event == Event::LockOutUnproved).await;
    assert!(rig.shown().lock_out.is_some() && rig.shown().locking);
    rig.set_off(false);
    rig.until("locked out", 20, |shown| !shown.locking).await;
    assert_eq!(rig.sent("TRACK_AUTO_ENABLE=,0").len(), 1);
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(false));
}

#[tokio::test(start_paused = true)]
async fn a_session_of_a_locked_unit_starts_locked_and_moves_nothing_from_the_first_byte() {
    let mut rig = Rig::start_locked_out(&options(), &antenna(), Some(lock_out()));
    assert_eq!(rig.shown().lock_out, Some(lock_out()));
    assert!(rig.shown().locking);
    let found = rig.until_event(5, |event| matches!(event, Event::Connected(_))).await;
    assert_eq!(found, Event::Connected(Found::Still));
    rig.until("locked out", 5, |shown| !shown.locking).await;
    rig.send(Command::Park);
    rig.until_event(1, |event| *event == refused()).await;
    assert_eq!(rig.orders(), [""; 0]);
    assert_eq!(rig.shown().stop, StopState::Ready);
}

#[tokio::test(start_paused = true)]
async fn auto_track_that_stays_on_is_an_alarm_and_the_lock_stands_all_the_same() {
    // Auto track is on or not reported. The unit answers OK and changes nothing.
    let on = format!("{}1", STILL.strip_suffix('0').unwrap());
    let silent = STILL.strip_suffix(",0").unwrap().to_owned();
    for status in [on, silent] {
        let script = move |payload: &str| match payload {
            "STATUS?" => vec![(10, status.clone())],
            other => plain(other),
        };
        let mut unit = Scripted::start(Box::new(script));
        unit.seconds(3.0).await;
        unit.handle.send(Command::LockOut(lock_out())).unwrap();
        unit.seconds(60.0).await;
        let told = unit.events();
        let alarms = told.iter().filter(|event| **event == Event::LockOutUnproved).count();
        assert_eq!(alarms, 1, "{told:?}");
        let shown = unit.handle.snapshot();
        assert!(shown.lock_out.is_some() && shown.locking);
        assert_eq!(unit.sent("TRACK_AUTO_ENABLE=").len(), 1, "it is not asked again and again");
        unit.handle.send(Command::Park).unwrap();
        unit.seconds(1.0).await;
        assert_eq!(unit.events(), [refused()]);
    }
}
