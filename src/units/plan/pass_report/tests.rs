//! Tests of reports of passes with known errors.

use jiff::{SignedDuration, Timestamp};

use super::{
    Breaks, FlownOffsets, LossCause, LostStretch, MeasuredPosition, PassReport, PassVerdict,
    TrackedPass,
};
use crate::{
    astro::{
        Angle, AzEl, Offset, Site, TrackOffsets,
        time::{add_seconds, seconds_between},
    },
    orbit::{Pass, PassSearch, Propagator, bundled, passes},
    plan::{Loss, MountLimits, Trackability},
    station::{Mount, Station},
};

const ISS: u32 = 25_544;
const STEP_S: f64 = 0.2;

struct Scene {
    propagator: Propagator,
    site: Site,
    pass: Pass,
    breaks: Breaks,
}

impl Scene {
    /// Returns a pass of the ISS with a high elevation.
    fn new() -> Self {
        let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
        let site = Station::default().site;
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let search = PassSearch {
            aos_elevation: Angle::from_degrees(5.0),
            floor: Angle::from_degrees(40.0),
            ..PassSearch::new(site, start, add_seconds(start, 3.0 * 86_400.0))
        };
        let pass = passes(&propagator, &search, &|| false)[0];
        Self { propagator, site, pass, breaks: Breaks::default() }
    }

    fn flown_pass(&self) -> TrackedPass<'_> {
        TrackedPass {
            propagator: &self.propagator,
            site: self.site,
            start: self.pass.aos.time,
            end: self.pass.los.time,
            limits: MountLimits {
                mount: Mount::AzEl {
                    azimuth_from_deg: 0.0,
                    azimuth_to_deg: 540.0,
                    elevation_from_deg: 0.0,
                    elevation_to_deg: 90.0,
                },
                maximum_rate_deg_s: 10.0,
                half_beam: Angle::from_degrees(1.0),
                has_elevation: true,
                min_elevation: Angle::from_degrees(5.0),
            },
            trackability: Trackability::Whole,
            ended: None,
            breaks: &self.breaks,
        }
    }

    fn time(&self, second: f64) -> Timestamp {
        add_seconds(self.pass.aos.time, second)
    }

    /// Returns the direction of an antenna with an azimuth error of `azimuth_deg`, degrees.
    fn shifted(&self, time: Timestamp, azimuth_deg: f64) -> AzEl {
        let direction = self.direction(time);
        AzEl { azimuth: direction.azimuth + Angle::from_degrees(azimuth_deg), ..direction }
    }

    fn direction(&self, time: Timestamp) -> AzEl {
        self.propagator.look_from(self.site, time).unwrap().direction
    }

    /// Returns positions throughout the pass. `points` returns the direction of the antenna at each
    /// second, or `None`.
    fn flown(&self, points: impl Fn(f64, Timestamp) -> Option<AzEl>) -> Vec<MeasuredPosition> {
        let (start, end) = (self.pass.aos.time, self.pass.los.time);
        let count = (seconds_between(start, end) / STEP_S) as u32;
        let time = |step: u32| add_seconds(start, f64::from(step) * STEP_S);
        let flown = (0..=count).filter_map(|step| {
            let direction = points(f64::from(step) * STEP_S, time(step))?;
            Some(MeasuredPosition { time: time(step), pointing: direction.into() })
        });
        flown.collect()
    }

    fn report(&self, points: impl Fn(f64, Timestamp) -> Option<AzEl>) -> PassReport {
        self.flown_pass().report(&self.flown(points))
    }

    fn duration_s(&self) -> f64 {
        self.pass.duration_s()
    }
}

fn causes(report: &PassReport) -> Vec<LossCause> {
    report.losses.iter().map(|loss| loss.cause).collect()
}

fn is_close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

#[test]
fn an_antenna_on_its_satellite_has_a_good_pass_without_losses() {
    let scene = Scene::new();
    let report = scene.report(|_, time| Some(scene.direction(time)));
    assert_eq!((report.verdict, &*report.losses), (PassVerdict::Good, &[][..]));
    let whole_s = scene.duration_s();
    for seconds in [report.counted_s, report.known_s, report.in_beam_s] {
        assert!(is_close(seconds, whole_s, 0.01), "{seconds} of {whole_s}");
    }
    assert!(report.rms.unwrap().off_deg < 1e-9);
}

#[test]
fn a_late_antenna_is_behind_along_the_way_and_not_across_it() {
    let scene = Scene::new();
    let report = scene.report(|_, time| Some(scene.direction(add_seconds(time, -0.5))));
    let rms = report.rms.unwrap();
    assert!(is_close(rms.along_deg, rms.off_deg, 1e-3), "{rms:?}");
    assert!(rms.across_deg < 0.01 * rms.along_deg, "{rms:?}");
    let worst = report.worst.unwrap();
    assert!(worst.error.along_deg < 0.0, "{worst:?}");
    // A satellite is fastest at its nearest point.
    assert!(is_close(seconds_between(worst.time, scene.pass.tca.time), 0.0, 5.0));
}

#[test]
fn an_error_of_elevation_is_told_as_one() {
    let scene = Scene::new();
    let report = scene.report(|_, time| {
        let mut direction = scene.direction(time);
        direction.elevation = direction.elevation + Angle::from_degrees(0.3);
        Some(direction)
    });
    let rms = report.rms.unwrap();
    assert!(is_close(rms.elevation_deg, 0.3, 1e-9) && is_close(rms.azimuth_deg, 0.0, 1e-9));
    assert!(is_close(rms.off_deg, 0.3, 1e-6));
    assert!(is_close(rms.along_deg.hypot(rms.across_deg), 0.3, 1e-4), "{rms:?}");
    assert_eq!(report.verdict, PassVerdict::Good);
}

#[test]
fn a_stretch_without_positions_is_not_known_and_makes_a_pass_poor() {
    let scene = Scene::new();
    let gap = |second: f64| (100.0..112.0).contains(&second);
    let report = scene.report(|second, time| (!gap(second)).then(|| scene.direction(time)));
    assert_eq!(causes(&report), [LossCause::NotMeasured]);
    assert!(is_close(report.losses[0].seconds(), 12.0, 2.0 * STEP_S));
    assert!(is_close(report.counted_s - report.known_s, 12.0, 2.0 * STEP_S));
    assert_eq!(report.verdict, PassVerdict::Poor);
    let short = |second: f64| (100.0..103.0).contains(&second);
    let report = scene.report(|second, utc| (!short(second)).then(|| scene.direction(utc)));
    assert_eq!(report.verdict, PassVerdict::Fair, "3 s of it are not known");
}

#[test]
fn what_the_mount_had_to_lose_is_no_fault_and_no_excuse_for_more() {
    let scene = Scene::new();
    let shifted_after = |time: Timestamp| {
        let mut direction = scene.direction(time);
        direction.elevation = direction.elevation + Angle::from_degrees(20.0);
        direction
    };
    let report = |lost: std::ops::Range<f64>| {
        let measured = scene.flown(|second, utc| {
            Some(if lost.contains(&second) { shifted_after(utc) } else { scene.direction(utc) })
        });
        let [start, end] = [150.0, 158.0].map(|second| scene.time(second));
        let trackability = Trackability::Loses { seconds: 8.0, loss: Loss::Overhead, start, end };
        TrackedPass { trackability, ..scene.flown_pass() }.report(&measured)
    };
    let planned = report(150.0..158.0);
    assert_eq!(
        (planned.verdict, causes(&planned)),
        (PassVerdict::Good, vec![LossCause::RateOfMount])
    );
    let more = report(150.0..250.0);
    assert_eq!((more.verdict, causes(&more)), (PassVerdict::Poor, vec![LossCause::OutsideBeam]));
    let elsewhere = report(220.0..228.0);
    assert_eq!(causes(&elsewhere), [LossCause::OutsideBeam], "the mount loses nothing there");
}

/// An axis at its limit reports no angle, so no position lies beyond it.
#[test]
fn what_is_out_of_reach_is_no_fault_whatever_was_measured_there() {
    let scene = Scene::new();
    // Until TCA the satellite is on one side, and the mount ends slightly further.
    let middle_s = seconds_between(scene.pass.aos.time, scene.pass.tca.time) + 10.0;
    let [begin, end] = [0.0, middle_s]
        .map(|second| scene.direction(add_seconds(scene.pass.aos.time, second)).azimuth);
    let way_deg = (end - begin).wrapped_180().degrees();
    let (from_deg, to_deg) = if way_deg > 0.0 {
        (begin.degrees() - 1.0, begin.degrees() + way_deg)
    } else {
        (end.degrees(), end.degrees() - way_deg + 1.0)
    };
    let mount = Mount::AzEl {
        azimuth_from_deg: from_deg,
        azimuth_to_deg: to_deg,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    let tracked = scene.flown_pass();
    let lost_s = scene.duration_s() - middle_s;
    let (start, stop_time) = (scene.time(middle_s), scene.pass.los.time);
    let trackability =
        Trackability::Loses { seconds: lost_s, loss: Loss::OutOfReach, start, end: stop_time };
    let limits = MountLimits { mount, ..tracked.limits };
    let tracked = TrackedPass { limits, trackability, ..tracked };
    let at_its_end = scene.direction(add_seconds(scene.pass.aos.time, middle_s));
    for stays_in_sight in [false, true] {
        let flown = scene.flown(|second, time| match second {
            second if second < middle_s => Some(scene.direction(time)),
            _ => stays_in_sight.then_some(at_its_end),
        });
        let report = tracked.report(&flown);
        assert_eq!(report.verdict, PassVerdict::Good, "{report:?}");
        assert_eq!(causes(&report), [LossCause::OutOfReach]);
        assert!(is_close(report.losses[0].seconds(), lost_s, 3.0), "{report:?}");
        let worst = report.worst.unwrap().error.off_deg;
        assert!(worst < 0.1, "{worst}: what is out of reach says nothing of the pointing");
    }
    // The mount does not explain a pointing error that continues to the end of the reach.
    let wanders = tracked.report(&scene.flown(|second, utc| match second {
        second if second < middle_s - 60.0 => Some(scene.direction(utc)),
        second if second < middle_s => {
            let mut direction = scene.direction(utc);
            direction.elevation = direction.elevation + Angle::from_degrees(20.0);
            Some(direction)
        }
        _ => Some(at_its_end),
    }));
    assert_eq!(wanders.verdict, PassVerdict::Poor);
    assert_eq!(causes(&wanders), [LossCause::OutsideBeam, LossCause::OutOfReach]);
    // A missing position within the reach still counts as a loss.
    let idle = tracked.report(
        &scene.flown(|second, time| (second < middle_s / 2.0).then(|| scene.direction(time))),
    );
    assert_eq!(idle.verdict, PassVerdict::Poor);
    assert_eq!(causes(&idle), [LossCause::NotMeasured, LossCause::OutOfReach]);
}

#[test]
fn seconds_are_lost_once_also_where_positions_come_back_outside_of_the_beam() {
    let scene = Scene::new();
    let report = scene.report(|second, time| match second {
        _ if (100.0..106.0).contains(&second) => None,
        _ if (106.0..110.0).contains(&second) => {
            let mut direction = scene.direction(time);
            direction.elevation = direction.elevation + Angle::from_degrees(20.0);
            Some(direction)
        }
        _ => Some(scene.direction(time)),
    });
    assert_eq!(causes(&report), [LossCause::NotMeasured, LossCause::OutsideBeam]);
    let lost_s: f64 = report.losses.iter().map(LostStretch::seconds).sum();
    assert!(is_close(lost_s, 10.0, 3.0 * STEP_S), "{:?}", report.losses);
}

#[test]
fn what_came_after_the_end_of_the_program_is_not_known_and_nobody_s_fault() {
    let scene = Scene::new();
    let ended = Some(add_seconds(scene.pass.aos.time, 100.0));
    let report = |is_off: fn(f64) -> bool| {
        let measured = scene.flown(|second, time| {
            let mut direction = scene.direction(time);
            if is_off(second) {
                direction.elevation = direction.elevation + Angle::from_degrees(20.0);
            }
            (second <= 100.0).then_some(direction)
        });
        TrackedPass { ended, ..scene.flown_pass() }.report(&measured)
    };
    let on = report(|_| false);
    assert_eq!((on.verdict, causes(&on)), (PassVerdict::Poor, vec![LossCause::ProgramEnded]));
    assert!(is_close(on.in_beam_s, 100.0, STEP_S) && is_close(on.known_s, 100.0, STEP_S));
    let after_s = scene.duration_s() - 100.0;
    assert!(is_close(on.losses[0].seconds(), after_s, 1e-3), "{:?}", on.losses);
    let left = report(|second| second > 40.0);
    assert_eq!(causes(&left), [LossCause::OutsideBeam, LossCause::ProgramEnded]);
}

#[test]
fn what_comes_late_leaves_early_or_wanders_is_told_apart() {
    let scene = Scene::new();
    let end_s = scene.duration_s();
    // The antenna turns by 5 degrees a second, and arrives after 20 s.
    let late =
        scene.report(|second, time| Some(scene.shifted(time, -5.0 * (20.0 - second).max(0.0))));
    assert_eq!(causes(&late), [LossCause::LateStart]);
    assert!((19.0..20.0).contains(&late.losses[0].seconds()), "{:?}", late.losses);
    let early = scene
        .report(|second, utc| Some(scene.shifted(utc, 5.0 * (second - end_s + 20.0).max(0.0))));
    assert_eq!(causes(&early), [LossCause::EarlyEnd]);
    assert!((19.0..20.0).contains(&early.losses[0].seconds()), "{:?}", early.losses);
    let report_off = |when: std::ops::Range<f64>| {
        scene.report(|second, moment| {
            Some(if when.contains(&second) {
                scene.shifted(moment, 40.0)
            } else {
                scene.direction(moment)
            })
        })
    };
    let wanders = report_off(100.0..104.0);
    assert_eq!(causes(&wanders), [LossCause::OutsideBeam]);
    assert_eq!(wanders.verdict, PassVerdict::Fair);
    assert_eq!(report_off(100.0..200.0).verdict, PassVerdict::Poor);
    let unmeasured = scene.report(|_, _| None);
    assert_eq!((unmeasured.verdict, unmeasured.known_s), (PassVerdict::Poor, 0.0));
    assert_eq!(causes(&unmeasured), [LossCause::NotMeasured]);
}

/// An antenna on an offset track has arrived, however long its error lasts.
#[test]
fn an_antenna_beside_its_satellite_has_a_pointing_error_and_is_not_late() {
    let scene = Scene::new();
    for azimuth_deg in [4.0, -15.0] {
        let pass_report = scene.report(|_, time| Some(scene.shifted(time, azimuth_deg)));
        assert_eq!(causes(&pass_report), [LossCause::OutsideBeam], "{azimuth_deg}");
        assert!(is_close(pass_report.losses[0].seconds(), scene.duration_s(), 1e-3));
        // Repeat with the resolution of a position sensor.
        let coarse = scene.report(|_, utc| {
            let AzEl { azimuth, elevation } = scene.shifted(utc, azimuth_deg);
            let round = |angle: Angle| Angle::from_degrees((angle.degrees() * 10.0).round() / 10.0);
            Some(AzEl { azimuth: round(azimuth), elevation: round(elevation) })
        });
        assert_eq!(causes(&coarse), [LossCause::OutsideBeam], "{azimuth_deg}");
    }
    // The antenna approaches from afar, and stays beside the satellite.
    let way_deg = |second: f64| 4.0 + 3.0 * (30.0 - second).max(0.0);
    let late = scene.report(|second, time| Some(scene.shifted(time, way_deg(second))));
    assert_eq!(causes(&late), [LossCause::LateStart, LossCause::OutsideBeam]);
    assert!(is_close(late.losses[0].seconds(), 30.0, 1.0), "{:?}", late.losses);
}

#[test]
fn an_antenna_that_never_reached_its_satellite_was_late_all_the_time() {
    let scene = Scene::new();
    let opposite = scene.shifted(scene.pass.tca.time, 180.0);
    let stands = scene.report(|_, _| Some(opposite));
    assert_eq!((stands.verdict, stands.in_beam_s), (PassVerdict::Poor, 0.0));
    assert_eq!(causes(&stands), [LossCause::LateStart]);
    // The antenna turns away from the direction of the satellite's motion.
    let [before, after] = [0.0, 60.0].map(|second| scene.direction(scene.time(second)).azimuth);
    let rate_deg_s = -0.1 * (after - before).wrapped_180().degrees().signum();
    let turns = scene.report(|second, time| {
        let azimuth = opposite.azimuth + Angle::from_degrees(rate_deg_s * second);
        Some(AzEl { azimuth, ..scene.direction(time) })
    });
    assert_eq!(causes(&turns), [LossCause::LateStart]);
}

/// The azimuth axis turns round before the end of the pass, or returns after the start of the pass.
#[test]
fn what_the_mount_had_to_lose_at_an_end_of_the_pass_is_no_fault() {
    let scene = Scene::new();
    let end_s = scene.duration_s();
    for (first_s, last_s) in [(0.0, 20.0), (end_s - 20.0, end_s)] {
        let (start, end) = (scene.time(first_s), scene.time(last_s));
        let trackability = Trackability::Loses { seconds: 20.0, loss: Loss::Slew, start, end };
        let turns = scene.flown(|second, time| {
            let away_s = (second - first_s).min(last_s - second).max(0.0);
            let away_s = if first_s == 0.0 { (last_s - second).max(0.0) } else { away_s };
            Some(scene.shifted(time, 12.0 * away_s))
        });
        let report = TrackedPass { trackability, ..scene.flown_pass() }.report(&turns);
        assert_eq!((report.verdict, causes(&report)), (PassVerdict::Good, vec![LossCause::Slew]));
    }
}

#[test]
fn only_what_was_commanded_is_judged_and_the_rest_is_told() {
    let mut scene = Scene::new();
    for second in 0..400 {
        let is_commanded = (100..200).contains(&second) || (250..390).contains(&second);
        scene.breaks.note_commanded(scene.time(f64::from(second)), is_commanded);
    }
    let tracked = scene.flown_pass();
    let flown = scene.flown(|second, time| {
        let way_deg = 6.0 * (260.0 - second).max(0.0);
        Some(if second < 200.0 { scene.direction(time) } else { scene.shifted(time, way_deg) })
    });
    let commanded: Vec<MeasuredPosition> =
        flown.into_iter().filter(|flown| scene.breaks.was_commanded(flown.time)).collect();
    let report = tracked.report(&commanded);
    let expected = [
        LossCause::NotCommanded,
        LossCause::NotCommanded,
        LossCause::LateStart,
        LossCause::NotCommanded,
    ];
    assert_eq!(causes(&report), expected);
    let seconds: Vec<f64> = report.losses.iter().map(LostStretch::seconds).collect();
    for (lost_s, wanted_s) in seconds.iter().zip([100.0, 51.0, 10.0, scene.duration_s() - 389.0]) {
        assert!(is_close(*lost_s, wanted_s, 0.5), "{seconds:?}");
    }
    assert!(is_close(report.known_s, 99.0 + 139.0, 0.5), "{}", report.known_s);
}

#[test]
fn between_two_positions_the_beam_ends_where_the_error_crosses_it() {
    let scene = Scene::new();
    // The satellite enters the beam, which is 1 degree wide to each side, at 20 s.
    let flown: Vec<MeasuredPosition> = (0..400)
        .map(|step| {
            let second = 1.9 * f64::from(step);
            let time = scene.time(second);
            let mut direction = scene.direction(time);
            let off_deg = (1.0 + 0.2 * (20.0 - second)).max(0.0);
            direction.elevation = direction.elevation + Angle::from_degrees(off_deg);
            MeasuredPosition { time, pointing: direction.into() }
        })
        .take_while(|flown| flown.time <= scene.pass.los.time)
        .collect();
    let report = scene.flown_pass().report(&flown);
    assert!(is_close(report.losses[0].seconds(), 20.0, 0.01), "{:?}", report.losses);
    let lost_s: f64 = report.losses.iter().map(LostStretch::seconds).sum();
    assert!(is_close(report.in_beam_s + lost_s, scene.duration_s(), 1e-6));
}

#[test]
fn a_lost_link_and_a_stop_are_told_as_what_they_are() {
    let mut scene = Scene::new();
    let time = |scene: &Scene, second: u32| add_seconds(scene.pass.aos.time, f64::from(second));
    let flown = |scene: &Scene| {
        let left = scene.direction(add_seconds(scene.pass.aos.time, 201.0));
        scene.report(|second, utc| match second {
            _ if (100.0..130.0).contains(&second) => None,
            _ if second >= 201.0 => Some(left),
            _ => Some(scene.direction(utc)),
        })
    };
    let unknown = flown(&scene);
    assert_eq!(causes(&unknown), [LossCause::NotMeasured, LossCause::EarlyEnd]);
    for second in 0..400 {
        let lost_since = (103..130).contains(&second).then(|| time(&scene, 103));
        scene.breaks.note_link(time(&scene, second), lost_since);
    }
    let mut late = scene.breaks.clone();
    scene.breaks.note_stop(time(&scene, 200), LossCause::Stopped);
    let pass_report = flown(&scene);
    assert_eq!(causes(&pass_report), [LossCause::LinkLost, LossCause::Stopped]);
    assert!(
        is_close(pass_report.losses[0].seconds(), 30.0, 2.0 * STEP_S),
        "{:?}",
        pass_report.losses
    );
    assert_eq!(pass_report.verdict, PassVerdict::Poor);
    // STOP does not explain an earlier loss.
    late.note_stop(time(&scene, 260), LossCause::Stopped);
    scene.breaks = late;
    let flown_report = flown(&scene);
    let all = [LossCause::LinkLost, LossCause::EarlyEnd, LossCause::Stopped];
    assert_eq!(causes(&flown_report), all);
    assert!(is_close(flown_report.losses[1].seconds(), 58.0, 2.0), "{:?}", flown_report.losses);
}

#[test]
fn what_an_outage_ended_is_lost_to_the_link_until_the_end() {
    let mut scene = Scene::new();
    let left = scene.direction(add_seconds(scene.pass.aos.time, 100.0));
    for second in 0..400 {
        let now = add_seconds(scene.pass.aos.time, f64::from(second));
        let is_lost = (103..130).contains(&second);
        let lost_since = is_lost.then(|| add_seconds(scene.pass.aos.time, 100.0));
        scene.breaks.note_link(now, lost_since);
        // Azel asks the operator once the link is back.
        scene.breaks.note_commanded(now, second <= 131);
    }
    let report = scene.report(|second, time| match second {
        _ if (100.0..130.0).contains(&second) => None,
        _ if second >= 130.0 => Some(left),
        _ => Some(scene.direction(time)),
    });
    let lost_s: f64 = report.losses.iter().map(LostStretch::seconds).sum();
    let to_link = report.losses.iter().filter(|lost| lost.cause == LossCause::LinkLost);
    let link_s: f64 = to_link.map(LostStretch::seconds).sum();
    assert!(lost_s - link_s < 3.0, "{:?}", report.losses);
}

#[test]
fn what_the_watch_stopped_an_antenna_for_is_the_cause_of_what_follows() {
    use LossCause::{Forbidden, ForeignHands, GivenUp, NoEffect};
    for loss_cause in [NoEffect, GivenUp, ForeignHands, Forbidden] {
        let mut scene = Scene::new();
        let stop = add_seconds(scene.pass.aos.time, 200.0);
        let left = scene.direction(stop);
        for second in 0..=200 {
            let now = add_seconds(scene.pass.aos.time, f64::from(second));
            scene.breaks.note_commanded(now, true);
        }
        scene.breaks.note_stop(stop, loss_cause);
        scene.breaks.note_commanded(add_seconds(stop, 1.0), false);
        let report = scene
            .report(|second, time| Some(if second < 200.0 { scene.direction(time) } else { left }));
        assert_eq!(causes(&report), [loss_cause]);
    }
}

#[test]
fn an_offset_is_no_error_and_what_the_antenna_misses_beside_it_is() {
    let scene = Scene::new();
    let offset = |step| TrackOffsets::NONE.plus(step).unwrap();
    let [steps, half] = [
        [
            Offset::Azimuth(Angle::from_degrees(3.0)),
            Offset::Across(Angle::from_degrees(2.0)),
            Offset::Time(SignedDuration::from_secs(5)),
        ],
        [Offset::Azimuth(Angle::from_degrees(-2.0)); 3],
    ];
    let changed_at = scene.pass.tca.time;
    for (first, second) in steps.into_iter().zip(half) {
        let mut offsets = FlownOffsets::default();
        offsets.note(scene.pass.aos.time, offset(first));
        offsets.note(scene.pass.tca.time, offset(second));
        offsets.note(scene.pass.los.time, offset(second));
        assert_eq!(offsets.changes().len(), 2);
        let demanded = |time| {
            let now = offset(if time < changed_at { first } else { second });
            now.demanded(time, |utc| Some(scene.direction(utc))).unwrap()
        };
        let flown = |by_deg: f64| {
            let flown = scene.flown(|_, time| Some(demanded(time).displaced(30.0, by_deg)));
            let shifted =
                |flown: MeasuredPosition| offsets.taken_off(&scene.propagator, scene.site, flown);
            flown.into_iter().map(shifted).collect::<Vec<_>>()
        };
        let report = scene.flown_pass().report(&flown(0.0));
        assert!(report.rms.unwrap().off_deg < 1e-6, "{:?}", report.rms);
        let report = scene.flown_pass().report(&flown(0.5));
        let worst = report.worst.unwrap().error.off_deg;
        assert!(is_close(worst, 0.5, 1e-6), "{worst}");
    }
}
