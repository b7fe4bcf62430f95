//! One antenna as a station shows it.

mod answers;
mod errors;
mod past_tracks;
mod stake;

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

/// Predicted direction of a target at the time of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Catalog number of a satellite; `None` for another target.
    pub catalog_number: Option<u32>,
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub direction: AzEl,
}

/// One antenna as clients see it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct AntennaModel {
    #[serde(with = "written::antenna")]
    pub config: Arc<Antenna>,
    /// Last snapshot of its session.
    pub snapshot: Arc<Snapshot>,
    /// Prediction for the time of the last measurement.
    pub prediction: Option<Prediction>,
    /// Errors of the present track, oldest first.
    pub errors: Errors,
    /// Causes of the error of the pass under way, if they are known.
    // Older films hold another form under the field's own name, which is ignored.
    #[serde(default, rename = "explained_by")]
    pub explained: Option<Explained>,
    /// The unit answers, but positions that it was asked for are missing again and again.
    #[serde(default)]
    pub loses_positions: bool,
    /// Target of the present track.
    pub errors_of: Option<String>,
    /// Errors of the last tracks.
    pub past_tracks: PastTracks,
    /// Measured rates of azimuth and elevation, degrees a second.
    pub rates_deg_s: Option<(f64, f64)>,
    /// How its unit would track the selected or next pass on board.
    pub judged: Option<Judged>,
    /// The last event for the operator to read, with its time.
    pub news: Option<(Event, Timestamp)>,
    /// Time of a STOP that no snapshot shows yet.
    pub stop_pressed: Option<Instant>,
    /// Time of the last STOP that the station knows of.
    pub last_stop: Option<Instant>,
    /// The last track it was asked for.
    pub ordered_track: Option<TrackAgain>,
    /// A track that STOP ended, offered again.
    pub track_again: Option<TrackAgain>,
    /// A jog was refused for lack of a dead-man, and the operator has not allowed it since.
    pub asks_unguarded: bool,
    /// An action was refused because nobody here knows where it leads, and no other request
    /// came since.
    pub asks_unseen: Option<Act>,
    /// The other Azel of this machine that drives its unit.
    pub held_by: Option<HeldBy>,
    /// Automatic operation.
    pub operation: Operation,
    /// The party whose commands may move it, and the programs that are connected to its port.
    #[serde(default)]
    pub control: Control,
    /// Orbit by which its session judges on-board track.
    pub orbit: Option<Arc<KnownOrbit>>,
}

impl AntennaModel {
    /// An antenna whose session has just begun.
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
        }
    }

    /// Permanent id.
    pub fn id(&self) -> AntennaId {
        self.config.id
    }

    /// Keeps showing a pressed STOP that the station has not heard of yet.
    pub fn keep_pressed(&mut self, pressed: Option<Instant>) {
        let is_news = |pressed: &Instant| self.last_stop.is_none_or(|last| last < *pressed);
        self.stop_pressed = pressed.filter(is_news).or(self.stop_pressed);
    }

    /// Returns `true` if the antenna can be sent to its park position now.
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

    /// Groups of settings of its unit.
    pub fn groups(&self) -> &'static [&'static Group] {
        self.variant().groups
    }

    /// Returns `true` while program track follows a target or waits for one.
    pub fn follows(&self) -> bool {
        let view = self.snapshot.program_track.as_ref();
        view.is_some_and(|view| view.phase != TrackPhase::Over)
    }

    /// Catalog number of the satellite that is tracked, or about to be. With on-board track it is
    /// the satellite that the unit holds, whatever we asked for.
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

    /// Catalog number of the satellite that the antenna has the command to track or to wait for.
    pub fn commanded_number(&self) -> Option<u32> {
        let program = self.snapshot.state.program;
        let is_done = !self.follows()
            && program.is_some_and(|program| program.enabled && program.phase == Phase::Completed);
        self.tracked_number().filter(|_| !is_done)
    }

    /// Begin of the track that the antenna is commanded to, at most `now` for one that runs; `None`
    /// where that is not known.
    pub fn track_begins(&self, now: Timestamp) -> Option<Timestamp> {
        let snapshot = &self.snapshot;
        if let Some(view) = &snapshot.program_track {
            return Some(view.phase.begins(now));
        }
        let window = snapshot.state.on_board.window.filter(|_| self.is_program_on());
        let target = || snapshot.target.as_ref().map(|target| target.start);
        window.map(|(start, _)| start).or_else(target)
    }

    /// Returns `true` if the antenna tracks this satellite, or is on its way to a pass of it.
    pub fn takes(&self, catalog_number: u32) -> bool {
        self.snapshot.link.is_open() && self.commanded_number() == Some(catalog_number)
    }

    /// Returns `true` if the unit tracks, or is about to, by a program that this console has
    /// not started or taken over.
    pub fn tracks_unasked(&self) -> bool {
        self.is_live() && self.is_program_on() && self.snapshot.intent != Intent::Track
    }

    /// Name of the target that is tracked, or about to be; `None` where nothing is, or the
    /// unit does not name it.
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

    /// Returns `true` while a target is tracked, on board or by this program.
    pub fn tracks(&self) -> bool {
        let snapshot = &self.snapshot;
        let by_unit = snapshot
            .state
            .program
            .is_some_and(|program| program.enabled && program.phase == Phase::Tracking);
        let view = snapshot.program_track.as_ref();
        by_unit || view.is_some_and(|view| view.phase == TrackPhase::Tracking)
    }

    /// Returns `true` if the antenna moves or has a track. Without a link it returns
    /// `false`: nobody knows, and other settings may bring the link back.
    pub fn is_busy(&self) -> bool {
        let snapshot = &self.snapshot;
        let moves = snapshot.state.measured.is_some_and(|measured| measured.moving());
        let tracks = snapshot.program_track.is_some() || snapshot.intent == Intent::Track;
        snapshot.link.is_open() && (moves || tracks)
    }

    /// Returns `true` if the target of program track is where the mount cannot reach.
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

    /// Returns `true` while the unit answers in time. Else what was measured is old, such as that of
    /// the link before, while a new one is silent.
    pub fn is_live(&self) -> bool {
        let Snapshot { link, state, .. } = &*self.snapshot;
        let is_of_another_link = (state.link_since.zip(state.measured))
            .is_some_and(|(start, measured)| measured.received < start);
        matches!(link, LinkState::Up { .. }) && !is_of_another_link
    }

    /// Error of the last measurement against the prediction for its time; `None` while that
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

    /// Judgement of the present on-board track, or else of the next one.
    pub fn supervision(&self) -> Option<&Supervision> {
        let running = self.snapshot.on_board.as_ref().map(|view| &*view.found);
        running.or(self.judged.as_ref().and_then(|judged| judged.found.as_deref()))
    }

    /// The judgement, if by it the satellite is missed.
    pub fn misses(&self) -> Option<&Supervision> {
        self.supervision().filter(|found| !found.is_within_beam)
    }
}

/// Judgement of a unit, with the pass and the unit's settings behind it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Judged {
    /// How it would track; `None` where its antenna cannot track the pass.
    pub found: Option<Arc<Supervision>>,
    /// The pass and the settings that it was made of.
    #[serde(rename = "of")]
    pub basis: (PassListKey, OnBoard),
}

/// A track that can be offered again.
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
