//! What was lost of a pass, and why.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{APART_S, COMES_BACK_S, TrackPoint, TrackedPass};
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
    /// The link to the unit was lost.
    LinkLost,
    /// The program ended: nothing is known of what came after.
    ProgramEnded,
    /// The mount cannot point there.
    OutOfReach,
    /// An axis would have had to turn faster than it can near a keyhole of its mount.
    Keyhole,
    /// An axis would have had to turn faster than it can: overhead, or on the way back to what it reaches.
    RateOfMount,
    /// The axis had to slew a whole turn.
    Slew,
    /// The antenna had not arrived at the satellite yet.
    LateStart,
    /// The antenna had left the satellite before its end.
    EarlyEnd,
    /// STOP had been pressed.
    Stopped,
    NotExplained,
}

impl TrackedPass<'_> {
    pub(super) fn losses(&self, compared: &[TrackPoint]) -> Vec<LostStretch> {
        let mut losses: Vec<LostStretch> = Vec::new();
        let mut seen_to = self.from;
        let mut out_since: Option<Timestamp> = None;
        let mut has_arrived = false;
        let lost = |since: Timestamp, until: Timestamp, has_arrived: bool, is_over: bool| {
            let stop = self.breaks.stopped(since, until);
            let before = stop.unwrap_or(until);
            let is_over = is_over && stop.is_none();
            let mut lost = Vec::new();
            if since < before {
                let cause = self.cause(since, before, has_arrived, is_over);
                lost = self.in_parts(since, before, cause);
            }
            lost.extend(
                stop.into_iter().flat_map(|at| self.in_parts(at, until, LossCause::Stopped)),
            );
            lost
        };
        for position in compared {
            if seconds_between(seen_to, position.time) > APART_S {
                let off = out_since.take().into_iter();
                losses.extend(off.flat_map(|since| lost(since, seen_to, has_arrived, false)));
                losses.extend(self.not_measured(seen_to, position.time));
                seen_to = position.time;
            }
            if self.is_in_beam(position) {
                let off = out_since.take().into_iter();
                losses.extend(off.flat_map(|since| lost(since, position.time, has_arrived, false)));
                has_arrived = true;
            } else if out_since.is_none() {
                out_since = Some(seen_to);
            }
            seen_to = position.time;
        }
        let last = self.ended.unwrap_or(self.until);
        let is_measured = seconds_between(seen_to, last) <= APART_S;
        let until = if is_measured { last } else { seen_to };
        let off = out_since.into_iter();
        losses.extend(off.flat_map(|since| lost(since, until, has_arrived, self.ended.is_none())));
        if !is_measured {
            losses.extend(self.not_measured(seen_to, last));
        }
        let ended = self.ended.into_iter();
        losses.extend(
            ended.flat_map(|from| self.in_parts(from, self.until, LossCause::ProgramEnded)),
        );
        losses
    }

    fn not_measured(&self, from: Timestamp, until: Timestamp) -> Vec<LostStretch> {
        let is_lost = self.breaks.lost_link(from, until);
        let why = if is_lost { LossCause::LinkLost } else { LossCause::NotMeasured };
        self.in_parts(from, until, why)
    }

    /// Why the beam was off a satellite within reach between two times.
    fn cause(
        &self,
        from: Timestamp,
        until: Timestamp,
        has_arrived: bool,
        is_over: bool,
    ) -> LossCause {
        if let Trackability::Loses { at, .. } = self.trackability
            && has_arrived
            && !is_over
            && seconds_between(from, until) <= self.allowed_s()
        {
            return match at {
                Loss::Keyhole(_) => LossCause::Keyhole,
                Loss::Overhead => LossCause::RateOfMount,
                Loss::Slew => LossCause::Slew,
                Loss::OutOfReach if self.reached_s(from, until) <= COMES_BACK_S => {
                    LossCause::OutOfReach
                }
                // An axis is too slow, or on its way back to what it reaches.
                Loss::OutOfReach
                    if self.is_reached() || !self.is_in_reach(add_seconds(from, 1.0)) =>
                {
                    LossCause::RateOfMount
                }
                Loss::OutOfReach => LossCause::NotExplained,
            };
        }
        match (has_arrived, is_over) {
            (false, _) => LossCause::LateStart,
            (true, true) => LossCause::EarlyEnd,
            (true, false) => LossCause::NotExplained,
        }
    }

    /// Whether all of the pass is within reach of the mount.
    fn is_reached(&self) -> bool {
        self.reached_s(self.from, self.until) >= seconds_between(self.from, self.until)
    }

    /// Seconds in which the satellite was within reach of the mount.
    fn reached_s(&self, from: Timestamp, until: Timestamp) -> f64 {
        let seconds = 0..seconds_between(from, until).ceil().max(0.0) as u32;
        let at = |second: &u32| add_seconds(from, f64::from(*second));
        seconds.filter(|second| self.is_in_reach(at(second))).count() as f64
    }

    /// A stretch that is lost for this reason, but where the satellite was out of reach of the mount:
    /// that is lost whatever was measured, since an axis at its limit may tell no angle.
    fn in_parts(&self, from: Timestamp, until: Timestamp, why: LossCause) -> Vec<LostStretch> {
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
