//! Tests of a copy of settings, and of its use on a unit.

use super::GROUPS;
use crate::device::settings::{
    CopyError, CopyHead, GroupState, GroupStates, HeldGroup, ReadFailure, Secret, SettingsCopy,
    Value, Values, Verdict,
};

fn head() -> CopyHead {
    CopyHead {
        antenna: "Dish \"2\"".to_owned(),
        address: "192.168.10.21:4001".to_owned(),
        controller: "satrak".to_owned(),
        saved_at: "2026-08-12T11:15:30Z".parse().unwrap(),
    }
}

fn state<const N: usize>(values: [(&'static str, Value); N]) -> GroupState {
    let read_at = head().saved_at;
    let group = Some(HeldGroup { values: Values::from(values), read_at });
    GroupState { last_read: group, ..GroupState::default() }
}

fn unit_settings() -> GroupStates {
    let text = |text: &str| Value::Text(text.to_owned());
    let failed = GroupState {
        failure: Some(ReadFailure::Refused("ERR,1".to_owned())),
        ..GroupState::default()
    };
    GroupStates::from([
        (
            "general",
            state([
                ("clock_from_gps", Value::Flag(true)),
                ("lead_ms", Value::Integer(90_000)),
                ("azimuth_offset_deg", Value::Decimal(-0.15)),
                ("sspa", Value::Choice(0)),
                ("sspa_rule", Value::Choice(9)),
                ("tle_source", Value::Choice(1)),
            ]),
        ),
        ("gps", state([("latitude_deg", Value::Decimal(-33.86))])),
        ("window", state([("start", Value::Time(head().saved_at))])),
        (
            "ftp",
            state([
                ("password", Value::Secret(Secret::new("hunter2"))),
                ("user", text("a \"b\" # c")),
            ]),
        ),
        ("reduction", state([("x", Value::Decimal(4000.0))])),
        ("web", failed),
    ])
}

#[test]
fn a_copy_of_a_unit_differs_from_it_in_nothing() {
    let written = SettingsCopy::text(&head(), GROUPS, &unit_settings());
    assert!(!written.contains("hunter2"), "{written}");
    assert!(written.contains("# web: not read, the unit answered ERR,1"), "{written}");
    let copy = SettingsCopy::read(&written, "satrak", GROUPS).unwrap();
    assert_eq!(copy.head, head());
    assert_eq!(copy.unknown, Vec::<String>::new());
    let names: Vec<_> = copy.values.iter().map(|value| value.field).collect();
    assert!(!names.contains(&"tle_source") && !names.contains(&"password"), "{names:?}");
    assert_eq!(copy.differences(GROUPS, &unit_settings()).len(), 0);
}

#[test]
fn what_differs_is_told_and_service_is_only_shown() {
    let text = "version = 1\ncontroller = \"satrak\"\nantenna = \"A\"\naddress = \"b\"\n\
        saved_at = \"2026-08-12T11:15:30Z\"\n[general]\nlead_ms = 60000\nsspa = \"On\"\n\
        azimuth_offset_deg = 99\nminimum = 1\n[gps]\nlatitude_deg = 41.02\n\
        [reduction]\nx = 4100\n[web]\nurl = \"https://x\"\n[other]\nz = 1\n";
    let copy = SettingsCopy::read(text, "satrak", GROUPS).unwrap();
    assert_eq!(copy.unknown, ["general.minimum", "other.z"]);
    let found: Vec<_> = copy
        .differences(GROUPS, &unit_settings())
        .into_iter()
        .map(|one| (one.field.key, one.verdict))
        .collect();
    let expected = [
        ("azimuth_offset_deg", Verdict::Unfit),
        ("lead_ms", Verdict::Free),
        ("sspa", Verdict::Service),
        ("latitude_deg", Verdict::Free),
        ("url", Verdict::NotRead),
        ("x", Verdict::Service),
    ];
    let as_sets = |mut list: Vec<_>| {
        list.sort_by_key(|(key, _)| *key);
        list
    };
    assert_eq!(as_sets(found), as_sets(expected.to_vec()));
}

#[test]
fn another_file_is_refused_with_the_reason() {
    let read = |text: &str| SettingsCopy::read(text, "satrak", GROUPS).unwrap_err();
    assert!(matches!(read("[["), CopyError::Syntax(_)));
    assert_eq!(read("a = 1"), CopyError::NoCopy("version"));
    assert_eq!(read("version = 2"), CopyError::Newer(2));
    assert_eq!(read("version = 1\nantenna = 3"), CopyError::NoCopy("antenna"));
    let other = SettingsCopy::text(
        &CopyHead { controller: "genius".to_owned(), ..head() },
        GROUPS,
        &unit_settings(),
    );
    assert!(matches!(read(&other), CopyError::OtherController { .. }));
}
