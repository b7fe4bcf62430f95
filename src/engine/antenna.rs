//! One antenna of a running station: what its session told last, what is predicted
//! for it, and how far the two are apart.

mod errors;
mod stake;

use std::{collections::VecDeque, sync::Arc};

pub use errors::{ErrorSample, Errors};
pub use stake::Stake;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    claim::HeldBy, on_board::Judged, passes::ListedSatellite, track_again::TrackAgain, written,
};
use crate::{
    astro::{Angle, AzEl, Site, time::seconds_between},
    clock::Instant,
    device::{Measured, Phase, Variant, panel::Act, settings::Group},
    driver::{Event, Intent, Snapshot, StopState},
    plan::{Sample, TrackPhase, on_board::KnownOrbit},
    station::{Antenna, AntennaId, ControllerSpec},
};

/// Rates are taken over at least this long, so that rounding does not show.
const RATE_SPAN_S: f64 = 0.9;

/// Where a target stood when the antenna was measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Its catalog number, for a satellite.
    pub catalog_number: Option<u32>,
    /// When.
    pub at: Timestamp,
    /// Where.
    pub direction: AzEl,
}

/// One antenna.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct AntennaModel {
    /// What it is.
    #[serde(with = "written::antenna")]
    pub config: Antenna,
    /// What its session told last.
    pub snapshot: Arc<Snapshot>,
    /// Our own prediction at the time of the last measurement.
    pub prediction: Option<Prediction>,
    /// Errors of the present track, oldest first.
    pub errors: Errors,
    /// Measured rates of azimuth and elevation, degrees a second.
    pub rates_deg_s: Option<(f64, f64)>,
    /// How its unit would track the selected pass by itself.
    pub judged: Option<Judged>,
    /// The last event that the operator should read, and when it came.
    pub news: Option<(Event, Timestamp)>,
    /// When STOP was pressed that no snapshot tells of yet.
    pub stop_pressed: Option<Instant>,
    /// When STOP was pressed last, as far as the station knows.
    pub last_stop: Option<Instant>,
    /// What it was asked to track last.
    pub ordered_track: Option<TrackAgain>,
    /// A track that STOP has ended, to be offered again.
    pub track_again: Option<TrackAgain>,
    /// A jog was refused because no dead-man can be had, and the operator has not
    /// allowed it since.
    pub asks_unguarded: bool,
    /// An action was refused because nobody here knows where it leads, and nothing
    /// else was asked for since.
    pub asks_unseen: Option<Act>,
    /// Another Azel of this machine drives its unit.
    pub held_by: Option<HeldBy>,
    /// By which orbit its session judges what its unit does by itself.
    pub orbit: Option<Arc<KnownOrbit>>,
    recent: VecDeque<Measured>,
}

impl AntennaModel {
    /// An antenna whose session has just begun.
    pub fn new(config: Antenna, snapshot: Arc<Snapshot>) -> Self {
        Self {
            config,
            snapshot,
            prediction: None,
            errors: Errors::default(),
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
            orbit: None,
            recent: VecDeque::new(),
        }
    }

    /// Names it for good.
    pub fn id(&self) -> AntennaId {
        self.config.id
    }

    /// Goes on showing STOP as pressed that the station has not heard of yet.
    pub fn keep_pressed(&mut self, pressed: Option<Instant>) {
        let is_news = |pressed: &Instant| self.last_stop.is_none_or(|last| last < *pressed);
        self.stop_pressed = pressed.filter(is_news).or(self.stop_pressed);
    }

    /// Whether it can be sent to its park position now.
    pub fn can_park(&self) -> bool {
        let snapshot = &self.snapshot;
        let can = self.variant().capabilities;
        can.takes_positions && snapshot.link.is_open() && snapshot.lock_out.is_none()
    }

    /// The make of its controller.
    pub fn spec(&self) -> &'static ControllerSpec {
        self.config.connection.spec()
    }

    /// What its unit can do and remembers.
    pub fn variant(&self) -> &'static Variant {
        self.config.connection.variant()
    }

    /// What its controller remembers.
    pub fn groups(&self) -> &'static [&'static Group] {
        self.variant().groups
    }

    /// Compares what the snapshot measured with what is predicted. `followed` finds a
    /// satellite by its number.
    pub fn refresh<'a>(
        &mut self,
        site: Site,
        followed: impl Fn(u32) -> Option<&'a Arc<ListedSatellite>>,
    ) {
        let is_told = |pressed: &Instant| match self.snapshot.stop {
            StopState::Ready => false,
            StopState::Stopping { .. } | StopState::NotConfirmed { .. } => true,
            StopState::Stopped { at } => at >= *pressed,
        };
        self.stop_pressed = self.stop_pressed.filter(|pressed| !is_told(pressed));
        let Some(measured) = self.snapshot.state.measured else { return };
        if self.recent.back().is_some_and(|last| last.received == measured.received) {
            return;
        }
        self.take_rate(measured);
        let before = self.prediction.map(|prediction| prediction.catalog_number);
        self.prediction = if self.follows() {
            self.followed_prediction()
        } else {
            // What the unit does not follow yet, or has not risen, is waited for, not
            // missed.
            self.tracked_number().filter(|_| self.is_on_course()).and_then(|number| {
                let look = followed(number)?.propagator.look_from(site, measured.at).ok()?;
                (look.direction.elevation_deg() >= 0.0).then_some(Prediction {
                    catalog_number: Some(number),
                    at: measured.at,
                    direction: look.direction,
                })
            })
        };
        if self.prediction.map(|prediction| prediction.catalog_number) != before {
            self.errors.clear();
        }
        if let Some(error) = self.error() {
            self.errors.push(error);
        }
    }

    fn take_rate(&mut self, measured: Measured) {
        while self.recent.len() > 1
            && self
                .recent
                .get(1)
                .is_some_and(|next| seconds_between(next.at, measured.at) >= RATE_SPAN_S)
        {
            self.recent.pop_front();
        }
        self.rates_deg_s = self.recent.front().and_then(|before| {
            let span_s = seconds_between(before.at, measured.at);
            if !(RATE_SPAN_S / 2.0..=10.0).contains(&span_s) {
                return None;
            }
            // Over the zenith the angles of the sky jump and the axes do not.
            if self.config.mount.is_flipped(measured.axes[1].angle_deg)
                != self.config.mount.is_flipped(before.axes[1].angle_deg)
            {
                return None;
            }
            let (now, then) = (measured.pointing, before.pointing);
            let azimuth = (now.azimuth? - then.azimuth?).wrapped_180();
            let elevation = now
                .elevation
                .zip(then.elevation)
                .map(|(now, then)| (now - then).degrees() / span_s);
            Some((azimuth.degrees() / span_s, elevation.unwrap_or_default()))
        });
        self.recent.push_back(measured);
    }

    /// The session has the target and compares with it.
    fn followed_prediction(&self) -> Option<Prediction> {
        let view = self.snapshot.program_track.as_ref()?;
        let predicted = view.predicted?;
        Some(Prediction {
            catalog_number: view.catalog_number,
            at: predicted.time,
            direction: predicted.direction,
        })
    }

    /// Whether this program follows a target with it, or waits for one.
    pub fn follows(&self) -> bool {
        let view = self.snapshot.program_track.as_ref();
        view.is_some_and(|view| view.phase != TrackPhase::Over)
    }

    /// The satellite that is followed, or is about to be: by the unit itself the
    /// one it holds, whatever we asked for.
    pub fn tracked_number(&self) -> Option<u32> {
        let state = &self.snapshot.state;
        if self.follows() {
            return self.snapshot.program_track.as_ref().and_then(|view| view.catalog_number);
        }
        let enabled = state.program.is_some_and(|program| program.enabled);
        if enabled {
            return state.on_board.satellite.as_ref().map(|held| held.catalog_number);
        }
        (self.snapshot.intent == Intent::Track)
            .then(|| self.snapshot.target.as_ref().map(|target| target.catalog_number))
            .flatten()
    }

    /// Whether the unit is to point at what it tracks by itself. It is not before its
    /// tracking window opens, and not when the pass is over.
    fn is_on_course(&self) -> bool {
        self.snapshot.state.program.is_some_and(|program| {
            program.enabled && matches!(program.phase, Phase::Tracking | Phase::Unknown(_))
        })
    }

    /// Whether a target is followed right now, by the unit or by this program.
    pub fn tracks(&self) -> bool {
        let snapshot = &self.snapshot;
        let by_unit = snapshot
            .state
            .program
            .is_some_and(|program| program.enabled && program.phase == Phase::Tracking);
        let view = snapshot.program_track.as_ref();
        by_unit || view.is_some_and(|view| view.phase == TrackPhase::Tracking)
    }

    /// It moves, or is told from here to be somewhere. Without a link nobody knows,
    /// and other settings may be what brings it back.
    pub fn is_busy(&self) -> bool {
        let snapshot = &self.snapshot;
        let moves = snapshot.state.measured.is_some_and(|measured| measured.moving());
        let tracks = snapshot.program_track.is_some() || snapshot.intent == Intent::Track;
        snapshot.link.is_open() && (moves || tracks)
    }

    /// The target that is followed stands where the mount does not get to.
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

    /// How far the last measurement was from the prediction for its time.
    pub fn error(&self) -> Option<ErrorSample> {
        let prediction = self.prediction?;
        let measured = self.snapshot.state.measured?;
        let pointing = measured.pointing;
        let azimuth = (pointing.azimuth? - prediction.direction.azimuth).wrapped_180();
        let elevation = pointing.elevation.map(|at| at - prediction.direction.elevation);
        Some(ErrorSample {
            time: measured.at,
            off_beam: pointing.separation(prediction.direction.into())?,
            azimuth,
            elevation: elevation.unwrap_or(Angle::ZERO),
        })
    }
}
