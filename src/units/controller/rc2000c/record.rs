//! Recording of the link, frame by frame.

use super::{Rc2000c, exchange::Purpose, meaning};
use crate::{
    clock::Moment,
    device::{Direction, Finding, WireLine},
    protocol::rc2000c::{Command, Frame, FrameError, MAX_FRAME_BYTES},
};

/// Max length of a line of the wire log for bytes without a frame, bytes.
const MAX_NOISE: usize = 4 * MAX_FRAME_BYTES;

impl Rc2000c {
    pub(super) fn record_sent(&mut self, bytes: &[u8], now: Moment) {
        let is_status = bytes.get(2) == Some(&Command::Status.code());
        let sent = self.outstanding.as_ref();
        let is_poll = is_status
            && !self.is_poll_by_hand
            && sent.is_some_and(|sent| sent.purpose == Purpose::Poll);
        let line = WireLine::new(Direction::Sent, bytes, Finding::Good, now.utc);
        let meaning = meaning::of_sent(bytes, self.address, &self.axes);
        self.wire.push(WireLine { meaning, is_poll, ..line });
    }

    /// Keeps received bytes until Azel records them.
    pub(super) fn hear(&mut self, bytes: &[u8], now: Moment) {
        self.heard_at = Some(now.steady);
        self.heard.extend_from_slice(bytes);
    }

    /// Records a long run of noise in pieces.
    pub(super) fn limit_noise(&mut self, now: Moment) {
        if self.heard.len() > MAX_NOISE {
            self.record_noise(Finding::NoHeader, now);
        }
    }

    /// Records a frame, and before it the preceding bytes as noise.
    pub(super) fn record_frame(&mut self, frame: &Frame, now: Moment) {
        let bytes = frame.to_bytes();
        let place = self.heard.windows(bytes.len()).position(|window| window == bytes);
        if let Some(place) = place {
            let rest = self.heard.split_off(place + bytes.len());
            self.heard.truncate(place);
            self.record_noise(Finding::NoHeader, now);
            self.heard = rest;
        }
        let outstanding = [&self.outstanding, &self.halt].into_iter().flatten();
        let request = outstanding.into_iter().find(|sent| sent.code() == frame.code());
        let is_poll =
            !self.is_poll_by_hand && request.is_some_and(|sent| sent.purpose == Purpose::Poll);
        let reply_after = request.map(|sent| sent.clock.waited(now));
        let line = WireLine::new(Direction::Received, &bytes, Finding::Good, now.utc);
        let meaning = meaning::of_reply(frame);
        self.wire.push(WireLine { meaning, reply_after, is_poll, ..line });
    }

    /// Records bytes that began like a frame.
    pub(super) fn record_broken(&mut self, error: FrameError, now: Moment) {
        let finding = match error {
            FrameError::BadChecksum { received, computed } => {
                Finding::BadChecksum { received, computed }
            }
            FrameError::BadLength { .. } | FrameError::BadByte { .. } => Finding::NotText,
            FrameError::TooLong => Finding::TooLong,
            FrameError::Incomplete { .. } => Finding::Unfinished,
        };
        self.record_noise(finding, now);
    }

    /// Records the pending bytes as noise with `finding`.
    pub(super) fn record_noise(&mut self, finding: Finding, now: Moment) {
        let noise = std::mem::take(&mut self.heard);
        if !noise.is_empty() {
            self.wire.push(WireLine::new(Direction::Received, &noise, finding, now.utc));
        }
    }
}
