//! External interruptions of a pass: a lost link, a STOP by the operator or by Azel, or a track
//! without a command.

use jiff::Timestamp;

use super::{APART_S, LossCause};
use crate::astro::time::{add_seconds, seconds_between};

/// Max time after its STOP in which an antenna leaves its satellite, seconds.
const MOVES_ON_S: f64 = 3.0;

/// Link losses of a pass, stops of its antenna with their causes, and times with the track
/// commanded.
#[derive(Debug, Clone, Default)]
pub struct Breaks {
    lost: Vec<(Timestamp, Timestamp)>,
    /// `true` if the link was lost at the last note.
    is_lost: bool,
    stops: Vec<(Timestamp, LossCause)>,
    /// Times with the track commanded; `None` without a note: then the whole pass counts as
    /// commanded.
    commanded: Option<Vec<(Timestamp, Timestamp)>>,
    is_commanded: bool,
}

impl Breaks {
    /// Notes the state of the link at `now`; called repeatedly. `lost_since` may be some seconds
    /// before the detection of the loss.
    pub fn note_link(&mut self, now: Timestamp, lost_since: Option<Timestamp>) {
        match (self.lost.last_mut().filter(|_| self.is_lost), lost_since) {
            (Some((_, end)), _) => *end = now,
            (None, Some(start)) => self.lost.push((start, now)),
            (None, None) => {}
        }
        self.is_lost = lost_since.is_some();
    }

    /// Notes a STOP at `now` by the operator or by Azel. `loss_cause`: cause of all losses from
    /// then on.
    pub fn note_stop(&mut self, now: Timestamp, loss_cause: LossCause) {
        self.stops.push((now, loss_cause));
    }

    /// Notes at `now` whether the antenna has the command to track this pass; called repeatedly.
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

    /// Returns the stretches between two times in which the track was commanded. Interruptions as
    /// short as the time between two positions do not count, because a unit ends its window at a
    /// whole second.
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

    /// Returns the time from which a STOP explains a stretch, and the cause of that STOP.
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
