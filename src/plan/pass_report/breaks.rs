//! What broke into a pass from outside: a lost link, a STOP.

use jiff::Timestamp;

use crate::astro::time::add_seconds;

/// An antenna is off its satellite as late as this after its STOP, seconds.
const MOVES_ON_S: f64 = 3.0;

/// When there was no link to the unit of a pass, and when its antenna was stopped.
#[derive(Debug, Clone, Default)]
pub struct Breaks {
    no_link: Vec<(Timestamp, Timestamp)>,
    has_link: bool,
    stops: Vec<Timestamp>,
    /// Not stopped, when it was looked at last.
    is_ready: bool,
}

impl Breaks {
    /// Takes the state at `now`, again and again.
    pub fn note(&mut self, now: Timestamp, has_link: bool, is_stopped: bool) {
        match self.no_link.last_mut().filter(|_| !self.has_link) {
            Some((_, until)) => *until = now,
            None if !has_link => self.no_link.push((now, now)),
            None => {}
        }
        if is_stopped && self.is_ready {
            self.stops.push(now);
        }
        (self.has_link, self.is_ready) = (has_link, !is_stopped);
    }

    pub(super) fn lacks_link(&self, from: Timestamp, until: Timestamp) -> bool {
        self.no_link.iter().any(|(since, to)| *since <= until && from <= *to)
    }

    pub(super) fn has_stop(&self, from: Timestamp, until: Timestamp) -> bool {
        self.stops.iter().any(|at| add_seconds(from, -MOVES_ON_S) <= *at && *at <= until)
    }
}
