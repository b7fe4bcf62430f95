//! The catalog: all elements that the operator has, with the newest set of every object, or an
//! older one where the operator uses that or prefers its source.

use std::{
    cmp::Ordering,
    collections::{BTreeMap, BTreeSet},
    ops::Range,
    sync::{Arc, Weak},
};

use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::{Elements, Note, Nothing, ReadReport, Refusal};

/// A preferred source stays in use while its set is at most this much older than the newest one.
/// The limit compares epochs, not ages: a set that nobody else renews is still the best one.
pub const SOURCE_LAG: SignedDuration = SignedDuration::from_hours(72);

/// A set whose epoch lies more than this ahead replaces no other set. Sources give the next node of
/// an orbit as epoch, which is up to a day ahead; sets for launches to come, and sets with a
/// damaged epoch, lie farther ahead.
pub const MAX_EPOCH_AHEAD: SignedDuration = SignedDuration::from_hours(24);

/// The names of the sources that an object prefers, the first one first, by catalog number.
pub type SourceOrders = BTreeMap<u32, Vec<String>>;

#[derive(Debug, Clone, Default)]
pub struct Catalog {
    /// By catalog number: a sorted list takes half the memory of a map.
    entries: Vec<Entry>,
    groups: Vec<Group>,
    /// Sets that newer ones have replaced.
    superseded: Vec<Entry>,
    /// The newest sets of the objects of which an older one is in use, by catalog number.
    set_aside: BTreeMap<u32, SetAside>,
    /// The newest sets of the objects whose preferred source has an older one, by catalog number.
    passed_over: BTreeMap<u32, SetAside>,
    orders: SourceOrders,
    /// All sets of the objects with an order of sources.
    candidates: BTreeMap<u32, Vec<Entry>>,
    /// Objects with an order of sources whose set the operator has chosen.
    chosen: BTreeSet<u32>,
    /// A catalog in use, whose equal sets are shared.
    previous: Weak<Self>,
    clock: EpochClock,
}

/// Judges which of two sets of one object is better at a time.
#[derive(Debug, Clone, Copy, Default)]
struct EpochClock {
    /// `None` in a catalog without a time: the newest epoch is the best.
    now: Option<Timestamp>,
    /// The earliest epoch that was compared and lies too far ahead.
    ahead: Option<Timestamp>,
    /// The latest epoch that was compared and does not.
    current: Option<Timestamp>,
}

impl EpochClock {
    fn is_ahead(now: Timestamp, epoch: Timestamp) -> bool {
        epoch.duration_since(now) > MAX_EPOCH_AHEAD
    }

    /// The rank of an epoch: the newest one that does not lie too far ahead has the highest. Of
    /// those ahead the nearest one is the best.
    fn rank(self, epoch: Timestamp) -> (bool, i64) {
        let is_ahead = self.now.is_some_and(|now| Self::is_ahead(now, epoch));
        let microseconds = epoch.as_microsecond();
        (!is_ahead, if is_ahead { -microseconds } else { microseconds })
    }

    fn compare(&mut self, epochs: [Timestamp; 2]) -> Ordering {
        for epoch in epochs {
            if self.rank(epoch).0 {
                self.current = self.current.max(Some(epoch));
            } else {
                self.ahead = Some(self.ahead.map_or(epoch, |ahead| ahead.min(epoch)));
            }
        }
        let [first, second] = epochs.map(|epoch| self.rank(epoch));
        first.cmp(&second)
    }

    /// Returns `true` if a comparison would give another result at `now`.
    fn is_outdated(self, now: Timestamp) -> bool {
        let is_current = |epoch| !Self::is_ahead(now, epoch);
        self.now.is_some()
            && (self.ahead.is_some_and(is_current)
                || self.current.is_some_and(|epoch| Self::is_ahead(now, epoch)))
    }
}

/// The newest set of an object, while an older one is in use.
#[derive(Debug, Clone)]
struct SetAside {
    newest: Arc<Elements>,
    /// The source of the set in use.
    source_in_use: String,
}

/// The newest elements of an object, and the group whose source gave them.
#[derive(Debug, Clone)]
struct Entry {
    /// Shared by the catalogs before and after the sources were read again.
    elements: Arc<Elements>,
    group: u32,
}

impl Entry {
    fn number(&self) -> u32 {
        self.elements.catalog_number()
    }
}

/// The objects of one source.
#[derive(Debug, Clone)]
struct Group {
    name: String,
    /// Catalog numbers, sorted.
    members: Vec<u32>,
}

/// Changes of a merge.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MergeSummary {
    /// Objects that are new to the catalog.
    pub added: usize,
    /// Objects that got a better epoch.
    pub updated: usize,
    /// Sets with the same epoch as the known set.
    pub known: usize,
    /// Sets older than the known set, or too far ahead, left out.
    pub older: usize,
    /// Objects that could not be read.
    pub refused: Vec<Refusal>,
    /// Number of refused objects beyond those listed.
    pub refused_unlisted: usize,
    /// Oddities of sets that were accepted.
    pub notes: Vec<Note>,
    /// The reason why there was nothing to merge, if there was nothing.
    pub nothing: Option<Nothing>,
}

impl Catalog {
    /// Sets the orders of sources. Call it before the merges of these sources;
    /// [`Self::apply_orders`] applies the orders after them.
    pub fn set_orders(&mut self, orders: SourceOrders) {
        self.candidates = orders.keys().map(|number| (*number, Vec::new())).collect();
        self.orders = orders;
    }

    /// Sets the time at which the sets are used. Call it before the merges.
    pub fn set_time(&mut self, now: Timestamp) {
        self.clock.now = Some(now);
    }

    /// Returns `true` if the merges would choose other sets at `now`: a set that lay ahead of the
    /// time of the merges does so no more, or the clock was set back.
    pub fn is_outdated(&self, now: Timestamp) -> bool {
        self.clock.is_outdated(now)
    }

    /// Returns `true` if a set of `epoch` is used rather than one of `other`.
    pub fn is_better(&self, epoch: Timestamp, other: Timestamp) -> bool {
        self.clock.rank(epoch) > self.clock.rank(other)
    }

    /// The newest epoch of `sets` that does not lie more than [`MAX_EPOCH_AHEAD`] ahead; the nearest
    /// one if all do.
    pub fn newest_of<'a>(&self, sets: impl IntoIterator<Item = &'a Elements>) -> Option<Timestamp> {
        let epochs = sets.into_iter().map(Elements::epoch);
        epochs.max_by_key(|epoch| self.clock.rank(*epoch))
    }

    /// Uses the set of the first source in the order of each object that is at most
    /// [`SOURCE_LAG`] older than the newest one; leaves the newest set in use if there is none.
    /// Skips the objects for which `has_choice` returns true: the operator has chosen their set.
    pub fn apply_orders(&mut self, has_choice: impl Fn(u32) -> bool) {
        let candidates = std::mem::take(&mut self.candidates);
        for (number, sets) in candidates {
            if has_choice(number) {
                self.chosen.insert(number);
                continue;
            }
            if let Some(chosen) = self.preferred(number, &sets) {
                self.use_preferred(number, chosen);
            }
        }
    }

    fn preferred(&self, number: u32, sets: &[Entry]) -> Option<Entry> {
        let newest = self.get(number)?.epoch();
        let is_current = |set: &&Entry| {
            let epoch = set.elements.epoch();
            newest.duration_since(epoch).abs() <= SOURCE_LAG
                && self.clock.rank(epoch).0 == self.clock.rank(newest).0
        };
        self.orders.get(&number)?.iter().find_map(|name| {
            let place = self.groups.iter().position(|group| group.name == *name)?;
            let own = sets.iter().filter(|set| set.group as usize == place);
            own.max_by_key(|set| self.clock.rank(set.elements.epoch())).filter(is_current).cloned()
        })
    }

    fn use_preferred(&mut self, number: u32, mut chosen: Entry) {
        let source_in_use = self.groups.get(chosen.group as usize).map(|group| group.name.clone());
        let Ok(place) = self.entries.binary_search_by_key(&number, Entry::number) else { return };
        let Some(current) = self.entries.get_mut(place) else { return };
        take_name(&mut chosen.elements, &current.elements);
        if current.elements.epoch() == chosen.elements.epoch() {
            *current = chosen;
            return;
        }
        let newest = std::mem::replace(&mut current.elements, chosen.elements);
        let aside = SetAside { newest, source_in_use: source_in_use.unwrap_or_default() };
        self.passed_over.insert(number, aside);
    }

    /// Returns `true` if the operator has chosen the set of an object in place of its order.
    pub fn is_chosen(&self, catalog_number: u32) -> bool {
        self.chosen.contains(&catalog_number) || self.set_aside.contains_key(&catalog_number)
    }

    /// The newest set of an object whose preferred source has an older one.
    pub fn passed_over(&self, catalog_number: u32) -> Option<&Elements> {
        self.passed_over.get(&catalog_number).map(|aside| &*aside.newest)
    }

    /// Adds the elements of `source`. The newest epoch of an object wins, whatever the order of
    /// merging, unless it lies more than [`MAX_EPOCH_AHEAD`] ahead. A set without a name keeps the known name.
    pub fn merge(&mut self, report: ReadReport, source: &str) -> MergeSummary {
        let mut summary = MergeSummary {
            refused: report.refused,
            refused_unlisted: report.refused_unlisted,
            notes: report.notes,
            nothing: report.nothing,
            ..MergeSummary::default()
        };
        let group = self.group(source);
        let known = self.entries.len();
        let mut clock = self.clock;
        let mut members: Vec<u32> = Vec::with_capacity(report.elements.len());
        self.entries.reserve(report.elements.len());
        for elements in report.elements {
            let number = elements.catalog_number();
            let entry = Entry { elements: self.shared(elements), group };
            members.push(number);
            if let Some(sets) = self.candidates.get_mut(&number) {
                sets.push(entry.clone());
            }
            let (sorted, _) = self.entries.split_at_mut(known);
            let place = sorted.binary_search_by_key(&number, Entry::number).ok();
            match place.and_then(|place| sorted.get_mut(place)) {
                Some(current) => {
                    let other = settle(current, entry, &mut clock, &mut summary);
                    self.superseded.extend(other);
                }
                None => self.entries.push(entry),
            }
        }
        // The sort is stable, so that sets of one object stay in the order of the text.
        self.entries.sort_by_key(Entry::number);
        let superseded = &mut self.superseded;
        self.entries.dedup_by(|later, current| {
            let is_same = later.number() == current.number();
            if is_same {
                superseded.extend(settle(current, later.clone(), &mut clock, &mut summary));
            }
            is_same
        });
        self.clock = clock;
        summary.added = self.entries.len() - known;
        if let Some(group) = self.groups.get_mut(group as usize) {
            group.members.extend(members);
            group.members.sort_unstable();
            group.members.dedup();
        }
        summary
    }

    /// Shares the memory of the sets that `previous` has too. Call it before the merges.
    pub fn share_with(&mut self, previous: &Arc<Self>) {
        self.previous = Arc::downgrade(previous);
    }

    fn shared(&self, elements: Elements) -> Arc<Elements> {
        let previous = self.previous.upgrade();
        let known = previous.as_ref().and_then(|all| all.entry(elements.catalog_number()));
        let same = known.filter(|known| *known.elements == elements);
        same.map_or_else(|| Arc::new(elements), |same| Arc::clone(&same.elements))
    }

    /// Index of the group called `name`, which is added if it is new.
    fn group(&mut self, name: &str) -> u32 {
        let place = self.groups.iter().position(|group| group.name == name).unwrap_or_else(|| {
            self.groups.push(Group { name: name.to_owned(), members: Vec::new() });
            self.groups.len() - 1
        });
        place as u32
    }

    pub fn get(&self, catalog_number: u32) -> Option<&Elements> {
        self.entry(catalog_number).map(|entry| &*entry.elements)
    }

    fn entry(&self, catalog_number: u32) -> Option<&Entry> {
        let place = self.entries.binary_search_by_key(&catalog_number, Entry::number).ok()?;
        self.entries.get(place)
    }

    /// The source of the elements in use of an object: the first that gave the newest set, or
    /// that of the older set in its place.
    pub fn source_of(&self, catalog_number: u32) -> Option<&str> {
        let aside = self.set_aside.get(&catalog_number);
        if let Some(aside) = aside.or_else(|| self.passed_over.get(&catalog_number)) {
            return Some(&aside.source_in_use);
        }
        self.source_of_newest(catalog_number)
    }

    fn source_of_newest(&self, catalog_number: u32) -> Option<&str> {
        let group = self.entry(catalog_number)?.group;
        Some(self.groups.get(group as usize)?.name.as_str())
    }

    /// Uses `older`, which `source` gave, in place of the newest set of its object. To be called
    /// after all merges.
    pub fn use_in_place(&mut self, mut older: Elements, source: &str) {
        let number = older.catalog_number();
        let Ok(place) = self.entries.binary_search_by_key(&number, Entry::number) else { return };
        let Some(current) = self.entries.get_mut(place) else { return };
        if current.elements.epoch() == older.epoch() {
            return;
        }
        older.take_name(&current.elements);
        let newest = std::mem::replace(&mut current.elements, Arc::new(older));
        let aside = SetAside { newest, source_in_use: source.to_owned() };
        self.set_aside.insert(number, aside);
    }

    /// The newest set of an object of which an older one is in use.
    pub fn set_aside(&self, catalog_number: u32) -> Option<&Elements> {
        self.set_aside.get(&catalog_number).map(|aside| &*aside.newest)
    }

    /// All newest sets that are not in use, each with its source.
    pub fn all_set_aside(&self) -> impl Iterator<Item = (&Elements, &str)> {
        self.set_aside.iter().chain(&self.passed_over).map(|(number, aside)| {
            (&*aside.newest, self.source_of_newest(*number).unwrap_or_default())
        })
    }

    /// The sources in the order of merging, each with the number of objects whose newest set is
    /// its own.
    pub fn in_use(&self) -> Vec<(&str, usize)> {
        let mut counted: Vec<_> =
            self.groups.iter().map(|group| (group.name.as_str(), 0)).collect();
        for entry in &self.entries {
            if let Some((_, count)) = counted.get_mut(entry.group as usize) {
                *count += 1;
            }
        }
        counted
    }

    /// The sources in the order of merging, each with the number of its objects.
    pub fn groups(&self) -> impl Iterator<Item = (&str, usize)> {
        self.groups.iter().map(|group| (group.name.as_str(), group.members.len()))
    }

    /// All sources that hold an object, whichever of them has the newest set.
    pub fn groups_of(&self, catalog_number: u32) -> impl Iterator<Item = &str> {
        self.groups
            .iter()
            .filter(move |group| group.members.binary_search(&catalog_number).is_ok())
            .map(|group| group.name.as_str())
    }

    /// The elements of all objects that the source `group` holds, in order of catalog number.
    pub fn in_group(&self, group: &str) -> impl Iterator<Item = &Elements> {
        self.groups
            .iter()
            .filter(move |known| known.name == group)
            .flat_map(|known| &known.members)
            .filter_map(|number| self.get(*number))
    }

    /// At most `limit` objects whose number starts with `text` or whose name contains it in any
    /// case, sorted by name, then by number. An empty text finds all objects.
    pub fn search(&self, text: &str, limit: usize) -> Vec<&Elements> {
        search(self.iter(), text, limit)
    }

    /// Like [`Self::search`], among the objects of one source.
    pub fn search_group(&self, group: &str, text: &str, limit: usize) -> Vec<&Elements> {
        search(self.in_group(group), text, limit)
    }

    /// All elements, in order of catalog number.
    pub fn iter(&self) -> impl Iterator<Item = &Elements> {
        self.entries.iter().map(|entry| &*entry.elements)
    }

    /// The elements at `places` in the order of [`Self::iter`].
    pub fn range(&self, places: Range<usize>) -> impl Iterator<Item = &Elements> {
        self.iter().take(places.end).skip(places.start)
    }

    /// Takes the sets that were merged and are not in use, each with the name of its source.
    pub fn take_superseded(&mut self) -> Vec<(Elements, String)> {
        let sets = std::mem::take(&mut self.superseded);
        let name = |group: u32| self.groups.get(group as usize).map(|group| group.name.clone());
        let owned =
            |set: Entry| (Arc::unwrap_or_clone(set.elements), name(set.group).unwrap_or_default());
        sets.into_iter().map(owned).collect()
    }

    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub fn newest_epoch(&self) -> Option<Timestamp> {
        self.newest_of(self.iter())
    }
}

/// Keeps the better of two sets of one object in `current`; returns the other, unless it is of the
/// same epoch.
fn settle(
    current: &mut Entry,
    mut other: Entry,
    clock: &mut EpochClock,
    summary: &mut MergeSummary,
) -> Option<Entry> {
    let order = clock.compare([other.elements.epoch(), current.elements.epoch()]);
    match order {
        Ordering::Greater => {
            std::mem::swap(current, &mut other);
            summary.updated += 1;
        }
        Ordering::Equal => summary.known += 1,
        Ordering::Less => summary.older += 1,
    }
    take_name(&mut current.elements, &other.elements);
    (order != Ordering::Equal).then_some(other)
}

/// [`Elements::take_name`], which copies shared elements only if they lack a name.
fn take_name(elements: &mut Arc<Elements>, other: &Elements) {
    if elements.lacks_name() {
        Arc::make_mut(elements).take_name(other);
    }
}

fn search<'a>(
    among: impl Iterator<Item = &'a Elements>,
    text: &str,
    limit: usize,
) -> Vec<&'a Elements> {
    let text = text.trim().to_lowercase();
    let mut found: Vec<(String, &Elements)> = among
        .map(|elements| (elements.name().to_lowercase(), elements))
        .filter(|(name, elements)| {
            name.contains(&text) || elements.catalog_number().to_string().starts_with(&text)
        })
        .collect();
    found.sort_by(|(a, first), (b, second)| {
        a.cmp(b).then(first.catalog_number().cmp(&second.catalog_number()))
    });
    found.into_iter().take(limit).map(|(_, elements)| elements).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_elements;

    /// An OMM list of objects given as number, name and day of August 2026.
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
        let is_shared =
            |number| std::ptr::eq(before.get(number).unwrap(), after.get(number).unwrap());
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

    /// A catalog with these sources, each with the day of its set of object 5, and this order.
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
        for (order, sources, wanted) in [
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
            assert_eq!((catalog.source_of(5).unwrap(), day(in_use)), wanted, "{sources:?}");
            assert_eq!(in_use.name(), "FIVE");
            let newest = sources.iter().map(|(_, day)| *day).max().unwrap_or(1);
            let passed_over = catalog.passed_over(5).map(day);
            assert_eq!(passed_over, Some(newest).filter(|newest| *newest != wanted.1));
            assert_eq!(catalog.all_set_aside().count(), usize::from(passed_over.is_some()));
            assert_eq!((catalog.set_aside(5), catalog.passed_over(6)), (None, None));
        }
    }

    #[test]
    fn a_set_with_an_epoch_ahead_does_not_win_over_a_current_one() {
        let at = |text: &str| -> Timestamp { text.parse().unwrap() };
        let now = at("2026-08-12T12:00:00Z");
        for (days, wanted) in [
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
            let mut together = Catalog::default();
            together.set_time(now);
            together.merge(report(&own), "one");
            let mut apart = Catalog::default();
            apart.set_time(now);
            for set in own {
                apart.merge(report(&[set]), &set.2.to_string());
            }
            for catalog in [together, apart] {
                let epoch = catalog.get(5).unwrap().epoch();
                assert_eq!(epoch, at(&format!("2026-08-{wanted:02}T00:00:00Z")), "{days:?}");
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
        let at = |text: &str| -> Timestamp { text.parse().unwrap() };
        let mut catalog = Catalog::default();
        catalog.set_time(at("2026-08-12T12:00:00Z"));
        catalog.merge(report(&[(5, "FIVE", 12), (5, "FIVE", 20), (6, "ALONE", 30)]), "own");
        for (now, expected) in [
            ("2026-08-12T12:00:00Z", false),
            ("2026-08-18T23:00:00Z", false),
            ("2026-08-19T00:00:01Z", true),
            ("2026-08-11T00:00:01Z", false),
            ("1970-01-01T00:00:00Z", true),
        ] {
            assert_eq!(catalog.is_outdated(at(now)), expected, "{now}");
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
        assert_eq!((first.added, first.updated, first.known), (2, 0, 0));
        let second = catalog.merge(report(&[(5, "NEW", 11), (6, "STALE", 11)]), "second");
        assert_eq!((second.added, second.updated, second.known), (0, 1, 0));
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
        assert_eq!((summary.added, summary.updated, summary.known), (2, 1, 1));
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
        let of = |number| catalog.source_of(number);
        assert_eq!(
            [5, 6, 7, 9].map(of),
            [Some("weather"), Some("own"), Some("own"), Some("weather")]
        );
        assert_eq!(of(8), None);
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
        let objects =
            [(25_544, "ISS", 1), (255, "Noaa 19", 1), (7, "METEOR 25", 1), (8, "Iss 2", 1)];
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
}
