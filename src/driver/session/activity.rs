//! What an antenna is wanted to do, and how far that is.

use super::{on_board::Watch, program_track::Tracking};
use crate::{
    clock::Instant,
    device::{Motion, Pointing, TrackTarget},
    driver::Intent,
};

/// One at a time: whatever begins another one ends the one before.
pub(super) enum Activity {
    /// Nothing is to move.
    Standby,
    /// Jogs and steps by hand.
    Manual,
    /// Stays where it is, ready for a direction; after program track with what was
    /// tracked.
    Hold(Option<Box<Tracking>>),
    /// Goes to a direction, and stays there.
    GoTo(GoTo),
    /// The unit tracks a pass by itself.
    OnBoardTrack(Box<OnBoardTrack>),
    /// Azel commands position by position.
    ProgramTrack(Box<Tracking>),
}

/// A go-to or the way to park.
pub(super) struct GoTo {
    pub(super) parks: bool,
    pub(super) aim: Option<Pointing>,
    pub(super) stage: GoToStage,
}

/// How far a go-to is.
#[derive(Clone, Copy)]
pub(super) enum GoToStage {
    /// Is sent as soon as the antenna stands.
    Queued { motion: Motion, leg: Option<Leg> },
    /// On its way; `since` is when it was sent or seen to turn last.
    UnderWay { since: Instant, leg: Option<Leg> },
    /// It has arrived, or ended short.
    Over,
}

/// The first of two motions to a position, one axis after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    /// Where it ends.
    pub(super) aim: Pointing,
    /// The motion after it.
    pub(super) then: Motion,
}

/// A pass that the unit is to track by itself.
pub(super) struct OnBoardTrack {
    pub(super) target: TrackTarget,
    pub(super) watch: Watch,
    pub(super) stage: OnBoardStage,
}

/// How far the start of the unit's own program is.
#[derive(Clone, Copy)]
pub(super) enum OnBoardStage {
    /// The target goes to the unit as soon as the antenna stands.
    LoadQueued,
    /// The target is on its way to the unit.
    Loading { since: Instant },
    /// The unit holds the target; its program is started as soon as the antenna stands.
    StartQueued,
    /// Its program was started, and was not seen to run yet.
    Starting { since: Instant },
    /// The unit was seen tracking.
    Tracking,
}

/// Goes to the gate as soon as the antenna stands.
pub(super) enum Queued {
    Motion(Motion),
    Load(TrackTarget),
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

    /// Whether the antenna was not seen to do it yet.
    pub(super) fn is_pending(&self) -> bool {
        match self {
            Self::GoTo(go_to) => !matches!(go_to.stage, GoToStage::Over),
            Self::OnBoardTrack(track) => !matches!(track.stage, OnBoardStage::Tracking),
            _ => false,
        }
    }

    /// Whether it moves the antenna, or may at any time.
    pub(super) fn may_move(&self) -> bool {
        self.is_pending() || self.intent() == Intent::Track
    }

    /// The direction that it leads to, where it is one that stays.
    pub(super) fn aim(&self) -> Option<Pointing> {
        match self {
            Self::GoTo(go_to) => go_to.aim,
            Self::ProgramTrack(following) => following.aim,
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
            Self::ProgramTrack(following) => Some(following),
            _ => None,
        }
    }

    pub(super) fn program_mut(&mut self) -> Option<&mut Tracking> {
        match self {
            Self::ProgramTrack(following) => Some(following),
            _ => None,
        }
    }

    /// The program track that runs, or whose last pass is over.
    pub(super) fn last_program(&self) -> Option<&Tracking> {
        match self {
            Self::ProgramTrack(following) | Self::Hold(Some(following)) => Some(following),
            _ => None,
        }
    }

    pub(super) fn last_program_mut(&mut self) -> Option<&mut Tracking> {
        match self {
            Self::ProgramTrack(following) | Self::Hold(Some(following)) => Some(following),
            _ => None,
        }
    }

    /// A halt that was not pressed leaves the mode, and nothing of what ran in it.
    pub(super) fn halt(&mut self) {
        *self = match self {
            Self::Manual => Self::Manual,
            Self::Hold(_) | Self::GoTo(GoTo { parks: false, .. }) => Self::Hold(None),
            _ => Self::Standby,
        };
    }

    /// What waits for standstill; it counts as sent `now`.
    pub(super) fn take_queued(&mut self, now: Instant) -> Option<Queued> {
        match self {
            Self::GoTo(go_to) => {
                let GoToStage::Queued { motion, leg } = go_to.stage else { return None };
                go_to.stage = GoToStage::UnderWay { since: now, leg };
                Some(Queued::Motion(motion))
            }
            Self::OnBoardTrack(track) => match track.stage {
                OnBoardStage::LoadQueued => {
                    track.stage = OnBoardStage::Loading { since: now };
                    Some(Queued::Load(track.target.clone()))
                }
                OnBoardStage::StartQueued => {
                    track.stage = OnBoardStage::Starting { since: now };
                    Some(Queued::Motion(Motion::StartProgram))
                }
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn is_queued(&self) -> bool {
        match self {
            Self::GoTo(go_to) => matches!(go_to.stage, GoToStage::Queued { .. }),
            Self::OnBoardTrack(track) => {
                matches!(track.stage, OnBoardStage::LoadQueued | OnBoardStage::StartQueued)
            }
            _ => false,
        }
    }

    /// The link is lost: nothing that waits is sent on the next one, but its outcome is
    /// still told.
    pub(super) fn drop_queued(&mut self, now: Instant) {
        self.take_queued(now);
    }
}
