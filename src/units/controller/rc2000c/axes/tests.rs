use super::*;
use crate::{
    device::CountPoint,
    protocol::rc2000c::{Address, Decoder, Reply},
};

/// Status of an idle unit at 1525 and 750 counts.
pub(in super::super) const IDLE: &[u8] = b"\x06\x32\x31SBS 6       1525  75039      #@;S\x03\x42";

pub(in super::super) fn status(bytes: &[u8]) -> Status {
    let mut decoder = Decoder::new(Address::FACTORY);
    decoder.push(bytes);
    let frame = decoder.next().unwrap().unwrap();
    let Ok(Reply::Status { status, .. }) = Reply::parse(&frame) else { panic!("{frame:?}") };
    status
}

fn points(pairs: [(u16, f64); 2]) -> Vec<CountPoint> {
    pairs.map(|(counts, degrees)| CountPoint { counts, degrees }).to_vec()
}

fn mount(elevation_to_deg: f64) -> Mount {
    Mount::AzEl {
        azimuth_from_deg: 90.0,
        azimuth_to_deg: 540.0,
        elevation_from_deg: 0.0,
        elevation_to_deg,
    }
}

/// Returns axes with twenty counts a degree.
fn calibrated() -> Axes {
    Axes::new(&Calibration {
        azimuth: points([(30, 90.0), (9030, 540.0)]),
        elevation: points([(30, 0.0), (1830, 90.0)]),
    })
}

/// Returns axes for a site south of the equator: the counts grow westwards through north.
fn reversed() -> Axes {
    Axes::new(&Calibration {
        azimuth: points([(30, 450.0), (3630, 270.0)]),
        elevation: points([(30, 0.0), (1830, 90.0)]),
    })
}

#[test]
fn counts_are_angles_once_they_are_calibrated() {
    let status = status(IDLE);
    let [azimuth, elevation] = calibrated().read(&status, None);
    assert_eq!(azimuth.angle_deg.map(f64::round), Some(165.0));
    assert_eq!(elevation.angle_deg, Some(36.0));
    let unknown = Axes::new(&Calibration::default());
    let axes = unknown.read(&status, None);
    assert_eq!(axes.map(|axis| axis.angle_deg), [None, None]);
    let pointing = Axes::pointing(axes, &mount(90.0));
    assert_eq!(pointing, Pointing { azimuth: None, elevation: None });
}

#[test]
fn beyond_north_the_axis_counts_on_and_the_pointing_does_not() {
    let far = Status { azimuth: Position::Counts(6030), ..status(IDLE) };
    let axes = calibrated().read(&far, None);
    assert_eq!(axes[0].angle_deg, Some(390.0));
    let azimuth = Axes::pointing(axes, &mount(90.0)).azimuth.unwrap();
    assert!((azimuth.degrees() - 30.0).abs() < 1e-9);
}

#[test]
fn over_the_zenith_the_antenna_points_to_the_other_side() {
    let past_zenith = Status { elevation: Position::Counts(2430), ..status(IDLE) };
    let axes = calibrated().read(&past_zenith, None);
    assert_eq!(axes[1].angle_deg, Some(120.0));
    let direction = Axes::pointing(axes, &mount(180.0)).direction().unwrap();
    let [azimuth, _] = axes;
    let other_side = (azimuth.angle_deg.unwrap() + 180.0).rem_euclid(360.0);
    assert!((direction.azimuth_deg() - other_side).abs() < 1e-9);
    assert!((direction.elevation_deg() - 60.0).abs() < 1e-9);
    let noise = Status { elevation: Position::Counts(1831), ..status(IDLE) };
    let axes = calibrated().read(&noise, None);
    let direction = Axes::pointing(axes, &mount(90.0)).direction().unwrap();
    assert!((direction.azimuth_deg() - axes[0].angle_deg.unwrap()).abs() < 1e-9);
}

#[test]
fn shown_angles_are_taken_without_a_calibration_but_make_no_counts() {
    let shown = Status {
        azimuth: Position::TenthsOfDegree(1784),
        elevation: Position::TenthsOfDegree(-3),
        ..status(IDLE)
    };
    let unknown = Axes::new(&Calibration::default());
    let axes = unknown.read(&shown, None);
    assert_eq!(axes.map(|axis| axis.angle_deg), [Some(178.4), Some(-0.3)]);
    let angle = Some(Angle::from_degrees(180.0));
    let refused = unknown.counts(angle, angle, Some(&shown), &mount(90.0)).unwrap_err();
    assert_eq!(refused, "the azimuth is not calibrated");
    let refused = calibrated().counts(angle, None, Some(&shown), &mount(90.0)).unwrap_err();
    assert!(refused.contains("elevation") && refused.contains("not known"), "{refused}");
}

#[test]
fn a_shown_azimuth_has_no_angle_until_its_turn_is_known() {
    let mut mount = mount(90.0);
    if let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = &mut mount {
        (*azimuth_from_deg, *azimuth_to_deg) = (0.0, 450.0);
    }
    let nowhere = Axis { angle_deg: None, ..calibrated().read(&status(IDLE), None)[0] };
    let axis_at = |angle_deg| Axis { angle_deg: Some(angle_deg), ..nowhere };
    let lower_end = Axis { minus_limit: true, ..nowhere };
    let upper_end = Axis { plus_limit: true, ..nowhere };
    for (tenths, before, expected_deg) in [
        // Only one turn of the travel contains the angle.
        (1800, None, Some(180.0)),
        (3585, None, Some(358.5)),
        // Both ends of the travel contain the angle.
        (450, None, None),
        (450, Some(nowhere), None),
        (450, Some(axis_at(44.0)), Some(45.0)),
        (450, Some(axis_at(404.0)), Some(405.0)),
        // The axis passes through north.
        (5, Some(axis_at(359.8)), Some(360.5)),
        (3598, Some(axis_at(360.5)), Some(359.8)),
        (3600, Some(axis_at(0.2)), Some(0.0)),
        // The axis is at the end from which it moves away.
        (3, Some(lower_end), Some(0.3)),
        (895, Some(upper_end), Some(449.5)),
        // The reading has noise, or the axis has overrun its end.
        (3595, Some(axis_at(0.1)), Some(-0.5)),
        (920, Some(axis_at(449.0)), Some(452.0)),
        // The display does not wrap.
        (4000, None, Some(400.0)),
    ] {
        let position = Position::TenthsOfDegree(tenths);
        let shown = Axis { angle_deg: Some(f64::from(tenths) / 10.0), ..nowhere };
        let axis = Axes::unwrapped(shown, position, before.as_ref(), &mount);
        let is_right = match (axis.angle_deg, expected_deg) {
            (Some(deg), Some(expected_deg)) => (deg - expected_deg).abs() < 1e-9,
            (found, expected) => found == expected,
        };
        assert!(is_right, "{tenths} after {before:?}: {:?}", axis.angle_deg);
    }
}

#[test]
fn a_display_that_wraps_at_north_shows_no_turn_of_a_standing_axis() {
    let shown = |tenths| Status { azimuth: Position::TenthsOfDegree(tenths), ..status(IDLE) };
    let motion = |before, after| {
        let [azimuth, _] = calibrated().read(&shown(after), Some(&shown(before)));
        azimuth.motion
    };
    assert_eq!(motion(0, 3599), AxisMotion::Still);
    assert_eq!(motion(3599, 0), AxisMotion::Still);
    assert_eq!(motion(3590, 10), AxisMotion::Plus);
    assert_eq!(motion(10, 3590), AxisMotion::Minus);
    assert_eq!(motion(1000, 1010), AxisMotion::Plus);
}

#[test]
fn an_axis_that_stays_is_sent_to_its_present_counts() {
    let axes = calibrated();
    let angle = |degrees| Some(Angle::from_degrees(degrees));
    let counts = axes.counts(angle(390.0), angle(45.0), None, &mount(90.0)).unwrap();
    assert_eq!(counts, [6030, 930]);
    let one = axes.counts(None, angle(45.0), Some(&status(IDLE)), &mount(90.0)).unwrap();
    assert_eq!(one, [1525, 930]);
    let refusal = axes.counts(angle(88.0), angle(45.0), None, &mount(90.0)).unwrap_err();
    assert!(refusal.contains("no counts"), "{refusal}");
}

#[test]
fn an_axis_that_stays_at_its_limit_is_sent_to_that_end_of_its_travel() {
    let up = Some(Angle::from_degrees(45.0));
    let sent = |axes: Axes, (from_deg, to_deg), end| {
        let at_end = Status { azimuth: Position::Limit(end), ..status(IDLE) };
        let mut mount = mount(90.0);
        if let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = &mut mount {
            (*azimuth_from_deg, *azimuth_to_deg) = (from_deg, to_deg);
        }
        axes.counts(None, up, Some(&at_end), &mount).unwrap()[0]
    };
    let ends = [LimitEnd::CounterClockwise, LimitEnd::Clockwise];
    assert_eq!(ends.map(|end| sent(calibrated(), (90.0, 540.0), end)), [30, 9030]);
    // The counts begin at the counter-clockwise end, whichever way the angle grows.
    assert_eq!(ends.map(|end| sent(reversed(), (270.0, 450.0), end)), [30, 3630]);
}

#[test]
fn an_axis_that_noise_reads_beyond_its_travel_is_sent_to_the_end() {
    let up = Some(Angle::from_degrees(45.0));
    let sent = |counts| {
        let status = Status { azimuth: Position::Counts(counts), ..status(IDLE) };
        calibrated().counts(None, up, Some(&status), &mount(90.0)).unwrap()[0]
    };
    assert_eq!([25, 30, 31, 9030, 9036].map(sent), [30, 30, 31, 9030, 9030]);
    // Azel does not turn an axis that stands far outside.
    assert_eq!([1, 9060].map(sent), [1, 9060]);
}

#[test]
fn limits_lie_at_the_end_where_the_angle_does() {
    let at_end = Status {
        azimuth: Position::Limit(LimitEnd::CounterClockwise),
        elevation: Position::Limit(LimitEnd::Up),
        ..status(IDLE)
    };
    let ends =
        |axes: Axes| axes.read(&at_end, None).map(|axis| (axis.minus_limit, axis.plus_limit));
    assert_eq!(ends(calibrated()), [(true, false), (false, true)]);
    assert_eq!(ends(reversed()), [(false, true), (false, true)]);
}

#[test]
fn a_jog_goes_the_way_in_which_the_angle_grows() {
    let ways = |axes: Axes| {
        [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| axes.direction(x, y))
    };
    let [up, down] = [Direction::Up, Direction::Down];
    let [clockwise, back] = [Direction::Clockwise, Direction::CounterClockwise];
    assert_eq!(ways(calibrated()), [clockwise, back, up, down]);
    assert_eq!(ways(reversed()), [back, clockwise, up, down]);
}

#[test]
fn an_axis_moves_while_its_drive_or_its_number_says_so() {
    let before = status(IDLE);
    let axes = calibrated();
    let motion = |drive, az_counts| {
        let now = Status { azimuth_drive: drive, azimuth: Position::Counts(az_counts), ..before };
        axes.read(&now, Some(&before))[0].motion
    };
    assert_eq!(motion(AxisDrive::Still, 1526), AxisMotion::Still, "one count is no motion");
    assert_eq!(motion(AxisDrive::Still, 1527), AxisMotion::Plus);
    assert_eq!(motion(AxisDrive::Runaway, 1500), AxisMotion::Minus);
    assert_eq!(motion(AxisDrive::Runaway, 1525), AxisMotion::Still, "the alarm stays, not it");
    assert_eq!(motion(AxisDrive::Pending(Sense::Negative), 1525), AxisMotion::Minus);
    assert_eq!(motion(AxisDrive::AutoMove, 1525), AxisMotion::Unknown(7));
    assert_eq!(motion(AxisDrive::AutoMove, 1530), AxisMotion::Plus);
    assert_eq!(motion(AxisDrive::Unknown(0x26), 1525), AxisMotion::Unknown(0x26));
}

#[test]
fn counts_mean_angles_only_where_both_axes_are_calibrated() {
    let [azimuth, elevation] = calibrated().degrees([30, 30]).unwrap();
    assert!((azimuth.unwrap() - 90.0).abs() < 1e-9 && elevation.unwrap().abs() < 1e-9);
    let azimuth =
        vec![CountPoint { counts: 30, degrees: 90.0 }, CountPoint { counts: 3630, degrees: 270.0 }];
    let half = Axes::new(&Calibration { azimuth, ..Calibration::default() });
    assert_eq!(half.degrees([30, 30]), None);
    assert_eq!(Axes::new(&Calibration::default()).degrees([30, 30]), None);
}

#[test]
fn an_elevation_axis_at_its_limit_tells_the_side_and_otherwise_the_azimuth_is_not_known() {
    let axes = |plus_limit, minus_limit| {
        let axis = Axis {
            angle_deg: None,
            motion: AxisMotion::Still,
            drive: Drive::Off,
            plus_limit,
            minus_limit,
        };
        [Axis { angle_deg: Some(167.0), plus_limit: false, minus_limit: false, ..axis }, axis]
    };
    let azimuth_deg = |axes, elevation_to_deg| {
        let pointing = Axes::pointing(axes, &mount(elevation_to_deg));
        assert_eq!(pointing.elevation, None);
        pointing.azimuth.map(Angle::degrees)
    };
    assert_eq!(azimuth_deg(axes(true, false), 180.0), Some(347.0));
    assert_eq!(azimuth_deg(axes(false, true), 180.0), Some(167.0));
    assert_eq!(azimuth_deg(axes(false, false), 180.0), None);
    assert_eq!(azimuth_deg(axes(true, false), 90.0), Some(167.0));
}
