//! Recent statistics of each link: lines, bad lines, missing replies, round trips.

use std::{sync::Arc, time::Duration};

use jiff::{SignedDuration, Timestamp};

use super::log::Log;
use crate::{
    device::{Finding, panel::Tone},
    model::ConsoleLine,
};

/// Time span of the statistics.
const SPAN: SignedDuration = SignedDuration::from_mins(10);

/// Statistics of the link of one antenna.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Tally {
    pub(super) antenna: Arc<str>,
    /// Number of lines in both directions.
    pub(super) lines: usize,
    /// Number of damaged or unreadable lines, and of lines that refuse a request.
    pub(super) bad: usize,
    /// Number of replies that did not come in time.
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
    /// Recomputes the tallies up to `now`, at most once for each second.
    pub(super) fn refresh(&mut self, now: Timestamp, log: &Log) {
        let second = Some(now.as_second());
        if self.second != second {
            self.second = second;
            self.all = tallies(now, log);
        }
    }

    /// Returns the tally of each antenna, in the order of the antennas.
    pub(super) fn all(&self) -> &[Tally] {
        &self.all
    }
}

fn tallies(now: Timestamp, log: &Log) -> Vec<Tally> {
    let nothing = |antenna: &Arc<str>| {
        let antenna = Arc::clone(antenna);
        (Tally { antenna, lines: 0, bad: 0, missing: 0, median: None }, Vec::new())
    };
    let mut all: Vec<(Tally, Vec<Duration>)> = log.antennas().map(nothing).collect();
    let is_recent = |line: &&Arc<ConsoleLine>| now.duration_since(line.wire().time) <= SPAN;
    for line in log.newest_first().take_while(is_recent) {
        let own = all.iter_mut().find(|(tally, _)| tally.antenna == line.antenna);
        let Some((tally, waits)) = own else { continue };
        waits.extend(line.wire().reply_after);
        if matches!(line.wire().finding, Finding::NoReply { .. }) {
            tally.missing += 1;
            continue;
        }
        let is_bad = !line.wire().finding.is_good() || line.meaning.tone == Tone::Bad;
        tally.lines += 1;
        tally.bad += usize::from(is_bad);
    }
    let with_median = |(tally, mut waits): (Tally, Vec<Duration>)| {
        let middle = waits.len() / 2;
        let median = (!waits.is_empty()).then(|| *waits.select_nth_unstable(middle).1);
        Tally { median, ..tally }
    };
    all.into_iter().map(with_median).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contract::driver::WireLog,
        device::{Direction, WireLine},
        model::testing::wire,
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
        mast.push(reply(104, 70));
        let mut log = Log::default();
        log.pull([("Dish", &dish), ("Mast", &mast)].into_iter());
        let now = Timestamp::from_second(700).unwrap();
        let mut tallies = Tallies::default();
        let (antenna, median) = ("Dish".into(), Some(Duration::from_millis(20)));
        let of_dish = Tally { antenna, lines: 4, bad: 1, missing: 1, median };
        let (antenna, median) = ("Mast".into(), Some(Duration::from_millis(70)));
        let of_mast = Tally { antenna, lines: 1, bad: 0, missing: 0, median };
        tallies.refresh(now, &log);
        assert_eq!(tallies.all(), [of_dish, of_mast]);
    }
}
