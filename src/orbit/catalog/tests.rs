use super::*;
use crate::read_elements;

/// Returns an OMM list of objects given as number, name and day of August 2026.
fn report(objects: &[(u32, &str, u32)]) -> ReadReport {
    let messages: Vec<_> = objects
        .iter()
        .map(|(number, name, day)| {
            serde_json::json!({
                "OBJECT_NAME": name, "NORAD_CAT_ID": number,
                "EPOCH": format!("2026-08-{day:02}T00:00:00"), "MEAN_MOTION": 15.0,
                "ECCENTRICITY": 0.001, "INCLINATION": 51.6, "RA_OF_ASC_NODE": 0,
                "ARG_OF_PERICENTER": 0, "MEAN_ANOMALY": 0, "BSTAR": 0
            })
        })
        .collect();
    read_elements(&serde_json::json!(messages).to_string())
}

#[test]
fn a_catalog_that_is_read_again_takes_no_second_copy_of_the_same_sets() {
    let objects = [(5, "FIVE", 1), (6, "SIX", 1)];
    let mut before = Catalog::default();
    before.merge(report(&objects), "bundled");
    let before = Arc::new(before);
    let mut after = Catalog::default();
    after.share_with(&before);
    after.merge(report(&objects), "bundled");
    after.merge(report(&[(6, "SIX", 2)]), "web");
    let is_shared = |number| std::ptr::eq(before.get(number).unwrap(), after.get(number).unwrap());
    assert!(is_shared(5) && !is_shared(6));
    drop(before);
    assert_eq!(Arc::strong_count(&after.entries[0].elements), 1);
}

#[test]
fn a_shared_set_without_a_name_takes_one_for_itself_alone() {
    let mut before = Catalog::default();
    before.merge(report(&[(5, "", 2)]), "bundled");
    let before = Arc::new(before);
    let mut after = Catalog::default();
    after.share_with(&before);
    after.merge(report(&[(5, "FIVE", 1)]), "web");
    after.merge(report(&[(5, "", 2)]), "bundled");
    let names = [&*before, &after].map(|catalog| catalog.get(5).unwrap().name());
    assert_eq!(names, ["", "FIVE"]);
}

#[test]
fn an_older_set_in_use_keeps_the_newest_one_at_hand() {
    let mut catalog = Catalog::default();
    catalog.merge(report(&[(5, "FIVE", 1)]), "own");
    let older = catalog.get(5).unwrap().clone();
    catalog.merge(report(&[(5, "FIVE", 3), (6, "SIX", 3)]), "weather");
    let newest = catalog.get(5).unwrap().clone();
    catalog.use_in_place(older.clone(), "own");
    assert_eq!((catalog.get(5), catalog.set_aside(5)), (Some(&older), Some(&newest)));
    assert_eq!((catalog.source_of(5), catalog.source_of(6)), (Some("own"), Some("weather")));
    assert_eq!(catalog.all_set_aside().collect::<Vec<_>>(), [(&newest, "weather")]);
    assert_eq!(catalog.in_use(), [("own", 0), ("weather", 2)], "the sum is the catalog");
    catalog.use_in_place(catalog.get(6).unwrap().clone(), "own");
    assert_eq!(catalog.set_aside(6), None, "it is the set in use");
}

/// Returns a catalog with these sources, each with the day of its set of object 5, and this order.
fn ordered(order: &[&str], sources: &[(&str, u32)]) -> Catalog {
    let mut catalog = Catalog::default();
    catalog.merge(report(&[(5, "FIVE", 1)]), "bundled");
    let order = order.iter().map(|name| (*name).to_owned()).collect();
    catalog.set_orders(SourceOrders::from([(5, order)]));
    for (name, day) in sources {
        catalog.merge(report(&[(5, "", *day), (6, "SIX", *day)]), name);
    }
    catalog
}

#[test]
fn the_first_source_of_the_order_is_used_until_it_lags_behind() {
    for (order, sources, expected) in [
        (&["own", "web"][..], &[("web", 12), ("own", 11)][..], ("own", 11)),
        (&["own", "web"], &[("web", 12), ("own", 9)], ("own", 9)),
        (&["own", "web"], &[("web", 12), ("own", 8)], ("web", 12)),
        (&["own", "web"], &[("web", 12), ("own", 12)], ("own", 12)),
        (&["own", "web"], &[("other", 12), ("web", 10), ("own", 8)], ("web", 10)),
        (&["own", "web"], &[("other", 20), ("web", 10), ("own", 8)], ("other", 20)),
        (&["own", "web"], &[("web", 12)], ("web", 12)),
        (&["gone"], &[("web", 12), ("own", 11)], ("web", 12)),
        (&["own"], &[("own", 9)], ("own", 9)),
        (&["own"], &[], ("bundled", 1)),
    ] {
        let mut catalog = ordered(order, sources);
        catalog.apply_orders(|_| false);
        let day = |elements: &Elements| elements.epoch().to_string()[8..10].parse().unwrap();
        let in_use = catalog.get(5).unwrap();
        assert_eq!((catalog.source_of(5).unwrap(), day(in_use)), expected, "{sources:?}");
        assert_eq!(in_use.name(), "FIVE");
        let newest = sources.iter().map(|(_, day)| *day).max().unwrap_or(1);
        let passed_over = catalog.passed_over(5).map(day);
        assert_eq!(passed_over, Some(newest).filter(|newest| *newest != expected.1));
        assert_eq!(catalog.all_set_aside().count(), usize::from(passed_over.is_some()));
        assert_eq!((catalog.set_aside(5), catalog.passed_over(6)), (None, None));
    }
}

#[test]
fn a_set_with_an_epoch_ahead_does_not_win_over_a_current_one() {
    let time = |text: &str| -> Timestamp { text.parse().unwrap() };
    let now = time("2026-08-12T12:00:00Z");
    for (days, expected) in [
        (&[12, 26][..], 12),
        (&[26, 12], 12),
        // Half a day ahead is normal, a day and a half is not.
        (&[12, 13], 13),
        (&[12, 14], 12),
        (&[1, 30], 1),
        (&[30, 26, 28], 26),
        (&[14], 14),
    ] {
        let own: Vec<_> = days.iter().map(|day| (5, "FIVE", *day)).collect();
        let mut combined = Catalog::default();
        combined.set_time(now);
        combined.merge(report(&own), "one");
        let mut apart = Catalog::default();
        apart.set_time(now);
        for set in own {
            apart.merge(report(&[set]), &set.2.to_string());
        }
        for catalog in [combined, apart] {
            let epoch = catalog.get(5).unwrap().epoch();
            assert_eq!(epoch, time(&format!("2026-08-{expected:02}T00:00:00Z")), "{days:?}");
            assert!(!catalog.is_outdated(now));
        }
    }
}

#[test]
fn a_preferred_source_with_an_epoch_ahead_is_not_used() {
    let mut catalog = Catalog::default();
    catalog.set_time("2026-08-12T12:00:00Z".parse().unwrap());
    catalog.set_orders(SourceOrders::from([(5, vec!["own".to_owned()])]));
    catalog.merge(report(&[(5, "FIVE", 12)]), "web");
    catalog.merge(report(&[(5, "FIVE", 20)]), "own");
    catalog.apply_orders(|_| false);
    assert_eq!(catalog.source_of(5), Some("web"));
}

#[test]
fn another_time_outdates_a_choice_between_sets() {
    let time = |text: &str| -> Timestamp { text.parse().unwrap() };
    let mut catalog = Catalog::default();
    catalog.set_time(time("2026-08-12T12:00:00Z"));
    catalog.merge(report(&[(5, "FIVE", 12), (5, "FIVE", 20), (6, "ALONE", 30)]), "own");
    for (now, expected) in [
        ("2026-08-12T12:00:00Z", false),
        ("2026-08-18T23:00:00Z", false),
        ("2026-08-19T00:00:01Z", true),
        ("2026-08-11T00:00:01Z", false),
        ("1970-01-01T00:00:00Z", true),
    ] {
        assert_eq!(catalog.is_outdated(time(now)), expected, "{now}");
    }
}

#[test]
fn a_set_that_the_operator_chose_comes_before_the_order() {
    let mut catalog = ordered(&["own"], &[("web", 12), ("own", 11)]);
    catalog.apply_orders(|number| number == 5);
    assert_eq!(catalog.source_of(5), Some("web"));
}

#[test]
fn the_newest_epoch_wins_whatever_the_order() {
    let mut catalog = Catalog::default();
    let first = catalog.merge(report(&[(5, "OLD", 10), (6, "B", 12)]), "first");
    assert_eq!((first.added, first.updated, first.unchanged), (2, 0, 0));
    let second = catalog.merge(report(&[(5, "NEW", 11), (6, "STALE", 11)]), "second");
    assert_eq!((second.added, second.updated, second.unchanged), (0, 1, 0));
    assert_eq!((second.older, second.refused.len()), (1, 0));
    assert_eq!(catalog.get(5).unwrap().name(), "NEW");
    assert_eq!(catalog.get(6).unwrap().name(), "B");
    assert_eq!(catalog.newest_epoch(), Some("2026-08-12T00:00:00Z".parse().unwrap()));
    assert_eq!(catalog.len(), 2);
}

#[test]
fn the_newest_set_of_one_text_wins() {
    let mut catalog = Catalog::default();
    let objects = [(7, "A", 2), (5, "B", 3), (7, "C", 4), (7, "D", 1), (5, "E", 3)];
    let summary = catalog.merge(report(&objects), "one");
    assert_eq!((summary.added, summary.updated, summary.unchanged), (2, 1, 1));
    assert_eq!((summary.older, summary.refused.len()), (1, 0));
    assert_eq!(catalog.iter().map(Elements::name).collect::<Vec<_>>(), ["B", "C"]);
}

#[test]
fn a_set_without_a_name_leaves_the_known_one() {
    let mut catalog = Catalog::default();
    catalog.merge(report(&[(5, "KNOWN", 1), (6, "", 1)]), "one");
    catalog.merge(report(&[(5, "", 2), (6, "LATE", 1)]), "two");
    assert_eq!(catalog.get(5).unwrap().name(), "KNOWN");
    assert_eq!(catalog.get(6).unwrap().name(), "LATE");
}

#[test]
fn an_object_is_in_every_group_that_holds_it() {
    let mut catalog = Catalog::default();
    catalog.merge(report(&[(5, "A", 2), (6, "B", 2), (9, "AB", 2)]), "weather");
    catalog.merge(report(&[(6, "B", 1), (7, "C", 1), (6, "B", 1)]), "noaa");
    assert_eq!(catalog.groups().collect::<Vec<_>>(), [("weather", 3), ("noaa", 2)]);
    assert_eq!(catalog.groups_of(6).collect::<Vec<_>>(), ["weather", "noaa"]);
    assert_eq!(catalog.groups_of(8).count(), 0);
    let numbers = |found: Vec<&Elements>| -> Vec<u32> {
        found.into_iter().map(Elements::catalog_number).collect()
    };
    assert_eq!(numbers(catalog.in_group("noaa").collect()), [6, 7]);
    assert_eq!(numbers(catalog.search_group("weather", "b", 9)), [9, 6]);
    assert!(catalog.search_group("no such", "", 9).is_empty());
}

#[test]
fn the_source_of_the_newest_set_is_known_and_the_counts_sum_to_the_catalog() {
    let mut catalog = Catalog::default();
    catalog.merge(report(&[(5, "A", 2), (6, "B", 2), (9, "C", 2)]), "weather");
    catalog.merge(report(&[(6, "B", 3), (7, "D", 1), (5, "A", 1), (9, "C", 2)]), "own");
    let source_of = |number| catalog.source_of(number);
    assert_eq!(
        [5, 6, 7, 9].map(source_of),
        [Some("weather"), Some("own"), Some("own"), Some("weather")]
    );
    assert_eq!(source_of(8), None);
    assert_eq!(catalog.in_use(), [("weather", 2), ("own", 2)]);
    let superseded = catalog.take_superseded();
    let superseded: Vec<_> = superseded
        .iter()
        .map(|(elements, source)| (elements.catalog_number(), source.as_str()))
        .collect();
    assert_eq!(superseded, [(6, "weather"), (5, "own")], "not the one of the same epoch");
    assert_eq!(catalog.take_superseded(), []);
}

#[test]
fn a_merge_hands_on_what_was_refused() {
    let mut catalog = Catalog::default();
    let summary = catalog.merge(read_elements("[{}]"), "broken");
    assert_eq!((summary.refused.len(), catalog.is_empty()), (1, true));
}

#[test]
fn search_finds_numbers_by_their_start_and_names_by_any_part() {
    let mut catalog = Catalog::default();
    let objects = [(25_544, "ISS", 1), (255, "Noaa 19", 1), (7, "METEOR 25", 1), (8, "Iss 2", 1)];
    catalog.merge(report(&objects), "test");
    let numbers = |text, limit| -> Vec<u32> {
        catalog.search(text, limit).into_iter().map(Elements::catalog_number).collect()
    };
    assert_eq!(numbers(" iss", 9), [25_544, 8]);
    assert_eq!(numbers("25", 9), [25_544, 7, 255]);
    assert_eq!(numbers("25", 1), [25_544]);
    assert_eq!(numbers("", 9).len(), 4);
    assert!(numbers("no such", 9).is_empty());
}
