//! SQLite file of the record: its schema and its opening.

use std::{fs, path::Path, time::Duration};

use jiff::Timestamp;
use rusqlite::{Connection, OpenFlags};

use super::RecordError;

/// Version of the schema (`PRAGMA user_version`).
pub(super) const VERSION: i64 = 2;
/// Id of a record file (`PRAGMA application_id`): "Azel" in ASCII.
const APPLICATION: i64 = 0x417a_656c;
/// Timeout for a reader or the writer that waits for the other.
const BUSY: Duration = Duration::from_secs(2);
/// Size to which the write-ahead log is cut once no reader uses it, bytes.
const LOG_BYTES: i64 = 16 << 20;
/// Stored units per degree; angles are stored as whole numbers.
pub(super) const PER_DEGREE: f64 = 10_000.0;

/// Returns the time in `column` of a row. Fails on a time beyond the calendar, which a damaged
/// record may contain.
pub(in crate::record) fn time_of(column: usize, utc_us: i64) -> rusqlite::Result<Timestamp> {
    Timestamp::from_microsecond(utc_us)
        .map_err(|_| rusqlite::Error::IntegralValueOutOfRange(column, utc_us))
}

/// Tables of version 1. Positions and frames are stored in order of antenna and time, without
/// another index: a day of three antennas has millions of them.
const SCHEMA: &str = "
CREATE TABLE run (
    id INTEGER PRIMARY KEY,
    begun_us INTEGER NOT NULL,
    ended_us INTEGER,
    program TEXT NOT NULL
);
CREATE TABLE antenna (
    id INTEGER NOT NULL,
    since_us INTEGER NOT NULL,
    name TEXT NOT NULL,
    make TEXT NOT NULL,
    PRIMARY KEY (id, since_us)
) WITHOUT ROWID;
CREATE TABLE position (
    antenna INTEGER NOT NULL,
    utc_us INTEGER NOT NULL,
    number INTEGER NOT NULL,
    run INTEGER NOT NULL,
    steady_us INTEGER NOT NULL,
    azimuth INTEGER,
    elevation INTEGER,
    axis_1 INTEGER,
    axis_2 INTEGER,
    motion_1 INTEGER,
    motion_2 INTEGER,
    limits INTEGER NOT NULL,
    PRIMARY KEY (antenna, utc_us, number)
) WITHOUT ROWID;
CREATE TABLE frame (
    antenna INTEGER NOT NULL,
    utc_us INTEGER NOT NULL,
    number INTEGER NOT NULL,
    run INTEGER NOT NULL,
    is_sent INTEGER NOT NULL,
    bytes BLOB NOT NULL,
    length INTEGER,
    fault TEXT,
    meaning TEXT,
    reply_us INTEGER,
    PRIMARY KEY (antenna, utc_us, number)
) WITHOUT ROWID;
CREATE TABLE event (
    id INTEGER PRIMARY KEY,
    utc_us INTEGER NOT NULL,
    steady_us INTEGER NOT NULL,
    run INTEGER NOT NULL,
    antenna INTEGER,
    kind TEXT NOT NULL,
    data TEXT NOT NULL
);
CREATE INDEX event_time ON event (utc_us);
CREATE TABLE pass (
    id INTEGER PRIMARY KEY,
    antenna INTEGER NOT NULL,
    satellite INTEGER NOT NULL,
    name TEXT NOT NULL,
    from_us INTEGER NOT NULL,
    until_us INTEGER NOT NULL,
    run INTEGER NOT NULL,
    verdict TEXT NOT NULL,
    report TEXT NOT NULL
);
CREATE INDEX pass_time ON pass (until_us);
CREATE TABLE pass_point (
    pass INTEGER NOT NULL,
    utc_us INTEGER NOT NULL,
    azimuth INTEGER,
    elevation INTEGER,
    PRIMARY KEY (pass, utc_us)
) WITHOUT ROWID;
CREATE VIEW positions AS SELECT
    strftime('%Y-%m-%dT%H:%M:%fZ', utc_us / 1000000.0, 'unixepoch') AS time,
    (SELECT name FROM antenna AS a WHERE a.id = antenna ORDER BY since_us DESC LIMIT 1) AS antenna,
    azimuth / 10000.0 AS azimuth_deg, elevation / 10000.0 AS elevation_deg,
    axis_1 / 10000.0 AS axis_1_deg, axis_2 / 10000.0 AS axis_2_deg,
    motion_1, motion_2, limits
    FROM position;
CREATE VIEW events AS SELECT
    strftime('%Y-%m-%dT%H:%M:%fZ', utc_us / 1000000.0, 'unixepoch') AS time,
    (SELECT name FROM antenna AS a WHERE a.id = antenna ORDER BY since_us DESC LIMIT 1) AS antenna,
    kind, data
    FROM event;
";

/// Tables of the film, new in version 2.
const FILM: &str = "
CREATE TABLE reel (
    run INTEGER NOT NULL,
    number INTEGER NOT NULL,
    piece INTEGER NOT NULL,
    from_us INTEGER NOT NULL,
    until_us INTEGER NOT NULL,
    pictures BLOB NOT NULL,
    PRIMARY KEY (run, number, piece)
);
CREATE INDEX reel_time ON reel (from_us);
CREATE TABLE part (
    run INTEGER NOT NULL,
    number INTEGER NOT NULL,
    until_us INTEGER NOT NULL,
    content BLOB NOT NULL,
    PRIMARY KEY (run, number)
);
CREATE INDEX part_time ON part (until_us);
";

/// Indexes for rare kinds of entries. Azel also adds them to a record of an older program.
const FEW: &str = "
CREATE INDEX IF NOT EXISTS event_day ON event (utc_us) WHERE kind = 'day';
CREATE INDEX IF NOT EXISTS event_peak ON event (utc_us) WHERE kind = 'peak';
CREATE INDEX IF NOT EXISTS event_gap ON event (utc_us) WHERE kind = 'gap';
";

/// Table with the last trusted time of this computer's clock, for deleting old parts. Azel also
/// adds it to a record of an older program, with the time of the newest entry.
const CLOCK: &str = "
CREATE TABLE clock (
    id INTEGER PRIMARY KEY CHECK (id = 0), trusted_us INTEGER NOT NULL, doubted_us INTEGER
);
INSERT INTO clock SELECT 0, utc_us, NULL FROM event ORDER BY utc_us DESC LIMIT 1;
";

/// Opens the record at `path` for writing; creates a missing file.
pub(super) fn open(path: &Path) -> Result<Connection, RecordError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE
        | OpenFlags::SQLITE_OPEN_CREATE
        | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut db = Connection::open_with_flags(path, flags)?;
    // Only the owner may read where the antennas are and what they did.
    #[cfg(unix)]
    fs::set_permissions(path, std::os::unix::fs::PermissionsExt::from_mode(0o600))?;
    db.busy_timeout(BUSY)?;
    let version = version(&db)?;
    match version {
        0 => {
            // `auto_vacuum` cannot change after the first table, so set it now.
            db.pragma_update(None, "auto_vacuum", "INCREMENTAL")?;
            let of_new = db.transaction()?;
            of_new.execute_batch(SCHEMA)?;
            of_new.execute_batch(FILM)?;
            of_new.pragma_update(None, "application_id", APPLICATION)?;
            of_new.pragma_update(None, "user_version", VERSION)?;
            of_new.commit()?;
        }
        1 => {
            let of_old = db.transaction()?;
            of_old.execute_batch(FILM)?;
            of_old.pragma_update(None, "user_version", VERSION)?;
            of_old.commit()?;
        }
        VERSION => {}
        newer => return Err(RecordError::Newer(newer)),
    }
    db.execute_batch(FEW)?;
    if !db.table_exists(None, "clock")? {
        let of_old = db.transaction()?;
        of_old.execute_batch(CLOCK)?;
        of_old.commit()?;
    }
    // With these settings, readers do not disturb the writer, and commits survive a loss of power.
    db.pragma_update(None, "journal_mode", "WAL")?;
    db.pragma_update(None, "synchronous", "FULL")?;
    db.pragma_update(None, "journal_size_limit", LOG_BYTES)?;
    Ok(db)
}

/// Opens the record at `path` for reading only, also during writes.
pub(super) fn open_to_read(path: &Path) -> Result<Connection, RecordError> {
    let db = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
    db.busy_timeout(BUSY)?;
    match version(&db)? {
        1..=VERSION => Ok(db),
        0 => Err(RecordError::NoRecord),
        newer => Err(RecordError::Newer(newer)),
    }
}

/// Returns the version of the schema; 0 for an empty file.
fn version(db: &Connection) -> Result<i64, RecordError> {
    let number = |name| db.pragma_query_value(None, name, |row| row.get::<_, i64>(0));
    let (application, version) = (number("application_id")?, number("user_version")?);
    let tables: i64 = db.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
    match (application, version) {
        (APPLICATION, version) if version > 0 => Ok(version),
        (0, 0) if tables == 0 => Ok(0),
        _ => Err(RecordError::NoRecord),
    }
}
