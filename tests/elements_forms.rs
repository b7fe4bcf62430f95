//! Round trips of elements through every file format.

use std::io::Read as _;

use azel::orbit::{
    Elements, TleRefusalReason, read_elements, tle_lines, write_omm_csv, write_omm_json, write_tle,
};
use proptest::prelude::*;

const BUNDLED: &[u8] = include_bytes!("../assets/elements/active_2026-08-11.tle.gz");

fn bundled_text() -> String {
    let mut text = String::new();
    flate2::read::GzDecoder::new(BUNDLED).read_to_string(&mut text).unwrap();
    text
}

fn omm_json(elements: &[Elements]) -> String {
    let mut out = Vec::new();
    write_omm_json(elements, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn omm_csv(elements: &[Elements]) -> String {
    let mut out = Vec::new();
    write_omm_csv(elements, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn tle(elements: &[Elements]) -> String {
    let mut out = Vec::new();
    assert_eq!(write_tle(elements, &mut out).unwrap(), []);
    String::from_utf8(out).unwrap()
}

#[test]
fn the_whole_catalog_is_written_byte_for_byte_as_it_was_read() {
    let text = bundled_text();
    let report = read_elements(&text);
    assert_eq!((report.elements.len(), report.refused.len()), (16_089, 0));
    let written = tle(&report.elements);
    let differences: Vec<(&str, &str)> = text
        .lines()
        .zip(written.lines())
        .map(|(read, written)| (read.trim_end(), written))
        .filter(|(read, written)| read != written)
        .collect();
    println!("{} lines differ: {:#?}", differences.len(), differences.first());
    assert_eq!(text.lines().count(), written.lines().count());
    assert_eq!(differences, []);
}

#[test]
fn every_form_of_the_whole_catalog_is_the_same_set() {
    let elements = read_elements(&bundled_text()).elements;
    for text in [omm_json(&elements), omm_csv(&elements), tle(&elements)] {
        let report = read_elements(&text);
        assert_eq!(report.refused, []);
        assert!(report.elements == elements, "{}", &text[..300]);
    }
}

#[test]
fn nothing_is_written_for_nothing() {
    assert_eq!(omm_json(&[]), "[]\n");
    assert_eq!((omm_csv(&[]), tle(&[])), (String::new(), String::new()));
    assert_eq!(read_elements("[]").elements, []);
}

#[test]
fn a_number_that_no_tle_carries_is_handed_back() {
    let one = omm_json(&read_elements(&bundled_text()).elements[..1]);
    let changed = |number: &str| {
        let at = one.find("\"NORAD_CAT_ID\":900").unwrap();
        let text = format!("{}\"NORAD_CAT_ID\":{number}{}", &one[..at], &one[at + 18..]);
        read_elements(&text).elements.remove(0)
    };
    let last = changed("339999");
    assert!(tle_lines(&last).unwrap()[1].starts_with("2 Z9999 "));
    let only = std::slice::from_ref(&last);
    assert_eq!(read_elements(&tle(only)).elements, only);
    let beyond = [changed("340000"), last, changed("999999999")];
    let mut out = Vec::new();
    let refused = write_tle(&beyond, &mut out).unwrap();
    assert_eq!(read_elements(str::from_utf8(&out).unwrap()).elements.len(), 1);
    let numbers: Vec<_> = refused.iter().map(|refused| refused.catalog_number).collect();
    assert_eq!(numbers, [340_000, 999_999_999]);
    assert_eq!(refused[0].reason, TleRefusalReason::CatalogNumber);
}

/// Draws an OMM with any values that a set can have.
fn any_set() -> impl Strategy<Value = String> {
    let angles = [-720.0..720.0_f64, -720.0..720.0, -720.0..720.0];
    let drag = (-1.0..1.0_f64, 1e-12..1.0_f64, 0.0..1e-6_f64);
    let counts = (0..=339_999_u32, any::<u32>(), any::<u32>(), 1957..=2056_i16, 1..=365_i64);
    let orbit = (0.5..16.5_f64, 0.0..0.02_f64, 0.0..180.0_f64, angles, drag);
    (orbit, counts, 0..86_400_000_000_i64, "\\PC{0,30}").prop_map(|(orbit, counts, us, name)| {
        let (motion, eccentricity, inclination, [node, perigee, anomaly], (dot, bstar, ddot)) =
            orbit;
        let (number, set, revolution, year, day) = counts;
        let epoch = jiff::civil::date(year, 1, 1).at(0, 0, 0, 0);
        let since = jiff::SignedDuration::from_hours(24 * (day - 1));
        let epoch = epoch + since + jiff::SignedDuration::from_micros(us);
        serde_json::json!({
            "OBJECT_NAME": name, "OBJECT_ID": format!("{year}-001A"), "NORAD_CAT_ID": number,
            "EPOCH": epoch.to_string(), "MEAN_MOTION": motion, "ECCENTRICITY": eccentricity,
            "INCLINATION": inclination, "RA_OF_ASC_NODE": node, "ARG_OF_PERICENTER": perigee,
            "MEAN_ANOMALY": anomaly, "BSTAR": bstar, "MEAN_MOTION_DOT": dot,
            "MEAN_MOTION_DDOT": ddot, "ELEMENT_SET_NO": set, "REV_AT_EPOCH": revolution,
            "CLASSIFICATION_TYPE": "C"
        })
        .to_string()
    })
}

proptest! {
    #[test]
    fn the_omm_forms_keep_every_bit(set in any_set()) {
        let elements = read_elements(&set).elements;
        prop_assert_eq!(&read_elements(&omm_json(&elements)).elements, &elements);
        prop_assert_eq!(&read_elements(&omm_csv(&elements)).elements, &elements);
    }

    #[test]
    fn a_tle_keeps_any_name_of_24_ascii_letters(name in "[ -~]{0,24}") {
        let set = serde_json::json!({
            "OBJECT_NAME": name, "OBJECT_ID": "1998-067A", "NORAD_CAT_ID": 25_544,
            "EPOCH": "2026-11-27T00:00:00", "MEAN_MOTION": 15.5, "ECCENTRICITY": 0.001,
            "INCLINATION": 51.6, "RA_OF_ASC_NODE": 10, "ARG_OF_PERICENTER": 20,
            "MEAN_ANOMALY": 30, "BSTAR": 1e-4, "MEAN_MOTION_DOT": 1e-5, "MEAN_MOTION_DDOT": 0,
            "ELEMENT_SET_NO": 999, "REV_AT_EPOCH": 1, "CLASSIFICATION_TYPE": "U"
        });
        let elements = read_elements(&set.to_string()).elements;
        let read = read_elements(&tle(&elements)).elements;
        prop_assert_eq!(read[0].name(), elements[0].name());
    }

    #[test]
    fn a_tle_keeps_what_its_columns_hold(set in any_set()) {
        for elements in read_elements(&set).elements {
            let text = tle(std::slice::from_ref(&elements));
            let report = read_elements(&text);
            prop_assert_eq!(&report.refused, &vec![], "{}", text);
            let read = &report.elements[0];
            prop_assert_eq!(read.catalog_number(), elements.catalog_number());
            let off_us = read.epoch().as_microsecond() - elements.epoch().as_microsecond();
            prop_assert!(off_us.abs() <= 432, "{off_us}");
            let off = (read.mean_motion_rev_day() - elements.mean_motion_rev_day()).abs();
            prop_assert!(off <= 0.51e-8, "{off}");
            prop_assert!((read.eccentricity() - elements.eccentricity()).abs() <= 0.51e-7);
            let off_deg = (read.inclination() - elements.inclination()).degrees().abs();
            prop_assert!(off_deg <= 0.51e-4);
            // After one trip through a TLE, values no longer change.
            prop_assert_eq!(tle(&report.elements), text);
        }
    }
}
