//! The passes of some satellites, and the search for the next list in the
//! background. The list that is held stays until the next one is whole.

use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

use jiff::Timestamp;

use super::{
    PassKey,
    outlook::{Followed, Forecast},
    search::{Basis, Found, search},
};
use crate::{
    astro::time::{add_seconds, seconds_between},
    job::{Job, Wake},
};

/// A list older than this is made anew.
const STALE_S: f64 = 600.0;
/// The AOS of one pass in two lists is at most so far apart.
const SAME_AOS_S: f64 = 60.0;

/// Passes of some satellites.
#[derive(Default)]
pub struct Listing {
    /// The satellites, in the order of the station or by catalogue number.
    pub satellites: Vec<Arc<Followed>>,
    /// Passes that are not over yet, by AOS, then by catalogue number. In a
    /// list of all satellites those that are always up come last.
    pub passes: Vec<Forecast>,
    /// Another number whenever the passes are others.
    pub edition: u64,
    made: Option<(Basis, Timestamp)>,
    search: Option<Search>,
    halted: Option<Basis>,
    broke_off: bool,
}

struct Search {
    basis: Basis,
    at: Timestamp,
    progress: Arc<Progress>,
    job: Option<Job<Found>>,
}

/// How far a search has come. Written by its threads.
#[derive(Default)]
pub(super) struct Progress {
    pub(super) done: AtomicUsize,
    pub(super) of: AtomicUsize,
}

/// What is being done for the next list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Nothing: the list is the wanted one.
    Nothing,
    /// A search is under way.
    UnderWay {
        /// Satellites that are done.
        done: usize,
        /// All satellites; 0 while they are being prepared.
        of: usize,
    },
    /// The operator has cancelled it.
    Cancelled,
}

impl Listing {
    /// What is being done for the next list.
    pub fn work(&self) -> Work {
        match (&self.search, &self.halted) {
            (Some(Search { progress, .. }), _) => Work::UnderWay {
                done: progress.done.load(Ordering::Relaxed),
                of: progress.of.load(Ordering::Relaxed),
            },
            (None, Some(_)) => Work::Cancelled,
            (None, None) => Work::Nothing,
        }
    }

    /// When the search for this list began; `None` before the first list.
    pub fn made_at(&self) -> Option<Timestamp> {
        self.made.as_ref().map(|(_, at)| *at)
    }

    /// The last search broke off. The list before stays.
    pub(in crate::app) fn broke_off(&self) -> bool {
        self.broke_off
    }

    /// Ends the search under way. The next begins when the operator wants it
    /// or something else is asked for.
    pub(in crate::app) fn cancel(&mut self) {
        self.halted = self.search.take().map(|search| search.basis);
    }

    /// Begins the cancelled search again, with the next refresh.
    pub(in crate::app) fn resume(&mut self) {
        self.halted = None;
    }

    /// Takes a finished list, drops what is over, and begins a new search when
    /// the list was made from something else than `basis` or has grown old.
    /// `true` when the list is a new one.
    pub(super) fn refresh(&mut self, basis: &Basis, now: Timestamp, wake: &Wake) -> bool {
        let renewed = self.take_finished();
        self.drop_over(now);
        let fresh = self.made.as_ref().is_some_and(|(made_of, at)| {
            made_of == basis && seconds_between(*at, now).abs() < STALE_S
        });
        if fresh || self.halted.as_ref().is_some_and(|halted| halted != basis) {
            self.halted = None;
        }
        let coming = self.search.as_ref().is_some_and(|search| search.basis == *basis);
        if fresh {
            self.search = None;
        } else if !coming && self.halted.is_none() {
            self.begin(basis, now, wake);
        }
        renewed
    }

    /// Forgets the list when it was made from another place than `basis`.
    pub(super) fn keep_only_from(&mut self, basis: &Basis) {
        self.search = None;
        if self.made.as_ref().is_some_and(|(made_of, _)| made_of.vantage != basis.vantage) {
            *self = Self { edition: self.edition + 1, ..Self::default() };
        }
    }

    fn begin(&mut self, basis: &Basis, now: Timestamp, wake: &Wake) {
        // Preparing a whole catalogue takes as long as many searches.
        let prepared = self
            .made
            .as_ref()
            .filter(|(made_of, _)| made_of.has_satellites_of(basis))
            .map(|_| self.satellites.clone());
        let progress = Arc::new(Progress::default());
        let (wanted, told, shown) = (basis.clone(), Arc::clone(&progress), Arc::clone(wake));
        let job = Job::start("azel-passes", Arc::clone(wake), move |cancelled| {
            search(&wanted, prepared, now, &told, &shown, cancelled)
        });
        match job {
            Ok(job) => {
                let job = Some(job);
                self.search = Some(Search { basis: basis.clone(), at: now, progress, job });
            }
            Err(error) => {
                tracing::error!(%error, "no thread for the passes");
                self.halted = Some(basis.clone());
            }
        }
    }

    fn take_finished(&mut self) -> bool {
        let Some(end) = self.search.as_mut().and_then(|search| Job::take(&mut search.job)) else {
            return false;
        };
        let Ok(found) = end else {
            // The same elements would break the next search too: the operator begins it.
            self.cancel();
            self.broke_off = true;
            return false;
        };
        self.broke_off = false;
        self.made = self.search.take().map(|search| (search.basis, search.at));
        self.satellites = found.satellites;
        self.passes = found.passes;
        self.edition += 1;
        true
    }

    pub(super) fn drop_over(&mut self, now: Timestamp) {
        let is_over = |forecast: &&Forecast| forecast.pass.los.time <= now;
        let (dated, always_up) = self.parts();
        // What is over has begun: the rest of a long list need not be looked at.
        let begun = dated.iter().take_while(|forecast| forecast.pass.aos.time <= now);
        if begun.chain(always_up).any(|forecast| is_over(&forecast)) {
            self.passes.retain(|forecast| !is_over(&forecast));
            self.edition += 1;
        }
    }

    /// The passes that begin in the next `span_h` hours, in a list by AOS.
    pub fn within(&self, now: Timestamp, span_h: u32) -> &[Forecast] {
        let end = add_seconds(now, f64::from(span_h) * 3600.0);
        let count = self.passes.partition_point(|forecast| forecast.pass.aos.time < end);
        self.passes.get(..count).unwrap_or_default()
    }

    /// The place of the pass of `key` in the list. After a new list its AOS may
    /// differ by a little.
    pub fn place(&self, (number, aos): PassKey) -> Option<usize> {
        let (dated, always_up) = self.parts();
        let is_its = |forecast: &Forecast| forecast.number() == number;
        // A list begins with the passes that are cut at its start.
        let cut = dated.iter().take_while(|forecast| forecast.pass.starts_before).enumerate();
        let standing = (dated.len()..).zip(always_up);
        let mut early = cut.chain(standing);
        if let Some((place, _)) =
            early.find(|(_, forecast)| is_its(forecast) && aos < forecast.pass.los.time)
        {
            return Some(place);
        }
        let (from, to) = (add_seconds(aos, -SAME_AOS_S), add_seconds(aos, SAME_AOS_S));
        let first = dated.partition_point(|forecast| forecast.pass.aos.time <= from);
        let near = dated.iter().enumerate().skip(first);
        near.take_while(|(_, forecast)| forecast.pass.aos.time < to)
            .find_map(|(place, forecast)| is_its(forecast).then_some(place))
    }

    /// The passes by AOS, and those behind them that are always up.
    fn parts(&self) -> (&[Forecast], &[Forecast]) {
        let behind = self.passes.iter().rev().take_while(|forecast| forecast.is_always_up());
        self.passes.split_at(self.passes.len() - behind.count())
    }

    /// The pass of `key`.
    pub fn find(&self, key: PassKey) -> Option<&Forecast> {
        self.passes.get(self.place(key)?)
    }
}
