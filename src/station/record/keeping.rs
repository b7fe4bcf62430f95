//! Retention of the parts of a record.

use std::time::Duration;

use rusqlite::{Connection, OptionalExtension as _, params};

use super::RecordError;
use crate::station::Retention;

const DAY: i64 = 86_400_000_000;
const DAY_US: f64 = DAY as f64;
/// Length of the Julian year, days.
const YEAR_D: f64 = 365.25;
/// Max span of an antenna's positions or frames per removal, microseconds. The writer continues
/// between removals.
const SLICE_US: i64 = 600_000_000;
/// Max number of event rows per removal.
const SLICE_ROWS: i64 = 2000;
/// Max number of reels, and of parts, per removal.
const SLICE_FILM: i64 = 30;
const MINUTE_US: i64 = 60_000_000;
/// Number of empty pages that the file keeps for new data.
const SPARE: i64 = 256;
/// Max number of pages per return to the disk.
const PAGES: i64 = 200;

/// Max pause between runs, microseconds. After a longer one, the clock may be wrong.
const LONGEST_PAUSE_US: i64 = 30 * DAY;
/// Time after which Azel notes the clock again, microseconds.
const NOTED_EVERY_US: i64 = 3_600_000_000;
/// Run time after which Azel trusts a doubtful clock: the operator would have noticed a wrong one.
pub(super) const TRUSTED_AFTER: Duration = Duration::from_hours(24);

/// Returns `true` if the clock may decide which data are old. The clock must continue from its last
/// trusted time, have run for a day since it was doubted, also across runs, or this run must have
/// lasted [`TRUSTED_AFTER`]. With a wrong clock, all data could seem old.
pub(super) fn trusts(db: &Connection, now_us: i64, ran: Duration) -> Result<bool, RecordError> {
    let found = db
        .query_row("SELECT trusted_us, doubted_us FROM clock", [], |row| {
            Ok((row.get(0)?, row.get(1)?))
        })
        .optional()?;
    let (noted, doubted): (Option<i64>, Option<i64>) =
        found.map_or((None, None), |(trusted, doubted)| (Some(trusted), doubted));
    let (ahead_us, is_long) =
        (noted.map(|noted| now_us.saturating_sub(noted)), ran >= TRUSTED_AFTER);
    if ahead_us.is_some_and(|ahead_us| ahead_us > LONGEST_PAUSE_US) && !is_long {
        let since_us = doubted.map(|doubted| now_us.saturating_sub(doubted));
        if !since_us.is_some_and(|since_us| (0..=LONGEST_PAUSE_US).contains(&since_us)) {
            tracing::warn!("nothing of the record is removed for a day: the clock may be wrong");
            db.execute("UPDATE clock SET doubted_us = ?1", [now_us])?;
        }
        let is_steady =
            since_us.is_some_and(|since_us| (DAY..=LONGEST_PAUSE_US).contains(&since_us));
        if !is_steady {
            return Ok(false);
        }
    }
    // A slow clock at worst removes too little, but must not make the right clock look wrong.
    let is_due = |ahead_us| ahead_us > NOTED_EVERY_US || is_long && ahead_us < -NOTED_EVERY_US;
    if ahead_us.is_none_or(is_due) {
        db.execute("INSERT OR REPLACE INTO clock VALUES (0, ?1, NULL)", [now_us])?;
    }
    Ok(true)
}

/// Removes a slice of the data beyond its retention. Returns `true` if more may be left.
pub(super) fn remove_old(
    db: &Connection,
    keeping: Retention,
    now_us: i64,
) -> Result<bool, RecordError> {
    let before = |days: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "some centuries at most")]
        let span_us = (days * DAY_US) as i64;
        now_us.saturating_sub(span_us)
    };
    let raw_before = before(keeping.raw_days);
    let mut is_more = false;
    let antennas: Vec<i64> = db
        .prepare_cached("SELECT DISTINCT id FROM antenna")?
        .query_map([], |row| row.get(0))?
        .collect::<Result<_, _>>()?;
    for table in ["position", "frame"] {
        for antenna in &antennas {
            is_more |= remove_raw(db, table, *antenna, raw_before)?;
        }
    }
    is_more |= remove_film(db, raw_before)?;
    let removed = db
        .prepare_cached(
            "DELETE FROM event WHERE id IN \
             (SELECT id FROM event WHERE utc_us < ?1 ORDER BY utc_us LIMIT ?2)",
        )?
        .execute(params![before(keeping.years * YEAR_D), SLICE_ROWS])?;
    is_more |= removed > 0;
    let old = "SELECT id FROM pass WHERE until_us < ?1 ORDER BY until_us LIMIT 20";
    for table in [
        format!("DELETE FROM pass_point WHERE pass IN ({old})"),
        format!("DELETE FROM pass WHERE id IN ({old})"),
    ] {
        let removed = db.prepare_cached(&table)?.execute([before(keeping.years * YEAR_D)])?;
        is_more |= removed > 0;
    }
    let spare: i64 = db.pragma_query_value(None, "freelist_count", |row| row.get(0))?;
    if spare > SPARE {
        is_more = true;
        // The statement returns one page for each row.
        let mut vacuum = db.prepare(&format!("PRAGMA incremental_vacuum({PAGES})"))?;
        let mut pages = vacuum.query([])?;
        while pages.next()?.is_some() {}
    }
    Ok(is_more)
}

/// Removes some reels that began before `before`, and parts that no reel has shown since.
fn remove_film(db: &Connection, before: i64) -> Result<bool, RecordError> {
    let mut removed = 0;
    for (table, time) in [("reel", "from_us"), ("part", "until_us")] {
        let sql = format!(
            "DELETE FROM {table} WHERE rowid IN \
             (SELECT rowid FROM {table} WHERE {time} < ?1 ORDER BY {time} LIMIT ?2)"
        );
        // A reel may show its parts for a minute longer than the record notes.
        let before = if table == "part" { before - 2 * MINUTE_US } else { before };
        removed += db.prepare_cached(&sql)?.execute(params![before, SLICE_FILM])?;
    }
    Ok(removed > 0)
}

fn remove_raw(
    db: &Connection,
    table: &str,
    antenna: i64,
    before: i64,
) -> Result<bool, RecordError> {
    let oldest: Option<i64> = db
        .prepare_cached(&format!("SELECT min(utc_us) FROM {table} WHERE antenna = ?1"))?
        .query_row([antenna], |row| row.get(0))
        .optional()?
        .flatten();
    let Some(oldest) = oldest.filter(|oldest| *oldest < before) else { return Ok(false) };
    let end = before.min(oldest.saturating_add(SLICE_US));
    db.prepare_cached(&format!("DELETE FROM {table} WHERE antenna = ?1 AND utc_us < ?2"))?
        .execute(params![antenna, end])?;
    Ok(true)
}
