use proptest::prelude::*;

use super::*;

fn deg(degrees: f64) -> Angle {
    Angle::from_degrees(degrees)
}

fn from_steps(steps: &[Offset]) -> TrackOffsets {
    steps.iter().copied().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap()
}

/// Returns the motion of a target that rises straight up.
fn upwards(direction: AzEl) -> DVec3 {
    direction.displaced(0.0, 90.0).to_enu()
}

fn is_near(a: AzEl, b: AzEl) -> bool {
    a.separation(b).degrees() < 1e-9
}

#[test]
fn without_offsets_a_direction_stays_as_it_is_to_the_bit() {
    let direction = AzEl::from_degrees(123.456_789, 7.654_321);
    assert_eq!(TrackOffsets::NONE.added_to(direction, Some(upwards(direction))), direction);
    assert!(TrackOffsets::default().is_none());
}

#[test]
fn along_is_ahead_and_across_is_to_the_right() {
    let north = AzEl::from_degrees(0.0, 0.0);
    let shifted = |step: Offset| from_steps(&[step]).added_to(north, Some(upwards(north)));
    assert!(is_near(shifted(Offset::Along(deg(2.0))), AzEl::from_degrees(0.0, 2.0)));
    assert!(is_near(shifted(Offset::Across(deg(2.0))), AzEl::from_degrees(2.0, 0.0)));
    assert!(is_near(shifted(Offset::Across(deg(-2.0))), AzEl::from_degrees(358.0, 0.0)));
}

#[test]
fn across_at_the_zenith_is_the_whole_angle() {
    let zenith = AzEl::from_degrees(0.0, 90.0);
    // The target comes from the north, so east is to the right of an observer who faces it.
    let south = Some(DVec3::NEG_Y);
    let found = from_steps(&[Offset::Across(deg(0.5))]).added_to(zenith, south);
    assert!((found.separation(zenith).degrees() - 0.5).abs() < 1e-9);
    assert!(is_near(found, AzEl::from_degrees(90.0, 89.5)), "{found:?}");
    let near = AzEl::from_degrees(180.0, 89.9);
    let found = from_steps(&[Offset::Across(deg(0.5))]).added_to(near, south);
    assert!((found.separation(near).degrees() - 0.5).abs() < 1e-9, "where azimuth means little");
}

#[test]
fn a_target_that_stands_has_nothing_along_and_across() {
    let direction = AzEl::from_degrees(10.0, 20.0);
    let track_offsets = from_steps(&[Offset::Along(deg(1.0)), Offset::Across(deg(1.0))]);
    assert_eq!(track_offsets.added_to(direction, None), direction);
    assert_eq!(track_offsets.added_to(direction, Some(DVec3::ZERO)), direction);
    assert_eq!(
        track_offsets.added_to(direction, Some(direction.to_enu())),
        direction,
        "it comes straight on"
    );
}

#[test]
fn azimuth_wraps_and_elevation_goes_over_the_zenith() {
    let axis_offsets = from_steps(&[Offset::Azimuth(deg(2.0)), Offset::Elevation(deg(3.0))]);
    let wrapped = axis_offsets.added_to(AzEl::from_degrees(359.0, 10.0), None);
    assert!(is_near(wrapped, AzEl::from_degrees(1.0, 13.0)) && wrapped.azimuth_deg() < 2.0);
    let flipped = axis_offsets.added_to(AzEl::from_degrees(10.0, 88.0), None);
    assert!(is_near(flipped, AzEl::from_degrees(192.0, 89.0)), "{flipped:?}");
    assert!(flipped.elevation_deg() <= 90.0);
}

#[test]
fn steps_to_and_fro_leave_nothing() {
    let step = Offset::Azimuth(deg(0.1));
    let mut offsets = TrackOffsets::NONE;
    for _ in 0..3 {
        offsets = offsets.plus(step).unwrap();
    }
    assert_eq!(offsets, from_steps(&[Offset::Azimuth(deg(0.3))]));
    for _ in 0..3 {
        offsets = offsets.plus(-step).unwrap();
    }
    assert!(offsets.is_none());
    let time = Offset::Time(SignedDuration::from_millis(100));
    assert!(from_steps(&[time, -time]).is_none());
}

#[test]
fn an_offset_that_is_too_large_or_no_number_is_none() {
    let largest =
        from_steps(&[Offset::Elevation(-MAX_ANGLE_OFFSET), Offset::Time(MAX_TIME_OFFSET)]);
    for step in [
        Offset::Elevation(deg(-0.1)),
        Offset::Time(SignedDuration::from_millis(1)),
        Offset::Time(SignedDuration::MAX),
        Offset::Azimuth(deg(10.1)),
        Offset::Along(deg(f64::NAN)),
        Offset::Across(deg(f64::INFINITY)),
    ] {
        assert_eq!(largest.plus(step), None, "{step:?}");
    }
    assert_eq!(TrackOffsets::NONE.plus(Offset::Time(SignedDuration::MIN)), None);
}

#[test]
fn the_time_moves_the_target_and_not_the_direction() {
    let noon: Timestamp = "2026-08-12T12:00:00Z".parse().unwrap();
    let late = from_steps(&[Offset::Time(SignedDuration::from_millis(-300))]);
    assert_eq!(late.time_of(noon), "2026-08-12T11:59:59.7Z".parse().unwrap());
    let direction = AzEl::from_degrees(10.0, 20.0);
    assert_eq!(late.added_to(direction, Some(upwards(direction))), direction);
}

#[test]
fn only_offsets_of_the_axes_are_left_out_on_the_sky() {
    let all = from_steps(&[
        Offset::Along(deg(1.0)),
        Offset::Azimuth(deg(1.0)),
        Offset::Elevation(deg(1.0)),
    ]);
    assert_eq!(all.on_the_sky(), from_steps(&[Offset::Along(deg(1.0))]));
}

#[test]
fn they_come_back_from_a_file_and_too_large_ones_do_not() {
    let all = from_steps(&[
        Offset::Time(SignedDuration::from_millis(-1100)),
        Offset::Along(deg(0.3)),
        Offset::Across(deg(-0.2)),
        Offset::Azimuth(deg(9.999)),
        Offset::Elevation(deg(-0.001)),
    ]);
    let written = serde_json::to_string(&all).unwrap();
    assert_eq!(serde_json::from_str::<TrackOffsets>(&written).unwrap(), all, "{written}");
    let too_large = written.replace("-1.1", "-301.0");
    assert!(serde_json::from_str::<TrackOffsets>(&too_large).is_err(), "{too_large}");
}

proptest! {
    /// Offsets along and across lead away by their angles, for any target and motion.
    #[test]
    fn offsets_lead_away_by_their_angle(
        azimuth in 0.0..360.0, elevation in -5.0..90.0, bearing in 0.0..360.0,
        thousandths in -10_000_i32..10_000,
    ) {
        let direction = AzEl::from_degrees(azimuth, elevation);
        let way = Some(direction.displaced(bearing, 90.0).to_enu());
        let angle = deg(f64::from(thousandths) / 1000.0);
        let [ahead, right] = [Offset::Along(angle), Offset::Across(angle)]
            .map(|step| from_steps(&[step]).added_to(direction, way));
        for end in [ahead, right] {
            prop_assert!((direction.separation(end).degrees() - angle.degrees().abs()).abs() < 1e-8);
            prop_assert!((-90.0..=90.0).contains(&end.elevation_deg()));
        }
        prop_assert!(ahead.separation(direction.displaced(bearing, angle.degrees())).degrees() < 1e-8);
        prop_assert!(right.separation(direction.displaced(bearing + 90.0, angle.degrees())).degrees() < 1e-8);
    }

    /// A step back undoes a step, in any order.
    #[test]
    fn any_steps_are_undone_by_their_opposites(steps in proptest::collection::vec((0..5_usize, -50_i32..50), 0..20)) {
        let step = |(kind, tenths): &(usize, i32)| {
            let angle = deg(f64::from(*tenths) / 10.0);
            [
                Offset::Time(SignedDuration::from_millis(i64::from(*tenths) * 100)),
                Offset::Along(angle),
                Offset::Across(angle),
                Offset::Azimuth(angle),
                Offset::Elevation(angle),
            ][*kind]
        };
        let outward = steps.iter().map(step).try_fold(TrackOffsets::NONE, TrackOffsets::plus);
        if let Some(track_offsets) = outward {
            let back = steps.iter().map(|pair| -step(pair)).try_fold(track_offsets, TrackOffsets::plus);
            prop_assert!(back.is_none_or(TrackOffsets::is_none));
        }
    }
}
