use std::{
    sync::mpsc::{self, Receiver},
    time::Duration,
};

use super::*;
use crate::{
    astro::{Site, time::add_seconds},
    contract::passes::{PassListKey, PredictedPass, Work},
    makes::DemoAddresses,
    orbit::{bundled, read_element_bytes, write_omm_json},
};

const ISS: u32 = 25_544;
const NOAA_20: u32 = 43_013;
const METEOSAT_12: u32 = 54_743;

fn now() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

/// Lists of a station with one favourite and a small catalog.
struct Fixture {
    searches: Searches,
    pass_lists: PassLists,
    catalog: Arc<Catalog>,
    station: Arc<Station>,
    choice: ListChoice,
    now: Timestamp,
    wake: Wake,
    woken: Receiver<()>,
}

impl Fixture {
    fn new() -> Self {
        let (send, woken) = mpsc::sync_channel(1000);
        let bundled = bundled().unwrap();
        let some = [ISS, NOAA_20, METEOSAT_12].map(|number| bundled.get(number).unwrap());
        let mut catalog = Catalog::default();
        let mut text = Vec::new();
        write_omm_json(some, &mut text).unwrap();
        catalog.merge(read_element_bytes(&text), "test");
        Self {
            searches: Searches::default(),
            pass_lists: PassLists::default(),
            catalog: Arc::new(catalog),
            station: Arc::new(Station {
                favourites: [NOAA_20].into(),
                ..Station::demo(&DemoAddresses::default())
            }),
            choice: ListChoice { scope: Scope::All, ..ListChoice::default() },
            now: now(),
            wake: Arc::new(move || {
                let _ = send.try_send(());
            }),
            woken,
        }
    }

    /// Returns the station as a new value, which changes the search key.
    fn station(&mut self) -> &mut Station {
        Arc::make_mut(&mut self.station)
    }

    fn refresh(&mut self) {
        let (catalog, station) = (&self.catalog, &self.station);
        self.searches.refresh(catalog, station, self.choice, self.now, &self.wake);
        self.pass_lists = self.searches.shown();
    }

    /// Refreshes until no search is running.
    fn finish(&mut self) {
        self.refresh();
        while [Scope::Favourites, Scope::All]
            .iter()
            .any(|scope| matches!(self.pass_lists.list(*scope).work, Work::UnderWay { .. }))
        {
            self.woken.recv_timeout(Duration::from_mins(1)).expect("a sign of life");
            self.refresh();
        }
    }

    fn all(&self) -> &PassList {
        &self.pass_lists.all
    }
}

#[test]
fn all_satellites_are_listed_and_found_and_the_followed_ones_stay_apart() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let followed = &fixture.pass_lists.favourites.passes;
    assert!(!followed.is_empty() && followed.iter().all(|pass| pass.number() == NOAA_20));
    let iss: Vec<_> = fixture.all().passes.iter().filter(|pass| pass.number() == ISS).collect();
    assert!(!iss.is_empty());
    let key = iss[0].key();
    assert_eq!(fixture.pass_lists.find(key).map(PredictedPass::key), Some(key));
    let shifted = (key.0, add_seconds(key.1, 2.0));
    assert_eq!(fixture.pass_lists.find(shifted).map(PredictedPass::key), Some(key));
    assert!(fixture.pass_lists.find((key.0, add_seconds(key.1, 600.0))).is_none());
    // A pass that never sets is found even if an older list had another AOS.
    let always = (METEOSAT_12, add_seconds(now(), -100_000.0));
    assert!(fixture.pass_lists.find(always).is_some());
    assert!(
        fixture.pass_lists.satellite(ISS).is_some() && fixture.pass_lists.satellite(7).is_none()
    );
}

#[test]
fn no_pass_is_outlined_before_somebody_looks_at_it() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let listed = || fixture.pass_lists.favourites.passes.iter().chain(&*fixture.all().passes);
    assert!(listed().next().is_some() && !listed().any(PredictedPass::has_outline));
    let pass = &fixture.pass_lists.favourites.passes[0];
    assert!(pass.trackability(99).is_none() && !pass.has_outline(), "no such antenna");
    assert!(pass.trackability(0).is_some() && pass.has_outline());
}

#[test]
fn what_never_sets_stands_behind_the_passes_of_all_satellites() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let passes = &fixture.all().passes;
    assert!(passes.len() > 1 && passes[passes.len() - 1].number() == METEOSAT_12);
    assert!(passes[..passes.len() - 1].is_sorted_by_key(|pass| pass.pass.aos.time));
}

#[test]
fn what_never_sets_stands_behind_the_passes_of_favourites_whatever_the_span() {
    let mut fixture = Fixture::new();
    fixture.station().favourites = [METEOSAT_12, ISS].into();
    fixture.finish();
    let favourites = &fixture.pass_lists.favourites;
    for (span_h, is_cut) in [(1, true), (12, true), (48, false)] {
        let listed = favourites.upcoming_within(now(), span_h);
        assert_eq!(listed.len() < favourites.passes.len(), is_cut, "{span_h} h");
        let last = listed.get(listed.len() - 1).unwrap();
        assert_eq!((last.number(), listed.row(last.key())), (METEOSAT_12, Some(listed.len() - 1)));
        let end = add_seconds(now(), f64::from(span_h) * 3600.0);
        let others = || listed.iter().take(listed.len() - 1);
        assert!(
            others().all(|predicted| predicted.number() == ISS && predicted.pass.aos.time < end)
        );
        assert!(
            others().enumerate().all(|(row, predicted)| listed.row(predicted.key()) == Some(row))
        );
    }
}

#[test]
fn another_floor_span_or_site_searches_again_and_keeps_what_is_prepared() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let prepared = Arc::clone(&fixture.all().satellites[0]);
    let changes: [fn(&mut Fixture); 3] = [
        |fixture| fixture.station().elevation_floor_deg = 30.0,
        |fixture| fixture.choice.set_span_h(48),
        |fixture| fixture.station().site = Site::new(60.0, 10.0, 0.0).unwrap(),
    ];
    for change in changes {
        let (revision, before) = (fixture.all().revision, fixture.all().passes.len());
        change(&mut fixture);
        fixture.refresh();
        assert!(matches!(fixture.all().work, Work::UnderWay { .. }));
        assert_eq!(fixture.all().passes.len(), before, "the old list stays");
        fixture.finish();
        assert!(fixture.all().revision > revision);
        assert!(Arc::ptr_eq(&prepared, &fixture.all().satellites[0]));
    }
    assert!(fixture.all().passes.iter().all(|pass| pass.pass.max_elevation().degrees() >= 30.0));
}

#[test]
fn new_elements_are_prepared_and_searched() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let prepared = Arc::clone(&fixture.all().satellites[0]);
    fixture.catalog = Arc::new(Catalog::clone(&fixture.catalog));
    fixture.finish();
    assert!(!Arc::ptr_eq(&prepared, &fixture.all().satellites[0]));
}

#[test]
fn a_cancelled_search_stays_cancelled_until_something_else_is_asked_for() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let before = fixture.all().passes.len();
    for resume in [true, false] {
        fixture.choice.set_span_h(if resume { 12 } else { 24 });
        fixture.refresh();
        fixture.searches.of_mut(Scope::All).cancel();
        fixture.now = add_seconds(fixture.now, 1.0);
        fixture.refresh();
        assert_eq!(fixture.all().work, Work::Cancelled);
        assert!(fixture.all().passes.len() >= before.min(1), "the old list stays");
        if resume {
            fixture.searches.of_mut(Scope::All).resume();
        } else {
            fixture.station().elevation_floor_deg = 20.0;
        }
        fixture.refresh();
        assert!(matches!(fixture.all().work, Work::UnderWay { .. }), "{resume}");
        fixture.finish();
        assert_eq!(fixture.all().work, Work::Nothing);
    }
}

#[test]
fn what_was_cancelled_is_forgotten_where_the_list_is_right_again() {
    let mut fixture = Fixture::new();
    fixture.finish();
    fixture.choice.set_span_h(24);
    fixture.refresh();
    fixture.searches.of_mut(Scope::All).cancel();
    fixture.choice.set_span_h(6);
    fixture.refresh();
    assert_eq!(fixture.all().work, Work::Nothing);
}

#[test]
fn what_is_over_leaves_the_list_and_an_old_list_is_made_anew() {
    let mut fixture = Fixture::new();
    fixture.choice.scope = Scope::Favourites;
    fixture.finish();
    let first = fixture.pass_lists.favourites.passes[0].clone();
    fixture.now = first.pass.los.time.max(add_seconds(now(), 601.0));
    fixture.refresh();
    let favourites = &fixture.pass_lists.favourites;
    assert!(favourites.upcoming(fixture.now).iter().all(|pass| pass.key() != first.key()));
    assert!(matches!(favourites.work, Work::UnderWay { .. }), "it is old");
}

#[test]
fn the_list_of_another_place_is_not_kept_behind_the_favourites() {
    let mut fixture = Fixture::new();
    fixture.finish();
    fixture.choice.scope = Scope::Favourites;
    fixture.finish();
    assert!(!fixture.all().passes.is_empty(), "what was selected in it stays");
    fixture.station().site = Site::new(60.0, 10.0, 0.0).unwrap();
    fixture.finish();
    assert!(fixture.all().passes.is_empty());
}

#[test]
fn a_shorter_span_shows_the_beginning_of_the_list() {
    let mut fixture = Fixture::new();
    fixture.finish();
    let favourites = &fixture.pass_lists.favourites;
    let (short, long) =
        (favourites.upcoming_within(now(), 6), favourites.upcoming_within(now(), 48));
    assert!(short.len() < long.len() && long.len() == favourites.passes.len());
    let end = add_seconds(now(), 6.0 * 3600.0);
    assert!(short.iter().all(|pass| pass.pass.aos.time < end));
}

#[test]
fn the_rows_are_the_passes_that_are_neither_over_nor_too_late() {
    let mut fixture = Fixture::new();
    fixture.station().favourites = [METEOSAT_12, ISS, NOAA_20].into();
    fixture.finish();
    let favourites = &fixture.pass_lists.favourites;
    for (after_h, span_h) in [(0, 6), (5, 12), (20, 48), (47, 1), (49, 6)] {
        let start = add_seconds(now(), f64::from(after_h) * 3600.0);
        let end = add_seconds(start, f64::from(span_h) * 3600.0);
        let begins_in_time = |pass: &PredictedPass| pass.is_always_up() || pass.pass.aos.time < end;
        let is_listed = |candidate: &&PredictedPass| {
            candidate.pass.los.time > start && begins_in_time(candidate)
        };
        let expected: Vec<PassListKey> =
            favourites.passes.iter().filter(is_listed).map(PredictedPass::key).collect();
        let listed = favourites.upcoming_within(start, span_h);
        assert_eq!(listed.iter().map(PredictedPass::key).collect::<Vec<_>>(), expected);
        let rows: Vec<PassListKey> =
            (0..listed.len()).filter_map(|row| listed.get(row)).map(PredictedPass::key).collect();
        assert_eq!(rows, expected);
        for predicted in &*favourites.passes {
            let key = predicted.key();
            assert_eq!(
                listed.row(key),
                expected.iter().position(|other| *other == key),
                "{after_h} h"
            );
        }
        let dated = favourites.passes.iter().filter(|pass| !pass.is_always_up() && is_listed(pass));
        let is_begun = |pass: &&PredictedPass| is_listed(pass) && pass.pass.aos.time <= start;
        let dated_passes = favourites.passes.iter().filter(|candidate| !candidate.is_always_up());
        assert_eq!(listed.begun(start), dated_passes.filter(is_begun).count(), "{after_h} h");
        let upcoming = favourites.upcoming(start);
        assert!(
            upcoming.starting_before(end).map(PredictedPass::key).eq(dated.map(PredictedPass::key))
        );
    }
}

#[test]
fn a_pass_cut_at_the_start_of_the_list_is_found_whenever_it_began_in_an_older_one() {
    let bundled = bundled().unwrap();
    let half_a_day = |set: &&Elements| (11.0..13.0).contains(&(set.period_s() / 3600.0));
    let elements: Vec<Elements> = bundled.iter().filter(half_a_day).cloned().collect();
    let fixture = Fixture::new();
    let key = SearchKey::of_favourites(&fixture.catalog, &fixture.station);
    let list = list::again(&key, &elements, Some(now()));
    let mut cut = 0;
    for predicted in &*list.passes {
        let (number, aos) = predicted.key();
        let found = |aos| list.find((number, aos)).map(PredictedPass::key);
        assert_eq!(found(aos), Some(predicted.key()));
        if predicted.pass.starts_before {
            assert_eq!(found(add_seconds(aos, -1000.0)), Some(predicted.key()));
            cut += 1;
        }
    }
    assert!((10..list.passes.len() - 10).contains(&cut), "{cut} of {}", list.passes.len());
}
