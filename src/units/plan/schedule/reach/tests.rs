//! Tests of passes of real satellites, judged by few samples and by many.

use super::*;
use crate::{
    astro::time::add_seconds,
    orbit::{PassSearch, Propagator, passes},
    plan::schedule::testing::{
        Random, add_barriers, any_three_antennas, low_satellites, noon, planned, three_antennas,
    },
    station::{Direction, Entered, KeepOut},
};

const SEED: u64 = 7;

/// Calls `check` with the passes of this number of satellites in a day, and the reach of each
/// antenna.
fn each_pass(
    station: &Station,
    random: &mut Random,
    satellites: usize,
    mut check: impl FnMut(usize, &Reach, &mut Sight<'_>),
) {
    let antennas = planned(station, noon());
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, noon(), add_seconds(noon(), 86_400.0))
    };
    for satellite in low_satellites(random, satellites) {
        let propagator = Propagator::new(&satellite.elements).unwrap();
        for pass in passes(&propagator, &search, &|| false) {
            let mut sight = Sight::new(&propagator, station.site, None, &pass);
            for (place, antenna) in antennas.iter().enumerate() {
                check(place, &antenna.reach, &mut sight);
            }
        }
    }
}

/// Judges by many samples alone.
fn by_many(reach: &Reach, sight: &mut Sight<'_>) -> Option<Verdict> {
    let span = sight.above(reach.min_elevation())?;
    let clear = sight.clear(span);
    Some(reach.ways(sight.fine(span, span), &clear))
}

/// Judges by few samples alone, if they suffice.
fn by_few(reach: &Reach, sight: &mut Sight<'_>) -> Option<Vec<Way>> {
    let span = sight.above(reach.min_elevation())?;
    let clear = sight.clear(span);
    reach.easy_ways(sight.coarse(span), &clear)
}

fn assert_alike(few: &[Way], many: &Verdict, label: &str) {
    let Verdict::Possible(many) = many else { panic!("{label}: {many:?}") };
    assert_eq!(few.len(), many.len(), "{label}");
    for (few, many) in few.iter().zip(many) {
        let (a, b) = (few.span(), many.span());
        assert!(
            (few.counted_ms(a) - many.counted_ms(b)).abs() <= 4_000,
            "{label}: {few:?} {many:?}"
        );
        for (from_ms, to_ms) in [(a.from_ms, b.from_ms), (a.to_ms, b.to_ms)] {
            let pairs = few.axes_deg(from_ms).into_iter().zip(many.axes_deg(to_ms));
            let apart = pairs.map(|(few, many)| (few - many).abs());
            assert!(apart.fold(0.0, f64::max) < 2.0, "{label}: {few:?} {many:?}");
        }
    }
}

#[test]
fn what_few_samples_tell_of_a_pass_is_what_many_tell() {
    let mut compared = [0; 3];
    let mut random = Random::new(SEED);
    let mut turns = 0;
    for case in 0..25 {
        let station = if case == 0 { three_antennas() } else { any_three_antennas(&mut random) };
        each_pass(&station, &mut random, 8, |place, reach, sight| {
            let Some(few) = by_few(reach, sight) else { return };
            let many = by_many(reach, sight).unwrap();
            assert_alike(&few, &many, &format!("seed {SEED}, case {case}, antenna {place}"));
            turns += usize::from(few.len() > 1);
            compared[place] += 1;
        });
    }
    println!("seed {SEED}: {compared:?} passes compared, {turns} of them on more than one turn");
    assert!(compared.iter().all(|count| *count > 100) && turns > 100, "{compared:?} {turns}");
}

#[test]
fn directions_between_few_states_are_judged_as_those_of_the_orbit() {
    let (mut judged, mut random) = (0, Random::new(SEED + 2));
    for case in 0..4 {
        let mut station = any_three_antennas(&mut random);
        if case % 2 == 1 {
            add_barriers(&mut station, &mut random);
        }
        each_pass(&station, &mut random, 6, |place, reach, sight| {
            let Some(span) = sight.above(reach.min_elevation()) else { return };
            let clear = sight.clear(span);
            let exact = sight.exact(span);
            let [of_states, of_orbit] =
                [reach.ways(sight.fine(span, span), &clear), reach.ways(&exact, &clear)];
            let label = format!("seed {SEED}, case {case}, antenna {place}");
            match (of_states, of_orbit) {
                (Verdict::Possible(of_states), Verdict::Possible(of_orbit)) => {
                    assert_eq!(of_states.len(), of_orbit.len(), "{label}");
                    for (one, other) in of_states.iter().zip(&of_orbit) {
                        assert_eq!((one.span(), one.lost), (other.span(), other.lost), "{label}");
                        assert_eq!(one.counted_ms(span), other.counted_ms(span), "{label}");
                    }
                }
                (of_states, of_orbit) => assert_eq!(of_states, of_orbit, "{label}"),
            }
            judged += 1;
        });
    }
    assert!(judged > 100, "{judged}");
}

/// Checks that both judgements find the same loss. A part out of reach is no slew, even if the axis
/// changes ends in that time.
fn assert_same_loss(judged: Option<Lost>, many: Option<Lost>, label: &str) {
    assert_eq!(judged.map(|lost| lost.seconds), many.map(|lost| lost.seconds), "{label}");
    let [judged, many] = [judged, many].map(|lost| lost.map(|lost| lost.loss));
    let changes_ends = matches!((judged, many), (Some(Loss::BeyondAzimuth(_)), Some(Loss::Slew)));
    assert!(judged == many || changes_ends, "{label}: {judged:?} {many:?}");
}

#[test]
fn what_lies_beyond_the_travel_of_an_axis_needs_no_closer_look() {
    let (mut cut, mut none, mut random) = (0, 0, Random::new(SEED + 3));
    for case in 0..20 {
        let mut station = three_antennas();
        for antenna in &mut station.antennas {
            if let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = &mut antenna.mount {
                *azimuth_from_deg = f64::from(random.below(360));
                *azimuth_to_deg = *azimuth_from_deg + f64::from(10 + random.below(320));
            }
            antenna.beam_width_deg = f64::from(1 + random.below(40));
        }
        each_pass(&station, &mut random, 6, |place, reach, sight| {
            let Some(many) = by_many(reach, sight) else { return };
            let label = format!("seed {}, case {case}, antenna {place}", SEED + 3);
            let span = sight.above(reach.min_elevation()).unwrap();
            let part = reach.within_travel(sight.coarse(span), span);
            cut += usize::from(part.is_some_and(|part| part != span));
            none += usize::from(part.is_none());
            if by_few(reach, sight).is_some() {
                return;
            }
            match (reach.judge(sight), many) {
                (Verdict::Possible(judged), Verdict::Possible(many)) => {
                    assert_eq!(judged.len(), many.len(), "{label}");
                    for (one, other) in judged.iter().zip(&many) {
                        assert_eq!(one.span(), other.span(), "{label}");
                        assert_eq!(one.counted_ms(span), other.counted_ms(span), "{label}");
                        assert_same_loss(one.lost, other.lost, &label);
                        let Span { from_ms, to_ms } = one.span();
                        for time_ms in [from_ms, to_ms] {
                            let pairs =
                                one.axes_deg(time_ms).into_iter().zip(other.axes_deg(time_ms));
                            let apart = pairs.map(|(one, other)| (one - other).abs());
                            assert!(apart.fold(0.0, f64::max) < 0.01, "{label}");
                        }
                    }
                }
                (
                    Verdict::Impossible(Impossible::Lost(judged)),
                    Verdict::Impossible(Impossible::Lost(many)),
                ) => assert_same_loss(Some(judged), Some(many), &label),
                (judged, many) => assert_eq!(judged, many, "{label}"),
            }
        });
    }
    println!("seed {}: {cut} passes cut, {none} never near", SEED + 3);
    assert!(cut > 100 && none > 10, "{cut} {none}");
}

#[test]
fn with_keep_outs_or_the_sun_few_samples_decide_nothing() {
    let (mut judged, mut entered) = ([0; 3], 0);
    let mut random = Random::new(SEED + 1);
    for case in 0..5 {
        let mut station = any_three_antennas(&mut random);
        add_barriers(&mut station, &mut random);
        each_pass(&station, &mut random, 3, |place, reach, sight| {
            let Some(many) = by_many(reach, sight) else { return };
            let label = format!("seed {SEED}, case {case}, antenna {place}");
            assert_eq!(reach.judge(sight), many, "{label}");
            entered += usize::from(matches!(many, Verdict::Impossible(Impossible::KeepOut(_))));
            let Verdict::Possible(ways) = many else { return };
            for way in ways {
                assert_outside(reach, &way, &label);
            }
            judged[place] += 1;
        });
    }
    println!("seed {SEED}: {judged:?} passes judged, {entered} lead into a barrier");
    assert!(judged.iter().all(|count| *count > 10) && entered > 10, "{judged:?} {entered}");
}

/// The gate judges both directions too, so it refuses no planned way for the model.
#[test]
fn with_a_pointing_model_a_way_has_the_beam_on_the_satellite_and_both_directions_outside() {
    let (mut looks, mut random) = ([0; 3], Random::new(SEED + 4));
    for case in 0..2 {
        let mut station = any_three_antennas(&mut random);
        add_barriers(&mut station, &mut random);
        for antenna in &mut station.antennas {
            antenna.pointing_model = PointingModel {
                azimuth_offset_deg: 4.0,
                elevation_offset_deg: -2.0,
                tilt_north_deg: 2.0,
                sag_deg: 1.0,
                ..PointingModel::default()
            };
        }
        each_pass(&station, &mut random, 2, |place, reach, sight| {
            let Verdict::Possible(ways) = reach.judge(sight) else { return };
            let label = format!("seed {}, case {case}, antenna {place}", SEED + 4);
            let samples = sight.above(reach.min_elevation()).map(|span| sight.fine(span, span));
            for way in ways {
                assert_outside(reach, &way, &label);
                let model = station.antennas[place].track_model();
                if reach.on_board || !reach.drives.has_elevation || model.is_none() {
                    continue;
                }
                for sample in samples.iter().flat_map(|samples| &samples.list) {
                    let time_ms = ms(sample.time);
                    let nearby = Span { from_ms: time_ms - 2_000, to_ms: time_ms + 2_000 };
                    if way.counted_ms(nearby) < nearby.length_ms() {
                        continue;
                    }
                    let [azimuth_deg, elevation_deg] = way.axes_deg(time_ms);
                    let beam = model.direction(AzEl::from_degrees(azimuth_deg, elevation_deg));
                    let deviation = beam.separation(sample.direction);
                    assert!(
                        deviation < reach.half_beam + Angle::from_degrees(0.3),
                        "{label}: {deviation:?}"
                    );
                    looks[place] += 1;
                }
            }
        });
    }
    println!("seed {}: {looks:?} directions compared", SEED + 4);
    assert!(looks.iter().filter(|count| **count > 100).count() >= 2, "{looks:?}");
}

/// Checks that the counted seconds of a path lie in no barrier, and that both ends are reachable
/// from the open sky.
fn assert_outside(reach: &Reach, way: &Way, label: &str) {
    let Span { from_ms, to_ms } = way.span();
    for time_ms in (from_ms + 2_000..to_ms).step_by(5_000) {
        let span = Span { from_ms: time_ms - 2_000, to_ms: time_ms + 2_000 };
        if way.counted_ms(span) < span.length_ms() {
            continue;
        }
        let bounds = reach.bounds.at_time(at_ms(time_ms));
        let nearest = bounds.nearest(reach.bounds.direction(way.axes_deg(time_ms)));
        // Between two samples, the axes may cut a corner.
        let inside_deg = nearest.map_or(0.0, |nearest| -nearest.angle.degrees());
        assert!(inside_deg < 0.3, "{label}: {inside_deg} at {time_ms}");
    }
    assert!(reach.is_within_reach(way), "{label}");
}

/// An antenna never has to go to its park position, so a keep-out over that position costs no pass.
#[test]
fn a_park_position_out_of_reach_costs_no_pass() {
    let mut random = Random::new(SEED + 5);
    for entered in [Entered::Hard, Entered::GoRound] {
        let mut station = three_antennas();
        let corners = [(175.0, 0.0), (185.0, 0.0), (185.0, 9.0), (175.0, 9.0)];
        station.keep_outs.push(KeepOut {
            name: "Shed".to_owned(),
            reason: String::new(),
            entered,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(&corners).unwrap(),
        });
        let seed = random.next();
        let judged = |station: &mut Station, elevation_deg: f64| {
            for antenna in &mut station.antennas {
                antenna.park = Direction { azimuth_deg: 180.0, elevation_deg };
            }
            let mut verdicts = Vec::new();
            each_pass(station, &mut Random::new(seed), 6, |place, reach, sight| {
                verdicts.push((place, matches!(reach.judge(sight), Verdict::Possible(_))));
            });
            verdicts
        };
        let free = judged(&mut station, 80.0);
        assert!(free.iter().filter(|(_, is_possible)| *is_possible).count() > 30, "{free:?}");
        assert_eq!(judged(&mut station, 3.0), free, "{entered:?}");
        for antenna in &station.antennas {
            let reach = Reach::from_station(&station, antenna, None);
            let open = reach.open_sky(noon()).unwrap();
            assert!(reach.bounds.at_time(noon()).forbids(open).is_none(), "{open:?}");
        }
    }
    // 0 degrees is outside the travel of the third antenna.
    let mut station = three_antennas();
    let can_park = |station: &Station| {
        let reach =
            station.antennas.iter().map(|antenna| Reach::from_station(station, antenna, None));
        reach.map(|reach| reach.can_park(noon())).collect::<Vec<_>>()
    };
    assert_eq!(can_park(&station), [true; 3]);
    station.antennas[2].park = Direction { azimuth_deg: 0.0, elevation_deg: 45.0 };
    assert_eq!(can_park(&station), [true, true, false]);
}

#[test]
fn ways_lead_to_the_open_sky_beside_any_park_position() {
    let mut random = Random::new(SEED + 77);
    for case in 0..200 {
        let mut uniform =
            |start: f64, end: f64| start + (end - start) * f64::from(random.below(10_000)) / 1e4;
        let park =
            Direction { azimuth_deg: uniform(20.0, 340.0), elevation_deg: uniform(0.0, 15.0) };
        let (left_deg, right_deg) = (park.azimuth_deg - 5.0, park.azimuth_deg + 5.0);
        let top_deg = park.elevation_deg + 3.0;
        let corners =
            [(left_deg, 0.0), (right_deg, 0.0), (right_deg, top_deg), (left_deg, top_deg)];
        let mut station = three_antennas();
        station.keep_outs.push(KeepOut {
            name: "Shed".to_owned(),
            reason: String::new(),
            entered: Entered::Hard,
            antenna: None,
            margin_deg: uniform(1.0, 8.0),
            zone: KeepOut::zone_of(&corners).unwrap(),
        });
        for antenna in &mut station.antennas {
            antenna.park = park;
        }
        for antenna in &station.antennas {
            let reach = Reach::from_station(&station, antenna, None);
            let now = reach.bounds.at_time(noon());
            let open_deg = reach.open_sky_deg(&now).unwrap();
            let [(from_deg, to_deg), _] = reach.slews.travel_deg;
            for first_deg in [from_deg + 30.0, to_deg - 30.0] {
                let place_deg = [first_deg, 60.0];
                if now.has_room(place_deg, 3.0) {
                    let label = format!("seed {}, case {case}: {place_deg:?}", SEED + 77);
                    assert!(reach.is_way(place_deg, open_deg, &now), "{label} to {open_deg:?}");
                }
            }
        }
    }
}

/// The time between two samples counts only if both are in the beam.
#[test]
fn what_counts_of_a_pass_with_a_loss_begins_and_ends_in_the_beam() {
    let (mut edges, mut random) = (0, Random::new(SEED + 6));
    for case in 0..6 {
        let station = any_three_antennas(&mut random);
        each_pass(&station, &mut random, 6, |place, reach, sight| {
            let Verdict::Possible(ways) = reach.judge(sight) else { return };
            for way in ways.iter().filter(|way| way.lost.is_some()) {
                let Span { from_ms, to_ms } = way.span();
                for time_ms in [from_ms, to_ms] {
                    let sample =
                        sight.exact(Span { from_ms: time_ms, to_ms: time_ms + 2_000 }).list[0];
                    let beam = reach.bounds.direction(way.axes_deg(time_ms));
                    let deviation = if reach.drives.has_elevation {
                        beam.separation(sample.direction)
                    } else {
                        (beam.azimuth - sample.direction.azimuth).wrapped_180().abs()
                    };
                    let label = format!("seed {}, case {case}, antenna {place}", SEED + 6);
                    assert!(
                        deviation.degrees() <= reach.half_beam.degrees() + 0.01,
                        "{label}: {deviation:?}"
                    );
                    edges += 1;
                }
            }
        });
    }
    assert!(edges > 20, "{edges}");
}
