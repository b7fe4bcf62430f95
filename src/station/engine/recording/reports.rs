//! Reports of the passes that antennas track, however they are tracked: each is written when the
//! pass is over, or when the program ends.

use std::time::{Duration, Instant};

use jiff::Timestamp;

use super::{Recording, live::Live};
use crate::{
    astro::{
        Angle, AzEl, PointingModel, Site,
        time::{add_seconds, apart, seconds_between},
    },
    driver::{PositionLog, TimeSync, TrackView},
    engine::{
        Antenna, CatalogState, Engine, antenna::AntennaModel, passes::mount_limits,
        status::LinkStatus,
    },
    job::{Job, Wake},
    library::History,
    orbit::{Elements, PassSearch, Propagator, passes},
    plan::{
        MountLimits, Sample, TrackPhase, Trackability,
        pass_report::{Breaks, Evidence, FlownOffsets, MeasuredPosition, PassVerdict, TrackedPass},
        trackability,
    },
    record::{AboutTrack, PassNote, RecordedReport, TrackedBy},
    station::AntennaId,
};

/// How far a pass under way may reach back and ahead, seconds. Of a satellite that stays up
/// longer, this much from the beginning of its track is reported.
const REACH_S: f64 = 6.0 * 3600.0;
/// Time from the end of a pass to its report: the last position may still be on its way, seconds.
const AFTER_S: f64 = 3.0;
/// A pass that is not there is looked for again after this time, seconds.
const SOUGHT_AGAIN_S: f64 = 60.0;
/// Time for the reports that are not ready when the record ends.
const LAST_WITHIN: Duration = Duration::from_secs(1);
/// Time between two samples for the trackability, seconds.
const STEP_S: f64 = 2.0;
/// Least time between two points that are kept of the track, seconds.
const POINT_S: f64 = 0.95;

/// A pass that an antenna tracks, or has tracked, until it is over.
pub(super) struct Followed {
    pub(super) antenna: AntennaId,
    pub(super) elements: Elements,
    pub(super) propagator: Propagator,
    pub(super) site: Site,
    /// What counts, above the antenna's own minimum elevation.
    from: Timestamp,
    pub(super) until: Timestamp,
    max_elevation_deg: f64,
    /// When the program ended, if that was before the pass was over.
    ended: Option<Timestamp>,
    pub(super) limits: MountLimits,
    pub(super) about: AboutTrack,
    pub(super) breaks: Breaks,
    positions: PositionLog,
    next_position: u64,
    pub(super) flown: Vec<MeasuredPosition>,
    /// What explains its error so far.
    pub(super) live: Live,
}

impl Engine {
    /// Takes up the passes that antennas track, and reports on those that are over.
    pub(super) fn report_passes(&mut self) {
        if !self.recording.reports() {
            return;
        }
        let finished: Vec<PassNote> =
            self.recording.reports.iter_mut().filter_map(Job::take).flatten().collect();
        self.recording.reports.retain(Option::is_some);
        if !finished.is_empty() {
            self.record_has_grown();
        }
        for note in finished {
            self.recording.tell_pass(note);
        }
        // A pass is long beside a second.
        if self.now.as_second() == self.recording.looked_at {
            return;
        }
        self.recording.looked_at = self.now.as_second();
        for index in 0..self.antennas.len() {
            self.take_up_pass(index);
        }
        let now = self.now;
        self.look_at_passes();
        self.explain_passes();
        self.begin_reports(|pass| seconds_between(pass.until, now) > AFTER_S);
    }

    /// The record ends, with the program or because another one begins: what is known of the passes under
    /// way is written as well.
    pub(in crate::engine) fn report_last_passes(&mut self) {
        let now = self.now;
        self.look_at_passes();
        for pass in &mut self.recording.followed {
            pass.ended = Some(now).filter(|now| *now < pass.until);
        }
        self.begin_reports(|_| true);
        let end = Instant::now() + LAST_WITHIN;
        for job in self.recording.reports.drain(..).flatten() {
            match (
                job.wait(end.saturating_duration_since(Instant::now())),
                &self.recording.recorder,
            ) {
                (Some(note), Some((_, recorder))) => recorder.note_pass(note),
                (None, _) => tracing::error!("a pass without a report: its record ended"),
                (Some(_), None) => {}
            }
        }
    }

    fn look_at_passes(&mut self) {
        for pass in &mut self.recording.followed {
            let antenna = self.antennas.iter().find(|of| of.shown.id() == pass.antenna);
            pass.look(antenna, self.time_sync, self.now);
        }
    }

    fn begin_reports(&mut self, is_ready: impl Fn(&Followed) -> bool) {
        let Recording { followed, reports, .. } = &mut self.recording;
        for pass in followed.extract_if(.., |pass| is_ready(pass)) {
            let history = self.places.library().map(History::beside);
            reports.extend(pass.report(history, &self.wake).map(Some));
        }
    }

    /// Takes up the pass that an antenna tracks now, if it is a new one.
    fn take_up_pass(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let (shown, now) = (&antenna.shown, self.now);
        let Some(number) = shown.tracked_number().filter(|_| shown.tracks()) else { return };
        let is_known = |pass: &Followed| {
            pass.antenna == shown.id()
                && pass.elements.catalog_number() == number
                && now <= pass.until
        };
        if self.recording.followed.iter().any(is_known) {
            return;
        }
        let sought = (shown.id(), number);
        let is_soon = |(of, at): &(_, Timestamp)| {
            *of == sought && seconds_between(*at, now).abs() < SOUGHT_AGAIN_S
        };
        if self.recording.sought.iter().any(is_soon) {
            return;
        }
        let CatalogState::Ready(catalog) = &self.catalog else { return };
        let Some(elements) = catalog.get(number) else { return };
        let Ok(propagator) = Propagator::new(elements) else { return };
        let limits = mount_limits(&shown.config);
        let lowest = self.station.aos_elevation_deg.max(limits.min_elevation.degrees());
        let search = PassSearch {
            aos_elevation: Angle::from_degrees(lowest),
            ..PassSearch::new(
                self.station.site,
                add_seconds(now, -REACH_S),
                add_seconds(now, REACH_S),
            )
        };
        let found = passes(&propagator, &search, &|| false);
        let is_now = |pass: &&crate::orbit::Pass| pass.aos.time <= now && now <= pass.los.time;
        let Some(pass) = found.iter().find(is_now) else {
            self.recording.sought.retain(|((antenna, _), _)| *antenna != sought.0);
            return self.recording.sought.push((sought, now));
        };
        // Of one that does not rise, what was before the track is nobody's loss.
        let from = if pass.starts_before { now } else { pass.aos.time };
        let until = pass.los.time;
        let max_elevation_deg = pass.max_elevation().degrees();
        let followed = Followed {
            antenna: shown.id(),
            elements: elements.clone(),
            propagator,
            site: self.station.site,
            from,
            until,
            max_elevation_deg,
            ended: None,
            limits,
            about: about(shown, now, self.time_sync),
            breaks: Breaks::default(),
            positions: antenna.handle.positions().clone(),
            next_position: 0,
            flown: Vec::new(),
            live: Live::default(),
        };
        self.recording.followed.push(followed);
    }
}

/// The sets in `history` of the satellite of `elements`, with their epochs, but that one.
pub(super) fn others_of(
    elements: &Elements,
    history: Option<&History>,
) -> Vec<(Timestamp, Propagator)> {
    let sets = history.map_or_else(Vec::new, |of| of.of(elements.catalog_number()));
    let others = sets.iter().filter(|set| set.elements.epoch() != elements.epoch());
    let others =
        others.filter_map(|set| Some((set.elements.epoch(), Propagator::new(&set.elements).ok()?)));
    others.collect()
}

/// The measured directions.
pub(super) fn directions(
    flown: &[MeasuredPosition],
    has_elevation: bool,
) -> impl Iterator<Item = (Timestamp, AzEl)> {
    flown.iter().filter_map(move |flown| Some((flown.time, flown.direction(has_elevation)?)))
}

/// What is told of a track that begins now.
fn about(antenna: &AntennaModel, begun: Timestamp, sync: TimeSync) -> AboutTrack {
    let tracked_by = match () {
        () if antenna.follows() => TrackedBy::ProgramTrack,
        () if antenna.tracks_unasked() => TrackedBy::Elsewhere,
        () => TrackedBy::OnBoard,
    };
    let pointing_model = match tracked_by {
        TrackedBy::ProgramTrack => antenna.config.track_model(),
        TrackedBy::OnBoard | TrackedBy::Elsewhere => PointingModel::default(),
    };
    AboutTrack {
        begun,
        tracked_by,
        sent: None,
        offsets: FlownOffsets::default(),
        pointing_model,
        unit_clock_ahead_s: None,
        unit_place: None,
        sync,
    }
}

impl Followed {
    /// Takes what is new of the pass.
    fn look(&mut self, antenna: Option<&Antenna>, sync: TimeSync, now: Timestamp) {
        if let Some(antenna) = antenna {
            let positions = antenna.handle.positions();
            if !positions.is_same(&self.positions) {
                // Another session has taken over.
                (self.positions, self.next_position) = (positions.clone(), 0);
            }
            let snapshot = &antenna.shown.snapshot;
            let link = LinkStatus::of(&antenna.shown);
            let is_lost = matches!(link, LinkStatus::Lost | LinkStatus::Stale);
            self.breaks.note_link(now, is_lost);
            let view = snapshot.program_track.as_ref();
            let number = self.elements.catalog_number();
            // Before AOS and after LOS it counts for other passes.
            let is_of_this = |view: &&TrackView| {
                view.catalog_number == Some(number) && view.phase == TrackPhase::Tracking
            };
            if let Some(view) = view.filter(is_of_this) {
                self.about.sent = Some(view.stats.commands);
                self.about.offsets.note(now, view.offsets);
            }
            let shown = &antenna.shown;
            if !shown.follows() && shown.tracks() && shown.tracked_number() == Some(number) {
                self.about.offsets.note(now, snapshot.meant_offsets());
            }
            self.about.unit_place = snapshot.state.on_board.place.or(self.about.unit_place);
            let clock = snapshot.state.on_board.clock.filter(|clock| clock.is_set);
            self.about.unit_clock_ahead_s =
                clock.map(|clock| clock.ahead_s).or(self.about.unit_clock_ahead_s);
        }
        if sync == TimeSync::NotSynchronised {
            self.about.sync = sync;
        }
        let (first, positions) = self.positions.read_from(self.next_position);
        self.next_position = first + positions.len() as u64;
        let within = positions.iter().filter(|it| self.from <= it.at && it.at <= self.until);
        self.flown.extend(within.map(|it| MeasuredPosition { time: it.at, pointing: it.pointing }));
    }

    /// Starts the work on the report; `None` where there is no thread for it.
    fn report(self, history: Option<History>, wake: &Wake) -> Option<Job<PassNote>> {
        let job =
            Job::start("azel-report", Wake::clone(wake), move |_| self.note(history.as_ref()));
        job.inspect_err(|error| tracing::error!(%error, "a pass without a report")).ok()
    }

    fn note(self, history: Option<&History>) -> PassNote {
        let compared = |flown| self.about.compared(&self.propagator, self.site, flown);
        let flown: Vec<MeasuredPosition> = self.flown.iter().copied().map(compared).collect();
        let tracked = TrackedPass {
            propagator: &self.propagator,
            site: self.site,
            from: self.from,
            until: self.until,
            limits: self.limits,
            trackability: self.trackability(),
            ended: self.ended,
            breaks: &self.breaks,
        };
        let report = tracked.report(&flown);
        let has_elevation = self.limits.has_elevation;
        let is_reached = |flown: &&MeasuredPosition| tracked.is_in_reach(flown.time);
        let reached: Vec<MeasuredPosition> = flown.iter().filter(is_reached).copied().collect();
        let measured = directions(&reached, has_elevation);
        let half_beam = self.limits.half_beam;
        let evidence = Evidence::new(self.limits.mount, has_elevation, half_beam).with_pass(
            &self.propagator,
            self.site,
            self.about.path_source(self.site),
            measured,
        );
        let causes = match report.verdict {
            PassVerdict::Good => Vec::new(),
            PassVerdict::Fair | PassVerdict::Poor => {
                evidence.explanations(&others_of(&self.elements, history))
            }
        };
        let middle = add_seconds(self.from, seconds_between(self.from, self.until) / 2.0);
        let points = apart(self.flown.iter().copied(), POINT_S, |flown| flown.time).collect();
        let report = RecordedReport {
            from: self.from,
            until: self.until,
            max_elevation_deg: self.max_elevation_deg,
            age_days: self.elements.age_s(middle) / 86_400.0,
            half_beam_deg: self.limits.half_beam.degrees(),
            elements: self.elements,
            site: Some(self.site),
            about: self.about,
            report,
            causes,
        };
        PassNote { antenna: self.antenna, report, points }
    }

    fn trackability(&self) -> Trackability {
        let count = (seconds_between(self.from, self.until) / STEP_S) as u32;
        let samples = (0..=count).filter_map(|step| {
            let time = add_seconds(self.from, f64::from(step) * STEP_S);
            let look = self.propagator.look_from(self.site, time).ok()?;
            Some(Sample { time, direction: look.direction })
        });
        trackability(&samples.collect::<Vec<_>>(), self.limits)
    }
}
