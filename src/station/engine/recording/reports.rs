//! Reports of the passes that antennas track in any way. Azel writes a report when the pass is
//! over, or when the program ends.

use std::time::{Duration, Instant};

use jiff::Timestamp;

use super::{Recording, live::Live};
use crate::{
    astro::{
        Angle, PointingModel, Site,
        time::{add_seconds, apart, seconds_between},
    },
    clock::Instant as Steady,
    contract::{
        CatalogState,
        antenna::AntennaModel,
        automatic::Flown,
        driver::{LinkState, TimeSync, TrackView},
        passes::mount_limits,
        record::{AboutTrack, PlannedPart, RecordedReport, TrackedBy},
    },
    driver::PositionLog,
    engine::{
        Antenna, Engine,
        automatic::{Duty, Flight, is_same_pass},
    },
    job::{Job, Wake},
    library::History,
    orbit::{Elements, PassSearch, Propagator, passes},
    plan::{
        MountLimits, Sample, TrackPhase, Trackability,
        pass_report::{
            APART_S, Breaks, Evidence, FlownOffsets, LossCause, MeasuredPosition, PassVerdict,
            TrackedPass,
        },
        trackability,
    },
    record::PassNote,
    station::AntennaId,
};

/// Max reach of a current pass back and ahead, seconds. For a satellite that stays up longer, the
/// report covers this time from the start of its track.
const REACH_S: f64 = 6.0 * 3600.0;
/// Time from the end of a pass to its report, seconds: the last position may still be on its way.
const AFTER_S: f64 = 3.0;
/// Pause before another search for a pass that was not found, seconds.
const SOUGHT_AGAIN_S: f64 = 60.0;
/// Timeout for unfinished reports when the record ends.
const LAST_WITHIN: Duration = Duration::from_secs(1);
/// Time between two samples of the trackability, seconds.
const STEP_S: f64 = 2.0;
/// Min time between two kept points of the track, seconds.
const POINT_S: f64 = 0.95;

/// Pass that an antenna tracks or that automatic operation must track, until the pass is over.
pub(super) struct Followed {
    pub(super) antenna: AntennaId,
    /// Part of the pass that the plan gives to the antenna.
    planned: Option<Duty>,
    /// Flight of the pass after its end.
    flight: Option<Flight>,
    /// `true` if the antenna tracked the pass, which then needs a report.
    has_tracked: bool,
    pub(super) elements: Elements,
    pub(super) propagator: Propagator,
    pub(super) site: Site,
    /// AOS and LOS above the antenna's own min elevation.
    pub(super) start: Timestamp,
    pub(super) end: Timestamp,
    max_elevation_deg: f64,
    /// Time of the program's end, if before the end of the pass.
    ended: Option<Timestamp>,
    pub(super) limits: MountLimits,
    pub(super) about_track: AboutTrack,
    pub(super) breaks: Breaks,
    positions: PositionLog,
    next_position: u64,
    /// Positions measured while the pass was commanded.
    pub(super) flown: Vec<MeasuredPosition>,
    /// Search for the causes of the error so far.
    pub(super) live: Live,
}

/// Results of a finished pass.
pub(super) struct Finished {
    note: Option<PassNote>,
    /// Line of a scheduled pass for the list of the day.
    flown: Option<(AntennaId, Flown)>,
}

impl Engine {
    /// Adds the passes that antennas track or must track, and reports finished passes.
    pub(super) fn report_passes(&mut self) {
        let finished: Vec<Finished> =
            self.recording.reports.iter_mut().filter_map(Job::take).flatten().collect();
        self.recording.reports.retain(Option::is_some);
        if !finished.is_empty() {
            self.record_has_grown();
        }
        for finished in finished {
            self.tell_finished(finished);
        }
        self.note_commands();
        // One check a second is enough, since a pass is long.
        if self.now.as_second() == self.recording.looked_at {
            return;
        }
        self.recording.looked_at = self.now.as_second();
        let now = self.now;
        self.recording.announced.retain(|(_, _, end)| now <= *end);
        for index in 0..self.antennas.len() {
            self.add_passes(index);
        }
        self.look_at_passes();
        self.explain_passes();
        self.begin_reports(|pass| pass.is_over_since(now) > AFTER_S);
    }

    fn tell_finished(&mut self, finished: Finished) {
        if let Some(note) = finished.note {
            self.report_to_hooks(&note);
            self.recording.tell_pass(note);
        }
        if let Some((antenna, flown)) = finished.flown {
            self.note_flown(antenna, flown);
        }
    }

    /// Ends a scheduled pass of an antenna. Azel notes its outcome together with its report, which
    /// waits for the last positions.
    pub(in crate::engine) fn end_flight(&mut self, antenna: AntennaId, flight: Flight) {
        let is_its = |pass: &&mut Followed| {
            pass.antenna == antenna
                && pass.flight.is_none()
                && pass.planned.is_some_and(|duty| is_same_pass(duty.pass, flight.duty.pass))
        };
        match self.recording.followed.iter_mut().find(is_its) {
            Some(pass) => pass.flight = Some(flight),
            // The satellite no longer has elements.
            None => self.note_flown(antenna, flight.end(None)),
        }
    }

    /// Reports finished and current passes before the record ends.
    pub(in crate::engine) fn report_last_passes(&mut self) {
        let now = self.now;
        self.look_at_passes();
        for pass in &mut self.recording.followed {
            pass.ended = Some(now).filter(|now| *now < pass.counted().1);
        }
        self.begin_reports(|_| true);
        let end = Instant::now() + LAST_WITHIN;
        let jobs: Vec<_> = self.recording.reports.drain(..).flatten().collect();
        for job in jobs {
            if let Some(finished) = job.wait(end.saturating_duration_since(Instant::now())) {
                self.tell_finished(finished);
            } else {
                tracing::error!("a pass without a report: its record ended");
            }
        }
    }

    /// Notes the passes that the antennas are commanded to track.
    fn note_commands(&mut self) {
        let (now, recording) = (self.now, &mut self.recording);
        for antenna in &self.antennas {
            let track = antenna.shown.snapshot.program_track.as_ref();
            let awaits_operator = track.is_some_and(|track| track.awaits_operator);
            let number = antenna.shown.commanded_number().filter(|_| !awaits_operator);
            let id = antenna.shown.id();
            match number {
                Some(number) => {
                    let begun = recording.commanded.entry(id).or_insert((number, now));
                    if begun.0 != number {
                        *begun = (number, now);
                    }
                }
                None => {
                    recording.commanded.remove(&id);
                }
            }
            for pass in recording.followed.iter_mut().filter(|pass| pass.antenna == id) {
                pass.breaks.note_commanded(now, number == Some(pass.elements.catalog_number()));
            }
        }
    }

    fn look_at_passes(&mut self) {
        for pass in &mut self.recording.followed {
            let antenna = self.antennas.iter().find(|other| other.shown.id() == pass.antenna);
            pass.look(antenna, self.time_sync, self.now, self.steady);
        }
    }

    fn begin_reports(&mut self, is_ready: impl Fn(&Followed) -> bool) {
        let wants_reports = self.recording.wants_reports();
        let Recording { followed, reports, announced, .. } = &mut self.recording;
        for pass in followed.extract_if(.., |pass| is_ready(pass)) {
            announced.push((pass.antenna, pass.elements.catalog_number(), pass.end));
            let history = self.places.library().map(History::new);
            reports.push(Some(pass.report(history, wants_reports, &self.wake)));
        }
    }

    /// Adds the pass that an antenna tracks now, and the pass that automatic operation must track
    /// with the antenna.
    fn add_passes(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let (shown, now) = (&antenna.shown, self.now);
        let id = shown.id();
        let tracked = shown.tracked_number().filter(|_| shown.tracks());
        let duty = antenna.at_work.duty();
        let followed = &mut self.recording.followed;
        let own = |pass: &&mut Followed| pass.antenna == id && pass.flight.is_none();
        for pass in followed.iter_mut().filter(own) {
            let number = pass.elements.catalog_number();
            let is_its = |duty: &Duty| {
                duty.pass.0 == number && duty.start <= pass.end && pass.start <= duty.end
            };
            pass.planned = duty.filter(is_its);
        }
        followed.retain(|pass| {
            pass.antenna != id
                || pass.has_tracked
                || pass.planned.is_some()
                || pass.flight.is_some()
        });
        if let Some(duty) = duty {
            let middle_s = seconds_between(duty.start, duty.end) / 2.0;
            self.add_pass(index, duty.pass.0, add_seconds(duty.start, middle_s), Some(duty));
        }
        if let Some(number) = tracked {
            self.add_pass(index, number, now, None);
        }
    }

    /// Adds the pass of a satellite at a time, unless it is already known.
    fn add_pass(&mut self, index: usize, number: u32, time: Timestamp, planned: Option<Duty>) {
        let Some(antenna) = self.antennas.get(index) else { return };
        let (shown, now) = (&antenna.shown, self.now);
        let id = shown.id();
        let is_known = |pass: &Followed| {
            pass.antenna == id && pass.elements.catalog_number() == number && time <= pass.end
        };
        let is_told = |entry: &(AntennaId, u32, Timestamp)| {
            entry.0 == id && entry.1 == number && time <= entry.2
        };
        let recording = &mut self.recording;
        if recording.followed.iter().any(is_known) || recording.announced.iter().any(is_told) {
            return;
        }
        let key = (id, number);
        let is_soon = |(pass_key, time): &(_, Timestamp)| {
            *pass_key == key && seconds_between(*time, now).abs() < SOUGHT_AGAIN_S
        };
        if recording.lookups.iter().any(is_soon) {
            return;
        }
        let CatalogState::Ready(catalog) = &self.catalog else { return };
        let Some(elements) = catalog.get(number) else { return };
        let Ok(propagator) = Propagator::new(elements) else { return };
        let limits = mount_limits(&shown.config);
        let about_track = track_conditions(shown, now, self.time_sync);
        let led_from = about_track.led_from(self.station.site);
        let lowest_deg = led_from.pass_elevation(limits.min_elevation).degrees();
        let lowest = self.station.aos_elevation_deg.max(lowest_deg);
        let search = PassSearch {
            aos_elevation: Angle::from_degrees(lowest),
            ..PassSearch::new(
                self.station.site,
                add_seconds(time, -REACH_S),
                add_seconds(time, REACH_S),
            )
        };
        let found = passes(&propagator, &search, &|| false);
        let is_it = |pass: &&crate::orbit::Pass| pass.aos.time <= time && time <= pass.los.time;
        let Some(pass) = found.iter().find(is_it) else {
            recording.lookups.retain(|((antenna, _), _)| *antenna != key.0);
            return recording.lookups.push((key, now));
        };
        // A satellite that never rises was up before the track, so that time is not lost.
        let start = if pass.starts_before { now } else { pass.aos.time };
        let mut breaks = Breaks::default();
        let commanded = recording.commanded.get(&id).filter(|(commanded, _)| *commanded == number);
        if let Some((_, begin)) = commanded {
            breaks.note_commanded(*begin, true);
        }
        breaks.note_commanded(now, commanded.is_some());
        let followed = Followed {
            antenna: id,
            planned,
            flight: None,
            has_tracked: false,
            elements: elements.clone(),
            propagator,
            site: self.station.site,
            start,
            end: pass.los.time,
            max_elevation_deg: pass.max_elevation().degrees(),
            ended: None,
            limits,
            about_track,
            breaks,
            positions: antenna.handle.positions().clone(),
            next_position: 0,
            flown: Vec::new(),
            live: Live::default(),
        };
        recording.followed.push(followed);
    }
}

/// Returns the sets in `history` for the satellite of `elements`, with their epochs, without the
/// current set.
pub(super) fn others_of(
    elements: &Elements,
    history: Option<&History>,
) -> Vec<(Timestamp, Propagator)> {
    let sets = history.map_or_else(Vec::new, |stored| stored.sets_of(elements.catalog_number()));
    let others = sets.iter().filter(|set| set.elements.epoch() != elements.epoch());
    let others =
        others.filter_map(|set| Some((set.elements.epoch(), Propagator::new(&set.elements).ok()?)));
    others.collect()
}

/// Returns the conditions of a track that begins now.
fn track_conditions(antenna: &AntennaModel, begun: Timestamp, sync: TimeSync) -> AboutTrack {
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
    /// Returns the part of the pass that counts: the antenna's part in the plan, or the whole pass.
    fn counted(&self) -> (Timestamp, Timestamp) {
        self.planned.map_or((self.start, self.end), |duty| (duty.start, duty.end))
    }

    /// Returns the time since the end of the antenna's pass, seconds; negative before the end.
    fn is_over_since(&self, now: Timestamp) -> f64 {
        let is_under_way = self.planned.is_some() && self.flight.is_none();
        let end = if is_under_way { self.end } else { self.counted().1 };
        seconds_between(end, now)
    }

    /// Reads the news about the pass.
    fn look(&mut self, antenna: Option<&Antenna>, sync: TimeSync, now: Timestamp, steady: Steady) {
        if let Some(antenna) = antenna {
            let positions = antenna.handle.positions();
            if !positions.is_same(&self.positions) {
                // Another session has taken over.
                (self.positions, self.next_position) = (positions.clone(), 0);
            }
            let snapshot = &antenna.shown.snapshot;
            let lost_since = match snapshot.link {
                LinkState::Lost { start, .. } => {
                    Some(add_seconds(now, -steady.saturating_duration_since(start).as_secs_f64()))
                }
                LinkState::Off
                | LinkState::Connecting { .. }
                | LinkState::Up { .. }
                | LinkState::Stale { .. } => None,
            };
            self.breaks.note_link(now, lost_since);
            let view = snapshot.program_track.as_ref();
            let number = self.elements.catalog_number();
            let shown = &antenna.shown;
            let tracks = shown.tracks() && shown.tracked_number() == Some(number);
            if tracks && !self.has_tracked {
                (self.has_tracked, self.about_track) = (true, track_conditions(shown, now, sync));
            }
            // Before AOS and after LOS, program track works on other passes.
            let is_of_this = |view: &&TrackView| {
                view.catalog_number == Some(number) && view.phase == TrackPhase::Tracking
            };
            if let Some(view) = view.filter(is_of_this) {
                self.about_track.sent = Some(view.stats.commands);
                self.about_track.offsets.note(now, view.offsets);
            }
            if tracks && !shown.follows() {
                self.about_track.offsets.note(now, snapshot.meant_offsets());
            }
            self.about_track.unit_place =
                snapshot.state.on_board.place.or(self.about_track.unit_place);
            let clock = snapshot.state.on_board.clock.filter(|clock| clock.is_set);
            self.about_track.unit_clock_ahead_s =
                clock.map(|clock| clock.ahead_s).or(self.about_track.unit_clock_ahead_s);
        }
        if sync == TimeSync::NotSynchronised {
            self.about_track.sync = sync;
        }
        let (first, positions) = self.positions.read_from(self.next_position);
        self.next_position = first + positions.len() as u64;
        let near = add_seconds(self.start, -APART_S)..=add_seconds(self.end, APART_S);
        let own = positions.iter().filter(|measured| {
            near.contains(&measured.time) && self.breaks.was_commanded(measured.time)
        });
        self.flown
            .extend(own.map(|own| MeasuredPosition { time: own.time, pointing: own.pointing }));
    }

    /// Starts a job that makes the report.
    fn report(self, history: Option<History>, wants_note: bool, wake: &Wake) -> Job<Finished> {
        Job::start("azel-report", Wake::clone(wake), move |_| {
            self.finish(history.as_ref(), wants_note)
        })
    }

    fn finish(mut self, history: Option<&History>, wants_note: bool) -> Finished {
        let compared = |flown| self.about_track.compared(&self.propagator, self.site, flown);
        let flown: Vec<MeasuredPosition> = self.flown.iter().copied().map(compared).collect();
        let (start, end) = self.counted();
        let tracked = TrackedPass {
            propagator: &self.propagator,
            site: self.site,
            start,
            end,
            limits: self.limits,
            trackability: self.trackability(),
            ended: self.ended,
            breaks: &self.breaks,
        };
        let report = tracked.report(&flown);
        let outcome = self.flight.take().map(|flight| (self.antenna, flight.end(Some(&report))));
        if !wants_note || !self.has_tracked {
            return Finished { note: None, flown: outcome };
        }
        let has_elevation = self.limits.has_elevation;
        let half_beam = self.limits.half_beam;
        let evidence = Evidence::new(self.limits.mount, has_elevation, half_beam).with_pass(
            &self.propagator,
            self.site,
            self.about_track.path_source(self.site),
            tracked.judged(&report, &flown),
        );
        let had_no_effect = report.losses.iter().any(|lost| lost.cause == LossCause::NoEffect);
        let evidence = if had_no_effect { evidence.only_drives() } else { evidence };
        let causes = match report.verdict {
            PassVerdict::Good => Vec::new(),
            PassVerdict::Fair | PassVerdict::Poor => {
                evidence.explanations(&others_of(&self.elements, history))
            }
        };
        let middle = add_seconds(self.start, seconds_between(self.start, self.end) / 2.0);
        let is_inside = |flown: &&MeasuredPosition| (self.start..=self.end).contains(&flown.time);
        let points = self.flown.iter().filter(is_inside).copied();
        let points = apart(points, POINT_S, |flown| flown.time).collect();
        let report = RecordedReport {
            start: self.start,
            end: self.end,
            planned: self.planned.map(|duty| PlannedPart { start: duty.start, end: duty.end }),
            max_elevation_deg: self.max_elevation_deg,
            age_days: self.elements.age_s(middle) / 86_400.0,
            half_beam_deg: self.limits.half_beam.degrees(),
            elements: self.elements,
            site: Some(self.site),
            track: self.about_track,
            report,
            causes,
        };
        let note = PassNote { antenna: self.antenna, report, points };
        Finished { note: Some(note), flown: outcome }
    }

    /// Returns the counted part that the mount can track. The plan says how much the mount loses,
    /// and why.
    pub(super) fn trackability(&self) -> Trackability {
        let (first, last) = self.counted();
        let count = (seconds_between(first, last) / STEP_S) as u32;
        let samples = (0..=count).filter_map(|step| {
            let time = add_seconds(first, f64::from(step) * STEP_S);
            let look = self.propagator.look_from(self.site, time).ok()?;
            Some(Sample { time, direction: look.direction })
        });
        let alone = trackability(&samples.collect::<Vec<_>>(), self.limits);
        let Some(duty) = self.planned else { return alone };
        let Some(loss) = duty.lost_at else { return Trackability::Whole };
        let (start, end) = match alone {
            Trackability::Loses { start, end, .. } => (start, end),
            Trackability::Whole | Trackability::Nothing | Trackability::TooLow => (first, last),
        };
        let seconds = (seconds_between(first, last) - duty.counted_s).max(0.0);
        Trackability::Loses { seconds, loss, start, end }
    }
}
