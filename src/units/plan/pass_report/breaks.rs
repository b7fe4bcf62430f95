//! What broke into a pass from outside: a lost link, a STOP.

use jiff::Timestamp;

use crate::astro::time::add_seconds;

/// An antenna is off its satellite as late as this after its STOP, seconds.
const MOVES_ON_S: f64 = 3.0;

/// When the link to the unit of a pass was lost, and when STOP was pressed for its antenna.
#[derive(Debug, Clone, Default)]
pub struct Breaks {
    lost: Vec<(Timestamp, Timestamp)>,
    /// When it was looked at last.
    is_lost: bool,
    stops: Vec<Timestamp>,
}

impl Breaks {
    /// Takes the state of the link at `now`, again and again.
    pub fn note_link(&mut self, now: Timestamp, is_lost: bool) {
        match self.lost.last_mut().filter(|_| self.is_lost) {
            Some((_, until)) => *until = now,
            None if is_lost => self.lost.push((now, now)),
            None => {}
        }
        self.is_lost = is_lost;
    }

    /// Takes a STOP that was pressed at `now`.
    pub fn note_stop(&mut self, now: Timestamp) {
        self.stops.push(now);
    }

    pub(super) fn lost_link(&self, from: Timestamp, until: Timestamp) -> bool {
        self.lost.iter().any(|(since, to)| *since <= until && from <= *to)
    }

    /// From when on a stretch is put down to a STOP, if there was one.
    pub(super) fn stopped(&self, from: Timestamp, until: Timestamp) -> Option<Timestamp> {
        let earliest = add_seconds(from, -MOVES_ON_S);
        let stop = self.stops.iter().find(|at| (earliest..=until).contains(*at))?;
        let is_at_its_begin = *stop <= add_seconds(from, MOVES_ON_S);
        Some(if is_at_its_begin { from } else { *stop })
    }
}
