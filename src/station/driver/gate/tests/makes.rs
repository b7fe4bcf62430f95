//! Tests of the differences between the makes.

use super::*;
use crate::{
    controller::rotator_genius::{PAIR, ROTATORS, Rotators, SPEC},
    device::{Capabilities, SecondAxis, Variant},
    station::ControllerSpec,
};

fn new_case(antenna: Antenna, intent: Intent) -> Case {
    let mut case = Case { antenna, ..Case::new(intent) };
    for axis in case.axes() {
        axis.angle_deg = Some(45.0);
    }
    case
}

pub(super) fn genius(intent: Intent) -> Case {
    new_case(Antenna::genius("Mast", ""), intent)
}

pub(super) fn rc2000c(intent: Intent) -> Case {
    new_case(Antenna::rc2000c("Dish", ""), intent)
}

fn single_rotator(intent: Intent) -> Case {
    let mut antenna = Antenna::genius("Mast", "");
    antenna.connection.put(&ROTATORS, Rotators::First).unwrap();
    new_case(antenna, intent)
}

#[test]
fn what_a_controller_cannot_do_is_not_asked_of_it() {
    assert_eq!(genius(Intent::Track).ask(Motion::StartProgram), Err(Refusal::NotOffered));
    assert_eq!(genius(Intent::Track).ask(Motion::EnableAuto), Err(Refusal::NotOffered));
    assert_eq!(genius(Intent::Manual).ask(step(1.0, 0.0)), Err(Refusal::NotOffered));
    let alone = single_rotator(Intent::Position);
    assert_eq!(alone.ask(position(10.0, 20.0)), Err(Refusal::NotOffered), "no elevation axis");
    assert_eq!(alone.ask(position(10.0, None)), Ok(()));
}

#[test]
fn an_axis_that_is_absent_is_not_turned() {
    static AZIMUTH: Variant = Variant {
        capabilities: Capabilities {
            axes: ["Az", ""],
            second_axis: SecondAxis::Absent,
            steps: true,
            ..PAIR.capabilities
        },
        groups: &[],
        actions: &[],
        track_offsets: None,
        clock: None,
    };
    static MAST: ControllerSpec =
        ControllerSpec { variants: &[&AZIMUTH], variant: |_| &AZIMUTH, ..SPEC };
    let mast = new_case(MAST.antenna("Mast", ""), Intent::Manual);
    assert_eq!(mast.ask(jog(1.0, 0.0)), Ok(()));
    assert_eq!(mast.ask(step(1.0, 0.0)), Ok(()));
    assert_eq!(mast.ask(jog(0.0, 1.0)), Err(Refusal::NotOffered));
    assert_eq!(mast.ask(step(0.0, 1.0)), Err(Refusal::NotOffered));
}

#[test]
fn one_axis_at_a_time_where_the_controller_turns_one() {
    for case in [genius(Intent::Manual), rc2000c(Intent::Manual)] {
        assert_eq!(case.ask(jog(1.0, 1.0)), Err(Refusal::OneAxis));
        assert_eq!(case.ask(jog(0.0, -1.0)), Ok(()));
    }
    assert_eq!(Case::new(Intent::Manual).ask(jog(1.0, 1.0)), Ok(()));
}

#[test]
fn an_axis_of_unknown_angle_is_jogged_only_where_the_unit_ends_the_jog() {
    let (mut genius, mut rc2000c) = (genius(Intent::Manual), rc2000c(Intent::Manual));
    for case in [&mut genius, &mut rc2000c] {
        case.axes()[0].angle_deg = None;
    }
    assert_eq!(genius.ask(jog(1.0, 0.0)), Err(Refusal::AngleUnknown { axis: "Az" }));
    assert_eq!(genius.ask(jog(0.0, 1.0)), Ok(()), "the other one is known");
    assert_eq!(rc2000c.ask(jog(1.0, 0.0)), Ok(()));
}

#[test]
fn an_azimuth_axis_has_its_own_ends() {
    let mut case = rc2000c(Intent::Track);
    case.antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 450.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    assert_eq!(case.ask(position(449.0, 30.0)), Ok(()));
    let answer = case.ask(position(451.0, 30.0));
    assert!(matches!(answer, Err(Refusal::Travel { axis: "Az", .. })), "{answer:?}");

    // An axis that stays in place needs no angle.
    case.axes()[0].angle_deg = None;
    assert_eq!(case.ask(position(None, 30.0)), Ok(()));
}

#[test]
fn an_azimuth_of_the_sky_goes_to_the_nearest_position_of_the_axis() {
    let mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 450.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    for (at_deg, asked_deg, wanted_deg) in
        [(350.0, 10.0, 370.0), (20.0, 10.0, 10.0), (440.0, 100.0, 100.0), (440.0, 80.0, 440.0)]
    {
        let mut case = rc2000c(Intent::Position);
        case.axes()[0].angle_deg = Some(at_deg);
        let metal = Metal::new(&case, Arc::default());
        let gate = Gate::new(
            Box::new(metal),
            &case.antenna,
            Bounds::of_antenna(&Antenna { mount, ..case.antenna.clone() }),
            &Default::default(),
        );
        let Ok(Motion::Position { azimuth: Some(axis), .. }) =
            gate.nearest(position(asked_deg, 30.0))
        else {
            panic!("it stays a position")
        };
        assert!((axis.degrees() - wanted_deg).abs() < 1e-9, "{at_deg} {asked_deg}: {axis:?}");
    }
}

#[test]
fn an_action_that_moves_passes_every_rule() {
    let mut case = rc2000c(Intent::Manual);
    let action = "to_counts";
    assert_eq!(case.act(action), Ok(()));
    case.stopping = true;
    assert_eq!(case.act(action), Err(Refusal::Stopping));
    case.stopping = false;
    case.state.motion_lock = Some(true);
    assert_eq!(case.act(action), Err(Refusal::Fault));
}

/// Returns a Genius with an elevation travel to 180 degrees, and its gate. Its axes are flipped:
/// they point to an azimuth of 20 and an elevation of 60 degrees.
fn flipped(intent: Intent) -> (Case, Gate) {
    let mut case = genius(intent);
    if let Mount::AzEl { elevation_to_deg, .. } = &mut case.antenna.mount {
        *elevation_to_deg = 180.0;
    }
    case.antenna.limits.minimum_elevation_deg = 5.0;
    case.axes()[0].angle_deg = Some(200.0);
    case.axes()[1].angle_deg = Some(120.0);
    case.state.measured.as_mut().unwrap().pointing = AzEl::from_degrees(20.0, 60.0).into();
    let metal = Metal::new(&case, Arc::default());
    let gate = Gate::new(
        Box::new(metal),
        &case.antenna,
        Bounds::of_antenna(&case.antenna),
        &Default::default(),
    );
    (case, gate)
}

#[test]
fn over_the_zenith_the_antenna_stays_above_the_lowest_elevation_too() {
    let (case, _) = flipped(Intent::Track);
    for elevation_deg in [5.0, 90.0, 120.0, 175.0] {
        assert_eq!(case.ask(position(45.0, elevation_deg)), Ok(()), "{elevation_deg}");
    }
    for elevation_deg in [4.0, 176.0, 190.0] {
        let refused = case.ask(position(45.0, elevation_deg));
        assert!(matches!(refused, Err(Refusal::Elevation { .. })), "{refused:?}");
    }
    let mut short = case;
    if let Mount::AzEl { elevation_to_deg, .. } = &mut short.antenna.mount {
        *elevation_to_deg = 130.0;
    }
    assert_eq!(short.ask(position(45.0, 130.0)), Ok(()));
    let answer = short.ask(position(45.0, 131.0));
    assert!(matches!(answer, Err(Refusal::Travel { axis: "El", .. })), "{answer:?}");
    let plain = rc2000c(Intent::Track).ask(position(45.0, 120.0));
    assert!(matches!(plain, Err(Refusal::Elevation { .. })), "{plain:?}");
}

#[test]
fn by_hand_the_axes_go_back_to_where_they_count_plainly() {
    let (_, gate) = flipped(Intent::Position);
    let near = |motion: Motion, expected: [Option<f64>; 2]| {
        let Ok(Motion::Position { azimuth, elevation }) = gate.nearest(motion) else { panic!() };
        for (angle, expected) in [azimuth, elevation].into_iter().zip(expected) {
            assert_eq!(angle.map(|angle| angle.degrees().round()), expected, "{motion:?}");
        }
    };
    near(position(30.0, 40.0), [Some(30.0), Some(40.0)]);
    // The angle that the motion leaves out keeps its direction in the sky.
    near(position(30.0, None), [Some(210.0), None]);
    near(position(190.0, None), [Some(10.0), None]);
    near(position(None, 40.0), [None, Some(140.0)]);
    let answer = gate.nearest(position(30.0, 120.0));
    assert!(matches!(answer, Err(Refusal::Elevation { .. })), "{answer:?}");
}

#[test]
fn a_motion_over_the_zenith_ends_on_the_other_side() {
    let (_, gate) = flipped(Intent::Track);
    for (motion, azimuth_deg, elevation_deg) in [
        (position(250.0, 100.0), 70.0, 80.0),
        (position(250.0, 80.0), 250.0, 80.0),
        (position(210.0, None), 30.0, 60.0),
        (position(None, 140.0), 20.0, 40.0),
        (position(None, 40.0), 200.0, 40.0),
    ] {
        let aim = gate.aim(&motion).and_then(Pointing::direction).unwrap();
        let deviation = aim.separation(AzEl::from_degrees(azimuth_deg, elevation_deg));
        assert!(deviation.degrees() < 1e-9, "{motion:?} {aim:?}");
    }
}

#[test]
fn an_axis_without_an_angle_may_come_from_anywhere_in_its_travel() {
    let mut case = each_rule::add_mast(rc2000c(Intent::Position));
    assert_eq!(case.ask(position(60.0, 20.0)), Ok(()));
    case.axes()[0].angle_deg = None;
    assert!(matches!(case.ask(position(60.0, 20.0)), Err(Refusal::Forbidden { .. })));
    case.axes()[1].angle_deg = Some(60.0);
    assert_eq!(case.ask(position(60.0, None)), Ok(()), "over the mast");
    assert!(matches!(case.ask(position(60.0, 20.0)), Err(Refusal::Forbidden { .. })));
}

#[test]
fn an_action_ends_where_it_leads_and_not_where_the_motion_before_did() {
    let mut case = rc2000c(Intent::Position);
    case.leads_to = Lead::To([Some(200.0), Some(45.0)]);
    let mut gate = case.gate(&Arc::default());
    gate.start(position(50.0, 45.0), Intent::Position, false, case.now()).unwrap();
    let first_deg = |gate: &Gate, from_deg: f64| gate.turn_ahead([from_deg, 45.0], [6.0, 0.0])[0];
    assert!((first_deg(&gate, 48.0) - 50.0).abs() < 1e-9);
    let act = Act { action: "to_counts", values: [].into() };
    gate.act(act, false, Intent::Position, false, case.now()).unwrap();
    assert!((first_deg(&gate, 48.0) - 54.0).abs() < 1e-9, "it passes on");
    assert!((first_deg(&gate, 198.0) - 200.0).abs() < 1e-9);
}

#[test]
fn by_hand_it_may_go_along_an_edge_to_where_the_way_out_is_shorter() {
    let zone = |name: &str, margin_deg, corners_deg: [(f64, f64); 4]| KeepOut {
        name: name.to_owned(),
        reason: String::new(),
        entered: crate::station::Entered::Hard,
        antenna: None,
        margin_deg,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    };
    // The antenna stands within the margin below the balcony. The mast is beneath, and left of the
    // mast the way down is free.
    let balcony = [(130.0, 44.0), (195.0, 44.0), (195.0, 80.0), (130.0, 80.0)];
    let mast = [(147.0, -5.0), (204.0, -5.0), (204.0, 30.0), (147.0, 30.0)];
    let mut case = Case {
        antenna: Antenna::genius("Mast", ""),
        keep_outs: vec![zone("balcony", 6.0, balcony), zone("mast", 5.0, mast)],
        ..Case::new(Intent::Manual)
    };
    for (axis, deg) in case.axes().iter_mut().zip([149.0, 40.0]) {
        axis.angle_deg = Some(deg);
    }
    let mut gate = case.gate(&Arc::default());
    let now = case.now();
    gate.permit_exit(Some(now.steady + Duration::from_secs(1)));
    assert_eq!(gate.check(jog(-4.0, 0.0), Intent::Manual, now), Ok(()));
    for motion in [jog(4.0, 0.0), jog(0.0, -4.0)] {
        assert!(gate.check(motion, Intent::Manual, now).is_err(), "{motion:?}");
    }
}

#[test]
fn by_hand_it_leaves_a_keep_out_and_enters_it_nowhere_again() {
    // The keep-out surrounds a yard that is open above 30 degrees.
    let corners_deg = [
        (100.0, 10.0),
        (150.0, 10.0),
        (150.0, 60.0),
        (130.0, 60.0),
        (130.0, 30.0),
        (120.0, 30.0),
        (120.0, 60.0),
        (100.0, 60.0),
    ];
    let yard = KeepOut {
        name: "yard".to_owned(),
        reason: String::new(),
        entered: crate::station::Entered::Hard,
        antenna: None,
        margin_deg: 0.0,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    };
    let mut case = Case { keep_outs: vec![yard], ..changed_mount(Case::new(Intent::Manual)) };
    case.antenna.beam_width_deg = 0.01;
    case.antenna.limits.maximum_step_deg = 30.0;
    for (axis, deg) in case.axes().iter_mut().zip([117.0, 50.0]) {
        axis.angle_deg = Some(deg);
    }
    let mut gate = case.gate(&Arc::default());
    let now = case.now();
    gate.permit_exit(Some(now.steady + Duration::from_secs(1)));
    assert_eq!(gate.check(step(8.0, 0.0), Intent::Manual, now), Ok(()));
    let answer = gate.check(step(14.0, 0.0), Intent::Manual, now);
    assert!(matches!(answer, Err(Refusal::Forbidden { .. })), "{answer:?}");
}

/// Changes the mount to azimuth and elevation.
fn changed_mount(case: Case) -> Case {
    let mount = Antenna::rc2000c("Dish", "").mount;
    Case { antenna: Antenna { mount, ..case.antenna }, ..case }
}

#[test]
fn an_azimuth_alone_is_asked_of_the_other_side_at_the_upper_limit_of_a_mount_that_flips() {
    let mut case = rc2000c(Intent::Position);
    case.antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 450.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 180.0,
    };
    case.axes()[0].angle_deg = Some(170.0);
    let [_, elevation] = case.axes();
    (elevation.angle_deg, elevation.plus_limit) = (None, true);
    let gate = case.gate(&Arc::default());
    let motion = gate.nearest(position(347.0, None)).unwrap();
    assert_eq!(motion, position(167.0, None));
    let aim = gate.aim(&motion).unwrap();
    assert_eq!((aim.azimuth.map(Angle::degrees), aim.elevation), (Some(347.0), None));
}

#[test]
fn an_axis_that_a_program_track_sent_somewhere_is_still_on_its_way_when_the_other_one_is_sent() {
    let case = rc2000c(Intent::Track);
    let started = |intent| {
        let mut gate = case.gate(&Arc::default());
        gate.start(position(60.0, None), intent, false, case.now()).unwrap();
        gate.start(position(None, 70.0), intent, false, case.now()).unwrap();
        gate
    };
    let rounded = |gate: &Gate| gate.sent_to_deg().map(|to_deg| to_deg.map(f64::round));
    let mut gate = started(Intent::Track);
    assert_eq!(rounded(&gate), [Some(60.0), Some(70.0)]);
    gate.note_halt();
    assert_eq!(rounded(&gate), [None; 2]);
    // A motion to a position replaces the previous motion.
    assert_eq!(rounded(&started(Intent::Position)), [None, Some(70.0)]);
}
