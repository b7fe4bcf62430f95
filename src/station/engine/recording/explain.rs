//! Explanation of a pass's error while an antenna tracks the pass.

use std::path::Path;

use jiff::Timestamp;

use super::reports::{Followed, others_of};
use crate::{
    astro::time::{add_seconds, seconds_between},
    engine::Engine,
    job::{Job, Wake},
    library::History,
    plan::{
        MountLimits,
        pass_report::{Evidence, MeasuredPosition, TrackedPass},
    },
};

/// Min time between two searches for a cause, seconds.
const EVERY_S: f64 = 10.0;
/// Max age of the positions used, seconds: older errors may be corrected by now.
const SINCE_S: f64 = 180.0;
/// Min error that needs a cause, as a share of half the beamwidth.
const MIN_SHARE: f64 = 0.5;

impl Engine {
    /// Searches for the causes of errors in current passes, and shows them.
    pub(super) fn explain_passes(&mut self) {
        // A rehearsal has no window that could show a cause.
        if self.recording.recorder.is_none() {
            return;
        }
        let (now, wake) = (self.now, &self.wake);
        let library = self.places.library();
        for pass in &mut self.recording.followed {
            pass.explain(now, library, wake);
        }
        for antenna in &mut self.antennas {
            let shown = &mut antenna.shown;
            let is_current = |pass: &&Followed| pass.antenna == shown.id() && now <= pass.end;
            let pass = self.recording.followed.iter().find(is_current).filter(|_| shown.tracks());
            shown.explained = pass.and_then(|pass| pass.live.found.clone());
        }
    }
}

impl Followed {
    fn explain(&mut self, now: Timestamp, library: Option<&Path>, wake: &Wake) {
        if let Some(end) = Job::take(&mut self.live.job) {
            let end = end.ok();
            let (found, others) = end.unzip();
            (self.live.found, self.live.others) = (found.flatten(), others);
        }
        let is_due = self.live.begun.is_none_or(|time| seconds_between(time, now) >= EVERY_S);
        if !is_due || self.live.job.is_some() || now > self.end {
            return;
        }
        self.live.begun = Some(now);
        let start = add_seconds(now, -SINCE_S);
        let young = self.flown.iter().rev().take_while(|flown| flown.time >= start).copied();
        let mut young: Vec<MeasuredPosition> = young.collect();
        young.reverse();
        let (propagator, site) = (self.propagator.clone(), self.site);
        let about_track = self.about_track.clone();
        let (limits, breaks) = (self.limits, self.breaks.clone());
        let trackability = self.live.trackability.unwrap_or_else(|| self.trackability());
        self.live.trackability = Some(trackability);
        let begin = start.max(self.start);
        let (elements, others) = (self.elements.clone(), self.live.others.take());
        let history = library.map(History::new);
        self.live.job = Some(Job::start("azel-explain", Wake::clone(wake), move |_| {
            for flown in &mut young {
                *flown = about_track.compared(&propagator, site, *flown);
            }
            let tracked = TrackedPass {
                propagator: &propagator,
                site,
                start: begin,
                end: now,
                limits,
                trackability,
                ended: None,
                breaks: &breaks,
            };
            let report = tracked.report(&young);
            let MountLimits { has_elevation, mount, half_beam, .. } = limits;
            let evidence = Evidence::new(mount, has_elevation, half_beam).with_pass(
                &propagator,
                site,
                about_track.path_source(site),
                tracked.judged(&report, &young),
            );
            let others = others.unwrap_or_else(|| others_of(&elements, history.as_ref()));
            (evidence.explained(MIN_SHARE * half_beam.degrees(), &others), others)
        }));
    }
}
