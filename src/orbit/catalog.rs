//! The catalog: all elements that the operator has. Each object has its newest set, or an older set
//! if the operator uses it or prefers its source.

use std::{
    cmp::Ordering,
    collections::{BTreeMap, BTreeSet},
    ops::Range,
    sync::{Arc, Weak},
};

use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::{Elements, Note, Nothing, ReadReport, Refusal};

/// Max age difference between the set of a preferred source and the newest set, while the preferred
/// source stays in use. The limit compares epochs, not ages: a set that no other source renews is
/// still the best set.
pub const SOURCE_LAG: SignedDuration = SignedDuration::from_hours(72);

/// Max lead of an epoch over the time of use. A set with a later epoch replaces no other set.
/// Sources give the next node of an orbit as epoch, which is up to a day ahead. Sets of future
/// launches and sets with a damaged epoch lie farther ahead.
pub const MAX_EPOCH_AHEAD: SignedDuration = SignedDuration::from_hours(24);

/// Names of the sources that an object prefers, best first, by catalog number.
pub type SourceOrders = BTreeMap<u32, Vec<String>>;

#[derive(Debug, Clone, Default)]
pub struct Catalog {
    /// Entries by catalog number. A sorted list takes half the memory of a map.
    entries: Vec<Entry>,
    groups: Vec<Group>,
    /// Sets that newer sets have replaced.
    superseded: Vec<Entry>,
    /// Newest sets of the objects for which the operator uses an older set, by catalog number.
    set_aside: BTreeMap<u32, SetAside>,
    /// Newest sets of the objects whose preferred source has an older set, by catalog number.
    passed_over: BTreeMap<u32, SetAside>,
    orders: SourceOrders,
    /// All sets of the objects with an order of sources.
    candidates: BTreeMap<u32, Vec<Entry>>,
    /// Objects with an order of sources whose set the operator has chosen.
    chosen: BTreeSet<u32>,
    /// Catalog in use, whose equal sets are shared.
    previous: Weak<Self>,
    clock: EpochClock,
}

/// Judge of the better of two sets of one object at a time.
#[derive(Debug, Clone, Copy, Default)]
struct EpochClock {
    /// Time of use; `None` in a catalog without a time: the newest epoch is the best.
    now: Option<Timestamp>,
    /// Earliest compared epoch that lies too far ahead.
    ahead: Option<Timestamp>,
    /// Latest compared epoch that does not lie too far ahead.
    current: Option<Timestamp>,
}

impl EpochClock {
    fn is_ahead(now: Timestamp, epoch: Timestamp) -> bool {
        epoch.duration_since(now) > MAX_EPOCH_AHEAD
    }

    /// Returns the rank of an epoch. The newest epoch that does not lie too far ahead has the
    /// highest rank. Among epochs too far ahead, the nearest has the highest rank.
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

/// The newest set of an object while an older set is in use.
#[derive(Debug, Clone)]
struct SetAside {
    newest: Arc<Elements>,
    /// Source of the set in use.
    source_in_use: String,
}

/// The elements of an object, and the group whose source gave them.
#[derive(Debug, Clone)]
struct Entry {
    /// Elements, shared by the catalogs before and after a new reading of the sources.
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
    /// Objects that got a better set.
    pub updated: usize,
    /// Sets with the same epoch as the existing set.
    #[serde(rename = "known")]
    pub unchanged: usize,
    /// Sets that were left out because they are older than the existing set, or too far ahead.
    pub older: usize,
    /// Objects that could not be read.
    pub refused: Vec<Refusal>,
    /// Number of refused objects beyond those listed.
    pub refused_unlisted: usize,
    /// Oddities of sets that were accepted.
    pub notes: Vec<Note>,
    /// Reason why there was nothing to merge, if so.
    pub nothing: Option<Nothing>,
}

impl Catalog {
    /// Sets the orders of sources. The call must come before the merges of these sources;
    /// [`Self::apply_orders`] applies the orders after them.
    pub fn set_orders(&mut self, orders: SourceOrders) {
        self.candidates = orders.keys().map(|number| (*number, Vec::new())).collect();
        self.orders = orders;
    }

    /// Sets the time at which the sets are used. The call must come before the merges.
    pub fn set_time(&mut self, now: Timestamp) {
        self.clock.now = Some(now);
    }

    /// Returns `true` if the merges would choose other sets at `now`. Either a set that lay too far
    /// ahead no longer does so, or the clock was set back.
    pub fn is_outdated(&self, now: Timestamp) -> bool {
        self.clock.is_outdated(now)
    }

    /// Returns `true` if a set of `epoch` is preferred to a set of `other`.
    pub fn is_better(&self, epoch: Timestamp, other: Timestamp) -> bool {
        self.clock.rank(epoch) > self.clock.rank(other)
    }

    /// Returns the newest epoch of `sets` that does not lie more than [`MAX_EPOCH_AHEAD`] ahead. If
    /// all epochs do, returns the nearest.
    pub fn newest_of<'a>(&self, sets: impl IntoIterator<Item = &'a Elements>) -> Option<Timestamp> {
        let epochs = sets.into_iter().map(Elements::epoch);
        epochs.max_by_key(|epoch| self.clock.rank(*epoch))
    }

    /// Applies the order of sources of each object. Uses the set of the first source that is at
    /// most [`SOURCE_LAG`] older than the newest set. Without such a source, the newest set stays
    /// in use. Skips the objects for which `has_choice` returns true, because the operator has
    /// chosen their set.
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
        let set_aside = SetAside { newest, source_in_use: source_in_use.unwrap_or_default() };
        self.passed_over.insert(number, set_aside);
    }

    /// Returns `true` if the operator has chosen the set of an object, which overrides its order.
    pub fn is_chosen(&self, catalog_number: u32) -> bool {
        self.chosen.contains(&catalog_number) || self.set_aside.contains_key(&catalog_number)
    }

    /// Returns the newest set of an object whose preferred source has an older one.
    pub fn passed_over(&self, catalog_number: u32) -> Option<&Elements> {
        self.passed_over.get(&catalog_number).map(|set_aside| &*set_aside.newest)
    }

    /// Adds the elements of `source`. The newest epoch of an object wins in any order of merging,
    /// unless the epoch lies more than [`MAX_EPOCH_AHEAD`] ahead. A set without a name keeps the
    /// known name.
    pub fn merge(&mut self, report: ReadReport, source: &str) -> MergeSummary {
        let mut summary = MergeSummary {
            refused: report.refused,
            refused_unlisted: report.refused_unlisted,
            notes: report.notes,
            nothing: report.nothing,
            ..MergeSummary::default()
        };
        let group = self.group(source);
        let previous_count = self.entries.len();
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
            let (sorted, _) = self.entries.split_at_mut(previous_count);
            let place = sorted.binary_search_by_key(&number, Entry::number).ok();
            match place.and_then(|place| sorted.get_mut(place)) {
                Some(current) => {
                    let other = settle(current, entry, &mut clock, &mut summary);
                    self.superseded.extend(other);
                }
                None => self.entries.push(entry),
            }
        }
        // The sort is stable, so sets of one object stay in the order of the text.
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
        summary.added = self.entries.len() - previous_count;
        if let Some(group) = self.groups.get_mut(group as usize) {
            group.members.extend(members);
            group.members.sort_unstable();
            group.members.dedup();
        }
        summary
    }

    /// Shares the memory of sets that are also in `previous`. The call must come before the merges.
    pub fn share_with(&mut self, previous: &Arc<Self>) {
        self.previous = Arc::downgrade(previous);
    }

    fn shared(&self, elements: Elements) -> Arc<Elements> {
        let previous = self.previous.upgrade();
        let previous_entry = previous.as_ref().and_then(|all| all.entry(elements.catalog_number()));
        let same = previous_entry.filter(|entry| *entry.elements == elements);
        same.map_or_else(|| Arc::new(elements), |same| Arc::clone(&same.elements))
    }

    /// Returns the index of the group called `name`, and adds a new group if necessary.
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

    /// Returns the source of the elements in use for an object. It is the source of the older set
    /// in use, or else the first source that gave the newest set.
    pub fn source_of(&self, catalog_number: u32) -> Option<&str> {
        let set_aside = self.set_aside.get(&catalog_number);
        if let Some(set_aside) = set_aside.or_else(|| self.passed_over.get(&catalog_number)) {
            return Some(&set_aside.source_in_use);
        }
        self.source_of_newest(catalog_number)
    }

    fn source_of_newest(&self, catalog_number: u32) -> Option<&str> {
        let group = self.entry(catalog_number)?.group;
        Some(self.groups.get(group as usize)?.name.as_str())
    }

    /// Uses `older` from `source` in place of the newest set of its object. The call must come
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
        let set_aside = SetAside { newest, source_in_use: source.to_owned() };
        self.set_aside.insert(number, set_aside);
    }

    /// Returns the newest set of an object for which the operator uses an older set.
    pub fn set_aside(&self, catalog_number: u32) -> Option<&Elements> {
        self.set_aside.get(&catalog_number).map(|entry| &*entry.newest)
    }

    /// Returns all newest sets that are not in use, each with its source.
    pub fn all_set_aside(&self) -> impl Iterator<Item = (&Elements, &str)> {
        self.set_aside.iter().chain(&self.passed_over).map(|(number, set_aside)| {
            (&*set_aside.newest, self.source_of_newest(*number).unwrap_or_default())
        })
    }

    /// Returns the sources in the order of merging, each with the number of objects whose newest
    /// set it gave.
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

    /// Returns the sources in the order of merging, each with the number of its objects.
    pub fn groups(&self) -> impl Iterator<Item = (&str, usize)> {
        self.groups.iter().map(|group| (group.name.as_str(), group.members.len()))
    }

    /// Returns all sources that have an object, even those without its newest set.
    pub fn groups_of(&self, catalog_number: u32) -> impl Iterator<Item = &str> {
        self.groups
            .iter()
            .filter(move |group| group.members.binary_search(&catalog_number).is_ok())
            .map(|group| group.name.as_str())
    }

    /// Returns the elements of all objects of the source `group`, in order of catalog number.
    pub fn in_group(&self, group: &str) -> impl Iterator<Item = &Elements> {
        self.groups
            .iter()
            .filter(move |candidate| candidate.name == group)
            .flat_map(|candidate| &candidate.members)
            .filter_map(|number| self.get(*number))
    }

    /// Returns at most `limit` objects whose number starts with `text` or whose name contains it in
    /// any case. The objects are sorted by name, then by number. An empty text finds all objects.
    pub fn search(&self, text: &str, limit: usize) -> Vec<&Elements> {
        search(self.iter(), text, limit)
    }

    /// Returns the same as [`Self::search`], among the objects of one source.
    pub fn search_group(&self, group: &str, text: &str, limit: usize) -> Vec<&Elements> {
        search(self.in_group(group), text, limit)
    }

    /// Returns all elements, in order of catalog number.
    pub fn iter(&self) -> impl Iterator<Item = &Elements> {
        self.entries.iter().map(|entry| &*entry.elements)
    }

    /// Returns the elements at `places` in the order of [`Self::iter`].
    pub fn range(&self, places: Range<usize>) -> impl Iterator<Item = &Elements> {
        self.iter().take(places.end).skip(places.start)
    }

    /// Removes and returns the merged sets that are not in use, each with the name of its source.
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

/// Keeps the better of two sets of one object in `current`. Returns the other, unless both have the
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
        Ordering::Equal => summary.unchanged += 1,
        Ordering::Less => summary.older += 1,
    }
    take_name(&mut current.elements, &other.elements);
    (order != Ordering::Equal).then_some(other)
}

/// Calls [`Elements::take_name`], but copies shared elements only if they lack a name.
fn take_name(elements: &mut Arc<Elements>, other: &Elements) {
    if elements.lacks_name() {
        Arc::make_mut(elements).take_name(other);
    }
}

fn search<'a>(
    candidates: impl Iterator<Item = &'a Elements>,
    text: &str,
    limit: usize,
) -> Vec<&'a Elements> {
    let text = text.trim().to_lowercase();
    let mut found: Vec<(String, &Elements)> = candidates
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
mod tests;
