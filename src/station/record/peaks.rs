//! Reader of the noise peaks of the Sun and the Moon.

use std::path::Path;

use super::{RecordError, file};
use crate::{contract::record::Peaks, station::AntennaId};

/// Reads the peaks of the record at `path`; none if the record does not exist yet.
pub fn read_peaks(path: &Path) -> Result<Peaks, RecordError> {
    let mut peaks = Peaks::default();
    if !path.exists() {
        return Ok(peaks);
    }
    let db = file::open_to_read(path)?;
    let mut statement = db.prepare(
        "SELECT antenna, data FROM event WHERE kind = 'peak' AND antenna IS NOT NULL \
         ORDER BY utc_us, id",
    )?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let (antenna, data): (u32, String) = (row.get(0)?, row.get(1)?);
        if let Ok(change) = serde_json::from_str(&data) {
            peaks.change(AntennaId(antenna), change);
        }
    }
    Ok(peaks)
}
