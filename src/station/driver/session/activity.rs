//! Activity of an antenna, as the operator sees it, and its progress.

use std::time::Duration;

use super::{on_board::OnBoardWatch, tracking::Tracking};
use crate::{
    astro::Angle,
    clock::Instant,
    contract::driver::Intent,
    device::{Motion, Pointing, TrackTarget},
};

/// Max time until an accepted command must show in the unit's state.
const EFFECT: Duration = Duration::from_secs(5);

/// Activity of an antenna. Only one runs at a time: a new activity ends the current one.
pub(super) enum Activity {
    Standby,
    Manual,
    /// Rest until a new direction. After program track, the activity keeps its track.
    Hold(Option<Box<Tracking>>),
    /// Motion to a direction, where the antenna stays.
    GoTo(GoTo),
    OnBoardTrack(Box<OnBoardTrack>),
    /// Track for which Azel commands one position after another.
    ProgramTrack(Box<Tracking>),
}

pub(super) struct GoTo {
    pub(super) parks: bool,
    pub(super) slew: Slew,
}

/// Path to a direction, in one or more motions.
#[derive(Clone, Copy)]
pub(super) struct Slew {
    pub(super) aim: Option<Pointing>,
    pub(super) stage: SlewStage,
}

#[derive(Clone, Copy)]
pub(super) enum SlewStage {
    /// Pending motion, sent as soon as the antenna stands.
    Queued { motion: Motion, leg: Option<Leg> },
    /// Running motion; `begun` is the time of sending or discovery.
    UnderWay { begun: Instant, leg: Option<Leg> },
    /// Ended motion, at its target or short of it.
    Over,
}

/// Motion to a position on the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    pub(super) aim: Pointing,
    /// Next motion; `None` after a lost link ended the path at this position.
    pub(super) next: Option<Motion>,
}

pub(super) struct OnBoardTrack {
    pub(super) target: TrackTarget,
    pub(super) watch: OnBoardWatch,
    pub(super) stage: OnBoardStage,
}

/// Progress towards the start of the unit's own program.
#[derive(Clone, Copy)]
pub(super) enum OnBoardStage {
    /// Motion of Azel to the start of the pass, because the unit's own path there is blocked.
    Slewing(Slew),
    /// Pending target, sent to the unit as soon as the antenna stands.
    LoadQueued,
    /// Running transfer of the target to the unit, with a read-back.
    Loading { begun: Instant },
    /// Pending start: the unit has the target, and its program starts as soon as the antenna
    /// stands.
    StartQueued,
    /// Start without an observed effect: the program has not been seen running yet.
    Starting { begun: Instant },
    /// Observed track of the unit.
    Tracking,
}

/// Step that goes to the gate as soon as the antenna stands.
pub(super) enum Queued {
    Motion(Motion),
    Load(TrackTarget),
}

impl OnBoardStage {
    /// Returns `true` if the session next sends the target or the start of the unit's program.
    pub(super) fn starts_program(self) -> bool {
        match self {
            Self::LoadQueued | Self::StartQueued => true,
            Self::Slewing(_) | Self::Loading { .. } | Self::Starting { .. } | Self::Tracking => {
                false
            }
        }
    }
}

impl Activity {
    pub(super) fn intent(&self) -> Intent {
        match self {
            Self::Standby => Intent::Standby,
            Self::Manual => Intent::Manual,
            Self::GoTo(GoTo { parks: true, .. }) => Intent::Park,
            Self::GoTo(_) | Self::Hold(_) => Intent::Position,
            Self::OnBoardTrack(_) | Self::ProgramTrack(_) => Intent::Track,
        }
    }

    /// Returns `true` until the unit's state shows the activity.
    pub(super) fn is_pending(&self) -> bool {
        match self {
            Self::GoTo(go_to) => !matches!(go_to.slew.stage, SlewStage::Over),
            Self::OnBoardTrack(track) => !matches!(track.stage, OnBoardStage::Tracking),
            _ => false,
        }
    }

    /// Returns `true` if the activity moves the antenna, or may do so at any time.
    pub(super) fn may_move(&self) -> bool {
        self.is_pending() || self.intent() == Intent::Track
    }

    /// Returns the target direction, if it is fixed.
    pub(super) fn aim(&self) -> Option<Pointing> {
        match self {
            Self::ProgramTrack(track) => track.aim(),
            _ => self.slew().and_then(|slew| slew.aim),
        }
    }

    /// Returns the path of the activity, finished or not.
    pub(super) fn slew(&self) -> Option<&Slew> {
        match self {
            Self::GoTo(go_to) => Some(&go_to.slew),
            Self::OnBoardTrack(track) => match &track.stage {
                OnBoardStage::Slewing(slew) => Some(slew),
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn slew_mut(&mut self) -> Option<&mut Slew> {
        match self {
            Self::GoTo(go_to) => Some(&mut go_to.slew),
            Self::OnBoardTrack(track) => match &mut track.stage {
                OnBoardStage::Slewing(slew) => Some(slew),
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn on_board(&self) -> Option<&OnBoardTrack> {
        match self {
            Self::OnBoardTrack(track) => Some(track),
            _ => None,
        }
    }

    pub(super) fn on_board_mut(&mut self) -> Option<&mut OnBoardTrack> {
        match self {
            Self::OnBoardTrack(track) => Some(track),
            _ => None,
        }
    }

    pub(super) fn program(&self) -> Option<&Tracking> {
        match self {
            Self::ProgramTrack(track) => Some(track),
            _ => None,
        }
    }

    pub(super) fn program_mut(&mut self) -> Option<&mut Tracking> {
        match self {
            Self::ProgramTrack(track) => Some(track),
            _ => None,
        }
    }

    /// Returns the program track that is running or has finished its last pass.
    pub(super) fn last_program(&self) -> Option<&Tracking> {
        match self {
            Self::ProgramTrack(track) | Self::Hold(Some(track)) => Some(track),
            _ => None,
        }
    }

    pub(super) fn last_program_mut(&mut self) -> Option<&mut Tracking> {
        match self {
            Self::ProgramTrack(track) | Self::Hold(Some(track)) => Some(track),
            _ => None,
        }
    }

    /// Ends the current motion after a halt without an operator's STOP; the mode stays.
    pub(super) fn halt(&mut self) {
        *self = match self {
            Self::Manual => Self::Manual,
            Self::Hold(_) | Self::GoTo(GoTo { parks: false, .. }) => Self::Hold(None),
            _ => Self::Standby,
        };
    }

    /// Takes the step that waits for standstill, and counts it as sent at `now`.
    pub(super) fn take_queued(&mut self, now: Instant) -> Option<Queued> {
        if let Some(slew) = self.slew_mut() {
            let SlewStage::Queued { motion, leg } = slew.stage else { return None };
            slew.stage = SlewStage::UnderWay { begun: now, leg };
            return Some(Queued::Motion(motion));
        }
        match self {
            Self::OnBoardTrack(track) => match track.stage {
                OnBoardStage::LoadQueued => {
                    track.stage = OnBoardStage::Loading { begun: now };
                    Some(Queued::Load(track.target.clone()))
                }
                OnBoardStage::StartQueued => {
                    track.stage = OnBoardStage::Starting { begun: now };
                    Some(Queued::Motion(Motion::StartProgram))
                }
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn is_queued(&self) -> bool {
        if let Some(slew) = self.slew() {
            return matches!(slew.stage, SlewStage::Queued { .. });
        }
        self.on_board().is_some_and(|track| {
            matches!(track.stage, OnBoardStage::LoadQueued | OnBoardStage::StartQueued)
        })
    }

    /// Drops the pending step after a lost link, but still reports its outcome.
    pub(super) fn drop_queued(&mut self, now: Instant) {
        self.take_queued(now);
        if let Some(Slew { stage: SlewStage::UnderWay { leg: Some(leg), .. }, .. }) =
            self.slew_mut()
        {
            leg.next = None;
        }
    }
}

/// Outcome of a slew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Arrival {
    /// Position on the path: this motion is next.
    Leg(Motion),
    At(Pointing),
    /// Stop short of the target.
    Short {
        aim: Pointing,
    },
}

impl Slew {
    /// Returns the end of the running motion, if any.
    pub(super) fn current_aim(&self) -> Option<Pointing> {
        match self.stage {
            SlewStage::UnderWay { leg, .. } => leg.map(|leg| leg.aim).or(self.aim),
            SlewStage::Queued { .. } | SlewStage::Over => None,
        }
    }

    /// Returns `false` if the first motion leads to the current position.
    pub(super) fn leads_on(&self, position: Pointing, tolerance: Angle) -> bool {
        match self.stage {
            SlewStage::Queued { leg: Some(Leg { aim, .. }), .. } => {
                position.deviation(aim).is_none_or(|deviation| deviation > tolerance)
            }
            SlewStage::Queued { leg: None, .. } | SlewStage::UnderWay { .. } | SlewStage::Over => {
                true
            }
        }
    }

    /// Compares the running motion with a position requested at `requested`, at which the unit's
    /// flags reported standstill. `turned`: time of the last change of the angles.
    pub(super) fn watch(
        &mut self,
        position: Pointing,
        requested: Instant,
        turned: Option<Instant>,
        tolerance: Angle,
        now: Instant,
    ) -> Option<Arrival> {
        let SlewStage::UnderWay { begun, leg } = self.stage else { return None };
        let (aim, end) = (self.current_aim()?, self.aim?);
        if requested <= begun {
            return None;
        }
        // A motion continues while its angles change, even if the flags report standstill.
        let last_turn = turned.map_or(begun, |turned| turned.max(begun));
        let is_near = position.deviation(aim).is_some_and(|deviation| deviation <= tolerance);
        let arrival = match leg {
            Some(Leg { next: Some(next), .. }) if is_near => Arrival::Leg(next),
            Some(Leg { next: None, .. }) if is_near => Arrival::Short { aim: end },
            None if is_near => Arrival::At(aim),
            _ if now.saturating_duration_since(last_turn) >= EFFECT => Arrival::Short { aim: end },
            _ => return None,
        };
        self.stage = SlewStage::Over;
        Some(arrival)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::AzEl;

    #[test]
    fn a_way_that_begins_at_the_corner_where_the_antenna_stands_leads_on_nowhere() {
        let aimed = |azimuth_deg| Pointing::from(AzEl::from_degrees(azimuth_deg, 20.0));
        let next = Motion::Position { azimuth: Some(Angle::from_degrees(200.0)), elevation: None };
        let slew =
            |leg| Slew { aim: Some(aimed(200.0)), stage: SlewStage::Queued { motion: next, leg } };
        let round_a_corner = slew(Some(Leg { aim: aimed(100.0), next: Some(next) }));
        let tolerance = Angle::from_degrees(0.5);
        assert!(!round_a_corner.leads_on(aimed(100.2), tolerance));
        assert!(round_a_corner.leads_on(aimed(99.0), tolerance));
        assert!(slew(None).leads_on(aimed(199.9), tolerance), "the last motion may be a short one");
    }
}
