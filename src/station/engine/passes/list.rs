//! Pass list, and the background search for the next one. A list stays until the next list is
//! complete.

use std::sync::{Arc, atomic::Ordering};

use jiff::Timestamp;

use super::search::{Found, Progress, SearchKey, prepared, search};
use crate::{
    astro::time::seconds_between,
    contract::passes::{PassList, Work},
    job::{Job, Wake},
    orbit::Elements,
};

/// Max age of a list before a new search, seconds.
const STALE_S: f64 = 600.0;

/// Current list, and the search for the next one.
#[derive(Default)]
pub(in crate::engine) struct Search {
    pub(super) list: PassList,
    made_of: Option<SearchKey>,
    running: Option<Running>,
    halted: Option<SearchKey>,
    broke_off: bool,
}

struct Running {
    key: SearchKey,
    time: Timestamp,
    progress: Arc<Progress>,
    job: Option<Job<Found>>,
}

impl Search {
    /// Returns the list, with the state of the search for the next one.
    pub(super) fn shown(&self) -> PassList {
        let work = match (&self.running, &self.halted) {
            (Some(Running { progress, .. }), _) => Work::UnderWay {
                done: progress.done.load(Ordering::Relaxed),
                total: progress.total.load(Ordering::Relaxed),
            },
            (None, Some(_)) => Work::Cancelled,
            (None, None) => Work::Nothing,
        };
        PassList { work, ..self.list.clone() }
    }

    /// Returns `true` if the last search broke off. The previous list then stays.
    pub(in crate::engine) fn broke_off(&self) -> bool {
        self.broke_off
    }

    /// Ends the current search. The next one begins when the operator asks for it or the search key
    /// changes.
    pub(in crate::engine) fn cancel(&mut self) {
        self.halted = self.running.take().map(|search| search.key);
    }

    /// Lets the next refresh restart the cancelled search.
    pub(in crate::engine) fn resume(&mut self) {
        self.halted = None;
    }

    /// Adopts a finished list, and begins a new search if the list has another key or is too old.
    pub(super) fn refresh(&mut self, key: &SearchKey, now: Timestamp, wake: &Wake) {
        self.take_finished();
        let is_young = |time: Timestamp| seconds_between(time, now).abs() < STALE_S;
        let fresh = self.made_of.as_ref() == Some(key) && self.list.made_at.is_some_and(is_young);
        if fresh || self.halted.as_ref().is_some_and(|halted| halted != key) {
            self.halted = None;
        }
        let coming = self.running.as_ref().is_some_and(|search| search.key == *key);
        if fresh {
            self.running = None;
        } else if !coming && self.halted.is_none() {
            self.begin(key, now, wake);
        }
    }

    /// Ends the search, and drops the list if its observer differs from the one of `key`.
    pub(super) fn keep_only_from(&mut self, key: &SearchKey) {
        self.running = None;
        if self.made_of.as_ref().is_some_and(|made_of| made_of.observer != key.observer) {
            let list = PassList { revision: self.list.revision + 1, ..PassList::default() };
            *self = Self { list, ..Self::default() };
        }
    }

    fn begin(&mut self, key: &SearchKey, now: Timestamp, wake: &Wake) {
        // Reuse prepared satellites: preparing a whole catalog takes as long as many searches.
        let is_prepared = |made_of: &&SearchKey| made_of.has_satellites_of(key);
        let prepared = self.made_of.as_ref().filter(is_prepared);
        let prepared = prepared.map(|_| Arc::clone(&self.list.satellites));
        let progress = Arc::new(Progress::default());
        let (search_key, counter, shown) = (key.clone(), Arc::clone(&progress), Arc::clone(wake));
        let job = Job::start("azel-passes", Arc::clone(wake), move |cancelled| {
            search(&search_key, prepared, now, &counter, &shown, cancelled)
        });
        self.running = Some(Running { key: key.clone(), time: now, progress, job: Some(job) });
    }

    fn take_finished(&mut self) {
        let Some(end) = self.running.as_mut().and_then(|search| Job::take(&mut search.job)) else {
            return;
        };
        let Ok(found) = end else {
            // The same elements would also break the next search, so only the operator restarts it.
            self.cancel();
            self.broke_off = true;
            return;
        };
        self.broke_off = false;
        let Some(Running { key, time, .. }) = self.running.take() else { return };
        self.made_of = Some(key);
        self.list = PassList {
            satellites: found.satellites,
            passes: Arc::new(found.passes),
            revision: self.list.revision + 1,
            made_at: Some(time),
            work: Work::Nothing,
        };
    }
}

/// Makes the list of a search for `key` at `made_at` from these elements, on this thread.
pub(super) fn again(
    key: &SearchKey,
    elements: &[Elements],
    made_at: Option<Timestamp>,
) -> PassList {
    let satellites = Arc::new(elements.iter().filter_map(prepared).collect());
    let Some(time) = made_at else { return PassList { satellites, ..PassList::default() } };
    let nobody: Wake = Arc::new(|| {});
    let found = search(key, Some(satellites), time, &Progress::default(), &nobody, &|| false);
    PassList {
        satellites: found.satellites,
        passes: Arc::new(found.passes),
        made_at,
        ..PassList::default()
    }
}
