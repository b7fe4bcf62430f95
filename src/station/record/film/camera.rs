//! Camera that writes the film.

use std::io::Write as _;

use flate2::{Compression, write::DeflateEncoder};
use rusqlite::{Transaction, params};
use serde_json::Value;

use super::{Parts, Picture, patch::Patch};
use crate::record::RecordError;

/// Length of a reel, seconds: a search for a moment starts at the reel's first picture.
const REEL_S: f64 = 60.0;
/// Max size of pictures that wait for the disk, bytes.
const MAX_WAITING: usize = 16 << 20;

/// Camera of one run.
#[derive(Default)]
pub(in crate::record) struct Camera {
    parts: Parts,
    /// Last picture; null before the first picture of a reel.
    last: Value,
    /// Number of the reel in this run. The number skips one where pictures are missing.
    reel: i64,
    /// Number of the next piece of the reel.
    piece: i64,
    begun_us: i64,
    /// Time of the last picture.
    until_us: i64,
    /// Written and pending lines of this reel.
    written: Vec<u8>,
    waiting: Vec<u8>,
    /// Finished whole reels, with their numbers and times.
    pending: Vec<(i64, [i64; 2], Vec<u8>)>,
    /// Number of pictures dropped since the last write.
    pub(in crate::record) dropped: u64,
    /// Number of pictures since the last write.
    count: u64,
}

impl Camera {
    /// Adds a picture to the film.
    pub(in crate::record) fn take(&mut self, picture: &dyn Picture) {
        let time = picture.moment().utc;
        let at_us = time.as_microsecond();
        let has_jumped = at_us < self.until_us;
        let is_over = (at_us - self.begun_us) as f64 > REEL_S * 1e6;
        if !self.last.is_null() && (has_jumped || is_over) {
            self.end_reel();
        }
        let mut drawn = match picture.draw(&mut self.parts) {
            Ok(drawn) => drawn,
            Err(error) => {
                tracing::error!(%error, "a picture cannot be written down");
                self.dropped += 1;
                return self.begin_anew();
            }
        };
        self.parts.next_picture();
        // Values at these places are unchanged. Take them out of both pictures to skip their
        // comparison.
        let same: Vec<(String, Value)> = (self.parts.same.drain(..))
            .filter_map(|place| {
                drawn.pointer_mut(&place)?.take();
                let standing = self.last.pointer_mut(&place)?.take();
                Some((place, standing))
            })
            .collect();
        if self.last.is_null() {
            (self.begun_us, self.until_us) = (at_us, at_us);
        }
        if let Some(patch) = Patch::difference(&self.last, &drawn) {
            let nanosecond = i64::try_from(time.as_nanosecond()).unwrap_or(i64::MAX);
            // Neither step can fail: a vector accepts everything, and the patch is valid JSON.
            let _ = serde_json::to_writer(&mut self.waiting, &(nanosecond, patch));
            self.waiting.push(b'\n');
        }
        for (place, standing) in same {
            if let Some(target) = drawn.pointer_mut(&place) {
                *target = standing;
            }
        }
        self.last = drawn;
        self.until_us = at_us;
        self.count += 1;
        let parts: usize = self.parts.new.iter().map(|(_, content)| content.len()).sum();
        let pending: usize = self.pending.iter().map(|(.., lines)| lines.len()).sum();
        if self.waiting.len() + parts + pending > MAX_WAITING {
            self.dropped += self.count;
            self.begin_anew();
        }
    }

    /// Starts the film again, for a file without this film or after a missing part.
    pub(in crate::record) fn begin_anew(&mut self) {
        *self = Self {
            parts: Parts { last: self.parts.last, ..Parts::default() },
            reel: self.reel + 2,
            dropped: self.dropped,
            ..Self::default()
        };
    }

    /// Ends the reel, because pictures are missing before the next one.
    pub(in crate::record) fn cut(&mut self) {
        if !self.last.is_null() {
            self.end_reel();
        }
        self.reel += 1;
    }

    fn end_reel(&mut self) {
        let mut lines = std::mem::take(&mut self.written);
        lines.append(&mut self.waiting);
        self.pending.push((self.reel, [self.begun_us, self.until_us], lines));
        self.last = Value::Null;
        self.parts.placed.clear();
        self.reel += 1;
        self.piece = 0;
    }

    /// Writes new parts and pictures.
    pub(in crate::record) fn write(
        &self,
        tx: &Transaction<'_>,
        run: i64,
    ) -> Result<(), RecordError> {
        let mut insert_part = tx.prepare_cached(
            "INSERT INTO part (run, number, until_us, content) VALUES (?1, ?2, ?3, ?4)",
        )?;
        for (number, content) in &self.parts.new {
            insert_part.execute(params![run, number, self.until_us, deflated(content)?])?;
        }
        let mut insert_piece = tx.prepare_cached(
            "INSERT INTO reel (run, number, piece, from_us, until_us, pictures) \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
        )?;
        for (number, [from_us, until_us], lines) in &self.pending {
            // A whole reel takes less space than its pieces.
            tx.prepare_cached("DELETE FROM reel WHERE run = ?1 AND number = ?2")?
                .execute(params![run, number])?;
            insert_piece.execute(params![run, number, 0, from_us, until_us, deflated(lines)?])?;
        }
        if !self.waiting.is_empty() {
            let (from_us, until_us) = (self.begun_us, self.until_us);
            let lines = deflated(&self.waiting)?;
            insert_piece.execute(params![run, self.reel, self.piece, from_us, until_us, lines])?;
        }
        if !self.pending.is_empty() {
            let mut update_part =
                tx.prepare_cached("UPDATE part SET until_us = ?1 WHERE run = ?2 AND number = ?3")?;
            for number in self.parts.numbers() {
                update_part.execute(params![self.until_us, run, number])?;
            }
        }
        Ok(())
    }

    /// Marks the pending content as written to disk.
    pub(in crate::record) fn is_written(&mut self) {
        self.parts.new.clear();
        self.pending.clear();
        if !self.waiting.is_empty() {
            self.written.append(&mut self.waiting);
            self.piece += 1;
        }
        (self.dropped, self.count) = (0, 0);
    }
}

fn deflated(bytes: &[u8]) -> Result<Vec<u8>, RecordError> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?)
}
