//! I/O loop of a session: dials, talks, loses the link and dials again.

use std::{io, time::Duration};

use tokio::io::{AsyncReadExt, AsyncWriteExt, ReadHalf, WriteHalf};

use super::{Session, contact::LinkNeed, wires::SessionInput};
use crate::{
    clock::{Clock, Moment},
    contract::driver::{Command, Event, LinkLoss},
    device::Extent,
    driver::{Numbered, Stream},
};

/// Timeout of a connection attempt.
pub(in crate::driver) const CONNECT: Duration = Duration::from_secs(3);
/// Timeout of writing a few bytes to a link.
pub(in crate::driver) const WRITE: Duration = Duration::from_secs(1);
/// Pauses between attempts; the last pause repeats.
const BACK_OFF: [Duration; 5] = [
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
    Duration::from_secs(4),
    Duration::from_secs(8),
];

/// Interval between attempts while Azel owes a STOP.
pub(super) const STOP_RETRY: Duration = Duration::from_millis(250);
pub(in crate::driver) const MIN_WAIT: Duration = Duration::from_millis(2);

impl Session {
    /// Runs until the owner drops the handle; stops a jog before the end.
    pub async fn run(mut self) {
        self.look_for_mark().await;
        let mut attempt = 0;
        loop {
            if self.contact.link_need() == LinkNeed::No && !self.wait_until_wanted().await {
                break;
            }
            if let Some(loss) = self.connect_and_talk(&mut attempt).await {
                let wait = BACK_OFF.get(attempt).or(BACK_OFF.last()).copied().unwrap_or(CONNECT);
                attempt += 1;
                if self.pause(loss, wait).await.is_some() {
                    continue;
                }
            }
            // The session has ended, or the operator released the unit and the session waits for a
            // command.
            if self.contact.link_need() != LinkNeed::No {
                break;
            }
        }
        if self.stop.is_under_way() || self.commanded.key.pressed().is_some() {
            // If the program is killed from now on, its next start must find the owed STOP on disk.
            self.mark_debt().await;
            let now = self.now();
            self.halt_quietly(now);
        }
        self.pay_debts().await;
        self.end_marking().await;
        self.contact.close();
        let now = self.now();
        self.publish(now);
    }

    /// Returns the reason for the lost link; `None` if the session ends or needs no link any more.
    async fn connect_and_talk(&mut self, attempt: &mut usize) -> Option<LinkLoss> {
        let stream = match self.connect().await {
            Ok(Some(stream)) => stream,
            Ok(None) => return None,
            Err(loss) => return Some(loss),
        };
        let before = self.gate.state().traffic;
        let end = self.talk(stream).await;
        let now = self.now();
        // Include the bytes that arrived right before the end.
        self.gate.device().link_down(now);
        let after = self.gate.state().traffic;
        let has_replied = after.replies > before.replies;
        let end = match end {
            // The far end, such as a web server, sends other text and disconnects.
            Some(LinkLoss::Closed | LinkLoss::Broken(_))
                if !has_replied && after.last_unreadable != before.last_unreadable =>
            {
                Some(LinkLoss::OtherDevice)
            }
            end => end,
        };
        if has_replied {
            *attempt = 0;
            // A link that never carried a reply does not count as a new one.
            self.contact.note_reply();
        }
        self.remember_likeness();
        self.lose_shift(now);
        self.record();
        self.gate.forget_angles();
        self.gate.note_lost_answers();
        end
    }

    /// Returns `None` to end the session.
    async fn connect(&mut self) -> Result<Option<Box<dyn Stream>>, LinkLoss> {
        let now = self.now();
        self.publish(now);
        let mut dialling = self.contact.dial();
        let clock = self.clock.clone();
        let deadline = clock.now().steady + CONNECT;
        // An unresponsive address must not delay a STOP or a command.
        loop {
            tokio::select! {
                biased;
                turn = self.wires.next() => {
                    if !self.take_offline(turn) {
                        return Ok(None);
                    }
                }
                dialled = &mut dialling => {
                    let stream = dialled.map_err(|error| LinkLoss::Refused(error_text(&error)))?;
                    let now = self.now();
                    self.contact.set_connected(now.steady);
                    return Ok(Some(stream));
                }
                () = clock.sleep_until(deadline) => return Err(LinkLoss::ConnectTimeout),
            }
        }
    }

    /// Waits between two attempts; returns `None` to end the session.
    async fn pause(&mut self, loss: LinkLoss, wait: Duration) -> Option<()> {
        let now = self.now();
        self.tell_silence_of_lost_link();
        let jogs = self.commanded.key.started().is_some();
        // The key may still be down when the link is back, but must not restart the motion.
        self.commanded.key.spend();
        if jogs {
            self.halt_quietly(now);
        }
        // Send no motion late: after an outage, the antenna may be somewhere else.
        self.commanded.activity.drop_queued(now.steady);
        self.judging.drop_waiting();
        let clock = self.clock.clone();
        let mut retry_at = now.steady + wait;
        let last_reply = self.gate.state().traffic.last_reply;
        if self.contact.lose(loss.clone(), retry_at, last_reply, now.steady) {
            self.tell(Event::LinkLost(loss));
        }
        loop {
            let now = self.now();
            // A STOP must not wait for the normal interval.
            if self.stop.is_under_way() && retry_at > now.steady + STOP_RETRY {
                retry_at = now.steady + STOP_RETRY;
                self.contact.retry_at(retry_at);
            }
            self.watch_halt(now);
            self.let_sleep(now);
            self.forget_old_stop(now);
            self.publish(now);
            if now.steady >= retry_at {
                return Some(());
            }
            let due = self.halt_due().into_iter().chain(self.owed.marking_due(now.steady));
            let deadline = due.chain([retry_at]).min().unwrap_or(retry_at);
            tokio::select! {
                biased;
                turn = self.wires.next() => {
                    if !self.take_offline(turn) {
                        return None;
                    }
                }
                () = clock.sleep_until(deadline.max(now.steady + MIN_WAIT)) => {}
            }
        }
    }

    /// Returns `false` to close the session or disconnect.
    fn take_offline(&mut self, turn: SessionInput) -> bool {
        let now = self.now();
        match turn {
            SessionInput::Over => return false,
            SessionInput::Stop => self.stop_and_void(now),
            SessionInput::Command(Numbered { command: Command::Disconnect, .. }) => {
                return !self.disconnect();
            }
            SessionInput::Command(numbered) => {
                self.carry_out_numbered(numbered, now, Self::carry_out_offline);
            }
            SessionInput::Bounds(bounds) => self.keep_within(*bounds),
            SessionInput::Sleep(awake) => self.before_sleep(awake, now),
            SessionInput::Bytes(_) | SessionInput::Lost(_) | SessionInput::Time => {}
        }
        self.let_sleep(now);
        // The session needed the link only for a STOP and no longer owes one.
        if self.contact.link_need() == LinkNeed::ForStop && self.disconnect_after_stop() {
            return false;
        }
        self.publish(now);
        true
    }

    pub(super) fn stop_and_void(&mut self, now: Moment) {
        self.wires.void_commands();
        self.halt(now);
    }

    /// Talks until the loss of the link; returns `None` to end the session.
    async fn talk(&mut self, stream: Box<dyn Stream>) -> Option<LinkLoss> {
        // These are the STOP bytes for the dead-man. The controller forgets this request when the
        // link comes up.
        let now = self.now();
        let stop = self.gate.device().halt(Extent::Everything, now);
        self.stop.guard.link_up(&*stream, &stop);
        let end = self.talk_over(stream).await;
        self.stop.guard.link_down();
        end
    }

    async fn talk_over(&mut self, stream: Box<dyn Stream>) -> Option<LinkLoss> {
        let (mut reader, mut writer) = tokio::io::split(stream);
        let mut buffer = [0; 4096];
        let start = self.now();
        self.gate.device().link_up(start);
        self.owed.record_auto_track_request(None);
        drop(self.stop.take_bytes());
        // An owed STOP goes out on a new link before any query.
        if let Some(extent) = self.stop.extent() {
            self.queue_halt(extent, start);
        }
        self.contact.begin_link();
        let mut hurries = false;
        loop {
            // After a long wait, a jog that the controller would renew may be over.
            let now = self.now();
            self.watch_jog(now);
            self.beat(now);
            if let Err(loss) = self.send(&mut writer).await {
                return Some(loss);
            }
            let now = self.now();
            // Detect a clock step first, because supervision acts on UTC.
            if let Some(loss) = self.watch_clocks(now) {
                return Some(loss);
            }
            self.supervise(now);
            let pace = self.pace();
            let loss = self.contact.follow_age(self.gate.state(), pace, now.steady, start.steady);
            if let Some(loss) = loss {
                return Some(loss);
            }
            if self.contact.link_need() == LinkNeed::ForStop && self.disconnect_after_stop() {
                self.publish(now);
                self.shut_down(&mut reader, &mut writer).await;
                return None;
            }
            self.publish(now);
            // Send the effects of the last bytes without a wait. A controller that is always due
            // must not block the next command.
            hurries = !hurries && self.gate.device().due(now) <= now.steady;
            if hurries || self.stop.has_bytes() {
                continue;
            }
            let input = self.wait(&mut reader, &mut buffer).await;
            match input {
                SessionInput::Over => {
                    self.shut_down(&mut reader, &mut writer).await;
                    return None;
                }
                SessionInput::Lost(loss) => return Some(loss),
                SessionInput::Stop => {
                    let now = self.now();
                    self.stop_and_void(now);
                }
                SessionInput::Sleep(awake) => {
                    let now = self.now();
                    self.before_sleep(awake, now);
                }
                SessionInput::Command(Numbered { command: Command::Disconnect, .. }) => {
                    if self.disconnect() {
                        self.shut_down(&mut reader, &mut writer).await;
                        return None;
                    }
                }
                SessionInput::Bounds(bounds) => self.keep_within(*bounds),
                SessionInput::Command(numbered) => {
                    let now = self.now();
                    self.carry_out_numbered(numbered, now, Self::carry_out);
                }
                SessionInput::Bytes(count) => {
                    let now = self.now();
                    self.gate.device().receive(buffer.get(..count).unwrap_or_default(), now);
                    self.record();
                }
                SessionInput::Time => {}
            }
        }
    }

    /// Sends halts first, then the controller's output.
    pub(super) async fn send(
        &mut self,
        writer: &mut WriteHalf<Box<dyn Stream>>,
    ) -> Result<(), LinkLoss> {
        // A STOP overtakes every query, and waits for no pending reply.
        let bytes = self.stop.take_bytes();
        if !bytes.is_empty() {
            write(&self.clock, writer, &bytes).await?;
            let now = self.now();
            self.stop.note_written(now.steady);
            self.note_write(now);
            self.gate.device().sent(&bytes, now);
        }
        let now = self.now();
        while let Some(bytes) = self.gate.device().poll(now) {
            write(&self.clock, writer, &bytes).await?;
            self.note_write(now);
            self.gate.device().sent(&bytes, now);
        }
        self.record();
        Ok(())
    }

    async fn wait(
        &mut self,
        reader: &mut ReadHalf<Box<dyn Stream>>,
        buffer: &mut [u8],
    ) -> SessionInput {
        let now = self.now();
        let due = self.gate.device().due(now);
        let pace = self.pace();
        let link_due = self.contact.due(self.gate.state(), pace);
        let deadline = self
            .supervise_due()
            .into_iter()
            .chain(self.owed.marking_due(now.steady))
            .chain(self.unit_offsets.due(now.steady))
            .chain(link_due)
            .chain(self.silence_due())
            .chain([due])
            .min();
        let (clock, judged) = (self.clock.clone(), self.judging.notifier());
        // A deadline without effect must not cause a busy loop.
        let deadline = deadline.unwrap_or(due).max(now.steady + MIN_WAIT);
        tokio::select! {
            biased;
            turn = self.wires.next() => turn,
            // Read bytes after commands: a unit that sends without end must not block a STOP.
            read = reader.read(buffer) => match read {
                Ok(0) => SessionInput::Lost(LinkLoss::Closed),
                Ok(count) => SessionInput::Bytes(count),
                Err(error) => SessionInput::Lost(LinkLoss::Broken(error_text(&error))),
            },
            () = judged.notified() => SessionInput::Time,
            () = clock.sleep_until(deadline) => SessionInput::Time,
        }
    }
}

async fn write(
    clock: &Clock,
    writer: &mut WriteHalf<Box<dyn Stream>>,
    bytes: &[u8],
) -> Result<(), LinkLoss> {
    let written = clock.timeout(WRITE, async {
        writer.write_all(bytes).await?;
        writer.flush().await
    });
    match written.await {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(LinkLoss::Broken(error_text(&error))),
        Err(_) => {
            let stalled = io::Error::from(io::ErrorKind::TimedOut);
            Err(LinkLoss::Broken(error_text(&stalled)))
        }
    }
}

/// Returns the operating system's message without its number.
pub(in crate::driver) fn error_text(error: &io::Error) -> String {
    let text = error.to_string();
    let words = text.split(" (os error").next().unwrap_or_default();
    words.to_lowercase()
}
