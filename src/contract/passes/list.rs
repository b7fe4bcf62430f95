//! A list of passes, and the view of its upcoming passes.

use std::{iter, ops::Range, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::time::add_seconds,
    orbit::Pass,
    passes::{ListedSatellite, PassListKey, PredictedPass},
};

/// Max difference in AOS of the same pass between two lists, seconds.
const SAME_AOS_S: f64 = 60.0;

/// Passes of a set of satellites. Clones share the passes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PassList {
    /// Satellites, in the order of the station or by catalog number.
    #[serde(skip)]
    pub satellites: Arc<Vec<Arc<ListedSatellite>>>,
    /// Passes by AOS, then by catalog number; always-up passes come last, by number. Some passes
    /// may be over.
    #[serde(skip)]
    pub passes: Arc<Vec<PredictedPass>>,
    /// Number that changes with every new list.
    pub revision: u64,
    /// Start of the search for this list; `None` before the first list.
    pub made_at: Option<Timestamp>,
    pub work: Work,
}

impl Default for PassList {
    fn default() -> Self {
        Self {
            satellites: Arc::default(),
            passes: Arc::default(),
            revision: 0,
            made_at: None,
            work: Work::Nothing,
        }
    }
}

/// State of the search for the next list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    /// No search is running: the list is up to date.
    Nothing,
    UnderWay {
        /// Number of completed satellites.
        done: usize,
        /// Number of all satellites; 0 during the preparation.
        #[serde(rename = "of")]
        total: usize,
    },
    /// The operator cancelled the search.
    Cancelled,
}

impl PassList {
    /// Returns the passes at these indices, each with its catalog number.
    pub fn range(&self, places: Range<usize>) -> impl Iterator<Item = (u32, Pass)> {
        let passes = self.passes.iter().take(places.end).skip(places.start);
        passes.map(|predicted| (predicted.number(), predicted.pass))
    }

    /// Returns the passes that are not over at `now`.
    pub fn upcoming(&self, now: Timestamp) -> UpcomingPasses<'_> {
        UpcomingPasses::new(self, now, None)
    }

    /// Returns the passes that are not over and begin within `span_h` hours. The list must be
    /// ordered by AOS.
    pub fn upcoming_within(&self, now: Timestamp, span_h: u32) -> UpcomingPasses<'_> {
        let end = add_seconds(now, f64::from(span_h) * 3600.0);
        UpcomingPasses::new(self, now, Some(end))
    }

    /// Returns the index of the pass with `key`. Its AOS may differ slightly in a new list.
    fn place(&self, (number, aos): PassListKey) -> Option<usize> {
        let (dated, always_up) = self.parts();
        // Passes that are cut at the start of a list share its start as AOS, so they are ordered by
        // number.
        let start = dated.first().map(|predicted| predicted.pass.aos.time);
        let cut = dated.partition_point(|predicted| Some(predicted.pass.aos.time) <= start);
        let early = [(0, dated.get(..cut).unwrap_or_default()), (dated.len(), always_up)];
        for (first, passes) in early {
            let Ok(index) = passes.binary_search_by_key(&number, PredictedPass::number) else {
                continue;
            };
            let is_it = |predicted: &PredictedPass| {
                predicted.pass.starts_before && aos < predicted.pass.los.time
            };
            if passes.get(index).is_some_and(is_it) {
                return Some(first + index);
            }
        }
        let (start, end) = (add_seconds(aos, -SAME_AOS_S), add_seconds(aos, SAME_AOS_S));
        let first = dated.partition_point(|predicted| predicted.pass.aos.time <= start);
        let near = dated.iter().enumerate().skip(first);
        near.take_while(|(_, predicted)| predicted.pass.aos.time < end)
            .find_map(|(place, predicted)| (predicted.number() == number).then_some(place))
    }

    /// Returns the passes by AOS, and the always-up passes behind them.
    fn parts(&self) -> (&[PredictedPass], &[PredictedPass]) {
        let dated = self.passes.partition_point(|predicted| !predicted.is_always_up());
        self.passes.split_at(dated)
    }

    pub fn find(&self, key: PassListKey) -> Option<&PredictedPass> {
        self.passes.get(self.place(key)?)
    }
}

/// View of the passes of a list that are not over.
#[derive(Debug, Clone)]
pub struct UpcomingPasses<'a> {
    list: &'a PassList,
    /// Index ranges of passes that are over or begin too late, in order.
    left_out: Vec<Range<usize>>,
    /// Index of the first pass that begins too late.
    late: usize,
}

impl<'a> UpcomingPasses<'a> {
    fn new(list: &'a PassList, now: Timestamp, end: Option<Timestamp>) -> Self {
        let (dated, standing) = list.parts();
        let ended = |passes: &[PredictedPass], first: usize| {
            let passes = passes.iter().enumerate();
            let ended = passes.filter(|(_, predicted)| predicted.pass.los.time <= now);
            ended.map(|(place, _)| first + place..first + place + 1).collect::<Vec<_>>()
        };
        // A pass that is over has begun, so the search can stop at the first later AOS.
        let begun = dated.partition_point(|predicted| predicted.pass.aos.time <= now);
        let late = end.map_or(dated.len(), |end| {
            dated.partition_point(|predicted| predicted.pass.aos.time < end).max(begun)
        });
        let mut left_out = ended(dated.get(..begun).unwrap_or_default(), 0);
        left_out.push(late..dated.len());
        left_out.extend(ended(standing, dated.len()));
        Self { list, left_out, late }
    }

    pub fn len(&self) -> usize {
        self.list.passes.len() - self.left_out.iter().map(ExactSizeIterator::len).sum::<usize>()
    }

    /// Returns a value that changes whenever the rows change within one revision of the list.
    pub fn version(&self) -> (usize, usize) {
        (self.late, self.left_out.len())
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of rows whose passes have begun at `now`, without always-up passes.
    pub fn begun(&self, now: Timestamp) -> usize {
        let begun = self.list.parts().0.partition_point(|dated| dated.pass.aos.time <= now);
        let ended = self.left_out.iter().filter(|range| range.start < begun);
        begun - ended.map(|range| range.end.min(begun) - range.start).sum::<usize>()
    }

    /// Returns the pass in this row; `None` beyond the last row.
    pub fn get(&self, row: usize) -> Option<&'a PredictedPass> {
        let mut place = row;
        for left_out in &self.left_out {
            if left_out.start > place {
                break;
            }
            place += left_out.len();
        }
        self.list.passes.get(place)
    }

    pub fn iter(&self) -> impl Iterator<Item = &'a PredictedPass> {
        let passes = &self.list.passes;
        let starts = iter::once(0).chain(self.left_out.iter().map(|range| range.end));
        let ends = self.left_out.iter().map(|range| range.start).chain(iter::once(passes.len()));
        starts.zip(ends).flat_map(|(start, end)| passes.get(start..end).unwrap_or_default())
    }

    /// Returns the passes with AOS before `end`, by AOS, without always-up passes.
    pub fn starting_before(&self, end: Timestamp) -> impl Iterator<Item = &'a PredictedPass> {
        let passes = self.iter().take_while(move |predicted| predicted.pass.aos.time < end);
        passes.filter(|predicted| !predicted.is_always_up())
    }

    /// Returns the row of the pass with `key`. Its AOS may differ slightly in a new list.
    pub fn row(&self, key: PassListKey) -> Option<usize> {
        let place = self.list.place(key)?;
        let before = self.left_out.iter().take_while(|left_out| left_out.start <= place);
        let mut row = place;
        for left_out in before {
            if left_out.contains(&place) {
                return None;
            }
            row -= left_out.len();
        }
        Some(row)
    }
}
