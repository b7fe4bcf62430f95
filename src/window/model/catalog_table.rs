//! The catalog as a table: the objects shown, their order and their next passes. A thread
//! recomputes the table when an input has changed.

use std::{cmp::Ordering, collections::HashMap, sync::Arc};

use jiff::Timestamp;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{globe::NextPass, object_detail::ObjectDetail};
use crate::{
    astro::{
        Angle, Site,
        time::{DAY_S, add_seconds},
    },
    orbit::{Catalog, Elements, PassSearch, Propagator, passes_of_all},
    station::Station,
};

/// Age above which elements count as old, seconds, for every orbit.
pub const OLD_S: f64 = 7.0 * DAY_S;
/// Time ahead in which Azel searches for next passes, hours.
pub const NEXT_PASSES_H: u32 = 24;
/// Time after which the search for next passes runs again, seconds.
pub const NEXT_PASSES_STALE_S: f64 = 60.0;
/// Number of passes kept for each satellite. The first may end before the search runs again.
const PASSES_AHEAD: usize = 2;
/// Max time since the start of a current pass, seconds, except for satellites that hardly move.
const LOOK_BACK_S: f64 = 3600.0;

/// Objects among which the table searches.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Subset {
    #[default]
    All,
    Favourites,
    /// Objects of one source.
    Group(String),
    /// Name of a group that the operator has made.
    Own(String),
    /// Objects whose elements are older than [`OLD_S`].
    Old,
}

/// A column of the table; the operator can sort by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// Favourites by priority, before all other objects.
    #[default]
    Star,
    Name,
    Number,
    Period,
    Inclination,
    /// Heights of apogee and perigee.
    Heights,
    Age,
    /// Source of the elements in use.
    From,
    NextPass,
    MaxElevation,
}

/// Search, filter and order of the rows.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Question {
    pub search: String,
    pub scope: Subset,
    pub sort: Column,
    pub is_descending: bool,
}

/// All inputs of the rows.
#[derive(Debug, Clone)]
pub struct Inputs {
    pub question: Question,
    pub catalog: Arc<Catalog>,
    pub station: Arc<Station>,
    pub next: Option<Arc<NextPasses>>,
}

/// The rows of the table.
#[derive(Debug, Clone)]
pub struct Answer {
    pub inputs: Inputs,
    /// Catalog numbers in the order of the rows.
    pub rows: Arc<[u32]>,
    /// Number of objects with old elements in the whole catalog.
    pub old: usize,
}

/// The next pass of every satellite with a pass that reaches the elevation floor.
#[derive(Debug)]
pub struct NextPasses {
    pub key: NextKey,
    pub made_at: Timestamp,
    /// The first passes of each satellite, by time.
    by_satellite: HashMap<u32, Vec<NextPass>>,
}

/// Inputs of the next passes, except the time.
#[derive(Debug, Clone)]
pub struct NextKey {
    pub catalog: Arc<Catalog>,
    site: Site,
    aos_elevation: Angle,
    floor: Angle,
}

/// The table and its current question.
#[derive(Default)]
pub struct CatalogTable {
    pub question: Question,
    /// The last rows, kept until the next rows are ready.
    pub answer: Option<Answer>,
    pub next: Option<Arc<NextPasses>>,
    /// Catalog number of the object shown in detail.
    pub inspected: Option<u32>,
    /// The detail of an object, kept until the next detail is ready.
    pub detail: Option<ObjectDetail>,
}

impl CatalogTable {
    /// Returns the inputs for computing the rows.
    pub fn inputs(&self, catalog: &Arc<Catalog>, station: &Arc<Station>) -> Inputs {
        Inputs {
            question: self.question.clone(),
            catalog: Arc::clone(catalog),
            station: Arc::clone(station),
            next: self.next.clone(),
        }
    }
}

impl PartialEq for Inputs {
    fn eq(&self, other: &Self) -> bool {
        let made_at = |inputs: &Self| inputs.next.as_ref().map(|next| next.made_at);
        self.question == other.question
            && Arc::ptr_eq(&self.catalog, &other.catalog)
            && self.station.favourites == other.station.favourites
            && self.station.groups == other.station.groups
            && made_at(self) == made_at(other)
    }
}

impl PartialEq for NextKey {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.catalog, &other.catalog)
            && self.site == other.site
            && self.aos_elevation == other.aos_elevation
            && self.floor == other.floor
    }
}

impl NextKey {
    pub fn new(catalog: &Arc<Catalog>, station: &Station) -> Self {
        Self {
            catalog: Arc::clone(catalog),
            site: station.site,
            aos_elevation: station.aos_elevation(),
            floor: station.elevation_floor(),
        }
    }
}

impl NextPasses {
    /// Searches for the first passes of every satellite that end after `now`.
    pub fn search(key: NextKey, now: Timestamp, cancelled: &(dyn Fn() -> bool + Sync)) -> Self {
        let all: Vec<&Elements> = key.catalog.iter().collect();
        let prepared: Vec<(u32, Propagator)> = all
            .into_par_iter()
            .filter(|_| !cancelled())
            .filter_map(|elements| {
                Some((elements.catalog_number(), Propagator::new(elements).ok()?))
            })
            .collect();
        let (numbers, propagators): (Vec<u32>, Vec<Propagator>) = prepared.into_iter().unzip();
        let end = add_seconds(now, f64::from(NEXT_PASSES_H) * 3600.0);
        let window = PassSearch {
            aos_elevation: key.aos_elevation,
            floor: key.floor,
            ..PassSearch::new(key.site, add_seconds(now, -LOOK_BACK_S), end)
        };
        let mut by_satellite = HashMap::new();
        for (index, pass) in passes_of_all(&propagators, &window, &|_| (), cancelled) {
            if pass.los.time <= now {
                continue;
            }
            let Some(number) = numbers.get(index) else { continue };
            let first: &mut Vec<NextPass> = by_satellite.entry(*number).or_default();
            if first.len() < PASSES_AHEAD {
                first.push(NextPass {
                    aos: pass.aos.time,
                    los: pass.los.time,
                    max_elevation: pass.max_elevation(),
                    is_always_up: pass.starts_before && pass.ends_after,
                });
            }
        }
        Self { key, made_at: now, by_satellite }
    }

    /// Returns the pass of a satellite that is current at `now` or comes next.
    pub fn get(&self, number: u32, now: Timestamp) -> Option<NextPass> {
        self.by_satellite.get(&number)?.iter().copied().find(|pass| pass.los > now)
    }
}

/// Sort key of an object in a column; `None` sorts last in both directions.
type Rank = Option<(f64, f64)>;

/// Computes the rows for `inputs` at `now`.
pub fn arrange(inputs: Inputs, now: Timestamp) -> Answer {
    let Inputs { question, catalog, station, .. } = &inputs;
    let is_old = |elements: &&Elements| elements.epoch_distance_s(now) > OLD_S;
    let mut found: Vec<&Elements> = match &question.scope {
        Subset::All => catalog.iter().collect(),
        Subset::Favourites => {
            let favourites = station.favourites.iter();
            favourites.filter_map(|favourite| catalog.get(favourite.satellite)).collect()
        }
        Subset::Group(group) => catalog.in_group(group).collect(),
        Subset::Own(name) => {
            station.in_groups(name).into_iter().filter_map(|number| catalog.get(number)).collect()
        }
        Subset::Old => catalog.iter().filter(is_old).collect(),
    };
    let needle = question.search.trim().to_lowercase();
    if !needle.is_empty() {
        found.retain(|elements| is_found(elements, &needle));
    }
    let rows = match question.sort {
        Column::Name => {
            by_text(found, question.is_descending, |object| object.name().to_lowercase())
        }
        Column::From => by_text(found, question.is_descending, |object| {
            catalog.source_of(object.catalog_number()).unwrap_or_default().to_owned()
        }),
        column => {
            by_number(found, question.is_descending, |object| rank(column, object, &inputs, now))
        }
    };
    let old = catalog.iter().filter(is_old).count();
    Answer { inputs, rows, old }
}

/// Returns `true` if the name or designator contains the text in any case, or the catalog number
/// begins with it.
fn is_found(elements: &Elements, needle: &str) -> bool {
    elements.name().to_lowercase().contains(needle)
        || elements.catalog_number().to_string().starts_with(needle)
        || elements
            .international_designator()
            .is_some_and(|designator| designator.to_lowercase().contains(needle))
}

fn rank(column: Column, elements: &Elements, inputs: &Inputs, now: Timestamp) -> Rank {
    let number = elements.catalog_number();
    let next = || inputs.next.as_ref().and_then(|next| next.get(number, now));
    let one = |value: f64| Some((value, 0.0));
    match column {
        Column::Star => one(f64::from(inputs.station.priority(number)?.number())),
        Column::Name | Column::From | Column::Number => one(f64::from(number)),
        Column::Period => one(elements.period_s()),
        Column::Inclination => one(elements.inclination().degrees()),
        Column::Heights => {
            let heights = elements.heights();
            Some((heights.apogee_km, heights.perigee_km))
        }
        Column::Age => one(elements.age_s(now)),
        Column::NextPass => {
            let next = next()?;
            // Satellites that are up all the time come after all others.
            let late = f64::from(u8::from(next.is_always_up));
            Some((late, next.aos.as_microsecond() as f64))
        }
        Column::MaxElevation => one(next()?.max_elevation.degrees()),
    }
}

fn by_number(
    found: Vec<&Elements>,
    is_descending: bool,
    rank: impl Fn(&Elements) -> Rank,
) -> Arc<[u32]> {
    let mut ranked: Vec<(Rank, u32)> =
        found.into_iter().map(|elements| (rank(elements), elements.catalog_number())).collect();
    ranked.sort_by(|(a, first), (b, second)| {
        let order = match (a, b) {
            (Some(a), Some(b)) => {
                let order = a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
                if is_descending { order.reverse() } else { order }
            }
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => Ordering::Equal,
        };
        order.then(first.cmp(second))
    });
    ranked.into_iter().map(|(_, number)| number).collect()
}

/// Sorts objects by a text. Objects without a text come last in both directions.
fn by_text(
    found: Vec<&Elements>,
    is_descending: bool,
    text: impl Fn(&Elements) -> String,
) -> Arc<[u32]> {
    let mut named: Vec<(String, u32)> =
        found.into_iter().map(|elements| (text(elements), elements.catalog_number())).collect();
    named.sort_by(|(a, first), (b, second)| {
        let order = if is_descending { b.cmp(a) } else { a.cmp(b) };
        a.is_empty().cmp(&b.is_empty()).then(order).then(first.cmp(second))
    });
    named.into_iter().map(|(_, number)| number).collect()
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::{
        orbit::bundled,
        station::{Favourites, PassLimits, SatelliteGroup},
    };

    const ISS: u32 = 25_544;
    const NOAA_20: u32 = 43_013;

    fn now() -> Timestamp {
        "2026-08-12T12:00:00Z".parse().unwrap()
    }

    fn inputs(question: Question) -> Inputs {
        let catalog = Arc::new(bundled().unwrap());
        let mut favourites = Favourites::from([NOAA_20, ISS, 999]);
        favourites.set_priority(ISS, crate::station::Priority::ALL[0]);
        let weather = SatelliteGroup {
            name: "weather".to_owned(),
            satellites: vec![NOAA_20, 999],
            priority: None,
            limits: PassLimits::default(),
        };
        let groups = vec![weather];
        let station = Arc::new(Station { favourites, groups, ..Station::default() });
        Inputs { question, catalog, station, next: None }
    }

    fn rows(question: Question) -> Vec<u32> {
        arrange(inputs(question), now()).rows.to_vec()
    }

    fn search(search: &str) -> Question {
        Question { search: search.to_owned(), ..Question::default() }
    }

    #[test]
    fn names_numbers_and_designators_are_found() {
        assert_eq!(rows(search("noaa 20 ")), [NOAA_20]);
        assert!(rows(search("43013")).contains(&NOAA_20));
        assert!(rows(search("1998-067a")).contains(&ISS));
        assert_eq!(rows(search("no such object")), [0; 0]);
        assert_eq!(rows(Question::default()).len(), 16_089);
    }

    #[test]
    fn every_column_sorts_both_ways() {
        let catalog = bundled().unwrap();
        let elements = |number: u32| catalog.get(number).unwrap();
        let sorted =
            |sort, is_descending| rows(Question { sort, is_descending, ..search("sentinel") });
        let check = |column, key: &dyn Fn(&Elements) -> f64| {
            for is_descending in [false, true] {
                let keys: Vec<f64> = sorted(column, is_descending)
                    .iter()
                    .map(|number| key(elements(*number)))
                    .collect();
                assert!(keys.len() > 3);
                let right = |pair: &[f64]| {
                    if is_descending { pair[0] >= pair[1] } else { pair[0] <= pair[1] }
                };
                assert!(keys.windows(2).all(right), "{column:?} {keys:?}");
            }
        };
        check(Column::Number, &|elements| f64::from(elements.catalog_number()));
        check(Column::Period, &|elements| elements.period_s());
        check(Column::Inclination, &|elements| elements.inclination().degrees());
        check(Column::Heights, &|elements| elements.heights().apogee_km);
        check(Column::Age, &|elements| elements.age_s(now()));
        let names: Vec<_> = sorted(Column::Name, false)
            .iter()
            .map(|n| elements(*n).name().to_lowercase())
            .collect();
        assert!(names.is_sorted());
        let all = |sort| rows(Question { sort, ..Question::default() });
        assert_eq!(all(Column::Star)[..2], [ISS, NOAA_20], "by priority, the others after them");
        assert_eq!(all(Column::NextPass).len(), 16_089, "also while none is known");
    }

    #[test]
    fn groups_favourites_and_old_sets_are_chosen() {
        let answer = |scope| arrange(inputs(Question { scope, ..Question::default() }), now());
        assert_eq!(answer(Subset::Favourites).rows.len(), 2, "one has no elements");
        assert_eq!(
            answer(Subset::Own("weather".to_owned())).rows[..],
            [NOAA_20],
            "one is not held"
        );
        assert_eq!(
            answer(Subset::Group(crate::orbit::BUNDLED_SOURCE.to_owned())).rows.len(),
            16_089
        );
        let old = answer(Subset::Old);
        assert_eq!(old.rows.len(), old.old);
        assert!(old.old > 0 && old.old < 16_089, "{}", old.old);
    }

    #[test]
    fn sorting_and_searching_the_whole_catalog_is_timed() {
        let all = inputs(Question::default());
        let timed = |subject: &str, question: Question| {
            let inputs = Inputs { question, ..all.clone() };
            let start = Instant::now();
            let count = arrange(inputs, now()).rows.len();
            println!("{subject}: {:.1} ms, {count} rows", start.elapsed().as_secs_f64() * 1e3);
        };
        for sort in [Column::Name, Column::Number, Column::Heights, Column::Age, Column::From] {
            timed(&format!("sort by {sort:?}"), Question { sort, ..Question::default() });
        }
        for text in ["starlink", "noaa", "4301", "no such"] {
            timed(&format!("search for {text}"), search(text));
        }
    }

    #[test]
    fn the_next_pass_is_the_one_under_way_or_the_first_to_come() {
        let mut catalog = Catalog::default();
        let bundled = bundled().unwrap();
        let mut text = Vec::new();
        let few = [ISS, NOAA_20, 44_334].map(|number| bundled.get(number).unwrap());
        crate::orbit::write_omm_json(few, &mut text).unwrap();
        catalog.merge(crate::orbit::read_element_bytes(&text), "few");
        let (catalog, mut station) = (Arc::new(catalog), Station::default());
        let next = NextPasses::search(NextKey::new(&catalog, &station), now(), &|| false);
        for number in [ISS, NOAA_20] {
            let pass = next.get(number, now()).unwrap();
            assert!(pass.aos < pass.los && pass.los > now());
            assert!(pass.max_elevation >= station.elevation_floor());
            let later = next.get(number, pass.los).unwrap();
            assert!(later.aos > pass.los, "that one is over");
        }
        assert!(next.get(44_334, now()).unwrap().is_always_up);

        station.elevation_floor_deg = 60.0;
        let high = NextPasses::search(NextKey::new(&catalog, &station), now(), &|| false);
        assert!(high.key != next.key, "another floor asks for another search");
        for number in [ISS, NOAA_20, 44_334] {
            let highest = high.get(number, now()).map(|pass| pass.max_elevation.degrees());
            assert!(highest.is_none_or(|degrees| degrees >= 60.0), "{number} {highest:?}");
        }
    }
}
