//! Random tests that no motion allowed by the gate enters a forbidden area: random antennas,
//! keep-outs, positions and motions. `AZEL_CASES` and `AZEL_SEED` work as in
//! `tests/safety_properties.rs`.

use super::*;
use crate::{
    astro::{PointingModel, Term},
    driver::dice::Dice,
    plan::Barrier,
    station::{Entered, KeepOut, Station},
};

/// Max depth to which a path may enter a margin, degrees.
const EDGE_DEG: f64 = 0.05 + 1e-6;

/// Min width of a gap that counts as a way out, degrees.
const GAP_DEG: f64 = 1.0;

/// Step of the search for a way out, degrees.
const FINE_DEG: f64 = 0.1;

fn antenna(dice: &mut Dice) -> Antenna {
    let mut antenna = match dice.draw(0.0, 3.0) as u8 {
        0 => Antenna::satrak("Dish", ""),
        1 => Antenna::genius("Dish", ""),
        _ => Antenna::rc2000c("Dish", ""),
    };
    antenna.mount = if matches!(antenna.mount, Mount::Xy { .. }) && dice.chance(0.7) {
        Mount::Xy {
            lower_axis_azimuth_deg: dice.draw(0.0, 180.0),
            travel_from_deg: dice.draw(0.0, 40.0),
            travel_to_deg: dice.draw(140.0, 180.0),
        }
    } else {
        let azimuth_from_deg = dice.draw(-180.0, 90.0);
        Mount::AzEl {
            azimuth_from_deg,
            azimuth_to_deg: azimuth_from_deg + dice.draw(90.0, 540.0),
            elevation_from_deg: dice.draw(-5.0, 10.0),
            elevation_to_deg: dice.draw(60.0, 180.0),
        }
    };
    if dice.chance(0.4) {
        for term in Term::ALL {
            let max = if term == Term::ElevationScale { 0.05 } else { 4.0 };
            *antenna.pointing_model.place(term) = dice.draw(-max, max);
        }
    }
    antenna.beam_width_deg = dice.draw(0.01, 20.0);
    antenna.limits.minimum_elevation_deg = dice.draw(0.0, 20.0);
    antenna.limits.maximum_rate_deg_s = dice.draw(0.1, 10.0);
    antenna.limits.maximum_step_deg = dice.draw(1.0, 20.0);
    antenna
}

fn station(dice: &mut Dice) -> Station {
    let mut station = Station::default();
    for number in 0..dice.draw(0.0, 4.0) as u8 {
        let (az_deg, el_deg) = (dice.draw(0.0, 360.0), dice.draw(-20.0, 70.0));
        let (width_deg, height_deg) = (dice.draw(5.0, 60.0), dice.draw(5.0, 60.0));
        let top_deg = f64::min(el_deg + height_deg, 89.0);
        let lean_deg = dice.draw(-0.2, 0.2) * width_deg;
        let corners_deg = [
            (az_deg, el_deg),
            (az_deg + width_deg, el_deg),
            (az_deg + width_deg + lean_deg, top_deg),
            (az_deg + lean_deg, top_deg),
        ];
        let margin_deg = dice.draw(0.0, 10.0);
        let Ok(zone) = KeepOut::zone_of(&corners_deg) else { continue };
        let (name, entered) = (format!("zone {number}"), Entered::Hard);
        station.keep_outs.push(KeepOut {
            name,
            reason: String::new(),
            entered,
            antenna: None,
            margin_deg,
            zone,
        });
    }
    if dice.chance(0.3) {
        let (radius_deg, ahead_min) = (dice.draw(0.1, 40.0), dice.draw(0.0, 30.0));
        station.sun_avoidance = Some(crate::station::SunAvoidance { radius_deg, ahead_min });
    }
    station
}

fn motion(dice: &mut Dice, antenna: &Antenna) -> (Intent, Motion) {
    let can = antenna.connection.variant().capabilities;
    let mut two = |max: f64| {
        let [x, y] = [dice.draw(-max, max), dice.draw(-max, max)];
        match dice.draw(0.0, 3.0) as u8 {
            0 => [x, 0.0],
            1 => [0.0, y],
            _ if can.jogs_one_axis => [x, 0.0],
            _ => [x, y],
        }
    };
    let [x_deg_s, y_deg_s] = two(antenna.limits.maximum_rate_deg_s);
    let [x_deg, y_deg] = two(antenna.limits.maximum_step_deg);
    match dice.draw(0.0, 3.0) as u8 {
        0 => (Intent::Manual, Motion::Jog { x_deg_s, y_deg_s }),
        1 if can.steps => (Intent::Manual, Motion::Step { x_deg, y_deg }),
        _ => {
            let azimuth = dice.draw(-180.0, 500.0);
            (Intent::Position, position(azimuth, dice.draw(0.0, 180.0)))
        }
    }
}

/// Kind of a place on a way out.
enum OnTheWay {
    Free,
    Inside,
    Barred,
}

/// Clearances of both directions of the axes, each computed without the other.
struct BothWays {
    plain: Bounds,
    model: PointingModel,
}

impl BothWays {
    fn new(station: &Station, antenna: &Antenna) -> Self {
        let plain = Antenna { pointing_model: PointingModel::default(), ..antenna.clone() };
        Self { plain: Bounds::new(station, &plain), model: antenna.track_model() }
    }

    /// Returns the smaller clearance from each barrier, degrees; uses the axes for the minimum
    /// elevation.
    fn clear_deg(&self, axes_deg: [f64; 2], utc: Timestamp) -> Vec<(Barrier, f64)> {
        let [first_deg, second_deg] = axes_deg;
        let by_axes = self.plain.direction(axes_deg);
        let beam = if self.model.is_none() {
            by_axes
        } else {
            self.model.direction(AzEl::from_degrees(first_deg, second_deg))
        };
        let [by_axes, on_sky] =
            [by_axes, beam].map(|direction| self.plain.at_time(utc).clearances(direction));
        let clearances = by_axes.into_iter().zip(on_sky).map(|(by_axes, on_sky)| {
            let (axes_deg, sky_deg) = (by_axes.angle.degrees(), on_sky.angle.degrees());
            let is_floor = by_axes.barrier == Barrier::MinimumElevation;
            (by_axes.barrier, if is_floor { axes_deg } else { axes_deg.min(sky_deg) })
        });
        clearances.collect()
    }

    fn each_deg(&self, axes_deg: [f64; 2], utc: Timestamp) -> Vec<f64> {
        self.clear_deg(axes_deg, utc).into_iter().map(|(_, clear_deg)| clear_deg).collect()
    }

    /// Returns the clearance from the nearest barrier except the minimum elevation, degrees.
    fn nearest_deg(&self, axes_deg: [f64; 2], utc: Timestamp) -> f64 {
        let clearances = self.clear_deg(axes_deg, utc).into_iter();
        let above = clearances.filter(|(barrier, _)| *barrier != Barrier::MinimumElevation);
        above.map(|(_, clear_deg)| clear_deg).fold(180.0, f64::min)
    }

    /// Returns the clearance from the surroundings of the Sun, degrees.
    fn sun_deg(&self, axes_deg: [f64; 2], utc: Timestamp) -> f64 {
        let mut clearances = self.clear_deg(axes_deg, utc).into_iter();
        clearances
            .find(|(barrier, _)| *barrier == Barrier::Sun)
            .map_or(180.0, |(_, clear_deg)| clear_deg)
    }
}

/// Returns the shortest turn of one axis to an allowed direction, degrees of the sky; searches in
/// small steps.
fn way_out_deg(judge: &BothWays, from_deg: [f64; 2], utc: jiff::Timestamp) -> Option<f64> {
    let (bounds, clear_deg) = (&judge.plain, |axes_deg| judge.each_deg(axes_deg, utc));
    let before_deg = clear_deg(from_deg);
    let place = |axis: usize, turned_deg: f64| {
        let mut axes_deg = from_deg;
        axes_deg[axis] += turned_deg;
        let (min_deg, max_deg) = bounds.mount().travel_deg()[axis];
        let here_deg = clear_deg(axes_deg);
        let enters = before_deg.iter().zip(&here_deg).any(|(a, b)| *a >= 0.0 && *b < 0.0);
        if enters || !(min_deg..=max_deg).contains(&axes_deg[axis]) {
            OnTheWay::Barred
        } else if here_deg.iter().all(|clear_deg| *clear_deg >= 0.0) {
            OnTheWay::Free
        } else {
            OnTheWay::Inside
        }
    };
    let turn_deg = |axis: usize, way: f64| {
        let look = |turn_deg: f64| place(axis, way * turn_deg);
        for step in 0_u32..3_600 {
            let turn_deg = f64::from(step) * FINE_DEG;
            match look(turn_deg) {
                OnTheWay::Inside => {}
                OnTheWay::Barred => return None,
                OnTheWay::Free if step == 0 => return Some(0.0),
                OnTheWay::Free => {
                    let back = (0..=100).map(|part| FINE_DEG * f64::from(part) / 100.0);
                    let free =
                        back.take_while(|back| matches!(look(turn_deg - back), OnTheWay::Free));
                    let edge_deg = turn_deg - free.last().unwrap_or_default();
                    let has_room = matches!(look(edge_deg + GAP_DEG), OnTheWay::Free);
                    return has_room.then_some(edge_deg);
                }
            }
        }
        None
    };
    let ways = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].into_iter();
    let lengths = ways.filter_map(|(axis, way)| {
        let mut on_deg = from_deg;
        on_deg[axis] += 0.01;
        let moved = bounds.direction(from_deg).separation(bounds.direction(on_deg));
        Some(turn_deg(axis, way)? * moved.degrees() / 0.01)
    });
    lengths.min_by(f64::total_cmp)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CaseOutcome {
    Refused,
    Allowed,
    LedOut,
}

fn look_closely(seed: u64) -> CaseOutcome {
    let mut dice = Dice::new(seed);
    let (antenna, mut station) = (antenna(&mut dice), station(&mut dice));
    station.antennas.clear();
    let (intent, motion) = motion(&mut dice, &antenna);
    let from_deg = antenna.mount.travel_deg().map(|(min, max)| dice.draw(min, max));
    let utc = add_seconds("2026-06-21T00:00:00Z".parse().unwrap(), dice.draw(0.0, 3e7));
    let (bounds, judge) = (Bounds::new(&station, &antenna), BothWays::new(&station, &antenna));
    let here = bounds.direction(from_deg);
    let mut case = Case { antenna: antenna.clone(), ..Case::new(intent) };
    case.age = Duration::from_millis(dice.draw(0.0, 900.0) as u64);
    let measured = case.state.measured.as_mut().unwrap();
    measured.pointing = here.into();
    for (axis, deg) in measured.axes.iter_mut().zip(from_deg) {
        axis.angle_deg = Some(deg);
    }
    let started = Arc::default();
    let (objection, leads_to) = (None, Lead::Nowhere);
    let metal = Metal { state: case.state.clone(), started, objection, leads_to };
    let mut gate = Gate::new(Box::new(metal), &antenna, bounds.clone(), &Default::default());
    let now = Moment { steady: measured_at(&case) + case.age, utc };
    gate.permit_exit(Some(now.steady + Duration::from_secs(1)));
    if gate.check(motion, intent, now).is_err() {
        return CaseOutcome::Refused;
    }
    let situation = gate.situation(intent, false, now);
    let (to_deg, is_hand) = match motion {
        Motion::Jog { x_deg_s, y_deg_s } => {
            let ahead =
                situation.actual_rates([x_deg_s, y_deg_s]).map(|rate| rate * situation.ahead_s);
            ([from_deg[0] + ahead[0], from_deg[1] + ahead[1]], true)
        }
        Motion::Step { x_deg, y_deg } => ([from_deg[0] + x_deg, from_deg[1] + y_deg], true),
        _ => (gate.ends(motion, now).unwrap().1, false),
    };
    for (to_deg, (min_deg, max_deg)) in to_deg.into_iter().zip(antenna.mount.travel_deg()) {
        assert!((min_deg - 1e-6..=max_deg + 1e-6).contains(&to_deg), "{seed}: {to_deg}");
    }
    let floor_deg = f64::min(antenna.limits.minimum_elevation_deg, here.elevation_deg());
    let clear_deg = |axes_deg: [f64; 2]| judge.nearest_deg(axes_deg, utc);
    let start_deg = clear_deg(from_deg);
    if start_deg < 0.0 && is_hand {
        let ways_deg = [from_deg, to_deg].map(|axes_deg| way_out_deg(&judge, axes_deg, utc));
        if let [Some(start_deg), Some(end_deg)] = ways_deg {
            let is_deeper = end_deg > start_deg + FINE_DEG;
            assert!(!is_deeper, "{seed}: {motion:?} leads from {start_deg} to {end_deg}");
            // No place in between enters a barrier either, and the antenna stays outside the
            // others.
            let entered_at = |axes_deg, edge_deg: f64| {
                let clearances = judge.each_deg(axes_deg, utc).into_iter();
                clearances.map(|clear_deg| clear_deg < -edge_deg).collect::<Vec<_>>()
            };
            let entered = entered_at(from_deg, 0.0);
            for part in 1..=16 {
                let share = f64::from(part) / 16.0;
                let axes_deg: [f64; 2] = std::array::from_fn(|axis| {
                    from_deg[axis] + share * (to_deg[axis] - from_deg[axis])
                });
                let is_new =
                    entered.iter().zip(entered_at(axes_deg, EDGE_DEG)).any(|(was, is)| !was && is);
                assert!(!is_new, "{seed}: {motion:?} enters another at {axes_deg:?}");
                let Some(here_deg) = way_out_deg(&judge, axes_deg, utc) else { continue };
                let is_deeper = here_deg > start_deg + 3.0 * FINE_DEG;
                assert!(!is_deeper, "{seed}: {start_deg} to {here_deg} at {axes_deg:?}");
            }
        } else {
            let end_deg = clear_deg(to_deg);
            assert!(end_deg > start_deg, "{seed}: {motion:?} leads from {start_deg} to {end_deg}");
        }
        return CaseOutcome::LedOut;
    }
    // A go-to may begin inside only near the Sun, and must not approach it.
    let min_clear_deg = f64::min(start_deg, 0.0) - EDGE_DEG;
    assert!(clear_deg(to_deg) > -EDGE_DEG, "{seed}: {motion:?} ends inside");
    assert!(start_deg > -EDGE_DEG || judge.sun_deg(from_deg, utc) < 0.0, "{seed}: {motion:?}");
    // Each axis may have completed any share of its path at any time.
    for first in 0..=10 {
        for second in 0..=10 {
            let share = [f64::from(first) / 10.0, f64::from(second) / 10.0];
            let axes_deg = std::array::from_fn(|axis| {
                from_deg[axis] + share[axis] * (to_deg[axis] - from_deg[axis])
            });
            let clear_deg = clear_deg(axes_deg);
            assert!(clear_deg > min_clear_deg, "{seed}: {motion:?} at {axes_deg:?}: {clear_deg}");
            let elevation_deg = bounds.direction(axes_deg).elevation_deg();
            assert!(elevation_deg > floor_deg - EDGE_DEG, "{seed}: {motion:?} {elevation_deg}");
        }
    }
    CaseOutcome::Allowed
}

fn measured_at(case: &Case) -> Instant {
    case.state.measured.unwrap().received
}

#[test]
#[allow(clippy::print_stdout, reason = "the counts of the long form")]
fn any_motion_that_is_allowed_sweeps_nothing_forbidden() {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("AZEL_SEED").unwrap_or(20_261_122);
    // One of these cases costs a thousandth of a whole session.
    let cases = number("AZEL_CASES").map_or(2_000, |cases| cases * 10);
    let outcomes: Vec<CaseOutcome> = (seed..seed + cases).map(look_closely).collect();
    let count = |outcome| outcomes.iter().filter(|other| **other == outcome).count();
    let (allowed, led_out) = (count(CaseOutcome::Allowed), count(CaseOutcome::LedOut));
    println!("gate: {cases} cases from seed {seed}, {allowed} allowed, {led_out} led out");
    assert!(allowed > cases as usize / 20 && led_out > 0, "{allowed} allowed, {led_out} led out");
}
