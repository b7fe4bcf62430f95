//! Parts of a rig for whole passes.

use std::time::Duration;

use azel::{
    astro::time::seconds_between,
    contract::driver::Event,
    plan::{TrackPhase, TrackStats},
    sim::{Control, Unit},
};
use jiff::Timestamp;

pub(super) use crate::common::rig::{Rig, session};

/// Interval of the operator's looks, coarse because passes are long.
pub(super) const LOOK: Duration = Duration::from_millis(20);

impl<U: Unit> Rig<Control<U>> {
    pub(super) async fn until_utc(&mut self, time: Timestamp) {
        let left_s = seconds_between(self.clock.utc(), time);
        self.seconds(left_s.max(0.0)).await;
    }

    /// Waits for the end of the tracked pass and returns its statistics.
    pub(super) async fn until_over(&mut self) -> TrackStats {
        let is_over = |event: &Event| matches!(event, Event::ProgramTrackOver { .. });
        match self.until_event(3000, is_over).await {
            Event::ProgramTrackOver { stats, .. } => stats,
            other => panic!("{other:?}"),
        }
    }

    /// Returns the phase of the track, if there is one.
    pub(super) fn phase(&self) -> Option<TrackPhase> {
        self.shown().program_track.as_ref().map(|view| view.phase)
    }
}

/// Prints a line of the table; returns root mean square and worst error in degrees.
pub(super) fn figures(what: &str, stats: TrackStats) -> (f64, f64) {
    let [rms, worst] = [stats.rms(), stats.worst()].map(|off| off.unwrap().degrees());
    println!("{what:44} | rms {rms:6.3} | worst {worst:7.3} | {:4} commands", stats.commands);
    (rms, worst)
}
