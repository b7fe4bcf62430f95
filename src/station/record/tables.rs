//! Rows of the tables, within one transaction of the writer.

use std::sync::Arc;

use jiff::Timestamp;
use rusqlite::{Transaction, params};
use serde_json::json;

use super::{
    Entry, Kind, PassNote, RecordError,
    file::PER_DEGREE,
    intake::{Missed, RecordedSession},
};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    contract::driver::Recorded,
    device::{AxisMotion, Direction, Finding, Measured, WireLine},
    station::AntennaId,
};

/// Tables within one transaction.
pub(super) struct Tables<'a> {
    pub(super) tx: &'a Transaction<'a>,
    /// Number of this run.
    pub(super) run: i64,
    pub(super) begun: Moment,
}

impl Tables<'_> {
    fn steady_us(&self, steady: Instant) -> i64 {
        let elapsed = steady.saturating_duration_since(self.begun.steady);
        i64::try_from(elapsed.as_micros()).unwrap_or(i64::MAX)
    }

    pub(super) fn antenna(&self, session: &RecordedSession) -> Result<(), RecordError> {
        self.tx.prepare_cached("INSERT OR REPLACE INTO antenna VALUES (?1, ?2, ?3, ?4)")?.execute(
            params![
                session.antenna.0,
                session.moment.utc.as_microsecond(),
                session.name,
                session.make,
            ],
        )?;
        Ok(())
    }

    pub(super) fn entry(&self, entry: &Entry) -> Result<(), RecordError> {
        let antenna = entry.antenna.map(|antenna| antenna.0);
        let utc_us = entry.moment.utc.as_microsecond();
        self.tx
            .prepare_cached(
                "INSERT INTO event (utc_us, steady_us, run, antenna, kind, data) \
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
            )?
            .execute(params![
                utc_us,
                self.steady_us(entry.moment.steady),
                self.run,
                antenna,
                entry.kind.word(),
                entry.data.to_string(),
            ])?;
        Ok(())
    }

    pub(super) fn pass(&self, pass: &PassNote) -> Result<(), RecordError> {
        let report = &pass.report;
        self.tx
            .prepare_cached(
                "INSERT INTO pass (antenna, satellite, name, from_us, until_us, run, verdict, \
                 report) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
            )?
            .execute(params![
                pass.antenna.0,
                report.elements.catalog_number(),
                report.elements.name(),
                report.start.as_microsecond(),
                report.end.as_microsecond(),
                self.run,
                report.report.verdict.word(),
                serde_json::to_string(report)?,
            ])?;
        let id = self.tx.last_insert_rowid();
        let mut insert =
            self.tx.prepare_cached("INSERT OR IGNORE INTO pass_point VALUES (?1, ?2, ?3, ?4)")?;
        for point in &pass.points {
            insert.execute(params![
                id,
                point.time.as_microsecond(),
                parts(point.pointing.azimuth.map(Angle::degrees)),
                parts(point.pointing.elevation.map(Angle::degrees)),
            ])?;
        }
        Ok(())
    }

    pub(super) fn gap(
        &self,
        missed: Missed,
        start: Timestamp,
        moment: Moment,
    ) -> Result<(), RecordError> {
        let Missed { entries, positions, frames, pictures } = missed;
        let data = json!({
            "since": start, "entries": entries, "positions": positions, "frames": frames,
            "pictures": pictures,
        });
        self.entry(&Entry { moment, antenna: None, kind: Kind::Gap, data })
    }

    pub(super) fn positions(
        &self,
        antenna: AntennaId,
        first: u64,
        positions: &[Measured],
    ) -> Result<(), RecordError> {
        let mut insert = self.tx.prepare_cached(
            "INSERT OR IGNORE INTO position \
             VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
        )?;
        for (number, measured) in (first..).zip(positions) {
            let [first, second] = &measured.axes;
            let limits =
                [first.plus_limit, first.minus_limit, second.plus_limit, second.minus_limit]
                    .iter()
                    .enumerate()
                    .fold(0, |bits, (place, is_set)| bits | i64::from(*is_set) << place);
            insert.execute(params![
                antenna.0,
                measured.time.as_microsecond(),
                number.cast_signed(),
                self.run,
                self.steady_us(measured.received),
                parts(measured.pointing.azimuth.map(Angle::degrees)),
                parts(measured.pointing.elevation.map(Angle::degrees)),
                parts(first.angle_deg),
                parts(second.angle_deg),
                motion(first.motion),
                motion(second.motion),
                limits,
            ])?;
        }
        Ok(())
    }

    pub(super) fn frames(
        &self,
        antenna: AntennaId,
        lines: &[Arc<Recorded>],
    ) -> Result<(), RecordError> {
        let mut insert = self.tx.prepare_cached(
            "INSERT OR IGNORE INTO frame VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)",
        )?;
        for Recorded { number, line } in lines.iter().map(AsRef::as_ref) {
            insert.execute(params![
                antenna.0,
                line.time.as_microsecond(),
                number.cast_signed(),
                self.run,
                line.direction == Direction::Sent,
                &*line.bytes,
                line.is_shortened.then(|| i64::try_from(line.length).unwrap_or(i64::MAX)),
                fault(line.finding),
                meaning(line),
                line.reply_after.map(|after| i64::try_from(after.as_micros()).unwrap_or(i64::MAX)),
            ])?;
        }
        Ok(())
    }
}

/// Returns degrees as a whole number of stored units; `None` without an angle.
fn parts(deg: Option<f64>) -> Option<i64> {
    let parts = deg.filter(|deg| deg.is_finite())? * PER_DEGREE;
    #[expect(clippy::cast_possible_truncation, reason = "an angle has some turns at most")]
    Some(parts.round() as i64)
}

fn motion(motion: AxisMotion) -> Option<i64> {
    match motion {
        AxisMotion::Still => Some(0),
        AxisMotion::Plus => Some(1),
        AxisMotion::Minus => Some(-1),
        AxisMotion::Unknown(_) => None,
    }
}

/// Returns the fault of a line, if it has one.
fn fault(finding: Finding) -> Option<String> {
    if finding.is_good() {
        return None;
    }
    serde_json::to_string(&finding).ok()
}

/// Returns the meaning of a line, except of good lines that Azel polls for: most lines are of this
/// kind, and their bytes say the same.
fn meaning(line: &WireLine) -> Option<&str> {
    let is_shown = !line.is_poll || !line.finding.is_good();
    line.meaning.as_ref().filter(|_| is_shown).map(|meaning| &*meaning.text)
}
