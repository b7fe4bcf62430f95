//! What was lost of a pass, and why.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{APART_S, TrackPoint, TrackedPass};
use crate::{
    astro::time::{add_seconds, seconds_between},
    plan::trackability::{Loss, Trackability},
};

/// A stretch of a pass that was lost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LostStretch {
    pub from: Timestamp,
    pub until: Timestamp,
    pub cause: LossCause,
}

impl LostStretch {
    pub fn seconds(&self) -> f64 {
        seconds_between(self.from, self.until)
    }
}

/// Why a stretch was lost, as far as positions and mount tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossCause {
    /// No positions came in.
    NotMeasured,
    /// The program ended: nothing is known of what came after.
    ProgramEnded,
    /// The mount cannot point there.
    OutOfReach,
    /// An axis would have had to turn faster than it can: near a keyhole or overhead.
    RateOfMount,
    /// The axis had to slew a whole turn.
    Slew,
    /// The antenna had not arrived at the satellite yet.
    LateStart,
    /// The antenna had left the satellite before its end.
    EarlyEnd,
    NotExplained,
}

impl TrackedPass<'_> {
    pub(super) fn losses(&self, compared: &[TrackPoint]) -> Vec<LostStretch> {
        let mut losses: Vec<LostStretch> = Vec::new();
        let mut seen_to = self.from;
        let mut out_since: Option<Timestamp> = None;
        let mut has_arrived = false;
        let end =
            |since: Timestamp, until: Timestamp, has_arrived: bool, is_over: bool| LostStretch {
                from: since,
                until,
                cause: self.cause(since, until, has_arrived, is_over),
            };
        for position in compared {
            if seconds_between(seen_to, position.time) > APART_S {
                losses
                    .extend(out_since.take().map(|since| end(since, seen_to, has_arrived, false)));
                let (from, until) = (seen_to, position.time);
                losses.extend(self.not_known(from, until, LossCause::NotMeasured));
                seen_to = position.time;
            }
            if self.is_in_beam(position) {
                losses.extend(
                    out_since.take().map(|since| end(since, position.time, has_arrived, false)),
                );
                has_arrived = true;
            } else if out_since.is_none() {
                out_since = Some(seen_to);
            }
            seen_to = position.time;
        }
        let last = self.ended.unwrap_or(self.until);
        let is_measured = seconds_between(seen_to, last) <= APART_S;
        let until = if is_measured { last } else { seen_to };
        losses.extend(out_since.map(|since| end(since, until, has_arrived, self.ended.is_none())));
        if !is_measured {
            let (from, until) = (seen_to, last);
            losses.extend(self.not_known(from, until, LossCause::NotMeasured));
        }
        let ended = self.ended.into_iter();
        losses.extend(
            ended.flat_map(|from| self.not_known(from, self.until, LossCause::ProgramEnded)),
        );
        losses
    }

    /// Why the beam was off the satellite between two times.
    fn cause(
        &self,
        from: Timestamp,
        until: Timestamp,
        has_arrived: bool,
        is_over: bool,
    ) -> LossCause {
        let middle = add_seconds(from, seconds_between(from, until) / 2.0);
        let times = [from, middle, until];
        let mut directions = times.iter().filter_map(|at| self.direction(*at));
        if directions.any(|direction| !self.limits.mount.reaches(direction)) {
            return LossCause::OutOfReach;
        }
        if let Trackability::Loses { at, .. } = self.trackability
            && has_arrived
            && !is_over
            && seconds_between(from, until) <= self.allowed_s()
        {
            return match at {
                Loss::Keyhole(_) | Loss::Overhead => LossCause::RateOfMount,
                Loss::Slew => LossCause::Slew,
                Loss::OutOfReach => LossCause::OutOfReach,
            };
        }
        match (has_arrived, is_over) {
            (false, _) => LossCause::LateStart,
            (true, true) => LossCause::EarlyEnd,
            (true, false) => LossCause::NotExplained,
        }
    }

    /// A stretch of which no direction is known, for this reason. What is out of reach of the mount
    /// is lost whatever was measured: an axis at its limit may tell no angle.
    fn not_known(&self, from: Timestamp, until: Timestamp, why: LossCause) -> Vec<LostStretch> {
        let mut found: Vec<LostStretch> = Vec::new();
        let seconds = seconds_between(from, until).ceil().max(0.0) as u32;
        for second in 0..seconds {
            let at = |second: u32| add_seconds(from, f64::from(second)).min(until);
            let cause = if self.is_in_reach(at(second)) { why } else { LossCause::OutOfReach };
            match found.last_mut() {
                Some(last) if last.cause == cause => last.until = at(second + 1),
                _ => found.push(LostStretch { from: at(second), until: at(second + 1), cause }),
            }
        }
        if found.len() > 1 {
            found.retain(|loss| loss.cause == LossCause::OutOfReach || loss.seconds() > APART_S);
        }
        found
    }
}
