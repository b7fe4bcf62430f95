//! Judges and plans ways off the driver's thread, which must never be held up: it serves all
//! antennas, and STOP. The antenna waits until the answer is there.

use std::{collections::VecDeque, sync::Arc};

use tokio::{
    sync::{Notify, oneshot},
    task::spawn_blocking,
};

use super::Session;
use crate::{
    clock::Moment,
    contract::driver::{Command, Effect, Event, Intent, Refusal, TrackProblem},
    device::{Motion, OnBoard},
    driver::gate::{Detour, DetourQuestion, NoRoute, PathQuestion, Route},
    job::is_in_place,
    orbit::PropagationError,
    plan::{
        on_board::{Judge, NotClear},
        program_track::{AxisNow, PathOrder, PlannedPath, Planner},
    },
};

/// Number of judgements after which a command is refused whose unit keeps reporting something
/// else.
const MAX_TRIES: u8 = 3;

/// Number of steps of an offset that wait; a key repeats them.
const MAX_WAITING: usize = 32;

/// Work of a worker.
enum Question {
    /// Are these paths of the unit's own program clear?
    Paths(Vec<PathQuestion>),
    /// Which path does a program track take?
    Plan(Box<PathOrder>),
    /// Which detour leads round the barriers?
    Detour(Box<DetourQuestion>),
}

#[derive(Debug)]
enum Answer {
    Paths(Vec<(PathQuestion, Result<(), NotClear>)>),
    Plan(Box<PlannedPath>),
    Detour(Box<Detour>),
}

impl Question {
    fn answer(self) -> Answer {
        match self {
            Self::Paths(questions) => {
                let judged = questions.into_iter().map(|question| {
                    let verdict = question.judge();
                    (question, verdict)
                });
                Answer::Paths(judged.collect())
            }
            Self::Plan(order) => Answer::Plan(Box::new(order.plan())),
            Self::Detour(question) => Answer::Detour(Box::new(question.search())),
        }
    }
}

#[derive(Debug, Default)]
pub(super) struct Judging {
    /// One at a time, whatever is asked.
    running: Option<oneshot::Receiver<Answer>>,
    /// An answer is there.
    is_done: Arc<Notify>,
    /// A path for the command that waits for it.
    planned: Option<PlannedPath>,
    /// Commands that wait for an answer. A halt ends the wait, and so does the next command that is
    /// no further offset.
    waiting: VecDeque<Command>,
    /// Number of times that the first of them has waited.
    tries: u8,
}

impl Judging {
    pub(super) fn is_under_way(&self) -> bool {
        self.running.is_some()
    }

    pub(super) fn done(&self) -> Arc<Notify> {
        Arc::clone(&self.is_done)
    }

    /// Drops the commands that wait.
    pub(super) fn drop_waiting(&mut self) {
        self.waiting.clear();
        self.planned = None;
        self.tries = 0;
    }

    /// Gives the planner of a command the path that was planned for it, if there is one. Returns the
    /// order of a path that is still open and takes long. Fails once the target has decayed.
    pub(super) fn open_order(
        &mut self,
        planner: &mut Planner,
        axes: [AxisNow; 2],
        now: Moment,
    ) -> Result<Option<PathOrder>, PropagationError> {
        if let Some(planned) = self.planned.take() {
            planner.take_path(planned)?;
        }
        Ok(planner.path_order(now.utc, axes).filter(PathOrder::may_detour))
    }

    /// Begins to work on the answer, unless the session awaits another one.
    fn begin(&mut self, question: Question) {
        if self.is_under_way() {
            return;
        }
        let (send, running) = oneshot::channel();
        let is_done = self.done();
        let work = move || {
            // The session may have ended.
            let _ = send.send(question.answer());
            is_done.notify_one();
        };
        // In a rehearsal no order may depend on threads.
        if is_in_place() {
            work();
        } else {
            drop(spawn_blocking(work));
        }
        self.running = Some(running);
    }
}

impl Session {
    /// Returns `true` if the whole path of `judge` has been judged by each of these reports; else
    /// sees to it that it will be.
    pub(super) fn is_judged(&mut self, judge: &Arc<Judge>, units: &[OnBoard]) -> bool {
        let open = self.gate.open_questions(judge, units);
        if open.is_empty() {
            return true;
        }
        self.judging.begin(Question::Paths(open));
        false
    }

    /// Plans the path of a program track, unless a way is being judged.
    pub(super) fn plan(&mut self, order: PathOrder) {
        self.judging.begin(Question::Plan(Box::new(order)));
    }

    /// The way of a motion of a program track; sees to it that a detour will be looked for.
    pub(super) fn route(&mut self, motion: Motion, now: Moment) -> Result<Route, Refusal> {
        let route = self.gate.route(motion, Intent::Track, now);
        if let Err(NoRoute::Open(question)) = &route {
            self.look_for(question.clone());
        }
        route.map_err(NoRoute::refusal)
    }

    /// Looks for a detour, unless a way is being judged.
    pub(super) fn look_for(&mut self, question: Box<DetourQuestion>) {
        self.judging.begin(Question::Detour(question));
    }

    /// Carries `command` out again when the judgement is there that it needs.
    pub(super) fn wait_for_judgement(&mut self, command: Command) {
        if self.judging.tries >= MAX_TRIES {
            self.judging.tries = 0;
            return self.tell(Event::NotSent(Refusal::BeingJudged));
        }
        self.judging.tries += 1;
        self.judging.waiting.push_front(command);
    }

    /// Returns the command unless it has to wait behind others: steps of an offset add up. Any other
    /// command takes the place of what waits.
    pub(super) fn take_turn(&mut self, command: Command) -> Option<Command> {
        let waiting = &mut self.judging.waiting;
        let adds_up = matches!(command, Command::Offset(_)) && !waiting.is_empty();
        if adds_up && waiting.len() < MAX_WAITING {
            waiting.push_back(command);
            return None;
        }
        if command.row().effect != Effect::Looks {
            self.judging.drop_waiting();
        }
        Some(command)
    }

    fn take_answer(&mut self, answer: Answer, now: Moment) {
        let planned = match answer {
            Answer::Paths(judgements) => return self.gate.take_judgements(judgements),
            Answer::Detour(detour) => {
                self.gate.take_detour(*detour);
                None
            }
            Answer::Plan(planned) if self.judging.waiting.is_empty() => Some(planned),
            Answer::Plan(planned) => {
                self.judging.planned = Some(*planned);
                return;
            }
        };
        let Some(track) = self.commanded.activity.program_mut() else { return };
        track.next_update = now.steady;
        if let Some(Err(error)) = planned.map(|planned| track.planner.take_path(*planned)) {
            self.end_follow(TrackProblem::Orbit(error), now);
        }
    }

    /// Takes an answer that is there, and carries out what has waited for it.
    pub(super) fn watch_judging(&mut self, now: Moment) {
        let Some(running) = &mut self.judging.running else { return };
        match running.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return,
            Ok(answer) => self.take_answer(answer, now),
            Err(oneshot::error::TryRecvError::Closed) => {
                tracing::error!(antenna = self.setup.name(), "the judgement of a way broke down");
                self.judging.drop_waiting();
            }
        }
        self.judging.running = None;
        while !self.judging.is_under_way()
            && let Some(command) = self.judging.waiting.pop_front()
        {
            self.carry_out_now(command, now);
            if !self.judging.is_under_way() {
                self.judging.tries = 0;
            }
        }
    }
}
