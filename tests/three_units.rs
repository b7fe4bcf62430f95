//! The three makes at once, each with trouble on its line, for an hour of paused time. The display
//! must be true, and nothing may get stuck. The test prints the memory (`AZEL_HOURS=4 cargo test
//! --test azel three_units -- --nocapture`). Memory grows for some two hours, until the logs of the
//! links are full, and then stays flat.

use std::time::Duration;

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, LinkState, StopState},
    controller::rc2000c::Calibration,
    device::{CountLine, CountPoint},
    driver::AntennaHandle,
    sim::{Control, Unit, rc2000c, rotator_genius, satrak},
    station::{Antenna, Mount, Station},
};
use jiff::Timestamp;
use tokio::time::{Instant, sleep};

use crate::common::{
    clock::TestClock,
    dice::Dice,
    network::{Network, link},
    rig::session,
};

/// Interval at which the operator looks.
const LOOK: Duration = Duration::from_millis(100);
/// Length of a round of trouble.
const TROUBLE: Duration = Duration::from_secs(40);
/// Max time from the end of a round to a link that is up again.
const RECOVERY: Duration = Duration::from_mins(1);
/// Max time until a STOP on a good link is proved.
const PROOF: Duration = Duration::from_secs(15);

/// A session, its simulator, and controls for both.
struct Pair {
    name: &'static str,
    handle: AntennaHandle,
    set_fault: Box<dyn Fn(usize, bool)>,
    faults: usize,
    drop_clients: Box<dyn Fn()>,
    truth: Box<dyn Fn() -> AzEl>,
    /// Fastest rate of both axes together, degrees per second.
    fastest_deg_s: f64,
    /// Resolution of the readings, degrees.
    coarse_deg: f64,
    jog_deg_s: f64,
}

/// Starts a session of `antenna` with the unit in memory.
fn open<U: Unit>(antenna: &Antenna, control: &Control<U>) -> AntennaHandle {
    let served = control.clone();
    let dial = Network::default().dial(move || link(&served));
    let (session, handle) = session(antenna, dial, TestClock::new(Timestamp::UNIX_EPOCH).clock());
    tokio::spawn(session.run());
    handle
}

fn of_satrak() -> Pair {
    use satrak::{Control, Fault, Options};
    const FAULTS: [Fault; 8] = [
        Fault::Unsolicited,
        Fault::DropReply,
        Fault::Garbage,
        Fault::Split,
        Fault::Merge,
        Fault::Silence,
        Fault::BadChecksum,
        Fault::HangUp,
    ];
    let control = Control::new(&Options::new(Station::default().site, Timestamp::UNIX_EPOCH));
    let antenna = Antenna::satrak("Satrak", "in memory");
    let handle = open(&antenna, &control);
    let (faulty, dropping, seen) = (control.clone(), control.clone(), control);
    Pair {
        name: "Satrak",
        handle,
        set_fault: Box::new(move |fault, on| faulty.set_fault(FAULTS[fault], on)),
        faults: FAULTS.len(),
        drop_clients: Box::new(move || dropping.drop_clients()),
        truth: Box::new(move || {
            let state = seen.state();
            AzEl::from_degrees(state.az_deg, state.el_deg)
        }),
        fastest_deg_s: 12.0,
        coarse_deg: 0.05,
        jog_deg_s: 1.0,
    }
}

fn of_genius() -> Pair {
    use rotator_genius::{Control, Fault, Options, RotatorOptions};
    const FAULTS: [Fault; 6] = [
        Fault::Silence,
        Fault::DropReply,
        Fault::HangUp,
        Fault::Split,
        Fault::Merge,
        Fault::Refuse,
    ];
    let options = Options {
        rotators: [RotatorOptions::default(), RotatorOptions::elevation()],
        ..Options::default()
    };
    let control = Control::new(&options);
    let antenna = Antenna::genius("Genius", "in memory");
    let handle = open(&antenna, &control);
    let (faulty, dropping, seen) = (control.clone(), control.clone(), control);
    Pair {
        name: "Genius",
        handle,
        set_fault: Box::new(move |fault, on| faulty.set_fault(FAULTS[fault], on)),
        faults: FAULTS.len(),
        drop_clients: Box::new(move || dropping.drop_clients()),
        truth: Box::new(move || {
            let [azimuth, elevation] = seen.state().rotators.map(|rotator| rotator.angle_deg);
            AzEl::from_degrees(azimuth, elevation)
        }),
        fastest_deg_s: 12.0,
        coarse_deg: 1.5,
        jog_deg_s: 6.0,
    }
}

fn of_rc2000c() -> Pair {
    use rc2000c::{Control, Fault, Options};
    const FAULTS: [Fault; 9] = [
        Fault::Silence,
        Fault::DropReply,
        Fault::Garbage,
        Fault::Split,
        Fault::Merge,
        Fault::BitError,
        Fault::Truncate,
        Fault::RemoteDisabled,
        Fault::Refuse,
    ];
    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 90.0), point(3630, 270.0)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    let lines = [&calibration.azimuth, &calibration.elevation]
        .map(|points| CountLine::from_points(points).unwrap());
    let control = Control::new(&Options::default());
    let mut antenna = Antenna::rc2000c("RC2000C", "in memory");
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: 90.0,
        azimuth_to_deg: 270.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    calibration.put_into(&mut antenna.connection).unwrap();
    let handle = open(&antenna, &control);
    handle.send(Command::Connect).unwrap();
    let (faulty, dropping, seen) = (control.clone(), control.clone(), control);
    Pair {
        name: "RC2000C",
        handle,
        set_fault: Box::new(move |fault, on| faulty.set_fault(FAULTS[fault], on)),
        faults: FAULTS.len(),
        drop_clients: Box::new(move || dropping.drop_clients()),
        truth: Box::new(move || {
            let state = seen.state();
            let [azimuth, elevation] = lines;
            AzEl::from_degrees(azimuth.degrees(state.az_counts), elevation.degrees(state.el_counts))
        }),
        fastest_deg_s: 8.0,
        coarse_deg: 0.1,
        jog_deg_s: 2.0,
    }
}

/// Checks that the antenna was at the shown direction at some time since the question.
fn assert_true(pair: &Pair) {
    let shown = pair.handle.snapshot();
    let Some(measured) = shown.state.measured else { return };
    let Some(direction) = measured.direction() else { return };
    let age_s = (azel::clock::Instant::now() - measured.requested).as_secs_f64();
    let off = direction.separation((pair.truth)()).degrees();
    let allowed = pair.coarse_deg + pair.fastest_deg_s * age_s;
    assert!(off <= allowed, "{}: {off} degrees off after {age_s} s: {measured:?}", pair.name);
}

/// Sends a random command of the operator.
fn drive(pair: &Pair, dice: &mut Dice) {
    let command = match dice.below(6) {
        0 => Command::Standby,
        1 => Command::Manual,
        2 => Command::Position {
            azimuth: Some(Angle::from_degrees(100.0 + dice.below(150) as f64)),
            elevation: Some(Angle::from_degrees(20.0 + dice.below(50) as f64)),
        },
        3 => Command::Park,
        4 => Command::Hold,
        _ => return pair.handle.stop(),
    };
    // Ignore the refusal by a busy session, because the operator would press again.
    let _ = pair.handle.send(command);
}

/// Holds the jog key for one look.
fn hold(pair: &Pair, dice: &mut Dice) {
    let way = if dice.below(2) == 0 { 1.0 } else { -1.0 };
    let rates_deg_s = [way * pair.jog_deg_s, 0.0];
    let _ = pair.handle.send(Command::Jog { rates_deg_s });
}

async fn until(pair: &mut Pair, what: &str, within: Duration, is_so: impl Fn(&Pair) -> bool) {
    let end = Instant::now() + within;
    while !is_so(pair) {
        let shown = pair.handle.snapshot();
        assert!(Instant::now() < end, "{}: not {what}: {shown:#?}", pair.name);
        assert_true(pair);
        while pair.handle.next_event().is_some() {}
        sleep(LOOK).await;
    }
}

async fn round(pairs: &mut [Pair], dice: &mut Dice) {
    let faults: Vec<Vec<usize>> = pairs
        .iter()
        .map(|pair| (0..=dice.below(2)).map(|_| dice.below(pair.faults)).collect())
        .collect();
    for (pair, faults) in pairs.iter().zip(&faults) {
        for fault in faults {
            (pair.set_fault)(*fault, true);
        }
    }
    let end = Instant::now() + TROUBLE;
    while Instant::now() < end {
        for pair in pairs.iter_mut() {
            match dice.below(60) {
                0 => drive(pair, dice),
                1 if dice.below(4) == 0 => (pair.drop_clients)(),
                2..20 => hold(pair, dice),
                _ => {}
            }
            assert_true(pair);
            while pair.handle.next_event().is_some() {}
        }
        sleep(LOOK).await;
    }
    for (pair, faults) in pairs.iter_mut().zip(&faults) {
        for fault in faults {
            (pair.set_fault)(*fault, false);
        }
        let is_up = |pair: &Pair| matches!(pair.handle.snapshot().link, LinkState::Up { .. });
        until(pair, "up again", RECOVERY, is_up).await;
        pair.handle.stop();
        let stands = |pair: &Pair| matches!(pair.handle.snapshot().stop, StopState::Stopped { .. });
        until(pair, "stopped", PROOF, stands).await;
        let before = (pair.truth)();
        sleep(Duration::from_secs(2)).await;
        let crept = (pair.truth)().separation(before).degrees();
        // Readings cannot show a coast below their resolution.
        assert!(crept < pair.coarse_deg, "{}: it still turns: {crept}", pair.name);
    }
}

/// Returns the resident memory, MB.
fn memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}

#[tokio::test(start_paused = true)]
async fn an_hour_with_trouble_on_three_lines_leaves_no_trace() {
    let hours = std::env::var("AZEL_HOURS").ok().and_then(|hours| hours.parse().ok()).unwrap_or(1);
    let mut pairs = [of_satrak(), of_genius(), of_rc2000c()];
    let mut dice = Dice::new(20_261_122);
    let start = Instant::now();
    let mut memory = Vec::new();
    while start.elapsed() < Duration::from_hours(hours) {
        round(&mut pairs, &mut dice).await;
        memory.extend(memory_mb());
    }
    println!("{} rounds, memory in MB: {memory:.1?}", memory.len());
}
