//! Random tests of the watch. `AZEL_CASES` and `AZEL_SEED` work as in `tests/safety_properties.rs`.

mod plant;

use std::time::Duration;

use self::plant::{Plant, PlantKind, PlantOrder, STEP_S};
use super::*;
use crate::driver::dice::Dice;

/// Returns the seeds: from the environment, or `cases` seeds from the default seed.
fn cases(cases: u64) -> std::ops::Range<u64> {
    let read = |name: &str| std::env::var(name).ok()?.parse().ok();
    let first = read("AZEL_SEED").unwrap_or(1);
    let cases = read("AZEL_CASES").unwrap_or(cases);
    println!("{cases} cases from seed {first}");
    first..first + cases
}

impl PlantKind {
    fn figures(self) -> AxisFigures {
        AxisFigures {
            resolution_deg: self.step_deg,
            sway_deg: self.sway_deg,
            arrives_within_deg: self.leaves_deg,
            wraps: self.wraps,
        }
    }
}

/// Axis, with the watch and the session that reads and commands it.
struct Trial {
    plant: Plant,
    watch: MotionWatch,
    dice: Dice,
    began: Instant,
    /// Send time of the query, with measurement and receive times of its answer, seconds.
    question: Option<(f64, f64, f64)>,
    reading: Option<f64>,
    next_s: f64,
    /// Times of the answers to motions; some answers never come.
    answers: Vec<(f64, bool)>,
    /// End of the time without a link, seconds.
    away_until_s: f64,
    still_s: f64,
    stops: bool,
    found: Vec<(f64, Evidence)>,
    /// `true` if the unit reports a turning axis.
    is_flagged: bool,
}

impl Trial {
    fn new(seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let kind = PlantKind::any(&mut dice);
        let (from_deg, to_deg) = kind.travel_deg;
        let plant = Plant::new(kind, dice.draw(from_deg, to_deg));
        Self {
            plant,
            watch: MotionWatch::new([kind.figures(); 2], &[AxisLessons::default(); 2]),
            dice,
            began: Instant::now(),
            question: None,
            reading: None,
            next_s: 0.0,
            answers: Vec::new(),
            away_until_s: 0.0,
            still_s: 0.0,
            stops: false,
            found: Vec::new(),
            is_flagged: false,
        }
    }

    /// Restarts the watch, which keeps only the lessons about the axis.
    fn restarts(&mut self) {
        let figures = self.plant.kind.figures();
        self.watch = MotionWatch::new([figures; 2], &self.watch.lessons());
        self.answers.clear();
    }

    fn time_at(&self, at_s: f64) -> Instant {
        self.began + Duration::try_from_secs_f64(at_s).unwrap()
    }

    fn now(&self) -> Instant {
        self.time_at(self.plant.now_s)
    }

    fn send(&mut self, order: PlantOrder) {
        let now = self.now();
        let lead = match order {
            PlantOrder::To(deg) if self.plant.kind.wraps => {
                // The unit counts like the station, so the reading contains the full turns.
                let reads_deg = self.plant.deg.rem_euclid(360.0);
                let deg = deg - (self.plant.deg - reads_deg);
                Some(Lead::EitherWay(deg))
            }
            PlantOrder::To(deg) => Some(Lead::To(deg)),
            PlantOrder::Run(share) => Some(Lead::ToEnd { is_up: share > 0.0 }),
            PlantOrder::Stop => None,
        };
        self.plant.send(order);
        if let Some(lead) = lead {
            self.watch.note_command([Some(lead), None], now);
            let is_answered = self.dice.chance(0.95);
            let after_s = self.dice.draw(0.01, 0.6);
            self.answers.push((self.plant.now_s + after_s, is_answered));
            self.stops = false;
        } else {
            (self.stops, self.still_s) = (true, 0.0);
        }
    }

    fn step(&mut self) {
        self.plant.step(&mut self.dice);
        let now_s = self.plant.now_s;
        let now = self.now();
        while let Some(index) = self.answers.iter().position(|(at_s, _)| *at_s <= now_s) {
            let (_, is_answered) = self.answers.remove(index);
            if is_answered { self.watch.note_acceptance(now) } else { self.watch.note_refusal() }
        }
        self.still_s = if self.plant.is_still() { self.still_s + STEP_S } else { 0.0 };
        if now_s < self.away_until_s {
            (self.question, self.reading) = (None, None);
            return;
        }
        if self.question.is_none() && now_s >= self.next_s {
            let late_s = if self.dice.chance(0.02) { 1.5 } else { 0.3 };
            let takes_s = self.dice.draw(0.01, late_s);
            let measured_s = now_s + self.dice.draw(0.0, takes_s);
            self.question = Some((now_s, measured_s, now_s + takes_s));
            self.next_s = now_s + self.plant.kind.poll_s;
        }
        let Some((asked_s, measured_s, received_s)) = self.question else { return };
        if now_s >= measured_s && self.reading.is_none() {
            self.reading = Some(self.plant.read(&mut self.dice));
        }
        if now_s < received_s {
            return;
        }
        self.question = None;
        let Some(angle_deg) = self.reading.take() else { return };
        if self.dice.chance(0.02) {
            return;
        }
        let is_turning = self.plant.is_driven() || self.is_flagged;
        let motion = if is_turning { AxisMotion::Unknown(1) } else { AxisMotion::Still };
        let (requested, received) = (self.time_at(asked_s), self.time_at(received_s));
        let drive = if is_turning { Drive::On } else { Drive::Off };
        let reading = AxisReading { angle_deg, motion, drive, requested, received };
        if let Some(foreign) = self.watch.take([Some(reading), None]) {
            self.found.push((now_s, foreign.evidence));
        }
        // Equal readings prove standstill.
        if self.stops && now_s - asked_s + 1.0 < self.still_s {
            self.stops = false;
            let proved = self.time_at(now_s);
            self.watch.note_standstill(proved);
        }
    }

    fn seconds(&mut self, seconds: f64) {
        let end_s = self.plant.now_s + seconds;
        while self.plant.now_s < end_s {
            self.step();
        }
    }

    fn wait_still(&mut self) {
        for _ in 0..60_000 {
            self.step();
            if self.plant.is_still() {
                return;
            }
        }
    }

    fn stop(&mut self) {
        self.send(PlantOrder::Stop);
        while self.stops {
            self.step();
        }
    }

    fn any_deg(&mut self) -> f64 {
        let (from_deg, to_deg) = self.plant.kind.travel_deg;
        self.dice.draw(from_deg + 3.0, to_deg - 3.0)
    }

    fn any_slew(&mut self) {
        let deg = self.any_deg();
        self.send(PlantOrder::To(deg));
        self.wait_still();
    }

    /// Tracks a target that moves no faster than the axis can.
    /// Returns the last target and its rate, degrees a second.
    fn track(&mut self, seconds: f64) -> (f64, f64) {
        let (from_deg, to_deg) = self.plant.kind.travel_deg;
        let max_deg_s = (self.plant.kind.rate_deg_s * 0.6).min(2.0);
        let mut rate_deg_s = self.dice.draw(-1.0, 1.0) * max_deg_s;
        let mut target_deg = self.plant.deg;
        let end_s = self.plant.now_s + seconds;
        while self.plant.now_s < end_s {
            if !(from_deg + 5.0..to_deg - 5.0).contains(&(target_deg + rate_deg_s * 4.0)) {
                rate_deg_s = -rate_deg_s;
            }
            target_deg += rate_deg_s;
            self.send(PlantOrder::To(target_deg));
            self.seconds(1.0);
        }
        (target_deg, rate_deg_s)
    }

    /// Makes the axis do one random action of an operator or a program.
    fn any_deed(&mut self) {
        match self.dice.below(7) {
            0 => self.seconds(30.0),
            1 => self.any_slew(),
            2 => {
                let deg = self.any_deg();
                self.send(PlantOrder::To(deg));
                let after_s = self.dice.draw(0.0, 10.0);
                self.seconds(after_s);
                self.stop();
            }
            3 => {
                let share = if self.dice.chance(0.5) { 1.0 } else { -1.0 };
                self.send(PlantOrder::Run(share));
                let after_s = self.dice.draw(0.1, 8.0);
                self.seconds(after_s);
                self.stop();
            }
            4 => {
                let seconds = self.dice.draw(20.0, 200.0);
                self.track(seconds);
            }
            5 => {
                // Send a new target before the axis arrives.
                let (deg, other_deg) = (self.any_deg(), self.any_deg());
                self.send(PlantOrder::To(deg));
                let after_s = self.dice.draw(0.0, 10.0);
                self.seconds(after_s);
                self.send(PlantOrder::To(other_deg));
                self.wait_still();
            }
            _ => {
                if self.dice.chance(0.5) {
                    let deg = self.any_deg();
                    self.send(PlantOrder::To(deg));
                }
                self.away_until_s = self.plant.now_s + self.dice.draw(1.0, 30.0);
                self.seconds(31.0);
            }
        }
    }
}

#[test]
fn an_axis_that_only_its_commands_move_is_nobody_elses() {
    let mut failed = Vec::new();
    for seed in cases(24) {
        let mut scene = Trial::new(seed);
        while scene.plant.now_s < 3600.0 && scene.found.is_empty() {
            scene.any_deed();
        }
        if let Some(found) = scene.found.first() {
            failed.push(seed);
            if failed.len() < 4 {
                println!("seed {seed}: {found:?} at {} of {:?}", scene.plant.deg, scene.plant.kind);
            }
        }
    }
    assert!(failed.is_empty(), "{} failed: {failed:?}", failed.len());
}

/// Push: somebody turns the axis and holds it for at least three seconds.
struct Push {
    by_deg: f64,
    rate_deg_s: f64,
    holds_s: f64,
}

impl Push {
    fn any(scene: &mut Trial, way: f64) -> Self {
        let PlantKind { step_deg, noise_deg, sway_deg, .. } = scene.plant.kind;
        let min_deg = 2.5 * step_deg + 2.0 * noise_deg + sway_deg;
        let by_deg = (min_deg + scene.dice.draw(0.0, 30.0)) * way;
        Self { by_deg, rate_deg_s: scene.dice.draw(2.0, 20.0), holds_s: scene.dice.draw(3.0, 20.0) }
    }

    /// Applies the push. Returns the time until the watch finds it, seconds.
    fn happens(
        self,
        scene: &mut Trial,
        from_deg: f64,
        within_s: f64,
        mut each_s: impl FnMut(&mut Trial),
    ) -> Option<f64> {
        scene.found.clear();
        let began_s = scene.plant.now_s;
        let turns_s = self.by_deg.abs() / self.rate_deg_s;
        let mut next_s = began_s;
        while scene.plant.now_s < began_s + turns_s + within_s {
            let since_s = scene.plant.now_s - began_s;
            let is_held = since_s < turns_s + self.holds_s;
            let share = (since_s / turns_s).min(1.0);
            scene.plant.held_deg = is_held.then_some(from_deg + self.by_deg * share);
            if scene.plant.now_s >= next_s {
                next_s += 1.0;
                each_s(scene);
            }
            scene.step();
            if let Some((at_s, _)) = scene.found.first() {
                return Some(at_s - began_s - turns_s);
            }
        }
        None
    }
}

#[test]
fn one_that_is_pushed_at_rest_is_found_within_ten_seconds() {
    let (mut pushes, mut missed) = (0, Vec::new());
    for seed in cases(60) {
        let mut scene = Trial::new(seed);
        for _ in 0..8 {
            scene.any_slew();
            scene.seconds(20.0);
        }
        if scene.dice.chance(0.5) {
            scene.stop();
        }
        scene.seconds(20.0);
        let way = if scene.dice.chance(0.5) { 1.0 } else { -1.0 };
        let (from_deg, push) = (scene.plant.deg, Push::any(&mut scene, way));
        scene.is_flagged = true;
        pushes += 1_usize;
        // A drive that holds its position turns the axis back.
        if push.happens(&mut scene, from_deg, 10.0, |_| ()).is_none() {
            missed.push(seed);
        }
    }
    println!("{} of {pushes} missed: {missed:?}", missed.len());
    assert!(missed.len() * 100 <= pushes.max(100), "{missed:?}");
}

/// Returns the seeds of pushes by more than `beyond_deg` that the watch misses in a track.
fn missed_pushes(seeds: std::ops::Range<u64>, beyond_deg: f64) -> Vec<u64> {
    let is_missed = |seed: &u64| {
        let mut scene = Trial::new(*seed);
        scene.plant.kind.follows_well();
        // Let the watch learn for several days.
        for _ in 0..8 {
            scene.seconds(20.0);
            scene.any_slew();
            scene.seconds(20.0);
            scene.track(100.0);
            scene.stop();
        }
        scene.restarts();
        scene.any_slew();
        let (mut target_deg, rate_deg_s) = scene.track(60.0);
        let way = if scene.dice.chance(0.5) { 1.0 } else { -1.0 };
        let push = Push::any(&mut scene, way);
        // Push the axis beyond every target that the drive may still approach.
        let targets_deg = scene.plant.targets_deg().into_iter().chain([scene.plant.deg]);
        let furthest_deg = targets_deg.map(|deg| deg * way).fold(f64::MIN, f64::max) * way;
        let by_deg = furthest_deg + (push.by_deg.abs() + beyond_deg) * way - scene.plant.deg;
        let push = Push { by_deg, ..push };
        let from_deg = scene.plant.deg;
        let found = push.happens(&mut scene, from_deg, 15.0, |scene| {
            target_deg += rate_deg_s;
            scene.send(PlantOrder::To(target_deg));
        });
        found.is_none()
    };
    seeds.filter(is_missed).collect()
}

#[test]
fn one_that_is_pushed_far_in_a_track_is_found_within_fifteen_seconds() {
    let seeds = cases(200);
    let pushes = seeds.end - seeds.start;
    let missed = missed_pushes(seeds, 15.0);
    println!("{} of {pushes} missed: {missed:?}", missed.len());
    // Smaller pushes hide in the normal overshoot of a drive.
    assert!(missed.len() as u64 * 100 <= pushes.max(100), "{missed:?}");
}

/// Returns the evidence from a standing axis, read once a second, whose unit reports `drives`.
fn collect_evidence(watch: &mut MotionWatch, start: Instant, drives: &[Drive]) -> Vec<Evidence> {
    let mut found = Vec::new();
    for (second, drive) in (1..).zip(drives) {
        let requested = start + Duration::from_secs(second);
        let (motion, received) = (AxisMotion::Still, requested + Duration::from_millis(50));
        let reading = AxisReading { angle_deg: 10.0, motion, drive: *drive, requested, received };
        found.extend(watch.take([Some(reading), None]).map(|foreign| foreign.evidence));
    }
    found
}

#[test]
fn a_unit_that_reports_a_jog_or_a_runaway_accuses_by_its_word() {
    let figures =
        AxisFigures { resolution_deg: 0.1, sway_deg: 0.5, arrives_within_deg: 0.3, wraps: false };
    let start = Instant::now();
    let evidence = |drives: &[Drive]| {
        collect_evidence(
            &mut MotionWatch::new([figures; 2], &[AxisLessons::default(); 2]),
            start,
            drives,
        )
    };
    assert_eq!(
        evidence(&[Drive::Off, Drive::Jogged, Drive::Jogged, Drive::Jogged]),
        [Evidence::Jogged]
    );
    assert_eq!(evidence(&[Drive::Runaway; 60]), [Evidence::Runaway], "once, however long it lasts");
    assert_eq!(evidence(&[Drive::Off, Drive::Jogged, Drive::Off, Drive::Jogged, Drive::On]), []);

    // Jog the axis until the end of the jog is proved.
    let mut watch = MotionWatch::new([figures; 2], &[AxisLessons::default(); 2]);
    assert_eq!(collect_evidence(&mut watch, start, &[Drive::Off]), []);
    let later = start + Duration::from_secs(10);
    watch.note_command([Some(Lead::ToEnd { is_up: true }), None], later);
    watch.note_acceptance(later);
    assert_eq!(
        collect_evidence(&mut watch, later, &[Drive::Jogged, Drive::Jogged, Drive::Jogged]),
        []
    );
    watch.note_standstill(later + Duration::from_secs(4));
    let later = later + Duration::from_secs(10);
    assert_eq!(
        collect_evidence(&mut watch, later, &[Drive::Jogged, Drive::Jogged]),
        [Evidence::Jogged]
    );
}
