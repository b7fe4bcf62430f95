//! Interruptions of a pass from outside: a lost link, a STOP of the operator or of Azel, a track that was
//! not commanded.

use jiff::Timestamp;

use super::{APART_S, LossCause};
use crate::astro::time::{add_seconds, seconds_between};

/// An antenna is off its satellite as late as this after its STOP, seconds.
const MOVES_ON_S: f64 = 3.0;

/// When the link to the unit of a pass was lost, when and why its antenna was stopped, and when its track
/// was commanded.
#[derive(Debug, Clone, Default)]
pub struct Breaks {
    lost: Vec<(Timestamp, Timestamp)>,
    /// When it was looked at last.
    is_lost: bool,
    stops: Vec<(Timestamp, LossCause)>,
    /// `None` as long as nobody has noted it: then all of the pass counts as commanded.
    commanded: Option<Vec<(Timestamp, Timestamp)>>,
    is_commanded: bool,
}

impl Breaks {
    /// Takes the state of the link at `now`, again and again: since when it is lost, which may be
    /// some seconds before that was noticed.
    pub fn note_link(&mut self, now: Timestamp, lost_since: Option<Timestamp>) {
        match (self.lost.last_mut().filter(|_| self.is_lost), lost_since) {
            (Some((_, end)), _) => *end = now,
            (None, Some(start)) => self.lost.push((start, now)),
            (None, None) => {}
        }
        self.is_lost = lost_since.is_some();
    }

    /// Takes a STOP that was pressed at `now`, or that Azel sent. `loss_cause`: the cause of what is lost from
    /// then on.
    pub fn note_stop(&mut self, now: Timestamp, loss_cause: LossCause) {
        self.stops.push((now, loss_cause));
    }

    /// Notes at `now`, again and again, if the antenna has the command to track this pass.
    pub fn note_commanded(&mut self, now: Timestamp, is_commanded: bool) {
        let spans = self.commanded.get_or_insert_default();
        match spans.last_mut().filter(|_| is_commanded && self.is_commanded) {
            Some((_, end)) => *end = now,
            None if is_commanded => spans.push((now, now)),
            None => {}
        }
        self.is_commanded = is_commanded;
    }

    /// Returns `true` if the antenna had the command to track this pass at `time`.
    pub fn was_commanded(&self, time: Timestamp) -> bool {
        let holds = |(start, end): &(Timestamp, Timestamp)| *start <= time && time <= *end;
        self.commanded.as_ref().is_none_or(|spans| spans.iter().any(holds))
    }

    /// The stretches between two times in which the track was commanded. Interruptions as short as
    /// the time between two positions do not count: a unit ends its window at a whole second.
    pub(super) fn commanded(
        &self,
        start: Timestamp,
        stop_time: Timestamp,
    ) -> Vec<(Timestamp, Timestamp)> {
        let Some(spans) = &self.commanded else { return vec![(start, stop_time)] };
        let is_near = |a: Timestamp, b: Timestamp| seconds_between(a, b) <= APART_S;
        let mut merged: Vec<(Timestamp, Timestamp)> = Vec::new();
        for (begin, finish) in
            spans.iter().filter(|(first, end)| *first < stop_time && start < *end)
        {
            let begin_time = if is_near(start, *begin) { start } else { *begin };
            let last = if is_near(*finish, stop_time) { stop_time } else { *finish };
            match merged.last_mut().filter(|(_, end)| is_near(*end, begin_time)) {
                Some((_, end)) => *end = last,
                None => merged.push((begin_time, last)),
            }
        }
        merged
    }

    pub(super) fn lost_link(&self, start: Timestamp, end: Timestamp) -> bool {
        self.lost.iter().any(|(begin, finish)| *begin <= end && start <= *finish)
    }

    /// Returns `true` if the link was lost at `time`, or came back just before.
    pub(super) fn is_link_lost_at(&self, time: Timestamp) -> bool {
        self.lost_link(add_seconds(time, -APART_S), add_seconds(time, APART_S))
    }

    /// From when on a stretch is put down to a STOP, and why there was one.
    pub(super) fn stopped(
        &self,
        start: Timestamp,
        end: Timestamp,
    ) -> Option<(Timestamp, LossCause)> {
        let earliest = add_seconds(start, -MOVES_ON_S);
        let (stop, loss_cause) =
            *self.stops.iter().find(|(time, _)| (earliest..=end).contains(time))?;
        let is_at_its_begin = stop <= add_seconds(start, MOVES_ON_S);
        Some((if is_at_its_begin { start } else { stop }, loss_cause))
    }
}
