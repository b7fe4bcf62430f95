//! Counts of an antenna, for monitoring.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::{automatic::Flown, clock::Instant, driver};

/// Counts of one antenna since its session began, and times of its last STOP.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Tally {
    pub passes: PassTally,
    pub stops: StopTally,
}

/// Outcomes of the passes that the schedule gave to the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct PassTally {
    /// Passes tracked in full.
    pub whole: u64,
    /// Passes of which a part was lost.
    pub partial: u64,
    /// Passes of which nothing was tracked.
    pub missed: u64,
    /// Seconds that were to be tracked.
    pub planned_s: f64,
    /// Seconds with the satellite within half the beamwidth.
    pub in_beam_s: f64,
}

impl PassTally {
    /// Counts the outcome of a pass.
    pub fn count(&mut self, flown: &Flown) {
        self.planned_s += flown.of_s.max(0.0);
        self.in_beam_s += flown.in_beam_s.max(0.0);
        let count = if flown.in_beam_s <= 0.0 {
            &mut self.missed
        } else if flown.cause.is_none() {
            &mut self.whole
        } else {
            &mut self.partial
        };
        *count += 1;
    }
}

/// STOPs of the operator, and the times of the last one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct StopTally {
    pub pressed: u64,
    /// STOPs whose standstill was proved before the next press.
    pub proved: u64,
    /// Time from the last press with a written STOP to the end of its first write to the link.
    pub latency: Option<Duration>,
    /// Time from the last press with a proof to the proof of standstill.
    pub proof: Option<Duration>,
    /// Press whose write is still missing.
    pending_write: Option<Instant>,
    /// Press whose proof is still missing.
    pending_proof: Option<Instant>,
}

impl StopTally {
    /// Counts a press.
    pub fn press(&mut self, time: Instant) {
        self.pressed += 1;
        (self.pending_write, self.pending_proof) = (Some(time), Some(time));
    }

    /// Takes the times of the last STOP from the snapshot of the session.
    pub fn follow(&mut self, snapshot: &driver::Snapshot) {
        let is_before = |press: &mut Instant, time: Instant| *press <= time;
        if let Some(written) = snapshot.stop_written
            && let Some(press) = self.pending_write.take_if(|press| is_before(press, written))
        {
            self.latency = Some(written.saturating_duration_since(press));
        }
        if let driver::StopState::Stopped { time } = snapshot.stop
            && let Some(press) = self.pending_proof.take_if(|press| is_before(press, time))
        {
            self.proof = Some(time.saturating_duration_since(press));
            self.proved += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        automatic::MissCause,
        driver::{LinkState, Snapshot, StopState},
    };

    fn flown(in_beam_s: f64, cause: Option<MissCause>) -> Flown {
        let pass = (25_544, Timestamp::UNIX_EPOCH);
        Flown { pass, name: String::new(), of_s: 600.0, in_beam_s, proved_at: None, cause }
    }

    #[test]
    fn each_pass_counts_once() {
        let mut tally = PassTally::default();
        tally.count(&flown(600.0, None));
        tally.count(&flown(400.0, Some(MissCause::OffTarget)));
        tally.count(&flown(0.0, Some(MissCause::Refused)));
        assert_eq!((tally.whole, tally.partial, tally.missed), (1, 1, 1));
        assert_eq!((tally.planned_s, tally.in_beam_s), (1800.0, 1000.0));
    }

    #[test]
    fn times_of_a_stop_count_from_its_own_press() {
        let start = Instant::now();
        let later = |ms| start + Duration::from_millis(ms);
        let mut tally = StopTally::default();
        let old = Snapshot {
            stop: StopState::Stopped { time: start },
            stop_written: Some(start),
            ..Snapshot::before_anything(LinkState::Off)
        };
        tally.press(later(100));
        tally.follow(&old);
        assert_eq!((tally.latency, tally.proof), (None, None), "an earlier STOP");
        let written = Snapshot { stop_written: Some(later(103)), ..old.clone() };
        tally.follow(&written);
        assert_eq!((tally.latency, tally.proof), (Some(Duration::from_millis(3)), None));
        let stopped = Snapshot { stop: StopState::Stopped { time: later(900) }, ..written };
        tally.follow(&stopped);
        tally.follow(&stopped);
        assert_eq!((tally.pressed, tally.proved), (1, 1));
        assert_eq!(tally.proof, Some(Duration::from_millis(800)));
    }
}
