use std::{collections::VecDeque, time::Duration};

use super::*;
use crate::{
    astro::{Angle, Offset, Site},
    clock::Instant,
    orbit::{Pass, PassSearch, Propagator, bundled, passes},
    plan::{Target, TrackStats},
    station::{AfterPass, Antenna, Entered, KeepOut, MotionLimits, Mount, Station},
};

/// Time step of the simulated axes, seconds.
const TICK_S: f64 = 0.05;
const TICK: Duration = Duration::from_millis(50);

/// Two axes that go to the commanded position at their rate, after a latency.
#[derive(Clone)]
struct Metal {
    axes_deg: [f64; 2],
    goals_deg: [f64; 2],
    orders: VecDeque<(f64, [Option<f64>; 2])>,
    rate_deg_s: f64,
    latency_s: f64,
    /// Max distance for which an axis does not set out, degrees.
    ignored_deg: f64,
}

impl Metal {
    fn tell(&mut self, now_s: f64, point: SetPoint) {
        let axes = [point.azimuth, point.elevation].map(|axis| axis.map(Angle::degrees));
        self.orders.push_back((now_s + self.latency_s, axes));
    }

    fn advance(&mut self, now_s: f64) {
        while let Some((_, axes)) = self.orders.pop_front_if(|(at_s, _)| *at_s <= now_s) {
            let goals = self.goals_deg.iter_mut().zip(axes).zip(self.axes_deg);
            for ((goal, goal_deg), position) in goals {
                let is_reached = (*goal - position).abs() < 1e-9;
                let new_goal = goal_deg.filter(|new_goal| {
                    !is_reached || (new_goal - position).abs() > self.ignored_deg
                });
                *goal = new_goal.unwrap_or(*goal);
            }
        }
        for (axis, goal) in self.axes_deg.iter_mut().zip(self.goals_deg) {
            let max_deg = self.rate_deg_s * TICK_S;
            *axis += (goal - *axis).clamp(-max_deg, max_deg);
        }
    }

    fn now(&self) -> [AxisNow; 2] {
        let stands = |axis: usize| {
            self.orders.is_empty() && (self.axes_deg[axis] - self.goals_deg[axis]).abs() < 1e-9
        };
        [0, 1].map(|axis| AxisNow { position_deg: Some(self.axes_deg[axis]), stands: stands(axis) })
    }
}

struct TrackRun {
    stats: TrackStats,
    azimuths_deg: Vec<f64>,
    /// Seconds since AOS, and the comparison with the planned path.
    on_path: Vec<(f64, OnPath)>,
}

fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap()
}

fn azel(range_deg: (f64, f64), rate_deg_s: f64, step_deg: f64) -> Drives {
    let antenna = Antenna::rc2000c("", "");
    Drives {
        mount: Mount::AzEl {
            azimuth_from_deg: range_deg.0,
            azimuth_to_deg: range_deg.1,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        },
        limits: MotionLimits {
            minimum_elevation_deg: 0.0,
            maximum_rate_deg_s: rate_deg_s,
            ..antenna.limits
        },
        rates_deg_s: [rate_deg_s; 2],
        step_deg,
        arrives_within_deg: 0.0,
        has_elevation: true,
    }
}

fn settings(period_s: f64, dead_band_deg: f64) -> TrackSettings {
    TrackSettings { period_s, dead_band_deg, latency_s: 0.5, after: AfterPass::Hold }
}

/// Returns the first pass of a satellite in three days that meets the condition `is_it`.
fn pass_where(is_it: impl Fn(&Propagator, &Pass) -> bool) -> (Target, Pass) {
    let catalog = bundled().unwrap();
    for number in [43013, 25544, 37849, 25994, 27424, 49260] {
        let elements = catalog.get(number).unwrap();
        let propagator = Propagator::new(elements).unwrap();
        let start = elements.epoch();
        let search = PassSearch::new(site(), start, add_seconds(start, 10.0 * 86_400.0));
        for pass in passes(&propagator, &search, &|| false) {
            if !pass.starts_before && is_it(&propagator, &pass) {
                return (Target::Satellite(Box::new(elements.clone())), pass);
            }
        }
    }
    panic!("no such pass")
}

fn goes_through_north(propagator: &Propagator, pass: &Pass) -> bool {
    let look = |share: f64| {
        let time = add_seconds(pass.aos.time, pass.duration_s() * share);
        propagator.look_from(site(), time).unwrap().direction.azimuth_deg()
    };
    let azimuths: Vec<f64> = (0..=50).map(|step| look(f64::from(step) / 50.0)).collect();
    let crossing = azimuths.windows(2).position(|two| (two[1] - two[0]).abs() > 180.0);
    crossing.is_some_and(|index| (15..35).contains(&index))
}

fn max_deg(pass: &Pass) -> f64 {
    pass.max_elevation().degrees()
}

fn run(target: Target, pass: &Pass, drives: Drives, settings: TrackSettings) -> TrackRun {
    run_on(target, pass, drives, settings, &metal(drives, settings))
}

fn metal(drives: Drives, settings: TrackSettings) -> Metal {
    let [rate_deg_s, _] = drives.rates_deg_s;
    Metal {
        axes_deg: [180.0, 45.0],
        goals_deg: [180.0, 45.0],
        orders: VecDeque::new(),
        rate_deg_s,
        latency_s: settings.latency_s,
        ignored_deg: 0.0,
    }
}

/// Returns bounds with nothing in the way.
fn free() -> Bounds {
    let mut antenna = Antenna::rc2000c("", "");
    antenna.limits.minimum_elevation_deg = 0.0;
    Bounds::of_antenna(&antenna)
}

fn run_on(
    target: Target,
    pass: &Pass,
    drives: Drives,
    settings: TrackSettings,
    metal: &Metal,
) -> TrackRun {
    let passes = vec![(pass.aos.time, pass.los.time)];
    let track = ProgramTrack::new(target, site(), passes);
    let planner = Planner::new(track, drives, settings, free()).unwrap();
    run_planner(planner, pass, settings, metal, |_, _| {})
}

fn drives_mount(planner: &Planner) -> Mount {
    planner.drives.mount
}

/// Calls `look` with the positions of the axes at each time.
fn run_planner(
    mut planner: Planner,
    pass: &Pass,
    settings: TrackSettings,
    metal: &Metal,
    mut look: impl FnMut(Timestamp, [f64; 2]),
) -> TrackRun {
    let mut metal = metal.clone();
    let begin = add_seconds(pass.aos.time, -240.0);
    let started = Instant::now();
    let mut run =
        TrackRun { stats: TrackStats::default(), azimuths_deg: Vec::new(), on_path: Vec::new() };
    let ticks = ((pass.duration_s() + 240.0) / TICK_S) as u32;
    let mut next_look_s = 0.0;
    for tick in 0..ticks {
        let now_s = f64::from(tick) * TICK_S;
        let now = add_seconds(begin, now_s);
        if tick % 5 == 0 {
            planner.watch(started + TICK * tick, metal.axes_deg.map(Some));
            let half_beam = Angle::from_degrees(1.0);
            let reported = drives_mount(&planner).direction(metal.axes_deg);
            let reported = [Some(reported.azimuth), Some(reported.elevation)];
            let compared = planner.compare(now, metal.axes_deg.map(Some), reported, half_beam);
            let since_s = seconds_between(pass.aos.time, now);
            let compared = compared.filter(|_| since_s >= 0.0);
            run.on_path.extend(compared.map(|compared| (since_s, compared)));
        }
        if now_s >= next_look_s {
            next_look_s += settings.period_s;
            if let Some(next) = planner.update(now, metal.now()).unwrap() {
                planner.sent(next);
                metal.tell(now_s, next.set_point);
                run.stats.commands += 1;
            }
        }
        metal.advance(now_s);
        look(now, metal.axes_deg);
        if now >= pass.aos.time {
            let [azimuth, elevation] = metal.axes_deg;
            let position = AzEl::from_degrees(azimuth, elevation);
            if let Some(direction) = planner.reachable(now) {
                run.stats.take(direction.separation(position));
            }
            run.azimuths_deg.push(azimuth);
        }
    }
    run
}

fn shown(label: &str, stats: TrackStats) -> (f64, f64, u32) {
    let [rms, worst] = [stats.rms(), stats.worst()].map(|error| error.unwrap().degrees());
    println!("{label:40} rms {rms:6.3} worst {worst:7.3} commands {}", stats.commands);
    (rms, worst, stats.commands)
}

#[test]
fn a_usual_pass_is_followed_within_the_dead_band() {
    let (target, pass) = pass_where(|_, pass| (35.0..50.0).contains(&max_deg(pass)));
    let drives = azel((0.0, 360.0), 4.0, 0.0);
    for (dead_band_deg, max) in [(0.0, 0.06), (0.2, 0.2), (1.0, 0.9)] {
        let run = run(target.clone(), &pass, drives, settings(1.0, dead_band_deg));
        let (rms, ..) = shown(&format!("usual, dead band {dead_band_deg}"), run.stats);
        assert!(rms < max, "{rms}");
    }
}

#[test]
fn whole_degrees_are_followed_to_their_rounding() {
    let (target, pass) = pass_where(|_, pass| (35.0..50.0).contains(&max_deg(pass)));
    let run = run(target, &pass, azel((0.0, 360.0), 4.0, 1.0), settings(1.0, 0.5));
    let (rms, worst, _) = shown("usual, whole degrees", run.stats);
    // The error comes from the rounding of two axes, each up to half a degree.
    assert!(rms < 0.5 && worst < 1.0, "{rms} {worst}");
}

#[test]
fn a_drive_that_ignores_short_ways_is_found_out() {
    let (target, pass) = pass_where(|_, pass| (35.0..50.0).contains(&max_deg(pass)));
    let drives = azel((0.0, 360.0), 4.0, 1.0);
    let settings = settings(1.0, 0.5);
    let metal = Metal { ignored_deg: 2.0, ..metal(drives, settings) };
    let run = run_on(target, &pass, drives, settings, &metal);
    let (rms, worst, _) = shown("usual, whole degrees, more than 2 at once", run.stats);
    assert!(rms < 1.2 && worst < 3.5, "{rms} {worst}");
}

#[test]
fn through_north_an_overlap_needs_no_slew() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && goes_through_north(propagator, pass)
    });
    let plain = run(target.clone(), &pass, azel((0.0, 360.0), 4.0, 0.0), settings(1.0, 0.2));
    let overlap = run(target, &pass, azel((0.0, 450.0), 4.0, 0.0), settings(1.0, 0.2));
    let (_, lost, _) = shown("north, 0 to 360", plain.stats);
    let (rms, sharp_turn, _) = shown("north, 0 to 450", overlap.stats);
    assert!(lost > 45.0 && sharp_turn < 0.5 && rms < 0.2, "{lost} {sharp_turn} {rms}");
    let turned = |run: &TrackRun| {
        run.azimuths_deg.windows(2).map(|two| (two[1] - two[0]).abs()).sum::<f64>()
    };
    assert!(turned(&plain) > turned(&overlap) + 100.0);
}

#[test]
fn an_unwrap_is_on_its_way_until_the_predicted_time_and_else_the_antenna_is_on_its_path() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && goes_through_north(propagator, pass)
    });
    let run = run(target, &pass, azel((0.0, 360.0), 4.0, 0.0), settings(1.0, 0.2));
    let turns = |entry: &&(f64, OnPath)| matches!(entry.1, OnPath::OnItsWay { .. });
    let first = run.on_path.iter().position(|entry| turns(&entry)).unwrap();
    let (_, OnPath::OnItsWay { arrival: Some(end) }) = run.on_path[first] else {
        panic!("{:?}", run.on_path[first]);
    };
    let back_s = run.on_path[first..].iter().find(|entry| !turns(entry)).unwrap().0;
    let until_s = seconds_between(pass.aos.time, end);
    assert!((until_s - back_s).abs() < 2.0, "{until_s} {back_s}");
    let turning = run.on_path.iter().filter(turns).count();
    // The axis turns by 360 degrees at 4 degrees a second, with four commands a second.
    assert!((200..500).contains(&turning), "{turning}");
    for (at_s, compared) in &run.on_path {
        if let OnPath::Due { deviation } = compared {
            assert!(deviation.degrees() < 0.7, "{deviation:?} at {at_s}");
        }
    }
}

#[test]
fn an_antenna_that_stands_is_off_its_path_once_it_should_have_arrived() {
    let (target, pass) = pass_where(|_, pass| (35.0..50.0).contains(&max_deg(pass)));
    let (drives, settings) = (azel((0.0, 360.0), 4.0, 0.0), settings(1.0, 0.2));
    let stuck = Metal { rate_deg_s: 0.0, ..metal(drives, settings) };
    let run = run_on(target, &pass, drives, settings, &stuck);
    let due = run.on_path.iter().filter(
        |(_, compared)| matches!(compared, OnPath::Due { deviation } if deviation.degrees() > 10.0),
    );
    assert!(due.count() > run.on_path.len() / 2);
}

#[test]
fn an_antenna_whose_drives_are_slower_than_known_is_on_its_way_while_it_comes_nearer() {
    let mut approach = Approach::default();
    let time = |second: i64| Timestamp::from_second(second).unwrap();
    // The axis turns at 0.4 degrees a second, and then gets stuck.
    let off_deg = |second: i64| 60.0 - 0.4 * second.min(60) as f64;
    let nearer: Vec<bool> =
        (0..120).map(|second| approach.comes_nearer(off_deg(second), time(second))).collect();
    assert!(nearer[5..60].iter().all(|nearer| *nearer) && !nearer[70..].contains(&true));
    // An error that grows, or shrinks by 0.1 degrees a second, is no approach.
    for rate_deg_s in [1.0, -0.1] {
        let mut approach = Approach::default();
        let off_deg = |second: i64| 40.0 + rate_deg_s * second as f64;
        assert!(!(0..120).any(|second| approach.comes_nearer(off_deg(second), time(second))));
    }
}

#[test]
fn near_the_zenith_the_axis_turns_early_and_catches_up() {
    let (target, pass) = pass_where(|_, pass| (87.5..88.5).contains(&max_deg(pass)));
    for rate_deg_s in [2.0, 6.0] {
        let drives = azel((0.0, 360.0), rate_deg_s, 0.0);
        let run = run(target.clone(), &pass, drives, settings(1.0, 0.2));
        let (rms, worst, _) = shown(&format!("zenith at {rate_deg_s} degrees a second"), run.stats);
        assert!(rms < 20.0 / rate_deg_s && worst < 60.0 / rate_deg_s, "{rms} {worst}");
    }
}

fn overtravel(mut drives: Drives) -> Drives {
    if let Mount::AzEl { elevation_to_deg, .. } = &mut drives.mount {
        *elevation_to_deg = 180.0;
    }
    drives
}

#[test]
fn over_the_zenith_a_pass_through_north_needs_no_slew() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && goes_through_north(propagator, pass)
    });
    let run = run(target, &pass, overtravel(azel((0.0, 360.0), 4.0, 0.0)), settings(1.0, 0.2));
    let (rms, worst, _) = shown("north, 0 to 360 and 180", run.stats);
    assert!(worst < 0.5 && rms < 0.2, "{rms} {worst}");
}

#[test]
fn over_the_zenith_no_pass_needs_a_fast_axis() {
    let (target, pass) = pass_where(|_, pass| (87.5..88.5).contains(&max_deg(pass)));
    for rate_deg_s in [2.0, 6.0] {
        let drives = overtravel(azel((0.0, 360.0), rate_deg_s, 0.0));
        let run = run(target.clone(), &pass, drives, settings(1.0, 0.2));
        let (rms, worst, _) = shown(&format!("zenith at {rate_deg_s} and to 180"), run.stats);
        assert!(rms < 0.5 && worst < 2.3, "{rms} {worst}");
    }
}

#[test]
fn a_rate_is_learned_on_the_way_to_a_pass() {
    let (target, pass) = pass_where(|_, pass| (87.5..88.5).contains(&max_deg(pass)));
    let settings = settings(1.0, 0.2);
    for mount in
        [azel, |range_deg, rate_deg_s, step_deg| overtravel(azel(range_deg, rate_deg_s, step_deg))]
    {
        let right = mount((0.0, 360.0), 4.0, 0.0);
        let (known_deg, ..) =
            shown("rate as set", run(target.clone(), &pass, right, settings).stats);
        for share in [0.5, 2.0] {
            let wrong = mount((0.0, 360.0), 4.0 * share, 0.0);
            let mut metal = metal(right, settings);
            metal.axes_deg[0] = (pass.aos.direction.azimuth_deg() + 120.0).rem_euclid(360.0);
            metal.goals_deg = metal.axes_deg;
            let run = run_on(target.clone(), &pass, wrong, settings, &metal);
            let (rms, ..) = shown(&format!("{share} of the rate set"), run.stats);
            assert!(rms < known_deg + 0.1, "{rms} {known_deg}");
        }
    }
}

#[test]
fn a_planner_keeps_the_side_for_the_pass() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && goes_through_north(propagator, pass)
    });
    let track = ProgramTrack::new(target, site(), vec![(pass.aos.time, pass.los.time)]);
    let drives = overtravel(azel((0.0, 360.0), 4.0, 0.0));
    let mut planner = Planner::new(track, drives, settings(1.0, 0.2), free()).unwrap();
    let mut axes_deg = [20.0, 10.0];
    let mut elevation_deg = |time: Timestamp| {
        let axes = axes_deg.map(|position| AxisNow { position_deg: Some(position), stands: true });
        let SetPoint { azimuth, elevation } =
            planner.update(time, axes).unwrap().unwrap().set_point;
        planner.drives.rates_deg_s[0] *= 2.0;
        axes_deg = [azimuth, elevation].map(|angle| angle.unwrap().degrees());
        axes_deg[1]
    };
    assert!(elevation_deg(add_seconds(pass.aos.time, 1.0)) > 90.0);
    // For the rest of the pass, plain would be as good, and another path is due.
    assert!(elevation_deg(add_seconds(pass.los.time, -10.0)) > 90.0);
}

#[test]
fn with_a_pointing_model_the_axes_are_sent_to_what_they_have_to_read() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && !goes_through_north(propagator, pass)
    });
    let track = ProgramTrack::new(target.clone(), site(), vec![(pass.aos.time, pass.los.time)]);
    let model = PointingModel {
        azimuth_offset_deg: 3.0,
        elevation_offset_deg: -1.0,
        tilt_north_deg: 0.7,
        sag_deg: 0.5,
        ..PointingModel::default()
    };
    let drives = azel((0.0, 360.0), 4.0, 0.0);
    let planner = Planner::new(track, drives, settings(1.0, 0.2), free()).unwrap();
    let mut planner = planner.with_model(model);
    let now = pass.tca.time;
    let course = Course::new(&target, site()).unwrap();
    // The antenna stands on the satellite itself, like without a model.
    let direction = course.direction(now).unwrap();
    let axes = [direction.azimuth_deg(), direction.elevation_deg()]
        .map(|position| AxisNow { position_deg: Some(position), stands: true });
    let sent = planner.update(now, axes).unwrap().unwrap().set_point;
    let reading = AzEl { azimuth: sent.azimuth.unwrap(), elevation: sent.elevation.unwrap() };
    let directions =
        (0..40).map(|tenth| course.direction(add_seconds(now, f64::from(tenth) * 0.1)));
    let off_deg = |reading: AzEl| {
        let beam = model.direction(reading);
        let separations =
            directions.clone().flatten().map(|other| other.separation(beam).degrees());
        separations.fold(f64::INFINITY, f64::min)
    };
    // A command covers the time until the next update.
    assert!(off_deg(reading) < 0.3, "{} beside {reading:?}", off_deg(reading));
    let on_satellite = course.direction(now).unwrap();
    let beam = model.direction(planner.demanded(now, TrackOffsets::NONE).unwrap());
    assert!(beam.separation(on_satellite).degrees() < 1e-6);
    assert_eq!(planner.to_sky(now, TrackOffsets::NONE), None, "the model alone tells it");
    let step = Offset::Azimuth(Angle::from_degrees(2.0));
    let offsets = TrackOffsets::NONE.plus(step).unwrap();
    let beam = model.direction(planner.demanded(now, offsets).unwrap());
    let sky = AzEl::from_enu(planner.to_sky(now, offsets).unwrap() * beam.to_enu());
    assert!(sky.separation(on_satellite).degrees() < 1e-6);
    assert!(beam.separation(sky).degrees() > 1.0);
}

#[test]
fn with_an_offset_the_antenna_is_sent_beside_its_target_and_without_it_back() {
    let (target, pass) = pass_where(|propagator, pass| {
        max_deg(pass) > 20.0 && max_deg(pass) < 60.0 && !goes_through_north(propagator, pass)
    });
    let track = ProgramTrack::new(target, site(), vec![(pass.aos.time, pass.los.time)]);
    let drives = azel((0.0, 360.0), 4.0, 0.0);
    let mut planner = Planner::new(track, drives, settings(1.0, 0.2), free()).unwrap();
    let on_course = [pass.tca.direction.azimuth_deg(), pass.tca.direction.elevation_deg()];
    let axes = on_course.map(|position| AxisNow { position_deg: Some(position), stands: true });
    let now = pass.tca.time;
    let sent = |planner: &mut Planner| {
        planner.forget_sent();
        planner.update(now, axes).unwrap().unwrap().set_point
    };
    let plain = sent(&mut planner);
    let step = Offset::Azimuth(Angle::from_degrees(3.0));
    planner.set_offsets(TrackOffsets::NONE.plus(step).unwrap());
    let set_point = sent(&mut planner);
    let turned = (set_point.azimuth.unwrap() - plain.azimuth.unwrap()).wrapped_180().degrees();
    // The path is longer, so the antenna meets the target at another time.
    assert!((2.5..3.5).contains(&turned), "{plain:?} {set_point:?}");
    let time = pass.tca.time;
    let demanded = planner.reachable(time).unwrap();
    assert!((demanded.azimuth - pass.tca.direction.azimuth).wrapped_180().degrees() > 2.9);
    planner.set_offsets(TrackOffsets::NONE);
    assert_eq!(sent(&mut planner), plain);
}

/// Returns bounds with a keep-out that permits a detour. It reaches from the ground to `around_deg`
/// above the middle of the pass, and by `around_deg` to both sides of it.
fn mast(target: &Target, pass: &Pass, around_deg: f64) -> (Bounds, KeepOut) {
    let course = Course::new(target, site()).unwrap();
    let halfway = course.direction(add_seconds(pass.aos.time, pass.duration_s() / 2.0)).unwrap();
    let (azimuth, top) = (halfway.azimuth_deg(), halfway.elevation_deg() + around_deg);
    let sides = [azimuth - around_deg, azimuth + around_deg];
    let corners = [(sides[0], -2.0), (sides[1], -2.0), (sides[1], top), (sides[0], top)];
    let mast = KeepOut {
        name: "mast".to_owned(),
        entered: Entered::GoRound,
        reason: String::new(),
        antenna: None,
        margin_deg: 1.0,
        zone: KeepOut::zone_of(&corners).unwrap(),
    };
    let mut antenna = Antenna::rc2000c("", "");
    antenna.limits.minimum_elevation_deg = 0.0;
    let station = Station { site: site(), keep_outs: vec![mast.clone()], ..Station::default() };
    (Bounds::new(&station, &antenna), mast)
}

#[test]
fn a_mast_in_the_middle_of_a_pass_is_gone_round_along_its_margin() {
    for (rate_deg_s, step_deg) in [(6.0, 0.0), (1.0, 0.0), (6.0, 1.0)] {
        let (target, pass) = pass_where(|propagator, pass| {
            max_deg(pass) > 20.0 && max_deg(pass) < 50.0 && !goes_through_north(propagator, pass)
        });
        let (bounds, mast) = mast(&target, &pass, 8.0);
        let course = Course::new(&target, site()).unwrap();
        let drives = azel((-180.0, 540.0), rate_deg_s, step_deg);
        let settings = settings(0.5, 0.2);
        let track = ProgramTrack::new(target, site(), vec![(pass.aos.time, pass.los.time)]);
        let planner = Planner::new(track, drives, settings, bounds.clone()).unwrap();
        let (mut nearest_deg, mut behind_s, mut worst_deg) = (f64::MAX, 0.0, 0.0_f64);
        run_planner(planner, &pass, settings, &metal(drives, settings), |now, axes_deg| {
            let direction = bounds.direction(axes_deg);
            if now < pass.aos.time {
                return;
            }
            nearest_deg =
                nearest_deg.min(bounds.at_time(now).nearest(direction).unwrap().angle.degrees());
            let target = course.direction(now).unwrap();
            let off_deg = target.separation(direction).degrees();
            if mast.zone.clearance(target) < Angle::from_degrees(8.0) {
                behind_s += TICK_S;
                // The margin, half a beam and the room add up to at most four degrees.
                worst_deg = worst_deg.max(off_deg);
            } else if rate_deg_s > 2.0 {
                assert!(off_deg < 1.5 + step_deg, "{off_deg} {now}");
            }
        });
        assert!(behind_s > 20.0, "{behind_s}");
        assert!(nearest_deg > -0.05, "{nearest_deg} with {rate_deg_s} in steps of {step_deg}");
        assert!(worst_deg < 14.0 + step_deg, "{worst_deg}");
    }
}

#[test]
fn what_sets_behind_a_mast_is_waited_for_at_its_edge() {
    let (target, pass) = pass_where(|_, pass| max_deg(pass) > 20.0 && max_deg(pass) < 50.0);
    let sets = AzEl { elevation: Angle::from_degrees(0.0), ..pass.los.direction };
    let corners = [-6.0, 6.0].map(|change| sets.azimuth_deg() + change);
    let corners = [(corners[0], -2.0), (corners[1], -2.0), (corners[1], 8.0), (corners[0], 8.0)];
    let (_, mast) = mast(&target, &pass, 8.0);
    let mast = KeepOut { zone: KeepOut::zone_of(&corners).unwrap(), ..mast };
    let station = Station { site: site(), keep_outs: vec![mast], ..Station::default() };
    let mut antenna = Antenna::rc2000c("", "");
    antenna.limits.minimum_elevation_deg = 0.0;
    let bounds = Bounds::new(&station, &antenna);
    let drives = azel((-180.0, 540.0), 6.0, 0.0);
    let settings = settings(0.5, 0.2);
    let track = ProgramTrack::new(target, site(), vec![(pass.aos.time, pass.los.time)]);
    let planner = Planner::new(track, drives, settings, bounds.clone()).unwrap();
    let mut last_deg = f64::MAX;
    run_planner(planner, &pass, settings, &metal(drives, settings), |now, axes_deg| {
        if now >= pass.aos.time {
            let clear = bounds.at_time(now).nearest(bounds.direction(axes_deg)).unwrap();
            last_deg = bounds.direction(axes_deg).separation(pass.los.direction).degrees();
            assert!(clear.angle.degrees() > -0.05, "{clear:?}");
        }
    });
    assert!(last_deg < 14.0, "{last_deg}");
}
