//! Judgement and planning of paths outside the driver thread, which serves all antennas and STOP
//! and must never be delayed. The antenna waits for the answer.

use std::{collections::VecDeque, sync::Arc};

use tokio::{
    sync::{Notify, oneshot},
    task::spawn_blocking,
};

use crate::{
    clock::Moment,
    contract::driver::{Command, Effect},
    driver::gate::{Detour, DetourQuestion, PathQuestion},
    job::is_in_place,
    orbit::PropagationError,
    plan::{
        on_board::NotClear,
        program_track::{AxisNow, PathOrder, PlannedPath, Planner},
    },
};

/// Max number of judgements of one command, for a unit whose reports keep changing.
const MAX_TRIES: u8 = 3;

/// Max number of pending offset steps; a held key repeats them.
const MAX_WAITING: usize = 32;

/// Task of a worker.
enum Question {
    /// Question whether these paths of the unit's own program are clear.
    Paths(Vec<PathQuestion>),
    /// Request for the path of a program track.
    Plan(Box<PathOrder>),
    /// Request for a detour round the barriers.
    Detour(Box<DetourQuestion>),
}

#[derive(Debug)]
pub(super) enum JudgingAnswer {
    Paths(Vec<(PathQuestion, Result<(), NotClear>)>),
    Plan(Box<PlannedPath>),
    Detour(Box<Detour>),
}

/// Progress of an answer.
#[derive(Debug)]
pub(super) enum Poll {
    /// Missing answer, or no question.
    Pending,
    Answer(JudgingAnswer),
    /// Worker that ended without an answer.
    Broken,
}

impl Question {
    fn answer(self) -> JudgingAnswer {
        match self {
            Self::Paths(questions) => {
                let judged = questions.into_iter().map(|question| {
                    let verdict = question.judge();
                    (question, verdict)
                });
                JudgingAnswer::Paths(judged.collect())
            }
            Self::Plan(order) => JudgingAnswer::Plan(Box::new(order.plan())),
            Self::Detour(question) => JudgingAnswer::Detour(Box::new(question.search())),
        }
    }
}

#[derive(Debug, Default)]
pub(super) struct Judging {
    /// Current task; at most one runs at a time.
    running: Option<oneshot::Receiver<JudgingAnswer>>,
    /// Notification of an available answer.
    is_done: Arc<Notify>,
    /// Planned path for the waiting command.
    planned: Option<PlannedPath>,
    /// Commands that wait for an answer. A halt ends the wait, as does the next command except a
    /// further offset.
    waiting: VecDeque<Command>,
    /// Number of waits of the first command.
    tries: u8,
}

impl Judging {
    pub(super) fn is_under_way(&self) -> bool {
        self.running.is_some()
    }

    pub(super) fn notifier(&self) -> Arc<Notify> {
        Arc::clone(&self.is_done)
    }

    pub(super) fn drop_waiting(&mut self) {
        self.waiting.clear();
        self.planned = None;
        self.tries = 0;
    }

    /// Passes the planned path to the planner of its command, if available. Returns the order of a
    /// missing path that may need a detour. Fails once the target has decayed.
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

    /// Starts a task unless another one is running.
    fn begin(&mut self, question: Question) {
        // The question is not lost: its command or track asks again.
        if self.is_under_way() {
            return;
        }
        let (send, running) = oneshot::channel();
        let is_done = self.notifier();
        let work = move || {
            // The session may have ended.
            let _ = send.send(question.answer());
            is_done.notify_one();
        };
        // In a rehearsal, the order must not depend on threads.
        if is_in_place() {
            work();
        } else {
            drop(spawn_blocking(work));
        }
        self.running = Some(running);
    }

    /// Judges these paths of the unit's own program.
    pub(super) fn judge(&mut self, paths: Vec<PathQuestion>) {
        self.begin(Question::Paths(paths));
    }

    /// Plans the path of a program track, unless a task is running.
    pub(super) fn plan(&mut self, order: PathOrder) {
        self.begin(Question::Plan(Box::new(order)));
    }

    /// Searches for a detour, unless a task is running.
    pub(super) fn look_for(&mut self, question: Box<DetourQuestion>) {
        self.begin(Question::Detour(question));
    }

    /// Keeps `command` until its judgement arrives. Returns `false` after too many waits.
    pub(super) fn wait(&mut self, command: Command) -> bool {
        if self.tries >= MAX_TRIES {
            self.tries = 0;
            return false;
        }
        self.tries += 1;
        self.waiting.push_front(command);
        true
    }

    /// Returns the command unless it must wait behind others: offset steps add up. Any other
    /// command replaces the waiting ones.
    pub(super) fn take_turn(&mut self, command: Command) -> Option<Command> {
        let adds_up = matches!(command, Command::Offset(_)) && !self.waiting.is_empty();
        if adds_up && self.waiting.len() < MAX_WAITING {
            self.waiting.push_back(command);
            return None;
        }
        if command.row().effect != Effect::Looks {
            self.drop_waiting();
        }
        Some(command)
    }

    /// Keeps a path for the waiting command. Returns the path if no command waits.
    pub(super) fn keep_plan(&mut self, planned: Box<PlannedPath>) -> Option<Box<PlannedPath>> {
        if self.waiting.is_empty() {
            return Some(planned);
        }
        self.planned = Some(*planned);
        None
    }

    /// Checks for the answer.
    pub(super) fn poll(&mut self) -> Poll {
        match self.running.as_mut().map(oneshot::Receiver::try_recv) {
            None | Some(Err(oneshot::error::TryRecvError::Empty)) => Poll::Pending,
            Some(Ok(answer)) => Poll::Answer(answer),
            Some(Err(oneshot::error::TryRecvError::Closed)) => Poll::Broken,
        }
    }

    /// Ends the task after its answer, so that the next one may start.
    pub(super) fn end(&mut self) {
        self.running = None;
    }

    /// Takes the next waiting command, unless another task is running.
    pub(super) fn next_command(&mut self) -> Option<Command> {
        if self.is_under_way() { None } else { self.waiting.pop_front() }
    }

    /// Resets the number of waits after a command that awaits no further answer.
    pub(super) fn reset_waits(&mut self) {
        if !self.is_under_way() {
            self.tries = 0;
        }
    }
}
