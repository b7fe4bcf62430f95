//! Tests of schedules of real satellites on three antennas.

mod milp;

use std::cell::Cell;

use super::{testing::*, *};
use crate::{
    astro::time::{add_seconds, seconds_between},
    station::{BetweenPasses, ChooseBy, Take},
};

const SEED: u64 = 2_026;

/// Returns the operator's choices for planning.
fn kinds() -> [(Option<Partial>, BetweenPasses, ChooseBy); 5] {
    let part = |hand_over| Partial { min_share: 0.4, min_s: 90.0, step_s: 60.0, hand_over };
    [
        (None, BetweenPasses::Wait, ChooseBy::Elevation),
        (None, BetweenPasses::Park, ChooseBy::Duration),
        (None, BetweenPasses::Stay, ChooseBy::MostPasses),
        (Some(part(false)), BetweenPasses::Wait, ChooseBy::MostMinutes),
        (Some(part(true)), BetweenPasses::Park, ChooseBy::Elevation),
    ]
}

/// Calls `check` with requests of all kinds for some hours of some satellites.
fn each_day(days: u64, check: impl Fn(&Request<'_>)) {
    let station = three_antennas();
    let mut random = Random::new(SEED);
    for day in 0..days {
        let start = add_seconds(noon(), day as f64 * 86_400.0);
        let mut satellites = low_satellites(&mut random, 30);
        for satellite in satellites.iter_mut().step_by(4) {
            satellite.limits.max_per_day = Some(1);
        }
        let mut antennas = planned(&station, start);
        let list = candidates(&station, &antennas, &satellites, start, 5.0);
        for (partial, rest, choose_by) in kinds() {
            for antenna in &mut antennas {
                antenna.between_passes = rest;
            }
            check(&Request { choose_by, partial, ..request(&antennas, &list) });
        }
    }
}

/// Plans this number of days in these ways, each with other antennas and other keep-outs. Counts
/// the pairs of entries, the pairs with a path round a keep-out, and the entries of a partial pass.
fn behind_keep_outs(
    (days, satellites, hours): (u32, usize, f64),
    kinds: &[(Option<Partial>, BetweenPasses, ChooseBy)],
) -> (usize, usize, usize) {
    let mut random = Random::new(SEED);
    let (mut pairs, mut detours, mut parts) = (0, 0, 0);
    for day in 0..days {
        let mut station = any_three_antennas(&mut random);
        add_barriers(&mut station, &mut random);
        let start = add_seconds(noon(), f64::from(day) * 86_400.0);
        let satellites = low_satellites(&mut random, satellites);
        let mut antennas = planned(&station, start);
        for antenna in &mut antennas {
            antenna.stands_deg = Some(antenna.reach.park_deg());
        }
        let list = candidates(&station, &antennas, &satellites, start, hours);
        for (partial, rest, choose_by) in kinds.iter().copied() {
            for antenna in &mut antennas {
                antenna.between_passes = rest;
            }
            let schedule = plan(&Request { choose_by, partial, ..request(&antennas, &list) });
            for entry in &schedule.entries {
                assert_counts(entry, &list, day);
                let is_part = entry.late_s + entry.early_s > 0.0 || entry.shared_with.is_some();
                parts += usize::from(is_part);
            }
            for antenna in &antennas {
                let own = schedule.entries.iter().filter(|entry| entry.antenna == antenna.id);
                let own: Vec<&Entry> = own.collect();
                for pair in own.windows(2) {
                    let [a, b] = [pair[0], pair[1]];
                    let reach = &antenna.reach;
                    let (end_deg, start_deg) = (a.axes_deg[1], b.axes_deg[0]);
                    let direct = reach.leg_ms(end_deg, start_deg, way::ms(a.end));
                    let back = reach.leg_ms(end_deg, reach.park_deg(), way::ms(a.end));
                    let back_ms = reach.leg_ms(reach.park_deg(), start_deg, way::ms(b.start));
                    let by_park = back.zip(back_ms).map(|(back, outward)| back + outward);
                    let way_ms = direct.into_iter().chain(by_park).min();
                    let label = || format!("seed {SEED}, day {day}: {a:?} {b:?}");
                    let needs_s =
                        way_ms.unwrap_or_else(|| panic!("no way, {}", label())) as f64 / 1e3;
                    let gap_s = seconds_between(a.end, b.start);
                    assert!(gap_s + 1e-3 >= needs_s + antenna.set_up_s, "{needs_s} {}", label());
                    pairs += 1;
                    detours += usize::from(way_ms > Some(reach.straight_ms(end_deg, start_deg)));
                }
            }
        }
    }
    println!("seed {SEED}: {pairs} pairs of entries, {detours} with a way round, {parts} parts");
    (pairs, detours, parts)
}

/// Checks that an entry promises only the possible take between its ends, and begins at the axis
/// positions of that time.
fn assert_counts(entry: &Entry, list: &[Candidate], day: u32) {
    let candidate = list.iter().find(|candidate| candidate.key == entry.pass).unwrap();
    let option = candidate.options.iter().find(|(id, _)| *id == entry.antenna);
    let Some((_, Choice::Judged(Verdict::Possible(ways)))) = option else {
        panic!("seed {SEED}, day {day}: {entry:?}")
    };
    let span = way::Span { from_ms: way::ms(entry.start), to_ms: way::ms(entry.end) };
    let is_it = |way: &&Way| {
        let ends_deg = [way.axes_deg(span.from_ms), way.axes_deg(span.to_ms)];
        let counted_s = way.counted_ms(span) as f64 / 1e3;
        ends_deg == entry.axes_deg && (counted_s - entry.counted_s).abs() < 1e-3
    };
    assert!(ways.iter().any(|way| is_it(&way)), "seed {SEED}, day {day}: {entry:?}");
}

#[test]
fn no_two_entries_come_closer_than_the_way_round_keep_outs_and_set_up() {
    let (pairs, detours, _) = behind_keep_outs((4, 6, 5.0), &kinds()[..3]);
    assert!(pairs > 15 && detours > 5, "{pairs} {detours}");
}

#[test]
fn parts_of_passes_come_no_closer_than_the_way_round_keep_outs_and_set_up() {
    // Each of these schedules has many paths, each round the keep-outs.
    let (pairs, _, parts) = behind_keep_outs((2, 4, 2.5), &kinds()[3..]);
    assert!(pairs > 0 && parts > 0, "{pairs} {parts}");
}

fn worth(schedule: &Schedule) -> Vec<i64> {
    schedule.worth.iter().map(|class| class.worth).collect()
}

#[test]
fn no_two_entries_of_an_antenna_come_closer_than_slew_and_set_up() {
    each_day(3, |request| {
        let schedule = plan(request);
        assert!(schedule.entries.len() > 10);
        for antenna in request.antennas {
            let own = schedule.entries.iter().filter(|entry| entry.antenna == antenna.id);
            let own: Vec<&Entry> = own.collect();
            for pair in own.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                let straight_ms = antenna.reach.straight_ms(a.axes_deg[1], b.axes_deg[0]);
                let gap_s = seconds_between(a.end, b.start);
                assert!(gap_s >= straight_ms as f64 / 1000.0 + antenna.set_up_s, "{a:?} {b:?}");
                assert!(b.spare_s.is_some_and(|spare_s| spare_s >= 0.0), "{b:?}");
                assert_eq!(b.after, Some(a.pass));
            }
        }
        for entry in &schedule.entries {
            let parts: Vec<&Entry> = schedule.entries_of(entry.pass).collect();
            match parts[..] {
                [_] => assert_eq!(entry.shared_with, None),
                [a, b] => {
                    assert!(request.partial.is_some_and(|partial| partial.hand_over));
                    assert!(a.antenna != b.antenna && a.end <= b.start, "{a:?} {b:?}");
                }
                _ => panic!("{parts:?}"),
            }
        }
        let count = schedule.left_out.len() + request.candidates.len();
        assert!(schedule.entries.len() + count >= request.candidates.len());
    });
}

#[test]
fn a_bound_is_never_below_what_is_reached() {
    each_day(3, |request| {
        let schedule = plan(request);
        for class in &schedule.worth {
            if let Proof::AtMost(bound) = class.proof {
                assert!(bound >= class.worth, "{class:?}");
            }
        }
        if request.partial.is_none() {
            assert!(schedule.is_proved(), "{:?}", schedule.worth);
        }
    });
}

#[test]
fn planning_again_changes_nothing() {
    each_day(2, |request| {
        let schedule = plan(request);
        assert_eq!(plan(request), schedule);
        let steadiness = Steadiness { percent: 5, seconds: 10 };
        let again = plan(&Request { previous: Some(&schedule), steadiness, ..request.clone() });
        if request.partial.is_none() {
            assert_eq!(again.entries, schedule.entries);
            assert_eq!(changes(&schedule, &again, request.antennas[0].free_from), []);
        }
    });
}

/// Returns the schedule after the operator has set `pass` to always; `None` if it is still left
/// out.
fn with_always(request: &Request<'_>, pass: PassKey) -> Option<Schedule> {
    let mut chosen = request.candidates.to_vec();
    let candidate = chosen.iter_mut().find(|candidate| candidate.key == pass).unwrap();
    (candidate.take, candidate.max_per_day) = (Some(Take::Always), None);
    let schedule = plan(&Request { candidates: &chosen, ..request.clone() });
    let is_taken = schedule.entries_of(pass).next().is_some();
    is_taken.then_some(schedule)
}

/// Returns the worth of a schedule by the operator's choices for its passes in `request`.
fn worth_in(request: &Request<'_>, schedule: &Schedule) -> Vec<i64> {
    let class = |entry: &Entry| {
        let found = request.candidates.iter().find(|candidate| candidate.key == entry.pass);
        found.map(|candidate| candidate.class(request.choose_by))
    };
    let worth = |row_class: Class| {
        let own = schedule.entries.iter().filter(|entry| class(entry) == Some(row_class));
        own.map(|entry| entry.worth).sum()
    };
    Class::shown(request.choose_by).into_iter().map(worth).collect()
}

#[test]
fn a_pass_that_has_begun_is_left_out_as_under_way_and_not_as_too_far() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let satellites = low_satellites(&mut Random::new(SEED), 1);
    let list = candidates(&station, &antennas, &satellites, noon(), 24.0);
    let first = plan(&request(&antennas, &list)).entries[0].clone();
    for (after_s, expected) in [(-1.0, LeftOutReason::TooFar), (60.0, LeftOutReason::UnderWay)] {
        let free_from = add_seconds(first.start, after_s);
        let stands_deg = |antenna: &PlannedAntenna| Some(antenna.reach.park_deg());
        let late = antennas.iter().map(|antenna| PlannedAntenna {
            free_from,
            stands_deg: stands_deg(antenna),
            ..antenna.clone()
        });
        let late: Vec<PlannedAntenna> = late.collect();
        let schedule = plan(&request(&late, &list));
        let left = schedule.left_out.iter().find(|left| left.pass == first.pass).unwrap();
        assert_eq!(left.reason, expected, "{after_s}: {left:?}");
    }
}

#[test]
fn every_reason_holds_when_the_pass_is_always_taken() {
    each_day(1, |request| {
        let schedule = plan(request);
        assert_eq!(worth_in(request, &schedule), worth(&schedule));
        for left in schedule.left_out.iter().step_by(3) {
            let swapped = with_always(request, left.pass);
            match &left.reason {
                LeftOutReason::Refused(_)
                | LeftOutReason::Impossible(_)
                | LeftOutReason::Off(_)
                | LeftOutReason::OtherAntennas(_) => {
                    assert_eq!(swapped, None, "{left:?}");
                }
                LeftOutReason::Overlaps(_)
                | LeftOutReason::SlewTooShort(_)
                | LeftOutReason::MaxPerDay(_)
                | LeftOutReason::TooFar
                | LeftOutReason::UnderWay => {
                    let Some(swapped) = swapped else {
                        assert!(
                            matches!(left.reason, LeftOutReason::TooFar | LeftOutReason::UnderWay),
                            "{left:?}"
                        );
                        continue;
                    };
                    // Beyond its limit, a satellite may still add to the worth.
                    if schedule.is_proved() && !matches!(left.reason, LeftOutReason::MaxPerDay(_)) {
                        assert!(worth_in(request, &swapped) <= worth(&schedule), "{left:?}");
                    }
                    let start = request.antennas[0].free_from;
                    let changes = changes(&schedule, &swapped, start);
                    assert!(changes.iter().any(|change| change.pass == left.pass));
                    // The pass may fit after the removal of another entry.
                    let has_room = matches!(left.reason, LeftOutReason::MaxPerDay(_));
                    assert!(has_room || changes.len() > 1, "{left:?} {changes:?}");
                }
                LeftOutReason::NotFound => assert!(!schedule.is_proved()),
            }
        }
    });
}

#[test]
fn a_pass_that_is_always_taken_keeps_to_the_antennas_of_its_satellite() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let mut satellites = low_satellites(&mut Random::new(SEED), 20);
    for satellite in &mut satellites {
        satellite.limits.antennas = Some(vec![antennas[0].id]);
        satellite.limits.min_max_elevation_deg = Some(89.0);
        satellite.take = Some(Take::Always);
    }
    let list = candidates(&station, &antennas, &satellites, noon(), 6.0);
    let schedule = plan(&request(&antennas, &list));
    assert!(schedule.entries.len() > 5, "{}", schedule.entries.len());
    assert!(schedule.entries.iter().all(|entry| entry.antenna == antennas[0].id));
}

#[test]
fn a_pass_that_its_only_antenna_cannot_take_is_impossible() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let mut satellites = low_satellites(&mut Random::new(SEED), 40);
    // This antenna reaches only the south.
    let narrow = antennas[2].id;
    for satellite in &mut satellites {
        satellite.limits.antennas = Some(vec![narrow]);
    }
    let list = candidates(&station, &antennas, &satellites, noon(), 6.0);
    let schedule = plan(&request(&antennas, &list));
    let mut count = 0;
    for left in &schedule.left_out {
        let own = left.by_antenna.iter().find(|(antenna, _)| *antenna == narrow);
        if let Some((_, reason @ LeftOutReason::Impossible(_))) = own {
            assert_eq!(left.reason, *reason);
            count += 1;
        }
    }
    assert!(count > 5, "{count}");
}

#[test]
fn conflicts_name_entries_that_are_really_in_the_way() {
    let checked = Cell::new(0);
    each_day(2, |request| {
        let schedule = plan(request);
        let conflicts = schedule.left_out.iter().flat_map(|left| &left.by_antenna);
        for (antenna, reason) in conflicts {
            let (LeftOutReason::Overlaps(conflict) | LeftOutReason::SlewTooShort(conflict)) =
                reason
            else {
                continue;
            };
            let mut entries = schedule.entries_of(conflict.pass);
            assert!(entries.any(|entry| entry.antenna == *antenna), "{conflict:?}");
            assert!(conflict.missing_s > 0.0);
            checked.set(checked.get() + 1);
        }
    });
    assert!(checked.get() > 0);
}

#[test]
fn what_is_fixed_stays_and_what_the_operator_says_is_done() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let satellites = low_satellites(&mut Random::new(SEED), 70);
    let mut list = candidates(&station, &antennas, &satellites, noon(), 6.0);
    let first = plan(&request(&antennas, &list));
    let (entry, left) = (first.entries[3].clone(), first.left_out.iter());
    let is_lost = |left: &&LeftOut| {
        matches!(left.reason, LeftOutReason::Overlaps(_) | LeftOutReason::SlewTooShort(_))
    };
    let later = |left: &&LeftOut| left.pass.aos > add_seconds(entry.end, 3_600.0);
    let lost = left.filter(is_lost).find(later).unwrap().pass;
    let taken_pass = first.entries[5].pass;
    for candidate in &mut list {
        if candidate.key == lost {
            candidate.take = Some(Take::Always);
        } else if candidate.key == taken_pass {
            candidate.take = Some(Take::Never);
            candidate.refusal = Some(Refusal::Never);
        }
    }
    let fixed = [entry.clone()];
    let new = plan(&Request { fixed: &fixed, ..request(&antennas, &list) });
    let expected = new.entries_of(entry.pass).next().unwrap();
    assert_eq!(
        (expected.antenna, expected.start, expected.end),
        (entry.antenna, entry.start, entry.end)
    );
    assert!(expected.is_fixed);
    let always = new.entries_of(lost).next().unwrap();
    assert_eq!(always.class, Class::Always);
    let never = new.left_out.iter().find(|left| left.pass == taken_pass).unwrap();
    assert_eq!(never.reason, LeftOutReason::Refused(Refusal::Never));
    assert!(changes(&first, &new, noon()).iter().any(|change| {
        change.pass == taken_pass && change.cause == ChangeCause::LeftOut(never.reason.clone())
    }));
}

#[test]
fn an_antenna_resumes_a_pass_from_where_it_stands() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let satellites = low_satellites(&mut Random::new(SEED), 40);
    let list = candidates(&station, &antennas, &satellites, noon(), 6.0);
    let choose_by = ChooseBy::default();
    let first = plan(&request(&antennas, &list));
    for entry in &first.entries {
        let candidate = list.iter().find(|candidate| candidate.key == entry.pass).unwrap();
        let antenna = antennas.iter().find(|antenna| antenna.id == entry.antenna).unwrap();
        let now = add_seconds(entry.start, 30.0);
        let stands_deg = Some(antenna.reach.park_deg());
        let parked = PlannedAntenna { free_from: now, stands_deg, ..antenna.clone() };
        let Some(rest) = candidate.resumed(&parked, choose_by) else { continue };
        let needs_s = rest.slew_s + rest.set_up_s;
        let waits_s = seconds_between(now, rest.start);
        assert!(waits_s > needs_s - 1.0, "{rest:?}");
        assert!(rest.start < rest.end && rest.end <= candidate.los, "{rest:?}");
        assert!(rest.counted_s <= entry.counted_s - 30.0 + 1.0, "{rest:?}");
        let lost = PlannedAntenna { stands_deg: None, ..parked.clone() };
        assert_eq!(candidate.resumed(&lost, choose_by), None, "it may stand anywhere");
        let blocked = PlannedAntenna { free_from: candidate.los, ..parked };
        assert_eq!(candidate.resumed(&blocked, choose_by), None);
    }
    let entry = &first.entries[3];
    let candidate = list.iter().find(|candidate| candidate.key == entry.pass).unwrap();
    let antenna = antennas.iter().find(|antenna| antenna.id == entry.antenna).unwrap();
    let stands_deg = Some(entry.axes_deg[0]);
    let planned_antenna = PlannedAntenna { free_from: entry.start, stands_deg, ..antenna.clone() };
    let rest = candidate.resumed(&planned_antenna, choose_by).unwrap();
    assert!(rest.counted_s > entry.counted_s - 60.0, "{rest:?}");
}

#[test]
fn a_pass_that_is_tracked_already_or_waited_for_stays_until_its_end() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let satellites = low_satellites(&mut Random::new(SEED), 40);
    let list = candidates(&station, &antennas, &satellites, noon(), 6.0);
    let first = plan(&request(&antennas, &list));
    let entry = first.entries[3].clone();
    let candidate = list.iter().find(|candidate| candidate.key == entry.pass).unwrap();
    let antenna = antennas.iter().find(|antenna| antenna.id == entry.antenna).unwrap();
    let choose_by = ChooseBy::default();
    let now = add_seconds(entry.start, 30.0);
    let rest = candidate.under_way(antenna, choose_by, now).unwrap();
    assert_eq!((rest.start, rest.end), (now, entry.end));
    assert!((entry.counted_s - rest.counted_s - 30.0).abs() < 1.0, "{rest:?}");
    assert_eq!(candidate.under_way(antenna, choose_by, entry.end), None);
    let ahead = candidate.under_way(antenna, choose_by, add_seconds(entry.pass.aos, -900.0));
    let ahead = ahead.unwrap();
    assert_eq!((ahead.start, ahead.end, ahead.late_s), (entry.start, entry.end, 0.0));
    // At that time, the antenna could not take the whole pass.
    let mut later = antennas.clone();
    for antenna in &mut later {
        antenna.free_from = now;
    }
    let free_plan = plan(&request(&later, &list));
    assert!(free_plan.entries_of(entry.pass).all(|found| found.antenna != entry.antenna));
    let fixed = [rest];
    let fixed_plan = plan(&Request { fixed: &fixed, ..request(&later, &list) });
    let expected = fixed_plan.entries_of(entry.pass).next().unwrap();
    assert_eq!(
        (expected.antenna, expected.end, expected.is_fixed),
        (entry.antenna, entry.end, true)
    );
}

#[test]
fn the_other_part_of_a_pass_that_is_handed_over_stays_when_one_is_fixed() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let satellites = low_satellites(&mut Random::new(SEED), 40);
    let list = candidates(&station, &antennas, &satellites, noon(), 2.0);
    let partial = Some(Partial { min_share: 0.2, min_s: 60.0, step_s: 60.0, hand_over: true });
    let request = Request { partial, ..request(&antennas, &list) };
    let first = plan(&request);
    let shared = first.entries.iter().filter(|entry| entry.shared_with.is_some());
    let shared: Vec<_> = shared.take(2).collect();
    assert_eq!(shared.len(), 2, "nothing is handed over");
    for entry in shared {
        let fixed = [entry.clone()];
        let new = plan(&Request { fixed: &fixed, previous: Some(&first), ..request.clone() });
        let parts: Vec<_> = new.entries_of(entry.pass).collect();
        assert_eq!(parts.len(), 2, "{entry:?}");
        assert!(parts.iter().all(|part| part.shared_with.is_some()));
        assert!(parts.iter().any(|part| part.is_fixed && part.antenna == entry.antenna));
    }
}

#[test]
fn passes_far_from_what_changed_stay_as_they_are() {
    let station = three_antennas();
    let antennas = planned(&station, noon());
    let mut satellites = low_satellites(&mut Random::new(SEED + 1), 25);
    let before = candidates(&station, &antennas, &satellites, noon(), 10.0);
    let schedule = plan(&request(&antennas, &before));
    let changed = schedule.entries[4].pass.satellite;
    let satellite =
        satellites.iter_mut().find(|satellite| satellite.elements.catalog_number() == changed);
    satellite.unwrap().limits.min_max_elevation_deg = Some(89.0);
    let after = candidates(&station, &antennas, &satellites, noon(), 10.0);
    let steadiness = Steadiness { percent: 5, seconds: 10 };
    let new =
        plan(&Request { previous: Some(&schedule), steadiness, ..request(&antennas, &after) });
    let found = changes(&schedule, &new, noon());
    assert!(!found.is_empty());
    let own: Vec<_> = before
        .iter()
        .map(|candidate| candidate.key)
        .filter(|key| key.satellite == changed)
        .collect();
    for change in &found {
        let near = own.iter().any(|key| seconds_between(key.aos, change.pass.aos).abs() < 5_400.0);
        assert!(near, "{change:?}");
    }
    assert!(found.len() < schedule.entries.len() / 3, "{}", found.len());
}

#[test]
fn a_schedule_can_be_written_down_and_read_again() {
    each_day(1, |request| {
        let schedule = plan(request);
        let text = serde_json::to_string(&schedule).unwrap();
        assert_eq!(serde_json::from_str::<Schedule>(&text).unwrap(), schedule);
    });
}
