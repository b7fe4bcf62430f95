//! OMM as rows of separated values under a header with the field names. With decimal commas,
//! spreadsheets write semicolons or tabs in place of commas.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use super::{Field, MessageFields, Value};
use crate::reader::{ReadReport, RefusalReason};

/// Max number of fields that are read from a row; real rows have some forty. A line without an end
/// must not take many times its length in memory.
const MAX_FIELDS: usize = 1000;
/// Min number of field names in a header. The name of an object holds fewer, and a row has fewer
/// text fields.
const MIN_NAMES: usize = 4;

/// Characters that separate the fields, in the order of trial.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// Returns `true` if `line` is a header with names of OMM fields.
pub(in crate::reader) fn is_header(line: &str) -> bool {
    header(line).is_some()
}

/// Returns the fields of a header; `None` for another line.
fn header(line: &str) -> Option<Row> {
    SEPARATORS.into_iter().find_map(|separator| {
        let mut row = Row::new(separator);
        row.split(line);
        row.is_header().then_some(row)
    })
}

/// Reads all rows of `text`. A header may occur again, because files may be concatenated.
///
/// Each line is read separately, because no field of an OMM spans lines. A stray quotation mark
/// costs one row and not the rest of the text.
pub(in crate::reader) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    let mut row = Row::new(b',');
    let mut header: Vec<Option<Field>> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let (place, line) = (index + 1, line.trim());
        row.split(line);
        // A name may start with the sign of a remark.
        if line.is_empty() || (line.starts_with('#') && row.len() != header.len()) {
            continue;
        }
        // A header with other separators appears as one field or several fields.
        let is_other = row.len() != header.len();
        if let Some(new) = is_other.then(|| self::header(line)).flatten() {
            row = new;
        }
        if row.is_header() {
            header = row.fields().map(|name| Field::named(name.trim())).collect();
            continue;
        }
        // This is text before the table.
        if header.is_empty() {
            continue;
        }
        let mut message = MessageFields::default();
        for (field, text) in header.iter().zip(row.fields()) {
            if let Some(field) = *field {
                let has_comma = row.separator != b',' && field.is_number() && text.contains(',');
                let text = if has_comma { text.replace(',', ".").into() } else { text.into() };
                message.set(field, Value::Text(text));
            }
        }
        if row.len() == header.len() {
            message.finish(place, &mut report);
        } else {
            let reason = RefusalReason::FieldCount { found: row.len(), expected: header.len() };
            report.refuse(place, message.object().as_deref(), reason);
        }
    }
    report
}

/// Fields of one row, without their quotation marks.
struct Row {
    reader: Reader,
    separator: u8,
    text: Vec<u8>,
    /// End of each field in `text`.
    ends: Vec<usize>,
    len: usize,
}

impl Row {
    fn new(separator: u8) -> Self {
        // `Reader::default()` has no tables and reads nothing.
        let reader = ReaderBuilder::new().delimiter(separator).build();
        Self { reader, separator, text: Vec::new(), ends: vec![0; MAX_FIELDS], len: 0 }
    }

    fn split(&mut self, line: &str) {
        // Removing quotation marks makes no field longer. One extra byte shows that the buffer was
        // not full.
        self.text.resize(line.len() + 1, 0);
        self.reader.reset();
        let (mut read, mut written) = (0, 0);
        self.len = 0;
        loop {
            let (result, input, output, ends) = self.reader.read_record(
                line.as_bytes().get(read..).unwrap_or_default(),
                self.text.get_mut(written..).unwrap_or_default(),
                self.ends.get_mut(self.len..).unwrap_or_default(),
            );
            read += input;
            written += output;
            self.len += ends;
            if result != ReadRecordResult::InputEmpty {
                return;
            }
        }
    }

    fn len(&self) -> usize {
        self.len
    }

    fn is_header(&self) -> bool {
        let mut names = self.fields().map(str::trim);
        names.any(|name| name.eq_ignore_ascii_case("NORAD_CAT_ID"))
            && self.fields().filter_map(|name| Field::named(name.trim())).count() >= MIN_NAMES
    }

    fn fields(&self) -> impl Iterator<Item = &str> {
        let mut start = 0;
        self.ends.iter().take(self.len).map(move |&end| {
            let field = self.text.get(start..end).unwrap_or_default();
            start = end;
            str::from_utf8(field).unwrap_or_default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elements, reader::Refusal};

    const HEADER: &str = "OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,\
        RA_OF_ASC_NODE,ARG_OF_PERICENTER,MEAN_ANOMALY,EPHEMERIS_TYPE,CLASSIFICATION_TYPE,\
        NORAD_CAT_ID,ELEMENT_SET_NO,REV_AT_EPOCH,BSTAR,MEAN_MOTION_DOT,MEAN_MOTION_DDOT";
    const ROW: &str = "ISS (ZARYA),1998-067A,2026-08-11T01:21:00.123456,15.49560532,.0001771,\
        51.6435,225.4004,44.9625,5.1087,0,U,25544,999,23587,.49645E-3,.289036E-3,0";

    fn numbers(report: &ReadReport) -> Vec<u32> {
        report.elements.iter().map(Elements::catalog_number).collect()
    }

    #[test]
    fn both_dialects_give_the_same_orbit() {
        let plain = read(&format!("{HEADER}\r\n{ROW}\r\n"));
        assert_eq!(plain.refused, []);
        assert_eq!(plain.elements[0].name(), "ISS (ZARYA)");
        let quoted = |line: &str| format!("\"{}\"", line.replace(',', "\",\""));
        let text = format!(
            "{},\"DECAY_DATE\"\n{},\"\"\n",
            quoted(&HEADER.to_lowercase()),
            quoted(&ROW.replace("0,U,", ",,"))
        );
        assert_eq!(read(&text).elements, plain.elements);
    }

    #[test]
    fn spreadsheets_with_decimal_commas_are_read() {
        let plain = read(&format!("{HEADER}\n{ROW}\n"));
        let comma = ROW.replace(',', ";").replace('.', ",").replace("00,123456", "00.123456");
        for (separator, first) in [(";", ""), ("\t", ""), (";", "sep=;\n")] {
            let [header, row] =
                [&HEADER.replace(',', ";"), &comma].map(|line| line.replace(';', separator));
            let text = format!("{first}{header}\n{row}\n{HEADER}\n{ROW}\n{header}\n{row}\n");
            let report = read(&text);
            assert_eq!(report.refused, [], "{text}");
            let expected = vec![plain.elements[0].clone(); 3];
            assert_eq!(report.elements, expected, "{text}");
        }
    }

    #[test]
    fn a_date_of_a_spreadsheet_is_refused_with_what_to_do() {
        let refused = |date: &str| {
            let row = ROW.replace("2026-08-11T01:21:00.123456", date);
            let report = read(&format!("{HEADER}\n{row}\n"));
            assert_eq!((report.elements.len(), report.refused.len()), (0, 1), "{date}");
            report.refused[0].reason.clone()
        };
        for date in ["27/11/2026 06:00", "11/27/26", "27.11.2026 06:00:00", "27-11-2026 06:00"] {
            assert_eq!(refused(date), RefusalReason::DateOrder, "{date}");
        }
        for date in ["06:00", "27/11", "1.2.3.4", "a/b/2026", "2026/11/27 06:00", "46353.25"] {
            assert_eq!(refused(date), RefusalReason::Field("EPOCH"), "{date}");
        }
        let words = RefusalReason::DateOrder.to_string();
        for part in ["day and month", "spreadsheet", "2026-11-27T06:00:00"] {
            assert!(words.contains(part), "{words}");
        }
    }

    #[test]
    fn a_bad_row_costs_no_other() {
        let open = ROW.replace("ISS", "\"ISS");
        let torn = &ROW[..ROW.len() - 20];
        let last = ROW.replace("25544", "100000000").replace("ISS (ZARYA)", "\"A, \"\"B\"\"\"");
        let text = format!("{HEADER}\n{open}\n{ROW}\n# remark\n\n{torn}\njunk\n{last}\n");
        let report = read(&text);
        assert_eq!(numbers(&report), [25_544, 100_000_000]);
        assert_eq!(report.elements[1].name(), "A, \"B\"");
        let refusal = |line, object: Option<&str>, found| Refusal {
            line,
            object: object.map(str::to_owned),
            reason: RefusalReason::FieldCount { found, expected: 17 },
        };
        assert_eq!(
            report.refused[1..],
            [refusal(6, Some("ISS (ZARYA)"), 15), refusal(7, Some("junk"), 1)]
        );
        assert_eq!((report.refused.len(), report.refused[0].line), (3, 2));
    }

    #[test]
    fn a_second_header_may_have_another_order() {
        let text = format!(
            "{HEADER}\n{ROW}\nEPOCH,{},NORAD_CAT_ID\n2026-08-12T00:00:00,15,0,0,0,0,0,0,7\n",
            "MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,ARG_OF_PERICENTER,MEAN_ANOMALY,BSTAR"
        );
        assert_eq!(numbers(&read(&text)), [25_544, 7]);
    }

    #[test]
    fn a_row_without_an_end_is_refused_and_costs_no_other() {
        let report = read(&format!("{HEADER}\n{}\n{ROW}\n", ",".repeat(100_000)));
        assert_eq!(numbers(&report), [25_544]);
        let reason = RefusalReason::FieldCount { found: MAX_FIELDS, expected: 17 };
        assert_eq!(report.refused[0].reason, reason);
    }

    #[test]
    fn a_name_that_reads_like_a_header_is_a_name() {
        for name in ["NORAD_CAT_ID", "\"NORAD_CAT_ID,EPOCH,MEAN_MOTION,BSTAR\""] {
            let text = format!("{HEADER}\n{}\n{ROW}\n", ROW.replace("ISS (ZARYA)", name));
            let report = read(&text);
            assert_eq!(numbers(&report), [25_544, 25_544]);
            assert_eq!(report.elements[0].name(), name.trim_matches('"'));
        }
    }
}
