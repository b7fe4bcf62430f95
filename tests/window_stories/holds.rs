//! Confirmations that the operator gives by holding a button.

use std::sync::Arc;

use azel::{
    astro::AzEl,
    contract::{
        self,
        alarms::AlarmKind,
        driver::{
            Breach, Command, Event, Intent, LeftMoving, Mover, Refusal, Response, Safety, Snapshot,
            StopState,
        },
    },
    device::{panel::Act, settings::Values},
    engine::alarms::KeepAlarms,
    model::{Model, UiCommand},
    plan::{Barrier, Target},
    station::{Antenna, AntennaId, KeepOut, SunAvoidance},
};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, LARGE, Window, asked, says},
    settings_rig::hold,
    states,
};

const STANDS: &str = "Hold 1 s: I have seen it at rest";
const UNGUARDED: &str = "Hold 1 s to move without the dead-man timer";

fn shows(snapshot: Snapshot) -> Model {
    let mut model = rig::model(states::holding());
    model.shown_mut().antennas = vec![rig::antenna(model.station.antennas[0].clone(), snapshot)];
    model
}

#[test]
fn a_jog_without_a_dead_man_is_allowed_by_holding_only() {
    let unguarded = || Snapshot { intent: Intent::Manual, unguarded: true, ..states::holding() };
    // Azel asks no question before it has refused a jog for this reason, or once the operator has
    // confirmed.
    for (snapshot, is_refused) in
        [(unguarded(), false), (Snapshot { unguarded: false, ..unguarded() }, true)]
    {
        let mut model = shows(snapshot);
        model.shown_mut().antennas[0].asks_unguarded = is_refused;
        assert!(rig::window(LARGE, model).query_by_label(UNGUARDED).is_none());
    }
    let mut model = shows(unguarded());
    model.shown_mut().antennas[0].asks_unguarded = true;
    let mut window = rig::window(LARGE, model);
    assert!(says(&window, "nothing would stop the antenna"));
    window.get_by_label(UNGUARDED).click();
    assert_eq!(asked(&mut window), [], "a click is no hold");
    hold(&mut window, UNGUARDED);
    assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::AllowUnguarded)]);
}

#[test]
fn who_sees_an_antenna_stand_says_so_by_holding() {
    for size in rig::sizes() {
        let since = states::moving().state.measured.unwrap().received;
        let not_confirmed =
            Snapshot { stop: StopState::NotConfirmed { start: since }, ..states::moving() };
        let left = Snapshot {
            left_moving: Some(LeftMoving { start: Some(rig::now()) }),
            ..states::holding()
        };
        for (snapshot, why) in [
            (not_confirmed, "STOP is repeated until the antenna is known to be at rest."),
            (left, "Azel ended at 11:15:30Z while the antenna was moved."),
        ] {
            let mut window = rig::window(size, shows(snapshot));
            assert!(says(&window, why), "{why}");
            window.get_by_label(STANDS).click();
            assert_eq!(asked(&mut window), [], "a click is no hold");
            hold(&mut window, STANDS);
            let wanted = [UiCommand::antenna(AntennaId(1), Command::SeenStanding)];
            assert_eq!(asked(&mut window), wanted, "{why}");
        }
        let window = rig::window(size, rig::model(states::moving()));
        assert!(window.query_by_label(STANDS).is_none());
    }
}

const OUT: &str = "Hold 1 s to move out by hand";
const INTO_SUN: &str = "Hold 1 s to follow the Sun";

fn inside(barrier: Barrier, may_leave: bool) -> Snapshot {
    Snapshot { breach: Some(Breach { barrier, unknown_axis: None, may_leave }), ..states::manual() }
}

#[test]
fn a_motion_that_cannot_be_checked_is_allowed_by_holding_only() {
    let unknown = |may_leave| {
        let barrier = Barrier::KeepOut("mast".into());
        let inside = Some(Breach { barrier, unknown_axis: Some("Az"), may_leave });
        Snapshot { breach: inside, ..states::manual() }
    };
    let hold_unchecked = "Hold 1 s to move unchecked";
    for size in rig::sizes() {
        let mut window = rig::window(size, shows(unknown(false)));
        assert!(says(&window, "The angle of Az is not known: Satrak may be inside “mast”."));
        window.get_by_label(hold_unchecked).click();
        assert_eq!(asked(&mut window), [], "a click is no hold");
        hold(&mut window, hold_unchecked);
        assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::AllowWayOut)]);

        let window = rig::window(size, shows(unknown(true)));
        assert!(says(&window, "Azel does not check where it leads"));
        assert!(window.query_by_label(hold_unchecked).is_none());
    }
}

#[test]
fn the_way_out_of_a_keep_out_is_allowed_by_holding_only() {
    let mast = || Barrier::KeepOut("mast".into());
    for size in rig::sizes() {
        let words = "Satrak is inside “mast” now. It can be moved out by hand once you allow it.";
        let mut window = rig::window(size, shows(inside(mast(), false)));
        assert!(says(&window, words));
        assert!(says(&window, "Satrak stands inside “mast” and leaves it by hand alone."));
        window.get_by_label(OUT).click();
        assert_eq!(asked(&mut window), [], "a click is no hold");
        hold(&mut window, OUT);
        assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::AllowWayOut)]);

        let window = rig::window(size, shows(inside(mast(), true)));
        assert!(says(&window, "You have allowed it to be moved out by hand for a minute"));
        assert!(window.query_by_label(OUT).is_none());
        let window = rig::window(size, shows(states::manual()));
        assert!(window.query_by_label(OUT).is_none());
    }
}

#[test]
fn the_sun_is_followed_at_once_or_by_a_hold_that_names_its_avoidance() {
    for size in rig::sizes() {
        let choose_the_sun = |model: Model| {
            let mut window = rig::window(size, model);
            window.get_by_label("Follow something else").click();
            rig::settle(&mut window);
            window.get_by_label("Follow the Sun").click();
            rig::settle(&mut window);
            window
        };
        let follow = |window: &mut Window| match &asked(window)[..] {
            [
                UiCommand::Station(contract::Command::Antenna(
                    AntennaId(1),
                    Command::ProgramTrack(follow),
                )),
            ] => (follow.target.clone(), false),
            [
                UiCommand::Station(contract::Command::Antenna(
                    AntennaId(1),
                    Command::ProgramTrackIntoSun(follow),
                )),
            ] => (follow.target.clone(), true),
            other => panic!("{other:?}"),
        };
        let mut window = choose_the_sun(shows(states::holding()));
        assert_eq!(follow(&mut window), (Target::Sun, false));

        let mut model = shows(states::holding());
        Arc::make_mut(&mut model.shown_mut().station).sun_avoidance =
            Some(SunAvoidance { radius_deg: 5.0, ahead_min: 10.0 });
        let mut window = choose_the_sun(model);
        assert_eq!(asked(&mut window), [], "it is asked for first");
        assert!(says(&window, "The Sun avoidance keeps Satrak 5.0° away from the Sun."));
        window.get_by_label(INTO_SUN).click();
        assert_eq!(asked(&mut window), [], "a click is no hold");
        hold(&mut window, INTO_SUN);
        assert_eq!(follow(&mut window), (Target::Sun, true));
        assert!(window.query_by_label(INTO_SUN).is_none());
    }
}

#[test]
fn an_alarm_about_the_sun_offers_to_move_away_in_one_step() {
    let near = "Move away: Satrak is too close to the Sun; Azel was not moving it.";
    let told = Safety::Forbidden {
        barrier: Barrier::Sun,
        driver: Mover::Somebody,
        response: Response::Reported,
    };
    for size in rig::sizes() {
        let alarmed = |snapshot: Snapshot| {
            let mut model = shows(snapshot);
            model.shown_mut().alarms.raise(
                Some(AntennaId::FIRST),
                AlarmKind::Safety(told.clone()),
                rig::now(),
            );
            let mut window = rig::window(size, model);
            window.get_by_label_contains("1 alarm").click();
            rig::settle(&mut window);
            assert_eq!(asked(&mut window), [UiCommand::Station(contract::Command::OpenedAlarms)]);
            window
        };
        let mut window = alarmed(inside(Barrier::Sun, false));
        window.get_by_label(near).click();
        assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::MoveAway)]);
        let moving = Snapshot { breach: inside(Barrier::Sun, false).breach, ..states::moving() };
        for other in [moving, states::manual()] {
            assert!(alarmed(other).query_by_label(near).is_none());
        }
    }
}

#[test]
fn a_keep_out_is_told_of_with_its_reason() {
    let mut model = shows(states::manual());
    let mast = crate::common::mast(&[(80.0, 0.0), (80.0, 30.0), (100.0, 30.0), (100.0, 0.0)]);
    let reason = "Steel mast, 24 m away".to_owned();
    Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![KeepOut { reason, ..mast }];
    let barrier = || Barrier::KeepOut("mast".into());
    let refusal =
        Refusal::Forbidden { barrier: barrier(), direction: AzEl::from_degrees(90.0, 20.0) };
    model.shown_mut().antennas[0].news = Some((Event::NotSent(refusal), rig::now()));
    let told = Safety::Forbidden {
        barrier: barrier(),
        driver: Mover::Somebody,
        response: Response::Stopped,
    };
    model.shown_mut().alarms.raise(Some(AntennaId::FIRST), AlarmKind::Safety(told), rig::now());
    let mut window = rig::window(LARGE, model);
    assert!(says(&window, "at 90.0°, 20.0°. “mast”: Steel mast, 24 m away."));
    window.get_by_label_contains("1 alarm").click();
    rig::settle(&mut window);
    assert!(says(&window, "Azel was not moving it. “mast”: Steel mast, 24 m away."));
}

#[test]
fn an_action_whose_end_nobody_here_knows_is_started_by_holding_only() {
    const UNSEEN: &str = "Hold 1 s to start it without knowing where it ends";
    let dish = Antenna::rc2000c("Dish", "in memory");
    let action = dish.connection.variant().actions.iter().find(|action| action.moves).unwrap();
    let act = Act { action: action.key, values: Values::default() };
    for size in rig::sizes() {
        let mut model = shows(states::holding());
        model.shown_mut().antennas = vec![rig::antenna(dish.clone(), states::holding())];
        assert!(rig::window(size, model).query_by_label(UNSEEN).is_none());
        let mut model = shows(states::holding());
        model.shown_mut().antennas = vec![rig::antenna(dish.clone(), states::holding())];
        model.shown_mut().antennas[0].asks_unseen = Some(act.clone());
        let mut window = rig::window(size, model);
        assert!(says(&window, action.description));
        window.get_by_label(UNSEEN).click();
        assert_eq!(asked(&mut window), [], "a click is no hold");
        hold(&mut window, UNSEEN);
        let wanted = [UiCommand::antenna(AntennaId(1), Command::ActUnseen(act.clone()))];
        assert_eq!(asked(&mut window), wanted);
    }
}
