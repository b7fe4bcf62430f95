//! Detours of program track round barriers. A search takes up to a tenth of a second, so a worker
//! makes it, and there is no route until its answer is there.

use std::time::Duration;

use super::{Gate, Moment};
use crate::{
    contract::driver::{Intent, Refusal},
    plan::{
        Bounds,
        detour::{self, AxisLimits},
    },
};

/// Distance between two places of a detour that are tried as the next position, degrees.
const STEP_DEG: f64 = 4.0;
/// A detour leads to its end for this long. The antenna moves on its way meanwhile, and so does the
/// Sun, so each position is checked again before it is sent.
const FRESH: Duration = Duration::from_secs(2);
/// A detour leads to any end that is at most this far from its own on each axis, degrees.
const SAME_END_DEG: f64 = 2.0;

/// Why a motion has no route.
#[derive(Debug)]
pub(in crate::driver) enum NoRoute {
    Refused(Refusal),
    /// Nobody has looked for a detour yet.
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

/// The question for a detour between two positions, degrees as the mount counts.
#[derive(Debug, Clone)]
pub(in crate::driver) struct DetourQuestion {
    bounds: Bounds,
    limits: AxisLimits,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
    asked: Moment,
}

/// The places of a detour, without its start; none where there is no detour.
#[derive(Debug)]
pub(in crate::driver) struct Detour {
    question: DetourQuestion,
    places_deg: Vec<[f64; 2]>,
}

impl DetourQuestion {
    /// Looks for the detour; takes up to a tenth of a second.
    pub(in crate::driver) fn search(self) -> Detour {
        let Self { from_deg, to_deg, asked, .. } = self;
        let now = self.bounds.at_time(asked.utc);
        let turns = detour::route(&now, &self.limits, from_deg, to_deg);
        let places_deg = detour::in_steps(&turns.unwrap_or_default(), STEP_DEG);
        Detour { question: self, places_deg }
    }

    /// Returns `true` if the answer to this question holds for `other`, asked later.
    fn covers(&self, other: &Self) -> bool {
        let mut ends = self.to_deg.into_iter().zip(other.to_deg);
        other.asked.steady.saturating_duration_since(self.asked.steady) < FRESH
            && ends.all(|(one_deg, other_deg)| (one_deg - other_deg).abs() <= SAME_END_DEG)
            // A keep-out that was drawn since then could lie across the detour.
            && self.bounds == other.bounds
    }
}

impl Gate {
    /// The places of the detour between two positions, as far as it is known.
    pub(super) fn detour_places_deg(
        &self,
        from_deg: [f64; 2],
        to_deg: [f64; 2],
        now: Moment,
    ) -> Result<&[[f64; 2]], NoRoute> {
        // Only a track follows a detour, and an agreement may let it lead to the Sun.
        let bounds = self.bounds_in(Intent::Track).clone();
        let limits = self.axis_limits();
        let question = DetourQuestion { bounds, limits, from_deg, to_deg, asked: now };
        match &self.detour {
            Some(detour) if detour.question.covers(&question) => Ok(&detour.places_deg),
            Some(_) | None => Err(NoRoute::Open(Box::new(question))),
        }
    }

    pub(in crate::driver) fn take_detour(&mut self, detour: Detour) {
        self.detour = Some(detour);
    }
}
