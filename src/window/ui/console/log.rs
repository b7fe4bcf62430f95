//! The lines of all antennas in the order of time, and the filter for those shown.

use std::{collections::VecDeque, sync::Arc};

use crate::{
    contract::driver::{IsAwaited, MAX_LINES, Recorded, WireLog},
    device::{Direction, WireLine},
    model::ConsoleLine,
};

/// Choice of the lines that the log shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Filter {
    /// Antenna whose lines are shown; `None` shows all antennas.
    pub(super) antenna: Option<String>,
    /// Direction of the shown lines; `None` shows both.
    pub(super) direction: Option<Direction>,
    /// Text that every shown line contains.
    pub(super) needle: String,
    /// Flag: hide routine polls.
    pub(super) hides_polls: bool,
}

impl Default for Filter {
    fn default() -> Self {
        Self { antenna: None, direction: None, needle: String::new(), hides_polls: true }
    }
}

impl Filter {
    /// Decides whether the filter shows a line of `antenna`, leaves it out, or leaves it out only
    /// as a poll. `has_text` returns `true` if the line contains the text.
    fn judge(
        &self,
        antenna: &str,
        wire: &WireLine,
        has_text: impl FnOnce() -> bool,
    ) -> LineVerdict {
        let is_other = self.antenna.as_ref().is_some_and(|name| **name != *antenna);
        let is_other_way = self.direction.is_some_and(|way| way != wire.direction);
        if is_other || is_other_way || !has_text() {
            LineVerdict::Other
        } else if self.hides_polls && wire.is_routine_poll() {
            LineVerdict::Poll
        } else {
            LineVerdict::Shown
        }
    }
}

enum LineVerdict {
    Shown,
    Poll,
    Other,
}

/// Returns a test for the lines of an antenna that the filter shows.
fn is_shown(filter: &Filter, needle: &str, antenna: &Arc<str>) -> IsAwaited {
    let (filter, needle, antenna) = (filter.clone(), needle.to_owned(), Arc::clone(antenna));
    Arc::new(move |recorded| {
        // Build the line only if there is a text to find: the antenna's session waits for this
        // test.
        let has_text = || {
            let line = || ConsoleLine::new(0, Arc::clone(&antenna), Arc::clone(recorded));
            needle.is_empty() || line().has(&needle)
        };
        matches!(filter.judge(&antenna, &recorded.line, has_text), LineVerdict::Shown)
    })
}

/// All lines, and the positions of those shown.
#[derive(Debug, Default)]
pub(super) struct Log {
    lines: VecDeque<Arc<ConsoleLine>>,
    /// Position of the oldest kept line.
    first: u64,
    sources: Vec<Source>,
    filter: Filter,
    /// Positions of the shown lines, in order.
    shown: VecDeque<u64>,
    /// Positions of the hidden polls, in order.
    polls: VecDeque<u64>,
    /// Number of shown lines dropped from the front.
    dropped: u64,
}

/// The log of one antenna and the reading position in it.
#[derive(Debug)]
struct Source {
    antenna: Arc<str>,
    log: WireLog,
    next: u64,
}

impl Log {
    /// Takes new lines from the logs of the named antennas. Returns `true` if more lines may
    /// follow.
    pub(super) fn pull<'a>(&mut self, logs: impl Iterator<Item = (&'a str, &'a WireLog)>) -> bool {
        self.take_up(logs);
        let needle = self.filter.needle.to_lowercase();
        let read = self.sources.iter().map(|source| {
            let is_awaited = is_shown(&self.filter, &needle, &source.antenna);
            source.log.read_from(source.next, is_awaited).into()
        });
        let mut read: Vec<VecDeque<Arc<Recorded>>> = read.collect();
        while let Some((antenna, recorded)) = self.next_line(&mut read) {
            let position = self.first + self.lines.len() as u64;
            let line = ConsoleLine::new(position, antenna, recorded);
            self.list(&line, &needle);
            self.lines.push_back(Arc::new(line));
        }
        self.drop_oldest(MAX_LINES * self.sources.len().max(1));
        self.waiting() > 0
    }

    /// Takes the earliest line that was read. Returns `None` if no line is left, or if an antenna
    /// has only unread lines, which may be earlier.
    fn next_line(
        &mut self,
        read: &mut [VecDeque<Arc<Recorded>>],
    ) -> Option<(Arc<str>, Arc<Recorded>)> {
        let pairs = self.sources.iter_mut().zip(read);
        let mut first: Option<(&mut Source, &mut VecDeque<Arc<Recorded>>)> = None;
        for (source, lines) in pairs {
            let Some(line) = lines.front() else {
                if source.next < source.log.next_number() {
                    return None;
                }
                continue;
            };
            let is_earlier = first.as_ref().and_then(|(_, lines)| lines.front());
            if is_earlier.is_none_or(|earliest| line.line.time < earliest.line.time) {
                first = Some((source, lines));
            }
        }
        let (source, lines) = first?;
        let recorded = lines.pop_front()?;
        source.next = recorded.number + 1;
        Some((Arc::clone(&source.antenna), recorded))
    }

    /// Follows the current antennas; lines of former antennas stay.
    fn take_up<'a>(&mut self, logs: impl Iterator<Item = (&'a str, &'a WireLog)>) {
        let mut before = std::mem::take(&mut self.sources);
        for (antenna, log) in logs {
            let index = before.iter().position(|source| source.log.is_same(log));
            let next = index.map_or(0, |position| before.swap_remove(position).next);
            self.sources.push(Source { antenna: antenna.into(), log: log.clone(), next });
        }
    }

    fn list(&mut self, line: &ConsoleLine, needle: &str) {
        let has_text = || needle.is_empty() || line.has(needle);
        match self.filter.judge(&line.antenna, line.wire(), has_text) {
            LineVerdict::Shown => self.shown.push_back(line.position),
            LineVerdict::Poll => self.polls.push_back(line.position),
            LineVerdict::Other => {}
        }
    }

    fn drop_oldest(&mut self, max: usize) {
        let surplus = self.lines.len().saturating_sub(max);
        self.lines.drain(..surplus);
        self.first += surplus as u64;
        while self.shown.front().is_some_and(|position| *position < self.first) {
            self.shown.pop_front();
            self.dropped += 1;
        }
        while self.polls.front().is_some_and(|position| *position < self.first) {
            self.polls.pop_front();
        }
    }

    /// Returns the number of lines received since the last [`Self::pull`].
    pub(super) fn waiting(&self) -> u64 {
        let ahead = |source: &Source| source.log.next_number().saturating_sub(source.next);
        self.sources.iter().map(ahead).sum()
    }

    pub(super) fn set_filter(&mut self, filter: &Filter) {
        if self.filter == *filter {
            return;
        }
        self.filter = filter.clone();
        self.shown.clear();
        self.polls.clear();
        let needle = self.filter.needle.to_lowercase();
        let lines = std::mem::take(&mut self.lines);
        for line in &lines {
            self.list(line, &needle);
        }
        self.lines = lines;
    }

    /// Returns the positions of the shown lines.
    pub(super) fn shown(&self) -> &VecDeque<u64> {
        &self.shown
    }

    /// Returns the number of hidden polls.
    pub(super) fn hidden_polls(&self) -> usize {
        self.polls.len()
    }

    /// Returns the number of shown lines dropped from the front since the last call.
    pub(super) fn take_gone(&mut self) -> u64 {
        std::mem::take(&mut self.dropped)
    }

    /// Returns the line at a position while the log keeps it.
    pub(super) fn line(&self, position: u64) -> Option<&Arc<ConsoleLine>> {
        let index = usize::try_from(position.checked_sub(self.first)?).ok()?;
        self.lines.get(index)
    }

    /// Returns the names of the followed antennas.
    pub(super) fn antennas(&self) -> impl Iterator<Item = &Arc<str>> {
        self.sources.iter().map(|source| &source.antenna)
    }

    /// Returns all lines, shown or not, newest first.
    pub(super) fn newest_first(&self) -> impl Iterator<Item = &Arc<ConsoleLine>> {
        self.lines.iter().rev()
    }

    pub(super) fn all_shown(&self) -> impl Iterator<Item = &Arc<ConsoleLine>> {
        self.shown.iter().filter_map(|position| self.line(*position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        device::{Direction, WireLine},
        model::testing::wire,
    };

    fn sent(second: i64, text: &str) -> WireLine {
        wire(second, Direction::Sent, text)
    }

    fn poll(second: i64) -> WireLine {
        WireLine { is_poll: true, ..sent(second, "$STATUS?*2B") }
    }

    fn texts(log: &Log) -> Vec<&str> {
        log.all_shown().map(|line| line.raw.as_str()).collect()
    }

    fn filter(needle: &str, hides_polls: bool) -> Filter {
        Filter { needle: needle.to_owned(), hides_polls, ..Filter::default() }
    }

    #[test]
    fn lines_of_several_antennas_stand_in_the_order_of_time() {
        let (dish, mast) = (WireLog::default(), WireLog::default());
        dish.push(sent(1, "$A?*41"));
        dish.push(sent(3, "$C?*41"));
        mast.push(sent(2, "$B?*41"));
        let mut log = Log::default();
        let logs = [("Dish", &dish), ("Mast", &mast)];
        assert!(!log.pull(logs.into_iter()));
        dish.push(sent(4, "$D?*41"));
        assert_eq!(log.waiting(), 1);
        log.pull(logs.into_iter());
        assert_eq!(log.waiting(), 0);
        let order: String = texts(&log).iter().map(|text| &text[1..2]).collect();
        assert_eq!(order, "ABCD");
        let only = Filter { antenna: Some("Mast".to_owned()), ..Filter::default() };
        log.set_filter(&only);
        assert_eq!(texts(&log), ["$B?*41<CR><LF>"]);
    }

    #[test]
    fn many_waiting_lines_of_antennas_with_different_traffic_stand_in_the_order_of_time() {
        let (busy, quiet) = (WireLog::default(), WireLog::default());
        for second in 0..3500 {
            busy.push(sent(second, "$A?*41"));
            if second % 10 == 5 {
                quiet.push(sent(second, "$B?*41"));
            }
        }
        let mut log = Log::default();
        while log.pull([("Dish", &busy), ("Mast", &quiet)].into_iter()) {}
        let times: Vec<_> = log.all_shown().map(|line| line.wire().time).collect();
        assert_eq!(times.len(), 3850);
        assert!(times.is_sorted());
    }

    #[test]
    fn polls_are_hidden_and_counted_and_shown_again() {
        let wires = WireLog::default();
        for second in 0..5 {
            wires.push(poll(second));
        }
        wires.push(sent(9, "$STOP=*25"));
        let mut log = Log::default();
        log.pull([("Dish", &wires)].into_iter());
        assert_eq!((log.shown().len(), log.hidden_polls()), (1, 5));
        log.set_filter(&filter("", false));
        assert_eq!((log.shown().len(), log.hidden_polls()), (6, 0));
        log.set_filter(&filter("all motion", true));
        assert_eq!((log.shown().len(), log.hidden_polls()), (1, 0));
        wires.push(sent(10, "$STOP=*25"));
        wires.push(sent(11, "$TIME?*2A"));
        log.pull([("Dish", &wires)].into_iter());
        assert_eq!(log.shown().len(), 2, "the filter holds for new lines");
    }

    #[test]
    fn a_hidden_line_asks_for_no_frame() {
        let (dish, mast) = (WireLog::default(), WireLog::default());
        let mut log = Log::default();
        let mut asks = |filter: &Filter, (wires, line): (&WireLog, WireLine)| {
            log.set_filter(filter);
            log.pull([("Dish", &dish), ("Mast", &mast)].into_iter());
            wires.push(line)
        };
        let (stop, poll) = (|| sent(1, "$STOP=*25"), || poll(1));
        assert!(!asks(&Filter::default(), (&dish, poll())));
        assert!(asks(&Filter::default(), (&dish, stop())));
        assert!(asks(&filter("", false), (&dish, poll())));
        assert!(!asks(&filter("all motion", false), (&dish, poll())));
        assert!(asks(&filter("all motion", false), (&dish, stop())));
        assert!(asks(&filter("mast", true), (&mast, stop())));
        let only = Filter { antenna: Some("Mast".to_owned()), ..Filter::default() };
        assert!(!asks(&only, (&dish, stop())));
        assert!(asks(&only, (&mast, stop())));
        let received = Filter { direction: Some(Direction::Received), ..Filter::default() };
        assert!(!asks(&received, (&dish, stop())));
        assert!(asks(&received, (&dish, wire(1, Direction::Received, "$STOP=,OK*0D"))));
    }

    #[test]
    fn a_new_session_of_an_antenna_is_read_from_its_start() {
        let (old, new) = (WireLog::default(), WireLog::default());
        old.push(sent(1, "$STOP=*25"));
        new.push(sent(2, "$TIME?*2A"));
        let mut log = Log::default();
        log.pull([("Dish", &old)].into_iter());
        log.pull([("Dish", &new)].into_iter());
        assert_eq!(texts(&log), ["$STOP=*25<CR><LF>", "$TIME?*2A<CR><LF>"]);
    }

    #[test]
    fn a_full_log_loses_its_oldest_lines() {
        let wires = WireLog::default();
        let mut log = Log::default();
        for second in 0..i64::try_from(MAX_LINES).unwrap() + 7 {
            wires.push(sent(second, "$STOP=*25"));
            if second % 900 == 0 {
                log.pull([("Dish", &wires)].into_iter());
            }
        }
        while log.pull([("Dish", &wires)].into_iter()) {}
        assert_eq!(log.shown().len(), MAX_LINES);
        assert_eq!(log.take_gone(), 7);
        assert_eq!(log.take_gone(), 0);
        assert!(log.line(6).is_none() && log.line(7).is_some());
    }
}
