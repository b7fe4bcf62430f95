//! The schedule of the questions to the unit.

use std::time::Duration;

use crate::{clock::Instant, protocol::satrak::Query};

/// Questions with slow polls, and their intervals.
const SLOW: [(Query, Duration); 7] = [
    (Query::Faults, Duration::from_secs(30)),
    (Query::Clock, Duration::from_secs(10)),
    (Query::Satellite, Duration::from_secs(15)),
    (Query::StartStopTime, Duration::from_secs(15)),
    (Query::GpsData, Duration::from_secs(30)),
    (Query::Settings, Duration::from_secs(30)),
    (Query::GpsSettings, Duration::from_secs(30)),
];
/// Interval for the list of faults while the fault flag is set.
const FAULTS_WHILE_SET: Duration = Duration::from_secs(1);
/// Interval for a question that the unit does not know.
const UNKNOWN: Duration = Duration::from_mins(5);
/// Interval for a question after its first missing answer.
const RETRY: Duration = Duration::from_secs(5);
/// Interval for the list of faults if the unit did not answer while the fault flag is set: the
/// missing list then forbids motion. Each unanswered question takes up to 4 s of the link.
const FAULTS_RETRY: Duration = Duration::from_secs(10);

/// The questions, each with the time at which it is due.
#[derive(Debug)]
pub(super) struct QuerySchedule {
    due: Vec<(Query, Instant)>,
    /// The questions that the unit did not answer the last time.
    missed: Vec<Query>,
}

impl QuerySchedule {
    /// Returns all questions, due immediately, in the order in which Azel probes a new link.
    pub(super) fn new(now: Instant) -> Self {
        let probe = [Query::Version, Query::Status];
        let due = probe.into_iter().chain(SLOW.map(|(query, _)| query));
        Self { due: due.map(|query| (query, now)).collect(), missed: Vec::new() }
    }

    /// Returns the question that has been due longest. Once Azel has probed a new link, the
    /// position comes before all others.
    pub(super) fn next(&self, now: Instant) -> Option<Query> {
        let is_probed = self.due.iter().all(|(query, due)| *query != Query::Version || *due > now);
        let is_due = |(query, due): &(Query, Instant)| *query == Query::Status && *due <= now;
        if is_probed && self.due.iter().any(is_due) {
            return Some(Query::Status);
        }
        let (query, due) = self.due.iter().min_by_key(|(_, due)| *due)?;
        (*due <= now).then_some(*query)
    }

    pub(super) fn due(&self) -> Option<Instant> {
        self.due.iter().map(|(_, due)| *due).min()
    }

    /// Moves the question before all others, even those that have been due longer.
    pub(super) fn hurry(&mut self, query: Query, now: Instant) {
        let first = self.due().map_or(now, |due| due.min(now));
        if let Some(place) = self.due.iter().position(|(candidate, _)| *candidate == query) {
            // Of several questions that are due at the same time, Azel asks the first entry first.
            self.due.remove(place);
            self.due.insert(0, (query, first));
        }
    }

    /// Schedules a question again that was answered or given up.
    pub(super) fn done(&mut self, query: Query, now: Instant, status: Duration, fault: bool) {
        self.missed.retain(|missed| *missed != query);
        let wait = match query {
            Query::Status => status,
            Query::Faults if fault => FAULTS_WHILE_SET,
            // The version does not change while the link is up.
            Query::Version => return self.due.retain(|(query, _)| *query != Query::Version),
            _ => match SLOW.iter().find(|(candidate, _)| *candidate == query) {
                Some((_, period)) => *period,
                None => return,
            },
        };
        self.set(query, now + wait);
    }

    /// Schedules a question again that the unit does not know, or did not answer even the second
    /// time.
    pub(super) fn unknown(&mut self, query: Query, now: Instant, status: Duration, fault: bool) {
        match query {
            Query::Status => self.set(query, now + status),
            Query::Faults if fault => self.set(query, now + FAULTS_RETRY),
            _ => self.set(query, now + UNKNOWN),
        }
    }

    /// Schedules a question soon, once, that the unit did not answer: the unit may have been
    /// silent.
    pub(super) fn missed(&mut self, query: Query, now: Instant) {
        if !self.missed.contains(&query) {
            self.missed.push(query);
            self.set(query, now + RETRY);
        }
    }

    fn set(&mut self, query: Query, due: Instant) {
        if let Some(entry) = self.due.iter_mut().find(|(candidate, _)| *candidate == query) {
            entry.1 = due;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hurried_question_comes_before_those_that_are_overdue() {
        let start = Instant::now();
        let now = start + Duration::from_secs(1);
        let mut schedule = QuerySchedule::new(start);
        assert_eq!(schedule.next(now), Some(Query::Version));
        schedule.hurry(Query::Faults, now);
        assert_eq!(schedule.next(now), Some(Query::Faults));
        schedule.hurry(Query::Status, now);
        assert_eq!(schedule.next(now), Some(Query::Status));
        schedule.done(Query::Status, now, Duration::from_millis(500), false);
        assert_eq!(schedule.next(now), Some(Query::Faults), "the first hurry is kept");
        schedule.done(Query::Faults, now, Duration::from_millis(500), false);
        assert_eq!(schedule.next(now), Some(Query::Version));
    }

    #[test]
    fn a_question_without_an_answer_comes_again_soon_and_then_seldom() {
        let start = Instant::now();
        let period = Duration::from_millis(500);
        let mut schedule = QuerySchedule::new(start);
        let due = |schedule: &QuerySchedule| {
            schedule.due.iter().find(|(query, _)| *query == Query::Version).unwrap().1
        };
        schedule.unknown(Query::Version, start, period, false);
        schedule.missed(Query::Version, start);
        assert_eq!(due(&schedule), start + Duration::from_secs(5));
        let again = start + Duration::from_secs(9);
        schedule.unknown(Query::Version, again, period, false);
        schedule.missed(Query::Version, again);
        assert_eq!(due(&schedule), again + Duration::from_mins(5), "it does not know the question");
    }

    #[test]
    fn the_position_comes_before_whatever_else_is_due() {
        let start = Instant::now();
        let period = Duration::from_millis(200);
        let mut schedule = QuerySchedule::new(start);
        schedule.done(Query::Version, start, period, false);
        schedule.done(Query::Status, start, period, false);
        let now = start + Duration::from_mins(2);
        assert_eq!(schedule.next(now), Some(Query::Status));
        schedule.done(Query::Status, now, period, false);
        let slow = schedule.next(now).unwrap();
        assert_ne!(slow, Query::Status);
        schedule.done(slow, now + period, period, false);
        assert_eq!(schedule.next(now + period), Some(Query::Status));
    }

    #[test]
    fn a_hurry_while_nothing_is_due_is_due_now() {
        let now = Instant::now();
        let mut schedule = QuerySchedule::new(now);
        while let Some(query) = schedule.next(now) {
            schedule.done(query, now, Duration::from_millis(500), false);
        }
        assert_eq!(schedule.due(), Some(now + Duration::from_millis(500)));
        schedule.hurry(Query::Clock, now);
        assert_eq!(schedule.next(now), Some(Query::Clock));
    }
}
