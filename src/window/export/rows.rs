//! Rows as comma-separated values and as JSON, from the fields of a struct.

use std::{
    borrow::Cow,
    io::{self, Write},
};

use jiff::{Timestamp, fmt::temporal::DateTimePrinter};
use rayon::prelude::*;
use serde::{Serialize, Serializer};

/// Version of the JSON fields. A version only ever gains fields.
pub const FORMAT_VERSION: u32 = 1;
/// Number of rows that Azel makes before it writes them.
const AT_ONCE: usize = 1 << 12;
/// Number of rows that one thread takes at a time.
const CHUNK: usize = 256;

/// A row format for programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowFormat {
    Csv,
    /// An object with `format_version` and the rows, one row a line.
    Json,
}

impl RowFormat {
    /// Returns a text from an external source. CSV needs an escape so that no spreadsheet treats
    /// the text as a formula.
    ///
    /// Source: OWASP, "CSV Injection".
    pub fn text(self, text: &str) -> Cow<'_, str> {
        let is_formula = matches!(text.as_bytes(), [b'=' | b'+' | b'-' | b'@' | b'\t' | b'\r', ..]);
        match self {
            Self::Csv if is_formula => Cow::Owned(format!("'{text}")),
            Self::Csv | Self::Json => Cow::Borrowed(text),
        }
    }

    /// Formats these rows, one row a line; in JSON a comma precedes each row.
    fn lines<R: Serialize>(self, rows: impl IntoIterator<Item = R>) -> io::Result<Vec<u8>> {
        match self {
            Self::Csv => {
                let mut table =
                    csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
                for row in rows {
                    table.serialize(row).map_err(io_error)?;
                }
                table.into_inner().map_err(csv::IntoInnerError::into_error)
            }
            Self::Json => {
                let mut text = Vec::new();
                for row in rows {
                    text.extend_from_slice(b",\n");
                    serde_json::to_writer(&mut text, &row)?;
                }
                Ok(text)
            }
        }
    }
}

/// A time as RFC 3339, UTC, with milliseconds.
#[derive(Debug, Clone, Copy, Default)]
pub struct Time(pub Timestamp);

impl Serialize for Time {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&rfc3339::<3>(to_millisecond(self.0)))
    }
}

/// Rounds to the nearest millisecond; halves round away from 1970.
pub(super) fn to_millisecond(time: Timestamp) -> Timestamp {
    let nanoseconds = time.subsec_nanosecond();
    let milliseconds = (nanoseconds.abs() + 500_000) / 1_000_000 * nanoseconds.signum();
    let since_1970 = time.as_second() * 1000 + i64::from(milliseconds);
    Timestamp::from_millisecond(since_1970).unwrap_or(time)
}

/// Returns a time as RFC 3339, UTC, with `DECIMALS` decimals of a second; further decimals are cut
/// off.
pub(super) fn rfc3339<const DECIMALS: u8>(time: Timestamp) -> String {
    let mut text = String::with_capacity(32);
    // Appending to a string cannot fail.
    let _ = DateTimePrinter::new().precision(Some(DECIMALS)).print_timestamp(&time, &mut text);
    text
}

/// Rounds to the nearest multiple of 1 / `parts`.
pub fn rounded(value: f64, parts: f64) -> f64 {
    // Adding zero makes a negative zero positive.
    (value * parts).round() / parts + 0.0
}

/// Returns the original error of the output. Its kind distinguishes a closed pipe from a full disk.
fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// Writes `rows` in their order. The columns of CSV are the fields of `columns`. JSON is an object
/// with `format_version`, the fields of `fields`, and the rows under `name`.
pub fn write_rows<R: Serialize>(
    out: &mut impl Write,
    format: RowFormat,
    (name, fields): (&str, &[(&str, serde_json::Value)]),
    columns: &R,
    rows: impl IntoIterator<Item = R>,
) -> io::Result<()> {
    let mut rows = rows.into_iter();
    let texts = std::iter::from_fn(|| {
        let mut chunk = rows.by_ref().take(AT_ONCE).peekable();
        chunk.peek().is_some().then(|| format.lines(chunk))
    });
    write_lines(out, format, (name, fields), columns, texts)
}

/// Writes a row for each of `items`, in their order. `make` makes the rows of some hundred items in
/// the threads of the current rayon pool. Memory holds the text of some thousand rows. The other
/// parameters are the same as in [`write_rows`].
pub(super) fn write_many<T: Send + Sync, R: Serialize>(
    out: &mut impl Write,
    format: RowFormat,
    (name, fields): (&str, &[(&str, serde_json::Value)]),
    columns: &R,
    mut items: impl Iterator<Item = T>,
    make: impl Fn(&[T]) -> Vec<R> + Sync,
) -> io::Result<()> {
    let texts = std::iter::from_fn(|| {
        let batch: Vec<T> = items.by_ref().take(AT_ONCE).collect();
        let lines = |chunk: &[T]| format.lines(make(chunk));
        (!batch.is_empty()).then(|| batch.par_chunks(CHUNK).map(lines).collect::<Vec<_>>())
    });
    write_lines(out, format, (name, fields), columns, texts.flatten())
}

fn write_lines<R: Serialize>(
    out: &mut impl Write,
    format: RowFormat,
    (name, fields): (&str, &[(&str, serde_json::Value)]),
    columns: &R,
    texts: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    match format {
        RowFormat::Csv => {
            let mut header = csv::Writer::from_writer(Vec::new());
            header.serialize(columns).map_err(io_error)?;
            let header = header.into_inner().map_err(csv::IntoInnerError::into_error)?;
            out.write_all(
                header.split_inclusive(|byte| *byte == b'\n').next().unwrap_or_default(),
            )?;
            texts.into_iter().try_for_each(|text| out.write_all(&text?))
        }
        RowFormat::Json => {
            write!(out, "{{\"format_version\":{FORMAT_VERSION}")?;
            for (field, value) in fields {
                write!(out, ",\"{field}\":{value}")?;
            }
            write!(out, ",\"{name}\":[")?;
            let mut is_first = true;
            for text in texts {
                let text = text?;
                // No comma precedes the first row.
                let skipped = usize::from(is_first && !text.is_empty());
                is_first &= text.is_empty();
                out.write_all(text.get(skipped..).unwrap_or_default())?;
            }
            writeln!(out, "\n]}}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Row {
        number: usize,
        name: Cow<'static, str>,
        time: Time,
        none: Option<f64>,
    }

    fn row(format: RowFormat, number: usize) -> Row {
        let time = Time("2026-08-12T01:02:03.4567Z".parse().unwrap());
        Row { number, name: format.text("=1, \"two\""), time, none: None }
    }

    fn written(format: RowFormat, count: usize, threads: usize) -> String {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut out = Vec::new();
        let make = |numbers: &[usize]| numbers.iter().map(|number| row(format, *number)).collect();
        let fields = [("site", serde_json::json!("Porto"))];
        pool.in_place_scope(|_| {
            write_many(&mut out, format, ("rows", &fields), &row(format, 0), 0..count, make)
        })
        .unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_row_of_csv_quotes_what_it_must_and_is_no_formula() {
        let text = written(RowFormat::Csv, 1, 1);
        assert_eq!(
            text,
            "number,name,time,none\n0,\"'=1, \"\"two\"\"\",2026-08-12T01:02:03.457Z,\n"
        );
        assert_eq!(written(RowFormat::Csv, 0, 1), "number,name,time,none\n");
        for name in ["+1", "-1", "@SUM(A1)", "\t1", "\r1"] {
            assert_eq!(RowFormat::Csv.text(name), format!("'{name}"));
            assert_eq!(RowFormat::Json.text(name), name);
        }
        for name in ["ISS (ZARYA)", "NOAA-20", ""] {
            assert_eq!(RowFormat::Csv.text(name), name);
        }
    }

    #[test]
    fn json_has_a_version_and_a_row_a_line() {
        let text = written(RowFormat::Json, 2, 1);
        let whole: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(whole["format_version"], 1);
        assert_eq!(whole["site"], "Porto");
        let second = serde_json::json!({
            "number": 1, "name": "=1, \"two\"", "time": "2026-08-12T01:02:03.457Z", "none": null
        });
        assert_eq!(whole["rows"][1], second);
        assert_eq!(text.lines().count(), 4);
        let none: serde_json::Value =
            serde_json::from_str(&written(RowFormat::Json, 0, 1)).unwrap();
        assert_eq!(none["rows"], serde_json::json!([]));
    }

    #[test]
    fn rows_are_written_while_they_are_made() {
        struct Short(usize);
        impl io::Write for Short {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::BrokenPipe)?;
                Ok(bytes.len())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        for format in [RowFormat::Csv, RowFormat::Json] {
            let endless = (0..).map(|number| row(format, number));
            let columns = row(format, 0);
            let error = write_rows(&mut Short(10_000), format, ("rows", &[]), &columns, endless);
            assert_eq!(error.unwrap_err().kind(), io::ErrorKind::BrokenPipe);
        }
    }

    #[test]
    fn rows_are_in_order_whatever_thread_made_them() {
        let count = 2 * AT_ONCE + 7;
        for format in [RowFormat::Csv, RowFormat::Json] {
            let one = written(format, count, 1);
            assert_eq!(written(format, count, 3), one);
            assert!(one.contains(&format!("{}", count - 1)));
        }
        let text = written(RowFormat::Csv, count, 1);
        let numbers = text.lines().skip(1).map(|line| line.split(',').next().unwrap());
        assert!(numbers.eq((0..count).map(|number| number.to_string())));
    }
}
