//! Reader of a record, also during writes.

use std::{collections::BTreeMap, path::Path};

use jiff::Timestamp;
use rusqlite::{Connection, Row as SqlRow, params_from_iter};
use serde_json::{Value, json};

use super::{
    Kind, RecordError,
    file::{self, PER_DEGREE},
};
use crate::contract::record::Row;

/// Bounds before and after the times of all rows, microseconds.
const EARLIEST_US: i64 = i64::MIN / 2;
const LATEST_US: i64 = i64::MAX / 2;

/// Kind of a row of the record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// Entry of the station.
    Entry(Kind),
    /// Measured position.
    Position,
    /// Line on a link.
    Frame,
    /// Tracked pass with its report, at the end of the pass.
    Pass,
}

impl RowKind {
    /// Returns all kinds, entries first.
    pub fn all() -> impl Iterator<Item = Self> {
        let others = [Self::Pass, Self::Position, Self::Frame];
        Kind::ALL.into_iter().map(Self::Entry).chain(others)
    }

    pub fn word(self) -> &'static str {
        match self {
            Self::Entry(kind) => kind.word(),
            Self::Position => "position",
            Self::Frame => "frame",
            Self::Pass => "pass",
        }
    }
}

/// Selection of rows.
#[derive(Debug, Clone, Default)]
pub struct Query {
    /// First selected time.
    pub start: Option<Timestamp>,
    /// End of the selected time; rows at `end` are excluded.
    pub end: Option<Timestamp>,
    /// Name of the antenna, current or at the time of the row. Gaps, and STOPs that were meant for
    /// this antenna, count as its rows.
    pub antenna: Option<String>,
    pub row_kinds: Vec<RowKind>,
}

/// SQL condition for rows of the queried antenna.
const OF_ANTENNA: &str = "WHERE antenna IN (SELECT id FROM antenna AS named WHERE named.name = ?1)";

/// SQL condition for entries without an antenna that also concern the queried one.
const OR_OF_SEVERAL: &str = "OR antenna IS NULL AND CASE kind WHEN 'gap' THEN 1 WHEN 'stop' THEN EXISTS \
        (SELECT 1 FROM (SELECT value FROM json_each(data, '$.antennas') \
            UNION ALL SELECT value FROM json_each(data, '$.elsewhere')) AS pressed \
        WHERE pressed.value IN (SELECT id FROM antenna AS named WHERE named.name = ?1)) \
    ELSE 0 END";

/// Position of a reader in the record. Each antenna has its own position, because one antenna may
/// report an older measurement later than another.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct ReaderPosition {
    event: i64,
    pass: i64,
    /// Time of the latest position of each antenna, microseconds.
    position_us: BTreeMap<i64, i64>,
    /// Time of the latest line of each antenna, microseconds.
    frame_us: BTreeMap<i64, i64>,
}

/// Record that is open for reading.
pub struct Record {
    db: Connection,
    read_to: ReaderPosition,
}

impl Record {
    /// Opens the record at `path`.
    pub fn open(path: &Path) -> Result<Self, RecordError> {
        Ok(Self { db: file::open_to_read(path)?, read_to: ReaderPosition::default() })
    }

    /// Passes unread rows that match `query` to `take`, in order of time, until `take` returns
    /// `false`. `take` must not wait: the file frees no space during the call.
    pub fn read(
        &mut self,
        query: &Query,
        take: &mut dyn FnMut(Row) -> bool,
    ) -> Result<(), RecordError> {
        // Both reads see the same state of the file during concurrent writes.
        let _state = self.db.unchecked_transaction()?;
        let place = self.place()?;
        if place != self.read_to {
            rows(&self.db, query, (&self.read_to, &place), take)?;
        }
        self.read_to = place;
        Ok(())
    }

    /// Returns the end of the data in the record.
    fn place(&self) -> Result<ReaderPosition, RecordError> {
        let newest = |table: &str| {
            let sql = format!("SELECT max(id) FROM {table}");
            self.db.query_row(&sql, [], |row| row.get::<_, Option<i64>>(0))
        };
        let latest = |table: &str| -> Result<BTreeMap<i64, i64>, RecordError> {
            let mut statement = self.db.prepare_cached(&format!(
                "SELECT id, (SELECT max(utc_us) FROM {table} WHERE antenna = a.id) \
                 FROM (SELECT DISTINCT id FROM antenna) AS a"
            ))?;
            let rows = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?;
            let rows: Vec<(i64, Option<i64>)> = rows.collect::<Result<_, _>>()?;
            Ok(rows.into_iter().filter_map(|(antenna, utc_us)| Some((antenna, utc_us?))).collect())
        };
        Ok(ReaderPosition {
            event: newest("event")?.unwrap_or_default(),
            pass: newest("pass")?.unwrap_or_default(),
            position_us: latest("position")?,
            frame_us: latest("frame")?,
        })
    }
}

/// Returns the entries that match `query`, in order of time.
pub(super) fn entries(db: &Connection, query: &Query) -> Result<Vec<Row>, RecordError> {
    let mut found = Vec::new();
    let all = ReaderPosition::default();
    rows(db, query, (&all, &all), &mut |row| {
        found.push(row);
        true
    })?;
    Ok(found)
}

/// Passes the rows between two positions to `take`.
fn rows(
    db: &Connection,
    query: &Query,
    (before, now): (&ReaderPosition, &ReaderPosition),
    take: &mut dyn FnMut(Row) -> bool,
) -> Result<(), RecordError> {
    let from_us = query.start.map_or(EARLIEST_US, Timestamp::as_microsecond);
    let to_us = query.end.map_or(LATEST_US, Timestamp::as_microsecond);
    let mut parts = Vec::new();
    let is_entry = |row_kind: &&RowKind| matches!(row_kind, RowKind::Entry(_));
    let kinds: Vec<&str> =
        query.row_kinds.iter().filter(is_entry).map(|row_kind| row_kind.word()).collect();
    if !kinds.is_empty() {
        parts.push(format!(
            "SELECT utc_us, run, steady_us, antenna, kind, data, NULL AS b, NULL AS c, \
                 NULL AS d, NULL AS e, NULL AS f, NULL AS g FROM event \
                 WHERE utc_us >= {from_us} AND utc_us < {to_us} AND id > {} AND kind IN ('{}')",
            before.event,
            kinds.join("', '")
        ));
    }
    if query.row_kinds.contains(&RowKind::Pass) {
        parts.push(format!(
            "SELECT until_us AS utc_us, run, NULL AS steady_us, antenna, 'pass' AS kind, \
                 report, satellite, name, NULL, NULL, NULL, NULL FROM pass \
                 WHERE until_us >= {from_us} AND until_us < {to_us} AND id > {}",
            before.pass
        ));
    }
    let mut of_antennas = |select: &str, now: &BTreeMap<i64, i64>, read: &BTreeMap<i64, i64>| {
        for (antenna, newest_us) in now {
            let after_us = read.get(antenna).map_or(from_us, |read_us| from_us.max(read_us + 1));
            if after_us <= *newest_us {
                parts.push(format!(
                    "{select} WHERE antenna = {antenna} \
                         AND utc_us >= {after_us} AND utc_us < {to_us}"
                ));
            }
        }
    };
    if query.row_kinds.contains(&RowKind::Position) {
        let select = "SELECT utc_us, run, steady_us, antenna, 'position' AS kind, azimuth, \
                          elevation, axis_1, axis_2, motion_1, motion_2, limits FROM position";
        of_antennas(select, &now.position_us, &before.position_us);
    }
    if query.row_kinds.contains(&RowKind::Frame) {
        let select = "SELECT utc_us, run, NULL AS steady_us, antenna, 'frame' AS kind, \
                          is_sent, bytes, length, fault, meaning, reply_us, NULL FROM frame";
        of_antennas(select, &now.frame_us, &before.frame_us);
    }
    if parts.is_empty() {
        return Ok(());
    }
    let of_antenna = match &query.antenna {
        Some(_) if kinds.is_empty() => [OF_ANTENNA, ""],
        Some(_) => [OF_ANTENNA, OR_OF_SEVERAL],
        None => ["", ""],
    };
    let sql = format!(
        "SELECT *, (SELECT name FROM antenna AS a WHERE a.id = antenna ORDER BY \
             since_us > all_rows.utc_us, abs(since_us - all_rows.utc_us) LIMIT 1) AS antenna_name \
             FROM ({}) AS all_rows {of_antenna} ORDER BY utc_us",
        parts.join(" UNION ALL "),
        of_antenna = of_antenna.join(" ")
    );
    let mut statement = db.prepare(&sql)?;
    let mut rows = statement.query(params_from_iter(&query.antenna))?;
    while let Some(row) = rows.next()? {
        if !take(read_row(row)?) {
            break;
        }
    }
    Ok(())
}

fn read_row(row: &SqlRow<'_>) -> Result<Row, RecordError> {
    let utc_us: i64 = row.get(0)?;
    let kind: String = row.get(4)?;
    let data = match &*kind {
        "position" => {
            let deg = |place| -> Result<Option<f64>, RecordError> {
                Ok(row.get::<_, Option<i64>>(place)?.map(|parts| parts as f64 / PER_DEGREE))
            };
            let motion = |place| row.get::<_, Option<i64>>(place);
            json!({
                "azimuth_deg": deg(5)?,
                "elevation_deg": deg(6)?,
                "axes_deg": [deg(7)?, deg(8)?],
                "motion": [motion(9)?, motion(10)?],
                "limits": row.get::<_, i64>(11)?,
            })
        }
        "frame" => {
            let bytes: Vec<u8> = row.get(6)?;
            let reply_us: Option<i64> = row.get(10)?;
            let fault: Option<String> = row.get(8)?;
            json!({
                "is_sent": row.get::<_, bool>(5)?,
                "bytes": written(&bytes),
                "length": row.get::<_, Option<i64>>(7)?,
                "fault": fault.and_then(|fault| serde_json::from_str::<Value>(&fault).ok()),
                "meaning": row.get::<_, Option<String>>(9)?,
                "reply_s": reply_us.map(|us| us as f64 / 1e6),
            })
        }
        "pass" => {
            let report: String = row.get(5)?;
            json!({
                "satellite": row.get::<_, u32>(6)?,
                "name": row.get::<_, String>(7)?,
                "report": serde_json::from_str::<Value>(&report).unwrap_or_default(),
            })
        }
        _ => serde_json::from_str(&row.get::<_, String>(5)?).unwrap_or_default(),
    };
    Ok(Row {
        time: file::time_of(0, utc_us)?,
        run: row.get(1)?,
        steady_s: row.get::<_, Option<i64>>(2)?.map(|us| us as f64 / 1e6),
        antenna: row.get("antenna_name")?,
        kind,
        data,
    })
}

/// Returns bytes as text: printable ASCII unchanged, other bytes as `\x0d`, and a backslash as
/// `\\`.
fn written(bytes: &[u8]) -> String {
    bytes.escape_ascii().to_string()
}
