use proptest::prelude::*;

use super::*;

fn zone(corners_deg: &[(f64, f64)]) -> Result<Zone, ZoneError> {
    Zone::new(corners_deg.iter().map(|(az, el)| AzEl::from_degrees(*az, *el)).collect())
}

fn clearance_deg(zone: &Zone, azimuth_deg: f64, elevation_deg: f64) -> f64 {
    zone.clearance(AzEl::from_degrees(azimuth_deg, elevation_deg)).degrees()
}

#[track_caller]
fn expect(zone: &Zone, cases: &[(f64, f64, f64)]) {
    for (azimuth_deg, elevation_deg, expected) in cases {
        let found = clearance_deg(zone, *azimuth_deg, *elevation_deg);
        assert!((found - expected).abs() < 1e-9, "{azimuth_deg}, {elevation_deg}: {found}");
    }
}

#[test]
fn a_box_on_the_horizon_is_measured_from_its_nearest_edge() {
    let mast = zone(&[(100.0, 0.0), (100.0, 30.0), (140.0, 30.0), (140.0, 0.0)]).unwrap();
    let over_the_side = |deviation: f64, el: f64| {
        (el.to_radians().cos() * deviation.to_radians().sin()).asin().to_degrees()
    };
    expect(
        &mast,
        &[
            (120.0, 0.0, 0.0),
            (120.0, 10.0, -10.0),
            (120.0, 25.0, -5.0),
            (120.0, 30.0, 0.0),
            (120.0, 45.0, 15.0),
            (120.0, 90.0, 60.0),
            (120.0, -10.0, 10.0),
            (120.0, -90.0, 90.0),
            (105.0, 15.0, -over_the_side(5.0, 15.0)),
            (95.0, 15.0, over_the_side(5.0, 15.0)),
            (-265.0, 15.0, over_the_side(5.0, 15.0)),
        ],
    );
}

#[test]
fn an_edge_of_equal_elevations_is_an_arc_and_any_other_a_great_circle() {
    // The great circle between these corners would rise to 40.9 degrees at azimuth 50.
    let arc = zone(&[(0.0, 0.0), (0.0, 30.0), (100.0, 30.0), (100.0, 0.0)]).unwrap();
    expect(&arc, &[(50.0, 30.0, 0.0), (50.0, 35.0, 5.0)]);
    let circle = zone(&[(0.0, 0.0), (0.0, 30.0), (100.0, 30.001), (100.0, 0.0)]).unwrap();
    assert!(clearance_deg(&circle, 50.0, 40.0) < -1.0);
    let highest = (30_f64.to_radians().tan() / 50_f64.to_radians().cos()).atan().to_degrees();
    assert!(clearance_deg(&circle, 50.0, highest).abs() < 1e-3);
}

#[test]
fn azimuths_go_on_through_north_and_back_again_the_long_way() {
    let north = zone(&[(350.0, 0.0), (350.0, 20.0), (370.0, 20.0), (370.0, 0.0)]).unwrap();
    expect(&north, &[(0.0, 15.0, -5.0), (360.0, 25.0, 5.0), (5.0, 0.0, 0.0)]);
    assert!(clearance_deg(&north, 180.0, 10.0) > 100.0);
    let rest = zone(&[(350.0, 0.0), (350.0, 20.0), (10.0, 20.0), (10.0, 0.0)]).unwrap();
    expect(&rest, &[(180.0, 15.0, -5.0), (180.0, 25.0, 5.0), (100.0, 2.0, -2.0)]);
    assert!(clearance_deg(&rest, 0.0, 10.0) > 5.0);
}

#[test]
fn a_cap_holds_the_zenith() {
    let closed = zone(&[(0.0, 60.0), (120.0, 60.0), (240.0, 60.0), (360.0, 60.0)]).unwrap();
    let cases = [
        (0.0, 90.0, -30.0),
        (200.0, 75.0, -15.0),
        (0.0, 70.0, -10.0),
        (120.0, 50.0, 10.0),
        (0.0, -90.0, 150.0),
    ];
    expect(&closed, &cases);
    let two_halves = zone(&[(10.0, 60.0), (-170.0, 60.0), (-350.0, 60.0)]).unwrap();
    expect(&two_halves, &cases);
    let circles = zone(&[(0.0, 60.0), (90.0, 61.0), (180.0, 60.0), (270.0, 61.0)]).unwrap();
    assert!(clearance_deg(&circles, 0.0, 90.0) < -15.0);
    assert!(clearance_deg(&circles, 45.0, 40.0) > 10.0);
}

#[test]
fn a_corner_at_the_zenith_and_an_edge_over_it_are_no_exception() {
    let wedge = zone(&[(77.0, 90.0), (100.0, 30.0), (140.0, 30.0)]).unwrap();
    expect(&wedge, &[(120.0, 90.0, 0.0), (300.0, 80.0, 10.0), (120.0, 25.0, 5.0)]);
    assert!(clearance_deg(&wedge, 120.0, 60.0) < -5.0);
    assert!(clearance_deg(&wedge, 90.0, 60.0) > 4.0);
    let over_zenith = zone(&[(0.0, 70.0), (180.0, 70.0), (180.0, 80.0)]);
    assert!(over_zenith.is_ok(), "an arc back to where a great circle runs: {over_zenith:?}");
    let half = zone(&[(0.0, 50.0), (180.0, 51.0), (90.0, 50.0)]).unwrap();
    expect(&half, &[(0.0, 90.0, 0.0), (90.0, 80.0, -10.0), (270.0, 80.0, 10.0)]);
}

#[test]
fn what_is_no_zone_is_refused_with_its_reason() {
    use ZoneError as E;
    for (corners, expected) in [
        (&[(0.0, 0.0), (0.0, 9.0)][..], E::TooFewCorners),
        (&[(0.0, 0.0); 101], E::TooManyCorners),
        (&[(0.0, 0.0), (f64::NAN, 9.0), (9.0, 9.0)], E::Azimuth { corner: 2 }),
        (&[(0.0, 0.0), (0.0, 91.0), (9.0, 9.0)], E::Elevation { corner: 2 }),
        (&[(0.0, 0.0), (0.0, 9.0), (9.0, f64::NAN)], E::Elevation { corner: 3 }),
        (&[(0.0, 0.0), (0.0, 9.0), (0.0, 9.0), (9.0, 9.0)], E::NoLength { edge: 2 }),
        (&[(0.0, 0.0), (0.0, 9.0), (9.0, 9.0), (0.0, 0.0)], E::NoLength { edge: 4 }),
        (&[(0.0, 9.0), (370.0, 9.0), (9.0, 19.0)], E::MoreThanATurn { edge: 1 }),
        (&[(0.0, 9.0), (180.0, -9.0), (9.0, 19.0)], E::Opposite { edge: 1 }),
        (&[(0.0, -50.0), (180.0, -51.0), (9.0, 19.0)], E::Nadir { edge: 1 }),
        (&[(0.0, -90.0), (10.0, 0.0), (30.0, 0.0)], E::Nadir { edge: 1 }),
        (
            &[(0.0, 0.0), (10.0, 20.0), (10.0, 0.0), (0.0, 20.0)],
            E::Crossing { first: 1, second: 3 },
        ),
        (
            &[(0.0, 0.0), (0.0, 50.0), (0.0, 20.0), (40.0, 20.0)],
            E::Crossing { first: 1, second: 2 },
        ),
        (&[(0.0, 9.0), (40.0, 9.0), (20.0, 9.0)], E::NoArea),
        (&[(0.0, 60.0), (120.0, 60.0), (240.0, 60.0)], E::NoArea),
        (&[(0.0, 9.0), (0.0, 40.0), (0.0, 20.0)], E::NoArea),
        (&[(0.0, 9.0), (40.0, 19.0), (360.0, 9.0)], E::NoArea),
        // This is a full band with a seam.
        (
            &[(0.0, 0.0), (360.0, 0.0), (360.0, 9.0), (0.0, 9.0)],
            E::Crossing { first: 2, second: 4 },
        ),
        // The arc at 20 degrees lies below the great circle that starts at its end.
        (
            &[(0.0, 10.0), (0.0, 20.0), (100.0, 20.0), (100.0, 21.0), (5.0, 15.0)],
            E::Crossing { first: 2, second: 4 },
        ),
    ] {
        assert_eq!(zone(corners), Err(expected), "{corners:?}");
    }
}

#[test]
fn the_points_of_the_edges_are_close_and_come_around() {
    let mast = zone(&[(350.0, 0.0), (350.0, 20.0), (370.0, 20.0), (370.0, 0.0)]).unwrap();
    let points: Vec<AzEl> = mast.edges_sampled(Angle::from_degrees(1.0)).collect();
    for pair in points.windows(2) {
        assert!(pair[0].separation(pair[1]).degrees() < 1.0 + 1e-9);
    }
    assert_eq!(points.first(), points.last());
    let middle = mast.middle_of_edge(1).unwrap();
    assert!((middle.azimuth.degrees() - 360.0).abs() < 1e-9, "counted on from 350");
    assert!((middle.elevation_deg() - 20.0).abs() < 1e-9);
    assert_eq!(mast.middle_of_edge(4), None);
}

#[test]
fn the_margin_runs_around_at_its_distance() {
    let angle = Angle::from_degrees;
    for corners in [
        &[(350.0, 0.0), (350.0, 20.0), (370.0, 20.0), (370.0, 0.0)][..],
        &[(0.0, 60.0), (120.0, 60.0), (240.0, 60.0), (360.0, 60.0)],
        // The zone is bent inwards at 110 degrees.
        &[(100.0, 0.0), (100.0, 40.0), (110.0, 8.0), (120.0, 40.0), (120.0, 0.0)],
        &[(77.0, 90.0), (100.0, 30.0), (140.0, 30.0)],
    ] {
        let zone = zone(corners).unwrap();
        let points = zone.margin_sampled(angle(3.0), angle(1.0));
        assert!(points.len() > 30, "{}", points.len());
        for point in &points {
            assert!((zone.clearance(*point).degrees() - 3.0).abs() < 1e-3);
        }
        for pair in points.windows(2) {
            assert!(pair[0].separation(pair[1]).degrees() < 2.5, "{pair:?}");
        }
        assert_eq!(zone.margin_sampled(Angle::ZERO, angle(1.0)), []);
    }
}

/// Returns a polygon around `middle`: corners at rising bearings, up to 40 degrees away.
fn star() -> impl Strategy<Value = (AzEl, Vec<AzEl>)> {
    let corner = (0.05..1.0_f64, 2.0..40.0_f64);
    let corners = prop::collection::vec(corner, 3..12);
    (0.0..360.0_f64, -40.0..90.0_f64, corners).prop_map(|(azimuth, elevation, corners)| {
        let middle = AzEl::from_degrees(azimuth, elevation);
        let whole: f64 = corners.iter().map(|(part, _)| part).sum();
        let mut bearing = 0.0;
        let corners = corners.iter().map(|(part, distance)| {
            bearing += part / whole * std::f64::consts::TAU;
            destination(middle, bearing, distance.to_radians())
        });
        (middle, corners.collect())
    })
}

fn destination(middle: AzEl, bearing: f64, distance: f64) -> AzEl {
    let (up, east) = frame(middle);
    let tangent = up * bearing.cos() + east * bearing.sin();
    AzEl::from_enu(middle.to_enu() * distance.cos() + tangent * distance.sin())
}

fn frame(middle: AzEl) -> (DVec3, DVec3) {
    let up = AzEl { elevation: middle.elevation + Angle::from_degrees(90.0), ..middle }.to_enu();
    (up, up.cross(middle.to_enu()))
}

/// Applies the even-odd rule in the plane that touches the sphere at `middle`. Great circles are
/// straight in this plane.
fn is_inside_in_the_plane(middle: AzEl, corners: &[AzEl], direction: AzEl) -> bool {
    let (up, east) = frame(middle);
    let ahead = middle.to_enu();
    let flat = |position: &AzEl| {
        let vector = position.to_enu();
        (vector.dot(east) / vector.dot(ahead), vector.dot(up) / vector.dot(ahead))
    };
    if direction.to_enu().dot(ahead) <= 0.0 {
        return false;
    }
    let (x, y) = flat(&direction);
    let mut is_inside = false;
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let ((a_x, a_y), (b_x, b_y)) = (flat(a), flat(b));
        if (a_y > y) != (b_y > y) && x < a_x + (y - a_y) / (b_y - a_y) * (b_x - a_x) {
            is_inside = !is_inside;
        }
    }
    is_inside
}

fn any_direction() -> impl Strategy<Value = AzEl> {
    (-360.0..720.0_f64, -1.0..1.0_f64)
        .prop_map(|(azimuth, sin)| AzEl::from_degrees(azimuth, sin.asin().to_degrees()))
}

/// Returns a box whose corners are whole degrees, as operators enter them.
fn any_box() -> impl Strategy<Value = (i32, i32, i32, i32)> {
    (-20..380_i32, 1..360_i32, -10..80_i32, 1..100_i32)
        .prop_map(|(start, turn, low, high)| (start, start + turn, low, (low + high).min(90)))
}

#[test]
fn a_zone_that_is_far_away_is_known_to_be_far_at_once() {
    let mast = zone(&[(100.0, 0.0), (100.0, 30.0), (140.0, 30.0), (140.0, 0.0)]).unwrap();
    let bound_deg = |azimuth_deg, elevation_deg| {
        let point = AzEl::from_degrees(azimuth_deg, elevation_deg).to_enu();
        mast.clearance_lower_bound(point).degrees()
    };
    assert!((120.0..160.0).contains(&bound_deg(300.0, 15.0)), "{}", bound_deg(300.0, 15.0));
    assert!(bound_deg(120.0, 15.0) < -90.0, "within the cap it says nothing");
    // The inside is the side without the nadir, so no direction is far from this zone.
    let all_above = zone(&[(0.0, -80.0), (120.0, -80.0), (240.0, -80.0), (360.0, -80.0)]).unwrap();
    let vector = AzEl::from_degrees(0.0, 90.0).to_enu();
    assert!(all_above.clearance_lower_bound(vector).degrees() < -90.0);
}

#[test]
fn a_box_above_or_beside_a_zone_is_known_to_be_so_far_away() {
    let mast = zone(&[(350.0, 0.0), (350.0, 30.0), (370.0, 30.0), (370.0, 0.0)]).unwrap();
    let min = |az: [f64; 2], el: [f64; 2]| {
        let [azimuths, elevations] =
            [az, el].map(|[start, end]| (Angle::from_degrees(start), Angle::from_degrees(end)));
        mast.box_clearance_lower_bound(azimuths, elevations).degrees()
    };
    let above = min([0.0, 360.0], [32.0, 90.0]);
    assert!((above - 2.0).abs() < 1e-9, "{above}");
    let east = min([12.0, 100.0], [0.0, 60.0]);
    assert!((east - (0.5 * 2.0_f64.to_radians().sin()).asin().to_degrees()).abs() < 1e-9, "{east}");
    let west = min([-100.0, -12.0], [0.0, 0.0]);
    assert!((west - 2.0).abs() < 1e-9, "{west}");
    assert!(min([5.0, 100.0], [0.0, 60.0]) < -90.0, "it reaches into the zone");
    assert!(min([12.0, 200.0], [0.0, 60.0]) < -90.0, "it goes round more than a half");
}

proptest! {
    #[test]
    fn great_circles_around_a_middle_agree_with_the_plane_and_with_their_points(
        (middle, corners) in star(), direction in any_direction(), close in 0.0..60.0_f64,
        bearing in 0.0..7.0_f64,
    ) {
        let built = Zone::new(corners.clone());
        // If the bearings of two corners are more than half a turn apart, their edge passes the
        // middle.
        prop_assume!(built.is_ok());
        let zone = built.unwrap();
        for position in [direction, destination(middle, bearing, close.to_radians())] {
            let clearance = zone.clearance(position).degrees();
            let step = 0.5;
            let sampled = zone
                .edges_sampled(Angle::from_degrees(step))
                .map(|point| point.separation(position).degrees())
                .fold(f64::INFINITY, f64::min);
            prop_assert!(clearance.abs() <= sampled + 1e-9);
            let min = zone.clearance_lower_bound(position.to_enu()).degrees();
            prop_assert!(min <= clearance, "{min} {clearance}");
            prop_assert!(sampled <= clearance.abs() + step / 2.0 + 1e-9);
            if clearance.abs() > 1e-6 {
                let expected = is_inside_in_the_plane(middle, &corners, position);
                prop_assert_eq!(clearance < 0.0, expected, "{}", clearance);
            }
        }
    }

    #[test]
    fn a_box_is_no_nearer_than_any_of_its_directions(
        (_, corners) in star(), (az, el) in (-360.0..720.0_f64, -89.0..89.0_f64),
        (width, height) in (0.0..90.0_f64, 0.0..60.0_f64), box_sides in any_box(),
        shares in proptest::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 20),
    ) {
        let (start, end, low, high) = box_sides;
        let [first, last, low, high] = [start, end, low, high].map(f64::from);
        let boxed = zone(&[(first, low), (first, high), (last, high), (last, low)]);
        let top = (el + height).min(90.0);
        let ends = |west, east| (Angle::from_degrees(west), Angle::from_degrees(east));
        for zone in [Zone::new(corners), boxed].into_iter().flatten() {
            let min =
                zone.box_clearance_lower_bound(ends(az, az + width), ends(el, top)).degrees();
            for (across, up) in &shares {
                let clearance = clearance_deg(&zone, az + across * width, el + up * (top - el));
                prop_assert!(min <= clearance + 1e-9, "{min} {clearance}");
            }
        }
    }

    #[test]
    fn a_box_holds_what_lies_between_its_ends(
        (start, end, low, high) in any_box(), azimuth in -360..720_i32, elevation in -90..=90_i32,
        (share_a, share_b) in (-0.1..1.1_f64, -0.1..1.1_f64),
    ) {
        let [first, last, low, high] = [start, end, low, high].map(f64::from);
        prop_assume!(high > low);
        let corners = [(first, low), (first, high), (last, high), (last, low)];
        let built = zone(&corners);
        // A box that reaches the zenith has two corners in the same direction.
        prop_assume!(high < 90.0 || built.is_ok());
        let zone = built.unwrap();
        let near = (first + share_a * (last - first), low + share_b * (high - low));
        for (azimuth, elevation) in [(f64::from(azimuth), f64::from(elevation)), near] {
            if elevation > 90.0 {
                continue;
            }
            let clearance = clearance_deg(&zone, azimuth, elevation);
            let past = (azimuth - first).rem_euclid(360.0);
            let is_inside = past <= last - first && (low..=high).contains(&elevation);
            if clearance.abs() > 1e-9 {
                prop_assert_eq!(clearance < 0.0, is_inside, "{} {}: {}", azimuth, elevation, clearance);
            }
        }
    }

    #[test]
    fn clearance_changes_no_faster_than_the_direction(
        (middle, corners) in star(), a in any_direction(), b in any_direction(),
        (bearing, distance, step) in (0.0..7.0_f64, 0.0..1.0_f64, -9.0..-0.5_f64),
        (start, end, low, high) in any_box(),
    ) {
        let [first, last, low, high] = [start, end, low, high].map(f64::from);
        let boxed = zone(&[(first, low), (first, high), (last, high), (last, low)]);
        for zone in [Zone::new(corners), boxed].into_iter().flatten() {
            let c = destination(middle, bearing, distance);
            let d = destination(c, bearing * 3.0, 10_f64.powf(step));
            for (a, b) in [(a, b), (a, c), (c, d), (a, destination(a, bearing, 10_f64.powf(step)))] {
                let change = (zone.clearance(a) - zone.clearance(b)).abs().radians();
                prop_assert!(change <= a.separation(b).radians() + 1e-9);
            }
        }
    }
}
