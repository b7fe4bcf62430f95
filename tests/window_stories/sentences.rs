//! Sentence about the antenna in every case.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::{AzEl, time::add_seconds},
    contract::{
        claim::{HeldBy, Holder, HolderKind},
        driver::{
            Event, Found, Intent, LinkLoss, LinkState, OnBoardView, Refusal, Snapshot, StopState,
        },
        passes::PredictedPass,
    },
    device::{AxisMotion, Motion, MotionRequest, Offsets, Phase, PrepareError},
    engine::antenna::{Recent, refresh},
    model::Model,
};

use crate::window_stories::{makes, on_board, rig, states};

/// Returns the sentence for the station with this snapshot after `change`.
fn told(snapshot: Snapshot, change: impl FnOnce(&mut Model, &mut Snapshot)) -> String {
    let mut model = rig::model(rig::quiet());
    let mut snapshot = snapshot;
    change(&mut model, &mut snapshot);
    let config = model.station.antennas[0].clone();
    let mut antenna = rig::antenna(config, snapshot);
    refresh(&mut antenna, &mut Recent::default(), model.station.site, |number| {
        model.pass_lists.satellite(number)
    });
    antenna.news = model.shown_mut().antennas.remove(0).news;
    model.shown_mut().antennas = vec![antenna];
    states::sentence(&model)
}

fn unchanged(_: &mut Model, _: &mut Snapshot) {}

/// Returns a change that adds a current event.
fn just(event: Event) -> impl FnOnce(&mut Model, &mut Snapshot) {
    move |model, _| model.shown_mut().antennas[0].news = Some((event, model.now))
}

fn lost(model: &mut Model, snapshot: &mut Snapshot) {
    let since = rig::ago(model, 42);
    let retry_at = model.steady + Duration::from_secs(3);
    snapshot.link = LinkState::Lost { start: since, reason: LinkLoss::Silent, retry_at };
}

#[test]
fn a_path_that_is_being_judged_is_told_before_anything_begins() {
    let judged = Snapshot { being_judged: true, ..states::tracking(0.04) };
    assert_eq!(
        told(judged, unchanged),
        "Being judged: Azel checks the whole way against keep-outs, the Sun and the limits before \
         the antenna goes on."
    );
}

#[test]
fn an_antenna_on_its_way_to_a_pass_under_way_says_when_it_will_be_there() {
    let arrives_in = |seconds: u64| {
        told(states::tracking(30.2), |model, snapshot| {
            let arrives = Some(model.steady + Duration::from_secs(seconds));
            let found = Arc::new(on_board::found(0.0));
            snapshot.on_board = Some(OnBoardView { found, missing: None, arrives });
        })
    };
    assert_eq!(
        arrives_in(21),
        "Tracking NOAA 20 with the elements stored on the unit. The antenna is still turning, 30.20° \
         off the predicted path, expected there within 21 s."
    );
    assert!(arrives_in(0).contains("outside its 0.88° beam"), "{}", arrives_in(0));
}

#[test]
fn tracking_says_how_far_off_and_when_it_ends() {
    for (off_deg, wanted) in [
        (
            0.04,
            "Tracking NOAA 20 with the elements stored on the unit. The antenna is 0.04° off the \
             predicted path, inside its 0.88° beam. At LOS 11:21:27Z it stops and holds.",
        ),
        (
            0.61,
            "Tracking NOAA 20 with the elements stored on the unit. The antenna is 0.61° off the \
             predicted path, outside its 0.88° beam. At LOS 11:21:27Z it stops and holds.",
        ),
    ] {
        assert_eq!(told(states::tracking(off_deg), unchanged), wanted);
    }
    let by_itself = Snapshot { intent: Intent::Standby, target: None, ..states::tracking(0.04) };
    assert!(told(by_itself, unchanged).starts_with("Tracking NOAA 20 by its own program. "));
    let unknown = told(states::tracking(0.04), |model, _| {
        Arc::make_mut(&mut model.shown_mut().pass_lists.favourites.satellites).clear();
    });
    assert!(unknown.ends_with("Azel has no elements of it to compare with."), "{unknown}");
}

#[test]
fn before_and_after_the_pass_it_says_where_it_waits_and_holds() {
    for (phase, motion, wanted) in [
        (
            Phase::OutOfWindow,
            AxisMotion::Plus,
            "Moving to the start of the pass of NOAA 20. Its tracking starts at 11:18:42Z, in 3:12.",
        ),
        (
            Phase::AtStart,
            AxisMotion::Still,
            "Waiting at 205.0°, 5.0° for NOAA 20. Its tracking starts at 11:18:42Z, in 3:12.",
        ),
        (
            Phase::Completed,
            AxisMotion::Still,
            "The pass of NOAA 20 is over. Holding at 205.0°, 5.0°.",
        ),
        (
            Phase::Unknown(9),
            AxisMotion::Still,
            "The unit reports the unknown tracking state 9 for NOAA 20.",
        ),
    ] {
        assert_eq!(told(states::program(phase, motion), unchanged), wanted);
    }
}

#[test]
fn before_the_lead_of_the_unit_it_says_when_the_antenna_will_move() {
    let waiting = |phase, lead_s| {
        let mut snapshot = states::program(phase, AxisMotion::Still);
        snapshot.state.on_board.offsets = Some(Offsets { lead_s, ..Offsets::default() });
        told(snapshot, unchanged)
    };
    let tracks = "Waiting at 205.0°, 5.0° for NOAA 20. Its tracking starts at 11:18:42Z, in 3:12.";
    assert_eq!(
        waiting(Phase::OutOfWindow, 60.0),
        "Waiting at 205.0°, 5.0° for NOAA 20. The antenna moves to the start at 11:17:42Z, in 2:12, \
         and tracks from 11:18:42Z."
    );
    for (phase, lead_s) in
        [(Phase::AtStart, 60.0), (Phase::OutOfWindow, 0.0), (Phase::OutOfWindow, 600.0)]
    {
        assert_eq!(waiting(phase, lead_s), tracks, "{phase:?}, {lead_s} s");
    }
}

#[test]
fn only_while_it_tracks_it_is_compared_with_the_satellite() {
    let wrong_elevation = states::tracking(20.0);
    for (phase, error) in [
        (Phase::OutOfWindow, "– (half beam 0.44°), not known"),
        (Phase::AtStart, "– (half beam 0.44°), not known"),
        (Phase::Completed, "– (half beam 0.44°), not known"),
        (Phase::Tracking, "20.00° (half beam 0.44°), outside the beam"),
    ] {
        for size in rig::sizes() {
            // NOAA 20 is up in each case.
            let mut snapshot = wrong_elevation.clone();
            snapshot.state.program.as_mut().unwrap().phase = phase;
            let model = rig::model(snapshot);
            assert_eq!(model.antennas[0].errors.back().is_some(), phase == Phase::Tracking);
            let window = rig::window(size, model);
            assert!(rig::says(&window, &format!("Off beam axis {error}")), "{phase:?}");
        }
    }
}

#[test]
fn standing_says_where_and_what_comes_next() {
    let coming = |model: &mut Model, _: &mut Snapshot| {
        let after = |predicted: &&PredictedPass| predicted.pass.aos.time > model.now;
        model.selected =
            model.pass_lists.favourites.passes.iter().find(after).map(PredictedPass::key);
    };
    let nothing = |model: &mut Model, _: &mut Snapshot| model.selected = None;
    assert_eq!(
        told(states::holding(), unchanged),
        "Holding at 343.1°, 5.0°. NOAA 20 is up but is not being tracked."
    );
    assert_eq!(
        told(states::holding(), coming),
        "Holding at 343.1°, 5.0°. SUOMI NPP rises in 1:16:27."
    );
    assert_eq!(told(states::holding(), nothing), "Holding at 343.1°, 5.0°. No pass is selected.");
    let parked = Snapshot { intent: Intent::Park, ..states::holding() };
    assert!(told(parked, nothing).starts_with("Parked, holding at 343.1°, 5.0°."));
    let at = rig::model(rig::quiet()).steady;
    let stopped = Snapshot { stop: StopState::Stopped { time: at }, ..states::holding() };
    assert!(told(stopped, nothing).starts_with("Stopped, holding at 343.1°, 5.0°."));
    let auto = told(states::holding(), |_, snapshot| {
        snapshot.state.program.as_mut().unwrap().auto = Some(true);
    });
    assert!(auto.ends_with("Auto-track is on: the unit may start by itself."), "{auto}");
}

#[test]
fn moving_says_who_moves_it_and_where_to() {
    let aim = Some(AzEl::from_degrees(136.0, 20.0).into());
    let going = Snapshot { intent: Intent::Position, aim, ..states::moving() };
    assert_eq!(told(going.clone(), unchanged), "Moving to 136.0°, 20.0°.");
    let parking = Snapshot { intent: Intent::Park, ..going };
    assert_eq!(told(parking, unchanged), "Parking at 136.0°, 20.0°.");
    for (jog, wanted) in [
        ([-0.5, 0.0], "Jogging X at −0.50 °/s while the key is held."),
        ([0.0, 3.0], "Jogging Y at +3.00 °/s while the key is held."),
    ] {
        let jogging = Snapshot { jog: Some(jog), intent: Intent::Manual, ..states::moving() };
        assert_eq!(told(jogging, unchanged), wanted);
    }
    assert_eq!(
        told(states::moving(), unchanged),
        "Moving, not by this console: somebody else is driving it, or it is coasting to a stop."
    );
    let target = Some(states::target());
    let asked = Snapshot { intent: Intent::Track, pending: true, target, ..states::holding() };
    assert_eq!(
        told(asked, unchanged),
        "Preparing to track NOAA 20: satellite and tracking window are sent to the unit and \
         read back."
    );
}

#[test]
fn a_limit_says_which_way_out() {
    for (plus, wanted) in [
        (true, "Stopped: X+ limit switch is set. Jog X− to leave the limit."),
        (false, "Stopped: X− limit switch is set. Jog X+ to leave the limit."),
    ] {
        let sentence = told(states::holding(), |_, snapshot| {
            let x = &mut snapshot.state.measured.as_mut().unwrap().axes[0];
            (x.plus_limit, x.minus_limit) = (plus, !plus);
        });
        assert_eq!(sentence, wanted);
    }
}

#[test]
fn a_fault_that_locks_motion_comes_before_all_else_and_a_warning_does_not() {
    let with = |set: &'static [usize]| {
        told(states::tracking(0.0), move |model, snapshot| {
            states::report(snapshot, set, model.now);
        })
    };
    assert_eq!(
        with(&[2, 8]),
        "Motion is locked by a fault: X motor. Do not move X: check motor, brake and drive. It is \
         still moving: STOP ends that."
    );
    let standing = told(states::holding(), |model, snapshot| {
        states::report(snapshot, &[2, 8], model.now);
    });
    assert!(standing.ends_with("check motor, brake and drive."), "{standing}");
    assert!(with(&[2, 12]).starts_with("Tracking NOAA 20"));
}

#[test]
fn a_stop_says_what_is_not_proved() {
    let stopping = told(states::moving(), |model, snapshot| {
        snapshot.stop = StopState::Stopping { start: rig::ago(model, 2) };
    });
    assert_eq!(stopping, "Stopping Satrak: STOP was sent 2.0 s ago, waiting for standstill.");
    let unproved = told(states::moving(), |model, snapshot| {
        snapshot.stop = StopState::NotConfirmed { start: rig::ago(model, 4) };
    });
    assert_eq!(
        unproved,
        "Satrak is not known to have stopped, 4.0 s after STOP. Use the local panel."
    );
}

#[test]
fn without_a_reply_it_says_since_when_and_what_was_going_on() {
    let silent = "No reply from Satrak for 42 s: the connection is open, but the unit is silent. ";
    for (snapshot, did) in [
        (states::tracking(0.0), "It was tracking NOAA 20 and is probably still moving. "),
        (states::moving(), "It was moving and is probably still moving. "),
        (states::holding(), ""),
    ] {
        assert_eq!(told(snapshot, lost), format!("{silent}{did}Next try in 3.0 s."));
    }
    for (link, wanted) in [
        (
            LinkState::Off,
            "Satrak is not connected, so another program can use it. Press Connect to open the \
             link again.",
        ),
        (
            LinkState::Connecting { start: rig::model(rig::quiet()).steady },
            "Connecting to Satrak at 192.168.10.21:4001.",
        ),
    ] {
        assert_eq!(told(Snapshot::before_anything(link), unchanged), wanted);
    }
    assert_eq!(told(rig::quiet(), unchanged), "Satrak is connected and is being read.");
}

#[test]
fn a_silent_unit_is_not_said_to_do_what_it_did_last() {
    let silent = |snapshot: Snapshot, silent_s| {
        told(snapshot, move |model, snapshot| {
            snapshot.link = LinkState::Stale { as_of: rig::ago(model, silent_s) };
            snapshot.state.traffic.last_reply = Some(rig::ago(model, silent_s));
        })
    };
    assert_eq!(
        silent(states::tracking(0.0), 9),
        "No reply from Satrak for 9.0 s. It was tracking NOAA 20 and is probably still moving. \
         Azel connects again if it stays silent."
    );
    assert!(silent(states::tracking(0.0), 2).starts_with("Tracking NOAA 20"));
    let on_a_new_link = told(states::tracking(0.0), |model, snapshot| {
        let since = rig::ago(model, 1);
        snapshot.link = LinkState::Up { start: since };
        snapshot.state.link_since = Some(since);
        if let Some(measured) = &mut snapshot.state.measured {
            measured.received = rig::ago(model, 30);
        }
        snapshot.state.traffic.last_reply = Some(rig::ago(model, 30));
    });
    assert!(on_a_new_link.starts_with("No reply from Satrak for 30 s."), "{on_a_new_link}");
    let late = told(states::tracking(0.0), |model, snapshot| {
        snapshot.link = LinkState::Stale { as_of: rig::ago(model, 5) };
        snapshot.state.link_since = Some(rig::ago(model, 60));
        snapshot.state.traffic.last_reply = Some(rig::ago(model, 1));
        if let Some(measured) = &mut snapshot.state.measured {
            measured.requested = rig::ago(model, 5);
        }
    });
    assert_eq!(
        late,
        "Satrak answers late: its position is 5.0 s old. It was tracking NOAA 20 and is probably \
         still moving. Check its cable and the network."
    );
    let mut stopping = states::moving();
    stopping.stop = StopState::NotConfirmed { start: rig::model(rig::quiet()).steady };
    assert!(silent(stopping, 9).contains("is not known to have stopped"));
}

#[test]
fn a_make_that_serves_one_program_says_that_another_may_have_it() {
    let (other, refused) = (
        "Perhaps another program holds the connection. ",
        LinkLoss::Refused("connection refused".to_owned()),
    );
    for (reason, wanted) in [
        (refused, format!("the connection was not made (connection refused). {other}")),
        (LinkLoss::Closed, format!("the unit closed the connection. {other}")),
        (LinkLoss::Silent, "the connection is open, but the unit is silent. ".to_owned()),
        (
            LinkLoss::OtherDevice,
            "another device answers there, or one that asks for a code first. ".to_owned(),
        ),
    ] {
        let mut model = makes::model(makes::pair(), rig::quiet());
        let (since, retry_at) = (rig::ago(&model, 42), model.steady + Duration::from_secs(3));
        let mut snapshot = rig::quiet();
        snapshot.link = LinkState::Lost { start: since, reason, retry_at };
        model.shown_mut().antennas.clone_from(&makes::model(makes::pair(), snapshot).antennas);
        let sentence = format!("No reply from Genius for 42 s: {wanted}Next try in 3.0 s.");
        assert_eq!(states::sentence(&model), sentence);
    }
}

#[test]
fn a_refusal_without_a_code_is_told_in_its_words() {
    let asked = MotionRequest::Action(azel::controller::rotator_genius::OTHER);
    let refused = Event::Refused(asked, "F for rotator 2: it is outside its limits".to_owned());
    let mut model = makes::model(makes::alone(), states::holding());
    model.shown_mut().antennas[0].news = Some((refused, model.now));
    let sentence = states::sentence(&model);
    assert!(
        sentence.ends_with("the unit answered F for rotator 2: it is outside its limits."),
        "{sentence}"
    );
}

#[test]
fn what_has_just_happened_is_told_first_and_for_a_while() {
    let after = Duration::from_secs(42);
    let back = Event::Back { after, found: Found::Tracking, is_explained: true };
    assert_eq!(
        told(states::tracking(0.0), just(back.clone())),
        "Satrak answers again after 42 s. It is still tracking NOAA 20."
    );
    let later = told(states::tracking(0.0), |model, _| {
        model.shown_mut().antennas[0].news = Some((back, add_seconds(model.now, -13.0)));
    });
    assert!(later.starts_with("Tracking NOAA 20"), "{later}");
    let refused = PrepareError::Refused("ERR,7".to_owned());
    for (event, wanted) in [
        (
            Event::Back { after, found: Found::Still, is_explained: true },
            "Satrak answers again after 42 s. It is at rest and tracks nothing.",
        ),
        (Event::NotSent(Refusal::Stopping), "Not sent: a stop is under way."),
        (
            Event::Refused(MotionRequest::Motion(Motion::StartProgram), "ERR,7".to_owned()),
            "Track: the unit answered ERR,7.",
        ),
        (
            Event::CannotTrack(states::target(), refused),
            "Not tracking NOAA 20: the unit answered ERR,7.",
        ),
        (
            Event::StopRefused("ERR,7".to_owned()),
            "The unit answered ERR,7 to STOP. Use the local panel.",
        ),
    ] {
        assert_eq!(told(states::holding(), just(event)), wanted);
    }
}

#[test]
fn numbers_that_cannot_be_read_are_told_with_the_likely_cause() {
    let commas = |snapshot: &mut Snapshot| snapshot.state.unreadable = Some("Decimal commas.");
    let cause = "Decimal commas.";
    let unread = format!("The position of Satrak cannot be read. {cause}");
    assert_eq!(told(rig::quiet(), |_, snapshot| commas(snapshot)), unread);
    let lost = |model: &mut Model, snapshot: &mut Snapshot| {
        lost(model, snapshot);
        commas(snapshot);
    };
    assert_eq!(told(rig::quiet(), lost), format!("{unread} Next try in 3.0 s."));
    let tracked = told(states::tracking(0.0), lost);
    assert!(tracked.contains("It was tracking NOAA 20 and is probably still moving."), "{tracked}");
    let stopping = told(rig::quiet(), |model, snapshot| {
        commas(snapshot);
        snapshot.stop = StopState::NotConfirmed { start: rig::ago(model, 4) };
        snapshot.state.measured = states::holding().state.measured;
    });
    assert!(stopping.contains("Use the local panel."), "{stopping}");
}

#[test]
fn a_step_is_told_with_its_axis_and_amount() {
    for (step, wanted) in [
        ([0.5, 0.0], "Moving X by +0.50° in one step."),
        ([0.0, -2.0], "Moving Y by −2.00° in one step."),
    ] {
        let snapshot = Snapshot { intent: Intent::Manual, step: Some(step), ..states::moving() };
        assert_eq!(told(snapshot, unchanged), wanted);
    }
}

#[test]
fn an_antenna_that_another_azel_drives_names_it() {
    let mut model = rig::model(Snapshot { link: LinkState::Off, ..states::holding() });
    let since = "2026-08-12T09:00:00Z".parse().unwrap();
    let (socket, antenna) = (None, None);
    let holder = Holder { kind: HolderKind::Serve, process: 4242, start: since, socket, antenna };
    model.shown_mut().antennas[0].held_by = Some(HeldBy::Azel(Some(holder)));
    assert_eq!(
        states::sentence(&model),
        "Satrak is driven by azel serve (process 4242, since 2026-08-12 09:00Z). Nothing goes to \
         it from here."
    );
}
