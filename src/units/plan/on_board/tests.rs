use std::sync::LazyLock;

use super::*;
use crate::{
    astro::{frames, time::add_seconds},
    device::{HeldSatellite, Offsets, Place, UnitClock},
    orbit::{Pass, PassSearch, bundled, passes},
};

const ISS: u32 = 25_544;

fn site() -> Site {
    Site::new(41.02, 29.17, 100.0).unwrap().airless()
}

static ELEMENTS: LazyLock<Elements> =
    LazyLock::new(|| bundled().unwrap().get(ISS).unwrap().clone());
static PROPAGATOR: LazyLock<Propagator> = LazyLock::new(|| Propagator::new(&ELEMENTS).unwrap());
static PASS: LazyLock<Pass> = LazyLock::new(find_pass);

fn pass() -> Pass {
    *PASS
}

/// Returns a high pass that begins and ends at 10 degrees.
fn find_pass() -> Pass {
    let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    let aos_elevation = Angle::from_degrees(10.0);
    let search = PassSearch {
        aos_elevation,
        ..PassSearch::new(site(), start, add_seconds(start, 5.0 * 86_400.0))
    };
    let found = passes(&PROPAGATOR, &search, &|| false);
    found.into_iter().find(|pass| (50.0..80.0).contains(&pass.max_elevation().degrees())).unwrap()
}

fn judge_above(minimum_deg: f64) -> Judge {
    judge_from(site(), minimum_deg)
}

fn judge_from(site: Site, minimum_deg: f64) -> Judge {
    let target = TrackTarget {
        catalog_number: ISS,
        name: "ISS".to_owned(),
        element_file: None,
        start: pass().aos.time,
        end: pass().los.time,
    };
    let pass = OnBoardPass { target, elements: ELEMENTS.clone(), site, is_agreed: false };
    let minimum_elevation = Angle::from_degrees(minimum_deg);
    Judge::new(
        pass,
        Ability { minimum_elevation, ..Ability::from_antenna(&Antenna::satrak("Dish", "")) },
    )
    .unwrap()
}

fn judge() -> Judge {
    judge_above(5.0)
}

fn clock(ahead_s: f64) -> UnitClock {
    UnitClock { ahead_s, error_s: 0.0, is_set: true, read_at: pass().aos.time }
}

fn right() -> OnBoard {
    OnBoard {
        place: Some(Place { latitude_deg: 41.02, longitude_deg: 29.17, step_deg: 0.01 }),
        clock: Some(clock(0.0)),
        offsets: Some(Offsets { minimum_elevation_deg: 5.0, lead_s: 60.0, ..Offsets::default() }),
        satellite: None,
        window: None,
    }
}

fn report_with(change: impl FnOnce(&mut Offsets)) -> OnBoard {
    let mut unit = right();
    change(unit.offsets.as_mut().unwrap());
    unit
}

/// Returns the largest separation from the satellite over the pass, checked every second.
/// `direction_at` gives the direction of the antenna at a time.
fn worst_deg(direction_at: impl Fn(Timestamp) -> AzEl) -> f64 {
    let seconds = pass().duration_s() as u32;
    (0..=seconds)
        .map(|second| {
            let time = add_seconds(pass().aos.time, f64::from(second));
            let truth = PROPAGATOR.look_from(site(), time).unwrap().direction;
            direction_at(time).separation(truth).degrees()
        })
        .fold(0.0, f64::max)
}

fn look(place: Site, time: Timestamp) -> AzEl {
    PROPAGATOR.look_from(place, time).unwrap().direction
}

/// Returns the only cause and its error, which must be the whole error.
fn only(unit: &OnBoard) -> (Cause, f64) {
    let found = judge().supervise(unit, true);
    let [Ranked { cause, max_error: Some(deviation) }] = &found.causes[..] else {
        panic!("{found:#?}")
    };
    assert!((found.worst.angle.degrees() - deviation.degrees()).abs() < 1e-9, "{found:#?}");
    (cause.clone(), deviation.degrees())
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 0.02 * expected.max(1.0), "{found}, expected {expected}");
}

/// Returns bounds that forbid nothing at the site.
fn open_sky() -> crate::plan::Bounds {
    crate::plan::Bounds::of_antenna(&Antenna::satrak("Dish", ""))
}

#[test]
fn a_unit_that_goes_by_the_same_follows() {
    let found = judge().supervise(&right(), true);
    assert!(found.is_within_beam && found.worst.angle.degrees() < 1e-9, "{found:#?}");
    assert_eq!((found.causes, found.unknown), (vec![], vec![Unknown::Elements]));
    assert_eq!(found.lower_minimum_deg, None);
    // The unit reports its location in hundredths of a degree.
    let rounded = Place { latitude_deg: 41.01, longitude_deg: 29.18, step_deg: 0.01 };
    let found = judge().supervise(&OnBoard { place: Some(rounded), ..right() }, true);
    assert_eq!(found.causes, []);
}

#[test]
fn a_place_elsewhere_is_told_with_its_distance() {
    let place = Place { latitude_deg: 30.0, longitude_deg: 40.1, step_deg: 0.01 };
    let other_site = Site::new(30.0, 40.1, 100.0).unwrap().airless();
    let distance = frames::site_ecef_km(other_site).distance(frames::site_ecef_km(site()));
    assert!((1500.0..1700.0).contains(&distance));
    let found = judge().supervise(&OnBoard { place: Some(place), ..right() }, true);
    let [Ranked { cause, max_error: Some(deviation) }] = &found.causes[..] else {
        panic!("{found:#?}")
    };
    assert_eq!(*cause, Cause::Place { place, away_km: distance });
    assert_near(deviation.degrees(), worst_deg(|time| look(other_site, time)));
    // The unit does not point below its minimum elevation of 5 degrees.
    let min = Angle::from_degrees(5.0);
    let clamped = worst_deg(|utc| {
        let AzEl { azimuth, elevation } = look(other_site, utc);
        AzEl { azimuth, elevation: if elevation < min { min } else { elevation } }
    });
    assert_near(found.worst.angle.degrees(), clamped);
    assert!(!found.is_within_beam && clamped > 15.0, "{clamped}");
}

#[test]
fn a_clock_ahead_and_a_time_offset_are_so_much_along_the_track() {
    let ahead = worst_deg(|time| look(site(), add_seconds(time, 5.0).min(pass().los.time)));
    let (cause, off_deg) = only(&OnBoard { clock: Some(clock(5.0)), ..right() });
    assert_eq!(cause, Cause::Clock { ahead_s: 5.0 });
    assert_near(off_deg, ahead);

    let errors_deg = [3.0, -3.0].map(|by_s| worst_deg(|utc| look(site(), add_seconds(utc, by_s))));
    let (cause, off_deg) = only(&report_with(|offsets| offsets.time_s = 3.0));
    assert_eq!(cause, Cause::TimeOffset { offset_s: 3.0 });
    assert_near(off_deg, errors_deg[0].max(errors_deg[1]));
}

#[test]
fn a_clock_is_off_by_no_more_than_its_reading_proves() {
    let judged = |ahead_s, error_s| {
        let clock = UnitClock { error_s, ..clock(ahead_s) };
        let found = judge().supervise(&OnBoard { clock: Some(clock), ..right() }, true);
        (found.worst.angle.degrees(), found.causes)
    };
    assert_eq!(judged(-0.15, 0.15), judged(0.0, 0.0), "the reply alone may have been late");
    let (off_deg, causes) = judged(-5.0, 2.0);
    assert_near(off_deg, judged(-3.0, 0.0).0);
    assert!(matches!(causes[0].cause, Cause::Clock { ahead_s: -5.0 }), "{causes:?}");
}

#[test]
fn offsets_turn_the_beam_by_hand_computed_angles() {
    // Turning the azimuth by a at elevation e moves the beam by 2 asin(cos e sin(a/2)); the lowest
    // elevation is 10 degrees.
    let across = |azimuth_deg: f64| {
        let half = (azimuth_deg / 2.0).to_radians().sin();
        (2.0 * (10.0_f64.to_radians().cos() * half).asin()).to_degrees()
    };
    let (cause, off_deg) = only(&report_with(|offsets| offsets.azimuth_deg = 2.0));
    assert_eq!(cause, Cause::AzimuthOffset(2.0));
    assert_near(off_deg, across(2.0));

    let (cause, off_deg) = only(&report_with(|offsets| offsets.elevation_deg = -1.5));
    assert_eq!(cause, Cause::ElevationOffset(-1.5));
    assert_near(off_deg, 1.5);

    let (cause, off_deg) = only(&report_with(|offsets| offsets.north_deg = 6.0));
    assert!(matches!(cause, Cause::NorthOffset { offset_deg: 6.0, .. }), "{cause:?}");
    assert_near(off_deg, across(6.0));

    let (cause, off_deg) = only(&report_with(|offsets| offsets.minimum_elevation_deg = 25.0));
    assert_eq!(cause, Cause::MinimumElevation(25.0));
    assert_near(off_deg, 15.0);
}

#[test]
fn a_north_offset_that_is_the_lower_axis_of_the_station_is_right() {
    let mount = |lower_axis_azimuth_deg| Mount::Xy {
        lower_axis_azimuth_deg,
        travel_from_deg: 5.0,
        travel_to_deg: 175.0,
    };
    for (north_deg, axis_deg, off_deg) in [
        (30.0, 30.0, 0.0),
        (0.0, 30.0, 0.0),
        (210.0, 30.0, 0.0),
        (36.0, 30.0, 6.0),
        (-2.0, 0.0, -2.0),
    ] {
        let found = path::turned(north_deg, mount(axis_deg)).degrees();
        assert!((found - off_deg).abs() < 1e-9, "{north_deg} {axis_deg}: {found}");
    }
}

#[test]
fn another_satellite_and_other_elements_are_told_once_the_target_is_on_the_unit() {
    let holds = |catalog_number, maximum_elevation_deg| OnBoard {
        satellite: Some(HeldSatellite {
            catalog_number,
            name: "NOAA 20".to_owned(),
            maximum_elevation_deg: Some(maximum_elevation_deg),
        }),
        window: Some((pass().aos.time, pass().los.time)),
        ..right()
    };
    let highest_deg = pass().max_elevation().degrees();
    assert_eq!(judge().supervise(&holds(43_013, 20.0), false).causes, []);
    let found = judge().supervise(&holds(43_013, 20.0), true).causes;
    let cause = Cause::OtherSatellite { catalog_number: 43_013, name: "NOAA 20".to_owned() };
    assert_eq!(found, [Ranked { cause, max_error: None }]);
    assert_eq!(judge().supervise(&holds(ISS, highest_deg), true).causes, []);
    let found = judge().supervise(&holds(ISS, highest_deg - 20.0), true).causes;
    assert!(matches!(found[..], [Ranked { cause: Cause::Elements { .. }, .. }]), "{found:?}");
}

#[test]
fn the_greatest_error_comes_first_and_what_is_not_told_is_named() {
    let mut unit = report_with(|offsets| offsets.elevation_deg = 3.0);
    unit.clock = Some(clock(0.5));
    let found = judge().supervise(&unit, true);
    assert!(matches!(found.causes[0].cause, Cause::ElevationOffset(_)), "{found:?}");
    assert!(matches!(found.causes[1].cause, Cause::Clock { .. }), "{found:?}");
    let silent = judge().supervise(&OnBoard::default(), true);
    let all = [Unknown::Place, Unknown::Clock, Unknown::Offsets, Unknown::Elements];
    assert_eq!(silent.unknown, all);
}

#[test]
fn a_lower_minimum_of_the_unit_is_told_beside() {
    let found =
        judge().supervise(&report_with(|offsets| offsets.minimum_elevation_deg = 3.0), true);
    assert_eq!((found.lower_minimum_deg, found.causes), (Some(3.0), vec![]));
}

#[test]
fn a_path_is_finely_sampled_to_its_end() {
    let judge = judge();
    let unit = UnitPath::new(&OnBoard { clock: Some(clock(7.0)), ..right() }, &judge);
    let path: Vec<Sample> = judge.path(unit).collect::<Result<_, _>>().unwrap();
    let first = path.first().unwrap();
    assert!((seconds_between(first.time, pass().aos.time) - 7.0).abs() < 1e-6);
    assert!(first.direction.separation(pass().aos.direction).degrees() < 1e-6, "as it waits");
    assert!((seconds_between(path.last().unwrap().time, pass().los.time) - 7.0).abs() < 1e-6);
    for pair in path.windows(2) {
        let apart_deg = pair[0].direction.separation(pair[1].direction).degrees();
        assert!(seconds_between(pair[0].time, pair[1].time) <= 1.0 + 1e-9 || apart_deg <= 0.5);
    }
}

#[test]
fn a_path_that_nobody_knows_is_not_clear() {
    let gone_time = |days: u32| {
        let time = add_seconds(ELEMENTS.epoch(), f64::from(days) * 86_400.0);
        PROPAGATOR.look_from(site(), time).is_err().then_some(time)
    };
    let gone_time = (0..100_000).step_by(50).find_map(gone_time).expect("elements that end");
    let mut judge = judge();
    for until_s in [0.0, 3600.0] {
        judge.pass.target.start = add_seconds(gone_time, until_s - 3600.0);
        judge.pass.target.end = add_seconds(gone_time, until_s);
        // The rest of the path may be clear.
        judge.ability.minimum_elevation = Angle::from_degrees(-90.0);
        assert!(judge.is_clear(&right(), &open_sky()).is_err(), "{until_s}");
    }
}

#[test]
fn a_path_below_the_limit_or_beyond_the_travel_says_where_first() {
    assert_eq!(judge().is_clear(&right(), &open_sky()), Ok(()));
    let leads = |judge: &Judge, unit: &OnBoard| match judge.is_clear(unit, &open_sky()) {
        Err(NotClear::Leads(trespass)) => trespass,
        other => panic!("{other:?}"),
    };
    let low = leads(&judge_above(45.0), &right());
    assert_eq!(low.limit, OffLimits::Elevation { lowest_deg: 45.0 });
    assert_eq!(low.time, pass().aos.time);
    // With an offset that lowers the path, the end of the pass is as low as its beginning.
    let sunk = leads(
        &judge_above(10.0),
        &report_with(|offsets| {
            offsets.elevation_deg = -3.0;
            offsets.minimum_elevation_deg = 0.0;
        }),
    );
    assert!(matches!(sunk.limit, OffLimits::Elevation { .. }));
    // The unit is late by the time offset, whichever way it applies the offset.
    let late = report_with(|offsets| {
        (offsets.time_s, offsets.minimum_elevation_deg) = (120.0, 0.0);
    });
    assert!(judge_above(10.0).is_clear(&late, &open_sky()).is_err());
    let mut narrow = judge();
    narrow.ability.mount =
        Mount::Xy { lower_axis_azimuth_deg: 0.0, travel_from_deg: 60.0, travel_to_deg: 120.0 };
    assert_eq!(leads(&narrow, &right()).limit, OffLimits::Travel);
}

#[test]
fn a_unit_that_leaves_refraction_out_is_told_apart_and_still_takes_the_pass() {
    let place = Site::new(41.02, 29.17, 100.0).unwrap();
    let judge = judge_from(place, 5.0);
    let aos = pass().aos;
    let lifted = judge.direction(aos.time).unwrap();
    let off_deg = lifted.separation(aos.direction).degrees();
    // The pass begins at 10 degrees.
    assert!((0.08..0.1).contains(&off_deg) && lifted.elevation > aos.direction.elevation);
    let found = judge.supervise(&right(), true);
    assert_near(100.0 * found.worst.angle.degrees(), 100.0 * off_deg);
    let [Ranked { cause: Cause::Refraction, max_error: Some(deviation) }] = &found.causes[..]
    else {
        panic!("{found:#?}")
    };
    assert_eq!(*deviation, found.worst.angle);
    // A beam narrower than the refraction loses the ends of the pass, which no setting of the unit
    // prevents.
    let narrow = Ability { half_beam: Angle::from_degrees(0.05), ..judge.ability() };
    let narrow = Judge::new(judge.pass().clone(), narrow).unwrap();
    assert!(narrow.supervise(&right(), true).is_within_beam);
    assert!(!narrow.supervise(&report_with(|unit| unit.azimuth_deg = 1.0), true).is_within_beam);
    // The gate judges the path that the unit takes.
    assert!(judge.start(&right(), aos.time).unwrap().separation(aos.direction).degrees() < 1e-6);
}

#[test]
fn a_small_known_error_is_no_cause_of_a_large_one() {
    let ranked = |off_deg: Option<f64>| Ranked {
        cause: Cause::Refraction,
        max_error: off_deg.map(Angle::from_degrees),
    };
    let can_make = |own_deg, off_deg| ranked(own_deg).can_make(Angle::from_degrees(off_deg));
    assert!(can_make(Some(2.5), 2.6) && can_make(Some(9.0), 2.6));
    assert!(!can_make(Some(0.1), 2.6));
    assert!(can_make(None, 2.6), "such as another satellite on the unit");
}
