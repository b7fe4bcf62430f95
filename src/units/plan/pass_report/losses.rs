//! Losses of a pass, and their causes.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    APART_S, COMES_BACK_S, TrackPoint, TrackedPass,
    following::Following,
    stretches::{Stretch, StretchState},
};
use crate::{
    astro::time::{add_seconds, seconds_between},
    plan::trackability::{Loss, Trackability},
};

/// Part of a pass outside the beam or without positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LostStretch {
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    pub cause: LossCause,
}

impl LostStretch {
    pub fn seconds(&self) -> f64 {
        seconds_between(self.start, self.end)
    }

    /// Returns `true` if the error in this stretch comes from pointing or from the drives. If an
    /// antenna is still on its way at the end of the counted part, its drives may never reach the
    /// satellite.
    pub(super) fn is_judged(&self, end: Timestamp) -> bool {
        match self.cause {
            LossCause::OutsideBeam | LossCause::EarlyEnd => true,
            LossCause::LateStart => self.end >= end,
            LossCause::NotMeasured
            | LossCause::LinkLost
            | LossCause::ProgramEnded
            | LossCause::OutOfReach
            | LossCause::Keyhole
            | LossCause::RateOfMount
            | LossCause::Slew
            | LossCause::Stopped
            | LossCause::NoEffect
            | LossCause::GivenUp
            | LossCause::ForeignHands
            | LossCause::Forbidden
            | LossCause::NotCommanded => false,
        }
    }
}

/// Cause of a lost stretch, as far as positions and mount show it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossCause {
    /// Missing positions.
    NotMeasured,
    /// Lost link to the unit, with no positions.
    LinkLost,
    /// End of the program; later events are unknown.
    ProgramEnded,
    /// Satellite beyond the reach of the mount.
    OutOfReach,
    /// Keyhole of the mount: near it, an axis would have had to turn faster than possible.
    Keyhole,
    /// Rate limit: an axis would have had to turn faster than possible, overhead or on the way back
    /// into its reach.
    RateOfMount,
    /// Slew of the axis by a whole turn.
    Slew,
    /// Late arrival of the antenna at the satellite.
    LateStart,
    /// Early end: the antenna no longer followed the satellite.
    EarlyEnd,
    /// STOP by the operator.
    Stopped,
    /// STOP by Azel after a motion of an axis without effect.
    NoEffect,
    /// End of the pass by Azel after the antenna had stayed off its target.
    GivenUp,
    /// Motion of the antenna by somebody else.
    ForeignHands,
    /// STOP by Azel at a barrier.
    Forbidden,
    /// Missing command to track this pass.
    NotCommanded,
    /// Pointing error: the antenna followed the satellite beyond half the beamwidth.
    #[serde(alias = "not_explained")]
    OutsideBeam,
}

impl LossCause {
    /// Returns `true` for a loss that the mount explains, if the loss was no larger than necessary.
    pub fn is_of_mount(self) -> bool {
        match self {
            Self::OutOfReach | Self::Keyhole | Self::RateOfMount | Self::Slew => true,
            Self::NotMeasured
            | Self::LinkLost
            | Self::ProgramEnded
            | Self::LateStart
            | Self::EarlyEnd
            | Self::Stopped
            | Self::NoEffect
            | Self::GivenUp
            | Self::ForeignHands
            | Self::Forbidden
            | Self::NotCommanded
            | Self::OutsideBeam => false,
        }
    }

    /// Returns `true` if nothing is known about the antenna.
    pub(super) fn is_unknown(self) -> bool {
        matches!(self, Self::NotMeasured | Self::LinkLost | Self::ProgramEnded)
    }
}

impl TrackedPass<'_> {
    /// Returns the lost stretches; the positions in `points` show their causes.
    pub(super) fn losses(&self, stretches: &[Stretch], points: &[TrackPoint]) -> Vec<LostStretch> {
        let end = self.ended.unwrap_or(self.end);
        let commanded = self.breaks.commanded(self.start, end).into_iter();
        let followed: Vec<(Timestamp, Following)> = commanded
            .map(|(start, stop_time)| {
                let near = add_seconds(start, -APART_S)..=add_seconds(stop_time, APART_S);
                let own = points.iter().filter(|point| near.contains(&point.time));
                (stop_time, self.following(&own.collect::<Vec<_>>()))
            })
            .collect();
        let lost = stretches.iter().flat_map(|stretch| match stretch.state {
            StretchState::InBeam => Vec::new(),
            StretchState::NotMeasured => self.not_measured(stretch),
            StretchState::NotCommanded => self.not_commanded(stretch),
            StretchState::Outside => {
                let own = followed.iter().find(|(end, _)| stretch.start < *end);
                self.outside(stretch, own.map(|(_, following)| *following).unwrap_or_default())
            }
        });
        let ended = self.ended.into_iter();
        let ended = ended.flat_map(|begin| self.in_parts(begin, self.end, LossCause::ProgramEnded));
        let mut losses: Vec<LostStretch> = Vec::new();
        for lost in lost.chain(ended) {
            match losses.last_mut() {
                Some(last) if last.cause == lost.cause && last.end == lost.start => {
                    last.end = lost.end;
                }
                _ => losses.push(lost),
            }
        }
        losses
    }

    fn not_measured(&self, stretch: &Stretch) -> Vec<LostStretch> {
        let Stretch { start, end, .. } = *stretch;
        let is_lost = self.breaks.lost_link(start, end);
        let loss_cause = if is_lost { LossCause::LinkLost } else { LossCause::NotMeasured };
        self.in_parts(start, end, loss_cause)
    }

    /// Returns the losses of a stretch in which the antenna had no command to track this pass.
    fn not_commanded(&self, stretch: &Stretch) -> Vec<LostStretch> {
        let Stretch { start, end, .. } = *stretch;
        if let Some((stop, loss_cause)) = self.breaks.stopped(start, end) {
            let mut lost = self.in_parts(start, stop, LossCause::NotCommanded);
            lost.extend(self.in_parts(stop, end, loss_cause));
            return lost;
        }
        // A track that ended with its link continues only with the operator's permission.
        let reason = if self.breaks.is_link_lost_at(start) {
            LossCause::LinkLost
        } else {
            LossCause::NotCommanded
        };
        self.in_parts(start, end, reason)
    }

    /// Returns the losses of a stretch beyond half the beamwidth.
    fn outside(&self, stretch: &Stretch, following: Following) -> Vec<LostStretch> {
        let Stretch { start, end, .. } = *stretch;
        let stop = self.breaks.stopped(start, end);
        let before = stop.map_or(end, |(stop, _)| stop);
        let mut lost = if let Some(cause) = self.loss_of_mount(start, before) {
            self.in_parts(start, before, cause)
        } else {
            let arrived = following.start.unwrap_or(before).clamp(start, before);
            let left = following.end.unwrap_or(before).clamp(arrived, before);
            let mut lost = self.in_parts(start, arrived, LossCause::LateStart);
            lost.extend(self.in_parts(arrived, left, LossCause::OutsideBeam));
            lost.extend(self.in_parts(left, before, LossCause::EarlyEnd));
            lost
        };
        if let Some((stop, loss_cause)) = stop {
            lost.extend(self.in_parts(stop, end, loss_cause));
        }
        lost
    }

    /// Returns the loss of the mount between two times, if a loss was necessary there and the
    /// actual loss is no larger.
    fn loss_of_mount(&self, start: Timestamp, end: Timestamp) -> Option<LossCause> {
        let Trackability::Loses { loss, start: first, end: last, .. } = self.trackability else {
            return None;
        };
        let is_there = start <= add_seconds(last, COMES_BACK_S)
            && add_seconds(first, -COMES_BACK_S) <= end
            && seconds_between(start, end) <= self.allowed_s();
        match loss {
            _ if !is_there => None,
            Loss::Keyhole(_) => Some(LossCause::Keyhole),
            Loss::Overhead => Some(LossCause::RateOfMount),
            Loss::Slew => Some(LossCause::Slew),
            Loss::BeyondAzimuth(_) | Loss::OutOfReach
                if self.reached_s(start, end) <= COMES_BACK_S =>
            {
                Some(LossCause::OutOfReach)
            }
            // An axis is too slow, or on its way back into its reach.
            Loss::BeyondAzimuth(_) | Loss::OutOfReach
                if self.is_reached() || !self.is_in_reach(add_seconds(start, 1.0)) =>
            {
                Some(LossCause::RateOfMount)
            }
            Loss::BeyondAzimuth(_) | Loss::OutOfReach => None,
        }
    }

    /// Returns `true` if the whole pass is within reach of the mount.
    fn is_reached(&self) -> bool {
        self.reached_s(self.start, self.end) >= seconds_between(self.start, self.end)
    }

    /// Returns the seconds in which the satellite was within reach of the mount.
    fn reached_s(&self, start: Timestamp, end: Timestamp) -> f64 {
        let seconds = 0..seconds_between(start, end).ceil().max(0.0) as u32;
        let time = |second: &u32| add_seconds(start, f64::from(*second));
        seconds.filter(|second| self.is_in_reach(time(second))).count() as f64
    }

    /// Returns a lost stretch with this cause, split where the satellite was out of reach of the
    /// mount. That part is lost regardless of the measurements, because an axis at its limit may
    /// report no angle.
    fn in_parts(
        &self,
        start: Timestamp,
        end: Timestamp,
        loss_cause: LossCause,
    ) -> Vec<LostStretch> {
        let mut found: Vec<LostStretch> = Vec::new();
        let seconds = seconds_between(start, end).ceil().max(0.0) as u32;
        for second in 0..seconds {
            let time = |second: u32| add_seconds(start, f64::from(second)).min(end);
            let cause =
                if self.is_in_reach(time(second)) { loss_cause } else { LossCause::OutOfReach };
            match found.last_mut() {
                Some(last) if last.cause == cause => last.end = time(second + 1),
                _ => found.push(LostStretch { start: time(second), end: time(second + 1), cause }),
            }
        }
        if found.len() > 1 {
            found.retain(|loss| loss.cause == LossCause::OutOfReach || loss.seconds() > APART_S);
        }
        found
    }
}
