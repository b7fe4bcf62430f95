//! Reads a record, also while it is written.

use std::path::Path;

use jiff::Timestamp;
use rusqlite::{Connection, Row as SqlRow, params_from_iter, types::Value as SqlValue};
use serde::Serialize;
use serde_json::{Value, json};

use super::{
    Kind, RecordError,
    file::{self, PER_DEGREE},
};

/// What a row of the record is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum What {
    /// An entry of the station.
    Entry(Kind),
    /// A measured position.
    Position,
    /// A line on a link.
    Frame,
    /// A pass that was tracked, at its end, with its report.
    Pass,
}

impl What {
    /// All, entries first.
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

/// Which rows are wanted.
#[derive(Debug, Clone, Default)]
pub struct Query {
    /// From this time on.
    pub from: Option<Timestamp>,
    /// Before this time.
    pub to: Option<Timestamp>,
    /// Name of the antenna, now or at the time.
    pub antenna: Option<String>,
    pub what: Vec<What>,
}

/// A row of the record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// UTC.
    pub time: Timestamp,
    /// Number of the run of the program.
    pub run: i64,
    /// Seconds of the steady clock since that run began; `None` for lines on a link.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_s: Option<f64>,
    /// Name of the antenna at the time, if the row has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    pub kind: String,
    /// What the kind tells; see `docs/record.md`.
    pub data: Value,
}

/// Up to where a reader has read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Place {
    event: i64,
    pass: i64,
    /// Latest time of a position or line that was read, microseconds.
    raw_us: i64,
}

/// A record to be read.
pub struct Record {
    db: Connection,
    read_to: Place,
}

impl Record {
    /// Opens the record at `path`.
    pub fn open(path: &Path) -> Result<Self, RecordError> {
        Ok(Self { db: file::open_to_read(path)?, read_to: Place::default() })
    }

    /// Hands the rows that `query` wants to `take`, in order of time, until it returns `false`.
    pub fn read(
        &mut self,
        query: &Query,
        take: &mut dyn FnMut(Row) -> bool,
    ) -> Result<(), RecordError> {
        let place = self.place()?;
        self.rows(query, &Span::of(query, Place::default()), take)?;
        self.read_to = place;
        Ok(())
    }

    /// Hands the rows that have come since the last reading to `take`.
    pub fn read_on(
        &mut self,
        query: &Query,
        take: &mut dyn FnMut(Row) -> bool,
    ) -> Result<(), RecordError> {
        let place = self.place()?;
        if place == self.read_to {
            return Ok(());
        }
        self.rows(query, &Span::of(query, self.read_to), take)?;
        self.read_to = place;
        Ok(())
    }

    /// Up to where there is something to read.
    fn place(&self) -> Result<Place, RecordError> {
        let newest = |sql: &str| {
            self.db
                .query_row(sql, [], |row| row.get::<_, Option<i64>>(0))
                .map(Option::unwrap_or_default)
        };
        let raw = |table: &str| {
            newest(&format!(
                "SELECT max((SELECT max(utc_us) FROM {table} WHERE antenna = a.id)) \
                 FROM (SELECT DISTINCT id FROM antenna) AS a"
            ))
        };
        Ok(Place {
            event: newest("SELECT max(id) FROM event")?,
            pass: newest("SELECT max(id) FROM pass")?,
            raw_us: raw("position")?.max(raw("frame")?),
        })
    }

    fn rows(
        &self,
        query: &Query,
        span: &Span,
        take: &mut dyn FnMut(Row) -> bool,
    ) -> Result<(), RecordError> {
        let mut parts = Vec::new();
        let kinds: Vec<&str> = (query.what.iter())
            .filter(|what| matches!(what, What::Entry(_)))
            .map(|what| what.word())
            .collect();
        if !kinds.is_empty() {
            let kinds = kinds.join("', '");
            parts.push(format!(
                "SELECT utc_us, run, steady_us, antenna, kind, data, \
                 NULL AS b, NULL AS c, NULL AS d, NULL AS e, NULL AS f, NULL AS g \
                 FROM event WHERE utc_us >= ?1 AND utc_us < ?2 AND id > ?3 \
                 AND kind IN ('{kinds}')"
            ));
        }
        if query.what.contains(&What::Position) {
            parts.push(
                "SELECT utc_us, run, steady_us, antenna, 'position' AS kind, azimuth, elevation, axis_1, \
                 axis_2, motion_1, motion_2, limits FROM position \
                 WHERE antenna IN (SELECT id FROM antenna) \
                 AND utc_us >= ?1 AND utc_us < ?2 AND utc_us > ?4"
                    .to_owned(),
            );
        }
        if query.what.contains(&What::Frame) {
            parts.push(
                "SELECT utc_us, run, NULL AS steady_us, antenna, 'frame' AS kind, is_sent, bytes, length, fault, \
                 meaning, reply_us, NULL FROM frame \
                 WHERE antenna IN (SELECT id FROM antenna) \
                 AND utc_us >= ?1 AND utc_us < ?2 AND utc_us > ?4"
                    .to_owned(),
            );
        }
        if query.what.contains(&What::Pass) {
            parts.push(
                "SELECT until_us AS utc_us, run, NULL AS steady_us, antenna, 'pass' AS kind, report, satellite, name, NULL, \
                 NULL, NULL, NULL FROM pass \
                 WHERE until_us >= ?1 AND until_us < ?2 AND id > ?5"
                    .to_owned(),
            );
        }
        if parts.is_empty() {
            return Ok(());
        }
        let of_antenna = query.antenna.as_ref().map_or(
            "",
            |_| "WHERE antenna IN (SELECT id FROM antenna AS named WHERE named.name = ?6)",
        );
        let sql = format!(
            "SELECT *, (SELECT name FROM antenna AS a WHERE a.id = antenna \
             ORDER BY since_us > all_rows.utc_us, abs(since_us - all_rows.utc_us) LIMIT 1) AS antenna_name \
             FROM ({}) AS all_rows {of_antenna} ORDER BY utc_us",
            parts.join(" UNION ALL ")
        );
        let mut statement = self.db.prepare(&sql)?;
        let mut given: Vec<SqlValue> = vec![
            span.from_us.into(),
            span.to_us.into(),
            span.after.event.into(),
            span.after.raw_us.into(),
            span.after.pass.into(),
        ];
        given.extend(query.antenna.clone().map(SqlValue::from));
        given.truncate(statement.parameter_count());
        let mut rows = statement.query(params_from_iter(given))?;
        while let Some(row) = rows.next()? {
            if !take(read_row(row)?) {
                break;
            }
        }
        Ok(())
    }
}

/// Which rows are looked at.
struct Span {
    from_us: i64,
    to_us: i64,
    after: Place,
}

impl Span {
    fn of(query: &Query, after: Place) -> Self {
        Self {
            from_us: query.from.map_or(i64::MIN, Timestamp::as_microsecond),
            to_us: query.to.map_or(i64::MAX, Timestamp::as_microsecond),
            after,
        }
    }
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
        time: Timestamp::from_microsecond(utc_us).unwrap_or_default(),
        run: row.get(1)?,
        steady_s: row.get::<_, Option<i64>>(2)?.map(|us| us as f64 / 1e6),
        antenna: row.get("antenna_name")?,
        kind,
        data,
    })
}

/// Bytes as text: printable ASCII as it stands, the rest as `\x0d`, a backslash as `\\`.
fn written(bytes: &[u8]) -> String {
    bytes.escape_ascii().to_string()
}
