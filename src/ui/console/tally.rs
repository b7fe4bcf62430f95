//! Recent statistics of each link: lines, bad lines, missing replies, round trips.

use std::{sync::Arc, time::Duration};

use jiff::{SignedDuration, Timestamp};

use super::log::Log;
use crate::device::{Finding, panel::Tone};
use crate::model::ConsoleLine;

/// Span of the statistics.
const SPAN: SignedDuration = SignedDuration::from_mins(10);

/// Statistics of the link of one antenna.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Tally {
    pub(super) antenna: Arc<str>,
    /// Lines of both directions.
    pub(super) lines: usize,
    /// Lines that were damaged or unreadable, or refused something.
    pub(super) bad: usize,
    /// Replies that did not come in time.
    pub(super) missing: usize,
    /// Median round trip.
    pub(super) median: Option<Duration>,
}

/// Tallies of all antennas, recomputed each second.
#[derive(Debug, Default)]
pub(super) struct Tallies {
    second: Option<i64>,
    all: Vec<Tally>,
}

impl Tallies {
    /// Counts up to `now`.
    pub(super) fn refresh(&mut self, now: Timestamp, log: &Log) {
        let second = Some(now.as_second());
        if self.second != second {
            self.second = second;
            self.all = log.antennas().map(|antenna| tally(antenna, now, log)).collect();
        }
    }

    /// The tally of each antenna, in their order.
    pub(super) fn all(&self) -> &[Tally] {
        &self.all
    }
}

fn tally(antenna: &Arc<str>, now: Timestamp, log: &Log) -> Tally {
    let is_recent = |line: &&Arc<ConsoleLine>| now.duration_since(line.wire().at) <= SPAN;
    let recent = log.newest_first().take_while(is_recent).filter(|line| line.antenna == *antenna);
    let (mut lines, mut bad, mut missing, mut waits) = (0, 0, 0, Vec::new());
    for line in recent {
        waits.extend(line.wire().reply_after);
        if matches!(line.wire().finding, Finding::NoReply { .. }) {
            missing += 1;
            continue;
        }
        lines += 1;
        bad += usize::from(!line.wire().finding.is_good() || line.meaning.tone == Tone::Bad);
    }
    let middle = waits.len() / 2;
    let median = (!waits.is_empty()).then(|| *waits.select_nth_unstable(middle).1);
    Tally { antenna: Arc::clone(antenna), lines, bad, missing, median }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::testing::wire;
    use crate::{
        device::{Direction, WireLine},
        driver::WireLog,
    };

    #[test]
    fn lines_of_the_last_ten_minutes_are_counted_by_antenna() {
        let (dish, mast) = (WireLog::default(), WireLog::default());
        let reply = |second, after_ms| WireLine {
            reply_after: Some(Duration::from_millis(after_ms)),
            ..wire(second, Direction::Received, "$STOP=,OK*0D")
        };
        dish.push(reply(99, 9000));
        for (second, after_ms) in [(101, 10), (102, 30), (103, 20)] {
            dish.push(reply(second, after_ms));
        }
        dish.push(WireLine { finding: Finding::NoChecksum, ..wire(104, Direction::Received, "x") });
        let waited = Duration::from_secs(2);
        let finding = Finding::NoReply { waited, is_repeated: false };
        dish.push(WireLine { finding, ..wire(105, Direction::Received, "") });
        let mut log = Log::default();
        log.pull([("Dish", &dish), ("Mast", &mast)].into_iter());
        let now = Timestamp::from_second(700).unwrap();
        let mut tallies = Tallies::default();
        let (antenna, median) = ("Dish".into(), Some(Duration::from_millis(20)));
        let of_dish = Tally { antenna, lines: 4, bad: 1, missing: 1, median };
        let of_mast = Tally { antenna: "Mast".into(), lines: 0, bad: 0, missing: 0, median: None };
        tallies.refresh(now, &log);
        assert_eq!(tallies.all(), [of_dish, of_mast]);
    }
}
