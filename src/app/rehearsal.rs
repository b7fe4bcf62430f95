//! Rehearsal of the plan on a thread, with links to simulated units only.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use jiff::Timestamp;

use super::App;
use crate::{
    astro::time::seconds_between,
    contract::{CatalogState, passes::PassListKey, rehearsal::Rehearsed},
    job::Job,
    model::rehearsal::RehearsalState,
    rehearsal::{Rehearsal, RehearsalError, run},
    sim::Mechanics,
    station::Station,
};

/// Seed of the window's rehearsals: the same plan gives the same result.
const SEED: u64 = 1;
/// Time from the start of a one-pass rehearsal to AOS, seconds.
const BEFORE_S: f64 = 300.0;
/// Min length of a rehearsal, hours.
const SHORTEST_H: f64 = 0.01;

/// Running rehearsal; dropping it cancels it.
#[derive(Default)]
pub(super) struct RehearsalWork {
    job: Option<Job<Result<Rehearsed, RehearsalError>>>,
    /// Completed share, 0 to 1, as the bits of an `f64`.
    share: Arc<AtomicU64>,
}

impl App {
    /// Starts to rehearse the whole plan, or one pass of it.
    pub(super) fn rehearse(&mut self, pass: Option<PassListKey>) {
        let model = &self.model;
        let CatalogState::Ready(catalog) = &model.catalog else { return };
        let predicted = pass.and_then(|key| model.pass_lists.find(key));
        if pass.is_some() && predicted.is_none() {
            return;
        }
        let start = predicted.map_or(model.now, |chosen| {
            let before = crate::astro::time::add_seconds(chosen.pass.aos.time, -BEFORE_S);
            before.max(model.now)
        });
        let end = predicted.map_or_else(|| model.plan_until(), |chosen| chosen.pass.los.time);
        let hours = (seconds_between(start, end) / 3600.0).max(SHORTEST_H);
        let mut station = Station::clone(&model.station);
        if let Some(key) = pass {
            // Other antennas might take the pass instead.
            let own = model.antennas_of(key);
            station.antennas.retain(|antenna| own.contains(&antenna.id));
        }
        let rehearsal = Rehearsal {
            station,
            elements: Arc::clone(catalog),
            start,
            hours,
            seed: SEED,
            mechanics: Mechanics::default(),
            faults: Vec::new(),
            speed: None,
        };
        let share = Arc::<AtomicU64>::default();
        let shown_share = Arc::clone(&share);
        let work = move |is_cancelled: &(dyn Fn() -> bool + Sync)| {
            let tell = |now: Timestamp| {
                let share = seconds_between(rehearsal.start, now) / (rehearsal.hours * 3600.0);
                shown_share.store(share.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
            };
            run(&rehearsal, &tell, is_cancelled)
        };
        let job = Some(Job::start("azel-rehearsal", Arc::clone(&self.wake), work));
        self.rehearsal_work = RehearsalWork { job, share };
        self.model.rehearsal = RehearsalState::UnderWay(0.0);
    }

    /// Cancels the rehearsal, or discards the last result.
    pub(super) fn end_rehearsal(&mut self) {
        self.rehearsal_work = RehearsalWork::default();
        self.model.rehearsal = RehearsalState::None;
    }

    pub(super) fn take_rehearsal(&mut self) {
        let work = &mut self.rehearsal_work;
        let end = Job::take(&mut work.job);
        if work.job.is_some() {
            let share = f64::from_bits(work.share.load(Ordering::Relaxed));
            self.model.rehearsal = RehearsalState::UnderWay(share);
        }
        self.model.rehearsal = match end {
            None => return,
            Some(Ok(Ok(rehearsed))) => {
                RehearsalState::Done { rehearsed: Arc::new(rehearsed), time: self.model.now }
            }
            Some(Ok(Err(error))) => RehearsalState::Failed(error.to_string()),
            Some(Err(broke_off)) => RehearsalState::Failed(broke_off.to_string()),
        };
    }
}
