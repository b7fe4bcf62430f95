//! Line between a session and its unit, with its troubles.

use std::{
    io,
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::driver::Stream;
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::sleep,
};

use super::unit::Unit;
use crate::common::dice::Dice;

/// Troubles between a session and its unit.
#[derive(Debug, Clone, Default)]
pub(super) struct Line {
    pub(super) late_ms: f64,
    pub(super) lost: f64,
    /// `true` if the line loses the next reply.
    pub(super) loses_next: bool,
    /// `true` if the line loses the next reading of the position.
    pub(super) loses_next_reading: bool,
    pub(super) doubled: f64,
    pub(super) damaged: f64,
    pub(super) is_split: bool,
    /// `true` if replies carry no checksum, so that a changed figure looks like a position
    /// elsewhere.
    pub(super) is_unchecked: bool,
    /// `true` if the line loses bytes written by the session.
    pub(super) is_deaf: bool,
    /// `true` if the line loses bytes written by the unit.
    pub(super) is_mute: bool,
    /// `true` if no STOP gets through.
    pub(super) ignores_stop: bool,
    /// Axes whose angle is missing in every reply, and the text in its place.
    pub(super) blank: [bool; 2],
    pub(super) blank_text: usize,
    /// Share of the replies whose other figures are wrong.
    pub(super) falsified: f64,
    pub(super) cut: Option<Cut>,
    /// `true` once the cut was made.
    pub(super) was_cut: bool,
}

/// End of a link at a write of the session.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// Number of writes that get through before the cut.
    pub(super) after: usize,
    /// `true` to count only orders, not questions.
    pub(super) at_order: bool,
    /// Share of the bytes that still get through: 0 before the write, 1 after it.
    pub(super) share: f64,
}

impl Line {
    /// Returns the number of bytes that still get through if the link ends at this write.
    fn cut_at(&mut self, bytes: &[u8], unit: &dyn Unit) -> Option<usize> {
        let cut = self.cut.as_mut()?;
        if cut.at_order && !unit.holds_order(bytes) {
            return None;
        }
        if cut.after > 0 {
            cut.after -= 1;
            return None;
        }
        let share = cut.share;
        (self.cut, self.was_cut) = (None, true);
        Some((share * bytes.len() as f64).round() as usize)
    }
}

/// Carries the bytes of both ends, with the troubles of the line.
pub(super) async fn carry(
    mut here: DuplexStream,
    mut there: Box<dyn Stream>,
    line: Arc<Mutex<Line>>,
    mut dice: Dice,
    unit: Arc<dyn Unit>,
) -> io::Result<()> {
    let (mut out, mut back) = ([0; 1024], [0; 1024]);
    loop {
        tokio::select! {
            read = here.read(&mut out) => {
                let bytes = &out[..read?];
                if bytes.is_empty() {
                    return Ok(());
                }
                let (line, cut_at) = {
                    let mut line = line.lock().unwrap();
                    let cut_at = line.cut_at(bytes, &*unit);
                    (line.clone(), cut_at)
                };
                if let Some(at) = cut_at {
                    there.write_all(&bytes[..at]).await?;
                    return there.shutdown().await;
                }
                let vanishes = line.is_deaf || line.ignores_stop && unit.holds_stop(bytes);
                if !vanishes {
                    there.write_all(bytes).await?;
                }
            }
            read = there.read(&mut back) => {
                let bytes = &mut back[..read?];
                if bytes.is_empty() {
                    return Ok(());
                }
                let line = {
                    let mut line = line.lock().unwrap();
                    if std::mem::take(&mut line.loses_next) {
                        continue;
                    }
                    if line.loses_next_reading && unit.is_reading(bytes) {
                        line.loses_next_reading = false;
                        continue;
                    }
                    line.clone()
                };
                if line.is_mute || dice.chance(line.lost) {
                    continue;
                }
                if line.late_ms > 0.0 {
                    let late_s = dice.between(0.0, line.late_ms) / 1000.0;
                    sleep(Duration::try_from_secs_f64(late_s).unwrap()).await;
                }
                let mut sent = bytes.to_vec();
                for axis in (0..2).filter(|axis| line.blank[*axis]) {
                    sent = unit.without_angle(&sent, axis, line.blank_text);
                }
                if dice.chance(line.falsified) {
                    sent = unit.falsified(&sent, &mut dice);
                }
                if dice.chance(line.damaged) {
                    let at = dice.below(sent.len());
                    if line.is_unchecked {
                        sent.truncate(at);
                    } else {
                        sent[at] ^= 1 << dice.below(7);
                    }
                }
                if dice.chance(line.doubled) {
                    sent.extend_from_slice(bytes);
                }
                let at = if line.is_split { dice.below(sent.len() + 1) } else { 0 };
                here.write_all(&sent[..at]).await?;
                if line.is_split {
                    sleep(Duration::from_millis(5)).await;
                }
                here.write_all(&sent[at..]).await?;
            }
        }
    }
}
