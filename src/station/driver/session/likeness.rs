//! Comparison of a unit after an outage with its earlier reports. Somebody may have replaced the
//! unit or changed its settings, or the unit may have lost its memory.

use std::time::Duration;

use crate::{
    clock::Instant,
    contract::driver::Unlike,
    device::{AntennaState, Offsets, Place},
};

/// Max time until a unit repeats its earlier reports.
const READ_AGAIN: Duration = Duration::from_secs(15);

/// Both ends of an axis, degrees; `None` if the unit does not report them.
type Ends = Option<(f64, f64)>;

/// Description of a unit by its own reports.
#[derive(Debug, Clone, PartialEq, Default)]
struct Likeness {
    identity: Option<String>,
    place: Option<Place>,
    offsets: Option<Offsets>,
    travel_deg: [Ends; 2],
}

/// Unit that Azel must compare before it resumes a track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Recheck {
    pub(super) begun: Instant,
    /// Duration of the outage.
    pub(super) lost: Duration,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Compared {
    /// Incomplete reports of the unit.
    Pending,
    AsBefore,
    Unlike(Unlike),
}

/// Comparison of the unit with its state on the previous link.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Comparison {
    /// State of the unit at its last reading on the previous link.
    left_as: Likeness,
    /// Pending comparison of the unit; a program track keeps its own.
    recheck: Option<Recheck>,
}

impl Comparison {
    /// Stores the state of the unit when its link ends.
    pub(super) fn remember(&mut self, state: &AntennaState) {
        self.left_as = Likeness::new(state);
    }

    pub(super) fn pending(&self) -> Option<Recheck> {
        self.recheck
    }

    pub(super) fn begin(&mut self, recheck: Recheck) {
        self.recheck = Some(recheck);
    }

    pub(super) fn end(&mut self) {
        self.recheck = None;
    }

    /// Compares the unit, which has reported since `begun`.
    pub(super) fn compare(&self, state: &AntennaState, begun: Instant, now: Instant) -> Compared {
        let current = Likeness::new(state);
        let is_late = now.saturating_duration_since(begun) >= READ_AGAIN;
        match self.left_as.differs(&current) {
            None if self.left_as.is_whole(&current) => Compared::AsBefore,
            // A unit that omits an earlier report may have lost its memory.
            None if is_late => Compared::Unlike(Unlike::Unread),
            None => Compared::Pending,
            Some(unlike) => Compared::Unlike(unlike),
        }
    }
}

impl Likeness {
    fn new(state: &AntennaState) -> Self {
        Self {
            identity: state.identity.clone(),
            place: state.on_board.place,
            offsets: state.on_board.offsets,
            travel_deg: state.travel_deg,
        }
    }

    /// Returns the difference of `now`. A value without an earlier reading cannot differ.
    fn differs(&self, now: &Self) -> Option<Unlike> {
        let moved = |(before, now): (Place, Place)| {
            // The unit reports its place in steps, and may round it differently.
            let step_deg = before.step_deg + 1e-9;
            (before.latitude_deg - now.latitude_deg).abs() > step_deg
                || (before.longitude_deg - now.longitude_deg).abs() > step_deg
        };
        let other = |(before, now): (Ends, Ends)| {
            before.zip(now).is_some_and(|(before, now)| before != now)
        };
        if self.identity.as_ref().zip(now.identity.as_ref()).is_some_and(|(a, b)| a != b) {
            Some(Unlike::Identity)
        } else if self.travel_deg.into_iter().zip(now.travel_deg).any(other) {
            Some(Unlike::Limits)
        } else if self.place.zip(now.place).is_some_and(moved) {
            Some(Unlike::Place)
        } else if self.offsets.zip(now.offsets).is_some_and(|(a, b)| a != b) {
            Some(Unlike::Offsets)
        } else {
            None
        }
    }

    /// Returns `true` if `now` contains every earlier value.
    fn is_whole(&self, now: &Self) -> bool {
        let has = |before: bool, now: bool| !before || now;
        has(self.identity.is_some(), now.identity.is_some())
            && has(self.place.is_some(), now.place.is_some())
            && has(self.offsets.is_some(), now.offsets.is_some())
            && self
                .travel_deg
                .iter()
                .zip(now.travel_deg)
                .all(|(a, b)| has(a.is_some(), b.is_some()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn likeness() -> Likeness {
        let offsets = Offsets { azimuth_deg: 0.5, ..Offsets::default() };
        Likeness {
            identity: Some("CU 1.2".to_owned()),
            place: Some(Place { latitude_deg: 41.0, longitude_deg: 29.2, step_deg: 0.01 }),
            offsets: Some(offsets),
            travel_deg: [Some((0.0, 359.0)), None],
        }
    }

    #[test]
    fn a_unit_differs_by_its_identity_limits_place_or_offsets() {
        let identity = Some("CU 1.3".to_owned());
        let place = likeness().place.map(|place| Place { latitude_deg: 41.1, ..place });
        let offsets = likeness().offsets.map(|offsets| Offsets { azimuth_deg: 0.6, ..offsets });
        for (now, unlike) in [
            (likeness(), None),
            (Likeness { identity, ..likeness() }, Some(Unlike::Identity)),
            (
                Likeness { travel_deg: [Some((0.0, 180.0)), None], ..likeness() },
                Some(Unlike::Limits),
            ),
            (Likeness { place, ..likeness() }, Some(Unlike::Place)),
            (Likeness { offsets, ..likeness() }, Some(Unlike::Offsets)),
        ] {
            assert_eq!(likeness().differs(&now), unlike, "{now:?}");
            assert!(likeness().is_whole(&now), "{now:?}");
        }
        for now in [
            Likeness { identity: None, ..likeness() },
            Likeness { travel_deg: [None; 2], ..likeness() },
            Likeness { place: None, ..likeness() },
            Likeness { offsets: None, ..likeness() },
        ] {
            assert_eq!(likeness().differs(&now), None, "{now:?}");
            assert!(!likeness().is_whole(&now), "{now:?}");
        }
    }
}
