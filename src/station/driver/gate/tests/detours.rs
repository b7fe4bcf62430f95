//! Tests of the detour of a program track, which a worker searches for outside the gate.

use super::*;
use crate::{
    driver::gate::{NoRoute, Route},
    station::Entered,
};

/// Returns an antenna at 20 degrees of elevation beside a mast between 100 and 120 degrees. The
/// mast blocks the direct path to the other side and both paths that turn one axis after the other.
fn mast_case() -> Case {
    let mut case = Case::new(Intent::Track);
    case.antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 360.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    let corners_deg = [(100.0, 0.0), (120.0, 0.0), (120.0, 40.0), (100.0, 40.0)];
    case.keep_outs = vec![KeepOut {
        name: "mast".to_owned(),
        reason: String::new(),
        entered: Entered::GoRound,
        antenna: None,
        margin_deg: 1.0,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    }];
    let measured = case.state.measured.as_mut().unwrap();
    measured.pointing = AzEl::from_degrees(80.0, 20.0).into();
    for (axis, deg) in measured.axes.iter_mut().zip([80.0, 20.0]) {
        axis.angle_deg = Some(deg);
    }
    case
}

fn open(routed: Result<Route, NoRoute>) -> Option<Box<DetourQuestion>> {
    match routed {
        Err(NoRoute::Open(question)) => Some(question),
        Ok(_) | Err(NoRoute::Refused(_)) => None,
    }
}

#[test]
fn there_is_no_route_until_a_detour_has_been_looked_for_and_it_grows_old() {
    let case = mast_case();
    let mut gate = case.gate(&Arc::default());
    let now = case.now();
    let motion = position(140.0, 20.0);
    let question = open(gate.route(motion, Intent::Track, now)).expect("nobody has looked");
    gate.take_detour(question.search());
    let route = gate.route(motion, Intent::Track, now).unwrap();
    assert_eq!(route.second, Some(motion));
    assert_eq!(gate.check(route.first, Intent::Track, now), Ok(()));
    let Motion::Position { elevation: Some(elevation), .. } = route.first else { panic!() };
    assert!(elevation.degrees() > 20.0, "it leads over the mast: {elevation:?}");
    // The track advances slowly.
    assert!(gate.route(position(141.0, 20.5), Intent::Track, now).is_ok());
    assert!(open(gate.route(position(150.0, 20.0), Intent::Track, now)).is_some(), "another end");
    let later = Moment { steady: now.steady + Duration::from_secs(3), ..now };
    assert!(open(gate.route(motion, Intent::Track, later)).is_some(), "old");
}

#[test]
fn a_detour_within_other_bounds_is_looked_for_anew() {
    let case = mast_case();
    let mut gate = case.gate(&Arc::default());
    let (now, motion) = (case.now(), position(140.0, 20.0));
    let question = open(gate.route(motion, Intent::Track, now)).expect("nobody has looked");
    gate.take_detour(question.search());
    let keep_outs =
        case.keep_outs.iter().map(|keep_out| KeepOut { margin_deg: 3.0, ..keep_out.clone() });
    let wider = Station { keep_outs: keep_outs.collect(), ..Station::default() };
    gate.keep_within(Bounds::new(&wider, &case.antenna));
    assert!(open(gate.route(motion, Intent::Track, now)).is_some());
}

/// Only program track can follow a detour.
#[test]
fn a_slew_has_no_detour() {
    let case = mast_case();
    let gate = case.gate(&Arc::default());
    let routed = gate.route(position(140.0, 20.0), Intent::Position, case.now());
    assert!(matches!(routed, Err(NoRoute::Refused(Refusal::Forbidden { .. }))), "{routed:?}");
}

/// The axes have turned further since the last reading, and continue until the unit obeys.
#[test]
fn a_motion_begins_wherever_the_last_one_has_led_by_then() {
    let mut case = mast_case();
    let measured = case.state.measured.as_mut().unwrap();
    measured.pointing = AzEl::from_degrees(130.0, 45.0).into();
    for (axis, deg) in measured.axes.iter_mut().zip([130.0, 45.0]) {
        axis.angle_deg = Some(deg);
    }
    let started_s = |ago_s: f64| {
        let mut gate = case.gate(&Arc::default());
        let now = case.now();
        assert_eq!(gate.start(position(130.0, 10.0), Intent::Track, false, now), Ok(()));
        let later = Duration::try_from_secs_f64(ago_s).unwrap();
        let now = Moment { steady: now.steady + later, ..now };
        let over_the_mast = position(80.0, 45.0);
        let answer = gate.check(over_the_mast, Intent::Track, now);
        gate.note_halt();
        assert_eq!(gate.check(over_the_mast, Intent::Track, now), Ok(()), "it stands");
        answer
    };
    assert_eq!(started_s(0.0), Ok(()));
    assert!(matches!(started_s(0.9), Err(Refusal::Forbidden { .. })));
}
