//! Passes of a record for later viewing.

use std::{
    ops::{Range, RangeInclusive},
    path::Path,
};

use jiff::{SignedDuration, Timestamp};
use rusqlite::{Connection, Row as SqlRow, Rows, named_params};

use super::{
    Kind, Query, RecordError, RowKind,
    file::{self, PER_DEGREE},
    read,
};
use crate::{
    astro::{Angle, Site, time::seconds_between},
    contract::{
        hooks::HookRun,
        record::{
            AboutTrack, ListedKind, OpenedPass, PassPage, PassQuery, RecordedPass, RecordedReport,
            Row,
        },
    },
    device::Pointing,
    orbit::Propagator,
    plan::{
        Sample,
        pass_report::{MeasuredPosition, TrackPoint},
    },
    station::AntennaId,
};

/// Span of shown entries before the start of the track.
const BEFORE: SignedDuration = SignedDuration::from_secs(300);
/// Span of shown entries after LOS.
const AFTER: SignedDuration = SignedDuration::from_secs(60);
/// Span of the calls of hooks before AOS: the max lead, and the longer pass of the station.
const HOOKS_BEFORE: SignedDuration = SignedDuration::from_mins(30);
/// Span of the ends of calls after LOS: the max lag and the max timeout.
const HOOKS_AFTER: SignedDuration = SignedDuration::from_mins(75);
/// Max length of a found pass. Rows are in order of LOS, so a search by AOS reads this much
/// further.
pub(super) const LONGEST: SignedDuration = SignedDuration::from_hours(24);
/// Step of the predicted path, seconds.
const STEP_S: f64 = 2.0;
/// Kinds of entries that describe a pass.
const SHOWN_KINDS: [Kind; 7] =
    [Kind::Command, Kind::Stop, Kind::Refusal, Kind::Link, Kind::Alarm, Kind::Day, Kind::Gap];

/// Returns the value of the column `verdict`. Passes that were not tracked give an empty text,
/// which no row has.
fn verdict_of(kind: ListedKind) -> &'static str {
    match kind {
        ListedKind::Tracked(verdict) => verdict.word(),
        ListedKind::NotTracked => "",
    }
}

/// Returns the passes that match `query` in the record at `path`.
pub fn passes(path: &Path, query: &PassQuery) -> Result<PassPage, RecordError> {
    page(&file::open_to_read(path)?, query)
}

/// Returns the readable passes that match `query` in the record at `path`, with their AOS in
/// `span`, in order of AOS. Reports without a site belong to an antenna at `site`.
pub fn passes_within(
    path: &Path,
    query: &PassQuery,
    span: &Range<Timestamp>,
    site: Site,
) -> Result<Vec<OpenedPass>, RecordError> {
    let passes = PastPasses::open(path, site)?;
    passes.in_span(query, span)?.into_iter().map(|pass| passes.opened(pass)).collect()
}

/// Returns the pass with this number in the record at `path`. Reports without a site belong to an
/// antenna at `site`.
pub fn open_pass(path: &Path, id: i64, site: Site) -> Result<Option<OpenedPass>, RecordError> {
    let passes = PastPasses::open(path, site)?;
    passes.pass(id)?.map(|pass| passes.opened(pass)).transpose()
}

/// Returns the antenna's directions with their errors.
fn track_of(
    flown: &[MeasuredPosition],
    propagator: &Propagator,
    site: Site,
    about_track: &AboutTrack,
) -> Vec<TrackPoint> {
    let has_elevation = flown.iter().any(|flown| flown.pointing.elevation.is_some());
    let point = |flown: &MeasuredPosition| {
        let point = |flown| TrackPoint::new(propagator, site, has_elevation, flown);
        let compared = point(about_track.compared(propagator, site, *flown))?;
        if about_track.offsets.changes().is_empty() {
            return Some(compared);
        }
        let TrackPoint { antenna, .. } = point(about_track.on_the_sky(*flown))?;
        Some(TrackPoint { antenna, ..compared })
    };
    flown.iter().filter_map(point).collect()
}

pub(super) fn path_of(propagator: &Propagator, site: Site, report: &RecordedReport) -> Vec<Sample> {
    let count = (seconds_between(report.start, report.end) / STEP_S).ceil().max(0.0) as u32;
    let times = (0..=count).map(|step| {
        let time = crate::astro::time::add_seconds(report.start, f64::from(step) * STEP_S);
        time.min(report.end)
    });
    let sample = |time| {
        let look = propagator.look_from(site, time).ok()?;
        Some(Sample { time, direction: look.direction })
    };
    times.filter_map(sample).collect()
}

/// Passes of an open record.
pub(super) struct PastPasses {
    db: Connection,
    /// Site of the antennas in reports without a site.
    site: Site,
}

/// Columns of a pass.
pub(super) const COLUMNS: &str = "id, antenna, (SELECT name FROM antenna AS a WHERE a.id = pass.antenna \
    ORDER BY since_us > pass.until_us, abs(since_us - pass.until_us) LIMIT 1), report";

/// SQL condition of a query for passes.
const MATCHES: &str = "(:antenna IS NULL OR antenna = :antenna) \
    AND (:kind IS NULL OR verdict = :kind) \
    AND (instr(lower(name), lower(:text)) > 0 OR CAST(satellite AS TEXT) = :text \
         OR instr(strftime('%Y-%m-%d', from_us / 1000000, 'unixepoch'), :text) = 1)";

impl PastPasses {
    pub(super) fn open(path: &Path, site: Site) -> Result<Self, RecordError> {
        Ok(Self { db: file::open_to_read(path)?, site })
    }

    /// Returns the site of a report's antenna. Reports without a site are from before Azel modelled
    /// refraction.
    pub(super) fn site_of(&self, report: &RecordedReport) -> Site {
        report.site.unwrap_or(self.site.airless())
    }

    /// Returns the newest readable passes of an antenna that end within `span`, the newest first.
    pub(super) fn newest(
        &self,
        antenna: AntennaId,
        span: &RangeInclusive<Timestamp>,
        count: u32,
    ) -> Result<Vec<RecordedPass>, RecordError> {
        let mut statement = self.db.prepare(&format!(
            "SELECT {COLUMNS} FROM pass WHERE antenna = ?1 AND until_us BETWEEN ?2 AND ?3 \
             ORDER BY until_us DESC LIMIT ?4"
        ))?;
        let (start, end) = (span.start().as_microsecond(), span.end().as_microsecond());
        read_passes(statement.query((antenna.0, start, end, count))?)
    }

    fn in_span(
        &self,
        query: &PassQuery,
        span: &Range<Timestamp>,
    ) -> Result<Vec<RecordedPass>, RecordError> {
        let latest = span.end.checked_add(LONGEST).unwrap_or(Timestamp::MAX);
        let mut statement = self.db.prepare(&format!(
            "SELECT {COLUMNS} FROM pass WHERE until_us BETWEEN :from AND :latest \
             AND from_us >= :from AND from_us < :to AND {MATCHES} ORDER BY from_us"
        ))?;
        read_passes(statement.query(named_params! {
            ":from": span.start.as_microsecond(),
            ":to": span.end.as_microsecond(),
            ":latest": latest.as_microsecond(),
            ":antenna": query.antenna.map(|antenna| antenna.0),
            ":kind": query.kind.map(verdict_of),
            ":text": query.text.trim(),
        })?)
    }

    pub(super) fn pass(&self, id: i64) -> Result<Option<RecordedPass>, RecordError> {
        let mut statement =
            self.db.prepare(&format!("SELECT {COLUMNS} FROM pass WHERE id = ?1"))?;
        let mut rows = statement.query([id])?;
        rows.next()?.map_or(Ok(None), read_pass)
    }

    /// Returns a pass with its track and its entries.
    fn opened(&self, pass: RecordedPass) -> Result<OpenedPass, RecordError> {
        let report = &pass.report;
        let site = self.site_of(report);
        let (track, path) = match Propagator::new(&report.elements) {
            Ok(propagator) => {
                let points = self.points(pass.id)?;
                let track = track_of(&points, &propagator, site, &report.track);
                (track, path_of(&propagator, site, report))
            }
            Err(_) => (Vec::new(), Vec::new()),
        };
        let query = Query {
            start: report.start.min(report.track.begun).checked_sub(BEFORE).ok(),
            end: report.end.checked_add(AFTER).ok(),
            antenna: Some(pass.antenna_name.clone()),
            row_kinds: SHOWN_KINDS.into_iter().map(RowKind::Entry).collect(),
        };
        let mut entries = read::entries(&self.db, &query)?;
        if let Some(end) = query.end {
            entries.extend(self.gap_across(end)?);
        }
        entries.extend(self.hooks(&pass)?);
        Ok(OpenedPass { pass, track, path, entries })
    }

    /// Returns the calls of hooks for a pass. Their entries have the times of their ends.
    fn hooks(&self, pass: &RecordedPass) -> Result<Vec<Row>, RecordError> {
        let report = &pass.report;
        let query = Query {
            start: report.start.checked_sub(HOOKS_BEFORE).ok(),
            end: report.end.checked_add(HOOKS_AFTER).ok(),
            antenna: Some(pass.antenna_name.clone()),
            row_kinds: vec![RowKind::Entry(Kind::Hook)],
        };
        let number = report.elements.catalog_number();
        let is_of_pass = |row: &Row| {
            let run: Option<HookRun> = serde_json::from_value(row.data.clone()).ok();
            run.is_some_and(|run| {
                !run.is_trial && run.belongs_to(pass.antenna, number, report.start, report.end)
            })
        };
        let mut hooks = read::entries(&self.db, &query)?;
        hooks.retain(is_of_pass);
        Ok(hooks)
    }

    /// Returns the gap that began before `time` and ended later. Azel notes a gap at its end, and
    /// gaps do not overlap.
    fn gap_across(&self, time: Timestamp) -> Result<Option<Row>, RecordError> {
        let row_kinds = vec![RowKind::Entry(Kind::Gap)];
        let query = Query { start: Some(time), row_kinds, ..Query::default() };
        let next = read::entries(&self.db, &query)?.into_iter().next();
        Ok(next.filter(|gap| gap.gap_since().is_some_and(|start| start < time)))
    }

    /// Returns the measured track of a pass with the predicted track that controlled the antenna.
    /// Empty if the elements cannot be propagated.
    pub(super) fn led_track(&self, pass: &RecordedPass) -> Result<Vec<TrackPoint>, RecordError> {
        let report = &pass.report;
        let Ok(propagator) = Propagator::new(&report.elements) else { return Ok(Vec::new()) };
        let points = self.points(pass.id)?;
        let led_from = report.track.led_from(self.site_of(report));
        Ok(track_of(&points, &propagator, led_from, &report.track))
    }

    pub(super) fn points(&self, id: i64) -> Result<Vec<MeasuredPosition>, RecordError> {
        let mut statement = self.db.prepare(
            "SELECT utc_us, azimuth, elevation FROM pass_point WHERE pass = ?1 ORDER BY utc_us",
        )?;
        let points = statement.query_map([id], |row| {
            let angle = |place| -> rusqlite::Result<Option<Angle>> {
                let parts: Option<i64> = row.get(place)?;
                Ok(parts.map(|parts| Angle::from_degrees(parts as f64 / PER_DEGREE)))
            };
            Ok(MeasuredPosition {
                time: file::time_of(0, row.get(0)?)?,
                pointing: Pointing { azimuth: angle(1)?, elevation: angle(2)? },
            })
        })?;
        Ok(points.collect::<Result<_, _>>()?)
    }
}

/// Returns the newest passes that match `query`.
fn page(db: &Connection, query: &PassQuery) -> Result<PassPage, RecordError> {
    let antenna = query.antenna.map(|antenna| antenna.0);
    let kind = query.kind.map(verdict_of);
    let text = query.text.trim();
    let of_query = named_params! { ":antenna": antenna, ":kind": kind, ":text": text };
    let matching =
        db.query_row(&format!("SELECT count(*) FROM pass WHERE {MATCHES}"), of_query, |row| {
            row.get(0)
        })?;
    let (all, since_us): (u32, Option<i64>) =
        db.query_row("SELECT count(*), min(until_us) FROM pass", [], |row| {
            Ok((row.get(0)?, row.get(1)?))
        })?;
    let mut page = PassPage {
        matching,
        all,
        start: since_us.and_then(|us| Timestamp::from_microsecond(us).ok()),
        ..PassPage::default()
    };
    let mut statement = db.prepare(&format!(
        "SELECT {COLUMNS} FROM pass WHERE {MATCHES} ORDER BY until_us DESC LIMIT {}",
        query.count
    ))?;
    let mut rows = statement.query(of_query)?;
    while let Some(row) = rows.next()? {
        match read_pass(row)? {
            Some(pass) => page.passes.push(pass),
            None => page.unreadable += 1,
        }
    }
    Ok(page)
}

/// Returns the passes of the rows, without unreadable reports.
pub(super) fn read_passes(mut rows: Rows<'_>) -> Result<Vec<RecordedPass>, RecordError> {
    let mut passes = Vec::new();
    while let Some(row) = rows.next()? {
        passes.extend(read_pass(row)?);
    }
    Ok(passes)
}

/// Returns the pass of a row; `None` if its report is unreadable.
pub(super) fn read_pass(row: &SqlRow<'_>) -> Result<Option<RecordedPass>, RecordError> {
    let report: String = row.get(3)?;
    let Ok(report) = serde_json::from_str(&report) else { return Ok(None) };
    Ok(Some(RecordedPass {
        id: row.get(0)?,
        antenna: AntennaId(row.get(1)?),
        antenna_name: row.get::<_, Option<String>>(2)?.unwrap_or_default(),
        report,
    }))
}
