//! A random station, one simulated unit with its antenna, and the line between them.

use std::{
    future::Future,
    io,
    panic::AssertUnwindSafe,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};

use azel::{
    astro::{Angle, AzEl, time},
    clock::Clock,
    controller::{
        rc2000c::Calibration,
        rotator_genius::{ROTATORS, Rotators},
    },
    driver::{AntennaHandle, Command, Dial, Event, Session, Snapshot, Stream},
    plan::{Barrier, Bounds},
    protocol::{rotator_genius::WholeDegrees, satrak::encode},
    sim::{rc2000c, rotator_genius, satrak},
    station::{Antenna, CountLine, CountPoint, Entered, KeepOut, Mount, Station, SunAvoidance},
};
use jiff::Timestamp;
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::{Instant, sleep},
};

/// How often the metal is looked at.
pub(super) const LOOK: Duration = Duration::from_millis(50);
/// No case needs more readings of the clock than this.
const MOST_READINGS: u64 = 2_000_000;

/// Numbers that look random and repeat with their seed.
#[derive(Debug, Clone)]
pub(super) struct Dice(u64);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub(super) fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.between(0.0, 1.0) < share
    }
}

/// Runs `case` in paused time with one seed after the other, `usual` times unless
/// `AZEL_CASES` says otherwise.
pub(super) fn for_each_case<Ran: Future<Output = ()>>(
    class: &str,
    usual: u64,
    case: impl Fn(Dice) -> Ran,
) {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("AZEL_SEED").unwrap_or(20_261_122);
    let cases = number("AZEL_CASES").unwrap_or(usual);
    println!("{class}: {cases} cases from seed {seed}");
    let mut failed = Vec::new();
    for seed in seed..seed + cases {
        let run = AssertUnwindSafe(|| {
            let mut builder = tokio::runtime::Builder::new_current_thread();
            let runtime = builder.enable_time().start_paused(true).build().unwrap();
            runtime.block_on(case(Dice::new(seed)));
        });
        if std::panic::catch_unwind(run).is_err() {
            println!("{class}: seed {seed} failed");
            failed.push(seed);
            assert!(failed.len() < 10, "{class}: seeds {failed:?} failed");
        }
    }
    assert!(failed.is_empty(), "{class}: of {cases} cases seeds {failed:?} failed");
}

/// A simulated unit of one make.
#[derive(Clone)]
pub(super) enum Unit {
    Satrak(satrak::Control),
    Genius(rotator_genius::Control),
    Rc2000c(rc2000c::Control, [CountLine; 2]),
}

/// What a unit tells wrongly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    FrozenAngles,
    FalseRest,
}

impl Unit {
    /// Where both axes truly stand, degrees as the mount counts.
    pub(super) fn axes_deg(&self) -> [f64; 2] {
        match self {
            Self::Satrak(control) => control.state().metal_deg,
            Self::Genius(control) => control.state().rotators.map(|rotator| rotator.angle_deg),
            Self::Rc2000c(control, lines) => {
                let state = control.state();
                [lines[0].degrees(state.az_counts), lines[1].degrees(state.el_counts)]
            }
        }
    }

    pub(super) fn is_turning(&self) -> bool {
        match self {
            Self::Satrak(control) => control.state().is_moving,
            Self::Genius(control) => control.state().rotators.iter().any(|it| it.is_turning),
            Self::Rc2000c(control, _) => control.state().is_turning,
        }
    }

    pub(super) fn tell(&self, lie: Lie) {
        match (self, lie) {
            (Self::Satrak(it), Lie::FrozenAngles) => {
                it.set_fault(satrak::Fault::FrozenAngles, true);
            }
            (Self::Satrak(it), Lie::FalseRest) => it.set_fault(satrak::Fault::FalseRest, true),
            (Self::Genius(it), Lie::FrozenAngles) => {
                it.set_fault(rotator_genius::Fault::FrozenAngles, true);
            }
            (Self::Genius(it), Lie::FalseRest) => {
                it.set_fault(rotator_genius::Fault::FalseRest, true);
            }
            (Self::Rc2000c(it, _), Lie::FrozenAngles) => {
                it.set_fault(rc2000c::Fault::FrozenAngles, true);
            }
            (Self::Rc2000c(it, _), Lie::FalseRest) => it.set_fault(rc2000c::Fault::FalseRest, true),
        }
    }

    fn serve(&self, far: DuplexStream) {
        match self.clone() {
            Self::Satrak(control) => drop(tokio::spawn(async move { control.serve(far).await })),
            Self::Genius(control) => drop(tokio::spawn(async move { control.serve(far).await })),
            Self::Rc2000c(control, _) => {
                drop(tokio::spawn(async move { control.serve(far).await }));
            }
        }
    }

    /// What it has received since `from`, in order: a STOP, a question or anything
    /// else.
    pub(super) fn words_since(&self, from: Instant) -> Vec<(Instant, Word)> {
        let text: Vec<(Instant, String)> = match self {
            Self::Satrak(control) => control.received(),
            Self::Genius(control) => control.received(),
            Self::Rc2000c(control, _) => {
                let frames = control.received().into_iter();
                let text = |frame: &azel::protocol::rc2000c::Frame| {
                    let data = String::from_utf8_lossy(frame.data());
                    format!("{}{data}", char::from(frame.code()))
                };
                frames.map(|(at, frame)| (at, text(&frame))).collect()
            }
        };
        let word = |text: &str| match self {
            Self::Satrak(_) if text.starts_with("STOP=") || text.starts_with("TRACK=,0") => {
                Word::Stop
            }
            Self::Satrak(_) if !text.contains('=') => Word::Question,
            Self::Satrak(_)
                if ["GOTO=", "MOVE=", "STEP=", "TRACK="]
                    .iter()
                    .any(|word| text.starts_with(word)) =>
            {
                Word::Motion
            }
            Self::Genius(_) if text == "|S" => Word::Stop,
            Self::Genius(_) if text == "|h" => Word::Question,
            Self::Genius(_) if ["|A", "|P", "|M"].iter().any(|word| text.starts_with(word)) => {
                Word::Motion
            }
            Self::Rc2000c(..) if text.starts_with("3X") => Word::Stop,
            Self::Rc2000c(..) if text.starts_with(['0', '1', '5']) => Word::Question,
            Self::Rc2000c(..) if text.starts_with(['2', '3']) => Word::Motion,
            _ => Word::Other,
        };
        text.into_iter().filter(|(at, _)| *at >= from).map(|(at, it)| (at, word(&it))).collect()
    }

    /// Whether a jog goes on until the unit is told otherwise.
    pub(super) fn jogs_run_on(&self) -> bool {
        !matches!(self, Self::Rc2000c(..))
    }

    /// Another client turns one axis; `false` where none can.
    pub(super) async fn other_client_turns(&self, axis: usize, rate_deg_s: f64) -> bool {
        let bytes = match self {
            Self::Satrak(_) => {
                let rate = format!("{rate_deg_s:.2}");
                let rates = if axis == 0 { [rate.as_str(), "0"] } else { ["0", rate.as_str()] };
                encode(&format!("MOVE=,{},{}", rates[0], rates[1]))
            }
            Self::Genius(_) => {
                let way = if rate_deg_s > 0.0 { 'P' } else { 'M' };
                format!("|{way}{}", axis + 1).into_bytes()
            }
            Self::Rc2000c(..) => return false,
        };
        let (mut near, far) = tokio::io::duplex(4096);
        self.serve(far);
        near.write_all(&bytes).await.unwrap();
        let mut answer = [0; 64];
        drop(near.read(&mut answer).await);
        true
    }
}

/// What a unit received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Stop,
    Question,
    /// Metal is to move.
    Motion,
    Other,
}

/// What goes wrong between a session and its unit.
#[derive(Debug, Clone, Default)]
pub(super) struct Line {
    pub(super) late_ms: f64,
    pub(super) lost: f64,
    /// The next reply is lost.
    pub(super) loses_next: bool,
    pub(super) doubled: f64,
    pub(super) damaged: f64,
    pub(super) is_split: bool,
    /// Replies carry no checksum: a changed figure would be a true one of elsewhere.
    pub(super) is_unchecked: bool,
    /// What the session writes gets nowhere.
    pub(super) is_deaf: bool,
    /// What the unit writes gets nowhere.
    pub(super) is_mute: bool,
    /// A STOP never gets through.
    pub(super) ignores_stop: bool,
}

/// A station, its antenna, and where it stands.
pub(super) struct World {
    pub(super) unit: Unit,
    pub(super) antenna: Antenna,
    pub(super) station: Station,
    pub(super) bounds: Bounds,
    pub(super) utc_origin: Timestamp,
    /// Of the fastest motion of the unit, degrees a second.
    pub(super) fastest_deg_s: f64,
    /// Half a step of what is told, and what a drive may overshoot, degrees.
    pub(super) coarse_deg: f64,
}

/// What a world is to have.
pub(super) struct Wish {
    pub(super) keep_outs: usize,
    pub(super) least_margin_deg: fn(&World) -> f64,
    pub(super) has_sun: bool,
    /// The axes stand inside a keep-out.
    pub(super) starts_inside: bool,
    pub(super) makes: usize,
}

impl World {
    /// A random one, and its axes somewhere free, or inside a keep-out.
    pub(super) fn random(dice: &mut Dice, wish: &Wish) -> Self {
        loop {
            let mut world = match dice.below(wish.makes) {
                0 => Self::of_satrak(dice),
                1 => Self::of_genius(dice),
                _ => Self::of_rc2000c(dice),
            };
            if wish.has_sun && dice.chance(0.4) {
                let radius_deg = dice.between(1.0, 25.0);
                let ahead_min = dice.between(0.0, 30.0);
                world.station.sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min });
            }
            let least_deg = (wish.least_margin_deg)(&world);
            for number in 0..wish.keep_outs {
                let margin_deg = f64::min(least_deg + dice.between(0.0, 4.0), 30.0);
                world.station.keep_outs.extend(keep_out(dice, number, margin_deg));
            }
            world.bounds = Bounds::of(&world.station, &world.antenna);
            for _ in 0..200 {
                if world.place(dice, wish.starts_inside) {
                    return world;
                }
            }
        }
    }

    fn of_satrak(dice: &mut Dice) -> Self {
        let utc_origin = some_time(dice);
        let station = Station::default();
        let lower_axis_deg = dice.between(0.0, 180.0);
        let options = satrak::Options {
            lower_axis: Angle::from_degrees(lower_axis_deg),
            seed: dice.next(),
            max_clients: 2,
            ..satrak::Options::new(station.site, utc_origin)
        };
        let mut antenna = Antenna::satrak("Dish", "in memory");
        antenna.mount = Mount::Xy {
            lower_axis_azimuth_deg: lower_axis_deg,
            travel_from_deg: dice.between(5.0, 30.0),
            travel_to_deg: dice.between(150.0, 175.0),
        };
        antenna.limits.maximum_rate_deg_s = dice.between(0.5, 5.0);
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 15.0);
        antenna.beam_width_deg = dice.between(0.1, 3.0);
        let unit = Unit::Satrak(satrak::Control::new(&options));
        Self::with(unit, antenna, station, utc_origin, 5.0, 0.15)
    }

    fn of_genius(dice: &mut Dice) -> Self {
        use rotator_genius::{Options, RotatorOptions};
        let highest_deg = if dice.chance(0.3) { 180.0 } else { 90.0 };
        let options = Options {
            rotators: [
                RotatorOptions::default(),
                RotatorOptions {
                    limit_cw: WholeDegrees::nearest(highest_deg).unwrap(),
                    ..RotatorOptions::elevation()
                },
            ],
            max_clients: 2,
            seed: dice.next(),
            ..Options::default()
        };
        let mut antenna = Antenna::genius("Mast", "in memory");
        antenna.connection.put(&ROTATORS, Rotators::Pair).unwrap();
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: dice.between(0.0, 40.0).round(),
            azimuth_to_deg: dice.between(320.0, 450.0).round(),
            elevation_from_deg: 0.0,
            elevation_to_deg: highest_deg,
        };
        antenna.beam_width_deg = dice.between(1.0, 20.0);
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
        let unit = Unit::Genius(rotator_genius::Control::new(&options));
        Self::with(unit, antenna, Station::default(), some_time(dice), 4.0, 2.6)
    }

    fn of_rc2000c(dice: &mut Dice) -> Self {
        let point = |counts, degrees| CountPoint { counts, degrees };
        let (from_deg, span_deg) = (dice.between(-90.0, 180.0).round(), dice.between(120.0, 420.0));
        let to_deg = from_deg + span_deg.round();
        let calibration = Calibration {
            azimuth: vec![point(30, from_deg), point(3630, to_deg)],
            elevation: vec![point(30, 0.0), point(1830, 90.0)],
        };
        let lines = [&calibration.azimuth, &calibration.elevation]
            .map(|points| CountLine::through(points).unwrap());
        let mut antenna = Antenna::rc2000c("Dish", "in memory");
        calibration.put_into(&mut antenna.connection).unwrap();
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: from_deg,
            azimuth_to_deg: to_deg,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        };
        // 40 counts a second.
        let fastest_deg_s = f64::max(40.0 * (to_deg - from_deg) / 3600.0, 2.0);
        antenna.limits.maximum_rate_deg_s = fastest_deg_s;
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
        antenna.beam_width_deg = dice.between(0.1, 3.0);
        let unit = Unit::Rc2000c(rc2000c::Control::new(&rc2000c::Options::default()), lines);
        Self::with(unit, antenna, Station::default(), some_time(dice), fastest_deg_s, 0.3)
    }

    fn with(
        unit: Unit,
        antenna: Antenna,
        station: Station,
        utc_origin: Timestamp,
        fastest_deg_s: f64,
        coarse_deg: f64,
    ) -> Self {
        let bounds = Bounds::of(&station, &antenna);
        Self { unit, antenna, station, bounds, utc_origin, fastest_deg_s, coarse_deg }
    }

    /// Puts the axes somewhere; `false` where that is not as wished.
    fn place(&mut self, dice: &mut Dice, inside: bool) -> bool {
        let axes_deg = self.antenna.mount.travel_deg().map(|(from_deg, to_deg)| {
            let away_deg = f64::min(5.0, (to_deg - from_deg) / 4.0);
            dice.between(from_deg + away_deg, to_deg - away_deg).round()
        });
        let axes_deg = match &self.unit {
            Unit::Genius(_) => [axes_deg[0].rem_euclid(360.0), axes_deg[1]],
            _ => axes_deg,
        };
        // Where a unit counts within a full circle, an axis that has turned further would
        // begin outside of its travel.
        if axes_deg[0] < self.antenna.mount.travel_deg()[0].0 {
            return false;
        }
        let direction = self.bounds.direction(axes_deg);
        let above_deg = direction.elevation_deg() - self.antenna.limits.minimum_elevation_deg;
        let sky = self.bounds.at(self.utc_origin).above_the_floor().nearest(direction);
        let clear_deg = sky.map_or(90.0, |nearest| nearest.angle.degrees());
        let is_wished = if inside { clear_deg < -0.5 } else { clear_deg > 3.0 };
        if above_deg < 3.0 || !is_wished {
            return false;
        }
        match &mut self.unit {
            Unit::Satrak(control) => control.place(axes_deg),
            Unit::Genius(control) => {
                control.place(axes_deg.map(|deg| WholeDegrees::nearest(deg).unwrap()));
            }
            Unit::Rc2000c(control, lines) => {
                let counts = [lines[0].counts(axes_deg[0]), lines[1].counts(axes_deg[1])];
                let [Some(azimuth), Some(elevation)] = counts else { return false };
                control.place([azimuth, elevation]);
            }
        }
        true
    }

    /// How far the true direction is from the nearest keep-out itself, degrees.
    pub(super) fn zone_clearance_deg(&self) -> f64 {
        let direction = self.direction();
        let zones = self.station.keep_outs.iter();
        let clear_deg = zones.map(|zone| zone.zone.clearance(direction).degrees());
        clear_deg.fold(f64::INFINITY, f64::min)
    }

    /// How far the true direction is above the minimum elevation, degrees.
    pub(super) fn floor_clearance_deg(&self) -> f64 {
        self.direction().elevation_deg() - self.antenna.limits.minimum_elevation_deg
    }

    pub(super) fn direction(&self) -> AzEl {
        self.bounds.direction(self.unit.axes_deg())
    }

    /// By how much an axis is beyond its travel, degrees.
    pub(super) fn beyond_travel_deg(&self) -> f64 {
        let axes = self.unit.axes_deg().into_iter().zip(self.antenna.mount.travel_deg());
        let beyond_deg = |(angle_deg, (from_deg, to_deg)): (f64, (f64, f64))| {
            let turns = [-360.0, 0.0, 360.0].into_iter();
            let beyond = turns.map(|turn| {
                let angle_deg: f64 = angle_deg + turn;
                f64::max(from_deg - angle_deg, angle_deg - to_deg)
            });
            beyond.fold(f64::INFINITY, f64::min)
        };
        axes.map(beyond_deg).fold(0.0, f64::max)
    }
}

fn some_time(dice: &mut Dice) -> Timestamp {
    let noon: Timestamp = "2026-06-21T10:00:00Z".parse().unwrap();
    time::add_seconds(noon, dice.between(0.0, 365.0).floor() * time::DAY_S)
}

/// A convex quadrilateral.
fn keep_out(dice: &mut Dice, number: usize, margin_deg: f64) -> Option<KeepOut> {
    let (width_deg, height_deg) = (dice.between(5.0, 60.0), dice.between(5.0, 60.0));
    let (az_deg, el_deg) = (dice.between(0.0, 360.0), dice.between(-10.0, 60.0));
    let top_deg = f64::min(el_deg + height_deg, 88.0);
    let [left_deg, right_deg] = [(); 2].map(|()| dice.between(-0.2, 0.2) * width_deg);
    let corners_deg = [
        (az_deg, el_deg),
        (az_deg + width_deg, el_deg),
        (az_deg + width_deg + right_deg, top_deg),
        (az_deg + left_deg, top_deg),
    ];
    let zone = KeepOut::zone_of(&corners_deg).ok()?;
    let name = format!("zone {number}");
    let (reason, entered) = (String::new(), Entered::Hard);
    Some(KeepOut { name, reason, entered, antenna: None, margin_deg, zone })
}

/// An operator in front of a session, and the metal.
pub(super) struct Scene {
    pub(super) world: World,
    handle: AntennaHandle,
    pub(super) line: Arc<Mutex<Line>>,
    is_off: Arc<AtomicBool>,
    dials: Arc<Mutex<Vec<Instant>>>,
    /// All events and when they were seen.
    pub(super) events: Vec<(Instant, Event)>,
}

impl Scene {
    /// A session that has read its unit and knows its bounds.
    pub(super) async fn start(world: World, dice: &mut Dice) -> Self {
        let line = Arc::new(Mutex::new(Line {
            is_unchecked: matches!(world.unit, Unit::Genius(_)),
            ..Line::default()
        }));
        let (is_off, dials) = (Arc::new(AtomicBool::new(false)), Arc::default());
        let dial = dial(&world.unit, &line, &is_off, &dials, dice.next());
        let (started, readings) = (Instant::now(), AtomicU64::new(0));
        let utc_origin = world.utc_origin;
        let clock = Clock::new(move || {
            assert!(readings.fetch_add(1, Ordering::Relaxed) < MOST_READINGS, "a busy loop");
            time::add_seconds(utc_origin, started.elapsed().as_secs_f64())
        });
        let antenna = &world.antenna;
        let (session, handle) =
            Session::new(antenna.controller(), antenna, dial, clock, Arc::new(|| {}));
        tokio::spawn(session.run());
        handle.send(Command::Within(Box::new(world.bounds.clone()))).unwrap();
        handle.send(Command::Connect).unwrap();
        let mut scene = Self { world, handle, line, is_off, dials, events: Vec::new() };
        let end = Instant::now() + Duration::from_secs(20);
        while scene.shown().state.measured.is_none() || scene.shown().state.motion_lock.is_none() {
            assert!(Instant::now() < end, "never read: {:?}", scene.shown());
            scene.look().await;
        }
        scene.seconds(1.5).await;
        scene
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.snapshot()
    }

    pub(super) fn send(&self, command: Command) {
        // A session that is too busy says so; the operator would press again.
        drop(self.handle.send(command));
    }

    pub(super) fn stop(&self) {
        self.handle.stop();
    }

    pub(super) fn trouble(&self, change: impl FnOnce(&mut Line)) {
        change(&mut self.line.lock().unwrap());
    }

    /// The network goes, or is there again.
    pub(super) fn set_off(&self, is_off: bool) {
        self.is_off.store(is_off, Ordering::Relaxed);
        if is_off {
            match &self.world.unit {
                Unit::Satrak(control) => control.drop_clients(),
                Unit::Genius(control) => control.drop_clients(),
                Unit::Rc2000c(control, _) => control.drop_clients(),
            }
        }
    }

    /// When the last link was dialled that was opened.
    pub(super) fn last_dial(&self) -> Option<Instant> {
        self.dials.lock().unwrap().last().copied()
    }

    /// Waits for the time between two looks, and takes what was told.
    pub(super) async fn look(&mut self) {
        sleep(LOOK).await;
        let now = Instant::now();
        while let Some(event) = self.handle.next_event() {
            self.events.push((now, event));
        }
    }

    pub(super) async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.look().await;
        }
    }

    /// When the first event that `is_it` came, from `since` on.
    pub(super) fn told(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> Option<Instant> {
        let mut events = self.events.iter().filter(|(at, _)| *at >= since);
        events.find(|(_, event)| is_it(event)).map(|(at, _)| *at)
    }

    /// How many events that `is_it` have come from `since` on.
    pub(super) fn count(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|(at, event)| *at >= since && is_it(event)).count()
    }

    /// How far the true direction is from the Sun's surroundings, degrees.
    pub(super) fn sun_clearance_deg(&self) -> f64 {
        let utc = self.shown().state.measured.map_or(self.world.utc_origin, |it| it.at);
        let clearances = self.world.bounds.at(utc).clearances(self.world.direction());
        let sun = clearances.into_iter().find(|clearance| clearance.barrier == Barrier::Sun);
        sun.map_or(f64::INFINITY, |clearance| clearance.angle.degrees())
    }

    pub(super) fn report(&self) -> String {
        let World { unit, station, antenna, .. } = &self.world;
        let corners: Vec<_> = station
            .keep_outs
            .iter()
            .map(|zone| (KeepOut::corners_deg(&zone.zone), zone.margin_deg))
            .collect();
        let (mount, sun) = (&antenna.mount, &station.sun_avoidance);
        format!(
            "axes {:?} {:?}\n{mount:?} {:?} beam {}\nzones {corners:?}\nsun {sun:?}\nshown {:?} {:?}\n{:?}",
            unit.axes_deg(),
            self.world.direction(),
            antenna.limits,
            antenna.beam_width_deg,
            self.shown().intent,
            self.shown().state.measured,
            self.events
        )
    }
}

fn dial(
    unit: &Unit,
    line: &Arc<Mutex<Line>>,
    is_off: &Arc<AtomicBool>,
    dials: &Arc<Mutex<Vec<Instant>>>,
    seed: u64,
) -> Dial {
    let (unit, line, is_off) = (unit.clone(), Arc::clone(line), Arc::clone(is_off));
    let (dials, mut dice) = (Arc::clone(dials), Dice::new(seed));
    Box::new(move || {
        if is_off.load(Ordering::Relaxed) {
            return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
        }
        dials.lock().unwrap().push(Instant::now());
        let (near, here) = tokio::io::duplex(4096);
        let (there, far) = tokio::io::duplex(4096);
        unit.serve(far);
        tokio::spawn(carry(here, there, Arc::clone(&line), Dice::new(dice.next()), unit.clone()));
        Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
    })
}

/// Carries what both ends write, with the troubles of the line.
async fn carry(
    mut here: DuplexStream,
    mut there: DuplexStream,
    line: Arc<Mutex<Line>>,
    mut dice: Dice,
    unit: Unit,
) -> io::Result<()> {
    let (mut out, mut back) = ([0; 1024], [0; 1024]);
    loop {
        tokio::select! {
            read = here.read(&mut out) => {
                let bytes = &out[..read?];
                if bytes.is_empty() {
                    return Ok(());
                }
                let line = line.lock().unwrap().clone();
                let vanishes = line.is_deaf || line.ignores_stop && holds_stop(bytes, &unit);
                if !vanishes {
                    there.write_all(bytes).await?;
                }
            }
            read = there.read(&mut back) => {
                let bytes = &mut back[..read?];
                if bytes.is_empty() {
                    return Ok(());
                }
                let line = {
                    let mut line = line.lock().unwrap();
                    if std::mem::take(&mut line.loses_next) {
                        continue;
                    }
                    line.clone()
                };
                if line.is_mute || dice.chance(line.lost) {
                    continue;
                }
                if line.late_ms > 0.0 {
                    let late_s = dice.between(0.0, line.late_ms) / 1000.0;
                    sleep(Duration::try_from_secs_f64(late_s).unwrap()).await;
                }
                let mut sent = bytes.to_vec();
                if dice.chance(line.damaged) {
                    let at = dice.below(sent.len());
                    if line.is_unchecked {
                        sent.truncate(at);
                    } else {
                        sent[at] ^= 1 << dice.below(7);
                    }
                }
                if dice.chance(line.doubled) {
                    sent.extend_from_slice(bytes);
                }
                let at = if line.is_split { dice.below(sent.len() + 1) } else { 0 };
                here.write_all(&sent[..at]).await?;
                if line.is_split {
                    sleep(Duration::from_millis(5)).await;
                }
                here.write_all(&sent[at..]).await?;
            }
        }
    }
}

fn holds_stop(bytes: &[u8], unit: &Unit) -> bool {
    let holds = |word: &[u8]| bytes.windows(word.len()).any(|part| part == word);
    match unit {
        Unit::Satrak(_) => holds(b"STOP=") || holds(b"STOP ="),
        Unit::Genius(_) => holds(b"|S"),
        // The code follows the start and the address.
        Unit::Rc2000c(..) => bytes.get(2..4) == Some(b"3X"),
    }
}
