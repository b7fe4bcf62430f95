//! Following a target position by position, on the session's own clock.

use std::time::Instant;

use super::{Event, Session};
use crate::{
    controller::Moment,
    driver::{FollowProblem, FollowView, Intent},
    plan::{Follow, FollowPhase, FollowStats, Sample, follow::Course},
    station::AfterPass,
};

/// A target that is followed.
pub(super) struct Following {
    follow: Follow,
    course: Course,
    /// The phase that was told last.
    told: Option<FollowPhase>,
    stats: FollowStats,
    next_look: Option<Instant>,
    predicted: Option<Sample>,
}

impl Following {
    pub(super) fn view(&self) -> FollowView {
        FollowView {
            name: self.follow.target.name().into_owned(),
            catalog_number: self.follow.target.catalog_number(),
            phase: self.told.unwrap_or(FollowPhase::Following),
            stats: self.stats,
            next_look: self.next_look,
            predicted: self.predicted,
        }
    }
}

impl Session {
    /// Takes up a target. What moves for another reason is stopped first.
    pub(super) fn follow(&mut self, follow: Follow, now: Moment) {
        let name = follow.target.name().into_owned();
        let prepared = Course::new(&follow.target, follow.site).map_err(FollowProblem::Orbit);
        let checked = prepared.and_then(|course| match follow.phase(now.utc) {
            FollowPhase::Over => Err(FollowProblem::NoPass),
            FollowPhase::Waiting { .. } | FollowPhase::Following => Ok(course),
        });
        let course = match checked {
            Ok(course) => course,
            Err(problem) => return self.tell(Event::CannotFollow(name, problem)),
        };
        // From one target to another there is no need to stop.
        if self.following.is_none() && self.may_move() {
            self.halt_quietly(now);
        }
        let follow = if self.after == AfterPass::Next { follow } else { follow.one_pass(now.utc) };
        self.intent = Intent::Track;
        self.aim = None;
        self.target = None;
        self.following = Some(Following {
            follow,
            course,
            told: None,
            stats: FollowStats::default(),
            next_look: Some(now.steady),
            predicted: None,
        });
    }

    /// Says where the target is in its passes, and leaves it when it is over.
    pub(super) fn watch_follow(&mut self, now: Moment) {
        let Some(following) = &mut self.following else { return };
        let phase = following.follow.phase(now.utc);
        if following.told.replace(phase) == Some(phase) {
            return;
        }
        let name = following.follow.target.name().into_owned();
        match phase {
            FollowPhase::Waiting { aos } => self.tell(Event::Awaits { name, aos }),
            FollowPhase::Following => self.tell(Event::Follows(name)),
            FollowPhase::Over => {
                let stats = following.stats;
                self.tell(Event::FollowOver { name, stats });
                self.intent = Intent::Position;
            }
        }
    }
}
