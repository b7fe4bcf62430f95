//! Judges the paths of the unit's own program off the driver's thread, which must never be held up:
//! it serves all antennas, and STOP. The antenna waits until the judgement is there.

use std::{collections::VecDeque, sync::Arc};

use tokio::{
    sync::{Notify, oneshot},
    task::spawn_blocking,
};

use super::{Command, Event, Session};
use crate::{
    clock::Moment,
    device::OnBoard,
    driver::{Effect, Refusal, gate::PathQuestion},
    job::is_in_place,
    plan::on_board::{Judge, NotClear},
};

/// Number of judgements after which a command is refused whose unit keeps reporting something
/// else.
const MAX_TRIES: u8 = 3;

/// Number of steps of an offset that wait; a key repeats them.
const MAX_WAITING: usize = 32;

type Judgements = Vec<(PathQuestion, Result<(), NotClear>)>;

#[derive(Debug, Default)]
pub(super) struct Judging {
    /// One at a time, whatever is asked.
    running: Option<oneshot::Receiver<Judgements>>,
    /// A judgement is there.
    is_done: Arc<Notify>,
    /// What waits for it. A halt and the next command that is no further offset end the wait.
    waiting: VecDeque<Command>,
    /// How often the first of them has waited.
    tries: u8,
}

impl Judging {
    pub(super) fn is_under_way(&self) -> bool {
        self.running.is_some()
    }

    pub(super) fn done(&self) -> Arc<Notify> {
        Arc::clone(&self.is_done)
    }

    /// What waits is not to be carried out any more.
    pub(super) fn drop_waiting(&mut self) {
        self.waiting.clear();
        self.tries = 0;
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
