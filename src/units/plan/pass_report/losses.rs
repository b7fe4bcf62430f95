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

/// A stretch of a pass that was lost.
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

    /// Returns `true` if the error in it is one of pointing or of the drives. An antenna that is on
    /// its way to the end of what counts may have drives that never bring it there.
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
    /// The antenna was still on its way to the satellite.
    LateStart,
    /// The antenna followed the satellite no more.
    EarlyEnd,
    /// STOP had been pressed.
    Stopped,
    /// An axis had not turned as commanded, and Azel had stopped the antenna.
    NoEffect,
    /// The antenna had stayed off its target, and Azel had given up the pass.
    GivenUp,
    /// Somebody else had moved the antenna.
    ForeignHands,
    /// Azel had stopped the antenna at a barrier.
    Forbidden,
    /// The antenna had no command to track this pass.
    NotCommanded,
    /// The antenna followed the satellite beyond half the beamwidth: a pointing error.
    #[serde(alias = "not_explained")]
    OutsideBeam,
}

impl LossCause {
    /// Returns `true` for what the mount had to lose, if it was no more than that.
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

    /// Returns `true` where nothing is known of the antenna.
    pub(super) fn is_unknown(self) -> bool {
        matches!(self, Self::NotMeasured | Self::LinkLost | Self::ProgramEnded)
    }
}

impl TrackedPass<'_> {
    /// The stretches that were lost, with the positions that tell why.
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

    /// A stretch in which the antenna had no command to track this pass.
    fn not_commanded(&self, stretch: &Stretch) -> Vec<LostStretch> {
        let Stretch { start, end, .. } = *stretch;
        if let Some((stop, loss_cause)) = self.breaks.stopped(start, end) {
            let mut lost = self.in_parts(start, stop, LossCause::NotCommanded);
            lost.extend(self.in_parts(stop, end, loss_cause));
            return lost;
        }
        // A track that ended with its link goes on only once the operator agrees.
        let reason = if self.breaks.is_link_lost_at(start) {
            LossCause::LinkLost
        } else {
            LossCause::NotCommanded
        };
        self.in_parts(start, end, reason)
    }

    /// A stretch beyond half the beamwidth.
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

    /// The loss of the mount between two times, if that is where it had to lose something, and no
    /// more than it had to.
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
            // An axis is too slow, or on its way back to what it reaches.
            Loss::BeyondAzimuth(_) | Loss::OutOfReach
                if self.is_reached() || !self.is_in_reach(add_seconds(start, 1.0)) =>
            {
                Some(LossCause::RateOfMount)
            }
            Loss::BeyondAzimuth(_) | Loss::OutOfReach => None,
        }
    }

    /// Returns `true` if all of the pass is within reach of the mount.
    fn is_reached(&self) -> bool {
        self.reached_s(self.start, self.end) >= seconds_between(self.start, self.end)
    }

    /// Seconds in which the satellite was within reach of the mount.
    fn reached_s(&self, start: Timestamp, end: Timestamp) -> f64 {
        let seconds = 0..seconds_between(start, end).ceil().max(0.0) as u32;
        let time = |second: &u32| add_seconds(start, f64::from(*second));
        seconds.filter(|second| self.is_in_reach(time(second))).count() as f64
    }

    /// A stretch that is lost for this reason, but where the satellite was out of reach of the mount:
    /// that is lost whatever was measured, since an axis at its limit may tell no angle.
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
