use proptest::prelude::*;

use super::*;

fn elevation_deg(mask: &HorizonMask, azimuth_deg: f64) -> f64 {
    mask.elevation_at(Angle::from_degrees(azimuth_deg)).degrees()
}

#[test]
fn the_line_runs_straight_between_points_and_around_north() {
    let mask = HorizonMask::from_degrees([(350.0, 8.0), (10.0, 4.0), (100.0, -2.0)]).unwrap();
    for (azimuth_deg, expected) in [
        (10.0, 4.0),
        (55.0, 1.0),
        (100.0, -2.0),
        (225.0, 3.0),
        (350.0, 8.0),
        (0.0, 6.0),
        (360.0, 6.0),
        (-5.0, 7.0),
        (725.0, 5.0),
    ] {
        let found = elevation_deg(&mask, azimuth_deg);
        assert!((found - expected).abs() < 1e-9, "{azimuth_deg}: {found}");
    }
    assert!((mask.highest().degrees() - 8.0).abs() < 1e-12);
    assert!((mask.lowest().degrees() + 2.0).abs() < 1e-12);
}

#[test]
fn one_point_makes_a_level_horizon() {
    for azimuth in ["0", "77.7", "360"] {
        let mask = HorizonMask::parse(&format!("{azimuth} 5")).unwrap();
        for azimuth_deg in [0.0, 77.7, 200.0, 359.9] {
            assert!((elevation_deg(&mask, azimuth_deg) - 5.0).abs() < 1e-12);
        }
    }
}

#[test]
fn texts_of_every_dialect_are_read() {
    let expected = HorizonMask::from_degrees([(0.0, 1.5), (90.0, -2.0), (180.5, 3.0)]).unwrap();
    for text in [
        "0 1.5\n90 -2\n180.5 3\n",
        "\u{feff}# north first\r\n180.5\t3\r\n\r\n90;-2 # dip\r\n0,1.5",
        "  90 , -2\n0  1.5\n 180.5 ;3 \n360 1.5",
    ] {
        assert_eq!(HorizonMask::parse(text), Ok(expected.clone()), "{text:?}");
    }
}

/// Returns the elevations left and right of an azimuth where a mask has a wall.
fn sides(text: &str, azimuth_deg: f64) -> (f64, f64) {
    let mask = HorizonMask::parse(text).unwrap();
    (elevation_deg(&mask, azimuth_deg - 0.002), elevation_deg(&mask, azimuth_deg + 0.002))
}

#[test]
fn an_azimuth_on_two_lines_is_a_wall() {
    let wall = "0 10\n90 5\n180 5\n180 20\n200 20\n200 5";
    let turned: String = wall.lines().rev().flat_map(|line| [line, "\n"]).collect();
    let west = wall.replace("200", "-160");
    for text in [wall, &turned, &west] {
        for (azimuth_deg, expected) in [(180.0, (5.0, 20.0)), (200.0, (20.0, 5.0))] {
            let (left, right) = sides(text, azimuth_deg);
            assert!((left - expected.0).abs() < 0.01, "{text}: {left}");
            assert!((right - expected.1).abs() < 0.01, "{text}: {right}");
        }
    }
    for (text, azimuth_deg, expected) in [
        ("0 10\n90 5\n270 5\n360 10.2", 0.0, (10.2, 10.0)),
        ("360 10.2\n270 5\n90 5\n0 10", 0.0, (10.2, 10.0)),
        ("-180 3\n-90 5\n0 10\n90 5\n180 8", 180.0, (8.0, 3.0)),
    ] {
        let (left, right) = sides(text, azimuth_deg);
        assert!((left - expected.0).abs() < 0.01, "{text}: {left}");
        assert!((right - expected.1).abs() < 0.01, "{text}: {right}");
    }
}

#[test]
fn a_point_that_is_given_again_counts_once() {
    let expected = HorizonMask::parse("0 1\n90 2").unwrap();
    for text in ["0 1\n-0 1\n90 2", "0 1\n90 2\n360 1", "0 1\n90 2\n0 1"] {
        assert_eq!(HorizonMask::parse(text), Ok(expected.clone()), "{text}");
    }
}

#[test]
fn what_is_no_mask_is_refused_with_its_line() {
    let point = |line, reason| MaskImportError::Point { line, reason };
    for (text, expected) in [
        ("", MaskImportError::Empty),
        ("# nothing\n", MaskImportError::Empty),
        ("azimuth elevation", MaskImportError::Column { line: 1, column: "azimuth" }),
        ("0 1\n\n5", MaskImportError::Format { line: 3 }),
        ("0 1 2", MaskImportError::Format { line: 1 }),
        ("0,,5", MaskImportError::Format { line: 1 }),
        ("0 1\n361 2", point(2, MaskError::Azimuth(361.0))),
        ("-181 2", point(1, MaskError::Azimuth(-181.0))),
        ("0 91", point(1, MaskError::Elevation(91.0))),
        ("az,el\n0,inf", point(2, MaskError::Elevation(f64::INFINITY))),
        ("5 1\n7 1\n5 2", point(3, MaskError::Duplicate(5.0))),
        ("0 1\n0 2\n0 3", point(3, MaskError::Duplicate(0.0))),
        ("0 1\n0 2\n360 3", point(2, MaskError::Duplicate(0.0))),
    ] {
        assert_eq!(HorizonMask::parse(text), Err(expected), "{text:?}");
    }
    assert!(matches!(
        HorizonMask::parse("az,el\nnan,1"),
        Err(MaskImportError::Point { line: 2, reason: MaskError::Azimuth(_) })
    ));
    let long = (0..=MAX_MASK_POINTS).map(|index| (index as f64 * 0.01, 0.0));
    assert_eq!(HorizonMask::from_degrees(long), Err(MaskError::TooManyPoints));
}

proptest! {
    #[test]
    fn any_text_gives_a_mask_or_a_reason_and_any_mask_survives_its_text(text in "[0-9 .,;#\t\n-]*") {
        if let Ok(mask) = HorizonMask::parse(&text) {
            prop_assert_eq!(HorizonMask::parse(&mask.to_string()), Ok(mask));
        }
    }

    #[test]
    fn the_line_stays_between_its_points(
        points in prop::collection::btree_map(0_u16..3600, -90.0..90.0_f64, 1..40),
        azimuth_deg in -720.0..720.0_f64,
    ) {
        let points: Vec<_> =
            points.into_iter().map(|(tenth, el)| (f64::from(tenth) / 10.0, el)).collect();
        let mask = HorizonMask::from_degrees(points.clone()).unwrap();
        let lowest = points.iter().map(|(_, el)| *el).fold(90.0, f64::min);
        let found = elevation_deg(&mask, azimuth_deg);
        prop_assert!(found >= lowest - 1e-9 && found <= mask.highest().degrees() + 1e-9);
        prop_assert_eq!(HorizonMask::parse(&mask.to_string()), Ok(mask));
    }
}
