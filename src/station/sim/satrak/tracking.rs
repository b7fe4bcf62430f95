//! Tracking in a window of time. Its states are 0 outside the window, 3 on the way to the start
//! point, 1 in the window and 2 when over.

use std::time::Duration;

use jiff::{SignedDuration, Timestamp};

use crate::astro::{Angle, AzEl, Site};
use crate::orbit::{Elements, PropagationError, Propagator};
use crate::protocol::satrak::{Settings, TrackState, TrackWindow};

/// Pause from a stop to the next tracking step.
const RESUME_AFTER: Duration = Duration::from_secs(1);

/// Satellite to track.
#[derive(Debug, Clone)]
pub(super) struct Target {
    pub(super) catalog_number: u32,
    pub(super) epoch: Timestamp,
    propagator: Propagator,
}

impl Target {
    pub(super) fn new(elements: &Elements) -> Result<Self, PropagationError> {
        Ok(Self {
            catalog_number: elements.catalog_number(),
            epoch: elements.epoch(),
            propagator: Propagator::new(elements)?,
        })
    }

    /// Returns the geometric direction: the unit's document does not mention refraction.
    pub(super) fn direction(&self, site: Site, time: Timestamp) -> Result<AzEl, PropagationError> {
        Ok(self.propagator.look_from(site.airless(), time)?.direction)
    }
}

/// State of the tracking.
#[derive(Debug, Clone, Default)]
pub(super) struct Tracking {
    pub(super) target: Option<Target>,
    /// Window of `START_STOP_TIME=`.
    pub(super) window: Option<TrackWindow>,
    pub(super) is_enabled: bool,
    pub(super) is_auto: bool,
    /// `true` if auto-track restarts in a window in which tracking was switched off.
    pub(super) restarts: bool,
    /// `true` if the window ended during tracking.
    is_completed: bool,
    /// `true` if a client ended tracking in this window; auto-track then does not start again in
    /// it.
    is_declined: bool,
    /// End of a pause in tracking, as a time since the start of the unit.
    held_until: Duration,
}

impl Tracking {
    pub(super) fn set_window(&mut self, window: TrackWindow) {
        self.window = Some(window);
        self.is_completed = false;
        self.is_declined = false;
    }

    /// Returns `true` if the unit has a target to track, now or later.
    pub(super) fn is_ready(&self, rtc: Timestamp) -> bool {
        self.target.is_some() && self.window.is_some_and(|window| rtc < window.stop())
    }

    pub(super) fn enable(&mut self) {
        self.is_enabled = true;
        self.is_completed = false;
        self.is_declined = false;
        self.held_until = Duration::ZERO;
    }

    /// Ends tracking. Auto-track does not restart in the rest of a running window.
    pub(super) fn disable(&mut self) {
        self.is_declined |= std::mem::take(&mut self.is_enabled);
    }

    /// Ends tracking and removes satellite and window.
    pub(super) fn forget(&mut self) {
        *self = Self { restarts: self.restarts, ..Self::default() };
    }

    pub(super) fn enable_auto(&mut self) {
        self.is_auto = true;
        self.is_declined = false;
    }

    /// Pauses tracking for a moment in favour of other motion.
    pub(super) fn hold(&mut self, elapsed: Duration) {
        self.held_until = elapsed.saturating_add(RESUME_AFTER);
    }

    /// Starts and ends tracking by the unit's clock. Returns `true` when tracking ends.
    pub(super) fn update(&mut self, rtc: Timestamp, lead_ms: i64) -> bool {
        let Some(window) = self.window else { return false };
        if rtc >= window.stop() {
            let ended = std::mem::take(&mut self.is_enabled);
            self.is_completed |= ended;
            return ended;
        }
        let is_left_alone = self.is_declined && !self.restarts;
        let may_start = self.is_auto && !is_left_alone && self.target.is_some();
        if may_start && rtc >= lead_start(window, lead_ms) {
            self.is_enabled = true;
        }
        false
    }

    pub(super) fn state(&self, rtc: Timestamp, lead_ms: i64) -> TrackState {
        match self.window {
            _ if self.is_completed => TrackState::Completed,
            Some(window) if self.is_enabled && rtc >= window.start() => TrackState::InTrackTime,
            Some(window) if self.is_enabled && rtc >= lead_start(window, lead_ms) => {
                TrackState::BeforeStart
            }
            _ => TrackState::NotInTrackTime,
        }
    }

    /// Returns the demanded direction; `None` while tracking does not drive the antenna.
    pub(super) fn aim(
        &self,
        site: Site,
        rtc: Timestamp,
        settings: &Settings,
        elapsed: Duration,
    ) -> Option<Result<AzEl, PropagationError>> {
        let (target, window) = (self.target.as_ref()?, self.window?);
        let state = self.state(rtc, settings.lead_ms);
        let is_active = matches!(state, TrackState::InTrackTime | TrackState::BeforeStart);
        if !is_active || elapsed < self.held_until {
            return None;
        }
        let time = shifted(rtc.max(window.start()), settings.time_offset_ms);
        Some(target.direction(site, time).map(|direction| with_offsets(direction, settings)))
    }

    /// Returns the highest elevation in the window, degrees.
    pub(super) fn highest_deg(&self, site: Site) -> Option<f64> {
        const SAMPLE_S: i64 = 10;
        /// Number of samples in a day.
        const MAX_SAMPLES: usize = 8640;
        let (target, window) = (self.target.as_ref()?, self.window?);
        (window.start().as_second()..=window.stop().as_second())
            .step_by(SAMPLE_S as usize)
            .take(MAX_SAMPLES)
            .filter_map(|second| Timestamp::from_second(second).ok())
            .filter_map(|time| target.direction(site, time).ok())
            .map(AzEl::elevation_deg)
            .reduce(f64::max)
    }
}

/// Adds the offsets to the computed direction. The document only names the offsets: the simulator
/// applies them at once, not from the next window on, and limits the result to the min elevation.
fn with_offsets(direction: AzEl, settings: &Settings) -> AzEl {
    let elevation = direction.elevation_deg() + settings.el_offset_deg;
    AzEl {
        azimuth: direction.azimuth + Angle::from_degrees(settings.az_offset_deg),
        elevation: Angle::from_degrees(elevation.clamp(settings.minimum_elevation_deg, 90.0)),
    }
}

fn lead_start(window: TrackWindow, lead_ms: i64) -> Timestamp {
    shifted(window.start(), lead_ms.saturating_neg())
}

/// Returns `time` moved by milliseconds; unchanged at the end of the calendar.
pub(super) fn shifted(time: Timestamp, by_ms: i64) -> Timestamp {
    time.checked_add(SignedDuration::from_millis(by_ms)).unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(second: i64) -> Timestamp {
        Timestamp::from_second(1_500_000_000 + second).unwrap()
    }

    fn windowed() -> Tracking {
        let mut tracking = Tracking::default();
        tracking.set_window(TrackWindow::new(time(100), time(200)).unwrap());
        tracking
    }

    #[test]
    fn the_window_passes_through_its_states() {
        let mut tracking = windowed();
        tracking.enable();
        let mut pulses = Vec::new();
        for second in [0, 39, 40, 99, 100, 199, 200, 500] {
            tracking.update(time(second), 60_000);
            pulses.push(tracking.state(time(second), 60_000).code());
        }
        assert_eq!(pulses, [0, 0, 3, 3, 1, 1, 2, 2]);
        assert!(!tracking.is_enabled);
        tracking.set_window(TrackWindow::new(time(600), time(700)).unwrap());
        assert_eq!(tracking.state(time(610), 0), TrackState::NotInTrackTime);
    }

    #[test]
    fn without_a_satellite_auto_track_does_not_start() {
        let mut tracking = windowed();
        tracking.is_auto = true;
        tracking.update(time(150), 0);
        assert!(!tracking.is_enabled && !tracking.is_ready(time(150)));
    }
}
