//! Property tests of the readers: no bytes crash a reader, and a bad object does not hide the
//! others.

use azel::{
    astro::Site,
    orbit::{Elements, PassSearch, Propagator, passes, read_element_bytes, read_elements},
};
use proptest::prelude::*;

const LINES: [&str; 3] = [
    "GOOD",
    "1 25544U 98067A   26223.50000000  .00000000  00000-0  10000-3 0  9994",
    "2 25544  51.6000 225.4000 0001771  44.9000   5.1000 15.50000000    18",
];
const FIELDS: [(&str, &str); 12] = [
    ("OBJECT_NAME", "GOOD"),
    ("OBJECT_ID", "1998-067A"),
    ("EPOCH", "2026-08-11T12:00:00"),
    ("MEAN_MOTION", "15.5"),
    ("ECCENTRICITY", "0.0001771"),
    ("INCLINATION", "51.6"),
    ("RA_OF_ASC_NODE", "225.4"),
    ("ARG_OF_PERICENTER", "44.9"),
    ("MEAN_ANOMALY", "5.1"),
    ("NORAD_CAT_ID", "25544"),
    ("BSTAR", "0.0001"),
    ("REV_AT_EPOCH", "1"),
];

/// File format of elements: text before the objects, one object, text between two objects, text
/// after the last.
#[derive(Debug, Clone)]
struct Form {
    before: String,
    object: String,
    between: &'static str,
    after: &'static str,
}

impl Form {
    fn around(&self, objects: &[&[u8]]) -> Vec<u8> {
        let objects = objects.join(self.between.as_bytes());
        [self.before.as_bytes(), &objects, self.after.as_bytes()].concat()
    }
}

fn fields(start: &str, middle: &str, end: &str) -> String {
    FIELDS.map(|(key, value)| format!("{start}{key}{middle}{value}{end}")).concat()
}

fn forms() -> [Form; 5] {
    let form = |before: &str, object: String, between, after| Form {
        before: before.to_owned(),
        object,
        between,
        after,
    };
    let xml = FIELDS.map(|(key, value)| format!("<{key}>{value}</{key}>\n")).concat();
    let json = fields("\"", "\":\"", "\",");
    let header = FIELDS.map(|(key, _)| key).join(",");
    [
        form("# list\n", LINES.join("\n"), "\n", "\n"),
        form("[", format!("{{{}}}", json.trim_end_matches(',')), ",", "]"),
        form("<ndm>", format!("<omm version=\"2.0\"><body>{xml}</body></omm>"), "\n", "</ndm>"),
        form("", format!("CCSDS_OMM_VERS = 2.0\n{}", fields("", " = ", "\n")), "\n", "\n"),
        form(&format!("{header}\n"), FIELDS.map(|(_, value)| value).join(","), "\n", "\n"),
    ]
}

/// Edit of a text at one place.
#[derive(Debug, Clone)]
enum Change {
    Insert(Vec<u8>),
    Replace(u8),
    Remove(usize),
    Repeat(usize),
}

fn changes() -> impl Strategy<Value = Vec<(prop::sample::Index, Change)>> {
    // Draw the characters of the formats more often than other bytes.
    let telling = prop::sample::select(b"{}[]\",:\\<>/&;!=-+.\n\r\t 0129eE#ACZ\0\xff\xc3".to_vec());
    let byte = prop_oneof![3 => telling, 1 => any::<u8>()].boxed();
    let change = prop_oneof![
        prop::collection::vec(byte.clone(), 1..6).prop_map(Change::Insert),
        byte.prop_map(Change::Replace),
        (1..40_usize).prop_map(Change::Remove),
        (1..200_usize).prop_map(Change::Repeat),
    ];
    prop::collection::vec((any::<prop::sample::Index>(), change), 1..6)
}

fn changed(text: &[u8], changes: &[(prop::sample::Index, Change)]) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for (place, change) in changes.iter().filter(|_| !text.is_empty()) {
        if bytes.is_empty() {
            break;
        }
        let at = place.index(bytes.len());
        match change {
            Change::Insert(more) => drop(bytes.splice(at..at, more.iter().copied())),
            Change::Replace(byte) => bytes[at] = *byte,
            Change::Remove(count) => drop(bytes.drain(at..bytes.len().min(at + count))),
            Change::Repeat(count) => {
                let again = bytes[at..bytes.len().min(at + count)].to_vec();
                drop(bytes.splice(at..at, again));
            }
        }
    }
    bytes
}

#[test]
fn every_form_is_read_as_it_stands() {
    let first = read_elements(&forms()[0].object).elements;
    for form in forms() {
        let object = form.object.as_bytes();
        let report = read_element_bytes(&form.around(&[object, object]));
        assert_eq!(report.refused, [], "{form:?}");
        assert_eq!(report.elements.len(), 2, "{form:?}");
        let epoch_and_place = |set: &Elements| (set.epoch(), set.inclination().degrees());
        assert_eq!(epoch_and_place(&report.elements[1]), epoch_and_place(&first[0]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn any_bytes_are_harmless(bytes in any::<Vec<u8>>()) {
        read_element_bytes(&bytes);
    }

    #[test]
    fn any_change_of_any_form_is_harmless(form in 0..5_usize, changes in changes()) {
        let form = &forms()[form];
        let object = form.object.as_bytes();
        let bytes = changed(&form.around(&[object; 3]), &changes);
        let report = read_element_bytes(&bytes);
        prop_assert!(report.elements.len() + report.refused.len() <= bytes.len());
        let lines = bytes.split(|byte| *byte == b'\n').count();
        prop_assert!(report.refused.iter().all(|refused| (1..=lines).contains(&refused.line)));
    }

    #[test]
    fn a_bad_object_costs_no_other(form in 0..5_usize, changes in changes()) {
        let form = &forms()[form];
        let good = form.object.as_bytes();
        let bytes = form.around(&[good, &changed(good, &changes), good]);
        let expected = read_element_bytes(&form.around(&[good])).elements.remove(0);
        let report = read_element_bytes(&bytes);
        prop_assert!(report.elements.len() >= 2, "{}", String::from_utf8_lossy(&bytes));
        // A change may repeat both lines of a TLE. If half of the sets have no name, the reader
        // takes the names for headings.
        let unnamed = report.elements.iter().filter(|elements| elements.name().is_empty()).count();
        let has_headings = unnamed * 2 >= report.elements.len();
        let nameless = read_elements(&LINES[1..].join("\n")).elements.remove(0);
        for good in [&report.elements[0], report.elements.last().unwrap()] {
            prop_assert!(*good == expected || (has_headings && *good == nameless), "{good:?}");
        }
    }
}

/// Draws a number in the range, or sometimes an extreme or arbitrary number.
fn number(usual: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    let odd = [0.0, -0.0, 1e-300, 1e12, 1e17, 1e21, -1e21, 1e300, 359.999_999, 360.0, 180.0];
    prop_oneof![8 => usual, 1 => prop::sample::select(odd.to_vec()), 1 => any::<f64>()]
}

proptest! {
    /// Passes come once or twice a revolution, and a revolution takes over an hour.
    #[test]
    fn what_a_reader_takes_has_a_day_of_passes(
        motion in number(0.1..17.0),
        eccentricity in number(0.0..1.0),
        inclination in number(0.0..180.0),
        angles in prop::array::uniform3(number(-360.0..360.0)),
        bstar in number(-10.0..10.0),
        days in -20_000..11_000_i64,
        latitude in -90.0..=90.0,
    ) {
        let epoch = start() + jiff::SignedDuration::from_hours(24 * days);
        let values = [
            "ANY", "1998-067A", &epoch.strftime("%FT%T").to_string(), &motion.to_string(),
            &eccentricity.to_string(), &inclination.to_string(), &angles[0].to_string(),
            &angles[1].to_string(), &angles[2].to_string(), "5", &bstar.to_string(), "1",
        ];
        let header = FIELDS.map(|(key, _)| key).join(",");
        let site = Site::new(latitude, 29.0, 100.0).unwrap();
        for elements in read_elements(&format!("{header}\n{}\n", values.join(","))).elements {
            let propagator = Propagator::new(&elements).unwrap();
            for from in [start(), elements.epoch()] {
                let to = from + jiff::SignedDuration::from_hours(24);
                let found = passes(&propagator, &PassSearch::new(site, from, to), &|| false);
                prop_assert!(found.len() < 40, "{} passes", found.len());
            }
        }
    }
}

fn start() -> jiff::Timestamp {
    "2026-08-12T00:00:00Z".parse().unwrap()
}
