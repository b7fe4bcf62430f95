//! Passes of a record in order of time: their times, and the neighbours of a pass.

use std::path::Path;

use jiff::Timestamp;
use rusqlite::{OptionalExtension as _, named_params};

use super::{
    RecordError, file,
    past::{COLUMNS, LONGEST, PastPasses, path_of, read_pass, read_passes},
};
use crate::{
    astro::Site,
    contract::record::{PassTimes, RecordedPass},
    orbit::Propagator,
};

/// Starting point of a search for the next or previous pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Neighbour {
    /// Pass with this number. The search skips the same pass of another antenna.
    Pass(i64),
    /// Time of the start. A pass under way counts as the next one.
    Moment(Timestamp),
}

/// Returns the times of the passes between two times in the record at `path`. Reports without a
/// site belong to an antenna at `site`.
pub fn times_between(
    path: &Path,
    start: Timestamp,
    end: Timestamp,
    site: Site,
) -> Result<Vec<PassTimes>, RecordError> {
    let db = file::open_to_read(path)?;
    let latest = end.checked_add(LONGEST).unwrap_or(Timestamp::MAX);
    let sql = format!(
        "SELECT {COLUMNS} FROM pass WHERE until_us BETWEEN :from AND :latest AND from_us < :until \
         ORDER BY until_us"
    );
    let mut statement = db.prepare(&sql)?;
    let found = read_passes(statement.query(named_params! {
        ":from": start.as_microsecond(),
        ":until": end.as_microsecond(),
        ":latest": latest.as_microsecond(),
    })?)?;
    Ok(found.iter().map(|pass| times_of(pass, site)).collect())
}

/// Returns the times of the pass with this number.
pub fn times_of_pass(path: &Path, id: i64, site: Site) -> Result<Option<PassTimes>, RecordError> {
    let passes = PastPasses::open(path, site)?;
    Ok(passes.pass(id)?.map(|pass| times_of(&pass, site)))
}

/// Returns the pass after or before `reference`, of any antenna.
pub fn neighbour(
    path: &Path,
    reference: Neighbour,
    is_next: bool,
) -> Result<Option<RecordedPass>, RecordError> {
    let db = file::open_to_read(path)?;
    let found = match reference {
        Neighbour::Moment(time) => Some((0, time.as_microsecond(), time.as_microsecond())),
        Neighbour::Pass(id) => db
            .query_row("SELECT satellite, from_us, until_us FROM pass WHERE id = ?1", [id], |row| {
                Ok((row.get(0)?, row.get(1)?, row.get(2)?))
            })
            .optional()?,
    };
    let Some((satellite, from_us, until_us)) = found else { return Ok(None) };
    let (side, order) = if is_next { (">", "ASC") } else { ("<", "DESC") };
    let sql = format!(
        "SELECT {COLUMNS} FROM pass WHERE until_us {side} :until \
         AND NOT (satellite = :satellite AND from_us < :until AND until_us > :from) \
         ORDER BY until_us {order} LIMIT 1"
    );
    let parameters =
        named_params! { ":satellite": satellite, ":from": from_us, ":until": until_us };
    let mut statement = db.prepare(&sql)?;
    let mut rows = statement.query(parameters)?;
    rows.next()?.map_or(Ok(None), read_pass)
}

fn times_of(pass: &RecordedPass, site: Site) -> PassTimes {
    let report = &pass.report;
    let site = report.site.unwrap_or(site);
    let path = Propagator::new(&report.elements)
        .map(|propagator| path_of(&propagator, site, report))
        .unwrap_or_default();
    let highest = path
        .iter()
        .max_by(|a, b| a.direction.elevation.radians().total_cmp(&b.direction.elevation.radians()));
    PassTimes {
        name: report.elements.short_name().to_owned(),
        aos: report.start,
        tca: highest.map(|sample| sample.time),
        los: report.end,
        lost: report.report.losses.iter().map(|lost| (lost.start, lost.end)).collect(),
    }
}
