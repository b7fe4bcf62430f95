//! Imperfections of drive, gear and sensor for every simulated axis.

use std::{collections::VecDeque, time::Duration};

use super::prng::Prng;

/// Max number of pending commands; a further command replaces the newest.
const MAX_PENDING: usize = 100;
/// Mean time between two gusts, and duration of a gust, seconds.
const GUST_PERIOD_S: f64 = 20.0;
const GUST_S: f64 = 3.0;

/// Imperfections of an axis. By default it has none.
#[derive(Debug, Clone, Copy, PartialEq, Default, clap::Args)]
pub struct Mechanics {
    /// Seconds from a command until the drive obeys it
    #[arg(long, value_name = "S", default_value = "0", value_parser = seconds)]
    pub dead_time: Duration,
    /// Seconds to coast from full rate to rest [default: depends on the make]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub coasting: Option<Duration>,
    /// Shortest time that a drive runs towards a position, seconds
    #[arg(long, value_name = "S", default_value = "0", value_parser = seconds)]
    pub minimum_run: Duration,
    /// Largest sensor error, degrees, uniformly distributed
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = degrees)]
    pub noise_deg: f64,
    /// Play between drive and axis, degrees
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = degrees)]
    pub backlash_deg: f64,
    /// Largest sway of a standing axis in gusts, peak to peak, degrees
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = degrees)]
    pub sway_deg: f64,
}

impl Mechanics {
    /// Returns the time from full rate to rest without power, seconds; `own_s` is the make's
    /// default.
    pub(super) fn coasting_s(&self, own_s: f64) -> f64 {
        self.coasting.map_or(own_s, |coasting| coasting.as_secs_f64())
    }
}

/// Parses seconds from 0 to 60.
fn seconds(text: &str) -> Result<Duration, String> {
    Duration::try_from_secs_f64(number(text, 60.0)?).map_err(|error| error.to_string())
}

/// Parses degrees from 0 to 10.
fn degrees(text: &str) -> Result<f64, String> {
    number(text, 10.0)
}

fn number(text: &str, max: f64) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=max).contains(number));
    number.ok_or_else(|| format!("not a number from 0 to {max}"))
}

/// Commands that a drive with dead time has not obeyed yet.
#[derive(Debug, Clone)]
pub(super) struct CommandDelay<C> {
    dead_time_s: f64,
    /// Remaining time, seconds, and the command.
    pending: VecDeque<(f64, C)>,
}

impl<C> CommandDelay<C> {
    pub(super) fn new(mechanics: &Mechanics) -> Self {
        Self { dead_time_s: mechanics.dead_time.as_secs_f64(), pending: VecDeque::new() }
    }

    pub(super) fn command(&mut self, command: C) {
        if self.pending.len() == MAX_PENDING {
            self.pending.pop_back();
        }
        self.pending.push_back((self.dead_time_s, command));
    }

    /// Returns the newest pending command.
    pub(super) fn newest_mut(&mut self) -> Option<&mut C> {
        self.pending.back_mut().map(|(_, command)| command)
    }

    pub(super) fn is_idle(&self) -> bool {
        self.pending.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.pending.clear();
    }

    /// Advances time. Returns the command that takes effect now.
    pub(super) fn advance(&mut self, step_s: f64) -> Option<C> {
        let mut obeyed = None;
        while self.pending.front().is_some_and(|(left_s, _)| *left_s <= 0.0) {
            obeyed = self.pending.pop_front().map(|(_, command)| command);
        }
        for (left_s, _) in &mut self.pending {
            *left_s -= step_s;
        }
        obeyed
    }
}

/// Time for which a drive must run after it was switched on, and its run so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct MinimumRun {
    minimum_s: f64,
    run_s: f64,
}

impl MinimumRun {
    pub(super) fn new(mechanics: &Mechanics) -> Self {
        Self { minimum_s: mechanics.minimum_run.as_secs_f64(), run_s: 0.0 }
    }

    pub(super) fn advance(&mut self, is_running: bool, step_s: f64) {
        self.run_s = if is_running { self.run_s + step_s } else { 0.0 };
    }

    /// Returns `true` until the minimum run is over.
    pub(super) fn must_keep_running(&self) -> bool {
        self.run_s < self.minimum_s
    }
}

/// Play between a drive and its axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gear {
    half_deg: f64,
    /// Position of the drive within the play, degrees.
    within_deg: f64,
}

impl Gear {
    pub(super) fn new(mechanics: &Mechanics) -> Self {
        Self { half_deg: mechanics.backlash_deg / 2.0, within_deg: 0.0 }
    }

    /// Turns the drive by `by_deg`. Returns the turn of the axis, degrees.
    pub(super) fn turn(&mut self, by_deg: f64) -> f64 {
        let drive_deg = self.within_deg + by_deg;
        self.within_deg = drive_deg.clamp(-self.half_deg, self.half_deg);
        drive_deg - self.within_deg
    }
}

/// Sensor error from noise and wind.
#[derive(Debug, Clone)]
pub(super) struct Sensor {
    noise_deg: f64,
    sway_deg: f64,
    random: Prng,
    gust_deg: f64,
    gust_left_s: f64,
    error_deg: f64,
}

impl Sensor {
    pub(super) fn new(mechanics: &Mechanics, seed: u64) -> Self {
        Self {
            noise_deg: mechanics.noise_deg,
            sway_deg: mechanics.sway_deg,
            random: Prng::new(seed),
            gust_deg: 0.0,
            gust_left_s: 0.0,
            error_deg: 0.0,
        }
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        self.gust_left_s -= step_s;
        if self.gust_left_s <= 0.0 {
            let comes = self.random.even().abs() < step_s / GUST_PERIOD_S;
            let (gust_deg, left_s) =
                if comes { (self.random.even() * self.sway_deg / 2.0, GUST_S) } else { (0.0, 0.0) };
            (self.gust_deg, self.gust_left_s) = (gust_deg, left_s);
        }
        self.error_deg = self.gust_deg + self.random.even() * self.noise_deg;
    }

    /// Returns the reading minus the true angle at the last step, degrees.
    pub(super) fn error_deg(&self) -> f64 {
        self.error_deg
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_drive_obeys_in_order() {
        let dead_time = Duration::from_millis(100);
        let mut drive = CommandDelay::new(&Mechanics { dead_time, ..Mechanics::default() });
        drive.command('a');
        let mut obeyed = Vec::new();
        for step in 0..6 {
            if step == 1 {
                drive.command('b');
            }
            obeyed.push(drive.advance(0.05));
        }
        assert_eq!(obeyed, [None, None, Some('a'), Some('b'), None, None]);
        let mut prompt = CommandDelay::new(&Mechanics::default());
        prompt.command('c');
        prompt.command('d');
        assert_eq!(prompt.advance(0.05), Some('d'));
        for number in 0..1000 {
            drive.command(char::from_digit(number % 10, 10).unwrap());
        }
        assert_eq!(drive.pending.len(), MAX_PENDING);
        assert_eq!(drive.newest_mut(), Some(&mut '9'));
    }

    #[test]
    fn play_is_taken_up_before_the_axis_follows() {
        let mut gear = Gear::new(&Mechanics { backlash_deg: 1.0, ..Mechanics::default() });
        for (by_deg, turns_deg) in [(0.4, 0.0), (0.4, 0.3), (-0.9, 0.0), (-0.6, -0.5)] {
            let turned_deg = gear.turn(by_deg);
            assert!((turned_deg - turns_deg).abs() < 1e-9, "{by_deg}: {turned_deg}");
        }
    }

    #[test]
    fn a_sensor_errs_within_its_bounds() {
        let mechanics = Mechanics { noise_deg: 0.3, sway_deg: 1.0, ..Mechanics::default() };
        let errors = |seed| {
            let mut sensor = Sensor::new(&mechanics, seed);
            let step = |_| {
                sensor.advance(0.05);
                sensor.error_deg()
            };
            (0..20_000).map(step).collect::<Vec<_>>()
        };
        assert_eq!(errors(3), errors(3));
        assert_ne!(errors(3), errors(4));
        assert!(errors(3).iter().all(|error| error.abs() <= 0.8));
        assert!(errors(3).iter().any(|error| error.abs() > 0.5), "a gust");
        let calm = errors(3).iter().filter(|error| error.abs() <= 0.3).count();
        assert!(calm > 10_000, "{calm}");
    }

    #[test]
    fn numbers_out_of_range_are_rejected() {
        assert_eq!(seconds("0.3"), Ok(Duration::from_millis(300)));
        for wrong in ["-1", "61", "nan", "x", "inf"] {
            assert!(seconds(wrong).is_err() && degrees(wrong).is_err(), "{wrong}");
        }
    }
}
