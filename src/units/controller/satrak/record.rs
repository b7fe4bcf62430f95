//! Recording of the link: lines as the decoder splits them, each with the question it answers.

use std::time::Duration;

use super::{REPLY, Satrak, exchange::Outstanding, words};
use crate::{
    clock::{Instant, Moment},
    device::{Direction, Finding, Meaning, WireLine},
    protocol::satrak::{Decoder, FrameError, Halt, ReceivedLine, Verb, Word},
};

impl Satrak {
    /// Records written frames; `bytes` may contain several frames.
    pub(super) fn record_sent(&mut self, bytes: &[u8], now: Moment) {
        let mut decoder = Decoder::new();
        decoder.push(bytes);
        while let Some(line) = decoder.next_line() {
            let is_poll = self.polls(&line);
            let shown = line.without_secrets(false);
            let meaning = meaning_of(&line, Direction::Sent, &shown.bytes);
            self.wire.push(WireLine {
                direction: Direction::Sent,
                is_shortened: !shown.is_whole,
                bytes: shown.bytes.into(),
                meaning,
                is_poll,
                ..blank(&line, now)
            });
        }
    }

    /// Records a received line before Azel acts on it.
    pub(super) fn record_received(&mut self, line: &ReceivedLine, now: Moment) {
        let shown = line.without_secrets(!self.has_heard_frame);
        self.has_heard_frame |= !matches!(line.frame, Err(FrameError::NoHeader { .. }));
        let meaning = meaning_of(line, Direction::Received, &shown.bytes);
        self.wire.push(WireLine {
            is_shortened: !shown.is_whole,
            bytes: shown.bytes.into(),
            meaning,
            reply_after: self.reply_after(line, now),
            is_poll: self.polls(line),
            ..blank(line, now)
        });
    }

    /// Records the rest of a line that the lost link has cut off.
    pub(super) fn record_unfinished(&mut self, now: Moment) {
        if let Some(line) = self.decoder.take_unfinished() {
            self.record_received(&line, now);
        }
    }

    /// Returns `true` for a poll or its answer.
    fn polls(&self, line: &ReceivedLine) -> bool {
        let Some(command) = command(line) else { return false };
        let outstanding = self.outstanding.as_ref();
        outstanding.is_some_and(|sent| sent.answers(command) && sent.is_regular_poll())
    }

    fn reply_after(&self, line: &ReceivedLine, now: Moment) -> Option<Duration> {
        let command = command(line)?;
        let requests = [&self.outstanding, &self.slow, &self.probe].into_iter().flatten();
        let request = requests.into_iter().find(|sent| sent.answers(command));
        let sent_at = request.map(Outstanding::first_sent).or_else(|| self.halted(command))?;
        Some(now.steady.saturating_duration_since(sent_at))
    }

    /// Returns the time at which Azel sent the halt that this reply answers.
    fn halted(&self, (word, verb): (Word, Verb)) -> Option<Instant> {
        let is_answered = |halt: &&(Halt, Instant)| halt.0.word() == word && verb == Verb::Set;
        let (_, end) = self.halts.iter().find(is_answered)?;
        Some(*end - REPLY)
    }
}

fn command(line: &ReceivedLine) -> Option<(Word, Verb)> {
    line.frame.as_ref().ok()?.command()
}

/// Returns the log entry of a received line whose bytes are not shown.
fn blank(line: &ReceivedLine, now: Moment) -> WireLine {
    let length = line.length();
    WireLine { length, ..WireLine::new(Direction::Received, &[], finding(line), now.utc) }
}

/// Returns the meaning of a good line from the bytes that are kept, which contain no secrets.
fn meaning_of(line: &ReceivedLine, direction: Direction, shown: &[u8]) -> Option<Meaning> {
    line.frame.is_ok().then(|| words::meaning(direction, shown))
}

fn finding(line: &ReceivedLine) -> Finding {
    match &line.frame {
        Ok(_) => Finding::Good,
        Err(FrameError::BadChecksum { received, computed, .. }) => {
            Finding::BadChecksum { received: *received, computed: *computed }
        }
        Err(FrameError::NoChecksum { .. }) => Finding::NoChecksum,
        Err(FrameError::NoHeader { .. }) => Finding::NoHeader,
        Err(FrameError::TooLong { .. }) => Finding::TooLong,
        Err(FrameError::NotText { .. }) => Finding::NotText,
        Err(FrameError::Unfinished { .. }) => Finding::Unfinished,
    }
}
