//! Recording of the link: commands and replies as the decoder splits them, each with its meaning.

use super::{Genius, REPLY, exchange::Outstanding, meaning};
use crate::{
    clock::Moment,
    device::{Direction, Finding, Meaning, WireLine, panel::Tone},
    protocol::rotator_genius::{Acknowledgement, Received, Reply, Request},
};

impl Genius {
    pub(super) fn record_sent(&mut self, bytes: &[u8], now: Moment) {
        let meaning = meaning::of_sent(bytes);
        let is_poll = bytes == Request::Read.to_bytes()
            && self.outstanding.as_ref().is_some_and(Outstanding::is_poll);
        self.wire.push(WireLine { meaning, is_poll, ..line(Direction::Sent, bytes, now) });
    }

    /// Records a reply or noise before Azel acts on it.
    pub(super) fn record_received(&mut self, received: &Received, now: Moment) {
        let sent_at = |is_it: &dyn Fn(&Outstanding) -> bool| {
            self.outstanding.as_ref().filter(|sent| is_it(sent)).map(Outstanding::sent)
        };
        let (meaning, question_time, is_poll) = match received {
            Received::Noise(bytes) => {
                self.unfinished.drain(..bytes.len().min(self.unfinished.len()));
                let line = line(Direction::Received, bytes, now);
                return self.wire.push(WireLine { finding: Finding::NoHeader, ..line });
            }
            // The decoder also returns the bytes of these two as noise.
            Received::LayoutChanged(_) | Received::OtherProtocol => return,
            Received::Reply(Reply::Status(_)) => {
                let is_poll = self.outstanding.as_ref().is_some_and(Outstanding::is_poll);
                let question_time =
                    self.missing.front().copied().or_else(|| sent_at(&Outstanding::is_read));
                (Meaning::plain("Status"), question_time, is_poll)
            }
            Received::Reply(Reply::Acknowledgement { request: acknowledgement, is_accepted }) => {
                let question_time = if *acknowledgement == Acknowledgement::Stop {
                    self.halts.front().map(|end| *end - REPLY)
                } else {
                    sent_at(&|sent| sent.is_acknowledged_by(*acknowledgement))
                };
                let (tone, text) =
                    if *is_accepted { (Tone::Good, "Accepted") } else { (Tone::Bad, "Refused") };
                (Meaning { tone, ..Meaning::plain(text) }, question_time, false)
            }
        };
        let count = self.unfinished.len().saturating_sub(self.decoder.unfinished_bytes());
        let bytes: Vec<u8> = self.unfinished.drain(..count).collect();
        let reply_after =
            question_time.map(|sent_at| now.steady.saturating_duration_since(sent_at));
        let line = line(Direction::Received, &bytes, now);
        let meaning = Some(meaning);
        self.wire.push(WireLine { meaning, reply_after, is_poll, ..line });
    }

    /// Records the rest of a reply that the lost link has cut off.
    pub(super) fn record_unfinished(&mut self, now: Moment) {
        let bytes: Vec<u8> = self.unfinished.drain(..).collect();
        if !bytes.is_empty() {
            let line = line(Direction::Received, &bytes, now);
            self.wire.push(WireLine { finding: Finding::Unfinished, ..line });
        }
    }
}

fn line(direction: Direction, bytes: &[u8], now: Moment) -> WireLine {
    WireLine::new(direction, bytes, Finding::Unchecked, now.utc)
}
