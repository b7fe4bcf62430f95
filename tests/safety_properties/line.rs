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
    /// The next reply is lost.
    pub(super) loses_next: bool,
    pub(super) doubled: f64,
    pub(super) damaged: f64,
    pub(super) is_split: bool,
    /// Replies carry no checksum: a changed figure would be a true one of elsewhere.
    pub(super) is_unchecked: bool,
    /// Bytes written by the session are lost.
    pub(super) is_deaf: bool,
    /// Bytes written by the unit are lost.
    pub(super) is_mute: bool,
    /// A STOP never gets through.
    pub(super) ignores_stop: bool,
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
                let line = line.lock().unwrap().clone();
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
