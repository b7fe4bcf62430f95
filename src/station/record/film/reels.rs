//! Reader of the film.

use std::{io::Read as _, path::Path, time::Duration};

use flate2::read::DeflateDecoder;
use jiff::Timestamp;
use rusqlite::{Connection, OptionalExtension as _, params};
use serde_json::Value;

use super::patch::{Misfit, Patch};
use crate::{
    astro::time::add_seconds,
    device::{Direction, Finding, Meaning, WireLine, panel::Tone},
    record::{RecordError, file},
    station::AntennaId,
};

/// Reason why a moment cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Only an older program without film wrote this record.
    #[error("nothing was filmed yet")]
    None,
    #[error("the film is damaged there")]
    Damaged,
}

impl From<rusqlite::Error> for FilmError {
    fn from(error: rusqlite::Error) -> Self {
        RecordError::from(error).into()
    }
}

impl From<serde_json::Error> for FilmError {
    fn from(_: serde_json::Error) -> Self {
        Self::Damaged
    }
}

impl From<Misfit> for FilmError {
    fn from(Misfit: Misfit) -> Self {
        Self::Damaged
    }
}

/// SQL condition for a reel that directly continues another reel of its run. Other reels follow a
/// stretch without film.
const FOLLOWS: &str = "EXISTS (SELECT 1 FROM reel AS before WHERE before.run = reel.run \
    AND before.number = reel.number - 1)";

/// Film of a record, opened for reading.
pub struct Film {
    db: Connection,
    reel: Option<Reel>,
}

/// Reel at one of its pictures.
struct Reel {
    run: i64,
    number: i64,
    /// Number of pieces read, and the time of their last picture.
    pieces: (i64, i64),
    /// Pictures with their times, nanoseconds of UTC.
    pictures: Vec<(i64, Patch)>,
    /// Number of pictures that are applied in `picture`.
    place: usize,
    picture: Value,
}

/// Picture of the film.
#[derive(Debug)]
pub struct Shown<'a> {
    /// Number of the picture's run, for its parts.
    pub run: i64,
    pub picture: &'a Value,
}

impl Film {
    /// Opens the film in the record at `path`.
    pub fn open(path: &Path) -> Result<Self, FilmError> {
        let db = file::open_to_read(path)?;
        if !db.table_exists(None, "reel")? {
            return Err(FilmError::None);
        }
        Ok(Self { db, reel: None })
    }

    /// Returns the times of the first and the last picture.
    pub fn span(&self) -> Result<Option<(Timestamp, Timestamp)>, FilmError> {
        let sql = "SELECT min(from_us), (SELECT until_us FROM reel ORDER BY from_us DESC, piece DESC \
                   LIMIT 1) FROM reel";
        let ends: (Option<i64>, Option<i64>) =
            self.db.query_row(sql, [], |row| Ok((row.get(0)?, row.get(1)?)))?;
        let time = |us: Option<i64>| us.and_then(|us| Timestamp::from_microsecond(us).ok());
        Ok(time(ends.0).zip(time(ends.1)))
    }

    /// Returns the picture shown at `time`: the last picture that is not later.
    pub fn seek(&mut self, time: Timestamp) -> Result<Option<Shown<'_>>, FilmError> {
        let at_ns = i64::try_from(time.as_nanosecond()).unwrap_or(i64::MAX);
        let holds = |reel: &Reel| {
            let first = reel.pictures.first().is_some_and(|(first, _)| *first <= at_ns);
            first && reel.pictures.last().is_some_and(|(last, _)| *last > at_ns)
        };
        if !self.reel.as_ref().is_some_and(holds) {
            self.load(time)?;
            // The first picture of a reel may be later in the same microsecond.
            let first = self.reel.as_ref().and_then(|reel| reel.pictures.first());
            if first.is_some_and(|(first, _)| *first > at_ns) {
                self.load(add_seconds(time, -1e-6))?;
            }
        }
        let Some(reel) = &mut self.reel else { return Ok(None) };
        reel.wind_to(at_ns)?;
        Ok((reel.place > 0).then_some(Shown { run: reel.run, picture: &reel.picture }))
    }

    /// Loads the reel of a moment, or its new pieces.
    fn load(&mut self, time: Timestamp) -> Result<(), FilmError> {
        // `from_us` is rounded down to a microsecond, so the reel may begin slightly later. A reel
        // may also be rewritten as fewer pieces with more content.
        let sql = "SELECT run, number, count(*), max(until_us) FROM reel JOIN (SELECT run, number FROM reel \
                   WHERE from_us <= ?1 ORDER BY from_us DESC LIMIT 1) USING (run, number) \
                   GROUP BY run, number";
        let found = self
            .db
            .prepare_cached(sql)?
            .query_row([time.as_microsecond()], |row| {
                Ok((row.get(0)?, row.get(1)?, (row.get(2)?, row.get(3)?)))
            })
            .optional()?;
        let Some((run, number, pieces)) = found else {
            self.reel = None;
            return Ok(());
        };
        let is_known = |reel: &Reel| (reel.run, reel.number, reel.pieces) == (run, number, pieces);
        if self.reel.as_ref().is_some_and(is_known) {
            return Ok(());
        }
        let mut pictures = Vec::new();
        let mut statement = self.db.prepare_cached(
            "SELECT pictures FROM reel WHERE run = ?1 AND number = ?2 ORDER BY piece",
        )?;
        let mut rows = statement.query(params![run, number])?;
        while let Some(row) = rows.next()? {
            for line in inflated(row.get_ref(0)?.as_blob().map_err(|_| FilmError::Damaged)?)?
                .split(|byte| *byte == b'\n')
                .filter(|line| !line.is_empty())
            {
                pictures.push(serde_json::from_slice(line)?);
            }
        }
        self.reel = Some(Reel { run, number, pieces, pictures, place: 0, picture: Value::Null });
        Ok(())
    }

    /// Returns a large part of a picture of this run.
    pub fn part(&self, run: i64, number: i64) -> Result<Vec<u8>, FilmError> {
        let mut statement =
            self.db.prepare_cached("SELECT content FROM part WHERE run = ?1 AND number = ?2")?;
        let content: Option<Vec<u8>> =
            statement.query_row(params![run, number], |row| row.get(0)).optional()?;
        inflated(&content.ok_or(FilmError::Damaged)?)
    }

    /// Returns the time of the first event after `time`, or of the last event before it.
    pub fn event(&self, time: Timestamp, is_after: bool) -> Result<Option<Timestamp>, FilmError> {
        let sql = if is_after {
            "SELECT min(utc_us) FROM event WHERE utc_us > ?1"
        } else {
            "SELECT max(utc_us) FROM event WHERE utc_us < ?1"
        };
        let us: Option<i64> =
            self.db.prepare_cached(sql)?.query_row([time.as_microsecond()], |row| row.get(0))?;
        Ok(us.and_then(|us| Timestamp::from_microsecond(us).ok()))
    }

    /// Returns the time of the first picture that shows an entry recorded at `moment`.
    pub fn shown_from(&mut self, moment: Timestamp) -> Result<Timestamp, FilmError> {
        self.load(moment)?;
        let at_ns = i64::try_from(moment.as_nanosecond()).unwrap_or(i64::MAX);
        let in_reel = self.reel.as_ref().and_then(|reel| {
            let place = reel.pictures.partition_point(|(time, _)| *time < at_ns);
            reel.pictures.get(place).map(|(time, _)| *time)
        });
        let shown = in_reel.and_then(|ns| Timestamp::from_nanosecond(ns.into()).ok());
        if let Some(shown) = shown {
            return Ok(shown);
        }
        let next: Option<i64> = self
            .db
            .prepare_cached("SELECT min(from_us) FROM reel WHERE from_us > ?1")?
            .query_row([moment.as_microsecond()], |row| row.get(0))?;
        // The first picture of the next reel is within this microsecond.
        Ok(next.and_then(|us| Timestamp::from_microsecond(us + 1).ok()).unwrap_or(moment))
    }

    /// Returns the last gap of the film between two moments. In a gap, the program did not run,
    /// pictures were lost, or the film was removed for its age.
    pub fn hole(
        &self,
        start: Timestamp,
        last: Timestamp,
    ) -> Result<Option<(Timestamp, Timestamp)>, FilmError> {
        let (from_us, until_us) = (start.as_microsecond(), last.as_microsecond());
        let begin = format!(
            "SELECT from_us FROM reel WHERE from_us > ?1 AND from_us <= ?2 AND NOT {FOLLOWS} \
             ORDER BY from_us DESC LIMIT 1"
        );
        let begin: Option<i64> = self
            .db
            .prepare_cached(&begin)?
            .query_row([from_us, until_us], |row| row.get(0))
            .optional()?;
        let Some(begin) = begin else { return Ok(None) };
        let end = "SELECT until_us FROM reel WHERE from_us < ?1 ORDER BY from_us DESC, piece DESC \
                   LIMIT 1";
        let end: Option<i64> =
            self.db.prepare_cached(end)?.query_row([begin], |row| row.get(0)).optional()?;
        let end = end.map_or(from_us, |end| end.max(from_us));
        let time = |us| Timestamp::from_microsecond(us).ok();
        Ok(time(end).zip(time(begin)))
    }

    /// Returns the gap of the film around `moment`.
    pub fn hole_at(&self, moment: Timestamp) -> Result<Option<(Timestamp, Timestamp)>, FilmError> {
        let at_us = moment.as_microsecond();
        let before = "SELECT max(of.until_us) FROM reel AS of JOIN (SELECT run, number FROM reel \
                      WHERE from_us <= ?1 ORDER BY from_us DESC LIMIT 1) AS last \
                      ON of.run = last.run AND of.number = last.number";
        let after = format!(
            "SELECT from_us, {FOLLOWS} FROM reel WHERE from_us > ?1 ORDER BY from_us LIMIT 1"
        );
        let ended_us: Option<i64> =
            self.db.prepare_cached(before)?.query_row([at_us], |row| row.get(0))?;
        let next: Option<(i64, bool)> = self
            .db
            .prepare_cached(&after)?
            .query_row([at_us], |row| Ok((row.get(0)?, row.get(1)?)))
            .optional()?;
        let time = |us| Timestamp::from_microsecond(us).ok();
        let (ended_us, begun_us, follows) = match (ended_us, next) {
            (Some(ended_us), Some((begun_us, follows))) => (ended_us, begun_us, follows),
            // The moment is before all stored film.
            (None, Some((begun_us, _))) => return Ok(Some(moment).zip(time(begun_us + 1))),
            (_, None) => return Ok(None),
        };
        let is_between = !follows && ended_us < at_us;
        // The first picture of a run is within this microsecond.
        Ok(time(ended_us).zip(time(begun_us + 1)).filter(|_| is_between))
    }

    /// Returns the lines on the link of an antenna after `start`, up to `end`, oldest first.
    pub fn lines(
        &self,
        antenna: AntennaId,
        start: Timestamp,
        end: Timestamp,
    ) -> Result<Vec<WireLine>, FilmError> {
        let mut statement = self.db.prepare_cached(
            "SELECT utc_us, is_sent, bytes, length, fault, meaning, reply_us FROM frame \
             WHERE antenna = ?1 AND utc_us > ?2 AND utc_us <= ?3 ORDER BY utc_us, number",
        )?;
        let span = params![antenna.0, start.as_microsecond(), end.as_microsecond()];
        let mut rows = statement.query(span)?;
        let mut lines = Vec::new();
        while let Some(row) = rows.next()? {
            let time = file::time_of(0, row.get(0)?)?;
            let bytes: Vec<u8> = row.get(2)?;
            let length: Option<i64> = row.get(3)?;
            let fault: Option<String> = row.get(4)?;
            let meaning: Option<String> = row.get(5)?;
            let reply_us: Option<i64> = row.get(6)?;
            let is_sent: bool = row.get(1)?;
            // The record does not store which good lines had a checksum.
            let good = Ok(Finding::Unchecked);
            let finding = fault.map_or(good, |fault| serde_json::from_str(&fault))?;
            lines.push(WireLine {
                time,
                direction: if is_sent { Direction::Sent } else { Direction::Received },
                length: length
                    .and_then(|stored_length| stored_length.try_into().ok())
                    .unwrap_or(bytes.len()),
                is_shortened: length.is_some(),
                bytes: bytes.into(),
                finding,
                is_poll: meaning.is_none() && finding.is_good(),
                meaning: meaning.map(|text| Meaning { tone: Tone::Plain, text: text.into() }),
                reply_after: reply_us.and_then(|us| us.try_into().ok()).map(Duration::from_micros),
            });
        }
        Ok(lines)
    }
}

impl Reel {
    /// Winds to the last picture that is not later than `at_ns`.
    fn wind_to(&mut self, at_ns: i64) -> Result<(), FilmError> {
        let place = self.pictures.partition_point(|(time, _)| *time <= at_ns);
        if place < self.place {
            (self.place, self.picture) = (0, Value::Null);
        }
        for (_, patch) in self.pictures.iter().take(place).skip(self.place) {
            patch.clone().apply(&mut self.picture)?;
        }
        self.place = place;
        Ok(())
    }
}

/// Max inflated size of a part of a film, bytes: far more than Azel writes. The limit guards
/// against files of other programs.
const MAX_INFLATED: u64 = 64 << 20;

fn inflated(bytes: &[u8]) -> Result<Vec<u8>, FilmError> {
    let mut content = Vec::new();
    let mut limited = DeflateDecoder::new(bytes).take(MAX_INFLATED + 1);
    limited.read_to_end(&mut content).map_err(|_| FilmError::Damaged)?;
    if content.len() as u64 > MAX_INFLATED {
        return Err(FilmError::Damaged);
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::{Compression, write::DeflateEncoder};

    use super::{FilmError, inflated};

    #[test]
    fn a_part_of_a_film_is_inflated_to_a_limit() {
        let mut small = DeflateEncoder::new(Vec::new(), Compression::best());
        let megabyte = vec![0; 1_000_000];
        for _ in 0..300 {
            small.write_all(&megabyte).unwrap();
        }
        let small = small.finish().unwrap();
        assert!(matches!(inflated(&small), Err(FilmError::Damaged)), "{} bytes", small.len());
    }
}
