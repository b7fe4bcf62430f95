//! Detours of program track round barriers. A search takes up to a tenth of a second, so a worker
//! does it. Until its answer arrives, the track has no route.

use std::time::Duration;

use super::{Gate, Moment};
use crate::{
    contract::driver::{Intent, Refusal},
    plan::{
        Bounds,
        detour::{self, AxisLimits},
    },
};

/// Distance between two candidate positions on a detour, degrees.
const STEP_DEG: f64 = 4.0;
/// Time for which a detour is valid. The antenna and the Sun move during this time, so Azel checks
/// each position again before sending it.
const FRESH: Duration = Duration::from_secs(2);
/// Max distance of a new end from the detour's end on each axis, degrees.
const SAME_END_DEG: f64 = 2.0;

/// Reason why a motion has no route.
#[derive(Debug)]
pub(in crate::driver) enum NoRoute {
    Refused(Refusal),
    /// Missing search: a worker must answer this question first.
    Open(Box<DetourQuestion>),
}

impl From<Refusal> for NoRoute {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl NoRoute {
    pub(in crate::driver) fn refusal(self) -> Refusal {
        match self {
            Self::Refused(refusal) => refusal,
            Self::Open(_) => Refusal::BeingJudged,
        }
    }
}

/// Request for a detour between two positions, degrees as the mount counts.
#[derive(Debug, Clone)]
pub(in crate::driver) struct DetourQuestion {
    bounds: Bounds,
    limits: AxisLimits,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
    time: Moment,
}

/// Places of a detour without its start; empty if no detour exists.
#[derive(Debug)]
pub(in crate::driver) struct Detour {
    question: DetourQuestion,
    places_deg: Vec<[f64; 2]>,
}

impl DetourQuestion {
    /// Searches for the detour; takes up to a tenth of a second.
    pub(in crate::driver) fn search(self) -> Detour {
        let Self { from_deg, to_deg, time, .. } = self;
        let now = self.bounds.at_time(time.utc);
        let turns = detour::route(&now, &self.limits, from_deg, to_deg);
        let places_deg = detour::in_steps(&turns.unwrap_or_default(), STEP_DEG);
        Detour { question: self, places_deg }
    }

    /// Returns `true` if the answer to this question also answers `other`, a later question.
    fn covers(&self, other: &Self) -> bool {
        let mut ends = self.to_deg.into_iter().zip(other.to_deg);
        other.time.steady.saturating_duration_since(self.time.steady) < FRESH
            && ends.all(|(one_deg, other_deg)| (one_deg - other_deg).abs() <= SAME_END_DEG)
            // A new keep-out could lie across the detour.
            && self.bounds == other.bounds
    }
}

impl Gate {
    /// Returns the known places of the detour between two positions.
    pub(super) fn detour_places_deg(
        &self,
        from_deg: [f64; 2],
        to_deg: [f64; 2],
        now: Moment,
    ) -> Result<&[[f64; 2]], NoRoute> {
        // Only a track follows a detour, and a permission may let it lead to the Sun.
        let bounds = self.bounds_in(Intent::Track).clone();
        let limits = self.axis_limits();
        let question = DetourQuestion { bounds, limits, from_deg, to_deg, time: now };
        match &self.detour {
            Some(detour) if detour.question.covers(&question) => Ok(&detour.places_deg),
            Some(_) | None => Err(NoRoute::Open(Box::new(question))),
        }
    }

    pub(in crate::driver) fn take_detour(&mut self, detour: Detour) {
        self.detour = Some(detour);
    }
}
