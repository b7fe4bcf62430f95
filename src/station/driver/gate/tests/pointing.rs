//! Tests of a pointing model: both the axis readings and the beam must stay outside barriers.

use super::*;
use crate::{astro::PointingModel, plan::Barrier, station::Entered};

/// Difference between the azimuth axis and the direction of the beam, degrees.
const OFFSET_DEG: f64 = 4.0;

/// Returns an azimuth and elevation antenna at this azimuth and 30 degrees of elevation. A mast
/// stands between 100 and 120 degrees.
fn case_at(azimuth_deg: f64, intent: Intent) -> Case {
    let mut case = Case::new(intent);
    case.antenna.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 360.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    case.antenna.beam_width_deg = 0.0;
    case.antenna.pointing_model.azimuth_offset_deg = OFFSET_DEG;
    let corners_deg = [(100.0, 0.0), (120.0, 0.0), (120.0, 60.0), (100.0, 60.0)];
    case.keep_outs = vec![KeepOut {
        name: "mast".to_owned(),
        reason: String::new(),
        entered: Entered::Hard,
        antenna: None,
        margin_deg: 0.0,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    }];
    let measured = case.state.measured.as_mut().unwrap();
    measured.pointing = AzEl::from_degrees(azimuth_deg, 30.0).into();
    for (axis, deg) in measured.axes.iter_mut().zip([azimuth_deg, 30.0]) {
        axis.angle_deg = Some(deg);
    }
    case
}

/// Removes the model from the antenna.
fn plain(case: Case) -> Case {
    let mut case = case;
    case.antenna.pointing_model = PointingModel::default();
    case
}

/// Checks that the mast forbids `motion` from `azimuth_deg`, but not without a model.
fn assert_only_the_beam_enters(azimuth_deg: f64, intent: Intent, motion: Motion) {
    let Err(Refusal::Forbidden { barrier, direction }) = case_at(azimuth_deg, intent).ask(motion)
    else {
        panic!("{motion:?} from {azimuth_deg} is allowed");
    };
    assert_eq!(barrier, Barrier::KeepOut("mast".into()));
    assert!((99.9..120.1).contains(&direction.azimuth_deg()), "{direction:?}");
    assert_eq!(plain(case_at(azimuth_deg, intent)).ask(motion), Ok(()), "{motion:?}");
}

#[test]
fn a_motion_whose_beam_enters_is_refused_though_the_axes_stay_outside() {
    for (intent, motion) in [
        (Intent::Position, position(123.0, None)),
        (Intent::Park, position(123.0, 40.0)),
        (Intent::Track, position(123.0, 30.0)),
        (Intent::Manual, step(-3.0, 0.0)),
    ] {
        assert_only_the_beam_enters(126.0, intent, motion);
    }
    // The antenna would continue for 0.4 s.
    assert_only_the_beam_enters(124.3, Intent::Manual, jog(-1.0, 0.0));
}

#[test]
fn a_motion_whose_axes_enter_is_refused_though_the_beam_stays_outside() {
    for case in [case_at(90.0, Intent::Position), plain(case_at(90.0, Intent::Position))] {
        let refused = case.ask(position(102.0, None));
        assert!(matches!(refused, Err(Refusal::Forbidden { .. })), "{refused:?}");
    }
}

/// A lean to the east lowers the beam in the east and raises it in the west.
#[test]
fn a_long_slew_is_judged_with_the_model_of_each_place() {
    let slew = |zone_deg: [f64; 2]| {
        let mut case = case_at(80.0, Intent::Position);
        case.antenna.pointing_model =
            PointingModel { tilt_east_deg: 5.0, ..PointingModel::default() };
        let [low_deg, high_deg] = zone_deg;
        let corners_deg =
            [(265.0, low_deg), (275.0, low_deg), (275.0, high_deg), (265.0, high_deg)];
        case.keep_outs[0].zone = KeepOut::zone_of(&corners_deg).unwrap();
        let refused =
            |case: &Case| matches!(case.ask(position(270.0, None)), Err(Refusal::Forbidden { .. }));
        [refused(&case), refused(&plain(case))]
    };
    assert_eq!(slew([33.0, 37.0]), [true, false], "higher in the west");
    assert_eq!(slew([23.0, 27.0]), [false, false], "lower in the east alone");
}

#[test]
fn the_beam_gets_out_by_hand_with_permission() {
    // The axes stand outside, but the beam is 1 degree inside.
    let case = case_at(123.0, Intent::Manual);
    let mut gate = case.gate(&Arc::default());
    let now = case.now();
    let mast = Barrier::KeepOut("mast".into());
    let (out, deeper) = (jog(0.5, 0.0), jog(-0.5, 0.0));
    assert_eq!(gate.check(out, Intent::Manual, now), Err(Refusal::Inside(mast)));
    gate.permit_exit(Some(now.steady + Duration::from_mins(1)));
    assert_eq!(gate.check(out, Intent::Manual, now), Ok(()));
    let refused = gate.check(deeper, Intent::Manual, now);
    assert!(matches!(refused, Err(Refusal::Forbidden { .. })), "{refused:?}");
    let to_position = gate.check(position(140.0, None), Intent::Position, now);
    assert!(matches!(to_position, Err(Refusal::Forbidden { .. })), "only by hand");
}

#[test]
fn the_axes_get_out_by_hand_where_only_they_are_inside() {
    let case = case_at(103.0, Intent::Manual);
    let mut gate = case.gate(&Arc::default());
    let now = case.now();
    gate.permit_exit(Some(now.steady + Duration::from_mins(1)));
    assert_eq!(gate.check(jog(-0.5, 0.0), Intent::Manual, now), Ok(()));
    // The beam would enter the mast.
    let refused = gate.check(jog(0.5, 0.0), Intent::Manual, now);
    assert!(matches!(refused, Err(Refusal::Forbidden { .. })), "{refused:?}");
}
