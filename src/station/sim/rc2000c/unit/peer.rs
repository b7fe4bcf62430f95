//! Unit as a peer on the serial line.

use std::time::Duration;

use super::{LONGEST_CATCH_UP, Rc2000c, STEP, Snapshot, stand};
use crate::{
    protocol::rc2000c::{Frame, PolarizationMotion},
    sim::{
        harness::{self, Switches},
        rc2000c::{Fault, Quirk, connection::Line},
    },
};

impl harness::Unit for Rc2000c {
    type Quirk = Quirk;
    type Fault = Fault;
    type Request = Frame;
    type Snapshot = Snapshot;
    /// Counts of azimuth and elevation.
    type Place = [u16; 2];
    type Wire = Line;

    const SILENCE: Fault = Fault::Silence;
    const NOISE: Fault = Fault::Garbage;
    const REFUSAL: Fault = Fault::Refuse;
    const SPLIT: Fault = Fault::Split;
    const MERGE: Fault = Fault::Merge;

    fn advance(&mut self, elapsed: Duration) {
        let catch_up_from = elapsed.saturating_sub(LONGEST_CATCH_UP);
        self.elapsed = self.elapsed.max(catch_up_from);
        while self.elapsed < elapsed {
            let step = STEP.min(elapsed.saturating_sub(self.elapsed));
            self.elapsed += step;
            self.step(step.as_secs_f64());
        }
    }

    fn set_switches(&mut self, switches: &Switches<Quirk, Fault>) {
        self.quirks.clone_from(&switches.quirks);
        self.faults.clone_from(&switches.faults);
        self.suffer();
    }

    fn set_strength(&mut self, [azimuth, elevation]: [f64; 2]) {
        self.azimuth.set_strength(azimuth);
        self.elevation.set_strength(elevation);
    }

    fn cut_power(&mut self) {
        self.use_panel();
    }

    fn place(&mut self, counts: [u16; 2]) {
        [self.azimuth, self.elevation] = stand(counts, &self.axes, &self.mechanics, self.seed);
        self.suffer();
    }

    fn snapshot(&self) -> Snapshot {
        let is_turning = self.azimuth.is_turning()
            || self.elevation.is_turning()
            || self.feed.motion() != PolarizationMotion::Still;
        Snapshot {
            az_counts: self.azimuth.counts(),
            el_counts: self.elevation.counts(),
            polarization_units: self.feed.units(),
            mode: self.mode,
            is_turning,
        }
    }

    fn wire(&self) -> Line {
        Line::new(self.address, self.baud)
    }
}
