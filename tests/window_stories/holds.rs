//! What the operator answers for by a hold.

use azel::{
    app::{Model, UiCommand},
    driver::{Command, Intent, Snapshot, StopState},
};
use egui_kittest::kittest::Queryable as _;

use crate::{
    rig::{self, LARGE, SIZES, asked, says},
    settings_desk::hold,
    states,
};

const STANDS: &str = "Hold 1 s: I have seen that it stands";
const UNGUARDED: &str = "Hold 1 s to move without dead-man";

fn shows(snapshot: Snapshot) -> Model {
    let mut model = rig::model(states::holding());
    model.antennas = vec![rig::antenna(model.station.antennas[0].clone(), snapshot)];
    model
}

#[test]
fn a_jog_without_a_dead_man_is_allowed_by_holding_only() {
    let unguarded = || Snapshot { intent: Intent::Manual, unguarded: true, ..states::holding() };
    // Nothing is asked before a jog was refused for it, or once there is one.
    for (snapshot, is_refused) in
        [(unguarded(), false), (Snapshot { unguarded: false, ..unguarded() }, true)]
    {
        let mut model = shows(snapshot);
        model.antennas[0].asks_unguarded = is_refused;
        assert!(rig::window(LARGE, model).query_by_label(UNGUARDED).is_none());
    }
    let mut model = shows(unguarded());
    model.antennas[0].asks_unguarded = true;
    let mut window = rig::window(LARGE, model);
    assert!(says(&window, "nothing would stop the antenna"));
    window.get_by_label(UNGUARDED).click();
    assert_eq!(asked(&mut window), [], "a click is no hold");
    hold(&mut window, UNGUARDED);
    assert_eq!(asked(&mut window), [UiCommand::Antenna(0, Command::AllowUnguarded)]);
}

#[test]
fn who_sees_an_antenna_stand_says_so_by_holding() {
    for size in SIZES {
        let since = states::moving().state.measured.unwrap().received;
        let not_confirmed =
            Snapshot { stop: StopState::NotConfirmed { since }, ..states::moving() };
        let left = Snapshot { left_moving: Some(rig::now()), ..states::holding() };
        for (snapshot, why) in [
            (not_confirmed, "STOP is repeated until it is known to stand."),
            (left, "Azel ended at 11:15:30Z while it was moved."),
        ] {
            let mut window = rig::window(size, shows(snapshot));
            assert!(says(&window, why), "{why}");
            window.get_by_label(STANDS).click();
            assert_eq!(asked(&mut window), [], "a click is no hold");
            hold(&mut window, STANDS);
            let wanted = [UiCommand::Antenna(0, Command::SeenStanding)];
            assert_eq!(asked(&mut window), wanted, "{why}");
        }
        let window = rig::window(size, rig::model(states::moving()));
        assert!(window.query_by_label(STANDS).is_none());
    }
}
