//! Simulated unit: its memory and activity. It has no I/O and no clock: the caller passes the time
//! since the start.

use std::collections::BTreeSet;
use std::time::Duration;

use super::command::{CommandReader, SHORT_CONFIGURATION_BYTES};
use super::rotor::Rotor;
use super::{Fault, Options, Quirk, report};
use crate::protocol::rotator_genius::{
    Configuration, Motion, Moving, Request, RequestError, RotatorNumber, WholeDegrees,
};
use crate::sim::harness::{self, Switches};

/// Time between two steps of the rotators.
const STEP: Duration = Duration::from_millis(50);
/// Max elapsed time that the unit simulates; it skips a longer rest.
const LONGEST_CATCH_UP: Duration = Duration::from_mins(10);
/// Code that [`Fault::Panic`] reports.
const PANIC_CODE: u8 = 0x07;

/// Activity of the unit, for tests and displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapshot {
    pub rotators: [RotatorState; 2],
}

impl Snapshot {
    pub fn rotator(&self, number: RotatorNumber) -> &RotatorState {
        number.select(&self.rotators)
    }
}

/// True state of a rotator, independent of its sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotatorState {
    /// Angle, degrees, 0 to 360.
    pub angle_deg: f64,
    /// Direction of the drive.
    pub moving: Moving,
    /// `true` if the rotator turns; without its drive it may still coast.
    pub is_turning: bool,
    /// `true` if the sensor reads outside the limits.
    pub is_outside_limits: bool,
    pub target: Option<WholeDegrees>,
}

/// State of a simulated unit.
#[derive(Debug)]
pub struct RotatorGenius {
    rotors: [Rotor; 2],
    panic: u8,
    refuses: bool,
    /// `true` if each order turns the other rotator.
    is_crossed: bool,
    /// Time since the start of the unit, in whole steps.
    elapsed: Duration,
}

impl RotatorGenius {
    pub(super) fn new(options: &Options) -> Self {
        let [first, second] = &options.rotators;
        let rotor = |rotator, number| {
            Rotor::new(rotator, &options.mechanics, options.seed.rotate_left(1) ^ number)
        };
        Self {
            rotors: [rotor(first, 0), rotor(second, 1)],
            panic: 0,
            refuses: false,
            is_crossed: false,
            elapsed: Duration::ZERO,
        }
    }

    /// Carries out a command and returns the reply, if any. Must be called after `advance`.
    pub(super) fn answer(&mut self, command: &[u8], quirks: &BTreeSet<Quirk>) -> Option<Vec<u8>> {
        let letter = *command.get(1)?;
        let is_short = letter == b'c' && command.len() == SHORT_CONFIGURATION_BYTES;
        let request = if is_short && quirks.contains(&Quirk::Config12) {
            Request::parse(&[command, &[b' '; 10]].concat())
        } else {
            Request::parse(command)
        };
        let is_accepted = match request {
            Ok(Request::Read) => return Some(report::status(&self.rotors, self.panic, quirks)),
            Ok(Request::Stop) => {
                self.rotors.iter_mut().for_each(Rotor::stop);
                true
            }
            Ok(Request::Motion(_) | Request::Configure(_)) if self.refuses => false,
            Ok(Request::Motion(motion)) => self.start(motion),
            Ok(Request::Configure(configuration)) => {
                self.configure(&configuration, is_short);
                true
            }
            Err(RequestError::Unknown) if !quirks.contains(&Quirk::UnknownFails) => return None,
            Err(_) => false,
        };
        Some(match letter {
            b'A' => report::go_to(command, is_accepted, quirks),
            _ => report::acknowledgement(letter, is_accepted),
        })
    }

    fn start(&mut self, motion: Motion) -> bool {
        let (Motion::GoTo { rotator, .. } | Motion::Rotate { rotator, .. }) = motion;
        let turned = match rotator {
            RotatorNumber::One if self.is_crossed => RotatorNumber::Two,
            RotatorNumber::Two if self.is_crossed => RotatorNumber::One,
            RotatorNumber::One | RotatorNumber::Two => rotator,
        };
        let rotor = turned.of_mut(&mut self.rotors);
        match motion {
            Motion::GoTo { target, .. } => rotor.go_to(target),
            Motion::Rotate { direction, .. } => rotor.rotate(direction),
        }
    }

    fn configure(&mut self, configuration: &Configuration, keeps_name: bool) {
        let rotor = configuration.rotator().of_mut(&mut self.rotors);
        rotor.configure(configuration);
        if !keeps_name {
            configuration.name().as_str().clone_into(&mut rotor.name);
        }
    }
}

impl harness::Unit for RotatorGenius {
    type Quirk = Quirk;
    type Fault = Fault;
    /// Command as Latin-1 text.
    type Request = String;
    type Snapshot = Snapshot;
    type Place = [WholeDegrees; 2];
    type Wire = CommandReader;

    const SILENCE: Fault = Fault::Silence;
    const NOISE: Fault = Fault::Garbage;
    const REFUSAL: Fault = Fault::Refuse;
    const SPLIT: Fault = Fault::Split;
    const MERGE: Fault = Fault::Merge;

    fn advance(&mut self, elapsed: Duration) {
        self.elapsed = self.elapsed.max(elapsed.saturating_sub(LONGEST_CATCH_UP));
        // Use whole steps only, so that frequent requests change nothing.
        while self.elapsed + STEP <= elapsed {
            self.elapsed += STEP;
            for rotor in &mut self.rotors {
                rotor.advance(STEP.as_secs_f64());
            }
        }
    }

    fn set_switches(&mut self, switches: &Switches<Quirk, Fault>) {
        self.panic = if switches.has_fault(Fault::Panic) { PANIC_CODE } else { 0 };
        self.refuses = switches.has_fault(Fault::Refuse);
        self.is_crossed = switches.has_fault(Fault::CrossedDrives);
        for number in RotatorNumber::ALL {
            let has_no_sensor = switches.has_fault(Fault::NoSensor(number));
            let is_stuck = switches.has_fault(Fault::Stuck(number));
            let rotor = number.of_mut(&mut self.rotors);
            rotor.set_faults(has_no_sensor, is_stuck);
            let is_frozen = switches.has_fault(Fault::FrozenAngles);
            rotor.set_lies(is_frozen, switches.has_fault(Fault::FalseRest));
        }
    }

    fn set_strength(&mut self, shares: [f64; 2]) {
        for (rotor, share) in self.rotors.iter_mut().zip(shares) {
            rotor.set_strength(share);
        }
    }

    fn cut_power(&mut self) {
        self.rotors.iter_mut().for_each(Rotor::lose_power);
    }

    fn place(&mut self, angles: [WholeDegrees; 2]) {
        for (rotor, angle) in self.rotors.iter_mut().zip(angles) {
            rotor.place(angle);
        }
    }

    fn snapshot(&self) -> Snapshot {
        let rotators = self.rotors.each_ref().map(|rotor| RotatorState {
            angle_deg: rotor.angle_deg(),
            moving: rotor.moving(),
            is_turning: rotor.is_turning(),
            is_outside_limits: rotor.is_outside_limits(),
            target: rotor.journey().map(|(target, _)| target),
        });
        Snapshot { rotators }
    }

    fn wire(&self) -> CommandReader {
        CommandReader::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::harness::Unit;

    fn unit(faults: &[Fault]) -> RotatorGenius {
        let mut unit = RotatorGenius::new(&Options::default());
        unit.set_switches(&switches(faults));
        unit
    }

    fn switches(faults: &[Fault]) -> Switches<Quirk, Fault> {
        Switches { quirks: BTreeSet::new(), faults: faults.iter().copied().collect() }
    }

    fn answer(unit: &mut RotatorGenius, command: &str, quirks: &[Quirk]) -> Option<String> {
        let quirks = quirks.iter().copied().collect();
        let reply = unit.answer(command.as_bytes(), &quirks)?;
        Some(reply.into_iter().map(char::from).collect())
    }

    #[test]
    fn commands_are_accepted_or_refused_as_documented() {
        let mut unit = unit(&[]);
        for (command, reply) in [
            ("|A1200", Some("|AK")),
            ("|A1361", Some("|AF")),
            ("|A3090", Some("|AF")),
            // The sensor of rotator 2 is not connected.
            ("|A2090", Some("|AF")),
            ("|P2", Some("|PF")),
            ("|M1", Some("|MK")),
            ("|S", Some("|SK")),
            ("|c1270090A00TOW1      ", Some("|cK")),
            ("|A1000", Some("|AF")),
            ("|c1270090X00TOW1      ", Some("|cF")),
            ("|c1270090A00", Some("|cF")),
            ("|X", None),
        ] {
            assert_eq!(answer(&mut unit, command, &[]).as_deref(), reply, "{command}");
        }
        let failed = answer(&mut unit, "|X", &[Quirk::UnknownFails]);
        assert_eq!(failed.as_deref(), Some("|XF"));
    }

    #[test]
    fn a_configuration_without_a_name_keeps_the_old_one() {
        let mut unit = unit(&[]);
        assert_eq!(answer(&mut unit, "|c1270090E05", &[Quirk::Config12]).as_deref(), Some("|cK"));
        let status = answer(&mut unit, "|h", &[]).unwrap();
        assert!(status.starts_with("|h2\x00173270 90E0   0999999\0Tower "), "{status:?}");
    }

    #[test]
    fn faults_of_the_device_are_reported_and_felt() {
        let mut unit = unit(&[Fault::Panic, Fault::Refuse, Fault::NoSensor(RotatorNumber::One)]);
        assert!(answer(&mut unit, "|h", &[]).unwrap().starts_with("|h2\x07999359"));
        assert_eq!(answer(&mut unit, "|S", &[]).as_deref(), Some("|SK"));
        unit.set_switches(&switches(&[Fault::Refuse]));
        assert_eq!(answer(&mut unit, "|P1", &[]).as_deref(), Some("|PF"));
        unit.set_switches(&switches(&[Fault::Stuck(RotatorNumber::One)]));
        assert_eq!(answer(&mut unit, "|A1200", &[]).as_deref(), Some("|AK"));
        unit.advance(Duration::from_secs(5));
        let status = answer(&mut unit, "|h", &[]).unwrap();
        assert!(status.starts_with("|h2\x00173359  0A1   0200173\0"), "{status:?}");
    }

    #[test]
    fn asking_more_often_changes_nothing() {
        let run = |pause_ms| {
            let mut unit = unit(&[]);
            answer(&mut unit, "|A1300", &[]);
            for now in (0..=9990).step_by(pause_ms) {
                unit.advance(Duration::from_millis(now));
            }
            unit.snapshot()
        };
        assert_eq!(run(10), run(9990));
        assert!(run(10).rotators[0].angle_deg > 200.0);
    }
}
