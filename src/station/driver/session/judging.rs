//! Judges the paths of the unit's own program off the driver's thread, which must never be held up:
//! it serves all antennas, and STOP. The antenna waits until the judgement is there.

use std::sync::Arc;

use tokio::{
    sync::{Notify, oneshot},
    task::spawn_blocking,
};

use super::{Command, Event, Session};
use crate::{
    clock::Moment,
    device::OnBoard,
    driver::{Refusal, gate::PathQuestion},
    job::is_in_place,
    plan::on_board::{Judge, NotClear},
};

/// Number of judgements after which a command is refused whose unit keeps reporting something
/// else.
const MAX_TRIES: u8 = 3;

type Judgements = Vec<(PathQuestion, Result<(), NotClear>)>;

#[derive(Debug, Default)]
pub(super) struct Judging {
    /// One at a time, whatever is asked.
    running: Option<oneshot::Receiver<Judgements>>,
    /// A judgement is there.
    is_done: Arc<Notify>,
    /// The command that waits for it, and how often it has waited. A halt and the next command end
    /// the wait.
    waiting: Option<(Command, u8)>,
    /// How often the command that is being carried out has waited.
    tries: u8,
}

impl Judging {
    pub(super) fn is_under_way(&self) -> bool {
        self.running.is_some()
    }

    pub(super) fn done(&self) -> Arc<Notify> {
        Arc::clone(&self.is_done)
    }

    /// The command that waits is not to be carried out any more.
    pub(super) fn drop_waiting(&mut self) {
        self.waiting = None;
    }

    fn begin(&mut self, questions: Vec<PathQuestion>) {
        let (send, running) = oneshot::channel();
        let is_done = self.done();
        let work = move || {
            let judged = questions.into_iter().map(|question| {
                let verdict = question.judge();
                (question, verdict)
            });
            // The session may have ended.
            let _ = send.send(judged.collect());
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
        if !self.judging.is_under_way() {
            self.judging.begin(open);
        }
        false
    }

    /// Carries `command` out again when the judgement is there that it needs.
    pub(super) fn wait_for_judgement(&mut self, command: Command) {
        if self.judging.tries >= MAX_TRIES {
            return self.tell(Event::NotSent(Refusal::BeingJudged));
        }
        self.judging.waiting = Some((command, self.judging.tries + 1));
    }

    /// Takes a judgement that is there, and carries out what has waited for it.
    pub(super) fn watch_judging(&mut self, now: Moment) {
        let Some(running) = &mut self.judging.running else { return };
        match running.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return,
            Ok(judgements) => self.gate.take_judgements(judgements),
            Err(oneshot::error::TryRecvError::Closed) => {
                tracing::error!(antenna = self.name, "a judgement broke down");
                self.judging.drop_waiting();
            }
        }
        self.judging.running = None;
        if let Some((command, tries)) = self.judging.waiting.take() {
            self.judging.tries = tries;
            self.carry_out_now(command, now);
            self.judging.tries = 0;
        }
    }
}
