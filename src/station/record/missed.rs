//! Passes that automatic operation was to track but that no antenna tracked.

use std::path::Path;

use jiff::Timestamp;
use rusqlite::named_params;
use serde_json::Value;

use super::{RecordError, file, past::LONGEST};
use crate::{
    contract::record::{ListedKind, PassPage, PassQuery},
    station::AntennaId,
};

/// Entry of the list of the day about a pass without a report.
#[derive(Debug, Clone, PartialEq)]
pub struct MissedEntry {
    /// Number of the entry.
    pub id: i64,
    /// End of the pass for the antenna.
    pub time: Timestamp,
    pub antenna: AntennaId,
    /// Name of the antenna at the time.
    pub antenna_name: String,
    /// Outcome of the pass; `docs/record.md` describes its fields.
    pub flown: Value,
}

/// Returns the missed passes in the record at `path` that match `query`, the newest first. They
/// cover the same time as `page`.
pub fn missed(
    path: &Path,
    query: &PassQuery,
    page: &PassPage,
) -> Result<Vec<MissedEntry>, RecordError> {
    if matches!(query.kind, Some(ListedKind::Tracked(_))) {
        return Ok(Vec::new());
    }
    // Older missed passes appear together with the older passes.
    let is_whole = page.matching <= query.count;
    let start = page.passes.last().filter(|_| !is_whole).map(|pass| pass.report.end);
    let db = file::open_to_read(path)?;
    // Skip passes with time in the beam: an antenna tracked them while nothing could be recorded.
    let mut statement = db.prepare(
        "SELECT id, utc_us, antenna, (SELECT name FROM antenna AS a WHERE a.id = e.antenna \
         ORDER BY since_us > e.utc_us, abs(since_us - e.utc_us) LIMIT 1), flown FROM \
         (SELECT id, utc_us, antenna, json_extract(data, '$.what.flown') AS flown FROM event \
          WHERE kind = 'day' AND utc_us >= :since) AS e \
         WHERE flown IS NOT NULL AND coalesce(flown ->> '$.in_beam_s', 0) <= 0 \
         AND (:antenna IS NULL OR antenna = :antenna) \
         AND (instr(lower(flown ->> '$.name'), lower(:text)) > 0 \
              OR CAST(flown ->> '$.pass[0]' AS TEXT) = :text \
              OR instr(flown ->> '$.pass[1]', :text) = 1) \
         AND NOT EXISTS (SELECT 1 FROM pass WHERE pass.antenna = e.antenna \
             AND satellite = flown ->> '$.pass[0]' AND from_us < e.utc_us \
             AND until_us BETWEEN unixepoch(flown ->> '$.pass[1]') * 1000000 \
                 AND e.utc_us + :longest_s * 1000000) \
         ORDER BY utc_us DESC LIMIT :count",
    )?;
    let mut rows = statement.query(named_params! {
        ":since": start.map_or(i64::MIN, Timestamp::as_microsecond),
        ":antenna": query.antenna.map(|antenna| antenna.0),
        ":text": query.text.trim(),
        ":count": query.count,
        ":longest_s": LONGEST.as_secs(),
    })?;
    let mut found = Vec::new();
    while let Some(row) = rows.next()? {
        let flown: String = row.get(4)?;
        let Ok(flown) = serde_json::from_str(&flown) else { continue };
        found.push(MissedEntry {
            id: row.get(0)?,
            time: file::time_of(1, row.get(1)?)?,
            antenna: AntennaId(row.get(2)?),
            antenna_name: row.get::<_, Option<String>>(3)?.unwrap_or_default(),
            flown,
        });
    }
    Ok(found)
}
