//! Compares a unit after an outage with its earlier reports: somebody may have replaced it or
//! changed its settings, or it may have lost its memory.

use std::time::Duration;

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, Safety, Unlike},
    device::{AntennaState, Offsets, Place},
};

/// How long a unit may take to report again what it reported before.
const READ_AGAIN: Duration = Duration::from_secs(15);

/// Both ends of an axis, degrees; `None` where the unit does not report them.
type Ends = Option<(f64, f64)>;

/// Description of a unit, as far as the unit reports it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Likeness {
    identity: Option<String>,
    place: Option<Place>,
    offsets: Option<Offsets>,
    travel_deg: [Ends; 2],
}

/// A unit that must be compared before a target is tracked on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Recheck {
    pub(super) since: Instant,
    /// How long it was out of reach.
    pub(super) lost: Duration,
}

impl Likeness {
    pub(super) fn of(state: &AntennaState) -> Self {
        Self {
            identity: state.identity.clone(),
            place: state.on_board.place,
            offsets: state.on_board.offsets,
            travel_deg: state.travel_deg,
        }
    }

    /// Returns how `now` differs. A value that was not known before cannot differ.
    fn differs(&self, now: &Self) -> Option<Unlike> {
        let moved = |(before, now): (Place, Place)| {
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

    /// Returns `true` if `now` has everything that was known before.
    fn is_told(&self, now: &Self) -> bool {
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

impl Session {
    /// The link goes: remembers what the unit was like, unless a comparison with an earlier
    /// state is still pending.
    pub(super) fn remember_likeness(&mut self) {
        if !self.contact.unread && self.recheck().is_none() {
            self.contact.left_as = Likeness::of(self.gate.state());
        }
    }

    /// The comparison that is pending.
    pub(super) fn recheck(&self) -> Option<Recheck> {
        self.activity.program().and_then(|track| track.recheck).or(self.contact.recheck)
    }

    /// Compares the unit after an outage. A track resumes once it has proved to be as before;
    /// otherwise the operator is asked.
    pub(super) fn watch_likeness(&mut self, now: Moment) {
        let Some(Recheck { since, lost }) = self.recheck().filter(|_| !self.contact.unread) else {
            return;
        };
        let told = Likeness::of(self.gate.state());
        let is_late = now.steady.saturating_duration_since(since) >= READ_AGAIN;
        let unlike = match self.contact.left_as.differs(&told) {
            None if self.contact.left_as.is_told(&told) => None,
            None if is_late => Some(Unlike::Unread),
            None => return,
            Some(unlike) => Some(unlike),
        };
        self.contact.recheck = None;
        let track = self.activity.program_mut().and_then(|track| track.recheck.take());
        match (unlike, track) {
            (None, _) => {}
            (Some(unlike), Some(_)) => self.await_word(lost, Some(unlike)),
            (Some(unlike), None) => self.tell(Event::Safety(Safety::UnitDiffers { unlike })),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known() -> Likeness {
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
        let place = known().place.map(|place| Place { latitude_deg: 41.1, ..place });
        let offsets = known().offsets.map(|offsets| Offsets { azimuth_deg: 0.6, ..offsets });
        for (now, unlike) in [
            (known(), None),
            (Likeness { identity, ..known() }, Some(Unlike::Identity)),
            (Likeness { travel_deg: [Some((0.0, 180.0)), None], ..known() }, Some(Unlike::Limits)),
            (Likeness { place, ..known() }, Some(Unlike::Place)),
            (Likeness { offsets, ..known() }, Some(Unlike::Offsets)),
        ] {
            assert_eq!(known().differs(&now), unlike, "{now:?}");
            assert!(known().is_told(&now), "{now:?}");
        }
        for now in [
            Likeness { identity: None, ..known() },
            Likeness { travel_deg: [None; 2], ..known() },
            Likeness { place: None, ..known() },
            Likeness { offsets: None, ..known() },
        ] {
            assert_eq!(known().differs(&now), None, "{now:?}");
            assert!(!known().is_told(&now), "{now:?}");
        }
    }
}
