//! Commands that wait for the judgement of a path.

use std::sync::Arc;

use super::{
    Session,
    judging::{JudgingAnswer, Poll},
};
use crate::{
    clock::Moment,
    contract::driver::{Command, Event, Intent, Refusal, TrackProblem},
    device::{Motion, OnBoard},
    driver::gate::{NoRoute, Route},
    plan::on_board::Judge,
};

impl Session {
    /// Returns `true` if a worker has judged the whole path of `judge` for each of these reports;
    /// otherwise requests the judgement.
    pub(super) fn is_judged(&mut self, judge: &Arc<Judge>, units: &[OnBoard]) -> bool {
        let open = self.gate.open_questions(judge, units);
        if open.is_empty() {
            return true;
        }
        self.judging.judge(open);
        false
    }

    /// Returns the path of a motion of a program track; requests the search for a detour if needed.
    pub(super) fn route(&mut self, motion: Motion, now: Moment) -> Result<Route, Refusal> {
        let route = self.gate.route(motion, Intent::Track, now);
        if let Err(NoRoute::Open(question)) = &route {
            self.judging.look_for(question.clone());
        }
        route.map_err(NoRoute::refusal)
    }

    /// Executes `command` again when its judgement has arrived.
    pub(super) fn wait_for_judgement(&mut self, command: Command) {
        if !self.judging.wait(command) {
            self.tell(Event::NotSent(Refusal::BeingJudged));
        }
    }

    fn take_answer(&mut self, answer: JudgingAnswer, now: Moment) {
        let planned = match answer {
            JudgingAnswer::Paths(judgements) => return self.gate.take_judgements(judgements),
            JudgingAnswer::Detour(detour) => {
                self.gate.take_detour(*detour);
                None
            }
            JudgingAnswer::Plan(planned) => match self.judging.keep_plan(planned) {
                None => return,
                planned => planned,
            },
        };
        let Some(track) = self.commanded.activity.program_mut() else { return };
        // The track has waited for this answer.
        track.look_at(now.steady);
        if let Some(Err(error)) = planned.map(|planned| track.planner.take_path(*planned)) {
            self.end_follow(TrackProblem::Orbit(error), now);
        }
    }

    /// Takes an available answer, and executes the commands that waited for it.
    pub(super) fn watch_judging(&mut self, now: Moment) {
        match self.judging.poll() {
            Poll::Pending => return,
            Poll::Answer(answer) => self.take_answer(answer, now),
            Poll::Broken => {
                tracing::error!(antenna = self.setup.name(), "the judgement of a way broke down");
                self.judging.drop_waiting();
            }
        }
        self.judging.end();
        while let Some(command) = self.judging.next_command() {
            self.carry_out_now(command, now);
            self.judging.reset_waits();
        }
    }
}
