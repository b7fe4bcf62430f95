//! Judges and plans ways off the driver's thread, which must never be held up: it serves all
//! antennas, and STOP. The antenna waits until the answer is there.

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
pub(super) enum Answer {
    Paths(Vec<(PathQuestion, Result<(), NotClear>)>),
    Plan(Box<PlannedPath>),
    Detour(Box<Detour>),
}

/// Progress of an answer.
#[derive(Debug)]
pub(super) enum Poll {
    /// There is no question, or no answer yet.
    Pending,
    Answer(Answer),
    /// The worker has ended without an answer.
    Broken,
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
        // A question that finds no room is not lost: its command or track asks again.
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

    /// Judges these paths of the unit's own program.
    pub(super) fn judge(&mut self, paths: Vec<PathQuestion>) {
        self.begin(Question::Paths(paths));
    }

    /// Plans the path of a program track, unless a way is being judged.
    pub(super) fn plan(&mut self, order: PathOrder) {
        self.begin(Question::Plan(Box::new(order)));
    }

    /// Looks for a detour, unless a way is being judged.
    pub(super) fn look_for(&mut self, question: Box<DetourQuestion>) {
        self.begin(Question::Detour(question));
    }

    /// Keeps `command` until the judgement is there that it needs. Returns `false` for one that has
    /// waited too often.
    pub(super) fn wait(&mut self, command: Command) -> bool {
        if self.tries >= MAX_TRIES {
            self.tries = 0;
            return false;
        }
        self.tries += 1;
        self.waiting.push_front(command);
        true
    }

    /// Returns the command unless it has to wait behind others: steps of an offset add up. Any other
    /// command takes the place of what waits.
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

    /// Keeps a path for the command that waits for it. Returns it if none waits.
    pub(super) fn keep_plan(&mut self, planned: Box<PlannedPath>) -> Option<Box<PlannedPath>> {
        if self.waiting.is_empty() {
            return Some(planned);
        }
        self.planned = Some(*planned);
        None
    }

    /// Looks for the answer.
    pub(super) fn poll(&mut self) -> Poll {
        match self.running.as_mut().map(oneshot::Receiver::try_recv) {
            None | Some(Err(oneshot::error::TryRecvError::Empty)) => Poll::Pending,
            Some(Ok(answer)) => Poll::Answer(answer),
            Some(Err(oneshot::error::TryRecvError::Closed)) => Poll::Broken,
        }
    }

    /// The answer was taken: the next question may begin.
    pub(super) fn end(&mut self) {
        self.running = None;
    }

    /// The next command that waited, unless another answer is awaited.
    pub(super) fn next_command(&mut self) -> Option<Command> {
        if self.is_under_way() { None } else { self.waiting.pop_front() }
    }

    /// The command was carried out. One that awaits nothing more has no tries left to count.
    pub(super) fn was_carried_out(&mut self) {
        if !self.is_under_way() {
            self.tries = 0;
        }
    }
}
