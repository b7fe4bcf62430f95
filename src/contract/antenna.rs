//! State of one antenna, as a station publishes it.

mod answers;
mod errors;
mod past_tracks;
mod stake;
mod tally;

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    Command,
    astro::{Angle, AzEl},
    automatic::{OffBecause, Operation},
    claim::HeldBy,
    clock::Instant,
    control::Control,
    device::{OnBoard, Phase, Variant, panel::Act, settings::Group},
    driver::{Event, Intent, LinkState, Snapshot},
    passes::PassListKey,
    plan::{Sample, Supervision, TrackPhase, on_board::KnownOrbit, pass_report::Explained},
    station::{Antenna, AntennaId, ControllerSpec},
    written,
};
pub use answers::{Answers, NoMotion};
pub use errors::{ErrorSample, Errors};
pub use past_tracks::{PastTrack, PastTracks};
pub use stake::Stake;
pub use tally::{PassTally, StopTally, Tally};

/// Predicted direction of a target at the time of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Catalog number of a satellite; `None` for another target.
    pub catalog_number: Option<u32>,
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub direction: AzEl,
}

/// State of one antenna for clients.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct AntennaModel {
    #[serde(with = "written::antenna")]
    pub config: Arc<Antenna>,
    /// Last snapshot of the antenna's session.
    pub snapshot: Arc<Snapshot>,
    /// Prediction for the time of the last measurement.
    pub prediction: Option<Prediction>,
    /// Errors of the current track, oldest first.
    pub errors: Errors,
    /// Causes of the error of the current pass, if known.
    // Older films hold another form under the field's own name, which serde ignores.
    #[serde(default, rename = "explained_by")]
    pub explained: Option<Explained>,
    /// The unit answers, but positions that Azel requested are repeatedly missing.
    #[serde(default)]
    pub loses_positions: bool,
    /// Name of the target of the current track.
    pub errors_of: Option<String>,
    /// Errors of the last tracks.
    pub past_tracks: PastTracks,
    /// Measured rates of azimuth and elevation, degrees a second.
    pub rates_deg_s: Option<(f64, f64)>,
    /// Judgement of the unit's on-board track of the selected or next pass.
    pub judged: Option<Judged>,
    /// Last event for the operator, with its time.
    pub news: Option<(Event, Timestamp)>,
    /// Time of a STOP that no snapshot shows yet.
    pub stop_pressed: Option<Instant>,
    /// Time of the last STOP that the station has received.
    pub last_stop: Option<Instant>,
    /// Last track that the antenna was asked for.
    pub ordered_track: Option<TrackAgain>,
    /// Track that STOP ended and that the window offers again.
    pub track_again: Option<TrackAgain>,
    /// Azel refused a jog because no dead-man was available, and the operator has not allowed the
    /// jog since.
    pub asks_unguarded: bool,
    /// Action that Azel refused because its destination is unknown. `None` after the next request.
    pub asks_unseen: Option<Act>,
    /// Other Azel on this machine that drives the antenna's unit.
    pub held_by: Option<HeldBy>,
    pub operation: Operation,
    /// Party whose commands may move the antenna, and the programs connected to its port.
    #[serde(default)]
    pub control: Control,
    /// Orbit with which the session judges on-board track.
    pub orbit: Option<Arc<KnownOrbit>>,
    /// Counts for monitoring.
    #[serde(default)]
    pub tally: Tally,
}

impl AntennaModel {
    /// Creates an antenna whose session has just begun.
    pub fn new(config: impl Into<Arc<Antenna>>, snapshot: Arc<Snapshot>) -> Self {
        Self {
            config: config.into(),
            snapshot,
            prediction: None,
            errors: Errors::default(),
            explained: None,
            loses_positions: false,
            errors_of: None,
            past_tracks: PastTracks::default(),
            rates_deg_s: None,
            judged: None,
            news: None,
            stop_pressed: None,
            last_stop: None,
            ordered_track: None,
            track_again: None,
            asks_unguarded: false,
            asks_unseen: None,
            held_by: None,
            operation: Operation::Off(OffBecause::NotSwitchedOn),
            orbit: None,
            control: Control::default(),
            tally: Tally::default(),
        }
    }

    /// Returns the permanent id.
    pub fn id(&self) -> AntennaId {
        self.config.id
    }

    /// Keeps showing a pressed STOP that the station has not yet received.
    pub fn keep_pressed(&mut self, pressed: Option<Instant>) {
        let is_news = |pressed: &Instant| self.last_stop.is_none_or(|last| last < *pressed);
        self.stop_pressed = pressed.filter(is_news).or(self.stop_pressed);
    }

    /// Returns `true` if the antenna can go to its park position now.
    pub fn can_park(&self) -> bool {
        let snapshot = &self.snapshot;
        let can = self.variant().capabilities;
        can.takes_positions && snapshot.link.is_open() && snapshot.lock_out.is_none()
    }

    pub fn spec(&self) -> &'static ControllerSpec {
        self.config.connection.spec()
    }

    pub fn variant(&self) -> &'static Variant {
        self.config.connection.variant()
    }

    /// Returns the settings groups of the antenna's unit.
    pub fn groups(&self) -> &'static [&'static Group] {
        self.variant().groups
    }

    /// Returns `true` while program track follows a target or waits for a target.
    pub fn follows(&self) -> bool {
        let view = self.snapshot.program_track.as_ref();
        view.is_some_and(|view| view.phase != TrackPhase::Over)
    }

    /// Returns the catalog number of the satellite that the antenna tracks or is about to track.
    /// With on-board track, the satellite in the unit counts, even if Azel requested another.
    pub fn tracked_number(&self) -> Option<u32> {
        let state = &self.snapshot.state;
        if self.follows() {
            return self.snapshot.program_track.as_ref().and_then(|view| view.catalog_number);
        }
        let enabled = state.program.is_some_and(|program| program.enabled);
        if enabled {
            return state.on_board.satellite.as_ref().map(|satellite| satellite.catalog_number);
        }
        (self.snapshot.intent == Intent::Track)
            .then(|| self.snapshot.target.as_ref().map(|target| target.catalog_number))
            .flatten()
    }

    /// Returns the catalog number of the satellite that the antenna is commanded to track or to
    /// wait for.
    pub fn commanded_number(&self) -> Option<u32> {
        let program = self.snapshot.state.program;
        let is_done = !self.follows()
            && program.is_some_and(|program| program.enabled && program.phase == Phase::Completed);
        self.tracked_number().filter(|_| !is_done)
    }

    /// Returns the start of the commanded track; for a running program track, at most `now`.
    /// Returns `None` if the start is unknown.
    pub fn track_begins(&self, now: Timestamp) -> Option<Timestamp> {
        let snapshot = &self.snapshot;
        if let Some(view) = &snapshot.program_track {
            return Some(view.phase.begins(now));
        }
        let window = snapshot.state.on_board.window.filter(|_| self.is_program_on());
        let target = || snapshot.target.as_ref().map(|target| target.start);
        window.map(|(start, _)| start).or_else(target)
    }

    /// Returns `true` if the antenna tracks this satellite or is on its way to a pass of the
    /// satellite.
    pub fn takes(&self, catalog_number: u32) -> bool {
        self.snapshot.link.is_open() && self.commanded_number() == Some(catalog_number)
    }

    /// Returns `true` if the unit tracks, or is about to track, by a program that Azel has neither
    /// started nor taken over.
    pub fn tracks_unasked(&self) -> bool {
        self.is_live() && self.is_program_on() && self.snapshot.intent != Intent::Track
    }

    /// Returns the name of the target that the antenna tracks or is about to track. Returns `None`
    /// without a target, or if the unit does not report its name.
    pub fn tracked_name(&self) -> Option<&str> {
        let snapshot = &self.snapshot;
        if self.follows() {
            return snapshot.program_track.as_ref().map(|view| view.name.as_str());
        }
        let on_board =
            snapshot.state.on_board.satellite.as_ref().map(|satellite| satellite.name.as_str());
        if self.is_program_on() {
            return on_board;
        }
        let target = snapshot.target.as_ref().map(|target| target.name.as_str());
        target.filter(|_| snapshot.intent == Intent::Track)
    }

    fn is_program_on(&self) -> bool {
        let program = self.snapshot.state.program;
        program.is_some_and(|program| program.enabled && program.phase != Phase::Completed)
    }

    /// Returns `true` while the antenna tracks a target, on board or by program track.
    pub fn tracks(&self) -> bool {
        let snapshot = &self.snapshot;
        let by_unit = snapshot
            .state
            .program
            .is_some_and(|program| program.enabled && program.phase == Phase::Tracking);
        let view = snapshot.program_track.as_ref();
        by_unit || view.is_some_and(|view| view.phase == TrackPhase::Tracking)
    }

    /// Returns `true` if the antenna moves or has a track. Without a link, returns `false`: the
    /// state is unknown, and other settings may restore the link.
    pub fn is_busy(&self) -> bool {
        let snapshot = &self.snapshot;
        let moves = snapshot.state.measured.is_some_and(|measured| measured.moving());
        let tracks = snapshot.program_track.is_some() || snapshot.intent == Intent::Track;
        snapshot.link.is_open() && (moves || tracks)
    }

    /// Returns `true` if program track follows a target that the mount cannot reach.
    pub fn is_out_of_reach(&self) -> bool {
        let predicted = self.snapshot.program_track.as_ref().and_then(|view| view.predicted);
        let mount = self.config.mount;
        predicted.is_some_and(|Sample { mut direction, .. }| {
            if !self.variant().capabilities.has_elevation() {
                let [_, (lowest_deg, _)] = mount.travel_deg();
                direction.elevation = Angle::from_degrees(lowest_deg);
            }
            !mount.reaches(direction)
        })
    }

    /// Returns `true` while the unit answers in time. Otherwise the measurements are old, for
    /// example from the previous link while the current link is silent.
    pub fn is_live(&self) -> bool {
        let Snapshot { link, state, .. } = &*self.snapshot;
        let is_of_another_link = (state.link_since.zip(state.measured))
            .is_some_and(|(start, measured)| measured.received < start);
        matches!(link, LinkState::Up { .. }) && !is_of_another_link
    }

    /// Returns the error of the last measurement against the prediction for its time; `None` if the
    /// measurement is old.
    pub fn error(&self) -> Option<ErrorSample> {
        let prediction = self.prediction.filter(|_| self.is_live())?;
        let measured = self.snapshot.state.measured?;
        let pointing = measured.pointing;
        let azimuth = (pointing.azimuth? - prediction.direction.azimuth).wrapped_180();
        let elevation = pointing.elevation.map(|angle| angle - prediction.direction.elevation);
        Some(ErrorSample {
            time: measured.time,
            off_beam: pointing.separation(prediction.direction.into())?,
            azimuth,
            elevation: elevation.unwrap_or(Angle::ZERO),
        })
    }

    /// Returns the judgement of the current on-board track, or else of the next on-board track.
    pub fn supervision(&self) -> Option<&Supervision> {
        let running = self.snapshot.on_board.as_ref().map(|view| &*view.found);
        running.or(self.judged.as_ref().and_then(|judged| judged.found.as_deref()))
    }

    /// Returns the judgement if it expects a miss.
    pub fn misses(&self) -> Option<&Supervision> {
        self.supervision().filter(|found| !found.is_within_beam)
    }
}

/// Judgement of a unit, with the pass and the unit's settings on which it rests.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Judged {
    /// Expected on-board track; `None` if the antenna cannot track the pass.
    pub found: Option<Arc<Supervision>>,
    /// Pass and settings behind the judgement.
    #[serde(rename = "of")]
    pub basis: (PassListKey, OnBoard),
}

/// Track that the window can offer again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackAgain {
    /// Name of the target.
    pub name: String,
    /// Command that starts the track again.
    pub command: Command,
    /// End of the track.
    #[serde(rename = "until")]
    pub end: Timestamp,
}
